/* A trial state in principal stresses, its return, and back with the tangent; docs/equations.md, section 14. */
#include "smooth.h"

#define NEAR_EQUAL 1e-8 /* principal stresses closer than this share of their size: limit of the spin part */

void PrincipalOf(const double sig[6], Principal *p)
{
  const double d = 0.5 * (sig[XX] - sig[YY]), o = sig[XY], r = sqrt(d * d + o * o), m = 0.5 * (sig[XX] + sig[YY]);
  const double z = sig[ZZ], v[3] = {m + r, m - r, z};

  p->mean     = m;
  p->radius   = r;
  p->c2       = r > 0.0 ? d / r : 1.0;
  p->s2       = r > 0.0 ? o / r : 0.0;
  p->order[0] = z > v[0] ? 2 : 0;
  p->order[1] = z > v[0] ? 0 : z >= v[1] ? 2 : 1;
  p->order[2] = z >= v[1] ? 1 : 2;
  for (int i = 0; i < 3; i++)
    p->y[i] = v[p->order[i]];
}

/* Stress from principal values v (in-plane upper, lower, out of plane) in the trial directions. */
static void FromPrincipal(const Principal *p, const double v[3], double sig[6])
{
  const double m = 0.5 * (v[0] + v[1]), r = 0.5 * (v[0] - v[1]);

  sig[XX] = m + r * p->c2;
  sig[YY] = m - r * p->c2;
  sig[ZZ] = v[2];
  sig[XY] = r * p->s2;
}

static void Unsort(const Principal *p, const double y[3], double v[3])
{
  for (int i = 0; i < 3; i++)
    v[p->order[i]] = y[i];
}

/* d(stress)/d(trial stress) of xx yy zz xy from the slopes of principal values, and the columns of E and S_h. */
static void StressSlopes(const Principal *p, const Returned *r, double C[4][4], double by_E[4], double by_S[4])
{
  double v[3], D[3][3], e[3], h[3];

  Unsort(p, r->y, v);
  for (int i = 0; i < 3; i++) {
    e[p->order[i]] = r->dy[i][BY_E];
    h[p->order[i]] = r->dy[i][BY_SH];
    for (int j = 0; j < 3; j++)
      D[p->order[i]][p->order[j]] = r->dy[i][j];
  }
  const double size = fabs(p->mean) + p->radius;
  const double spin =
      p->radius > NEAR_EQUAL * size ? 0.5 * (v[0] - v[1]) / p->radius : 0.5 * (D[0][0] - D[0][1] - D[1][0] + D[1][1]);
  const double dir[3][4] = {{0.5 * (1.0 + p->c2), 0.5 * (1.0 - p->c2), 0.0, p->s2},
                            {0.5 * (1.0 - p->c2), 0.5 * (1.0 + p->c2), 0.0, -p->s2},
                            {0.0, 0.0, 1.0, 0.0}}; /* dv/d(xx yy zz xy) */
  const double out[3][4] = {{dir[0][0], dir[0][1], 0.0, 0.5 * p->s2},
                            {dir[1][0], dir[1][1], 0.0, -0.5 * p->s2},
                            {0.0, 0.0, 1.0, 0.0}};      /* d(xx yy zz xy)/dv */
  const double turn[4]   = {-p->s2, p->s2, 0.0, p->c2}; /* d(c2, s2) as the circle turns: (xx - yy)/2 and xy */

  for (int a = 0; a < 4; a++) {
    by_E[a] = by_S[a] = 0.0;
    for (int i = 0; i < 3; i++) {
      by_E[a] += out[i][a] * e[i];
      by_S[a] += out[i][a] * h[i];
    }
    for (int b = 0; b < 4; b++) {
      C[a][b] = spin * turn[a] * (b == 3 ? turn[b] : 0.5 * turn[b]);
      for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++)
          C[a][b] += out[i][a] * D[i][j] * dir[j][b];
      }
    }
  }
}

static Trial3 TrialOf(const Material *mat, const SkeletonStep *d, double eps, double nonlocal, const Principal *p)
{
  const Elasticity *el = &mat->elasticity;

  return (Trial3){.law      = &mat->plasticity,
                  .G2       = 2.0 * ElasticityShearFactor(el),
                  .lame     = ElasticityLameFactor(el),
                  .E        = StageModulus(el, d),
                  .Sh       = d->Sh,
                  .eps      = eps,
                  .nonlocal = nonlocal,
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
static double Double(const double a[4], const double b[4])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + 2.0 * a[3] * b[3];
}

/* Tangent of the trial state turned into that of the returned one; the work is sigma : D^-1 (trial - sigma), with
   StageModulus in D. */
static void PlasticTangent(const Elasticity *el, const SkeletonStep *d, const Principal *p, const Returned *r,
                           const double sig[4], const double e[4], SkeletonTangent *t)
{
  const double E = StageModulus(el, d);
  double       C[4][4], by_E[4], by_S[4], trial[4][SKELETON_IN];

  StressSlopes(p, r, C, by_E, by_S);
  for (int a = 0; a < 4; a++) {
    for (int q = 0; q < SKELETON_IN; q++)
      trial[a][q] = t->d[a][q];
  }
  for (int q = 0; q < SKELETON_IN; q++) {
    const double dE = StageModulusSlope(el, d, q);
    double       over[4], de[4], ds[4];

    for (int a = 0; a < 4; a++) {
      ds[a] = by_E[a] * dE + (q == SKELETON_SH ? by_S[a] : 0.0);
      for (int b = 0; b < 4; b++)
        ds[a] += C[a][b] * trial[b][q];
      t->d[a][q] = ds[a];
      over[a]    = trial[a][q] - ds[a];
    }
    PlasticStrain(el, E, over, de);
    t->d[SKELETON_WORK][q] = Double(ds, e) + Double(sig, de) - Double(sig, e) * dE / E;
  }
}

void TakeReturned(const Material *mat, double E, const Principal *p, const Returned *r, SkeletonState *s,
                  double over[4], double e[4])
{
  double v[3];

  for (int k = 0; k < 4; k++)
    over[k] = s->sig[k];
  Unsort(p, r->y, v);
  FromPrincipal(p, v, s->sig);
  for (int k = 0; k < 4; k++)
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
  Principal       p;

  l->s = *r->trial;
  for (int k = XX; k <= ZZ; k++)
    l->s.sig[k] += raise;
  for (int k = 0; k < 4; k++)
    l->over[k] = l->e[k] = 0.0;
  if (r->slopes) {
    l->t = *r->slopes;
    UnitPer(l->per);
  }
  PrincipalOf(l->s.sig, &p);
  if (!Yields(&mat->plasticity, r->d->Sh, l->s.own[OWN_P_EPS], r->nonlocal, p.y))
    return true;
  const Trial3 at = TrialOf(mat, r->d, l->s.own[OWN_P_EPS], r->nonlocal, &p);
  if (!ReturnToYield(&at, r->slopes != NULL, &found)) {
    *why = "no stress on the yield surface was found for the strain of this step";
    return false;
  }
  TakeReturned(mat, at.E, &p, &found, &l->s, l->over, l->e);
  if (!r->slopes)
    return true;
  PlasticTangent(&mat->elasticity, r->d, &p, &found, l->s.sig, l->e, &l->t);
  if (mat->plasticity.tears != TEARS_CLOSE)
    return true;
  SkeletonTangent raised = {0}; /* its first column: a trial state that is raised by 1 Pa */
  for (int k = XX; k <= ZZ; k++)
    raised.d[k][0] = 1.0;
  PlasticTangent(&mat->elasticity, r->d, &p, &found, l->s.sig, l->e, &raised);
  for (int k = 0; k < SKELETON_OUT; k++)
    l->per[k] = raised.d[k][0];
  return true;
}
