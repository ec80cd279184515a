#!/usr/bin/env python3
"""Collapse loads and factors of safety on ever finer grids: makes docs/plasticity.md.  Usage: plasticity.py CLATHRA [--page]

The measured numbers stay in docs/plasticity.csv; a run whose row is there is not repeated (delete the row to measure again).
--page makes the page from the rows alone.  All of it takes about an hour of one core.
"""
import csv
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import numpy as np

from _footings import STRIPS, collapse, exact, strip
from common import ROOT, Run

CASES = ROOT / "tests" / "verification" / "cases"
RAW, PAGE = ROOT / "docs" / "plasticity.csv", ROOT / "docs" / "plasticity.md"
COX = 141 * 1.6e3  # Pa
SLOPE_END = 4.0  # s


def footing(name, cells, integrator, rough, mean):
    more = () if mean else ("-mean_dilatation", "no")
    u, load = strip(name, cells, rough, *more, implicit=integrator == "implicit")
    found, growth = collapse(u, load)
    return found / exact(name), growth


def circle(cells, mean):
    """Load over Cox's at a settlement of 0.006 of the radius, and its growth over the last fifth of it."""
    run = Run.of_case(CASES / "circle.yaml", "-quiet", "-grid_cells", f"{4 * cells},{2 * cells}", "-mean_dilatation", "yes" if mean else "no", exit_code=(0, 3))
    m = run.csv("meters.csv")
    u, load = -m["plate.position_m"], m["plate.force_N"] / np.pi / COX
    return load[-1], load[-1] / np.interp(0.8 * u[-1], u, load) - 1


def slope(cells, factor, mean):
    """Largest displacement (m) and its growth over the last fifth of the run; cells over the height of 10 m."""
    n = cells / 10
    run = Run.of_case(CASES / "slope.yaml", "-quiet", "-grid_cells", f"{round(36 * n)},{round(12 * n)}", "-mean_dilatation", "yes" if mean else "no",
                      "-strength_factor", factor, "-output_times", f"{0.8 * SLOPE_END} s, {SLOPE_END} s")  # fmt: skip
    u = [np.hypot(*v["displacement"].T).max() for _, v in run.snapshots()[-2:]]
    return u[1], u[1] / u[0] - 1


def wanted():
    """(kind, arguments) in order of cost."""
    yield from (("footing", ("Prandtl", n, i, 1, 1)) for n in (4, 8) for i in ("hybrid", "implicit"))
    yield from (("footing", ("Prandtl", n, "implicit", 0, 1)) for n in (4, 8))
    yield from (("footing", ("Prandtl", n, "hybrid", 1, 0)) for n in (4, 8))
    yield from (("footing", (name, n, "hybrid", 0, 1)) for n in (4, 8) for name in STRIPS if name != "Prandtl")
    yield from (("slope", (10, f, 1)) for f in (1.35, 1.4, 1.45))
    yield from (("slope", (10, f, 0)) for f in (1.4, 1.45, 1.5))
    yield from (("slope", (20, f, m)) for f in (1.35, 1.4, 1.45) for m in (1, 0))
    yield from (("circle", (n, 1)) for n in (4, 8))
    yield ("circle", (8, 0))
    yield ("footing", ("Prandtl", 16, "implicit", 1, 1))
    yield from (("slope", (40, f, 1)) for f in (1.3, 1.35, 1.4))
    yield ("footing", ("Prandtl", 16, "hybrid", 1, 1))
    yield ("circle", (16, 1))
    yield from (("footing", (name, 16, "hybrid", 0, 1)) for name in STRIPS if name != "Prandtl")
    yield from (("footing", (name, 24, "hybrid", 0, 1)) for name in STRIPS if "20" in name)


def read():
    if not RAW.is_file():
        return {}
    with open(RAW, newline="") as f:
        return {(r["kind"], r["case"]): (float(r["value"]), float(r["growth"]), float(r["seconds"])) for r in csv.DictReader(f)}


def write(rows):
    with open(RAW, "w", newline="") as f:
        out = csv.writer(f, lineterminator="\n")
        out.writerow(("kind", "case", "value", "growth", "seconds"))
        for (kind, case), (value, growth, seconds) in rows.items():
            out.writerow((kind, case, f"{value:.6g}", f"{growth:.4g}", f"{seconds:.0f}"))


def key(kind, arguments):
    return kind, " / ".join(map(str, arguments))


def measure(rows):
    for kind, arguments in wanted():
        if key(kind, arguments) in rows:
            continue
        start = time.time()
        value, growth = globals()[kind](*arguments)
        rows[key(kind, arguments)] = (value, growth, time.time() - start)
        print(*key(kind, arguments), f"{value:.5g} {growth:+.2%}", flush=True)
        write(rows)


def percent(x):
    return f"{100 * x:+.1f} %"


def footing_rows(rows):
    for name in STRIPS:
        for integrator, rough, mean in (("hybrid", 1, 1), ("implicit", 1, 1), ("implicit", 0, 1), ("hybrid", 0, 1), ("hybrid", 1, 0)):
            found = {n: rows[k][0] - 1 for n in (4, 8, 16, 24) if (k := key("footing", (name, n, integrator, rough, mean))) in rows}
            if not found:
                continue
            n = sorted(found)
            limit = ""
            if len(n) > 1:
                h = [1 / k for k in n[-2:]]
                limit = percent((found[n[-1]] * h[0] - found[n[-2]] * h[1]) / (h[0] - h[1]))
            cells = " | ".join(percent(found[k]) if k in found else "" for k in (4, 8, 16, 24))
            yield f"| {name} | {'rough' if rough else 'smooth'} | {integrator}{'' if mean else ', no mean dilatation'} | {exact(name):.4f} | {cells} | {limit} |"


def slope_rows(rows):
    for mean in (1, 0):
        for n in (10, 20, 40):
            cells = []
            for f in (1.3, 1.35, 1.4, 1.45, 1.5):
                k = key("slope", (n, f, mean))
                cells.append("" if k not in rows else f"{1e3 * rows[k][0]:.0f} mm, {'fails' if rows[k][1] > 0.05 else 'stands'}")
            if any(cells):
                yield f"| H/{n} | {'yes' if mean else 'no'} | {' | '.join(cells)} |"


def circle_rows(rows):
    for n in (4, 8, 16):
        for mean in (1, 0):
            k = key("circle", (n, mean))
            if k in rows:
                yield f"| R/{n} | {'yes' if mean else 'no'} | {percent(rows[k][0] - 1)} | {percent(rows[k][1])} |"


def page(rows):
    lines = [
        "# Collapse loads and factors of safety", "",
        "Made by `tests/studies/plasticity.py` from the rows of [plasticity.csv](plasticity.csv); do not edit by hand. The tests `tests/verification/footings.py`,",
        "`slopes_strength.py`, `element_paths.py`, `plastic_hole.py` and `sand_column.py` run the short ones of these on every check.", "",
        "## What is needed for a collapse load", "",
        "- `mean_dilatation: yes` ((88) of [equations.md](equations.md)): without it bilinear motion locks, the load is far too large and grows on.",
        "- implicit: `stabilisation_ghost_penalty: 1e-3` or less. (22) is elastic and resists every step's flow at the surface, more in longer steps; hybrid has none.",
        "- stiff ground (E/c = 1e5 here), so that the load comes at a settlement that does not change the geometry (at E/c = 1e4 loads still rise by 1 to 10 %).",
        "- hybrid: a plate that slows down before the load is read, so that inertia (rho c v) is small, and some `stepper_damping`.", "",
        "## Strips on weightless ground, phi = psi", "",
        "Error of the mean pressure over the last fifth of the settlement, on cells of a/4 to a/24 (a: half-width); \"h to 0\" from the two finest, taken as of first order.",
        "What is left is the cell beside the plate, over which the ground's motion has to pass: the plate acts as if it were wider by half a cell and more.", "",
        "| case | plate | integrator | exact (c or q) | a/4 | a/8 | a/16 | a/24 | h to 0 |", "|---|---|---|---|---|---|---|---|---|",
        *footing_rows(rows), "",
        "The bar of 3 % on a grid, not extrapolated, is met by Prandtl's strip at a/16. At 20 deg a/16 is 4 % off, and falls with h: a/24 would do by the order seen; at 30 deg it takes finer",
        "grids yet. An empty field was not run.", "",
        "## Smooth circle on heavy ground (Cox), phi = psi = 30 deg, gamma R/c = 10: 141 c", "",
        "Implicit (about an axis hybrid is not there), at a settlement of 0.006 R.", "",
        "| h | mean dilatation | error | growth over the last fifth |", "|---|---|---|---|", *circle_rows(rows), "",
        "**The bar of 3 % is not met, and the cause is not found.** The load falls with h, but ever more slowly, and still grows with settlement. It is not locking (with and without mean",
        "dilatation the loads are alike), nor the ends of the ground (6 R wide, 3 R deep: 1 % less at R/4), nor the stiffness (ten times: 4 % more at R/4). Steps and (22) have a part: steps four",
        "times shorter with a penalty of 1e-5 give 7 % less at R/4. The same circle without friction is right up to the wider plate (19 and 10 % at R/4 and R/8 of 5.69 c), without weight it is",
        "43 and 26 % above 49.3 c. Strength grows from almost nothing at the edge of the plate, within less than a cell; the edges of the yield surface about an axis are the next suspect.", "",
        "## Slope 2:1 by strength reduction, psi = 0", "",
        "c = 10 kPa, phi = 20 deg, gamma = 20 kN/m3, H = 10 m (Griffiths and Lane 1999: 1.4; Bishop 1.38). Largest displacement after 4 s, and whether it stands by the criterion of",
        "`scripts/strength_reduction.py`; hybrid. The factor depends on the grid, as the run says.", "",
        "| h | mean dilatation | 1.30 | 1.35 | 1.40 | 1.45 | 1.50 |", "|---|---|---|---|---|---|---|", *slope_rows(rows), "",
    ]  # fmt: skip
    PAGE.write_text("\n".join(lines))


if __name__ == "__main__":
    found = read()
    if "--page" not in sys.argv:
        measure(found)
    page(found)
