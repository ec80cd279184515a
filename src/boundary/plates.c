/* Rigid plates on a side of the body: a spring between every face and the plate.  docs/equations.md, section 6. */
#include "clathra/boundary.h"

#define FLUID_MOST 1e3 /* of the skeleton's modulus: what an incompressible fluid in the pores may add */
#define FARTHEST 0.5   /* cells in one step */
#define THINNEST 0.5   /* cells between a plate and a plane that holds the body */

double PlatePosition(const Bc *b, double t)
{
  return b->force.n ? 0.0 : b->displacement.n ? ScheduleValue(&b->displacement, t) : ScheduleIntegral(&b->value, t);
}

double PlateForce(const Bc *b, double t)
{
  return ScheduleValue(&b->force, t - b->zero);
}

double PlateStiffness(const Bc *b, const Face *f, const PointProperties *q, double h)
{
  double storage = 0.0, M = q->M;

  for (int k = 0; k < PHASE_COUNT; k++)
    storage += q->storage[k];
  if (storage > 0.0)
    M += fmin(1.0 / storage, FLUID_MOST * q->M);
  else if (q->rho[PHASE_W] > 0.0)
    M += FLUID_MOST * q->M;
  return b->stiffness * M / h * f->a0;
}

/* Contact of a face with a rigid plate (72). */
void PlateEvaluate(const Bc *b, const Face *f, double position, const double in[IN_COUNT], FaceOutput *o)
{
  const int    d = SideAxis(f->side);
  const double n = SideSign(f->side), gap = PlateGap(f, position, &in[IN_U]);
  Kinematics   k;

  if (b->separates && gap <= 0.0)
    return;
  o->plate[PLATE_FORCE] = f->K * gap;
  o->out[F_VS + d] += n * f->K * gap;
  o->D[F_VS + d][IN_U + d] += f->K;
  for (int i = 1; b->rough && i < CL_DIM; i++) {
    const int    t     = (d + i) % CL_DIM;
    const double shear = -f->K * (f->moved[t] + in[IN_U + t]);

    o->plate[PLATE_SHEAR] += shear;
    o->out[F_VS + t] -= shear;
    o->D[F_VS + t][IN_U + t] += f->K;
  }
  if (KinematicsValues(&in[IN_GRADU], &k))
    o->plate[PLATE_AREA] = n * VectorDot(k.cof[d], f->n);
}

bool PlatesForced(const Scene *c)
{
  bool any = false;

  for (PetscInt k = 0; k < c->nbc; k++)
    any = any || c->bc[k].force.n;
  return any;
}

/* One pass of (73): sums over the faces that touch a plate at its present position (all of them at first) of what they
   bear, of what that falls by, and their number. */
static void SumSprings(const Scene *c, PetscInt nface, const Face *face, const double (*answer)[2], bool first,
                       const double *value, double (*sum)[3])
{
  for (PetscInt k = 0; k < nface; k++) {
    const PetscInt which = face[k].bc[BC_PLATE];

    if (which < 0 || !c->bc[which].force.n)
      continue;
    const double n = SideSign(face[k].side), bears = n * answer[k][0];
    if (c->bc[which].separates && !first && bears <= answer[k][1] * n * value[which])
      continue;
    sum[which][0] += bears;
    sum[which][1] += answer[k][1];
    sum[which][2] += 1.0;
  }
}

PetscErrorCode PlatesSeek(const Scene *c, MPI_Comm comm, PetscInt nface, const Face *face, const double (*answer)[2],
                          double t, double *value, double *K)
{
  bool again = PlatesForced(c);
  double(*sum)[3], *touching;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(c->nbc, &sum, c->nbc, &touching));
  /* fewer and fewer faces touch: the force is a convex function of the position, met from the left */
  for (bool first = true; again; first = false) {
    again = false;
    PetscCall(PetscArrayzero(sum, c->nbc));
    SumSprings(c, nface, face, answer, first, value, sum);
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, (PetscMPIInt)(3 * c->nbc), MPI_DOUBLE, MPI_SUM, comm));
    for (PetscInt k = 0; k < c->nbc; k++) {
      if (!c->bc[k].force.n || sum[k][2] == 0.0 || (!first && sum[k][2] == touching[k]))
        continue;
      value[k]    = SideSign(c->bc[k].side) * (sum[k][0] - PlateForce(&c->bc[k], t)) / sum[k][1];
      touching[k] = sum[k][2];
      again       = again || c->bc[k].separates;
      if (K)
        K[k] = sum[k][1];
    }
  }
  PetscCall(PetscFree2(sum, touching));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has the plate met a plane that holds the body along its axis, or the plane a plate? */
static const Bc *Met(const Scene *c, const Grid *g, const Face *f, double position)
{
  const int    d     = SideAxis(f->side);
  const double start = f->x[d] - f->moved[d], least = THINNEST * LinesLeastAt(&g->line[d], f->x[d]);

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc    *b    = &c->bc[k];
    const double from = start - b->position, to = from + position;

    if (b->type != BC_ROLLER && b->type != BC_FIXED && b->type != BC_PLATE_LINE)
      continue;
    if (b->axis == d && position != 0.0 && (from * to <= 0.0 || (fabs(to) < least && fabs(to) < fabs(from))))
      return b;
  }
  return NULL;
}

ClStatus PlateCheck(const Scene *c, const Grid *g, const Face *f, double position, char *text, size_t size)
{
  const Bc    *b  = &c->bc[f->bc[BC_PLATE]], *plane;
  const int    d  = SideAxis(f->side);
  const double at = f->x[d] - f->moved[d] + position, upper = GridNode(g, d, g->cells[d]);
  const double zero[CL_DIM] = {0.0}, gap = PlateGap(f, position, zero), slack = 1e-9 * g->line[d].h;
  const bool   touches = !b->separates || gap > 0.0;

  if (!touches)
    return CL_OK;
  if (at < g->lower[d] - slack || at > upper + slack) {
    snprintf(text, size, "plate %s leaves the background grid", b->name);
    return CL_LEFT_GRID;
  }
  plane = Met(c, g, f, position);
  if (plane) {
    snprintf(text, size, "plate %s comes within half a cell of %s, which holds the body", b->name, plane->name);
    return CL_LEFT_GRID;
  }
  if (fabs(gap) > FARTHEST * LinesLeastAt(&g->line[d], f->x[d])) {
    snprintf(text, size, "plate %s moves more than half a cell in one step", b->name);
    return CL_TOO_FAR;
  }
  return CL_OK;
}
