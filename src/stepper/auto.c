/* auto: which integrator takes the run on, decided at any time from what the next second would cost by either;
   docs/equations.md, section 15.  Work is counted, not clocked: a run repeats and restarts bit for bit. */
#include "clathra/stepper.h"
#include "clathra/words.h"

#define MARGIN 2.0         /* of cost, to be worth a change */
#define LOOKS_IMPLICIT 3   /* in a row that ask for hybrid ... */
#define LOOKS_HYBRID 4     /* ... or for the implicit one, times the patience */
#define PATIENCE_MOST 1024 /* looks: some 1e6 steps of hybrid */
#define START 0.1          /* first implicit step, of the one that would do */
#define STILL_GROWING 1.5  /* a wanted step that grows by so much is not yet what the scene allows */

/* What stops leave of a step that would be dt long: the larger of the interval to the next one and the one behind it.
 */
static double Allowed(const Stepper *s, double dt)
{
  bool         kink;
  const double stop  = StepperNextStop(s, &kink);
  Stepper      there = *s;

  there.state.t = stop;
  return fmin(dt, fmax(stop - s->state.t, StepperNextStop(&there, &kink) - stop));
}

/* s of the forecast's machine that the next second takes by hybrid (99), of the slowest rank, with this stable step;
   INFINITY if there is none. */
static PetscErrorCode CostHybrid(const Stepper *s, const StableStep *limit, double *cost)
{
  const Model *m = s->model;

  PetscFunctionBeginUser;
  *cost = INFINITY;
  if (limit->dt > 0.0)
    *cost = StepperHybridWork(m, 1.0) / StepperHybridStep(CaseOf(m->c), limit);
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, cost, 1, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ... by implicit steps of length dt with so many Newton iterations each (99). */
static PetscErrorCode CostImplicit(const Stepper *s, double newton, double dt, double *cost)
{
  PetscFunctionBeginUser;
  *cost = StepperImplicitWork(s->model, newton, 1.0) / dt;
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, cost, 1, MPI_DOUBLE, MPI_MAX, s->model->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- the implicit step that hybrid's motion would allow
 */
#define RATES 7 /* p_w, p_g, T, S_h, displacement, plastic strain, stress */

/* Sums over the particles that are compared. */
typedef struct {
  double change[RATES];         /* squares of changes */
  double jump, mass, volume, n; /* mass times the square of the skeleton's change of velocity; mass of all phases */
} Motion;

static void AddSquare(const double *now, const double *then, PetscInt p, PetscInt q, double *sum)
{
  if (now)
    *sum += PetscSqr(now[p] - then[q]);
}

static void AddMotion(const Particles *P, const Particles *then, PetscInt p, PetscInt q, Motion *sum)
{
  double *const *now = (double *const *)P->f, *const *was = (double *const *)then->f;

  AddSquare(now[P_PW], was[P_PW], p, q, &sum->change[0]);
  if (now[P_PG])
    sum->change[1] += PetscSqr(GasToBe(now[P_PW][p], now[P_PG][p]) - GasToBe(was[P_PW][q], was[P_PG][q]));
  AddSquare(now[P_T], was[P_T], p, q, &sum->change[2]);
  AddSquare(now[P_SH], was[P_SH], p, q, &sum->change[3]);
  for (int d = 0; d < CL_DIM; d++)
    AddSquare(now[P_U + d], was[P_U + d], p, q, &sum->change[4]);
  AddSquare(now[P_EPS], was[P_EPS], p, q, &sum->change[5]);
  for (int k = 0; k < CL_TENSOR; k++)
    AddSquare(now[P_SIG + k], was[P_SIG + k], p, q, &sum->change[6]);
  double mass = 0.0, jump = 0.0;
  for (int k = 0; k < 4; k++)
    mass += now[P_MS + k] ? now[P_MS + k][p] : 0.0;
  for (int d = 0; d < CL_DIM; d++)
    AddSquare(now[P_VS + d], was[P_VS + d], p, q, &jump);
  sum->jump += mass * jump;
  sum->mass += mass;
  sum->volume += now[P_V][p];
  sum->n++;
}

/* Places of the particles in the order of their numbers. */
static PetscErrorCode ByNumber(const Particles *P, PetscInt **id, PetscInt **place)
{
  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(P->n, id, P->n, place));
  PetscCall(PetscArraycpy(*id, P->i[PI_ID], P->n));
  for (PetscInt p = 0; p < P->n; p++)
    (*place)[p] = p;
  PetscCall(PetscSortIntWithArray(P->n, *id, *place));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Since the last burst began; particles that changed ranks in it are left out. */
static PetscErrorCode MotionOf(Stepper *s, Motion *sum)
{
  const Particles *P = &s->model->P, *then = &s->good;
  PetscInt        *id, *place, *id_then, *place_then, left;

  PetscFunctionBeginUser;
  *sum = (Motion){.n = 0.0};
  PetscCall(ParticlesMigrate(&s->model->grid, &s->good, &left)); /* borders may have moved */
  PetscCall(ByNumber(P, &id, &place));
  PetscCall(ByNumber(then, &id_then, &place_then));
  for (PetscInt p = 0, q = 0; p < P->n; p++) {
    while (q < then->n && id_then[q] < id[p])
      q++;
    if (q < then->n && id_then[q] == id[p])
      AddMotion(P, then, place[p], place_then[q], sum);
  }
  PetscCall(PetscFree2(id, place));
  PetscCall(PetscFree2(id_then, place_then));
  PetscCallMPI(
      MPI_Allreduce(MPI_IN_PLACE, sum, sizeof(*sum) / sizeof(double), MPI_DOUBLE, MPI_SUM, s->model->grid.comm));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Do waves carry stresses that count (100)? */
static bool Waves(const Stepper *s, const Motion *sum)
{
  const double limit = s->limit.each[LIMIT_WAVE];

  if (!isfinite(limit))
    return false;
  const double speed = 2.0 / (sqrt(GridHighest2(&s->model->grid)) * limit);

  return sum->mass / sum->volume * speed * sqrt(sum->jump / sum->mass) > s->tol * s->state.scale_p;
}

/* (100); 0 where waves count. */
static PetscErrorCode StepThatWouldDo(Stepper *s, double *dt)
{
  const StepperState *z            = &s->state;
  const double        scale[RATES] = {z->scale_p, z->scale_p,        z->scale_T, STEPPER_SCALE_SH,
                                      z->scale_u, STEPPER_SCALE_EPS, z->scale_p};
  Motion              sum;

  PetscFunctionBeginUser;
  PetscCall(MotionOf(s, &sum));
  *dt = 0.0;
  if (Waves(s, &sum))
    PetscFunctionReturn(PETSC_SUCCESS);
  *dt = Allowed(s, s->dt_max);
  for (int k = 0; k < RATES; k++) {
    const double rate = sqrt(sum.change[k] / sum.n) / (z->t - s->auto_.good_t);

    if (rate > 0.0)
      *dt = fmin(*dt, pow(s->tol, 1.0 / StepperTableau(s)->error_order) * scale[k] / rate);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* ---------------------------------------------------------------- changes */
/* A change starts as a stage does: particles stay as they are, rates of the last step are none of the next. */
static PetscErrorCode GoOver(Stepper *s, int kind, double dt, bool *ok)
{
  StepperState *z = &s->state;

  PetscFunctionBeginUser;
  if (s->scheme->destroy)
    PetscCall(s->scheme->destroy(s));
  s->scheme = StepperSchemeOf(kind == AUTO_HYBRID ? INTEGRATOR_HYBRID : INTEGRATOR_AUTO);
  z->kind   = kind;
  z->votes  = 0;
  z->since  = z->t;
  z->spent  = 0.0;
  StepperForget(z, fmin(fmax(dt, s->dt_min), s->dt_max));
  if (s->scheme->create)
    PetscCall(s->scheme->create(s));
  if (s->scheme->ready)
    PetscCall(s->scheme->ready(s, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* A visit that cost more than hybrid would have makes the next one wait longer. */
static void LearnFromVisit(StepperState *z, double hybrid)
{
  const bool paid = z->t > z->since && z->spent / (z->t - z->since) <= hybrid;

  z->patience = paid ? 1 : PetscMin(2 * z->patience, PATIENCE_MOST);
}

static PetscErrorCode FromImplicit(Stepper *s, bool *ok)
{
  StepperState *z = &s->state;
  StableStep    limit;
  const double  dt = s->auto_.give_way ? s->auto_.dt : Allowed(s, z->dt);
  double        implicit, hybrid, step;

  PetscFunctionBeginUser;
  PetscCall(CostImplicit(s, (double)s->auto_.newton, 1.0, &step)); /* the same on all ranks, as all that decides */
  z->spent += step;
  PetscCall(StepperHybridLimit(s, &limit));
  PetscCall(CostHybrid(s, &limit, &hybrid));
  PetscCall(CostImplicit(s, (double)s->auto_.newton, dt, &implicit));
  const bool growing = z->dt > STILL_GROWING * s->auto_.dt;

  z->votes = !growing && implicit > MARGIN * hybrid ? z->votes + 1 : 0;
  if (!s->auto_.give_way && z->votes < LOOKS_IMPLICIT)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(s->model->grid.comm,
                        "t = %s: %s -> hybrid: a second takes %.2g s by implicit steps of %s (%s), %.2g s by "
                        "hybrid's\n",
                        TimeAt(z->t).s, StepperName(s), implicit, TimeWords(dt, 2).s,
                        s->auto_.give_way ? "which fail" : "that do not grow", hybrid));
  s->auto_.give_way = false;
  LearnFromVisit(z, hybrid);
  PetscCall(GoOver(s, AUTO_HYBRID, z->dt, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FromHybrid(Stepper *s, bool *ok)
{
  StepperState *z  = &s->state;
  double        dt = 0.0, hybrid, implicit = INFINITY;

  PetscFunctionBeginUser;
  PetscCall(StepThatWouldDo(s, &dt));
  PetscCall(CostHybrid(s, &s->limit, &hybrid));
  if (dt > 0.0)
    PetscCall(CostImplicit(s, 2.0 * STEPPER_NEWTON, dt, &implicit));
  z->votes = implicit * MARGIN < hybrid ? z->votes + 1 : 0;
  if (z->votes < LOOKS_HYBRID * z->patience)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscPrintf(s->model->grid.comm,
                        "t = %s: hybrid -> %s: a second takes %.2g s by hybrid's steps, %.2g s by implicit ones of %s "
                        "that would do\n",
                        TimeAt(z->t).s, case_integrator[StepperSchemeOf(INTEGRATOR_AUTO)->kind], hybrid, implicit,
                        TimeWords(dt, 2).s));
  PetscCall(GoOver(s, AUTO_IMPLICIT, START * dt, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperAutoBegin(Stepper *s)
{
  StepperState *z      = &s->state;
  const Case   *c      = StepperCase(s);
  const bool    chosen = IntegratorKinds(c->integrator) & BY_TURNS;

  PetscFunctionBeginUser;
  s->auto_.on = chosen && s->adaptive && !CaseNeedsImplicit(c);
  if (!chosen)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (z->kind == AUTO_UNDECIDED) {
    z->kind     = s->forecast.hybrid ? AUTO_HYBRID : AUTO_IMPLICIT;
    z->votes    = 0;
    z->patience = 1;
    z->since    = s->state.t;
    z->spent    = 0.0;
  }
  if (z->kind == AUTO_HYBRID)
    s->scheme = StepperSchemeOf(INTEGRATOR_HYBRID);
  PetscCall(
      PetscPrintf(s->model->grid.comm, "  integrator chosen: %s%s", StepperName(s), s->auto_.on ? ", for now" : ""));
  const char *word = SceneUnknown(&c->scene, BY_EXPLICIT);
  if (s->auto_.on && word)
    PetscCall(PetscPrintf(s->model->grid.comm, "; hybrid goes without %s", word));
  PetscCall(PetscPrintf(s->model->grid.comm, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperAutoGivesWay(Stepper *s, const Attempt *a, double dt, bool last, bool *yes)
{
  const bool   slide  = a->status == CL_TOO_FAR; /* steps will not grow again before it rests */
  const double newton = slide ? (double)a->newton : 2.0 * STEPPER_NEWTON;
  StableStep   limit;
  double       implicit, hybrid;

  PetscFunctionBeginUser;
  *yes = false;
  if (!s->auto_.on || (a->status == CL_INACCURATE && !last))
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StepperHybridLimit(s, &limit));
  PetscCall(CostHybrid(s, &limit, &hybrid));
  PetscCall(CostImplicit(s, newton, slide ? s->state.dt : dt, &implicit));
  *yes = isfinite(hybrid) && (last || implicit > (slide ? 1.0 : MARGIN) * hybrid);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode StepperAutoDecide(Stepper *s, bool *ok)
{
  PetscFunctionBeginUser;
  if (!s->auto_.on || s->stop || s->broken)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (s->state.kind == AUTO_HYBRID)
    PetscCall(FromHybrid(s, ok));
  else
    PetscCall(FromImplicit(s, ok));
  PetscFunctionReturn(PETSC_SUCCESS);
}
