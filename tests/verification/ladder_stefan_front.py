#!/usr/bin/env python3
"""cases/stefan_front: dissociation front controlled by conduction, against Neumann's solution.

The front is where all hydrate gone would leave it.  What the scene has and the solution has not: a reaction of finite rate
(the hydrate is superheated by a tenth of a kelvin), gas at a pressure some Pa above p_e, cells and particles of
finite size.  The bar of the position follows from the grids: 40 and 80 cells differ by 0.08 %, with all of the above 0.2 %.
"""
import numpy as np

from _ladder import CASES, StefanFront
from common import Run, finish, judge, table

exact, TIMES = StefanFront.solution(), np.array([10800.0, 43200.0, 86400.0, 172800.0])
rows, worst = [], {}
for n in (20, 40, 80):
    run = Run.of_case(CASES / "stefan_front", "-grid_cells", f"{n},1")
    shots = [run.snapshot(t) for t in TIMES]
    front = np.array([StefanFront.front(v) for v in shots])
    off = front / exact.front(TIMES) - 1
    power = np.polyfit(np.log(TIMES[1:]), np.log(front[1:]), 1)[0]
    x, T = shots[-1]["position"][:, 0], shots[-1]["T"][:, 0]
    rms = np.sqrt(np.mean((T - exact.temperature(x, TIMES[-1])) ** 2)) / (StefanFront.T_wall - StefanFront.T_e)
    worst[n] = np.max(np.abs(off[1:])), power, rms
    rows.append((float(n), *(100 * off), power, 100 * rms))
print(f"lambda {exact.lam:.5f}, front at 2 days {float(exact.front(TIMES[-1])):.5f} m")
table(("cells", "front off, 3 h (%)", "12 h", "1 d", "2 d", "power of t", "T, rms of 15 K, 2 d (%)"), rows)
judge("4.5", "Stefan front, 80 cells, from 12 h: position", worst[80][0], 2e-3, 0.01, "%")
judge("4.5", "Stefan front, 80 cells: power of t, off 1/2", abs(worst[80][1] - 0.5), 2e-3)
judge("4.5", "Stefan front, 80 cells, 2 days: T, rms of 15 K", worst[80][2], 1e-3, 0.01, "%")
finish()
