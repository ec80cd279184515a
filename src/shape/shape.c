/* What a region holds: a box, a polygon, what lies below a line, or a circle, inside its bounds, without others. */
#include "clathra/shape.h"
#include "clathra/geometry.h"
#include <string.h>

/* Points are judged a little off their place (of a cell), so that round-off decides nothing: a point on an edge goes
   to the region above or to the right of it. */
#define NUDGE 1e-7
#define ROUND 1e-9 /* of a cell: an edge of a place so close to a line lies on it */
/* Of a place: a box with less than that beyond the last edge of the filling stretches the place before it; where there
   is one place a cell, a longer domain would act shorter than it is. */
#define LEAST_PLACE 0.25
#define LEAST_ONLY 0.05
#define ON_CIRCLE 1e-9 /* of the radius: on it is outside */

static void Bounds(const Points *points, double lower[], double upper[])
{
  for (int d = 0; d < 2; d++) {
    lower[d] = INFINITY;
    upper[d] = -INFINITY;
    for (PetscInt k = 0; k < points->n; k++) {
      lower[d] = fmin(lower[d], points->x[2 * k + d]);
      upper[d] = fmax(upper[d], points->x[2 * k + d]);
    }
  }
}

void RegionBound(const Scene *c, Region *r)
{
  double lower[CL_DIM], upper[CL_DIM];

  memcpy(lower, c->lower, sizeof(lower));
  memcpy(upper, c->upper, sizeof(upper));

  if (r->shape == SHAPE_POLYGON)
    Bounds(&r->polygon, lower, upper);
  if (r->shape == SHAPE_BELOW) {
    Bounds(&r->below, lower, upper);
    lower[1] = c->lower[1];
  }
  for (int d = 0; d < CL_DIM; d++) {
    if (r->shape == SHAPE_CIRCLE && d < 2) {
      lower[d] = r->circle[d] - r->circle[2];
      upper[d] = r->circle[d] + r->circle[2];
    }
    if (r->shape != SHAPE_BOX || !isfinite(r->lower[d]))
      r->lower[d] = fmax(r->lower[d], lower[d]);
    if (r->shape != SHAPE_BOX || !isfinite(r->upper[d]))
      r->upper[d] = fmin(r->upper[d], upper[d]);
  }
}

/* The region's own shape, before `minus`. */
static bool Holds(const Scene *c, const Region *r, const double x[])
{
  static const double share[] = {1.0, 0.618, 0.382};
  double              y[CL_DIM];

  for (int d = 0; d < CL_DIM; d++) {
    const GridLines line = SceneLines(c, d);

    y[d] = x[d] + share[d] * NUDGE * LinesWidthAt(&line, x[d]);
  }
  for (int d = 0; d < CL_DIM; d++) {
    if (!(y[d] >= r->lower[d] && y[d] < r->upper[d]))
      return false;
  }
  switch (r->shape) {
  case SHAPE_POLYGON:
    return PolygonHolds(r->polygon.n, r->polygon.x, y);
  case SHAPE_BELOW:
    return LineCovers(r->below.n, r->below.x, y);
  case SHAPE_CIRCLE:
    return hypot(x[0] - r->circle[0], x[1] - r->circle[1]) < (1.0 - ON_CIRCLE) * r->circle[2];
  default:
    return true;
  }
}

bool RegionHolds(const Scene *c, PetscInt region, const double x[])
{
  const Region *r = &c->region[region];

  if (!Holds(c, r, x))
    return false;
  for (PetscInt k = 0; k < r->minus.n; k++) {
    if (Holds(c, &c->region[r->minus.i[k]], x))
      return false;
  }
  return true;
}

PetscInt RegionAt(const Scene *c, const double x[])
{
  for (PetscInt k = 0; k < c->nregion; k++) {
    if (!RegionEmpty(&c->region[k]) && RegionHolds(c, k, x))
      return k;
  }
  return -1;
}

bool RegionReaches(const Scene *c, PetscInt region, const double x[], const double slack[])
{
  const Region *r = &c->region[region];

  for (int d = 0; d < CL_DIM; d++) {
    if (!(x[d] > r->lower[d] - slack[d] && x[d] < r->upper[d] + slack[d]))
      return false;
  }
  if (RegionWhole(r))
    return true;
  double y[CL_DIM];
  for (int d = 0; d < CL_DIM; d++) /* shapes are prisms: along z there is an inside */
    y[d] = d < 2 ? x[d] : fmin(fmax(x[d], r->lower[d]), r->upper[d] - slack[d]);
  if (RegionHolds(c, region, y))
    return true;
  for (int k = 0; k < 16; k++) { /* in all directions, as a boundary has no side to prefer */
    y[0] = x[0] + slack[0] * cos(k * M_PI / 8.0);
    y[1] = x[1] + slack[1] * sin(k * M_PI / 8.0);
    if (RegionHolds(c, region, y))
      return true;
  }
  return false;
}

double RegionHighest(const Region *r, const double direction[])
{
  const Points *points = r->shape == SHAPE_POLYGON ? &r->polygon : &r->below;
  const double  foot   = fmax(direction[0] * r->lower[0], direction[0] * r->upper[0]) + direction[1] * r->lower[1];
  double        box = 0.0, along = 0.0, shape = r->shape == SHAPE_BELOW ? foot : -INFINITY;

  for (int d = 0; d < CL_DIM; d++)
    box += fmax(direction[d] * r->lower[d], direction[d] * r->upper[d]);
  for (int d = 2; d < CL_DIM; d++) /* of a prism */
    along += fmax(direction[d] * r->lower[d], direction[d] * r->upper[d]);
  if (r->shape == SHAPE_BOX)
    return box;
  for (PetscInt k = 0; k < points->n; k++)
    shape = fmax(shape, points->x[2 * k] * direction[0] + points->x[2 * k + 1] * direction[1]);
  if (r->shape == SHAPE_CIRCLE)
    shape =
        r->circle[0] * direction[0] + r->circle[1] * direction[1] + r->circle[2] * hypot(direction[0], direction[1]);
  return fmin(box, shape + along);
}

void RegionExtreme(const Scene *c, const Region *g, double sign, double x[CL_DIM])
{
  double up[CL_DIM];

  SceneUp(c, sign, up);
  const double reach = RegionHighest(g, up);

  for (int d = 0; d < CL_DIM; d++)
    x[d] = up[d] * reach;
}

/* Height of the body's highest point (sign 1), or minus that of its lowest (-1). */
static double SceneReach(const Scene *c, double sign)
{
  double reach = -INFINITY, x[CL_DIM];

  if (SceneGravity(c) == 0.0)
    return 0.0;
  for (PetscInt i = 0; i < c->nregion; i++) {
    if (RegionEmpty(&c->region[i]))
      continue;
    RegionExtreme(c, &c->region[i], sign, x);
    reach = fmax(reach, sign * SceneHeight(c, x));
  }
  return reach;
}

double SceneTop(const Scene *c)
{
  return SceneReach(c, 1.0);
}

double SceneFoot(const Scene *c)
{
  return -SceneReach(c, -1.0);
}

double SceneDatum(const Scene *c, double datum)
{
  return isinf(datum) ? SceneTop(c) : datum;
}

/* ---------------------------------------------------------------- places */
/* Where cells differ the places are those of a regular filling of the cells, by which domains end on lines; a box cuts
   or stretches the outermost to its sides. */
static void LatticeUnequal(const Scene *c, const Region *r, int d, Lattice *lattice)
{
  const GridLines *line = &lattice->line[d];
  const double     ppc  = (double)r->ppc[d];
  const double lower = LinesPlace(line, r->lower[d]) * ppc, upper = LinesPlace(line, r->upper[d]) * ppc; /* places */
  const bool   box   = r->shape == SHAPE_BOX;
  const double least = r->ppc[d] > 1 ? LEAST_PLACE : LEAST_ONLY;
  PetscInt     first = PetscMax((PetscInt)floor(lower + ROUND), 0), last = (PetscInt)ceil(upper - ROUND);

  if (box) {
    first = (PetscInt)floor(lower + least);
    last  = PetscMax((PetscInt)ceil(upper - least), first + 1);
  }
  last                = PetscMin(last, c->cells[d] * r->ppc[d]);
  lattice->first[d]   = first;
  lattice->n[d]       = PetscMax(last - first, 0);
  lattice->spacing[d] = 1.0 / ppc;
  lattice->from[d]    = box ? lower / ppc : (double)first / ppc;
  lattice->to[d]      = box ? upper / ppc : (double)last / ppc;
}

void RegionLattice(const Scene *c, PetscInt region, Lattice *lattice)
{
  const Region *r = &c->region[region];

  for (int d = 0; d < CL_DIM; d++) {
    lattice->line[d] = SceneLines(c, d);
    if (lattice->line[d].x) {
      LatticeUnequal(c, r, d, lattice);
      continue;
    }
    const double length = r->upper[d] - r->lower[d], h = lattice->line[d].h, ppc = (double)r->ppc[d];

    if (r->shape == SHAPE_BOX) {
      lattice->first[d]   = 0;
      lattice->n[d]       = PetscMax((PetscInt)ceil(length / h * ppc - 1e-6), 1);
      lattice->from[d]    = r->lower[d];
      lattice->spacing[d] = length / (double)lattice->n[d];
      continue;
    }
    lattice->from[d]    = c->lower[d];
    lattice->spacing[d] = h / ppc;
    lattice->first[d]   = PetscMax((PetscInt)floor((r->lower[d] - c->lower[d]) / h * ppc), 0);
    lattice->n[d]       = PetscMin((PetscInt)ceil((r->upper[d] - c->lower[d]) / h * ppc), c->cells[d] * r->ppc[d]);
    lattice->n[d]       = PetscMax(lattice->n[d] - lattice->first[d], 0);
  }
}

/* Edge i of the places, m, where cells differ; beyond the ends one place after the other. */
static double LatticeEdge(const Lattice *lattice, int d, PetscInt i)
{
  const PetscInt n       = lattice->n[d];
  const double   spacing = lattice->spacing[d], regular = (double)(lattice->first[d] + i) * spacing;
  const double   s    = i <= 0   ? lattice->from[d] + (double)i * spacing
                        : i >= n ? lattice->to[d] + (double)(i - n) * spacing
                                 : regular;
  const double   line = rint(s);

  return LinesFrom(&lattice->line[d], fabs(s - line) < ROUND ? line : s);
}

/* Number of the place that holds x, also where there is none. */
static PetscInt LatticeIndex(const Lattice *lattice, int d, double x)
{
  if (!lattice->line[d].x)
    return (PetscInt)floor((x - lattice->from[d]) / lattice->spacing[d]) - lattice->first[d];
  const double   s = LinesPlace(&lattice->line[d], x), spacing = lattice->spacing[d];
  const PetscInt i = (PetscInt)floor(s / spacing) - lattice->first[d], n = lattice->n[d];

  if (s < lattice->from[d])
    return (PetscInt)floor((s - lattice->from[d]) / spacing);
  if (s >= lattice->to[d])
    return n + (PetscInt)floor((s - lattice->to[d]) / spacing);
  return PetscMin(PetscMax(i, 0), n - 1);
}

double LatticeWidth(const Lattice *lattice, int d, double x)
{
  if (!lattice->line[d].x)
    return lattice->spacing[d];
  const PetscInt i = LatticeIndex(lattice, d, x);

  return LatticeEdge(lattice, d, i + 1) - LatticeEdge(lattice, d, i);
}

bool RegionPlace(const Scene *c, PetscInt region, const Lattice *lattice, const PetscInt ij[], double x[])
{
  bool in = true;

  for (int d = 0; d < CL_DIM; d++) {
    x[d] = lattice->line[d].x ? 0.5 * (LatticeEdge(lattice, d, ij[d]) + LatticeEdge(lattice, d, ij[d] + 1))
                              : lattice->from[d] + ((double)(lattice->first[d] + ij[d]) + 0.5) * lattice->spacing[d];
    in   = in && ij[d] >= 0 && ij[d] < lattice->n[d];
  }
  return in && (RegionWhole(&c->region[region]) || RegionHolds(c, region, x));
}

/* Does the region have a particle at x, just outside a side, or one whose place is the next, centred at `next`? */
static bool Covers(const Scene *c, PetscInt region, const double x[], const double next[], bool of_box)
{
  const Region *r = &c->region[region];
  Lattice       lattice;
  PetscInt      ij[CL_DIM];
  double        centre[CL_DIM];

  if (RegionEmpty(r))
    return false;
  if (RegionWhole(r)) {
    bool in = true;

    for (int d = 0; d < CL_DIM; d++)
      in = in && x[d] >= r->lower[d] && x[d] <= r->upper[d];
    if (in)
      return true;
  }
  if (RegionWhole(r) && of_box)
    return false;
  if (RegionHolds(c, region, next))
    return true;
  RegionLattice(c, region, &lattice);
  for (int d = 0; d < CL_DIM; d++)
    ij[d] = LatticeIndex(&lattice, d, x[d]);
  return RegionPlace(c, region, &lattice, ij, centre);
}

PetscInt RegionFaces(const Scene *c, PetscInt region, const Lattice *lattice, const PetscInt ij[])
{
  PetscInt bits = 0;
  double   x[CL_DIM];

  (void)RegionPlace(c, region, lattice, ij, x);
  for (int side = 0; side < SIDE_COUNT; side++) {
    const int d = SideAxis(side), sign = (int)SideSign(side);
    PetscInt  beside[CL_DIM];
    double    next[CL_DIM], outside[CL_DIM];

    memcpy(beside, ij, sizeof(beside));
    memcpy(outside, x, sizeof(outside));
    beside[d] += sign;
    bool covered = RegionPlace(c, region, lattice, beside, next);

    outside[d] += sign * 1.001 * (0.5 * LatticeWidth(lattice, d, x[d]));
    for (PetscInt k = 0; k < c->nregion && !covered; k++)
      covered = k != region && Covers(c, k, outside, next, RegionWhole(&c->region[region]));
    if (!covered)
      bits |= 1 << side;
  }
  return bits;
}

/* ---------------------------------------------------------------- faces */
/* A way out of the region, from a to b, and the first boundary it crosses. */
typedef struct {
  const Scene *c;
  PetscInt     region;
  double       a[CL_DIM], b[CL_DIM], t, n[CL_DIM];
} WayOut;

/* A crossing counts when the region ends there. */
static void Try(WayOut *w, double t, double nx, double ny)
{
  const double step = 1e-3, length = hypot(nx, ny);
  double       in[CL_DIM], out[CL_DIM];

  if (!(t < w->t) || length == 0.0)
    return;
  for (int d = 0; d < CL_DIM; d++) {
    in[d]  = w->a[d] + (t - step) * (w->b[d] - w->a[d]);
    out[d] = w->a[d] + (t + step) * (w->b[d] - w->a[d]);
  }
  if (!RegionHolds(w->c, w->region, in) || RegionHolds(w->c, w->region, out))
    return;
  w->t    = t;
  w->n[0] = nx / length;
  w->n[1] = ny / length;
}

static void TryEdge(WayOut *w, const double p[], const double q[])
{
  double t;

  if (SegmentsMeet(w->a, w->b, p, q, &t))
    Try(w, t, q[1] - p[1], p[0] - q[0]);
}

/* |a + t (b - a) - centre| = radius */
static void TryCircle(WayOut *w, const double circle[])
{
  const double u[CL_DIM] = {w->b[0] - w->a[0], w->b[1] - w->a[1]},
               v[CL_DIM] = {w->a[0] - circle[0], w->a[1] - circle[1]};
  const double uu = u[0] * u[0] + u[1] * u[1], uv = u[0] * v[0] + u[1] * v[1];
  const double root = uv * uv - uu * (v[0] * v[0] + v[1] * v[1] - circle[2] * circle[2]);

  if (root < 0.0)
    return;
  for (int sign = -1; sign <= 1; sign += 2) {
    const double t = (-uv + sign * sqrt(root)) / uu;

    if (t >= 0.0 && t <= 1.0)
      Try(w, t, v[0] + t * u[0], v[1] + t * u[1]);
  }
}

static void TryShape(WayOut *w, const Region *r)
{
  const double box[10] = {r->lower[0], r->lower[1], r->upper[0], r->lower[1], r->upper[0],
                          r->upper[1], r->lower[0], r->upper[1], r->lower[0], r->lower[1]};

  for (PetscInt k = 0; r->shape == SHAPE_POLYGON && k < r->polygon.n; k++)
    TryEdge(w, r->polygon.x + 2 * k, r->polygon.x + 2 * ((k + 1) % r->polygon.n));
  for (PetscInt k = 0; r->shape == SHAPE_BELOW && k + 1 < r->below.n; k++)
    TryEdge(w, r->below.x + 2 * k, r->below.x + 2 * (k + 1));
  if (r->shape == SHAPE_CIRCLE)
    TryCircle(w, r->circle);
  for (int k = 0; k < 4; k++)
    TryEdge(w, box + 2 * k, box + 2 * (k + 1));
}

void FaceNormal(const Scene *c, PetscInt region, const double x[], int side, double n[])
{
  const Region *r    = &c->region[region];
  const int     d    = SideAxis(side);
  const double  sign = SideSign(side);
  WayOut        w    = {.c = c, .region = region, .t = INFINITY};
  Lattice       lattice;

  memcpy(w.a, x, sizeof(w.a));
  memcpy(w.b, x, sizeof(w.b));
  w.n[d] = sign;
  if (!RegionWhole(r) && side <= SIDE_YMAX) { /* along z a shape is a prism */
    RegionLattice(c, region, &lattice);
    w.b[d] += sign * LatticeWidth(&lattice, d, x[d]);
    TryShape(&w, r);
    for (PetscInt k = 0; k < r->minus.n; k++)
      TryShape(&w, &c->region[r->minus.i[k]]);
  }
  double sum = 0.0;
  for (int i = 0; i < CL_DIM; i++)
    sum += fabs(w.n[i]);
  const double steps = copysign(sum, sign * w.n[d]);

  for (int i = 0; i < CL_DIM; i++)
    n[i] = w.n[i] / steps;
}

static bool OnLine(const Scene *c, const Points *line, PetscInt region, const double x[], int side)
{
  const int d = SideAxis(side);
  double    a[CL_DIM], b[CL_DIM], t;
  Lattice   lattice;

  memcpy(a, x, sizeof(a));
  memcpy(b, x, sizeof(b));
  RegionLattice(c, region, &lattice);
  const double width = LatticeWidth(&lattice, d, x[d]);

  a[d] += 0.5 * SideSign(side) * width;
  b[d] = a[d] + LINE_REACH * width;
  a[d] -= LINE_REACH * width;
  for (PetscInt k = 0; k + 1 < line->n; k++) {
    if (SegmentsMeet(a, b, line->x + 2 * k, line->x + 2 * (k + 1), &t))
      return true;
  }
  return false;
}

bool FaceNamed(const Scene *c, const Meter *m, PetscInt region, const double x[], int side)
{
  if (side >= SIDE_COUNT)
    return false;
  const double along = x[SideAxis(side) == 0 ? 1 : 0];

  if (m->region >= 0 && m->region != region)
    return false;
  if (m->along.n)
    return OnLine(c, &m->along, region, x, side);
  return (int)m->side == side && along >= m->from && along <= m->to;
}
