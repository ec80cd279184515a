#!/usr/bin/env python3
"""Row 6: a closed, insulated column, squeezed by 10 MPa and released, against the undrained closed forms.

The load is uniform and nothing can leave, so every particle goes through the states of one closed cell (exact.py):
water and gas compressed in equilibrium with the skeleton's M ln J and, with kinetics so fast (K_d x 1e4) that they do
not limit, p = p_e(T).
"""
from pathlib import Path

import numpy as np

import exact
from common import Run, check, finish, judge, table

CASE = Path(__file__).parent / "cases" / "closed_cell.yaml"
LENGTH = 0.1  # m
LOADS = {500.0: 5e6, 1000.0: 1e7, 1500.0: 5e6}  # s: Pa
FAST = ["-mat_sediment_kinetics_active", "yes", "-mat_sediment_kinetics_K0", "2.5e-6 mol/(m^2 Pa s)"]
SOLVED = ["-newton_tol_update", "1e-8"]  # K and MPa: what is left of a cycle is then not Newton's
NO_CAPILLARITY = ["-mat_sediment_retention_p0", "100 Pa"]


def compare(name, solution, capillary, *options):
    cell = exact.bp2_cell(capillary=capillary)
    run = Run.of_case(CASE, "-fields", "thmc", *SOLVED, *options)  # T stays where nothing reacts: shown, not taken for granted
    rows, worst = [], 0.0
    for t, q in LOADS.items():
        want = solution(q, cell)
        for key, unit, column, probe, scale in (
            ("p", "MPa", "p_Pa", "middle", 1e-6), ("T", "degC", "T_degC", "middle", 1.0), ("S_h", "-", "S_h", "middle", 1.0),
            ("u", "mm", "u_x_m", "surface", 1e3),
        ):  # fmt: skip
            exact_value = want[key] * (LENGTH if key == "u" else 1.0)
            got = run.at(probe, column, [t])[0]
            error = abs(got - exact_value) / abs(exact_value) if exact_value else abs(got)
            worst = max(worst, error)
            rows.append((t, q / 1e6, f"{key} ({unit})", f"{scale * got:.8g}", f"{scale * exact_value:.8g}", error))
    print(f"\n{name}")
    table(("t (s)", "q (MPa)", "quantity", "computed", "exact", "relative error"), rows)
    judge(6, f"{name}: largest relative error of p, T, S_h and u", worst, 1e-4)
    p, T = run.probe("middle")["p_Pa"], run.probe("middle")["T_degC"]
    u = run.probe("surface")["u_x_m"]
    back = {"p": abs(p[-1] / p[0] - 1), "u": abs(u[-1]) / np.max(np.abs(u)), "T": abs(T[-1] / T[0] - 1)}
    for quantity, value in back.items():
        judge(6, f"{name}: {quantity} after full unloading, relative", value, 1e-8)
    check(f"{name}: hydrate left", run.probe("middle")["S_h"][-1], 1e-8)
    for what in ("water", "methane"):
        check(f"{name}: {what} balance, largest error", np.max(np.abs(run.balance[f"{what}_error"])), 1e-10)
    return run


compare("undrained, no reaction, p_c = 0", exact.undrained, False, *NO_CAPILLARITY)
compare("undrained, no reaction, capillary pressure", exact.undrained, True)
compare("undrained, fast kinetics, p_c = 0", exact.undrained_equilibrium, False, *FAST, *NO_CAPILLARITY)
compare("undrained, fast kinetics, capillary pressure", exact.undrained_equilibrium, True, *FAST)
finish()
