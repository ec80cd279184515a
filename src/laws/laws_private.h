/* Shared by the laws alone: physical constants (as in base.h, which the laws do not see) and two guarded functions. */
#pragma once

#include <math.h>
#include <stddef.h>
#include <string.h>
#include "clathra/inline.h"

#define LAW_GAS_CONSTANT 8.314 /* J/(mol K) */
#define LAW_PI 3.14159265358979323846
#define LAW_LN10 2.30258509299404568402
#define LAW_ZERO_CELSIUS 273.15 /* K */
#define LAW_EXP_MAX 200.0       /* no exponent of a sensible parameter set comes near */
#define LAW_TOE 1e-3            /* width of the C1 toes */
#define LAW_TRAPPED_MIN 1e-4 /* least trapped gas S_gr' of the smooth retention, so that p_c is defined without any */
#define LAW_SMOOTH 0.05      /* default p_s/p_0 of the smooth retention */

/* Position of a name in a NULL-terminated list, -1 if it is not there. */
static inline int LawFind(const char *const names[], const char *name)
{
  for (int i = 0; name && names[i]; i++) {
    if (!strcmp(names[i], name))
      return i;
  }
  return -1;
}

/* Types(): the names of the laws of a kind.  Set(law, type): the law by name, where `...` sets it to number i of the
   list, parameters stay; false, and nothing set, for an unknown name. */
#define LAW_CHOICE(Types, Set, Law, names, ...)                                                                        \
  const char *const *Types(void)                                                                                       \
  {                                                                                                                    \
    return names;                                                                                                      \
  }                                                                                                                    \
  bool Set(Law *law, const char *type)                                                                                 \
  {                                                                                                                    \
    const int i = LawFind(names, type);                                                                                \
                                                                                                                       \
    if (i >= 0) {                                                                                                      \
      __VA_ARGS__;                                                                                                     \
    }                                                                                                                  \
    return i >= 0;                                                                                                     \
  }

/* A law is one formula without branches on the state, written as an INLINE function that gives value and slopes.  One
   state at a time it is called as it is; over arrays a loop calls it, which the compiler makes vector code of, without
   the slopes that the loop drops.  Here those of one number: formula(law, x, &slope) as One and as
   Batch. */
#define LAW_OF_ONE(One, Batch, Law, formula)                                                                           \
  double One(const Law *law, double x, double *slope)                                                                  \
  {                                                                                                                    \
    return formula(law, x, slope);                                                                                     \
  }                                                                                                                    \
  void Batch(const Law *law, int n, const double *restrict x, double *restrict y)                                      \
  {                                                                                                                    \
    const Law l = *law;                                                                                                \
    double    slope;                                                                                                   \
                                                                                                                       \
    for (int q = 0; q < n; q++)                                                                                        \
      y[q] = formula(&l, x[q], &slope);                                                                                \
  }

/* glibc's vector versions of these, which it declares under -ffast-math only. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
  #if __GLIBC_PREREQ(2, 35)
    #define VECTOR __attribute__((simd("notinbranch"), const, nothrow)) extern
VECTOR double exp(double);
VECTOR double log(double);
VECTOR double pow(double, double);
VECTOR double log1p(double);
VECTOR double expm1(double);
  #endif
#endif

/* Not fmax and fmin, which GCC calls as functions; x that is no number stays none. */
INLINE double LawAtLeast(double x, double least)
{
  return x < least ? least : x;
}

INLINE double LawAtMost(double x, double most)
{
  return x > most ? most : x;
}

/* x, in lanes whose result is not used (x <= 0) another number: glibc's vector functions take all lanes one by one
   where the result of one overflows or vanishes. */
INLINE double LawWhereAbove0(double x, double otherwise)
{
  return x <= 0.0 ? otherwise : x;
}

/* exp(x) for |x| <= X = 200; beyond, e^X (1 + x - X) and e^-X/(1 - X - x): C1, positive, increasing, never inf or 0.
   NaN stays NaN. */
INLINE double LawExp(double x, double *dx)
{
  const double e       = exp(LawAtMost(LawAtLeast(x, -LAW_EXP_MAX), LAW_EXP_MAX));
  const double stretch = 1.0 + LawAtLeast(fabs(x) - LAW_EXP_MAX, 0.0);

  *dx = x > 0.0 ? e : e / (stretch * stretch);
  return x > 0.0 ? e * stretch : e / stretch;
}

/* b^n, 0 for b <= 0.  Where n < 2 a toe replaces it below b0 = 1e-3: with t = b/b0 the cubic
   b0^n t^2 [(3 - n) + (n - 2) t] meets b^n in value and slope at b0 and starts flat, so that clipping at 0 is C1. */
INLINE double LawToePower(double b, double n, double *db)
{
  const double x = LawWhereAbove0(b, 1.0);
  double       v = pow(x, n), d = n * v / x;

  if (n < 2.0) {
    const double t = b / LAW_TOE, w = pow(LAW_TOE, n);

    v = b < LAW_TOE ? w * t * t * ((3.0 - n) + (n - 2.0) * t) : v;
    d = b < LAW_TOE ? w / LAW_TOE * t * (2.0 * (3.0 - n) + 3.0 * (n - 2.0) * t) : d;
  }
  *db = b <= 0.0 ? 0.0 : d;
  return b <= 0.0 ? 0.0 : v;
}
