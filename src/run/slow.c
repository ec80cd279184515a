/* A note while a run is on its way that takes far more steps, or longer, than was forecast: neither ends soon nor gives
   up. */
#include "run_private.h"
#include "clathra/words.h"

#define FAR 10.0     /* times the forecast are left, by the run's own pace, ... */
#define PATIENCE 2.0 /* ... after so many times the forecast */
#define SOON 10.0    /* s of the wall that are not long, spent or left */

void SlowBegin(Slow *slow, const Stepper *s)
{
  *slow = (Slow){.next  = PATIENCE * s->forecast.implicit_steps,
                 .clock = fmax(PATIENCE * s->forecast.implicit_seconds, SOON),
                 .stage = s->state.stage};
}

/* What shortens the steps: the last one's field and place, or Newton's method. */
static void Rules(const Stepper *s, const StepInfo *info, char text[128])
{
  if (s->state.hold > 0)
    snprintf(text, 128, "ruled by Newton's method, which refused a step shortly before");
  else
    snprintf(text, 128, "ruled by the error of %s, largest near %s", stepper_error_word[info->rules],
             PlaceWords(info->peak.at).s);
}

/* Is it time for a word?  The first one after so many steps or so long, the next after both. */
static bool Due(const Slow *slow, PetscInt taken, double spent)
{
  const bool many = taken >= slow->next, late = spent >= slow->clock;

  return slow->said ? many && late : many || late;
}

bool SlowIs(const Slow *slow, const Forecast *f, PetscInt taken, const Pace *pace)
{
  return Due(slow, taken, pace->spent) && pace->left * pace->step > SOON &&
         (pace->left > FAR * f->implicit_steps ||
          (pace->spent >= slow->clock && pace->left * pace->step > FAR * f->implicit_seconds));
}

static PetscErrorCode Say(const Slow *slow, const Stepper *s, const StepInfo *info, PetscInt taken, const Pace *pace)
{
  const double t = s->state.t - s->model->c->t_begin, left = StepperCase(s)->t_end - s->state.t;
  char         rules[128];

  PetscFunctionBeginUser;
  Rules(s, info, rules);
  PetscCall(PetscFPrintf(s->model->grid.comm, stderr,
                         "clathra: note: slow: %" PetscInt_FMT " steps (%" PetscInt_FMT
                         " refused), %s, have come to %s, %.3g %%; the forecast was %s, %s, for all, and by their "
                         "growth so far %s are left, %s; with the present dt of %s it would be %s",
                         taken, slow->refused, TimeWords(pace->spent, 2).s, TimeWords(t, 3).s, 100.0 * pace->done,
                         CountWords(s->forecast.implicit_steps).s, TimeWords(s->forecast.implicit_seconds, 2).s,
                         CountWords(pace->left).s, TimeWords(pace->left * pace->step, 2).s, TimeWords(info->dt, 2).s,
                         CountWords(left / info->dt).s));
  if (!isnan(pace->flat))
    PetscCall(
        PetscFPrintf(s->model->grid.comm, stderr, ", %s as the last %d went", TimeWords(pace->flat, 2).s, LEARNT_LATE));
  PetscCall(PetscFPrintf(s->model->grid.comm, stderr, ".  dt is %s\n", rules));
  PetscCall(StepperAdviseSlow(s, s->state.hold > 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlowLook(Slow *slow, const Stepper *s, const StepInfo *info, const StageLog *log)
{
  const PetscInt taken = StageLogTaken(log);
  Pace           pace;

  PetscFunctionBeginUser;
  if (slow->stage != s->state.stage)
    SlowBegin(slow, s);
  slow->refused += info->cuts;
  if (s->explicit || !s->adaptive || !Due(slow, taken, StageLogSpent(log)) || CaseAtEnd(StepperCase(s), s->state.t))
    PetscFunctionReturn(PETSC_SUCCESS);
  StageLogPace(log, s, &pace);
  if (!SlowIs(slow, &s->forecast, taken, &pace))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Say(slow, s, info, taken, &pace));
  slow->next  = 2.0 * taken;
  slow->clock = 2.0 * pace.spent;
  slow->said  = true;
  PetscFunctionReturn(PETSC_SUCCESS);
}
