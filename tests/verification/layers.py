#!/usr/bin/env python3
"""Flow along and across layers whose permeabilities differ 50,000-fold, against the exact one.

Flow along and across layers of sand and clay whose permeabilities differ 50,000-fold (350), and of one sand that hydrate has choked in two of
them: exact along them wherever grid lines are, across them on grid lines and to the first order where borders cut cells, in implicit steps and in hybrid's; a well in a layer against Thiem; the
paper's bare form says what it lacks."""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, order, table

CASES = Path(__file__).parent / "cases"
LAYERS, WELL = CASES / "layers.yaml", CASES / "layered_well.yaml"
ROW = "layers"
SAND, CLAY, MU, RHO = 5e-13, 1e-17, 1e-3, 1000.0
ALONG = RHO * 1e6 / 6 * (SAND + 2 * CLAY) / MU  # kg/(s m): 1 MPa over 6 m, layers of 1 m
ACROSS = RHO * 1e6 * 6 / (1 / SAND + 2 / CLAY) / MU
UP = ("-bc_in_side", "bottom", "-bc_out_side", "top", "-meter_in_side", "bottom", "-meter_out_side", "top")
UPRIGHT = [f"-region_{name}_{end}={x} m,{y} m" for k, name in enumerate(("lower", "layer", "upper")) for end, x, y in (("lower", k, 0), ("upper", k + 1, 6))]
TURNED = ("-grid_upper", "3 m,6 m", *(word for option in UPRIGHT for word in option.split("=")))
SHIFTED = ("-grid_lower", "-0.13 m,-0.17 m", "-grid_upper", "6.37 m,3.33 m", "-grid_cells", "13,7")


# one sand, of whose pores hydrate fills a share in the outer layers: k_a = k0 (1 - S_h)^4 there
choked = lambda Sh: ("-mat_sand_permeability_hydrate_law", "power", "-mat_sand_permeability_mh", "4", "-region_lower_material", "sand", "-region_layer_Sh", "0",
                     *(word for layer in ("lower", "upper") for word in (f"-region_{layer}_Sh", f"{Sh}")))  # fmt: skip
left = lambda Sh: SAND * (1 - Sh) ** 4


def rate(case, meter, *options):
    run = Run.of_case(case, "-quiet", *options)
    return abs(run.csv("meters.csv")[f"{meter}.water_kg_s"][-1])


rows = []
for name, options, exact, bar in (("along layers", (), ALONG, 1e-10), ("along layers, particles of two layers in a cell", SHIFTED, ALONG, 1e-10),
                                  ("along layers, axes swapped", (*TURNED, *UP), ALONG, 1e-10), ("along layers, sdirk2 and inertia", ("-stepper_type", "sdirk2", "-inertia", "yes"), ALONG, 1e-6),
                                  ("across layers", UP, ACROSS, 1e-8), ("across layers, axes swapped", TURNED, ACROSS, 1e-8),
                                  *((f"along layers choked to {(1 - Sh) ** 4:g} by hydrate{words}", (*choked(Sh), *options), RHO * 1e6 / 6 * (SAND + 2 * left(Sh)) / MU, 1e-10)
                                    for Sh, words, options in ((0.5, "", ()), (0.9, "", ()), (0.5, ", axes swapped", (*TURNED, *UP)), (0.5, ", particles of two layers in a cell", SHIFTED))),
                                  ("across layers choked by hydrate", (*choked(0.5), *UP), RHO * 1e6 * 6 / (1 / SAND + 2 / left(0.5)) / MU, 1e-8)):  # fmt: skip
    found = rate(LAYERS, "out", *options)
    rows.append((name, found, exact))
    judge(ROW, f"{name}: flow", abs(found / exact - 1), bar)
table(("water, kg/(s m)", "found", "exact"), rows)

# borders that cut cells (447): off in the first order of h, a third too much without it
BORDERS = lambda low, high, x=6: [w for region, end, at in (("lower", "upper", low), ("layer", "lower", low), ("layer", "upper", high), ("upper", "lower", high)) for w in (f"-region_{region}_{end}", f"{x if end == 'upper' else 0} m,{at} m")]
AXES = lambda options: [",".join(reversed(w.split(","))) if "," in w else w for w in options]
for name, cells, low, high, bar in (("in the middle of cells", "2,6", 1.25, 2.25, 0.08), ("in the middle of cells, axes swapped", "6,2", 1.25, 2.25, 0.08), ("a fifth of a cell off", "2,6", 1.1, 2.1, 0.065),
                                    ("a fifth of a cell off, half the cells", "2,12", 1.1, 2.1, 0.045), ("beside sand of less than a cell", "2,12", 1.4, 1.6, 0.035)):  # fmt: skip
    options = (*TURNED, *AXES(BORDERS(low, high))) if "swapped" in name else (*UP, *BORDERS(low, high))
    exact = RHO * 1e6 * 6 / ((high - low) / SAND + (3 - high + low) / CLAY) / MU
    judge(ROW, f"across layers, borders {name}: flow", abs(rate(LAYERS, "out", *options, "-grid_cells", cells) / exact - 1), bar)

thiem = 2 * np.pi * SAND * 4 * RHO / MU * 6e6 / np.log(20.1 / 0.1)
cells = (11, 22, 44)
off = [abs(rate(WELL, "well", "-grid_cells", f"{n},{13 * n // 11}", "-mat_sand_water_bulk_modulus", "1e20 Pa", "-mat_clay_water_bulk_modulus", "1e20 Pa") / thiem - 1) for n in cells]
table(("cells", "off Thiem", "order"), [(n, o, "-" if k == 0 else f"{-order(cells, off)[k - 1]:.2f}") for k, (n, o) in enumerate(zip(cells, off))])
for n, o, bar in zip(cells, off, (0.06, 0.02, 0.01)):
    judge(ROW, f"well in 4 m of sand between clays, cells of {22 / n:g} x {11 / n:.2g} m: rate", o, bar, 0.01, "%")

# hybrid: as exact where a step is long beside rho k0/mu.  It has to come to rest: water of 0.1 GPa in the sand, and in the clay so much stiffer that both do at once;
# across them a contrast of 20, as the sand's water must pass the clay.  Faces on the sand alone act on its particles' own pressures, which nodes do not see: 1 %.
HYBRID = ("-stepper_type", "hybrid", "-inertia", "yes", "-stepper_adapt", "yes", "-stepper_dt", "0.1 s", "-region_lower_pressure", "101325 Pa", "-bc_in_pressure", "101825 Pa",
          "-bc_out_pressure", "100825 Pa")  # fmt: skip
until = lambda t, clay: (*HYBRID, "-time_end", f"{t} s", "-output_times", f"{t} s", "-mat_sand_water_bulk_modulus", "1e8 Pa", "-mat_clay_water_bulk_modulus", f"{clay} Pa")
THIN = ("-grid_upper", "1 m,3 m", "-grid_cells", "2,6", *(f(k) for k, name in enumerate(("lower", "layer", "upper")) for f in (lambda k, n=name: f"-region_{n}_upper", lambda k: f"1 m,{k + 1} m")))
CLAY_20 = 0.05 * SAND
# the outer layers are of sand at first, of something half as permeable from 100 s on
LATER = ("-mat_clay_permeability_k0", f"{0.5 * SAND} m^2", "-region_lower_material", "sand", "-region_upper_material", "sand", "-stages", "alike,layers", "-stage_alike_end", "100 s",
         "-stage_layers_end", "4000 s", "-stage_layers_materials", "lower,clay,upper,clay")  # fmt: skip
rows = []
for name, options, exact, bar in (("along layers", until(2500, 5e12), ALONG, 1e-10),
                                  ("along layers, particles of two layers in a cell", (*until(2500, 5e12), *SHIFTED), ALONG, 1e-6),
                                  ("along layers, axes swapped", (*until(2500, 5e12), *TURNED, *UP), ALONG, 1e-10),
                                  ("along layers, in and out through the sand alone", (*until(2500, 5e12), *(w for b in ("in", "out") for w in (f"-bc_{b}_from", "1 m", f"-bc_{b}_to", "2 m"))), ALONG, 0.02),
                                  ("along layers from a stage on", (*until(4000, 1e8), *LATER), 2 * RHO * 1e6 / 6 * SAND / MU, 1e-8),
                                  ("along layers choked to 1/16 by hydrate", (*until(2500, 1e8), *choked(0.5)), RHO * 1e6 / 6 * (SAND + 2 * left(0.5)) / MU, 1e-8),
                                  ("across layers choked to 1/16 by hydrate", (*until(2500, 1e8), *choked(0.5), *THIN, *UP), RHO * 1e6 / (1 / SAND + 2 / left(0.5)) / MU, 1e-8),
                                  ("across layers", (*until(8000, 2e8), *THIN, *UP, "-mat_clay_permeability_k0", f"{CLAY_20} m^2"), RHO * 1e6 / (1 / SAND + 2 / CLAY_20) / MU, 1e-8)):  # fmt: skip
    found = 1e3 * rate(LAYERS, "out", *options)
    rows.append((name, found, exact))
    judge(ROW, f"hybrid, {name}: flow", abs(found / exact - 1), bar)
table(("hybrid: water per MPa, kg/(s m)", "found", "exact"), rows)
off = (*THIN, *BORDERS(1.25, 2.25, 1), *UP, "-mat_clay_permeability_k0", f"{CLAY_20} m^2")
judge(ROW, "hybrid against euler, across layers, borders in the middle of cells: flow", abs(1e3 * rate(LAYERS, "out", *until(8000, 2e8), *off) / rate(LAYERS, "out", *off) - 1), 1e-5)

bare = Run.of_case(LAYERS, "-quiet", *until(1, 1e8), "-stepper_type", "hybrid_paper", "-stepper_max_steps", 1)
check_true("the paper's bare form warns of layers", "permeability of the regions differs by a factor of 5e+04" in bare.output, bare.output[:300])
finish()
