/* Private to skeleton/: returns to the yield surface in principal stresses. */
#pragma once

#include "elastic.h"

#define YIELD_ROUND_OFF 1e-12 /* share of the cohesion: a state returned before is not returned again */

/* Trial state of a return and what it may use. */
typedef struct {
  const Plasticity *law;
  double            G2, lame; /* of Hooke's law per Young's modulus: 2G/E, lambda/E */
  double            E, Sh;
  double            eps;      /* deviatoric plastic strain at the start */
  double            nonlocal; /* that which sets the strength where the law has a nonlocal_length */
  double            y[3];     /* trial stresses, falling, Pa */
} Trial3;

/* Strength at the plastic strain eps, or what the neighbours left of it, which no slope in eps changes. */
static inline void StrengthOf(const Plasticity *law, double Sh, double eps, double nonlocal, Strength *k)
{
  StrengthEvaluate(law, Sh, law->nonlocal > 0.0 ? nonlocal : eps, k);
  if (law->nonlocal > 0.0)
    k->c_e = k->phi_e = k->psi_e = 0.0;
}
static inline void StrengthAt(const Trial3 *t, double eps, Strength *k)
{
  StrengthOf(t->law, t->Sh, eps, t->nonlocal, k);
}

/* Columns of the slopes: the trial stresses, E, S_h. */
enum { BY_E = 3, BY_SH, BY_COUNT };
typedef struct {
  double       y[3], eps;
  double       dy[3][BY_COUNT];
  ReturnRegion region;
  int          iterations;
} Returned;

/* False if no state was found.  Slopes are filled if asked for. */
bool ReturnSmooth(const Trial3 *t, bool slopes, Returned *r); /* flow: menetrey_willam */
bool ReturnPlanes(const Trial3 *t, bool slopes, Returned *r); /* flow: mohr_coulomb */
/* To the apex c/tan(phi); false if the trial state lies more than `slack`, Pa, below it. */
bool ReturnApex(const Trial3 *t, double slack, bool slopes, Returned *r);

bool   Update_MohrCoulomb(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                          SkeletonTangent *t, const char **why);
double Margin_MohrCoulomb(const Material *mat, double Sh, const SkeletonHistory *h);
bool   Block_MohrCoulomb(const Material *mat, const SkeletonBlock *b, const char **why);

/* sqrt(2/3 dev x : dev x) of principal values, and its slopes. */
INLINE double DeviatoricNorm(const double x[3], double dx[3])
{
  const double m = (x[0] + x[1] + x[2]) / 3.0, s[3] = {x[0] - m, x[1] - m, x[2] - m};
  const double n = sqrt(2.0 / 3.0 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]));

#pragma GCC unroll 3
  for (int i = 0; i < 3; i++)
    dx[i] = n > 0.0 ? 2.0 / 3.0 * s[i] / n : 0.0;
  return n;
}
