#!/usr/bin/env python3
"""Row 10: the same column along x and along y, mirrored, and shifted against the grid.

Turned and mirrored columns do the same arithmetic in another order: round-off, amplified by Newton's tolerances.  For the
shift the column floats, loaded and drained at both ends, so that no grid plane ties it to the grid; what a shift changes
must be less than what the mesh changes (12 against 24 cells).
"""
import itertools
from pathlib import Path

import numpy as np

from common import Run, check, finish, judge, largest_difference, scratch, table

CASE = Path(__file__).parent / "cases" / "orientation.yaml"
N, WIDTH = 12, 0.05
TIGHT = ["-newton_tol_update", 1e-9]
LEFT_END = """  load_left: {type: traction, side: left, normal: {table: [0 s, 3.25 MPa, 500 s, 8.25 MPa]}}
  drain_left: {type: pressure, side: left, initial: yes}
"""
QUANTITIES = {"p": "p_Pa", "T": "T_degC", "S_h": "S_h"}


def placed(axis, mirrored):
    """Options that put the column along axis (0, 1), its drained end at the upper or, mirrored, at the lower end."""
    h = 1 / N
    lower, upper = (-h, 1.0) if mirrored else (0.0, 1 + h)
    pair = lambda along, across: ",".join(f"{v!r} m" for v in ((along, across) if axis == 0 else (across, along)))
    cells = (N + 1, 1) if axis == 0 else (1, N + 1)
    side = (("right", "left"), ("top", "bottom"))[axis][mirrored]
    at = lambda x: 1 - x if mirrored else x
    return ["-grid_lower", pair(lower, 0.0), "-grid_upper", pair(upper, WIDTH), "-grid_cells", f"{cells[0]},{cells[1]}",
            "-region_column_upper", pair(1.0, WIDTH), "-bc_base_axis", "xy"[axis], "-bc_base_position", f"{at(0.0)} m",
            "-bc_lower_wall_axis", "yx"[axis], "-bc_upper_wall_axis", "yx"[axis], "-bc_load_side", side,
            "-bc_drain_side", side, "-probe_inner_at", pair(at(0.6), WIDTH / 2),
            "-probe_end_at", pair(at(1.0), WIDTH / 2)]  # fmt: skip


def history(run, axis, mirrored):
    out = {k: run.probe("inner")[c] for k, c in QUANTITIES.items()}
    out["u"] = run.probe("end")[f"u_{'xy'[axis]}_m"] * (-1 if mirrored else 1)
    return out


def turned():
    base = None
    for axis, mirrored in itertools.product((0, 1), (False, True)):
        run = Run.of_case(CASE, *placed(axis, mirrored), *TIGHT)
        got = history(run, axis, mirrored)
        if base is None:
            base = got
            continue
        name = f"along {'xy'[axis]}{', mirrored' if mirrored else ''}, against along x"
        for k in base:
            judge(10, f"{name}: {k}, relative", largest_difference(got[k], base[k]), 1e-10)


def floating(cells, shift):
    """A column of 1 m, loaded and drained at both ends, on a grid of cells a metre, put at `shift` cells from a line."""
    h = 1 / cells
    x0 = shift * h
    lines = CASE.read_text().splitlines(keepends=True)
    at = next(k for k, line in enumerate(lines) if line.startswith("  base: "))
    case = scratch() / "floating.yaml"
    case.write_text("".join(lines[:at] + [LEFT_END] + lines[at + 1 :]))
    run = Run.of_case(case, "-boundaries", "lower_wall,upper_wall,load,drain,load_left,drain_left",
                      "-grid_lower", f"{-2 * h!r} m,0 m", "-grid_upper", f"{1 + 3 * h!r} m,{WIDTH} m",
                      "-grid_cells", f"{cells + 5},1", "-region_column_lower", f"{x0!r} m,0 m",
                      "-region_column_upper", f"{1 + x0!r} m,{WIDTH} m", "-probe_inner_at", f"{0.5 + x0!r} m,{WIDTH / 2} m",
                      "-probe_end_at", f"{1 + x0!r} m,{WIDTH / 2} m", "-mat_sediment_kinetics_active", "no")  # fmt: skip
    return run.probe("inner")["p_Pa"] - 3.25e6, run.probe("end")["u_x_m"]


def shifted():
    base, fine = floating(N, 0.0), floating(2 * N, 0.0)
    mesh = [largest_difference(a, b) for a, b in zip(base, fine)]
    rows = [("24 cells", *mesh)]
    for shift in (0.25, 0.5, 0.7):
        change = [largest_difference(a, b) for a, b in zip(floating(N, shift), base)]
        rows.append((f"shift {shift} h", *change))
        for what, c, m in zip(("p in the middle", "u of the end"), change, mesh):
            judge(10, f"shifted by {shift} of a cell: change of {what} over discretisation error", c / m, 1.0)
    print("\nlargest difference from 12 cells without shift, relative")
    table(("", "p in the middle", "u of the end"), rows)
    check("discretisation error itself (12 against 24 cells)", max(mesh), 0.05)


if __name__ == "__main__":
    turned()
    shifted()
    finish()
