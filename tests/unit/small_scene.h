/* Shared by the unit tests of the model, of field sets and of axisymmetry: scenes built in memory for any field set and
   geometry, with random states that are the same on any number of ranks, and the Jacobian against differences.  Include
   after cmocka.h. */
#pragma once

#include <stdlib.h>
#include "clathra/case.h"
#include "clathra/model.h"
#include "model/solver.h"
#include "random.h"
#include "ranks.h"
#include "sediment.h"

#define Say(...) Call(PetscPrintf(PETSC_COMM_WORLD, __VA_ARGS__))

static const char *const basis_name[3] = {"cpgimp", "ugimp", "linear"};

/* In [-1, 1), the same on every rank. */
static inline double Noise(int seed, PetscInt a, PetscInt b)
{
  Rng r = {0x9E3779B97F4A7C15ULL * (uint64_t)(seed + 1) + 0xBF58476D1CE4E5B9ULL * (uint64_t)(a + 7) +
           0x94D049BB133111EBULL * (uint64_t)(b + 11)};

  for (int k = 0; k < 4; k++)
    (void)RngUnit(&r);
  return 2.0 * RngUnit(&r) - 1.0;
}

static inline double Largest(double v)
{
  Call(MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_MAX, PETSC_COMM_WORLD));
  return v;
}

static inline double Sum(double v)
{
  Call(MPI_Allreduce(MPI_IN_PLACE, &v, 1, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return v;
}

/* ---------------------------------------------------------------- scenes */
#define MAX_BC 16

typedef struct {
  Case     c;
  Material mat;
  Region   region;
  Bc       bc[MAX_BC];
  double   number[2 * MAX_BC], zero; /* values of constant schedules */
  Material pair[2];                  /* of two layers */
  Region   half[2];
  Model    m;
  Stage    stage;
  Product *product; /* of PrepareJacobian, where the solver's operator is assembled */
} SmallScene;

#define DEPTH 3 /* cells of 0.06 m along z, where there is one */

/* Grid of 6 x 4 cells of 0.1 m x 0.08 m from x = `start`, with one region, which in space does not fill the grid along
   z; conditions are added afterwards. */
static inline void SceneInit(SmallScene *s, unsigned has, bool inertia, bool axisymmetric, BasisType basis,
                             double start, const double lower[2], const double upper[2])
{
  memset(s, 0, sizeof(*s));
  s->c = (Case){.scene.lower                       = {start, 0.0},
                .scene.upper                       = {start + 0.6, 0.32},
                .scene.cells                       = {6, 4},
                .scene.basis                       = basis,
                .scene.axisymmetric                = axisymmetric,
                .scene.inertia                     = inertia,
                .scene.nmaterial                   = 1,
                .scene.nregion                     = 1,
                .scene.material                    = &s->mat,
                .scene.region                      = &s->region,
                .scene.bc                          = s->bc,
                .scene.stabilisation.ghost_penalty = 0.1};
  Check(FieldSetMake(has, inertia, &s->c.scene.fields));
  for (int d = 2; d < CL_DIM; d++) {
    s->c.scene.upper[d] = 0.06 * DEPTH;
    s->c.scene.cells[d] = DEPTH;
  }
  s->mat                 = SedimentMaterial();
  s->mat.kappa_w         = 0.6;
  s->mat.permeability.k0 = 1.53e-13;
  if (has & HAS_GAS)
    SetSolubility(&s->mat.gas, 1.9e-5);
  s->region = (Region){.ppc         = {2, 2},
                       .lower       = {start + lower[0], lower[1]},
                       .upper       = {start + upper[0], upper[1]},
                       .pressure    = 3.25e6,
                       .temperature = 4.0};
  for (int d = 2; d < CL_DIM; d++) {
    s->region.upper[d] = 0.13;
    s->region.ppc[d]   = 2;
  }
  s->region.Sw = s->c.scene.fields.phase[PHASE_G] ? 0.6 : s->c.scene.fields.fluid ? 1.0 : 0.0;
  s->region.Sg = s->c.scene.fields.phase[PHASE_G] ? 0.4 : 0.0;
}

static inline Schedule Constant(SmallScene *s, int which, double v)
{
  double *y = &s->number[2 * s->c.scene.nbc + which];

  *y = v;
  return (Schedule){.n = 1, .t = &s->zero, .y = y};
}

static inline Bc *AddFace(SmallScene *s, BcType type, Side side, double value, double shear)
{
  Bc *b = &s->bc[s->c.scene.nbc];

  *b                 = (Bc){.type = type, .side = side, .region = -1, .from = -INFINITY, .to = INFINITY, .alpha = 40.0};
  b->value           = Constant(s, 0, value);
  b->shear           = Constant(s, 1, shear);
  b->number          = s->c.scene.nbc++;
  s->c.scene.listed  = s->bc;
  s->c.scene.nlisted = s->c.scene.nbc;
  return b;
}

static inline void AddPlane(SmallScene *s, BcType type, PetscInt axis, double position, double value)
{
  s->bc[s->c.scene.nbc]       = (Bc){.type = type, .axis = axis, .position = position, .region = -1};
  s->bc[s->c.scene.nbc].value = Constant(s, 0, value);
  s->c.scene.nbc++;
}

/* Makes two layers of the region, which meet at x or y = `at`; k0 of the second is `contrast` times that of the first.
   The material is as it is by now. */
static inline void SceneLayers(SmallScene *s, int axis, double at, double contrast)
{
  s->pair[0] = s->pair[1] = s->mat;
  s->half[0] = s->half[1] = s->region;
  s->half[0].upper[axis]  = at;
  s->half[1].lower[axis]  = at;
  s->half[1].material     = 1;
  s->pair[1].permeability.k0 *= contrast;
  s->c.scene.nmaterial = s->c.scene.nregion = 2;
  s->c.scene.material                       = s->pair;
  s->c.scene.region                         = s->half;
}

/* A test with more than one layer points s->c.region and s->c.material at its own. */
static inline const Region *RegionOf(const SmallScene *s, PetscInt p)
{
  return &s->c.scene.region[s->m.P.i[PI_REGION][p]];
}

static inline const Material *MaterialOf(const SmallScene *s, PetscInt p)
{
  return &s->c.scene.material[RegionOf(s, p)->material];
}

/* Masses and saturations that belong to a particle's pressures. */
static inline void Refill(SmallScene *s, PetscInt p, double Sh)
{
  const FieldSet *fs  = &s->c.scene.fields;
  const Region   *r   = RegionOf(s, p);
  const Material *mat = MaterialOf(s, p);
  double *const  *f   = s->m.P.f;
  const double    T = fs->heat ? f[P_T][p] : r->temperature, pw = fs->phase[PHASE_W] ? f[P_PW][p] : 0.0;
  const double    pg = f[P_PG] ? f[P_PG][p] : pw;
  double          m[4], sg = fs->phase[PHASE_G] ? r->Sg : 0.0;

  if (f[P_PG])
    sg = GasShareOf(mat, pg - pw, Sh);
  PointInitialMasses(fs, mat, &(PointStart){f[P_V][p], mat->porosity, Sh, sg, pw, pg, T}, m);
  for (int k = 0; k < 4; k++) {
    if (f[P_MS + k])
      f[P_MS + k][p] = m[k];
  }
  f[P_SH][p] = Sh;
  if (f[P_SW])
    f[P_SW][p] = (1.0 - Sh) * (1.0 - sg);
}

/* Nodal and particle arrays of a stage that starts from the state at t_n. */
static inline void StageStart(SmallScene *s, double dt)
{
  Model         *m = &s->m;
  const PetscInt n = m->c->fields.n;
  ClStatus       status;

  m->t_n = 1e9; /* long enough for heat to cross cells (382) */
  Call(ModelBeginStep(m, &status));
  if (status != CL_OK)
    Say("  %s\n", m->failure.why);
  Check(status == CL_OK);
  s->stage = (Stage){.t = dt, .dt = dt};
  Call(PetscMalloc3(m->map.n_local * n, &s->stage.x_star, m->map.n_local * CL_DIM, &s->stage.u_star, 3 * m->P.n,
                    &s->stage.m_star));
  Call(PetscArraycpy(s->stage.x_star, m->x_n, m->map.n_local * n));
  Call(PetscArrayzero(s->stage.u_star, m->map.n_local * CL_DIM));
  for (PetscInt k = 0; k < 3 * m->P.n; k++)
    s->stage.m_star[k] = m->P.f[P_MH + k % 3] ? m->P.f[P_MH + k % 3][k / 3] : 0.0;
}

static inline void SceneDestroy(SmallScene *s)
{
  Call(PetscFree3(s->stage.x_star, s->stage.u_star, s->stage.m_star));
  Call(ProductDestroy(&s->product));
  Call(ModelDestroy(&s->m));
}

/* The solver is made by the first ModelSolve: one iteration, whatever comes of it. */
static inline void MakeSolver(SmallScene *s)
{
  const PetscInt n = s->m.map.n_local * s->c.scene.fields.n;
  double        *x;
  PetscInt       newton;
  ClStatus       status;

  Call(PetscOptionsSetValue(NULL, "-snes_max_it", "1"));
  Call(PetscMalloc1(n, &x));
  Call(PetscArraycpy(x, s->m.x_n, n));
  Call(ModelSolve(&s->m, x, &newton, &status));
  Call(PetscOptionsClearValue(NULL, "-snes_max_it"));
  Call(SNESSetTolerances(s->m.solver->snes, 0.0, 0.0, 0.0, 15, 10000));
  Call(PetscFree(x));
}

static inline void SetX(Model *m, const double *x)
{
  double *a;

  Call(VecGetArrayWrite(m->solver->X, &a));
  for (PetscInt k = 0; k < m->map.n_owned * m->c->fields.n; k++)
    a[k] = x[k] / m->col_scale[k];
  Call(VecRestoreArrayWrite(m->solver->X, &a));
}

/* Largest scaled residual of the equations of unknowns q in [from, to): momentum in units of 1 MPa over a cell, mass
   and heat in what 1 MPa and 1 K store. */
static inline double ResidualAt(SmallScene *s, const double *x, int from, int to)
{
  Model          *m  = &s->m;
  const FieldSet *fs = &m->c->fields;
  const double   *a;
  double          worst = 0.0;

  if (!m->solver->X)
    MakeSolver(s);
  SetX(m, x);
  Call(ModelResidual(NULL, m->solver->X, m->solver->R, m));
  Check(m->failure.status == CL_OK);
  Call(VecGetArrayRead(m->solver->R, &a));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++) {
    if (fs->field[k % fs->n] >= from && fs->field[k % fs->n] < to)
      worst = fmax(worst, fabs(a[k]));
  }
  Call(VecRestoreArrayRead(m->solver->R, &a));
  return Largest(worst);
}

/* ---------------------------------------------------------------- random states */
static inline void AddNoise(double *a, PetscInt p, double size, double noise)
{
  if (a)
    a[p] += size * noise;
}

/* Random history: everything that a run could have left on a particle. */
static inline void RandomHistory(SmallScene *s, double Sh)
{
  double *const *f = s->m.P.f;

  for (PetscInt p = 0; p < s->m.P.n; p++) {
    const PetscInt id = s->m.P.i[PI_ID][p];

    for (int d = 0; d < CL_DIM; d++) {
      f[P_X + d][p] += 0.2 * f[P_L + d][p] * Noise(1, id, d);
      f[P_L + d][p] *= 1.0 + 0.05 * Noise(2, id, d);
      AddNoise(f[P_GW + d], p, 2e5, Noise(3, id, d));
      AddNoise(f[P_GG + d], p, 2e5, Noise(4, id, d));
      AddNoise(f[P_GT + d], p, 5.0, Noise(5, id, d));
    }
    for (int k = 0; k < 3 * CL_DIM; k++)
      AddNoise(f[P_VS + k], p, 1e-4, Noise(6, id, k));
    for (int k = 0; k < 6; k++) {
      AddNoise(f[P_SIG + k], p, 2e6, Noise(7, id, k));
      AddNoise(f[P_SIG0 + k], p, 1e6, Noise(8, id, k));
    }
    AddNoise(f[P_PW], p, 2e5, Noise(9, id, 0));
    if (f[P_PG])
      f[P_PG][p] = f[P_PW][p] + 8e4 * (1.5 + Noise(9, id, 1));
    AddNoise(f[P_T], p, 1.0, Noise(9, id, 2));
    Refill(s, p, Sh * (1.0 + 0.5 * Noise(9, id, 3)));
  }
}

/* The same number on any number of ranks. */
static inline PetscInt NodeId(const Model *m, PetscInt I)
{
  PetscInt id = 0;

  for (int d = CL_DIM - 1; d >= 0; d--)
    id = 100 * id + m->map.ij[I][d];
  return id;
}

/* Unknowns around the start values: strains of a percent or so, 0.2 MPa, 1 K; the capillary pressure moves by 20 kPa,
   which keeps it away from the threshold of gas mobility (a kink). */
static inline void RandomUnknowns(const Model *m, double dt, int seed, double *x)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const PetscInt node = NodeId(m, I);

    for (int k = 0; k < fs->n; k++) {
      const int    q    = fs->field[k];
      const double size = q < F_VW ? 2e-4 / dt : q < F_PW ? 1e-4 : q == F_PW ? 2e5 : q == F_PG ? 2e4 : 1.0;

      x[I * fs->n + k] = m->x_n[I * fs->n + k] + size * Noise(seed, node, q);
      if (q == F_PG)
        x[I * fs->n + k] += 2e5 * Noise(seed, node, F_PW);
    }
  }
}

static inline void RandomStage(SmallScene *s, double dt)
{
  Model *m = &s->m;

  StageStart(s, dt);
  RandomUnknowns(m, dt, 20, s->stage.x_star);
  for (PetscInt I = 0; I < m->map.n_local && s->c.scene.fields.solid; I++) {
    for (int d = 0; d < CL_DIM; d++)
      s->stage.u_star[I * CL_DIM + d] =
          2e-4 * Noise(21 + d, CL_DIM == 2 ? m->map.ij[I][0] : NodeId(m, I), m->map.ij[I][1]);
  }
  for (PetscInt k = 0; k < 3 * m->P.n; k++)
    s->stage.m_star[k] *= 1.0 + 0.02 * Noise(23, m->P.i[PI_ID][k / 3], k % 3);
  Call(ModelBeginStage(m, &s->stage));
}

/* Every kind of condition that the field set knows occurs in one of the two sets. */
static inline void AddConditions(SmallScene *s, int set)
{
  const FieldSet *fs    = &s->c.scene.fields;
  const bool      moves = fs->solid || fs->fluid;
  const double    shear = CL_DIM == 2 ? 1.0 : 0.0; /* a traction's is the plane's */
  const double    x0 = s->c.scene.lower[0], axis = s->c.scene.axisymmetric && x0 == 0.0;

  for (int d = 2; d < CL_DIM && moves; d++)
    AddPlane(s, BC_ROLLER, d, 0.0, 0.0);
  if (CL_DIM > 2 && fs->solid)
    AddFace(s, BC_TRACTION, (Side)(SIDE_COUNT - 1), 3.5e6, 0.0);
  if (CL_DIM > 2 && fs->fluid && set == 1)
    AddFace(s, BC_PRESSURE, (Side)(SIDE_COUNT - 1), 3.2e6, 0.0);
  if (set == 0) {
    if (moves && !axis)
      AddPlane(s, BC_ROLLER, 0, x0, 0.0);
    if (moves)
      AddPlane(s, BC_FIXED, 1, 0.0, 0.0);
    if (fs->solid)
      AddFace(s, BC_TRACTION, SIDE_XMAX, 3e6, 5e5 * shear);
    if (fs->fluid)
      AddFace(s, BC_PRESSURE, SIDE_XMAX, 3e6, 0.0)->initial = true;
    if (fs->heat) {
      AddFace(s, BC_CONVECTION, SIDE_XMAX, 10.0, 0.0);
      AddFace(s, BC_HEAT_FLUX, SIDE_YMAX, 300.0, 0.0)->to = x0 + 0.25;
    }
    return;
  }
  if (fs->solid && !axis)
    AddPlane(s, BC_PLATE_LINE, 0, x0, 2e-5);
  if (moves)
    AddPlane(s, BC_ROLLER, 1, 0.0, 0.0);
  if (fs->solid) {
    AddFace(s, BC_TRACTION, SIDE_YMAX, 4e6, -7e5 * shear)->from = x0 + 0.2;
    AddFace(s, BC_TRACTION, SIDE_XMIN, 2e6, 3e5 * shear);
  }
  if (fs->fluid)
    AddFace(s, BC_PRESSURE, SIDE_YMAX, 3.6e6, 0.0);
  if (fs->heat) {
    AddPlane(s, BC_TEMPERATURE, 0, x0, 5.0);
    AddFace(s, BC_FACE_TEMPERATURE, SIDE_YMAX, 6.0, 0.0)->with_depth = 3e3;
    AddFace(s, BC_HEAT_FLUX, SIDE_XMAX, -200.0, 0.0);
    AddFace(s, BC_CONVECTION, SIDE_XMAX, 8.0, 0.0);
  }
}

/* A body whose free sides cut cells; start: x of the grid's left side, the body begins `gap` right of it. */
static inline void JacobianCase(SmallScene *s, unsigned has, bool inertia, bool axisymmetric, BasisType basis,
                                double start, double gap, bool reacts, int set)
{
  const double lower[2] = {gap, 0.0}, upper[2] = {0.47, 0.18};

  SceneInit(s, has, inertia, axisymmetric, basis, start, lower, upper);
  s->mat.reacts               = reacts;
  s->mat.elasticity.change    = set;
  s->c.scene.gravity[0]       = axisymmetric ? 0.0 : 2.0;
  s->c.scene.gravity[1]       = -9.81;
  s->c.scene.compression_heat = s->c.scene.fields.heat && s->c.scene.fields.fluid && set != 1;
  s->region.pressure          = reacts && set ? 2.6e6 : 4.8e6; /* dissociating, forming */
  AddConditions(s, set);
}

/* A random state of it. */
static inline void JacobianState(SmallScene *s)
{
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  RandomHistory(s, 0.2);
  RandomStage(s, 20.0);
  MakeSolver(s);
}

static inline void JacobianScene(SmallScene *s, unsigned has, bool inertia, bool axisymmetric, BasisType basis,
                                 double start, double gap, bool reacts, int set)
{
  JacobianCase(s, has, inertia, axisymmetric, basis, start, gap, reacts, set);
  JacobianState(s);
}

/* ---------------------------------------------------------------- differences */
/* (R(X + t D) - R(X - t D))/2t, extrapolated from steps t, t/2, t/4, ...: each row keeps its best value. */
#define LEVELS 7
static inline void Difference(Model *m, Vec X, Vec D, double t, double *dy)
{
  const PetscInt n = m->map.n_owned * m->c->fields.n;
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
    Check(m->failure.status == CL_OK);
    Call(VecWAXPY(Xt, -t, D, X));
    Call(ModelResidual(NULL, Xt, Rd, m));
    Check(m->failure.status == CL_OK);
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
static inline void PrepareJacobian(SmallScene *s, Vec *X, Vec *D, Vec *JD)
{
  Model  *m = &s->m;
  double *x;

  Call(PetscMalloc1(m->map.n_local * m->c->fields.n, &x));
  RandomUnknowns(m, s->stage.dt, 30, x);
  SetX(m, x);
  Call(PetscFree(x));
  Call(VecDuplicate(m->solver->X, X));
  Call(VecDuplicate(m->solver->X, D));
  Call(VecDuplicate(m->solver->X, JD));
  Call(VecCopy(m->solver->X, *X));
  Call(ModelResidual(NULL, *X, m->solver->R, m));
  if (m->failure.status != CL_OK)
    Say("  inadmissible: %s\n", m->failure.why);
  Check(m->failure.status == CL_OK);
  Call(VecAXPBY(*D, 0.999, 0.0, *X)); /* elsewhere, so that the Jacobian has nothing from the last residual */
  Call(ModelResidual(NULL, *D, *JD, m));
  Call(ModelJacobian(m->solver->snes, *X, m->solver->A, m->solver->Pmat, m));
  if (m->solver->product)
    return;
  Call(ProductDestroy(&s->product));
  Call(ProductCreate(m));
  Call(ModelJacobian(m->solver->snes, *X, m->solver->A, m->solver->Pmat, m));
  s->product         = m->solver->product;
  m->solver->product = NULL;
}

/* Largest difference of the product particle by particle from the assembled one JD, of each equation over its largest
   row. */
static inline double ProductApart(SmallScene *s, Vec D, Vec JD)
{
  Model        *m              = &s->m;
  const int     nf             = m->c->fields.n;
  double        error[F_COUNT] = {0.0}, size[F_COUNT] = {0.0}, worst = 0.0;
  const double *a, *b;
  Vec           product;

  Call(VecDuplicate(JD, &product));
  m->solver->product = s->product;
  Call(MatMult(m->solver->A, D, product));
  m->solver->product = NULL;
  Call(VecGetArrayRead(product, &a));
  Call(VecGetArrayRead(JD, &b));
  for (PetscInt k = 0; k < m->map.n_owned * nf; k++) {
    error[k % nf] = fmax(error[k % nf], fabs(a[k] - b[k]));
    size[k % nf]  = fmax(size[k % nf], fabs(b[k]));
  }
  Call(VecRestoreArrayRead(product, &a));
  Call(VecRestoreArrayRead(JD, &b));
  Call(VecDestroy(&product));
  for (int q = 0; q < nf; q++)
    worst = fmax(worst, Largest(error[q]) / Largest(size[q]));
  return worst;
}

#define MOST_PRODUCT_APART 1e-6 /* slopes are kept as float, but those of storage */

/* Largest |J D - difference| of each equation over the largest difference of that equation, in random directions;
   J D is the same assembled and particle by particle. */
static inline double DirectionError(SmallScene *s, int directions)
{
  Model         *m  = &s->m;
  const PetscInt nf = m->c->fields.n, n = m->map.n_owned * nf;
  const double  *a;
  double         worst = 0.0, *dy, *d;
  Vec            X, D, JD;

  PrepareJacobian(s, &X, &D, &JD);
  Call(PetscMalloc1(n, &dy));
  for (int k = 0; k < directions; k++) {
    double error[F_COUNT] = {0.0}, size[F_COUNT] = {0.0};

    Call(VecGetArrayWrite(D, &d));
    for (PetscInt i = 0; i < n; i++)
      d[i] = Noise(40 + k, NodeId(m, i / nf), m->c->fields.field[i % nf]);
    Call(VecRestoreArrayWrite(D, &d));
    Call(MatMult(m->solver->A, D, JD));
    if (s->product) {
      const double apart = ProductApart(s, D, JD);

      if (!(apart < MOST_PRODUCT_APART))
        Say("  product particle by particle off the assembled one by %.1e\n", apart);
      Check(apart < MOST_PRODUCT_APART);
    }
    Difference(m, X, D, 4e-3, dy);
    Call(VecGetArrayRead(JD, &a));
    for (PetscInt i = 0; i < n; i++) {
      error[i % nf] = fmax(error[i % nf], fabs(a[i] - dy[i]));
      size[i % nf]  = fmax(size[i % nf], fabs(dy[i]));
    }
    Call(VecRestoreArrayRead(JD, &a));
    for (int q = 0; q < nf; q++)
      worst = fmax(worst, Largest(error[q]) / Largest(size[q]));
  }
  Call(PetscFree(dy));
  Call(VecDestroy(&X));
  Call(VecDestroy(&D));
  Call(VecDestroy(&JD));
  return worst;
}

/* Every entry, relative to the largest of its row. */
static inline double ColumnError(SmallScene *s)
{
  Model         *m  = &s->m;
  const PetscInt nf = m->c->fields.n, n = m->map.n_owned * nf, N = m->map.n_global * nf;
  double        *dy, *error, *top, worst = 0.0;
  const double  *a;
  Vec            X, D, JD;

  PrepareJacobian(s, &X, &D, &JD);
  Call(PetscMalloc1(n, &dy));
  Call(PetscCalloc2(n, &error, n, &top));
  for (PetscInt c = 0; c < N; c++) {
    Call(VecSet(D, 0.0));
    if (c >= m->map.first * nf && c < m->map.first * nf + n)
      Call(VecSetValue(D, c, 1.0, INSERT_VALUES));
    Call(VecAssemblyBegin(D));
    Call(VecAssemblyEnd(D));
    Call(MatMult(m->solver->A, D, JD));
    Difference(m, X, D, m->c->fields.field[c % nf] < F_PW ? 1e-2 : 2e-2, dy);
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

/* Setup of a group: linear systems solved as well as can be, with factors of each iteration's own matrix. */
static inline int SolveWell(void **state)
{
  (void)state;
  return PetscOptionsSetValue(NULL, "-ksp_rtol", "1e-10") || PetscOptionsSetValue(NULL, "-ksp_atol", "1e-14") ||
         PetscOptionsSetValue(NULL, "-newton_refactor", "0");
}
