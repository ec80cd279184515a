/* Points, segments and polygons of the plane. */
#include "clathra/geometry.h"

#define SLACK 1e-9 /* of a segment's length: its ends */

/* > 0: x lies to the left of the line from a to b; 0: on it. */
static double Turn(const double a[], const double b[], const double x[])
{
  return (b[0] - a[0]) * (x[1] - a[1]) - (b[1] - a[1]) * (x[0] - a[0]);
}

/* Crossings of the ray from x to the right; an edge is taken from its lower end up, whoever lists it. */
bool PolygonHolds(PetscInt n, const double *point, const double x[])
{
  bool in = false;

  for (PetscInt k = 0; k < n; k++) {
    const double *a = point + 2 * k, *b = point + 2 * ((k + 1) % n);

    if ((a[1] > x[1]) != (b[1] > x[1]))
      in ^= (a[1] < b[1] ? Turn(a, b, x) : Turn(b, a, x)) > 0.0;
  }
  return in;
}

bool LineCovers(PetscInt n, const double *point, const double x[])
{
  PetscInt low = 0, high = n - 1; /* the segment that holds x[0]: bisection */

  if (!(x[0] >= point[0] && x[0] < point[2 * high]))
    return false;
  while (high - low > 1) {
    const PetscInt middle = (low + high) / 2;

    *(x[0] < point[2 * middle] ? &high : &low) = middle;
  }
  const double *a = point + 2 * low, *b = point + 2 * high;

  if (a[1] < b[1])
    return !(Turn(a, b, x) > 0.0);
  return a[1] > b[1] ? Turn(b, a, x) > 0.0 : x[1] < a[1];
}

static int Sign(double v)
{
  return (v > 0.0) - (v < 0.0);
}

/* x, known to lie on the line through a and b: between them? */
static bool Between(const double a[], const double b[], const double x[])
{
  for (int d = 0; d < CL_DIM; d++) {
    if (x[d] < fmin(a[d], b[d]) || x[d] > fmax(a[d], b[d]))
      return false;
  }
  return true;
}

/* Two sides of a polygon that are no neighbours; what is said of their first points covers the second ones, which
   begin the next sides. */
static bool Touch(const double a[], const double b[], const double c[], const double d[])
{
  const int s[4] = {Sign(Turn(a, b, c)), Sign(Turn(a, b, d)), Sign(Turn(c, d, a)), Sign(Turn(c, d, b))};

  if (s[0] * s[1] < 0 && s[2] * s[3] < 0)
    return true;
  return (!s[0] && Between(a, b, c)) || (!s[2] && Between(c, d, a));
}

/* Neighbouring sides ab, bc share b, and more only where the second runs back over the first. */
static bool FoldsBack(const double a[], const double b[], const double c[])
{
  const double along = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);

  return Turn(a, b, c) == 0.0 && along <= 0.0;
}

bool PolygonCrosses(PetscInt n, const double *point, PetscInt pair[2])
{
  for (PetscInt i = 0; i < n; i++) {
    const double *a = point + 2 * i, *b = point + 2 * ((i + 1) % n);

    for (PetscInt j = i + 1; j < n; j++) {
      const double *c = point + 2 * j, *d = point + 2 * ((j + 1) % n);
      const bool    bad = j == i + 1 ? FoldsBack(a, b, d) : (j + 1) % n == i ? FoldsBack(c, a, b) : Touch(a, b, c, d);

      if (!bad)
        continue;
      pair[0] = i;
      pair[1] = j;
      return true;
    }
  }
  return false;
}

bool SegmentsMeet(const double a[], const double b[], const double c[], const double d[], double *t)
{
  const double r[CL_DIM] = {b[0] - a[0], b[1] - a[1]}, s[CL_DIM] = {d[0] - c[0], d[1] - c[1]};
  const double w[CL_DIM] = {c[0] - a[0], c[1] - a[1]}, den = r[0] * s[1] - r[1] * s[0];

  if (fabs(den) <= 1e-12 * hypot(r[0], r[1]) * hypot(s[0], s[1]))
    return false;
  const double u = (w[0] * r[1] - w[1] * r[0]) / den;

  *t = (w[0] * s[1] - w[1] * s[0]) / den;
  return *t >= -SLACK && *t <= 1.0 + SLACK && u >= -SLACK && u <= 1.0 + SLACK;
}
