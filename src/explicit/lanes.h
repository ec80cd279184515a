/* Private to explicit/: how particles and nodes are laid out for the loops.
   Particles are taken BLOCK at a time, sorted by cell, all of one material: what happens at a particle runs over arrays
   of a block. What a particle gives to or takes from a node is a row of numbers next to each other, so that one vector
   instruction moves eight of them.  Every loop is made once for each set of fields: a field that is not there leaves no
   trace. */
#pragma once

#include "clathra/basis.h"
#include "clathra/explicit.h"
#include "clathra/inline.h"
#include "clathra/point_flow.h"
#include "clathra/point_heat.h"
#include "clathra/point_state.h"
#include "clathra/transfer.h"

#define BLOCK 32
#define LANES 8
#define STRAIGHT 0.5      /* of p_0: change of p_c over which s_g(p_c) is nearly straight */
#define PRESSURE_UNIT 1e6 /* Pa, of the unknowns of (151) */

#define PIECES (LANES / CL_REGISTER) /* of eight lanes */
typedef double Lanes[LANES];

/* A set of fields as the loops know it; a constant in each of them. */
typedef struct {
  int solid, fluids, heat; /* 0/1; water, water and gas; 0/1 */
  int layers;              /* 0/1: particles differ in k_p or have beds: (350) shares a node's flow, (306) drives it */
} Set;

#define PLACE(name, number)                                                                                            \
  INLINE int name(Set s)                                                                                               \
  {                                                                                                                    \
    return number;                                                                                                     \
  }
PLACE(Scalars, s.fluids + s.heat) /* unknowns of mass and heat: p_w, p_g, T */
INLINE int Rows(int n)
{
  return (n + LANES - 1) / LANES;
}

/* First pass, sums over particles: V p_w, V p_g, C T, the force on the mixture, momenta of skeleton and fluids (all but
 * the force carried to the node by gradients), V, C, the mass of the skeleton and each fluid, with layers V k_p and
 * that times A, with fluids what weighs their pressures (449). */
enum { FL_M = 0, FL_G, FL_MI = FL_G + CL_DIM, FL_DRAG, FL_W, FL_ROOT };
PLACE(A_Force, Scalars(s))
INLINE int A_Momentum(Set s, int phase) /* 0: skeleton, 1 + k: fluid k */
{
  return A_Force(s) + CL_DIM * (s.solid ? 1 + phase : phase - 1);
}
PLACE(A_V, A_Momentum(s, s.fluids) + CL_DIM)
PLACE(A_C, A_V(s) + 1)
PLACE(A_M, A_C(s) + s.heat)
PLACE(FluidLanesAlike, s.fluids == 2 ? FL_ROOT + 1 : FL_ROOT) /* a lone fluid has no k_r */
PLACE(FL_Inertia, s.layers ? FluidLanesAlike(s) : FL_MI) /* of one fluid (310); without layers that of its weight */
PLACE(FluidLanes, FluidLanesAlike(s) + s.layers)
INLINE int A_Fluid(Set s, int f)
{
  return A_M(s) + s.solid + FluidLanes(s) * f;
}
PLACE(A_K, A_Fluid(s, s.fluids))
PLACE(A_Beds, A_K(s) + s.layers) /* by cl_symmetric */
PLACE(A_Stores, A_Beds(s) + CL_SYMMETRIC * s.layers)
PLACE(A_Count, A_Stores(s) + (s.fluids > 0))
PLACE(A_Acting, s.solid ? A_V(s) : Scalars(s)) /* of which so many are carried or have forces */

/* Pressure of a fluid at a node at t_n (2). */
INLINE double NodalPressure(Set s, const double *a, int k)
{
  return a[k] / a[A_Stores(s)];
}

/* Second pass, from nodes: v_s, T (with gradients); p_w, p_g; of each fluid Darcy flux, mean gradient of p, increment
   of velocity; that of v_s. */
enum { B_J = 0, B_PROJ = CL_DIM, B_DV = 2 * CL_DIM, B_PER_FLUID = 3 * CL_DIM };
PLACE(B_T, CL_DIM *s.solid)
INLINE int B_P(Set s, int f)
{
  return CL_DIM * s.solid + s.heat + f;
}
INLINE int B_Fluid(Set s, int f)
{
  return CL_DIM * s.solid + s.heat + s.fluids + B_PER_FLUID * f;
}
PLACE(B_DVs, B_Fluid(s, s.fluids))
PLACE(B_Count, B_DVs(s) + CL_DIM * s.solid)

/* ... and to nodes: what is missing of each scalar, then the matrix that says what a change of the scalars makes of it.
 */
PLACE(R_Matrix, Scalars(s))
PLACE(R_Count, Scalars(s) * (Scalars(s) + 1))

/* Between that and the third pass, to nodes (413): what their particles store of the increments of pressure by the
   sums of all their nodes, and the matrix of the same by a node's own. */
PLACE(Stored_Matrix, s.fluids)
PLACE(Stored_Count, s.fluids *(s.fluids + 1))

/* Third pass, from nodes: increments of the scalars, their end values (gradients), v_s; a dry body has its increment of
 * v_s here. */
PLACE(C_End, Scalars(s))
PLACE(C_Vs, 2 * Scalars(s))
PLACE(C_DVs, C_Vs(s) + CL_DIM)
PLACE(C_Count, Scalars(s) > 0 ? C_Vs(s) + CL_DIM * s.solid : B_Count(s))
PLACE(C_Width, LANES *Rows(C_Count(s)))

/* What a step keeps per particle between its passes. */
enum {
  T_T = 0, /* degC, where heat has no field */
  T_SG,    /* share of gas and its slope */
  T_DS,
  T_RHO,                                    /* [2] densities with which the fluids flow */
  T_GAS     = T_RHO + PHASE_COUNT,          /* [2] slopes of that of the gas in p_g and T */
  T_HELD    = T_GAS + 2,                    /* density of the gas in the pores (323) */
  T_DRAG    = T_HELD + 1,                   /* [2] mu/(k_a k_r) */
  T_CONDUCT = T_DRAG + PHASE_COUNT,         /* weight of its flow at t_n (350); with layers */
  T_V,                                      /* volume at the end of the step */
  T_EOS,                                    /* [2] masses at that volume and the old pressures */
  T_SLOPE      = T_EOS + PHASE_COUNT,       /* [2][3] their slopes in p_w, p_g, T */
  T_CONSISTENT = T_SLOPE + 3 * PHASE_COUNT, /* beta of (413) */
  T_WARM       = T_CONSISTENT + 1, /* [2] beta T_K times the fluids' volumes, m^3: heat of compression per Pa (290) */
  T_GAIN       = T_WARM + PHASE_COUNT, /* hydrate: gain at the old p and T, slopes in p_w, p_g and T */
  T_GAIN_W,
  T_GAIN_G,
  T_GAIN_T,
  T_MISS, /* bare form: [2] masses missing, then [2][3] what increments of p_w, p_g, T make of them */
  T_LOCAL = T_MISS + PHASE_COUNT,
  T_COUNT = T_LOCAL + 3 * PHASE_COUNT
};

enum { INC = 3 * CL_DIM }; /* skeleton, water, gas */

typedef struct {
  int    root;  /* fuller node that this one follows; its own number if it stands for itself */
  double own;   /* share that it keeps of its own balances of mass and heat; 1 if it follows nobody */
  double own_v; /* ... of momentum; 1 where velocities are free */
  int beyond; /* node on the other side of that one, whose velocity with its says that of this one (454); else itself */
  double stretch[CL_DIM]; /* ... from here over from there, for each axis of the velocity; 0 where that is prescribed */
  int    held;            /* its place in the list of nodes with prescribed unknowns, -1 if it has none */
  bool   leads;           /* others follow it in velocity */
} NodeInfo;

/* Parts of a step in -log_view. */
enum { STEP_DEPOSIT = 0, STEP_VELOCITIES, STEP_RATES, STEP_SCALARS, STEP_UPDATE, STEP_ORDER, STEP_PARTS };

struct Explicit {
  Model          *m;
  ExplicitOptions o;
  Set             set;
  PetscInt        cap; /* of the arrays over particles */
  double         *t[T_COUNT];
  Beds           *beds;         /* [cap] A at t_n (306), (447); with layers */
  int            *base[CL_DIM]; /* first node along each axis, as at the last look */
  PetscInt       *order, *key;  /* work space of the sort */
  NodeMap         map;
  PetscInt        shared;            /* Grid.shared that it is of */
  int            *slot;              /* padded grid node -> row */
  PetscInt        rows;              /* n_local + 1: the last row takes what nobody needs */
  double         *raw;               /* memory of the arrays below */
  double         *A, *B, *R, *C, *G; /* [rows][8 n]; G: A of a leading node with what its followers gave it */
  double *inc;     /* [rows][INC] increments of velocity from a node's own balances, with what its followers gave it; of
                      fluids with layers the flow per permeability (311) */
  double   *gain;  /* [rows][3] the same of the scalars */
  double   *given; /* [rows][LANES] (413): Stored_... */
  bool      again; /* (37) is solved for what (413) gives */
  double   *cell;  /* [rows][CELL_MEAN] of the cell behind a node: sums of PartMoment, m^3, last CELL_PRESSURE */
  CellMean *mean;  /* [rows] */
  double   *swell; /* [rows] mean stress through a cell's volume change, J, of this rank; from CellsMotion on
                                     the mean divergence of its velocity, 1/s */
  double (*part)[CL_DIM][CL_DIM]; /* [rows] (160): stress through the cell's mean motion, J; from CellsMotion on its
                                     mean velocity gradient, 1/s */
  double *link; /* [rows] which neighbour a nearly empty node follows, and the share it keeps, as they travel between
                   ranks */
  double (*lean)[CL_DIM]; /* [rows] m/s, increment on the line through two nodes beyond that of the nearer (454) */
  double   *alternates;   /* [rows][CL_DIM][ALTERNATION_COUNT] (440) of T; NULL where nothing carries heat */
  bool      long_cells;   /* are there cells in which (444) acts? */
  double   *torn;         /* [rows] of more than none: about the node particles stand open (427) */
  NodeInfo *node;         /* [rows] */
  PetscInt  nheld, *held; /* local nodes with prescribed unknowns */
  unsigned *mask;         /* ... which */
  double   *fixed;        /* ... and their values, [nheld][fields.n] */
  PetscInt  nface;
  Face     *face;
  double (*spring)[CL_DIM];     /* [rows] stiffness of the springs at a node, N/m */
  double (*answer)[2 * CL_DIM]; /* [rows] velocity without the plates; what its own springs, pulled by 1 m, add */
  double (*push)[CL_DIM];       /* [rows] force of the plates, N */
  bool   stale, strays, gone;   /* a particle reaches other nodes; left this rank's cells; left the grid, see (373) */
  bool   resize;                /* rows of nodes have another length */
  double latent, advected;      /* J over the step */
  double squeezed, beyond;      /* (290), (442), J over the step */
  double heat_in, warmed;       /* J over the step: what prescribed temperatures take, and all that warms the nodes */
  double ahead;                 /* of the end of the step, since ExplicitBegin, s */
  double across, stable;        /* of StableStep, s */
  Unseen unseen;
  double straight;         /* STRAIGHT p_0, the least of all materials, Pa */
  double work[WORK_RATES]; /* J over the step (92), this rank */
  double (*pull)[CL_DIM];  /* [nface] force of the tractions, N */
  double added, acting;    /* N^2: inertia that mass scaling adds, forces of the stresses at the start of the burst */
  double worst_scaling;
  PetscLogEvent event[STEP_PARTS];
};

/* Weight of a particle's flow (350). */
INLINE double Conductance(const Explicit *e, Set s, PetscInt p)
{
  return s.layers ? e->t[T_CONDUCT][p] : 1.0;
}

/* v := A v, with layers. */
INLINE void Drive(const Explicit *e, Set s, PetscInt p, double v[CL_DIM])
{
  if (s.layers)
    BedsDrive(&e->beds[p], v);
}

/* Gradient g of a pressure less the weight of a fluid of density rho, with layers. */
INLINE void Unweighed(const Explicit *e, Set s, double rho, double g[CL_DIM])
{
  for (int d = 0; s.layers && d < CL_DIM; d++)
    g[d] -= rho * e->m->bc.gravity[d];
}

/* Weights of a block of particles. */
typedef struct {
  double S[CL_DIM][3][BLOCK], D[CL_DIM][3][BLOCK];
  int    first[BLOCK];                              /* padded number of the lowest left node */
  double unit[CL_DIM][BLOCK], third[CL_DIM][BLOCK]; /* m, from the first node to the second; times that, to the third */
} Weights;

/* A run of particles of one material, or of nodes. */
typedef struct {
  PetscInt        p;
  int             n;
  const Material *mat;
} Run;

void WeightsOf(const Explicit *e, Run r, Weights *w);

/* Three nodes of a particle's patch that follow each other along x: where the first stands from the patch's first on;
   its places along the axes; the product of the other axes' weights, and the same with the derivative along d. */
typedef struct {
  int    at, place[CL_DIM];
  double S, D[CL_DIM];
} PatchRow;

enum { PATCH_ROWS = CL_NODES / 3 };

/* Row k of particle q's patch. */
INLINE PatchRow PatchRowOf(const Explicit *e, const Weights *w, int q, int k)
{
  const PetscInt *gm = e->m->grid.gm;
#if CL_DIM == 2
  const double Sy = w->S[1][k][q], Dy = w->D[1][k][q];

  return (PatchRow){.at = k * (int)gm[0], .place = {0, k}, .S = Sy, .D = {0.0, Dy}};
#else
  const int    b = k % 3, c = k / 3;
  const double Sy = w->S[1][b][q], Dy = w->D[1][b][q], Sz = w->S[2][c][q], Dz = w->D[2][c][q];
  const int    at = (int)((c * gm[1] + b) * gm[0]);

  return (PatchRow){.at = at, .place = {0, b, c}, .S = Sy * Sz, .D = {0.0, Dy * Sz, Sy * Dz}};
#endif
}

/* Gradient of the weight of its node a. */
INLINE void PatchGradient(const Weights *w, int q, const PatchRow *row, int a, double G[CL_DIM])
{
  G[0] = w->D[0][a][q] * row->S;
  for (int d = 1; d < CL_DIM; d++)
    G[d] = w->S[0][a][q] * row->D[d];
}

/* Do particles take the volume change of their cells (88)?  Not in the bare form, which is the paper's. */
INLINE bool TakesCellMean(const Explicit *e)
{
  return SceneTakesCellMeans(e->m->c) && !e->o.paper;
}

/* Place of the mean stress through a cell's volume change, J, of this rank: no moment is asked for there. */
enum { CELL_PRESSURE = CELL_MEAN - 1 };

/* (160), (88): what particles take of their cells' gradient, and of its divergence beyond that in each direction of
   space. */
typedef struct {
  double strain, volume;
} CellShare;

INLINE CellShare CellShareOf(const Explicit *e)
{
  const double strain = e->m->c->mean_strain;

  return (CellShare){strain, (1.0 - strain) / 3.0};
}

/* Where corner i of the cell at padded number `first` stands, from there on. */
INLINE int CornerAt(const Explicit *e, int i)
{
  const PetscInt *gm = e->m->grid.gm;
  int             at = 0;

  for (int d = CL_DIM - 1; d >= 0; d--)
    at = at * (int)gm[d] + (i >> d & 1);
  return at;
}

/* The parts along the axes of particle q's domain. */
INLINE void PartsOf(const Weights *w, int q, AxisParts part[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++) {
    const double S[3] = {w->S[d][0][q], w->S[d][1][q], w->S[d][2][q]};
    const double D[3] = {w->D[d][0][q], w->D[d][1][q], w->D[d][2][q]}, h = w->unit[d][q];

    part[d] = AxisPartsOf(S, D, h, (w->third[d][q] - 1.0) * h);
  }
}

void Deposit(Explicit *e);
void Rates(Explicit *e, double dt);
/* (440) at t_n; before Rates. */
PetscErrorCode HeatAlternation(Explicit *e);
void           Stored(Explicit *e); /* (413), to Explicit.given */
void           Update(Explicit *e, double dt);
/* Calls the loop made for the set of the scene on every run of particles, or on the nodes of this rank. */
typedef void (*Loop)(Explicit *e, Run r, double dt);
typedef Loop LoopTable[2][3][2]; /* [solid][fluids][heat] */
void         ForRuns(Explicit *e, const LoopTable table, double dt);
void         ForNodes(Explicit *e, const LoopTable table, double dt);
#define MAKE_LOOP(f, solid, fluids, heat)                                                                              \
  static void f##_##solid##fluids##heat(Explicit *e, Run r, double dt)                                                 \
  {                                                                                                                    \
    if (fluids && e->set.layers)                                                                                       \
      f(e, (Set){solid, fluids, heat, 1}, r, dt);                                                                      \
    else                                                                                                               \
      f(e, (Set){solid, fluids, heat, 0}, r, dt);                                                                      \
  }
/* A loop f for each set, and their table f_loops. */
#define MAKE_LOOPS(f)                                                                                                  \
  MAKE_LOOP(f, 0, 0, 1)                                                                                                \
  MAKE_LOOP(f, 0, 1, 0)                                                                                                \
  MAKE_LOOP(f, 0, 1, 1)                                                                                                \
  MAKE_LOOP(f, 0, 2, 0)                                                                                                \
  MAKE_LOOP(f, 0, 2, 1)                                                                                                \
  MAKE_LOOP(f, 1, 0, 0)                                                                                                \
  MAKE_LOOP(f, 1, 0, 1)                                                                                                \
  MAKE_LOOP(f, 1, 1, 0)                                                                                                \
  MAKE_LOOP(f, 1, 1, 1)                                                                                                \
  MAKE_LOOP(f, 1, 2, 0)                                                                                                \
  MAKE_LOOP(f, 1, 2, 1)                                                                                                \
  static const LoopTable f##_##loops = {{{NULL, f##_001}, {f##_010, f##_011}, {f##_020, f##_021}},                     \
                                        {{f##_100, f##_101}, {f##_110, f##_111}, {f##_120, f##_121}}};

/* Cells (88). */
PetscErrorCode CellsForces(Explicit *e); /* what particles give to their cells, to the nodes, A */
void           CellsMotion(Explicit *e); /* velocity gradients */

PetscErrorCode LoseUnseen(Explicit *e); /* (452), when it is due */

/* Node side. */
PetscErrorCode NodesRebuild(Explicit *e); /* numbering, when particles reach other nodes */
PetscErrorCode NodesPrepare(Explicit *e); /* prescribed values, and who follows whom (41) */
void NodesExtend(Explicit *e, double dt); /* forces of what follows two nodes (454), those of plates included */
PetscErrorCode NodesVelocities(Explicit *e, double dt);  /* A -> B */
PetscErrorCode NodesScalars(Explicit *e, StageRates *r); /* R -> C */
void           FacesForces(Explicit *e, double dt);
void           FacesRates(Explicit *e, double dt, StageRates *r);
void           FacesWork(Explicit *e, double dt); /* of the tractions, with the new velocities */
PetscErrorCode FacesBegin(Explicit *e);
/* Adds what conditions of heat give each particle less per kelvin that it is warmer, W/K, [n]. */
PetscErrorCode FacesConductance(const Explicit *e, double *conductance);
int            FaceNodes(const Explicit *e, const Face *f, PetscInt node[CL_NODES]); /* in the order of Face.N */

/* Plates (plates.c, plate_forces.c). */
PetscErrorCode PlatesStart(Explicit *e);                                          /* of a step */
void           PlatesDeposit(Explicit *e, Face *f, int n, const PetscInt node[]); /* springs of a face to its nodes */
/* Forces at the end of the step, time t, into the balances of the nodes.  Collective. */
PetscErrorCode PlatesForces(Explicit *e, double t, double dt);
PetscErrorCode PlatesEnd(Explicit *e); /* what they bear to the model, all ranks */

/* Does (413) correct lumped storage?  Not in the bare form, which is the paper's. */
INLINE bool Corrects(const Explicit *e)
{
  return e->set.fluids > 0 && !e->o.paper;
}

/* Do relative changes of p_g go through the nodes (151)? */
INLINE bool Relative(const Explicit *e, Set s)
{
  return s.fluids == 2 && e->m->relative_gas && !e->o.paper;
}

/* (151): the second of a row's columns for dp_w and dp_g, where the second is p_g, Pa. */
INLINE double RelativeColumn(const double a[2], double p_g)
{
  return (a[0] + a[1]) * (p_g / PRESSURE_UNIT);
}

/* (151): increments of p_w and p_g, where the latter is p_g, from what the nodes have solved for. */
INLINE void PressuresOf(double p_g, const double y[2], double d[2])
{
  const double gas = p_g / PRESSURE_UNIT * y[1];

  d[0] = gas + y[0];
  d[1] = gas;
}

/* (322): water and methane that a unit of hydrate displaces at t_n, kg/m^3: two fluids, with p_w and p_g of then. */
INLINE void PerHydrateVolume(const Explicit *e, Run r, const double *restrict pw, const double *restrict pg,
                             double held[PHASE_COUNT][BLOCK])
{
  const double *restrict sg = e->t[T_SG] + r.p, *restrict rho_w = e->t[T_RHO] + r.p,
                         *restrict rho_g = e->t[T_HELD] + r.p, *restrict ds = e->t[T_DS] + r.p;
  const double H = r.mat->gas.trace, n = r.mat->retention.hydrate;

  for (int q = 0; q < r.n; q++) {
    const Content water = WaterContent(sg[q], rho_w[q]), methane = MethaneContent(H, sg[q], rho_g[q], pg[q]);
    const double  drains = n * (pg[q] - pw[q]) * ds[q]; /* -(1 - S_h) ds_g/dS_h (320) */

    held[PHASE_W][q] = water.v + water.sg * drains;
    held[PHASE_G][q] = methane.v + methane.sg * drains;
  }
}

INLINE double Largest(double a, double b)
{
  return a > b ? a : b;
}

/* Heat capacities of a block of particles, J/K. */
INLINE void Capacities(const Explicit *e, Set s, Run r, double *restrict C)
{
  double *const *f          = e->m->P.f;
  const double *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p, *mw = s.fluids ? f[P_MW] + r.p : NULL,
                         *mg = s.fluids == 2 ? f[P_MG] + r.p : NULL;

  for (int q = 0; q < r.n; q++)
    C[q] = HeatCapacity(r.mat, ms[q], mh[q], mw ? mw[q] : 0.0, mg ? mg[q] : 0.0);
}

/* Sum of a block's n numbers. */
INLINE double Sum(int n, const double *restrict x)
{
  double sum = 0.0;

  for (int q = 0; q < n; q++)
    sum += x[q];
  return sum;
}

/* FLIP: velocities of n particles from increments that stand `width` numbers apart. */
INLINE void AddChange(int n, double *restrict v, const double *restrict dv, int width)
{
  INDEPENDENT
  for (int q = 0; q < n; q++)
    v[q] += dv[q * width];
}
