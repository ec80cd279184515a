/* The time loop, whatever the scheme: what it starts from, stage by stage to the end. */
#include "clathra/stepper.h"

#define FLOOR_P 1e4 /* Pa: pressure changes below it are not resolved more finely */
#define FLOOR_T 1.0 /* K: likewise */

PetscErrorCode StepperStart(Stepper *s)
{
  ModelTotals t;

  PetscFunctionBeginUser;
  PetscCall(ModelComputeTotals(s->model, &t));
  s->state.water0    = t.water;
  s->state.methane0  = t.methane;
  s->state.capacity0 = t.capacity;
  s->state.enthalpy0 = t.enthalpy;
  s->state.hydrate0  = t.hydrate;
  PetscCall(StepperEnergyStart(s));
  PetscCall(StepperExtremes(s, true));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperCreate(Model *m, Stepper *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(s, sizeof(*s)));
  s->model = m;
  PetscCall(StepperTakeStage(s, 0));
  s->max_steps     = PETSC_MAX_INT;
  s->state.dt      = CaseOf(m->c)->dt;
  s->state.err_old = 1.0;
  s->state.fresh   = 1;
  s->state.scale_p = FLOOR_P;
  s->state.scale_T = FLOOR_T;
  s->state.scale_u = StepperFloorU(s);
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-stepper_max_steps", &s->max_steps, NULL));
  PetscCall(StepperStart(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Look(Stepper *s)
{
  PetscFunctionBeginUser;
  PetscCall(StepperForecast(s));
  PetscCall(StepperPrintForecast(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Forecasts of the stages to come, from the state as it is. */
static PetscErrorCode LookAhead(Stepper *s, bool *ok)
{
  const PetscInt now      = s->state.stage;
  const Forecast forecast = s->forecast;

  PetscFunctionBeginUser;
  for (PetscInt k = now + 1; k < StepperCase(s)->nstage && *ok; k++) {
    PetscCall(StepperTakeStage(s, k));
    PetscCall(Look(s));
    s->limit = s->forecast.limit;
    if (s->scheme->check)
      PetscCall(s->scheme->check(s, ok));
  }
  PetscCall(StepperTakeStage(s, now));
  s->forecast = forecast;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The scheme of this stage, with its storage. */
static PetscErrorCode Prepare(Stepper *s, bool *ok)
{
  PetscFunctionBeginUser;
  PetscCall(StepperAutoBegin(s));
  if (s->scheme->create)
    PetscCall(s->scheme->create(s));
  if (s->scheme->ready)
    PetscCall(s->scheme->ready(s, ok));
  if (s->scheme->tableau || s->auto_.on)
    PetscCall(ModelPrintSolver(s->model));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperReady(Stepper *s, bool *ok)
{
  PetscFunctionBeginUser;
  *ok = true;
  PetscCall(StepperTakeStage(s, s->state.stage));
  if (!s->adaptive && s->state.hold == 0)
    s->state.dt = StepperCase(s)->dt; /* a fixed step is the case's, also after a restart, but on its way back to it */
  if (StepperStageDone(s) && !StepperDone(s))
    PetscCall(StepperNextStage(s));
  PetscCall(Look(s));
  PetscCall(LookAhead(s, ok));
  if (*ok)
    PetscCall(Prepare(s, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperDestroy(Stepper *s)
{
  PetscFunctionBeginUser;
  PetscCall(StepperFreeWork(&s->work));
  if (s->scheme->destroy)
    PetscCall(s->scheme->destroy(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Leaves the stage that is done for the next one. */
static PetscErrorCode Change(Stepper *s, bool *ok)
{
  PetscFunctionBeginUser;
  if (s->scheme->destroy)
    PetscCall(s->scheme->destroy(s));
  PetscCall(StepperNextStage(s));
  PetscCall(Look(s));
  PetscCall(Prepare(s, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperRun(Stepper *s, bool *ok)
{
  PetscFunctionBeginUser;
  const PetscInt first = s->state.step;

  *ok = true;
  while (*ok && !s->stop && !s->broken && s->state.step - first < s->max_steps && !StepperDone(s)) {
    if (StepperStageDone(s))
      PetscCall(Change(s, ok));
    if (*ok) {
      PetscCall(ModelBalance(s->model));
      PetscCall(s->scheme->tableau ? StepperImplicitStep(s, ok) : s->scheme->advance(s, ok));
    }
    if (*ok && !StepperStageDone(s))
      PetscCall(StepperAutoDecide(s, ok));
  }
  *ok = *ok && !s->broken;
  PetscFunctionReturn(PETSC_SUCCESS);
}
