/* What a run has learnt of its own steps: how many are left, and the time they take; (318), (319), (345), (411),
   (412), (420) and (421) of docs/equations.md, section 15. */
#include "clathra/stepper.h"

#define APART 1.02   /* times that are kept are so far apart */
#define GROWTH 1.2   /* at most: steps of a doubling over those of the one before */
#define RECENT 0.1   /* weight of the last steps in the mean time of one */
#define FEW 4        /* steps from which nothing is concluded, */
#define SHORT 4.0    /* ... nor from a time of so many of the first */
#define BEHIND 0.1   /* of a step: the first one behind a kink */
#define RISE 3.0     /* order of the error that step control sees (26) */
#define SPREAD M_LN2 /* (411): two of three forecasts are off by less than a factor of two */
#define SLUMP 0.1    /* (420): steps this much shorter than before begin anew */
#define TRUST 0.1    /* (412): share of the stage from which on the run knows more than the forecast */

/* Up to time t since the origin, linear between what is kept, from nothing at 0 on. */
static double StepsAt(const Trace *r, double t)
{
  double t0 = 0.0, n0 = 0.0;

  for (int k = 0; k < r->n; k++) {
    if (t <= r->t[k])
      return n0 + (r->steps[k] - n0) * (t - t0) / (r->t[k] - t0);
    t0 = r->t[k];
    n0 = r->steps[k];
  }
  return n0;
}

static double Last(const Trace *r)
{
  return r->n ? r->t[r->n - 1] : 0.0;
}

/* Of the doubling that ends at t. */
static double LastDoubling(const Trace *r, double t)
{
  return StepsAt(r, t) - StepsAt(r, 0.5 * t);
}

static bool Known(const Trace *r)
{
  return r->n >= FEW && Last(r) > SHORT * r->t[0];
}

/* To come to time t (s) has taken so many steps since the start. */
static void TraceAdd(Trace *r, double t, double steps)
{
  const double now = t - r->origin;

  if (r->n > 1 && now < APART * r->t[r->n - 2])
    r->n--; /* the last one was for the moment */
  if (r->n == LEARNT) {
    for (int k = 0; 2 * k < LEARNT; k++) {
      r->t[k]     = r->t[2 * k];
      r->steps[k] = r->steps[2 * k];
    }
    r->n = (LEARNT + 1) / 2;
  }
  r->t[r->n]       = now;
  r->steps[r->n++] = steps - r->before;
}

/* (345): share of n_k that a doubling around tau takes behind a kink at t_k; 1 where there was none. */
static double Rise(double tau, double kink)
{
  return tau < kink ? pow(tau / kink, 1.0 / RISE) : 1.0;
}

/* n_k of (345), as far as it is known by now. */
static double Doubling(const Learnt *l)
{
  const double t = Last(&l->trace);

  return Known(&l->trace) ? LastDoubling(&l->trace, t) / Rise(t, l->kink) : l->doubling;
}

void LearntBegin(Learnt *l, double t, double kink)
{
  l->doubling = Doubling(l);
  l->trace    = (Trace){.origin = t, .before = l->all};
  l->slump.n  = 0;
  l->late[0]  = (Mark){t, l->all, l->spent};
  l->marks    = 1;
  l->longest  = 0.0;
  l->kink     = kink;
}

/* (420): have steps fallen far below what they were?  Times count anew, too, from the end of the longest of them on. */
static void Slump(Learnt *l)
{
  const Mark  *m    = l->late;
  const double mean = (m[LEARNT_LATE].t - m[0].t) / (m[LEARNT_LATE].steps - m[0].steps);
  int          from = 1;

  if (mean >= SLUMP * l->longest) {
    l->longest = fmax(l->longest, mean);
    return;
  }
  for (int k = 2; k <= LEARNT_LATE / 2; k++) {
    if (m[k].t - m[k - 1].t > m[from].t - m[from - 1].t)
      from = k;
  }
  l->longest = mean;
  l->slump   = (Trace){.origin = m[from].t, .before = m[from].steps};
  for (int k = from + 1; k < LEARNT_LATE; k++)
    TraceAdd(&l->slump, m[k].t, m[k].steps);
}

void LearntAdd(Learnt *l, double t, double steps, double spent)
{
  const double since = steps - l->all;

  if (l->marks == 0)
    l->late[l->marks++] = (Mark){l->trace.origin, l->all, l->spent};
  l->dt = (t - l->trace.origin - Last(&l->trace)) / since;
  l->told++;
  l->step += fmax(RECENT, 1.0 / l->told) * ((spent - l->spent) / since - l->step);
  l->all   = steps;
  l->spent = spent;
  TraceAdd(&l->trace, t, steps);
  if (l->marks > LEARNT_LATE)
    memmove(l->late, l->late + 1, sizeof(Mark) * (size_t)--l->marks);
  l->late[l->marks++] = (Mark){t, steps, spent};
  if (l->marks > LEARNT_LATE)
    Slump(l);
  if (l->slump.n)
    TraceAdd(&l->slump, t, steps);
}

/* (318) from the last known time t since the origin on, up to `until`; least: steps of a second that stops ask for. */
static double Doublings(const Trace *r, double t, double until, double least, double most)
{
  const double last = LastDoubling(r, t), before = LastDoubling(r, 0.5 * t);
  const double grows = fmin(fmax(last / before, 1.0), most);
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

/* To `until` (s of the scene), before which no kink is, by what one trace shows; NAN: nothing yet. */
static double Stretch(const Learnt *l, const Trace *r, double until, double least)
{
  const double t = Last(r), doubling = Doubling(l);

  if (Known(r))
    return Doublings(r, t, until - r->origin, least, r == &l->trace ? GROWTH : 1.0);
  if (doubling > 0.0)
    return Behind(doubling, r == &l->trace ? l->kink : 0.0, fmax(t, BEHIND * l->dt), until - r->origin, least);
  return NAN;
}

double LearntPace(const Learnt *l, const Ahead *a)
{
  const Trace *r = &l->trace;
  const double t = Last(r), least = 1.0 / a->stretch, doubling = Doubling(l);
  double       begin = r->origin, until = (a->kinks ? a->kink[0] : a->end), left;

  if (a->even) /* the pace so far (319) */
    return r->n ? (a->end - r->origin - t) * LastDoubling(r, t) / (0.5 * t) : NAN;
  left = Stretch(l, r, until, least);
  if (l->slump.n) /* ... or that of the slump (420) */
    left = fmax(left, Stretch(l, &l->slump, until, least));
  until -= begin;
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
  const double pace = LearntPace(l, a), share = (l->trace.origin + Last(&l->trace) - a->from) / (a->end - a->from);

  if (a->even || !(a->forecast > 0.0)) /* no forecast knew of a slump */
    return pace;
  const double median = LearntMedian(a->forecast, l->all); /* of the steps beyond those taken (411) */
  const double stands = fmin(Above(Beyond(a->forecast, l->all)) / Above(1.0), 1.0),
               weight = share / (share + TRUST * stands);

  return isnan(pace) ? median : pow(pace, weight) * pow(median, 1.0 - weight); /* weighted (412) */
}

double LearntLeft(const Learnt *l, const Ahead *a)
{
  return LearntSteps(l, a) * l->step;
}

double LearntFlat(const Learnt *l, const Ahead *a)
{
  const Mark *now = &l->late[l->marks - 1];

  if (l->marks <= LEARNT_LATE)
    return NAN;
  return (a->end - now->t) * (now->spent - l->late[0].spent) / (now->t - l->late[0].t);
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
