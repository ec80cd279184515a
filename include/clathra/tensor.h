/* tensor: symmetric 3x3 tensors as six numbers xx yy zz xy yz xz, and how they turn: in the plane about z.  Units:
   those of the components. */
#pragma once

#include <math.h>
#include <stddef.h>
#include "clathra/dimension.h"
#include "clathra/inline.h"

enum { XX = 0, YY, ZZ, XY, YZ, XZ };
/* Those that a motion along the axes can fill, and the axes it can turn about: in the plane z alone. */
enum { CL_TENSOR = CL_DIM == 2 ? 4 : 6, CL_SPINS = CL_DIM == 2 ? 1 : 3 };
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

/* d(R s R^T)/dtheta = W r - r W about the axis z, x or y (spin 0, 1, 2), of the turned tensor r: W turns the first of
   the two other axes into the second. */
static inline void Spin6(const double r[6], int spin, double dr[6])
{
  const int a = spin, b = (spin + 1) % 3, n = (spin + 2) % 3;

  dr[voigt[a][a]] = -2.0 * r[voigt[a][b]];
  dr[voigt[b][b]] = 2.0 * r[voigt[a][b]];
  dr[voigt[a][b]] = r[voigt[a][a]] - r[voigt[b][b]];
  dr[voigt[n][n]] = 0.0;
  dr[voigt[a][n]] = -r[voigt[b][n]];
  dr[voigt[b][n]] = r[voigt[a][n]];
}

#if CL_DIM == 2
/* A rotation about z: cosine and sine. */
typedef struct {
  double c, s;
} Rotation;
enum { CL_TURN = 2 }; /* its numbers */

/* That whose numbers stand at place q of arrays. */
INLINE Rotation RotationAt(const double *const turn[CL_TURN], ptrdiff_t q)
{
  return (Rotation){turn[0][q], turn[1][q]};
}

  #define ROTATION_NONE                                                                                                \
    {                                                                                                                  \
      1.0, 0.0                                                                                                         \
    }

/* r = R s R^T. */
INLINE void Rotate6(const double s[6], Rotation R, double r[6])
{
  Turn6(s, R.c, R.s, r);
}

/* The other way round. */
INLINE Rotation RotationBack(Rotation R)
{
  return (Rotation){R.c, -R.s};
}
#else
/* A rotation: its matrix. */
typedef struct {
  double R[3][3];
} Rotation;
enum { CL_TURN = 9 }; /* its numbers, row by row */

/* That whose numbers stand at place q of arrays. */
INLINE Rotation RotationAt(const double *const turn[CL_TURN], ptrdiff_t q)
{
  Rotation R;

  for (int k = 0; k < CL_TURN; k++)
    R.R[k / 3][k % 3] = turn[k][q];
  return R;
}
  #define ROTATION_NONE                                                                                                \
    {                                                                                                                  \
      CL_IDENTITY                                                                                                      \
    }

/* r = R s R^T. */
INLINE void Rotate6(const double s[6], Rotation R, double r[6])
{
  double half[3][3];

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      half[i][j] = R.R[i][0] * s[voigt[0][j]] + R.R[i][1] * s[voigt[1][j]] + R.R[i][2] * s[voigt[2][j]];
  }
  for (int i = 0; i < 3; i++) {
    for (int j = i; j < 3; j++)
      r[voigt[i][j]] = half[i][0] * R.R[j][0] + half[i][1] * R.R[j][1] + half[i][2] * R.R[j][2];
  }
}

/* The other way round. */
INLINE Rotation RotationBack(Rotation R)
{
  Rotation back;

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      back.R[i][j] = R.R[j][i];
  }
  return back;
}
#endif

/* Turns those of CL_TENSOR numbers. */
INLINE void Rotate(const double a[CL_TENSOR], Rotation R, double r[CL_TENSOR])
{
  double a6[6] = {0.0}, r6[6];

#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++)
    a6[k] = a[k];
  Rotate6(a6, R, r6);
#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++)
    r[k] = r6[k];
}
