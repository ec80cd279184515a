#!/usr/bin/env python3
"""stabilisation_heat (293), (440): cold water flows into warm sand at a cell Peclet number of 26; temperatures stay within their
bounds, heat is conserved, and where a cell conducts more than it carries nothing changes.  Implicit and hybrid.
Hydrate that a falling pressure cools, in water that flows: nothing is warmer than what flows in.
"""
from pathlib import Path

import numpy as np

from common import CASES, Run, check_true, finish, judge, table

GRID = ("-grid_cells", "20,1", "-time_end", "1 d", "-output_times", "0 s, 1 d", "-stepper_adapt", "yes")
SHARP = ("-mat_sand_solid_conductivity", "0.1 W/(m K)", "-mat_sand_water_conductivity", "0.03 W/(m K)")
q, c = 5e-6, 4.2e6


CARRY = {"central": ("-stabilisation_heat", "no"), "auto": (), "everywhere": ("-stabilisation_heat", "yes")}


def fronts(word, *more, **keywords):
    run = Run.of_case(CASES / "heat_advection", *GRID, *SHARP, *CARRY[word], *more, **keywords)
    T = run.snapshots()[-1][1]["T"][:, 0]
    return run, T, max(10 - T.min(), T.max() - 20)


kappa = 0.7 * 0.1 + 0.3 * 0.03
print(f"cell Peclet number {q * c * 0.2 / (2 * kappa):.3g}")
rows = []
OFF, off, beyond = fronts("central")
rows.append(("sdirk2", "central", off.min(), off.max()))
ON, on, within = fronts("everywhere")
rows.append(("sdirk2", "everywhere", on.min(), on.max()))
check_true("by central differences temperatures leave their bounds", beyond > 0.5, f"{beyond:.3g} K")
judge("fronts", "sdirk2: beyond 10 and 20 degC, K", within, 0.02)
WARNS = "stabilisation_heat: auto, where flow carries the heat"
check_true("a run by them ends with a warning that names it, one with (293) does not", WARNS in OFF.output.splitlines()[-1] + OFF.output.splitlines()[-2] and "than start" not in ON.output, OFF.output[-300:])
AUTO, auto, beyond = fronts("auto")
rows.append(("sdirk2", "auto", auto.min(), auto.max()))
judge("fronts", "sdirk2, where T alternates: beyond 10 and 20 degC, K", beyond, 0.02)
judge("fronts", "sdirk2, where T alternates: balance of heat, of 1 K of the body", np.max(np.abs(AUTO.balance["heat_error"])), 1e-8)
HYBRID = ("-stepper_type", "hybrid", "-inertia", "yes", "-mat_sand_water_bulk_modulus", "1 MPa", "-time_end", "12 h", "-output_times", "0 s, 12 h")
_, hy, hybrid = fronts("everywhere", *HYBRID)
_, free, _ = fronts("central", *HYBRID)
rows += [("hybrid, 12 h", "central", free.min(), free.max()), ("hybrid, 12 h", "everywhere", hy.min(), hy.max())]
judge("fronts", "hybrid: beyond 10 and 20 degC, K", hybrid, 0.02)
at = ("-time_end", "12 h", "-output_times", "0 s, 12 h")
apart = np.max(np.abs(fronts("everywhere", *at)[1] - hy))
judge("fronts", "hybrid against sdirk2 at 12 h, with it, K", apart, 0.3)
check_true("... and it does something there", np.max(np.abs(hy - free)) > 1.0, f"{np.max(np.abs(hy - free)):.3g} K")
table(("integrator", "heat carried", "lowest T", "highest T"), rows)
judge("fronts", "sdirk2: balance of heat, of 1 K of the body", np.max(np.abs(ON.balance["heat_error"])), 1e-8)
for word, alone in (("everywhere", on), ("auto", auto)):
    judge("fronts", f"2 ranks against 1, {word}, K", np.max(np.abs(fronts(word, ranks=2)[1] - alone)), 1e-6)
fine = [Run.of_case(CASES / "heat_advection", *GRID, "-mat_sand_solid_conductivity", "50 W/(m K)", *CARRY[w]).snapshots()[-1][1]["T"] for w in CARRY]
judge("fronts", "cell Peclet number 0.06: what it changes, of 10 K", max(np.max(np.abs(f - fine[0])) for f in fine) / 10, 0.0)


# What flows in at 11 degC meets hydrate that its pressure holds below: central differences warm what is between, and cool it.
def carried(word, **keywords):
    """The run, how far any temperature is beyond the 11 degC of the start (7.7 MPa: 11.0), and how far the sand before the hydrate is from them, K."""
    run = Run.of_case(Path(__file__).parent / "cases" / "carried_heat.yaml", *CARRY[word], **keywords)
    states = [v for _, v in run.snapshots()]
    return run, max(v["T"].max() for v in states) - 11, max(np.max(np.abs(v["T"][v["position"][:, 0] < 3] - 11)) for v in states)


rows = []
for word, warmer, off in (("central", (0.5, 3), (0.9, 3)), ("auto", 0.05, 0.02), ("everywhere", 0.05, 0.05)):
    run, above, away = carried(word)
    rows.append((word, above, away))
    judge("fronts", f"into hydrate, {word}: warmer than what flows in and than hydrate in equilibrium, K", above, warmer)
    judge("fronts", f"into hydrate, {word}: water before it off the temperature of what flows in, K", away, off)
    judge("fronts", f"into hydrate, {word}: balance of heat, of 1 K of the body", np.max(np.abs(run.balance["heat_error"])), 1e-8)
table(("into hydrate, heat carried", "above 11 degC, K", "off 11 degC before it, K"), rows)
finish()
