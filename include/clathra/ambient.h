/* ambient: pressure of the fluid that the scene stands in, at one time; docs/equations.md (42). */
#pragma once

#include <stdbool.h>
#include "clathra/dimension.h"

typedef struct {
  bool   on;
  double pressure;  /* at and above the level, Pa */
  double weight[2]; /* density times gravity, Pa/m */
  double head;      /* weight . x at the level, Pa */
} Ambient;

/* p_a at x (m) in Pa, and its gradient in Pa/m: constant above the level, of the fluid's weight below it. */
static inline double AmbientPressure(const Ambient *a, const double x[2], double gradient[2])
{
  const double depth = a->weight[0] * x[0] + a->weight[1] * x[1] - a->head; /* as a pressure */
  const bool   below = !(depth <= 0.0);                                     /* NaN stays NaN */

  for (int d = 0; d < CL_DIM; d++)
    gradient[d] = below ? a->weight[d] : 0.0;
  return a->pressure + (below ? depth : 0.0);
}
