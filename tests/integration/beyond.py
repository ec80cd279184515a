#!/usr/bin/env python3
"""A temperature that neither start nor conditions nor hydrate can make is told of when it happens, once, with place and time; what is less than two kelvin at the end alone."""
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run, check, check_true, finish, seconds  # noqa: E402

# A rod in hydrate on cells of 1 m, heated to 60 degC before heat has crossed a twentieth of a cell.
SCENE = (Path(__file__).resolve().parents[1] / "verification" / "cases" / "heater_rod.yaml", "-output_every", "30 h", "-progress", "0", "-bc_rod_temperature")
FAST, MILD = ("{ramp: [14.4 degC, 60 degC, 0 h, %d h]}" % hours for hours in (2, 4))
SAID = re.compile(r"clathra: warning: a particle (has|had) (\S+) degC, near \((\S+), (\S+)\) m at t = (\S+ \S+): (\S+) K (colder|warmer) than start, conditions and hydrate can make it .*\n  What to try, in this order: (.*?); ")
STEP = re.compile(r"^step +\d+: t = (\S+ \S+)", re.M)


def said(ramp=FAST, **keywords):
    run = Run.of_case(*SCENE, ramp, **keywords)
    return run, list(SAID.finditer(run.output))


def main():
    run, found = said()
    check_true("far beyond: told of on the way, once, and at the end", [w[1] for w in found] == ["has", "had"], run.output[-800:])
    if len(found) != 2:
        sys.exit(finish())
    first, last = found
    steps = [seconds(t) for t in STEP.findall(run.output)]
    after = [seconds(t) for t in STEP.findall(run.output[first.end() :])]
    check_true("... while the run goes on", len(after) > 2 and abs(seconds(first[5]) / after[0] - 1) < 1e-3 and after[0] > steps[0], f"{first[5]}, {after[:2]}")
    check("... as soon as it is two kelvin: K on the way", float(first[6]), (1.95, 2.6))
    check("... and K at the end", float(last[6]), (float(first[6]), 20))
    check("... where it is: in the cells about the rod, m", float(first[3]), (1.1, 6.1))
    words = lambda of: [w.groups() for w in of]
    check_true("two ranks say the same", words(said(ranks=2)[1]) == words(found))
    check_true("less than two kelvin: at the end alone", {w[1] for w in said(MILD)[1]} == {"had"})
    finish()


main()
