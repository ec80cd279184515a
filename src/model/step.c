/* Start of a step: stencils, active nodes and nodal start values on the configuration at t_n. */
#include "solver.h"

#define AT_AXIS 1e-6 /* of a half-length */

static bool InsideGrid(const Grid *g, const Stencil *s)
{
  for (int d = 0; d < CL_DIM; d++) {
    for (int k = 0; k < 3; k++) {
      const PetscInt i = s->axis[d].base + k;

      if ((i < 0 || i > g->cells[d]) && (s->axis[d].S[k] != 0.0 || s->axis[d].dS[k] != 0.0))
        return false;
    }
  }
  return true;
}

/* Stencils of all particles, and the flags of the nodes they reach. */
static PetscErrorCode BuildStencils(Model *m, unsigned char *flag)
{
  const Grid *g = &m->grid;
  int         n, k[CL_NODES][CL_DIM];

  PetscFunctionBeginUser;
  if (m->P.n > m->stencil_cap) {
    PetscCall(FreeParticleArrays(m));
    m->stencil_cap = m->P.cap;
    PetscCall(PetscMalloc1(m->stencil_cap, &m->stencil));
    PetscCall(PetscMalloc1(m->stencil_cap, &m->conduct));
    PetscCall(PetscMalloc1(m->stencil_cap, &m->order));
    PetscCall(AdditionsReserve(m));
  }
  if (!SceneSharesFlow(m->c)) /* a stage may bring other materials */
    PetscCall(PetscFree(m->beds));
  else if (!m->beds)
    PetscCall(PetscMalloc1(m->stencil_cap, &m->beds));
  PetscCall(AdditionsOfStage(m));
  for (PetscInt p = 0; p < m->P.n; p++) {
    Stencil *s = &m->stencil[p];

    ParticleStencil(m->c, g, &m->P, p, s);
    if (!InsideGrid(g, s)) {
      ModelNoteFailure(m, CL_LEFT_GRID, "a particle's domain leaves the background grid", p);
      continue;
    }
    n = StencilNodes(s, k);
    for (int a = 0; a < n; a++) {
      PetscInt ij[CL_DIM];

      for (int d = 0; d < CL_DIM; d++)
        ij[d] = s->axis[d].base + k[a][d];
      flag[GridPadded(g, ij)] = 1;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Sums of one particle into its nodes: masses, (2) for the unknowns of the set, phi S_pi. */
enum { SUM_M = 0, SUM_W = SUM_M + 3, SUM_X = SUM_W + 2, SUM_COUNT = SUM_X + F_COUNT };

/* Weight V S (or capacity S) times the particle's value, carried to the node by its gradient. */
static inline double Carried(const Model *m, PetscInt p, int value, int gradient, const double d[CL_DIM])
{
  double *const *f = (double *const *)m->P.f;

  double v = f[value][p];

  for (int i = 0; i < CL_DIM; i++)
    v += f[gradient + i][p] * d[i];
  return v;
}

/* Weight per volume of a particle's pressures at its nodes (449). */
static double Compliance(const FieldSet *fs, const PointProperties *q)
{
  return fs->phase[PHASE_G] ? 1.0 : fmax(q->compressibility, CL_LEAST_COMPLIANCE);
}

static void DepositNode(const Model *m, PetscInt p, double S, const double d[CL_DIM], const PointProperties *q,
                        double *s)
{
  const FieldSet *fs       = &m->c->fields;
  double *const  *f        = (double *const *)m->P.f;
  const double    VS       = f[P_V][p] * S;
  const bool      there[3] = {fs->solid, fs->phase[PHASE_W], fs->phase[PHASE_G]};

  for (int k = 0; k < 3; k++) {
    if (!there[k])
      continue;
    const double mass = ParticlePhaseMass(&m->P, p, k);

    s[SUM_M + k] += S * mass;
    for (int i = 0; i < CL_DIM; i++)
      s[SUM_X + fs->at[VectorAt(F_VS, k, 0)] + i] +=
          S * mass *
          (fs->solid ? Carried(m, p, VectorAt(P_VS, k, i), VectorAt(P_GV, i, 0), d) : f[VectorAt(P_VS, k, i)][p]);
  }
  for (int k = 0; k < PHASE_COUNT; k++) {
    if (!fs->phase[k])
      continue;
    s[SUM_X + PlaceP(fs, k)] += VS * Compliance(fs, q) * Carried(m, p, P_PW + k, VectorAt(P_GW, k, 0), d);
    s[SUM_W + k] += VS * q->phi * (1.0 - q->Sh) * q->s[k];
  }
  if (fs->heat)
    s[SUM_X + PlaceT(fs)] += S * q->capacity * Carried(m, p, P_T, P_GT, d);
  for (int k = 0; fs->heat && k < CL_MIXED; k++) /* mixed derivatives of T (395), (446) */
    s[SUM_X + PlaceT(fs)] += MixedProduct(k, S * q->capacity * f[P_BT + k][p], d);
}

/* Did the particle's domain begin at the axis? */
static bool SeededAtAxis(const Model *m, PetscInt p)
{
  double x[CL_DIM], l[CL_DIM];

  if (!m->c->axisymmetric)
    return false;
  ParticleInitialPlace(&m->P, p, x);
  ParticlesInitialHalfLength(m->c, m->P.i[PI_REGION][p], x, l);
  return x[0] < l[0] * (1.0 + AT_AXIS);
}

static void Deposit(const Model *m, PetscInt p, const Reach *r, const PointProperties *q, double *sum)
{
  const Grid  *g     = &m->grid;
  const int    width = SUM_X + m->c->fields.n;
  const double V = m->P.f[P_V][p], weight = m->conduct[p];
  const bool   axis = SeededAtAxis(m, p);
  double       at[CL_DIM]; /* where the particle's values belong */

  for (int d = 0; d < CL_DIM; d++)
    at[d] = AxisCentroid(&m->stencil[p].axis[d], &g->line[d]);
  for (int a = 0; a < r->n; a++) {
    const PetscInt I = r->node[a];
    const double   S = r->S[a], VS = V * S, VSk = VS * weight;
    double         d[CL_DIM], *c = &m->coef[I * NC_COUNT];

    for (int k = 0; k < CL_DIM; k++)
      d[k] = GridNode(g, k, m->map.ij[I][k]) - at[k];
    ParticleCarry(&m->P, p, d);
    DepositNode(m, p, S, d, q, &sum[I * width]);
    m->V[I] += VS;
    m->Vk[I] += VSk;
    for (int k = 0; m->beds && k < CL_SYMMETRIC; k++)
      m->share[I].A[k] += VSk * m->beds[p].A.A[k];
    c[NC_M] += VS * q->M;
    c[NC_KAPPA] += VS * q->kappa;
    c[NC_CAPACITY] += S * q->capacity;
    c[NC_COMPLIANCE] += VS * Compliance(&m->c->fields, q);
    c[NC_REACTION] += VS * q->reaction;
    c[NC_REACTION_HEAT] += VS * q->reaction_heat;
    c[NC_SH] += VS * q->Sh;
    if (VS > m->most[I]) {
      m->most[I]     = VS;
      m->material[I] = ParticleMaterial(m, p);
      m->hydrate[I]  = q->Sh;
    }
    if (m->c->axisymmetric) {
      c[NC_RING] += V * r->H[a];
      c[NC_AXIS] += axis ? VS : 0.0;
    }
    for (int k = 0; k < PHASE_COUNT; k++) {
      if (!m->c->fields.phase[k])
        continue;
      c[NC_LAMBDA + k] += VS * q->rho[k] * q->kr[k] / q->resist[k];
      c[NC_RHO + k] += VS * q->rho[k];
      c[NC_P + k] += VS * m->P.f[P_PW + k][p];
      c[NC_STORAGE + k] += VS * q->storage[k];
      c[NC_DRAG + k] += VSk * q->resist[k];
      c[NC_KR + k] += (Donated(m, k) ? VS : VSk) * sqrt(q->kr[k]);
    }
  }
}

static void Average(Model *m, const double *sum)
{
  const FieldSet *fs = &m->c->fields;

  for (PetscInt I = 0; I < m->map.n_local; I++) {
    const double *s = &sum[I * (SUM_X + fs->n)], V = m->V[I];
    double       *c = &m->coef[I * NC_COUNT], *x = &m->x_n[I * fs->n];

    m->flow[I] = V / m->Vk[I];
    if (m->share) {
      const Beds mean = BedsMean(m->share[I].A, m->Vk[I]);

      m->share[I] = BedsInverse(&mean);
    }
    for (int k = 0; k < fs->n; k++) {
      const int    q      = fs->field[k];
      const double weight = q < F_PW ? s[SUM_M + q / CL_DIM] : q < F_T ? c[NC_COMPLIANCE] : c[NC_CAPACITY];

      x[k] = weight > 0.0 ? s[SUM_X + k] / weight : 0.0;
    }
    for (int k = 0; k < PHASE_COUNT; k++)
      m->w[PHASE_COUNT * I + k] = fmax(s[SUM_W + k] / V, CL_SHARE_FLOOR);
    for (int k = 0; k < NC_COUNT; k++)
      c[k] /= V;
    for (int k = 0; k < PHASE_COUNT; k++) { /* k_r of a node (108) with shares of layers (350) */
      c[NC_DRAG + k] *= m->flow[I];
      c[NC_KR + k] = PetscSqr(c[NC_KR + k] * RootFactor(m, I, k));
    }
  }
}

/* What drives the fluids of particles through their layers. */
static PetscErrorCode Layers(Model *m)
{
  Beds *A;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->share));
  if (!m->beds)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(m->map.n_local, &m->share));
  PetscCall(PetscMalloc1(m->P.n, &A));
  PetscCall(ParticlesDrive(m->c, &m->grid, &m->map, &m->P, A));
  for (PetscInt p = 0; p < m->P.n; p++)
    m->beds[p].A = A[p];
  PetscCall(PetscFree(A));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (88); the particles of several ranks may have parts in a cell. */
static PetscErrorCode Cells(Model *m)
{
  const bool ring = m->c->axisymmetric;
  double    *moment;

  PetscFunctionBeginUser;
  PetscCall(PetscFree(m->cell));
  if (!SceneTakesCellMeans(m->c))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(m->map.n_local, &m->cell));
  PetscCall(PetscCalloc1(m->map.n_local * CELL_MOMENTS, &moment));
  for (PetscInt p = 0; p < m->P.n; p++) {
    const double V = m->P.f[P_V][p];
    AxisParts    part[CL_DIM], over[CL_DIM];
    PetscInt     cell[CL_CORNERS];
    double       share[CL_CORNERS];

    StencilCells(&m->stencil[p], &m->grid, &m->map, part, cell, share);
    memcpy(over, part, sizeof(part));
    if (ring)
      over[0] = StencilRing(&m->stencil[p], &m->grid, &part[0]);
    for (int c = 0; c < CL_CORNERS; c++) {
      if (cell[c] < 0)
        continue;
      double *sum = &moment[cell[c] * CELL_MOMENTS];
      for (int k = 0; k < CELL_MEAN; k++) {
        sum[k] += V * PartMoment(part, c, k);
        if (ring)
          sum[CELL_MOMENTS - CELL_MEAN + k] += V * PartMoment(over, c, k);
      }
    }
  }
  PetscCall(NodeMapSum(&m->map, moment, CELL_MOMENTS));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    double h[CL_DIM];

    if (!(moment[I * CELL_MOMENTS] > 0.0))
      continue; /* behind it no particle has a part */
    for (int d = 0; d < CL_DIM; d++)
      h[d] = LinesWidth(&m->grid.line[d], m->map.ij[I][d]);
    CellMeanOf(&moment[I * CELL_MOMENTS], h, ring, &m->cell[I]);
  }
  PetscCall(PetscFree(moment));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Project(Model *m)
{
  const int   width  = SUM_X + m->c->fields.n;
  const bool  shared = SceneSharesFlow(m->c);
  double     *sum;
  const char *why;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(m->map.n_local * width, &sum));
  PetscCall(PetscArrayzero(m->V, m->map.n_local));
  PetscCall(PetscArrayzero(m->Vk, m->map.n_local));
  PetscCall(PetscArrayzero(m->coef, m->map.n_local * NC_COUNT));
  PetscCall(PetscArrayzero(m->most, m->map.n_local));
  for (PetscInt p = 0; p < m->P.n; p++) {
    PointProperties q;
    Reach           r;
    const ClStatus  status = ModelParticleProperties(m, p, &q, &why);

    if (status != CL_OK) {
      ModelNoteFailure(m, status, why, p);
      continue;
    }
    for (int k = 0; m->beds && k < PHASE_COUNT; k++)
      m->beds[p].rho[k] = q.rho[k];
    AdditionsSet(m, p, &q);
    m->conduct[p] = shared ? SceneConductance(m->c, ParticleMaterial(m, p), m->P.f[P_SH][p]) : 1.0;
    ReachExpand(m, p, &r);
    Deposit(m, p, &r, &q, sum);
  }
  PetscCall(NodeMapSum(&m->map, sum, width));
  PetscCall(NodeMapSum(&m->map, m->V, 1));
  PetscCall(NodeMapSum(&m->map, m->Vk, 1));
  if (m->share)
    PetscCall(NodeMapSum(&m->map, m->share->A, CL_SYMMETRIC));
  PetscCall(NodeMapSum(&m->map, m->coef, NC_COUNT));
  Average(m, sum);
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define TILE 16 /* nodes along x whose rows of J2 stay in the cache */

/* Particles by their first node, tile by tile. */
static PetscErrorCode Order(Model *m)
{
  const Grid    *g    = &m->grid;
  const PetscInt keys = (g->gm[0] / TILE + 1) * TILE * (GridPaddedSize(g) / g->gm[0]);
  PetscInt      *first;

  PetscFunctionBeginUser;
  PetscCall(PetscCalloc1(keys + 1, &first));
  for (int pass = 0; pass < 2; pass++) {
    for (PetscInt p = 0; p < m->P.n; p++) {
      const PetscInt i = m->stencil[p].axis[0].base - g->gs[0];
      PetscInt       k = 0;

      for (int d = CL_DIM - 1; d > 0; d--)
        k = k * g->gm[d] + m->stencil[p].axis[d].base - g->gs[d];
      k = (i / TILE * (GridPaddedSize(g) / g->gm[0]) + k) * TILE + i % TILE;

      if (pass == 0)
        first[k + 1]++;
      else
        m->order[first[k]++] = p;
    }
    for (PetscInt k = 0; pass == 0 && k < keys; k++)
      first[k + 1] += first[k];
  }
  PetscCall(PetscFree(first));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelBeginStep(Model *m, ClStatus *status)
{
  unsigned char *flag;
  bool           changed;

  PetscFunctionBeginUser;
  PetscCall(PetscLogEventBegin(m->event[EVENT_BEGIN_STEP], 0, 0, 0, 0));
  m->failure.status = CL_OK;
  PreconditionerRenew(m);
  PetscCall(PetscCalloc1(GridPaddedSize(&m->grid), &flag));
  PetscCall(BuildStencils(m, flag));
  PetscCall(ModelReduceStatus(m, status));
  if (*status == CL_OK) {
    PetscCall(Order(m));
    PetscCall(NodeMapUpdate(&m->grid, flag, &m->map, &changed));
    if (changed)
      PetscCall(ModelResizeNodal(m));
    PetscCall(Cells(m));
    PetscCall(Layers(m));
    PetscCall(Project(m));
    PetscCall(ModelReduceStatus(m, status));
  }
  if (*status == CL_OK) {
    PetscCall(FacesBuild(m->c, &m->grid, &m->P, &m->nface, &m->face));
    PetscCall(DonorBuild(m)); /* before the faces: the wall of a well has its shares (197) */
    PetscCall(FacesStart(m));
    PetscCall(StabilisationBuild(m));
    PetscCall(UpwindLimit(m));
    ChordsBuild(m);
  }
  PetscCall(PetscFree(flag));
  PetscCall(PetscLogEventEnd(m->event[EVENT_BEGIN_STEP], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode ModelBeginStage(Model *m, const Stage *s)
{
  PetscFunctionBeginUser;
  m->stage     = *s;
  m->evaluated = false;
  BcValuesEvaluate(m->c, s->t, &m->bc);
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    m->mask[I] = 0;
    PlaneConditions(m->c, &m->grid, &m->bc, m->map.ij[I], m->coef[I * NC_COUNT + NC_AXIS] > 0.0, &m->mask[I],
                    &m->fixed[I * m->c->fields.n]);
  }
  ScalesBuild(m);
  PetscFunctionReturn(PETSC_SUCCESS);
}
