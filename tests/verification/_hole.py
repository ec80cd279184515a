"""Salencon's hole (1969): numbers of the solution, and a quarter of it in plane strain."""
from pathlib import Path

import numpy as np

from common import Run

QUARTER = Path(__file__).parent / "cases" / "hole_quarter.yaml"
P0, R0 = 30e6, 1.734998  # Pa, m
WALL = {"0 deg": 0.1216712e-3, "30 deg": 0.2810346e-3}  # m, a hundredth of that at E = 6.77793 GPa
EDGE, TENSION, FAR = 12.0122e6, 3.45e6 / np.tan(np.radians(30)), 4.0  # Pa: radial stress at R0; c cot phi; m
IMPLICIT = ("-inertia", "no", "-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "0.05 s")
HYBRID = ("-stepper_type", "hybrid", "-stepper_adapt", "yes", "-stepper_damping", 0.2)


def far_stress(p):
    """Radial stress at FAR when the wall bears p: elastic outside of the plastic zone, whose radius follows p (K_p = 3)."""
    growth = (P0 - p) if p > EDGE else (P0 - EDGE) * (EDGE + TENSION) / (p + TENSION)
    return P0 - growth / FAR**2


def arc(radius, n):
    a = np.linspace(0, np.pi / 2, n)
    points = [f"[{radius * np.cos(x):.12g} m, {radius * np.sin(x):.12g} m]" for x in (a if radius == 1.0 else a[::-1])]
    return f"[{', '.join(points)}]"


def quarter(h, hybrid=False, timeout=800):
    """Relative errors of the wall's displacement and of the plastic radius, with dilation.

    The load comes in 1 s, in hybrid in 0.03 s, ever slower, with a rest of a quarter of that.
    """
    end, n, part = 0.03 if hybrid else 1.0, round(4.4 / h), np.linspace(0, 1, 41)
    last = f"{1.25 * end if hybrid else end:g} s"
    wall = P0 * ((1 - part) ** 2 if hybrid else 1 - part)
    tables = [", ".join(f"{t * end:.8g} s, {value:.8g} Pa" for t, value in zip(part, values)) for values in (wall, [far_stress(p) for p in wall])]
    run = Run.of_case(QUARTER, "-quiet", "-grid_upper", f"{n * h:.12g} m, {n * h:.12g} m", "-grid_cells", f"{n},{n}", "-bc_wall_along", arc(1.0, 33),
                      "-bc_far_along", arc(FAR, 65), "-bc_wall_normal_table", tables[0], "-bc_far_normal_table", tables[1], "-time_end", last,
                      "-output_times", last, *(HYBRID if hybrid else IMPLICIT), timeout=timeout)  # fmt: skip
    p = run.snapshots()[-1][1]
    x, u = p["position"], p["displacement"]
    r = np.hypot(x[:, 0], x[:, 1])
    near = r < 1 + 4 * h
    inwards = -(u[near, 0] * x[near, 0] + u[near, 1] * x[near, 1]) / r[near]
    found = np.polyval(np.polyfit(r[near] - 1, inwards, 3), 0.0), r[p["plastic_work"][:, 0] > 0].max()
    return found[0] / WALL["30 deg"] - 1, found[1] / R0 - 1
