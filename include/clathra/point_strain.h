/* Strain and rotation of a step: every relation of (7) that needs no series, for one particle and for loops over blocks
   (point_state.h). */
#pragma once

#include "clathra/tensor.h"

/* Of F in the plane: tan theta = turn/along; b = F F^T = m 1 + (d, off; off, -d), its radius sqrt(y) m. */
typedef struct {
  double along, turn, m, d, off, y;
} Stretch;

/* (7); F row by row, dimensionless. */
INLINE Stretch StretchOf(double xx, double xy, double yx, double yy)
{
  const double bxx = xx * xx + xy * xy, byy = yx * yx + yy * yy, off = xx * yx + xy * yy;
  const double m = 0.5 * (bxx + byy), d = 0.5 * (bxx - byy);

  return (Stretch){xx + yy, yx - xy, m, d, off, (d * d + off * off) / (m * m)};
}

/* Diagonal of U = R^T F, with the cosine and sine of R; all dimensionless. */
INLINE void StretchDiagonal(double c, double s, double xx, double xy, double yx, double yy, double U[2])
{
  U[0] = c * xx + s * yx;
  U[1] = -s * xy + c * yy;
}

/* Logarithmic strain (7) in the plane: half of ln J, and half of atanh(sqrt y)/sqrt y times d/m and off/m; zz stays. */
INLINE void LogStrainOf(double half_ln_J, double d, double off, double e[CL_TENSOR])
{
  e[XX] = half_ln_J + d;
  e[YY] = half_ln_J - d;
  e[XY] = off;
}
