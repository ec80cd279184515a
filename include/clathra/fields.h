/* fields: the six fields of the model, their nine nodal unknowns in the plane, their equations, and the subset of them
   that a scene needs.  docs/equations.md, section 10. */
#pragma once

#include <stdbool.h>
#include "clathra/dimension.h"

enum { PHASE_W = 0, PHASE_G = 1, PHASE_COUNT };
#define CL_FLUID_VECTORS (PHASE_COUNT * CL_DIM) /* numbers of a vector of each fluid */
/* Unknowns of a node: first components of the velocities, then the scalars. */
enum { F_VS = 0, F_VW = CL_DIM, F_VG = 2 * CL_DIM, F_PW = 3 * CL_DIM, F_PG, F_T, F_COUNT };

typedef struct {
  const char *name, *unit, *equation;
} FieldInfo;

extern const FieldInfo cl_field[F_COUNT];

/* What has fields of its own: bits that also say what a particle variable, a key or a condition needs. */
enum { HAS_SOLID = 1, HAS_WATER = 2, HAS_GAS = 4, HAS_HEAT = 8, HAS_ALL = 15 };
extern const char *const cl_field_word[]; /* solid, water, gas, heat; NULL ends it */
/* What a particle variable may need besides: a skeleton that yields, one whose hydrate bears a stress of its own, one
   whose strength follows the plastic strain of its neighbours. */
/* ... and what only a key may need: hydrate, at the start or by reaction. */
enum { HAS_PLASTIC = 16, HAS_BONDS = 32, HAS_NONLOCAL = 64, HAS_HYDRATE = 128 };
#define HAS_HISTORY (HAS_PLASTIC | HAS_BONDS) /* a skeleton that holds history besides its stress */

/* A field set.  A field that is not in it has no unknown, no row, no storage; its place is -1. */
typedef struct {
  unsigned has;                /* bits HAS_... */
  bool     solid, heat, fluid; /* moves; carries T; has a fluid at all */
  bool     phase[PHASE_COUNT]; /* fluids that are there */
  bool     inertia;            /* accelerations; false: quasi-static */
  int      n;                  /* unknowns of a node */
  int      at[F_COUNT];        /* place of each unknown in a node's block */
  int      field[F_COUNT];     /* unknown at each place */
} FieldSet;

/* From the bits; false for a set that cannot be (gas without water, nothing at all). */
bool FieldSetMake(unsigned has, bool inertia, FieldSet *fs);
/* "solid, water, gas, heat (thmc)"; the name of the set where the field has one. */
void FieldSetPrint(const FieldSet *fs, char *text, int size);
/* A set by its name (thmc, thc, hm, thm, m, ...); 0 for an unknown one. */
unsigned FieldSetByName(const char *name);

/* Place of the first component of the skeleton velocity among a node's unknowns; -1 without a solid. */
static inline int PlaceVs(const FieldSet *fs)
{
  return fs->at[F_VS];
}
/* ... of a fluid's velocity; -1 where the fluid is not there or has no unknown. */
static inline int PlaceV(const FieldSet *fs, int phase) /* velocity of a fluid */
{
  return fs->at[VectorAt(F_VW, phase, 0)];
}
/* ... of a fluid's pressure; -1 likewise. */
static inline int PlaceP(const FieldSet *fs, int phase)
{
  return fs->at[F_PW + phase];
}
/* ... of the temperature; -1 without heat. */
static inline int PlaceT(const FieldSet *fs)
{
  return fs->at[F_T];
}
