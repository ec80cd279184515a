/* Start of a step: stencils, active nodes and nodal start values on the configuration at t_n. */
#include "clathra/point_reaction.h"
#include "clathra/point_heat.h"
#include "solver.h"

#define AT_AXIS 1e-6        /* of a half-length */
#define UPSTREAM_LEAST 1e-3 /* of V h: with less than this upstream of a node, its k_r stays central */

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
    if (SceneDonor(m->c))
      PetscCall(PetscMalloc1(m->stencil_cap, &m->added->donor));
    if (m->c->stabilisation.saturation_upwind && m->c->fields.phase[PHASE_G] && !m->c->fields.one_pressure)
      PetscCall(PetscCalloc1(PHASE_COUNT * m->stencil_cap, &m->added->spread));
    if (m->c->stabilisation.heat_upwind && m->c->fields.heat && m->c->fields.fluid)
      PetscCall(PetscCalloc1(3 * m->stencil_cap, &m->added->upwind));
    if (m->c->stabilisation.lumped_reaction && m->c->fields.phase[PHASE_G])
      PetscCall(PetscCalloc1(m->stencil_cap, &m->added->lump));
    if (SceneHoldsReaction(m->c))
      PetscCall(PetscMalloc1(m->stencil_cap, &m->added->held));
  }
  if (!SceneHasBeds(m->c)) /* a stage may bring other materials */
    PetscCall(PetscFree(m->beds));
  else if (!m->beds)
    PetscCall(PetscMalloc1(m->stencil_cap, &m->beds));
  if (!SceneExchanges(m->c))
    PetscCall(PetscFree(m->added->exchange));
  else if (!m->added->exchange)
    PetscCall(PetscMalloc1(m->stencil_cap, &m->added->exchange));
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
    const double mass =
        fmax(k == 0 ? f[P_MS][p] + f[P_MH][p] : f[P_MS + 1 + k][p], 0.0); /* a trace may be none (101) */

    s[SUM_M + k] += S * mass;
    for (int i = 0; i < CL_DIM; i++)
      s[SUM_X + fs->at[VectorAt(F_VS, k, 0)] + i] += S * mass * f[VectorAt(P_VS, k, i)][p];
  }
  for (int k = 0; k < PHASE_COUNT; k++) {
    if (!fs->phase[k])
      continue;
    if (k == PHASE_W || !fs->one_pressure)
      s[SUM_X + PlaceP(fs, k)] += VS * Carried(m, p, HeldPressure(fs, P_PW, k), VectorAt(P_GW, k, 0), d);
    s[SUM_W + k] += VS * q->phi * (1.0 - q->Sh) * q->s[k];
  }
  if (fs->heat)
    s[SUM_X + PlaceT(fs)] += S * q->capacity * (Carried(m, p, P_T, P_GT, d) + f[P_BT][p] * d[0] * d[1]); /* (395) */
}

/* (200): diffusion of p_c that carries the saturations with the flow of both fluids, or that of one that flows alone.
 */
static void SpreadOf(const Model *m, PetscInt p, const PointProperties *q, double D[PHASE_COUNT])
{
  const double l[PHASE_COUNT] = {q->kr[PHASE_W] / q->resist[PHASE_W], q->kr[PHASE_G] / q->resist[PHASE_G]},
               all = l[PHASE_W] + l[PHASE_G], both = l[PHASE_W] * l[PHASE_G] / all;
  double h[CL_DIM], Pe[PHASE_COUNT] = {0.0}, shared = 0.0;

  D[PHASE_W] = D[PHASE_G] = 0.0;
  if (!(both > 0.0))
    return;
  CellWidths(m, p, h);
  for (int k = 0; k < PHASE_COUNT; k++) {
    double g[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      g[d] = m->P.f[VectorAt(P_GW, k, d)][p] - q->rho[k] * m->c->gravity[d];
    Drive(m, p, g);
    for (int d = 0; d < CL_DIM; d++)
      Pe[k] += 0.5 * h[d] * fabs(g[d] * q->mobility_slope[k]) / both;
    shared += (1.0 - l[k] / all) * Pe[k];
  }
  for (int k = 0; k < PHASE_COUNT; k++) {
    const double most = fmax(shared, l[k] / all * Pe[k]);

    if (most > 1e-4)
      D[k] = both * (most / tanh(most) - 1.0);
  }
}

/* Conductivity that carries heat with the flow of t_n (293). */
static void UpwindOf(const Model *m, PetscInt p, const PointProperties *q, double K[3])
{
  const Material *mat       = ParticleMaterial(m, p);
  double          a[CL_DIM] = {0.0}, h[CL_DIM];

  for (int k = 0; k < PHASE_COUNT; k++) {
    for (int d = 0; m->c->fields.phase[k] && d < CL_DIM; d++)
      a[d] -= SpecificHeat(mat, k) * q->rho[k] * q->kr[k] / q->resist[k] *
              (m->P.f[VectorAt(P_GW, m->c->fields.one_pressure ? PHASE_W : k, d)][p] - q->rho[k] * m->c->gravity[d]);
  }
  Drive(m, p, a);
  CellWidths(m, p, h);
  HeatUpwind(q->kappa, a, h, K);
}

/* (381) with the faster of both ways at t_n. */
static double HeldOf(const Model *m, PetscInt p, const PointProperties *q)
{
  const double g[CL_DIM] = {m->P.f[P_GT][p], m->P.f[P_GT + 1][p]};
  double       h[CL_DIM], slope;

  EquilibriumPressure(&ParticleMaterial(m, p)->kinetics.equilibrium, m->P.f[P_T][p], &slope);
  CellWidths(m, p, h);
  return ReactionHeld(q->reaction_heat, slope, q->kappa, ReactionWidth(h, g));
}

/* Did the particle's domain begin at the axis? */
static bool SeededAtAxis(const Model *m, PetscInt p)
{
  double l[CL_DIM];

  if (!m->c->axisymmetric)
    return false;
  const double x[CL_DIM] = {ParticleInitialX(&m->P, p, 0), ParticleInitialX(&m->P, p, 1)};
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
    DepositNode(m, p, S, d, q, &sum[I * width]);
    m->V[I] += VS;
    m->Vk[I] += VSk;
    c[NC_M] += VS * q->M;
    c[NC_KAPPA] += VS * q->kappa;
    c[NC_CAPACITY] += S * q->capacity;
    c[NC_REACTION] += VS * q->reaction;
    c[NC_REACTION_HEAT] += VS * q->reaction_heat;
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
      c[NC_P + k] += VS * m->P.f[k == PHASE_G && !m->c->fields.one_pressure ? P_PG : P_PW][p];
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
    for (int k = 0; k < fs->n; k++) {
      const int    q      = fs->field[k];
      const double weight = q < F_PW ? s[SUM_M + q / CL_DIM] : q < F_T ? V : c[NC_CAPACITY];

      x[k] = weight > 0.0 ? s[SUM_X + k] / weight : 0.0;
    }
    for (int k = 0; k < PHASE_COUNT; k++)
      m->w[PHASE_COUNT * I + k] = fmax(s[SUM_W + k] / V, CL_SHARE_FLOOR);
    for (int k = 0; k < NC_COUNT; k++)
      c[k] /= V;
    for (int k = 0; k < PHASE_COUNT; k++) { /* (350), (108) */
      c[NC_DRAG + k] *= m->flow[I];
      c[NC_KR + k] = PetscSqr(c[NC_KR + k] * (Donated(m, k) ? 1.0 : m->flow[I]));
    }
  }
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
    if (m->beds)
      m->beds[p] = (Bedding){ParticleBeds(m->c, &m->P, p), {q.rho[PHASE_W], q.rho[PHASE_G]}};
    if (m->added->spread)
      SpreadOf(m, p, &q, &m->added->spread[PHASE_COUNT * p]);
    if (m->added->upwind)
      UpwindOf(m, p, &q, &m->added->upwind[3 * p]);
    if (m->added->held)
      m->added->held[p] = HeldOf(m, p, &q);
    if (m->added->exchange)
      ExchangeSet(m, p, &q);
    m->conduct[p] = shared ? SceneConductance(m->c, ParticleMaterial(m, p), m->P.f[P_SH][p]) : 1.0;
    ReachExpand(m, p, &r);
    Deposit(m, p, &r, &q, sum);
  }
  PetscCall(NodeMapSum(&m->map, sum, width));
  PetscCall(NodeMapSum(&m->map, m->V, 1));
  PetscCall(NodeMapSum(&m->map, m->Vk, 1));
  PetscCall(NodeMapSum(&m->map, m->coef, NC_COUNT));
  Average(m, sum);
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (35): directions of flow at t_n, and the factors that keep the sum of the weights. */
static PetscErrorCode UpstreamWeights(Model *m)
{
  const FieldSet *fs = &m->c->fields;
  double         *sum;

  PetscFunctionBeginUser;
  if (!m->c->stabilisation.upstream)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscArrayzero(m->added->up, PHASE_COUNT * UP_COUNT * m->map.n_local));
  for (PetscInt I = 0; I < m->map.n_local; I++) {
    for (int f = 0; f < PHASE_COUNT; f++) {
      double J[CL_DIM] = {0.0};

      if (fs->phase[f])
        DarcyFlux(m, I, f, &m->x_n[I * fs->n], J);
      const double size = VectorLength(J);
      for (int d = 0; d < CL_DIM && size > 0.0; d++)
        UpstreamAt(m, I, f)[d] = J[d] / size;
    }
  }
  PetscCall(PetscCalloc1(PHASE_COUNT * m->map.n_local, &sum));
  for (PetscInt p = 0; p < m->P.n; p++) {
    Reach r;

    ReachExpand(m, p, &r);
    for (int a = 0; a < r.n; a++) {
      for (int f = 0; f < PHASE_COUNT; f++)
        sum[PHASE_COUNT * r.node[a] + f] +=
            m->P.f[P_V][p] * r.S[a] * fmax(Upstream(m, p, r.node[a], UpstreamAt(m, r.node[a], f)), 0.0);
    }
  }
  PetscCall(NodeMapSum(&m->map, sum, PHASE_COUNT));
  for (PetscInt k = 0; k < PHASE_COUNT * m->map.n_local; k++) {
    const PetscInt I = k / PHASE_COUNT;

    if (sum[k] > UPSTREAM_LEAST * NodeWidth(m, I) * m->V[I])
      m->added->up[UP_COUNT * k + UP_FACTOR] = m->V[I] / sum[k];
  }
  PetscCall(PetscFree(sum));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* (197) of a face; drag: mean mu/k_a of its nodes at t_n, Pa s/m^2. */
static void AddWall(Model *m, const Reach *r, const Face *f, int phase, double drag)
{
  const double lost = f->ring[0] * f->x[0] * PetscSqr(f->n[0]) / VectorLength(f->n) * drag;

  for (int a = 0; a < r->n; a++) {
    const PetscInt I     = r->node[a];
    const double   share = f->N[a] > 0.0 ? PetscSqr(f->Nr[a]) / f->N[a] : 0.0;

    m->wall[PHASE_COUNT * I + phase] +=
        lost * share * FaceFlow(m, f->particle, I, VectorAt(F_VW, phase, 0)) * FaceShare(m, f->particle, I, phase);
  }
}

/* (195), (197): about an axis the flux through a face goes with 1/r. */
static void RadialFace(Model *m, const Reach *r, Face *f)
{
  double drag[PHASE_COUNT] = {0.0}, sum = 0.0;

  if (!m->c->axisymmetric || !(f->x[0] > 0.0))
    return;
  for (int a = 0; a < r->n; a++) {
    const double *c = &m->coef[r->node[a] * NC_COUNT];

    f->Nr[a] = f->N[a] / (c[NC_RING] * f->x[0]);
    sum += f->N[a];
    for (int k = 0; k < PHASE_COUNT; k++)
      drag[k] += f->N[a] * c[NC_DRAG + k];
  }
  for (int k = 0; m->wall && k < PHASE_COUNT; k++)
    AddWall(m, r, f, k, drag[k] / sum);
}

void ModelFaceProperties(const Model *m, Face *f, int n, const double S[])
{
  PointProperties q;
  const char     *why;

  if ((f->bc[BC_INFLOW] < 0 && f->share == 0.0) || ModelParticleProperties(m, f->particle, &q, &why) != CL_OK)
    return;
  FaceInflow(f, n, S, q.kr);
  WellProperties(&q, f);
}

/* (365): by the flux at t_n. */
static void FaceDirections(const Model *m, const Reach *r, Face *f)
{
  for (int k = 0; k < PHASE_COUNT; k++) {
    double sum[CL_DIM] = {0.0}, J[CL_DIM];

    if (!m->c->fields.phase[k])
      continue;
    for (int a = 0; a < r->n; a++) {
      DarcyFlux(m, r->node[a], k, &m->x_n[r->node[a] * m->c->fields.n], J);
      for (int d = 0; d < CL_DIM; d++)
        sum[d] += FaceWeight(f, a, VectorAt(F_VW, k, d)) * FaceShare(m, f->particle, r->node[a], k) * J[d];
    }
    FaceDirection(m->c, f, k, sum);
  }
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
    PetscCall(Project(m));
    PetscCall(ModelReduceStatus(m, status));
  }
  if (*status == CL_OK) {
    PetscCall(FacesBuild(m->c, &m->grid, &m->P, &m->nface, &m->face));
    if (m->wall)
      PetscCall(PetscArrayzero(m->wall, PHASE_COUNT * m->map.n_local));
    for (PetscInt k = 0; k < m->nface; k++) {
      Face *f = &m->face[k];
      Reach r;

      ReachExpand(m, f->particle, &r);
      RadialFace(m, &r, f);
      ModelFaceProperties(m, f, r.n, r.S);
      if (m->c->stabilisation.outflow)
        FaceDirections(m, &r, f);
      if (f->bc[BC_PLATE] >= 0)
        ModelPlateStiffness(m, f);
    }
    PetscCall(StabilisationBuild(m));
    PetscCall(UpstreamWeights(m));
    PetscCall(DonorBuild(m));
    LumpBuild(m);
  }
  PetscCall(PetscFree(flag));
  PetscCall(PetscLogEventEnd(m->event[EVENT_BEGIN_STEP], 0, 0, 0, 0));
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define ROUND_OFF_P 1e-3 /* of 1 MPa, times Newton's tolerance: round-off of a pressure, with a margin */

/* Mass that a change of 1 MPa stores, moves or turns into hydrate, but no more than there is, unless that is below the
   round-off of what moves or reacts. */
static double MassScale(const FieldSet *fs, const double c[NC_COUNT], int phase, double w, double dt, double h)
{
  const double squeezed = fs->solid ? w / c[NC_M] : 0.0;
  const double moved    = 1e6 * (c[NC_RHO + phase] * (c[NC_STORAGE + phase] + squeezed) +
                              dt * c[NC_LAMBDA + phase] / (h * h) + dt * c[NC_REACTION]);

  return fmax(fmin(moved, c[NC_RHO + phase] * w), ROUND_OFF_P * moved);
}

#define SLIVER 0.05 /* of a cell: emptier nodes are held by the ghost penalty, whose rows do not shrink with them */

#define ROUND_OFF 1e-5 /* of the terms of a fluid's momentum, times Newton's tolerance, with a margin */

/* Row of a fluid's momentum per volume: 1 MPa over a cell, unless that is below the round-off of its terms: of the drag
   of the skeleton's own velocity where permeability is low; of pressures on a node that sees but a sliver, where
   forces shrink with its depth and the volume with the square of that. */
static double FluidScale(const Model *m, PetscInt I, int phase, double h)
{
  const FieldSet *fs = &m->c->fields;
  const double   *c = &m->coef[I * NC_COUNT], dt = m->stage.dt, P = 1e6;
  const double    sliver = sqrt(2.0 * NodeVolume(m, I) / m->V[I]);
  const double    kr     = c[NC_KR + phase];
  double          row    = kr / h * fmax(P, ROUND_OFF * sliver * fmax(P, fabs(c[NC_P + phase]))), v;

  if (!fs->solid)
    return row;
  v = P / h / ((fs->inertia ? c[NC_RHO + phase] / dt : 0.0) + c[NC_M] * dt / (h * h)); /* what 1 MPa brings about */
  for (int d = 0; d < CL_DIM; d++)
    v = fmax(v, fabs(m->stage.x_star[I * fs->n + PlaceVs(fs) + d]));
  return fmax(row, ROUND_OFF * c[NC_DRAG + phase] * m->w[PHASE_COUNT * I + phase] * v);
}

/* Columns: 1 MPa, 1 K, and the velocities that belong to 1 MPa over a cell.  Rows: what such a change makes of each
   balance, so that scaled residuals and updates compare across fields. */
static void NodeScales(const Model *m, PetscInt I, double h, double *row, double *col)
{
  const FieldSet *fs = &m->c->fields;
  const double   *c = &m->coef[I * NC_COUNT], dt = m->stage.dt, P = 1e6, V = m->V[I];
  const double    V_row = fmax(V, SLIVER * NodeVolume(m, I));

  for (int d = 0; d < CL_DIM; d++) {
    if (fs->solid) {
      col[PlaceVs(fs) + d] = P * h / (c[NC_M] * dt);
      row[PlaceVs(fs) + d] = V_row * P / h;
    }
    for (int k = 0; k < PHASE_COUNT; k++) {
      if (!fs->phase[k])
        continue;
      const double kr = c[NC_KR + k], inertia = fs->inertia ? kr * c[NC_RHO + k] / dt : 0.0;

      col[PlaceV(fs, k) + d] = kr * P / h / (inertia + c[NC_DRAG + k] * m->w[PHASE_COUNT * I + k]);
      row[PlaceV(fs, k) + d] = V * FluidScale(m, I, k, h);
    }
  }
  for (int k = 0; k < PHASE_COUNT; k++) {
    if (!fs->phase[k])
      continue;
    const double mass  = RowWeight(m, I, k) * V_row * MassScale(fs, c, k, m->w[PHASE_COUNT * I + k], dt, h);
    col[PlaceP(fs, k)] = P;
    row[PlaceP(fs, k)] = k == PHASE_G && fs->one_pressure ? row[PlaceP(fs, k)] + mass : mass;
  }
  if (fs->heat) {
    col[PlaceT(fs)] = 1.0;
    row[PlaceT(fs)] = V_row * fmax(c[NC_CAPACITY] / dt + c[NC_KAPPA] / (h * h), ROUND_OFF_P * P * c[NC_REACTION_HEAT]);
  }
}

static void Scales(Model *m)
{
  const int n = m->c->fields.n;

  for (PetscInt I = 0; I < m->map.n_local; I++)
    NodeScales(m, I, NodeWidth(m, I), &m->row_scale[I * n], &m->col_scale[I * n]);
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
  Scales(m);
  PetscFunctionReturn(PETSC_SUCCESS);
}
