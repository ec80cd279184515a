#!/usr/bin/env python3
"""One pressure (34): exact in a closed cell, conservative, and the same as two pressures where capillary pressure tends to nothing."""
from pathlib import Path

import numpy as np

import exact
from common import CASES, Run, check, finish, judge, table

CELL = Path(__file__).parent / "cases" / "closed_cell.yaml"
LENGTH = 0.1  # m
LOADS = {500.0: 5e6, 1000.0: 1e7, 1500.0: 5e6}  # s: Pa
FAST = ["-mat_sediment_kinetics_active", "yes", "-mat_sediment_kinetics_K0", "2.5e-6 mol/(m^2 Pa s)"]


def balance(name, run):
    for what in ("water", "methane"):
        check(f"{name}: {what} balance, largest error", np.max(np.abs(run.balance[f"{what}_error"])), 1e-12)


def closed(name, solution, *options):
    run = Run.of_case(CELL, "-pressures", "one", *options)
    cell, rows = exact.bp2_cell(capillary=False), []
    for t, q in LOADS.items():
        want = solution(q, cell)
        for key, column, probe in (("p", "p_Pa", "middle"), ("S_h", "S_h", "middle"), ("u", "u_x_m", "surface")):
            value = want[key] * (LENGTH if key == "u" else 1.0)
            got = run.at(probe, column, [t])[0]
            rows.append((t, key, got, value, abs(got - value) / abs(value) if value else abs(got)))
    print(f"\n{name}")
    table(("t (s)", "quantity", "computed", "exact", "relative error"), rows)
    judge("4.1", f"one pressure, {name}: largest relative error of p, S_h and u", max(r[-1] for r in rows), 1e-4)
    balance(name, run)


closed("undrained, no reaction", exact.undrained)
closed("undrained, fast kinetics", exact.undrained_equilibrium, *FAST)

# A front of saturation: explicit saturations need steps of a fraction of a cell
SCENE = [CASES / "buckley_leverett", "-stepper_dt", "10 s", "-time_end", "4000 s", "-output_times", "4000 s"]


def profile(*options):
    run = Run.of_case(*SCENE, *options)
    last = run.snapshot(4000.0)
    return np.asarray(last["S_w"]).ravel(), run


one, run = profile("-pressures", "one")
balance("front", run)
rows = []
for p0 in ("10 kPa", "1 kPa", "200 Pa"):
    two, _ = profile("-mat_sand_retention_p0", p0)
    rows.append((p0, np.mean(np.abs(one - two))))
print("\nBuckley-Leverett: one pressure against two, mean difference of S_w")
table(("p_0", "difference"), rows)
judge("4.1", "one pressure against two with p_0 = 200 Pa: mean difference of S_w at a front", rows[-1][1], 0.02)
check("the difference falls with p_0", rows[-1][1] / rows[0][1], 0.7)
finish()
