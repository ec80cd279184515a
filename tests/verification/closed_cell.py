#!/usr/bin/env python3
"""A closed adiabatic cell goes to equilibrium, and hydrate dissociates as it should.

Row 13: a closed adiabatic cell goes to equilibrium; hydrate dissociates exponentially at constant p and T; S_h goes
from 0.5 to 0 and never below, with any step.
"""
from pathlib import Path

import numpy as np

import exact
from common import Run, check, check_true, finish, judge, order, table

CASES = Path(__file__).parent / "cases"
KD = "-mat_core_kinetics_K0"
GAMMA = 1 - 0.5**0.5
GROWTH = {"euler": lambda z: 1 / (1 - z), "sdirk2": lambda z: (1 + (1 - 2 * GAMMA) * z) / (1 - GAMMA * z) ** 2}
STIFF = [KD, "3.6e8 mol/(m^2 Pa s)"]  # K_d x 1e4


def balances(name, run):
    worst = max(np.max(np.abs(run.balance[f"{w}_error"])) for w in ("water", "methane"))
    judge(13, f"{name}: water and methane balance, largest error of any step", worst, 1e-10)


def closed():
    want = exact.adiabatic_cell()
    for name, options in (("closed cell", []), ("closed cell, K_d x 1e4, dt = 1000 s",
                          [*STIFF, "-stepper_adapt", "no", "-stepper_dt", 1000])):  # fmt: skip
        run = Run.of_case(CASES / "masuda_cell.yaml", *options)
        got = {k: run.probe("middle")[c][-1] for k, c in (("p", "p_Pa"), ("T", "T_degC"), ("S_h", "S_h"))}
        print(f"\n{name}: {len(run.balance['time_s'])} steps")
        table(("quantity", "computed", "exact", "relative error"),
              [(k, f"{got[k]:.7g}", f"{want[k]:.7g}", abs(got[k] / want[k] - 1)) for k in got])  # fmt: skip
        for k in got:
            judge(13, f"{name}: {k} at equilibrium, relative error", abs(got[k] / want[k] - 1), 1e-4)
        balances(name, run)


def constant_p_and_T():
    rate, rows, errors = exact.dissociation_rate(), [], []
    print(f"\nconstant p and T: S_h = 0.5 exp(-{rate:.5g} t); largest error over 1000 s")
    steps = (50.0, 25.0, 12.5)
    for dt in steps:
        run = Run.of_case(CASES / "open_cell.yaml", "-stepper_dt", dt)
        Sh, p, T = (run.probe("middle")[c] for c in ("S_h", "p_Pa", "T_degC"))
        errors.append(np.max(np.abs(Sh - 0.5 * np.exp(-rate * run.time))) / 0.5)
        rows.append((dt, errors[-1], Sh[-1], np.max(np.abs(p - 2.84e6)), np.max(np.abs(T - 2.3))))
        balances(f"constant p and T, dt = {dt:g} s", run)
    table(("dt (s)", "error of S_h / 0.5", "S_h(1000 s)", "|p - 2.84 MPa| (Pa)", "|T - 2.3| (K)"), rows)
    print("observed orders", *(f"{o:.2f}" for o in order(steps, errors)))
    judge(13, "constant p and T: error of S_h over S_h0, sdirk2, dt = 12.5 s", errors[-1], 1e-3)
    check("order in time", order(steps, errors)[-1], (1.8, 2.2))


def to_zero():
    for name, options in (
        ("S_h from 0.5 to 0, adaptive", ["-stepper_adapt", "yes", "-stepper_dt_max", 1000]),
        ("S_h from 0.5 to 0, dt = 500 s", ["-stepper_dt", 500]),
        ("S_h from 0.5 to 0, K_d x 1e4, dt = 500 s", [*STIFF, "-stepper_dt", 500]),
        ("S_h from 0.5 to 0, euler, K_d x 1e4, dt = 500 s", [*STIFF, "-stepper_dt", 500, "-stepper_type", "euler"]),
    ):
        run = Run.of_case(CASES / "open_cell.yaml", "-time_end", "10000 s", "-output_probe_every", "0 s", *options)
        Sh = run.probe("middle")["S_h"]
        print(f"\n{name}: {len(run.balance['time_s'])} steps, least S_h {np.min(Sh):.3g}, last {Sh[-1]:.3g}")
        check(f"{name}: least S_h", np.min(Sh), (0.0, 1.0))
        if "-stepper_dt" in options:  # at constant p and T a step multiplies S_h by what (12) makes of it, or leaves none
            z = -exact.dissociation_rate() * 500 * (1e4 if STIFF[1] in options else 1)
            want = 0.5 * max(0.0, GROWTH["euler" if "euler" in options else "sdirk2"](z)) ** np.arange(1, 5)
            judge(13, f"{name}: S_h after each of four steps, off the integrator's own", np.max(np.abs(Sh[1:5] - want) / np.maximum(want, 1e-300)), 2e-4)
        check(f"{name}: last S_h", Sh[-1], 1e-10)
        check_true(f"{name}: hydrate mass never negative", np.all(run.balance["hydrate_kg"] >= 0))
        balances(name, run)


if __name__ == "__main__":
    closed()
    constant_p_and_T()
    to_zero()
    finish()
