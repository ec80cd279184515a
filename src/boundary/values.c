/* Prescribed values of all conditions, gravity and the fluid around the body as functions of time. */
#include "clathra/boundary.h"
#include "clathra/shape.h"

Ambient AmbientOf(const Scene *c, double t, const double gravity[CL_DIM])
{
  Ambient a = {.pressure = ScheduleValue(&c->ambient_pressure, t)};

  for (int d = 0; d < CL_DIM; d++)
    a.weight[d] = c->ambient_density * gravity[d];
  a.head = -VectorLength(a.weight) * ScheduleValue(&c->ambient_level, t);
  a.on   = a.pressure != 0.0 || c->ambient_density > 0.0;
  return a;
}

/* (425): what depth adds to a temperature at height 0. */
static double AtZero(const Scene *c, const Bc *b)
{
  return b->with_depth == 0.0 ? 0.0 : b->with_depth * SceneDatum(c, b->datum);
}

void BcValuesEvaluate(const Scene *c, double t, BcValues *v)
{
  for (PetscInt k = 0; k < c->nbc; k++) {
    const double at = t - c->bc[k].zero;

    v->value[k] = ScheduleValue(&c->bc[k].value, at) + AtZero(c, &c->bc[k]);
    v->shear[k] = ScheduleValue(c->bc[k].type == BC_WELL ? &c->bc[k].heated : &c->bc[k].shear, at);
    if (c->bc[k].type == BC_PLATE)
      v->value[k] = PlatePosition(&c->bc[k], t);
    for (int ph = 0; ph < PHASE_COUNT; ph++)
      v->phase[ph][k] = ScheduleValue(c->bc[k].type == BC_WELL ? &c->bc[k].rate[ph] : &c->bc[k].phase[ph], at);
  }
  for (int d = 0; d < CL_DIM; d++) {
    const double ramp = c->gravity_ramp, from = c->gravity_before[d], at = t - c->t_begin;

    v->gravity[d] = at < ramp ? from + (c->gravity[d] - from) * at / ramp : c->gravity[d];
  }
  v->ambient = AmbientOf(c, t, v->gravity);
}

double BcValueAt(const Scene *c, const Bc *b, double value, const double x[CL_DIM], double gradient[CL_DIM])
{
  const double per = b->with_depth == 0.0 ? 0.0 : b->with_depth / SceneGravity(c);

  for (int d = 0; d < CL_DIM; d++)
    gradient[d] = per * c->gravity[d];
  return per == 0.0 ? value : value - b->with_depth * SceneHeight(c, x);
}

void BcTemperatureSpan(const Scene *c, const Bc *b, double *low, double *high)
{
  const double top  = AtZero(c, b) - b->with_depth * SceneTop(c);
  const double foot = AtZero(c, b) - b->with_depth * SceneFoot(c);

  ScheduleSpan(&b->value, low, high);
  *low += fmin(top, foot);
  *high += fmax(top, foot);
}

/* First kink of the condition after t, which round-off may have left short of one. */
static double NextKink(const Bc *b, double t)
{
  const double at   = t - b->zero + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);
  double       next = fmin(ScheduleNextKink(&b->value, at), ScheduleNextKink(&b->shear, at));

  next = fmin(next, ScheduleNextKink(&b->heated, at));
  next = fmin(next, fmin(ScheduleNextKink(&b->displacement, at), ScheduleNextKink(&b->force, at)));
  for (int ph = 0; ph < PHASE_COUNT; ph++)
    next = fmin(next, fmin(ScheduleNextKink(&b->phase[ph], at), ScheduleNextKink(&b->rate[ph], at)));
  return b->zero + next;
}

double BcNextMark(const Scene *c, double t)
{
  double next = fmin(ScheduleNextMark(&c->ambient_pressure, t), ScheduleNextMark(&c->ambient_level, t));

  for (PetscInt k = 0; k < c->nbc; k++) {
    const Bc       *b     = &c->bc[k];
    const double    at    = t - b->zero + 4.0 * PETSC_MACHINE_EPSILON * fabs(t);
    const Schedule *own[] = {&b->value,    &b->shear,   &b->displacement, &b->force, &b->phase[0],
                             &b->phase[1], &b->rate[0], &b->rate[1],      &b->heated};

    for (size_t i = 0; i < sizeof(own) / sizeof(*own); i++)
      next = fmin(next, b->zero + ScheduleNextMark(own[i], at));
  }
  return next;
}

double BcNextKink(const Scene *c, double t)
{
  const double ramped = c->t_begin + c->gravity_ramp;
  double       next   = t < ramped - SceneTimeSlack(c, ramped) ? ramped : INFINITY;

  next = fmin(next, fmin(ScheduleNextKink(&c->ambient_pressure, t), ScheduleNextKink(&c->ambient_level, t)));
  for (PetscInt k = 0; k < c->nbc; k++)
    next = fmin(next, NextKink(&c->bc[k], t));
  return next;
}
