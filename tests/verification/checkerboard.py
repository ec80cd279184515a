#!/usr/bin/env python3
"""The README's own case and heaters in hydrate: saturations do not alternate.

The README's own case, on half its cells: no alternating saturations beside the end of the pressure face (365);
water and methane; two ranks.  A heater of 60 degC in
hydrate, and hot water that flows into it: none forms ahead of the front, nor does S_h alternate (381)."""
import re
from pathlib import Path

import numpy as np

from common import ROOT, binary, check_true, finish, judge, largest_difference, launch, run, scratch, table

CASES = Path(__file__).parent / "cases"
case = scratch() / "case.yaml"
case.write_text(re.search(r"```yaml\n(title: a hydrate layer is drawn down.*?)```", Path(ROOT / "README.md").read_text(), re.S)[1])
ROW, OPTIONS = 20, ("-quiet", "-grid_cells", "10,6", "-time_end", "1 h", "-output_every", "1 h")


def well(*more, **keywords):
    return run(binary(), case, *OPTIONS, *more, **keywords)


def alternation(done, quantity):
    """Largest second difference over neighbouring cells of a particle variable, and its range."""
    v = done.snapshot(3600.0)[quantity].ravel().reshape(-1, ROW)
    across, along = v[:, 4:] - 2 * v[:, 2:-2] + v[:, :-4], v[4:] - 2 * v[2:-2] + v[:-4]
    return max(np.max(np.abs(across)), np.max(np.abs(along)))


one = well()
judge("fronts", "S_w: largest second difference between cells", alternation(one, "S_w"), 0.01)
for name in ("water_error", "methane_error"):
    judge("fronts", f"{name}", np.max(np.abs(one.balance[name])), 1e-12)
two = well(ranks=2)
judge("fronts", "1 and 2 ranks: pressure", largest_difference(two.probe("middle")["p_Pa"], one.probe("middle")["p_Pa"]), 1e-7)


def heater(*more, **keywords):
    """The run, and S_h along x at its end."""
    done = run(binary(), CASES / "heater.yaml", "-quiet", *more, **keywords)
    return done, done.snapshot(done.time[-1])["S_h"].ravel().reshape(2, -1)[0]


PLACES = np.arange(11) / 10
PROBES = ["-probes", ",".join(f"x{k}" for k in range(11)), *(w for k, x in enumerate(PLACES) for w in (f"-probe_x{k}_at", f"{x:g} m,0.05 m"))]
FIELDS = lambda r, k, column: np.array([v[k].ravel() for _, v in r.snapshots()] if column is None else [r.probe(f"x{i}")[column] for i in range(11)])
hourly, S = heater("-output_every", "1 h", *PROBES)
own, seen, states, S_seen = (FIELDS(hourly, k, c) for k, c in (("T", None), ("T", "T_degC"), ("S_h", None), ("S_h", "S_h")))
print(f"S_h beside the heater: {np.round(S, 2)}")
judge("fronts", "heater: hydrate ahead of the front, beyond that far away", np.max(S) / S[-1] - 1, 0.01)
judge("fronts", "... S_h that falls towards the far end", max(np.max(-np.diff(S)), 0.0), 1e-3)
judge("fronts", "... a particle warmer than the heater or colder than the start, any hour, K", max(own.max() - 60, 10 - own.min(), 0), 0.01, 1, "K")
judge("fronts", "... a probe", max(seen.max() - 60, 10 - seen.min(), 0), 0.01, 1, "K")
judge("fronts", "... S_h of probes outside the particles' range", max(-S_seen.min(), S_seen.max() - states.max(), 0), 1e-6)
for name in ("water_error", "methane_error"):
    judge("fronts", f"... {name}", np.max(np.abs(hourly.balance[name])), 1e-12)
fine, S_fine = heater("-grid_cells", "40,1", "-output_every", "1 h")
judge("fronts", "heater: hydrate that is left, against cells of a quarter", abs(np.mean(S) / np.mean(S_fine) - 1), 0.01, 0.01, "%")
judge("fronts", "... most S_h of any hour, beyond that of cells of a quarter", states.max() - max(v["S_h"].max() for _, v in fine.snapshots()), 0.005)
one, two = (heater("-time_end", "1 h", ranks=n)[1] for n in (1, 2))
judge("fronts", "... 1 and 2 ranks, S_h", np.max(np.abs(two - one)), 1e-8)

# Hot water flows into hydrate at equilibrium: S_h = 0.4 ahead of the front.
SWAPPED = ("-grid_upper", "0.1 m,2 m", "-region_layer_upper", "0.1 m,2 m", "-bc_base_axis", "x", "-bc_top_axis", "x", "-bc_warm_axis", "y", "-bc_inlet_side", "bottom", "-bc_outlet_side", "top")
RING = ("-geometry", "axisymmetric", "-grid_lower", "0.1 m,0 m", "-grid_upper", "2.1 m,0.1 m", "-region_layer_lower", "0.1 m,0 m", "-region_layer_upper", "2.1 m,0.1 m", "-bc_warm_position", "0.1 m",
        "-bc_inlet_water", "5e-5 m/s", "-time_end", "2 d")  # fmt: skip


def hot(cells, *more):
    """Most S_h of any hour, share of the hydrate that is gone, coldest and warmest (degC)."""
    states = [v for _, v in run(binary(), CASES / "hot_water.yaml", "-quiet", "-grid_cells", cells, *more).snapshots()]
    left = states[-1]["mass_hydrate"].sum() / states[0]["mass_hydrate"].sum()
    return [max(v["S_h"].max() for v in states), 1 - left, min(v["T"].min() for v in states), max(v["T"].max() for v in states)]


plane, ring = hot("20,1"), hot("20,1", *RING)
rows = [("plane", *plane), ("axes swapped", *hot("1,20", *SWAPPED)), ("about an axis", *ring)]
rows += [(f"{n} particles along a cell", *hot("20,1", "-region_layer_particles_per_cell", f"{n},2")) for n in (1, 3, 5)]
table(("hot water into hydrate", "S_h, most", "hydrate gone", "T, least", "T, most"), rows)
for name, most, _, coldest, warmest in rows:
    judge("fronts", f"hot water into hydrate, {name}: most S_h of any hour, over the 0.4 of the start", most - 0.4, 0.005)
    judge("fronts", f"... {name}: colder than the start or warmer than what flows in, K", max(10 - coldest, warmest - 60, 0), 0.2, 1, "K")
judge("fronts", "hot water into hydrate: axes swapped, hydrate gone", abs(rows[1][2] - plane[1]), 1e-9)
judge("fronts", "hot water into hydrate: hydrate gone, against cells of a quarter", abs(plane[1] / hot("80,1")[1] - 1), 0.015, 0.01, "%")
judge("fronts", "... about an axis", abs(ring[1] / hot("80,1", *RING)[1] - 1), 0.015, 0.01, "%")
# A heater at cells of 1 mm, for hybrid: gas leaves, and the reaction holds T at equilibrium.
SMALL = ("-grid_upper", "0.02 m,0.001 m", "-region_layer_upper", "0.02 m,0.001 m", "-bc_top_position", "0.001 m", "-mat_sand_permeability_k0", "1e-14 m^2", "-mat_sand_kinetics_K0", "1e-5 mol/(m^2 Pa s)",
         "-boundaries", "base,top,warm,outlet", "-bc_warm_temperature", "{ramp: [10 degC, 60 degC, 0 s, 0.4 s]}", "-time_end", "4 s", "-output_every", "0.5 s")  # fmt: skip
small, hybrid = hot("20,1", *SMALL), hot("20,1", *SMALL, "-inertia", "yes", "-stepper_type", "hybrid")
judge("fronts", "a heater at cells of 1 mm, hybrid: most S_h of any half second, over the 0.4 of the start", hybrid[0] - 0.4, 0.03)
judge("fronts", "... hydrate gone, against sdirk2", abs(hybrid[1] / small[1] - 1), 0.01, 0.01, "%")
judge("fronts", "... colder than the start, K", 10 - hybrid[2], 0.01, 1, "K")
finish()
