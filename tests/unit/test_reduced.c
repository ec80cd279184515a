/* The reduced preconditioner: for every field set, with and without inertia, in the plane and about an axis, with one
   pressure, GMRES with it solves the exact Jacobian and agrees with LU of the whole; the fluid velocities are recovered
   exactly; what it leaves out costs few iterations, and where it leaves out nothing none. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <cmocka.h>
#include "small_scene.h"

static const char *const set_names[] = {"thmc", "thc", "hmc", "hc", "thm", "hm", "th", "h", "tm", "m", "t"};
#define SETS ((int)(sizeof(set_names) / sizeof(*set_names)))

static void AskFor(const char *kind)
{
  Call(PetscOptionsSetValue(NULL, "-newton_preconditioner", kind));
}

static void RandomVector(const Model *m, int seed, Vec V)
{
  const PetscInt nf = m->c->fields.n;
  double        *a;

  Call(VecGetArrayWrite(V, &a));
  for (PetscInt k = 0; k < m->map.n_owned * nf; k++) {
    const PetscInt *ij = m->map.ij[k / nf];

    a[k] = (m->mask[k / nf] >> (k % nf)) & 1u ? 0.0 : Noise(seed, ij[0] + 100 * ij[1], m->c->fields.field[k % nf]);
  }
  Call(VecRestoreArrayWrite(V, &a));
}

/* Largest difference of two vectors field by field, over the largest value of that field. */
static double Apart(const Model *m, Vec A, Vec B)
{
  const int     nf            = m->c->fields.n;
  double        diff[F_COUNT] = {0.0}, size[F_COUNT] = {0.0}, worst = 0.0;
  const double *a, *b;

  Call(VecGetArrayRead(A, &a));
  Call(VecGetArrayRead(B, &b));
  for (PetscInt k = 0; k < m->map.n_owned * nf; k++) {
    diff[k % nf] = fmax(diff[k % nf], fabs(a[k] - b[k]));
    size[k % nf] = fmax(size[k % nf], fabs(b[k]));
  }
  Call(VecRestoreArrayRead(A, &a));
  Call(VecRestoreArrayRead(B, &b));
  for (int q = 0; q < nf; q++)
    worst = fmax(worst, Largest(diff[q]) / Largest(size[q]));
  return worst;
}

/* Largest (A Y - R)/R in the rows of the fluid velocities for Y = M^-1 R. */
static double RecoveryError(Model *m, Vec R, Vec Y)
{
  const FieldSet *fs    = &m->c->fields;
  double          worst = 0.0, size = 0.0;
  const double   *a, *r;
  Vec             AY;

  Call(VecDuplicate(R, &AY));
  Call(ReducedApply(m, R, Y));
  Call(MatMult(m->solver->A, Y, AY));
  Call(VecGetArrayRead(AY, &a));
  Call(VecGetArrayRead(R, &r));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++) {
    const int q = fs->field[k % fs->n];

    if (q < F_VW || q >= F_PW)
      continue;
    worst = fmax(worst, fabs(a[k] - r[k]));
    size  = fmax(size, fabs(r[k]));
  }
  Call(VecRestoreArrayRead(AY, &a));
  Call(VecRestoreArrayRead(R, &r));
  Call(VecDestroy(&AY));
  return fs->fluid ? Largest(worst) / Largest(size) : 0.0;
}

typedef struct {
  double   apart, recovery;
  PetscInt its[2]; /* with LU, with the reduced one */
} Found;

static Found Compare(unsigned has, bool inertia, bool axisymmetric, bool gas_reacts)
{
  static const char *const kind[2] = {"whole", "reduced"};
  Found                    f       = {0};
  Vec                      x[2];

  for (int k = 0; k < 2; k++) {
    SmallScene *s = malloc(sizeof(*s));
    Vec         X, R, JD;
    KSP         ksp;

    AskFor(kind[k]);
    JacobianScene(s, has, inertia, axisymmetric, BASIS_CPGIMP, axisymmetric ? 0.2 : 0.0, 0.0, gas_reacts, 0);
    PrepareJacobian(s, &X, &R, &JD);
    RandomVector(&s->m, 70, R);
    Call(VecDuplicate(R, &x[k]));
    if (k == 1)
      f.recovery = RecoveryError(&s->m, R, x[k]);
    Call(SNESGetKSP(s->m.solver->snes, &ksp));
    Call(KSPSetOperators(ksp, s->m.solver->A, s->m.solver->Pmat));
    Call(KSPSolve(ksp, R, x[k]));
    Call(KSPGetIterationNumber(ksp, &f.its[k]));
    if (k == 1)
      f.apart = Apart(&s->m, x[1], x[0]);
    Call(VecDestroy(&X));
    Call(VecDestroy(&R));
    Call(VecDestroy(&JD));
    SceneDestroy(s);
    free(s);
  }
  Call(VecDestroy(&x[0]));
  Call(VecDestroy(&x[1]));
  return f;
}

#define MOST_APART 1e-6 /* with ksp_rtol 1e-10 */
#define MOST_ITS 40

static void TestSets(void **state)
{
  (void)state;
  Say("GMRES to 1e-10 with LU of the whole and with the reduced preconditioner: iterations, solutions apart, rows of "
      "the "
      "fluid velocities missed\n");
  for (int k = 0; k < SETS; k++) {
    const unsigned has = FieldSetByName(set_names[k]);

    for (int v = 0; v < 4; v++) {
      const bool inertia = v % 2 == 0;

      one_pressure = v == 3 && (has & HAS_GAS);
      if (!(has & (HAS_SOLID | HAS_WATER)) && v > 0)
        continue; /* heat alone has no inertia */
      const Found f = Compare(has, inertia, v / 2, v == 1 && (has & HAS_ALL) == HAS_ALL);
      Say("  %-5s%s%s%s %3d %3d  %.1e  %.1e\n", set_names[k], inertia ? ", inertia" : "",
          v / 2 ? ", about an axis" : "", one_pressure ? ", one pressure" : "", (int)f.its[0], (int)f.its[1], f.apart,
          f.recovery);
      Check(f.apart < MOST_APART && f.recovery < 1e-11 && f.its[1] < MOST_ITS);
    }
  }
  one_pressure = false;
}

/* Of one group without fluids nothing is left out (170): with factors of its matrix GMRES is done at once. */
static void TestNothingLeftOut(void **state)
{
  static const char *const set[]    = {"m", "t"};
  static const char *const option[] = {"-reduced_fieldsplit_motion_pc_type", "-reduced_fieldsplit_flow_pc_type"};
  static const char *const solver[] = {"-reduced_fieldsplit_motion_pc_factor_mat_solver_type",
                                       "-reduced_fieldsplit_flow_pc_factor_mat_solver_type"};

  (void)state;
  for (int k = 0; k < 2; k++) {
    Call(PetscOptionsSetValue(NULL, option[k], PCLU));
    Call(PetscOptionsSetValue(NULL, solver[k], MATSOLVERMUMPS));
    for (int axisymmetric = 0; axisymmetric < 2; axisymmetric++) {
      const Found f = Compare(FieldSetByName(set[k]), k == 0, axisymmetric, false);

      Say("  %s%s: %d iterations\n", set[k], axisymmetric ? ", about an axis" : "", (int)f.its[1]);
      Check(f.its[1] <= 2 && f.apart < MOST_APART);
    }
    Call(PetscOptionsClearValue(NULL, option[k]));
    Call(PetscOptionsClearValue(NULL, solver[k]));
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestSets), cmocka_unit_test(TestNothingLeftOut)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
