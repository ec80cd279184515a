/* Particles that left the grid and were taken out of the run (373): into the state, and into words. */
#include "clathra/stepper.h"
#include "clathra/words.h"

#define SHOWN 100 /* lines of one step or burst */
#define WIDE (sizeof(LeavingParticle) / sizeof(double))

static int ByTime(const void *a, const void *b)
{
  const LeavingParticle *x = a, *y = b;

  return x->t != y->t ? (x->t > y->t ? 1 : -1) : x->id > y->id ? 1 : -1;
}

static PetscErrorCode PrintParticles(const Model *m, const LeavingParticle *one, PetscInt n)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < n && k < SHOWN; k++)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "t = %s: particle %.0f of %s left the grid at %s and is taken out, %g kg\n",
                          TimeAt(one[k].t).s, one[k].id, m->c->region[(PetscInt)one[k].region].name,
                          PlaceWords(one[k].x).s, one[k].mass));
  if (n > SHOWN)
    PetscCall(PetscPrintf(PETSC_COMM_SELF, "... and %" PetscInt_FMT " more\n", n - SHOWN));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* All of them, on the first rank. */
static PetscErrorCode PrintLeaving(const Model *m)
{
  const Leaving   *l    = &m->leaving;
  const MPI_Comm   comm = m->grid.comm;
  PetscMPIInt      mine = (PetscMPIInt)(l->n * (PetscInt)WIDE), *count, *at, total = 0;
  LeavingParticle *all;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(m->grid.size, &count, m->grid.size, &at));
  PetscCallMPI(MPI_Gather(&mine, 1, MPI_INT, count, 1, MPI_INT, 0, comm));
  for (PetscMPIInt r = 0; m->grid.rank == 0 && r < m->grid.size; r++) {
    at[r] = total;
    total += count[r];
  }
  PetscCall(PetscMalloc(sizeof(double) * (size_t)total, &all));
  PetscCallMPI(MPI_Gatherv(l->one, mine, MPI_DOUBLE, all, count, at, MPI_DOUBLE, 0, comm));
  if (m->grid.rank == 0) {
    qsort(all, (size_t)total / WIDE, sizeof(*all), ByTime);
    PetscCall(PrintParticles(m, all, total / (PetscInt)WIDE));
  }
  PetscCall(PetscFree(all));
  PetscCall(PetscFree2(count, at));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperCountLeaving(Stepper *s)
{
  Model   *m    = s->model;
  Leaving *l    = &m->leaving;
  PetscInt rest = m->P.n;

  PetscFunctionBeginUser;
  if (!l->removes)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, l->sum, REMOVED_COUNT, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  if (l->sum[REMOVED_N] == 0.0)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < REMOVED_COUNT; k++)
    s->state.removed[k] += l->sum[k];
  PetscCall(PrintLeaving(m));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &rest, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  s->broken = rest == 0;
  s->empty  = rest == 0;
  if (!s->empty)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(
      StepperGiveUp(s, CL_LEFT_GRID,
                    "a larger grid, for nothing of the body stayed in it; a roller or fixed line where it should be "
                    "held; an earlier time_end; the units of velocities and loads",
                    ": the last particle has left the grid"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
