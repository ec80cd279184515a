#!/usr/bin/env python3
"""cases/buckley_leverett: a front of saturation, in the plane and about an axis.

How far off the front is and S behind it (456): over h, particles a cell and capillary pressure; the grid shifted, axes exchanged, ranks."""
import numpy as np

from _ladder import CASES, BuckleyLeverett as B
from common import Run, check, finish, judge, order, table

CASE, END, R0, R1 = CASES / "buckley_leverett", 1e4, 0.1, 1.1
TWO = 2.0  # cells behind the front from where S counts
RADIAL = ("-geometry", "axisymmetric", "-grid_lower", f"{R0} m,0 m", "-grid_upper", f"{R1} m,0.02 m", "-region_strip_lower", f"{R0} m,0 m",
          "-region_strip_upper", f"{R1} m,0.02 m", "-bc_inlet_water", "4e-5 m/s", "-probe_middle_at", "0.6 m,0.01 m")  # fmt: skip
ALONG_Y = ("-grid_upper", "0.02 m,1 m", "-region_strip_upper", "0.02 m,1 m", "-bc_inlet_side", "bottom", "-bc_outlet_side", "top", "-bc_bottom_axis", "x",
           "-bc_top_axis", "x", "-probe_middle_at", "0.01 m,0.5 m")  # fmt: skip


def errors(run, cells, of=lambda x: x, back=lambda x: x, t=END, axis=0):
    """Front's error in cells, largest error of S two cells behind the front and farther, mean error, S's range; of(x): the place in
    the plane that is reached as soon as x, back: its inverse."""
    v = run.snapshot(t)
    x, across = v["position"][:, axis], v["position"][:, 1 - axis]
    row = np.flatnonzero(across < np.mean(across))
    row = row[np.argsort(x[row])]
    x, S, front, h = x[row], v["S_w"][row, 0], float(back(B.exact.front(END))), 1 / cells
    off = np.abs(S - B.exact.saturation(of(x), END))
    return np.array([(B.front(x, S) - front) / h, np.max(off[x < front - TWO * h]), np.mean(off), S.max(), S.min()])


def plane(cells, *options, ranks=1):
    run = Run.of_case(CASE, "-grid_cells", f"{cells},1", "-stepper_dt", 1500 / cells, *options, ranks=ranks)
    return errors(run, cells), run


def radial(cells):
    run = Run.of_case(CASE, "-grid_cells", f"{cells},1", "-stepper_dt", 1500 / cells, *RADIAL)
    return errors(run, cells, lambda r: (r * r - R0 * R0) / (2 * R0) / 4, lambda x: np.sqrt(R0 * R0 + 2 * R0 * 4 * x)), run


def shifted(part):
    """The body begins so much of a cell right of a line."""
    h = 1 / 50
    return plane(50, "-grid_lower", f"{-part * h} m,0 m", "-grid_upper", f"{1 + (1 - part) * h} m,0.02 m", "-grid_cells", "51,1")[0]


CELLS, head = (25, 50, 100), ("cells", "front off (cells)", "S behind it", "mean", "largest (0.9)", "smallest (0.1)")
for name, scene in (("plane", plane), ("radial", radial)):
    got = [scene(n) for n in CELLS]
    e = np.array([g[0] for g in got])
    print(f"{name}: orders of the mean error in h", *(f"{o:.2f}" for o in -order(CELLS, e[:, 2])))
    table(head, [(float(n), *row) for n, row in zip(CELLS, e)])
    for n, row in list(zip(CELLS, e))[1:]:
        judge("4.5", f"Buckley-Leverett, {name}, {n} cells: front off, cells", abs(row[0]), 0.7)
        judge("4.5", f"Buckley-Leverett, {name}, {n} cells: largest error of S two cells behind the front and farther", row[1], 0.025)
        judge("4.5", f"Buckley-Leverett, {name}, {n} cells: S beyond what flows in", max(row[3] - 0.9, 0.0), 1e-3)
    judge("4.5", f"Buckley-Leverett, {name}: order of the mean error in h", -order(CELLS, e[:, 2])[-1], (0.6, 1.5))
    check(f"{name}: water balance", np.max(np.abs(got[-1][1].balance["water_error"])), 1e-12)
    if name == "plane":
        middle = e[1]

rows = []
for name, e in (("1 particle along the flow", plane(50, "-region_strip_particles_per_cell", "1,2")[0]), ("3 particles", plane(50, "-region_strip_particles_per_cell", "3,2")[0]),
                ("p0 = 0.1 kPa", plane(50, "-mat_sand_retention_p0", "0.1 kPa")[0]), ("grid shifted by a quarter of a cell", shifted(0.25)),
                ("by half", shifted(0.5))):  # fmt: skip
    rows.append((name, *e))
    judge("4.5", f"Buckley-Leverett, 50 cells, {name}: front off, cells", abs(e[0]), 0.9)
    judge("4.5", "... largest error of S", e[1], 0.04)
table(head, rows)
# Where p0 is 0.5 % of the drop of pressure, what Newton's tolerance of a row of mass leaves is as much of S.
one, two = (plane(25, ranks=n)[1].snapshot(END)["S_w"] for n in (1, 2))
judge("4.5", "Buckley-Leverett, 1 and 2 ranks: S", np.max(np.abs(two - one)), 1e-5)
turned = Run.of_case(CASE, "-stepper_dt", 30, *ALONG_Y, "-grid_cells", "1,50")
judge("4.5", "Buckley-Leverett, along y: front and S", np.max(np.abs(errors(turned, 50, axis=1) - middle)), 1e-6)
finish()
