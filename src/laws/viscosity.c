/* Viscosities of water and of gas. */
#include "clathra/laws_batch.h"
#include "laws_private.h"

#define COLDEST -40.0 /* degC: the water's laws are of no use below, nor above, and stay what they are there */
#define HOTTEST 180.0

/* (128): Kestin, Sokolov and Wakeham (1978), with the factor of salt of Sharqawy, Lienhard and Zubair (2010). */
static double Kestin(double S, double T, double *dT)
{
  const double t = T < COLDEST ? COLDEST : T > HOTTEST ? HOTTEST : T, d = 20.0 - t, per = 1.0 / (t + 96.0);
  const double sum = 1.2364 + d * (-1.37e-3 + d * 5.7e-6), y = d * per * sum,
               y_t = -per * sum - y * per - d * per * (-1.37e-3 + 2.0 * d * 5.7e-6);
  const double A = 1.541 + t * (1.998e-2 - t * 9.52e-5), A_t = 1.998e-2 - 2.0 * t * 9.52e-5;
  const double B = 7.974 + t * (-7.561e-2 + t * 4.724e-4), B_t = -7.561e-2 + 2.0 * t * 4.724e-4;
  const double mu = 1.002e-3 * exp(LAW_LN10 * y), salt = 1.0 + S * (A + B * S);

  *dT = T == t ? mu * (LAW_LN10 * y_t * salt + S * (A_t + B_t * S)) : 0.0;
  return mu * salt;
}

double WaterViscosity(const Viscosity *law, double T, double *dmu_dT)
{
  *dmu_dT = 0.0;
  return law->law == WATER_VISCOSITY_KESTIN ? Kestin(law->salinity, T, dmu_dT) : law->mu;
}

/* (129), Lee, Gonzalez and Eakin (1966): T in degrees Rankine, M in g/mol, rho in g/cm^3; 1e-4 cP = 1e-7 Pa s. */
static double Lee(double M, double rho, double T, double *drho, double *dT)
{
  const double g = 1e3 * M, t = 1.8 * (T + LAW_ZERO_CELSIUS), r = 1e-3 * rho < 1e-12 ? 1e-12 : 1e-3 * rho;
  const double bottom = 209.2 + 19.26 * g + t, K = (9.379 + 0.01607 * g) * t * sqrt(t) / bottom;
  const double X = 3.448 + 986.4 / t + 0.01009 * g, Y = 2.447 - 0.2224 * X, log_r = log(r), power = exp(Y * log_r);
  const double mu = 1e-7 * K * exp(X * power), X_t = -986.4 / (t * t);

  *drho = r > 1e-12 ? mu * X * Y * power / r * 1e-3 : 0.0;
  *dT   = 1.8 * mu * (1.5 / t - 1.0 / bottom + X_t * power * (1.0 - 0.2224 * X * log_r));
  return mu;
}

double GasViscosity(const Viscosity *law, double rho, double T, double *dmu_drho, double *dmu_dT)
{
  *dmu_drho = *dmu_dT = 0.0;
  return law->law == GAS_VISCOSITY_LEE ? Lee(law->M, rho, T, dmu_drho, dmu_dT) : law->mu;
}

void WaterViscosityBatch(const Viscosity *law, int n, const double *T, double *mu)
{
  double d;

  for (int q = 0; q < n; q++)
    mu[q] = law->mu;
  for (int q = 0; law->law != WATER_VISCOSITY_CONSTANT && q < n; q++)
    mu[q] = WaterViscosity(law, T[q], &d);
}

void GasViscosityBatch(const Viscosity *law, int n, const double *rho, const double *T, double *mu)
{
  double d, e;

  for (int q = 0; q < n; q++)
    mu[q] = law->mu;
  for (int q = 0; law->law != GAS_VISCOSITY_CONSTANT && q < n; q++)
    mu[q] = GasViscosity(law, rho[q], T[q], &d, &e);
}
