#!/usr/bin/env python3
"""The README's own case, on half its cells: no alternating saturations beside the end of the pressure face (365);
what stabilisation_saturation (200) must not change; water and methane; two ranks; hybrid refuses it.  A heater of 60 degC in
hydrate: none forms ahead of the front (265), nor does S_h alternate, and no more melts than it should."""
import re
from pathlib import Path

import numpy as np

from common import ROOT, binary, check_true, finish, judge, largest_difference, launch, run, scratch

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
hybrid = launch(binary(), case, "-stepper_type", "hybrid", "-stabilisation_saturation", "yes", "-case_check", out=scratch() / "out")
check_true("hybrid refuses stabilisation_saturation", hybrid.returncode == 2 and "stabilisation_saturation" in hybrid.stdout, hybrid.stdout)


def heater(*more, **keywords):
    """The run, and S_h along x at the end."""
    done = run(binary(), CASES / "heater.yaml", "-quiet", *more, **keywords)
    return done, done.snapshot(done.time[-1])["S_h"].ravel().reshape(2, -1)[0]


(nodes, S), (_, fine) = heater(), heater("-grid_cells", "40,1")
print(f"S_h beside the heater: {np.round(S, 2)}")
judge("fronts", "a heater in hydrate: hydrate ahead of the front, beyond that far away", np.max(S) / S[-1] - 1, 0.01)
judge("fronts", "... S_h that falls towards the far end", max(np.max(-np.diff(S)), 0.0), 1e-3)
judge("fronts", "... hydrate that is left, against that in cells of a quarter", abs(np.mean(S) / np.mean(fine) - 1), 0.01)
for name in ("water_error", "methane_error"):
    judge("fronts", f"... {name}", np.max(np.abs(nodes.balance[name])), 1e-12)
PLACES = np.arange(11) / 10
PROBES = ["-probes", ",".join(f"x{k}" for k in range(11)), *(w for k, x in enumerate(PLACES) for w in (f"-probe_x{k}_at", f"{x:g} m,0.05 m"))]
FIELDS = lambda r, k, column: np.array([v[k].ravel() for _, v in r.snapshots()] if column is None else [r.probe(f"x{i}")[column] for i in range(11)])
hourly = heater("-output_every", "1 h", *PROBES)[0]
own, seen, S, S_seen = (FIELDS(hourly, k, c) for k, c in (("T", None), ("T", "T_degC"), ("S_h", None), ("S_h", "S_h")))
judge("fronts", "... a particle warmer than the heater or colder than the start, any hour, K", max(own.max() - 60, 10 - own.min(), 0), 1e-6, 1, "K")
judge("fronts", "... a probe", max(seen.max() - 60, 10 - seen.min(), 0), 1e-3, 1, "K")
judge("fronts", "... S_h that falls towards the far end, any hour", max(np.max(-np.diff(S.reshape(len(S), 2, -1)[:, 0], axis=1)), 0.0), 1e-3)
judge("fronts", "... S_h of probes outside the particles' range", max(-S_seen.min(), S_seen.max() - S.max(), 0), 1e-6)
check_true("... which see all of the front", S_seen[0].min() == 0 and S_seen[-1].min() > 0.399)
one, two = (heater("-time_end", "1 h", ranks=n)[1] for n in (1, 2))
judge("fronts", "... 1 and 2 ranks, S_h", np.max(np.abs(two - one)), 1e-8)
finish()
