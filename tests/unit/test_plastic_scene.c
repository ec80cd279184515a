/* A plastic skeleton inside a particle and a scene: the particle's tangent and the exact Jacobian against differences
   in plastic states, heat of plastic work included. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <cmocka.h>
#include "model/gather.h"
#include "small_scene.h"

static const struct {
  const char *name;
  unsigned    has;
} sets[] = {{"m", HAS_SOLID}, {"tm", HAS_SOLID | HAS_HEAT}, {"hm", HAS_SOLID | HAS_WATER}, {"thmc", HAS_ALL}};
#define SETS ((int)(sizeof(sets) / sizeof(*sets)))

/* ---------------------------------------------------------------- a particle */
typedef struct {
  FieldSet     fs;
  Material     mat;
  PointHistory h;
  double       in[IN_COUNT];
  int          column;
  bool         axis;
} Point;

static bool Outputs(void *ctx, double x, double y[RIDDERS_ROWS])
{
  const Point *q = ctx;
  PointState   state;
  PointOutput  o = {0};
  const char  *why;
  double       in[IN_COUNT];

  memcpy(in, q->in, sizeof in);
  in[q->column] = x;
  if (PointEvaluate(&(PointInput){&q->fs, &q->mat, &q->h, in}, false, &state, &o, &why) != CL_OK)
    return false;
  memcpy(y, o.out, sizeof o.out);
  return true;
}

static void RandomPoint(Rng *r, Point *q)
{
  const bool   gas = q->fs.phase[PHASE_G];
  const double pw = 4e6, pg = pw + 1e5, T = RngBetween(r, 2.0, 8.0);

  q->mat            = SedimentMaterial();
  q->mat.plasticity = WeakPlasticity(RngPick(r, 2), 0.7);
  q->mat.reacts     = gas && RngPick(r, 2);
  q->h              = (PointHistory){.V = 2e-4, .T_n = T, .Sh_n = 0.2, .dt = RngLog(r, 0.1, 10.0)};
  const double sg   = gas ? GasShareOf(&q->mat, pg - pw, 0.21) : 0.0;
  double       m[4];
  PointInitialMasses(&q->fs, &q->mat, &(PointStart){q->h.V, 0.3, 0.21, sg, pw, pg, T}, m);
  q->h.m_s = m[0];
  memcpy(q->h.m_star, &m[1], sizeof(q->h.m_star));
  for (int k = 0; k < 4; k++) {
    q->h.skeleton.sig[k]          = RngBetween(r, -3e6, 1e6);
    q->h.skeleton.from.plastic[k] = RngBetween(r, -1e-3, 1e-3);
  }
  q->h.skeleton.from.own[OWN_P_EPS] = RngBetween(r, 0.0, 0.2);
  for (int k = 0; k < IN_COUNT; k++)
    q->in[k] = RngBetween(r, -1.0, 1.0) * (k < IN_HOOP ? 0.02 : k == IN_HOOP ? 0.02 * q->axis : k < IN_GT ? 1e4 : 0.0);
  q->in[IN_P]     = q->fs.phase[PHASE_W] ? pw : 0.0;
  q->in[IN_P + 1] = gas ? pg : 0.0;
  q->in[IN_T]     = T;
}

/* The same with a tear that stands open and closes before it bears. */
static void MakeTorn(Rng *r, Point *q)
{
  q->h.skeleton.from.own[OWN_P_OPENING] = RngLog(r, 1e-4, 1e-1);
}

/* Where the input now varied leads: on the yield surface, and what tears do on the way. */
static int Branch(const Point *q, double x)
{
  const double open = q->h.skeleton.from.own[OWN_P_OPENING];
  PointState   state;
  PointOutput  o;
  const char  *why;
  double       in[IN_COUNT];

  memcpy(in, q->in, sizeof in);
  in[q->column] = x;
  if (PointEvaluate(&(PointInput){&q->fs, &q->mat, &q->h, in}, false, &state, &o, &why) != CL_OK)
    return -1;
  const double left = state.skeleton.own[OWN_P_OPENING],
               mean = Trace6(state.skeleton.sig) / 3.0; /* none while tears take up what dilates */

  return (int)state.skeleton.region + 10 * (left == 0.0) + 20 * (left < open) + 40 * (fabs(mean) < 1.0);
}

/* No tear begins or ends to close within a step to either side, nor is an edge reached on the way. */
static bool NoTearTurns(const Point *q, double step)
{
  const double x    = q->in[q->column];
  bool         same = true;

  for (int k = -4; k <= 4 && q->h.skeleton.from.own[OWN_P_OPENING] > 0.0; k++)
    same = same && Branch(q, x + 0.25 * k * step) == Branch(q, x);
  return same;
}

/* Worst entry of the tangent over its row; rows of the stress and of the heat alone: what plasticity touches. */
static double TangentError(Point *q, ReturnRegion *region)
{
  static const int rows[] = {OUT_P, OUT_P + 1, OUT_P + 2, OUT_P + 3, OUT_HOOP, OUT_Q};
  const double     strain =
      q->h.skeleton.from.own[OWN_P_OPENING] > 0.0 ? 4e-4 : 1e-4; /* against the round-off of the raise */
  PointState  state;
  PointOutput o;
  const char *why;
  double      worst = 0.0;

  Check(PointEvaluate(&(PointInput){&q->fs, &q->mat, &q->h, q->in}, true, &state, &o, &why) == CL_OK);
  *region = state.skeleton.region;
  for (int k = 0; k < 6 && *region != RETURN_ELASTIC; k++) {
    double error = 0.0, size = 0.0;

    if (rows[k] == OUT_Q && !q->fs.heat)
      continue;
    for (int c = 0; c < IN_J; c++) {
      const double unit = c < IN_P ? strain : c < IN_T ? 1e3 : c == IN_T ? 0.05 : c < IN_GT ? 1e3 : 1.0;
      double       dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

      q->column = c;
      if ((c == IN_HOOP && !q->axis) || (c >= IN_P && c < IN_T && !q->fs.phase[c - IN_P]) || c > IN_T ||
          (c == IN_T && !q->fs.heat) || !NoTearTurns(q, unit) ||
          !Ridders(Outputs, q, q->in[c], unit, OUT_COUNT, dy, err))
        continue;
      size  = fmax(size, unit * fmax(fabs(dy[rows[k]]), fabs(o.D[rows[k]][c])));
      error = fmax(error, unit * (fabs(o.D[rows[k]][c] - dy[rows[k]]) - 10.0 * err[rows[k]]));
    }
    if (size > 0.0)
      worst = fmax(worst, error / size);
  }
  return worst;
}

/* Torn ones are known less well: at no mean stress the raise (427) follows from the return's own round-off. */
static void TryParticles(bool torn, int states, double bar)
{
  for (int k = 0; k < 2 * SETS; k++) {
    Rng    r         = {500 + (uint64_t)k};
    double worst     = 0.0;
    int    region[6] = {0};

    for (int n = 0; n < states; n++) {
      Point        q = {.axis = k >= SETS};
      ReturnRegion where;

      Check(FieldSetMake(sets[k % SETS].has, true, &q.fs));
      RandomPoint(&r, &q);
      if (torn)
        MakeTorn(&r, &q);
      worst = fmax(worst, TangentError(&q, &where));
      region[where]++;
    }
    Say("%s, %-4s %s: tangent %.1e; %d elastic, %d face, %d edge, %d apex, %d closing\n",
        torn ? "torn particle" : "particle", sets[k % SETS].name, k < SETS ? "plane" : "axis ", worst, region[0],
        region[1], region[2], region[3], region[RETURN_CLOSING]);
    Check(worst < bar && region[RETURN_FACE] > states / 3 && (region[RETURN_CLOSING] > 0) == torn);
  }
}

static void TestParticle(void **state)
{
  (void)state;
  TryParticles(false, 150, 1e-7);
  TryParticles(true, 60, 1e-6);
}

/* ---------------------------------------------------------------- the assembled Jacobian */
/* Particles that yield at the state of PrepareJacobian. */
static double Yielding(SmallScene *s)
{
  double *x, n = 0.0;

  Call(PetscMalloc1(s->m.map.n_local * s->c.scene.fields.n, &x));
  RandomUnknowns(&s->m, s->stage.dt, 30, x);
  ModelGive(&s->m, x, false);
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    ParticleResult at;

    Check(ParticleEvaluate(&s->m, p, x, false, &at) == CL_OK);
    n += at.state.skeleton.region != RETURN_ELASTIC;
  }
  Call(PetscFree(x));
  return n;
}

static void TestJacobian(void **state)
{
  (void)state;
  for (int k = 0; k < 4 * SETS; k++) {
    const bool  axis = k / SETS % 2, strain = k / SETS / 2 == 1;
    SmallScene *s     = malloc(sizeof(*s));
    double      yield = 0.0, all;

    const bool bonds = k % SETS == SETS - 1; /* hydrate that goes, with a stress of its own */

    JacobianCase(s, sets[k % SETS].has, true, axis, k % 2 && strain ? BASIS_UGIMP : BASIS_CPGIMP, 0.0, 0.0, bonds, 1);
    s->c.scene.mean_strain   = strain ? 0.7 : 0.0;
    s->mat.elasticity.change = bonds ? STIFFNESS_BONDS : STIFFNESS_BOTH;
    s->mat.plasticity        = WeakPlasticity(k % 2, 0.7);
    s->c.scene.fields.has |= SkeletonHas(&s->mat);
    JacobianState(s);
    for (PetscInt p = 0; k % 4 == 1 && p < s->m.P.n; p++)
      s->m.P.f[P_OPENING][p] = 0.01 * (1.0 + Noise(72, s->m.P.i[PI_ID][p], 0));
    for (PetscInt p = 0; p < s->m.P.n; p++)
      s->m.P.f[P_EPS][p] = 0.1 * (1.0 + Noise(70, s->m.P.i[PI_ID][p], 0));
    for (PetscInt p = 0; bonds && p < s->m.P.n; p++) {
      for (int i = 0; i < 4; i++)
        s->m.P.f[P_BOND + i][p] = 1e6 * Noise(71, s->m.P.i[PI_ID][p], i);
    }
    const double worst = DirectionError(s, 2), entry = k % SETS == 1 ? ColumnError(s) : 0.0;
    yield = Sum(Yielding(s));
    all   = Sum((double)s->m.P.n);
    Say("Jacobian, %-4s %s%s: directions %.1e, entries %.1e; %g of %g particles yield\n", sets[k % SETS].name,
        axis ? "axis " : "plane", strain ? ", mean strain" : "", worst, entry, yield, all);
    Check(worst < 1e-6 && entry < 1e-6 && yield > 0.7 * all);
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestParticle), cmocka_unit_test(TestJacobian)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
