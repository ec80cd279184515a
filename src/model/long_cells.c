/* Conduction in cells longer than wide (444): what keeps a node from being warmed by a colder one. */
#include "gather.h"

/* V (m^3, at t_n) times (444) of a particle, and d2 S_I/dx dy (1/m^2) of its nodes; false: it has none. */
static bool Twist(const Model *m, PetscInt p, const Reach *r, double *stiff, double twist[CL_NODES])
{
  int at[CL_NODES][CL_DIM];

  if (!m->added->long_cell || m->added->long_cell[p] == 0.0)
    return false;
  StencilNodes(&m->stencil[p], at);
  for (int a = 0; a < r->n; a++)
    twist[a] = m->stencil[p].axis[0].dS[at[a][0]] * m->stencil[p].axis[1].dS[at[a][1]];
  *stiff = m->P.f[P_V][p] * m->added->long_cell[p];
  return true;
}

void LongCellResidual(const Model *m, PetscInt p, const Reach *r, const double *x, double *f)
{
  const FieldSet *fs = &m->c->fields;
  double          stiff, twist[CL_NODES], sum = 0.0;

  if (!Twist(m, p, r, &stiff, twist))
    return;
  for (int a = 0; a < r->n; a++)
    sum += twist[a] * x[r->node[a] * fs->n + fs->at[F_T]];
  for (int a = 0; a < r->n; a++)
    *RowOf(m, f, r->node[a], F_T) += stiff * twist[a] * sum;
}

void LongCellBlock(const Model *m, const Assembly *to, PetscInt p, const Reach *r)
{
  const int at = to->fs.at[F_T];
  double    stiff, twist[CL_NODES];

  if (!Twist(m, p, r, &stiff, twist))
    return;
  for (int a = 0; a < r->n; a++) {
    const double w = stiff * twist[a];

    for (int b = 0; w != 0.0 && b < r->n; b++)
      AssemblyBlock(m, to, r->node[a], r->node[b])[at * to->fs.n + at] += w * twist[b];
  }
}
