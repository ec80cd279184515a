#!/usr/bin/env python3
"""The shipped cases' final fields do not alternate from cell to cell.

Fields that alternate from cell to cell are judged by a number: zigzag, the smallest of three successive differences of
alternating sign between the means of neighbouring cells in a row, the largest in the body, over the field's range.  It is 0 in
smooth fields and at fronts, and the amplitude where cells alternate.  The shipped cases' final fields, of the pictures in docs,
on shorter runs or larger cells where they are long, the README's own case and the tutorial's; stresses beside a heater, whose particles alternate and whose pictures do not.
"""
import re
from pathlib import Path

import numpy as np

from common import CASES, ROOT, binary, check_true, finish, judge, run, scratch, table  # noqa: I001
import clathra  # noqa: E402, from python, which common puts on the path
import tutorial  # noqa: E402
from clathra import shown  # noqa: E402

SEEN = 0.02  # of the range of a picture's colours
SLIDES = 0.1  # where slopes slide: at the end of the heated part of their base, and at their toes
FRONT = 0.1  # what BP2's own front has on the grid of its figure
# Variable: range below which it counts as constant.
LEAST = {"p": 1e3, "p_w": 1e3, "T": 1e-2, "S_h": 1e-3, "S_w": 1e-3, "mean stress": 1e2, "displacement": 1e-9, "eps_d_p": 1e-3}


def cell_means(run, particles, values):
    """(nx, ny) means over the particles of each cell, NaN where there are none."""
    low, high, n = (np.array(run.case[f"grid_{k}"]) for k in ("lower", "upper", "cells"))
    n = n.astype(int)
    i, j = np.clip(np.floor((particles["position"] - low) / (high - low) * n).astype(int), 0, n - 1).T
    cell = i * n[1] + j
    count, total = (np.bincount(cell, w, minlength=n.prod()) for w in (None, values))
    return np.where(count > 0, total / np.maximum(count, 1), np.nan).reshape(n)


def zigzag(cells):
    """Largest over both axes; rows with gaps are passed over where they are."""
    worst = 0.0
    for axis in (0, 1):
        d = np.diff(np.moveaxis(cells, axis, 0), axis=0)
        if len(d) < 3:
            continue
        three = np.stack([d[k : len(d) - 2 + k] for k in range(3)])
        turns = np.all(three[:-1] * three[1:] < 0, axis=0)
        worst = max(worst, np.max(np.abs(three).min(axis=0), where=turns, initial=0.0))
    return worst


def measured(folder, own=False):
    """{variable: zigzag over range} of the last snapshot, of variables that vary; own: of the particles' own stress."""
    run = clathra.Run(folder)
    p = run.particles(run.times[-1])
    fields = {k: np.asarray(p[k]).reshape(len(p["id"]), -1) for k in ("p", "p_w", "T", "S_h", "S_w", "eps_d_p") if k in p}
    if "stress" in p:  # of the nodal means that pictures show: a cell's particles share its volume change (88), so their own alternate from cell to cell
        fields |= {"mean stress": (p if own else shown.drawn(run, run.times[-1]))["stress"][:, :3].mean(axis=1, keepdims=True), "displacement": p["displacement"]}
    found = {}
    for name, values in fields.items():
        parts = [cell_means(run, p, v) for v in values.T]
        spread = max(np.nanmax(c) - np.nanmin(c) for c in parts)
        if spread > LEAST[name]:
            found[name] = max(zigzag(c) for c in parts) / spread
    return found


# ---------------------------------------------------------------- the measure itself
x, y = np.meshgrid(np.arange(20), np.arange(10), indexing="ij")
check_true("it is 0 for a smooth field, a front and an overshoot", zigzag(np.sin(x / 3) + y**2) == zigzag(1.0 * (x > 9)) == zigzag(1.0 * (x > 9) + 0.1 * (x == 10)) == 0.0)
check_true("... and the amplitude of a checkerboard, in a corner too", zigzag(1.0 * ((x + y) % 2)) == 1.0 and abs(zigzag(np.where((x < 6) & (y < 6), 0.3 * ((x + y) % 2), 0.01 * x * y)) - 0.3) < 0.1)

# ---------------------------------------------------------------- shipped cases
SHORT = {"terzaghi": (), "heat_slab": (), "heat_advection": (), "gravity_column": (), "mcwhorter_sunada": (), "footing": (), "shear_box": (), "elastic_wave": (),
         "stefan_front": ("-time_end", "12 h", "-output_times", "12 h"), "buckley_leverett": ("-grid_cells", "50,1"), "bp2": ("-time_end", "1000 s", "-output_times", "1000 s"),
         "sea_floor": ("-stepper_max_steps", 4), "century": (), "century_hydrate": (), "masuda": ("-grid_cells", "4,30", "-time_end", "1 h", "-output_times", "1 h"),
         "biaxial": ("-stepper_type", "hybrid", "-grid_cells", "8,21", "-time_end", "0.45 s", "-output_every", "0.45 s")}  # fmt: skip
# Cells, s to load, end: before particles cross lines at the end of the heated base, from when on means of its two rows are of unlike cells.
SLOPES = {"slope_a": ("75,15", 3, 6.5), "slope_b": ("225,10", 5, 8), "slope_c": ("180,8", 5, 10)}
rows = []
for name, options in SHORT.items():
    found = measured(run(binary(), CASES / name, "-quiet", *options).out)
    rows += [(name, k, v) for k, v in found.items()]
    check_true(f"{name}: some field varies", bool(found), list(found))
    if name == "bp2":  # particles of one cell share its strain, not their stiffness, which follows S_h: beside the front of 50 cells they alternate
        print(f"     {name}: zigzag of the mean stress beside the front, not judged: {found.pop('mean stress'):.3g}")
        judge("fronts", f"{name}, 50 cells: zigzag of S_w beside the front over its range", found.pop("S_w"), FRONT)
    if name == "biaxial":  # it varies by 0.013
        judge("fronts", f"{name}: zigzag of S_w over its range", found.pop("S_w"), 2 * SEEN)
    judge("fronts", f"{name}: zigzag of any field over its range", max(found.values()), SEEN)


def slope(name, *options):
    cells, load, end = SLOPES[name]
    return measured(run(binary(), CASES / name, "-quiet", "-grid_cells", cells, "-gravity_ramp", f"{load} s", "-stage_load_end", f"{load} s", "-stage_slide_end", f"{end} s", "-output_every", "0 s", *options).out)


for name in SLOPES:
    found = slope(name)
    rows += [(name, k, v) for k, v in found.items()]
    for what in ("eps_d_p", "displacement"):
        judge("fronts", f"{name} on coarse cells: zigzag of {what} over its range", found.pop(what), SEEN)
    print(f"     {name}: zigzag of S_w, which no picture shows, not judged: {found.pop('S_w'):.3g}")
    judge("fronts", f"{name} on coarse cells: zigzag of any other field over its range", max(found.values()), SLIDES)

locked = measured(run(binary(), CASES / "footing", "-quiet", "-mat_ground_elasticity_nu", 0.4999).out, own=True)
check_true("a skeleton that locks is seen: its mean stress alternates", locked["mean stress"] > 0.1, locked)
case = scratch() / "case.yaml"
text = re.search(r"```yaml\n(title: a hydrate layer is drawn down.*?)```", Path(ROOT / "README.md").read_text(), re.S)[1]
case.write_text(text)
FOUR_HOURS = ("-quiet", "-grid_cells", "10,6", "-time_end", "4 h", "-output_every", "4 h")
found = measured(run(binary(), case, *FOUR_HOURS).out)
rows += [("README's case", k, v) for k, v in found.items()]
judge("fronts", "README's case: zigzag of any field over its range", max(found.values()), SEEN)

# ---------------------------------------------------------------- the tutorial's film, on the grid of its picture
case.write_text(tutorial.case_text())
found = measured(run(binary(), case, "-quiet", *tutorial.FINE, "-output_every", "30 d").out)
rows += [("tutorial's well", k, v) for k, v in found.items()]
judge("fronts", "tutorial's picture: zigzag of S_h over its range", found["S_h"], 2 * SEEN)
judge("fronts", "tutorial's picture: zigzag of any field over its range", max(found.values()), FRONT)

# ---------------------------------------------------------------- stresses that hydrate makes alternate within cells
HEATER = text.replace("boundaries: [", "boundaries: [heater, ").replace("bc:\n", "bc:\n  heater: {type: face_temperature, side: left, from: 1 m, to: 3 m, temperature: {ramp: [10 degC, 60 degC, 0 h, 12 h]}}\n")
case.write_text(re.sub(r"  well: \{.*\n", "  well: {type: pressure, side: top, initial: yes}\n", HEATER).replace("10 m", "4 m").replace("5 m, 2.5 m", "2 m, 2.5 m"))
heated = clathra.Run(run(binary(), case, "-quiet", "-grid_cells", "8,12", "-stepper_tol", "1e-2", "-time_end", "2 d", "-output_every", "2 d").out)
own, seen = heated.particles(), shown.drawn(heated, None)


def rows_of_particles(values):
    """(nx, ny) of a body of 2 x 2 particles a cell."""
    order = np.lexsort(heated.particles()["initial_position"].T[::-1].round(6))
    return values[order].reshape(16, -1)


for what, p, least, most in (("its particles", own, 0.05, 1.0), ("the nodal means that pictures show", seen, 0.0, 0.05)):
    syy = rows_of_particles(p["stress"][:, 1])
    found = zigzag(syy) / np.ptp(syy)
    rows.append(("heater", what, found))
    check_true(f"a heater: zigzag of the vertical stress, {what}: {found:.3g} of its range", least <= found <= most)
x = own["position"]
smooth, constant = (np.abs(shown.nodal_means(heated.lines, own, v[:, None])[:, 0] - v) for v in (x[:, 1] - 0.2 * x[:, 0], np.full(len(x), 7.0)))
inside = np.all((x > 0.5) & (x < x.max(0) - 0.5), axis=1)
check_true("nodal means keep a constant, and inside a linear field", constant.max() < 1e-12 and smooth[inside].max() < 0.01, (constant.max(), smooth[inside].max()))
table(("case", "field", "zigzag/range"), rows)
finish()
