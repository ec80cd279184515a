/* Phase equilibrium of methane hydrate: pressure p_e (Pa) of the temperature (degC). */
#include "clathra/laws_batch.h"
#include "laws_private.h"

/* (231), Sloan (1987), (P37): p_e = A1 exp(A2 - A3/T_K). */
INLINE double Equilibrium_Sloan(const Equilibrium *law, double T, double *dpe_dT)
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
#define BLEND 0.25                           /* K, half-width of the blend between the curves over ice and over water */

INLINE double Polynomial(const double c[6], double t, double *dt)
{
  double y = c[5];

  *dt = 0.0;
  for (int i = 4; i >= 0; i--) {
    *dt = *dt * t + y;
    y   = y * t + c[i];
  }
  return y;
}

/* ln p_e from that over ice and over water (value and slope), joined C1 where they cross. */
INLINE double Joined(double T, double crossing, const double ice[2], const double water[2], double *dT)
{
  const double x = LawAtLeast(LawAtMost((T - crossing) / (2.0 * BLEND) + 0.5, 1.0), 0.0);
  const double w = x * x * (3.0 - 2.0 * x), dw = 6.0 * x * (1.0 - x) / (2.0 * BLEND); /* weight of water */

  *dT = ice[1] + w * (water[1] - ice[1]) + dw * (water[0] - ice[0]);
  return ice[0] + w * (water[0] - ice[0]);
}

/* (232), Moridis (2003), 148.8-320 K; outside the exponent continues linearly.  The printed switch at 273.2 K jumps by
   2 %, which no Newton iteration can sit on: the branches are joined where they cross (273.483 K); the printed values
   stand everywhere but in 273.2-273.74 K. */
INLINE double Equilibrium_Moridis(const Equilibrium *law, double T, double *dpe_dT)
{
  const double t = LawAtLeast(LawAtMost(T, MORIDIS_HOTTEST), MORIDIS_COLDEST);
  double       ice[2], water[2], dy, de;

  (void)law;
  water[0]       = Polynomial(over_water, t, &water[1]);
  ice[0]         = Polynomial(over_ice, t, &ice[1]);
  const double y = Joined(t, MORIDIS_CROSSING, ice, water, &dy), e = LawExp(y + dy * (T - t), &de);

  *dpe_dT = 1e6 * de * dy;
  return 1e6 * e;
}

/* (122), Kamath (1984), p_e in kPa, 248-298 K: over ice and over water, joined where they cross (0.807 degC). */
INLINE double Equilibrium_Kamath(const Equilibrium *law, double T, double *dpe_dT)
{
  static const double A[2] = {14.717, 38.980}, B[2] = {1886.79, 8533.80}; /* ice, water */
  const double        TK = T + LAW_ZERO_CELSIUS, crossing = (B[1] - B[0]) / (A[1] - A[0]) - LAW_ZERO_CELSIUS;
  const double        ice[2]   = {A[0] - B[0] / TK, B[0] / (TK * TK)};
  const double        water[2] = {A[1] - B[1] / TK, B[1] / (TK * TK)};
  double              dy, de;
  const double        e = LawExp(Joined(T, crossing, ice, water, &dy), &de);

  (void)law;
  *dpe_dT = 1e3 * de * dy;
  return 1e3 * e;
}

/* (123), Masuda et al. (1999), in Pa: the curve of Selim and Sloan (1989) raised by 15 %. */
INLINE double Equilibrium_Masuda(const Equilibrium *law, double T, double *dpe_dT)
{
  const double TK = T + LAW_ZERO_CELSIUS;
  double       de;
  const double e = LawExp(49.3185 - 9459.0 / TK, &de);

  (void)law;
  *dpe_dT = 1.15 * de * 9459.0 / (TK * TK);
  return 1.15 * e;
}

/* The laws by name.  A row makes its function of one state and its loop over n, at the temperature that salt shifts. */
#define EQUILIBRIUM_LAWS(X)                                                                                            \
  X("sloan", Equilibrium_Sloan)                                                                                        \
  X("moridis", Equilibrium_Moridis)                                                                                    \
  X("kamath", Equilibrium_Kamath)                                                                                      \
  X("masuda", Equilibrium_Masuda)

#define NAME(name, Law) name,
#define MAKE(name, Law)                                                                                                \
  static double Law##_One(const Equilibrium *law, double T, double *dpe_dT)                                            \
  {                                                                                                                    \
    return Law(law, T + law->shift, dpe_dT);                                                                           \
  }                                                                                                                    \
  static void Law##_Loop(const Equilibrium *law, int n, const double *restrict T, double *restrict pe,                 \
                         double *restrict dpe_dT)                                                                      \
  {                                                                                                                    \
    const Equilibrium l = *law;                                                                                        \
                                                                                                                       \
    for (int q = 0; q < n; q++)                                                                                        \
      pe[q] = Law(&l, T[q] + l.shift, &dpe_dT[q]);                                                                     \
  }
#define ONE_NAME(name, Law) Law##_One,
#define LOOP_NAME(name, Law) Law##_Loop,

typedef double (*Pressure)(const Equilibrium *, double, double *);
typedef void (*PressureLoop)(const Equilibrium *, int, const double *, double *, double *);
static const char *const names[] = {EQUILIBRIUM_LAWS(NAME) NULL};
EQUILIBRIUM_LAWS(MAKE)
static const Pressure     laws[]  = {EQUILIBRIUM_LAWS(ONE_NAME)};
static const PressureLoop loops[] = {EQUILIBRIUM_LAWS(LOOP_NAME)};

void EquilibriumPressureBatch(const Equilibrium *law, int n, const double *T, double *pe, double *dpe_dT)
{
  law->pressure_loop(law, n, T, pe, dpe_dT);
}

double EquilibriumCurvature(const Equilibrium *law, double T)
{
  double slope, beyond;

  EquilibriumPressure(law, T, &slope);
  EquilibriumPressure(law, T + CL_CURVES, &beyond);
  return EquilibriumCurvatureOf(slope, beyond);
}

/* By halving: p_e grows with T. */
double EquilibriumTemperature(const Equilibrium *law, double p)
{
  double low = -50.0, high = 60.0, slope;

  while (high - low > 1e-6) {
    const double middle = 0.5 * (low + high);

    if (EquilibriumPressure(law, middle, &slope) < p)
      low = middle;
    else
      high = middle;
  }
  return low;
}

LAW_CHOICE(EquilibriumTypes, EquilibriumSetType, Equilibrium, names, law->pressure = laws[i],
           law->pressure_loop = loops[i], law->type = names[i])
