/* What a run has learnt of its own cost: time left. */
#include "clathra/stepper.h"

#define APART 1.02 /* times that are kept are so far apart */

void LearntAdd(Learnt *l, double t, double cost)
{
  if (l->n > 1 && t < APART * l->t[l->n - 2])
    l->n--; /* the last one was for the moment */
  if (l->n == LEARNT) {
    for (int k = 0; 2 * k < LEARNT; k++) {
      l->t[k]    = l->t[2 * k];
      l->cost[k] = l->cost[2 * k];
    }
    l->n = (LEARNT + 1) / 2;
  }
  l->t[l->n]      = t;
  l->cost[l->n++] = cost;
}

/* Up to time t, linear between what is kept, from nothing at 0 on. */
static double CostAt(const Learnt *l, double t)
{
  double t0 = 0.0, c0 = 0.0;

  for (int k = 0; k < l->n; k++) {
    if (t <= l->t[k])
      return c0 + (l->cost[k] - c0) * (t - t0) / (l->t[k] - t0);
    t0 = l->t[k];
    c0 = l->cost[k];
  }
  return c0;
}

double LearntLeft(const Learnt *l, double t_end)
{
  const double t    = l->n ? l->t[l->n - 1] : 0.0;
  double       left = 0.0;

  if (!(t > 0.0))
    return 0.0;
  const double last = CostAt(l, t) - CostAt(l, 0.5 * t), before = CostAt(l, 0.5 * t) - CostAt(l, 0.25 * t);
  const double grows = before > 0.0 ? fmin(fmax(last / before, 0.5), 2.0) : 2.0;

  for (double from = t, cost = grows * last; from < t_end; from *= 2.0, cost *= grows)
    left += cost * fmin((t_end - from) / from, 1.0);
  return left;
}
