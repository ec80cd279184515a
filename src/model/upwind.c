/* Where the conductivity that carries heat with the flow (293) is needed: (440) of docs/equations.md. */
#include "clathra/point_heat.h"
#include "gather.h"

#define WHOLE 0.5    /* of a particle: the node's share is the particle's */
#define LEAST_T 1e-3 /* K from node to node: below it is what Newton's method and round-off leave */

enum { BEND, KNOWN, BOTH }; /* of a node along an axis; it has neighbours on both sides: 1, else 0 */

static inline double BendOf(const double *bend, PetscInt I, int d)
{
  return bend[(I * CL_DIM + d) * BOTH + BEND];
}

static inline bool Known(const double *bend, PetscInt I, int d)
{
  return bend[(I * CL_DIM + d) * BOTH + KNOWN] > 0.0;
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

static PetscErrorCode FindBends(Model *m, double *bend)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      PetscInt K[2];

      Beside(m, I, d, K);
      if (K[0] < 0 || K[1] < 0)
        continue;
      bend[(I * CL_DIM + d) * BOTH + BEND]  = Bend(m, I, d, K);
      bend[(I * CL_DIM + d) * BOTH + KNOWN] = 1.0;
    }
  }
  PetscCall(NodeMapSum(&m->map, bend, BOTH * CL_DIM));
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
static double Alternates(const Model *m, const double *bend, PetscInt I, int d, const PetscInt K[2])
{
  const double own  = BendOf(bend, I, d);
  double       most = 0.0;

  for (int side = 0; side < 2; side++) {
    const bool   known  = Known(bend, K[side], d);
    const bool   enters = !known && (side ? -1.0 : 1.0) * CarriedAlong(m, I, d) > 0.0;
    const double other  = known ? BendOf(bend, K[side], d) : enters ? -own : 0.0;

    if (own * other < 0.0)
      most = fmax(most, -2.0 * own * other / (fabs(own) + fabs(other)));
  }
  return most;
}

/* theta_I: what alternates. */
static PetscErrorCode FindShares(Model *m, const double *bend, double *found)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      PetscInt K[2];

      if (BendOf(bend, I, d) == 0.0)
        continue;
      Beside(m, I, d, K);
      found[I * CL_DIM + d] = Alternates(m, bend, I, d, K);
    }
  }
  PetscCall(NodeMapSum(&m->map, found, CL_DIM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* t_I: a bend beside a node that alternates will be the next one. */
static PetscErrorCode LendShares(Model *m, const double *bend, const double *found, double *share)
{
  PetscFunctionBeginUser;
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int d = 0; d < CL_DIM; d++) {
      const double own = fabs(BendOf(bend, I, d));
      PetscInt     K[2];

      if (own == 0.0)
        continue;
      Beside(m, I, d, K);
      const double beside   = fmax(found[K[0] * CL_DIM + d], found[K[1] * CL_DIM + d]);
      share[I * CL_DIM + d] = fmax(found[I * CL_DIM + d], fmin(own, beside));
    }
  }
  PetscCall(NodeMapSum(&m->map, share, CL_DIM));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* theta of a particle, a mean over the axes weighted with h_d |a_d|; K: its (293). */
static double ShareOf(const Model *m, PetscInt p, const double K[CL_SYMMETRIC], const double *bend, const double *share)
{
  double h[CL_DIM], sum = 0.0, all = 0.0;
  Reach  r;

  CellWidths(m, p, h);
  ReachExpand(m, p, &r);
  for (int d = 0; d < CL_DIM; d++) {
    const double w  = h[d] * sqrt(K[cl_symmetric[d][d]]);
    double       of = 0.0, known = 0.0;

    for (int a = 0; a < r.n; a++) {
      of += r.S[a] * share[r.node[a] * CL_DIM + d];
      known += Known(bend, r.node[a], d) ? r.S[a] : 0.0;
    }
    sum += known > 0.0 ? w * fmin(1.0, of / (WHOLE * known)) : 0.0;
    all += w;
  }
  return all > 0.0 ? sum / all : 0.0;
}

PetscErrorCode UpwindLimit(Model *m)
{
  const size_t size = (size_t)CL_DIM * m->map.n_local;
  double      *bend, *found, *share;

  PetscFunctionBeginUser;
  if (!SceneCarriesHeat(m->c) || m->c->stabilisation.heat != HEAT_AUTO)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc3(BOTH * size, &bend, size, &found, size, &share));
  PetscCall(FindBends(m, bend));
  PetscCall(FindShares(m, bend, found));
  PetscCall(LendShares(m, bend, found, share));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double *K     = &m->added->upwind[CL_SYMMETRIC * p];
    double  trace = 0.0;

    for (int d = 0; d < CL_DIM; d++)
      trace += K[cl_symmetric[d][d]];
    if (!(trace > 0.0))
      continue;
    const double theta = ShareOf(m, p, K, bend, share);

    for (int k = 0; k < CL_SYMMETRIC; k++)
      K[k] *= theta;
  }
  PetscCall(PetscFree3(bend, found, share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
