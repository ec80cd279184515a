#!/usr/bin/env python3
"""cases/heat_slab: a slab cooled on one side, against its series; orders in h and dt."""
import numpy as np

from _ladder import CASES, HeatSlab
from common import Run, finish, judge, order, table

DAY = 86400.0


def rms(*options):
    """Error of T over the particles after one day, over the 10 K of the step."""
    v = Run.of_case(CASES / "heat_slab", *options).snapshot(DAY)
    return np.sqrt(np.mean((v["T"][:, 0] - HeatSlab.temperature(v["position"][:, 0], DAY)) ** 2)) / 10


cells = (5, 10, 20, 40)
error = [rms("-grid_cells", f"{n},1", "-stepper_dt", 600, "-time_end", "1 d", "-output_times", "1 d") for n in cells]
found = order(cells, error)
table(("cells", "rms of T / 10 K", "order"), list(zip(map(float, cells), error, ["", *-found])))
judge("4.5", "Heat slab, 20 cells, 1 day: T, rms of 10 K", error[2], 1e-3, 0.01, "%")
judge("4.5", "Heat slab: order in h", -found[-1], (1.9, 2.1))

steps, short = (5400.0, 2700.0, 1350.0), ("-time_end", "1 d", "-output_times", "1 d")
fine = Run.of_case(CASES / "heat_slab", "-stepper_dt", 150, *short).snapshot(DAY)["T"]
for stepper, bar in (("euler", (0.9, 1.1)), ("sdirk2", (1.8, 2.2))):
    off = [np.max(np.abs(Run.of_case(CASES / "heat_slab", "-stepper_type", stepper, "-stepper_dt", dt, *short)
                         .snapshot(DAY)["T"] - fine)) for dt in steps]  # fmt: skip
    table((f"{stepper}: dt (s)", "off dt = 150 s (K)", "order"), list(zip(steps, off, ["", *order(steps, off)])))
    judge("4.5", f"Heat slab: order of {stepper} in dt", order(steps, off)[-1], bar)
finish()
