#!/usr/bin/env python3
"""Slope A on cells of 15 m by sdirk2, through its loading and the first second of heating: with the tie (351) of slivers' pressures it goes on in steps of 0.1 s.

The body is undrained, its surface cuts cells, and heating takes the base past yield.  Without the tie nodes of slivers take pressures of their own: three times as many Newton
iterations in the loading, and no solution at any step when heating begins.
"""
import re

from common import Run, check, check_true, finish, table

TIED = ("-quiet", "-grid_cells", "40,8", "-stepper_type", "sdirk2", "-stepper_tol", "1e-2", "-stage_slide_end", "11 s")

run = Run.of_case("slope_a", *TIED)
found = re.search(r"stage load: .*?(\d+) steps, \d+ refused, (\d+) Newton", (run.out / "summary.txt").read_text())
steps, newton = (int(n) for n in found.groups())
table(["steps of the loading", "Newton iterations", "steps in all", "last step (s)"], [[steps, newton, len(run.balance["time_s"]), run.balance["dt_s"][-1]]])
check("time reached (s)", run.balance["time_s"][-1], (10.999, 11.001))
check("Newton iterations a step of the loading", newton / steps, (0, 4))
check_true("steps have grown to 0.1 s again", run.balance["dt_s"][-1] > 0.099)
finish()
