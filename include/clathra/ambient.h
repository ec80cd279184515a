/* ambient: pressure of the fluid that the scene stands in, at one time; docs/equations.md (42). */
#pragma once

#include <stdbool.h>
#include "clathra/dimension.h"

typedef struct {
  bool   on;
  double pressure;       /* at and above the level, Pa */
  double weight[CL_DIM]; /* density times gravity, Pa/m */
  double head;           /* weight . x at the level, Pa */
} Ambient;

/* p_a at x (m) in Pa, and its gradient in Pa/m: constant above the level, of the fluid's weight below it. */
static inline double AmbientPressure(const Ambient *a, const double x[CL_DIM], double gradient[CL_DIM])
{
  const double depth = VectorDot(a->weight, x) - a->head; /* as a pressure */
  const bool   below = !(depth <= 0.0);                   /* NaN stays NaN */

  for (int d = 0; d < CL_DIM; d++)
    gradient[d] = below ? a->weight[d] : 0.0;
  return a->pressure + (below ? depth : 0.0);
}
