#!/usr/bin/env python3
"""Row 10: the same column along x and along y, mirrored, and shifted against the grid.

Turned and mirrored columns do the same arithmetic in another order: round-off, amplified by Newton's tolerances.  For the
shift the column floats, loaded and drained at both ends, so that no grid plane ties it to the grid; what a shift changes
must be no more than the discretisation error, that is the error against 48 cells of the worst placed column.
"""
import itertools
from pathlib import Path

import numpy as np

from common import Run, check, finish, judge, largest_difference, scratch, table

CASE = Path(__file__).parent / "cases" / "orientation.yaml"
N, WIDTH = 12, 0.05
TIGHT = ["-newton_tol_update", 1e-9]
QUICK = ["-stepper_type", "hybrid", "-stepper_adapt", "yes", "-stepper_dt", "1e-5 s", "-time_end", "0.02 s", "-output_probe_every", "0.005 s",
         "-bc_load_normal_table", "0 s,3.25 MPa,0.01 s,8.25 MPa", "-mat_sediment_kinetics_K0", "1e-6 mol/(m^2 Pa s)"]  # fmt: skip
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


def layered(axis):
    """Options that make the upper half across it a layer a thousandth as permeable, so that particles of both are in every cell (350)."""
    pair = lambda along, across: ",".join(f"{v!r} m" for v in ((along, across) if axis == 0 else (across, along)))
    return ["-materials", "sediment,tight", "-mat_tight_like", "sediment", "-mat_tight_permeability_k0", "1.53e-18 m^2", "-regions", "column,roof",
            "-region_roof_like", "column", "-region_roof_material", "tight", "-region_column_upper", pair(1.0, WIDTH / 2),
            "-region_roof_lower", pair(0.0, WIDTH / 2), "-region_roof_upper", pair(1.0, WIDTH)]  # fmt: skip


def turned(what="", layers=False, options=TIGHT):
    base = None
    for axis, mirrored in itertools.product((0, 1), (False, True)):
        run = Run.of_case(CASE, *placed(axis, mirrored), *(layered(axis) if layers else ()), *options)
        got = history(run, axis, mirrored)
        if base is None:
            base = got
            continue
        name = f"{what}along {'xy'[axis]}{', mirrored' if mirrored else ''}, against along x"
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
                      "-probe_end_at", f"{1 + x0!r} m,{WIDTH / 2} m", "-mat_sediment_kinetics_active", "no",
                      "-output_times", "500 s")  # fmt: skip
    v = run.snapshot(500.0)
    row = np.argsort(v["position"][:, 0] - v["displacement"][:, 0] + 1e-6 * v["position"][:, 1])[::2]  # the lower row
    start = (v["position"] - v["displacement"])[row, 0] - x0
    profile = np.interp(np.linspace(0.1, 0.9, 33), start, v["p"][row, 0] - 3.25e6)
    return profile, run.probe("end")["u_x_m"]


def shifted():
    shifts, fine = (0.0, 0.25, 0.5, 0.7), floating(4 * N, 0.0)
    runs = {(n, s): floating(n, s) for n in (N, 2 * N) for s in shifts}
    top = [np.max(np.abs(f)) for f in fine]
    off = lambda a, b: [np.max(np.abs(x - y)) / t for x, y, t in zip(a, b, top)]
    error = {k: off(run, fine) for k, run in runs.items()}
    change = {k: off(run, runs[k[0], 0.0]) for k, run in runs.items()}
    print("\nfloating column: error against 48 cells, and change by the shift; relative to the largest value")
    table(("cells", "shift / h", "error: profile of p", "u of the end", "change: profile of p", "u of the end"),
          [(*k, *error[k], *change[k]) for k in runs])  # fmt: skip
    for n in (N, 2 * N):
        for q, what in enumerate(("profile of p", "u of the end")):
            largest = max(error[n, s][q] for s in shifts)
            ratio = max(change[n, s][q] for s in shifts) / largest
            judge(10, f"shifted, {n} cells: change of {what} over discretisation error ({largest:.2g})", ratio, 1.1)
            if n == 2 * N:  # the ratio alone would let both grow
                judge(10, f"shifted, {n} cells: largest error of {what}, of its largest value", largest, (7e-3, 1.2e-3)[q])
                judge(10, f"shifted, {n} cells: largest change of {what}, of its largest value", max(change[n, s][q] for s in shifts), (3.5e-3, 1.2e-3)[q])
    check("errors with 24 cells over those with 12, worst shift",
          max(max(error[2 * N, s]) for s in shifts) / max(max(error[N, s]) for s in shifts), 0.3)  # fmt: skip  # 0.25 is order 2


if __name__ == "__main__":
    turned()
    turned("layers, ", True)
    turned("layers, hybrid, ", True, QUICK)
    shifted()
    finish()
