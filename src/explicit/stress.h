/* Pores, stress and history of the skeleton at the end of a step, and what they take of the energy; docs/equations.md,
   section 12. */
#pragma once

#include "clathra/laws_batch.h"
#include "motion.h"

/* Volume and saturation of hydrate at the end of the step; false if fluids or hydrate have no open pores left. */
INLINE bool PoresAfter(Explicit *e, const Set s, Run r, const Strain *n, const double *restrict T, double *restrict phi)
{
  double *const *f     = e->m->P.f;
  const bool     known = s.fluids || s.heat; /* the volume, from the pass before */
  double *restrict V = f[P_V] + r.p, *restrict Sh = f[P_SH] + r.p;
  const double *restrict at = known ? e->t[T_V] + r.p : V, *restrict ms = f[P_MS] + r.p, *restrict mh = f[P_MH] + r.p;
  double rho_s[BLOCK], rho_h[BLOCK], zero[BLOCK]                                                      = {0.0};
  Wrong  full = 0;

  LiquidDensityBatch(&r.mat->solid, r.n, zero, T, rho_s);
  LiquidDensityBatch(&r.mat->hydrate, r.n, zero, T, rho_h);
  INDEPENDENT
  for (int q = 0; q < r.n; q++) {
    const double volume = known ? at[q] : V[q] * n->J[q];
    const Pores  v      = PoresOf(volume, ms[q], rho_s[q], mh[q], rho_h[q]);

    full |= WRONG_UNLESS((v.open > 0.0) | (!s.fluids & (mh[q] == 0.0)));
    phi[q] = v.phi;
    Sh[q]  = mh[q] == 0.0 ? 0.0 : v.Sh;
    V[q]   = volume;
  }
  return !full;
}

/* Mean thermal strain of skeleton and hydrate. */
INLINE void ThermalStrain(const Explicit *e, const Set s, Run r, const Gathered *g, const double *restrict phi,
                          double *restrict thermal)
{
  const double *restrict Sh = e->m->P.f[P_SH] + r.p;

  for (int q = 0; q < r.n; q++)
    thermal[q] = s.heat ? SolidExpansivity(r.mat, phi[q], Sh[q]).v * g->value[q][s.fluids] / 3.0 : 0.0;
}

/* (92): work of the pressures, trapezoidal, and of the ambient one as the particles of a block expand and move. */
INLINE void ExpansionWork(Explicit *e, const Set s, Run r, const Gathered *g, const Strain *n, double dt)
{
  const Ambient *ambient   = &e->m->bc.ambient;
  double *const *f         = e->m->P.f;
  const double *restrict V = f[P_V] + r.p;
  double inside = 0.0, outside = 0.0;

  for (int q = 0; s.fluids && q < r.n; q++) {
    const PetscInt p   = r.p + q;
    const double   dpw = g->value[q][0], pw = f[P_PW][p] - 0.5 * dpw;
    double         mean = pw;

    if (s.fluids == 2) {
      const double dpg = g->value[q][1], pg = f[P_PG][p] - 0.5 * dpg;

      mean = PorePressureOf(e->t[T_SG][p] + 0.5 * e->t[T_DS][p] * (dpg - dpw), pw, pg).v;
    }
    inside += mean * V[q] * (n->J[q] - 1.0);
  }
  for (int q = 0; ambient->on && q < r.n; q++) {
    double x[CL_DIM], gradient[CL_DIM];

    ParticlePlace(&e->m->P, r.p + q, x);
    const double p = AmbientPressure(ambient, x, gradient);

    outside += V[q] * (p * (n->J[q] - 1.0) + dt * VectorDot(gradient, &g->value[q][C_Vs(s)]));
  }
  e->work[WORK_PRESSURE] += inside;
  e->work[WORK_LOADS] -= outside;
}

/* Elastic energy that goes with the stiffness, J. */
static inline double Released(const Elasticity *el, const SkeletonBlock *b, const double *restrict V)
{
  const double *E = b->E, *E_n = b->E_n;
  double        sum     = 0.0;
  Wrong         changes = 0;

  for (int q = 0; q < b->n; q++)
    changes |= WRONG_UNLESS(E[q] == E_n[q]);
  for (int q = 0; changes && q < b->n; q++) {
    SkeletonHistory h;

    SkeletonTake(&b->store, q, &h);
    sum += V[q] * SkeletonReleased(el, b->E_n[q], b->E[q], b->kept ? b->kept[q] : 1.0, &h);
  }
  return sum;
}

/* What plastic flow dissipated, J, and the share of it that the next step gives to the nodes as heat. */
static inline void PlasticWork(Explicit *e, Run r, const double *work)
{
  double *const *f = e->m->P.f;

  for (int q = 0; q < r.n; q++) {
    const PetscInt p = r.p + q;

    f[P_WP][p] += f[P_V][p] * work[q];
    f[P_HEAT][p] = r.mat->plasticity.heat * f[P_V][p] * work[q];
  }
}

/* New effective stress and history of the skeleton; kept: share of hydrate that is still there (93). */
INLINE void StressOf(Explicit *e, const Set s, Run r, const Gathered *g, const Strain *n, const double *restrict T,
                     const double *kept)
{
  const Elasticity *el     = &r.mat->elasticity;
  const double     *Sh     = e->m->P.f[P_SH] + r.p;
  const bool        yields = r.mat->plasticity.type != PLASTICITY_NONE;
  double            E_old[BLOCK], E[BLOCK], phi[BLOCK] = {0.0}, thermal[BLOCK], work[BLOCK];
  const char       *why = NULL;

  ElasticityYoungBatch(el, r.n, Sh, E_old);
  if (!PoresAfter(e, s, r, n, T, phi))
    ModelNoteFailure(e->m, CL_DOMAIN, "no open pores are left", Worst(r, Sh)); /* S_h >= 1 */
  ElasticityYoungBatch(el, r.n, Sh, E);
  ThermalStrain(e, s, r, g, phi, thermal);
  SkeletonBlock block = {.n       = r.n,
                         .thermal = thermal,
                         .E_n     = E_old,
                         .E       = E,
                         .Sh      = Sh,
                         .kept    = kept,
                         .work    = yields ? work : NULL,
                         .store   = ParticlesSkeleton(&e->m->P, r.p, e->ahead)};
  for (int k = 0; k < CL_TURN; k++)
    block.turn[k] = n->turn[k];
  for (int k = 0; k < CL_TENSOR; k++)
    block.e[k] = n->e[k];
  e->m->released += Released(el, &block, e->m->P.f[P_V] + r.p);
  if (!SkeletonUpdateBlock(r.mat, &block, &why))
    ModelNoteFailure(e->m, CL_DOMAIN, why, Worst(r, work));
  if (yields)
    PlasticWork(e, r, work);
}
