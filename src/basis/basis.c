/* uGIMP, cpGIMP and linear functions along one axis, and their tensor product. */
#include "clathra/basis.h"

#define EDGE_SNAP 1e-9 /* of a cell: a domain edge so close to a grid line lies on it */

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

static double Snap(double s)
{
  const double line = round(s);

  return fabs(s - line) < EDGE_SNAP ? line : s;
}

void BasisHat(double x, double lower, double h, Axis *a)
{
  const double s = Snap((x - lower) / h), base = floor(s);

  a->base = (PetscInt)base;
  for (int k = 0; k < 3; k++) {
    a->S[k]  = Hat(s - base - k);
    a->dS[k] = k == 0 ? -1.0 / h : k == 1 ? 1.0 / h : 0.0;
  }
}

void BasisAxis(BasisType type, double x, double l, double lower, double h, PetscInt cells, Axis *a)
{
  const double s = (x - lower) / h, r = l / h, from = Snap(s - r), to = Snap(s + r), end = (double)cells;
  const bool   clipped = s >= 0.0 && s <= end && (from < 0.0 || to > end);
  const double lo = clipped ? fmax(from, 0.0) : from, hi = clipped ? fmin(to, end) : to, base = floor(lo);
  const double length = clipped ? hi - lo : 2.0 * r;

  if (type == BASIS_LINEAR) {
    BasisHat(x, lower, h, a);
    return;
  }
  a->base = (PetscInt)base;
  for (int k = 0; k < 3; k++) { /* (3); the average uses the snapped length so that the weights sum to one */
    a->S[k]  = (HatIntegral(hi - base - k) - HatIntegral(lo - base - k)) / (hi - lo);
    a->dS[k] = (Hat(hi - base - k) - Hat(lo - base - k)) / (length * h);
  }
}

int StencilExpand(const Stencil *s, const Grid *g, const NodeMap *map, PetscInt node[CL_NODES], double S[CL_NODES],
                  double G[CL_NODES][CL_DIM])
{
  const Axis *x = &s->axis[0], *y = &s->axis[1];
  int         n = 0;

  for (int b = 0; b < 3; b++) {
    if (y->S[b] == 0.0 && y->dS[b] == 0.0)
      continue;
    for (int a = 0; a < 3; a++) {
      if (x->S[a] == 0.0 && x->dS[a] == 0.0)
        continue;
      node[n] = map->index[GridPadded(g, x->base + a, y->base + b)];
      S[n]    = x->S[a] * y->S[b];
      G[n][0] = x->dS[a] * y->S[b];
      G[n][1] = x->S[a] * y->dS[b];
      n++;
    }
  }
  return n;
}
