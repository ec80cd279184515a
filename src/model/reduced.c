/* The reduced preconditioner (170)-(175): a matrix for v_s, p_w, p_g and T alone, of radius 2, and its solver.
   Values are gathered node by node, each with its neighbours; what counts of them (433) is handed to PETSc as one
   matrix, or as two groups of unknowns, `flow` (pressures, temperature) and `motion` (v_s), that PCFIELDSPLIT takes as
   they are. Every option -reduced_... of the solver wins over what stands here. */
#include "solver.h"

enum { FLOW = 0, MOTION, GROUPS };

struct Reduced {
  FieldSet     fs;                           /* unknowns of a node */
  bool         split;                        /* flow, then motion, each with a solver of its own; else one of all */
  int          groups;                       /* that have unknowns */
  int          first[GROUPS], count[GROUPS]; /* their places */
  const char  *prefix;                       /* of the options of the solver */
  int          full[F_COUNT];                /* place in the block of the scene's set */
  double      *value;                        /* [n_local][NEIGHBOURS][fs.n][fs.n]; null between two renewals */
  double       row[F_COUNT], col[F_COUNT];   /* units of rows and columns: each one number for the whole body ... */
  double       unit[F_COUNT][F_COUNT];       /* ... columns over rows */
  Mat          block[GROUPS][GROUPS], A;     /* between two renewals: of the groups; all of it */
  KSP          ksp;                          /* null between steps */
  MatNullSpace rigid;                        /* null without motion */
  Vec          b, y;                         /* owned nodes: all of a group, then all of the next */
  Vec          slaved, diagonal; /* of the scene's set, rows (16) of the Jacobian: times y, their diagonal */
};

#define ROW_MOST_ENTRIES (NEIGHBOURS * F_COUNT)

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

/* Which neighbours a node has, and their numbers, in the order of their columns. */
static int RowNodes(const Model *m, PetscInt I, int k[NEIGHBOURS], PetscInt number[NEIGHBOURS])
{
  int n = 0;

  for (int q = 0; q < NEIGHBOURS; q++) {
    const PetscInt K = ModelNeighbour(m, I, q);
    int            at;

    if (K < 0)
      continue;
    for (at = n++; at > 0 && number[at - 1] > m->map.global[K]; at--) {
      number[at] = number[at - 1];
      k[at]      = k[at - 1];
    }
    number[at] = m->map.global[K];
    k[at]      = q;
  }
  return n;
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

static PetscErrorCode CreateFactors(const Model *m, const Reduced *r)
{
  PC pc;

  PetscFunctionBeginUser;
  PetscCall(KSPGetPC(r->ksp, &pc));
  PetscCall(PCSetType(pc, PCLU));
  PetscCall(PCFactorSetMatSolverType(pc, FactorsPackage(m, r->fs.n)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A new one at every renewal: what multigrid keeps from set-up to set-up would make a run depend on where it was last
   restarted. */
static PetscErrorCode CreateSolver(const Model *m, Reduced *r)
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
  PetscCall(VecDuplicate(m->solver->X, &r->slaved));
  PetscCall(VecDuplicate(m->solver->X, &r->diagonal));
  if (r->split)
    PetscCall(ReducedPreferences(r->groups > 1 || !r->fs.solid, r->fs.solid));
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
  PetscCall(VecDestroy(&r->slaved));
  PetscCall(VecDestroy(&r->diagonal));
  PetscCall(PetscFree(r->value));
  PetscCall(PetscFree(*reduced));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of a field have one unit each, the mean of Newton's scales, so that what is smooth in the body is
   smooth for multigrid. */
static PetscErrorCode Units(Model *m, Reduced *r)
{
  double sum[2 * F_COUNT] = {0.0};

  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int k = 0; k < r->fs.n; k++) {
      const PetscInt q = I * m->c->fields.n + r->full[k];

      sum[k] += m->row_scale[q] / (double)m->map.n_global;
      sum[F_COUNT + k] += m->col_scale[q] / (double)m->map.n_global;
    }
  }
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, sum, 2 * F_COUNT, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  for (int k = 0; k < r->fs.n; k++) {
    r->row[k] = sum[k];
    r->col[k] = sum[F_COUNT + k];
  }
  for (int s = 0; s < r->fs.n; s++) {
    for (int t = 0; t < r->fs.n; t++)
      r->unit[s][t] = r->col[t] / r->row[s];
  }
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
  PetscCall(Units(m, r));
  PetscCall(PetscCalloc1((size_t)m->map.n_local * NEIGHBOURS * r->fs.n * r->fs.n, &r->value));
  to->place = NULL;
  to->value = r->value;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rows and columns of prescribed unknowns stay empty but for what they would have on the diagonal. */
static inline bool Held(const Model *m, const Reduced *r, PetscInt I, int k)
{
  return (m->mask[I] >> r->full[k]) & 1u;
}

static void Scaled(const Model *m, const Reduced *r, PetscInt I, PetscInt K, double *v)
{
  const int nf = r->fs.n;

  for (int s = 0; s < nf; s++) {
    for (int t = 0; t < nf; t++)
      v[s * nf + t] *= r->unit[s][t];
    for (int t = 0; (m->mask[I] || m->mask[K]) && t < nf; t++) {
      if ((I != K || s != t) && (Held(m, r, I, s) || Held(m, r, K, t)))
        v[s * nf + t] = 0.0;
    }
  }
}

/* Row i of a node against all unknowns of its neighbour k. */
static const double *ReducedRow(const Reduced *r, PetscInt I, int k, int i)
{
  return &r->value[((size_t)(I * NEIGHBOURS + k) * r->fs.n + i) * r->fs.n];
}

/* Entries of row i of node I in the columns of a group that are not zero, and the diagonal; of n neighbours. */
static int RowEntries(const Reduced *r, PetscInt I, int i, int t, int n, const int *k, const PetscInt *number,
                      PetscInt *col, double *v)
{
  int count = 0;

  for (int b = 0; b < n; b++) {
    const double *row = ReducedRow(r, I, k[b], i);

    for (int j = r->first[t]; j < r->first[t] + r->count[t]; j++) {
      if (row[j] == 0.0 && (k[b] != NEIGHBOURS / 2 || i != j))
        continue;
      col[count] = number[b] * r->count[t] + j - r->first[t];
      v[count++] = row[j];
    }
  }
  return count;
}

/* Entries of this rank's rows in columns of owned nodes and of others. */
static PetscErrorCode CountEntries(Model *m, const Reduced *r, int s, int t, PetscInt *own, PetscInt *other)
{
  const PetscInt from = m->map.first * r->count[t], end = from + m->map.n_owned * r->count[t];

  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    PetscInt  number[NEIGHBOURS], col[ROW_MOST_ENTRIES];
    double    v[ROW_MOST_ENTRIES];
    int       k[NEIGHBOURS];
    const int n = RowNodes(m, I, k, number);

    for (int i = 0; i < r->count[s]; i++) {
      const int count = RowEntries(r, I, r->first[s] + i, t, n, k, number, col, v);

      own[I * r->count[s] + i] = 0;
      for (int b = 0; b < count; b++)
        own[I * r->count[s] + i] += col[b] >= from && col[b] < end;
      other[I * r->count[s] + i] = count - own[I * r->count[s] + i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillEntries(Model *m, const Reduced *r, int s, int t, Mat A)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    PetscInt  number[NEIGHBOURS], col[ROW_MOST_ENTRIES];
    double    v[ROW_MOST_ENTRIES];
    int       k[NEIGHBOURS];
    const int n = RowNodes(m, I, k, number);

    for (int i = 0; i < r->count[s]; i++) {
      const PetscInt row   = m->map.global[I] * r->count[s] + i;
      const int      count = RowEntries(r, I, r->first[s] + i, t, n, k, number, col, v);

      PetscCall(MatSetValues(A, 1, &row, count, col, v, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateBlock(Model *m, const Reduced *r, int s, int t, Mat *A)
{
  const PetscInt rows = m->map.n_owned * r->count[s];
  PetscInt      *own, *other;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(rows, &own, rows, &other));
  PetscCall(CountEntries(m, r, s, t, own, other));
  PetscCall(MatCreate(m->grid.comm, A));
  PetscCall(MatSetSizes(*A, rows, m->map.n_owned * r->count[t], PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSetBlockSizes(*A, r->count[s], r->count[t]));
  PetscCall(MatSeqAIJSetPreallocation(*A, 0, own));           /* does nothing where there are several ranks ... */
  PetscCall(MatMPIAIJSetPreallocation(*A, 0, own, 0, other)); /* ... or one */
  PetscCall(MatSetOption(*A, MAT_NO_OFF_PROC_ENTRIES, PETSC_TRUE));
  PetscCall(PetscFree2(own, other));
  PetscCall(FillEntries(m, r, s, t, *A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (433) in the rows of node I: what does not count becomes zero. */
static void LeaveOut(const Reduced *r, PetscInt I, double drop)
{
  const int nf   = r->fs.n;
  double   *node = &r->value[(size_t)I * NEIGHBOURS * nf * nf], most[F_COUNT] = {0.0};

  for (int e = 0; e < NEIGHBOURS * nf; e++) {
    double *row = &most[e % nf];

    for (int j = 0; j < nf; j++)
      *row = fabs(node[e * nf + j]) > *row ? fabs(node[e * nf + j]) : *row;
  }
  for (int e = 0; e < NEIGHBOURS * nf; e++) {
    const double least = drop * most[e % nf];

    for (int j = 0; j < nf; j++)
      node[e * nf + j] = fabs(node[e * nf + j]) > least || e == NEIGHBOURS / 2 * nf + j ? node[e * nf + j] : 0.0;
  }
}

/* The values scaled, those of this rank's nodes whole, as far as they count. */
static PetscErrorCode ScaleValues(Model *m, const Reduced *r)
{
  const int size = r->fs.n * r->fs.n;

  PetscFunctionBeginUser;
  PetscCall(NodeMapReduce(&m->map, r->value, NEIGHBOURS * size));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int q = 0; q < NEIGHBOURS; q++) {
      const PetscInt K = ModelNeighbour(m, I, q);

      if (K >= 0)
        Scaled(m, r, I, K, &r->value[(size_t)(I * NEIGHBOURS + q) * size]);
    }
    LeaveOut(r, I, m->solver->drop);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMatrices(Model *m, Reduced *r)
{
  Mat       a[GROUPS * GROUPS];
  PetscBool all;

  PetscFunctionBeginUser;
  /* a split that solves for the flow and then for the motion never reads what motion does to the flow */
  PetscCall(PetscOptionsHasName(NULL, NULL, "-reduced_pc_fieldsplit_type", &all));
  for (int s = 0; s < r->groups; s++) {
    for (int t = 0; t < r->groups; t++) {
      if (all || s != FLOW || t != MOTION)
        PetscCall(CreateBlock(m, r, s, t, &r->block[s][t]));
      a[r->groups * s + t] = r->block[s][t];
    }
  }
  if (r->rigid)
    PetscCall(MatSetNearNullSpace(r->block[r->groups - 1][r->groups - 1], r->rigid));
  if (r->groups > 1) {
    PetscCall(MatCreateNest(m->grid.comm, r->groups, NULL, r->groups, NULL, a, &r->A));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  r->A = a[0];
  PetscCall(PetscObjectReference((PetscObject)r->A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedSetUp(Model *m)
{
  Reduced *r = m->solver->reduced;

  PetscFunctionBeginUser;
  PetscCall(ScaleValues(m, r));
  PetscCall(CreateMatrices(m, r));
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

      b[Place(m, r, I, k)] = Held(m, r, I, k) ? 0.0 : a[q] * m->row_scale[q] / r->row[k];
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

      x[q] = Held(m, r, I, k) ? a[q] : y[Place(m, r, I, k)] * r->col[k] / m->col_scale[q];
    }
  }
  PetscCall(VecRestoreArray(Y, &x));
  PetscCall(VecRestoreArrayRead(r->y, &y));
  PetscCall(VecRestoreArrayRead(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Fluid velocities of Y from their rows (16), which couple them with nothing but themselves and what `slaved` holds. */
static PetscErrorCode SolveSlaved(const Model *m, const Reduced *r, Vec R, Vec Y)
{
  const FieldSet *fs = &m->c->fields;
  const double   *a, *s, *d;
  double         *x;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(R, &a));
  PetscCall(VecGetArrayRead(r->slaved, &s));
  PetscCall(VecGetArrayRead(r->diagonal, &d));
  PetscCall(VecGetArray(Y, &x));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++) {
    const int q = fs->field[k % fs->n];

    if (q >= F_VW && q < F_PW)
      x[k] = (a[k] - s[k]) / d[k];
  }
  PetscCall(VecRestoreArray(Y, &x));
  PetscCall(VecRestoreArrayRead(r->diagonal, &d));
  PetscCall(VecRestoreArrayRead(r->slaved, &s));
  PetscCall(VecRestoreArrayRead(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (175) */
static PetscErrorCode RecoverVelocities(Model *m, Reduced *r, Vec R, Vec Y)
{
  PetscFunctionBeginUser;
  if (r->fs.n == m->c->fields.n)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (m->solver->product)
    PetscCall(ProductMult(m, true, Y, r->slaved));
  else
    PetscCall(MatMult(m->solver->J2, Y, r->slaved));
  PetscCall(SolveSlaved(m, r, R, Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedGuess(Model *m, Vec R, Vec Y)
{
  Reduced *r = m->solver->reduced;

  PetscFunctionBeginUser;
  PetscCall(VecSet(Y, 0.0));
  if (r->fs.n == m->c->fields.n)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(VecSet(r->slaved, 0.0));
  PetscCall(SolveSlaved(m, r, R, Y));
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
