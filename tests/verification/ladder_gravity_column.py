#!/usr/bin/env python3
"""cases/gravity_column: a soft column under its own weight, against the closed form at large strain.

And orders in h."""
import numpy as np

from _ladder import CASES, GravityColumn as G
from common import Run, check, check_true, finish, judge, order, table

cells, error = (10, 20, 40), []
for n in cells:
    v = Run.of_case(CASES / "gravity_column", "-grid_cells", f"1,{n}", "-stepper_dt", 0.25).snapshots()[-1][1]
    u = v["displacement"][:, 1]
    exact, J, stress = G.solution(v["position"][:, 1] - u)
    error.append([np.max(np.abs(u - exact)) / np.max(np.abs(exact)),
                  np.sqrt(np.mean((0.5 / (1 - v["porosity"][:, 0]) / J - 1) ** 2)),
                  np.sqrt(np.mean((v["stress"][:, 1] - stress) ** 2)) / np.max(np.abs(stress))])  # fmt: skip
error = np.array(error)
columns = [x for k in range(3) for x in (error[:, k], ["", *-order(cells, error[:, k])])]
table(("cells", "u", "order", "J, rms", "order", "stress, rms", "order"), list(zip(map(float, cells), *columns)))
small = G.rho0 * G.g * G.H**2 / (2 * G.M)
print(f"settlement {-G.solution(G.H)[0]:.4f} m; linear theory {small:.4f} m")
judge("4.5", "Gravity column, 20 cells, 19 % settlement: displacement", error[1, 0], 1e-3, 0.01, "%")
judge("4.5", "Gravity column: order of the displacement in h", -order(cells, error[:, 0])[-1], (1.8, 2.3))
judge("4.5", "Gravity column, 20 cells: volume ratio, rms", error[1, 1], 1e-2, 0.01, "%")
for k, what in ((1, "volume ratio"), (2, "stress")):
    check(f"{what}: order in h", -order(cells, error[:, k])[-1], (0.9, 2.2))

steps = [Run.of_case(CASES / "gravity_column", "-stepper_dt", dt).snapshots()[-1][1]["displacement"] for dt in (1.0, 0.25)]
judge("4.5", "Gravity column: end reached in 10 and in 40 steps", np.max(np.abs(steps[0] - steps[1])) / small, 1e-3, 0.01, "%")

# the same end by hybrid with local damping, which turns the swinging column into a quasi-static one; scaled masses take longer to settle
for scaling, until in ((1, 20), (16, 80)):
    done = Run.of_case(CASES / "gravity_column", "-stepper_type", "hybrid", "-inertia", "yes", "-stepper_adapt", "yes", "-stepper_damping", 0.5,
                       "-stepper_mass_scaling", scaling, "-time_end", f"{until} s", "-output_times", f"{until} s")  # fmt: skip
    v = done.snapshots()[-1][1]
    u = v["displacement"][:, 1]
    off = np.max(np.abs(u - G.solution(v["position"][:, 1] - u)[0])) / np.max(np.abs(u))
    judge("4.5", f"Gravity column by hybrid, local damping 0.5, masses x {scaling}: displacement", off, 2e-3, 0.01, "%")
    check_true("the error of mass scaling is reported", ("mass scaling" in done.output) == (scaling > 1))
finish()
