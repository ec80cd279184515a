#!/usr/bin/env python3
"""cases/buckley_leverett: a front of saturation against the exact one.

cases/buckley_leverett: a front of saturation, with saturations carried with the flow (200) and without; error over h and capillary pressure."""
import numpy as np

from _ladder import CASES, BuckleyLeverett as B
from common import Run, check, finish, judge, order, table

END = 1e4


def errors(cells, *options):
    """Front's error (m), mean error of S, largest and smallest S at the end, and the balance error of water."""
    run = Run.of_case(CASES / "buckley_leverett", "-grid_cells", f"{cells},1", "-stepper_dt", 1500 / cells, *options)
    x, S = B.profile(run.snapshot(END))
    mean = np.mean(np.abs(S - B.exact.saturation(x, END)))
    return B.front(x, S) - float(B.exact.front(END)), mean, S.max(), S.min(), np.max(np.abs(run.balance["water_error"]))


cells = (25, 50, 100)
carried = np.array([errors(n) for n in cells])
off = np.array([errors(n, "-stabilisation_saturation", "no") for n in cells[:2]])
head = ("cells", "front off (m)", "mean error of S", "largest S (0.9)", "smallest S (0.1)", "water balance")
print(f"front of {B.exact.S_front:.4f} at {float(B.exact.front(END)):.4f} m; saturations carried with the flow")
table(head, [(float(n), *e) for n, e in zip(cells, carried)])
print("orders of the mean error in h", *(f"{o:.2f}" for o in -order(cells, carried[:, 1])))
print("the same with central drag")
table(head, [(float(n), *e) for n, e in zip(cells, off)])
table(("50 cells, p0 (Pa)", *head[1:3]), [(5000.0, *errors(50, "-mat_sand_retention_p0", "5 kPa")[:2])])
judge("4.5", "Buckley-Leverett, 100 cells: front off, cells", abs(carried[-1, 0]) * cells[-1], 2.0)
judge("4.5", "Buckley-Leverett, 100 cells: mean error of S", carried[-1, 1], 0.02)
judge("4.5", "Buckley-Leverett: order of the mean error in h", -order(cells, carried[:, 1])[-1], (0.6, 1.2))
check("error with central drag does not fall with h, over that of saturations carried with the flow", carried[1, 1] / off[1, 1], 0.5)
check("water balance", carried[:, 4].max(), 1e-12)
finish()
