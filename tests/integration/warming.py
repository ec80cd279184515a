#!/usr/bin/env python3
"""cases/slope_warming on a coarse grid, its first 35 years, by `auto`.

cases/slope_warming on cells of 25 m, its first 35 years of warming: implicit steps of weeks and more by `auto`, which are those of sdirk2 with the same
stabilisations; what the warmth takes of the hydrate; nothing is lost; two ranks; hybrid alone refuses the scene."""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, Run, binary, check, check_true, finish, judge, launch, scratch  # noqa: E402

from clathra.units import YEAR  # noqa: E402  python/, which common puts on the path

COARSE = ("-quiet", "-grid_upper", "500 m, 125 m", "-grid_cells", "20,5", "-stage_settle_end", "10 a", "-stage_warm_end", "45 a",
          "-output_times", "10 a, 30 a", "-output_every", "0 s")  # fmt: skip
WARM = ("-bc_sea_temperature", "{ramp: [2.9 degC, 5.9 degC, 10 a, 110 a]}")
COLD = ("-bc_sea_temperature", "2.9 degC")


def slope(*options, sea=WARM, **keywords):
    return Run.of_case("slope_warming", *COARSE, *sea, *options, **keywords)


def left(run):
    """Share of the hydrate that is left."""
    return run.balance["hydrate_kg"][-1] / run.balance["hydrate_kg"][0]


def warmer(run, cold):
    """(What the crest is warmer by, and what conduction without hydrate gives at most: the sea's share of 3 K, K)."""
    now, then = run.probe("crest")["T_degC"][-1], cold.probe("crest")["T_degC"][-1]
    return now - then, (0.1, 0.35 * 3)


run = slope()
last = run.snapshots()[-1][1]
steps = np.diff(run.balance["time_s"][run.balance["time_s"] > 15 * YEAR]) / 86400
check_true("implicit for as long as the slope holds", "-> hybrid" not in run.output)
check("mean step from five years after the beginning on, days", steps.mean(), (20.0, 1000.0))
cold = slope(sea=COLD)
judge("slopes", "slope_warming on 25 m: hydrate that the warmth takes in 35 years, share of all", left(cold) - left(run), (0.09, 0.13))  # cells of 8 m: 0.28
check("T of the crest, 8 m below the sea floor, above that under a cold sea (K)", *warmer(run, cold))
for what in ("water", "methane"):
    judge("slopes", f"... {what}, largest error of any step", np.max(np.abs(run.balance[f"{what}_error"])), 1e-12)
alone = slope("-stage_warm_stepper_type", "sdirk2").snapshots()[-1][1]
check_true("the particles of sdirk2 alone, bit for bit", all(np.array_equal(v, alone[k]) for k, v in last.items()))
two = slope(ranks=2).snapshots()[-1][1]
judge("slopes", "... 2 ranks against 1, S_h", np.max(np.abs(last["S_h"] - two["S_h"])), 1e-4)
refused = launch(binary(), CASES / "slope_warming", "-stage_warm_stepper_type", "hybrid", "-case_check", out=scratch() / "out")
check_true("hybrid alone refuses its stabilisations", refused.returncode == 2 and "hybrid does not know stabilisation_donor" in refused.stdout, refused.stdout[-300:])
finish()
