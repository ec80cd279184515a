/* Densities, saturations, hydrate and masses of a particle; docs/equations.md (8)-(10). */
#include <string.h>
#include "clathra/point_flow.h"
#include "clathra/point_heat.h"
#include "clathra/point_state.h"
#include "state.h"

static Jet LiquidJet(const Liquid *law, Jet p, Jet T)
{
  double       dp, dT;
  const double rho = LiquidDensity(law, p.v, T.v, &dp, &dT);

  return JetChain2(rho, dp, p, dT, T);
}

/* Methane that water holds (101): where there is one pressure, none. */
static double Trace(const FieldSet *fs, const Material *mat)
{
  return fs->one_pressure ? 0.0 : mat->gas.trace;
}

static Jet FluidJet(const Material *mat, int phase, Jet p, Jet T)
{
  double       dp, dT;
  const double rho = FluidDensity(mat, phase, p.v, T.v, &dp, &dT);

  return JetChain2(rho, dp, p, dT, T);
}

/* k_r of a fluid among two, of its share of the open pores or of all of them. */
static Jet RelPermJet(const RelPerm *law, int phase, const ScalarState *s)
{
  const Jet        share = phase == PHASE_W ? s->sw : s->sg;
  const KrArgument a     = KrArgumentOf(law->of_pores, share.v, s->Sh.v);
  const Jet        x     = JetChain2(a.v, a.share, share, a.Sh, s->Sh);
  double           d;
  const double     kr = phase == PHASE_W ? RelPermWater(law, x.v, &d) : RelPermGas(law, x.v, &d);

  return JetChain(KrFloored(kr), kr < CL_MOBILITY_FLOOR ? 0.0 : d, x);
}

static Jet ViscosityJet(const Material *mat, int phase, Jet rho, Jet T)
{
  double       dT, drho = 0.0;
  const double mu =
      phase == PHASE_W ? WaterViscosity(&mat->mu_w, T.v, &dT) : GasViscosity(&mat->mu_g, rho.v, T.v, &drho, &dT);

  return JetChain2(mu, drho, rho, dT, T);
}

/* mu/k_a and k_r of the phases that flow. */
static void Mobility(const FieldSet *fs, const Material *mat, Jet T, ScalarState *s)
{
  double       dphi, dSh;
  const double k  = PermeabilityEvaluate(&mat->permeability, s->phi.v, s->Sh.v, &dphi, &dSh);
  const Jet    ka = JetChain2(k, dphi, s->phi, dSh, s->Sh);

  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue; /* a lone fluid fills the pores: k_r = 1 */
    s->kr[f]     = fs->phase[PHASE_G] ? RelPermJet(&mat->relperm, f, s) : JetConstant(1.0);
    s->resist[f] = JetDiv(ViscosityJet(mat, f, s->rho[f], T), ka);
  }
}

static void Thermal(const Material *mat, const PointHistory *h, Jet T, ScalarState *s)
{
  const double kappa[4] = {mat->kappa_s, mat->kappa_h, mat->kappa_w, mat->kappa_g};
  double       dphi, dSh, dsw, dL;
  const double k = MixtureAverage(s->phi.v, s->Sh.v, s->sw.v, kappa, &dphi, &dSh, &dsw);
  const double L = LatentHeatEvaluate(&mat->latent, T.v, &dL);

  s->kappa    = JetAdd(JetChain2(k, dphi, s->phi, dSh, s->Sh), JetChain(0.0, dsw, s->sw));
  s->capacity = JetChain3(HeatCapacity(mat, h->m_s, s->m_h.v, s->m[PHASE_W].v, s->m[PHASE_G].v), mat->c_h, s->m_h,
                          mat->c_w, s->m[PHASE_W], mat->c_g, s->m[PHASE_G]);
  s->latent   = JetChain(L, dL, T);
}

/* beta T_K of a fluid (291). */
static Jet ExpansionJet(const Material *mat, int phase, Jet p, Jet T)
{
  const Jet TK = JetShift(T, CL_ZERO_CELSIUS);
  double    dp, dT;

  if (phase == PHASE_W)
    return JetScale(mat->water.beta, TK);
  const double beta = GasExpansion(&mat->gas, p.v, T.v, &dp, &dT);
  return JetMul(JetChain2(beta, dp, p, dT, T), TK);
}

/* Young's modulus and the expansivity of skeleton and hydrate. */
static void Skeleton(const Material *mat, ScalarState *s)
{
  double            dE;
  const double      E = ElasticityYoung(&mat->elasticity, s->Sh.v, &dE);
  const Expansivity b = SolidExpansivity(mat, s->phi.v, s->Sh.v);

  s->E    = JetChain(E, dE, s->Sh);
  s->beta = JetChain2(b.v, b.phi, s->phi, b.Sh, s->Sh);
}

/* Shares of two fluids in the open pores and their mean pressure (10). */
static void Share(Jet sg, Jet pw, Jet pg, ScalarState *s)
{
  const PorePressure m = PorePressureOf(sg.v, pw.v, pg.v);

  s->sg = sg;
  s->sw = JetSub(JetConstant(1.0), sg);
  s->p  = JetChain3(m.v, m.sg, sg, m.pw, pw, m.pg, pg);
}

/* (320) */
static Jet GasShareJet(const Retention *law, Jet pc, Jet Sh)
{
  double       dpc, dSh;
  const double sg = RetentionGasShare(law, pc.v, Sh.v, &dpc, &dSh);

  return JetChain2(sg, dpc, pc, dSh, Sh);
}

/* (321): what the reaction makes of S_h if the fluids share the pores as at this S_h, less S_h itself, with its slope;
   all else is fixed. */
static double HydrateBalance(const Material *mat, const PointHistory *h, double Sh, double pw, double pg, double T,
                             double rho_h, const ScalarState *s, double *slope)
{
  ScalarState  trial = {.V = JetConstant(s->V.v), .Vp = JetConstant(s->Vp.v)};
  double       dpc, dSh;
  const double sg = RetentionGasShare(&mat->retention, pg - pw, Sh, &dpc, &dSh), full = rho_h * s->Vp.v;

  Share(JetVariable(sg, JET_J), JetConstant(pw), JetConstant(pg), &trial); /* the place of J is free for s_g */
  HydrateMass(mat, h, JetConstant(T), JetConstant(rho_h), &trial);
  *slope = trial.m_h.d[JET_J] * dSh / full - 1.0;
  return trial.m_h.v / full - Sh;
}

#define ROUNDING 4e-16 /* of S_h */

/* (321) by Newton inside a bracket: S_h, with what is left of the balance and its slope there. */
static double SolveHydrate(const Material *mat, const PointHistory *h, double pw, double pg, double T, double rho_h,
                           const ScalarState *s, double *f, double *slope)
{
  double lo = 0.0, hi = 1.0, Sh = fmin(fmax(h->m_star[0] / (rho_h * s->Vp.v), lo), hi);

  for (int it = 0; it < 100; it++) {
    *f                      = HydrateBalance(mat, h, Sh, pw, pg, T, rho_h, s, slope);
    *(*f > 0.0 ? &lo : &hi) = Sh;
    if (fabs(*f) <= ROUNDING || hi - lo <= ROUNDING)
      break;
    const double next = Sh - *f / *slope;

    Sh = next > lo && next < hi && it % 3 ? next : 0.5 * (lo + hi); /* a kink of the law would hold Newton up */
  }
  return Sh;
}

/* The slopes follow from the implicit function theorem; of the mass of hydrate what the reaction says where it is slow,
   what S_h says where it is fast, which is one Newton step more in either. */
static void ShareWithHydrate(const Material *mat, const PointHistory *h, Jet pw, Jet pg, Jet T, Jet rho_h,
                             ScalarState *s)
{
  const Jet    full = JetMul(rho_h, s->Vp), pc = JetSub(pg, pw);
  double       f, slope;
  const double found = SolveHydrate(mat, h, pw.v, pg.v, T.v, rho_h.v, s, &f, &slope);

  Share(GasShareJet(&mat->retention, pc, JetConstant(found)), pw, pg, s);
  HydrateMass(mat, h, T, rho_h, s);
  const Jet    Sh = JetChain(found - f / slope, -1.0 / slope, JetDiv(s->m_h, full)), m_h = JetMul(Sh, full);
  const double more = -(slope + 1.0) * f / slope * full.v;

  Share(GasShareJet(&mat->retention, pc, Sh), pw, pg, s);
  s->m_h.v += more;
  s->gain.v += more;
  memcpy(s->m_h.d, m_h.d, sizeof(m_h.d));
  memcpy(s->gain.d, m_h.d, sizeof(m_h.d));
}

/* Shares of the fluids in the open pores, their mean pressure, and hydrate. */
static void Saturations(const FieldSet *fs, const Material *mat, const PointHistory *h, Jet pw, Jet pg, Jet T,
                        Jet rho_h, ScalarState *s)
{
  if (!fs->phase[PHASE_G]) {
    s->sw = JetConstant(fs->phase[PHASE_W] ? 1.0 : 0.0);
    s->sg = JetConstant(0.0);
    s->p  = fs->phase[PHASE_W] ? pw : JetConstant(0.0);
  } else if (fs->one_pressure) {
    Share(JetConstant(1.0 - h->sw_n), pw, pg, s);
  } else if (mat->retention.hydrate > 0.0) {
    ShareWithHydrate(mat, h, pw, pg, T, rho_h, s);
    return;
  } else {
    Share(GasShareJet(&mat->retention, JetSub(pg, pw), JetConstant(0.0)), pw, pg, s);
  }
  HydrateMass(mat, h, T, rho_h, s);
}

static ClStatus CheckInputs(const FieldSet *fs, const Material *mat, const double in[IN_COUNT], const char **why)
{
  const bool finite = isfinite(in[IN_T]) && (!fs->phase[PHASE_W] || isfinite(in[IN_P])) &&
                      (!fs->phase[PHASE_G] || isfinite(in[IN_P + 1]));

  if (!finite) {
    *why = "pressure or temperature is not finite";
    return CL_NONFINITE;
  }
  if (fs->solid && !isfinite(in[IN_U] + in[IN_U + 1])) {
    *why = "a displacement is not finite";
    return CL_NONFINITE;
  }
  if (in[IN_T] <= -CL_ZERO_CELSIUS) {
    *why = "temperature fell to absolute zero";
    return CL_DOMAIN;
  }
  if (fs->phase[PHASE_G] && mat->gas.trace == 0.0 && in[IN_P + 1] <= 0.0) {
    *why = "gas pressure fell to zero; without_gas: yes lets gas vanish";
    return CL_DOMAIN;
  }
  return CL_OK;
}

ClStatus ScalarStateEvaluate(const FieldSet *fs, const Material *mat, const PointHistory *h, double J,
                             const double in[IN_COUNT], ScalarState *s, const char **why)
{
  const Jet pw = JetVariable(in[IN_P], JET_PW), pg = JetVariable(in[IN_P + 1], JET_PG),
            T    = JetVariable(in[IN_T], JET_T);
  const Jet zero = JetConstant(0.0), pressure[PHASE_COUNT] = {pw, pg};
  const Jet rho_s = LiquidJet(&mat->solid, zero, T), rho_h = LiquidJet(&mat->hydrate, zero, T);

  const ClStatus status = CheckInputs(fs, mat, in, why);
  if (status != CL_OK)
    return status;
  s->V   = JetScale(h->V, JetVariable(J, JET_J));
  s->Vp  = VolumeLeftJet(s->V, JetConstant(h->m_s), rho_s);
  s->phi = JetDiv(s->Vp, s->V);
  if (!(s->phi.v > 0.0)) {
    *why = "porosity fell to zero";
    return CL_DOMAIN;
  }
  Saturations(fs, mat, h, pw, pg, T, rho_h, s);

  const Jet Vf = VolumeLeftJet(s->Vp, s->m_h, rho_h);
  if (!(Vf.v > 0.0)) {
    *why = "hydrate fills the pore space";
    return CL_DOMAIN;
  }
  s->Sh         = PoreShareJet(s->m_h, rho_h, s->Vp);
  s->m[PHASE_W] = s->m[PHASE_G] = zero;
  if (fs->phase[PHASE_W]) {
    s->rho[PHASE_W] = FluidJet(mat, PHASE_W, pw, T);
    const Content c = WaterContent(s->sg.v, s->rho[PHASE_W].v);
    s->m[PHASE_W]   = JetMul(Vf, JetChain2(c.v, c.sg, s->sg, c.rho, s->rho[PHASE_W]));
  }
  if (fs->phase[PHASE_G]) {
    s->rho[PHASE_G] = FluidJet(mat, PHASE_G, pg, T);
    const Content c = MethaneContent(Trace(fs, mat), s->sg.v, s->rho[PHASE_G].v, pg.v);
    s->m[PHASE_G]   = JetMul(Vf, JetChain3(c.v, c.sg, s->sg, c.rho, s->rho[PHASE_G], c.p, pg));
  }
  if (fs->fluid)
    Mobility(fs, mat, T, s);
  if (fs->heat)
    Thermal(mat, h, T, s);
  for (int f = 0; fs->heat && h->compression && f < PHASE_COUNT; f++) {
    if (fs->phase[f])
      s->warm[f] = ExpansionJet(mat, f, pressure[f], T);
  }
  if (fs->solid)
    Skeleton(mat, s);
  return CL_OK;
}

void PointInitialMasses(const FieldSet *fs, const Material *mat, double V, double phi, double Sh, double sg, double pw,
                        double pg, double T, double *m_s, double *m_h, double *m_w, double *m_g)
{
  double       d, e;
  const bool   gas = fs->phase[PHASE_G];
  const double Vf  = V * phi * (1.0 - Sh);

  *m_s = V * (1.0 - phi) * LiquidDensity(&mat->solid, 0.0, T, &d, &e);
  *m_h = V * phi * Sh * LiquidDensity(&mat->hydrate, 0.0, T, &d, &e);
  *m_w = fs->phase[PHASE_W] ? Vf * WaterContent(sg, FluidDensity(mat, PHASE_W, pw, T, &d, &e)).v : 0.0;
  *m_g = gas ? Vf * MethaneContent(Trace(fs, mat), sg, FluidDensity(mat, PHASE_G, pg, T, &d, &e), pg).v : 0.0;
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
static void ReactionProperties(const Material *mat, const ScalarState *s, double T, PointProperties *r)
{
  const Kinetics *k = &mat->kinetics;
  double          d[2];
  const double    forms = KineticsFormationArea(k, s->sw.v, s->Sh.v, &d[0], &d[1]);
  const double    area  = fmax(forms, k->A_geo * s->phi.v * s->Sh.v);

  r->reaction      = k->M_h * KineticsRateConstant(k, T, &d[0]) * area;
  r->reaction_heat = r->reaction * LatentHeatEvaluate(&mat->latent, T, &d[0]);
}

ClStatus PointPropertiesEvaluate(const FieldSet *fs, const Material *mat, double V, double m_s, double m_h, double pw,
                                 double pg, double T, double sw_n, PointProperties *r, const char **why)
{
  const PointHistory h = {
      .V = V, .m_s = m_s, .sw_n = sw_n, .m_star = {m_h, 0.0, 0.0}, .dt = 0.0}; /* dt' = 0: no reaction */
  const double   in[IN_COUNT] = {[IN_P] = pw, [IN_P + 1] = pg, [IN_T] = T};
  ScalarState    s;
  const ClStatus status = ScalarStateEvaluate(fs, mat, &h, 1.0, in, &s, why);

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
    r->compressibility += (m->d[JET_PW] + m->d[JET_PG]) / (V * s.rho[f].v);
  }
  if (fs->heat) {
    r->capacity = s.capacity.v;
    r->kappa    = s.kappa.v;
  }
  if (fs->solid) {
    r->M = s.E.v * (2.0 * ElasticityShearFactor(&mat->elasticity) + ElasticityLameFactor(&mat->elasticity));
    r->G = s.E.v * ElasticityShearFactor(&mat->elasticity);
  }
  if (mat->reacts)
    ReactionProperties(mat, &s, T, r);
  return CL_OK;
}
