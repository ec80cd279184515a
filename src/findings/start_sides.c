/* What is said of the sides of the body and cannot be meant: faces that are opened and closed at once, and sides that
   nothing bears though the pores behind them do. */
#include "findings_private.h"
#include "clathra/shape.h"

#define ON_LINE 1e-9 /* of the coordinate's size */
#define SWELLS 5e-3  /* strain of the skeleton that is worth a word */

/* How far the body reaches on a side, m; region: it alone, if not below zero. */
static double SideLine(const Scene *c, PetscInt region, int side)
{
  const double sign = SideSign(side);
  double       at   = -INFINITY;

  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region *r = &c->region[k];

    if (!RegionEmpty(r) && (region < 0 || region == k))
      at = fmax(at, sign * (sign > 0.0 ? r->upper : r->lower)[SideAxis(side)]);
  }
  return sign * at;
}

/* Does it hold the line of this axis at `at` (m)? */
static bool HoldsLine(const Bc *b, int axis, double at)
{
  return (b->type == BC_ROLLER || b->type == BC_FIXED || b->type == BC_PLATE_LINE) && b->axis == axis &&
         fabs(b->position - at) <= ON_LINE * fmax(fabs(at), 1.0);
}

static PetscErrorCode FindClosed(const Findings *f, FindingId id, const Scene *c)
{
  char advice[128];

  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *face = &c->bc[k];

    if ((face->type != BC_PRESSURE && face->type != BC_INFLOW) || face->side == SIDE_COUNT)
      continue;
    const int    axis = SideAxis(face->side);
    const double at   = SideLine(c, face->region, face->side);

    for (PetscInt i = 0; i < c->nbc; i++) {
      const Bc *line = &c->bc[i];

      if (line->drained || !HoldsLine(line, axis, at))
        continue;
      snprintf(advice, sizeof(advice), "bc_%s_holds: skeleton, which lets the fluids cross", line->name);
      SAY_TRY(advice,
              "boundary %s holds water and gas, too, at %c = %g m, and closes the faces of boundary %s, which lie "
              "there: nothing flows through them",
              line->name, 'x' + axis, line->position, face->name);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FindingsFindClosedFaces(Findings *f, FindingId id)
{
  PetscFunctionBeginUser;
  for (PetscInt k = 0; k < PetscMax(f->c->nstage, 1); k++)
    PetscCall(FindClosed(f, id, &CaseInStage(f->c, k)->scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Does a condition hold or press this side of the body, which lies at coordinate `at` (m)? */
static bool Borne(const Scene *c, int side, double at)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *b = &c->bc[k];

    if (HoldsLine(b, SideAxis(side), at) ||
        ((b->type == BC_TRACTION || b->type == BC_PLATE) && ((int)b->side == side || b->side == SIDE_COUNT)))
      return true;
  }
  return false;
}

/* Of the regions that reach the side at `at` (m) and start without a stress: the largest strain by which their pore
   pressure, Pa, would swell them; 0: none. */
static PetscErrorCode Swells(const Scene *c, int side, double at, double *strain, double *pressure)
{
  PetscFunctionBeginUser;
  *strain = *pressure = 0.0;
  for (PetscInt k = 0; k < c->nregion; k++) {
    const Region  *r = &c->region[k];
    InitialScalars s;
    double         dE, middle[CL_DIM];

    if (RegionEmpty(r) || !RegionUnstressed(r) || SideLine(c, k, side) != at)
      continue;
    const Elasticity *el = &c->material[r->material].elasticity;
    const double      M  = ElasticityConstrainedFactor(el) * ElasticityYoung(el, r->Sh, &dE);

    RegionMiddle(r, middle);
    PetscCall(InitialScalarsAt(c, r, middle, &s));
    if (s.p / M > *strain) {
      *strain   = s.p / M;
      *pressure = s.p;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A side of which nothing is said is free of total stress, so the skeleton takes the pores' pressure as a tension at
   once. */
PetscErrorCode FindingsFindFreeSides(Findings *f, FindingId id)
{
  const Scene *c   = f->s->model->c;
  const bool   sea = AmbientOf(c, c->t_begin, c->gravity).on || c->ambient_pressure.n > 1;
  char         advice[128];

  PetscFunctionBeginUser;
  for (int side = 0; side < SIDE_COUNT && c->fields.solid && c->fields.fluid && !sea; side++) {
    const double at = SideLine(c, -1, side);
    double       strain, pressure;

    if ((c->axisymmetric && side == SIDE_XMIN && at <= 0.0) || Borne(c, side, at))
      continue;
    PetscCall(Swells(c, side, at, &strain, &pressure));
    if (!(strain > SWELLS))
      continue;
    snprintf(advice, sizeof(advice), "type: traction, side: %s, normal: %.4g MPa", cl_side[side], 1e-6 * pressure);
    SAY_TRY(advice,
            "nothing bears the pore pressure of %.3g MPa at the body's %s, which is free of total stress as long as no "
            "traction, plate, roller or ambient pressure acts there: its skeleton swells by some %.2g %%",
            1e-6 * pressure, cl_side[side], 100.0 * strain);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
