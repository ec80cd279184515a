/* Diffusion that carries saturations with the flow of both fluids (200): what it is made of, where there is none, what
   it must not change; the same in hybrid as in the implicit steps. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "clathra/explicit.h"
#include "small_scene.h"
#include "model/additions.h"

/* Mobilities that change with p_c, m^2/(Pa s); p_c in MPa. */
static double Mobility(int k, double pc)
{
  return k == PHASE_W ? 1e-10 / (1.0 + pc * pc) : 3e-10 * pc * pc / (1.0 + pc * pc);
}

/* Flux of water at one axis if p_c were uniform, m/s: what J brings, and what gravity alone (share) drives. */
static double WaterFlux(double pc, double J, double by_gravity)
{
  const double lw = Mobility(PHASE_W, pc), lg = Mobility(PHASE_G, pc);

  return lw / (lw + lg) * J + lw * lg / (lw + lg) * by_gravity;
}

static TwoFluids RandomFluids(Rng *r, double *pc)
{
  TwoFluids f;

  *pc = RngBetween(r, 0.3, 3.0);
  for (int k = 0; k < PHASE_COUNT; k++) {
    f.mobility[k] = Mobility(k, *pc);
    f.slope[k]    = (Mobility(k, *pc + 1e-5) - Mobility(k, *pc - 1e-5)) / 20.0; /* per Pa */
    f.rho[k]      = k == PHASE_W ? 1000.0 : RngBetween(r, 1.0, 900.0);
    for (int d = 0; d < CL_DIM; d++)
      f.grad_p[k][d] = RngBetween(r, -2e5, 2e5);
  }
  for (int d = 0; d < CL_DIM; d++)
    f.h[d] = RngLog(r, 0.01, 10.0);
  return f;
}

/* J of both fluids along axis d, m/s. */
static double Total(const TwoFluids *f, const double b[CL_DIM], int d)
{
  double J = 0.0;

  for (int k = 0; k < PHASE_COUNT; k++)
    J -= f->mobility[k] * (f->grad_p[k][d] - f->rho[k] * b[d]);
  return J;
}

/* Against differences of the flux with which both fluids carry p_c, with all that gravity does as long as p_c is
   uniform. */
static void TestSpeed(void **state)
{
  double worst = 0.0;

  (void)state;
  for (uint64_t n = 1; n <= 200; n++) {
    Rng          r = {n * 0x9E3779B97F4A7C15ULL};
    double       pc, Pe = 0.0;
    TwoFluids    f         = RandomFluids(&r, &pc);
    const double b[CL_DIM] = {n % 2 ? 0.0 : 4.0, -9.81}, lw = f.mobility[PHASE_W], lg = f.mobility[PHASE_G];
    const double heavier = f.rho[PHASE_W] - f.rho[PHASE_G], both = lw * lg / (lw + lg);

    for (int d = 0; d < CL_DIM; d++)
      f.grad_p[PHASE_G][d] = f.grad_p[PHASE_W][d];
    for (int d = 0; d < CL_DIM; d++) {
      const double J = Total(&f, b, d), g = heavier * b[d],
                   c = (WaterFlux(pc + 1e-5, J, g) - WaterFlux(pc - 1e-5, J, g)) / 20.0;

      Pe += f.h[d] * fabs(c) / (2.0 * both);
    }
    const double want = both * (Pe / tanh(Pe) - 1.0);
    worst             = fmax(worst, fabs(SaturationDiffusion(&f, b, NULL) - want) / (want + 1e-6 * both));
  }
  Say("(200) against differences of the water's flux: %.1e\n", worst);
  Check(worst < 1e-4);
}

/* Nothing where both fluids pass each other, where gravity and capillary pressure hold each other, where the mobilities
   do not change. */
static void TestNothing(void **state)
{
  const double none[CL_DIM] = {0.0}, down[CL_DIM] = {3.0, -9.0};
  double       most[3] = {0.0}, moved = 0.0;

  (void)state;
  for (uint64_t n = 1; n <= 200; n++) {
    Rng             r = {n * 0x9E3779B97F4A7C15ULL};
    double          pc;
    TwoFluids       f = RandomFluids(&r, &pc), at_rest = f, constant = f;
    const TwoFluids flow = f;

    for (int d = 0; d < CL_DIM; d++) {
      f.grad_p[PHASE_G][d] = -f.mobility[PHASE_W] * f.grad_p[PHASE_W][d] / f.mobility[PHASE_G];
      for (int k = 0; k < PHASE_COUNT; k++)
        at_rest.grad_p[k][d] = f.rho[k] * down[d];
    }
    constant.slope[PHASE_W] = constant.slope[PHASE_G] = 0.0;
    const double scale                                = f.mobility[PHASE_W] + f.mobility[PHASE_G];
    most[0]                                           = fmax(most[0], SaturationDiffusion(&f, none, NULL) / scale);
    most[1] = fmax(most[1], SaturationDiffusion(&at_rest, down, NULL) / scale);
    most[2] = fmax(most[2], SaturationDiffusion(&constant, down, NULL) / scale);
    moved   = fmax(moved, SaturationDiffusion(&flow, down, NULL) / scale);
  }
  Say("of the mobility, at most: counter-current %.1e, at rest %.1e, constant mobilities %.1e; with a flow %.1f\n",
      most[0], most[1], most[2], moved);
  Check(most[0] < 1e-20 && most[1] < 1e-20 && most[2] == 0.0 && moved > 0.1);
}

/* Of second order where cells are small, of first where they are large; sooner or later than both nowhere. */
static void TestOrder(void **state)
{
  const double down[CL_DIM] = {0.0, -9.81};

  (void)state;
  for (uint64_t n = 1; n <= 50; n++) {
    Rng       r = {n * 0x9E3779B97F4A7C15ULL};
    double    pc, D[2][2], last = 0.0;
    TwoFluids f = RandomFluids(&r, &pc);

    f.grad_p[PHASE_W][0] = f.grad_p[PHASE_G][0] = 1e5;
    for (int k = 0; k < 4; k++) {
      for (int d = 0; d < CL_DIM; d++)
        f.h[d] = (k / 2 ? 1e9 : 1e-4) * (k % 2 ? 2.0 : 1.0);
      D[k / 2][k % 2] = SaturationDiffusion(&f, down, NULL);
    }
    Check(fabs(D[0][1] / D[0][0] - 4.0) < 1e-3 && fabs(D[1][1] / D[1][0] - 2.0) < 1e-3);
    for (double h = 1e-6; h < 1e6; h *= 1.01) { /* also where the series ends */
      for (int d = 0; d < CL_DIM; d++)
        f.h[d] = h;
      const double D_h = SaturationDiffusion(&f, down, NULL);
      Check(last == 0.0 || (D_h >= last * (1.0 - 1e-6) && D_h <= last * 1.03));
      last = D_h;
    }
  }
}

/* Axes exchanged and mirrored; beds. */
static void TestAxes(void **state)
{
  (void)state;
  for (uint64_t n = 1; n <= 50; n++) {
    Rng          r = {n * 0x9E3779B97F4A7C15ULL};
    double       pc, turned_b[CL_DIM];
    TwoFluids    f = RandomFluids(&r, &pc), turned = f;
    const double b[CL_DIM] = {4.0, -9.0}, D = SaturationDiffusion(&f, b, NULL);
    Beds         even = {{0.0}};

    for (int d = 0; d < CL_DIM; d++) {
      const int to = (d + 1) % CL_DIM;

      even.A[d]    = 1.0;
      turned.h[to] = f.h[d];
      turned_b[to] = -b[d];
      for (int k = 0; k < PHASE_COUNT; k++)
        turned.grad_p[k][to] = -f.grad_p[k][d];
    }
    Check(fabs(SaturationDiffusion(&turned, turned_b, NULL) - D) <= 1e-13 * D);
    Check(SaturationDiffusion(&f, b, &even) == D);
    even.A[1] = 0.1; /* as in cells a tenth as wide along y */
    turned    = f;
    turned.h[1] *= 0.1;
    Check(fabs(SaturationDiffusion(&f, b, &even) - SaturationDiffusion(&turned, b, NULL)) <= 1e-13 * D);
  }
}

static SmallScene *Make(unsigned has, int variant)
{
  static const double box[2][2] = {{0.0, 0.0}, {0.5, 0.28}};
  SmallScene         *s         = malloc(sizeof(*s));

  SceneInit(s, has, true, false, BASIS_CPGIMP, 0.0, box[0], box[1]);
  s->c.scene.gravity[1] = -9.81;
  if (variant == 1)
    s->mat.permeability.ratio = 0.1;
  if (variant == 2)
    SceneLayers(s, 1, 0.16, 1e-2);
  if (variant == 3)
    s->mat.relperm.of_pores = true;
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  RandomHistory(s, 0.2);
  return s;
}

/* Hybrid's loops, which have the slopes of k_r from laws over arrays, against the implicit steps'. */
static void TestHybrid(void **state)
{
  (void)state;
  for (int variant = 0; variant < 4; variant++) {
    const ExplicitOptions hybrid = {
        .drag_implicit = true, .tied = true, .flip = 1.0, .mass_scaling = 1.0, .passes = variant < 2 ? 0 : 3};
    SmallScene *s   = Make(variant % 2 ? HAS_ALL : HAS_WATER | HAS_GAS, variant);
    StageRates  sum = {0};
    Explicit   *e;
    ClStatus    status;
    const char *why;
    double     *want, worst = 0.0, most = 0.0;

    Call(ExplicitCreate(&s->m, &hybrid, &e));
    Call(ExplicitBegin(e, &status));
    Check(status == CL_OK);
    Call(PetscMalloc1(s->m.P.n, &want));
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      PointProperties q;

      Check(ModelParticleProperties(&s->m, p, &q, &why) == CL_OK);
      want[p] = ModelSaturationDiffusion(&s->m, p, &q, variant < 2);
      most    = fmax(most, want[p]);
    }
    const PetscInt n = s->m.P.n;
    Call(ExplicitStep(e, 0.0, 1e-9, &sum, &status));
    Check(status == CL_OK);
    for (PetscInt p = 0; p < n; p++)
      worst = fmax(worst, fabs(ExplicitSaturationDiffusion(e, p) - want[p]));
    Say("hybrid, variant %d: up to %.1e m2/(Pa s), off the implicit steps' by %.1e\n", variant, Largest(most),
        Largest(worst));
    Check(Largest(most) > 0.0 && Largest(worst) < 1e-10 * Largest(most));
    Call(PetscFree(want));
    Call(ExplicitDestroy(&e));
    SceneDestroy(s);
    free(s);
  }
}

/* What (200) adds to the rows of mass at the nodal values x: with less without; all nodes of this rank. */
static void RowsOf(SmallScene *s, const double *x, double *rows)
{
  Model        *m = &s->m;
  const double *a;

  m->evaluated = false;
  (void)ResidualAt(s, x, F_PW, F_T);
  Call(VecGetArrayRead(m->solver->R, &a));
  for (PetscInt k = 0; k < m->map.n_owned * m->c->fields.n; k++)
    rows[k] = a[k] * m->row_scale[k];
  Call(VecRestoreArrayRead(m->solver->R, &a));
}

/* It moves neither fluid where p_c is uniform, and otherwise sums to zero over the nodes. */
static void TestRows(void **state)
{
  (void)state;
  for (int uniform = 0; uniform < 2; uniform++) {
    SmallScene     *s  = Make(HAS_WATER | HAS_GAS, 0);
    Model          *m  = &s->m;
    const FieldSet *fs = &m->c->fields;
    double         *x, *rows[2], *D, added[PHASE_COUNT] = {0.0}, largest[PHASE_COUNT] = {0.0}, all = 0.0;

    StageStart(s, 10.0);
    Call(ModelBeginStage(m, &s->stage));
    Call(PetscMalloc4(m->map.n_local * fs->n, &x, m->map.n_local * fs->n, &rows[0], m->map.n_local * fs->n, &rows[1],
                      m->P.n, &D));
    Call(PetscArraycpy(x, m->x_n, m->map.n_local * fs->n));
    for (PetscInt I = 0; I < m->map.n_local && uniform; I++)
      x[I * fs->n + PlaceP(fs, PHASE_G)] = x[I * fs->n + PlaceP(fs, PHASE_W)] + 1.1e5;
    RowsOf(s, x, rows[0]);
    Call(PetscArraycpy(D, m->added->diffusion, m->P.n));
    Call(PetscArrayzero(m->added->diffusion, m->P.n));
    RowsOf(s, x, rows[1]);
    for (PetscInt I = 0; I < m->map.n_owned; I++) {
      for (int k = 0; k < PHASE_COUNT; k++) {
        const PetscInt at = I * fs->n + PlaceP(fs, k);

        added[k] += rows[0][at] - rows[1][at];
        largest[k] = fmax(largest[k], fabs(rows[0][at] - rows[1][at]));
        all        = fmax(all, fabs(rows[1][at]));
      }
    }
    all = Largest(all);
    for (int k = 0; k < PHASE_COUNT; k++) {
      const double one = Largest(largest[k]), sum = fabs(Sum(added[k]));

      Say("p_c %s, fluid %d: adds up to %.1e of the largest row, all together %.1e\n", uniform ? "uniform" : "varies",
          k, one / all, sum / all);
      Check((one > 1e-6 * all) == !uniform && (uniform ? one : sum) < 1e-12 * all);
    }
    Call(PetscFree4(x, rows[0], rows[1], D));
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestSpeed),  cmocka_unit_test(TestNothing),
                                     cmocka_unit_test(TestOrder),  cmocka_unit_test(TestAxes),
                                     cmocka_unit_test(TestHybrid), cmocka_unit_test(TestRows)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
