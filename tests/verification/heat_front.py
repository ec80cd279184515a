#!/usr/bin/env python3
"""stabilisation_heat (293): cold water flows into warm sand at a cell Peclet number of 26; temperatures stay within their
bounds, heat is conserved, and where a cell conducts more than it carries nothing changes.  Implicit and hybrid.
"""
import numpy as np

from common import CASES, Run, check_true, finish, judge, table

GRID = ("-grid_cells", "20,1", "-time_end", "1 d", "-output_times", "0 s, 1 d", "-stepper_adapt", "yes")
SHARP = ("-mat_sand_solid_conductivity", "0.1 W/(m K)", "-mat_sand_water_conductivity", "0.03 W/(m K)")
q, c = 5e-6, 4.2e6


def fronts(upwind, *more, **keywords):
    run = Run.of_case(CASES / "heat_advection", *GRID, *SHARP, "-stabilisation_heat", upwind, *more, **keywords)
    T = run.snapshots()[-1][1]["T"][:, 0]
    return run, T, max(10 - T.min(), T.max() - 20)


kappa = 0.7 * 0.1 + 0.3 * 0.03
print(f"cell Peclet number {q * c * 0.2 / (2 * kappa):.3g}")
rows = []
OFF, off, beyond = fronts("no")
rows.append(("sdirk2", "no", off.min(), off.max()))
ON, on, within = fronts("yes")
rows.append(("sdirk2", "yes", on.min(), on.max()))
check_true("without it temperatures leave their bounds", beyond > 0.5, f"{beyond:.3g} K")
judge("fronts", "sdirk2: beyond 10 and 20 degC, K", within, 0.02)
WARNS = "stabilisation_heat: yes, where flow carries the heat"
check_true("a run without it ends with a warning that names it, one with it does not", WARNS in OFF.output.splitlines()[-1] + OFF.output.splitlines()[-2] and "than start" not in ON.output, OFF.output[-300:])
HYBRID = ("-stepper_type", "hybrid", "-inertia", "yes", "-mat_sand_water_bulk_modulus", "1 MPa", "-time_end", "12 h", "-output_times", "0 s, 12 h")
_, hy, hybrid = fronts("yes", *HYBRID)
_, free, _ = fronts("no", *HYBRID)
rows += [("hybrid, 12 h", "no", free.min(), free.max()), ("hybrid, 12 h", "yes", hy.min(), hy.max())]
judge("fronts", "hybrid: beyond 10 and 20 degC, K", hybrid, 0.02)
at = ("-time_end", "12 h", "-output_times", "0 s, 12 h")
apart = np.max(np.abs(fronts("yes", *at)[1] - hy))
judge("fronts", "hybrid against sdirk2 at 12 h, with it, K", apart, 0.3)
check_true("... and it does something there", np.max(np.abs(hy - free)) > 1.0, f"{np.max(np.abs(hy - free)):.3g} K")
table(("integrator", "stabilisation_heat", "lowest T", "highest T"), rows)
judge("fronts", "sdirk2: balance of heat, of 1 K of the body", np.max(np.abs(ON.balance["heat_error"])), 1e-8)
two, T2, _ = fronts("yes", ranks=2)
judge("fronts", "2 ranks against 1, K", np.max(np.abs(T2 - on)), 1e-6)
fine = [Run.of_case(CASES / "heat_advection", *GRID, "-mat_sand_solid_conductivity", "50 W/(m K)", "-stabilisation_heat", w).snapshots()[-1][1]["T"] for w in ("no", "yes")]
judge("fronts", "cell Peclet number 0.06: what it changes, of 10 K", np.max(np.abs(fine[1] - fine[0])) / 10, 0.0)
finish()
