/* Particles gathered on rank 0 in the order of their ids, one variable at a time, and put into HDF5. */
#include "io_private.h"

PetscErrorCode GatherCreate(const Model *m, Gather *g)
{
  const Particles *P  = &m->P;
  PetscMPIInt      n  = (PetscMPIInt)P->n;
  PetscInt        *id = NULL;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(g, sizeof(*g)));
  g->comm = m->grid.comm;
  g->rank = m->grid.rank;
  g->size = m->grid.size;
  g->n    = P->n;
  if (g->rank == 0)
    PetscCall(PetscMalloc2(g->size, &g->count, g->size, &g->start));
  PetscCallMPI(MPI_Gather(&n, 1, MPI_INT, g->count, 1, MPI_INT, 0, g->comm));
  if (g->rank == 0) {
    for (PetscMPIInt r = 0; r < g->size; r++) {
      g->start[r] = (PetscMPIInt)g->total;
      g->total += g->count[r];
    }
    PetscCall(PetscMalloc2(g->total, &g->order, g->total, &g->id));
    PetscCall(PetscMalloc1(g->total, &id));
    PetscCall(PetscMalloc(sizeof(double) * (size_t)PetscMax(g->total, 1), &g->buffer));
    PetscCall(PetscMalloc1(PetscMax(g->total, 1) * P_MOST, &g->data));
  }
  PetscCallMPI(MPI_Gatherv(P->i[PI_ID], n, MPIU_INT, id, g->count, g->start, MPIU_INT, 0, g->comm));
  if (g->rank == 0) {
    for (PetscInt k = 0; k < g->total; k++)
      g->order[k] = k;
    PetscCall(PetscSortIntWithPermutation(g->total, id, g->order));
    for (PetscInt k = 0; k < g->total; k++)
      g->id[k] = id[g->order[k]];
    PetscCall(PetscFree(id));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherDestroy(Gather *g)
{
  PetscFunctionBeginUser;
  if (g->rank == 0) {
    PetscCall(PetscFree2(g->count, g->start));
    PetscCall(PetscFree2(g->order, g->id));
    PetscCall(PetscFree(g->buffer));
    PetscCall(PetscFree(g->data));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherReals(Gather *g, const double *local, PetscInt stride, double *sorted)
{
  double *all = g->buffer;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Gatherv(local, (PetscMPIInt)g->n, MPI_DOUBLE, all, g->count, g->start, MPI_DOUBLE, 0, g->comm));
  if (g->rank == 0) {
    for (PetscInt k = 0; k < g->total; k++)
      sorted[k * stride] = all[g->order[k]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherInts(Gather *g, const PetscInt *local, PetscInt *sorted)
{
  PetscInt *all = g->buffer;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Gatherv(local, (PetscMPIInt)g->n, MPIU_INT, all, g->count, g->start, MPIU_INT, 0, g->comm));
  if (g->rank == 0) {
    for (PetscInt k = 0; k < g->total; k++)
      sorted[k] = all[g->order[k]];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode GatherVariables(Gather *g, const Particles *P, bool compress, hid_t group, PetscErrorCode *ierr)
{
  PetscFunctionBeginUser;
  for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
    const hsize_t dims[2] = {(hsize_t)g->total, (hsize_t)v->nc};

    if (!ParticlesHold(P, v))
      continue;
    for (int c = 0; c < v->nc; c++)
      PetscCall(GatherReals(g, P->f[v->first + c], v->nc, g->rank == 0 ? g->data + c : NULL));
    if (g->rank == 0 && !*ierr)
      *ierr = H5Write(group, v->name, H5T_NATIVE_DOUBLE, v->nc > 1 ? 2 : 1, dims, g->data, v->unit, compress);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
