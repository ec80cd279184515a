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

void BasisHat(double x, double lower, double h, Axis *a)
{
  const double s = BasisSnap((x - lower) / h), base = floor(s);

  a->base = (PetscInt)base;
  for (int k = 0; k < 3; k++) {
    a->S[k]  = Hat(s - base - k);
    a->dS[k] = k == 0 ? -1.0 / h : k == 1 ? 1.0 / h : 0.0;
  }
}

void BasisAxis(BasisType type, double x, double l, double lower, double h, PetscInt cells, Axis *a)
{
  if (type == BASIS_LINEAR) {
    BasisHat(x, lower, h, a);
    return;
  }
  const BasisDomain d    = BasisDomainOf(x, l, lower, h, (double)cells);
  const double      base = floor(d.lo);

  a->base = (PetscInt)base;
  BasisAverage(d.lo - base, d.hi - base, d.length * h, a->S, a->dS);
}

/* Integral of s N(s) from -infinity, N the hat function of unit width. */
static double HatMoment(double s)
{
  const double t = fmin(fmax(s, -1.0), 1.0), even = t * t / 2.0, odd = t * t * t / 3.0;

  return t < 0.0 ? even + odd - 1.0 / 6.0 : even - odd - 1.0 / 6.0;
}

void BasisRadius(BasisType type, double x, double l, double lower, double h, PetscInt cells, Axis *a, double hoop[3],
                 double *r)
{
  BasisAxis(type, x, l, lower, h, cells, a);
  if (type == BASIS_LINEAR) {
    *r = x;
    for (int k = 0; k < 3; k++)
      hoop[k] = a->S[k] / x;
    return;
  }
  const BasisDomain d = BasisDomainOf(x, l, lower, h, (double)cells);
  const double axis = -lower / h, mid = 0.5 * (d.lo + d.hi), radius = mid - axis, length = d.hi - d.lo; /* in cells */

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

double AxisCentroid(const Axis *a, double lower, double h)
{
  return lower + h * ((double)a->base * (a->S[0] + a->S[1] + a->S[2]) + a->S[1] + 2.0 * a->S[2]);
}

int StencilExpand(const Stencil *s, const Grid *g, const NodeMap *map, PetscInt node[CL_NODES], double S[CL_NODES],
                  double G[CL_NODES][CL_DIM], double H[CL_NODES])
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
      if (s->r > 0.0)
        H[n] = s->hoop[a] * y->S[b];
      n++;
    }
  }
  return n;
}

double CellGradient(const Grid *g, bool axisymmetric, const PetscInt i[CL_DIM], double r, double Q[CL_DIM])
{
  const double *h = g->h;

  Q[0] = Q[1] = 0.0;
  if (i[0] < 0 || i[0] > 1 || i[1] < 0 || i[1] > 1)
    return 0.0;
  Q[0] = (i[0] ? 0.5 : -0.5) / h[0];
  Q[1] = (i[1] ? 0.5 : -0.5) / h[1];
  if (!axisymmetric)
    return 0.0;
  const double ring = r * h[0] + 0.5 * h[0] * h[0], outer = 0.5 * r * h[0] + h[0] * h[0] / 3.0; /* int r, int r N dr */

  Q[1] = (i[0] ? outer : ring - outer) / (ring * (i[1] ? h[1] : -h[1]));
  return 0.25 * h[0] / ring;
}
