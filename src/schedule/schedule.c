/* schedule: values and kinks of piecewise-linear and piecewise-constant functions of time. */
#include "clathra/schedule.h"
#include <stdlib.h>

static double Slack(double a, double b)
{
  return 1e-12 * PetscMax(PetscAbsReal(a), PetscAbsReal(b));
}

/* Largest i with t_i <= t, -1 before the first point.  A time within round-off of a jump is taken as the jump's. */
static PetscInt ScheduleFind(const Schedule *s, double t)
{
  PetscInt lo = -1, hi = s->n;

  while (hi - lo > 1) {
    PetscInt mid = lo + (hi - lo) / 2;
    if (s->t[mid] <= t + (s->steps ? Slack(s->t[mid], t) : 0))
      lo = mid;
    else
      hi = mid;
  }
  return lo;
}

double ScheduleValue(const Schedule *s, double t)
{
  PetscInt i;

  if (s->n == 0)
    return 0;
  i = ScheduleFind(s, t);
  if (i < 0)
    return s->y[0];
  if (i == s->n - 1 || s->steps)
    return s->y[i];
  return s->y[i] + (s->y[i + 1] - s->y[i]) * ((t - s->t[i]) / (s->t[i + 1] - s->t[i]));
}

double ScheduleNextKink(const Schedule *s, double t)
{
  if (s->n < 2)
    return INFINITY;
  for (PetscInt i = PetscMax(ScheduleFind(s, t), 0); i < s->n; i++) {
    if (s->t[i] > t + Slack(s->t[i], t))
      return s->t[i];
  }
  return INFINITY;
}

double ScheduleIntegral(const Schedule *s, double t)
{
  double sum = 0.0;

  for (double from = 0.0, to; from < t; from = to) {
    to = PetscMin(ScheduleNextKink(s, from), t);
    sum += (to - from) * (s->steps ? ScheduleValue(s, from) : 0.5 * (ScheduleValue(s, from) + ScheduleValue(s, to)));
  }
  return sum;
}

void ScheduleDestroy(Schedule *s)
{
  free(s->t);
  free(s->y);
  s->t = s->y = NULL;
  s->n        = 0;
}
