/* keys_bc: boundary conditions; what a kind has for keys says TYPE. */
#include "key_rows.h"

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
static bool NeedsTemperature(const void *p)
{
  return ((const Bc *)p)->type != BC_INFLOW;
}
static bool GrowsWithDepth(const void *p)
{
  return ((const Bc *)p)->with_depth != 0.0;
}
static bool WellNeedsRadius(const void *p)
{
  return ((const Bc *)p)->value.n > 0;
}
static bool BcNeedsSide(const void *p)
{
  return !((const Bc *)p)->along.n;
}

#define BC_WORD(kind, word, ...) word,
const char *const case_bc_type[] = {CL_FACE_CONDITIONS(BC_WORD) CL_NODE_CONDITIONS(BC_WORD) NULL,
                                    CL_NODE_FORMS(BC_WORD)};
#undef BC_WORD

static const char *const axis_word[]      = {"x", "y", IN_SPACE("z", ) NULL};
static const char *const capillary_word[] = {"held", "free", NULL};
static const char *const holds_word[]     = {"all", "skeleton", NULL};
static const char *const clock_word[]     = {"run", "stage", NULL};
static const char *const phases_word[]    = {"both", "water", "gas", NULL}; /* OpenPhases */

#define TYPE(t) (1u << (t))
#define ON_FACE(kind, ...) | TYPE(BC_##kind)
#define PLANE(kind, word, has, by, term, where, doc) | ((where) == ON_PLANE ? TYPE(BC_##kind) : 0u)
enum { FACES = 0u CL_FACE_CONDITIONS(ON_FACE), PLANES = 0u CL_NODE_CONDITIONS(PLANE) CL_NODE_FORMS(PLANE) };

/* those that hold or offer a temperature, and those on the surface */
enum { WARM = TYPE(BC_FACE_TEMPERATURE) | TYPE(BC_CONVECTION) | TYPE(BC_TEMPERATURE) | TYPE(BC_REGION_TEMPERATURE) };
enum { SIDES = FACES & ~(unsigned)BC_INSIDE };

const Key bc_key[] = {
    CHOICE(Bc, "type", type, NULL, case_bc_type, "what is prescribed", .first = BC_NONE + 1),
    BOOLEAN(Bc, "clock", of_stage, "run", "its times count from the begin of the run, or of each stage",
            .choices = clock_word),
    POINTS(Bc, "along", along, "[[x, y], ...]: faces on this line, in the initial configuration, instead of a side",
           .types = SIDES & ~TYPE(BC_PLATE)),
    CHOICE(Bc, "side", side, "none", cl_side, "side of the body, moves with it",
           WHEN(BcNeedsSide, "along is not given"), .types = SIDES),
    NAME(Bc, "region", region, "all", GROUP_REGION, "one of regions, or all",
         .types = SIDES | TYPE(BC_REGION_TEMPERATURE) | TYPE(BC_HEAT_SOURCE)),
    REAL(Bc, "from", from, "m", "", "start", "only the part of the side from here ...", .word = "-start",
         .types = SIDES),
    REAL(Bc, "to", to, "m", "", "end", "... to here", .word = "end", .types = SIDES),
    REALS(Bc, CL_DIM, "at", at, "m", "", NULL,
          "place of the line at the start (in space one end of its open part); it moves with the body",
          .types = TYPE(BC_WELL)),
    IN_SPACE(REALS(Bc, CL_DIM, "end", end, "m", "", NULL, "the other end of what is open, along an axis",
                   .types = TYPE(BC_WELL)), )
        CHOICE(Bc, "axis", axis, NULL, axis_word, "axis normal to the grid plane", .types = PLANES),
    REAL(Bc, "position", position, "m", "", NULL, "coordinate of the plane; must be a grid line", .types = PLANES),
    BOOLEAN(Bc, "holds", drained, "all", "all phases, or the skeleton alone: a porous plate",
            .types = TYPE(BC_ROLLER) | TYPE(BC_FIXED) | TYPE(BC_PLATE) | TYPE(BC_PLATE_LINE), .choices = holds_word),
    BOOLEAN(Bc, "rough", rough, "no", "holds the tangential displacement too", .types = TYPE(BC_PLATE)),
    BOOLEAN(Bc, "separates", separates, "no", "the body may lift off: the plate takes no tension",
            .types = TYPE(BC_PLATE)),
    REAL(Bc, "stiffness", stiffness, "", "[1,1e6]", "100",
         "of its springs, in units of constrained modulus over cell (72)", .types = TYPE(BC_PLATE)),
    BOOLEAN(Bc, "initial", initial, "no", "hold the initial p_w and p_g of each particle", .types = TYPE(BC_PRESSURE)),
    REAL(Bc, "alpha", alpha, "W/(m^2 K)", "[0,1e9]", NULL, "heat transfer coefficient", .types = TYPE(BC_CONVECTION)),
    SCHEDULE("normal", value, "Pa", "[-1e12,1e12]", NULL, TYPE(BC_TRACTION),
             "total normal stress beyond the ambient pressure, compression-positive"),
    SCHEDULE("shear", shear, "Pa", "[-1e12,1e12]", "0 Pa", TYPE(BC_TRACTION),
             "along the side's normal turned by +90 degrees"),
    SCHEDULE("p_w", phase[PHASE_W], "Pa", "(0,1e10]", "", TYPE(BC_PRESSURE), "water pressure, together with p_g"),
    SCHEDULE("p_g", phase[PHASE_G], "Pa", "(0,1e10]", "", TYPE(BC_PRESSURE), "gas pressure, together with p_w"),
    SCHEDULE("pressure", value, "Pa", "(0,1e10]", "", TYPE(BC_PRESSURE), "mean pore pressure, or the word ambient",
             WHEN(NeedsPressure, "initial is no and p_w, p_g are not given"), .word = "ambient"),
    BOOLEAN(Bc, "saturation", natural, "held",
            "capillary pressure outside, with pressure or initial: the face's initial one, or the body's own (free "
            "outflow)",
            .choices = capillary_word, .types = TYPE(BC_PRESSURE), .has = HAS_GAS),
    CHOICE(Bc, "phases", open, "both", phases_word, "fluids for which the face is open; closed for the other",
           .types = TYPE(BC_PRESSURE)),
    SCHEDULE("bottom_pressure", value, "Pa", "(0,1e10]", "", TYPE(BC_WELL), "mean pore pressure in the well"),
    REAL(Bc, "radius", radius, "m", "(0,1e3]", "none", "of the well, at most half a cell",
         WHEN(WellNeedsRadius, "bottom_pressure is given"), .word = "none", .types = TYPE(BC_WELL)),
    REAL(Bc, "skin", skin, "", "[-5,1e4]", "0", "of the well: resistance at its wall, in mu/(2 pi k) (368)",
         .types = TYPE(BC_WELL)),
    SCHEDULE("water_flow", rate[PHASE_W], "kg/s", "[-1e6,1e6]", "", TYPE(BC_WELL),
             "mass into the body per metre of thickness (in space: of all), instead of bottom_pressure"),
    SCHEDULE("gas_flow", rate[PHASE_G], "kg/s", "[-1e6,1e6]", "", TYPE(BC_WELL), "the same for gas"),
    SCHEDULE("inflow_temperature", heated, "degC", "(-273.15,1000]", "", TYPE(BC_WELL),
             "of what enters, by default the body's own"),
    SCHEDULE("water", phase[PHASE_W], "m/s", "[-1e3,1e3]", "0 m/s", TYPE(BC_INFLOW),
             "volume into the body per time and area"),
    SCHEDULE("gas", phase[PHASE_G], "m/s", "[-1e3,1e3]", "0 m/s", TYPE(BC_INFLOW), "the same for gas"),
    SCHEDULE("flux", value, "W/m^2", "[-1e12,1e12]", NULL, TYPE(BC_HEAT_FLUX), "into the body"),
    SCHEDULE("power", value, "W/m^3", "[-1e12,1e12]", NULL, TYPE(BC_HEAT_SOURCE),
             "heat into each m^3 that particles have at the start"),
    SCHEDULE("ambient", value, "degC", "(-273.15,1000]", NULL, TYPE(BC_CONVECTION), "temperature outside"),
    SCHEDULE("temperature", value, "degC", "(-273.15,1000]", "",
             TYPE(BC_FACE_TEMPERATURE) | TYPE(BC_TEMPERATURE) | TYPE(BC_REGION_TEMPERATURE) | TYPE(BC_INFLOW),
             "inflow: of what flows in, by default the body's own", WHEN(NeedsTemperature, "type is not inflow")),
    REAL(Bc, "with_depth", with_depth, "K/m", "[-1e4,1e4]", "0 K/m", "growth of that temperature with depth",
         .types = WARM),
    REAL(Bc, "datum", datum, "m", "", "top",
         "coordinate against gravity where the temperature is as given; top: of the body", .word = "top",
         ACTS(GrowsWithDepth, "with_depth is not 0"), .types                                     = WARM),
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
