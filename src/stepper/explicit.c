/* hybrid and explicit: many small steps without a matrix between two looks at the clock; docs/equations.md, section 12.
 */
#include "clathra/stepper.h"
#include "clathra/words.h"

#define BURST 256 /* steps between two estimates of the stable step, and at most lost by a failure */
#define CUT 0.5   /* of the step after a burst that failed */
#define HOLD 8    /* bursts at the smaller step after that */
#define GONE 1e-6 /* of the step that a visit began with (372) */

static PetscErrorCode Create(Stepper *s)
{
  const Case     *c = StepperCase(s);
  ExplicitOptions o = s->scheme->form;

  PetscFunctionBeginUser;
  o.damping      = c->damping;
  o.mass_scaling = c->mass_scaling;
  PetscCall(ExplicitCreate(s->model, &o, &s->explicit));
  PetscCall(ParticlesCreate(c->scene.fields.has, &s->good));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Destroy(Stepper *s)
{
  PetscFunctionBeginUser;
  PetscCall(ExplicitDestroy(&s->explicit));
  PetscCall(ParticlesDestroy(&s->good));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A fixed step above the stable one is refused. */
static PetscErrorCode CheckFixed(const Stepper *s, bool *ok)
{
  const double dt = StepperCase(s)->dt;
  char         stage[80];

  PetscFunctionBeginUser;
  if (s->adaptive || StepperCase(s)->force_dt || dt <= s->limit.dt)
    PetscFunctionReturn(PETSC_SUCCESS);
  *ok = false;
  StepperStageWords(s, stage);
  PetscCall(
      PetscFPrintf(s->model->grid.comm, stderr,
                   "clathra: %s: %sstepper_dt = %g s is above the stable step of %g s (%s rules); allowed (0 s,%g "
                   "s], or -stepper_force_dt "
                   "yes, or -stepper_adapt yes\n",
                   StepperCase(s)->file, stage, dt, s->limit.dt, cl_limit_word[s->limit.rules], s->limit.dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* No stable step, or a fixed one above it. */
static PetscErrorCode Check(const Stepper *s, bool *ok)
{
  char stage[80];

  PetscFunctionBeginUser;
  if (!(s->limit.dt > 0.0)) {
    *ok = false;
    StepperStageWords(s, stage);
    PetscCall(PetscFPrintf(
        s->model->grid.comm, stderr,
        "clathra: %s: %sstepper_type: %s has no stable step here (water without compressibility carries waves at any "
        "speed); use sdirk2 or euler\n",
        StepperCase(s)->file, stage, StepperName(s)));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(CheckFixed(s, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The step to take, but for stops. */
static double Free(const Stepper *s)
{
  return s->adaptive ? fmin(StepperCase(s)->cfl * s->limit.dt, s->dt_max) : StepperCase(s)->dt;
}

static Unseen Kept(const Stepper *s)
{
  return (Unseen){s->state.unseen, s->state.unseen_steps};
}

static PetscErrorCode Ready(Stepper *s, bool *ok)
{
  char     text[512];
  size_t   n = 0;
  ClStatus status;

  PetscFunctionBeginUser;
  s->model->t_n = s->state.t;
  PetscCall(ExplicitBegin(s->explicit, Kept(s), &status));
  PetscCall(ExplicitStableStep(s->explicit, &s->limit));
  for (int k = LIMIT_NONE + 1; k < LIMIT_COUNT; k++) {
    if (s->limit.each[k] < INFINITY && n < sizeof(text))
      n += (size_t)snprintf(text + n, sizeof(text) - n, "%s %s %.3g s", n ? "," : "", cl_limit_word[k],
                            s->limit.each[k]);
  }
  PetscCall(PetscPrintf(s->model->grid.comm,
                        "  stable step %.4g s:%s; %s rules; the reaction is implicit and sets no bound\n", s->limit.dt,
                        text, cl_limit_word[s->limit.rules]));
  PetscCall(Check(s, ok));
  s->dt_begin = Free(s);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ... after a burst that failed, without stops. */
static double Wanted(const Stepper *s)
{
  return s->state.hold > 0 ? fmin(s->state.dt, Free(s)) : Free(s);
}

/* Steps to take until the next stop, and their length. */
static PetscInt Plan(const Stepper *s, double stop, double *dt)
{
  const double left = stop - s->state.t, wanted = Wanted(s);
  const double n = fmax(ceil(left / wanted - 1e-9), 1.0);

  *dt = n <= BURST || s->adaptive ? left / n : wanted;
  return (PetscInt)fmin(n, BURST);
}

/* Means over a burst of n steps, for meters.csv. */
static StageRates Rates(const StageRates *sum, double time)
{
  StageRates mean = *sum;
  double    *v    = (double *)&mean;

  for (size_t k = 0; k < sizeof(mean) / sizeof(double); k++)
    v[k] /= time;
  return mean;
}

/* A burst of n steps; the sums are those of all ranks. */
static PetscErrorCode Burst(Stepper *s, PetscInt n, double dt, Attempt *a)
{
  Model     *m   = s->model;
  StageRates sum = {0};

  PetscFunctionBeginUser;
  m->limited  = 0;
  m->released = 0.0;
  ModelForgetLeaving(m);
  for (PetscInt k = 0; k < n && a->status == CL_OK; k++)
    PetscCall(ExplicitStep(s->explicit, s->state.t + (double)k * dt, dt, &sum, &a->status));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &sum, sizeof(sum) / sizeof(double), MPI_DOUBLE, MPI_SUM, m->grid.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &m->limited, 1, MPIU_INT, MPI_SUM, m->grid.comm));
  StepperCount(m->c, &sum, 1.0, a);
  m->rates   = Rates(&sum, (double)n * dt);
  a->limited = m->limited;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The accepted burst becomes history; nodal values of the new state are there for whoever writes them. */
static PetscErrorCode Accept(Stepper *s, PetscInt n, double dt, double stop, bool reached, const Attempt *a,
                             PetscInt cuts)
{
  StepperState  *z    = &s->state;
  const StepInfo info = {.dt = dt, .cuts = cuts};
  ClStatus       status;

  PetscFunctionBeginUser;
  z->step += n;
  z->t     = reached ? stop : z->t + (double)n * dt;
  z->dt    = dt;
  z->fresh = 1;
  if (z->hold > 0)
    z->hold--;
  z->unseen       = ExplicitUnseen(s->explicit).time;
  z->unseen_steps = ExplicitUnseen(s->explicit).steps;
  PetscCall(ExplicitEnd(s->explicit));
  s->model->t_n = z->t;
  if (reached)
    PetscCall(ModelBeginStep(s->model, &status));
  PetscCall(StepperAccept(s, a, &info));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The stable step as it is now; says so when another limit sets it. */
static PetscErrorCode Limit(Stepper *s)
{
  const LimitKind before = s->limit.rules;

  PetscFunctionBeginUser;
  PetscCall(ExplicitStableStep(s->explicit, &s->limit));
  if (s->limit.rules != before && before != LIMIT_NONE)
    PetscCall(PetscPrintf(s->model->grid.comm, "t = %s: %s rules now, stable step %.4g s (%s before)\n",
                          TimeAt(s->state.t).s, cl_limit_word[s->limit.rules], s->limit.dt, cl_limit_word[before]));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A run whose steps have shrunk to nothing is ended (372), for it would not end by itself. */
static PetscErrorCode CheckGone(const Stepper *s, bool *ok)
{
  PetscFunctionBeginUser;
  if (Wanted(s) >= GONE * s->dt_begin)
    PetscFunctionReturn(PETSC_SUCCESS);
  *ok = false;
  PetscCall(StepperGiveUp(s, CL_TOO_FAR, NULL, ": the step of %s has come down from %.2g s to %.2g s (%s rules%s)",
                          StepperName(s), s->dt_begin, Wanted(s), cl_limit_word[s->limit.rules],
                          s->state.hold > 0 ? ", and steps were refused" : ""));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The particles as they were before the burst, with their owners of now. */
static PetscErrorCode GoBack(Stepper *s)
{
  Model   *m = s->model;
  PetscInt left;

  PetscFunctionBeginUser;
  PetscCall(ParticlesCopy(&s->good, &m->P));
  PetscCall(ParticlesMigrate(&m->grid, &m->P, &left));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode Advance(Stepper *s, bool *ok)
{
  Model         *m   = s->model;
  const Failure *why = ModelFailure(m);
  bool           kink;
  const double   stop = StepperNextStop(s, &kink);

  PetscFunctionBeginUser;
  *ok = true;
  PetscCall(ParticlesCopy(&m->P, &s->good));
  s->auto_.good_t = s->state.t;
  for (PetscInt cuts = 0;; cuts++) {
    Attempt a = {.status = CL_OK};
    double  dt;

    s->model->t_n = s->state.t;
    PetscCall(ExplicitBegin(s->explicit, Kept(s), &a.status));
    PetscCall(Limit(s));
    bool stable = true;
    PetscCall(CheckFixed(s, &stable));
    if (!stable) {
      *ok = false;
      PetscCall(StepperGiveUp(s, CL_OK, "stepper_adapt: yes, which follows the stable step; a shorter stepper_dt",
                              ": the fixed step is above the stable one by now"));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(CheckGone(s, ok));
    if (!*ok)
      PetscFunctionReturn(PETSC_SUCCESS);
    const PetscInt n = Plan(s, stop, &dt);
    if (a.status == CL_OK)
      PetscCall(Burst(s, n, dt, &a));
    if (a.status == CL_OK) {
      PetscCall(Accept(s, n, dt, stop, s->state.t + (double)n * dt >= stop - 0.5 * dt, &a, cuts));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    PetscCall(GoBack(s));
    s->state.dt    = CUT * dt;
    s->state.hold  = HOLD;
    const bool out = a.status == CL_LEFT_GRID; /* as it would with any step */
    if (!out)
      PetscCall(PetscPrintf(
          m->grid.comm, "t = %s: up to %" PetscInt_FMT " steps of %g s refused (%s: %s near %s); trying %g s\n",
          TimeAt(s->state.t).s, n, dt, StepperStatusName(a.status), why->why, PlaceWords(why->where).s, s->state.dt));
    if (out || cuts >= s->max_failures) {
      *ok = false;
      PetscCall(StepperGiveUpStep(s, cuts + 1, a.status));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
}

#define WITHOUT_MATRIX(integrator, ...)                                                                                \
  {                                                                                                                    \
    .kind = (integrator), .advance = Advance, .form = {__VA_ARGS__}, .create = Create, .destroy = Destroy,             \
    .ready = Ready, .check = Check                                                                                     \
  }

const StepperScheme StepperScheme_Hybrid   = WITHOUT_MATRIX(INTEGRATOR_HYBRID, .drag_implicit = true);
const StepperScheme StepperScheme_Paper    = WITHOUT_MATRIX(INTEGRATOR_PAPER, .drag_implicit = true, .paper = true);
const StepperScheme StepperScheme_Explicit = WITHOUT_MATRIX(INTEGRATOR_EXPLICIT);
