/* The reaction of a particle: every relation once, with its slopes, for one particle (residual, Jacobian) and for loops
   over blocks of them (hybrid). */
#pragma once

#include "clathra/inline.h"
#include "clathra/laws.h"
#include "clathra/point_heat.h"
#include "clathra/point_state.h"

/* kg: (12) halves hydrate for ever; what is less than this is none, long before 1/m overflows. */
#define HYDRATE_GONE 1e-100

/* Share with its slope in the mass. */
typedef struct {
  double v, m;
} Kept;

/* k of (93): what is still there of the hydrate `from` (kg) when m is left. */
INLINE Kept KeptHydrate(double from, double m)
{
  return from > HYDRATE_GONE && m < from ? (Kept){m / from, 1.0 / from} : (Kept){m > 0.0 ? 1.0 : 0.0, 0.0};
}

/* Hydrate that a step adds to its surface, kg/m^2, with slopes in p (1/Pa) and T (1/K). */
typedef struct {
  double v, p, T;
} Growth;

/* A front of heat in a particle's cell (382): square of the cell's width across it (m^2), and how much of one it is. */
typedef struct {
  double h2, share;
} HeatFront;

#define HEAT_CROSSED 3e-3 /* of the square of a cell's width: how far heat gets before conduction counts */

/* (382) in cells h wide (m): gradients g_T (K/m), g_p (Pa/m), slope of p_e (Pa/K), T above equilibrium (K), square of
   the way that heat has been conducted since the stage began (m^2). */
INLINE HeatFront HeatFrontOf(const double h[CL_DIM], const double g_T[CL_DIM], const double g_p[CL_DIM], double dpe_dT,
                             double above, double conducted)
{
  double slope = 0.0, across = 0.0, alone = 0.0;

  for (int d = 0; d < CL_DIM; d++) {
    const double with_p = g_p[d] / dpe_dT, T2 = g_T[d] * g_T[d], h2 = h[d] * h[d];

    slope += T2;
    across += T2 * h2;
    alone += fmax(T2 - 2.0 * with_p * with_p, 0.0) * h2;
  }
  if (!(alone > 0.0))
    return (HeatFront){0.0, 0.0};
  const double h2 = across / slope, far = conducted / (HEAT_CROSSED * h2), crossed = far * far * far * far,
               beyond = fmax(fabs(above) - sqrt(across), 0.0);

  return (HeatFront){h2, crossed / (1.0 + crossed) * alone / (across + beyond * beyond + HEAT_LEAST_T * HEAT_LEAST_T)};
}

/* (381): what a cell's conduction holds of a reaction whose heat is q (W/(m^3 Pa)), over what it lets through; kappa
   (W/(m K)), power: heat made in the particle itself (W/m^3); the rest as above. */
INLINE double ReactionHeld(double q, double dpe_dT, double kappa, HeatFront f, double power, double above)
{
  const double all = q * dpe_dT * f.h2 * fabs(above);

  return all > 0.0 ? pow(1.0 + all / (6.0 * kappa * fabs(above) + power * f.h2), f.share) - 1.0 : 0.0;
}

/* Pressure that drives the reaction; forms: it is above p_e; wet: it is that of methane in water, without gas. */
typedef struct {
  PorePressure p;
  bool         forms, wet;
} Driving;

/* What the nodes of a particle have: p of (10) or (371) with its slopes; p_e (Pa) at their mean T with p_e' (Pa/K) and
   p_e''/p_e' (1/K); the covariances of T with p_w and p_g (K Pa) and the variance of T (K^2), weighted by S. */
typedef struct {
  PorePressure p;
  double       pe, dpe_dT, curvature, covariance[PHASE_COUNT], variance;
} NodesSeen;

#define CHORD_WITHIN 0.06 /* of the spread of p_e over the nodes: so near to equilibrium they are at it */
/* (424), Pa: what the chords of p_e between nodes at equilibrium lie above it. */
INLINE double ReactionChord(const NodesSeen *x)
{
  const double spread = CHORD_WITHIN * CHORD_WITHIN * x->dpe_dT * x->dpe_dT * x->variance, off = x->pe - x->p.v,
               chord = 0.5 * x->curvature * (x->p.pw * x->covariance[PHASE_W] + x->p.pg * x->covariance[PHASE_G]);

  return spread > 0.0 ? chord * spread / (spread + off * off) : 0.0;
}

/* Is there no gas phase (371)?  trace is H of (101), pressures in Pa. */
INLINE bool ReactionWithoutGas(double trace, double pw, double pg)
{
  return trace > 0.0 && pg < pw;
}

/* (10), and (371) where there is no gas phase; s_g dimensionless. */
INLINE PorePressure ReactionPressure(double trace, double sg, double pw, double pg)
{
  return ReactionWithoutGas(trace, pw, pg) ? (PorePressure){pg, 0.0, 0.0, 1.0} : PorePressureOf(sg, pw, pg);
}

/* What drives it where p_e is this, Pa. */
INLINE Driving ReactionDriving(double trace, double sg, double pw, double pg, double pe)
{
  const PorePressure p = ReactionPressure(trace, sg, pw, pg);

  return (Driving){p, p.v > pe, ReactionWithoutGas(trace, pw, pg)};
}

/* A number with its slope in T (1/K). */
typedef struct {
  double v, T;
} OfTemperature;

/* (11) per surface: -dt' M_h K_d (p_e - p)/(1 + held); p_e in Pa. */
INLINE Growth ReactionGrowth(const Kinetics *k, double dt, double held, const Driving *d, OfTemperature Kd,
                             OfTemperature pe)
{
  const double c = dt * k->M_h / (1.0 + held), drive = pe.v - d->p.v;

  return (Growth){-c * Kd.v * drive, c * Kd.v, -c * (Kd.T * drive + Kd.v * pe.T)};
}

/* (12): what a particle that holds `from` (kg) gains, with its slope in a = dt' M_h K_d A_geo (p_e - p)/rho_h >= 0. */
INLINE double ReactionDissociated(double from, double a, double *slope)
{
  const double per  = 1.0 / (1.0 + a);
  const bool   gone = from * per < HYDRATE_GONE;

  *slope = gone ? 0.0 : -from * per * per;
  return gone ? -from : -from * (a / (1.0 + a)); /* never more than there is */
}

/* What (381) asks of a particle at t_n. */
typedef struct {
  const double *h;                        /* [CL_DIM] widths of its cell, m */
  PorePressure  by;                       /* what drives the reaction */
  double        pe, dpe_dT;               /* Pa, Pa/K */
  double        heat;                     /* of the reaction, W/(m^3 Pa) */
  double        kappa, C;                 /* W/(m K), J/(m^3 K) */
  double        plastic;                  /* heat of plastic flow, W/m^3 */
  double        since;                    /* the stage's start, s */
  double        g_T[CL_DIM];              /* K/m */
  double        g_p[PHASE_COUNT][CL_DIM]; /* Pa/m */
  double        rate[PHASE_COUNT];        /* of p_w and p_g in the last step, Pa/s */
} HeldParticle;

/* (381) of a particle, dimensionless: over what is let through. */
INLINE double ReactionHeldAt(const HeldParticle *x)
{
  const double above = (x->pe - x->by.v) / x->dpe_dT,
               rate = (x->by.pw * x->rate[PHASE_W] + x->by.pg * x->rate[PHASE_G]) / x->dpe_dT; /* of equilibrium, K/s */
  double g_p[CL_DIM];

  for (int d = 0; d < CL_DIM; d++)
    g_p[d] = x->by.pw * x->g_p[PHASE_W][d] + x->by.pg * x->g_p[PHASE_G][d];
  return ReactionHeld(x->heat, x->dpe_dT, x->kappa,
                      HeatFrontOf(x->h, x->g_T, g_p, x->dpe_dT, above, x->kappa / x->C * x->since),
                      x->plastic + x->C * fabs(rate), above);
}

/* W of (418) with its slopes in S_h (1), p_c and p - p_e (1/Pa). */
typedef struct {
  double v, Sh, pc, over;
} Wetted;

#define WET_OVER 1e2  /* Pa above p_e over which W goes from the surface that melts to that of its own */
#define WET_OPEN 1e-2 /* least 1 - S_h that counts there */

/* A number with its slope in x. */
typedef struct {
  double v, x;
} Fade;
/* theta of (418), (1 - exp(-x))/x, with its slope; x >= 0, all dimensionless. */
INLINE Fade WetFade(double x)
{
  if (x < 1e-2)
    return (Fade){1.0 - x * (1.0 / 2 - x * (1.0 / 6 - x * (1.0 / 24 - x / 120))),
                  -1.0 / 2 + x * (1.0 / 3 - x * (1.0 / 8 - x * (1.0 / 30 - x / 144)))};
  const double e = exp(-x);

  return (Fade){(1.0 - e) / x, (e * (1.0 + x) - 1.0) / (x * x)};
}

/* (418): W, the surface of hydrate in water that holds methane over A_geo s_w (1 - S_h)^3; where there is gas the film
   is the surface.  H (trace) of (101), p_c = p_g - p_w (Pa), over = p - p_e >= 0 (Pa). */
INLINE Wetted ReactionWet(const Material *mat, double phi, double Sh, double pc, double over)
{
  if (!(mat->gas.trace > 0.0))
    return (Wetted){.v = 0.0};

  const double scale = RetentionTrapScale(&mat->retention), gas = exp(-fmax(pc, 0.0) / scale);
  const double open = fmax(1.0 - Sh, WET_OPEN), whole = 1.0 / (open * open * open), steep = 3.0 * whole / open;
  const Fade   fade = WetFade(over / WET_OVER);
  const double more = 1.0 + (whole - 1.0) * fade.v, W = phi * Sh * more * gas;

  return (Wetted){.v    = W,
                  .Sh   = phi * gas * (more + (1.0 - Sh > WET_OPEN ? Sh * steep * fade.v : 0.0)),
                  .pc   = pc > 0.0 ? -W / scale : 0.0,
                  .over = phi * Sh * gas * (whole - 1.0) * fade.x / WET_OVER};
}

/* dm/dm_h of (37), (40): mass of a fluid that a kg of hydrate takes the place of; held: of a unit of open pores,
 * kg/m^3.
 */
INLINE double Displaced(double held, double rho_h)
{
  return -held / rho_h;
}
