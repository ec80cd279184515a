/* model: the monolithic residual of one stage, its Jacobian, and the commit of a step.  docs/equations.md, 5-7 and 9.
 */
#pragma once

#include "clathra/basis.h"
#include "clathra/boundary.h"
#include "clathra/particles.h"
#include "clathra/point.h"

#define CL_WHY 256 /* length of a sentence that says why something cannot go on */

/* One implicit stage: everything an integrator says to the physics. */
typedef struct {
  double  t;      /* end of the stage, where boundary functions are evaluated, s */
  double  dt;     /* dt', s */
  double  ahead;  /* of the end of the stage since t_n, s */
  double  drain;  /* share per time of the heat that hybrid left (69) given in this step: 1 over its length, 1/s */
  double *x_star; /* [n_local][fields.n] starred nodal velocities, pressures, temperature */
  double *u_star; /* [n_local][CL_DIM] starred displacement, m */
  double *m_star; /* [n][TRIAL_MASSES] starred masses m_h, m_w, m_g, kg */
  SkeletonStage *k_star; /* [n] starred state of the skeleton; null: that of t_n */
} Stage;

enum { TRIAL_MASSES = 3, TRIAL_SCALARS = 4, TRIAL_PLASTIC = 1 + CL_TENSOR };
/* Result of a stage on the particles, before any commit. */
typedef struct {
  double        *m;   /* [n][TRIAL_MASSES] m_h; m_w, m_g less what Newton left in the rows (28), kg */
  double        *y;   /* [n][TRIAL_SCALARS] p_w, p_g, T, S_h */
  double        *u;   /* [n][CL_DIM] displacement of the step so far, m */
  double        *v;   /* [n][CL_DIM] skeleton velocity, m/s */
  SkeletonStage *end; /* [n] of the skeleton; null where it holds no history */
  double        *s;   /* [n][TRIAL_PLASTIC] eps_d_p and stress xx yy zz xy; null without plasticity */
  double        *k;   /* [n][TRIAL_PLASTIC] their rates at the end of the step, the scheme's to fill; likewise */
} Trial;

/* What a meter counts, outwards: kg/s of water and gas, W. */
enum { METER_WATER = PHASE_W, METER_GAS = PHASE_G, METER_HEAT, METER_COUNT };

/* Works of the mechanical balance (90): what is counted as it happens, J or, as rates, W. */
enum {
  WORK_INERTIA = 0, /* of all forces on the nodes' masses: what the kinetic energy gains before the integrator's loss */
  WORK_GRAVITY,
  WORK_LOADS,    /* of tractions and of the ambient pressure */
  WORK_PLATES,   /* of plates and of prescribed motion */
  WORK_PRESSURE, /* of the fluids' pressures, as fluids expand and through open faces */
  WORK_DRAG,     /* dissipated between skeleton and fluids */
  WORK_DAMPING,  /* taken by artificial damping and the ghost penalty */
  WORK_RATES,    /* those before it are rates of a stage; the rest is what a step made of the particles' energies */
  WORK_RELEASED = WORK_RATES, /* elastic energy that went with the stiffness */
  WORK_HEAT,                  /* share of the plastic dissipation that became heat */
  WORK_LOST,                  /* kinetic energy that the integrator took */
  WORK_REMAINDER,
  WORK_COUNT
};

/* What may act: the conditions of a case by their number, then its meters. */
enum { ACTS_METER = CL_CONDITIONS, ACTS_COUNT = ACTS_METER + CL_METERS };

/* Rates over the boundary and inside at the end of a stage, global sums. */
typedef struct {
  double out[PHASE_COUNT];                      /* kg/s */
  double heat_in, heat_source, heat_rate;       /* W: through the boundary; latent and squeezed less advected; stored */
  double squeezed;                              /* W: of compression and throttling of the fluids (290) */
  double beyond;                                /* W: heat of reaction beyond what the state stores (442) */
  double enthalpy_out;                          /* W: with the fluids (364) */
  double left[PHASE_COUNT], moved[PHASE_COUNT]; /* kg/s: in the mass rows, and what they exchange (277) */
  double meter[CL_METERS][METER_COUNT];
  double acts[ACTS_COUNT]; /* zero: it gives nothing */
  double work[WORK_RATES]; /* W; zero without mechanics */
} StageRates;

/* PETSc's log events. */
enum {
  EVENT_BEGIN_STEP = 0,
  EVENT_RESIDUAL,
  EVENT_JACOBIAN,
  EVENT_WIDE,
  EVENT_SETUP,
  EVENT_REDUCED,
  EVENT_PRODUCT,
  EVENT_COUNT
};

/* A particle with beds at t_n. */
typedef struct {
  Beds   A;                /* permeability by direction, over the largest (306), (447) */
  double rho[PHASE_COUNT]; /* kg/m^3 */
} Bedding;

typedef struct Solver    Solver;    /* src/model/solver.h */
typedef struct Additions Additions; /* src/model/additions.h */

/* Why a step cannot go on. */
typedef struct {
  ClStatus status;        /* of the last evaluation, on this rank until ModelReduceStatus */
  char     why[CL_WHY];   /* ... in words: the first reason of the rank */
  double   where[CL_DIM]; /* m */
} Failure;

/* One of two fluids at a node (16). */
typedef struct {
  double F[CL_DIM]; /* inertia, pressure gradient and faces, N */
  double D[CL_DIM]; /* sum of V S mu/k_a, Pa s m; along x with what a well's wall adds (197) */
  double root;      /* mean of sqrt(k_r) (108) */
} FluidNode;

/* What the rows of a particle see of the projected gradients: as of PointOutput. */
typedef struct {
  double flux[PHASE_COUNT][PHASE_COUNT][CL_DIM][CL_DIM], q[PHASE_COUNT][CL_DIM];
} Wide;

/* Sums over all particles. */
typedef struct {
  double water, methane, hydrate, solid; /* kg; water and methane include what the hydrate holds */
  double gas, dissolved;                 /* methane in the pores, and what of it water holds (101), kg */
  double V;
  double capacity; /* J/K */
  double enthalpy; /* J, (363); 0 without heat */
} ModelTotals;

/* Energies of the mechanical balance (90) that the particles hold, J; zero without mechanics.  Sums over all ranks. */
enum {
  ENERGY_KINETIC = 0,
  ENERGY_ELASTIC,  /* (89), over that of the initial stress */
  ENERGY_PLASTIC,  /* dissipated so far */
  ENERGY_HEAT,     /* the share of it that became heat */
  ENERGY_RELEASED, /* Model.released */
  ENERGY_COUNT
};

/* Sums over particles that were taken out of the run (373). */
enum {
  REMOVED_N = 0,
  REMOVED_SOLID, /* kg, as the next three: those of ModelTotals */
  REMOVED_HYDRATE,
  REMOVED_WATER,
  REMOVED_METHANE,
  REMOVED_ENTHALPY,                           /* J, (363) */
  REMOVED_MOMENTUM,                           /* of all phases, N s */
  REMOVED_ENERGY = REMOVED_MOMENTUM + CL_DIM, /* ENERGY_..., J */
  REMOVED_COUNT  = REMOVED_ENERGY + ENERGY_COUNT
};
/* One of them: when and where it left, and the mass of all that it held. */
typedef struct {
  double id, region, t, x[CL_DIM], mass; /* whole numbers; s, m, kg */
} LeavingParticle;
/* Particles of this rank that left in the last step or burst. */
typedef struct {
  bool             removes; /* they are taken out; else the step is refused */
  PetscInt         n, cap;
  LeavingParticle *one; /* [n] */
  double           sum[REMOVED_COUNT];
} Leaving;

typedef struct {
  /* Every integrator's: the body and what is counted of it. */
  const Scene *c;
  Grid         grid;
  Particles    P;
  NodeMap      map; /* of the last implicit step */
  BcValues     bc;
  StageRates   rates;           /* of the last stage, means over a burst */
  PetscInt     plates;          /* their number */
  double (*plate)[PLATE_COUNT]; /* [Scene.nlisted] at the end of the last stage; zero where it is no plate */
  double   released;            /* J, this rank: elastic energy that stiffness took away in the last step or burst */
  PetscInt limited;             /* particles on which the hydrate positivity limiter acted in the last stage */
  bool     uneven;              /* the last implicit step evened nothing out within cells: (354) was not found */
  Leaving  leaving;             /* particles that crossed the edge of the grid (373) */
  bool     relative_gas;        /* changes of p_g in proportion to it (151), (416) */

  double t_n; /* s; whoever steps sets it before ModelBeginStep and ExplicitBegin */

  /* The implicit system's: what stands from here on is seen by src/model alone (tests/layers.py). */
  PetscLogEvent event[EVENT_COUNT];

  /* on the configuration at t_n, built by ModelBeginStep */
  Stencil  *stencil; /* [n] */
  PetscInt  stencil_cap;
  PetscInt *order; /* [n] particles by the nodes they reach */
  double   *x_n;   /* [n_local][fields.n] projected start values */
  double   *w;     /* [n_local][2] (phi S_pi)_I */
  double   *V;     /* [n_local] sum of V_n S, m^3 */
  Bedding  *beds;  /* [n] NULL without */
  Beds     *share; /* [n_local] B of (448); NULL without */
  CellMean *cell;  /* [n_local] of the cell behind a node (88); NULL without */
  double *conduct; /* [n] k_p at t_n over the first k0 (350): a particle's share in a flow; 1 where it is not shared */
  double *Vk;      /* [n_local] sum of V S times it, m^3 */
  double *flow;    /* [n_local] V/Vk (350) */
  double *wall;    /* [n_local][2] this rank's drag at the wall of a well (197), Pa s m; NULL in the plane */
  double *coef;    /* [n_local][NC_COUNT] nodal means, places NC_... */
  const Material **material; /* [n_local] of most of what this rank has at the node */
  double          *most;     /* [n_local] ... volume of the particle that it is of, times S, m^3 */
  double          *hydrate;  /* [n_local] ... its S_h at t_n */
  unsigned        *mask;     /* [n_local] Dirichlet bits */
  double          *fixed;    /* [n_local][fields.n] Dirichlet values of the stage */
  PetscInt         nface;
  Face            *face;

  /* of the stage, built by ModelBeginStage */
  Stage   stage;
  double *row_scale, *col_scale; /* [n_local][fields.n] */

  /* of the last evaluation */
  double    *x, *f;       /* [n_local][fields.n] unscaled unknowns, residual */
  FluidNode *fluid;       /* [n_local][2] where there are two */
  bool       evaluated;   /* x, proj, give, take and fluid are those of a residual of this stage */
  double    *proj;        /* [n_local][PHASE_COUNT][CL_DIM] projected pressure gradients Pi g, Pa/m */
  double    *give, *take; /* [n_local][...] what nodes hold for their particles, what these add (src/model/gather.h) */
  Wide      *wide;        /* [n] of the wide part (27) */
  double    *plate_K;     /* [Scene.nbc] stiffness of the springs that touch, N/m; where a force is prescribed */

  Additions *added;   /* what the scheme adds to the balances (22), (23), (200), (293), (456) */
  Solver    *solver;  /* of the stages */
  Failure    failure; /* of the last evaluation */
} Model;

/* Nodal means at t_n. */
enum {
  NC_M = 0,
  NC_LAMBDA,
  NC_RHO     = NC_LAMBDA + PHASE_COUNT,
  NC_STORAGE = NC_RHO + PHASE_COUNT,
  NC_KAPPA   = NC_STORAGE + PHASE_COUNT,
  NC_CAPACITY,
  NC_COMPLIANCE,
  NC_REACTION,
  NC_REACTION_HEAT,
  NC_SH, /* S_h */
  NC_DRAG,
  NC_KR   = NC_DRAG + PHASE_COUNT,
  NC_P    = NC_KR + PHASE_COUNT, /* of the particles' pressures */
  NC_RING = NC_P + PHASE_COUNT,  /* 1/r */
  NC_AXIS,                       /* of what was seeded at the axis: 1 */
  NC_COUNT
};

/* Grid and particles of a scene at its initial state.  first: the scene of the first stage, whose loads that state is
   in balance with; c itself without stages. */
PetscErrorCode ModelCreate(MPI_Comm comm, const Scene *c, const Scene *first, Model *m);
/* Frees all but the scene.  Collective. */
PetscErrorCode ModelDestroy(Model *m);
/* Between steps: moves the borders between ranks where their particles have become uneven.  Collective. */
PetscErrorCode ModelBalance(Model *m);
/* Before the first step: shares the grid out as a checkpoint says (GridShare); the particles are the caller's.
   Collective. */
PetscErrorCode ModelShare(Model *m, const PetscInt nproc[], PetscInt *const start[]);
/* Unknowns a node of the matrix that implicit steps factorise (330); 0: they have multigrid. */
int ModelFactored(const Model *m);
/* One line, once a run: which preconditioner implicit steps have, and why.  Collective. */
PetscErrorCode ModelPrintSolver(Model *m);
/* Makes the solver of implicit steps if there is none; it reads its options and, with -help, lists them.  Collective;
   after ModelBeginStep. */
PetscErrorCode ModelReadySolver(Model *m);
/* Stencils, active nodes, projections, faces and stabilisation on the configuration at t_n.  Collective; *status is the
   same on all ranks. */
PetscErrorCode ModelBeginStep(Model *m, ClStatus *status);
/* Starts a stage: boundary values, scales.  The stage's arrays belong to the caller. */
PetscErrorCode ModelBeginStage(Model *m, const Stage *s);
/* Solves (15)-(23) for the stage; x (n_local x fields.n, ghosts included) holds the first guess and then the solution
   in SI units; newton: iterations with a Jacobian of their own (343). */
PetscErrorCode ModelSolve(Model *m, double *x, PetscInt *newton, ClStatus *status);
/* What the solution x (n_local x fields.n, SI units) means for the particles; checks that they stay within half a cell
 * and inside the grid. */
PetscErrorCode ModelEndStage(Model *m, const double *x, Trial *trial, StageRates *rates, ClStatus *status);
/* Can the plates go where they must in this stage? */
PetscErrorCode ModelPlatesCheck(Model *m, ClStatus *status);
/* Model.plate of all ranks from what each has added, with the positions.  Collective. */
PetscErrorCode ModelPlatesSum(Model *m);
/* Sets Face.K from the particle's present properties. */
void ModelPlateStiffness(const Model *m, Face *f);
/* The skeleton of particle p at t_n, where a first stage starts. */
static inline SkeletonStage ModelSkeletonStart(const Model *m, PetscInt p)
{
  const SkeletonStore store = ParticlesSkeleton(&m->P, p, 0.0);
  SkeletonHistory     h;

  SkeletonTake(&store, 0, &h);
  return h.from;
}
/* Nodal values at t_n ([n_local][fields.n], SI units) as ModelBeginStep projects them (2); NULL before the first. */
const double *ModelStart(const Model *m);
/* Skeleton velocity at t_n on the particles (n x 2), interpolated like Trial.v, m/s. */
void ModelStartVelocity(const Model *m, double *v);
/* Makes the trial state of the last stage the history, with rates (n x 4, of p_w, p_g, T, S_h: Pa/s, K/s, 1/s), moves
   the particles and migrates them.  unseen: share of the motion that nodes do not see which is lost (452),
   dimensionless.  Collective. */
PetscErrorCode ModelCommit(Model *m, const double *x, const Trial *trial, const double *rates, double unseen);
/* Notes why particle p cannot go on; the first reason of this rank stays. */
void ModelNoteFailure(Model *m, ClStatus status, const char *why, PetscInt p);
/* Why the last evaluation failed, and where; the words stay when the status is cleared. */
const Failure *ModelFailure(const Model *m);
/* Nothing has failed so far, on this rank. */
void ModelClearFailure(Model *m);
/* Other words for why a step is refused, for a reason that no particle has; the place stays. */
void ModelExplain(Model *m, const char *why);
/* Properties of a particle at t_n; a failure leaves *why pointing to a sentence. */
ClStatus ModelParticleProperties(const Model *m, PetscInt p, PointProperties *q, const char **why);
/* Heat capacity that flows through a particle by Darcy's law with the gradients of t_n, W/(m^2 K); beds aside. */
void ModelHeatFlow(const Model *m, PetscInt p, const PointProperties *q, double a[CL_DIM]);
/* Initial p_w and p_g at a face: the particle's own, and the weight of the water between it and the face. */
void ModelInitialAtFace(const Model *m, const Face *face, double p0[PHASE_COUNT]);
/* What flows into the body and wells need of the particle of a face (109), (367); S: its weights at its n nodes,
   dimensionless. */
void ModelFaceProperties(const Model *m, Face *f, int n, const double S[]);
/* Adds a face's rates, weighted with `weight`, to those of the whole boundary and of the meters that cover it. */
void ModelCountFace(const Scene *c, const Face *face, double weight, const FaceOutput *o, StageRates *rates);
/* Same status on all ranks (the worst), with its reason and place on all ranks. */
PetscErrorCode ModelReduceStatus(Model *m, ClStatus *status);

/* Of the particles as they are.  Collective; the same on all ranks. */
PetscErrorCode ModelComputeTotals(const Model *m, ModelTotals *t);
/* What one particle adds to them. */
void ModelAddTotals(const Model *m, PetscInt p, ModelTotals *t);

double ModelKineticEnergy(const Particles *P, PetscInt p); /* of all phases of a particle, J */
/* Fills all of ENERGY_..., J.  Collective; the same on all ranks. */
PetscErrorCode ModelEnergies(const Model *m, double energy[ENERGY_COUNT]);
/* What one particle adds to all but the released one, J. */
void ModelAddEnergies(const Model *m, PetscInt p, double energy[ENERGY_COUNT]);

/* Takes the particles that stand outside the grid at t (s) out of the run and notes them in Model.leaving, if that is
   wished. */
PetscErrorCode ModelTakeOut(Model *m, double t);
/* Nothing has left in this step or burst. */
void ModelForgetLeaving(Model *m);

/* SNES callbacks, exposed for tests. */
PetscErrorCode ModelResidual(SNES snes, Vec X, Vec R, void *model);
/* A: the shell that applies the exact Jacobian; P: the preconditioner's matrix.  Collective. */
PetscErrorCode ModelJacobian(SNES snes, Vec X, Mat A, Mat P, void *model);
