/* The explicit integrators: balances of random states in every field set, rest, rigid motion, the stable step. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>
#include "clathra/explicit.h"
#include "small_scene.h"

static const double box[2][2] = {{0.0, 0.0}, {0.43, 0.25}};

static const struct {
  const char *name;
  unsigned    has;
} sets[] = {
    {"m", HAS_SOLID},
    {"tm", HAS_SOLID | HAS_HEAT},
    {"hm", HAS_SOLID | HAS_WATER},
    {"thm", HAS_SOLID | HAS_WATER | HAS_HEAT},
    {"hmc", HAS_SOLID | HAS_WATER | HAS_GAS},
    {"thmc", HAS_ALL},
    {"h", HAS_WATER},
    {"th", HAS_WATER | HAS_HEAT},
    {"hc", HAS_WATER | HAS_GAS},
    {"thc", HAS_WATER | HAS_GAS | HAS_HEAT},
    {"t", HAS_HEAT},
};

static const ExplicitOptions hybrid = {.drag_implicit = true, .mass_scaling = 1.0};

static SmallScene *Make(unsigned has, BasisType basis, int conditions, bool reacts)
{
  SmallScene *s = malloc(sizeof(*s));

  SceneInit(s, has, true, false, basis, 0.0, box[0], box[1]);
  s->mat.reacts = reacts && (has & HAS_GAS) && (has & HAS_WATER);
  if (conditions >= 0)
    AddConditions(s, conditions);
  Call(ModelCreate(PETSC_COMM_WORLD, &s->c.scene, &s->c.scene, &s->m));
  return s;
}

/* Steps from the present state; the sum over all ranks of what crossed the boundary. */
static StageRates Go(SmallScene *s, const ExplicitOptions *o, int steps, double share)
{
  Explicit  *e;
  StableStep limit;
  StageRates sum = {0};
  ClStatus   status;

  Call(ExplicitCreate(&s->m, o, &e));
  Call(ExplicitBegin(e, (Unseen){0.0, 0}, &status));
  Call(ExplicitStableStep(e, &limit));
  Check(status == CL_OK && limit.dt > 0.0 && limit.rules != LIMIT_NONE);
  for (int k = 0; k < steps && status == CL_OK; k++)
    Call(ExplicitStep(e, 0.0, share * fmin(limit.dt, 1.0), &sum, &status));
  if (status != CL_OK)
    Say("  %s\n", s->m.failure.why);
  Check(status == CL_OK);
  Call(ExplicitEnd(e));
  Call(ExplicitDestroy(&e));
  Call(MPI_Allreduce(MPI_IN_PLACE, &sum, sizeof(sum) / sizeof(double), MPI_DOUBLE, MPI_SUM, PETSC_COMM_WORLD));
  return sum;
}

/* Water, methane and heat of a random state with every kind of condition: what is gained is what came in, to round-off.
 */
static void TestBalances(void **state)
{
  (void)state;
  for (size_t k = 0; k < sizeof(sets) / sizeof(*sets); k++) {
    double worst[3] = {0.0};

    for (int run = 0; run < 6; run++) {
      SmallScene *s = Make(sets[k].has, (BasisType)(run / 2), run % 2, true);
      ModelTotals before, after;

      RandomHistory(s, s->mat.reacts ? 0.2 : 0.0);
      Call(ModelComputeTotals(&s->m, &before));
      const StageRates sum = Go(s, &hybrid, 3, 0.2);
      Call(ModelComputeTotals(&s->m, &after));
      worst[0] = fmax(worst[0], fabs(after.water - before.water + sum.out[PHASE_W]) / fmax(before.water, 1e-9));
      worst[1] = fmax(worst[1], fabs(after.methane - before.methane + sum.out[PHASE_G]) / fmax(before.methane, 1e-9));
      worst[2] = fmax(worst[2], fabs(sum.heat_rate - sum.heat_in - sum.heat_source) / before.capacity);
      SceneDestroy(s);
      free(s);
    }
    Say("%-4s: water %.1e, methane %.1e of what is there, heat %.1e K\n", sets[k].name, worst[0], worst[1], worst[2]);
    Check(worst[0] < 1e-13 && worst[1] < 1e-13 && worst[2] < 1e-12);
  }
}

/* Largest velocity of any phase. */
static double Fastest(const SmallScene *s)
{
  double v = 0.0;

  for (int k = P_VS; k < P_VS + 6; k++) {
    for (PetscInt p = 0; s->m.P.f[k] && p < s->m.P.n; p++)
      v = fmax(v, fabs(s->m.P.f[k][p]));
  }
  return Largest(v);
}

/* Uniform pressure between walls and a loaded, drained side stays at rest, whatever the saturation of each particle. */
static void TestRest(void **state)
{
  (void)state;
  for (int basis = 0; basis < 2; basis++) {
    SmallScene *s = Make(HAS_ALL, (BasisType)basis, -1, false);

    for (int side = 0; side < SIDE_COUNT; side++) {
      AddFace(s, BC_TRACTION, (Side)side, 3.25e6, 0.0);
      AddFace(s, BC_PRESSURE, (Side)side, 3.25e6, 0.0)->initial = true;
    }
    Call(PetscFree4(s->m.bc.value, s->m.bc.shear, s->m.bc.phase[0], s->m.bc.phase[1]));
    Call(PetscCalloc4(s->c.scene.nbc, &s->m.bc.value, s->c.scene.nbc, &s->m.bc.shear, s->c.scene.nbc, &s->m.bc.phase[0],
                      s->c.scene.nbc, &s->m.bc.phase[1]));
    for (PetscInt p = 0; p < s->m.P.n; p++)
      Refill(s, p, 0.3 * (1.0 + Noise(3, s->m.P.i[PI_ID][p], 0)));
    Go(s, &hybrid, 20, 0.5);
    /* one step of free fall under 1 MPa over a cell would give dt * 1e6/(h rho) ~ 1e-2 m/s */
    Say("at rest, %-6s: fastest %.1e m/s\n", basis_name[basis], Fastest(s));
    Check(Fastest(s) < 1e-13);
    SceneDestroy(s);
    free(s);
  }
}

/* A free body in uniform motion keeps velocity, stress and pressure. */
static void TestTranslation(void **state)
{
  SmallScene *s        = Make(HAS_SOLID | HAS_WATER, BASIS_CPGIMP, -1, false);
  double      worst[2] = {0.0};

  (void)state;
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    s->m.P.f[P_PW][p] = 0.0;
    Refill(s, p, 0.0);
    for (int k = 0; k < 4; k++)
      s->m.P.f[P_VS + k][p] = k % 2 ? 3.0 : 20.0;
  }
  Go(s, &hybrid, 40, 0.5);
  for (PetscInt p = 0; p < s->m.P.n; p++) {
    for (int k = 0; k < 4; k++)
      worst[0] = fmax(worst[0], fabs(s->m.P.f[P_VS + k][p] - (k % 2 ? 3.0 : 20.0)));
    worst[1] = fmax(worst[1], fmax(fabs(s->m.P.f[P_PW][p]), fabs(s->m.P.f[P_SIG][p])));
  }
  Say("uniform motion: velocity off by %.1e m/s, pressure and stress %.1e Pa\n", Largest(worst[0]), Largest(worst[1]));
  Check(Largest(worst[0]) < 1e-11 &&
        Largest(worst[1]) < 1e-3); /* rounding of 1e9 Pa times strain increments of 1e-16 a step */
  SceneDestroy(s);
  free(s);
}

/* Each bound scales as its formula says. */
static void TestStableStep(void **state)
{
  StableStep   limit[4];
  const double scaling[4] = {1.0, 100.0, 1.0, 1.0};

  (void)state;
  for (int k = 0; k < 4; k++) {
    SmallScene     *s = Make(HAS_SOLID | HAS_WATER | HAS_HEAT, BASIS_CPGIMP, -1, false);
    ExplicitOptions o = hybrid;
    Explicit       *e;
    ClStatus        status;

    o.mass_scaling = scaling[k];
    if (k >= 2) {
      s->mat.permeability.k0 *= 1e-3;
      o.drag_implicit = k == 2;
    }
    Call(ExplicitCreate(&s->m, &o, &e));
    Call(ExplicitBegin(e, (Unseen){0.0, 0}, &status));
    Call(ExplicitStableStep(e, &limit[k]));
    Call(ExplicitDestroy(&e));
    SceneDestroy(s);
    free(s);
  }
  Check(fabs(limit[1].each[LIMIT_WAVE] / limit[0].each[LIMIT_WAVE] - 10.0) < 1e-9); /* sqrt of the inertia */
  Check(limit[1].each[LIMIT_HEAT] == limit[0].each[LIMIT_HEAT]);
  Check(limit[0].dt <= limit[0].each[limit[0].rules] && limit[0].dt > 0.3 * limit[0].each[limit[0].rules]);
  Check(limit[3].rules == LIMIT_DRAG && limit[3].dt < 0.1 * limit[2].dt); /* hardly permeable: explicit drag rules */
}

int main(int argc, char **argv)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(TestBalances), cmocka_unit_test(TestRest),
                                     cmocka_unit_test(TestTranslation), cmocka_unit_test(TestStableStep)};

  return RunTests(argc, argv, tests, NULL, NULL);
}
