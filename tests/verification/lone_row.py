#!/usr/bin/env python3
"""A closed bar of gassy sand that is stretched: gas keeps p V of its particle.

A closed bar of gassy sand, one row of particles in cells twice as high, is pulled to one and a half times its length: gas keeps p V of its particle, and with the tie (417) of
what particles do not see of pressures nothing builds up across the row, by sdirk2 as by hybrid, which needs none.

Without it the light bar has no first step, and the one with gravity and Poisson's ratio takes twice as many Newton iterations and gets
gradients of p_w across it of 0.2 MPa/m, where the weight of water makes 0.01.
"""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, table

CASE = Path(__file__).parent / "cases" / "stretched_gas.yaml"
ROW = ("-quiet", "-region_thin_pressure", "2 MPa", "-grid_upper", "1.4 m,0.2 m", "-boundaries", "left,bottom,pull")
HEAVY = ("-gravity", "0 m/s^2,-9.81 m/s^2", "-mat_sand_permeability_k0", "1e-14 m^2", "-mat_sand_elasticity_nu", "0.3")
rows, ends = [], {}
for name, more in (("light", ()), ("heavy", HEAVY)):
    for scheme, ranks in (("sdirk2", 1), ("sdirk2", 2), ("hybrid", 1)):
        run, who = Run.of_case(CASE, *ROW, *more, "-stepper_type", scheme, ranks=ranks), f"a row of particles, {name}, {scheme}, {ranks} ranks"
        first, last = run.snapshots()[0][1], run.snapshots()[-1][1]
        check_true(f"{who}: goes to the end", abs(run.balance["time_s"][-1] - 0.1) < 1e-9)
        volume = last["volume"] * last["porosity"] * (1 - last["S_w"]) / (first["volume"] * first["porosity"] * (1 - first["S_w"]))
        boyle = np.max(np.abs(last["p_g"] * volume / first["p_g"] - 1))
        across = max(np.max(np.abs(last[k][:, 1])) for k in ("grad_p_w", "grad_p_g"))
        newton = run.balance["newton"].sum() / len(run.balance["time_s"])
        rows.append([name, scheme, ranks, boyle, across, newton])
        ends[name, scheme, ranks] = np.ravel(last["p_g"])[np.argsort(np.ravel(last["id"]))]
        judge("gas", f"{who}: p_g times its volume, of that at the start", boyle, 5e-4 if scheme == "sdirk2" else 5e-3)
        judge("gas", f"{who}: methane, of the mass at the start", np.max(np.abs(run.balance["methane_error"])), 1e-13)
        judge("gas", f"{who}: water, of the mass at the start", np.max(np.abs(run.balance["water_error"])), 1e-13)
        if scheme == "sdirk2":
            judge("gas", f"{who}: gradient of pressures across it (Pa/m)", across, 1e3)
            check(f"{who}: Newton iterations a step", newton, (0, 4))
    judge("gas", f"a row of particles, {name}: p_g of two ranks against one", np.max(np.abs(ends[name, "sdirk2", 2] / ends[name, "sdirk2", 1] - 1)), 1e-9)
    judge("gas", f"a row of particles, {name}: p_g of sdirk2 against hybrid", np.max(np.abs(ends[name, "sdirk2", 1] / ends[name, "hybrid", 1] - 1)), 5e-3)
table(["bar", "integrator", "ranks", "p V off", "gradient across (Pa/m)", "Newton iterations a step"], rows)
finish()
