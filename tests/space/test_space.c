/* Space: how a particle is strained and turned, and the skeleton's laws on any axes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/kinematics.h"
#include "clathra/particles.h"
#include "clathra/point_strain.h"
#include "clathra/skeleton.h"
#include "random.h"

/* A rotation, uniform enough, from a quaternion. */
static Rotation RandomRotation(Rng *r)
{
  double q[4], n = 0.0;

  for (int k = 0; k < 4; k++) {
    q[k] = RngBetween(r, -1.0, 1.0);
    n += q[k] * q[k];
  }
  for (int k = 0; k < 4; k++)
    q[k] /= sqrt(n);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  return (Rotation){{{1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)},
                     {2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)},
                     {2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)}}};
}

/* By an angle about axis z, x or y (spin 0, 1, 2). */
static Rotation About(int spin, double angle)
{
  const int a = spin, b = (spin + 1) % 3, n = (spin + 2) % 3;
  Rotation  R = {{{0.0}}};

  R.R[a][a] = R.R[b][b] = cos(angle);
  R.R[b][a]             = sin(angle);
  R.R[a][b]             = -sin(angle);
  R.R[n][n]             = 1.0;
  return R;
}

static Rotation Product(Rotation A, Rotation B)
{
  Rotation C = {{{0.0}}};

  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      for (int k = 0; k < 3; k++)
        C.R[i][j] += A.R[i][k] * B.R[k][j];
    }
  }
  return C;
}

/* ---------------------------------------------------------------- kinematics */
/* F = V R with V = Q exp(diag s) Q^T: grad u, the rotation and ln V. */
static void Make(const double s[3], Rotation Q, Rotation R, double g[MOTION_COUNT], double e[6])
{
  double V[6], stretch[6] = {exp(s[0]), exp(s[1]), exp(s[2])}, strain[6] = {s[0], s[1], s[2]};

  Rotate6(stretch, Q, V);
  Rotate6(strain, Q, e);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      g[VectorAt(0, i, j)] = i == j ? -1.0 : 0.0;
      for (int k = 0; k < 3; k++)
        g[VectorAt(0, i, j)] += V[voigt[i][k]] * R.R[k][j];
    }
  }
  g[MOTION_HOOP] = 0.0;
}

/* Of any stretch, also where two or three of them are one, and any rotation. */
static void TestValues(void **state)
{
  Rng    r     = {501};
  double worst = 0.0, turned = 0.0, volume = 0.0;

  (void)state;
  for (int n = 0; n < 20000; n++) {
    const double   size = RngLog(&r, 1e-8, 0.7);
    const Rotation Q = RandomRotation(&r), R = RandomRotation(&r);
    double         s[3] = {0.0}, g[MOTION_COUNT], e[6];
    Kinematics     k;

    for (int i = 0; i < 3; i++)
      s[i] = i > 0 && n % 3 >= i ? s[0] : size * RngBetween(&r, -1.0, 1.0);
    Make(s, Q, R, g, e);
    assert_true(KinematicsEvaluate(g, &k));
    for (int i = 0; i < 6; i++)
      worst = fmax(worst, fabs(k.e[i] - e[i]));
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) {
        double sum = 0.0;

        turned = fmax(turned, fabs(k.turn.R[i][j] - R.R[i][j]));
        for (int d = 0; d < 3; d++)
          sum += k.F[d][i] * k.cof[d][j];
        volume = fmax(volume, fabs(sum - (i == j ? k.J : 0.0)));
      }
    }
    volume = fmax(volume, fabs(k.J - exp(s[0] + s[1] + s[2])));
  }
  printf("kinematics in space: ln V off by %.1e, R by %.1e, J and cof F by %.1e\n", worst, turned, volume);
  assert_true(worst < 2e-14 && turned < 2e-14 && volume < 5e-14);
}

/* Series of small strains, any rotation: the numbers of eigenvectors. */
static void TestSmall(void **state)
{
  Rng    r     = {502};
  double worst = 0.0, turned = 0.0;

  (void)state;
  for (int n = 0; n < 20000; n++) {
    const Rotation Q = RandomRotation(&r), R = n % 2 ? RandomRotation(&r) : About(n % 3, RngBetween(&r, -0.1, 0.1));
    const double   size = RngLog(&r, 1e-8, 0.1);
    double         s[3], g[MOTION_COUNT], H[3][3], e[6], small[6], turn[3][3];

    for (int i = 0; i < 3; i++)
      s[i] = i > 0 && n % 3 >= i ? s[0] : size * RngBetween(&r, -1.0, 1.0);
    Make(s, Q, R, g, e);
    memcpy(H, g, sizeof(H));
    SmallStretch(H, small, turn);
    for (int i = 0; i < 6; i++)
      worst = fmax(worst, fabs(small[i] - e[i]));
    for (int i = 0; i < 9; i++)
      turned = fmax(turned, fabs(turn[i / 3][i % 3] - R.R[i / 3][i % 3]));
  }
  printf("series of small strains in space: ln V off by %.1e, R by %.1e\n", worst, turned);
  assert_true(worst < 5e-15 && turned < 5e-15); /* without optimisation 2.0e-15 */
}

/* The numbers of a plane motion are the plane's. */
static void TestPlane(void **state)
{
  Rng    r     = {502};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 2000; n++) {
    const double a = RngBetween(&r, -0.3, 0.3), b = RngBetween(&r, -0.3, 0.3), c = RngBetween(&r, -0.3, 0.3),
                 d = RngBetween(&r, -0.3, 0.3), along = 2.0 + a + d, turn = c - b, n2 = hypot(along, turn);
    const double g[MOTION_COUNT] = {a, b, 0.0, c, d, 0.0, 0.0, 0.0, 0.0};
    Kinematics   k;

    assert_true(KinematicsEvaluate(g, &k));
    worst = fmax(worst, fmax(fabs(k.turn.R[0][0] - along / n2), fabs(k.turn.R[1][0] - turn / n2)));
    worst = fmax(worst, fmax(fabs(k.dtheta[0][VectorAt(0, 0, 0)] + turn / (n2 * n2)),
                             fabs(k.dtheta[0][VectorAt(0, 1, 0)] - along / (n2 * n2))));
    worst = fmax(worst, fmax(fabs(k.e[ZZ]), fmax(fabs(k.e[YZ]), fabs(k.e[XZ]))));
  }
  printf("kinematics in space: plane motions off by %.1e\n", worst);
  assert_true(worst < 1e-14);
}

typedef struct {
  double   g[MOTION_COUNT];
  int      which;
  Rotation at; /* of the state about which the spins are taken */
} Motion;

enum { ROW_E = 0, ROW_SPIN = 6, ROW_J = 9, ROW_COF, ROWS = ROW_COF + 9 };

static bool MotionRows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  const Motion *q = ctx;
  double        g[MOTION_COUNT];
  Kinematics    k;

  memcpy(g, q->g, sizeof(g));
  g[q->which] = x;
  if (!KinematicsEvaluate(g, &k))
    return false;
  const Rotation W = Product(k.turn, RotationBack(q->at)); /* 1 + the spin's matrix to first order */

  memcpy(y + ROW_E, k.e, sizeof(k.e));
  for (int s = 0; s < 3; s++)
    y[ROW_SPIN + s] = 0.5 * (W.R[(s + 1) % 3][s] - W.R[s][(s + 1) % 3]);
  y[ROW_J] = k.J;
  for (int i = 0; i < 9; i++)
    y[ROW_COF + i] = k.cof[i / 3][i % 3];
  return true;
}

static void TestSlopes(void **state)
{
  Rng    r     = {503};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 1000; n++) {
    const double size = RngLog(&r, 1e-6, 0.4);
    double       s[3] = {0.0}, e[6];
    Motion       q;
    Kinematics   k;

    for (int i = 0; i < 3; i++)
      s[i] = i > 0 && n % 3 >= i ? s[0] : size * RngBetween(&r, -1.0, 1.0);
    Make(s, RandomRotation(&r), RandomRotation(&r), q.g, e);
    assert_true(KinematicsEvaluate(q.g, &k));
    q.at = k.turn;
    for (q.which = 0; q.which < MOTION_HOOP; q.which++) {
      double dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

      assert_true(Ridders(MotionRows, &q, q.g[q.which], 0.02, ROWS, dy, err));
      for (int i = 0; i < 6; i++)
        worst = fmax(worst, fabs(dy[ROW_E + i] - k.de[i][q.which]));
      for (int i = 0; i < 3; i++)
        worst = fmax(worst, fabs(dy[ROW_SPIN + i] - k.dtheta[i][q.which]));
      worst = fmax(worst, fabs(dy[ROW_J] - k.dJ[q.which]));
      for (int i = 0; i < 9; i++)
        worst = fmax(worst, fabs(dy[ROW_COF + i] - k.dcof[i / 3][i % 3][q.which]));
    }
  }
  printf("kinematics in space: slopes of ln V, spins, J, cof F against differences: %.1e\n", worst);
  assert_true(worst < 1e-9);
}

/* ---------------------------------------------------------------- the skeleton */
typedef struct {
  Material        mat;
  SkeletonHistory h;
  SkeletonStep    d;
  int             which;
} Sample;

enum { ELASTIC = 0, BONDED, SMOOTH, PLANES, TORN, LAWS };
static const char *const law_name[LAWS] = {"elastic", "bonds", "menetrey_willam", "mohr_coulomb", "tears"};

static void RandomTensor(Rng *r, double size, double a[6])
{
  for (int k = 0; k < 6; k++)
    a[k] = size * RngBetween(r, -1.0, 1.0);
}

static Sample RandomSample(Rng *r, int law)
{
  Sample q = {.mat.elasticity = {9e7, 2e9, 1.0, 1.0, RngBetween(r, 0.0, 0.45), RngPick(r, 2)}};

  if (law == BONDED)
    q.mat.elasticity.change = STIFFNESS_BONDS;
  if (law >= SMOOTH)
    q.mat.plasticity = (Plasticity){.type     = PLASTICITY_MOHR_COULOMB,
                                    .flow     = law == SMOOTH ? FLOW_MENETREY_WILLAM : FLOW_MOHR_COULOMB,
                                    .c_max    = 2e6,
                                    .c_min    = 1.2e6,
                                    .c_res    = 1e6,
                                    .phi_peak = 30.0,
                                    .phi_res  = 10.0,
                                    .psi_max  = 10.0,
                                    .psi_min  = 5.0,
                                    .eta_h    = 5.0,
                                    .eta_s    = 5.0,
                                    .Sh_max   = 0.5,
                                    .cutoff   = law == SMOOTH ? INFINITY : 0.0,
                                    .factor   = 1.0};
  q.d     = (SkeletonStep){.turn    = RandomRotation(r),
                           .thermal = RngBetween(r, -1e-3, 1e-3),
                           .E       = RngLog(r, 2e8, 1e9),
                           .Sh      = RngBetween(r, 0.0, 0.5),
                           .kept    = RngBetween(r, 0.3, 1.0)};
  q.d.E_n = q.d.E * RngBetween(r, 0.8, 1.2);
  RandomTensor(r, law >= SMOOTH ? 3e6 / q.d.E : 0.01, q.d.e);
  RandomTensor(r, 5e6, q.h.sig);
  RandomTensor(r, 2e6, q.h.sig0);
  if (law >= SMOOTH)
    q.h.sig[XX] -= 2e6, q.h.sig[YY] -= 2e6, q.h.sig[ZZ] -= 2e6;
  RandomTensor(r, 1e-3, q.h.from.strain);
  RandomTensor(r, law >= SMOOTH ? 1e-4 : 0.0, q.h.from.plastic);
  memcpy(q.h.from.sig, q.h.sig, sizeof(q.h.from.sig));
  RandomTensor(r, law == BONDED ? 5e6 : 0.0, q.h.from.own + OWN_P_BOND);
  q.h.from.own[OWN_P_EPS]     = law >= SMOOTH ? RngBetween(r, 0.0, 0.1) : 0.0;
  q.h.from.own[OWN_P_OPENING] = law == TORN ? RngBetween(r, 0.0, 5e-3) : 0.0;
  return q;
}

static bool Go(const Sample *q, SkeletonState *s, SkeletonTangent *t)
{
  const char *why;

  return SkeletonUpdate(&q->mat, &q->h, &q->d, s, t, &why);
}

/* The step with number `which` of the tangent moved by x. */
static SkeletonStep Moved(const SkeletonStep *d, int which, double x)
{
  SkeletonStep to = *d;

  if (which < SKELETON_STRAIN)
    to.turn = Product(About(which - SKELETON_THETA, x), d->turn);
  else if (which < SKELETON_THERMAL)
    to.e[which - SKELETON_STRAIN] += x;
  else
    *(which == SKELETON_THERMAL ? &to.thermal
      : which == SKELETON_E     ? &to.E
      : which == SKELETON_SH    ? &to.Sh
                                : &to.kept) += x;
  return to;
}

enum { AT_WORK = 6, AT_REGION, SKELETON_ROWS };

static bool SkeletonRows(void *ctx, double x, double y[RIDDERS_ROWS])
{
  const Sample *q = ctx;
  Sample        p = *q;
  SkeletonState s;

  p.d = Moved(&q->d, q->which, x);
  if (!Go(&p, &s, NULL))
    return false;
  memcpy(y, s.sig, sizeof(s.sig));
  y[AT_WORK]   = s.work;
  y[AT_REGION] = s.region + 10.0 * (s.own[OWN_P_OPENING] == 0.0);
  return true;
}

/* Largest step over which the state stays on the same part of the yield surface. */
static double Room(Sample *q, double step)
{
  double y[RIDDERS_ROWS], at;

  if (!SkeletonRows(q, 0.0, y))
    return 0.0;
  at = y[AT_REGION];
  for (int k = 0; k < 12; k++, step *= 0.5) {
    bool same = true;

    for (int side = -4; side <= 4; side++)
      same = same && SkeletonRows(q, 0.25 * side * step, y) && y[AT_REGION] == at;
    if (same)
      return step;
  }
  return 0.0;
}

static void TestTangents(void **state)
{
  (void)state;
  for (int law = 0; law < LAWS; law++) {
    Rng    r     = {510 + (uint64_t)law};
    double worst = 0.0;
    int    tried = 0, flows = 0;

    for (int n = 0; n < 500; n++) {
      Sample          q = RandomSample(&r, law);
      SkeletonTangent t;
      SkeletonState   s;

      if (!Go(&q, &s, &t))
        continue;
      flows += s.region != RETURN_ELASTIC;
      for (q.which = 0; q.which < SKELETON_IN; q.which++) {
        const double size = 2e6,
                     full = q.which < SKELETON_STRAIN ? 0.01
                            : q.which < SKELETON_E    ? 0.02 * size / q.d.E
                            : q.which == SKELETON_E   ? 0.01 * q.d.E
                                                      : 0.01,
                     step = Room(&q, full);
        double dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

        if (step < 1e-2 * full || !Ridders(SkeletonRows, &q, 0.0, step, AT_REGION, dy, err))
          continue;
        tried++;
        for (int i = 0; i < SKELETON_OUT; i++) {
          const double unit = (i < SKELETON_WORK ? size : size * size / q.d.E) / full;

          worst = fmax(worst, fmax(0.0, fabs(dy[i] - t.d[i][q.which]) - 10.0 * err[i]) / unit);
        }
      }
    }
    printf("tangent in space of %s against differences: %.1e (%d; %d states flow)\n", law_name[law], worst, tried,
           flows);
    assert_true(worst < 1e-6 && tried > 3000 && (law < SMOOTH || flows > 100));
  }
}

/* The same on turned axes. */
static void TurnSample(Sample *q, Rotation Q)
{
  double *tensor[] = {
      q->h.sig, q->h.sig0, q->h.from.strain, q->h.from.plastic, q->h.from.sig, q->h.from.own + OWN_P_BOND, q->d.e};

  for (size_t i = 0; i < sizeof(tensor) / sizeof(*tensor); i++) {
    double a[6];

    Rotate6(tensor[i], Q, a);
    memcpy(tensor[i], a, sizeof(a));
  }
  q->d.turn = Product(Product(Q, q->d.turn), RotationBack(Q));
}

static void TestTurned(void **state)
{
  (void)state;
  for (int law = 0; law < LAWS; law++) {
    Rng    r     = {520 + (uint64_t)law};
    double worst = 0.0;
    int    count = 0;

    for (int n = 0; n < 2000; n++) {
      const Sample   q = RandomSample(&r, law);
      const Rotation Q = RandomRotation(&r);
      Sample         w = q;
      SkeletonState  s, z;
      double         back[6], bond[6];

      TurnSample(&w, Q);
      if (!Go(&q, &s, NULL))
        continue;
      assert_true(Go(&w, &z, NULL));
      Rotate6(z.sig, RotationBack(Q), back);
      Rotate6(z.own + OWN_P_BOND, RotationBack(Q), bond);
      for (int k = 0; k < 6; k++)
        worst = fmax(worst, (fabs(back[k] - s.sig[k]) + fabs(bond[k] - s.own[OWN_P_BOND + k])) / 5e6);
      worst = fmax(worst, fabs(z.own[OWN_P_EPS] - s.own[OWN_P_EPS]));
      count++;
    }
    printf("%s on turned axes in space: %.1e (%d)\n", law_name[law], worst, count);
    assert_true(worst < 1e-9 && count > 1500);
  }
}

enum { BLOCK = 32, HISTORY = 13 + OWN_COUNT }; /* sig, sig0, yield, then a law's own */

/* Blocks of particles, of any length, give what single ones do. */
static void TestBlocks(void **state)
{
  (void)state;
  for (int law = 0; law < LAWS; law++) {
    Rng    r     = {530 + (uint64_t)law};
    double worst = 0.0;
    int    count = 0, flows = 0;

    for (int n = 0; n < 200; n++) {
      Sample        q[BLOCK];
      double        in[CL_TURN + CL_TENSOR + 5][BLOCK], held[HISTORY][BLOCK], work[BLOCK];
      const char   *why;
      SkeletonBlock b = {.n = 1 + RngPick(&r, BLOCK), .work = work, .store.yield = held[12]};

      for (int k = 0; k < BLOCK; k++) {
        q[k]     = RandomSample(&r, law);
        q[k].mat = q[0].mat;
        memset(q[k].h.from.strain, 0, sizeof(q[k].h.from.strain));
        memset(q[k].h.from.plastic, 0, sizeof(q[k].h.from.plastic));
        q[k].h.from.own[OWN_P_EPS] *= k % 2; /* strength of the peak, or less */
        for (int i = 0; i < CL_TURN; i++)
          in[i][k] = q[k].d.turn.R[i / 3][i % 3];
        for (int i = 0; i < CL_TENSOR; i++)
          in[CL_TURN + i][k] = q[k].d.e[i];
        const double rest[] = {q[k].d.thermal, q[k].d.E_n, q[k].d.E, q[k].d.Sh, q[k].d.kept};
        for (int i = 0; i < 5; i++)
          in[CL_TURN + CL_TENSOR + i][k] = rest[i];
        for (int i = 0; i < 6; i++) {
          held[i][k]     = q[k].h.sig[i];
          held[6 + i][k] = q[k].h.sig0[i];
        }
        for (int i = 0; i < OWN_COUNT; i++)
          held[13 + i][k] = q[k].h.from.own[i];
      }
      for (int i = 0; i < CL_TURN; i++)
        b.turn[i] = in[i];
      for (int i = 0; i < CL_TENSOR; i++)
        b.e[i] = in[CL_TURN + i];
      const double **const rest[] = {&b.thermal, &b.E_n, &b.E, &b.Sh, &b.kept};
      for (int i = 0; i < 5; i++)
        *rest[i] = in[CL_TURN + CL_TENSOR + i];
      for (int i = 0; i < 6; i++) {
        b.store.sig[i]  = held[i];
        b.store.sig0[i] = held[6 + i];
      }
      for (int i = 0; i < OWN_COUNT; i++)
        b.store.own[i] = held[13 + i];
      SkeletonUpdateBlock(&q[0].mat, &b, &why);
      for (int k = 0; k < BLOCK; k++) {
        SkeletonState s;
        const bool    found = Go(&q[k], &s, NULL);

        if (k < b.n && (!found || isnan(work[k]))) {
          assert_true(!found && isnan(work[k]));
          continue;
        }
        for (int i = 0; i < 6; i++) { /* beyond n nothing is touched */
          worst = fmax(worst, fabs(held[i][k] - (k < b.n ? s.sig[i] : q[k].h.sig[i])) / 5e6);
          worst = fmax(worst, fabs(held[6 + i][k] - (k < b.n ? s.sig0[i] : q[k].h.sig0[i])) / 5e6);
        }
        for (int i = 0; i < OWN_COUNT; i++)
          worst = fmax(worst, fabs(held[13 + i][k] - (k < b.n ? s.own[i] : q[k].h.from.own[i])) /
                                  (i >= OWN_P_BOND && i < OWN_P_BOND + CL_TENSOR ? 5e6 : 1.0));
        if (k < b.n && law >= SMOOTH) {
          worst = fmax(worst, fabs(work[k] - s.work) / 1e5);
          assert_int_equal((int)held[12][k], (int)s.region);
          flows += s.region != RETURN_ELASTIC;
        }
        count += k < b.n;
      }
    }
    printf("blocks in space of %s: %.1e (%d; %d flow)\n", law_name[law], worst, count, flows);
    assert_true(worst < 1e-12 && count > 2000 && (law < SMOOTH || flows > 500));
  }
}

/* (446): c x y z of the start, after a motion F: its derivative by all axes as a function of x' = F x. */
static void TestMixedCarry(void **state)
{
  Rng r = {77};

  (void)state;
  for (int n = 0; n < 20; n++) {
    double F[3][3], A[3][3], B[CL_MIXED] = {0.0}, there = 0.0;

    for (int k = 0; k < 9; k++)
      F[k / 3][k % 3] = (k / 3 == k % 3) + RngBetween(&r, -0.4, 0.4);
    const double J = CofactorOf(F, A), c = RngBetween(&r, -5.0, 5.0);

    for (int k = 0; k < 9; k++)
      A[k / 3][k % 3] /= J;
    B[CL_PAIRS] = c;
    MixedCarry(A, B);
    for (int corner = 0; corner < 8; corner++) { /* of a cube in x': what is odd in each of the three is left */
      double at[3], sign = 0.125, xyz = c;

      for (int d = 0; d < 3; d++) {
        at[d] = corner >> d & 1 ? 1.0 : -1.0;
        sign *= at[d];
      }
      for (int d = 0; d < 3; d++)
        xyz *= A[0][d] * at[0] + A[1][d] * at[1] + A[2][d] * at[2];
      there += sign * xyz;
    }
    assert_true(fabs(B[CL_PAIRS] - there) < 1e-12 * fabs(there));
    for (int k = 0; k < CL_PAIRS; k++)
      assert_true(B[k] == 0.0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestValues),   cmocka_unit_test(TestPlane),      cmocka_unit_test(TestSlopes),
      cmocka_unit_test(TestTangents), cmocka_unit_test(TestTurned),     cmocka_unit_test(TestSmall),
      cmocka_unit_test(TestBlocks),   cmocka_unit_test(TestMixedCarry),
  };

  return cmocka_run_group_tests(tests, NULL, NULL);
}
