/* curves: what the laws of a case's materials give over their variables, as rows of text; docs/laws.md is drawn from
   them. */
#include "run_private.h"

#define ROWS 201
#define MOST 4 /* values of a row */

typedef struct {
  const char *name, *columns; /* "x unit, y unit, ..." */
  double      from, to;
  int         scale; /* of from and to: 0, or what of the material: SCALE_... */
  unsigned    has;   /* fields that need the law */
  void (*evaluate)(const Material *, double x, double y[MOST]);
  int n;
} Curve;
enum { SCALE_NONE = 0, SCALE_P0 };

static double none[3]; /* slopes, which no curve shows */

static void Retention_(const Material *m, double pc, double y[MOST])
{
  y[0] = RetentionGasShare(&m->retention, pc, 0.0, &none[0], &none[1]);
  y[1] = 1.0 - y[0];
}

static void RelPerm_(const Material *m, double sw, double y[MOST])
{
  y[0] = RelPermWater(&m->relperm, sw, &none[0]);
  y[1] = RelPermGas(&m->relperm, 1.0 - sw, &none[0]);
}

static void WithHydrate(const Material *m, double Sh, double y[MOST])
{
  y[0] = PermeabilityEvaluate(&m->permeability, m->permeability.phi0, Sh, &none[0], &none[1]) / m->permeability.k0;
}

static void WithPorosity(const Material *m, double phi, double y[MOST])
{
  y[0] = PermeabilityEvaluate(&m->permeability, phi, 0.0, &none[0], &none[1]) / m->permeability.k0;
}

static void Equilibrium_(const Material *m, double T, double y[MOST])
{
  y[0] = EquilibriumPressure(&m->kinetics.equilibrium, T, &none[0]);
}

static void RateConstant(const Material *m, double T, double y[MOST])
{
  y[0] = KineticsRateConstant(&m->kinetics, T, &none[0]);
}

static void Surface(const Material *m, double sw, double y[MOST])
{
  y[0] = KineticsFormationArea(&m->kinetics, sw, 0.0, 0.0).v;
  y[1] = KineticsFormationArea(&m->kinetics, sw, 0.0, 0.4).v;
}

static void Latent(const Material *m, double T, double y[MOST])
{
  y[0] = LatentHeatEvaluate(&m->latent, T, &none[0]);
}

static void GasRho(const Material *m, double p, double y[MOST])
{
  y[0] = GasDensity(&m->gas, p, 4.0, &none[0], &none[1]);
  y[1] = GasDensity(&m->gas, p, 20.0, &none[0], &none[1]);
}

static void WaterRho(const Material *m, double p, double y[MOST])
{
  y[0] = LiquidDensity(&m->water, p, 4.0, &none[0], &none[1]);
  y[1] = LiquidDensity(&m->water, p, 20.0, &none[0], &none[1]);
}

static void Viscosities(const Material *m, double T, double y[MOST])
{
  y[0] = WaterViscosity(&m->mu_w, T, &none[0]);
  y[1] = GasViscosity(&m->mu_g, GasDensity(&m->gas, 1e7, T, &none[0], &none[1]), T, &none[0], &none[1]);
}

static void Melting(const Material *m, double p, double y[MOST])
{
  y[0] = BrineMelting(m->salinity, p);
}

static void Young(const Material *m, double Sh, double y[MOST])
{
  y[0] = ElasticityYoung(&m->elasticity, Sh, &none[0]);
}

static void Conductivity(const Material *m, double sw, double y[MOST])
{
  const double kappa[4] = {m->kappa_s, m->kappa_h, m->kappa_w, m->kappa_g};

  y[0] = MixtureAverage(m->porosity, 0.0, sw, kappa, &none[0], &none[1], &none[2]);
  y[1] = MixtureAverage(m->porosity, 0.4, sw, kappa, &none[0], &none[1], &none[2]);
}

static void Softening(const Material *m, double eps, double y[MOST])
{
  Strength s;

  StrengthEvaluate(&m->plasticity, 0.4, eps, &s);
  y[0] = s.c;
  y[1] = s.phi * 180.0 / M_PI;
  y[2] = s.psi * 180.0 / M_PI;
}

static void Hardening(const Material *m, double Sh, double y[MOST])
{
  Strength s;

  StrengthEvaluate(&m->plasticity, Sh, 0.0, &s);
  y[0] = s.c;
  y[1] = s.psi * 180.0 / M_PI;
}

static const Curve curve[] = {
    {"retention", "p_c Pa, s_g -, s_w -", -2.0, 10.0, SCALE_P0, HAS_GAS, Retention_, 2},
    {"relative_permeability", "s_w -, k_rw -, k_rg -", 0.0, 1.0, SCALE_NONE, HAS_GAS, RelPerm_, 2},
    {"permeability_hydrate", "S_h -, k_a/k_0 -", 0.0, 0.99, SCALE_NONE, HAS_WATER, WithHydrate, 1},
    {"permeability_porosity", "porosity -, k_a/k_0 -", 0.05, 0.8, SCALE_NONE, HAS_WATER, WithPorosity, 1},
    {"equilibrium", "T degC, p_e Pa", -10.0, 25.0, SCALE_NONE, HAS_GAS, Equilibrium_, 1},
    {"rate_constant", "T degC, K_d mol/(m^2 Pa s)", 0.0, 25.0, SCALE_NONE, HAS_GAS, RateConstant, 1},
    {"formation_surface", "s_w -, A_s at S_h = 0 1/m, A_s at S_h = 0.4 1/m", 0.0, 1.0, SCALE_NONE, HAS_GAS, Surface, 2},
    {"latent_heat", "T degC, L J/kg", 0.0, 25.0, SCALE_NONE, HAS_HEAT, Latent, 1},
    {"gas_density", "p Pa, rho_g at 4 degC kg/m^3, rho_g at 20 degC kg/m^3", 1e5, 3e7, SCALE_NONE, HAS_GAS, GasRho, 2},
    {"water_density", "p Pa, rho_w at 4 degC kg/m^3, rho_w at 20 degC kg/m^3", 1e5, 3e7, SCALE_NONE, HAS_WATER,
     WaterRho, 2},
    {"viscosity", "T degC, mu_w Pa s, mu_g at 10 MPa Pa s", 0.0, 60.0, SCALE_NONE, HAS_WATER, Viscosities, 2},
    {"melting", "p Pa, T_m degC", 1e5, 3e7, SCALE_NONE, HAS_WATER, Melting, 1},
    {"conductivity", "s_w -, kappa at S_h = 0 W/(m K), kappa at S_h = 0.4 W/(m K)", 0.0, 1.0, SCALE_NONE, HAS_HEAT,
     Conductivity, 2},
    {"stiffness", "S_h -, E Pa", 0.0, 1.0, SCALE_NONE, HAS_SOLID, Young, 1},
    {"softening", "eps_d_p -, c at S_h = 0.4 Pa, phi deg, psi deg", 0.0, 1.0, SCALE_NONE, HAS_PLASTIC, Softening, 3},
    {"strength", "S_h -, c Pa, psi deg", 0.0, 0.6, SCALE_NONE, HAS_PLASTIC, Hardening, 2},
};

static void Print(FILE *out, const Material *m, const Curve *k)
{
  const double scale = k->scale == SCALE_P0 ? m->retention.p0 : 1.0;

  fprintf(out, "# %s of %s: %s\n", k->name, m->name, k->columns);
  for (int i = 0; i < ROWS; i++) {
    const double x = scale * (k->from + (k->to - k->from) * i / (ROWS - 1));
    double       y[MOST];

    k->evaluate(m, x, y);
    fprintf(out, "%.9g", x);
    for (int j = 0; j < k->n; j++)
      fprintf(out, ", %.9g", y[j]);
    fputc('\n', out);
  }
}

PetscErrorCode CasePrintCurves(const Scene *c, FILE *out)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < c->nmaterial; i++) {
    const Material *m   = &c->material[i];
    const unsigned  has = c->fields.has | (m->plasticity.type ? HAS_PLASTIC : 0u);

    for (size_t k = 0; k < sizeof(curve) / sizeof(*curve); k++) {
      if ((has & curve[k].has) == curve[k].has)
        Print(out, m, &curve[k]);
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
