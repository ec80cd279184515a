#!/usr/bin/python3
"""Forecast against fact: forecasts.py CLATHRA [FOLDER]

Runs the shipped implicit cases that take about a minute or less, and the scenes of docs/tutorial.md with their neighbours without gas, into FOLDER (default:
results/forecasts), compares what each says at its start and at 5, 10, 25 and 50 % of its time with what it then takes, and writes docs/studies/forecast.md.
"""
import re
import subprocess
import sys
import time
from pathlib import Path

import dated
from clathra.units import SECONDS
from tutorial import case_text, heated, tidal, without_gas

ROOT = Path(__file__).resolve().parents[1]
PAGE = dated.STUDIES / "forecast.md"
MARKS = (5, 10, 25, 50)
HEATED = ("-bc_well_pressure", "11 MPa")
CASES = ("terzaghi", "mcwhorter_sunada", "buckley_leverett", "stefan_front", "bp2", "masuda", "century", "century_hydrate", "slope_warming")


def scenes(folder):
    """(name, case, options) of each."""
    text = case_text()
    own = {"well": text, "heater": heated(text), "tide": tidal(text), "well_without_gas": without_gas(text), "heater_without_gas": heated(without_gas(text))}
    for name, case in own.items():
        (folder / f"{name}.yaml").write_text(case)
    at = {name: folder / f"{name}.yaml" for name in own}
    yield from ((f"[{name}](../../cases/{name}/README.md)", ROOT / "cases" / name, ()) for name in CASES)
    yield "[tutorial](../tutorial.md): well", at["well"], ()
    yield "... tolerance 1e-3", at["well"], ("-stepper_tol", "1e-3")
    yield "... well and heater", at["heater"], ()
    yield "... heater", at["heater"], HEATED
    yield "... tide", at["tide"], ()
    yield "[without gas](../../tests/verification/first_gas.py): well", at["well_without_gas"], ()
    yield "... heater", at["heater_without_gas"], (*HEATED, "-time_end", "10 d", "-output_every", "2 d")
    yield "[heater inside](../../tests/verification/cases/heater_rod.yaml)", ROOT / "tests" / "verification" / "cases" / "heater_rod.yaml", ()


class Told:
    """What a run said and when: `forecast` (steps, s), `lines` (share, step, steps left, s left, s of the wall), `took` (steps, s); of the last stage."""

    def __init__(self, program, case, options, out):
        command = [str(program), str(case), "-progress", "0", "-overwrite", "-output_dir", str(out), *options]
        begun, self.lines, self.log = 0.0, [], []
        with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as run:
            for line in run.stdout:
                now = time.monotonic()
                self.log.append(line)
                if said := re.search(r"implicit about ([\d.e+-]+) steps, ([\d.e+-]+) (\w+)", line):
                    self.forecast, begun, self.lines = (float(said[1]), float(said[2]) * SECONDS[said[3]]), now, []
                if step := re.match(r"(?:stage \w+: )?step +(\d+): .*?\(([\d.]+) %\)", line):
                    left = re.search(r"about ([\d.e+-]+) steps?, ([\d.e+-]+) (\w+) left", line)
                    self.lines.append((float(step[2]), int(step[1]), *((float(left[1]), float(left[2]) * SECONDS[left[3]]) if left else (None, None)), now - begun))
        if run.returncode or not self.lines:
            raise RuntimeError(f"{case}: exit code {run.returncode}\n{''.join(self.log[-5:])}")
        self.first = self.lines[0][1] - 1
        self.took = (self.lines[-1][1] - self.first, self.lines[-1][4])

    def at(self, mark):
        """At the first line from there on: steps and s left, as said and as it came; None: there is no such line before the end."""
        for share, step, steps, seconds, wall in self.lines[:-1]:
            if share >= mark and steps is not None:
                return steps, self.first + self.took[0] - step, seconds, self.took[1] - wall
        return None


def within(said, was):
    return was > 0 and 0.5 <= said / was <= 2.0


def number(value):
    return f"{value:.2g}" if value < 100 else f"{value:.0f}"


def row(name, told):
    cells = [name, f"{told.forecast[0]:.0f} / {told.took[0]}", f"{number(told.forecast[1])} / {number(told.took[1])}"]
    for mark in MARKS:
        at = told.at(mark)
        cells.append(f"{at[0]:.0f} / {at[1]}, {number(at[2])} / {number(at[3])}" if at else "")
    return cells


def page(found):
    """The page; `found`: (name, Told) of each scene."""
    head = ["scene", "steps", "time, s", *(f"left at {m} %: steps, s" for m in MARKS)]
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(row(*f)) + " |" for f in found)]
    marked = [at for _, told in found for mark in MARKS if (at := told.at(mark))]
    starts = [within(told.forecast[0], told.took[0]) for _, told in found]
    steps, seconds = ([within(at[k], at[k + 1]) for at in marked] for k in (0, 2))
    said = [(left, told.first + told.took[0] - step) for _, told in found for share, step, left, _, _ in told.lines[:-1] if left is not None]
    lines_within = sum(within(*s) for s in said)
    return "\n".join([
        *dated.head("Forecast and time left against fact", "scripts/forecasts.py", PAGE),
        "Each cell: said / came. A forecast stands at the start of a run ([equations](../equations.md), section 15, (317)). Every line of progress from 5 % of the time on says what is left (412): first",
        "from the forecast and the run's own pace, later from the pace alone. Seconds are those of the machine that wrote this, with whatever else it did.", "",
        *lines, "",
        f"Within a factor of two: the forecast of steps in {sum(starts)} of {len(starts)} scenes; steps left in {sum(steps)} of {len(steps)} of the cells, time left in {sum(seconds)}; steps left on "
        f"{100 * lines_within / len(said):.0f} % of all {len(said)} lines.", "",
        "The forecast does not see a front that becomes expensive later: beside a heater most steps fall where the first cell of hydrate melts, after a fifth of the time.",
        "A run that exceeds its forecast tenfold says so itself, with what rules its steps ([giving_up.md](../giving_up.md)).", "",
    ])  # fmt: skip


def main(program, folder=ROOT / "results" / "forecasts"):
    folder = Path(folder).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    found = []
    for k, (name, case, options) in enumerate(scenes(folder)):
        found.append((name, Told(program, case, options, folder / f"run{k}")))
        print(*row(*found[-1]), sep="  ", flush=True)
    dated.measured(PAGE)
    PAGE.write_text(page(found))


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
