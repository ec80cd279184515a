/* Private to point/: densities, saturations, hydrate and masses of a particle; docs/equations.md (8)-(10).  Taken in
   whole, so that slopes that nobody reads cost nothing. */
#pragma once

#include "clathra/point_flow.h"
#include "clathra/point_heat.h"
#include "clathra/point_state.h"
#include "reaction.h"

INLINE Jet LiquidJet(const Liquid *law, Jet p, Jet T)
{
  double       dp, dT;
  const double rho = LiquidDensity(law, p.v, T.v, &dp, &dT);

  return JetChain2(rho, dp, p, dT, T);
}

INLINE Jet FluidJet(const Material *mat, int phase, Jet p, Jet T)
{
  double       dp, dT;
  const double rho = FluidDensity(mat, phase, p.v, T.v, &dp, &dT);

  return JetChain2(rho, dp, p, dT, T);
}

/* k_r of a fluid among two, of its share of the open pores or of all of them. */
INLINE Jet RelPermJet(const RelPerm *law, int phase, const ScalarState *s)
{
  const Jet        share = phase == PHASE_W ? s->sw : s->sg;
  const KrArgument a     = KrArgumentOf(law->of_pores, share.v, s->Sh.v);
  const Jet        x     = JetChain2(a.v, a.share, share, a.Sh, s->Sh);
  double           d;
  const double     kr = phase == PHASE_W ? RelPermWater(law, x.v, &d) : RelPermGas(law, x.v, &d);

  return JetChain(KrFloored(kr), kr < CL_MOBILITY_FLOOR ? 0.0 : d, x);
}

INLINE Jet ViscosityJet(const Material *mat, int phase, Jet rho, Jet T)
{
  double       dT, drho = 0.0;
  const double mu =
      phase == PHASE_W ? WaterViscosity(&mat->mu_w, T.v, &dT) : GasViscosity(&mat->mu_g, rho.v, T.v, &drho, &dT);

  return JetChain2(mu, drho, rho, dT, T);
}

/* mu/k_a and k_r of the phases that flow. */
INLINE void Mobility(const FieldSet *fs, const Material *mat, Jet T, ScalarState *s)
{
  double       dphi, dSh;
  const double k  = PermeabilityEvaluate(&mat->permeability, s->phi.v, s->Sh.v, &dphi, &dSh);
  const Jet    ka = JetChain2(k, dphi, s->phi, dSh, s->Sh);

#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue; /* a lone fluid fills the pores: k_r = 1 */
    s->kr[f]     = fs->phase[PHASE_G] ? RelPermJet(&mat->relperm, f, s) : JetConstant(1.0);
    s->resist[f] = JetDiv(ViscosityJet(mat, f, s->rho[f], T), ka);
  }
}

INLINE void Thermal(const Material *mat, const PointHistory *h, Jet T, ScalarState *s)
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
INLINE Jet ExpansionJet(const Material *mat, int phase, Jet p, Jet T)
{
  const Jet TK = JetShift(T, CL_ZERO_CELSIUS);
  double    dp, dT;

  if (phase == PHASE_W)
    return JetScale(mat->water.beta, TK);
  const double beta = GasExpansion(&mat->gas, p.v, T.v, &dp, &dT);
  return JetMul(JetChain2(beta, dp, p, dT, T), TK);
}

/* Young's modulus and the expansivity of skeleton and hydrate. */
INLINE void Skeleton(const Material *mat, ScalarState *s)
{
  double            dE;
  const double      E = ElasticityYoung(&mat->elasticity, s->Sh.v, &dE);
  const Expansivity b = SolidExpansivity(mat, s->phi.v, s->Sh.v);

  s->E    = JetChain(E, dE, s->Sh);
  s->beta = JetChain2(b.v, b.phi, s->phi, b.Sh, s->Sh);
}

/* Shares of two fluids in the open pores and their mean pressure (10). */
INLINE void Share(Jet sg, Jet pw, Jet pg, ScalarState *s)
{
  const PorePressure m = PorePressureOf(sg.v, pw.v, pg.v);

  s->sg = sg;
  s->sw = JetSub(JetConstant(1.0), sg);
  s->p  = JetChain3(m.v, m.sg, sg, m.pw, pw, m.pg, pg);
}

/* Share of gas in pores that hydrate narrows (320). */
INLINE Jet GasShareJet(const Retention *law, Jet pc, Jet Sh)
{
  double       dpc, dSh;
  const double sg = RetentionGasShare(law, pc.v, Sh.v, &dpc, &dSh);

  return JetChain2(sg, dpc, pc, dSh, Sh);
}

/* Shares of the open pores when hydrate narrows them as at this S_h (320). */
INLINE void ShareBeside(const Material *mat, Jet Sh, ScalarState *s)
{
  Share(GasShareJet(&mat->retention, JetSub(s->pg, s->pw), Sh), s->pw, s->pg, s);
}

/* (321): what the reaction makes of S_h if the fluids share the pores as at this S_h, less S_h itself, with its slope;
   all else is fixed. */
INLINE double HydrateBalance(const Material *mat, const PointHistory *h, double Sh, const ScalarState *s, double *slope)
{
  ScalarState  trial = {.pw    = JetConstant(s->pw.v),
                        .pg    = JetConstant(s->pg.v),
                        .T     = JetConstant(s->T.v),
                        .rho_h = JetConstant(s->rho_h.v),
                        .V     = JetConstant(s->V.v),
                        .Vp    = JetConstant(s->Vp.v)};
  const double full  = s->rho_h.v * s->Vp.v;

  ShareBeside(mat, JetVariable(Sh, JET_J), &trial); /* the place of J is free for S_h */
  HydrateMass(mat, h, &trial);
  *slope = trial.m_h.d[JET_J] / full - 1.0;
  return trial.m_h.v / full - Sh;
}

#define ROUNDING 4e-16 /* of S_h */

/* (321) by Newton inside a bracket: S_h, with what is left of the balance and its slope there. */
INLINE double SolveHydrate(const Material *mat, const PointHistory *h, const ScalarState *s, double *f, double *slope)
{
  double lo = 0.0, hi = 1.0, Sh = fmin(fmax(h->m_star[0] / (s->rho_h.v * s->Vp.v), lo), hi);

  for (int it = 0; it < 100; it++) {
    *f                      = HydrateBalance(mat, h, Sh, s, slope);
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
INLINE void ShareWithHydrate(const Material *mat, const PointHistory *h, ScalarState *s)
{
  const Jet    full = JetMul(s->rho_h, s->Vp);
  double       f, slope;
  const double found = SolveHydrate(mat, h, s, &f, &slope);

  ShareBeside(mat, JetConstant(found), s);
  HydrateMass(mat, h, s);
  const Jet    Sh = JetChain(found - f / slope, -1.0 / slope, JetDiv(s->m_h, full)), m_h = JetMul(Sh, full);
  const double more = -(slope + 1.0) * f / slope * full.v;

  ShareBeside(mat, Sh, s);
  s->m_h  = (Jet){s->m_h.v + more, m_h.d};
  s->gain = (Jet){s->gain.v + more, m_h.d};
}

/* Shares of the fluids in the open pores, their mean pressure, and hydrate. */
INLINE void Saturations(const FieldSet *fs, const Material *mat, const PointHistory *h, ScalarState *s)
{
  if (!fs->phase[PHASE_G]) {
    s->sw = JetConstant(fs->phase[PHASE_W] ? 1.0 : 0.0);
    s->sg = JetConstant(0.0);
    s->p  = fs->phase[PHASE_W] ? s->pw : JetConstant(0.0);
  } else if (mat->retention.hydrate > 0.0) {
    ShareWithHydrate(mat, h, s);
    return;
  } else {
    ShareBeside(mat, JetConstant(0.0), s);
  }
  HydrateMass(mat, h, s);
}

INLINE ClStatus CheckInputs(const FieldSet *fs, const Material *mat, const double in[IN_COUNT], const char **why)
{
  const bool finite = isfinite(in[IN_T]) && (!fs->phase[PHASE_W] || isfinite(in[IN_P])) &&
                      (!fs->phase[PHASE_G] || isfinite(in[IN_P + 1]));

  if (!finite) {
    *why = "pressure or temperature is not finite";
    return CL_NONFINITE;
  }
  if (fs->solid && !isfinite(VectorDot(&in[IN_U], &in[IN_U]))) {
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

/* Only what the fields of the set need is filled, the rest is zero. */
INLINE ClStatus ScalarStateEvaluate(const PointInput *x, double J, ScalarState *s, const char **why)
{
  const FieldSet     *fs  = x->fs;
  const Material     *mat = x->mat;
  const PointHistory *h   = x->h;
  const double       *in  = x->in;
  const Jet           pw = JetVariable(in[IN_P], JET_PW), pg = JetVariable(in[IN_P + 1], JET_PG),
            T    = JetVariable(in[IN_T], JET_T);
  const Jet zero = JetConstant(0.0), pressure[PHASE_COUNT] = {pw, pg};
  const Jet rho_s = LiquidJet(&mat->solid, zero, T), rho_h = LiquidJet(&mat->hydrate, zero, T);

  const ClStatus status = CheckInputs(fs, mat, in, why);
  if (status != CL_OK)
    return status;
  *s     = (ScalarState){.pw = pw, .pg = pg, .T = T, .rho_h = rho_h, .V = JetScale(h->V, JetVariable(J, JET_J))};
  s->Vp  = VolumeLeftJet(s->V, JetConstant(h->m_s), rho_s);
  s->phi = JetDiv(s->Vp, s->V);
  const bool filled = fs->fluid || h->m_star[0] > 0.0; /* nothing else needs pores */
  if (filled && !(s->phi.v > 0.0)) {
    *why = "porosity fell to zero";
    return CL_DOMAIN;
  }
  Saturations(fs, mat, h, s);

  const Jet Vf = VolumeLeftJet(s->Vp, s->m_h, rho_h);
  if (filled && !(Vf.v > 0.0)) {
    *why = "hydrate fills the pore space";
    return CL_DOMAIN;
  }
  s->Sh         = filled ? PoreShareJet(s->m_h, rho_h, s->Vp) : zero;
  s->m[PHASE_W] = s->m[PHASE_G] = zero;
  if (fs->phase[PHASE_W]) {
    s->rho[PHASE_W] = FluidJet(mat, PHASE_W, pw, T);
    const Content c = WaterContent(s->sg.v, s->rho[PHASE_W].v);
    s->m[PHASE_W]   = JetMul(Vf, JetChain2(c.v, c.sg, s->sg, c.rho, s->rho[PHASE_W]));
  }
  if (fs->phase[PHASE_G]) {
    s->rho[PHASE_G] = FluidJet(mat, PHASE_G, pg, T);
    const Content c = MethaneContent(mat->gas.trace, s->sg.v, s->rho[PHASE_G].v, pg.v);
    s->m[PHASE_G]   = JetMul(Vf, JetChain3(c.v, c.sg, s->sg, c.rho, s->rho[PHASE_G], c.p, pg));
    if (GasFlowsByWater(mat->gas.trace, pw.v, pg.v))
      s->rho[PHASE_G] = FluidJet(mat, PHASE_G, JetScale(CL_GAS_FLOWS, pw), T);
  }
  if (fs->fluid)
    Mobility(fs, mat, T, s);
  if (fs->heat)
    Thermal(mat, h, T, s);
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (fs->heat && h->compression && fs->phase[f])
      s->warm[f] = ExpansionJet(mat, f, pressure[f], T);
  }
  if (fs->solid)
    Skeleton(mat, s);
  return CL_OK;
}
