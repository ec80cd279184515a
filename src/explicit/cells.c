/* Mean motion over the material in cells (88), (160): its forces and its gradient. */
#include "lanes.h"

/* Row of corner i of the cell behind node I. */
static int Corner(const Explicit *e, PetscInt I, int i)
{
  return e->slot[GridPadded(&e->m->grid, e->map.ij[I]) + CornerAt(e, i)];
}

/* Has the cell behind node I material in it, and may it be this rank's? */
static bool Filled(const Explicit *e, PetscInt I)
{
  const Grid *g = &e->m->grid;
  PetscInt    last[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    last[d] = e->map.ij[I][d] + 1;
  return e->cell[I * CELL_MEAN] > 0.0 && BoxHolds(g->gs, g->gm, last);
}

PetscErrorCode CellsForces(Explicit *e)
{
  const int  width = LANES * Rows(A_Count(e->set)), at = A_Force(e->set);
  const bool strain = e->m->c->mean_strain > 0.0;

  PetscFunctionBeginUser;
  if (!TakesCellMean(e))
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt I = 0; I < e->map.n_local; I++) { /* each rank gives the nodes what its own particles press with */
    e->swell[I] = e->cell[I * CELL_MEAN + CELL_PRESSURE];

    e->cell[I * CELL_MEAN + CELL_PRESSURE] = 0.0;
  }
  PetscCall(NodeMapSum(&e->map, e->cell, CELL_MEAN));
  for (PetscInt I = 0; I < e->map.n_local; I++) {
    CellMean *c = &e->mean[I];
    double    h[CL_DIM];

    if (!Filled(e, I))
      continue;
    for (int d = 0; d < CL_DIM; d++)
      h[d] = LinesWidth(&e->m->grid.line[d], e->map.ij[I][d]);
    CellMeanOf(&e->cell[I * CELL_MEAN], h, false, c);
    for (int a = 0; a < CL_CORNERS; a++) {
      double *row = &e->A[Corner(e, I, a) * width + at];

      for (int i = 0; i < CL_DIM; i++)
        row[i] += c->Q[a][i] * e->swell[I] + (strain ? VectorDot(c->Q[a], e->part[I][i]) : 0.0);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void CellsMotion(Explicit *e)
{
  const int  width = LANES * Rows(B_Count(e->set));
  const bool takes = TakesCellMean(e), strain = e->m->c->mean_strain > 0.0;

  for (PetscInt I = 0; takes && I < e->map.n_local; I++) {
    if (!Filled(e, I))
      continue;
    e->swell[I] = 0.0;
    if (strain)
      memset(e->part[I], 0, sizeof(e->part[I]));
    for (int a = 0; a < CL_CORNERS; a++) {
      const double *v = &e->B[Corner(e, I, a) * width];

      e->swell[I] += VectorDot(v, e->mean[I].Q[a]);
      for (int i = 0; strain && i < CL_DIM; i++) {
        for (int j = 0; j < CL_DIM; j++)
          e->part[I][i][j] += v[i] * e->mean[I].Q[a][j];
      }
    }
  }
}
