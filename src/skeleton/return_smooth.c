/* Return along the smooth potential: five equations for three stresses, multiplier and plastic strain
   (docs/equations.md, section 14).  The potential is isotropic and convex, so the order of the stresses stays and one
   multiplier is enough: edges of the yield surface need no case of their own. */
#include "smooth.h"

#define UNKNOWNS SMOOTH_UNKNOWNS
#define ITERATIONS 30
#define HALVINGS 12
#define BISECTIONS 60
#define SHARP 1e-6 /* roundness of the potential's end, of the stress, below which it is a point */
#define FLAT 1e-7  /* dilation below which the potential has no end to speak of: to the apex at once */
#define CLOSE SMOOTH_CLOSE

static void Equations(const Trial3 *t, const double x[UNKNOWNS], bool slopes, SmoothSystem *s)
{
  Strength k;

  StrengthAt(t, t->eps + x[X_EPS], &k);
  const SmoothAngles a = {sin(k.phi), cos(k.phi), tan(k.psi), FlowRoundness(t->law)};
  SmoothEquations(t, &k, &a, x, slopes, s);
}

/* A z = b for m right sides, with pivots; both are overwritten.  False if A is singular. */
static bool Solve(double A[UNKNOWNS][UNKNOWNS], int m, double b[UNKNOWNS][BY_COUNT])
{
  for (int k = 0; k < UNKNOWNS; k++) {
    int top = k;

    for (int i = k + 1; i < UNKNOWNS; i++)
      top = fabs(A[i][k]) > fabs(A[top][k]) ? i : top;
    if (!(fabs(A[top][k]) > 0.0))
      return false;
    for (int j = 0; top != k && j < UNKNOWNS; j++) {
      const double a = A[k][j];

      A[k][j]   = A[top][j];
      A[top][j] = a;
    }
    for (int j = 0; top != k && j < m; j++) {
      const double a = b[k][j];

      b[k][j]   = b[top][j];
      b[top][j] = a;
    }
    for (int i = k + 1; i < UNKNOWNS; i++) {
      const double f = A[i][k] / A[k][k];

      for (int j = k + 1; j < UNKNOWNS; j++)
        A[i][j] -= f * A[k][j];
      for (int j = 0; j < m; j++)
        b[i][j] -= f * b[k][j];
    }
  }
  for (int k = UNKNOWNS - 1; k >= 0; k--) {
    for (int j = 0; j < m; j++) {
      for (int i = k + 1; i < UNKNOWNS; i++)
        b[k][j] -= A[k][i] * b[i][j];
      b[k][j] /= A[k][k];
    }
  }
  return true;
}

/* Matrix with the column of the plastic strain per Pa, so that its pivots are of one size. */
static bool NewtonStep(const Trial3 *t, SmoothSystem *s, double dx[UNKNOWNS])
{
  double b[UNKNOWNS][BY_COUNT];

  for (int i = 0; i < UNKNOWNS; i++) {
    b[i][0] = -s->r[i];
    s->A[i][X_EPS] /= t->E;
  }
  if (!Solve(s->A, 1, b))
    return false;
  for (int i = 0; i < UNKNOWNS; i++)
    dx[i] = b[i][0];
  dx[X_EPS] /= t->E;
  return true;
}

/* Near the apex the flow is so steep that round-off of the stresses keeps the residual from falling: there the next
   step says how well they are known. */
static bool Settled(const Trial3 *t, double scale, const double x[UNKNOWNS], const double dx[UNKNOWNS])
{
  const double most = fmax(fmax(fabs(dx[0]), fabs(dx[1])), fmax(fabs(dx[2]), t->E * fabs(dx[X_EPS])));

  return most <= CLOSE * scale && x[X_L] >= -CLOSE * scale;
}

/* What that leaves of F goes off the mean stress. */
static bool OntoSurface(const Trial3 *t, double x[UNKNOWNS])
{
  Strength k;
  double   dF[3], dphi;

  StrengthAt(t, t->eps + x[X_EPS], &k);
  const double off = MohrCoulombYield(k.phi, k.c, x, dF, &dphi) / (dF[0] + dF[2]);
  for (int i = 0; i < 3; i++)
    x[i] -= isfinite(off) ? off : 0.0;
  return true;
}

/* Newton with halved steps from x; true if it arrived. */
static bool Newton(const Trial3 *t, double scale, double x[UNKNOWNS], int *iterations)
{
  SmoothSystem s;
  double       size, dx[UNKNOWNS];

  Equations(t, x, false, &s);
  size = SmoothSize(&s);
  for (int it = 0; it < ITERATIONS; it++) {
    const bool close = size <= CLOSE * scale;
    double     step  = 1.0, to[UNKNOWNS];

    ++*iterations;
    if (!isfinite(size) || !NewtonStep(t, &s, dx))
      return false;
    for (int h = 0;; h++, step *= 0.5) {
      for (int i = 0; i < UNKNOWNS; i++)
        to[i] = x[i] + step * dx[i];
      Equations(t, to, false, &s);
      const double now = SmoothSize(&s);
      if (close && !(now < size))
        return x[X_L] >= -CLOSE * scale; /* the better one stays */
      if (close || now < (1.0 - 1e-4 * step) * size) {
        size = now;
        break;
      }
      if (h == HALVINGS)
        return Settled(t, scale, x, dx) && OntoSurface(t, x);
    }
    for (int i = 0; i < UNKNOWNS; i++)
      x[i] = to[i];
    if (close)
      return x[X_L] >= -CLOSE * scale;
  }
  return false;
}

static void Slopes(const Trial3 *t, const double x[UNKNOWNS], Returned *r)
{
  SmoothSystem s;

  Equations(t, x, true, &s);
  for (int i = 0; i < UNKNOWNS; i++) {
    s.A[i][X_EPS] /= t->E;
    for (int j = 0; j < BY_COUNT; j++)
      s.by[i][j] = -s.by[i][j];
  }
  if (!Solve(s.A, BY_COUNT, s.by))
    return;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < BY_COUNT; j++)
      r->dy[i][j] = s.by[i][j];
  }
}

/* First guess beyond the apex: the mean stress of the apex, the deviator as the nearly flat end of the potential leaves
   it. */
static void GuessBeyond(const Trial3 *t, double x[UNKNOWNS])
{
  Strength     k;
  double       ds[3];
  const double sm = (t->y[0] + t->y[1] + t->y[2]) / 3.0, norm = DeviatoricNorm(t->y, ds);

  x[X_EPS] = norm / (t->G2 * t->E);
  StrengthAt(t, t->eps + x[X_EPS], &k);
  const double tp = tan(k.psi), m = FlowRoundness(t->law) * tp, at = k.c / tan(k.phi),
               R    = (3.0 - sin(k.phi)) / (6.0 * cos(k.phi));
  x[X_L]            = (sm - at) / ((t->G2 + 3.0 * t->lame) * tp / 3.0);
  const double keep = 1.0 / (1.0 + t->G2 * x[X_L] * 1.5 * R * R / m);
  for (int i = 0; i < 3; i++)
    x[i] = at + keep * (t->y[i] - sm);
}

/* First guess near the end of a potential with hardly any dilation: R_mw of triaxial compression at every theta leaves
   one equation for the share of the deviator that stays, F = 0, which rises with it. */
static void GuessShare(const Trial3 *t, double x[UNKNOWNS])
{
  Strength     k;
  double       ds[3], dF[3], F_phi, low = 0.0, high = 1.0, keep = 1.0;
  const double sm = (t->y[0] + t->y[1] + t->y[2]) / 3.0, norm = DeviatoricNorm(t->y, ds);

  x[X_EPS] = norm / (t->G2 * t->E);
  StrengthAt(t, t->eps + x[X_EPS], &k);
  const double tp = tan(k.psi), m = FlowRoundness(t->law) * tp, K = (t->G2 + 3.0 * t->lame) * tp / 3.0,
               R = (3.0 - sin(k.phi)) / (6.0 * cos(k.phi)), rho = 1.5 * R * norm,
               F = MohrCoulombYield(k.phi, k.c, t->y, dF, &F_phi), shear = F + k.c - sm * tan(k.phi);
  for (int i = 0; i < BISECTIONS; i++) {
    keep   = 0.5 * (low + high);
    x[X_L] = (1.0 / keep - 1.0) * hypot(m, keep * rho) / (1.5 * R * R * t->G2);
    if (keep * shear + (sm - K * x[X_L]) * tan(k.phi) > k.c)
      high = keep;
    else
      low = keep;
  }
  for (int i = 0; i < 3; i++)
    x[i] = sm - K * x[X_L] + keep * (t->y[i] - sm);
  x[X_EPS] *= 1.0 - keep;
}

/* For trial states from which Newton does not arrive: along the way from a state of equal stresses inside the yield
   surface to the trial state, each solution the guess of the next. */
static bool Continuation(const Trial3 *t, double scale, double x[UNKNOWNS], int *iterations)
{
  Trial3   at = *t;
  Strength k;
  double   done = 0.0, step = 0.25, from[UNKNOWNS], inside, dF[3], dphi;

  StrengthAt(t, t->eps, &k);
  inside = fmin((t->y[0] + t->y[1] + t->y[2]) / 3.0, k.phi > 0.0 ? 0.5 * k.c / tan(k.phi) : INFINITY);
  for (int i = 0; i < UNKNOWNS; i++)
    from[i] = i < 3 ? inside : 0.0;
  while (done < 1.0 && step > 1e-4) {
    const double to = fmin(done + step, 1.0);

    for (int i = 0; i < 3; i++)
      at.y[i] = inside + to * (t->y[i] - inside);
    const bool elastic = MohrCoulombYield(k.phi, k.c, at.y, dF, &dphi) <= 0.0;
    for (int i = 0; i < UNKNOWNS; i++)
      x[i] = i < 3 && (elastic || from[X_L] == 0.0) ? at.y[i] : from[i];
    if (!elastic && !Newton(&at, scale, x, iterations)) {
      step *= 0.5;
      continue;
    }
    for (int i = 0; i < UNKNOWNS; i++)
      from[i] = x[i];
    done = to;
    step *= 2.0;
  }
  return done >= 1.0;
}

/* Does a potential that ends in a point (no cohesion, or hardly any dilation left) keep a trial state beyond the apex
   there?  Its flow must reach the trial deviator: |s_tr| <= 2 G/E L rho(s_tr)/|s_tr|, L what the mean stress asks for.
 */
static bool StaysAtApex(const Trial3 *t, double scale, const Returned *apex)
{
  const double sm = (t->y[0] + t->y[1] + t->y[2]) / 3.0, s[3] = {t->y[0] - sm, t->y[1] - sm, t->y[2] - sm};
  Strength     k;
  FlowGradient P;

  StrengthAt(t, apex->eps, &k);
  if (k.psi < FLAT)
    return true;
  if (FlowRoundness(t->law) * tan(k.psi) > SHARP * scale)
    return false;
  MenetreyWillamGradient(k.phi, k.psi, 0.0, s, &P);
  const double L = (sm - apex->y[0]) / ((t->G2 + 3.0 * t->lame) * tan(k.psi) / 3.0);
  return s[0] * s[0] + s[1] * s[1] + s[2] * s[2] <= t->G2 * L * (s[0] * P.dev[0] + s[1] * P.dev[1] + s[2] * P.dev[2]);
}

bool ReturnSmooth(const Trial3 *t, bool slopes, Returned *r)
{
  double   x[UNKNOWNS] = {t->y[0], t->y[1], t->y[2], 0.0, 0.0}, size = 0.0;
  Returned apex;

  for (int i = 0; i < 3; i++)
    size = fmax(size, fabs(t->y[i]));
  const bool near   = ReturnApex(t, FLAT * size, slopes, &apex);
  const bool beyond = near && (t->y[0] + t->y[1] + t->y[2]) / 3.0 >= apex.y[0] - CLOSE * size;
  bool       found  = false;
  r->iterations     = 0;
  r->region         = RETURN_FACE;
  if (beyond) {
    if (StaysAtApex(t, size, &apex)) {
      apex.iterations = 0;
      *r              = apex;
      return true;
    }
    GuessBeyond(t, x);
    found = isfinite(x[0] + x[X_L]) && Newton(t, size, x, &r->iterations);
  }
  if (!found) {
    for (int i = 0; i < UNKNOWNS; i++)
      x[i] = i < 3 ? t->y[i] : 0.0;
    found = Newton(t, size, x, &r->iterations);
  }
  if (!found) {
    GuessShare(t, x);
    found = isfinite(x[0] + x[X_L]) && Newton(t, size, x, &r->iterations);
  }
  found = found || (!beyond && Continuation(t, size, x, &r->iterations));
  if (!found) { /* in a needle: what is found below the apex would differ from it by less than FLAT */
    apex.iterations = r->iterations;
    *r              = apex;
    return near;
  }
  for (int i = 0; i < 3; i++)
    r->y[i] = x[i];
  r->eps = t->eps + x[X_EPS];
  if (slopes)
    Slopes(t, x, r);
  return true;
}
