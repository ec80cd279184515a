/* The background grid and its distribution: DMDA decides nothing but neighbours and ghosts. */
#include "clathra/grid.h"

/* Ranks along x and y with the shortest seams, at least three nodes each way (the stencil is two wide). */
static bool ChooseLayout(PetscMPIInt size, const PetscInt nodes[], PetscInt nproc[])
{
  double best = INFINITY;

  for (PetscInt px = 1; px <= size; px++) {
    const PetscInt py   = size / px;
    const bool     fits = px * py == size && (px == 1 || nodes[0] / px >= 3) && (py == 1 || nodes[1] / py >= 3);
    const double   seam = (double)(px - 1) * (double)nodes[1] + (double)(py - 1) * (double)nodes[0];

    if (fits && seam < best) {
      best     = seam;
      nproc[0] = px;
      nproc[1] = py;
    }
  }
  return best < INFINITY;
}

bool GridFits(PetscMPIInt size, const PetscInt cells[])
{
  const PetscInt nodes[CL_DIM] = {cells[0] + 1, cells[1] + 1};
  PetscInt       nproc[CL_DIM];

  return ChooseLayout(size, nodes, nproc);
}

PetscErrorCode GridCreate(MPI_Comm comm, const double lower[], const double upper[], const PetscInt cells[], Grid *g)
{
  const GridLines line[CL_DIM] = {LinesEqual(lower[0], upper[0], cells[0]), LinesEqual(lower[1], upper[1], cells[1])};

  PetscFunctionBeginUser;
  PetscCall(GridCreateOn(comm, line, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridCreateOn(MPI_Comm comm, const GridLines line[CL_DIM], Grid *g)
{
  const PetscInt cells[CL_DIM] = {line[0].cells, line[1].cells};
  PetscInt       nodes[CL_DIM] = {cells[0] + 1, cells[1] + 1}, *count[CL_DIM], coord[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(g, sizeof(*g)));
  g->comm = comm;
  PetscCallMPI(MPI_Comm_rank(comm, &g->rank));
  PetscCallMPI(MPI_Comm_size(comm, &g->size));
  PetscCheck(ChooseLayout(g->size, nodes, g->nproc), comm, PETSC_ERR_ARG_SIZ,
             "a grid of %" PetscInt_FMT " x %" PetscInt_FMT " cells is too small for %d ranks: use fewer ranks",
             cells[0], cells[1], g->size);
  for (int d = 0; d < CL_DIM; d++) {
    g->line[d]  = line[d];
    g->lower[d] = line[d].lower;
    g->cells[d] = cells[d];
    PetscCall(PetscMalloc1(g->nproc[d], &count[d]));
    PetscCall(PetscMalloc1(g->nproc[d] + 1, &g->start[d]));
    g->start[d][0] = 0;
    for (PetscInt r = 0; r < g->nproc[d]; r++) {
      count[d][r]        = nodes[d] / g->nproc[d] + (r < nodes[d] % g->nproc[d]);
      g->start[d][r + 1] = g->start[d][r] + count[d][r];
    }
  }
  PetscCall(DMDACreate2d(comm, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE, DMDA_STENCIL_BOX, nodes[0], nodes[1], g->nproc[0],
                         g->nproc[1], 1, 2, count[0], count[1], &g->da));
  PetscCall(DMSetUp(g->da));
  coord[0] = g->rank % g->nproc[0];
  coord[1] = g->rank / g->nproc[0];
  for (int d = 0; d < CL_DIM; d++) {
    g->xs[d] = g->start[d][coord[d]];
    g->xm[d] = count[d][coord[d]];
    g->gs[d] = g->xs[d] - 2;
    g->gm[d] = g->xm[d] + 4;
    PetscCall(PetscFree(count[d]));
  }
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

static PetscInt RankCoordinate(const PetscInt *start, PetscInt nproc, PetscInt i)
{
  PetscInt r = 0;

  while (r + 1 < nproc && i >= start[r + 1])
    r++;
  return r;
}

PetscMPIInt GridCellOwner(const Grid *g, const PetscInt cell[])
{
  const PetscInt rx = RankCoordinate(g->start[0], g->nproc[0], cell[0]),
                 ry = RankCoordinate(g->start[1], g->nproc[1], cell[1]);

  return (PetscMPIInt)(ry * g->nproc[0] + rx);
}
