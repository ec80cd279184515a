/* Numbering of active nodes.  Only nodes that some particle reaches are unknowns. */
#include "clathra/grid.h"

/* Flags of the padded local array, made the same on all ranks that see a node. */
static PetscErrorCode ShareFlags(const Grid *g, const unsigned char *flag, unsigned char *shared)
{
  Vec      local, global;
  double **a;
  PetscInt x0, y0, nx, ny;

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(g->da, &local));
  PetscCall(DMGetGlobalVector(g->da, &global));
  PetscCall(DMDAGetGhostCorners(g->da, &x0, &y0, NULL, &nx, &ny, NULL));
  PetscCall(VecSet(global, 0.0));
  PetscCall(DMDAVecGetArray(g->da, local, &a));
  for (PetscInt j = y0; j < y0 + ny; j++) {
    for (PetscInt i = x0; i < x0 + nx; i++)
      a[j][i] = flag[GridPadded(g, i, j)];
  }
  PetscCall(DMDAVecRestoreArray(g->da, local, &a));
  PetscCall(DMLocalToGlobal(g->da, local, ADD_VALUES, global));
  PetscCall(DMGlobalToLocal(g->da, global, INSERT_VALUES, local));
  PetscCall(PetscArrayzero(shared, g->gm[0] * g->gm[1]));
  PetscCall(DMDAVecGetArrayRead(g->da, local, &a));
  for (PetscInt j = y0; j < y0 + ny; j++) {
    for (PetscInt i = x0; i < x0 + nx; i++)
      shared[GridPadded(g, i, j)] = a[j][i] > 0.0;
  }
  PetscCall(DMDAVecRestoreArrayRead(g->da, local, &a));
  PetscCall(DMRestoreLocalVector(g->da, &local));
  PetscCall(DMRestoreGlobalVector(g->da, &global));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static bool Owned(const Grid *g, PetscInt i, PetscInt j)
{
  return i >= g->xs[0] && i < g->xs[0] + g->xm[0] && j >= g->xs[1] && j < g->xs[1] + g->xm[1];
}

static PetscErrorCode Number(const Grid *g, const unsigned char *shared, NodeMap *map)
{
  const PetscInt n = g->gm[0] * g->gm[1];
  PetscInt       k = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &map->index));
  PetscCall(PetscMalloc1(n, &map->ij));
  for (int pass = 0; pass < 2; pass++) { /* owned nodes, then ghosts */
    for (PetscInt j = g->gs[1]; j < g->gs[1] + g->gm[1]; j++) {
      for (PetscInt i = g->gs[0]; i < g->gs[0] + g->gm[0]; i++) {
        const PetscInt q = GridPadded(g, i, j);

        if (!shared[q]) {
          map->index[q] = -1;
          continue;
        }
        if (Owned(g, i, j) != (pass == 0))
          continue;
        map->ij[k][0] = i;
        map->ij[k][1] = j;
        map->index[q] = k++;
      }
    }
    if (pass == 0)
      map->n_owned = k;
  }
  map->n_local = k;
  PetscCallMPI(MPI_Allreduce(&map->n_owned, &map->n_global, 1, MPIU_INT, MPI_SUM, g->comm));
  PetscCallMPI(MPI_Exscan(&map->n_owned, &map->first, 1, MPIU_INT, MPI_SUM, g->comm));
  if (g->rank == 0)
    map->first = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Global numbers of ghosts travel as doubles in a DMDA vector (exact below 2^53). */
static PetscErrorCode NumberGhosts(const Grid *g, NodeMap *map)
{
  Vec          local, global;
  double     **a;
  PetscSFNode *remote;
  PetscInt    *first;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(map->n_local, 1), &map->global));
  PetscCall(PetscMalloc1(map->n_local - map->n_owned, &remote));
  PetscCall(PetscMalloc1(g->size, &first));
  PetscCallMPI(MPI_Allgather(&map->first, 1, MPIU_INT, first, 1, MPIU_INT, g->comm));
  PetscCall(DMGetLocalVector(g->da, &local));
  PetscCall(DMGetGlobalVector(g->da, &global));
  PetscCall(DMDAVecGetArray(g->da, global, &a));
  for (PetscInt k = 0; k < map->n_owned; k++)
    a[map->ij[k][1]][map->ij[k][0]] = (double)(map->first + k);
  PetscCall(DMDAVecRestoreArray(g->da, global, &a));
  PetscCall(DMGlobalToLocal(g->da, global, INSERT_VALUES, local));
  PetscCall(DMDAVecGetArrayRead(g->da, local, &a));
  for (PetscInt k = 0; k < map->n_local; k++) {
    map->global[k] = (PetscInt)a[map->ij[k][1]][map->ij[k][0]];
    if (k >= map->n_owned) {
      const PetscMPIInt owner        = GridCellOwner(g, map->ij[k]);
      remote[k - map->n_owned].rank  = owner;
      remote[k - map->n_owned].index = map->global[k] - first[owner];
    }
  }
  PetscCall(DMDAVecRestoreArrayRead(g->da, local, &a));
  PetscCall(DMRestoreLocalVector(g->da, &local));
  PetscCall(DMRestoreGlobalVector(g->da, &global));
  PetscCall(PetscFree(first));
  PetscCall(PetscSFCreate(g->comm, &map->sf));
  PetscCall(PetscSFSetGraph(map->sf, map->n_owned, map->n_local - map->n_owned, NULL, PETSC_OWN_POINTER, remote,
                            PETSC_OWN_POINTER));
  PetscCall(PetscSFSetUp(map->sf));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapUpdate(const Grid *g, const unsigned char *flag, NodeMap *map, bool *changed)
{
  const PetscInt n = g->gm[0] * g->gm[1];
  unsigned char *shared;
  PetscMPIInt    same = map->index != NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &shared));
  PetscCall(ShareFlags(g, flag, shared));
  for (PetscInt q = 0; same && q < n; q++)
    same = shared[q] == (map->index[q] >= 0);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_INT, MPI_LAND, g->comm));
  if (!same) {
    PetscCall(NodeMapDestroy(map));
    PetscCall(Number(g, shared, map));
    PetscCall(NumberGhosts(g, map));
  }
  *changed = !same;
  PetscCall(PetscFree(shared));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapDestroy(NodeMap *map)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(map->index));
  PetscCall(PetscFree(map->ij));
  PetscCall(PetscFree(map->global));
  PetscCall(PetscSFDestroy(&map->sf));
  for (int nc = 0; nc <= CL_NODE_DOUBLES; nc++) {
    if (map->unit[nc])
      PetscCallMPI(MPI_Type_free(&map->unit[nc]));
  }
  PetscCall(PetscMemzero(map, sizeof(*map)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Unit(NodeMap *map, PetscInt nc, MPI_Datatype *unit)
{
  PetscFunctionBeginUser;
  if (nc == 1) {
    *unit = MPIU_REAL;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  if (!map->unit[nc]) {
    PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)nc, MPIU_REAL, &map->unit[nc]));
    PetscCallMPI(MPI_Type_commit(&map->unit[nc]));
  }
  *unit = map->unit[nc];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapReduce(NodeMap *map, double *a, PetscInt nc)
{
  MPI_Datatype unit;
  PetscMPIInt  size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)map->sf), &size));
  if (size == 1)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Unit(map, nc, &unit));
  PetscCall(PetscSFReduceBegin(map->sf, unit, a + map->n_owned * nc, a, MPI_SUM));
  PetscCall(PetscSFReduceEnd(map->sf, unit, a + map->n_owned * nc, a, MPI_SUM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapBroadcast(NodeMap *map, double *a, PetscInt nc)
{
  MPI_Datatype unit;
  PetscMPIInt  size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)map->sf), &size));
  if (size == 1)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Unit(map, nc, &unit));
  PetscCall(PetscSFBcastBegin(map->sf, unit, a, a + map->n_owned * nc, MPI_REPLACE));
  PetscCall(PetscSFBcastEnd(map->sf, unit, a, a + map->n_owned * nc, MPI_REPLACE));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapSum(NodeMap *map, double *a, PetscInt nc)
{
  PetscFunctionBeginUser;
  PetscCall(NodeMapReduce(map, a, nc));
  PetscCall(NodeMapBroadcast(map, a, nc));
  PetscFunctionReturn(PETSC_SUCCESS);
}
