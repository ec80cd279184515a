#include "clathra/words.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define SMALL 0.01 /* of a unit: what is less reads better in its own */

Words TimeWordsAs(double seconds, double scale, int digits)
{
  static const struct {
    double      s;
    const char *name;
  } unit[]    = {{3.15576e7, "years"}, {86400.0, "days"}, {3600.0, "h"}, {60.0, "min"}, {1.0, "s"}};
  Words words = {""};
  int   k     = 0, n;

  while (k < 4 && scale < 2.0 * unit[k].s)
    k++;
  if (k < 4 && seconds != 0.0 && fabs(seconds) < SMALL * unit[k].s)
    return TimeWordsAs(seconds, fabs(seconds), digits);
  n = snprintf(words.s, sizeof(words.s), "%.*g %s", digits, seconds / unit[k].s, unit[k].name);
  if (strncmp(words.s, "1 ", 2) == 0 && unit[k].s >= 86400.0)
    words.s[n - 1] = '\0'; /* 1 year */
  return words;
}

Place PlaceWords(const double x[CL_DIM])
{
  Place words = {"("};
  int   n     = 1;

  for (int d = 0; d < CL_DIM; d++)
    n += snprintf(words.s + n, sizeof(words.s) - (size_t)n, "%s%.4g", d ? ", " : "", x[d]);
  snprintf(words.s + n, sizeof(words.s) - (size_t)n, ") m");
  return words;
}

Words TimeWords(double seconds, int digits)
{
  return TimeWordsAs(seconds, seconds, digits);
}

Words TimeAt(double t)
{
  return TimeWords(t, 6);
}

Words PressureWords(double pascals, int digits)
{
  static const struct {
    double      Pa;
    const char *name;
  } unit[]           = {{1e9, "GPa"}, {1e6, "MPa"}, {1e3, "kPa"}, {1.0, "Pa"}};
  Words        words = {""};
  const double least = 1.0 - 0.5 * pow(10.0, -digits); /* 999.9 kPa to three digits is 1 MPa */
  int          k     = 0;

  while (k < 3 && fabs(pascals) < least * unit[k].Pa)
    k++;
  snprintf(words.s, sizeof(words.s), "%.*g %s", digits, pascals / unit[k].Pa, unit[k].name);
  return words;
}

Words CountWords(double n)
{
  const double unit  = n >= 100.0 ? pow(10.0, floor(log10(n)) - 1.0) : 1.0;
  Words        words = {""};

  snprintf(words.s, sizeof(words.s), n < 1e5 ? "%.0f" : "%.2g", unit * round(n / unit));
  return words;
}
