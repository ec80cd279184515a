/* Fluid velocities that follow the pressures, and how far Newton's update goes, where gas may vanish: (414), (415) of
   docs/equations.md. */
#include "solver.h"

#define HALVINGS 4   /* at most; what is left then is tried: a kink may lie in the way */
#define DESCENT 1e-4 /* of the residual, for a whole update (Armijo) */

bool ModelSlaves(const Model *m)
{
  return m->fluid && !m->c->fields.inertia && !m->c->fields.one_pressure && m->c->material[0].gas.trace > 0.0;
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

PetscErrorCode ModelSlave(Model *m, Vec X)
{
  double *a;

  PetscFunctionBeginUser;
  if (!ModelSlaves(m))
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

PetscErrorCode ModelLeaves(SNES snes, Model *m, Vec X, double share, Vec Y, Vec W, double *norm)
{
  Vec R;

  PetscFunctionBeginUser;
  PetscCall(VecWAXPY(W, -share, Y, X));
  PetscCall(ModelSlave(m, W));
  PetscCall(VecDuplicate(X, &R));
  PetscCall(SNESComputeFunction(snes, W, R));
  PetscCall(VecNorm(R, NORM_2, norm));
  PetscCall(VecDestroy(&R));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelTryUpdate(SNESLineSearch ls, Vec X, Vec Y, Vec W, PetscBool *changed_Y, PetscBool *changed_W,
                              void *model)
{
  Model *m = (Model *)model;
  SNES   snes;
  double from, norm, share = 1.0;

  PetscFunctionBeginUser;
  *changed_Y = PETSC_FALSE;
  *changed_W = PETSC_FALSE;
  if (!ModelSlaves(m))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESLineSearchGetSNES(ls, &snes));
  PetscCall(SNESGetFunctionNorm(snes, &from));
  for (int k = 0;; k++, share *= 0.5) {
    PetscCall(ModelLeaves(snes, m, X, share, Y, W, &norm));
    if (norm <= (1.0 - DESCENT * share) * from || k == HALVINGS)
      break;
  }
  PetscCall(PetscInfo(snes, "update: share %g leaves %.3e of %.3e\n", share, norm, from));
  *changed_W = PETSC_TRUE;
  PetscFunctionReturn(PETSC_SUCCESS);
}
