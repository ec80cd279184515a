/* The Jacobian from particles and faces: assembled as J2 with all unknowns, and as what (170) leaves when the fluid
   velocities are eliminated; or only their tangents kept for products (product.c). */
#include "solver.h"

/* Nodal factors that multiply a particle's outputs: accelerations, Darcy fluxes, temperature rate, weights of drag. */
typedef struct {
  double acc[1 + PHASE_COUNT][CL_DIM], own[PHASE_COUNT][CL_DIM], J[PHASE_COUNT][CL_DIM], Tdot; /* own: in (16), (310) */
  double kr[PHASE_COUNT];                                                                      /* of the node (108) */
  double flow[PHASE_COUNT], share[PHASE_COUNT]; /* (350), (333), and without S */
  double rise[PHASE_COUNT][CL_DIM];             /* d row (16)/d sqrt(k_r) of the particle, N; of two fluids */
} NodeFactors;

static void Factors(const Model *m, PetscInt p, PetscInt I, const double *x, double S, NodeFactors *n)
{
  const FieldSet *fs = &m->c->fields;

  if (fs->solid)
    Acceleration(m, I, x, PlaceVs(fs), 1.0, n->acc[0]);
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    Acceleration(m, I, x, PlaceV(fs, f), 1.0, n->acc[1 + f]);
    FluidAcceleration(m, p, I, x, f, n->own[f]);
    DarcyFlux(m, I, f, &x[I * fs->n], n->J[f]);
    n->share[f] = FlowWeight(m, p, I, f);
    n->flow[f]  = S * n->share[f];
    n->kr[f]    = 1.0;
    if (!m->fluid)
      continue;
    const FluidNode *at = &m->fluid[PHASE_COUNT * I + f];

    n->kr[f] = at->root * at->root;
    for (int i = 0; i < CL_DIM; i++)
      n->rise[f][i] = 2.0 * at->root * MobilityShare(m, p, I, f, S) * at->F[i];
  }
  if (fs->heat) {
    const PetscInt k = I * fs->n + PlaceT(fs);

    n->Tdot = (x[k] - m->stage.x_star[k]) / m->stage.dt;
  }
}

/* Of a particle's outputs in the unknowns of its nodes, so many in all. */
typedef struct {
  const double (*of)[ROW_MOST]; /* [OUT_COUNT] */
  int length;
} OutputSlopes;

/* Adds `expression` of node a, of each of them, times the slopes DB of an output to a row. */
#define TERM(output, expression)                                                                                       \
  do {                                                                                                                 \
    double *factor = RowSumAdd(&sum, DB->of[output]);                                                                  \
    for (int a = 0; a < r->n; a++)                                                                                     \
      factor[a] = (expression);                                                                                        \
  } while (0)

/* Where row k of a particle's nodes stands. */
static void RowOfNodes(Patch *patch, int k, int n, double *row[CL_NODES])
{
  for (int a = 0; a < n; a++)
    row[a] = patch->v[a][k];
}

/* Rows of the nodes against the slopes DB of the outputs in the unknowns of all of them. */
static void SolidRows(const Model *m, const Assembly *to, const Reach *r, const NodeFactors *k, const OutputSlopes *DB,
                      Patch *patch)
{
  const double *S = r->S;
  RowSum        sum;
  double       *row[CL_NODES];

  for (int i = 0; i < CL_DIM; i++) {
    sum.n = 0;
    for (int j = 0; j < CL_DIM; j++)
      TERM(VectorAt(OUT_P, i, j), r->M[a][j]);
    TERM(OUT_M, S[a] * k[a].acc[0][i]);
    for (int f = 0; f < PHASE_COUNT; f++) {
      if (to->fs.phase[f])
        TERM(OUT_M + 1 + f, S[a] * k[a].acc[1 + f][i]);
    }
    if (to->force)
      TERM(OUT_A + i, S[a]);
    if (m->c->axisymmetric && i == 0)
      TERM(OUT_HOOP, r->K[a]);
    if (m->cell) {
      for (int d = 0; d < CL_DIM; d++)
        TERM(VectorAt(OUT_P, d, d), r->B[a][i]);
      if (SceneStrainsAcross(m->c))
        TERM(OUT_HOOP, r->B[a][i]);
    }
    RowOfNodes(patch, PlaceVs(&to->fs) + i, r->n, row);
    RowSumInto(&sum, r->n, DB->length, patch->fresh, row);
  }
}

static void MassRows(const Model *m, const Assembly *to, const Reach *r, const OutputSlopes *DB, Patch *patch)
{
  const FieldSet *fs = &to->fs;
  const double   *S = r->S, dt = m->stage.dt;
  RowSum          sum = {.n = 0};
  double         *row[CL_NODES];

  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    TERM(OUT_DM + f, S[a]);
    for (int j = 0; j < CL_DIM; j++)
      TERM(VectorAt(OUT_FLUX, f, j), -dt * r->G[a][j]);
    RowOfNodes(patch, PlaceP(fs, f), r->n, row);
    RowSumInto(&sum, r->n, DB->length, patch->fresh, row);
    sum.n = 0;
  }
}

static void MomentumRows(const Model *m, const Assembly *to, const Reach *r, int f, const NodeFactors *k,
                         const OutputSlopes *DB, Patch *patch)
{
  RowSum  sum;
  double *row[CL_NODES];

  for (int i = 0; i < CL_DIM; i++) {
    sum.n = 0;
    TERM(OUT_MI + f, k[a].flow[f] * k[a].kr[f] * k[a].own[f][i]);
    TERM(VectorAt(OUT_G, f, i), k[a].flow[f] * k[a].kr[f]);
    TERM(OUT_D + f, k[a].flow[f] * k[a].J[f][i]);
    if (m->fluid)
      TERM(OUT_ROOT + f, k[a].rise[f][i]);
    RowOfNodes(patch, PlaceV(&to->fs, f) + i, r->n, row);
    RowSumInto(&sum, r->n, DB->length, patch->fresh, row);
  }
}

static void HeatRows(const Assembly *to, const Reach *r, const NodeFactors *k, const OutputSlopes *DB, Patch *patch)
{
  const double *S   = r->S;
  RowSum        sum = {.n = 0};
  double       *row[CL_NODES];

  TERM(OUT_C, S[a] * k[a].Tdot);
  TERM(OUT_Q, S[a]);
  for (int j = 0; j < CL_DIM; j++)
    TERM(OUT_HEAT + j, r->G[a][j]);
  RowOfNodes(patch, PlaceT(&to->fs), r->n, row);
  RowSumInto(&sum, r->n, DB->length, patch->fresh, row);
}

static void NodeRows(const Model *m, const Assembly *to, const Reach *r, const NodeFactors *k, const OutputSlopes *DB,
                     Patch *patch)
{
  const FieldSet *fs = &to->fs;

  if (fs->solid)
    SolidRows(m, to, r, k, DB, patch);
  MassRows(m, to, r, DB, patch);
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (fs->phase[f] && PlaceV(fs, f) >= 0)
      MomentumRows(m, to, r, f, k, DB, patch);
  }
  if (fs->heat)
    HeatRows(to, r, k, DB, patch);
  patch->fresh = false;
}

/* The lumped terms couple a node only with itself.  Eliminated fluids move with the skeleton as far as drag holds them
   (173). */
static void Diagonal(const FieldSet *fs, const double out[OUT_COUNT], const NodeFactors *k, double dt, double S,
                     const double *w, double *block)
{
  const double inertia = fs->inertia ? S / dt : 0.0, per_dt = fs->inertia ? 1.0 / dt : 0.0;

  for (int i = 0; i < CL_DIM; i++) {
    const int vs = PlaceVs(fs) + i;

    if (fs->solid)
      block[vs * ROW_MOST + vs] += inertia * out[OUT_M];
    for (int f = 0; f < PHASE_COUNT; f++) {
      const int v = PlaceV(fs, f) + i;

      if (!fs->phase[f])
        continue;
      const double drag = k->flow[f] * out[OUT_D + f] * w[f],
                   mass = per_dt * k->flow[f] * k->share[f] * k->kr[f] * out[OUT_MI + f];

      if (PlaceV(fs, f) < 0) {
        if (fs->solid && drag > 0.0)
          block[vs * ROW_MOST + vs] += inertia * out[OUT_M + 1 + f] * drag / (drag + mass);
        continue;
      }
      block[v * ROW_MOST + v] += mass + drag;
      if (!fs->solid)
        continue;
      block[v * ROW_MOST + vs] -= drag;
      block[vs * ROW_MOST + v] += inertia * out[OUT_M + 1 + f];
    }
  }
  if (fs->heat)
    block[PlaceT(fs) * ROW_MOST + PlaceT(fs)] += S * out[OUT_C] / dt;
}

/* The skeleton's acceleration in (308). */
static void DiagonalBeds(const FieldSet *fs, const Beds *A, const double out[OUT_COUNT], const NodeFactors *k,
                         double dt, double *block)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f] || PlaceV(fs, f) < 0)
      continue;
    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        block[(PlaceV(fs, f) + i) * ROW_MOST + PlaceVs(fs) + j] +=
            k->flow[f] * k->kr[f] * out[OUT_MI + f] * (A->A[cl_symmetric[i][j]] - (i == j ? k->share[f] : 0.0)) / dt;
    }
  }
}

/* Of the node's place b, where displacement counts with NU; the fluxes' weights NS are the caller's. */
static inline NodeWeights WeightsAt(const Model *m, const Reach *r, int b, double NU)
{
  return (NodeWeights){.S     = r->S[b],
                       .NU    = NU,
                       .K     = m->c->axisymmetric ? r->K[b] : 0.0,
                       .G     = r->G[b],
                       .M     = r->M[b],
                       .B     = m->cell ? r->B[b] : NULL,
                       .w     = &m->w[PHASE_COUNT * r->node[b]],
                       .share = m->share ? &m->share[r->node[b]] : NULL};
}

/* What a particle adds to the blocks between its nodes. */
static void ParticleBlock(const Model *m, const Assembly *to, const double *x, const ParticleResult *of, Slopes *slopes,
                          Patch *patch)
{
  const FieldSet    *fs = &to->fs;
  const Reach       *r  = &of->r;
  const PointOutput *o  = &of->o;
  const PetscInt     p  = of->p;
  NodeFactors        factor[CL_NODES];
  const double      *D[OUT_COUNT];
  double            *row[OUT_COUNT];
  double             DB[OUT_COUNT][ROW_MOST] __attribute__((aligned(64)));

  SlopesBegin(fs->n * r->n, m->cell != NULL, slopes);
  for (int b = 0; b < r->n; b++) {
    Factors(m, p, r->node[b], x, r->S[b], &factor[b]);
    NodeWeights at = WeightsAt(m, r, b, MotionWeight(m, p, r, b));

    for (int f = 0; f < PHASE_COUNT; f++) {
      for (int d = 0; d < CL_DIM; d++)
        at.NS[f][d] = factor[b].flow[f];
    }
    SlopesAdd(fs, m->c->axisymmetric, m->stage.dt, &at, b * fs->n, slopes);
  }
  for (int k = 0; k < to->nout; k++) {
    D[k]   = o->D[to->out[k]];
    row[k] = DB[to->out[k]];
  }
  SlopesApply(slopes, to->nout, D, row);
  NodeRows(m, to, r, factor, &(OutputSlopes){(const double(*)[ROW_MOST])DB, slopes->length}, patch);
  for (int a = 0; a < r->n; a++) {
    Diagonal(fs, o->out, &factor[a], m->stage.dt, r->S[a], &m->w[PHASE_COUNT * r->node[a]], &patch->v[a][0][a * fs->n]);
    if (m->beds && fs->solid && fs->inertia)
      DiagonalBeds(fs, &m->beds[p].A, o->out, &factor[a], m->stage.dt, &patch->v[a][0][a * fs->n]);
  }
}

static void KeepWide(const FieldSet *fs, const PointOutput *o, Wide *w)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    memcpy(w->flux[f], o->wide[f], sizeof(w->flux[f]));
    if (fs->heat)
      memcpy(w->q[f], o->wide_q[f], sizeof(w->q[f]));
  }
}

/* The targets in turn; what eliminates changes the tangent, so it comes last. */
static void ParticleLoop(Model *m, const double *x, int ntarget, const Assembly *target)
{
  Patch  patch[2];
  Slopes slopes[2];

  for (int k = 0; k < ntarget; k++)
    patch[k].n = slopes[k].unknowns = 0;
  for (PetscInt q = 0; q < m->P.n; q++) {
    const PetscInt p = m->order[q];
    ParticleResult at;

    if (ParticleEvaluate(m, p, x, true, &at) != CL_OK)
      continue; /* the residual said so */
    if (m->wide)
      KeepWide(&m->c->fields, &at.o, &m->wide[p]);
    if (m->solver->product)
      ProductKeep(m, q, &at.o);
    for (int k = 0; k < ntarget; k++) {
      if (target[k].reduced)
        EliminateParticle(m, x, target[k].fixed_stress, &at);
      PatchAt(m, &target[k], &at.r, &patch[k]);
      ParticleBlock(m, &target[k], x, &at, &slopes[k], &patch[k]);
      LongCellBlock(m, &target[k], p, &at.r);
    }
  }
  for (int k = 0; k < ntarget; k++)
    PatchAdd(m, &target[k], &patch[k]);
}

/* Factor of what a face puts into the row of any unknown: k_r in (16). */
static double MobilityOf(const Model *m, PetscInt I, int q)
{
  return m->fluid && q >= F_VW && q < F_PW ? PetscSqr(m->fluid[PHASE_COUNT * I + (q - F_VW) / CL_DIM].root) : 1.0;
}

/* Few conditions change with an unknown, and none changes all rows. */
static bool NoSlope(const double D[IN_COUNT])
{
  double size = 0.0;

  for (int q = 0; q < IN_COUNT; q++)
    size += fabs(D[q]);
  return size == 0.0;
}

/* Rows of a face's nodes: all are weighted with N. */
static void FaceBlock(const Model *m, const Assembly *to, const Face *face, const Reach *r, const FaceOutput *o)
{
  const FieldSet *fs = &to->fs;
  Slopes          slopes;

  slopes.unknowns = 0;
  SlopesBegin(fs->n * r->n, true, &slopes);
  for (int b = 0; b < r->n; b++) {
    NodeWeights at = WeightsAt(m, r, b, face->N[b]);

    for (int f = 0; f < PHASE_COUNT; f++) {
      for (int d = 0; d < CL_DIM; d++)
        at.NS[f][d] = FaceShare(m, face->particle, r->node[b], f) * FaceWeight(face, b, VectorAt(F_VW, f, d));
    }
    SlopesAdd(fs, m->c->axisymmetric, m->stage.dt, &at, b * fs->n, &slopes);
  }
  for (int k = 0; k < F_COUNT; k++) {
    double        row[ROW_MOST] __attribute__((aligned(64)));
    const double *D      = o->D[k];
    double       *to_row = row;

    if (fs->at[k] < 0 || NoSlope(D))
      continue;
    SlopesApply(&slopes, 1, &D, &to_row);
    for (int a = 0; a < r->n; a++) {
      const double N =
          FaceWeight(face, a, k) * FaceFlow(m, face->particle, r->node[a], k) * MobilityOf(m, r->node[a], k);

      for (int b = 0; b < r->n; b++) {
        double *block = AssemblyBlock(m, to, r->node[a], r->node[b]) + fs->at[k] * fs->n;

        for (int q = 0; q < fs->n; q++)
          block[q] += N * row[b * fs->n + q];
      }
    }
  }
}

/* (197) couples a node only with itself. */
static void WallBlocks(const Model *m, const Assembly *to)
{
  const FieldSet *fs = &to->fs;

  for (PetscInt k = 0; m->wall && k < m->map.n_local * PHASE_COUNT; k++) {
    const PetscInt I = k / PHASE_COUNT;
    const int      f = k % PHASE_COUNT, v = fs->phase[f] ? PlaceV(fs, f) : -1;

    if (m->wall[k] == 0.0 || v < 0)
      continue;
    double *row = AssemblyBlock(m, to, I, I) + v * fs->n;

    row[v] += m->wall[k] * m->w[k];
    if (fs->solid)
      row[PlaceVs(fs)] -= m->wall[k] * m->w[k];
  }
}

static void FaceLoop(Model *m, const double *x, int ntarget, const Assembly *target)
{
  for (PetscInt k = 0; k < m->nface; k++) {
    Reach      r;
    FaceOutput o;

    if (!FaceActs(m->c, &m->face[k]))
      continue;
    FaceAt(m, &m->face[k], x, &r, &o);
    if (m->solver->product)
      ProductKeepFace(m, k, &o);
    for (int t = 0; t < ntarget; t++) {
      if (target[t].reduced)
        EliminateFace(m, &m->face[k], &r, &o);
      FaceBlock(m, &target[t], &m->face[k], &r, &o);
    }
  }
  for (int t = 0; t < ntarget; t++)
    WallBlocks(m, &target[t]);
}

/* What is assembled: J2 for the operator, or where it preconditions at a renewal, and at one the reduced matrix. */
static PetscErrorCode Targets(Model *m, bool renew, int *n, Assembly *target)
{
  PetscFunctionBeginUser;
  *n = 0;
  if (m->solver->J2 && (!m->solver->product || renew)) {
    PetscCall(MatrixBegin(m));
    AssemblyOf(m, &m->c->fields, &target[(*n)++]);
  }
  if (!renew || !m->solver->reduces)
    PetscFunctionReturn(PETSC_SUCCESS);
  AssemblyOf(m, ReducedFields(m), &target[*n]);
  PetscCall(ReducedBegin(m, &target[(*n)++]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Finish(Model *m, bool renew, int n, const Assembly *target, Mat A, Mat P)
{
  PetscFunctionBeginUser;
  if (n > 0 && !target[0].reduced)
    PetscCall(MatrixFinish(m));
  if (m->solver->reduces)
    PetscCall(ReducedFollow(m));
  if (renew && m->solver->reduces) {
    PetscCall(PetscLogEventBegin(m->event[EVENT_SETUP], 0, 0, 0, 0));
    PetscCall(ReducedSetUp(m));
    PetscCall(PetscLogEventEnd(m->event[EVENT_SETUP], 0, 0, 0, 0));
  }
  if (renew && m->solver->J2 && P != m->solver->J2)
    PetscCall(MatrixCopy(m, P));
  PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelJacobian(SNES snes, Vec X, Mat A, Mat P, void *model)
{
  Model   *m = (Model *)model;
  Assembly target[2];
  bool     renew;
  int      n;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->event[EVENT_JACOBIAN], 0, 0, 0, 0));
  PetscCall(PreconditionerChoose(m, snes, &renew));
  PetscCall(ModelNodesAt(m, X));
  PlatesMark(m, m->x);
  if (m->solver->product)
    PetscCall(ProductBegin(m));
  else if (!m->wide && m->c->fields.fluid)
    PetscCall(PetscCalloc1(m->stencil_cap, &m->wide));
  PetscCall(Targets(m, renew, &n, target));
  ParticleLoop(m, m->x, n, target);
  FaceLoop(m, m->x, n, target);
  for (int k = 0; k < n; k++)
    StabilisationJacobian(m, &target[k]);
  PetscCall(Finish(m, renew, n, target, A, P));
  PetscCall(PetscLogEventEnd(m->event[EVENT_JACOBIAN], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
