/* What hydrate that grows takes of every balance of (37). */
#pragma once

#include "clathra/laws_batch.h"
#include "clathra/point_reaction.h"
#include "gathered.h"

/* What a kg of hydrate gained takes off every row: kg of the fluids, and with the sign of the heat that it gives, J. */
INLINE void PerGain(const Explicit *e, const Set s, Run r, const double *restrict T, const double *restrict rho_h,
                    double c[3][BLOCK])
{
  const Kinetics *k               = &r.mat->kinetics;
  const double    nu[PHASE_COUNT] = {KineticsWater(k), KineticsMethane(k)};
  double          held[PHASE_COUNT][BLOCK], L[BLOCK];

  LatentHeatBatch(&r.mat->latent, r.n, T, L);
  PerHydrateVolume(e, r, e->m->P.f[P_PW] + r.p, e->m->P.f[P_PG] + r.p, held);
  for (int row = 0; row < Scalars(s); row++) {
    for (int q = 0; q < r.n; q++)
      c[row][q] = row < s.fluids ? nu[row] + Displaced(held[row][q], rho_h[q]) : -L[q];
  }
}
