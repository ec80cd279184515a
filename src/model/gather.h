/* Private to model/: what passes between nodes and one particle. */
#pragma once

#include "additions.h"

/* A particle's nodes with their values; H only about an axis; M, K are G, H as the motion sees them (160); B (88) only
   with mean dilatation. */
typedef struct {
  int      n;
  PetscInt node[CL_NODES];
  double   S[CL_NODES], G[CL_NODES][CL_DIM], H[CL_NODES], B[CL_NODES][CL_DIM];
  const double (*M)[CL_DIM], *K;
  double mixed[CL_NODES][CL_DIM], mixed_hoop[CL_NODES];
} Reach;

/* (160), then (88) */
static inline void CellMotion(const Model *m, PetscInt p, Reach *r)
{
  const Stencil *s    = &m->stencil[p];
  const bool     ring = m->c->axisymmetric;
  PetscInt       cell[CL_DIM];
  double         h[CL_DIM];

  for (int d = 0; d < CL_DIM; d++) {
    cell[d] = s->axis[d].base + s->cell[d];
    h[d]    = LinesWidth(&m->grid.line[d], cell[d]);
  }
  const double radius = GridNode(&m->grid, 0, cell[0]), share = m->c->mean_strain;
  const double mean = m->c->mean_dilatation ? (1.0 - share) / (ring ? CL_DIM + 1 : CL_DIM) : 0.0;

  for (int a = 0; a < r->n; a++) {
    PetscInt i[CL_DIM];
    double   Q[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      i[d] = m->map.ij[r->node[a]][d] - cell[d];
    const double hoop = CellGradient(h, ring, i, radius, Q), beyond = ring ? hoop - r->H[a] : 0.0;

    for (int d = 0; d < CL_DIM; d++) {
      r->mixed[a][d] = r->G[a][d] + share * (Q[d] - r->G[a][d]);
      r->B[a][d]     = mean * (Q[d] - r->G[a][d]);
    }
    r->mixed_hoop[a] = ring ? r->H[a] + share * beyond : 0.0;
    r->B[a][0] += mean * beyond;
  }
  r->M = r->mixed;
  r->K = r->mixed_hoop;
}

static inline void ReachExpand(const Model *m, PetscInt p, Reach *r)
{
  r->n = StencilExpand(&m->stencil[p], &m->grid, &m->map, r->node, r->S, r->G, r->H);
  r->M = r->G;
  r->K = r->H;
  if (m->c->mean_dilatation || m->c->mean_strain > 0.0)
    CellMotion(m, p, r);
}

/* Gradient and hoop strain of what moves with the nodes, u: of each of the particle's nodes. */
static inline void MotionGradient(const Model *m, const Reach *r, double (*u)[CL_DIM], double g[MOTION_COUNT])
{
  double more = 0.0;

  for (int k = 0; k < MOTION_COUNT; k++)
    g[k] = 0.0;
  for (int a = 0; a < r->n; a++) {
    for (int i = 0; i < CL_DIM; i++) {
      for (int j = 0; j < CL_DIM; j++)
        g[VectorAt(0, i, j)] += u[a][i] * r->M[a][j];
    }
    if (m->c->axisymmetric)
      g[MOTION_HOOP] += u[a][0] * r->K[a];
    if (m->c->mean_dilatation)
      more += VectorDot(u[a], r->B[a]);
  }
  for (int d = 0; d < CL_DIM; d++)
    g[VectorAt(0, d, d)] += more;
  if (m->c->axisymmetric)
    g[MOTION_HOOP] += more;
}

/* Weights that carry the particle's middle along: S in the plane, the plain average about an axis. */
static inline double MotionWeight(const Model *m, PetscInt p, const Reach *r, int a)
{
  return m->c->axisymmetric ? r->H[a] * m->stencil[p].r : r->S[a];
}

static inline const Material *ParticleMaterial(const Model *m, PetscInt p)
{
  return &m->c->material[m->c->region[m->P.i[PI_REGION][p]].material];
}

/* Weight of the projection (20): volume times permeability. */
static inline double ConductingVolume(const Model *m, PetscInt p)
{
  return m->P.f[P_V][p] * m->conduct[p];
}

/* (350) over S_I: 1 where all particles of the node are as permeable. */
static inline double LayerWeight(const Model *m, PetscInt p, PetscInt I)
{
  return m->conduct[p] * m->flow[I];
}

/* What nodes and particles exchange, and rows of the tangent, are whole numbers of these, so that sums of them are
   vector code whatever the fields.  As wide as a register: of wider ones the compiler keeps what it sums in memory. */
#ifdef __AVX512F__
  #define LANES 8
#else
  #define LANES 4
#endif
typedef double Lanes __attribute__((vector_size(LANES * sizeof(double)), may_alias, aligned(sizeof(double))));

/* Model.give, what a node holds for its particles: they sum it with S, what stands from GIVE_GRAD on with G. */
/* So many numbers in whole Lanes, whatever their width. */
#define WHOLE_LANES(n) (((n) + 7) / 8 * 8)
enum {
  GIVE_SCALARS = PHASE_COUNT + 1,
  GIVE_SCALAR  = 0,                          /* p_w, p_g (Pa), T (K) less those at t_n */
  GIVE_START   = GIVE_SCALAR + GIVE_SCALARS, /* those at t_n */
  GIVE_U       = GIVE_START + GIVE_SCALARS,  /* displacement of the step, m */
  GIVE_J       = GIVE_U + CL_DIM,            /* Darcy fluxes times V/Vk (350), m/s */
  GIVE_PROJ    = GIVE_J + CL_FLUID_VECTORS,  /* projected pressure gradients, Pa/m */
  GIVE_GRAD    = WHOLE_LANES(GIVE_PROJ + CL_FLUID_VECTORS),
  GIVE_MOTION  = GIVE_GRAD + GIVE_SCALARS, /* after p_w, p_g, T: displacement */
  GIVE_COUNT   = WHOLE_LANES(GIVE_MOTION + CL_DIM)
};

/* Of a fluid: OUT_MI, once more with the weight, OUT_G, OUT_D. */
enum { FLUID_MI = 0, FLUID_MI2, FLUID_G, FLUID_D = FLUID_G + CL_DIM, FLUID_COUNT };

/* Model.take, what particles have added at a node: with S, what stands from TAKE_GRAD on with G. */
enum {
  TAKE_M     = 0,                        /* OUT_M */
  TAKE_DM    = TAKE_M + 1 + PHASE_COUNT, /* OUT_DM */
  TAKE_C     = TAKE_DM + PHASE_COUNT,    /* OUT_C, OUT_Q */
  TAKE_ROOT  = TAKE_C + 2,               /* OUT_ROOT with V and the layer's weight (108) */
  TAKE_A     = TAKE_ROOT + PHASE_COUNT,  /* OUT_A */
  TAKE_FLUID = TAKE_A + CL_DIM,          /* of each fluid FLUID_... with the layer's weight (350), or (333) */
  TAKE_GRAD  = WHOLE_LANES(TAKE_FLUID + PHASE_COUNT * FLUID_COUNT), /* tested with G in the rows of v_s ... */
  TAKE_MASS  = TAKE_GRAD + CL_DIM,                                  /* ... of the fluids' masses ... */
  TAKE_HEAT  = TAKE_MASS + PHASE_COUNT,                             /* ... and of T */
  TAKE_COUNT = WHOLE_LANES(TAKE_HEAT + 1)
};

/* How far a particle lies upstream of a node, against the direction of flow there, m; negative downstream. */
static inline double Upstream(const Model *m, PetscInt p, PetscInt I, const double direction[CL_DIM])
{
  double s = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    s += direction[d] * (GridNode(&m->grid, d, m->map.ij[I][d]) - m->P.f[P_X + d][p]);
  return s;
}

/* omega_Ip (332): 1 where all nodes of the particle are as mobile. */
static inline double DonorShare(const Model *m, PetscInt p, PetscInt I)
{
  const Donor *at = &m->added->donor[p];

  return at->base + fmax(-Upstream(m, p, I, at->up), 0.0);
}

static inline bool Donated(const Model *m, int f)
{
  return m->added->donor && f == PHASE_G;
}

/* Is a particle's share in the root of k_r at its nodes (108) that of the layer's weight, not (35) or (359)? */
static inline bool LayerRoot(const Model *m, int f)
{
  return !m->c->stabilisation.upstream && !Donated(m, f);
}

/* The node's factor in both. */
static inline double NodeShare(const Model *m, PetscInt I, int f)
{
  return Donated(m, f) ? m->added->source[2 * I] : m->flow[I];
}

/* Share of a node's flux of a fluid that goes through an open face of the particle: (350), of gas (333) without
   omega. */
static inline double FaceShare(const Model *m, PetscInt p, PetscInt I, int f)
{
  return m->conduct[p] * NodeShare(m, I, f);
}

/* (197): what the wall of a well adds to the drag of a node's flow along axis i, of this rank's faces, Pa s m. */
static inline double WallDrag(const Model *m, PetscInt I, int f, int i)
{
  return m->wall && i == 0 ? m->wall[PHASE_COUNT * I + f] : 0.0;
}

/* W_Ip/S_I of a fluid: (350), of gas (333). */
static inline double FlowWeight(const Model *m, PetscInt p, PetscInt I, int f)
{
  return Donated(m, f) ? DonorShare(m, p, I) * FaceShare(m, p, I, f) : LayerWeight(m, p, I);
}

/* Weight of a node's projected gradient in the bracket of (19): S_I, of gas (334). */
static inline double ProjectedShare(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  return Donated(m, f) ? S * DonorShare(m, p, I) * m->coef[I * NC_COUNT + NC_KR + f] / m->added->donor[p].kr : S;
}

/* v := A v where particle p has beds (306). */
static inline void Drive(const Model *m, PetscInt p, double v[CL_DIM])
{
  if (m->beds)
    BedsDrive(&m->beds[p].A, v);
}

/* rho b of a fluid of particle p with beds at t_n, N/m^3. */
static inline void BedsWeight(const Model *m, PetscInt p, int f, double w[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    w[d] = m->beds[p].rho[f] * m->bc.gravity[d];
}

/* Component of the store that holds the pressure of a fluid; first is that of the water, P_PW or P_PW0. */
static inline int HeldPressure(const FieldSet *fs, int first, int f)
{
  return fs->one_pressure ? first : first + f;
}

/* Share of water in the open pores at t_n. */
static inline double ParticleSw(const Model *m, PetscInt p)
{
  return m->P.f[P_SW] ? m->P.f[P_SW][p] / (1.0 - m->P.f[P_SH][p]) : 0.0;
}

/* Weight of a fluid's mass balance in its row: 1, or with one pressure 1/rho_pi, so that the sum is the balance of
   volume (34). */
static inline double RowWeight(const Model *m, PetscInt I, int phase)
{
  return m->c->fields.one_pressure ? 1.0 / m->coef[I * NC_COUNT + NC_RHO + phase] : 1.0;
}

/* Where the mass balance of a fluid at a node is gathered. */
static inline double *MassRow(const Model *m, double *f, PetscInt I, int phase)
{
  const FieldSet *fs = &m->c->fields;

  return fs->one_pressure ? &m->mass_row[PHASE_COUNT * I + phase] : &f[I * fs->n + PlaceP(fs, phase)];
}

/* The same for the row of any unknown. */
static inline double *RowOf(const Model *m, double *f, PetscInt I, int q)
{
  const bool mass = q == F_PW || q == F_PG;

  if (m->fluid && q >= F_VW && q < F_PW)
    return &m->fluid[PHASE_COUNT * I + (q - F_VW) / CL_DIM].F[(q - F_VW) % CL_DIM];
  return mass ? MassRow(m, f, I, q - F_PW) : &f[I * m->c->fields.n + m->c->fields.at[q]];
}

/* What a face of particle p at node I adds to row q is weighted with besides: (350) in (16). */
static inline double FaceFlow(const Model *m, PetscInt p, PetscInt I, int q)
{
  return q >= F_VW && q < F_PW ? FlowWeight(m, p, I, (q - F_VW) / CL_DIM) : 1.0;
}

static inline double RowWeightOf(const Model *m, PetscInt I, int q)
{
  return q == F_PW || q == F_PG ? RowWeight(m, I, q - F_PW) : 1.0;
}

/* Widths of a particle's cell, m. */
static inline void CellWidths(const Model *m, PetscInt p, double h[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    h[d] = LinesWidth(&m->grid.line[d], m->stencil[p].axis[d].base + m->stencil[p].cell[d]);
}

/* Volume of a full cell about a node, m^3. */
static inline double NodeVolume(const Model *m, PetscInt I)
{
  const PetscInt *ij = m->map.ij[I];
  const double    h0 = LinesAround(&m->grid.line[0], ij[0]), r = GridNode(&m->grid, 0, ij[0]);
  double          V = h0;

  for (int d = 1; d < CL_DIM; d++)
    V *= LinesAround(&m->grid.line[d], ij[d]);
  return V * (m->c->axisymmetric ? 2.0 * M_PI * fmax(r, 0.25 * h0) : 1.0);
}

/* The smallest cell width at a node, m. */
static inline double NodeWidth(const Model *m, PetscInt I)
{
  double h = INFINITY;

  for (int d = 0; d < CL_DIM; d++)
    h = fmin(h, LinesLess(&m->grid.line[d], m->map.ij[I][d]));
  return h;
}

/* Darcy flux of a fluid at a node (19). */
static inline void DarcyFlux(const Model *m, PetscInt I, int f, const double *xI, double J[CL_DIM])
{
  const FieldSet *fs = &m->c->fields;
  const double    w = m->w[PHASE_COUNT * I + f], *v = &xI[PlaceV(fs, f)];

  for (int i = 0; i < CL_DIM; i++)
    J[i] = w * (fs->solid ? v[i] - xI[PlaceVs(fs) + i] : v[i]);
}

static inline double *UpstreamAt(const Model *m, PetscInt I, int f)
{
  return &m->added->up[UP_COUNT * (PHASE_COUNT * I + f)];
}

/* Weight of a particle in k_r of a node (108): (350), or what looks upstream (35). */
static inline double MobilityWeight(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  if (!m->c->stabilisation.upstream)
    return Donated(m, f) ? S : S * LayerWeight(m, p, I);
  const double *u = UpstreamAt(m, I, f);

  return u[UP_FACTOR] > 0.0 ? S * u[UP_FACTOR] * fmax(Upstream(m, p, I, u), 0.0) : S;
}

/* ... of all in the node's k_r (108). */
static inline double MobilityShare(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  return MobilityWeight(m, p, I, f, S) * m->P.f[P_V][p] / m->V[I];
}

/* Acceleration of the velocity at place k of a node's block; quasi-static: none. */
static inline void Rate(const Model *m, PetscInt I, const double *x, int k, double rate[CL_DIM])
{
  const PetscInt q = I * m->c->fields.n + k;

  for (int i = 0; i < CL_DIM; i++)
    rate[i] = m->c->fields.inertia ? (x[q + i] - m->stage.x_star[q + i]) / m->stage.dt : 0.0;
}

/* ... weighted, less gravity. */
static inline void Acceleration(const Model *m, PetscInt I, const double *x, int k, double weight, double acc[CL_DIM])
{
  Rate(m, I, x, k, acc);
  for (int i = 0; i < CL_DIM; i++)
    acc[i] = weight * acc[i] - m->bc.gravity[i];
}

/* What of the skeleton's acceleration less gravity beds take off a fluid (308): (A - 1) of it. */
static inline void BedsHold(const Model *m, PetscInt p, PetscInt I, const double *x, double across[CL_DIM])
{
  const FieldSet *fs = &m->c->fields;
  double          s[CL_DIM];

  for (int i = 0; i < CL_DIM; i++)
    s[i] = -m->bc.gravity[i];
  if (fs->solid)
    Acceleration(m, I, x, PlaceVs(fs), 1.0, s);
  for (int i = 0; i < CL_DIM; i++)
    across[i] = s[i];
  BedsDrive(&m->beds[p].A, across);
  for (int i = 0; i < CL_DIM; i++)
    across[i] -= s[i];
}

/* ... of a fluid of particle p with (310). */
static inline void FluidAcceleration(const Model *m, PetscInt p, PetscInt I, const double *x, int f, double acc[CL_DIM])
{
  double across[CL_DIM];

  Acceleration(m, I, x, PlaceV(&m->c->fields, f), FlowWeight(m, p, I, f), acc);
  if (!m->beds)
    return;
  BedsHold(m, p, I, x, across);
  for (int i = 0; i < CL_DIM; i++)
    acc[i] += across[i];
}

/* Own value at t_n of unknown q = F_PW, F_PG, F_T. */
static inline double OwnValue(const Model *m, PetscInt p, int q)
{
  return m->P.f[q == F_T ? P_T : HeldPressure(&m->c->fields, P_PW, q - F_PW)][p];
}

/* Nodal less own value at t_n of unknown q = F_PW, F_PG, F_T. */
static inline double Shift(const Model *m, PetscInt p, const Reach *r, int q)
{
  const FieldSet *fs = &m->c->fields;
  double          shift;

  if (fs->at[q] < 0)
    return 0.0;
  shift = -OwnValue(m, p, q);
  for (int a = 0; a < r->n; a++)
    shift += r->S[a] * m->x_n[r->node[a] * fs->n + fs->at[q]];
  return shift;
}

/* Nodes that one couples with: within two of it, itself in the middle. */
#define RADIUS 2
#define WIDTH (2 * RADIUS + 1)
enum { NEIGHBOURS = CL_DIM == 2 ? WIDTH * WIDTH : WIDTH * WIDTH * WIDTH };

/* Local number of neighbour k; -1 where there is none that this rank knows. */
static inline PetscInt ModelNeighbour(const Model *m, PetscInt I, int k)
{
  PetscInt ij[CL_DIM];

  for (int d = 0; d < CL_DIM; k /= WIDTH, d++)
    ij[d] = m->map.ij[I][d] + k % WIDTH - RADIUS;
  return BoxHolds(m->grid.gs, m->grid.gm, ij) ? m->map.index[GridPadded(&m->grid, ij)] : -1;
}

/* Which neighbour of I is K? */
static inline PetscInt ModelOffset(const Model *m, PetscInt I, PetscInt K)
{
  PetscInt k = 0;

  for (int d = CL_DIM - 1; d >= 0; d--)
    k = k * WIDTH + m->map.ij[K][d] - m->map.ij[I][d] + RADIUS;
  return k;
}

/* What a Jacobian is assembled for. */
typedef struct {
  FieldSet       fs;                   /* unknowns and rows */
  bool           reduced;              /* the reduced matrix, else J2 */
  bool           eliminated;           /* fs lacks the fluid velocities of the scene */
  bool           force;                /* OUT_A counts in the rows of v_s */
  bool           fixed_stress;         /* (174) in the mass rows */
  int            nout, out[OUT_COUNT]; /* outputs that the rows read */
  double *const *place;                /* J2: blocks of the neighbours of each node; else ... */
  double        *value;                /* ... [n_local][NEIGHBOURS][fs.n][fs.n] of the reduced matrix */
} Assembly;

/* Where rows of node I and columns of node K add up: fs.n x fs.n, by rows, unscaled. */
static inline double *AssemblyBlock(const Model *m, const Assembly *to, PetscInt I, PetscInt K)
{
  const size_t k = (size_t)(I * NEIGHBOURS + ModelOffset(m, I, K));

  return to->place ? to->place[k] : &to->value[k * (size_t)(to->fs.n * to->fs.n)];
}

/* Rows of the tangent as long as the unknowns of all nodes of a particle or face, node by node, zeros up to a multiple
   of 8, so that sums of them are vector code whatever the number of fields. */
#define ROW_MOST WHOLE_LANES(CL_NODES *F_COUNT)

static inline int RowLength(int unknowns)
{
  return WHOLE_LANES(unknowns);
}

/* One node as a particle or face sees it; NS (by fluid and component) and NU stand for S in the Darcy fluxes, where it
   is (350) or (333), and in the displacement. */
typedef struct {
  double        S, NS[PHASE_COUNT][CL_DIM], NU, K;
  const double *G, *M, *w, *B; /* B: null without mean dilatation */
} NodeWeights;

/* d in/d(unknowns). */
typedef struct {
  int    unknowns, length; /* unknowns: 0 before the first SlopesBegin */
  double in[IN_COUNT][ROW_MOST] __attribute__((aligned(64)));
} Slopes;

/* anew: with mean dilatation; else what SlopesAdd wrote for other nodes has the places that it writes again. */
void SlopesBegin(int unknowns, bool anew, Slopes *s);
/* Those of the node whose unknowns are `first` ... first + fs->n - 1. */
void SlopesAdd(const FieldSet *fs, bool axisymmetric, double dt, const NodeWeights *b, int first, Slopes *s);
/* row[k] = D[k] d in/d(unknowns), D[k] = d out_k/d in, of n outputs. */
void SlopesApply(const Slopes *s, int n, const double *const *D, double *const *row);

/* Sums of the same rows, each with factors of its own. */
#define ROW_TERMS IN_COUNT
typedef struct {
  int           n;
  const double *row[ROW_TERMS];
  double        factor[ROW_TERMS][CL_NODES]; /* [row][sum] */
} RowSum;

/* One more row; the caller fills the factors that it returns. */
static inline double *RowSumAdd(RowSum *s, const double *row)
{
  s->row[s->n] = row;
  return s->factor[s->n++];
}

/* out := the sums, which are the first, or out += them. */
void RowSumInto(const RowSum *s, int sums, int length, bool first, double *const *out);

/* The rows of a particle's nodes, summed over particles that reach the same ones before they go to the matrix. */
typedef struct {
  int      n;
  bool     fresh; /* no particle has written its rows */
  PetscInt node[CL_NODES];
  double   v[CL_NODES][F_COUNT][ROW_MOST] __attribute__((aligned(64)));
} Patch;

/* Makes it that of the nodes of r: one of other nodes (n = 0: of none) goes to the matrix first. */
void PatchAt(const Model *m, const Assembly *to, const Reach *r, Patch *s);
void PatchAdd(const Model *m, const Assembly *to, const Patch *s);

/* What nodes hold for their particles at the nodal values x; before ParticleEvaluate and FaceAt.  slope: what a change
   x of them makes; before ParticleChange and FaceChange. */
void ModelGive(Model *m, const double *x, bool slope);
/* Everything about particle p at the nodal values x: its reach, inputs, state, outputs.  A failure is noted in the
 * model. */
ClStatus ParticleEvaluate(Model *m, PetscInt p, const double *x, bool tangent, Reach *r, double in[IN_COUNT],
                          PointState *s, PointOutput *o);
/* The same for a surface face. */
void FaceAt(const Model *m, const Face *face, const double *x, Reach *r, FaceOutput *o);
/* Changes of the inputs of a particle and of its projected gradients, and of the inputs of a face, that a change x of
   the nodal values makes. */
void ParticleChange(const Model *m, PetscInt p, const double *x, Reach *r, double in[IN_COUNT],
                    double proj[CL_FLUID_VECTORS]);
void FaceChange(const Model *m, const Face *face, const double *x, Reach *r, double in[IN_COUNT]);
/* Adds the outputs of a particle, or changes of them, to what its nodes have taken (TAKE_...); x: of BedsHold. */
void ParticleScatter(Model *m, PetscInt p, const Reach *r, const double *x, const double out[OUT_COUNT]);
/* Model.x and what nodes hold for their particles at X; where products or two fluids need it, what they have taken and
   the momenta (16) on all of them.  Costs something only where the last residual was elsewhere. */
PetscErrorCode ModelNodesAt(Model *m, Vec X);
/* (34): the balances of both fluids make one of volume, added to the rows f of the owned nodes. */
PetscErrorCode ModelSumMassRows(Model *m, double *f);
/* Projected pressure gradients (20), (309) of the nodal pressures x into proj (n_local x PHASE_COUNT x CL_DIM), all
   ranks; slope: what a change x of them makes. */
PetscErrorCode ModelProjectGradients(Model *m, const double *x, bool slope, double *proj);
/* Scaled, owned Vec -> unscaled nodal values on owned and ghost nodes. */
PetscErrorCode ModelUnscale(Model *m, Vec X, double *x);
/* (265): coefficients at t_n; what it adds to the rows of a particle's nodes, and to their blocks. */
void LumpBuild(Model *m);
void LumpResidual(const Model *m, PetscInt p, const Reach *r, const double *x, double *f);
void LumpBlock(const Model *m, const Assembly *to, PetscInt p, const Reach *r);
/* (332)-(334): where each particle's gas comes from at t_n, all ranks. */
PetscErrorCode DonorBuild(Model *m);
/* (353), (354): what they need of a particle at t_n; the change at the end of the step. */
void           ExchangeSet(const Model *m, PetscInt p, const PointProperties *q);
PetscErrorCode ExchangeBuild(Model *m);
/* (22) and (23): lists on the configuration at t_n, residual, Jacobian. */
PetscErrorCode StabilisationBuild(Model *m);
void           StabilisationResidual(const Model *m, const double *x, bool slope, double *f); /* slope: of a change x */
void           StabilisationJacobian(Model *m, const Assembly *to);
/* Makes ready to assemble for the unknowns `fs`: those of the scene, or what is left without fluid velocities. */
void AssemblyOf(const Model *m, const FieldSet *fs, Assembly *to);
/* What eliminated fluid velocities leave of the tangent (171)-(174) of a particle, of a face. */
void EliminateParticle(const Model *m, PetscInt p, const Reach *r, const double *x, const double in[IN_COUNT],
                       bool fixed_stress, PointOutput *o);
void EliminateFace(const Model *m, const Face *face, const Reach *r, FaceOutput *o);
/* Plates (plates.c): their number and state; (73) position of those with a prescribed force at the nodal values x, all
   ranks; which faces touch, for the tangent; its dense part, f -= ... x; what the meters report. */
PetscErrorCode ModelPlatesCreate(Model *m);
PetscErrorCode PlatesPosition(Model *m, const double *x);
void           PlatesMark(Model *m, const double *x);
bool           PlatesCouple(const Model *m);
PetscErrorCode PlatesMult(const Model *m, const double *x, double *f);
PetscErrorCode PlatesReport(Model *m, const double *x);
/* Powers (91) of a particle, of a face with what it adds to its nodes, of prescribed motion (this rank's nodes), W; a
   scene with a solid. */
void   ParticlePower(const Model *m, PetscInt p, const Reach *r, const double *x, const double in[IN_COUNT],
                     const PointState *s, const double out[OUT_COUNT], double power[WORK_RATES]);
void   FacePower(const Model *m, const Face *f, const Reach *r, const double *x, const FaceOutput *o,
                 double power[WORK_RATES]);
double HeldPower(const Model *m);
double DragPower(const Model *m, const double *x);  /* of two fluids, of one at a well's wall; this rank's share */
double GhostPower(const Model *m, const double *x); /* that the penalty on v_s takes (22) */
/* What Newton's update may change at once: before every line search. */
#define CL_LIMIT_J 0.5 /* volumetric strain of a step */
PetscErrorCode ModelLimitUpdate(SNESLineSearch ls, Vec X, Vec Y, PetscBool *changed, void *model);
/* Where gas may vanish (slave.c): do fluid velocities follow (16)?  X with those that do; W = X - share Y with them and
   the norm of the scaled residual there; how far an update goes. */
bool           ModelSlaves(const Model *m);
PetscErrorCode ModelSlave(Model *m, Vec X);
PetscErrorCode ModelLeaves(SNES snes, Model *m, Vec X, double share, Vec Y, Vec W, double *norm);
PetscErrorCode ModelTryUpdate(SNESLineSearch ls, Vec X, Vec Y, Vec W, PetscBool *changed_Y, PetscBool *changed_W,
                              void *model);
PetscErrorCode ModelResizeNodal(Model *m);
/* Room for what the scheme adds to particles (additions.c), and where a stage of the run may change it; of particle p,
   whose properties at t_n are q; (35) of the nodes, after the projection. */
PetscErrorCode AdditionsReserve(Model *m);
PetscErrorCode AdditionsOfStage(Model *m);
void           AdditionsSet(Model *m, PetscInt p, const PointProperties *q);
PetscErrorCode UpstreamBuild(Model *m);
/* Model.face and Model.wall on the configuration at t_n (faces.c); Model.row_scale and col_scale of the stage. */
PetscErrorCode FacesStart(Model *m);
void           ScalesBuild(Model *m);
PetscErrorCode FreeParticleArrays(Model *m); /* of the configuration at t_n */
