#!/usr/bin/python3
"""The case that docs/tutorial.md builds is valid, starts, produces, and ends without a warning, and so does its heater by power; its other heater and its tide run."""
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import binary, check, check_true, finish, launch, scratch  # noqa: E402

import clathra  # noqa: E402
import tutorial  # noqa: E402


def ends(what, text, notes=()):
    """A whole run, which has nothing to warn of but what the page says of it: the beginnings of these lines."""
    out, case = scratch() / "whole", scratch() / "whole.yaml"
    case.write_text(text)
    done = launch(binary(), case, "-quiet", out=out)
    said = [line for line in done.stdout.splitlines() if "warning" in line or "note:" in line or "above the tolerance" in line]
    as_said = len(said) == len(notes) and all(line.startswith(note) for line, note in zip(said, notes))
    check_true(f"{what} ends well, with as many notes as the page says ({len(notes)}) and no warning", done.returncode == 0 and "finished at t = 30 days" in done.stdout and as_said, said)
    return clathra.Run(out)


def main():
    out, case = scratch() / "out", scratch() / "case.yaml"
    case.write_text(tutorial.case_text())
    done = launch(binary(), case, "-stepper_max_steps", "8", "-progress", "0", out=out)
    check_true("the blocks of the page are a case that starts", done.returncode == 0, done.stdout[-300:])
    run = clathra.Run(out)
    check_true("what the page says is in it: layers, probes, the meter", run.names("regions") == ["lower", "layer", "upper"] and run.axisymmetric
               and run.probe_names == ["near", "far"] and run.case["mat_clay_porosity"] == 0.4 and run.case["mat_clay_kinetics_active"] == "no")  # fmt: skip
    check_true("gas and water come to the well, the more the longer", all((v[1:] - v[:-1] > 0).all() for v in (
        run.meter("well")["gas_kg"], run.meter("well")["water_kg"])), run.meter("well")["gas_kg"][-1])  # fmt: skip
    check("water and methane are kept, of the store", max(abs(run.balance[k]).max() for k in ("water_error", "methane_error")), 1e-12)
    text = case.read_text()
    run = ends("the case of the page", text, ["clathra: note: the border between clay and sand lay on a line of the grid and is 0.14 of a cell off it"])
    check("gas of 30 days as the page says it, t", run.meter("well")["gas_kg"][-1] / 1e3, (9.0, 9.2))
    run = ends("the same with basis: total", f"{text}\nbasis: total\n")
    check("gas of 30 days as the page says it of that, t", run.meter("well")["gas_kg"][-1] / 1e3, (8.55, 8.7))
    run = ends("its heater by power", tutorial.powered(text))
    kilowatt = 400 * 2 * np.pi * 0.1 * 4
    check("heat that came in, over its power times time, less one", abs(-run.meter("well")["heat_J"][-1] / (kilowatt * 29.5 * 86400) - 1), 1e-5)
    melts = -run.balance["heat_source_J"][-1] / run.balance["heat_in_J"][-1]
    check("share of it that melts hydrate", melts, (0.6, 0.67))
    check("hydrate that it melts, t", (run.balance["hydrate_kg"][0] - run.balance["hydrate_kg"][-1]) / 1e3, (3.5, 3.65))
    for what, changed in (("heater", tutorial.heated(text)), ("tide", tutorial.tidal(text))):
        case.write_text(changed)
        done = launch(binary(), case, "-stepper_max_steps", "1", "-quiet", out=scratch() / what)
        check_true(f"the {what} of the last section takes a step", done.returncode == 0, done.stdout[-300:])
    case.write_text(text)
    more = dict(re.findall(r"^\| `(-[\w ,-]+?)` \|.*\|.*\|(.*)\|$", tutorial.PAGE.read_text(), re.M))
    check_true("the page's variants are a tolerance, grids and a basis", len(more) == 6 and " ".join(tutorial.FINE) in more, str(more))
    for option in more:
        done = launch(binary(), case, *option.split(), "-case_check")
        check_true(f"{option} is one", done.returncode == 0, done.stdout[-300:])
    finish()


main()
