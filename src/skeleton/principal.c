/* The return of a trial state in principal stresses, and its tangent; docs/equations.md, section 14. */
#include "smooth.h"

static Trial3 TrialOf(const Returning *r, double eps, const Principal *p)
{
  const Elasticity *el = &r->mat->elasticity;

  return (Trial3){.law      = r->law,
                  .G2       = 2.0 * ElasticityShearFactor(el),
                  .lame     = ElasticityLameFactor(el),
                  .E        = StageModulus(el, r->d),
                  .Sh       = r->d->Sh,
                  .eps      = eps,
                  .nonlocal = r->nonlocal,
                  .y        = {p->y[0], p->y[1], p->y[2]}};
}

static bool Yields(const Plasticity *law, double Sh, double eps, double nonlocal, const double y[3])
{
  Strength k;
  double   dy[3], dphi;

  StrengthOf(law, Sh, eps, nonlocal, &k);
  const double round_off = YIELD_ROUND_OFF * k.c + 1e-2 * YIELD_ROUND_OFF * (fabs(y[0]) + fabs(y[2]));
  return MohrCoulombYield(k.phi, k.c, y, dy, &dphi) > round_off || y[0] > StrengthCutoff(law) + round_off;
}

static bool ReturnToYield(const Trial3 *t, bool slopes, Returned *r)
{
  return t->law->flow == FLOW_MOHR_COULOMB ? ReturnPlanes(t, slopes, r) : ReturnSmooth(t, slopes, r);
}

/* sigma : e, with the shear on both sides of the diagonal. */
static double Double(const double a[CL_TENSOR], const double b[CL_TENSOR])
{
  double sum = 0.0;

  for (int k = 0; k < CL_TENSOR; k++)
    sum += (k <= ZZ ? 1.0 : 2.0) * a[k] * b[k];
  return sum;
}

/* Tangent of the trial state turned into that of the returned one; the work is sigma : D^-1 (trial - sigma), with
   StageModulus in D. */
static void PlasticTangent(const Elasticity *el, const SkeletonStep *d, const Principal *p, const Returned *r,
                           const double sig[6], const double e[CL_TENSOR], SkeletonTangent *t)
{
  const double E = StageModulus(el, d);
  double       C[CL_TENSOR][CL_TENSOR], by_E[CL_TENSOR], by_S[CL_TENSOR], trial[CL_TENSOR][SKELETON_IN];

  StressSlopes(p, r, C, by_E, by_S);
  for (int a = 0; a < CL_TENSOR; a++) {
    for (int q = 0; q < SKELETON_IN; q++)
      trial[a][q] = t->d[a][q];
  }
  for (int q = 0; q < SKELETON_IN; q++) {
    const double dE = StageModulusSlope(el, d, q);
    double       over[CL_TENSOR], de[CL_TENSOR], ds[CL_TENSOR];

    for (int a = 0; a < CL_TENSOR; a++) {
      ds[a] = by_E[a] * dE + (q == SKELETON_SH ? by_S[a] : 0.0);
      for (int b = 0; b < CL_TENSOR; b++)
        ds[a] += C[a][b] * trial[b][q];
      t->d[a][q] = ds[a];
      over[a]    = trial[a][q] - ds[a];
    }
    PlasticStrain(el, E, over, de);
    t->d[SKELETON_WORK][q] = Double(ds, e) + Double(sig, de) - Double(sig, e) * dE / E;
  }
}

void TakeReturned(const Material *mat, double E, const Principal *p, const Returned *r, SkeletonState *s,
                  double over[CL_TENSOR], double e[CL_TENSOR])
{
  for (int k = 0; k < CL_TENSOR; k++)
    over[k] = s->sig[k];
  FromPrincipal(p, r->y, s->sig);
  for (int k = 0; k < CL_TENSOR; k++)
    over[k] -= s->sig[k];
  PlasticStrain(&mat->elasticity, E, over, e);
  s->own[OWN_P_EPS] = r->eps;
  s->region         = r->region;
  s->work           = Double(s->sig, e);
}

/* Slopes of a state that was not returned, as of one that was. */
static void UnitPer(double per[SKELETON_OUT])
{
  for (int k = 0; k < SKELETON_OUT; k++)
    per[k] = k <= ZZ ? 1.0 : 0.0;
}

bool ReturnRaised(const Returning *r, double raise, Landed *l, const char **why)
{
  const Material *mat = r->mat;
  Returned        found;
  Principal       p = *r->axes;

  l->s = *r->trial;
  for (int k = XX; k <= ZZ; k++) {
    l->s.sig[k] += raise;
    p.y[k] += raise;
  }
  for (int k = 0; k < CL_TENSOR; k++)
    l->over[k] = l->e[k] = 0.0;
  if (r->slopes) {
    l->t = *r->slopes;
    UnitPer(l->per);
  }
  if (!Yields(r->law, r->d->Sh, l->s.own[OWN_P_EPS], r->nonlocal, p.y))
    return true;
  const Trial3 at = TrialOf(r, l->s.own[OWN_P_EPS], &p);
  if (!ReturnToYield(&at, r->slopes != NULL, &found)) {
    *why = "no stress on the yield surface was found for the strain of this step";
    return false;
  }
  TakeReturned(mat, at.E, &p, &found, &l->s, l->over, l->e);
  if (!r->slopes)
    return true;
  PlasticTangent(&mat->elasticity, r->d, &p, &found, l->s.sig, l->e, &l->t);
  if (raise == 0.0)
    return true;
  SkeletonTangent raised = {0}; /* its first column: a trial state that is raised by 1 Pa */
  for (int k = XX; k <= ZZ; k++)
    raised.d[k][0] = 1.0;
  PlasticTangent(&mat->elasticity, r->d, &p, &found, l->s.sig, l->e, &raised);
  for (int k = 0; k < SKELETON_OUT; k++)
    l->per[k] = raised.d[k][0];
  return true;
}
