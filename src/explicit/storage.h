/* Consistent storage (413), as far as the stable step has room for it. */
#pragma once

#include "lanes.h"

/* Of each wavelength's increment a share (1 - l)(1 - CONSISTENT l) is amiss, l between 1 for what is smooth and 1/4 for
   what alternates along an axis: 0.47 at most, and 0.04 above l = 0.65.  Lumped storage alone has 1 - l. */
#define CONSISTENT 1.5
#define ROOM 0.2 /* of the 4 of (38), kept for it */

/* (312): k_a over that without hydrate, where what (350) weighs with does not count hydrate. */
static inline double Openness(Set s, const Material *mat, double phi, double Sh)
{
  double dphi, dSh;

  if (!s.layers || !mat->reacts)
    return 1.0;
  return PermeabilityEvaluate(&mat->permeability, phi, Sh, &dphi, &dSh) /
         PermeabilityEvaluate(&mat->permeability, phi, 0.0, &dphi, &dSh);
}

/* What a fluid adds to the left side of (38) over dt (s), dimensionless: square of its highest frequency, 1/s^2, rate
   of decay of its motion, 1/s. */
static inline double FluidGrowth(double dt, double square, double decay)
{
  return 2.0 * dt * dt * square / (1.0 + dt * decay);
}

/* beta of (413) where the fluids add f over the stable step: 0 to CONSISTENT, dimensionless. */
static inline double ConsistentShare(double f)
{
  return (1.0 + CONSISTENT) * f < ROOM ? CONSISTENT : f < ROOM ? ROOM / f - 1.0 : 0.0;
}
