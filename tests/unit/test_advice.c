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

/* Hydrate at 13 degC in sand beside clay of a thousandth of its permeability, and a well; beside it T (degC), and q
   (W/m^2) from below. */
static const char *Advised(double T, double q, bool donor)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.6, 0.32};
  SmallScene  *s       = malloc(sizeof(*s));
  Stepper     *stepper = calloc(1, sizeof(*stepper));

  SceneInit(s, HAS_ALL, false, false, BASIS_CPGIMP, 0.0, lower, upper);
  s->mat.reacts = true;
  SceneLayers(s, 1, 0.16, 1e-3);
  s->c.scene.stabilisation.donor = donor;
  AddFace(s, BC_PRESSURE, SIDE_XMIN, 5e6, 0.0);
  AddFace(s, BC_FACE_TEMPERATURE, SIDE_XMIN, T, 0.0);
  AddFace(s, BC_HEAT_FLUX, SIDE_YMIN, q, 0.0);
  s->m.c                                                       = &s->c.scene;
  s->m.grid.comm                                               = PETSC_COMM_WORLD;
  stepper->model                                               = &s->m;
  stepper->state.begin[HIGHEST_T]                              = 13.0;
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

/* (381) keeps most of a well's gas in its cells: it is for hydrate that is heated. */
static void HeldReactionIsForHeaters(void **state)
{
  if (PetscGlobalRank > 0) /* the words are rank 0's */
    return;
  assert_non_null(strstr(Advised(60.0, 0.0, false), "stabilisation_reaction_heat"));
  assert_true(Starts("stabilisation_reaction_heat: yes"));
  assert_non_null(strstr(Advised(13.0, 500.0, false), "stabilisation_reaction_heat"));
  assert_null(strstr(Advised(13.0, 0.1, false), "stabilisation_reaction_heat"));
  assert_true(Starts("stabilisation_donor: yes"));
  assert_null(strstr(Advised(13.0, 0.1, true), "stabilisation_donor"));
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(HeldReactionIsForHeaters)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
