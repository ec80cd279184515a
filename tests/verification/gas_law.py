#!/usr/bin/env python3
"""Real gas in place and in a closed, warmed cell, against Peng and Robinson's equation.

Real gas (120): gas in place of an initial state and a closed, warmed cell, implicit and hybrid, against Peng and
Robinson's equation solved here on its own; what the paper's ideal gas would make of it stands beside it.
"""
import numpy as np

from common import Run, check_true, finish, judge, scratch, table
from exact import R_GAS, ZERO_C, Retention, bisect

M, TC, PC, ECCENTRIC = 0.016, 190.564, 4.5992e6, 0.01142
PHI, SG, V = 0.3, 0.4, 0.04 * 0.04
CURVE = Retention(1e3, 0.5, 0.1, 0.05)
SCENE = """
title: a closed cell of gas and water, warmed
fields: [water, gas, heat]
grid: {lower: [0 m, 0 m], upper: [0.08 m, 0.08 m], cells: [8, 8]}
materials: [sand]
mat:
  sand:
    porosity: 0.3
    solid: {density: 2600 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}
    water: {bulk_modulus: 2.2 GPa, ref_pressure: 3 MPa, ref_temperature: 4 degC, expansion: 2e-4 1/K}
    retention: {p0: 1 kPa, m: 0.5, Swr: 0.1, Sgr: 0.05}
    relperm: {nw: 2, ng: 2}
    permeability: {k0: 1e-16 m^2, hydrate_law: none}
regions: [cell]
region: {cell: {lower: [0 m, 0 m], upper: [0.04 m, 0.04 m], material: sand, pressure: 3 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4}}
boundaries: [bath]
bc: {bath: {type: region_temperature, region: cell, temperature: {ramp: [4 degC, 24 degC, 0 s, 1 s]}}}
time: {end: 1 s}
stepper: {tol: 1e-6}
output: {times: [0 s, 1 s]}
probes: [middle]
probe: {middle: {at: [0.02 m, 0.02 m]}}
"""


def pressure(rho, T):
    """Peng and Robinson (1976) as they print it: p of the molar volume (Pa), T in degC."""
    TK, v = T + ZERO_C, M / rho
    kappa = 0.37464 + 1.54226 * ECCENTRIC - 0.26992 * ECCENTRIC**2
    a = 0.45723553 * (R_GAS * TC) ** 2 / PC * (1 + kappa * (1 - np.sqrt(TK / TC))) ** 2
    b = 0.07779607 * R_GAS * TC / PC
    return R_GAS * TK / (v - b) - a / (v * v + 2 * b * v - b * b)


def density(p, T):
    return bisect(lambda rho: pressure(rho, T) - p, 1e-9, 300.0)


def warmed(p0, T0, T1, gas=density):
    """Mean pressure of the closed cell at T1: both masses stay in the pores."""
    pc0 = CURVE.invert(SG)
    pw0 = p0 - SG * pc0
    water = lambda p, T: np.exp((p - 3e6) / 2.2e9 - 2e-4 * (T - 4))
    share = lambda pw: 1 - (1 - SG) * water(pw0, T0) / water(pw, T1)
    pc = lambda pw: CURVE.invert(share(pw))
    pw = bisect(lambda pw: share(pw) * gas(pw + pc(pw), T1) - SG * gas(pw0 + pc0, T0), 0.5 * p0, 3 * p0)
    return pw + share(pw) * pc(pw)


FIXED = ["-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "1e-3 s"]
HALF = ["-time_end", "0.5 s", "-output_times", "0 s, 0.5 s"]
case = scratch() / "cell.yaml"
case.write_text(SCENE)
rows = []
for p, T in ((2.84e6, 2.3), (3.75e6, 2.3), (10e6, 4.0), (15e6, 10.0)):
    start = Run.of_case(case, "-region_cell_pressure", f"{p} Pa", "-region_cell_temperature", f"{T} degC", "-bc_bath_temperature", f"{T} degC", "-time_end", "1e-3 s", "-output_times", "0 s")
    pg = p + (1 - SG) * CURVE.invert(SG)
    rho = start.snapshot(0.0)["mass_gas"].sum() / (V * PHI * SG)
    ideal = M * pg / (R_GAS * (T + ZERO_C))
    rows.append((p / 1e6, T, rho, ideal / rho, rho / density(pg, T) - 1))
    judge("fluids", f"gas in place at {p / 1e6:g} MPa, {T:g} degC against (120), relative", abs(rows[-1][4]), 1e-12)
table(("p (MPa)", "T (degC)", "rho (kg/m^3)", "Z", "error"), rows)

want, wrong = warmed(3e6, 4.0, 24.0), warmed(3e6, 4.0, 24.0, lambda p, T: M * p / (R_GAS * (T + ZERO_C)))
rows = []
for name, bar, options in (("sdirk2", 2e-7, []), ("euler", 2e-7, ["-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "0.05 s"]),
                           ("hybrid", 2e-7, FIXED)):  # fmt: skip
    run = Run.of_case(case, *options)
    p, T = run.probe("middle")["p_Pa"], run.probe("middle")["T_degC"][-1]
    rise = (p[-1] - p[0]) / (want - 3e6) - 1
    rows.append((name, T, p[-1], want, wrong, rise))
    judge("fluids", f"{name}: rise of p in a closed cell warmed by 20 K against (120), relative", abs(rise), bar)
table(("integrator", "T (degC)", "p (Pa)", "exact", "of an ideal gas", "error of the rise"), rows)
check_true("an ideal gas would not do", abs((wrong - want) / (want - 3e6)) > 0.02, f"{(wrong - want) / (want - 3e6):.3f} of the rise")

# 2 ranks and a restart: nothing of the law is history
for name, kind in (("sdirk2", []), ("hybrid", FIXED)):
    one = Run.of_case(case, *kind)
    two = Run.of_case(case, *kind, ranks=2)
    half = Run.of_case(case, *kind, *HALF)
    again = Run.of_case(case, *kind, "-restart", half.out / "checkpoint.h5", "-output_times", "0 s, 0.5 s, 1 s", out=half.out)
    last = one.snapshot(1.0)
    judge("fluids", f"{name}: 2 ranks against 1, p_g relative", np.max(np.abs(two.snapshot(1.0)["p_g"] / last["p_g"] - 1)), 1e-10)
    judge("fluids", f"{name}: over a restart at 0.5 s, p_g relative", np.max(np.abs(again.snapshot(1.0)["p_g"] / last["p_g"] - 1)), 1e-6)
finish()
