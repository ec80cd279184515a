/* The trial state of every law: (14), or with bonds (93), from where the stage starts; and what a return does to it.
 */
#include "elastic.h"

/* Derivatives of (14). */
static void ElasticTangent(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonTangent *t)
{
  const double G = ElasticityShearFactor(el), lame = ElasticityLameFactor(el);
  double       r, over[6], rot[6], rot0[6], drot[6], drot0[6], e[CL_TENSOR], unit[CL_TENSOR];
  const bool   follows = Relaxation(el, d->E, d->E_n, &r);

  BareStrain(d, e);
  UnitStress(el, e, unit);
  for (int k = 0; k < 6; k++)
    over[k] = h->sig[k] - h->sig0[k];
  Rotate6(over, d->turn, rot);
  Rotate6(h->sig0, d->turn, rot0);
  *t = (SkeletonTangent){0};
  for (int i = 0; i < CL_SPINS; i++) {
    Spin6(rot, i, drot);
    Spin6(rot0, i, drot0);
    for (int k = 0; k < 6; k++)
      t->d[k][SKELETON_THETA + i] = drot0[k] + r * drot[k];
  }
  for (int k = 0; k < 6; k++) {
    double *row = t->d[k];

    row[SKELETON_E] = (k < CL_TENSOR ? unit[k] : 0.0) + (follows ? rot[k] / d->E_n : 0.0);
    if (k < CL_TENSOR)
      row[SKELETON_STRAIN + k] = d->E * 2.0 * G;
    for (int j = 0; k < 3 && j < 3; j++)
      row[SKELETON_STRAIN + j] += d->E * lame;
    if (k < 3)
      row[SKELETON_THERMAL] = -d->E * (2.0 * G + 3.0 * lame);
  }
}

/* Derivatives of (93). */
static void BondedTangent(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonTangent *t)
{
  const double G = ElasticityShearFactor(el), lame = ElasticityLameFactor(el), E = StageModulus(el, d),
               E_h = d->E - el->E0;
  double e[CL_TENSOR], start[CL_TENSOR], bond[CL_TENSOR], unit[CL_TENSOR], unit_e[CL_TENSOR];
  double turned[6] = {0.0}, spin[6], spin_e[6], carried[6];

  BareStrain(d, e);
  Rotate(h->from.strain, d->turn, start);
  Rotate(h->from.own + OWN_P_BOND, d->turn, bond);
  for (int k = 0; k < CL_TENSOR; k++) {
    e[k] -= start[k];
    turned[k] = start[k];
  }
  UnitStress(el, e, unit);
  Rotate6(h->sig, d->turn, carried);
  Rotate(h->from.sig, d->turn, carried);
  for (int k = 0; k < CL_TENSOR; k++)
    carried[k] -= (1.0 - d->kept) * bond[k];
  *t = (SkeletonTangent){0};
  for (int i = 0; i < CL_SPINS; i++) {
    Spin6(carried, i, spin);
    Spin6(turned, i, spin_e);
    UnitStress(el, spin_e, unit_e);
    for (int k = 0; k < 6; k++)
      t->d[k][SKELETON_THETA + i] = spin[k] - (k < CL_TENSOR ? E * unit_e[k < CL_TENSOR ? k : 0] : 0.0);
  }
  for (int k = 0; k < CL_TENSOR; k++) {
    double *row = t->d[k];

    row[SKELETON_E]          = d->kept * unit[k];
    row[SKELETON_KEPT]       = bond[k] + E_h * unit[k];
    row[SKELETON_STRAIN + k] = E * 2.0 * G;
    for (int j = 0; k < 3 && j < 3; j++)
      row[SKELETON_STRAIN + j] += E * lame;
    if (k < 3)
      row[SKELETON_THERMAL] = -E * (2.0 * G + 3.0 * lame);
  }
}

/* (68): takes the plastic strain `start` (as the body lies now) that the stage starts from off the trial stress. */
static void TakeOff(const Elasticity *el, double E, const double start[CL_TENSOR], SkeletonState *s, SkeletonTangent *t)
{
  double unit[CL_TENSOR], start6[6] = {0.0}, spin[6], dunit[CL_TENSOR];

  UnitStress(el, start, unit);
  for (int k = 0; k < CL_TENSOR; k++) {
    start6[k] = start[k];
    s->sig[k] -= E * unit[k];
    if (t)
      t->d[k][SKELETON_E] -= unit[k];
  }
  for (int i = 0; t && i < CL_SPINS; i++) {
    Spin6(start6, i, spin);
    UnitStress(el, spin, dunit);
    for (int k = 0; k < CL_TENSOR; k++)
      t->d[k][SKELETON_THETA + i] -= E * dunit[k];
  }
}

void TrialState(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                SkeletonTangent *t)
{
  double start[CL_TENSOR];

  ElasticEnd(h, s);
  if (ElasticityHasBonds(el)) {
    BondedStress(el, h, d, s);
    if (t)
      BondedTangent(el, h, d, t);
    return;
  }
  ElasticStress(el, h, d, s);
  if (t)
    ElasticTangent(el, h, d, t);
  Rotate(h->from.plastic, d->turn, start);
  TakeOff(el, d->E, start, s, t);
}

void PlasticStrain(const Elasticity *el, double E, const double over[CL_TENSOR], double e[CL_TENSOR])
{
  const double tr = el->nu * (over[0] + over[1] + over[2]);

  for (int k = 0; k < CL_TENSOR; k++)
    e[k] = ((1.0 + el->nu) * over[k] - (k <= ZZ ? tr : 0.0)) / E;
}

void ReturnEnd(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, const double over[CL_TENSOR],
               const double e[CL_TENSOR], SkeletonState *s)
{
  const double share = BondShare(el, d);
  double       sum[CL_TENSOR];

  Rotate(e, RotationBack(d->turn), sum);
  for (int k = 0; k < CL_TENSOR; k++) {
    s->plastic[k] = h->from.plastic[k] + sum[k];
    s->own[OWN_P_BOND + k] -= share * over[k];
  }
}
