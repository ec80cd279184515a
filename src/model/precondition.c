/* Which preconditioner GMRES has, when it is made anew, and what takes over where it breaks down. */
#include "solver.h"
#include "clathra/words.h"

/* What it costs to make one, in GMRES iterations, measured (docs/studies/benchmark.md): multigrid whatever the size;
   LU, whose work grows faster than that of an iteration, by the square root of the number of unknowns. */
#define COST_MULTIGRID 3.0
#define COST_LU_LEAST 10.0
#define COST_LU 0.24

/* Unknowns of the reduced matrix across the body from which multigrid takes over from LU (330). */
#define ACROSS_LU (CL_DIM == 3 ? 180.0 : 250.0)

/* Cells that hold particles: their number, and the box about them. */
static PetscErrorCode Occupied(const Model *m, PetscInt *count, PetscInt extent[CL_DIM])
{
  const Grid    *g = &m->grid;
  PetscInt       end[2 * CL_DIM];
  unsigned char *seen;

  PetscFunctionBeginUser;
  *count = 0;
  for (int k = 0; k < 2 * CL_DIM; k++)
    end[k] = PETSC_MIN_INT;
  PetscCall(PetscCalloc1(GridPaddedSize(g), &seen));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double   x[CL_DIM];
    PetscInt cell[CL_DIM];

    ParticleGridPlace(&m->P, p, x);
    if (!GridCell(g, x, cell))
      continue;
    unsigned char *here = &seen[GridPadded(g, cell)];
    *count += !*here;
    *here = 1;
    for (int d = 0; d < CL_DIM; d++) {
      end[d]          = PetscMax(end[d], cell[d]);
      end[CL_DIM + d] = PetscMax(end[CL_DIM + d], -cell[d]);
    }
  }
  PetscCall(PetscFree(seen));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, count, 1, MPIU_INT, MPI_SUM, g->comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, end, 2 * CL_DIM, MPIU_INT, MPI_MAX, g->comm));
  for (int d = 0; d < CL_DIM; d++)
    extent[d] = *count > 0 ? end[d] + end[CL_DIM + d] + 1 : 1;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Has the user given one of these options?  Then it chose. */
static PetscErrorCode Given(SolverPlan *plan, int n, const char *const option[], bool *given)
{
  PetscFunctionBeginUser;
  *given = false;
  for (int k = 0; k < n && !*given; k++) {
    PetscBool own;

    PetscCall(PetscOptionsHasName(NULL, NULL, option[k], &own));
    if (own)
      plan->asked = option[k];
    *given = own;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define COUNT(a) ((int)(sizeof(a) / sizeof(*(a))))

/* Does the user ask for LU of the reduced matrix, or for something else of all of it, or for multigrid? */
static PetscErrorCode FactorsAskedFor(SolverPlan *plan)
{
  static const char *const groups[] = {"-reduced_fieldsplit_flow_pc_type", "-reduced_fieldsplit_motion_pc_type",
                                       "-reduced_pc_fieldsplit_type"};
  char                     type[32];
  PetscBool                all, split;
  bool                     given;

  PetscFunctionBeginUser;
  PetscCall(Given(plan, COUNT(groups), groups, &given));
  plan->factors = plan->factors && !given;
  PetscCall(PetscOptionsGetString(NULL, NULL, "-reduced_pc_type", type, sizeof(type), &all));
  if (!all)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscStrcmp(type, PCFIELDSPLIT, &split));
  plan->factors = !split;
  plan->asked   = "-reduced_pc_type";
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options that ask for a solver; a matrix that the user names stays where Krylov's method alone is given. */
static PetscErrorCode AskedFor(SolverPlan *plan, int matrix)
{
  static const char *const whole[] = {"-pc_type", "-ksp_type", "-model_pmat_type"};
  bool                     given;

  PetscFunctionBeginUser;
  plan->asked = matrix == PRECONDITIONER_AUTO ? NULL : "-newton_preconditioner";
  PetscCall(Given(plan, matrix == PRECONDITIONER_AUTO ? COUNT(whole) : 1, whole, &given));
  plan->reduced = plan->reduced && !given;
  if (plan->reduced)
    PetscCall(FactorsAskedFor(plan));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What elimination leaves of a node's unknowns. */
static int Left(const FieldSet *fs)
{
  int n = 0;

  for (int k = 0; k < fs->n; k++)
    n += fs->field[k] < F_VW || fs->field[k] >= F_PW;
  return n;
}

static double AcrossLU(const FieldSet *fs)
{
  return ACROSS_LU / Left(fs);
}

/* Mean number of cells across the body: how many along its longest axis share a layer; in space layers are faces, whose
   LU costs as the square of that. */
static double Across(PetscInt cells, const PetscInt extent[CL_DIM])
{
  PetscInt longest = extent[0];

  for (int d = 1; d < CL_DIM; d++)
    longest = PetscMax(longest, extent[d]);
  return (double)cells / (double)longest;
}

PetscErrorCode PreconditionerPlan(Model *m)
{
  const int   matrix = m->solver->preconditioner;
  SolverPlan *plan   = &m->solver->plan;
  PetscInt    cells, extent[CL_DIM];

  PetscFunctionBeginUser;
  PetscCall(Occupied(m, &cells, extent));
  plan->across  = Across(cells, extent);
  plan->factors = plan->across <= AcrossLU(&m->c->fields);
  plan->reduced =
      matrix == PRECONDITIONER_REDUCED || (matrix == PRECONDITIONER_AUTO && !(plan->factors && SceneDonor(m->c)));
  PetscCall(AskedFor(plan, matrix));
  PetscFunctionReturn(PETSC_SUCCESS);
}

int ModelFactored(const Model *m)
{
  const SolverPlan *plan = &m->solver->plan;

  if (!plan->reduced)
    return m->c->fields.n;
  return plan->factors ? Left(&m->c->fields) : 0;
}

PetscErrorCode ModelPrintSolver(Model *m)
{
  SolverPlan *plan     = &m->solver->plan;
  const char *name     = plan->reduced ? "-reduced_pc_type" : "-pc_type";
  char        type[64] = "", why[128];

  PetscFunctionBeginUser;
  if (plan->said)
    PetscFunctionReturn(PETSC_SUCCESS);
  plan->said = true;
  PetscCall(PetscOptionsGetString(NULL, NULL, name, type, sizeof(type), NULL));
  if (!type[0])
    PetscCall(PetscStrncpy(type, plan->reduced && !plan->factors ? "multigrid" : PCLU, sizeof(type)));
  if (plan->asked)
    snprintf(why, sizeof(why), "as %s asks", plan->asked);
  else if (!plan->reduced)
    snprintf(why, sizeof(why), "%.3g cells across, stabilisation_donor", plan->across);
  else
    snprintf(why, sizeof(why), "%.3g cells across, %d of %d unknowns a node (lu up to %.3g across)", plan->across,
             Left(&m->c->fields), m->c->fields.n, AcrossLU(&m->c->fields));
  PetscCall(PetscPrintf(m->grid.comm, "  preconditioner: %s of the %s matrix: %s\n", type,
                        plan->reduced ? "reduced" : "whole", why));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ApplyReduced(PC pc, Vec R, Vec Y)
{
  Model *m;

  PetscFunctionBeginUser;
  PetscCall(PCShellGetContext(pc, &m));
  PetscCall(PetscLogEventBegin(m->event[EVENT_REDUCED], 0, 0, 0, 0));
  PetscCall(ReducedApply(m, R, Y));
  PetscCall(PetscLogEventEnd(m->event[EVENT_REDUCED], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (441): GMRES starts where the rows that were eliminated are solved; LU of the whole starts from nothing. */
static PetscErrorCode Guess(KSP ksp, Vec R, Vec Y, void *model)
{
  Model *m = (Model *)model;

  PetscFunctionBeginUser;
  (void)ksp;
  if (m->solver->reduces)
    PetscCall(ReducedGuess(m, R, Y));
  else
    PetscCall(VecSet(Y, 0.0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What GMRES begins with. */
static PetscErrorCode FirstResidual(KSP ksp, Vec R, PetscReal *first)
{
  const PetscReal *history;
  PetscInt         n;

  PetscFunctionBeginUser;
  PetscCall(KSPGetResidualHistory(ksp, &history, &n));
  if (n > 0)
    *first = history[0];
  else
    PetscCall(VecNorm(R, NORM_2, first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static double Cost(const Model *m)
{
  const Solver *s = m->solver;

  return s->reduces && !s->plan.factors
             ? COST_MULTIGRID
             : fmax(COST_LU_LEAST, COST_LU * sqrt((double)m->map.n_global * (double)m->c->fields.n));
}

/* (176): iterations per decade that the residual fell, with a new preconditioner and since. */
static PetscErrorCode CountIterations(KSP ksp, Vec R, Vec Y, void *model)
{
  Model         *m = (Model *)model;
  Renewal       *w = &m->solver->renewal;
  PetscReal      first, last;
  PetscInt       its;
  const PetscInt most = m->solver->poor;

  PetscFunctionBeginUser;
  (void)Y;
  PetscCall(KSPGetIterationNumber(ksp, &its));
  PetscCall(KSPGetResidualNorm(ksp, &last));
  PetscCall(FirstResidual(ksp, R, &first));
  const double decades = first > 0.0 && last > 0.0 ? log10(first / last) : 0.0;
  if (w->fresh) {
    w->per_decade = decades > 0.0 ? (double)its / decades : INFINITY;
    w->lost       = 0.0;
    w->fresh      = false;
  } else {
    w->lost += fmax((double)its - w->per_decade * fmax(decades, 0.0), 0.0);
  }
  w->due = most >= 0 ? its > most : w->lost > Cost(m);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PreconditionerCreate(Model *m, KSP ksp)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(ksp, &pc));
  PetscCall(KSPSetPostSolve(ksp, CountIterations, m));
  if (m->solver->reduces) {
    PetscCall(ReducedCreate(m));
    PetscCall(PCSetType(pc, PCSHELL));
    PetscCall(PCShellSetName(pc, "reduced"));
    PetscCall(PCShellSetContext(pc, m));
    PetscCall(PCShellSetApply(pc, ApplyReduced));
    PetscCall(KSPSetTolerances(ksp, 1e-4, PETSC_DEFAULT, PETSC_DEFAULT, 200));
    PetscCall(KSPGMRESSetRestart(ksp, 200));
    PetscCall(KSPSetPreSolve(ksp, Guess, m));
    PetscCall(KSPSetInitialGuessNonzero(ksp, PETSC_TRUE));
    PetscCall(KSPConvergedDefaultSetUIRNorm(ksp));
    PetscCall(KSPSetResidualHistory(ksp, NULL, 1, PETSC_TRUE));
  } else {
    PetscCall(FactorsUse(m, m->solver->Pmat, m->c->fields.n, pc));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

void PreconditionerRenew(Model *m)
{
  m->solver->refactor = true;
}

PetscErrorCode PreconditionerChoose(Model *m, SNES snes, bool *renew)
{
  PetscFunctionBeginUser;
  *renew = m->solver->refactor || m->solver->always_refactor || m->solver->renewal.due ||
           fabs(m->stage.dt - m->solver->factored_dt) > 1e-3 * m->solver->factored_dt;
  if (snes)
    PetscCall(SNESSetLagPreconditioner(snes, *renew ? -2 : -1)); /* -2: once, now; -1: never again */
  m->solver->refactor = false;
  if (!*renew)
    PetscFunctionReturn(PETSC_SUCCESS);
  m->solver->factored_dt = m->stage.dt;
  m->solver->renewal     = (Renewal){.fresh = true};
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PreconditionerFallBack(Model *m)
{
  KSPConvergedReason reason;
  const char        *why;
  KSP                ksp;
  PC                 pc;

  PetscFunctionBeginUser;
  PetscCall(SNESGetKSP(m->solver->snes, &ksp));
  PetscCall(KSPGetConvergedReason(ksp, &reason));
  why = reason == KSP_DIVERGED_ITS ? "too many iterations" : KSPConvergedReasons[reason];
  PetscCall(PetscPrintf(m->grid.comm,
                        "t = %s: the reduced preconditioner broke down (%s); LU of the whole solves this stage\n",
                        TimeAt(m->stage.t).s, why));
  PetscCall(KSPGetPC(ksp, &m->solver->set_aside));
  PetscCall(PetscObjectReference((PetscObject)m->solver->set_aside));
  const bool whole = m->solver->J2 != NULL;

  if (!whole)
    PetscCall(MatrixCreate(m));
  PetscCall(PCCreate(m->grid.comm, &pc));
  PetscCall(FactorsUse(m, m->solver->J2, m->c->fields.n, pc));
  PetscCall(KSPSetPC(ksp, pc));
  PetscCall(PCDestroy(&pc));
  m->solver->reduces = false;
  if (whole)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESSetJacobian(m->solver->snes, m->solver->A, m->solver->J2, NULL, NULL));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode PreconditionerReturn(Model *m)
{
  KSP ksp;

  PetscFunctionBeginUser;
  if (!m->solver->set_aside)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESGetKSP(m->solver->snes, &ksp));
  PetscCall(KSPSetPC(ksp, m->solver->set_aside));
  PetscCall(PCDestroy(&m->solver->set_aside));
  m->solver->reduces  = true;
  m->solver->refactor = true;
  if (!m->solver->product)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(SNESSetJacobian(m->solver->snes, m->solver->A, m->solver->A, NULL, NULL));
  PetscCall(MatrixDestroy(m->solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}
