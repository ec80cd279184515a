/* skeleton: the stress of one particle's skeleton behind one interface: strain increment and history in; stress,
   history, tangent and dissipated work out.  Pure functions; every integrator calls the same ones, one particle at a
   time (with the tangent) or over blocks.  docs/equations.md (14) and section 14. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include "clathra/fields.h"
#include "clathra/material.h"
#include "clathra/tensor.h"

/* What a step does to the skeleton; the tangent is taken with respect to these numbers in this order. */
enum {
  SKELETON_THETA   = 0,                           /* rotation of the step, rad, about the axes of Spin6 */
  SKELETON_STRAIN  = SKELETON_THETA + CL_SPINS,   /* logarithmic strain of the step (7): xx yy zz xy (yz xz) */
  SKELETON_THERMAL = SKELETON_STRAIN + CL_TENSOR, /* linear thermal strain beta_sh (T - T_n)/3 */
  SKELETON_E,                                     /* Young's modulus now, Pa */
  SKELETON_SH,                                    /* hydrate saturation now */
  SKELETON_KEPT,                                  /* share of the stage's first hydrate that is still there */
  SKELETON_IN
};
typedef struct {
  Rotation turn;         /* of the step */
  double   e[CL_TENSOR]; /* logarithmic strain xx yy zz xy (tensor component) */
  double   thermal;      /* beta_sh (T - T_n)/3 */
  double   E_n, E;       /* Young's modulus at t_n and now, Pa */
  double   Sh;           /* hydrate saturation now */
  double   kept;         /* min(1, m_h/m_h*); only with bonds (93) */
} SkeletonStep;

/* History that the laws hold besides the stress: X(enum, what a material must have, HDF5 name, components, unit,
   meaning), rows of the particles' table.  Zero at the start unless the law has a `start`; CL_TENSOR components are a
   tensor xx yy zz xy (yz xz), which turns with the body. */
#define CL_SKELETON_HISTORY(X)                                                                                         \
  X(P_EPS, HAS_PLASTIC, "eps_d_p", 1, "-", "deviatoric plastic strain so far")                                         \
  X(P_OPENING, HAS_PLASTIC, "opening", 1, "-", "ln J by which tears stand open (427)")                                 \
  X(P_BOND, HAS_BONDS, "stress_hydrate", CL_TENSOR, "Pa", "what hydrate bears of the effective stress: xx yy zz xy")

/* All that a skeleton keeps: its history, and what is known of the last step. */
#define CL_SKELETON_TABLE(X)                                                                                           \
  CL_SKELETON_HISTORY(X)                                                                                               \
  X(P_YIELD, HAS_PLASTIC, "yield", 1, "-",                                                                             \
    "end of the last step: 0 elastic, 1 face, 2 edge, 3 apex, 4 tension, 5 closing")                                   \
  X(P_WP, HAS_PLASTIC, "plastic_work", 1, "J", "dissipated by the particle so far")                                    \
  X(P_HEAT, HAS_PLASTIC, "plastic_heat", 1, "J", "hybrid: of the last step, which the next one gives to the nodes")    \
  X(P_KP, HAS_PLASTIC, "rate_plastic", 1 + CL_TENSOR, "1/s",                                                           \
    "of eps_d_p and stress xx yy zz xy (Pa/s), end of the last step")                                                  \
  X(P_NONLOCAL, HAS_NONLOCAL, "eps_d_p_nonlocal", 1, "-", "sum of its averages over neighbours, what softens")         \
  X(P_NONLOCAL_RATE, HAS_NONLOCAL, "rate_nonlocal", 1, "1/s", "of eps_d_p_nonlocal, mean of the last step")            \
  X(P_AVERAGED, HAS_NONLOCAL, "eps_d_p_averaged", 1, "-", "eps_d_p at the last average")

/* OWN_P_EPS, ...: place of a history variable in the arrays below. */
#define CL_OWN_ENUM(id, has, name, nc, unit, doc) OWN_##id, OWN_##id##_LAST_ = OWN_##id + (nc)-1,
enum { CL_SKELETON_HISTORY(CL_OWN_ENUM) OWN_COUNT };
#undef CL_OWN_ENUM

#define CL_OWN_ONE(id, has, name, nc, unit, doc) +1
enum { SKELETON_HISTORY = 0 CL_SKELETON_HISTORY(CL_OWN_ONE) }; /* variables, not components */
#undef CL_OWN_ONE

/* What a stage starts from, or ends with: as the body lay at t_n, starred in a second stage (24). */
typedef struct {
  double own[OWN_COUNT];
  double plastic[CL_TENSOR]; /* plastic strain since t_n, xx yy zz xy */
  double strain[CL_TENSOR];  /* strain since t_n less the thermal one */
  double sig[CL_TENSOR];     /* effective stress xx yy zz xy, Pa */
  double work;               /* dissipated since t_n, J */
} SkeletonStage;

typedef struct {
  double        sig[6], sig0[6]; /* effective stress at t_n and the initial one that turns with the body, Pa */
  SkeletonStage from;
  double        nonlocal; /* plastic strain that sets the strength, end of the stage (86); only with nonlocal_length */
  double        place[CL_DIM]; /* at the start of the run, m: strength may grow with depth there (455) */
} SkeletonHistory;

/* Where on the yield surface a state was returned to. */
typedef enum {
  RETURN_ELASTIC = 0, /* it was not */
  RETURN_FACE,
  RETURN_EDGE,
  RETURN_APEX,
  RETURN_TENSION, /* at the cut-off */
  RETURN_CLOSING  /* a tear gave way, nothing else (427) */
} ReturnRegion;

typedef struct {
  double       sig[6], sig0[6];
  double       own[OWN_COUNT];     /* history at the end of the stage, as the body lies then */
  double       plastic[CL_TENSOR]; /* as in SkeletonStage */
  double       work;               /* dissipated in the stage, J per m^3 */
  ReturnRegion region;
} SkeletonState;

/* Rows of the tangent: the six stresses (Pa), then the dissipated work. */
enum { SKELETON_WORK = 6, SKELETON_OUT };
typedef struct {
  double d[SKELETON_OUT][SKELETON_IN];
} SkeletonTangent;

/* Where the history of particles stands: arrays over particles, null where a scene does not hold it. */
typedef struct {
  double *sig[6], *sig0[6], *own[OWN_COUNT], *yield, *nonlocal, *rate;
  double *place[CL_DIM]; /* at the start, m */
  double  ahead;         /* of the end of the stage, since the last average of neighbours, s */
} SkeletonStore;

/* n particles of one material; the history is replaced.  Numbers of the rotation, strain and the rest as in
   SkeletonStep; in the plane e_zz = 0. */
typedef struct {
  int           n;
  const double *turn[CL_TURN], *e[CL_TENSOR], *thermal, *E_n, *E, *Sh;
  const double *kept; /* [n]; may be null without bonds */
  double       *work; /* [n], J/m^3; may be null for a law that dissipates nothing */
  SkeletonStore store;
} SkeletonBlock;

/* A law: its functions return false with *why pointing to a sentence; a shorter step mends that.  The work of a block's
   particles without a stress is NaN then. */
typedef struct {
  const char *name;
  unsigned    has; /* HAS_...: whose rows of the tables it needs */
  bool (*update)(const Material *, const SkeletonHistory *, const SkeletonStep *, SkeletonState *, SkeletonTangent *,
                 const char **why);
  bool (*block)(const Material *, const SkeletonBlock *, const char **why);
  void (*start)(const Material *, double own[OWN_COUNT]); /* history of a new particle; null: zero */
  /* distance to yield, Pa: positive inside; null: it does not yield */
  double (*margin)(const Material *, double Sh, const SkeletonHistory *);
} SkeletonLaw;
/* The row of the table that a material takes. */
const SkeletonLaw *SkeletonLawOf(const Material *mat);

/* Rows of the tables that a material needs. */
static inline unsigned SkeletonHas(const Material *mat)
{
  const bool yields = mat->plasticity.type != PLASTICITY_NONE, nonlocal = yields && mat->plasticity.nonlocal > 0.0;

  return SkeletonLawOf(mat)->has | (ElasticityHasBonds(&mat->elasticity) ? HAS_BONDS : 0u) |
         (nonlocal ? HAS_NONLOCAL : 0u);
}

/* t may be null. */
static inline bool SkeletonUpdate(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d,
                                  SkeletonState *s, SkeletonTangent *t, const char **why)
{
  return SkeletonLawOf(mat)->update(mat, h, d, s, t, why);
}
/* The same over a block of particles, without tangents; writes their stress and history.  False: no state was found for
   one of them, with a sentence in *why; its work is NaN. */
static inline bool SkeletonUpdateBlock(const Material *mat, const SkeletonBlock *b, const char **why)
{
  return SkeletonLawOf(mat)->block(mat, b, why);
}

/* The end of a stage as the body lay at t_n; volume V, m^3. */
void SkeletonEndStage(const SkeletonHistory *h, const SkeletonStep *d, const SkeletonState *s, double V,
                      SkeletonStage *end);
/* Adds c (y_1 - y_n) to star; c dimensionless. */
static inline void SkeletonStar(const SkeletonStage *y_n, const SkeletonStage *y_1, double c, SkeletonStage *star)
{
  const double *n = (const double *)y_n, *one = (const double *)y_1;

  for (size_t k = 0; k < sizeof(*star) / sizeof(double); k++)
    ((double *)star)[k] += c * (one[k] - n[k]);
}

/* Outside the block forms of the laws the only functions that read and write the history of particle q; the stress
   alone is what every law holds. */
INLINE void SkeletonTakeStress(const SkeletonStore *f, ptrdiff_t q, SkeletonHistory *h)
{
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++) {
    h->sig[k]  = f->sig[k][q];
    h->sig0[k] = f->sig0[k][q];
  }
}
/* Writes it. */
INLINE void SkeletonKeepStress(const SkeletonStore *f, ptrdiff_t q, const SkeletonState *s)
{
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++) {
    f->sig[k][q]  = s->sig[k];
    f->sig0[k][q] = s->sig0[k];
  }
}
/* (86), dimensionless. */
static inline double SkeletonNonlocal(const SkeletonStore *f, ptrdiff_t q)
{
  return f->nonlocal ? f->nonlocal[q] + f->ahead * f->rate[q] : 0.0;
}
/* Place at the start, m. */
static inline void SkeletonPlace(const SkeletonStore *f, ptrdiff_t q, double place[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    place[d] = f->place[d] ? f->place[d][q] : 0.0;
}
/* Stress and history of particle q. */
static inline void SkeletonTake(const SkeletonStore *f, ptrdiff_t q, SkeletonHistory *h)
{
  SkeletonTakeStress(f, q, h);
  h->from = (SkeletonStage){0};
  for (int k = 0; k < CL_TENSOR; k++)
    h->from.sig[k] = h->sig[k];
  for (int k = 0; k < OWN_COUNT; k++)
    h->from.own[k] = f->own[k] ? f->own[k][q] : 0.0;
  h->nonlocal = SkeletonNonlocal(f, q);
  SkeletonPlace(f, q, h->place);
}
/* Writes them. */
static inline void SkeletonKeep(const SkeletonStore *f, ptrdiff_t q, const SkeletonState *s)
{
  SkeletonKeepStress(f, q, s);
  for (int k = 0; k < OWN_COUNT; k++) {
    if (f->own[k])
      f->own[k][q] = s->own[k];
  }
  if (f->yield)
    f->yield[q] = (double)s->region;
}

/* How far a state is from yield, in Pa, as the yield function measures it; NaN for a law that does not yield. */
static inline double SkeletonMargin(const Material *mat, double Sh, const SkeletonHistory *h)
{
  const SkeletonLaw *law = SkeletonLawOf(mat);

  return law->margin ? law->margin(mat, Sh, h) : NAN;
}

/* ---------------------------------------------------------------- energy (89) */
/* (both) : D^-1 : (over) / 2 of stresses, J/m^3. */
static inline double SkeletonComplement(double nu, double E, const double both[6], const double over[6])
{
  const double product = both[XX] * over[XX] + both[YY] * over[YY] + both[ZZ] * over[ZZ] +
                         2.0 * (both[XY] * over[XY] + both[YZ] * over[YZ] + both[XZ] * over[XZ]);

  return ((1.0 + nu) * product - nu * Trace6(both) * Trace6(over)) / (2.0 * E);
}
/* Elastic energy per volume over that of the initial stress, J/m^3, with Young's modulus E. */
static inline double SkeletonEnergy(const Elasticity *el, double E, const SkeletonHistory *h)
{
  const bool   bonds = ElasticityHasBonds(el);
  const double E_h = E - el->E0, *own = h->from.own + OWN_P_BOND;
  double       bond[6] = {0.0}, both[6], over[6];

  for (int k = 0; bonds && k < CL_TENSOR; k++)
    bond[k] = own[k];
  for (int k = 0; k < 6; k++) {
    both[k] = h->sig[k] - bond[k] + h->sig0[k];
    over[k] = h->sig[k] - bond[k] - h->sig0[k];
  }
  return SkeletonComplement(el->nu, bonds ? el->E0 : E, both, over) +
         (bonds && E_h > 0.0 ? SkeletonComplement(el->nu, E_h, bond, bond) : 0.0);
}
/* Elastic energy per volume lost at held strain as Young's modulus goes from E_n to E and the share `kept` of the
   hydrate stays, J/m^3. */
static inline double SkeletonReleased(const Elasticity *el, double E_n, double E, double kept, const SkeletonHistory *h)
{
  const double    r    = el->change == STIFFNESS_LOSS_ONLY && E > E_n ? 1.0 : E / E_n;
  SkeletonHistory left = *h;

  if (ElasticityHasBonds(el)) {
    for (int k = 0; k < CL_TENSOR; k++) {
      left.from.own[OWN_P_BOND + k] *= kept;
      left.sig[k] -= (1.0 - kept) * h->from.own[OWN_P_BOND + k];
    }
  } else {
    for (int k = 0; k < 6; k++)
      left.sig[k] = h->sig0[k] + r * (h->sig[k] - h->sig0[k]);
  }
  return SkeletonEnergy(el, E_n, h) - SkeletonEnergy(el, E, &left);
}
