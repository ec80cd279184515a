/* laws_batch: the laws over arrays, values without the derivatives nobody asks for; one call for many particles of one
   material, so that the compiler takes several at a time.  The formulae are those of laws.h, the numbers to a few ulp,
   for vector code has its own exp, log and pow.  n values each, in and out may not overlap.  Units:
   those of laws.h. */
#pragma once

#include "clathra/laws.h"

/* s_g at p_c, and its slope. */
void RetentionGasShareBatch(const Retention *law, int n, const double *pc, const double *Sh, double *s, double *ds_dpc);
/* k_rw at s_w. */
void RelPermWaterBatch(const RelPerm *law, int n, const double *restrict sw, double *restrict kr);
/* k_rg at s_g. */
void RelPermGasBatch(const RelPerm *law, int n, const double *restrict sg, double *restrict kr);
/* k_a at phi and S_h, m^2. */
void PermeabilityBatch(const Permeability *law, int n, const double *phi, const double *Sh, double *k);
/* rho at p and T. */
void LiquidDensityBatch(const Liquid *law, int n, const double *restrict p, const double *restrict T,
                        double *restrict rho);
/* The gas has this form alone; GasDensity is it for one state. */
void GasDensityBatch(const Gas *law, int n, const double *p, const double *T, double *rho, double *drho_dp,
                     double *drho_dT);
/* mu_w at T. */
void WaterViscosityBatch(const Viscosity *law, int n, const double *T, double *mu);
/* mu_g at rho and T. */
void GasViscosityBatch(const Viscosity *law, int n, const double *rho, const double *T, double *mu);
/* E at S_h, Pa. */
void ElasticityYoungBatch(const Elasticity *law, int n, const double *restrict Sh, double *restrict E);
/* p_e and K_d with their slopes in T. */
void EquilibriumPressureBatch(const Equilibrium *law, int n, const double *T, double *pe, double *dpe_dT);
/* K_d at T, mol/(m^2 Pa s), and its slope. */
void KineticsRateConstantBatch(const Kinetics *law, int n, const double *restrict T, double *restrict Kd,
                               double *restrict dKd_dT);
/* Surface on which hydrate forms, 1/m, at the water share s_w, W of (418) and S_h. */
void KineticsFormationAreaBatch(const Kinetics *law, int n, const double *restrict sw, const double *restrict wet,
                                const double *restrict Sh, double *restrict A);
/* Mean of a property by volume; X: of solid, hydrate, water, gas. */
void MixtureAverageBatch(int n, const double *restrict phi, const double *restrict Sh, const double *restrict sw,
                         const double X[4], double *restrict mean);
/* L at T, J/kg. */
void LatentHeatBatch(const LatentHeat *law, int n, const double *restrict T, double *restrict L);
