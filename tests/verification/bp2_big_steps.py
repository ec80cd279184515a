#!/usr/bin/python3
"""BP2 case 2 with fixed steps of 50 s and 100 s (row 17), by both integrators.

Probe rows are written at every step, so that no output cuts a step.  A fixed step that cannot be taken is cut and
grows back; how often that happened is reported.
"""
import re

import numpy as np

from common import CASES, Run, check_true, finish, judge, read_csv, record, table

reference = read_csv(CASES / "bp2" / "reference" / "bp2_case2.csv")
want = {t: reference["p_MPa"][np.argmin(np.abs(reference["t_s"] - t))] * 1e6 for t in (1000.0, 2000.0)}
rows = []
for scheme in ("sdirk2", "euler"):
    for dt in (50, 100):
        run = Run.of_case("bp2", "-quiet", "-stepper_type", scheme, "-stepper_adapt", "no", "-stepper_dt", f"{dt} s",
                          "-stepper_dt_max", "100 s", "-output_probe_every", "0 s", "-output_times", "0 s")  # fmt: skip
        name = f"BP2 case 2, {scheme}, fixed dt = {dt} s"
        steps, largest = len(run.balance["step"]), np.max(run.balance["dt_s"])
        refused = int(re.search(r"(\d+) refused", run.output).group(1))
        done = abs(run.time[-1] - 2000) < 1e-6 and abs(largest - dt) < 1e-6
        check_true(f"{name}: finishes", done, f"{steps} steps, {refused} refused")
        record(17, f"{name}: finishes", "2000 s", f"{run.time[-1]:g} s, {refused} steps refused", done)
        error = {t: run.at("p06", "p_Pa", t) / p - 1 for t, p in want.items()}
        judge(17, f"{name}: p at 0.6 m, 1000 s", abs(error[1000.0]), 0.02, 0.01, "%")
        rows.append([scheme, dt, steps, refused, f"{100 * error[1000.0]:.3f}", f"{100 * error[2000.0]:.3f}"])
table(["scheme", "dt (s)", "steps", "refused", "p(1000 s) off (%)", "p(2000 s) off (%)"], rows)
finish()
