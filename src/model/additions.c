/* What the scheme adds to the balances of particles, at t_n: diffusion that carries saturations and heat with the flow.
 */
#include "clathra/point_heat.h"
#include "gather.h"

PetscErrorCode AdditionsReserve(Model *m)
{
  const FieldSet *fs = &m->c->fields;
  Additions      *to = m->added;

  PetscFunctionBeginUser;
  if (SceneDonor(m->c))
    PetscCall(PetscMalloc1(m->stencil_cap, &to->donor));
  if (fs->phase[PHASE_W] && fs->phase[PHASE_G])
    PetscCall(PetscCalloc1(m->stencil_cap, &to->diffusion));
  if (SceneCarriesHeat(m->c))
    PetscCall(PetscCalloc1(CL_SYMMETRIC * m->stencil_cap, &to->upwind));
  if (SceneThinCells(m->c))
    PetscCall(PetscCalloc1(m->stencil_cap, &to->thin));
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

/* Widths of its cell by the particle's place, as hybrid keeps no stencils, m. */
static void CellWidthsAt(const Model *m, PetscInt p, double h[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    h[d] = LinesWidthAt(&m->grid.line[d], ParticleGridX(&m->P, p, d));
}

double ModelSaturationDiffusion(const Model *m, PetscInt p, const PointProperties *q, bool lumped)
{
  TwoFluids f;

  for (int k = 0; k < PHASE_COUNT; k++) {
    f.mobility[k] = q->kr[k] / q->resist[k];
    f.slope[k]    = q->mobility_slope[k];
    f.rho[k]      = q->rho[k];
    for (int d = 0; d < CL_DIM; d++)
      f.grad_p[k][d] = m->P.f[VectorAt(P_GW, k, d)][p];
  }
  CellWidthsAt(m, p, f.h);
  for (int d = 0; d < CL_DIM; d++)
    f.h[d] = CarryingWidth(f.h[d], m->P.f[P_L + d][p], lumped);
  const Beds beds = SceneHasBeds(m->c) ? ParticleBeds(m->c, &m->P, p) : (Beds){{0.0}};
  return SaturationDiffusion(&f, m->c->gravity, SceneHasBeds(m->c) ? &beds : NULL);
}

/* Conductivity that carries heat with the flow of t_n (293). */
static void UpwindOf(const Model *m, PetscInt p, const PointProperties *q, double K[CL_SYMMETRIC])
{
  const Material *mat       = ParticleMaterial(m, p);
  double          a[CL_DIM] = {0.0}, h[CL_DIM];

  for (int k = 0; k < PHASE_COUNT; k++) {
    for (int d = 0; m->c->fields.phase[k] && d < CL_DIM; d++)
      a[d] -= SpecificHeat(mat, k) * q->rho[k] * q->kr[k] / q->resist[k] *
              (m->P.f[VectorAt(P_GW, k, d)][p] - q->rho[k] * m->c->gravity[d]);
  }
  Drive(m, p, a);
  CellWidths(m, p, h);
  HeatUpwind(q->kappa, a, h, K);
}

void AdditionsSet(Model *m, PetscInt p, const PointProperties *q)
{
  Additions *to = m->added;

  if (to->diffusion)
    to->diffusion[p] = ModelSaturationDiffusion(m, p, q, false);
  if (to->upwind)
    UpwindOf(m, p, q, &to->upwind[CL_SYMMETRIC * p]);
  if (to->thin)
    to->thin[p] = ThinOf(m, p, q->kappa);
  if (to->exchange)
    ExchangeSet(m, p, q);
}
