/* Where a nodal field alternates from node to node along an axis: (440) of docs/equations.md. */
#include "clathra/grid.h"
#include "clathra/tensor.h"
#include <math.h>

static inline double BendOf(const double *bend, PetscInt I, int d)
{
  return bend[(I * CL_DIM + d) * ALTERNATION_COUNT + ALTERNATION_SHARE];
}

static inline bool Known(const double *bend, PetscInt I, int d)
{
  return bend[(I * CL_DIM + d) * ALTERNATION_COUNT + ALTERNATION_KNOWN] > 0.0;
}

/* The neighbours of an owned node along axis d; negative: there is none. */
static void Beside(const Grid *g, const NodeMap *map, const NodalField *f, PetscInt I, int d, PetscInt K[2])
{
  for (int side = 0; side < 2; side++) {
    PetscInt ij[CL_DIM];

    for (int i = 0; i < CL_DIM; i++)
      ij[i] = map->ij[I][i] + (i == d ? 2 * side - 1 : 0);
    K[side] = NodeMapAt(g, map, ij);
    if (K[side] >= 0 && !isfinite(f->value[K[side]]))
      K[side] = -1;
  }
}

/* How unlike the slopes on both sides of a node are: 0 within a factor of three (bends: where they are equal, all from
   a factor of three on), 1 where the field has a minimum, -1 where it has a maximum. */
static double Bend(const Grid *g, const NodeMap *map, const NodalField *f, PetscInt I, int d, const PetscInt K[2])
{
  const PetscInt i = map->ij[I][d];
  const double   v = f->value[I], change[2] = {v - f->value[K[0]], f->value[K[1]] - v};
  const double   before = change[0] / LinesWidth(&g->line[d], i - 1), after = change[1] / LinesWidth(&g->line[d], i);

  if (fabs(change[0]) + fabs(change[1]) < f->least)
    return 0.0;
  const double turn = 2.0 * fabs(after - before) / (fabs(before) + fabs(after)) - (f->bends ? 0.0 : 1.0);

  return turn > 0.0 ? copysign(fmin(turn, 1.0), after - before) : 0.0;
}

static PetscErrorCode FindBends(const Grid *g, NodeMap *map, const NodalField *f, double *bend)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < map->n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      double  *to = &bend[(I * CL_DIM + d) * ALTERNATION_COUNT];
      PetscInt K[2];

      Beside(g, map, f, I, d, K);
      if (K[0] < 0 || K[1] < 0 || !isfinite(f->value[I]))
        continue;
      to[ALTERNATION_SHARE] = Bend(g, map, f, I, d, K);
      to[ALTERNATION_KNOWN] = 1.0;
    }
  }
  PetscCall(NodeMapBroadcast(map, bend, ALTERNATION_COUNT * CL_DIM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Harmonic mean of the bends of a node and of a neighbour that bends the other way, as a border does that the flow
   comes from. */
static double Alternates(const NodalField *f, const double *bend, PetscInt I, int d, const PetscInt K[2])
{
  const double own  = BendOf(bend, I, d);
  double       most = 0.0;

  for (int side = 0; side < 2; side++) {
    const bool   known  = Known(bend, K[side], d);
    const bool   enters = !known && (side ? -1.0 : 1.0) * f->flow[I * CL_DIM + d] > 0.0;
    const double other  = known ? BendOf(bend, K[side], d) : enters ? -own : 0.0;

    if (own * other < 0.0)
      most = fmax(most, -2.0 * own * other / (fabs(own) + fabs(other)));
  }
  return most;
}

/* theta_I: what alternates. */
static PetscErrorCode FindShares(const Grid *g, NodeMap *map, const NodalField *f, const double *bend, double *found)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < map->n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      PetscInt K[2];

      if (BendOf(bend, I, d) == 0.0)
        continue;
      Beside(g, map, f, I, d, K);
      found[I * CL_DIM + d] = Alternates(f, bend, I, d, K);
    }
  }
  PetscCall(NodeMapBroadcast(map, found, CL_DIM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode NodeMapAlternation(const Grid *g, NodeMap *map, const NodalField *f, double *share)
{
  double *found;

  PetscFunctionBeginUser;
  PetscCall(PetscArrayzero(share, map->n_local * CL_DIM * ALTERNATION_COUNT));
  PetscCall(FindBends(g, map, f, share));
  if (f->bends) {
    for (PetscInt k = 0; k < map->n_local * CL_DIM; k++)
      share[k * ALTERNATION_COUNT + ALTERNATION_SHARE] = fabs(share[k * ALTERNATION_COUNT + ALTERNATION_SHARE]);
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(PetscCalloc1((size_t)CL_DIM * (size_t)map->n_local, &found));
  PetscCall(FindShares(g, map, f, share, found));
  for (PetscInt I = 0; I < map->n_owned; I++) { /* a bend beside a node that alternates will be the next one */
    for (int d = 0; d < CL_DIM; d++) {
      const double own = fabs(BendOf(share, I, d));
      PetscInt     K[2];

      if (own == 0.0)
        continue;
      Beside(g, map, f, I, d, K);
      share[(I * CL_DIM + d) * ALTERNATION_COUNT + ALTERNATION_SHARE] =
          fmax(found[I * CL_DIM + d], fmin(own, fmax(found[K[0] * CL_DIM + d], found[K[1] * CL_DIM + d])));
    }
  }
  PetscCall(NodeMapBroadcast(map, share, ALTERNATION_COUNT * CL_DIM));
  PetscCall(PetscFree(found));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define WHOLE 0.5 /* of a particle: the node's share is the particle's */

double AlternationOf(const double mean[CL_DIM][ALTERNATION_COUNT], const double h[CL_DIM], const double K[CL_SYMMETRIC])
{
  double sum = 0.0, all = 0.0;

  for (int d = 0; d < CL_DIM; d++) { /* weighted with h_d |a_d| */
    const double w = h[d] * sqrt(K[cl_symmetric[d][d]]), known = mean[d][ALTERNATION_KNOWN];

    sum += known > 0.0 ? w * fmin(1.0, mean[d][ALTERNATION_SHARE] / (WHOLE * known)) : 0.0;
    all += w;
  }
  return all > 0.0 ? sum / all : 0.0;
}
