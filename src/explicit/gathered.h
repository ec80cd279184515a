/* What the particles of a block get from their nodes, and how a loop over them says that something is wrong. */
#pragma once

#include "lanes.h"

/* What a loop over particles finds wrong: of the width of its numbers, so that the loop stays vector code. */
typedef int64_t Wrong;
#define WRONG_UNLESS(condition) ((condition) ? (Wrong)0 : (Wrong)1)

typedef struct {
  double value[BLOCK][LANES], dx[BLOCK][LANES], dy[BLOCK][LANES];
} Gathered;

INLINE void Gather(const Explicit *e, Run r, const Weights *w, Gathered *g)
{
  const int stride = (int)e->m->grid.gm[0];

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];
    Lanes      v = {0.0}, x = {0.0}, y = {0.0};

    for (int b = 0; b < 3; b++) {
      const double Sy = w->S[1][b][q], Dy = w->D[1][b][q];

      for (int a = 0; a < 3; a++) {
        const Lanes row = ((const Lanes *)e->C)[slot[b * stride + a]];

        v += row * (w->S[0][a][q] * Sy);
        x += row * (w->D[0][a][q] * Sy);
        y += row * (w->S[0][a][q] * Dy);
      }
    }
    *(Lanes *)g->value[q] = v;
    *(Lanes *)g->dx[q]    = x;
    *(Lanes *)g->dy[q]    = y;
  }
}

/* Particle of a block with the largest value; NaN is larger than all. */
static inline PetscInt Worst(Run r, const double size[])
{
  int worst = 0;

  for (int q = 1; q < r.n && !isnan(size[worst]); q++) {
    if (!(size[q] <= size[worst]))
      worst = q;
  }
  return r.p + worst;
}
