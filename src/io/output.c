/* The files of a run: created, or cut back to the time of a restart and continued. */
#include "io_private.h"

#include <unistd.h>

/* What a run before left and this one will not write, or not yet. */
static void RemoveStale(const Output *out, const Model *m)
{
  static const char *const name[] = {"summary.txt", "report.html", "fields.xdmf", "meters.csv"};
  const int                n      = MetersWanted(m) ? 3 : 4;
  char                     path[IO_PATH + 16];

  for (int k = 0; k < n; k++) {
    snprintf(path, sizeof(path), "%s/%s", out->dir, name[k]);
    (void)unlink(path);
  }
}

static PetscErrorCode OpenFiles(Output *out, const Model *m, const StepperState *s, OutputFrom from)
{
  PetscFunctionBeginUser;
  out->failed = !IoMakeFolder(out->dir);
  if (from == OUTPUT_ANEW)
    RemoveStale(out, m);
  PetscCall(TablesOpen(out, m, from, s->t));
  PetscCall(SeriesStart(out, from, s->next_snapshot));
  PetscCall(SeriesWrite(out, &m->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputCreate(const Model *m, const StepperState *s, OutputFrom from, Output **result)
{
  const Case    *c    = CaseOf(m->c);
  PetscErrorCode ierr = PETSC_SUCCESS;
  Output        *out;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&out));
  out->fields = m->c->fields;
  for (int k = 0; k < TABLE_COUNT; k++)
    out->fd[k] = -1;
  PetscCall(PetscStrncpy(out->dir, c->output_dir, sizeof(out->dir)));
  PetscCall(PetscMalloc1(c->nprobe, &out->reach));
  for (PetscInt k = 0; k < c->nprobe; k++)
    out->reach[k] = 1.0;
  if (m->grid.rank == 0)
    ierr = OpenFiles(out, m, s, from);
  PetscCall(IoAgree(m->grid.comm, ierr));
  *result = out;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputGood(const Output *out, MPI_Comm comm, bool *ok)
{
  int failed = out->failed;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Bcast(&failed, 1, MPI_INT, 0, comm));
  *ok = !failed;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputSync(Output *out, MPI_Comm comm, bool *ok)
{
  PetscFunctionBeginUser;
  TablesSync(out);
  PetscCall(OutputGood(out, comm, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode OutputDestroy(Output **result, MPI_Comm comm, bool *ok)
{
  Output *out = *result;

  PetscFunctionBeginUser;
  *ok = true;
  if (!out)
    PetscFunctionReturn(PETSC_SUCCESS);
  TablesClose(out);
  PetscCall(OutputGood(out, comm, ok));
  PetscCall(PetscFree(out->reach));
  PetscCall(PetscFree(out->snapshot));
  PetscCall(PetscFree(*result));
  PetscFunctionReturn(PETSC_SUCCESS);
}
