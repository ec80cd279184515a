/* What the note of a slow run advises: first what its scene needs. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "small_scene.h"
#include "clathra/stepper.h"

static char said[STEPPER_ADVICE];

/* Hydrate in sand beside clay of a thousandth of its permeability, and a well. */
static const char *Advised(bool donor)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.6, 0.32};
  SmallScene  *s       = malloc(sizeof(*s));
  Stepper     *stepper = calloc(1, sizeof(*stepper));

  SceneInit(s, HAS_ALL, false, false, BASIS_CPGIMP, 0.0, lower, upper);
  s->mat.reacts = true;
  SceneLayers(s, 1, 0.16, 1e-3);
  s->c.scene.stabilisation.donor = donor;
  AddFace(s, BC_PRESSURE, SIDE_XMIN, 5e6, 0.0);
  s->m.c         = &s->c.scene;
  stepper->model = &s->m;
  StepperAdviceSlow(stepper, false, said);
  free(stepper);
  free(s);
  return said;
}

static void DonorIsForGasBesideClay(void **state)
{
  const char *const first = "stabilisation_donor: yes";

  assert_memory_equal(Advised(false), first, strlen(first));
  assert_null(strstr(Advised(true), "stabilisation_donor"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(DonorIsForGasBesideClay)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
