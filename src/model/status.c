/* Why a step cannot go on: the first reason of a rank, the worst of all. */
#include "gather.h"

void ModelNoteFailure(Model *m, ClStatus status, const char *why, PetscInt p)
{
  if (m->status != CL_OK)
    return;
  m->status   = status;
  m->why      = why;
  m->where[0] = m->P.f[P_X][p];
  m->where[1] = m->P.f[P_X + 1][p];
}

PetscErrorCode ModelReduceStatus(Model *m, ClStatus *status)
{
  struct {
    int status, rank;
  } local = {(int)m->status, m->grid.rank}, worst;

  PetscFunctionBeginUser;
  PetscCallMPI(MPI_Allreduce(&local, &worst, 1, MPI_2INT, MPI_MAXLOC, m->grid.comm));
  *status = (ClStatus)worst.status;
  if (worst.status != CL_OK && m->grid.size > 1) {
    if (worst.rank == m->grid.rank && m->why != m->text)
      PetscCall(PetscStrncpy(m->text, m->why ? m->why : "", sizeof(m->text)));
    PetscCallMPI(MPI_Bcast(m->text, sizeof(m->text), MPI_CHAR, worst.rank, m->grid.comm));
    PetscCallMPI(MPI_Bcast(m->where, CL_DIM, MPI_DOUBLE, worst.rank, m->grid.comm));
    m->why = m->text;
  }
  m->status = *status;
  PetscFunctionReturn(PETSC_SUCCESS);
}
