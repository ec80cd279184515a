/* A number that is none is no small error: neither the estimate of a step nor the state after it passes it by. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <cmocka.h>
#include "clathra/stepper.h"

#define N 3
#define GOOD(call) assert_int_equal((call), 0)

static Case    c;
static Model   m;
static Stepper s;

static int Start(void **state)
{
  m           = (Model){.c = &c};
  s           = (Stepper){.model = &m, .tol = 1e-3, .state = {.scale_p = 1e4, .scale_u = 1e-3}};
  c.fields    = (FieldSet){.has = HAS_SOLID | HAS_WATER};
  m.grid.comm = PETSC_COMM_WORLD;
  GOOD(ParticlesCreate(c.fields.has, &m.P));
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
  double e[4 * N] = {0}, eu[2 * N] = {0};

  assert_true(StepperErrorNorm(&s, e, eu) == 0.0);
  e[4 * 1 + 0] = NAN;
  assert_true(StepperErrorNorm(&s, e, eu) > 1.0);
  e[4 * 1 + 0]  = 0.0;
  eu[2 * 2 + 1] = NAN;
  assert_true(StepperErrorNorm(&s, e, eu) > 1.0);
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
                                     cmocka_unit_test_setup_teardown(AStateThatIsNoNumberIsNotGoneOnWith, Start, End),
                                     cmocka_unit_test_setup_teardown(ASignalStopsAfterTheStep, Start, End)};
  int                     failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL))
    return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  return PetscFinalize() || failed;
}
