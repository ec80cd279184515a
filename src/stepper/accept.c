/* What all schemes do with a step: where it must end, what it adds up once it is accepted. */
#include "clathra/stepper.h"
#include "clathra/words.h"

/* What errors are relative to: the largest change since the start; of pore pressure or stress, temperature and
   position.  With them ranks agree on a signal. */
static PetscErrorCode UpdateScales(Stepper *s)
{
  const Model *m      = s->model;
  double       top[4] = {s->state.scale_p, s->state.scale_u, s->state.scale_T, s->interrupted ? s->interrupted() : 0};

  PetscFunctionBeginUser;
  for (int k = 0; k < 5; k++) { /* p_w, p_g, sigma'_xx, _yy, _zz against their initial values */
    const int     now = k < 2 ? P_PW + k : P_SIG + k - 2, start = k < 2 ? P_PW0 + k : P_SIG0 + k - 2;
    const double *a = m->P.f[now], *b = m->P.f[start];

    for (PetscInt p = 0; a && p < m->P.n; p++) {
      const bool gas = now == P_PG; /* the water before it */

      top[0] =
          fmax(top[0], ClSize(gas ? GasToBe(m->P.f[P_PW][p], a[p]) - GasToBe(m->P.f[P_PW0][p], b[p]) : a[p] - b[p]));
    }
  }
  for (int d = 0; m->P.f[P_U] && d < CL_DIM; d++) {
    for (PetscInt p = 0; p < m->P.n; p++)
      top[1] = fmax(top[1], ClSize(m->P.f[P_U + d][p]));
  }
  for (PetscInt p = 0; m->P.f[P_T] && p < m->P.n; p++)
    top[2] = fmax(top[2], ClSize(m->P.f[P_T][p] - ParticleInitialT(m->c, &m->P, p)));
  PetscCallMPI(MPI_Allreduce(MPI_IN_PLACE, top, 4, MPI_DOUBLE, MPI_MAX, m->grid.comm));
  s->broken = !isfinite(top[0] + top[1] + top[2]);
  if (s->broken) {
    PetscCall(
        StepperGiveUp(s, CL_NONFINITE, NULL, ": a pressure, stress, temperature or displacement is not a number"));
    PetscFunctionReturn(PETSC_SUCCESS);
  }
  s->state.scale_p = top[0];
  s->state.scale_u = top[1];
  s->state.scale_T = top[2];
  s->signal        = (int)top[3];
  s->stop          = s->stop || s->signal;
  PetscFunctionReturn(PETSC_SUCCESS);
}

double StepperNextStop(const Stepper *s, bool *kink)
{
  const double t = s->state.t, at_kink = BcNextKink(s->model->c, t);
  const double event = s->next_event ? s->next_event(s, s->monitor_ctx) : INFINITY;
  const double mark  = BcNextMark(s->model->c, t);
  const double stop  = fmin(fmin(StepperCase(s)->t_end, mark), fmin(at_kink, event));

  *kink = stop == at_kink;
  return stop;
}

void StepperCount(const Scene *c, const StageRates *rates, double weight, Attempt *a)
{
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    a->out[ph] += weight * rates->out[ph];
    a->left[ph] += weight * rates->left[ph];
    a->moved[ph] += weight * rates->moved[ph];
  }
  a->heat_gain += weight * rates->heat_rate;
  a->heat_in += weight * rates->heat_in;
  a->heat_source += weight * rates->heat_source;
  a->squeezed += weight * rates->squeezed;
  a->beyond += weight * rates->beyond;
  a->enthalpy_out += weight * rates->enthalpy_out;
  for (PetscInt k = 0; k < c->nmeter; k++) {
    for (int q = 0; q < METER_COUNT; q++)
      a->meter[k][q] += weight * rates->meter[k][q];
  }
  for (int k = 0; k < ACTS_COUNT; k++)
    a->acts[k] += weight * rates->acts[k];
  for (int k = 0; k < WORK_RATES; k++)
    a->work[k] += weight * rates->work[k];
}

/* Relative to the initial store; absolute where there was none. */
static double Missing(double missing, double store)
{
  return store > 0.0 ? missing / store : missing;
}

void StepperErrors(const StepperState *z, const ModelTotals *now, double error[3])
{
  error[0] = Missing(now->water + z->out[PHASE_W] + z->removed[REMOVED_WATER] - z->water0, z->water0);
  error[1] = Missing(now->methane + z->out[PHASE_G] + z->removed[REMOVED_METHANE] - z->methane0, z->methane0);
  error[2] = Missing(z->heat_gain - z->heat_in - z->heat_source, z->capacity0 * 1.0); /* of 1 K */
}

PetscErrorCode StepperAccept(Stepper *s, const Attempt *a, const StepInfo *info)
{
  StepperState *z = &s->state;

  PetscFunctionBeginUser;
  s->broken = false;
  PetscCall(StepperCountLeaving(s));
  if (s->broken)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(UpdateScales(s));
  if (s->broken)
    PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(StepperExtremes(s, false));
  z->loose_total += a->loose > 0.0;
  z->err_worst = fmax(z->err_worst, a->loose);
  if (s->adaptive && a->peak.err > z->peak) {
    z->peak    = a->peak.err;
    z->peak_of = a->peak.of;
    z->peak_t  = z->t;
    PetscCall(PetscArraycpy(z->peak_at, a->peak.at, CL_DIM));
  }
  z->newton_total += a->newton;
  z->failures_total += info->cuts;
  z->limited_total += a->limited;
  for (int ph = 0; ph < PHASE_COUNT; ph++) {
    z->out[ph] += a->out[ph];
    z->left[ph] += a->left[ph];
    z->moved[ph] += a->moved[ph];
  }
  z->heat_gain += a->heat_gain;
  z->heat_in += a->heat_in;
  z->heat_source += a->heat_source;
  z->squeezed += a->squeezed;
  z->beyond += a->beyond;
  z->enthalpy_out += a->enthalpy_out;
  for (PetscInt k = 0; k < s->model->c->nmeter; k++) {
    for (int q = 0; q < METER_COUNT; q++)
      z->meter[k][q] += a->meter[k][q];
  }
  for (int k = 0; k < ACTS_COUNT; k++)
    z->acts[k] += a->acts[k];
  PetscCall(StepperEnergyStep(s, a->work));
  ModelForgetLeaving(s->model);
  if (s->monitor)
    PetscCall(s->monitor(s, info, s->monitor_ctx));
  PetscFunctionReturn(PETSC_SUCCESS);
}
