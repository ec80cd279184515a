/* Implicit steps of auto: do they still lead from one equilibrium to the next, or over a slide; what any of them takes
   of the motion that nodes do not see.  docs/equations.md, section 15. */
#include "clathra/stepper.h"
#include "clathra/transfer.h"

#define UNFORESEEN 0.05 /* of a cell (356) */

/* (356) of particle p, of what it may be. */
static double Unforeseen(const Stepper *s, PetscInt p, double dt)
{
  const Model  *m = s->model;
  const double *u = s->work.trial[s->scheme->tableau->stages - 1].u, *v = s->work.v_n;
  double        most = 0.0;

  for (int d = 0; d < CL_DIM; d++) {
    const PetscInt q = CL_DIM * p + d;

    most = fmax(most, fmin(fabs(u[q]), fabs(u[q] - dt * v[q])) / LinesLeastAt(&m->grid.line[d], m->P.f[P_X + d][p]));
  }
  return most / UNFORESEEN;
}

PetscErrorCode StepperCheckEquilibrium(Stepper *s, double dt, Attempt *a)
{
  Model   *m     = s->model;
  double   most  = 1.0;
  PetscInt worst = -1;

  PetscFunctionBeginUser;
  if (!s->auto_.on || !m->c->fields.solid)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double moved = Unforeseen(s, p, dt);

    if (moved > most) {
      most  = moved;
      worst = p;
    }
  }
  ModelClearFailure(m);
  if (worst >= 0)
    ModelNoteFailure(m, CL_TOO_FAR, "a slide: its speed at the start does not foretell where a particle goes", worst);
  PetscCall(ModelReduceStatus(m, &a->status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperUnseen(Stepper *s, double dt, double *share)
{
  const FieldSet *fs = &s->model->c->fields;
  StableStep      limit;

  PetscFunctionBeginUser;
  *share = 0.0;
  if (!fs->solid || !fs->inertia)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StepperHybridLimit(s, &limit));
  *share = UnseenShare(dt, limit.across);
  PetscFunctionReturn(PETSC_SUCCESS);
}
