/* keys_case: the grid, the surroundings, numerics, time and output; and what of it a stage may have of its own. */
#include "key_rows.h"

#define HAS_SPACING(axis, d)                                                                                           \
  static bool HasSpacing##axis(const void *p)                                                                          \
  {                                                                                                                    \
    return ((const Case *)p)->scene.spacing[d][0];                                                                     \
  }                                                                                                                    \
  static bool HasTable##axis(const void *p)                                                                            \
  {                                                                                                                    \
    return ((const Case *)p)->scene.table[d][0];                                                                       \
  }
HAS_SPACING(X, 0)
HAS_SPACING(Y, 1)
IN_SPACE(HAS_SPACING(Z, 2))
static bool HasEqualAxis(const void *p)
{
  bool equal = false;

  for (int d = 0; d < CL_DIM; d++)
    equal = equal || !(((const Case *)p)->scene.spacing[d][0] || ((const Case *)p)->scene.table[d][0]);
  return equal;
}
static bool NeedsEnd(const void *p)
{
  return ((const Case *)p)->nstage == 0;
}

static const char *const basis_word[]       = {"cpgimp", "ugimp", "linear", "total", NULL}; /* BasisType */
static const char *const geometry_word[]    = {PLANE_WORD, "axisymmetric", NULL};
static const char *const ice_word[]         = {"warn", "stop", NULL};      /* ICE_... */
static const char *const leaving_word[]     = {"stop", "remove", NULL};    /* LEAVING_... */
static const char *const without_gas_word[] = {"auto", "yes", "no", NULL}; /* WITHOUT_GAS_... */

#define WORD(name, word, ...) word,
const char *const case_integrator[INTEGRATOR_COUNT + 1] = {CL_INTEGRATORS(WORD)};

const Key case_key[] = {
    TEXT(Case, "title", title, "", "one line"),
    REALS(Case, CL_DIM, "grid_lower", scene.lower, "m", "", NULL, "lower left corner of the background grid",
          BINDS(HAS_ALL)),
    REALS(Case, CL_DIM, "grid_upper", scene.upper, "m", "", NULL,
          "upper right corner; the body must not leave the grid", BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_x", scene.spacing[0], "",
         "sizes of the cells along x: one, or first, largest and growth from the lower end on ([0.05 m, 2 m, growth "
         "1.15])",
         ACTS(HasSpacingX, "it is given"), BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_x_table", scene.table[0], "",
         "sizes at places, which are lines of the grid ({table: [0 m, 0.5 m, 4 m, 0.05 m, 10 m, 1 m]})",
         ACTS(HasTableX, "it is given"), BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_y", scene.spacing[1], "", "likewise along y", ACTS(HasSpacingY, "it is given"),
         BINDS(HAS_ALL)),
    TEXT(Case, "grid_spacing_y_table", scene.table[1], "", "likewise along y", ACTS(HasTableY, "it is given"),
         BINDS(HAS_ALL)),
    IN_SPACE(TEXT(Case, "grid_spacing_z", scene.spacing[2], "", "likewise along z", ACTS(HasSpacingZ, "it is given"),
                  BINDS(HAS_ALL)),
             TEXT(Case, "grid_spacing_z_table", scene.table[2], "", "likewise along z", ACTS(HasTableZ, "it is given"),
                  BINDS(HAS_ALL)), )
        INTEGERS(Case, CL_DIM, "grid_cells", scene.cells, "[1,100000]", EACH("auto"),
                 "cells along " AXES_WORDS "; auto: as many as the spacing of that axis makes",
                 WHEN(HasEqualAxis, "an axis has no spacing"), .word = "auto", BINDS(HAS_ALL)),
    BOOLEAN(Case, "geometry", scene.axisymmetric, PLANE_WORD, "axisymmetric: x is the radius, y runs along the axis",
            .choices = geometry_word, BINDS(HAS_ALL)),
    TEXT(Case, "fields", fields_wanted, "auto",
         "a list of solid, water, gas, heat, or a set's name (thmc, thc, hmc, thm, hm, m, ...); auto drops what is "
         "identically zero",
         BINDS(HAS_ALL)),
    BOOLEAN(Case, "inertia", scene.inertia, "yes", "accelerations; no is quasi-static"),
    BOOLEAN(Case, "compression_heat", scene.compression_heat, "no",
            "fluids warm as they are compressed and cool or warm as they are throttled (Joule-Thomson)"),
    CHOICE(Case, "basis", scene.basis, "cpgimp", basis_word,
           "basis functions: averages over domains that follow the particles' stretch (cpgimp) or keep their size "
           "(ugimp), at points (linear); total: total Lagrangian, for bodies that settle or bend but do not flow "
           "(sdirk2, euler)"),
    REAL(Case, "mean_strain", scene.mean_strain, "", "[0,1]", "0",
         "share of the cell's mean motion in a particle's strain (160), against locking; 1 leaves hourglass modes, "
         "0.95 does for collapse loads",
         BY(ALL_BUT_PAPER)),
    REALS(Case, CL_DIM, "gravity", scene.gravity, "m/s^2", "[-1e4,1e4]", EACH("0 m/s^2"),
          "e.g. [0 m/s^2, -9.81 m/s^2]"),
    REAL(Case, "gravity_ramp", scene.gravity_ramp, "s", "[0,inf)", "0 s",
         "gravity grows from zero to its value over this time"),
    REAL(Case, "strength_factor", scene.strength_factor, "", "(0,1e3]", "1",
         "divides cohesion, tension cut-off and the tangents of friction and dilation angle of all materials"),
    ROW(Case, "ambient_pressure", KEY_SCHEDULE, scene.ambient_pressure, 1, "Pa", "[0,1e10]", "0 Pa",
        "of the fluid around the body, at and above ambient_level; acts on the whole surface"),
    REAL(Case, "ambient_density", scene.ambient_density, "kg/m^3", "[0,1e5]", "0 kg/m^3",
         "of that fluid: below ambient_level its pressure grows with depth"),
    REAL(Case, "ambient_drag", scene.ambient_drag, "", "[0,100]", "0",
         "coefficient of the drag of that fluid, at rest, on faces that move into it", .has = HAS_SOLID),
    ROW(Case, "ambient_level", KEY_SCHEDULE, scene.ambient_level, 1, "m", "", "0 m", "coordinate against gravity"),
    CHOICE(Case, "without_gas", scene.without_gas, "auto", without_gas_word,
           "sediment may be or become free of gas: water then holds 1e-7 of what gas would; auto: where a region has "
           "Sg: 0"),
    CHOICE(Case, "ice", ice, "warn", ice_word,
           "where pore water is colder than its melting point (no equation has ice), with heat or reacting hydrate: "
           "warn, or end the run"),
    CHOICE(Case, "particles_leaving", leaving, "stop", leaving_word,
           "particles that cross the edge of the grid end the run, or are removed and counted", .has = HAS_SOLID),
    REAL(Case, "time_end", t_end, "s", "(0,inf)", "end of the last stage", "the run starts at 0 and ends here",
         WHEN(NeedsEnd, "there are no stages"), .kept = true),
    CHOICE(Case, "stepper_type", integrator, "sdirk2", case_integrator,
           "time integrator; auto: the cheaper of sdirk2 and hybrid, at any time; hybrid_paper: the paper's form of "
           "hybrid"),
    BOOLEAN(Case, "stepper_adapt", adaptive, "yes", "choose the step by the error estimate"),
    REAL(Case, "stepper_dt", dt, "s", "(0,inf)", "1e-3 @time_end", "first step (adaptive) or fixed step",
         .plain = true),
    REAL(Case, "stepper_dt_min", dt_min, "s", "(0,inf)", "1e-9 @time_end", "a smaller step ends the run", .plain = true,
         BY(IMPLICIT)),
    REAL(Case, "stepper_dt_max", dt_max, "s", "(0,inf)", "1 @time_end", "longest step", .plain = true),
    REAL(Case, "stepper_tol", tol, "", "(0,1)", "1e-3", "relative tolerance of the error estimate", BY(IMPLICIT)),
    REAL(Case, "stepper_error_exponent", error_exponent, "", "[1,16]", "2",
         "n of the mean of the error over the particles: 2 is the root mean square; 8 sees a front in a small part of "
         "the body",
         BY(IMPLICIT)),
    INTEGERS(Case, 1, "stepper_max_failures", max_failures, "[1,1000]", "20",
             "cuts in a row before the run is given up"),
    REAL(Case, "stepper_cfl", cfl, "", "(0,1]", "0.8", "step as a share of the stable one", BY(STABLE_STEPS)),
    BOOLEAN(Case, "stepper_force_dt", force_dt, "no", "take a fixed step above the stable one all the same",
            BY(STABLE_STEPS)),
    REAL(Case, "stepper_damping", damping, "", "[0,1)", "0",
         "share of the out-of-balance force that acts against motion, for quasi-static ends", BY(STABLE_STEPS)),
    REAL(Case, "stepper_mass_scaling", mass_scaling, "", "[1,1e12]", "1",
         "factor on all inertia; the error it makes is reported", BY(STABLE_STEPS)),
    REAL(Case, "stabilisation_ghost_penalty", scene.stabilisation.ghost_penalty, "", "[0,100]", "0.1",
         "at free surfaces; 0 = off", BY(IMPLICIT)),
    BOOLEAN(Case, "stabilisation_donor", scene.stabilisation.donor, "no",
            "gas has the mobility of the nodes upstream: for sand with gas beside clay"),
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

/* Keys that stages share with the case: not given, the case's value stays. */
#define CASES "the case's"
#define CASES_LENGTH "the case's, or its share of the stage's length"
const Key stage_key[] = {
    REAL(CaseStage, "end", end, "s", "(0,inf)", NULL, "it begins where the stage before ends", .made = true),
    BOOLEAN(CaseStage, "reset_displacement", reset, "no", "displacement and log_J count from the begin of the stage"),
    BOOLEAN(CaseStage, "kinetics_active", reaction, "yes", "no: hydrate neither forms nor dissociates"),
    TEXT(CaseStage, "boundaries", boundaries, "all", "list of the boundaries that act in this stage; all, or none",
         .made = true),
    TEXT(CaseStage, "boundaries_off", off, "", "list: all but these act", .made = true),
    TEXT(CaseStage, "materials", materials, "", "list of pairs region, material; stress, masses and pressures stay",
         .made = true),
    REALS(CaseStage, CL_DIM, "gravity", c.scene.gravity, "m/s^2", "[-1e4,1e4]", CASES, "along " AXES_WORDS,
          .kept = true),
    REAL(CaseStage, "gravity_ramp", c.scene.gravity_ramp, "s", "[0,inf)", CASES,
         "time over which gravity changes to that of this stage", .kept = true),
    REAL(CaseStage, "strength_factor", c.scene.strength_factor, "", "(0,1e3]", CASES,
         "strength is divided by it, from the begin of the stage on", .kept = true),
    BOOLEAN(CaseStage, "inertia", c.scene.inertia, CASES, "accelerations; no is quasi-static", .kept = true),
    CHOICE(CaseStage, "stepper_type", c.integrator, CASES, case_integrator, "time integrator", .kept = true),
    BOOLEAN(CaseStage, "stepper_adapt", c.adaptive, CASES, "choose the step by the error estimate", .kept = true),
    REAL(CaseStage, "stepper_dt", c.dt, "s", "(0,inf)", CASES_LENGTH, "first step (adaptive) or fixed step",
         .plain = true, .kept = true),
    REAL(CaseStage, "stepper_dt_min", c.dt_min, "s", "(0,inf)", CASES_LENGTH, "a smaller step ends the run",
         .plain = true, .kept = true, BY(IMPLICIT)),
    REAL(CaseStage, "stepper_dt_max", c.dt_max, "s", "(0,inf)", CASES_LENGTH, "longest step", .plain = true,
         .kept = true),
    REAL(CaseStage, "stepper_tol", c.tol, "", "(0,1)", CASES, "relative tolerance of the error estimate", .kept = true,
         BY(IMPLICIT)),
    REAL(CaseStage, "stepper_cfl", c.cfl, "", "(0,1]", CASES, "step as a share of the stable one", .kept = true,
         BY(STABLE_STEPS)),
    BOOLEAN(CaseStage, "stepper_force_dt", c.force_dt, CASES, "take a fixed step above the stable one all the same",
            .kept = true, BY(STABLE_STEPS)),
    REAL(CaseStage, "stepper_damping", c.damping, "", "[0,1)", CASES, "local damping", .kept = true, BY(STABLE_STEPS)),
    REAL(CaseStage, "stepper_mass_scaling", c.mass_scaling, "", "[1,1e12]", CASES, "factor on all inertia",
         .kept = true, BY(STABLE_STEPS)),
    REAL(CaseStage, "output_every", c.every, "s", "[0,inf)", CASES, "snapshots, counted from the begin of the stage",
         .kept = true),
    REAL(CaseStage, "output_probe_every", c.probe_every, "s", "[0,inf)", CASES,
         "probe rows, counted from the begin of the stage", .kept = true),
    REAL(CaseStage, "checkpoint_every", c.checkpoint_every, "s", "[0,inf)", CASES,
         "counted from the begin of the stage", .plain = true, .kept = true),
    {.name = NULL},
};
