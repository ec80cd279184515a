/* End of a stage and of a step: the only place of the implicit integrators that writes history. */
#include "solver.h"

#define MAX_MOVE 0.5 /* cells per step */

static void Displacement(const Model *m, PetscInt p, const Reach *r, const double *x, double u[CL_DIM])
{
  const FieldSet *fs = &m->c->fields;

  for (int d = 0; d < CL_DIM; d++) {
    u[d] = 0.0;
    for (int a = 0; fs->solid && a < r->n; a++) {
      const PetscInt I = r->node[a];

      u[d] +=
          MotionWeight(m, p, r, a) * (m->stage.u_star[I * CL_DIM + d] + m->stage.dt * x[I * fs->n + PlaceVs(fs) + d]);
    }
  }
}

static void Velocity(const Model *m, PetscInt p, const double *x, double v[CL_DIM])
{
  const FieldSet *fs = &m->c->fields;
  Reach           r;

  for (int d = 0; d < CL_DIM; d++)
    v[d] = 0.0;
  if (!fs->solid)
    return;
  ReachExpand(m, p, &r);
  for (int a = 0; a < r.n; a++) {
    for (int d = 0; d < CL_DIM; d++)
      v[d] += r.S[a] * x[r.node[a] * fs->n + PlaceVs(fs) + d];
  }
}

const double *ModelStart(const Model *m)
{
  return m->x_n;
}

/* Without inertia the particle's own, of its last stage (313): what the nodes' mean of it differs by, a share of h^2,
   would pass for an error in time in steps however short. */
void ModelStartVelocity(const Model *m, double *v)
{
  const bool own = m->c->fields.solid && !m->c->fields.inertia;

  for (PetscInt p = 0; p < m->P.n; p++) {
    if (!own)
      Velocity(m, p, m->x_n, &v[CL_DIM * p]);
    for (int d = 0; own && d < CL_DIM; d++)
      v[CL_DIM * p + d] = m->P.f[P_VS + d][p];
  }
}

/* Cells that move with the body are never left. */
static void CheckMotion(Model *m, PetscInt p, const double u[CL_DIM])
{
  for (int d = 0; d < CL_DIM && !m->P.total; d++) {
    const GridLines *line = &m->grid.line[d];
    const double     to = m->P.f[P_X + d][p] + u[d], upper = LinesAt(line, line->cells);

    if (fabs(u[d]) > MAX_MOVE * LinesLeastAt(line, m->P.f[P_X + d][p]))
      ModelNoteFailure(m, CL_TOO_FAR, "a particle moves more than half a cell in one step", p);
    else if (!m->leaving.removes && (to < m->grid.lower[d] || to > upper))
      ModelNoteFailure(m, CL_LEFT_GRID, "a particle leaves the background grid", p);
  }
}

void ModelCountFace(const Scene *c, const Face *face, double weight, const FaceOutput *o, StageRates *rates)
{
  for (int ph = 0; ph < PHASE_COUNT; ph++)
    rates->out[ph] += weight * o->outflow[ph];
  rates->heat_in += weight * o->heat_in;
  rates->enthalpy_out += weight * o->enthalpy;
  for (PetscInt k = 0; k < c->nmeter; k++) {
    if (!(face->meters >> k & 1))
      continue;
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      rates->meter[k][METER_WATER + ph] += weight * o->outflow[ph];
    rates->meter[k][METER_HEAT] -= weight * o->heat_in;
    rates->acts[ACTS_METER + k] += weight * (fabs(o->outflow[PHASE_W]) + fabs(o->outflow[PHASE_G]) + fabs(o->heat_in));
  }
  for (int kind = BC_NONE + 1; kind < BC_FACES; kind++) {
    if (o->acts[kind])
      rates->acts[c->bc[face->bc[kind]].number] += weight;
  }
}

/* Heat that held temperatures give: what is left in their rows (21). */
static double HeldHeat(const Model *m)
{
  const FieldSet *fs  = &m->c->fields;
  double          sum = 0.0;

  for (PetscInt I = 0; fs->heat && I < m->map.n_owned; I++) {
    if ((m->mask[I] >> PlaceT(fs)) & 1u)
      sum += m->f[I * fs->n + PlaceT(fs)];
  }
  return sum;
}

static void BoundaryRates(const Model *m, const double *x, StageRates *rates)
{
  rates->heat_in += HeldHeat(m);
  for (PetscInt k = 0; k < m->nface; k++) {
    double     sum = 0.0;
    Reach      r;
    FaceOutput o;

    FaceAt(m, &m->face[k], x, &r, &o);
    for (int a = 0; a < r.n; a++)
      sum += m->face[k].N[a];
    ModelCountFace(m->c, &m->face[k], sum, &o, rates);
    if (m->c->fields.solid)
      FacePower(m, &m->face[k], &r, x, &o, rates->work);
  }
}

/* (277): what a particle stores, and hands from cell to cell. */
static void CountMoved(const Model *m, PetscInt p, const double out[OUT_COUNT], StageRates *rates)
{
  double h[CL_DIM];

  CellWidths(m, p, h);
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    if (m->c->fields.phase[ph])
      rates->moved[ph] += fabs(out[OUT_DM + ph]) / m->stage.dt;
    for (int d = 0; m->c->fields.phase[ph] && d < CL_DIM; d++)
      rates->moved[ph] += fabs(out[VectorAt(OUT_FLUX, ph, d)]) / h[d];
  }
}

static void CountLeft(const Model *m, StageRates *rates)
{
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    for (PetscInt I = 0; m->c->fields.phase[ph] && I < m->map.n_owned; I++)
      rates->left[ph] += fabs(*RowOf(m, m->f, I, F_PW + ph)) / m->stage.dt;
  }
}

/* (28): what is left in the mass rows goes back to the particles, to be found again in the next step. */
static PetscErrorCode KeepBalance(Model *m, double *masses)
{
  const FieldSet *fs = &m->c->fields;

  PetscFunctionBeginUser;
  if (!fs->fluid)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(NodeMapBroadcast(&m->map, m->f, fs->n));
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++) {
      const double share = r.S[a] * m->P.f[P_V][p] / m->V[r.node[a]];

      for (int ph = 0; ph < PHASE_COUNT; ph++) {
        if (fs->phase[ph])
          masses[TRIAL_MASSES * p + 1 + ph] -= share * *RowOf(m, m->f, r.node[a], F_PW + ph);
      }
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void HeatRates(const Model *m, const double *x, const ParticleResult *at, StageRates *rates)
{
  const FieldSet *fs  = &m->c->fields;
  const Reach    *r   = &at->r;
  const double   *out = at->o.out;

  rates->heat_source -= out[OUT_Q];
  rates->squeezed += at->state.squeezed;
  rates->beyond += LatentHeatBeyond(&ParticleMaterial(m, at->p)->latent, at->in[IN_T]) * at->state.gain / m->stage.dt;
  for (int a = 0; a < r->n; a++) {
    const PetscInt k = r->node[a] * fs->n + PlaceT(fs);

    rates->heat_rate += r->S[a] * out[OUT_C] * (x[k] - m->stage.x_star[k]) / m->stage.dt;
  }
}

static void PlasticState(PetscInt p, const SkeletonState *k, Trial *trial)
{
  trial->s[TRIAL_PLASTIC * p] = k->own[OWN_P_EPS];
  for (int c = 0; c < CL_TENSOR; c++)
    trial->s[TRIAL_PLASTIC * p + 1 + c] = k->sig[c];
}

PetscErrorCode ModelEndStage(Model *m, const double *x, Trial *trial, StageRates *rates, ClStatus *status)
{
  PetscFunctionBeginUser;
  *rates            = (StageRates){0};
  m->failure.status = CL_OK;
  ModelGive(m, x, false);
  for (PetscInt p = 0; p < m->P.n; p++) {
    ParticleResult    at;
    const PointState *s = &at.state;

    if (ParticleEvaluate(m, p, x, false, &at) != CL_OK)
      continue;
    Displacement(m, p, &at.r, x, &trial->u[CL_DIM * p]);
    Velocity(m, p, x, &trial->v[CL_DIM * p]);
    CheckMotion(m, p, &trial->u[CL_DIM * p]);
    for (int k = 0; k < 3; k++)
      trial->m[TRIAL_MASSES * p + k] = k == 0 ? s->m_h : k == 1 ? s->m_w : s->m_g;
    for (int k = 0; k < 3; k++)
      trial->y[TRIAL_SCALARS * p + k] = m->P.f[P_PW + k] ? at.in[IN_P + k] : 0.0;
    if (m->P.f[P_PG])
      trial->y[TRIAL_SCALARS * p + 1] = GasToBe(at.in[IN_P], at.in[IN_P + 1]);
    trial->y[TRIAL_SCALARS * p + 3] = s->Sh;
    if (trial->end)
      trial->end[p] = s->end;
    if (trial->s)
      PlasticState(p, &s->skeleton, trial);
    CountMoved(m, p, at.o.out, rates);
    if (m->c->fields.heat)
      HeatRates(m, x, &at, rates);
    if (m->c->fields.solid)
      ParticlePower(m, x, &at, rates->work);
  }
  CountLeft(m, rates);
  PetscCall(KeepBalance(m, trial->m));
  BoundaryRates(m, x, rates);
  if (m->c->fields.solid) {
    rates->work[WORK_PLATES] += HeldPower(m);
    rates->work[WORK_DAMPING] += GhostPower(m, x);
    rates->work[WORK_DRAG] += DragPower(m, x);
  }
  PetscCall(PlatesReport(m, x));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, rates, sizeof(*rates) / sizeof(double), MPI_DOUBLE, MPI_SUM, m->grid.comm));
  m->rates = *rates;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &m->limited, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  PetscCall(ModelReduceStatus(m, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Gradient at the particle's own place of what its nodes have moved in the stage, where they stand for it in (88) and
   (160), too. */
static void OwnGradient(const Model *m, const Reach *r, const double *x, double H[CL_DIM][CL_DIM])
{
  const FieldSet *fs = &m->c->fields;

  memset(H, 0, sizeof(double[CL_DIM][CL_DIM]));
  for (int a = 0; fs->solid && a < r->n; a++) {
    const PetscInt I = r->node[a];

    for (int i = 0; i < CL_DIM; i++) {
      const double u = m->stage.u_star[I * CL_DIM + i] + m->stage.dt * x[I * fs->n + PlaceVs(fs) + i];

      for (int j = 0; j < CL_DIM; j++)
        H[i][j] += u * r->G[a][j];
    }
  }
}

/* The gradient of the velocity, by which the next step carries it to its nodes (451). */
static void WriteVelocityGradient(Model *m, PetscInt p, const double *x, const Reach *r)
{
  const FieldSet *fs = &m->c->fields;

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      double sum = 0.0;

      for (int a = 0; a < r->n; a++)
        sum += x[r->node[a] * fs->n + PlaceVs(fs) + i] * r->G[a][j];
      m->P.f[VectorAt(P_GV, i, j)][p] = sum;
    }
  }
}

/* Position, size, stress. */
static void WriteMotion(Model *m, PetscInt p, const double *x, const Reach *r, const PointState *s)
{
  double *const *f = m->P.f;
  double         u[CL_DIM];

  Displacement(m, p, r, x, u);
  const double   log_J  = log(s->V / f[P_V][p]);
  const bool     grows  = m->c->basis == BASIS_CPGIMP;
  ParticleMotion motion = {.log_J = &log_J};
  double         H[CL_DIM][CL_DIM], stretch[CL_DIM];

  OwnGradient(m, r, x, H);
  for (int i = 0; i < CL_DIM; i++) {
    stretch[i]        = s->stretch[i] - (s->F[i][i] - 1.0 - H[i][i]);
    motion.u[i]       = &u[i];
    motion.stretch[i] = grows ? &stretch[i] : NULL;
    for (int j = 0; j < CL_DIM; j++)
      motion.H[i][j] = &H[i][j];
  }
  ParticlesKeep(&m->P, p, 1, &motion);
  f[P_V][p] = s->V;

  const SkeletonStore store = ParticlesSkeleton(&m->P, 0, 0.0);
  SkeletonKeep(&store, p, &s->skeleton);
}

/* Of a node's velocity at place k of its block: what it has more than `from` of what it had. */
static double Change(const Model *m, const double *x, double from, PetscInt I, int k)
{
  const PetscInt q = I * m->c->fields.n + k;

  return x[q] - from * m->x_n[q];
}

/* FLIP: velocities of skeleton, water, gas; fluids slip by the particle's own share of the flow (313). Without inertia
   velocities have no memory: those of the nodes (355). */
static void WriteVelocities(Model *m, PetscInt p, const double *x, const Reach *r)
{
  const FieldSet *fs   = &m->c->fields;
  const double    from = fs->inertia ? 1.0 : 0.0;

  double dv_s[CL_DIM] = {0.0};

  for (int a = 0; fs->solid && a < r->n; a++) {
    for (int d = 0; d < CL_DIM; d++)
      dv_s[d] += r->S[a] * Change(m, x, from, r->node[a], PlaceVs(fs) + d);
  }
  for (int d = 0; fs->solid && d < CL_DIM; d++)
    m->P.f[P_VS + d][p] = from * m->P.f[P_VS + d][p] + dv_s[d];
  for (int f = 0; f < PHASE_COUNT; f++) {
    double slip[CL_DIM] = {0.0};

    if (!fs->phase[f])
      continue;
    for (int a = 0; a < r->n; a++) {
      const PetscInt I = r->node[a];
      double         at[CL_DIM];

      for (int d = 0; d < CL_DIM; d++)
        at[d] = Change(m, x, from, I, PlaceV(fs, f) + d) - (fs->solid ? Change(m, x, from, I, PlaceVs(fs) + d) : 0.0);
      ShareOut(m, I, at);
      for (int d = 0; d < CL_DIM; d++)
        slip[d] += r->S[a] * FlowWeight(m, p, I, f) * at[d];
    }
    Drive(m, p, slip);
    for (int d = 0; d < CL_DIM; d++) {
      double *v = &m->P.f[VectorAt(P_VW, f, d)][p];

      *v = from * *v + dv_s[d] + slip[d];
    }
  }
}

/* Elastic energy that went with the stiffness in this step. */
static double Released(const Model *m, PetscInt p, const PointState *s)
{
  const Elasticity   *el    = &ParticleMaterial(m, p)->elasticity;
  const SkeletonStore store = ParticlesSkeleton(&m->P, 0, 0.0);
  const double        old   = m->P.f[P_MH][p];
  SkeletonHistory     h;
  double              dE;

  SkeletonTake(&store, p, &h);
  return s->V * SkeletonReleased(el, ElasticityYoung(el, m->P.f[P_SH][p], &dE), ElasticityYoung(el, s->Sh, &dE),
                                 s->m_h < old ? s->m_h / old : 1.0, &h);
}

/* Mixed derivative q of T (395), (446) along the axes of the grid's configuration. */
static double MixedDerivative(const Model *m, PetscInt p, const Reach *r, const double *x, int q)
{
  const FieldSet *fs   = &m->c->fields;
  const Axis     *axis = m->stencil[p].axis;
  double          b    = 0.0;

  for (int a = 0; a < r->n; a++) {
    const PetscInt *ij = m->map.ij[r->node[a]];

    double w = x[r->node[a] * fs->n + PlaceT(fs)];

    for (int d = 0; d < CL_DIM; d++) {
      const PetscInt k = ij[d] - axis[d].base;

      w *= cl_mixed[q][d] ? axis[d].dS[k] : axis[d].S[k];
    }
    b += w;
  }
  return b;
}

/* (395), (446) on the configuration at t_n. */
static void WriteMixed(Model *m, PetscInt p, const double *x, const Reach *r)
{
  double B[CL_MIXED], A[CL_DIM][CL_DIM];

  for (int k = 0; k < CL_MIXED; k++)
    B[k] = MixedDerivative(m, p, r, x, k);
  if (m->P.total) {
    ParticleInverse(&m->P, p, A);
    MixedCarry(A, B);
  }
  for (int k = 0; k < CL_MIXED; k++)
    m->P.f[P_BT + k][p] = B[k];
}

static void WriteHistory(Model *m, PetscInt p, const double *x, const Reach *r, const double in[IN_COUNT],
                         const PointState *s)
{
  const FieldSet *fs = &m->c->fields;
  double *const  *f  = m->P.f;

  WriteVelocities(m, p, x, r);
  for (int k = 0; k < 3; k++) { /* p_w, p_g, T */
    if (!f[P_PW + k])
      continue;
    f[P_PW + k][p] = in[IN_P + k] + (m->added->exchange && k < PHASE_COUNT ? m->added->exchange[p].change : 0.0);
    for (int d = 0; d < CL_DIM; d++)
      f[VectorAt(P_GW, k, d)][p] = in[k < PHASE_COUNT ? VectorAt(IN_GP, k, d) : IN_GT + d];
  }
  if (fs->heat)
    WriteMixed(m, p, x, r);
  if (fs->solid) {
    WriteVelocityGradient(m, p, x, r);
    WriteMotion(m, p, x, r, s);
  } else {
    ParticlesKeep(&m->P, p, 1, NULL);
  }
  f[P_MH][p]  = s->m_h;
  f[P_SH][p]  = s->Sh;
  f[P_PHI][p] = s->phi;
  if (fs->phase[PHASE_W]) {
    f[P_MW][p] = s->m_w;
    f[P_SW][p] = s->Sw;
  }
  if (fs->phase[PHASE_G])
    f[P_MG][p] = s->m_g;
}

PetscErrorCode ModelCommit(Model *m, const double *x, const Trial *trial, const double *rates, double unseen)
{
  const Transfer at_start = {.grid = &m->grid, .map = &m->map, .n = m->P.n, .stencil = m->stencil};
  PetscInt       left;

  PetscFunctionBeginUser;
  PetscCall(ModelProjectGradients(m, x, false, m->proj));
  PetscCall(ExchangeBuild(m));
  PetscCall(ReducedRest(m->solver->reduced));
  ModelGive(m, x, false);
  m->released = 0.0;
  for (PetscInt p = 0; p < m->P.n; p++) {
    ParticleResult at;
    PointState    *s = &at.state;

    PetscCheck(ParticleEvaluate(m, p, x, false, &at) == CL_OK, PETSC_COMM_SELF, PETSC_ERR_PLIB,
               "an accepted state is not admissible");
    for (int k = 0; m->P.f[P_RATE] && k < 4; k++)
      m->P.f[P_RATE + k][p] = rates[TRIAL_SCALARS * p + k];
    s->m_w = trial->m[TRIAL_MASSES * p + 1];
    s->m_g = trial->m[TRIAL_MASSES * p + 2];
    if (trial->s) {
      m->P.f[P_WP][p] += trial->end[p].work;
      m->P.f[P_HEAT][p] = 0.0; /* the stages gave it */
      for (int k = 0; k < TRIAL_PLASTIC; k++)
        m->P.f[P_KP + k][p] = trial->k[TRIAL_PLASTIC * p + k];
    }
    if (m->c->fields.solid)
      m->released += Released(m, p, s);
    WriteHistory(m, p, x, &at.r, at.in, s);
  }
  if (unseen > 0.0)
    PetscCall(TransferUnseen(&at_start, &m->c->fields, unseen, &m->P));
  PetscCall(ModelTakeOut(m, m->stage.t));
  PetscCall(ParticlesMigrate(&m->grid, &m->P, &left));
  PetscCheck(left == 0, m->grid.comm, PETSC_ERR_PLIB, "an accepted step moved particles out of the grid");
  PetscCall(ParticlesNonlocal(m->c, &m->grid, m->stage.ahead, &m->P));
  PetscFunctionReturn(PETSC_SUCCESS);
}
