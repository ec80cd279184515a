/* The reduced preconditioner (170)-(175): a matrix for v_s, p_w, p_g and T alone, of radius 2, and its solver.
   Values are gathered node by node, each with its 25 neighbours, and handed to PETSc as two groups of unknowns, `flow`
   (pressures, temperature) and `motion` (v_s), that PCFIELDSPLIT takes as they are.  Every option -reduced_... of the
   solver wins over what stands here. */
#include "solver.h"

enum { FLOW = 0, MOTION, GROUPS };

struct Reduced {
  FieldSet fs;                                 /* unknowns of a node */
  int      first[GROUPS], count[GROUPS];       /* their places */
  int      full[F_COUNT];                      /* place in the block of the scene's set */
  double  *value;                              /* [n_local][NEIGHBOURS][fs.n][fs.n]; null between two renewals */
  double   row[F_COUNT], col[F_COUNT];         /* units of rows and columns: each one number for the whole body ... */
  double   unit[F_COUNT][F_COUNT];             /* ... columns over rows */
  Mat      block[GROUPS][GROUPS], nest, whole; /* whole: what wants one matrix, as anything but a split does */
  KSP      ksp;                                /* null between steps */
  bool     split;                              /* its preconditioner is PCFIELDSPLIT */
  Vec      b, y;                               /* owned nodes: flow of all, then motion of all */
  Vec      slaved, diagonal; /* of the scene's set, rows (16) of the Jacobian: times y, their diagonal */
};

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
  r->first[MOTION] = 0;
  r->count[MOTION] = r->first[FLOW] = fs->solid ? CL_DIM : 0;
  r->count[FLOW]                    = r->fs.n - r->first[FLOW];
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

/* With its pattern: all neighbours that are there. */
static PetscErrorCode CreateBlock(Model *m, int rows, int cols, Mat *A)
{
  const PetscInt n = m->map.n_owned;
  PetscInt      *start, *col, nz = 0;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n * rows + 1, &start, n * rows * NEIGHBOURS * cols, &col));
  for (PetscInt I = 0; I < n; I++) {
    PetscInt  number[NEIGHBOURS];
    int       k[NEIGHBOURS];
    const int count = RowNodes(m, I, k, number);

    for (int i = 0; i < rows; i++) {
      start[I * rows + i] = nz;
      for (int b = 0; b < count; b++) {
        for (int j = 0; j < cols; j++)
          col[nz++] = number[b] * cols + j;
      }
    }
  }
  start[n * rows] = nz;
  PetscCall(MatCreate(m->grid.comm, A));
  PetscCall(MatSetSizes(*A, n * rows, n * cols, PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSetBlockSizes(*A, rows, cols));
  PetscCall(MatSeqAIJSetPreallocationCSR(*A, start, col, NULL)); /* does nothing where there are several ranks ... */
  PetscCall(MatMPIAIJSetPreallocationCSR(*A, start, col, NULL)); /* ... or one */
  PetscCall(PetscFree2(start, col));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Rigid motions of the body, which algebraic multigrid must carry to its coarse grids. */
static PetscErrorCode RigidMotions(Model *m, Mat A)
{
  const NodeMap *map = &m->map;
  MatNullSpace   null;
  Vec            v[3], x;
  double        *a;

  PetscFunctionBeginUser;
  PetscCall(MatCreateVecs(A, &x, NULL));
  PetscCall(VecSetBlockSize(x, CL_DIM));
  if (m->c->axisymmetric) { /* only along the axis */
    PetscCall(VecStrideSet(x, 1, 1.0));
    PetscCall(VecNormalize(x, NULL));
    v[0] = x;
    PetscCall(MatNullSpaceCreate(m->grid.comm, PETSC_FALSE, 1, v, &null));
  } else {
    PetscCall(VecGetArrayWrite(x, &a));
    for (PetscInt I = 0; I < map->n_owned; I++) {
      for (int d = 0; d < CL_DIM; d++)
        a[CL_DIM * I + d] = GridNode(&m->grid, d, map->ij[I][d]);
    }
    PetscCall(VecRestoreArrayWrite(x, &a));
    PetscCall(MatNullSpaceCreateRigidBody(x, &null));
  }
  PetscCall(MatSetNearNullSpace(A, null));
  PetscCall(MatNullSpaceDestroy(&null));
  PetscCall(VecDestroy(&x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A split that solves for the flow and then for the motion never reads what motion does to the flow. */
static PetscErrorCode ReadsAll(bool *all)
{
  PetscBool type, split;

  PetscFunctionBeginUser;
  PetscCall(PetscOptionsHasName(NULL, NULL, "-reduced_pc_type", &type));
  PetscCall(PetscOptionsHasName(NULL, NULL, "-reduced_pc_fieldsplit_type", &split));
  *all = type || split;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateMatrices(Model *m, Reduced *r)
{
  Mat        a[GROUPS * GROUPS];
  const bool both = r->count[FLOW] > 0 && r->count[MOTION] > 0;
  bool       all  = true;

  PetscFunctionBeginUser;
  PetscCall(ReadsAll(&all));
  for (int s = 0; s < GROUPS; s++) {
    for (int t = 0; t < GROUPS; t++) {
      if (r->count[s] > 0 && r->count[t] > 0 && (all || s != FLOW || t != MOTION))
        PetscCall(CreateBlock(m, r->count[s], r->count[t], &r->block[s][t]));
      a[GROUPS * s + t] = r->block[s][t];
    }
  }
  if (r->count[MOTION] > 0)
    PetscCall(RigidMotions(m, r->block[MOTION][MOTION]));
  if (both) {
    PetscCall(MatCreateNest(m->grid.comm, GROUPS, NULL, GROUPS, NULL, a, &r->nest));
  } else {
    r->nest = r->block[r->count[FLOW] > 0 ? FLOW : MOTION][r->count[FLOW] > 0 ? FLOW : MOTION];
    PetscCall(PetscObjectReference((PetscObject)r->nest));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateSplit(Reduced *r)
{
  static const char *const name[GROUPS] = {"flow", "motion"};
  IS                       is[GROUPS];
  PC                       pc;

  PetscFunctionBeginUser;
  PetscCall(KSPSetOptionsPrefix(r->ksp, "reduced_"));
  PetscCall(KSPGetPC(r->ksp, &pc));
  PetscCall(PCSetType(pc, PCFIELDSPLIT));
  PetscCall(PCFieldSplitSetType(pc, PC_COMPOSITE_MULTIPLICATIVE));
  PetscCall(MatNestGetISs(r->nest, is, NULL));
  for (int s = 0; s < GROUPS; s++)
    PetscCall(PCFieldSplitSetIS(pc, name[s], is[s]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A new one at every renewal: what multigrid keeps from set-up to set-up would make a run depend on where it was last
   restarted. */
static PetscErrorCode CreateSolver(Reduced *r)
{
  PetscBool split;
  PC        pc;

  PetscFunctionBeginUser;
  PetscCall(KSPDestroy(&r->ksp));
  PetscCall(KSPCreate(PetscObjectComm((PetscObject)r->nest), &r->ksp));
  PetscCall(KSPSetType(r->ksp, KSPPREONLY));
  if (r->count[FLOW] > 0 && r->count[MOTION] > 0)
    PetscCall(CreateSplit(r));
  else
    PetscCall(
        KSPSetOptionsPrefix(r->ksp, r->count[FLOW] > 0 ? "reduced_fieldsplit_flow_" : "reduced_fieldsplit_motion_"));
  PetscCall(KSPSetFromOptions(r->ksp));
  PetscCall(KSPGetPC(r->ksp, &pc));
  PetscCall(PetscObjectTypeCompare((PetscObject)pc, PCFIELDSPLIT, &split));
  r->split = split;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedCreate(Model *m)
{
  Reduced *r;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&r));
  m->solver->reduced = r;
  Unknowns(&m->c->fields, r);
  PetscCall(CreateMatrices(m, r));
  PetscCall(MatCreateVecs(r->nest, &r->y, &r->b));
  PetscCall(VecDuplicate(m->solver->X, &r->slaved));
  PetscCall(VecDuplicate(m->solver->X, &r->diagonal));
  PetscCall(ReducedPreferences(r->count[FLOW] > 0, r->count[MOTION] > 0));
  PetscCall(CreateSolver(r));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedRest(Reduced *r)
{
  PetscFunctionBeginUser;
  if (r)
    PetscCall(KSPDestroy(&r->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedDestroy(Reduced **reduced)
{
  Reduced *r = *reduced;

  PetscFunctionBeginUser;
  if (!r)
    PetscFunctionReturn(PETSC_SUCCESS);
  for (int s = 0; s < GROUPS; s++) {
    for (int t = 0; t < GROUPS; t++)
      PetscCall(MatDestroy(&r->block[s][t]));
  }
  PetscCall(MatDestroy(&r->nest));
  PetscCall(MatDestroy(&r->whole));
  PetscCall(KSPDestroy(&r->ksp));
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
  PetscCall(KSPDestroy(&r->ksp)); /* not beside what is gathered now */
  to->reduced      = true;
  to->fixed_stress = r->split;
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

/* Rows of a node in the matrix of groups s, t. */
static const double *RowsOf(const Reduced *r, PetscInt I, int k, int s, int t)
{
  return &r->value[((size_t)(I * NEIGHBOURS + k) * r->fs.n + r->first[s]) * r->fs.n + r->first[t]];
}

/* Values of this rank's rows, whose columns are owned nodes or others, as its pattern has them. */
static PetscErrorCode WriteOwned(Model *m, const Reduced *r, int s, int t, bool own, Mat A)
{
  const int cols = r->count[t], nf = r->fs.n;
  double   *to, *a;

  PetscFunctionBeginUser;
  PetscCall(MatSeqAIJGetArray(A, &a));
  to = a;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    const double *from[NEIGHBOURS];
    PetscInt      number[NEIGHBOURS];
    int           k[NEIGHBOURS], n = 0;
    const int     all = RowNodes(m, I, k, number);

    for (int b = 0; b < all; b++) {
      if ((ModelNeighbour(m, I, k[b]) < m->map.n_owned) == own)
        from[n++] = RowsOf(r, I, k[b], s, t);
    }
    for (int i = 0; i < r->count[s]; i++) {
      for (int b = 0; b < n; b++) {
        for (int j = 0; j < cols; j++)
          *to++ = from[b][i * nf + j];
      }
    }
  }
  PetscCall(MatSeqAIJRestoreArray(A, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What was found for rows of other ranks. */
static PetscErrorCode SendForeign(Model *m, const Reduced *r, int s, int t)
{
  const int rows = r->count[s], cols = r->count[t], nf = r->fs.n;

  PetscFunctionBeginUser;
  for (PetscInt I = m->map.n_owned; I < m->map.n_local; I++) {
    PetscInt  row[F_COUNT], col[NEIGHBOURS * F_COUNT], number[NEIGHBOURS];
    double    v[F_COUNT * NEIGHBOURS * F_COUNT];
    int       k[NEIGHBOURS];
    const int n = RowNodes(m, I, k, number);

    for (int i = 0; i < rows; i++) {
      row[i] = m->map.global[I] * rows + i;
      for (int b = 0; b < n * cols; b++)
        v[i * n * cols + b] = RowsOf(r, I, k[b / cols], s, t)[i * nf + b % cols];
    }
    for (int b = 0; b < n * cols; b++)
      col[b] = number[b / cols] * cols + b % cols;
    PetscCall(MatSetValues(r->block[s][t], rows, row, n * cols, col, v, ADD_VALUES));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillMatrix(Model *m, const Reduced *r, int s, int t)
{
  Mat       own = r->block[s][t], other = NULL;
  PetscBool one;

  PetscFunctionBeginUser;
  PetscCall(PetscObjectTypeCompare((PetscObject)own, MATSEQAIJ, &one));
  if (!one)
    PetscCall(MatMPIAIJGetSeqAIJ(r->block[s][t], &own, &other, NULL));
  PetscCall(WriteOwned(m, r, s, t, true, own));
  if (other)
    PetscCall(WriteOwned(m, r, s, t, false, other));
  PetscCall(SendForeign(m, r, s, t));
  PetscCall(MatAssemblyBegin(r->block[s][t], MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(r->block[s][t], MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FillMatrices(Model *m, Reduced *r)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int q = 0; q < NEIGHBOURS; q++) {
      const PetscInt K = ModelNeighbour(m, I, q);

      if (K >= 0)
        Scaled(m, r, I, K, &r->value[(size_t)(I * NEIGHBOURS + q) * r->fs.n * r->fs.n]);
    }
  }
  for (int k = 0; k < GROUPS * GROUPS; k++) {
    if (r->block[k / GROUPS][k % GROUPS])
      PetscCall(FillMatrix(m, r, k / GROUPS, k % GROUPS));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ReducedSetUp(Model *m)
{
  Reduced *r = m->solver->reduced;
  Mat      A = r->nest;

  PetscFunctionBeginUser;
  PetscCall(FillMatrices(m, r));
  PetscCall(PetscFree(r->value));
  if (r->nest != r->block[FLOW][FLOW] && r->nest != r->block[MOTION][MOTION]) {
    PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
    if (!r->split) {
      PetscCall(MatConvert(r->nest, MATAIJ, r->whole ? MAT_REUSE_MATRIX : MAT_INITIAL_MATRIX, &r->whole));
      A = r->whole;
    }
  }
  PetscCall(CreateSolver(r));
  PetscCall(KSPSetOperators(r->ksp, A, A));
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
  if (k < r->count[MOTION])
    return m->map.n_owned * r->count[FLOW] + I * r->count[MOTION] + k;
  return I * r->count[FLOW] + k - r->first[FLOW];
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

/* (175): their rows couple them with nothing but themselves and what has just been found. */
static PetscErrorCode RecoverVelocities(Model *m, Reduced *r, Vec R, Vec Y)
{
  const FieldSet *fs = &m->c->fields;
  const double   *a, *s, *d;
  double         *x;

  PetscFunctionBeginUser;
  if (r->fs.n == fs->n)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (m->solver->product)
    PetscCall(ProductMult(m, true, Y, r->slaved));
  else
    PetscCall(MatMult(m->solver->J2, Y, r->slaved));
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
