/* particles: the structure-of-arrays store of material points.  The history variables are declared once, here; the
   store, the HDF5 names, the checkpoint and the docs follow from this table. */
#pragma once

#include "clathra/case.h"

/* X(enum, HDF5 name, components, unit, meaning) */
#define CL_PARTICLE_TABLE(X)                                                                                           \
  X(P_X, "position", 2, "m", "centre")                                                                                 \
  X(P_U, "displacement", 2, "m", "from the initial position")                                                          \
  X(P_L, "half_length", 2, "m", "of the GIMP domain")                                                                  \
  X(P_V, "volume", 1, "m^3", "current, per metre of thickness")                                                        \
  X(P_LOGJ, "log_J", 1, "-", "logarithm of the volume ratio V/V_0")                                                    \
  X(P_MS, "mass_solid", 1, "kg", "grains")                                                                             \
  X(P_MH, "mass_hydrate", 1, "kg", "")                                                                                 \
  X(P_MW, "mass_water", 1, "kg", "")                                                                                   \
  X(P_MG, "mass_gas", 1, "kg", "")                                                                                     \
  X(P_PW, "p_w", 1, "Pa", "water pressure")                                                                            \
  X(P_PG, "p_g", 1, "Pa", "gas pressure")                                                                              \
  X(P_T, "T", 1, "degC", "temperature")                                                                                \
  X(P_GW, "grad_p_w", 2, "Pa/m", "at the end of the last step")                                                        \
  X(P_GG, "grad_p_g", 2, "Pa/m", "")                                                                                   \
  X(P_GT, "grad_T", 2, "K/m", "")                                                                                      \
  X(P_VS, "v_s", 2, "m/s", "skeleton velocity")                                                                        \
  X(P_VW, "v_w", 2, "m/s", "water velocity")                                                                           \
  X(P_VG, "v_g", 2, "m/s", "gas velocity")                                                                             \
  X(P_SIG, "stress", 6, "Pa", "effective, tension-positive: xx yy zz xy yz xz")                                        \
  X(P_SIG0, "stress_initial", 6, "Pa", "initial effective stress, rotated with the body")                              \
  X(P_PW0, "p_w_initial", 1, "Pa", "initial water pressure")                                                           \
  X(P_PG0, "p_g_initial", 1, "Pa", "initial gas pressure")                                                             \
  X(P_RATE, "rate", 4, "1/s", "of p_w, p_g (Pa/s), T (K/s) and S_h at the end of the last step")                       \
  X(P_SH, "S_h", 1, "-", "hydrate saturation")                                                                         \
  X(P_SW, "S_w", 1, "-", "water saturation")                                                                           \
  X(P_PHI, "porosity", 1, "-", "")

/* One enumerator per component: P_X is the first, P_X + 1 the second, ... ; P_COUNT is their number. */
#define CL_PARTICLE_ENUM(id, name, nc, unit, doc) id, id##_LAST_ = id + (nc)-1,
enum { CL_PARTICLE_TABLE(CL_PARTICLE_ENUM) P_COUNT };
#undef CL_PARTICLE_ENUM

typedef struct {
  const char *name, *unit, *doc;
  int         first, nc;
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
  double   *f[P_COUNT]; /* f[component][particle] */
  PetscInt *i[PI_COUNT];
} Particles;

PetscErrorCode ParticlesCreate(Particles *P);
PetscErrorCode ParticlesDestroy(Particles *P);
PetscErrorCode ParticlesResize(Particles *P, PetscInt n); /* keeps the first min(n, old n) */
PetscErrorCode ParticlesCopy(const Particles *from, Particles *to);

#include "clathra/grid.h"

/* Fills the regions of the case with particles, each on the rank that owns its cell, numbered the same whatever the
   number of ranks.  Collective. */
PetscErrorCode ParticlesSeed(const Case *c, const Grid *g, Particles *P);
/* Sends every particle to the owner of its cell; *left counts those outside the grid (nothing is moved then), globally.
   Collective. */
PetscErrorCode ParticlesMigrate(const Grid *g, Particles *P, PetscInt *left);
