#!/usr/bin/env python3
"""Collapse of a cylinder of sand in space: the runout of experiments.

Collapse of a cylinder of sand in space (cases/collapse_3d) by hybrid: the runout of experiments with cylinders of sand, salt, sugar and
rice, and the heap that sdirk2 makes of it in the plane, about its axis.
"""
import json
import sys

import numpy as np

from common import ROOT, binary, check, finish, judge, program_of, run, scratch, table

CASE = ROOT / "cases" / "collapse_3d"
SPACE = program_of(CASE)
SHARES = (0.25, 0.5, 0.75, 0.95)


def about_its_axis():
    """The same cylinder, sand and cells with geometry: axisymmetric, by implicit steps."""
    case = {
        "title": "Cylinder about its axis", "geometry": "axisymmetric", "fields": ["solid"], "gravity": ["0 m/s^2", "-9.81 m/s^2"],
        "grid": {"lower": ["0 m", "0 m"], "upper": ["3 m", "1.25 m"], "cells": [24, 10]},
        "materials": ["sand"], "regions": ["cylinder"], "boundaries": ["axis", "floor"],
        "mat": {"sand": {"porosity": 0.4, "solid": {"density": "2650 kg/m^3"}, "elasticity": {"E0": "5 MPa", "nu": 0.3},
                         "plasticity": {"law": "mohr_coulomb", "flow": "mohr_coulomb", "cohesion_max": "0 Pa", "friction_peak": "31 deg", "dilation_max": "1 deg"}}},
        "region": {"cylinder": {"lower": ["0 m", "0 m"], "upper": ["1 m", "1 m"], "material": "sand", "stress": {"geostatic": 0.5}}},
        "bc": {"axis": {"type": "roller", "axis": "x", "position": "0 m"}, "floor": {"type": "fixed", "axis": "y", "position": "0 m"}},
        "time": {"end": "1.6 s"}, "output": {"times": ["1.6 s"]},
        "stepper": {"type": "sdirk2", "dt": "0.002 s", "tol": 1e-3}, "stabilisation": {"ghost_penalty": 1e-3},
    }  # fmt: skip
    path = scratch() / "axis.yaml"
    path.write_text(json.dumps(case))
    return run(binary(), path)


def radii(v):
    x = v["position"]
    return x[:, 0] if x.shape[1] == 2 else np.hypot(x[:, 0], x[:, 1])


def within(v):
    """Radii within which these shares of the mass lie, m."""
    order = radii(v).argsort()
    mass = v["mass_solid"].ravel()[order].cumsum()
    return np.interp(SHARES, mass / mass[-1], radii(v)[order])


def experiments(high):
    """Lube, Huppert, Sparks and Hallworth (2004): runout over the radius of cylinders less than 1.7 times as high as that."""
    return 1.24 * high


def main():
    whole = run(SPACE, CASE)
    v = whole.snapshots()[-1][1]
    runout = np.sort(radii(v))[-5] - 1.0  # the farthest few may have left the heap
    judge("strength", "cylinder of sand, as high as its radius: runout over that of experiments", runout / experiments(1.0), (0.8, 1.2))
    angle = np.degrees(np.arctan2(v["position"][:, 1], v["position"][:, 0]))
    far = [np.sort(radii(v)[(angle >= a) & (angle < a + 30)])[-3] for a in (0, 30, 60)]
    judge("strength", "cylinder of sand: front in three directions, spread over the radius it has", np.ptp(far) / np.mean(far), 0.02)
    left = abs(whole.balance["energy_remainder_J"][-1] / whole.balance["gravity_work_J"][-1])
    judge("strength", "cylinder of sand: what the balance of energy leaves of gravity's work", left, 0.01)

    plane = about_its_axis().snapshots()[-1][1]
    here, there = within(v), within(plane)
    table(["share of the mass", "within (m), in space by hybrid", "about the axis by sdirk2"], list(zip(SHARES, here, there)))
    judge("strength", "cylinder of sand in space by hybrid: radii of shares of its mass against sdirk2 about the axis", np.max(np.abs(here / there - 1)), 0.03)
    top = lambda v, up: v["position"][radii(v) < 0.15, up].max()  # a particle is 1/32 m high
    check("... height at the axis", abs(top(v, 2) / top(plane, 1) - 1), 0.03)

    slippery = run(SPACE, CASE, "-mat_sand_plasticity_friction_peak", "15 deg", "-grid_upper", "4 m,4 m,1.25 m", "-grid_cells", "32,32,10").snapshots()[-1][1]
    check("with a wrong friction of 15 deg the runout is not that of experiments", (np.sort(radii(slippery))[-5] - 1.0) / experiments(1.0), (1.3, 3.0))

    short = ("-time_end", "0.3 s", "-output_every", "0.3 s")
    place = lambda r: (lambda v: v["position"][v["id"].ravel().argsort()])(r.snapshots()[-1][1])
    one = place(run(SPACE, CASE, *short))
    for ranks in (2, 4):
        judge("strength", f"cylinder of sand on {ranks} ranks: places, m", np.max(np.abs(place(run(SPACE, CASE, *short, ranks=ranks)) - one)), 1e-9)
    finish()


if __name__ == "__main__":
    sys.exit(main())
