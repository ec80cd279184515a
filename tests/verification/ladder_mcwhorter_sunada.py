#!/usr/bin/env python3
"""cases/mcwhorter_sunada: counter-current imbibition, against the similarity solution; order in h."""
import numpy as np

from _ladder import CASES, McWhorterSunada
from common import Run, finish, judge, order, table

exact, TIMES = McWhorterSunada.solution(), (3600.0, 14400.0, 43200.0)
cells, error = (50, 100, 200), []
for n in cells:
    run = Run.of_case(CASES / "mcwhorter_sunada", "-grid_cells", f"{n},1")
    row = []
    for t in TIMES:
        v = run.snapshot(t)
        S = exact.saturation(v["position"][:, 0], t)
        row.append(np.mean(np.abs(v["S_w"][:, 0] - S)) / np.mean(S - exact.S_initial))
    water = -np.interp(TIMES[-1], run.balance["time_s"], run.balance["water_out_kg"]) / (1000 * 0.02)
    error.append([*row, abs(water / exact.imbibed(TIMES[-1]) - 1), np.max(np.abs(run.balance["water_error"]))])
error = np.array(error)
table(("cells", "mean error of S, 1 h", "4 h", "12 h", "imbibed, 12 h", "water balance"), list(zip(map(float, cells), *error.T)))
for k, t in enumerate(TIMES):
    print(f"t = {t:g} s: orders in h", *(f"{o:.2f}" for o in -order(cells, error[:, k])))
judge("4.5", "McWhorter-Sunada, 100 cells, 12 h: mean error of S, of its mean rise", error[1, 2], 0.015, 0.01, "%")
judge("4.5", "McWhorter-Sunada, 100 cells, 12 h: water taken up", error[1, 3], 0.01, 0.01, "%")
judge("4.5", "McWhorter-Sunada, 200 cells, 1 h: mean error of S", error[2, 0], 0.03, 0.01, "%")
judge("4.5", "McWhorter-Sunada: order in h at 1 h", -order(cells, error[:, 0])[-1], (0.9, 2.2))
finish()
