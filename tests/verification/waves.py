#!/usr/bin/env python3
"""Values that change with time as waves and as a column of a file.

Values that change with time as waves (267) and as a column of a file: a periodic temperature runs into a wall and fades as
exp(-x/d), d = sqrt(kappa T/(pi C)).  Two ranks, restart bit for bit, and the resolved case, which needs no file."""
import math
from pathlib import Path

import numpy as np

from common import ROOT, binary, check_true, finish, judge, launch, run, scratch

CASE = ROOT / "tests" / "verification" / "cases" / "wave.yaml"
done = run(binary(), CASE, "-quiet")
t, day = done.time, done.time > 5 * 86400
kappa = 0.9 * 2.0  # what the pores hold conducts nothing here
capacity = 0.9 * 2500 * 800
d = math.sqrt(kappa * 86400 / (math.pi * capacity))


def exact(x, t):
    return 10 + 8 * np.exp(-x / d) * np.sin(2 * np.pi * (t - 86400) / 86400 - x / d)


for name, x in (("a", 0.11875), ("b", 0.31875)):
    T = done.probe(name)["T_degC"]
    judge("4.3", f"T at {x} m on the sixth day, of the amplitude at the face", np.max(np.abs(T[day] - exact(x, t[day]))) / 8, 0.01)
steps = np.diff(done.balance["time_s"])
judge("4.3", "longest step, of an eighth of the period", np.max(steps) / 10800 - 1, 1e-9)

folder = scratch()
hours = np.arange(0, 145, 0.5)
(folder / "day.csv").write_text("# measured\ntime [h], sky [degC], wall [degC]\n" + "".join(
    f"{h}, 99, {10 + 8 * math.sin(2 * math.pi * h / 24):.9f}\n" for h in hours))  # fmt: skip
case = folder / "case.yaml"
case.write_text(CASE.read_text().replace("{sine: [10 degC, 8 K, 24 h, 24 h]}", "{csv: [day.csv, Wall]}").replace("end: 6 d", "end: 1 d"))
table = run(binary(), case, "-quiet")
one = run(binary(), CASE, "-quiet", "-time_end", "1 d")
judge("4.3", "file of half hours against the wave, of its amplitude", np.max(np.abs(table.probe("a")["T_degC"] - one.probe("a")["T_degC"])) / 8, 3e-3)
for name, r in (("wave", one), ("file", table)):
    again = folder / name
    again.mkdir()
    (again / "case.yaml").write_text((r.out / "case.yaml").read_text())
    same = run(binary(), again, "-quiet", out=again / "out")
    judge("4.3", f"{name}: the resolved case runs to the same", np.max(np.abs(same.probe("a")["T_degC"] - r.probe("a")["T_degC"])), 0.0)
short = [run(binary(), CASE, "-quiet", "-time_end", "2 h", ranks=n).probe("a")["T_degC"] for n in (1, 2)]
judge("4.3", "1 and 2 ranks, K", np.max(np.abs(short[1] - short[0])), 1e-9)
fixed = ("-quiet", "-time_end", "1 d", "-stepper_adapt", "no", "-stepper_dt", "1 h")
whole, half = run(binary(), CASE, *fixed), run(binary(), CASE, *fixed, "-stepper_max_steps", 10)
rest = run(binary(), CASE, *fixed, "-restart", half.out / "checkpoint.h5", out=half.out)
judge("4.3", "restart: the same to the last bit", np.max(np.abs(rest.probe("a")["T_degC"] - whole.probe("a")["T_degC"])), 0.0)
(folder / "day.csv").write_text("time [h], wall [degC]\n0, 10\n2 , 11 K\n")
bad = launch(binary(), case, "-case_check")
check_true("a wrong cell is named", bad.returncode == 2 and "bc_day_temperature_csv" in bad.stdout and "line 3" in bad.stdout, bad.stdout)
finish()
