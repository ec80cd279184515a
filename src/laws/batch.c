/* The laws over arrays.  The loops below repeat the formulae of their files without branches;
   tests/unit/test_laws_batch.c holds them together. */
#include "clathra/laws_batch.h"
#include "laws_private.h"

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

/* fmax and fmin, which GCC calls as functions, for numbers that are numbers. */
static inline double Larger(double a, double b)
{
  return a > b ? a : b;
}

static inline double Smaller(double a, double b)
{
  return a < b ? a : b;
}

#define LEAST 1e-300 /* keeps logarithms of zero out of lanes that are not used */

static void SmoothVanGenuchten(const Retention *law, int n, const double *pc, double *s, double *ds)
{
  const double ps = law->p_smooth > 0.0 ? law->p_smooth : LAW_SMOOTH * law->p0, per_ps = 1.0 / ps;
  const double pt = law->p_trap > 0.0 ? law->p_trap : law->p0, Sgr = Larger(law->Sgr, LAW_TRAPPED_MIN);
  const double room = 1.0 - law->Swr - Sgr, power = 1.0 / (1.0 - law->m), m = law->m, log_p0 = log(law->p0);

  for (int q = 0; q < n; q++) {
    const double x = pc[q] * per_ps, e = exp(-fabs(x)), l = log1p(e), up = (x >= 0.0 ? 1.0 : e) / (1.0 + e);
    const double plus = Larger(ps * (Larger(x, 0.0) + l), LEAST), minus = -ps * (Larger(-x, 0.0) + l);
    const double trapped = Sgr * exp(minus / pt), L = power * (log(plus) - log_p0), eL = exp(-fabs(L));
    const double exponent = -m * (Larger(L, 0.0) + log1p(eL)), VG = exp(exponent),
                 slope = (L >= 0.0 ? 1.0 : eL) / (1.0 + eL);

    s[q]  = trapped - room * expm1(exponent);
    ds[q] = trapped / pt * (1.0 - up) + room * m * power * VG * (slope / plus) * up;
  }
}

void RetentionGasShareBatch(const Retention *law, int n, const double *pc, double *s, double *ds)
{
  if (!strcmp(law->type, "van_genuchten")) {
    SmoothVanGenuchten(law, n, pc, s, ds);
    return;
  }
  for (int q = 0; q < n; q++)
    s[q] = RetentionGasShare(law, pc[q], &ds[q]);
}

/* b^n as LawToePower, for n >= 2 or above the toe; the rare rest is done again one by one. */
static void ToePower(int n, double power, double *b)
{
  if (power < 2.0) {
    double d;

    for (int q = 0; q < n; q++)
      b[q] = LawToePower(b[q], power, &d);
    return;
  }
  for (int q = 0; q < n; q++)
    b[q] = b[q] > 0.0 ? pow(Larger(b[q], LEAST), power) : 0.0;
}

static void Corey(int n, double own, double range, double power, const double *s, double *kr)
{
  for (int q = 0; q < n; q++)
    kr[q] = Smaller((s[q] - own) / range, 1.0);
  ToePower(n, power, kr);
}

void RelPermWaterBatch(const RelPerm *law, int n, const double *sw, double *kr)
{
  Corey(n, law->Swr, 1.0 - law->Swr - law->Sgr, law->nw, sw, kr);
}

void RelPermGasBatch(const RelPerm *law, int n, const double *sg, double *kr)
{
  Corey(n, law->Sgr, 1.0 - law->Swr - law->Sgr, law->ng, sg, kr);
}

static bool Is(const char *type, const char *name)
{
  return !strcmp(type, name);
}

void PermeabilityBatch(const Permeability *law, int n, const double *phi, const double *Sh, double *k)
{
  const double per_phi0 = 1.0 / law->phi0;
  const bool   kozeny = Is(law->porosity_type, "kozeny_carman"), square = Is(law->porosity_type, "square_jacobian");
  double       d;

  if (Is(law->hydrate_type, "power")) {
    for (int q = 0; q < n; q++)
      k[q] = 1.0 - Sh[q];
    ToePower(n, law->mh, k);
  } else if (Is(law->hydrate_type, "none")) {
    for (int q = 0; q < n; q++)
      k[q] = 1.0;
  } else {
    for (int q = 0; q < n; q++)
      k[q] = law->hydrate_factor(law, Sh[q], &d);
  }
  if (kozeny) {
    for (int q = 0; q < n; q++) {
      const double r = phi[q] * per_phi0, J = (1.0 - law->phi0) / (1.0 - phi[q]);

      k[q] *= law->k0 * r * sqrt(r) * J * J * J;
    }
  } else if (square) {
    for (int q = 0; q < n; q++) {
      const double J = (1.0 - law->phi0) / (1.0 - phi[q]);

      k[q] *= law->k0 * J * J;
    }
  } else {
    for (int q = 0; q < n; q++)
      k[q] *= law->k0 * law->porosity_factor(law, phi[q], &d);
  }
}

void LiquidDensityBatch(const Liquid *law, int n, const double *p, const double *T, double *rho)
{
  const double per_K = 1.0 / law->K;

  if (per_K == 0.0 && law->beta == 0.0) {
    for (int q = 0; q < n; q++)
      rho[q] = law->rho0;
    return;
  }
  for (int q = 0; q < n; q++) {
    const double x = (p[q] - law->p_ref) * per_K - law->beta * (T[q] - law->T_ref);

    rho[q] = law->rho0 * exp(Larger(Smaller(x, LAW_EXP_MAX), -LAW_EXP_MAX));
  }
}

void ElasticityYoungBatch(const Elasticity *law, int n, const double *Sh, double *E)
{
  const double a = law->ah * law->Eh;
  double       d;

  if (law->bh == 1.0 || a == 0.0) {
    for (int q = 0; q < n; q++)
      E[q] = law->E0 + a * Sh[q];
    return;
  }
  for (int q = 0; q < n; q++)
    E[q] = ElasticityYoung(law, Sh[q], &d);
}
