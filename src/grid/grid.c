/* The background grid and its cells. */
#include "clathra/grid.h"

PetscErrorCode GridCreate(MPI_Comm comm, const double lower[], const double upper[], const PetscInt cells[], Grid *g)
{
  GridLines line[CL_DIM];

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++)
    line[d] = LinesEqual(lower[d], upper[d], cells[d]);
  PetscCall(GridCreateOn(comm, line, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridCreateOn(MPI_Comm comm, const GridLines line[CL_DIM], Grid *g)
{
  char size[64] = "";

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(g, sizeof(*g)));
  g->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &g->rank));
  PetscCallMPI(MPI_Comm_size(comm, &g->size));
  for (int d = 0; d < CL_DIM; d++) {
    const size_t n = strlen(size);

    g->line[d]  = line[d];
    g->lower[d] = line[d].lower;
    g->cells[d] = line[d].cells;
    snprintf(size + n, sizeof(size) - n, "%s%" PetscInt_FMT, d ? " x " : "", g->cells[d]);
  }
  PetscCheck(GridFits(g->size, g->cells), comm, PETSC_ERR_ARG_SIZ,
             "a grid of %s cells is too small for %d ranks: use fewer ranks", size, g->size);
  PetscCall(GridShareEvenly(g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridDestroy(Grid *g)
{
  PetscFunctionBeginUser;
  PetscCall(DMDestroy(&g->da));
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(PetscFree(g->start[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool GridCell(const Grid *g, const double x[], PetscInt cell[])
{
  for (int d = 0; d < CL_DIM; d++) {
    const double s = LinesPlace(&g->line[d], x[d]);

    if (!(s >= 0.0 && s <= (double)g->cells[d]))
      return false;
    cell[d] = (PetscInt)s;
    if (cell[d] == g->cells[d])
      cell[d]--;
  }
  return true;
}
