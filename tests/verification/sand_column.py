#!/usr/bin/env python3
"""Collapse of a column of dry sand of aspect ratio 2, with hybrid: the runout of experiments in the plane is 2.4 to 3.6 initial
widths for sands of about 30 deg; with a wrong friction angle it is
not.  No cohesion: the free surface is at the apex of the yield surface all the time.
"""
from pathlib import Path

from common import Run, check, finish, judge, table

CASE = Path(__file__).parent / "cases" / "sand_column.yaml"
LOW, HIGH = 2.4, 3.6
rows = []
for flow, friction, right in (("mohr_coulomb", 31, True), ("menetrey_willam", 31, True), ("mohr_coulomb", 15, False), ("mohr_coulomb", 55, False)):
    run = Run.of_case(CASE, "-quiet", "-mat_sand_plasticity_flow", flow, "-mat_sand_plasticity_friction_peak", f"{friction} deg",
                      "-grid_upper", "10 m, 2.4 m", "-grid_cells", "100,24", "-time_end", "1.6 s", "-output_every", "0 s")  # fmt: skip
    last = run.snapshots()[-1][1]
    x = last["position"][:, 0]
    runout = sorted(x)[-5] - 1.0  # the farthest few may have left the heap
    rows.append([flow, friction, runout, (last["yield"] == 3).mean()])
    if right:
        judge("strength", f"runout of a column of sand over its width, {flow}, {friction} deg", runout, (LOW, HIGH))
    else:
        check(f"runout with a wrong friction of {friction} deg, distance from the band", max(LOW - runout, runout - HIGH), (0.05, 10))
check("the two flows against each other", abs(rows[1][2] / rows[0][2] - 1), 0.1)
table(["flow", "friction (deg)", "runout / width", "share at the apex"], rows)
finish()
