#!/usr/bin/env python3
"""Collapse loads and factors of safety on ever finer grids: makes docs/studies/plasticity.md.  Usage: plasticity.py CLATHRA [--page]

The measured numbers stay in docs/studies/plasticity.csv; a run whose row is there is not repeated (delete the row to measure again).
--page makes the page from the rows alone.  All of it takes about an hour of one core.
"""
import csv
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import numpy as np

import _footings
from _footings import STRIPS, collapse, exact, strip
from _hole import quarter
from common import ROOT, Run
import dated  # of scripts/, which common puts on the path
from clathra.strength import FLOWS, Energies  # python/, which common puts on the path

CASES = ROOT / "tests" / "verification" / "cases"
RAW, PAGE = ROOT / "docs" / "studies" / "plasticity.csv", ROOT / "docs" / "studies" / "plasticity.md"
SLOPE_END = 4.0  # s
CIRCLES = ((0.99, 0.1), (0.99, 1), (0.95, 1), (0.95, 10), (0, 1))  # mean_strain, how many times softer than E/c = 1e7


def footing(name, cells, integrator, rough, strain):
    """Collapse load over the exact one and its growth; strain: with mean strain?"""
    u, load = strip(name, cells, rough, *(() if strain else ("-mean_strain", "0")), implicit=integrator == "implicit")
    found, growth = collapse(u, load)
    return found / exact(name), growth


def circle(*arguments):
    return _footings.circle(*arguments, timeout=7200)


def hole(cells, integrator):
    """Relative errors of the wall's displacement and of the plastic radius of Salencon's hole in plane strain; cells over the radius."""
    return quarter(1 / cells, integrator == "hybrid", timeout=7200)


def slope(cells, factor):
    """Largest displacement (m) and plastic work of the last tenth of the run, by what the body has taken up; cells over the height of 10 m."""
    n = cells / 10
    run = Run.of_case(CASES / "slope.yaml", "-quiet", "-grid_cells", f"{round(36 * n)},{round(12 * n)}", "-strength_factor", factor, "-output_times", f"{0.9 * SLOPE_END} s, {SLOPE_END} s")  # fmt: skip
    return np.hypot(*run.snapshots()[-1][1]["displacement"].T).max(), Energies(run.balance, 0.0, SLOPE_END).flow(0.9, 1.0)[0]


def wanted():
    """(kind, arguments) in order of cost."""
    yield from (("footing", ("Prandtl", n, i, 1, strain)) for n in (4, 8) for i in ("hybrid", "implicit") for strain in (1, 0))
    yield from (("footing", (name, n, "hybrid", 0, strain)) for n in (4, 8) for name in STRIPS if name != "Prandtl" for strain in (1, 0))
    yield from (("circle", (n, *how)) for n in (4, 8) for how in CIRCLES[1:])
    yield from (("slope", (n, f)) for n in (10, 20) for f in (1.35, 1.4, 1.45))
    yield from (("hole", (n, i)) for n in (5, 10) for i in ("implicit", "hybrid"))
    yield from (("slope", (40, f)) for f in (1.3, 1.35, 1.4))
    yield from (("hole", (20, i)) for i in ("implicit", "hybrid"))
    yield from (("footing", ("Prandtl", 16, i, 1, 1)) for i in ("hybrid", "implicit"))
    yield from (("circle", (n, *CIRCLES[1])) for n in (16, 24))
    yield from (("circle", (n, *CIRCLES[0])) for n in (8, 16))


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
    dated.measured(RAW)


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
        for integrator, rough, mean in ((i, r, m) for m in (1, 0) for r in (1, 0) for i in ("hybrid", "implicit")):
            found = {n: rows[k][0] - 1 for n in (4, 8, 16) if (k := key("footing", (name, n, integrator, rough, mean))) in rows}
            if not found:
                continue
            n = sorted(found)
            limit = ""
            if len(n) > 1:
                h = [1 / k for k in n[-2:]]
                limit = percent((found[n[-1]] * h[0] - found[n[-2]] * h[1]) / (h[0] - h[1]))
            cells = " | ".join(percent(found[k]) if k in found else "" for k in (4, 8, 16))
            yield f"| {name} | {'rough' if rough else 'smooth'} | {integrator} | {'yes' if mean else 'no'} | {exact(name):.4f} | {cells} | {limit} |"


def slope_rows(rows):
    for n in (10, 20, 40):
        cells = []
        for f in (1.3, 1.35, 1.4, 1.45):
            k = key("slope", (n, f))
            cells.append("" if k not in rows else f"{1e3 * rows[k][0]:.0f} mm, {'fails' if rows[k][1] > FLOWS else 'stands'}")
        if any(cells):
            yield f"| H/{n} | {' | '.join(cells)} |"


def circle_rows(rows):
    for share, softer in CIRCLES:
        for n in (4, 8, 16, 24):
            k = key("circle", (n, share, softer))
            if k in rows:
                yield f"| R/{n} | {1e7 / softer:.0e} | {share} | {percent(rows[k][0] - 1)} | {percent(rows[k][1])} |".replace("e+0", "e")


def hole_rows(rows):
    for n in (5, 10, 20):
        found = [rows.get(key("hole", (n, i))) for i in ("implicit", "hybrid")]
        if any(found):
            yield f"| a/{n} | " + " | ".join(" | ".join(map(percent, f[:2])) if f else " | " for f in found) + " |"


def circle_causes(rows):
    """What makes the load of the circle too large, one by one."""
    at = lambda n, share, softer: percent(rows[key("circle", (n, share, softer))][0] - 1) if key("circle", (n, share, softer)) in rows else "(not run)"
    against = lambda n: percent(rows[key("circle", (n, 0.99, 0.1))][0] * 141 / 142.3 - 1)
    return [
        f"With a share of 0.99 the load falls with h, {at(4, 0.99, 1)}, {at(8, 0.99, 1)}, {at(16, 0.99, 1)} over Cox's 141 c with E/c = 1e7. On R/24 that is {at(24, 0.99, 1)} and grows: beside the plate the ground",
        f"has risen by a larger part of a cell. With E/c = 1e8, at a tenth of the settlement, the load has come to rest, and is {at(8, 0.99, 0.1)} and **{at(16, 0.99, 0.1)}** on R/8 and R/16: the bar of 3 % is met. The method of",
        f"characteristics (a script that is not kept here) gives 142.0 to 142.4 c, as fine as its nets are; over 142.3 c they are {against(8)} and {against(16)}. What else makes",
        "the load too large, one at a time:", "",
        f"- ground that dilates and locks, (160): without `mean_strain` {at(4, 0, 1)} and {at(8, 0, 1)} at R/4 and R/8, and growing;",
        f"- soft ground: with E/c = 1e6 {at(4, 0.95, 10)} and {at(8, 0.95, 10)} where stiff ground (share 0.95) has {at(4, 0.95, 1)} and {at(8, 0.95, 1)}: beside the plate it has risen by a thirtieth of a cell of R/8 by then,",
        "  and the load still grows;",
        f"- what `mean_strain` leaves to a particle's own strain: a stress of (1 - s)^2 E u/h beside the plate, 24 c at R/16 with 0.95 and 1 c with 0.99: {at(8, 0.95, 1)} and {at(8, 0.99, 1)} at R/8;",
        "- the ghost penalty (22), which resists elastically: at R/4 14.2, 13.5, 13.4 % with 1e-5, 1e-6, 1e-7 (without any, Newton's method finds no solution);",
        "- not the number of particles: 3 x 3 a cell make 15.6 % at R/4 of what are 15.2 % with 2 x 2 (share 0.95, 8e-5 R).", "",
        "What is left is the edge, but not the contact: the vertical stress of the topmost particles within R adds up to 99.3 % of the load at R/4 and to 100.2 % at R/8, so that the plate bears on nothing beyond R. The node",
        "at its edge moves with it, though, and the ground follows over the next cell: what fails is as wide as under a plate of some 1.05 R at R/4, and the load of a circle on its own weight goes with nearly the cube of",
        "its radius, so that it sees this three times as much as a strip. (An earlier page had 15.9, 10.7, 13.8 %, on soft ground and with 0.95.)",
    ]  # fmt: skip


def page(rows):
    lines = [
        *dated.head("Collapse loads and factors of safety", "tests/studies/plasticity.py", RAW),
        "The tests `tests/verification/footings.py`,",
        "`slopes_strength.py`, `element_paths.py`, `plastic_hole.py` and `sand_column.py` run the short ones of these on every check.", "",
        "## What is needed for a collapse load", "",
        "- where the ground dilates, `mean_strain: 0.95` ((160) of [equations.md](../equations.md)): one volume change a cell (88) locks as soon as its particles shear, and so dilate, differently.",
        "- implicit: a `stabilisation_ghost_penalty` that is small beside the strength. (22) is elastic and resists every step's flow at the surface; hybrid has none. It grows with E: 1e-3 for the strips, 1e-6 for the",
        "  circle.",
        "- clay whose c_u grows with depth: friction 0 and `cohesion_gradient` below `cohesion_level` (455); the limit of a strip of it is met within 2 % (`tests/verification/clay_strength.py`).",
        "- stiff ground (E/c = 1e5, for the circle 1e7), so that the load comes at a settlement that does not change the geometry: with psi = 30 deg the ground beside the plate rises seven times as far as the plate sinks.",
        "- hybrid: a plate that slows down before the load is read, so that inertia (rho c v) is small, and some `stepper_damping`.", "",
        "## Strips on weightless ground, phi = psi", "",
        "Error of the mean pressure over the last fifth of the settlement, on cells of a/4 to a/16 (a: half-width); \"h to 0\" from the two finest, taken as of first order. What",
        "is left is the cell beside the plate, over which the ground's motion has to pass: the plate acts as if it were wider by a part of a cell.", "",
        "| case | plate | integrator | mean strain | exact (c or q) | a/4 | a/8 | a/16 | h to 0 |", "|---|---|---|---|---|---|---|---|---|",
        *footing_rows(rows), "",
        "The bar of 3 % on a grid, not extrapolated, is met by Nc and Nq at a/8, at 20 and at 30 deg; Cox's circle, below, at R/16. Nc at",
        "30 deg still grows by 3 to 4 % over the last fifth of its settlement. An empty field was not run.", "",
        "## Smooth circle on heavy ground (Cox), phi = psi = 30 deg, gamma R/c = 10: 141 c", "",
        "Implicit (about an axis hybrid is not there), at a settlement of 6e-5 R where E/c = 1e7 (ghost penalty 1e-6), of 6e-6 R where it is 1e8 (1e-7), of 6e-4 R where it is 1e6 (1e-5).", "",
        "| h | E/c | mean_strain | error | growth over the last fifth |", "|---|---|---|---|---|", *circle_rows(rows), "",
        *circle_causes(rows), "",
        "## Salencon's hole in plane strain, phi = psi = 30 deg", "",
        "A quarter of the hole on a grid of squares, whose far edge, at four radii, bears the stress that the infinite ground has there; errors of the displacement of the wall and of the radius of the plastic zone",
        "(the outermost particle that has yielded). The same scene without dilation has no single solution in the plane: bands form around the hole, and the wall moves 2 % too little on a/10 and 4 % too much on a/20.",
        "About an axis, where bands cannot form, both are in `tests/verification/plastic_hole.py`.", "",
        "| h | implicit: wall | radius | hybrid: wall | radius |", "|---|---|---|---|---|", *hole_rows(rows), "",
        "## Slope 2:1 by strength reduction, psi = 0", "",
        "c = 10 kPa, phi = 20 deg, gamma = 20 kN/m3, H = 10 m (Griffiths and Lane 1999: 1.4; Bishop 1.38). Largest displacement after 4 s, and whether it stands by what",
        "`clathra strength` asks; hybrid. The factor depends on the grid, as the run says.", "",
        "| h | 1.30 | 1.35 | 1.40 | 1.45 |", "|---|---|---|---|---|", *slope_rows(rows), "",
    ]  # fmt: skip
    PAGE.write_text("\n".join(lines))


if __name__ == "__main__":
    found = read()
    if "--page" not in sys.argv:
        measure(found)
    page(found)
