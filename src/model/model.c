/* Life of a model. */
#include "clathra/point_heat.h"
#include "solver.h"

PetscErrorCode ModelCreate(MPI_Comm comm, const Scene *c, const Scene *first, Model *m)
{
  GridLines line[CL_DIM];

  static const char *const name[EVENT_COUNT] = {"ClBeginStep",     "ClResidual",     "ClJacobian", "ClWidePart",
                                                "ClReducedMatrix", "ClReducedApply", "ClProduct"};

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(m, sizeof(*m)));
  m->c = c;
  for (int d = 0; d < CL_DIM; d++)
    line[d] = SceneLines(c, d);
  PetscCall(GridCreateOn(comm, line, &m->grid));
  PetscCall(ParticlesCreate(c->fields.has, &m->P));
  m->P.total = c->basis == BASIS_TOTAL && c->fields.solid;
  PetscCall(ParticlesSeed(first, &m->grid, &m->P));
  PetscCall(GeostaticStress(first, &m->grid, &m->P));
  PetscCall(PetscCalloc4(c->nbc, &m->bc.value, c->nbc, &m->bc.shear, c->nbc, &m->bc.phase[0], c->nbc, &m->bc.phase[1]));
  PetscCall(ModelPlatesCreate(m));
  m->failure.why[0] = '?';
  PetscCall(PetscNew(&m->added));
  PetscCall(SolverCreate(&m->solver));
  PetscCall(PreconditionerPlan(m));
  for (int e = 0; e < EVENT_COUNT; e++)
    PetscCall(PetscLogEventRegister(name[e], PETSC_OBJECT_CLASSID, &m->event[e]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode DestroyNodal(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree6(m->x_n, m->w, m->V, m->Vk, m->flow, m->coef));
  PetscCall(PetscFree(m->wall));
  PetscCall(PetscFree3(m->material, m->most, m->hydrate));
  PetscCall(PetscFree(m->added->source));
  PetscCall(PetscFree4(m->mask, m->fixed, m->row_scale, m->col_scale));
  PetscCall(PetscFree5(m->x, m->f, m->proj, m->give, m->take));
  PetscCall(PetscFree(m->fluid));
  PetscCall(SolverReset(m->solver));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode FreeParticleArrays(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->stencil));
  PetscCall(PetscFree(m->conduct));
  PetscCall(PetscFree(m->order));
  PetscCall(PetscFree(m->wide));
  PetscCall(PetscFree(m->added->donor));
  PetscCall(PetscFree(m->added->exchange));
  PetscCall(PetscFree(m->added->spread));
  PetscCall(PetscFree(m->added->upwind));
  PetscCall(PetscFree(m->added->long_cell));
  PetscCall(PetscFree(m->added->held));
  PetscCall(PetscFree(m->added->chord));
  PetscCall(PetscFree(m->beds));
  PetscCall(PetscFree(m->share));
  PetscCall(PetscFree(m->cell));
  m->stencil_cap = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelDestroy(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(DestroyNodal(m));
  PetscCall(SolverDestroy(&m->solver));
  PetscCall(FreeParticleArrays(m));
  PetscCall(PetscFree(m->face));
  PetscCall(PetscFree(m->leaving.one));
  PetscCall(PetscFree(m->added->ghost));
  PetscCall(PetscFree(m->added->cell));
  PetscCall(PetscFree(m->added));
  PetscCall(PetscFree4(m->bc.value, m->bc.shear, m->bc.phase[0], m->bc.phase[1]));
  PetscCall(PetscFree2(m->plate, m->plate_K));
  PetscCall(ParticlesDestroy(&m->P));
  PetscCall(NodeMapDestroy(&m->map));
  PetscCall(GridDestroy(&m->grid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The numbering of nodes and the faces were those of other borders. */
static PetscErrorCode ForgetLayout(Model *m)
{
  PetscFunctionBeginUser;
  PetscCall(NodeMapDestroy(&m->map));
  PetscCall(PetscFree(m->face));
  m->nface = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelBalance(Model *m)
{
  bool moved;

  PetscFunctionBeginUser;
  PetscCall(ParticlesBalance(&m->grid, &m->P, &moved));
  if (moved)
    PetscCall(ForgetLayout(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelShare(Model *m, const PetscInt nproc[], PetscInt *const start[])
{
  PetscFunctionBeginUser;
  PetscCall(GridShare(&m->grid, nproc, start));
  PetscCall(ForgetLayout(m));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Everything whose size follows the active nodes; the solver is made anew when first needed. */
PetscErrorCode ModelResizeNodal(Model *m)
{
  const PetscInt n = PetscMax(m->map.n_local, 1), nf = m->c->fields.n;

  PetscFunctionBeginUser;
  PetscCall(DestroyNodal(m));
  PetscCall(
      PetscCalloc6(n * nf, &m->x_n, n * PHASE_COUNT, &m->w, n, &m->V, n, &m->Vk, n, &m->flow, n * NC_COUNT, &m->coef));
  PetscCall(PetscCalloc3(n, &m->material, n, &m->most, n, &m->hydrate));
  if (m->c->axisymmetric && m->c->fields.fluid)
    PetscCall(PetscCalloc1(n * PHASE_COUNT, &m->wall));
  if (SceneDonor(m->c))
    PetscCall(PetscCalloc1(n * 2, &m->added->source));
  PetscCall(PetscCalloc4(n, &m->mask, n * nf, &m->fixed, n * nf, &m->row_scale, n * nf, &m->col_scale));
  PetscCall(PetscCalloc5(n * nf, &m->x, n * nf, &m->f, n * CL_FLUID_VECTORS, &m->proj, n * GIVE_COUNT, &m->give,
                         n * TAKE_COUNT, &m->take));
  if (m->c->fields.phase[PHASE_W] && m->c->fields.phase[PHASE_G])
    PetscCall(PetscCalloc1(n * PHASE_COUNT, &m->fluid));
  PetscFunctionReturn(PETSC_SUCCESS);
}

double ModelKineticEnergy(const Particles *P, PetscInt p)
{
  const double m[3] = {P->f[P_MS][p] + P->f[P_MH][p], P->f[P_MW] ? P->f[P_MW][p] : 0.0,
                       P->f[P_MG] ? P->f[P_MG][p] : 0.0};
  double       sum  = 0.0;

  for (int k = 0; k < 3; k++) {
    const int v = P_VS + k * CL_DIM;

    for (int d = 0; P->f[v] && d < CL_DIM; d++)
      sum += 0.5 * m[k] * PetscSqr(P->f[v + d][p]);
  }
  return sum;
}

/* Enthalpy of a particle beside water at 0 degC, J (363). */
static double Enthalpy(const Material *mat, double capacity, double mh, double T)
{
  double slope;

  return capacity * T - (mat->reacts ? mh * LatentHeatEvaluate(&mat->latent, 0.0, &slope) : 0.0);
}

/* Of a particle's methane in the pores (kg) what its water holds (101), kg. */
static double Dissolved(const Model *m, PetscInt p, double mg)
{
  double *const *f = m->P.f;
  const double   H = ParticleMaterial(m, p)->gas.trace;

  return H > 0.0 && f[P_PG] ? fmin(f[P_PHI][p] * f[P_V][p] * f[P_SW][p] * DissolvedMethane(H, f[P_PG][p]), mg) : 0.0;
}

void ModelAddTotals(const Model *m, PetscInt p, ModelTotals *t)
{
  const Material *mat = ParticleMaterial(m, p);
  const Kinetics *k   = &mat->kinetics;
  const double    ms = m->P.f[P_MS][p], mh = m->P.f[P_MH][p];
  const double    mw       = m->c->fields.phase[PHASE_W] ? m->P.f[P_MW][p] : 0.0;
  const double    mg       = m->c->fields.phase[PHASE_G] ? m->P.f[P_MG][p] : 0.0;
  const double    capacity = HeatCapacity(mat, ms, mh, mw, mg);

  t->water += mw + (mat->reacts ? mh * KineticsWater(k) : 0.0);
  t->methane += mg + (mat->reacts ? mh * KineticsMethane(k) : 0.0);
  t->hydrate += mh;
  t->solid += ms;
  t->gas += mg;
  t->dissolved += Dissolved(m, p, mg);
  t->V += m->P.f[P_V][p];
  t->capacity += capacity;
  if (m->c->fields.heat)
    t->enthalpy += Enthalpy(mat, capacity, mh, m->P.f[P_T][p]);
}

PetscErrorCode ModelComputeTotals(const Model *m, ModelTotals *t)
{
  PetscFunctionBeginUser;
  *t = (ModelTotals){0};
  for (PetscInt p = 0; p < m->P.n; p++)
    ModelAddTotals(m, p, t);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, t, sizeof(*t) / sizeof(double), MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}
