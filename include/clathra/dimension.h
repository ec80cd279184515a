/* dimension: of space, and where vectors and tensors of it stand in arrays. */
#pragma once

#define CL_DIM 2 /* space dimensions of the grid; stresses are 3-D */

/* Place of component d of the k-th of vectors that stand together from place `first` on: of a fluid's vector, of a row
   of a tensor. */
static inline int VectorAt(int first, int k, int d)
{
  return first + CL_DIM * k + d;
}
