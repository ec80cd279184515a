/* The reduced preconditioner (170)-(175): a matrix for v_s, p_w, p_g and T alone, of radius 2, and its solver.
   Values are gathered node by node, each with its neighbours; they become (reduced_matrix.c) one matrix, or two groups
   of unknowns, `flow` (pressures, temperature) and `motion` (v_s), that PCFIELDSPLIT takes as they are. Every option
   -reduced_... of the solver wins over what stands here. */
#include "reduced.h"

static void Unknowns(const FieldSet *fs, Reduced *r)
{
  int place[F_COUNT] = {0};

  r->fs   = *fs;
  r->fs.n = 0;
  for (int k = 0; k < fs->n; k++) {
    const int q = fs->field[k];

    place[k] = -1;
    if (q >= F_VW && q < F_PW)
      continue;
    place[k]               = r->fs.n;
    r->full[r->fs.n]       = k;
    r->fs.field[r->fs.n++] = q;
  }
  for (int q = 0; q < F_COUNT; q++)
    r->fs.at[q] = fs->at[q] >= 0 ? place[fs->at[q]] : -1;
}

static void AddGroup(Reduced *r, int first, int count)
{
  if (count == 0)
    return;
  r->first[r->groups]   = first;
  r->count[r->groups++] = count;
}

/* Displacement comes first among the unknowns. */
static void FindGroups(Reduced *r)
{
  const int motion = r->fs.solid ? CL_DIM : 0;

  r->prefix = "reduced_";
  if (!r->split) {
    AddGroup(r, 0, r->fs.n);
    return;
  }
  AddGroup(r, motion, r->fs.n - motion);
  AddGroup(r, 0, motion);
  if (r->groups == 1)
    r->prefix = motion ? "reduced_fieldsplit_motion_" : "reduced_fieldsplit_flow_";
}

/* Rigid motions of the body, which algebraic multigrid must carry to its coarse grids. */
static PetscErrorCode RigidMotions(const Model *m, MatNullSpace *null)
{
  const NodeMap *map = &m->map;
  Vec            x;
  double        *a;

  PetscFunctionBeginUser;
  PetscCall(VecCreateMPI(m->grid.comm, CL_DIM * map->n_owned, PETSC_DETERMINE, &x));
  PetscCall(VecSetBlockSize(x, CL_DIM));
  if (m->c->axisymmetric) { /* only along the axis */
    PetscCall(VecStrideSet(x, 1, 1.0));
    PetscCall(VecNormalize(x, NULL));
    PetscCall(MatNullSpaceCreate(m->grid.comm, PETSC_FALSE, 1, &x, null));
  } else {
    PetscCall(VecGetArrayWrite(x, &a));
    for (PetscInt I = 0; I < map->n_owned; I++) {
      for (int d = 0; d < CL_DIM; d++)
        a[CL_DIM * I + d] = GridNode(&m->grid, d, map->ij[I][d]);
    }
    PetscCall(VecRestoreArrayWrite(x, &a));
    PetscCall(MatNullSpaceCreateRigidBody(x, null));
  }
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateSplit(const Reduced *r)
{
  static const char *const name[GROUPS] = {"flow", "motion"};
  IS                       is[GROUPS];
  PC                       pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(r->ksp, &pc));
  PetscCall(PCSetType(pc, PCFIELDSPLIT));
  PetscCall(PCFieldSplitSetType(pc, PC_COMPOSITE_MULTIPLICATIVE));
  PetscCall(MatNestGetISs(r->A, is, NULL));
  for (int s = 0; s < GROUPS; s++)
    PetscCall(PCFieldSplitSetIS(pc, name[s], is[s]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateFactors(Model *m, const Reduced *r)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(r->ksp, &pc));
  PetscCall(FactorsUse(m, r->A, r->fs.n, pc));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A new one at every renewal: what multigrid keeps from set-up to set-up would make a run depend on where it was last
   restarted. */
static PetscErrorCode CreateSolver(Model *m, Reduced *r)
{
  PetscFunctionBeginUser;
  PetscCall(KSPCreate(m->grid.comm, &r->ksp));
  PetscCall(KSPSetType(r->ksp, KSPPREONLY));
  PetscCall(KSPSetOptionsPrefix(r->ksp, r->prefix));
  if (!r->split)
    PetscCall(CreateFactors(m, r));
  else if (r->groups > 1)
    PetscCall(CreateSplit(r));
  PetscCall(KSPSetOperators(r->ksp, r->A, r->A));
  PetscCall(KSPSetFromOptions(r->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroySolver(Reduced *r)
{
  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&r->ksp));
  PetscCall(MatDestroy(&r->A));
  for (int k = 0; k < GROUPS * GROUPS; k++)
    PetscCall(MatDestroy(&r->block[k / GROUPS][k % GROUPS]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedCreate(Model *m)
{
  Reduced *r;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  m->solver->reduced = r;
  r->split           = !m->solver->plan.factors;
  Unknowns(&m->c->fields, r);
  FindGroups(r);
  if (r->split && r->fs.solid)
    PetscCall(RigidMotions(m, &r->rigid));
  PetscCall(VecCreateMPI(m->grid.comm, r->fs.n * m->map.n_owned, PETSC_DETERMINE, &r->b));
  PetscCall(VecDuplicate(r->b, &r->y));
  PetscCall(VecDuplicate(m->solver->X, &r->velocity_rows));
  PetscCall(VecDuplicate(m->solver->X, &r->diagonal));
  if (r->split)
    PetscCall(ReducedPreferences(r->groups > 1 || !r->fs.solid, r->fs.solid));
  else
    PetscCall(ReducedFactorsPreferences());
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedRest(Reduced *r)
{
  PetscFunctionBeginUser;
  if (r)
    PetscCall(DestroySolver(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedDestroy(Reduced **reduced)
{
  Reduced *r = *reduced;

  PetscFunctionBeginUser;
  if (!r)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(DestroySolver(r));
  PetscCall(MatNullSpaceDestroy(&r->rigid));
  PetscCall(VecDestroy(&r->b));
  PetscCall(VecDestroy(&r->y));
  PetscCall(VecDestroy(&r->velocity_rows));
  PetscCall(VecDestroy(&r->diagonal));
  PetscCall(PetscFree(r->value));
  PetscCall(PetscFree(*reduced));
  PetscFunctionReturn(PETSC_SUCCESS);
}

const FieldSet *ReducedFields(const Model *m)
{
  return &m->solver->reduced->fs;
}

PetscErrorCode ReducedBegin(Model *m, Assembly *to)
{
  Reduced *r = m->solver->reduced;

  PetscFunctionBeginUser;
  PetscCall(DestroySolver(r)); /* not beside what is gathered now */
  to->reduced      = true;
  to->fixed_stress = r->split && r->groups > 1;
  PetscCall(ReducedUnits(m, r));
  PetscCall(PetscCalloc1((size_t)m->map.n_local * NEIGHBOURS * r->fs.n * r->fs.n, &r->value));
  to->place = NULL;
  to->value = r->value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedSetUp(Model *m)
{
  Reduced *r = m->solver->reduced;

  PetscFunctionBeginUser;
  PetscCall(ReducedMatrices(m, r));
  PetscCall(PetscFree(r->value));
  PetscCall(CreateSolver(m, r));
  PetscCall(KSPSetUp(r->ksp));
  PetscCall(KSPSetUpOnBlocks(r->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedFollow(Model *m)
{
  PetscFunctionBeginUser;
  if (m->solver->product)
    PetscCall(ProductDiagonal(m, m->solver->reduced->diagonal));
  else
    PetscCall(MatGetDiagonal(m->solver->J2, m->solver->reduced->diagonal));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Place of unknown k of owned node I in b and y. */
static inline PetscInt Place(const Model *m, const Reduced *r, PetscInt I, int k)
{
  PetscInt before = 0;
  int      s      = 0;

  for (; s < r->groups - 1 && (k < r->first[s] || k >= r->first[s] + r->count[s]); s++)
    before += m->map.n_owned * r->count[s];
  return before + I * r->count[s] + k - r->first[s];
}

static PetscErrorCode Restrict(const Model *m, const Reduced *r, Vec R)
{
  const double *a;
  double       *b;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(R, &a));
  PetscCall(VecGetArrayWrite(r->b, &b));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int k = 0; k < r->fs.n; k++) {
      const PetscInt q = I * m->c->fields.n + r->full[k];

      b[Place(m, r, I, k)] = ReducedHolds(m, r, I, k) ? 0.0 : a[q] * m->row_scale[q] / r->row[k];
    }
  }
  PetscCall(VecRestoreArrayWrite(r->b, &b));
  PetscCall(VecRestoreArrayRead(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The fluid velocities stay zero. */
static PetscErrorCode Prolong(const Model *m, const Reduced *r, Vec R, Vec Y)
{
  const double *a, *y;
  double       *x;

  PetscFunctionBeginUser;
  PetscCall(VecSet(Y, 0.0));
  PetscCall(VecGetArrayRead(R, &a));
  PetscCall(VecGetArrayRead(r->y, &y));
  PetscCall(VecGetArray(Y, &x));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int k = 0; k < r->fs.n; k++) {
      const PetscInt q = I * m->c->fields.n + r->full[k];

      x[q] = ReducedHolds(m, r, I, k) ? a[q] : y[Place(m, r, I, k)] * r->col[k] / m->col_scale[q];
    }
  }
  PetscCall(VecRestoreArray(Y, &x));
  PetscCall(VecRestoreArrayRead(r->y, &y));
  PetscCall(VecRestoreArrayRead(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fluid velocities of Y from their rows (16), which couple them with nothing but themselves and what `velocity_rows`
 * holds. */
static PetscErrorCode SolveVelocities(const Model *m, const Reduced *r, Vec R, Vec Y)
{
  const FieldSet *fs = &m->c->fields;
  const double   *a, *s, *d;
  double         *x;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(R, &a));
  PetscCall(VecGetArrayRead(r->velocity_rows, &s));
  PetscCall(VecGetArrayRead(r->diagonal, &d));
  PetscCall(VecGetArray(Y, &x));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++) {
    const int q = fs->field[k % fs->n];

    if (q >= F_VW && q < F_PW)
      x[k] = (a[k] - s[k]) / d[k];
  }
  PetscCall(VecRestoreArray(Y, &x));
  PetscCall(VecRestoreArrayRead(r->diagonal, &d));
  PetscCall(VecRestoreArrayRead(r->velocity_rows, &s));
  PetscCall(VecRestoreArrayRead(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fluid velocities of the reduced solution (175). */
static PetscErrorCode RecoverVelocities(Model *m, Reduced *r, Vec R, Vec Y)
{
  PetscFunctionBeginUser;
  if (r->fs.n == m->c->fields.n)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (m->solver->product)
    PetscCall(ProductMult(m, true, Y, r->velocity_rows));
  else
    PetscCall(MatMult(m->solver->J2, Y, r->velocity_rows));
  PetscCall(SolveVelocities(m, r, R, Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedGuess(Model *m, Vec R, Vec Y)
{
  Reduced *r = m->solver->reduced;

  PetscFunctionBeginUser;
  PetscCall(VecSet(Y, 0.0));
  if (r->fs.n == m->c->fields.n)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecSet(r->velocity_rows, 0.0));
  PetscCall(SolveVelocities(m, r, R, Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedApply(Model *m, Vec R, Vec Y)
{
  Reduced *r = m->solver->reduced;

  PetscFunctionBeginUser;
  PetscCall(Restrict(m, r, R));
  PetscCall(KSPSolve(r->ksp, r->b, r->y));
  PetscCall(Prolong(m, r, R, Y));
  PetscCall(RecoverVelocities(m, r, R, Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}
