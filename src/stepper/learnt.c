/* What a run has learnt of its own cost: time left, (318), (319) and (345) of docs/equations.md, section 15. */
#include "clathra/stepper.h"

#define APART 1.02 /* times that are kept are so far apart */
#define GROWTH 1.2 /* at most: cost of a doubling over that of the one before */
#define RECENT 0.1 /* weight of the last step in the mean cost of one */
#define FEW 4      /* steps from which nothing is concluded, */
#define SHORT 4.0  /* ... nor from a time of so many of the first */
#define BEHIND 0.1 /* of a step: the first one behind a kink */
#define RISE 3.0   /* order of the error that step control sees (26) */

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

static double Last(const Learnt *l)
{
  return l->n ? l->t[l->n - 1] : 0.0;
}

static bool Known(const Learnt *l)
{
  return l->n >= FEW && Last(l) > SHORT * l->t[0];
}

/* (345): share of C_k that a doubling around tau costs behind a kink at t_k; 1 where there was none. */
static double Rise(double tau, double kink)
{
  return tau < kink ? pow(tau / kink, 1.0 / RISE) : 1.0;
}

/* C_k of (345), as far as it is known by now. */
static double Doubling(const Learnt *l)
{
  const double t = Last(l);

  return Known(l) ? (CostAt(l, t) - CostAt(l, 0.5 * t)) / Rise(t, l->kink) : l->doubling;
}

void LearntBegin(Learnt *l, double t, double cost, double kink)
{
  l->doubling = Doubling(l);
  l->n        = 0;
  l->origin   = t;
  l->spent    = cost;
  l->kink     = kink;
}

void LearntAdd(Learnt *l, double t, double cost)
{
  const double now = t - l->origin, paid = cost - l->spent, before = l->n ? l->cost[l->n - 1] : 0.0;

  l->dt   = now - Last(l);
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

/* (345) from `from` to `until`, both since the kink. */
static double Behind(double doubling, double kink, double from, double until, double least)
{
  double left = 0.0;

  for (; from < until; from *= 2.0)
    left += fmax(doubling * Rise(M_SQRT2 * from, kink), least * from) * fmin((until - from) / from, 1.0);
  return left;
}

double LearntLeft(const Learnt *l, const Ahead *a)
{
  const double t = Last(l), least = l->step / a->stretch, doubling = Doubling(l);
  double       begin = l->origin, until = (a->kinks ? a->kink[0] : a->end) - begin, left;

  if (a->even) /* (319) */
    return l->n ? (a->end - l->origin - t) * (CostAt(l, t) - CostAt(l, 0.5 * t)) / (0.5 * t) : NAN;
  if (Known(l))
    left = Doublings(l, t, until, least);
  else if (doubling > 0.0)
    left = Behind(doubling, l->kink, fmax(t, BEHIND * l->dt), until, least);
  else
    return NAN;
  for (int k = 0; k < a->kinks; k++) {
    const double dt = fmin(t > 0.0 ? l->dt * until / t : l->dt, a->stretch);

    begin += until;
    until = (k + 1 < a->kinks ? a->kink[k + 1] : a->end) - begin;
    left += l->step + Behind(doubling, begin - a->begin, fmin(BEHIND * dt, 0.5 * until), until, least);
  }
  return left;
}

void StepperAhead(const Stepper *s, Ahead *a)
{
  const Case *c    = StepperCase(s);
  double      kink = BcNextKink(&c->scene, s->state.t);

  *a = (Ahead){.begin = c->scene.t_begin, .end = c->t_end, .stretch = INFINITY};
  for (; kink < c->t_end && a->kinks < AHEAD_KINKS; kink = BcNextKink(&c->scene, kink))
    a->kink[a->kinks++] = kink;
  a->more = kink < c->t_end;
  a->even = s->explicit || !s->adaptive || a->more;
  if (!a->even)
    a->stretch = (c->t_end - s->state.t) / StepperStops(s, c->t_end - s->state.t, NULL);
}
