#!/usr/bin/env python3
"""One element that is torn open and pushed together again.

One element that is torn open and pushed together again: the mean stress (427) is that of the volume, on the way
out K eps_v up to the apex, on the way back no stress until all that opened is closed.
"""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, last_places, table

CASE = Path(__file__).parent / "cases" / "tears.yaml"
E, NU, C, PHI, M0 = 200e6, 0.25, 50e3, np.radians(30), -200e3
K, APEX = E / (3 * (1 - 2 * NU)), C / np.tan(PHI)
FIXED = ("-stepper_adapt", "no", "-stepper_dt", "0.1 ms", "-newton_tol_residual", "1e-11", "-newton_tol_update", "1e-9")
# bars: mean stress over the apex's (sdirk2, which ends before the body bounces: of a step across a kink), opening over its largest
RUNS = {
    "sdirk2": (("-stepper_type", "sdirk2", *FIXED, "-time_end", "0.28 s"), 0.05),
    "euler": (("-stepper_type", "euler", *FIXED), 1e-8),
    "hybrid": (("-stepper_type", "hybrid", "-stepper_damping", "0.1", "-output_probe_every", "0.05 ms"), 1e-9),
}


def exact(eps):
    """Mean stress and opening along a path of volumetric strains: elastic between no stress, or more while nothing is open, and the apex."""
    m, open_, out = M0, 0.0, []
    for de in np.diff(eps, prepend=eps[0]):
        m += K * de
        torn, closed = max(m - APEX, 0) / K, min(max(-m, 0) / K, open_)
        m, open_ = m - K * (torn - closed), open_ + torn - closed
        out.append([m, open_])
    return np.array(out).T


def path(*options, ranks=1):
    p = Run.of_case(CASE, "-quiet", *options, ranks=ranks).probe("p")
    return p["eps_v"], -p["p_eff_Pa"], p.get("opening", 0 * p["eps_v"])


rows = []
for flow in ("mohr_coulomb", "menetrey_willam"):
    for name, (options, bar) in RUNS.items():
        eps, m, opening = path(*options, "-mat_soil_plasticity_flow", flow)
        want, open_ = exact(eps)
        rows.append([name, flow, eps.max(), eps[-1], opening.max(), np.abs(m - want).max() / APEX, np.abs(opening - open_).max() / open_.max()])
        judge("strength", f"element torn open and closed, {flow}, {name}: mean stress on the whole path, over the apex's", rows[-1][5], bar)
        judge("strength", f"element torn open and closed, {flow}, {name}: what stands open, over its largest", rows[-1][6], bar)
        check_true("... it opened, closed, and bears again", opening.max() > 0.01 and 0 in opening[np.argmax(opening):] and m[np.argmax(opening):].min() < 0.5 * M0)
SAND = Path(__file__).parent / "cases" / "sand_column.yaml"
for name in ("sdirk2", "hybrid"):
    sand = [Run.of_case(SAND, "-quiet", "-stepper_type", name, "-stepper_tol", "0.03", "-time_end", "0.4 s", ranks=n) for n in (1, 2)]
    check(f"column of sand, {name}, on 2 ranks: places (m)", abs(last_places(sand[1]) - last_places(sand[0])).max(), 1e-9)
    check_true("... tears opened", sand[0].snapshots()[-1][1]["opening"].max() > 0.01)
table(["integrator", "flow", "largest eps_v", "last eps_v", "largest opening", "off: mean stress", "off: opening"], rows)
finish()
