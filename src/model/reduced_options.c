/* What the solvers of the reduced preconditioner are, unless the user gave options of theirs. */
#include "gather.h"

/* An option of the solver unless the user gave it; nobody is told if nothing takes it. */
static PetscErrorCode Prefer(const char *name, const char *value)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &given));
  if (given)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscOptionsSetValue(NULL, name, value));
  PetscCall(PetscOptionsHasName(NULL, NULL, name, &given)); /* used */
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* An option of a group's solver: `name` behind its prefix. */
static PetscErrorCode PreferFor(const char *group, const char *name, const char *value)
{
  char full[128];

  PetscFunctionBeginUser;
  snprintf(full, sizeof(full), "-reduced_fieldsplit_%s_%s", group, name);
  PetscCall(Prefer(full, value));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode IsGiven(const char *group, PetscBool *given)
{
  char full[128];

  PetscFunctionBeginUser;
  snprintf(full, sizeof(full), "-reduced_fieldsplit_%s_pc_type", group);
  PetscCall(PetscOptionsHasName(NULL, NULL, full, given));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Algebraic multigrid, unless the user wants something else.  GMRES needs no symmetric smoother: one sweep forward on
   the way down and one backward on the way up cost half of hypre's default, for 5 % more iterations; in space a node's
   row is five times as long, and a higher threshold thins the coarse levels out. */
static PetscErrorCode PreferMotion(void)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(IsGiven("motion", &given));
  if (given)
    PetscFunctionReturn(PETSC_SUCCESS);
#if defined(PETSC_HAVE_HYPRE)
  PetscCall(PreferFor("motion", "pc_type", "hypre"));
  PetscCall(PreferFor("motion", "pc_hypre_boomeramg_strong_threshold", CL_DIM == 3 ? "0.7" : "0.5"));
  PetscCall(PreferFor("motion", "pc_hypre_boomeramg_relax_type_down", "SOR/Jacobi"));
  PetscCall(PreferFor("motion", "pc_hypre_boomeramg_relax_type_up", "backward-SOR/Jacobi"));
#else
  PetscCall(PreferFor("motion", "pc_type", "gamg")); /* given from now on, so this is said once */
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  multigrid of the motion by gamg: this PETSc has no hypre\n"));
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Aggregates of nodes, all fields of a node together, smoothed by ILU: capillary pressure and reaction couple the
   fields within a node so strongly that multigrid field by field diverges. */
static PetscErrorCode PreferFlow(void)
{
  PetscBool given;

  PetscFunctionBeginUser;
  PetscCall(IsGiven("flow", &given));
  if (given)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PreferFor("flow", "pc_type", "gamg"));
  PetscCall(PreferFor("flow", "mg_levels_ksp_type", "richardson"));
  PetscCall(PreferFor("flow", "mg_levels_ksp_max_it", "1"));
  PetscCall(PreferFor("flow", "mg_levels_pc_type", "bjacobi"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* MUMPS orders unknowns by approximate minimum degree: in the plane its factors are as good as those of nested
   dissection up to the breadths that LU is for (330), and found in an eighth of the time, which is half of a numerical
   factorisation; in space they cost a third more. */
PetscErrorCode ReducedFactorsPreferences(void)
{
  PetscFunctionBeginUser;
#if CL_DIM == 2
  PetscCall(Prefer("-reduced_mat_mumps_icntl_7", "0"));
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedPreferences(bool flow, bool motion)
{
  PetscFunctionBeginUser;
  if (flow)
    PetscCall(PreferFlow());
  if (motion)
    PetscCall(PreferMotion());
  PetscFunctionReturn(PETSC_SUCCESS);
}
