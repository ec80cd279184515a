/* Particles follow their cells' owners. */
#include "clathra/particles.h"

static void Pack(const Particles *P, PetscInt p, double *to)
{
  for (int k = 0; k < P_COUNT; k++)
    to[k] = P->f[k] ? P->f[k][p] : 0.0;
  for (int k = 0; k < PI_COUNT; k++)
    to[P_COUNT + k] = (double)P->i[k][p]; /* exact below 2^53 */
}

static void Unpack(const double *from, Particles *P, PetscInt p)
{
  for (int k = 0; k < P_COUNT; k++) {
    if (P->f[k])
      P->f[k][p] = from[k];
  }
  for (int k = 0; k < PI_COUNT; k++)
    P->i[k][p] = (PetscInt)from[P_COUNT + k];
}

static void Move(Particles *P, PetscInt from, PetscInt to)
{
  for (int k = 0; k < P_COUNT; k++) {
    if (P->f[k])
      P->f[k][to] = P->f[k][from];
  }
  for (int k = 0; k < PI_COUNT; k++)
    P->i[k][to] = P->i[k][from];
}

static PetscErrorCode FindOwners(const Grid *g, const Particles *P, PetscMPIInt *owner, PetscInt *left)
{
  PetscInt outside = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    const double x[CL_DIM] = {P->f[P_X][p], P->f[P_X + 1][p]};
    PetscInt     cell[CL_DIM];

    if (GridCell(g, x, cell))
      owner[p] = GridCellOwner(g, cell);
    else
      outside++;
  }
  PetscCallMPI(MPI_Allreduce(&outside, left, 1, MPIU_INT, MPI_SUM, g->comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Exchanges the particles whose owner is another rank; those that stay keep their order. */
static PetscErrorCode Exchange(const Grid *g, const PetscMPIInt *owner, Particles *P)
{
  const PetscMPIInt width = P_COUNT + PI_COUNT;
  PetscMPIInt      *count, *to, *got, *from, total = 0, arriving = 0;
  double           *out, *in;
  PetscInt          kept = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc4(g->size, &count, g->size, &to, g->size, &got, g->size, &from));
  for (PetscInt p = 0; p < P->n; p++) {
    if (owner[p] != g->rank)
      count[owner[p]] += width;
  }
  PetscCallMPI(MPI_Alltoall(count, 1, MPI_INT, got, 1, MPI_INT, g->comm));
  for (PetscMPIInt r = 0; r < g->size; r++) {
    to[r]   = total;
    from[r] = arriving;
    total += count[r];
    arriving += got[r];
  }
  PetscCall(PetscMalloc2(total, &out, arriving, &in));
  for (PetscInt p = 0; p < P->n; p++) {
    if (owner[p] == g->rank) {
      if (kept != p)
        Move(P, p, kept);
      kept++;
    } else {
      Pack(P, p, out + to[owner[p]]);
      to[owner[p]] += width;
    }
  }
  for (PetscMPIInt r = 0; r < g->size; r++)
    to[r] -= count[r];
  PetscCallMPI(MPI_Alltoallv(out, count, to, MPIU_REAL, in, got, from, MPIU_REAL, g->comm));
  PetscCall(ParticlesResize(P, kept + arriving / width));
  for (PetscInt k = 0; k < arriving / width; k++)
    Unpack(in + k * width, P, kept + k);
  PetscCall(PetscFree2(out, in));
  PetscCall(PetscFree4(count, to, got, from));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ParticlesMigrate(const Grid *g, Particles *P, PetscInt *left)
{
  PetscMPIInt *owner;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(P->n, &owner));
  PetscCall(FindOwners(g, P, owner, left));
  if (*left == 0 && g->size > 1)
    PetscCall(Exchange(g, owner, P));
  PetscCall(PetscFree(owner));
  PetscFunctionReturn(PETSC_SUCCESS);
}
