/* The laws over arrays against the laws one by one. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/laws_batch.h"
#include "random.h"

#define N 1000

static Rng rng = {42};

static double RandomIn(double lo, double hi)
{
  return RngBetween(&rng, lo, hi);
}

static double Worst(int n, const double *a, const double *b)
{
  double worst = 0.0;

  for (int q = 0; q < n; q++)
    worst = fmax(worst, fabs(a[q] - b[q]) / fmax(fabs(b[q]), 1e-30));
  return worst;
}

static double x[N], y[N], a[N], b[N], da[N], db[N];

static void TestRetention(void **state)
{
  const char *const *type = RetentionTypes();

  (void)state;
  for (int k = 0; type[k]; k++) {
    Retention law = {.p0 = 5e4, .m = 0.3, .lambda = 1.5, .Swr = 0.2, .Sgr = 0.1};
    double    none;

    assert_true(RetentionSetType(&law, type[k]));
    for (law.hydrate = 0.0; law.hydrate < 2.0; law.hydrate += 1.5) {
      for (int q = 0; q < N; q++) {
        x[q] = (q % 2 ? 1.0 : -1.0) * pow(10.0, RandomIn(-2.0, 8.0));
        y[q] = RandomIn(0.0, 0.95);
      }
      RetentionGasShareBatch(&law, N, x, y, a, da);
      for (int q = 0; q < N; q++)
        b[q] = RetentionGasShare(&law, x[q], y[q], &db[q], &none);
      printf("retention %-22s, n = %.1f: share %.1e, slope %.1e\n", type[k], law.hydrate, Worst(N, a, b),
             Worst(N, da, db));
      assert_true(Worst(N, a, b) < 1e-13 && Worst(N, da, db) < 1e-11);
    }
  }
}

static void TestRelPerm(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    const RelPerm law = {.Swr = 0.2, .Sgr = 0.05, .nw = k ? 4.0 : 1.5, .ng = k ? 2.0 : 1.0};
    double        d;

    for (int q = 0; q < N; q++)
      x[q] = RandomIn(-0.1, 1.1);
    RelPermWaterBatch(&law, N, x, a);
    RelPermGasBatch(&law, N, x, da);
    for (int q = 0; q < N; q++) {
      b[q]  = RelPermWater(&law, x[q], &d);
      db[q] = RelPermGas(&law, x[q], &d);
    }
    printf("relative permeability, exponents %g and %g: %.1e, %.1e\n", law.nw, law.ng, Worst(N, a, b),
           Worst(N, da, db));
    assert_true(Worst(N, a, b) < 1e-12 && Worst(N, da, db) < 1e-12);
  }
}

static void TestPermeability(void **state)
{
  const char *const *h = PermeabilityHydrateTypes(), *const *p = PermeabilityPorosityTypes();

  (void)state;
  for (int i = 0; h[i]; i++) {
    for (int j = 0; p[j]; j++) {
      Permeability law = {.k0 = 1e-13, .phi0 = 0.4, .mh = 3.0, .kh = 0.1, .Shc = 0.5};
      double       d, e;

      assert_true(PermeabilitySetHydrateType(&law, h[i]) && PermeabilitySetPorosityType(&law, p[j]));
      for (int q = 0; q < N; q++) {
        x[q] = RandomIn(0.05, 0.9);
        y[q] = RandomIn(0.0, 0.95);
      }
      PermeabilityBatch(&law, N, x, y, a);
      for (int q = 0; q < N; q++)
        b[q] = PermeabilityEvaluate(&law, x[q], y[q], &d, &e);
      printf("permeability %s, %s: %.1e\n", h[i], p[j], Worst(N, a, b));
      assert_true(Worst(N, a, b) < 1e-13);
    }
  }
}

static void TestLiquidAndStiffness(void **state)
{
  const Liquid law[3] = {
      {1000.0, 2.2e9, 2e-4, 1e5, 20.0}, {1000.0, INFINITY, 0.0, 1e5, 20.0}, {900.0, INFINITY, 1e-3, 0.0, 4.0}};
  double d, e;

  (void)state;
  for (int k = 0; k < 3; k++) {
    for (int q = 0; q < N; q++) {
      x[q] = RandomIn(-1e8, 1e9);
      y[q] = RandomIn(-20.0, 80.0);
    }
    LiquidDensityBatch(&law[k], N, x, y, a);
    for (int q = 0; q < N; q++)
      b[q] = LiquidDensity(&law[k], x[q], y[q], &d, &e);
    printf("density %d: %.1e\n", k, Worst(N, a, b));
    assert_true(Worst(N, a, b) < 1e-14);
  }
  for (int k = 0; k < 3; k++) {
    const Elasticity el = {.E0 = 9e7, .Eh = k == 2 ? 0.0 : 2e9, .ah = 1.0, .bh = k ? 0.5 : 1.0, .nu = 0.3};

    for (int q = 0; q < N; q++)
      x[q] = RandomIn(0.0, 0.9);
    ElasticityYoungBatch(&el, N, x, a);
    for (int q = 0; q < N; q++)
      b[q] = ElasticityYoung(&el, x[q], &d);
    assert_true(Worst(N, a, b) < 1e-15);
  }
}

/* The law has one form; what differs is how many states it sees at a time. */
static void TestGas(void **state)
{
  const char *const *type = GasTypes();

  (void)state;
  for (int k = 0; type[k]; k++) {
    Gas           law = {.M = 0.016, .Tc = 190.564, .pc = 4.5992e6, .eccentric = 0.01142};
    static double da_T[N], db_T[N];

    assert_true(GasSetType(&law, type[k]));
    for (int q = 0; q < N; q++) {
      x[q] = pow(10.0, RandomIn(0.0, 9.0));
      y[q] = RandomIn(-50.0, 150.0);
    }
    GasDensityBatch(&law, N, x, y, a, da, da_T);
    for (int q = 0; q < N; q++)
      b[q] = GasDensity(&law, x[q], y[q], &db[q], &db_T[q]);
    printf("gas %-14s: density %.1e, slopes %.1e, %.1e\n", type[k], Worst(N, a, b), Worst(N, da, db),
           Worst(N, da_T, db_T));
    assert_true(Worst(N, a, b) < 1e-13 && Worst(N, da, db) < 1e-11 && Worst(N, da_T, db_T) < 1e-11);
  }
}

static void TestViscosity(void **state)
{
  double d, e;

  (void)state;
  for (int k = 0; k < 2; k++) {
    const Viscosity law = {.law = k, .mu = 2e-5, .salinity = 0.03, .M = 0.016};

    for (int q = 0; q < N; q++) {
      x[q] = RandomIn(0.1, 300.0);
      y[q] = RandomIn(-5.0, 90.0);
    }
    WaterViscosityBatch(&law, N, y, a);
    GasViscosityBatch(&law, N, x, y, da);
    for (int q = 0; q < N; q++) {
      b[q]  = WaterViscosity(&law, y[q], &d);
      db[q] = GasViscosity(&law, x[q], y[q], &d, &e);
    }
    assert_true(Worst(N, a, b) == 0.0 && Worst(N, da, db) == 0.0);
  }
}

static void TestReaction(void **state)
{
  const char *const *type = EquilibriumTypes();
  double             d;

  (void)state;
  for (int q = 0; q < N; q++)
    x[q] = RandomIn(-30.0, 60.0);
  for (int k = 0; type[k]; k++) {
    Equilibrium law = {.A1 = 1e3, .A2 = 38.98, .A3 = 8533.8, .shift = 0.4 * k};

    assert_true(EquilibriumSetType(&law, type[k]));
    EquilibriumPressureBatch(&law, N, x, a, da);
    for (int q = 0; q < N; q++)
      b[q] = EquilibriumPressure(&law, x[q], &db[q]);
    printf("equilibrium %-8s: pressure %.1e, slope %.1e\n", type[k], Worst(N, a, b), Worst(N, da, db));
    assert_true(Worst(N, a, b) < 1e-13 && Worst(N, da, db) < 1e-11);
  }
  for (int k = 0; k < 2; k++) {
    const Kinetics   law    = {.K0 = 2.5e-7, .dE = k ? 8e4 : 0.0, .A_geo = 1e6};
    const LatentHeat latent = {.C0 = 4.7e5, .C1 = 140.0, .kirchhoff = k, .T_ref = 4.0, .dc = 900.0};

    KineticsRateConstantBatch(&law, N, x, a, da);
    for (int q = 0; q < N; q++)
      b[q] = KineticsRateConstant(&law, x[q], &db[q]);
    assert_true(Worst(N, a, b) < 1e-13 && Worst(N, da, db) < 1e-11);
    for (int q = 0; q < N; q++)
      y[q] = RandomIn(0.0, 1.0);
    KineticsFormationAreaBatch(&law, N, y, x, y, a);
    for (int q = 0; q < N; q++)
      b[q] = KineticsFormationArea(&law, y[q], x[q], y[q]).v;
    assert_true(Worst(N, a, b) < 1e-15);
    LatentHeatBatch(&latent, N, x, a);
    for (int q = 0; q < N; q++)
      b[q] = LatentHeatEvaluate(&latent, x[q], &d);
    assert_true(Worst(N, a, b) < 1e-15);

    const double X[4] = {3.0, 0.5, 0.6, 0.03};
    double       slope[3];

    MixtureAverageBatch(N, y, y, y, X, a);
    for (int q = 0; q < N; q++)
      b[q] = MixtureAverage(y[q], y[q], y[q], X, &slope[0], &slope[1], &slope[2]);
    assert_true(Worst(N, a, b) < 1e-15);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestRetention),         cmocka_unit_test(TestRelPerm),
                                     cmocka_unit_test(TestPermeability),      cmocka_unit_test(TestGas),
                                     cmocka_unit_test(TestViscosity),         cmocka_unit_test(TestReaction),
                                     cmocka_unit_test(TestLiquidAndStiffness)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
