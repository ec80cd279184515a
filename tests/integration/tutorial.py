#!/usr/bin/python3
"""The case that docs/tutorial.md builds is valid, starts, and produces; its heater and its tide run."""
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import binary, check, check_true, finish, launch, scratch  # noqa: E402

import clathra  # noqa: E402
import tutorial  # noqa: E402


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
    for what, changed in (("heater", tutorial.heated(text)), ("tide", tutorial.tidal(text))):
        case.write_text(changed)
        done = launch(binary(), case, "-stepper_max_steps", "1", "-quiet", out=scratch() / what)
        check_true(f"the {what} of the last section takes a step", done.returncode == 0, done.stdout[-300:])
    case.write_text(text)
    more = dict(re.findall(r"^\| `(-[\w ,-]+?)` \|.*\|.*\|(.*)\|$", tutorial.PAGE.read_text(), re.M))
    check_true("the page's variants are a tolerance and a grid", len(more) == 2, str(more))
    for option in more:
        done = launch(binary(), case, *option.split(), "-case_check")
        check_true(f"{option} is one", done.returncode == 0, done.stdout[-300:])
    finish()


main()
