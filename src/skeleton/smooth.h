/* Private to skeleton/: the equations of the return along the smooth potential, for one particle and, within a loop,
   for several (no branches, calls or loops that remain). */
#pragma once

#include "clathra/laws_strength.h"
#include "plastic.h"

#define SMOOTH_UNKNOWNS 5
#define SMOOTH_CLOSE 1e-9 /* scaled residual from which one more full step ends at round-off */
enum { X_L = 3, X_EPS };

/* (65) at x = (y, multiplier in Pa, growth of the plastic strain), all in Pa: rows as unknowns, then matrices. */
typedef struct {
  double r[SMOOTH_UNKNOWNS], A[SMOOTH_UNKNOWNS][SMOOTH_UNKNOWNS], by[SMOOTH_UNKNOWNS][BY_COUNT];
} SmoothSystem;

/* Of the friction angle phi and the dilation psi: sin(phi), cos(phi), tan(psi); roundness of the potential's end. */
typedef struct {
  double si, co, tp, roundness;
} SmoothAngles;

/* k: strength at the strain of x, a: its angles; slopes: fill s->by too. */
INLINE void SmoothEquations(const Trial3 *t, const Strength *k, const SmoothAngles *a, const double x[SMOOTH_UNKNOWNS],
                            bool slopes, SmoothSystem *s)
{
  FlowGradient P;
  double       dF[3], dn[3], F_phi, n_y[3] = {0.0, 0.0, 0.0}, n_eps = 0.0, n_S = 0.0;

  FlowGradientOf(a->si, a->co, a->tp, a->roundness, x, &P);
  const double n = DeviatoricNorm(P.dev, dn), L = x[X_L];

#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    const double P_eps = P.phi[i] * k->phi_e + P.psi[i] * k->psi_e, P_S = P.psi[i] * k->psi_S;

    n_eps += dn[i] * P_eps;
    n_S += dn[i] * P_S;
#pragma GCC unroll 3
    for (int j = 0; j < 3; j++)
      n_y[j] += dn[i] * P.yy[i][j];
  }
  const double tr = P.y[0] + P.y[1] + P.y[2], tr_psi = P.psi[0] + P.psi[1] + P.psi[2];
  const double tr_eps = tr_psi * k->psi_e, tr_S = tr_psi * k->psi_S;
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    const double P_eps = P.phi[i] * k->phi_e + P.psi[i] * k->psi_e, DP = t->G2 * P.y[i] + t->lame * tr;

    s->r[i] = x[i] - t->y[i] + L * DP;
#pragma GCC unroll 3
    for (int j = 0; j < 3; j++)
      s->A[i][j] = (i == j ? 1.0 : 0.0) + L * t->G2 * P.yy[i][j];
    s->A[i][X_L]   = DP;
    s->A[i][X_EPS] = L * (t->G2 * P_eps + t->lame * tr_eps);
  }
  s->r[X_L]   = YieldOf(a->si, a->co, k->c, x, dF, &F_phi);
  s->r[X_EPS] = t->E * x[X_EPS] - L * n;
#pragma GCC unroll 3
  for (int j = 0; j < 3; j++) {
    s->A[X_L][j]   = dF[j];
    s->A[X_EPS][j] = -L * n_y[j];
  }
  s->A[X_L][X_L]     = 0.0;
  s->A[X_L][X_EPS]   = F_phi * k->phi_e - k->c_e;
  s->A[X_EPS][X_L]   = -n;
  s->A[X_EPS][X_EPS] = t->E - L * n_eps;
  if (!slopes)
    return;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++)
      s->by[i][j] = i == j ? -1.0 : 0.0;
    s->by[i][BY_E]  = 0.0;
    s->by[i][BY_SH] = L * (t->G2 * P.psi[i] * k->psi_S + t->lame * tr_S);
    s->by[X_L][i] = s->by[X_EPS][i] = 0.0;
  }
  s->by[X_L][BY_E]    = 0.0;
  s->by[X_L][BY_SH]   = -k->c_S;
  s->by[X_EPS][BY_E]  = x[X_EPS];
  s->by[X_EPS][BY_SH] = -L * n_S;
}

INLINE double SmoothSize(const SmoothSystem *s)
{
  double sum = 0.0;

#pragma GCC unroll 5
  for (int i = 0; i < SMOOTH_UNKNOWNS; i++)
    sum += s->r[i] * s->r[i];
  return sqrt(sum);
}

/* Returns of SMOOTH_LANES trial states of one law at once, those that are easy: mean stress compressive, so the apex is
   out of sight, and Newton's full steps shrink the residual.  Arrays over lanes; in: trial stresses (falling, Pa),
   E, S_h, strain at the start, that of the neighbours. */
#define SMOOTH_LANES 8
typedef struct {
  double        y[3][SMOOTH_LANES], E[SMOOTH_LANES], Sh[SMOOTH_LANES], eps[SMOOTH_LANES], nonlocal[SMOOTH_LANES];
  unsigned char elastic[SMOOTH_LANES]; /* out: does not yield */
  unsigned char found[SMOOTH_LANES];   /* out: y and eps are those of the returned state */
} SmoothLanes;
void ReturnSmoothLanes(const Plasticity *law, double G2, double lame, SmoothLanes *l);
