/* Unit tests of src/skeleton, Mohr-Coulomb: points known from elsewhere, the yield surface held, the tangent in every
   region, turned frames, a drained biaxial path. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include "clathra/skeleton.h"
#include "random.h"

#define DEG (3.14159265358979323846 / 180.0)

typedef struct {
  Material        mat;
  SkeletonHistory h;
  double          in[SKELETON_IN], E_n;
  int             which;
} Sample;

static SkeletonStep StepOf(const Sample *q, const double in[SKELETON_IN])
{
  return (SkeletonStep){
      .turn    = {cos(in[SKELETON_THETA]), sin(in[SKELETON_THETA])},
      .e       = {in[SKELETON_STRAIN], in[SKELETON_STRAIN + 1], in[SKELETON_STRAIN + 2], in[SKELETON_STRAIN + 3]},
      .thermal = in[SKELETON_THERMAL],
      .E_n     = q->E_n,
      .E       = in[SKELETON_E],
      .Sh      = in[SKELETON_SH],
      .kept    = in[SKELETON_KEPT]};
}

static bool Go(const Sample *q, const double in[SKELETON_IN], SkeletonState *s, SkeletonTangent *t)
{
  const SkeletonStep d   = StepOf(q, in);
  const char        *why = NULL;

  const bool found = SkeletonUpdate(&q->mat, &q->h, &d, s, t, &why);

  assert_true(found == (why == NULL));
  return found;
}

/* ---------------------------------------------------------------- the potential */
/* (49), (50), straight from the paper. */
static double Potential(double phi, double psi, double apex, const double y[3])
{
  const double sm = (y[0] + y[1] + y[2]) / 3.0, top = fmax(y[0], fmax(y[1], y[2]));
  double       J2 = 0.0;

  for (int i = 0; i < 3; i++)
    J2 += 0.5 * (y[i] - sm) * (y[i] - sm);
  const double q = sqrt(3.0 * J2), t = 1.5 * (top - sm) / q, e = (3.0 - sin(phi)) / (3.0 + sin(phi)), a = 1.0 - e * e,
               b   = 2.0 * e - 1.0;
  const double Rmc = (1.0 / (sqrt(3.0) * cos(phi)) * sin(2.0 * M_PI / 3.0) + cos(2.0 * M_PI / 3.0) * tan(phi) / 3.0);
  const double R = (4.0 * a * t * t + b * b) / (2.0 * a * t + b * sqrt(4.0 * a * t * t + 5.0 * e * e - 4.0 * e)) * Rmc;

  return sqrt(pow(apex * tan(psi), 2.0) + pow(R * q, 2.0)) + sm * tan(psi);
}

typedef struct {
  double y[3], phi, psi, apex;
  int    which;
} PotentialAt;

static bool PotentialRows(void *ctx, double x, double out[RIDDERS_ROWS])
{
  PotentialAt  p = *(PotentialAt *)ctx;
  FlowGradient g;

  *(p.which < 3 ? &p.y[p.which] : p.which == 3 ? &p.phi : &p.psi) = x;
  MenetreyWillamGradient(p.phi, p.psi, p.apex, p.y, &g);
  out[0] = Potential(p.phi, p.psi, p.apex, p.y);
  for (int i = 0; i < 3; i++)
    out[1 + i] = g.y[i];
  return true;
}

static void TestPotential(void **state)
{
  Rng    r        = {401};
  double worst[2] = {0.0};

  (void)state;
  for (int n = 0; n < 2000; n++) {
    const double size = RngLog(&r, 1e-2, 10.0); /* MPa, of the deviator */
    PotentialAt  p    = {.phi = RngBetween(&r, 5, 50) * DEG, .psi = RngBetween(&r, 0.5, 15) * DEG, .apex = 0.1};
    FlowGradient g;
    double       d[RIDDERS_ROWS], err[RIDDERS_ROWS];

    for (int i = 0; i < 3; i++)
      p.y[i] = RngBetween(&r, -size, size);
    if (n % 3 == 0) /* near and on both edges */
      p.y[1] = p.y[n % 2 ? 0 : 2] + size * (n % 4 ? 0.0 : 1e-3);
    const double hi = fmax(p.y[0], fmax(p.y[1], p.y[2])), lo = fmin(p.y[0], fmin(p.y[1], p.y[2]));
    if (hi - lo < 0.1 * size)
      continue;
    MenetreyWillamGradient(p.phi, p.psi, p.apex, p.y, &g);
    for (p.which = 0; p.which < 5; p.which++) {
      const double at = p.which < 3 ? p.y[p.which] : p.which == 3 ? p.phi : p.psi;

      assert_true(PotentialRows(&p, at, d));
      assert_true(Ridders(PotentialRows, &p, at, p.which < 3 ? 1e-3 * size : 1e-3, 4, d, err));
      if (p.which < 3)
        worst[0] = fmax(worst[0], fabs(d[0] - g.y[p.which]));
      for (int i = 0; i < 3; i++) {
        const double exact = p.which < 3 ? g.yy[i][p.which] : p.which == 3 ? g.phi[i] : g.psi[i];

        const double off = fabs(d[1 + i] - exact) - 10.0 * err[1 + i]; /* third derivatives jump at the edges */

        worst[1] = fmax(worst[1], off / (1.0 + fabs(exact)));
      }
    }
  }
  printf("potential against differences: gradient %.1e, its slopes %.1e\n", worst[0], worst[1]);
  assert_true(worst[0] < 1e-9 && worst[1] < 1e-6);
}

/* ---------------------------------------------------------------- known points */
static Sample Point(double E, double nu, double c, double phi, double psi, const double sig[3])
{
  Sample q = {.mat.elasticity = {E, 0.0, 1.0, 1.0, nu, false},
              .mat.plasticity = {.type     = PLASTICITY_MOHR_COULOMB,
                                 .flow     = FLOW_MOHR_COULOMB,
                                 .c_max    = c,
                                 .c_min    = c,
                                 .c_res    = c,
                                 .phi_peak = phi,
                                 .phi_res  = phi,
                                 .psi_max  = psi,
                                 .psi_min  = psi,
                                 .cutoff   = INFINITY},
              .E_n            = E,
              .in[SKELETON_E] = E};

  for (int i = 0; i < 3; i++)
    q.h.sig[i] = sig[i];
  return q;
}

static double Off(const Sample *q, const double expected[3])
{
  SkeletonState s;
  double        worst = 0.0;

  assert_true(Go(q, q->in, &s, NULL));
  for (int i = 0; i < 3; i++)
    worst = fmax(worst, fabs(s.sig[i] - expected[i]) / (fabs(expected[0]) + fabs(expected[1])));
  return worst;
}

static void TestKnownPoints(void **state)
{
  const double trial[3] = {103076.923077, -169230.76923, 146153.846154}, zero[3] = {0.0};
  Sample       q = Point(2e6, 0.3, 5000.0, 30.0, 25.0, trial);
  double       worst[4];

  (void)state;
  worst[0] = Off(&q, (const double[3]){-53127.1630223, -176701.997143, -53127.1630223});
  q        = Point(2e6, 0.3, 5000.0, 50.0, 25.0, trial);
  worst[1] = Off(&q, (const double[3]){-19581.9827945, -175291.959478, -19581.9827945});
  q        = Point(1000.0, 0.0, 10.0, 35.0, 20.0, zero);

  q.mat.plasticity.cutoff   = 10.0;
  q.in[SKELETON_STRAIN]     = 0.008;
  q.in[SKELETON_STRAIN + 1] = -0.028;
  worst[2]                  = Off(&q, (const double[3]){3.430712712, -25.759721410, 0.0});
  q.mat.plasticity.cutoff   = 3.2; /* face and cut-off: f(3.2, y3) = 0 */
  const double si = sin(35.0 * DEG), y3 = (3.2 * (1.0 + si) - 20.0 * cos(35.0 * DEG)) / (1.0 - si);
  worst[3] = Off(&q, (const double[3]){3.2, y3, 0.0});
  printf("known points: off by %.1e, %.1e, %.1e, %.1e\n", worst[0], worst[1], worst[2], worst[3]);
  assert_true(worst[0] < 1e-11 && worst[1] < 1e-11 && worst[2] < 1e-10 && worst[3] < 1e-12);
}

/* ---------------------------------------------------------------- random states */
/* Two principal stresses that are equal, or nearly: those in the plane, or one of them and that out of it. */
static void MakeEqual(Rng *r, Sample *q, bool in_plane)
{
  const double near = RngPick(r, 2) ? 0.0 : RngLog(r, 1e-10, 1e-1);

  q->in[SKELETON_THETA] = 0.0;
  for (int i = 0; i < 4; i++) {
    double *v[] = {q->h.sig, q->h.sig0, &q->in[SKELETON_STRAIN], q->h.from.plastic};

    v[i][in_plane ? YY : ZZ] = v[i][XX] * (1.0 + near);
    v[i][XY] *= near;
  }
}

/* The same skeleton with part of its stiffness and of its stress the hydrate's, some of which goes in the stage. */
static void MakeBonded(Rng *r, Sample *q)
{
  const double E = q->in[SKELETON_E], stress = fabs(q->h.sig[XX]) + fabs(q->h.sig[YY]);

  q->mat.elasticity.E0     = E * RngBetween(r, 0.2, 0.8);
  q->mat.elasticity.Eh     = E;
  q->mat.elasticity.change = STIFFNESS_BONDS;
  q->in[SKELETON_KEPT]     = RngPick(r, 3) ? RngBetween(r, 0.0, 1.0) : 1.0;
  for (int k = 0; k < 4; k++) {
    q->h.from.sig[k]              = q->h.sig[k] + 0.1 * stress * RngBetween(r, -1.0, 1.0);
    q->h.from.strain[k]           = 0.3 * q->in[SKELETON_STRAIN + k];
    q->h.from.own[OWN_P_BOND + k] = 0.3 * stress * RngBetween(r, -1.0, 1.0);
  }
}

static Sample RandomSample(Rng *r, int flow, bool cutoff)
{
  const double c = RngLog(r, 5e4, 3e6), size = c * RngLog(r, 0.1, 30.0), E = size * RngLog(r, 50.0, 1e4);
  Sample       q = {.mat.elasticity = {E, 0.0, 1.0, 1.0, RngBetween(r, 0.05, 0.45), RngPick(r, 2)}};
  Plasticity  *k = &q.mat.plasticity;

  *k       = (Plasticity){.type         = PLASTICITY_MOHR_COULOMB,
                          .flow         = flow,
                          .c_max        = c,
                          .c_min        = c * RngBetween(r, 0.1, 1.0),
                          .phi_peak     = RngBetween(r, 20.0, 48.0),
                          .phi_res      = RngBetween(r, 10.0, 20.0),
                          .psi_max      = RngBetween(r, 5.0, 15.0),
                          .psi_min      = RngBetween(r, 1.0, 5.0),
                          .eta_h        = RngBetween(r, 0.0, 5.0),
                          .Sh_max       = 0.5,
                          .eta_s        = RngPick(r, 3) ? RngLog(r, 0.5, 10.0) : 0.0,
                          .eccentricity = 0.1,
                          .cutoff       = INFINITY};
  k->c_res = k->c_min * RngBetween(r, 0.1, 1.0);
  if (RngPick(r, 10) == 0)
    k->psi_max = k->psi_min = 0.0;
  if (RngPick(r, 10) == 0) /* sand: both yield surface and potential end in a point */
    k->c_max = k->c_min = k->c_res = 0.0;
  if (cutoff)
    k->cutoff = RngBetween(r, 0.0, 0.9) * k->c_res / tan(k->phi_peak * DEG);
  q.h.from.own[OWN_P_EPS] = RngPick(r, 2) ? RngLog(r, 1e-4, 1.0) : 0.0;
  q.in[SKELETON_THETA]    = RngBetween(r, -1.0, 1.0);
  q.in[SKELETON_E]        = E;
  q.in[SKELETON_SH]       = RngBetween(r, 0.0, 0.5);
  q.E_n                   = E * RngBetween(r, 0.9, 1.1);
  const double mean       = size * RngBetween(r, -1.0, 0.3);
  for (int i = 0; i < 4; i++) {
    q.h.sig0[i]               = i < 3 ? 0.2 * mean : 0.0;
    q.h.sig[i]                = (i < 3 ? mean : 0.0) + 0.3 * size * RngBetween(r, -1.0, 1.0);
    q.in[SKELETON_STRAIN + i] = size / E * RngBetween(r, -1.0, 1.0);
    q.h.from.plastic[i]       = RngPick(r, 2) ? 0.1 * size / E * RngBetween(r, -1.0, 1.0) : 0.0;
  }
  if (RngPick(r, 4) == 0)
    MakeEqual(r, &q, RngPick(r, 2));
  q.in[SKELETON_THERMAL] = 0.05 * size / E * RngBetween(r, -1.0, 1.0);
  k->factor              = RngPick(r, 3) ? 1.0 : RngBetween(r, 0.8, 2.0);
  if (RngPick(r, 3) == 0)
    MakeBonded(r, &q);
  return q;
}

/* A factor does what dividing the strengths by hand does (no softening: that of tan(phi) is not tan of that of phi). */
static void TestStrengthFactor(void **state)
{
  Rng    r          = {412};
  double worst      = 0.0;
  int    plastic[3] = {0};

  (void)state;
  for (int n = 0; n < 6000; n++) {
    Sample      q = RandomSample(&r, n % 3 ? FLOW_MOHR_COULOMB : FLOW_MENETREY_WILLAM, n % 3 == 2), by_hand;
    Plasticity *k = &q.mat.plasticity, *l = &by_hand.mat.plasticity;

    k->eta_s = k->eta_h = 0.0; /* strength is that of the ..._max */
    k->c_min = k->c_res = k->c_max;
    k->psi_min          = k->psi_max;
    k->phi_res          = k->phi_peak;
    k->factor           = RngBetween(&r, 0.5, 3.0);
    by_hand             = q;
    l->factor           = 1.0;
    l->c_max = l->c_min = l->c_res = k->c_max / k->factor;
    l->cutoff                      = k->cutoff / k->factor;
    l->phi_peak = l->phi_res = atan(tan(k->phi_peak * DEG) / k->factor) / DEG;
    l->psi_max = l->psi_min = atan(tan(k->psi_max * DEG) / k->factor) / DEG;
    SkeletonState s, t;
    const bool    found = Go(&q, q.in, &s, NULL), same = Go(&by_hand, by_hand.in, &t, NULL);

    assert_true(found == same);
    plastic[n % 3] += found && s.region != RETURN_ELASTIC;
    for (int i = 0; i < 4 && found; i++)
      worst = fmax(worst, fabs(s.sig[i] - t.sig[i]) / (fabs(t.sig[XX]) + fabs(t.sig[YY]) + fabs(t.sig[ZZ])));
  }
  printf("strength factor: off by %.1e from strengths divided by hand (%d, %d, %d plastic points)\n", worst, plastic[0],
         plastic[1], plastic[2]);
  assert_true(worst < 1e-10 && plastic[0] > 500 && plastic[1] > 500 && plastic[2] > 500);
}

/* A strength that grows with depth (455) is that of a law whose cohesions are those of the depth, slopes included;
   above the level it does not grow. */
static void TestDepth(void **state)
{
  Rng    r        = {455};
  double worst[2] = {0.0};
  int    plastic  = 0;

  (void)state;
  for (int n = 0; n < 4000; n++) {
    Sample       q = RandomSample(&r, n % 2 ? FLOW_MOHR_COULOMB : FLOW_MENETREY_WILLAM, n % 4 == 3), by_hand = q;
    Plasticity  *k = &q.mat.plasticity, *l = &by_hand.mat.plasticity;
    const double depth = RngBetween(&r, -1.0, 4.0), below = depth > 0.0 ? depth : 0.0, c = k->c_max;

    k->axis               = n % 2;
    k->up                 = n % 3 ? 1 : -1;
    k->level              = RngBetween(&r, -5.0, 5.0);
    k->gradient           = (c > 0.0 ? c : 1e5) * RngBetween(&r, 0.1, 1.0);
    q.h.place[k->axis]    = k->level - k->up * depth;
    double *const grown[] = {&l->c_min, &l->c_res, &l->c_max};
    for (int i = 0; i < 3; i++)
      *grown[i] = c > 0.0 ? *grown[i] * (1.0 + k->gradient * below / c) : k->gradient * below;
    SkeletonState   s, t;
    SkeletonTangent ds, dt;
    const bool      found = Go(&q, q.in, &s, &ds), same = Go(&by_hand, by_hand.in, &t, &dt);

    assert_true(found == same);
    plastic += found && s.region != RETURN_ELASTIC;
    for (int i = 0; i < 4 && found; i++) {
      worst[0] = fmax(worst[0], fabs(s.sig[i] - t.sig[i]) / (fabs(t.sig[XX]) + fabs(t.sig[YY]) + fabs(t.sig[ZZ])));
      for (int j = 0; j < 4; j++)
        worst[1] = fmax(worst[1], fabs(ds.d[i][SKELETON_STRAIN + j] - dt.d[i][SKELETON_STRAIN + j]) / q.in[SKELETON_E]);
    }
  }
  printf("strength with depth: stress off by %.1e, tangent by %.1e of E from cohesions by hand (%d plastic points)\n",
         worst[0], worst[1], plastic);
  assert_true(worst[0] < 1e-11 && worst[1] < 1e-7 && plastic > 1000);
}

/* Some states with tears that stand open by up to what the step moves. */
static void GiveTears(Sample *q, int n)
{
  Rng          r      = {7000 + (uint64_t)n};
  const double strain = fabs(q->in[SKELETON_STRAIN]) + fabs(q->in[SKELETON_STRAIN + 1]);

  if (n % 3 != 1)
    return;
  q->h.from.own[OWN_P_OPENING] = RngPick(&r, 3) ? strain * RngLog(&r, 1e-2, 3.0) : 0.0;
}

/* Some states of a law whose strength its neighbours' plastic strain sets. */
static void GiveNonlocal(Sample *q, int n)
{
  if (n % 5 != 4)
    return;
  q->mat.plasticity.nonlocal = 0.1;
  q->h.nonlocal              = 0.3 + 0.5 * q->h.from.own[OWN_P_EPS];
}

/* Plastic strain that sets the strength at the end. */
static double Softens(const Sample *q, const SkeletonState *s)
{
  return q->mat.plasticity.nonlocal > 0.0 ? q->h.nonlocal : s->own[OWN_P_EPS];
}

/* Principal stresses, falling. */
static void Sorted(const double s[6], double y[3])
{
  const double m = 0.5 * (s[XX] + s[YY]), r = hypot(0.5 * (s[XX] - s[YY]), s[XY]), v[3] = {m + r, m - r, s[ZZ]};
  const double hi = fmax(v[0], v[2]), lo = fmin(v[1], v[2]);

  y[0] = hi;
  y[1] = v[0] + v[1] + v[2] - hi - lo;
  y[2] = lo;
}

static void TestYieldSurface(void **state)
{
  const char *more  = getenv("CLATHRA_PLASTIC_STATES");
  const int   n     = more ? atoi(more) : 1000000;
  Rng         r     = {402};
  double      worst = 0.0, least = 0.0;
  int         count[2][6] = {{0}}, lost = 0;

  (void)state;
  for (int k = 0; k < n; k++) {
    Sample        q = RandomSample(&r, k % 2, k % 4 == 3);
    SkeletonState s;
    Strength      now;
    double        y[3], dy[3], dphi;

    GiveNonlocal(&q, k);
    GiveTears(&q, k);
    if (!Go(&q, q.in, &s, NULL)) {
      lost++;
      printf("lost %d c %g psi %g\n", k, q.mat.plasticity.c_max, q.mat.plasticity.psi_max);
      continue;
    }
    count[k % 2][s.region]++;
    if (s.region == RETURN_ELASTIC) {
      assert_true(s.work == 0.0 && s.own[OWN_P_EPS] == q.h.from.own[OWN_P_EPS]);
      continue;
    }
    StrengthEvaluate(&q.mat.plasticity, q.in[SKELETON_SH], Softens(&q, &s), &now);
    Sorted(s.sig, y);
    const double F = MohrCoulombYield(now.phi, now.c, y, dy, &dphi), over = y[0] - StrengthCutoff(&q.mat.plasticity);
    const double unit =
        now.c > 0.0 ? now.c
                    : 1e-3 * (fabs(q.h.sig[XX]) + fabs(q.h.sig[YY]) + q.in[SKELETON_E] * fabs(q.in[SKELETON_STRAIN]) +
                              q.in[SKELETON_E] * (fabs(q.in[SKELETON_STRAIN + 1]) + q.h.from.own[OWN_P_OPENING]));
    const bool inside = s.region == RETURN_TENSION || s.region == RETURN_CLOSING;

    worst = fmax(worst, fmax(inside ? F : fabs(F), over) / unit);
    least = fmin(least, s.work / (unit * fmax(1e-3, q.h.from.own[OWN_P_OPENING])));
    assert_true(s.own[OWN_P_EPS] >= q.h.from.own[OWN_P_EPS]);
  }
  for (int f = 0; f < 2; f++)
    printf("%s: %d elastic, %d face, %d edge, %d apex, %d tension, %d closing\n",
           f ? "mohr_coulomb" : "menetrey_willam", count[f][0], count[f][1], count[f][2], count[f][3], count[f][4],
           count[f][5]);
  printf("%d states: yield function off by %.1e c at most, least dissipation %.1e, %d not returned\n", n, worst, least,
         lost);
  assert_true(worst < 1e-10 && least >= -1e-12 && lost == 0 && fmin(count[0][5], count[1][5]) > 0.01 * n);
}

/* Mean stress within `near` to 0.1 of the apex's on either side, dilation softened to nearly nothing: a smooth
   potential is a needle there, and Newton from the trial state does not arrive (some 4 % of states with near 1e-6).
   Nearer to it round-off of the stresses decides when Newton is done. */
static void NearApex(double near, double far, double strained, int states, double tolerance)
{
  Rng    r     = {409};
  double worst = 0.0, back = 0.0; /* of plastic strain and work, per elastic strain and work of the apex */
  int    count = 0, lost = 0;

  for (int n = 0; n < states; n++) {
    const double  zero[3] = {0.0}, eps = RngBetween(&r, 0.0, strained), a = RngBetween(&r, 0.0, 2.0 * M_PI);
    Sample        q   = Point(6e8, 0.33, 1e6, 45.0, 15.0, zero);
    Plasticity   *law = &q.mat.plasticity;
    SkeletonState s;
    Strength      k;
    double        y[3], dy[3], dphi;

    law->flow  = FLOW_MENETREY_WILLAM;
    law->c_min = law->c_res = 1e5;
    law->phi_res            = 30.0;
    law->psi_min            = 5.0;
    law->eta_s              = 5.0;
    law->eccentricity       = 0.1;
    q.h.from.own[OWN_P_EPS] = eps;
    StrengthEvaluate(law, 0.0, eps, &k);
    const double apex = k.c / tan(k.phi), d = apex * RngLog(&r, 10.0 * near, far),
                 sm = apex * (1.0 + (n % 2 ? -1.0 : 1.0) * RngLog(&r, near, 0.1));
    q.h.sig[XX]     = sm + d * cos(a);
    q.h.sig[YY]     = sm + d * cos(a + 2.0 * M_PI / 3.0);
    q.h.sig[ZZ]     = sm + d * cos(a - 2.0 * M_PI / 3.0);
    if (!Go(&q, q.in, &s, NULL)) {
      lost++;
      continue;
    }
    if (s.region == RETURN_ELASTIC)
      continue;
    count++;
    StrengthEvaluate(law, 0.0, s.own[OWN_P_EPS], &k);
    Sorted(s.sig, y);
    worst = fmax(worst, fabs(MohrCoulombYield(k.phi, k.c, y, dy, &dphi)) / k.c);
    back  = fmax(back, fmax((eps - s.own[OWN_P_EPS]) * 6e8 / apex, -s.work * 6e8 / (apex * apex)));
  }
  printf("within %g of the apex: %d states, yield function off by %.1e c at most, flow back by %.1e, %d not returned\n",
         near, count, worst, back, lost);
  assert_true(count > 0.6 * states && worst < tolerance && back < tolerance && lost == 0);
}

static void TestNearApex(void **state)
{
  (void)state;
  NearApex(1e-6, 1.0, 2.5, 50000, 1e-10);
  NearApex(1e-12, 0.1, 5.0, 300000, 2e-7);
}

/* ---------------------------------------------------------------- tangent */
static bool Rows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  Sample       *q = ctx;
  double        in[SKELETON_IN];
  SkeletonState s;

  memcpy(in, q->in, sizeof(in));
  in[q->which] = x;
  if (!Go(q, in, &s, NULL))
    return false;
  memcpy(y, s.sig, sizeof(s.sig));
  const double open = q->h.from.own[OWN_P_OPENING], left = s.own[OWN_P_OPENING];

  y[6] = s.work;
  y[7] = s.region + 10 * (left == 0.0) + 20 * (left < open); /* tears closed, or closing */
  return true;
}

/* Largest step (halved from `step`) over which the region stays and what tears do, and on a face the order of the
   stresses: where two are equal the yield function has an edge, and the state a slope on either side of it. */
static double Room(Sample *q, double step, double stress, int region)
{
  double y[RIDDERS_ROWS] = {0.0}, p[3];

  if (!Rows(q, q->in[q->which], y))
    return 0.0;
  const int at = (int)y[7];
  Sorted(y, p);
  const double gap = region == RETURN_FACE ? fmin(p[0] - p[1], p[1] - p[2]) : INFINITY;
  for (; stress * step > 0.5 * gap && step > 0.0; step *= 0.5)
    continue;

  for (int k = 0; k < 12; k++, step *= 0.5) {
    bool same = true;

    for (int side = -4; side <= 4; side++)
      same = same && Rows(q, q->in[q->which] + 0.25 * side * step, y) && (int)y[7] == at;
    if (same)
      return step;
  }
  return 0.0;
}

static void TestTangent(void **state)
{
  Rng    r           = {403};
  double worst[2][6] = {{0.0}};
  int    tried[2][6] = {{0}};

  (void)state;
  for (int n = 0; n < 9000; n++) {
    Sample       q    = RandomSample(&r, n % 2, n % 4 == 3);
    const double size = q.mat.plasticity.c_max > 0.0 ? q.mat.plasticity.c_max
                                                     : 0.1 * fmax(fabs(q.h.sig[XX]), fabs(q.h.sig[YY])),
                 E    = q.in[SKELETON_E];
    SkeletonTangent t;
    SkeletonState   s;

    GiveNonlocal(&q, n);
    GiveTears(&q, n);
    if (!Go(&q, q.in, &s, &t) || (s.region == RETURN_FACE && RngPick(&r, 4)))
      continue;
    for (q.which = 0; q.which < SKELETON_IN; q.which++) {
      const bool   strain = q.which >= SKELETON_STRAIN && q.which <= SKELETON_THERMAL;
      const double full   = strain                  ? 0.02 * size / E
                            : q.which == SKELETON_E ? 0.01 * E
                                                    : 0.01,
                   step   = Room(&q, full,
                               strain                  ? E
                                 : q.which == SKELETON_E ? size / E
                                                         : size,
                                 s.region);
      double dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

      if (step < 1e-2 * full)
        continue;
      assert_true(Ridders(Rows, &q, q.in[q.which], step, SKELETON_OUT, dy, err));
      bool sharp = true;
      for (int i = 0; i < SKELETON_OUT; i++) {
        const double unit = (i < SKELETON_WORK ? size : size * size / E) / full;

        worst[n % 2][s.region] =
            fmax(worst[n % 2][s.region], fmax(0.0, fabs(dy[i] - t.d[i][q.which]) - 10.0 * err[i]) / unit);
        sharp = sharp && err[i] < 1e-4 * unit;
      }
      tried[n % 2][s.region] += sharp;
    }
  }
  for (int f = 0; f < 2; f++) {
    printf("tangent of %s against differences:", f ? "mohr_coulomb" : "menetrey_willam");
    for (int k = 0; k < 6; k++)
      printf(" %.1e (%d)", worst[f][k], tried[f][k]);
    printf("\n");
    for (int k = 0; k < 6; k++)
      assert_true(worst[f][k] < 1e-6);
  }
  assert_true(tried[0][RETURN_FACE] > 1000 && tried[0][RETURN_APEX] > 100 && tried[1][RETURN_EDGE] > 300 &&
              tried[1][RETURN_APEX] > 100 && tried[1][RETURN_TENSION] > 300 && tried[0][RETURN_CLOSING] > 100);
}

/* ---------------------------------------------------------------- tears */
/* Strained by e along its axes. */
static double MeanAfter(Sample *q, const double e[3], double *opening)
{
  SkeletonState s;

  for (int k = 0; k < 3; k++)
    q->in[SKELETON_STRAIN + k] = e[k];
  assert_true(Go(q, q->in, &s, NULL));
  memcpy(q->h.sig, s.sig, sizeof(s.sig));
  memcpy(q->h.from.own, s.own, sizeof(s.own));
  *opening = s.own[OWN_P_OPENING];
  return (s.sig[XX] + s.sig[YY] + s.sig[ZZ]) / 3.0;
}

/* A point pulled open and pushed together again: mean stress against volume has no memory of it, whatever the steps,
   and a hundred such cycles leave no volume. */
static void TestTears(void **state)
{
  const double E = 2e8, nu = 0.3, c = 2e4, K = E / (3.0 * (1.0 - 2.0 * nu)), zero[3] = {0.0}, far = 0.01;
  const double press[3] = {-0.1 * far, -0.1 * far, -0.1 * far};
  double       worst    = 0.0;

  (void)state;
  for (int flow = 0; flow < 2; flow++) {
    for (int steps = 1; steps <= 64; steps *= 4) {
      Sample q      = Point(E, nu, c, 30.0, 0.0, zero);
      double volume = 0.0, opening, pressed, none;

      q.mat.plasticity.flow = flow;
      const double apex     = c / tan(30.0 * DEG);
      for (int cycle = 0; cycle < 100; cycle++) {
        for (int k = 0; k < 2 * steps; k++) {
          const double e = (k < steps ? far : -far) / steps, all[3] = {e, e, e};

          volume += 3.0 * e;
          const double m    = MeanAfter(&q, all, &opening);
          const double open = 3.0 * far - apex / K; /* where it opened farthest */
          const double expected =
              k < steps ? fmin(K * volume, apex) : fmax(fmin(apex + K * (volume - 3.0 * far), apex), 0.0);

          if (k < steps ? volume > 3.0 * far - 1e-12 : volume < 1e-12)
            worst = fmax(worst, fabs(opening - (k < steps ? open : 0.0)) / far);
          if (cycle == 0)
            worst = fmax(worst, fabs(m - expected) / apex);
        }
      }
      pressed = MeanAfter(&q, press, &none);
      worst   = fmax(worst, fabs(pressed + 0.3 * K * far) / (K * far)); /* it bears once more, from where it began */
    }
  }
  printf("tears: off by %.1e of the apex or the opening\n", worst);
  assert_true(worst < 1e-9);
}

/* Mean stress after the strain e in `steps`, from a compression, and what is open then. */
static double MeanAfterSteps(const double e[3], int steps, double *opening)
{
  const double start[3] = {-1e5, -1e5, -1e5}, part[3] = {e[0] / steps, e[1] / steps, e[2] / steps};
  Sample       q    = Point(2e8, 0.3, 2e4, 30.0, 30.0, start);
  double       mean = 0.0;

  for (int n = 0; n < steps; n++)
    mean = MeanAfter(&q, part, opening);
  return mean;
}

/* Ground that dilates more than it is stretched is compressed on the whole path, though the trial state of a wide step
   may be a tension: nothing opens, and one step ends where many do. */
static void TestDilating(void **state)
{
  const double e[3] = {2.5e-3, -1e-3, 0.0};
  double       opening[2];

  (void)state;
  const double one = MeanAfterSteps(e, 1, &opening[0]), many = MeanAfterSteps(e, 256, &opening[1]);
  printf("stretched by less than it dilates: mean stress %.2f kPa in one step, %.2f in 256\n", 1e-3 * one, 1e-3 * many);
  assert_true(opening[0] == 0.0 && opening[1] == 0.0 && many < -5e4 && fabs(one / many - 1.0) < 1e-9);
}

/* ---------------------------------------------------------------- turned frames */
static void Turn4(double s[4], double angle)
{
  const double a[6] = {s[0], s[1], s[2], s[3], 0.0, 0.0};
  double       b[6];

  Turn6(a, cos(angle), sin(angle), b);
  memcpy(s, b, 4 * sizeof(double));
}

static void TestTurned(void **state)
{
  Rng    r     = {404};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 4000; n++) {
    Sample q = RandomSample(&r, n % 2, n % 4 == 3), w;

    GiveTears(&q, n);
    w                 = q;
    const double a    = RngBetween(&r, -3.0, 3.0),
                 unit = fmax(q.mat.plasticity.c_max, 0.03 * (fabs(q.h.sig[XX]) + fabs(q.h.sig[YY])));
    SkeletonState s, z, again;

    Turn4(w.h.sig, a);
    Turn4(w.h.sig0, a);
    Turn4(w.h.from.plastic, a);
    Turn4(w.h.from.strain, a);
    Turn4(w.h.from.sig, a);
    Turn4(w.h.from.own + OWN_P_BOND, a);
    Turn4(&w.in[SKELETON_STRAIN], a);
    assert_true(Go(&q, q.in, &s, NULL) && Go(&w, w.in, &z, NULL));
    const SkeletonStep d = StepOf(&w, w.in);
    SkeletonEndStage(&w.h, &d, &z, 1.0, &w.h.from); /* from where it ended it flows no more */
    w.in[SKELETON_KEPT] = 1.0;
    assert_true(Go(&w, w.in, &again, NULL));
    for (int i = 0; i < 4; i++)
      worst = fmax(worst, fabs(again.sig[i] - z.sig[i]) / unit);
    Turn4(z.sig, -a);
    Turn4(z.plastic, -a);
    Turn4(z.own + OWN_P_BOND, -a);
    for (int i = 0; i < 4; i++)
      worst = fmax(worst,
                   fmax(fabs(s.sig[i] - z.sig[i]) / unit, fabs(s.plastic[i] - z.plastic[i]) * q.in[SKELETON_E] / unit));
    worst = fmax(worst, fmax(fabs(s.own[OWN_P_EPS] - z.own[OWN_P_EPS]),
                             fabs(s.own[OWN_P_OPENING] - z.own[OWN_P_OPENING]) * q.in[SKELETON_E] / unit));
    for (int i = 0; i < 4; i++)
      worst = fmax(worst, fabs(s.own[OWN_P_BOND + i] - z.own[OWN_P_BOND + i]) / unit);
  }
  printf("turned frame: off by %.1e\n", worst);
  assert_true(worst < 1e-8);
}

/* ---------------------------------------------------------------- a drained biaxial path with softening */
/* Rate of stress of an elastic-plastic point (paper A.7) by differences of yield function and potential: no return. */
static double YieldOf(const Sample *q, double eps, const double y[3])
{
  Strength k;

  StrengthEvaluate(&q->mat.plasticity, q->in[SKELETON_SH], eps, &k);
  return ((y[0] - y[2]) + (y[0] + y[2]) * sin(k.phi)) / (2.0 * cos(k.phi)) - k.c;
}

static double FlowOf(const Sample *q, double eps, const double y[3])
{
  Strength k;

  StrengthEvaluate(&q->mat.plasticity, q->in[SKELETON_SH], eps, &k);
  return Potential(k.phi, k.psi, q->mat.plasticity.eccentricity * q->mat.plasticity.c_max, y);
}

static void Gradient(const Sample *q, double (*f)(const Sample *, double, const double *), double eps,
                     const double y[3], double g[3])
{
  const double d = 1e-5 * (fabs(y[0] - y[2]) + 1.0);

  for (int i = 0; i < 3; i++) {
    double hi[3] = {y[0], y[1], y[2]}, lo[3] = {y[0], y[1], y[2]};

    hi[i] += d;
    lo[i] -= d;
    g[i] = (f(q, eps, hi) - f(q, eps, lo)) / (2.0 * d);
  }
}

static void Hooke(const Sample *q, const double e[3], double s[3])
{
  const Elasticity *el = &q->mat.elasticity;
  const double      E = q->in[SKELETON_E], tr = E * ElasticityLameFactor(el) * (e[0] + e[1] + e[2]);

  for (int i = 0; i < 3; i++)
    s[i] = 2.0 * E * ElasticityShearFactor(el) * e[i] + tr;
}

/* d(stress) for lateral strain x, axial a, none out of the plane; stress sorted lateral, middle, axial. */
static double Rate(const Sample *q, double eps, const double y[3], const double de[3], double dy[3])
{
  double F[3], P[3], DP[3], De[3], up = 0.0, down = 0.0, n2 = 0.0;

  Hooke(q, de, dy);
  if (YieldOf(q, eps, y) < 0.0)
    return 0.0;
  Gradient(q, YieldOf, eps, y, F);
  Gradient(q, FlowOf, eps, y, P);
  Hooke(q, P, DP);
  Hooke(q, de, De);
  const double mean = (P[0] + P[1] + P[2]) / 3.0;
  for (int i = 0; i < 3; i++) {
    up += F[i] * De[i];
    down += F[i] * DP[i];
    n2 += (P[i] - mean) * (P[i] - mean);
  }
  const double n = sqrt(2.0 / 3.0 * n2), F_eps = (YieldOf(q, eps + 1e-6, y) - YieldOf(q, eps - 1e-6, y)) / 2e-6;
  const double L = fmax(0.0, up / (down - F_eps * n));
  for (int i = 0; i < 3; i++)
    dy[i] -= L * DP[i];
  return L * n;
}

/* The lateral strain that keeps the lateral stress for an axial one; forward Euler in tiny steps. */
static void Integrate(const Sample *q, double to, int steps, double y[3], double *eps)
{
  const double da = to / steps;
  double       x  = -0.4 * da;

  for (int k = 0; k < steps; k++) {
    double a[3], b[3], dy[3];

    for (int it = 0; it < 3; it++) {
      Rate(q, *eps, y, (const double[3]){x, 0.0, da}, a);
      Rate(q, *eps, y, (const double[3]){1.001 * x, 0.0, da}, b);
      x *= 1.0 + 1e-3 * a[0] / (a[0] - b[0]);
    }
    *eps += Rate(q, *eps, y, (const double[3]){x, 0.0, da}, dy);
    for (int i = 0; i < 3; i++)
      y[i] += dy[i];
  }
}

/* The law itself along the same path, lateral strain by secant. */
static void FollowPath(Sample *q, double to, int steps)
{
  const double side = q->h.sig[XX], da = to / steps;
  double       x[2] = {-0.3 * da, -0.6 * da}, f[2];

  for (int k = 0; k < steps; k++) {
    SkeletonState s;

    q->in[SKELETON_STRAIN + 1] = da;
    for (int it = 0; it < 60; it++) {
      q->in[SKELETON_STRAIN] = x[1];
      assert_true(Go(q, q->in, &s, NULL));
      f[1] = s.sig[XX] - side;
      if (it > 0 && (fabs(f[1]) < 1e-9 * fabs(side) || f[1] == f[0]))
        break;
      const double next = it ? x[1] - f[1] * (x[1] - x[0]) / (f[1] - f[0]) : x[1] * 1.01;
      x[0]              = x[1];
      f[0]              = f[1];
      x[1]              = next;
    }
    assert_true(fabs(s.sig[XX] - side) < 1e-6 * fabs(side));
    memcpy(q->h.sig, s.sig, sizeof(s.sig));
    q->h.from.own[OWN_P_EPS] = s.own[OWN_P_EPS];
    x[0]                     = 0.99 * x[1];
  }
}

static void TestBiaxialPath(void **state)
{
  double worst[2] = {0.0}, law = 0.0;

  (void)state;
  for (int stage = 0; stage < 3; stage++) {
    const double to      = stage == 0 ? -0.01 : stage == 1 ? -0.05 : -0.15; /* before, about and after the peak */
    const double side[3] = {-1e6, -1e6, -1e6};
    Sample       q       = Point(6e8, 0.33, 1e6, 45.0, 15.0, side);
    Plasticity  *k       = &q.mat.plasticity;
    double       y[3] = {-1e6, -1e6, -1e6 * (1.0 + 1e-6)}, eps = 0.0;

    k->flow         = FLOW_MENETREY_WILLAM;
    k->eccentricity = 0.1;
    k->c_min = k->c_res = 1e5;
    k->phi_res          = 30.0;
    k->psi_min          = 5.0;
    k->eta_s = k->eta_h = 5.0;
    k->Sh_max           = 0.443;
    q.in[SKELETON_SH]   = 0.4;
    for (int i = 0; i < 3; i++)
      q.h.sig0[i] = 0.0;
    Integrate(&q, to, 100000, y, &eps);
    Sample c = q;
    FollowPath(&q, to, 400);
    FollowPath(&c, to, 800);
    for (int i = 0; i < 2; i++) { /* extrapolated to no step: both are of first order */
      const double axial = 2.0 * c.h.sig[YY] - q.h.sig[YY], e = 2.0 * c.h.from.own[OWN_P_EPS] - q.h.from.own[OWN_P_EPS];

      worst[i] = fmax(worst[i], i ? fabs(e - eps) : fabs(axial / y[2] - 1.0));
    }
    Strength at;
    StrengthEvaluate(k, 0.4, c.h.from.own[OWN_P_EPS], &at);
    const double si = sin(at.phi), exact = (c.h.sig[XX] * (1.0 + si) - 2.0 * at.c * cos(at.phi)) / (1.0 - si);
    printf("biaxial, %.0f %%: axial %.4f MPa, eps %.5f (differences %.4f, %.5f)\n", -100.0 * to, c.h.sig[YY] * 1e-6,
           c.h.from.own[OWN_P_EPS], y[2] * 1e-6, eps);
    if (c.h.from.own[OWN_P_EPS] > 0.0)
      law = fmax(law, fabs(c.h.sig[YY] / exact - 1.0));
  }
  printf("  off by %.1e (stress), %.1e (plastic strain); law of the peak %.1e\n", worst[0], worst[1], law);
  assert_true(worst[0] < 2e-4 && worst[1] < 2e-5 && law < 1e-12);
}

/* ---------------------------------------------------------------- softening_length */
/* Work per area that a band one cell wide dissipates in shear beyond what its residual strength takes, J/m^2; the band
   slides 0.1 m. */
static double BandWork(double cell, double length)
{
  const double zero[3] = {0.0};
  Sample       q       = Point(1e8, 0.3, 1e5, 0.0, 0.0, zero);
  double       work    = 0.0;

  q.mat.plasticity.c_res  = 2e4;
  q.mat.plasticity.c_min  = 2e4;
  q.mat.plasticity.Sh_max = 0.0;
  q.mat.plasticity.eta_s  = 10.0;
  q.mat.plasticity.length = length;
  q.mat.plasticity.cell   = cell;
  for (int k = 0; k < 4000; k++) {
    const double  slip = 0.1 / cell / 4000.0; /* shear strain gamma of the step */
    SkeletonState s;

    q.in[SKELETON_STRAIN + 3] = 0.5 * slip;
    assert_true(Go(&q, q.in, &s, NULL));
    work += cell * (s.work - (s.own[OWN_P_EPS] > q.h.from.own[OWN_P_EPS] ? 2e4 * slip : 0.0));
    memcpy(q.h.sig, s.sig, sizeof(s.sig));
    q.h.from.own[OWN_P_EPS] = s.own[OWN_P_EPS];
  }
  return work;
}

static void TestSofteningLength(void **state)
{
  const double coarse = BandWork(0.02, 0.01), fine = BandWork(0.01, 0.01), finer = BandWork(0.005, 0.01);
  const double plain[2] = {BandWork(0.01, 0.0), BandWork(0.005, 0.0)};

  (void)state;
  printf("softening of a band: %.4g, %.4g, %.4g J/m^2 on cells of 20, 10, 5 mm with a length of 10 mm; without %.4g, "
         "%.4g\n",
         coarse, fine, finer, plain[0], plain[1]);
  assert_true(fabs(coarse / fine - 1.0) < 0.02 && fabs(finer / fine - 1.0) < 0.02);
  assert_true(fabs(plain[0] / fine - 1.0) < 1e-12 && fabs(plain[1] / plain[0] - 0.5) < 0.05);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestPotential), cmocka_unit_test(TestKnownPoints),    cmocka_unit_test(TestYieldSurface),
      cmocka_unit_test(TestTangent),   cmocka_unit_test(TestTears),          cmocka_unit_test(TestDilating),
      cmocka_unit_test(TestTurned),    cmocka_unit_test(TestBiaxialPath),    cmocka_unit_test(TestSofteningLength),
      cmocka_unit_test(TestNearApex),  cmocka_unit_test(TestStrengthFactor), cmocka_unit_test(TestDepth)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
