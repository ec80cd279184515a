/* Implicit schemes: attempts at a step with ever smaller dt until one is accepted; error norm and step control. */
#include "clathra/stepper.h"
#include "clathra/words.h"

#define CUT_FAILED 0.25 /* after a step that could not be taken */
#define HOLD 5          /* steps without growth after that */
#define RETURNS (-1)    /* of `hold`: a fixed step that was cut grows back */
#define CUT_AT_KINK 0.1 /* first step behind a kink of a schedule */
#define EASY_NEWTON 6   /* growth only while Newton needs no more iterations a stage */
#define SAFE 0.9        /* of the step that would just meet the tolerance */
#define LEAST_CUT 0.2   /* a step is cut to at once, by its error, ... */
#define LEAST_RETRY 0.1 /* ... and when two attempts have shown how that falls */
#define CRAWL 1e7       /* a run that needs so many more steps at its present length ... */
#define CRAWL_STEPS 100 /* ... and that for so many in a row, will not end */

PetscErrorCode StepperFreeWork(StepperWork *w)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree3(w->x, w->x_star, w->u_star));
  PetscCall(PetscFree3(w->m_star, w->rates, w->v_n));
  for (int k = 0; k < w->stages; k++) {
    PetscCall(PetscFree(w->x_stage[k]));
    PetscCall(PetscFree4(w->trial[k].m, w->trial[k].y, w->trial[k].u, w->trial[k].v));
    PetscCall(PetscFree(w->trial[k].end));
    PetscCall(PetscFree2(w->trial[k].s, w->trial[k].k));
  }
  PetscCall(PetscFree(w->k_star));
  PetscCall(PetscFree(w->e_plastic));
  w->cap_nodes = w->cap_particles = 0;
  w->stages                       = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode SizeWork(Stepper *s)
{
  StepperWork    *w  = &s->work;
  const FieldSet *fs = &s->model->c->fields;
  const PetscInt  n = s->model->P.cap, N = s->model->map.n_local;
  const int       stages = s->scheme->tableau->stages;

  PetscFunctionBeginUser;
  if (n <= w->cap_particles && N <= w->cap_nodes && stages == w->stages)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StepperFreeWork(w));
  PetscCall(PetscCalloc3(N * fs->n, &w->x, N * fs->n, &w->x_star, N * CL_DIM, &w->u_star));
  PetscCall(PetscCalloc3(TRIAL_MASSES * n, &w->m_star, TRIAL_SCALARS * n, &w->rates, CL_DIM * n, &w->v_n));
  for (int k = 0; k < stages; k++) {
    Trial *to = &w->trial[k];

    if (k < stages - 1)
      PetscCall(PetscCalloc1(N * fs->n, &w->x_stage[k]));
    PetscCall(
        PetscCalloc4(TRIAL_MASSES * n, &to->m, TRIAL_SCALARS * n, &to->y, CL_DIM * n, &to->u, CL_DIM * n, &to->v));
    if (fs->has & HAS_HISTORY)
      PetscCall(PetscCalloc1(n, &to->end));
    if (fs->has & HAS_PLASTIC)
      PetscCall(PetscCalloc2(TRIAL_PLASTIC * n, &to->s, TRIAL_PLASTIC * n, &to->k));
  }
  if (fs->has & HAS_HISTORY)
    PetscCall(PetscCalloc1(n, &w->k_star));
  if (fs->has & HAS_PLASTIC)
    PetscCall(PetscCalloc1(TRIAL_PLASTIC * n, &w->e_plastic));
  w->stages        = stages;
  w->cap_nodes     = N;
  w->cap_particles = n;
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *const stepper_error_word[STEPPER_ERRORS] = {"p_w",   "p_g", "T", "S_h", "displacement", "plastic strain",
                                                        "stress"};

void StepperBoundWords(int bound, char words[48])
{
  static const char *const word[BOUNDS] = {[BOUND_GROWTH]  = "growth from step to step",
                                           [BOUND_NEWTON]  = "Newton's method",
                                           [BOUND_REFUSED] = "refused steps",
                                           [BOUND_STOP]    = "times to be hit",
                                           [BOUND_BEGIN]   = "begin or kink",
                                           [BOUND_MOST]    = "stepper_dt_max",
                                           [BOUND_LEAST]   = "stepper_dt_min",
                                           [BOUND_FIXED]   = "stepper_dt"};

  words[0] = '\0';
  if (bound < STEPPER_ERRORS)
    snprintf(words, 48, "error of %s", stepper_error_word[bound]);
  else if (bound < BOUNDS)
    snprintf(words, 48, "%s", word[bound]);
}

/* Gustafsson's PI controller: the step that would just meet the tolerance, as far as the wanted step may grow at once;
   which of the two it is. */
static double Controller(const Stepper *s, double dt, const Attempt *a, int *bound)
{
  const double q = s->scheme->tableau->error_order, err = fmax(a->err, 1e-4), old = fmax(s->state.err_old, 1e-4);
  const bool   blind     = StepperBlind(s);
  const bool   hard      = a->newton > EASY_NEWTON * s->scheme->tableau->stages || s->state.hold > 0;
  const bool   cut_short = dt < 0.999 * s->state.dt; /* by an event: err_old says nothing about growth */
  const double gain      = cut_short ? pow(err, -1.0 / q) : pow(err, -0.7 / q) * pow(old, 0.4 / q);
  const double fit       = blind ? INFINITY : SAFE * dt * gain;
  const double most      = hard ? fmax(dt, s->state.dt) : 2.0 * fmax(dt, s->state.dt);

  if (fit < most)
    *bound = a->rules;
  else if (hard)
    *bound = s->state.hold > 0 ? BOUND_REFUSED : BOUND_NEWTON;
  else
    *bound = BOUND_GROWTH;
  return fmax(LEAST_CUT * dt, fmin(fit, most));
}

/* The step to take: dt as wanted, but never across a kink, an event or the end; what is left before those is shared out
   evenly over the last three steps so that no sliver remains, but for fixed steps that none has cut. */
static double NextStep(const Stepper *s, bool *kink)
{
  const double wanted = s->state.dt, left = StepperNextStop(s, kink) - s->state.t, n = ceil(left / wanted - 1e-9);

  *kink = *kink && n <= 1.0;
  if (n <= 1.0)
    return left;
  return (s->adaptive || s->state.hold != 0) && n <= 3.0 ? left / n : wanted;
}

/* dt for the next step, after a step of length dt was accepted, and what bounds it. */
static double WantedStep(const Stepper *s, double dt, bool kink, const Attempt *a, int *bound)
{
  const StepperState *z = &s->state;
  double              next;

  if (!s->adaptive) { /* back to the fixed step after a cut */
    next   = z->hold > 0 ? z->dt : fmin(2.0 * z->dt, StepperCase(s)->dt);
    *bound = next < StepperCase(s)->dt ? BOUND_REFUSED : BOUND_FIXED;
    return next;
  }
  next = Controller(s, dt, a, bound);
  if (kink)
    next *= CUT_AT_KINK;
  if (next > s->dt_max)
    *bound = BOUND_MOST;
  else if (next < s->dt_min)
    *bound = BOUND_LEAST;
  return fmin(fmax(next, s->dt_min), s->dt_max);
}

/* What bounds the step that is taken, of length dt where `wanted` was. */
static int Bound(const Stepper *s, double dt, double wanted, PetscInt cuts)
{
  if (dt < 0.999 * wanted)
    return BOUND_STOP;
  return s->state.fresh && s->adaptive && !cuts ? BOUND_BEGIN : s->bound;
}

static PetscErrorCode Accept(Stepper *s, double dt, bool kink, const Attempt *a, PetscInt cuts)
{
  StepperState  *z    = &s->state;
  const StepInfo info = {.dt     = dt,
                         .err    = a->err,
                         .newton = a->newton,
                         .cuts   = cuts,
                         .rules  = a->rules,
                         .bound  = Bound(s, dt, z->dt, cuts),
                         .peak   = a->peak};
  double         unseen;

  PetscFunctionBeginUser;
  PetscCall(StepperUnseen(s, dt, &unseen));
  PetscCall(ModelCommit(s->model, s->work.x, &s->work.trial[s->scheme->tableau->stages - 1], s->work.rates, unseen));
  z->uneven_total += s->model->uneven;
  z->step++;
  z->t += dt;
  z->dt      = WantedStep(s, dt, kink, a, &s->bound);
  z->err_old = a->err;
  z->fresh   = kink;
  if (z->hold > 0)
    z->hold--;
  if (z->hold <= 0 && !s->adaptive)
    z->hold = z->dt < StepperCase(s)->dt ? RETURNS : 0;
  PetscCall(StepperAccept(s, a, &info));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A cut that hardly lowers the error: it is noise of the space discretisation (particles that changed cells since the
   last step), which no dt mends. */
static bool IsNoise(const Stepper *s, double dt, double err, double dt_old, double err_old)
{
  return err_old > 0.0 && dt < dt_old && err > err_old * pow(dt / dt_old, 0.25 * s->scheme->tableau->error_order);
}

/* Is the error of an attempt small enough, noise, or, at dt_min, to be put up with? */
static void Judge(Stepper *s, double dt, double dt_old, double err_old, Attempt *a)
{
  if (!isfinite(a->err)) {
    a->status = CL_NONFINITE;
    ModelExplain(s->model, "the error estimate is not a number");
  } else if (a->err > 1.0 && dt > s->dt_min && !IsNoise(s, dt, a->err, dt_old, err_old)) {
    a->status = CL_INACCURATE;
  } else if (a->err > 1.0) {
    a->loose = a->err;
    if (dt > s->dt_min)
      a->err = 1.0; /* noise */
  }
}

/* dt after an attempt with such an error, which the one before shows how to fall with dt, if it was refused for its
   error too: right behind a start or a kink, where a front sets out, it does so by an order less than the estimate's
   (422). */
static double Retry(const Stepper *s, double dt, double err, double dt_old, double err_old)
{
  const double order = s->scheme->tableau->error_order;

  if (!(err_old > err))
    return dt * fmax(LEAST_CUT, SAFE * pow(err, -1.0 / order));
  const double falls = log(err_old / err) / log(dt_old / dt);

  return dt * fmax(LEAST_RETRY, pow(SAFE / err, 1.0 / fmin(falls, order)));
}

/* An adaptive run whose steps have shrunk to nothing is ended, for it would not end by itself. */
static PetscErrorCode CheckCrawl(Stepper *s, double dt, bool *ok)
{
  const double left = StepperCase(s)->t_end - s->state.t;

  PetscFunctionBeginUser;
  s->crawl = s->adaptive && left > CRAWL * dt ? s->crawl + 1 : 0;
  if (s->crawl < CRAWL_STEPS)
    PetscFunctionReturn(PETSC_SUCCESS);
  *ok = false;
  PetscCall(StepperGiveUp(s, CL_INACCURATE, NULL,
                          ": for %d steps dt has been about %s, at which the rest would take %.1g steps", CRAWL_STEPS,
                          TimeWords(dt, 2).s, left / dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* One step: attempts with ever smaller dt until one is accepted or the budget is spent. */
PetscErrorCode StepperImplicitStep(Stepper *s, bool *ok)
{
  Model         *m   = s->model;
  const Failure *why = ModelFailure(m);
  ClStatus       status;
  double         dt_inaccurate = 0.0, err_inaccurate = 0.0;
  char           text[CL_WHY];
  bool           kink;

  PetscFunctionBeginUser;
  *ok    = true;
  m->t_n = s->state.t;
  PetscCall(ModelBeginStep(m, &status));
  if (status != CL_OK) {
    *ok = false;
    PetscCall(
        StepperGiveUp(s, status, NULL, ": %s near %s; no smaller step can help", why->why, PlaceWords(why->where).s));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(SizeWork(s));
  ModelStartVelocity(m, s->work.v_n);
  s->auto_.newton = 0;
  for (PetscInt cuts = 0;; cuts++) {
    const double dt = NextStep(s, &kink);
    Attempt      a  = {.status = CL_OK};

    PetscCall(PetscArraycpy(s->work.x, ModelStart(m), m->map.n_local * m->c->fields.n));
    s->work.drain = 1.0 / dt;
    PetscCall(StepperDirkStep(s, dt, &a));
    s->auto_.newton += a.newton;
    s->auto_.dt = dt;
    if (a.status == CL_OK)
      PetscCall(StepperCheckEquilibrium(s, dt, &a));
    if (a.status == CL_OK && s->adaptive)
      Judge(s, dt, dt_inaccurate, err_inaccurate, &a);
    if (a.status == CL_OK) {
      PetscCall(Accept(s, dt, kink, &a, cuts));
      PetscCall(CheckCrawl(s, dt, ok));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    const bool small = dt <= s->dt_min * (1.0 + 1e-9);
    if (a.status == CL_INACCURATE) {
      snprintf(text, sizeof(text), "the error estimate, of %s, stays above the tolerance", stepper_error_word[a.rules]);
      ModelExplain(m, text);
      s->state.dt    = fmax(Retry(s, dt, a.err, dt_inaccurate, err_inaccurate), s->dt_min);
      s->bound       = s->state.dt > s->dt_min ? a.rules : BOUND_LEAST;
      dt_inaccurate  = dt;
      err_inaccurate = a.err;
    } else {
      s->state.dt   = fmax(CUT_FAILED * dt, s->dt_min);
      s->state.hold = HOLD;
      s->bound      = BOUND_REFUSED;
      PetscCall(PetscPrintf(m->grid.comm, "t = %s: step of %s refused (%s: %s near %s); trying %s\n",
                            TimeAt(s->state.t).s, TimeWords(dt, 4).s, StepperStatusName(a.status), why->why,
                            PlaceWords(why->where).s, TimeWords(s->state.dt, 4).s));
    }
    const bool last = cuts >= s->max_failures || small;
    PetscCall(StepperAutoGivesWay(s, &a, dt, last, &s->auto_.give_way));
    if (s->auto_.give_way)
      PetscFunctionReturn(PETSC_SUCCESS);
    if (last) {
      *ok = false;
      PetscCall(StepperGiveUpStep(s, cuts + 1, a.status));
      PetscFunctionReturn(PETSC_SUCCESS);
    }
  }
}
