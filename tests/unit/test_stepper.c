/* A number that is none is no small error: neither the estimate of a step nor the state after it passes it by; what
   errors are relative to; the time left. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "clathra/stepper.h"
#include "ranks.h"

#define N 3
#define GOOD(call) assert_int_equal((call), 0)

static Case    c;
static Model   m;
static Stepper s;

static int Start(void **state)
{
  m                = (Model){.c = &c.scene};
  s                = (Stepper){.model = &m, .tol = 1e-3, .state = {.scale_p = 1e4, .scale_T = 1.0, .scale_u = 1e-3}};
  c.scene.fields   = (FieldSet){.has = HAS_SOLID | HAS_WATER};
  c.error_exponent = 2.0;
  m.grid.comm      = PETSC_COMM_WORLD;
  GOOD(ParticlesCreate(c.scene.fields.has, &m.P));
  GOOD(ParticlesResize(&m.P, N));
  for (int k = 0; k < P_COUNT; k++) {
    for (int p = 0; m.P.f[k] && p < N; p++)
      m.P.f[k][p] = 0.0;
  }
  return 0;
}

static int End(void **state)
{
  return ParticlesDestroy(&m.P);
}

static void AnErrorThatIsNoNumberIsLarge(void **state)
{
  double  e[4 * N] = {0}, eu[2 * N] = {0};
  Attempt a = {.status = CL_OK};

  assert_true(StepperErrorNorm(&s, e, eu, &a) == 0.0);
  e[4 * 1 + 0] = NAN;
  assert_true(StepperErrorNorm(&s, e, eu, &a) > 1.0);
  e[4 * 1 + 0]  = 0.0;
  eu[2 * 2 + 1] = NAN;
  assert_true(StepperErrorNorm(&s, e, eu, &a) > 1.0);
  assert_string_equal(stepper_error_word[a.rules], "displacement");
}

/* (292): what one of three particles has, by exponent. */
static void TheExponentSeesAFront(void **state)
{
  double  e[4 * N] = {0}, eu[2 * N] = {0};
  Attempt a = {.status = CL_OK};

  e[4 * 2]                = s.tol * s.state.scale_p;
  eu[2 * 1]               = 0.3 * s.tol * s.state.scale_u;
  eu[2 * 1 + 1]           = -0.4 * s.tol * s.state.scale_u;
  const double exponent[] = {1.0, 2.0, 8.0, 16.0};
  for (int k = 0; k < 4; k++) {
    c.error_exponent = exponent[k];
    assert_true(fabs(StepperErrorNorm(&s, e, eu, &a) / pow(3.0, -1.0 / exponent[k]) - 1.0) < 1e-12);
    assert_string_equal(stepper_error_word[a.rules], "p_w");
  }
  e[4 * 2] = 0.0;
  assert_true(fabs(StepperErrorNorm(&s, e, eu, &a) / (0.5 * pow(3.0, -1.0 / 16.0)) - 1.0) < 1e-12);
  e[4 * 2] = NAN;
  assert_true(isinf(StepperErrorNorm(&s, e, eu, &a)));
  c.error_exponent = 2.0;
}

/* An error of T counts by the largest change so far, whatever the place has started from; the largest is named. */
static void TemperatureCountsByItsChange(void **state)
{
  double         e[4 * N] = {0}, eu[2 * N] = {0};
  Attempt        a    = {.status = CL_OK};
  const StepInfo info = {.dt = 1.0};
  Region         r    = {.temperature = 4.0};

  c.scene.region = &r;
  GOOD(ParticlesDestroy(&m.P));
  GOOD(ParticlesCreate(HAS_WATER | HAS_HEAT, &m.P));
  GOOD(ParticlesResize(&m.P, N));
  for (int p = 0; p < N; p++) {
    for (int k = 0; k < P_COUNT; k++) {
      if (m.P.f[k])
        m.P.f[k][p] = 0.0;
    }
    m.P.i[PI_REGION][p] = 0;
    m.P.f[P_T][p]       = 4.0;
    e[4 * p + 2]        = 1e-3;
  }
  GOOD(StepperAccept(&s, &a, &info));
  assert_true(s.state.scale_T == 1.0);
  assert_true(fabs(StepperErrorNorm(&s, e, eu, &a) - 1.0) < 1e-12);
  m.P.f[P_T][1] = 60.0;
  GOOD(StepperAccept(&s, &a, &info));
  m.P.f[P_T][1] = 4.0;
  GOOD(StepperAccept(&s, &a, &info));
  assert_true(s.state.scale_T == 56.0);
  assert_true(fabs(StepperErrorNorm(&s, e, eu, &a) - 1.0 / 56.0) < 1e-12);
  assert_string_equal(stepper_error_word[a.rules], "T");
  m.P.f[P_T][2] = NAN;
  GOOD(StepperAccept(&s, &a, &info));
  assert_true(s.broken && s.state.scale_T == 56.0);
}

/* Runs of known length, one unit of cost a step, whose steps begin anew at kinks: of what is left after 5 % and later,
   but for the first steps behind a kink. */
static double LeftOff(double (*next)(double t, double dt), const Ahead *a)
{
  Learnt l    = {.n = 0};
  double kink = a->kinks ? a->kink[0] : INFINITY, from = 0.0, dt = 1.0, steps = 0.0, all = 0.0, worst = 1.0;
  int    passed = 0;

  for (int count = 1; count >= 0; count--) {
    from = passed = 0;
    dt            = 1.0;
    kink          = a->kinks ? a->kink[0] : INFINITY;
    for (double t = 0.0; t < 0.999999 * a->end;) {
      Ahead ahead = *a;

      t += fmin(fmin(dt, kink - t), a->end - t);
      dt = next(t - from, dt);
      all += count;
      if (!count)
        LearntAdd(&l, t, ++steps);
      if (t >= kink) {
        from = t;
        dt   = 1.0;
        kink = ++passed < a->kinks ? a->kink[passed] : INFINITY;
        if (!count)
          LearntBegin(&l, t, steps);
      }
      if (count || t < 0.05 * a->end || t >= 0.9 * a->end)
        continue;
      ahead.kinks -= passed;
      for (int k = 0; k < ahead.kinks; k++)
        ahead.kink[k] = a->kink[passed + k];
      const double off = LearntLeft(&l, &ahead) / (all - steps);
      if (t - from > 0.01 * a->end)
        worst = fmax(worst, fmax(off, 1.0 / off));
    }
  }
  return worst;
}

static double Even(double t, double dt)
{
  return 1.0;
}

static double Diffuses(double t, double dt)
{
  return fmax(1.0, 0.05 * t); /* steps in proportion to time, as where a front spreads */
}

static double Grows(double t, double dt)
{
  return fmin(1.2 * dt, 400.0);
}

static double Root(double t, double dt)
{
  return fmax(1.0, 0.5 * sqrt(t));
}

static void TimeLeftIsLearnt(void **state)
{
  static const struct {
    const char *what;
    double (*next)(double, double);
    Ahead ahead;
  } run[] = {
      {"even steps", Even, {.end = 1e5, .stretch = INFINITY, .even = true}},
      {"as many as there are stops", Even, {.end = 1e4, .stretch = 1.0}},
      {"dt ~ t", Diffuses, {.end = 1e6, .stretch = 5e4}},
      {"growth to a largest step", Grows, {.end = 1e5, .stretch = 400.0}},
      {"dt ~ sqrt t", Root, {.end = 1e6, .stretch = INFINITY}},
      {"dt ~ t behind each kink", Diffuses, {.end = 1e6, .stretch = 1e5, .kinks = 2, .kink = {3e4, 4e5}}},
  };
  Learnt l = {.n = 0};

  assert_true(isnan(LearntLeft(&l, &run[1].ahead)));
  LearntAdd(&l, 1.0, 1.0);
  assert_true(isnan(LearntLeft(&l, &run[1].ahead)));
  for (size_t k = 0; k < sizeof(run) / sizeof(*run); k++) {
    const double worst = LeftOff(run[k].next, &run[k].ahead);

    printf("time left after 5 %%, %-26s off by a factor of %.3f at most\n", run[k].what, worst);
    assert_true(worst < 2.0);
  }
}

static void AStateThatIsNoNumberIsNotGoneOnWith(void **state)
{
  const int      spoilt[] = {P_PW, P_SIG, P_U + 1};
  const Attempt  a        = {.status = CL_OK};
  const StepInfo info     = {.dt = 1.0};

  GOOD(StepperAccept(&s, &a, &info));
  assert_false(s.broken);
  for (int k = 0; k < 3; k++) {
    m.P.f[spoilt[k]][1] = NAN;
    GOOD(StepperAccept(&s, &a, &info));
    assert_true(s.broken && isfinite(s.state.scale_p) && isfinite(s.state.scale_u));
    m.P.f[spoilt[k]][1] = 0.0;
    GOOD(StepperAccept(&s, &a, &info));
    assert_false(s.broken);
  }
}

static int Seven(void)
{
  return 7;
}

static void ASignalStopsAfterTheStep(void **state)
{
  const Attempt  a    = {.status = CL_OK, .loose = 2.5};
  const StepInfo info = {.dt = 1.0};

  GOOD(StepperAccept(&s, &a, &info));
  assert_true(!s.stop && s.state.loose_total == 1 && s.state.err_worst == 2.5);
  s.interrupted = Seven;
  GOOD(StepperAccept(&s, &a, &info));
  assert_true(s.stop && s.signal == 7);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test_setup_teardown(AnErrorThatIsNoNumberIsLarge, Start, End),
                                     cmocka_unit_test_setup_teardown(TheExponentSeesAFront, Start, End),
                                     cmocka_unit_test_setup_teardown(AStateThatIsNoNumberIsNotGoneOnWith, Start, End),
                                     cmocka_unit_test_setup_teardown(ASignalStopsAfterTheStep, Start, End),
                                     cmocka_unit_test_setup_teardown(TemperatureCountsByItsChange, Start, End),
                                     cmocka_unit_test(TimeLeftIsLearnt)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
