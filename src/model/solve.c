/* Newton-Krylov solution of one stage with PETSc's SNES. */
#include "solver.h"
#include "clathra/solver_words.h"

#define CONSERVATION 20.0 /* mass and energy are solved that much tighter than momentum */

const char *const solver_preconditioner[] = {"auto", "whole", "reduced", NULL};
const char *const solver_operator[]       = {"auto", "assembled", "particles", NULL};

PetscErrorCode SolverCreate(Solver **out)
{
  Solver *s;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&s));
  s->poor          = -1;
  s->tol_residual  = 1e-9;
  s->tol_update    = 1e-6;
  s->keep_jacobian = 0.01;
  s->drop          = 1e-6;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-model_pmat_type", s->pmat_type, sizeof(s->pmat_type), NULL));
  PetscCall(PetscOptionsGetInt(NULL, NULL, "-newton_refactor", &s->poor, NULL));
  PetscCall(PetscOptionsGetEList(NULL, NULL, "-newton_preconditioner", solver_preconditioner,
                                 PRECONDITIONER_REDUCED + 1, &s->preconditioner, NULL));
  PetscCall(
      PetscOptionsGetEList(NULL, NULL, "-newton_operator", solver_operator, OPERATOR_PARTICLES + 1, &s->apply, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-newton_drop", &s->drop, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-newton_keep_jacobian", &s->keep_jacobian, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-newton_tol_residual", &s->tol_residual, NULL));
  PetscCall(PetscOptionsGetReal(NULL, NULL, "-newton_tol_update", &s->tol_update, NULL));
  *out = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverReset(Solver *s)
{
  PetscFunctionBeginUser;
  PetscCall(MatrixDestroy(s));
  PetscCall(ProductDestroy(&s->product));
  PetscCall(MatDestroy(&s->A));
  PetscCall(MatDestroy(&s->Pmat));
  PetscCall(VecDestroy(&s->X));
  PetscCall(VecDestroy(&s->R));
  PetscCall(SNESDestroy(&s->snes));
  PetscCall(ReducedDestroy(&s->reduced));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SolverDestroy(Solver **s)
{
  PetscFunctionBeginUser;
  if (!*s)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SolverReset(*s));
  PetscCall(PetscFree(*s));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Largest scaled entry of each field over all ranks. */
static PetscErrorCode FieldNorms(const Model *m, Vec v, double norm[F_COUNT])
{
  const FieldSet *fs = &m->c->fields;
  const double   *a;

  PetscFunctionBeginUser;
  for (int q = 0; q < F_COUNT; q++)
    norm[q] = 0.0;
  PetscCall(VecGetArrayRead(v, &a));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++)
    norm[fs->field[k % fs->n]] = fmax(norm[fs->field[k % fs->n]], ClSize(a[k]));
  PetscCall(VecRestoreArrayRead(v, &a));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, norm, F_COUNT, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Largest(const double norm[F_COUNT], int *field)
{
  *field = 0;
  for (int q = 1; q < F_COUNT; q++) {
    if (norm[q] > norm[*field])
      *field = q;
  }
  return norm[*field];
}

/* Keeps the Jacobian while the residual falls fast enough (343). */
static PetscErrorCode JacobianChoose(SNES snes, PetscInt it, double residual, Model *m)
{
  const bool serves = it > 0 && residual < m->solver->keep_jacobian * m->solver->residual &&
                      !m->solver->always_refactor && !m->solver->renewal.due;

  PetscFunctionBeginUser;
  m->solver->residual = residual;
  m->solver->kept += serves;
  PetscCall(SNESSetLagJacobian(snes, serves ? -1 : 1)); /* -1: never again */
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define NEARLY 0.5             /* of the last residual: what an iteration of the second half may leave at most */
#define MOMENTUM_TOLERANCE 0.1 /* fluid momentum: where a phase hardly moves, round-off of its drag stands at 1e-9 */

/* Converged when every field's residual and update are small in units of 1 MPa and 1 K. */
static PetscErrorCode Converged(SNES snes, PetscInt it, PetscReal xnorm, PetscReal gnorm, PetscReal fnorm,
                                SNESConvergedReason *reason, void *model)
{
  Model   *m = (Model *)model;
  Vec      R, dX;
  double   residual[F_COUNT], update[F_COUNT] = {0.0};
  PetscInt max_it;
  int      fr, fu;

  PetscFunctionBeginUser;
  (void)xnorm;
  (void)gnorm;
  *reason = SNES_CONVERGED_ITERATING;
  if (PetscIsInfOrNanReal(fnorm)) {
    *reason = SNES_DIVERGED_FUNCTION_NANORINF;
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SNESGetFunction(snes, &R, NULL, NULL));
  PetscCall(SNESGetSolutionUpdate(snes, &dX));
  PetscCall(SNESGetTolerances(snes, NULL, NULL, NULL, &max_it, NULL));
  PetscCall(FieldNorms(m, R, residual));
  if (it > 0)
    PetscCall(FieldNorms(m, dX, update));
  for (int q = F_PW; q <= F_T; q++)
    residual[q] *= CONSERVATION;
  for (int q = F_VW; q < F_PW; q++)
    residual[q] *= MOMENTUM_TOLERANCE,
        update[q] = 0.0; /* they follow the pressures by (16): their residual says it all */
  const double r = Largest(residual, &fr), u = Largest(update, &fu);
  PetscCall(PetscInfo(snes, "Newton %" PetscInt_FMT ": largest residual %.3e (%s), largest update %.3e (%s)\n", it, r,
                      cl_field[fr].equation, u, cl_field[fu].name));
  if (r <= m->solver->tol_residual && u <= m->solver->tol_update)
    *reason = it == 0 ? SNES_CONVERGED_FNORM_ABS : SNES_CONVERGED_SNORM_RELATIVE;
  else if (it >= max_it || (2 * it >= max_it && r > NEARLY * m->solver->residual))
    *reason = SNES_DIVERGED_MAX_IT;
  if (*reason == SNES_CONVERGED_ITERATING)
    PetscCall(JacobianChoose(snes, it, r, m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* From the right, so that it stops on the rows' own residual, not below their round-off; a method of the user's choice
   may know the left side only. */
static PetscErrorCode SetSide(KSP ksp)
{
  char      type[64];
  PetscBool given, gmres = PETSC_TRUE;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-ksp_type", type, sizeof(type), &given));
  if (given)
    PetscCall(PetscStrendswith(type, "gmres", &gmres));
  if (gmres)
    PetscCall(KSPSetPCSide(ksp, PC_RIGHT));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Defaults: flexible GMRES preconditioned by a direct factorisation of J2; every -snes_, -ksp_, -pc_ option wins. */
static PetscErrorCode CreateSolver(Model *m)
{
  SNESLineSearch ls;
  PetscBool      aij;
  KSP            ksp;

  PetscFunctionBeginUser;
  m->solver->refactor = true;
  m->solver->reduces  = m->solver->plan.reduced;
  const bool particles =
      m->solver->apply == OPERATOR_PARTICLES || (m->solver->apply == OPERATOR_AUTO && m->solver->reduces);
  if (particles)
    PetscCall(ProductCreate(m));
  if (!particles || !m->solver->reduces)
    PetscCall(MatrixCreate(m));
  PetscCall(WideCreate(m, &m->solver->A));
  PetscCall(MatCreateVecs(m->solver->A, &m->solver->X, &m->solver->R));
  PetscCall(PetscStrcmp(m->solver->pmat_type[0]           ? m->solver->pmat_type
                        : FactorsSmall(m, m->c->fields.n) ? "aij"
                                                          : "baij",
                        "aij", &aij));
  PetscCheck(!aij || m->grid.size == 1, m->grid.comm, PETSC_ERR_SUP,
             "-model_pmat_type aij is for one rank; leave it out, or give baij");
  if (m->solver->J2 && aij) {
    PetscCall(MatConvert(m->solver->J2, MATAIJ, MAT_INITIAL_MATRIX, &m->solver->Pmat));
  } else {
    m->solver->Pmat = m->solver->J2 ? m->solver->J2 : m->solver->A;
    PetscCall(PetscObjectReference((PetscObject)m->solver->Pmat));
  }
  PetscCall(SNESCreate(m->grid.comm, &m->solver->snes));
  PetscCall(SNESSetFunction(m->solver->snes, m->solver->R, ModelResidual, m));
  PetscCall(SNESSetJacobian(m->solver->snes, m->solver->A, m->solver->Pmat, ModelJacobian, m));
  PetscCall(SNESSetTolerances(m->solver->snes, 0.0, 0.0, 0.0, 30, 10000));
  PetscCall(SNESSetConvergenceTest(m->solver->snes, Converged, m, NULL));
  PetscCall(SNESGetLineSearch(m->solver->snes, &ls));
  PetscCall(SNESLineSearchSetType(ls, SNESLINESEARCHNONE));
  PetscCall(SNESLineSearchSetPreCheck(ls, ModelLimitUpdate, m));
  PetscCall(SNESLineSearchSetPostCheck(ls, ModelVelocitiesAfterUpdate, m));
  PetscCall(SNESGetKSP(m->solver->snes, &ksp));
  PetscCall(KSPSetType(ksp, KSPFGMRES)); /* keeps what the preconditioner gave, where GMRES applies it once more */
  PetscCall(KSPSetTolerances(ksp, 1e-6, 0.02 * m->solver->tol_residual, PETSC_DEFAULT, 60));
  PetscCall(KSPGMRESSetRestart(ksp, 60));
  PetscCall(PreconditionerCreate(m, ksp));
  PetscCall(SetSide(ksp));
  PetscCall(SNESSetFromOptions(m->solver->snes));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelReadySolver(Model *m)
{
  PetscFunctionBeginUser;
  if (!m->solver->snes)
    PetscCall(CreateSolver(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Equation and place of the largest scaled residual. */
static PetscErrorCode FindWorst(Model *m, int *field)
{
  struct {
    double value, at[CL_DIM];
    int    field;
  } worst          = {.value = -1.0};
  const PetscInt n = m->c->fields.n;
  const double  *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(m->solver->R, &a));
  for (PetscInt k = 0; k < m->map.n_owned * n; k++) {
    if (!(fabs(a[k]) > worst.value))
      continue;
    worst.value = fabs(a[k]);
    worst.field = m->c->fields.field[k % n];
    for (int d = 0; d < CL_DIM; d++)
      worst.at[d] = GridNode(&m->grid, d, m->map.ij[k / n][d]);
  }
  PetscCall(VecRestoreArrayRead(m->solver->R, &a));
  PetscCall(GridShareLargest(m->grid.comm, &worst, sizeof(worst)));
  for (int d = 0; d < CL_DIM; d++)
    m->failure.where[d] = worst.at[d];
  *field = worst.field;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why SNES gave up, in words. */
static PetscErrorCode Explain(Model *m)
{
  KSP                ksp;
  KSPConvergedReason linear;
  int                field = 0;

  PetscFunctionBeginUser;
  PetscCall(ModelReduceStatus(m, &m->failure.status));
  if (m->failure.status != CL_OK)
    PetscFunctionReturn(PETSC_SUCCESS); /* a particle said it */
  PetscCall(SNESGetKSP(m->solver->snes, &ksp));
  PetscCall(KSPGetConvergedReason(ksp, &linear));
  PetscCall(FindWorst(m, &field));
  snprintf(m->failure.why, sizeof(m->failure.why), "%s, largest residual in the equation of %s",
           linear < 0 ? "the linear solver failed" : "Newton's method did not converge", cl_field[field].equation);
  m->failure.status = CL_SOLVER;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Would the velocity at the start carry a node out of the trusted range within this stage?  Then it is none of a step
   so long: what is left of a motion that has come to rest since. */
static bool TooFast(const Model *m, PetscInt I, const double *x)
{
  const FieldSet *fs  = &m->c->fields;
  double          far = 0.0;

  for (int d = 0; fs->solid && d < CL_DIM; d++)
    far = fmax(far, fabs(x[PlaceVs(fs) + d]) * m->stage.dt / LinesLess(&m->grid.line[d], m->map.ij[I][d]));
  return far > CL_LIMIT_J;
}

/* From the state at the start, or at rest. */
static PetscErrorCode FirstGuess(Model *m, const double *x)
{
  const PetscInt n = m->c->fields.n;
  double        *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(m->solver->X, &a));
  for (PetscInt k = 0; k < m->map.n_owned * n; k++) {
    const bool fixed = (m->mask[k / n] >> (k % n)) & 1u;
    const bool rests = m->c->fields.field[k % n] < F_PW && TooFast(m, k / n, &x[k - k % n]);

    a[k] = (fixed ? m->fixed[k] : rests ? 0.0 : x[k]) / m->col_scale[k];
  }
  PetscCall(VecRestoreArrayWrite(m->solver->X, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a stage is tried with, in this order: an old preconditioner where it serves, a new one at every iteration, LU;
   then (426), and that with LU. */
enum { WITH_OLD = 0, WITH_NEW, WITH_LU, SEARCHED, SEARCHED_WITH_LU, ATTEMPTS };

/* Is it this one's turn, after one that ended for a reason? */
static bool IsDue(const Model *m, int attempt, SNESConvergedReason reason)
{
  const Solver *s      = m->solver;
  const bool    linear = reason == SNES_DIVERGED_LINEAR_SOLVE;

  switch (attempt) {
  case WITH_OLD:
    return true;
  case WITH_NEW:
    return linear || s->kept > 0;
  case WITH_LU:
    return linear && s->reduces;
  case SEARCHED:
    return reason == SNES_DIVERGED_MAX_IT && (m->c->fields.has & HAS_PLASTIC) && !ModelVelocitiesFollow(m);
  default:
    return s->searches && linear && s->reduces;
  }
}

/* Solves once from the first guess x, adding to the iterations. */
static PetscErrorCode Attempt(Model *m, int attempt, const double *x, PetscInt *newton, SNESConvergedReason *reason)
{
  Solver    *s  = m->solver;
  const bool lu = attempt == WITH_LU || attempt == SEARCHED_WITH_LU;
  /* where nothing better is left, a linear solve that stops early still gives a good direction */
  const bool last = lu || (!s->reduces && attempt != WITH_OLD);
  PetscInt   its;

  PetscFunctionBeginUser;
  s->always_refactor = attempt != WITH_OLD;
  s->searches        = attempt >= SEARCHED;
  s->kept            = 0;
  if (lu)
    PetscCall(PreconditionerFallBack(m));
  PetscCall(SNESSetMaxLinearSolveFailures(s->snes, last ? 4 : 1));
  PetscCall(FirstGuess(m, x));
  PetscCall(ModelVelocitiesOfPressures(m, s->X));
  PetscCall(SNESSolve(s->snes, NULL, s->X));
  PetscCall(SNESGetConvergedReason(s->snes, reason));
  PetscCall(SNESGetIterationNumber(s->snes, &its));
  *newton += its - s->kept;
  if (*reason == SNES_DIVERGED_FUNCTION_NANORINF)
    PetscCall(ModelReduceStatus(m, &m->failure.status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelSolve(Model *m, double *x, PetscInt *newton, ClStatus *status)
{
  SNESConvergedReason reason = SNES_CONVERGED_ITERATING;

  PetscFunctionBeginUser;
  PetscCall(ModelReadySolver(m));
  *newton             = 0;
  m->solver->searches = false;
  for (int attempt = 0; attempt < ATTEMPTS && reason <= 0; attempt++) {
    if (reason == SNES_DIVERGED_FUNCTION_NANORINF && m->failure.status != CL_OK)
      break; /* a particle said why */
    if (IsDue(m, attempt, reason))
      PetscCall(Attempt(m, attempt, x, newton, &reason));
  }
  if (reason < 0) {
    PetscCall(Explain(m));
    m->solver->refactor = true;
  } else
    m->failure.status = CL_OK;
  PetscCall(PreconditionerReturn(m));
  PetscCall(ModelReduceStatus(m, status));
  if (*status == CL_OK)
    PetscCall(ModelUnscale(m, m->solver->X, x));
  PetscFunctionReturn(PETSC_SUCCESS);
}
