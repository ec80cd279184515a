/* Flow of the fluids through a particle: every relation once, with its slopes, for one particle and for loops over
   blocks (point_state.h). */
#pragma once

#include <stdbool.h>
#include "clathra/inline.h"

#define CL_MOBILITY_FLOOR 1e-9 /* of k_r: an immobile fluid has one pressure in all directions, and a velocity */

/* What k_r is a function of, with slopes in the fluid's share of the open pores and in S_h. */
typedef struct {
  double v, share, Sh;
} KrArgument;

/* share: of the open pores, in [0, 1]. */
INLINE KrArgument KrArgumentOf(bool of_pores, double share, double Sh)
{
  const double of = of_pores ? 1.0 - Sh : 1.0;

  return (KrArgument){of * share, of, of_pores ? -share : 0.0};
}

/* k_r, or the least that a mobility is taken with. */
INLINE double KrFloored(double kr)
{
  return kr < CL_MOBILITY_FLOOR ? CL_MOBILITY_FLOOR : kr;
}

/* Mobility with what inertia holds, m^2/(Pa s), with slopes in k_r, mu/k_a and rho. */
typedef struct {
  double v, kr, resist, rho;
} Tau;

/* (20); per_dt: 1/dt', with mass scaling, or 0 without inertia. */
INLINE Tau TauOf(double kr, double resist, double rho, double per_dt)
{
  const double sum = resist + kr * rho * per_dt, v = kr / sum;

  return (Tau){v, resist / (sum * sum), -v / sum, -v * v * per_dt};
}

/* (18) along one axis, kg m/s: Darcy flux J and projected less own gradient, both on the configuration at t_n. */
INLINE double MassFlux(double V, double rho, double rho_tau, double J, double gradient)
{
  return V * (rho * J + rho_tau * gradient);
}
