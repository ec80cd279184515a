#!/usr/bin/env python3
"""Row 8: states that must stay at rest through committed steps.

Bars under uniform stress whose surface lies anywhere in a cell: what particles take from their cells (88), (160) leaves no force.
Ground without fluids may be pressed until no pores are left.

Two layers of different saturation under one pressure (the paper's fluid force would push p grad(phi S) there), and a
hydrostatic column under gravity, both with a free surface inside a cell.  Velocities are held against k/mu times the
pressure gradient that 1 MPa over a cell would make in the more permeable layer.
"""
from pathlib import Path

import numpy as np

from common import Run, finish, judge, table

CASES = Path(__file__).parent / "cases"
SCALE = 1e-13 / 1e-3 * 1e6 / 0.1  # m/s
HOOP = ("-region_bar_stress", "-1 MPa,0 Pa,-1 MPa,0 Pa,0 Pa,0 Pa")
rows = []
for name, what in (("rest_layers", "two layers of different saturation"), ("rest_hydrostatic", "hydrostatic column")):
    run = Run.of_case(CASES / f"{name}.yaml", "-newton_tol_residual", 1e-12, "-newton_tol_update", 1e-10, "-snes_max_it", 30)
    last = run.snapshot(1000.0)
    speed = {v: np.abs(last[v]).max() for v in ("v_s", "v_w")}
    for v, value in speed.items():
        rows.append((what, v, value, value / SCALE))
        judge(8, f"{what}: largest {v} over {SCALE:g} m/s after 1000 s", value / SCALE, 1e-12)
for fill in (0.05, 0.3, 0.77):
    upper = f"2 m, {1 + 0.25 * fill} m"
    for name, more in (("hybrid", ()), ("sdirk2", ("-stepper_type", "sdirk2")), ("hybrid, half the mean strain", ("-mean_strain", 0.5)),
                       ("sdirk2, about an axis", ("-stepper_type", "sdirk2", "-geometry", "axisymmetric", "-boundaries", "base,right", *HOOP))):  # fmt: skip
        last = Run.of_case(CASES / "pressed_bar.yaml", "-quiet", "-region_bar_upper", upper, *more).snapshots()[-1][1]
        value = np.abs(last["v_s"]).max()
        rows.append((f"bar, {name}", "v_s", value, value / 1.0))
        judge(8, f"bar under 1 MPa, surface at {fill} of a cell, {name}: largest v_s after 0.05 s", value, 1e-12, unit="m/s")
# all of the surface cuts cells, and tractions bear the stress
SIDES = ("left", "right", "bottom", "top")
PRESSED = [o for s in SIDES for o in (f"-bc_on_{s}_type", "traction", f"-bc_on_{s}_side", s, f"-bc_on_{s}_normal", "1 MPa")]
for name, more in (("hybrid", ()), ("sdirk2", ("-stepper_type", "sdirk2"))):
    last = Run.of_case(CASES / "pressed_bar.yaml", "-quiet", "-boundaries", ",".join(f"on_{s}" for s in SIDES), *PRESSED, "-region_bar_lower", "0.31 m,0.27 m", "-region_bar_upper", "1.77 m,1.13 m",
                       "-region_bar_stress", "-1 MPa,-1 MPa,-1 MPa,0 Pa,0 Pa,0 Pa", *more).snapshots()[-1][1]  # fmt: skip
    judge(8, f"block under 1 MPa all round, off the grid's lines, {name}: largest v_s after 0.05 s", np.abs(last["v_s"]).max(), 1e-12, unit="m/s")
# ground without fluids whose pores are gone: as compressible as with pores, of the same weight
def pressed(phi, *more):
    end = ("-boundaries", "left,base,load", "-bc_load_type", "traction", "-bc_load_side", "right", "-bc_load_normal", "{ramp: [1 MPa, 20 MPa, 0 s, 0.05 s]}")
    run = Run.of_case(CASES / "pressed_bar.yaml", "-quiet", *end, "-mat_rock_porosity", phi, "-mat_rock_solid_density", f"{2000 / (1 - phi)!r} kg/m^3", *more)
    return run.snapshots()[-1][1]


for name, more in (("hybrid", ()), ("sdirk2", ("-stepper_type", "sdirk2", "-inertia", "no", "-newton_tol_update", 1e-10))):
    dense, loose = (pressed(phi, *more) for phi in (0.02, 0.4))
    judge(8, f"pressed until no pores are left, {name}: porosity at the end", dense["porosity"].min(), (-0.5, -0.02))
    off = np.abs(dense["displacement"] - loose["displacement"]).max() / np.abs(loose["displacement"]).max()
    judge(8, f"... displacement against ground with pores, {name}", off, 1e-8)
table(("state", "velocity", "largest (m/s)", "over the scale"), rows)
finish()
