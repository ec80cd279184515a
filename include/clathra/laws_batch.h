/* laws_batch: the laws over arrays, values without the derivatives nobody asks for; one call for many particles of one
   material, so that the compiler takes several at a time.  Same numbers as laws.h to a few ulp; a law that has no such
   loop here is called particle by particle.  n values each; in and out may not overlap. */
#pragma once

#include "clathra/laws.h"

void RetentionGasShareBatch(const Retention *law, int n, const double *pc, double *s, double *ds_dpc);
void RelPermWaterBatch(const RelPerm *law, int n, const double *sw, double *kr);
void RelPermGasBatch(const RelPerm *law, int n, const double *sg, double *kr);
void PermeabilityBatch(const Permeability *law, int n, const double *phi, const double *Sh, double *k);
void LiquidDensityBatch(const Liquid *law, int n, const double *p, const double *T, double *rho);
/* The gas has this form alone; GasDensity is it for one state. */
void GasDensityBatch(const Gas *law, int n, const double *p, const double *T, double *rho, double *drho_dp,
                     double *drho_dT);
void ElasticityYoungBatch(const Elasticity *law, int n, const double *Sh, double *E);
