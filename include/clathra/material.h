/* material: the laws and constants of one material, read and checked once. */
#pragma once

#include "clathra/laws.h"

typedef struct {
  char         name[64];
  double       porosity; /* initial porosity, (0,1) */
  Liquid       solid, hydrate, water;
  Gas          gas;
  double       fresh;    /* density of water without salt at the reference state, kg/m^3 */
  double       salinity; /* kg of salt per kg of water with it */
  Viscosity    mu_w, mu_g;
  double       c_s, c_h, c_w, c_g;                 /* specific heat, J/(kg K) */
  double       kappa_s, kappa_h, kappa_w, kappa_g; /* thermal conductivity, W/(m K) */
  Retention    retention;
  RelPerm      relperm;
  Permeability permeability;
  bool         reacts; /* kinetics on */
  Kinetics     kinetics;
  LatentHeat   latent;
  Elasticity   elasticity;
  Plasticity   plasticity;
} Material;
