/* The stages of a run: which case, integrator and step control hold, and what one stage hands to the next. */
#include "clathra/stepper.h"

#define SCHEME(name, word, scheme, kinds) &StepperScheme_##scheme,
static const StepperScheme *const schemes[INTEGRATOR_COUNT] = {CL_INTEGRATORS(SCHEME)};

const StepperScheme *StepperSchemeOf(Integrator kind)
{
  return schemes[kind];
}

const Tableau *StepperTableau(const Stepper *s)
{
  return s->scheme->tableau ? s->scheme->tableau : schemes[INTEGRATOR_AUTO]->tableau;
}

const char *StepperName(const Stepper *s)
{
  return case_integrator[s->scheme->kind];
}

double StepperFloorU(const Stepper *s)
{
  double h = INFINITY;

  for (int d = 0; d < CL_DIM; d++)
    h = fmin(h, s->model->grid.line[d].h);
  return 1e-3 * h;
}

void StepperStageWords(const Stepper *s, char words[80])
{
  const Case *c = StepperCase(s);

  words[0] = '\0';
  for (PetscInt k = 0; k < c->nstage; k++) {
    if (c == &c->stage[k].c)
      snprintf(words, 80, "stage %s: ", c->stage[k].name);
  }
}

bool StepperStageDone(const Stepper *s)
{
  return CaseAtEnd(StepperCase(s), s->state.t);
}

bool StepperDone(const Stepper *s)
{
  return StepperStageDone(s) && s->state.stage + 1 >= StepperCase(s)->nstage;
}

PetscErrorCode StepperTakeStage(Stepper *s, PetscInt k)
{
  const Case *c = CaseInStage(StepperCase(s), k);

  PetscFunctionBeginUser;
  s->model->c     = &c->scene;
  s->scheme       = StepperSchemeOf(c->integrator);
  s->adaptive     = c->adaptive;
  s->dt_min       = c->dt_min;
  s->dt_max       = c->dt_max;
  s->tol          = c->tol;
  s->max_failures = c->max_failures;
  s->crawl        = 0;
  s->bound        = s->adaptive ? BOUND_BEGIN : BOUND_FIXED; /* of the first step, also behind a restart */

  s->model->leaving.removes = c->leaving == LEAVING_REMOVE;
  s->model->relative_gas    = SceneKeepsGas(&c->scene);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From here on displacements count; where a particle was seeded stays known. */
static void ResetDisplacement(Stepper *s)
{
  Particles *P = &s->model->P;

  for (PetscInt p = 0; P->f[P_U] && p < P->n; p++) {
    for (int d = 0; d < CL_DIM; d++)
      P->f[P_U + d][p] = 0.0;
    P->f[P_LOGJ][p] = 0.0;
  }
  s->state.scale_u = StepperFloorU(s);
}

void StepperForget(StepperState *z, double dt)
{
  z->dt      = dt;
  z->hold    = 0;
  z->fresh   = 1;
  z->err_old = 1.0;
}

/* Particles stay as they are; only the rates of the last step are no rates of this stage. */
PetscErrorCode StepperNextStage(Stepper *s)
{
  StepperState *z = &s->state;

  PetscFunctionBeginUser;
  z->t = StepperCase(s)->t_end; /* to the last digit */
  z->stage++;
  PetscCall(StepperTakeStage(s, z->stage));
  StepperForget(z, StepperCase(s)->dt);
  z->kind = AUTO_UNDECIDED;
  PetscCall(PetscArrayzero(z->acts, ACTS_COUNT));
  if (StepperCase(s)->stage[z->stage].reset)
    ResetDisplacement(s);
  PetscCall(StepperEnergyChange(s));
  PetscFunctionReturn(PETSC_SUCCESS);
}
