/* keys: the declared key table.  A row says everything about a key: reading, range, default, resolved case, printed
   list and typo search follow from it. */
#include "case_private.h"
#include <stddef.h>
#include <string.h>

/* ---------------------------------------------------------------- conditions */
static bool HasSpacingX(const void *p)
{
  return ((const Case *)p)->scene.spacing[0][0];
}
static bool HasSpacingY(const void *p)
{
  return ((const Case *)p)->scene.spacing[1][0];
}
static bool HasTableX(const void *p)
{
  return ((const Case *)p)->scene.table[0][0];
}
static bool HasTableY(const void *p)
{
  return ((const Case *)p)->scene.table[1][0];
}
static bool HasEqualAxis(const void *p)
{
  return !(HasSpacingX(p) || HasTableX(p)) || !(HasSpacingY(p) || HasTableY(p));
}
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
static bool IsHydrostatic(const void *p)
{
  return ((const Region *)p)->hydrostatic;
}
static bool IsGeothermal(const void *p)
{
  return ((const Region *)p)->geothermal != 0.0;
}
static bool NeedsPressure(const void *p)
{
  const Bc *b = (const Bc *)p;

  return !b->initial && !b->phase[PHASE_W].n && !b->phase[PHASE_G].n;
}
static bool NeedsVelocity(const void *p)
{
  const Bc *b = (const Bc *)p;

  return b->type == BC_PLATE_LINE || (!b->displacement.n && !b->force.n);
}
static bool NeedsEnd(const void *p)
{
  return ((const Case *)p)->nstage == 0;
}
static bool NeedsTemperature(const void *p)
{
  return ((const Bc *)p)->type != BC_INFLOW;
}

static bool NeedsBox(const void *p)
{
  const Region *r = (const Region *)p;

  return !r->polygon.n && !r->below.n && isinf(r->circle[2]);
}
static bool BcNeedsSide(const void *p)
{
  return !((const Bc *)p)->along.n;
}
static bool NeedsPlace(const void *p)
{
  const Probe *b = (const Probe *)p;

  return b->over < 0 && b->surface.side == SIDE_COUNT && !b->surface.along.n;
}
static bool MeterNeedsSide(const void *p)
{
  return !((const Meter *)p)->along.n;
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

/* ---------------------------------------------------------------- words */
static const char *const basis_word[]           = {"cpgimp", "ugimp", "linear", NULL}; /* BasisType */
static const char *const pressures_word[]       = {"two", "one", NULL};
static const char *const geometry_word[]        = {"plane", "axisymmetric", NULL};
static const char *const stepper_word[]         = {"sdirk2", "euler", "hybrid", "explicit", "auto", NULL};
static const char *const surface_word[]         = {"free", "tied", "velocities_free", NULL};        /* SURFACE_... */
static const char *const share_word[]           = {"nodes", "particles", "relative", NULL};         /* PRESSURES_... */
static const char *const side_word[]            = {"left", "right", "bottom", "top", "none", NULL}; /* Side */
static const char *const axis_word[]            = {"x", "y", NULL};
static const char *const space_word[]           = {"fluids", "pores", NULL};
static const char *const stiffness_word[]       = {"both", "loss_only", "bonds", NULL};
static const char *const water_viscosity_word[] = {"constant", "kestin", NULL}; /* WATER_VISCOSITY_... */
static const char *const gas_viscosity_word[]   = {"constant", "lee", NULL};    /* GAS_VISCOSITY_... */
static const char *const latent_word[]          = {"linear", "kirchhoff", NULL};
static const char *const ice_word[]             = {"warn", "stop", NULL};                    /* ICE_... */
static const char *const without_gas_word[]     = {"auto", "yes", "no", NULL};               /* WITHOUT_GAS_... */
static const char *const plasticity_word[]      = {"none", "mohr_coulomb", NULL};            /* PLASTICITY_... */
static const char *const flow_word[]            = {"menetrey_willam", "mohr_coulomb", NULL}; /* FLOW_... */
static const char *const capillary_word[]       = {"held", "free", NULL};
static const char *const holds_word[]           = {"all", "skeleton", NULL};
static const char *const clock_word[]           = {"run", "stage", NULL};
static const char *const phases_word[]          = {"both", "water", "gas", NULL}; /* OpenPhases */
#define BC_WORD(kind, word, ...) word,
const char *const case_bc_type[] = {CL_FACE_CONDITIONS(BC_WORD) CL_NODE_CONDITIONS(BC_WORD) NULL,
                                    CL_NODE_FORMS(BC_WORD)};
#undef BC_WORD

/* ---------------------------------------------------------------- the table */
/* Rows: name, member, [unit, range,] default, meaning, then whatever is special about the key. */
#define ROW(T, name_, kind_, member_, count_, unit_, range_, def_, doc_, ...)                                          \
  {                                                                                                                    \
    .name = name_, .kind = kind_, .offset = offsetof(T, member_), .count = count_, .unit = unit_, .range = range_,     \
    .def = def_, .doc = doc_, ##__VA_ARGS__                                                                            \
  }
#define REALS(T, n, name, member, unit, range, def, doc, ...)                                                          \
  ROW(T, name, KEY_REAL, member, n, unit, range, def, doc, ##__VA_ARGS__)
#define REAL(T, name, member, unit, range, def, doc, ...)                                                              \
  ROW(T, name, KEY_REAL, member, 1, unit, range, def, doc, ##__VA_ARGS__)
#define INTEGERS(T, n, name, member, range, def, doc, ...)                                                             \
  ROW(T, name, KEY_INT, member, n, "", range, def, doc, ##__VA_ARGS__)
#define BOOLEAN(T, name, member, def, doc, ...) ROW(T, name, KEY_BOOL, member, 1, "", "", def, doc, ##__VA_ARGS__)
#define TEXT(T, name, member, def, doc, ...)                                                                           \
  ROW(T, name, KEY_TEXT, member, sizeof(((T *)0)->member), "", "", def, doc, ##__VA_ARGS__)
#define CHOICE(T, name, member, def, words, doc, ...)                                                                  \
  ROW(T, name, KEY_CHOICE, member, 1, "", "", def, doc, .choices = words, ##__VA_ARGS__)
#define NAME(T, name, member, def, group, doc, ...)                                                                    \
  ROW(T, name, KEY_NAME, member, 1, "", "", def, doc, .names = group, ##__VA_ARGS__)
/* read by CaseLike; the member is not used */
#define LIKE(T, group, doc)                                                                                            \
  ROW(T, "like", KEY_NAME, name, 1, "", "", "none", doc, .names = group, .word = "none", .shape = true, .own = true,   \
      .like = true)
#define NAMES(T, name, member, group, doc, ...)                                                                        \
  ROW(T, name, KEY_NAMES, member, 0, "", "", "", doc, .names = group, ##__VA_ARGS__)
#define POINTS(T, name, member, doc, ...) ROW(T, name, KEY_POINTS, member, 0, "m", "", "", doc, ##__VA_ARGS__)
/* a law is set by its function; the member is not used */
#define LAWKEY(name, def, law_, doc, ...)                                                                              \
  ROW(Material, name, KEY_LAW, porosity, 1, "", "", def, doc, .law = &law_, ##__VA_ARGS__)
#define SCHEDULE(name, member, unit, range, def, types_, doc, ...)                                                     \
  ROW(Bc, name, KEY_SCHEDULE, member, 1, unit, range, def, doc, .types = types_, ##__VA_ARGS__)
#define WHEN(condition, words) .needed = condition, .when = words
/* does nothing otherwise; is required besides */
#define ACTS(condition, words) .acts = condition, .idle = words
/* what particles hold means something else with another value, where there are any of these fields */
#define BINDS(fields) .binds = fields
#define OFLAW(condition, words) WHEN(condition, words), ACTS(condition, words)

static const Key case_key[] = {
    TEXT(Case, "title", title, "", "one line"),
    REALS(Case, 2, "grid_lower", scene.lower, "m", "", NULL, "lower left corner of the background grid",
          BINDS(HAS_ALL)),
    REALS(Case, 2, "grid_upper", scene.upper, "m", "", NULL, "upper right corner; the body must not leave the grid",
          BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_x", scene.spacing[0], "",
         "sizes of the cells along x: one size (0.5 m), or first size, largest size and growth from cell to cell, "
         "from the lower end on ([0.05 m, 2 m, growth 1.15])",
         ACTS(HasSpacingX, "it is given"), BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_x_table", scene.table[0], "",
         "the same by places, which are lines of the grid, and sizes there, from the lower end to the upper "
         "({table: [0 m, 0.5 m, 4 m, 0.05 m, 10 m, 1 m]})",
         ACTS(HasTableX, "it is given"), BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_y", scene.spacing[1], "", "likewise along y", ACTS(HasSpacingY, "it is given"),
         BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_y_table", scene.table[1], "", "likewise along y", ACTS(HasTableY, "it is given"),
         BINDS(HAS_ALL)),
    INTEGERS(Case, 2, "grid_cells", scene.cells, "[1,100000]", "auto, auto",
             "cells along x and y; auto: as many as the spacing of that axis makes",
             WHEN(HasEqualAxis, "an axis has no spacing"), .word = "auto", BINDS(HAS_ALL)),
    BOOLEAN(Case, "geometry", scene.axisymmetric, "plane", "axisymmetric: x is the radius, y runs along the axis",
            .choices = geometry_word, BINDS(HAS_ALL)),
    TEXT(Case, "fields", fields_wanted, "auto",
         "what the scene needs: a list of solid, water, gas, heat, or a set's name (thmc, thc, hmc, thm, hm, m, ...); "
         "auto drops what is identically zero",
         BINDS(HAS_ALL)),
    BOOLEAN(Case, "inertia", scene.inertia, "yes", "accelerations; no is quasi-static"),
    BOOLEAN(Case, "pressures", scene.one_pressure, "two",
            "one: p_g = p_w, saturations follow explicitly from the masses", .choices = pressures_word, BINDS(HAS_ALL)),
    BOOLEAN(Case, "compression_heat", scene.compression_heat, "no",
            "fluids warm as they are compressed and cool or warm as they are throttled (Joule-Thomson)"),
    CHOICE(Case, "basis", scene.basis, "cpgimp", basis_word, "basis functions"),
    BOOLEAN(
        Case, "mean_dilatation", scene.mean_dilatation, "no",
        "particles take the mean volume change of their cell, so that a skeleton that flows without one, or dilates, "
        "does not lock"),
    REAL(Case, "mean_strain", scene.mean_strain, "", "[0,1]", "0",
         "share of the mean motion of its cell in the strain of a particle: a skeleton that yields flows more freely; "
         "1 leaves modes without stiffness, 0.95 does for collapse loads"),
    REALS(Case, 2, "gravity", scene.gravity, "m/s^2", "[-1e4,1e4]", "0 m/s^2, 0 m/s^2", "e.g. [0 m/s^2, -9.81 m/s^2]"),
    REAL(Case, "gravity_ramp", scene.gravity_ramp, "s", "[0,inf)", "0 s",
         "gravity grows from zero to its value over this time"),
    REAL(
        Case, "strength_factor", scene.strength_factor, "", "(0,1e3]", "1",
        "cohesion, tension cut-off and the tangents of friction and dilation angle of all materials are divided by it: "
        "the "
        "largest one that a slope bears is its factor of safety"),
    ROW(Case, "ambient_pressure", KEY_SCHEDULE, scene.ambient_pressure, 1, "Pa", "[0,1e10]", "0 Pa",
        "of the fluid that the scene stands in: acts on the whole surface of the body; at and above ambient_level"),
    REAL(Case, "ambient_density", scene.ambient_density, "kg/m^3", "[0,1e5]", "0 kg/m^3",
         "of that fluid: below ambient_level its pressure grows with depth"),
    REAL(Case, "ambient_drag", scene.ambient_drag, "", "[0,100]", "0",
         "coefficient of the drag of that fluid, at rest, on faces that move into it", .has = HAS_SOLID),
    ROW(Case, "ambient_level", KEY_SCHEDULE, scene.ambient_level, 1, "m", "", "0 m", "coordinate against gravity"),
    CHOICE(Case, "without_gas", scene.without_gas, "auto", without_gas_word,
           "sediment may be or become free of gas: water then holds 1e-7 of what gas would; auto: where a region has "
           "Sg: 0"),
    CHOICE(Case, "ice", ice, "warn", ice_word,
           "when pore water is colder than its melting point, of which no equation knows: say so and go on, or end the "
           "run"),
    REAL(Case, "time_end", t_end, "s", "(0,inf)", "end of the last stage", "the run starts at 0 and ends here",
         WHEN(NeedsEnd, "there are no stages"), .kept = true),
    TEXT(Case, "stepper_type", stepper, "sdirk2",
         "time integrator; auto: the cheaper of sdirk2 and hybrid, at any time", .choices = stepper_word),
    BOOLEAN(Case, "stepper_adapt", adaptive, "yes", "choose the step by the error estimate"),
    REAL(Case, "stepper_dt", dt, "s", "(0,inf)", "1e-3 @time_end", "first step (adaptive) or fixed step",
         .plain = true),
    REAL(Case, "stepper_dt_min", dt_min, "s", "(0,inf)", "1e-9 @time_end", "a smaller step ends the run",
         .plain = true),
    REAL(Case, "stepper_dt_max", dt_max, "s", "(0,inf)", "1 @time_end", "longest step", .plain = true),
    REAL(Case, "stepper_tol", tol, "", "(0,1)", "1e-3", "relative tolerance of the error estimate"),
    REAL(Case, "stepper_error_exponent", error_exponent, "", "[1,16]", "2",
         "of the mean of the error over the particles: 2 is the root mean square, in which a front in a small part of "
         "the "
         "body drowns; 8 sees it"),
    INTEGERS(Case, 1, "stepper_max_failures", max_failures, "[1,1000]", "20",
             "cuts in a row before the run is given up"),
    REAL(Case, "stepper_cfl", cfl, "", "(0,1]", "0.8", "hybrid, explicit: step as a share of the stable one"),
    BOOLEAN(Case, "stepper_force_dt", force_dt, "no",
            "hybrid, explicit: take a fixed step above the stable one all the same"),
    REAL(Case, "stepper_flip", flip, "", "[0,1]", "1",
         "hybrid, explicit: particles take increments of nodal velocity (1, FLIP), the velocity itself (0, PIC), or a "
         "mixture"),
    REAL(Case, "stepper_relaxation", relaxation, "s", "(0,inf]", "none",
         "hybrid, explicit: time over which pressures and temperature of a particle tend to those of the nodes, which "
         "do not see what differs within a cell; or the word none",
         .word = "none"),
    REAL(
        Case, "stepper_damping", damping, "", "[0,1)", "0",
        "hybrid, explicit: share of the mixture's out-of-balance force taken away against its motion, for quasi-static "
        "ends"),
    REAL(Case, "stepper_mass_scaling", mass_scaling, "", "[1,1e12]", "1",
         "hybrid, explicit: factor on all inertia; the error it makes is reported"),
    CHOICE(
        Case, "stepper_surface", surface, "tied", surface_word,
        "hybrid, explicit: nearly empty nodes follow their fullest neighbour in part; velocities_free, for slides: in "
        "pressures and temperature alone, which leaves the balance of energy as it is"),
    CHOICE(
        Case, "stepper_pressures", pressures, "nodes", share_word,
        "hybrid, explicit: changes of pressure shared over nodes; likewise, but those of p_g in proportion to the p_g "
        "that each particle has (relative), for gas in what tears; or by each particle alone (particles: the paper's "
        "form, which rings)"),
    REAL(Case, "stabilisation_ghost_penalty", scene.stabilisation.ghost_penalty, "", "[0,100]", "0.1",
         "at free surfaces; 0 = off"),
    REAL(Case, "stabilisation_ghost_storage", scene.stabilisation.ghost_storage, "", "[0,100]", "0",
         "the same on pressures' changes, for undrained bodies; 0 = off"),
    REAL(Case, "stabilisation_pressure_projection", scene.stabilisation.pressure_projection, "", "[0,100]", "1",
         "undrained limit; 0 = off"),
    BOOLEAN(Case, "stabilisation_flux_interpolation", scene.stabilisation.flux_interpolation, "yes",
            "momentum-interpolated mass flux"),
    BOOLEAN(Case, "stabilisation_upstream", scene.stabilisation.upstream, "no",
            "relative permeabilities from upstream, for sharp fronts of saturation"),
    BOOLEAN(Case, "stabilisation_saturation", scene.stabilisation.saturation_upwind, "no",
            "carries saturations with the flow: no alternating cells where capillary pressure is weak"),
    BOOLEAN(
        Case, "stabilisation_heat", scene.stabilisation.heat_upwind, "no",
        "carries heat with the flow: temperatures stay within their bounds where a cell's heat is carried rather than "
        "conducted"),
    BOOLEAN(Case, "stabilisation_reaction", scene.stabilisation.lumped_reaction, "no",
            "each node pays for the share of a particle's reaction that it drives: no alternating hydrate ahead of a "
            "front of heat"),
    TEXT(Case, "output_dir", output_dir, "results/<case name>", "output folder"),
    ROW(Case, "output_times", KEY_REALS, times, 0, "s", "[0,inf)", "", "field snapshots at these times, hit exactly"),
    REAL(Case, "output_every", every, "s", "[0,inf)", "0 s", "... and every so long; 0 s = off"),
    TEXT(Case, "output_quantities", quantities_wanted, "all",
         "what probes write: a list of p, p_w, p_g, T, S_h, S_w, S_g, u, stress, x, eps_d_p, p_eff, q, strain, yield; "
         "all is what the "
         "scene has fields "
         "for"),
    REAL(Case, "output_probe_every", probe_every, "s", "[0,inf)", "0 s", "probe rows, hit exactly; 0 s = every step"),
    REAL(Case, "standard_pressure", standard_pressure, "Pa", "(0,1e9]", "101.4 kPa",
         "of standard volumes of gas; a note, not used"),
    REAL(Case, "standard_temperature", standard_temperature, "degC", "(-273.15,1000]", "15.56 degC",
         "of standard volumes of gas; a note, not used"),
    REAL(Case, "standard_gas_density", standard_gas_density, "kg/m^3", "(0,1e3]", "0.6789 kg/m^3",
         "of gas at standard_pressure and standard_temperature: what standard volumes are computed with"),
    REAL(Case, "checkpoint_every", checkpoint_every, "s", "[0,inf)", "0 s", "0 s = only at the end and on failure",
         .plain = true),
    {.name = NULL},
};

static const Key material_key[] = {
    LIKE(Material, GROUP_MATERIAL, "another of materials, whose keys hold where this one's are not given"),
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
    REAL(Material, "water_salinity", salinity, "", "[0,0.16]", "0",
         "kg of salt per kg of pore water, a given constant: raises its density, lowers the temperatures of "
         "equilibrium and of melting",
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
    REAL(Material, "retention_p_trap", retention.p_trap, "Pa", "(0,1e10]", "1 @retention_p0",
         "pressure scale of trapped gas, smooth form", .has = HAS_GAS, ACTS(IsSmooth, "law is van_genuchten"),
         BINDS(HAS_GAS)),
    REAL(Material, "relperm_Swr", relperm.Swr, "", "[0,1)", "1 @retention_Swr", "residual water saturation of k_rw",
         .has = HAS_GAS),
    REAL(Material, "relperm_Sgr", relperm.Sgr, "", "[0,1)", "1 @retention_Sgr", "residual gas saturation of k_rg",
         .has = HAS_GAS),
    BOOLEAN(Material, "relperm_share_of", relperm.of_pores, "fluids",
            "k_r from the share of the fluid-filled pores, S/(1 - Sh), or of all pores, S", .choices = space_word,
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
         "k across the beds over k along them, which is k_a (306)", .has = HAS_WATER),
    REAL(Material, "permeability_dip", permeability.dip, "deg", "[-90,90]", "0 deg",
         "of the beds at the start, from x towards y; they turn with the body", .has = HAS_WATER,
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
            "C0 - C1 T, or that at T_ref and from there on with the heat capacities of hydrate, water and gas",
            .choices = latent_word, .has = HAS_HEAT, ACTS(NeedsRate, "kinetics are active")),
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
           "stress follows E(S_h) both ways, only its loss, or hydrate bears a stress of its own that goes with it",
           .has = HAS_SOLID, .also = HAS_HYDRATE),
    CHOICE(Material, "plasticity_law", plasticity.type, "none", plasticity_word, "strength of the skeleton",
           .has = HAS_SOLID, .history = true),
    CHOICE(Material, "plasticity_flow", plasticity.flow, "menetrey_willam", flow_word,
           "potential: smooth, or the planes of the dilation angle", .has = HAS_SOLID,
           ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_cohesion_max", plasticity.c_max, "Pa", "[0,1e12]", "0 Pa",
         "peak cohesion at Sh_max; it falls as exp(eta_h (S_h - Sh_max)) towards cohesion_min",
         OFLAW(NeedsStrength, "law is mohr_coulomb"), .has = HAS_SOLID),
    REAL(Material, "plasticity_cohesion_min", plasticity.c_min, "Pa", "[0,1e12]", "1 @plasticity_cohesion_max",
         "its lower limit for little hydrate", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_cohesion_residual", plasticity.c_res, "Pa", "[0,1e12]", "1 @plasticity_cohesion_min",
         "what plastic strain leaves of it: c_res + (c_peak - c_res) exp(-eta_s eps_d_p)", .has = HAS_SOLID,
         ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_friction_peak", plasticity.phi_peak, "deg", "[0,90)", "0 deg", "friction angle",
         OFLAW(NeedsStrength, "law is mohr_coulomb"), .has = HAS_SOLID),
    REAL(Material, "plasticity_friction_residual", plasticity.phi_res, "deg", "[0,90)", "1 @plasticity_friction_peak",
         "what plastic strain leaves of it", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_dilation_max", plasticity.psi_max, "deg", "[0,90)", "0 deg",
         "dilation angle at Sh_max; plastic strain leaves nothing of it", .has = HAS_SOLID,
         ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_dilation_min", plasticity.psi_min, "deg", "[0,90)", "1 @plasticity_dilation_max",
         "its lower limit for little hydrate", .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_eta_h", plasticity.eta_h, "", "[0,1e3]", "0", "how fast strength grows with hydrate",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_Sh_max", plasticity.Sh_max, "", "[0,1]", "1", "hydrate saturation of the ..._max",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_eta_s", plasticity.eta_s, "", "[0,1e6]", "0",
         "how fast strength falls with deviatoric plastic strain; 0 = never", .has = HAS_SOLID,
         ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_softening_length", plasticity.length, "m", "[0,1e6]", "0 m",
         "width of a shear band that eta_s is meant for: eta_s is scaled by the size of a cell over it, so that what a "
         "band "
         "dissipates per area does not depend on the grid; 0 m = not scaled",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_nonlocal_length", plasticity.nonlocal, "m", "[0,1e6]", "0 m",
         "strength follows the plastic strain of neighbours, averaged with weights (d/l) exp(-(d/l)^2) of their "
         "distance "
         "d, l this length: what a band carries then depends less on the grid (docs/biaxial.md); at least two cells; 0 "
         "m = the "
         "particle's own",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    REAL(Material, "plasticity_eccentricity", plasticity.eccentricity, "", "(0,10]", "0.1",
         "of the smooth potential: how round its end is, of cohesion_max", .has = HAS_SOLID,
         ACTS(FlowIsSmooth, "law is mohr_coulomb and flow menetrey_willam")),
    REAL(Material, "plasticity_tension_cutoff", plasticity.cutoff, "Pa", "[0,1e12]", "none",
         "largest tension, flow mohr_coulomb only; or the word none", .word = "none", .has = HAS_SOLID),
    REAL(Material, "plasticity_heat", plasticity.heat, "", "[0,1]", "0", "share of the plastic work that becomes heat",
         .has = HAS_SOLID, ACTS(NeedsStrength, "law is mohr_coulomb")),
    {.name = NULL},
};

static const Key region_key[] = {
    LIKE(Region, GROUP_REGION,
         "another of regions, whose keys hold where this one's are not given, but for shape and minus"),
    NAME(Region, "material", material, NULL, GROUP_MATERIAL,
         "one of materials, or none: only to be cut out of others, to hold a region_temperature, or for a probe's mean",
         .word = "none", .shape = true),
    POINTS(Region, "polygon", polygon, "[[x, y], ...]: what this closed line goes round", .shape = true, .own = true),
    POINTS(Region, "below", below, "[[x, y], ...]: what lies under this line, down to lower", .shape = true,
           .own = true),
    REALS(Region, 3, "circle", circle, "m", "", "none, none, none", "[x, y, radius]", .word = "none", .shape = true,
          .own = true),
    REALS(Region, 2, "lower", lower, "m", "", "none, none", "lower left corner of a box, or bounds of another shape",
          WHEN(NeedsBox, "polygon, below and circle are not given"), .word = "-none", .shape = true, .own = true),
    REALS(Region, 2, "upper", upper, "m", "", "none, none", "upper right corner",
          WHEN(NeedsBox, "polygon, below and circle are not given"), .word = "none", .shape = true, .own = true),
    NAMES(Region, "minus", minus, GROUP_REGION, "list of regions whose shapes are cut out of this one", .own = true,
          BINDS(HAS_ALL)),
    INTEGERS(Region, 2, "particles_per_cell", ppc, "[1,10]", "2, 2", "along x and y", BINDS(HAS_ALL)),
    REAL(Region, "pressure", pressure, "Pa", "(0,1e10]", NULL, "initial mean pore pressure", .has = HAS_WATER),
    REAL(Region, "temperature", temperature, "degC", "(-273.15,1000]", NULL, "initial temperature",
         .has = HAS_HEAT | HAS_GAS, .felt = true),
    REAL(Region, "Sh", Sh, "", "[0,1)", "0", "initial hydrate saturation"),
    REAL(Region, "Sw", Sw, "", "[0,1]", NULL,
         "initial water saturation; Sh + Sw + Sg = 1; without gas it follows from Sh", .has = HAS_GAS),
    REAL(Region, "Sg", Sg, "", "[0,1]", NULL, "initial gas saturation", .has = HAS_GAS),
    REALS(Region, 6, "stress", stress, "Pa", "[-1e12,1e12]", "0 Pa, 0 Pa, 0 Pa, 0 Pa, 0 Pa, 0 Pa",
          "initial effective stress xx yy zz xy yz xz, tension-positive", .has = HAS_SOLID),
    REAL(Region, "stress_geostatic", K0, "", "(0,10]", "no",
         "K0: vertical effective stress from the weight above less the pore pressure, horizontal K0 times it",
         .word = "no"),
    BOOLEAN(Region, "stress_normally_consolidated", consolidated, "no",
            "the same with K0 = 1 - sin(friction angle of the material)"),
    BOOLEAN(Region, "hydrostatic", hydrostatic, "no", "water in balance with gravity", .has = HAS_WATER),
    REAL(Region, "datum", datum, "m", "", "0 m",
         "coordinate against gravity where the pressure is `pressure`; may lie above the body", .has = HAS_WATER,
         ACTS(IsHydrostatic, "hydrostatic is yes")),
    REAL(Region, "geothermal", geothermal, "K/m", "[-1e4,1e4]", "0 K/m", "growth of temperature with depth"),
    REAL(Region, "geothermal_datum", geothermal_datum, "m", "", "top",
         "coordinate against gravity below which it grows and above which it is `temperature`; top of the body",
         .word = "top", ACTS(IsGeothermal, "geothermal is not 0")),
    {.name = NULL},
};

#define TYPE(t) (1u << (t))
#define ON_FACE(kind, ...) | TYPE(BC_##kind)
#define PLANE(kind, word, has, by, term, where, doc) | ((where) == ON_PLANE ? TYPE(BC_##kind) : 0u)
enum { FACES = 0u CL_FACE_CONDITIONS(ON_FACE), PLANES = 0u CL_NODE_CONDITIONS(PLANE) CL_NODE_FORMS(PLANE) };

static const Key bc_key[] = {
    CHOICE(Bc, "type", type, NULL, case_bc_type, "what is prescribed", .first = BC_NONE + 1),
    BOOLEAN(Bc, "clock", of_stage, "run", "what times of its values count from: the begin of the run, or of each stage",
            .choices = clock_word),
    POINTS(Bc, "along", along, "[[x, y], ...]: faces on this line, in the initial configuration, instead of a side",
           .types = FACES & ~TYPE(BC_PLATE)),
    CHOICE(Bc, "side", side, "none", side_word, "side of the body, moves with it",
           WHEN(BcNeedsSide, "along is not given"), .types = FACES),
    NAME(Bc, "region", region, "all", GROUP_REGION, "one of regions, or all",
         .types = FACES | TYPE(BC_REGION_TEMPERATURE)),
    REAL(Bc, "from", from, "m", "", "start", "only the part of the side from here ...", .word = "-start",
         .types = FACES),
    REAL(Bc, "to", to, "m", "", "end", "... to here", .word = "end", .types = FACES),
    CHOICE(Bc, "axis", axis, NULL, axis_word, "axis normal to the grid plane", .types = PLANES),
    REAL(Bc, "position", position, "m", "", NULL, "coordinate of the plane; must be a grid line", .types = PLANES),
    BOOLEAN(Bc, "holds", drained, "all", "all phases, or the skeleton alone: a porous plate",
            .types = TYPE(BC_ROLLER) | TYPE(BC_FIXED) | TYPE(BC_PLATE) | TYPE(BC_PLATE_LINE), .choices = holds_word),
    BOOLEAN(Bc, "rough", rough, "no", "holds the tangential displacement too", .types = TYPE(BC_PLATE)),
    BOOLEAN(Bc, "separates", separates, "no", "the body may lift off: the plate takes no tension",
            .types = TYPE(BC_PLATE)),
    REAL(Bc, "stiffness", stiffness, "", "[1,1e6]", "100",
         "of the springs between plate and body, in units of the constrained modulus (with its fluids) over a cell",
         .types = TYPE(BC_PLATE)),
    BOOLEAN(Bc, "initial", initial, "no", "hold the initial p_w and p_g of each particle", .types = TYPE(BC_PRESSURE)),
    REAL(Bc, "alpha", alpha, "W/(m^2 K)", "[0,1e9]", NULL, "heat transfer coefficient", .types = TYPE(BC_CONVECTION)),
    SCHEDULE("normal", value, "Pa", "[-1e12,1e12]", NULL, TYPE(BC_TRACTION),
             "total normal stress beyond the ambient pressure, compression-positive"),
    SCHEDULE("shear", shear, "Pa", "[-1e12,1e12]", "0 Pa", TYPE(BC_TRACTION),
             "along the side's normal turned by +90 degrees"),
    SCHEDULE("p_w", phase[PHASE_W], "Pa", "(0,1e10]", "", TYPE(BC_PRESSURE), "water pressure, together with p_g"),
    SCHEDULE("p_g", phase[PHASE_G], "Pa", "(0,1e10]", "", TYPE(BC_PRESSURE), "gas pressure, together with p_w"),
    SCHEDULE("pressure", value, "Pa", "(0,1e10]", "", TYPE(BC_PRESSURE),
             "mean pore pressure, or the word ambient: the pressure of the fluid around the body at the face",
             WHEN(NeedsPressure, "initial is no and p_w, p_g are not given"), .word = "ambient"),
    BOOLEAN(Bc, "saturation", natural, "held",
            "capillary pressure outside, with pressure or initial: held is the face's initial one, free the body's own "
            "(natural outflow)",
            .choices = capillary_word, .types = TYPE(BC_PRESSURE)),
    CHOICE(Bc, "phases", open, "both", phases_word, "fluids for which the face is open; closed for the other",
           .types = TYPE(BC_PRESSURE)),
    SCHEDULE("water", phase[PHASE_W], "m/s", "[-1e3,1e3]", "0 m/s", TYPE(BC_INFLOW),
             "volume into the body per time and area, at the face's pressure and temperature; negative = out"),
    SCHEDULE("gas", phase[PHASE_G], "m/s", "[-1e3,1e3]", "0 m/s", TYPE(BC_INFLOW), "the same for gas"),
    SCHEDULE("flux", value, "W/m^2", "[-1e12,1e12]", NULL, TYPE(BC_HEAT_FLUX), "into the body"),
    SCHEDULE("ambient", value, "degC", "(-273.15,1000]", NULL, TYPE(BC_CONVECTION), "temperature outside"),
    SCHEDULE("temperature", value, "degC", "(-273.15,1000]", "",
             TYPE(BC_FACE_TEMPERATURE) | TYPE(BC_TEMPERATURE) | TYPE(BC_REGION_TEMPERATURE) | TYPE(BC_INFLOW),
             "inflow: of what flows in, by default the body's own", WHEN(NeedsTemperature, "type is not inflow")),
    SCHEDULE("displacement", displacement, "m", "[-1e6,1e6]", "", TYPE(BC_PLATE),
             "since the start, along the axis normal to the side, positive in its direction"),
    SCHEDULE(
        "force", force, "N", "[-1e18,1e18]", "", TYPE(BC_PLATE),
        "on the body beyond the ambient pressure, compression-positive; per metre of thickness or of the full ring"),
    SCHEDULE("velocity", value, "m/s", "[-1e3,1e3]", "", TYPE(BC_PLATE) | TYPE(BC_PLATE_LINE),
             "along the axis, positive in its direction",
             WHEN(NeedsVelocity, "neither displacement nor force is given")),
    {.name = NULL},
};

static const Key probe_key[] = {
    NAME(Probe, "over", over, "none", GROUP_REGION,
         "the mean over a region, weighted with current volumes: its particles, or of a region without particles those "
         "that were in its shape first",
         .word = "none"),
    POINTS(Probe, "along", surface.along,
           "[[x, y], ...]: the mean over the faces on this line, in the initial configuration, weighted with current "
           "areas"),
    CHOICE(Probe, "side", surface.side, "none", side_word, "the mean over this side of the body, by area"),
    NAME(Probe, "region", surface.region, "all", GROUP_REGION, "with side or along: one of regions, or all"),
    REAL(Probe, "from", surface.from, "m", "", "start", "with side: only the part from here ...", .word = "-start"),
    REAL(Probe, "to", surface.to, "m", "", "end", "... to here", .word = "end"),
    REALS(Probe, 2, "at", x, "m", "", "none, none", "a point: initial position, inside a region",
          WHEN(NeedsPlace, "over, side and along are not given"), .word = "none"),
    BOOLEAN(Probe, "fixed", fixed, "no",
            "a point stays there in space, otherwise it follows the body; a mean is over what is in the region's shape "
            "now"),
    {.name = NULL},
};

static const Key meter_key[] = {
    POINTS(Meter, "along", along, "[[x, y], ...]: faces on this line, in the initial configuration, instead of a side"),
    CHOICE(Meter, "side", side, "none", side_word, "side of the body, moves with it",
           WHEN(MeterNeedsSide, "along is not given")),
    NAME(Meter, "region", region, "all", GROUP_REGION, "one of regions, or all"),
    REAL(Meter, "from", from, "m", "", "start", "only the part of the side from here ...", .word = "-start"),
    REAL(Meter, "to", to, "m", "", "end", "... to here", .word = "end"),
    {.name = NULL},
};

/* Keys that stages share with the case: not given, the case's value stays. */
#define CASES "the case's"
#define CASES_LENGTH "the case's if it is given, else the same share of the stage's length"
static const Key stage_key[] = {
    REAL(CaseStage, "end", end, "s", "(0,inf)", NULL, "it begins where the stage before ends", .made = true),
    BOOLEAN(
        CaseStage, "reset_displacement", reset, "no",
        "displacement and log_J count from the begin of the stage; sides, from and to stay those of the initial body"),
    BOOLEAN(CaseStage, "kinetics_active", reaction, "yes",
            "no: hydrate neither forms nor dissociates, in materials whose kinetics are active"),
    TEXT(CaseStage, "boundaries", boundaries, "all", "list of the boundaries that act in this stage; all, or none",
         .made = true),
    TEXT(CaseStage, "boundaries_off", off, "", "list: all but these act", .made = true),
    TEXT(CaseStage, "materials", materials, "",
         "list of pairs region, material: what the region is made of in this stage; stress, masses and pressures stay",
         .made = true),
    REALS(CaseStage, 2, "gravity", c.scene.gravity, "m/s^2", "[-1e4,1e4]", CASES, "along x and y", .kept = true),
    REAL(CaseStage, "gravity_ramp", c.scene.gravity_ramp, "s", "[0,inf)", CASES,
         "gravity goes from that of the stage before to that of this one over this time", .kept = true),
    REAL(CaseStage, "strength_factor", c.scene.strength_factor, "", "(0,1e3]", CASES,
         "strength is divided by it, from the begin of the stage on", .kept = true),
    BOOLEAN(CaseStage, "inertia", c.scene.inertia, CASES, "accelerations; no is quasi-static", .kept = true),
    TEXT(CaseStage, "stepper_type", c.stepper, CASES, "time integrator", .choices = stepper_word, .kept = true),
    BOOLEAN(CaseStage, "stepper_adapt", c.adaptive, CASES, "choose the step by the error estimate", .kept = true),
    REAL(CaseStage, "stepper_dt", c.dt, "s", "(0,inf)", CASES_LENGTH, "first step (adaptive) or fixed step",
         .plain = true, .kept = true),
    REAL(CaseStage, "stepper_dt_min", c.dt_min, "s", "(0,inf)", CASES_LENGTH, "a smaller step ends the run",
         .plain = true, .kept = true),
    REAL(CaseStage, "stepper_dt_max", c.dt_max, "s", "(0,inf)", CASES_LENGTH, "longest step", .plain = true,
         .kept = true),
    REAL(CaseStage, "stepper_tol", c.tol, "", "(0,1)", CASES, "relative tolerance of the error estimate", .kept = true),
    REAL(CaseStage, "stepper_cfl", c.cfl, "", "(0,1]", CASES, "hybrid, explicit: step as a share of the stable one",
         .kept = true),
    BOOLEAN(CaseStage, "stepper_force_dt", c.force_dt, CASES,
            "hybrid, explicit: take a fixed step above the stable one all the same", .kept = true),
    REAL(CaseStage, "stepper_flip", c.flip, "", "[0,1]", CASES, "hybrid, explicit: FLIP (1) to PIC (0)", .kept = true),
    REAL(CaseStage, "stepper_relaxation", c.relaxation, "s", "(0,inf]", CASES,
         "hybrid, explicit: time over which particles take up the nodes' pressures and temperature", .kept = true,
         .word = "none"),
    REAL(CaseStage, "stepper_damping", c.damping, "", "[0,1)", CASES, "hybrid, explicit: local damping", .kept = true),
    REAL(CaseStage, "stepper_mass_scaling", c.mass_scaling, "", "[1,1e12]", CASES,
         "hybrid, explicit: factor on all inertia", .kept = true),
    REAL(CaseStage, "output_every", c.every, "s", "[0,inf)", CASES, "snapshots, counted from the begin of the stage",
         .kept = true),
    REAL(CaseStage, "output_probe_every", c.probe_every, "s", "[0,inf)", CASES,
         "probe rows, counted from the begin of the stage", .kept = true),
    REAL(CaseStage, "checkpoint_every", c.checkpoint_every, "s", "[0,inf)", CASES,
         "counted from the begin of the stage", .plain = true, .kept = true),
    {.name = NULL},
};

#define GROUP(T, prefix_, list_, noun_, n_, p_, required_, key_, doc_)                                                 \
  {                                                                                                                    \
    .prefix = prefix_, .list = list_, .noun = noun_, .doc = doc_, .size = sizeof(T), .count = offsetof(Case, n_),      \
    .pointer = offsetof(Case, p_), .required = required_, .key = key_                                                  \
  }
const GroupInfo case_group[GROUP_COUNT] = {
    {.prefix = "", .list = NULL, .noun = "case", .doc = "The scene", .size = sizeof(Case), .key = case_key},
    GROUP(Material, "mat_", "materials", "material", scene.nmaterial, scene.material, true, material_key,
          "Laws and constants"),
    GROUP(Region, "region_", "regions", "region", scene.nregion, scene.region, true, region_key,
          "Parts of the body, each of one shape, and their initial state"),
    GROUP(Bc, "bc_", "boundaries", "boundary", scene.nbc, scene.bc, false, bc_key, "Boundary conditions"),
    GROUP(Probe, "probe_", "probes", "probe", nprobe, probe, false, probe_key,
          "Points and means whose history is written"),
    GROUP(Meter, "meter_", "meters", "meter", scene.nmeter, scene.meter, false, meter_key,
          "Parts of the surface that count what crosses them"),
    GROUP(CaseStage, "stage_", "stages", "stage", nstage, stage, false, stage_key,
          "Stages that follow each other in time; a key that is not given is the case's"),
};
