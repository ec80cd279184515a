/* What is assembled of the reduced matrix (170)-(174): scaled, thinned out (433), handed to PETSc row by row. */
#include "reduced.h"

/* Rows and columns of a field have one unit each, the mean of Newton's scales, so that what is smooth in the body is
   smooth for multigrid. */
PetscErrorCode ReducedUnits(Model *m, Reduced *r)
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

/* Which neighbours a node has, and their numbers, in the order of their columns. */
typedef struct {
  int      n, k[NEIGHBOURS];
  PetscInt number[NEIGHBOURS];
} Columns;

static void ColumnsOf(const Model *m, PetscInt I, Columns *c)
{
  c->n = 0;
  for (int q = 0; q < NEIGHBOURS; q++) {
    const PetscInt K = ModelNeighbour(m, I, q);
    int            at;

    if (K < 0)
      continue;
    for (at = c->n++; at > 0 && c->number[at - 1] > m->map.global[K]; at--) {
      c->number[at] = c->number[at - 1];
      c->k[at]      = c->k[at - 1];
    }
    c->number[at] = m->map.global[K];
    c->k[at]      = q;
  }
}

/* Rows and columns of prescribed unknowns stay empty but for what they would have on the diagonal. */
static void Scaled(const Model *m, const Reduced *r, PetscInt I, PetscInt K, double *v)
{
  const int nf = r->fs.n;

  for (int s = 0; s < nf; s++) {
    for (int t = 0; t < nf; t++)
      v[s * nf + t] *= r->unit[s][t];
    for (int t = 0; (m->mask[I] || m->mask[K]) && t < nf; t++) {
      if ((I != K || s != t) && (ReducedHolds(m, r, I, s) || ReducedHolds(m, r, K, t)))
        v[s * nf + t] = 0.0;
    }
  }
}

/* Row i of a node against all unknowns of its neighbour k. */
static const double *ReducedRow(const Reduced *r, PetscInt I, int k, int i)
{
  return &r->value[((size_t)(I * NEIGHBOURS + k) * r->fs.n + i) * r->fs.n];
}

/* Rows of this rank in compressed form. */
typedef struct {
  PetscInt *from, *col; /* first entry of each row, [rows + 1]; columns of the entries */
  double   *v;
  PetscInt  count; /* of the entries so far */
} Rows;

/* Adds what row i of node I has in the columns of group t that is not zero, and the diagonal. */
static void AddRow(const Reduced *r, PetscInt I, int i, int t, const Columns *c, Rows *to)
{
  for (int b = 0; b < c->n; b++) {
    const double *row = ReducedRow(r, I, c->k[b], i);

    for (int j = r->first[t]; j < r->first[t] + r->count[t]; j++) {
      if (row[j] == 0.0 && (c->k[b] != NEIGHBOURS / 2 || i != j))
        continue;
      to->col[to->count] = c->number[b] * r->count[t] + j - r->first[t];
      to->v[to->count++] = row[j];
    }
  }
}

/* Entries of group s in columns of group t, at most; a neighbour that is not there has zeros. */
static PetscInt MostEntries(const Model *m, const Reduced *r, int s, int t)
{
  PetscInt count = 0;

  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int q = 0; q < NEIGHBOURS; q++) {
      const double *v = ReducedRow(r, I, q, r->first[s]);

      for (int e = 0; e < r->count[s] * r->fs.n; e++)
        count += v[e] != 0.0 && e % r->fs.n >= r->first[t] && e % r->fs.n < r->first[t] + r->count[t];
    }
  }
  return count + (s == t ? m->map.n_owned * r->count[s] : 0); /* zeros on the diagonal */
}

/* Rows of group s in the columns of group t. */
static void FillRows(const Model *m, const Reduced *r, int s, int t, Rows *to)
{
  Columns c;

  to->count = 0;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    ColumnsOf(m, I, &c);
    for (int i = 0; i < r->count[s]; i++) {
      to->from[I * r->count[s] + i] = to->count;
      AddRow(r, I, r->first[s] + i, t, &c, to);
    }
  }
  to->from[m->map.n_owned * r->count[s]] = to->count;
}

static PetscErrorCode CreateBlock(Model *m, const Reduced *r, int s, int t, Mat *A)
{
  const PetscInt rows = m->map.n_owned * r->count[s], most = MostEntries(m, r, s, t);
  Rows           of;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc3(rows + 1, &of.from, most, &of.col, most, &of.v));
  FillRows(m, r, s, t, &of);
  PetscCall(MatCreate(m->grid.comm, A));
  PetscCall(MatSetSizes(*A, rows, m->map.n_owned * r->count[t], PETSC_DETERMINE, PETSC_DETERMINE));
  PetscCall(MatSetType(*A, MATAIJ));
  PetscCall(MatSetBlockSizes(*A, r->count[s], r->count[t]));
  PetscCall(
      MatSeqAIJSetPreallocationCSR(*A, of.from, of.col, of.v)); /* does nothing where there are several ranks ... */
  PetscCall(MatMPIAIJSetPreallocationCSR(*A, of.from, of.col, of.v)); /* ... or one */
  PetscCall(PetscFree3(of.from, of.col, of.v));
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

PetscErrorCode ReducedMatrices(Model *m, Reduced *r)
{
  Mat       a[GROUPS * GROUPS];
  PetscBool all;

  PetscFunctionBeginUser;
  PetscCall(ScaleValues(m, r));
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
