/* The reduced matrix, between what fills it (reduced_matrix.c) and what solves with it (reduced.c). */
#ifndef CLATHRA_MODEL_REDUCED_H
#define CLATHRA_MODEL_REDUCED_H

#include "solver.h"

enum { FLOW = 0, MOTION, GROUPS };

struct Reduced {
  FieldSet     fs;                           /* unknowns of a node */
  bool         split;                        /* flow, then motion, each with a solver of its own; else one of all */
  int          groups;                       /* that have unknowns */
  int          first[GROUPS], count[GROUPS]; /* their places */
  const char  *prefix;                       /* of the options of the solver */
  int          full[F_COUNT];                /* place in the block of the scene's set */
  double      *value;                        /* [n_local][NEIGHBOURS][fs.n][fs.n]; null between two renewals */
  double       row[F_COUNT], col[F_COUNT];   /* units of rows and columns: each one number for the whole body ... */
  double       unit[F_COUNT][F_COUNT];       /* ... columns over rows */
  Mat          block[GROUPS][GROUPS], A;     /* between two renewals: of the groups; all of it */
  KSP          ksp;                          /* null between steps */
  MatNullSpace rigid;                        /* null without motion */
  Vec          b, y;                         /* owned nodes: all of a group, then all of the next */
  Vec          velocity_rows, diagonal; /* of the scene's set, rows (16) of the Jacobian: times y, their diagonal */
};

/* Is unknown k of node I a prescribed one? */
static inline bool ReducedHolds(const Model *m, const Reduced *r, PetscInt I, int k)
{
  return (m->mask[I] >> r->full[k]) & 1u;
}

PetscErrorCode ReducedUnits(Model *m, Reduced *r);    /* of rows and columns, from Newton's scales */
PetscErrorCode ReducedMatrices(Model *m, Reduced *r); /* of the groups, and all of it, from the values of all ranks */

#endif
