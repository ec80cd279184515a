/* Where the conductivity that carries heat with the flow (293) is needed: (440) of docs/equations.md. */
#include "clathra/point_heat.h"
#include "gather.h"

#define LEAST_T 1e-3 /* K from node to node: below it is what Newton's method and round-off leave */

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
               d_T[2]   = {T - m->x_n[K[0] * fs->n + PlaceT(fs)], m->x_n[K[1] * fs->n + PlaceT(fs)] - T};
  const double before = d_T[0] / LinesWidth(line, i - 1), after = d_T[1] / LinesWidth(line, i);

  if (fabs(d_T[0]) + fabs(d_T[1]) < LEAST_T)
    return 0.0;
  const double turn = 2.0 * fabs(after - before) / (fabs(before) + fabs(after)) - 1.0;

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

/* Heat that the fluids carry along axis d at t_n, of any unit. */
static double CarriedAlong(const Model *m, PetscInt I, int d)
{
  const FieldSet *fs  = &m->c->fields;
  double          sum = 0.0;

  for (int f = 0; f < PHASE_COUNT; f++) {
    double J[CL_DIM];

    if (!fs->phase[f])
      continue;
    DarcyFlux(m, I, f, &m->x_n[I * fs->n], J);
    sum += SpecificHeat(NodeMaterial(m, I), f) * m->coef[I * NC_COUNT + NC_RHO + f] * J[d];
  }
  return sum;
}

/* Harmonic mean of the bends of a node and of a neighbour that bends the other way, as a border does that the flow
   comes from. */
static double Alternates(const Model *m, double *bend, PetscInt I, int d, const PetscInt K[2])
{
  const double own  = *At(bend, I, d, SHARE);
  double       most = 0.0;

  if (own == 0.0)
    return 0.0;
  for (int side = 0; side < 2; side++) {
    const bool   known  = *At(bend, K[side], d, KNOWN) > 0.0;
    const bool   enters = !known && (side ? -1.0 : 1.0) * CarriedAlong(m, I, d) > 0.0;
    const double other  = known ? *At(bend, K[side], d, SHARE) : enters ? -own : 0.0;

    if (own * other < 0.0)
      most = fmax(most, -2.0 * own * other / (fabs(own) + fabs(other)));
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
      *At(node, I, d, SHARE) = Alternates(m, bend, I, d, K);
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
  if (!SceneCarriesHeat(m->c) || m->c->stabilisation.heat != HEAT_AUTO)
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
