/* The residual (15)-(23): particles, faces, stabilisation, Dirichlet rows. */
#include "gather.h"

/* Rows (15) of the mixture from one particle; those of the fluids lend it their inertia. */
static void ScatterSolid(const Model *m, const Reach *r, const double *x, const double out[OUT_COUNT], double *f)
{
  const FieldSet *fs   = &m->c->fields;
  const double    mean = out[OUT_P] + out[OUT_P + 3] + (m->c->axisymmetric ? out[OUT_HOOP] : 0.0);

  for (int a = 0; a < r->n; a++) {
    const double *G  = r->M[a];
    double       *fI = &f[r->node[a] * fs->n + PlaceVs(fs)], acc[2], inertia[2];

    Acceleration(m, r->node[a], x, PlaceVs(fs), 1.0, acc);
    for (int i = 0; i < CL_DIM; i++)
      inertia[i] = out[OUT_M] * acc[i];
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      if (!fs->phase[ph])
        continue;
      Acceleration(m, r->node[a], x, PlaceV(fs, ph), 1.0, acc);
      for (int i = 0; i < CL_DIM; i++)
        inertia[i] += out[OUT_M + 1 + ph] * acc[i];
    }
    for (int i = 0; i < CL_DIM; i++)
      fI[i] += r->S[a] * inertia[i] + G[0] * out[VectorAt(OUT_P, i, 0)] + G[1] * out[VectorAt(OUT_P, i, 1)];
    for (int i = 0; m->bc.ambient.on && i < CL_DIM; i++)
      fI[i] += r->S[a] * out[OUT_A + i];
    if (m->c->axisymmetric)
      fI[0] += r->K[a] * out[OUT_HOOP];
    for (int i = 0; m->c->mean_dilatation && i < CL_DIM; i++)
      fI[i] += r->B[a][i] * mean;
  }
}

/* Momentum (16) of one fluid at a node: a lone one has its drag at once, of two only what goes into it. */
static void ScatterMomentum(const Model *m, PetscInt p, int ph, PetscInt I, double S, const double *x,
                            const double out[OUT_COUNT], double *f)
{
  const double    flow = S * FlowWeight(m, p, I, ph);
  const FieldSet *fs   = &m->c->fields;
  FluidNode      *at   = m->fluid ? &m->fluid[PHASE_COUNT * I + ph] : NULL;
  double         *row  = at ? at->F : &f[I * fs->n + PlaceV(fs, ph)], acc[2], J[2];

  FluidAcceleration(m, p, I, x, ph, acc);
  for (int i = 0; i < CL_DIM; i++)
    row[i] += flow * (out[OUT_MI + ph] * acc[i] + out[VectorAt(OUT_G, ph, i)]);
  if (at) {
    at->D += flow * out[OUT_D + ph];
    at->root += MobilityShare(m, p, I, ph, S) * out[OUT_ROOT + ph];
    return;
  }
  DarcyFlux(m, I, ph, &x[I * fs->n], J);
  for (int i = 0; i < CL_DIM; i++)
    row[i] += flow * out[OUT_D + ph] * J[i];
}

/* Rows (16) and (17) of one fluid from one particle. */
static void ScatterFluid(const Model *m, PetscInt p, int ph, const Reach *r, const double *x,
                         const double out[OUT_COUNT], double *f)
{
  for (int a = 0; a < r->n; a++) {
    const PetscInt I = r->node[a];
    const double   S = r->S[a], *G = r->G[a];

    ScatterMomentum(m, p, ph, I, S, x, out, f);
    *MassRow(m, f, I, ph) += S * out[OUT_DM + ph] - m->stage.dt * (G[0] * out[VectorAt(OUT_FLUX, ph, 0)] +
                                                                   G[1] * out[VectorAt(OUT_FLUX, ph, 1)]);
  }
}

/* Rows (21). */
static void ScatterHeat(const Model *m, const Reach *r, const double *x, const double out[OUT_COUNT], double *f)
{
  const FieldSet *fs = &m->c->fields;

  for (int a = 0; a < r->n; a++) {
    const PetscInt k = r->node[a] * fs->n + PlaceT(fs);

    f[k] += r->S[a] * (out[OUT_C] * (x[k] - m->stage.x_star[k]) / m->stage.dt + out[OUT_Q]) +
            r->G[a][0] * out[OUT_HEAT] + r->G[a][1] * out[OUT_HEAT + 1];
  }
}

static void Scatter(const Model *m, PetscInt p, const Reach *r, const double *x, const double out[OUT_COUNT], double *f)
{
  const FieldSet *fs = &m->c->fields;

  if (fs->solid)
    ScatterSolid(m, r, x, out, f);
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    if (fs->phase[ph])
      ScatterFluid(m, p, ph, r, x, out, f);
  }
  if (fs->heat)
    ScatterHeat(m, r, x, out, f);
}

static void ParticleLoop(Model *m, const double *x, double *f)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach       r;
    PointState  state;
    PointOutput o;
    double      in[IN_COUNT];

    if (ParticleEvaluate(m, p, x, false, &r, in, &state, &o) != CL_OK)
      return;
    m->limited += state.limited;
    Scatter(m, p, &r, x, o.out, f);
    LumpResidual(m, p, &r, x, f);
  }
}

static void FaceLoop(const Model *m, const double *x, double *f)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *face = &m->face[k];
    Reach       r;
    FaceOutput  o;

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
      double           J[2];

      DarcyFlux(m, I, ph, &x[I * fs->n], J);
      for (int i = 0; i < CL_DIM; i++)
        m->f[I * fs->n + PlaceV(fs, ph) + i] = at->root * at->root * at->F[i] + at->D * J[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (34): the balances of both fluids make one of volume. */
static PetscErrorCode SumMassRows(Model *m)
{
  const FieldSet *fs = &m->c->fields;

  PetscFunctionBeginUser;
  PetscCall(NodeMapReduce(&m->map, m->mass_row, PHASE_COUNT));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      m->f[I * fs->n + PlaceP(fs, ph)] += RowWeight(m, I, ph) * m->mass_row[PHASE_COUNT * I + ph];
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

/* Unscaled rows of the owned nodes at X. */
static PetscErrorCode Rows(Model *m, Vec X)
{
  PetscFunctionBeginUser;
  m->failure.status = CL_OK;
  m->limited        = 0;
  PetscCall(ModelUnscale(m, X, m->x));
  PetscCall(PetscArrayzero(m->f, m->map.n_local * m->c->fields.n));
  if (m->mass_row)
    PetscCall(PetscArrayzero(m->mass_row, m->map.n_local * PHASE_COUNT));
  if (m->fluid)
    PetscCall(PetscArrayzero(m->fluid, m->map.n_local * PHASE_COUNT));
  PetscCall(ModelProjectGradients(m, m->x, false, m->proj));
  PetscCall(PlatesPosition(m, m->x));
  ParticleLoop(m, m->x, m->f);
  FaceLoop(m, m->x, m->f);
  StabilisationResidual(m, m->x, m->f);
  PetscCall(NodeMapReduce(&m->map, m->f, m->c->fields.n));
  if (m->mass_row)
    PetscCall(SumMassRows(m));
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

PetscErrorCode ModelFluidsAt(Model *m, Vec X)
{
  bool same;

  PetscFunctionBeginUser;
  if (!m->fluid)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(Evaluated(m, X, &same));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &same, 1, MPI_C_BOOL, MPI_LAND, m->grid.comm));
  if (!same)
    PetscCall(Rows(m, X));
  PetscCall(NodeMapBroadcast(&m->map, (double *)m->fluid, PHASE_COUNT * sizeof(FluidNode) / sizeof(double)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelResidual(SNES snes, Vec X, Vec R, void *model)
{
  Model *m = (Model *)model;

  PetscFunctionBeginUser;
  (void)snes;
  PetscCall(PetscLogEventBegin(m->event[EVENT_RESIDUAL], 0, 0, 0, 0));
  PetscCall(Rows(m, X));
  PetscCall(Finish(m, m->x, m->f, R));
  PetscCall(PetscLogEventEnd(m->event[EVENT_RESIDUAL], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
