/* keys_region: shape and initial state of a region. */
#include "key_rows.h"

static bool IsHydrostatic(const void *p)
{
  return ((const Region *)p)->hydrostatic;
}
static bool IsGeothermal(const void *p)
{
  return ((const Region *)p)->geothermal != 0.0;
}
static bool NeedsBox(const void *p)
{
  const Region *r = (const Region *)p;

  return !r->polygon.n && !r->below.n && isinf(r->circle[2]);
}

const Key region_key[] = {
    LIKE(Region, GROUP_REGION, "another region, whose keys are the defaults, but for shape and minus"),
    NAME(Region, "material", material, NULL, GROUP_MATERIAL,
         "a material, or none: to be cut out of others, for region_temperature, heat_source or a probe's mean",
         .word = "none", .shape = true),
    POINTS(Region, "polygon", polygon, "[[x, y], ...]: what this closed line goes round", .shape = true, .own = true),
    POINTS(Region, "below", below, "[[x, y], ...]: what lies under this line, down to lower", .shape = true,
           .own = true),
    REALS(Region, 3, "circle", circle, "m", "", "none, none, none", "[x, y, radius]", .word = "none", .shape = true,
          .own = true),
    REALS(Region, CL_DIM, "lower", lower, "m", "", EACH("none"),
          "lower left corner of a box, or bounds of another shape",
          WHEN(NeedsBox, "polygon, below and circle are not given"), .word = "-none", .shape = true, .own = true),
    REALS(Region, CL_DIM, "upper", upper, "m", "", EACH("none"), "upper right corner",
          WHEN(NeedsBox, "polygon, below and circle are not given"), .word = "none", .shape = true, .own = true),
    NAMES(Region, "minus", minus, GROUP_REGION, "list of regions whose shapes are cut out of this one", .own = true,
          BINDS(HAS_ALL)),
    INTEGERS(Region, CL_DIM, "particles_per_cell", ppc, "[1,10]", EACH("2"), "along " AXES_WORDS, BINDS(HAS_ALL)),
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
         "K0: vertical effective stress from the weight above, horizontal K0 times it", .word = "no"),
    BOOLEAN(Region, "stress_normally_consolidated", consolidated, "no",
            "the same with K0 = 1 - sin(friction angle of the material)"),
    BOOLEAN(Region, "hydrostatic", hydrostatic, "no", "water in balance with gravity", .has = HAS_WATER),
    REAL(Region, "datum", datum, "m", "", "0 m",
         "coordinate against gravity where the pressure is `pressure`; may lie above the body", .has = HAS_WATER,
         ACTS(IsHydrostatic, "hydrostatic is yes")),
    REAL(Region, "geothermal", geothermal, "K/m", "[-1e4,1e4]", "0 K/m", "growth of temperature with depth"),
    REAL(Region, "geothermal_datum", geothermal_datum, "m", "", "top",
         "coordinate against gravity above which it is `temperature`; top: of the body", .word = "top",
         ACTS(IsGeothermal, "geothermal is not 0")),
    {.name = NULL},
};
