#!/usr/bin/env python3
"""Blocks that meet touch through the grid, without a law of contact, and part again.

Blocks that meet (cases/meeting.yaml): what has torn loose and comes down on what lies there touches through the grid, without a law of contact.

Two bars of one length, the lower one on a rigid floor: waves of impact run through both and are back after 2 L/c; after 4 L/c the upper bar
leaves with the speed it came with, and the lower one is at rest without stress.  So all of gravity's work is kinetic energy again, they come
no nearer than they touch, and nothing holds them together.  hybrid at three steps, sdirk2 with little of the ghost penalty, which is a damping of what is
beside the surface; ranks.
"""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, table

CASE = Path(__file__).parent / "cases" / "meeting.yaml"
CELL = 0.25
SDIRK2 = ("-stepper_type", "sdirk2", "-stepper_adapt", "no", "-stepper_dt", "2.5e-4 s")


def fall(*options, **keywords):
    return Run.of_case(CASE, "-quiet", *options, **keywords)


def bounce(run):
    """(share of gravity's work that is kinetic energy in the end, share of the speed that comes back, least distance in cells, speed of the lower bar in the end over that of the fall)."""
    shown, b = run.snapshots(), run.balance
    upper = shown[0][1]["initial_position"][:, 1] > 2.5
    speed = np.array([p["v_s"][upper, 1].mean() for _, p in shown])
    apart = min(np.min(p["position"][upper, 1] - p["half_length"][upper, 1]) - np.max(p["position"][~upper, 1] + p["half_length"][~upper, 1]) for _, p in shown)
    end = shown[-1][1]
    return b["kinetic_energy_J"][-1] / b["gravity_work_J"][-1], -speed.max() / speed.min(), apart / CELL, abs(end["v_s"][~upper, 1].mean() / speed.min())


if __name__ == "__main__":
    rows, runs = [], {}
    for name, options in (("hybrid, cfl 0.8", ()), ("hybrid, cfl 0.4", ("-stepper_cfl", "0.4")), ("hybrid, cfl 0.2", ("-stepper_cfl", "0.2")),
                          ("sdirk2, ghost penalty 1e-3", (*SDIRK2, "-stabilisation_ghost_penalty", "1e-3")), ("sdirk2, ghost penalty 0.1", SDIRK2)):  # fmt: skip
        runs[name] = fall(*options)
        rows.append((name, *bounce(runs[name])))
    table(["integrator", "kinetic energy over gravity's work", "speed that comes back", "nearest, in cells", "lower bar after, of the speed"], rows)
    found = {name: values for name, *values in rows}
    coarse, middle, fine = (1 - found[f"hybrid, cfl {c}"][0] for c in (0.8, 0.4, 0.2))
    judge("slopes", "blocks that meet, hybrid: kinetic energy that does not come back, of gravity's work", coarse, 0.03, 0.01, "%")
    check("... falls with the step, half of it: share left", middle / coarse, (0.4, 0.65))
    check("... a quarter", fine / middle, (0.4, 0.65))
    judge("slopes", "blocks that meet, sdirk2 with a ghost penalty of 1e-3: kinetic energy that does not come back", 1 - found["sdirk2, ghost penalty 1e-3"][0], 0.04, 0.01, "%")
    judge("slopes", "blocks that meet, planted: a ghost penalty of 0.1: kinetic energy that does not come back", 1 - found["sdirk2, ghost penalty 0.1"][0], (0.1, 1), 0.01, "%")
    for name, values in found.items():
        judge("slopes", f"blocks that meet, {name}: nearest, in cells", values[2], (0.5, 1.0))
        judge("slopes", f"blocks that meet, {name}: speed of the lower bar after, of that of the fall", values[3], 0.03, 0.01, "%")
        check_true(f"{name}: no step refused", ", 0 refused" in runs[name].output)
    once = ("-output_every", "0.5 s")
    last = fall(*once).snapshots()[-1][1]
    for ranks in (2, 4):
        many = fall(*once, ranks=ranks).snapshots()[-1][1]
        judge("slopes", f"blocks that meet, {ranks} ranks against 1: place, m", np.max(np.abs(many["position"] - last["position"])), 1e-10)
    finish()
