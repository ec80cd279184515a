/* Flow of the fluids through a particle: every relation once, with its slopes, for one particle and for loops over
   blocks (point_state.h). */
#pragma once

#include <math.h>
#include <stdbool.h>
#include "clathra/dimension.h"
#include "clathra/inline.h"

#define CL_MOBILITY_FLOOR 1e-9 /* of k_r: an immobile fluid has one pressure in all directions, and a velocity */

/* A of (306), what drives a fluid per gradient in units of k_a: xx, yy, xy; 1 without beds. */
typedef struct {
  double xx, yy, xy;
} Beds;

/* (306), (307) of a material whose beds dip by `dip` (rad) from x towards y and lay like that where the deformation
   gradient F (xx, xy, yx, yy) was 1; ratio of k across them to k along them. */
INLINE Beds BedsOf(double ratio, double dip, const double F[4])
{
  const double n0[2] = {-sin(dip), cos(dip)}, n[2] = {F[3] * n0[0] - F[2] * n0[1], F[0] * n0[1] - F[1] * n0[0]};
  const double c = (1.0 - ratio) / (n[0] * n[0] + n[1] * n[1]);

  return (Beds){1.0 - c * n[0] * n[0], 1.0 - c * n[1] * n[1], -c * n[0] * n[1]};
}

/* v := A v; A dimensionless. */
INLINE void BedsDrive(const Beds *A, double v[2])
{
  const double x = v[0], y = v[1];

  v[0] = A->xx * x + A->xy * y;
  v[1] = A->xy * x + A->yy * y;
}

/* (309): what drives a fluid whose weight is w (rho b, Pa/m) like the gradient g of its pressure (Pa/m): g itself where
   it is at rest. */
INLINE void BedsDriveMoving(const Beds *A, const double w[2], double g[2])
{
  for (int d = 0; d < CL_DIM; d++)
    g[d] -= w[d];
  BedsDrive(A, g);
  for (int d = 0; d < CL_DIM; d++)
    g[d] += w[d];
}

/* J . (A^-1 - 1) J: what drag takes more than along the beds. */
INLINE double BedsDrag(const Beds *A, const double J[2])
{
  const double det = A->xx * A->yy - A->xy * A->xy;

  return (A->yy * J[0] * J[0] - 2.0 * A->xy * J[0] * J[1] + A->xx * J[1] * J[1]) / det - J[0] * J[0] - J[1] * J[1];
}

/* What k_r is a function of, with slopes in the fluid's share of the open pores and in S_h. */
typedef struct {
  double v, share, Sh;
} KrArgument;

/* share: of the open pores, in [0, 1], dimensionless. */
INLINE KrArgument KrArgumentOf(bool of_pores, double share, double Sh)
{
  const double of = of_pores ? 1.0 - Sh : 1.0;

  return (KrArgument){of * share, of, of_pores ? -share : 0.0};
}

/* k_r, or the least that a mobility is taken with; dimensionless. */
INLINE double KrFloored(double kr)
{
  return kr < CL_MOBILITY_FLOOR ? CL_MOBILITY_FLOOR : kr;
}

/* Mobility with what inertia holds, m^2/(Pa s), with slopes in k_r, mu/k_a and rho. */
typedef struct {
  double v, kr, resist, rho;
} Tau;

/* (20); resist: Pa s/m^2, rho: kg/m^3; per_dt: 1/dt' (1/s), with mass scaling, or 0 without inertia. */
INLINE Tau TauOf(double kr, double resist, double rho, double per_dt)
{
  const double sum = resist + kr * rho * per_dt, v = kr / sum;

  return (Tau){v, resist / (sum * sum), -v / sum, -v * v * per_dt};
}

/* (353): share of what a particle's pressure differs by from its nodes' that flow within the cell takes away in
   dt (s); mobility: sum over the fluids of k_a k_r/mu, m^2/(Pa s); storage per volume of sediment, 1/Pa; half-lengths
   l, m. */
INLINE double ExchangeShare(double mobility, double storage, const double l[CL_DIM], double dt)
{
  double sum = 0.0;

  for (int d = 0; d < CL_DIM; d++)
    sum += 0.5 / (l[d] * l[d]);
  return -expm1(-dt * sum * mobility / storage);
}

/* (18) along one axis, kg m/s: Darcy flux J and projected less own gradient, both on the configuration at t_n. */
INLINE double MassFlux(double V, double rho, double rho_tau, double J, double gradient)
{
  return V * (rho * J + rho_tau * gradient);
}
