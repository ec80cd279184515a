/* particles: the structure-of-arrays store of material points.  The history variables are declared once, here; the
   store, the HDF5 names, the checkpoint and the docs follow from this table. */
#pragma once

#include "clathra/point_flow.h"
#include "clathra/point_state.h"
#include "clathra/scene.h"
#include "clathra/skeleton.h"

#if CL_DIM == 2
  #define CL_MIXED_TABLE(X)
#else
  #define CL_MIXED_TABLE(X) X(P_BXYZ, HAS_HEAT, "mixed_T_xyz", 1, "K/m^3", "d3T/dx dy dz, likewise (446)")
#endif
/* X(enum, fields any of which it goes with, HDF5 name, components, unit, meaning) */
#define CL_PARTICLE_TABLE(X)                                                                                           \
  X(P_X, HAS_ALL, "position", CL_DIM, "m", "centre")                                                                   \
  X(P_U, HAS_SOLID, "displacement", CL_DIM, "m", "from the initial position, or since a stage reset it")               \
  X(P_L, HAS_ALL, "half_length", CL_DIM, "m", "of the GIMP domain")                                                    \
  X(P_F, HAS_SOLID, "deformation_gradient", CL_DIM *CL_DIM, "-", "in the plane, since the start: xx xy yx yy")         \
  X(P_V, HAS_ALL, "volume", 1, "m^3", "current, per metre of thickness or of the full ring")                           \
  X(P_LOGJ, HAS_SOLID, "log_J", 1, "-", "logarithm of the volume ratio V/V_0")                                         \
  X(P_MS, HAS_ALL, "mass_solid", 1, "kg", "grains")                                                                    \
  X(P_MH, HAS_ALL, "mass_hydrate", 1, "kg", "")                                                                        \
  X(P_MW, HAS_WATER, "mass_water", 1, "kg", "")                                                                        \
  X(P_MG, HAS_GAS, "mass_gas", 1, "kg", "")                                                                            \
  X(P_PW, HAS_WATER, "p_w", 1, "Pa", "water pressure")                                                                 \
  X(P_PG, HAS_GAS, "p_g", 1, "Pa", "gas pressure")                                                                     \
  X(P_T, HAS_HEAT, "T", 1, "degC", "temperature")                                                                      \
  X(P_GW, HAS_WATER, "grad_p_w", CL_DIM, "Pa/m", "at the end of the last step")                                        \
  X(P_GG, HAS_GAS, "grad_p_g", CL_DIM, "Pa/m", "")                                                                     \
  X(P_GT, HAS_HEAT, "grad_T", CL_DIM, "K/m", "")                                                                       \
  X(P_BT, HAS_HEAT, "mixed_T", CL_PAIRS, "K/m^2", "d2T/dx dy, at the end of the last step (395)")                      \
  CL_MIXED_TABLE(X)                                                                                                    \
  X(P_VS, HAS_SOLID, "v_s", CL_DIM, "m/s", "skeleton velocity")                                                        \
  X(P_VW, HAS_WATER, "v_w", CL_DIM, "m/s", "water velocity")                                                           \
  X(P_VG, HAS_GAS, "v_g", CL_DIM, "m/s", "gas velocity")                                                               \
  X(P_GV, HAS_SOLID, "grad_v_s", CL_DIM *CL_DIM, "1/s", "at the end of the last step: xx xy yx yy")                    \
  X(P_SIG, HAS_SOLID, "stress", 6, "Pa", "effective, tension-positive: xx yy zz xy yz xz")                             \
  X(P_SIG0, HAS_SOLID, "stress_initial", 6, "Pa", "initial effective stress, rotated with the body")                   \
  X(P_PW0, HAS_WATER, "p_w_initial", 1, "Pa", "initial water pressure")                                                \
  X(P_PG0, HAS_GAS, "p_g_initial", 1, "Pa", "initial gas pressure")                                                    \
  X(P_RATE, HAS_WATER | HAS_HEAT, "rate_p_w", 1, "Pa/s", "at the end of the last step")                                \
  X(P_RATE_PG, HAS_WATER | HAS_HEAT, "rate_p_g", 1, "Pa/s", "")                                                        \
  X(P_RATE_T, HAS_WATER | HAS_HEAT, "rate_T", 1, "K/s", "")                                                            \
  X(P_RATE_SH, HAS_WATER | HAS_HEAT, "rate_S_h", 1, "1/s", "")                                                         \
  X(P_X0, HAS_SOLID, "initial_position", CL_DIM, "m", "where it was seeded")                                           \
  X(P_SH, HAS_ALL, "S_h", 1, "-", "hydrate saturation")                                                                \
  CL_SKELETON_TABLE(X)                                                                                                 \
  X(P_SW, HAS_WATER, "S_w", 1, "-", "water saturation")                                                                \
  X(P_PHI, HAS_ALL, "porosity", 1, "-", "")

/* One enumerator per component: P_X is the first, P_X + 1 the second, ... ; P_COUNT is their number. */
#define CL_PARTICLE_ENUM(id, has, name, nc, unit, doc) id, id##_LAST_ = id + (nc)-1,
enum { CL_PARTICLE_TABLE(CL_PARTICLE_ENUM) P_COUNT };
#undef CL_PARTICLE_ENUM
/* Components of the largest variable. */
#define CL_PARTICLE_SIZE(id, has, name, nc, unit, doc) char id[nc];
enum { P_MOST = sizeof(union {CL_PARTICLE_TABLE(CL_PARTICLE_SIZE)}) };
#undef CL_PARTICLE_SIZE
/* Orders of rows that the code counts on: masses by substance, pressures and temperature as in the unknowns, initial
   pressures and velocities by phase. */
_Static_assert(P_MH == P_MS + 1 && P_MW == P_MH + 1 && P_MG == P_MW + 1, "masses: solid, hydrate, water, gas");
_Static_assert(P_PG == P_PW + 1 && P_T == P_PG + 1, "p_w, p_g, T");
/* The history of the skeleton stands together, in the order of OWN_... */
enum { P_HISTORY = P_EPS };
#define CL_OWN_CHECK(id, has, name, nc, unit, doc) _Static_assert((int)(id)-P_HISTORY == (int)OWN_##id, name);
CL_SKELETON_HISTORY(CL_OWN_CHECK)
#undef CL_OWN_CHECK
_Static_assert(P_PG0 == P_PW0 + 1, "initial p_w, p_g");
_Static_assert(P_RATE_PG == P_RATE + 1 && P_RATE_T == P_RATE + 2 && P_RATE_SH == P_RATE + 3, "rates: p_w, p_g, T, S_h");
_Static_assert(P_VW == P_VS + CL_DIM && P_VG == P_VW + CL_DIM, "velocities: skeleton, water, gas");
_Static_assert(P_VS == P_BT + CL_MIXED, "mixed derivatives of T");
_Static_assert(P_GV == P_VG + CL_DIM, "gradient of v_s");
_Static_assert(P_GG == P_GW + CL_DIM && P_GT == P_GG + CL_DIM, "gradients of p_w, p_g, T");

typedef struct {
  const char *name, *unit, *doc;
  int         first, nc;
  unsigned    has; /* fields any of which it goes with */
} ParticleVariable;
extern const ParticleVariable cl_particle_variable[]; /* NULL name ends it */

/* Integers kept with each particle. */
enum {
  PI_ID = 0 /* unique, 0-based seeding order */,
  PI_REGION,
  PI_FACES /* bit 1 << Side: carries this surface face */,
  PI_COUNT
};

typedef struct {
  PetscInt  n, cap;     /* particles on this rank, allocated */
  unsigned  has;        /* fields of the scene */
  bool      total;      /* the body moves, and the grid is that of its initial configuration (445) */
  double   *f[P_COUNT]; /* f[component][particle]; NULL for a variable of a field that the scene has not */
  PetscInt *i[PI_COUNT];
} Particles;

/* Is the variable of a field that the scene has? */
static inline bool ParticlesHold(const Particles *P, const ParticleVariable *v)
{
  return P->has & v->has;
}

/* Coordinate of a particle in the initial configuration, m. */
static inline double ParticleInitialX(const Particles *P, PetscInt p, int d)
{
  return P->f[P_X0] ? P->f[P_X0 + d][p] : P->f[P_X + d][p]; /* a rigid body stays */
}

/* Its place now, m. */
static inline void ParticlePlace(const Particles *P, PetscInt p, double x[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    x[d] = P->f[P_X + d][p];
}

/* Its place in the initial configuration, m. */
static inline void ParticleInitialPlace(const Particles *P, PetscInt p, double x[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    x[d] = ParticleInitialX(P, p, d);
}

/* Where the grid has it, m: its place in the configuration of the grid. */
static inline double ParticleGridX(const Particles *P, PetscInt p, int d)
{
  return P->total ? ParticleInitialX(P, p, d) : P->f[P_X + d][p];
}

/* ... along all axes, m. */
static inline void ParticleGridPlace(const Particles *P, PetscInt p, double x[CL_DIM])
{
  for (int d = 0; d < CL_DIM; d++)
    x[d] = ParticleGridX(P, p, d);
}

/* Mass of a phase, kg: 0 the skeleton with hydrate, 1 water, 2 gas; none where a trace is less than none (101). */
static inline double ParticlePhaseMass(const Particles *P, PetscInt p, int phase)
{
  if (phase == 0)
    return P->f[P_MS][p] + P->f[P_MH][p];
  return P->f[P_MS + 1 + phase] ? fmax(P->f[P_MS + 1 + phase][p], 0.0) : 0.0;
}

/* Deformation gradient F from the initial configuration to that at t_n, dimensionless; 1 without a solid. */
static inline void ParticleDeformation(const Particles *P, PetscInt p, double F[CL_DIM][CL_DIM])
{
  for (int k = 0; k < CL_DIM * CL_DIM; k++)
    F[k / CL_DIM][k % CL_DIM] = P->f[P_F] ? P->f[P_F + k][p] : k / CL_DIM == k % CL_DIM;
}

/* A = F^-T of it, which carries gradients (445); dimensionless. */
static inline void ParticleInverse(const Particles *P, PetscInt p, double A[CL_DIM][CL_DIM])
{
  double F[CL_DIM][CL_DIM];

  ParticleDeformation(P, p, F);
  const double per = 1.0 / CofactorOf(F, A);

  for (int k = 0; k < CL_DIM * CL_DIM; k++)
    A[k / CL_DIM][k % CL_DIM] *= per;
}

/* A vector of the grid's configuration, v, at particle p as it is at t_n (445); m. */
static inline void ParticleCarry(const Particles *P, PetscInt p, double v[CL_DIM])
{
  double F[CL_DIM][CL_DIM], at[CL_DIM];

  if (!P->total)
    return;
  ParticleDeformation(P, p, F);
  for (int i = 0; i < CL_DIM; i++)
    at[i] = VectorDot(F[i], v);
  for (int i = 0; i < CL_DIM; i++)
    v[i] = at[i];
}

/* What drives its fluids through the beds as they lie now (306). */
static inline Beds ParticleBeds(const Scene *c, const Particles *P, PetscInt p)
{
  const Permeability *law = &c->material[c->region[P->i[PI_REGION][p]].material].permeability;
  double              F[CL_DIM][CL_DIM];

  ParticleDeformation(P, p, F);
  return BedsOf(law->ratio, law->dip * M_PI / 180.0, F);
}

/* Temperature that a particle started from (81), degC. */
double ParticleInitialT(const Scene *c, const Particles *P, PetscInt p);
/* Its temperature, degC; in a scene without heat that of its region. */
static inline double ParticleT(const Scene *c, const Particles *P, PetscInt p)
{
  return P->f[P_T] ? P->f[P_T][p] : c->region[P->i[PI_REGION][p]].temperature;
}

/* Mean pore pressure of what the particle holds, Pa; scenes with water. */
static inline double ParticlePressure(const Particles *P, PetscInt p)
{
  const double pw = P->f[P_PW][p], pg = P->f[P_PG] ? P->f[P_PG][p] : pw;

  return PorePressureOf(1.0 - P->f[P_SW][p] / (1.0 - P->f[P_SH][p]), pw, pg).v;
}

/* History of the skeleton of the particles from `first` on, for a stage that ends `ahead` (s) of the last average of
   neighbours; the set must have a solid. */
static inline SkeletonStore ParticlesSkeleton(const Particles *P, PetscInt first, double ahead)
{
  SkeletonStore s = {.yield    = P->f[P_YIELD] ? P->f[P_YIELD] + first : NULL,
                     .nonlocal = P->f[P_NONLOCAL] ? P->f[P_NONLOCAL] + first : NULL,
                     .rate     = P->f[P_NONLOCAL] ? P->f[P_NONLOCAL_RATE] + first : NULL,
                     .ahead    = ahead};

  for (int d = 0; d < CL_DIM; d++)
    s.place[d] = P->f[P_X0 + d] + first;
  for (int k = 0; k < OWN_COUNT; k++)
    s.own[k] = P->f[P_HISTORY + k] ? P->f[P_HISTORY + k] + first : NULL;
  for (int k = 0; k < 6; k++) {
    s.sig[k]  = P->f[P_SIG + k] + first;
    s.sig0[k] = P->f[P_SIG0 + k] + first;
  }
  return s;
}

/* The motion of some particles in a step, in the plane; an array entry for each. */
typedef struct {
  const double *u[CL_DIM];         /* displacement, m */
  const double *H[CL_DIM][CL_DIM]; /* its gradient in the configuration at the begin of the step */
  const double *log_J;             /* ln of the volume over that at the begin of the step */
  const double *stretch[CL_DIM];   /* of the domains; NULL: they keep their size */
} ParticleMotion;
/* What a step makes of the history of n particles from `first` on that have their new pressures, temperature and
   gradients of these in the configuration at its begin: position, displacement, domain, deformation gradient, ln J,
   and the gradients in that at its end.  Called once a step by both kinds of integrator; motion: NULL without a solid.
 */
void ParticlesKeep(const Particles *P, PetscInt first, PetscInt n, const ParticleMotion *motion);

/* Mixed derivatives B (395) after a motion with A = F^-T: xy (yz, xz) of A B A^T; and (446). */
void MixedCarry(const double A[CL_DIM][CL_DIM], double B[CL_MIXED]);

/* Particles of another run as those a run starts with (340). */
void           ParticlesBecomeInitial(Particles *P);
PetscErrorCode ParticlesCreate(unsigned has, Particles *P); /* an empty store for the fields HAS_... */
/* Frees all variables; the store is empty then. */
PetscErrorCode ParticlesDestroy(Particles *P);
PetscErrorCode ParticlesResize(Particles *P, PetscInt n); /* keeps the first min(n, old n) */
/* All variables of `from`; `to` holds the same fields and takes its size. */
PetscErrorCode ParticlesCopy(const Particles *from, Particles *to);
PetscErrorCode ParticlesPermute(Particles *P, const PetscInt order[]); /* the k-th becomes what order[k] was */

#include "clathra/grid.h"

/* Fills the regions of the case with particles, each on the rank that owns its cell, numbered the same whatever the
   number of ranks.  Collective. */
PetscErrorCode ParticlesSeed(const Scene *c, const Grid *g, Particles *P);
/* A place that gets a particle. */
typedef struct {
  PetscInt id, region, faces;    /* faces: bits of PI_FACES */
  double   x[CL_DIM], l[CL_DIM]; /* centre, half-lengths, m */
} Site;
typedef PetscErrorCode (*SiteVisit)(const Scene *c, const Grid *g, const Site *site, void *ctx);
/* Calls visit for every site of the body, on every rank and in the same order. */
PetscErrorCode SitesVisit(const Scene *c, const Grid *g, SiteVisit visit, void *ctx);

/* (106): what step control takes for p_g: the pressure of gas or, where there is none, of that which would appear; Pa.
 */
static inline double GasToBe(double pw, double pg)
{
  return pg > pw ? pg : pw;
}

/* What a region starts from at one place. */
typedef struct {
  double pw, pg, sg, p, T;               /* Pa, share of the fluids, mean (10), degC */
  double density;                        /* of the mixture, kg/m^3 */
  double grad_p[CL_DIM], grad_T[CL_DIM]; /* Pa/m (of p_w and of p_g), K/m */
} InitialScalars;
/* x in m.  Error where the retention law never reaches the initial gas share. */
PetscErrorCode InitialScalarsAt(const Scene *c, const Region *r, const double x[], InitialScalars *s);
/* Pressure (Pa) at x of the water that has `pressure` at the region's datum (82). */
double InitialWaterPressure(const Scene *c, const Region *r, double pressure, const double x[]);

/* Of a particle at x (m) with half-lengths l (m): m^3, in the plane per metre of thickness, about an axis of the ring.
 */
double ParticleInitialVolume(const Scene *c, const double x[], const double l[]);
/* Everything of particle p of a region but its numbers: at x (m), with half-lengths l (m). */
PetscErrorCode ParticleInitialState(const Scene *c, PetscInt region, Particles *P, PetscInt p, const double x[],
                                    const double l[]);
/* Half-lengths of a region's particles at the start, m. */
void ParticlesInitialHalfLength(const Scene *c, PetscInt region, const double x[CL_DIM], double l[CL_DIM]);
/* Sends particle p to rank owner[p].  key NULL: those that stay keep their order, behind them come those of other
   ranks, by rank; else in the order of key[p] (>= 0), whatever rank they come from.  Collective. */
PetscErrorCode ParticlesSend(MPI_Comm comm, const PetscMPIInt owner[], const PetscInt key[], Particles *P);
/* Sends every particle to the owner of its cell; *left counts those outside the grid (nothing is moved then), globally.
   Collective. */
PetscErrorCode ParticlesMigrate(const Grid *g, Particles *P, PetscInt *left);
/* Particles of a rank on average, and those of the fullest one over that mean (dimensionless, 1: even).  Collective. */
PetscErrorCode ParticlesFullest(const Grid *g, const Particles *P, double *mean, double *most);
/* Where one rank has more than 1.1 times the mean and other borders make it less, shares the grid out anew and sends
   the particles to their new owners; the same particles on the same grid always give the same borders.  Collective. */
PetscErrorCode ParticlesBalance(Grid *g, Particles *P, bool *moved);
/* At the end of a step (or burst of steps) of length `time` (s): what grew of the plastic strain since the last call,
   averaged over neighbours, joins P_NONLOCAL, for materials with a nonlocal_length; particles of the others go on with
   their own.  docs/equations.md (85).  Collective. */
PetscErrorCode ParticlesNonlocal(const Scene *c, const Grid *g, double time, Particles *P);
