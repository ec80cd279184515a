/* What a user may try when a run gives up, for its cause, the likeliest first; docs/giving_up.md says more. */
#include "clathra/stepper.h"
#include "clathra/words.h"

const char *StepperStatusName(ClStatus st)
{
  static const char *const name[] = {"fine",          "inadmissible state", "not finite", "left the grid",
                                     "moved too far", "no solution",        "inaccurate", "fatal"};

  return name[st];
}

/* May the integrators without a matrix help, which a run by an implicit one does not try by itself? */
static bool HybridMayHelp(const Stepper *s, ClStatus status)
{
  return (status == CL_TOO_FAR || status == CL_SOLVER) && !s->explicit && !s->auto_.on &&
         !CaseNeedsImplicit(StepperCase(s));
}

/* Does gas lie in layers, of which one may hold it fast, without (332)? */
static bool DonorMayHelp(const Stepper *s, ClStatus status)
{
  const Scene *c = s->model->c;

  return (status == CL_SOLVER || status == CL_INACCURATE) && !s->explicit && !c->stabilisation.donor &&
         c->fields.phase[PHASE_G] && SceneContrast(c) > 1.0;
}

/* Empty where nothing is known to help. */
static void Advice(const Stepper *s, ClStatus status, char words[STEPPER_ADVICE])
{
  static const char *const advice[] = {
      [CL_DOMAIN] =
          "the load or the pressure that brings a particle there: a ramp instead of a jump, and less of it; the "
          "units of what acts near that place; finer cells there",
      [CL_NONFINITE] = "the units of the materials and conditions near that place; a smaller stepper_dt; without the "
                       "conditions one by one",
      [CL_LEFT_GRID] =
          "a larger grid, for the body must stay inside it; a roller or fixed line where the body should be "
          "held; particles: {leaving: remove} for what may go",
      [CL_TOO_FAR] = "gravity_ramp or a ramp of the load; stress: {geostatic: K0} for a body that starts unstressed; "
                     "inertia: yes where it slides",
      [CL_SOLVER] =
          "a ramp instead of a jump of what acts near that place; Sgr of some percent and p0 of some kPa more, "
          "where gas or water is nearly immobile; surfaces on lines of the grid, or well inside cells; "
          "finer cells there",
      [CL_INACCURATE] = "stepper_tol ten times larger; a ramp instead of a jump; finer cells where fields are steep"};
  const char *what = status >= 0 && status <= CL_INACCURATE ? advice[status] : NULL;

  words[0] = '\0';
  if (what)
    snprintf(words, STEPPER_ADVICE, "%s%s%s",
             DonorMayHelp(s, status) ? "stabilisation_donor: yes, for gas beside clay whose gas is trapped; " : "",
             what, HybridMayHelp(s, status) ? "; stepper_type hybrid or auto for what is fast" : "");
}

void StepperAdviceSlow(const Stepper *s, bool newton, char words[STEPPER_ADVICE])
{
  snprintf(
      words, STEPPER_ADVICE, "%s%s%s",
      DonorMayHelp(s, CL_SOLVER) ? "stabilisation_donor: yes, for gas beside clay whose gas is trapped; " : "",
      newton
          ? "Sgr of some percent and p0 of some kPa more, where gas or water is nearly immobile; stepper_type euler; "
          : "stepper_tol ten times larger; ",
      "a ramp instead of a jump; finer cells near that place");
}

PetscErrorCode StepperGiveUp(const Stepper *s, ClStatus cause, const char *what_to_try, const char *why, ...)
{
  char    words[STEPPER_ADVICE], sentence[CL_WHY + 256];
  va_list args;

  PetscFunctionBeginUser;
  va_start(args, why);
  vsnprintf(sentence, sizeof(sentence), why, args);
  va_end(args);
  Advice(s, cause, words);
  PetscCall(FindingSayOf(s->model->grid.comm, FINDING_GIVEN_UP, NULL, what_to_try ? what_to_try : words, "%s%s",
                         TimeAt(s->state.t).s, sentence));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperGiveUpStep(const Stepper *s, PetscInt attempts, ClStatus status)
{
  const Failure *last = ModelFailure(s->model);

  PetscFunctionBeginUser;
  PetscCall(StepperGiveUp(s, status, NULL, " after %" PetscInt_FMT " attempts at this step: %s (%s), near %s", attempts,
                          last->why, StepperStatusName(status), PlaceWords(last->where).s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
