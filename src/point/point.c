/* Stress, fluxes and their consistent tangent; docs/equations.md (14)-(21). */
#include "state.h"
#include "clathra/tensor.h"
#include <string.h>

/* Row of the tangent for a scalar output c * jet: J spreads over grad u. */
INLINE void AddJet(double D[IN_COUNT], double c, const Jet *a, const Kinematics *k)
{
  for (int i = 0; i < MOTION_COUNT; i++)
    D[IN_GRADU + i] += c * a->d[JET_J] * k->dJ[i];
  D[IN_P] += c * a->d[JET_PW];
  D[IN_P + 1] += c * a->d[JET_PG];
  D[IN_T] += c * a->d[JET_T];
}

typedef struct {
  double s[6], ds[6][IN_COUNT];
  double work, dwork[IN_COUNT]; /* dissipated in the stage, J/m^3 */
} Stress;

/* Tangent of a number of the skeleton with its derivatives d, in the inputs of the particle. */
INLINE void SkeletonRow(const double d[SKELETON_IN], const Kinematics *k, const ScalarState *s, const Jet *thermal,
                        const Jet *kept, double row[IN_COUNT])
{
  static const int component[4] = {0, 1, 3, 2}; /* of Kinematics.e */

  for (int i = 0; i < IN_COUNT; i++)
    row[i] = 0.0;
  for (int i = 0; i < MOTION_COUNT; i++) {
    row[IN_GRADU + i] = i < MOTION_HOOP ? d[SKELETON_THETA] * k->dtheta[i] : 0.0;
    for (int c = 0; c < 4; c++)
      row[IN_GRADU + i] += d[SKELETON_STRAIN + c] * k->de[component[c]][i];
  }
  AddJet(row, d[SKELETON_E], &s->E, k);
  AddJet(row, d[SKELETON_SH], &s->Sh, k);
  AddJet(row, d[SKELETON_THERMAL], thermal, k);
  AddJet(row, d[SKELETON_KEPT], kept, k);
}

/* Effective stress and its tangent; e_zz is the hoop strain, zero in plane strain. */
INLINE ClStatus EffectiveStress(const Material *mat, const PointHistory *h, const Kinematics *k, const ScalarState *s,
                                double T, bool tangent, SkeletonState *state, SkeletonStage *end, Stress *out,
                                const char **why)
{
  const Jet       thermal = JetScale(1.0 / 3.0, JetMul(s->beta, JetVariable(T - h->T_n, JET_T)));
  double          dE;
  SkeletonStep    d    = {.c       = k->c,
                          .s       = k->s,
                          .e       = {k->e[0], k->e[1], k->e[3], k->e[2]},
                          .thermal = thermal.v,
                          .E       = s->E.v,
                          .Sh      = s->Sh.v};
  const Kept      k_h  = ElasticityHasBonds(&mat->elasticity) ? KeptHydrate(h->m_star[0], s->m_h.v) : (Kept){1.0, 0.0};
  const Jet       kept = JetChain(k_h.v, k_h.m, s->m_h);
  SkeletonTangent t;

  d.E_n  = ElasticityYoung(&mat->elasticity, h->Sh_n, &dE);
  d.kept = kept.v;
  if (!SkeletonUpdate(mat, &h->skeleton, &d, state, tangent ? &t : NULL, why))
    return CL_DOMAIN;
  for (int c = 0; c < 6; c++) {
    out->s[c] = state->sig[c];
    if (tangent)
      SkeletonRow(t.d[c], k, s, &thermal, &kept, out->ds[c]);
  }
  SkeletonEndStage(&h->skeleton, &d, state, s->V.v, end);
  out->work = state->work;
  if (tangent)
    SkeletonRow(t.d[SKELETON_WORK], k, s, &thermal, &kept, out->dwork);
  return CL_OK;
}

/* Ambient pressure at the particle, with the force V grad p_a that its weight is (42). */
typedef struct {
  double p, g[CL_DIM];
} AmbientState;

INLINE AmbientState AmbientAt(const PointHistory *h, const Kinematics *k, const ScalarState *s,
                              const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  AmbientState a = {0.0, {0.0}};
  double       x[CL_DIM];

  if (!h->ambient)
    return a;
  for (int d = 0; d < CL_DIM; d++)
    x[d] = h->x[d] + in[IN_U + d];
  a.p = AmbientPressure(h->ambient, x, a.g);
  for (int i = 0; i < CL_DIM; i++) {
    o->out[OUT_A + i] = s->V.v * a.g[i];
    if (tangent)
      AddJet(o->D[OUT_A + i], a.g[i], &s->V, k);
  }
  return a;
}

/* d(cof v)_i, row i of the cofactor against v, by number q of the motion. */
INLINE double CofactorSlope(const Kinematics *k, int i, int q, const double v[CL_DIM])
{
  double sum = k->dcof[i][0][q] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += k->dcof[i][j][q] * v[j];
  return sum;
}

/* (cof^T v)_i, and its slope likewise. */
INLINE double AlongCofactor(const Kinematics *k, int i, const double v[CL_DIM])
{
  double sum = k->cof[0][i] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += k->cof[j][i] * v[j];
  return sum;
}

INLINE double AlongCofactorSlope(const Kinematics *k, int i, int q, const double v[CL_DIM])
{
  double sum = k->dcof[0][i][q] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += k->dcof[j][i][q] * v[j];
  return sum;
}

/* out = V_n (sigma' - (p - p_a) 1) cof F, in the plane and around the axis (30) (momentum of the mixture). */
INLINE void MixtureForces(const PointHistory *h, const Kinematics *k, const ScalarState *s, const Stress *st,
                          const AmbientState *a, bool tangent, PointOutput *o)
{
  const double p = s->p.v - a->p, hoop = st->s[ZZ] - p;
  double       total[CL_DIM][CL_DIM];

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      total[i][j] = st->s[voigt[i][j]] - (i == j ? p : 0.0);
  }
  o->out[OUT_HOOP] = h->V * hoop * k->cof_hoop;
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      const int row = VectorAt(OUT_P, i, j);

      o->out[row] = h->V * AlongCofactor(k, j, total[i]);
      for (int m = 0; tangent && m < CL_DIM; m++) {
        const double *ds = st->ds[voigt[i][m]], c = h->V * k->cof[m][j];

        for (int q = 0; q < IN_J; q++)
          o->D[row][q] += c * ds[q];
        if (m == i)
          AddJet(o->D[row], -c, &s->p, k);
        for (int d = 0; m == i && d < CL_DIM; d++)
          o->D[row][IN_U + d] += c * a->g[d];
        for (int q = 0; q < MOTION_COUNT; q++)
          o->D[row][q] += h->V * total[i][m] * k->dcof[m][j][q];
      }
    }
  }
  if (!tangent)
    return;
  for (int q = 0; q < IN_J; q++)
    o->D[OUT_HOOP][q] += h->V * k->cof_hoop * st->ds[ZZ][q];
  AddJet(o->D[OUT_HOOP], -h->V * k->cof_hoop, &s->p, k);
  for (int d = 0; d < CL_DIM; d++)
    o->D[OUT_HOOP][IN_U + d] += h->V * k->cof_hoop * a->g[d];
  for (int q = 0; q < MOTION_HOOP; q++)
    o->D[OUT_HOOP][q] += h->V * hoop * k->dJ[q] / k->lambda;
}

/* v := A v, with beds (306). */
INLINE void Drive(const PointHistory *h, double v[CL_DIM])
{
  if (h->beds)
    BedsDrive(h->beds, v);
}

/* out = V_n A cof F g_pi (momentum of a fluid); its columns likewise. */
INLINE void FluidForces(const PointHistory *h, const Kinematics *k, int f, const double in[IN_COUNT], bool tangent,
                        PointOutput *o)
{
  const double *g  = &in[VectorAt(IN_GP, f, 0)];
  const int     at = VectorAt(OUT_G, f, 0);

  for (int i = 0; i < CL_DIM; i++) {
    const int row = at + i;

    o->out[row] = h->V * VectorDot(k->cof[i], g);
    if (!tangent)
      continue;
    for (int j = 0; j < CL_DIM; j++)
      o->D[row][VectorAt(IN_GP, f, j)] += h->V * k->cof[i][j];
    for (int q = 0; q < MOTION_COUNT; q++)
      o->D[row][q] += h->V * CofactorSlope(k, i, q, g);
  }
  Drive(h, &o->out[at]);
  for (int q = 0; tangent && h->beds && q < IN_J; q++) {
    double slope[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      slope[d] = o->D[at + d][q];
    BedsDrive(h->beds, slope);
    for (int d = 0; d < CL_DIM; d++)
      o->D[at + d][q] = slope[d];
  }
}

/* K = cof^T cof / J (symmetric, from V F^-1 F^-T) and its derivatives. */
typedef struct {
  double K[CL_DIM][CL_DIM], d[CL_DIM][CL_DIM][MOTION_COUNT];
} Metric;

INLINE void MetricEvaluate(const Kinematics *k, bool tangent, Metric *g)
{
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      double c = k->cof[0][i] * k->cof[0][j];

      for (int m = 1; m < CL_DIM; m++)
        c += k->cof[m][i] * k->cof[m][j];
      g->K[i][j] = c / k->J;
      for (int q = 0; tangent && q < MOTION_COUNT; q++) {
        double dc = k->dcof[0][i][q] * k->cof[0][j] + k->cof[0][i] * k->dcof[0][j][q];

        for (int m = 1; m < CL_DIM; m++)
          dc += k->dcof[m][i][q] * k->cof[m][j] + k->cof[m][i] * k->dcof[m][j][q];
        g->d[i][j][q] = (dc - g->K[i][j] * k->dJ[q]) / k->J;
      }
    }
  }
}

/* d(K v)_i by number q of the motion. */
INLINE double MetricSlope(const Metric *g, int i, int q, const double v[CL_DIM])
{
  double sum = g->d[i][0][q] * v[0];

  for (int j = 1; j < CL_DIM; j++)
    sum += g->d[i][j][q] * v[j];
  return sum;
}

/* (200): adds V_n rho D K (g_g - g_w) for water, takes it off for gas. */
INLINE void Spread(const PointHistory *h, const Kinematics *k, const Metric *metric, const ScalarState *s, int f,
                   const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  const double VD  = (f == PHASE_W ? h->V : -h->V) * h->spread[f];
  const Jet    rho = s->rho[f];
  double       c[CL_DIM];

  if (VD == 0.0)
    return;
  for (int i = 0; i < CL_DIM; i++)
    c[i] = in[VectorAt(IN_GP, PHASE_G, i)] - in[VectorAt(IN_GP, PHASE_W, i)];
  for (int i = 0; i < CL_DIM; i++) {
    const double Kc = VectorDot(metric->K[i], c);
    double      *D  = o->D[VectorAt(OUT_FLUX, f, i)];

    o->out[VectorAt(OUT_FLUX, f, i)] += VD * rho.v * Kc;
    if (!tangent)
      continue;
    AddJet(D, VD * Kc, &rho, k);
    for (int q = 0; q < MOTION_COUNT; q++)
      D[q] += VD * rho.v * MetricSlope(metric, i, q, c);
    for (int j = 0; j < CL_DIM; j++) {
      D[VectorAt(IN_GP, PHASE_G, j)] += VD * rho.v * metric->K[i][j];
      D[VectorAt(IN_GP, PHASE_W, j)] -= VD * rho.v * metric->K[i][j];
    }
  }
}

/* Phi = V_n rho [ cof^T J + tau K (Pi g - g) ] (19), (309). */
INLINE void Flux(const FieldSet *fs, const PointHistory *h, const Kinematics *k, const Metric *metric,
                 const ScalarState *s, int f, const double in[IN_COUNT], bool tangent, PointOutput *o, double *tau_out)
{
  const double(*K)[CL_DIM] = metric->K;
  const Jet     rho        = s->rho[f];
  const Jet     kr         = f == PHASE_G && h->mobility > 0.0 ? JetConstant(h->mobility) : s->kr[f];
  const Tau     t          = TauOf(kr.v, s->resist[f].v, rho.v, fs->inertia ? 1.0 / h->dt : 0.0);
  const Jet     tau        = JetChain3(t.v, t.kr, kr, t.resist, s->resist[f], t.rho, rho);
  const Jet     rt         = JetScale(h->bracket, JetMul(rho, tau));
  const double *J          = &in[VectorAt(IN_J, f, 0)];
  double        g[CL_DIM], b[CL_DIM];

  for (int i = 0; i < CL_DIM; i++)
    g[i] = in[VectorAt(IN_GP, f, i)];
  if (h->beds)
    BedsDriveMoving(h->beds, h->weight[f], g);
  for (int i = 0; i < CL_DIM; i++)
    b[i] = h->proj[f][i] - g[i];

  *tau_out = tau.v;
  for (int i = 0; i < CL_DIM; i++) {
    const int    row = VectorAt(OUT_FLUX, f, i);
    const double cJ = AlongCofactor(k, i, J), Kb = VectorDot(K[i], b);

    o->out[row] = MassFlux(h->V, rho.v, rt.v, cJ, Kb);
    if (!tangent)
      continue;
    double *D = o->D[row];
    AddJet(D, h->V * cJ, &rho, k);
    AddJet(D, h->V * Kb, &rt, k);
    for (int q = 0; q < MOTION_COUNT; q++) {
      D[q] += h->V * rho.v * AlongCofactorSlope(k, i, q, J);
      D[q] += h->V * rt.v * MetricSlope(metric, i, q, b);
    }
    double slope[CL_DIM];
    for (int j = 0; j < CL_DIM; j++) {
      slope[j] = h->V * rt.v * K[i][j];
      D[VectorAt(IN_J, f, j)] += h->V * rho.v * k->cof[j][i];
      o->wide[f][f][i][j] = slope[j];
    }
    Drive(h, slope); /* A is symmetric */
    for (int j = 0; j < CL_DIM; j++)
      D[VectorAt(IN_GP, f, j)] -= slope[j];
  }
}

/* (352): adds H p_g/rho_w Phi_w, the methane that the water carries. */
INLINE void CarriedFlux(const Material *mat, const Kinematics *k, const ScalarState *s, const double in[IN_COUNT],
                        bool tangent, PointOutput *o)
{
  const double H = mat->gas.carried, pg = in[IN_P + PHASE_G];
  const Jet    rho   = s->rho[PHASE_W];
  const double c     = CarriedShare(H, pg, rho.v);
  const Jet    share = JetChain2(c, H / rho.v, JetVariable(pg, JET_PG), -c / rho.v, rho);

  for (int i = 0; i < CL_DIM; i++) {
    const int    row = VectorAt(OUT_FLUX, PHASE_G, i), of = VectorAt(OUT_FLUX, PHASE_W, i);
    const double water = o->out[of];

    o->out[row] += share.v * water;
    if (!tangent)
      continue;
    AddJet(o->D[row], water, &share, k);
    for (int q = 0; q < IN_COUNT; q++)
      o->D[row][q] += share.v * o->D[of][q];
    for (int j = 0; j < CL_DIM; j++)
      o->wide[PHASE_G][PHASE_W][i][j] = share.v * o->wide[PHASE_W][PHASE_W][i][j];
  }
}

/* Conduction: V kappa F^-1 F^-T g_T, and what carries heat with the flow, (293) on the configuration at t_n. */
INLINE void Conduction(const PointHistory *h, const Kinematics *k, const Metric *metric, const ScalarState *s,
                       const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  for (int i = 0; i < CL_DIM; i++) {
    const double Kg         = VectorDot(metric->K[i], &in[IN_GT]);
    const double up[CL_DIM] = {i ? h->upwind[2] : h->upwind[0], i ? h->upwind[1] : h->upwind[2]};

    o->out[OUT_HEAT + i] = h->V * (s->kappa.v * Kg + VectorDot(up, &in[IN_GT]));
    if (!tangent)
      continue;
    double *D = o->D[OUT_HEAT + i];
    AddJet(D, h->V * Kg, &s->kappa, k);
    for (int q = 0; q < MOTION_COUNT; q++)
      D[q] += h->V * s->kappa.v * MetricSlope(metric, i, q, &in[IN_GT]);
    for (int j = 0; j < CL_DIM; j++)
      D[IN_GT + j] += h->V * (s->kappa.v * metric->K[i][j] + up[j]);
  }
}

INLINE void PutScalar(int r, Jet value, const Kinematics *k, bool tangent, PointOutput *o)
{
  o->out[r] = value.v;
  if (tangent)
    AddJet(o->D[r], 1.0, &value, k);
}

/* Scalars of one fluid tested with S_I: mass, inertia, drag, what hydrate gives. */
INLINE void FluidScalars(const Material *mat, const PointHistory *h, const Kinematics *k, const ScalarState *s, int f,
                         bool tangent, PointOutput *o)
{
  const Jet    mass = s->m[f];
  const double nu   = KineticsFluid(&mat->kinetics, f);
  const double root = sqrt(s->kr[f].v);
  Jet          dm   = JetShift(mass, -h->m_star[1 + f]);

  if (mat->reacts)
    dm = JetAdd(dm, JetScale(nu, s->gain));
  PutScalar(OUT_M + 1 + f, mass, k, tangent, o);
  PutScalar(OUT_MI + f, JetMul(s->V, s->rho[f]), k, tangent, o);
  PutScalar(OUT_D + f, JetMul(s->V, s->resist[f]), k, tangent, o);
  PutScalar(OUT_ROOT + f, JetChain(root, 0.5 / root, s->kr[f]), k, tangent, o);
  PutScalar(OUT_DM + f, dm, k, tangent, o);
}

/* Heat stored, released and advected, c Phi . g_T; needs the fluxes. */
INLINE void Heat(const FieldSet *fs, const Material *mat, const PointHistory *h, const Kinematics *k,
                 const ScalarState *s, const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  PutScalar(OUT_C, s->capacity, k, tangent, o);
  PutScalar(OUT_Q, mat->reacts ? JetScale(-1.0 / h->dt, JetMul(s->latent, s->gain)) : JetConstant(0.0), k, tangent, o);
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++) {
    const double c_f = SpecificHeat(mat, f);

    if (!fs->phase[f])
      continue;
    o->out[OUT_Q] += AdvectedHeat(c_f, &o->out[VectorAt(OUT_FLUX, f, 0)], &in[IN_GT]);
    for (int i = 0; tangent && i < CL_DIM; i++) {
      const int r = VectorAt(OUT_FLUX, f, i);

      for (int q = 0; q < IN_COUNT; q++)
        o->D[OUT_Q][q] += c_f * in[IN_GT + i] * o->D[r][q];
      o->D[OUT_Q][IN_GT + i] += c_f * o->out[r];
    }
    for (int of = 0; tangent && of < PHASE_COUNT; of++) {
      for (int j = 0; j < CL_DIM; j++)
        o->wide_q[of][j] += AdvectedHeat(c_f, (double[]){o->wide[f][of][0][j], o->wide[f][of][1][j]}, &in[IN_GT]);
    }
  }
}

/* (290) of one fluid: what its compression and throttling take of OUT_Q; needs its flux. */
INLINE void CompressionHeat(const PointHistory *h, const Kinematics *k, const ScalarState *s, int f,
                            const double in[IN_COUNT], bool tangent, PointState *state, PointOutput *o)
{
  const Jet        p = JetVariable(in[IN_P + f], JET_PW + f), rho = s->rho[f];
  const Jet        volume = JetDiv(s->m[f], rho);
  const Jet        rise   = JetScale(-1.0 / h->dt, JetMul(JetMul(volume, s->warm[f]), JetShift(p, -h->p_star[f])));
  const Throttling t      = ThrottlingOf(s->warm[f].v, rho.v);
  const Jet        share  = JetChain2(t.v, t.warm, s->warm[f], t.rho, rho);
  const double    *g = &in[VectorAt(IN_GP, f, 0)], *flux = &o->out[VectorAt(OUT_FLUX, f, 0)], *b = h->gravity;
  double           fall[CL_DIM], *D = o->D[OUT_Q];

  for (int i = 0; i < CL_DIM; i++) {
    fall[i] = k->F[0][i] * b[0];
    for (int j = 1; j < CL_DIM; j++)
      fall[i] += k->F[j][i] * b[j];
  }
  const double sum = rise.v + ThrottledHeat(share.v, flux, g, fall);
  for (int i = 0; tangent && i < CL_DIM; i++) {
    const double head = share.v * g[i] - fall[i];

    for (int q = 0; q < IN_COUNT; q++)
      D[q] += head * o->D[VectorAt(OUT_FLUX, f, i)][q];
    for (int j = 0; j < CL_DIM; j++) {
      for (int of = 0; of < PHASE_COUNT; of++)
        o->wide_q[of][j] += head * o->wide[f][of][i][j];
      D[VectorAt(IN_GRADU, j, i)] -= flux[i] * b[j];
    }
    D[VectorAt(IN_GP, f, i)] += flux[i] * share.v;
  }
  o->out[OUT_Q] += sum;
  state->squeezed -= sum;
  if (!tangent)
    return;
  AddJet(D, 1.0, &rise, k);
  AddJet(D, VectorDot(flux, g), &share, k);
}

/* (69) */
INLINE void PlasticHeat(const Material *mat, const PointHistory *h, const Kinematics *k, const ScalarState *s,
                        const Stress *st, bool tangent, PointOutput *o)
{
  const double share = -mat->plasticity.heat / h->dt;

  if (mat->plasticity.type == PLASTICITY_NONE || share == 0.0)
    return;
  o->out[OUT_Q] += share * s->V.v * st->work;
  if (!tangent)
    return;
  AddJet(o->D[OUT_Q], share * st->work, &s->V, k);
  for (int q = 0; q < IN_COUNT; q++)
    o->D[OUT_Q][q] += share * s->V.v * st->dwork[q];
}

INLINE void FillState(const FieldSet *fs, const ScalarState *s, PointState *state)
{
  state->V        = s->V.v;
  state->phi      = s->phi.v;
  state->Sh       = s->Sh.v;
  state->Sw       = (1.0 - s->Sh.v) * s->sw.v;
  state->Sg       = (1.0 - s->Sh.v) * s->sg.v;
  state->m_h      = s->m_h.v;
  state->m_w      = s->m[PHASE_W].v;
  state->m_g      = s->m[PHASE_G].v;
  state->p        = s->p.v;
  state->limited  = s->limited;
  state->squeezed = 0.0;
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++)
    state->rho[f] = fs->phase[f] ? s->rho[f].v : 0.0;
}

INLINE ClStatus CheckFinite(const FieldSet *fs, const PointOutput *o, const char **why)
{
  double sum = 0.0; /* of the rows that every set's outputs lead into */

  for (int r = OUT_FLUX; fs->fluid && r < OUT_HEAT; r++)
    sum += fs->phase[(r - OUT_FLUX) / CL_DIM] ? o->out[r] : 0.0;
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++)
    sum += fs->phase[f]
               ? o->out[VectorAt(OUT_G, f, 0)] + o->out[VectorAt(OUT_G, f, 1)] + o->out[OUT_D + f] + o->out[OUT_DM + f]
               : 0.0;
  for (int r = OUT_P; fs->solid && r < OUT_P + CL_DIM * CL_DIM; r++)
    sum += o->out[r];
  if (fs->heat)
    sum += o->out[OUT_HEAT] + o->out[OUT_HEAT + 1] + o->out[OUT_C] + o->out[OUT_Q];
  if (isfinite(sum))
    return CL_OK;
  *why = "a flux or force is not finite";
  return CL_NONFINITE;
}

/* The motion of a particle that does not move. */
static const Kinematics at_rest = {
    .F        = {{1.0, 0.0}, {0.0, 1.0}},
    .lambda   = 1.0,
    .J        = 1.0,
    .cof      = {{1.0, 0.0}, {0.0, 1.0}},
    .cof_hoop = 1.0,
    .c        = 1.0,
    .stretch  = {1.0, 1.0},
};

INLINE ClStatus Evaluate(const FieldSet *fs, const Material *mat, const PointHistory *h, const double in[IN_COUNT],
                         bool tangent, PointState *state, PointOutput *o, const char **why)
{
  Kinematics        moved;
  const Kinematics *k = &at_rest;
  ScalarState       s;
  Metric            metric;
  Stress            st;

  st.work = 0.0;
  if (fs->solid) {
    if (!(tangent ? KinematicsEvaluate(&in[IN_GRADU], &moved) : KinematicsValues(&in[IN_GRADU], &moved))) {
      *why = "volume ratio of the step is not positive";
      return CL_DOMAIN;
    }
    k = &moved;
  }
  const ClStatus status = ScalarStateEvaluate(fs, mat, h, k->J, in, &s, why);
  if (status != CL_OK)
    return status;
  if (tangent) {
    for (int r = 0; r < OUT_COUNT; r++) {
      for (int q = 0; q < IN_COUNT; q++)
        o->D[r][q] = 0.0;
    }
    memcpy(o->dJ, k->dJ, sizeof(o->dJ));
    memset(o->wide, 0, sizeof(o->wide));
    memset(o->wide_q, 0, sizeof(o->wide_q));
  }
  FillState(fs, &s, state);
  PutScalar(OUT_M, JetShift(s.m_h, h->m_s), k, tangent, o);
  if (fs->solid) {
    const ClStatus strained =
        EffectiveStress(mat, h, k, &s, in[IN_T], tangent, &state->skeleton, &state->end, &st, why);
    if (strained != CL_OK)
      return strained;
    const AmbientState a = AmbientAt(h, k, &s, in, tangent, o);
    MixtureForces(h, k, &s, &st, &a, tangent, o);
    for (int d = 0; d < CL_DIM; d++)
      state->stretch[d] = k->stretch[d];
  }
  memcpy(state->F, k->F, sizeof(state->F));
  if (fs->fluid || fs->heat)
    MetricEvaluate(k, tangent, &metric);
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    FluidForces(h, k, f, in, tangent, o);
    Flux(fs, h, k, &metric, &s, f, in, tangent, o, &state->tau[f]);
    Spread(h, k, &metric, &s, f, in, tangent, o);
    FluidScalars(mat, h, k, &s, f, tangent, o);
  }
  if (fs->phase[PHASE_W] && fs->phase[PHASE_G] && mat->gas.carried > 0.0)
    CarriedFlux(mat, k, &s, in, tangent, o);
  if (fs->heat) {
    Conduction(h, k, &metric, &s, in, tangent, o);
    Heat(fs, mat, h, k, &s, in, tangent, o);
#pragma GCC unroll 2
    for (int f = 0; f < PHASE_COUNT; f++) {
      if (h->compression && fs->phase[f])
        CompressionHeat(h, k, &s, f, in, tangent, state, o);
    }
    if (fs->solid)
      PlasticHeat(mat, h, k, &s, &st, tangent, o);
  }
  return CheckFinite(fs, o, why);
}

/* The residual pays for no slope: each form is compiled by itself. */
ClStatus PointEvaluate(const FieldSet *fs, const Material *mat, const PointHistory *h, const double in[IN_COUNT],
                       bool tangent, PointState *state, PointOutput *o, const char **why)
{
  return tangent ? Evaluate(fs, mat, h, in, true, state, o, why) : Evaluate(fs, mat, h, in, false, state, o, why);
}
