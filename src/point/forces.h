/* Private to point/: forces on the mixture and on its fluids; docs/equations.md (14)-(16). */
#pragma once

#include "clathra/tensor.h"
#include "tangent.h"
#include <string.h>

typedef struct {
  double s[6], ds[6][IN_COUNT];
  double work, dwork[IN_COUNT]; /* dissipated in the stage, J/m^3 */
} Stress;

/* Tangent of a number of the skeleton with its derivatives d, in the inputs of the particle. */
INLINE void SkeletonRow(const double d[SKELETON_IN], const Kinematics *k, const ScalarState *s, const Jet *thermal,
                        const Jet *kept, double row[IN_COUNT])
{
  for (int i = 0; i < IN_COUNT; i++)
    row[i] = 0.0;
  for (int i = 0; i < MOTION_COUNT; i++) {
    for (int c = 0; i < MOTION_HOOP && c < CL_SPINS; c++)
      row[IN_GRADU + i] += d[SKELETON_THETA + c] * k->dtheta[c][i];
    for (int c = 0; c < CL_TENSOR; c++)
      row[IN_GRADU + i] += d[SKELETON_STRAIN + c] * k->de[c][i];
  }
  AddJet(row, d[SKELETON_E], &s->E, k);
  AddJet(row, d[SKELETON_SH], &s->Sh, k);
  AddJet(row, d[SKELETON_THERMAL], thermal, k);
  AddJet(row, d[SKELETON_KEPT], kept, k);
}

/* Effective stress and its tangent; e_zz is the hoop strain, zero in plane strain. */
INLINE ClStatus EffectiveStress(const PointInput *x, const Kinematics *k, const ScalarState *s, bool tangent,
                                PointState *to, Stress *out, const char **why)
{
  const Material     *mat     = x->mat;
  const PointHistory *h       = x->h;
  SkeletonState      *state   = &to->skeleton;
  const Jet           thermal = JetScale(1.0 / 3.0, JetMul(s->beta, JetVariable(x->in[IN_T] - h->T_n, JET_T)));
  double              dE;
  SkeletonStep        d = {.turn = k->turn, .thermal = thermal.v, .E = s->E.v, .Sh = s->Sh.v};
  const Kept      k_h   = ElasticityHasBonds(&mat->elasticity) ? KeptHydrate(h->m_star[0], s->m_h.v) : (Kept){1.0, 0.0};
  const Jet       kept  = JetChain(k_h.v, k_h.m, s->m_h);
  SkeletonTangent t;

  memcpy(d.e, k->e, sizeof(d.e));
  d.E_n  = ElasticityYoung(&mat->elasticity, h->Sh_n, &dE);
  d.kept = kept.v;
  if (!SkeletonUpdate(mat, &h->skeleton, &d, state, tangent ? &t : NULL, why))
    return CL_DOMAIN;
  for (int c = 0; c < 6; c++) {
    out->s[c] = state->sig[c];
    if (tangent)
      SkeletonRow(t.d[c], k, s, &thermal, &kept, out->ds[c]);
  }
  SkeletonEndStage(&h->skeleton, &d, state, s->V.v, &to->end);
  out->work = state->work;
  if (tangent)
    SkeletonRow(t.d[SKELETON_WORK], k, s, &thermal, &kept, out->dwork);
  return CL_OK;
}

/* Ambient pressure at the particle, with the force V grad p_a that its weight is (42). */
typedef struct {
  double p, g[CL_DIM];
} AmbientState;

INLINE AmbientState AmbientAt(const PointHistory *h, const Kinematics *k, const ScalarState *s,
                              const double in[IN_COUNT], bool tangent, PointOutput *o)
{
  AmbientState a = {0.0, {0.0}};
  double       x[CL_DIM];

  if (!h->ambient)
    return a;
  for (int d = 0; d < CL_DIM; d++)
    x[d] = h->x[d] + in[IN_U + d];
  a.p = AmbientPressure(h->ambient, x, a.g);
  for (int i = 0; i < CL_DIM; i++) {
    o->out[OUT_A + i] = s->V.v * a.g[i];
    if (tangent)
      AddJet(o->D[OUT_A + i], a.g[i], &s->V, k);
  }
  return a;
}

/* out = V_n (sigma' - (p - p_a) 1) cof F, in the plane and around the axis (30) (momentum of the mixture). */
INLINE void MixtureForces(const PointHistory *h, const Kinematics *k, const ScalarState *s, const Stress *st,
                          const AmbientState *a, bool tangent, PointOutput *o)
{
  const double p = s->p.v - a->p, hoop = st->s[ZZ] - p;
  double       total[CL_DIM][CL_DIM];

  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++)
      total[i][j] = st->s[voigt[i][j]] - (i == j ? p : 0.0);
  }
  o->out[OUT_HOOP] = h->V * hoop * k->cof_hoop;
  for (int i = 0; i < CL_DIM; i++) {
    for (int j = 0; j < CL_DIM; j++) {
      const int row = VectorAt(OUT_P, i, j);

      o->out[row] = h->V * AlongCofactor(k, j, total[i]);
      for (int m = 0; tangent && m < CL_DIM; m++) {
        const double *ds = st->ds[voigt[i][m]], c = h->V * k->cof[m][j];

        for (int q = 0; q < IN_J; q++)
          o->D[row][q] += c * ds[q];
        if (m == i)
          AddJet(o->D[row], -c, &s->p, k);
        for (int d = 0; m == i && d < CL_DIM; d++)
          o->D[row][IN_U + d] += c * a->g[d];
        for (int q = 0; q < MOTION_COUNT; q++)
          o->D[row][q] += h->V * total[i][m] * k->dcof[m][j][q];
      }
    }
  }
  if (!tangent)
    return;
  for (int q = 0; q < IN_J; q++)
    o->D[OUT_HOOP][q] += h->V * k->cof_hoop * st->ds[ZZ][q];
  AddJet(o->D[OUT_HOOP], -h->V * k->cof_hoop, &s->p, k);
  for (int d = 0; d < CL_DIM; d++)
    o->D[OUT_HOOP][IN_U + d] += h->V * k->cof_hoop * a->g[d];
  for (int q = 0; q < MOTION_HOOP; q++)
    o->D[OUT_HOOP][q] += h->V * hoop * k->dJ[q] / k->lambda;
}

/* out = V_n A cof F g_pi (momentum of a fluid); its columns likewise. */
INLINE void FluidForces(const PointHistory *h, const Kinematics *k, int f, const double in[IN_COUNT], bool tangent,
                        PointOutput *o)
{
  const double *g  = &in[VectorAt(IN_GP, f, 0)];
  const int     at = VectorAt(OUT_G, f, 0);

  for (int i = 0; i < CL_DIM; i++) {
    const int row = at + i;

    o->out[row] = h->V * VectorDot(k->cof[i], g);
    if (!tangent)
      continue;
    for (int j = 0; j < CL_DIM; j++)
      o->D[row][VectorAt(IN_GP, f, j)] += h->V * k->cof[i][j];
    for (int q = 0; q < MOTION_COUNT; q++)
      o->D[row][q] += h->V * CofactorSlope(k, i, q, g);
  }
  Drive(h, &o->out[at]);
  for (int q = 0; tangent && h->beds && q < IN_J; q++) {
    double slope[CL_DIM];

    for (int d = 0; d < CL_DIM; d++)
      slope[d] = o->D[at + d][q];
    BedsDrive(h->beds, slope);
    for (int d = 0; d < CL_DIM; d++)
      o->D[at + d][q] = slope[d];
  }
}
