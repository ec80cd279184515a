/* What a run says of the range of its pressures and temperatures, beside what it started from and what acted on it: at
   its end, and of temperatures far beyond when it happens; and of steps that were accepted above the tolerance. */
#include "findings_private.h"
#include "clathra/words.h"

#define BEYOND 0.02   /* of the range, and ... */
#define LEAST_T 0.1   /* ... K or ... */
#define AT_ONCE 2.0   /* ... K from which it is not left to the end */
#define LEAST_P 1e4   /* ... Pa, that is worth a word */
#define ABOVE 0.1     /* of the highest pressure, likewise: what is heated in closed ground has more */
#define HEAVY 2700.0  /* kg/m^3: no ground is heavier */
#define DOUBTFUL 10.0 /* times the tolerance, from which errors that were put up with are warned of */

typedef struct {
  double low, high;
} Span;

static void Widen(Span *span, Span by)
{
  span->low  = fmin(span->low, by.low);
  span->high = fmax(span->high, by.high);
}

static void Add(Span *span, const Schedule *s)
{
  Span own;

  ScheduleSpan(s, &own.low, &own.high);
  Widen(span, own);
}

/* Temperatures that nothing but the reaction leads out of, degC: heat is conducted and carried between those of the
   start and of the conditions.  Sources open it upwards, sinks downwards. */
static Span Temperatures(const Stepper *s)
{
  const Case *c    = StepperCase(s);
  Span        span = {s->state.begin[LOWEST_T], s->state.begin[HIGHEST_T]};

  for (PetscInt k = 0; k < PetscMax(c->nstage, 1); k++) {
    const Scene *scene = &CaseInStage(c, k)->scene;

    for (PetscInt i = 0; i < scene->nbc; i++) {
      const Bc *b    = &scene->bc[i];
      Span      flux = {0.0, 0.0};

      if (b->type == BC_HEAT_FLUX || b->type == BC_HEAT_SOURCE)
        Add(&flux, &b->value);
      else if (b->type == BC_WELL)
        Add(&span, &b->heated);
      else if (BcPrescribesT(b)) {
        Span own;

        BcTemperatureSpan(scene, b, &own.low, &own.high);
        Widen(&span, own);
      }
      span.low  = flux.low < 0.0 ? -INFINITY : span.low;
      span.high = flux.high > 0.0 ? INFINITY : span.high;
    }
    if (scene->compression_heat)
      span = (Span){-INFINITY, INFINITY};
    if (scene->fields.has & HAS_PLASTIC)
      span.high = INFINITY;
  }
  return span;
}

static void PlaceOf(const Extreme *e, char text[128])
{
  snprintf(text, 128, "near %s at t = %s", PlaceWords(e->at).s, TimeWords(e->t, 4).s);
}

PetscErrorCode FindingsFindRanges(Findings *f, FindingId id)
{
  static const struct {
    const char *name, *unit;
    double      per;
    int         low;
    unsigned    has;
  } of[] = {{"p", "MPa", 1e6, LOWEST_P, HAS_WATER}, {"T", "degC", 1.0, LOWEST_T, HAS_HEAT}};

  PetscFunctionBeginUser;
  for (int k = 0; k < 2; k++) {
    const Extreme *low = &f->s->state.extreme[of[k].low];
    char           from[128], to[128];

    if (!(f->s->model->c->fields.has & of[k].has))
      continue;
    PlaceOf(&low[0], from);
    PlaceOf(&low[1], to);
    SAY("  %s of particles from %.5g %s, %s, to %.5g, %s", of[k].name, low[0].value / of[k].per, of[k].unit, from,
        low[1].value / of[k].per, to);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* How far the lowest or highest temperature so far is beyond all that leads there. */
typedef struct {
  double by, slack; /* K; what is not worth a word */
  double acted;     /* degC: how far start and conditions lead, without hydrate */
} Beyond;

static Beyond BeyondOf(const Stepper *s, Span acted, int k)
{
  const Extreme *e     = s->state.extreme;
  const Scene   *c     = s->model->c;
  const Span     bound = {StepperEquilibrium(c, acted.low, e[LOWEST_P].value, false),
                          StepperEquilibrium(c, acted.high, e[HIGHEST_P].value, true)};
  const double   range = fmax(bound.high, e[HIGHEST_T].value) - fmin(bound.low, e[LOWEST_T].value);

  return (Beyond){.by    = k == HIGHEST_T ? e[k].value - bound.high : bound.low - e[k].value,
                  .slack = fmax(LEAST_T, isfinite(range) ? BEYOND * range : 0.0),
                  .acted = k == HIGHEST_T ? acted.high : acted.low};
}

static PetscErrorCode SayTemperature(const Findings *f, FindingId id, int k, Beyond beyond)
{
  const StepperState *z    = &f->s->state;
  const Scene        *c    = f->s->model->c;
  const Extreme      *e    = &z->extreme[k];
  const bool          warm = k == HIGHEST_T, now = id == FINDING_TEMPERATURE_NOW;
  char                place[128], hydrate[96]    = "none reacts";

  PetscFunctionBeginUser;
  PlaceOf(e, place);
  if (SceneReacts(c) && c->fields.phase[PHASE_G])
    snprintf(hydrate, sizeof(hydrate), "%.4g degC, in equilibrium with %.4g MPa",
             StepperEquilibrium(c, warm ? -INFINITY : INFINITY, z->extreme[warm ? HIGHEST_P : LOWEST_P].value, warm),
             1e-6 * z->extreme[warm ? HIGHEST_P : LOWEST_P].value);
  SAY("a particle %s %.4g degC, %s: %.2g K %s than start, conditions and hydrate can make it (start and conditions: "
      "%.4g degC; hydrate: %s), so it is the grid's doing%s",
      now ? "has" : "had", e->value, place, beyond.by, warm ? "warmer" : "colder", beyond.acted, hydrate,
      now ? " and may grow (said once on the way)" : "");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* While it happens, once, if it is some kelvin; and at the end. */
PetscErrorCode FindingsFindTemperature(Findings *f, FindingId id)
{
  const bool now = id == FINDING_TEMPERATURE_NOW;

  PetscFunctionBeginUser;
  if (!f->s->model->c->fields.heat)
    PetscFunctionReturn(PETSC_SUCCESS);
  if (!f->acted.known) {
    const Span acted = Temperatures(f->s);

    f->acted = (Acted){.low = acted.low, .high = acted.high, .known = true};
  }
  for (int k = LOWEST_T; k <= HIGHEST_T && !(now && FindingTimes(id)); k++) {
    const Beyond beyond = BeyondOf(f->s, (Span){f->acted.low, f->acted.high}, k);

    if (beyond.by > fmax(now ? AT_ONCE : 0.0, beyond.slack))
      PetscCall(SayTemperature(f, id, k, beyond));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What a condition may make of pore pressures, Pa; opens the span where that is not known. */
static void AddPressures(Span *span, const Bc *b)
{
  if (b->type == BC_PLATE || b->type == BC_PLATE_LINE || b->type == BC_INFLOW)
    *span = (Span){-INFINITY, INFINITY};
  if (b->type == BC_WELL && (b->rate[PHASE_W].n || b->rate[PHASE_G].n))
    *span = (Span){-INFINITY, INFINITY};
  if (b->type == BC_PRESSURE || b->type == BC_WELL)
    Add(span, &b->value);
  for (int ph = 0; b->type == BC_PRESSURE && ph < PHASE_COUNT; ph++)
    Add(span, &b->phase[ph]);
}

/* How far the tractions (Pa) change at most, and the highest; undrained ground takes them on. */
static void Tractions(const Scene *c, double *most, double *change)
{
  for (PetscInt i = 0; i < c->nbc; i++) {
    Span load = {INFINITY, -INFINITY};

    if (c->bc[i].type != BC_TRACTION)
      continue;
    Add(&load, &c->bc[i].value);
    *most   = fmax(*most, load.high);
    *change = fmax(*change, load.high - load.low);
  }
}

/* Pore pressures that start, conditions, loads, weight and hydrate in equilibrium can make, Pa; open where something
   acts of which that is not known. */
static Span Pressures(const Stepper *s)
{
  const StepperState *z    = &s->state;
  const Case         *c    = StepperCase(s);
  Span                span = {z->begin[LOWEST_P], z->begin[HIGHEST_P]};

  for (PetscInt k = 0; k < PetscMax(c->nstage, 1); k++) {
    const Scene *scene = &CaseInStage(c, k)->scene;
    const double heavy = SceneGravity(scene) * scene->ambient_density;
    Span         level = {INFINITY, -INFINITY};
    double       most = 0.0, change = 0.0, tall = 0.0;

    for (int d = 0; d < CL_DIM; d++)
      tall = fmax(tall, scene->upper[d] - scene->lower[d]);

    for (PetscInt i = 0; i < scene->nbc; i++)
      AddPressures(&span, &scene->bc[i]);
    if (scene->ambient_pressure.n > 1 || ScheduleValue(&scene->ambient_pressure, 0.0) != 0.0)
      Add(&span, &scene->ambient_pressure);
    Add(&level, &scene->ambient_level);
    if (heavy > 0.0 && level.high > level.low)
      change = heavy * (level.high - level.low);
    Tractions(scene, &most, &change);
    span.low  = span.low - change;
    span.high = fmax(span.high, most) + (scene->fields.inertia ? change : 0.0);
    if (SceneGravity(scene) > 0.0) /* of all that may lie above */
      span.high += (HEAVY + scene->ambient_density) * SceneGravity(scene) * tall;
    if (scene->fields.has & HAS_PLASTIC) /* sheared ground makes its own */
      span = (Span){-INFINITY, INFINITY};
  }
  return span;
}

/* A pressure beyond all may be physics (what melts or cools takes less room, what is heated or loaded more), so this is
   no more than a note. */
PetscErrorCode FindingsFindPressure(Findings *f, FindingId id)
{
  const StepperState *z     = &f->s->state;
  const Span          bound = Pressures(f->s);
  const double        range = z->extreme[HIGHEST_P].value - z->extreme[LOWEST_P].value;

  PetscFunctionBeginUser;
  for (int k = LOWEST_P; f->s->model->c->fields.phase[PHASE_W] && k <= HIGHEST_P; k++) {
    const bool     high  = k == HIGHEST_P;
    const Extreme *e     = &z->extreme[k];
    const double   limit = high ? bound.high : bound.low, beyond = high ? e->value - limit : limit - e->value;
    char           place[128];

    if (!(beyond > fmax(LEAST_P, high ? ABOVE * fabs(limit) : BEYOND * range)))
      continue;
    PlaceOf(e, place);
    SAY("the pressure of a particle was %.4g MPa, %s: %.3g MPa %s that of the start and of all conditions and loads "
        "(%.4g MPa).  %s may do that; at a border of layers that has left the grid's lines it is one row of particles, "
        "and pictures have the nodes' mean; beside it neighbours that alternate are the grid's doing (docs/limits.md)",
        1e-6 * e->value, place, 1e-6 * beyond, high ? "above" : "below", 1e-6 * limit,
        high ? "Melting hydrate that is closed in, heating or squeezing" : "Melting hydrate, cooling or unloading");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

#define VACUUM 101325.0 /* Pa below nothing: water in pores boils before, or lets its gas out */

/* A mean pore pressure that no water bears. */
PetscErrorCode FindingsFindTension(Findings *f, FindingId id)
{
  const Extreme *e = &f->s->state.extreme[LOWEST_P];
  char           place[128];

  PetscFunctionBeginUser;
  if (!f->s->model->c->fields.phase[PHASE_W] || !(e->value < -VACUUM))
    PetscFunctionReturn(PETSC_SUCCESS);
  PlaceOf(e, place);
  SAY("the pressure of a particle was %s, a tension, %s: water in pores boils or lets its gas out before, which is not "
      "modelled, and stresses there are not those of ground",
      PressureWords(e->value, 4).s, place);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* The largest estimated error of any particle, and errors that were put up with. */
PetscErrorCode FindingsFindErrors(Findings *f, FindingId id)
{
  const StepperState *z = &f->s->state;

  PetscFunctionBeginUser;
  if (z->peak > 0.0)
    SAY("  largest error of a step at any particle: %.3g of the tolerance, of %s near %s at t = %s", z->peak,
        stepper_error_word[(int)z->peak_of], PlaceWords(z->peak_at).s, TimeWords(z->peak_t, 4).s);
  if (z->loose_total)
    SAY("  %" PetscInt_FMT " step%s accepted above the tolerance, with an estimated error of up to %.3g of it (at "
        "stepper_dt_min, or noise of the particles)",
        z->loose_total, z->loose_total == 1 ? " was" : "s were", z->err_worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Errors far above the tolerance that were put up with. */
PetscErrorCode FindingsFindDoubtfulSteps(Findings *f, FindingId id)
{
  const StepperState *z = &f->s->state;

  PetscFunctionBeginUser;
  if (z->loose_total && z->err_worst > DOUBTFUL)
    SAY("%" PetscInt_FMT " of %" PetscInt_FMT
        " steps %s accepted above the tolerance, with an estimated error of up to %.3g of it: no shorter step lowered "
        "it (particles that change cells, a jump), or stepper_dt_min did not let it; finer cells or a ramp there, and "
        "a look at balance.csv's dt_s",
        z->loose_total, z->step, z->loose_total == 1 ? "was" : "were", z->err_worst);
  PetscFunctionReturn(PETSC_SUCCESS);
}
