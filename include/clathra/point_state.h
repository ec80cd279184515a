/* State of a particle: every relation once, with its slopes, for one particle (residual, Jacobian: they carry the
   slopes along as jets) and for loops over blocks of them (hybrid, which takes of the slopes what it needs). */
#pragma once

#include "clathra/inline.h"
#include "clathra/jet.h"
#include "clathra/material.h"

/* (8) in numbers of a kind: doubles in loops over blocks, jets in one particle; Less(a, b) = a - b, Over(a, b) = a/b.
   What a mass m (kg) of density rho (kg/m^3) leaves of a volume (m^3): grains the pores V_p, hydrate the open ones V_f;
   V_p over V is phi, the volume of hydrate over V_p is S_h. */
#define CL_PORES(Number, VolumeLeft, PoreShare, Less, Over)                                                            \
  INLINE Number VolumeLeft(Number volume, Number m, Number rho)                                                        \
  {                                                                                                                    \
    return Less(volume, Over(m, rho));                                                                                 \
  }                                                                                                                    \
  INLINE Number PoreShare(Number m, Number rho, Number pore)                                                           \
  {                                                                                                                    \
    return Over(Over(m, rho), pore);                                                                                   \
  }
#define CL_LESS(a, b) ((a) - (b))
#define CL_OVER(a, b) ((a) / (b))
CL_PORES(double, VolumeLeft, PoreShare, CL_LESS, CL_OVER)
CL_PORES(Jet, VolumeLeftJet, PoreShareJet, JetSub, JetDiv)

typedef struct {
  double pore, open, phi, Sh; /* V_p and V_f, m^3; phi and S_h */
} Pores;

/* (8) of a volume V (m^3) with masses (kg) of grains and hydrate of these densities (kg/m^3). */
INLINE Pores PoresOf(double V, double m_s, double rho_s, double m_h, double rho_h)
{
  const double pore = VolumeLeft(V, m_s, rho_s);

  return (Pores){pore, VolumeLeft(pore, m_h, rho_h), pore / V, PoreShare(m_h, rho_h, pore)};
}

/* Of a fluid at its own pressure p (Pa) and T (degC), kg/m^3, with slopes, kg/(m^3 Pa) and kg/(m^3 K). */
INLINE double FluidDensity(const Material *mat, int phase, double p, double T, double *drho_dp, double *drho_dT)
{
  return phase == PHASE_W ? LiquidDensity(&mat->water, p, T, drho_dp, drho_dT)
                          : GasDensity(&mat->gas, p, T, drho_dp, drho_dT);
}

/* Pressure with slopes in s_g, p_w and p_g. */
typedef struct {
  double v, sg, pw, pg;
} PorePressure;

/* (10); s_g dimensionless, pressures in Pa. */
INLINE PorePressure PorePressureOf(double sg, double pw, double pg)
{
  return (PorePressure){pw + sg * (pg - pw), pg - pw, 1.0 - sg, sg};
}

#define CL_LEAST_COMPLIANCE 1e-20 /* 1/Pa: incompressible water counts by its volume (449) */

#define CL_GAS_FLOWS 0.1 /* of p_w: with less p_g a pore has no gas that could flow (323) */

/* (323): is it this part of p_w that sets the density with which gas flows?  H as in Gas.trace, kg/(m^3 Pa); Pa. */
INLINE bool GasFlowsByWater(double H, double pw, double pg)
{
  return H > 0.0 && pg < CL_GAS_FLOWS * pw;
}

/* Mass in a unit of open pore volume, kg/m^3, with slopes in s_g, in the fluid's density and, apart from it, in its own
   pressure. */
typedef struct {
  double v, sg, rho, p;
} Content;

/* (9); s_g dimensionless, rho in kg/m^3. */
INLINE Content WaterContent(double sg, double rho)
{
  return (Content){(1.0 - sg) * rho, -rho, 1.0 - sg, 0.0};
}

/* Methane in a volume of water (101), kg/m^3; H as in Gas.trace or Gas.carried. */
INLINE double DissolvedMethane(double H, double pg)
{
  return H * pg;
}

/* (352): mass of methane that goes with a unit mass of water; H as in Gas.carried, kg/(m^3 Pa), p_g in Pa, kg/m^3. */
INLINE double CarriedShare(double H, double pg, double rho_w)
{
  return DissolvedMethane(H, pg) / rho_w;
}

/* (101); H as in Gas.trace, kg/(m^3 Pa); s_g dimensionless, rho in kg/m^3, p_g in Pa. */
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
