/* Which rank has which nodes: boxes between borders that run through the whole grid.  DMDA decides nothing but
   neighbours and ghosts. */
#include "clathra/grid.h"
#include <string.h>

#define LEAST_NODES 3 /* of a rank along an axis: the stencil is two wide */

static double Seam(const PetscInt nodes[], const PetscInt nproc[])
{
  double sum = 0.0;

  for (int d = 0; d < CL_DIM; d++) {
    double across = 1.0;

    for (int e = 0; e < CL_DIM; e++)
      across *= e == d ? 1.0 : (double)nodes[e];
    sum += (double)(nproc[d] - 1) * across;
  }
  return sum;
}

/* ---------------------------------------------------------------- ways to share */
/* Gives `take` every share of `size` ranks among the axes from d on. */
static PetscErrorCode Shares(const PetscInt nodes[], int d, PetscInt size, PetscInt nproc[], GridShareFn *take,
                             void *ctx)
{
  PetscFunctionBeginUser;
  if (d == CL_DIM) {
    if (size == 1)
      PetscCall(take(nproc, Seam(nodes, nproc), ctx));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  for (PetscInt p = 1; p <= size; p++) {
    if (size % p != 0 || (p > 1 && nodes[d] / p < LEAST_NODES))
      continue;
    nproc[d] = p;
    PetscCall(Shares(nodes, d + 1, size / p, nproc, take, ctx));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridShares(PetscMPIInt size, const PetscInt cells[], GridShareFn *take, void *ctx)
{
  PetscInt nodes[CL_DIM], nproc[CL_DIM];

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++)
    nodes[d] = cells[d] + 1;
  PetscCall(Shares(nodes, 0, size, nproc, take, ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  PetscInt nproc[CL_DIM];
  double   seam;
} Least;

static PetscErrorCode TakeLeast(const PetscInt nproc[], double seam, void *ctx)
{
  Least *best = (Least *)ctx;

  PetscFunctionBeginUser;
  if (seam < best->seam) {
    best->seam = seam;
    memcpy(best->nproc, nproc, sizeof(best->nproc));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool GridFits(PetscMPIInt size, const PetscInt cells[])
{
  Least best = {.seam = INFINITY};

  return GridShares(size, cells, TakeLeast, &best) == PETSC_SUCCESS && best.seam < INFINITY;
}

/* ---------------------------------------------------------------- borders */
void GridEvenBorders(PetscInt cells, const PetscInt *load, PetscInt nproc, PetscInt *start)
{
  const PetscInt nodes = cells + 1;
  double         total = 0.0, below = 0.0;
  PetscInt       i = 0;

  for (PetscInt k = 0; k < cells; k++)
    total += load ? (double)load[k] : 1.0;
  start[0]     = 0;
  start[nproc] = nodes;
  for (PetscInt r = 1; r < nproc; r++) {
    const double   share = total * (double)r / (double)nproc;
    const PetscInt least = start[r - 1] + LEAST_NODES, most = nodes - (nproc - r) * LEAST_NODES;

    for (; i < cells; i++) {
      const double next = below + (load ? (double)load[i] : 1.0);

      if (i >= least && next - share > share - below)
        break; /* further from the share than now */
      if (i >= most)
        break;
      below = next;
    }
    start[r] = PetscMin(PetscMax(i, least), most);
  }
}

bool GridSound(const Grid *g, const PetscInt nproc[], PetscInt *const start[])
{
  PetscInt size = 1;

  for (int d = 0; d < CL_DIM; d++) {
    size *= nproc[d];
    if (nproc[d] < 1 || start[d][0] != 0 || start[d][nproc[d]] != g->cells[d] + 1)
      return false;
    for (PetscInt r = 0; r < nproc[d]; r++) {
      if (start[d][r + 1] - start[d][r] < (nproc[d] > 1 ? LEAST_NODES : 1))
        return false;
    }
  }
  return size == g->size;
}

static PetscErrorCode CreateLayout(Grid *g)
{
  PetscInt all[3] = {1, 1, 1}, nproc[3] = {1, 1, 1}, *count[3] = {NULL, NULL, NULL};

  PetscFunctionBeginUser;
  for (int d = 0; d < CL_DIM; d++) {
    all[d]   = g->cells[d] + 1;
    nproc[d] = g->nproc[d];
    PetscCall(PetscMalloc1(nproc[d], &count[d]));
    for (PetscInt r = 0; r < nproc[d]; r++)
      count[d][r] = g->start[d][r + 1] - g->start[d][r];
  }
  PetscCall(DMDACreate(g->comm, &g->da));
  PetscCall(DMSetDimension(g->da, CL_DIM));
  PetscCall(DMDASetSizes(g->da, all[0], all[1], all[2]));
  PetscCall(DMDASetNumProcs(g->da, nproc[0], nproc[1], nproc[2]));
  PetscCall(DMDASetBoundaryType(g->da, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE, DM_BOUNDARY_NONE));
  PetscCall(DMDASetDof(g->da, 1));
  PetscCall(DMDASetStencilType(g->da, DMDA_STENCIL_BOX));
  PetscCall(DMDASetStencilWidth(g->da, 2));
  PetscCall(DMDASetOwnershipRanges(g->da, count[0], count[1], count[2]));
  PetscCall(DMSetUp(g->da));
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(PetscFree(count[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridShare(Grid *g, const PetscInt nproc[], PetscInt *const start[])
{
  static const PetscInt none[CL_DIM] = {0};
  PetscInt              coord[CL_DIM];

  PetscFunctionBeginUser;
  PetscCheck(GridSound(g, nproc, start), g->comm, PETSC_ERR_ARG_SIZ, "impossible borders between ranks");
  PetscCall(DMDestroy(&g->da));
  for (int d = 0; d < CL_DIM; d++) {
    PetscCall(PetscFree(g->start[d]));
    g->nproc[d] = nproc[d];
    PetscCall(PetscMalloc1(nproc[d] + 1, &g->start[d]));
    PetscCall(PetscArraycpy(g->start[d], start[d], nproc[d] + 1));
  }
  PetscCall(CreateLayout(g));
  BoxAt(none, g->nproc, g->rank, coord);
  for (int d = 0; d < CL_DIM; d++) {
    g->xs[d] = g->start[d][coord[d]];
    g->xm[d] = g->start[d][coord[d] + 1] - g->xs[d];
    g->gs[d] = g->xs[d] - 2;
    g->gm[d] = g->xm[d] + 4;
  }
  g->shared++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GridShareEvenly(Grid *g)
{
  Least     best = {.seam = INFINITY};
  PetscInt *start[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(GridShares(g->size, g->cells, TakeLeast, &best));
  for (int d = 0; d < CL_DIM; d++) {
    PetscCall(PetscMalloc1(best.nproc[d] + 1, &start[d]));
    GridEvenBorders(g->cells[d], NULL, best.nproc[d], start[d]);
  }
  PetscCall(GridShare(g, best.nproc, start));
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(PetscFree(start[d]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscMPIInt GridBoxOwner(const PetscInt nproc[], PetscInt *const start[], const PetscInt cell[])
{
  PetscInt at[CL_DIM];

  for (int d = 0; d < CL_DIM; d++) {
    PetscInt low = 0, high = nproc[d]; /* start[low] <= cell < start[high] */

    while (high - low > 1) {
      const PetscInt middle = (low + high) / 2;

      *(cell[d] >= start[d][middle] ? &low : &high) = middle;
    }
    at[d] = low;
  }
  return (PetscMPIInt)BoxPlace((PetscInt[CL_DIM]){0}, nproc, at);
}

PetscMPIInt GridCellOwner(const Grid *g, const PetscInt cell[])
{
  return GridBoxOwner(g->nproc, g->start, cell);
}

PetscErrorCode GridShareLargest(MPI_Comm comm, void *largest, size_t bytes)
{
  struct {
    double value;
    int    rank;
  } best;

  PetscFunctionBeginUser;
  memcpy(&best.value, largest, sizeof(best.value));
  PetscCallMPI(MPI_Comm_rank(comm, &best.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(largest, (PetscMPIInt)bytes, MPI_BYTE, best.rank, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
