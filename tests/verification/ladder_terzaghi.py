#!/usr/bin/env python3
"""cases/terzaghi: consolidation of a saturated column with five unknowns a node; order in h.

The order is judged at 10 min; later what the steps leave (2e-4 at a tolerance of 3e-5) is as large as what 50 cells leave.
"""
import numpy as np

from _ladder import CASES, Terzaghi as Z
from common import Run, finish, judge, order, table

TIMES = np.array([600.0, 3600.0, 14400.0])
cells, error = (12, 25, 50), []
for n in cells:
    run = Run.of_case(CASES / "terzaghi", "-grid_cells", f"{n},1", "-stepper_tol", 3e-5, "-time_end", "4 h",
                      "-output_times", "10 min, 1 h, 4 h")  # fmt: skip
    rms = []
    for t in TIMES:
        v = run.snapshot(t)
        exact = Z.pressure(v["position"][:, 0] - v["displacement"][:, 0], t)
        rms.append(np.sqrt(np.mean((v["p"][:, 0] - Z.p0 - exact) ** 2)) / Z.q)
    u = Z.settlement(TIMES)
    error.append([max(rms[1:]), rms[0], np.max(np.abs(run.at("end", "u_x_m", TIMES) - u)) / np.max(np.abs(u))])
error = np.array(error)
columns = [x for k in range(3) for x in (error[:, k], ["", *-order(cells, error[:, k])])]
table(("cells", "p, rms, 1 h on", "order", "p, rms, 10 min", "order", "settlement", "order"),
      list(zip(map(float, cells), *columns)))  # fmt: skip
judge("4.5", "Terzaghi, saturated set, 50 cells: p, rms of the load, from 1 h", error[-1, 0], 2e-3, 0.01, "%")
judge("4.5", "Terzaghi, saturated set, 50 cells: settlement", error[-1, 2], 2e-3, 0.01, "%")
judge("4.5", "Terzaghi, saturated set: order of p in h, 10 min", -order(cells, error[:, 1])[-1], (1.8, 2.4))
finish()
