/* Private to skeleton/: linear elasticity with E(S_h), the law itself and the trial state of every other one. */
#pragma once

#include "clathra/skeleton.h"

#define INLINE static inline __attribute__((always_inline))

/* Share of the stress above the initial one that a change of E leaves, r of (14); true where it follows E. */
INLINE bool Relaxation(const Elasticity *el, double E, double E_n, double *r)
{
  *r = SkeletonRelaxation(el, E_n, E);
  return !(el->loss_only && E > E_n);
}

/* Stress per Young's modulus of a strain xx yy zz xy. */
INLINE void UnitStress(const Elasticity *el, const double e[4], double s[4])
{
  const double G2 = 2.0 * ElasticityShearFactor(el), tr = ElasticityLameFactor(el) * (e[0] + e[1] + e[2]);

  s[0] = G2 * e[0] + tr;
  s[1] = G2 * e[1] + tr;
  s[2] = G2 * e[2] + tr;
  s[3] = G2 * e[3];
}

/* (14).  No branches and no loops that remain: compiles to vector code inside a loop over particles. */
INLINE void ElasticStress(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *o)
{
  const double e[4] = {d->e[0] - d->thermal, d->e[1] - d->thermal, d->e[2] - d->thermal, d->e[3]};
  double       unit[4], over[6], rot[6], r;

  Relaxation(el, d->E, d->E_n, &r);
  UnitStress(el, e, unit);
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++)
    over[k] = h->sig[k] - h->sig0[k];
  Turn6(over, d->c, d->s, rot);
  Turn6(h->sig0, d->c, d->s, o->sig0);
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++)
    o->sig[k] = o->sig0[k] + r * rot[k] + (k < 4 ? d->E * unit[k < 4 ? k : 0] : 0.0);
}

/* What else belongs to a state that stayed elastic. */
INLINE void ElasticEnd(const SkeletonHistory *h, SkeletonState *o)
{
  o->eps    = h->eps;
  o->work   = 0.0;
  o->region = RETURN_ELASTIC;
  for (int k = 0; k < 4; k++)
    o->plastic[k] = h->plastic[k];
}

bool Block_Elastic(const Material *mat, const SkeletonBlock *b, const char **why);
void ElasticTangent(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonTangent *t);
