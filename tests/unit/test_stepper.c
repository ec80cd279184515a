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
#include "recorded_runs.h"
#include "../../src/findings/findings_private.h"

#define N 3
#define GOOD(call) assert_int_equal((call), 0)

static Case    c;
static Model   m;
static Stepper s;

static int Start(void **state)
{
  FindingForget();
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
  m.P.f[P_X][2]           = 7.0;
  m.P.f[P_X + 1][2]       = -2.0;
  m.P.f[P_X][1]           = 3.0;
  const double exponent[] = {1.0, 2.0, 8.0, 16.0};
  for (int k = 0; k < 4; k++) {
    c.error_exponent = exponent[k];
    assert_true(fabs(StepperErrorNorm(&s, e, eu, &a) / pow(3.0, -1.0 / exponent[k]) - 1.0) < 1e-12);
    assert_string_equal(stepper_error_word[a.rules], "p_w");
  }
  assert_true(a.peak.err == 1.0 && a.peak.of == 0 && a.peak.at[0] == 7.0 && a.peak.at[1] == -2.0);
  e[4 * 2] = 0.0;
  assert_true(fabs(StepperErrorNorm(&s, e, eu, &a) / (0.5 * pow(3.0, -1.0 / 16.0)) - 1.0) < 1e-12);
  assert_true(fabs(a.peak.err - 0.5) < 1e-12 && a.peak.at[0] == 3.0);
  assert_string_equal(stepper_error_word[a.peak.of], "displacement");
  e[4 * 2] = NAN;
  assert_true(isinf(StepperErrorNorm(&s, e, eu, &a)));
  assert_true(isinf(a.peak.err) && a.peak.at[0] == 7.0);
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

/* A run of known length whose loads have kinks: its steps and their cost so far, forecast of what is left. */
typedef struct {
  Learnt l;
  Ahead  ahead;  /* the whole run's */
  int    passed; /* kinks */
  double steps, spent;
} Told;

/* A step to time t. */
static void Tell(Told *r, double t, double cost)
{
  r->steps += 1.0;
  r->spent += cost;
  LearntAdd(&r->l, t, r->steps, r->spent);
  if (r->passed < r->ahead.kinks && t >= r->ahead.kink[r->passed]) {
    LearntBegin(&r->l, t, t);
    r->passed++;
  }
}

/* Of what is left of a cost of `all`. */
static double Off(const Told *r, double all)
{
  Ahead ahead = r->ahead;

  ahead.kinks -= r->passed;
  for (int k = 0; k < ahead.kinks; k++)
    ahead.kink[k] = r->ahead.kink[r->passed + k];
  return LearntLeft(&r->l, &ahead) / (all - r->spent);
}

typedef double Law(double t, double dt, double kink);

/* One unit of cost a step; the step of the law, and behind a kink a tenth of the last one at first.  Of what is left
 * after 5 % and later. */
static double LeftOff(Law *next, const Ahead *a)
{
  double all = 0.0, worst = 1.0;

  for (int count = 1; count >= 0; count--) {
    Told   r  = {.ahead = *a};
    double dt = 1.0, from = 0.0;

    for (double t = 0.0; t < 0.999999 * a->end;) {
      const double kink = r.passed < a->kinks ? a->kink[r.passed] : INFINITY;

      t += fmin(fmin(dt, kink - t), a->end - t);
      dt = t >= kink ? 0.1 * dt : next(t - from, dt, from);
      Tell(&r, t, 1.0);
      if (t >= kink)
        from = t;
      if (count || t < 0.05 * a->end || t >= 0.9 * a->end)
        continue;
      const double off = Off(&r, all);

      if (t - from > 0.01 * a->end)
        worst = fmax(worst, fmax(off, 1.0 / off));
    }
    all = r.spent;
  }
  return worst;
}

static double Even(double t, double dt, double kink)
{
  return 1.0;
}

static double Diffuses(double t, double dt, double kink)
{
  return fmax(1.0, 0.05 * t); /* steps in proportion to time, as where a front spreads */
}

static double Grows(double t, double dt, double kink)
{
  return fmin(1.2 * dt, 400.0);
}

static double Root(double t, double dt, double kink)
{
  return fmax(1.0, 0.5 * sqrt(t));
}

/* Behind a change of slope the error is t/kink of what it was behind the begin (345). */
static double Kinked(double t, double dt, double kink)
{
  return fmin(2.0 * dt, Diffuses(t, dt, kink) * cbrt(fmax(kink / t, 1.0)));
}

static void TimeLeftIsLearnt(void **state)
{
  static const struct {
    const char *what;
    Law        *next;
    Ahead       ahead;
  } run[] = {
      {"even steps", Even, {.end = 1e5, .stretch = INFINITY, .even = true}},
      {"as many as there are stops", Even, {.end = 1e4, .stretch = 1.0}},
      {"dt ~ t", Diffuses, {.end = 1e6, .stretch = 5e4}},
      {"growth to a largest step", Grows, {.end = 1e5, .stretch = 400.0}},
      {"dt ~ sqrt t", Root, {.end = 1e6, .stretch = INFINITY}},
      {"an early and a late kink", Kinked, {.end = 1e6, .stretch = INFINITY, .kinks = 2, .kink = {3e4, 4e5}}},
      {"two late kinks", Kinked, {.end = 1e6, .stretch = INFINITY, .kinks = 2, .kink = {3e5, 6e5}}},
  };
  Learnt l = {.told = 0};

  assert_true(fabs(LearntMedian(100.0, 0.0) - 100.0) < 0.1); /* (411): all is left, ... */
  assert_true(fabs(LearntMedian(100.0, 100.0) / (100.0 * (exp2(0.6744897501960817) - 1.0)) - 1.0) <
              1e-6);                                                                   /* a quarter */
  assert_true(fabs(LearntMedian(1.0, 63.99) / LearntMedian(1.0, 64.01) - 1.0) < 0.05); /* where the tail takes over */
  assert_true(isnan(LearntLeft(&l, &run[1].ahead)));
  LearntAdd(&l, 1.0, 1.0, 1.0);
  assert_true(isnan(LearntLeft(&l, &run[1].ahead)));
  for (size_t k = 0; k < sizeof(run) / sizeof(*run); k++) {
    const double worst = LeftOff(run[k].next, &run[k].ahead);

    printf("time left after 5 %%, %-26s off by a factor of %.3f at most\n", run[k].what, worst);
    assert_true(worst < 2.0);
  }
}

/* Steps in proportion to time, until at a share `fell` of the run gas comes: then so many steps of 1e-7 of it, from
   where they grow back by 15 %.  What is said to be left of it `at` steps behind, over what is. */
static double SlumpOff(double fell, int stood, int at, double *flat)
{
  const double end = 1e6, fall = fell * end;
  double       all = 0.0, off = NAN;

  for (int count = 1; count >= 0; count--) {
    Told   r    = {.ahead = {.end = end, .stretch = INFINITY, .forecast = 80.0}};
    double dt   = 1.0;
    int    late = 0;

    for (double t = 0.0; t < 0.999999 * end;) {
      late += t >= fall;
      dt = late == 0 ? fmax(1.0, 0.1 * t) : late <= stood ? 1e-7 * end : fmin(1.15 * dt, 0.1 * t);
      t += fmin(dt, end - t);
      Tell(&r, t, 1.0);
      if (late == at && !count) {
        off   = Off(&r, all);
        *flat = LearntFlat(&r.l, &r.ahead) / (all - r.spent);
      }
    }
    all = r.spent;
  }
  return off;
}

/* (420) and (421): steps that fall by orders of magnitude between two kinks, as where the first gas comes. */
static void ASlumpIsSeen(void **state)
{
  static const double fell[]  = {0.2, 0.7};
  static const int    stood[] = {15, 40}, at[] = {12, 15, 40, 60};
  double              flat;

  for (int k = 0; k < 16; k++) {
    const int    n = stood[k / 4 % 2], i = at[k % 4];
    const double off = SlumpOff(fell[k / 8], n, i, &flat);

    printf("at %.1f %d steps of a ten-millionth, %d later: left %.2f of what is, %.3g if they stay\n", fell[k / 8], n,
           i, off, flat);
    assert_true(off > 0.5 && off < 3.0);
    assert_true(i > n || flat > 1e4);
  }
  SlumpOff(0.2, 15, 5, &flat);
  assert_true(flat < 3.0); /* it counts the last ten steps */
}

static bool IsSlow(const Slow *slow, const Forecast *f, PetscInt taken, Pace *pace)
{
  pace->taken = taken;
  return FindingsIsSlow(slow, f, pace);
}

/* Slow is what has taken twice the forecast, of steps or on the clock, and has ten times as much left. */
static void SlowBySteps(void **state)
{
  const Forecast f    = {.implicit_steps = 80.0, .implicit_seconds = 22.0};
  Slow           slow = {.next = 160.0, .clock = 44.0};
  Pace           p    = {.left = 801.0, .step = 0.1, .spent = 16.0};

  assert_true(IsSlow(&slow, &f, 160, &p));
  assert_false(IsSlow(&slow, &f, 159, &p));
  p.left = 799.0;
  assert_false(IsSlow(&slow, &f, 160, &p));
  p.left = NAN;
  assert_false(IsSlow(&slow, &f, 160, &p));
  p = (Pace){.left = 801.0, .step = 0.01, .spent = 1.6};
  assert_false(IsSlow(&slow, &f, 160, &p)); /* it is over in seconds */
}

static void SlowByTheClock(void **state)
{
  const Forecast f    = {.implicit_steps = 80.0, .implicit_seconds = 22.0};
  Slow           slow = {.next = 160.0, .clock = 44.0};
  Pace           p    = {.left = 60.0, .step = 4.3, .spent = 45.0};

  assert_true(IsSlow(&slow, &f, 10, &p));
  p.step = 3.0;
  assert_false(IsSlow(&slow, &f, 10, &p)); /* a slow machine is no slow run */
  p = (Pace){.left = 60.0, .step = 4.3, .spent = 43.0};
  assert_false(IsSlow(&slow, &f, 10, &p));
  assert_false(IsSlow(&slow, &f, 160, &p)); /* twice the steps, but neither ten times as many nor twice the time */
  slow    = (Slow){.next = 20.0, .clock = 90.0, .said = true};
  p.spent = 91.0;
  assert_false(IsSlow(&slow, &f, 19, &p));
  assert_true(IsSlow(&slow, &f, 20, &p));
  p.spent = 89.0;
  assert_false(IsSlow(&slow, &f, 20, &p));
}

/* Recorded runs, wells and heaters in hydrate among them: of the lines after 5 % this share is within a factor of two,
   and of the first lines after 5, 10, 25 and 50 % as many. */
static void TimeLeftOfRecordedRuns(void **state)
{
  static const double mark[] = {0.05, 0.1, 0.25, 0.5};
  const int           runs = (int)(sizeof(recorded) / sizeof(*recorded)), marks = 4 * runs;
  int                 within = 0, at_marks = 0;
  double              share = 0.0;

  for (int k = 0; k < runs; k++) {
    const Recorded *r    = &recorded[k];
    Told            told = {.ahead = {.end = 1e7, .kinks = r->kinks, .forecast = r->forecast}};
    double          all = 0.0, worst = 1.0;
    int             lines = 0, good = 0, marked = 0;

    for (int i = 0; i < r->n; i++)
      all += r->step[i][1];
    for (int i = 0; i < r->kinks; i++)
      told.ahead.kink[i] = 1e7 * r->kink[i];
    printf("time left after 5 %%, %-36s", r->what);
    for (int i = 0; i + 1 < r->n; i++) {
      const double t = r->step[i][0], stops = fmax(ceil(r->stops * (1.0 - 1e-7 * t)), 1.0);

      Tell(&told, t, r->step[i][1]);
      told.ahead.stretch = (1e7 - t) / stops;
      if (t < 0.05e7)
        continue;
      const double off = Off(&told, all), factor = fmax(off, 1.0 / off);

      lines++;
      good += factor <= 2.0;
      worst = fmax(worst, factor);
      for (; marked < 4 && t >= 0.9999999e7 * mark[marked]; marked++) {
        printf(" %5.2f", off);
        at_marks += factor <= 2.0;
      }
    }
    printf("  %3d of %3d lines within two, worst %.2f\n", good, lines, worst);
    assert_true(lines > 10 && marked == 4);
    within += good;
    share += (double)good / lines / runs;
  }
  printf("time left: %d of %d within two at 5, 10, 25 and 50 %%; %d lines, %.1f %% in the mean of the runs\n", at_marks,
         marks, within, 100.0 * share);
  assert_true(at_marks >= 0.85 * marks && share >= 0.82);
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

/* What the stepper says, to PETSC_STDOUT, while this runs. */
static void Said(char *text, size_t size, PetscErrorCode (*call)(int), int n)
{
  FILE *kept = PETSC_STDOUT, *file = tmpfile();

  assert_non_null(file);
  PETSC_STDOUT = file;
  GOOD(call(n));
  PETSC_STDOUT = kept;
  rewind(file);
  text[fread(text, 1, size - 1, file)] = '\0';
  fclose(file);
}

static PetscErrorCode GiveUp(int status)
{
  return StepperGiveUpStep(&s, 3, (ClStatus)status);
}

static PetscErrorCode AcceptSpoilt(int unused)
{
  const Attempt  a    = {.status = CL_OK};
  const StepInfo info = {.dt = 1.0};

  m.P.f[P_PW][0] = NAN;
  return StepperAccept(&s, &a, &info);
}

/* Whatever a run gives up for, the next line says what to try. */
static void EveryEndSaysWhatToTry(void **state)
{
  int  rank;
  char text[1024];

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  for (int k = CL_DOMAIN; k <= CL_INACCURATE + 1; k++) { /* the last: a state that is no number */
    if (k <= CL_INACCURATE)
      Said(text, sizeof(text), GiveUp, k);
    else
      Said(text, sizeof(text), AcceptSpoilt, 0);
    if (rank)
      continue; /* the first rank speaks */
    const char *end = strstr(text, "Given up"), *line = end ? strchr(end, '\n') : NULL;

    assert_non_null(line);
    if (strstr(line, "\n  What to try, in this order: ") != line)
      fail_msg("%s", text);
    assert_true(strlen(line) > 60 && strstr(line, "docs/giving_up.md"));
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
                                     cmocka_unit_test_setup_teardown(EveryEndSaysWhatToTry, Start, End),
                                     cmocka_unit_test_setup_teardown(ASignalStopsAfterTheStep, Start, End),
                                     cmocka_unit_test_setup_teardown(TemperatureCountsByItsChange, Start, End),
                                     cmocka_unit_test(TimeLeftIsLearnt),
                                     cmocka_unit_test(ASlumpIsSeen),
                                     cmocka_unit_test(SlowBySteps),
                                     cmocka_unit_test(SlowByTheClock),
                                     cmocka_unit_test(TimeLeftOfRecordedRuns)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
