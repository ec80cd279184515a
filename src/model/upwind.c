/* Where the conductivity that carries heat with the flow (293) is needed: (440) of docs/equations.md. */
#include "gather.h"

enum { SHARE, KNOWN, BOTH }; /* of a node along an axis; it has neighbours on both sides: 1, else 0 */

static inline double *At(double *node, PetscInt I, int d, int what)
{
  return &node[(I * CL_DIM + d) * BOTH + what];
}

/* The neighbours of an owned node along axis d; negative: there is none. */
static void Beside(const Model *m, PetscInt I, int d, PetscInt K[2])
{
  int centre = 0, stride = 1;

  for (int i = 0, s = 1; i < CL_DIM; i++, s *= WIDTH) {
    centre += RADIUS * s;
    stride = i == d ? s : stride;
  }
  K[0] = ModelNeighbour(m, I, centre - stride);
  K[1] = ModelNeighbour(m, I, centre + stride);
}

/* How unlike the slopes of T at t_n on both sides of a node are: 0 within a factor of three, 1 where T has a minimum,
   -1 where it has a maximum. */
static double Bend(const Model *m, PetscInt I, int d, const PetscInt K[2])
{
  const FieldSet  *fs   = &m->c->fields;
  const GridLines *line = &m->grid.line[d];
  const PetscInt   i    = m->map.ij[I][d];
  const double     T    = m->x_n[I * fs->n + PlaceT(fs)],
               before   = (T - m->x_n[K[0] * fs->n + PlaceT(fs)]) / LinesWidth(line, i - 1),
               after    = (m->x_n[K[1] * fs->n + PlaceT(fs)] - T) / LinesWidth(line, i);
  const double sum = fabs(before) + fabs(after), turn = sum > 0.0 ? 2.0 * fabs(after - before) / sum - 1.0 : 0.0;

  return turn > 0.0 ? copysign(turn, after - before) : 0.0;
}

static PetscErrorCode FindBends(Model *m, double *node)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      PetscInt K[2];

      Beside(m, I, d, K);
      if (K[0] < 0 || K[1] < 0)
        continue;
      *At(node, I, d, SHARE) = Bend(m, I, d, K);
      *At(node, I, d, KNOWN) = 1.0;
    }
  }
  PetscCall(NodeMapSum(&m->map, node, BOTH * CL_DIM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Of the bend of a node what a neighbour bends the other way, or all of it beside the border. */
static double Alternates(double *bend, PetscInt I, int d, const PetscInt K[2])
{
  const double own  = *At(bend, I, d, SHARE);
  double       most = 0.0;

  for (int side = 0; side < 2; side++) {
    const double other = *At(bend, K[side], d, KNOWN) > 0.0 ? *At(bend, K[side], d, SHARE) : -own;

    if (own * other < 0.0)
      most = fmax(most, fmin(fabs(own), fabs(other)));
  }
  return most;
}

/* Shares of the nodes, from their bends. */
static PetscErrorCode FindShares(Model *m, double *bend, double *node)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      PetscInt K[2];

      if (!(*At(bend, I, d, KNOWN) > 0.0))
        continue;
      Beside(m, I, d, K);
      *At(node, I, d, SHARE) = Alternates(bend, I, d, K);
      *At(node, I, d, KNOWN) = 1.0;
    }
  }
  PetscCall(NodeMapSum(&m->map, node, BOTH * CL_DIM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* theta of a particle whose heat is carried along the axis of K, a h-weighted mean over the axes. */
static double ShareOf(const Model *m, PetscInt p, const double K[CL_SYMMETRIC], double *node)
{
  double h[CL_DIM], share = 0.0, all = 0.0;
  Reach  r;

  CellWidths(m, p, h);
  ReachExpand(m, p, &r);
  for (int d = 0; d < CL_DIM; d++) {
    const double w  = h[d] * sqrt(K[cl_symmetric[d][d]]); /* h_d |a_d| */
    double       of = 0.0, known = 0.0;

    for (int a = 0; a < r.n; a++) {
      of += r.S[a] * *At(node, r.node[a], d, SHARE);
      known += r.S[a] * *At(node, r.node[a], d, KNOWN);
    }
    share += known > 0.0 ? w * of / known : 0.0;
    all += w;
  }
  return all > 0.0 ? share / all : 0.0;
}

PetscErrorCode UpwindLimit(Model *m)
{
  const size_t size = (size_t)BOTH * CL_DIM * m->map.n_local;
  double      *bend, *node;

  PetscFunctionBeginUser;
  if (!m->added->upwind || m->c->stabilisation.heat != HEAT_AUTO)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc2(size, &bend, size, &node));
  PetscCall(FindBends(m, bend));
  PetscCall(FindShares(m, bend, node));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double *K     = &m->added->upwind[CL_SYMMETRIC * p];
    double  trace = 0.0;

    for (int d = 0; d < CL_DIM; d++)
      trace += K[cl_symmetric[d][d]];
    if (!(trace > 0.0))
      continue;
    const double share = ShareOf(m, p, K, node);

    for (int k = 0; k < CL_SYMMETRIC; k++)
      K[k] *= share;
  }
  PetscCall(PetscFree2(bend, node));
  PetscFunctionReturn(PETSC_SUCCESS);
}
