#!/usr/bin/env python3
"""Which mean of the error over the particles buys most: n of (292) in docs/equations.md.

error_norm.py [CLATHRA] [SCENE ...]

Every scene runs with exponents 2, 8 and 16 at five tolerances.  A line gives steps and the largest error of any particle at the end, against a
run at a fiftieth of the default tolerance (in time alone, on the same grid): pressures, T and displacement over their largest change, S_h and
S_w over 0.1.  The last column is what n = 2 reaches in as many steps as n = 8 takes at the default tolerance, between its tolerances by logarithms.
"""
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "verification"), str(ROOT / "scripts")]
from clathra import read_csv, read_snapshots  # noqa: E402
from common import CASES, launch  # noqa: E402

HERE = ROOT / "tests" / "verification" / "cases"
SCENES = {  # name: (case, options, end)
    "BP2": (CASES / "bp2", (), "1000 s"),
    "Masuda": (CASES / "masuda", (), "3600 s"),
    "century, cells of 5 m": (CASES / "century", ("-grid_cells", "1,21", "-grid_upper", "1 m,105 m"), "1.5778e10 s"),
    "century, cells of 2.5 m": (CASES / "century", ("-grid_cells", "1,42", "-grid_upper", "1 m,105 m"), "1.5778e10 s"),
    "century_hydrate, cells of 3 m": (CASES / "century_hydrate", ("-grid_cells", "1,34"), "500 a"),
    "gas let into a tenth of water": (HERE / "no_gas_inflow.yaml", ("-grid_cells", "1,80"), "600 s"),
    "heater": (HERE / "heater.yaml", (), "2 d"),
    "McWhorter-Sunada": (CASES / "mcwhorter_sunada", (), None),
}
EXPONENTS, TOL, FINE = (2, 8, 16), (4e-3, 2e-3, 1e-3, 5e-4, 2.5e-4), 2e-5
FIELDS = {"p_w": None, "p_g": None, "T": None, "S_h": 0.1, "S_w": 0.1, "displacement": None}  # what counts as one; None: the largest change


def run(program, scene, *options):
    """(steps, first snapshot, last snapshot)."""
    case, more, end = SCENES[scene]
    out = Path(tempfile.mkdtemp(prefix="error-norm-"))
    until = ("-time_end", end, "-output_times", f"0 s,{end}") if end else ()
    done = launch(program, case, "-quiet", *more, *until, *options, out=out, timeout=3000)
    if done.returncode:
        raise SystemExit(f"{scene} {options}: {done.stdout[-400:]}")
    snapshots = read_snapshots(out)
    return len(read_csv(out / "balance.csv")["step"]), snapshots[0][1], snapshots[-1][1]


def worst(found, fine, first):
    """Largest error of any particle, and of which field."""
    errors = {}
    for name, scale in FIELDS.items():
        if name in fine and name in first:
            change = np.max(np.abs(fine[name] - first[name]))
            if scale or change > 1e-9 * np.max(np.abs(fine[name])):
                errors[name] = np.max(np.abs(found[name] - fine[name])) / (scale or change)
    name = max(errors, key=errors.get)
    return errors[name], name


def main():
    given = sys.argv[1:]
    program = given.pop(0) if given and Path(given[0]).is_file() else str(ROOT / "build" / "clathra")
    print("| | n | " + " | ".join(f"tolerance {t:g}" for t in TOL) + " | n = 2 at the steps of 1e-3 |\n" + "|---" * (len(TOL) + 3) + "|")
    for scene in given or SCENES:
        _, _, fine = run(program, scene, "-stepper_tol", FINE)
        rows = {}
        for n in EXPONENTS:
            rows[n] = []
            for tol in TOL:
                steps, first, last = run(program, scene, "-stepper_tol", tol, "-stepper_error_exponent", n)
                rows[n].append((steps, *worst(last, fine, first)))
        two = np.log([[steps, error] for steps, error, _ in rows[2]])
        for n, row in rows.items():
            steps = np.log(row[2][0])
            same = f"{np.exp(np.interp(steps, two[:, 0], two[:, 1])):.1e}" if two[0, 0] <= steps <= two[-1, 0] else ""
            print(f"| {scene} | {n} | " + " | ".join(f"{k}, {e:.1e} ({f})" for k, e, f in row) + f" | {same} |", flush=True)


if __name__ == "__main__":
    main()
