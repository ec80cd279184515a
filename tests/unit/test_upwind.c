/* Where heat is carried upstream (440): all of it where T alternates from node to node, nothing where T is smooth or
   has one extreme; whatever is added to T, along either axis, on a body that is turned, sheared and off its grid's
   lines. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "small_scene.h"
#include "model/additions.h"
#include "model/gather.h"

#define CONDUCTIVITY 0.7 /* W/(m K) that is to be left or not */

typedef double Field(const PetscInt ij[CL_DIM], int axis);

static const double middle[CL_DIM] = {0.3, 0.16}, turn = 0.35; /* rad */
static double       above, factor;                             /* T = above + factor field */

static double Sloping(const PetscInt ij[CL_DIM], int axis)
{
  return (double)(2 * ij[axis] + 3 * ij[1 - axis]);
}

/* A minimum on a line of the grid ... */
static double Valley(const PetscInt ij[CL_DIM], int axis)
{
  return pow((double)ij[axis] - 4.0, 2.0);
}

/* ... and between two. */
static double FlatValley(const PetscInt ij[CL_DIM], int axis)
{
  return pow((double)ij[axis] - 4.5, 2.0);
}

/* A bend with a slope that doubles. */
static double Bent(const PetscInt ij[CL_DIM], int axis)
{
  return fmax((double)ij[axis], 2.0 * (double)ij[axis] - 4.0);
}

static double Zigzag(const PetscInt ij[CL_DIM], int axis)
{
  return ij[axis] % 2 ? 1.0 : -1.0;
}

static double SlopingZigzag(const PetscInt ij[CL_DIM], int axis)
{
  return 0.25 * (double)ij[axis] + Zigzag(ij, axis);
}

static double Chessboard(const PetscInt ij[CL_DIM], int axis)
{
  return Zigzag(ij, axis) * Zigzag(ij, 1 - axis);
}

/* One node beside the border below both of its neighbours, smooth beyond. */
static double BesideBorder(const PetscInt ij[CL_DIM], int axis)
{
  return ij[axis] == 1 ? -0.5 : ij[axis] == 0 ? 0.0 : 0.5 * (double)ij[axis];
}

/* Alternates in nodes 1 to 3; node 4 is a corner whose next one bends nowhere. */
static double Corner(const PetscInt ij[CL_DIM], int axis)
{
  static const double T[5] = {0.0, 0.0, -0.2, 0.2, 0.1};

  return ij[axis] < 5 ? T[ij[axis]] : 0.1 - 5.0 * (double)(ij[axis] - 4);
}

static void Turn(SmallScene *s)
{
  for (PetscInt i = 0; i < s->m.P.n; i++) {
    double *const *f = s->m.P.f;
    const double   X = f[P_X][i] - middle[0] + 0.2 * (f[P_X + 1][i] - middle[1]), Y = f[P_X + 1][i] - middle[1];

    f[P_X][i]     = middle[0] + cos(turn) * X - sin(turn) * Y;
    f[P_X + 1][i] = middle[1] + sin(turn) * X + cos(turn) * Y;
  }
}

static SmallScene *Make(bool turned)
{
  const double whole[2][2] = {{0.0, 0.0}, {0.6, 0.32}}, part[2][2] = {{0.16, 0.093}, {0.44, 0.227}};
  SmallScene  *s = malloc(sizeof(*s));
  ClStatus     status;

  SceneInit(s, HAS_HEAT | HAS_WATER, false, false, BASIS_CPGIMP, 0.0, turned ? part[0] : whole[0],
            turned ? part[1] : whole[1]);
  s->c.scene.cells[0] *= 2;
  s->c.scene.cells[1] *= 2;
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  if (turned)
    Turn(s);
  Call(ModelBeginStep(&s->m, &status));
  Check(status == CL_OK);
  return s;
}

/* Least and largest share of the conductivity along `axis` that is left to a particle with low <= x <= high, m. */
static void Between(const SmallScene *s, int axis, double low, double high, double share[2])
{
  const Model *m = &s->m;

  share[0] = share[1] = -INFINITY;
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double x  = ParticleGridX(&m->P, p, axis);
    const double of = m->added->upwind[CL_SYMMETRIC * p + cl_symmetric[axis][axis]] / CONDUCTIVITY;

    if (x < low || x > high)
      continue;
    share[0] = fmax(share[0], -of);
    share[1] = fmax(share[1], of);
  }
  share[0] = -Largest(share[0]);
  share[1] = Largest(share[1]);
}

/* ... of all particles at a field of T. */
static void Shares(SmallScene *s, Field *field, int axis, double share[2])
{
  Model *m = &s->m;

  for (PetscInt I = 0; I < m->map.n_local; I++)
    m->x_n[I * m->c->fields.n + PlaceT(&m->c->fields)] = above + factor * field(m->map.ij[I], axis);
  Call(PetscArrayzero(m->added->upwind, CL_SYMMETRIC * m->P.n));
  for (PetscInt p = 0; p < m->P.n; p++)
    m->added->upwind[CL_SYMMETRIC * p + cl_symmetric[axis][axis]] = CONDUCTIVITY;
  Call(UpwindLimit(m));
  Between(s, axis, -INFINITY, INFINITY, share);
}

/* What changes no share: T = above + factor field. */
static const double added[3][2] = {{4.0, 1.0}, {300.0, -1.0}, {-50.0, 40.0}};

static const struct {
  const char *name;
  Field      *field;
  double      share;
  bool        turned; /* it says so on the turned body, too, whose border has nodes everywhere */
} known[] = {
    {"a slope", Sloping, 0.0, true},
    {"a valley on a line of the grid", Valley, 0.0, false},
    {"a valley between two", FlatValley, 0.0, false},
    {"a bend", Bent, 0.0, false},
    {"a zigzag", Zigzag, 1.0, true},
    {"a zigzag on a slope", SlopingZigzag, 1.0, true},
    {"a chessboard", Chessboard, 1.0, true},
};
#define KNOWN ((int)(sizeof(known) / sizeof(*known)))

static void TestWhere(void **state)
{
  (void)state;
  for (int turned = 0; turned < 2; turned++) {
    SmallScene *s = Make(turned);

    for (int k = 0; k < KNOWN; k++) {
      for (int v = 0; v < 6 && (known[k].turned || !turned); v++) {
        double share[2];

        above  = added[v / 2][0];
        factor = added[v / 2][1];
        Shares(s, known[k].field, v % 2, share);
        if (v < 2)
          Say("  %s: %s along %c: %.3g to %.3g\n", turned ? "turned" : "upright", known[k].name, v % 2 ? 'y' : 'x',
              share[0], share[1]);
        Check(fabs(share[0] - known[k].share) < 1e-12 && fabs(share[1] - known[k].share) < 1e-12);
      }
    }
    SceneDestroy(s);
    free(s);
  }
}

/* What Newton's method may leave is no zigzag. */
static void TestNoise(void **state)
{
  SmallScene *s = Make(false);
  double      share[2];

  (void)state;
  above  = 4.0;
  factor = 1e-4;
  Shares(s, Zigzag, 0, share);
  Check(share[1] == 0.0);
  factor = 1e-3;
  Shares(s, Zigzag, 0, share);
  Check(fabs(share[0] - 1.0) < 1e-9);
  SceneDestroy(s);
  free(s);
}

/* A corner beside nodes that alternate is next to them; the straight slope behind it is not. */
static void TestCorner(void **state)
{
  SmallScene *s = Make(false);

  (void)state;
  for (int v = 0; v < 3 * CL_DIM; v++) {
    const int   axis = v % CL_DIM;
    const Grid *g    = &s->m.grid;
    double      all[2], beside[2], beyond[2];

    above  = added[v / CL_DIM][0];
    factor = added[v / CL_DIM][1];
    Shares(s, Corner, axis, all);
    Between(s, axis, GridNode(g, axis, 4), GridNode(g, axis, 5), beside);
    Between(s, axis, GridNode(g, axis, 5), GridNode(g, axis, 6), beyond);
    Say("  %g + %g T behind a corner along %c: %.3g to %.3g, a cell further %.3g to %.3g\n", above, factor,
        axis ? 'y' : 'x', beside[0], beside[1], beyond[0], beyond[1]);
    Check(beside[0] > 0.2 && beside[1] > 0.9 && beyond[1] < 1e-12);
  }
  SceneDestroy(s);
  free(s);
}

/* The water flows along an axis at 1 m/s times `sign`. */
static void Flow(SmallScene *s, int axis, double sign)
{
  Model *m = &s->m;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int d = 0; d < CL_DIM; d++)
      m->x_n[I * m->c->fields.n + PlaceV(&m->c->fields, PHASE_W) + d] = d == axis ? sign : 0.0;
  }
}

/* A wiggle of one node counts where its neighbour is the border that the flow comes from. */
static void TestBorder(void **state)
{
  SmallScene *s = Make(false);

  (void)state;
  above  = 4.0;
  factor = 1.0;
  for (int v = 0; v < 2 * CL_DIM; v++) {
    const int    axis = v / 2;
    const double sign = v % 2 ? -1.0 : 1.0;
    double       share[2];

    Flow(s, axis, sign);
    Shares(s, BesideBorder, axis, share);
    Say("  beside the border along %c, flow %s it: %.3g to %.3g\n", axis ? 'y' : 'x', sign > 0.0 ? "from" : "to",
        share[0], share[1]);
    Check(fabs(share[1] - fmax(sign, 0.0)) < 1e-12 && share[0] == 0.0);
  }
  SceneDestroy(s);
  free(s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestWhere), cmocka_unit_test(TestNoise),
                                     cmocka_unit_test(TestCorner), cmocka_unit_test(TestBorder)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
