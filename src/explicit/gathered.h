/* What the particles of a block get from their nodes and give to them, and how a loop over them says that something is
 * wrong. */
#pragma once

#include "lanes.h"

/* What a loop over particles finds wrong: of the width of its numbers, so that the loop stays vector code. */
typedef int64_t Wrong;
#define WRONG_UNLESS(condition) ((condition) ? (Wrong)0 : (Wrong)1)

/* Rows of nodes are no longer than so many lanes where they are gathered, ... */
#define GATHERED ((CL_DIM == 2 ? 3 : 5) * LANES)
/* ... and where particles give to them. */
#define GIVEN ((CL_DIM == 2 ? 5 : 6) * LANES)
/* ... of which the first may be carried. */
#define CARRIED (2 * LANES)
/* The numbers of a row whose gradients are gathered stand in its first so many lanes. */
#define GRADED ((CL_DIM == 2 ? 1 : 2) * LANES)

typedef struct {
  double value[BLOCK][GATHERED], grad[CL_DIM][BLOCK][GRADED]; /* at the particle */
  double swell[BLOCK], beyond[CL_DIM][CL_DIM][BLOCK]; /* what MeanMotion has added to the gradient of the velocity, 1/s:
                                                         b of (88) on each axis, across the plane too, and (160) */
} Gathered;

/* A block's values, one row of numbers for each particle: what is multiplied with the node's place in the patch
   (carried values), with products of its places (cross) and with the gradients (forces). */
typedef struct {
  double value[BLOCK][GIVEN], carry[CL_DIM][BLOCK][CARRIED], cross[CL_MIXED][BLOCK][LANES], force[CL_DIM][BLOCK][LANES];
  double across[BLOCK]; /* of the force of the stress: across the plane, J; 0 in space */
} Given;

/* Gradient of number k at particle q. */
INLINE void GradientOf(const Gathered *g, int q, int k, double G[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    G[d] = g->grad[d][q][k];
}

/* From nodes that hold so many eights of numbers each; gradients of the first of them. */
INLINE void Gather(const Explicit *e, const double *nodes, int eights, int graded_eights, Run r, const Weights *w,
                   Gathered *g)
{
  const int rows = eights * PIECES, graded = graded_eights * PIECES;

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];
    Register   v[GATHERED / CL_REGISTER], grad[CL_DIM][GRADED / CL_REGISTER];

    for (int z = 0; z < rows; z++)
      v[z] = (Register){0.0};
    for (int d = 0; d < CL_DIM; d++) {
      for (int z = 0; z < graded; z++)
        grad[d][z] = (Register){0.0};
    }
    for (int k = 0; k < PATCH_ROWS; k++) {
      const PatchRow at = PatchRowOf(e, w, q, k);

      for (int a = 0; a < 3; a++) {
        const Register *row = (const Register *)nodes + (size_t)slot[at.at + a] * (size_t)rows;
        const double    S   = w->S[0][a][q] * at.S;
        double          G[CL_DIM];

        PatchGradient(w, q, &at, a, G);
        for (int z = 0; z < graded; z++) {
          for (int d = 0; d < CL_DIM; d++)
            grad[d][z] += row[z] * G[d];
        }
        for (int z = 0; z < rows; z++)
          v[z] += row[z] * S;
      }
    }
    for (int z = 0; z < rows; z++)
      *(Register *)&g->value[q][z * CL_REGISTER] = v[z];
    for (int d = 0; d < CL_DIM; d++) {
      for (int z = 0; z < graded; z++)
        *(Register *)&g->grad[d][q][z * CL_REGISTER] = grad[d][z];
    }
  }
}

/* (160), (88): the gradients of the particles' velocity, which stand in g from number `at` on, as their cells' means
   have them. */
INLINE void MeanMotion(const Explicit *e, Set s, Run r, const Weights *w, int at, Gathered *g)
{
  const CellShare take   = CellShareOf(e);
  const bool      shares = s.solid && TakesCellMean(e);

  memset(g->swell, 0, sizeof(g->swell));
  memset(g->beyond, 0, sizeof(g->beyond));
  for (int q = 0; shares && q < r.n; q++) {
    AxisParts part[CL_DIM];
    double    more = 0.0;

    PartsOf(w, q, part);
    for (int i = 0; i < CL_DIM; i++)
      more -= g->grad[i][q][at + i] / part[i].whole;
    for (int c = 0; c < CL_CORNERS; c++) {
      const double share = PartMoment(part, c, 0);
      const int    row   = e->slot[w->first[q] + CornerAt(e, c)];

      if (!(share > 0.0))
        continue;
      more += share * e->swell[row];
      for (int i = 0; take.strain > 0.0 && i < CL_DIM; i++) {
        for (int j = 0; j < CL_DIM; j++)
          g->beyond[i][j][q] += take.strain * share * (e->part[row][i][j] - g->grad[j][q][at + i] / part[j].whole);
      }
    }
    g->swell[q] = take.volume * more;
    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        g->grad[j][q][at + i] += g->beyond[i][j][q] + (i == j ? g->swell[q] : 0.0);
    }
  }
}

/* Nothing to carry in so many eights, no forces, and nothing beyond the first `count` values. */
INLINE void GiveNothing(Run r, int count, int carried, Given *v)
{
  for (int q = 0; q < r.n; q++) {
    for (int k = 0; k < LANES * carried; k++) {
      for (int d = 0; d < CL_DIM; d++)
        v->carry[d][q][k] = 0.0;
    }
    for (int k = 0; k < LANES; k++) {
      for (int d = 0; d < CL_DIM; d++)
        v->force[d][q][k] = 0.0;
      for (int c = 0; c < CL_MIXED; c++)
        v->cross[c][q][k] = 0.0;
    }
    for (int k = count; k < LANES * Rows(count); k++)
      v->value[q][k] = 0.0;
  }
}

/* Mixed derivative c at particle q of a number that nodes hold in their rows, `width` numbers
   long (395), (446). */
INLINE double Mixed(const Explicit *e, const double *nodes, int width, const Weights *w, int q, int c)
{
  const int *slot = &e->slot[w->first[q]];
  double     sum  = 0.0;

  for (int k = 0; k < PATCH_ROWS; k++) {
    const PatchRow at = PatchRowOf(e, w, q, k);
    double         of = 1.0; /* of the axes beyond x */

    for (int d = 1; d < CL_DIM; d++)
      of *= cl_mixed[c][d] ? w->D[d][at.place[d]][q] : w->S[d][at.place[d]][q];
    for (int a = 0; a < 3; a++)
      sum += (cl_mixed[c][0] ? w->D[0][a][q] : w->S[0][a][q]) * of * nodes[slot[at.at + a] * width];
  }
  return sum;
}

/* What is carried to the nodes besides the value itself: nothing, by gradients, by mixed derivatives, too. */
enum { CARRY_NOTHING = 0, CARRY_LINEAR, CARRY_BILINEAR };
/* To nodes that hold `count` numbers each, of which the first `acting` may be carried or have forces; the latter stand
   in the first eight.  forces: are there any? */
INLINE void Scatter(const Explicit *e, double *nodes, int count, int carries, int acting, bool forces, Run r,
                    const Weights *w, const Given *v)
{
  const int rows = Rows(count) * PIECES, carried = (acting + CL_REGISTER - 1) / CL_REGISTER;
  const int first = PetscMin(carried, PIECES);

  for (int q = 0; q < r.n; q++) {
    const int      *slot  = &e->slot[w->first[q]];
    const Register *value = (const Register *)v->value[q];
    double          x[CL_DIM][3];

    for (int d = 0; d < CL_DIM; d++) {
      x[d][0] = 0.0;
      x[d][1] = 1.0;
      x[d][2] = w->third[d][q];
    }
    for (int k = 0; k < PATCH_ROWS; k++) {
      const PatchRow at = PatchRowOf(e, w, q, k);

      for (int a = 0; a < 3; a++) {
        Register    *row = (Register *)nodes + (size_t)slot[at.at + a] * (size_t)rows;
        const double S   = w->S[0][a][q] * at.S;
        double       G[CL_DIM], place[CL_DIM];

        PatchGradient(w, q, &at, a, G);
        place[0] = x[0][a];
        for (int d = 1; d < CL_DIM; d++)
          place[d] = x[d][at.place[d]];
        for (int z = 0; z < first; z++) {
          Register sum = value[z];

          for (int d = 0; d < CL_DIM && carries; d++)
            sum += ((const Register *)v->carry[d][q])[z] * place[d];
          for (int c = 0; c < CL_MIXED && carries == CARRY_BILINEAR; c++)
            sum += ((const Register *)v->cross[c][q])[z] * MixedProduct(c, 1.0, place);
          sum *= S;
          for (int d = 0; d < CL_DIM && forces; d++)
            sum += ((const Register *)v->force[d][q])[z] * G[d];
          row[z] += sum;
        }
        for (int z = first; z < carried; z++) {
          Register sum = value[z];

          for (int d = 0; d < CL_DIM; d++)
            sum += ((const Register *)v->carry[d][q])[z] * place[d];
          row[z] += sum * S;
        }
        for (int z = carried; z < rows; z++)
          row[z] += value[z] * S;
      }
    }
  }
}

/* Particle of a block with the largest value; NaN is larger than all. */
static inline PetscInt Worst(Run r, const double size[])
{
  int worst = 0;

  for (int q = 1; q < r.n && !isnan(size[worst]); q++) {
    if (!(size[q] <= size[worst]))
      worst = q;
  }
  return r.p + worst;
}
