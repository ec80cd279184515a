/* Writing a checkpoint: the state and all particles of a run in one HDF5 file behind a seal.

     512 bytes           the seal: see seal.c
     /state/<field>      StepperState
     /scene              text: CaseWriteState
     /particles/<name>   cl_particle_variable (n x components); id, region, faces; rank and place: where the particle
   was, so that on as many ranks a restart finds the same order and goes on bit for bit; attribute ranks
     /borders            of their boxes: how many along x, y, and the first nodes of each along x and the end, along y
 */
#include "io_private.h"

#include <stddef.h>
#include <stdlib.h>
#include <string.h>

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
                                     INT(limited_total), INT(loose_total),
                                     REAL(err_worst),    REAL(out),
                                     REAL(heat_gain),    REAL(heat_in),
                                     REAL(heat_source),  REAL(water0),
                                     REAL(methane0),     REAL(capacity0),
                                     REAL(scale_p),      REAL(scale_u),
                                     REAL(scale_T),      INT(next_snapshot),
                                     INT(stage),         REAL(meter),
                                     INT(kind),          INT(ice_total),
                                     INT(ice_most),      REAL(ice_coldest),
                                     INT(votes),         INT(patience),
                                     REAL(since),        REAL(spent),
                                     REAL(work),         REAL(energy),
                                     REAL(squeezed),     REAL(left),
                                     REAL(moved),        REAL(enthalpy0),
                                     REAL(enthalpy_out), {NULL, 0, 0, false}};
/* Fourteen integers, twenty-five reals, the meters, works and energies. */
_Static_assert(sizeof(StepperState) ==
                   14 * sizeof(PetscInt) + (25 + CL_METERS * METER_COUNT + WORK_COUNT + ENERGY_COUNT) * sizeof(double),
               "a new field of StepperState must join io_state_field");

typedef struct {
  hid_t          file, group; /* rank 0 */
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

static PetscErrorCode WriteScene(hid_t file, const Case *c)
{
  char   *text;
  size_t  size;
  hsize_t n;

  PetscFunctionBeginUser;
  PetscCall(CaseText(c, CaseWriteState, &text, &size));
  n = size;
  PetscCall(H5Write(file, "scene", H5T_NATIVE_CHAR, 1, &n, text, NULL, false));
  free(text);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteBorders(hid_t file, const Grid *g)
{
  PetscInt *border;
  hsize_t   n = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(CL_DIM * (g->size + 2), &border));
  for (int d = 0; d < CL_DIM; d++)
    border[n++] = g->nproc[d];
  for (int d = 0; d < CL_DIM; d++) {
    for (PetscInt r = 0; r <= g->nproc[d]; r++)
      border[n++] = g->start[d][r];
  }
  PetscCall(H5Write(file, "borders", H5T_NATIVE_INT, 1, &n, border, NULL, false));
  PetscCall(PetscFree(border));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Start(Writer *w, const Case *c, const StepperState *s, const Grid *g)
{
  PetscFunctionBeginUser;
  PetscCall(H5ImageCreate(SEAL_BYTES, &w->file));
  PetscCall(H5WriteInt(w->file, "ranks", g->size));
  PetscCall(WriteBorders(w->file, g));
  PetscCall(WriteState(w->file, s));
  PetscCall(WriteScene(w->file, c));
  PetscCall(H5Group(w->file, "/particles", &w->group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteInts(Writer *w, const Particles *P, Gather *g)
{
  const hsize_t n      = (hsize_t)g->total;
  PetscInt     *data   = (PetscInt *)g->data;
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

static PetscErrorCode Finish(Writer *w, const Case *c, uint64_t run, const char *path, bool *ok)
{
  char    block[SEAL_BYTES];
  IoPiece image;

  PetscFunctionBeginUser;
  H5Check(H5Gclose(w->group));
  PetscCall(H5ImageBytes(w->file, &image));
  image.data = (const char *)image.data + SEAL_BYTES;
  image.bytes -= SEAL_BYTES;
  SealMake(block, CaseFingerprint(c), run, image.data, image.bytes);
  *ok = IoReplace(path, true, 2, (IoPiece[]){{block, SEAL_BYTES}, image});
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CheckpointWrite(const Model *m, const StepperState *s, uint64_t run, const char *path, bool *ok)
{
  const Grid *grid = &m->grid;
  Gather      g;
  Writer      w    = {.file = -1, .group = -1};
  int         good = 1;

  PetscFunctionBeginUser;
  PetscCheck(strlen(path) + 8 < PETSC_MAX_PATH_LEN, grid->comm, PETSC_ERR_ARG_SIZ, "the path %s is too long", path);
  if (grid->rank == 0)
    w.ierr = Start(&w, CaseOf(m->c), s, grid);
  PetscCall(GatherCreate(m, &g));
  PetscCall(GatherVariables(&g, &m->P, false, w.group, &w.ierr));
  PetscCall(WriteInts(&w, &m->P, &g));
  if (grid->rank == 0 && !w.ierr) {
    w.ierr = Finish(&w, CaseOf(m->c), run, path, ok);
    good   = *ok;
    PetscCall(H5FileClose(&w.file));
  }
  PetscCall(IoAgree(grid->comm, w.ierr));
  PetscCallMPI(MPI_Bcast(&good, 1, MPI_INT, 0, grid->comm));
  *ok = good;
  PetscCall(GatherDestroy(&g));
  PetscFunctionReturn(PETSC_SUCCESS);
}
