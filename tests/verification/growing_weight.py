#!/usr/bin/python3
"""`stepper_type: auto` on a cut whose weight grows over months until it slides.

stepper_type: auto on a cut whose weight grows over months (cases/growing_weight.yaml): implicit steps of days, hybrid for the seconds of the slide, implicit
steps of days again to the end.  sdirk2 alone steps over the slide; ground that holds never leaves sdirk2; a change and restarts around it leave everything as it was."""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "integration"))
import _files  # noqa: E402
from common import Run, changes, check_true, finish, judge, scratch  # noqa: E402

CASE = Path(__file__).parent / "cases" / "growing_weight.yaml"
TO_AND_FRO = [("sdirk2", "hybrid"), ("hybrid", "sdirk2")]
DAY, FIRM = 86400.0, ("-mat_soil_plasticity_cohesion_max", "3 kPa")


def cut(kind, *options, **keywords):
    return Run.of_case(CASE, "-quiet", "-stepper_type", kind, *options, **keywords)


run, over = cut("auto"), cut("sdirk2")
found, t, dt = changes(run), run.balance["time_s"], run.balance["dt_s"]
E_k = run.balance["kinetic_energy_J"]
check_true("implicit, hybrid for the slide and once more at most for what rings after it, implicit again",
           [c[1:] for c in found] in (TO_AND_FRO, 2 * TO_AND_FRO) and found[-1][0] - found[0][0] < 100, str(found))  # fmt: skip
bursts = np.flatnonzero(np.diff(run.balance["step"]) > 1) + 1  # rows of hybrid
first, second = int(bursts[0]), int(bursts[-1]) + 1  # advances until each change, a row each
judge("slopes", "a cut whose weight grows over months: steps of auto before the slide", float(first), 100.0)
judge("slopes", "... after it, which last 50 days", float(t.size - second), 100.0)
check_true("... and come to days again", dt[second:].max() > DAY, f"{dt[second:].max():.3g} s")
check_true("hybrid has all of it: the step before it is of hours", dt[first - 1] > 3600.0 and E_k[first - 1] < 1e-6 * E_k.max(), f"{dt[first - 1]:.3g} s, {E_k[first - 1]:.3g} J")
judge("slopes", "... the slide that hybrid carries lasts, s", t[second - 1] - t[first - 1], (1.0, 100.0))
check_true("it is one: E_k during it and after it", E_k.max() > 100 and E_k[-1] < 1e-6 * E_k.max(), f"{E_k.max():.3g}, {E_k[-1]:.3g} J")
check_true("sdirk2 alone comes to its end, too", over.code == 0, f"shortest step {over.balance['dt_s'].min():.3g} s")
held, alone = cut("auto", *FIRM), cut("sdirk2", *FIRM)
names = [n for n in _files.different(held.out, alone.out, ("probes.csv", "balance.csv")) if n.startswith(("fields", "probes", "balance"))]
check_true("ground that holds: sdirk2 bit for bit", not changes(held) and not names, ", ".join(names[:5]))

for what, cut_at in {"before the change": first - 1, "at the change": first, "after it": first + 1, "at the change back": second, "three steps after it": second + 3}.items():
    out = scratch() / "out"
    cut("auto", "-stepper_max_steps", run.steps(cut_at - 1), out=out)
    cut("auto", "-restart", out / "checkpoint.h5", out=out)
    names = _files.different(run.out, out)
    check_true(f"cut {what}: the same bit for bit", not names, ", ".join(names[:5]))
for ranks in (2, 4):
    many = changes(cut("auto", "-stepper_max_steps", run.steps(first + 7), ranks=ranks))
    check_true(f"{ranks} ranks go over to hybrid", [c[1:] for c in many] == [("sdirk2", "hybrid")] and np.isclose(many[0][0], found[0][0], rtol=1e-6), str(many))
mass = [np.sum(p["mass_solid"]) for _, p in run.snapshots()]
judge("slopes", "... mass of the solid, largest change", np.ptp(mass) / mass[0], 1e-14)
finish()
