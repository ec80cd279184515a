/* Equations of state: intrinsic densities, kg/m^3, of pressure (Pa) and temperature (degC). */
#include "clathra/laws.h"
#include "laws_private.h"

/* rho = rho_0 exp((p - p_ref)/K - beta (T - T_ref)), (221), (P10); K = INFINITY is incompressible.  Also solid,
 * hydrate.
 */
double LiquidDensity(const Liquid *law, double p, double T, double *drho_dp, double *drho_dT)
{
  double       de;
  const double e = LawExp((p - law->p_ref) / law->K - law->beta * (T - law->T_ref), &de);

  *drho_dp = law->rho0 * de / law->K;
  *drho_dT = -law->rho0 * de * law->beta;
  return law->rho0 * e;
}

/* Ideal gas, (222), (P11): rho = M p/(R T_K). */
double GasDensity(const Gas *law, double p, double T, double *drho_dp, double *drho_dT)
{
  const double TK = T + LAW_ZERO_CELSIUS;

  *drho_dp = law->M / (LAW_GAS_CONSTANT * TK);
  *drho_dT = -*drho_dp * p / TK;
  return *drho_dp * p;
}
