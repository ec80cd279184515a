/* The mechanical balance of a run, whatever the integrator; docs/equations.md (90). */
#include "clathra/stepper.h"

PetscErrorCode StepperEnergyStart(Stepper *s)
{
  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(s->model, s->state.energy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperEnergyStep(Stepper *s, const double work[WORK_RATES])
{
  const Case   *c = StepperCase(s);
  StepperState *z = &s->state;
  double        now[ENERGY_COUNT], gain[ENERGY_COUNT];

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(s->model, now));
  for (int k = 0; k < ENERGY_COUNT; k++) {
    gain[k]      = now[k] + s->model->leaving.sum[REMOVED_ENERGY + k] - z->energy[k]; /* what left gained it before */
    z->energy[k] = now[k];
  }
  if (!c->scene.fields.solid)
    PetscFunctionReturn(PETSC_SUCCESS);
  /* quasi-static: no inertia in the balance of momentum, so none here */
  const double kinetic = (!c->scene.fields.inertia ? 0.0 : s->explicit ? c->mass_scaling : 1.0) * gain[ENERGY_KINETIC];
  const double lost    = work[WORK_INERTIA] - kinetic;
  const double given   = work[WORK_GRAVITY] + work[WORK_LOADS] + work[WORK_PLATES] + work[WORK_PRESSURE],
               gone    = gain[ENERGY_PLASTIC] + now[ENERGY_RELEASED] + work[WORK_DRAG] + work[WORK_DAMPING] + lost;

  for (int k = 0; k < WORK_RATES; k++)
    z->work[k] += work[k];
  z->work[WORK_RELEASED] += now[ENERGY_RELEASED];
  z->work[WORK_HEAT] += gain[ENERGY_HEAT];
  z->work[WORK_LOST] += lost;
  z->work[WORK_REMAINDER] += given - gone - kinetic - gain[ENERGY_ELASTIC];
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperEnergyChange(Stepper *s)
{
  StepperState *z   = &s->state;
  const double  old = z->energy[ENERGY_ELASTIC];

  PetscFunctionBeginUser;
  PetscCall(ModelEnergies(s->model, z->energy));
  z->work[WORK_RELEASED] += old - z->energy[ENERGY_ELASTIC]; /* the stress stays, its strain does not */
  PetscFunctionReturn(PETSC_SUCCESS);
}
