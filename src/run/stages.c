/* What each stage of a run took, and in it each integrator that auto chose: for the progress and the summary. */
#include "run_private.h"
#include "clathra/words.h"

#define WORDS 640    /* characters of what bounded the steps, at most */
#define UNKNOWN 0.05 /* of the stage, before which no time left is named */

typedef struct {
  const char *integrator;
  PetscInt    stage;
  double      from, to;           /* s of the scene, in this process */
  double      clock, spent;       /* s of the wall: when it began, so far */
  double      scaling;            /* error of mass scaling so far */
  double      least, most;        /* stable step, or implicit ones, s */
  double      ruled[LIMIT_COUNT]; /* s of the scene, by what bounded the step */
  PetscInt    held[BOUNDS];       /* implicit steps, by what bounded them */
  PetscInt    steps, refused, newton;
  bool        implicit;
} Entry;

struct StageLog {
  PetscInt n, cap, step; /* entries, allocated, steps at the last look */
  double   from, clock;  /* when the stage began: s of the scene in this process, of the wall */
  PetscInt taken;        /* steps since then */
  Entry   *entry;
  Learnt   learnt; /* since then, or since the integrator changed */
  double   kink;   /* the next one, s */
  bool     many;   /* too many of them to begin anew at each */
};

static PetscErrorCode Append(StageLog *log, const Stepper *s, double from)
{
  PetscFunctionBeginUser;
  if (log->n == log->cap) {
    log->cap = 2 * log->cap + 8;
    PetscCall(PetscRealloc(sizeof(Entry) * (size_t)log->cap, &log->entry));
  }
  if (log->n == 0 || log->entry[log->n - 1].stage != s->state.stage) {
    Ahead ahead;

    StepperAhead(s, &ahead);
    log->from   = from;
    log->clock  = Wall();
    log->kink   = BcNextKink(s->model->c, from);
    log->many   = ahead.more;
    log->taken  = 0;
    log->learnt = (Learnt){.trace.origin = from};
  } else { /* its steps are others */
    log->learnt =
        (Learnt){.trace = {.origin = from, .before = log->taken}, .all = log->taken, .spent = Wall() - log->clock};
  }
  log->entry[log->n++] =
      (Entry){.integrator = StepperName(s), .stage = s->state.stage, .from = from, .to = from, .clock = Wall()};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageLogCreate(const Stepper *s, StageLog **log)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(log));
  (*log)->step = s->state.step;
  PetscCall(Append(*log, s, s->state.t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageLogDestroy(StageLog **log)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree((*log)->entry));
  PetscCall(PetscFree(*log));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void NoteRange(Entry *e, double dt)
{
  e->least = e->most > 0.0 ? fmin(e->least, dt) : dt;
  e->most  = fmax(e->most, dt);
}

/* Stable step of the step just taken, and for how long which limit set it. */
static void NoteLimit(Entry *e, const Stepper *s)
{
  NoteRange(e, s->limit.dt);
  e->ruled[s->limit.rules] += s->state.t - e->to;
}

/* Length of the implicit step just taken, and what bounded it. */
static void NoteBound(Entry *e, const StepInfo *info)
{
  e->implicit = true;
  e->held[info->bound]++;
  NoteRange(e, info->dt);
}

PetscErrorCode StageLogStep(StageLog *log, const Stepper *s, const StepInfo *info)
{
  Entry *e = &log->entry[log->n - 1];

  PetscFunctionBeginUser;
  if (s->state.stage != e->stage || StepperName(s) != e->integrator)
    PetscCall(Append(log, s, s->state.stage != e->stage ? s->model->c->t_begin : e->to));
  e = &log->entry[log->n - 1];
  if (s->explicit)
    NoteLimit(e, s);
  else
    NoteBound(e, info);
  e->to      = s->state.t;
  e->spent   = Wall() - e->clock;
  e->scaling = s->explicit ? ExplicitMassScalingError(s->explicit) : 0.0;
  e->steps += s->state.step - log->step;
  e->refused += info->cuts;
  e->newton += info->newton;
  log->taken += s->state.step - log->step;
  log->step = s->state.step;
  LearntAdd(&log->learnt, s->state.t, log->taken, Wall() - log->clock);
  if (s->state.t >= log->kink) {
    log->kink = BcNextKink(s->model->c, s->state.t);
    if (!log->many)
      LearntBegin(&log->learnt, s->state.t, s->state.t - s->model->c->t_begin);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The rest of the stage. */
static void Look(const StageLog *log, const Stepper *s, Ahead *ahead)
{
  StepperAhead(s, ahead);
  ahead->from = log->from;
  ahead->even = ahead->even || log->many;
  if (s->auto_.on) /* of one integrator alone */
    ahead->forecast = 0.0;
}

/* Has the stage taken as many steps, or as long, as was forecast for all of it? */
static bool PastForecast(const StageLog *log, const Stepper *s)
{
  const Forecast *f = &s->forecast;

  return !s->explicit && s->adaptive && (log->taken >= f->implicit_steps || log->learnt.spent >= f->implicit_seconds);
}

void StageLogProgress(const StageLog *log, const Stepper *s, Left *left)
{
  Ahead        ahead;
  const double done = (s->state.t - log->from) / (StepperCase(s)->t_end - log->from);

  *left = (Left){.steps = NAN, .time = NAN, .flat = NAN};
  if (CaseAtEnd(StepperCase(s), s->state.t))
    left->steps = left->time = left->flat = 0.0;
  else if (done >= UNKNOWN || PastForecast(log, s)) {
    Look(log, s, &ahead);
    left->steps = LearntSteps(&log->learnt, &ahead);
    left->time  = LearntLeft(&log->learnt, &ahead);
    left->flat  = LearntFlat(&log->learnt, &ahead);
  }
}

void StageLogPace(const StageLog *log, const Stepper *s, Pace *pace)
{
  Ahead ahead;

  Look(log, s, &ahead);
  *pace = (Pace){.taken = log->taken,
                 .done  = (s->state.t - log->from) / (StepperCase(s)->t_end - log->from),
                 .left  = LearntPace(&log->learnt, &ahead),
                 .step  = log->learnt.step,
                 .spent = log->learnt.spent,
                 .flat  = LearntFlat(&log->learnt, &ahead)};
}

/* " (WHAT 12 %" or ", WHAT 12 %" behind what is there. */
static void AddShare(const char *what, double share, char words[WORDS])
{
  const size_t n = strlen(words);

  if (share > 0.0)
    snprintf(words + n, WORDS - n, "%s%s %.3g %%", strchr(words, '(') ? ", " : " (", what, 100.0 * share);
}

/* ", stable step 0.004 s to 0.006 s (waves in the mixture 100 %)", of the time; ", steps of 0.01 s to 0.1 s (error of T
   80 %, times to be hit 20 %)", of the steps. */
static PetscErrorCode LimitWords(const Entry *e, char words[WORDS])
{
  char what[48];

  PetscFunctionBeginUser;
  words[0] = '\0';
  if (!(e->most > 0.0))
    PetscFunctionReturn(PETSC_SUCCESS);
  if (e->implicit)
    snprintf(words, WORDS, ", steps of %s to %s", TimeWords(e->least, 3).s, TimeWords(e->most, 3).s);
  else
    snprintf(words, WORDS, ", stable step %.3g s to %.3g s", e->least, e->most);
  for (int k = 0; k < LIMIT_COUNT; k++)
    AddShare(cl_limit_word[k], e->ruled[k] / (e->to - e->from), words);
  for (int k = 0; k < BOUNDS; k++) {
    StepperBoundWords(k, what);
    AddShare(what, (double)e->held[k] / (double)e->steps, words);
  }
  if (strchr(words, '('))
    PetscCall(PetscStrlcat(words, ")", WORDS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageLogSummary(const StageLog *log, const Stepper *s, char **text)
{
  const Case  *c    = StepperCase(s);
  const size_t line = 960;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(line * (size_t)log->n, text));
  for (PetscInt k = 0; k < log->n; k++) {
    const Entry *e  = &log->entry[k];
    char        *at = *text + strlen(*text), scaled[80] = "", stage[80] = "", limit[WORDS];

    if (e->steps == 0)
      continue;
    PetscCall(LimitWords(e, limit));
    if (c->nstage == 0 && log->n == 1) { /* the rest is the run's */
      if (limit[0])
        snprintf(at, line, "\n  %s", &limit[2]); /* without its comma */
      continue;
    }
    if (CaseInStage(c, e->stage)->mass_scaling > 1.0 && e->scaling > 0.0)
      snprintf(scaled, sizeof(scaled), ", mass scaling added up to %.2g of the forces", e->scaling);
    if (c->nstage)
      snprintf(stage, sizeof(stage), "stage %s: ", c->stage[e->stage].name);
    snprintf(at, line,
             "\n  %s%s from %g s to %g s (%s), %" PetscInt_FMT " steps, %" PetscInt_FMT " refused, %" PetscInt_FMT
             " Newton iterations, %.2f s%s%s",
             stage, e->integrator, e->from, e->to, TimeWords(e->to - e->from, 3).s, e->steps, e->refused, e->newton,
             e->spent, limit, scaled);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
