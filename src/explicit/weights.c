/* Weights (3), (4) of a block of particles. */
#include "lanes.h"

/* Where cells are equal. */
INLINE void Axes(const Explicit *e, Run r, int d, bool linear, Weights *w, int *restrict base)
{
  const GridLines *line  = &e->m->grid.line[d];
  const BasisType  type  = e->m->c->basis;
  const double     lower = line->lower, h = line->h, cells = (double)line->cells;
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
      const BasisDomain b = BasisDomainOf(type, x[q], l[q], lower, h, cells);

      first           = floor(b.lo);
      const double lo = b.lo - first, hi = b.hi - first;
      BasisAverage(lo, hi, 1.0, 1.0, hi - lo, b.length * h, S, D);
    }
    for (int k = 0; k < 3; k++) {
      w->S[d][k][q] = S[k];
      w->D[d][k][q] = D[k];
    }
    base[q] = (int)first;
  }
}

/* Where they differ (301). */
static void AxesUnequal(const Explicit *e, Run r, int d, Weights *w, int *restrict base)
{
  const GridLines *line = &e->m->grid.line[d];

  for (int q = 0; q < r.n; q++) {
    Axis a;

    BasisAxis(e->m->c->basis, e->m->P.f[P_X + d][r.p + q], e->m->P.f[P_L + d][r.p + q], line, &a);
    for (int k = 0; k < 3; k++) {
      w->S[d][k][q] = a.S[k];
      w->D[d][k][q] = a.dS[k];
    }
    base[q] = (int)a.base;
  }
}

/* Places of the nodes from the first on. */
INLINE void Nodes(const Explicit *e, Run r, int d, const int *restrict base, Weights *w)
{
  const GridLines *line = &e->m->grid.line[d];

  for (int q = 0; q < r.n; q++) {
    w->unit[d][q]  = line->x ? LinesWidth(line, base[q]) : line->h;
    w->third[d][q] = line->x ? 1.0 + LinesWidth(line, base[q] + 1) / w->unit[d][q] : 2.0;
  }
}

void WeightsOf(const Explicit *e, Run r, Weights *w)
{
  const Grid *g = &e->m->grid;
  int         base[CL_DIM][BLOCK];

  for (int d = 0; d < CL_DIM; d++) {
    if (g->line[d].x)
      AxesUnequal(e, r, d, w, base[d]);
    else if (e->m->c->basis == BASIS_LINEAR)
      Axes(e, r, d, true, w, base[d]);
    else
      Axes(e, r, d, false, w, base[d]);
    Nodes(e, r, d, base[d], w);
  }
  for (int q = 0; q < r.n; q++) {
    PetscInt first[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      first[d] = base[d][q];
    w->first[q] = (int)GridPadded(g, first);
  }
}
