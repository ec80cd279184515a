#!/usr/bin/env python3
"""Scenes of the plane, drawn out along any axis, give the plane's answers with clathra3d.

A scene of the plane is one layer of cells thick, held by rollers on both sides of it: exact in the grid's functions, so that
what differs is round-off, amplified by Newton's tolerances.  The axes are exchanged in a ring, so that each of the three is
once the one along which nothing happens.
"""
import json
import shutil
import sys
from pathlib import Path

import numpy as np

from common import binary, check, finish, judge, launch, run, scratch, table

SPACE = Path(binary()).with_name("clathra3d")
DEEP = 0.1  # m, of the layer
SIDES = (("left", "right"), ("bottom", "top"), ("back", "front"))
TIGHT = ["-newton_tol_update", 1e-11]

MATERIAL = {
    "porosity": 0.3,
    "solid": {"density": "2600 kg/m^3", "heat_capacity": "800 J/(kg K)", "conductivity": "3 W/(m K)", "expansion": "1e-5 1/K"},
    "hydrate": {"density": "900 kg/m^3", "heat_capacity": "2010 J/(kg K)", "conductivity": "0.5 W/(m K)", "expansion": "1e-5 1/K",
                "molar_mass": "0.124 kg/mol", "number": 6},
    "water": {"density": "1000 kg/m^3", "bulk_modulus": "2.2 GPa", "viscosity": "1e-3 Pa s", "heat_capacity": "4200 J/(kg K)",
              "conductivity": "0.5 W/(m K)", "expansion": "2e-4 1/K", "ref_pressure": "3.25 MPa", "ref_temperature": "4 degC",
              "molar_mass": "0.018 kg/mol"},
    "gas": {"eos": "peng_robinson", "molar_mass": "0.016 kg/mol", "viscosity": "1e-5 Pa s", "heat_capacity": "2100 J/(kg K)",
            "conductivity": "0.044 W/(m K)"},
    "retention": {"law": "van_genuchten", "p0": "50 kPa", "m": 0.3, "Swr": 0.2, "Sgr": 0.1},
    "relperm": {"nw": 4, "ng": 2},
    "permeability": {"k0": "1e-14 m^2", "porosity_law": "kozeny_carman", "hydrate_law": "power", "mh": 3},
    "kinetics": {"active": "yes", "K0": "1e-8 mol/(m^2 Pa s)", "dE": "0 J/mol", "A_geo": "1e6 1/m", "equilibrium": "sloan",
                 "A1": "1 kPa", "A2": 38.98, "A3": "8533.8 K"},
    "latent_heat": {"C0": "473632 J/kg", "C1": "140.117 J/(kg K)"},
    "elasticity": {"E0": "90 MPa", "Eh": "500 MPa", "ah": 1, "bh": 1, "nu": 0.3, "stiffness_change": "bonds"},
}  # fmt: skip


def block():
    """A block that is loaded on a part of its top, drained at its right end and heated at its left: it shears and turns."""
    half = lambda name, lower, upper: {"lower": lower, "upper": upper, "particles_per_cell": [2, 2], "material": "sediment",
                                       "pressure": "3.25 MPa", "temperature": "4 degC", "Sw": 0.5, "Sg": 0.3, "Sh": 0.2}  # fmt: skip
    return {
        "title": "Block", "gravity": ["1 m/s^2", "-9.81 m/s^2"],
        "grid": {"lower": ["0 m", "0 m"], "upper": ["0.8 m", "0.6 m"], "cells": [8, 6]},
        "materials": ["sediment"], "mat": {"sediment": MATERIAL},
        "regions": ["loaded", "free"],
        "region": {"loaded": half("loaded", ["0 m", "0 m"], ["0.3 m", "0.5 m"]), "free": half("free", ["0.3 m", "0 m"], ["0.65 m", "0.5 m"])},
        "boundaries": ["wall", "base", "load", "rest", "drain", "sun", "end"],
        "bc": {
            "wall": {"type": "roller", "axis": "x", "position": "0 m"},
            "base": {"type": "roller", "axis": "y", "position": "0 m"},
            "load": {"type": "traction", "side": "top", "region": "loaded", "normal": {"ramp": ["3.25 MPa", "5 MPa", "0 s", "100 s"]}},
            "rest": {"type": "traction", "side": "top", "region": "free", "normal": "3.25 MPa"},
            "end": {"type": "traction", "side": "right", "normal": "3.25 MPa"},
            "drain": {"type": "pressure", "side": "right", "initial": "yes"},
            "sun": {"type": "convection", "side": "top", "ambient": "12 degC", "alpha": "400 W/(m^2 K)"},
        },
        "time": {"end": "200 s"}, "stepper": {"type": "sdirk2", "adapt": "no", "dt": "20 s"},
        "output": {"times": ["200 s"]},
    }  # fmt: skip


def drawn_out(case, ring):
    """The case in space: its x and y become axes ring, ring + 1, the third is the one without change."""
    along = [ring % 3, (ring + 1) % 3, (ring + 2) % 3]  # of x, y and the new axis

    def place(xy, z):
        out = [None] * 3
        for d, v in zip(along, (*xy, z)):
            out[d] = v
        return out

    c = json.loads(json.dumps(case))
    c["grid"] = {"lower": place(c["grid"]["lower"], "0 m"), "upper": place(c["grid"]["upper"], f"{DEEP} m"), "cells": place(c["grid"]["cells"], 1)}
    if "gravity" in c:
        c["gravity"] = place(c["gravity"], "0 m/s^2")
    for r in c["region"].values():
        r["lower"], r["upper"] = place(r["lower"], "0 m"), place(r["upper"], f"{DEEP} m")
        r["particles_per_cell"] = place(r.get("particles_per_cell", [2, 2]), 2)
    for b in c["bc"].values():
        if "axis" in b:
            b["axis"] = "xyz"[along["xy".index(b["axis"])]]
        if "at" in b:
            b["at"], b["end"] = place(b["at"], "0 m"), place(b["at"], f"{DEEP} m")
        if "side" in b:
            d, end = next((d, s.index(b["side"])) for d, s in enumerate(SIDES) if b["side"] in s)
            b["side"] = SIDES[along[d]][end]
    if {"solid", "water"} & set(c.get("fields", ["solid"])):
        for name, at in (("one_face", "0 m"), ("other_face", f"{DEEP} m")):
            c["boundaries"].append(name)
            c["bc"][name] = {"type": "roller", "axis": "xyz"[along[2]], "position": at}
    c["title"] += f" in space, {'xyz'[along[2]]} without change"
    return c, along


def written(case, name):
    path = scratch() / f"{name}.yaml"
    path.write_text(json.dumps(case))
    return path


def apart(plane, space, along):
    """{variable: largest difference over the largest value}, particles paired by where they were first."""
    t, p = plane.snapshots()[-1]
    t3, s = space.snapshots()[-1]
    assert abs(t - t3) < 1e-9 * t
    start = lambda v: v["initial_position"] if "initial_position" in v else v["position"]
    order = np.lexsort(np.round(start(p), 9).T)
    key = np.round(start(s)[:, along[:2]], 9)
    layer = [np.flatnonzero(np.round(start(s)[:, along[2]], 9) == z) for z in np.unique(np.round(start(s)[:, along[2]], 9))]
    out = {}
    voigt = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
    for cells in layer:
        cells = cells[np.lexsort(key[cells].T)]
        for name, v in p.items():
            a, b = v[order], s[name][cells]
            if name in ("id", "region", "vertex", "rank"):
                continue
            if name in ("volume", "plastic_work", "plastic_heat") or name.startswith("mass"):  # per metre in the plane
                b = b / (DEEP / len(layer))
            elif name in ("stress", "stress_initial"):
                b = b[:, [voigt[along[i], along[j]] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2))]]
            elif name == "stress_hydrate":
                a, b = a, b[:, [voigt[along[i], along[j]] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1))]]
            elif name in ("deformation_gradient", "grad_v_s"):
                b = b.reshape(-1, 3, 3)[:, along[:2]][:, :, along[:2]].reshape(-1, 4)
            elif name == "mixed_T":
                b = b[:, [{(0, 1): 0, (1, 2): 1, (0, 2): 2}[tuple(sorted(along[:2]))]]]
            elif name == "rate_plastic":
                a, b = a[:, :1], b[:, :1]
            elif a.shape[1] == 2:
                b = b[:, along[:2]]
            if a.shape != b.shape:
                raise AssertionError(f"{name}: {a.shape} and {b.shape}")
            top = np.max(np.abs(a))
            if top > 0:
                out[name] = max(out.get(name, 0.0), float(np.max(np.abs(a - b)) / top))
    return out


def compare(what, case, *options, rings=(0,), ranks=1, bar=1e-10):
    """Judges the case in space by the plane; returns the runs in space."""
    plane = run(binary(), written(case, "plane"), *TIGHT, *options)
    runs = []
    for ring in rings:
        drawn, along = drawn_out(case, ring)
        space = run(SPACE, written(drawn, "space"), *TIGHT, *options, ranks=ranks)
        off = apart(plane, space, along)
        rates = {k: off.pop(k) for k in list(off) if k.startswith(("rate", "v_", "grad", "mixed"))}
        worst = max(off, key=off.get)
        name = f"{what}, {'xyz'[along[2]]} without change" + (f", {ranks} ranks" if ranks > 1 else "")
        print(f"{name}: " + ", ".join(f"{k} {v:.1e}" for k, v in sorted(off.items(), key=lambda kv: -kv[1])[:6]))
        judge("space", f"{name}: farthest from the plane, relative ({worst})", off[worst], bar)
        check("... of velocities, rates and gradients, which are differences of these", max(rates.values(), default=0.0), 100 * bar)
        runs.append(space)
    return runs


def column():
    """Terzaghi's column on 20 cells."""
    soil = {k: v for k, v in MATERIAL.items() if k in ("porosity", "solid", "water")}
    soil |= {"permeability": {"k0": "1e-15 m^2", "porosity_law": "none", "hydrate_law": "none"}, "elasticity": {"E0": "100 MPa", "nu": 0.2}}
    return {
        "title": "Terzaghi", "fields": ["solid", "water"],
        "grid": {"lower": ["0 m", "0 m"], "upper": ["1 m", "0.05 m"], "cells": [20, 1]},
        "materials": ["clay"], "mat": {"clay": soil}, "regions": ["column"],
        "region": {"column": {"lower": ["0 m", "0 m"], "upper": ["1 m", "0.05 m"], "material": "clay", "pressure": "0.1 MPa", "temperature": "20 degC"}},
        "boundaries": ["base", "bottom", "top", "load", "drain"],
        "bc": {
            "base": {"type": "roller", "axis": "x", "position": "0 m"},
            "bottom": {"type": "roller", "axis": "y", "position": "0 m"},
            "top": {"type": "roller", "axis": "y", "position": "0.05 m"},
            "load": {"type": "traction", "side": "right", "normal": {"ramp": ["0.1 MPa", "1 MPa", "0 s", "10 s"]}},
            "drain": {"type": "pressure", "side": "right", "initial": "yes"},
        },
        "time": {"end": "200 s"}, "stepper": {"type": "sdirk2", "adapt": "no", "dt": "10 s"}, "output": {"times": ["200 s"]},
    }  # fmt: skip


def mandel():
    """A quarter of Mandel's block under a plate that goes down at once and then slowly; drained at its side."""
    rock = {k: v for k, v in MATERIAL.items() if k in ("porosity", "solid", "water")}
    rock |= {"permeability": {"k0": "1e-17 m^2", "porosity_law": "none", "hydrate_law": "none"}, "elasticity": {"E0": "9 GPa", "nu": 0.2}}
    return {
        "title": "Mandel", "fields": ["solid", "water"], "inertia": "no",
        "grid": {"lower": ["0 m", "0 m"], "upper": ["1.04 m", "0.5 m"], "cells": [13, 6]},
        "materials": ["rock"], "mat": {"rock": rock}, "regions": ["block"],
        "region": {"block": {"lower": ["0 m", "0 m"], "upper": ["1 m", "0.5 m"], "material": "rock", "pressure": "1 MPa", "temperature": "4 degC"}},
        "boundaries": ["axis", "base", "plate", "side", "drain"],
        "bc": {
            "axis": {"type": "roller", "axis": "x", "position": "0 m"},
            "base": {"type": "roller", "axis": "y", "position": "0 m"},
            "plate": {"type": "plate", "side": "top", "displacement": {"table": ["0 s", "0 m", "100 s", "-1e-4 m", "2000 s", "-3e-4 m"]}},
            "side": {"type": "traction", "side": "right", "normal": "1 MPa"},
            "drain": {"type": "pressure", "side": "right", "initial": "yes"},
        },
        "time": {"end": "2000 s"}, "stepper": {"type": "sdirk2", "adapt": "no", "dt": "100 s"}, "output": {"times": ["2000 s"]},
    }  # fmt: skip


def sample(flow):
    """A corner of sand with hydrate between rough plates that yields, confined by the sea, whose pressure it also has in its pores."""
    case, sand = block(), json.loads(json.dumps(MATERIAL))
    sand["elasticity"] = {"E0": "600 MPa", "nu": 0.33}
    sand["plasticity"] = {"law": "mohr_coulomb", "flow": flow, "cohesion_max": "1 MPa", "cohesion_min": "100 kPa", "cohesion_residual": "50 kPa",
                          "friction_peak": "40 deg", "friction_residual": "30 deg", "dilation_max": "10 deg", "dilation_min": "5 deg",
                          "eta_h": 5, "eta_s": 5, "Sh_max": 0.443, "heat": 0.9}  # fmt: skip
    case |= {
        "title": "Sand that yields", "gravity": ["0 m/s^2", "0 m/s^2"], "ambient": {"pressure": "3.25 MPa"}, "mat": {"sediment": sand},
        "boundaries": ["wall", "base", "plate"],
        "bc": {
            "wall": {"type": "roller", "axis": "x", "position": "0 m"},
            "base": {"type": "fixed", "axis": "y", "position": "0 m"},
            "plate": {"type": "plate", "side": "top", "rough": "yes", "velocity": {"ramp": ["0 m/s", "-0.02 m/s", "0 s", "0.2 s"]}},
        },
        "time": {"end": "0.5 s"}, "stepper": {"type": "sdirk2", "adapt": "no", "dt": "0.05 s"}, "output": {"times": ["0.5 s"]},
    }  # fmt: skip
    return case


WITHOUT_GAS = [o for r in ("loaded", "free") for o in (f"-region_{r}_Sg", 0, f"-region_{r}_Sw", 1, f"-region_{r}_Sh", 0)] + ["-mat_sediment_kinetics_active", "no"]


def drawn_out_scenes():
    every = (0, 1, 2)
    compare("Terzaghi's column", column(), rings=every)
    compare("Mandel's block", mandel(), rings=every)
    compare("block", block(), rings=every)
    compare("block", block(), ranks=4)
    compare("block, euler", block(), "-stepper_type", "euler", "-mat_sediment_kinetics_active", "no")
    wet = block()
    wet["boundaries"].remove("sun")
    del wet["bc"]["sun"]
    compare("block, hm, quasi-static", wet, "-fields", "solid,water", "-inertia", "no", *WITHOUT_GAS)
    compare("block, half the cell's mean strain, saturations and heat carried, beds, heat of compression", block(), "-mean_strain", 0.5,
            "-mat_sediment_permeability_ratio", 0.1,
            "-mat_sediment_permeability_dip", "20 deg", "-compression_heat", "yes", rings=(0,))  # fmt: skip
    compare("block, multigrid", block(), "-reduced_pc_type", "fieldsplit", rings=(0,))
    for flow in ("menetrey_willam", "mohr_coulomb"):
        compare(f"sand that yields, {flow}", sample(flow), rings=every, bar=1e-8)


def hurried(case, dt="2e-5 s", end="0.02 s"):
    """The case in so short a time that steps without a matrix come through it; its loads are as much faster."""
    case = json.loads(json.dumps(case))
    for b in case["bc"].values():
        if "ramp" in b.get("normal", ""):
            b["normal"]["ramp"][2:] = ["0 s", end]
        if b["type"] == "plate":
            b["velocity"] = {"ramp": ["0 m/s", "-1 m/s", "0 s", end]}
    return case | {"time": {"end": end}, "output": {"times": [end]}, "stepper": {"type": "hybrid", "adapt": "no", "dt": dt}}


SETS = ("solid", "heat", "water", "water,heat", "water,gas", "water,gas,heat", "solid,heat", "solid,water", "solid,water,heat", "solid,water,gas")


def of_fields(case, fields):
    """The scene with these fields alone, and what they know of its material, state and conditions."""
    case, has = json.loads(json.dumps(case)), set(fields.split(","))
    needs = {"sun": "heat", "drain": "water"}
    case["boundaries"] = [b for b in case["boundaries"] if needs.get(b, "solid") in has]
    case["bc"] = {b: case["bc"][b] for b in case["boundaries"]}
    if "drain" in case["bc"]:
        case["bc"]["drain"] = {"type": "pressure", "side": "right", "pressure": "3 MPa"}
    sediment = case["mat"]["sediment"]
    sediment["kinetics"] = {"active": "no"}
    sediment["elasticity"] = {"E0": "90 MPa" if "solid" in has else "rigid", "nu": 0.3}
    for r in case["region"].values():
        del r["Sw"], r["Sg"], r["Sh"]
        r |= {"Sw": 0.7, "Sg": 0.3} if "gas" in has else {"Sw": 1} if "water" in has else {}
    if "heat" in has:
        case["region"]["free"] |= {"geothermal": "5 K/m", "geothermal_datum": "0.5 m"}
    return case | {"fields": fields.split(",")}


def without_matrix():
    """The same of hybrid and explicit."""
    every, quick = (0, 1, 2), hurried(block())
    compare("block, hybrid", quick, rings=every)
    for ranks in (2, 4):
        compare("block, hybrid", hurried(block(), end="0.004 s"), ranks=ranks)
    compare("block, hybrid, half the cell's mean strain, heat carried, beds, heat of compression", quick, "-mean_strain", 0.5,
            "-mat_sediment_permeability_ratio", 0.1, "-mat_sediment_permeability_dip", "20 deg",
            "-compression_heat", "yes")  # fmt: skip
    within = json.loads(json.dumps(quick))  # no surface on a line of the grid, where round-off would decide whether a node has a sliver
    for r in within["region"].values():
        r["upper"][1], r["particles_per_cell"] = "0.45 m", [4, 2]
    within["region"]["free"]["upper"][0] = "0.675 m"  # nor a node with two neighbours as full as each other (41)
    compare("block, hybrid, off the lines of the grid", within, rings=every)
    compare("block, hybrid, the paper's bare form", within, "-stepper_type", "hybrid_paper", rings=every)
    compare("block, explicit", hurried(block(), end="0.002 s"), "-stepper_type", "explicit", "-mat_sediment_permeability_k0", "1e-10 m^2")
    for fields in SETS:
        compare(f"{fields}, hybrid", hurried(of_fields(block(), fields), end="0.004 s"))
    wet = json.loads(json.dumps(quick))
    wet["boundaries"].remove("sun")
    del wet["bc"]["sun"]
    compare("block, hm, hybrid, linear functions", wet, "-fields", "solid,water", "-basis", "linear", *WITHOUT_GAS)
    for flow in ("menetrey_willam", "mohr_coulomb"):
        compare(f"sand that yields, hybrid, {flow}", hurried(sample(flow)), rings=every, bar=1e-8)
    compare("sand that yields between smooth plates, hybrid, domains that stretch", hurried(sample("menetrey_willam")), "-bc_plate_rough", "no",
            "-basis", "cpgimp", bar=1e-8)  # fmt: skip


def drilled(case):
    """With a well that yields water, gas and heat."""
    case = json.loads(json.dumps(case))
    case["boundaries"].append("well")
    case["bc"]["well"] = {"type": "well", "at": ["0.33 m", "0.24 m"], "bottom_pressure": "2.8 MPa", "radius": "2 cm"}
    return case


LAYERS = {"sand": ("3 m", "1e-12 m^2"), "silt": ("5 m", "1e-13 m^2"), "gravel": ("6 m", "1e-11 m^2")}  # their tops, from z = 0 on


def ground(names):
    """Rigid layers of wet ground, 10 m x 10 m, whose sides hold their pressure and in which a well stands."""
    fluid = {"bulk_modulus": "2.2e18 Pa", "ref_pressure": "5 MPa"}
    soil = lambda k: {"porosity": 0.3, "solid": {"density": "2650 kg/m^3"}, "water": fluid, "elasticity": {"E0": "rigid", "nu": 0.3},
                      "permeability": {"k0": k, "porosity_law": "none", "hydrate_law": "none"}}  # fmt: skip
    tops = [LAYERS[n][0] for n in names]
    return {
        "title": "Ground in layers", "fields": ["water"], "inertia": "no",
        "grid": {"lower": ["0 m"] * 3, "upper": ["10 m", "10 m", tops[-1]], "cells": [10, 10, int(tops[-1].split()[0])]},
        "materials": names, "mat": {n: soil(LAYERS[n][1]) for n in names}, "regions": names,
        "region": {n: {"lower": ["0 m", "0 m", below], "upper": ["10 m", "10 m", top], "material": n, "pressure": "10 MPa"}
                   for n, below, top in zip(names, ["0 m", *tops], tops)},
        "boundaries": ["left", "right", "bottom", "top", "well"],
        "bc": {s: {"type": "pressure", "side": s, "initial": "yes"} for s in ("left", "right", "bottom", "top")}
        | {"well": {"type": "well", "at": ["5.25 m", "4.6 m", "0 m"], "end": ["5.25 m", "4.6 m", tops[-1]], "radius": "0.1 m", "bottom_pressure": "4 MPa"}},
        "meters": ["well"], "meter": {"well": {"well": "well"}},
        "time": {"end": "1e8 s"}, "stepper": {"type": "euler", "adapt": "no", "dt": "2e7 s"},
    }  # fmt: skip


def wells():
    """Wells drawn out with their scene; one through layers, which yields what each of them would; one that is open in a part of them."""
    compare("a well, water and gas with hydrate", drilled(block()), rings=(0, 1, 2))
    compare("a well across beds", drilled(block()), "-mat_sediment_permeability_ratio", 0.3, "-mat_sediment_permeability_dip", "20 deg")
    compare("a well, hybrid", drilled(hurried(block())), rings=(0, 1, 2))
    rate = lambda case, *options, ranks=1: run(SPACE, written(case, "ground"), *options, ranks=ranks).csv("meters.csv")["well.water_kg_s"][-1]
    names = list(LAYERS)
    yields = {n: rate(ground([n])) / float(LAYERS[n][0].split()[0]) for n in names}  # kg/s a metre
    whole = 3 * yields["sand"] + 2 * yields["silt"] + yields["gravel"]
    judge("space", "a well through three layers: rate off the sum of theirs", abs(rate(ground(names)) / whole - 1), 1e-9)
    judge("space", "... on 2 ranks", abs(rate(ground(names), ranks=2) / whole - 1), 1e-9)
    part = ground(names)
    part["bc"]["well"]["at"][2], part["bc"]["well"]["end"][2] = "5.9 m", "5.2 m"
    tight = [o for n in ("sand", "silt") for o in (f"-mat_{n}_permeability_k0", "1e-19 m^2")]
    # flow from above and below comes to that of what is open, up to all that the layer has
    judge("space", "... open in 0.7 m of one of 1 m, the others tight: rate over that of 0.7 m", rate(part, *tight) / (0.7 * yields["gravel"]), (1.0, 1 / 0.7))
    part["bc"]["well"] = {"type": "well", "at": ["5.25 m", "4.6 m", "0 m"], "end": ["5.25 m", "4.6 m", "6 m"], "water_flow": "-3 kg/s"}
    judge("space", "... a rate that is given", abs(rate(part) / 3 - 1), 1e-12)


def turned(hybrid=False):
    """A body that no plane cuts out, its axes exchanged in a ring: layers that differ in permeability, so that (353) acts, or with
    hybrid (350), loaded on a part of its top and on its front, drained aside, warmer with depth."""
    case = block()
    clay = json.loads(json.dumps(MATERIAL))
    clay["permeability"]["k0"] = "1e-17 m^2"
    case |= {"materials": ["sediment", "clay"], "mat": {"sediment": MATERIAL, "clay": clay}, "title": "Turned"}
    case["region"]["free"]["material"] = "clay"
    del case["bc"]["sun"]
    case["boundaries"].remove("sun")
    for r in case["region"].values():
        r |= {"geothermal": "0.5 K/m", "geothermal_datum": "0.5 m"}
    case |= {"time": {"end": "100 s"}, "output": {"times": ["100 s"]}}
    runs, options = [], []
    if hybrid:
        case, options = hurried(case), ["-mean_strain", 0.5, "-compression_heat", "yes"]
        options += [o for m in ("sediment", "clay") for o in (f"-mat_{m}_kinetics_active", "no")]  # T bends within a particle then (395)
    for ring in (0, 1, 2):
        c, along = drawn_out(case, ring)
        c["grid"]["cells"][along[2]], c["grid"]["upper"][along[2]] = 3, "0.3 m"
        for r in c["region"].values():
            r["upper"][along[2]] = "0.2 m"
        c["boundaries"].remove("other_face")
        del c["bc"]["other_face"]
        c["boundaries"].append("front_load")
        c["bc"]["front_load"] = {"type": "traction", "side": SIDES[along[2]][1], "normal": {"ramp": ["3.25 MPa", "4 MPa", "0 s", c["time"]["end"]]}}
        v = run(SPACE, written(c, "turned"), *TIGHT, *options).snapshots()[-1][1]
        order = np.lexsort(np.round(v["initial_position"][:, along], 9).T)
        runs.append({"displacement": v["displacement"][order][:, along], **{k: v[k][order] for k in ("p_w", "p_g", "S_h", "volume", "T")}})
    spread = lambda k, v: np.max(np.abs(v - (0 if k == "displacement" else np.mean(v))))
    for n, r in enumerate(runs[1:], 1):
        worst, k = max((np.max(np.abs(r[k] - v)) / spread(k, v), k) for k, v in runs[0].items())
        by = ", by hybrid" if hybrid else ""
        judge("space", f"a body that no plane cuts out{by}, its axes exchanged {n} times: farthest, of the spread ({k})", worst, 1e-9 if hybrid else 1e-8)


def borders():
    """Sand beside clay whose border cuts cells (447): sheared and turned, against the plane; implicit steps and hybrid's."""
    case = block()
    soil = lambda k0: {k: v for k, v in MATERIAL.items() if k in ("porosity", "solid", "water")} | {"permeability": {"k0": k0, "hydrate_law": "none"}, "elasticity": {"E0": "20 MPa", "nu": 0.3}}
    case |= {"fields": ["solid", "water"], "materials": ["sand", "clay"], "mat": {"sand": soil("1e-14 m^2"), "clay": soil("1e-18 m^2")}, "title": "Border"}
    for r in case["region"].values():
        r |= {"material": "sand", "Sw": 0.8, "Sg": 0.0}
    case["region"]["free"] |= {"material": "clay", "lower": ["0.34 m", "0 m"]}
    case["region"]["loaded"]["upper"] = ["0.34 m", "0.5 m"]
    del case["bc"]["sun"]
    case["boundaries"].remove("sun")
    # the rate of (353) has a third axis in space
    compare("a border that cuts cells", case, "-exchange_ksp_max_it", 1, rings=(0, 1, 2), bar=1e-9)
    compare("a border that cuts cells, hybrid", hurried(case), rings=(0, 1, 2))


def bar():
    """Under stress along itself, in a corner of rollers, with free surfaces that cut cells (88), (160): no force."""
    case = block()
    rock = {k: v for k, v in MATERIAL.items() if k in ("porosity", "solid", "elasticity")}
    rock["plasticity"] = {"law": "mohr_coulomb", "flow": "mohr_coulomb", "cohesion_max": "1 GPa", "friction_peak": "30 deg"}  # what may yield takes (88)
    case |= {"title": "Bar under stress", "fields": ["solid"], "gravity": ["0 m/s^2"] * 3, "mat": {"sediment": rock}, "regions": ["bar"],
             "grid": {"lower": ["0 m"] * 3, "upper": ["0.8 m", "0.6 m", "0.6 m"], "cells": [4, 3, 3]}, "boundaries": list("abcd"),
             "region": {"bar": {"lower": ["0 m"] * 3, "upper": ["0.8 m", "0.46 m", "0.55 m"], "material": "sediment", "particles_per_cell": [2, 2, 2],
                                "stress": ["-1 MPa", "0 Pa", "0 Pa", "0 Pa", "0 Pa", "0 Pa"]}},
             "bc": {n: {"type": "roller", "axis": axis, "position": at} for n, axis, at in (("a", "x", "0 m"), ("b", "x", "0.8 m"), ("c", "y", "0 m"), ("d", "z", "0 m"))},
             "time": {"end": "0.02 s"}, "output": {"times": ["0.02 s"]}, "stepper": {"type": "hybrid"}}  # fmt: skip
    for what, options in (("hybrid", ()), ("sdirk2", ("-stepper_type", "sdirk2")), ("hybrid, half the mean strain", ("-mean_strain", 0.5))):
        v = run(SPACE, written(case, "bar"), "-quiet", *options).snapshots()[-1][1]["v_s"]
        judge("space", f"bar under 1 MPa whose surfaces cut cells, {what}: largest v_s after 0.02 s", np.abs(v).max(), 1e-12, unit="m/s")


def cube(vertical):
    """Wet ground of 1 m, a third axis of gravity at will, on the sea's floor: held at its base and sides, its top open to the sea."""
    up = "xyz".index(vertical)
    floor = [["0 m", "1 m"] for _ in range(3)]
    soil = {k: v for k, v in MATERIAL.items() if k in ("porosity", "solid", "water")}
    soil |= {"permeability": {"k0": "1e-14 m^2", "porosity_law": "none", "hydrate_law": "none"}, "elasticity": {"E0": "20 MPa", "nu": 0.3}}
    soil["water"] = soil["water"] | {"bulk_modulus": "incompressible"}  # else nodes, linear between each other, have not quite its profile
    case = {
        "title": f"Cube under the sea, {vertical} upright", "fields": ["solid", "water"],
        "gravity": [f"{-9.81 if d == up else 0.0} m/s^2" for d in range(3)],
        "grid": {"lower": ["0 m"] * 3, "upper": ["1.2 m" if d == up else "1 m" for d in range(3)], "cells": [6 if d == up else 5 for d in range(3)]},
        "ambient": {"pressure": "101325 Pa", "density": "1000 kg/m^3", "level": "300 m"},
        "materials": ["soil"], "mat": {"soil": soil}, "regions": ["cube"],
        "region": {"cube": {"lower": [f[0] for f in floor], "upper": [f[1] for f in floor], "material": "soil", "pressure": "101325 Pa",
                            "hydrostatic": "yes", "datum": "300 m", "stress": {"geostatic": 0.5}, "temperature": "4 degC"}},
        "boundaries": ["floor"], "bc": {"floor": {"type": "pressure", "side": SIDES[up][1], "pressure": "ambient"}},
        "time": {"end": "10 s"}, "stepper": {"type": "sdirk2", "adapt": "no", "dt": "1 s"}, "output": {"times": ["10 s"]},
    }  # fmt: skip
    for d in range(3):
        for end, at in enumerate(("0 m", "1 m")):
            if d == up and end == 1:
                continue
            case["boundaries"].append(SIDES[d][end])
            case["bc"][SIDES[d][end]] = {"type": "roller", "axis": "xyz"[d], "position": at}
    return case


def at_rest():
    """Weight, pore pressure and sea in balance in the grid's functions: nothing moves."""
    for vertical, by in [(v, "") for v in "xyz"] + [(v, ", by hybrid") for v in "xyz"]:
        case, sinks = cube(vertical), 0.5 * 700 * 9.81 / 20e6  # m, about what the weight alone would do
        if by:  # water next to incompressible, as above; the weight alone would make it fall
            case["mat"]["soil"]["water"]["bulk_modulus"], sinks = "1e13 Pa", 0.5 * 9.81 * 5e-4**2
            case = hurried(case, "5e-7 s", "5e-4 s")
        v = run(SPACE, written(case, "cube"), *TIGHT).snapshots()[-1][1]
        bar = 3e-7 if by else 1e-8  # p/K of that water
        judge("space", f"cube under the sea, {vertical} upright{by}: moves, of what its weight could do", np.max(np.abs(v["displacement"])) / sinks, bar)
        vertical_stress = v["stress"][:, "xyz".index(vertical)]
        across = v["stress"][:, [k for k in range(3) if k != "xyz".index(vertical)]]
        check("... horizontal over vertical stress, off K0", np.max(np.abs(across / vertical_stress[:, None] - 0.5)), 1e-6)


def newmark(x, z, deep):
    """Vertical stress over the load at (x, z) and `deep` (m) below a square of half width 1 m on a half space: four corners of rectangles."""
    found = 0.0
    for a in (1 - x, 1 + x):
        for b in (1 - z, 1 + z):
            m, n = a / deep, b / deep
            root = np.sqrt(m * m + n * n + 1)
            found = found + (np.arctan(m * n / root) + m * n / root * (1 / (m * m + 1) + 1 / (n * n + 1))) / (2 * np.pi)
    return found


DEEP_GROUND = 16  # m


def footing(h):
    """A quarter of a flexible square footing of 2 m on elastic ground, y upright, on cells of h (m) that grow away from it."""
    soil = {"porosity": 0.4, "solid": {"density": "2600 kg/m^3"}, "elasticity": {"E0": "20 MPa", "nu": 0.3}}
    side, deep = [0, h, 1, h, DEEP_GROUND, 4], [0, 4, DEEP_GROUND - 2, h, DEEP_GROUND, h]
    metres = lambda v: {"table": [f"{x} m" for x in v]}
    box = lambda lower, upper: {"lower": [f"{x} m" for x in lower], "upper": [f"{x} m" for x in upper], "material": "soil"}
    return {
        "title": "Square footing", "fields": ["solid"], "inertia": "no",
        "grid": {"lower": ["0 m"] * 3, "upper": [f"{DEEP_GROUND} m"] * 3, "spacing": {"x": metres(side), "y": metres(deep), "z": metres(side)}},
        "materials": ["soil"], "mat": {"soil": soil}, "regions": ["ground", "pad"],
        "region": {"ground": box([0] * 3, [DEEP_GROUND] * 3), "pad": box([0, DEEP_GROUND - 1, 0], [1, DEEP_GROUND, 1])},
        "boundaries": ["left", "back", "right", "front", "base", "load"],
        "bc": {
            "left": {"type": "roller", "axis": "x", "position": "0 m"}, "right": {"type": "roller", "axis": "x", "position": f"{DEEP_GROUND} m"},
            "back": {"type": "roller", "axis": "z", "position": "0 m"}, "front": {"type": "roller", "axis": "z", "position": f"{DEEP_GROUND} m"},
            "base": {"type": "fixed", "axis": "y", "position": "0 m"},
            "load": {"type": "traction", "side": "top", "region": "pad", "normal": "20 kPa"},
        },
        "time": {"end": "1 s"}, "stepper": {"type": "euler", "adapt": "no", "dt": "1 s"}, "output": {"times": ["1 s"]},
    }  # fmt: skip


def under_a_footing():
    """Stress near the axis, between half a metre and two below the load, against Newmark's integral of Boussinesq's solution."""
    rows, errors = [], {}
    for h in (0.5, 0.25):
        case = run(SPACE, written(footing(h), "footing"))
        v = case.snapshot(1.0)
        x = v["initial_position"]
        below = DEEP_GROUND - x[:, 1]
        at = (x[:, 0] < 0.5) & (x[:, 2] < 0.5) & (below > 0.5) & (below < 2)
        off = -v["stress"][at, 1] / 20e3 - newmark(x[at, 0], x[at, 2], below[at])
        errors[h] = np.sqrt(np.mean(off**2))
        rows.append((h, len(x), at.sum(), off.min(), off.max(), errors[h]))
    table(("h (m)", "particles", "of them near the axis", "least error", "largest, of the load", "rms"), rows)
    judge("space", "square footing, h = 0.25 m: stress below its middle, rms error of the load", errors[0.25], 0.03)
    check("... over that on cells twice as large", errors[0.25] / errors[0.5], 0.6)


def begun_again():
    """A run that stops and goes on from its checkpoint, on two ranks then, ends as the one that does not stop."""
    for what, scene, middle, bar in (("block", block(), "100 s", 0.0), ("block by hybrid", hurried(block()), "0.01 s", 1e-10)):
        halved(what, written(drawn_out(scene, 0)[0], "restart"), middle, bar)


def halved(what, case, middle, bar):
    """A burst of hybrid ends at the checkpoint, which rounds the times of its steps."""
    whole = run(SPACE, case, *TIGHT).snapshots()[-1][1]
    half = run(SPACE, case, *TIGHT, "-time_end", middle, "-output_times", middle)
    for ranks in (1, 2):
        rest = run(SPACE, case, *TIGHT, "-restart", half.out / "checkpoint.h5", ranks=ranks).snapshots()[-1][1]
        off = max(np.max(np.abs(rest[k] - v)) / np.max(np.abs(v)) for k, v in whole.items() if np.any(v) and k in ("p", "T", "S_h", "displacement", "stress"))
        judge("space", f"{what}, begun again after half its time on {ranks} rank{'s' * (ranks > 1)}: farthest from the whole run", off, 1e-10 if ranks > 1 else bar)


def refused():
    """What is of the plane alone is refused by name, and a case of the plane by the program of space; a case of space goes to it."""
    plane, (space, _) = block(), drawn_out(block(), 0)
    sheared, askew, beside = (json.loads(json.dumps(c)) for c in (space, drawn_out(drilled(block()), 0)[0], drawn_out(drilled(block()), 0)[0]))
    sheared["bc"]["load"]["shear"] = "1 kPa"
    askew["bc"]["well"]["end"] = ["0.34 m", "0.24 m", "0.1 m"]
    beside["bc"]["well"]["end"][2] = "0.12 m"
    for what, program, case, options, words in (
        ("axisymmetry", SPACE, space, ["-geometry", "axisymmetric"], "geometry"),
        ("shear of a traction", SPACE, sheared, [], "bc_load_shear"),
        ("a well that runs along no axis", SPACE, askew, [], "bc_well_end"),
        ("a well that is open beyond the body", SPACE, beside, [], "bc_well_at"),
        ("part of a side", SPACE, space, ["-bc_load_to", "0.2 m"], "bc_load_to"),
        ("a case of the plane", SPACE, plane, [], "clathra3d"),
    ):
        done = launch(program, written(case, "refused"), *options, out=scratch() / "out")
        check(f"refused: {what}: exit code 2 and said by name", float(done.returncode == 2 and words in done.stdout), (1.0, 1.0))
    case = written(space, "handed-over")
    said = [launch(program, case, "-case_check") for program in (binary(), SPACE)]
    check("clathra hands a case of space over to clathra3d", float(said[0].returncode == said[1].returncode == 0 and said[0].stdout.splitlines()[:3] == said[1].stdout.splitlines()[:3]), (1.0, 1.0))
    alone = scratch() / "clathra"
    shutil.copy(binary(), alone)
    done = launch(alone, case, "-case_check")
    check("... and without it says whose it is", float(done.returncode == 2 and "three axes are clathra3d's" in done.stdout), (1.0, 1.0))


def main():
    drawn_out_scenes()
    without_matrix()
    wells()
    borders()
    bar()
    turned()
    turned(hybrid=True)
    at_rest()
    under_a_footing()
    begun_again()
    refused()
    finish()


if __name__ == "__main__":
    main()
