/* The Jacobian assembled from particles and faces: J2 with all unknowns, and what (170) leaves when the fluid
   velocities are eliminated. */
#include "solver.h"

/* Nodal factors that multiply a particle's outputs: accelerations, Darcy fluxes, temperature rate, weights of drag. */
typedef struct {
  double acc[3][2], own[PHASE_COUNT][CL_DIM], J[PHASE_COUNT][CL_DIM], Tdot; /* own: in (16), (310) */
  double weight[PHASE_COUNT];                                               /* RowWeight */
  double kr[PHASE_COUNT];                                                   /* of the node (108) */
  double flow[PHASE_COUNT], share[PHASE_COUNT];                             /* (350), (333), and without S */
  double rise[PHASE_COUNT][CL_DIM]; /* d row (16)/d sqrt(k_r) of the particle, N; of two fluids */
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
    n->share[f]  = FlowWeight(m, p, I, f);
    n->flow[f]   = S * n->share[f];
    n->kr[f]     = 1.0;
    n->weight[f] = RowWeight(m, I, f);
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

/* Rows of node a against the slopes DB of the outputs in the unknowns of all nodes. */
static void NodeRows(const Model *m, const Assembly *to, const Reach *r, int a, const NodeFactors *k,
                     const double DB[OUT_COUNT][ROW_MOST], int length, double (*row)[ROW_MOST])
{
  const FieldSet *fs = &to->fs;
  const double    S = r->S[a], *M = r->M[a], *G = r->G[a], *B = m->c->mean_dilatation ? r->B[a] : NULL;
  RowSum          sum = {0};

  for (int i = 0; fs->solid && i < CL_DIM; i++) {
    sum.n = 0;
    RowSumAdd(&sum, M[0], DB[VectorAt(OUT_P, i, 0)]);
    RowSumAdd(&sum, M[1], DB[VectorAt(OUT_P, i, 1)]);
    RowSumAdd(&sum, S * k->acc[0][i], DB[OUT_M]);
    for (int f = 0; f < PHASE_COUNT; f++) {
      if (fs->phase[f])
        RowSumAdd(&sum, S * k->acc[1 + f][i], DB[OUT_M + 1 + f]);
    }
    if (to->force)
      RowSumAdd(&sum, S, DB[OUT_A + i]);
    if (m->c->axisymmetric && i == 0)
      RowSumAdd(&sum, r->K[a], DB[OUT_HOOP]);
    if (B) {
      RowSumAdd(&sum, B[i], DB[OUT_P]);
      RowSumAdd(&sum, B[i], DB[OUT_P + 3]);
      if (m->c->axisymmetric)
        RowSumAdd(&sum, B[i], DB[OUT_HOOP]);
    }
    RowSumInto(&sum, length, row[PlaceVs(fs) + i]);
  }
  sum.n = 0;
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    RowSumAdd(&sum, k->weight[f] * S, DB[OUT_DM + f]);
    for (int j = 0; j < CL_DIM; j++)
      RowSumAdd(&sum, -k->weight[f] * m->stage.dt * G[j], DB[VectorAt(OUT_FLUX, f, j)]);
    if (f == PHASE_W && fs->one_pressure)
      continue; /* one row for both */
    RowSumInto(&sum, length, row[PlaceP(fs, f)]);
    sum.n = 0;
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    for (int i = 0; fs->phase[f] && PlaceV(fs, f) >= 0 && i < CL_DIM; i++) {
      sum.n = 0;
      RowSumAdd(&sum, k->flow[f] * k->kr[f] * k->own[f][i], DB[OUT_MI + f]);
      RowSumAdd(&sum, k->flow[f] * k->kr[f], DB[VectorAt(OUT_G, f, i)]);
      RowSumAdd(&sum, k->flow[f] * k->J[f][i], DB[OUT_D + f]);
      if (m->fluid)
        RowSumAdd(&sum, k->rise[f][i], DB[OUT_ROOT + f]);
      RowSumInto(&sum, length, row[PlaceV(fs, f) + i]);
    }
  }
  if (fs->heat) {
    sum.n = 0;
    RowSumAdd(&sum, S * k->Tdot, DB[OUT_C]);
    RowSumAdd(&sum, S, DB[OUT_Q]);
    for (int j = 0; j < CL_DIM; j++)
      RowSumAdd(&sum, G[j], DB[OUT_HEAT + j]);
    RowSumInto(&sum, length, row[PlaceT(fs)]);
  }
}

/* The lumped terms couple a node only with itself.  Eliminated fluids move with the skeleton as far as drag holds them
   (173). */
static void Diagonal(const FieldSet *fs, const double out[OUT_COUNT], const NodeFactors *k, double dt, double S,
                     const double *w, double *block, int ld)
{
  const double inertia = fs->inertia ? S / dt : 0.0, per_dt = fs->inertia ? 1.0 / dt : 0.0;

  for (int i = 0; i < CL_DIM; i++) {
    const int vs = PlaceVs(fs) + i;

    if (fs->solid)
      block[vs * ld + vs] += inertia * out[OUT_M];
    for (int f = 0; f < PHASE_COUNT; f++) {
      const int v = PlaceV(fs, f) + i;

      if (!fs->phase[f])
        continue;
      const double drag = k->flow[f] * out[OUT_D + f] * w[f],
                   mass = per_dt * k->flow[f] * k->share[f] * k->kr[f] * out[OUT_MI + f];

      if (PlaceV(fs, f) < 0) {
        if (fs->solid && drag > 0.0)
          block[vs * ld + vs] += inertia * out[OUT_M + 1 + f] * drag / (drag + mass);
        continue;
      }
      block[v * ld + v] += mass + drag;
      if (!fs->solid)
        continue;
      block[v * ld + vs] -= drag;
      block[vs * ld + v] += inertia * out[OUT_M + 1 + f];
    }
  }
  if (fs->heat)
    block[PlaceT(fs) * ld + PlaceT(fs)] += S * out[OUT_C] / dt;
}

/* Beds: fluids feel the skeleton's acceleration (308). */
static void DiagonalBeds(const FieldSet *fs, const Beds *A, const double out[OUT_COUNT], const NodeFactors *k,
                         double dt, double *block, int ld)
{
  const double less[2][2] = {{A->xx - 1.0, A->xy}, {A->xy, A->yy - 1.0}};

  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f] || PlaceV(fs, f) < 0)
      continue;
    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        block[(PlaceV(fs, f) + i) * ld + PlaceVs(fs) + j] += k->flow[f] * k->kr[f] * out[OUT_MI + f] * less[i][j] / dt;
    }
  }
}

/* What a particle adds to the blocks between its nodes. */
static void ParticleBlock(const Model *m, const Assembly *to, PetscInt p, const Reach *r, const double *x,
                          const PointOutput *o, Patch *patch)
{
  const FieldSet *fs           = &to->fs;
  const bool      axisymmetric = m->c->axisymmetric;
  NodeFactors     factor[CL_NODES];
  Slopes          slopes;
  double          DB[OUT_COUNT][ROW_MOST] __attribute__((aligned(64)));

  SlopesBegin(fs->n * r->n, &slopes);
  for (int b = 0; b < r->n; b++) {
    Factors(m, p, r->node[b], x, r->S[b], &factor[b]);
    const NodeWeights at = {
        .S  = r->S[b],
        .NS = {{factor[b].flow[PHASE_W], factor[b].flow[PHASE_W]}, {factor[b].flow[PHASE_G], factor[b].flow[PHASE_G]}},
        .NU = MotionWeight(m, p, r, b),
        .K  = axisymmetric ? r->K[b] : 0.0,
        .G  = r->G[b],
        .M  = r->M[b],
        .B  = m->c->mean_dilatation ? r->B[b] : NULL,
        .w  = &m->w[PHASE_COUNT * r->node[b]]};

    SlopesAdd(fs, axisymmetric, m->stage.dt, &at, b * fs->n, &slopes);
  }
  for (int k = 0; k < to->nout; k++)
    SlopesApply(&slopes, o->D[to->out[k]], DB[to->out[k]]);
  for (int a = 0; a < r->n; a++) {
    NodeRows(m, to, r, a, &factor[a], DB, slopes.length, patch->v[a]);
    Diagonal(fs, o->out, &factor[a], m->stage.dt, r->S[a], &m->w[2 * r->node[a]], &patch->v[a][0][a * fs->n], ROW_MOST);
    if (m->beds && fs->solid && fs->inertia)
      DiagonalBeds(fs, &m->beds[p].A, o->out, &factor[a], m->stage.dt, &patch->v[a][0][a * fs->n], ROW_MOST);
  }
}

static void KeepWide(const FieldSet *fs, const PointOutput *o, double *wide)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    for (int k = 0; fs->phase[f] && k < 4; k++)
      wide[4 * f + k] = o->wide[f][k / 2][k % 2];
    for (int j = 0; fs->phase[f] && fs->heat && j < CL_DIM; j++)
      wide[8 + 2 * f + j] = o->wide_q[f][j];
  }
}

/* The targets in turn; what eliminates changes the tangent, so it comes last. */
static void ParticleLoop(Model *m, const double *x, int ntarget, const Assembly *target)
{
  Patch patch[2];

  for (int k = 0; k < ntarget; k++)
    patch[k].n = 0;
  for (PetscInt q = 0; q < m->P.n; q++) {
    const PetscInt p = m->order[q];
    Reach          r;
    PointState     state;
    PointOutput    o;
    double         in[IN_COUNT];

    if (ParticleEvaluate(m, p, x, true, &r, in, &state, &o) != CL_OK)
      continue; /* the residual said so */
    if (m->wide)
      KeepWide(&m->c->fields, &o, &m->wide[12 * p]);
    for (int k = 0; k < ntarget; k++) {
      if (target[k].reduced)
        EliminateParticle(m, p, &r, x, in, target[k].fixed_stress, &o);
      PatchAt(m, &target[k], &r, &patch[k]);
      ParticleBlock(m, &target[k], p, &r, x, &o, &patch[k]);
      LumpBlock(m, &target[k], p, &r);
    }
  }
  for (int k = 0; k < ntarget; k++)
    PatchAdd(m, &target[k], &patch[k]);
}

/* Factor of what a face puts into the row of any unknown: k_r in (16). */
static double MobilityOf(const Model *m, PetscInt I, int q)
{
  return m->fluid && q >= F_VWX && q <= F_VGY ? PetscSqr(m->fluid[PHASE_COUNT * I + (q - F_VWX) / CL_DIM].root) : 1.0;
}

/* Rows of a face's nodes: all are weighted with N. */
static void FaceBlock(const Model *m, const Assembly *to, const Face *face, const Reach *r, const FaceOutput *o)
{
  const FieldSet *fs = &to->fs;
  Slopes          slopes;

  SlopesBegin(fs->n * r->n, &slopes);
  for (int b = 0; b < r->n; b++) {
    const double water   = FaceShare(m, face->particle, r->node[b], PHASE_W),
                 gas     = FaceShare(m, face->particle, r->node[b], PHASE_G);
    const NodeWeights at = {.S  = r->S[b],
                            .NS = {{water * face->Nr[b], water * face->N[b]}, {gas * face->Nr[b], gas * face->N[b]}},
                            .NU = face->N[b],
                            .K  = m->c->axisymmetric ? r->K[b] : 0.0,
                            .G  = r->G[b],
                            .M  = r->M[b],
                            .B  = m->c->mean_dilatation ? r->B[b] : NULL,
                            .w  = &m->w[PHASE_COUNT * r->node[b]]};

    SlopesAdd(fs, m->c->axisymmetric, m->stage.dt, &at, b * fs->n, &slopes);
  }
  for (int k = 0; k < F_COUNT; k++) {
    double row[ROW_MOST] __attribute__((aligned(64)));

    if (fs->at[k] < 0)
      continue;
    SlopesApply(&slopes, o->D[k], row);
    for (int a = 0; a < r->n; a++) {
      const double N = FaceWeight(face, a, k) * FaceFlow(m, face->particle, r->node[a], k) *
                       RowWeightOf(m, r->node[a], k) * MobilityOf(m, r->node[a], k);

      for (int b = 0; b < r->n; b++) {
        double *block = AssemblyBlock(m, to, r->node[a], r->node[b]) + fs->at[k] * fs->n;

        for (int q = 0; q < fs->n; q++)
          block[q] += N * row[b * fs->n + q];
      }
    }
  }
}

static void FaceLoop(Model *m, const double *x, int ntarget, const Assembly *target)
{
  for (PetscInt k = 0; k < m->nface; k++) {
    Reach      r;
    FaceOutput o;

    FaceAt(m, &m->face[k], x, &r, &o);
    for (int t = 0; t < ntarget; t++) {
      if (target[t].reduced)
        EliminateFace(m, &m->face[k], &r, &o);
      FaceBlock(m, &target[t], &m->face[k], &r, &o);
    }
  }
}

PetscErrorCode ModelJacobian(SNES snes, Vec X, Mat A, Mat P, void *model)
{
  Model   *m = (Model *)model;
  Assembly target[2];
  bool     renew;
  int      n = 1;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->event[EVENT_JACOBIAN], 0, 0, 0, 0));
  PetscCall(PreconditionerChoose(m, snes, &renew));
  PetscCall(ModelFluidsAt(m, X));
  PetscCall(ModelUnscale(m, X, m->x));
  PetscCall(ModelProjectGradients(m, m->x, false, m->proj));
  ModelGive(m, m->x);
  PetscCall(MatrixBegin(m));
  PetscCall(PlatesPosition(m, m->x));
  PlatesMark(m, m->x);
  AssemblyOf(m, &m->c->fields, &target[0]);
  if (renew && m->solver->reduces) {
    AssemblyOf(m, ReducedFields(m), &target[1]);
    PetscCall(ReducedBegin(m, &target[1]));
    n = 2;
  }
  ParticleLoop(m, m->x, n, target);
  FaceLoop(m, m->x, n, target);
  for (int k = 0; k < n; k++)
    StabilisationJacobian(m, &target[k]);
  PetscCall(MatrixFinish(m));
  if (m->solver->reduces)
    PetscCall(ReducedFollow(m));
  if (renew && m->solver->reduces) {
    PetscCall(PetscLogEventBegin(m->event[EVENT_SETUP], 0, 0, 0, 0));
    PetscCall(ReducedSetUp(m));
    PetscCall(PetscLogEventEnd(m->event[EVENT_SETUP], 0, 0, 0, 0));
  }
  if (renew && P != m->solver->J2)
    PetscCall(MatConvert(m->solver->J2, MATAIJ, MAT_REUSE_MATRIX, &P));
  if (A != P) {
    PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  }
  PetscCall(PetscLogEventEnd(m->event[EVENT_JACOBIAN], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
