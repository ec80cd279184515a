#!/usr/bin/env python3
"""cases/century: the measured error in time falls with the tolerance over four decades.

And where it does not, on fine cells."""
import numpy as np

from _ladder import Century as C
from common import Run, check_true, finish, judge, table

ROW = "century"
ROWS_5M = ("-grid_cells", "1,21", "-grid_upper", "1 m,105 m", "-output_probe_every", f"{C.end / 5:.17g} s")
STIFF = ("-mat_clay_elasticity_E0", "10 GPa", "-mat_clay_permeability_k0", "1e-21 m^2")  # the same diffusion, a thousandth of the strain


def run(*options):
    return Run.of_case("century", "-quiet", "-output_times", "0 s", *options)


def difference(run, fine):
    """Largest difference over the whole time: of the settlement, relative to the largest, and of the pressures, relative to the load Q."""
    u = np.max(np.abs(run.probe("top")["u_y_m"] - fine.probe("top")["u_y_m"])) / np.max(np.abs(fine.probe("top")["u_y_m"]))
    return max(u, *(np.max(np.abs(run.probe(n)["p_Pa"] - fine.probe(n)["p_Pa"])) / C.Q for n in C.depths))


def study(title, tols, equal, *options, plateau=False):
    """Differences from `equal` equal steps at the tolerances `tols`, each below the one before; on a plateau the last below the first; and the steps taken."""
    fine, rows = run(*options, "-stepper_adapt", "no", "-stepper_dt", f"{C.end / equal:.17g} s"), []
    for tol in tols:
        r = run(*options, "-stepper_tol", tol)
        rows.append((tol, float(len(r.balance["time_s"])), difference(r, fine)))
    print(f"\n{title}: largest difference of settlement and pressures from {equal} equal steps")
    table(("tolerance", "steps", "difference"), rows)
    found = np.array([r[-1] for r in rows])
    check_true(f"{title}: the difference falls with the tolerance", found[-1] < found[0] if plateau else np.all(np.diff(found) < 0))
    return found, [r[1] for r in rows]


# the estimate is of the third order per step, so the error of a run goes with the tolerance to the power 2/3 where the tolerance, and not
# the growth from the first step or the rows of the probes, rules the steps: over four decades 10^(8/3) = 460
tols = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
soft, _ = study("large strain, cells of 5 m", tols, 2000, *ROWS_5M)
judge(ROW, "cells of 5 m: error in time at 1e-5 over that at 1e-1", soft[-1] / soft[0], 1e-2)
judge(ROW, "cells of 5 m: largest error in time over the tolerance, 1e-1 to 1e-5", np.max(soft / tols), 5)
stiff, _ = study("small strain, cells of 5 m", tols, 2000, *ROWS_5M, *STIFF)
judge(ROW, "a thousandth of the strain, cells of 5 m: error in time at 1e-5 over that at 1e-1", stiff[-1] / stiff[0], 0.2)

# on cells of 1 m the surface crosses three of them; while it leaves a cell that is filled to less than 0.4, the answer depends on the number
# of steps by some 1e-3, nearly as the logarithm of dt, which is not in the estimate: the difference falls, but not in proportion
ROWS_1M = ("-output_probe_every", f"{C.end / 20:.17g} s")
fine, _ = study("large strain, cells of 1 m", (1e-1, 1e-2, 1e-3, 1e-4), 800, *ROWS_1M, plateau=True)
judge(ROW, "cells of 1 m, tolerance 1e-1: difference of settlement and pressures from 800 equal steps", fine[0], 3e-3)
judge(ROW, "cells of 1 m, tolerance 1e-4: difference of settlement and pressures from 800 equal steps", fine[-1], 1e-3)

# where the surface crosses none (445), the tolerance alone says what a run is worth, on fine cells, too
total, steps = study("large strain, basis total, cells of 1 m", (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), 1600, "-basis", "total", *ROWS_1M)
judge(ROW, "basis total, cells of 1 m: error in time at 1e-6 over that at 1e-2", total[-1] / total[0], 0.1)
judge(ROW, "basis total, cells of 1 m: largest error in time, 1e-2 to 1e-6", np.max(total), 1e-3)
judge(ROW, "basis total, cells of 1 m: steps at 1e-5 over those at 1e-3", steps[3] / steps[1], 10)
finish()
