#!/usr/bin/python3
"""Initial states in balance with gravity (docs/equations.md, section 13): nothing moves when the run starts.

A layered column under the sea (cases/geostatic.yaml), two materials, hydrostatic, K0, geothermal, in water that neither
compresses nor expands: at rest to round-off with every basis, along y and along x, about an axis, and, without pore
pressure, wherever layers and surface cut the grid's cells.  Compressible water leaves velocities that fall with h.
The profiles are held against sums and integrals made here.
"""
import json
import re
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, order, scratch, table

CASE = Path(__file__).parent / "cases" / "geostatic.yaml"
TIGHT = ("-quiet", "-newton_tol_residual", 1e-11, "-newton_tol_update", 1e-10)
G, RHO_W, P_ATM, SEA = 9.81, 1000.0, 101325.0, 40.0
FOLDER = scratch()
rows = []


def variant(name, *edits):
    """A case of its own: pairs of texts, old and new."""
    text = CASE.read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    path = FOLDER / f"{name}.yaml"
    path.write_text(text)
    return path


def ends(case, *options, ranks=1):
    """(run, variables at the start, at the end)."""
    run = Run.of_case(case, *TIGHT, *options, ranks=ranks)
    snapshots = run.snapshots()
    return run, snapshots[0][1], snapshots[-1][1]


def at_rest(what, case, *options, bar=1e-12, bar_T=1e-12):
    """Velocities (m/s) after ten steps, and what stress and temperature did."""
    run, first, last = ends(case, *options)
    speed = max(np.abs(last[v]).max() for v in ("v_s", "v_w", "v_g") if v in last)
    stress = np.abs(last["stress"] - first["stress"]).max() / np.abs(first["stress"]).max()
    heat = np.abs(last["T"] - first["T"]).max() if "T" in last else 0.0
    rows.append((what, speed, stress, heat))
    judge("geostatic", f"{what}: largest velocity after 10 steps (m/s)", speed, bar)
    check(f"{what}: change of stress over the largest", stress, 1e-10)
    check(f"{what}: change of temperature (K)", heat, bar_T)
    check_true(f"{what}: no warning", not any(w in run.output for w in ("unstressed", "tension")))
    return first


# ---------------------------------------------------------------- at rest to round-off
NO_HEAT = ((", cold, warm]", "]"), ("  cold: {type: temperature, axis: y, position: 20 m, temperature: 6 degC}\n", ""),
           ("  warm: {type: temperature, axis: y, position: 0 m, temperature: 6.536 degC}\n", ""),
           (" geothermal: 25 K/km, geothermal_datum: 8 m,", ""), (" geothermal: 28 K/km,", ""))  # fmt: skip
DRY = (*NO_HEAT, ("fields: thm", "fields: m"), ("hydrostatic: yes, datum: 40 m,", ""), ("pressure: 101325 Pa,", ""),
       ("    water: {bulk_modulus: incompressible}\n", ""))  # fmt: skip
OFF = (("4 m, 8 m", "4 m, 7.3 m"), ("0 m, 8 m", "0 m, 7.3 m"), ("4 m, 20 m", "4 m, 19.1 m"))
TURNED = (("[4 m, 24 m], cells: [2, 12]", "[24 m, 4 m], cells: [12, 2]"), ("[0 m/s^2, -9.81 m/s^2]", "[-9.81 m/s^2, 0 m/s^2]"),
          ("4 m, 8 m", "8 m, 4 m"), ("0 m, 8 m", "8 m, 0 m"), ("4 m, 20 m", "20 m, 4 m"), ("axis: y, position: 0 m", "axis: x, position: 0 m"), ("left: {type: roller, axis: x", "left: {type: roller, axis: y"),
          ("right: {type: roller, axis: x", "right: {type: roller, axis: y"), ("side: top", "side: right"), ("axis: y, position: 20 m", "axis: x, position: 20 m"))  # fmt: skip
UPWARD = (*NO_HEAT, ("fields: thm", "fields: hm"), ("-9.81", "9.81"), ("datum: 40 m", "datum: 20 m"), ("side: top", "side: bottom"),
          ("axis: y, position: 0 m", "axis: y, position: 20 m"))  # fmt: skip
HYDRATE = (("fields: thm", "fields: thmc"), ("degC, geothermal: 2", "degC, Sh: 0.3, Sw: 0.6999999999, Sg: 1e-10, geothermal: 2"),
           ("    permeability:", "    gas: {eos: ideal, viscosity: 1e6 Pa s}\n    retention: {law: van_genuchten, p0: 10 kPa, m: 0.5, Swr: 0.1, Sgr: 0}\n"
            "    relperm: {Swr: 0.1, Sgr: 0.5, nw: 3, ng: 2}\n    permeability:"))  # fmt: skip
BURST = ("-stepper_type", "hybrid", "-time_end", "1e-4 s", "-stepper_dt", "1e-5 s", "-output_times", "0 s, 1e-4 s",
         "-mat_sand_water_bulk_modulus", "1e13 Pa", "-mat_clay_water_bulk_modulus", "1e13 Pa")  # fmt: skip
SLOW = ("-stepper_type", "hybrid", "-time_end", "0.01 s", "-stepper_dt", "1e-3 s", "-output_times", "0 s, 0.01 s")

first = at_rest("two layers, thm, cpgimp", CASE)
at_rest("ugimp", CASE, "-basis", "ugimp")
at_rest("quasi-static", CASE, "-inertia", "no")
at_rest("euler", CASE, "-stepper_type", "euler")
at_rest("hybrid", CASE, *BURST)
at_rest("about an axis", CASE, "-geometry", "axisymmetric")
at_rest("along x", variant("turned", *TURNED))
at_rest("gravity upwards", variant("upward", *UPWARD))
at_rest("hydrate and a trace of gas, thmc", variant("hydrate", *HYDRATE))
off = variant("off", *DRY, *OFF)
at_rest("layers and surface inside cells", off)
at_rest("layers and surface inside cells, ugimp about an axis", off, "-basis", "ugimp", "-geometry", "axisymmetric")
WARM = ("-mat_sand_water_expansion", "2e-4 1/K", "-mat_clay_water_expansion", "2e-4 1/K", "-region_deep_temperature", "60 degC", "-region_shallow_temperature", "60 degC")
at_rest("open top, water lighter than at its reference", variant("open", *NO_HEAT, ("fields: thm", "fields: hm"), ("right, sea", "right, sea, open"),
        ("  sea: {", "  open: {type: pressure, side: top, initial: yes}\n  sea: {"), ("297525 Pa", f"{P_ATM + RHO_W * np.exp(-2e-4 * 40) * G * 20!r} Pa")), *WARM)  # fmt: skip
at_rest("linear functions", variant("dry", *DRY), "-boundaries", "base,left,right,sea", "-bc_sea_normal", "0 Pa", "-basis", "linear")
wet = variant("wet", *NO_HEAT, ("fields: thm", "fields: hm"), *OFF, ("297525 Pa", "306354 Pa"))
at_rest("saturated, layers and surface inside cells", wet)
SEA_AROUND = ((", sea", ""), ("  sea: {type: traction, side: top, normal: 297525 Pa}\n", ""),
              ("basis: cpgimp", "basis: cpgimp\nambient: {pressure: 101325 Pa, density: 1000 kg/m^3, level: 40 m}"))  # fmt: skip
at_rest("ambient sea", variant("ambient", *SEA_AROUND))
at_rest("ambient sea, about an axis", variant("ambient", *SEA_AROUND), "-geometry", "axisymmetric")
at_rest("ambient sea, hybrid", variant("ambient", *SEA_AROUND), *BURST)
flooded = variant("flooded", *NO_HEAT, ("fields: thm", "fields: hm"), *OFF, *SEA_AROUND)
at_rest("ambient sea, layers and surface inside cells", flooded)
at_rest("3 x 3 under 2 x 2 a cell", off, "-region_deep_particles_per_cell", "3,3")
at_rest("layers and surface inside cells, hybrid", off, *SLOW)


def leaning(name, gravity, up):
    """Two layers across axis `up`, inside cells, under gravity that is oblique to them, between sides that hold what an endless slope hands on."""
    n = len(gravity)
    place = lambda at, other: [f"{at if d == up else other} m" for d in range(n)]
    sides = {f"side_{d}_{x}": {"type": "fixed", "axis": "xyz"[d], "position": f"{x} m"} for d in range(n) for x in (0, 4) if d != up}
    soil = lambda porosity, density, E: {"porosity": porosity, "solid": {"density": f"{density} kg/m^3"}, "elasticity": {"E0": E, "nu": 0.3}}
    path = FOLDER / f"{name}.yaml"
    path.write_text(json.dumps({
        "title": "layers that lean", "fields": ["solid"], "gravity": [f"{g} m/s^2" for g in gravity],
        "grid": {"lower": place(0, 0), "upper": place(24, 4), "cells": [12 if d == up else 4 for d in range(n)]},
        "materials": ["sand", "clay"], "mat": {"sand": soil(0.4, 2650, "50 MPa"), "clay": soil(0.5, 2700, "20 MPa")}, "regions": ["deep", "shallow"],
        "region": {"deep": {"lower": place(0, 0), "upper": place(7.3, 4), "material": "sand", "stress": {"geostatic": 0.5}},
                   "shallow": {"lower": place(7.3, 0), "upper": place(19.1, 4), "material": "clay", "stress": {"geostatic": 0.8}}},
        "boundaries": ["base", *sides], "bc": {"base": {"type": "fixed", "axis": "xyz"[up], "position": "0 m"}, **sides},
        "time": {"end": "1000 s"}, "stepper": {"adapt": "no", "dt": "100 s"}, "output": {"times": ["0 s", "1000 s"]}}))  # fmt: skip
    return path


plane = leaning("lean", (3, -9), 1)
lean = at_rest("oblique gravity, layers and surface inside cells", plane)
at_rest("oblique gravity, hybrid", plane, *SLOW)
at_rest("oblique gravity, ambient sea", variant("lean_sea", *NO_HEAT, ("fields: thm", "fields: hm"), *OFF, *SEA_AROUND, ("[0 m/s^2, -9.81 m/s^2]", "[3 m/s^2, -9 m/s^2]"),
                                                ("left: {type: roller", "left: {type: fixed"), ("right: {type: roller", "right: {type: fixed")))  # fmt: skip
swapped = at_rest("oblique gravity, axes swapped", leaning("swapped", (-9, 3), 0))
space = at_rest("oblique gravity along three axes, in space", leaning("lean_3d", (3, 2, -9), 2))
table(("state", "velocity (m/s)", "stress", "T (K)"), rows)
yy, xy = lean["stress"][:, 1], lean["stress"][:, 3]
judge("geostatic", "oblique gravity: shear stress against gravity's slope times the vertical one, of the largest", np.abs(xy + 3 / 9 * yy).max() / np.abs(xy).max(), 1e-12)
judge("geostatic", "oblique gravity: largest shear stress against the weight of all, less half a particle's", np.abs(xy).max() / (3 * (0.5 * 2700 * 11.8 + 0.6 * 2650 * 7.3)), (0.9, 1))
judge("geostatic", "oblique gravity: axes swapped, shear stress, of the largest", np.abs(np.sort(swapped["stress"][:, 3]) / np.sort(lean["stress"][:, 3]) - 1).max(), 1e-9)
xy, yz, xz = space["stress"][:, 3:].T
judge("geostatic", "oblique gravity in space: shear stresses in proportion to gravity along their axes", max(np.abs(xy).max(), np.abs(2 * xz - 3 * yz).max()) / np.abs(xz).max(), 1e-12)
two = ends(plane, ranks=2)[1]
judge("geostatic", "oblique gravity: 2 ranks against 1, stress, of the largest", np.abs(two["stress"] - lean["stress"]).max() / np.abs(lean["stress"]).max(), 1e-12)

# ---------------------------------------------------------------- the profiles
x, y = first["position"].T
clay, sand = 0.5 * 2700 + 0.5 * RHO_W, 0.6 * 2650 + 0.4 * RHO_W
above = np.where(y > 8, clay * (20 - y), clay * 12 + sand * (8 - y)) * G + P_ATM + RHO_W * G * 20
p = P_ATM + RHO_W * G * (SEA - y)
K0, T = np.where(y > 8, 0.8, 0.5), np.where(y > 8, 6 + 0.028 * (20 - y), 6.336 + 0.025 * (8 - y))
xx, yy, zz, xy, yz, xz = first["stress"].T
judge("geostatic", "vertical effective stress against the weight above less the pore pressure, of the largest", np.abs(yy - p + above).max() / above.max(), 1e-12)
check("K0 in the plane", np.abs(xx - K0 * yy).max(), 1e-9)
check("K0 out of the plane", np.abs(zz - K0 * yy).max(), 1e-9)
check("shear", max(np.abs(s).max() for s in (xy, yz, xz)), 0.0)
check("pore pressure (Pa)", np.abs(first["p_w"][:, 0] - p).max(), 1e-8)
check("temperature (K)", np.abs(first["T"][:, 0] - T).max(), 1e-12)

_, first, _ = ends(CASE, "-region_shallow_geothermal_datum", "15 m", "-stepper_max_steps", 1)
mine = first["position"][:, 1] > 8
bent = 6 + 0.028 * np.maximum(15 - first["position"][mine, 1], 0)
check("temperature with its datum inside the body (K)", np.abs(first["T"][mine, 0] - bent).max(), 1e-12)

# ---------------------------------------------------------------- compressible, expanding water
WATER = [o for m in ("sand", "clay") for o in (f"-mat_{m}_water_bulk_modulus", "2.2 GPa", f"-mat_{m}_water_expansion", "2e-4 1/K")]
ONE = ("-region_deep_geothermal", "28 K/km", "-region_deep_geothermal_datum", "20 m", "-region_deep_temperature", "6 degC",
       "-bc_warm_temperature", "6.56 degC")  # fmt: skip
_, first, _ = ends(CASE, *WATER, *ONE, "-stepper_max_steps", 1, "-output_times", "0 s")


def density(p, z):
    return RHO_W * np.exp((p - 101325) / 2.2e9 - 2e-4 * (6 + 0.028 * max(20 - z, 0.0) - 20))


def integrated(z, steps=400):
    """p at height z by Runge-Kutta from the level of the sea, in two pieces that meet where the temperature bends."""
    p = P_ATM
    for top, bottom in ((SEA, 20.0), (20.0, z)):
        h = (bottom - top) / steps
        for k in range(steps):
            at = top + k * h
            f = lambda p, at: -density(p, at - (1e-12 if bottom == z else -1e-12)) * G
            a = f(p, at)
            b = f(p + 0.5 * h * a, at + 0.5 * h)
            c = f(p + 0.5 * h * b, at + 0.5 * h)
            d = f(p + h * c, at + h)
            p += h / 6 * (a + 2 * b + 2 * c + d)
    return p


heights = first["position"][:, 1]
exact = {z: integrated(z) for z in np.unique(heights)}
miss = max(abs(first["p_w"][k, 0] / exact[z] - 1) for k, z in enumerate(heights))
judge("geostatic", "hydrostatic pressure of compressible, expanding water against its integral", miss, 1e-12)
slope = max(abs(first["grad_p_w"][k, 1] / (-density(exact[z], z) * G) - 1) for k, z in enumerate(heights))
check("... its gradient on particles", slope, 1e-12)

LEVEL = variant("level", ("conductivity: 2 W/(m K)", "conductivity: 0 W/(m K)"), ("incompressible}", "incompressible, conductivity: 0 W/(m K)}"))  # one gradient in two materials
cells, speeds = (12, 24, 48), []
for n in cells:
    _, _, last = ends(LEVEL, *WATER, *ONE, "-grid_cells", f"2,{n}")
    speeds.append(max(np.abs(last[v]).max() for v in ("v_s", "v_w")))
table(("cells", "velocity (m/s)"), list(zip(map(float, cells), speeds)))
judge("geostatic", "compressible water, h = 2 m: largest velocity over k rho g / mu", speeds[0] / (1e-12 / 1e-3 * RHO_W * G), 2e-5)
check("... falls with h, order", order(1 / np.array(cells, float), np.array(speeds)).min(), (0.8, 3))

# ---------------------------------------------------------------- ground that is not flat; ranks
STEP = (*DRY, ("4 m, 20 m", "2 m, 20 m"))
step = variant("step", *STEP, ("deep, shallow]", "deep, shallow, bench]"),
               ("  shallow: {", "  bench: {lower: [2 m, 8 m], upper: [4 m, 13 m], material: clay, stress: {geostatic: 0.8}}\n  shallow: {"))
one, two = ends(step), ends(step, ranks=2)
x, y = one[1]["position"].T
top = np.where(x < 2, 20, 13)
clay, sand = 0.5 * 2700, 0.6 * 2650
weight = np.where(y > 8, clay * (top - y), clay * (top - 8) + sand * (8 - y)) * G
check("a step in the ground: stress is the weight along the vertical", np.abs(one[1]["stress"][:, 1] + weight + 297525).max(), 1e-6)
for what, case, options in (("level ground", CASE, ()), ("layers inside cells", off, ()), ("a step in the ground", step, ("-stepper_max_steps", 1)),
                            ("ranks side by side", step, ("-stepper_max_steps", 1, "-grid_cells", "16,12"))):  # fmt: skip
    a, b = (ends(case, *options, ranks=n)[1] for n in (1, 2))
    check_true(f"{what}: the same start on 1 and 2 ranks", all(np.array_equal(a[v], b[v]) for v in a))
_, _, last = ends(CASE, ranks=2)
check("velocity on 2 ranks (m/s)", max(np.abs(last[v]).max() for v in ("v_s", "v_w")), 1e-12)

# ---------------------------------------------------------------- the case as it ran; warnings
run, first, _ = ends(CASE)
again = Run.of_case(run.out / "case.yaml", *TIGHT)
check_true("the resolved case starts from the same state", all(np.array_equal(v, again.snapshots()[0][1][k]) for k, v in first.items()))
CALM = ("-stepper_max_steps", 1, "-output_times", "")
bare = variant("bare", *DRY, (", stress: {geostatic: 0.5}", ""), (", stress: {geostatic: 0.8}", ""))
say = lambda *o: Run.of_case(bare, "-quiet", *CALM, *o).output
check_true("gravity on an unstressed body: one warning", say().count("gravity acts on an unstressed body: region deep") == 1)
check_true("none when gravity grows", "unstressed" not in say("-gravity_ramp", "1 s"))
check_true("none when all is stressed", "unstressed" not in say("-region_deep_stress", "0 Pa,-1 kPa,0 Pa,0 Pa,0 Pa,0 Pa", "-region_shallow_stress", "0 Pa,-1 kPa,0 Pa,0 Pa,0 Pa,0 Pa"))
loadless = Run.of_case(CASE, "-quiet", *CALM, "-bc_sea_normal", "0 Pa")
check_true("pore pressure without a load on top: a warning", re.search(r"the geostatic stress is a tension of up to 29\d[.\d]* kPa", loadless.output))
# ---------------------------------------------------------------- normally consolidated: K0 = 1 - sin 30 deg where there is strength
STRONG = ("    elasticity:", "    plasticity: {law: mohr_coulomb, cohesion_max: 1 MPa, friction_peak: 30 deg}\n    elasticity:")
loose = variant("loose", STRONG, ("geostatic: 0.5", "normally_consolidated: yes"), ("geostatic: 0.8", "normally_consolidated: yes"))
first = at_rest("normally consolidated ground with strength", loose)
judge("geostatic", "normally consolidated, friction of 30 deg: horizontal over vertical effective stress", np.abs(first["stress"][:, 0] / first["stress"][:, 1] - 0.5).max(), 1e-12)

finish()
