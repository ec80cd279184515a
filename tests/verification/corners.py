#!/usr/bin/env python3
"""At the corners of a heater temperatures stay between those of body and heater.

(395), (446): at the corners of a heater, where the nodes' T is bilinear, its particles stay between what they start from and what
the heater has; implicit and hybrid, in equal cells and others; heat is conserved, ranks agree.  In space at the corners of a hot box, and
where three held sides of a body meet.
A heater in hydrate; heated too fast for its cells the end of the run says so.
"""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, scratch, table

CASES = Path(__file__).parent / "cases"
START, HEATER = 11.0, 60.0


def field(name, *more, **keywords):
    run = Run.of_case(CASES / name, *more, **keywords)
    return run, np.array([fields["T"][:, 0] for _, fields in run.snapshots()])


rows = []
GRADED = ("-grid_cells", "auto,auto", "-grid_spacing_x", "{table: [0 m, 0.8 m, 2 m, 0.25 m, 3 m, 0.25 m, 5 m, 0.8 m]}", "-grid_spacing_y", "0.5 m")
WAYS = {"sdirk2": (), "euler": ("-stepper_type", "euler"), "hybrid": ("-stepper_type", "hybrid"), "sdirk2, graded": GRADED,
        "hybrid, graded": ("-stepper_type", "hybrid", *GRADED)}  # fmt: skip
found = {}
for way, options in WAYS.items():
    run, T = found[way] = field("heater_corners.yaml", *options)
    rows.append((way, T.min(), T.max()))
    judge("corners", f"{way}: particles warmer than the heater, K", max(T.max() - HEATER, 0.0), 0.05)
    judge("corners", f"{way}: balance of heat, of 1 K of the body", np.max(np.abs(run.balance["heat_error"])), 1e-8)
    judge("corners", f"{way}: particles colder than the start, of 49 K", max(START - T.min(), 0.0) / (HEATER - START), 0.02)
table(("integrator, cells", "coldest, degC", "warmest, degC"), rows)
SHORT = ("-stepper_type", "hybrid", "-stepper_cfl", "0.02")  # both tend to the same: 0.23, 0.042, 0.0073 K at 0.5, 0.1, 0.02
SQUARER = ("-grid_cells", "auto,15", "-grid_spacing_x", "{table: [0 m, 0.46 m, 2 m, 0.33333 m, 3 m, 0.33333 m, 5 m, 0.46 m]}")  # (444), which acts in cells longer than that, is not in hybrid
short = {"": field("heater_corners.yaml", *SHORT)[1], ", graded": field("heater_corners.yaml", *SHORT, *SQUARER)[1]}
implicit = {"": found["sdirk2"][1], ", graded": field("heater_corners.yaml", *SQUARER)[1]}
for cells in short:
    apart = np.max(np.abs(short[cells][-1] - implicit[cells][-1]))
    judge("corners", f"hybrid against sdirk2 at a fiftieth of its stable step{cells}, K", apart, 0.02)
two = field("heater_corners.yaml", ranks=2)[1]
judge("corners", "2 ranks against 1, K", np.max(np.abs(two - found["sdirk2"][1])), 1e-6)
# In space the nodes' T is linear along each of three axes: with the derivatives by pairs alone particles in the cube's corners were 18 % of the jump (hybrid 9 %) below the sides, those in the box's corners 2.4 % above it.
for way, options in (("sdirk2", ()), ("euler", WAYS["euler"]), ("hybrid", (*WAYS["hybrid"], "-stepper_cfl", "0.2"))):
    run, T = field("heater_corners_3d.yaml", *options)
    judge("corners", f"hot box in a cold cube, {way}: colder than the sides, of the jump", max(10 - T.min(), 0.0) / 10, 0.005)
    judge("corners", f"... {way}: warmer than the box, of the jump", max(T.max() - HEATER, 0.0) / 40, 0.001)
    judge("corners", f"... {way}: balance of heat, of 1 K of the body", np.max(np.abs(run.balance["heat_error"])), 1e-8)
    if way != "euler":
        judge("corners", f"... {way}: 2 ranks against 1, K", np.max(np.abs(field("heater_corners_3d.yaml", *options, ranks=2)[1] - T)), 1e-6)
cut, folder = ("heater_corners_3d.yaml", "-quiet"), scratch()
straight = field(*cut)[1]
field(*cut, "-stepper_max_steps", "20", out=folder)
check_true("... sdirk2: a restart after 20 steps goes on bit for bit", np.array_equal(field(*cut, "-restart", folder / "checkpoint.h5", out=folder)[1][-1], straight[-1]))
LONGER = ("-boundaries", "heater", "-grid_upper", "3 m,4.2 m,3 m", "-region_rock_upper", "3 m,4.2 m,3 m", "-region_core_lower", "0 m,0 m,0 m", "-region_core_upper", "0.5 m,2.1 m,1.5 m")
for way in ("sdirk2", "hybrid"):
    judge("corners", f"a heater that ends within a side, cells 1.4 times as long as wide, {way}: colder than the start, of the jump", max(20 - field("heater_corners_3d.yaml", *LONGER, *WAYS[way])[1].min(), 0.0) / 40, 0.001)
# In hydrate on cells of 1 m, heated within a day.
rod, T = field("heater_rod.yaml", "-quiet")
judge("corners", "a heater in hydrate, coarse: colder than the start, K", max(14.4 - T.min(), 0.0), 0.6)
judge("corners", "... warmer than the heater, K", max(T.max() - HEATER, 0.0), 0.12)
rod, T = field("heater_rod.yaml", "-quiet", "-bc_rod_temperature", "{ramp: [14.4 degC, 60 degC, 0 h, 4 h]}")
check_true("... heated within four hours, which the end says", "colder than start, conditions" in rod.output, rod.output[-300:])
check_true("... and the summary", "  T of particles from " in (rod.out / "summary.txt").read_text())
finish()
