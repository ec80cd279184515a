/* The smooth return of several particles at once: the equations of return_smooth.c in vector code, for states that need
   nothing but Newton's full steps.  What is not found here is left to ReturnSmooth. */
#include "smooth.h"

/* glibc's vector versions of these, which it declares under -ffast-math only. */
#if defined(__x86_64__) && defined(__GLIBC__) && defined(__GNUC__) && !defined(__clang__)
  #if __GLIBC_PREREQ(2, 35)
    #define VECTOR __attribute__((simd("notinbranch"), const, nothrow)) extern
VECTOR double exp(double);
VECTOR double tan(double);
  #endif
#endif

#define PASSES 8          /* of Newton; three are usual */
#define COMPRESSED 1e-6   /* mean stress below this share of the largest: the apex is not near (66) */
#define SMALL_EXPONENT 50 /* of the laws' exponentials: beyond it LawExp bends them */

typedef double Numbers[SMOOTH_LANES];

/* Strength at S_h before softening; without the slopes in S_h, which Newton does not need. */
typedef struct {
  Numbers c, psi;
} Peaks;

/* Newton's unknowns with their residual, and what became of the lane. */
typedef struct {
  Numbers x[SMOOTH_UNKNOWNS], size, scale;
  Numbers open; /* 1: still on its way, 0: done or given up */
  Numbers good; /* 1: done */
} Iterate;

/* Newton's step by the inverse of the leading 3 x 3 block, which is symmetric and positive definite as P is convex, and
   Cramer's rule for what is left of the other two. */
INLINE void StepOf(const SmoothSystem *s, double dx[SMOOTH_UNKNOWNS])
{
  const double a = s->A[0][0], b = s->A[0][1], c = s->A[0][2], d = s->A[1][1], e = s->A[1][2], f = s->A[2][2];
  const double C00 = d * f - e * e, C01 = c * e - b * f, C02 = b * e - c * d, C11 = a * f - c * c, C12 = b * c - a * e,
               C22 = a * d - b * b, per = 1.0 / (a * C00 + b * C01 + c * C02);
  const double inv[3][3] = {
      {per * C00, per * C01, per * C02}, {per * C01, per * C11, per * C12}, {per * C02, per * C12, per * C22}};
  double z[3][3]; /* of the residual, and of the columns of the multiplier and of the plastic strain */

#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    z[0][i] = -inv[i][0] * s->r[0] - inv[i][1] * s->r[1] - inv[i][2] * s->r[2];
    z[1][i] = inv[i][0] * s->A[0][X_L] + inv[i][1] * s->A[1][X_L] + inv[i][2] * s->A[2][X_L];
    z[2][i] = inv[i][0] * s->A[0][X_EPS] + inv[i][1] * s->A[1][X_EPS] + inv[i][2] * s->A[2][X_EPS];
  }
  double m[2][3]; /* rows F and eps: columns as in z, the residual to the right side */
#pragma GCC unroll 2
  for (int i = 0; i < 2; i++) {
    const double *row = s->A[X_L + i];

    m[i][0] = -s->r[X_L + i] - row[0] * z[0][0] - row[1] * z[0][1] - row[2] * z[0][2];
    m[i][1] = row[X_L] - row[0] * z[1][0] - row[1] * z[1][1] - row[2] * z[1][2];
    m[i][2] = row[X_EPS] - row[0] * z[2][0] - row[1] * z[2][1] - row[2] * z[2][2];
  }
  const double det = 1.0 / (m[0][1] * m[1][2] - m[0][2] * m[1][1]);
  dx[X_L]          = (m[0][0] * m[1][2] - m[0][2] * m[1][0]) * det;
  dx[X_EPS]        = (m[0][1] * m[1][0] - m[0][0] * m[1][1]) * det;
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++)
    dx[i] = z[0][i] - z[1][i] * dx[X_L] - z[2][i] * dx[X_EPS];
}

typedef struct {
  double G2, lame, eta, own, roundness; /* own: 1 where strength follows the particle's own strain */
} Fixed;

/* Strength at the strain `eps`, which grows by the iterate's own part. */
INLINE void StrengthAtIterate(const Plasticity *law, const Fixed *c, const PeakStrength *peak, double eps, double grown,
                              Strength *k)
{
  const double left = exp(-c->eta * (eps + c->own * grown));

  SoftenedStrengthOf(law, peak, c->eta, left, left, k);
  k->c_e *= c->own;
  k->phi_e *= c->own;
  k->psi_e *= c->own;
}

/* One full step of every lane that is open.  A lane is done when the residual it steps from is small; it is given up
   when a step does not shrink the residual. */
static __attribute__((noinline)) void Pass(const Plasticity *law, const Fixed *c, const Peaks *peak,
                                           const SmoothLanes *l, bool first, Numbers elastic, Iterate *n)
{
  const Plasticity p     = *law;
  const Fixed      fixed = *c;
  const double    *eps   = c->own > 0.0 ? l->eps : l->nonlocal;

  INDEPENDENT
  for (int q = 0; q < SMOOTH_LANES; q++) {
    const Trial3 t = {.G2 = fixed.G2, .lame = fixed.lame, .E = l->E[q], .y = {l->y[0][q], l->y[1][q], l->y[2][q]}};
    double       x[SMOOTH_UNKNOWNS], dx[SMOOTH_UNKNOWNS];
    const PeakStrength at = {.c = peak->c[q], .psi = peak->psi[q]};
    Strength           k;
    SmoothSystem       s;

#pragma GCC unroll 5
    for (int i = 0; i < SMOOTH_UNKNOWNS; i++)
      x[i] = n->x[i][q];
    StrengthAtIterate(&p, &fixed, &at, eps[q], x[X_EPS], &k);
    const double       half = tan(0.5 * k.phi), per = 1.0 / (1.0 + half * half); /* sine and cosine would be one call */
    const SmoothAngles a = {2.0 * half * per, (1.0 - half * half) * per, tan(k.psi), fixed.roundness};
    SmoothEquations(&t, &k, &a, x, false, &s);
    const double size = SmoothSize(&s),
                 room = YIELD_ROUND_OFF * k.c + 1e-2 * YIELD_ROUND_OFF * (fabs(t.y[0]) + fabs(t.y[2]));
    const int close = size <= SMOOTH_CLOSE * n->scale[q], falls = first | (size < (1.0 - 1e-4) * n->size[q]),
              go = (n->open[q] > 0.0) & (falls | close);

    StepOf(&s, dx);
    elastic[q] = (first & (n->open[q] > 0.0) & !(s.r[X_L] > room)) ? 1.0 : elastic[q];
#pragma GCC unroll 5
    for (int i = 0; i < SMOOTH_UNKNOWNS; i++)
      n->x[i][q] = go ? x[i] + dx[i] : x[i];
    n->size[q] = size;
    n->good[q] = (go & close) ? 1.0 : n->good[q];
    n->open[q] = (go & !close) ? 1.0 : 0.0;
  }
}

void ReturnSmoothLanes(const Plasticity *law, double G2, double lame, SmoothLanes *l)
{
  const Fixed c = {G2, lame, SofteningRate(law), law->nonlocal > 0.0 ? 0.0 : 1.0, FlowRoundness(law)};
  Peaks       peak;
  Numbers     elastic = {0.0};
  Iterate     n       = {0};
  double      open    = 1.0;

  for (int q = 0; q < SMOOTH_LANES; q++) {
    const double exponent = law->eta_h * (l->Sh[q] - law->Sh_max), hydrate = exp(exponent),
                 softens = c.eta * (c.own > 0.0 ? l->eps[q] : l->nonlocal[q]);
    PeakStrength at;
    const double mean = (l->y[0][q] + l->y[1][q] + l->y[2][q]) / 3.0, most = fmax(fabs(l->y[0][q]), fabs(l->y[2][q]));

    PeakStrengthOf(law, hydrate, hydrate, &at);
    peak.c[q]   = at.c;
    peak.psi[q] = at.psi;
    for (int i = 0; i < 3; i++)
      n.x[i][q] = l->y[i][q];
    n.scale[q] = most;
    n.open[q] =
        ((mean < -COMPRESSED * most) & (fabs(exponent) < SMALL_EXPONENT) & (softens < SMALL_EXPONENT)) ? 1.0 : 0.0;
  }
  for (int it = 0; it < PASSES && open > 0.0; it++) {
    Pass(law, &c, &peak, l, it == 0, elastic, &n);
    open = 0.0;
    for (int q = 0; q < SMOOTH_LANES; q++) {
      n.open[q] = elastic[q] > 0.0 ? 0.0 : n.open[q];
      open += n.open[q];
    }
  }
  for (int q = 0; q < SMOOTH_LANES; q++) {
    const double slack = SMOOTH_CLOSE * n.scale[q];

    l->elastic[q] = elastic[q] > 0.0;
    l->found[q]   = !l->elastic[q] & (n.good[q] > 0.0) & (n.x[X_L][q] >= -slack) & (n.x[0][q] >= n.x[1][q] - slack) &
                  (n.x[1][q] >= n.x[2][q] - slack);
    for (int i = 0; i < 3; i++)
      l->y[i][q] = n.x[i][q];
    l->eps[q] += n.x[X_EPS][q];
  }
}
