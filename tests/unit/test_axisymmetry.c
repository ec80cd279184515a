/* Tests of the geometry about an axis: radial weights, kinematics with the hoop strain, the exact Jacobian, states that
   must be in equilibrium. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/tensor.h"
#include "small_scene.h"

/* ---------------------------------------------------------------- radial weights */
/* Sums of weights and gradients, a linear field, the hoop strain of u_r = r, the ring's mean of r. */
typedef struct {
  double sum, zero, slope, hoop, centroid, mean;
} RadialError;

static void RadialErrors(BasisType basis, double x, double l, double lower, double h, PetscInt cells, RadialError *e)
{
  Axis   a;
  double H[3], r, S = 0.0, G = 0.0, Gr = 0.0, Hr = 0.0, mean = 0.0, first = 0.0;

  const GridLines line = LinesEqual(lower, lower + (double)cells * h, cells);

  BasisRadius(basis, x, l, &line, &a, H, &r);
  const double half = BasisReach(basis, &line, x, l);
  const double lo = fmax(x - half, lower), hi = fmin(x + half, lower + (double)cells * h), mid = 0.5 * (lo + hi);
  for (int k = 0; k < 3; k++) {
    const double rk = lower + (double)(a.base + k) * h;

    S += a.S[k];
    G += a.dS[k];
    Gr += a.dS[k] * rk;
    Hr += H[k] * rk;
    mean += H[k] * r * rk;
    first += a.S[k] * rk;
    Check(H[k] >= 0.0 && a.S[k] > -1e-14);
  }
  e->sum   = fmax(e->sum, fabs(S - 1.0) * l / h); /* they are differences over 2 l/h */
  e->zero  = fmax(e->zero, fabs(G) * l);
  e->slope = fmax(e->slope, fabs(Gr - 1.0) * l / h);
  e->hoop  = fmax(e->hoop, fabs(Hr - 1.0));
  e->mean  = fmax(e->mean, fabs(mean / (basis == BASIS_LINEAR ? x : mid) - 1.0));
  /* int r^2 dr / int r dr */
  const double ring = basis == BASIS_LINEAR ? x : 2.0 / 3.0 * (hi * hi + hi * lo + lo * lo) / (hi + lo);
  e->centroid       = fmax(e->centroid, fmax(fabs(first - ring), fabs(AxisCentroid(&a, &line) - first)) / h);
}

static void TestRadialWeights(void **state)
{
  static const double lower[3] = {0.0, 0.7, 5e3};
  const double        h        = 0.13;

  (void)state;
  for (int basis = 0; basis < 3; basis++) {
    for (int k = 0; k < 3; k++) {
      const double far = k == 2 ? lower[k] / h : 1.0; /* round-off of r in cells */
      RadialError  e   = {0};
      Rng          rng = {77 + (uint64_t)k};

      for (int n = 0; n < 3000; n++) {
        const double l = h * RngBetween(&rng, 0.02, 0.5);

        RadialErrors((BasisType)basis, lower[k] + fmax(8.0 * h * RngUnit(&rng), l), l, lower[k], h, 9, &e);
      }
      for (int n = 1; n <= 4; n++) { /* first particle of a regular filling: from the axis or the grid's side */
        const double l = 0.5 * h / n;

        RadialErrors((BasisType)basis, lower[k] + l, l, lower[k], h, 9, &e);
      }
      if (basis != BASIS_LINEAR) /* over the grid's left side: clipped */
        RadialErrors((BasisType)basis, lower[k] + 0.2 * h, 0.3 * h, lower[k], h, 9, &e);
      Say("%-6s from r = %-5g sum %.0e, gradients' sum %.0e, slope of r %.0e, hoop strain of u_r = r %.0e, "
          "mean r %.0e, centroid %.0e\n",
          basis_name[basis], lower[k], e.sum, e.zero, e.slope, e.hoop, e.mean, e.centroid);
      Check(e.sum < 1e-14 * far && e.zero < 1e-14 * far && e.slope < 1e-14 * far * far && e.hoop < 1e-14 * far &&
            e.mean < 1e-14 * far && e.centroid < 1e-13 * far * far);
    }
  }
}

/* Weights against quadrature of N r, N' r and N, panel by panel between the grid lines. */
static void TestRadialQuadrature(void **state)
{
  const double    h     = 0.2;
  const GridLines line  = LinesEqual(0.0, 6.0 * h, 6);
  double          worst = 0.0;
  Rng             rng   = {5};

  (void)state;
  for (int n = 0; n < 2000; n++) {
    const double l = h * RngBetween(&rng, 0.05, 0.5), x = fmax(l, 5.0 * h * RngUnit(&rng)), lo = x - l, hi = x + l;
    double       H[3], r;
    Axis         a;

    BasisRadius(BASIS_CPGIMP, x, l, &line, &a, H, &r);
    for (int k = 0; k < 3; k++) {
      const double node   = (double)(a.base + k) * h;
      const double cut[5] = {lo, fmin(fmax(node - h, lo), hi), fmin(fmax(node, lo), hi), fmin(fmax(node + h, lo), hi),
                             hi};
      double       S = 0.0, G = 0.0, N0 = 0.0;

      for (int q = 1; q < 3; q++) { /* Simpson is exact for r N */
        const double p = cut[q], w = cut[q + 1] - cut[q], at[3] = {p, p + 0.5 * w, p + w};

        for (int i = 0; i < 3; i++) {
          const double weight = w * (i == 1 ? 4.0 : 1.0) / 6.0, N = fmax(0.0, 1.0 - fabs(at[i] - node) / h);

          S += weight * at[i] * N;
          N0 += weight * N;
          G += weight * at[i] * (q == 1 ? 1.0 : -1.0) / h;
        }
      }
      const double ring = 2.0 * l * x;
      worst =
          fmax(worst, fmax(fabs(a.S[k] - S / ring), fmax(fabs(a.dS[k] - G / ring) * l, fabs(H[k] - N0 / ring) * x)));
    }
  }
  Say("radial weights, gradients and hoop weights against quadrature: %.1e\n", worst);
  Check(worst < 1e-13);
}

/* ---------------------------------------------------------------- kinematics */
enum { K_J = 0, K_COF, K_HOOP = K_COF + 4, K_E, K_THETA = K_E + 4, K_ROWS };

typedef struct {
  double motion[MOTION_COUNT];
  int    column;
} Motion;

static bool Numbers(void *ctx, double x, double y[RIDDERS_ROWS])
{
  const Motion *q = ctx;
  double        motion[MOTION_COUNT];
  Kinematics    k;

  memcpy(motion, q->motion, sizeof motion);
  motion[q->column] = x;
  if (!KinematicsEvaluate(motion, &k))
    return false;
  y[K_J] = k.J;
  for (int c = 0; c < 4; c++) {
    y[K_COF + c] = k.cof[c / 2][c % 2];
    y[K_E + c]   = k.e[c];
  }
  y[K_HOOP]  = k.cof_hoop;
  y[K_THETA] = atan2(k.turn.s, k.turn.c);
  return true;
}

static void TestKinematics(void **state)
{
  Rng    rng   = {9};
  double worst = 0.0;

  (void)state;
  for (int n = 0; n < 300; n++) {
    Motion     q;
    Kinematics k;

    for (int c = 0; c < MOTION_COUNT; c++)
      q.motion[c] = RngBetween(&rng, -0.3, 0.3);
    Check(KinematicsEvaluate(q.motion, &k));
    for (int c = 0; c < MOTION_COUNT; c++) {
      double dy[RIDDERS_ROWS], err[RIDDERS_ROWS];

      q.column = c;
      Check(Ridders(Numbers, &q, q.motion[c], 0.01, K_ROWS, dy, err));
      worst = fmax(worst, fabs(k.dJ[c] - dy[K_J]));
      worst = fmax(worst, fabs((c == MOTION_HOOP ? 0.0 : k.dJ[c] / k.lambda) - dy[K_HOOP]));
      worst = fmax(worst, fabs((c == MOTION_HOOP ? 0.0 : k.dtheta[0][c]) - dy[K_THETA]));
      for (int i = 0; i < 4; i++) {
        worst = fmax(worst, fabs(k.dcof[i / 2][i % 2][c] - dy[K_COF + i]));
        worst = fmax(worst, fabs(k.de[i][c] - dy[K_E + i]));
      }
    }
  }
  Say("kinematics with hoop strain against differences: %.1e\n", worst);
  Check(worst < 1e-10);
  for (double c = -0.5; c < 1.0; c += 0.25) { /* uniform expansion */
    const double motion[MOTION_COUNT] = {c, 0.0, 0.0, c, c}, s = 1.0 + c;
    Kinematics   k;

    Check(KinematicsEvaluate(motion, &k));
    Check(fabs(k.J - s * s * s) < 1e-14 && fabs(k.cof[0][0] - s * s) < 1e-14 && fabs(k.cof[1][1] - s * s) < 1e-14 &&
          fabs(k.cof_hoop - s * s) < 1e-14 && k.cof[0][1] == 0.0 && k.cof[1][0] == 0.0 &&
          atan2(k.turn.s, k.turn.c) == 0.0);
    Check(fabs(k.e[0] - log(s)) < 1e-14 && fabs(k.e[1] - log(s)) < 1e-14 && fabs(k.e[ZZ] - log(s)) < 1e-14 &&
          fabs(k.e[XY]) < 1e-15 && fabs(k.stretch[0] - s) < 1e-14 && fabs(k.stretch[1] - s) < 1e-14);
  }
  const double gone[2][MOTION_COUNT] = {{0.1, 0.0, 0.0, 0.1, -1.0}, {-2.1, 0.0, 0.0, 0.1, -2.0}};
  Kinematics   k;
  Check(!KinematicsEvaluate(gone[0], &k) && !KinematicsEvaluate(gone[1], &k)); /* J > 0 alone would not do */
}

/* ---------------------------------------------------------------- Jacobian */
static void TestJacobian(void **state)
{
  (void)state;
  Say("exact Jacobian about an axis, all fields: random directions; every entry relative to the largest of its row\n");
  for (int v = 0; v < 12; v++) {
    SmallScene  *s     = malloc(sizeof(*s));
    const int    basis = v / 4;
    const double start = v % 4 == 3 ? 0.3 : 0.0, gap = v % 4 == 2 ? 0.13 : 0.0;

    JacobianScene(s, HAS_ALL, true, true, (BasisType)basis, start, gap, v % 2, v % 4 / 2);
    const double worst = DirectionError(s, 3), entry = v == 1 || v == 7 ? ColumnError(s) : 0.0;
    Say("  %-6s body from r = %.2f m, kinetics %-3s conditions %d: directions %.1e", basis_name[basis], start + gap,
        v % 2 ? "on" : "off", v % 4 / 2, worst);
    Say(entry > 0.0 ? ", entries %.1e\n" : "\n", entry);
    Check(worst < 1e-6 && entry < 1e-6);
    SceneDestroy(s);
    free(s);
  }
}

/* The same with a pressure on the wall of a hole, whose drag (197) is the nodes'. */
static void TestWallJacobian(void **state)
{
  (void)state;
  for (int v = 0; v < 4; v++) {
    SmallScene *s    = malloc(sizeof(*s));
    double      wall = 0.0;

    JacobianCase(s, v % 2 ? HAS_ALL : HAS_SOLID | HAS_WATER, v / 2, true, BASIS_CPGIMP, 0.3, 0.13, false, 0);
    AddFace(s, BC_PRESSURE, SIDE_XMIN, 3e6, 0.0);
    JacobianState(s);
    for (PetscInt k = 0; k < s->m.map.n_local * PHASE_COUNT; k++)
      wall = fmax(wall, s->m.wall[k]);
    const double worst = DirectionError(s, 3), entry = ColumnError(s);
    Say("exact Jacobian beside a well, %s, inertia %s: directions %.1e, entries %.1e; drag of the wall up to %.1e Pa s "
        "m\n",
        v % 2 ? "all fields" : "one fluid", v / 2 ? "on" : "off", worst, entry, Largest(wall));
    Check(worst < 1e-6 && entry < 1e-6 && Largest(wall) > 0.0);
    SceneDestroy(s);
    free(s);
  }
}

/* ---------------------------------------------------------------- equilibrium */
/* Uniform pore pressure and effective stress (rr = tt) with their tractions on all sides, on the grid's lines and
   across them, hollow and about the axis: no force anywhere, no flow. */
static void TestUniformStress(void **state)
{
  static const double box[4][4] = {
      {0.1, 0.08, 0.5, 0.24}, {0.117, 0.093, 0.471, 0.238}, {0.0, 0.08, 0.5, 0.24}, {0.0, 0.093, 0.471, 0.238}};
  const double srr = -5e6, szz = -3e6, p = 3.25e6;

  (void)state;
  for (int k = 0; k < 16; k++) {
    const bool  strain = k >= 8;
    SmallScene *s      = malloc(sizeof(*s));

    SceneInit(s, k % 2 ? HAS_ALL : HAS_SOLID | HAS_WATER, true, true, k / 4 % 2 ? BASIS_UGIMP : BASIS_CPGIMP, 0.0,
              box[k % 4], box[k % 4] + 2);
    s->c.scene.mean_strain = strain ? 0.9 : 0.0;
    AddFace(s, BC_TRACTION, SIDE_XMIN, p - srr, 0.0);
    AddFace(s, BC_TRACTION, SIDE_XMAX, p - srr, 0.0);
    AddFace(s, BC_TRACTION, SIDE_YMIN, p - szz, 0.0);
    AddFace(s, BC_TRACTION, SIDE_YMAX, p - szz, 0.0);
    AddFace(s, BC_PRESSURE, SIDE_XMAX, p, 0.0)->initial = true;
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    for (PetscInt i = 0; i < s->m.P.n; i++) {
      s->m.P.f[P_SIG + XX][i] = s->m.P.f[P_SIG + ZZ][i] = srr;
      s->m.P.f[P_SIG + YY][i]                           = szz;
    }
    StageStart(s, 10.0);
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, 0, F_COUNT) * 1e6 / (p - srr);
    Check((Sum((double)s->m.added->nghost) > 0.0) == (k % 2 == 1)); /* a surface on the grid's lines cuts no cell */
    Say("uniform stress, %-6s, %s, %s%s: residual %.1e of the stress\n", basis_name[k / 4 % 2],
        k % 2 ? "across cells" : "on the grid ", k % 4 / 2 ? "about the axis" : "hollow", strain ? ", mean strain" : "",
        residual);
    Check(residual < 1e-13);
    SceneDestroy(s);
    free(s);
  }
}

/* u_r = a r, u_z = b z in one step: every particle's stress is the exact one, and with the tractions that belong to it
   no force is left.  For the linear basis only the stress. */
static void TestHomogeneous(void **state)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.47, 0.21}, a = 0.09, b = -0.08, dt = 10.0;
  const double e[3] = {log(1.0 + a), log(1.0 + b), log(1.0 + a)}, trace = e[0] + e[1] + e[2];

  (void)state;
  for (int basis = 0; basis < 3; basis++) {
    SmallScene *s = malloc(sizeof(*s));
    double     *x, off = 0.0, volume = 0.0, place = 0.0;
    Trial       t = {0};
    StageRates  rates;
    ClStatus    status;

    SceneInit(s, HAS_SOLID, false, true, (BasisType)basis, 0.0, lower, upper);
    const Elasticity *el = &s->mat.elasticity;
    const double      G = el->E0 / (2.0 * (1.0 + el->nu)), lame = 2.0 * G * el->nu / (1.0 - 2.0 * el->nu);
    const double      srr = 2.0 * G * e[0] + lame * trace, szz = 2.0 * G * e[1] + lame * trace;
    AddFace(s, BC_TRACTION, SIDE_XMAX, -srr, 0.0);
    AddFace(s, BC_TRACTION, SIDE_YMAX, -szz, 0.0);
    AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
    s->c.scene.stabilisation.ghost_penalty = 0.1;
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    StageStart(s, dt);
    Call(ModelBeginStage(&s->m, &s->stage));
    Call(PetscMalloc1(s->m.map.n_local * 2, &x));
    for (PetscInt I = 0; I < s->m.map.n_local; I++) {
      x[2 * I]     = a * (double)s->m.map.ij[I][0] * s->m.grid.line[0].h / dt;
      x[2 * I + 1] = b * (double)s->m.map.ij[I][1] * s->m.grid.line[1].h / dt;
    }
    const double residual = ResidualAt(s, x, 0, F_COUNT);
    Call(PetscMalloc4(3 * s->m.P.n, &t.m, 4 * s->m.P.n, &t.y, 2 * s->m.P.n, &t.u, 2 * s->m.P.n, &t.v));
    Call(ModelEndStage(&s->m, x, &t, &rates, &status));
    Check(status == CL_OK);
    double *rate;
    Call(PetscCalloc1(4 * s->m.P.n, &rate));
    Call(ModelCommit(&s->m, x, &t, rate, 0.0));
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      double *const *f = s->m.P.f;
      const double   V = 8.0 * M_PI * f[P_X][p] * f[P_L][p] * f[P_L + 1][p];

      for (int c = 0; c < 6; c++) {
        const double want = c == XX || c == ZZ ? srr : c == YY ? szz : 0.0;
        off               = fmax(off, fabs(f[P_SIG + c][p] - want) / fabs(srr));
      }
      if (basis == BASIS_CPGIMP) /* the domain stays the particle's volume */
        volume = fmax(volume, fabs(f[P_V][p] / V - 1.0));
      place = fmax(place, fabs(f[P_X][p] / (1.0 + a) - (f[P_X][p] - f[P_U][p])) +
                              fabs(f[P_X + 1][p] / (1.0 + b) - (f[P_X + 1][p] - f[P_U + 1][p])));
    }
    off = Largest(off), volume = Largest(volume), place = Largest(place);
    Say("homogeneous stretch, %-6s: stress %.1e, volume against domain %.1e, place %.1e m; force left %.1e of 1 MPa\n",
        basis_name[basis], off, volume, place, residual);
    Check(off < 1e-12 && volume < 1e-12 && place < 1e-13);
    Check(basis == BASIS_LINEAR || residual < 1e-11);
    Call(PetscFree(rate));
    Call(PetscFree(x));
    Call(PetscFree4(t.m, t.y, t.u, t.v));
    SceneDestroy(s);
    free(s);
  }
}

/* Linear T along the axis and constant along r, with its flux on the two ends. */
static void TestAxialHeat(void **state)
{
  const double lower[2] = {0.0, 0.05}, upper[2] = {0.47, 0.27}, slope = 20.0;

  (void)state;
  for (int basis = 0; basis < 2; basis++) {
    SmallScene *s = malloc(sizeof(*s));
    double      d[3];

    SceneInit(s, HAS_HEAT, true, true, (BasisType)basis, 0.0, lower, upper);
    s->mat.solid.beta  = 0.0;
    const double k[4]  = {s->mat.kappa_s, s->mat.kappa_h, s->mat.kappa_w, s->mat.kappa_g};
    const double kappa = MixtureAverage(0.3, 0.0, 0.0, k, &d[0], &d[1], &d[2]);
    AddFace(s, BC_HEAT_FLUX, SIDE_YMIN, 0.0, 0.0);
    AddFace(s, BC_HEAT_FLUX, SIDE_YMAX, 0.0, 0.0);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      s->m.P.f[P_T][p]      = 4.0 + slope * s->m.P.f[P_X + 1][p];
      s->m.P.f[P_GT + 1][p] = slope;
    }
    StageStart(s, 1e3);
    PointProperties q;
    const char     *why;
    Call(PointPropertiesEvaluate(&s->c.scene.fields, &s->mat,
                                 &(PointContents){.V = 1.0, .m_s = 0.7 * s->mat.solid.rho0, .T = 4.0}, &q,
                                 &why) != CL_OK);
    s->number[0] = -q.kappa * slope;
    s->number[2] = q.kappa * slope;
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, 0, F_COUNT);
    Say("linear temperature along the axis, %-6s: kappa %.4f (mixture %.4f) W/(m K), heat rows %.1e\n",
        basis_name[basis], q.kappa, kappa, residual);
    Check(residual < 1e-13);
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestRadialWeights), cmocka_unit_test(TestRadialQuadrature), cmocka_unit_test(TestKinematics),
      cmocka_unit_test(TestJacobian),      cmocka_unit_test(TestWallJacobian),     cmocka_unit_test(TestUniformStress),
      cmocka_unit_test(TestHomogeneous),   cmocka_unit_test(TestAxialHeat),
  };

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
