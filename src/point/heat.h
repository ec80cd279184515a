/* Private to point/: heat conducted, stored, released, advected and gained by compression; docs/equations.md (21). */
#pragma once

#include "forces.h"

/* Conduction: V kappa F^-1 F^-T g_T, and what carries heat with the flow, (293) on the configuration at t_n. */
INLINE void Conduction(const PointHistory *h, const Kinematics *k, const Metric *metric, const ScalarState *s,
                       const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  for (int i = 0; i < CL_DIM; i++) {
    const double Kg = VectorDot(metric->K[i], &in[IN_GT]);
    double       up[CL_DIM];

    for (int j = 0; j < CL_DIM; j++)
      up[j] = h->upwind[cl_symmetric[i][j]];
    o->out[OUT_HEAT + i] = h->V * (s->kappa.v * Kg + VectorDot(up, &in[IN_GT]));
    if (!tangent)
      continue;
    double *D = o->D[OUT_HEAT + i];
    AddJet(D, h->V * Kg, &s->kappa, k);
    for (int q = 0; q < MOTION_COUNT; q++)
      D[q] += h->V * s->kappa.v * MetricSlope(metric, i, q, &in[IN_GT]);
    for (int j = 0; j < CL_DIM; j++)
      D[IN_GT + j] += h->V * (s->kappa.v * metric->K[i][j] + up[j]);
  }
}

/* Heat stored, released and advected, c Phi . g_T; needs the fluxes. */
INLINE void Heat(const PointInput *x, const Kinematics *k, const ScalarState *s, bool tangent, PointOutput *o)
{
  const Material *mat = x->mat;
  const double   *in  = x->in;

  PutScalar(OUT_C, s->capacity, k, tangent, o);
  PutScalar(OUT_Q, mat->reacts ? JetScale(-1.0 / x->h->dt, JetMul(s->latent, s->gain)) : JetConstant(0.0), k, tangent,
            o);
#pragma GCC unroll 2
  for (int f = 0; f < PHASE_COUNT; f++) {
    const double c_f = SpecificHeat(mat, f);

    if (!x->fs->phase[f])
      continue;
    o->out[OUT_Q] += AdvectedHeat(c_f, &o->out[VectorAt(OUT_FLUX, f, 0)], &in[IN_GT]);
    for (int i = 0; tangent && i < CL_DIM; i++) {
      const int r = VectorAt(OUT_FLUX, f, i);

      for (int q = 0; q < IN_COUNT; q++)
        o->D[OUT_Q][q] += c_f * in[IN_GT + i] * o->D[r][q];
      o->D[OUT_Q][IN_GT + i] += c_f * o->out[r];
    }
    for (int of = 0; tangent && of < PHASE_COUNT; of++) {
      for (int j = 0; j < CL_DIM; j++) {
        double flux[CL_DIM];

        for (int i = 0; i < CL_DIM; i++)
          flux[i] = o->wide[f][of][i][j];
        o->wide_q[of][j] += AdvectedHeat(c_f, flux, &in[IN_GT]);
      }
    }
  }
}

/* (290) of one fluid: what its compression and throttling take of OUT_Q; needs its flux. */
INLINE void CompressionHeat(const PointInput *x, const Kinematics *k, const ScalarState *s, int f, bool tangent,
                            PointState *state, PointOutput *o)
{
  const PointHistory *h  = x->h;
  const double       *in = x->in;
  const Jet           p = JetVariable(in[IN_P + f], JET_PW + f), rho = s->rho[f];
  const Jet           volume = JetDiv(s->m[f], rho);
  const Jet           rise   = JetScale(-1.0 / h->dt, JetMul(JetMul(volume, s->warm[f]), JetShift(p, -h->p_star[f])));
  const Throttling    t      = ThrottlingOf(s->warm[f].v, rho.v);
  const Jet           share  = JetChain2(t.v, t.warm, s->warm[f], t.rho, rho);
  const double       *g = &in[VectorAt(IN_GP, f, 0)], *flux = &o->out[VectorAt(OUT_FLUX, f, 0)], *b = h->gravity;
  double              fall[CL_DIM], *D = o->D[OUT_Q];

  for (int i = 0; i < CL_DIM; i++) {
    fall[i] = k->F[0][i] * b[0];
    for (int j = 1; j < CL_DIM; j++)
      fall[i] += k->F[j][i] * b[j];
  }
  const double sum = rise.v + ThrottledHeat(share.v, flux, g, fall);
  for (int i = 0; tangent && i < CL_DIM; i++) {
    const double head = share.v * g[i] - fall[i];

    for (int q = 0; q < IN_COUNT; q++)
      D[q] += head * o->D[VectorAt(OUT_FLUX, f, i)][q];
    for (int j = 0; j < CL_DIM; j++) {
      for (int of = 0; of < PHASE_COUNT; of++)
        o->wide_q[of][j] += head * o->wide[f][of][i][j];
      D[VectorAt(IN_GRADU, j, i)] -= flux[i] * b[j];
    }
    D[VectorAt(IN_GP, f, i)] += flux[i] * share.v;
  }
  o->out[OUT_Q] += sum;
  state->squeezed -= sum;
  if (!tangent)
    return;
  AddJet(D, 1.0, &rise, k);
  AddJet(D, VectorDot(flux, g), &share, k);
}

/* Heat of plastic flow (69). */
INLINE void PlasticHeat(const Material *mat, const PointHistory *h, const Kinematics *k, const ScalarState *s,
                        const Stress *st, bool tangent, PointOutput *o)
{
  const double share = -mat->plasticity.heat / h->dt;

  if (mat->plasticity.type == PLASTICITY_NONE || share == 0.0)
    return;
  o->out[OUT_Q] += share * s->V.v * st->work;
  if (!tangent)
    return;
  AddJet(o->D[OUT_Q], share * st->work, &s->V, k);
  for (int q = 0; q < IN_COUNT; q++)
    o->D[OUT_Q][q] += share * s->V.v * st->dwork[q];
}
