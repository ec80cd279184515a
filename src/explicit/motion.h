/* How the particles of a block are strained and move in a step; docs/equations.md, section 12. */
#pragma once

#include "clathra/point_strain.h"
#include "gathered.h"

#define MOST_MOVED 0.5     /* of a cell, in a step */
#define LARGEST_STRAIN 0.1 /* of one step: beyond it the series below lose digits, and the step is no small one */

typedef struct {
  double turn[CL_TURN][BLOCK], e[CL_TENSOR][BLOCK], stretch[CL_DIM][BLOCK], J[BLOCK], log_J[BLOCK],
      H[CL_DIM][CL_DIM][BLOCK]; /* of the particle's own place, without its cells' means; likewise stretch */
} Strain;

#if CL_DIM == 2

/* ln J by its series for J near 1. */
INLINE double LogOf(double J)
{
  const double z = (J - 1.0) / (J + 1.0), z2 = z * z;

  return 2.0 * z * (1.0 + z2 * (1.0 / 3.0 + z2 * (1.0 / 5.0 + z2 * (1.0 / 7.0 + z2 * (1.0 / 9.0 + z2 / 11.0)))));
}

/* (7) without branches: rotation c, s and logarithmic strain 1/2 ln F F^T by series in small increments; false if one
 * is not small. */
INLINE bool StrainOf(const Set s, int n, const Gathered *g, double dt, Strain *o)
{
  const int at    = C_Vs(s);
  Wrong     large = 0;

  for (int q = 0; q < n; q++) {
    const double Hxx = dt * g->grad[0][q][at], Fxy = dt * g->grad[1][q][at], Fyx = dt * g->grad[0][q][at + 1],
                 Hyy = dt * g->grad[1][q][at + 1], Fxx = 1.0 + Hxx, Fyy = 1.0 + Hyy;
    const Stretch of = StretchOf(Fxx, Fxy, Fyx, Fyy);
    const double  a = of.along, b = of.turn, per = 1.0 / sqrt(a * a + b * b), c = a * per, si = b * per, y = of.y;
    const double  J = Fxx * Fyy - Fxy * Fyx, lnJ = LogOf(J), across = 1.0 + dt * g->swell[q];
    const double  ratio =
        1.0 + y * (1.0 / 3.0 + y * (1.0 / 5.0 + y * (1.0 / 7.0 + y * (1.0 / 9.0 + y * (1.0 / 11.0 + y / 13.0)))));
    double e[CL_TENSOR], U[CL_DIM];

    large |= WRONG_UNLESS((fabs(J - 1.0) < LARGEST_STRAIN) & (y < LARGEST_STRAIN * LARGEST_STRAIN) & (a > 1.0));
    o->turn[0][q] = c;
    o->turn[1][q] = si;
    LogStrainOf(0.5 * lnJ, 0.5 * ratio * of.d / of.m, 0.5 * ratio * of.off / of.m, e);
    o->e[XX][q]   = e[XX];
    o->e[YY][q]   = e[YY];
    o->e[ZZ][q]   = LogOf(across);
    o->e[XY][q]   = e[XY];
    o->H[0][0][q] = Hxx - dt * (g->beyond[0][0][q] + g->swell[q]);
    o->H[0][1][q] = Fxy - dt * g->beyond[0][1][q];
    o->H[1][0][q] = Fyx - dt * g->beyond[1][0][q];
    o->H[1][1][q] = Hyy - dt * (g->beyond[1][1][q] + g->swell[q]);
    o->J[q]       = J * across;
    o->log_J[q]   = lnJ + o->e[ZZ][q];
    StretchDiagonal(c, si, Fxx, Fxy, Fyx, Fyy, U);
    o->stretch[0][q] = U[0] - dt * (g->beyond[0][0][q] + g->swell[q]);
    o->stretch[1][q] = U[1] - dt * (g->beyond[1][1][q] + g->swell[q]);
  }
  return !large; /* NaN is wrong as well */
}
#else
/* (432); false if a particle's is not small. */
INLINE bool StrainOf(const Set s, int n, const Gathered *g, double dt, Strain *o)
{
  const int at    = C_Vs(s);
  Wrong     large = 0;

  INDEPENDENT
  for (int q = 0; q < n; q++) {
    double H[3][3], F[3][3], cof[3][3], e[6], R[3][3], most = 0.0;

  #pragma GCC unroll 9
    for (int k = 0; k < 9; k++) {
      H[k / 3][k % 3]       = dt * g->grad[k % 3][q][at + k / 3];
      o->H[k / 3][k % 3][q] = H[k / 3][k % 3] - dt * (g->beyond[k / 3][k % 3][q] + (k % 4 == 0 ? g->swell[q] : 0.0));
      F[k / 3][k % 3]       = H[k / 3][k % 3] + (k % 4 == 0 ? 1.0 : 0.0);
    }
    SmallStretch(H, e, R);
    o->J[q]     = CofactorOf(F, cof);
    o->log_J[q] = e[XX] + e[YY] + e[ZZ];
  #pragma GCC unroll 6
    for (int k = 0; k < 6; k++) {
      o->e[k][q] = e[k];
      most       = Largest(most, fabs(e[k]));
    }
  #pragma GCC unroll 9
    for (int k = 0; k < 9; k++)
      o->turn[k][q] = R[k / 3][k % 3];
  #pragma GCC unroll 3
    for (int d = 0; d < 3; d++) /* diag U = diag R^T F */
      o->stretch[d][q] =
          R[0][d] * F[0][d] + R[1][d] * F[1][d] + R[2][d] * F[2][d] - dt * (g->beyond[d][d][q] + g->swell[q]);
    large |= WRONG_UNLESS((fabs(o->J[q] - 1.0) < LARGEST_STRAIN) & (most < LARGEST_STRAIN));
  }
  return !large;
}
#endif

/* The particle of a block that is strained most. */
static inline PetscInt Strained(Run r, const Strain *n)
{
  double size[BLOCK];

  for (int q = 0; q < r.n; q++) {
    size[q] = 0.0;
    for (int c = 0; c < CL_TENSOR; c++)
      size[q] += (c > ZZ ? 2.0 : 1.0) * n->e[c][q] * n->e[c][q];
  }
  return Worst(r, size);
}

/* The particle of a block that moves farthest, in cells; `most`: how far. */
static inline PetscInt Farthest(const Explicit *e, const Set s, Run r, const Gathered *g, double dt, double *most)
{
  double size[BLOCK];

  for (int q = 0; q < r.n; q++) {
    size[q] = 0.0;
    for (int d = 0; d < CL_DIM; d++) {
      const double u     = dt * g->value[q][C_Vs(s) + d];
      const double cells = fabs(u) / LinesLeastAt(&e->m->grid.line[d], e->m->P.f[P_X + d][r.p + q] - u);

      size[q] = cells > size[q] || isnan(cells) ? cells : size[q];
    }
  }
  const PetscInt worst = Worst(r, size);

  *most = size[worst - r.p];
  return worst;
}

/* A particle of a block that stands outside the grid; -1: none does. */
static inline PetscInt Outside(const Explicit *e, Run r)
{
  const Grid *grid = &e->m->grid;

  for (int q = 0; q < r.n; q++) {
    for (int d = 0; d < CL_DIM; d++) {
      const double x = LinesPlace(&grid->line[d], e->m->P.f[P_X + d][r.p + q]);

      if (!(x >= 0.0 && x <= (double)grid->cells[d]))
        return r.p + q;
    }
  }
  return -1;
}

/* Where a particle crosses half a cell a shorter step may help, where it crosses the edge of the grid none does. */
static inline void NoteStray(Explicit *e, const Set s, Run r, const Gathered *g, double dt)
{
  double         most;
  const PetscInt far = Farthest(e, s, r, g, dt, &most), out = Outside(e, r);

  if (most < MOST_MOVED && out >= 0 && !e->m->leaving.removes)
    ModelNoteFailure(e->m, CL_LEFT_GRID, "a particle leaves the background grid", out);
  else
    ModelNoteFailure(e->m, CL_TOO_FAR, "a particle moves more than half a cell in one step", far);
}

/* Does a particle, now at x, come from more than half a cell away? */
INLINE Wrong Strays(const GridLines *line, int n, const double *restrict u, const double *restrict x)
{
  const double h   = line->h;
  Wrong        far = 0;

  for (int q = 0; q < n && !line->x; q++)
    far |= WRONG_UNLESS(fabs(u[q]) < MOST_MOVED * h);
  for (int q = 0; q < n && line->x; q++)
    far |= WRONG_UNLESS(fabs(u[q]) < MOST_MOVED * LinesLeastAt(line, x[q] - u[q]));
  return far;
}

/* Has a particle, now at x, left the grid? */
INLINE Wrong Leaves(const GridLines *line, int n, const double *restrict x)
{
  const double lower = line->lower, upper = LinesAt(line, line->cells);
  Wrong        out = 0;

  for (int q = 0; q < n; q++)
    out |= WRONG_UNLESS((x[q] >= lower) & (x[q] <= upper));
  return out;
}

/* Makes the motion history; false if a particle crosses half a cell, or leaves a grid that none may leave (373). */
INLINE bool Move(Explicit *e, const Set s, Run r, const Gathered *g, const Strain *n, double dt)
{
  const Grid    *grid   = &e->m->grid;
  const bool     grows  = e->m->c->basis == BASIS_CPGIMP;
  ParticleMotion motion = {.log_J = n->log_J};
  double         u[CL_DIM][BLOCK];
  Wrong          far = 0, out = 0;

  for (int d = 0; d < CL_DIM; d++) {
    for (int q = 0; q < r.n; q++)
      u[d][q] = dt * g->value[q][C_Vs(s) + d];
    motion.u[d] = u[d];
    for (int j = 0; j < CL_DIM; j++)
      motion.H[d][j] = n->H[d][j];
    motion.stretch[d] = grows ? n->stretch[d] : NULL;
  }
  ParticlesKeep(&e->m->P, r.p, r.n, &motion);
  for (int d = 0; d < CL_DIM; d++) {
    far |= Strays(&grid->line[d], r.n, u[d], e->m->P.f[P_X + d] + r.p);
    out |= Leaves(&grid->line[d], r.n, e->m->P.f[P_X + d] + r.p);
  }
  e->gone = e->gone || out;
  return !far && (!out || e->m->leaving.removes);
}
