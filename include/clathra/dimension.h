/* dimension: of space, and where vectors and tensors of it stand in arrays.  Units: those of the components. */
#pragma once

#include <math.h>

#define CL_DIM 2 /* space dimensions of the grid; stresses are 3-D */

enum { CL_CORNERS = 1 << CL_DIM }; /* of a cell */

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

/* |a| */
static inline double VectorLength(const double a[CL_DIM])
{
  double length = hypot(a[0], a[1]);

  for (int d = 2; d < CL_DIM; d++)
    length = hypot(length, a[d]);
  return length;
}
