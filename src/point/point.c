/* What a particle gives its nodes, with the consistent tangent; docs/equations.md (14)-(21): its terms in forces.h,
   fluxes.h and heat.h. */
#include "fluxes.h"
#include "heat.h"
#include <string.h>

INLINE void FillState(const FieldSet *fs, const ScalarState *s, PointState *state)
{
  state->V        = s->V.v;
  state->phi      = s->phi.v;
  state->Sh       = s->Sh.v;
  state->Sw       = (1.0 - s->Sh.v) * s->sw.v;
  state->Sg       = (1.0 - s->Sh.v) * s->sg.v;
  state->m_h      = s->m_h.v;
  state->m_w      = s->m[PHASE_W].v;
  state->m_g      = s->m[PHASE_G].v;
  state->p        = s->p.v;
  state->limited  = s->limited;
  state->squeezed = 0.0;
  state->gain     = 0.0;
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++)
    state->rho[f] = fs->phase[f] ? s->rho[f].v : 0.0;
}

INLINE ClStatus CheckFinite(const FieldSet *fs, const PointOutput *o, const char **why)
{
  double sum = 0.0; /* of the rows that every set's outputs lead into */

  for (int r = OUT_FLUX; fs->fluid && r < OUT_HEAT; r++)
    sum += fs->phase[(r - OUT_FLUX) / CL_DIM] ? o->out[r] : 0.0;
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++)
    sum += fs->phase[f]
               ? o->out[VectorAt(OUT_G, f, 0)] + o->out[VectorAt(OUT_G, f, 1)] + o->out[OUT_D + f] + o->out[OUT_DM + f]
               : 0.0;
  for (int r = OUT_P; fs->solid && r < OUT_P + CL_DIM * CL_DIM; r++)
    sum += o->out[r];
  if (fs->heat)
    sum += o->out[OUT_HEAT] + o->out[OUT_HEAT + 1] + o->out[OUT_C] + o->out[OUT_Q];
  if (isfinite(sum))
    return CL_OK;
  *why = "a flux or force is not finite";
  return CL_NONFINITE;
}

/* The motion of a particle that does not move. */
static const Kinematics at_rest = {
    .F        = CL_IDENTITY,
    .lambda   = 1.0,
    .J        = 1.0,
    .cof      = CL_IDENTITY,
    .cof_hoop = 1.0,
    .turn     = ROTATION_NONE,
};

INLINE ClStatus Evaluate(const PointInput *x, bool tangent, PointState *state, PointOutput *o, const char **why)
{
  const FieldSet     *fs  = x->fs;
  const Material     *mat = x->mat;
  const PointHistory *h   = x->h;
  const double       *in  = x->in;
  Kinematics          moved;
  const Kinematics   *k = &at_rest;
  ScalarState         s;
  Metric              metric;
  Stress              st;

  st.work = 0.0;
  if (fs->solid) {
    if (!(tangent ? KinematicsEvaluate(&in[IN_GRADU], &moved) : KinematicsValues(&in[IN_GRADU], &moved))) {
      *why = "volume ratio of the step is not positive";
      return CL_DOMAIN;
    }
    k = &moved;
  }
  const ClStatus status = ScalarStateEvaluate(x, k->J, &s, why);
  if (status != CL_OK)
    return status;
  if (tangent) {
    for (int r = 0; r < OUT_COUNT; r++) {
      for (int q = 0; q < IN_COUNT; q++)
        o->D[r][q] = 0.0;
    }
    memcpy(o->dJ, k->dJ, sizeof(o->dJ));
    memset(o->wide, 0, sizeof(o->wide));
    memset(o->wide_q, 0, sizeof(o->wide_q));
  }
  FillState(fs, &s, state);
  PutScalar(OUT_M, JetShift(s.m_h, h->m_s), k, tangent, o);
  if (fs->solid) {
    const ClStatus strained = EffectiveStress(x, k, &s, tangent, state, &st, why);
    if (strained != CL_OK)
      return strained;
    const AmbientState a = AmbientAt(h, k, &s, in, tangent, o);
    MixtureForces(h, k, &s, &st, &a, tangent, o);
  }
  for (int d = 0; d < CL_DIM; d++)
    state->stretch[d] = fs->solid ? k->stretch[d] : 1.0;
  memcpy(state->F, k->F, sizeof(state->F));
  if (fs->fluid || fs->heat)
    MetricEvaluate(k, tangent, &metric);
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++) {
    if (!fs->phase[f])
      continue;
    FluidForces(h, k, f, in, tangent, o);
    state->tau[f] = Flux(x, k, &metric, &s, f, tangent, o);
    Spread(x, k, &metric, &s, f, tangent, o);
    FluidScalars(mat, h, k, &s, f, tangent, o);
  }
  if (fs->phase[PHASE_W] && fs->phase[PHASE_G] && mat->gas.carried > 0.0)
    CarriedFlux(mat, k, &s, in, tangent, o);
  if (fs->heat) {
    Conduction(h, k, &metric, &s, in, tangent, o);
    Heat(x, k, &s, tangent, o);
    if (mat->reacts)
      state->gain = s.gain.v;
#pragma GCC unroll 2
    for (int f = 0; f < PHASE_COUNT; f++) {
      if (h->compression && fs->phase[f])
        CompressionHeat(x, k, &s, f, tangent, state, o);
    }
    if (fs->solid)
      PlasticHeat(mat, h, k, &s, &st, tangent, o);
  }
  return CheckFinite(fs, o, why);
}

/* The residual pays for no slope: each form is compiled by itself. */
ClStatus PointEvaluate(const PointInput *x, bool tangent, PointState *state, PointOutput *o, const char **why)
{
  return tangent ? Evaluate(x, true, state, o, why) : Evaluate(x, false, state, o, why);
}
