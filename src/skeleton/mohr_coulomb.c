/* Mohr-Coulomb behind the interface of the skeleton, one particle at a time. */
#include "plastic.h"

/* - F of (63), or what is left to the tension cut-off. */
double Margin_MohrCoulomb(const Material *mat, double Sh, const SkeletonHistory *h)
{
  const Plasticity law = StrengthAtDepth(&mat->plasticity, StrengthDepth(&mat->plasticity, h->place));
  Principal        p;
  Strength         k;
  double           dy[3], dphi;

  PrincipalOf(h->sig, &p);
  StrengthOf(&law, Sh, h->from.own[OWN_P_EPS], h->nonlocal, &k);
  return fmin(-MohrCoulombYield(k.phi, k.c, p.y, dy, &dphi), StrengthCutoff(&law) - p.y[0]);
}

bool Update_MohrCoulomb(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                        SkeletonTangent *t, const char **why)
{
  const Plasticity law = StrengthAtDepth(&mat->plasticity, StrengthDepth(&mat->plasticity, h->place));
  Principal        axes;
  const Returning  r = {
       .mat = mat, .law = &law, .d = d, .nonlocal = h->nonlocal, .trial = s, .axes = &axes, .slopes = t};
  Landed l;

  TrialState(&mat->elasticity, h, d, s, t);
  PrincipalOf(s->sig, &axes);
  const bool found = ReturnTrial(&r, &l, why);

  *s = l.s;
  if (!found || s->region == RETURN_ELASTIC)
    return found;
  if (t)
    *t = l.t;
  ReturnEnd(&mat->elasticity, h, d, l.over, l.e, s);
  return true;
}
