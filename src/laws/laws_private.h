/* Shared by the laws alone: physical constants (as in base.h, which the laws do not see) and two guarded functions. */
#pragma once

#include <math.h>
#include <stddef.h>
#include <string.h>

#define LAW_GAS_CONSTANT 8.314 /* J/(mol K) */
#define LAW_PI 3.14159265358979323846
#define LAW_LN10 2.30258509299404568402
#define LAW_ZERO_CELSIUS 273.15 /* K */
#define LAW_EXP_MAX 200.0       /* no exponent of a sensible parameter set comes near */
#define LAW_TOE 1e-3            /* width of the C1 toes */
#define LAW_TRAPPED_MIN 1e-4 /* least trapped gas S_gr' of the smooth retention, so that p_c is defined without any */
#define LAW_SMOOTH 0.05      /* default p_s/p_0 of the smooth retention */

/* Position of a name in a NULL-terminated list, -1 if it is not there. */
static inline int LawFind(const char *const names[], const char *name)
{
  for (int i = 0; name && names[i]; i++) {
    if (!strcmp(names[i], name))
      return i;
  }
  return -1;
}

/* exp(x) for |x| <= X = 200; beyond, e^X (1 + x - X) and e^-X/(1 - X - x): C1, positive, increasing, never inf or 0.
   NaN stays NaN. */
static inline double LawExp(double x, double *dx)
{
  const double over = fabs(x) - LAW_EXP_MAX;

  if (!(over > 0.0))
    return *dx = exp(x);

  const double e = exp(copysign(LAW_EXP_MAX, x)), stretch = 1.0 + over;

  *dx = x > 0.0 ? e : e / (stretch * stretch);
  return x > 0.0 ? e * stretch : e / stretch;
}

/* b^n, n > 0, 0 for b <= 0.  Where n < 2 a toe replaces it below b0 = 1e-3: with t = b/b0 the cubic
   b0^n t^2 [(3 - n) + (n - 2) t] meets b^n in value and slope at b0 and starts flat, so that clipping at 0 is C1. */
static inline double LawToePower(double b, double n, double *db)
{
  *db = 0.0;
  if (b <= 0.0)
    return 0.0;
  if (n < 2.0 && b < LAW_TOE) {
    const double t = b / LAW_TOE, v = pow(LAW_TOE, n);

    *db = v / LAW_TOE * t * (2.0 * (3.0 - n) + 3.0 * (n - 2.0) * t);
    return v * t * t * ((3.0 - n) + (n - 2.0) * t);
  }
  const double v = pow(b, n);

  *db = n * v / b;
  return v;
}
