/* Masses of the fluids and of hydrate at the end of a step, and the heat of their change; docs/equations.md,
 * section 12. */
#pragma once

#include "clathra/laws_batch.h"
#include "clathra/point_reaction.h"
#include "gathered.h"

/* Gain of hydrate in a block's particles, what was wanted of it and what there is (40). */
INLINE void GainOf(const Explicit *e, const Set s, Run r, const Gathered *g, double *restrict wanted,
                   double *restrict gain)
{
  const double *restrict gain_0 = e->t[T_GAIN] + r.p, *restrict gain_w = e->t[T_GAIN_W] + r.p,
                         *restrict gain_g = e->t[T_GAIN_G] + r.p, *restrict gain_T = e->t[T_GAIN_T] + r.p,
                         *restrict mh = e->m->P.f[P_MH] + r.p;

  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    wanted[q] = gain_0[q] + gain_w[q] * g->value[q][0] + gain_g[q] * g->value[q][1] +
                (s.heat ? gain_T[q] * g->value[q][2] : 0.0);
    gain[q] = Largest(wanted[q], -mh[q]);
  }
}

/* Its heat, with T of t_n; what was missing goes back to the particle. */
INLINE void HeatOf(Explicit *e, const Set s, Run r, const double *restrict T, const double *restrict wanted,
                   const double *restrict gain)
{
  double *restrict now = e->m->P.f[P_T] + r.p;
  double L[BLOCK], C[BLOCK], heat[BLOCK], beyond[BLOCK];

  LatentHeatBatch(&r.mat->latent, r.n, T, L);
  Capacities(e, s, r, C);
  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    now[q] += L[q] * (gain[q] - wanted[q]) / C[q];
    heat[q]   = L[q] * wanted[q];
    beyond[q] = LatentHeatBeyond(&r.mat->latent, T[q]) * wanted[q];
  }
  e->latent += Sum(r.n, heat);
  e->beyond += Sum(r.n, beyond);
}

/* Mass of hydrate, what the fluids and heat give for it (40). */
INLINE void HydrateOf(Explicit *e, const Set s, Run r, const Gathered *g, double *restrict kept, PetscInt *limited)
{
  double *const  *f               = e->m->P.f;
  const Kinetics *kin             = &r.mat->kinetics;
  const double    nu[PHASE_COUNT] = {KineticsWater(kin), KineticsMethane(kin)};
  double         *mw = f[P_MW] + r.p, *mg = f[P_MG] + r.p, *mh = f[P_MH] + r.p; /* read by HeatOf, too */
  const double   *pw = f[P_PW] + r.p, *pg = f[P_PG] + r.p, *now = s.heat ? f[P_T] + r.p : e->t[T_T] + r.p;
  double          wanted[BLOCK], gain[BLOCK], T[BLOCK], p[PHASE_COUNT][BLOCK], rho_h[BLOCK], zero[BLOCK] = {0.0},
                                                                                    held[PHASE_COUNT][BLOCK];
  int fewer = 0;

  GainOf(e, s, r, g, wanted, gain);
  for (int q = 0; q < r.n; q++) { /* at t_n */
    T[q]          = now[q] - (s.heat ? g->value[q][2] : 0.0);
    p[PHASE_W][q] = pw[q] - g->value[q][0];
    p[PHASE_G][q] = pg[q] - g->value[q][1];
  }
  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
  PerHydrateVolume(e, r, p[PHASE_W], p[PHASE_G], held);
  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    mw[q] += Displaced(held[PHASE_W][q], rho_h[q]) * wanted[q] + nu[PHASE_W] * (wanted[q] - gain[q]);
    mg[q] += Displaced(held[PHASE_G][q], rho_h[q]) * wanted[q] + nu[PHASE_G] * (wanted[q] - gain[q]);
  }
  if (s.heat)
    HeatOf(e, s, r, T, wanted, gain);
  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    fewer += gain[q] != wanted[q];
    kept[q] = KeptHydrate(mh[q], mh[q] + gain[q]).v;
    mh[q] += gain[q];
  }
  *limited += fewer;
}

/* (40): masses of the fluids, what the laws' slopes make of the increments, so that the sum over particles is what the
   nodal balances say; the gain of hydrate likewise.  Where hydrate runs out, the missing part is taken back from the
   fluids and from the heat. */
INLINE void MassesOf(Explicit *e, const Set s, Run r, const Gathered *g, double *restrict kept, PetscInt *limited)
{
  double *const *f = e->m->P.f;

  for (int k = 0; k < s.fluids; k++) {
    double *restrict m         = f[P_MW + k] + r.p;
    const double *restrict eos = e->t[T_EOS + k] + r.p;

    for (int q = 0; q < r.n; q++)
      m[q] = eos[q];
    for (int i = 0; i < Scalars(s); i++) {
      const double *restrict slope = e->t[T_SLOPE + 3 * k + (i < s.fluids ? i : 2)] + r.p;

      INDEPENDENT
      for (int q = 0; q < r.n; q++)
        m[q] += slope[q] * g->value[q][i];
    }
  }
  if (s.fluids == 2 && r.mat->reacts)
    HydrateOf(e, s, r, g, kept, limited);
}

/* (290): what the rise of the pressures gave. */
INLINE void CountCompression(Explicit *e, const Set s, Run r, const Gathered *g)
{
  for (int k = 0; k < s.fluids; k++) {
    for (int q = 0; q < r.n; q++)
      e->squeezed += e->t[T_WARM + k][r.p + q] * g->value[q][k];
  }
}

/* (105): where a step takes p_c further than the law is straight, p_g is what belongs to the particle's methane, which
   (40) has given it: between the old one and that of the linear relation. */
INLINE void GasOfMethane(Explicit *e, const Set s, Run r, const Gathered *g)
{
  double *const *f     = e->m->P.f;
  const double   p0    = r.mat->retention.p0;
  bool           bends = false;

  for (int q = 0; q < r.n; q++)
    bends |= fabs(g->value[q][1] - g->value[q][0]) > STRAIGHT * p0;
  for (int q = 0; bends && q < r.n; q++) {
    const PetscInt p  = r.p + q;
    const double   dp = g->value[q][1], pg = f[P_PG][p], T = s.heat ? f[P_T][p] : e->t[T_T][p];
    double         drho, dT;

    if (fabs(dp - g->value[q][0]) <= STRAIGHT * p0)
      continue;
    const Pores v = PoresOf(e->t[T_V][p], f[P_MS][p], LiquidDensity(&r.mat->solid, 0.0, T, &drho, &dT), f[P_MH][p],
                            LiquidDensity(&r.mat->hydrate, 0.0, T, &drho, &dT));

    f[P_PG][p] = PointGasPressure(r.mat, f[P_MG][p] / v.open, v.Sh, f[P_PW][p], T, pg - dp, pg);
  }
}
