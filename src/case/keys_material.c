/* keys_material: laws and constants of a material. */
#include "key_rows.h"

static bool NeedsM(const void *p)
{
  return !strncmp(((const Material *)p)->retention.type, "van_genuchten", 13);
}
static bool NeedsLambda(const void *p)
{
  return !strcmp(((const Material *)p)->retention.type, "brooks_corey");
}
static bool HasBeds(const void *p)
{
  return ((const Material *)p)->permeability.ratio < 1.0;
}
static bool NeedsPower(const void *p)
{
  return !strcmp(((const Material *)p)->permeability.hydrate_type, "power");
}
static bool NeedsRamp(const void *p)
{
  return !strcmp(((const Material *)p)->permeability.hydrate_type, "masuda_ramp");
}
static bool NeedsRate(const void *p)
{
  return ((const Material *)p)->reacts;
}
static bool NeedsStrength(const void *p)
{
  return ((const Material *)p)->plasticity.type == PLASTICITY_MOHR_COULOMB;
}
static bool StrengthGrows(const void *p)
{
  return NeedsStrength(p) && ((const Material *)p)->plasticity.gradient > 0.0;
}
static bool IsSmooth(const void *p)
{
  return !strcmp(((const Material *)p)->retention.type, "van_genuchten");
}
static bool IsSloan(const void *p)
{
  return NeedsRate(p) && !strcmp(((const Material *)p)->kinetics.equilibrium.type, "sloan");
}
static bool IsCubic(const void *p)
{
  return !strcmp(((const Material *)p)->gas.type, "peng_robinson");
}
static bool GasIsConstant(const void *p)
{
  return ((const Material *)p)->mu_g.law == GAS_VISCOSITY_CONSTANT;
}
static bool WaterIsConstant(const void *p)
{
  return ((const Material *)p)->mu_w.law == WATER_VISCOSITY_CONSTANT;
}
static bool IsKirchhoff(const void *p)
{
  return NeedsRate(p) && ((const Material *)p)->latent.kirchhoff;
}
static bool FlowIsSmooth(const void *p)
{
  return NeedsStrength(p) && ((const Material *)p)->plasticity.flow == FLOW_MENETREY_WILLAM;
}
static bool PorosityCounts(const void *p)
{
  return strcmp(((const Material *)p)->permeability.porosity_type, "none") != 0;
}

/* ---------------------------------------------------------------- laws by name */
#define LAW(Name, set_, types_, object, field)                                                                         \
  static bool Set##Name(Material *m, const char *type)                                                                 \
  {                                                                                                                    \
    return set_(&m->object, type);                                                                                     \
  }                                                                                                                    \
  static const char *Get##Name(const Material *m)                                                                      \
  {                                                                                                                    \
    return m->object.field;                                                                                            \
  }                                                                                                                    \
  static const Law law_##Name = {types_, Set##Name, Get##Name};
LAW(Retention, RetentionSetType, RetentionTypes, retention, type)
LAW(Hydrate, PermeabilitySetHydrateType, PermeabilityHydrateTypes, permeability, hydrate_type)
LAW(Porosity, PermeabilitySetPorosityType, PermeabilityPorosityTypes, permeability, porosity_type)
LAW(Gas, GasSetType, GasTypes, gas, type)
LAW(Equilibrium, EquilibriumSetType, EquilibriumTypes, kinetics.equilibrium, type)

static const char *const space_word[]           = {"fluids", "pores", NULL};
static const char *const stiffness_word[]       = {"both", "loss_only", "bonds", NULL};
static const char *const water_viscosity_word[] = {"constant", "kestin", NULL}; /* WATER_VISCOSITY_... */
static const char *const gas_viscosity_word[]   = {"constant", "lee", NULL};    /* GAS_VISCOSITY_... */
static const char *const latent_word[]          = {"linear", "kirchhoff", NULL};
static const char *const plasticity_word[]      = {"none", "mohr_coulomb", NULL};            /* PLASTICITY_... */
static const char *const flow_word[]            = {"menetrey_willam", "mohr_coulomb", NULL}; /* FLOW_... */

const Key material_key[] = {
    LIKE(Material, GROUP_MATERIAL, "another material, whose keys are the defaults"),
    REAL(Material, "porosity", porosity, "", "(0,1)", NULL, "initial porosity", BINDS(HAS_ALL)),
    REAL(Material, "solid_density", solid.rho0, "kg/m^3", "(0,1e5]", NULL, "of the grains", BINDS(HAS_ALL)),
    REAL(Material, "solid_heat_capacity", c_s, "J/(kg K)", "(0,1e6]", NULL, "", .has = HAS_HEAT),
    REAL(Material, "solid_conductivity", kappa_s, "W/(m K)", "[0,1e4]", NULL, "thermal conductivity", .has = HAS_HEAT),
    REAL(Material, "solid_expansion", solid.beta, "1/K", "[-0.1,0.1]", "0 1/K", "volumetric thermal expansion",
         BINDS(HAS_ALL)),
    REAL(Material, "hydrate_density", hydrate.rho0, "kg/m^3", "(0,1e5]", "900 kg/m^3", "", .has = HAS_HYDRATE,
         BINDS(HAS_ALL)),
    REAL(Material, "hydrate_heat_capacity", c_h, "J/(kg K)", "(0,1e6]", "2010 J/(kg K)", "", .has = HAS_HYDRATE,
         .also = HAS_HEAT),
    REAL(Material, "hydrate_conductivity", kappa_h, "W/(m K)", "[0,1e4]", "0.5 W/(m K)", "thermal conductivity",
         .has = HAS_HYDRATE, .also = HAS_HEAT),
    REAL(Material, "hydrate_expansion", hydrate.beta, "1/K", "[-0.1,0.1]", "0 1/K", "volumetric thermal expansion",
         .has = HAS_HYDRATE, BINDS(HAS_ALL)),
    REAL(Material, "hydrate_molar_mass", kinetics.M_h, "kg/mol", "(0,10]", "0.124 kg/mol", "must be M_g + N_h M_w",
         .has = HAS_HYDRATE, BINDS(HAS_ALL)),
    REAL(Material, "hydrate_number", kinetics.N_h, "", "(0,100]", "6", "hydration number N_h: water per gas",
         .has = HAS_HYDRATE, BINDS(HAS_ALL)),
    REAL(Material, "water_density", fresh, "kg/m^3", "(0,1e5]", "1000 kg/m^3",
         "of fresh water, at ref_pressure and ref_temperature", .has = HAS_WATER, BINDS(HAS_WATER)),
    REAL(Material, "water_salinity", salinity, "", "[0,0.16]", "0", "kg of salt per kg of pore water, a constant",
         .has = HAS_WATER, BINDS(HAS_WATER)),
    REAL(Material, "water_bulk_modulus", water.K, "Pa", "(0,inf)", "2.2 GPa", "or the word incompressible",
         .word = "incompressible", .has = HAS_WATER, BINDS(HAS_WATER)),
    REAL(Material, "water_viscosity", mu_w.mu, "Pa s", "(0,1e6]", "1e-3 Pa s", "of the law constant", .has = HAS_WATER,
         ACTS(WaterIsConstant, "viscosity_law is constant")),
    CHOICE(Material, "water_viscosity_law", mu_w.law, "constant", water_viscosity_word,
           "kestin falls with temperature, grows with salinity", .has = HAS_WATER),
    REAL(Material, "water_heat_capacity", c_w, "J/(kg K)", "(0,1e6]", "4200 J/(kg K)", "", .has = HAS_WATER,
         .also = HAS_HEAT),
    REAL(Material, "water_conductivity", kappa_w, "W/(m K)", "[0,1e4]", "0.5 W/(m K)", "thermal conductivity",
         .has = HAS_WATER, .also = HAS_HEAT),
    REAL(Material, "water_expansion", water.beta, "1/K", "[-0.1,0.1]", "0 1/K", "volumetric thermal expansion",
         .has = HAS_WATER, BINDS(HAS_WATER)),
    REAL(Material, "water_ref_pressure", water.p_ref, "Pa", "[0,1e10]", "101325 Pa", "of the densities",
         BINDS(HAS_ALL)),
    REAL(Material, "water_ref_temperature", water.T_ref, "degC", "(-273.15,1000]", "20 degC",
         "of the densities, grains and hydrate too", BINDS(HAS_ALL)),
    REAL(Material, "water_molar_mass", kinetics.M_w, "kg/mol", "(0,10]", "0.018 kg/mol", "",
         .has = HAS_WATER | HAS_HYDRATE, BINDS(HAS_ALL)),
    REAL(Material, "gas_molar_mass", gas.M, "kg/mol", "(0,10]", "0.016 kg/mol", "methane by default",
         .has = HAS_GAS | HAS_HYDRATE, BINDS(HAS_ALL)),
    REAL(Material, "gas_solubility", gas.henry, "mol/(m^3 Pa)", "[0,1]", "auto",
         "Henry's; auto: methane's at 10 degC, 1.9e-5, where sediment may be free of gas (without_gas), else 0",
         .word = "auto", .has = HAS_GAS, BINDS(HAS_GAS)),
    LAWKEY("gas_eos", "peng_robinson", law_Gas, "density; ideal is M p/(R T), the paper's", BINDS(HAS_GAS)),
    REAL(Material, "gas_critical_temperature", gas.Tc, "K", "(0,1e4]", "190.564 K", "peng_robinson; methane by default",
         .has = HAS_GAS, ACTS(IsCubic, "eos is peng_robinson"), BINDS(HAS_GAS)),
    REAL(Material, "gas_critical_pressure", gas.pc, "Pa", "(0,1e9]", "4.5992 MPa", "peng_robinson", .has = HAS_GAS,
         ACTS(IsCubic, "eos is peng_robinson"), BINDS(HAS_GAS)),
    REAL(Material, "gas_acentric_factor", gas.eccentric, "", "(-1,2]", "0.01142", "peng_robinson", .has = HAS_GAS,
         ACTS(IsCubic, "eos is peng_robinson"), BINDS(HAS_GAS)),
    REAL(Material, "gas_viscosity", mu_g.mu, "Pa s", "(0,1e6]", "7e-6 Pa s", "of the law constant", .has = HAS_GAS,
         ACTS(GasIsConstant, "viscosity_law is constant")),
    CHOICE(Material, "gas_viscosity_law", mu_g.law, "constant", gas_viscosity_word,
           "lee grows with temperature and density", .has = HAS_GAS),
    REAL(Material, "gas_heat_capacity", c_g, "J/(kg K)", "(0,1e6]", "2100 J/(kg K)", "", .has = HAS_GAS,
         .also = HAS_HEAT),
    REAL(Material, "gas_conductivity", kappa_g, "W/(m K)", "[0,1e4]", "0.044 W/(m K)", "thermal conductivity",
         .has = HAS_GAS, .also = HAS_HEAT),
    LAWKEY("retention_law", "van_genuchten", law_Retention, "van_genuchten is the smooth form with trapped gas",
           BINDS(HAS_GAS)),
    REAL(Material, "retention_p0", retention.p0, "Pa", "(0,1e10]", NULL, "air-entry (reference) pressure",
         .has = HAS_GAS, BINDS(HAS_GAS)),
    REAL(Material, "retention_m", retention.m, "", "(0,1)", "0.5", "van Genuchten's m",
         OFLAW(NeedsM, "law is van_genuchten..."), .has = HAS_GAS, BINDS(HAS_GAS)),
    REAL(Material, "retention_lambda", retention.lambda, "", "(0,100]", "1", "Brooks-Corey pore-size index",
         OFLAW(NeedsLambda, "law is brooks_corey"), .has = HAS_GAS, BINDS(HAS_GAS)),
    REAL(Material, "retention_Swr", retention.Swr, "", "[0,1)", NULL, "residual water saturation", .has = HAS_GAS,
         BINDS(HAS_GAS)),
    REAL(Material, "retention_Sgr", retention.Sgr, "", "[0,1)", NULL, "residual gas saturation", .has = HAS_GAS,
         BINDS(HAS_GAS)),
    REAL(Material, "retention_p_smooth", retention.p_smooth, "Pa", "(0,1e10]", "0.05 @retention_p0",
         "smoothing width of the smooth form", .has = HAS_GAS, ACTS(IsSmooth, "law is van_genuchten"), BINDS(HAS_GAS)),
    REAL(Material, "retention_p_trap", retention.p_trap, "Pa", "(0,1e10]", "auto",
         "pressure scale of trapped gas, smooth form; auto: retention_p0, at most 50 kPa where a region has Sg: 0",
         .word = "auto", .has = HAS_GAS, ACTS(IsSmooth, "law is van_genuchten"), BINDS(HAS_GAS)),
    REAL(Material, "retention_hydrate_exponent", retention.hydrate, "", "[0,20]", "0",
         "n of p_c = p_c(s_g)/(1 - Sh)^n (320); (mh - 1)/2 by Leverett's scaling", .has = HAS_GAS, BINDS(HAS_GAS)),
    REAL(Material, "relperm_Swr", relperm.Swr, "", "[0,1)", "1 @retention_Swr", "residual water saturation of k_rw",
         .has = HAS_GAS),
    REAL(Material, "relperm_Sgr", relperm.Sgr, "", "[0,1)", "1 @retention_Sgr", "residual gas saturation of k_rg",
         .has = HAS_GAS),
    BOOLEAN(Material, "relperm_share_of", relperm.of_pores, "fluids",
            "k_r from the share of fluid-filled pores, S/(1 - Sh), or of all pores", .choices = space_word,
            .has = HAS_GAS),
    REAL(Material, "relperm_nw", relperm.nw, "", "(0,20]", NULL, "Corey exponent of water", .has = HAS_GAS),
    REAL(Material, "relperm_ng", relperm.ng, "", "(0,20]", NULL, "Corey exponent of gas", .has = HAS_GAS),
    REAL(Material, "permeability_k0", permeability.k0, "m^2", "(0,1e-4]", NULL,
         "intrinsic, at phi0 and without hydrate", .has = HAS_WATER),
    REAL(Material, "permeability_phi0", permeability.phi0, "", "(0,1)", "1 @porosity", "reference porosity",
         .has = HAS_WATER, ACTS(PorosityCounts, "porosity_law is not none")),
    LAWKEY("permeability_porosity_law", "kozeny_carman", law_Porosity, ""),
    LAWKEY("permeability_hydrate_law", "power", law_Hydrate, "power is (1-S_h)^mh"),
    REAL(Material, "permeability_mh", permeability.mh, "", "[0,100]", "0", "exponent of 1-S_h",
         OFLAW(NeedsPower, "hydrate_law is power"), .has = HAS_WATER, .also = HAS_HYDRATE),
    REAL(Material, "permeability_kh", permeability.kh, "", "(0,1]", "1", "plateau",
         OFLAW(NeedsRamp, "hydrate_law is masuda_ramp"), .has = HAS_WATER, .also = HAS_HYDRATE),
    REAL(Material, "permeability_Shc", permeability.Shc, "", "(0,1]", "1", "threshold",
         OFLAW(NeedsRamp, "hydrate_law is masuda_ramp"), .has = HAS_WATER, .also = HAS_HYDRATE),
    REAL(Material, "permeability_ratio", permeability.ratio, "", "(0,1]", "1",
         "k across bedding planes over k_a along them (306)", .has = HAS_WATER),
    REAL(Material, "permeability_dip", permeability.dip, "deg", "[-90,90]", "0 deg",
         "of bedding planes at the start, from x towards y", .has = HAS_WATER,
         ACTS(HasBeds, "permeability_ratio is below 1")),
    BOOLEAN(Material, "kinetics_active", reacts, "no", "hydrate forms and dissociates", BINDS(HAS_ALL)),
    REAL(Material, "kinetics_K0", kinetics.K0, "mol/(m^2 Pa s)", "[0,inf)", "0 mol/(m^2 Pa s)",
         "K_d = K0 exp(-dE/(R T))", OFLAW(NeedsRate, "active")),
    REAL(Material, "kinetics_dE", kinetics.dE, "J/mol", "[0,1e7]", "0 J/mol", "activation energy; 0 = constant K_d",
         ACTS(NeedsRate, "kinetics are active")),
    REAL(Material, "kinetics_A_geo", kinetics.A_geo, "1/m", "[0,inf)", "0 1/m", "hydrate surface per volume",
         OFLAW(NeedsRate, "active")),
    LAWKEY("kinetics_equilibrium", "sloan", law_Equilibrium,
           "sloan is p_e = A1 exp(A2 - A3/T); the others are methane's"),
    REAL(Material, "kinetics_A1", kinetics.equilibrium.A1, "Pa", "(0,1e10]", "1 kPa", "",
         ACTS(IsSloan, "kinetics are active and equilibrium is sloan")),
    REAL(Material, "kinetics_A2", kinetics.equilibrium.A2, "", "[-1000,1000]", "38.98", "",
         ACTS(IsSloan, "kinetics are active and equilibrium is sloan")),
    REAL(Material, "kinetics_A3", kinetics.equilibrium.A3, "K", "[0,1e6]", "8533.8 K", "",
         ACTS(IsSloan, "kinetics are active and equilibrium is sloan")),
    REAL(Material, "latent_heat_C0", latent.C0, "J/kg", "[0,1e8]", "473632 J/kg",
         "heat of dissociation C0 - C1 T (T in kelvin)", .has = HAS_HEAT, ACTS(NeedsRate, "kinetics are active")),
    REAL(Material, "latent_heat_C1", latent.C1, "J/(kg K)", "[-1e5,1e5]", "140.117 J/(kg K)", "", .has = HAS_HEAT,
         ACTS(NeedsRate, "kinetics are active")),
    BOOLEAN(Material, "latent_heat_law", latent.kirchhoff, "linear",
            "C0 - C1 T, or from T_ref on by the heat capacities (130)", .choices = latent_word, .has = HAS_HEAT,
            ACTS(NeedsRate, "kinetics are active")),
    REAL(Material, "latent_heat_T_ref", latent.T_ref, "degC", "(-273.15,1000]", "0 degC", "kirchhoff", .has = HAS_HEAT,
         ACTS(IsKirchhoff, "kinetics are active and law is kirchhoff")),
    REAL(Material, "elasticity_E0", elasticity.E0, "Pa", "(0,1e15]", NULL,
         "Young's modulus without hydrate, or the word rigid", .word = "rigid", .has = HAS_SOLID, .felt = true),
    REAL(Material, "elasticity_Eh", elasticity.Eh, "Pa", "[0,1e15]", "0 Pa", "E = E0 + ah Eh S_h^bh", .has = HAS_SOLID,
         .also = HAS_HYDRATE),
    REAL(Material, "elasticity_ah", elasticity.ah, "", "[0,100]", "1", "", .has = HAS_SOLID, .also = HAS_HYDRATE),
    REAL(Material, "elasticity_bh", elasticity.bh, "", "(0,20]", "1", "", .has = HAS_SOLID, .also = HAS_HYDRATE),
    REAL(Material, "elasticity_nu", elasticity.nu, "", "[0,0.5)", NULL, "Poisson's ratio", .has = HAS_SOLID),
    CHOICE(Material, "elasticity_stiffness_change", elasticity.change, "bonds", stiffness_word,
           "stress follows E(S_h), only its loss, or hydrate bears a stress of its own (93)", .has = HAS_SOLID,
           .also = HAS_HYDRATE),
    CHOICE(Material, "plasticity_law", plasticity.type, "none", plasticity_word, "strength of the skeleton",
           .has = HAS_SOLID, .history = true),
    CHOICE(Material, "plasticity_flow", plasticity.flow, "menetrey_willam", flow_word,
           "potential: smooth, or the planes of the dilation angle", .has = HAS_SOLID,
           ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_cohesion_max", plasticity.c_max, "Pa", "[0,1e12]", "0 Pa",
         "peak cohesion at Sh_max (61)", OFLAW(NeedsStrength, "law is mohr_coulomb"), .has = HAS_SOLID),
    REAL(Material, "plasticity_cohesion_min", plasticity.c_min, "Pa", "[0,1e12]", "1 @plasticity_cohesion_max",
         "lower limit for little hydrate", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_cohesion_residual", plasticity.c_res, "Pa", "[0,1e12]", "1 @plasticity_cohesion_min",
         "residual cohesion (62)", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_cohesion_gradient", plasticity.gradient, "Pa/m", "[0,1e9]", "0 Pa/m",
         "growth of cohesion_max with depth at the start, cohesion_min and cohesion_residual in proportion (455)",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_cohesion_level", plasticity.level, "m", "", "0 m",
         "level at and above which cohesion is as given",
         OFLAW(StrengthGrows, "law is mohr_coulomb and cohesion_gradient is above 0 Pa/m"), .has = HAS_SOLID),
    REAL(Material, "plasticity_friction_peak", plasticity.phi_peak, "deg", "[0,90)", "0 deg", "friction angle",
         OFLAW(NeedsStrength, "law is mohr_coulomb"), .has = HAS_SOLID),
    REAL(Material, "plasticity_friction_residual", plasticity.phi_res, "deg", "[0,90)", "1 @plasticity_friction_peak",
         "residual friction angle", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_dilation_max", plasticity.psi_max, "deg", "[0,90)", "0 deg",
         "dilation angle at Sh_max; its residual is zero", .has = HAS_SOLID,
         ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_dilation_min", plasticity.psi_min, "deg", "[0,90)", "1 @plasticity_dilation_max",
         "lower limit for little hydrate", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_eta_h", plasticity.eta_h, "", "[0,1e3]", "0", "how fast strength grows with hydrate",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_Sh_max", plasticity.Sh_max, "", "[0,1]", "1", "hydrate saturation of the ..._max",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_eta_s", plasticity.eta_s, "", "[0,1e6]", "0",
         "how fast strength falls with deviatoric plastic strain; 0 = never", .has = HAS_SOLID,
         ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_softening_length", plasticity.length, "m", "[0,1e6]", "0 m",
         "width of a shear band that eta_s is meant for: eta_s is scaled by cell size over it; 0 m = not scaled",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_nonlocal_length", plasticity.nonlocal, "m", "[0,1e6]", "0 m",
         "l of plastic strain averaged over neighbours (85), at least two cells; 0 m = the particle's own",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_eccentricity", plasticity.eccentricity, "", "(0,10]", "0.1",
         "roundness of the smooth potential's apex, over cohesion_max (64)", .has = HAS_SOLID,
         ACTS(FlowIsSmooth, "law is mohr_coulomb and flow menetrey_willam")),
    REAL(Material, "plasticity_tension_cutoff", plasticity.cutoff, "Pa", "[0,1e12]", "none",
         "largest tension, flow mohr_coulomb only; or the word none", .word = "none", .has = HAS_SOLID),
    REAL(Material, "plasticity_heat", plasticity.heat, "", "[0,1]", "0", "share of the plastic work that becomes heat",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    {.name = NULL},
};
