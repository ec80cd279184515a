#!/usr/bin/env python3
"""Face temperatures that grow with depth are met exactly, wherever the body lies.

Face temperatures that grow with depth (425), (199): a linear temperature behind a surface of stairs is met exactly, wherever
the body lies in its cells and whichever way it is turned, from rest and from another start; in a block that shears and turns
ten degrees more everywhere are ten degrees more at the end; a block that falls sees what one at rest sees under a sea that
warms as fast.  sdirk2, euler and hybrid.
"""
from pathlib import Path

import numpy as np

import _shear_block
from common import Run, check, check_true, finish, judge, table

CASES = Path(__file__).resolve().parent / "cases"
SLOPE, BLOCK = CASES / "sea_temperature.yaml", CASES / "falling_block.yaml"
CORNERS = np.array([[0, 0], [300, 0], [150, 100], [0, 100]], float)
LINE = np.array([[0, 0], [0, 100], [150, 100], [300, 0], [0, 0]], float)
G, PER = np.array([1.7, -9.66]), 0.02
CELL = 16 * PER  # K


def points(x):
    return "[" + ", ".join(f"[{a:.6f} m, {b:.6f} m]" for a, b in x) + "]"


def as_it_is(x):
    return x


def slope(turn=as_it_is, *more, **keywords):
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
    return off[0], off[-1]


rows = []
swap = lambda x: x[:, ::-1]  # noqa: E731
for name, turn in (("as it is", as_it_is), ("moved by part of a cell", lambda x: x + [21.3, 9.7]), ("axes swapped", swap)):
    for kind in ("sdirk2", "hybrid"):
        begin, end = slope(turn, "-stepper_type", kind)
        rows.append((name, kind, begin, end))
        judge("surfaces", f"linear T behind stairs, {name}, {kind}: off after 20 years, of a cell's growth", end / CELL, 1e-9)
check("... on two ranks", slope(ranks=2)[1] / CELL, 1e-9)
begin, end = slope(as_it_is, "-region_slope_geothermal", "0 K/m", "-time_end", "1e5 a", "-output_times", "0 s, 1e5 a")
rows.append(("from 3 degC, after 1e5 years", "sdirk2", begin, end))
judge("surfaces", "linear T behind stairs, from 3 degC throughout: off in the end, of a cell's growth", end / CELL, 1e-5)
table(("scene", "integrator", "off at the start (K)", "off at the end (K)"), rows)
_, none = slope(as_it_is, "-bc_sea_with_depth", "0 K/m")
check_true("... and it is the condition that holds it", none > CELL, f"without with_depth off by {none:.3g} K")

# What a block sees of ten degrees more, in it and around it, while its top is sheared by 6.5 % of its height.
SIDES = ("left", "right", "top")
SHEARED = ("-fields", "solid,heat", "-gravity", "0 m/s^2,-9.81 m/s^2", "-mat_soft_solid_heat_capacity", "5 J/(kg K)", "-mat_soft_solid_conductivity", "1e4 W/(m K)",
           "-mat_soft_solid_expansion", "0 1/K", "-boundaries", ",".join(("base", "shear", *SIDES)), "-output_times", "0 s",
           *(w for s in SIDES for w in (f"-bc_{s}_type", "face_temperature", f"-bc_{s}_side", s, f"-bc_{s}_with_depth", "2 K/m")))  # fmt: skip
QUICK = ("-inertia", "yes", "-bc_shear_shear_ramp", "0 Pa,-0.1 MPa,0 s,0.1 s", "-time_end", "0.12 s", "-output_probe_every", "0.12 s", "-stepper_dt", "8e-5 s")


def sheared(T, *more):
    """Particles at the end, with T degC at the top of the sea and in the block at the start."""
    warm = (w for s in SIDES for w in (f"-bc_{s}_temperature", f"{T} degC"))
    return Run.of_case(_shear_block.CASE, *SHEARED, *warm, "-region_block_temperature", f"{T} degC", *more).snapshots()[-1][1]


for kind, more in (("sdirk2", ()), ("hybrid", QUICK)):
    one, other = (sheared(T, "-stepper_type", kind, *more) for T in (3, 13))
    judge("surfaces", f"10 K more in and around a sheared block, {kind}: T off by, K", np.max(np.abs(other["T"] - one["T"] - 10)), 1e-9)
    check(f"{kind}: ... it shears by, m", np.abs(one["displacement"][:, 0]).max(), (0.01, 0.5))
    check(f"{kind}: ... and T varies by, K", np.ptp(one["T"]), (0.1, 3.0))

# What a block sees that falls by g t^2/2: T^ + 2 K/m times that.  One at rest has its own place, and the same in time.
times = np.linspace(0, 1, 401)
rising = "{table: [" + ", ".join(f"[{t:.6f} s, {3 + 9.81 * t * t:.9f} degC]" for t in times) + "]}"
REST = ("-boundaries", "sea,base", "-bc_base_type", "fixed", "-bc_base_axis", "y", "-bc_base_position", "0 m", "-bc_sea_temperature", rising,
        "-mat_metal_elasticity_E0", "1e12 Pa")  # fmt: skip
rows = []
GRIDS = ("8,28", "16,56")
at_rest = {cells: Run.of_case(BLOCK, *REST, "-grid_cells", cells).snapshots() for cells in GRIDS}
for kind, more in (("sdirk2", ()), ("euler", ("-stepper_dt", "0.002 s")), ("hybrid", ("-stepper_adapt", "yes"))):
    apart = []
    for cells in GRIDS:
        fall = Run.of_case(BLOCK, "-stepper_type", kind, "-grid_cells", cells, *more).snapshots()[-1][1]
        rest = at_rest[cells][-1][1]
        gained = rest["T"].mean() - at_rest[cells][0][1]["T"].mean()
        apart.append(np.sqrt(np.mean((fall["T"] - rest["T"]) ** 2)) / gained)
    check(f"{kind}: the block fell by 4.905 m, off by", np.abs(fall["displacement"][:, 1] + 4.905).max(), 0.02)
    judge("surfaces", f"T of a block that falls through a warmer and warmer sea, {kind}, h = 1/8: rms apart from one at rest, of what it gains", apart[-1], 0.005)
    check(f"{kind}: ... order in h", np.log2(apart[0] / apart[1]), (1.0, 4.0))
    rows.append((kind, *apart))
table(("integrator", "apart, h = 1/4", "h = 1/8"), rows)
check("... it gains, K, of the sea's 9.81", gained, (6.0, 9.81))
finish()
