/* Rows of the tangent in the unknowns of all nodes of a particle or face. */
#include "gather.h"

#define TOGETHER 4 /* rows that are read in one go */

INLINE void SumInto(const RowSum *s, int n, double *out)
{
  Lanes *to = (Lanes *)out;

  for (int k = 0; k < s->n; k += TOGETHER) {
    const Lanes *r0 = (const Lanes *)s->row[k], *r1 = (const Lanes *)s->row[k + 1], *r2 = (const Lanes *)s->row[k + 2],
                *r3 = (const Lanes *)s->row[k + 3];
    const double f0 = s->factor[k], f1 = s->factor[k + 1], f2 = s->factor[k + 2], f3 = s->factor[k + 3];

    for (int j = 0; j < n; j++)
      to[j] += (f0 * r0[j] + f1 * r1[j]) + (f2 * r2[j] + f3 * r3[j]);
  }
}

void RowSumInto(RowSum *s, int length, double *out)
{
  for (; s->n % TOGETHER != 0; s->n++) {
    s->factor[s->n] = 0.0;
    s->row[s->n]    = s->row[0];
  }
  switch (length / LANES) {
  case 5:
    SumInto(s, 5, out);
    return;
  case 11:
    SumInto(s, 11, out);
    return;
  default:
    SumInto(s, length / LANES, out);
  }
}

void SlopesBegin(int unknowns, Slopes *s)
{
  s->length = RowLength(unknowns);
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
    in[IN_GRADU][vs + i] += dt * b->B[i];
    in[IN_GRADU + 3][vs + i] += dt * b->B[i];
    if (axisymmetric)
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
      in[VectorAt(IN_J, f, i)][first + PlaceV(fs, f) + i] = b->NS[f][i] * b->w[f];
      if (fs->solid)
        in[VectorAt(IN_J, f, i)][vs + i] = -b->NS[f][i] * b->w[f];
    }
  }
  if (fs->heat) {
    const int T = first + PlaceT(fs);

    in[IN_T][T] = b->S;
    for (int i = 0; i < CL_DIM; i++)
      in[IN_GT + i][T] = b->G[i];
  }
}

void SlopesApply(const Slopes *s, const double D[IN_COUNT], double *row)
{
  RowSum sum;

  sum.n = 0;
  memset(row, 0, (size_t)s->length * sizeof(double));
  for (int k = 0; k < IN_COUNT; k++) {
    if (D[k] != 0.0)
      RowSumAdd(&sum, D[k], s->in[k]);
  }
  RowSumInto(&sum, s->length, row);
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
  else if (to->fs.n == 5)
    AddBlocks(m, to, 5, s);
  else if (to->fs.n == 2)
    AddBlocks(m, to, 2, s);
  else
    AddBlocks(m, to, to->fs.n, s);
}

void PatchAt(const Model *m, const Assembly *to, const Reach *r, Patch *s)
{
  if (s->n == r->n && memcmp(s->node, r->node, (size_t)r->n * sizeof(*r->node)) == 0)
    return;
  PatchAdd(m, to, s);
  s->n = r->n;
  memcpy(s->node, r->node, (size_t)r->n * sizeof(*r->node));
  for (int a = 0; a < s->n; a++) {
    for (int i = 0; i < to->fs.n; i++)
      memset(s->v[a][i], 0, (size_t)RowLength(s->n * to->fs.n) * sizeof(double));
  }
}
