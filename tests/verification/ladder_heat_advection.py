#!/usr/bin/env python3
"""cases/heat_advection: cold water flows into warm sand, against Ogata and Banks; order in h."""
import numpy as np

from _ladder import CASES, HeatAdvection
from common import Run, finish, judge, order, table

cells, times, error = (20, 40, 80), (21600.0, 172800.0), []
for n in cells:
    run = Run.of_case(CASES / "heat_advection", "-grid_cells", f"{n},1")
    error.append([np.sqrt(np.mean((v["T"][:, 0] - HeatAdvection.temperature(v["position"][:, 0], t)) ** 2)) / 10
                  for t, v in ((t, run.snapshot(t)) for t in times)])  # fmt: skip
error = np.array(error)
found = -order(cells, error[:, 1])
table(("cells", "rms of T / 10 K, 6 h", "2 d", "order, 2 d"), list(zip(map(float, cells), *error.T, ["", *found])))
v = run.snapshot(times[-1])
judge("4.5", "Heat with advection, 80 cells, 2 days: T, rms of 10 K", error[-1, 1], 1.5e-3, 0.01, "%")
judge("4.5", "Heat with advection: order in h", found[-1], (1.8, 2.2))
flux = v["v_w"][:, 0] * v["porosity"][:, 0]
judge("4.5", "Heat with advection: Darcy flux", np.max(np.abs(flux / HeatAdvection.q - 1)), 1e-8)
finish()
