#!/usr/bin/env python3
"""A temperature that neither start nor conditions nor hydrate can make is told of when it happens, once, with place, time and the key that mends it; what is less than two kelvin at the end alone."""
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, Run, check, check_true, finish, seconds  # noqa: E402

# Cold water into sand at a cell Peclet number of 26, carried by central differences.
SCENE = (CASES / "heat_advection", "-grid_cells", "20,1", "-time_end", "1 d", "-output_times", "0 s", "-stepper_adapt", "yes", "-stabilisation_heat", "no", "-mat_sand_solid_conductivity", "0.1 W/(m K)",
         "-mat_sand_water_conductivity", "0.03 W/(m K)", "-progress", "0")  # fmt: skip
HOT = ("-stepper_dt", "1 min", "-stepper_dt_max", "15 min", "-region_body_temperature", "90 degC")
SAID = re.compile(r"clathra: warning: a particle (has|had) (\S+) degC, near \((\S+), (\S+)\) m at t = (\S+ \S+): (\S+) K (colder|warmer) than start, conditions and hydrate can make it .*?What to try, in this order: (.*?); ")
STEP = re.compile(r"^step +\d+: t = (\S+ \S+)", re.M)


def said(*options, **keywords):
    run = Run.of_case(*SCENE, *options, **keywords)
    return run, list(SAID.finditer(run.output))


def main():
    run, found = said(*HOT)
    check_true("far beyond: told of on the way, once, and at the end", [w[1] for w in found] == ["has", "had"], run.output[-800:])
    if len(found) != 2:
        sys.exit(finish())
    first, last = found
    steps = [seconds(t) for t in STEP.findall(run.output)]
    after = [seconds(t) for t in STEP.findall(run.output[first.end() :])]
    check_true("... while the run goes on", len(after) > 2 and seconds(first[5]) == after[0] > steps[0], f"{first[5]}, {after[:2]}")
    check("... as soon as it is two kelvin: K on the way", float(first[6]), (1.95, 2.6))
    check("... and K at the end", float(last[6]), (float(first[6]), 20))
    check("... where it is: behind the inlet, m", float(first[3]), (0, 1))
    check_true("... with the key that mends it first", first[8] == last[8] == "stabilisation_heat: auto, where flow carries the heat", first[8])
    words = lambda of: [(*w.groups()[:3], *w.groups()[4:]) for w in of]  # without y: both particles of a column are as cold
    check_true("two ranks say the same", words(said(*HOT, ranks=2)[1]) == words(found))
    check_true("less than two kelvin: at the end alone", [w[1] for w in said()[1]] == ["had"])
    check_true("with the key: nothing", not said(*HOT, "-stabilisation_heat", "auto")[1])
    finish()


main()
