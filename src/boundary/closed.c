/* Faces that a condition opens and another one, on the line they lie on, closes: nothing flows there, whatever is
   prescribed. */
#include "clathra/boundary.h"
#include "clathra/shape.h"

#define ON_LINE 1e-9 /* of the coordinate's size */

/* Does it hold the fluids' velocity normal to a line of this axis, and where, m? */
static bool Closes(const Bc *b, PetscInt axis, double *at)
{
  *at = b->position;
  return (b->type == BC_ROLLER || b->type == BC_FIXED || b->type == BC_PLATE_LINE) && !b->drained && b->axis == axis;
}

/* Where its faces lie at the start, m; NAN: on no single line. */
static double FaceLine(const Scene *c, const Bc *face)
{
  const double sign = SideSign(face->side);
  double       at   = -INFINITY;

  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region *r = &c->region[k];

    if (!RegionEmpty(r) && (face->region < 0 || face->region == k))
      at = fmax(at, sign * (sign > 0.0 ? r->upper : r->lower)[SideAxis(face->side)]);
  }
  return sign * at;
}

PetscErrorCode ClosedWarning(MPI_Comm comm, const Scene *c)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *face = &c->bc[k];

    if ((face->type != BC_PRESSURE && face->type != BC_INFLOW) || face->side == SIDE_COUNT)
      continue;
    for (PetscInt i = 0; i < c->nbc; i++) {
      const double line = FaceLine(c, face);
      double       at;

      if (!Closes(&c->bc[i], SideAxis(face->side), &at) || !(fabs(at - line) <= ON_LINE * fmax(fabs(at), 1.0)))
        continue;
      PetscCall(
          PetscFPrintf(comm, stderr,
                       "clathra: warning: boundary %s holds water and gas, too, at %c = %g m, and closes the "
                       "faces of boundary %s, which lie there: nothing flows through them.  bc_%s_holds: skeleton "
                       "lets the fluids cross\n",
                       c->bc[i].name, "xy"[SideAxis(face->side)], at, face -> name, c -> bc[i].name));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
