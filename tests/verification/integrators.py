#!/usr/bin/env python3
"""Implicit and explicit integrators tend to one answer as dt and h go to 0.

The two kinds of integrator check each other: one scene by each of them tends to one answer as dt -> 0 and h -> 0.

(a) a wave in a saturated column, with water from gassy to incompressible; (b) fast consolidation: both exact
(exact_dynamic.py); (c) a closed reacting column; (d) BP2 a thousand times faster, cases 1 and 2.

An explicit integrator is compared at its own step.  It keeps pressures on particles, the implicit ones at nodes, and so its
answer differs by the space discretisation too: that part falls with h.
"""
import numpy as np

from _integrators import DAMPED, EULER, EXPLICIT, REACTING, SDIRK2, adaptive, apart, bp2, consolidation, explicit_ones, fixed, steps_of, wave, worst
from common import Run, check, finish, judge, order, table

ROW = "integrators"
TIGHT = ("-newton_tol_residual", 1e-10, "-newton_tol_update", 1e-8, "-ksp_rtol", 1e-8)
IMPLICIT = (EULER, SDIRK2)
FEWEST = 13  # cells of the coarsest column, with the spare ones


def head(text):
    print(f"\n{text}", flush=True)


# ---------------------------------------------------------------------------------------------- against exact curves
def at_own_step(scene, kind, cells, k):
    """An explicit integrator at its stable step, an implicit one at a step that is halved with h."""
    step = adaptive(kind) if kind in EXPLICIT else fixed(kind, scene.every / (5 * 2**k))
    return scene.run(*step, cells=(cells, 1))


def exact_columns():
    """Error of the worst curve over its range, on cells and steps a quarter as large together."""
    scenes = (  # bars of euler, sdirk2 and of the explicit ones: 1.3 to 2 times what is left on 52 cells
        (wave(), "gassy water, 22 MPa", (0.02, 0.002, 0.008)), (wave(2.2e9), "water, 2.2 GPa", (0.025, 0.01, 0.013)),
        (wave(np.inf), "incompressible water", (0.036, 0.015, None)), (consolidation(), "", (0.006, 0.003, 0.001)))  # fmt: skip
    for scene, where, bars in scenes:
        name, exact, rows = scene.name + (f", {where}" if where else ""), scene.exact(), []
        for kind in (*IMPLICIT, *(explicit_ones() if np.isfinite(scene.Kw) else ())):
            cells = [FEWEST, 4 * FEWEST]
            runs = [at_own_step(scene, kind, n, k) for k, n in zip((0, 2), cells)]
            off = [worst(scene.curves(r), exact) for r in runs]
            orders = ["-", *(f"{o:.2f}" for o in -order(cells, off))]
            rows += [(kind, *each) for each in zip(cells, map(steps_of, runs), off, orders)]
            bar = bars[IMPLICIT.index(kind)] if kind in IMPLICIT else bars[2]
            judge(ROW, f"{name}, {kind}, 52 cells: worst curve off the exact one", off[-1], bar, 0.01, "%")
            check(f"{name}, {kind}: error falls with h and dt", off[-1] / off[0], 0.6 if kind == EULER else 0.4)
        head(f"{name}: worst of {', '.join(exact)} off the exact curve, over its range")
        table(("integrator", "cells", "steps", "error", "order"), rows)


# ---------------------------------------------------------------------------------------------------- dt -> 0 at fixed h
def shrinking_steps(scene, steps, euler, sdirk2, *options):
    """Differences at fixed h from sdirk2 with half the least step; bars of the orders, which are those of the worst curve (of sdirk2
    from differences of neighbours).

    With inertia waves that shorter steps follow and longer ones damp hide the order of sdirk2 (order_with_inertia has it): it is shown and not judged.
    """
    name, options = scene.name + (", quasi-static" if "-inertia" in options else ""), (*TIGHT, *options)
    fine, rows, found = scene.curves(scene.run(*fixed(SDIRK2, steps[-1] / 2), *options)), [], {}
    for kind in IMPLICIT:
        runs = [scene.curves(scene.run(*fixed(kind, dt), *options)) for dt in steps]
        each = [apart(r, fine) for r in runs]
        neighbours = [worst(a, b) for a, b in zip(runs, [*runs[1:], fine])]  # of sdirk2: the last is dt/2 too
        orders = order(steps, neighbours if kind == SDIRK2 else [max(e.values()) for e in each])
        found[kind] = max(each[-1].values()), orders[-1]
        rows += [(kind, dt, *e.values(), "-" if k == 0 else f"{orders[k - 1]:.2f}") for k, (dt, e) in enumerate(zip(steps, each))]
    head(f"{name}, {scene.cells[0]} cells: largest difference from sdirk2 with dt = {steps[-1] / 2:g} s, over the range of the curve")
    table(("integrator", "dt (s)", *scene.watched, "order"), rows)
    judge(ROW, f"{name}: order of euler as dt falls", found[EULER][1], euler)
    if sdirk2:
        judge(ROW, f"{name}: order of sdirk2 as dt falls", found[SDIRK2][1], sdirk2)
    judge(ROW, f"{name}: sdirk2 over euler at dt = {steps[-1]:g} s", found[SDIRK2][0] / found[EULER][0], 0.35)


def order_with_inertia():
    """A dry column of 26 cells whose end is pushed along (1 - cos)/2, so that no wave is shorter than a step: differences of neighbours as dt is halved
    six times.  The shortest waves of the grid, of 6.6 ms, are followed by the last steps alone; until then neighbours are uneven, so orders are those of
    the whole way and of its end."""
    rise, end, q, steps = 0.1, 0.2, 10e3, 5e-3 / 2 ** np.arange(7)
    t = np.linspace(0, rise, 21)
    push = ",".join(f"{a!r} s,{b!r} Pa" for a, b in zip(t.tolist(), (0.5 * q * (1 - np.cos(np.pi * t / rise))).tolist()))
    still = ("-quiet", "-grid_cells", "26,1", "-grid_upper", "10.4 m,0.2 m", "-bc_push_normal_table", push, "-time_end", f"{end} s",
             "-output_times", f"{end} s", "-output_probe_every", "5 ms", *TIGHT)  # fmt: skip
    rows = []
    for kind, bar in ((EULER, (0.8, 1.2)), (SDIRK2, (1.8, 2.2))):
        u = [Run.of_case("elastic_wave", *still, *fixed(kind, float(dt))).probe("end")["u_x_m"] for dt in (*steps, steps[-1] / 2)]
        off = [np.max(np.abs(a - b)) / np.ptp(b) for a, b in zip(u, u[1:])]
        orders = order(steps, off)
        rows += [(kind, dt, e, "-" if k == 0 else f"{orders[k - 1]:.2f}") for k, (dt, e) in enumerate(zip(steps, off))]
        for a, b in ((0 if kind == SDIRK2 else 2, 6), (4, 5), (5, 6)):
            found = order([steps[a], steps[b]], [off[a], off[b]])[0]
            judge(ROW, f"a wave in a dry column, inertia, {kind}: order from {steps[a]:g} to {steps[b]:g} s", found, bar)
    head("A wave in a dry column, 26 cells: largest difference from half the step, over the range of the curve")
    table(("integrator", "dt (s)", "difference from dt/2", "order"), rows)


# ----------------------------------------------------------------------------------------------------- faster BP2
def compressed():
    """Quasi-static, the same steps: the numbers must be the same.  Inertia makes the difference that is left."""
    cells, n = (26, 1), 100
    rows = []
    for case in (1, 2):
        slow, fast = bp2(case, cells=cells), bp2(case, 1000, cells=cells)
        still = [s.run(*fixed(SDIRK2, s.end / n), "-inertia", "no") for s in (slow, fast)]
        same = worst(slow.curves(still[0]), fast.curves(still[1]))
        judge(ROW, f"BP2 case {case}, 1000 times faster, quasi-static, {n} equal steps: off the slow one", same, 1e-6)
        moving = [s.curves(s.run(*adaptive(SDIRK2), "-inertia", "yes")) for s in (slow, fast)]
        off = apart(moving[1], moving[0])
        judge(ROW, f"BP2 case {case}, 1000 times faster, with inertia, adaptive: off the slow one", max(off.values()), 0.01, 0.01, "%")
        rows.append((str(case), same, " ".join(f"{k} {v:.1e}" for k, v in off.items())))
    head("BP2 in 2 s against BP2 in 2000 s, 25 cells, sdirk2: largest difference over the range of the curve")
    table(("case", "quasi-static", "with inertia, adaptive"), rows)


# ------------------------------------------------------------------------------------------------- the explicit kind
def explicit_in_time(scene, kind, dt):
    """At fixed h: differences from its own shorter step."""
    steps = [dt, dt / 2, dt / 4]
    runs = [scene.curves(scene.run(*fixed(kind, s))) for s in steps]
    off = [worst(a, b) for a, b in zip(runs, runs[1:])]
    head(f"{scene.name}, {kind}, {scene.cells[0]} cells")
    table(("dt (s)", "difference from dt/2", "order"), [(s, o, "-") for s, o in zip(steps, off)])
    judge(ROW, f"{scene.name}, {kind}: dt halved, the difference is at most", off[1] / off[0], 0.8)


def explicit_in_space(scene, kind, cells, bar, *options):
    """At its own step: difference from sdirk2 with tight tolerance, on finer and finer grids; falls, where it is above 1 % of the range."""
    rows, off = [], []
    for n in cells:
        other = scene.curves(scene.run(*adaptive(SDIRK2, 3e-4), cells=(n, 1)))
        run = scene.run(*adaptive(kind), *options, cells=(n, 1))
        each = apart(scene.curves(run), other)
        off.append((max(each.values()), np.mean(list(each.values()))))
        rows.append((n, steps_of(run), run.cpu, *each.values()))
    head(f"{scene.name}, {kind} against sdirk2 on the same grid: largest difference over the range of the curve")
    table(("cells", "steps", "processor time (s)", *scene.watched), rows)
    judge(ROW, f"{scene.name}, {kind} against sdirk2, {cells[-1]} cells: worst curve", off[-1][0], bar, 0.01, "%")
    judge(ROW, f"{scene.name}, {kind} against sdirk2, mean of the curves: {cells[-1]} over {cells[0]} cells, or over 1 % of the range", off[-1][1] / max(off[0][1], 0.01), 0.8)


def explicit_kind():
    """All of them on what is cheap; hybrid alone where the explicit drag of gas would take a step of a microsecond."""
    cells = (13, 26)
    for kind in explicit_ones():
        explicit_in_time(wave(cells=(FEWEST, 1)), kind, 5e-4)
        explicit_in_time(consolidation(cells=(FEWEST, 1)), kind, 5e-4)
    if "hybrid" in explicit_ones():
        explicit_in_space(REACTING, "hybrid", cells, 0.022)
        for case, bar in ((1, 0.012), (2, 0.017)):
            explicit_in_space(bp2(case, 1000), "hybrid", cells, bar, *DAMPED)


if __name__ == "__main__":
    exact_columns()
    shrinking_steps(wave(cells=(FEWEST, 1)), (2e-3, 1e-3, 5e-4), (0.8, 1.2), None)
    shrinking_steps(consolidation(cells=(FEWEST, 1)), (0.1, 0.05, 0.025), (0.5, 1.2), None)
    shrinking_steps(consolidation(cells=(FEWEST, 1)), (0.1, 0.05, 0.025), (0.85, 1.2), (1.7, 2.3), "-inertia", "no")
    shrinking_steps(REACTING, (0.01, 0.005, 0.0025), (0.85, 1.2), None)
    shrinking_steps(REACTING, (0.01, 0.005, 0.0025), (0.85, 1.2), (1.8, 2.2), "-inertia", "no")
    order_with_inertia()
    compressed()
    explicit_kind()
    finish()
