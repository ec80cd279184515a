/* A gas that is thinner than its nodes' follows its share of what they change by (416): the tangent, what stays as it
   is, and that it does not vanish before its nodes' does. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "small_scene.h"
#include "model/gather.h"

#define THIN 0.3 /* of the pressure that gas had, in every third particle */

/* One pressure everywhere, or a random state in which every third particle has 0.3 of its gas' pressure, at its p_c. */
static SmallScene *Make(bool reacts, int set, bool uniform)
{
  SmallScene    *s = malloc(sizeof(*s));
  double *const *f;

  JacobianCase(s, HAS_ALL, true, false, BASIS_CPGIMP, 0.0, 0.0, reacts, set);
  s->mat.gas.trace = s->mat.gas.carried = 0.0;
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  if (!uniform)
    RandomHistory(s, 0.2);
  f = s->m.P.f;
  for (PetscInt p = 0; !uniform && p < s->m.P.n; p++) {
    if (s->m.P.i[PI_ID][p] % 3)
      continue;
    f[P_PW][p] -= (1.0 - THIN) * f[P_PG][p];
    f[P_PG][p] *= THIN;
    Refill(s, p, 0.2);
  }
  RandomStage(s, 20.0);
  return s;
}

static void Free(SmallScene *s)
{
  SceneDestroy(s);
  free(s);
}

static void TestJacobian(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    SmallScene *s = Make(k / 2, k % 2, false);

    s->m.relative_gas = true;
    MakeSolver(s);
    const double worst = DirectionError(s, 3), entry = ColumnError(s);
    Say("Jacobian, kinetics %-3s conditions %d: directions %.1e, entries %.1e\n", k / 2 ? "on" : "off", k % 2, worst,
        entry);
    Check(worst < 1e-6 && entry < 1e-6);
    Free(s);
  }
}

/* Particle p at nodal values x, by (1) and by (416). */
typedef struct {
  ClStatus   status;
  double     in[IN_COUNT];
  PointState state;
} At;

static At AtNodes(SmallScene *s, PetscInt p, const double *x, bool relative)
{
  At             at;
  ParticleResult e;

  s->m.relative_gas = relative;
  ModelClearFailure(&s->m);
  ModelGive(&s->m, x, false);
  at.status = ParticleEvaluate(&s->m, p, x, false, &e);
  at.state  = e.state;
  memcpy(at.in, e.in, sizeof(at.in));
  return at;
}

/* Nodal gas of particle p at t_n, Pa. */
static double Nodal(const Model *m, PetscInt p)
{
  Reach r;

  ReachExpand(m, p, &r);
  return OwnValue(m, p, F_PG) + Shift(m, p, &r, F_PG);
}

/* p_c is what it is by (1), the reaction sees the nodes, and gas changes in proportion, at most twice as much as the
   nodes; at one pressure everywhere all is as by (1). */
static void TestShare(void **state)
{
  (void)state;
  for (int uniform = 0; uniform < 2; uniform++) {
    SmallScene  *s = Make(true, 1, uniform);
    const Model *m = &s->m;
    const int    n = m->c->fields.n, w = IN_P + PHASE_W, g = IN_P + PHASE_G;
    double      *x, pc = 0.0, share = 0.0, hydrate = 0.0, apart = 0.0, least = INFINITY, most = 0.0;

    Call(PetscMalloc1(m->map.n_local * n, &x));
    RandomUnknowns(m, s->stage.dt, 30, x);
    for (PetscInt p = 0; p < m->P.n; p++) {
      const At     one = AtNodes(s, p, x, false), two = AtNodes(s, p, x, true);
      const double own = m->P.f[P_PG][p], a = own / fmax(Nodal(m, p), 0.5 * own);

      Check(one.status == CL_OK && two.status == CL_OK);
      least   = fmin(least, a);
      most    = fmax(most, a);
      pc      = fmax(pc, fabs((one.in[g] - one.in[w]) - (two.in[g] - two.in[w])));
      hydrate = fmax(hydrate, fabs(two.state.m_h / one.state.m_h - 1.0));
      share   = fmax(share, fabs(two.in[g] / (own + a * (one.in[g] - own)) - 1.0));
      apart   = fmax(apart, fabs(two.in[g] - one.in[g]));
    }
    Say("a from %.3f to %.3f: p_c off by %.1e Pa, p_g by %.1e, hydrate by %.1e; p_g by up to %.1e Pa from (1)\n",
        -Largest(-least), Largest(most), Largest(pc), Largest(share), Largest(hydrate), Largest(apart));
    Check(Largest(pc) < 1e-8 && Largest(share) < 1e-13 && Largest(hydrate) < 1e-13);
    Check(uniform ? Largest(apart) < 1e-8 : -Largest(-least) < 0.6 && Largest(most) > 1.2 && Largest(apart) > 1e4);
    Call(PetscFree(x));
    Free(s);
  }
}

/* Nodes lose all but a hundredth of their gas' pressure: particles that share pascals cannot follow, those that share
   in proportion keep what they have of it. */
static void TestExpands(void **state)
{
  SmallScene  *s = Make(false, 0, false);
  const Model *m = &s->m;
  const int    n = m->c->fields.n;
  double      *x, refused[2] = {0.0, 0.0}, least = INFINITY;

  (void)state;
  Call(PetscMalloc1(m->map.n_local * n, &x));
  Call(PetscArraycpy(x, m->x_n, m->map.n_local * n));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int f = 0; f < PHASE_COUNT; f++)
      x[I * n + PlaceP(&m->c->fields, f)] -= 0.99 * m->x_n[I * n + PlaceP(&m->c->fields, PHASE_G)];
  }
  for (PetscInt p = 0; p < m->P.n; p++) {
    for (int relative = 0; relative < 2; relative++) {
      const At at = AtNodes(s, p, x, relative);

      refused[relative] += at.status != CL_OK;
      if (relative && at.status == CL_OK)
        least = fmin(least, at.in[IN_P + PHASE_G] / m->P.f[P_PG][p]);
    }
  }
  Say("gas of the nodes falls to a hundredth: %g particles have none by (1), %g by (416), that of the others is at "
      "least "
      "%.4f of what it was\n",
      Sum(refused[0]), Sum(refused[1]), -Largest(-least));
  Check(Sum(refused[0]) > 5 && Sum(refused[1]) == 0.0 && -Largest(-least) > 0.01 - 1e-9);
  Call(PetscFree(x));
  Free(s);
}

/* Heat of compression (290) counts from the pressures that the stage starts from: none at its starred values, where
   only what flows is left. */
static void TestCompression(void **state)
{
  SmallScene  *s    = Make(false, 0, false);
  double       from = 0.0, to = 0.0;
  const double dt = 1e-6; /* s: what flows adds next to nothing */

  (void)state;
  s->m.stage.dt = dt;
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    from = fmax(from, fabs(AtNodes(s, p, s->stage.x_star, true).state.squeezed) * dt);
    to   = fmax(to, fabs(AtNodes(s, p, s->m.x_n, true).state.squeezed) * dt);
  }
  Say("heat of compression at the starred pressures %.1e J, of those at t_n %.1e\n", Largest(from), Largest(to));
  Check(Largest(to) > 0.0 && Largest(from) < 1e-6 * Largest(to));
  Free(s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestJacobian), cmocka_unit_test(TestShare),
                                     cmocka_unit_test(TestExpands), cmocka_unit_test(TestCompression)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
