/* Where what carries heat (293) and saturations (456) with the flow is needed: (440), (456) of docs/equations.md. */
#include "clathra/point_heat.h"
#include "gather.h"

/* Heat (of any unit) or volume that the fluids carry along axis d at t_n. */
static double CarriedAlong(const Model *m, PetscInt I, int d, bool heat)
{
  const FieldSet *fs  = &m->c->fields;
  double          sum = 0.0;

  for (int f = 0; f < PHASE_COUNT; f++) {
    double J[CL_DIM];

    if (!fs->phase[f])
      continue;
    DarcyFlux(m, I, f, &m->x_n[I * fs->n], J);
    sum += heat ? SpecificHeat(NodeMaterial(m, I), f) * m->coef[I * NC_COUNT + NC_RHO + f] * J[d] : J[d];
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

#define LEAST_SHARE 0.01 /* of the open pores: smaller differences of saturation are not seen */

/* s_g at a node's pressures at t_n. */
static double GasShareAt(const Model *m, PetscInt I)
{
  const double *x = &m->x_n[I * m->c->fields.n];
  double        slope[2];

  return RetentionGasShare(&NodeMaterial(m, I)->retention,
                           x[PlaceP(&m->c->fields, PHASE_G)] - x[PlaceP(&m->c->fields, PHASE_W)],
                           m->coef[I * NC_COUNT + NC_SH], &slope[0], &slope[1]);
}

/* Of T at t_n, or of s_g. */
static PetscErrorCode Shares(Model *m, bool heat, double *share)
{
  const FieldSet *fs = &m->c->fields;
  const PetscInt  n  = m->map.n_local;
  double         *value, *flow;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(n, &value, n * CL_DIM, &flow));
  for (PetscInt I = 0; I < n; I++) {
    value[I] = heat ? m->x_n[I * fs->n + PlaceT(fs)] : GasShareAt(m, I);
    for (int d = 0; d < CL_DIM; d++)
      flow[I * CL_DIM + d] = CarriedAlong(m, I, d, heat);
  }
  const NodalField field = {value, flow, heat ? HEAT_LEAST_T : LEAST_SHARE, !heat && SceneHasFronts(m->c)};
  PetscCall(NodeMapAlternation(&m->grid, &m->map, &field, share));
  PetscCall(PetscFree2(value, flow));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* spread: D of (456), two a particle; or null. */
static PetscErrorCode LimitHeat(Model *m, const double *spread, double *share)
{
  PetscFunctionBeginUser;
  PetscCall(Shares(m, true, share));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double         *K     = &m->added->upwind[CL_SYMMETRIC * p];
    double          trace = 0.0;
    PointProperties q;
    const char     *why;

    if (spread && spread[PHASE_COUNT * p] != 0.0 && ModelParticleProperties(m, p, &q, &why) == CL_OK)
      AdditionsUpwind(m, p, &q, spread[PHASE_COUNT * p], K);

    for (int d = 0; d < CL_DIM; d++)
      trace += K[cl_symmetric[d][d]];
    if (!(trace > 0.0))
      continue;
    const double theta = ShareOf(m, p, K, share);

    for (int k = 0; k < CL_SYMMETRIC; k++)
      K[k] *= theta;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (456): axes count by the gradient of p_c. */
static PetscErrorCode LimitSaturations(Model *m, double *share)
{
  PetscFunctionBeginUser;
  PetscCall(Shares(m, false, share));
  for (PetscInt p = 0; p < m->P.n; p++) {
    double *D = &m->added->spread[PHASE_COUNT * p], K[CL_SYMMETRIC] = {0.0};

    if (D[PHASE_W] == 0.0)
      continue;
    for (int d = 0; d < CL_DIM; d++)
      K[cl_symmetric[d][d]] = PetscSqr(m->P.f[VectorAt(P_GW, PHASE_G, d)][p] - m->P.f[VectorAt(P_GW, PHASE_W, d)][p]);
    D[PHASE_W] = D[PHASE_G] = D[PHASE_W] * ShareOf(m, p, K, share);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode UpwindLimit(Model *m)
{
  const bool saturations = m->added->spread && !m->added->donor;
  double    *share;

  PetscFunctionBeginUser;
  if (!SceneCarriesHeat(m->c) && !saturations)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(ALTERNATION_COUNT * CL_DIM * m->map.n_local, &share));
  if (saturations)
    PetscCall(LimitSaturations(m, share));
  if (SceneCarriesHeat(m->c))
    PetscCall(LimitHeat(m, saturations ? m->added->spread : NULL, share));
  PetscCall(PetscFree(share));
  PetscFunctionReturn(PETSC_SUCCESS);
}
