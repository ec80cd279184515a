#!/usr/bin/env python3
"""Water, salt, ice and the heat of reaction against the laws.

Water, salt, ice and the heat of reaction: curves of equilibrium, what salinity shifts, viscosities that follow T and rho,
ice that is said, and Kirchhoff's law against the enthalpy of a closed cell; implicit and hybrid.
"""
import math
import re
from pathlib import Path

import numpy as np

from common import Run, binary, check_true, finish, judge, launch, pascals, scratch

CELL = Path(__file__).parent / "cases" / "masuda_cell.yaml"
S, SHIFT = 0.035, 1.150757415565222  # (125), by hand
MASUDA = lambda T: 1.15 * math.exp(49.3185 - 9459 / (T + 273.15))
BODY = """
title: wet sand
fields: [water, gas, heat]
grid: {lower: [0 m, 0 m], upper: [0.08 m, 0.08 m], cells: [8, 8]}
materials: [sand]
mat:
  sand:
    porosity: 0.3
    solid: {density: 2600 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}
    retention: {p0: 1 kPa, m: 0.5, Swr: 0.1, Sgr: 0.05}
    relperm: {nw: 2, ng: 2}
    permeability: {k0: 1e-14 m^2, hydrate_law: none}
regions: [cell]
region: {cell: {lower: [0 m, 0 m], upper: [0.04 m, 0.04 m], material: sand, pressure: 3 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4}}
boundaries: [way]
bc: {way: {type: pressure, side: right, p_w: 2.998 MPa, p_g: 2.999 MPa}}
time: {end: 1 s}
stepper: {adapt: no, dt: 0.01 s}
output: {times: [0 s, 1 s]}
meters: [out]
meter: {out: {side: right}}
"""
KINDS = (("sdirk2", []), ("hybrid", ["-stepper_type", "hybrid", "-stepper_dt", "1e-3 s"]))


def salt():
    """A closed cell goes to the equilibrium of its salt water, whose density is that of the table."""
    run = Run.of_case(CELL, "-mat_core_kinetics_equilibrium", "masuda", "-mat_core_water_salinity", S)
    probe = run.probe("middle")
    said = re.search(r"equilibrium of hydrate by masuda, salinity 0.035 \((\S+) K colder\): p_e = (\S+ [kMG]?Pa) at (\S+) degC", run.output)
    check_true("the curve, the salinity and p_e are printed", said is not None, run.output[:400])
    judge("fluids", "printed p_e at the initial temperature, relative", abs(pascals(said[2]) / MASUDA(float(said[3]) + SHIFT) - 1), 1e-5)
    judge("fluids", "closed cell in equilibrium: p over p_e(T + shift) - 1", abs(probe["p_Pa"][-1] / MASUDA(probe["T_degC"][-1] + SHIFT) - 1), 1e-4)
    fresh = Run.of_case(CELL, "-time_end", "1e-3 s", "-stepper_dt", "1e-3 s", "-output_times", "0 s")
    ratio = run.snapshot(0.0)["mass_water"].sum() / fresh.snapshot(0.0)["mass_water"].sum()
    T = 2.3  # of the reference
    excess = S * (802 - 2.001 * T + 1.677e-2 * T**2 - 3.06e-5 * T**3 - 1.613e-5 * S * T**2)
    judge("fluids", "water of 3.5 % salt is heavier by (126), relative", abs(ratio / (1 + excess / 1000) - 1), 1e-9)


def kirchhoff():
    """sum m c (T - T_ref) - m_h L(T_ref) of a closed adiabatic cell stays: with Kirchhoff's law, and with no other slope."""
    c = {"mass_solid": 800.0, "mass_hydrate": 2010.0, "mass_water": 4200.0, "mass_gas": 2100.0}
    L = 446120 - 132.638 * 273.15
    for law, bar in (("kirchhoff", (0.0, 1e-5)), ("linear", (1e-4, 1.0))):
        (_, first), (_, last) = (lambda s: (s[0], s[-1]))(Run.of_case(CELL, "-mat_core_latent_heat_law", law).snapshots())
        H = [sum(float((v[k] * v["T"]).sum()) * c[k] for k in c) - L * float(v["mass_hydrate"].sum()) for v in (first, last)]
        heat = L * abs(float(last["mass_hydrate"].sum() - first["mass_hydrate"].sum()))
        judge("fluids", f"{law}: enthalpy that a closed cell lost, of the heat of reaction", abs(H[1] - H[0]) / heat, bar)


def viscosity(case):
    """Next to the start the laws are constants: the same meters as with the constant of the same value."""
    T = 4.0
    start = Run.of_case(case, "-time_end", "1e-3 s", "-stepper_dt", "1e-3 s", "-output_times", "0 s").snapshot(0.0)
    rho = start["mass_gas"].sum() / (start["volume"].sum() * 0.3 * 0.4)
    y = (20 - T) / (T + 96) * (1.2364 - 1.37e-3 * (20 - T) + 5.7e-6 * (20 - T) ** 2)
    water = 1.002e-3 * 10**y
    t, M = (T + 273.15) * 1.8, 16.0
    K, X = (9.379 + 0.01607 * M) * t**1.5 / (209.2 + 19.26 * M + t), 3.448 + 986.4 / t + 0.01009 * M
    gas = 1e-7 * K * math.exp(X * (rho / 1000) ** (2.447 - 0.2224 * X))
    for name, kind in KINDS:
        laws = Run.of_case(case, *kind, "-mat_sand_water_viscosity_law", "kestin", "-mat_sand_gas_viscosity_law", "lee").csv("meters.csv")
        same = Run.of_case(case, *kind, "-mat_sand_water_viscosity", f"{water} Pa s", "-mat_sand_gas_viscosity", f"{gas} Pa s").csv("meters.csv")
        plain = Run.of_case(case, *kind).csv("meters.csv")
        for fluid in ("water", "gas"):
            column = next(k for k in laws if fluid in k and "kg" in k and "rate" not in k)
            a, b, p = (r[column][-1] for r in (laws, same, plain))
            judge("fluids", f"{name}: {fluid} that left, by its law against that constant", abs(a / b - 1), 1e-3)
            check_true(f"{name}: {fluid}, the law matters", abs(a / p - 1) > 0.02, f"{a / p:.4f}")


def ice(case):
    """A body cooled to -3 degC: said once, counted, or the end; sea water at -1.5 degC is none."""
    scene = scratch() / "cold.yaml"
    text = case.read_text()
    i, j = text.index("boundaries:"), text.index("time:")
    scene.write_text(text[:i] + "boundaries: [bath]\nbc: {bath: {type: region_temperature, region: cell, temperature: {ramp: [4 degC, -3 degC, 0 s, 1 s]}}}\n" + text[j:])
    for name, kind in KINDS:
        run = Run.of_case(scene, *kind)
        summary = (run.out / "summary.txt").read_text()
        check_true(f"{name}: ice is said once", run.output.count("melting point of ice, by up to") == 1, run.output[-300:])
        said = re.search(r"at (\d+) looks, in up to (\d+) particles and by up to (\S+) K", summary)
        check_true(f"{name}: ... and counted in the summary", said is not None and int(said[2]) == 64, summary[-300:])
        judge("fluids", f"{name}: degrees below the melting point at 2.96 MPa", abs(float(said[3]) - (3 - 7.53e-8 * 2.9e6)), 0.01)
        out = scratch() / "out"
        stop = launch(binary(), scene, *kind, "-ice", "stop", "-quiet", out=out)
        at = re.search(r"stopped at t = (\S+) s: the water", stop.stdout)
        check_true(f"{name}: ice: stop ends the run with code 3", stop.returncode == 3 and at is not None, stop.stdout[-300:])
        judge("fluids", f"{name}: ... where T passes the melting point (s)", float(at[1]), (4.2 / 7 - 0.01, 4.2 / 7 + (0.3 if kind else 0.02)))
        on = launch(binary(), scene, *kind, "-ice", "warn", "-restart", out / "checkpoint.h5", "-quiet", out=out)
        check_true(f"{name}: ... and ice: warn goes on from there", on.returncode == 0 and "finished" in (out / "summary.txt").read_text(), on.stdout[-300:])
    sea = Run.of_case(scene, "-bc_bath_temperature_ramp", "4 degC, -1.5 degC, 0 s, 1 s", "-mat_sand_water_salinity", "0.035")
    check_true("sea water at -1.5 degC is no ice", "melting" not in sea.output)


if __name__ == "__main__":
    body = scratch() / "body.yaml"
    body.write_text(BODY)
    salt()
    kirchhoff()
    viscosity(body)
    ice(body)
    finish()
