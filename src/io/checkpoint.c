/* Writing a checkpoint: the state and all particles of a run in one HDF5 file behind a seal.

     512 bytes           the seal: see seal.c
     /state/<field>      StepperState
     /particles/<name>   cl_particle_variable (n x components); id, region, faces; rank and place: where the particle
   was, so that on as many ranks a restart finds the same order and goes on bit for bit attribute ranks */
#include "io_private.h"

#include <errno.h>
#include <fcntl.h>
#include <libgen.h>
#include <stddef.h>
#include <string.h>
#include <unistd.h>

#define REAL(field)                                                                                                    \
  {                                                                                                                    \
    #field, offsetof(StepperState, field), sizeof(((StepperState *)0)->field) / sizeof(double), false                  \
  }
#define INT(field)                                                                                                     \
  {                                                                                                                    \
    #field, offsetof(StepperState, field), 1, true                                                                     \
  }
const StateField io_state_field[] = {INT(step),          REAL(t),
                                     REAL(dt),           REAL(err_old),
                                     INT(hold),          INT(fresh),
                                     INT(newton_total),  INT(failures_total),
                                     INT(limited_total), REAL(out),
                                     REAL(heat_gain),    REAL(heat_in),
                                     REAL(heat_source),  REAL(water0),
                                     REAL(methane0),     REAL(capacity0),
                                     REAL(scale_p),      REAL(scale_u),
                                     INT(next_snapshot), INT(stage),
                                     REAL(meter),        {NULL, 0, 0, false}};
/* Eight integers, thirteen reals, the meters. */
_Static_assert(sizeof(StepperState) == 8 * sizeof(PetscInt) + (13 + CL_METERS * METER_COUNT) * sizeof(double),
               "a new field of StepperState must join io_state_field");

typedef struct {
  hid_t          file, group; /* rank 0 */
  double        *data;        /* rank 0: one variable */
  PetscErrorCode ierr;        /* rank 0: first error; the gathering goes on */
} Writer;

static PetscErrorCode WriteState(hid_t file, const StepperState *s)
{
  hid_t group;

  PetscFunctionBeginUser;
  PetscCall(H5Group(file, "/state", &group));
  for (const StateField *f = io_state_field; f->name; f++) {
    const hsize_t n = (hsize_t)f->n;

    PetscCall(H5Write(group, f->name, f->integer ? H5T_NATIVE_INT : H5T_NATIVE_DOUBLE, 1, &n,
                      (const char *)s + f->offset, NULL, false));
  }
  H5Check(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Start(Writer *w, const char *path, const StepperState *s, PetscMPIInt ranks)
{
  PetscFunctionBeginUser;
  PetscCall(H5FileCreate(path, SEAL_BYTES, &w->file));
  PetscCall(H5WriteInt(w->file, "ranks", ranks));
  PetscCall(WriteState(w->file, s));
  PetscCall(H5Group(w->file, "/particles", &w->group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteReals(Writer *w, const Particles *P, Gather *g)
{
  PetscFunctionBeginUser;
  for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
    const hsize_t dims[2] = {(hsize_t)g->total, (hsize_t)v->nc};

    if (!ParticlesHold(P, v))
      continue;
    for (int c = 0; c < v->nc; c++)
      PetscCall(GatherReals(g, P->f[v->first + c], v->nc, w->data + (g->rank == 0 ? c : 0)));
    if (g->rank == 0 && !w->ierr) {
      w->ierr = H5Write(w->group, v->name, H5T_NATIVE_DOUBLE, v->nc > 1 ? 2 : 1, dims, w->data, v->unit, false);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteInts(Writer *w, const Particles *P, Gather *g)
{
  const hsize_t n      = (hsize_t)g->total;
  PetscInt     *data   = (PetscInt *)w->data;
  const char   *name[] = {"id", "region", "faces", "rank", "place"};

  PetscFunctionBeginUser;
  for (int k = 0; k < 5; k++) {
    if (k < PI_COUNT)
      PetscCall(GatherInts(g, P->i[k], data));
    if (g->rank > 0 || w->ierr)
      continue;
    for (PetscInt p = 0; k >= PI_COUNT && p < g->total; p++) {
      PetscMPIInt r = 0;

      while (r + 1 < g->size && g->order[p] >= g->start[r + 1])
        r++;
      data[p] = k == PI_COUNT ? r : g->order[p] - g->start[r];
    }
    w->ierr = H5Write(w->group, name[k], H5T_NATIVE_INT, 1, &n, data, NULL, false);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void SyncFolder(const char *path)
{
  char copy[IO_PATH];
  int  fd;

  snprintf(copy, sizeof(copy), "%s", path);
  fd = open(dirname(copy), O_RDONLY);
  if (fd < 0)
    return;
  (void)!fsync(fd); /* some file systems cannot; the rename is then as safe as they make it */
  close(fd);
}

/* PATH is whole at every instant: the old one gets a second name, then the new one takes its place. */
static PetscErrorCode Replace(const char *aside, const char *path)
{
  char old[IO_PATH + 8];

  PetscFunctionBeginUser;
  snprintf(old, sizeof(old), "%s.old", path);
  if (access(path, F_OK) == 0) {
    (void)unlink(old);
    if (link(path, old) != 0)
      PetscCall(IoRename(path, old)); /* a file system without links */
  }
  PetscCall(IoRename(aside, path));
  SyncFolder(path);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Finish(Writer *w, const Case *c, const char *aside, const char *path)
{
  PetscFunctionBeginUser;
  H5Check(H5Gclose(w->group));
  PetscCall(H5FileClose(&w->file));
  PetscCall(SealWrite(aside, CaseFingerprint(c)));
  PetscCall(Replace(aside, path));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWrite(const Model *m, const StepperState *s, const char *path)
{
  const Grid *grid = &m->grid;
  char        aside[IO_PATH];
  Gather      g;
  Writer      w = {.file = -1, .group = -1};

  PetscFunctionBeginUser;
  PetscCheck(strlen(path) + 8 < PETSC_MAX_PATH_LEN, grid->comm, PETSC_ERR_ARG_SIZ, "the path %s is too long", path);
  snprintf(aside, sizeof(aside), "%s.tmp", path);
  if (grid->rank == 0)
    w.ierr = Start(&w, aside, s, grid->size);
  PetscCall(GatherCreate(m, &g));
  if (g.rank == 0)
    PetscCall(PetscMalloc1(PetscMax(g.total, 1) * 6, &w.data)); /* 6: components of the largest variable */
  PetscCall(WriteReals(&w, &m->P, &g));
  PetscCall(WriteInts(&w, &m->P, &g));
  if (grid->rank == 0 && !w.ierr)
    w.ierr = Finish(&w, m->c, aside, path);
  PetscCall(IoAgree(grid->comm, w.ierr));
  PetscCall(PetscFree(w.data));
  PetscCall(GatherDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
