/* What a user should know of means over cells that the surface cuts; docs/equations.md, section 7. */
#include "clathra/boundary.h"

#define FILLED 1e-3 /* of a cell's volume: what it may be short of */

/* Cells that particles fill in part, on all ranks; a cell's particles are on one. */
static PetscErrorCode CutCells(const Grid *g, const Scene *c, const Particles *P, PetscInt *cut)
{
  const PetscInt n = GridPaddedSize(g);
  double        *filled; /* share of each cell */

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(n, &filled));
  for (PetscInt p = 0; p < P->n; p++) {
    double   x[CL_DIM], share = P->f[P_V][p];
    PetscInt cell[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      x[d] = P->f[P_X + d][p];
    if (!GridCell(g, x, cell))
      continue;
    for (int d = 0; d < CL_DIM; d++)
      share /= LinesWidth(&g->line[d], cell[d]);
    if (c->axisymmetric)
      share /= 2.0 * M_PI * LinesFrom(&g->line[0], (double)cell[0] + 0.5);
    filled[GridPadded(g, cell)] += share;
  }
  *cut = 0;
  for (PetscInt k = 0; k < n; k++)
    *cut += filled[k] > 0.0 && fabs(filled[k] - 1.0) > FILLED;
  PetscCall(PetscFree(filled));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, cut, 1, MPIU_INT, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const Bc *SceneTraction(const Scene *c)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *bc = &c->bc[k];

    for (PetscInt i = 0; bc->type == BC_TRACTION && i < bc->value.n; i++) {
      if (bc->value.y[i] != 0.0)
        return bc;
    }
    for (PetscInt i = 0; bc->type == BC_TRACTION && i < bc->shear.n; i++) {
      if (bc->shear.y[i] != 0.0)
        return bc;
    }
  }
  return NULL;
}

PetscErrorCode CellMeansWarning(const Grid *g, const Scene *c, const Particles *P, const Bc *traction)
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
  if (traction)
    PetscCall(PetscFPrintf(g->comm, stderr,
                           "clathra: warning: the traction %s (bc_%s_type) stands against stress that acts through "
                           "%s: where its surface rises from the grid's line, hybrid gives it to nodes of almost no "
                           "mass, and loads come out wrong; let an ambient pressure or a plate bear it, or take sdirk2 "
                           "or euler\n",
                           traction->name, traction->name, key));
  PetscFunctionReturn(PETSC_SUCCESS);
}
