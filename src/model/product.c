/* Products of the exact Jacobian with a change of the unknowns, particle by particle: the tangents of particles and
   faces, as each has them, are kept instead of a matrix.  What a change makes of the residual (15)-(23) is found the
   way the residual is (401): nodes give to particles, particles add to nodes, rows are made of the sums. */
#include "solver.h"
#include "tangents.h"

/* Of a node at X: what this rank's particles have added (TAKE_...), and of two fluids the sums of all ranks (16). */
typedef struct {
  double    M[1 + PHASE_COUNT], MI2[PHASE_COUNT], D[PHASE_COUNT], C;
  FluidNode fluid[PHASE_COUNT];
} AtNode;

struct Product {
  Tangents tangents;
  double  *MI;                       /* [n][PHASE_COUNT] OUT_MI as Model.order has them; beds */
  PetscInt cap;                      /* particles it has room for */
  double (*face)[F_COUNT][IN_COUNT]; /* [nface] FaceOutput.D of those that act */
  PetscInt nface;                    /* faces it has room for */
  double  *x, *dx;                   /* [n_local][fields.n] unknowns, their change */
  double  *diagonal;                 /* [n_local][CL_FLUID_VECTORS] of rows (16), unscaled */
  AtNode  *node;                     /* [n_local] */
};

PetscErrorCode ProductCreate(Model *m)
{
  const PetscInt n = PetscMax(m->map.n_local, 1), nf = m->c->fields.n;
  Product       *t;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&t));
  PetscCall(PetscMalloc4(n * nf, &t->x, n * nf, &t->dx, n * CL_FLUID_VECTORS, &t->diagonal, n, &t->node));
  m->solver->product = t;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProductDestroy(Product **product)
{
  Product *t = *product;

  PetscFunctionBeginUser;
  if (!t)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(TangentsEnd(&t->tangents));
  PetscCall(PetscFree(t->MI));
  PetscCall(PetscFree(t->face));
  PetscCall(PetscFree4(t->x, t->dx, t->diagonal, t->node));
  PetscCall(PetscFree(*product));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode MakeRoom(const Model *m, Product *t)
{
  PetscFunctionBeginUser;
  PetscCall(TangentsBegin(m, &t->tangents));
  if (m->beds && m->P.n > t->cap) {
    PetscCall(PetscFree(t->MI));
    t->cap = m->P.n;
    PetscCall(PetscMalloc1(t->cap * PHASE_COUNT, &t->MI));
  }
  if (m->nface > t->nface) {
    PetscCall(PetscFree(t->face));
    t->nface = m->nface;
    PetscCall(PetscMalloc1(t->nface, &t->face));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProductBegin(Model *m)
{
  const FieldSet *fs     = &m->c->fields;
  Product        *t      = m->solver->product;
  const double    per_dt = fs->inertia ? 1.0 / m->stage.dt : 0.0;

  PetscFunctionBeginUser;
  PetscCall(MakeRoom(m, t));
  PetscCall(PetscArraycpy(t->x, m->x, m->map.n_local * fs->n));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *take = &m->take[TAKE_COUNT * I];
    AtNode       *at   = &t->node[I];

    memcpy(at->M, &take[TAKE_M], sizeof(at->M));
    at->C = take[TAKE_C];
    for (int f = 0; f < PHASE_COUNT; f++) {
      const double *of = &take[TAKE_FLUID + FLUID_COUNT * f], share = fs->fluid ? NodeShare(m, I, f) : 0.0;
      const double  root = m->fluid ? m->fluid[PHASE_COUNT * I + f].root : 1.0;

      at->MI2[f] = share * share * of[FLUID_MI2];
      at->D[f]   = share * of[FLUID_D];
      if (m->fluid)
        at->fluid[f] = m->fluid[PHASE_COUNT * I + f];
      for (int d = 0; d < CL_DIM; d++)
        t->diagonal[VectorAt(CL_FLUID_VECTORS * I, f, d)] =
            per_dt * root * root * at->MI2[f] + (at->D[f] + WallDrag(m, I, f, d)) * m->w[PHASE_COUNT * I + f];
    }
  }
  PetscCall(NodeMapReduce(&m->map, t->diagonal, CL_FLUID_VECTORS));
  PetscFunctionReturn(PETSC_SUCCESS);
}

void ProductKeep(Model *m, PetscInt q, const PointOutput *o)
{
  Product *t = m->solver->product;

  TangentsKeep(&t->tangents, q, o);
  for (int f = 0; m->beds && f < PHASE_COUNT; f++)
    t->MI[PHASE_COUNT * q + f] = m->c->fields.phase[f] ? o->out[OUT_MI + f] : 0.0;
}

void ProductKeepFace(Model *m, PetscInt k, const FaceOutput *o)
{
  memcpy(m->solver->product->face[k], o->D, sizeof(o->D));
}

/* The skeleton's acceleration in (308). */
static void BedsChange(Model *m, PetscInt q, const Reach *r, const double *dx)
{
  const FieldSet *fs = &m->c->fields;
  const PetscInt  p  = m->order[q];
  const double   *MI = &m->solver->product->MI[PHASE_COUNT * q];

  for (int a = 0; fs->solid && fs->inertia && a < r->n; a++) {
    const PetscInt I = r->node[a];
    double         across[CL_DIM];

    memcpy(across, &dx[I * fs->n + PlaceVs(fs)], sizeof(across));
    BedsDrive(&m->beds[p].A, across);
    for (int f = 0; f < PHASE_COUNT; f++) {
      const double share  = fs->phase[f] ? FlowWeight(m, p, I, f) : 0.0;
      const double weight = fs->phase[f] ? r->S[a] * share / NodeShare(m, I, f) * MI[f] : 0.0;

      for (int d = 0; d < CL_DIM; d++)
        m->take[TAKE_COUNT * I + TAKE_FLUID + FLUID_COUNT * f + FLUID_G + d] +=
            weight * (across[d] - share * dx[I * fs->n + PlaceVs(fs) + d]) / m->stage.dt;
    }
  }
}

static void ParticleLoop(Model *m, bool momentum, const double *dx, double *f)
{
  Lanes in[IN_ALL] = {{0.0}}, out[OUT_COUNT] = {{0.0}};
  Reach r[LANES];

  for (PetscInt first = 0; first < m->P.n; first += LANES) {
    const int count = (int)PetscMin(m->P.n - first, LANES);

    for (int c = 0; c < count; c++) {
      double of[IN_ALL];

      ParticleChange(m, m->order[first + c], dx, &r[c], of, &of[IN_PROJ]);
      for (int k = 0; k < IN_VOLUME; k++)
        in[k][c] = of[k];
    }
    TangentsApply(&m->solver->product->tangents, first / LANES, momentum, in, out);
    for (int c = 0; c < count; c++) {
      const PetscInt p = m->order[first + c];
      double         of[OUT_COUNT];

      for (int k = 0; k < OUT_COUNT; k++)
        of[k] = out[k][c];
      ParticleScatter(m, p, &r[c], m->solver->product->x, of);
      if (m->beds)
        BedsChange(m, first + c, &r[c], dx);
      if (!momentum)
        LongCellResidual(m, p, &r[c], dx, f);
    }
  }
}

static void FaceLoop(const Model *m, const double *dx, double *f)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt k = 0; k < m->nface; k++) {
    const Face *face = &m->face[k];
    double      in[IN_COUNT];
    Reach       r;

    if (!FaceActs(m->c, face))
      continue;
    FaceChange(m, face, dx, &r, in);
    for (int q = 0; q < F_COUNT; q++) {
      const double *D   = m->solver->product->face[k][q];
      double        out = 0.0;

      if (fs->at[q] < 0)
        continue;
      for (int i = 0; i < IN_COUNT; i++)
        out += D[i] * in[i];
      for (int a = 0; a < r.n; a++)
        *RowOf(m, f, r.node[a], q) += FaceWeight(face, a, q) * FaceFlow(m, face->particle, r.node[a], q) * out;
    }
  }
}

/* Change of an acceleration (Rate). */
static void RateChange(const Model *m, PetscInt I, const double *dx, int k, double rate[CL_DIM])
{
  const FieldSet *fs = &m->c->fields;

  for (int i = 0; i < CL_DIM; i++)
    rate[i] = fs->inertia ? dx[I * fs->n + k + i] / m->stage.dt : 0.0;
}

/* Row (15) */
static void SolidRow(const Model *m, PetscInt I, const double *x, const double *dx, const double *take, double *f)
{
  const FieldSet *fs = &m->c->fields;
  double         *fI = &f[I * fs->n + PlaceVs(fs)], acc[CL_DIM], change[CL_DIM];

  for (int k = 0; k < 1 + PHASE_COUNT; k++) {
    const int place = k > 0 ? PlaceV(fs, k - 1) : PlaceVs(fs);

    if (k > 0 && !fs->phase[k - 1])
      continue;
    Acceleration(m, I, x, place, 1.0, acc);
    RateChange(m, I, dx, place, change);
    for (int i = 0; i < CL_DIM; i++)
      fI[i] += take[TAKE_M + k] * acc[i] + m->solver->product->node[I].M[k] * change[i];
  }
  for (int i = 0; i < CL_DIM; i++)
    fI[i] += take[TAKE_GRAD + i] + take[TAKE_A + i];
}

/* Rows (16) and (17) of a fluid at a node. */
static void FluidRows(const Model *m, int ph, PetscInt I, const double *x, const double *dx, const double *take,
                      double *f)
{
  const FieldSet *fs    = &m->c->fields;
  const AtNode   *at    = &m->solver->product->node[I];
  const double   *of    = &take[TAKE_FLUID + FLUID_COUNT * ph];
  FluidNode      *fluid = m->fluid ? &m->fluid[PHASE_COUNT * I + ph] : NULL;
  double *row = fluid ? fluid->F : &f[I * fs->n + PlaceV(fs, ph)], rate[CL_DIM], change[CL_DIM], J[CL_DIM], dJ[CL_DIM];
  const double share = NodeShare(m, I, ph);

  *RowOf(m, f, I, F_PW + ph) += take[TAKE_DM + ph] + take[TAKE_MASS + ph];
  Rate(m, I, x, PlaceV(fs, ph), rate);
  RateChange(m, I, dx, PlaceV(fs, ph), change);
  for (int i = 0; i < CL_DIM; i++)
    row[i] += share * (share * of[FLUID_MI2] * rate[i] - of[FLUID_MI] * m->bc.gravity[i] + of[FLUID_G + i]) +
              at->MI2[ph] * change[i];
  if (fluid) {
    for (int i = 0; i < CL_DIM; i++)
      fluid->D[i] += share * of[FLUID_D];
    fluid->root += RootFactor(m, I, ph) * take[TAKE_ROOT + ph] / m->V[I];
    return;
  }
  DarcyFlux(m, I, ph, &x[I * fs->n], J);
  DarcyFlux(m, I, ph, &dx[I * fs->n], dJ);
  for (int i = 0; i < CL_DIM; i++)
    row[i] += share * of[FLUID_D] * J[i] + (at->D[ph] + WallDrag(m, I, ph, i)) * dJ[i];
}

static void NodeLoop(const Model *m, const double *x, const double *dx, double *f)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *take = &m->take[TAKE_COUNT * I];

    if (fs->solid)
      SolidRow(m, I, x, dx, take, f);
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      if (fs->phase[ph])
        FluidRows(m, ph, I, x, dx, take, f);
    }
    if (fs->heat) { /* row (21) */
      const PetscInt k = I * fs->n + PlaceT(fs);

      f[k] += (take[TAKE_C] * (x[k] - m->stage.x_star[k]) + m->solver->product->node[I].C * dx[k]) / m->stage.dt +
              take[TAKE_C + 1] + take[TAKE_HEAT];
    }
  }
}

/* (16) of two fluids: k_r F + D J. */
static PetscErrorCode MomentumRows(Model *m, const double *x, const double *dx, double *f)
{
  const FieldSet *fs = &m->c->fields;

  PetscFunctionBeginUser;
  PetscCall(NodeMapReduce(&m->map, (double *)m->fluid, PHASE_COUNT * sizeof(FluidNode) / sizeof(double)));
  for (PetscInt I = 0; I < m->map.n_owned; I++) {
    for (int ph = 0; ph < PHASE_COUNT; ph++) {
      const FluidNode *change = &m->fluid[PHASE_COUNT * I + ph], *at = &m->solver->product->node[I].fluid[ph];
      double           J[CL_DIM], dJ[CL_DIM];

      DarcyFlux(m, I, ph, &x[I * fs->n], J);
      DarcyFlux(m, I, ph, &dx[I * fs->n], dJ);
      for (int i = 0; i < CL_DIM; i++)
        f[I * fs->n + PlaceV(fs, ph) + i] = 2.0 * at->root * change->root * at->F[i] +
                                            at->root * at->root * change->F[i] + change->D[i] * J[i] + at->D[i] * dJ[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Scaled rows; those of prescribed unknowns are the unknowns. */
static PetscErrorCode Finish(const Model *m, const double *f, Vec X, Vec Y)
{
  const PetscInt n = m->c->fields.n;
  const double  *x;
  double        *y;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayRead(X, &x));
  PetscCall(VecGetArrayWrite(Y, &y));
  for (PetscInt k = 0; k < m->map.n_owned * n; k++)
    y[k] = (m->mask[k / n] >> (k % n)) & 1u ? x[k] : f[k] / m->row_scale[k];
  PetscCall(VecRestoreArrayWrite(Y, &y));
  PetscCall(VecRestoreArrayRead(X, &x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProductMult(Model *m, bool momentum, Vec X, Vec Y)
{
  const PetscInt nf = m->c->fields.n, n = m->map.n_local;
  Product       *t = m->solver->product;

  PetscFunctionBeginUser;
  m->evaluated = false; /* what the last residual left with the nodes is overwritten */
  PetscCall(ModelUnscale(m, X, t->dx));
  PetscCall(PetscArrayzero(m->f, n * nf));
  if (m->fluid)
    PetscCall(PetscArrayzero(m->fluid, n * PHASE_COUNT));
  PetscCall(PetscArrayzero(m->take, n * TAKE_COUNT));
  if (!momentum)
    PetscCall(ModelProjectGradients(m, t->dx, true, m->proj));
  ModelGive(m, t->dx, true);
  ParticleLoop(m, momentum, t->dx, m->f);
  NodeLoop(m, t->x, t->dx, m->f);
  FaceLoop(m, t->dx, m->f);
  if (!momentum) {
    StabilisationResidual(m, t->dx, true, m->f);
    if (PlatesCouple(m))
      PetscCall(PlatesMult(m, t->dx, m->f));
  }
  PetscCall(NodeMapReduce(&m->map, m->f, nf));
  if (m->fluid)
    PetscCall(MomentumRows(m, t->x, t->dx, m->f));
  PetscCall(Finish(m, m->f, X, Y));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ProductDiagonal(const Model *m, Vec d)
{
  const FieldSet *fs = &m->c->fields;
  double         *a;

  PetscFunctionBeginUser;
  PetscCall(VecGetArrayWrite(d, &a));
  for (PetscInt k = 0; k < m->map.n_owned * fs->n; k++) {
    const int  q    = fs->field[k % fs->n];
    const bool free = !((m->mask[k / fs->n] >> (k % fs->n)) & 1u);

    a[k] = free && q >= F_VW && q < F_PW ? m->solver->product->diagonal[CL_FLUID_VECTORS * (k / fs->n) + q - F_VW] *
                                               m->col_scale[k] / m->row_scale[k]
                                         : 1.0;
  }
  PetscCall(VecRestoreArrayWrite(d, &a));
  PetscFunctionReturn(PETSC_SUCCESS);
}
