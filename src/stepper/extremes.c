/* The lowest and highest pressure and temperature of any particle so far, with when and where. */
#include "clathra/stepper.h"

static const double sign[EXTREMES] = {-1.0, 1.0, -1.0, 1.0}; /* the highest of sign times the value is sought */

/* Of the particles of this rank, times sign; -INFINITY where there is none. */
static void Find(const Stepper *s, Extreme best[EXTREMES])
{
  const Particles *P = &s->model->P;

  for (int k = 0; k < EXTREMES; k++) {
    const bool heat = k >= LOWEST_T;

    best[k] = (Extreme){.value = -INFINITY, .t = s->state.t};
    for (PetscInt p = 0; P->f[heat ? P_T : P_PW] && p < P->n; p++) {
      const double v = sign[k] * (heat ? P->f[P_T][p] : ParticlePressure(P, p));

      if (v > best[k].value) {
        best[k].value = v;
        ParticlePlace(P, p, best[k].at);
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
  StepperState *z = &s->state;
  Extreme       best[EXTREMES];

  PetscFunctionBeginUser;
  Find(s, best);
  for (int k = 0; k < EXTREMES; k++) {
    PetscCall(GridShareLargest(s->model->grid.comm, &best[k], sizeof(best[k])));
    if (!isfinite(best[k].value)) /* no such field; a particle whose value is no number is UpdateScales's */
      continue;
    best[k].value *= sign[k];
    if (start)
      z->begin[k] = best[k].value;
    if (start || sign[k] * best[k].value > sign[k] * z->extreme[k].value)
      z->extreme[k] = best[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
