/* Retention: gas share of the fluid-filled pore space s_g(p_c), p_c = p_g - p_w (Pa); van Genuchten (1980), Brooks and
   Corey (1964); (P4), (P6). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

#define PC_MAX 1e9 /* Pa, range searched by RetentionInvert */
#define PLATEAU_EPSILON 4e-16

/* log(1 + e^x), accurate in both tails, and its slope 1/(1 + e^-x). */
INLINE double Softplus(double x, double *dx)
{
  const double e = exp(-fabs(x));

  *dx = (x >= 0.0 ? 1.0 : e) / (1.0 + e);
  return LawAtLeast(x, 0.0) + log1p(e);
}

/* 1 - VG(p), VG = [1 + (p/p_0)^n]^-m = exp(-m sp(L)), n = 1/(1 - m), L = n log(p/p_0): no overflow, and no cancellation
   where VG is near 1.  0 for p <= 0. */
INLINE double Drained(const Retention *law, double p, double *dp)
{
  double       slope;
  const double x = LawWhereAbove0(p, law->p0), n = 1.0 / (1.0 - law->m);
  const double s = -law->m * Softplus(n * log(x / law->p0), &slope);

  *dp = p <= 0.0 ? 0.0 : law->m * n * exp(s) * (slope / x);
  return p <= 0.0 ? 0.0 : -expm1(s);
}

/* (223): s_g = S_gr' exp(p-/p_t) + (1 - S_wr - S_gr')(1 - VG(p+)), p+ = p_s sp(p_c/p_s), p- = -p_s sp(-p_c/p_s).
   Trapped gas is compressed once p_c < 0; C-infinity and increasing, where the printed (P6) is NaN for p_c < 0.
   Zero (or unset) p_smooth, p_trap mean 0.05 p_0, p_0. */
INLINE double Retention_VanGenuchten(const Retention *law, double pc, double *ds_dpc)
{
  const double ps = law->p_smooth > 0.0 ? law->p_smooth : LAW_SMOOTH * law->p0;
  const double pt = RetentionTrapScale(law), Sgr = LawAtLeast(law->Sgr, LAW_TRAPPED_MIN);
  double       up, down, drained_dp;
  const double plus = ps * Softplus(pc / ps, &up), minus = -ps * Softplus(-pc / ps, &down);
  const double trapped = Sgr * exp(minus / pt), room = 1.0 - law->Swr - Sgr;
  const double drained = Drained(law, plus, &drained_dp);

  *ds_dpc = trapped / pt * down + room * drained_dp * up;
  return trapped + room * drained;
}

/* Printed law (P4), (P6) with p_c cut at 0: s_g = S_gr + (1 - S_wr - S_gr)(1 - VG(max(p_c, 0))); C1. */
INLINE double Retention_VanGenuchtenClamped(const Retention *law, double pc, double *ds_dpc)
{
  const double room = 1.0 - law->Swr - law->Sgr, drained = Drained(law, pc, ds_dpc);

  *ds_dpc *= room;
  return law->Sgr + room * drained;
}

/* (224): s_g = S_gr + (1 - S_wr - S_gr)(1 - (p_c/p_0)^-lambda) for p_c > p_0, else S_gr; kink at p_0. */
INLINE double Retention_BrooksCorey(const Retention *law, double pc, double *ds_dpc)
{
  const double x = LawAtLeast(pc, law->p0), room = 1.0 - law->Swr - law->Sgr, s = -law->lambda * log(x / law->p0);

  *ds_dpc = pc <= law->p0 ? 0.0 : room * law->lambda * exp(s) / x;
  return law->Sgr - room * expm1(s);
}

/* The laws by name.  A row makes its function of one state and its loop over n. */
#define RETENTION_LAWS(X)                                                                                              \
  X("van_genuchten", Retention_VanGenuchten)                                                                           \
  X("van_genuchten_clamped", Retention_VanGenuchtenClamped)                                                            \
  X("brooks_corey", Retention_BrooksCorey)

#define NAME(name, Law) name,
#define FUNCTION(name, Law) Law,
#define LOOP(name, Law)                                                                                                \
  static void Law##_Loop(const Retention *law, int n, const double *restrict pc, double *restrict s,                   \
                         double *restrict ds)                                                                          \
  {                                                                                                                    \
    const Retention l = *law;                                                                                          \
                                                                                                                       \
    for (int q = 0; q < n; q++)                                                                                        \
      s[q] = Law(&l, pc[q], &ds[q]);                                                                                   \
  }
#define LOOP_NAME(name, Law) Law##_Loop,

typedef double (*GasShare)(const Retention *, double, double *);
typedef void (*GasShareLoop)(const Retention *, int, const double *, double *, double *);
static const char *const names[] = {RETENTION_LAWS(NAME) NULL};
static const GasShare    laws[]  = {RETENTION_LAWS(FUNCTION)};
RETENTION_LAWS(LOOP)
static const GasShareLoop loops[] = {RETENTION_LAWS(LOOP_NAME)};

#define FULL 1e-12 /* least 1 - S_h: pores that hydrate fills are refused elsewhere */
#define PIECE 32

double RetentionNarrowing(const Retention *law, double Sh)
{
  return law->hydrate > 0.0 ? pow(LawAtLeast(1.0 - Sh, FULL), law->hydrate) : 1.0;
}

/* (320): d/dS_h of s_g((1 - S_h)^n p_c) */
double RetentionHydrateSlope(const Retention *law, double pc, double Sh, double ds_dpc)
{
  return -law->hydrate * pc / LawAtLeast(1.0 - Sh, FULL) * ds_dpc;
}

void RetentionGasShareBatch(const Retention *law, int n, const double *pc, const double *Sh, double *s, double *ds_dpc)
{
  double bare[PIECE], r[PIECE];

  if (law->hydrate == 0.0) {
    law->gas_share_loop(law, n, pc, s, ds_dpc);
    return;
  }
  for (int from = 0; from < n; from += PIECE) {
    const int some = n - from < PIECE ? n - from : PIECE;

    for (int q = 0; q < some; q++) {
      r[q]    = RetentionNarrowing(law, Sh[from + q]);
      bare[q] = r[q] * pc[from + q];
    }
    law->gas_share_loop(law, some, bare, s + from, ds_dpc + from);
    for (int q = 0; q < some; q++)
      ds_dpc[from + q] *= r[q];
  }
}

/* The plateau s_g = S_gr of a clamped law ends at *pc; false for a law without one. */
static bool Plateau(const Retention *law, double *pc)
{
  *pc = law->gas_share == Retention_BrooksCorey ? law->p0 : 0.0;
  return law->gas_share != Retention_VanGenuchten;
}

/* p_c (Pa) without hydrate with s_g(p_c) = sg, by bisection of [-1e9, 1e9] down to neighbouring doubles (about 70
   evaluations; used for initial states only).  On a plateau p_c is its end.  False, and *pc untouched, if the law never
   reaches sg. */
static bool Invert(const Retention *law, double sg, double *pc)
{
  double lo = -PC_MAX, hi = PC_MAX, end, d;

  if (Plateau(law, &end) && fabs(sg - law->Sgr) <= PLATEAU_EPSILON) {
    *pc = end;
    return true;
  }
  if (!(sg > law->gas_share(law, lo, &d) && sg <= law->gas_share(law, hi, &d)))
    return false;
  for (double mid = 0.5 * (lo + hi); mid > lo && mid < hi; mid = 0.5 * (lo + hi)) {
    if (law->gas_share(law, mid, &d) < sg)
      lo = mid;
    else
      hi = mid;
  }
  *pc = sg - law->gas_share(law, lo, &d) < law->gas_share(law, hi, &d) - sg ? lo : hi;
  return true;
}

bool RetentionInvert(const Retention *law, double sg, double Sh, double *pc)
{
  const bool found = Invert(law, sg, pc);

  if (found)
    *pc /= RetentionNarrowing(law, Sh);
  return found;
}

#define VANISHED 20.0 /* e^-20: share of the residual gas that is left */

bool RetentionNoGas(const Retention *law, double Sh, double *pc)
{
  const bool clamped = Plateau(law, pc);

  if (!clamped)
    *pc = -VANISHED * RetentionTrapScale(law);
  *pc /= RetentionNarrowing(law, Sh);
  return !clamped || law->Sgr == 0.0;
}

LAW_CHOICE(RetentionTypes, RetentionSetType, Retention, names, law->gas_share = laws[i], law->gas_share_loop = loops[i],
           law->type = names[i])
