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
  double all;   /* K times what is open, and what the trial state opens, Pa */
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

  c.all = c.K * c.open + fmax(c.trial, 0.0);
  c.c   = fmin(fmax(-c.trial, 0.0), c.all);
  c.by  = c.c == 0.0 ? NOTHING_CLOSES : c.c < c.all ? ALL_COMPRESSION : ALL_THAT_IS_OPEN;
  return c;
}

/* The least raise between c and all of it with which a return that dilates ends at no mean stress; `below`: what it
   ends at with c. */
static bool Search(const Returning *r, double none, double below, Closing *c, Landed *l, const char **why)
{
  const double near = NEAR * none;
  double       lo = c->c, hi = c->all, above;
  bool         probed = false;

  if (!ReturnRaised(r, hi, l, why))
    return false;
  above = Mean(l->s.sig);
  c->c  = hi;
  c->by = above < -none ? ALL_THAT_IS_OPEN : NO_MEAN_STRESS;
  if (c->by == ALL_THAT_IS_OPEN)
    return true;
  for (int k = 0; k < SEARCHES && hi - lo > 2.0 * near; k++) {
    const bool   found = above <= none, probes = found && !probed; /* is there none right below, too: at an apex? */
    const double at = probes                ? hi - near
                      : found || k % 3 == 2 ? 0.5 * (lo + hi)
                                            : lo - below / (above - below) * (hi - lo);

    if (!ReturnRaised(r, at, l, why))
      return false;
    const double mean = Mean(l->s.sig);

    probed |= probes;
    if (mean < -none) {
      lo    = at;
      below = mean;
    } else {
      hi = c->c = at;
      above     = mean;
    }
  }
  return ReturnRaised(r, c->c, l, why);
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
                                                 : c->open * dK + (c->trial > 0.0 ? dtrial : 0.0);

    for (int k = 0; k < SKELETON_OUT; k++)
      t->d[k][q] += l->per[k] * dc;
    t->d[SKELETON_WORK][q] -= (MeanSlope(t, q) * c->c + mean * dc - mean * c->c / c->K * dK) / c->K;
  }
}

/* Over, strain and work with what closed, and what stands open now. */
static void End(const Closing *c, Landed *l)
{
  const double mean = Mean(l->s.sig);

  for (int k = XX; k <= ZZ; k++) {
    l->over[k] -= c->c;
    l->e[k] -= c->c / (3.0 * c->K);
  }
  l->s.work -= fmin(mean, 0.0) * c->c / c->K; /* above nothing by round-off alone */
  l->s.own[OWN_P_OPENING] = fmax((c->all - c->c - fmax(mean, 0.0)) / c->K, 0.0);
  if (l->s.region == RETURN_ELASTIC && c->c > 0.0)
    l->s.region = RETURN_CLOSING;
}

bool ReturnWithTears(const Returning *r, Landed *l, const char **why)
{
  Closing c    = Begin(r);
  double  size = 0.0;

  for (int k = 0; k < CL_TENSOR; k++)
    size += fabs(r->trial->sig[k]);
  if (!ReturnRaised(r, c.c, l, why))
    return false;
  const double none = ROUND_OFF * (size + c.c), mean = Mean(l->s.sig);

  if (mean < -none && c.c < c.all && !Search(r, none, mean, &c, l, why))
    return false;
  if (r->slopes)
    Slopes(r, &c, l);
  End(&c, l);
  return true;
}
