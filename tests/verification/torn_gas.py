#!/usr/bin/env python3
"""Gas at two pressures in one cell of a stretched bar: each half keeps its own.

Gas at two pressures, one a twentieth of the other, side by side in a cell of a bar that is pulled to one and a half times its length: pressures fall with what a
particle has, by hybrid (151) and by sdirk2 (416), none reaches zero, and each half keeps its gas.

By the particles' shared increments sdirk2 goes no farther than 0.0283 s of 0.1: the thin gas of the border's cell has lost what its nodes lose.  Its storage is consistent,
so pressures ring beside the jump, where that of hybrid is lumped; hence the bars.
"""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, table

CASE = Path(__file__).parent / "cases" / "stretched_gas.yaml"
BORDER, CELL = 0.35, 0.1
rows = []
for scheme, boyle, gone in (("hybrid", 5e-3, 1e-3), ("sdirk2", 0.25, 3e-2)):
    ends = []
    for ranks in (1, 2):
        run, who = Run.of_case(CASE, "-quiet", "-stepper_type", scheme, ranks=ranks), f"{scheme}, {ranks} ranks"
        first, last = run.snapshots()[0][1], run.snapshots()[-1][1]
        x = first["position"][:, 0]
        check_true(f"{who}: goes to the end", abs(run.balance["time_s"][-1] - 0.1) < 1e-9)
        check_true(f"{who}: every pressure of the gas above zero", np.all(last["p_g"] > 0))
        judge("gas", f"{who}: methane, of the mass at the start", np.max(np.abs(run.balance["methane_error"])), 1e-13)
        judge("gas", f"{who}: water, of the mass at the start", np.max(np.abs(run.balance["water_error"])), 1e-13)
        volume = last["volume"] * last["porosity"] * (1 - last["S_w"]) / (first["volume"] * first["porosity"] * (1 - first["S_w"]))
        for half, far in (("thin", x < BORDER - CELL), ("dense", x > BORDER + CELL)):
            held = np.max(np.abs(last["p_g"] * volume / first["p_g"] - 1)[far])  # Boyle's law of a particle
            kept = abs(last["mass_gas"][far].sum() / first["mass_gas"][far].sum() - 1)
            rows.append([scheme, ranks, half, volume[far].mean(), held, kept])
            judge("gas", f"{who}, {half} half: p_g times its volume, of that at the start", held, boyle)
            judge("gas", f"{who}, {half} half: gas kept", kept, gone)
        ends.append(np.ravel(last["p_g"])[np.argsort(np.ravel(last["id"]))])
    judge("gas", f"{scheme}: p_g of two ranks against one", np.max(np.abs(ends[1] / ends[0] - 1)), 1e-9)
table(["integrator", "ranks", "half", "volume of gas over that at the start", "p V off", "gas lost"], rows)
finish()
