/* keys: the groups of the declared key table.  A row says everything about a key: reading, range, default, resolved
   case, printed list and typo search follow from it. */
#include "key_rows.h"

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
