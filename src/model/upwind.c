/* Where the conductivity that carries heat with the flow (293) is needed: (440) of docs/equations.md. */
#include "clathra/point_heat.h"
#include "gather.h"

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

static double ShareOf(const Model *m, PetscInt p, const double K[CL_SYMMETRIC], const double *share)
{
  double h[CL_DIM], mean[CL_DIM][ALTERNATION_COUNT] = {{0.0}};
  Reach  r;

  CellWidths(m, p, h);
  ReachExpand(m, p, &r);
  for (int a = 0; a < r.n; a++) {
    for (int d = 0; d < CL_DIM; d++) {
      for (int k = 0; k < ALTERNATION_COUNT; k++)
        mean[d][k] += r.S[a] * share[(r.node[a] * CL_DIM + d) * ALTERNATION_COUNT + k];
    }
  }
  return AlternationOf(mean, h, K);
}

/* Of T at t_n. */
static PetscErrorCode Shares(Model *m, double *share)
{
  const FieldSet *fs = &m->c->fields;
  const PetscInt  n  = m->map.n_local;
  double         *T, *flow;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &T, n * CL_DIM, &flow));
  for (PetscInt I = 0; I < n; I++) {
    T[I] = m->x_n[I * fs->n + PlaceT(fs)];
    for (int d = 0; d < CL_DIM; d++)
      flow[I * CL_DIM + d] = CarriedAlong(m, I, d);
  }
  PetscCall(NodeMapAlternation(&m->grid, &m->map, &(NodalField){T, flow, HEAT_LEAST_T}, share));
  PetscCall(PetscFree2(T, flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UpwindLimit(Model *m)
{
  double *share;

  PetscFunctionBeginUser;
  if (!SceneCarriesHeat(m->c))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(ALTERNATION_COUNT * CL_DIM * m->map.n_local, &share));
  PetscCall(Shares(m, share));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double *K     = &m->added->upwind[CL_SYMMETRIC * p];
    double  trace = 0.0;

    for (int d = 0; d < CL_DIM; d++)
      trace += K[cl_symmetric[d][d]];
    if (!(trace > 0.0))
      continue;
    const double theta = ShareOf(m, p, K, share);

    for (int k = 0; k < CL_SYMMETRIC; k++)
      K[k] *= theta;
  }
  PetscCall(PetscFree(share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
