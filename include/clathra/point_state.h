/* State of a particle: every relation once, with its slopes, for one particle (residual, Jacobian: they carry the
   slopes along as jets) and for loops over blocks of them (hybrid, which takes of the slopes what it needs). */
#pragma once

#include "clathra/inline.h"
#include "clathra/material.h"

/* (8): V_p and V_f, m^3, phi and S_h; a particle's jets are made of the same quotients. */
typedef struct {
  double pore, open, phi, Sh;
} Pores;

/* Of a volume V (m^3) with masses (kg) of grains and hydrate of these densities (kg/m^3). */
INLINE Pores PoresOf(double V, double m_s, double rho_s, double m_h, double rho_h)
{
  const double pore = V - m_s / rho_s, hydrate = m_h / rho_h;

  return (Pores){pore, pore - hydrate, pore / V, hydrate / pore};
}

/* Pressure with slopes in s_g, p_w and p_g. */
typedef struct {
  double v, sg, pw, pg;
} PorePressure;

/* (10) */
INLINE PorePressure PorePressureOf(double sg, double pw, double pg)
{
  return (PorePressure){pw + sg * (pg - pw), pg - pw, 1.0 - sg, sg};
}

/* Mass in a unit of open pore volume, kg/m^3, with slopes in s_g, in the fluid's density and, apart from it, in its own
   pressure. */
typedef struct {
  double v, sg, rho, p;
} Content;

/* (9) */
INLINE Content WaterContent(double sg, double rho)
{
  return (Content){(1.0 - sg) * rho, -rho, 1.0 - sg, 0.0};
}

/* Methane in a volume of water (101), kg/m^3; H as in Gas.trace or Gas.carried. */
INLINE double DissolvedMethane(double H, double pg)
{
  return H * pg;
}

/* (101); H as in Gas.trace. */
INLINE Content MethaneContent(double H, double sg, double rho, double pg)
{
  const double c = DissolvedMethane(H, pg);

  return (Content){sg * rho + (1.0 - sg) * c, rho - c, sg, (1.0 - sg) * H};
}

/* Mass (kg) with slopes in the fluid's own pressure, in that of the other fluid, and in T. */
typedef struct {
  double v, own, other, T;
} FluidMass;

/* (9) in an open volume with its slope in T; the slopes of s_g in the fluid's own pressure and in T; those of its
   density. */
INLINE FluidMass MassOf(Content c, double open, double open_T, double sg_own, double sg_T, double rho_p, double rho_T)
{
  const double turns = open * c.sg * sg_own;

  return (FluidMass){open * c.v, turns + open * (c.rho * rho_p + c.p), -turns,
                     c.v * open_T + open * (c.sg * sg_T + c.rho * rho_T)};
}
