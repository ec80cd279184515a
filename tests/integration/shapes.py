#!/usr/bin/python3
"""Bodies that are not boxes: the same on 1, 2 and 4 ranks, from the resolved case, from the command line, across a
restart; a checkpoint of another shape is refused.

The scene, cases/hill.yaml, has every shape and every way to name faces.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run, binary, check, check_true, finish, launch, scratch  # noqa: E402

HILL = Path(__file__).resolve().parent / "cases" / "hill.yaml"
TIGHT = ("-quiet", "-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10")
HYBRID = ("-quiet", "-inertia", "yes", "-stepper_type", "hybrid", "-time_end", "0.02 s", "-output_times", "0 s,0.02 s",
          "-stepper_dt", "1e-4 s", "-bc_load_normal_ramp", "0 Pa,100 kPa,0 s,0.02 s", "-checkpoint_every", "0 s")  # fmt: skip
FILES = ("probes.csv", "meters.csv")


def hill(*options, **keywords):
    return Run.of_case(HILL, *options, **keywords)


def same_files(a, b):
    return all((a.out / f).read_bytes() == (b.out / f).read_bytes() for f in FILES)


def worst(a, b):
    """Largest difference over the size of its variable, in particles (sorted by number) and meters."""
    found = 0.0
    for (_, x), (_, y) in zip(a.snapshots(), b.snapshots(), strict=True):
        for name in ("position", "half_length", "volume", "mass_solid", "T", "stress", "displacement", "region"):
            found = max(found, np.max(np.abs(x[name] - y[name])) / (np.max(np.abs(x[name])) or 1.0))
    for name, x in a.csv("meters.csv").items():
        found = max(found, np.max(np.abs(x - b.csv("meters.csv")[name])) / (np.max(np.abs(x)) or 1.0))
    return found


# --- ranks
runs = {n: hill(*TIGHT, ranks=n) for n in (1, 2, 4)}
one = runs[1]
for n in (2, 4):
    check(f"{n} ranks against 1", worst(one, runs[n]), 1e-9)
fast = {n: hill(*HYBRID, ranks=n) for n in (1, 2)}
check("hybrid: 2 ranks against 1", worst(fast[1], fast[2]), 1e-9)

# --- what the scene shows: it was loaded and heated where the case says
end = one.snapshot(3600.0)
check_true("the crest comes down", one.probe("tip")["u_y_m"][-1] < -0.01, f"{one.probe('tip')['u_y_m'][-1]:.3g} m")
heat = {m: -one.csv("meters.csv")[f"{m}.heat_J"][-1] for m in ("slope", "crest", "crown")}
check_true("heat comes through slope and crown alone", heat["slope"] > 0 and heat["crown"] < 0 and heat["crest"] == 0, heat)
boulder = end["T"][end["region"] == 2]
check_true("the boulder stays warm", len(boulder) > 50 and boulder.mean() > 37, f"{boulder.mean():.3g} degC")
check_true("no particle in the tunnel", np.hypot(*(end["position"] - end["displacement"] - [12, 4]).T).min() > 1)

# --- the resolved case, the command line
again = Run.of_case(one.out / "case.yaml", *TIGHT)
check_true("the resolved case runs to the same", same_files(one, again) and worst(one, again) == 0.0)
resolved = [[line for line in (r.out / "case.yaml").read_text().splitlines() if not line.startswith(("#", "output_dir"))] for r in (one, again)]
check_true("... and resolves to itself", resolved[0] == resolved[1] and any("minus: [rock, boulder, lining]" in line for line in resolved[0]))
text = HILL.read_text()
folder = scratch()
plain = folder / "case.yaml"
plain.write_text(text.replace("{polygon: [[3 m, 3.2 m], [6 m, 3 m], [6.5 m, 5 m], [4 m, 5.1 m]],", "{polygon: [[0 m, 0 m], [1 m, 0 m], [1 m, 1 m]],")
                 .replace("minus: [rock, boulder, lining]", "minus: [rock]"))  # fmt: skip
given = Run.of_case(plain, *TIGHT, "-region_boulder_polygon", "[[3 m, 3.2 m], [600 cm,3 m],[6.5 m,5 m] , [4 m, 5.1 m]]",
                    "-region_soil_minus", "rock,boulder,lining")  # fmt: skip
check_true("shapes from the command line", same_files(one, given) and worst(one, given) == 0.0)

# --- restart
out = scratch() / "cut"
half = launch(binary(), HILL, *TIGHT, "-stepper_max_steps", "3", out=out)
rest = launch(binary(), HILL, *TIGHT, "-restart", out / "checkpoint.h5", out=out)
check_true("a restart goes on bit for bit", rest.returncode == 0 and same_files(one, Run(out)), f"codes {half.returncode}, {rest.returncode}")
for key, value in (("-region_lining_circle", "12 m,4 m,1.61 m"), ("-region_soil_below", "[[0 m, 4 m], [8 m, 8 m], [20 m, 8.2 m]]"),
                   ("-region_soil_minus", "rock,boulder,lining,tunnel"), ("-meter_slope_along", "[[0 m, 4 m], [8 m, 7.9 m]]"),
                   ("-bc_sun_along", "[[1 m, 4.5 m], [8 m, 8 m]]")):  # fmt: skip
    refused = launch(binary(), HILL, *TIGHT, "-restart", out / "checkpoint.h5", key, value, out=scratch() / "other")
    check_true(f"another {key[1:]} is refused", refused.returncode == 2 and "another case" in refused.stdout, refused.stdout.splitlines()[-1:])
finish()
