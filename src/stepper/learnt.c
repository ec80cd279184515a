/* What a run has learnt of its own steps: how many are left, and the time they take; (318), (319), (345), (411) and
   (412) of docs/equations.md, section 15. */
#include "clathra/stepper.h"

#define APART 1.02   /* times that are kept are so far apart */
#define GROWTH 1.2   /* at most: steps of a doubling over those of the one before */
#define RECENT 0.1   /* weight of the last steps in the mean time of one */
#define FEW 4        /* steps from which nothing is concluded, */
#define SHORT 4.0    /* ... nor from a time of so many of the first */
#define BEHIND 0.1   /* of a step: the first one behind a kink */
#define RISE 3.0     /* order of the error that step control sees (26) */
#define SPREAD M_LN2 /* (411): two of three forecasts are off by less than a factor of two */
#define TRUST 0.1    /* (412): share of the stage from which on the run knows more than the forecast */

/* Up to time t since the origin, linear between what is kept, from nothing at 0 on. */
static double StepsAt(const Learnt *l, double t)
{
  double t0 = 0.0, n0 = 0.0;

  for (int k = 0; k < l->n; k++) {
    if (t <= l->t[k])
      return n0 + (l->steps[k] - n0) * (t - t0) / (l->t[k] - t0);
    t0 = l->t[k];
    n0 = l->steps[k];
  }
  return n0;
}

static double Last(const Learnt *l)
{
  return l->n ? l->t[l->n - 1] : 0.0;
}

static bool Known(const Learnt *l)
{
  return l->n >= FEW && Last(l) > SHORT * l->t[0];
}

/* (345): share of n_k that a doubling around tau takes behind a kink at t_k; 1 where there was none. */
static double Rise(double tau, double kink)
{
  return tau < kink ? pow(tau / kink, 1.0 / RISE) : 1.0;
}

/* n_k of (345), as far as it is known by now. */
static double Doubling(const Learnt *l)
{
  const double t = Last(l);

  return Known(l) ? (StepsAt(l, t) - StepsAt(l, 0.5 * t)) / Rise(t, l->kink) : l->doubling;
}

void LearntBegin(Learnt *l, double t, double kink)
{
  l->doubling = Doubling(l);
  l->n        = 0;
  l->origin   = t;
  l->before   = l->all;
  l->kink     = kink;
}

void LearntAdd(Learnt *l, double t, double steps, double spent)
{
  const double now = t - l->origin, since = steps - l->all;

  l->dt = (now - Last(l)) / since;
  l->told++;
  l->step += fmax(RECENT, 1.0 / l->told) * ((spent - l->spent) / since - l->step);
  l->all   = steps;
  l->spent = spent;
  if (l->n > 1 && now < APART * l->t[l->n - 2])
    l->n--; /* the last one was for the moment */
  if (l->n == LEARNT) {
    for (int k = 0; 2 * k < LEARNT; k++) {
      l->t[k]     = l->t[2 * k];
      l->steps[k] = l->steps[2 * k];
    }
    l->n = (LEARNT + 1) / 2;
  }
  l->t[l->n]       = now;
  l->steps[l->n++] = steps - l->before;
}

/* (318) from the last known time t since the origin on, up to `until`; least: steps of a second that stops ask for. */
static double Doublings(const Learnt *l, double t, double until, double least)
{
  const double last = StepsAt(l, t) - StepsAt(l, 0.5 * t), before = StepsAt(l, 0.5 * t) - StepsAt(l, 0.25 * t);
  const double grows = fmin(fmax(last / before, 1.0), GROWTH);
  double       left  = 0.0;

  for (double from = t, n = grows * last; from < until; from *= 2.0, n *= grows)
    left += fmax(n, least * from) * fmin((until - from) / from, 1.0);
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

double LearntPace(const Learnt *l, const Ahead *a)
{
  const double t = Last(l), least = 1.0 / a->stretch, doubling = Doubling(l);
  double       begin = l->origin, until = (a->kinks ? a->kink[0] : a->end) - begin, left;

  if (a->even) /* (319) */
    return l->n ? (a->end - l->origin - t) * (StepsAt(l, t) - StepsAt(l, 0.5 * t)) / (0.5 * t) : NAN;
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
    left += 1.0 + Behind(doubling, begin - a->begin, fmin(BEHIND * dt, 0.5 * until), until, least);
  }
  return left;
}

/* Share of a normal distribution above z. */
static double Above(double z)
{
  return 0.5 * erfc(z / M_SQRT2);
}

/* In units of the spread. */
static double Beyond(double forecast, double n)
{
  return log(fmax(n, 1e-3) / forecast) / SPREAD;
}

double LearntMedian(double forecast, double n)
{
  const double z   = Beyond(forecast, n);
  double       low = z, high = fmax(z, 0.0) + 1.0;

  if (z > 6.0) /* where the tail is exponential */
    return n * expm1(SPREAD * M_LN2 / z);
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);

    if (Above(middle) > 0.5 * Above(z))
      low = middle;
    else
      high = middle;
  }
  return forecast * exp(SPREAD * low) - n;
}

double LearntSteps(const Learnt *l, const Ahead *a)
{
  const double pace = LearntPace(l, a), share = (l->origin + Last(l) - a->from) / (a->end - a->from);

  if (a->even || !(a->forecast > 0.0))
    return pace;
  const double median = LearntMedian(a->forecast, l->all); /* (411) */
  const double stands = fmin(Above(Beyond(a->forecast, l->all)) / Above(1.0), 1.0),
               weight = share / (share + TRUST * stands);

  return isnan(pace) ? median : pow(pace, weight) * pow(median, 1.0 - weight); /* (412) */
}

double LearntLeft(const Learnt *l, const Ahead *a)
{
  return LearntSteps(l, a) * l->step;
}

void StepperAhead(const Stepper *s, Ahead *a)
{
  const Case *c    = StepperCase(s);
  double      kink = BcNextKink(&c->scene, s->state.t);

  *a = (Ahead){.begin    = c->scene.t_begin,
               .from     = c->scene.t_begin,
               .end      = c->t_end,
               .stretch  = INFINITY,
               .forecast = s->forecast.implicit_steps};
  for (; kink < c->t_end && a->kinks < AHEAD_KINKS; kink = BcNextKink(&c->scene, kink))
    a->kink[a->kinks++] = kink;
  a->more = kink < c->t_end;
  a->even = s->explicit || !s->adaptive || a->more;
  if (!a->even)
    a->stretch = (c->t_end - s->state.t) / StepperStops(s, c->t_end - s->state.t, NULL);
}
