/* Sides of the body that nothing holds or presses, though its pores bear a pressure: a side of which nothing is said is
   free of total stress, so the skeleton takes that pressure as a tension at once. */
#include "clathra/boundary.h"
#include "clathra/shape.h"

#define SWELLS 5e-3 /* strain of the skeleton that is worth a word */

static const char *const side_word[SIDE_COUNT] = {"left", "right", "bottom", "top"};

/* Does a condition hold or press this side of the body, which lies at coordinate `at` (m)? */
static bool Borne(const Scene *c, int side, double at)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc  *b       = &c->bc[k];
    const bool on_line = b->axis == SideAxis(side) && fabs(b->position - at) <= 1e-9 * fmax(fabs(at), 1.0);

    if ((b->type == BC_ROLLER || b->type == BC_FIXED || b->type == BC_PLATE_LINE) && on_line)
      return true;
    if ((b->type == BC_TRACTION || b->type == BC_PLATE) && ((int)b->side == side || b->side == SIDE_COUNT))
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
    const Region     *r              = &c->region[k];
    const Elasticity *el             = &c->material[r->material].elasticity;
    const double      middle[CL_DIM] = {0.5 * (r->lower[0] + r->upper[0]), 0.5 * (r->lower[1] + r->upper[1])};
    const double     *edge           = SideSign(side) > 0.0 ? r->upper : r->lower;
    InitialScalars    s;
    double            M, dE;
    bool              stressed = RegionGeostatic(r);

    for (int i = 0; i < 6; i++)
      stressed = stressed || r->stress[i] != 0.0;
    if (RegionEmpty(r) || stressed || edge[SideAxis(side)] != at)
      continue;
    M = ElasticityYoung(el, r->Sh, &dE) * (1.0 - el->nu) / ((1.0 + el->nu) * (1.0 - 2.0 * el->nu));
    PetscCall(InitialScalarsAt(c, r, middle, &s));
    if (s.p / M > *strain) {
      *strain   = s.p / M;
      *pressure = s.p;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeSidesWarning(MPI_Comm comm, const Scene *c)
{
  const bool sea =
      c->ambient_density > 0.0 || c->ambient_pressure.n > 1 || ScheduleValue(&c->ambient_pressure, 0.0) > 0.0;

  PetscFunctionBeginUser;
  for (int side = 0; side < SIDE_COUNT && c->fields.solid && c->fields.fluid && !sea; side++) {
    const double sign = SideSign(side);
    double       at   = -INFINITY, strain, pressure;

    for (PetscInt k = 0; k < c->nregion; k++) {
      if (!RegionEmpty(&c->region[k]))
        at = fmax(at, sign * (sign > 0.0 ? c->region[k].upper : c->region[k].lower)[SideAxis(side)]);
    }
    at *= sign;
    if ((c->axisymmetric && side == SIDE_XMIN && at <= 0.0) || Borne(c, side, at))
      continue;
    PetscCall(Swells(c, side, at, &strain, &pressure));
    if (!(strain > SWELLS))
      continue;
    PetscCall(
        PetscFPrintf(comm, stderr,
                     "clathra: warning: nothing bears the pore pressure of %.3g MPa at the body's %s, which is "
                     "free of total stress as long as no traction, plate, roller or ambient pressure acts there: "
                     "its skeleton swells by some %.2g %% (type: traction, side: %s, normal: %.4g MPa keeps it)\n",
                     1e-6 * pressure, side_word[side], 100.0 * strain, side_word[side], 1e-6 * pressure));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
