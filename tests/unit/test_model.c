/* Tests of src/model, src/boundary as a whole: exact Jacobian, states of rest, patch tests, conservation, Newton's
   order. Scenes are built in memory; every random number belongs to a particle's id or a grid node, so that any number
   of ranks sees the same problem. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <cmocka.h>
#include "clathra/model.h"
#include "clathra/tensor.h"
#include "random.h"
#include "ranks.h"
#include "sediment.h"

#define Say(...) Call(PetscPrintf(PETSC_COMM_WORLD, __VA_ARGS__))

/* In [-1, 1), the same on every rank. */
static double Noise(int seed, PetscInt a, PetscInt b)
{
  Rng r = {0x9E3779B97F4A7C15ULL * (uint64_t)(seed + 1) + 0xBF58476D1CE4E5B9ULL * (uint64_t)(a + 7) +
           0x94D049BB133111EBULL * (uint64_t)(b + 11)};

  for (int k = 0; k < 4; k++)
    (void)RngUnit(&r);
  return 2.0 * RngUnit(&r) - 1.0;
}

static double Largest(double v)
{
  Call(MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  return v;
}

static double Sum(double v)
{
  Call(MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return v;
}

/* ---------------------------------------------------------------- scenes */
#define MAX_BC 16

typedef struct {
  Case     c;
  Material mat[2];
  Region   region[2];
  Bc       bc[MAX_BC];
  double   number[2 * MAX_BC], zero; /* values of constant schedules */
  Model    m;
  Stage    stage;
} Scene;

static Material MakeMaterial(void)
{
  Material m = SedimentMaterial();

  m.kappa_w         = 0.6;
  m.permeability.k0 = 1.53e-13;
  return m;
}

/* Grid of 6 x 4 cells of 0.1 m x 0.08 m with one region; conditions are added afterwards. */
static void SceneInit(Scene *s, BasisType basis, const double lower[2], const double upper[2])
{
  memset(s, 0, sizeof(*s));
  s->c      = (Case){.lower               = {0.0, 0.0},
                     .upper               = {0.6, 0.32},
                     .cells               = {6, 4},
                     .basis               = basis,
                     .nmaterial           = 2,
                     .nregion             = 1,
                     .material            = s->mat,
                     .region              = s->region,
                     .bc                  = s->bc,
                     .ghost_penalty       = 0.1,
                     .pressure_projection = 1.0,
                     .flux_interpolation  = true,
                     .inertia             = true,
                     .fields              = *AllFields()};
  s->mat[0] = s->mat[1] = MakeMaterial();
  for (int r = 0; r < 2; r++) {
    s->region[r] = (Region){.ppc = {2, 2}, .pressure = 3.25e6, .temperature = 4.0, .Sw = 0.6, .Sg = 0.4, .material = r};
    for (int d = 0; d < 2; d++) {
      s->region[r].lower[d] = lower[d];
      s->region[r].upper[d] = upper[d];
    }
  }
}

static Schedule Constant(Scene *s, int which, double v)
{
  double *y = &s->number[2 * s->c.nbc + which];

  *y = v;
  return (Schedule){1, &s->zero, y, false};
}

static Bc *AddFace(Scene *s, BcType type, Side side, double value, double shear)
{
  Bc *b = &s->bc[s->c.nbc];

  *b       = (Bc){.type = type, .side = side, .region = -1, .from = -INFINITY, .to = INFINITY, .alpha = 40.0};
  b->value = Constant(s, 0, value);
  b->shear = Constant(s, 1, shear);
  s->c.nbc++;
  return b;
}

static void AddPlane(Scene *s, BcType type, PetscInt axis, double position, double value)
{
  s->bc[s->c.nbc]       = (Bc){.type = type, .axis = axis, .position = position, .region = -1};
  s->bc[s->c.nbc].value = Constant(s, 0, value);
  s->c.nbc++;
}

static const Material *MaterialOf(const Scene *s, PetscInt p)
{
  return &s->mat[s->region[s->m.P.i[PI_REGION][p]].material];
}

/* Masses and saturations that belong to a particle's pressures. */
static void Refill(Scene *s, PetscInt p, double Sh)
{
  double *const *f = s->m.P.f;
  const double   V = f[P_V][p], T = f[P_T][p];
  double         d;

  InitialMasses(MaterialOf(s, p), V, MaterialOf(s, p)->porosity, Sh, f[P_PW][p], f[P_PG][p], T, &f[P_MS][p],
                &f[P_MH][p], &f[P_MW][p], &f[P_MG][p]);
  f[P_SH][p] = Sh;
  f[P_SW][p] = (1.0 - Sh) * (1.0 - RetentionGasShare(&MaterialOf(s, p)->retention, f[P_PG][p] - f[P_PW][p], &d));
}

/* Nodal and particle arrays of a stage that starts from the state at t_n at rest. */
static void StageStart(Scene *s, double dt)
{
  Model   *m = &s->m;
  ClStatus status;

  Call(ModelBeginStep(m, &status));
  Check(status == CL_OK);
  s->stage = (Stage){.t = dt, .dt = dt};
  Call(PetscMalloc3(m->map.n_local * F_COUNT, &s->stage.x_star, m->map.n_local * CL_DIM, &s->stage.u_star, 3 * m->P.n,
                    &s->stage.m_star));
  Call(PetscArraycpy(s->stage.x_star, m->x_n, m->map.n_local * F_COUNT));
  Call(PetscArrayzero(s->stage.u_star, m->map.n_local * CL_DIM));
  for (PetscInt k = 0; k < 3 * m->P.n; k++)
    s->stage.m_star[k] = m->P.f[P_MH + k % 3][k / 3];
}

static void SceneDestroy(Scene *s)
{
  Call(PetscFree3(s->stage.x_star, s->stage.u_star, s->stage.m_star));
  Call(ModelDestroy(&s->m));
}

/* The solver is made by the first ModelSolve: one iteration, whatever comes of it. */
static void MakeSolver(Scene *s)
{
  double  *x;
  PetscInt newton;
  ClStatus status;

  Call(PetscOptionsSetValue(NULL, "-snes_max_it", "1"));
  Call(PetscMalloc1(s->m.map.n_local * F_COUNT, &x));
  Call(PetscArraycpy(x, s->m.x_n, s->m.map.n_local * F_COUNT));
  Call(ModelSolve(&s->m, x, &newton, &status));
  Call(PetscOptionsClearValue(NULL, "-snes_max_it"));
  Call(SNESSetTolerances(s->m.snes, 0.0, 0.0, 0.0, 15, 10000));
  Call(PetscFree(x));
}

static void SetX(Model *m, const double *x)
{
  double *a;

  Call(VecGetArrayWrite(m->X, &a));
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++)
    a[k] = x[k] / m->col_scale[k];
  Call(VecRestoreArrayWrite(m->X, &a));
}

/* ---------------------------------------------------------------- (a) Jacobian */
/* Random history: everything that a run could have left on a particle. */
static void RandomHistory(Scene *s, double Sh)
{
  double *const *f = s->m.P.f;

  for (PetscInt p = 0; p < s->m.P.n; p++) {
    const PetscInt id = s->m.P.i[PI_ID][p];

    for (int d = 0; d < 2; d++) {
      f[P_X + d][p] += 0.2 * f[P_L + d][p] * Noise(1, id, d);
      f[P_L + d][p] *= 1.0 + 0.05 * Noise(2, id, d);
      f[P_GW + d][p] = 2e5 * Noise(3, id, d);
      f[P_GG + d][p] = 2e5 * Noise(4, id, d);
      f[P_GT + d][p] = 5.0 * Noise(5, id, d);
    }
    for (int k = 0; k < 6; k++) {
      f[P_VS + k][p]   = 1e-4 * Noise(6, id, k);
      f[P_SIG + k][p]  = 2e6 * Noise(7, id, k);
      f[P_SIG0 + k][p] = 1e6 * Noise(8, id, k);
    }
    f[P_PW][p] += 2e5 * Noise(9, id, 0);
    f[P_PG][p] = f[P_PW][p] + 8e4 * (1.5 + Noise(9, id, 1));
    f[P_T][p] += Noise(9, id, 2);
    Refill(s, p, Sh * (1.0 + 0.5 * Noise(9, id, 3)));
  }
}

/* Unknowns around the start values: strains of a percent or so, 0.2 MPa, 1 K; the capillary pressure moves by 20 kPa,
   which keeps it away from the threshold of gas mobility (a kink). */
static void RandomUnknowns(const Model *m, double dt, int seed, double *x)
{
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const PetscInt node = m->map.ij[I][0] + 100 * m->map.ij[I][1];

    for (int q = 0; q < F_COUNT; q++) {
      const double size = q < F_VWX ? 2e-4 / dt : q < F_PW ? 1e-4 : q == F_PW ? 2e5 : q == F_PG ? 2e4 : 1.0;

      x[I * F_COUNT + q] = m->x_n[I * F_COUNT + q] + size * Noise(seed, node, q);
    }
    x[I * F_COUNT + F_PG] += 2e5 * Noise(seed, node, F_PW);
  }
}

static void RandomStage(Scene *s, double dt)
{
  Model *m = &s->m;

  StageStart(s, dt);
  RandomUnknowns(m, dt, 20, s->stage.x_star);
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int d = 0; d < CL_DIM; d++)
      s->stage.u_star[I * CL_DIM + d] = 2e-4 * Noise(21 + d, m->map.ij[I][0], m->map.ij[I][1]);
  }
  for (PetscInt k = 0; k < 3 * m->P.n; k++)
    s->stage.m_star[k] *= 1.0 + 0.02 * Noise(23, m->P.i[PI_ID][k / 3], k % 3);
  Call(ModelBeginStage(m, &s->stage));
}

/* Every kind of condition occurs in one of the two sets. */
static void AddConditions(Scene *s, int set)
{
  if (set == 0) {
    AddPlane(s, BC_ROLLER, 0, 0.0, 0.0);
    AddPlane(s, BC_FIXED, 1, 0.0, 0.0);
    AddFace(s, BC_TRACTION, SIDE_XMAX, 3e6, 5e5);
    AddFace(s, BC_PRESSURE, SIDE_XMAX, 3e6, 0.0)->initial = true;
    AddFace(s, BC_CONVECTION, SIDE_XMAX, 10.0, 0.0);
    AddFace(s, BC_HEAT_FLUX, SIDE_YMAX, 300.0, 0.0)->to = 0.25;
  } else {
    AddPlane(s, BC_PLATE, 0, 0.0, 2e-5);
    AddPlane(s, BC_TEMPERATURE, 0, 0.0, 5.0);
    AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
    AddFace(s, BC_TRACTION, SIDE_YMAX, 4e6, -7e5)->from = 0.2;
    AddFace(s, BC_PRESSURE, SIDE_YMAX, 3.6e6, 0.0);
    AddFace(s, BC_FACE_TEMPERATURE, SIDE_YMAX, 6.0, 0.0);
    AddFace(s, BC_HEAT_FLUX, SIDE_XMAX, -200.0, 0.0);
    AddFace(s, BC_CONVECTION, SIDE_XMAX, 8.0, 0.0);
  }
}

static void JacobianScene(Scene *s, BasisType basis, bool reacts, int set)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.47, 0.18}; /* the free sides cut cells */

  SceneInit(s, basis, lower, upper);
  s->mat[0].reacts               = reacts;
  s->mat[0].elasticity.loss_only = set;
  s->c.gravity[0]                = 2.0;
  s->c.gravity[1]                = -9.81;
  s->c.flux_interpolation        = !(set == 1 && !reacts);
  s->c.upstream                  = reacts;
  s->region[0].pressure          = reacts && set ? 2.6e6 : 4.8e6; /* dissociating, forming */
  AddConditions(s, set);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
  RandomHistory(s, 0.2);
  RandomStage(s, 20.0);
  Check((PetscInt)Sum((double)s->m.nghost) > 0 && (PetscInt)Sum((double)s->m.ncell) > 0);
  double upstream = 0.0;
  for (PetscInt k = 0; k < 2 * s->m.map.n_owned; k++)
    upstream += s->m.up[3 * k + 2] > 0.0;
  Check((Sum(upstream) > 0.0) == reacts);
  MakeSolver(s);
}

/* (R(X + t D) - R(X - t D))/2t, extrapolated from steps t, t/2, t/4, ...: each row keeps its best value. */
#define LEVELS 7
static void Difference(Model *m, Vec X, Vec D, double t, double *dy)
{
  const PetscInt n = m->map.n_owned * F_COUNT;
  double        *a[LEVELS][LEVELS], *err;
  const double  *up, *down;
  Vec            Xt, Ru, Rd;

  Call(PetscMalloc1(n, &err));
  Call(VecDuplicate(X, &Xt));
  Call(VecDuplicate(X, &Ru));
  Call(VecDuplicate(X, &Rd));
  for (PetscInt i = 0; i < n; i++)
    err[i] = INFINITY;
  for (int l = 0; l < LEVELS; l++, t *= 0.5) {
    Call(VecWAXPY(Xt, t, D, X));
    Call(ModelResidual(NULL, Xt, Ru, m));
    Call(VecWAXPY(Xt, -t, D, X));
    Call(ModelResidual(NULL, Xt, Rd, m));
    Check(m->status == CL_OK);
    for (int k = 0; k <= l; k++)
      Call(PetscMalloc1(n, &a[l][k]));
    Call(VecGetArrayRead(Ru, &up));
    Call(VecGetArrayRead(Rd, &down));
    for (PetscInt i = 0; i < n; i++) {
      double factor = 4.0;

      a[l][0][i] = (up[i] - down[i]) / (2.0 * t);
      for (int k = 1; k <= l; k++, factor *= 4.0) {
        a[l][k][i]     = (factor * a[l][k - 1][i] - a[l - 1][k - 1][i]) / (factor - 1.0);
        const double e = fmax(fabs(a[l][k][i] - a[l][k - 1][i]), fabs(a[l][k][i] - a[l - 1][k - 1][i]));

        if (e < err[i]) {
          err[i] = e;
          dy[i]  = a[l][k][i];
        }
      }
    }
    Call(VecRestoreArrayRead(Ru, &up));
    Call(VecRestoreArrayRead(Rd, &down));
  }
  for (int l = 0; l < LEVELS; l++) {
    for (int k = 0; k <= l; k++)
      Call(PetscFree(a[l][k]));
  }
  Call(PetscFree(err));
  Call(VecDestroy(&Xt));
  Call(VecDestroy(&Ru));
  Call(VecDestroy(&Rd));
}

/* J at X = a random state. */
static void PrepareJacobian(Scene *s, Vec *X, Vec *D, Vec *JD)
{
  Model  *m = &s->m;
  double *x;

  Call(PetscMalloc1(m->map.n_local * F_COUNT, &x));
  RandomUnknowns(m, s->stage.dt, 30, x);
  SetX(m, x);
  Call(PetscFree(x));
  Call(VecDuplicate(m->X, X));
  Call(VecDuplicate(m->X, D));
  Call(VecDuplicate(m->X, JD));
  Call(VecCopy(m->X, *X));
  Call(ModelResidual(NULL, *X, m->R, m));
  if (m->status != CL_OK)
    Say("  inadmissible: %s\n", m->why);
  Check(m->status == CL_OK);
  Call(ModelJacobian(m->snes, *X, m->A, m->Pmat, m));
}

/* Largest |a - b| of each equation over the largest |b| of that equation. */
static double FieldError(const Model *m, Vec JD, const double *dy)
{
  double        error[F_COUNT] = {0.0}, size[F_COUNT] = {0.0}, worst = 0.0;
  const double *a;

  Call(VecGetArrayRead(JD, &a));
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++) {
    error[k % F_COUNT] = fmax(error[k % F_COUNT], fabs(a[k] - dy[k]));
    size[k % F_COUNT]  = fmax(size[k % F_COUNT], fabs(dy[k]));
  }
  Call(VecRestoreArrayRead(JD, &a));
  for (int q = 0; q < F_COUNT; q++)
    worst = fmax(worst, Largest(error[q]) / Largest(size[q]));
  return worst;
}

static double DirectionError(Scene *s, int directions)
{
  Model *m     = &s->m;
  double worst = 0.0, *dy, *d;
  Vec    X, D, JD;

  PrepareJacobian(s, &X, &D, &JD);
  Call(PetscMalloc1(m->map.n_owned * F_COUNT, &dy));
  for (int n = 0; n < directions; n++) {
    Call(VecGetArrayWrite(D, &d));
    for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++)
      d[k] = Noise(40 + n, m->map.ij[k / F_COUNT][0] + 100 * m->map.ij[k / F_COUNT][1], k % F_COUNT);
    Call(VecRestoreArrayWrite(D, &d));
    Call(MatMult(m->A, D, JD));
    Difference(m, X, D, 4e-3, dy);
    worst = fmax(worst, FieldError(m, JD, dy));
  }
  Call(PetscFree(dy));
  Call(VecDestroy(&X));
  Call(VecDestroy(&D));
  Call(VecDestroy(&JD));
  return worst;
}

/* Every entry, relative to the largest of its row. */
static double ColumnError(Scene *s)
{
  Model         *m = &s->m;
  const PetscInt n = m->map.n_owned * F_COUNT, N = m->map.n_global * F_COUNT;
  double        *dy, *error, *top, worst = 0.0;
  const double  *a;
  Vec            X, D, JD;

  PrepareJacobian(s, &X, &D, &JD);
  Call(PetscMalloc1(n, &dy));
  Call(PetscCalloc2(n, &error, n, &top));
  for (PetscInt c = 0; c < N; c++) {
    Call(VecSet(D, 0.0));
    if (c >= m->map.first * F_COUNT && c < m->map.first * F_COUNT + n)
      Call(VecSetValue(D, c, 1.0, INSERT_VALUES));
    Call(VecAssemblyBegin(D));
    Call(VecAssemblyEnd(D));
    Call(MatMult(m->A, D, JD));
    Difference(m, X, D, c % F_COUNT < F_PW ? 1e-1 : 2e-2, dy);
    Call(VecGetArrayRead(JD, &a));
    for (PetscInt k = 0; k < n; k++) {
      error[k] = fmax(error[k], fabs(a[k] - dy[k]));
      top[k]   = fmax(top[k], fabs(dy[k]));
    }
    Call(VecRestoreArrayRead(JD, &a));
  }
  for (PetscInt k = 0; k < n; k++)
    worst = fmax(worst, error[k] / top[k]);
  Call(PetscFree(dy));
  Call(PetscFree2(error, top));
  Call(VecDestroy(&X));
  Call(VecDestroy(&D));
  Call(VecDestroy(&JD));
  return Largest(worst);
}

static const char *const basis_name[3] = {"cpgimp", "ugimp", "linear"};

static void TestJacobian(void **state)
{
  (void)state;
  Say("Jacobian (shell) against differences: random directions; every entry relative to the largest of its row\n");
  for (int basis = 0; basis < 3; basis++) {
    for (int k = 0; k < 4; k++) {
      Scene *s = malloc(sizeof(*s));

      JacobianScene(s, (BasisType)basis, k / 2, k % 2);
      const double worst = DirectionError(s, 3), entry = k == 2 + basis % 2 ? ColumnError(s) : 0.0;
      Say("  %-6s kinetics %-3s conditions %d: directions %.1e", basis_name[basis], k / 2 ? "on" : "off", k % 2, worst);
      Say(entry > 0.0 ? ", entries %.1e\n" : "\n", entry);
      Check(worst < 1e-6 && entry < 1e-6);
      SceneDestroy(s);
      free(s);
    }
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
    Scene       *s = malloc(sizeof(*s));
    Model       *m = &s->m;
    double      *x, mass[2] = {0.0}, gain[2] = {0.0};
    const double nu[2] = {6.0 * 0.018 / 0.124, 0.016 / 0.124};
    Trial        t;
    StageRates   rates;
    ClStatus     status;

    JacobianScene(s, (BasisType)(k % 3), k % 4 >= 2, k % 2);
    Call(PetscMalloc1(m->map.n_local * F_COUNT, &x));
    Call(PetscMalloc4(3 * m->P.n, &t.m, 4 * m->P.n, &t.y, 2 * m->P.n, &t.u, 2 * m->P.n, &t.v));
    RandomUnknowns(m, s->stage.dt, 50 + k, x);
    SetX(m, x);
    Call(ModelResidual(NULL, m->X, m->R, m));
    Check(m->status == CL_OK);
    Call(ModelEndStage(m, x, &t, &rates, &status));
    Check(status == CL_OK);
    for (PetscInt p = 0; p < m->P.n; p++) {
      const double h = s->mat[0].reacts ? t.m[3 * p] - s->stage.m_star[3 * p] : 0.0;

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
/* Largest scaled residual of the equations in [from, to): momentum in units of 1 MPa over a cell, mass and heat in what
   1 MPa and 1 K store. */
static double ResidualAt(Scene *s, const double *x, int from, int to)
{
  Model        *m = &s->m;
  const double *a;
  double        worst = 0.0;

  if (!m->X)
    MakeSolver(s);
  SetX(m, x);
  Call(ModelResidual(NULL, m->X, m->R, m));
  Check(m->status == CL_OK);
  Call(VecGetArrayRead(m->R, &a));
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++) {
    if (k % F_COUNT >= from && k % F_COUNT < to)
      worst = fmax(worst, fabs(a[k]));
  }
  Call(VecRestoreArrayRead(m->R, &a));
  return Largest(worst);
}

/* Newton from a perturbed first guess must come back to rest: the largest velocity in units of its column scale, the
   velocity that makes 1 MPa in the step (immobile gas moves with the skeleton, whose scale then counts). */
static double RestVelocity(Scene *s, double *scale)
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
  m->tol_residual = 2e-12; /* and a twentieth of it in mass and energy */
  Call(ModelSolve(m, x, &newton, &status));
  if (status != CL_OK)
    Say("  %s\n", m->why);
  Check(status == CL_OK && newton > 0);
  for (PetscInt k = 0; k < m->map.n_owned * F_COUNT; k++) {
    if (k % F_COUNT < F_PW)
      worst = fmax(worst, fabs(x[k]) / fmax(m->col_scale[k], m->col_scale[k - k % F_COUNT]));
    if (k % F_COUNT < F_VWX)
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
    Scene *s = malloc(sizeof(*s));
    double scale;

    SceneInit(s, (BasisType)basis, lower, upper);
    s->c.nregion           = 2;
    s->region[1].lower[1]  = 0.13;
    s->region[1].upper[1]  = 0.25;
    s->mat[1].retention.m  = 0.6;
    s->mat[1].retention.p0 = 2e5;
    s->mat[1].porosity     = 0.45;
    AddPlane(s, BC_ROLLER, 0, 0.0, 0.0);
    AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
    AddFace(s, BC_TRACTION, SIDE_XMAX, q, 0.0);
    AddFace(s, BC_TRACTION, SIDE_YMAX, q, 0.0);
    AddFace(s, BC_PRESSURE, SIDE_YMAX, 0.0, 0.0)->initial = true;
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      double *const *f = s->m.P.f;
      double         d;

      f[P_PW][p] = f[P_PW0][p] = 3.2e6;
      f[P_PG][p] = f[P_PG0][p] = 3.3e6;
      Refill(s, p, s->m.P.i[PI_REGION][p] ? 0.3 : 0.0);
      const double sg = RetentionGasShare(&MaterialOf(s, p)->retention, 1e5, &d);
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
static void HydrostaticScene(Scene *s, BasisType basis)
{
  const double lower[2] = {0.0, 0.0}, upper[2] = {0.5, 0.24}, g = 9.81;
  Material    *mat = &s->mat[0];

  SceneInit(s, basis, lower, upper);
  Check(RetentionSetType(&mat->retention, "van_genuchten_clamped"));
  mat->retention.Sgr = 0.05;
  mat->water.K       = INFINITY;
  mat->gas.M         = 1e-18;
  s->c.gravity[1]    = -g;
  s->region[0].Sg    = 0.05;
  s->region[0].Sw    = 0.95;
  AddPlane(s, BC_ROLLER, 0, 0.0, 0.0);
  AddPlane(s, BC_ROLLER, 0, 0.5, 0.0);
  AddPlane(s, BC_FIXED, 1, 0.0, 0.0);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
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
    Scene *s = malloc(sizeof(*s));
    double scale;

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
  for (int k = 0; k < 4; k++) {
    Scene *s = malloc(sizeof(*s));

    SceneInit(s, k / 2 ? BASIS_UGIMP : BASIS_CPGIMP, box[k % 2], box[k % 2] + 2);
    /* normal stress is compression-positive; the shear acts along the normal turned by +90 degrees */
    AddFace(s, BC_TRACTION, SIDE_XMIN, p - sxx, sxy);
    AddFace(s, BC_TRACTION, SIDE_XMAX, p - sxx, sxy);
    AddFace(s, BC_TRACTION, SIDE_YMIN, p - syy, -sxy);
    AddFace(s, BC_TRACTION, SIDE_YMAX, p - syy, -sxy);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
    for (PetscInt i = 0; i < s->m.P.n; i++) {
      s->m.P.f[P_SIG + XX][i] = sxx;
      s->m.P.f[P_SIG + YY][i] = syy;
      s->m.P.f[P_SIG + XY][i] = sxy;
    }
    StageStart(s, 10.0);
    Call(ModelBeginStage(&s->m, &s->stage));
    const double residual = ResidualAt(s, s->m.x_n, 0, F_COUNT);
    Say("uniform stress, %-6s, %s: residual %.1e of 1 MPa\n", basis_name[k / 2],
        k % 2 ? "across cells" : "on the grid ", residual);
    Check(residual < 1e-13);
    SceneDestroy(s);
    free(s);
  }
}

/* Linear p in x and the velocity of Darcy's law: every water row is zero. */
static void TestDarcy(void **state)
{
  const double lower[2] = {0.1, 0.08}, upper[2] = {0.5, 0.24}, slope = 2e6;
  Scene       *s   = malloc(sizeof(*s));
  Material    *mat = &s->mat[0];
  double      *x, d, e;

  (void)state;
  SceneInit(s, BASIS_CPGIMP, lower, upper);
  Check(RetentionSetType(&mat->retention, "van_genuchten_clamped"));
  mat->water.K = INFINITY;
  AddFace(s, BC_PRESSURE, SIDE_XMIN, 3e6 + slope * 0.1, 0.0);
  AddFace(s, BC_PRESSURE, SIDE_XMAX, 3e6 + slope * 0.5, 0.0);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    double *const *f = s->m.P.f;

    f[P_PW][p] = f[P_PG][p] = 3e6 + slope * f[P_X][p];
    f[P_GW][p] = f[P_GG][p] = slope;
    f[P_PW0][p] = f[P_PG0][p] = 1e6;
    Refill(s, p, 0.0);
  }
  StageStart(s, 1e3);
  const double sw = 1.0 - RetentionGasShare(&mat->retention, 0.0, &d),
               k  = PermeabilityEvaluate(&mat->permeability, 0.3, 0.0, &d, &e);
  const double v  = -k * RelPermWater(&mat->relperm, sw, &d) / mat->mu_w * slope / (0.3 * sw);
  Call(PetscMalloc1(s->m.map.n_local * F_COUNT, &x));
  for (PetscInt I = 0; I < s->m.map.n_local; I++)
    s->m.x_n[I * F_COUNT + F_VWX] = s->stage.x_star[I * F_COUNT + F_VWX] = v;
  Call(PetscArraycpy(x, s->m.x_n, s->m.map.n_local * F_COUNT));
  Call(ModelBeginStage(&s->m, &s->stage));
  const double force = ResidualAt(s, x, F_VWX, F_VGX);
  double       scale = 0.0; /* kg; what flows through a square metre in the step is 1e3 s x 1e3 kg/m^3 x J */
  for (PetscInt I = 0; I < s->m.map.n_local; I++)
    scale = fmax(scale, s->m.row_scale[I * F_COUNT + F_PW]);
  const double mass = ResidualAt(s, x, F_PW, F_PG) * scale / (1e6 * fabs(v) * 0.3 * sw * s->m.grid.h[1]);
  for (PetscInt I = 0; I < s->m.map.n_local; I++)
    x[I * F_COUNT + F_VWX] *= 1.001; /* the rows do see the velocity */
  const double seen = ResidualAt(s, x, F_VWX, F_VGX);
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
    Scene *s = malloc(sizeof(*s));
    double d[3];

    SceneInit(s, BASIS_CPGIMP, lower, upper);
    Material *mat   = &s->mat[0];
    mat->solid.beta = mat->hydrate.beta = mat->water.beta = 0.0;
    const double X[4]                                     = {mat->kappa_s, mat->kappa_h, mat->kappa_w, mat->kappa_g};
    const double kappa                                    = MixtureAverage(0.3, 0.0, 0.6, X, &d[0], &d[1], &d[2]);
    for (int side = 0; side < SIDE_COUNT; side++)
      AddFace(s, BC_HEAT_FLUX, (Side)side, (side % 2 ? 1.0 : -1.0) * kappa * slope[side / 2], 0.0);
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
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
  Scene       *s = malloc(sizeof(*s));
  double      *x, history[50] = {0.0}, best = 0.0;
  PetscInt     newton, n;
  ClStatus     status;

  (void)state;
  SceneInit(s, BASIS_CPGIMP, lower, upper);
  s->mat[0].reacts          = true;
  s->mat[0].permeability.k0 = 1.53e-15;
  AddPlane(s, BC_FIXED, 0, 0.0, 0.0);
  AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
  AddPlane(s, BC_ROLLER, 1, 0.16, 0.0);
  AddFace(s, BC_TRACTION, SIDE_XMAX, 5.25e6, 0.0);
  AddFace(s, BC_PRESSURE, SIDE_XMAX, 0.0, 0.0)->initial = true;
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c, &s->m));
  StageStart(s, 50.0);
  Call(ModelBeginStage(&s->m, &s->stage));
  MakeSolver(s);
  s->m.tol_residual = 1e-11;
  Call(SNESSetConvergenceHistory(s->m.snes, history, NULL, 50, PETSC_TRUE));
  Call(PetscMalloc1(s->m.map.n_local * F_COUNT, &x));
  Call(PetscArraycpy(x, s->m.x_n, s->m.map.n_local * F_COUNT));
  Call(ModelSolve(&s->m, x, &newton, &status));
  Call(SNESGetConvergenceHistory(s->m.snes, NULL, NULL, &n));
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

/* Linear systems solved as well as can be, with factors of each iteration's own matrix: Newton's method undisturbed. */
static PetscErrorCode SetOptions(void)
{
  PetscFunctionBeginUser;
  PetscCall(PetscOptionsSetValue(NULL, "-ksp_rtol", "1e-10"));
  PetscCall(PetscOptionsSetValue(NULL, "-ksp_atol", "1e-14"));
  PetscCall(PetscOptionsSetValue(NULL, "-newton_refactor", "0"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(TestJacobian),    cmocka_unit_test(TestMassRows),      cmocka_unit_test(TestTwoLayers),
      cmocka_unit_test(TestHydrostatic), cmocka_unit_test(TestUniformStress), cmocka_unit_test(TestDarcy),
      cmocka_unit_test(TestHeatFlux),    cmocka_unit_test(TestNewtonOrder),
  };
  int failed;

  if (PetscInitialize(&argc, &argv, NULL, NULL) || MPI_Comm_rank(PETSC_COMM_WORLD, &world_rank) ||
      MPI_Comm_size(PETSC_COMM_WORLD, &world_size) || SetOptions())
    return 1;
  failed = cmocka_run_group_tests(tests, NULL, NULL);
  if (PetscFinalize())
    return 1;
  return failed;
}
