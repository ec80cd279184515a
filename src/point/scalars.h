/* Private to point/: the scalar state of a particle with its slopes in (J, p_w, p_g, T). */
#pragma once

#include "clathra/jet.h"
#include "clathra/point.h"

typedef struct {
  Jet  pw, pg, T, rho_h; /* Pa, degC, kg/m^3 */
  Jet  V, Vp, phi, Sh, sw, sg, p;
  Jet  m_h, m[PHASE_COUNT]; /* masses, kg */
  Jet  gain; /* m_h - m_h*, kg, as the reaction makes it: the difference would round what m_h* is the large part of */
  Jet  rho[PHASE_COUNT];                     /* intrinsic densities */
  Jet  resist[PHASE_COUNT], kr[PHASE_COUNT]; /* mu/k_a, Pa s/m^2; relative permeability */
  Jet  capacity, kappa;                      /* V C_m (J/K); kappa_m (W/m/K) */
  Jet  latent;                               /* J/kg */
  Jet  warm[PHASE_COUNT];                    /* beta T_K of the fluids, where compression counts */
  Jet  E;                                    /* Young's modulus, Pa */
  Jet  beta;                                 /* mean volumetric expansivity of the skeleton, 1/K */
  bool limited;
} ScalarState;
