/* Private to point/: the quotient of a logarithm and its argument, by series where the closed form cancels. */
#pragma once

#include <math.h>

/* g(y) = atanh(sqrt y)/sqrt y and g'(y), by series where the closed form cancels. */
static double AtanhRatio(double y, double *dg)
{
  if (y < 1e-2) {
    double g = 0.0, d = 0.0;

    for (int n = 8; n >= 0; n--) {
      g = g * y + 1.0 / (2.0 * n + 1.0);
      if (n > 0)
        d = d * y + n / (2.0 * n + 1.0);
    }
    *dg = d;
    return g;
  }
  const double x = sqrt(y), g = atanh(x) / x;

  *dg = 0.5 * (1.0 / (1.0 - y) - g) / y;
  return g;
}
