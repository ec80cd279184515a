/* Modified Cam-clay (Roscoe and Burland 1968) with the elasticity of (14). */
#include "plastic.h"

#define ITERATIONS 100

/* Trial invariants, moduli, and the return: multiplier L (1/Pa), volumetric plastic strain e. */
typedef struct {
  double M2, lambda, pt, qt, K, G, pc_n; /* given */
  double L, e, p, q, pc, shrink;         /* shrink = q/q_t */
} Clay;

/* State at a multiplier; returns f and its slope. */
static double AtMultiplier(Clay *c, double L, double *slope)
{
  double e = c->e, g_e = 1.0;

  for (int it = 0; it < ITERATIONS; it++) {
    c->pc          = c->pc_n * exp(e / c->lambda);
    g_e            = 1.0 + 2.0 * c->K * L + L * c->pc / c->lambda;
    const double g = e - L * (2.0 * (c->pt - c->K * e) - c->pc), step = fmax(fmin(g / g_e, c->lambda), -c->lambda);

    e -= step;
    if (fabs(step) <= 1e-16 + 1e-15 * fabs(e))
      break;
  }
  c->L      = L;
  c->e      = e;
  c->pc     = c->pc_n * exp(e / c->lambda);
  c->p      = c->pt - c->K * e;
  c->shrink = 1.0 / (1.0 + 6.0 * c->G * L / c->M2);
  c->q      = c->shrink * c->qt;

  const double over = 2.0 * c->p - c->pc, e_L = over / g_e;
  *slope = -2.0 * c->q * c->q / c->M2 * c->shrink * 6.0 * c->G / c->M2 - (over * c->K + c->p * c->pc / c->lambda) * e_L;
  return c->q * c->q / c->M2 + c->p * (c->p - c->pc);
}

/* f > 0 without flow, f < 0 with much of it: Newton in a bracket. */
static bool Return(Clay *c)
{
  double lo = 0.0, hi = 1.0 / (c->K + c->G), slope, f, L = 0.0;

  for (c->e = 0.0; (f = AtMultiplier(c, hi, &slope)) > 0.0; lo = hi, hi *= 4.0) {
    if (!isfinite(f) || hi * c->G > 1e12)
      return false;
  }
  for (int it = 0; it < ITERATIONS; it++) {
    f                      = AtMultiplier(c, L, &slope);
    *(f > 0.0 ? &lo : &hi) = L;
    double next            = slope < 0.0 ? L - f / slope : lo - 1.0;
    if (!(next > lo && next < hi))
      next = fabs(f) <= 1e-15 * c->pc * c->pc ? L : 0.5 * (lo + hi);
    if (fabs(next - L) <= 1e-15 * L || hi - lo <= 1e-15 * hi)
      return true;
    L = next;
  }
  return true;
}

static bool Evaluate(const Material *mat, const SkeletonStep *d, const SkeletonState *s, Clay *c)
{
  const double E = StageModulus(&mat->elasticity, d), nu = mat->elasticity.nu;

  *c = (Clay){.M2     = mat->plasticity.M * mat->plasticity.M,
              .lambda = mat->plasticity.lambda,
              .pt     = -(s->sig[XX] + s->sig[YY] + s->sig[ZZ]) / 3.0,
              .qt     = Mises6(s->sig),
              .K      = E / (3.0 * (1.0 - 2.0 * nu)),
              .G      = 0.5 * E / (1.0 + nu),
              .pc_n   = s->own[OWN_P_PC]};
  return c->qt * c->qt / c->M2 + c->pt * (c->pt - c->pc_n) > 1e-12 * c->pc_n * c->pc_n;
}

static double Double(const double a[CL_TENSOR], const double b[CL_TENSOR])
{
  double sum = 0.0;

  for (int k = 0; k < CL_TENSOR; k++)
    sum += (k < 3 ? 1.0 : 2.0) * a[k] * b[k];
  return sum;
}

/* The two equations e = L (2p - p_c), f = 0, solved for their slopes in every number of the step. */
static void Tangent(const Elasticity *el, const SkeletonStep *d, const Clay *c, const double dev[CL_TENSOR],
                    SkeletonTangent *t)
{
  const double E = StageModulus(el, d), over = 2.0 * c->p - c->pc, b = 6.0 / c->M2 * c->shrink;
  const double A[2][2] = {{1.0 + 2.0 * c->K * c->L + c->L * c->pc / c->lambda, -over},
                          {-over * c->K - c->p * c->pc / c->lambda, -2.0 * c->q * c->q / c->M2 * b * c->G}};
  const double det     = A[0][0] * A[1][1] - A[0][1] * A[1][0];

  for (int k = 0; k < SKELETON_IN; k++) {
    double       ds[CL_TENSOR];
    const double dE = StageModulusSlope(el, d, k) / E, dpt = -(t->d[0][k] + t->d[1][k] + t->d[2][k]) / 3.0;

    for (int a = 0; a < CL_TENSOR; a++)
      ds[a] = t->d[a][k] + (a < 3 ? dpt : 0.0);
    const double qdq = 1.5 * c->shrink * c->shrink * Double(dev, ds), dp0 = dpt - c->K * c->e * dE,
                 dq0 = -2.0 * c->q * c->q / c->M2 * b * c->L * c->G * dE;
    const double r0 = 2.0 * c->L * dp0, r1 = -(over * dp0 + 2.0 / c->M2 * qdq + dq0);
    const double de = (r0 * A[1][1] - A[0][1] * r1) / det, dL = (A[0][0] * r1 - A[1][0] * r0) / det;
    const double dp = dp0 - c->K * de, dshrink = -c->shrink * b * c->G * (dL + c->L * dE);
    const double q_dq = qdq + c->q * c->q * dshrink / c->shrink;

    for (int a = 0; a < CL_TENSOR; a++)
      t->d[a][k] = c->shrink * ds[a] + dshrink * dev[a] - (a < 3 ? dp : 0.0);
    t->d[SKELETON_WORK][k] = dp * c->e + c->p * de + 2.0 / c->M2 * (dL * c->q * c->q + 2.0 * c->L * q_dq);
  }
}

/* From the trial state in s to f = 0. */
static bool Flow(const Material *mat, const SkeletonStep *d, SkeletonState *s, SkeletonTangent *t,
                 double over[CL_TENSOR], double e[CL_TENSOR], const char **why)
{
  Clay   c;
  double dev[CL_TENSOR];

  if (!Evaluate(mat, d, s, &c))
    return true;
  if (!Return(&c)) {
    *why = "Cam-clay found no state on its yield surface";
    return false;
  }
  for (int a = 0; a < CL_TENSOR; a++) {
    const double sig = s->sig[a];

    dev[a]    = sig + (a < 3 ? c.pt : 0.0);
    s->sig[a] = c.shrink * dev[a] - (a < 3 ? c.p : 0.0);
    over[a]   = sig - s->sig[a];
  }
  if (t)
    Tangent(&mat->elasticity, d, &c, dev, t);
  PlasticStrain(&mat->elasticity, StageModulus(&mat->elasticity, d), over, e);
  s->own[OWN_P_EPS] += c.L * 2.0 * c.q / c.M2;
  s->own[OWN_P_PC] = c.pc;
  s->region        = RETURN_FACE;
  s->work          = c.p * c.e + c.L * 2.0 * c.q * c.q / c.M2;
  return true;
}

bool Update_CamClay(const Material *mat, const SkeletonHistory *h, const SkeletonStep *d, SkeletonState *s,
                    SkeletonTangent *t, const char **why)
{
  double over[CL_TENSOR], e[CL_TENSOR];

  TrialState(&mat->elasticity, h, d, s, t);
  if (!Flow(mat, d, s, t, over, e, why))
    return false;
  if (s->region != RETURN_ELASTIC)
    ReturnEnd(&mat->elasticity, h, d, over, e, s);
  return true;
}

/* Trial states in vector code, then one by one. */
bool Block_CamClay(const Material *mat, const SkeletonBlock *b, const char **why)
{
  const SkeletonStore *f     = &b->store;
  bool                 found = Block_Elastic(mat, b, why);

  for (int q = 0; q < b->n; q++) {
    const SkeletonStep d = {.E = b->E[q], .Sh = b->Sh[q], .kept = b->kept ? b->kept[q] : 1.0};
    SkeletonState      s = {.region = RETURN_ELASTIC};
    double             over[CL_TENSOR], e[CL_TENSOR];

    for (int k = 0; k < CL_TENSOR; k++)
      s.sig[k] = f->sig[k][q];
    s.own[OWN_P_EPS]   = f->own[OWN_P_EPS][q];
    s.own[OWN_P_PC]    = f->own[OWN_P_PC][q];
    const bool fine    = Flow(mat, &d, &s, NULL, over, e, why);
    found              = found && fine;
    const double share = BondShare(&mat->elasticity, &d);
    for (int k = 0; k < CL_TENSOR && s.region != RETURN_ELASTIC; k++) {
      f->sig[k][q] = s.sig[k];
      if (share != 0.0)
        f->own[OWN_P_BOND + k][q] -= share * over[k];
    }
    f->own[OWN_P_EPS][q] = s.own[OWN_P_EPS];
    f->own[OWN_P_PC][q]  = s.own[OWN_P_PC];
    f->yield[q]          = (double)s.region;
    b->work[q]           = fine ? s.work : NAN;
  }
  return found;
}

void Start_CamClay(const Material *mat, double own[OWN_COUNT])
{
  own[OWN_P_PC] = mat->plasticity.pc0;
}
