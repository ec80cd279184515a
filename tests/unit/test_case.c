/* The case reader: units, schedules, typo search, reading cases/bp2, and the resolved case bit for bit. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <cmocka.h>
#include "../../src/case/case_private.h"
#include "ranks.h"

static char bp2[PETSC_MAX_PATH_LEN]; /* cases/bp2 of this tree */

#define GOOD(call) assert_int_equal((call), 0)

/* ---------------------------------------------------------------- units */
static void units_to_si(void **state)
{
  static const struct {
    const char *text, *si;
    double      value;
  } row[] = {
      {"3.25 MPa", "Pa", 3.25e6},
      {"3.25MPa", "Pa", 3.25e6},
      {"0.01 MPa/s", "Pa/s", 1e4},
      {"4 degC", "degC", 4},
      {"4 \xc2\xb0"
       "C",
       "degC", 4},
      {"277.15 K", "degC", 277.15 - 273.15},
      {"8533.8 K", "K", 8533.8},
      {"20 min", "s", 1200},
      {"2 h", "s", 7200},
      {"1.5 d", "s", 129600},
      {"1 a", "s", 31557600},
      {"1 years", "s", 31557600},
      {"12 months", "s", 31557600},
      {"2 weeks", "s", 1209600},
      {"10 days", "s", 864000},
      {"1.5 hours", "s", 5400},
      {"1 mm/year", "m/s", 1e-3 / 31557600},
      {"1.53e-15 m^2", "m^2", 1.53e-15},
      {"2 mD", "m^2", 2 * 9869233e-22},
      {"1 Darcy", "m^2", 9.869233e-13},
      {"50 kPa", "Pa", 5e4},
      {"2.2 GPa", "Pa", 2.2e9},
      {"1 bar", "Pa", 1e5},
      {"1 atm", "Pa", 101325},
      {"20 mm", "m", 0.02},
      {"1.1 cm", "m", 0.011},
      {"7 uPa s", "Pa s", 7e-6},
      {"1 cP", "Pa s", 1e-3},
      {"40 %", "", 0.4},
      {"800 J/(kg K)", "J/(kg K)", 800},
      {"800 J/(kg degC)", "J/(kg K)", 800},
      {"0.8 kJ kg^-1 K^-1", "J/(kg K)", 800},
      {"800 J/kg/K", "J/(kg K)", 800},
      {"2.5e-10 mol/(m^2 Pa s)", "mol/(m^2 Pa s)", 2.5e-10},
      {"2.6 t/m^3", "kg/m^3", 2600},
      {"1 g/cm^3", "kg/m^3", 1000},
      {"16 g/mol", "kg/mol", 0.016},
      {"-9.81 m/s\xc2\xb2", "m/s^2", -9.81},
      {"1e-4 1/K", "1/K", 1e-4},
      {"3 W/(m\xc2\xb7K)", "W/(m K)", 3},
      {"60 m/min", "m/s", 1},
      {"25", "", 25},
  };
  char why[CASE_WHY];

  (void)state;
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    double value = NAN;
    if (!QuantityParse(row[i].text, row[i].si, &value, why))
      fail_msg("%s: %s", row[i].text, why);
    if (fabs(value - row[i].value) > 2e-16 * fabs(row[i].value))
      fail_msg("%s is %.17g", row[i].text, value);
  }
}

static void units_refused(void **state)
{
  static const char *const row[][2] = {
      {"3.25e6", "Pa"},    {"3 m", "Pa"},     {"3 MPa/s", "Pa"},
      {"0.5 m", ""},       {"nan", ""},       {"inf Pa", "Pa"},
      {"1e999 Pa", "Pa"},  {"0x10 Pa", "Pa"}, {"", "Pa"},
      {"Pa", "Pa"},        {"1 pa", "Pa"},    {"1 MPsi", "Pa"},
      {"1 kg/", "kg"},     {"1 (kg", "kg"},   {"1 kg)", "kg"},
      {"1 m^", "m"},       {"1 m^99", "m"},   {"4 degC", "K"},
      {"1 m^1.5", "m"},    {"1 m m", "m"},    {"1 kmin", "s"},
      {"1,2", ""},         {"1 2", ""},       {"--1 m", "m"},
      {". m", "m"},        {"1e304 Mm", "m"}, {"1 ((((((m))))))", "m"},
      {"1e308 GPa", "Pa"}, {"1 //m", "1/m"},  {"1 \xff", "m"},
  };
  char   why[CASE_WHY];
  double value;

  (void)state;
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    *why = 0;
    if (QuantityParse(row[i][0], row[i][1], &value, why))
      fail_msg("'%s' was taken for %s", row[i][0], row[i][1]);
    assert_true(*why);
  }
}

/* ---------------------------------------------------------------- schedules */
static void schedule_values(void **state)
{
  double   t[] = {10, 20, 40}, y[] = {1, 3, -1};
  Schedule line = {.n = 3, .t = t, .y = y}, jump = {.n = 3, .t = t, .y = y, .steps = true},
           constant = {.n = 1, .t = t, .y = y};

  (void)state;
  assert_true(ScheduleValue(&line, 0) == 1 && ScheduleValue(&line, 10) == 1 && ScheduleValue(&line, 15) == 2);
  assert_true(ScheduleValue(&line, 20) == 3 && ScheduleValue(&line, 30) == 1 && ScheduleValue(&line, 40) == -1);
  assert_true(ScheduleValue(&line, 1e9) == -1);
  assert_true(ScheduleValue(&jump, 0) == 1 && ScheduleValue(&jump, 19.9) == 1 && ScheduleValue(&jump, 20) == 3);
  assert_true(ScheduleValue(&jump, 20 * (1 - 1e-13)) == 3 && ScheduleValue(&jump, 41) == -1);
  assert_true(ScheduleValue(&constant, -5) == 1 && ScheduleValue(&constant, 5e9) == 1);
  assert_true(ScheduleNextKink(&line, 0) == 10 && ScheduleNextKink(&line, 10) == 20 &&
              ScheduleNextKink(&line, 39) == 40);
  assert_true(ScheduleNextKink(&line, 20 * (1 - 1e-13)) == 40 && ScheduleNextKink(&line, 20 * (1 - 1e-11)) == 20);
  assert_true(isinf(ScheduleNextKink(&line, 40)) && isinf(ScheduleNextKink(&constant, 0)));
  assert_true(fabs(ScheduleIntegral(&line, 5) - 5) < 1e-14 && fabs(ScheduleIntegral(&line, 15) - 17.5) < 1e-13);
  assert_true(fabs(ScheduleIntegral(&line, 40) - 50) < 1e-13 && fabs(ScheduleIntegral(&line, 50) - 40) < 1e-13);
  assert_true(fabs(ScheduleIntegral(&jump, 25) - 35) < 1e-13 && ScheduleIntegral(&constant, 7) == 7);
  assert_true(ScheduleNextKink(&jump, 10) == 20);

  /* 1 + 2 sin(2 pi (t - 10)/8): its eighths are whole seconds; the integral over two periods is that of the mean */
  Wave     wave[2] = {{2, 8, 10}, {0.5, 5, 0}};
  Schedule tide    = {.n = 1, .t = t, .y = y, .nwave = 1, .wave = wave},
           both    = {.n = 1, .t = t, .y = y, .nwave = 2, .wave = wave};

  assert_true(fabs(ScheduleValue(&tide, 12) - 3) < 1e-14 && fabs(ScheduleValue(&tide, 16) + 1) < 1e-14);
  assert_true(fabs(ScheduleValue(&tide, 0) + 1) < 1e-14 && fabs(ScheduleValue(&tide, 10 + 8e6) - 1) < 1e-8);
  assert_true(ScheduleNextMark(&tide, 0) == 1 && ScheduleNextMark(&tide, 1) == 2 &&
              ScheduleNextMark(&tide, 10.5) == 11);
  assert_true(ScheduleNextMark(&tide, 3 * (1 - 1e-13)) == 4 && ScheduleNextMark(&both, 0) == 0.625);
  assert_true(isinf(ScheduleNextMark(&line, 0)) && isinf(ScheduleNextKink(&tide, 0)) && ScheduleSwing(&both) == 2.5);
  assert_true(fabs(ScheduleIntegral(&tide, 16) - 16) < 1e-13);
  double sum = 0;
  for (int i = 0; i < 7000; i++)
    sum += 1e-3 * ScheduleValue(&both, 1e-3 * (i + 0.5));
  assert_true(fabs(ScheduleIntegral(&both, 7) - sum) < 1e-6);
}

/* ---------------------------------------------------------------- YAML */
/* Entries as "name=value@line", maps left out; what libyaml or the walk says begins with '!'. */
static void parsed(void **state)
{
  static const char *const row[][2] = {
      {"a: 1 MPa\nb: {c: x, d: [1 m, 2 m]}\n", "a=1 MPa@1 b_c=x@2 b_d=1 m,2 m@2 "},
      {"a:\n  - [1, 2] # first\n  - [3,\n     4]\n", "a=1; 2,3; 4@1 "},
      {"a: 'x: # y'\nb: \"q \\\"r\\\"\"\nc: two\n  lines # gone\n", "a=x: # y@1 b=q \"r\"@2 c=two lines@3 "},
      {"a: ~\nb: ''\nc: []\nd: {}\ne: 'null'\nf:\n", "a=@1 b=@2 c=@3 d=@4 e=null@5 f=@6 "},
      {"a: &v 7 m\nb: *v\n", "a=7 m@1 b=7 m@2 "},
      {"a: &m {x: 1, y: {z: 2, w: 3}}\nb:\n  <<: *m\n  x: 5\n",
       "a_x=1@1 a_y_z=2@1 a_y_w=3@1 b_x=5@4 b_y_z=2@1 b_y_w=3@1 "},
      {"b:\n  y: {z: 9}\n  <<: {y: {z: 2, w: 3}}\n", "b_y_z=9@2 "},
      {"a: {<<: [{x: 1}, {x: 2, y: 3}]}\n", "a_x=1@1 a_y=3@1 "},
      {"a: &m {<<: {x: 1}, y: 2}\nb: {<<: *m, x: 3}\n", "a_y=2@1 a_x=1@1 b_x=3@2 b_y=2@1 "},
      {"\xef\xbb\xbf--- # begins\na: 1\r\nb: 2\r\n...\n", "a=1@2 b=2@3 "},
      {"a: 1\nA: 2\n", "!A: is given twice, on lines 1 and 2"},
      {"a_b: 1\na: {b: 2}\n", "!a_b: is given twice, on lines 1 and 2"},
      {"a: [1, 2\nb: 3\n", "a bracket is opened here"},
      {"- a\n", "!is not a case"},
      {"# nothing\n", "!is not a case"},
  };

  (void)state;
  for (size_t i = 0; i < sizeof row / sizeof *row; i++) {
    Reader r        = {.comm = PETSC_COMM_SELF, .file = "f"};
    char   got[512] = "";

    if (ReaderParse(&r, row[i][0])) {
      for (PetscInt k = 0; k < r.nentry; k++)
        if (!r.entry[k].map)
          snprintf(got + strlen(got), sizeof got - strlen(got), "%s=%s@%d ", r.entry[k].name,
                   r.entry[k].value ? r.entry[k].value : "", (int)r.entry[k].line);
      if (strcmp(got, row[i][1]))
        fail_msg("%s\ngives %s\nnot   %s", row[i][0], got, row[i][1]);
    } else if (r.nerror != 1 || !strstr(r.error[0], row[i][1] + (*row[i][1] == '!')))
      fail_msg("%s\nis refused with: %s", row[i][0], r.nerror ? r.error[0] : "nothing");
    GOOD(ReaderDestroy(&r));
  }
}

/* ---------------------------------------------------------------- cases */
static void set_option(const char *name, const char *value)
{
  GOOD(PetscOptionsSetValue(NULL, name, value));
}

static void read_bp2(void **state)
{
  Case            c;
  bool            ok;
  const Material *m;

  (void)state;
  GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
  assert_true(ok);
  assert_true(c.scene.nmaterial == 1 && c.scene.nregion == 1 && c.scene.nbc == 5 && c.nprobe == 2);
  assert_true(c.scene.cells[0] == 52 && c.scene.cells[1] == 1 && c.scene.upper[0] == 1.04 &&
              c.scene.basis == BASIS_CPGIMP);
  assert_true(c.t_end == 2000 && c.probe_every == 20 && c.ntimes == 5 && c.times[2] == 1000);
  assert_string_equal(c.output_dir, "results/bp2");
  m = &c.scene.material[0];
  assert_true(m->porosity == 0.15 && m->solid.rho0 == 2600 && isinf(m->solid.K) && m->water.K == 2.2e9);
  assert_true(m->retention.p_smooth == 2500 && m->retention.p_trap == 5e4 && m->relperm.Sgr == 0.4);
  assert_true(m->permeability.phi0 == 0.15 && m->permeability.k0 == 1.53e-15 && m->permeability.mh == 3);
  assert_true(m->reacts && m->kinetics.K0 == 2.5e-10 && m->kinetics.equilibrium.A1 == 1000 && m->kinetics.M_g == 0.016);
  assert_true(m->elasticity.E0 == 9e7 && !m->elasticity.change);
  assert_true(c.scene.region[0].pressure == 3.25e6 && c.scene.region[0].temperature == 4 &&
              c.scene.region[0].ppc[1] == 2);
  assert_true(c.scene.bc[0].type == BC_FIXED && c.scene.bc[0].axis == 0 && c.scene.bc[1].type == BC_ROLLER &&
              c.scene.bc[2].position == 0.02);
  assert_true(c.scene.bc[3].type == BC_TRACTION && c.scene.bc[3].side == SIDE_XMAX && c.scene.bc[3].region == -1);
  assert_true(ScheduleValue(&c.scene.bc[3].value, 500) == 8.25e6 &&
              ScheduleValue(&c.scene.bc[3].value, 3000) == 3.25e6);
  assert_true(c.scene.bc[4].type == BC_PRESSURE && c.scene.bc[4].initial && c.scene.bc[4].value.n == 0);
  GOOD(CaseDestroy(&c));
}

static void command_line_wins(void **state)
{
  static const char *const option[][2] = {
      {"-mat_sediment_porosity", "0.2"}, {"-mat_sediment_kinetics_active", "no"},
      {"-grid_cells", "104,2"},          {"-region_column_pressure", "3 MPa"},
      {"-bc_load_normal", "5 MPa"},      {"-stepper_dt", "0.5"},
      {"-output_dir", "elsewhere"},      {"-stepper_type", "euler"},
  };
  Case c;
  bool ok;

  (void)state;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    set_option(option[i][0], option[i][1]);
  GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    GOOD(PetscOptionsClearValue(NULL, option[i][0]));
  assert_true(ok);
  assert_true(c.scene.material[0].porosity == 0.2 && c.scene.material[0].permeability.phi0 == 0.2 &&
              !c.scene.material[0].reacts);
  assert_true(c.scene.cells[0] == 104 && c.scene.cells[1] == 2 && c.scene.region[0].pressure == 3e6 && c.dt == 0.5);
  assert_true(c.scene.bc[3].value.n == 1 && c.scene.bc[3].value.y[0] == 5e6);
  assert_string_equal(c.output_dir, "elsewhere");
  assert_int_equal(c.integrator, INTEGRATOR_EULER);
  GOOD(CaseDestroy(&c));
}

/* Methane dissolves (352) in sediment without gas, not for a region that names a place. */
static void place_without_gas(void **state)
{
  static const char *const option[][2] = {
      {"-regions", "column,spot"},       {"-region_spot_lower", "0.1 m,0 m"}, {"-region_spot_upper", "0.2 m,0.02 m"},
      {"-region_spot_material", "none"}, {"-probes", "p06,surface,mean"},     {"-probe_mean_over", "spot"}};
  Case c;
  bool ok;

  (void)state;
  for (int gas = 1; gas >= 0; gas--) {
    for (size_t i = 0; i < sizeof option / sizeof *option; i++)
      set_option(option[i][0], option[i][1]);
    set_option("-region_column_Sw", gas ? "0.6" : "1");
    set_option("-region_column_Sg", gas ? "0.4" : "0");
    GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
    for (size_t i = 0; i < sizeof option / sizeof *option; i++)
      GOOD(PetscOptionsClearValue(NULL, option[i][0]));
    GOOD(PetscOptionsClearValue(NULL, "-region_column_Sw"));
    GOOD(PetscOptionsClearValue(NULL, "-region_column_Sg"));
    assert_true(ok && c.scene.nregion == 2 && c.scene.region[1].material < 0);
    assert_true(gas ? c.scene.material[0].gas.trace == 0.0
                    : c.scene.material[0].gas.carried == GAS_SOLUBILITY * c.scene.material[0].gas.M);
    GOOD(CaseDestroy(&c));
  }
}

/* What an instance does not give is that of the one it is like, through a chain, the command line over the file. */
static void like(void **state)
{
  static const char *const option[][2] = {
      {"-materials", "silt,sediment,clay"},
      {"-mat_clay_like", "sediment"},
      {"-mat_silt_like", "clay"},
      {"-mat_clay_porosity", "0.4"},
      {"-mat_clay_kinetics_active", "no"},
      {"-mat_silt_permeability_hydrate_law", "masuda_ramp"},
      {"-mat_silt_permeability_kh", "0.2"},
      {"-mat_silt_permeability_Shc", "0.3"},
      {"-mat_sediment_solid_density", "2700 kg/m^3"},
      {"-regions", "column,plug,hole"},
      {"-region_column_upper", "0.5 m,0.02 m"},
      {"-region_column_lower", "0.1 m,0 m"},
      {"-region_column_minus", "hole"},
      {"-region_plug_like", "column"},
      {"-region_plug_lower", "0.5 m,0 m"},
      {"-region_plug_upper", "1 m,0.02 m"},
      {"-region_plug_material", "silt"},
      {"-region_plug_pressure", "3 MPa"},
      {"-region_hole_like", "column"}, /* which says nothing of a region without particles */
      {"-region_hole_material", "none"},
      {"-region_hole_lower", "0.1 m,0 m"},
      {"-region_hole_upper", "0.2 m,0.02 m"},
  };
  Case            c, same;
  bool            ok;
  const Material *m;
  const Region   *g;

  (void)state;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    set_option(option[i][0], option[i][1]);
  GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
  assert_true(ok);
  set_option("-mat_silt_like", "none"); /* then it says too little */
  GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &same, &ok));
  assert_false(ok);
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    GOOD(PetscOptionsClearValue(NULL, option[i][0]));
  m = c.scene.material;
  for (int i = 0; i < 3; i++) {
    assert_true(m[i].solid.rho0 == 2700 && m[i].retention.m == 0.3 && m[i].elasticity.E0 == 9e7);
    assert_true(m[i].porosity == (i == 1 ? 0.15 : 0.4) && m[i].reacts == (i == 1));
    assert_true(m[i].permeability.phi0 == m[i].porosity); /* a default of its own */
    assert_string_equal(m[i].permeability.hydrate_type, i ? "power" : "masuda_ramp");
  }
  g = &c.scene.region[1];
  assert_true(g->material == 0 && g->pressure == 3e6 && g->temperature == 4 && g->Sw == 0.6 && g->Sg == 0.4);
  assert_true(g->lower[0] == 0.5 && g->minus.n == 0 && c.scene.region[0].minus.n == 1 &&
              c.scene.region[2].material == -1);
  GOOD(CaseDestroy(&c));
}

/* What a stage names, else what the case names, else the default with the stage's own length. */
static void stages(void **state)
{
  static const char *const option[][2] = {
      {"-stages", "settle,slide"},
      {"-stage_settle_end", "500 s"},
      {"-stage_slide_end", "2000 s"},
      {"-stage_slide_stepper_type", "hybrid"},
      {"-stage_settle_inertia", "no"},
      {"-stage_settle_stepper_tol", "0.1"},
      {"-stage_slide_boundaries_off", "load"},
      {"-stage_settle_kinetics_active", "no"},
      {"-bc_drain_clock", "stage"},
      {"-gravity", "0 m/s^2,-9.81 m/s^2"},
      {"-stage_slide_gravity", "0 m/s^2,-1 m/s^2"},
      {"-stepper_tol", "0.02"},
  };
  Case        c;
  bool        ok;
  const Case *a, *b;

  (void)state;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    set_option(option[i][0], option[i][1]);
  GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
  for (size_t i = 0; i < sizeof option / sizeof *option; i++)
    GOOD(PetscOptionsClearValue(NULL, option[i][0]));
  assert_true(ok && c.nstage == 2);
  a = CaseInStage(&c, 0);
  b = CaseInStage(a, 1);
  assert_true(a->scene.t_begin == 0 && a->t_end == 500 && b->scene.t_begin == 500 && b->t_end == 2000 &&
              c.t_end == 2000);
  assert_true(!a->scene.inertia && !a->scene.fields.inertia && b->scene.inertia && b->scene.fields.inertia &&
              b->scene.fields.n == a->scene.fields.n);
  assert_int_equal(a->integrator, INTEGRATOR_SDIRK2);
  assert_int_equal(b->integrator, INTEGRATOR_HYBRID);
  assert_true(a->tol == 0.1 && b->tol == 0.02 && a->dt == 1 && b->dt == 1 && b->dt_max == 50);
  assert_true(a->dt_min == 1e-9 * 500 && b->dt_min == 1e-9 * 1500);
  assert_true(a->scene.nbc == 5 && b->scene.nbc == 4 && b->scene.bc[3].type == BC_PRESSURE && c.scene.nbc == 5);
  assert_true(a->scene.bc[4].zero == 0 && b->scene.bc[3].zero == 500 && b->scene.bc[0].zero == 0);
  assert_true(a->scene.material[0].kinetics.K0 == 0 && a->scene.material[0].reacts &&
              b->scene.material[0].kinetics.K0 == 2.5e-10);
  assert_true(a->scene.gravity_before[1] == 0 && b->scene.gravity_before[1] == -9.81 && b->scene.gravity[1] == -1);
  GOOD(CaseDestroy(&c));
}

static void refused(void **state)
{
  static const char *const option[][2] = {{"-mat_sediment_porosty", "0.2"}, {"-region_column_Sw", "0.7"}};
  Case                     c;
  bool                     ok;

  (void)state;
  for (size_t i = 0; i < sizeof option / sizeof *option; i++) {
    set_option(option[i][0], option[i][1]);
    GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
    GOOD(PetscOptionsClearValue(NULL, option[i][0]));
    assert_false(ok);
    assert_true(c.scene.nmaterial == 0 && !c.scene.material);
  }
  GOOD(CaseRead(PETSC_COMM_WORLD, "/no/such/case", &c, &ok));
  assert_false(ok);
}

static void nearest_key(void **state)
{
  Case c;
  bool ok;
  char nearest[256];

  (void)state;
  assert_int_equal(EditDistance("kitten", "sitting"), 3);
  assert_int_equal(EditDistance("Porosity", "porosity"), 0);
  GOOD(CaseRead(PETSC_COMM_WORLD, bp2, &c, &ok));
  assert_true(KeyNearest(&c, "mat_sedimnt_porosity", nearest, sizeof nearest));
  assert_string_equal(nearest, "mat_sediment_porosity");
  assert_true(KeyNearest(&c, "bc_load_normal_tabel", nearest, sizeof nearest));
  assert_string_equal(nearest, "bc_load_normal_table");
  assert_true(KeyNearest(&c, "materails", nearest, sizeof nearest));
  assert_string_equal(nearest, "materials");
  assert_false(KeyNearest(&c, "wavelength", nearest, sizeof nearest));
  assert_true(KeyOwned(&c, "mat_sediment_colour") && KeyOwned(&c, "grid_size") && KeyOwned(&c, "regoin_column_Sh"));
  assert_false(KeyOwned(&c, "mat_mumps_icntl_14") || KeyOwned(&c, "stepper_newton_max") || KeyOwned(&c, "ksp_type"));
  GOOD(CaseDestroy(&c));
}

/* ---------------------------------------------------------------- resolved case */
static void same_schedule(const Key *k, const Schedule *a, const Schedule *b)
{
  size_t bytes = (size_t)a->n * sizeof(double);

  if (a->n != b->n || a->steps != b->steps || (bytes && (memcmp(a->t, b->t, bytes) || memcmp(a->y, b->y, bytes))))
    fail_msg("schedule %s differs", k->name);
}

static void same_key(const Case *a, const Case *b, Group g, PetscInt i, const Key *k)
{
  const char *pa = GroupInstance(a, g, i) + k->offset, *pb = GroupInstance(b, g, i) + k->offset;
  bool        same = true;

  if (k->kind == KEY_REAL)
    same = !memcmp(pa, pb, (size_t)k->count * sizeof(double));
  else if (k->kind == KEY_INT)
    same = !memcmp(pa, pb, (size_t)k->count * sizeof(PetscInt));
  else if (k->kind == KEY_CHOICE || k->kind == KEY_NAME)
    same = *(const int *)pa == *(const int *)pb;
  else if (k->kind == KEY_BOOL)
    same = *(const bool *)pa == *(const bool *)pb;
  else if (k->kind == KEY_TEXT)
    same = !strcmp(pa, pb);
  else if (k->kind == KEY_LAW)
    same = k->law->get((const Material *)(pa - k->offset)) == k->law->get((const Material *)(pb - k->offset));
  else if (k->kind == KEY_SCHEDULE)
    same_schedule(k, (const Schedule *)pa, (const Schedule *)pb);
  else
    same = a->ntimes == b->ntimes && (!a->ntimes || !memcmp(a->times, b->times, (size_t)a->ntimes * sizeof(double)));
  if (!same)
    fail_msg("%s differs", k->name);
}

static void round_trip(const char *path, const char *resolved)
{
  Case        a, b;
  bool        ok;
  PetscMPIInt rank;

  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  GOOD(CaseRead(PETSC_COMM_WORLD, path, &a, &ok));
  assert_true(ok);
  if (rank == 0) {
    FILE *f = fopen(resolved, "w");

    assert_non_null(f);
    GOOD(CaseWriteResolved(&a, f));
    assert_int_equal(fclose(f), 0);
  }
  GOOD(MPI_Barrier(PETSC_COMM_WORLD));
  GOOD(CaseRead(PETSC_COMM_WORLD, resolved, &b, &ok));
  assert_true(ok);
  for (Group g = GROUP_CASE; g < GROUP_COUNT; g++) {
    PetscInt n = g == GROUP_CASE ? 1 : *GroupCount(&a, g);
    if (g != GROUP_CASE)
      assert_int_equal(n, *GroupCount(&b, g));
    for (PetscInt i = 0; i < n; i++) {
      if (g != GROUP_CASE)
        assert_string_equal(GroupInstance(&a, g, i), GroupInstance(&b, g, i));
      for (const Key *k = case_group[g].key; k->name; k++)
        same_key(&a, &b, g, i, k);
    }
  }
  for (PetscInt i = 0; i < a.scene.nmaterial; i++) {
    const Material *m = &a.scene.material[i], *n = &b.scene.material[i];
    assert_memory_equal(&m->solid, &n->solid, sizeof m->solid);
    assert_memory_equal(&m->hydrate, &n->hydrate, sizeof m->hydrate);
    assert_memory_equal(&m->retention, &n->retention, sizeof m->retention);
    assert_memory_equal(&m->kinetics, &n->kinetics, sizeof m->kinetics);
  }
  GOOD(CaseDestroy(&a));
  GOOD(CaseDestroy(&b));
}

/* Awkward numbers in awkward units, every form of a schedule, two of each thing. */
static void write_awkward(const char *path)
{
  static const char *const material =
      "    porosity: 33.3 %\n"
      "    solid: {density: 2.65 g/cm^3, heat_capacity: 0.8 kJ/(kg degC), conductivity: 3.3 W/(m K), expansion: 1e-5 "
      "1/K}\n"
      "    water: {bulk_modulus: incompressible, viscosity: 1.1 cP, ref_temperature: 288.3 K, ref_pressure: 1 atm}\n"
      "    relperm: {nw: 0.7, ng: 3.1, Swr: 0.1}\n"
      "    permeability: {k0: 3.3 mD, hydrate_law: masuda_ramp, porosity_law: none, kh: 0.01, Shc: 0.7}\n"
      "    elasticity: {E0: 0.123456789012345678 GPa, nu: 0.1, stiffness_change: loss_only}\n";
  FILE *f = fopen(path, "w");

  assert_non_null(f);
  fputs("title: 'it''s, \"a\" title: # with everything'\n"
        "grid: {lower: [-10 cm, 0 m], upper: [70 cm, 0.3 m], cells: [8, 3]}\n"
        "gravity: [0 m/s^2, -9.81 m/s^2]\nmaterials: [sand, Clay_2]\nmat:\n",
        f);
  for (int i = 0; i < 2; i++) {
    fprintf(f, "  %s:\n%s", i ? "Clay_2" : "sand", material);
    fputs(i ? "    retention: {law: brooks_corey, p0: 7.7 kPa, lambda: 1.7, Swr: 0.1, Sgr: 0}\n"
            : "    retention: {p0: 3.3333333333333333 kPa, m: 0.77, Swr: 0.05, Sgr: 0.01, p_smooth: 11 Pa}\n",
          f);
  }
  fputs(
      "regions: [low, high]\nregion:\n"
      "  low: {lower: [0 m, 0 m], upper: [0.6 m, 0.1 m], material: clay_2, pressure: 1.1 bar, temperature: 280.1 K,\n"
      "    Sw: 0.7, Sg: 30 %, hydrostatic: yes, datum: 0.31 m, stress: [-1 kPa, -2 kPa, -1.1 kPa, 0 Pa, 0 Pa, 0 Pa]}\n"
      "  high: {lower: [0 m, 0.1 m], upper: [0.6 m, 0.25 m], material: sand, pressure: 0.3 MPa, temperature: 3.7 "
      "degC,\n"
      "    particles_per_cell: [3, 1], Sh: 0.1, Sw: 0.7, Sg: 0.2}\n"
      "boundaries: [a, b, c, d, e, f, g, h, i]\nbc:\n"
      "  a: {type: traction, side: top, region: high, from: 0.1 m, to: 0.2 m, normal: {ramp: [0 Pa, 1.1 MPa, 1 s, 7 "
      "min]},\n"
      "    shear: {rate: [1 Pa, 0.1 kPa/h, 0 s, 3.3 h]}}\n"
      "  b: {type: convection, side: left, alpha: 25 W/(m^2 K), ambient: {piecewise: [0 s, 280 K, 10 s, 281.3 K]}}\n"
      "  c: {type: pressure, side: right, from: 0.01 m, pressure: {table: [0 s, 1 bar, 0.1 d, 2 bar, 1 d, 1.5 bar]}}\n"
      "  d: {type: plate, axis: y, position: 10 cm, velocity: -1.1e-4 mm/min}\n"
      "  e: {type: temperature, axis: x, position: -0.1 m, temperature: {piecewise: [3 s, 1.1 degC]}}\n"
      "  f: {type: heat_flux, side: bottom, flux: 1 mW/cm^2}\n"
      "  g: {type: face_temperature, side: bottom, to: 0.3 m, temperature: 275.4 K}\n"
      "  h: {type: plate, side: right, force: {table: [[0 s, 1 kN], [0.2 d, 3.3 kN]]}, rough: yes, holds: skeleton}\n"
      "  i: {type: plate, side: left, region: low, displacement: {ramp: [0 m, -1.1 mm, 0 s, 1 h]}, separates: yes,\n"
      "    stiffness: 330}\n"
      "time: {end: 0.7 d}\noutput: {times: [0.1 h, 1.7 h], every: 1.1 h, dir: 'a \"strange\" dir'}\n"
      "checkpoint: {every: 0.3 h}\nstepper: {tol: 1.1e-4}\n",
      f);
  fclose(f);
}

static void resolved_is_the_same_case(void **state)
{
  char folder[PETSC_MAX_PATH_LEN] = "/tmp/clathra_test_XXXXXX", in[PETSC_MAX_PATH_LEN + 32],
       out[PETSC_MAX_PATH_LEN + 32];
  PetscMPIInt rank;

  (void)state;
  MPI_Comm_rank(PETSC_COMM_WORLD, &rank);
  if (rank == 0)
    assert_non_null(mkdtemp(folder));
  GOOD(MPI_Bcast(folder, sizeof folder, MPI_CHAR, 0, PETSC_COMM_WORLD));
  snprintf(in, sizeof in, "%s/case.yaml", folder);
  snprintf(out, sizeof out, "%s/resolved.yaml", folder);
  round_trip(bp2, out);
  if (rank == 0)
    write_awkward(in);
  GOOD(MPI_Barrier(PETSC_COMM_WORLD));
  round_trip(folder, out);
  if (rank == 0) {
    unlink(in);
    unlink(out);
    rmdir(folder);
  }
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(units_to_si),
      cmocka_unit_test(units_refused),
      cmocka_unit_test(schedule_values),
      cmocka_unit_test(parsed),
      cmocka_unit_test(read_bp2),
      cmocka_unit_test(like),
      cmocka_unit_test(stages),
      cmocka_unit_test(refused),
      cmocka_unit_test(nearest_key),
      cmocka_unit_test(command_line_wins),
      cmocka_unit_test(resolved_is_the_same_case),
      cmocka_unit_test(place_without_gas),
  };
  const char *up = strstr(__FILE__, "tests/unit/");

  snprintf(bp2, sizeof bp2, "%.*scases/bp2", (int)(up - __FILE__), __FILE__);
  return RunTests(argc, argv, tests, NULL, NULL);
}
