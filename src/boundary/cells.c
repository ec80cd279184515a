/* What a user should know of means over cells that the surface cuts; docs/equations.md, section 7. */
#include "clathra/boundary.h"

#define FILLED 1e-3 /* of a cell's volume: what it may be short of */

/* Cells that particles fill in part, on all ranks; a cell's particles are on one. */
static PetscErrorCode CutCells(const Grid *g, const Case *c, const Particles *P, PetscInt *cut)
{
  const PetscInt n = g->gm[0] * g->gm[1];
  double        *filled; /* share of each cell */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &filled));
  for (PetscInt p = 0; p < P->n; p++) {
    const double x[CL_DIM] = {P->f[P_X][p], P->f[P_X + 1][p]};
    PetscInt     cell[CL_DIM];

    if (!GridCell(g, x, cell))
      continue;
    const double middle = g->lower[0] + ((double)cell[0] + 0.5) * g->h[0];
    filled[GridPadded(g, cell[0], cell[1])] +=
        P->f[P_V][p] / (g->h[0] * g->h[1] * (c->axisymmetric ? 2.0 * M_PI * middle : 1.0));
  }
  *cut = 0;
  for (PetscInt k = 0; k < n; k++)
    *cut += filled[k] > 0.0 && fabs(filled[k] - 1.0) > FILLED;
  PetscCall(PetscFree(filled));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, cut, 1, MPIU_INT, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CellMeansWarning(const Grid *g, const Case *c, const Particles *P)
{
  const char *const key = c->mean_strain > 0.0 ? "mean_strain" : "mean_dilatation";
  PetscInt          cut;

  PetscFunctionBeginUser;
  if (!c->fields.solid || (!c->mean_dilatation && c->mean_strain == 0.0))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(CutCells(g, c, P, &cut));
  if (cut > 0)
    PetscCall(
        PetscFPrintf(g->comm, stderr,
                     "clathra: warning: the surface cuts %" PetscInt_FMT
                     " cells of the grid, and %s leaves forces there of the order of the stress times what a cell "
                     "lacks: let the body fill its cells, or do without\n",
                     cut, key));
  PetscFunctionReturn(PETSC_SUCCESS);
}
