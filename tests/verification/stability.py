#!/usr/bin/env python3
"""Properties at their extremes, slivers, sudden loads, steps far above the explicit limit.

A representative part of docs/studies/stability.md.

Every run must end well or say why it did not; no file of a run may hold a NaN; kinetic energy must not grow when nothing
drives it; errors are held against finer runs and exact solutions.
"""
import math
from pathlib import Path

import numpy as np

from _extremes import CELL, SCENE, attempt, difference, scene, stable_step
from _ladder import ElasticWave as W
from common import CASES, check, check_true, finish, judge, table
from clathra import read_snapshots

ROW = "stability"
FALLING = Path(__file__).parent / "cases" / "falling.yaml"
FIXED = lambda kind, dt: ["-stepper_type", kind, "-stepper_adapt", "no", "-stepper_dt", f"{dt:.12g}", "-stepper_dt_min", f"{1e-7 * dt:.12g}"]
UNTIL = lambda t: ["-time_end", f"{t:.12g} s", "-output_times", f"{t:.12g} s", "-stepper_dt_max", f"{t:.12g} s"]
rows = []


def ends(name, done, kind="finished"):
    """Notes a run; checks how it ended and that its files hold no NaN."""
    rows.append((name, done.kind, float(done.steps), done.growth, done.balance))
    check_true(f"{name}: {kind}, no NaN", done.kind == kind and not done.nan, f"{done.kind} {done.said} {'; '.join(done.nan[:3])}".strip())
    return done


def properties():
    """Fixed steps of 1 s, up to 1e5 times the explicit limit, against a finer quasi-static run: 20 s of SCENE with one property changed."""
    cases = {  # what changes, and 1.3 to 1.5 times what steps of 1 s cost by euler; at 60 degC all hydrate is gone within the first of them
        "k = 1e-9 m2": ({"k": 1e-9}, 0.024), "k = 1e-22 m2": ({"k": 1e-22}, 0.025),
        "S_g = 1e-6": ({"Sg": 1e-6, "Sh": 0.1}, 0.017), "S_h = 0.9": ({"Sh": 0.9, "Sg": 0.05}, 0.036), "porosity 0.9": ({"phi": 0.9}, 0.027),
        "E = 1e5 Pa": ({"E0": 1e5}, 0.022), "E = 1e11 Pa": ({"E0": 1e11}, 0.017), "K_w infinite": ({"Kw": math.inf}, 0.024),
        "60 degC": ({"T0": 60}, 0.11), "60 MPa": ({"p": 60e6}, 0.025)}  # fmt: skip
    for name, (change, bar) in cases.items():
        options, load = [*scene(**change), *UNTIL(20.0)], 1e6 * min(1.0, change.get("E0", 1e8) / 1e8)
        fine = ends(f"{name}, fine", attempt([*options, "-inertia", "no", "-stepper_tol", "3e-4"]))
        done = ends(f"{name}, euler, 1 s", attempt([*options, *FIXED("euler", 1.0)]))
        if fine.kind == done.kind == "finished":
            error = max(difference(done.folder, fine.folder, load).values())
            judge(ROW, f"{name}, euler, steps of 1 s: largest error of any field over its largest change", error, bar)
            check(f"{name}: kinetic energy late over early", done.growth, 1.0)
            check(f"{name}: balance", done.balance, 1e-11)


def fast_reaction():
    """Round-off of the pressure times a fast reaction must not cut steps."""
    done = ends("reaction x 1e6, euler, 1 s", attempt([*scene(rate=1e6), *UNTIL(20.0), *FIXED("euler", 1.0)]))
    judge(ROW, "reaction x 1e6, euler, 20 steps of 1 s: steps taken", float(done.steps), 60.0)
    ends("reaction x 1e8, sdirk2, 1 s", attempt([*scene(rate=1e8), *UNTIL(5.0), *FIXED("sdirk2", 1.0)]))


def uneven(folder):
    """Mean second difference of S_h along the column."""
    v = read_snapshots(folder, "particles")[-1][1]
    row = np.flatnonzero(v["position"][:, 1] < v["position"][:, 1].mean())
    return np.mean(np.abs(np.diff(v["S_h"][row[np.argsort(v["position"][row, 0])], 0], 2)))


def even_reaction():
    """Between nodes at equilibrium so fast a reaction is at equilibrium, too (424).  That is of the start of a step, and the reaction makes up for it at the end, with steps of 1 s as with shorter ones.  Without (424) the differences are 0.16."""
    options = [*scene(rate=1e6), *UNTIL(20.0)]
    for name, more, bar in (("euler, 1 s", FIXED("euler", 1.0), 0.024), ("euler, 0.25 s", FIXED("euler", 0.25), 0.024), ("adaptive", ["-inertia", "no", "-stepper_tol", "3e-4"], 0.01)):
        judge(ROW, f"reaction x 1e6, {name}: S_h from particle to particle, mean second difference", uneven(ends(f"reaction x 1e6, {name}", attempt([*options, *more])).folder), bar)


def slivers():
    """The last particle reaches into the next cell, by less and less: the answer must not depend on it."""
    options = [*scene(), *UNTIL(20.0), "-stepper_type", "euler"]
    whole = ends("no sliver", attempt(options))
    for depth in (1e-3, 1e-5, 2e-6, 9e-7, 1e-7, 1e-8):
        done = ends(f"sliver of {depth:g} cells", attempt([*options, "-region_column_upper", f"{0.2 + depth * CELL!r} m, 0.02 m"]))
        if done.kind == "finished":
            judge(ROW, f"a sliver of {depth:g} cells: largest change of any field", max(difference(done.folder, whole.folder, 1e6).values()), 0.03)


def refusals():
    """Steps above the explicit limit."""
    limit, rules = stable_step(scene(), "hybrid")
    check_true("hybrid prints its stable step and what rules it", limit > 0, f"{limit:g} s, {rules}")
    done = ends("hybrid, ten times its limit", attempt([*scene(), *UNTIL(1e3 * limit), *FIXED("hybrid", 10 * limit)]), "refused")
    check_true("the refusal names step and limit", "above the stable step" in done.said and rules in done.said, done.said)
    forced = attempt([*scene(), *UNTIL(1e4 * limit), *FIXED("hybrid", 10 * limit), "-stepper_force_dt", "yes"])
    ends("hybrid, ten times its limit, forced", forced, forced.kind if forced.kind in ("finished", "stopped") else "finished or stopped")
    check_true("... and the program notices", forced.kind == "stopped" or forced.cut > 0, f"{forced.cut} cuts")


def energy():
    """A dry column is pushed and rings: largest kinetic energy over the exact largest, q^2 V/2M."""
    limit, _ = stable_step([], "hybrid", CASES / "elastic_wave")
    exact = W.q**2 * 10.0 * 0.2 / (2 * W.M)
    for kind, factor in (("hybrid", 0.5), ("explicit", 0.5), ("sdirk2", 0.5), ("euler", 0.5), ("sdirk2", 1e3), ("euler", 1e3)):
        done = ends(f"wave, {kind}, {factor:g} of the limit",
                    attempt([*UNTIL(400 * factor * limit), *FIXED(kind, factor * limit)], CASES / "elastic_wave"))  # fmt: skip
        judge(ROW, f"dry wave, {kind}, 400 steps of {factor:g} of the limit: kinetic energy over the exact largest", done.kinetic / exact, 1.05)


def falling():
    """A saturated block falls through 31 cells."""
    for kind, bar in (("sdirk2", 1e-3), ("euler", 1e-2), ("hybrid", 1e-3)):
        done = ends(f"falling block, {kind}", attempt(["-stepper_type", kind, *(["-stepper_adapt", "yes"] if kind == "hybrid" else [])], FALLING))
        v = read_snapshots(done.folder)[-1][1]
        error = np.max(np.abs(v["displacement"] - [0.0, -0.5 * 9.81 * 0.8**2])) / (0.5 * 9.81 * 0.8**2)
        judge(ROW, f"falling block, {kind}: displacement", error, bar)


def sudden():
    """10 MPa on the end at once, or the outlet's pressure to less than a third: errors over the largest change, that of p over the load too, against
    quasi-static steps of a third of the tolerance.  To 0.5 MPa at once on four grids against cells of 5 mm."""
    still = ["-inertia", "no"]
    load, fall = ["-bc_load_normal", "17 MPa", "-bc_outlet_pressure", "7 MPa"], ["-bc_load_normal", "7 MPa", "-bc_outlet_pressure"]
    loads = {  # name: (options, {kind: (options, bar of p, of all)})
        "load of 10 MPa, k = 1e-11 m2": ([*scene(k=1e-11), *load], {"sdirk2": (["-stepper_tol", "3e-4"], 0.004, 0.08), "sdirk2, quasi-static": (still, 1e-3, 0.01)}),
        "load of 10 MPa, k = 1e-14 m2": ([*scene(), *load], {"euler": (["-stepper_type", "euler"], 1e-3, 0.05), "sdirk2, quasi-static": (still, 1e-3, 0.01)}),
        "outlet to 2 MPa": ([*scene(), *fall, "2 MPa"], {"sdirk2": ([], 1e-3, 2e-3)})}  # fmt: skip
    for name, (options, kinds) in loads.items():
        fine = ends(f"{name} at once, fine", attempt([*options, *UNTIL(100.0), *still, "-stepper_tol", "3e-4"]))
        for kind, (more, bar_p, bar) in kinds.items():
            done = ends(f"{name} at once, {kind}", attempt([*options, *UNTIL(100.0), *more]))
            if fine.kind == done.kind == "finished":
                error = difference(done.folder, fine.folder, 10e6 if "load" in name else 5e6)
                judge(ROW, f"{name} at once, {kind}: error of p over the load", error["p"], bar_p)
                judge(ROW, f"{name} at once, {kind}: largest error of any field", max(error.values()), bar)
    runs = {n: ends(f"outlet to 0.5 MPa at once, {n} cells", attempt([*scene(), *UNTIL(100.0), *fall, "0.5 MPa", "-grid_cells", f"{n},1"]))
            for n in (11, 16, 22, 44)}  # fmt: skip
    for n, bar in ((11, 0.003), (22, 7e-4)):
        error = difference(runs[n].folder, runs[44].folder)["p"]
        judge(ROW, f"outlet to 0.5 MPa at once, {n} cells against 44: error of p over its change", error, bar)


def crawl():
    """Hydrate that dissociates at once where no gas can be dense, to an end: on the node behind the surface p_g extrapolates to less than
    zero."""
    for p in (0.1e6, 0.03e6):
        ends(f"{p / 1e6:g} MPa", attempt(scene(p=p)))


if __name__ == "__main__":
    properties()
    fast_reaction()
    even_reaction()
    slivers()
    refusals()
    energy()
    falling()
    sudden()
    crawl()
    table(("run", "ended", "steps", "kinetic energy late/early", "balance"), rows)
    finish()
