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

/* ---------------------------------------------------------------- a trial state, principal.c */
#define NEAR_EQUAL 1e-8 /* principal stresses closer than this share of their size: limit of the spin part */

/* Principal stresses y of a stress, falling, and their directions. */
#if CL_DIM == 2
typedef struct {
  double mean, radius, c2, s2; /* of Mohr's circle: xx - yy = 2 radius c2, xy = radius s2 */
  int    order[3];             /* of y: 0, 1 in the plane, 2 out of it */
  double y[3];
} Principal;
#else
typedef struct {
  double Q[3][3]; /* directions in columns */
  double y[3];
} Principal;
#endif
void PrincipalOf(const double sig[6], Principal *p);
/* The stress with principal values y in the directions of p. */
void FromPrincipal(const Principal *p, const double y[3], double sig[6]);
/* Takes the returned state r into s; what that takes off the trial stress in `over`, with the plastic strain e. */
void TakeReturned(const Material *mat, double E, const Principal *p, const Returned *r, SkeletonState *s,
                  double over[CL_TENSOR], double e[CL_TENSOR]);

/* d(stress)/d(trial stress) from the slopes of principal values, and the columns of E and S_h. */
void StressSlopes(const Principal *p, const Returned *r, double C[CL_TENSOR][CL_TENSOR], double by_E[CL_TENSOR],
                  double by_S[CL_TENSOR]);

/* A trial state on its way to the yield surface. */
typedef struct {
  const Material        *mat;
  const Plasticity      *law; /* of mat, at the particle's depth (455) */
  const SkeletonStep    *d;
  double                 nonlocal;
  const SkeletonState   *trial;
  const Principal       *axes;   /* of the trial stress */
  const SkeletonTangent *slopes; /* of the trial state; null: none are wanted */
} Returning;

/* Where it lands: what that takes off the trial stress, the plastic strain of it; where they are wanted, slopes in the
   numbers of the step and, where it is raised, in the mean stress by which it is. */
typedef struct {
  SkeletonState   s;
  double          over[CL_TENSOR], e[CL_TENSOR];
  SkeletonTangent t;
  double          per[SKELETON_OUT];
} Landed;

/* Returns the trial state with `raise`, Pa, more of mean stress. */
bool ReturnRaised(const Returning *r, double raise, Landed *l, const char **why);
/* The same with as much of it as tears take up (427): the whole way of a trial state. */
bool ReturnTrial(const Returning *r, Landed *l, const char **why);

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
