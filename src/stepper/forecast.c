/* What the run would cost by either kind of integrator; docs/equations.md, section 15. */
#include "clathra/stepper.h"
#include "clathra/words.h"

/* Measured on one core of a 2024 server, within a factor of 1.8 for 18 scenes of 80 to 16 000 particles (hybrid: 8);
   what counts is their ratio. */
#define HYBRID_BASE (CL_DIM == 3 ? 0.46e-6 : 0.10e-6)   /* s a particle and step: motion and stress */
#define HYBRID_SCALAR (CL_DIM == 3 ? 0.30e-6 : 0.05e-6) /* ... each of p_w, p_g, T */
#define HYBRID_COUPLED (CL_DIM == 3 ? 0.0 : 0.01e-6)
/* In space of bodies of 200 to 22 000 particles, within a factor of 2. */
#define PARTICLE (CL_DIM == 3 ? 8e-6 : 2.2e-6)   /* s a particle and Jacobian: the residuals that go with it */
#define TANGENT (CL_DIM == 3 ? 0.5e-6 : 0.7e-6)  /* s a particle and unknown of a node: Jacobian */
#define FACTOR (CL_DIM == 3 ? 4e-7 : 2e-7)       /* s: factorisation of N unknowns, n to a node, and solves ... */
#define FACTOR_POWER (CL_DIM == 3 ? 1.4 : 1.3)   /* ... with it take FACTOR n N^FACTOR_POWER */
#define MULTIGRID (CL_DIM == 3 ? 20e-6 : 2.5e-6) /* s an unknown and Jacobian: GMRES with multigrid */
#define SMOOTH_STEPS 1e2                         /* (317): an adaptive run whose loads are slow, at ... */
#define SMOOTH_TOL 1e-3                          /* ... this tolerance, ... */
#define REACTS 1.75         /* ... times as many where hydrate reacts: its fronts rule steps then */
#define NEWTON_REACTS 2.3   /* Jacobians a stage there */
#define NEWTON_DONOR 5.0    /* ... with donors of gas (332), each with a factorisation of its own */
#define BEHIND_KINK 12.0    /* steps that a kink adds */
#define PERIOD 30.0         /* steps in a period of a condition's waves, at SMOOTH_TOL */
#define MARKS 8.0           /* ... in which so many of them are stops */
#define MOST_STRETCHES 2000 /* ... looked at */
#define TRANSITS 100.0      /* waves matter in a run that is no longer than so many of their transits ... */
#define PER_TRANSIT 40.0    /* ... and want so many steps each */

static double Extent(const Scene *c)
{
  double extent = 0.0;

  for (PetscInt k = 0; k < c->nregion; k++) {
    for (int d = 0; d < CL_DIM; d++)
      extent = fmax(extent, c->region[k].upper[d] - c->region[k].lower[d]);
  }
  return extent;
}

double StepperHybridWork(const Model *m, double steps)
{
  const FieldSet *fs = &m->c->fields;
  const double    s  = fs->phase[PHASE_W] + fs->phase[PHASE_G] + fs->heat;

  return steps * (double)m->P.n * (HYBRID_BASE + HYBRID_SCALAR * s + HYBRID_COUPLED * s * s);
}

double StepperStops(const Stepper *s, double left, double *kinks)
{
  const double t_end = StepperCase(s)->t_end, from = t_end - left;
  Stepper      ahead = *s;
  double       steps = 0.0, found = 0.0, share;
  int          n = 0;

  ahead.state.t = from;
  for (; ahead.state.t < t_end && n < MOST_STRETCHES; n++) {
    bool         kink;
    const double stop = StepperNextStop(&ahead, &kink);

    steps += fmax(1.0, ceil((stop - ahead.state.t) / s->dt_max));
    found += kink && stop < t_end;
    ahead.state.t = stop;
  }
  share = n < MOST_STRETCHES ? 1.0 : left / (ahead.state.t - from);
  if (kinks)
    *kinks = found * share;
  return steps * share;
}

/* Periods of the waves of all conditions in what is left. */
static double Periods(const Stepper *s, double left)
{
  const double t_end = StepperCase(s)->t_end, from = t_end - left;
  double       t = BcNextMark(s->model->c, from);
  int          n = 0;

  for (; t < t_end && n < MOST_STRETCHES; n++)
    t = BcNextMark(s->model->c, t);
  return n / MARKS * (n < MOST_STRETCHES ? 1.0 : left / (t - from));
}

/* Does hydrate react while a step is chosen by its error?  Its fronts, which nobody knows yet, then rule steps. */
static bool FrontsRule(const Stepper *s)
{
  const Scene *c = s->model->c;

  return s->adaptive && SceneReacts(c) && c->fields.heat && c->fields.phase[PHASE_G];
}

/* Steps of an implicit run: as fixed, or few unless waves have to be resolved, events come often or loads have kinks.
 */
static double ImplicitSteps(const Stepper *s, double left)
{
  const Model *m = s->model;
  double       kinks;

  if (!s->adaptive)
    return left / CaseOf(m->c)->dt;
  const double speed = 2.0 / (sqrt(GridHighest2(&m->grid)) * s->forecast.limit.each[LIMIT_WAVE]);
  const double transits =
      m->c->fields.inertia && isfinite(s->forecast.limit.each[LIMIT_WAVE]) ? left * speed / Extent(m->c) : INFINITY;

  const double finer  = cbrt(SMOOTH_TOL / s->tol);
  const double first  = pow(s->tol, 1.0 / 3.0 - 1.0 / StepperTableau(s)->error_order); /* n goes with tol^(-1/q) */
  const double smooth = SMOOTH_STEPS * (FrontsRule(s) ? REACTS : 1.0) * finer * sqrt(first);
  const double stops  = fmax(StepperStops(s, left, &kinks), PERIOD * finer * first * Periods(s, left));
  const double steps  = fmax(smooth, stops + BEHIND_KINK * kinks); /* N of (317) */

  return transits < TRANSITS ? fmax(steps, PER_TRANSIT * transits) : steps;
}

/* As (99) with factors, (331) with multigrid; particles are seeded two along each axis of a cell. */
double StepperImplicitWork(const Model *m, double newton, double factors)
{
  const double n = m->c->fields.n, nodes = (double)m->P.n / CL_CORNERS, f = ModelFactored(m);
  const double solver = f == 0.0 ? newton * MULTIGRID * n * nodes : factors * FACTOR * f * pow(f * nodes, FACTOR_POWER);

  return newton * (double)m->P.n * (PARTICLE + TANGENT * n) + solver;
}

PetscErrorCode StepperHybridLimit(Stepper *s, StableStep *limit)
{
  const ExplicitOptions o = {.drag_implicit = true, .mass_scaling = StepperCase(s)->mass_scaling};
  Explicit             *e;

  PetscFunctionBeginUser;
  PetscCall(ExplicitCreate(s->model, &o, &e));
  PetscCall(ExplicitStableStep(e, limit));
  PetscCall(ExplicitDestroy(&e));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperForecast(Stepper *s)
{
  const Model *m    = s->model;
  const Case  *c    = CaseOf(m->c);
  const double left = c->t_end - fmax(s->state.t, c->scene.t_begin);
  Forecast    *f    = &s->forecast;

  PetscFunctionBeginUser;
  *f = (Forecast){.hybrid_steps = INFINITY, .hybrid_seconds = INFINITY};
  for (int k = 0; k < LIMIT_COUNT; k++)
    f->limit.each[k] = INFINITY;
  if (!CaseNeedsImplicit(c))
    PetscCall(StepperHybridLimit(s, &f->limit));
  if (f->limit.dt > 0.0) {
    f->hybrid_steps   = fmax(ceil(left / StepperHybridStep(c, &f->limit)), 1.0);
    f->hybrid_seconds = StepperHybridWork(m, f->hybrid_steps);
  }
  f->implicit_steps   = ImplicitSteps(s, left);
  const double stages = f->implicit_steps * StepperTableau(s)->stages;
  const bool   donor  = SceneDonor(m->c) && FrontsRule(s);
  const double newton = stages * (donor ? NEWTON_DONOR : FrontsRule(s) ? NEWTON_REACTS : STEPPER_NEWTON);

  f->implicit_seconds = StepperImplicitWork(m, newton, donor ? newton : f->implicit_steps);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &f->hybrid_seconds, 1, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, &f->implicit_seconds, 1, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  f->hybrid = f->hybrid_seconds < f->implicit_seconds;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperPrintForecast(const Stepper *s)
{
  const Forecast *f   = &s->forecast;
  const char     *why = CaseNeedsImplicit(StepperCase(s));
  char            hybrid[128], stage[80];

  PetscFunctionBeginUser;
  if (why) {
    snprintf(hybrid, sizeof(hybrid), "hybrid does not know %s", why);
  } else if (!(f->limit.dt > 0.0)) {
    snprintf(hybrid, sizeof(hybrid), "hybrid has no stable step");
  } else {
    snprintf(hybrid, sizeof(hybrid), "hybrid %s steps, %s", CountWords(f->hybrid_steps).s,
             TimeWords(f->hybrid_seconds, 2).s);
  }
  StepperStageWords(s, stage);
  PetscCall(PetscPrintf(s->model->grid.comm, "  %sforecast: %s; implicit about %s steps, %s%s; %s is the cheaper one\n",
                        stage, hybrid, CountWords(f->implicit_steps).s, TimeWords(f->implicit_seconds, 2).s,
                        s->adaptive ? " (most take half to twice that)" : "", f->hybrid ? "hybrid" : "implicit"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
