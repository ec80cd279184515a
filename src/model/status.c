/* Why a step cannot go on: the first reason of a rank, the worst of all. */
#include "gather.h"

void ModelNoteFailure(Model *m, ClStatus status, const char *why, PetscInt p)
{
  if (m->failure.status != CL_OK)
    return;
  m->failure.status = status;
  ModelExplain(m, why);
  for (int d = 0; d < CL_DIM; d++)
    m->failure.where[d] = m->P.f[P_X + d][p];
}

const Failure *ModelFailure(const Model *m)
{
  return &m->failure;
}

void ModelClearFailure(Model *m)
{
  m->failure.status = CL_OK;
}

void ModelExplain(Model *m, const char *why)
{
  snprintf(m->failure.why, sizeof(m->failure.why), "%s", why);
}

PetscErrorCode ModelReduceStatus(Model *m, ClStatus *status)
{
  Failure *f = &m->failure;
  struct {
    int status, rank;
  } local = {(int)f->status, m->grid.rank}, worst;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&local, &worst, 1, MPI_2INT, MPI_MAXLOC, m->grid.comm));
  *status = (ClStatus)worst.status;
  if (worst.status != CL_OK && m->grid.size > 1) {
    PetscCallMPI(MPI_Bcast(f->why, sizeof(f->why), MPI_CHAR, worst.rank, m->grid.comm));
    PetscCallMPI(MPI_Bcast(f->where, CL_DIM, MPI_DOUBLE, worst.rank, m->grid.comm));
  }
  f->status = *status;
  PetscFunctionReturn(PETSC_SUCCESS);
}
