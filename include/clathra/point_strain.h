/* Strain and rotation of a step, for one particle and for loops over blocks (point_state.h): in the plane every
   relation of (7) that needs no series, in space the series (432) of small strains. */
#pragma once

#include "clathra/tensor.h"

#if CL_DIM == 2
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
#else
  #define CL_SERIES 8 /* terms: of strains up to 0.1, W^8 is 1e-16 */

/* r = a b of symmetric matrices that commute; dimensionless. */
INLINE void ProductOf(const double a[6], const double b[6], double r[6])
{
  r[XX] = a[XX] * b[XX] + a[XY] * b[XY] + a[XZ] * b[XZ];
  r[YY] = a[XY] * b[XY] + a[YY] * b[YY] + a[YZ] * b[YZ];
  r[ZZ] = a[XZ] * b[XZ] + a[YZ] * b[YZ] + a[ZZ] * b[ZZ];
  r[XY] = a[XX] * b[XY] + a[XY] * b[YY] + a[XZ] * b[YZ];
  r[YZ] = a[XY] * b[XZ] + a[YY] * b[YZ] + a[YZ] * b[ZZ];
  r[XZ] = a[XX] * b[XZ] + a[XY] * b[YZ] + a[XZ] * b[ZZ];
}

/* r = sum_k c_k W^k; dimensionless. */
INLINE void SeriesOf(const double c[CL_SERIES], const double W[6], double r[6])
{
  #pragma GCC unroll 6
  for (int i = 0; i < 6; i++)
    r[i] = i <= ZZ ? c[CL_SERIES - 1] : 0.0;
  #pragma GCC unroll 8
  for (int k = CL_SERIES - 2; k >= 0; k--) {
    double next[6];

    ProductOf(W, r, next);
  #pragma GCC unroll 6
    for (int i = 0; i < 6; i++)
      r[i] = next[i] + (i <= ZZ ? c[k] : 0.0);
  }
}

/* r = (2 + Y)^-1; dimensionless. */
INLINE void InverseOfTwoAnd(const double Y[6], double r[6])
{
  const double xx = 2.0 + Y[XX], yy = 2.0 + Y[YY], zz = 2.0 + Y[ZZ], xy = Y[XY], yz = Y[YZ], xz = Y[XZ];
  const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - yy * xz;
  const double per = 1.0 / (xx * cxx + xy * cxy + xz * cxz);

  r[XX] = per * cxx;
  r[YY] = per * (xx * zz - xz * xz);
  r[ZZ] = per * (xx * yy - xy * xy);
  r[XY] = per * cxy;
  r[YZ] = per * (xy * xz - xx * yz);
  r[XZ] = per * cxz;
}

/* (432): ln V and R of F = 1 + H, both dimensionless, whose logarithmic strains are 0.1 or less. */
INLINE void SmallStretch(const double H[3][3], double e[6], double R[3][3])
{
  static const double log_of[CL_SERIES]  = {1.0,       1.0 / 3.0,  1.0 / 5.0,  1.0 / 7.0,
                                            1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0};
  static const double root_of[CL_SERIES] = {1.0,          1.0 / 2.0,    3.0 / 8.0,      5.0 / 16.0,
                                            35.0 / 128.0, 63.0 / 256.0, 231.0 / 1024.0, 429.0 / 2048.0};
  double              Y[6]               = {0.0}, two[6], Z[6], W[6], P[6], root[6], back[6];

  #pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
  #pragma GCC unroll 3
    for (int j = i; j < 3; j++)
      Y[voigt[i][j]] = H[i][j] + H[j][i] + H[i][0] * H[j][0] + H[i][1] * H[j][1] + H[i][2] * H[j][2];
  }
  InverseOfTwoAnd(Y, two);
  ProductOf(Y, two, Z);
  ProductOf(Z, Z, W);
  SeriesOf(log_of, W, P);
  ProductOf(Z, P, e);
  SeriesOf(root_of, W, root);
  ProductOf(Z, root, back); /* V^-1 = root - back */
  #pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
  #pragma GCC unroll 3
    for (int j = 0; j < 3; j++) {
      double sum = 0.0;

  #pragma GCC unroll 3
      for (int k = 0; k < 3; k++)
        sum += (root[voigt[i][k]] - back[voigt[i][k]]) * ((k == j ? 1.0 : 0.0) + H[k][j]);
      R[i][j] = sum;
    }
  }
}
#endif
