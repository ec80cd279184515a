/* Plastic strain averaged over neighbours (85): against sums over all pairs, on any number of ranks; planes of
   symmetry; materials of their own; increments counted once. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include "clathra/particles.h"
#include "random.h"
#include "ranks.h"

#define COUNT 400
#define LENGTH 0.09 /* of material 0; material 1 has 1.3 times it, material 2 none */

typedef struct {
  Grid      g;
  Scene     c;
  Material  mat[3];
  Region    region[3];
  Bc        bc[2];
  Particles P;
} SmallScene;

/* What particle id is, from its number alone. */
typedef struct {
  double x[2], V, eps, nonlocal, averaged;
  int    material;
} One;

static One OneOf(int id)
{
  Rng r = {0x9E3779B97F4A7C15ULL * (uint64_t)(id + 1)};
  One o;

  for (int k = 0; k < 3; k++)
    (void)RngUnit(&r);
  o.x[0]     = RngUnit(&r);
  o.x[1]     = 0.5 * RngUnit(&r);
  o.V        = RngBetween(&r, 1e-4, 3e-4);
  o.averaged = RngBetween(&r, 0.0, 0.3);
  o.eps      = o.averaged + (o.x[0] < 0.6 ? RngBetween(&r, 0.0, 0.1) : 0.0); /* nothing grows in the rest */
  o.nonlocal = RngBetween(&r, 0.0, 0.3);
  o.material = RngPick(&r, 3);
  return o;
}

static void Make(SmallScene *s, PetscInt rollers)
{
  const double   lower[2] = {0.0, 0.0}, upper[2] = {1.0, 0.5};
  const PetscInt cells[2] = {25, 12};

  memset(s, 0, sizeof(*s));
  Call(GridCreate(PETSC_COMM_WORLD, lower, upper, cells, &s->g));
  s->mat[0].plasticity.nonlocal = LENGTH;
  s->mat[1].plasticity.nonlocal = 1.3 * LENGTH;
  for (int k = 0; k < 3; k++)
    s->region[k].material = k;
  s->bc[0] = (Bc){.type = BC_ROLLER, .axis = 0, .position = 0.0};
  s->bc[1] = (Bc){.type = BC_ROLLER, .axis = 1, .position = 0.5};
  s->c = (Scene){.nmaterial = 3, .nregion = 3, .material = s->mat, .region = s->region, .nbc = rollers, .bc = s->bc};
  Call(ParticlesCreate(HAS_SOLID | HAS_PLASTIC | HAS_NONLOCAL, &s->P));
  for (int id = 0; id < COUNT; id++) {
    const One      o = OneOf(id);
    const PetscInt p = s->P.n;
    PetscInt       cell[2];

    if (!GridCell(&s->g, o.x, cell) || GridCellOwner(&s->g, cell) != s->g.rank)
      continue;
    Call(ParticlesResize(&s->P, p + 1));
    for (int d = 0; d < 2; d++)
      s->P.f[P_X + d][p] = o.x[d];
    s->P.f[P_V][p]             = o.V;
    s->P.f[P_EPS][p]           = o.eps;
    s->P.f[P_AVERAGED][p]      = o.averaged;
    s->P.f[P_NONLOCAL][p]      = o.nonlocal;
    s->P.f[P_NONLOCAL_RATE][p] = 7.0;
    s->P.i[PI_ID][p]           = id;
    s->P.i[PI_REGION][p]       = o.material;
  }
}

static void Free(SmallScene *s)
{
  Call(ParticlesDestroy(&s->P));
  Call(GridDestroy(&s->g));
}

/* (85) as it stands, over everything and its images. */
static double Reference(int id, PetscInt rollers)
{
  const One    a   = OneOf(id);
  const double l   = a.material == 0 ? LENGTH : 1.3 * LENGTH;
  double       sum = 0.0, weights = 0.0;

  for (int k = 0; k < COUNT; k++) {
    const One b = OneOf(k);

    for (int image = 0; image < 4; image++) {
      const bool   left = image & 1, up = image & 2;
      const double x = left ? -b.x[0] : b.x[0], y = up ? 1.0 - b.x[1] : b.x[1];
      const double r = hypot(x - a.x[0], y - a.x[1]) / l;

      if (b.material != a.material || (left && rollers < 1) || (up && rollers < 2) || r >= 3.0)
        continue;
      sum += b.V * r * exp(-r * r) * (b.eps - b.averaged);
      weights += b.V * r * exp(-r * r);
    }
  }
  return sum / weights;
}

static void TestPairs(void **state)
{
  double worst = 0.0;

  (void)state;
  for (PetscInt rollers = 0; rollers <= 2; rollers++) {
    SmallScene s;

    Make(&s, rollers);
    Call(ParticlesNonlocal(&s.c, &s.g, 0.5, &s.P));
    for (PetscInt p = 0; p < s.P.n; p++) {
      const int    id = (int)s.P.i[PI_ID][p];
      const One    o  = OneOf(id);
      const double d  = o.material == 2 ? o.eps - o.averaged : Reference(id, rollers);

      worst = fmax(worst, fabs(s.P.f[P_NONLOCAL][p] - o.nonlocal - d));
      worst = fmax(worst, fabs(s.P.f[P_NONLOCAL_RATE][p] - d / 0.5));
      Check(s.P.f[P_AVERAGED][p] == o.eps && s.P.f[P_EPS][p] == o.eps);
    }
    Call(ParticlesNonlocal(&s.c, &s.g, 0.5, &s.P)); /* nothing has grown since */
    for (PetscInt p = 0; p < s.P.n; p++) {
      const One o = OneOf((int)s.P.i[PI_ID][p]);

      Check(s.P.f[P_NONLOCAL_RATE][p] == 0.0);
      worst = fmax(worst, o.material == 2 ? fabs(s.P.f[P_NONLOCAL][p] - o.nonlocal - (o.eps - o.averaged)) : 0.0);
    }
    Free(&s);
  }
  Call(MPI_Allreduce(MPI_IN_PLACE, &worst, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  if (world_rank == 0)
    printf("nonlocal plastic strain against all pairs: off by %.1e\n", worst);
  Check(worst < 1e-13);
}

/* What is the same everywhere stays so; a particle without neighbours has its own. */
static void TestEven(void **state)
{
  SmallScene s;

  (void)state;
  Make(&s, 1);
  for (PetscInt p = 0; p < s.P.n; p++) {
    s.P.f[P_EPS][p] = s.P.f[P_AVERAGED][p] + 0.02;
    if (s.P.i[PI_ID][p] == 11) { /* far from the rest */
      s.P.f[P_X][p] = s.P.f[P_X][p] < 0.5 ? -40.0 : 40.0;
      s.P.f[P_EPS][p] += 0.03;
    }
  }
  Call(ParticlesNonlocal(&s.c, &s.g, 0.0, &s.P));
  for (PetscInt p = 0; p < s.P.n; p++) {
    const One o = OneOf((int)s.P.i[PI_ID][p]);

    Check(fabs(s.P.f[P_NONLOCAL][p] - o.nonlocal - (s.P.i[PI_ID][p] == 11 ? 0.05 : 0.02)) < 1e-15);
    Check(s.P.f[P_NONLOCAL_RATE][p] == 0.0); /* a call at no time says nothing of a rate */
  }
  Free(&s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestPairs), cmocka_unit_test(TestEven)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
