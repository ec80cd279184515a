/* skeleton: the stress of one particle's skeleton behind one interface: strain increment and history in; stress,
   history, tangent and dissipated work out.  Pure functions; every integrator calls the same ones, one particle at a
   time (with the tangent) or over blocks.  docs/equations.md (14) and section 14. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include "clathra/material.h"
#include "clathra/tensor.h"

/* What a step does to the skeleton; the tangent is taken with respect to these numbers in this order. */
enum {
  SKELETON_THETA = 0,                     /* rotation of the step, rad */
  SKELETON_STRAIN,                        /* logarithmic strain of the step (7): xx yy zz xy */
  SKELETON_THERMAL = SKELETON_STRAIN + 4, /* linear thermal strain beta_sh (T - T_n)/3 */
  SKELETON_E,                             /* Young's modulus now, Pa */
  SKELETON_SH,                            /* hydrate saturation now */
  SKELETON_IN
};
typedef struct {
  double c, s;    /* cosine and sine of the rotation */
  double e[4];    /* logarithmic strain xx yy zz xy (tensor component) */
  double thermal; /* beta_sh (T - T_n)/3 */
  double E_n, E;  /* Young's modulus at t_n and now, Pa */
  double Sh;      /* hydrate saturation now */
} SkeletonStep;

typedef struct {
  double sig[6], sig0[6]; /* effective stress at t_n and the initial one that turns with the body, Pa */
  double eps;             /* deviatoric plastic strain that the stage starts from */
  double plastic[4];      /* plastic strain since t_n that it starts from, xx yy zz xy, as the body lay at t_n (24) */
} SkeletonHistory;

/* Where on the yield surface a state was returned to. */
typedef enum {
  RETURN_ELASTIC = 0, /* it was not */
  RETURN_FACE,
  RETURN_EDGE,
  RETURN_APEX,
  RETURN_TENSION /* at the cut-off */
} ReturnRegion;

typedef struct {
  double       sig[6], sig0[6];
  double       eps, plastic[4]; /* as in the history, at the end of the stage */
  double       work;            /* dissipated in the stage, J per m^3 */
  ReturnRegion region;
} SkeletonState;

/* Rows of the tangent: the six stresses (Pa), then the dissipated work. */
enum { SKELETON_WORK = 6, SKELETON_OUT };
typedef struct {
  double d[SKELETON_OUT][SKELETON_IN];
} SkeletonTangent;

/* History that the laws hold besides the stress, all zero at the start: X(enum, fields, HDF5 name, components, unit,
   meaning), rows of the particles' table. */
#define CL_SKELETON_TABLE(X)                                                                                           \
  X(P_EPS, HAS_PLASTIC, "eps_d_p", 1, "-", "deviatoric plastic strain so far")                                         \
  X(P_YIELD, HAS_PLASTIC, "yield", 1, "-", "end of the last step: 0 elastic, 1 face, 2 edge, 3 apex, 4 tension")       \
  X(P_WP, HAS_PLASTIC, "plastic_work", 1, "J", "dissipated by the particle so far")                                    \
  X(P_HEAT, HAS_PLASTIC, "plastic_heat", 1, "J", "hybrid: of the last step, which the next one gives to the nodes")    \
  X(P_KP, HAS_PLASTIC, "rate_plastic", 5, "1/s", "of eps_d_p and stress xx yy zz xy (Pa/s), end of the last step")

/* Where the history of particles stands: arrays over particles, null where a law does not hold it. */
typedef struct {
  double *sig[6], *sig0[6], *eps, *yield;
} SkeletonStore;

/* n particles of one material; the history is replaced.  Strain and rotation as in SkeletonStep, e_zz = 0. */
typedef struct {
  int           n;
  const double *c, *s, *xx, *yy, *xy, *thermal, *E_n, *E, *Sh;
  double       *work; /* [n], J/m^3; may be null for a law that dissipates nothing */
  SkeletonStore store;
} SkeletonBlock;

/* A law: its functions return false with *why pointing to a sentence; a shorter step mends that. */
typedef struct {
  const char *name;
  bool (*update)(const Material *, const SkeletonHistory *, const SkeletonStep *, SkeletonState *, SkeletonTangent *,
                 const char **why);
  bool (*block)(const Material *, const SkeletonBlock *, const char **why);
} SkeletonLaw;
const SkeletonLaw *SkeletonLawOf(const Material *mat);

/* (89): elastic energy per volume over that of the initial stress, J/m^3, with Young's modulus E. */
static inline double SkeletonEnergy(const Elasticity *el, double E, const double sig[6], const double sig0[6])
{
  double both[6], over[6];

  for (int k = 0; k < 6; k++) {
    both[k] = sig[k] + sig0[k];
    over[k] = sig[k] - sig0[k];
  }
  const double product = both[XX] * over[XX] + both[YY] * over[YY] + both[ZZ] * over[ZZ] +
                         2.0 * (both[XY] * over[XY] + both[YZ] * over[YZ] + both[XZ] * over[XZ]);

  return ((1.0 + el->nu) * product - el->nu * Trace6(both) * Trace6(over)) / (2.0 * E);
}
/* Share r of the stress above the initial one that a change of stiffness from E_n to E leaves (14). */
static inline double SkeletonRelaxation(const Elasticity *el, double E_n, double E)
{
  return el->loss_only && E > E_n ? 1.0 : E / E_n;
}
/* Elastic energy per volume that is lost as the stiffness changes from E_n to E at held strain, J/m^3. */
static inline double SkeletonReleased(const Elasticity *el, double E_n, double E, const double sig[6],
                                      const double sig0[6])
{
  const double r = SkeletonRelaxation(el, E_n, E);
  double       left[6];

  for (int k = 0; k < 6; k++)
    left[k] = sig0[k] + r * (sig[k] - sig0[k]);
  return SkeletonEnergy(el, E_n, sig, sig0) - SkeletonEnergy(el, E, left, sig0);
}

/* t may be null. */
static inline bool SkeletonUpdate(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d,
                                  SkeletonState *s, SkeletonTangent *t, const char **why)
{
  return SkeletonLawOf(mat)->update(mat, h, d, s, t, why);
}
static inline bool SkeletonUpdateBlock(const Material *mat, const SkeletonBlock *b, const char **why)
{
  return SkeletonLawOf(mat)->block(mat, b, why);
}

/* Outside the block forms of the laws the only functions that read and write the history of particle q; the stress
   alone is what every law holds. */
static inline __attribute__((always_inline)) void SkeletonTakeStress(const SkeletonStore *f, ptrdiff_t q,
                                                                     SkeletonHistory *h)
{
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++) {
    h->sig[k]  = f->sig[k][q];
    h->sig0[k] = f->sig0[k][q];
  }
}
static inline __attribute__((always_inline)) void SkeletonKeepStress(const SkeletonStore *f, ptrdiff_t q,
                                                                     const SkeletonState *s)
{
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++) {
    f->sig[k][q]  = s->sig[k];
    f->sig0[k][q] = s->sig0[k];
  }
}
static inline void SkeletonTake(const SkeletonStore *f, ptrdiff_t q, SkeletonHistory *h)
{
  SkeletonTakeStress(f, q, h);
  h->eps = f->eps ? f->eps[q] : 0.0;
  for (int k = 0; k < 4; k++)
    h->plastic[k] = 0.0;
}
static inline void SkeletonKeep(const SkeletonStore *f, ptrdiff_t q, const SkeletonState *s)
{
  SkeletonKeepStress(f, q, s);
  if (f->eps) {
    f->eps[q]   = s->eps;
    f->yield[q] = (double)s->region;
  }
}
