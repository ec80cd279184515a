/* A note while a run is on its way that takes far more steps than was forecast: neither ends soon nor gives up. */
#include "run_private.h"

#define FAR 10.0     /* times the forecast are left, by the run's own pace, ... */
#define PATIENCE 2.0 /* ... after so many times the forecast */

void SlowBegin(Slow *slow, const Stepper *s)
{
  *slow = (Slow){.next = PATIENCE * s->forecast.implicit_steps, .stage = s->state.stage};
}

/* What shortens the steps: the last one's field and place, or Newton's method. */
static PetscErrorCode Rules(const Stepper *s, const StepInfo *info, char text[128])
{
  PetscFunctionBeginUser;
  if (s->state.hold > 0)
    PetscCall(PetscSNPrintf(text, 128, "ruled by Newton's method, which refused a step shortly before"));
  else
    PetscCall(PetscSNPrintf(text, 128, "ruled by the error of %s, largest near (%.4g, %.4g) m",
                            stepper_error_word[info->rules], info->peak.at[0], info->peak.at[1]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SlowLook(Slow *slow, const Stepper *s, const StepInfo *info, const StageLog *log)
{
  const double   forecast = s->forecast.implicit_steps;
  const PetscInt taken    = StageLogTaken(log);
  char           rules[128], now[32], time[32], rest[32], all[16], grown[16], flat[16];
  Pace           pace;

  PetscFunctionBeginUser;
  if (slow->stage != s->state.stage)
    SlowBegin(slow, s);
  slow->refused += info->cuts;
  if (s->explicit || !s->adaptive || taken < slow->next || CaseAtEnd(StepperCase(s), s->state.t))
    PetscFunctionReturn(PETSC_SUCCESS);
  StageLogPace(log, s, &pace);
  if (!(pace.left > FAR * forecast))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Rules(s, info, rules));
  StepperTime(s->state.t - s->model->c->t_begin, s->state.t - s->model->c->t_begin, 3, now);
  StepperTime(info->dt, info->dt, 2, time);
  StepperTime(pace.left * pace.step, pace.left * pace.step, 2, rest);
  StepperCount2(forecast, all);
  StepperCount2(pace.left, grown);
  StepperCount2((StepperCase(s)->t_end - s->state.t) / info->dt, flat);
  PetscCall(
      PetscFPrintf(s->model->grid.comm, stderr,
                   "clathra: note: slow: %" PetscInt_FMT " steps (%" PetscInt_FMT
                   " refused) have come to %s, %.3g %%; the forecast was %s for all, and by their growth so far %s are "
                   "left, %s; with the present dt of %s it would be %s.  dt is %s\n",
                   taken, slow->refused, now, 100.0 * pace.done, all, grown, rest, time, flat, rules));
  PetscCall(StepperAdviseSlow(s, s->state.hold > 0));
  slow->next = 2.0 * taken;
  PetscFunctionReturn(PETSC_SUCCESS);
}
