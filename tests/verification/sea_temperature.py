#!/usr/bin/env python3
"""Face temperatures that grow with depth (425), (199): a linear temperature behind a surface of stairs is met exactly, wherever
the body lies in its cells and whichever way it is turned, from rest and from another start; a block that falls sees what
one at rest sees under a sea that warms as fast.  sdirk2, euler and hybrid.
"""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, table

CASES = Path(__file__).resolve().parent / "cases"
SLOPE, BLOCK = CASES / "sea_temperature.yaml", CASES / "falling_block.yaml"
CORNERS = np.array([[0, 0], [300, 0], [150, 100], [0, 100]], float)
LINE = np.array([[0, 0], [0, 100], [150, 100], [300, 0], [0, 0]], float)
G, PER = np.array([1.7, -9.66]), 0.02
CELL = 16 * PER  # K


def points(x):
    return "[" + ", ".join(f"[{a:.6f} m, {b:.6f} m]" for a, b in x) + "]"


def slope(turn=lambda x: x, *more, **keywords):
    """Largest distance of T from the exact one at the start and at the end, K, with the scene put elsewhere by `turn`."""
    zero = turn(np.zeros((1, 2)))[0]
    g, corners, line = turn(G[None])[0] - zero, turn(CORNERS), turn(LINE)
    top = np.max(-corners @ g) / np.hypot(*g)
    # the grid is the one of the case, or the same turned by a right angle
    upper, cells = (("352 m, 128 m", "22,8") if abs(g[1]) > abs(g[0]) else ("128 m, 352 m", "8,22"))
    run = Run.of_case(SLOPE, "-gravity", f"{g[0]:.6f} m/s^2,{g[1]:.6f} m/s^2", "-grid_upper", upper, "-grid_cells", cells,
                      "-region_slope_polygon", points(corners), "-bc_sea_along", points(line), *more, **keywords)  # fmt: skip
    off = []
    for _, p in run.snapshots():
        depth = top + p["position"] @ g / np.hypot(*g)
        off.append(np.max(np.abs(p["T"][:, 0] - 3 - PER * depth)))
    return off[0], off[-1], run


rows = []
swap = lambda x: x[:, ::-1]  # noqa: E731
for name, turn in (("as it is", lambda x: x), ("moved by part of a cell", lambda x: x + [21.3, 9.7]), ("axes swapped", swap)):
    for kind in ("sdirk2", "hybrid"):
        begin, end, _ = slope(turn, "-stepper_type", kind)
        rows.append((name, kind, begin, end))
        judge("surfaces", f"linear T behind stairs, {name}, {kind}: off after 20 years, of a cell's growth", end / CELL, 1e-9)
check("... on two ranks", slope(lambda x: x, ranks=2)[1] / CELL, 1e-9)
_, end, run = slope(lambda x: x, "-region_slope_geothermal", "0 K/m", "-time_end", "1e5 a", "-output_times", "0 s, 1e5 a")
rows.append(("from 3 degC, after 1e5 years", "sdirk2", slope(lambda x: x, "-region_slope_geothermal", "0 K/m", "-time_end", "1 d", "-output_times", "0 s, 1 d")[0], end))
judge("surfaces", "linear T behind stairs, from 3 degC throughout: off in the end, of a cell's growth", end / CELL, 1e-5)
table(("scene", "integrator", "off at the start (K)", "off at the end (K)"), rows)
_, none, _ = slope(lambda x: x, "-bc_sea_with_depth", "0 K/m")
check_true("... and it is the condition that holds it", none > CELL, f"without with_depth off by {none:.3g} K")

# What a block sees that falls by g t^2/2: T^ + 2 K/m times that.  One at rest has its own place, and the same in time.
times = np.linspace(0, 1, 401)
rising = "{table: [" + ", ".join(f"[{t:.6f} s, {3 + 9.81 * t * t:.9f} degC]" for t in times) + "]}"
REST = ("-boundaries", "sea,base", "-bc_base_type", "fixed", "-bc_base_axis", "y", "-bc_base_position", "0 m", "-bc_sea_temperature", rising,
        "-mat_metal_elasticity_E0", "1e12 Pa")  # fmt: skip
rows = []
for kind, more in (("sdirk2", ()), ("euler", ("-stepper_dt", "0.002 s")), ("hybrid", ("-stepper_adapt", "yes"))):
    apart = []
    for cells in ("8,28", "16,56"):
        fall = Run.of_case(BLOCK, "-stepper_type", kind, "-grid_cells", cells, *more).snapshots()[-1][1]
        first, *_, (_, rest) = Run.of_case(BLOCK, *REST, "-grid_cells", cells).snapshots()
        gained = rest["T"].mean() - first[1]["T"].mean()
        apart.append(np.sqrt(np.mean((fall["T"] - rest["T"]) ** 2)) / gained)
    check(f"{kind}: the block fell by 4.905 m, off by", np.abs(fall["displacement"][:, 1] + 4.905).max(), 0.02)
    judge("surfaces", f"T of a block that falls through a warmer and warmer sea, {kind}, h = 1/8: rms apart from one at rest, of what it gains", apart[-1], 0.005)
    check(f"{kind}: ... order in h", np.log2(apart[0] / apart[1]), (1.0, 4.0))
    rows.append((kind, *apart))
table(("integrator", "apart, h = 1/4", "h = 1/8"), rows)
check("... it gains, K, of the sea's 9.81", gained, (6.0, 9.81))
finish()
