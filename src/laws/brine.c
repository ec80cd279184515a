/* Salt in the water: what it makes of density, of the equilibrium of hydrate and of the melting point of ice. */
#include "clathra/laws.h"
#include "laws_private.h"

#define MOLAR_SALT 0.05844       /* kg/mol, NaCl */
#define MOLAR_WATER 0.018015     /* kg/mol */
#define MEASURED_SALINITY 0.0335 /* sea water of Dickens and Quinby-Hunt (1994) ... */
#define MEASURED_SHIFT 1.1       /* ... and how far it lowers the temperature of equilibrium, K */

/* (126), Sharqawy, Lienhard and Zubair (2010): the part of their density of sea water that salt makes; to 0.16, 180
 * degC. */
double BrineExcessDensity(double salinity, double T)
{
  const double S = salinity;

  return S * (802.0 + T * (-2.001 + T * (1.677e-2 - T * 3.06e-5 - S * 1.613e-5)));
}

/* ln(1 - x) of the mole fraction x of salt: of an ideal solution, -ln of the activity of its water. */
static double Dilution(double salinity)
{
  const double salt = salinity / MOLAR_SALT, water = (1.0 - salinity) / MOLAR_WATER;

  return log(water / (salt + water));
}

/* Shift of equilibrium by salt (125). */
double BrineEquilibriumShift(double salinity)
{
  return MEASURED_SHIFT * Dilution(salinity) / Dilution(MEASURED_SALINITY);
}

/* (127), Fofonoff and Millard (1983) after Millero and Leung (1976); p in decibar above that of the air. */
double BrineMelting(double salinity, double p)
{
  const double S = 1e3 * salinity;

  return S * (-0.0575 + 1.710523e-3 * sqrt(S) - 2.154996e-4 * S) - 7.53e-4 * (p - 101325.0) / 1e4;
}
