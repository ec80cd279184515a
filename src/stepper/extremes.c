/* The lowest and highest pressure and temperature of any particle so far, with when and where, and how far hydrate was
   above its equilibrium because its reaction was held. */
#include "clathra/stepper.h"
#include <string.h>

#define HYDRATE 0.01 /* S_h: what is less goes on for ever, (12) */

static const double sign[EXTREMES] = {1.0, -1.0, 1.0, -1.0, -1.0}; /* the lowest of sign times the value is sought */

/* (423), K, if it may be more than `least` (K, >= 0); else 0. */
static double HeldWarmth(const Model *m, PetscInt p, double least)
{
  const Particles *P   = &m->P;
  const Material  *mat = &m->c->material[m->c->region[P->i[PI_REGION][p]].material];
  const double     T = P->f[P_T][p], at = ParticlePressure(P, p);
  double           slope;

  if (!mat->reacts || P->f[P_SH][p] < HYDRATE ||
      EquilibriumPressure(&mat->kinetics.equilibrium, T - least, &slope) <= at)
    return 0.0;
  const double held = ModelHeld(m, p);

  return (T - EquilibriumTemperature(&mat->kinetics.equilibrium, at)) * held / (1.0 + held);
}

/* Of the particles of this rank: sign times the value, INFINITY where there is none, and the particle. */
static void Find(const Model *m, double low[EXTREMES], PetscInt who[EXTREMES])
{
  const Particles *P = &m->P;

  for (int k = 0; k < EXTREMES; k++) {
    low[k] = INFINITY;
    who[k] = 0;
  }
  if (SceneHoldsReaction(m->c))
    low[MOST_HELD] = 0.0;
  for (PetscInt p = 0; p < P->n; p++) {
    const double held = SceneHoldsReaction(m->c) ? HeldWarmth(m, p, -low[MOST_HELD]) : -INFINITY;

    if (-held < low[MOST_HELD]) {
      low[MOST_HELD] = -held;
      who[MOST_HELD] = p;
    }
    for (int k = 0; k < MOST_HELD; k++) {
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

#define HELD 0.2 /* of what may melt hydrate (419) */

double StepperHeldLevel(const Stepper *s)
{
  const Extreme *of = s->state.extreme;

  return HELD * (of[HIGHEST_T].value - StepperEquilibrium(s->model->c, INFINITY, of[LOWEST_P].value, false));
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
  if (-best[MOST_HELD].value > 0.0 && -best[MOST_HELD].value >= StepperHeldLevel(s)) /* since the last look */
    z->held_for += z->t - z->held_look;
  z->held_look = z->t;
  PetscFunctionReturn(PETSC_SUCCESS);
}
