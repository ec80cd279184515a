#!/usr/bin/env python3
"""Salencon's hole in Mohr-Coulomb ground, with and without dilation, on three grids.

Salencon's hole (1969) in Mohr-Coulomb ground, classical flow with and without dilation: stresses, radius of the
plastic zone, displacement of the wall on three grids; implicit, about an axis, where the hoop stress is a principal
stress of its own.  The exact ground is infinite, this one ends at 41 radii.  Then a quarter of it in plane strain on a
grid of squares, implicit and in hybrid, with dilation: without it bands form in the plane, and the solution is not the only one.
"""
from pathlib import Path

import numpy as np

from _hole import P0, R0, WALL, quarter
from common import Run, check, finish, judge, order, table

CASE = Path(__file__).parent / "cases" / "hole.yaml"
R = np.array([1.2, 1.5, 2.0, 3.0, 5.0])
RADIAL = np.array([2.6293, 7.4695, 16.4632, 23.9836, 27.8341]) * 1e6
HOOP = np.array([19.8389, 34.3596, 43.5368, 36.0164, 32.1659]) * 1e6


def stress(x, s, r, inside):
    """Values at radii r, linear between particles on one side of the edge of the plastic zone (a kink of the hoop stress)."""
    out = np.empty_like(r)
    for zone in (True, False):
        here = (r < R0) == zone
        mine = inside == zone
        out[here] = np.interp(r[here], x[mine], s[mine])
    return out


rows = []
for dilation, wall in WALL.items():
    errors, sizes = [], (0.1, 0.05, 0.025)
    for h in sizes:
        n = round(40.1 / h)
        run = Run.of_case(CASE, "-quiet", "-grid_lower", f"{1 - h:.17g} m, 0 m", "-grid_upper", f"{1 - h + n * h:.17g} m, {h} m", "-grid_cells", f"{n},1",
                          "-region_ring_upper", f"41 m, {h} m", "-bc_top_position", f"{h} m", "-mat_rock_plasticity_dilation_max", dilation)  # fmt: skip
        p = run.snapshots()[-1][1]
        x, u, s = p["position"][:, 0], p["displacement"][:, 0], -p["stress"]
        inside = p["yield"][:, 0] > 0
        radial, hoop = stress(x, s[:, 0], R, inside), stress(x, s[:, 2], R, inside)
        edge = x[inside].max() + 0.25 * h
        found = -np.polyval(np.polyfit(x[:4], u[:4], 2), 1.0)
        error = [np.abs(radial - RADIAL).max() / P0, np.abs(hoop - HOOP).max() / P0, abs(edge / R0 - 1), abs(found / wall - 1)]
        errors.append(error)
        rows.append([dilation, h, *error])
    judge("strength", f"Salencon's hole, dilation {dilation}: radial stress, h = a/40", errors[-1][0], 0.01)
    judge("strength", f"Salencon's hole, dilation {dilation}: hoop stress, h = a/40", errors[-1][1], 0.02)
    judge("strength", f"Salencon's hole, dilation {dilation}: radius of the plastic zone, h = a/40", errors[-1][2], 0.02)
    judge("strength", f"Salencon's hole, dilation {dilation}: displacement of the wall, h = a/40", errors[-1][3], 0.01)
    check("order of the radial stress", order(sizes, [e[0] for e in errors])[0], (0.7, 3.0))

# ---------------------------------------------------------------------------------------- a quarter in plane strain
plane, sizes = [], (0.2, 0.1)
for h in sizes:
    plane.append([h, *quarter(h, hybrid=False), *quarter(h, hybrid=True)])
print("\nquarter in plane strain, relative errors")
table(["h (m)", "wall, implicit", "R0", "wall, hybrid", "R0"], plane)
for name, k in (("implicit", 1), ("hybrid", 3)):
    judge("strength", f"Salencon's hole in plane strain, {name}: displacement of the wall, h = a/10", abs(plane[-1][k]), 0.05)
    judge("strength", f"Salencon's hole in plane strain, {name}: radius of the plastic zone, h = a/10", abs(plane[-1][k + 1]), 0.02)
    check("order of the wall's displacement", order(sizes, [abs(row[k]) for row in plane])[0], (0.8, 3.0))
judge("strength", "Salencon's hole in plane strain, hybrid against implicit: displacement of the wall, h = a/10", abs(plane[-1][3] - plane[-1][1]), 0.005)
print()
table(["dilation", "h (m)", "radial stress / p0", "hoop stress / p0", "plastic radius", "wall displacement"], rows)
finish()
