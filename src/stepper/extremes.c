/* The lowest and highest pressure and temperature of any particle so far, with when and where. */
#include "clathra/stepper.h"
#include <string.h>

static const double sign[EXTREMES] = {1.0, -1.0, 1.0, -1.0}; /* the lowest of sign times the value is sought */

/* Of the particles of this rank: sign times the value, INFINITY where there is none, and the particle. */
static void Find(const Model *m, double low[EXTREMES], PetscInt who[EXTREMES])
{
  const Particles *P = &m->P;

  for (int k = 0; k < EXTREMES; k++) {
    low[k] = INFINITY;
    who[k] = 0;
  }
  for (PetscInt p = 0; p < P->n; p++) {
    for (int k = 0; k < EXTREMES; k++) {
      const bool heat = k >= LOWEST_T;

      if (!P->f[heat ? P_T : P_PW])
        continue;
      const double v = sign[k] * (heat ? P->f[P_T][p] : ParticlePressure(P, p));

      if (v < low[k]) {
        low[k] = v;
        who[k] = p;
      }
    }
  }
}

double StepperEquilibrium(const Scene *c, double from, double p, bool warm)
{
  double out = from;

  for (PetscInt k = 0; k < c->nmaterial; k++) {
    const Material *m = &c->material[k];

    if (!m->reacts || !c->fields.phase[PHASE_G])
      continue;
    const double T = EquilibriumTemperature(&m->kinetics.equilibrium, p);

    out = warm ? fmax(out, T) : fmin(out, T);
  }
  return out;
}

PetscErrorCode StepperExtremes(Stepper *s, bool start)
{
  const Model  *m = s->model;
  StepperState *z = &s->state;
  struct {
    double value;
    int    rank;
  } best[EXTREMES];
  double   low[EXTREMES], at[EXTREMES][CL_DIM] = {{0.0}};
  PetscInt who[EXTREMES];

  PetscFunctionBeginUser;
  Find(m, low, who);
  for (int k = 0; k < EXTREMES; k++) {
    best[k].value = low[k];
    best[k].rank  = m->grid.rank;
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, best, EXTREMES, MPI_DOUBLE_INT, MPI_MINLOC, m->grid.comm));
  for (int k = 0; k < EXTREMES; k++) {
    for (int d = 0; best[k].rank == m->grid.rank && m->P.n && d < CL_DIM; d++)
      at[k][d] = m->P.f[P_X + d][who[k]];
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, at, EXTREMES * CL_DIM, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  for (int k = 0; k < EXTREMES; k++) {
    if (!isfinite(best[k].value)) /* no such field; a particle whose value is no number is UpdateScales's */
      continue;
    if (start)
      z->begin[k] = sign[k] * best[k].value;
    if (!start && !(best[k].value < sign[k] * z->extreme[k].value))
      continue;
    z->extreme[k] = (Extreme){.value = sign[k] * best[k].value, .t = z->t};
    memcpy(z->extreme[k].at, at[k], sizeof(at[k]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperShareLargest(MPI_Comm comm, void *largest, size_t bytes)
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
