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

static char said[2048];

/* Instead of to stdout, as PETSc offers it. */
static PetscErrorCode Keep(FILE *to, const char format[], va_list list)
{
  (void)to;
  vsnprintf(said, sizeof(said), format, list);
  return PETSC_SUCCESS;
}

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
  s->m.c                                                       = &s->c.scene;
  s->m.grid.comm                                               = PETSC_COMM_WORLD;
  stepper->model                                               = &s->m;
  said[0]                                                      = '\0';
  PetscErrorCode (*const plain)(FILE *, const char[], va_list) = PetscVFPrintf;
  PetscVFPrintf                                                = Keep;
  Call(StepperAdviseSlow(stepper, false));
  PetscVFPrintf = plain;
  free(stepper);
  free(s);
  return said;
}

static bool Starts(const char *words)
{
  const char *const colon = strchr(said, ':');

  return colon && strncmp(colon + 2, words, strlen(words)) == 0;
}

static void DonorIsForGasBesideClay(void **state)
{
  if (PetscGlobalRank > 0) /* the words are rank 0's */
    return;
  Advised(false);
  assert_true(Starts("stabilisation_donor: yes"));
  assert_null(strstr(Advised(true), "stabilisation_donor"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(DonorIsForGasBesideClay)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
