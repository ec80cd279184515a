/* Times in words, for what a run says. */
#include "clathra/schedule.h"
#include <stdio.h>
#include <string.h>

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
  n = snprintf(words.s, sizeof(words.s), "%.*g %s", digits, seconds / unit[k].s, unit[k].name);
  if (strncmp(words.s, "1 ", 2) == 0 && unit[k].s >= 86400.0)
    words.s[n - 1] = '\0'; /* 1 year */
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
