/* Writing a checkpoint: the state and all particles of a run in one HDF5 file behind a seal.

     512 bytes           the seal: see seal.c
     /state/<field>      StepperState
     /scene              text: CaseWriteState
     /case               text: CaseWriteBound, by which a refusal names what differs
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
    #field, offsetof(StepperState, field), sizeof(((StepperState *)0)->field) / (sizeof(double)), false                \
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
                                     REAL(enthalpy_out), REAL(removed),
                                     REAL(peak),         REAL(peak_of),
                                     REAL(peak_t),       REAL(peak_at),
                                     REAL(begin),        REAL(extreme),
                                     INT(uneven_total),  REAL(beyond),
                                     REAL(hydrate0),     REAL(acts),
                                     REAL(unseen),       INT(unseen_steps),
                                     {NULL, 0, 0, false}};
/* Sixteen integers, 31 reals and a place, meters, works, energies, what left, extremes. */
_Static_assert(sizeof(StepperState) == (16 * sizeof(PetscInt) + sizeof(double) - 1) / sizeof(double) * sizeof(double) +
                                           (31 + CL_DIM + CL_METERS * METER_COUNT + ACTS_COUNT + WORK_COUNT +
                                            ENERGY_COUNT + REMOVED_COUNT + EXTREMES) *
                                               sizeof(double) +
                                           EXTREMES * sizeof(Extreme),
               "a new field of StepperState must join io_state_field");

static PetscErrorCode WriteState(hid_t file, const StepperState *s)
{
  hid_t group;

  PetscFunctionBeginUser;
  PetscCall(H5Group(file, "/state", &group));
  for (const StateField *f = io_state_field; f->name; f++) {
    PetscCall(H5Write(group, f->name, f->integer ? H5_INT : H5T_NATIVE_DOUBLE, (hsize_t)f->n,
                      (const char *)s + f->offset, NULL));
  }
  H5Check(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteText(hid_t file, const char *name, const Case *c,
                                PetscErrorCode (*write)(const Case *, FILE *))
{
  char  *text;
  size_t size;

  PetscFunctionBeginUser;
  PetscCall(CaseText(c, write, &text, &size));
  PetscCall(H5Write(file, name, H5T_NATIVE_CHAR, size, text, NULL));
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
  PetscCall(H5Write(file, "borders", H5_INT, n, border, NULL));
  PetscCall(PetscFree(border));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteInts(const Grid *grid, const Particles *P, Slab *s, hid_t group)
{
  PetscInt *rank, *place;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(P->n, &rank, P->n, &place));
  for (PetscInt p = 0; p < P->n; p++) {
    rank[p]  = grid->rank;
    place[p] = p;
  }
  const struct {
    const char     *name;
    const PetscInt *data;
  } integer[] = {
      {"id", P->i[PI_ID]}, {"region", P->i[PI_REGION]}, {"faces", P->i[PI_FACES]}, {"rank", rank}, {"place", place}};

  for (int k = 0; k < 5; k++) {
    PetscCall(SlabInts(s, integer[k].data));
    PetscCall(SlabWriteInts(s, group, integer[k].name, NULL, false));
  }
  PetscCall(PetscFree2(rank, place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteAll(const Model *m, const StepperState *state, Slab *s, hid_t file)
{
  hid_t group;

  PetscFunctionBeginUser;
  PetscCall(H5WriteInt(file, "ranks", m->grid.size));
  PetscCall(WriteBorders(file, &m->grid));
  PetscCall(WriteState(file, state));
  PetscCall(WriteText(file, "scene", CaseOf(m->c), CaseWriteState));
  PetscCall(WriteText(file, "case", CaseOf(m->c), CaseWriteBound));
  PetscCall(H5Group(file, "/particles", &group));
  PetscCall(SlabWriteVariables(s, &m->P, false, group));
  PetscCall(WriteInts(&m->grid, &m->P, s, group));
  H5Check(H5Gclose(group));
  PetscFunctionReturn(PETSC_SUCCESS);
}

typedef struct {
  uint64_t fingerprint, run;
} Owner;

static void SealIt(uint64_t sum, uint64_t bytes, const void *ctx, char *block)
{
  const Owner *o = ctx;

  SealMake(block, o->fingerprint, o->run, bytes, sum);
}

#define ROOM_STATE ((size_t)1 << 20) /* bytes that are no particles': state, scene, groups */

PetscErrorCode CheckpointWrite(const Model *m, const StepperState *s, uint64_t run, const char *path, bool *ok)
{
  const Owner owner = {CaseFingerprint(CaseOf(m->c)), run};
  SharedFile  f;
  Slab        slab;
  size_t      room;

  PetscFunctionBeginUser;
  PetscCheck(strlen(path) + 8 < PETSC_MAX_PATH_LEN, m->grid.comm, PETSC_ERR_ARG_SIZ, "the path %s is too long", path);
  PetscCall(SlabParticles(m, &slab));
  room = ROOM_STATE + SlabRoomVariables(&slab, &m->P) + H5Room(&slab.part, 5, 5);
  PetscCall(SharedCreate(m->grid.comm, path, SEAL_BYTES, room, &f, ok));
  if (*ok) {
    PetscCall(WriteAll(m, s, &slab, f.file));
    PetscCall(SharedFinish(&f, true, SealIt, &owner, ok));
  }
  PetscCall(SlabDestroy(&slab));
  PetscFunctionReturn(PETSC_SUCCESS);
}
