/* Diffusion that carries saturations with the flow of both fluids (456): what it is made of, where there is none, what
   it must not change. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
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

static TwoFluids RandomFluids(Rng *r, double half)
{
  const double pc = RngBetween(r, 0.3, 3.0);
  TwoFluids    f  = {.half = 1e6 * half, .heavier = RngBetween(r, 100.0, 990.0)};

  for (int k = 0; k < PHASE_COUNT; k++) {
    f.mobility[k] = Mobility(k, pc);
    f.less[k]     = Mobility(k, pc - half);
    f.more[k]     = Mobility(k, pc + half);
  }
  for (int d = 0; d < CL_DIM; d++) {
    f.J[d]       = RngBetween(r, -1e-5, 1e-5);
    f.grad_pc[d] = RngBetween(r, -2e5, 2e5);
    f.h[d]       = RngLog(r, 0.01, 10.0);
  }
  return f;
}

/* Against differences of the flux with which both fluids carry p_c, with all that gravity does where p_c is uniform. */
static void TestSpeed(void **state)
{
  double worst = 0.0;

  (void)state;
  for (uint64_t n = 1; n <= 200; n++) {
    Rng          r = {n * 0x9E3779B97F4A7C15ULL}, again = r;
    const double pc = RngBetween(&again, 0.3, 3.0), half = n % 2 ? 1e-4 : 0.1;
    TwoFluids    f         = RandomFluids(&r, half);
    const double b[CL_DIM] = {n % 3 ? 0.0 : 4.0, -9.81}, lw = f.mobility[PHASE_W], lg = f.mobility[PHASE_G];
    const double both = lw * lg / (lw + lg);
    double       Pe   = 0.0;

    for (int d = 0; d < CL_DIM; d++) {
      const double g = f.heavier * b[d];

      f.grad_pc[d] = 0.0;
      Pe += f.h[d] * fabs(WaterFlux(pc + half, f.J[d], g) - WaterFlux(pc - half, f.J[d], g)) / (2e6 * half) /
            (2.0 * both);
    }
    const double want = both * (Pe / tanh(Pe) - 1.0);
    worst             = fmax(worst, fabs(SaturationDiffusion(&f, b, NULL) - want) / (want + 1e-6 * both));
  }
  Say("(456) against differences of the water's flux: %.1e\n", worst);
  Check(worst < 1e-6);
}

/* Nothing where both fluids pass each other, where gravity and capillary pressure hold each other, where the mobilities
   do not change. */
static void TestNothing(void **state)
{
  const double none[CL_DIM] = {0.0}, down[CL_DIM] = {3.0, -9.0};
  double       most[3] = {0.0}, moved = 0.0;

  (void)state;
  for (uint64_t n = 1; n <= 200; n++) {
    Rng             r       = {n * 0x9E3779B97F4A7C15ULL};
    const TwoFluids f       = RandomFluids(&r, 0.1);
    TwoFluids       passing = f, constant = f;

    for (int d = 0; d < CL_DIM; d++)
      passing.J[d] = 0.0;
    TwoFluids at_rest = passing;
    for (int d = 0; d < CL_DIM; d++)
      at_rest.grad_pc[d] = -f.heavier * down[d];
    for (int k = 0; k < PHASE_COUNT; k++)
      constant.less[k] = constant.more[k] = f.mobility[k];
    const double scale = f.mobility[PHASE_W] + f.mobility[PHASE_G];
    most[0]            = fmax(most[0], SaturationDiffusion(&passing, none, NULL) / scale);
    most[1]            = fmax(most[1], SaturationDiffusion(&at_rest, down, NULL) / scale);
    most[2]            = fmax(most[2], SaturationDiffusion(&constant, down, NULL) / scale);
    moved              = fmax(moved, SaturationDiffusion(&f, down, NULL) / scale);
  }
  Say("of the mobility, at most: counter-current %.1e, at rest %.1e, constant mobilities %.1e; with a flow %.1f\n",
      most[0], most[1], most[2], moved);
  Check(most[0] == 0.0 && most[1] < 1e-20 && most[2] == 0.0 && moved > 0.1);
}

/* Of second order where cells are small, of first where they are large; sooner or later than both nowhere. */
static void TestOrder(void **state)
{
  const double down[CL_DIM] = {0.0, -9.81};

  (void)state;
  for (uint64_t n = 1; n <= 50; n++) {
    Rng       r = {n * 0x9E3779B97F4A7C15ULL};
    TwoFluids f = RandomFluids(&r, 0.1);
    double    D[2][2], last = 0.0;

    f.J[0] = 1e-5;
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

/* Axes exchanged and mirrored. */
static void TestAxes(void **state)
{
  (void)state;
  for (uint64_t n = 1; n <= 50; n++) {
    Rng          r = {n * 0x9E3779B97F4A7C15ULL};
    TwoFluids    f = RandomFluids(&r, 0.1), turned = f;
    const double b[CL_DIM] = {4.0, -9.0}, D = SaturationDiffusion(&f, b, NULL);
    double       turned_b[CL_DIM];
    Beds         even = {{0.0}};

    for (int d = 0; d < CL_DIM; d++) {
      const int to = (d + 1) % CL_DIM;

      even.A[d]          = 1.0;
      turned.h[to]       = f.h[d];
      turned_b[to]       = -b[d];
      turned.J[to]       = -f.J[d];
      turned.grad_pc[to] = -f.grad_pc[d];
    }
    Check(fabs(SaturationDiffusion(&turned, turned_b, NULL) - D) <= 1e-13 * D);
    Check(SaturationDiffusion(&f, b, &even) == D);
  }
}

/* Rows of mass at the nodal values x of all nodes of this rank. */
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
  static const double box[2][2] = {{0.0, 0.0}, {0.5, 0.28}};

  (void)state;
  for (int uniform = 0; uniform < 2; uniform++) {
    SmallScene *s = malloc(sizeof(*s));
    Model      *m = &s->m;
    double     *x, *rows[2], added[PHASE_COUNT] = {0.0}, largest[PHASE_COUNT] = {0.0}, all = 0.0;

    SceneInit(s, HAS_WATER | HAS_GAS, true, false, BASIS_CPGIMP, 0.0, box[0], box[1]);
    s->c.scene.gravity[1] = -9.81;
    Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, m));
    RandomHistory(s, 0.2);
    StageStart(s, 10.0);
    Call(ModelBeginStage(m, &s->stage));
    const FieldSet *fs = &m->c->fields;
    Call(PetscMalloc3(m->map.n_local * fs->n, &x, m->map.n_local * fs->n, &rows[0], m->map.n_local * fs->n, &rows[1]));
    Call(PetscArraycpy(x, m->x_n, m->map.n_local * fs->n));
    for (PetscInt I = 0; I < m->map.n_local && uniform; I++)
      x[I * fs->n + PlaceP(fs, PHASE_G)] = x[I * fs->n + PlaceP(fs, PHASE_W)] + 1.1e5;
    for (int with = 0; with < 2; with++) {
      for (PetscInt k = 0; k < PHASE_COUNT * m->P.n; k++)
        m->added->spread[k] = with ? 1e-9 : 0.0;
      RowsOf(s, x, rows[with]);
    }
    for (PetscInt I = 0; I < m->map.n_owned; I++) {
      for (int k = 0; k < PHASE_COUNT; k++) {
        const PetscInt at = I * fs->n + PlaceP(fs, k);

        added[k] += rows[1][at] - rows[0][at];
        largest[k] = fmax(largest[k], fabs(rows[1][at] - rows[0][at]));
        all        = fmax(all, fabs(rows[0][at]));
      }
    }
    all = Largest(all);
    for (int k = 0; k < PHASE_COUNT; k++) {
      const double one = Largest(largest[k]), sum = fabs(Sum(added[k]));

      Say("p_c %s, fluid %d: adds up to %.1e of the largest row, all together %.1e\n", uniform ? "uniform" : "varies",
          k, one / all, sum / all);
      Check((one > 1e-6 * all) == !uniform && (uniform ? one : sum) < 1e-11 * (all + one));
    }
    Call(PetscFree3(x, rows[0], rows[1]));
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestSpeed), cmocka_unit_test(TestNothing),
                                     cmocka_unit_test(TestOrder), cmocka_unit_test(TestAxes),
                                     cmocka_unit_test(TestRows)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
