#!/usr/bin/env python3
"""Heat of compression and throttling of the fluids, against the same laws integrated on their own.

Heat of compression and throttling of the fluids (290): a closed cell that is warmed, a closed cell into which water is
pressed, and gas throttled on its way through sediment, against the same laws integrated here on their own.
"""
import math

import numpy as np

from common import Run, check_true, finish, judge, scratch, table
from exact import R_GAS, ZERO_C, Retention, bisect

M, TC, PC, ECCENTRIC = 0.016, 190.564, 4.5992e6, 0.01142
PHI, SG, V, C_G, C_W = 0.3, 0.4, 0.04 * 0.04, 2100.0, 4200.0
K_W, BETA_W, RHO_S, C_S = 2.2e9, 2e-4, 2600.0, 800.0
CURVE = Retention(1e5, 0.5, 0.1, 0.05)
MATERIAL = """
materials: [sand]
mat:
  sand:
    porosity: 0.3
    solid: {density: 2600 kg/m^3, heat_capacity: %g J/(kg K), conductivity: %g W/(m K)}
    water: {bulk_modulus: 2.2 GPa, ref_pressure: 3 MPa, ref_temperature: 4 degC, expansion: 2e-4 1/K, conductivity: %g W/(m K)}
    gas: {conductivity: %g W/(m K)}
    retention: {p0: 100 kPa, m: 0.5, Swr: 0.1, Sgr: 0.05}
    relperm: {nw: 2, ng: 2, Swr: %g}
    permeability: {k0: 1e-12 m^2, hydrate_law: none}
compression_heat: yes
"""
CELL = """
title: a closed cell of gas and water
fields: [water, gas, heat]
grid: {lower: [0 m, 0 m], upper: [0.08 m, 0.08 m], cells: [4, 4]}
regions: [cell]
region: {cell: {lower: [0 m, 0 m], upper: [0.04 m, 0.04 m], material: sand, pressure: 3 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4}}
%s
time: {end: 1 s}
stepper: {tol: 1e-5}
output: {times: [0 s, 1 s]}
probes: [middle]
probe: {middle: {over: cell}}
"""
RISE, RATE = 20.0, 0.05 * V * PHI / 0.08  # K; m^3/s per m^2 of the two sides that let water in: 5 % of the pores in 1 s
BATH = "boundaries: [bath]\nbc: {bath: {type: region_temperature, region: cell, temperature: {ramp: [4 degC, 24 degC, 0 s, 1 s]}}}"
PUMP = "boundaries: [left, right]\nbc:\n" + "".join(f"  {s}: {{type: inflow, side: {s}, water: {RATE} m/s}}\n" for s in ("left", "right"))
PLUG = """
title: gas throttled in sediment
fields: [water, gas, heat]
inertia: no
grid: {lower: [0 m, 0 m], upper: [1 m, 0.05 m], cells: [12, 1]}
regions: [plug]
region: {plug: {lower: [0 m, 0 m], upper: [1 m, 0.05 m], material: sand, pressure: 10 MPa, temperature: 30 degC, Sw: 0.2, Sg: 0.8}}
boundaries: [inlet, warm, outlet]
bc:
  inlet: {type: pressure, side: left, pressure: 10 MPa, phases: gas}
  warm: {type: temperature, axis: x, position: 0 m, temperature: 30 degC}
  outlet: {type: pressure, side: right, pressure: {ramp: [10 MPa, 5 MPa, 0 s, 1 s]}, phases: gas}
time: {end: 30 s}
stepper: {tol: 1e-2}
output: {times: [0 s, 30 s]}
"""


def molar_pressure(v, T, ideal):
    TK = T + ZERO_C
    if ideal:
        return R_GAS * TK / v
    kappa = 0.37464 + 1.54226 * ECCENTRIC - 0.26992 * ECCENTRIC**2
    a = 0.45723553 * (R_GAS * TC) ** 2 / PC * (1 + kappa * (1 - (TK / TC) ** 0.5)) ** 2
    b = 0.07779607 * R_GAS * TC / PC
    return R_GAS * TK / (v - b) - a / (v * v + 2 * b * v - b * b)


def density(p, T, ideal=False):
    return bisect(lambda rho: molar_pressure(M / rho, T, ideal) - p, 1e-9, 300.0, 52)


def expansion(p, T, ideal):
    """-(1/rho) drho/dT at constant pressure, by differences."""
    h = 0.01
    return -(math.log(density(p, T + h, ideal)) - math.log(density(p, T - h, ideal))) / (2 * h)


def water(p, T):
    return 1000 * math.exp((p - 3e6) / K_W - BETA_W * (T - 4))


class Closed:
    """Water of mass m_w(t), gas of constant mass, in rigid pores; p_w follows from T and m_w."""

    def __init__(self, ideal):
        self.ideal, self.pc = ideal, CURVE.invert(SG)
        self.pw = 3e6 - SG * self.pc
        self.m_w = V * PHI * (1 - SG) * water(self.pw, 4.0)
        self.m_g = V * PHI * SG * density(self.pw + self.pc, 4.0, ideal)

    def pressures(self, T, m_w):
        def off(pw):
            sg = 1 - m_w / (V * PHI * water(pw, T))
            return V * PHI * sg * density(pw + CURVE.invert(sg), T, self.ideal) - self.m_g

        pw = bisect(off, 0.5 * self.pw, 4 * self.pw, 45)
        sg = 1 - m_w / (V * PHI * water(pw, T))
        return pw, pw + CURVE.invert(sg), sg

    def rates(self, T, m_w):
        """Heat that d p gives per dm_w and per dT (J/kg, J/K), and the capacity (J/K)."""
        pw, pg, sg = self.pressures(T, m_w)
        warm = V * PHI * (T + ZERO_C) * np.array([(1 - sg) * BETA_W, sg * expansion(pg, T, self.ideal)])
        dm, dT = 1e-3 * m_w, 0.1
        slope = lambda a, b, d: (np.array(a[:2]) - np.array(b[:2])) / (2 * d)
        by_m = slope(self.pressures(T, m_w + dm), self.pressures(T, m_w - dm), dm)
        by_T = slope(self.pressures(T + dT, m_w), self.pressures(T - dT, m_w), dT)
        return warm @ by_m, warm @ by_T, V * (1 - PHI) * RHO_S * C_S + m_w * C_W + self.m_g * C_G

    def warmed(self, rise, n=3):
        """Heat that a rise of T takes, and the share of it that p gives (J), by Simpson's rule."""
        T = np.linspace(4.0, 4.0 + rise, 2 * n + 1)
        r = np.array([self.rates(x, self.m_w) for x in T])
        w = np.array([1] + [4, 2] * (n - 1) + [4, 1]) * rise / (6 * n)
        return w @ (r[:, 2] - r[:, 1]), w @ r[:, 1]

    def pumped(self, n=4):
        """T after 0.05 of the pores have been filled with water at the body's own p and T, without heat (Heun)."""
        T, m, heat, dt = 4.0, self.m_w, 0.0, 1.0 / n

        def slope(T, m):
            by_m, by_T, C = self.rates(T, m)
            dm = RATE * 0.08 * water(self.pressures(T, m)[0], T)
            rise = by_m * dm / (C - by_T)
            return rise, dm, by_m * dm + by_T * rise

        for _ in range(n):
            a = slope(T, m)
            b = slope(T + dt * a[0], m + dt * a[1])
            T, m, heat = (x + 0.5 * dt * (p + q) for x, p, q in zip((T, m, heat), a, b))
        return T, heat


FIXED = ["-stepper_type", "hybrid", "-stepper_adapt", "no", "-stepper_dt", "4e-5 s"]
HALF = ["-time_end", "0.5 s", "-output_times", "0 s, 0.5 s"]
folder = scratch()
for name, conditions in (("bath", BATH), ("pump", PUMP)):
    (folder / f"{name}.yaml").write_text(CELL % conditions + MATERIAL % (C_S, 3.0, 0.5, 0.044, 0.1))
(folder / "plug.yaml").write_text(PLUG + MATERIAL % (80.0, 1e-3, 1e-3, 1e-3, 0.3))

# a closed cell: heat that it takes to warm it, and how warm it gets when water is pressed into it
rows = []
for eos in ("peng_robinson", "ideal"):
    cell = Closed(eos == "ideal")
    heat, given = cell.warmed(RISE)
    T, work = cell.pumped()
    for stepper in ("sdirk2", "euler", "hybrid"):
        kind = {"sdirk2": [], "euler": ["-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "0.02 s"], "hybrid": FIXED}[stepper]
        if stepper != "sdirk2" and eos == "ideal":
            continue
        bath = Run.of_case(folder / "bath.yaml", "-mat_sand_gas_eos", eos, *kind).balance
        pump = Run.of_case(folder / "pump.yaml", "-mat_sand_gas_eos", eos, *kind)
        end = pump.probe("middle")["T_degC"][-1]
        rows.append((eos, stepper, bath["heat_in_J"][-1] / heat - 1, bath["compression_heat_J"][-1] / given - 1, end, T, (end - T) / (T - 4)))
        judge("fluids", f"{eos}, {stepper}: heat that warms a closed cell by 20 K, of what compression gives", abs(bath["heat_in_J"][-1] - heat) / given, 0.01)
        judge("fluids", f"{eos}, {stepper}: ... heat of compression in balance.csv", abs(rows[-1][3]), 0.01)
        judge("fluids", f"{eos}, {stepper}: rise of T as water is pressed in", abs(rows[-1][6]), 0.01)
        judge("fluids", f"{eos}, {stepper}: ... heat of compression in balance.csv", abs(pump.balance["compression_heat_J"][-1] / work - 1), 0.01)
        judge("fluids", f"{eos}, {stepper}: balance of heat", np.max(np.abs(pump.balance["heat_error"])), 1e-8)
table(("gas", "integrator", "heat of warming", "of it compression", "T after pumping", "exact", "error of the rise"), rows)

# gas throttled from 10 to 5 MPa: c dT + (1 - beta T)/rho dp - b dx = 0 along the way, with the run's own p(x)
rows = []
for eos, stepper, gravity in (("peng_robinson", "sdirk2", -1e4), ("ideal", "sdirk2", 0.0), ("peng_robinson", "hybrid", 0.0)):
    kind = ["-stepper_type", "hybrid", "-inertia", "yes"] if stepper == "hybrid" else []
    run = Run.of_case(folder / "plug.yaml", "-mat_sand_gas_eos", eos, "-gravity", f"{gravity} m/s^2, 0 m/s^2", *kind)
    end = run.snapshots()[-1][1]
    along = np.argsort(end["position"][:, 0], kind="stable")
    x, p, T = end["position"][along, 0], end["p_g"][along].ravel(), end["T"][along].ravel()
    want = [T[0]]
    for i in range(1, len(x)):
        slope = lambda p, T: -(1 - (T + ZERO_C) * expansion(p, T, eos == "ideal")) / density(p, T, eos == "ideal")
        middle = want[-1] + 0.5 * (slope(p[i - 1], want[-1]) * (p[i] - p[i - 1]) + gravity * (x[i] - x[i - 1])) / C_G
        want.append(want[-1] + (slope(0.5 * (p[i] + p[i - 1]), 0.5 * (want[-1] + middle)) * (p[i] - p[i - 1]) + gravity * (x[i] - x[i - 1])) / C_G)
    off = np.max(np.abs(T - want))
    rows.append((eos, stepper, gravity, p[-1] / 1e6, T[-1] - T[0], want[-1] - T[0], off))
    name = f"{eos}, {stepper}, gravity {gravity:g} m/s^2"
    if eos == "ideal":
        judge("fluids", f"{name}: an ideal gas is not cooled (K; what the water that expands took is not gone yet)", off, 0.01)
    else:
        judge("fluids", f"{name}: T along the way, of the drop", off / (T[0] - T[-1]), 0.01)
        judge("fluids", f"{name}: drop over 4.7 MPa, K", T[0] - T[-1], (20, 40))
    if eos == "ideal":
        continue
    case = (folder / "plug.yaml", "-gravity", f"{gravity} m/s^2, 0 m/s^2", *kind)
    short = ("-time_end", "0.2 s", "-output_times", "0 s, 0.2 s")
    half, two = Run.of_case(*case, *short), Run.of_case(*case, *short, ranks=2)
    before = half.balance["compression_heat_J"][-1]
    judge("fluids", f"{name}: 2 ranks against 1 at 0.2 s, K", np.max(np.abs(two.snapshots()[-1][1]["T"] - half.snapshots()[-1][1]["T"])), 1e-9)
    again = Run.of_case(*case, "-restart", half.out / "checkpoint.h5", "-time_end", "0.4 s", "-output_times", "0 s, 0.2 s, 0.4 s", out=half.out).balance
    sum_ = again["compression_heat_J"]
    check_true(f"{name}: heat of compression goes on over a restart", before in sum_ and sum_[-1] < 2 * before < 0, (before, sum_[-1]))
table(("gas", "integrator", "gravity (m/s^2)", "p at the end (MPa)", "dT (K)", "exact", "largest difference (K)"), rows)
finish()
