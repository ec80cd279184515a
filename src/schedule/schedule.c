/* schedule: values and kinks of piecewise-linear and piecewise-constant functions of time, and their waves. */
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

static double Phase(const Wave *w, double t)
{
  return 2.0 * M_PI * fmod((t - w->begin) / w->period, 1.0);
}

/* Sum of sines (267). */
static double Waves(const Schedule *s, double t)
{
  double sum = 0.0;

  for (PetscInt k = 0; k < s->nwave; k++)
    sum += s->wave[k].amplitude * sin(Phase(&s->wave[k], t));
  return sum;
}

double ScheduleSwing(const Schedule *s)
{
  double sum = 0.0;

  for (PetscInt k = 0; k < s->nwave; k++)
    sum += fabs(s->wave[k].amplitude);
  return sum;
}

bool ScheduleIsZero(const Schedule *s)
{
  for (PetscInt i = 0; i < s->n; i++) {
    if (s->y[i] != 0.0)
      return false;
  }
  return ScheduleSwing(s) == 0.0;
}

void ScheduleSpan(const Schedule *s, double *low, double *high)
{
  const double swing = ScheduleSwing(s);

  *low  = INFINITY;
  *high = -INFINITY;
  for (PetscInt k = 0; k < s->n; k++) {
    *low  = fmin(*low, s->y[k] - swing);
    *high = fmax(*high, s->y[k] + swing);
  }
}

static double Points(const Schedule *s, double t)
{
  const PetscInt i = ScheduleFind(s, t);

  if (i < 0)
    return s->y[0];
  if (i == s->n - 1 || s->steps)
    return s->y[i];
  return s->y[i] + (s->y[i + 1] - s->y[i]) * ((t - s->t[i]) / (s->t[i + 1] - s->t[i]));
}

double ScheduleValue(const Schedule *s, double t)
{
  return s->n ? Points(s, t) + Waves(s, t) : 0.0;
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

double ScheduleNextMark(const Schedule *s, double t)
{
  double next = INFINITY;

  for (PetscInt k = 0; k < s->nwave; k++) {
    const double eighth = s->wave[k].period / 8.0, begin = s->wave[k].begin,
                 n    = floor((t - begin) / eighth + 1e-9) + 1.0; /* past round-off */
    const double mark = begin + n * eighth;

    next = fmin(next, mark > t + Slack(mark, t) ? mark : mark + eighth);
  }
  return next;
}

double ScheduleIntegral(const Schedule *s, double t)
{
  double sum = 0.0;

  for (PetscInt k = 0; k < s->nwave; k++) {
    const Wave *w = &s->wave[k];

    sum += w->amplitude * w->period / (2.0 * M_PI) * (cos(Phase(w, 0.0)) - cos(Phase(w, t)));
  }

  for (double from = 0.0, to; s->n && from < t; from = to) {
    to = PetscMin(ScheduleNextKink(s, from), t);
    sum += (to - from) * (s->steps ? Points(s, from) : 0.5 * (Points(s, from) + Points(s, to)));
  }
  return sum;
}

void ScheduleDestroy(Schedule *s)
{
  free(s->t);
  free(s->y);
  free(s->wave);
  *s = (Schedule){0};
}
