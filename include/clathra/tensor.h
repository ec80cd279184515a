/* tensor: symmetric 3x3 tensors as six numbers xx yy zz xy yz xz, and the 2x2 algebra of a plane motion.  Units: those
   of the components. */
#pragma once

#include <math.h>
#include "clathra/inline.h"

enum { XX = 0, YY, ZZ, XY, YZ, XZ };
/* Place of row i, column j. */
static const int voigt[3][3] = {{XX, XY, XZ}, {XY, YY, YZ}, {XZ, YZ, ZZ}};

/* xx + yy + zz. */
static inline double Trace6(const double s[6])
{
  return s[XX] + s[YY] + s[ZZ];
}

/* sqrt(3 J2) */
static inline double Mises6(const double s[6])
{
  const double a = s[XX] - s[YY], b = s[YY] - s[ZZ], c = s[ZZ] - s[XX];

  return sqrt(0.5 * (a * a + b * b + c * c) + 3.0 * (s[XY] * s[XY] + s[YZ] * s[YZ] + s[XZ] * s[XZ]));
}

/* r = R s R^T for the rotation in the x-y plane with cosine c and sine n. */
INLINE void Turn6(const double s[6], double c, double n, double r[6])
{
  const double xx = s[XX], yy = s[YY], xy = s[XY], xz = s[XZ], yz = s[YZ];

  r[XX] = c * c * xx - 2.0 * c * n * xy + n * n * yy;
  r[YY] = n * n * xx + 2.0 * c * n * xy + c * c * yy;
  r[XY] = c * n * (xx - yy) + (c * c - n * n) * xy;
  r[ZZ] = s[ZZ];
  r[XZ] = c * xz - n * yz;
  r[YZ] = n * xz + c * yz;
}

/* d(R s R^T)/dtheta = W r - r W with W = [0 -1; 1 0], of the turned tensor r. */
static inline void Spin6(const double r[6], double dr[6])
{
  dr[XX] = -2.0 * r[XY];
  dr[YY] = 2.0 * r[XY];
  dr[XY] = r[XX] - r[YY];
  dr[ZZ] = 0.0;
  dr[XZ] = -r[YZ];
  dr[YZ] = r[XZ];
}
