#!/usr/bin/python3
"""`stepper_type: auto` on a column that is loaded slowly, then suddenly, then unloaded slowly.

stepper_type: auto.  A saturated column is loaded slowly, then suddenly, then unloaded slowly: consolidation, a wave, and
consolidation again, each with its exact solution.  Which integrator works when; its answer against the exact one and
against either integrator alone; what a change leaves as it was; restarts around a change; ranks."""
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "integration"))
import _files  # noqa: E402
from _auto import CASE, EXACT, PHASES, Q, TIMES, WATCHED, column  # noqa: E402
from common import CASES, binary, changes, check_true, finish, judge, launch, scratch, table  # noqa: E402

def errors(run):
    """{curve: largest error over its range in each phase}."""
    found = {}
    for name, (probe, quantity, *_) in WATCHED.items():
        off = np.abs(run.at(probe, quantity, TIMES) - EXACT[name]) / np.ptp(EXACT[name])
        found[name] = [float(np.max(off[(TIMES > a) & (TIMES <= b)])) for a, b in PHASES]
    return found


# --------------------------------------------------------------------------------------------------- who works when
runs = {(kind, n): column(kind, cells=n) for kind, n in (("auto", 13), ("auto", 26), ("sdirk2", 26), ("hybrid", 26))}
off = {k: errors(r) for k, r in runs.items()}
print("error over the range of the curve, phase by phase")
table(["integrator", "cells", "curve", *(f"{a} ... {b} s" for a, b in PHASES), "steps"],
      [(kind, n, c, *(f"{e:.2e}" for e in off[kind, n][c]), int(runs[kind, n].balance["step"][-1])) for kind, n in runs for c in WATCHED])
run = runs["auto", 26]
found = changes(run)
check_true("implicit, hybrid for the wave, implicit again", [c[1:] for c in found] == [("sdirk2", "hybrid"), ("hybrid", "sdirk2")], str(found))
check_true("hybrid begins with the wave and ends when it has died", 20.0 < found[0][0] < 20.1 and 21.0 < found[1][0] < 60.0, str(found))
judge("slopes", "auto, slow load, wave, consolidation: u against the exact one, worst of all phases, of its range", max(off["auto", 26]["u(H)"]), 0.01)
judge("slopes", "... p", max(off["auto", 26]["p(H/2)"]), 0.04)
judge("slopes", "... p, its error over that of hybrid alone", max(off["auto", 26]["p(H/2)"]) / max(off["hybrid", 26]["p(H/2)"]), 1.2)
judge("slopes", "... p, its error over that on cells twice as large", max(off["auto", 26]["p(H/2)"]) / max(off["auto", 13]["p(H/2)"]), 0.7)
judge("slopes", "... sdirk2 alone damps the wave away: its error over that of auto", max(off["sdirk2", 26]["p(H/2)"]) / max(off["auto", 26]["p(H/2)"]), (5, 1000))
judge("slopes", "... steps of auto over those of hybrid", runs["auto", 26].balance["step"][-1] / runs["hybrid", 26].balance["step"][-1], 0.5)
judge("slopes", "... water, largest error of any step", np.max(np.abs(run.balance["water_error"])), 1e-13)
lines = re.findall(r"^  (sdirk2|hybrid) from \S+ s to \S+ s \([\d.]+ \w+\), \d+ steps", (run.out / "summary.txt").read_text(), re.M)
check_true("a line for each in summary.txt", lines == ["sdirk2", "hybrid", "sdirk2"], str(lines))
fixed = column("auto", "-stepper_adapt", "no", "-stepper_dt", "0.5 s")
check_true("with a fixed step it stays with what it chose", not changes(fixed) and "integrator chosen: sdirk2\n" in fixed.output)

# ---------------------------------------------------------------------- stabilisations that only implicit steps know
STABILISED = ("-stabilisation_donor", "yes", "-inertia", "yes", "-stepper_adapt", "yes", "-case_check")
chosen, refused = (launch(binary(), CASES / "buckley_leverett", *STABILISED, "-stepper_type", kind, out=scratch() / "out") for kind in ("auto", "hybrid"))
check_true("auto's implicit steps have them, hybrid goes without, and the start says so",
           chosen.returncode == 0 and "hybrid goes without stabilisation_donor" in chosen.stdout and "hybrid goes without" not in run.output, chosen.stdout[-300:])  # fmt: skip
check_true("... and hybrid alone refuses them", refused.returncode == 2 and "hybrid does not know stabilisation_donor" in refused.stdout, refused.stdout[-300:])

# ------------------------------------------------------------------------------- a change leaves everything as it was
rows = run.balance["time_s"]
first, second = (int(np.argmin(np.abs(rows - t))) for t, *_ in found)  # rows at each change
there = column("auto", "-stepper_max_steps", run.steps(first))
alone = column("sdirk2", "-stepper_max_steps", run.steps(first))
names = _files.different(there.out, alone.out, ("probes.csv", "balance.csv"))
check_true("particles and totals at a change are those of sdirk2 alone, bit for bit",
           changes(there) and {n.split("/")[-1] for n in names} <= {"kind", "votes", "patience", "since", "spent", "hold", "fresh", "err_old", "dt"}, ", ".join(names))  # fmt: skip

# ------------------------------------------------------------------------------------------------------ restart, ranks
for what, cut in {"before the change to hybrid": first - 1, "at it": first, "after it": first + 1, "at the change back": second, "after the change back": second + 1}.items():
    out = scratch() / "out"
    column("auto", "-stepper_max_steps", run.steps(cut), out=out)
    column("auto", "-restart", out / "checkpoint.h5", out=out)
    names = _files.different(run.out, out)
    check_true(f"cut {what}: the same bit for bit", not names, ", ".join(names[:5]))
# On half the cells; on 2 ranks all of it and cut, on 4 until hybrid has begun: a step of hybrid waits for neighbours some 25 times, whatever there is to do.
run, found = runs["auto", 13], changes(runs["auto", 13])
first, second = (int(np.argmin(np.abs(run.balance["time_s"] - t))) for t, *_ in found)
for ranks in (2, 4):
    many = column("auto", *(("-stepper_max_steps", run.steps(first + 40)) if ranks > 2 else ()), cells=13, ranks=ranks)
    there = found[:1] if ranks > 2 else found
    check_true(f"{ranks} ranks change at the same steps", [c[1:] for c in changes(many)] == [c[1:] for c in there] and np.allclose([c[0] for c in changes(many)], [c[0] for c in there], rtol=1e-6), str(changes(many)))
    rows = TIMES[TIMES <= many.time[-1]]
    judge("slopes", f"auto, {ranks} ranks against 1: p over its range", np.max(np.abs(many.at("middle", "p_Pa", rows) - run.at("middle", "p_Pa", rows))) / Q, 1e-6)
    if ranks > 2:
        continue
    out, parts, before = scratch() / f"cut{ranks}", [], 0
    for cut in (first - 1, first, first + 1, second - 1, second, second + 1, None):  # one run in seven parts: before, at and after either change
        parts.append(column("auto", *(("-restart", out / "checkpoint.h5") if before else ()), *(("-stepper_max_steps", run.steps(cut) - before) if cut else ()), cells=13, ranks=ranks, out=out))
        before = run.steps(cut) if cut else 0
    said = [c for part in parts for c in changes(part)]  # sums of ranks come in any order, so not bit for bit
    check_true(f"{ranks} ranks cut before, at and after either change: it changes where the whole does", said == changes(many), str(said))
    judge("slopes", f"auto, {ranks} ranks cut before, at and after either change: p of the whole against the uncut run, over its range", np.max(np.abs(parts[-1].probe("middle")["p_Pa"] - many.probe("middle")["p_Pa"])) / Q, 1e-9)
finish()
