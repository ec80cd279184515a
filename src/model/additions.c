/* What the scheme adds to the balances of particles, at t_n: diffusion that carries saturations and heat with the flow,
   how fast the reaction is held. */
#include "clathra/point_heat.h"
#include "clathra/point_reaction.h"
#include "gather.h"

PetscErrorCode AdditionsReserve(Model *m)
{
  const FieldSet *fs = &m->c->fields;
  Additions      *to = m->added;

  PetscFunctionBeginUser;
  if (SceneDonor(m->c))
    PetscCall(PetscMalloc1(m->stencil_cap, &to->donor));
  if (fs->phase[PHASE_W] && fs->phase[PHASE_G] && (!to->donor || SceneCarriesGas(m->c)))
    PetscCall(PetscCalloc1(PHASE_COUNT * m->stencil_cap, &to->spread));
  if (SceneCarriesHeat(m->c))
    PetscCall(PetscCalloc1(CL_SYMMETRIC * m->stencil_cap, &to->upwind));
  if (SceneHasLongCells(m->c))
    PetscCall(PetscCalloc1(m->stencil_cap, &to->long_cell));
  if (SceneReactsWithHeat(m->c)) {
    PetscCall(PetscMalloc1(m->stencil_cap, &to->held));
    PetscCall(PetscMalloc1(m->stencil_cap, &to->chord));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode AdditionsOfStage(Model *m)
{
  PetscFunctionBeginUser;
  if (!SceneExchanges(m->c))
    PetscCall(PetscFree(m->added->exchange));
  else if (!m->added->exchange)
    PetscCall(PetscMalloc1(m->stencil_cap, &m->added->exchange));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* With gas of where it comes from: diffusion of p_c with the flow of both fluids, or that of one that flows alone
 * (200). */
static void SpreadOf(const Model *m, PetscInt p, const PointProperties *q, double D[PHASE_COUNT])
{
  const double l[PHASE_COUNT] = {q->kr[PHASE_W] / q->resist[PHASE_W], q->kr[PHASE_G] / q->resist[PHASE_G]},
               all = l[PHASE_W] + l[PHASE_G], both = l[PHASE_W] * l[PHASE_G] / all;
  double h[CL_DIM], Pe[PHASE_COUNT] = {0.0}, shared = 0.0;

  D[PHASE_W] = D[PHASE_G] = 0.0;
  if (!(both > 0.0))
    return;
  CellWidths(m, p, h);
  for (int k = 0; k < PHASE_COUNT; k++) {
    double g[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      g[d] = m->P.f[VectorAt(P_GW, k, d)][p] - q->rho[k] * m->c->gravity[d];
    Drive(m, p, g);
    for (int d = 0; d < CL_DIM; d++)
      Pe[k] += 0.5 * h[d] * fabs(g[d] * q->mobility_slope[k]) / both;
    shared += (1.0 - l[k] / all) * Pe[k];
  }
  for (int k = 0; k < PHASE_COUNT; k++) {
    const double most = fmax(shared, l[k] / all * Pe[k]);

    if (most > 1e-4)
      D[k] = both * (most / tanh(most) - 1.0);
  }
}

#define LEAST_CHANGE 1e-3 /* of p_0: less than this p_c is not taken to differ by in a cell */

/* l_pi = k_a k_r,pi/mu_pi of particle p at another capillary pressure, m^2/(Pa s). */
static void MobilitiesAt(const Material *mat, const PointProperties *q, double pc, double l[PHASE_COUNT])
{
  double       slope[2];
  const double sg = RetentionGasShare(&mat->retention, pc, q->Sh, &slope[0], &slope[1]);
  const double w  = KrArgumentOf(mat->relperm.of_pores, 1.0 - sg, q->Sh).v,
               g  = KrArgumentOf(mat->relperm.of_pores, sg, q->Sh).v;

  l[PHASE_W] = KrFloored(RelPermWater(&mat->relperm, w, slope)) / q->resist[PHASE_W];
  l[PHASE_G] = KrFloored(RelPermGas(&mat->relperm, g, slope)) / q->resist[PHASE_G];
}

/* Volume of a fluid through a particle along axis d by Darcy's law, m/s; beds aside. */
static double DarcyAlong(const Model *m, PetscInt p, const PointProperties *q, int k, int d)
{
  return -q->kr[k] / q->resist[k] * (m->P.f[VectorAt(P_GW, k, d)][p] - q->rho[k] * m->c->gravity[d]);
}

/* The same of all axes: by the fluid's own velocity where that has a memory, else by Darcy's law. */
static void FluxOf(const Model *m, PetscInt p, const PointProperties *q, int k, double J[CL_DIM])
{
  double *const *f = m->P.f;

  for (int d = 0; d < CL_DIM; d++) {
    if (m->c->fields.inertia)
      J[d] =
          q->phi * (1.0 - q->Sh) * q->s[k] * (f[VectorAt(P_VW, k, d)][p] - (m->c->fields.solid ? f[P_VS + d][p] : 0.0));
    else
      J[d] = DarcyAlong(m, p, q, k, d);
  }
  if (!m->c->fields.inertia)
    Drive(m, p, J);
}

/* D of (456) but for theta, m^2/(Pa s). */
static double SpreadByFlow(const Model *m, PetscInt p, const PointProperties *q)
{
  double *const  *f   = m->P.f;
  const Material *mat = ParticleMaterial(m, p);
  TwoFluids       two = {.heavier = q->rho[PHASE_W] - q->rho[PHASE_G]};
  double          J[PHASE_COUNT][CL_DIM];

  CellWidths(m, p, two.h);
  for (int k = 0; k < PHASE_COUNT; k++) {
    two.mobility[k] = q->kr[k] / q->resist[k];
    FluxOf(m, p, q, k, J[k]);
  }
  for (int d = 0; d < CL_DIM; d++) {
    two.J[d]       = J[PHASE_W][d] + J[PHASE_G][d];
    two.grad_pc[d] = f[VectorAt(P_GW, PHASE_G, d)][p] - f[VectorAt(P_GW, PHASE_W, d)][p];
    two.half += 0.5 * two.h[d] * fabs(two.grad_pc[d]);
    two.h[d] = CarryingWidth(two.h[d], f[P_L + d][p]);
  }
  two.half = fmax(two.half, LEAST_CHANGE * mat->retention.p0);
  MobilitiesAt(mat, q, f[P_PG][p] - f[P_PW][p] - two.half, two.less);
  MobilitiesAt(mat, q, f[P_PG][p] - f[P_PW][p] + two.half, two.more);
  return SaturationDiffusion(&two, m->c->gravity, m->beds ? &m->beds[p].A : NULL);
}

void ModelHeatFlow(const Model *m, PetscInt p, const PointProperties *q, double a[CL_DIM])
{
  const Material *mat = ParticleMaterial(m, p);

  for (int d = 0; d < CL_DIM; d++)
    a[d] = 0.0;
  for (int k = 0; k < PHASE_COUNT; k++) {
    for (int d = 0; m->c->fields.phase[k] && d < CL_DIM; d++)
      a[d] += SpecificHeat(mat, k) * q->rho[k] * DarcyAlong(m, p, q, k, d);
  }
}

void AdditionsUpwind(const Model *m, PetscInt p, const PointProperties *q, double spread, double K[CL_SYMMETRIC])
{
  double *const  *f   = m->P.f;
  const Material *mat = ParticleMaterial(m, p);
  double          a[CL_DIM], h[CL_DIM];

  ModelHeatFlow(m, p, q, a);
  for (int d = 0; spread != 0.0 && d < CL_DIM; d++)
    a[d] += spread * (f[VectorAt(P_GW, PHASE_G, d)][p] - f[VectorAt(P_GW, PHASE_W, d)][p]) *
            (SpecificHeat(mat, PHASE_W) * q->rho[PHASE_W] - SpecificHeat(mat, PHASE_G) * q->rho[PHASE_G]);
  Drive(m, p, a);
  CellWidths(m, p, h);
  (void)HeatUpwind(q->kappa, a, h, K);
}

/* Heat of plastic flow at the end of the last step, as if all of it were shear, W/m^3. */
static double PlasticPower(const Model *m, PetscInt p)
{
  double *const *f = m->P.f;
  double         sig[6];

  if (!f[P_KP])
    return 0.0;
  for (int k = 0; k < 6; k++)
    sig[k] = f[P_SIG + k][p];
  return ParticleMaterial(m, p)->plasticity.heat * Mises6(sig) * fmax(f[P_KP][p], 0.0);
}

/* (381) with the faster of both ways at t_n; the cell's widths by the particle's place, as hybrid keeps no stencils. */
static double HeldOf(const Model *m, PetscInt p, const PointProperties *q)
{
  double *const  *f   = m->P.f;
  const Material *mat = ParticleMaterial(m, p);
  double          h[CL_DIM];
  HeldParticle    x = {.h       = h,
                       .by      = ReactionPressure(mat->gas.trace, q->s[PHASE_G], f[P_PW][p], f[P_PG][p]),
                       .heat    = q->reaction_heat,
                       .kappa   = q->kappa,
                       .C       = q->capacity / f[P_V][p],
                       .plastic = PlasticPower(m, p),
                       .since   = m->t_n - m->c->t_begin,
                       .rate    = {f[P_RATE][p], f[P_RATE_PG][p]}};

  x.pe = EquilibriumPressure(&mat->kinetics.equilibrium, f[P_T][p], &x.dpe_dT);
  for (int d = 0; d < CL_DIM; d++) {
    h[d]     = LinesWidthAt(&m->grid.line[d], ParticleGridX(&m->P, p, d));
    x.g_T[d] = f[P_GT + d][p];
    for (int k = 0; k < PHASE_COUNT; k++)
      x.g_p[k][d] = f[VectorAt(P_GW, k, d)][p];
  }
  return ReactionHeldAt(&x);
}

void AdditionsSet(Model *m, PetscInt p, const PointProperties *q)
{
  Additions *to = m->added;

  if (to->spread && to->donor)
    SpreadOf(m, p, q, &to->spread[PHASE_COUNT * p]);
  else if (to->spread)
    to->spread[PHASE_COUNT * p] = to->spread[PHASE_COUNT * p + 1] = SpreadByFlow(m, p, q);
  if (to->upwind)
    AdditionsUpwind(m, p, q, 0.0, &to->upwind[CL_SYMMETRIC * p]);
  if (to->long_cell) {
    double h[CL_DIM];

    CellWidths(m, p, h);
    to->long_cell[p] = LongCellConductivity(q->kappa, h);
  }
  if (to->held)
    to->held[p] = HeldOf(m, p, q);
  if (to->exchange)
    ExchangeSet(m, p, q);
}
