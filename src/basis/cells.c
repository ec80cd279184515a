/* Means over the material in a cell (88). */
#include "clathra/basis.h"
#include "clathra/inline.h"

/* Mean of the product of node i's hats over all axes but `skip`. */
INLINE double HatMean(const double moment[CELL_MEAN], double per_V, int i, int skip)
{
  double sum = 0.0;

#pragma GCC unroll 8
  for (int k = 0; k < CELL_MEAN; k++) {
    int sign = 1; /* of k in the product of xi (second node) and 1 - xi (first) */

#pragma GCC unroll 3
    for (int d = 0; d < CL_DIM; d++) {
      const int takes = k >> d & 1;

      sign *= d == skip ? 1 - takes : i >> d & 1 ? takes : 1 - 2 * takes;
    }
    if (sign != 0)
      sum += sign * moment[k];
  }
  return sum * per_V;
}

void CellMeanOf(const double moment[CELL_MOMENTS], const double h[CL_DIM], bool axisymmetric, CellMean *c)
{
  const double per_V = 1.0 / moment[0];
  double       per[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    per[d] = 1.0 / h[d];
#pragma GCC unroll 8
  for (int i = 0; i < CL_CORNERS; i++) {
#pragma GCC unroll 3
    for (int d = 0; d < CL_DIM; d++)
      c->Q[i][d] = HatMean(moment, per_V, i, d) * (i >> d & 1 ? per[d] : -per[d]);
    c->hoop[i] = axisymmetric ? HatMean(&moment[CELL_MOMENTS - CELL_MEAN], per_V, i, CL_DIM) : 0.0;
  }
}

void StencilCells(const Stencil *s, const Grid *g, const NodeMap *map, AxisParts part[CL_DIM],
                  PetscInt cell[CL_CORNERS], double share[CL_CORNERS])
{
  for (int d = 0; d < CL_DIM; d++) {
    const Axis *a = &s->axis[d];

    part[d] = AxisPartsOf(a->S, a->dS, LinesWidth(&g->line[d], a->base), LinesWidth(&g->line[d], a->base + 1));
  }
  for (int c = 0; c < CL_CORNERS; c++) {
    PetscInt first[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      first[d] = s->axis[d].base + (c >> d & 1);
    share[c] = PartMoment(part, c, 0);
    cell[c]  = share[c] > 0.0 ? NodeMapAt(g, map, first) : -1;
  }
}

AxisParts StencilRing(const Stencil *s, const Grid *g, const AxisParts *radial)
{
  /* (29): r = r_1 - h_0 (1 - xi) before the line between the cells and r_1 + h_1 xi behind it */
  const GridLines *line = &g->line[0];
  const PetscInt   base = s->axis[0].base;
  const double     h0 = LinesWidth(line, base), h1 = LinesWidth(line, base + 1), r1 = GridNode(g, 0, base + 1);
  AxisParts        over = {.at = {0.0, s->hoop[2]}};

  over.share[0] = (radial->share[0] + h0 * s->hoop[0]) / r1;
  over.share[1] = (radial->share[1] - h1 * s->hoop[2]) / r1;
  over.at[0]    = over.share[0] - s->hoop[0];
  return over;
}
