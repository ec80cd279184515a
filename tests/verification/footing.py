#!/usr/bin/env python3
"""A rigid circular footing on elastic ground: its stiffness, smooth and rough.

A rigid circular footing on elastic ground (cases/footing): stiffness of a smooth disc on a half space, F = 2 E a w/(1 - nu^2)
(Boussinesq), and how much stiffer a rough one is, (1 - nu) ln(3 - 4 nu)/(1 - 2 nu) (Spence 1968).

The grid makes the disc wider by a part of a cell (order 1), the ends of the ground make it stiffer by a part of a/H: both are
extrapolated, from two grids and from two depths.  The ratio of rough to smooth hardly sees either.
"""
import numpy as np

from common import Run, check, finish, judge

E, NU, A = 20e6, 0.3, 1.0
EXACT = 2 * E * A / (1 - NU**2)
ONE_STEP = ("-stepper_dt", "1 s")
COARSE = ("-grid_cells", "32,33")
DEEP = ("-grid_upper", "16 m,16.25 m", "-region_ground_upper", "16 m,16 m", "-grid_cells", "64,65", "-bc_side_position", "16 m")


def stiffness(*options):
    m = Run.of_case("footing", *ONE_STEP, *options).csv("meters.csv")
    return -m["footing.force_N"][-1] / m["footing.position_m"][-1] / EXACT


smooth = ("-bc_footing_rough", "no")
coarse, fine, deep = (stiffness(*smooth, *more) for more in (COARSE, (), DEEP))
print(f"over that of the half space: h = a/4 {coarse:.4f}, h = a/8 {fine:.4f}, twice as deep {deep:.4f}")
grid = (2 * fine - coarse) / coarse
check("stiffness at h = a/4 over that of h to 0", 1 / grid, (1.0, 1.12))
check("stiffness of ground of depth 8 a over the half space's, h to 0", coarse * grid, (1.05, 1.2))
judge("plates", "smooth footing: stiffness, h to 0 and depth to infinity, against the half space", abs((2 * deep - coarse) * grid - 1), 0.04)
ratio = (1 - NU) * np.log(3 - 4 * NU) / (1 - 2 * NU)
for what, options, reference in (("h = a/4", COARSE, coarse), ("h = a/8", (), fine)):
    judge("plates", f"rough footing over smooth, {what}, against Spence", abs(stiffness(*options) / reference / ratio - 1), 5e-3)
finish()
