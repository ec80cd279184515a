/* Plates in the integrators without a matrix: their springs at the nodes; docs/equations.md, sections 6 and 12. */
#include "nodes.h"

/* of a cell: what is farther from a plate that separates cannot reach it in a step (a node with next to no mass
   might) */
#define NEAR 0.1

PetscErrorCode PlatesStart(Explicit *e)
{
  PetscFunctionBeginUser;
  if (!e->m->plates)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(e->spring, e->rows));
  PetscCall(PetscArrayzero(e->push, e->rows));
  PetscCall(PetscArrayzero(e->m->plate, e->m->c->nlisted));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does the plate of a face act along d? */
static bool Acts(const Explicit *e, const Face *f, int d)
{
  return d == SideAxis(f->side) || e->m->c->bc[f->bc[BC_PLATE]].rough;
}

static void Check(Model *m, const Face *f)
{
  char           why[CL_WHY];
  const ClStatus status = PlateCheck(m->c, &m->grid, f, m->bc.value[f->bc[BC_PLATE]], why, sizeof(why));

  if (status != CL_OK)
    ModelNoteFailure(m, status, why, f->particle);
}

void PlatesDeposit(Explicit *e, Face *f, int n, const PetscInt node[])
{
  Model       *m            = e->m;
  const Bc    *b            = &m->c->bc[f->bc[BC_PLATE]];
  const double zero[CL_DIM] = {0.0};

  ModelPlateStiffness(m, f);
  f->touches = b->force.n || !b->separates ||
               PlateGap(f, m->bc.value[f->bc[BC_PLATE]], zero) >
                   -NEAR * LinesWidthAt(&m->grid.line[SideAxis(f->side)], f->x[SideAxis(f->side)]);
  if (!f->touches)
    return;
  if (!b->force.n)
    Check(m, f);
  for (int a = 0; a < n; a++) {
    for (int d = 0; d < CL_DIM; d++)
      e->spring[node[a]][d] += Acts(e, f, d) ? f->K * f->N[a] : 0.0;
  }
}
