#!/usr/bin/env python3
"""Large-strain consolidation against the exact solution of Xie and Leo (2004).

Row 5: 10 MPa on a column of M = 100 MPa."""
from pathlib import Path

import numpy as np

import exact
from common import Run, check, finish, judge, order, table

CASE = Path(__file__).parent / "cases" / "xie_leo.yaml"
Q, M, K0, MU, H, P0 = 1e7, 1e8, 1.53e-15, 1e-3, 1.0, 1e8
TIMES = np.array([1000.0, 2000.0, 4000.0])
CELLS = (12, 25, 50)

p_exact = exact.xie_leo_pressure(Q, M, K0, MU, H, 0.4, TIMES)
u_exact = exact.xie_leo_settlement(Q, M, K0, MU, H, TIMES)
error, rows = {}, []
for n in CELLS:
    run = Run.of_case(CASE, "-grid_cells", f"{n},1")
    p, u = run.at("p06", "p_Pa", TIMES) - P0, run.at("surface", "u_x_m", TIMES)
    error[n] = np.array([np.abs(p / p_exact - 1), np.abs(u / u_exact - 1)])
    rows += [(n, t, a / 1e6, b / 1e6, 100 * e, -1e3 * c, -1e3 * d, 100 * f)
             for t, a, b, e, c, d, f in zip(TIMES, p, p_exact, error[n][0], u, u_exact, error[n][1])]  # fmt: skip
table(("cells", "t (s)", "p(0.6) (MPa)", "exact", "error (%)", "settlement (mm)", "exact", "error (%)"), rows)
worst = {n: error[n].max(axis=1) for n in CELLS}
for k, what in enumerate(("p(0.6 m)", "settlement")):
    e = [worst[n][k] for n in CELLS]
    print(f"{what}: observed orders in h", *(f"{o:.2f}" for o in order([1 / n for n in CELLS], e)))
    for j, t in enumerate(TIMES):
        judge(5, f"Xie and Leo, 50 cells, {t:g} s: {what}", error[50][k][j], 5e-3, 0.01, "%")
    check(f"{what}: error at 50 cells over that at 25", e[2] / e[1], 1.0)
    check(f"{what}: error at 25 cells over that at 12", e[1] / e[0], 1.0)
finish()
