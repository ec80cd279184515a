/* Surface faces: their geometry, and which conditions act on them. */
#include "clathra/boundary.h"
#include "clathra/shape.h"
#include <string.h>

/* Last condition of a type on this face; later ones in the case win. */
static PetscInt FindCondition(const Scene *c, BcType type, const Face *f)
{
  PetscInt found = -1;

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc *b = &c->bc[k];

    if (b->type == type && FaceNamed(c, &BcFaces(b), f->region, f->x0, f->side))
      found = k;
  }
  return found;
}

double FaceLoad(const Scene *c, Side side, PetscInt region, const double x[CL_DIM], double t)
{
  Face f = {.side = (int)side, .region = region};

  memcpy(f.x0, x, sizeof(f.x0));
  const PetscInt k = FindCondition(c, BC_TRACTION, &f);

  return k < 0 ? 0.0 : ScheduleValue(&c->bc[k].value, t);
}

static unsigned FindMeters(const Scene *c, const Face *f)
{
  unsigned meters = 0;

  for (PetscInt k = 0; k < c->nmeter; k++)
    meters |= (unsigned)FaceNamed(c, &c->meter[k], f->region, f->x0, f->side) << k;
  return meters;
}

#define POINT 1e-5 /* of a cell: shorter than that along an axis a face counts as a point there */

/* Along one axis, m. */
typedef struct {
  double middle, half;
} Span;

/* Along one axis what is inside the particle's domain of a face that spans `all`, and how many cells that is. */
static double Inside(BasisType type, const GridLines *line, const Particles *P, const Face *f, int d, Span all,
                     Span *inside)
{
  const double p = ParticleGridX(P, f->particle, d), half = P->f[P_L + d][f->particle];

  if (line->x) {
    const BasisSpan dom = BasisSpanOf(type, line, p, half);
    const double    lo  = fmin(fmax(LinesPlace(line, all.middle - all.half), dom.lo), dom.hi),
                 hi     = fmin(fmax(LinesPlace(line, all.middle + all.half), dom.lo), dom.hi);

    inside->middle = 0.5 * (LinesFrom(line, lo) + LinesFrom(line, hi));
    inside->half   = 0.5 * (LinesFrom(line, hi) - LinesFrom(line, lo));
    return hi - lo;
  }
  const double      h = line->h, lower = line->lower, at = (all.middle - lower) / h, r = all.half / h;
  const BasisDomain dom = BasisDomainOf(type, p, half, lower, h, (double)line->cells);
  const double      lo = fmin(fmax(at - r, dom.lo), dom.hi), hi = fmin(fmax(at + r, dom.lo), dom.hi);

  inside->middle = lower + 0.5 * (lo + hi) * h;
  inside->half   = 0.5 * (hi - lo) * h;
  return hi - lo;
}

/* Weights along one axis: of the interval inside the particle's domain, whose nodes are the only ones it may use; a hat
   function where that is a point. */
static void AxisWeights(const Scene *c, const Grid *g, const Particles *P, const Face *f, int d, Span all, Axis *a)
{
  const GridLines *line = &g->line[d];
  double           hoop[3], r;
  Span             in;

  if (Inside(c->basis, line, P, f, d, all, &in) < POINT)
    BasisHat(in.middle, line, a);
  else if (d == 0 && c->axisymmetric)
    BasisRadius(BASIS_UGIMP, in.middle, in.half, line, a, hoop, &r);
  else
    BasisAxis(BASIS_UGIMP, in.middle, in.half, line, a);
}

/* Products of the axes' weights, in the order of StencilExpand. */
static void SpreadWeights(const Stencil *st, double w[CL_DIM][3], Face *f)
{
  int       at[CL_NODES][CL_DIM];
  const int n = StencilNodes(st, at);

  for (int a = 0; a < n; a++) {
    f->N[a] = 1.0;
    for (int d = 0; d < CL_DIM; d++)
      f->N[a] *= w[d][at[a][d]];
    f->Nr[a] = f->Nm[PHASE_W][a] = f->Nm[PHASE_G][a] = f->N[a];
  }
}

/* at, half: middle of the face in the grid's configuration and how far it reaches along each axis, m.  A linear
   particle does not reach the nodes of its face, which then acts at the particle. */
static void Weights(const Scene *c, const Grid *g, const Particles *P, const Stencil *st, const double at[CL_DIM],
                    const double half[CL_DIM], Face *f)
{
  double w[CL_DIM][3];

  for (int d = 0; d < CL_DIM; d++) {
    Axis a = st->axis[d];

    if (c->basis != BASIS_LINEAR)
      AxisWeights(c, g, P, f, d, (Span){at[d], half[d]}, &a);
    for (int k = 0; k < 3; k++) {
      const PetscInt i = st->axis[d].base + k - a.base;

      w[d][k] = i >= 0 && i < 3 ? a.S[i] : 0.0;
    }
  }
  SpreadWeights(st, w, f);
}

/* (197), (198): of the faces of a hole about the axis on which something is prescribed. */
static void Ring(const Scene *c, const Grid *g, const Particles *P, double radius, Face *f)
{
  const bool   hole = c->axisymmetric && f->side == SIDE_XMIN;
  const double l    = P->f[P_L][f->particle];

  f->ring[0] = hole && f->bc[BC_PRESSURE] >= 0 ? FaceRing(c, g, radius, l, 0.0) : 0.0;
  f->ring[1] = hole && f->bc[BC_FACE_TEMPERATURE] >= 0 ? FaceRing(c, g, radius, l, FACE_PENALTY) : 0.0;
}

/* Mean pore pressure at the face as the particle's own values and gradients have it, Pa. */
static double FacePore(const Scene *c, const Particles *P, const Face *f)
{
  const PetscInt p = f->particle;
  double         pore;

  if (!c->fields.phase[PHASE_W])
    return 0.0;
  const double sg = P->f[P_SW] ? 1.0 - P->f[P_SW][p] / (1.0 - P->f[P_SH][p]) : 0.0;

  pore = ParticlePressure(P, p);
  for (int d = 0; d < CL_DIM; d++) {
    const double gw = P->f[P_GW + d][p], gg = P->f[P_GG] ? P->f[P_GG + d][p] : gw;

    pore += ((1.0 - sg) * gw + sg * gg) * (f->x[d] - P->f[P_X + d][p]);
  }
  return pore;
}

/* A well or a source acts in its particle, wherever that is. */
static void PlaceInside(const Particles *P, const Stencil *st, Face *f)
{
  double w[CL_DIM][3];

  for (int d = 0; d < CL_DIM; d++) {
    f->x[d] = P->f[P_X + d][f->particle];
    for (int k = 0; k < 3; k++)
      w[d][k] = st->axis[d].S[k];
  }
  SpreadWeights(st, w, f);
}

void ParticleStencil(const Scene *c, const Grid *g, const Particles *P, PetscInt p, Stencil *s)
{
  s->r = 0.0;
  for (int d = 0; d < CL_DIM; d++) {
    const GridLines *line = &g->line[d];
    const double     x = ParticleGridX(P, p, d), l = P->f[P_L + d][p];

    if (d == 0 && c->axisymmetric)
      BasisRadius(c->basis, x, l, line, &s->axis[d], s->hoop, &s->r);
    else
      BasisAxis(c->basis, x, l, line, &s->axis[d]);
    s->cell[d] = BasisCellAt(line, x, &s->axis[d]);
  }
}

void ParticleCentroid(const Grid *g, const Particles *P, PetscInt p, const Stencil *s, double at[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    at[d] = AxisCentroid(&s->axis[d], &g->line[d]);
  if (!P->total)
    return;
  for (int d = 0; d < CL_DIM; d++)
    at[d] -= ParticleGridX(P, p, d);
  ParticleCarry(P, p, at);
  for (int d = 0; d < CL_DIM; d++)
    at[d] += P->f[P_X + d][p];
}

void FacePlace(const Scene *c, const Grid *g, const Particles *P, Face *f)
{
  Stencil s;

  ParticleStencil(c, g, P, f->particle, &s);
  if (f->share > 0.0) {
    PlaceInside(P, &s, f);
    return;
  }
  const PetscInt p    = f->particle;
  const int      axis = SideAxis(f->side);
  const double   sign = SideSign(f->side);
  double F[CL_DIM][CL_DIM], cof[CL_DIM][CL_DIM], l[CL_DIM], at[CL_DIM], half[CL_DIM], A = 1.0; /* of the face, m^2 */

  ParticlesInitialHalfLength(c, f->region, f->x0, l);
  ParticleDeformation(P, p, F);
  CofactorOf(F, cof);
  ParticleCentroid(g, P, p, &s, at);
  for (int d = 0; d < CL_DIM; d++) {
    f->x[d]     = P->f[P_X + d][p] + sign * F[d][axis] * l[axis];
    f->r[d]     = f->x[d] - at[d];
    f->moved[d] = f->x[d] - f->x0[d] - (d == axis ? sign * l[axis] : 0.0);
    A *= d == axis ? 1.0 : 2.0 * l[d];
  }
  for (int d = 0; d < CL_DIM; d++) {
    at[d]   = P->total ? f->x[d] - f->moved[d] : f->x[d];
    half[d] = 0.0;
    for (int t = 0; t < CL_DIM; t++)
      half[d] += t == axis ? 0.0 : (P->total ? d == t : fabs(F[d][t])) * l[t];
  }
  f->a0 = A * (c->axisymmetric ? 2.0 * M_PI * (f->x[0] - f->moved[0]) : 1.0);
  A *= c->axisymmetric ? 2.0 * M_PI * f->x[0] : 1.0;
  for (int i = 0; i < CL_DIM; i++) { /* a <- cof(F) a */
    f->n[i] = sign * A * cof[i][axis];
    f->s[i] = A * VectorDot(cof[i], f->n0);
  }
  Weights(c, g, P, &s, at, half, f);
  Ring(c, g, P, at[0], f);
  f->pore            = FacePore(c, P, f);
  f->leaves[PHASE_W] = f->leaves[PHASE_G] = false;
}

#define MOBILE 1e-3 /* k_r from which on what is let in can flow on */

void FaceInflow(Face *f, int n, const double *S, const double kr[PHASE_COUNT])
{
  double sum = 0.0;

  if (f->bc[BC_INFLOW] < 0 || f->bc[BC_PRESSURE] >= 0)
    return;
  for (int a = 0; a < n; a++)
    sum += f->N[a];
  for (int k = 0; k < PHASE_COUNT; k++) {
    const double share = fmin(1.0, kr[k] / MOBILE);

    for (int a = 0; a < n; a++)
      f->Nm[k][a] = share * f->N[a] + (1.0 - share) * sum * S[a];
  }
}

static void MakeFace(const Scene *c, const Grid *g, const Particles *P, PetscInt p, int side, Face *f)
{
  *f = (Face){.particle = p, .side = side, .region = P->i[PI_REGION][p], .bc = {[BC_NONE] = -1}};
  ParticleInitialPlace(P, p, f->x0);
  for (int kind = BC_NONE + 1; kind < BC_FACES; kind++)
    f->bc[kind] = BC_INSIDE >> kind & 1u ? -1 : FindCondition(c, (BcType)kind, f);
  f->meters = FindMeters(c, f);
  FaceNormal(c, f->region, f->x0, side, f->n0);
  FacePlace(c, g, P, f);
}

/* Volume of a particle at the start, m^3 (per metre of thickness in the plane), if a heat source is in it, else 0. */
static double Heated(const Scene *c, const Particles *P, const Bc *b, PetscInt p)
{
  const PetscInt own = P->i[PI_REGION][p];
  double         x0[CL_DIM], l[CL_DIM];

  ParticleInitialPlace(P, p, x0);
  if (b->region >= 0 && b->region != own && !(RegionEmpty(&c->region[b->region]) && RegionHolds(c, b->region, x0)))
    return 0.0;
  ParticlesInitialHalfLength(c, own, x0, l);
  return ParticleInitialVolume(c, x0, l);
}

/* What a condition inside the body, a well or a heat source, has of particle p: Face.share. */
static double ShareOf(const Scene *c, const Particles *P, const Bc *b, const Well *well, PetscInt p)
{
  double x0[CL_DIM], l[CL_DIM];

  if (b->type == BC_HEAT_SOURCE)
    return Heated(c, P, b, p);
  ParticleInitialPlace(P, p, x0);
  ParticlesInitialHalfLength(c, P->i[PI_REGION][p], x0, l);
  return WellShare(well, x0, l);
}

static void MakeInsideFace(const Scene *c, const Grid *g, const Particles *P, PetscInt p, PetscInt k, double share,
                           Face *f)
{
  *f = (Face){.particle = p, .side = SIDE_COUNT, .region = P->i[PI_REGION][p], .share = share};
  ParticleInitialPlace(P, p, f->x0);
  for (int kind = 0; kind < BC_FACES; kind++)
    f->bc[kind] = kind == (int)c->bc[k].type ? k : -1;
  for (PetscInt i = 0; i < c->nmeter; i++)
    f->meters |= (unsigned)(c->meter[i].well == c->bc[k].number) << i;
  FacePlace(c, g, P, f);
}

/* Adds the particles of condition k, a well or a heat source, to n faces of so many that there is room for. */
static PetscErrorCode InsideFaces(const Scene *c, const Grid *g, const Particles *P, PetscInt k, PetscInt *n,
                                  Face **face)
{
  const Bc *b     = &c->bc[k];
  PetscInt  count = 0, at = *n;
  Well      well;

  PetscFunctionBeginUser;
  if (b->type == BC_WELL && !WellPlace(c, b, &well))
    PetscFunctionReturn(PETSC_SUCCESS);
  for (PetscInt p = 0; p < P->n; p++)
    count += ShareOf(c, P, b, &well, p) > 0.0;
  if (!count)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscRealloc((size_t)(at + count) * sizeof(Face), face));
  for (PetscInt p = 0; p < P->n; p++) {
    const double    share = ShareOf(c, P, b, &well, p);
    const Material *mat   = &c->material[c->region[P->i[PI_REGION][p]].material];

    if (!(share > 0.0))
      continue;
    MakeInsideFace(c, g, P, p, k, share, &(*face)[at]);
    if (b->type == BC_WELL)
      (*face)[at].draws = b->index * sqrt(WellRatio(&well, &mat->permeability)) * share * WellLength(&well);
    at++;
  }
  *n = at;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FacesBuild(const Scene *c, const Grid *g, const Particles *P, PetscInt *n, Face **face)
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
        MakeFace(c, g, P, p, side, &(*face)[count++]);
    }
  }
  for (PetscInt k = 0; k < c->nbc; k++) {
    if (BC_INSIDE >> c->bc[k].type & 1u)
      PetscCall(InsideFaces(c, g, P, k, n, face));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
