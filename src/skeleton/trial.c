/* The trial state of every law: (14), or with bonds (93), from where the stage starts; and what a return does to it.
 */
#include "elastic.h"

/* Derivatives of (14). */
static void ElasticTangent(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonTangent *t)
{
  const double e[4] = {d->e[0] - d->thermal, d->e[1] - d->thermal, d->e[2] - d->thermal, d->e[3]};
  const double G = ElasticityShearFactor(el), lame = ElasticityLameFactor(el);
  double       r, over[6], rot[6], rot0[6], drot[6], drot0[6], unit[4];
  const bool   follows = Relaxation(el, d->E, d->E_n, &r);

  UnitStress(el, e, unit);
  for (int k = 0; k < 6; k++)
    over[k] = h->sig[k] - h->sig0[k];
  Turn6(over, d->c, d->s, rot);
  Turn6(h->sig0, d->c, d->s, rot0);
  Spin6(rot, drot);
  Spin6(rot0, drot0);
  *t = (SkeletonTangent){0};
  for (int k = 0; k < 6; k++) {
    double *row = t->d[k];

    row[SKELETON_THETA] = drot0[k] + r * drot[k];
    row[SKELETON_E]     = (k < 4 ? unit[k] : 0.0) + (follows ? rot[k] / d->E_n : 0.0);
    if (k < 4)
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
  double e[4], start[4], bond[4], unit[4], turned[6], spin[6], spin_e[6], unit_e[4], carried[6];

  Turn4(h->from.strain, d->c, d->s, start);
  Turn4(h->from.own + OWN_P_BOND, d->c, d->s, bond);
  for (int k = 0; k < 4; k++)
    e[k] = d->e[k] - (k < 3 ? d->thermal : 0.0) - start[k];
  UnitStress(el, e, unit);
  Turn6(h->sig, d->c, d->s, carried);
  Turn4(h->from.sig, d->c, d->s, carried);
  for (int k = 0; k < 4; k++)
    carried[k] -= (1.0 - d->kept) * bond[k];
  Spin6(carried, spin);
  for (int k = 0; k < 6; k++)
    turned[k] = k < 4 ? start[k] : 0.0;
  Spin6(turned, spin_e);
  UnitStress(el, spin_e, unit_e);
  *t = (SkeletonTangent){0};
  for (int k = 0; k < 6; k++) {
    double *row = t->d[k];

    row[SKELETON_THETA] = spin[k] - (k < 4 ? E * unit_e[k] : 0.0);
    if (k >= 4)
      continue;
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
static void TakeOff(const Elasticity *el, double E, const double start[4], SkeletonState *s, SkeletonTangent *t)
{
  const double start6[6] = {start[0], start[1], start[2], start[3], 0.0, 0.0};
  double       unit[4], spin[6], dunit[4];

  UnitStress(el, start, unit);
  Spin6(start6, spin);
  UnitStress(el, spin, dunit);
  for (int k = 0; k < 4; k++) {
    s->sig[k] -= E * unit[k];
    if (!t)
      continue;
    t->d[k][SKELETON_E] -= unit[k];
    t->d[k][SKELETON_THETA] -= E * dunit[k];
  }
}

void TrialState(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                SkeletonTangent *t)
{
  double start[4];

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
  Turn4(h->from.plastic, d->c, d->s, start);
  TakeOff(el, d->E, start, s, t);
}

void PlasticStrain(const Elasticity *el, double E, const double over[4], double e[4])
{
  const double tr = el->nu * (over[0] + over[1] + over[2]);

  for (int k = 0; k < 4; k++)
    e[k] = ((1.0 + el->nu) * over[k] - (k < 3 ? tr : 0.0)) / E;
}

void ReturnEnd(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, const double over[4],
               const double e[4], SkeletonState *s)
{
  const double share = BondShare(el, d);
  double       sum[4];

  Turn4(e, d->c, -d->s, sum);
  for (int k = 0; k < 4; k++) {
    s->plastic[k] = h->from.plastic[k] + sum[k];
    s->own[OWN_P_BOND + k] -= share * over[k];
  }
}
