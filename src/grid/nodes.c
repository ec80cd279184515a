/* Numbering of active nodes.  Only nodes that some particle reaches are unknowns. */
#include "clathra/grid.h"

/* Flags of the padded local array, made the same on all ranks that see a node. */
static PetscErrorCode ShareFlags(const Grid *g, const unsigned char *flag, unsigned char *shared)
{
  Vec           local, global;
  double       *a;
  const double *seen;
  PetscInt      first[3], size[3], ij[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(DMGetLocalVector(g->da, &local));
  PetscCall(DMGetGlobalVector(g->da, &global));
  PetscCall(DMDAGetGhostCorners(g->da, &first[0], &first[1], &first[2], &size[0], &size[1], &size[2]));
  PetscCall(VecSet(global, 0.0));
  PetscCall(VecGetArrayWrite(local, &a));
  for (PetscInt k = 0; k < BoxSize(size); k++) {
    BoxAt(first, size, k, ij);
    a[k] = flag[GridPadded(g, ij)];
  }
  PetscCall(VecRestoreArrayWrite(local, &a));
  PetscCall(DMLocalToGlobal(g->da, local, ADD_VALUES, global));
  PetscCall(DMGlobalToLocal(g->da, global, INSERT_VALUES, local));
  PetscCall(PetscArrayzero(shared, GridPaddedSize(g)));
  PetscCall(VecGetArrayRead(local, &seen));
  for (PetscInt k = 0; k < BoxSize(size); k++) {
    BoxAt(first, size, k, ij);
    shared[GridPadded(g, ij)] = seen[k] > 0.0;
  }
  PetscCall(VecRestoreArrayRead(local, &seen));
  PetscCall(DMRestoreLocalVector(g->da, &local));
  PetscCall(DMRestoreGlobalVector(g->da, &global));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Number(const Grid *g, const unsigned char *shared, NodeMap *map)
{
  const PetscInt n = GridPaddedSize(g);
  PetscInt       k = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(n, &map->index));
  PetscCall(PetscMalloc1(n, &map->ij));
  for (int pass = 0; pass < 2; pass++) { /* owned nodes, then ghosts */
    for (PetscInt q = 0; q < n; q++) {
      PetscInt ij[CL_DIM];

      if (!shared[q]) {
        map->index[q] = -1;
        continue;
      }
      BoxAt(g->gs, g->gm, q, ij);
      if (BoxHolds(g->xs, g->xm, ij) != (pass == 0))
        continue;
      for (int d = 0; d < CL_DIM; d++)
        map->ij[k][d] = ij[d];
      map->index[q] = k++;
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
  Vec           local, global;
  double       *a;
  const double *seen;
  PetscSFNode  *remote;
  PetscInt     *first, corner[3], size[3];

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(PetscMax(map->n_local, 1), &map->global));
  PetscCall(PetscMalloc1(map->n_local - map->n_owned, &remote));
  PetscCall(PetscMalloc1(g->size, &first));
  PetscCallMPI(MPI_Allgather(&map->first, 1, MPIU_INT, first, 1, MPIU_INT, g->comm));
  PetscCall(DMGetLocalVector(g->da, &local));
  PetscCall(DMGetGlobalVector(g->da, &global));
  PetscCall(VecGetArray(global, &a));
  for (PetscInt k = 0; k < map->n_owned; k++)
    a[BoxPlace(g->xs, g->xm, map->ij[k])] = (double)(map->first + k);
  PetscCall(VecRestoreArray(global, &a));
  PetscCall(DMGlobalToLocal(g->da, global, INSERT_VALUES, local));
  PetscCall(DMDAGetGhostCorners(g->da, &corner[0], &corner[1], &corner[2], &size[0], &size[1], &size[2]));
  PetscCall(VecGetArrayRead(local, &seen));
  for (PetscInt k = 0; k < map->n_local; k++) {
    map->global[k] = (PetscInt)seen[BoxPlace(corner, size, map->ij[k])];
    if (k >= map->n_owned) {
      const PetscMPIInt owner        = GridCellOwner(g, map->ij[k]);
      remote[k - map->n_owned].rank  = owner;
      remote[k - map->n_owned].index = map->global[k] - first[owner];
    }
  }
  PetscCall(VecRestoreArrayRead(local, &seen));
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
  const PetscInt n = GridPaddedSize(g);
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
  if (map->block)
    PetscCallMPI(MPI_Type_free(&map->block));
  PetscCall(PetscMemzero(map, sizeof(*map)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Type of nc numbers a node; null on one rank, which has nobody to tell.  PETSc keeps types that it has seen, so they
   last as long as the map. */
static PetscErrorCode Unit(NodeMap *map, PetscInt nc, MPI_Datatype *unit)
{
  const bool    many = nc > CL_NODE_DOUBLES;
  MPI_Datatype *kept = many ? &map->block : &map->unit[nc];
  PetscMPIInt   size;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(PetscObjectComm((PetscObject)map->sf), &size));
  if (size > 1 && nc > 1 && !*kept) {
    PetscCallMPI(MPI_Type_contiguous((PetscMPIInt)nc, MPIU_REAL, kept));
    PetscCallMPI(MPI_Type_commit(kept));
    map->in_block = many ? nc : map->in_block;
  }
  PetscCheck(size == 1 || !many || nc == map->in_block, PetscObjectComm((PetscObject)map->sf), PETSC_ERR_PLIB,
             "blocks of %" PetscInt_FMT " and of %" PetscInt_FMT " numbers a node", nc, map->in_block);
  *unit = size == 1 ? MPI_DATATYPE_NULL : nc == 1 ? MPIU_REAL : *kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapReduce(NodeMap *map, double *a, PetscInt nc)
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  PetscCall(Unit(map, nc, &unit));
  if (unit == MPI_DATATYPE_NULL)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSFReduceBegin(map->sf, unit, a + map->n_owned * nc, a, MPI_SUM));
  PetscCall(PetscSFReduceEnd(map->sf, unit, a + map->n_owned * nc, a, MPI_SUM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapBroadcast(NodeMap *map, double *a, PetscInt nc)
{
  MPI_Datatype unit;

  PetscFunctionBeginUser;
  PetscCall(Unit(map, nc, &unit));
  if (unit == MPI_DATATYPE_NULL)
    PetscFunctionReturn(PETSC_SUCCESS);
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
