/* The Jacobian assembled from particles and faces: J2 with all unknowns, and what (170) leaves when the fluid
   velocities are eliminated. */
#include "gather.h"

/* One node as a particle or face sees it; NS (by component) and NU stand for S in the Darcy fluxes, where it is (350),
   and in the displacement. */
typedef struct {
  double        S, NS[CL_DIM], NU, K;
  const double *G, *M, *w, *B; /* B: null without mean dilatation */
} NodeWeights;

/* d out/d(unknowns of one node): one row of D times d in/d x. */
static inline void Columns(const FieldSet *fs, bool axisymmetric, double dt, const double *D, const NodeWeights *b,
                           double *col)
{
  const double *G = b->G;

  if (fs->solid) {
    const double *M  = b->M;
    const int     vs = PlaceVs(fs);

    for (int i = 0; i < 2; i++)
      col[vs + i] = dt * (D[IN_GRADU + 2 * i] * M[0] + D[IN_GRADU + 2 * i + 1] * M[1] + D[IN_U + i] * b->NU);
    if (axisymmetric)
      col[vs] += dt * D[IN_HOOP] * b->K;
    for (int i = 0; b->B && i < 2; i++)
      col[vs + i] += dt * (D[IN_GRADU] + D[IN_GRADU + 3] + (axisymmetric ? D[IN_HOOP] : 0.0)) * b->B[i];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    for (int i = 0; PlaceV(fs, f) >= 0 && i < 2; i++) {
      const double J = D[IN_J + 2 * f + i] * b->NS[i] * b->w[f];

      col[PlaceV(fs, f) + i] = J;
      if (fs->solid)
        col[PlaceVs(fs) + i] -= J;
    }
    const double dp    = D[IN_P + f] * b->S + D[IN_GP + 2 * f] * G[0] + D[IN_GP + 2 * f + 1] * G[1];
    col[PlaceP(fs, f)] = f == PHASE_G && fs->one_pressure ? col[PlaceP(fs, f)] + dp : dp;
  }
  if (fs->heat)
    col[PlaceT(fs)] = D[IN_T] * b->S + D[IN_GT] * G[0] + D[IN_GT + 1] * G[1];
}

/* Nodal factors that multiply a particle's outputs: accelerations, Darcy fluxes, temperature rate, weights of drag. */
typedef struct {
  double acc[3][2], own[PHASE_COUNT][2], J[PHASE_COUNT][2], Tdot; /* own: in (16), (310) */
  double weight[PHASE_COUNT];                                     /* RowWeight */
  double kr[PHASE_COUNT];                                         /* of the node (108) */
  double flow, share;                                             /* (350), and without S */
  double rise[PHASE_COUNT][2]; /* d row (16)/d sqrt(k_r) of the particle, N; of two fluids */
} NodeFactors;

static void Factors(const Model *m, PetscInt p, PetscInt I, const double *x, double S, NodeFactors *n)
{
  const FieldSet *fs = &m->c->fields;

  if (fs->solid)
    Acceleration(m, I, x, PlaceVs(fs), 1.0, n->acc[0]);
  n->share = FlowWeight(m, p, I);
  n->flow  = S * n->share;
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    Acceleration(m, I, x, PlaceV(fs, f), 1.0, n->acc[1 + f]);
    FluidAcceleration(m, p, I, x, f, n->own[f]);
    DarcyFlux(m, I, f, &x[I * fs->n], n->J[f]);
    n->kr[f]     = 1.0;
    n->weight[f] = RowWeight(m, I, f);
    if (!m->fluid)
      continue;
    const FluidNode *at = &m->fluid[PHASE_COUNT * I + f];

    n->kr[f] = at->root * at->root;
    for (int i = 0; i < 2; i++)
      n->rise[f][i] = 2.0 * at->root * MobilityShare(m, p, I, f, S) * at->F[i];
  }
  if (fs->heat) {
    const PetscInt k = I * fs->n + PlaceT(fs);

    n->Tdot = (x[k] - m->stage.x_star[k]) / m->stage.dt;
  }
}

/* Rows of node a against the columns DB of node b (b's block starts at *out, row length ld). */
static inline void Rows(const FieldSet *fs, bool axisymmetric, bool ambient, int n, const NodeFactors *k, double dt,
                        double S, const double *G, const double *M, double K, const double *B,
                        double DB[OUT_COUNT][F_COUNT], double *out, int ld)
{
  for (int i = 0; fs->solid && i < 2; i++) {
    double *row = &out[(PlaceVs(fs) + i) * ld];

    for (int q = 0; q < n; q++)
      row[q] = M[0] * DB[OUT_P + 2 * i][q] + M[1] * DB[OUT_P + 2 * i + 1][q] + S * k->acc[0][i] * DB[OUT_M][q];
    for (int f = 0; f < PHASE_COUNT; f++) {
      for (int q = 0; fs->phase[f] && q < n; q++)
        row[q] += S * k->acc[1 + f][i] * DB[OUT_M + 1 + f][q];
    }
    for (int q = 0; ambient && q < n; q++)
      row[q] += S * DB[OUT_A + i][q];
    for (int q = 0; axisymmetric && i == 0 && q < n; q++)
      row[q] += K * DB[OUT_HOOP][q];
    for (int q = 0; B && q < n; q++)
      row[q] += B[i] * (DB[OUT_P][q] + DB[OUT_P + 3][q] + (axisymmetric ? DB[OUT_HOOP][q] : 0.0));
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    for (int i = 0; PlaceV(fs, f) >= 0 && i < 2; i++) {
      double *row = &out[(PlaceV(fs, f) + i) * ld];

      for (int q = 0; q < n; q++)
        row[q] = k->flow * (k->kr[f] * (k->own[f][i] * DB[OUT_MI + f][q] + DB[OUT_G + 2 * f + i][q]) +
                            k->J[f][i] * DB[OUT_D + f][q]);
      for (int q = 0; fs->phase[PHASE_W] && fs->phase[PHASE_G] && q < n; q++)
        row[q] += k->rise[f][i] * DB[OUT_ROOT + f][q];
    }
    const bool shared = f == PHASE_G && fs->one_pressure; /* the row that the water has begun */
    double    *row    = &out[PlaceP(fs, f) * ld];
    for (int q = 0; q < n; q++) {
      const double flux = G[0] * DB[OUT_FLUX + 2 * f][q] + G[1] * DB[OUT_FLUX + 2 * f + 1][q];
      const double mass = k->weight[f] * (S * DB[OUT_DM + f][q] - dt * flux);

      row[q] = shared ? row[q] + mass : mass;
    }
  }
  if (fs->heat) {
    double *row = &out[PlaceT(fs) * ld];

    for (int q = 0; q < n; q++)
      row[q] = S * (k->Tdot * DB[OUT_C][q] + DB[OUT_Q][q]) + G[0] * DB[OUT_HEAT][q] + G[1] * DB[OUT_HEAT + 1][q];
  }
}

/* The lumped terms couple a node only with itself.  Eliminated fluids move with the skeleton as far as drag holds them
   (173). */
static void Diagonal(const FieldSet *fs, const double out[OUT_COUNT], const NodeFactors *k, double dt, double S,
                     const double *w, double *block, int ld)
{
  const double inertia = fs->inertia ? S / dt : 0.0, moved = fs->inertia ? k->flow * k->share / dt : 0.0;

  for (int i = 0; i < 2; i++) {
    const int vs = PlaceVs(fs) + i;

    if (fs->solid)
      block[vs * ld + vs] += inertia * out[OUT_M];
    for (int f = 0; f < PHASE_COUNT; f++) {
      const int    v    = PlaceV(fs, f) + i;
      const double drag = k->flow * out[OUT_D + f] * w[f], mass = moved * k->kr[f] * out[OUT_MI + f];

      if (!fs->phase[f])
        continue;
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
    for (int i = 0; i < 2; i++) {
      for (int j = 0; j < 2; j++)
        block[(PlaceV(fs, f) + i) * ld + PlaceVs(fs) + j] += k->flow * k->kr[f] * out[OUT_MI + f] * less[i][j] / dt;
    }
  }
}

/* A constant number of unknowns lets the compiler unroll the rows of the largest sets. */
INLINE void ParticleBlockOf(const Model *m, const Assembly *to, int n, PetscInt p, const Reach *r, const double *x,
                            const PointOutput *o)
{
  const FieldSet *fs           = &to->fs;
  const bool      axisymmetric = m->c->axisymmetric;
  const double    dt           = m->stage.dt;
  NodeFactors     factor[CL_NODES];

  for (int a = 0; a < r->n; a++)
    Factors(m, p, r->node[a], x, r->S[a], &factor[a]);
  for (int b = 0; b < r->n; b++) {
    const NodeWeights at = {.S  = r->S[b],
                            .NS = {factor[b].flow, factor[b].flow},
                            .NU = MotionWeight(m, p, r, b),
                            .K  = axisymmetric ? r->K[b] : 0.0,
                            .G  = r->G[b],
                            .M  = r->M[b],
                            .B  = m->c->mean_dilatation ? r->B[b] : NULL,
                            .w  = &m->w[2 * r->node[b]]};
    double            DB[OUT_COUNT][F_COUNT];

    for (int k = 0; k < to->nout; k++)
      Columns(fs, axisymmetric, dt, o->D[to->out[k]], &at, DB[to->out[k]]);
    for (int a = 0; a < r->n; a++) {
      double *restrict sum = AssemblyBlock(m, to, r->node[a], r->node[b]);
      double block[F_COUNT * F_COUNT];

      Rows(fs, axisymmetric, to->force, n, &factor[a], dt, r->S[a], r->G[a], r->M[a], axisymmetric ? r->K[a] : 0.0,
           m->c->mean_dilatation ? r->B[a] : NULL, DB, block, n);
      if (a == b)
        Diagonal(fs, o->out, &factor[a], dt, r->S[a], at.w, block, n);
      if (a == b && m->beds && fs->solid && fs->inertia)
        DiagonalBeds(fs, &m->beds[p].A, o->out, &factor[a], dt, block, n);
      for (int k = 0; k < n * n; k++)
        sum[k] += block[k];
    }
  }
}

static void ParticleBlock(const Model *m, const Assembly *to, PetscInt p, const Reach *r, const double *x,
                          const PointOutput *o)
{
  if (to->fs.n == F_COUNT)
    ParticleBlockOf(m, to, F_COUNT, p, r, x, o);
  else if (to->fs.n == 5)
    ParticleBlockOf(m, to, 5, p, r, x, o);
  else
    ParticleBlockOf(m, to, to->fs.n, p, r, x, o);
}

static void KeepWide(const FieldSet *fs, const PointOutput *o, double *wide)
{
  for (int f = 0; f < PHASE_COUNT; f++) {
    for (int k = 0; fs->phase[f] && k < 4; k++)
      wide[4 * f + k] = o->wide[f][k / 2][k % 2];
    for (int j = 0; fs->phase[f] && fs->heat && j < 2; j++)
      wide[8 + 2 * f + j] = o->wide_q[f][j];
  }
}

/* The targets in turn; what eliminates changes the tangent, so it comes last. */
static void ParticleLoop(Model *m, const double *x, int ntarget, const Assembly *target)
{
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach       r;
    PointState  state;
    PointOutput o;
    double      in[IN_COUNT];

    if (ParticleEvaluate(m, p, x, true, &r, in, &state, &o) != CL_OK)
      continue; /* the residual said so */
    if (m->wide)
      KeepWide(&m->c->fields, &o, &m->wide[12 * p]);
    for (int k = 0; k < ntarget; k++) {
      if (target[k].reduced)
        EliminateParticle(m, p, &r, x, in, target[k].fixed_stress, &o);
      ParticleBlock(m, &target[k], p, &r, x, &o);
      LumpBlock(m, &target[k], p, &r);
    }
  }
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

  for (int b = 0; b < r->n; b++) {
    const double      flow = FlowWeight(m, face->particle, r->node[b]);
    const NodeWeights at   = {.S  = r->S[b],
                              .NS = {flow * face->Nr[b], flow * face->N[b]},
                              .NU = face->N[b],
                              .K  = m->c->axisymmetric ? r->K[b] : 0.0,
                              .G  = r->G[b],
                              .M  = r->M[b],
                              .B  = m->c->mean_dilatation ? r->B[b] : NULL,
                              .w  = &m->w[2 * r->node[b]]};

    for (int k = 0; k < F_COUNT; k++) {
      double col[F_COUNT];

      if (fs->at[k] < 0)
        continue;
      Columns(fs, m->c->axisymmetric, m->stage.dt, o->D[k], &at, col);
      for (int a = 0; a < r->n; a++) {
        const double N = FaceWeight(face, a, k) * FaceFlow(m, face->particle, r->node[a], k) *
                         RowWeightOf(m, r->node[a], k) * MobilityOf(m, r->node[a], k);

        double *row = AssemblyBlock(m, to, r->node[a], r->node[b]) + fs->at[k] * fs->n;

        for (int q = 0; q < fs->n; q++)
          row[q] += N * col[q];
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
  PetscCall(MatrixBegin(m));
  PetscCall(PlatesPosition(m, m->x));
  PlatesMark(m, m->x);
  AssemblyOf(m, &m->c->fields, &target[0]);
  if (renew && m->reduces) {
    AssemblyOf(m, ReducedFields(m), &target[1]);
    PetscCall(ReducedBegin(m, &target[1]));
    n = 2;
  }
  ParticleLoop(m, m->x, n, target);
  FaceLoop(m, m->x, n, target);
  for (int k = 0; k < n; k++)
    StabilisationJacobian(m, &target[k]);
  PetscCall(MatrixFinish(m));
  if (m->reduces)
    PetscCall(ReducedFollow(m));
  if (renew && m->reduces) {
    PetscCall(PetscLogEventBegin(m->event[EVENT_SETUP], 0, 0, 0, 0));
    PetscCall(ReducedSetUp(m));
    PetscCall(PetscLogEventEnd(m->event[EVENT_SETUP], 0, 0, 0, 0));
  }
  if (renew && P != m->J2)
    PetscCall(MatConvert(m->J2, MATAIJ, MAT_REUSE_MATRIX, &P));
  if (A != P) {
    PetscCall(MatAssemblyBegin(A, MAT_FINAL_ASSEMBLY));
    PetscCall(MatAssemblyEnd(A, MAT_FINAL_ASSEMBLY));
  }
  PetscCall(PetscLogEventEnd(m->event[EVENT_JACOBIAN], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}
