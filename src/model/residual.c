/* The residual (15)-(23): particles, faces, stabilisation, Dirichlet rows. */
#include "solver.h"

/* Row (15) at a node; the fluids lend the mixture their inertia. */
static void SolidRow(const Model *m, PetscInt I, const double *x, const double *take, double *f)
{
  const FieldSet *fs = &m->c->fields;
  double         *fI = &f[I * fs->n + PlaceVs(fs)], acc[CL_DIM];

  for (int k = 0; k < 1 + PHASE_COUNT; k++) {
    if (k > 0 && !fs->phase[k - 1])
      continue;
    Acceleration(m, I, x, k > 0 ? PlaceV(fs, k - 1) : PlaceVs(fs), 1.0, acc);
    for (int i = 0; i < CL_DIM; i++)
      fI[i] += take[TAKE_M + k] * acc[i];
  }
  for (int i = 0; i < CL_DIM; i++)
    fI[i] += take[TAKE_GRAD + i] + take[TAKE_A + i];
}

/* Rows (16) and (17) of a fluid at a node: a lone one has its drag at once, of two only what goes into it. */
static void FluidRows(const Model *m, int ph, PetscInt I, const double *x, const double *take, double *f)
{
  const FieldSet *fs    = &m->c->fields;
  const double   *of    = &take[TAKE_FLUID + FLUID_COUNT * ph];
  FluidNode      *at    = m->fluid ? &m->fluid[PHASE_COUNT * I + ph] : NULL;
  double         *row   = at ? at->F : &f[I * fs->n + PlaceV(fs, ph)], rate[CL_DIM], J[CL_DIM];
  const double    share = NodeShare(m, I, ph);

  *RowOf(m, f, I, F_PW + ph) += take[TAKE_DM + ph] + take[TAKE_MASS + ph];
  Rate(m, I, x, PlaceV(fs, ph), rate); /* inertia by the particles' share of the flow (310) */
  for (int i = 0; i < CL_DIM; i++)
    row[i] += share * (share * of[FLUID_MI2] * rate[i] - of[FLUID_MI] * m->bc.gravity[i] + of[FLUID_G + i]);
  if (at) {
    for (int i = 0; i < CL_DIM; i++)
      at->D[i] += share * of[FLUID_D] + WallDrag(m, I, ph, i);
    at->root += RootFactor(m, I, ph) * take[TAKE_ROOT + ph] / m->V[I];
    return;
  }
  DarcyFlux(m, I, ph, &x[I * fs->n], J);
  for (int i = 0; i < CL_DIM; i++)
    row[i] += (share * of[FLUID_D] + WallDrag(m, I, ph, i)) * J[i];
}

/* Row (21) at a node. */
static void HeatRow(const Model *m, PetscInt I, const double *x, const double *take, double *f)
{
  const PetscInt k = I * m->c->fields.n + PlaceT(&m->c->fields);

  f[k] += take[TAKE_C] * (x[k] - m->stage.x_star[k]) / m->stage.dt + take[TAKE_C + 1] + take[TAKE_HEAT];
}

/* What the particles added becomes rows of the nodes. */
static void NodeLoop(const Model *m, const double *x, double *f)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *take = &m->take[TAKE_COUNT * I];

    if (fs->solid)
      SolidRow(m, I, x, take, f);
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      if (fs->phase[ph])
        FluidRows(m, ph, I, x, take, f);
    }
    if (fs->heat)
      HeatRow(m, I, x, take, f);
  }
}

static void ParticleLoop(Model *m, const double *x, double *f)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    ParticleResult at;

    if (ParticleEvaluate(m, p, x, false, &at) != CL_OK)
      return;
    m->limited += at.state.limited;
    ParticleScatter(m, p, &at.r, x, at.o.out);
    LongCellResidual(m, p, &at.r, x, f);
  }
  NodeLoop(m, x, f);
}

static void FaceLoop(const Model *m, const double *x, double *f)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *face = &m->face[k];
    Reach       r;
    FaceOutput  o;

    if (!FaceActs(m->c, face))
      continue;
    FaceAt(m, face, x, &r, &o);
    for (int a = 0; a < r.n; a++) {
      for (int q = 0; q < F_COUNT; q++) {
        if (fs->at[q] >= 0)
          *RowOf(m, f, r.node[a], q) += FaceWeight(face, a, q) * FaceFlow(m, face->particle, r.node[a], q) * o.out[q];
      }
    }
  }
}

/* (16) of two fluids: k_r F + D J. */
static PetscErrorCode MomentumRows(Model *m, const double *x)
{
  const FieldSet *fs = &m->c->fields;

  PetscFunctionBeginUser;
  PetscCall(NodeMapReduce(&m->map, (double *)m->fluid, PHASE_COUNT * sizeof(FluidNode) / sizeof(double)));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      const FluidNode *at = &m->fluid[PHASE_COUNT * I + ph];
      double           J[CL_DIM];

      DarcyFlux(m, I, ph, &x[I * fs->n], J);
      for (int i = 0; i < CL_DIM; i++)
        m->f[I * fs->n + PlaceV(fs, ph) + i] = at->root * at->root * at->F[i] + at->D[i] * J[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scaled rows; a prescribed unknown's row is x - x_hat. */
static PetscErrorCode Finish(Model *m, const double *x, const double *f, Vec R)
{
  const PetscInt n = m->c->fields.n;
  double        *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(R, &a));
  for (PetscInt k = 0; k < m->map.n_owned * n; k++) {
    const bool fixed = (m->mask[k / n] >> (k % n)) & 1u;

    a[k] = fixed ? (x[k] - m->fixed[k]) / m->col_scale[k] : f[k] / m->row_scale[k];
    if (m->failure.status != CL_OK)
      a[k] = NAN; /* every rank sees it in the norm; SNESSetFunctionDomainError would tell this rank alone */
  }
  PetscCall(VecRestoreArrayWrite(R, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What nodes hold for their particles at X. */
static PetscErrorCode Give(Model *m, Vec X)
{
  PetscFunctionBeginUser;
  m->evaluated = false;
  PetscCall(ModelUnscale(m, X, m->x));
  PetscCall(ModelProjectGradients(m, m->x, false, m->proj));
  PetscCall(PlatesPosition(m, m->x));
  ModelGive(m, m->x, false);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Unscaled rows of the owned nodes at X. */
static PetscErrorCode Rows(Model *m, Vec X)
{
  PetscFunctionBeginUser;
  m->failure.status = CL_OK;
  m->limited        = 0;
  PetscCall(Give(m, X));
  PetscCall(PetscArrayzero(m->f, m->map.n_local * m->c->fields.n));
  if (m->fluid)
    PetscCall(PetscArrayzero(m->fluid, m->map.n_local * PHASE_COUNT));
  PetscCall(PetscArrayzero(m->take, m->map.n_local * TAKE_COUNT));
  ParticleLoop(m, m->x, m->f);
  FaceLoop(m, m->x, m->f);
  StabilisationResidual(m, m->x, false, m->f);
  PetscCall(NodeMapReduce(&m->map, m->f, m->c->fields.n));
  if (m->fluid)
    PetscCall(MomentumRows(m, m->x));
  m->evaluated = true;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is X what this rank evaluated last? */
static PetscErrorCode Evaluated(const Model *m, Vec X, bool *same)
{
  const double *a;

  PetscFunctionBeginUser;
  *same = m->evaluated;
  PetscCall(VecGetArrayRead(X, &a));
  for (PetscInt k = 0; *same && k < m->map.n_owned * m->c->fields.n; k++)
    *same = a[k] * m->col_scale[k] == m->x[k];
  PetscCall(VecRestoreArrayRead(X, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ... on all ranks? */
static PetscErrorCode EvaluatedByAll(const Model *m, Vec X, bool *same)
{
  PetscFunctionBeginUser;
  PetscCall(Evaluated(m, X, same));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, same, 1, MPI_C_BOOL, MPI_LAND, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelNodesAt(Model *m, Vec X)
{
  bool same;

  PetscFunctionBeginUser;
  PetscCall(EvaluatedByAll(m, X, &same));
  if (!same)
    PetscCall(m->fluid || m->solver->product ? Rows(m, X) : Give(m, X));
  if (m->fluid)
    PetscCall(NodeMapBroadcast(&m->map, (double *)m->fluid, PHASE_COUNT * sizeof(FluidNode) / sizeof(double)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelResidual(SNES snes, Vec X, Vec R, void *model)
{
  Model *m = (Model *)model;
  bool   same;

  PetscFunctionBeginUser;
  (void)snes;
  PetscCall(PetscLogEventBegin(m->event[EVENT_RESIDUAL], 0, 0, 0, 0));
  PetscCall(EvaluatedByAll(m, X, &same));
  if (!same)
    PetscCall(Rows(m, X));
  PetscCall(Finish(m, m->x, m->f, R));
  PetscCall(PetscLogEventEnd(m->event[EVENT_RESIDUAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
