#!/usr/bin/env python3
"""The README's own case, on half its cells: no alternating saturations beside the end of the pressure face (365);
what stabilisation_saturation (200) must not change; water and methane; two ranks; hybrid refuses it.  A heater of 60 degC in
hydrate: none forms ahead of the front with stabilisation_reaction (265) or stabilisation_reaction_heat (381), nor does S_h
alternate; the second melts no more than it should."""
import re
from pathlib import Path

import numpy as np

from common import ROOT, WARNS_OF_HELD, binary, check_true, finish, judge, largest_difference, launch, run, scratch

CASES = Path(__file__).parent / "cases"
case = scratch() / "case.yaml"
case.write_text(re.search(r"```yaml\n(title: a hydrate layer is drawn down.*?)```", Path(ROOT / "README.md").read_text(), re.S)[1])
ROW, OPTIONS = 20, ("-quiet", "-grid_cells", "10,6", "-time_end", "1 h", "-output_every", "1 h")


def well(upwind, *more, **keywords):
    return run(binary(), case, *OPTIONS, "-stabilisation_saturation", upwind, *more, **keywords)


def alternation(done, quantity):
    """Largest second difference over neighbouring cells of a particle variable, and its range."""
    v = done.snapshot(3600.0)[quantity].ravel().reshape(-1, ROW)
    across, along = v[:, 4:] - 2 * v[:, 2:-2] + v[:, :-4], v[4:] - 2 * v[2:-2] + v[:-4]
    return max(np.max(np.abs(across)), np.max(np.abs(along)))


upwind, central = well("yes"), well("no")
judge("fronts", "S_w: largest second difference between cells", alternation(central, "S_w"), 0.01)
p = [r.probe("middle")["p_Pa"][-1] for r in (upwind, central)]
judge("fronts", "pressure at the probe, with and without, of the drop", abs(p[0] - p[1]) / 2e6, 0.01)
for name in ("water_error", "methane_error"):
    judge("fronts", f"{name}", np.max(np.abs(upwind.balance[name])), 1e-12)
two = well("yes", ranks=2)
judge("fronts", "1 and 2 ranks: pressure", largest_difference(two.probe("middle")["p_Pa"], upwind.probe("middle")["p_Pa"]), 1e-7)
for name in ("saturation", "reaction"):
    hybrid = launch(binary(), case, "-stepper_type", "hybrid", "-stabilisation_saturation", "no", f"-stabilisation_{name}", "yes", "-case_check", out=scratch() / "out")
    check_true(f"hybrid refuses stabilisation_{name}", hybrid.returncode == 2 and f"stabilisation_{name}" in hybrid.stdout, hybrid.stdout)


def heater(lumped, *more, way="reaction", **keywords):
    """The run, and S_h along x at the end."""
    done = run(binary(), CASES / "heater.yaml", "-quiet", f"-stabilisation_{way}", lumped, *more, **keywords)
    return done, done.snapshot(done.time[-1])["S_h"].ravel().reshape(2, -1)[0]


(nodes, S), (particles, S_0) = heater("yes"), heater("no")
print(f"S_h beside the heater with (265): {np.round(S, 2)}\n                      without it: {np.round(S_0, 2)}")
judge("fronts", "(265): hydrate ahead of the front, beyond that far away", np.max(S) / S[-1] - 1, 0.01)
judge("fronts", "(265): S_h that falls towards the far end", max(np.max(-np.diff(S)), 0.0), 1e-3)
check_true("without it there is more than a tenth", np.max(S_0) / S_0[-1] > 1.1, f"{np.max(S_0) / S_0[-1] - 1:.3f}")
judge("fronts", "(265): hydrate that is left, with and without", abs(np.sum(S) / np.sum(S_0) - 1), 0.15)
for name in ("water_error", "methane_error"):
    judge("fronts", f"(265): {name}", np.max(np.abs(nodes.balance[name])), 1e-12)
PLACES = np.arange(11) / 10
PROBES = ["-probes", ",".join(f"x{k}" for k in range(11)), *(w for k, x in enumerate(PLACES) for w in (f"-probe_x{k}_at", f"{x:g} m,0.05 m"))]
FIELDS = lambda r, k, column: np.array([v[k].ravel() for _, v in r.snapshots()] if column is None else [r.probe(f"x{i}")[column] for i in range(11)])
hourly = heater("yes", "-output_every", "1 h", *PROBES)[0]
own, seen, S, S_seen = (FIELDS(hourly, k, c) for k, c in (("T", None), ("T", "T_degC"), ("S_h", None), ("S_h", "S_h")))
judge("fronts", "(265): a particle warmer than the heater or colder than the start, any hour, K", max(own.max() - 60, 10 - own.min(), 0), 1e-6, 1, "K")
judge("fronts", "... a probe", max(seen.max() - 60, 10 - seen.min(), 0), 1e-3, 1, "K")
judge("fronts", "(265): S_h that falls towards the far end, any hour", max(np.max(-np.diff(S.reshape(len(S), 2, -1)[:, 0], axis=1)), 0.0), 1e-3)
judge("fronts", "... S_h of probes outside the particles' range", max(-S_seen.min(), S_seen.max() - S.max(), 0), 1e-6)
check_true("... which see all of the front", S_seen[0].min() == 0 and S_seen[-1].min() > 0.399)
one, two = (heater("yes", "-time_end", "1 h", ranks=n)[1] for n in (1, 2))
judge("fronts", "(265): 1 and 2 ranks, S_h", np.max(np.abs(two - one)), 1e-8)
held, S = heater("yes", way="reaction_heat")
judge("fronts", "(381): hydrate ahead of the front, beyond that far away", np.max(S) / S[-1] - 1, 0.01)
judge("fronts", "(381): S_h that falls towards the far end", max(np.max(-np.diff(S)), 0.0), 1e-3)
judge("fronts", "(381): hydrate that is left, with and without", abs(np.sum(S) / np.sum(S_0) - 1), 0.015)
for name in ("water_error", "methane_error"):
    judge("fronts", f"(381): {name}", np.max(np.abs(held.balance[name])), 1e-12)
# (423): what the limiter keeps above equilibrium, and for how long, against snapshots of every hour, which do not know its share B/(1 + B); a quarter as long in cells half as wide.
LATE = re.compile(r"held hydrate up to ([\d.]+) K above its equilibrium, near \(.*\) m at t = .*; by ([\d.]+) K or more, a fifth of what may melt it, for ([\d.]+) (h|min)")


def late(done):
    """K above equilibrium at most, from which it counts (419), and hours of that, as the summary says."""
    found = LATE.search((done.out / "summary.txt").read_text())
    return float(found[1]), float(found[2]), float(found[3]) / (60 if found[4] == "min" else 1)


def equilibrium(p):
    """degC at p (Pa): 11.38 at 8 MPa (Sloan)."""
    return 1 / (1 / 284.53 - np.log(p / 8e6) / 8533.8) - 273.15


def above(v):
    """K by which particles with S_h >= 0.01 are above equilibrium, at most."""
    share = 1 - v["S_w"] / (1 - v["S_h"])
    p = v["p_w"] + share * (v["p_g"] - v["p_w"])
    return np.max((v["T"] - equilibrium(p))[v["S_h"] >= 0.01], initial=0.0)


hourly = heater("yes", "-output_every", "1 h", way="reaction_heat")[0]
seen = np.array([above(v) for _, v in hourly.snapshots()])
(most, least, hours), two = late(hourly), heater("yes", "-output_every", "1 h", way="reaction_heat", ranks=2)[0]
judge("fronts", "(423): K above equilibrium at most, against every hour's", most - seen.max(), (-0.5, 2))
lowest = min(np.min(v["p_w"]) for _, v in hourly.snapshots())
judge("fronts", "(419): K from which it counts, against a fifth of the heater's above equilibrium at the lowest p_w", least - 0.2 * (60 - equilibrium(lowest)), 0.1)
judge("fronts", "(423): hours of that or more, against every hour's", hours - np.sum(seen > least), (-3, 1))
check_true("... on 2 ranks", np.allclose(late(two), (most, least, hours), rtol=0.01), f"{late(two)}, {most} K, {least} K, {hours} h")
fine = [heater("yes", "-grid_cells", f"{n},1", way="reaction_heat")[0] for n in (20, 40)]
judge("fronts", "(423): times as long in cells twice as wide", hours / late(fine[0])[2], (2.5, 6))
check_true("a tenth of the run and more is warned of, less is not", WARNS_OF_HELD in hourly.output and WARNS_OF_HELD not in fine[1].output, hourly.output[-500:])
check_true("nothing of it without the limiter", "held hydrate" not in particles.output and WARNS_OF_HELD not in particles.output)
finish()
