/* What a particle's scalar state is asked for besides the balances: first masses, gas, properties at t_n. */
#include "state.h"

void PointInitialMasses(const FieldSet *fs, const Material *mat, const PointStart *x, double m[4])
{
  double       d, e;
  const double Vf = x->V * x->phi * (1.0 - x->Sh);

  m[0] = x->V * (1.0 - x->phi) * LiquidDensity(&mat->solid, 0.0, x->T, &d, &e);
  m[1] = x->V * x->phi * x->Sh * LiquidDensity(&mat->hydrate, 0.0, x->T, &d, &e);
  m[2] = m[3] = 0.0;
  if (fs->phase[PHASE_W])
    m[2] = Vf * WaterContent(x->sg, FluidDensity(mat, PHASE_W, x->pw, x->T, &d, &e)).v;
  if (fs->phase[PHASE_G])
    m[3] = Vf * MethaneContent(mat->gas.trace, x->sg, FluidDensity(mat, PHASE_G, x->pg, x->T, &d, &e), x->pg).v;
}

double PointMethane(const Material *mat, double Sh, double pw, double pg, double T, double slope[PHASE_COUNT])
{
  double       ds, ds_dSh, rho_p, rho_T;
  const double sg   = RetentionGasShare(&mat->retention, pg - pw, Sh, &ds, &ds_dSh),
               rho  = GasDensity(&mat->gas, pg, T, &rho_p, &rho_T);
  const FluidMass m = MassOf(MethaneContent(mat->gas.trace, sg, rho, pg), 1.0, 0.0, ds, 0.0, rho_p, rho_T);

  slope[PHASE_W] = m.other;
  slope[PHASE_G] = m.own;
  return m.v;
}

#define CLOSE 1e-4 /* of p_0 */

double PointGasPressure(const Material *mat, double want, double Sh, double pw, double T, double a, double b)
{
  double       slope[PHASE_COUNT], lo = fmin(a, b), hi = fmax(a, b);
  const double close = CLOSE * mat->retention.p0;

  if ((PointMethane(mat, Sh, pw, lo, T, slope) - want) * (PointMethane(mat, Sh, pw, hi, T, slope) - want) >= 0.0)
    return b;
  while (hi - lo > close + 4.0 * PETSC_MACHINE_EPSILON * fabs(hi)) {
    const double mid = 0.5 * (lo + hi);

    if (PointMethane(mat, Sh, pw, mid, T, slope) < want)
      lo = mid;
    else
      hi = mid;
  }
  return 0.5 * (lo + hi);
}

/* Rate of the reaction for 1 Pa off equilibrium, whichever way it goes. */
static void ReactionProperties(const Material *mat, const ScalarState *s, double pc, double T, PointProperties *r)
{
  const Kinetics *k = &mat->kinetics;
  double          d;
  const double    wet   = ReactionWet(mat, s->phi.v, s->Sh.v, pc, 0.0).v;
  const double    forms = KineticsFormationArea(k, s->sw.v, wet, s->Sh.v).v;
  const double    area  = fmax(forms, KineticsMeltingArea(k, s->phi.v, s->Sh.v));

  r->reaction      = k->M_h * KineticsRateConstant(k, T, &d) * area;
  r->reaction_heat = r->reaction * LatentHeatEvaluate(&mat->latent, T, &d);
}

ClStatus PointPropertiesEvaluate(const FieldSet *fs, const Material *mat, const PointContents *x, PointProperties *r,
                                 const char **why)
{
  const PointHistory h = {.V = x->V, .m_s = x->m_s, .m_star = {x->m_h, 0.0, 0.0}, .dt = 0.0}; /* dt' = 0: no reaction */
  const double       in[IN_COUNT] = {[IN_P] = x->pw, [IN_P + 1] = x->pg, [IN_T] = x->T};
  ScalarState        s;
  const ClStatus     status = ScalarStateEvaluate(&(PointInput){fs, mat, &h, in}, 1.0, &s, why);

  if (status != CL_OK)
    return status;
  *r = (PointProperties){.s = {s.sw.v, s.sg.v}, .phi = s.phi.v, .Sh = s.Sh.v};
  for (int f = 0; f < PHASE_COUNT; f++) {
    const Jet *m = &s.m[f];

    if (!fs->phase[f])
      continue;
    r->rho[f]            = s.rho[f].v;
    r->resist[f]         = s.resist[f].v;
    r->kr[f]             = s.kr[f].v;
    const Jet mobility   = JetDiv(s.kr[f], s.resist[f]);
    r->mobility_slope[f] = 0.5 * (mobility.d[JET_PG] - mobility.d[JET_PW]);
    r->storage[f]        = m->d[JET_PW + f] / (x->V * s.rho[f].v);
    r->cross[f]          = m->d[JET_PW + PHASE_G - f] / (x->V * s.rho[f].v);
    r->compressibility += (m->d[JET_PW] + m->d[JET_PG]) / (x->V * s.rho[f].v);
  }
  if (fs->heat) {
    r->capacity = s.capacity.v;
    r->kappa    = s.kappa.v;
  }
  if (fs->solid) {
    r->M = s.E.v * ElasticityConstrainedFactor(&mat->elasticity);
    r->G = s.E.v * ElasticityShearFactor(&mat->elasticity);
  }
  if (mat->reacts)
    ReactionProperties(mat, &s, x->pg - x->pw, x->T, r);
  return CL_OK;
}
