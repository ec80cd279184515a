/* boundary: where a condition acts, on which field, as which function of time.  docs/equations.md, section 6. */
#pragma once

#include "clathra/ambient.h"
#include "clathra/basis.h"
#include "clathra/particles.h"
#include "clathra/point.h"

/* A surface face of a particle on the configuration at t_n. */
typedef struct {
  PetscInt particle;
  int      side;
  double   n[CL_DIM]; /* outward normal x area, m^2 per metre of thickness or of the full ring; goes with the body */
  double   s[CL_DIM]; /* the same of the true surface that the face stands for (70) */
  double   x[CL_DIM]; /* middle of the face, m */
  double   r[CL_DIM]; /* from where the particle's values belong (AxisCentroid) to the face, m */
  PetscInt region;
  double   x0[CL_DIM];                /* initial position of the particle, m */
  double   n0[CL_DIM];                /* FaceNormal there */
  double   N[CL_NODES];               /* weights, in the order of StencilExpand */
  double   Nr[CL_NODES];              /* (195): those of Darcy fluxes along x */
  double   Nm[PHASE_COUNT][CL_NODES]; /* (109): those in the rows of mass */
  double   ring[2];             /* (197), (198): what is lost between face and body in a ring, in 2 pi k and kappa */
  bool     leaves[PHASE_COUNT]; /* has the fluid that crosses the body's density (365)? */
  double   pore;                /* mean pore pressure at t_n, Pa (358) */
  PetscInt bc[BC_FACES];        /* by kind: index into Case.bc, -1 = none */
  double   moved[CL_DIM];       /* displacement since the start, m */
  double   a0;                  /* area at the start, m^2 */
  double   K;                   /* stiffness of its plate's spring, N/m; see PlateStiffness */
  bool     touches; /* its plate takes part in the last tangent: always, or where one that separates touches */
  unsigned meters;  /* bit k: Case.meter[k] counts it */
  double   share;   /* of a well omega_p (366), of a heat source its volume at the start, m^3; such a face is a particle
                       inside the body and has no area */
  double draws;     /* C sqrt(r) omega_p of (367), dimensionless */
  double conducts[PHASE_COUNT], kr[PHASE_COUNT]; /* k_a/mu (m^2/(Pa s)) and k_r at t_n */
} Face;

/* Weight of a node in what a face adds to row q, and takes from its Darcy fluxes; dimensionless. */
static inline double FaceWeight(const Face *f, int a, int q)
{
  if (q == F_PW || q == F_PG)
    return f->Nm[q - F_PW][a];
  return (q == F_VW || q == F_VG) ? f->Nr[a] : f->N[a];
}

/* (365): which way a fluid crosses the face by its Darcy flux J there, m/s. */
static inline void FaceDirection(Face *f, int phase, const double J[CL_DIM])
{
  f->leaves[phase] = VectorDot(J, f->n) > 0.0;
}

/* Finds the faces of the local particles and the conditions on them; *face is reallocated. */
PetscErrorCode FacesBuild(const Scene *c, const Grid *g, const Particles *P, PetscInt *n, Face **face);

/* Weights of particle p where the grid has it. */
void ParticleStencil(const Scene *c, const Grid *g, const Particles *P, PetscInt p, Stencil *s);
/* Where a linear function takes the value of these weights at t_n, m. */
void ParticleCentroid(const Grid *g, const Particles *P, PetscInt p, const Stencil *s, double at[CL_DIM]);

/* What drives each particle's fluids through its layers as they lie now, A: [n] (306), of one fluid less across borders
   that cut cells (447).  Collective. */
PetscErrorCode ParticlesDrive(const Scene *c, const Grid *g, NodeMap *map, const Particles *P, Beds *A);

/* Where the face is and how it distributes, for its particle's present position and weights. */
void FacePlace(const Scene *c, const Grid *g, const Particles *P, Face *f);

/* (109): weights of an inflow of fluids that cannot move yet.  S: n weights of the face's particle (-), in the order of
   StencilExpand; kr: its relative permeabilities at t_n (-). */
void FaceInflow(Face *f, int n, const double *S, const double kr[PHASE_COUNT]);

/* The place of a well on the two axes across it, in cells of the grid; on each its particles tile from `first` on with
   `width`, and its weights sum up to `sum`.  In space it is open from `lower` to `upper` (m) of the third axis,
   `along`.
 */
typedef struct {
  int       across[2], along;
  GridLines line[2];
  double    at[CL_DIM]; /* the middle of what is open, m */
  double    place[2], first[2], width[2], sum[2], lower, upper;
} Well;
/* How long it is open, m; the plane has a metre of everything. */
static inline double WellLength(const Well *w)
{
  return CL_DIM == 2 ? 1.0 : w->upper - w->lower;
}
/* Of condition b; false if no region has particles there. */
bool WellPlace(const Scene *c, const Bc *b, Well *w);
/* (366): of a particle at x0 (m) with half-lengths l (m), all at the start; dimensionless. */
double WellShare(const Well *w, const double x0[CL_DIM], const double l[CL_DIM]);
/* det A across the well of a material as it lies at the start (306), dimensionless. */
double WellRatio(const Well *w, const Permeability *law);
/* C of (369), dimensionless; 0 if there is none: the well is too wide for its cells. */
PetscErrorCode WellIndex(const Scene *c, const Bc *b, const Well *w, double *C);
/* What a face of a well has of its particle's properties at t_n. */
void WellProperties(const PointProperties *q, Face *f);

#define FACE_PENALTY 20.0 /* gamma of (199) */

/* (197), (198): what radial flow to a face at radius r (m), whose particles have the half-length l, loses between body
   and face beyond what the grid carries, per 2 pi k/mu and height: of a fluid (penalty 0), or of heat. */
double FaceRing(const Scene *c, const Grid *g, double r, double l, double penalty);

/* Normal stress (Pa, compression-positive) prescribed at time t on a side of the particle of a region that was first
   at x (m); 0 where none is. */
double FaceLoad(const Scene *c, Side side, PetscInt region, const double x[CL_DIM], double t);

/* Stresses of the particles in geostatic regions, just seeded; docs/equations.md (83), (84).  The same on any number
   of ranks; no communication. */
PetscErrorCode           GeostaticStress(const Scene *c, const Grid *g, Particles *P);
extern const char *const cl_side[]; /* words of Side, and none */

/* Prescribed values of all conditions at one time, at height 0 where they vary with depth, and gravity then.  Of a
   plate `value` is the position since the start, which its owner fills in where the force is prescribed. */
typedef struct {
  double *value, *shear, *phase[PHASE_COUNT]; /* [Scene.nbc]; of a well rates and T of what enters */
  double  gravity[CL_DIM];
  Ambient ambient;
} BcValues;
/* (42): the fluid around the body at time t (s), gravity (m/s^2) being what it is then. */
Ambient AmbientOf(const Scene *c, double t, const double gravity[CL_DIM]);
/* Fills v, whose arrays are there, with what holds at time t (s). */
void BcValuesEvaluate(const Scene *c, double t, BcValues *v);
/* (425): what a condition prescribes at x (m), and its gradient, `value` being its BcValues; only temperatures vary in
   space, degC and K/m. */
double BcValueAt(const Scene *c, const Bc *b, double value, const double x[CL_DIM], double gradient[CL_DIM]);
/* Lowest and highest temperature that it prescribes over the height of the body, at any time, degC; infinite, -infinite
   where it has no schedule. */
void   BcTemperatureSpan(const Scene *c, const Bc *b, double *low, double *high);
double BcNextKink(const Scene *c, double t); /* first kink of any schedule after t, s; INFINITY if none */
double BcNextMark(const Scene *c,
                  double       t); /* first time after t that a step must not cross for the waves of a schedule, s */

/* What is said of a plate: position since the start along its axis (m); force on the body, compression-positive, and
   along the side in the direction of the axis (N); area under it (m^2). */
enum { PLATE_POSITION = 0, PLATE_FORCE, PLATE_SHEAR, PLATE_AREA, PLATE_COUNT };

/* A fluid's own pressure at a face, extrapolated from its particle, Pa. */
static inline double FacePressure(const Face *f, int phase, const double in[IN_COUNT])
{
  double p = in[IN_P + phase];

  for (int d = 0; d < CL_DIM; d++)
    p += in[VectorAt(IN_GP, phase, d)] * f->r[d];
  return p;
}

/* What a face adds to the nine rows of a node per unit of N_I, with the tangent in the particle's inputs, where Darcy
   fluxes and displacement are those at the face (weights N_I).  outflow: mass rates of water and gas (kg/s) and heat
   into the body (W). */
typedef struct {
  double out[F_COUNT], D[F_COUNT][IN_COUNT];
  double outflow[PHASE_COUNT], heat_in;
  double enthalpy;           /* (364): W that what flows out takes along */
  double plate[PLATE_COUNT]; /* what its plate gives; PLATE_POSITION is not used */
  bool   acts[BC_FACES];     /* by kind: does its condition give anything? */
} FaceOutput;
/* Is something prescribed on it, or counted?  Else FaceEvaluate finds nothing: most of a surface is left alone. */
bool FaceActs(const Scene *c, const Face *f);
/* What a face is evaluated with. */
typedef struct {
  const Scene    *c;
  const Face     *f;
  const BcValues *v;
  const Material *mat;           /* of its particle */
  const double   *p0;            /* [PHASE_COUNT] initial pressures at the face, Pa */
  const double   *in;            /* [IN_COUNT] */
  const double   *velocity;      /* [CL_DIM] of the skeleton at the face, m/s, which changes with in[IN_U] as 1/dt */
  double          Sh, kappa, dt; /* of its particle at t_n, W/(m K), s */
} FaceInput;
/* In SI units. */
void FaceEvaluate(const FaceInput *x, FaceOutput *o);

/* Position of a plate since the start at time t, m; 0 where its force is prescribed.  That force, N. */
double PlatePosition(const Bc *b, double t);
/* The force that a plate is prescribed to bear at time t, compression-positive, N; 0 where its motion is. */
double PlateForce(const Bc *b, double t);
/* Stiffness of a face's spring, N/m: q are the properties of its particle, h the cell along the plate's axis. */
double PlateStiffness(const Bc *b, const Face *f, const PointProperties *q, double h);
/* How far the face is beyond its plate, outwards, when it has moved by u since t_n, m. */
static inline double PlateGap(const Face *f, double position, const double u[CL_DIM])
{
  const int d = SideAxis(f->side);

  return SideSign(f->side) * (f->moved[d] - position + u[d]);
}
/* Is the force of any plate prescribed? */
bool PlatesForced(const Scene *c);
/* (73): positions `value` (m since the start) of the plates that bear a prescribed force at time t (s); answer: what
   each face's spring bears along the axis with the plate where it was at the start (N), and how much less for every
   metre that the plate gives way (N/m).  K, if wanted: that of all that touch, N/m.  Collective. */
PetscErrorCode PlatesSeek(const Scene *c, MPI_Comm comm, PetscInt nface, const Face *face, const double (*answer)[2],
                          double t, double *value, double *K);
/* Adds the plate's spring to what a face adds to its nodes, with the tangent. */
void PlateEvaluate(const Bc *b, const Face *f, double position, const double in[IN_COUNT], FaceOutput *o);
/* CL_OK, or why the plate cannot go to `position` (m) in this step; the sentence goes to text. */
ClStatus PlateCheck(const Scene *c, const Grid *g, const Face *f, double position, char *text, size_t size);

/* What the program knows of a kind of condition: the rows of CL_FACE_CONDITIONS, CL_NODE_CONDITIONS. */
typedef struct FaceState FaceState;
typedef struct {
  const char *word;
  unsigned    has;   /* fields HAS_... any of which it needs */
  int         where; /* ON_FACES, ON_PLANE, IN_REGION */
  /* adds what condition Case.bc[k] does at a face; NULL: nothing, or a plate, whose force decides where it is */
  void (*face)(const FaceState *x, PetscInt k, FaceOutput *o);
  /* prescribes unknowns of a node as PlaneConditions does; at: the condition's value at the time */
  void (*node)(const FieldSet *fs, const Bc *b, double at, unsigned *mask, double *value);
} Condition;
extern const Condition cl_condition[BC_COUNT]; /* by BcType */

/* Is the node at x (m) one of those that condition b prescribes something at? */
bool NodePrescribed(const Scene *c, const Grid *g, const Bc *b, const double x[CL_DIM]);
/* Dirichlet values on grid planes, in regions and on the axis, where what the node sees was seeded there: sets bit k of
   mask and value[k] (m/s, Pa, degC) for every prescribed unknown, k its place in the field set, of grid node ij. */
void PlaneConditions(const Scene *c, const Grid *g, const BcValues *v, const PetscInt ij[CL_DIM], bool at_axis,
                     unsigned *mask, double *value);
