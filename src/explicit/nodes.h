/* Private to the node side of explicit/: what numbering, velocities and scalars share. */
#pragma once

#include "lanes.h"

/* Volume of the particles about a node; 0 where there are none. */
INLINE double Volume(const Explicit *e, const Set s, PetscInt I)
{
  return e->A[I * LANES * Rows(A_Count(s)) + A_V(s)];
}

/* Sums of a node, with what those that follow it in velocity give to it. */
INLINE const double *Balances(const Explicit *e, const Set s, PetscInt I)
{
  const int width = LANES * Rows(A_Count(s));

  return e->node[I].leads ? &e->G[I * width] : &e->A[I * width];
}

/* x of the n x n system A x = b by elimination with the diagonal as pivots: storage and capacity outweigh what couples
 * them. */
INLINE void SolveSmall(int n, double *A, double *b, double *x)
{
  for (int k = 0; k < n; k++) {
    for (int i = k + 1; i < n; i++) {
      const double c = A[i * n + k] / A[k * n + k];

      for (int j = k; j < n; j++)
        A[i * n + j] -= c * A[k * n + j];
      b[i] -= c * b[k];
    }
  }
  for (int k = n - 1; k >= 0; k--) {
    x[k] = b[k];
    for (int j = k + 1; j < n; j++)
      x[k] -= A[k * n + j] * x[j];
    x[k] /= A[k * n + k];
  }
}

/* Adds a share of n numbers. */
static inline void AddRow(double *to, double share, const double *from, int n)
{
  for (int k = 0; k < n; k++)
    to[k] += share * from[k];
}

/* Is this unknown of node I prescribed, and to which value? */
static inline bool Held(const Explicit *e, PetscInt I, int unknown, double *value)
{
  const int h = e->node[I].held, at = e->m->c->fields.at[unknown];

  if (h < 0 || !((e->mask[h] >> at) & 1u))
    return false;
  *value = e->fixed[h * e->m->c->fields.n + at];
  return true;
}

/* (41): increment k of a node, which keeps its own share (NodeInfo: own, own_v) and takes the rest from the node it
   follows. */
static inline double Blended(const Explicit *e, PetscInt I, double own, int width, const double *inc, int k)
{
  return own * inc[width * I + k] + (1.0 - own) * inc[width * e->node[I].root + k];
}

/* (454): increment k of a velocity, along axis d. */
static inline double Extended(const Explicit *e, PetscInt I, int k, int d)
{
  const double own = e->node[I].own_v;

  return Blended(e, I, own, INC, e->inc, k) + (1.0 - own) * e->lean[I][d];
}

/* Increment of the velocity of node I along d from its balance as it stands, undamped, m/s, and its factor there, N
 * s/m. */
double NodeFree(const Explicit *e, PetscInt I, int d, double dt, double *lhs);

/* Finds who follows whom (41), and adds to A of a leading node what its followers give up.  Collective. */
PetscErrorCode NodesFollow(Explicit *e);
