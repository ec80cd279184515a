#!/usr/bin/env python3
"""A well about an axis, in cells up to twenty times its radius, against Thiem.

A pressure and a temperature on the wall of a well, in cells from half its radius to twenty times that: Thiem's steady flow
and its heat, with the grid beginning at the wall and at the axis, where the wall cuts a cell; two ranks; both schemes.
A well between clays without gas, past the time at which the hydrate beside it is used up."""
from pathlib import Path

import numpy as np

from common import Run, check, finish, judge, largest_difference, table

CASE = Path(__file__).parent / "cases" / "boundaries.yaml"
R_W, R, K, MU, BULK, KAPPA = 0.1, 20.1, 1e-12, 1e-3, 2.2e9, 0.7 * 3.0 + 0.3 * 0.044  # of the case; m, m^2, Pa s, Pa, W/(m K)
INSIDE, OUTSIDE, HOT, COLD = 4e6, 10e6, 60.0, 10.0


def well(h, lower, what, *more, **keywords):
    """A ring from R_W to R in cells of h, in which nothing changes any more at the end."""
    fluid = what == "water"
    options = ["-quiet", "-geometry", "axisymmetric", "-fields", what, "-inertia", "no", "-basis", "cpgimp"]
    n = int(np.ceil((R - lower) / h - 1e-9))
    options += ["-grid_lower", f"{lower} m,0 m", "-grid_upper", f"{lower + n * h} m,{h} m", "-grid_cells", f"{n},1"]
    options += ["-region_strip_lower", f"{R_W} m,0 m", "-region_strip_upper", f"{R} m,{h} m", "-region_strip_pressure", f"{OUTSIDE} Pa"]
    kind, key, values = ("pressure", "p_w", (f"{INSIDE} Pa", f"{OUTSIDE} Pa")) if fluid else ("face_temperature", "temperature", (f"{HOT} degC", f"{COLD} degC"))
    options += ["-boundaries", "well,far", "-meters", "well"]
    for name, side, value in (("well", "left", values[0]), ("far", "right", values[1])):
        options += [f"-bc_{name}_type", kind, f"-bc_{name}_side", side, f"-bc_{name}_{key}", value]
    for name, r in (("left", R_W + 1e-3), ("middle", 1.0), ("right", 10.0)):
        options += [f"-probe_{name}_at", f"{r} m,{h / 2} m"]
    end = 1e6 if fluid else 1e11
    steps = ["-time_end", f"{end} s", "-stepper_dt", f"{end / 10} s", "-stepper_type", "euler"]
    return Run.of_case(CASE, *options, "-meter_well_side", "left", *steps, *more, **keywords)


def rate(run, what):
    """Of the flow into the well per height, over Thiem's."""
    meters = run.csv("meters.csv")
    if what == "water":
        flow, thiem = meters["well.water_kg_s"][-1], 2 * np.pi * K / MU * (OUTSIDE - INSIDE) / np.log(R / R_W)
        return flow / (1000.0 * np.exp(0.5 * (INSIDE + OUTSIDE - 2 * 5e6) / BULK)) / thiem  # at the mean density
    return meters["well.heat_W"][-1] / (2 * np.pi * KAPPA * (COLD - HOT) / np.log(R / R_W))


def at_one_metre(run, what):
    """Off the logarithm at 1 m, of the drop."""
    inner, outer = (INSIDE, OUTSIDE) if what == "water" else (HOT, COLD)
    exact = inner + (outer - inner) * np.log(1.0 / R_W) / np.log(R / R_W)
    return abs(run.probe("middle")["p_Pa" if what == "water" else "T_degC"][-1] - exact) / abs(outer - inner)


rows = []
for what in ("water", "heat"):
    for lower in (R_W, 0.0):
        for h in (2.0, 1.0, 0.5, 0.2, 0.15, 0.1):
            run = well(h, lower, what)
            rows.append((what, "the wall" if lower else "the axis", h / R_W, rate(run, what) / h, at_one_metre(run, what)))
table(("flow of", "grid from", "h / r_w", "rate / Thiem", "at 1 m, of the drop"), rows)
for what in ("water", "heat"):
    off = [abs(r[3] - 1) for r in rows if r[0] == what]
    judge("wells", f"{what}: rate off Thiem's, h up to 20 r_w, wall on a line and across a cell", max(off), 5e-4)
    judge("wells", f"{what}: at 1 m, of the drop, h up to 2 r_w", max(r[4] for r in rows if r[0] == what and r[2] <= 2.0), 2e-3)

# a body that can move, about the same flow: nothing holds it at an axis that it does not reach
SOLID = ("-fields", "solid,water", "-mat_sand_elasticity_E0", "1e10 Pa", "-boundaries", "well,far,low,high,wall,rim",
         "-bc_low_type", "roller", "-bc_low_axis", "y", "-bc_low_position", "0 m", "-bc_high_type", "roller", "-bc_high_axis", "y", "-bc_high_position", "0.15 m",
         "-bc_wall_type", "traction", "-bc_wall_side", "left", "-bc_wall_normal", f"{INSIDE} Pa", "-bc_rim_type", "traction", "-bc_rim_side", "right",
         "-bc_rim_normal", f"{OUTSIDE} Pa")  # fmt: skip
solid = well(0.15, 0.0, "water", *SOLID)
judge("wells", "stiff skeleton: rate off Thiem's", abs(rate(solid, "water") / 0.15 - 1), 5e-4)
one, two = (well(0.5, 0.0, "water", "-stepper_type", "sdirk2", ranks=n) for n in (1, 2))
judge("wells", "1 and 2 ranks: pressures", largest_difference(two.probe("left")["p_Pa"], one.probe("left")["p_Pa"]), 1e-10)
judge("wells", "sdirk2: rate off Thiem's", abs(rate(one, "water") / 0.5 - 1), 5e-4)

wet = Run.of_case(CASE.parent / "wet_clays_well.yaml")
p_w = wet.snapshot(1.3 * 86400)["p_w"]
judge("wells", "between clays without gas, 1.3 days: steps", float(len(wet.balance["time_s"])), 200.0)
check("... lowest p_w over the 4 MPa of the well", p_w.min() / 4e6, (0.99, 1.1))
for name in ("water_error", "methane_error"):
    check(f"... {name}", np.max(np.abs(wet.balance[name])), 1e-12)
finish()
