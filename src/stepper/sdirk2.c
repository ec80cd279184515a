/* Alexander's two-stage SDIRK, L-stable, stiffly accurate; docs/equations.md, section 8. */
#include "clathra/stepper.h"

#define GAMMA (1.0 - 0.70710678118654752440)

/* Start values of the second stage (24). */
static void Star(Stepper *s, double dt)
{
  const Model    *m  = s->model;
  const FieldSet *fs = &m->c->fields;
  StepperWork    *w  = &s->work;
  const double    c = (1.0 - GAMMA) / GAMMA, *x_n = ModelStart(m);

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int q = 0; q < fs->n; q++) {
      const PetscInt k = I * fs->n + q;

      w->x_star[k] = x_n[k] + c * (w->x[k] - x_n[k]);
    }
    for (int d = 0; fs->solid && d < CL_DIM; d++)
      w->u_star[I * CL_DIM + d] = (1.0 - GAMMA) * dt * w->x[I * fs->n + PlaceVs(fs) + d];
  }
  for (PetscInt p = 0; p < m->P.n; p++) {
    for (int k = 0; k < 3; k++) {
      const double m_n = StepperMass(m, p, k);

      w->m_star[3 * p + k] = m_n + c * (w->trial[0].m[3 * p + k] - m_n);
    }
  }
  StepperStarSkeleton(s, c);
}

/* (26): weights of k_n, k_1, k_2; without k_n (fresh) the embedded first-order formula. */
static void ErrorWeights(bool fresh, double e[3])
{
  const double b1 = 1.0 / (6.0 * GAMMA * (1.0 - GAMMA)), b2 = 0.5 - b1 * GAMMA;

  e[0] = fresh ? 0.0 : 1.0 - b1 - b2;
  e[1] = fresh ? GAMMA : b1 - (1.0 - GAMMA);
  e[2] = fresh ? -GAMMA : b2 - GAMMA;
}

static PetscErrorCode Error(Stepper *s, double dt, Attempt *a)
{
  const Model *m = s->model;
  StepperWork *w = &s->work;
  double       weight[3], *e, *eu;

  PetscFunctionBeginUser;
  ErrorWeights(s->state.fresh, weight);
  StepperPlasticErrors(s, dt, GAMMA, weight);
  PetscCall(PetscMalloc2(4 * m->P.n, &e, CL_DIM * m->P.n, &eu));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double y_n[4], k_n[4];

    StepperHistory(m, p, y_n, k_n);
    for (int k = 0; k < 4; k++) {
      const double k1 = (w->trial[0].y[4 * p + k] - y_n[k]) / (GAMMA * dt);
      const double k2 = (w->trial[1].y[4 * p + k] - y_n[k] - (1.0 - GAMMA) * dt * k1) / (GAMMA * dt);

      w->rates[4 * p + k] = k2;
      e[4 * p + k]        = dt * (weight[0] * k_n[k] + weight[1] * k1 + weight[2] * k2);
    }
    for (int d = 0; d < CL_DIM; d++) {
      const PetscInt q = CL_DIM * p + d;

      eu[q] = dt * (weight[0] * w->v_n[q] + weight[1] * w->trial[0].v[q] + weight[2] * w->trial[1].v[q]);
    }
  }
  a->err = StepperErrorNorm(s, e, eu, a);
  PetscCall(PetscFree2(e, eu));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Step(Stepper *s, double dt, Attempt *a)
{
  StepperWork *w = &s->work;
  const double t = s->state.t;

  PetscFunctionBeginUser;
  PetscCall(StepperStartFromHistory(s));
  PetscCall(StepperStage(s, t + GAMMA * dt, GAMMA * dt, &w->trial[0], (1.0 - GAMMA) / GAMMA, a));
  if (a->status != CL_OK)
    PetscFunctionReturn(PETSC_SUCCESS);
  Star(s, dt);
  PetscCall(StepperStage(s, t + dt, GAMMA * dt, &w->trial[1], 1.0, a));
  if (a->status == CL_OK)
    PetscCall(Error(s, dt, a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const StepperScheme StepperScheme_Sdirk2 = {
    .kind = INTEGRATOR_SDIRK2, .error_order = 3, .stages = 2, .advance = StepperImplicitStep, .step = Step};
