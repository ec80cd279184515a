/* start: a run that begins with the state which another one ended in. */
#include "run_private.h"
#include "clathra/words.h"
#include <limits.h>
#include <stdlib.h>
#include <string.h>

/* Would this run write over the file?  Rank 0. */
static bool InFolder(const char *file, const char *folder)
{
  char full[PATH_MAX], dir[PATH_MAX], *slash;

  if (!realpath(file, full) || !realpath(folder, dir))
    return false;
  slash = strrchr(full, '/');
  if (slash)
    *slash = '\0';
  return !strcmp(full, dir);
}

PetscErrorCode StartFromState(Stepper *s, const char *path, bool *ok)
{
  const MPI_Comm comm   = s->model->grid.comm;
  int            inside = 0;
  Origin         origin;

  PetscFunctionBeginUser;
  if (s->model->grid.rank == 0)
    inside = InFolder(path, StepperCase(s)->output_dir);
  PetscCallMPI(MPI_Bcast(&inside, 1, MPI_INT, 0, comm));
  *ok = !inside;
  if (inside)
    PetscCall(PetscFPrintf(comm, stderr,
                           "clathra: -restart_as_initial %s lies in the output folder, and this run would write over "
                           "it; give another -output_dir\n",
                           path));
  if (*ok)
    PetscCall(CheckpointReadInitial(s->model, path, &origin, ok));
  if (!*ok)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StepperStart(s));
  s->state.unseen       = origin.unseen.time;
  s->state.unseen_steps = origin.unseen.steps;
  PetscCall(PetscPrintf(comm, "  starts from the state of %s, t = %s there\n", path, TimeAt(origin.t).s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
