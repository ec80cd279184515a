/* The times at which a run writes.  Steps end exactly on them, so t is one of them or is not. */
#include "run_private.h"
#include "clathra/words.h"

double NextMultiple(const Case *c, double every, double t)
{
  const double at = t - c->scene.t_begin + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);

  return every > 0.0 ? c->scene.t_begin + every * (floor(at / every * (1.0 + 1e-12) + 1e-9) + 1.0) : INFINITY;
}

/* A time between two outputs that is longer than the run, or the stage, means none between its start and its end. */
static PetscErrorCode EveryNote(MPI_Comm comm, const Case *c, const char *stage, const char *key, double every)
{
  const double length = c->t_end - c->scene.t_begin;

  PetscFunctionBeginUser;
  if (!(every > length * (1.0 + 1e-9)))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscFPrintf(
      comm, stderr, "clathra: note: %s%s%s (%s) is longer than the %s (%s): it asks for nothing before its end\n",
      stage, stage[0] ? ": " : "", key, TimeWords(every, 4).s, stage[0] ? "stage" : "run", TimeWords(length, 4).s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode EveryNotes(MPI_Comm comm, const Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PetscMax(c->nstage, 1); k++) {
    const Case *in    = CaseInStage(c, k);
    const char *stage = c->nstage ? c->stage[k].name : "";

    if (c->nstage && in->every == c->every && c->every <= c->t_end) /* the case's, for stages longer than this one */
      continue;
    PetscCall(EveryNote(comm, in, stage, "output_every", in->every));
  }
  PetscCall(EveryNote(comm, c, "", "output_probe_every", c->probe_every));
  PetscFunctionReturn(PETSC_SUCCESS);
}

double NextSnapshot(const Case *c, double t)
{
  double next = NextMultiple(c, c->every, t);

  for (PetscInt k = 0; k < c->ntimes; k++) {
    if (c->times[k] > t + SceneTimeSlack(&c->scene, t))
      next = fmin(next, c->times[k]);
  }
  return next;
}

static bool IsTime(const Case *c, double event, double t)
{
  return fabs(event - t) <= 1e-9 * fabs(t - c->scene.t_begin) + SceneTimeSlack(&c->scene, t);
}

bool AtMultiple(const Case *c, double every, double t)
{
  return every > 0.0 && IsTime(c, c->scene.t_begin + every * round((t - c->scene.t_begin) / every), t);
}

bool AtSnapshot(const Case *c, double t)
{
  bool at = AtMultiple(c, c->every, t);

  for (PetscInt k = 0; k < c->ntimes; k++)
    at = at || IsTime(c, c->times[k], t);
  return at;
}
