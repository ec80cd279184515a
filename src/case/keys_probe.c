/* keys_probe: what is written of points, means and parts of the surface. */
#include "key_rows.h"

static bool NeedsPlace(const void *p)
{
  const Probe *b = (const Probe *)p;

  return b->over < 0 && b->surface.side == SIDE_COUNT && !b->surface.along.n;
}
static bool MeterNeedsSide(const void *p)
{
  return !((const Meter *)p)->along.n && ((const Meter *)p)->well < 0;
}

const Key probe_key[] = {
    NAME(Probe, "over", over, "none", GROUP_REGION,
         "mean over a region's particles by volume; of a region without a material those that were in its shape first",
         .word = "none"),
    POINTS(Probe, "along", surface.along,
           "[[x, y], ...]: mean over the faces on this line in the initial configuration, by current area"),
    CHOICE(Probe, "side", surface.side, "none", cl_side, "the mean over this side of the body, by area"),
    NAME(Probe, "region", surface.region, "all", GROUP_REGION, "with side or along: one of regions, or all"),
    REAL(Probe, "from", surface.from, "m", "", "start", "with side: only the part from here ...", .word = "-start"),
    REAL(Probe, "to", surface.to, "m", "", "end", "... to here", .word = "end"),
    REALS(Probe, CL_DIM, "at", x, "m", "", EACH("none"), "a point: initial position, inside a region",
          WHEN(NeedsPlace, "over, side and along are not given"), .word = "none"),
    BOOLEAN(Probe, "fixed", fixed, "no", "a point stays in space; a mean is over what is in the region's shape now"),
    {.name = NULL},
};

const Key meter_key[] = {
    NAME(Meter, "well", well, "none", GROUP_BC, "a boundary of type well, instead of a part of the surface",
         .word = "none"),
    POINTS(Meter, "along", along, "[[x, y], ...]: faces on this line, in the initial configuration, instead of a side"),
    CHOICE(Meter, "side", side, "none", cl_side, "side of the body, moves with it",
           WHEN(MeterNeedsSide, "neither along nor well is given")),
    NAME(Meter, "region", region, "all", GROUP_REGION, "one of regions, or all"),
    REAL(Meter, "from", from, "m", "", "start", "only the part of the side from here ...", .word = "-start"),
    REAL(Meter, "to", to, "m", "", "end", "... to here", .word = "end"),
    {.name = NULL},
};
