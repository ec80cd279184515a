/* Private to model/: what passes between nodes and one particle. */
#pragma once

#include "weights.h"

/* What nodes and particles exchange, and rows of the tangent, are whole numbers of these, so that sums of them are
   vector code whatever the fields. */
#define LANES CL_REGISTER
typedef Register Lanes;

/* Model.give, what a node holds for its particles: they sum it with S, what stands from GIVE_GRAD on with G. */
/* So many numbers in whole Lanes, whatever their width. */
#define WHOLE_LANES(n) (((n) + 7) / 8 * 8)
enum {
  GIVE_SCALARS = PHASE_COUNT + 1,
  GIVE_SCALAR  = 0,                          /* p_w, p_g (Pa), T (K) less those at t_n */
  GIVE_START   = GIVE_SCALAR + GIVE_SCALARS, /* those at t_n */
  GIVE_U       = GIVE_START + GIVE_SCALARS,  /* displacement of the step, m */
  GIVE_J       = GIVE_U + CL_DIM,            /* B times Darcy fluxes times V/Vk (350), (448), m/s */
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

/* Nodes that one couples with: within two of it, itself in the middle. */
#define RADIUS 2
#define WIDTH (2 * RADIUS + 1)
enum { NEIGHBOURS = CL_DIM == 2 ? WIDTH * WIDTH : WIDTH * WIDTH * WIDTH };

/* The material of most of what this rank has at a node; the first one where it has nothing. */
static inline const Material *NodeMaterial(const Model *m, PetscInt I)
{
  return m->material[I] ? m->material[I] : &m->c->material[0];
}

/* Local number of neighbour k; -1 where there is none that this rank knows. */
static inline PetscInt ModelNeighbour(const Model *m, PetscInt I, int k)
{
  PetscInt ij[CL_DIM];

  for (int d = 0; d < CL_DIM; k /= WIDTH, d++)
    ij[d] = m->map.ij[I][d] + k % WIDTH - RADIUS;
  return NodeMapAt(&m->grid, &m->map, ij);
}

/* Which neighbour of I is K? */
static inline PetscInt ModelOffset(const Model *m, PetscInt I, PetscInt K)
{
  PetscInt k = 0;

  for (int d = CL_DIM - 1; d >= 0; d--)
    k = k * WIDTH + m->map.ij[K][d] - m->map.ij[I][d] + RADIUS;
  return k;
}

/* rho s of a fluid at a node at t_n, kg/(m^3 Pa). */
static inline double StoredAt(const Model *m, PetscInt I, int f)
{
  const double *c = &m->coef[I * NC_COUNT];

  return c[NC_RHO + f] * c[NC_STORAGE + f];
}

/* Methane in a kg of the water at a node at t_n (352), dimensionless. */
static inline double CarriedAt(const Model *m, PetscInt I)
{
  const double *c = &m->coef[I * NC_COUNT], H = NodeMaterial(m, I)->gas.carried;

  return H > 0.0 ? CarriedShare(H, c[NC_P + PHASE_G], c[NC_RHO]) : 0.0;
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
  const double *G, *M, *w, *B; /* B: null without (88) */
  const Beds   *share;         /* (448); null without */
} NodeWeights;

/* d in/d(unknowns). */
typedef struct {
  int    unknowns, length; /* unknowns: 0 before the first SlopesBegin */
  double in[IN_COUNT][ROW_MOST] __attribute__((aligned(64)));
} Slopes;

/* anew: with (88); else what SlopesAdd wrote for other nodes has the places that it writes again. */
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

/* A particle at nodal values: the nodes it reaches, what they give it, and what it makes of that. */
typedef struct {
  PetscInt    p;
  Reach       r;
  double      in[IN_COUNT];
  PointState  state;
  PointOutput o;
} ParticleResult;

/* What nodes hold for their particles at the nodal values x; before ParticleEvaluate and FaceAt.  slope: what a change
   x of them makes; before ParticleChange and FaceChange. */
void ModelGive(Model *m, const double *x, bool slope);
/* Everything about particle p at the nodal values x: its reach, inputs, state, outputs.  A failure is noted in the
 * model. */
ClStatus ParticleEvaluate(Model *m, PetscInt p, const double *x, bool tangent, ParticleResult *at);
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
/* Projected pressure gradients (20), (309) of the nodal pressures x into proj (n_local x PHASE_COUNT x CL_DIM), all
   ranks; slope: what a change x of them makes. */
PetscErrorCode ModelProjectGradients(Model *m, const double *x, bool slope, double *proj);
/* Scaled, owned Vec -> unscaled nodal values on owned and ghost nodes. */
PetscErrorCode ModelUnscale(Model *m, Vec X, double *x);
/* (424) at t_n. */
void ChordsBuild(Model *m);
/* (444): what it adds to the rows of heat of the particle's nodes, and to their blocks. */
void LongCellResidual(const Model *m, PetscInt p, const Reach *r, const double *x, double *f);
void LongCellBlock(const Model *m, const Assembly *to, PetscInt p, const Reach *r);
/* (332)-(334): where each particle's gas comes from at t_n, all ranks. */
PetscErrorCode DonorBuild(Model *m);
/* (353), (354): what they need of a particle at t_n; the change at the end of the step. */
void           ExchangeSet(const Model *m, PetscInt p, const PointProperties *q);
PetscErrorCode ExchangeBuild(Model *m);
/* g_s of (351), (417): changes of pressure that they hold store this share of what the sediment of their volume does.
 */
#define STORAGE_SHARE 0.1
/* (22), (351), (417) and (23): lists on the configuration at t_n, residual, Jacobian. */
PetscErrorCode StabilisationBuild(Model *m);
PetscErrorCode PressureModesBuild(Model *m);
void           StabilisationResidual(const Model *m, const double *x, bool slope, double *f); /* slope: of a change x */
void           StabilisationJacobian(Model *m, const Assembly *to);
/* Makes ready to assemble for the unknowns `fs`: those of the scene, or what is left without fluid velocities. */
void AssemblyOf(const Model *m, const FieldSet *fs, Assembly *to);
/* What eliminated fluid velocities leave of the tangent (171)-(174) of a particle, of a face. */
void EliminateParticle(const Model *m, const double *x, bool fixed_stress, ParticleResult *at);
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
void   ParticlePower(const Model *m, const double *x, const ParticleResult *at, double power[WORK_RATES]);
void   FacePower(const Model *m, const Face *f, const Reach *r, const double *x, const FaceOutput *o,
                 double power[WORK_RATES]);
double HeldPower(const Model *m);
double DragPower(const Model *m, const double *x);  /* of two fluids, of one at a well's wall; this rank's share */
double GhostPower(const Model *m, const double *x); /* that the penalty on v_s takes (22) */
/* What Newton's update may change at once, and how far it goes (415): before every line search. */
#define CL_LIMIT_J 0.5 /* volumetric strain of a step */
PetscErrorCode ModelLimitUpdate(SNESLineSearch ls, Vec X, Vec Y, PetscBool *changed, void *model);
/* Where gas may vanish (fluid_velocities.c): do fluid velocities follow (16)?  X with those that do; what an update led
   to, with them. */
bool           ModelVelocitiesFollow(const Model *m);
PetscErrorCode ModelVelocitiesOfPressures(Model *m, Vec X);
PetscErrorCode ModelVelocitiesAfterUpdate(SNESLineSearch ls, Vec X, Vec Y, Vec W, PetscBool *changed_Y,
                                          PetscBool *changed_W, void *model);
PetscErrorCode ModelResizeNodal(Model *m);
/* Room for what the scheme adds to particles (additions.c), and where a stage of the run may change it; of particle p,
   whose properties at t_n are q. */
PetscErrorCode AdditionsReserve(Model *m);
PetscErrorCode AdditionsOfStage(Model *m);
void           AdditionsSet(Model *m, PetscInt p, const PointProperties *q);
/* Conductivity that carries heat with the flow of t_n (293), with D of (456) (m^2/(Pa s)); W/(m K). */
void AdditionsUpwind(const Model *m, PetscInt p, const PointProperties *q, double spread, double K[CL_SYMMETRIC]);
PetscErrorCode UpwindLimit(Model *m);
/* Model.face and Model.wall on the configuration at t_n (faces.c); Model.row_scale and col_scale of the stage. */
PetscErrorCode FacesStart(Model *m);
void           ScalesBuild(Model *m);
PetscErrorCode FreeParticleArrays(Model *m); /* of the configuration at t_n */
