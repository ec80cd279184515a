/* Tears that close before they bear (427): the volume by which a particle opened while its mean stress was a tension is
   squeezed out again at no mean stress. */
#include "plastic.h"

#define SEARCHES 100
#define ROUND_OFF 5e-16 /* of the stresses: a mean stress that is none */
#define NEAR 64.0       /* of that: how near to a raise there is another */

/* What decides about the raise c, the part of the trial mean stress that closing takes up. */
enum { NOTHING_CLOSES, ALL_COMPRESSION, ALL_THAT_IS_OPEN, NO_MEAN_STRESS };
typedef struct {
  double K;     /* bulk modulus, Pa */
  double open;  /* ln J at the start */
  double trial; /* mean stress, Pa */
  double most;  /* K times what is open, Pa: the largest c */
  double c;     /* Pa */
  int    by;    /* of the above */
} Closing;

static double Mean(const double sig[6])
{
  return Trace6(sig) / 3.0;
}

static double MeanSlope(const SkeletonTangent *t, int q)
{
  return (t->d[XX][q] + t->d[YY][q] + t->d[ZZ][q]) / 3.0;
}

/* Bulk modulus over Young's modulus. */
static double BulkFactor(const Elasticity *el)
{
  return 1.0 / (3.0 * (1.0 - 2.0 * el->nu));
}

/* What can be said before the return. */
static Closing Begin(const Returning *r)
{
  Closing c = {.K     = BulkFactor(&r->mat->elasticity) * StageModulus(&r->mat->elasticity, r->d),
               .open  = fmax(r->trial->own[OWN_P_OPENING], 0.0), /* a starred one may be negative */
               .trial = Mean(r->trial->sig)};

  c.most = c.K * c.open;
  c.c    = fmin(fmax(-c.trial, 0.0), c.most);
  c.by   = c.c == 0.0 ? NOTHING_CLOSES : c.c < c.most ? ALL_COMPRESSION : ALL_THAT_IS_OPEN;
  return c;
}

/* Bracket of the least raise with which a return that dilates ends at no mean stress. */
typedef struct {
  double lo, hi;       /* raises: with the first there is compression, with the second none */
  double below, above; /* mean stresses with them */
  double slope;        /* of the mean stress, from the last two raises that were too small; 1: of an elastic state */
} Bracket;

/* Where the mean stress vanishes by what is known.  At an apex it is none for every raise that is large enough, so that
   only those which are too small say where that begins. */
static double Aim(const Bracket *b, double none)
{
  return b->lo - b->below / (b->above <= none ? b->slope : (b->above - b->below) / (b->hi - b->lo));
}

/* Takes what a raise ends at; true: no compression. */
static bool Narrow(double at, double mean, double none, Bracket *b)
{
  if (mean >= -none) {
    b->hi    = at;
    b->above = mean;
    return true;
  }
  b->slope = (mean - b->below) / (at - b->lo);
  b->lo    = at;
  b->below = mean;
  return false;
}

/* The least raise between c and all of it with which a return that dilates ends at no mean stress; `below`: what it
   ends at with c. */
static bool Search(const Returning *r, double none, double below, Closing *c, Landed *l, const char **why)
{
  const double near  = NEAR * none;
  Bracket      b     = {.lo = c->c, .hi = c->most, .below = below, .slope = 1.0};
  bool         found = false;
  double       at    = b.hi;

  if (!ReturnRaised(r, at, l, why))
    return false;
  c->c  = at;
  c->by = ALL_THAT_IS_OPEN;
  if (!Narrow(at, Mean(l->s.sig), none, &b))
    return true;
  c->by = NO_MEAN_STRESS;
  for (int k = 0; k < SEARCHES && b.hi - b.lo > 2.0 * near; k++) {
    const double aim  = Aim(&b, none);
    const bool   aims = !found && k % 4 != 3 && aim > b.lo && aim < b.hi;

    at = found ? b.hi - near : aims ? aim : 0.5 * (b.lo + b.hi); /* one right below that ends there, too? */
    if (!ReturnRaised(r, at, l, why))
      return false;
    found = Narrow(at, Mean(l->s.sig), none, &b) && aims && b.above <= none;
  }
  c->c = b.hi;
  return at == b.hi || ReturnRaised(r, c->c, l, why);
}

/* Slopes of c in the numbers of the step, and what they make of those of the landed state, whose c was held. */
static void Slopes(const Returning *r, const Closing *c, Landed *l)
{
  const Elasticity *el  = &r->mat->elasticity;
  const double      per = (l->per[XX] + l->per[YY] + l->per[ZZ]) / 3.0, mean = Mean(l->s.sig);
  SkeletonTangent  *t = &l->t;

  for (int q = 0; q < SKELETON_IN; q++) {
    const double dK = BulkFactor(el) * StageModulusSlope(el, r->d, q), dtrial = MeanSlope(r->slopes, q);
    const double dc = c->by == NOTHING_CLOSES    ? 0.0
                      : c->by == ALL_COMPRESSION ? -dtrial
                      : c->by == NO_MEAN_STRESS  ? (per > 0.0 ? -MeanSlope(t, q) / per : 0.0)
                                                 : c->open * dK;

    for (int k = 0; k < SKELETON_OUT; k++)
      t->d[k][q] += l->per[k] * dc;
    t->d[SKELETON_WORK][q] -= (MeanSlope(t, q) * c->c + mean * dc - mean * c->c / c->K * dK) / c->K;
  }
}

/* Over, strain and work with what closed, and what stands open now: nothing where there is compression, `none` being a
   mean stress that is none. */
static void End(const Closing *c, double none, Landed *l)
{
  const double mean = Mean(l->s.sig);

  for (int k = XX; k <= ZZ; k++) {
    l->over[k] -= c->c;
    l->e[k] -= c->c / (3.0 * c->K);
  }
  l->s.work -= fmin(mean, 0.0) * c->c / c->K; /* above nothing by round-off alone */
  l->s.own[OWN_P_OPENING] =
      mean < -none ? 0.0 : fmax((c->most - c->c + fmax(c->trial, 0.0) - fmax(mean, 0.0)) / c->K, 0.0);
  if (l->s.region == RETURN_ELASTIC && c->c > 0.0)
    l->s.region = RETURN_CLOSING;
}

bool ReturnTrial(const Returning *r, Landed *l, const char **why)
{
  Closing c    = Begin(r);
  double  size = 0.0;

  for (int k = 0; k < CL_TENSOR; k++)
    size += fabs(r->trial->sig[k]);
  if (!ReturnRaised(r, c.c, l, why))
    return false;
  const double none = ROUND_OFF * (size + c.c), mean = Mean(l->s.sig);

  if (mean < -none && c.c < c.most && !Search(r, none, mean, &c, l, why))
    return false;
  if (r->slopes)
    Slopes(r, &c, l);
  End(&c, none, l);
  return true;
}
