/* dimension: of space, and where vectors and tensors of it stand in arrays.  Units: those of the components. */
#pragma once

#include <math.h>

#ifndef CL_DIM
  #define CL_DIM 2 /* space dimensions of the grid; stresses are 3-D */
#endif

enum { CL_CORNERS = 1 << CL_DIM }; /* of a cell */

/* Pairs of axes, xy yz xz, the numbers of a symmetric tensor of the axes: its diagonal, then its pairs; and the mixed
   derivatives of a field that is linear along each axis: by pairs, and in space by all three. */
enum { CL_PAIRS = CL_DIM * (CL_DIM - 1) / 2, CL_SYMMETRIC = CL_DIM + CL_PAIRS, CL_MIXED = CL_DIM == 2 ? 1 : 4 };
#if CL_DIM == 2
  #define CL_IDENTITY                                                                                                  \
    {                                                                                                                  \
      {1.0, 0.0},                                                                                                      \
      {                                                                                                                \
        0.0, 1.0                                                                                                       \
      }                                                                                                                \
    }
static const int cl_symmetric[CL_DIM][CL_DIM] = {{0, 2}, {2, 1}}, cl_pair[CL_PAIRS][2] = {{0, 1}},
                 cl_mixed[CL_MIXED][CL_DIM] = {{1, 1}};
#else
  #define CL_IDENTITY                                                                                                  \
    {                                                                                                                  \
      {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0},                                                                                \
      {                                                                                                                \
        0.0, 0.0, 1.0                                                                                                  \
      }                                                                                                                \
    }
static const int cl_symmetric[CL_DIM][CL_DIM] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}},
                 cl_pair[CL_PAIRS][2]         = {{0, 1}, {1, 2}, {0, 2}},
                 cl_mixed[CL_MIXED][CL_DIM]   = {{1, 1, 0}, {0, 1, 1}, {1, 0, 1}, {1, 1, 1}};
#endif

/* Place of component d of the k-th of vectors that stand together from place `first` on: of a fluid's vector, of a row
   of a tensor. */
static inline int VectorAt(int first, int k, int d)
{
  return first + CL_DIM * k + d;
}

/* a . b */
static inline double VectorDot(const double a[CL_DIM], const double b[CL_DIM])
{
  double sum = a[0] * b[0];

  for (int d = 1; d < CL_DIM; d++)
    sum += a[d] * b[d];
  return sum;
}

/* cof = det F F^-T; returns det F. */
static inline double CofactorOf(const double F[CL_DIM][CL_DIM], double cof[CL_DIM][CL_DIM])
{
#if CL_DIM == 2
  cof[0][0] = F[1][1];
  cof[0][1] = -F[1][0];
  cof[1][0] = -F[0][1];
  cof[1][1] = F[0][0];
#else
  for (int i = 0; i < 3; i++) {
      const int a = (i + 1) % 3, b = (i + 2) % 3;

      for (int j = 0; j < 3; j++) {
        const int c = (j + 1) % 3, d = (j + 2) % 3;

        cof[i][j] = F[a][c] * F[b][d] - F[a][d] * F[b][c];
    }
  }
#endif
  return VectorDot(F[0], cof[0]);
}

/* |a| */
static inline double VectorLength(const double a[CL_DIM])
{
  double length = hypot(a[0], a[1]);

  for (int d = 2; d < CL_DIM; d++)
    length = hypot(length, a[d]);
  return length;
}

/* w times the components of v along the axes of mixed derivative k. */
static inline double MixedProduct(int k, double w, const double v[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    w *= cl_mixed[k][d] ? v[d] : 1.0;
  return w;
}
