/* Where blocks of the tangent go: J2 or the reduced matrix. */
#include "solver.h"

static void Add(Assembly *to, int first, int count)
{
  for (int k = 0; k < count; k++)
    to->out[to->nout++] = first + k;
}

void AssemblyOf(const Model *m, const FieldSet *fs, Assembly *to)
{
  *to = (Assembly){.fs = *fs, .place = m->solver->place, .eliminated = fs->fluid && PlaceV(fs, PHASE_W) < 0};
  /* eliminated fluids push the mixture as they are accelerated (173) */
  to->force = m->bc.ambient.on || (to->eliminated && fs->inertia);
  if (fs->solid) {
    Add(to, OUT_P, CL_DIM * CL_DIM);
    Add(to, OUT_M, 1);
    if (SceneStrainsAcross(m->c))
      Add(to, OUT_HOOP, 1);
    if (to->force)
      Add(to, OUT_A, CL_DIM);
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    Add(to, VectorAt(OUT_FLUX, f, 0), CL_DIM);
    Add(to, OUT_DM + f, 1);
    if (fs->solid)
      Add(to, OUT_M + 1 + f, 1);
    if (to->eliminated)
      continue;
    Add(to, VectorAt(OUT_G, f, 0), CL_DIM);
    Add(to, OUT_MI + f, 1);
    Add(to, OUT_D + f, 1);
    if (m->fluid)
      Add(to, OUT_ROOT + f, 1);
  }
  if (fs->heat) {
    Add(to, OUT_HEAT, CL_DIM);
    Add(to, OUT_C, 2); /* and OUT_Q */
  }
}

/* J2.  Blocks are added up unscaled where they end up, row by row; MatrixFinish turns them into BAIJ's columns, scales
   them and sends what was found for other ranks' nodes. */

/* Places in the values of a BAIJ matrix with this rank's rows: its columns are owned nodes, or others whose global
   numbers `number` gives. */
static PetscErrorCode Places(Model *m, Mat A, bool own, const PetscInt *number)
{
  const PetscInt  n = m->c->fields.n;
  const PetscInt *ia, *ja;
  PetscInt        rows;
  PetscBool       done;
  double         *a;

  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_TRUE, &rows, &ia, &ja, &done));
  PetscCheck(done && rows == m->map.n_owned, m->grid.comm, PETSC_ERR_PLIB, "J2 has other rows than there are nodes");
  PetscCall(MatSeqBAIJGetArray(A, &a));
  for (PetscInt I = 0; I < rows; I++) {
    for (int k = 0; k < NEIGHBOURS; k++) {
      const PetscInt K = ModelNeighbour(m, I, k);

      if (K < 0 || (K < m->map.n_owned) != own)
        continue;
      for (PetscInt q = ia[I]; q < ia[I + 1]; q++) {
        if ((own ? ja[q] : number[ja[q]]) == (own ? K : m->map.global[K]))
          m->solver->place[I * NEIGHBOURS + k] = &a[(size_t)q * n * n];
      }
    }
  }
  PetscCall(MatSeqBAIJRestoreArray(A, &a));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_TRUE, &rows, &ia, &ja, &done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AllPlaces(Model *m)
{
  const PetscInt  n = m->c->fields.n, ghosts = m->map.n_local - m->map.n_owned;
  const PetscInt *number;
  PetscBool       one;
  Mat             own, other;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1((size_t)m->map.n_local * NEIGHBOURS, &m->solver->place));
  PetscCall(PetscMalloc1((size_t)ghosts * NEIGHBOURS * n * n, &m->solver->foreign));
  PetscCall(MatSetOption(m->solver->J2, MAT_ROW_ORIENTED, PETSC_FALSE));
  PetscCall(PetscObjectTypeCompare((PetscObject)m->solver->J2, MATSEQBAIJ, &one));
  if (one) {
    PetscCall(Places(m, m->solver->J2, true, NULL));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(MatMPIBAIJGetSeqBAIJ(m->solver->J2, &own, &other, &number));
  PetscCall(Places(m, own, true, NULL));
  PetscCall(Places(m, other, false, number));
  for (PetscInt k = 0; k < ghosts * NEIGHBOURS; k++)
    m->solver->place[m->map.n_owned * NEIGHBOURS + k] = &m->solver->foreign[(size_t)k * n * n];
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Block pattern: all active nodes within radius 2, so that it holds whatever the particles do. */
PetscErrorCode MatrixCreate(Model *m)
{
  const NodeMap         *map = &m->map;
  const PetscInt         n   = m->c->fields.n;
  PetscInt              *dnz, *onz;
  ISLocalToGlobalMapping l2g;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc2(map->n_owned, &dnz, map->n_owned, &onz));
  for (PetscInt I = 0; I < map->n_owned; I++) {
    for (int k = 0; k < NEIGHBOURS; k++) {
      const PetscInt K = ModelNeighbour(m, I, k);

      if (K >= 0)
        (K < map->n_owned ? dnz : onz)[I]++;
    }
  }
  PetscCall(MatCreateBAIJ(m->grid.comm, n, map->n_owned * n, map->n_owned * n, PETSC_DETERMINE, PETSC_DETERMINE, 0, dnz,
                          0, onz, &m->solver->J2));
  PetscCall(ISLocalToGlobalMappingCreate(m->grid.comm, n, map->n_local, map->global, PETSC_COPY_VALUES, &l2g));
  PetscCall(MatSetLocalToGlobalMapping(m->solver->J2, l2g, l2g));
  PetscCall(ISLocalToGlobalMappingDestroy(&l2g));
  PetscCall(PetscFree2(dnz, onz));
  for (PetscInt I = 0; I < map->n_owned; I++) {
    const double zero[F_COUNT * F_COUNT] = {0.0}; /* n x n of it */

    for (int k = 0; k < NEIGHBOURS; k++) {
      const PetscInt K = ModelNeighbour(m, I, k);

      if (K >= 0)
        PetscCall(MatSetValuesBlockedLocal(m->solver->J2, 1, &I, 1, &K, zero, INSERT_VALUES));
    }
  }
  PetscCall(MatAssemblyBegin(m->solver->J2, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->solver->J2, MAT_FINAL_ASSEMBLY));
  PetscCall(MatSetOption(m->solver->J2, MAT_NEW_NONZERO_LOCATION_ERR, PETSC_TRUE));
  PetscCall(AllPlaces(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MatrixDestroy(Solver *s)
{
  PetscFunctionBeginUser;
  PetscCall(MatDestroy(&s->J2));
  PetscCall(PetscFree(s->place));
  PetscCall(PetscFree(s->foreign));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MatrixBegin(Model *m)
{
  const PetscInt n = m->c->fields.n;

  PetscFunctionBeginUser;
  PetscCall(MatZeroEntries(m->solver->J2));
  PetscCall(PetscArrayzero(m->solver->foreign, (size_t)(m->map.n_local - m->map.n_owned) * NEIGHBOURS * n * n));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Factors of a node's rows: none of prescribed unknowns. */
static void RowFactors(const Model *m, PetscInt I, double row[F_COUNT])
{
  const int n = m->c->fields.n;

  for (int s = 0; s < n; s++)
    row[s] = (m->mask[I] >> s) & 1u ? 0.0 : 1.0 / m->row_scale[I * n + s];
}

/* Pair by pair about the diagonal, so that `out` may be v. */
INLINE void Scale(int n, const double *row, const double *col, const double *v, double *out)
{
  for (int q = 0; q < n; q++) {
    for (int s = 0; s <= q; s++) {
      const double below = v[q * n + s], above = v[s * n + q];

      out[q * n + s] = above * (row[s] * col[q]);
      out[s * n + q] = below * (row[q] * col[s]);
    }
  }
}

/* Scaled; v by rows, into `out` by columns, which may be v.  A constant number of unknowns lets the compiler unroll. */
static void Finished(const Model *m, const double row[F_COUNT], PetscInt K, const double *v, double *out)
{
  const int     n   = m->c->fields.n;
  const double *col = &m->col_scale[K * n];

  if (n == F_COUNT)
    Scale(F_COUNT, row, col, v, out);
  else if (n == CL_DIM)
    Scale(CL_DIM, row, col, v, out);
  else
    Scale(n, row, col, v, out);
}

PetscErrorCode MatrixFinish(Model *m)
{
  const int n = m->c->fields.n;
  double    block[F_COUNT * F_COUNT], row[F_COUNT];

  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    RowFactors(m, I, row);
    for (int k = 0; k < NEIGHBOURS; k++) {
      const PetscInt K = ModelNeighbour(m, I, k);
      double        *v = m->solver->place[I * NEIGHBOURS + k];

      if (K < 0 || !v)
        continue;
      if (I < m->map.n_owned) {
        Finished(m, row, K, v, v);
        continue;
      }
      Finished(m, row, K, v, block);
      PetscCall(MatSetValuesBlockedLocal(m->solver->J2, 1, &I, 1, &K, block, ADD_VALUES));
    }
  }
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int s = 0; s < n; s++) {
      if ((m->mask[I] >> s) & 1u)
        m->solver->place[I * NEIGHBOURS + NEIGHBOURS / 2][s * n + s] = 1.0;
    }
  }
  PetscCall(MatAssemblyBegin(m->solver->J2, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(m->solver->J2, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode MatrixCopy(const Model *m, Mat P)
{
  const PetscInt  n = m->c->fields.n;
  const PetscInt *ia, *ja, *first, *column;
  PetscInt        blocks, rows;
  PetscBool       done;
  double         *v, *out;
  Mat             J2 = m->solver->J2;

  PetscFunctionBeginUser;
  PetscCall(MatGetRowIJ(J2, 0, PETSC_FALSE, PETSC_TRUE, &blocks, &ia, &ja, &done));
  PetscCall(MatGetRowIJ(P, 0, PETSC_FALSE, PETSC_FALSE, &rows, &first, &column, &done));
  PetscCheck(rows == blocks * n && first[rows] == ia[blocks] * n * n, PETSC_COMM_SELF, PETSC_ERR_PLIB,
             "the copy of J2 has another pattern");
  PetscCall(MatSeqBAIJGetArray(J2, &v));
  PetscCall(MatSeqAIJGetArrayWrite(P, &out));
  for (PetscInt I = 0; I < blocks; I++) {
    for (PetscInt k = ia[I]; k < ia[I + 1]; k++) {
      for (PetscInt s = 0; s < n; s++) {
        for (PetscInt q = 0; q < n; q++)
          out[first[I * n + s] + (k - ia[I]) * n + q] = v[(k * n + q) * n + s];
      }
    }
  }
  PetscCall(MatSeqAIJRestoreArrayWrite(P, &out));
  PetscCall(MatSeqBAIJRestoreArray(J2, &v));
  PetscCall(MatRestoreRowIJ(P, 0, PETSC_FALSE, PETSC_FALSE, &rows, &first, &column, &done));
  PetscCall(MatRestoreRowIJ(J2, 0, PETSC_FALSE, PETSC_TRUE, &blocks, &ia, &ja, &done));
  PetscFunctionReturn(PETSC_SUCCESS);
}
