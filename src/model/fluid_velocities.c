/* Fluid velocities that follow the pressures where gas may vanish: (414) of docs/equations.md. */
#include "gather.h"

bool ModelVelocitiesFollow(const Model *m)
{
  return m->fluid && !m->c->fields.inertia && m->c->material[0].gas.trace > 0.0;
}

/* Those of an owned node to its scaled unknowns a, after an evaluation there. */
static void FollowPressures(const Model *m, PetscInt I, double *a)
{
  const FieldSet *fs = &m->c->fields;

  for (int f = 0; f < PHASE_COUNT; f++) {
    const FluidNode *at = &m->fluid[PHASE_COUNT * I + f];

    for (int d = 0; d < CL_DIM; d++) {
      const int    v    = PlaceV(fs, f) + d;
      const double J    = -at->root * at->root * at->F[d] / at->D[d];
      const double slip = J / m->w[PHASE_COUNT * I + f], v_s = fs->solid ? m->x[I * fs->n + PlaceVs(fs) + d] : 0.0;

      if (!((m->mask[I] >> v) & 1u))
        a[v] = (v_s + slip) / m->col_scale[I * fs->n + v];
    }
  }
}

PetscErrorCode ModelVelocitiesOfPressures(Model *m, Vec X)
{
  double *a;

  PetscFunctionBeginUser;
  if (!ModelVelocitiesFollow(m))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelNodesAt(m, X));
  if (m->failure.status != CL_OK)
    PetscFunctionReturn(PETSC_SUCCESS); /* X is outside the range of a law, and its residual says so */
  PetscCall(VecGetArray(X, &a));
  for (PetscInt I = 0; I < m->map.n_owned; I++)
    FollowPressures(m, I, &a[I * m->c->fields.n]);
  PetscCall(VecRestoreArray(X, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelVelocitiesAfterUpdate(SNESLineSearch ls, Vec X, Vec Y, Vec W, PetscBool *changed_Y,
                                          PetscBool *changed_W, void *model)
{
  Model *m = (Model *)model;

  PetscFunctionBeginUser;
  (void)ls;
  (void)X;
  (void)Y;
  *changed_Y = PETSC_FALSE;
  *changed_W = ModelVelocitiesFollow(m) ? PETSC_TRUE : PETSC_FALSE;
  PetscCall(ModelVelocitiesOfPressures(m, W));
  PetscFunctionReturn(PETSC_SUCCESS);
}
