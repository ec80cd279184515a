/* initial: initial states that are to be in balance with gravity. */
#include "case_private.h"
#include "clathra/particles.h"
#include "clathra/shape.h"

#define FAIL(region, key, ...) FAIL_AT(GROUP_REGION, region, key, __VA_ARGS__)

/* Pressure at the top must stay positive. */
static void CheckHydrostatic(Reader *r, const Scene *c, const Region *g)
{
  double lowest, x[CL_DIM];

  if (SceneGravity(c) == 0.0) {
    FAIL(g->name, "hydrostatic", "is yes but gravity is zero");
    return;
  }
  RegionExtreme(c, g, 1.0, x);
  lowest = InitialWaterPressure(c, g, g->pressure, x);
  if (!(lowest > 0.0))
    FAIL(g->name, "datum", "makes the pressure %g Pa at the top; it must be positive", lowest);
}

static void CheckGeothermal(Reader *r, const Scene *c, const Region *g)
{
  double coldest = INFINITY, x[CL_DIM];

  if (!(c->fields.has & HAS_HEAT)) {
    FAIL(g->name, "geothermal", "needs heat, which is not among the fields of the scene (%s)",
         CaseOf(c)->fields_wanted);
    return;
  }
  if (SceneGravity(c) == 0.0) {
    FAIL(g->name, "geothermal", "is given but gravity, which says where depth is, is zero");
    return;
  }
  for (int sign = -1; sign <= 1; sign += 2) {
    RegionExtreme(c, g, sign, x);
    coldest = fmin(coldest,
                   g->temperature + g->geothermal * fmax(SceneDatum(c, g->geothermal_datum) - SceneHeight(c, x), 0.0));
  }
  if (coldest <= -CL_ZERO_CELSIUS)
    FAIL(g->name, "geothermal", "makes the temperature %g degC at its top or foot", coldest);
}

static void CheckGeostatic(Reader *r, const Scene *c, const Region *g)
{
  const char *key    = g->consolidated ? "stress_normally_consolidated" : "stress_geostatic";
  bool        listed = false;

  for (int s = 0; s < 6; s++)
    listed = listed || g->stress[s] != 0.0;
  if (listed)
    FAIL(g->name, key, "and a list of stresses are both given; choose one");
  if (g->consolidated && g->K0 > 0.0 && !isinf(g->K0))
    FAIL(g->name, key, "and stress_geostatic are both given; choose one");
  if (!(c->fields.has & HAS_SOLID))
    FAIL(g->name, key, "needs solid, which is not among the fields of the scene (%s)", CaseOf(c)->fields_wanted);
  if (SceneGravity(c) == 0.0)
    FAIL(g->name, key, "is given but gravity is zero");
  if (c->gravity_ramp > 0.0)
    FAIL(g->name, key, "is in balance with gravity, but gravity_ramp makes it start from zero; choose one");
  if (g->consolidated && isnan(RegionK0(c, g)))
    FAIL(g->name, key, "needs a friction angle, which material %s has not; give stress_geostatic: K0",
         c->material[g->material].name);
}

void CheckInitial(Reader *r, const Scene *c, const Region *g)
{
  if (g->hydrostatic && c->fields.fluid)
    CheckHydrostatic(r, c, g);
  if (g->geothermal != 0.0)
    CheckGeothermal(r, c, g);
  if (RegionGeostatic(g))
    CheckGeostatic(r, c, g);
}
