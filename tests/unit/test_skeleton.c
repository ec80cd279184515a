/* Unit tests of src/skeleton: the block form of every law is the single form; the elastic tangent is that of
   differences (the plastic one: test_plasticity.c). */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/skeleton.h"
#include "random.h"

#define N 32

typedef struct {
  Material        mat;
  SkeletonHistory h;
  double          in[SKELETON_IN], E_n;
  int             which;
} Sample;

static SkeletonStep StepOf(const double in[SKELETON_IN], double E_n)
{
  return (SkeletonStep){
      .turn    = {cos(in[SKELETON_THETA]), sin(in[SKELETON_THETA])},
      .e       = {in[SKELETON_STRAIN], in[SKELETON_STRAIN + 1], in[SKELETON_STRAIN + 2], in[SKELETON_STRAIN + 3]},
      .thermal = in[SKELETON_THERMAL],
      .E_n     = E_n,
      .E       = in[SKELETON_E],
      .Sh      = in[SKELETON_SH]};
}

static Sample RandomSample(Rng *r)
{
  Sample q = {.mat.elasticity = {9e7, 2e9, 1.0, 1.0, RngBetween(r, 0.0, 0.45), RngPick(r, 2)}};

  q.in[SKELETON_THETA] = RngBetween(r, -1.0, 1.0);
  for (int k = 0; k < 4; k++)
    q.in[SKELETON_STRAIN + k] = RngBetween(r, -0.01, 0.01);
  q.in[SKELETON_THERMAL] = RngBetween(r, -1e-3, 1e-3);
  q.in[SKELETON_E]       = RngLog(r, 1e8, 1e9);
  q.in[SKELETON_SH]      = RngBetween(r, 0.0, 0.5);
  q.E_n                  = q.in[SKELETON_E] * RngBetween(r, 0.8, 1.2);
  for (int k = 0; k < 6; k++) {
    q.h.sig[k]  = RngBetween(r, -5e6, 5e6);
    q.h.sig0[k] = RngBetween(r, -2e6, 2e6);
  }
  return q;
}

/* Plane stresses, and a material that some of them make yield. */
static void MakePlastic(Rng *r, Sample *q)
{
  q->mat.plasticity        = (Plasticity){.type         = PLASTICITY_MOHR_COULOMB,
                                          .c_max        = 2e6,
                                          .c_min        = 1.2e6,
                                          .c_res        = 1e6,
                                          .phi_peak     = 30.0,
                                          .phi_res      = 10.0,
                                          .psi_max      = 10.0,
                                          .psi_min      = 5.0,
                                          .eta_s        = 1.0,
                                          .eta_h        = 4.0,
                                          .Sh_max       = 0.5,
                                          .eccentricity = 0.1,
                                          .cutoff       = INFINITY};
  q->h.from.own[OWN_P_EPS] = RngPick(r, 2) ? RngBetween(r, 0.0, 0.5) : 0.0;
  for (int i = 4; i < 6; i++)
    q->h.sig[i] = q->h.sig0[i] = 0.0;
}

static void TestBlock(void **state)
{
  Rng    r      = {301};
  double worst  = 0.0;
  int    yields = 0, closing = 0;

  (void)state;
  for (int run = 0; run < 200; run++) {
    Sample        q[N];
    double        a[10][N], sig[12][N], work[N], eps[N], opening[N], yield[N];
    const bool    plastic = run % 2;
    const char   *why     = NULL;
    SkeletonBlock b       = {.n       = 1 + RngPick(&r, N),
                             .turn    = {a[0], a[1]},
                             .e       = {[XX] = a[2], [YY] = a[3], [ZZ] = a[9], [XY] = a[4]},
                             .thermal = a[5],
                             .E_n     = a[6],
                             .E       = a[7],
                             .Sh      = a[8],
                             .work    = plastic ? work : NULL,
                             .store   = {.own = {[OWN_P_EPS] = eps, [OWN_P_OPENING] = opening}, .yield = yield}};

    for (int k = 0; k < N; k++) {
      q[k]     = RandomSample(&r);
      q[k].mat = q[0].mat;
      if (plastic)
        MakePlastic(&r, &q[k]);
      q[k].h.from.own[OWN_P_OPENING] = run % 4 == 3 && k % 2 ? RngBetween(&r, 0.0, 5e-3) : 0.0;
      opening[k]                     = q[k].h.from.own[OWN_P_OPENING];
      eps[k]                         = q[k].h.from.own[OWN_P_EPS];
      const SkeletonStep d           = StepOf(q[k].in, q[k].E_n);
      const double       row[10] = {d.turn.c, d.turn.s, d.e[0], d.e[1], d.e[3], d.thermal, d.E_n, d.E, d.Sh, d.e[2]};

      for (int i = 0; i < 10; i++)
        a[i][k] = row[i];
      for (int i = 0; i < 6; i++) {
        sig[i][k]     = q[k].h.sig[i];
        sig[6 + i][k] = q[k].h.sig0[i];
      }
    }
    for (int i = 0; i < 6; i++) {
      b.store.sig[i]  = sig[i];
      b.store.sig0[i] = sig[6 + i];
    }
    assert_true(SkeletonUpdateBlock(&q[0].mat, &b, &why));
    for (int k = 0; k < N; k++) {
      const SkeletonStep d = StepOf(q[k].in, q[k].E_n);
      SkeletonState      s;

      assert_true(SkeletonUpdate(&q[k].mat, &q[k].h, &d, &s, NULL, &why));
      for (int i = 0; i < 6; i++) { /* beyond n nothing is touched */
        worst = fmax(worst, fabs(sig[i][k] - (k < b.n ? s.sig[i] : q[k].h.sig[i])));
        worst = fmax(worst, fabs(sig[6 + i][k] - (k < b.n ? s.sig0[i] : q[k].h.sig0[i])));
      }
      if (plastic && k < b.n) {
        worst = fmax(worst, 1e7 * fmax(fabs(eps[k] - s.own[OWN_P_EPS]), fabs(work[k] - s.work) / 1e5));
        worst = fmax(worst, 1e7 * fabs(opening[k] - s.own[OWN_P_OPENING]));
        assert_true((int)yield[k] == (int)s.region);
        closing += s.own[OWN_P_OPENING] < q[k].h.from.own[OWN_P_OPENING];
        yields += s.region != RETURN_ELASTIC;
      }
    }
  }
  printf("block against single form: worst %.1e Pa of 1e7; %d yield\n", worst, yields);
  assert_true(worst < 1e-7 && yields > 500 && closing > 50);
}

static bool Rows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  Sample       *q = ctx;
  double        in[SKELETON_IN];
  SkeletonState s;
  const char   *why;

  memcpy(in, q->in, sizeof(in));
  in[q->which]         = x;
  const SkeletonStep d = StepOf(in, q->E_n);
  if (!SkeletonUpdate(&q->mat, &q->h, &d, &s, NULL, &why))
    return false;
  memcpy(y, s.sig, sizeof(s.sig));
  y[6] = s.work;
  return true;
}

static void TestTangent(void **state)
{
  static const double size[SKELETON_IN] = {1e-2, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4, 1e6, 1e-2};
  Rng                 r                 = {302};
  double              worst             = 0.0;

  (void)state;
  for (int n = 0; n < 500; n++) {
    Sample          q = RandomSample(&r);
    SkeletonTangent t;
    SkeletonState   s;
    const char     *why;
    double          dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

    const SkeletonStep d = StepOf(q.in, q.E_n);
    assert_true(SkeletonUpdate(&q.mat, &q.h, &d, &s, &t, &why));
    for (q.which = 0; q.which < SKELETON_IN; q.which++) {
      assert_true(Ridders(Rows, &q, q.in[q.which], size[q.which], SKELETON_OUT, dy, err));
      for (int i = 0; i < SKELETON_OUT; i++)
        worst = fmax(worst, fabs(dy[i] - t.d[i][q.which]) * size[q.which] / 1e6);
    }
  }
  printf("tangent against differences: worst %.1e\n", worst);
  assert_true(worst < 1e-8);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestBlock), cmocka_unit_test(TestTangent)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
