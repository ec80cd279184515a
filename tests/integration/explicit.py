#!/usr/bin/python3
"""hybrid and explicit: 1, 2 and 4 ranks agree, a restart goes on bit for bit, a step too long is refused, a failure ends with the last good state.

The block of two materials of ranks.py, squeezed by a tenth within 0.2 s: particles pass from cell to cell and from rank to rank.
"""
import re
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, Run, binary, check, check_true, finish, launch, scratch  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "block.yaml"
LOAD = ("-mat_soft_permeability_k0", "1e-10 m^2", "-mat_firm_permeability_k0", "1e-10 m^2",
        "-bc_load_normal_ramp", "3.4 MPa,4.6 MPa,0 s,0.2 s", "-time_end", "0.24 s", "-output_times", "0 s,0.12 s,0.24 s",
        "-output_probe_every", "0.02 s", "-quiet")  # fmt: skip
FIXED = ("-stepper_adapt", "no", "-checkpoint_every", "0.12 s")
# kind: step, end, cells; explicit drag ends where gas becomes immobile: its stable step falls with k_r; with these cells particles still pass a border
TYPES = {"hybrid": (4e-5, 0.24, "6,10"), "explicit": (4e-5, 0.1, "6,12")}


def run(kind, *options, **keywords):
    return Run.of_case(CASE, *LOAD, "-stepper_type", kind, *options, **keywords)


def worst(a, b):
    """Largest difference over the size of its variable, over histories and particles."""
    found = max(np.max(np.abs(a.probes[c] - b.probes[c])) / (np.max(np.abs(a.probes[c])) or 1.0) for c in a.probes if not c.endswith("u_x_m"))
    for (_, x), (_, y) in zip(a.snapshots(), b.snapshots(), strict=True):
        for name in ("p_w", "p_g", "T", "S_h", "position", "displacement", "stress", "v_s", "mass_water", "mass_hydrate"):
            found = max(found, np.max(np.abs(x[name] - y[name])) / np.max(np.abs(x[name])) if np.any(x[name]) else 0.0)
    return found


def owners(path):
    with h5py.File(path, "r") as file:
        return file["particles/rank"][()]


for kind, (step, end, cells) in TYPES.items():
    fixed = (*FIXED, "-stepper_dt", f"{step} s", "-time_end", f"{end} s", "-output_times", f"0 s,{end} s", "-grid_cells", cells)
    runs = {n: run(kind, *fixed, ranks=n) for n in (1, 2, 4)}
    u = runs[1].probe("top")["u_y_m"]
    print(f"{kind}: the top comes down by {-100 * u.min() / 0.8:.1f} % of the height; water balance {np.max(np.abs(runs[1].balance['water_error'])):.1e}")
    check_true(f"{kind}: the block is squeezed", -0.2 < u.min() / 0.8 < -0.02)
    check(f"{kind}: water and methane balance", np.max(np.abs([runs[1].balance[f"{w}_error"] for w in ("water", "methane")])), 1e-12)
    dt = runs[1].balance['dt_s']
    check_true(f"{kind}: the step is the fixed one", np.allclose(dt, step, rtol=1e-9), f"{dt.min():.12g} to {dt.max():.12g} s")
    for n in (2, 4):
        check(f"{kind}: {n} ranks against 1", worst(runs[1], runs[n]), 1e-8)
        first = run(kind, *fixed, "-time_end", f"{step} s", "-output_times", "0 s", ranks=n)
        moved = int(np.sum(owners(first.out / "checkpoint.h5") != owners(runs[n].out / "checkpoint.h5")))
        check_true(f"{kind}: particles changed ranks", moved > 0, f"{moved} on {n} ranks")

for ranks in (1, 2):
    straight, out = run("hybrid", ranks=ranks), scratch() / "cut"
    half = launch(binary(), CASE, *LOAD, "-stepper_type", "hybrid", "-stepper_max_steps", straight.steps(4), ranks=ranks, out=out)
    check_true("first part ends", half.returncode == 0)
    cut = run("hybrid", "-restart", out / "checkpoint.h5", ranks=ranks, out=out)
    same = all(np.array_equal(straight.probes[c], cut.probes[c]) for c in straight.probes)
    check_true(f"cut in two on {ranks} rank(s): the same bit for bit", same and len(straight.time) == len(cut.time))

# refused before anything is written
out = scratch() / "refused"
r = launch(binary(), CASE, *LOAD, "-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "1e-2 s", out=out)
said = r.stdout
check_true("a step above the stable one is refused", r.returncode == 2 and "stable step" in said and "waves in the mixture" in said and not out.exists(), said[-200:])
r = launch(binary(), CASE, *LOAD, "-stepper_type", "hybrid", "-inertia", "no", out=out)
check_true("inertia: no is refused", r.returncode == 2 and "inertia: no" in r.stdout and not out.exists(), r.stdout[-200:])

r = launch(binary(), CASES / "terzaghi", "-quiet", "-stepper_type", "hybrid", "-mat_clay_water_bulk_modulus", "incompressible",
           "-inertia", "yes", out=out)  # fmt: skip
check_true("water without compressibility is refused", r.returncode == 2 and "no stable step" in r.stdout and not out.exists(), r.stdout[-200:])

# forced, it fails, is rolled back and cut, and at last ends with a state that is good
r = launch(binary(), CASE, *LOAD, "-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "1e-2 s", "-stepper_force_dt", "yes",
           "-stepper_max_failures", "2", out=out)  # fmt: skip
check_true("forced: ends with exit code 3 and says why", r.returncode == 3 and "Given up" in r.stdout and "refused" in r.stdout, r.stdout[-300:])

# particles are worked on in blocks; the one that fails is named, under the load, and not the first of its block
punched = launch(binary(), CASE, *LOAD, "-quiet", "-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "1e-5 s", "-stepper_max_failures", "1", "-bc_load_normal_ramp", "4 GPa,4 GPa,0 s,1 s",
                 "-bc_load_from", "0.4 m", "-bc_load_to", "0.5 m", out=scratch() / "punched")  # fmt: skip
place = re.search(r"Given up at .*(?:no open pores are left|a pressure or temperature left its range) .*near \((\S+), (\S+)\) m", punched.stdout)
check_true("punched: says where, under the load or beside it", punched.returncode == 3 and place and 0.4 <= float(place[1]) <= 0.55 and float(place[2]) > 0.65, punched.stdout[-400:])

# what ends with ever shorter steps is ended: at the edge of the grid at once, elsewhere by (372)
flying = Path(__file__).resolve().parents[1] / "verification" / "cases" / "flying.yaml"
for ranks in (1, 2):
    gone = launch(binary(), flying, "-quiet", "-time_end", "2 s", "-output_times", "2 s", out=scratch() / f"gone{ranks}", ranks=ranks)
    check_true(f"a block falls off the grid, {ranks} rank(s): given up by name, at once", gone.returncode == 3 and "refused (" not in gone.stdout
               and "a particle leaves the background grid (left the grid)" in gone.stdout and "a larger grid" in gone.stdout, gone.stdout[-400:])  # fmt: skip
out_shrunk = scratch() / "shrunk"
shrunk = launch(binary(), CASE, *LOAD, "-stepper_type", "hybrid", "-stepper_max_failures", "1000", "-bc_load_normal_ramp", "4 GPa,4 GPa,0 s,1 s",
                "-bc_load_from", "0.4 m", "-bc_load_to", "0.5 m", out=out_shrunk)  # fmt: skip
check_true("pores that close for good: given up once the step is a millionth", shrunk.returncode == 3 and "the step of hybrid has come down from" in shrunk.stdout
           and shrunk.stdout.count("refused (") < 60 and (out_shrunk / "checkpoint.h5").exists(), f"{shrunk.stdout.count('refused (')} refused")  # fmt: skip

with h5py.File(out / "checkpoint.h5", "r") as file:
    check_true("forced: the saved state is finite", all(np.all(np.isfinite(v[()])) for v in file["particles"].values()))
finish()
