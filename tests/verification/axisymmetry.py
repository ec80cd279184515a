#!/usr/bin/env python3
"""Section 4.2: geometry about an axis, against exact solutions and against the plane far from the axis.

A particle's pressure, temperature and stress belong to the centroid of its ring, its displacement to the middle of its domain.
"""
from pathlib import Path

import numpy as np

import exact_flow
import exact_heat
import exact_solid
from common import Run, check, check_true, finish, judge, order, scratch, table
from field_sets import TIGHT, difference, scene, select

CASES = Path(__file__).parent / "cases"
BASES = ("cpgimp", "ugimp", "linear")


def rings(v):
    """Radii (m) of the particles' middles and of their rings' centroids, as they were at the start."""
    r = v["position"][:, 0] - (v["displacement"][:, 0] if "displacement" in v else 0.0)
    l = v["half_length"][:, 0]
    return r, r + l**2 / (3 * r)


# ---------------------------------------------------------------------------------------- solids
def thick_cylinder():
    a, b, p_in, p_out, E, nu = 0.3, 0.8, 200.0, 50.0, 2e8, 0.3
    rows = []
    for basis in BASES:
        for place, upper in (("on the grid's lines", 1.0), ("across cells", 1.03)):
            cells, off = (10, 20, 40), []
            if basis == "linear" and place == "across cells":
                continue  # a linear particle's face acts at the particle
            for n in cells:
                run = Run.of_case(CASES / "cylinder_solid.yaml", "-quiet", "-basis", basis, "-grid_cells", f"{n},1",
                                  "-grid_upper", f"{upper} m,0.1 m")  # fmt: skip
                v = run.snapshot(1.0)
                r, _ = rings(v)
                u, rr, tt, zz = exact_solid.thick_cylinder(r, a, b, p_in, p_out, E, nu)
                stress = np.array([v["stress"][:, 0] - rr, v["stress"][:, 2] - tt, v["stress"][:, 1] - zz])
                rms = lambda x: np.sqrt(np.mean(np.square(x)))
                off.append((rms(v["displacement"][:, 0] - u) / np.max(np.abs(u)), rms(stress) / p_in))
            off, h = np.array(off), [upper / n for n in cells]
            for k, what in enumerate(("u_r", "stress")):
                rows.append((basis, place, what, *off[:, k], *order(h, off[:, k])))
            if basis != "linear":
                judge("4.2", f"thick cylinder, {basis}, {place}, 40 cells: u_r, rms over its largest", off[-1, 0], 2e-3)
                judge("4.2", f"thick cylinder, {basis}, {place}, 40 cells: stress, rms over the load", off[-1, 1], 2e-2)
                judge("4.2", f"thick cylinder, {basis}, {place}: order of u_r in h", order(h, off[:, 0])[-1], (1.5, 3.0))
    table(("basis", "surfaces", "what", "h", "h/2", "h/4", "order", "order"), rows)


def expansion():
    """u_r = c r under the outer traction that belongs to it, in ten steps, c = 0.2; exact for cpGIMP, whose domains stay the
    particles' volumes."""
    c, E, nu = 0.2, 2e8, 0.3
    e = np.log(1 + c)
    G, lame = E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu))
    stress = np.array([2 * (G + lame) * e, 2 * lame * e, 2 * (G + lame) * e])
    for place, upper in (("on the grid's lines", 1.0), ("across cells", 1.03)):
        run = Run.of_case(CASES / "cylinder_solid.yaml", "-quiet", "-region_ring_lower", "0 m,0 m", "-region_ring_upper", "0.5 m,0.1 m",
                          "-grid_upper", f"{upper} m,0.1 m", "-stepper_dt", "0.1 s", "-newton_tol_residual", 1e-12,
                          "-newton_tol_update", 1e-10, "-bc_outside_normal_ramp", f"0 Pa,{-stress[0]!r} Pa,0 s,1 s")  # fmt: skip
        v = run.snapshot(1.0)
        r, _ = rings(v)
        u = np.max(np.abs(v["displacement"][:, 0] - c * r)) / (0.5 * c)
        s = np.max(np.abs(v["stress"][:, :3] - stress)) / stress[0]
        J = np.max(np.abs(np.exp(v["log_J"][:, 0]) / (1 + c) ** 2 - 1))
        for what, value in (("u_r = c r", u), ("stress", s), ("J = (1 + c)^2", J)):
            judge("4.2", f"uniform expansion by {c:g} in ten steps, {place}: {what}, largest relative error", value, 1e-9)


# ---------------------------------------------------------------------------------------- flow
def consolidation():
    R, P, p0 = 0.5, 1e3, 1e6
    exact = exact_flow.PoroCylinder(R, P, 9e7, 0.2, 0.3 / 2.2e9, 1e-12)
    times = np.array([0.02, 0.05, 0.1, 0.3]) * R**2 / exact.c
    rows, start = [], exact.initial_pressure()
    for basis in BASES:
        cells, off = (10, 20, 40) if basis == "cpgimp" else (20,), []
        for n in cells:
            upper = 0.53 if basis != "linear" else 0.5
            run = Run.of_case(CASES / "cylinder_drained.yaml", "-quiet", "-basis", basis, "-grid_cells", f"{n},1", "-grid_upper",
                              f"{upper} m,0.1 m", "-output_times", ",".join(f"{t!r} s" for t in times), "-time_end", f"{times[-1]!r} s")  # fmt: skip
            found = []
            for t in times:
                v = run.snapshot(t)
                r, ring = rings(v)
                p, u = exact.pressure(ring, t), exact.displacement(r, t)
                rms = lambda x: np.sqrt(np.mean(np.square(x)))
                found.append((rms(v["p_w"][:, 0] - p0 - p) / start, rms(v["displacement"][:, 0] - u) / np.max(np.abs(u))))
            off.append(np.max(found, axis=0))
            rows.append((basis, n, *off[-1], len(run.balance["time_s"])))
            worst = np.max(np.abs(run.balance["water_error"]))
            check(f"radial consolidation, {basis}, {n} cells: water balance", worst, 1e-10)
            if n == 40:
                peak = np.max(run.probe("axis")["p_w_Pa"] - p0) / start - 1
                t = np.linspace(0.001, 0.2, 400) * R**2 / exact.c
                judge("4.2", "radial consolidation: overshoot of p on the axis over the exact one",
                      peak / (np.max(exact.pressure(0.0, t)) / start - 1), (0.9, 1.1))  # fmt: skip
        if basis != "linear":
            judge("4.2", f"radial consolidation, {basis}, {cells[-1]} cells: p, rms over p(0+)", off[-1][0], 0.02, 0.01, "%")
            judge("4.2", f"radial consolidation, {basis}, {cells[-1]} cells: u_r, rms over its largest", off[-1][1], 0.02, 0.01, "%")
        if len(cells) > 1:
            check("radial consolidation: p, error of 40 over 10 cells", off[-1][0] / off[0][0], 0.5)
            check("radial consolidation: u, error of 40 over 10 cells", off[-1][1] / off[0][1], 0.5)
    table(("basis", "cells", "p, rms / p(0+)", "u, rms", "steps"), rows)


# ---------------------------------------------------------------------------------------- heat
def heat():
    R, C, k, alpha, T0, Ta = 0.4, 0.8 * 2500 * 800, 0.8 * 2.5, 25.0, 10.0, 3.0
    kappa = k / C
    exact = {
        "line": lambda r, t: exact_heat.cylinder(r, t, R, kappa, T0, Ta),
        "face": lambda r, t: exact_heat.cylinder(r, t, R, kappa, T0, Ta),
        "air": lambda r, t: exact_heat.cylinder_convective(r, t, R, kappa, k, alpha, T0, Ta),
    }
    names = {"line": "T on a grid line", "face": "T on the face", "air": "convection"}
    rows = []
    for which, basis in (("line", "cpgimp"), ("face", "cpgimp"), ("air", "cpgimp"), ("air", "ugimp"), ("line", "linear")):
        cells, off = (8, 16, 32), []
        for n in cells:
            run = Run.of_case(select(CASES / "cylinder_heat.yaml", which), "-quiet", "-basis", basis, "-grid_cells", f"{n},1",
                              "-stepper_dt", 800.0 / (n / 8))  # fmt: skip
            found = []
            for t in (4000.0, 12000.0, 40000.0):
                v = run.snapshot(t)
                _, ring = rings(v) if basis != "linear" else (0, v["position"][:, 0])
                found.append(np.sqrt(np.mean((v["T"][:, 0] - exact[which](ring, t)) ** 2)) / (T0 - Ta))
            off.append(np.max(found))
            check(f"heat, {names[which]}, {basis}, {n} cells: heat balance (K)", np.max(np.abs(run.balance["heat_error"])),
                  np.inf if which == "line" else 1e-8)  # fmt: skip
        h = [R / n for n in cells]
        rows.append((names[which], basis, *off, *order(h, off)))
        judge("4.2", f"cooling cylinder, {names[which]}, {basis}, 32 cells: T, rms over T0 - Ta", off[-1], 0.01, 0.01, "%")
        check(f"cooling cylinder, {names[which]}, {basis}: order in h", order(h, off)[-1], (0.9, 3.0))
    table(("surface", "basis", "8 cells", "16", "32", "order", "order"), rows)


# ---------------------------------------------------------------------------------------- conservation, rest, ranks, far away
def conservation():
    for basis in BASES[:2]:  # the linear basis does not hold this load on a side that cuts cells, in the plane neither
        for name, keep in (("closed", ("warmed",)), ("draining", ("drained", "warmed"))):
            for inertia in ("yes", "no") if basis == "cpgimp" else ("yes",):
                run = Run.of_case(scene("thmc", *keep), "-quiet", "-geometry", "axisymmetric", "-basis", basis, "-inertia", inertia,
                                  "-mat_sand_kinetics_active", "yes")  # fmt: skip
                b = run.balance
                worst = max(np.max(np.abs(b[f"{w}_error"])) for w in ("water", "methane"))
                judge("4.2", f"{name} reacting body about an axis, {basis}, inertia {inertia}: water and methane, any step", worst, 1e-10)
                check(f"{name}: hydrate lost", 1 - b["hydrate_kg"][-1] / b["hydrate_kg"][0], (1e-3, 1.0))
                gone = np.max(np.abs(b["water_out_kg"])) / b["water_kg"][0]
                check_true(f"{name}: water goes through the drain", gone > 1e-4 if keep[0] == "drained" else gone == 0, f"{gone:.2g} of it")


def rest():
    speed = 1e-13 / 1e-3 * 1e6 / 0.1  # m/s, as in rest.py
    for cells in ("1,10", "3,10"):
        run = Run.of_case(CASES / "rest_hydrostatic.yaml", "-quiet", "-geometry", "axisymmetric", "-grid_cells", cells,
                          "-newton_tol_residual", 1e-12, "-newton_tol_update", 1e-10, "-snes_max_it", 30)  # fmt: skip
        last = run.snapshot(1000.0)
        for v in ("v_s", "v_w"):
            judge("4.2", f"hydrostatic column about an axis, {cells.replace(',', ' x ')} cells: {v} over {speed:g} m/s after 1000 s",
                  np.max(np.abs(last[v])) / speed, 1e-12)  # fmt: skip


def ranks():
    one, two = (Run.of_case(scene("thmc", "drained", "warmed"), *TIGHT, "-geometry", "axisymmetric", "-mat_sand_kinetics_active",
                            "yes", ranks=n) for n in (1, 2))  # fmt: skip
    value, where, names = difference(one, two)
    judge("4.2", f"reacting body about an axis, 2 ranks against 1: {names} variables ({where})", value, 1e-9)


def far():
    """The scene of field_sets.py moved to r0: the plane's solution up to size/r0."""
    options = (*TIGHT, "-mat_sand_kinetics_active", "yes")
    plane = Run.of_case(scene("thmc", "drained", "warmed"), *options).snapshot(100.0)
    compared = ("displacement", "stress", "p_w", "p_g", "T", "S_h", "porosity", "log_J")
    off, rows = [], []
    for r0 in (5e2, 5e3):
        moved = [f"-bc_left_position {r0!r} m", f"-bc_load_to {r0 + 0.2!r} m", f"-grid_lower {r0!r} m,0 m",
                 f"-grid_upper {r0 + 0.5!r} m,0.4 m", f"-region_block_lower {r0!r} m,0 m",
                 f"-region_block_upper {r0 + 0.43!r} m,0.26 m"]  # fmt: skip
        moved = [part for option in moved for part in option.split(" ", 1)]
        v = Run.of_case(scene("thmc", "drained", "warmed"), *options, "-geometry", "axisymmetric", *moved).snapshot(100.0)
        each = {n: np.max(np.abs(v[n] - plane[n])) / np.max(np.abs(plane[n])) for n in compared}
        off.append(max(each.values()))
        rows.append((r0, *each.values()))
    table(("r0 (m)", *compared), rows)
    judge("4.2", "a block of 0.5 m at r = 5000 m against the plane: largest difference of its state", off[1], 1e-3)
    judge("4.2", "the same over the difference at r = 500 m", off[1] / off[0], (0.09, 0.11))


if __name__ == "__main__":
    expansion()
    consolidation()
    heat()
    conservation()
    rest()
    ranks()
    far()
    finish()
