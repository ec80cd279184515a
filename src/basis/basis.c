/* uGIMP, cpGIMP and linear functions along one axis, and their tensor product. */
#include "clathra/basis.h"

/* Hat function of unit width and its integral from -infinity. */
static double Hat(double s)
{
  return fmax(0.0, 1.0 - fabs(s));
}

static double HatIntegral(double s)
{
  if (s <= -1.0)
    return 0.0;
  if (s >= 1.0)
    return 1.0;
  return s < 0.0 ? 0.5 * (1.0 + s) * (1.0 + s) : 1.0 - 0.5 * (1.0 - s) * (1.0 - s);
}

void BasisHat(double x, const GridLines *line, Axis *a)
{
  const double s = BasisSnap(LinesPlace(line, x)), base = floor(s);

  a->base        = (PetscInt)base;
  const double h = LinesWidth(line, a->base);
  for (int k = 0; k < 3; k++) {
    a->S[k]  = Hat(s - base - k);
    a->dS[k] = k == 0 ? -1.0 / h : k == 1 ? 1.0 / h : 0.0;
  }
}

/* Local width of the cells (302), m: that of a cell in its middle, the mean of two on the line between them. */
static double LocalWidth(const GridLines *line, PetscInt cell, double x)
{
  const double h = LinesWidth(line, cell), t = 2.0 * (x - LinesAt(line, cell)) / h - 1.0; /* -1 ... 1 */
  const double beside = LinesWidth(line, t < 0.0 ? cell - 1 : cell + 1);

  return h + 0.5 * fabs(t) * (beside - h);
}

double BasisReach(BasisType type, const GridLines *line, double x, double l)
{
  const double room = fmin(x - line->lower, LinesAt(line, line->cells) - x);

  return BasisHalfLength(type, l, line->x ? LocalWidth(line, LinesFind(line, x), x) : line->h, room);
}

BasisSpan BasisSpanOf(BasisType type, const GridLines *line, double x, double l)
{
  const double   cells = (double)line->cells, r = BasisReach(type, line, x, l), s = LinesPlace(line, x);
  const double   from = BasisSnap(LinesPlace(line, x - r)), to = BasisSnap(LinesPlace(line, x + r));
  const bool     clipped = (s >= 0.0) & (s <= cells) & ((from < 0.0) | (to > cells));
  BasisSpan      d       = {.lo = clipped ? fmax(from, 0.0) : from, .hi = clipped ? fmin(to, cells) : to};
  const PetscInt first   = (PetscInt)floor(d.lo);

  d.length          = LinesFrom(line, d.hi) - LinesFrom(line, d.lo);
  d.gradient_length = clipped ? d.length : 2.0 * r;
  for (int k = 0; k < 2; k++)
    d.width[k] = LinesWidth(line, first + k);
  return d;
}

void BasisAxis(BasisType type, double x, double l, const GridLines *line, Axis *a)
{
  if (type == BASIS_LINEAR) {
    BasisHat(x, line, a);
    return;
  }
  if (line->x) {
    const BasisSpan d    = BasisSpanOf(type, line, x, l);
    const double    base = floor(d.lo);

    a->base = (PetscInt)base;
    BasisAverage(d.lo - base, d.hi - base, d.width[0], d.width[1], d.length, d.gradient_length, a->S, a->dS);
    return;
  }
  const BasisDomain d    = BasisDomainOf(type, x, l, line->lower, line->h, (double)line->cells);
  const double      base = floor(d.lo), lo = d.lo - base, hi = d.hi - base;

  a->base = (PetscInt)base;
  BasisAverage(lo, hi, 1.0, 1.0, hi - lo, d.length * line->h, a->S, a->dS);
}

/* Integral of s N(s) from -infinity, N the hat function of unit width. */
static double HatMoment(double s)
{
  const double t = fmin(fmax(s, -1.0), 1.0), even = t * t / 2.0, odd = t * t * t / 3.0;

  return t < 0.0 ? even + odd - 1.0 / 6.0 : even - odd - 1.0 / 6.0;
}

/* (29) where cells differ: over the part of the domain in each cell N and r are linear, so r N has its exact mean by
   Simpson's rule. */
static void RadiusUnequal(BasisType type, const GridLines *line, double x, double l, Axis *a, double hoop[3], double *r)
{
  const BasisSpan d  = BasisSpanOf(type, line, x, l);
  const double    lo = LinesFrom(line, d.lo), hi = LinesFrom(line, d.hi), radius = 0.5 * (lo + hi);
  double          S[3] = {0.0}, edge[3] = {0.0};

  for (int c = 0; c < 2; c++) {
    const double left = LinesAt(line, a->base + c), h = d.width[c];
    const double p = fmax(lo, left), q = fmin(hi, left + h), mid = 0.5 * (p + q), w = (q - p) / 6.0;

    if (!(q > p))
      continue;
    for (int k = 0; k < 2; k++) { /* N of the left and the right node at p, mid, q */
      const double sign = k ? 1.0 : -1.0, at = k ? left : left + h;
      const double Np = sign * (p - at) / h, Nm = sign * (mid - at) / h, Nq = sign * (q - at) / h;

      S[c + k] += w * (p * Np + 4.0 * mid * Nm + q * Nq);
      edge[c + k] += q * Nq - p * Np; /* [r N] = int (r N' + N) dr */
    }
  }
  *r = radius;
  for (int k = 0; k < 3; k++) {
    const double integral = a->S[k] * d.length;

    hoop[k]  = a->S[k] / radius;
    a->S[k]  = S[k] / (radius * d.length);
    a->dS[k] = (edge[k] - integral) / (radius * d.length);
  }
}

void BasisRadius(BasisType type, double x, double l, const GridLines *line, Axis *a, double hoop[3], double *r)
{
  BasisAxis(type, x, l, line, a);
  if (type == BASIS_LINEAR) {
    *r = x;
    for (int k = 0; k < 3; k++)
      hoop[k] = a->S[k] / x;
    return;
  }
  if (line->x) {
    RadiusUnequal(type, line, x, l, a, hoop, r);
    return;
  }
  const double      h    = line->h;
  const BasisDomain d    = BasisDomainOf(type, x, l, line->lower, h, (double)line->cells);
  const double      axis = -line->lower / h, mid = 0.5 * (d.lo + d.hi), radius = mid - axis,
               length = d.hi - d.lo; /* in cells */

  *r = radius * h;
  for (int k = 0; k < 3; k++) { /* (29); r = r_k + s about node k */
    const double node = (double)(a->base + k), rk = node - axis, lo = d.lo - node, hi = d.hi - node;
    const double moment = HatMoment(hi) - HatMoment(lo), integral = HatIntegral(hi) - HatIntegral(lo);
    const double edge = (hi + rk) * Hat(hi) - (lo + rk) * Hat(lo); /* [r N] = int (r N' + N) dr */

    hoop[k]  = a->S[k] / *r;
    a->S[k]  = (rk * integral + moment) / (radius * length);
    a->dS[k] = (edge - integral) / (radius * length * h);
  }
}

double AxisCentroid(const Axis *a, const GridLines *line)
{
  if (line->x) {
    double at = 0.0;

    for (int k = 0; k < 3; k++)
      at += a->S[k] * LinesAt(line, a->base + k);
    return at;
  }
  return line->lower + line->h * ((double)a->base * (a->S[0] + a->S[1] + a->S[2]) + a->S[1] + 2.0 * a->S[2]);
}

static bool Reached(const Axis *a, int k)
{
  return a->S[k] != 0.0 || a->dS[k] != 0.0;
}

/* Nodes that differ in x alone: how far the row is from the first one along the other axes, and the products of their
   weights. */
typedef struct {
  int    k[CL_DIM];
  double S, G[CL_DIM];
} Row;

/* Row number `row` of a stencil; false if it carries nothing. */
static inline bool RowOf(const Stencil *s, int row, Row *r)
{
  r->S = 1.0;
  for (int d = 1; d < CL_DIM; d++)
    r->G[d] = 1.0;
  for (int d = 1; d < CL_DIM; row /= 3, d++) {
    const Axis *a = &s->axis[d];
    const int   k = r->k[d] = row % 3;

    if (!Reached(a, k))
      return false;
    r->S *= a->S[k];
    for (int j = 1; j < CL_DIM; j++)
      r->G[j] *= j == d ? a->dS[k] : a->S[k];
  }
  return true;
}

int StencilNodes(const Stencil *s, int k[CL_NODES][CL_DIM])
{
  int n = 0;

  for (int row = 0; row < CL_NODES / 3; row++) {
    Row r;

    for (int a = 0; RowOf(s, row, &r) && a < 3; a++) {
      if (!Reached(&s->axis[0], a))
        continue;
      r.k[0] = a;
      memcpy(k[n++], r.k, sizeof(r.k));
    }
  }
  return n;
}

int StencilExpand(const Stencil *s, const Grid *g, const NodeMap *map, PetscInt node[CL_NODES], double S[CL_NODES],
                  double G[CL_NODES][CL_DIM], double H[CL_NODES])
{
  const Axis *x = &s->axis[0];
  int         n = 0;

  for (int row = 0; row < CL_NODES / 3; row++) {
    Row      r;
    PetscInt first[CL_DIM] = {x->base};

    if (!RowOf(s, row, &r))
      continue;
    for (int d = 1; d < CL_DIM; d++)
      first[d] = s->axis[d].base + r.k[d];
    const PetscInt *index = &map->index[GridPadded(g, first)];
    for (int a = 0; a < 3; a++) {
      if (!Reached(x, a))
        continue;
      node[n] = index[a];
      S[n]    = x->S[a] * r.S;
      G[n][0] = x->dS[a] * r.S;
      for (int d = 1; d < CL_DIM; d++)
        G[n][d] = x->S[a] * r.G[d];
      if (s->r > 0.0)
        H[n] = s->hoop[a] * r.S;
      n++;
    }
  }
  return n;
}
