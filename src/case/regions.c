/* regions: the shapes of the body and what refers to places on it: their faces, heaters, probes. */
#include "case_private.h"
#include "clathra/geometry.h"
#include "clathra/shape.h"
#include "clathra/words.h"
#include <string.h>

static const char *const shape_key[] = {"lower", "polygon", "below", "circle"};

/* The last shape that is given; how many are. */
static int ShapeOf(const Region *g, ShapeKind *shape)
{
  const bool given[] = {false, g->polygon.n > 0, g->below.n > 0, !isinf(g->circle[2])};
  int        n       = 0;

  *shape = SHAPE_BOX;
  for (int s = SHAPE_POLYGON; s <= SHAPE_CIRCLE; s++) {
    n += given[s];
    if (given[s])
      *shape = (ShapeKind)s;
  }
  return n;
}

void RegionsFinish(Scene *c)
{
  for (PetscInt k = 0; k < c->nregion; k++) {
    (void)ShapeOf(&c->region[k], &c->region[k].shape);
    RegionBound(c, &c->region[k]);
  }
}

/* ---------------------------------------------------------------- one shape */
static void CheckPolygon(Reader *r, const Region *g)
{
  const double *x = g->polygon.x;
  PetscInt      pair[2];

  if (g->polygon.n < 3)
    FAIL_AT(GROUP_REGION, g->name, "polygon", "has %d points, needs at least 3", (int)g->polygon.n);
  else if (PolygonCrosses(g->polygon.n, x, pair))
    FAIL_AT(GROUP_REGION, g->name, "polygon",
            "crosses itself: the sides that begin at (%g m, %g m) and (%g m, %g m) meet (it closes by itself)",
            x[2 * pair[0]], x[2 * pair[0] + 1], x[2 * pair[1]], x[2 * pair[1] + 1]);
}

/* A line of at least two points. */
static bool CheckPoints(Reader *r, Group group, const char *name, const char *key, const Points *line)
{
  if (line->n < 2)
    FAIL_AT(group, name, key, "has %d point, needs at least 2", (int)line->n);
  return line->n >= 2;
}

static void CheckBelow(Reader *r, const Region *g)
{
  if (!CheckPoints(r, GROUP_REGION, g->name, "below", &g->below))
    return;
  for (PetscInt k = 2; k < 2 * g->below.n; k += 2) {
    if (g->below.x[k] > g->below.x[k - 2])
      continue;
    FAIL_AT(GROUP_REGION, g->name, "below", "must ascend in x (%g m after %g m)", g->below.x[k], g->below.x[k - 2]);
    return;
  }
}

static void CheckCircle(Reader *r, const Region *g)
{
  if (!isfinite(g->circle[0]) || !isfinite(g->circle[1]) || !(g->circle[2] > 0.0))
    FAIL_AT(GROUP_REGION, g->name, "circle", "needs a centre and a positive radius, is (%g m, %g m), %g m",
            g->circle[0], g->circle[1], g->circle[2]);
}

/* The region lies in the grid. */
static void CheckBounds(Reader *r, const Scene *c, const Region *g)
{
  const char *key = shape_key[g->shape];

  for (int d = 0; d < CL_DIM; d++) {
    const double slack = 1e-12 * (fabs(c->upper[d]) + fabs(c->lower[d]));

    if (g->upper[d] <= g->lower[d] && g->shape == SHAPE_BOX)
      FAIL_AT(GROUP_REGION, g->name, "upper", "must lie above lower on all axes (%g m <= %g m)", g->upper[d],
              g->lower[d]);
    else if (g->upper[d] <= g->lower[d])
      FAIL_AT(GROUP_REGION, g->name, key, "nothing of it lies between lower and upper along %c", "xyz"[d]);
    else if (!r->bad[GROUP_CASE] && c->upper[d] > c->lower[d] &&
             (g->lower[d] < c->lower[d] - slack || g->upper[d] > c->upper[d] + slack))
      FAIL_AT(GROUP_REGION, g->name, g->shape == SHAPE_BOX && g->upper[d] > c->upper[d] ? "upper" : key,
              "the region leaves the grid along %c: %g..%g m is not in %g..%g m", "xyz"[d], g -> lower[d],
              g -> upper[d], c -> lower[d], c -> upper[d]);
  }
}

/* A shape without particles must be cut out of another region, hold temperatures, be heated or what a mean is over. */
static bool Serves(const Case *c, PetscInt region)
{
  for (PetscInt k = 0; k < c->nprobe; k++) {
    if (c->probe[k].over == region)
      return true;
  }
  for (PetscInt k = 0; k < c->scene.nbc; k++) {
    const Bc *b = &c->scene.bc[k];

    if ((b->type == BC_REGION_TEMPERATURE || b->type == BC_HEAT_SOURCE) && b->region == region)
      return true;
  }
  for (PetscInt k = 0; k < c->scene.nregion; k++) {
    for (PetscInt m = 0; m < c->scene.region[k].minus.n; m++) {
      if (c->scene.region[k].minus.i[m] == region)
        return true;
    }
  }
  return false;
}

static void CheckShape(Reader *r, const Case *c, PetscInt region)
{
  const Region  *g      = &c->scene.region[region];
  const PetscInt before = r->nerror;
  ShapeKind      shape;

  if (ShapeOf(g, &shape) > 1)
    FAIL_AT(GROUP_REGION, g->name, shape_key[shape],
            "is one shape too many: a region has a polygon, below, circle or box");
  else if (shape == SHAPE_POLYGON)
    CheckPolygon(r, g);
  else if (shape == SHAPE_BELOW)
    CheckBelow(r, g);
  else if (shape == SHAPE_CIRCLE)
    CheckCircle(r, g);
  if (r->nerror == before)
    CheckBounds(r, &c->scene, g);
  for (PetscInt k = 0; k < g->minus.n; k++) {
    if (g->minus.i[k] == region)
      FAIL_AT(GROUP_REGION, g->name, "minus", "the region cannot be cut out of itself");
  }
  if (RegionEmpty(g) && !Serves(c, region))
    FAIL_AT(GROUP_REGION, g->name, "material",
            "is none, but no region has %s in its minus and no region_temperature, heat_source or probe names it",
            g->name);
}

bool ShapesGood(Reader *r, const Case *c)
{
  const PetscInt before = r->nerror;

  for (PetscInt k = 0; k < c->scene.nregion; k++)
    CheckShape(r, c, k);
  return r->nerror == before;
}

/* ---------------------------------------------------------------- their particles */
typedef struct {
  const Scene    *c;
  PetscInt        region;
  const Lattice  *lattice;
  const PetscInt *ij;
  const double   *x;
} Spot;

/* Is there a particle that `is` says yes to?  NULL: any. */
static bool AnyPlace(const Scene *c, PetscInt region, bool (*is)(const Spot *, const void *), const void *context)
{
  static const PetscInt first[CL_DIM] = {0};
  Lattice               lattice;
  PetscInt              ij[CL_DIM];
  double                x[CL_DIM];
  const Spot            place = {c, region, &lattice, ij, x};

  if (RegionEmpty(&c->region[region]))
    return false;
  RegionLattice(c, region, &lattice);
  for (PetscInt k = 0; k < BoxSize(lattice.n); k++) {
    BoxAt(first, lattice.n, k, ij);
    if (RegionPlace(c, region, &lattice, ij, x) && (!is || is(&place, context)))
      return true;
  }
  return false;
}

static bool IsInside(const Spot *place, const void *other)
{
  return RegionHolds(place->c, *(const PetscInt *)other, place->x);
}

/* Boxes by their sides, other shapes by the centres of particles. */
static bool Overlap(const Scene *c, PetscInt i, PetscInt j)
{
  const Region *g = &c->region[i], *o = &c->region[j];

  if (RegionEmpty(g) || RegionEmpty(o))
    return false;
  for (int d = 0; d < CL_DIM; d++) {
    if (!(fmin(g->upper[d], o->upper[d]) - fmax(g->lower[d], o->lower[d]) > 1e-9 * (g->upper[d] - g->lower[d])))
      return false;
  }
  if (RegionWhole(g) && RegionWhole(o))
    return true;
  return AnyPlace(c, i, IsInside, &j) || AnyPlace(c, j, IsInside, &i);
}

/* Region j of the list lies over region i, an earlier one, and wins: its shape is cut out of that. */
static PetscErrorCode Cut(const Reader *r, Case *c, PetscInt i, PetscInt j)
{
  Region   *g     = &c->scene.region[i];
  Names    *minus = &g->minus;
  PetscInt *more;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(minus->n + 1, &more));
  PetscCall(PetscArraycpy(more, minus->i, minus->n));
  more[minus->n++] = j;
  PetscCall(PetscFree(minus->i));
  minus->i = more;
  PetscCall(FindingSayOf(r->comm, FINDING_REGIONS_OVERLAP, r->file, NULL,
                         "region %s lies over region %s, which is cut out there: the later one in regions wins",
                         c->scene.region[j].name, g->name));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode RegionsCut(const Reader *r, Case *c)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->scene.nregion; i++) {
    for (PetscInt j = i + 1; j < c->scene.nregion; j++) {
      if (Overlap(&c->scene, i, j))
        PetscCall(Cut(r, c, i, j));
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

bool RegionsFilled(Reader *r, const Case *c)
{
  bool filled = true;

  for (PetscInt i = 0; i < c->scene.nregion; i++) {
    const Region *g = &c->scene.region[i];

    if (RegionEmpty(g) || AnyPlace(&c->scene, i, NULL, NULL))
      continue;
    FAIL_AT(GROUP_REGION, g->name, g->minus.n ? "minus" : shape_key[g->shape],
            "the region keeps no particle: no centre of one lies inside");
    filled = false;
  }
  return filled;
}

/* ---------------------------------------------------------------- faces */
static bool HasNamed(const Spot *p, const void *meters)
{
  const Meter *const *m    = (const Meter *const *)meters;
  const PetscInt      bits = RegionFaces(p->c, p->region, p->lattice, p->ij);

  for (int side = 0; side < SIDE_COUNT; side++) {
    if ((bits >> side & 1) && FaceNamed(p->c, m[0], p->region, p->x, side) &&
        FaceNamed(p->c, m[1], p->region, p->x, side))
      return true;
  }
  return false;
}

/* What the regions' boxes say, where all are whole. */
bool FacesShared(const Scene *c, const Meter *a, const Meter *b)
{
  const Meter *const both[] = {a, b};

  for (PetscInt i = 0; i < c->nregion; i++) {
    if (AnyPlace(c, i, HasNamed, both))
      return true;
  }
  return false;
}

static bool SideMeets(const Scene *c, const Meter *m)
{
  const int along = m->side == SIDE_XMIN || m->side == SIDE_XMAX ? 1 : 0;
  bool      meets = false, whole = !m->along.n;

  for (PetscInt i = 0; i < c->nregion; i++) {
    whole = whole && RegionWhole(&c->region[i]) && !RegionEmpty(&c->region[i]);
    if (m->region < 0 || m->region == i)
      meets |= m->from < c->region[i].upper[along] && m->to > c->region[i].lower[along];
  }
  if (whole)
    return meets;
  return FacesShared(c, m, m);
}

void CheckFaces(Reader *r, const Scene *c, Group g, const char *name, const Meter *m)
{
  if (m->along.n) {
    if (m->side != SIDE_COUNT)
      FAIL_AT(g, name, "side", "and along are two ways to name faces: give one");
    else if (isfinite(m->from) || isfinite(m->to))
      FAIL_AT(g, name, isfinite(m->from) ? "from" : "to", "goes with side, not with along");
    else if (CheckPoints(r, g, name, "along", &m->along) && !SideMeets(c, m))
      FAIL_AT(g, name, "along", "no face of the body lies on this line, within %g particle spacings", LINE_REACH);
    return;
  }
  if (m->side == SIDE_COUNT)
    FAIL_AT(g, name, "side", "is none, and along is not given");
  else if (m->to <= m->from)
    FAIL_AT(g, name, "to", "must lie above from (%g m <= %g m)", m->to, m->from);
  else if (!SideMeets(c, m))
    FAIL_AT(g, name, "from", "and to: no part of the body's side lies between %g m and %g m", m->from, m->to);
}

/* ---------------------------------------------------------------- points */
void CheckSource(Reader *r, const Scene *c, const Bc *b)
{
  for (PetscInt i = 0; i < c->nregion; i++) {
    if (b->region < 0 || b->region == i ? AnyPlace(c, i, NULL, NULL)
                                        : RegionEmpty(&c->region[b->region]) && AnyPlace(c, i, IsInside, &b->region))
      return;
  }
  FAIL_AT(GROUP_BC, b->name, "region", "%s has no particle to heat: no centre of one lies inside",
          c->region[b->region].name);
}

/* A region whose temperature is held must hold a node. */
void CheckHeld(Reader *r, const Scene *c, const Bc *b)
{
  for (PetscInt i = 0; i < c->nregion; i++) {
    const Region *g = &c->region[i];
    GridLines     line[CL_DIM];
    double        slack[CL_DIM], x[CL_DIM];
    PetscInt      from[CL_DIM], nodes[CL_DIM], at[CL_DIM], all;

    if (b->region >= 0 && b->region != i)
      continue;
    for (int d = 0; d < CL_DIM; d++) {
      line[d]  = SceneLines(c, d);
      slack[d] = 1e-6 * line[d].h;
      from[d]  = (PetscInt)ceil(LinesPlace(&line[d], g->lower[d]) - 1e-6);
      nodes[d] = PetscMax((PetscInt)floor(LinesPlace(&line[d], g->upper[d]) + 1e-6) - from[d] + 1, 0);
    }
    all = BoxSize(nodes);
    for (PetscInt k = 0; k < all; k++) {
      BoxAt(from, nodes, k, at);
      for (int d = 0; d < CL_DIM; d++)
        x[d] = LinesAt(&line[d], at[d]);
      if (RegionReaches(c, i, x, slack))
        return;
    }
  }
  FAIL_AT(GROUP_BC, b->name, "region",
          "has no node of the grid in its shape: refine the grid, or let the shape follow its lines");
}

/* A point lies in the body. */
static void CheckPoint(Reader *r, const Scene *c, const Probe *p)
{
  double slack[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    slack[d] = 1e-6 * SceneLines(c, d).h;
  for (PetscInt i = 0; i < c->nregion; i++) {
    if (!RegionEmpty(&c->region[i]) && RegionReaches(c, i, p->x, slack))
      return;
  }
  FAIL_AT(GROUP_PROBE, p->name, "at", "%s lies in no region", PlaceWords(p->x).s);
}

typedef struct {
  const Scene *c;
  PetscInt     region;
} Within;

static bool LiesWithin(const Spot *p, const void *context)
{
  const Within *w = (const Within *)context;

  return RegionHolds(w->c, w->region, p->x);
}

/* A region without particles holds some of another's. */
static void CheckOver(Reader *r, const Scene *c, const Probe *p)
{
  const Within w     = {c, p->over};
  bool         holds = !RegionEmpty(&c->region[p->over]);

  for (PetscInt i = 0; i < c->nregion && !holds; i++)
    holds = !RegionEmpty(&c->region[i]) && AnyPlace(c, i, LiesWithin, &w);
  if (!holds)
    FAIL_AT(GROUP_PROBE, p->name, "over", "region %s holds no particle", c->region[p->over].name);
}

void CheckProbe(Reader *r, const Scene *c, const Probe *p)
{
  const bool point = isfinite(p->x[0]) || isfinite(p->x[1]), over = p->over >= 0,
             surface = p->surface.side != SIDE_COUNT || p->surface.along.n;
  const Meter *m     = &p->surface;

  if (point + over + surface > 1)
    FAIL_AT(GROUP_PROBE, p->name, point ? "at" : "over",
            "is one of three: a point (at), a region (over), a surface (side or along)");
  else if (!surface && (m->region >= 0 || isfinite(m->from) || isfinite(m->to)))
    FAIL_AT(GROUP_PROBE, p->name,
            m->region >= 0      ? "region"
            : isfinite(m->from) ? "from"
                                : "to",
            "goes with side or along");
  else if (surface && p->fixed)
    FAIL_AT(GROUP_PROBE, p->name, "fixed", "goes with at or over: a surface moves with the body");
  else if (point)
    CheckPoint(r, c, p);
  else if (over)
    CheckOver(r, c, p);
  else
    CheckFaces(r, c, GROUP_PROBE, p->name, m);
}
