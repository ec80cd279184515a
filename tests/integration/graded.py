#!/usr/bin/python3
"""A grid whose cells differ: 1 and 2 ranks agree, a restart goes on bit for bit, hybrid agrees with implicit steps and explicit with it, and the files say where its lines are.

The block of two materials of ranks.py, squeezed by a tenth: particles pass from cell to cell, and from rank to rank.  Along x cells are fine where the
materials meet, along y at the drained top.
"""
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
import clathra  # noqa: E402
from common import Run, binary, check, check_true, finish, launch, scratch  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "block.yaml"
GRID = ("-quiet", "-grid_cells", "auto,auto", "-grid_spacing_x_table", "0 m,0.15 m,0.3 m,0.04 m,0.6 m,0.15 m",
        "-grid_spacing_y_table", "0 m,0.2 m,0.7 m,0.05 m,0.8 m,0.05 m,1 m,0.1 m")  # fmt: skip
TIGHT = ("-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9", "-stepper_adapt", "no", "-stepper_dt", "20 s")
FAST = ("-mat_soft_permeability_k0", "1e-10 m^2", "-mat_firm_permeability_k0", "1e-10 m^2", "-bc_load_normal_ramp", "3.4 MPa,4.6 MPa,0 s,0.2 s",
        "-time_end", "0.06 s", "-output_times", "0.06 s", "-output_probe_every", "0.02 s")  # fmt: skip
NAMES = ("p_w", "p_g", "T", "S_h", "position", "displacement", "stress", "v_s", "mass_water", "mass_hydrate")


def worst(a, b, names=NAMES):
    """Largest difference over the size of its variable, over particles."""
    found = 0.0
    for (_, x), (_, y) in zip(a.snapshots(), b.snapshots(), strict=True):
        found = max([found, *(np.max(np.abs(x[n] - y[n])) / np.max(np.abs(x[n])) for n in names if np.any(x[n]))])
    return found


def the_same(a, b):
    return all(np.array_equal(x[n], y[n]) for (_, x), (_, y) in zip(a.snapshots(), b.snapshots(), strict=True) for n in x)


# ---------------------------------------------------------------- implicit
runs = {n: Run.of_case(CASE, *GRID, *TIGHT, ranks=n) for n in (1, 2)}
u = runs[1].probe("top")["u_y_m"].min() / 0.8
check_true("the block is squeezed", -0.2 < u < -0.02, f"{100 * u:.1f} % of its height")
check("water and methane balance", np.max(np.abs([runs[1].balance[f"{w}_error"] for w in ("water", "methane")])), 1e-9)
check("sdirk2: 2 ranks against 1", worst(runs[1], runs[2]), 1e-9)

out = scratch() / "cut"
half = launch(binary(), CASE, *GRID, *TIGHT, "-stepper_max_steps", "8", out=out)
cut = Run.of_case(CASE, *GRID, *TIGHT, "-restart", out / "checkpoint.h5", out=out)
check_true("sdirk2: cut in two, the same bit for bit", half.returncode == 0 and the_same(runs[1], cut))
other = launch(binary(), CASE, *GRID[:-1], "0 m,0.2 m,0.7 m,0.06 m,0.8 m,0.06 m,1 m,0.1 m", *TIGHT, "-restart", out / "checkpoint.h5", out=scratch() / "other")
check_true("a restart on other lines is refused", other.returncode == 2 and "grid" in other.stdout, other.stdout[-200:])

# ---------------------------------------------------------------- hybrid
fast = Run.of_case(CASE, *GRID, *FAST, "-stepper_tol", "1e-4", "-stepper_dt", "1e-3 s", "-stepper_dt_max", "0.005 s")
hybrid = {n: Run.of_case(CASE, *GRID, *FAST, "-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "3e-5 s", ranks=n) for n in (1, 2)}
check("hybrid: 2 ranks against 1", worst(hybrid[1], hybrid[2]), 1e-8)
check("hybrid: water and methane balance", np.max(np.abs([hybrid[1].balance[f"{w}_error"] for w in ("water", "methane")])), 1e-12)
for name, bar in (("p_w", 0.01), ("displacement", 0.02)):
    check(f"hybrid against sdirk2: {name}", worst(fast, hybrid[1], (name,)), bar)
drag = Run.of_case(CASE, *GRID, *FAST, "-stepper_type", "explicit", "-stepper_adapt", "no", "-stepper_dt", "1.5e-5 s")
check("explicit, whose drag is explicit too, against hybrid", worst(hybrid[1], drag, ("p_w", "displacement", "stress")), 0.01)
out = scratch() / "cut"
half = launch(binary(), CASE, *GRID, *FAST, "-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "3e-5 s", "-stepper_max_steps", "512", out=out)
cut = Run.of_case(CASE, *GRID, *FAST, "-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "3e-5 s", "-restart", out / "checkpoint.h5", out=out)
check_true("hybrid: cut in two, the same bit for bit", half.returncode == 0 and len(cut.snapshots()) > 0 and the_same(hybrid[1], cut))

# ---------------------------------------------------------------- files
run = clathra.Run(runs[1].out)
x, y = run.lines
check_true("lines: from end to end, through the places of the table", x[0] == 0.0 and x[-1] == 0.6 and 0.3 in x and {0.7, 0.8} <= set(y) and y[-1] == 1.0)
check_true("lines: as many as the case says", [len(x) - 1, len(y) - 1] == run.case["grid_cells"], run.case["grid_cells"])
h = np.diff(y)
check_true("cells: as wide as asked for", np.all(h <= 0.2 + 1e-9) and np.all(np.diff(x) <= 0.15 + 1e-9) and h[(y[:-1] >= 0.7) & (y[1:] <= 0.8)].max() <= 0.05 + 1e-9)
check("cells: ratio of neighbours", max(np.max(np.r_[d[1:] / d[:-1], d[:-1] / d[1:]]) for d in (h, np.diff(x))), 2.0)
text = (runs[1].out / "grid.xdmf").read_text()
shown = [np.array(re.findall(r"\S+", part), float) for part in re.findall(r'Format="XML">([^<]*)<', text.split("<Time")[1])]
check_true("grid.xdmf: a mesh with these lines", "3DRectMesh" in text and np.array_equal(shown[0], x) and np.array_equal(shown[1], y))
first = clathra.Run(runs[1].out).particles(0.0)
check("particles: their domains fill the block", abs(4 * np.sum(np.prod(first["half_length"], axis=1)) / 0.48 - 1), 1e-12)
again = launch(binary(), runs[1].out / "case.yaml", "-quiet", "-time_end", "20 s", "-output_times", "0 s", out=scratch() / "again")
check_true("the resolved case is a case", again.returncode == 0, again.stdout[-200:])
finish()
