/* The background grid and its distribution: DMDA decides nothing but neighbours and ghosts. */
#include "clathra/grid.h"

#define LEAST_NODES 3 /* of a rank along an axis: the stencil is two wide */

typedef struct {
  const PetscInt *nodes;
  PetscInt        nproc[CL_DIM], best[CL_DIM];
  double          seam; /* of the best */
} Layout;

static double Seam(const Layout *l)
{
  double sum = 0.0;

  for (int d = 0; d < CL_DIM; d++) {
    double across = 1.0;

    for (int e = 0; e < CL_DIM; e++)
      across *= e == d ? 1.0 : (double)l->nodes[e];
    sum += (double)(l->nproc[d] - 1) * across;
  }
  return sum;
}

/* Tries every share of `size` ranks among the axes from d on. */
static void TryLayouts(Layout *l, int d, PetscInt size)
{
  if (d == CL_DIM) {
    if (size == 1 && Seam(l) < l->seam) {
      l->seam = Seam(l);
      memcpy(l->best, l->nproc, sizeof(l->best));
    }
    return;
  }
  for (PetscInt p = 1; p <= size; p++) {
    if (size % p != 0 || (p > 1 && l->nodes[d] / p < LEAST_NODES))
      continue;
    l->nproc[d] = p;
    TryLayouts(l, d + 1, size / p);
  }
}

/* Ranks along the axes with the least seams. */
static bool ChooseLayout(PetscMPIInt size, const PetscInt nodes[], PetscInt nproc[])
{
  Layout l = {.nodes = nodes, .seam = INFINITY};

  TryLayouts(&l, 0, size);
  memcpy(nproc, l.best, sizeof(l.best));
  return l.seam < INFINITY;
}

bool GridFits(PetscMPIInt size, const PetscInt cells[])
{
  PetscInt nodes[CL_DIM], nproc[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    nodes[d] = cells[d] + 1;
  return ChooseLayout(size, nodes, nproc);
}

PetscErrorCode GridCreate(MPI_Comm comm, const double lower[], const double upper[], const PetscInt cells[], Grid *g)
{
  GridLines line[CL_DIM];

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++)
    line[d] = LinesEqual(lower[d], upper[d], cells[d]);
  PetscCall(GridCreateOn(comm, line, g));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateLayout(Grid *g, const PetscInt nodes[CL_DIM], PetscInt *const count[CL_DIM])
{
  PetscInt        all[3] = {1, 1, 1}, nproc[3] = {1, 1, 1};
  const PetscInt *share[3] = {NULL, NULL, NULL};

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++) {
    all[d]   = nodes[d];
    nproc[d] = g->nproc[d];
    share[d] = count[d];
  }
  PetscCall(DMDACreate(g->comm, &g->da));
  PetscCall(DMSetDimension(g->da, CL_DIM));
  PetscCall(DMDASetSizes(g->da, all[0], all[1], all[2]));
  PetscCall(DMDASetNumProcs(g->da, nproc[0], nproc[1], nproc[2]));
  PetscCall(DMDASetBoundaryType(g->da, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE));
  PetscCall(DMDASetDof(g->da, 1));
  PetscCall(DMDASetStencilType(g->da, DMDA_STENCIL_BOX));
  PetscCall(DMDASetStencilWidth(g->da, 2));
  PetscCall(DMDASetOwnershipRanges(g->da, share[0], share[1], share[2]));
  PetscCall(DMSetUp(g->da));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridCreateOn(MPI_Comm comm, const GridLines line[CL_DIM], Grid *g)
{
  static const PetscInt none[CL_DIM] = {0};
  PetscInt              nodes[CL_DIM], *count[CL_DIM], coord[CL_DIM];
  char                  size[64] = "";

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
    nodes[d]    = line[d].cells + 1;
    PetscCall(PetscSNPrintf(size + n, sizeof(size) - n, "%s%" PetscInt_FMT, d ? " x " : "", g->cells[d]));
  }
  PetscCheck(ChooseLayout(g->size, nodes, g->nproc), comm, PETSC_ERR_ARG_SIZ,
             "a grid of %s cells is too small for %d ranks: use fewer ranks", size, g->size);
  for (int d = 0; d < CL_DIM; d++) {
    PetscCall(PetscMalloc1(g->nproc[d], &count[d]));
    PetscCall(PetscMalloc1(g->nproc[d] + 1, &g->start[d]));
    g->start[d][0] = 0;
    for (PetscInt r = 0; r < g->nproc[d]; r++) {
      count[d][r]        = nodes[d] / g->nproc[d] + (r < nodes[d] % g->nproc[d]);
      g->start[d][r + 1] = g->start[d][r] + count[d][r];
    }
  }
  PetscCall(CreateLayout(g, nodes, count));
  BoxAt(none, g->nproc, g->rank, coord);
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
  PetscMPIInt rank = 0;

  for (int d = CL_DIM - 1; d >= 0; d--)
    rank = rank * (PetscMPIInt)g->nproc[d] + (PetscMPIInt)RankCoordinate(g->start[d], g->nproc[d], cell[d]);
  return rank;
}
