/* What each stage of a run took: for the progress and the summary. */
#include "run_private.h"

typedef struct {
  const char *integrator;
  double      from, to;           /* s of the scene, in this process */
  double      clock, spent;       /* s of the wall: when it began, so far */
  double      scaling;            /* error of mass scaling so far */
  double      least, most;        /* stable step, s */
  double      ruled[LIMIT_COUNT]; /* s of the scene, by what bounded the step */
  PetscInt    steps, refused, newton;
} Entry;

struct StageLog {
  PetscInt n, now, step; /* stages, the present one, steps at the last look */
  Entry   *entry;
};

static void Begin(StageLog *log, PetscInt k, double t)
{
  log->now      = k;
  log->entry[k] = (Entry){.from = t, .to = t, .clock = Wall()};
}

PetscErrorCode StageLogCreate(const Stepper *s, StageLog **log)
{
  PetscFunctionBeginUser;
  PetscCall(PetscNew(log));
  (*log)->n    = PetscMax(s->model->c->nstage, 1);
  (*log)->step = s->state.step;
  PetscCall(PetscCalloc1((*log)->n, &(*log)->entry));
  Begin(*log, s->state.stage, s->state.t);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageLogDestroy(StageLog **log)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree((*log)->entry));
  PetscCall(PetscFree(*log));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Stable step of the step just taken, and for how long which limit set it. */
static void NoteLimit(Entry *e, const Stepper *s)
{
  const StableStep *limit = &s->limit;

  e->least = e->most > 0.0 ? fmin(e->least, limit->dt) : limit->dt;
  e->most  = fmax(e->most, limit->dt);
  e->ruled[limit->rules] += s->state.t - e->to;
}

void StageLogStep(StageLog *log, const Stepper *s, const StepInfo *info)
{
  if (s->state.stage != log->now)
    Begin(log, s->state.stage, s->model->c->t_begin);

  Entry *e = &log->entry[log->now];
  if (s->explicit)
    NoteLimit(e, s);
  e->integrator = s->scheme->name;
  e->to         = s->state.t;
  e->spent      = Wall() - e->clock;
  e->scaling    = s->explicit ? ExplicitMassScalingError(s->explicit) : 0.0;
  e->steps += s->state.step - log->step;
  e->refused += info->cuts;
  e->newton += info->newton;
  log->step = s->state.step;
}

void StageLogProgress(const StageLog *log, const Stepper *s, double *done, double *left)
{
  const Entry *e = &log->entry[log->now];

  *done = (e->to - e->from) / (s->model->c->t_end - e->from);
  *left = *done > 0.0 ? e->spent * (1.0 - *done) / *done : 0.0;
}

/* ", stable step 0.004 s to 0.006 s (waves in the mixture 100 %)" where there is one. */
static PetscErrorCode LimitWords(const Entry *e, char words[200])
{
  PetscFunctionBeginUser;
  words[0] = '\0';
  if (!(e->most > 0.0))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscSNPrintf(words, 200, ", stable step %.3g s to %.3g s", e->least, e->most));
  for (int k = 0; k < LIMIT_COUNT; k++) {
    const size_t n = strlen(words);

    if (e->ruled[k] > 0.0)
      PetscCall(PetscSNPrintf(words + n, 200 - n, "%s%s %.3g %%", strchr(words, '(') ? ", " : " (", cl_limit_word[k],
                              100.0 * e->ruled[k] / (e->to - e->from)));
  }
  PetscCall(PetscStrlcat(words, ")", 200));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StageLogSummary(const StageLog *log, const Stepper *s, char **text)
{
  const Case  *c    = s->model->c;
  const size_t line = 520;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(line * (size_t)log->n, text));
  for (PetscInt k = 0; k < c->nstage; k++) {
    const Entry *e  = &log->entry[k];
    char        *at = *text + strlen(*text), scaled[80] = "", limit[200];

    if (e->steps == 0)
      continue;
    if (c->stage[k].c.mass_scaling > 1.0 && e->scaling > 0.0)
      PetscCall(PetscSNPrintf(scaled, sizeof(scaled), ", mass scaling added up to %.2g of the forces", e->scaling));
    PetscCall(LimitWords(e, limit));
    PetscCall(PetscSNPrintf(at, line,
                            "  stage %s: %s from %g s to %g s, %" PetscInt_FMT " steps, %" PetscInt_FMT
                            " refused, %" PetscInt_FMT " Newton iterations, %.2f s%s%s\n",
                            c->stage[k].name, e->integrator, e->from, e->to, e->steps, e->refused, e->newton, e->spent,
                            limit, scaled));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
