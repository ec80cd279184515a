/* What a particle's scalar state is asked for besides the balances: first masses, gas, properties at t_n. */
#include "state.h"

void PointInitialMasses(const FieldSet *fs, const Material *mat, double V, double phi, double Sh, double sg, double pw,
                        double pg, double T, double *m_s, double *m_h, double *m_w, double *m_g)
{
  double       d, e;
  const bool   gas = fs->phase[PHASE_G];
  const double Vf  = V * phi * (1.0 - Sh);

  *m_s = V * (1.0 - phi) * LiquidDensity(&mat->solid, 0.0, T, &d, &e);
  *m_h = V * phi * Sh * LiquidDensity(&mat->hydrate, 0.0, T, &d, &e);
  *m_w = fs->phase[PHASE_W] ? Vf * WaterContent(sg, FluidDensity(mat, PHASE_W, pw, T, &d, &e)).v : 0.0;
  *m_g = gas ? Vf * MethaneContent(mat->gas.trace, sg, FluidDensity(mat, PHASE_G, pg, T, &d, &e), pg).v : 0.0;
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

ClStatus PointPropertiesEvaluate(const FieldSet *fs, const Material *mat, double V, double m_s, double m_h, double pw,
                                 double pg, double T, PointProperties *r, const char **why)
{
  const PointHistory h = {.V = V, .m_s = m_s, .m_star = {m_h, 0.0, 0.0}, .dt = 0.0}; /* dt' = 0: no reaction */
  const double       in[IN_COUNT] = {[IN_P] = pw, [IN_P + 1] = pg, [IN_T] = T};
  ScalarState        s;
  const ClStatus     status = ScalarStateEvaluate(fs, mat, &h, 1.0, in, &s, why);

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
    r->storage[f]        = m->d[JET_PW + f] / (V * s.rho[f].v);
    r->cross[f]          = m->d[JET_PW + PHASE_G - f] / (V * s.rho[f].v);
    r->compressibility += (m->d[JET_PW] + m->d[JET_PG]) / (V * s.rho[f].v);
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
    ReactionProperties(mat, &s, pg - pw, T, r);
  return CL_OK;
}
