/* Direct solvers: packages in order of preference, and which of them this PETSc has. */
#include "solver.h"

/* UMFPACK with its solves beats MUMPS only on small problems: 0.8 against 2.4 ms a factorisation of a strip of 500
   unknowns, 58 against 30 ms of a block of 3400. */
#define UMFPACK_MOST 2500

bool FactorsSmall(const Model *m, int n)
{
  return m->grid.size == 1 && m->map.n_global * n <= UMFPACK_MOST;
}

MatSolverType FactorsPackage(bool small, bool (*has)(MatSolverType package, void *ctx), void *ctx)
{
  static const MatSolverType order[2][4] = {
      {MATSOLVERMUMPS, MATSOLVERSUPERLU_DIST, MATSOLVERUMFPACK, MATSOLVERPETSC},
      {MATSOLVERUMFPACK, MATSOLVERMUMPS, MATSOLVERSUPERLU_DIST, MATSOLVERPETSC},
  };

  for (int k = 0; k < 4; k++) {
    if (has(order[small][k], ctx))
      return order[small][k];
  }
  return NULL;
}

static bool Has(MatSolverType package, void *matrix)
{
  PetscBool has = PETSC_FALSE;

  PetscCallAbort(PETSC_COMM_SELF, MatGetFactorAvailable((Mat)matrix, package, MAT_FACTOR_LU, &has));
  return has;
}

/* Does an option of the user choose another one? */
static PetscErrorCode IsGiven(PC pc, PetscBool *given)
{
  const char *prefix;

  PetscFunctionBeginUser;
  PetscCall(PCGetOptionsPrefix(pc, &prefix));
  PetscCall(PetscOptionsHasName(NULL, prefix, "-pc_type", given));
  if (!*given)
    PetscCall(PetscOptionsHasName(NULL, prefix, "-pc_factor_mat_solver_type", given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One line, once a run, where neither of the two that are known to do well factorises. */
static PetscErrorCode Say(Model *m, PC pc, bool small, MatSolverType package)
{
  PetscBool mumps = PETSC_FALSE, umfpack = PETSC_FALSE, given;

  PetscFunctionBeginUser;
  PetscCall(IsGiven(pc, &given));
  if (package)
    PetscCall(PetscStrcmp(package, MATSOLVERMUMPS, &mumps));
  if (package && small)
    PetscCall(PetscStrcmp(package, MATSOLVERUMFPACK, &umfpack));
  if (given || mumps || umfpack || m->solver->plan.told)
    PetscFunctionReturn(PETSC_SUCCESS);
  m->solver->plan.told = true;
  PetscCall(PetscPrintf(m->grid.comm, "  lu by %s: this PETSc has no mumps\n",
                        package ? package : "petsc, repeated on every rank"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FactorsUse(Model *m, Mat A, int n, PC pc)
{
  const bool          small   = FactorsSmall(m, n);
  const MatSolverType package = FactorsPackage(small, Has, A);

  PetscFunctionBeginUser;
  PetscCall(PCSetType(pc, package ? PCLU : PCREDUNDANT)); /* whose own default is LU */
  if (package)
    PetscCall(PCFactorSetMatSolverType(pc, package));
  PetscCall(Say(m, pc, small, package));
  PetscFunctionReturn(PETSC_SUCCESS);
}
