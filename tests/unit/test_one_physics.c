/* The physics of a particle is the same in hybrid's loops over blocks and in the implicit particle: in the middle of a
   body that strains evenly, out of equilibrium, what one short step changes on the particle must agree, the better the
   shorter the step. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "clathra/point_reaction.h"
#include "clathra/stepper.h"
#include "small_scene.h"

static const double box[2][2] = {{0.0, 0.0}, {1.5, 1.2}}; /* 15 x 15 cells */

typedef struct {
  const char *name;
  unsigned    has;
  double      pressure; /* below or above that of equilibrium, 3.3 MPa at 4 degC */
  const char *retention, *hydrate, *porosity;
  int         stiffness;
  double      bh, expansion;
  bool        of_pores, yields, compression;
  double      contrast; /* k0 of the right half over that of the left; 0: one material */
  double      ratio;    /* of permeability across beds that dip by 30 deg, in a body that falls; 0: no beds */
  double      narrows;  /* exponent of (320) */
} Variant;

/* TestChords: T varies by this share of warmer, p by this one of what keeps equilibrium with all of it; the grid begins
   so much of a cell before the body; p lacks this (Pa) of equilibrium in the middle. */
static bool   tilts;
static double warms, rises, lacks, shift;

static const Variant variants[] = {
    {"dissociates", HAS_ALL, 2.6e6, "van_genuchten", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 1.0, false, false,
     false, 0.0, 0.0, 0.0},
    {"forms", HAS_ALL, 4.8e6, "van_genuchten", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 1.0, false, false, false,
     0.0, 0.0, 0.0},
    {"other laws", HAS_ALL, 2.6e6, "brooks_corey", "masuda_ramp", "square_jacobian", STIFFNESS_LOSS_ONLY, 1.5, 30.0,
     true, false, true, 0.0, 0.0, 0.0},
    {"bonds", HAS_ALL, 2.6e6, "van_genuchten_clamped", "none", "none", STIFFNESS_BONDS, 1.0, 1.0, false, false, false,
     0.0, 0.0, 0.0},
    {"plastic", HAS_ALL, 2.6e6, "van_genuchten", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 1.0, false, true, false,
     0.0, 0.0, 0.0},
    {"one fluid", HAS_SOLID | HAS_WATER | HAS_HEAT, 3e6, "van_genuchten", "none", "kozeny_carman", STIFFNESS_BOTH, 1.0,
     30.0, false, false, true, 0.0, 0.0, 0.0},
    {"narrow pores", HAS_ALL, 2.6e6, "van_genuchten", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 30.0, false, false,
     false, 0.0, 0.0, 2.0},
    {"narrow pores fill", HAS_ALL, 4.8e6, "brooks_corey", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 30.0, false,
     false, false, 0.0, 0.0, 2.0},
    {"rigid", HAS_WATER | HAS_GAS | HAS_HEAT, 2.6e6, "van_genuchten", "power", "none", STIFFNESS_BOTH, 1.0, 1.0, false,
     false, true, 0.0, 0.0, 0.0},
    {"layers", HAS_ALL, 2.6e6, "van_genuchten", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 1.0, false, false, false,
     1e3, 0.0, 0.0},
    {"wet layers", HAS_SOLID | HAS_WATER | HAS_HEAT, 3e6, "van_genuchten", "none", "kozeny_carman", STIFFNESS_BOTH, 1.0,
     1.0, false, false, false, 1e-3, 0.0, 0.0},
    {"beds", HAS_ALL, 2.6e6, "van_genuchten", "power", "kozeny_carman", STIFFNESS_BOTH, 1.0, 1.0, false, false, false,
     0.0, 0.1, 0.0},
    {"wet beds", HAS_SOLID | HAS_WATER | HAS_HEAT, 3e6, "van_genuchten", "none", "kozeny_carman", STIFFNESS_BOTH, 1.0,
     1.0, false, false, false, 1e-3, 0.1, 0.0},
    {"dry", HAS_SOLID, 0.0, "van_genuchten", "power", "none", STIFFNESS_BOTH, 1.0, 1.0, false, true, false, 0.0, 0.0,
     0.0},
};

static void SetMaterial(Material *m, const Variant *v)
{
  Check(RetentionSetType(&m->retention, v->retention));
  Check(PermeabilitySetHydrateType(&m->permeability, v->hydrate));
  Check(PermeabilitySetPorosityType(&m->permeability, v->porosity));
  m->reacts            = (v->has & HAS_GAS) != 0;
  m->kinetics.K0       = 2.5e-7; /* so fast that a microsecond leaves something to compare */
  m->elasticity.change = v->stiffness;
  m->elasticity.bh     = v->bh;
  m->relperm.of_pores  = v->of_pores;
  m->retention.hydrate = v->narrows;
  m->permeability.phi0 = 0.4;
  if (v->ratio > 0.0) {
    m->permeability.ratio = v->ratio;
    m->permeability.dip   = 30.0;
  }
  m->solid.beta *= v->expansion;
  m->hydrate.beta *= v->expansion;
  if (v->of_pores) { /* "other laws" */
    Check(GasSetType(&m->gas, "peng_robinson"));
    Check(EquilibriumSetType(&m->kinetics.equilibrium, "kamath"));
    m->kinetics.equilibrium.shift = 0.5;
    m->mu_w.law                   = WATER_VISCOSITY_KESTIN;
    m->mu_g.law                   = GAS_VISCOSITY_LEE;
    m->latent.kirchhoff           = true;
    m->latent.dc                  = -300.0;
  }
  if (v->yields)
    m->plasticity = WeakPlasticity(FLOW_MENETREY_WILLAM, 0.0); /* hybrid gives the heat a step later */
}

static const double stress[6] = {-4e6, -1.2e6, -1.1e6, 0.0, 0.0, 0.0}; /* effective, Pa */
#define STEP 1e-6                                                      /* s */
#define CAPILLARY 8e4                                                  /* Pa */

/* The same state everywhere, in even motion v = L x, with fluids that move relative to the skeleton. */
static void SetState(SmallScene *s, bool slips)
{
  static const double L[2][2] = {{0.6, -0.3}, {0.9, 0.5}}, slip[3][2] = {{0.0, 0.0}, {3e-3, -2e-3}, {-4e-3, 1e-3}};
  double *const      *f = s->m.P.f;

  for (PetscInt p = 0; p < s->m.P.n; p++) {
    for (int k = 0; k < 6; k++) {
      const double *row = L[k % 2];

      if (f[P_VS + k])
        f[P_VS + k][p] =
            (f[P_VS] ? row[0] * f[P_X][p] + row[1] * f[P_X + 1][p] : 0.0) + (slips ? slip[k / 2][k % 2] : 0.0);
      if (f[P_SIG + k])
        f[P_SIG + k][p] = f[P_SIG0 + k][p] = stress[k];
    }
    if (f[P_PG]) {
      f[P_PW][p] = s->region.pressure - GasShareOf(&s->mat, CAPILLARY, s->mat.reacts ? 0.2 : 0.0) * CAPILLARY;
      f[P_PG][p] = f[P_PW][p] + CAPILLARY;
    }
    Refill(s, p, s->mat.reacts ? 0.2 : 0.0);
  }
}

static const double warmer[2] = {5.0, -3.0}; /* K/m */

/* p and T that vary evenly, out of equilibrium by little in the middle of the body. */
static void Tilt(SmallScene *s)
{
  double *const *f = s->m.P.f;
  double         d;
  const double   pe = EquilibriumPressure(&s->mat.kinetics.equilibrium, s->region.temperature, &d);

  for (PetscInt p = 0; p < s->m.P.n; p++) {
    double T = s->region.temperature, over = 0.0;

    for (int k = 0; k < CL_DIM; k++) {
      const double x = f[P_X + k][p] - 0.5 * (box[0][k] + box[1][k]);

      T += warms * warmer[k] * x;
      over += rises * d * warmer[k] * x;
      f[P_GT + k][p] = warms * warmer[k];
      f[P_GW + k][p] = f[P_GG + k][p] = rises * d * warmer[k];
    }
    f[P_T][p]  = T;
    f[P_PW][p] = pe - lacks + over - GasShareOf(&s->mat, CAPILLARY, 0.2) * CAPILLARY;
    f[P_PG][p] = f[P_PW][p] + CAPILLARY;
    for (int k = 0; k < 6; k++)
      f[P_VS + k][p] = 0.0; /* strain would change p by as much as (424) */
    Refill(s, p, 0.2);
  }
}

/* In the middle cell.  A velocity averaged to nodes is not even at the surface, which consistent masses spread inwards.
 */
static bool Inside(const SmallScene *s, PetscInt p)
{
  const double *const x[2] = {s->m.P.f[P_X], s->m.P.f[P_X + 1]};

  return x[0][p] > 0.7 && x[0][p] < 0.8 && x[1][p] > 0.56 && x[1][p] < 0.64;
}

typedef struct {
  double before[P_COUNT], change[P_COUNT];
} Held;

/* SmallScene of a variant with one step of dt to go. */
static void Make(SmallScene *s, const Variant *v, Integrator integrator, bool slips)
{
  SceneInit(s, v->has, true, false, BASIS_CPGIMP, 0.0, box[0], box[1]);
  for (int d = 0; d < CL_DIM; d++) {
    const double h = box[1][d] / 15.0;

    s->c.scene.lower[d] = -shift * h;
    s->c.scene.upper[d] = (16.0 - shift) * h;
    s->c.scene.cells[d] = 16;
  }
  SetMaterial(&s->mat, v);
  s->c.scene.fields.has |= (v->yields ? HAS_PLASTIC : 0) | (v->stiffness == STIFFNESS_BONDS ? HAS_BONDS : 0);
  s->region.pressure          = v->pressure;
  s->c.scene.compression_heat = v->compression;
  s->c.scene.gravity[0]       = v->ratio > 0.0 ? 5.0 : 0.0;
  s->c.scene.gravity[1]       = v->ratio > 0.0 ? -9.81 : 0.0;
  s->c.integrator             = integrator;
  s->c.dt = s->c.dt_max = s->c.t_end     = STEP;
  s->c.dt_min                            = 1e-3 * STEP;
  s->c.cfl                               = 0.8;
  s->c.error_exponent                    = 2.0;
  s->c.tol                               = 1.0;
  s->c.mass_scaling                      = 1.0;
  s->c.scene.stabilisation.ghost_penalty = 0.0; /* nothing to stabilise, but it reaches far */
  for (int side = 0; side < SIDE_COUNT && (v->has & HAS_SOLID); side++)
    AddFace(s, BC_TRACTION, (Side)side, v->pressure - stress[side == SIDE_YMIN || side == SIDE_YMAX], 0.0);
  if (v->contrast > 0.0)
    SceneLayers(s, 0, 0.5 * (box[0][0] + box[1][0]), v->contrast); /* they meet within the cell that is looked at */
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  s->m.solver->tol_residual = s->m.solver->tol_update = 1e-11;
  SetState(s, slips);
  if (tilts)
    Tilt(s);
}

/* What one step changes on the particles inside; returns their number on this rank.  They are of one cell, so that
   no integrator puts them in another order. */
static int Changes(const Variant *v, Integrator integrator, bool slips, Held held[4])
{
  SmallScene *s = malloc(sizeof(*s));
  Stepper     stepping;
  int         n  = 0;
  bool        ok = true;

  Make(s, v, integrator, slips);
  for (int after = 0; after < 2; after++) {
    n = 0;
    for (PetscInt p = 0; p < s->m.P.n; p++) {
      if (!Inside(s, p))
        continue;
      for (int k = 0; k < P_COUNT; k++) {
        const double now = s->m.P.f[k] ? s->m.P.f[k][p] : 0.0;

        if (after)
          held[n].change[k] = now - held[n].before[k];
        else
          held[n].before[k] = now;
      }
      n++;
    }
    if (after)
      break;
    Call(StepperCreate(&s->m, &stepping));
    Call(StepperReady(&stepping, &ok));
    Check(ok);
    Call(StepperRun(&stepping, &ok));
    Check(ok && stepping.state.step == 1);
    Call(StepperDestroy(&stepping));
  }
  SceneDestroy(s);
  free(s);
  return n;
}

/* Not compared: what the next step starts with alone, and each integrator keeps in its own way. */
static bool Compared(const ParticleVariable *q, bool slips)
{
  static const int own[] = {P_RATE, P_RATE_PG, P_RATE_T, P_RATE_SH,       P_GW,  P_GG,
                            P_GT,   P_BT,      P_KP,     P_NONLOCAL_RATE, P_HEAT};

  for (size_t k = 0; k < sizeof own / sizeof *own; k++)
    if (q->first == own[k])
      return false;
  return !slips || q->first == P_VW || q->first == P_VG;
}

/* Largest difference of the changes over all variables, relative to the change of the variable, or to 1000 m/s^2, or to
   round-off, whichever is most; and whose it is. */
static double Apart(const Variant *v, bool slips, const char **whose)
{
  Held   a[4], b[4];
  double worst = 0.0;

  const int n = Changes(v, INTEGRATOR_EULER, slips, a), m = Changes(v, INTEGRATOR_HYBRID, slips, b);

  Check(n == m);
  for (int i = 0; i < n; i++) /* the tests are of plastic particles where they should be */
    Check(!v->yields || (a[i].change[P_EPS] > 1e-4 && b[i].change[P_EPS] > 1e-4));
  *whose = "";
  for (const ParticleVariable *q = cl_particle_variable; q->name; q++) {
    for (int i = 0; i < n && Compared(q, slips); i++) {
      double size = strcmp(q->unit, "m/s") ? 1e-300 : 1e3 * STEP, off = 0.0;

      for (int k = q->first; k < q->first + q->nc; k++) {
        size = fmax(size, fmax(fabs(a[i].change[k]), STEP * fabs(a[i].before[k])));
        off  = fmax(off, fabs(a[i].change[k] - b[i].change[k]));
      }
      if (off / size > worst) {
        worst  = off / size;
        *whose = q->name;
      }
    }
  }
  return Largest(worst);
}

static void TestOnePhysics(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof(variants) / sizeof(*variants); k++) {
    const char  *whose[2];
    const double even = Apart(&variants[k], false, &whose[0]), drag = Apart(&variants[k], true, &whose[1]);

    Say("%-11s: changes of a step of %g s differ by %.1e (%s), under drag by %.1e (%s)\n", variants[k].name, STEP, even,
        whose[0], drag, whose[1]);
    Check(even < 1e-3 && drag < 2e-4);
  }
}

/* sum S_I (x_I - x_p)^2 of a particle's domain along an axis, m^2: the mean over it of what the two nodes around a
   place have. */
static double Variance(const SmallScene *s, int d, double x, double l)
{
  const double h     = (s->c.scene.upper[d] - s->c.scene.lower[d]) / (double)s->c.scene.cells[d];
  const int    parts = 2000;
  double       sum   = 0.0;

  for (int k = 0; k < parts; k++) {
    const double y = x + l * ((2.0 * k + 1.0) / parts - 1.0), place = (y - s->c.scene.lower[d]) / h,
                 xi = place - floor(place);

    sum += xi * (1.0 - xi) * h * h + (y - x) * (y - x);
  }
  return sum / parts;
}

/* p_e of a particle less its pressure, Pa. */
static double Lack(const Held *held, const Material *mat)
{
  double slope;

  return EquilibriumPressure(&mat->kinetics.equilibrium, held->before[P_T], &slope) - held->before[P_PW] -
         GasShareOf(mat, CAPILLARY, 0.2) * CAPILLARY;
}

/* (424) of a particle, Pa, by hand, where p and T are linear. */
static double ChordByHand(const Held *held, const SmallScene *s)
{
  const double T = held->before[P_T], step = 1e-3;
  double       variance = 0.0, slope[3];

  for (int d = 0; d < CL_DIM; d++)
    variance += warmer[d] * warmer[d] * Variance(s, d, held->before[P_X + d], held->before[P_L + d]);
  for (int k = 0; k < 3; k++)
    EquilibriumPressure(&s->mat.kinetics.equilibrium, T + (k - 1) * step, &slope[k]);
  const double even = s->region.temperature, near = CHORD_WITHIN * slope[1] * warms * sqrt(variance),
               off = Lack(held, &s->mat) / fmax(near, 1e-300);
  double middle;

  EquilibriumPressure(&s->mat.kinetics.equilibrium, even, &middle);
  return 0.5 * (slope[2] - slope[0]) / (2.0 * step * slope[1]) * warms * rises * middle * variance / (1.0 + off * off);
}

/* (424) by what melts: the rate is that of a body in which nothing varies.  Largest difference to that by hand, Pa;
 *most: the largest of those, Pa. */
static double ChordsOff(Integrator integrator, double T_share, double p_share, double *most)
{
  const Variant    *v = &variants[0];
  SmallScene *const s = malloc(sizeof(*s));
  Held              even[4], held[4];
  double            worst = 0.0;

  *most = warms = rises = 0.0;
  const int n           = Changes(v, integrator, false, even);
  warms                 = T_share;
  rises                 = p_share;
  Check(Changes(v, integrator, false, held) == n);
  Make(s, v, integrator, false);
  for (int i = 0; i < n; i++) {
    const double chord = ChordByHand(&held[i], s),
                 found =
                     held[i].change[P_MH] / even[i].change[P_MH] * Lack(&even[i], &s->mat) - Lack(&held[i], &s->mat);

    *most = fmax(*most, chord);
    worst = fmax(worst, fabs(found - chord));
  }
  SceneDestroy(s);
  free(s);
  *most = Largest(*most);
  return Largest(worst);
}

/* What melts follows p_e and (424) in both integrators, wherever in its cells a particle is: with all of it near
   equilibrium, less of it farther off, and nothing where T or p is the same everywhere. */
static void TestChords(void **state)
{
  static const double shifts[]    = {0.0, 0.2},
                      shares[][3] = {{1.0, 1.0, 2e3}, {1.0, 1.0, 1e4}, {0.0, 0.1, 2e4}, {0.1, 0.0, 2e4}},
                      least[]     = {1000.0, 200.0, 0.0, 0.0};

  (void)state;
  tilts = true;
  for (int k = 0; k < 16; k++) {
    const Integrator integrator = k % 2 ? INTEGRATOR_HYBRID : INTEGRATOR_EULER;
    const double    *share      = shares[k / 4];
    double           most;

    shift            = shifts[k / 2 % 2];
    lacks            = share[2];
    const double off = ChordsOff(integrator, share[0], share[1], &most);
    Say("%-6s: (424), T by %.1f, p by %.1f, %.0f Pa below equilibrium: up to %.0f Pa by hand, particles %.1f of a cell "
        "on: off by %.3g Pa\n",
        case_integrator[integrator], share[0], share[1], share[2], most, shift, off);
    Check((least[k / 4] > 0.0 ? most > least[k / 4] : most == 0.0) && off < 2.0);
  }
  tilts = false;
  shift = 0.0;
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestOnePhysics), cmocka_unit_test(TestChords)};

  return RunTests(argc, argv, tests, SolveWell, NULL);
}
