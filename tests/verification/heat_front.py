#!/usr/bin/env python3
"""Cold water flows into warm sand: temperatures stay within their bounds and heat is conserved.

(293), (440): cold water flows into warm sand at a cell Peclet number of 26; temperatures stay within their bounds, heat is
conserved, and where a cell conducts more than it carries nothing changes.  Implicit and hybrid.
Hydrate that a falling pressure cools, in water that flows: nothing is warmer than what flows in.
"""
from pathlib import Path

import numpy as np

from common import CASES, Run, check_true, finish, judge, table

GRID = ("-grid_cells", "20,1", "-time_end", "1 d", "-output_times", "0 s, 1 d", "-stepper_adapt", "yes")
SHARP = ("-mat_sand_solid_conductivity", "0.1 W/(m K)", "-mat_sand_water_conductivity", "0.03 W/(m K)")
q, c = 5e-6, 4.2e6


def fronts(*more, **keywords):
    run = Run.of_case(CASES / "heat_advection", *GRID, *SHARP, *more, **keywords)
    T = run.snapshots()[-1][1]["T"][:, 0]
    return run, T, max(10 - T.min(), T.max() - 20)


kappa = 0.7 * 0.1 + 0.3 * 0.03
print(f"cell Peclet number {q * c * 0.2 / (2 * kappa):.3g}")
run, T, beyond = fronts()
rows = [("sdirk2", T.min(), T.max())]
judge("fronts", "sdirk2: beyond 10 and 20 degC, K", beyond, 0.02)
check_true("... and no warning of it", "than start" not in run.output, run.output[-300:])
judge("fronts", "sdirk2: balance of heat, of 1 K of the body", np.max(np.abs(run.balance["heat_error"])), 1e-8)
judge("fronts", "2 ranks against 1, K", np.max(np.abs(fronts(ranks=2)[1] - T)), 1e-6)
HALF = ("-time_end", "12 h", "-output_times", "0 s, 12 h")
HYBRID = ("-stepper_type", "hybrid", "-inertia", "yes", "-mat_sand_water_bulk_modulus", "1 MPa", *HALF)
half, (quick, hybrid, beyond) = fronts(*HALF)[1], fronts(*HYBRID)
rows.append(("hybrid, 12 h", hybrid.min(), hybrid.max()))
judge("fronts", "hybrid: beyond 10 and 20 degC, K", beyond, 0.02)
judge("fronts", "hybrid: balance of heat, of 1 K of the body", np.max(np.abs(quick.balance["heat_error"])), 1e-8)
judge("fronts", "hybrid against sdirk2 at 12 h, K", np.max(np.abs(half - hybrid)), 0.1)
judge("fronts", "hybrid, 2 ranks against 1, K", np.max(np.abs(fronts(*HYBRID, ranks=2)[1] - hybrid)), 1e-6)
ALONG_Y = ("-grid_upper", "0.05 m,4 m", "-grid_cells", "1,20", "-region_body_upper", "0.05 m,4 m", "-bc_bottom_axis", "x", "-bc_top_axis", "x", "-bc_inlet_side", "bottom", "-bc_outlet_side", "top",
           "-bc_cold_axis", "y", "-probes", "half", "-probe_half_at", "0.025 m,0.5 m")  # fmt: skip
judge("fronts", "hybrid along y against along x, K", np.max(np.abs(np.sort(fronts(*HYBRID, *ALONG_Y)[1]) - np.sort(hybrid))), 1e-6)
table(("integrator", "lowest T", "highest T"), rows)


# What flows in at 11 degC meets hydrate that its pressure holds below: central differences warm what is between, and cool it.
run = Run.of_case(Path(__file__).parent / "cases" / "carried_heat.yaml")
states = [v for _, v in run.snapshots()]
judge("fronts", "into hydrate: warmer than what flows in and than hydrate in equilibrium (7.7 MPa: 11.0 degC), K", max(v["T"].max() for v in states) - 11, 0.05)
judge("fronts", "into hydrate: water before it off the temperature of what flows in, K", max(np.max(np.abs(v["T"][v["position"][:, 0] < 3] - 11)) for v in states), 0.02)
judge("fronts", "into hydrate: balance of heat, of 1 K of the body", np.max(np.abs(run.balance["heat_error"])), 1e-8)
finish()
