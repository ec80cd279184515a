#!/usr/bin/env python3
"""Columns of dry sand that collapse in the plane, against experiments; a block that is dropped.

Columns of dry sand in the plane, let go on a rough floor, and an elastic block dropped on a smooth one: a heap keeps its volume, comes
to rest and runs as far as those of Lube, Huppert, Sparks and Freundt (2005), the high one a fifth farther; what the floor takes of the block's energy does not hang on the step.
"""
import json

import numpy as np

from common import Run, binary, check, finish, judge, run, scratch, table

EXPERIMENTS = {1: 1.2, 3: 3.95}  # (final - initial width) over initial width
IMPLICIT = {"stepper": {"type": "sdirk2", "dt": "0.002 s", "tol": 1e-2}, "stabilisation": {"ghost_penalty": 1e-3}}
HYBRID = {"stepper": {"type": "hybrid"}}
MOVES = 0.1  # m/s


def column(high, cells, end, how):
    """A column 1 m wide (half of one of 2 m) and so many times as high, on so many cells a metre."""
    h, far = 1 / cells, {1: 3.2, 3: 8}[high]
    path = scratch() / "column.yaml"
    path.write_text(json.dumps({
        "title": f"column of sand, {high} times as high as wide", "fields": ["solid"], "gravity": ["0 m/s^2", "-9.81 m/s^2"],
        "grid": {"lower": ["0 m", "0 m"], "upper": [f"{far} m", f"{high + 2 * h} m"], "cells": [round(far * cells), high * cells + 2]},
        "materials": ["sand"], "regions": ["column"], "boundaries": ["left", "floor"],
        "mat": {"sand": {"porosity": 0.4, "solid": {"density": "2650 kg/m^3"}, "elasticity": {"E0": "10 MPa", "nu": 0.3},
                         "plasticity": {"law": "mohr_coulomb", "flow": "mohr_coulomb", "cohesion_max": "0 Pa", "friction_peak": "31 deg", "dilation_max": "0 deg"}}},
        "region": {"column": {"lower": ["0 m", "0 m"], "upper": ["1 m", f"{high} m"], "material": "sand", "stress": {"geostatic": 0.5}}},
        "bc": {"left": {"type": "roller", "axis": "x", "position": "0 m"}, "floor": {"type": "fixed", "axis": "y", "position": "0 m"}},
        "time": {"end": f"{end} s"}, "output": {"times": [f"{end} s"]}, **how}))  # fmt: skip
    v = run(binary(), path, "-quiet").snapshots()[-1][1]
    x = np.sort(v["position"][:, 0])
    return x[-max(5, len(x) // 200)] - 1, v["volume"].sum() / high, (np.linalg.norm(v["v_s"], axis=1) > MOVES).mean()


def dropped(*options):
    """A block of 1 m with E = 20 MPa that falls 2 m: largest height of its middle after it, m, share of the fall's energy that is gone then."""
    path = scratch() / "block.yaml"
    path.write_text(json.dumps({
        "title": "a block dropped on a floor", "fields": ["solid"], "gravity": ["0 m/s^2", "-10 m/s^2"],
        "grid": {"lower": ["-1 m", "0 m"], "upper": ["2 m", "4 m"], "cells": [30, 40]},
        "materials": ["soft"], "regions": ["block"], "boundaries": ["floor"],
        "mat": {"soft": {"porosity": 0.3, "solid": {"density": "2000 kg/m^3"}, "elasticity": {"E0": "20 MPa", "nu": 0.3}}},
        "region": {"block": {"lower": ["0 m", "2 m"], "upper": ["1 m", "3 m"], "material": "soft"}},
        "bc": {"floor": {"type": "roller", "axis": "y", "position": "0 m"}},
        "time": {"end": "1.4 s"}, "output": {"times": ["1.4 s"], "probe_every": "0.01 s"}, **HYBRID,
        "probes": ["middle"], "probe": {"middle": {"at": ["0.5 m", "2.5 m"]}}}))  # fmt: skip
    done = run(binary(), path, "-quiet", *options)
    b, u = done.balance, done.probe("middle")["u_y_m"]
    gone = b["gravity_work_J"][-1] - b["kinetic_energy_J"][-1] - b["elastic_energy_J"][-1]
    return 2 + u[np.argmin(u):].max(), gone / (1400 * 10 * 2)


rows = []
for high, cells, end, name, how in ((1, 10, 2, "hybrid", HYBRID), (1, 10, 2, "sdirk2", IMPLICIT), (3, 10, 3, "hybrid", HYBRID)):
    out, volume, moving = column(high, cells, end, how)
    rows.append([high, cells, name, out, EXPERIMENTS[high], volume, moving])
    of = f"column of dry sand, {high} times as high as wide, {name}"
    judge("strength", f"{of}: run-out over that of experiments", out / EXPERIMENTS[high], (0.85, 1.15 if high == 1 else 1.25))
    judge("strength", f"{of}: volume of the heap over the column's", volume, (0.95, 1.05))
    judge("strength", f"{of}: share above 0.1 m/s at the end", moving, 0.01)
check("hybrid against sdirk2: run-out", abs(rows[1][3] / rows[0][3] - 1), 0.05)
blocks = [(cfl, *dropped("-stepper_cfl", cfl)) for cfl in ("0.8", "0.2")]
(_, high, gone), (_, fine, less) = blocks
judge("strength", "elastic block dropped 2 m: rebound with a quarter of the step", abs(high / fine - 1), 0.05)
judge("strength", "elastic block dropped 2 m: energy gone by the rebound, with a quarter of the step", less, 0.2)
check("... beyond that with the whole step", abs(gone - less), 0.05)
paper = dropped("-stepper_cfl", "0.2", "-stepper_type", "hybrid_paper")[1]
judge("strength", "elastic block dropped 2 m, hybrid_paper, whose nodes do not know the gradient of motion: energy gone over that by hybrid", paper / less, (1.5, 4))
table(["height / width", "cells / width", "integrator", "run-out / width", "experiments", "volume", "above 0.1 m/s"], rows)
table(["stepper_cfl", "rebound (m)", "energy gone"], blocks)
finish()
