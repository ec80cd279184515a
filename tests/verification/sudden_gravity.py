#!/usr/bin/env python3
"""Gravity that starts at once in a closed saturated column makes the exact wave.

Gravity that starts at once in a closed saturated column: a wave, not a false strain of the pressure projection (275).

The water cannot leave, so the column is a bar of the modulus M + K_w/n, fixed at its base.  Its end falls freely until
the wave from the base arrives, u = -g t^2/2, and comes back from twice that.  The skeleton is soft: 1/(2G) alone in (23)
takes the pressure that builds up within a cell for a strain of it, several times the answer.  With k0 = 1e-16 m^2 water
moves by 3 mm in this time; with 1e-17 m^2 Newton's updates of p stay above their tolerance while all residuals are
round-off, and steps are refused.
"""
from pathlib import Path

import numpy as np

from common import Run, finish, judge, table

CASE = Path(__file__).parent / "cases" / "saturated_column.yaml"
H, n, E, nu, g, K_w = 10.0, 0.33, 1e6, 0.3, 10.0, 2.2e9
RHO = (1 - n) * 2000 + n * 1000
M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)) + K_w / n
CROSSING = H / np.sqrt(M / RHO)  # s
SCENE = ("-grid_cells", "26,1", "-mat_sand_elasticity_E0", f"{E} Pa", "-mat_sand_permeability_k0", "1e-16 m^2", "-gravity",
         f"{-g} m/s^2,0 m/s^2", "-bc_load_normal", "1 MPa", "-time_end", f"{2 * CROSSING:.12g} s",
         "-output_probe_every", f"{CROSSING / 20:.12g} s", "-quiet")  # fmt: skip


def end(t):
    """Displacement (m) of the free end, of d'Alembert's waves: -g/2 t^2, with another sign of the acceleration after the crossing."""
    late = np.maximum(t - CROSSING, 0)
    return -g / 2 * t**2 + g * late**2


def off(name, *options):
    run = Run.of_case(CASE, *SCENE, *options)
    t, u = run.time, run.probe("end")["u_x_m"]
    return np.max(np.abs(u - end(t))) / np.max(np.abs(end(t)))


found = {}
for steps in (50, 100):
    for scheme in ("sdirk2", "euler"):
        found[scheme, steps] = off(scheme, "-stepper_type", scheme, "-stepper_dt", f"{CROSSING / steps:.12g} s")
found["hybrid", 0] = off("hybrid", "-stepper_type", "hybrid", "-stepper_adapt", "yes")
table(("integrator", "steps to cross", "largest error of the end, of its largest displacement"), [(*k, v) for k, v in found.items()])
for (scheme, steps), error in found.items():
    judge(6, f"{scheme}, {steps or 'its own'} steps: end of the column", error, 0.03 if scheme == "euler" else 0.01)
finish()
