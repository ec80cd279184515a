/* What the particles of a block get from their nodes and give to them, and how a loop over them says that something is
 * wrong. */
#pragma once

#include "lanes.h"

/* What a loop over particles finds wrong: of the width of its numbers, so that the loop stays vector code. */
typedef int64_t Wrong;
#define WRONG_UNLESS(condition) ((condition) ? (Wrong)0 : (Wrong)1)

/* Rows of nodes are no longer than so many lanes where they are gathered, ... */
#define GATHERED (3 * LANES)
/* ... and where particles give to them. */
#define GIVEN (5 * LANES)

typedef struct {
  double value[BLOCK][GATHERED], dx[BLOCK][LANES], dy[BLOCK][LANES]; /* at the particle; gradients of the first row */
} Gathered;

/* A block's values, one row of numbers for each particle; x, y: what is multiplied with the node's place in the 3 x 3
   patch (carried values), with both its places (cross) and with the gradients (forces). */
typedef struct {
  double value[BLOCK][GIVEN], carry[CL_DIM][BLOCK][LANES], cross[BLOCK][LANES], force[CL_DIM][BLOCK][LANES];
} Given;

/* From nodes that hold `rows` rows of lanes each. */
INLINE void Gather(const Explicit *e, const double *nodes, int rows, Run r, const Weights *w, Gathered *g)
{
  const int stride = (int)e->m->grid.gm[0];

  for (int q = 0; q < r.n; q++) {
    const int *slot = &e->slot[w->first[q]];
    Lanes      v[GATHERED / LANES], x = {0.0}, y = {0.0};

    for (int z = 0; z < rows; z++)
      v[z] = (Lanes){0.0};
    for (int b = 0; b < 3; b++) {
      const double Sy = w->S[1][b][q], Dy = w->D[1][b][q];

      for (int a = 0; a < 3; a++) {
        const Lanes *row = (const Lanes *)nodes + (size_t)slot[b * stride + a] * (size_t)rows;
        const double S   = w->S[0][a][q] * Sy;

        x += row[0] * (w->D[0][a][q] * Sy);
        y += row[0] * (w->S[0][a][q] * Dy);
        for (int z = 0; z < rows; z++)
          v[z] += row[z] * S;
      }
    }
    for (int z = 0; z < rows; z++)
      *(Lanes *)&g->value[q][z * LANES] = v[z];
    *(Lanes *)g->dx[q] = x;
    *(Lanes *)g->dy[q] = y;
  }
}

/* Nothing to carry, no forces, and nothing beyond the first `count` values. */
INLINE void GiveNothing(Run r, int count, Given *v)
{
  for (int q = 0; q < r.n; q++) {
    for (int k = 0; k < LANES; k++)
      v->carry[0][q][k] = v->carry[1][q][k] = v->cross[q][k] = v->force[0][q][k] = v->force[1][q][k] = 0.0;
    for (int k = count; k < LANES * Rows(count); k++)
      v->value[q][k] = 0.0;
  }
}

/* Mixed second derivative at particle q of a number that nodes hold in their rows, `width` numbers long (395). */
INLINE double Mixed(const Explicit *e, const double *nodes, int width, const Weights *w, int q)
{
  const int *slot = &e->slot[w->first[q]], stride = (int)e->m->grid.gm[0];
  double     sum = 0.0;

  for (int b = 0; b < 3; b++) {
    for (int a = 0; a < 3; a++)
      sum += w->D[0][a][q] * w->D[1][b][q] * nodes[slot[b * stride + a] * width];
  }
  return sum;
}

/* sum S (u - u_q) (v - v_q) of two numbers that nodes hold in their rows and particle q has got from them (g). */
INLINE double Covariance(const Explicit *e, const double *nodes, int width, int u, int v, const Weights *w,
                         const Gathered *g, int q)
{
  const int *slot = &e->slot[w->first[q]], stride = (int)e->m->grid.gm[0];
  double     sum = 0.0;

  for (int b = 0; b < 3; b++) {
    for (int a = 0; a < 3; a++) {
      const double *row = &nodes[slot[b * stride + a] * width];

      sum += w->S[0][a][q] * w->S[1][b][q] * (row[u] - g->value[q][u]) * (row[v] - g->value[q][v]);
    }
  }
  return sum;
}

/* What is carried to the nodes besides the value itself: nothing, by gradients, by a mixed derivative, too. */
enum { CARRY_NOTHING = 0, CARRY_LINEAR, CARRY_BILINEAR };
/* To nodes that hold `count` numbers each; forces: are there any? */
INLINE void Scatter(const Explicit *e, double *nodes, int count, int carries, bool forces, Run r, const Weights *w,
                    const Given *v)
{
  const int rows = Rows(count), stride = (int)e->m->grid.gm[0];

  for (int q = 0; q < r.n; q++) {
    const int   *slot  = &e->slot[w->first[q]];
    const Lanes *value = (const Lanes *)v->value[q];
    const Lanes  cx = *(const Lanes *)v->carry[0][q], cy = *(const Lanes *)v->carry[1][q];
    const Lanes  fx = *(const Lanes *)v->force[0][q], fy = *(const Lanes *)v->force[1][q];
    const double x[3] = {0.0, 1.0, w->third[0][q]}, y[3] = {0.0, 1.0, w->third[1][q]};

    for (int b = 0; b < 3; b++) {
      const double Sy = w->S[1][b][q], Dy = w->D[1][b][q];

      for (int a = 0; a < 3; a++) {
        const double S = w->S[0][a][q] * Sy, Gx = w->D[0][a][q] * Sy, Gy = w->S[0][a][q] * Dy;
        Lanes       *row   = (Lanes *)nodes + (size_t)slot[b * stride + a] * (size_t)rows;
        Lanes        first = value[0];

        if (carries)
          first += cx * x[a] + cy * y[b];
        if (carries == CARRY_BILINEAR)
          first += *(const Lanes *)v->cross[q] * (x[a] * y[b]);
        row[0] += forces ? first * S + fx * Gx + fy * Gy : first * S;
        for (int z = 1; z < rows; z++)
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
