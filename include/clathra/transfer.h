/* What passes between particles and nodes besides sums and increments; docs/equations.md, section 5. */
#pragma once

#include "clathra/basis.h"
#include "clathra/particles.h"

/* All particles of this rank and where the grid has them. */
typedef struct {
  const Grid    *grid;
  NodeMap       *map;
  PetscInt       n;
  const Stencil *stencil; /* [n] */
} Transfer;

/* Share of it that is lost in dt (s): in some ten times of a wave across a cell (s), to a power of two, so that it does
   not matter when that was last looked at. */
static inline double UnseenShare(double dt, double across)
{
  return 1.0 - exp(-dt / (10.0 * exp2(round(log2(across)))));
}
/* (452): takes a share (dimensionless) of the motion that nodes do not see out of the velocities of all particles.
   Collective. */
PetscErrorCode TransferUnseen(const Transfer *t, const FieldSet *fs, double share, Particles *P);
