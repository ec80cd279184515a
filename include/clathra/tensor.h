/* tensor: symmetric 3x3 tensors as six numbers xx yy zz xy yz xz, and the 2x2 algebra of a plane motion. */
#pragma once

#include <math.h>

enum { XX = 0, YY, ZZ, XY, YZ, XZ };

static inline double Trace6(const double s[6])
{
  return s[XX] + s[YY] + s[ZZ];
}

/* r = R s R^T for the rotation by theta in the x-y plane; dr = dr/dtheta (may be NULL). */
static inline void Rotate6(const double s[6], double theta, double r[6], double dr[6])
{
  const double c = cos(theta), n = sin(theta);

  r[XX] = c * c * s[XX] - 2.0 * c * n * s[XY] + n * n * s[YY];
  r[YY] = n * n * s[XX] + 2.0 * c * n * s[XY] + c * c * s[YY];
  r[XY] = c * n * (s[XX] - s[YY]) + (c * c - n * n) * s[XY];
  r[ZZ] = s[ZZ];
  r[XZ] = c * s[XZ] - n * s[YZ];
  r[YZ] = n * s[XZ] + c * s[YZ];
  if (dr) { /* d(R s R^T) = W r - r W with W = [0 -1; 1 0] */
    dr[XX] = -2.0 * r[XY];
    dr[YY] = 2.0 * r[XY];
    dr[XY] = r[XX] - r[YY];
    dr[ZZ] = 0.0;
    dr[XZ] = -r[YZ];
    dr[YZ] = r[XZ];
  }
}
