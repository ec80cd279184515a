#!/usr/bin/env python3
"""Thermal strain and thermal pressurisation against closed forms.

A body that is warmed free, between walls, and full of
water that cannot leave (that one free under its load: implicit alone).
"""
import numpy as np

from common import Run, finish, judge, scratch
from exact import bisect

PHI, BETA, BETA_W, K_W, E, NU, RISE = 0.4, 3e-4, 6e-4, 2.2e9, 50e6, 0.3, 20.0
SCENE = """
title: a body that is warmed
fields: [FIELDS]
grid: {lower: [0 m, 0 m], upper: [0.12 m, 0.12 m], cells: [6, 6]}
materials: [clay]
mat:
  clay:
    porosity: 0.4
    solid: {density: 2600 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K), expansion: 3e-4 1/K}
    hydrate: {expansion: 3e-4 1/K}
    water: {bulk_modulus: 2.2 GPa, expansion: 6e-4 1/K, ref_pressure: 1 MPa, ref_temperature: 10 degC}
    permeability: {k0: 1e-12 m^2, porosity_law: none, hydrate_law: none}
    elasticity: {E0: 50 MPa, nu: 0.3}
regions: [body]
region: {body: {lower: [0 m, 0 m], upper: [0.08 m, 0.08 m], material: clay, temperature: 10 degC, STATE}}
boundaries: [BOUNDS]
bc:
  bath: {type: region_temperature, region: body, temperature: {ramp: [10 degC, 30 degC, 0 s, 1 s]}}
  left: {type: roller, axis: x, position: 0 m}
  bottom: {type: roller, axis: y, position: 0 m}
  right: {type: roller, axis: x, position: 0.08 m}
  top: {type: roller, axis: y, position: 0.08 m}
  load: {type: traction, side: right, normal: 1 MPa}
  lid: {type: traction, side: top, normal: 1 MPa}
time: {end: 1.5 s}
stepper: {tol: 1e-4}
output: {times: [0 s, 1.5 s]}
probes: [m]
probe: {m: {at: [0.03 m, 0.03 m]}}
"""
LAME, G, A = E * NU / ((1 + NU) * (1 - 2 * NU)), 0.5 * E / (1 + NU), BETA * RISE / 3
HYBRID = ["-stepper_type", "hybrid", "-stepper_damping", "0.5"]


def warmed(fields, bounds, *options, water=False):
    case = scratch() / "body.yaml"
    text = SCENE.replace("FIELDS", fields).replace("BOUNDS", bounds).replace("STATE", "pressure: 1 MPa" if water else "Sh: 0.2")
    names = bounds.split(", ")
    case.write_text("\n".join(l for l in text.splitlines() if not (l.startswith("  ") and ": {type:" in l and l.split(":")[0].strip() not in names)))
    last = Run.of_case(case, *options).snapshot(1.5)
    return last["log_J"] if "log_J" in last else None, last["stress"] if "stress" in last else None, last["p"] if water else None


def dry():
    """Free in the plane: e = (1 + nu) a, sigma'_zz = -E a; between walls sigma' = -(3 lambda + 2 G) a, a = beta dT/3."""
    for name, bar, options in (("sdirk2", 1e-4, ["-inertia", "no"]), ("hybrid", 1e-4, HYBRID)):
        J, stress, _ = warmed("solid, heat", "bath, left, bottom", *options)
        judge("fluids", f"{name}: free, ln J over 2 (1 + nu) a", np.max(np.abs(J / (2 * (1 + NU) * A) - 1)), bar)
        judge("fluids", f"{name}: free, sigma'_zz over -E a", np.max(np.abs(stress[:, 2] / (-E * A) - 1)), bar)
        J, stress, _ = warmed("solid, heat", "bath, left, bottom, right, top", *options)
        judge("fluids", f"{name}: between walls, sigma' over -(3 lambda + 2 G) a", np.max(np.abs(stress[:, :3] / (-(3 * LAME + 2 * G) * A) - 1)), bar)


def pores(J):
    """ln of the volume of the pores over what it was, at the volume ratio J."""
    return np.log((J - (1 - PHI) * np.exp(BETA * RISE)) / PHI)


def wet():
    """Undrained.  Held: p - p_0 = K [beta_w dT - ln(V_p/V_p0)].  Free under its load: the same with J = exp 2e, and the skeleton bears p - p_0."""
    held = K_W * (BETA_W * RISE - pores(1.0))
    free = bisect(lambda e: (2 * LAME + 2 * G) * e - (3 * LAME + 2 * G) * A - K_W * (BETA_W * RISE - pores(np.exp(2 * e))), 0.0, 0.05)
    for name, bar, options in (("sdirk2", 1e-4, ["-inertia", "no"]), ("hybrid", 1e-4, HYBRID)):
        _, _, p = warmed("water, heat", "bath", *([] if name == "sdirk2" else options[:2]), water=True)
        judge("fluids", f"{name}: rigid, rise of p over the closed form", np.max(np.abs((p - 1e6) / held - 1)), bar)
        if name == "hybrid":
            continue  # the load's waves in water take longer to die away than this test may
        J, _, p = warmed("solid, water, heat", "bath, left, bottom, load, lid", *options, water=True)
        judge("fluids", f"{name}: free under its load, rise of p over the closed form", np.max(np.abs((p - 1e6) / (K_W * (BETA_W * RISE - pores(np.exp(2 * free)))) - 1)), 5 * bar)
        judge("fluids", f"{name}: free under its load, ln J over the closed form", np.max(np.abs(J / (2 * free) - 1)), bar)
    print(f"held: {held / 1e6:.4f} MPa, free: e = {free:.6g}")


if __name__ == "__main__":
    dry()
    wet()
    finish()
