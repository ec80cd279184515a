#!/usr/bin/env python3
"""A run that goes as forecast does not say that it is slow, and what it says is left is so."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import binary, check_true, finish, scratch  # noqa: E402

import forecasts  # noqa: E402
from tutorial import case_text, heated  # noqa: E402


def main():
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
