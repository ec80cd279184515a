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
  const Stencil *s            = &m->stencil[p];
  const bool     ring         = m->c->axisymmetric;
  const PetscInt cell[CL_DIM] = {s->axis[0].base + s->cell[0], s->axis[1].base + s->cell[1]};
  const double   h[CL_DIM]    = {LinesWidth(&m->grid.line[0], cell[0]), LinesWidth(&m->grid.line[1], cell[1])};
  const double   radius = GridNode(&m->grid, 0, cell[0]), share = m->c->mean_strain;
  const double   mean = m->c->mean_dilatation ? (1.0 - share) / (ring ? 3.0 : 2.0) : 0.0;

  for (int a = 0; a < r->n; a++) {
    const PetscInt i[CL_DIM] = {m->map.ij[r->node[a]][0] - cell[0], m->map.ij[r->node[a]][1] - cell[1]};
    double         Q[CL_DIM];
    const double   hoop = CellGradient(h, ring, i, radius, Q), beyond = ring ? hoop - r->H[a] : 0.0;

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
      more += u[a][0] * r->B[a][0] + u[a][1] * r->B[a][1];
  }
  g[0] += more;
  g[3] += more;
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

/* Share of a node's flux of a fluid that goes through an open face of the particle: (350), of gas (333) without
   omega. */
static inline double FaceShare(const Model *m, PetscInt p, PetscInt I, int f)
{
  return Donated(m, f) ? m->conduct[p] * m->added->source[2 * I] : LayerWeight(m, p, I);
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

  if (m->fluid && q >= F_VWX && q <= F_VGY)
    return &m->fluid[PHASE_COUNT * I + (q - F_VWX) / CL_DIM].F[(q - F_VWX) % CL_DIM];
  return mass ? MassRow(m, f, I, q - F_PW) : &f[I * m->c->fields.n + m->c->fields.at[q]];
}

/* What a face of particle p at node I adds to row q is weighted with besides: (350) in (16). */
static inline double FaceFlow(const Model *m, PetscInt p, PetscInt I, int q)
{
  return q >= F_VWX && q <= F_VGY ? FlowWeight(m, p, I, (q - F_VWX) / CL_DIM) : 1.0;
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

  return h0 * LinesAround(&m->grid.line[1], ij[1]) * (m->c->axisymmetric ? 2.0 * M_PI * fmax(r, 0.25 * h0) : 1.0);
}

/* The smallest cell width at a node, m. */
static inline double NodeWidth(const Model *m, PetscInt I)
{
  return fmin(LinesLess(&m->grid.line[0], m->map.ij[I][0]), LinesLess(&m->grid.line[1], m->map.ij[I][1]));
}

static inline void GatherSolid(const Model *m, PetscInt p, const Reach *r, const double *x, const Face *face,
                               double in[IN_COUNT])
{
  const int n = m->c->fields.n, vs = PlaceVs(&m->c->fields);
  double    u[CL_NODES][CL_DIM];

  for (int a = 0; a < r->n; a++) {
    const double *v = &x[r->node[a] * n + vs], *us = &m->stage.u_star[r->node[a] * CL_DIM];

    for (int i = 0; i < CL_DIM; i++) {
      u[a][i] = us[i] + m->stage.dt * v[i];
      in[IN_U + i] += (face ? face->N[a] : MotionWeight(m, p, r, a)) * u[a][i];
    }
  }
  MotionGradient(m, r, u, &in[IN_GRADU]);
}

/* Darcy flux of a fluid at a node (19). */
static inline void DarcyFlux(const Model *m, PetscInt I, int f, const double *xI, double J[2])
{
  const FieldSet *fs = &m->c->fields;
  const double    w = m->w[PHASE_COUNT * I + f], *v = &xI[PlaceV(fs, f)];

  for (int i = 0; i < CL_DIM; i++)
    J[i] = w * (fs->solid ? v[i] - xI[PlaceVs(fs) + i] : v[i]);
}

/* Weight of a particle in k_r of a node (108): (350), or what looks upstream (35). */
static inline double MobilityWeight(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  if (!m->c->stabilisation.upstream)
    return S * LayerWeight(m, p, I);
  const double *u = &m->added->up[6 * I + 3 * f];

  return u[2] > 0.0 ? S * u[2] * fmax(Upstream(m, p, I, u), 0.0) : S;
}

/* ... of all in the node's k_r (108). */
static inline double MobilityShare(const Model *m, PetscInt p, PetscInt I, int f, double S)
{
  return MobilityWeight(m, p, I, f, S) * m->P.f[P_V][p] / m->V[I];
}

/* Acceleration, weighted, less gravity of the velocity at place k of a node's block; quasi-static: only gravity. */
static inline void Acceleration(const Model *m, PetscInt I, const double *x, int k, double weight, double acc[2])
{
  const PetscInt q = I * m->c->fields.n + k;

  for (int i = 0; i < CL_DIM; i++)
    acc[i] =
        (m->c->fields.inertia ? weight * (x[q + i] - m->stage.x_star[q + i]) / m->stage.dt : 0.0) - m->bc.gravity[i];
}

/* ... of a fluid of particle p with (310); beds hold what of the skeleton's acceleration less gravity is across them
   (308). */
static inline void FluidAcceleration(const Model *m, PetscInt p, PetscInt I, const double *x, int f, double acc[2])
{
  const FieldSet *fs = &m->c->fields;
  double          s[2], A[2];

  Acceleration(m, I, x, PlaceV(fs, f), FlowWeight(m, p, I, f), acc);
  if (!m->beds)
    return;
  for (int i = 0; i < CL_DIM; i++)
    s[i] = -m->bc.gravity[i];
  if (fs->solid)
    Acceleration(m, I, x, PlaceVs(fs), 1.0, s);
  for (int i = 0; i < CL_DIM; i++)
    A[i] = s[i];
  BedsDrive(&m->beds[p].A, A);
  for (int i = 0; i < CL_DIM; i++)
    acc[i] += A[i] - s[i];
}

static inline void GatherFluid(const Model *m, PetscInt p, int f, const Reach *r, const double *x, const Face *face,
                               double in[IN_COUNT])
{
  const int n = m->c->fields.n, at = PlaceP(&m->c->fields, f);

  for (int a = 0; a < r->n; a++) {
    const PetscInt I  = r->node[a];
    const double   pI = x[I * n + at], flow = face ? FaceShare(m, p, I, f) : FlowWeight(m, p, I, f);
    double         J[2];

    DarcyFlux(m, I, f, &x[I * n], J);
    in[IN_P + f] += r->S[a] * (pI - m->x_n[I * n + at]);
    for (int i = 0; i < CL_DIM; i++) {
      in[VectorAt(IN_GP, f, i)] += r->G[a][i] * pI;
      in[VectorAt(IN_J, f, i)] += (face ? FaceWeight(face, a, VectorAt(F_VWX, f, i)) : r->S[a]) * flow * J[i];
    }
  }
}

/* Inputs (1), (5), (19) of particle p from the nodal values x; Darcy fluxes and displacement are those at its face
   (NULL: the particle's own). */
static inline void GatherInputs(const Model *m, PetscInt p, const Reach *r, const double *x, const Face *face,
                                double in[IN_COUNT])
{
  const FieldSet *fs = &m->c->fields;

  for (int q = 0; q < IN_COUNT; q++)
    in[q] = 0.0;
  in[IN_T] = ParticleT(m->c, &m->P, p);
  if (fs->solid)
    GatherSolid(m, p, r, x, face, in);
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    in[IN_P + f] = m->P.f[HeldPressure(fs, P_PW, f)][p];
    GatherFluid(m, p, f, r, x, face, in);
  }
  if (!fs->heat)
    return;
  for (int a = 0; a < r->n; a++) {
    const PetscInt k = r->node[a] * fs->n + PlaceT(fs);

    in[IN_T] += r->S[a] * (x[k] - m->x_n[k]);
    for (int d = 0; d < CL_DIM; d++)
      in[IN_GT + d] += r->G[a][d] * x[k];
  }
}

/* Nodal less own value at t_n of unknown q = F_PW, F_PG, F_T. */
static inline double Shift(const Model *m, PetscInt p, const Reach *r, int q)
{
  const FieldSet *fs = &m->c->fields;
  double          shift;

  if (fs->at[q] < 0)
    return 0.0;
  shift = -m->P.f[q == F_T ? P_T : HeldPressure(fs, P_PW, q - F_PW)][p];
  for (int a = 0; a < r->n; a++)
    shift += r->S[a] * m->x_n[r->node[a] * fs->n + fs->at[q]];
  return shift;
}

/* (1) of the pressure that the stage starts from, Pa. */
static inline double StarredPressure(const Model *m, PetscInt p, const Reach *r, int f)
{
  const FieldSet *fs  = &m->c->fields;
  double          sum = m->P.f[HeldPressure(fs, P_PW, f)][p];

  for (int a = 0; a < r->n; a++) {
    const PetscInt k = r->node[a] * fs->n + PlaceP(fs, f);

    sum += r->S[a] * (m->stage.x_star[k] - m->x_n[k]);
  }
  return sum;
}

static inline void GatherHistory(const Model *m, PetscInt p, const Reach *r, PointHistory *h)
{
  const FieldSet *fs = &m->c->fields;

  h->V        = m->P.f[P_V][p];
  h->m_s      = m->P.f[P_MS][p];
  h->T_n      = ParticleT(m->c, &m->P, p);
  h->Sh_n     = m->P.f[P_SH][p];
  h->sw_n     = ParticleSw(m, p);
  h->dt       = m->stage.dt;
  h->bracket  = m->c->stabilisation.flux_interpolation ? 1.0 : 0.0;
  h->mobility = m->added->donor ? m->added->donor[p].kr : 0.0;
  for (int f = 0; f < PHASE_COUNT; f++)
    h->spread[f] = m->added->spread ? m->added->spread[PHASE_COUNT * p + f] : 0.0;
  for (int k = 0; k < 3; k++)
    h->upwind[k] = m->added->upwind ? m->added->upwind[3 * p + k] : 0.0;
  h->compression = m->c->compression_heat;
  for (int k = 0; h->compression && k < PHASE_COUNT; k++) {
    h->p_star[k]  = fs->phase[k] ? StarredPressure(m, p, r, k) : 0.0;
    h->gravity[k] = m->bc.gravity[k];
  }
  h->beds = m->beds ? &m->beds[p].A : NULL;
  for (int f = 0; m->beds && f < PHASE_COUNT; f++)
    BedsWeight(m, p, f, h->weight[f]);
  h->ambient = m->bc.ambient.on ? &m->bc.ambient : NULL;
  for (int d = 0; h->ambient && d < CL_DIM; d++)
    h->x[d] = AxisCentroid(&m->stencil[p].axis[d], &m->grid.line[d]);
  for (int k = 0; k < 3; k++) {
    h->m_star[k] = m->stage.m_star[3 * p + k];
    h->shift[k]  = Shift(m, p, r, F_PW + k);
  }
  if (fs->solid) {
    const SkeletonStore store = ParticlesSkeleton(&m->P, 0, m->stage.ahead);

    SkeletonTake(&store, p, &h->skeleton);
    if (m->stage.k_star)
      h->skeleton.from = m->stage.k_star[p];
  }
  for (int f = 0; f < PHASE_COUNT; f++) {
    for (int i = 0; i < CL_DIM; i++)
      h->proj[f][i] = 0.0;
    for (int a = 0; fs->phase[f] && a < r->n; a++) {
      const double share = ProjectedShare(m, p, r->node[a], f, r->S[a]);

      for (int i = 0; i < CL_DIM; i++)
        h->proj[f][i] += share * m->proj[VectorAt(0, PHASE_COUNT * r->node[a] + f, i)];
    }
  }
}

/* Nodes that one couples with: within two of it, itself in the middle. */
#define RADIUS 2
#define WIDTH (2 * RADIUS + 1)
#define NEIGHBOURS (WIDTH * WIDTH)

/* Local number of neighbour k; -1 where there is none that this rank knows. */
static inline PetscInt ModelNeighbour(const Model *m, PetscInt I, int k)
{
  const Grid    *g = &m->grid;
  const PetscInt i = m->map.ij[I][0] + k % WIDTH - RADIUS, j = m->map.ij[I][1] + k / WIDTH - RADIUS;

  if (i < g->gs[0] || j < g->gs[1] || i >= g->gs[0] + g->gm[0] || j >= g->gs[1] + g->gm[1])
    return -1;
  return m->map.index[GridPadded(g, i, j)];
}

/* Which neighbour of I is K? */
static inline PetscInt ModelOffset(const Model *m, PetscInt I, PetscInt K)
{
  return (m->map.ij[K][1] - m->map.ij[I][1] + RADIUS) * WIDTH + m->map.ij[K][0] - m->map.ij[I][0] + RADIUS;
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
#define ROW_MOST ((CL_NODES * F_COUNT + 7) / 8 * 8)

static inline int RowLength(int unknowns)
{
  return (unknowns + 7) / 8 * 8;
}

/* One node as a particle or face sees it; NS (by fluid and component) and NU stand for S in the Darcy fluxes, where it
   is (350) or (333), and in the displacement. */
typedef struct {
  double        S, NS[PHASE_COUNT][CL_DIM], NU, K;
  const double *G, *M, *w, *B; /* B: null without mean dilatation */
} NodeWeights;

/* d in/d(unknowns). */
typedef struct {
  int    length;
  double in[IN_COUNT][ROW_MOST] __attribute__((aligned(64)));
} Slopes;

void SlopesBegin(int unknowns, Slopes *s);
/* Those of the node whose unknowns are `first` ... first + fs->n - 1. */
void SlopesAdd(const FieldSet *fs, bool axisymmetric, double dt, const NodeWeights *b, int first, Slopes *s);
/* row = D d in/d(unknowns), D = d out/d in. */
void SlopesApply(const Slopes *s, const double D[IN_COUNT], double *row);

/* A sum of rows with factors. */
#define ROW_TERMS IN_COUNT
typedef struct {
  int           n;
  double        factor[ROW_TERMS];
  const double *row[ROW_TERMS];
} RowSum;

static inline void RowSumAdd(RowSum *s, double factor, const double *row)
{
  s->factor[s->n] = factor;
  s->row[s->n++]  = row;
}

/* out += the sum. */
void RowSumInto(RowSum *s, int length, double *out);

/* The rows of a particle's nodes, summed over particles that reach the same ones before they go to the matrix. */
typedef struct {
  int      n;
  PetscInt node[CL_NODES];
  double   v[CL_NODES][F_COUNT][ROW_MOST] __attribute__((aligned(64)));
} Patch;

/* Makes it that of the nodes of r: one of other nodes (n = 0: of none) goes to the matrix first. */
void PatchAt(const Model *m, const Assembly *to, const Reach *r, Patch *s);
void PatchAdd(const Model *m, const Assembly *to, const Patch *s);

/* Everything about particle p at the nodal values x: its reach, inputs, state, outputs.  A failure is noted in the
 * model. */
ClStatus ParticleEvaluate(Model *m, PetscInt p, const double *x, bool tangent, Reach *r, double in[IN_COUNT],
                          PointState *s, PointOutput *o);
/* The same for a surface face. */
void FaceAt(const Model *m, const Face *face, const double *x, Reach *r, FaceOutput *o);
/* Momenta of two fluids (16) at X, on all local nodes; costs a residual only where the last one was elsewhere. */
PetscErrorCode ModelFluidsAt(Model *m, Vec X);
/* Projected pressure gradients (20), (309) of the nodal pressures x into proj (n_local x 4), all ranks; slope: what a
   change x of them makes. */
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
void           StabilisationResidual(const Model *m, const double *x, double *f);
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
double DragPower(const Model *m, const double *x);  /* of two fluids, this rank's nodes */
double GhostPower(const Model *m, const double *x); /* that the penalty on v_s takes (22) */
/* What Newton's update may change at once: before every line search. */
#define CL_LIMIT_J 0.5 /* volumetric strain of a step */
PetscErrorCode ModelLimitUpdate(SNESLineSearch ls, Vec X, Vec Y, PetscBool *changed, void *model);
PetscErrorCode ModelResizeNodal(Model *m);
PetscErrorCode FreeParticleArrays(Model *m); /* of the configuration at t_n */
