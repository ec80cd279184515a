/* Phase equilibrium of methane hydrate: pressure p_e (Pa) of the temperature (degC). */
#include "clathra/laws.h"
#include "laws_private.h"

/* (231), Sloan (1987), (P37): p_e = A1 exp(A2 - A3/T_K). */
static double Equilibrium_Sloan(const Equilibrium *law, double T, double *dpe_dT)
{
  const double TK = T + LAW_ZERO_CELSIUS;
  double       de;
  const double e = LawExp(law->A2 - law->A3 / TK, &de);

  *dpe_dT = law->A1 * de * law->A3 / (TK * TK);
  return law->A1 * e;
}

/* ln p_e[MPa] of Moridis (2003) as polynomials in degC: the printed coefficients, in powers of kelvin, re-expanded
   about 273.15 K in 40 digits, because in kelvin the sum cancels to 1e-10. */
static const double over_water[6] = {0.93944292326009297,    0.11469924756730304,    -0.0034623775223046855,
                                     0.00031909682478716999, -9.4514591621859907e-6, 8.86065316687571e-8};
static const double over_ice[6]   = {0.96486076446964683,  0.037252533185766023,  0.00029446165785820577,
                                     7.256040054629809e-6, 4.6401931155316535e-8, 1.09882180475307e-10};
#define MORIDIS_COLDEST (148.8 - LAW_ZERO_CELSIUS) /* degC; the ends of the data */
#define MORIDIS_HOTTEST (320.0 - LAW_ZERO_CELSIUS)
#define MORIDIS_CROSSING 0.33344344905243205 /* degC, where the two polynomials meet */
#define MORIDIS_BLEND 0.25                   /* K, half-width of the blend */

static double Polynomial(const double c[6], double t, double *dt)
{
  double y = c[5];

  *dt = 0.0;
  for (int i = 4; i >= 0; i--) {
    *dt = *dt * t + y;
    y   = y * t + c[i];
  }
  return y;
}

/* (232), Moridis (2003), 148.8-320 K; outside the exponent continues linearly.  The printed switch at 273.2 K jumps by
   2 %, which no Newton iteration can sit on: the branches are joined where they cross (273.483 K), C1 over +-0.25 K;
   the printed values stand everywhere but in 273.2-273.74 K. */
static double Equilibrium_Moridis(const Equilibrium *law, double T, double *dpe_dT)
{
  const double t = fmax(MORIDIS_COLDEST, fmin(T, MORIDIS_HOTTEST));
  const double x = fmax(0.0, fmin((t - MORIDIS_CROSSING) / (2.0 * MORIDIS_BLEND) + 0.5, 1.0));
  const double w = x * x * (3.0 - 2.0 * x), dw = 6.0 * x * (1.0 - x) / (2.0 * MORIDIS_BLEND); /* weight of water */
  double       dy_w, dy_i, de;
  const double y_w = Polynomial(over_water, t, &dy_w), y_i = Polynomial(over_ice, t, &dy_i);
  const double dy = dy_i + w * (dy_w - dy_i) + dw * (y_w - y_i);
  const double e  = LawExp(y_i + w * (y_w - y_i) + dy * (T - t), &de);

  (void)law;
  *dpe_dT = 1e6 * de * dy;
  return 1e6 * e;
}

typedef double (*Pressure)(const Equilibrium *, double, double *);
static const char *const names[] = {"sloan", "moridis", NULL};
static const Pressure    laws[]  = {Equilibrium_Sloan, Equilibrium_Moridis};
_Static_assert(sizeof names / sizeof *names == sizeof laws / sizeof *laws + 1, "a name for every law");

const char *const *EquilibriumTypes(void)
{
  return names;
}

/* Sets the function and the name; A1, A2, A3 stay.  False, and nothing set, for an unknown name. */
bool EquilibriumSetType(Equilibrium *law, const char *type)
{
  const int i = LawFind(names, type);

  if (i < 0)
    return false;
  law->pressure = laws[i];
  law->type     = names[i];
  return true;
}
