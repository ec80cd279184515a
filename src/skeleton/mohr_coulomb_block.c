/* Mohr-Coulomb over blocks, as the integrators without a matrix take them. */
#include "smooth.h"

#define CHUNK 32 /* particles tested at once */

/* What no principal stress of particle q exceeds, nor half the difference and the mean of the largest and the smallest
   (in the plane they are these). */
typedef struct {
  double hi, shear, mean;
} Bounds;

INLINE Bounds BoundsOf(const SkeletonStore *f, ptrdiff_t q)
{
  const double xx = f->sig[XX][q], yy = f->sig[YY][q], zz = f->sig[ZZ][q], xy = f->sig[XY][q];
#if CL_DIM == 2
  const double d = 0.5 * (xx - yy), m = 0.5 * (xx + yy), r = sqrt(d * d + xy * xy);
  const double hi = m + r > zz ? m + r : zz, lo = m - r < zz ? m - r : zz;

  return (Bounds){hi, 0.5 * (hi - lo), 0.5 * (hi + lo)};
#else
  const double p = (xx + yy + zz) / 3.0, a = xx - p, b = yy - p, c = zz - p, yz = f->sig[YZ][q], xz = f->sig[XZ][q],
               J = sqrt(0.5 * (a * a + b * b + c * c) + xy * xy + yz * yz + xz * xz), root = sqrt(3.0);

  return (Bounds){p + 2.0 / root * J, J, p + 0.5 / root * J}; /* p + 2/sqrt(3) J cos of Lode's angle, and so on */
#endif
}

/* Which of n trial states from q on may yield, without exponentials or angles of their own: where nothing has flowed
   yet (nor around it), friction is that of the peak and the cohesion c_min or more, both by (455); where all normal
   stresses are compressive, no strength is below the residual one.  All of them reduced (87).  Vector code. */
static void MayYield(const Plasticity *law, const SkeletonStore *f, int q, int n, unsigned char may[CHUNK])
{
  const double part = StrengthReduced(law, 1.0), peak = atan(part * tan(law->phi_peak * M_PI / 180.0)),
               res = atan(part * tan(law->phi_res * M_PI / 180.0)), sp = sin(peak), sr = sin(res),
               cp = part * law->c_min * cos(peak), cr = part * law->c_res * cos(res), cutoff = StrengthCutoff(law),
               deep_p = part * (StrengthBelow(law, law->c_min, 1.0) - law->c_min) * cos(peak),
               deep_r = part * (StrengthBelow(law, law->c_res, 1.0) - law->c_res) * cos(res), up = (double)law->up;
  const int     own = law->nonlocal == 0.0; /* strength follows the particle's own strain */
  const double *eps = f->own[OWN_P_EPS] + q, *open = f->own[OWN_P_OPENING] + q,
               *at = law->gradient > 0.0 ? f->place[law->axis] + q : eps;

  for (int k = 0; k < n; k++) {
    const Bounds of = BoundsOf(f, q + k);
    const double hi = of.hi, shear = of.shear, mean = of.mean, below = up * (law->level - at[k]),
                 depth = below > 0.0 ? below : 0.0;
    const int fresh    = own & (eps[k] == 0.0) & (shear + mean * sp <= cp + deep_p * depth),
              worn     = (hi <= 0.0) & (shear + mean * sr <= cr + deep_r * depth);

    may[k] = (unsigned char)!((open[k] <= 0.0) & (hi <= cutoff) & (fresh | worn));
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
  y->s = (SkeletonState){.own = {[OWN_P_EPS] = f->own[OWN_P_EPS][q], [OWN_P_OPENING] = f->own[OWN_P_OPENING][q]}};
  for (int k = 0; k < CL_TENSOR; k++)
    y->s.sig[k] = f->sig[k][q];
  PrincipalOf(y->s.sig, &y->p);
}

/* What the block keeps of a particle that yields. */
static void KeepYielding(const Material *mat, const SkeletonBlock *b, const Yielding *y, const double over[CL_TENSOR])
{
  const SkeletonStore *f     = &b->store;
  const double         share = BondShare(&mat->elasticity, &y->d);

  b->work[y->q]  = y->s.work;
  f->yield[y->q] = (double)y->s.region;
  if (y->s.region == RETURN_ELASTIC)
    return;
  f->own[OWN_P_EPS][y->q]     = y->s.own[OWN_P_EPS];
  f->own[OWN_P_OPENING][y->q] = y->s.own[OWN_P_OPENING];
  for (int k = 0; k < CL_TENSOR; k++) {
    f->sig[k][y->q] = y->s.sig[k];
    if (share != 0.0)
      f->own[OWN_P_BOND + k][y->q] -= share * over[k];
  }
}

static bool ReturnOne(const Material *mat, const SkeletonBlock *b, Yielding *y, const char **why)
{
  double place[CL_DIM];

  SkeletonPlace(&b->store, y->q, place);
  const Plasticity law = StrengthAtDepth(&mat->plasticity, StrengthDepth(&mat->plasticity, place));
  const Returning  r   = {.mat      = mat,
                          .law      = &law,
                          .d        = &y->d,
                          .nonlocal = SkeletonNonlocal(&b->store, y->q),
                          .trial    = &y->s,
                          .axes     = &y->p};
  Landed           l;
  const bool       found = ReturnTrial(&r, &l, why);

  y->s = l.s;
  KeepYielding(mat, b, y, l.over);
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
    double         over[CL_TENSOR], e[CL_TENSOR];

    const bool open = y[i].s.own[OWN_P_OPENING] > 0.0;

    if (l.elastic[i] && !open)
      continue;
    if (!l.found[i] || open) {
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
  const Plasticity *law = &mat->plasticity;
  const bool        lanes =
      law->flow == FLOW_MENETREY_WILLAM && law->gradient == 0.0 && (law->factor == 0.0 || law->factor == 1.0);
  bool          found = Block_Elastic(mat, b, why);
  unsigned char may[CHUNK];

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
