/* Goes through the table of findings. */
#include "findings_private.h"
#include <string.h>

/* It is said at sight. */
PetscErrorCode FindingsFindNone(Findings *f, FindingId id)
{
  (void)f, (void)id;
  return PETSC_SUCCESS;
}

static const struct {
  FindingWhen   when;
  FindingsFind *find;
} row[] = {
#define ROW(id, when, kind, find, what_to_try) [FINDING_##id] = {FINDING_AT_##when, find},
    CL_FINDINGS(ROW)};

PetscErrorCode FindingsAt(Findings *f, FindingWhen when)
{
  PetscFunctionBeginUser;
  for (FindingId id = 0; id < FINDING_COUNT; id++) {
    if (row[id].when == when)
      PetscCall(row[id].find(f, id));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsShareLargest(MPI_Comm comm, void *largest, size_t bytes)
{
  struct {
    double value;
    int    rank;
  } best;

  PetscFunctionBeginUser;
  memcpy(&best.value, largest, sizeof(best.value));
  PetscCallMPI(MPI_Comm_rank(comm, &best.rank));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &best, 1, MPI_DOUBLE_INT, MPI_MAXLOC, comm));
  PetscCallMPI(MPI_Bcast(largest, (PetscMPIInt)bytes, MPI_BYTE, best.rank, comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
