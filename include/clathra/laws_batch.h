/* laws_batch: the laws over arrays, values without the derivatives nobody asks for; one call for many particles of one
   material, so that the compiler takes several at a time.  The formulae are those of laws.h, the numbers to a few ulp,
   for vector code has its own exp, log and pow.  n values each, in the units of laws.h; in and out may not overlap. */
#pragma once

#include "clathra/laws.h"

void RetentionGasShareBatch(const Retention *law, int n, const double *pc, double *s, double *ds_dpc);
void RelPermWaterBatch(const RelPerm *law, int n, const double *restrict sw, double *restrict kr);
void RelPermGasBatch(const RelPerm *law, int n, const double *restrict sg, double *restrict kr);
void PermeabilityBatch(const Permeability *law, int n, const double *phi, const double *Sh, double *k);
void LiquidDensityBatch(const Liquid *law, int n, const double *restrict p, const double *restrict T,
                        double *restrict rho);
/* The gas has this form alone; GasDensity is it for one state. */
void GasDensityBatch(const Gas *law, int n, const double *p, const double *T, double *rho, double *drho_dp,
                     double *drho_dT);
void WaterViscosityBatch(const Viscosity *law, int n, const double *T, double *mu);
void GasViscosityBatch(const Viscosity *law, int n, const double *rho, const double *T, double *mu);
void ElasticityYoungBatch(const Elasticity *law, int n, const double *restrict Sh, double *restrict E);
/* p_e and K_d with their slopes in T. */
void EquilibriumPressureBatch(const Equilibrium *law, int n, const double *T, double *pe, double *dpe_dT);
void KineticsRateConstantBatch(const Kinetics *law, int n, const double *restrict T, double *restrict Kd,
                               double *restrict dKd_dT);
void KineticsFormationAreaBatch(const Kinetics *law, int n, const double *restrict sw, const double *restrict Sh,
                                double *restrict A);
void MixtureAverageBatch(int n, const double *restrict phi, const double *restrict Sh, const double *restrict sw,
                         const double X[4], double *restrict mean);
void LatentHeatBatch(const LatentHeat *law, int n, const double *restrict T, double *restrict L);
