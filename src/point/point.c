/* Stress, fluxes and their consistent tangent; docs/equations.md (14)-(21). */
#include "state.h"
#include "clathra/tensor.h"

/* Row of the tangent for a scalar output c * jet: J spreads over grad u. */
static void AddJet(double D[IN_COUNT], double c, const Jet *a, const Kinematics *k)
{
  for (int i = 0; i < 4; i++)
    D[IN_GRADU + i] += c * a->d[JET_J] * k->dJ[i];
  D[IN_P] += c * a->d[JET_PW];
  D[IN_P + 1] += c * a->d[JET_PG];
  D[IN_T] += c * a->d[JET_T];
}

typedef struct {
  double s[6], ds[6][IN_COUNT];
} Stress;

/* (14): sigma' and its tangent.  Plane strain: e_zz = 0. */
static void EffectiveStress(const Material *mat, const PointHistory *h, const Kinematics *k, const ScalarState *s,
                            double T, bool tangent, double sig0_rotated[6], Stress *out)
{
  const Elasticity *el = &mat->elasticity;
  const double      G = ElasticityShearFactor(el), lame = ElasticityLameFactor(el), dT = T - h->T_n;
  double            dE, over[6], rot[6], drot[6], drot0[6], unit[6];
  const double      En = ElasticityYoung(el, h->Sh_n, &dE), thermal = s->beta.v * dT / 3.0;
  const double      e[6]    = {k->e[0] - thermal, k->e[1] - thermal, -thermal, k->e[2], 0.0, 0.0};
  double            r       = s->E.v / En;
  bool              relaxes = true;

  if (el->loss_only && r > 1.0) {
    r       = 1.0;
    relaxes = false;
  }
  for (int c = 0; c < 6; c++)
    over[c] = h->sig[c] - h->sig0[c];
  Rotate6(over, k->theta, rot, drot);
  Rotate6(h->sig0, k->theta, sig0_rotated, drot0);
  for (int c = 0; c < 6; c++) { /* stress per unit of E */
    unit[c]   = 2.0 * G * e[c] + (c < 3 ? lame * Trace6(e) : 0.0);
    out->s[c] = sig0_rotated[c] + r * rot[c] + s->E.v * unit[c];
  }
  if (!tangent)
    return;

  const Jet dTj = JetVariable(dT, JET_T), eT = JetScale(1.0 / 3.0, JetMul(s->beta, dTj));
  for (int c = 0; c < 6; c++) {
    double *d = out->ds[c];

    for (int i = 0; i < IN_COUNT; i++)
      d[i] = 0.0;
    for (int i = 0; i < 4; i++) {
      const double trace = k->de[0][i] + k->de[1][i];
      const double de    = c == XX ? k->de[0][i] : c == YY ? k->de[1][i] : c == XY ? k->de[2][i] : 0.0;

      d[IN_GRADU + i] =
          (drot0[c] + r * drot[c]) * k->dtheta[i] + s->E.v * (2.0 * G * de + (c < 3 ? lame * trace : 0.0));
    }
    AddJet(d, unit[c] + (relaxes ? rot[c] / En : 0.0), &s->E, k);
    if (c < 3)
      AddJet(d, -s->E.v * (2.0 * G + 3.0 * lame), &eT, k);
  }
}

/* out = V_n sigma cof F (momentum) and V_n p_pi cof F (fluids). */
static void Forces(const PointHistory *h, const Kinematics *k, const ScalarState *s, const Stress *st,
                   const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  const double     total[2][2] = {{st->s[XX] - s->p.v, st->s[XY]}, {st->s[XY], st->s[YY] - s->p.v}};
  static const int voigt[2][2] = {{XX, XY}, {XY, YY}};

  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++) {
      const int row = OUT_P + 2 * i + j;

      o->out[row] = h->V * (total[i][0] * k->cof[0][j] + total[i][1] * k->cof[1][j]);
      for (int f = 0; f < PHASE_COUNT; f++)
        o->out[OUT_PF + 4 * f + 2 * i + j] = h->V * in[IN_P + f] * k->cof[i][j];
      if (!tangent)
        continue;
      for (int m = 0; m < 2; m++) {
        const double *ds = st->ds[voigt[i][m]], c = h->V * k->cof[m][j];

        for (int q = 0; q < IN_J; q++)
          o->D[row][q] += c * ds[q];
        if (m == i)
          AddJet(o->D[row], -c, &s->p, k);
        for (int q = 0; q < 4; q++)
          o->D[row][q] += h->V * total[i][m] * k->dcof[m][j][q];
      }
      for (int f = 0; f < PHASE_COUNT; f++) {
        double *D = o->D[OUT_PF + 4 * f + 2 * i + j];

        D[IN_P + f] += h->V * k->cof[i][j];
        for (int q = 0; q < 4; q++)
          D[q] += h->V * in[IN_P + f] * k->dcof[i][j][q];
      }
    }
  }
}

/* (18)-(20): Phi = V_n rho [ cof^T J + tau K (Pi g - g) ] with K = cof^T cof / J (symmetric, from V F^-1 F^-T). */
static void Fluxes(const PointHistory *h, const Kinematics *k, const ScalarState *s, const double in[IN_COUNT],
                   bool tangent, PointOutput *o, double tau_out[PHASE_COUNT])
{
  double K[2][2], dK[2][2][4];

  for (int i = 0; i < 2; i++) {
    for (int j = 0; j < 2; j++) {
      const double c = k->cof[0][i] * k->cof[0][j] + k->cof[1][i] * k->cof[1][j];

      K[i][j] = c / k->J;
      for (int q = 0; tangent && q < 4; q++) {
        const double dc = k->dcof[0][i][q] * k->cof[0][j] + k->cof[0][i] * k->dcof[0][j][q] +
                          k->dcof[1][i][q] * k->cof[1][j] + k->cof[1][i] * k->dcof[1][j][q];
        dK[i][j][q] = (dc - K[i][j] * k->dJ[q]) / k->J;
      }
    }
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    const Jet     rho = s->rho[f], tau = JetDiv(JetConstant(1.0), JetAdd(s->drag[f], JetScale(1.0 / h->dt, rho)));
    const Jet     rt = JetScale(h->bracket, JetMul(rho, tau));
    const double *J = &in[IN_J + 2 * f], *g = &in[IN_GP + 2 * f];
    const double  b[2] = {h->proj[f][0] - g[0], h->proj[f][1] - g[1]};

    tau_out[f] = tau.v;
    for (int i = 0; i < 2; i++) {
      const int    row = OUT_FLUX + 2 * f + i;
      const double cJ = k->cof[0][i] * J[0] + k->cof[1][i] * J[1], Kb = K[i][0] * b[0] + K[i][1] * b[1];

      o->out[row] = h->V * (rho.v * cJ + rt.v * Kb);
      if (!tangent)
        continue;
      double *D = o->D[row];
      AddJet(D, h->V * cJ, &rho, k);
      AddJet(D, h->V * Kb, &rt, k);
      for (int q = 0; q < 4; q++) {
        D[q] += h->V * rho.v * (k->dcof[0][i][q] * J[0] + k->dcof[1][i][q] * J[1]);
        D[q] += h->V * rt.v * (dK[i][0][q] * b[0] + dK[i][1][q] * b[1]);
      }
      for (int j = 0; j < 2; j++) {
        D[IN_J + 2 * f + j] += h->V * rho.v * k->cof[j][i];
        D[IN_GP + 2 * f + j] -= h->V * rt.v * K[i][j];
        o->wide[f][i][j] = h->V * rt.v * K[i][j];
      }
    }
  }
  /* conduction: V kappa F^-1 F^-T g_T */
  for (int i = 0; i < 2; i++) {
    const double Kg = K[i][0] * in[IN_GT] + K[i][1] * in[IN_GT + 1];

    o->out[OUT_HEAT + i] = h->V * s->kappa.v * Kg;
    if (!tangent)
      continue;
    double *D = o->D[OUT_HEAT + i];
    AddJet(D, h->V * Kg, &s->kappa, k);
    for (int q = 0; q < 4; q++)
      D[q] += h->V * s->kappa.v * (dK[i][0][q] * in[IN_GT] + dK[i][1][q] * in[IN_GT + 1]);
    for (int j = 0; j < 2; j++)
      D[IN_GT + j] += h->V * s->kappa.v * K[i][j];
  }
}

/* Scalars tested with S_I: inertia, drag, masses, heat. */
static void Scalars(const Material *mat, const PointHistory *h, const Kinematics *k, const ScalarState *s,
                    const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  const double nu[PHASE_COUNT]   = {mat->kinetics.N_h * mat->kinetics.M_w / mat->kinetics.M_h,
                                    mat->kinetics.M_g / mat->kinetics.M_h};
  const double c_f[PHASE_COUNT]  = {mat->c_w, mat->c_g};
  const Jet    mass[PHASE_COUNT] = {s->m_w, s->m_g};
  const Jet    gain              = JetShift(s->m_h, -h->m_star[0]);
  Jet          row[OUT_COUNT - OUT_M];

  row[0] = JetShift(s->m_h, h->m_s);
  for (int f = 0; f < PHASE_COUNT; f++) {
    row[1 + f]              = mass[f];
    row[OUT_MI - OUT_M + f] = JetMul(s->V, s->rho[f]);
    row[OUT_D - OUT_M + f]  = JetMul(s->V, s->drag[f]);
    row[OUT_DM - OUT_M + f] = JetShift(mass[f], -h->m_star[1 + f]);
    if (mat->reacts)
      row[OUT_DM - OUT_M + f] = JetAdd(row[OUT_DM - OUT_M + f], JetScale(nu[f], gain));
  }
  row[OUT_C - OUT_M] = s->capacity;
  row[OUT_Q - OUT_M] = mat->reacts ? JetScale(-1.0 / h->dt, JetMul(s->latent, gain)) : JetConstant(0.0);
  for (int r = 0; r < OUT_COUNT - OUT_M; r++) {
    o->out[OUT_M + r] = row[r].v;
    if (tangent)
      AddJet(o->D[OUT_M + r], 1.0, &row[r], k);
  }
  for (int f = 0; f < PHASE_COUNT; f++) { /* advected heat c Phi . g_T; needs the fluxes */
    for (int i = 0; i < 2; i++) {
      const int r = OUT_FLUX + 2 * f + i;

      o->out[OUT_Q] += c_f[f] * o->out[r] * in[IN_GT + i];
      if (!tangent)
        continue;
      for (int q = 0; q < IN_COUNT; q++)
        o->D[OUT_Q][q] += c_f[f] * in[IN_GT + i] * o->D[r][q];
      o->D[OUT_Q][IN_GT + i] += c_f[f] * o->out[r];
    }
    for (int j = 0; tangent && j < 2; j++) {
      o->wide_q[f][j] = c_f[f] * (o->wide[f][0][j] * in[IN_GT] + o->wide[f][1][j] * in[IN_GT + 1]);
    }
  }
}

static void FillState(const ScalarState *s, const Kinematics *k, const Stress *st, PointState *state)
{
  state->V       = s->V.v;
  state->phi     = s->phi.v;
  state->Sh      = s->Sh.v;
  state->Sw      = (1.0 - s->Sh.v) * s->sw.v;
  state->Sg      = (1.0 - s->Sh.v) * s->sg.v;
  state->m_h     = s->m_h.v;
  state->m_w     = s->m_w.v;
  state->m_g     = s->m_g.v;
  state->p       = s->p.v;
  state->limited = s->limited;
  for (int f = 0; f < PHASE_COUNT; f++)
    state->rho[f] = s->rho[f].v;
  for (int d = 0; d < 2; d++)
    state->stretch[d] = k->stretch[d];
  for (int c = 0; c < 6; c++)
    state->sig[c] = st->s[c];
}

ClStatus PointEvaluate(const Material *mat, const PointHistory *h, const double in[IN_COUNT], bool tangent,
                       PointState *state, PointOutput *o, const char **why)
{
  const double gradu[2][2] = {{in[0], in[1]}, {in[2], in[3]}};
  Kinematics   k;
  ScalarState  s;
  Stress       st;

  if (!KinematicsEvaluate(gradu, &k)) {
    *why = "volume ratio of the step is not positive";
    return CL_DOMAIN;
  }
  const ClStatus status = ScalarStateEvaluate(mat, h, k.J, in, &s, why);
  if (status != CL_OK)
    return status;
  if (tangent) {
    for (int r = 0; r < OUT_COUNT; r++) {
      for (int q = 0; q < IN_COUNT; q++)
        o->D[r][q] = 0.0;
    }
  }
  EffectiveStress(mat, h, &k, &s, in[IN_T], tangent, state->sig0, &st);
  Forces(h, &k, &s, &st, in, tangent, o);
  Fluxes(h, &k, &s, in, tangent, o, state->tau);
  Scalars(mat, h, &k, &s, in, tangent, o);
  FillState(&s, &k, &st, state);
  for (int r = 0; r < OUT_COUNT; r++) {
    if (!isfinite(o->out[r])) {
      *why = "a flux or force is not finite";
      return CL_NONFINITE;
    }
  }
  return CL_OK;
}
