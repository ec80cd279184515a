/* Private to point/: the fluids' fluxes, and what of them is tested with S_I; docs/equations.md (17)-(20). */
#pragma once

#include "tangent.h"

/* (200), (456): adds V_n rho D K (g_g - g_w) for water, takes it off for gas. */
INLINE void Spread(const PointInput *x, const Kinematics *k, const Metric *metric, const ScalarState *s, int f,
                   bool tangent, PointOutput *o)
{
  const double *in = x->in, VD = (f == PHASE_W ? x->h->V : -x->h->V) * x->h->spread[f];
  const Jet     rho = s->rho[f];
  double        c[CL_DIM];

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

/* Phi = V_n rho [ cof^T A J + tau K A (Pi g - g) ] (19), (448), g less what gravity has of it; returns tau. */
INLINE double Flux(const PointInput *x, const Kinematics *k, const Metric *metric, const ScalarState *s, int f,
                   bool tangent, PointOutput *o)
{
  const PointHistory *h    = x->h;
  const double       *in   = x->in;
  const double(*K)[CL_DIM] = metric->K;
  const Jet rho            = s->rho[f];
  const Jet kr             = f == PHASE_G && h->mobility > 0.0 ? JetConstant(h->mobility) : s->kr[f];
  const Tau t              = TauOf(kr.v, s->resist[f].v, rho.v, x->fs->inertia ? 1.0 / h->dt : 0.0);
  const Jet tau            = JetChain3(t.v, t.kr, kr, t.resist, s->resist[f], t.rho, rho);
  const Jet rt             = JetMul(rho, tau);
  double    J[CL_DIM], b[CL_DIM];

  for (int i = 0; i < CL_DIM; i++) {
    J[i] = in[VectorAt(IN_J, f, i)];
    b[i] = h->proj[f][i] - (in[VectorAt(IN_GP, f, i)] - (h->beds ? h->weight[f][i] : 0.0));
  }
  Drive(h, J);
  Drive(h, b);

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
    double *wide = o->wide[f][f][i], carried[CL_DIM];
    for (int j = 0; j < CL_DIM; j++) {
      wide[j]    = h->V * rt.v * K[i][j];
      carried[j] = h->V * rho.v * k->cof[j][i];
    }
    Drive(h, wide); /* A is symmetric */
    Drive(h, carried);
    for (int j = 0; j < CL_DIM; j++) {
      D[VectorAt(IN_J, f, j)] += carried[j];
      D[VectorAt(IN_GP, f, j)] -= wide[j];
    }
  }
  return tau.v;
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
