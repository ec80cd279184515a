/* explicit: the paper's explicit-implicit scheme (section 3.4): nodal velocities with drag implicit, nodal rates of
   temperature and pressure with the reaction implicit, all by small local solves, no matrix.  docs/equations.md,
   section 12.  Same particles, laws and boundary conditions as the implicit model, whose grid, store and case it uses.
 */
#pragma once

#include "clathra/model.h"

typedef struct {
  bool   drag_implicit; /* hybrid; explicit otherwise */
  bool   paper;         /* the bare form (P72): rates of pressure by the particle, not shared over nodes */
  double damping;       /* local damping of the mixture's out-of-balance force, [0,1) */
  double mass_scaling;  /* factor on every inertia, >= 1 */
} ExplicitOptions;

/* What bounds a step. */
typedef enum {
  LIMIT_NONE = 0,
  LIMIT_WAVE,      /* waves in the mixture */
  LIMIT_THIN,      /* waves in slivers of thin domains (150) */
  LIMIT_WATER,     /* waves in the water */
  LIMIT_GAS,       /* waves in the gas */
  LIMIT_DIFFUSION, /* diffusion of pressure */
  LIMIT_HEAT,      /* conduction of heat */
  LIMIT_DRAG,      /* drag, taken explicitly */
  LIMIT_COUNT
} LimitKind;
extern const char *const cl_limit_word[LIMIT_COUNT];

typedef struct {
  double    each[LIMIT_COUNT]; /* s: bound of each kind alone, INFINITY where there is none */
  double    dt;                /* s: bound of all together */
  double    across;            /* s: shortest time of a wave across a cell, the longest way; INFINITY without waves */
  LimitKind rules;
} StableStep;

typedef struct Explicit Explicit;

/* The integrator of a model, which must outlive it, and its work space.  Collective. */
PetscErrorCode ExplicitCreate(Model *m, const ExplicitOptions *o, Explicit **e);
/* Frees it; *e becomes NULL.  Collective. */
PetscErrorCode ExplicitDestroy(Explicit **e);
/* How long, s, and for how many steps particles have kept what nodes do not see (452). */
typedef struct {
  double   time;
  PetscInt steps;
} Unseen;

/* Sorts the particles by cell and readies nodes and faces for a run of steps.  Collective. */
PetscErrorCode ExplicitBegin(Explicit *e, Unseen unseen, ClStatus *status);
/* ... by now: s, and steps. */
Unseen ExplicitUnseen(const Explicit *e);
/* Largest stable step on the present state (38), (39), (150).  Collective. */
PetscErrorCode ExplicitStableStep(Explicit *e, StableStep *limit);
/* One step from t to t + dt on the committed state; adds what crossed the boundary and what heat changed (integrals
   over the step: kg, J) to *sum.  A failed step leaves particles half-moved: the caller keeps a copy.  Collective. */
PetscErrorCode ExplicitStep(Explicit *e, double t, double dt, StageRates *sum, ClStatus *status);
/* Derived variables of the particles (porosity, saturation of water) for whoever reads them next. */
PetscErrorCode ExplicitEnd(Explicit *e);
/* Largest ratio, over the steps so far, of the inertia that mass scaling added to the forces of the stresses over a
   cell (2-norms over the nodes), dimensionless. */
double ExplicitMassScalingError(const Explicit *e);
/* Bytes (B) that a particle takes: store and work space. */
double ExplicitBytesPerParticle(const Explicit *e);
