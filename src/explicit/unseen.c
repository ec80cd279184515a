/* What nodes do not see of the particles' motion (452). */
#include "lanes.h"

#define UNSEEN_STEPS 64 /* from one time to the next: it costs about two of them */

PetscErrorCode LoseUnseen(Explicit *e)
{
  Model   *m = e->m;
  Stencil *stencil;

  PetscFunctionBeginUser;
  if (e->o.paper || !e->set.solid || e->unseen.steps < UNSEEN_STEPS)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(m->P.n, &stencil));
  for (PetscInt p = 0; p < m->P.n; p++)
    ParticleStencil(m->c, &m->grid, &m->P, p, &stencil[p]);
  const Transfer t = {.grid = &m->grid, .map = &e->map, .n = m->P.n, .stencil = stencil};
  PetscCall(TransferUnseen(&t, &m->c->fields, UnseenShare(e->unseen.time, e->across), &m->P));
  PetscCall(PetscFree(stencil));
  e->unseen = (Unseen){0.0, 0};
  PetscFunctionReturn(PETSC_SUCCESS);
}

Unseen ExplicitUnseen(const Explicit *e)
{
  return e->unseen;
}
