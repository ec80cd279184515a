/* The laws of the skeleton by name, and the first of them, linear elasticity (14). */
#include "elastic.h"
#include "plastic.h"

/* Derivatives of (14). */
void ElasticTangent(const Elasticity *el, const SkeletonHistory *h, const SkeletonStep *d, SkeletonTangent *t)
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

static bool Update_Elastic(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                           SkeletonTangent *t, const char **why)
{
  (void)why;
  ElasticStress(&mat->elasticity, h, d, s);
  ElasticEnd(h, s);
  if (t)
    ElasticTangent(&mat->elasticity, h, d, t);
  return true;
}

static bool Block_Elastic(const Material *mat, const SkeletonBlock *b, const char **why)
{
  const Elasticity    el = mat->elasticity;
  const SkeletonBlock B  = *b;

  (void)why;
#pragma GCC ivdep
  for (int q = 0; q < B.n; q++) {
    const SkeletonStep d = {.c       = B.c[q],
                            .s       = B.s[q],
                            .e       = {B.xx[q], B.yy[q], 0.0, B.xy[q]},
                            .thermal = B.thermal[q],
                            .E_n     = B.E_n[q],
                            .E       = B.E[q],
                            .Sh      = B.Sh[q]};
    SkeletonHistory    h;
    SkeletonState      s;

    SkeletonTakeStress(&B.store, q, &h);
    ElasticStress(&el, &h, &d, &s);
    SkeletonKeepStress(&B.store, q, &s);
  }
  for (int q = 0; B.work && q < B.n; q++)
    B.work[q] = 0.0;
  return true;
}

/* By PLASTICITY_... */
static const SkeletonLaw laws[] = {{"none", Update_Elastic, Block_Elastic},
                                   {"mohr_coulomb", Update_MohrCoulomb, Block_MohrCoulomb}};

const SkeletonLaw *SkeletonLawOf(const Material *mat)
{
  return &laws[mat->plasticity.type];
}
