#!/usr/bin/env python3
"""Conduction in cells longer than wide: nothing cools beside a heater.

Conduction in cells longer than wide (444): beside a heater that ends within a side T stays above that of the start, in the plane and about an axis, whichever
axis is the long one, with a body that cuts cells, on two ranks; and how far that is from fine cells; a linear T is met exactly; the product of the tangents is
the assembled matrix."""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, table

CASE = Path(__file__).parent / "cases" / "thin_cells.yaml"
ROW = "4.3"
TURNED = ("-grid_upper", "4 m,2 m", "-grid_cells", "8,20", "-region_wall_upper", "4 m,2 m", "-bc_heater_side", "bottom")
AXIS = ("-geometry", "axisymmetric", "-grid_lower", "0.1 m,0 m", "-grid_upper", "2.1 m,4 m", "-region_wall_lower", "0.1 m,0 m", "-region_wall_upper", "2.1 m,4 m")
HYBRID = ("-stepper_type", "hybrid")
CUT = ("-grid_lower", "-0.15 m,-0.65 m", "-grid_upper", "2.35 m,4.85 m", "-grid_cells", "25,11")


def case(*options, **keywords):
    run = Run.of_case(CASE, "-quiet", *options, **keywords)
    return run, run.snapshots()[-1][1]


def coldest(run):
    """Of the particles at the output times, below the 10 degC of the start, of the 40 K of the heater."""
    return (10 - min(v["T"].min() for _, v in run.snapshots())) / 40


rows = []
for name, options, bar in (("plane", (), 0.001), ("the long axis the other one", TURNED, 0.001), ("about an axis", AXIS, 0.001), ("body that cuts cells", CUT, 0.02), ("euler", ("-stepper_type", "euler"), 0.001),
                           ("hybrid", HYBRID, 0.001), ("hybrid, the long axis the other one", (*HYBRID, *TURNED), 0.001), ("hybrid, body that cuts cells", (*HYBRID, *CUT), 0.02)):
    below = coldest(case(*options)[0])
    rows.append((name, below))
    judge(ROW, f"heater in thin cells, {name}: T below the start, of the heater's", below, bar)
coarse, _ = case(*HYBRID, "-grid_cells", "8,8")
check_true("hybrid, on cells of 0.25 m: no step is refused, and nothing is warmer than the heater", " 0 refused" in coarse.output and max(v["T"].max() for _, v in coarse.snapshots()) < 50.0, coarse.output[-600:])
table(("T below the start, of the heater's", ""), rows)

# the answer of cells of 5 cm, means over the blocks of 0.1 m by 0.5 m that are the cells here
def blocks(v, size=(0.1, 0.5)):
    place = np.floor(v["position"] / size + 1e-9).astype(int)
    number = place[:, 0] * 8 + place[:, 1]
    return np.bincount(number, v["T"][:, 0]) / np.bincount(number)


_, fine = case("-grid_cells", "40,80")
judge(ROW, "heater in thin cells: T of cells against those of 5 cm, root of the mean square", np.sqrt(np.mean((blocks(case()[1]) - blocks(fine)) ** 2)), 1.04, unit="K")

# a linear T between two sides, the same on two ranks
LINEAR = ("-boundaries", "cold,warm", "-bc_cold_type", "temperature", "-bc_cold_axis", "y", "-bc_cold_position", "0 m", "-bc_cold_temperature", "10 degC", "-bc_warm_type", "temperature",
          "-bc_warm_axis", "y", "-bc_warm_position", "4 m", "-bc_warm_temperature", "18 degC", "-time_end", "4000 d", "-output_times", "4000 d")  # fmt: skip
_, v = case(*LINEAR, "-region_wall_temperature", "14 degC")
judge(ROW, "thin cells: steady linear T", np.max(np.abs(v["T"][:, 0] - 10 - 2 * v["position"][:, 1])), 1e-6, unit="K")
for name, options in (("sdirk2", ()), ("hybrid", HYBRID)):
    (run, one), (_, two) = (case(*options, ranks=ranks) for ranks in (1, 2))
    judge(ROW, f"heater in thin cells, {name}: two ranks apart from one", np.max(np.abs(one["T"] - two["T"])), 1e-9, unit="K")
    judge(ROW, f"heater in thin cells, {name}: balance of heat", np.max(np.abs(run.balance["heat_error"])), 1e-9)
products = [case("-newton_preconditioner", "reduced", "-newton_operator", o)[1]["T"] for o in ("assembled", "particles")]
judge(ROW, "heater in thin cells: assembled against particle by particle", np.max(np.abs(products[0] - products[1])), 1e-7, unit="K")
finish()
