#!/usr/bin/env python3
"""Row 8: states that must stay at rest through committed steps.

Two layers of different saturation under one pressure (the paper's fluid force would push p grad(phi S) there), and a
hydrostatic column under gravity, both with a free surface inside a cell.  Velocities are held against k/mu times the
pressure gradient that 1 MPa over a cell would make in the more permeable layer.
"""
from pathlib import Path

import numpy as np

from common import Run, finish, judge, table

CASES = Path(__file__).parent / "cases"
SCALE = 1e-13 / 1e-3 * 1e6 / 0.1  # m/s
rows = []
for name, what in (("rest_layers", "two layers of different saturation"), ("rest_hydrostatic", "hydrostatic column")):
    run = Run.of_case(CASES / f"{name}.yaml", "-newton_tol_residual", 1e-12, "-newton_tol_update", 1e-10, "-snes_max_it", 30)
    last = run.snapshot(1000.0)
    speed = {v: np.abs(last[v]).max() for v in ("v_s", "v_w")}
    for v, value in speed.items():
        rows.append((what, v, value, value / SCALE))
        judge(8, f"{what}: largest {v} over {SCALE:g} m/s after 1000 s", value / SCALE, 1e-12)
table(("state", "velocity", "largest (m/s)", "over the scale"), rows)
finish()
