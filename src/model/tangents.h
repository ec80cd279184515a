/* Private to model/: tangents of particles, kept for products with a change of their inputs. */
#pragma once

#include "gather.h"

/* More inputs: projected gradients (27), and a change of the volume, through which alone motion reaches scalars. */
enum { IN_PROJ = IN_COUNT, IN_VOLUME = IN_PROJ + CL_FLUID_VECTORS, IN_ALL };

/* So many particles side by side, so that products are vector code whatever the fields: the q-th particle of
   Model.order is number q % LANES of group q / LANES. */
typedef struct {
  int      rows, row[OUT_COUNT];       /* outputs with slopes: storage, ... */
  int      storage, momentum;          /* ... others from the first on, the fluids' momentum from the second */
  int      first[OUT_COUNT + 1];       /* of each row: its first slope; last: their number */
  int      in[OUT_COUNT * IN_ALL];     /* input of a slope ... */
  int      at[OUT_COUNT * IN_ALL];     /* ... and its place in PointOutput; of the volume: of IN_GRADU's */
  int      volumes, volume[OUT_COUNT]; /* slopes with IN_VOLUME */
  int      width, store;               /* numbers of a particle in ... */
  float   *value;                      /* [groups][width][LANES] slopes */
  double  *stored;                     /* [groups][store][LANES] those of storage, then d det F */
  PetscInt cap;                        /* groups they have room for */
} Tangents;

/* Pattern and room for the tangents of this rank's particles. */
PetscErrorCode TangentsBegin(const Model *m, Tangents *t);
PetscErrorCode TangentsEnd(Tangents *t);
/* Keeps that of the q-th particle. */
void TangentsKeep(Tangents *t, PetscInt q, const PointOutput *o);
/* Changes of the outputs of a group that changes of its inputs make; in: but for IN_VOLUME, which is found here.
   momentum: only of the outputs that the fluids' rows (16) read. */
void TangentsApply(const Tangents *t, PetscInt group, bool momentum, Lanes in[IN_ALL], Lanes out[OUT_COUNT]);
