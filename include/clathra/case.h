/* case: everything that cases/<name>/case.yaml and the command line say: the scene, and how to run it. */
#pragma once

#include "clathra/scene.h"

#include <string.h>

/* Quantities that probes may write: word, and the fields any of which it needs; those before the skeleton's history,
   variable by variable, and those behind. */
#define CL_QUANTITIES(X)                                                                                               \
  X(QUANTITY_P, "p", HAS_WATER)                                                                                        \
  X(QUANTITY_PW, "p_w", HAS_WATER)                                                                                     \
  X(QUANTITY_PG, "p_g", HAS_GAS)                                                                                       \
  X(QUANTITY_T, "T", HAS_HEAT)                                                                                         \
  X(QUANTITY_SH, "S_h", HAS_ALL)                                                                                       \
  X(QUANTITY_SW, "S_w", HAS_WATER)                                                                                     \
  X(QUANTITY_SG, "S_g", HAS_GAS)                                                                                       \
  X(QUANTITY_U, "u", HAS_SOLID)                                                                                        \
  X(QUANTITY_STRESS, "stress", HAS_SOLID)                                                                              \
  X(QUANTITY_X, "x", HAS_ALL)
#define CL_QUANTITIES_BEHIND(X)                                                                                        \
  X(QUANTITY_MEAN, "p_eff", HAS_PLASTIC)    /* mean effective stress, compression-positive */                          \
  X(QUANTITY_Q, "q", HAS_PLASTIC)           /* deviatoric stress sqrt(3 J2) */                                         \
  X(QUANTITY_STRAIN, "strain", HAS_PLASTIC) /* volumetric and deviatoric */                                            \
  X(QUANTITY_YIELD, "yield", HAS_PLASTIC)   /* distance to yield; is it reached? */
#define CL_QUANTITY_ID(id, word, has) id,
enum {
  CL_QUANTITIES(CL_QUANTITY_ID) QUANTITY_HISTORY,
  QUANTITY_HISTORY_LAST = QUANTITY_HISTORY + SKELETON_HISTORY - 1,
  CL_QUANTITIES_BEHIND(CL_QUANTITY_ID) QUANTITY_COUNT
};

/* A point whose history is written, or what the history of a mean is taken over. */
typedef struct {
  char     name[64];
  double   x[CL_DIM]; /* m, initial position; infinite: a mean */
  bool     fixed;     /* stays there in space, not with the material */
  PetscInt over;      /* mean over this region, by volume; -1: not */
  Meter    surface;   /* mean over this part of the surface, by area; SIDE_COUNT without a line: not */
} Probe;

enum { ICE_WARN = 0, ICE_STOP };
enum { LEAVING_STOP = 0, LEAVING_REMOVE };

/* Time integrators.  X(name, word of stepper_type, scheme in src/stepper, kinds it honours what is known to); auto
   takes steps of that scheme in turn with hybrid. */
#define CL_INTEGRATORS(X)                                                                                              \
  X(SDIRK2, "sdirk2", Sdirk2, BY_IMPLICIT)             /* two stages, second order */                                  \
  X(EULER, "euler", Euler, BY_IMPLICIT)                /* backward, first order */                                     \
  X(HYBRID, "hybrid", Hybrid, BY_EXPLICIT)             /* explicit motion, implicit drag and reaction */               \
  X(EXPLICIT, "explicit", Explicit, BY_EXPLICIT)       /* ... and explicit drag */                                     \
  X(PAPER, "hybrid_paper", Paper, BY_PAPER)            /* the paper's bare form of hybrid */                           \
  X(AUTO, "auto", Sdirk2, BY_ALL_BUT_PAPER | BY_TURNS) /* the cheaper one at any time */
#define CL_INTEGRATOR_ID(name, ...) INTEGRATOR_##name,
typedef enum { CL_INTEGRATORS(CL_INTEGRATOR_ID) INTEGRATOR_COUNT } Integrator;
#undef CL_INTEGRATOR_ID
extern const char *const case_integrator[INTEGRATOR_COUNT + 1]; /* the words; ended by NULL */

#define CL_INTEGRATOR_KINDS(name, word, scheme, kinds) kinds,
/* Kinds (BY_...) of an integrator. */
static inline unsigned IntegratorKinds(Integrator integrator)
{
  static const unsigned kinds[INTEGRATOR_COUNT] = {CL_INTEGRATORS(CL_INTEGRATOR_KINDS)};

  return kinds[integrator];
}
#undef CL_INTEGRATOR_KINDS

typedef struct Case {
  Scene scene;                    /* first: CaseOf */
  char  file[PETSC_MAX_PATH_LEN]; /* the case file */
  char  title[256];
  char  fields_wanted[64]; /* auto, or the words of cl_field_word, or the name of a set */
  int   ice;               /* ICE_... */
  int   leaving;           /* LEAVING_...: what becomes of particles that leave the grid (373) */
  /* time: the command line's -stepper_* options win over these */
  double     t_end;
  Integrator integrator;
  bool       adaptive;
  double     dt, dt_min, dt_max; /* s; dt = first (adaptive) or fixed step */
  double     tol;                /* relative tolerance of the error estimate */
  double     error_exponent;     /* of its mean over the particles (292) */
  PetscInt   max_failures;       /* cuts in a row before the run is given up */
  /* hybrid and explicit */
  double cfl;          /* step as a share of the stable one */
  bool   force_dt;     /* take a fixed step above the stable one all the same */
  double damping;      /* local damping */
  double mass_scaling; /* factor on inertia */
  /* output */
  char     output_dir[PETSC_MAX_PATH_LEN]; /* default results/<case name> */
  PetscInt ntimes;                         /* field snapshots at these times (hit exactly) ... */
  double  *times;
  PetscInt nprobe;
  Probe   *probe;
  char     quantities_wanted[128]; /* all, or words */
  unsigned quantities;             /* bits 1 << QUANTITY_... that probes write; 0 = all of the scene's fields */
  double   every;                  /* ... and every so many seconds (0 = off) */
  double   probe_every;            /* s between probe rows, hit exactly; 0 = every step */
  double   checkpoint_every;       /* s; 0 = only at the end and on failure */
  double   standard_pressure, standard_temperature; /* Pa, degC: what standard volumes are said to be at */
  double   standard_gas_density;                    /* kg/m^3 there: what they are computed with */
  /* stages, the same in the case and in all of them */
  PetscInt          nstage;
  struct CaseStage *stage;
} Case;

/* The case that a scene is part of.  Every scene of a run is; physics does not ask. */
static inline const Case *CaseOf(const Scene *s)
{
  return (const Case *)s;
}

/* One of the stages of a run, which follow each other in time. */
typedef struct CaseStage {
  char   name[64];
  double end;                         /* s; it begins where the one before ends */
  bool   reset;                       /* displacements count from its begin */
  bool   reaction;                    /* hydrate forms and dissociates, where a material reacts */
  char   boundaries[2048], off[2048]; /* those that act: all, or names; or all but these names */
  char   materials[2048];             /* region, material, region, material, ... */
  Case   c; /* the case as it holds in this stage: conditions and materials of its own, the rest shared */
} CaseStage;

/* What keeps the case from steps without a matrix, as it says it (a boundary by its name); NULL if nothing does.  auto
   has what its implicit steps have, in turn. */
static inline const char *CaseNeedsImplicit(const Case *c)
{
  return SceneUnknown(&c->scene, BY_EXPLICIT | (IntegratorKinds(c->integrator) & BY_TURNS));
}

/* The case as it holds in stage k; the case itself if it has no stages. */
static inline const Case *CaseInStage(const Case *c, PetscInt k)
{
  return c->nstage ? &c->stage[k].c : c;
}

/* Has the run, or the stage whose case this is, ended at time t (s)? */
static inline bool CaseAtEnd(const Case *c, double t)
{
  return t >= c->t_end - SceneTimeSlack(&c->scene, c->t_end);
}

/* Reads and checks a case (a folder or a .yaml file) together with the options database, collectively.
   On bad input prints the error (file, key, value, unit, allowed range, nearest key) on rank 0, sets *ok = false and
   returns success; nothing has been written. */
PetscErrorCode CaseRead(MPI_Comm comm, const char *path, Case *c, bool *ok);
PetscErrorCode CaseWriteResolved(const Case *c, FILE *out); /* SI, itself a case that runs to the same result */
/* What a restart must find unchanged: all keys but names, outputs, and the numerics of time and of the solver. */
uint64_t CaseFingerprint(const Case *c);
/* The same in lines "key, tab, value", in SI; of a case with stages each begins with "in stage NAME: ". */
PetscErrorCode CaseWriteBound(const Case *c, FILE *out);
/* What a state of its particles needs to be the initial state of another case: lines "key: value" of the grid, regions
   and what their materials tie it to, in SI; both cases must have the same. */
PetscErrorCode CaseWriteState(const Case *c, FILE *out);
/* What CaseWriteResolved, CaseWriteBound or CaseWriteState writes, to be freed. */
PetscErrorCode CaseText(const Case *c, PetscErrorCode (*write)(const Case *c, FILE *out), char **text, size_t *size);
/* Frees all that CaseRead made, and the stages. */
PetscErrorCode CaseDestroy(Case *c);
/* Prints every case key (name, kind, unit, range, default, meaning) as Markdown: the source of docs/options.md and
 * -help. */
PetscErrorCode CasePrintKeys(FILE *out);
/* How many numbers the grid of a case (a folder or a file) has; 0: the file does not say.  Before MPI begins. */
int CaseAxes(const char *given);
/* Is -case_keys given, and does it not say no?  A word that says neither yes nor no asks for nothing here: CaseRead
   refuses it. */
PetscErrorCode CaseKeysAsked(PetscBool *asked);
