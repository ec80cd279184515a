/* Goes through the table of findings. */
#include "findings_private.h"

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
