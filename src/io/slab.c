/* Numbers of particles and nodes on the ranks that write them, one component at a time, by a star forest: the slots of
   a rank's share are its roots, the particles or nodes of all ranks their leaves. */
#include "io_private.h"

#include <petscsf.h>

/* Leaf p goes to slot at[p] of rank to[p]. */
static PetscErrorCode Connect(MPI_Comm comm, Slab *s, const PetscMPIInt to[], const PetscInt at[])
{
  const PetscInt most = PetscMax(PetscMax(s->n_slots, s->n), 1);
  PetscSFNode   *remote;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Comm_size(comm, &s->size));
  PetscCall(PetscMalloc1(s->n, &remote));
  for (PetscInt p = 0; p < s->n; p++)
    remote[p] = (PetscSFNode){.rank = to[p], .index = at[p]};
  PetscCall(PetscSFCreate(comm, &s->sf));
  PetscCall(PetscSFSetGraph(s->sf, s->n_slots, s->n, NULL, PETSC_OWN_POINTER, remote, PETSC_OWN_POINTER));
  PetscCall(PetscMalloc(sizeof(double) * (size_t)most, &s->out));
  PetscCall(PetscMalloc(sizeof(double) * (size_t)most, &s->come));
  PetscCall(PetscMalloc1(PetscMax(s->n_slots, 1) * P_MOST, &s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Slots that a particle came to, in order: ids may have gaps. */
static PetscErrorCode Rows(Slab *s)
{
  PetscInt *here = s->out, *came = s->come;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < s->n; p++)
    here[p] = 1;
  PetscCall(PetscArrayzero(came, s->n_slots));
  PetscCall(PetscSFReduceBegin(s->sf, MPIU_INT, here, came, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(s->sf, MPIU_INT, here, came, MPI_REPLACE));
  PetscCall(PetscMalloc1(s->n_slots, &s->row));
  for (PetscInt k = 0; k < s->n_slots; k++) {
    if (came[k])
      s->row[s->rows++] = k;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabParticles(const Model *m, Slab *s)
{
  const Particles *P    = &m->P;
  const PetscInt  *id   = P->i[PI_ID];
  PetscInt         last = -1, before = 0, share;
  PetscMPIInt     *to;
  PetscInt        *at;

  PetscFunctionBeginUser;
  *s = (Slab){.n = P->n};
  for (PetscInt p = 0; p < P->n; p++)
    last = PetscMax(last, id[p]);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &last, 1, MPIU_INT, MPI_MAX, m->grid.comm));
  share      = last / m->grid.size + 1;
  s->n_slots = PetscMax(PetscMin(share, last + 1 - m->grid.rank * share), 0);
  PetscCall(PetscMalloc2(P->n, &to, P->n, &at));
  for (PetscInt p = 0; p < P->n; p++) {
    to[p] = (PetscMPIInt)(id[p] / share);
    at[p] = id[p] % share;
  }
  PetscCall(Connect(m->grid.comm, s, to, at));
  PetscCall(PetscFree2(to, at));
  PetscCall(Rows(s));
  PetscCallMPI(MPI_Allreduce(&s->rows, &s->total, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  PetscCallMPI(MPI_Exscan(&s->rows, &before, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  s->part = (H5Part){.nd = 1, .all = {(hsize_t)s->total}, .start = {(hsize_t)before}, .count = {(hsize_t)s->rows}};
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Strips across the axis with most nodes; datasets are (layers (z) x) rows (y) x columns (x). */
PetscErrorCode SlabNodes(const Model *m, Slab *s)
{
  const Grid  *g = &m->grid;
  int          d = CL_DIM - 1;
  PetscMPIInt *to;
  PetscInt    *at, width[CL_DIM], mine[CL_DIM], lower[CL_DIM] = {0};

  PetscFunctionBeginUser;
  for (int e = CL_DIM - 1; e >= 0; e--) {
    d        = g->cells[e] > g->cells[d] ? e : d;
    width[e] = mine[e] = g->cells[e] + 1;
  }
  const PetscInt share = g->cells[d] / g->size + 1, first = PetscMin(g->rank * share, g->cells[d] + 1);

  *s         = (Slab){.n = ModelStart(m) ? m->map.n_owned : 0};
  mine[d]    = PetscMin(share, width[d] - first);
  s->n_slots = s->rows = BoxSize(mine);
  PetscCall(PetscMalloc2(s->n, &to, s->n, &at));
  for (PetscInt k = 0; k < s->n; k++) {
    const PetscInt owner = m->map.ij[k][d] / share;
    PetscInt       box[CL_DIM];

    memcpy(box, width, sizeof(box));
    lower[d] = owner * share;
    box[d]   = PetscMin(share, width[d] - lower[d]);
    to[k]    = (PetscMPIInt)owner;
    at[k]    = BoxPlace(lower, box, m->map.ij[k]);
  }
  PetscCall(Connect(g->comm, s, to, at));
  PetscCall(PetscFree2(to, at));
  PetscCallMPI(MPI_Allreduce(&s->n, &s->total, 1, MPIU_INT, MPI_SUM, g->comm));
  s->part                       = (H5Part){.nd = CL_DIM};
  s->part.start[CL_DIM - 1 - d] = (hsize_t)first;
  for (int e = 0; e < CL_DIM; e++) {
    s->part.all[CL_DIM - 1 - e]   = (hsize_t)width[e];
    s->part.count[CL_DIM - 1 - e] = (hsize_t)mine[e];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabDestroy(Slab *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscSFDestroy(&s->sf));
  PetscCall(PetscFree(s->row));
  PetscCall(PetscFree(s->out));
  PetscCall(PetscFree(s->come));
  PetscCall(PetscFree(s->data));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabReals(Slab *s, const double *local, PetscInt stride, int c, int nc)
{
  double *out = s->out, *come = s->come;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < s->n; p++)
    out[p] = local[p * stride];
  for (PetscInt k = 0; k < s->n_slots; k++)
    come[k] = NAN;
  PetscCall(PetscSFReduceBegin(s->sf, MPIU_REAL, out, come, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(s->sf, MPIU_REAL, out, come, MPI_REPLACE));
  for (PetscInt k = 0; k < s->rows; k++)
    s->data[k * nc + c] = come[s->row ? s->row[k] : k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabInts(Slab *s, const PetscInt *local)
{
  PetscInt *come = s->come, *data = (PetscInt *)s->data;

  PetscFunctionBeginUser;
  PetscCall(PetscSFReduceBegin(s->sf, MPIU_INT, local, come, MPI_REPLACE));
  PetscCall(PetscSFReduceEnd(s->sf, MPIU_INT, local, come, MPI_REPLACE));
  for (PetscInt k = 0; k < s->rows; k++)
    data[k] = come[s->row ? s->row[k] : k];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabWrite(const Slab *s, hid_t group, const char *name, int nc, const char *unit, bool keep)
{
  PetscFunctionBeginUser;
  PetscCall(H5WritePart(group, name, &s->part, &(H5Values){H5T_NATIVE_DOUBLE, nc, s->data, unit}, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabWriteInts(const Slab *s, hid_t group, const char *name, const char *unit, bool keep)
{
  PetscFunctionBeginUser;
  PetscCall(H5WritePart(group, name, &s->part, &(H5Values){H5_INT, 1, s->data, unit}, keep));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlabWriteVariables(Slab *s, const Particles *P, bool keep, hid_t group)
{
  PetscFunctionBeginUser;
  for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
    if (!ParticlesHold(P, v))
      continue;
    for (int c = 0; c < v->nc; c++)
      PetscCall(SlabReals(s, P->f[v->first + c], 1, c, v->nc));
    PetscCall(SlabWrite(s, group, v->name, v->nc, v->unit, keep));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

size_t SlabRoomVariables(const Slab *s, const Particles *P)
{
  size_t room = 0;

  for (const ParticleVariable *v = cl_particle_variable; v->name; v++)
    room += ParticlesHold(P, v) ? H5Room(&s->part, 1, v->nc) : 0;
  return room;
}
