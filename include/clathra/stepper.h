/* stepper: time integration.  One loop, many schemes in a function table; three outcomes of a step: done, recoverable
   (rolled back, cut and retried), fatal. */
#pragma once

#include "clathra/case.h"
#include "clathra/explicit.h"
#include "clathra/finding.h"

/* Extremes of particles: mean pore pressure, Pa, and temperature, degC. */
enum { LOWEST_P = 0, HIGHEST_P, LOWEST_T, HIGHEST_T, EXTREMES };
typedef struct {
  double value, t, at[CL_DIM]; /* when, s, and where, m; all zero without the field */
} Extreme;

/* Everything besides the particles that a run carries from step to step (in the checkpoint, so that a restart is bit
 * for bit). */
typedef struct {
  PetscInt step;          /* steps done */
  PetscInt hold;          /* steps during which dt may not grow; -1: a fixed step that was cut grows back */
  PetscInt fresh;         /* 1: no rates of a previous step (start, or just past a kink of a schedule) */
  PetscInt next_snapshot; /* its number */
  PetscInt stage;         /* of the case; t may have reached its end */
  PetscInt newton_total, failures_total, limited_total;
  PetscInt loose_total;  /* steps accepted with an error above the tolerance: at dt_min, or noise of the particles */
  PetscInt uneven_total; /* steps that evened no pressures out within cells: (354) was not found */
  PetscInt ice_total;    /* looks (after a step, or a burst) that found water below its melting point ... */
  PetscInt ice_most;     /* ... and in how many particles at most */
  PetscInt kind;         /* auto: AUTO_... */
  PetscInt votes;        /* auto: looks in a row that asked for the other one */
  PetscInt patience;     /* auto: doubles with every visit of the implicit integrator that did not pay */
  PetscInt unseen_steps; /* hybrid, explicit: steps since particles lost what nodes do not see (452) */
  double   t;            /* s */
  double   unseen;       /* ... and how long that is, s */
  double   dt;           /* next step wanted by the controller, s */
  double   err_old;      /* error of the last accepted step relative to the tolerance */
  double   ice_coldest;  /* how far at most, K */
  double   err_worst;    /* largest error of the steps in loose_total */
  double   peak, peak_of, peak_t, peak_at[CL_DIM]; /* largest Peak of any step, when it was taken (s), and where (m) */
  double   out[PHASE_COUNT];                       /* water and methane gone through the boundary since t = 0, kg */
  double   heat_gain, heat_in, heat_source;        /* J since t = 0 */
  double   squeezed;     /* of the heat source: compression and throttling (290), J since t = 0 */
  double   hydrate0;     /* at the start, kg */
  double   beyond;       /* of the heat source: of reaction, beyond what the state stores (442), J since t = 0 */
  double   enthalpy_out; /* with the fluids (364), J since t = 0 */
  double   left[PHASE_COUNT], moved[PHASE_COUNT];  /* (277), kg since t = 0 */
  double   meter[CL_METERS][METER_COUNT];          /* (33): kg of water and gas, J, outwards since t = 0 */
  double   acts[ACTS_COUNT];                       /* zero: it has given nothing since the stage began */
  double   work[WORK_COUNT];                       /* (90), J since t = 0 */
  double   removed[REMOVED_COUNT];                 /* particles that left the grid (373), since t = 0 */
  double   begin[EXTREMES];                        /* extremes at the start */
  Extreme  extreme[EXTREMES];                      /* ... and of the run so far */
  double   energy[ENERGY_COUNT];                   /* J, as the particles hold them now */
  double   water0, methane0, capacity0, enthalpy0; /* totals at t = 0, kg, J/K, J */
  double   since, spent; /* auto: s of the last change, and seconds of the forecast's machine spent since */
  double   scale_p, scale_T, scale_u; /* largest change of pressure or stress (Pa), temperature (K) and displacement (m)
                                         so far: what errors are   relative to */
} StepperState;

/* The particle whose estimated error is largest, relative to the tolerance; of is an index of stepper_error_word. */
typedef struct {
  double err;
  int    of;
  double at[CL_DIM]; /* m */
} Peak;

#define STEPPER_ERRORS 7 /* p_w, p_g, T, S_h, position, plastic strain, stress */
extern const char *const stepper_error_word[STEPPER_ERRORS];
/* What bounds an implicit step: the error of a field (an index of stepper_error_word), or one of these. */
enum {
  BOUND_GROWTH = STEPPER_ERRORS,
  BOUND_NEWTON,
  BOUND_REFUSED,
  BOUND_STOP,
  BOUND_BEGIN,
  BOUND_MOST,
  BOUND_LEAST,
  BOUND_FIXED,
  BOUNDS
};

/* Numbers of the step just taken, for monitors. */
typedef struct {
  double   dt, err; /* s; error relative to the tolerance (fixed steps: 0) */
  PetscInt newton;
  PetscInt cuts;  /* failures before it succeeded */
  int      rules; /* whose error err is: stepper_error_word */
  int      bound; /* what bounded dt of an implicit step: BOUND_... */
  Peak     peak;
} StepInfo;

#define DIRK_STAGES 4 /* of a Runge-Kutta method, at most */
/* Work space of an implicit step, sized for the particles, nodes and stages of this configuration. */
typedef struct {
  double        *x, *x_star, *u_star;  /* [n_local][fields.n], [n_local][fields.n], [n_local][CL_DIM] */
  double        *x_stage[DIRK_STAGES]; /* x at the end of each stage but the last */
  double        *m_star, *rates, *v_n; /* [n][TRIAL_MASSES], [n][TRIAL_SCALARS], [n][CL_DIM] */
  SkeletonStage *k_star;               /* [n]; null where the skeleton holds no history */
  double        *e_plastic;            /* [n][TRIAL_PLASTIC] errors of Trial.s; null without plasticity */
  Trial          trial[DIRK_STAGES];
  double         drain; /* of the stages to come, 1/s */
  PetscInt       cap_nodes, cap_particles;
  int            stages;
} StepperWork;

/* What one attempt at a step found. */
typedef struct {
  ClStatus status;
  PetscInt newton, limited;
  double   err;                                   /* relative to the tolerance */
  int      rules;                                 /* whose error that is: stepper_error_word */
  Peak     peak;                                  /* behind the mean */
  double   loose;                                 /* ... when it is accepted above 1; else 0 */
  double   out[PHASE_COUNT];                      /* kg over the step */
  double   heat_gain, heat_in, heat_source;       /* J over the step */
  double   squeezed, beyond, enthalpy_out;        /* J over the step */
  double   left[PHASE_COUNT], moved[PHASE_COUNT]; /* kg over the step (277) */
  double   meter[CL_METERS][METER_COUNT];         /* kg, J over the step */
  double   acts[ACTS_COUNT];                      /* zero: it has given nothing in the step */
  double   work[WORK_RATES];                      /* J over the step */
} Attempt;

#define STEPPER_NEWTON 1.6 /* Jacobians a stage that a forecast counts on */
/* Changes that count as one in a step's error besides those of pressure, temperature and displacement. */
#define STEPPER_SCALE_SH 0.1
#define STEPPER_SCALE_EPS 0.1 /* of plastic strain */

typedef struct Stepper Stepper;

/* A diagonally implicit Runge-Kutta method whose last stage ends the step; dimensionless. */
typedef struct {
  int    stages;
  double a[DIRK_STAGES][DIRK_STAGES]; /* rates k_1, k_2, ... of a row's stage; the last row weighs those of the step */
  /* Weights of k_n, k_1, k_2, ... that the error is estimated against; right behind a start or a kink, without k_n: a's
     last row if there is no estimate then. */
  double embedded[DIRK_STAGES + 1], embedded_fresh[DIRK_STAGES + 1];
  int    error_order; /* q: the estimate behaves like dt^q */
} Tableau;

/* A scheme.  advance takes the state to a later time, or says that it cannot (*ok = false); it never commits a step
   that failed. */
typedef struct {
  Integrator     kind;
  const Tableau *tableau; /* of an implicit scheme, which StepperImplicitStep advances; else null, and ... */
  PetscErrorCode (*advance)(Stepper *s, bool *ok);
  ExplicitOptions form; /* of one without a tableau: what does not follow from keys */
  /* what else a scheme needs (may be NULL): its own storage; a check before anything is written, *ok = false refuses */
  PetscErrorCode (*create)(Stepper *s);
  PetscErrorCode (*destroy)(Stepper *s);
  PetscErrorCode (*ready)(Stepper *s, bool *ok);
  /* does it know a way from here, with the stable step in Stepper.limit?  Of a stage that is still to come, too */
  PetscErrorCode (*check)(const Stepper *s, bool *ok);
} StepperScheme;

enum { AUTO_UNDECIDED = 0, AUTO_IMPLICIT, AUTO_HYBRID };
/* What auto looks at; auto.c. */
typedef struct {
  bool     on;       /* stepper_type: auto, with adaptive steps, in a scene that hybrid knows */
  bool     give_way; /* the implicit step failed where hybrid would be the cheaper one */
  PetscInt newton;   /* iterations of all attempts at the last implicit step */
  double   dt;       /* of the last implicit step, s */
  double   good_t;   /* time of Stepper.good, s */
} Auto;

#define STEPPER_SCHEME(name, word, scheme, kinds) extern const StepperScheme StepperScheme_##scheme;
CL_INTEGRATORS(STEPPER_SCHEME)
#undef STEPPER_SCHEME

/* What the rest of the run would cost, roughly: steps, and seconds of the slowest rank. */
typedef struct {
  StableStep limit;
  double     hybrid_steps, hybrid_seconds; /* INFINITY where the scene is none for it */
  double     implicit_steps, implicit_seconds;
  bool       hybrid; /* is the cheaper one */
} Forecast;

struct Stepper {
  Model               *model;
  const StepperScheme *scheme;
  StepperState         state;
  StepperWork          work;
  bool                 adaptive;
  double               dt_min, dt_max, tol;
  PetscInt             max_failures, max_steps;
  int                  crawl; /* steps in a row at whose length the run would not end */
  int                  bound; /* what bounds state.dt: BOUND_... */
  Explicit *explicit;         /* hybrid, explicit: the integrator and the last good state */
  Particles  good;
  StableStep limit;    /* at the last look */
  double     dt_begin; /* hybrid, explicit: the first step of the visit, s (372) */
  Auto       auto_;
  Forecast   forecast;
  /* called after every accepted step */
  PetscErrorCode (*monitor)(Stepper *s, const StepInfo *info, void *ctx);
  void *monitor_ctx;
  bool  broken;             /* the state is not finite any more, or empty: not to be kept */
  bool  empty;              /* the last particle has left the grid */
  bool  stop;               /* ends the run after this step; the monitor may set it */
  int (*interrupted)(void); /* signal that asks for the end, 0 for none; may be NULL */
  int signal;               /* ... on any rank, which set stop */
  /* next time that a step must hit besides kinks and the end; INFINITY if none */
  double (*next_event)(const Stepper *s, void *ctx);
};

/* The case as it holds now: of the stage, if there are any. */
static inline const Case *StepperCase(const Stepper *s)
{
  return CaseOf(s->model->c);
}
PetscErrorCode StepperCreate(Model *m, Stepper *s); /* as the case says */
PetscErrorCode StepperStart(Stepper *s); /* balances and energies from the particles as they are.  Collective */
/* Frees the work space and the integrator's own; the model stays.  Collective. */
PetscErrorCode StepperDestroy(Stepper *s);
/* Before anything is written, at the start or after a restart: what the schemes say about this stage and those to come;
 *ok = false: refused, a sentence was printed. */
PetscErrorCode StepperReady(Stepper *s, bool *ok);
/* Runs to the end of the last stage (or -stepper_max_steps).  *ok = false: given up, the model holds the last good
 * state and a sentence was printed. */
PetscErrorCode StepperRun(Stepper *s, bool *ok);

/* ---- stages.c: docs/architecture.md, "Stages of a case" */
const StepperScheme *StepperSchemeOf(Integrator kind); /* auto: the one of its implicit steps */
/* Takes stage k's case, integrator and step control; the state stays as it is. */
PetscErrorCode StepperTakeStage(Stepper *s, PetscInt k);
/* At the end of a stage that is not the last: the next one begins. */
PetscErrorCode StepperNextStage(Stepper *s);
/* The first step behind a change of stage or integrator is to be dt (s) and knows nothing of those before. */
void StepperForget(StepperState *z, double dt);
/* Is the end of the stage, or of a run without stages, reached? */
bool StepperStageDone(const Stepper *s);
/* Is the end of the last stage reached? */
bool StepperDone(const Stepper *s);
/* Displacement below which errors are not resolved more finely, m. */
double StepperFloorU(const Stepper *s);
/* "stage NAME: ", empty without stages. */
void StepperStageWords(const Stepper *s, char words[80]);
/* "error of T", "growth from step to step", ...: BOUND_... in words. */
void StepperBoundWords(int bound, char words[48]);

/* Fills Stepper.forecast from the state as it is.  Collective. */
PetscErrorCode StepperForecast(Stepper *s);
/* Seconds of the forecast's machine, of this rank: hybrid steps; Newton iterations and factorisations. */
double StepperHybridWork(const Model *m, double steps);
/* Likewise: so many Newton iterations and factorisations, s. */
double StepperImplicitWork(const Model *m, double newton, double factors);
/* Stable step of hybrid on the present state.  Collective. */
PetscErrorCode StepperHybridLimit(Stepper *s, StableStep *limit);
/* The step that hybrid takes of it, s. */
static inline double StepperHybridStep(const Case *c, const StableStep *limit)
{
  return fmin(c->cfl * limit->dt, c->dt_max);
}
#define STEPPER_ADVICE 768
/* What to try where steps are far shorter than the forecast hoped for; newton: steps that it refused shorten them. */
void StepperAdviceSlow(const Stepper *s, bool newton, char words[STEPPER_ADVICE]);
/* Says that the run is given up now, why (behind the time), what may be tried (NULL: what helps against this cause). */
PetscErrorCode StepperGiveUp(const Stepper *s, ClStatus cause, const char *what_to_try, const char *why, ...)
    __attribute__((format(printf, 4, 5)));
/* The same after so many attempts at a step: why the last one failed, and where. */
PetscErrorCode StepperGiveUpStep(const Stepper *s, PetscInt attempts, ClStatus status);
/* Steps that kinks of the loads, output times and dt_max ask for in the last `left` (s) of the stage, at least;
 *kinks (or NULL): how many of them end at a kink. */
double StepperStops(const Stepper *s, double left, double *kinks);
/* A line about Stepper.forecast.  Collective. */
PetscErrorCode StepperPrintForecast(const Stepper *s);

/* ---- learnt.c */
#define LEARNT 400
/* Steps that it took to come to times t (s) since the origin, thinned out. */
typedef struct {
  int    n;
  double t[LEARNT], steps[LEARNT];
  double origin, before; /* s of the scene, and the steps up to it */
} Trace;
#define LEARNT_LATE 10
typedef struct {
  double t, steps, spent; /* s of the scene, number, s of the wall */
} Mark;
/* What a run has learnt since the last kink of a load, or the begin; `late` holds the last steps, the oldest first. */
typedef struct {
  Trace  trace, slump; /* since then, and since steps fell far below what they were (420); n = 0: they did not */
  Mark   late[LEARNT_LATE + 1];
  int    told, marks; /* times told in all; those in `late` */
  double longest;     /* mean of LEARNT_LATE steps in a row, at most, s: since the origin or the slump */
  double all, spent;  /* steps, and seconds of the wall, up to now */
  double step, dt;    /* time of a step of late, s of the wall; the last one, s of the scene */
  double kink;        /* t_k of (345), s: how long after the stage's begin the origin is; 0: it is the begin */
  double doubling;    /* n_k of (345), as known at the origin; 0: not at all */
} Learnt;
/* From time t (s) on times count anew: behind a kink so long (s) after the stage's begin. */
void LearntBegin(Learnt *l, double t, double kink);
/* To come to time t (s) has taken so many steps and seconds of the wall since the start. */
void LearntAdd(Learnt *l, double t, double steps, double spent);
#define AHEAD_KINKS 20
/* What is known of the rest of a stage. */
typedef struct {
  double begin, end, kink[AHEAD_KINKS]; /* s: of the stage; of the kinks that are left */
  double from, forecast; /* s: since when steps are counted; how many were forecast from there to the end, 0: none */
  int    kinks;
  double stretch; /* mean time between two stops, s: a step is no longer */
  bool   more;    /* there are more kinks than are listed */
  bool   even;    /* steps are all alike: a stable or a fixed step, or more kinks */
} Ahead;
/* From the present time on. */
void StepperAhead(const Stepper *s, Ahead *a);
/* Number of steps to the end (dimensionless) by what the run has shown, (318), (319), (345); NAN: nothing is known yet.
 */
double LearntPace(const Learnt *l, const Ahead *a);
/* Number of steps that are left (dimensionless), as often more as less, of those forecast, when n are taken, (411). */
double LearntMedian(double forecast, double n);
/* Number of steps to the end (dimensionless) by both (412); NAN: nothing is known yet. */
double LearntSteps(const Learnt *l, const Ahead *a);
/* The time of the wall that they take, s; NAN: nothing is known yet. */
double LearntLeft(const Learnt *l, const Ahead *a);
/* The time of the wall to the end, s, if time went on as in the last steps, (421); NAN: there are too few. */
double LearntFlat(const Learnt *l, const Ahead *a);

/* ---- auto.c: docs/equations.md, section 15 */
/* The integrator a stage begins with, or a restart goes on with. */
PetscErrorCode StepperAutoBegin(Stepper *s);
/* After this attempt of length dt (s) failed, the last one allowed or not: is it time for hybrid?  After one that (356)
   refused the next, of state.dt with as many Newton iterations, is what hybrid has to be cheaper than. */
PetscErrorCode StepperAutoGivesWay(Stepper *s, const Attempt *a, double dt, bool last, bool *yes);
/* After every step: goes over to the other integrator where that pays. */
PetscErrorCode StepperAutoDecide(Stepper *s, bool *ok);
/* auto, after an attempt of length dt (s) that Newton's method solved: a step over a slide is refused, a->status
   CL_TOO_FAR (356).  Collective. */
PetscErrorCode StepperCheckEquilibrium(Stepper *s, double dt, Attempt *a);
/* Share of the motion that nodes do not see which is lost over an implicit step of length dt (s) (452).  Collective. */
PetscErrorCode StepperUnseen(Stepper *s, double dt, double *share);

/* Shared by the schemes. */
/* The next time (s) that a step must hit: a kink of a schedule, an event, the end. */
double StepperNextStop(const Stepper *s, bool *kink);
/* extremes.c: those of the particles as they are go into the state; at the start, after every accepted step or burst.
   Collective. */
PetscErrorCode StepperExtremes(Stepper *s, bool start);
/* The temperature, degC, at which hydrate of any material would be in equilibrium with p (Pa), the highest of them or
   the lowest, if `from` is less far out; forming hydrate warms up to it, melting cools down to it. */
double StepperEquilibrium(const Scene *c, double from, double p, bool warm);
/* Adds rates times a weight (s), or integrals with weight 1, to what an attempt found. */
void StepperCount(const Scene *c, const StageRates *rates, double weight, Attempt *a);
/* leaving.c: what left the grid in the accepted step or burst goes into the state, and a line says so for each
   particle; a run that has none left is broken.  Collective. */
PetscErrorCode StepperCountLeaving(Stepper *s);
/* What is missing, of the initial mass of water and methane (of nothing: kg) and of the heat that warms the body by 1
 * K.
 */
void StepperErrors(const StepperState *z, const ModelTotals *now, double error[3]);
/* Adds up what an accepted step found, and calls the monitor; t and dt are the scheme's to set. */
PetscErrorCode StepperAccept(Stepper *s, const Attempt *a, const StepInfo *info);
/* Norm (292), over the tolerance, of the errors e [n][TRIAL_SCALARS] (Pa, Pa, K, 1), eu [n][CL_DIM] (m) and those of
   plastic states; a->rules says which it is, a->peak where the largest of any is.  Collective. */
double StepperErrorNorm(Stepper *s, const double *e, const double *eu, Attempt *a);
/* One attempt of length dt (s) at a step of the scheme's tableau on the configuration that ModelBeginStep prepared:
   leaves the solution in work.x and the rates in work.rates and commits nothing.  Collective. */
PetscErrorCode StepperDirkStep(Stepper *s, double dt, Attempt *a);
/* Has the next step no estimate of its error? */
bool StepperBlind(const Stepper *s);
/* The advance of schemes that have a tableau: attempts, control of their length, commit.  Collective. */
PetscErrorCode StepperImplicitStep(Stepper *s, bool *ok);
/* energy.c: the mechanical balance (90).  What the particles hold at the start; what the works of an accepted step made
   of it; what a change of materials does.  Collective. */
PetscErrorCode StepperEnergyStart(Stepper *s);
/* After a step: work in J, WORK_....  Collective. */
PetscErrorCode StepperEnergyStep(Stepper *s, const double work[WORK_RATES]);
/* After a change of stage: materials may hold another elastic energy.  Collective. */
PetscErrorCode StepperEnergyChange(Stepper *s);
/* Frees the arrays of a work space. */
PetscErrorCode StepperFreeWork(StepperWork *w);
/* In words, for messages. */
const char *StepperStatusName(ClStatus st);
const char *StepperName(const Stepper *s); /* of the integrator that works now */
/* Of the implicit steps of this run, or of those that auto would take. */
const Tableau *StepperTableau(const Stepper *s);
