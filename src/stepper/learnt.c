/* What a run has learnt of its own cost: time left, (318) and (319) of docs/equations.md, section 15. */
#include "clathra/stepper.h"

#define APART 1.02 /* times that are kept are so far apart */
#define GROWTH 1.2 /* at most: cost of a doubling over that of the one before */
#define RECENT 0.1 /* weight of the last step in the mean cost of one */
#define FEW 4      /* steps from which nothing is concluded */

void LearntBegin(Learnt *l, double t, double cost)
{
  l->n      = 0;
  l->origin = t;
  l->spent  = cost;
}

void LearntAdd(Learnt *l, double t, double cost)
{
  const double now = t - l->origin, paid = cost - l->spent, before = l->n ? l->cost[l->n - 1] : 0.0;

  l->step = l->step > 0.0 ? l->step + RECENT * (paid - before - l->step) : paid - before;
  if (l->n > 1 && now < APART * l->t[l->n - 2])
    l->n--; /* the last one was for the moment */
  if (l->n == LEARNT) {
    for (int k = 0; 2 * k < LEARNT; k++) {
      l->t[k]    = l->t[2 * k];
      l->cost[k] = l->cost[2 * k];
    }
    l->n = (LEARNT + 1) / 2;
  }
  l->t[l->n]      = now;
  l->cost[l->n++] = paid;
}

/* Up to time t since the origin, linear between what is kept, from nothing at 0 on. */
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

/* (318) from the last known time t since the origin on, up to `until`; least: cost of a second that stops ask for. */
static double Doublings(const Learnt *l, double t, double until, double least)
{
  const double last = CostAt(l, t) - CostAt(l, 0.5 * t), before = CostAt(l, 0.5 * t) - CostAt(l, 0.25 * t);
  const double grows = fmin(fmax(last / before, 1.0), GROWTH);
  double       left  = 0.0;

  for (double from = t, cost = grows * last; from < until; from *= 2.0, cost *= grows)
    left += fmax(cost, least * from) * fmin((until - from) / from, 1.0);
  return left;
}

double LearntLeft(const Learnt *l, const Ahead *a)
{
  const double t = l->n ? l->t[l->n - 1] : 0.0, least = l->step / a->stretch;
  double       begin = l->origin, left = 0.0;

  if (l->n == 0 || (l->n < FEW && !a->even))
    return NAN;
  if (a->even) /* (319) */
    return (a->end - l->origin - t) * (CostAt(l, t) - CostAt(l, 0.5 * t)) / (0.5 * t);
  for (int k = 0; k <= a->kinks; k++) {
    const double until = (k < a->kinks ? a->kink[k] : a->end) - begin;

    left += (k ? CostAt(l, fmin(t, until)) : 0.0) + Doublings(l, t, until, least);
    begin += until;
  }
  return left;
}

bool StepperAhead(const Stepper *s, Ahead *a)
{
  const Case *c    = StepperCase(s);
  double      kink = BcNextKink(&c->scene, s->state.t);

  *a = (Ahead){.end = c->t_end, .stretch = INFINITY};
  for (; kink < c->t_end && a->kinks < AHEAD_KINKS; kink = BcNextKink(&c->scene, kink))
    a->kink[a->kinks++] = kink;
  a->even = s->explicit || !s->adaptive || kink < c->t_end;
  if (!a->even)
    a->stretch = (c->t_end - s->state.t) / StepperStops(s, c->t_end - s->state.t, NULL);
  return !(kink < c->t_end);
}
