#!/usr/bin/env python3
"""Collapse loads of rigid strips: Prandtl's, and Nc and Nq of associated ground.

Collapse loads of rigid strips (cases/strip.yaml): Prandtl's, and Nc and Nq of associated weightless ground at 20 deg, with
hybrid and implicit, rough and smooth; Cox's circle on a coarse grid; what the locking of ground that
dilates does without mean strain.

The plate pushes the node at its edge, and the ground follows over the next cell: a load too large by h/2 of the half-width, of
first order.  Nc and Nq are within 3 % at h = a/8, Prandtl's strip is at a/16, and here within twice that at a/8; the circle is within
6 % at R/8, and here within 8/6 of that at R/6.  Those finer grids, of many minutes, are tests/studies/plasticity.py's (docs/studies/plasticity.md).
"""
import numpy as np

from _footings import STRIP, circle, collapse, exact, order, saturated, strip, strip_run
from common import check, check_true, finish, judge, table

rows = []


def measured(name, cells, rough, *more, implicit=False, what="", case=STRIP):
    """Collapse load at a/cells."""
    u, load = strip(name, cells, rough, *more, implicit=implicit, case=case)
    found, growth = collapse(u, load)
    rows.append([name, "rough" if rough else "smooth", "implicit" if implicit else "hybrid", f"a/{cells}", found, 100 * (found / exact(name) - 1), 100 * growth, what])
    return found, growth


def family(name, rough, implicit, grids, finest, extrapolated, *more):
    """Loads that fall towards the exact one, on grids of a/cells."""
    found = [measured(name, n, rough, *more, implicit=implicit) for n in grids]
    load, h = np.array([f[0] for f in found]), 1 / np.array(grids)
    title = f"{name}, {'rough' if rough else 'smooth'}, {'implicit' if implicit else 'hybrid'}"
    if finest:
        judge("strength", f"{title}: collapse load at h = a/{grids[-1]}", load[-1] / exact(name) - 1, finest, 0.01, "%")
    if len(grids) > 1:
        check(f"{title}: order in h", order(h, load, exact(name))[-1], (0.7, 1.4))
        judge("strength", f"{title}: collapse load, h to 0", abs((2 * load[-1] - load[-2]) / exact(name) - 1), extrapolated, 0.01, "%")
    check(f"{title}: growth over the last fifth", max(abs(f[1]) for f in found), 0.02)
    return load


strong = family("Prandtl", True, True, (4, 8), (0.0, 0.06), 0.015)
free = family("Prandtl", True, False, (4, 8), None, 0.015)
check("Prandtl: hybrid against implicit", np.abs(free / strong - 1).max(), 0.01)
wet = [measured("Prandtl", 4, True, implicit=i, what="undrained", case=saturated())[0] for i in (True, False)]
check("Prandtl on saturated ground, undrained: the same load, both integrators", np.abs(wet / np.array([strong[0], free[0]]) - 1).max(), 1e-3)
last = strip_run("Prandtl", 4, True, case=saturated()).snapshots()
volume = last[-1][1]["volume"] / (last[0][1]["volume"] * np.exp(last[-1][1]["log_J"])) - 1
check("... hybrid: volume of particles against their strain", np.abs(volume).max(), 1e-9)
family("Prandtl", False, True, (8,), (0.0, 0.06), None)
for name in ("Nc, 20 deg", "Nq, 20 deg"):
    free = family(name, False, False, (4, 8), (0.0, 0.03), 0.015)
    check(f"{name}: implicit against hybrid, a/4", measured(name, 4, False, implicit=True)[0] / free[0] - 1, (-0.04, 0.04))
BESIDE = ("-ambient_pressure", "0 Pa", "-boundaries", "base,left,right,plate,beside", "-bc_beside_type", "traction", "-bc_beside_side", "top", "-bc_beside_from", "1 m", "-bc_beside_normal", "1 MPa")
m = strip_run("Nq, 20 deg", 4, False, *BESIDE).csv("meters.csv")
by_traction = collapse(-m["plate.position_m"], m["plate.force_N"] / 1e6)[0]
check("Nq, 20 deg, hybrid: surcharge by a traction on a surface that rises from the grid's line, against ambient pressure", by_traction / measured("Nq, 20 deg", 4, False)[0] - 1, (-1e-3, 1e-3))
load, growth = measured("Prandtl", 8, True, "-mean_strain", "0", implicit=True, what="no mean strain")
check("Prandtl without mean strain: over the exact load at a/8", load / exact("Prandtl") - 1, (0.0, 0.1))
check("... growth over the last fifth", growth, 0.02)
load, growth = measured("Nq, 30 deg", 4, False)
judge("strength", "Nq, 30 deg, smooth, hybrid: collapse load at h = a/4", load / exact("Nq, 30 deg") - 1, (0.0, 0.03), 0.01, "%")
load, growth = measured("Nq, 30 deg", 4, False, "-mean_strain", "0", what="locks")
check("... without mean strain: over the exact load", load / exact("Nq, 30 deg") - 1, (0.15, 0.3))
# sdirk2: the same load, with a quarter of euler's iterations
found = {(n, s): circle(n, s, end=end, kind="sdirk2") for n, s, end in ((4, 0.99, 0.85), (6, 0.99, 0.85), (4, 0, 1.0))}
for (n, s), (load, growth) in found.items():
    rows.append(["Cox's circle", "smooth", "implicit", f"R/{n}", 141 * load, 100 * (load - 1), 100 * growth, "" if s else "locks"])
coarse, fine = (found[n, 0.99] for n in (4, 6))
judge("strength", "Cox's circle on heavy ground, 30 deg, h = R/6", fine[0] - 1, (0.0, 0.08), 0.01, "%")
check("... order in h", order([1 / 4, 1 / 6], [coarse[0], fine[0]], 1)[0], (0.8, 1.5))
check("... growth over the last fifth", max(coarse[1], fine[1]), 0.01)
check("... without mean strain: over the exact load", found[4, 0][0] - 1, (0.4, 1.0))
table(["case", "plate", "integrator", "h", "load (MPa)", "error (%)", "growth (%)", ""], rows)
finish()
