#!/usr/bin/env python3
"""A run that neither ends nor gives up says so on its way, with what rules its steps and what to try; one that goes as forecast does not."""
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import binary, check, check_true, finish, launch, scratch  # noqa: E402

import forecasts  # noqa: E402
from tutorial import case_text, heated  # noqa: E402

CASES = Path(__file__).resolve().parents[1] / "verification" / "cases"

LINE = re.compile(r"clathra: note: slow: (\d+) steps \((\d+) refused\), ([\d.e+]+) (\w+), have come to (.*?), ([\d.]+) %; the forecast was ([\d.e+]+), (.*?), for all, and by their growth so far ([\d.e+]+) are left, "
                  r".*?; with the present dt of .*? it would be ([\d.e+]+)(?:, (.*?) as the last 10 went)?\.  dt is ruled by (.*)\n  What to try, in this order: (.*) \(docs/giving_up\.md\)")  # fmt: skip


def main():
    """A cut under a weight that grows: implicit steps small enough for a tight tolerance stand when it slides."""
    options = ("-stepper_type", "sdirk2", "-stepper_tol", "1e-5", "-gravity_ramp", "40 h", "-time_end", "120 h", "-output_every", "40 h", "-progress", "0")
    done = launch(binary(), CASES / "growing_weight.yaml", *options, "-stepper_max_steps", "4000", out=scratch() / "stands")
    said = LINE.findall(done.stdout)
    steps = [int(line[0]) for line in said]
    check_true("a run that stands says so, once until it has taken twice as many steps", steps and len(said) == done.stdout.count("note: slow")
               and all(b >= 2 * a for a, b in zip(steps, steps[1:])), f"{steps}\n{done.stdout[-2000:]}")  # fmt: skip
    taken, refused, spent, unit, now, share, forecast, promised, grown, flat, long, rules, advice = said[0]
    check_true("... after twice the forecast's steps, or ten seconds", 2 <= int(taken) / float(forecast) < 3.7 or float(spent) * forecasts.SECONDS[unit] >= 10, said[0])
    check_true("... with how long it has taken, was said to take, and would as its last steps went", unit == "s" and promised.endswith(" s") and all(re.fullmatch(r"|[\d.e+]+ (s|min|h|days|years)", line[10]) for line in said) and any(line[10] for line in said), said)
    check_true("... and the time left is named with what it counts on", re.search(r"about [\d.e+]+ steps, [\d.e+]+ \w+ left if steps grow again, [\d.e+]+ \w+ if not", done.stdout), done.stdout[-300:])
    check("... with more than ten times the forecast left, by either way to count", min(float(grown), float(flat)) / float(forecast), (9.5 if int(taken) >= 2 * float(forecast) else 1, 1e5))  # printed with two digits
    check("... at a share of its time", float(share), (0.1, 30))
    check_true("... how many were refused", int(refused) < int(taken) and "h" in now, f"{refused}, {now}")
    check_true("... with what rules the step and where", re.match(r"(the error of \w+, largest near \([\d.]+, [\d.]+\) m|Newton's method)", rules) is not None, rules)
    plain = scratch() / "well_and_heater.yaml"  # the well alone ends in 16 more steps where 34 are said at 10 %, docs/studies/forecast.md
    plain.write_text(heated(case_text()))
    goes = forecasts.Told(binary(), plain, (), scratch() / "goes")
    text = "".join(goes.log)
    check_true("a run that goes as forecast says nothing of the kind", "note: slow" not in text and "finished" in text, text[-500:])
    check_true("its forecast of steps is within a factor of two", forecasts.within(goes.forecast[0], goes.took[0]), f"{goes.forecast[0]} and {goes.took[0]}")
    left = {mark: goes.at(mark)[:2] for mark in forecasts.MARKS}
    check_true("... and the steps that it says are left, at 5, 10, 25 and 50 %", all(forecasts.within(*v) for v in left.values()), left)
    cells = forecasts.row("... well and heater", goes)
    check_true("docs/studies/forecast.md has this row", "| ".join(["", *(c.split(",")[0] for c in cells[1:2])]) in forecasts.PAGE.read_text(), cells)
    finish()


main()
