/* Exchange within cells (353), (354) on a body that is turned, sheared and shifted against its grid: what nodes see of
   the particles' pressures stays, what has been evened out stays so, and a pressure that is linear is left alone. */
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

#define ABOVE 3.25e6                                           /* Pa, of pressures */
static const double middle[CL_DIM] = {0.3, 0.16}, turn = 0.35; /* rad */

typedef double Field(const double x[CL_DIM], PetscInt id);

static double Linear(const double x[CL_DIM], PetscInt id)
{
  (void)id;
  return ABOVE + 2e5 * x[0] - 3e5 * x[1];
}

static double Uneven(const double x[CL_DIM], PetscInt id)
{
  return Linear(x, id) + 1e5 * Noise(7, id, 0);
}

static double Higher(const double x[CL_DIM], PetscInt id)
{
  return 7e6 + Uneven(x, id);
}

static void Pressures(SmallScene *s, Field *p)
{
  double *const *f = s->m.P.f;

  for (PetscInt i = 0; i < s->m.P.n; i++) {
    const double x[CL_DIM] = {f[P_X][i], f[P_X + 1][i]};

    f[P_PW][i] = f[P_PG][i] = p(x, s->m.P.i[PI_ID][i]);
    for (int k = 0; k < 2 * CL_DIM; k++)
      f[P_GW + k][i] = p == Linear ? (k % 2 ? -3e5 : 2e5) : 0.0;
    Refill(s, i, RegionOf(s, i)->Sh);
  }
}

/* Two layers 1e8 apart in permeability, turned, sheared by a fifth and off the lines of the grid. */
static SmallScene *Make(BasisType basis, bool axisymmetric)
{
  const double lower[2] = {0.21, 0.093}, upper[2] = {0.39, 0.217};
  SmallScene  *s = malloc(sizeof(*s));

  SceneInit(s, HAS_ALL, true, axisymmetric, basis, 0.0, lower, upper);
  s->c.scene.cells[0] *= 2;
  s->c.scene.cells[1] *= 2;
  SceneLayers(s, 1, 0.151, 1e-8);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  for (PetscInt i = 0; i < s->m.P.n; i++) {
    double *const *f = s->m.P.f;
    const double   X = f[P_X][i] - middle[0] + 0.2 * (f[P_X + 1][i] - middle[1]), Y = f[P_X + 1][i] - middle[1];

    f[P_X][i]     = middle[0] + cos(turn) * X - sin(turn) * Y;
    f[P_X + 1][i] = middle[1] + sin(turn) * X + cos(turn) * Y;
  }
  return s;
}

/* Change of the pressures in a step far longer than any exchange takes; `change` [n]. */
static void Evened(SmallScene *s, double *change)
{
  ClStatus status;

  Call(ModelBeginStep(&s->m, &status));
  Check(status == CL_OK);
  s->m.stage.ahead = 1e30;
  Call(ExchangeBuild(&s->m));
  for (PetscInt i = 0; i < s->m.P.n; i++)
    change[i] = s->m.added->exchange[i].change;
}

/* Largest of any node's mean of the changes, over ranks. */
static double SeenByNodes(SmallScene *s, const double *change)
{
  Model  *m = &s->m;
  double *sum, worst = 0.0;

  Call(PetscCalloc1(m->map.n_local, &sum));
  for (PetscInt i = 0; i < m->P.n; i++) {
    Reach r;

    ReachExpand(m, i, &r);
    for (int a = 0; a < r.n; a++)
      sum[r.node[a]] += m->P.f[P_V][i] * r.S[a] * change[i];
  }
  Call(NodeMapReduce(&m->map, sum, 1));
  for (PetscInt I = 0; I < m->map.n_owned; I++)
    worst = fmax(worst, fabs(sum[I] / m->V[I]));
  Call(PetscFree(sum));
  return Largest(worst);
}

static double LargestOf(const SmallScene *s, const double *a, const double *less)
{
  double worst = 0.0;

  for (PetscInt i = 0; i < s->m.P.n; i++)
    worst = fmax(worst, fabs(a[i] - (less ? less[i] : 0.0)));
  return Largest(worst);
}

static void TestExchange(void **state)
{
  (void)state;
  Say("changes of pressure in a long step, of 1e5 Pa: of an uneven field, what nodes see of it, in the next step, what "
      "7 "
      "MPa more everywhere make of it; of a linear field\n");
  for (int k = 0; k < 4; k++) {
    const BasisType basis = k % 2 ? BASIS_LINEAR : BASIS_CPGIMP;
    SmallScene     *s     = Make(basis, k >= 2);
    double         *y, *other;
    double          even[5];

    Call(PetscMalloc2(s->m.P.n + 64, &y, s->m.P.n + 64, &other)); /* ranks part them anew */
    Pressures(s, Linear);
    Evened(s, y);
    even[4] = LargestOf(s, y, NULL) / 1e5;
    Pressures(s, Higher);
    Evened(s, other);
    Pressures(s, Uneven);
    Evened(s, y);
    even[0] = LargestOf(s, y, NULL) / 1e5;
    even[1] = SeenByNodes(s, y) / 1e5;
    even[3] = LargestOf(s, y, other) / 1e5;
    for (PetscInt i = 0; i < s->m.P.n; i++) {
      s->m.P.f[P_PW][i] += y[i];
      s->m.P.f[P_PG][i] += y[i];
    }
    Evened(s, y);
    even[2] = LargestOf(s, y, NULL) / 1e5;
    Say("  %-7s %-13s %.2f  %.1e  %.1e  %.1e  %.1e\n", basis_name[basis], k >= 2 ? "about an axis" : "plane", even[0],
        even[1], even[2], even[3], even[4]);
    Check(even[0] > 0.1);
    Check(even[1] < 1e-7 && even[2] < 1e-6 && even[3] < 1e-6);
    Check(even[4] < (k >= 2 ? 1e-5 : 1e-9)); /* about an axis the mean of S lies beside the particle, by l^2/(3 r) */
    Call(PetscFree2(y, other));
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestExchange)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
