/* Tests of src/model, src/boundary as a whole: exact Jacobian, states of rest, patch tests, conservation, Newton's
   order. Scenes are built in memory; every random number belongs to a particle's id or a grid node, so that any number
   of ranks sees the same problem. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/tensor.h"
#include "small_scene.h"

/* ---------------------------------------------------------------- (a) Jacobian */
/* A random state; in the second set of conditions gas has the mobility of where it comes from. */
static void RandomScene(SmallScene *s, BasisType basis, bool reacts, int set)
{
  double held = 0.0, donor = 0.0;

  JacobianCase(s, HAS_ALL, true, false, basis, 0.0, 0.0, reacts, set);
  s->c.scene.stabilisation.donor = set;
  JacobianState(s);
  Check((PetscInt)Sum((double)s->m.added->nghost) > 0 && (PetscInt)Sum((double)s->m.added->ncell) > 0);
  for (PetscInt p = 0; p < s->m.P.n; p++)
    held += s->m.added->held && s->m.added->held[p] > 0.0;
  for (PetscInt p = 0; p < s->m.P.n; p++)
    donor += s->m.added->donor && s->m.added->donor[p].base < 1.0;
  Check((Sum(held) > 0.0) == reacts && (Sum(donor) > 0.0) == (set > 0));
}

static void TestJacobian(void **state)
{
  (void)state;
  Say("Jacobian (shell) against differences: random directions; every entry relative to the largest of its row\n");
  for (int basis = 0; basis < 3; basis++) {
    for (int k = 0; k < 4; k++) {
      SmallScene *s = malloc(sizeof(*s));

      RandomScene(s, (BasisType)basis, k / 2, k % 2);
      const double worst = DirectionError(s, 3), entry = k == 2 + basis % 2 ? ColumnError(s) : 0.0;
      Say("  %-6s kinetics %-3s conditions %d: directions %.1e", basis_name[basis], k / 2 ? "on" : "off", k % 2, worst);
      Say(entry > 0.0 ? ", entries %.1e\n" : "\n", entry);
      Check(worst < 1e-6 && entry < 1e-6);
      SceneDestroy(s);
      free(s);
    }
  }
}

/* What is factorised row by row holds the blocks of J2, which is not symmetric; on one rank. */
static void TestCopyByRows(void **state)
{
  static const unsigned has[3] = {HAS_SOLID, HAS_SOLID | HAS_WATER, HAS_ALL};

  (void)state;
  if (Sum(1.0) > 1.0)
    skip();
  Call(PetscOptionsSetValue(NULL, "-model_pmat_type", "aij"));
  for (int k = 0; k < 3; k++) {
    SmallScene *s = malloc(sizeof(*s));
    Vec         X, D, JD;
    Mat         rows, turned;
    double      largest, apart, skew;

    JacobianCase(s, has[k], true, false, BASIS_CPGIMP, 0.0, 0.0, false, 0);
    JacobianState(s);
    PrepareJacobian(s, &X, &D, &JD);
    Check(s->m.solver->Pmat != s->m.solver->J2);
    PreconditionerRenew(&s->m);
    Call(ModelJacobian(s->m.solver->snes, X, s->m.solver->A, s->m.solver->Pmat, &s->m));
    Call(MatConvert(s->m.solver->J2, MATAIJ, MAT_INITIAL_MATRIX, &rows));
    Call(MatTranspose(rows, MAT_INITIAL_MATRIX, &turned));
    Call(MatNorm(rows, NORM_FROBENIUS, &largest));
    Call(MatAXPY(turned, -1.0, rows, DIFFERENT_NONZERO_PATTERN));
    Call(MatNorm(turned, NORM_FROBENIUS, &skew));
    Call(MatAXPY(rows, -1.0, s->m.solver->Pmat, DIFFERENT_NONZERO_PATTERN));
    Call(MatNorm(rows, NORM_FROBENIUS, &apart));
    Say("copy of J2 by rows, %d unknowns a node: differs by %.1e, its transpose by %.1e of %.1e\n", s->c.scene.fields.n,
        apart, skew, largest);
    Check(apart == 0.0 && skew > 1e-3 * largest);
    Call(MatDestroy(&rows));
    Call(MatDestroy(&turned));
    Call(VecDestroy(&X));
    Call(VecDestroy(&D));
    Call(VecDestroy(&JD));
    SceneDestroy(s);
    free(s);
  }
  Call(PetscOptionsClearValue(NULL, "-model_pmat_type"));
}

/* Two layers whose permeabilities differ a thousandfold (350), with one fluid and with two; with methane in the water
   (352) that what is added to the balance of water takes along, in either matrix. */
static void TestLayersJacobian(void **state)
{
  static const struct {
    const char *name, *matrix;
    unsigned    has;
    bool        donor;
    double      solubility; /* mol/(m^3 Pa) */
  } scene[] = {{"water", "reduced", HAS_SOLID | HAS_WATER, false, 0.0},
               {"six fields", "reduced", HAS_ALL, false, 0.0},
               {"six fields, gas from where it comes (332)", "reduced", HAS_ALL, true, 0.0},
               {"six fields, methane in the water (352)", "reduced", HAS_ALL, false, 1.9e-5},
               {"six fields, methane in the water (352), whole", "whole", HAS_ALL, false, 1.9e-5}};

  (void)state;
  for (size_t k = 0; k < sizeof(scene) / sizeof(*scene); k++) {
    SmallScene *s = malloc(sizeof(*s));

    Call(PetscOptionsSetValue(NULL, "-newton_preconditioner", scene[k].matrix));
    JacobianCase(s, scene[k].has, true, false, BASIS_CPGIMP, 0.0, 0.0, false, 0);
    s->c.scene.stabilisation.donor = scene[k].donor;
    if (scene[k].solubility > 0.0)
      SetSolubility(&s->mat.gas, scene[k].solubility);
    SceneLayers(s, 1, 0.08, 1e-3);
    JacobianState(s);
    const double worst = DirectionError(s, 3), entry = ColumnError(s);
    Say("  two layers, %s: directions %.1e, entries %.1e\n", scene[k].name, worst, entry);
    Check(worst < 1e-6 && entry < 1e-6);
    SceneDestroy(s);
    free(s);
  }
  Call(PetscOptionsClearValue(NULL, "-newton_preconditioner"));
}

/* On the grid of the initial configuration (445), of a body that has been strained and turned. */
static void TestTotalJacobian(void **state)
{
  static const unsigned has[4] = {HAS_SOLID, HAS_SOLID | HAS_WATER, HAS_ALL, HAS_ALL};

  (void)state;
  for (int k = 0; k < 4; k++) {
    SmallScene *s = malloc(sizeof(*s));

    JacobianCase(s, has[k], true, k == 3, BASIS_TOTAL, k == 3 ? 0.3 : 0.0, 0.0, false, 0);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    RandomHistory(s, 0.2);
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      for (int c = 0; c < CL_DIM * CL_DIM; c++)
        AddNoise(s->m.P.f[P_F + c], p, 0.2, Noise(11, s->m.P.i[PI_ID][p], c));
    }
    RandomStage(s, 20.0);
    MakeSolver(s);
    const double worst = DirectionError(s, 3), entry = ColumnError(s);
    Say("  total, %d unknowns a node%s: directions %.1e, entries %.1e\n", s->c.scene.fields.n,
        k == 3 ? ", about an axis" : "", worst, entry);
    Check(worst < 1e-6 && entry < 1e-6);
    SceneDestroy(s);
    free(s);
  }
}

/* Beds that dip (308), with one fluid and with two, in layers of unlike permeability. */
static void TestBedsJacobian(void **state)
{
  static const unsigned has[3] = {HAS_SOLID | HAS_WATER, HAS_ALL, HAS_WATER | HAS_GAS | HAS_HEAT};

  (void)state;
  for (int k = 0; k < 3; k++) {
    SmallScene *s = malloc(sizeof(*s));

    JacobianCase(s, has[k], true, false, BASIS_CPGIMP, 0.0, 0.0, false, 0);
    s->mat.permeability.ratio = 0.1;
    s->mat.permeability.dip   = 25.0;
    SceneLayers(s, 1, 0.08, 0.3);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    RandomHistory(s, 0.2);
    RandomStage(s, 1e-3); /* short: what (308) adds to inertia goes with 1/dt */
    MakeSolver(s);
    const double worst = DirectionError(s, 3), entry = ColumnError(s);
    Say("  beds, %s: directions %.1e, entries %.1e\n",
        k == 0   ? "water"
        : k == 1 ? "six fields"
                 : "rigid",
        worst, entry);
    Check(worst < 1e-6 && entry < 1e-6);
    SceneDestroy(s);
    free(s);
  }
}

/* Residual of a random state of a body whose beds lay at `dip`, deg, before it was turned or sheared by F. */
static void BedsResidual(double ratio, double dip, const double F[4], int n, double *a)
{
  SmallScene *s = malloc(sizeof(*s));
  Model      *m = &s->m;

  JacobianCase(s, HAS_ALL, true, false, BASIS_CPGIMP, 0.0, 0.0, false, 0);
  s->c.scene.nbc = s->c.scene.nlisted = 0; /* faces turn, too */
  s->mat.permeability.ratio           = ratio;
  s->mat.permeability.dip             = dip;
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, m));
  RandomHistory(s, 0.2);
  for (PetscInt p = 0; p < m->P.n; p++) {
    for (int k = 0; k < 4; k++)
      m->P.f[P_F + k][p] = F[k];
  }
  RandomStage(s, 20.0);
  MakeSolver(s);
  double       *x;
  const double *R;
  Call(PetscMalloc1(m->map.n_local * m->c->fields.n, &x));
  RandomUnknowns(m, s->stage.dt, 30, x);
  SetX(m, x);
  Call(ModelResidual(NULL, m->solver->X, m->solver->R, m));
  Call(VecGetArrayRead(m->solver->R, &R));
  Check(m->map.n_owned * m->c->fields.n <= n);
  for (PetscInt k = 0; k < n; k++)
    a[k] = k < m->map.n_owned * m->c->fields.n ? R[k] : 0.0;
  Call(VecRestoreArrayRead(m->solver->R, &R));
  Call(PetscFree(x));
  SceneDestroy(s);
  free(s);
}

static double BedsApart(double dip, const double F[4], double dip_F, double ratio)
{
  static const double one[4] = {1.0, 0.0, 0.0, 1.0};
  static double       a[512], b[512];
  double              off = 0.0;

  BedsResidual(ratio, dip, one, 512, a);
  BedsResidual(ratio, dip_F, F, 512, b);
  for (int k = 0; k < 512; k++)
    off = fmax(off, fabs(a[k] - b[k]));
  return Largest(off);
}

/* Beds are surfaces of the material (307): they turn with the body, a right angle too; shear along them leaves them as
   they are, and shear across them by tan(45 deg) turns what stood upright to 45 deg. */
static void TestBedsTurn(void **state)
{
  static const double turned[4] = {0.0, -1.0, 1.0, 0.0}, c = 0.8, si = 0.6, shear[4] = {1.0, 1.0, 0.0, 1.0};
  const double        some[4] = {c, -si, si, c}, angle = atan2(si, c) * 180.0 / M_PI;
  const double        right = BedsApart(90.0, turned, 0.0, 0.1), part = BedsApart(20.0 + angle, some, 20.0, 0.1),
               along = BedsApart(0.0, shear, 0.0, 0.1), across = BedsApart(45.0, shear, 90.0, 0.1),
               unlike = BedsApart(90.0, turned, 90.0, 0.1);

  (void)state;
  Say("beds turn: by 90 deg %.1e, by %.0f deg %.1e, sheared along %.1e, across %.1e; not turned %.1e\n", right, angle,
      part, along, across, unlike);
  Check(right < 1e-12 && part < 1e-12 && along < 1e-12 && across < 1e-12 && unlike > 1e-3);
}

/* A of a border (447) with the normal at `angle` in beds that dip, and its inverse (448): [across, along, turned, one].
 */
static void BorderAt(double angle, double turn, double off[4])
{
  const double n[2] = {cos(angle), sin(angle)}, t[2] = {-n[1], n[0]}, one[2][2] = {{1.0, 0.0}, {0.0, 1.0}},
               ratio           = 1e-4;
  const double N[CL_SYMMETRIC] = {n[0] * n[0], n[1] * n[1], n[0] * n[1]}, c = cos(turn), si = sin(turn);
  const double m[2]            = {c * n[0] - si * n[1], si * n[0] + c * n[1]};
  const double M[CL_SYMMETRIC] = {m[0] * m[0], m[1] * m[1], m[0] * m[1]};
  const Beds   before          = BedsOf(0.3, 0.4, one);
  Beds         A = before, B = BedsOf(0.3, 0.4 + turn, one);
  double       drive[2], was[2], mine[2];

  BedsLessen(&A, N, ratio);
  BedsLessen(&B, M, ratio);
  off[0] = fabs(BedsAcross(&A, N) / (ratio * BedsAcross(&before, N)) - 1.0);
  /* what no flow across drives: along the border as before */
  memcpy(drive, n, sizeof(drive));
  BedsDrive(&before, drive);
  const double rest[2] = {-drive[1], drive[0]}; /* n . A rest = 0 */
  memcpy(was, rest, sizeof(was));
  memcpy(mine, rest, sizeof(mine));
  BedsDrive(&before, was);
  BedsDrive(&A, mine);
  off[1] = hypot(mine[0] - was[0], mine[1] - was[1]);
  /* the whole turned */
  memcpy(was, t, sizeof(was));
  BedsDrive(&A, was);
  mine[0] = c * t[0] - si * t[1];
  mine[1] = si * t[0] + c * t[1];
  BedsDrive(&B, mine);
  off[2]             = hypot(mine[0] - (c * was[0] - si * was[1]), mine[1] - (si * was[0] + c * was[1]));
  const Beds inverse = BedsInverse(&A);
  memcpy(was, n, sizeof(was));
  BedsDrive(&A, was);
  BedsDrive(&inverse, was);
  off[3] = hypot(was[0] - n[0], was[1] - n[1]);
}

static void TestBorders(void **state)
{
  double worst[4] = {0.0};

  (void)state;
  for (int k = 0; k < 12; k++) {
    double off[4];

    BorderAt(0.5 * k, 0.3 + 0.7 * k, off);
    for (int i = 0; i < 4; i++)
      worst[i] = fmax(worst[i], off[i]);
  }
  Say("borders: across %.1e, along %.1e, turned %.1e, inverse %.1e\n", worst[0], worst[1], worst[2], worst[3]);
  Check(worst[0] < 1e-10 && worst[1] < 1e-14 && worst[2] < 1e-14 && worst[3] < 1e-10);
}

/* Plates: one that moves, rough; one with a prescribed force, whose springs couple all nodes under it (74), held to the
   body or free to separate, in which case a part of it touches. */
static void PlateScene(SmallScene *s, bool axisymmetric, int kind)
{
  Bc *b;

  JacobianCase(s, kind == 1 ? HAS_SOLID : HAS_SOLID | HAS_WATER, true, axisymmetric, BASIS_CPGIMP, 0.1, 0.0, false, 0);
  b            = AddFace(s, BC_PLATE, SIDE_XMAX, 1e-5, 0.0);
  b->stiffness = 100.0;
  b->rough     = true;
  b            = AddFace(s, BC_PLATE, SIDE_YMAX, 0.0, 0.0);
  b->force     = Constant(s, -2, kind == 2 ? 1e9 : 4e6); /* the number of the value that it has not */
  b->value.n   = 0;
  b->stiffness = 100.0;
  b->separates = kind == 2;
  JacobianState(s);
}

/* Exact Jacobian, the force as prescribed, and no plate that does not touch. */
static void TestPlates(void **state)
{
  (void)state;
  for (int k = 0; k < 6; k++) {
    SmallScene *s = malloc(sizeof(*s));
    Model      *m = &s->m;
    Trial       t = {0};

    PlateScene(s, k % 2, k / 2);
    const PetscInt top   = s->c.scene.nbc - 1;
    const double   worst = DirectionError(s, 3), entry = ColumnError(s);
    double        *x;
    StageRates     rates;
    ClStatus       status;
    double         touching = 0.0, faces = 0.0;

    for (PetscInt i = 0; i < m->nface; i++) {
      touching += m->face[i].bc[BC_PLATE] == top && m->face[i].touches;
      faces += m->face[i].bc[BC_PLATE] == top;
    }
    Call(PetscMalloc1(m->map.n_local * m->c->fields.n, &x));
    Call(PetscMalloc4(3 * m->P.n, &t.m, 4 * m->P.n, &t.y, 2 * m->P.n, &t.u, 2 * m->P.n, &t.v));
    RandomUnknowns(m, s->stage.dt, 30, x);
    SetX(m, x);
    Call(ModelResidual(NULL, m->solver->X, m->solver->R, m));
    Call(ModelEndStage(m, x, &t, &rates, &status));
    const double F = s->bc[top].force.y[0], error = fabs(m->plate[top][PLATE_FORCE] / F - 1.0);
    Say("plates, %s, kind %d: directions %.1e, entries %.1e, force %.1e; %g of %g faces touch\n",
        k % 2 ? "about an axis" : "plane", k / 2, worst, entry, error, Sum(touching), Sum(faces));
    Check(worst < 1e-6 && entry < 1e-6 && error < 1e-12);
    Check(k / 2 == 2 ? Sum(touching) < Sum(faces) && Sum(touching) > 0.0 : Sum(touching) == Sum(faces));
    Call(PetscFree(x));
    Call(PetscFree4(t.m, t.y, t.u, t.v));
    SceneDestroy(s);
    free(s);
  }
}

/* ---------------------------------------------------------------- (d) conservation */
/* What the particles keep, (28), is what they had less what flowed out, even for unknowns that solve nothing: the rows
   of water and of gas, summed over the nodes, are the change of mass plus the outflow. */
static void TestMassRows(void **state)
{
  double worst = 0.0;

  (void)state;
  for (int k = 0; k < 12; k++) {
    SmallScene  *s = malloc(sizeof(*s));
    Model       *m = &s->m;
    double      *x, mass[2] = {0.0}, gain[2] = {0.0};
    const double nu[2] = {6.0 * 0.018 / 0.124, 0.016 / 0.124};
    Trial        t     = {0};
    StageRates   rates;
    ClStatus     status;

    RandomScene(s, (BasisType)(k % 3), k % 4 >= 2, k % 2);
    Call(PetscMalloc1(m->map.n_local * F_COUNT, &x));
    Call(PetscMalloc4(3 * m->P.n, &t.m, 4 * m->P.n, &t.y, 2 * m->P.n, &t.u, 2 * m->P.n, &t.v));
    RandomUnknowns(m, s->stage.dt, 50 + k, x);
    SetX(m, x);
    Call(ModelResidual(NULL, m->solver->X, m->solver->R, m));
    Check(m->failure.status == CL_OK);
    Call(ModelEndStage(m, x, &t, &rates, &status));
    Check(status == CL_OK);
    for (PetscInt p = 0; p < m->P.n; p++) {
      const double h = s->mat.reacts ? t.m[3 * p] - s->stage.m_star[3 * p] : 0.0;

      for (int f = 0; f < 2; f++) {
        mass[f] += t.m[3 * p + 1 + f];
        gain[f] += t.m[3 * p + 1 + f] - s->stage.m_star[3 * p + 1 + f] + nu[f] * h;
      }
    }
    for (int f = 0; f < 2; f++)
      worst = fmax(worst, fabs(Sum(gain[f]) + s->stage.dt * rates.out[f]) / Sum(mass[f]));
    Call(PetscFree(x));
    Call(PetscFree4(t.m, t.y, t.u, t.v));
    SceneDestroy(s);
    free(s);
  }
  Say("water and gas gained and gone, of the mass inside: %.1e (12 random states)\n", worst);
  Check(worst < 1e-13);
}

/* ---------------------------------------------------------------- states of rest, patch tests */
/* Newton from a perturbed first guess must come back to rest: the largest velocity in units of its column scale, the
   velocity that makes 1 MPa in the step (immobile gas moves with the skeleton, whose scale then counts). */
static double RestVelocity(SmallScene *s, double *scale)
{
  Model   *m = &s->m;
  double  *x, worst = 0.0;
  PetscInt newton;
  ClStatus status;

  *scale = 0.0;
  Call(PetscMalloc1(m->map.n_local * F_COUNT, &x));
  for (PetscInt k = 0; k < m->map.n_local * F_COUNT; k++)
    x[k] = m->x_n[k] +
           1e-3 * m->col_scale[k] * Noise(60, m->map.ij[k / F_COUNT][0] + 100 * m->map.ij[k / F_COUNT][1], k % F_COUNT);
  m->solver->tol_residual = 2e-12; /* and a twentieth of it in mass and energy */
  Call(ModelSolve(m, x, &newton, &status));
  if (status != CL_OK)
    Say("  %s\n", m->failure.why);
  Check(status == CL_OK && newton > 0);
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++) {
    if (k % F_COUNT < F_PW)
      worst = fmax(worst, fabs(x[k]) / fmax(m->col_scale[k], m->col_scale[k - k % F_COUNT]));
    if (k % F_COUNT < F_VW)
      *scale = fmax(*scale, m->col_scale[k]);
  }
  Call(PetscFree(x));
  *scale = Largest(*scale);
  return Largest(worst);
}

/* Two layers with different retention under one p_w, p_g; the skeleton carries what the pores do not: sigma' - p = -q.
   Not for the linear basis, whose point quadrature does not balance a traction exactly. */
static void TestTwoLayers(void **state)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.47, 0.13}, q = 4e6;

  (void)state;
  for (int basis = 0; basis < 2; basis++) {
    SmallScene *s = malloc(sizeof(*s));
    double      scale;

    SceneInit(s, HAS_ALL, true, false, (BasisType)basis, 0.0, lower, upper);
    s->c.scene.stabilisation.donor = basis;
    Material mat[2]                = {s->mat, s->mat};
    Region   region[2]             = {s->region, s->region};
    mat[1].retention.m             = 0.6;
    mat[1].retention.p0            = 2e5;
    mat[1].permeability.k0 *= 1e-3;
    mat[1].porosity      = 0.45;
    region[1].lower[1]   = 0.13;
    region[1].upper[1]   = 0.25;
    region[1].material   = 1;
    s->c.scene.nmaterial = s->c.scene.nregion = 2;
    s->c.scene.material                       = mat;
    s->c.scene.region                         = region;
    AddPlane(s, BC_ROLLER, 0, 0.0, 0.0);
    AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
    AddFace(s, BC_TRACTION, SIDE_XMAX, q, 0.0);
    AddFace(s, BC_TRACTION, SIDE_YMAX, q, 0.0);
    AddFace(s, BC_PRESSURE, SIDE_YMAX, 0.0, 0.0)->initial = true;
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      double *const *f = s->m.P.f;

      f[P_PW][p] = f[P_PW0][p] = 3.2e6;
      f[P_PG][p] = f[P_PG0][p] = 3.3e6;
      Refill(s, p, s->m.P.i[PI_REGION][p] ? 0.3 : 0.0);
      const double sg = GasShareOf(MaterialOf(s, p), 1e5, f[P_SH][p]);
      for (int k = 0; k < 3; k++)
        f[P_SIG + k][p] = f[P_SIG0 + k][p] = 3.2e6 + sg * 1e5 - q;
    }
    StageStart(s, 10.0);
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, 0, F_COUNT), v = RestVelocity(s, &scale);
    Say("two layers, %-6s: residual %.1e, velocities %.1e of %.1e m/s\n", basis_name[basis], residual, v, scale);
    Check(residual < 1e-13 && v < 1e-12);
    SceneDestroy(s);
    free(s);
  }
}

/* Closed column under gravity: incompressible water, weightless immobile gas on the plateau of its retention curve. */
static void HydrostaticScene(SmallScene *s, BasisType basis)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.5, 0.24}, g = 9.81;
  Material    *mat = &s->mat;

  SceneInit(s, HAS_ALL, true, false, basis, 0.0, lower, upper);
  Check(RetentionSetType(&mat->retention, "van_genuchten_clamped"));
  mat->retention.Sgr             = 0.05;
  mat->water.K                   = INFINITY;
  mat->gas.M                     = 1e-18;
  s->c.scene.stabilisation.donor = basis;
  SetSolubility(&mat->gas, 1.9e-5);
  s->c.scene.gravity[1] = -g;
  s->region.Sg          = 0.05;
  s->region.Sw          = 0.95;
  AddPlane(s, BC_ROLLER, 0, 0.0, 0.0);
  AddPlane(s, BC_ROLLER, 0, 0.5, 0.0);
  AddPlane(s, BC_FIXED, 1, 0.0, 0.0);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    double *const *f     = s->m.P.f;
    const double   depth = 0.24 - f[P_X + 1][p], T = f[P_T][p];
    double         d, e;
    const double   rho   = LiquidDensity(&mat->water, 0.0, T, &d, &e);
    const double   grain = LiquidDensity(&mat->solid, 0.0, T, &d, &e);

    f[P_PW][p]     = 1e6 + rho * g * depth;
    f[P_PG][p]     = 0.9e6;
    f[P_GW + 1][p] = -rho * g;
    Refill(s, p, 0.0);
    const double gas  = GasDensity(&mat->gas, 0.9e6, T, &d, &e);
    const double mean = 0.7 * grain + 0.3 * (0.95 * rho + 0.05 * gas), top = 0.95 * 1e6 + 0.05 * 0.9e6;
    const double total = -mean * g * depth, p_m = top + 0.95 * rho * g * depth; /* free of traction at the top */
    for (int k = 0; k < 3; k++)
      f[P_SIG + k][p] = f[P_SIG0 + k][p] = total + p_m;
  }
}

static void TestHydrostatic(void **state)
{
  (void)state;
  for (int basis = 0; basis < 2; basis++) {
    SmallScene *s = malloc(sizeof(*s));
    double      scale;

    HydrostaticScene(s, (BasisType)basis);
    StageStart(s, 10.0);
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, 0, F_COUNT), v = RestVelocity(s, &scale);
    Say("hydrostatic column, %-6s: residual %.1e, velocities %.1e of %.1e m/s\n", basis_name[basis], residual, v,
        scale);
    Check(residual < 1e-13 && v < 1e-12);
    SceneDestroy(s);
    free(s);
  }
}

/* A uniform stress with its tractions on all four sides, on the grid's lines and across them. */
static void TestUniformStress(void **state)
{
  static const double box[2][4] = {{0.1, 0.08, 0.5, 0.24}, {0.117, 0.093, 0.471, 0.238}};
  const double        sxx = -5e6, syy = -3e6, sxy = 1.2e6, p = 3.25e6;

  (void)state;
  for (int k = 0; k < 8; k++) {
    const bool  strain = k >= 4, ugimp = k / 2 % 2;
    const int   at = k % 2;
    SmallScene *s  = malloc(sizeof(*s));

    SceneInit(s, HAS_ALL, true, false, ugimp ? BASIS_UGIMP : BASIS_CPGIMP, 0.0, box[at], box[at] + 2);
    s->c.scene.mean_strain = strain ? 0.9 : 0.0;
    /* normal stress is compression-positive; the shear acts along the normal turned by +90 degrees */
    AddFace(s, BC_TRACTION, SIDE_XMIN, p - sxx, sxy);
    AddFace(s, BC_TRACTION, SIDE_XMAX, p - sxx, sxy);
    AddFace(s, BC_TRACTION, SIDE_YMIN, p - syy, -sxy);
    AddFace(s, BC_TRACTION, SIDE_YMAX, p - syy, -sxy);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    for (PetscInt i = 0; i < s->m.P.n; i++) {
      s->m.P.f[P_SIG + XX][i] = sxx;
      s->m.P.f[P_SIG + YY][i] = syy;
      s->m.P.f[P_SIG + XY][i] = sxy;
    }
    StageStart(s, 10.0);
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, 0, F_COUNT);
    Say("uniform stress, %-6s, %s%s: residual %.1e of 1 MPa\n", basis_name[ugimp], at ? "across cells" : "on the grid ",
        strain ? ", mean strain" : "", residual);
    Check(residual < 2e-13);
    SceneDestroy(s);
    free(s);
  }
}

/* Linear p in x and the velocity of Darcy's law: every water row is zero. */
static void TestDarcy(void **state)
{
  const double lower[2] = {0.1, 0.08}, upper[2] = {0.5, 0.24}, slope = 2e6;
  SmallScene  *s   = malloc(sizeof(*s));
  Material    *mat = &s->mat;
  double      *x, d, e;

  (void)state;
  SceneInit(s, HAS_ALL, true, false, BASIS_CPGIMP, 0.0, lower, upper);
  Check(RetentionSetType(&mat->retention, "van_genuchten_clamped"));
  mat->water.K = INFINITY;
  AddFace(s, BC_PRESSURE, SIDE_XMIN, 3e6 + slope * 0.1, 0.0);
  AddFace(s, BC_PRESSURE, SIDE_XMAX, 3e6 + slope * 0.5, 0.0);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    double *const *f = s->m.P.f;

    f[P_PW][p] = f[P_PG][p] = 3e6 + slope * f[P_X][p];
    f[P_GW][p] = f[P_GG][p] = slope;
    f[P_PW0][p] = f[P_PG0][p] = 1e6;
    Refill(s, p, 0.0);
  }
  StageStart(s, 1e3);
  const double sw = 1.0 - GasShareOf(mat, 0.0, 0.0), k = PermeabilityEvaluate(&mat->permeability, 0.3, 0.0, &d, &e);
  const double v = -k * RelPermWater(&mat->relperm, sw, &d) / mat->mu_w.mu * slope / (0.3 * sw);
  Call(PetscMalloc1(s->m.map.n_local * F_COUNT, &x));
  for (PetscInt I = 0; I < s->m.map.n_local; I++)
    s->m.x_n[I * F_COUNT + F_VW] = s->stage.x_star[I * F_COUNT + F_VW] = v;
  Call(PetscArraycpy(x, s->m.x_n, s->m.map.n_local * F_COUNT));
  Call(ModelBeginStage(&s->m, &s->stage));
  const double force = ResidualAt(s, x, F_VW, F_VG);
  double       scale = 0.0; /* kg; what flows through a square metre in the step is 1e3 s x 1e3 kg/m^3 x J */
  for (PetscInt I = 0; I < s->m.map.n_local; I++)
    scale = fmax(scale, s->m.row_scale[I * F_COUNT + F_PW]);
  const double mass = ResidualAt(s, x, F_PW, F_PG) * scale / (1e6 * fabs(v) * 0.3 * sw * s->m.grid.line[1].h);
  for (PetscInt I = 0; I < s->m.map.n_local; I++)
    x[I * F_COUNT + F_VW] *= 1.001; /* the rows do see the velocity */
  const double seen = ResidualAt(s, x, F_VW, F_VG);
  Say("uniform Darcy flow, v_w = %.6e m/s: momentum of water %.1e, mass %.1e (with 0.1 %% more velocity: %.1e)\n", v,
      force, mass, seen);
  Check(force < 1e-13 && mass < 1e-13 && seen > 1e-5);
  Call(PetscFree(x));
  SceneDestroy(s);
  free(s);
}

/* Linear T with the heat flux that belongs to it on two sides. */
static void TestHeatFlux(void **state)
{
  const double lower[2] = {0.1, 0.08}, upper[2] = {0.5, 0.24}, slope[2] = {30.0, -20.0};

  (void)state;
  for (int k = 0; k < 2; k++) {
    SmallScene *s = malloc(sizeof(*s));
    double      d[3];

    SceneInit(s, HAS_ALL, true, false, BASIS_CPGIMP, 0.0, lower, upper);
    Material *mat   = &s->mat;
    mat->solid.beta = mat->hydrate.beta = mat->water.beta = 0.0;
    const double X[4]                                     = {mat->kappa_s, mat->kappa_h, mat->kappa_w, mat->kappa_g};
    const double kappa                                    = MixtureAverage(0.3, 0.0, 0.6, X, &d[0], &d[1], &d[2]);
    for (int side = 0; side < SIDE_COUNT; side++)
      AddFace(s, BC_HEAT_FLUX, (Side)side, (side % 2 ? 1.0 : -1.0) * kappa * slope[side / 2], 0.0);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      double *const *f = s->m.P.f;

      f[P_T][p] = 4.0 + slope[0] * f[P_X][p] + slope[1] * f[P_X + 1][p];
      for (int a = 0; a < 2; a++)
        f[P_GT + a][p] = slope[a];
      Refill(s, p, 0.0);
    }
    StageStart(s, 1e3);
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, F_T, F_COUNT);
    Say("linear temperature, kappa_m = %.4f W/(m K): heat rows %.1e\n", kappa, residual);
    Check(residual < 1e-13);
    SceneDestroy(s);
    free(s);
  }
}

/* ---------------------------------------------------------------- (e) Newton */
/* A sudden load of 2 MPa on a column that forms hydrate, one step of 50 s. */
static void TestNewtonOrder(void **state)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.47, 0.16};
  SmallScene  *s = malloc(sizeof(*s));
  double      *x, history[50] = {0.0}, best = 0.0;
  PetscInt     newton, n;
  ClStatus     status;

  (void)state;
  SceneInit(s, HAS_ALL, true, false, BASIS_CPGIMP, 0.0, lower, upper);
  s->mat.reacts          = true;
  s->mat.permeability.k0 = 1.53e-15;
  AddPlane(s, BC_FIXED, 0, 0.0, 0.0);
  AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
  AddPlane(s, BC_ROLLER, 1, 0.16, 0.0);
  AddFace(s, BC_TRACTION, SIDE_XMAX, 5.25e6, 0.0);
  AddFace(s, BC_PRESSURE, SIDE_XMAX, 0.0, 0.0)->initial = true;
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  StageStart(s, 50.0);
  Call(ModelBeginStage(&s->m, &s->stage));
  MakeSolver(s);
  s->m.solver->tol_residual = 1e-11;
  Call(SNESSetConvergenceHistory(s->m.solver->snes, history, NULL, 50, PETSC_TRUE));
  Call(PetscMalloc1(s->m.map.n_local * F_COUNT, &x));
  Call(PetscArraycpy(x, s->m.x_n, s->m.map.n_local * F_COUNT));
  Call(ModelSolve(&s->m, x, &newton, &status));
  Call(SNESGetConvergenceHistory(s->m.solver->snes, NULL, NULL, &n));
  Say("Newton on a sudden load of 2 MPa with hydrate forming, dt = 50 s:\n");
  for (PetscInt k = 0; k < n; k++) {
    const double order = k > 1 ? log(history[k] / history[k - 1]) / log(history[k - 1] / history[k - 2]) : NAN;

    Say("  %2" PetscInt_FMT "  |R| = %.3e, order %.2f\n", k, history[k], order);
    if (k > 1 && history[k - 1] < 1e-2 && history[k] > 1e-12)
      best = fmax(best, order);
  }
  Check(status == CL_OK && best > 1.8);
  Call(PetscFree(x));
  SceneDestroy(s);
  free(s);
}

/* (414): fluid velocities of a random state that follow the pressures meet their rows (16), wall of a well and layers
   included; the other unknowns stay.  With inertia they have a memory and stay, too. */
static void TestSlaved(void **state)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.47, 0.29};

  (void)state;
  for (int k = 0; k < 4; k++) {
    const bool   ring = k % 2, inertia = k > 1;
    SmallScene  *s = malloc(sizeof(*s));
    Model       *m = &s->m;
    double      *x, changed = 0.0, kept = 0.0, wall = 0.0;
    Vec          before;
    const double start = ring ? 0.1 : 0.0;

    SceneInit(s, HAS_ALL, inertia, ring, BASIS_CPGIMP, start, lower, upper);
    SetSolubility(&s->mat.gas, 1.9e-5); /* gas may vanish */
    SceneLayers(s, 1, 0.16, 1e-3);
    AddFace(s, BC_PRESSURE, SIDE_XMIN, 3e6, 0.0);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, m));
    RandomHistory(s, 0.2);
    RandomStage(s, 20.0);
    for (PetscInt i = 0; m->wall && i < m->map.n_local * PHASE_COUNT; i++)
      wall = fmax(wall, m->wall[i]);
    Call(PetscMalloc1(m->map.n_local * F_COUNT, &x));
    RandomUnknowns(m, s->stage.dt, 30, x);
    const double rest = ResidualAt(s, x, F_VW, F_PW);
    Call(VecDuplicate(m->solver->X, &before));
    Call(VecCopy(m->solver->X, before));
    Call(ModelVelocitiesOfPressures(m, m->solver->X));
    Call(VecAXPY(before, -1.0, m->solver->X));
    const double *d, *a;
    Call(VecGetArrayRead(before, &d));
    for (PetscInt i = 0; i < m->map.n_owned * F_COUNT; i++) {
      const bool slave = i % F_COUNT >= F_VW && i % F_COUNT < F_PW;

      changed = fmax(changed, slave ? fabs(d[i]) : 0.0);
      kept    = fmax(kept, slave ? 0.0 : fabs(d[i]));
    }
    Call(VecRestoreArrayRead(before, &d));
    Call(ModelResidual(NULL, m->solver->X, m->solver->R, m));
    double left = 0.0;
    Call(VecGetArrayRead(m->solver->R, &a));
    for (PetscInt i = 0; i < m->map.n_owned * F_COUNT; i++)
      left = fmax(left, i % F_COUNT >= F_VW && i % F_COUNT < F_PW ? fabs(a[i]) : 0.0);
    Call(VecRestoreArrayRead(m->solver->R, &a));
    Say("fluid velocities that follow (16), %s%s: residual %.1e, before %.1e; wall's drag up to %.1e Pa s m\n",
        ring ? "about an axis" : "plane", inertia ? ", inertia" : "", Largest(left), rest, Largest(wall));
    Check(ModelVelocitiesFollow(m) == !inertia && Largest(kept) == 0.0 && (Largest(wall) > 0.0) == ring);
    Check(inertia ? Largest(changed) == 0.0 : rest > 1e-3 && Largest(left) < 1e-12 * rest);
    Call(VecDestroy(&before));
    Call(PetscFree(x));
    SceneDestroy(s);
    free(s);
  }
}

/* (197) with (333): what a well's wall adds is of the state at t_n, not of the donors of the step before: the step
   begun again has the same. */
static void TestWallOfDonors(void **state)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.47, 0.29};
  SmallScene  *s = malloc(sizeof(*s));
  Model       *m = &s->m;
  double      *first, gas = 0.0, apart = 0.0;
  ClStatus     status;

  (void)state;
  SceneInit(s, HAS_ALL, false, true, BASIS_CPGIMP, 0.1, lower, upper);
  s->c.scene.stabilisation.donor = true;
  SceneLayers(s, 1, 0.16, 1e-3);
  AddFace(s, BC_PRESSURE, SIDE_XMIN, 3e6, 0.0);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, m));
  RandomHistory(s, 0.2);
  RandomStage(s, 20.0);
  const PetscInt n = m->map.n_local * PHASE_COUNT;
  Call(PetscMalloc1(n, &first));
  Call(PetscArraycpy(first, m->wall, n));
  Call(ModelBeginStep(m, &status));
  Check(status == CL_OK && m->map.n_local * PHASE_COUNT == n);
  for (PetscInt i = PHASE_G; i < n; i += PHASE_COUNT) {
    gas   = fmax(gas, m->wall[i]);
    apart = fmax(apart, fabs(first[i] - m->wall[i]));
  }
  Say("wall of a well, gas of donors: drag up to %.3e Pa s m, begun again %.1e apart\n", Largest(gas), Largest(apart));
  Check(Largest(gas) > 0.0 && Largest(apart) == 0.0);
  Call(PetscFree(first));
  SceneDestroy(s);
  free(s);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestJacobian),     cmocka_unit_test(TestLayersJacobian), cmocka_unit_test(TestTotalJacobian),
      cmocka_unit_test(TestBedsJacobian), cmocka_unit_test(TestBedsTurn),       cmocka_unit_test(TestBorders),
      cmocka_unit_test(TestPlates),       cmocka_unit_test(TestMassRows),       cmocka_unit_test(TestTwoLayers),
      cmocka_unit_test(TestHydrostatic),  cmocka_unit_test(TestUniformStress),  cmocka_unit_test(TestDarcy),
      cmocka_unit_test(TestHeatFlux),     cmocka_unit_test(TestNewtonOrder),    cmocka_unit_test(TestSlaved),
      cmocka_unit_test(TestCopyByRows),   cmocka_unit_test(TestWallOfDonors),
  };

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
