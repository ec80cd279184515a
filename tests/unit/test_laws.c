/* Unit tests of the laws.  Every law is a row of a table: random states and parameters are checked for finite values,
   bounds, sign of slope, derivatives against differences, and C1 joins.  A new law is tested by adding a row. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>
#include "clathra/laws.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))
#define STATES 100000 /* of the finiteness sweep, per row */
#define POINTS 3000   /* of the difference test, per row */
#define ARGS 3
#define KINKS 4

/* ---------------------------------------------------------------- random numbers: xorshift64*, fixed seed */
static uint64_t rng;

static double Uniform(double a, double b)
{
  rng ^= rng >> 12;
  rng ^= rng << 25;
  rng ^= rng >> 27;
  return a + (b - a) * (double)((rng * 0x2545F4914F6CDD1DULL) >> 11) * 0x1p-53;
}

static double LogUniform(double a, double b)
{
  return exp(Uniform(log(a), log(b)));
}

static bool Chance(double p)
{
  return Uniform(0, 1) < p;
}

/* ---------------------------------------------------------------- one parameter set of all laws */
typedef struct {
  Retention    ret;
  RelPerm      kr;
  Permeability perm;
  Equilibrium  eq;
  Kinetics     kin;
  Liquid       liquid;
  Gas          gas;
  LatentHeat   latent;
  double       salinity;
  Elasticity   young;
  double       X[4];
} Set;

static Set Draw(void)
{
  const double p0 = LogUniform(1, 1e8), Swr = Uniform(0, 0.45), Sgr = Chance(0.2) ? 0 : Uniform(0, 0.45);
  Set          s = {0};

  s.ret = (Retention){.p0 = p0, .m = Uniform(0.05, 0.97), .lambda = LogUniform(0.05, 10), .Swr = Swr, .Sgr = Sgr};
  if (Chance(0.5))
    s.ret.p_smooth = p0 * LogUniform(1e-2, 1), s.ret.p_trap = p0 * LogUniform(1e-1, 10);
  s.kr        = (RelPerm){Uniform(0, 0.45), Uniform(0, 0.45), LogUniform(0.1, 8), LogUniform(0.1, 8), false};
  s.perm      = (Permeability){.k0 = LogUniform(1e-22, 1e-9), .phi0 = Uniform(0.05, 0.9), .mh = LogUniform(0.3, 15)};
  s.perm.kh   = Uniform(0, 1);
  s.perm.Shc  = LogUniform(1e-5, 0.9);
  s.eq        = Chance(0.5) ? (Equilibrium){.A1 = 1000, .A2 = 38.98, .A3 = 8533.8}
                            : (Equilibrium){.A1 = 1.15, .A2 = 49.3185, .A3 = 9459};
  s.kin       = (Kinetics){.K0 = LogUniform(1e-12, 1e6), .dE = Chance(0.2) ? 0 : Uniform(0, 1e6)};
  s.kin.A_geo = LogUniform(1, 1e7);
  s.liquid    = (Liquid){Uniform(500, 3000), Chance(0.2) ? INFINITY : LogUniform(1e6, 1e12), Uniform(0, 1e-3),
                         Uniform(0, 1e7), Uniform(-10, 30)};
  s.gas       = (Gas){
            .M = Uniform(0.01, 0.05), .Tc = Uniform(100, 200), .pc = LogUniform(1e6, 1e7), .eccentric = Uniform(-0.2, 0.4)};
  s.latent =
      (LatentHeat){.C0 = Uniform(4e5, 5e5), .C1 = Uniform(0, 200), .T_ref = Uniform(-10, 30), .dc = -Uniform(0, 300)};
  s.young = (Elasticity){
      LogUniform(1e6, 1e9), LogUniform(1e6, 1e10), Uniform(0, 1), Chance(0.2) ? 1 : LogUniform(0.2, 4), 0.3, false};
  s.eq.shift = Chance(0.5) ? 0 : 1.3;
  s.salinity = Chance(0.5) ? 0 : Uniform(0, 0.16);
  for (int i = 0; i < 4; i++)
    s.X[i] = LogUniform(0.01, 1e6);
  return s;
}

/* ---------------------------------------------------------------- the table */
typedef struct {
  int    n;
  double at[KINKS];
  bool   corner[KINKS]; /* the slope jumps; otherwise the join is C1 */
} Kinks;

typedef struct Row Row;
struct Row {
  const char *name, *type; /* type: name of the law, if it has one */
  double (*f)(const Row *, Set *, const double *x, double *d);
  int    n;                                             /* number of arguments */
  double lo[ARGS], hi[ARGS];                            /* admissible box */
  double (*scale)(const Set *, const double *x, int i); /* length over which f changes little with argument i */
  Kinks (*kinks)(const Set *, const double *x, int i);
  double fmin, fmax; /* bounds of the value, up to round-off */
  int    slope;      /* sign of df/dx0; 0 = any */
};

static double F_Retention(const Row *r, Set *s, const double *x, double *d)
{
  assert_true(RetentionSetType(&s->ret, r->type));
  return RetentionGasShare(&s->ret, x[0], x[1], &d[0], &d[1]);
}
static double F_Narrowed(const Row *r, Set *s, const double *x, double *d)
{
  s->ret.hydrate = 3 * s->ret.m;
  return F_Retention(r, s, x, d);
}
static double F_Water(const Row *r, Set *s, const double *x, double *d)
{
  return RelPermWater(&s->kr, x[0], d);
}
static double F_Gas(const Row *r, Set *s, const double *x, double *d)
{
  return RelPermGas(&s->kr, x[0], d);
}
/* arguments (S_h, phi), relative to k_0 */
static double F_Hydrate(const Row *r, Set *s, const double *x, double *d)
{
  assert_true(PermeabilitySetHydrateType(&s->perm, r->type) && PermeabilitySetPorosityType(&s->perm, "none"));
  s->perm.k0 = 1;
  return PermeabilityEvaluate(&s->perm, x[1], x[0], &d[1], &d[0]);
}
static double F_Porosity(const Row *r, Set *s, const double *x, double *d)
{
  assert_true(PermeabilitySetHydrateType(&s->perm, "power") && PermeabilitySetPorosityType(&s->perm, r->type));
  return PermeabilityEvaluate(&s->perm, x[0], x[1], &d[0], &d[1]);
}
static double F_Equilibrium(const Row *r, Set *s, const double *x, double *d)
{
  assert_true(EquilibriumSetType(&s->eq, r->type));
  return EquilibriumPressure(&s->eq, x[0], d);
}
static double F_Rate(const Row *r, Set *s, const double *x, double *d)
{
  return KineticsRateConstant(&s->kin, x[0], d);
}
static double F_Area(const Row *r, Set *s, const double *x, double *d)
{
  const FormationArea A = KineticsFormationArea(&s->kin, x[0], x[1], x[2]);

  d[0] = A.sw;
  d[1] = A.wet;
  d[2] = A.Sh;
  return A.v;
}
static double F_Liquid(const Row *r, Set *s, const double *x, double *d)
{
  return LiquidDensity(&s->liquid, x[0], x[1], &d[0], &d[1]);
}
static double F_GasDensity(const Row *r, Set *s, const double *x, double *d)
{
  assert_true(GasSetType(&s->gas, r->type));
  return GasDensity(&s->gas, x[0], x[1], &d[0], &d[1]);
}
static double F_Latent(const Row *r, Set *s, const double *x, double *d)
{
  return LatentHeatEvaluate(&s->latent, x[0], d);
}
static double F_Kirchhoff(const Row *r, Set *s, const double *x, double *d)
{
  s->latent.kirchhoff = true;
  return LatentHeatEvaluate(&s->latent, x[0], d);
}
static double F_WaterViscosity(const Row *r, Set *s, const double *x, double *d)
{
  return WaterViscosity(&(Viscosity){.law = WATER_VISCOSITY_KESTIN, .salinity = s->salinity}, x[0], d);
}
static double F_GasExpansion(const Row *r, Set *s, const double *x, double *d)
{
  assert_true(GasSetType(&s->gas, r->type));
  return GasExpansion(&s->gas, x[0], x[1], &d[0], &d[1]);
}

static double F_GasViscosity(const Row *r, Set *s, const double *x, double *d)
{
  return GasViscosity(&(Viscosity){.law = GAS_VISCOSITY_LEE, .M = s->gas.M}, x[0], x[1], &d[0], &d[1]);
}
static double F_Mixture(const Row *r, Set *s, const double *x, double *d)
{
  return MixtureAverage(x[0], x[1], x[2], s->X, &d[0], &d[1], &d[2]);
}
static double F_Young(const Row *r, Set *s, const double *x, double *d)
{
  return ElasticityYoung(&s->young, x[0], d);
}

static double L_Smooth(const Set *s, const double *x, int i)
{
  const double ps = s->ret.p_smooth > 0 ? s->ret.p_smooth : 0.05 * s->ret.p0;

  return (1 - s->ret.m) * (fmin(ps, s->ret.p0) + 0.2 * fmax(x[0], 0));
}
static double L_Narrowed(const Set *s, const double *x, int i)
{
  const double r = RetentionNarrowing(&s->ret, x[1]), bare = r * x[0], h = L_Smooth(s, &bare, 0);

  return i ? (1 - x[1]) * fmin(0.1, h / (s->ret.hydrate * fabs(bare))) : h / r;
}
static double L_Clamped(const Set *s, const double *x, int i)
{
  return 0.3 * (1 - s->ret.m) * fabs(x[0]);
}
static double L_BrooksCorey(const Set *s, const double *x, int i)
{
  return 0.1 * fabs(x[0]);
}
static double Corey(double b, double range)
{
  return 0.1 * fmax(b / range, 1e-3) * range;
}
static double L_Water(const Set *s, const double *x, int i)
{
  return Corey(x[0] - s->kr.Swr, 1 - s->kr.Swr - s->kr.Sgr);
}
static double L_Gas(const Set *s, const double *x, int i)
{
  return Corey(x[0] - s->kr.Sgr, 1 - s->kr.Swr - s->kr.Sgr);
}
static double L_Fraction(const Set *s, const double *x, int i)
{
  return 0.1 * fmin(x[i], 1 - x[i]);
}
static double L_Liquid(const Set *s, const double *x, int i)
{
  return i ? 5 : isinf(s->liquid.K) ? 1e6 : 0.1 * s->liquid.K;
}
static double L_GasDensity(const Set *s, const double *x, int i)
{
  return i ? 5 : 0.1 * x[0];
}
static double L_Kelvin(const Set *s, const double *x, int i)
{
  return 1;
}

static Kinks None(void)
{
  return (Kinks){.n = 0};
}
static Kinks Join(double at)
{
  return (Kinks){.n = 1, .at = {at}};
}
static Kinks Corner(double at)
{
  return (Kinks){.n = 1, .at = {at}, .corner = {true}};
}
static Kinks K_Clamped(const Set *s, const double *x, int i)
{
  return Corner(0); /* C1, but the slope grows as p_c^(m/(1-m)): a corner in all but name for small m */
}
static Kinks K_BrooksCorey(const Set *s, const double *x, int i)
{
  return Corner(s->ret.p0);
}
static Kinks K_Water(const Set *s, const double *x, int i)
{
  const double a = s->kr.Swr, range = 1 - a - s->kr.Sgr;

  return (Kinks){3, {a, a + 1e-3 * range, a + range}, {false, false, true}};
}
static Kinks K_Gas(const Set *s, const double *x, int i)
{
  const double a = s->kr.Sgr, range = 1 - a - s->kr.Swr;

  return (Kinks){3, {a, a + 1e-3 * range, a + range}, {false, false, true}};
}
static Kinks K_Power(const Set *s, const double *x, int i)
{
  return i ? None() : Join(1 - 1e-3);
}
static Kinks K_Porosity(const Set *s, const double *x, int i)
{
  return i ? Join(1 - 1e-3) : None();
}
static Kinks K_Ramp(const Set *s, const double *x, int i)
{
  return i ? None() : Corner(s->perm.Shc);
}
static Kinks K_Moridis(const Set *s, const double *x, int i)
{
  const double by = s->eq.shift;

  return (Kinks){
      4, {148.8 - 273.15 - by, 0.333443449 - 0.25 - by, 0.333443449 + 0.25 - by, 320 - 273.15 - by}, {false}};
}
static Kinks K_Kamath(const Set *s, const double *x, int i)
{
  const double at = 0.80665842 - s->eq.shift;

  return (Kinks){2, {at - 0.25, at + 0.25}, {false}};
}
static Kinks K_Kestin(const Set *s, const double *x, int i)
{
  return (Kinks){2, {-40, 180}, {true, true}};
}
static Kinks K_Rate(const Set *s, const double *x, int i)
{
  return Join(s->kin.dE / (8.314 * 200) - 273.15);
}
static Kinks K_Liquid(const Set *s, const double *x, int i)
{
  const Liquid *l = &s->liquid;

  if (isinf(l->K))
    return None();
  if (i)
    return Join(l->T_ref + ((x[0] - l->p_ref) / l->K - 200) / l->beta);
  return Join(l->p_ref + l->K * (200 + l->beta * (x[1] - l->T_ref)));
}
static Kinks K_Young(const Set *s, const double *x, int i)
{
  return (Kinks){.n = s->young.bh < 1 ? 2 : 1, .at = {1e-3, 0}}; /* steeper than b_h = 1 at 0: the toe */
}

#define PC                                                                                                             \
  {-1e9},                                                                                                              \
  {                                                                                                                    \
    1e9                                                                                                                \
  }
static const Row rows[] = {
    {"retention", "van_genuchten", F_Retention, 1, PC, L_Smooth, NULL, 0, 1, 1},
    {"retention", "van_genuchten_clamped", F_Retention, 1, PC, L_Clamped, K_Clamped, 0, 1, 1},
    {"retention", "brooks_corey", F_Retention, 1, PC, L_BrooksCorey, K_BrooksCorey, 0, 1, 1},
    {"narrowed", "van_genuchten", F_Narrowed, 2, {-1e9, 0}, {1e9, 0.95}, L_Narrowed, NULL, 0, 1, 1},
    {"relperm water", NULL, F_Water, 1, {0}, {1}, L_Water, K_Water, 0, 1, 1},
    {"relperm gas", NULL, F_Gas, 1, {0}, {1}, L_Gas, K_Gas, 0, 1, 1},
    {"hydrate", "power", F_Hydrate, 2, {0, 0.01}, {1, 0.99}, L_Fraction, K_Power, 0, 1, -1},
    {"hydrate", "masuda_ramp", F_Hydrate, 2, {0, 0.01}, {1, 0.99}, L_Fraction, K_Ramp, 0, 1, -1},
    {"hydrate", "none", F_Hydrate, 2, {0, 0.01}, {1, 0.99}, L_Fraction, NULL, 1, 1, 0},
    {"porosity", "kozeny_carman", F_Porosity, 2, {1e-12, 0}, {1 - 1e-12, 1}, L_Fraction, K_Porosity, 0, INFINITY, 1},
    {"porosity", "square_jacobian", F_Porosity, 2, {1e-12, 0}, {1 - 1e-12, 1}, L_Fraction, K_Porosity, 0, INFINITY, 1},
    {"porosity", "none", F_Porosity, 2, {1e-12, 0}, {1 - 1e-12, 1}, L_Fraction, K_Porosity, 0, INFINITY, 0},
    {"equilibrium", "sloan", F_Equilibrium, 1, {-50}, {150}, L_Kelvin, NULL, 1e3, 1e14, 1},
    {"equilibrium", "moridis", F_Equilibrium, 1, {-200}, {150}, L_Kelvin, K_Moridis, 10, 1e15, 1},
    {"equilibrium", "kamath", F_Equilibrium, 1, {-50}, {150}, L_Kelvin, K_Kamath, 1e3, 1e12, 1},
    {"equilibrium", "masuda", F_Equilibrium, 1, {-50}, {150}, L_Kelvin, NULL, 1e2, 1e13, 1},
    {"rate constant", NULL, F_Rate, 1, {-50}, {150}, L_Kelvin, K_Rate, 0, 1e6, 1},
    {"formation area", NULL, F_Area, 3, {0, 0, 0}, {1, 1, 1}, L_Fraction, NULL, 0, 1e7, 0},
    {"liquid density", NULL, F_Liquid, 2, {1, -50}, {1e9, 150}, L_Liquid, K_Liquid, 1e-90, INFINITY, 1},
    {"gas density", "ideal", F_GasDensity, 2, {1, -50}, {1e9, 150}, L_GasDensity, NULL, 0, INFINITY, 1},
    {"gas density", "peng_robinson", F_GasDensity, 2, {1, -50}, {1e9, 150}, L_GasDensity, NULL, 0, INFINITY, 1},
    {"latent heat", NULL, F_Latent, 1, {-50}, {150}, L_Kelvin, NULL, 3e5, 5e5, -1},
    {"latent heat", "kirchhoff", F_Kirchhoff, 1, {-50}, {150}, L_Kelvin, NULL, 2e5, 6e5, -1},
    {"water viscosity", "kestin", F_WaterViscosity, 1, {-60}, {200}, L_Kelvin, K_Kestin, 1e-5, 0.1, -1},
    {"gas expansion", "peng_robinson", F_GasExpansion, 2, {1, -50}, {1e8, 150}, L_GasDensity, NULL, 0, INFINITY, 0},
    {"gas viscosity", "lee", F_GasViscosity, 2, {1e-3, -50}, {400, 150}, L_GasDensity, NULL, 1e-6, INFINITY, 1},
    {"mixture", NULL, F_Mixture, 3, {0, 0, 0}, {1, 1, 1}, L_Fraction, NULL, 0.01, 1e6, 0},
    {"Young", NULL, F_Young, 1, {0}, {1}, L_Fraction, K_Young, 1e6, 1.2e10, 1},
};

/* Corners of the box, joins, both sides of 0 in many decades, or uniform. */
static double Sample(const Row *r, const Set *s, const double *x, int i)
{
  const double lo = r->lo[i], hi = r->hi[i], u = Uniform(0, 1);
  const Kinks  k = r->kinks ? r->kinks(s, x, i) : None();
  double       v = Uniform(lo, hi);

  if (u < 0.05)
    v = lo;
  else if (u < 0.1)
    v = hi;
  else if (u < 0.2 && k.n)
    v = k.at[(int)Uniform(0, k.n)];
  else if (u < 0.3)
    v = hi - LogUniform(1e-12, 1) * (hi - lo);
  else if (u < 0.4)
    v = lo + LogUniform(1e-12, 1) * (hi - lo);
  else if (u < 0.7 && lo < -1e3)
    v = (Chance(0.5) ? 1 : -1) * s->ret.p0 * LogUniform(1e-5, 1e5);
  return fmax(lo, fmin(v, hi));
}

static void DrawState(const Row *r, Set *s, double *x)
{
  *s = Draw();
  for (int i = r->n - 1; i >= 0; i--)
    x[i] = Sample(r, s, x, i);
}

static const char *Label(const Row *r)
{
  static char text[64];

  snprintf(text, sizeof text, "%s %s", r->name, r->type ? r->type : "");
  return text;
}

/* ---------------------------------------------------------------- tests over the table */
static void Finite_Bounded_Monotone(void **state)
{
  for (size_t k = 0; k < COUNT(rows); k++) {
    const Row *r = &rows[k];

    for (int j = 0; j < STATES; j++) {
      Set    s;
      double x[ARGS] = {0}, d[ARGS];

      for (int i = 0; i < ARGS; i++)
        d[i] = i < r->n ? NAN : 0; /* a derivative that is not set is found */
      DrawState(r, &s, x);
      const double f = r->f(r, &s, x, d);

      if (!isfinite(f) || !isfinite(d[0]) || !isfinite(d[1]) || !isfinite(d[2]) || !(f >= r->fmin * (1 - 4e-16)) ||
          !(f <= r->fmax * (1 + 4e-16)) || d[0] * r->slope < 0)
        fail_msg("%s at (%.17g, %.17g, %.17g): f = %.17g, d = %g %g %g", Label(r), x[0], x[1], x[2], f, d[0], d[1],
                 d[2]);
    }
  }
}

/* df/dx_i by central differences and Ridders' extrapolation, first step h. */
static double Difference(const Row *r, Set *s, const double *x, int i, double h)
{
  enum { LEVELS = 8 };
  double a[LEVELS][LEVELS], best = 0, error = INFINITY;

  for (int n = 0; n < LEVELS; n++, h /= 1.6) {
    double xp[ARGS], xm[ARGS], d[ARGS], factor = 1;

    memcpy(xp, x, sizeof xp);
    memcpy(xm, x, sizeof xm);
    xp[i] += h;
    xm[i] -= h;
    a[0][n] = (r->f(r, s, xp, d) - r->f(r, s, xm, d)) / (xp[i] - xm[i]);
    for (int m = 1; m <= n; m++) {
      factor *= 1.6 * 1.6;
      a[m][n]        = (a[m - 1][n] * factor - a[m - 1][n - 1]) / (factor - 1);
      const double e = fmax(fabs(a[m][n] - a[m - 1][n]), fabs(a[m][n] - a[m - 1][n - 1]));

      if (e < error)
        error = e, best = a[m][n];
    }
  }
  return best;
}

/* Largest first step that stays inside the box's smooth piece around x; 0 if x sits on a join. */
static double FirstStep(const Row *r, const Set *s, const double *x, int i)
{
  const Kinks k = r->kinks ? r->kinks(s, x, i) : None();
  double      h = r->scale(s, x, i);

  for (int j = 0; j < k.n; j++)
    h = fmin(h, 0.9 * fabs(x[i] - k.at[j]));
  return h < 1e-3 * r->scale(s, x, i) ? 0 : h;
}

static void Derivatives(void **state)
{
  for (size_t k = 0; k < COUNT(rows); k++) {
    const Row *r     = &rows[k];
    int        tried = 0;
    double     worst = 0;

    for (int j = 0; j < POINTS; j++) {
      Set    s;
      double x[ARGS] = {0}, d[ARGS], unused[ARGS];

      DrawState(r, &s, x);
      const double f = r->f(r, &s, x, d);

      for (int i = 0; i < r->n; i++) {
        const double h = FirstStep(r, &s, x, i);

        if (!(h > 1e-7 * fabs(x[i])))
          continue; /* on a join, or below the resolution of x */
        const double fd = Difference(r, &s, x, i, h), noise = fmax(fabs(f), fabs(r->f(r, &s, x, unused)));
        const double tol = 1e-7 * fabs(d[i]) + (1e-13 + 1e-15 * fabs(x[i]) / h) * noise / h + 1e-290;

        tried++;
        worst = fmax(worst, fabs(fd - d[i]) / tol);
        if (!(fabs(fd - d[i]) <= tol))
          fail_msg("%s, derivative %d at (%.17g, %.17g, %.17g): %.12g, differences %.12g +- %.1e", Label(r), i, x[0],
                   x[1], x[2], d[i], fd, tol);
      }
    }
    print_message("%-36s %5d differences, worst %.2g of the tolerance\n", Label(r), tried, worst);
    assert_true(tried > POINTS / 3);
  }
}

static void Joins(void **state)
{
  for (size_t k = 0; k < COUNT(rows); k++) {
    const Row   *r     = &rows[k];
    const double floor = r->fmax == 1 ? 1e-6 : 0; /* laws of order 1 that start from 0 */

    for (int j = 0; j < POINTS && r->kinks; j++) {
      Set    s;
      double x[ARGS] = {0};

      DrawState(r, &s, x);
      for (int i = 0; i < r->n; i++) {
        const Kinks all = r->kinks(&s, x, i);

        for (int q = 0; q < all.n; q++) {
          double       a[ARGS], b[ARGS], da[ARGS], db[ARGS];
          const double step = 4e-16 * (fabs(all.at[q]) + 1) + (r->kinks == K_Moridis ? 1e-9 : 0); /* 9 digits given */

          memcpy(a, x, sizeof a);
          memcpy(b, x, sizeof b);
          a[i]            = all.at[q] - step;
          b[i]            = all.at[q] + step;
          const double fa = r->f(r, &s, a, da), fb = r->f(r, &s, b, db), big = fmax(fabs(da[i]), fabs(db[i]));

          if (fabs(fa - fb) > 1e-8 * floor + 1e-13 * fmax(fabs(fa), fabs(fb)) + 2 * big * (b[i] - a[i]) ||
              (!all.corner[q] && fabs(da[i] - db[i]) > floor + 1e-6 * big + 1e-6 * fmax(fabs(fa), fabs(fb))))
            fail_msg("%s jumps at %.17g: %.17g, %.17g; slopes %g, %g", Label(r), all.at[q], fa, fb, da[i], db[i]);
        }
      }
    }
  }
}

/* A NaN of the solver must come out as NaN, not be hidden by a clip. */
static void NaN_Stays(void **state)
{
  for (size_t k = 0; k < COUNT(rows); k++) {
    const Row *r = &rows[k];

    if (r->type && !strcmp(r->type, "none"))
      continue;
    for (int j = 0; j < 100; j++) {
      Set    s       = Draw();
      double x[ARGS] = {NAN, 0.5, 0.5}, d[ARGS];

      if (s.kin.dE == 0 || isinf(s.liquid.K))
        continue;
      if (!isnan(r->f(r, &s, x, d)))
        fail_msg("%s hides a NaN", Label(r));
    }
  }
}

/* Every name a law offers has a row, and no other name is taken. */
static void Names(void **state)
{
  const struct {
    const char        *row;
    const char *const *names;
  } lists[] = {{"retention", RetentionTypes()},
               {"hydrate", PermeabilityHydrateTypes()},
               {"porosity", PermeabilityPorosityTypes()},
               {"equilibrium", EquilibriumTypes()}};
  Set s     = Draw();

  for (size_t k = 0; k < COUNT(lists); k++) {
    int offered = 0, tested = 0;

    for (; lists[k].names[offered]; offered++) {
      for (size_t j = 0; j < COUNT(rows); j++)
        tested += !strcmp(rows[j].name, lists[k].row) && !strcmp(rows[j].type, lists[k].names[offered]);
    }
    if (offered == 0 || offered != tested)
      fail_msg("%s: %d laws, %d rows", lists[k].row, offered, tested);
  }
  assert_true(RetentionSetType(&s.ret, "brooks_corey") && EquilibriumSetType(&s.eq, "moridis"));
  assert_string_equal(s.ret.type, "brooks_corey");
  const char *const wrong[] = {NULL, "", "van_genuchte", "van_genuchtenn", "Power", "nonesuch"};

  for (size_t k = 0; k < COUNT(wrong); k++) {
    assert_false(RetentionSetType(&s.ret, wrong[k]) || EquilibriumSetType(&s.eq, wrong[k]) ||
                 PermeabilitySetHydrateType(&s.perm, wrong[k]) || PermeabilitySetPorosityType(&s.perm, wrong[k]));
  }
  assert_string_equal(s.ret.type, "brooks_corey");
  assert_string_equal(s.eq.type, "moridis");
}

static const Retention BP2 = {.p0 = 5e4, .m = 0.3, .lambda = 0.5, .Swr = 0.2, .Sgr = 0.4};

static void RetentionInversion(void **state)
{
  Retention law = BP2;
  double    pc, d, none;

  for (int k = 0; RetentionTypes()[k]; k++) {
    int found = 0;

    for (int j = 0; j < 3000; j++) {
      law = Draw().ret;
      RetentionSetType(&law, RetentionTypes()[k]);
      const double from = (Chance(0.5) ? 1 : -1) * law.p0 * LogUniform(1e-3, 1e2),
                   sg   = RetentionGasShare(&law, from, 0.0, &d, &none);

      if (!(sg > 1e-300) || fabs(from) > 1e9)
        continue;
      assert_true(RetentionInvert(&law, sg, 0.0, &pc));
      const double back = RetentionGasShare(&law, pc, 0.0, &d, &none);

      if (!(fabs(back - sg) <= 4e-16 + 4e-16 * fabs(pc) * d))
        fail_msg("%s: %.17g from %.17g", law.type, back, sg);
      found++;
    }
    assert_true(found > 1500);
    law = BP2;
    RetentionSetType(&law, RetentionTypes()[k]);
    pc = 7;
    assert_false(RetentionInvert(&law, 0.8, 0.0, &pc) || RetentionInvert(&law, 1.1, 0.0, &pc) ||
                 RetentionInvert(&law, 0, 0.0, &pc) || RetentionInvert(&law, -0.1, 0.0, &pc) ||
                 RetentionInvert(&law, NAN, 0.0, &pc));
    assert_true(pc == 7);
  }
  law = BP2;
  RetentionSetType(&law, "van_genuchten");
  assert_true(RetentionInvert(&law, 0.38735372246897245, 0.0, &pc) && fabs(pc) < 1e-9); /* p_c = 0 */
  assert_true(RetentionInvert(&law, 0.1, 0.0, &pc) && pc < 0);
  RetentionSetType(&law, "van_genuchten_clamped");
  assert_true(RetentionInvert(&law, 0.4, 0.0, &pc) && pc == 0);
  assert_true(RetentionInvert(&law, 1 - 0.6, 0.0, &pc) && pc == 0);
  assert_false(RetentionInvert(&law, 0.39, 0.0, &pc));
  RetentionSetType(&law, "brooks_corey");
  assert_true(RetentionInvert(&law, 0.4, 0.0, &pc) && pc == law.p0);
  assert_false(RetentionInvert(&law, 0.39, 0.0, &pc));
}

static int Seed(void **state)
{
  rng = 0x9E3779B97F4A7C15ULL;
  return 0;
}

#define TEST(f) cmocka_unit_test_setup(f, Seed)

int main(void)
{
  const struct CMUnitTest tests[] = {
      TEST(Finite_Bounded_Monotone), TEST(Derivatives), TEST(Joins), TEST(NaN_Stays), TEST(Names),
      TEST(RetentionInversion)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
