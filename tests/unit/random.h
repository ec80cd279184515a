/* Shared by the unit tests: a deterministic random source and derivatives by Ridders' extrapolation of differences. */
#pragma once

#include <math.h>
#include <stdint.h>
#include <string.h>

typedef struct {
  uint64_t s;
} Rng;

static inline double RngUnit(Rng *r) /* xorshift*, [0, 1) */
{
  r->s ^= r->s >> 12;
  r->s ^= r->s << 25;
  r->s ^= r->s >> 27;
  return (double)((r->s * 2685821657736338717ULL) >> 11) * 0x1p-53;
}

static inline double RngBetween(Rng *r, double lo, double hi)
{
  return lo + (hi - lo) * RngUnit(r);
}

static inline double RngLog(Rng *r, double lo, double hi) /* lo, hi > 0 */
{
  return exp(RngBetween(r, log(lo), log(hi)));
}

static inline int RngPick(Rng *r, int n)
{
  return (int)(RngUnit(r) * n);
}

#define RIDDERS_ROWS 48
#define RIDDERS_LEVELS 13

/* d y/d x of a vector function at x: central differences with step, step/2, ..., extrapolated; each row keeps the entry
   of its tableau with the smallest estimated error, in err.  False where the function is not defined. */
typedef bool (*RiddersFunction)(void *ctx, double x, double y[RIDDERS_ROWS]);

static inline bool Ridders(RiddersFunction f, void *ctx, double x, double step, int rows, double dy[RIDDERS_ROWS],
                           double err[RIDDERS_ROWS])
{
  static double a[RIDDERS_LEVELS][RIDDERS_LEVELS][RIDDERS_ROWS];
  double        up[RIDDERS_ROWS], down[RIDDERS_ROWS];

  for (int i = 0; i < rows; i++)
    err[i] = INFINITY;
  for (int n = 0; n < RIDDERS_LEVELS; n++, step *= 0.5) {
    const volatile double hi = x + step, lo = x - step;

    if (!f(ctx, hi, up) || !f(ctx, lo, down))
      return false;
    for (int i = 0; i < rows; i++) {
      double factor = 4.0;

      a[n][0][i] = (up[i] - down[i]) / (hi - lo);
      for (int k = 1; k <= n; k++, factor *= 4.0) {
        a[n][k][i]     = (a[n][k - 1][i] * factor - a[n - 1][k - 1][i]) / (factor - 1.0);
        const double e = fmax(fabs(a[n][k][i] - a[n][k - 1][i]), fabs(a[n][k][i] - a[n - 1][k - 1][i]));

        if (e < err[i]) {
          err[i] = e;
          dy[i]  = a[n][k][i];
        }
      }
    }
  }
  return true;
}
