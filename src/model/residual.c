/* The residual (15)-(23): particles, faces, stabilisation, Dirichlet rows. */
#include "gather.h"

/* What a particle adds at each of its nodes: [0] is weighted with S, [1] and [2] with the components of G. */
typedef struct {
  double S[TAKE_GRAD], G[CL_DIM][TAKE_COUNT - TAKE_GRAD];
} Shares;

/* (35) and (359) are no shares of the particle's own. */
static bool LayerRoot(const Model *m, int f)
{
  return !m->c->stabilisation.upstream && !Donated(m, f);
}

static void SharesOf(const Model *m, PetscInt p, const double out[OUT_COUNT], Shares *s)
{
  const FieldSet *fs = &m->c->fields;
  const double    c = m->conduct[p], dt = m->stage.dt;

  *s = (Shares){.S = {[TAKE_M] = out[OUT_M]}};
  for (int i = 0; fs->solid && i < CL_DIM; i++) {
    s->S[TAKE_A + i] = m->bc.ambient.on ? out[OUT_A + i] : 0.0;
    for (int d = 0; d < CL_DIM; d++)
      s->G[d][i] = out[VectorAt(OUT_P, i, d)];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    double *of = &s->S[TAKE_FLUID + FLUID_COUNT * f];

    if (!fs->phase[f])
      continue;
    s->S[TAKE_M + 1 + f] = out[OUT_M + 1 + f];
    s->S[TAKE_DM + f]    = out[OUT_DM + f];
    s->S[TAKE_ROOT + f]  = m->fluid && LayerRoot(m, f) ? c * m->P.f[P_V][p] * out[OUT_ROOT + f] : 0.0;
    of[FLUID_MI]         = c * out[OUT_MI + f];
    of[FLUID_MI2]        = c * of[FLUID_MI];
    of[FLUID_D]          = c * out[OUT_D + f];
    for (int d = 0; d < CL_DIM; d++) {
      of[FLUID_G + d]                    = c * out[VectorAt(OUT_G, f, d)];
      s->G[d][TAKE_MASS - TAKE_GRAD + f] = -dt * out[VectorAt(OUT_FLUX, f, d)];
    }
  }
  if (!fs->heat)
    return;
  s->S[TAKE_C]     = out[OUT_C];
  s->S[TAKE_C + 1] = out[OUT_Q];
  for (int d = 0; d < CL_DIM; d++)
    s->G[d][TAKE_HEAT - TAKE_GRAD] = out[OUT_HEAT + d];
}

/* Where motion has weights of its own: about an axis, over cells. */
static void ScatterMotion(Model *m, const Reach *r, const double out[OUT_COUNT], Shares *s)
{
  double mean = out[OUT_P];

  for (int d = 1; d < CL_DIM; d++)
    mean += out[VectorAt(OUT_P, d, d)];
  if (m->c->axisymmetric)
    mean += out[OUT_HOOP];

  for (int i = 0; i < CL_DIM; i++) {
    for (int a = 0; a < r->n; a++) {
      double *row = &m->take[TAKE_COUNT * r->node[a] + TAKE_GRAD + i], sum = r->M[a][0] * s->G[0][i];

      for (int d = 1; d < CL_DIM; d++)
        sum += r->M[a][d] * s->G[d][i];
      *row += sum;
      if (m->c->axisymmetric && i == 0)
        *row += r->K[a] * out[OUT_HOOP];
      if (m->c->mean_dilatation)
        *row += r->B[a][i] * mean;
    }
    for (int d = 0; d < CL_DIM; d++)
      s->G[d][i] = 0.0;
  }
}

/* What of a fluid has weights that differ from node to node: of gas (333), of its mobility (35). */
static void ScatterFluid(Model *m, PetscInt p, const Reach *r, int f, const double out[OUT_COUNT], Shares *s)
{
  double *of = &s->S[TAKE_FLUID + FLUID_COUNT * f];

  for (int a = 0; a < r->n; a++) {
    const PetscInt I    = r->node[a];
    double        *node = &m->take[TAKE_COUNT * I];

    if (m->fluid && !LayerRoot(m, f))
      node[TAKE_ROOT + f] += MobilityWeight(m, p, I, f, r->S[a]) * m->P.f[P_V][p] * out[OUT_ROOT + f];
    if (!Donated(m, f))
      continue;
    const double share = DonorShare(m, p, I);
    for (int k = 0; k < FLUID_COUNT; k++)
      node[TAKE_FLUID + FLUID_COUNT * f + k] += r->S[a] * share * (k == FLUID_MI2 ? share : 1.0) * of[k];
  }
  for (int k = 0; Donated(m, f) && k < FLUID_COUNT; k++)
    of[k] = 0.0;
}

/* Beds hold what of the skeleton's acceleration less gravity is across them (308). */
static void ScatterBeds(Model *m, PetscInt p, const Reach *r, const double *x, int f, const double out[OUT_COUNT])
{
  for (int a = 0; a < r->n; a++) {
    const PetscInt I      = r->node[a];
    const double   weight = r->S[a] * FlowWeight(m, p, I, f) / NodeShare(m, I, f) * out[OUT_MI + f];
    double         across[CL_DIM];

    BedsHold(m, p, I, x, across);
    for (int d = 0; d < CL_DIM; d++)
      m->take[TAKE_COUNT * I + TAKE_FLUID + FLUID_COUNT * f + FLUID_G + d] += weight * across[d];
  }
}

/* Adds the sum over the axes of g times the k-th Lanes of G; a vector that is returned has no place everywhere. */
static inline void LanesAlong(const double g[CL_DIM], const double G[CL_DIM][TAKE_COUNT - TAKE_GRAD], int k, Lanes *to)
{
  Lanes sum = g[0] * ((const Lanes *)G[0])[k];

  for (int d = 1; d < CL_DIM; d++)
    sum += g[d] * ((const Lanes *)G[d])[k];
  *to += sum;
}

static void Scatter(Model *m, PetscInt p, const Reach *r, const double *x, const double out[OUT_COUNT])
{
  const FieldSet *fs = &m->c->fields;
  Shares          s;

  SharesOf(m, p, out, &s);
  if (fs->solid && (m->c->axisymmetric || r->M != r->G))
    ScatterMotion(m, r, out, &s);
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (fs->phase[f] && m->beds)
      ScatterBeds(m, p, r, x, f, out);
    if (fs->phase[f] && !LayerRoot(m, f))
      ScatterFluid(m, p, r, f, out, &s);
  }
  const Lanes *S = (const Lanes *)s.S;
  for (int a = 0; a < r->n; a++) {
    Lanes *node = (Lanes *)&m->take[TAKE_COUNT * r->node[a]];

    for (int k = 0; k < TAKE_GRAD / LANES; k++)
      node[k] += r->S[a] * S[k];
    for (int k = 0; k < (TAKE_COUNT - TAKE_GRAD) / LANES; k++)
      LanesAlong(r->G[a], s.G, k, &node[TAKE_GRAD / LANES + k]);
  }
}

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

  *MassRow(m, f, I, ph) += take[TAKE_DM + ph] + take[TAKE_MASS + ph];
  Rate(m, I, x, PlaceV(fs, ph), rate); /* (310) */
  for (int i = 0; i < CL_DIM; i++)
    row[i] += share * (share * of[FLUID_MI2] * rate[i] - of[FLUID_MI] * m->bc.gravity[i] + of[FLUID_G + i]);
  if (at) {
    at->D += share * of[FLUID_D];
    at->root += (LayerRoot(m, ph) ? m->flow[I] : 1.0) * take[TAKE_ROOT + ph] / m->V[I];
    return;
  }
  DarcyFlux(m, I, ph, &x[I * fs->n], J);
  for (int i = 0; i < CL_DIM; i++)
    row[i] += share * of[FLUID_D] * J[i];
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
    Reach       r;
    PointState  state;
    PointOutput o;
    double      in[IN_COUNT];

    if (ParticleEvaluate(m, p, x, false, &r, in, &state, &o) != CL_OK)
      return;
    m->limited += state.limited;
    Scatter(m, p, &r, x, o.out);
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
  PetscCall(PetscArrayzero(m->take, m->map.n_local * TAKE_COUNT));
  PetscCall(ModelProjectGradients(m, m->x, false, m->proj));
  PetscCall(PlatesPosition(m, m->x));
  ModelGive(m, m->x);
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
