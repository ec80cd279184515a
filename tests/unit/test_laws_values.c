/* Values of the laws against independent numbers: 40 to 60 digits (mpmath), hand calculation, docs and scenes. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <math.h>
#include <cmocka.h>
#include "clathra/laws.h"
#include "clathra/point_reaction.h"

#define COUNT(a) (sizeof(a) / sizeof *(a))

static void Near(double got, double want, double rel)
{
  if (!(fabs(got - want) <= rel * fabs(want)))
    fail_msg("%.17g, expected %.17g within %g", got, want, rel);
}

static const Retention BP2 = {.p0 = 5e4, .m = 0.3, .lambda = 0.5, .Swr = 0.2, .Sgr = 0.4};

static void RetentionValues(void **state)
{
  /* BP2's smooth curve in 60 digits (mpmath): p_c, s_g, slope */
  static const double exact[][3] = {
      {-1e6, 8.2446144897542313e-10, 1.64892289795e-14}, {-5e4, 0.14715177645341246, 2.943035523e-6},
      {-100, 0.38692417063323864, 4.325797334e-6},       {0, 0.38735372246897245, 4.26522970315e-6},
      {1, 0.3873579873957162, 4.26462378387e-6},         {2500, 0.39620417123391229, 2.87803538649e-6},
      {5e4, 0.47509904142345776, 1.39243269302e-6},      {1e6, 0.68967247941097068, 4.66373905101e-8},
      {1e9, 0.79426198963633819, 2.45914553489e-12},
  };
  Retention law = BP2;
  double    d, none;

  RetentionSetType(&law, "van_genuchten");
  for (size_t i = 0; i < COUNT(exact); i++) {
    Near(RetentionGasShare(&law, exact[i][0], 0.0, &d, &none), exact[i][1], 2e-15);
    Near(d, exact[i][2], 1e-11);
  }
  law = (Retention){.p0 = 1e5, .m = 0.45, .Swr = 0.3, .Sgr = 0}; /* S_gr' = 1e-4 */
  RetentionSetType(&law, "van_genuchten");
  Near(RetentionGasShare(&law, -3e6, 0.0, &d, &none), 9.3576229688401746e-18, 2e-15);
  assert_true(RetentionGasShare(&law, -1e9, 0.0, &d, &none) == 0 && d == 0);

  law = BP2;
  RetentionSetType(&law, "van_genuchten_clamped");
  Near(RetentionGasShare(&law, 5e4, 0.0, &d, &none), 0.4 + 0.4 * (1 - pow(2, -0.3)), 1e-15);
  assert_true(RetentionGasShare(&law, -1, 0.0, &d, &none) == 0.4 && d == 0);
  assert_true(RetentionGasShare(&law, 0, 0.0, &d, &none) == 0.4 && d == 0);
  RetentionSetType(&law, "brooks_corey");
  Near(RetentionGasShare(&law, 2e5, 0.0, &d, &none), 0.4 + 0.4 * 0.5, 1e-15);
  Near(d, 0.4 * 0.5 * 0.5 / 2e5, 1e-15);
  assert_true(RetentionGasShare(&law, 4.9e4, 0.0, &d, &none) == 0.4 && d == 0);
}

static void RelPermValues(void **state)
{
  const RelPerm bp2 = {0.2, 0.4, 4, 2, false}, masuda = {0.1, 0, 0.82, 2.11, true};
  double        d;

  Near(RelPermWater(&bp2, 0.4, &d), 0.0625, 1e-14); /* b = 1/2 */
  Near(d, 4 * 0.125 / 0.4, 1e-14);
  Near(RelPermGas(&bp2, 0.5, &d), 0.0625, 1e-14); /* b = 1/4 */
  Near(RelPermWater(&masuda, 0.55, &d), pow(0.5, 0.82), 1e-14);
  Near(RelPermWater(&masuda, 0.1 + 0.9 * 2e-3, &d), pow(2e-3, 0.82), 1e-11); /* just above the toe */
  assert_true(RelPermWater(&bp2, 0.2, &d) == 0 && d == 0);
  assert_true(RelPermWater(&bp2, 0.1, &d) == 0 && d == 0);
  assert_true(RelPermWater(&bp2, 0.7, &d) == 1 && d == 0);
  assert_true(RelPermWater(&masuda, 0.05, &d) == 0 && d == 0);
}

static void PermeabilityValues(void **state)
{
  Permeability law = {.k0 = 1e-15, .phi0 = 0.5, .mh = 3, .kh = 0.01, .Shc = 1e-4};
  double       dp, ds;

  assert_true(PermeabilitySetHydrateType(&law, "power") && PermeabilitySetPorosityType(&law, "kozeny_carman"));
  Near(PermeabilityEvaluate(&law, 0.5, 0, &dp, &ds), 1e-15, 1e-15);
  Near(PermeabilityEvaluate(&law, 0.25, 0.5, &dp, &ds), 1e-15 * pow(0.5, 1.5) * 8.0 / 27.0 * 0.125, 1e-14);
  assert_true(PermeabilityEvaluate(&law, 0.5, 1, &dp, &ds) == 0 && ds == 0);
  PermeabilitySetPorosityType(&law, "square_jacobian");
  Near(PermeabilityEvaluate(&law, 0.25, 0, &dp, &ds), 1e-15 * 4.0 / 9.0, 1e-14);
  PermeabilitySetPorosityType(&law, "none");
  PermeabilitySetHydrateType(&law, "masuda_ramp");
  Near(PermeabilityEvaluate(&law, 0.1, 0, &dp, &ds), 1e-15, 1e-14);
  Near(PermeabilityEvaluate(&law, 0.1, 5e-5, &dp, &ds), 0.505e-15, 1e-13);
  Near(PermeabilityEvaluate(&law, 0.1, 0.4, &dp, &ds), 1e-17, 1e-14);
}

static double Printed(const double c[6], double TK)
{
  double y = 0;

  for (int i = 5; i >= 0; i--)
    y = y * TK + c[i];
  return 1e6 * exp(y);
}

static void EquilibriumValues(void **state)
{
  /* as printed by Moridis (2003), in powers of kelvin */
  static const double water[6] = {-1.94138504464560e5, 3.31018213397926e3,   -2.25540264493806e1,
                                  7.67559117787059e-2, -1.30465829788791e-4, 8.86065316687571e-8};
  static const double ice[6]   = {-4.38921173434628e1, 7.76302133739303e-1,  -7.27291427030502e-3,
                                  3.85413985900724e-5, -1.03669656828834e-7, 1.09882180475307e-10};
  Equilibrium         law      = {.A1 = 1000, .A2 = 38.98, .A3 = 8533.8};
  double              d, last = 0;

  EquilibriumSetType(&law, "sloan");
  Near(EquilibriumPressure(&law, 4, &d), 3600153.39665444, 1e-13);
  EquilibriumSetType(&law, "moridis");
  Near(EquilibriumPressure(&law, 4, &d), 3899838.8411577, 1e-13); /* 40 digits */
  Near(EquilibriumPressure(&law, 20, &d), 23868483.325021, 1e-13);
  Near(EquilibriumPressure(&law, 0, &d), 2624422.2182147, 1e-13);
  Near(EquilibriumPressure(&law, 46.85 + 50, &d), 400900240919.61, 1e-12);
  for (double TK = 149; TK < 320; TK += 0.37) {
    if (TK <= 273.2 || TK >= 273.74)
      Near(EquilibriumPressure(&law, TK - 273.15, &d), Printed(TK > 273.2 ? water : ice, TK), 1e-9);
  }
  for (double T = -0.5; T < 1.5; T += 1e-3) { /* the join */
    const double p = EquilibriumPressure(&law, T, &d), lo = fmin(Printed(water, T + 273.15), Printed(ice, T + 273.15));

    assert_true(p > last && d > 0 && p >= lo * (1 - 1e-9));
    last = p;
  }
}

/* p_e''/p_e': Sloan's by hand, others by differences of p_e. */
static void EquilibriumCurvatures(void **state)
{
  const char *const *type;
  Equilibrium        law = {.A1 = 1.15, .A2 = 49.3185, .A3 = 9459};
  double             d;

  (void)state;
  EquilibriumSetType(&law, "sloan");
  Near(EquilibriumCurvature(&law, 4), 9459 / (277.15 * 277.15) - 2 / 277.15, 1e-3);
  for (type = EquilibriumTypes(); *type; type++) {
    EquilibriumSetType(&law, *type);
    for (double T = 2; T < 20; T += 1.7) {
      const double h = 0.05, up = EquilibriumPressure(&law, T + h, &d), down = EquilibriumPressure(&law, T - h, &d),
                   p = EquilibriumPressure(&law, T, &d);

      Near(EquilibriumCurvature(&law, T), (up - 2 * p + down) / (h * h * d), 3e-3);
    }
  }
}

static void OtherCurves(void **state)
{
  Equilibrium law = {.shift = 0};
  double      d, fresh;

  assert_true(EquilibriumSetType(&law, "kamath"));
  Near(EquilibriumPressure(&law, 4, &d), 3600153.3966544433, 1e-13); /* 40 digits */
  Near(EquilibriumPressure(&law, 10, &d), 6913313.392231686, 1e-13);
  Near(EquilibriumPressure(&law, -5, &d), 2166085.8161686994, 1e-13);
  assert_true(EquilibriumSetType(&law, "masuda"));
  Near(EquilibriumPressure(&law, 4, &d), 4541324.18581276, 1e-13);
  Near(EquilibriumPressure(&law, 10, &d), 9359853.57636106, 1e-13);
  fresh     = EquilibriumPressure(&law, 10, &d);
  law.shift = 1.5;
  Near(EquilibriumPressure(&law, 8.5, &d), fresh, 1e-13);
}

static void BrineValues(void **state)
{
  Near(BrineMelting(0.04, 101325 + 500e4), -2.588567466391664, 1e-13); /* the check value of Fofonoff and Millard */
  assert_true(BrineMelting(0, 101325) == 0);
  Near(BrineMelting(0, 1e6), -0.0677, 0.01); /* -0.0753 K/MPa; Clausius-Clapeyron: -0.0743 */
  Near(BrineEquilibriumShift(0.0335), 1.1, 1e-14);
  Near(BrineEquilibriumShift(0.035), 1.150757415565222, 1e-12);
  Near(BrineEquilibriumShift(0.1), 3.485647820968829, 1e-12);
  assert_true(BrineEquilibriumShift(0) == 0 && BrineExcessDensity(0, 10) == 0);
  Near(BrineExcessDensity(0.035, 5), 1027.67547 - 999.96675, 0.01); /* EOS-80 */
  Near(BrineExcessDensity(0.035, 25), 1023.34306 - 997.04796, 0.02);
}

static void ViscosityValues(void **state)
{
  const Viscosity water = {.law = WATER_VISCOSITY_KESTIN, .mu = 7},
                  salty = {.law = WATER_VISCOSITY_KESTIN, .salinity = 0.035};
  const Viscosity gas = {.law = GAS_VISCOSITY_LEE, .M = 0.016043}, held = {.mu = 3};
  double          d, e;

  Near(WaterViscosity(&water, 0, &d), 0.0017915037498227595, 1e-13); /* 40 digits; measured 1.792e-3 */
  Near(WaterViscosity(&water, 20, &d), 1.002e-3, 1e-13);
  Near(WaterViscosity(&water, 25, &d), 0.89020056617052e-3, 1e-12);
  Near(WaterViscosity(&salty, 20, &d), 1.077e-3, 5e-3); /* sea water, ITTC (2011) */
  Near(GasViscosity(&gas, 0.65, 26.85, &d, &e), 1.1434807304398947e-05, 1e-12);
  Near(GasViscosity(&gas, 0.65, 26.85, &d, &e), 1.112e-5, 0.03); /* methane at 0.1 MPa */
  Near(GasViscosity(&gas, 87.315, 4, &d, &e), 1.4199571152950395e-05, 1e-12);
  assert_true(WaterViscosity(&held, 4, &d) == 3 && d == 0 && GasViscosity(&held, 4, 4, &d, &e) == 3 && d == 0 &&
              e == 0);
}

static void KineticsValues(void **state)
{
  Kinetics masuda = {.K0 = 3.6e4, .dE = 78151, .A_geo = 7.5e5, .M_h = 0.124};
  Kinetics bp2    = {.K0 = 2.5e-10, .dE = 0, .A_geo = 1e6};
  double   d, e;

  masuda.equilibrium = (Equilibrium){.A1 = 1.15, .A2 = 49.3185, .A3 = 9459};
  EquilibriumSetType(&masuda.equilibrium, "sloan");
  const double Kd = KineticsRateConstant(&masuda, 2.3, &d), pe = EquilibriumPressure(&masuda.equilibrium, 2.3, &e);

  Material wet         = {.gas.trace = 1e-9};
  wet.retention.p_trap = 1e4;
  Near(Kd, 5.44118333753e-11, 1e-11);
  Near(Kd * masuda.A_geo * (pe - 2.84e6) * masuda.M_h / 900, 4.7161e-3, 1e-5);
  Near(EquilibriumPressure(&masuda.equilibrium, 2.081, &e), 3.5798e6, 1e-4); /* closed adiabatic cell */
  assert_true(KineticsRateConstant(&bp2, -50, &d) == 2.5e-10 && d == 0);
  Near(KineticsFormationArea(&bp2, 0.6, 0, 0.5).v, 1e6 * 0.3 * 0.2 * 0.5, 1e-14);
  assert_true(KineticsFormationArea(&bp2, 0.6, 0, 1).v == 0 && KineticsFormationArea(&bp2, 0.6, 0, 1).sw == 0);
  assert_true(KineticsFormationArea(&bp2, 1, 0, 0.3).v == 0 && KineticsFormationArea(&bp2, 0, 2, 0.3).v == 0);
  /* (418): A_geo phi S_h s_w (1 - S_h)^3 */
  Near(KineticsFormationArea(&bp2, 1, ReactionWet(&wet, 0.4, 0.3, -1e5, 1e30).v, 0.3).v, 1e6 * 0.4 * 0.3 * 0.343,
       1e-14);
  Near(KineticsFormationArea(&bp2, 1, ReactionWet(&wet, 0.4, 0.3, -1e5, 0.0).v, 0.3).v,
       KineticsMeltingArea(&bp2, 0.4, 0.3), 1e-14);
  Near(ReactionWet(&wet, 0.4, 0.3, 2e4, 10.0).v / ReactionWet(&wet, 0.4, 0.3, 0.0, 10.0).v, 0.1353352832366127, 1e-14);
  wet.gas.trace = 0.0;
  assert_true(ReactionWet(&wet, 0.4, 0.3, 0.0, 0.0).v == 0.0);
}

/* The front (382) that g_T (K/m), g_p over p_e' (K/m) and T above equilibrium (K) make of cells of 2 m and 0.5 m. */
static HeatFront Front(double T_x, double T_y, double p_x, double p_y, double above)
{
  const double h[CL_DIM] = {2.0, 0.5}, slope = 7e5, g_T[CL_DIM] = {T_x, T_y}, g_p[CL_DIM] = {slope * p_x, slope * p_y};

  return HeatFrontOf(h, g_T, g_p, slope, above, 1e9);
}

/* By hand where T varies by far more than 1 mK. */
static void HeldReactionValues(void **state)
{
  (void)state;
  Near(Front(5.0, 0.0, 0.0, 0.0, 0.0).h2, 4.0, 1e-15); /* heat comes along x, along y, and aslant */
  Near(Front(0.0, 5.0, 0.0, 0.0, 0.0).h2, 0.25, 1e-15);
  Near(Front(3.0, 4.0, 0.0, 0.0, 0.0).h2, (9.0 * 4.0 + 16.0 * 0.25) / 25.0, 1e-15);
  Near(Front(3.0, 4.0, 0.0, 0.0, 6.0).share, 1.0, 1e-7); /* ... to what is no farther from equilibrium than that */
  Near(Front(5.0, 0.0, -1.0, 0.0, 0.0).share, 23.0 / 25.0, 1e-7);
  Near(Front(5.0, 0.0, 0.0, 0.0, -30.0).share, 100.0 / (100.0 + 400.0), 1e-7);
  assert_true(Front(5.0, 5.0, 5.0, 5.0, 0.0).share == 0.0); /* T goes with the pressure; the pressure alone; nothing */
  assert_true(Front(0.0, 0.0, 5.0, 0.0, 0.0).share == 0.0);
  assert_true(Front(0.0, 0.0, 0.0, 0.0, 0.0).share == 0.0);
  assert_true(Front(1e-5, 0.0, 0.0, 0.0, 1.0).share < 1e-8); /* a little, where all is far from equilibrium */

  const double h[CL_DIM] = {2.0, 0.5}, g_T[CL_DIM] = {5.0, 0.0}, g_p[CL_DIM] = {0.0};
  Near(HeatFrontOf(h, g_T, g_p, 7e5, 0.0, HEAT_CROSSED * 4.0).share, 0.5, 1e-7); /* heat begins to cross the cell */
  assert_true(HeatFrontOf(h, g_T, g_p, 7e5, 0.0, 0.0).share == 0.0);

  const double q = 3.0, slope = 7e5, kappa = 2.0, B = q * slope * 4.0 / (6.0 * kappa);
  Near(ReactionHeld(q, slope, kappa, (HeatFront){4.0, 1.0}, 0.0, 1.0), B, 1e-15);
  Near(ReactionHeld(q, slope, kappa, (HeatFront){4.0, 0.5}, 0.0, 1.0), sqrt(1.0 + B) - 1.0, 1e-15);
  for (int sign = -1; sign < 2; sign += 2) /* heat made in the particle itself */
    Near(ReactionHeld(q, slope, kappa, (HeatFront){4.0, 1.0}, 30.0, 5.0 * sign), q * slope / (6.0 * kappa / 4.0 + 6.0),
         1e-14);
  assert_true(ReactionHeld(q, slope, kappa, (HeatFront){4.0, 1.0}, 30.0, 0.0) == 0.0);
  assert_true(ReactionHeld(q, slope, kappa, (HeatFront){0.0, 0.0}, 0.0, 1.0) == 0.0);
}

static void StateAndHeatValues(void **state)
{
  const Liquid water = {1000, 2.2e9, 3e-4, 3.25e6, 4}, grain = {2600, INFINITY, 0, 0, 0}, soft = {1000, 1e3, 0, 0, 0};
  Gas          methane = {.M = 0.016};
  LatentHeat   latent  = {.C0 = 473632, .C1 = 140.117};
  const double X[4]    = {1, 2, 4, 8};
  double       dp, dT, d;

  Near(LiquidDensity(&water, 3.25e6, 4, &dp, &dT), 1000, 1e-15);
  Near(LiquidDensity(&water, 3.25e6 + 2.2e7, 14, &dp, &dT), 1000 * exp(0.01 - 0.003), 1e-14);
  assert_true(LiquidDensity(&grain, 1e9, 100, &dp, &dT) == 2600 && dp == 0 && dT == 0);
  assert_true(isfinite(LiquidDensity(&soft, 1e9, 4, &dp, &dT)) && isfinite(dp) && dp > 0);
  assert_true(GasSetType(&methane, "ideal"));
  Near(GasDensity(&methane, 3.25e6, 4, &dp, &dT), 0.016 * 3.25e6 / (8.314 * 277.15), 1e-14);
  Near(LatentHeatEvaluate(&latent, 4, &d), 434.8e3, 1e-4);
  latent.kirchhoff = true, latent.T_ref = 4, latent.dc = -500;
  Near(LatentHeatEvaluate(&latent, 4, &d), 473632 - 140.117 * 277.15, 1e-14);
  Near(LatentHeatEvaluate(&latent, 14, &d), 473632 - 140.117 * 277.15 - 5000, 1e-14);
  Near(MixtureAverage(0.5, 0.5, 0.25, X, &dp, &dT, &d), 0.5 * 1 + 0.25 * 2 + 0.0625 * 4 + 0.1875 * 8, 1e-15);
  assert_true(MixtureAverage(0, 0.3, 0.3, X, &dp, &dT, &d) == 1 && MixtureAverage(1, 1, 0.3, X, &dp, &dT, &d) == 2);
}

/* (120) in 40 digits, with T in degC and M = 0.016 kg/mol; and methane as it is (Setzmann and Wagner 1991, M =
   0.0160428 kg/mol), which Peng and Robinson's equation overestimates by up to 3 %. */
static void GasValues(void **state)
{
  static const double exact[][5] = {
      {1, 20, 6.5647784526858972e-06, 6.56477860675636e-06, -2.23939244568643e-08},
      {101325, 4, 0.70558289196158808, 6.98339417390007e-06, -0.00256871498786763},
      {2.84e6, 2.3, 21.536479843157771, 8.20428703801003e-06, -0.100708945249293},
      {3.75e6, 2.3, 29.189690418170613, 8.61645720760216e-06, -0.147707331837926},
      {10e6, 4, 89.531664701156345, 1.04850224641802e-05, -0.674465899129982},
      {15e6, 10, 134.3438113234447, 9.25328943483989e-06, -1.01307608893004},
      {60e6, 4, 337.4852664231509, 2.01323373108313e-06, -1.00575852261049},
      {1000e6, -50, 562.98585933515835, 2.84360341784068e-08, -0.153997630414722},
  };
  Gas    law = {.M = 0.016, .Tc = 190.564, .pc = 4.5992e6, .eccentric = 0.01142};
  double dp, dT, last = 0.0;

  assert_true(GasSetType(&law, "peng_robinson"));
  for (size_t i = 0; i < COUNT(exact); i++) {
    const double *e = exact[i];

    Near(GasDensity(&law, e[0], e[1], &dp, &dT), e[2], 1e-13);
    Near(dp, e[3], 1e-11);
    Near(dT, e[4], 1e-11);
  }
  static const double real[][3] = {{2.84e6, 2.3, 21.2713}, {3.75e6, 2.3, 28.7150}, {10e6, 4, 87.3150},
                                   {10e6, 10, 83.6243},    {15e6, 4, 138.5807},    {15e6, 10, 132.0727},
                                   {1e5, 26.85, 0.6443},   {10e6, 26.85, 75.1755}};
  static const double Z[]       = {0.92, 0.90, 0.79, 0.79, 0.77, 0.77};
  for (size_t i = 0; i < COUNT(real); i++) {
    const double rho = GasDensity(&law, real[i][0], real[i][1], &dp, &dT) * 0.0160428 / 0.016;
    const double z   = real[i][0] * 0.0160428 / (rho * 8.314 * (real[i][1] + 273.15));

    printf("methane at %.4g MPa, %.2f degC: %.4f kg/m^3, Z = %.4f; Setzmann and Wagner %.4f (%+.1f %%)\n",
           real[i][0] / 1e6, real[i][1], rho, z, real[i][2], 100.0 * (rho / real[i][2] - 1.0));
    Near(rho, real[i][2], 0.03);
    if (i < COUNT(Z))
      Near(z, Z[i], 0.04);
  }
  for (double p = -1e3; p < 1e3; p += 1.7) { /* through zero, where the gas is ideal */
    const double rho = GasDensity(&law, p, 4, &dp, &dT);

    assert_true(p == -1e3 || rho > last);
    Near(dp, 0.016 / (8.314 * 277.15), 1e-4);
    last = rho;
  }
  for (double T = -82.4; T < -81.0; T += 0.05) { /* near the critical point the iteration still ends */
    assert_true(isfinite(GasDensity(&law, 4.5992e6, T, &dp, &dT)) && dp > 0.0);
  }
}

static void ElasticityValues(void **state)
{
  Elasticity law = {9e7, 2e9, 0.5, 1, 0.25, false};
  double     d;

  Near(ElasticityYoung(&law, 0.3, &d), 9e7 + 3e8, 1e-15);
  assert_true(d == 1e9 && ElasticityYoung(&law, 0, &d) == 9e7);
  for (law.bh = 0.2; law.bh < 4; law.bh += 0.2) {
    assert_true(ElasticityYoung(&law, 0, &d) == 9e7 && isfinite(d) && d >= 0);
    assert_true(isfinite(ElasticityYoung(&law, -1e-16, &d)) && isfinite(d)); /* round-off */
    Near(ElasticityYoung(&law, 0.5, &d), 9e7 + 1e9 * pow(0.5, law.bh), 1e-14);
    Near(ElasticityYoung(&law, 1, &d), 9e7 + 1e9, 1e-14);
  }
  Near(ElasticityShearFactor(&law), 0.4, 1e-15);
  Near(ElasticityLameFactor(&law), 0.4, 1e-15);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(RetentionValues),       cmocka_unit_test(RelPermValues),
                                     cmocka_unit_test(PermeabilityValues),    cmocka_unit_test(EquilibriumValues),
                                     cmocka_unit_test(EquilibriumCurvatures), cmocka_unit_test(OtherCurves),
                                     cmocka_unit_test(BrineValues),           cmocka_unit_test(ViscosityValues),
                                     cmocka_unit_test(KineticsValues),        cmocka_unit_test(HeldReactionValues),
                                     cmocka_unit_test(StateAndHeatValues),    cmocka_unit_test(GasValues),
                                     cmocka_unit_test(ElasticityValues)};

  return cmocka_run_group_tests(tests, NULL, NULL);
}
