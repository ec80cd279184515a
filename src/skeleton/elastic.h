/* Private to skeleton/: linear elasticity with E(S_h), the law itself and the trial state of every other one. */
#pragma once

#include "clathra/skeleton.h"

/* Share of the stress above the initial one that a change of E leaves, r of (14); true where it follows E. */
INLINE bool Relaxation(const Elasticity *el, double E, double E_n, double *r)
{
  const bool follows = !(el->change == STIFFNESS_LOSS_ONLY && E > E_n);

  *r = follows ? E / E_n : 1.0;
  return follows;
}

/* Stress per Young's modulus of a strain xx yy zz xy. */
INLINE void UnitStress(const Elasticity *el, const double e[CL_TENSOR], double s[CL_TENSOR])
{
  const double G2 = 2.0 * ElasticityShearFactor(el), tr = ElasticityLameFactor(el) * (e[0] + e[1] + e[2]);

#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++)
    s[k] = G2 * e[k] + (k <= ZZ ? tr : 0.0);
}

/* Strain of the step less the thermal one. */
INLINE void BareStrain(const SkeletonStep *d, double e[CL_TENSOR])
{
#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++)
    e[k] = d->e[k] - (k <= ZZ ? d->thermal : 0.0);
}

/* (14).  No branches and no loops that remain: compiles to vector code inside a loop over particles. */
INLINE void ElasticStress(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *o)
{
  double e[CL_TENSOR], unit[CL_TENSOR], over[6], rot[6], r;

  BareStrain(d, e);
  Relaxation(el, d->E, d->E_n, &r);
  UnitStress(el, e, unit);
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++)
    over[k] = h->sig[k] - h->sig0[k];
  Rotate6(over, d->turn, rot);
  Rotate6(h->sig0, d->turn, o->sig0);
#pragma GCC unroll 6
  for (int k = 0; k < 6; k++)
    o->sig[k] = o->sig0[k] + r * rot[k] + (k < CL_TENSOR ? d->E * unit[k < CL_TENSOR ? k : 0] : 0.0);
}

/* (93): hydrate's part in o->own.  Vector code, too. */
INLINE void BondedStress(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *o)
{
  const double *from = h->from.own + OWN_P_BOND, E_h = d->E - el->E0;
  double        e[CL_TENSOR], start[CL_TENSOR], bond[CL_TENSOR], bare[CL_TENSOR], unit[CL_TENSOR];

  BareStrain(d, e);
  Rotate(h->from.strain, d->turn, start);
  Rotate(from, d->turn, bond);
#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++) {
    e[k]    = e[k] - start[k];
    bare[k] = h->from.sig[k] - from[k];
  }
  UnitStress(el, e, unit);
  Rotate(bare, d->turn, start);
  Rotate6(h->sig, d->turn, o->sig);
  Rotate6(h->sig0, d->turn, o->sig0);
#pragma GCC unroll 6
  for (int k = 0; k < CL_TENSOR; k++) {
    o->own[OWN_P_BOND + k] = d->kept * (bond[k] + E_h * unit[k]);
    o->sig[k]              = start[k] + el->E0 * unit[k] + o->own[OWN_P_BOND + k];
  }
}

/* What else belongs to a state that stayed elastic. */
INLINE void ElasticEnd(const SkeletonHistory *h, SkeletonState *o)
{
  o->work   = 0.0;
  o->region = RETURN_ELASTIC;
  for (int k = 0; k < OWN_COUNT; k++)
    o->own[k] = h->from.own[k];
  for (int k = 0; k < CL_TENSOR; k++)
    o->plastic[k] = h->from.plastic[k];
}

/* Young's modulus by which a strain of the stage shows in the stress: E, or with bonds (93). */
INLINE double StageModulus(const Elasticity *el, const SkeletonStep *d)
{
  return ElasticityHasBonds(el) ? el->E0 + d->kept * (d->E - el->E0) : d->E;
}

/* Its slope in number q of SkeletonStep. */
static inline double StageModulusSlope(const Elasticity *el, const SkeletonStep *d, int q)
{
  if (!ElasticityHasBonds(el))
    return q == SKELETON_E ? 1.0 : 0.0;
  return q == SKELETON_E ? d->kept : q == SKELETON_KEPT ? d->E - el->E0 : 0.0;
}

/* Stress without plastic flow in the stage, the hydrate's part with bonds, and the tangent (may be null). */
void TrialState(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                SkeletonTangent *t);
/* Plastic strain xx yy zz xy that takes a stress off by `over`. */
void PlasticStrain(const Elasticity *el, double E, const double over[CL_TENSOR], double e[CL_TENSOR]);
/* Takes a return's `over` off the hydrate's part too (94); e: plastic strain of the stage, as the body lies now. */
void ReturnEnd(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, const double over[CL_TENSOR],
               const double e[CL_TENSOR], SkeletonState *s);
/* Share of a return's `over` that is the hydrate's (94); zero without bonds. */
INLINE double BondShare(const Elasticity *el, const SkeletonStep *d)
{
  return ElasticityHasBonds(el) ? d->kept * (d->E - el->E0) / StageModulus(el, d) : 0.0;
}

bool Update_Elastic(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                    SkeletonTangent *t, const char **why);
bool Block_Elastic(const Material *mat, const SkeletonBlock *b, const char **why);
