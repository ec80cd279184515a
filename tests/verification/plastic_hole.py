#!/usr/bin/env python3
"""Salencon's hole (1969) in Mohr-Coulomb ground, classical flow with and without dilation: stresses, radius of the
plastic zone, displacement of the wall on three grids; implicit, about an axis, where the hoop stress is a principal
stress of its own.  The exact ground is infinite, this one ends at 41 radii.  Then a quarter of it in plane strain on a
grid of squares, implicit and in hybrid, with dilation: without it bands form in the plane, and the solution is not the only one.
"""
from pathlib import Path

import numpy as np

from common import Run, check, finish, judge, order, table

CASE = Path(__file__).parent / "cases" / "hole.yaml"
QUARTER = CASE.with_name("hole_quarter.yaml")
P0, R0 = 30e6, 1.734998
R = np.array([1.2, 1.5, 2.0, 3.0, 5.0])
RADIAL = np.array([2.6293, 7.4695, 16.4632, 23.9836, 27.8341]) * 1e6
HOOP = np.array([19.8389, 34.3596, 43.5368, 36.0164, 32.1659]) * 1e6
WALL = {"0 deg": 0.1216712e-3, "30 deg": 0.2810346e-3}  # m, a hundredth of that at E = 6.77793 GPa


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
EDGE, TENSION, FAR = 12.0122e6, 3.45e6 / np.tan(np.radians(30)), 4.0  # Pa: radial stress at R0; c cot phi; m


def far_stress(p):
    """Radial stress at FAR when the wall bears p: elastic outside of the plastic zone, whose radius follows p (K_p = 3)."""
    growth = (P0 - p) if p > EDGE else (P0 - EDGE) * (EDGE + TENSION) / (p + TENSION)
    return P0 - growth / FAR**2


def arc(radius, n):
    a = np.linspace(0, np.pi / 2, n)
    points = [f"[{radius * np.cos(x):.12g} m, {radius * np.sin(x):.12g} m]" for x in (a if radius == 1.0 else a[::-1])]
    return f"[{', '.join(points)}]"


def quarter(h, *options, end=1.0, rest=0.0, slows=False):
    """Displacement of the wall inwards (m) and outermost radius that yielded (m); the load comes in `end` seconds, ever slower if it slows."""
    n = round(4.4 / h)
    part = np.linspace(0, 1, 41)
    wall = P0 * ((1 - part) ** 2 if slows else 1 - part)
    tables = [", ".join(f"{t * end:.8g} s, {value:.8g} Pa" for t, value in zip(part, values)) for values in (wall, [far_stress(p) for p in wall])]
    run = Run.of_case(QUARTER, "-quiet", "-grid_upper", f"{n * h:.12g} m, {n * h:.12g} m", "-grid_cells", f"{n},{n}", "-bc_wall_along", arc(1.0, 33),
                      "-bc_far_along", arc(FAR, 65), "-bc_wall_normal_table", tables[0], "-bc_far_normal_table", tables[1], "-time_end", f"{end + rest} s",
                      "-output_times", f"{end + rest} s", *options)  # fmt: skip
    p = run.snapshots()[-1][1]
    x, u = p["position"], p["displacement"]
    r = np.hypot(x[:, 0], x[:, 1])
    near = r < 1 + 4 * h
    inwards = -(u[near, 0] * x[near, 0] + u[near, 1] * x[near, 1]) / r[near]
    return np.polyval(np.polyfit(r[near] - 1, inwards, 3), 0.0), r[p["plastic_work"][:, 0] > 0].max()


plane, sizes = [], (0.2, 0.1)
for h in sizes:
    implicit = quarter(h, "-inertia", "no", "-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "0.05 s")
    hybrid = quarter(h, "-stepper_type", "hybrid", "-stepper_adapt", "yes", "-stepper_damping", 0.2, end=0.03, rest=0.0075, slows=True)
    plane.append([h, *(f(v) for v in (implicit, hybrid) for f in (lambda v: v[0] / WALL["30 deg"] - 1, lambda v: v[1] / R0 - 1))])
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
