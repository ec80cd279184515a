#!/usr/bin/env python3
"""Mandel's problem in plane strain: the pressure at the centre, with its overshoot.

Row 11: Mandel's problem in plane strain, the plate moved as in the exact solution: p at the centre, with its overshoot.

The plate's velocity is a table whose points are the ends of the steps, since steps end on the kinks of a schedule; sdirk2
integrates a velocity that is linear in a step exactly, so the table's values make the plate follow the exact motion: the
whole undrained settlement in the first step, by its starting value, then the exact rates.
"""
from pathlib import Path

import numpy as np

import exact
from common import Run, check, finish, judge, table

CASE = Path(__file__).parent / "cases" / "mandel.yaml"
P0, SG = 1e6, 1e-7
M = exact.Mandel(a=1.0, b=0.5, q=1e4, E=9e9, nu=0.2, storage=0.15 * ((1 - SG) / 2.2e11 + SG / P0), mobility=1e-14)
SCALE = M.a**2 / M.c  # s


def plate(times):
    """Velocities (m/s) at times (s), the first of them 0: linear between, they displace as the exact plate does."""
    rate = lambda t: (M.plate_displacement(1.001 * t) - M.plate_displacement(0.999 * t)) / (0.002 * t)
    v = np.array([0.0, *rate(times[1:])])
    v[0] = 2 * M.plate_displacement(times[1]) / times[1] - v[1]
    return v


def solve(cells, steps):
    times = np.array([0.0, *(SCALE * np.geomspace(2e-3, 1.0, steps))])
    entries = ",".join(f"{t!r} s,{v!r} m/s" for t, v in zip(times, plate(times)))
    width = 1 / (cells - 0.5)  # the drained face lies inside a cell
    run = Run.of_case(CASE, "-grid_cells", f"{cells},{cells // 2}", "-grid_upper", f"{cells * width!r} m,0.5 m",
                      "-bc_plate_velocity_table", entries, "-time_end", f"{times[-1]!r} s",
                      "-stepper_dt", repr(times[-1]), "-stepper_dt_max", repr(times[-1]))  # fmt: skip
    return run


def main():
    initial, rows, errors = M.initial_pressure(), [], {}
    for cells, steps in ((13, 40), (25, 40)):
        run = solve(cells, steps)
        late = run.time > 5e-3 * SCALE
        t, p = run.time[late], run.probe("centre")["p_Pa"][late] - P0
        want = M.pressure(0.0, t)
        errors[cells] = np.max(np.abs(p - want)) / initial
        u, v = run.probe("top")["u_y_m"][late], M.plate_displacement(t)
        print(f"\n{cells} x {cells // 2} cells, {len(run.balance['time_s'])} steps; plate off its exact way by at most "
              f"{np.max(np.abs(u / v - 1)):.2g}")  # fmt: skip
        show = np.unique(np.linspace(0, len(t) - 1, 9).astype(int))
        table(("c t/a2", "p(0)/p(0+)", "exact", "error (%)"),
              [(t[k] / SCALE, p[k] / initial, want[k] / initial, 100 * (p[k] - want[k]) / initial) for k in show])  # fmt: skip
        overshoot, exact_one = np.max(p) / initial - 1, np.max(want) / initial - 1
        judge(11, f"Mandel, {cells} x {cells // 2} cells: p at the centre, largest error over p(0+)", errors[cells], 0.02, 0.01, "%")
        judge(11, f"Mandel, {cells} x {cells // 2} cells: overshoot over the exact one ({100 * exact_one:.3g} %)",
              overshoot / exact_one, (0.8, 1.2))  # fmt: skip
    check("error falls with h", errors[25] / errors[13], 1.0)
    finish()


if __name__ == "__main__":
    main()
