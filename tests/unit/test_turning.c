/* A free body that turns by a right angle in many steps under an all-round pressure: the pressure must not show,
   neither in its stress nor in its shape, in implicit steps and in hybrid's. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <math.h>
#include <string.h>
#include <cmocka.h>
#include "small_scene.h"
#include "clathra/stepper.h"
#include "clathra/tensor.h"

#define OMEGA 5.0  /* rad/s */
#define SIZE 0.3   /* m, of the body */
#define EXCESS 1e3 /* Pa */

static const double middle[CL_DIM] = {0.4, 0.4};

/* A body of 0.3 m x `height` in the middle of 16 x 16 cells of 0.05 m, at pressure p inside and out; its upper half is
   `contrast` times as permeable, unless that is 1, and then at a pressure of its own, so that water flows. */
static SmallScene *Make(unsigned has, BasisType basis, Integrator integrator, double p, double height, double contrast,
                        double t_end)
{
  const double lower[2] = {0.25, middle[1] - 0.5 * height}, upper[2] = {0.55, middle[1] + 0.5 * height};
  SmallScene  *s = malloc(sizeof(*s));

  SceneInit(s, has, true, false, basis, 0.0, lower, upper);
  s->c.scene.upper[0] = s->c.scene.upper[1] = 0.8;
  s->c.scene.cells[0] = s->c.scene.cells[1] = 16;
  s->mat.elasticity.E0                      = 1e7;
  s->mat.elasticity.Eh                      = 0.0;
  s->mat.reacts                             = false;
  s->mat.water.p_ref                        = p; /* as dense and stiff at any p */
  s->region.pressure                        = p;
  for (int d = 0; d < 3 && !s->c.scene.fields.fluid; d++)
    s->region.stress[d] = -p;
  s->number[0]                = p;
  s->c.scene.ambient_pressure = (Schedule){.n = 1, .t = &s->zero, .y = s->number};
  s->region.K0                = INFINITY; /* the stress is as given */
  s->c.integrator             = integrator;
  s->c.t_end = s->c.dt_max = t_end;
  s->c.dt                  = integrator != INTEGRATOR_HYBRID ? 0.005 : has & HAS_WATER ? 5e-6 : 1e-4;
  s->c.dt_min              = 1e-9;
  s->c.error_exponent      = 2.0;
  s->c.tol                 = 1e-3;
  s->c.max_failures        = 5;
  s->c.cfl                 = 0.8;
  s->c.mass_scaling        = 1.0;
  if (contrast != 1.0) {
    SceneLayers(s, 1, middle[1], contrast);
    s->half[1].pressure += EXCESS;
  }
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  s->m.solver->tol_residual = 1e-11;
  for (PetscInt i = 0; i < s->m.P.n; i++) {
    for (int v = P_VS; v < P_VS + 6; v += 2) {
      if (!s->m.P.f[v])
        continue;
      s->m.P.f[P_GV + 1][i] = -OMEGA;
      s->m.P.f[P_GV + 2][i] = OMEGA;
      s->m.P.f[v][i]        = -OMEGA * (s->m.P.f[P_X + 1][i] - middle[1]);
      s->m.P.f[v + 1][i]    = OMEGA * (s->m.P.f[P_X][i] - middle[0]);
    }
  }
  return s;
}

/* What the end looks like, by number of the particle, which any rank may hold. */
typedef struct {
  PetscInt n;
  double   x[256][2], X[256][2], stress[256][3];
} End;

static void Turn(unsigned has, BasisType basis, Integrator integrator, double p, double contrast, double t_end, End *e)
{
  SmallScene *s = Make(has, basis, integrator, p, 0.16, contrast, t_end); /* across the lines of the grid */
  Stepper     stepping;
  bool        ok;

  Call(StepperCreate(&s->m, &stepping));
  Call(StepperReady(&stepping, &ok));
  Check(ok);
  Call(StepperRun(&stepping, &ok));
  Check(ok);
  memset(e, 0, sizeof(*e));
  for (PetscInt i = 0; i < s->m.P.n; i++) {
    const PetscInt k = s->m.P.i[PI_ID][i];

    Check(k < 256);
    e->n = k + 1 > e->n ? k + 1 : e->n;
    for (int d = 0; d < 2; d++) {
      e->x[k][d] = s->m.P.f[P_X + d][i];
      e->X[k][d] = ParticleInitialX(&s->m.P, i, d);
    }
    for (int c = 0; c < 3; c++)
      e->stress[k][c] = s->m.P.f[P_SIG + (c == 2 ? XY : c)][i] + (c < 2 && !s->c.scene.fields.fluid ? p : 0.0);
  }
  const PetscInt n = sizeof(End) / sizeof(double) - 1;
  Call(MPI_Allreduce(MPI_IN_PLACE, e->x, (int)n, MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  Call(MPI_Allreduce(MPI_IN_PLACE, &e->n, 1, MPIU_INT, MPI_MAX, PETSC_COMM_WORLD));
  Call(StepperDestroy(&stepping));
  SceneDestroy(s);
  free(s);
}

/* Angle by which the body has turned, and how far its particles are from where that turn puts them. */
static double Shape(const End *e, double *angle)
{
  double c = 0.0, s = 0.0, worst = 0.0;

  for (PetscInt k = 0; k < e->n; k++) {
    const double X = e->X[k][0] - middle[0], Y = e->X[k][1] - middle[1], x = e->x[k][0] - middle[0],
                 y = e->x[k][1] - middle[1];

    c += X * x + Y * y;
    s += X * y - Y * x;
  }
  *angle = atan2(s, c);
  for (PetscInt k = 0; k < e->n; k++) {
    const double X = e->X[k][0] - middle[0], Y = e->X[k][1] - middle[1];

    worst = fmax(worst, hypot(middle[0] + cos(*angle) * X - sin(*angle) * Y - e->x[k][0],
                              middle[1] + sin(*angle) * X + cos(*angle) * Y - e->x[k][1]));
  }
  return worst / SIZE;
}

static void TestTurn(void **state)
{
  static const struct {
    const char *name;
    Integrator  integrator;
    unsigned    has;
    BasisType   basis;
    double      degrees[3];
    double      contrast;
  } body[] = {
      {"dry, sdirk2", INTEGRATOR_SDIRK2, HAS_SOLID, BASIS_CPGIMP, {30, 45, 90}, 1.0},
      {"dry, ugimp, euler", INTEGRATOR_EULER, HAS_SOLID, BASIS_UGIMP, {30, 45, 90}, 1.0},
      {"dry, total, sdirk2", INTEGRATOR_SDIRK2, HAS_SOLID, BASIS_TOTAL, {30, 45, 90}, 1.0},
      {"saturated, total, sdirk2", INTEGRATOR_SDIRK2, HAS_SOLID | HAS_WATER, BASIS_TOTAL, {90}, 1.0},
      {"layers, total, sdirk2", INTEGRATOR_SDIRK2, HAS_SOLID | HAS_WATER, BASIS_TOTAL, {45}, 1e3},
      {"dry, hybrid", INTEGRATOR_HYBRID, HAS_SOLID, BASIS_CPGIMP, {30, 45, 90}, 1.0},
      {"saturated, sdirk2", INTEGRATOR_SDIRK2, HAS_SOLID | HAS_WATER, BASIS_CPGIMP, {90}, 1.0},
      {"saturated, hybrid", INTEGRATOR_HYBRID, HAS_SOLID | HAS_WATER, BASIS_CPGIMP, {30}, 1.0},
      {"layers, sdirk2", INTEGRATOR_SDIRK2, HAS_SOLID | HAS_WATER, BASIS_CPGIMP, {45}, 1e3},
      {"layers, hybrid", INTEGRATOR_HYBRID, HAS_SOLID | HAS_WATER, BASIS_CPGIMP, {30}, 1e3},
  };
  static End low, high;

  (void)state;
  for (size_t k = 0; k < sizeof(body) / sizeof(*body); k++) {
    for (int a = 0; a < (world_size > 1 ? 1 : 3) && body[k].degrees[a] > 0.0; a++) {
      const double degrees = body[k].degrees[a] / (world_size > 1 ? 3.0 : 1.0); /* ranks: one angle, a third of it */
      const double t       = 1.17 * degrees * M_PI / 180.0 / OMEGA;
      double       x = 0.0, stress = 0.0, angle;

      Turn(body[k].has, body[k].basis, body[k].integrator, 1e5, body[k].contrast, t, &low);
      Turn(body[k].has, body[k].basis, body[k].integrator, 1e7, body[k].contrast, t, &high);
      for (PetscInt i = 0; i < low.n; i++) {
        x = fmax(x, hypot(high.x[i][0] - low.x[i][0], high.x[i][1] - low.x[i][1]) / SIZE);
        for (int c = 0; c < 3; c++)
          stress = fmax(stress, fabs(high.stress[i][c] - low.stress[i][c]) / 1e7);
      }
      const double shape = Shape(&high, &angle);
      Say("%-34s turned by %5.2f deg: off the turned shape by %.1e; 10 MPa against 0.1 MPa: place %.1e, stress %.1e\n",
          body[k].name, angle * 180.0 / M_PI, shape, x, stress);
      const double most = body[k].integrator != INTEGRATOR_EULER ? 0.01 : 0.03; /* its steps damp what turns */
      Check(fabs(angle / (OMEGA * t) - 1.0) < most && shape < 1e-4);
      Check(x < 1e-6 && stress < 1e-6);
    }
  }
}

/* A body that is sheared, stretched and turned in one step, with a temperature that does not change: its gradient goes
   along with the motion, F^-T g, so that (2) finds the same linear field again. */
static void TestGradient(void **state)
{
  static const double A[2][2] = {{180.0, 600.0}, {-300.0, -120.0}}, g[2] = {7.0, -4.0}, dt = 1e-4; /* 1/s, K/m, s */
  const double        F[2][2] = {{1.0 + dt * A[0][0], dt * A[0][1]}, {dt * A[1][0], 1.0 + dt * A[1][1]}};
  const double        J       = F[0][0] * F[1][1] - F[0][1] * F[1][0];
  const double        want[2] = {(F[1][1] * g[0] - F[1][0] * g[1]) / J, (F[0][0] * g[1] - F[0][1] * g[0]) / J};

  (void)state;
  static const struct {
    const char *name;
    Integrator  integrator;
    BasisType   basis;
    double      step; /* length of one, of the whole */
  } kind[] = {{"euler", INTEGRATOR_EULER, BASIS_CPGIMP, 1.0},
              {"hybrid", INTEGRATOR_HYBRID, BASIS_CPGIMP, 1.0},
              {"total", INTEGRATOR_EULER, BASIS_TOTAL, 0.5}};

  for (size_t k = 0; k < sizeof(kind) / sizeof(*kind); k++) {
    SmallScene *s = Make(HAS_SOLID | HAS_HEAT, kind[k].basis, kind[k].integrator, 0.0, 0.2, 1.0, dt);
    Stepper     stepping;
    double      worst = 0.0;
    bool        ok;

    s->c.dt                 = kind[k].step * dt; /* the second step of two begins on a strained body */
    s->mat.elasticity.E0    = 100.0;             /* its waves go 0.03 mm */
    s->m.solver->tol_update = 1e-11;
    s->mat.kappa_s = s->mat.kappa_h = s->mat.kappa_w = s->mat.kappa_g = 0.0;
    for (PetscInt i = 0; i < s->m.P.n; i++) {
      double *const *f    = s->m.P.f;
      const double   x[2] = {f[P_X][i] - middle[0], f[P_X + 1][i] - middle[1]};

      for (int d = 0; d < 2; d++) {
        f[P_VS + d][i] = A[d][0] * x[0] + A[d][1] * x[1];
        for (int j = 0; j < 2; j++)
          f[VectorAt(P_GV, d, j)][i] = A[d][j];
        f[P_GT + d][i] = g[d];
      }
      f[P_T][i] = 5.0 + g[0] * x[0] + g[1] * x[1];
    }
    Call(StepperCreate(&s->m, &stepping));
    Call(StepperReady(&stepping, &ok));
    Call(StepperRun(&stepping, &ok));
    Check(ok);
    for (PetscInt i = 0; i < s->m.P.n; i++) {
      for (int d = 0; d < 2; d++)
        worst = fmax(worst, fabs(s->m.P.f[P_GT + d][i] - want[d]));
      for (int c = 0; c < 4; c++)
        worst = fmax(worst, fabs(s->m.P.f[P_F + c][i] - F[c / 2][c % 2]));
    }
    worst = Largest(worst);
    Say("%-6s gradient of T and deformation gradient after a step of 3 %% stretch, 6 %% shear: off by %.1e\n",
        kind[k].name, worst);
    Check(worst < 1e-7);
    Call(StepperDestroy(&stepping));
    SceneDestroy(s);
    free(s);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestTurn), cmocka_unit_test(TestGradient)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
