/* Weights (3), (4) of a block of particles. */
#include "lanes.h"

INLINE void Axes(const Explicit *e, Run r, int d, bool linear, Weights *w, int *restrict base)
{
  const Grid  *g     = &e->m->grid;
  const double lower = g->lower[d], h = g->h[d], cells = (double)g->cells[d];
  const double *restrict x = e->m->P.f[P_X + d] + r.p, *restrict l = e->m->P.f[P_L + d] + r.p;

  for (int q = 0; q < r.n; q++) {
    double S[3], D[3], first;

    if (linear) {
      const double s = BasisSnap((x[q] - lower) / h);

      first = floor(s);
      S[0]  = 1.0 - (s - first);
      S[1]  = s - first;
      S[2] = D[2] = 0.0;
      D[0]        = -1.0 / h;
      D[1]        = 1.0 / h;
    } else {
      const BasisDomain b = BasisDomainOf(x[q], l[q], lower, h, cells);

      first = floor(b.lo);
      BasisAverage(b.lo - first, b.hi - first, b.length * h, S, D);
    }
    for (int k = 0; k < 3; k++) {
      w->S[d][k][q] = S[k];
      w->D[d][k][q] = D[k];
    }
    base[q] = (int)first;
  }
}

/* Places of the particles' cells from their first nodes on. */
static void Cells(const Explicit *e, Run r, int *const base[CL_DIM], Weights *w)
{
  const Grid *g = &e->m->grid;

  for (int d = 0; d < CL_DIM; d++) {
    const double lower = g->lower[d], h = g->h[d], cells = (double)g->cells[d];
    const double *restrict x = e->m->P.f[P_X + d] + r.p;
    const int stride         = d ? (int)g->gm[0] : 1;

    for (int q = 0; q < r.n; q++)
      w->cell[q] = (d ? w->cell[q] : 0) + stride * BasisCell((x[q] - lower) / h, (double)base[d][q], cells);
  }
}

void WeightsOf(const Explicit *e, Run r, Weights *w)
{
  const Grid *g = &e->m->grid;
  int x[BLOCK], y[BLOCK], *const base[CL_DIM] = {x, y};

  for (int d = 0; d < CL_DIM; d++) {
    if (e->m->c->basis == BASIS_LINEAR)
      Axes(e, r, d, true, w, base[d]);
    else
      Axes(e, r, d, false, w, base[d]);
  }
  for (int q = 0; q < r.n; q++)
    w->first[q] = (int)GridPadded(g, x[q], y[q]);
  if (TakesCellMean(e))
    Cells(e, r, base, w);
}
