/* Heat of a particle: every relation once, with its slopes, for one particle and for loops over blocks (point_state.h).
 */
#pragma once

#include "clathra/fields.h"
#include "clathra/inline.h"
#include "clathra/material.h"

#define HEAT_LEAST_T 1e-3 /* K from node to node: below it is what Newton's method and round-off leave (440) */

/* Of a fluid, J/(kg K). */
INLINE double SpecificHeat(const Material *mat, int phase)
{
  return phase == PHASE_W ? mat->c_w : mat->c_g;
}

/* (444) over the volume, W m/K: kappa (W/(m K)) by how much longer than wide the particle's cell of widths h (m) is;
   in the plane and about an axis. */
INLINE double LongCellConductivity(double kappa, const double h[CL_DIM])
{
  return kappa * fmax(fmax(h[1] * h[1] - 2.0 * h[0] * h[0], h[0] * h[0] - 2.0 * h[1] * h[1]), 0.0) / 6.0;
}

/* V C_m, J/K; the slopes in the masses (kg) are the specific heats. */
INLINE double HeatCapacity(const Material *mat, double m_s, double m_h, double m_w, double m_g)
{
  return m_s * mat->c_s + m_h * mat->c_h + m_w * mat->c_w + m_g * mat->c_g;
}

/* What a flux of mass takes along (21), W: c in J/(kg K), the flux in kg m/s, the gradient of T in K/m. */
INLINE double AdvectedHeat(double c, const double flux[CL_DIM], const double gT[CL_DIM])
{
  return c * VectorDot(flux, gT);
}

/* Number with slopes in phi and S_h. */
typedef struct {
  double v, phi, Sh;
} Expansivity;

/* (P45): volumetric, of skeleton and hydrate, 1/K. */
INLINE Expansivity SolidExpansivity(const Material *mat, double phi, double Sh)
{
  const double grains = 1.0 - phi, ice = phi * Sh, per = 1.0 / (grains + ice);
  const double v        = (grains * mat->solid.beta + ice * mat->hydrate.beta) * per;
  const double d_grains = (mat->solid.beta - v) * per, d_ice = (mat->hydrate.beta - v) * per;

  return (Expansivity){v, Sh * d_ice - d_grains, phi * d_ice};
}

/* Heat per mass and pressure, m^3/kg, with slopes in beta T_K and rho. */
typedef struct {
  double v, warm, rho;
} Throttling;

/* (290): what a kg of a fluid takes up per Pa that it flows down; warm: its beta T_K. */
INLINE Throttling ThrottlingOf(double warm, double rho)
{
  const double v = (1.0 - warm) / rho;

  return (Throttling){v, -1.0 / rho, -v / rho};
}

/* (290): what a flux of mass (kg m/s) takes up as it is throttled, W; share as above, the gradient of its pressure in
   Pa/m, gravity b in m/s^2. */
INLINE double ThrottledHeat(double share, const double flux[CL_DIM], const double g[CL_DIM], const double b[CL_DIM])
{
  double sum = flux[0] * (share * g[0] - b[0]);

  for (int d = 1; d < CL_DIM; d++)
    sum += flux[d] * (share * g[d] - b[d]);
  return sum;
}
