/* laws_strength: the strength of laws.h, its yield function and its smooth potential, as functions for a loop over
   particles: no branches, no calls and no loops that remain, so that they become vector code there.  Arguments are what
   laws.h says; angles come with their sines and cosines.  Units: stresses in Pa, angles in rad, strains and saturations
   dimensionless. */
#pragma once

#include <math.h>
#include "clathra/inline.h"
#include "clathra/laws.h"

#define STRENGTH_DEG (3.14159265358979323846 / 180.0)

/* What (61) gives at a hydrate saturation: cohesion (Pa) and dilation (deg), and slopes in S_h, those of psi in rad. */
typedef struct {
  double c, psi, c_S, psi_S;
} PeakStrength;

/* (61); hydrate: exp[eta_h (S_h - S_h,max)], d_hydrate its slope in the exponent. */
INLINE void PeakStrengthOf(const Plasticity *law, double hydrate, double d_hydrate, PeakStrength *p)
{
  p->c     = law->c_min + (law->c_max - law->c_min) * hydrate;
  p->psi   = law->psi_min + (law->psi_max - law->psi_min) * hydrate;
  p->c_S   = law->eta_h * d_hydrate * (law->c_max - law->c_min);
  p->psi_S = STRENGTH_DEG * law->eta_h * d_hydrate * (law->psi_max - law->psi_min);
}

/* (62); left: exp(-eta eps), d_left its slope in the exponent. */
INLINE void SoftenedStrengthOf(const Plasticity *law, const PeakStrength *p, double eta, double left, double d_left,
                               Strength *s)
{
  s->c     = law->c_res + (p->c - law->c_res) * left;
  s->phi   = STRENGTH_DEG * (law->phi_res + (law->phi_peak - law->phi_res) * left);
  s->psi   = STRENGTH_DEG * p->psi * left;
  s->c_e   = -eta * d_left * (p->c - law->c_res);
  s->phi_e = -STRENGTH_DEG * eta * d_left * (law->phi_peak - law->phi_res);
  s->psi_e = -STRENGTH_DEG * eta * d_left * p->psi;
  s->c_S   = p->c_S * left;
  s->psi_S = p->psi_S * left;
}

/* Yield function of Mohr and Coulomb (63). */
INLINE double YieldOf(double si, double co, double c, const double y[3], double dy[3], double *dphi)
{
  const double half = 0.5 * (y[0] - y[2]), mean = 0.5 * (y[0] + y[2]);

  dy[0] = 0.5 * (1.0 + si) / co;
  dy[1] = 0.0;
  dy[2] = -0.5 * (1.0 - si) / co;
  *dphi = (half * si + mean) / (co * co);
  return (half + mean * si) / co - c;
}

/* Elliptic section R_mw (64) without its factor R_mc(pi/3, phi): f(t, e), t = cos(theta), and slopes. */
typedef struct {
  double f, t, tt, e, te;
} FlowSection;

/* At t = cos(theta), theta the Lode angle, and eccentricity e in [1/2, 1]. */
INLINE void FlowSectionOf(double t, double e, FlowSection *s)
{
  const double a = 1.0 - e * e, b = 2.0 * e - 1.0, under = 4.0 * a * t * t + 5.0 * e * e - 4.0 * e,
               w = sqrt(under > 1e-16 ? under : 1e-16);
  const double N = 4.0 * a * t * t + b * b, N_t = 8.0 * a * t, N_tt = 8.0 * a, N_e = -8.0 * e * t * t + 4.0 * b,
               N_te = -16.0 * e * t;
  const double w_t = 4.0 * a * t / w, w_tt = (4.0 * a - w_t * w_t) / w,
               w_e = (-8.0 * e * t * t + 10.0 * e - 4.0) / (2.0 * w), w_te = (-8.0 * e * t - w_e * w_t) / w;
  const double D = 2.0 * a * t + b * w, D_t = 2.0 * a + b * w_t, D_tt = b * w_tt,
               D_e = -4.0 * e * t + 2.0 * w + b * w_e, D_te = -4.0 * e + 2.0 * w_t + b * w_te;

  s->f  = N / D;
  s->t  = (N_t - s->f * D_t) / D;
  s->e  = (N_e - s->f * D_e) / D;
  s->tt = (N_tt - 2.0 * s->t * D_t - s->f * D_tt) / D;
  s->te = (N_te - s->t * D_e - s->e * D_t - s->f * D_te) / D;
}

/* P (64) with m = apex tan(psi); si, co of phi, tp = tan(psi).  Stresses in any order: the potential is isotropic.
   Where q = 0 the deviatoric slope is that of a triaxial state, and its product with rho zero. */
INLINE void FlowGradientOf(double si, double co, double tp, double apex, const double y[3], FlowGradient *P)
{
  const double first  = (y[0] >= y[1] ? 1.0 : 0.0) * (y[0] >= y[2] ? 1.0 : 0.0),
               second = (1.0 - first) * (y[1] >= y[2] ? 1.0 : 0.0), is_top[3] = {first, second, 1.0 - first - second};
  const double sm = (y[0] + y[1] + y[2]) / 3.0, s[3] = {y[0] - sm, y[1] - sm, y[2] - sm};
  const double q   = sqrt(1.5 * (s[0] * s[0] + s[1] * s[1] + s[2] * s[2]));
  const double top = is_top[0] * s[0] + is_top[1] * s[1] + is_top[2] * s[2], t = q > 0.0 ? 1.5 * top / q : 1.0;
  const double e = (3.0 - si) / (3.0 + si), e_phi = -6.0 * co / ((3.0 + si) * (3.0 + si));
  const double R = (3.0 - si) / (6.0 * co), R_phi = (3.0 * si - 1.0) / (6.0 * co * co);
  FlowSection  k;

  FlowSectionOf(t, e, &k);
  const double sec2 = 1.0 + tp * tp, m = apex * tp;
  const double rho = R * k.f * q, S = sqrt(m * m + rho * rho), rho_phi = q * (R_phi * k.f + R * k.e * e_phi);
  double       u[3], r[3], r_phi[3], qy[3];

  const double share = S > 0.0 ? rho / S : 0.0, bend = S > 0.0 ? m * m / (S * S * S) : 0.0;
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    const double e1 = is_top[i] - 1.0 / 3.0;

    qy[i]    = q > 0.0 ? 1.5 * s[i] / q : 0.0;
    u[i]     = 1.5 * e1 - t * qy[i]; /* q dt/dy */
    r[i]     = R * ((k.f - t * k.t) * qy[i] + 1.5 * k.t * e1);
    r_phi[i] = R_phi / R * r[i] + R * e_phi * ((k.e - t * k.te) * qy[i] + 1.5 * k.te * e1);
  }
#pragma GCC unroll 3
  for (int i = 0; i < 3; i++) {
    P->dev[i] = share * r[i];
    P->y[i]   = P->dev[i] + tp / 3.0;
    P->phi[i] = bend * rho_phi * r[i] + share * r_phi[i];
    P->psi[i] = (S > 0.0 ? -rho * m * apex * sec2 / (S * S * S) * r[i] : 0.0) + sec2 / 3.0;
#pragma GCC unroll 3
    for (int j = 0; j < 3; j++) {
      const double unit = (i == j ? 1.0 : 0.0) - 1.0 / 3.0;
      const double rr   = R * R * k.f * ((k.f - t * k.t) * (1.5 * unit - qy[i] * qy[j]) + k.tt * u[i] * u[j]);

      P->yy[i][j] = S > 0.0 ? bend * r[i] * r[j] + rr / S : 0.0;
    }
  }
}
