/* Backward Euler; docs/equations.md, section 8. */
#include "clathra/stepper.h"

static PetscErrorCode Step(Stepper *s, double dt, Attempt *a)
{
  Model       *m = s->model;
  StepperWork *w = &s->work;

  PetscFunctionBeginUser;
  PetscCall(StepperStartFromHistory(s));
  PetscCall(StepperStage(s, s->state.t + dt, dt, &w->trial[0], 1.0, a));
  if (a->status != CL_OK)
    PetscFunctionReturn(PETSC_SUCCESS);

  const double half = s->state.fresh ? 0.0 : 0.5, weight[3] = {-half, half, 0.0};
  double      *e, *eu;

  StepperPlasticErrors(s, dt, 1.0, weight);
  PetscCall(PetscMalloc2(4 * m->P.n, &e, CL_DIM * m->P.n, &eu));
  for (PetscInt p = 0; p < m->P.n; p++) { /* error of backward Euler (25) */
    double y_n[4], k_n[4];

    StepperHistory(m, p, y_n, k_n);
    for (int k = 0; k < 4; k++) {
      w->rates[4 * p + k] = (w->trial[0].y[4 * p + k] - y_n[k]) / dt;
      e[4 * p + k]        = s->state.fresh ? 0.0 : 0.5 * dt * (w->rates[4 * p + k] - k_n[k]);
    }
    for (int d = 0; d < CL_DIM; d++)
      eu[CL_DIM * p + d] = s->state.fresh ? 0.0 : 0.5 * dt * (w->trial[0].v[CL_DIM * p + d] - w->v_n[CL_DIM * p + d]);
  }
  a->err = StepperErrorNorm(s, e, eu, a);
  PetscCall(PetscFree2(e, eu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const StepperScheme StepperScheme_Euler = {.kind        = INTEGRATOR_EULER,
                                           .error_order = 2,
                                           .looks_back  = true,
                                           .stages      = 1,
                                           .advance     = StepperImplicitStep,
                                           .step        = Step};
