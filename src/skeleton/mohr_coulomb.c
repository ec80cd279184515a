/* Mohr-Coulomb behind the interface of the skeleton: elastic trial, principal stresses in the plane, return, and back
   with the tangent; docs/equations.md, section 14. */
#include "smooth.h"

#define CHUNK 32        /* particles tested at once */
#define NEAR_EQUAL 1e-8 /* principal stresses closer than this share of their size: limit of the spin part */

/* In-plane principal stresses and direction of a stress xx yy zz xy; order[i]: 0, 1 in the plane, 2 out of it. */
typedef struct {
  double mean, radius, c2, s2; /* of Mohr's circle: xx - yy = 2 radius c2, xy = radius s2 */
  int    order[3];             /* which principal stress is the largest, middle, smallest */
  double y[3];                 /* falling */
} Principal;

static void PrincipalOf(const double sig[6], Principal *p)
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

/* - F of (63), or what is left to the tension cut-off. */
double Margin_MohrCoulomb(const Material *mat, double Sh, const SkeletonHistory *h)
{
  const Plasticity *law = &mat->plasticity;
  Principal         p;
  Strength          k;
  double            dy[3], dphi;

  PrincipalOf(h->sig, &p);
  StrengthOf(law, Sh, h->from.own[OWN_P_EPS], h->nonlocal, &k);
  return fmin(-MohrCoulombYield(k.phi, k.c, p.y, dy, &dphi), StrengthCutoff(law) - p.y[0]);
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

/* Takes the returned state r into s; what that takes off the trial stress in `over`, with the plastic strain e. */
static void TakeReturned(const Material *mat, double E, const Principal *p, const Returned *r, SkeletonState *s,
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

/* From the trial stress in s, with principal stresses p, to the yield surface; over, e as above. */
static bool Return(const Material *mat, const SkeletonStep *d, double nonlocal, const Principal *p, SkeletonState *s,
                   SkeletonTangent *t, double over[4], double e[4], const char **why)
{
  Returned r;

  if (!Yields(&mat->plasticity, d->Sh, s->own[OWN_P_EPS], nonlocal, p->y))
    return true;
  const Trial3 at = TrialOf(mat, d, s->own[OWN_P_EPS], nonlocal, p);
  if (!ReturnToYield(&at, t != NULL, &r)) {
    *why = "no stress on the yield surface was found for the strain of this step";
    return false;
  }
  TakeReturned(mat, at.E, p, &r, s, over, e);
  if (t)
    PlasticTangent(&mat->elasticity, d, p, &r, s->sig, e, t);
  return true;
}

bool Update_MohrCoulomb(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                        SkeletonTangent *t, const char **why)
{
  double    over[4], e[4];
  Principal p;

  TrialState(&mat->elasticity, h, d, s, t);
  PrincipalOf(s->sig, &p);
  if (!Return(mat, d, h->nonlocal, &p, s, t, over, e, why))
    return false;
  if (s->region != RETURN_ELASTIC)
    ReturnEnd(&mat->elasticity, h, d, over, e, s);
  return true;
}

/* Which of n trial states from q on may yield, without exponentials or angles of their own: where nothing has flowed
   yet (nor around it), friction is that of the peak and the cohesion c_min or more; where all normal stresses are
   compressive, no strength is below the residual one.  All of them reduced (87).  Vector code. */
static void MayYield(const Plasticity *law, const SkeletonStore *f, int q, int n, unsigned char may[CHUNK])
{
  const double part = StrengthReduced(law, 1.0), peak = atan(part * tan(law->phi_peak * M_PI / 180.0)),
               res = atan(part * tan(law->phi_res * M_PI / 180.0)), sp = sin(peak), sr = sin(res),
               cp = part * law->c_min * cos(peak), cr = part * law->c_res * cos(res), cutoff = StrengthCutoff(law);
  const int     own = law->nonlocal == 0.0; /* strength follows the particle's own strain */
  const double *xx = f->sig[XX] + q, *yy = f->sig[YY] + q, *zz = f->sig[ZZ] + q, *xy = f->sig[XY] + q,
               *eps = f->own[OWN_P_EPS] + q;

  for (int k = 0; k < n; k++) {
    const double d = 0.5 * (xx[k] - yy[k]), m = 0.5 * (xx[k] + yy[k]), r = sqrt(d * d + xy[k] * xy[k]);
    const double hi = m + r > zz[k] ? m + r : zz[k], lo = m - r < zz[k] ? m - r : zz[k];
    const double shear = 0.5 * (hi - lo), mean = 0.5 * (hi + lo);
    const int fresh = own & (eps[k] == 0.0) & (shear + mean * sp <= cp), worn = (hi <= 0.0) & (shear + mean * sr <= cr);

    may[k] = (unsigned char)!((hi <= cutoff) & (fresh | worn));
  }
}

/* A particle of a block at its trial stress. */
typedef struct {
  int           q;
  SkeletonStep  d;
  SkeletonState s;
  Principal     p;
} Yielding;

static void TakeYielding(const SkeletonBlock *b, int q, Yielding *y)
{
  const SkeletonStore *f = &b->store;

  y->q = q;
  y->d = (SkeletonStep){.E = b->E[q], .Sh = b->Sh[q], .kept = b->kept ? b->kept[q] : 1.0};
  y->s = (SkeletonState){.sig            = {f->sig[XX][q], f->sig[YY][q], f->sig[ZZ][q], f->sig[XY][q]},
                         .own[OWN_P_EPS] = f->own[OWN_P_EPS][q]};
  PrincipalOf(y->s.sig, &y->p);
}

/* What the block keeps of a particle that yields. */
static void KeepYielding(const Material *mat, const SkeletonBlock *b, const Yielding *y, const double over[4])
{
  const SkeletonStore *f     = &b->store;
  const double         share = BondShare(&mat->elasticity, &y->d);

  b->work[y->q]  = y->s.work;
  f->yield[y->q] = (double)y->s.region;
  if (y->s.region == RETURN_ELASTIC)
    return;
  f->own[OWN_P_EPS][y->q] = y->s.own[OWN_P_EPS];
  for (int k = 0; k < 4; k++) {
    f->sig[k][y->q] = y->s.sig[k];
    if (share != 0.0)
      f->own[OWN_P_BOND + k][y->q] -= share * over[k];
  }
}

static bool ReturnOne(const Material *mat, const SkeletonBlock *b, Yielding *y, const char **why)
{
  double     over[4], e[4];
  const bool found = Return(mat, &y->d, SkeletonNonlocal(&b->store, y->q), &y->p, &y->s, NULL, over, e, why);

  KeepYielding(mat, b, y, over);
  if (!found)
    b->work[y->q] = NAN;
  return found;
}

/* The smooth return of up to SMOOTH_LANES particles at once; the hard ones one by one. */
static bool ReturnLanes(const Material *mat, const SkeletonBlock *b, const int *list, int n, const char **why)
{
  const Elasticity *el    = &mat->elasticity;
  bool              found = true;
  Yielding          y[SMOOTH_LANES];
  SmoothLanes       l;

  for (int i = 0; i < n; i++)
    TakeYielding(b, list[i], &y[i]);
  for (int i = 0; i < SMOOTH_LANES; i++) {
    const Yielding *from = &y[i < n ? i : 0];

    for (int k = 0; k < 3; k++)
      l.y[k][i] = from->p.y[k];
    l.E[i]        = StageModulus(el, &from->d);
    l.Sh[i]       = from->d.Sh;
    l.eps[i]      = from->s.own[OWN_P_EPS];
    l.nonlocal[i] = SkeletonNonlocal(&b->store, from->q);
  }
  ReturnSmoothLanes(&mat->plasticity, 2.0 * ElasticityShearFactor(el), ElasticityLameFactor(el), &l);
  for (int i = 0; i < n; i++) {
    const Returned r = {.y = {l.y[0][i], l.y[1][i], l.y[2][i]}, .eps = l.eps[i], .region = RETURN_FACE};
    double         over[4], e[4];

    if (l.elastic[i])
      continue;
    if (!l.found[i]) {
      found = ReturnOne(mat, b, &y[i], why) && found;
      continue;
    }
    TakeReturned(mat, StageModulus(el, &y[i].d), &y[i].p, &r, &y[i].s, over, e);
    KeepYielding(mat, b, &y[i], over);
  }
  return found;
}

/* Trial stresses of all first, then the returns of those that yield, both in vector code. */
bool Block_MohrCoulomb(const Material *mat, const SkeletonBlock *b, const char **why)
{
  const Plasticity *law   = &mat->plasticity;
  const bool        lanes = law->flow == FLOW_MENETREY_WILLAM && (law->factor == 0.0 || law->factor == 1.0);
  bool              found = Block_Elastic(mat, b, why);
  unsigned char     may[CHUNK];

  for (int q = 0; q < b->n; q++)
    b->store.yield[q] = (double)RETURN_ELASTIC; /* their work is zero already */
  for (int q = 0; q < b->n; q += CHUNK) {
    const int n = b->n - q < CHUNK ? b->n - q : CHUNK;
    int       list[CHUNK], many = 0;

    MayYield(law, &b->store, q, n, may);
    for (int k = 0; k < n; k++) {
      list[many] = q + k;
      many += may[k];
    }
    for (int k = 0, group; k < many; k += group) {
      group = !lanes || many - k == 1 ? 1 : many - k < SMOOTH_LANES ? many - k : SMOOTH_LANES;
      if (group > 1) {
        found = ReturnLanes(mat, b, list + k, group, why) && found;
        continue;
      }
      Yielding y;

      TakeYielding(b, list[k], &y);
      found = ReturnOne(mat, b, &y, why) && found;
    }
  }
  return found;
}
