/* The reduced preconditioner, by LU and by multigrid: for every field set, with and without inertia, in the plane and
   about an axis, GMRES with it solves the exact Jacobian and agrees with LU of the whole; the fluid
   velocities are recovered exactly; what it leaves out costs few iterations, and where it leaves out nothing none;
   large rows of the fluid velocities do not stand in for the others; packages that factorise are taken in order. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>
#include <cmocka.h>
#include "small_scene.h"

static const char *const set_names[] = {"thmc", "thc", "hmc", "hc", "thm", "hm", "th", "h", "tm", "m", "t"};
#define SETS ((int)(sizeof(set_names) / sizeof(*set_names)))

enum { WHOLE = 0, FACTORS, MULTIGRID, KINDS };

static void AskFor(int kind)
{
  static const char *const solver[KINDS] = {NULL, "lu", "fieldsplit"};

  Call(PetscOptionsSetValue(NULL, "-newton_preconditioner", kind == WHOLE ? "whole" : "reduced"));
  if (solver[kind])
    Call(PetscOptionsSetValue(NULL, "-reduced_pc_type", solver[kind]));
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

/* Of each kind; the solutions against that with LU of the whole. */
typedef struct {
  double   apart[KINDS], recovery[KINDS];
  PetscInt its[KINDS];
} Found;

static void Solve(unsigned has, bool inertia, bool axisymmetric, bool gas_reacts, int kind, Vec *first, Found *f)
{
  SmallScene *s = malloc(sizeof(*s));
  Vec         X, R, JD, x;
  KSP         ksp;

  AskFor(kind);
  JacobianScene(s, has, inertia, axisymmetric, BASIS_CPGIMP, axisymmetric ? 0.2 : 0.0, 0.0, gas_reacts, 0);
  PrepareJacobian(s, &X, &R, &JD);
  RandomVector(&s->m, 70, R);
  Call(VecDuplicate(R, &x));
  f->recovery[kind] = kind == WHOLE ? 0.0 : RecoveryError(&s->m, R, x);
  Call(SNESGetKSP(s->m.solver->snes, &ksp));
  Call(KSPSetOperators(ksp, s->m.solver->A, s->m.solver->Pmat));
  Call(KSPSolve(ksp, R, x));
  Call(KSPGetIterationNumber(ksp, &f->its[kind]));
  if (kind == WHOLE)
    Call(VecDuplicate(x, first));
  if (kind == WHOLE)
    Call(VecCopy(x, *first));
  f->apart[kind] = Apart(&s->m, x, *first);
  Call(VecDestroy(&x));
  Call(VecDestroy(&X));
  Call(VecDestroy(&R));
  Call(VecDestroy(&JD));
  SceneDestroy(s);
  free(s);
}

static Found Compare(unsigned has, bool inertia, bool axisymmetric, bool gas_reacts)
{
  Found f = {0};
  Vec   first;

  for (int k = 0; k < KINDS; k++)
    Solve(has, inertia, axisymmetric, gas_reacts, k, &first, &f);
  Call(VecDestroy(&first));
  return f;
}

#define LARGE 1e6
#define MOST_APART 1e-6 /* with ksp_rtol 1e-10 */
#define MORE_ITS 8      /* than LU of the whole */

static void TestSets(void **state)
{
  (void)state;
  Say("GMRES to 1e-10 with LU of the whole and with the reduced preconditioner by LU and by multigrid: iterations, "
      "solutions apart, rows of the fluid velocities missed\n");
  for (int k = 0; k < SETS; k++) {
    const unsigned has = FieldSetByName(set_names[k]);

    for (int v = 0; v < 4; v++) {
      const bool inertia = v % 2 == 0;

      if (!(has & (HAS_SOLID | HAS_WATER)) && v > 0)
        continue; /* heat alone has no inertia */
      const Found f = Compare(has, inertia, v / 2, v == 1 && (has & HAS_ALL) == HAS_ALL);
      Say("  %-5s%s%s %3d", set_names[k], inertia ? ", inertia" : "", v / 2 ? ", about an axis" : "",
          (int)f.its[WHOLE]);
      for (int q = FACTORS; q < KINDS; q++) {
        Say("; %3d  %.1e  %.1e", (int)f.its[q], f.apart[q], f.recovery[q]);
        Check(f.apart[q] < MOST_APART && f.recovery[q] < 1e-11 && f.its[q] <= f.its[WHOLE] + MORE_ITS);
      }
      Say("\n");
    }
  }
}

/* What a PETSc has of the packages that factorise: their names, separated by commas. */
static bool Has(MatSolverType package, void *names)
{
  const char *at = strstr(names, package);

  return at && (at[strlen(package)] == ',' || at[strlen(package)] == '\0');
}

/* The order in which packages are asked for, small on one rank or not. */
static void PackagesAreTakenInOrder(void **state)
{
  static const struct {
    const char *has, *large, *small;
  } row[] = {{"petsc,umfpack,superlu_dist,mumps", "mumps", "umfpack"},
             {"petsc,superlu_dist,mumps", "mumps", "mumps"},
             {"petsc,umfpack,superlu_dist", "superlu_dist", "umfpack"},
             {"petsc,umfpack", "umfpack", "umfpack"},
             {"petsc,superlu_dist", "superlu_dist", "superlu_dist"},
             {"petsc", "petsc", "petsc"},
             {"superlu", NULL, NULL}}; /* several ranks, none of them parallel */

  for (size_t k = 0; k < sizeof(row) / sizeof(*row); k++) {
    for (int small = 0; small < 2; small++) {
      const char *expected = small ? row[k].small : row[k].large;
      const char *found    = FactorsPackage(small, Has, (void *)row[k].has);

      Check(expected ? found && !strcmp(found, expected) : !found);
    }
  }
}

/* Without fluids nothing is left out (170): with factors of the matrix GMRES is done at once. */
static void TestNothingLeftOut(void **state)
{
  static const char *const set[] = {"m", "t"};

  (void)state;
  for (int k = 0; k < 2; k++) {
    for (int axisymmetric = 0; axisymmetric < 2; axisymmetric++) {
      const Found f = Compare(FieldSetByName(set[k]), k == 0, axisymmetric, false);

      Say("  %s%s: %d iterations\n", set[k], axisymmetric ? ", about an axis" : "", (int)f.its[FACTORS]);
      Check(f.its[FACTORS] <= 2 && f.apart[FACTORS] < MOST_APART);
    }
  }
}

/* (433): what is small costs nothing, what is large costs iterations, nothing costs the solution. */
static void TestSmallEntries(void **state)
{
  static const char *const share[] = {"0", "1e-6", "0.1"};
  Found                    f[3];

  (void)state;
  for (int k = 0; k < 3; k++) {
    Call(PetscOptionsSetValue(NULL, "-newton_drop", share[k]));
    f[k] = Compare(HAS_ALL, false, false, false);
    Say("  entries below %s of a row's largest left out: %d iterations, %.1e\n", share[k], (int)f[k].its[FACTORS],
        f[k].apart[FACTORS]);
    Check(f[k].apart[FACTORS] < MOST_APART);
  }
  Call(PetscOptionsClearValue(NULL, "-newton_drop"));
  Check(f[1].its[FACTORS] == f[0].its[FACTORS] && f[2].its[FACTORS] > f[0].its[FACTORS] + 2);
}

/* Largest of R - A Y in the rows that are not those of fluid velocities. */
static double LeftElsewhere(const Model *m, Vec R, Vec Y)
{
  const FieldSet *fs   = &m->c->fields;
  double          left = 0.0;
  const double   *a, *r;
  Vec             AY;

  Call(VecDuplicate(R, &AY));
  Call(MatMult(m->solver->A, Y, AY));
  Call(VecGetArrayRead(AY, &a));
  Call(VecGetArrayRead(R, &r));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++) {
    const int q = fs->field[k % fs->n];

    if (q < F_VW || q >= F_PW)
      left = fmax(left, fabs(a[k] - r[k]));
  }
  Call(VecRestoreArrayRead(AY, &a));
  Call(VecRestoreArrayRead(R, &r));
  Call(VecDestroy(&AY));
  return Largest(left);
}

/* (441): what GMRES to 1e-4 leaves in rows of 1, where those of the fluid velocities are 1e6. */
static double LeftBehindLargeRows(int kind)
{
  SmallScene *s = malloc(sizeof(*s));
  Vec         X, R, JD, x;
  double      left, *a;
  KSP         ksp;

  AskFor(kind);
  JacobianScene(s, HAS_ALL, false, false, BASIS_CPGIMP, 0.0, 0.0, false, 0);
  PrepareJacobian(s, &X, &R, &JD);
  Call(VecDuplicate(R, &x));
  RandomVector(&s->m, 70, x);
  Call(VecGetArray(x, &a));
  for (PetscInt k = 0; k < s->m.map.n_owned * s->m.c->fields.n; k++) {
    const int q = s->m.c->fields.field[k % s->m.c->fields.n];

    a[k] *= q >= F_VW && q < F_PW ? LARGE : 0.0;
  }
  Call(VecRestoreArray(x, &a));
  Call(MatMult(s->m.solver->A, x, R));
  RandomVector(&s->m, 71, JD);
  Call(VecAXPY(R, 1.0, JD));
  Call(SNESGetKSP(s->m.solver->snes, &ksp));
  Call(KSPSetTolerances(ksp, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, PETSC_DEFAULT));
  Call(KSPSolve(ksp, R, x));
  left = LeftElsewhere(&s->m, R, x);
  Say("  %s: %.1e left in rows of 1\n", kind == FACTORS ? "factors" : "multigrid", left);
  Call(VecDestroy(&x));
  Call(VecDestroy(&X));
  Call(VecDestroy(&R));
  Call(VecDestroy(&JD));
  SceneDestroy(s);
  free(s);
  return left;
}

static void TestLargeRows(void **state)
{
  (void)state;
  for (int kind = FACTORS; kind < KINDS; kind++)
    Check(LeftBehindLargeRows(kind) < 1e-2);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(PackagesAreTakenInOrder), cmocka_unit_test(TestSets),
                                     cmocka_unit_test(TestNothingLeftOut), cmocka_unit_test(TestSmallEntries),
                                     cmocka_unit_test(TestLargeRows)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
