/* A note while a run is on its way that takes far more steps, or longer, than was forecast: neither ends soon nor gives
   up. */
#include "findings_private.h"
#include "clathra/words.h"

#define FAR 10.0     /* times the forecast are left, by the run's own pace, ... */
#define PATIENCE 2.0 /* ... after so many times the forecast */
#define SOON 10.0    /* s of the wall that are not long, spent or left */

static void Begin(Slow *slow, const Stepper *s)
{
  *slow = (Slow){.next  = PATIENCE * s->forecast.implicit_steps,
                 .clock = fmax(PATIENCE * s->forecast.implicit_seconds, SOON),
                 .stage = s->state.stage,
                 .begun = true};
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
static bool Due(const Slow *slow, const Pace *pace)
{
  const bool many = pace->taken >= slow->next, late = pace->spent >= slow->clock;

  return slow->said ? many && late : many || late;
}

bool FindingsIsSlow(const Slow *slow, const Forecast *f, const Pace *pace)
{
  return Due(slow, pace) && pace->left * pace->step > SOON &&
         (pace->left > FAR * f->implicit_steps ||
          (pace->spent >= slow->clock && pace->left * pace->step > FAR * f->implicit_seconds));
}

static PetscErrorCode Say(const Findings *f, FindingId id)
{
  const Stepper *s    = f->s;
  const Pace    *pace = &f->pace;
  const double   dt = f->info->dt, t = s->state.t - s->model->c->t_begin, left = StepperCase(s)->t_end - s->state.t;
  char           rules[128], flat[64] = "", what[768];

  PetscFunctionBeginUser;
  Rules(s, f->info, rules);
  if (!isnan(pace->flat))
    snprintf(flat, sizeof(flat), ", %s as the last %d went", TimeWords(pace->flat, 2).s, LEARNT_LATE);
  StepperAdviceSlow(s, s->state.hold > 0, what);
  PetscCall(FindingSayOf(
      f->comm, id, NULL, what,
      "slow: %" PetscInt_FMT " steps (%" PetscInt_FMT
      " refused), %s, have come to %s, %.3g %%; the forecast was %s, %s, for all, and by their growth so far %s are "
      "left, %s; with the present dt of %s it would be %s%s.  dt is %s",
      pace->taken, f->slow.refused, TimeWords(pace->spent, 2).s, TimeWords(t, 3).s, 100.0 * pace->done,
      CountWords(s->forecast.implicit_steps).s, TimeWords(s->forecast.implicit_seconds, 2).s, CountWords(pace->left).s,
      TimeWords(pace->left * pace->step, 2).s, TimeWords(dt, 2).s, CountWords(left / dt).s, flat, rules));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsFindSlow(Findings *f, FindingId id)
{
  const Stepper *s    = f->s;
  Slow          *slow = &f->slow;

  PetscFunctionBeginUser;
  if (!slow->begun || slow->stage != s->state.stage)
    Begin(slow, s);
  slow->refused += f->info->cuts;
  if (s->explicit || !s->adaptive || CaseAtEnd(StepperCase(s), s->state.t) ||
      !FindingsIsSlow(slow, &s->forecast, &f->pace))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Say(f, id));
  slow->next  = 2.0 * f->pace.taken;
  slow->clock = 2.0 * f->pace.spent;
  slow->said  = true;
  PetscFunctionReturn(PETSC_SUCCESS);
}
