/* Life of the explicit integrator, order of the particles, and one step as a table of contents. */
#include "lanes.h"

static const char *const part[STEP_PARTS] = {"ClExDeposit", "ClExVelocities", "ClExRates",
                                             "ClExScalars", "ClExUpdate",     "ClExOrder"};

/* Do layers share a node's flow (350)?  Not in the bare form, which is the paper's. */
static int Layers(const Explicit *e)
{
  return SceneSharesFlow(e->m->c) && !e->o.paper;
}

PetscErrorCode ExplicitCreate(Model *m, const ExplicitOptions *o, Explicit **out)
{
  const FieldSet *fs = &m->c->fields;
  Explicit       *e;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&e));
  e->m   = m;
  e->o   = *o;
  e->set = (Set){fs->solid, fs->phase[PHASE_W] + fs->phase[PHASE_G], fs->heat, Layers(e)};
  *out   = e;

  for (int d = 0; d < CL_DIM && SceneHasLongCells(m->c) && !o->paper; d++) {
    const GridLines *along = &m->grid.line[d], *across = &m->grid.line[(d + 1) % CL_DIM];

    e->long_cells = e->long_cells || PetscSqr(LinesWidest(along)) > 2.0 * PetscSqr(across->h);
  }
  e->straight = INFINITY;
  for (PetscInt k = 0; k < m->c->nmaterial && m->c->material[k].gas.trace > 0.0; k++)
    e->straight = PetscMin(e->straight, STRAIGHT * m->c->material[k].retention.p0);
  for (int k = 0; k < STEP_PARTS; k++)
    PetscCall(PetscLogEventRegister(part[k], PETSC_OBJECT_CLASSID, &e->event[k]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeParticles(Explicit *e)
{
  PetscFunctionBeginUser;
  for (int k = 0; k < T_COUNT; k++)
    PetscCall(PetscFree(e->t[k]));
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(PetscFree(e->base[d]));
  PetscCall(PetscFree2(e->order, e->key));
  PetscCall(PetscFree(e->beds));
  e->cap = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExplicitDestroy(Explicit **out)
{
  Explicit *e = *out;

  PetscFunctionBeginUser;
  if (!e)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeParticles(e));
  PetscCall(NodeMapDestroy(&e->map));
  PetscCall(PetscFree(e->raw));
  PetscCall(PetscFree(e->alternates));
  PetscCall(PetscFree7(e->inc, e->gain, e->link, e->lean, e->torn, e->node, e->slot));
  PetscCall(PetscFree3(e->held, e->mask, e->fixed));
  PetscCall(PetscFree(e->face));
  PetscCall(PetscFree(e->pull));
  PetscCall(PetscFree3(e->spring, e->answer, e->push));
  PetscCall(PetscFree4(e->cell, e->mean, e->swell, e->part));
  PetscCall(PetscFree(e));
  *out = NULL;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Is this work array of use? */
static bool Needs(const Explicit *e, int k)
{
  const Set s = e->set;

  if (k == T_T)
    return !s.heat;
  if (k == T_CONDUCT)
    return s.layers;
  if (k == T_WARM || k == T_WARM + 1)
    return e->m->c->compression_heat;
  if (k == T_CONSISTENT)
    return Corrects(e);
  if (k == T_V)
    return Scalars(s) > 0;
  if (k >= T_MISS)
    return e->o.paper && s.fluids > 0;
  if (k == T_SG || k == T_DS || k == T_GAS || k == T_GAS + 1 || k == T_HELD || k >= T_GAIN)
    return s.fluids == 2;
  return s.fluids > 0; /* those of the gas, too: few, and the pointers stay simple */
}

static PetscErrorCode SizeParticles(Explicit *e)
{
  const PetscInt n = e->m->P.cap;

  PetscFunctionBeginUser;
  if (n <= e->cap)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(FreeParticles(e));
  for (int k = 0; k < T_COUNT; k++) {
    if (Needs(e, k))
      PetscCall(PetscCalloc1(n, &e->t[k]));
  }
  for (int d = 0; d < CL_DIM; d++)
    PetscCall(PetscMalloc1(n, &e->base[d]));
  PetscCall(PetscMalloc2(n, &e->order, n, &e->key));
  if (e->set.layers)
    PetscCall(PetscMalloc1(n, &e->beds));
  e->cap = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* First nodes of all particles; notes whether one is new, or belongs to another rank's cell. */
static void Look(Explicit *e)
{
  const Model *m = e->m;

  for (int d = 0; d < CL_DIM; d++) {
    const Grid      *g    = &m->grid;
    const GridLines *line = &g->line[d];
    const double     h = line->h, lower = line->lower, cells = (double)line->cells, first = (double)g->xs[d];
    const double     end     = (double)(g->xs[d] + g->xm[d]) + (g->xs[d] + g->xm[d] > g->cells[d] ? 1.0 : 0.0);
    const bool       linear  = m->c->basis == BASIS_LINEAR;
    const double *restrict x = m->P.f[P_X + d], *restrict l = m->P.f[P_L + d];
    int *restrict base = e->base[d];
    int changed = 0, strays = 0;

    for (PetscInt p = 0; p < m->P.n; p++) {
      const double s   = LinesPlace(line, x[p]);
      const double lo  = linear    ? BasisSnap(s)
                         : line->x ? BasisSpanOf(m->c->basis, line, x[p], l[p]).lo
                                   : BasisDomainOf(m->c->basis, x[p], l[p], lower, h, cells).lo;
      const int    now = (int)floor(lo);

      changed |= now != base[p];
      strays |= (s < first) | (s >= end);
      base[p] = now;
    }
    e->stale  = e->stale || changed;
    e->strays = e->strays || strays;
  }
}

/* ---------------------------------------------------------------- order of the particles: by cell, then by id */
static PetscErrorCode Permute(Explicit *e)
{
  Particles *P = &e->m->P;
  double    *copy;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc1(P->n, &copy));
  for (int k = 0; k < P_COUNT; k++) {
    if (!P->f[k])
      continue;
    for (PetscInt p = 0; p < P->n; p++)
      copy[p] = P->f[k][e->order[p]];
    PetscCall(PetscArraycpy(P->f[k], copy, P->n));
  }
  PetscInt *whole = (PetscInt *)copy;
  for (int k = 0; k < PI_COUNT; k++) {
    for (PetscInt p = 0; p < P->n; p++)
      whole[p] = P->i[k][e->order[p]];
    PetscCall(PetscArraycpy(P->i[k], whole, P->n));
  }
  PetscCall(PetscFree(copy));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Sort(Explicit *e)
{
  const Grid *g      = &e->m->grid;
  Particles  *P      = &e->m->P;
  bool        sorted = true;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; p < P->n; p++) {
    double   x[CL_DIM];
    PetscInt cell[CL_DIM];

    ParticlePlace(P, p, x);
    if (!GridCell(g, x, cell))
      PetscCall(PetscArrayzero(cell, CL_DIM));
    e->order[p] = P->i[PI_ID][p];
    e->key[p]   = GridPadded(g, cell);
    sorted      = sorted &&
             (p == 0 || e->key[p] > e->key[p - 1] || (e->key[p] == e->key[p - 1] && e->order[p] > e->order[p - 1]));
  }
  if (sorted)
    PetscFunctionReturn(PETSC_SUCCESS);

  PetscInt *rank; /* particles by id, then stably by cell */
  PetscCall(PetscMalloc1(P->n, &rank));
  for (PetscInt p = 0; p < P->n; p++)
    rank[p] = p;
  PetscCall(PetscSortIntWithArray(P->n, e->order, rank));
  PetscInt *at, cells = GridPaddedSize(g);
  PetscCall(PetscCalloc1(cells + 1, &at));
  for (PetscInt p = 0; p < P->n; p++)
    at[e->key[p] + 1]++;
  for (PetscInt k = 0; k < cells; k++)
    at[k + 1] += at[k];
  for (PetscInt p = 0; p < P->n; p++)
    e->order[at[e->key[rank[p]]]++] = rank[p];
  PetscCall(PetscFree(at));
  PetscCall(PetscFree(rank));
  PetscCall(Permute(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- steps */
static PetscErrorCode Ready(Explicit *e)
{
  PetscFunctionBeginUser;
  if (Layers(e) != e->set.layers) { /* a stage may bring other materials */
    e->resize     = true;
    e->set.layers = Layers(e);
    PetscCall(FreeParticles(e));
  }
  PetscCall(SizeParticles(e));
  PetscCall(Sort(e));
  for (PetscInt p = 0; e->t[T_T] && p < e->m->P.n; p++)
    e->t[T_T][p] = e->m->c->region[e->m->P.i[PI_REGION][p]].temperature;
  e->strays = false;
  Look(e);
  e->stale = true;
  PetscCall(FacesBegin(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sum of squares of the forces that act: of the stresses over a cell, and of weight. */
static PetscErrorCode ActingForces(Explicit *e)
{
  const Model *m   = e->m;
  double       sum = 0.0;

  PetscFunctionBeginUser;
  for (PetscInt p = 0; e->set.solid && p < m->P.n; p++) {
    double       h    = INFINITY;
    const double pore = e->set.fluids ? m->P.f[P_PW][p] : 0.0, mass = m->P.f[P_MS][p] + m->P.f[P_MH][p];

    for (int d = 0; d < CL_DIM; d++)
      h = fmin(h, LinesWidthAt(&m->grid.line[d], m->P.f[P_X + d][p]));
    for (int d = 0; d < CL_DIM; d++)
      sum += PetscSqr(m->P.f[P_V][p] / h * (m->P.f[P_SIG + d][p] - pore)) + PetscSqr(mass * m->c->gravity[d]);
  }
  PetscCallMPI(MPI_Allreduce(&sum, &e->acting, 1, MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExplicitBegin(Explicit *e, Unseen unseen, ClStatus *status)
{
  PetscFunctionBeginUser;
  ModelClearFailure(e->m);
  e->ahead  = 0.0;
  e->unseen = unseen;
  PetscCall(Ready(e));
  if (e->o.mass_scaling > 1.0)
    PetscCall(ActingForces(e));
  PetscCall(ModelReduceStatus(e->m, status));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Agreement of all ranks on how the step went, and what follows from where the particles are now. */
static PetscErrorCode Agree(Explicit *e, double t, ClStatus *status)
{
  Model   *m       = e->m;
  int      flag[4] = {ModelFailure(m)->status != CL_OK, e->stale, e->strays, e->gone};
  PetscInt left;

  PetscFunctionBeginUser;
  *status = ModelFailure(m)->status;
  if (m->grid.size > 1) {
    PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, flag, 4, MPI_INT, MPI_MAX, m->grid.comm));
    if (flag[0])
      PetscCall(ModelReduceStatus(m, status));
  }
  e->stale  = flag[1];
  e->strays = flag[2];
  if (*status != CL_OK || !(flag[3] || (e->strays && m->grid.size > 1)))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(ModelTakeOut(m, t));
  PetscCall(ParticlesMigrate(&m->grid, &m->P, &left));
  PetscCheck(left == 0, m->grid.comm, PETSC_ERR_PLIB, "an accepted step moved particles out of the grid");
  PetscCall(ModelBalance(m));
  PetscCall(Ready(e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums of the particles at their nodes, and the velocities that follow. */
static PetscErrorCode Momentum(Explicit *e, double t, double dt)
{
  const int width = LANES * Rows(A_Count(e->set));

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(e->event[STEP_DEPOSIT], 0, 0, 0, 0));
  PetscCall(PetscArrayzero(e->A, e->rows * width));
  if (TakesCellMean(e)) {
    PetscCall(PetscArrayzero(e->cell, e->rows * CELL_MEAN));
    if (e->m->c->mean_strain > 0.0)
      PetscCall(PetscArrayzero(e->part, e->rows));
  }
  if (e->set.layers)
    PetscCall(ParticlesDrive(e->m->c, &e->m->grid, &e->map, &e->m->P, e->beds));
  Deposit(e);
  PetscCall(CellsForces(e));
  PetscCall(PetscLogEventEnd(e->event[STEP_DEPOSIT], 0, 0, 0, 0));
  PetscCall(PetscLogEventBegin(e->event[STEP_VELOCITIES], 0, 0, 0, 0));
  PetscCall(PlatesStart(e));
  FacesForces(e, dt);
  PetscCall(NodeMapSum(&e->map, e->A, width));
  PetscCall(NodesPrepare(e));
  if (e->m->plates)
    PetscCall(PlatesForces(e, t, dt));
  NodesExtend(e, dt);
  PetscCall(NodesVelocities(e, dt));
  CellsMotion(e);
  FacesWork(e, dt);
  PetscCall(PetscLogEventEnd(e->event[STEP_VELOCITIES], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Masses and heat with those velocities, and the pressures and temperature that follow. */
static PetscErrorCode MassAndHeat(Explicit *e, double dt, StageRates *sum)
{
  const int width = LANES * Rows(R_Count(e->set));

  PetscFunctionBeginUser;
  if (!Scalars(e->set))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscLogEventBegin(e->event[STEP_RATES], 0, 0, 0, 0));
  PetscCall(PetscArrayzero(e->R, e->rows * width));
  PetscCall(HeatAlternation(e));
  Rates(e, dt);
  PetscCall(PetscLogEventEnd(e->event[STEP_RATES], 0, 0, 0, 0));
  PetscCall(PetscLogEventBegin(e->event[STEP_SCALARS], 0, 0, 0, 0));
  FacesRates(e, dt, sum);
  PetscCall(NodeMapSum(&e->map, e->R, width));
  PetscCall(NodesScalars(e, sum));
  PetscCall(PetscLogEventEnd(e->event[STEP_SCALARS], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExplicitStep(Explicit *e, double t, double dt, StageRates *sum, ClStatus *status)
{
  Model *m = e->m;

  PetscFunctionBeginUser;
  ModelClearFailure(m);
  e->latent = e->advected = e->squeezed = e->beyond = 0.0;
  e->ahead += dt;
  PetscCall(PetscArrayzero(e->work, WORK_RATES));
  BcValuesEvaluate(m->c, t + dt, &m->bc);
  if (e->stale)
    PetscCall(NodesRebuild(e));
  PetscCall(LoseUnseen(e));
  e->stale = e->strays = e->gone = false;
  PetscCall(Momentum(e, t + dt, dt));
  PetscCall(MassAndHeat(e, dt, sum));
  PetscCall(PetscLogEventBegin(e->event[STEP_UPDATE], 0, 0, 0, 0));
  Update(e, dt);
  PetscCall(PetscLogEventEnd(e->event[STEP_UPDATE], 0, 0, 0, 0));
  sum->heat_source += e->latent - e->advected + e->squeezed;
  sum->squeezed += e->squeezed;
  sum->beyond += e->beyond;
  for (int k = 0; k < WORK_RATES; k++)
    sum->work[k] += e->work[k];
  PetscCall(PetscLogEventBegin(e->event[STEP_ORDER], 0, 0, 0, 0));
  e->unseen.time += dt;
  e->unseen.steps++;
  Look(e);
  PetscCall(Agree(e, t + dt, status));
  PetscCall(PetscLogEventEnd(e->event[STEP_ORDER], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ExplicitEnd(Explicit *e)
{
  Particles *P = &e->m->P;

  PetscFunctionBeginUser;
  PetscCall(PlatesEnd(e));
  PetscCall(ParticlesNonlocal(e->m->c, &e->m->grid, e->ahead, P));
  for (PetscInt p = 0; p < P->n; p++) {
    PointProperties q;
    const char     *why;

    if (ModelParticleProperties(e->m, p, &q, &why) != CL_OK)
      continue; /* the next step will say why */
    P->f[P_PHI][p] = q.phi;
    P->f[P_SH][p]  = q.Sh;
    if (e->set.fluids)
      P->f[P_SW][p] = (1.0 - q.Sh) * q.s[PHASE_W];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

double ExplicitMassScalingError(const Explicit *e)
{
  return e->worst_scaling;
}

double ExplicitBytesPerParticle(const Explicit *e)
{
  double bytes = (PI_COUNT + 2) * sizeof(PetscInt) + CL_DIM * sizeof(int); /* with what sorts them */

  for (int k = 0; k < P_COUNT; k++)
    bytes += e->m->P.f[k] ? sizeof(double) : 0;
  for (int k = 0; k < T_COUNT; k++)
    bytes += e->t[k] ? sizeof(double) : 0;
  bytes += e->beds ? sizeof(*e->beds) : 0;
  return bytes;
}
