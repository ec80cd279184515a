/* Surface faces: their geometry, and which conditions act on them. */
#include "clathra/boundary.h"
#include "clathra/shape.h"

static const int side_axis[SIDE_COUNT] = {0, 0, 1, 1};
static const int side_sign[SIDE_COUNT] = {-1, 1, -1, 1};

/* Last condition of a type on this face; later ones in the case win. */
static PetscInt FindCondition(const Case *c, BcType type, const Face *f)
{
  PetscInt found = -1;

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *b = &c->bc[k];

    if (b->type == type && FaceNamed(c, &BcFaces(b), f->region, f->x0, f->side))
      found = k;
  }
  return found;
}

static unsigned FindMeters(const Case *c, const Face *f)
{
  unsigned meters = 0;

  for (PetscInt k = 0; k < c->nmeter; k++)
    meters |= (unsigned)FaceNamed(c, &c->meter[k], f->region, f->x0, f->side) << k;
  return meters;
}

/* Hat function along the normal, the particle's own weights along the tangent.  A linear particle does not reach the
   nodes of its face, which then acts at the particle. */
static void Weights(const Grid *g, BasisType basis, const Stencil *s, int axis, double position, double N[CL_NODES])
{
  const Axis *x = &s->axis[0], *y = &s->axis[1];
  Axis        hat;
  int         n = 0;

  if (basis == BASIS_LINEAR)
    hat = s->axis[axis];
  else
    BasisHat(position, g->lower[axis], g->h[axis], &hat);
  for (int b = 0; b < 3; b++) {
    if (y->S[b] == 0.0 && y->dS[b] == 0.0)
      continue;
    for (int a = 0; a < 3; a++) {
      if (x->S[a] == 0.0 && x->dS[a] == 0.0)
        continue;
      const PetscInt k = axis == 0 ? x->base + a - hat.base : y->base + b - hat.base;
      const double   w = k >= 0 && k < 3 ? hat.S[k] : 0.0;

      N[n++] = w * (axis == 0 ? y->S[b] : x->S[a]);
    }
  }
}

void FacePlace(const Case *c, const Grid *g, const Particles *P, const Stencil *stencil, Face *f)
{
  const PetscInt p    = f->particle;
  const int      axis = side_axis[f->side], tangent = 1 - axis;
  const double   arm = side_sign[f->side] * P->f[P_L + axis][p], position = P->f[P_X + axis][p] + arm;
  const double   radius = P->f[P_X][p] + (axis == 0 ? arm : 0.0);

  f->r[axis]    = position - AxisCentroid(&stencil->axis[axis], g->lower[axis], g->h[axis]);
  f->r[tangent] = 0.0;
  f->area       = 2.0 * P->f[P_L + tangent][p] * (c->axisymmetric ? 2.0 * M_PI * radius : 1.0);
  f->n[axis]    = side_sign[f->side] * f->area;
  f->n[tangent] = 0.0;
  Weights(g, c->basis, stencil, axis, position, f->N);
}

static void MakeFace(const Case *c, const Grid *g, const Particles *P, const Stencil *stencil, PetscInt p, int side,
                     Face *f)
{
  f->particle    = p;
  f->side        = side;
  f->region      = P->i[PI_REGION][p];
  f->x0[0]       = ParticleInitialX(P, p, 0);
  f->x0[1]       = ParticleInitialX(P, p, 1);
  f->share       = FaceShare(c, f->region, f->x0, side);
  f->traction    = FindCondition(c, BC_TRACTION, f);
  f->pressure    = FindCondition(c, BC_PRESSURE, f);
  f->heat        = FindCondition(c, BC_HEAT_FLUX, f);
  f->convection  = FindCondition(c, BC_CONVECTION, f);
  f->temperature = FindCondition(c, BC_FACE_TEMPERATURE, f);
  f->inflow      = FindCondition(c, BC_INFLOW, f);
  f->meters      = FindMeters(c, f);
  FacePlace(c, g, P, &stencil[p], f);
}

PetscErrorCode FacesBuild(const Case *c, const Grid *g, const Particles *P, const Stencil *stencil, PetscInt *n,
                          Face **face)
{
  PetscInt count = 0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    for (int side = 0; side < SIDE_COUNT; side++)
      count += (P->i[PI_FACES][p] >> side) & 1;
  }
  if (count != *n || !*face) {
    PetscCall(PetscFree(*face));
    PetscCall(PetscMalloc1(PetscMax(count, 1), face));
  }
  *n    = count;
  count = 0;
  for (PetscInt p = 0; p < P->n; p++) {
    for (int side = 0; side < SIDE_COUNT; side++) {
      if ((P->i[PI_FACES][p] >> side) & 1)
        MakeFace(c, g, P, stencil, p, side, &(*face)[count++]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
