#!/usr/bin/python3
"""BP2, both cases, against the curves of an independent finite-volume code.

BP2, both cases, against the curves of an independent finite-volume code at every 20 s (rows 1 and 2), and the water
and methane ledgers of these runs (row 7).

The front of hydrate at 1000 s against the same code, in the coordinates of the start: five places 1 cm apart.

Row 1: the case as it stands (50 cells, 4 particles a cell).  Row 2: 100 cells and a tighter tolerance, half the bars.
Displacement and hydrate saturation are judged by their peaks, p by the value itself, T in kelvin.
"""
import numpy as np

from common import CASES, Run, finish, judge, read_csv, table

OFF = ("-mat_sediment_kinetics_active", "no")
FINE = ("-grid_cells", "104,1", "-stepper_tol", "2e-4")
PERCENT = (0.01, "%")
# name: (probe, quantity, reference column, factor to the reference's unit, how judged, bar of row 1, unit shown)
CURVES = {
    "p at 0.6 m": ("p06", "p_Pa", "p_MPa", 1e-6, "itself", 0.01, PERCENT),
    "displacement of the loaded end": ("surface", "u_x_m", "u_mm", 1e3, "peak", 0.015, PERCENT),
    "S_h at 0.6 m": ("p06", "S_h", "Sh", 1, "peak", 0.02, PERCENT),
    "T at 0.6 m": ("p06", "T_degC", "T_C", 1, "absolute", 0.03, (1, "K")),
}


def at_reference_times(run, probe, quantity, times):
    """Rows of the probe at these times, which the run must have hit."""
    rows = [int(np.argmin(np.abs(run.time - t))) for t in times]
    if not np.allclose(run.time[rows], times, rtol=1e-9, atol=1e-6):
        raise ValueError("a reference time is not among the probe's rows")
    return run.probe(probe)[quantity][rows]


def difference(values, want, how):
    """Largest difference and its place in the list."""
    size = {"itself": np.abs(want), "peak": np.max(np.abs(want)), "absolute": 1.0}[how]
    error = np.abs(values - want) / size
    return np.max(error), int(np.argmax(error))


def front(run, cells, off, rise):
    """S_h of the particles ahead of x = 0.9 m at 1000 s: off the reference, and up again towards the end, of the peak."""
    want, v = read_csv(CASES / "bp2" / "reference" / "bp2_case2_front.csv"), run.snapshot(1000.0)
    x0, Sh = v["initial_position"][:, 0], v["S_h"].ravel()
    x = np.unique(np.round(x0, 9))
    mean = np.array([Sh[np.abs(x0 - place) < 1e-8].mean() for place in x])
    got, peak = np.interp(want["x0_m"], x, mean), mean.max()
    table(("x at the start (m)", "S_h", "reference", "off, of the peak"), zip(want["x0_m"], got, want["Sh"], (got - want["Sh"]) / peak))
    judge(1 if cells == 50 else 2, f"BP2 case 2, {cells} cells: S_h at its front at 1000 s, of the peak", np.max(np.abs(got - want["Sh"])) / peak, off, *PERCENT)
    judge(1 if cells == 50 else 2, f"BP2 case 2, {cells} cells: S_h rises again beyond 0.9 m, of the peak", max(0.0, np.max(np.diff(mean[x > 0.9]))) / peak, rise, *PERCENT)


def compare(case, row, factor, *options):
    """Runs a case, judges its curves with `factor` times the bars and its ledgers; returns rows of the table."""
    run = Run.of_case("bp2", "-quiet", *options, *(OFF if case == 1 else ()))
    reference, lines = read_csv(CASES / "bp2" / "reference" / f"bp2_case{case}.csv"), []
    cells = 50 if row == 1 else 100
    for name, (probe, quantity, column, unit, how, bar, (scale, mark)) in CURVES.items():
        if case == 1 and column in ("Sh", "T_C"):
            continue  # no hydrate, no heat
        values = at_reference_times(run, probe, quantity, reference["t_s"]) * unit
        error, k = difference(values, reference[column], how)
        judge(row, f"BP2 case {case}, {cells} cells: {name}", error, factor * bar, scale, mark)
        lines.append([str(cells), str(case), name, f"{error / scale:.3g} {mark}", f"{factor * bar / scale:g} {mark}",
                      f"{reference['t_s'][k]:g}", values[k], reference[column][k]])  # fmt: skip
    for fluid in ("water", "methane"):
        judge(7, f"{fluid} balance, BP2 case {case}, {cells} cells, every step of {len(run.balance['step'])}",
              np.max(np.abs(run.balance[f"{fluid}_error"])), 1e-10)  # fmt: skip
    if case == 2:
        front(run, cells, *((0.18, 0.04) if row == 1 else (0.03, 0.025)))
    print("\n".join(run.output.splitlines()[-5:-1]), flush=True)
    return lines


lines = []
for case in (1, 2):
    lines += compare(case, 1, 1.0)
for case in (1, 2):
    lines += compare(case, 2, 0.5, *FINE)
table(["cells", "case", "quantity", "largest difference", "bar", "at (s)", "Clathra", "reference"], lines)
finish()
