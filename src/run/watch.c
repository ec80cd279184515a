/* What a run does by the clock on the wall: lines of progress, checkpoints, and an end before its time is over. */
#include "run_private.h"
#include <time.h>

#define OFTEN 300.0 /* s between checkpoints, unless -checkpoint_wall says otherwise */
#define LINE 1.0    /* s between lines of progress, unless -progress does */

double Wall(void)
{
  struct timespec t;

  clock_gettime(CLOCK_MONOTONIC, &t);
  return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

PetscErrorCode WatchStart(Watch *w)
{
  const double now = Wall();

  PetscFunctionBeginUser;
  *w = (Watch){
      .limit = INFINITY, .often = OFTEN, .line = LINE, .begun = now, .saved = now, .before = now, .said = -INFINITY};
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-time_limit", &w->limit, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-checkpoint_wall", &w->often, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-progress", &w->line, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode WatchStep(MPI_Comm comm, Watch *w, bool *save, bool *end)
{
  double now = Wall();

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&now, 1, MPI_DOUBLE, 0, comm)); /* ranks agree */
  w->longest = fmax(w->longest, now - w->before);
  w->before  = now;
  *save      = w->often > 0.0 && now - w->saved >= w->often;
  *end       = now - w->begun + 2.0 * w->longest >= w->limit;
  w->over    = *end;
  PetscFunctionReturn(PETSC_SUCCESS);
}

void WatchSaved(Watch *w)
{
  w->saved = w->before;
}

bool WatchLine(Watch *w, bool last)
{
  if (!last && w->before - w->said < w->line)
    return false;
  w->said = w->before;
  return true;
}
