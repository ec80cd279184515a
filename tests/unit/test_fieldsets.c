/* Tests of field sets: what each holds, the tangent of a particle and the exact Jacobian for every named set, with and
   without inertia, in the plane and about an axis; in space with the same sources. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/explicit.h"
#include "small_scene.h"

static const char *const set_names[] = {"thmc", "thc", "hmc", "hc", "thm", "hm", "th", "h", "tm", "m", "t"};
#define GEOMETRIES (CL_DIM == 2 ? 4 : 2) /* plane and about an axis, or space; each quasi-static and with inertia */
#define SETS ((int)(sizeof(set_names) / sizeof(*set_names)))

static void TestSets(void **state)
{
  static const int vectors[SETS] = {3, 2, 3, 2, 2, 2, 1, 1, 1, 1, 0}, scalars[SETS] = {3, 3, 2, 2, 2, 1, 2, 1, 1, 0, 1};
  int              can = 0;
  FieldSet         fs;

  (void)state;
  for (int k = 0; k < SETS; k++) {
    const unsigned has = FieldSetByName(set_names[k]);
    int            n   = 0;

    Check(has && FieldSetMake(has, true, &fs) && fs.n == CL_DIM * vectors[k] + scalars[k]);
    for (int q = 0; q < F_COUNT; q++) {
      if (fs.at[q] < 0)
        continue;
      Check(fs.at[q] == n && fs.field[n] == q); /* in the order of the full set, without gaps */
      n++;
    }
    Check(n == fs.n);
  }
  for (unsigned has = 0; has <= HAS_ALL; has++) /* gas needs water; something must be there: the eleven named ones */
    can += FieldSetMake(has, true, &fs);
  Check(can == SETS);
}

/* Nothing is stored for a field that is not there. */
static void TestStorage(void **state)
{
  (void)state;
  for (int k = 0; k < SETS; k++) {
    FieldSet  fs;
    Particles P;

    Check(FieldSetMake(FieldSetByName(set_names[k]), true, &fs));
    Call(ParticlesCreate(fs.has, &P));
    Call(ParticlesResize(&P, 3));
    for (const ParticleVariable *v = cl_particle_variable; v->name; v++) {
      for (int c = 0; c < v->nc; c++)
        Check((P.f[v->first + c] != NULL) == ((v->has & fs.has) != 0));
    }
    Check(P.f[P_X] && P.f[P_V] && P.f[P_MS]);
    Call(ParticlesDestroy(&P));
  }
}

/* ---------------------------------------------------------------- a particle's tangent */
typedef struct {
  const FieldSet *fs;
  Material        mat;
  PointHistory    h;
  double          in[IN_COUNT];
  int             column;
} Point;

static bool IsInput(const FieldSet *fs, bool axisymmetric, int q)
{
  const int fluid = q < IN_P    ? -1
                    : q < IN_T  ? q - IN_P
                    : q < IN_GP ? -1
                    : q < IN_GT ? (q - IN_GP) / CL_DIM
                                : (q - IN_J) / CL_DIM;

  if (q < IN_P)
    return fs->solid && (q < IN_HOOP || axisymmetric);
  if (q >= IN_U)
    return fs->solid;
  if (q == IN_T || (q >= IN_GT && q < IN_J))
    return fs->heat;
  return fs->phase[fluid];
}

static bool IsOutput(const FieldSet *fs, int r)
{
  if (r < OUT_FLUX || r == OUT_HOOP || r >= OUT_A)
    return fs->solid;
  if (r == OUT_M)
    return true;
  if ((r >= OUT_HEAT && r < OUT_HOOP) || r == OUT_C || r == OUT_Q)
    return fs->heat;
  if (r < OUT_M)
    return fs->phase[(r - (r < OUT_HEAT ? OUT_FLUX : OUT_G)) / CL_DIM];
  return fs->phase[r < OUT_MI ? r - OUT_M - 1 : (r - OUT_MI) % 2];
}

static bool Outputs(void *ctx, double x, double y[RIDDERS_ROWS])
{
  const Point *q = ctx;
  PointState   state;
  PointOutput  o = {0};
  const char  *why;
  double       in[IN_COUNT];

  memcpy(in, q->in, sizeof in);
  in[q->column] = x;
  if (PointEvaluate(&(PointInput){q->fs, &q->mat, &q->h, in}, false, &state, &o, &why) != CL_OK)
    return false;
  memcpy(y, o.out, sizeof o.out);
  return true;
}

/* Its pressure changes within millimetres, so that differences see it. */
static const Ambient sea = {.on = true, .pressure = 2e6, .weight = {3e8, -7e8}, .head = -5e6};

static void RandomPoint(Rng *r, const FieldSet *fs, bool axisymmetric, Point *q)
{
  const double pw = RngBetween(r, 2e6, 6e6), pg = pw + RngBetween(r, 6e4, 2e5), T = RngBetween(r, 2.0, 8.0);

  *q               = (Point){.fs = fs, .mat = SedimentMaterial()};
  q->h.ambient     = &sea;
  q->mat.reacts    = fs->phase[PHASE_G] && RngPick(r, 3);
  q->h.V           = 2e-4;
  q->h.T_n         = T + RngBetween(r, -1.0, 1.0) * fs->heat;
  q->h.Sh_n        = RngBetween(r, 0.05, 0.3);
  q->h.dt          = RngLog(r, 5.0, 500.0);
  const double Sh0 = q->h.Sh_n * RngBetween(r, 0.9, 1.1);
  const double sg  = fs->phase[PHASE_G] ? GasShareOf(&q->mat, pg - pw, Sh0) : 0.0;
  double       m[4];
  PointInitialMasses(fs, &q->mat, &(PointStart){q->h.V, 0.3, Sh0, sg, pw, pg, T}, m);
  q->h.m_s = m[0];
  memcpy(q->h.m_star, &m[1], sizeof(q->h.m_star));
  for (int k = 0; k < 6; k++) {
    q->h.skeleton.sig[k]  = RngBetween(r, -3e6, 3e6);
    q->h.skeleton.sig0[k] = RngBetween(r, -3e6, 3e6);
  }
  for (int k = 0; k < CL_FLUID_VECTORS; k++)
    q->h.proj[k / CL_DIM][k % CL_DIM] = RngBetween(r, -2e5, 2e5);
  q->h.shift[0] = RngBetween(r, -1e4, 1e4) * fs->phase[PHASE_W];
  q->h.shift[1] = RngBetween(r, -1e4, 1e4) * fs->phase[PHASE_G];
  q->h.shift[2] = RngBetween(r, -0.1, 0.1) * fs->heat;
  for (int k = 0; k < IN_COUNT; k++) {
    if (IsInput(fs, axisymmetric, k) && k < IN_U)
      q->in[k] = RngBetween(r, -1.0, 1.0) * (k < IN_P ? 0.1 : k < IN_GT ? 2e5 : k < IN_J ? 20.0 : 1e-6);
  }
  for (int d = 0; fs->solid && d < CL_DIM; d++)
    q->in[IN_U + d] = 4e-4 - 1e-3 * d;
  q->in[IN_P]     = fs->phase[PHASE_W] ? pw : 0.0;
  q->in[IN_P + 1] = fs->phase[PHASE_G] ? pg : 0.0;
  q->in[IN_T]     = T;
}

/* Largest error of the tangent, each row relative to what typical inputs make of it. */
static double TangentError(Point *q, bool axisymmetric)
{
  PointState  state;
  PointOutput o;
  const char *why;
  double      error[OUT_COUNT] = {0.0}, size[OUT_COUNT] = {0.0}, worst = 0.0;

  if (PointEvaluate(&(PointInput){q->fs, &q->mat, &q->h, q->in}, true, &state, &o, &why) != CL_OK)
    return 0.0;
  for (int c = 0; c < IN_COUNT; c++) {
    const double unit = c < IN_P    ? 0.1
                        : c < IN_T  ? 1e5
                        : c == IN_T ? 1.0
                        : c < IN_GT ? 2e5
                        : c < IN_J  ? 20.0
                        : c < IN_U  ? 1e-6
                                    : 1e-3;
    double       dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

    q->column = c;
    if (!IsInput(q->fs, axisymmetric, c) || !Ridders(Outputs, q, q->in[c], 0.1 * unit, OUT_COUNT, dy, err))
      continue;
    for (int r = 0; r < OUT_COUNT; r++) {
      if (!IsOutput(q->fs, r))
        continue;
      size[r]  = fmax(size[r], unit * fmax(fabs(dy[r]), fabs(o.D[r][c])));
      error[r] = fmax(error[r], unit * fmax(fabs(o.D[r][c] - dy[r]) - 3.0 * err[r], 0.0));
    }
  }
  for (int r = 0; r < OUT_COUNT; r++) {
    const double value =
        o.out[r < OUT_DM || r > OUT_DM + 1 ? r : OUT_M + 1 + r - OUT_DM]; /* masses gained: of the mass */

    /* differences hold 1e-12 of the value itself, 1e-11 of the drag, whose S_h is found by iteration */
    const double noise = r == OUT_D || r == OUT_D + 1 ? 1e-2 : 1e-3;

    if (size[r] > 0.0)
      worst = fmax(worst, error[r] / fmax(size[r], noise * fabs(value)));
  }
  return worst;
}

static void TestTangent(void **state)
{
  (void)state;
  Say("tangent of a particle against differences: largest error of an entry over its row, 100 random states\n");
  for (int k = 0; k < SETS; k++) {
    double worst[2][2] = {{0.0}};

    for (int v = 0; v < GEOMETRIES; v++) {
      Rng      r = {400 + (uint64_t)(10 * k + v)};
      FieldSet fs;

      Check(FieldSetMake(FieldSetByName(set_names[k]), v % 2, &fs));
      worst[v / 2][v % 2] = 0.0;
      for (int n = 0; n < 100; n++) {
        Point q;

        RandomPoint(&r, &fs, v / 2, &q);
        worst[v / 2][v % 2] = fmax(worst[v / 2][v % 2], TangentError(&q, v / 2));
      }
      Check(worst[v / 2][v % 2] < 1e-8);
    }
    Say("  %-4s plane or space %.1e, quasi-static %.1e; about an axis %.1e, quasi-static %.1e\n", set_names[k],
        worst[0][1], worst[0][0], worst[1][1], worst[1][0]);
  }
}

/* ---------------------------------------------------------------- the assembled Jacobian */
/* `entries`: every entry for the first basis, too. */
static void Jacobians(bool axisymmetric, bool entries)
{
  for (int k = 0; k < SETS; k++) {
    const unsigned has      = FieldSetByName(set_names[k]);
    double         worst[2] = {0.0}, entry = 0.0;

    for (int v = 0; v < 8; v += CL_DIM == 2 ? 1 : 3) { /* basis changes with the set, so that all of them occur */
      SmallScene *s       = malloc(sizeof(*s));
      const int   inertia = v % 2, set = v / 2 % 2, reacts = v / 4 && (has & HAS_GAS);

      if (v / 4 && !(has & HAS_GAS)) {
        free(s);
        continue;
      }
      JacobianScene(s, has, inertia, axisymmetric, (BasisType)((k + v / 2) % 3), 0.0, 0.0, reacts, set);
      worst[inertia] = fmax(worst[inertia], DirectionError(s, 2));
      if (entries && set == 1 && reacts == ((has & HAS_GAS) != 0) && inertia)
        entry = fmax(entry, ColumnError(s));
      SceneDestroy(s);
      free(s);
    }
    Say("  %-4s with inertia %.1e, quasi-static %.1e", set_names[k], worst[1], worst[0]);
    Say(entries ? ", entries %.1e\n" : "\n", entry);
    Check(worst[0] < 1e-6 && worst[1] < 1e-6 && entry < 1e-6);
  }
}

static void TestJacobian(void **state)
{
  (void)state;
  Say("exact Jacobian against differences: random directions; every entry relative to the largest of its row\n");
  Jacobians(false, CL_DIM == 2);
}

#if CL_DIM == 2
static void TestJacobianAxis(void **state)
{
  (void)state;
  Say("exact Jacobian against differences, about an axis: random directions\n");
  Jacobians(true, false);
}
#endif

/* A field that is linear along each axis, at x; the derivative by the axes of `by`.  Bit d of a coefficient's number:
   it goes with the coordinate d. */
static double Multilinear(const double x[CL_DIM], const int by[CL_DIM])
{
  static const double c[8] = {14.0, 3.0, -5.0, 40.0, 7.0, -60.0, 30.0, 900.0};
  double              sum  = 0.0;

  for (int k = 0; k < CL_CORNERS; k++) {
    double term = c[k];

    for (int d = 0; d < CL_DIM; d++)
      term *= !by[d] ? (k >> d & 1 ? x[d] : 1.0) : k >> d & 1 ? 1.0 : 0.0;
    sum += term;
  }
  return sum;
}

/* (395), (446): particles within cells and across their borders that hold such a T give it to their nodes in either
   integrator, and read their derivatives from them again. */
static void TestMultilinear(void **state)
{
  static const int      none[CL_DIM] = {0};
  const double          lower[2] = {0.0, 0.0}, upper[2] = {0.43, 0.25};
  int                   by[CL_DIM] = {0};
  double                worst[2]   = {0.0};
  SmallScene           *s          = malloc(sizeof(*s));
  const ExplicitOptions hybrid     = {.drag_implicit = true, .mass_scaling = 1.0};
  Explicit             *e;
  StageRates            sum = {0};
  ClStatus              status;

  (void)state;
  SceneInit(s, HAS_HEAT, true, false, BASIS_CPGIMP, 0.0, lower, upper);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  Model         *m    = &s->m;
  double *const *f    = m->P.f;
  double(*at)[CL_DIM] = malloc((size_t)m->P.n * sizeof(*at));

  for (PetscInt p = 0; p < m->P.n; p++) {
    Stencil stencil;

    for (int d = 0; d < CL_DIM; d++)
      f[P_X + d][p] += 0.4 * f[P_L + d][p] * Noise(1, m->P.i[PI_ID][p], d) + 0.5 * f[P_L + d][p];
    ParticleStencil(m->c, &m->grid, &m->P, p, &stencil);
    ParticleCentroid(&m->grid, &m->P, p, &stencil, at[p]);
    f[P_T][p] = Multilinear(at[p], none);
    for (int d = 0; d < CL_DIM; d++) {
      by[d]          = 1;
      f[P_GT + d][p] = Multilinear(at[p], by);
      by[d]          = 0;
    }
    for (int k = 0; k < CL_MIXED; k++)
      f[P_BT + k][p] = Multilinear(at[p], cl_mixed[k]);
  }
  StageStart(s, 1.0);
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    double x[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      x[d] = GridNode(&m->grid, d, m->map.ij[I][d]);
    worst[0] = fmax(worst[0], fabs(m->x_n[I] - Multilinear(x, none)));
  }
  Call(ExplicitCreate(m, &hybrid, &e));
  Call(ExplicitBegin(e, (Unseen){0.0, 0}, &status));
  Call(ExplicitStep(e, 0.0, 1e-9, &sum, &status));
  Check(status == CL_OK);
  Call(ExplicitEnd(e));
  Call(ExplicitDestroy(&e));
  for (PetscInt p = 0; p < m->P.n; p++) { /* particles stay, in the order that the integrator sorts them in */
    Stencil stencil;
    double  x[CL_DIM];

    ParticleStencil(m->c, &m->grid, &m->P, p, &stencil);
    ParticleCentroid(&m->grid, &m->P, p, &stencil, x);
    for (int k = 0; k < CL_MIXED; k++)
      worst[1] = fmax(worst[1], fabs(f[P_BT + k][p] - Multilinear(x, cl_mixed[k])));
  }
  Say("T linear along each axis: nodes off by %.1e K, derivatives of particles after a step of hybrid by %.1e K/m^%d\n",
      Largest(worst[0]), Largest(worst[1]), CL_DIM);
  Check(Largest(worst[0]) < 1e-12 && Largest(worst[1]) < 1e-6);
  free(at);
  SceneDestroy(s);
  free(s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(TestSets),
    cmocka_unit_test(TestStorage),
    cmocka_unit_test(TestTangent),
    cmocka_unit_test(TestJacobian),
    cmocka_unit_test(TestMultilinear),
#if CL_DIM == 2
    cmocka_unit_test(TestJacobianAxis),
#endif
  };

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
