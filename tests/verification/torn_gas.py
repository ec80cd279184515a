#!/usr/bin/env python3
"""Gas at two pressures, one a twentieth of the other, side by side in a cell of a bar that is pulled to one and a half times its length: pressures fall with what a
particle has (151), none reaches zero, and each half keeps its gas.  At one pressure everywhere (151) changes nothing."""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, table

CASE = Path(__file__).parent / "cases" / "stretched_gas.yaml"
BORDER, CELL = 0.35, 0.1
rows = []
for ranks in (1, 2):
    run = Run.of_case(CASE, "-quiet", ranks=ranks)
    first, last = run.snapshots()[0][1], run.snapshots()[-1][1]
    x = first["position"][:, 0]
    check_true(f"{ranks} ranks: every pressure of the gas above zero", np.all(last["p_g"] > 0))
    judge("gas", f"{ranks} ranks: methane, of the mass at the start", np.max(np.abs(run.balance["methane_error"])), 1e-13)
    volume = last["volume"] * last["porosity"] * (1 - last["S_w"]) / (first["volume"] * first["porosity"] * (1 - first["S_w"]))
    for half, far in (("thin", x < BORDER - CELL), ("dense", x > BORDER + CELL)):
        held = np.max(np.abs(last["p_g"] * volume / first["p_g"] - 1)[far])  # Boyle's law of a particle
        kept = abs(last["mass_gas"][far].sum() / first["mass_gas"][far].sum() - 1)
        rows.append([ranks, half, volume[far].mean(), held, kept])
        judge("gas", f"{ranks} ranks, {half} half: p_g times its volume, of that at the start", held, 5e-3)
        judge("gas", f"{ranks} ranks, {half} half: gas kept", kept, 1e-3)
even = [Run.of_case(CASE, "-quiet", "-region_thin_pressure", "2 MPa", "-time_end", "0.05 s", "-output_times", "0.05 s", "-stepper_pressures", how).snapshots()[-1][1]
        for how in ("nodes", "relative")]  # fmt: skip
judge("gas", "one pressure everywhere: (151) against shared increments, p_g", np.max(np.abs(even[1]["p_g"] / even[0]["p_g"] - 1)), 1e-4)
table(["ranks", "half", "volume of gas over that at the start", "p V off", "gas lost"], rows)
finish()
