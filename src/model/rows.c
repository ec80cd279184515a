/* Rows of the tangent in the unknowns of all nodes of a particle or face. */
#include "gather.h"

#define TOGETHER 4                /* sums that go on side by side: each row is read once for all of them */
#define TILE (LANES == 8 ? 5 : 2) /* Lanes of each that registers hold */

/* `count` of the sums from the k-th on, n Lanes from the j-th on. */
INLINE void SumTile(const RowSum *s, int k, int count, int j, int n, bool first, double *const *out)
{
  const Lanes none = {0.0};
  Lanes       sum[TOGETHER][TILE];

#pragma GCC unroll 4
  for (int c = 0; c < count; c++) {
#pragma GCC unroll 5
    for (int l = 0; l < n; l++)
      sum[c][l] = first ? none : ((const Lanes *)out[k + c])[j + l];
  }
  for (int q = 0; q < s->n; q++) {
    const Lanes *row = (const Lanes *)s->row[q] + j;

#pragma GCC unroll 4
    for (int c = 0; c < count; c++) {
#pragma GCC unroll 5
      for (int l = 0; l < n; l++)
        sum[c][l] += s->factor[q][k + c] * row[l];
    }
  }
#pragma GCC unroll 4
  for (int c = 0; c < count; c++) {
#pragma GCC unroll 5
    for (int l = 0; l < n; l++)
      ((Lanes *)out[k + c])[j + l] = sum[c][l];
  }
}

INLINE void SumStrip(const RowSum *s, int sums, int j, int n, bool first, double *const *out)
{
  int k = 0;

  for (; k + TOGETHER <= sums; k += TOGETHER)
    SumTile(s, k, TOGETHER, j, n, first, out);
  for (; k < sums; k++)
    SumTile(s, k, 1, j, n, first, out);
}

/* Of what is left, too, as many Lanes at a time as there are: one by one each would wait for the sum before it. */
void RowSumInto(const RowSum *s, int sums, int length, bool first, double *const *out)
{
  const int lanes = length / LANES;
  int       j     = 0;

  for (; j + TILE <= lanes; j += TILE)
    SumStrip(s, sums, j, TILE, first, out);
  if (TILE > 4 && lanes - j == 4)
    SumStrip(s, sums, j, 4, first, out);
  else if (TILE > 3 && lanes - j == 3)
    SumStrip(s, sums, j, 3, first, out);
  else if (TILE > 2 && lanes - j == 2)
    SumStrip(s, sums, j, 2, first, out);
  else if (lanes - j == 1)
    SumStrip(s, sums, j, 1, first, out);
}

void SlopesBegin(int unknowns, bool anew, Slopes *s)
{
  if (!anew && s->unknowns == unknowns)
    return;
  s->unknowns = unknowns;
  s->length   = RowLength(unknowns);
  for (int k = 0; k < IN_COUNT; k++)
    memset(s->in[k], 0, (size_t)s->length * sizeof(double));
}

void SlopesAdd(const FieldSet *fs, bool axisymmetric, double dt, const NodeWeights *b, int first, Slopes *s)
{
  double(*in)[ROW_MOST] = s->in;
  const int vs          = first + PlaceVs(fs);

  for (int i = 0; fs->solid && i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      in[VectorAt(IN_GRADU, i, j)][vs + i] = dt * b->M[j];
    in[IN_U + i][vs + i] = dt * b->NU;
    if (axisymmetric && i == 0)
      in[IN_HOOP][vs] = dt * b->K;
    if (!b->B)
      continue;
    for (int d = 0; d < CL_DIM; d++)
      in[VectorAt(IN_GRADU, d, d)][vs + i] += dt * b->B[i];
    if (CL_DIM == 2)
      in[IN_HOOP][vs + i] += dt * b->B[i];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    const int p = first + PlaceP(fs, f);

    in[IN_P + f][p] = b->S;
    for (int i = 0; i < CL_DIM; i++) {
      in[VectorAt(IN_GP, f, i)][p] = b->G[i];
      if (PlaceV(fs, f) < 0)
        continue;
      for (int j = 0; j < CL_DIM; j++) {
        const double share = b->NS[f][i] * b->w[f] * (b->share ? b->share->A[cl_symmetric[i][j]] : i == j);

        in[VectorAt(IN_J, f, i)][first + PlaceV(fs, f) + j] = share;
        if (fs->solid)
          in[VectorAt(IN_J, f, i)][vs + j] = -share;
      }
    }
  }
  if (fs->heat) {
    const int T = first + PlaceT(fs);

    in[IN_T][T] = b->S;
    for (int i = 0; i < CL_DIM; i++)
      in[IN_GT + i][T] = b->G[i];
  }
}

void SlopesApply(const Slopes *s, int n, const double *const *D, double *const *row)
{
  for (int k = 0; k < n; k += TOGETHER) {
    const int     some           = n - k < TOGETHER ? n - k : TOGETHER;
    double        size[IN_COUNT] = {0.0};
    const double *of[TOGETHER];
    RowSum        sum;

    sum.n = 0;
    for (int c = 0; c < TOGETHER; c++) {
      of[c] = D[k + (c < some ? c : 0)];
      for (int q = 0; q < IN_COUNT; q++)
        size[q] += fabs(of[c][q]);
    }
    for (int q = 0; q < IN_COUNT; q++) {
      if (size[q] == 0.0)
        continue;
      double *factor = RowSumAdd(&sum, s->in[q]);
      for (int c = 0; c < TOGETHER; c++)
        factor[c] = of[c][q];
    }
    RowSumInto(&sum, some, s->length, true, row + k);
  }
}

/* A constant number of unknowns lets the compiler unroll the blocks of the largest sets. */
INLINE void AddBlocks(const Model *m, const Assembly *to, int n, const Patch *s)
{
  for (int a = 0; a < s->n; a++) {
    for (int b = 0; b < s->n; b++) {
      double *restrict block = AssemblyBlock(m, to, s->node[a], s->node[b]);

      for (int i = 0; i < n; i++) {
        for (int q = 0; q < n; q++)
          block[i * n + q] += s->v[a][i][b * n + q];
      }
    }
  }
}

void PatchAdd(const Model *m, const Assembly *to, const Patch *s)
{
  if (to->fs.n == F_COUNT)
    AddBlocks(m, to, F_COUNT, s);
  else if (to->fs.n == CL_DIM + 3) /* v_s, p_w, p_g, T */
    AddBlocks(m, to, CL_DIM + 3, s);
  else if (to->fs.n == CL_DIM)
    AddBlocks(m, to, CL_DIM, s);
  else
    AddBlocks(m, to, to->fs.n, s);
}

void PatchAt(const Model *m, const Assembly *to, const Reach *r, Patch *s)
{
  if (s->n == r->n && memcmp(s->node, r->node, (size_t)r->n * sizeof(*r->node)) == 0)
    return;
  PatchAdd(m, to, s);
  s->n     = r->n;
  s->fresh = true;
  memcpy(s->node, r->node, (size_t)r->n * sizeof(*r->node));
}
