#!/usr/bin/env python3
"""cases/century: large-strain consolidation under a growing load, against its exact solution over 500 years."""
import numpy as np

from _ladder import CASES, Century as C
from common import Run, binary, check, check_true, finish, judge, launch, order, scratch, table

ROW = "century"


def errors(run):
    """Largest errors over the whole time: of the settlement, relative to its last value; of the pressures, relative to the load Q."""
    t = run.time[1:]
    settlement, p = C.settlement(t), C.pressure(list(C.depths.values()), t)
    off = [np.max(np.abs(run.probe(n)["p_Pa"][1:] - C.p0 - p[:, k])) / C.Q for k, n in enumerate(C.depths)]
    return np.max(np.abs(-run.probe("top")["u_y_m"][1:] - settlement)) / settlement[-1], max(off)


def difference(run, fine):
    """The same against another run, with the probes written at the same times."""
    u = np.max(np.abs(run.probe("top")["u_y_m"] - fine.probe("top")["u_y_m"])) / np.max(np.abs(fine.probe("top")["u_y_m"]))
    return max(u, *(np.max(np.abs(run.probe(n)["p_Pa"] - fine.probe(n)["p_Pa"])) / C.Q for n in C.depths))


run = Run.of_case("century", "-quiet")
u, p = errors(run)
b = run.balance
steps = len(b["time_s"])
print(f"{steps} steps from {b['dt_s'].min():.3g} s to {b['dt_s'].max() / C.year:.3g} years, {int(b['newton'].sum())} Newton iterations;"
      f" settlement {-run.probe('top')['u_y_m'][-1]:.3f} m")  # fmt: skip
judge(ROW, "settlement over 500 years, of the last", u, 1e-2, 0.01, "%")
judge(ROW, "pore pressure at 2, 5, 10 and 20 m over 500 years, of the load", p, 1e-2, 0.01, "%")
judge(ROW, "steps", steps, 200)
judge(ROW, "water balance", np.max(np.abs(b["water_error"])), 1e-12)

# tolerance: what is left at 1e-1 already is not the estimated error, but the basis that stays as it is during a step in which the surface
# crosses a part of a cell, and particles that change cells; so the difference falls, but not in proportion
EVERY = ("-quiet", "-output_probe_every", f"{C.end / 20:.17g} s")
fine = Run.of_case("century", *EVERY, "-stepper_adapt", "no", "-stepper_dt", f"{C.end / 800:.17g} s")
tols, rows = (1e-1, 1e-2, 1e-3, 1e-4), []
for tol in tols:
    r = Run.of_case("century", *EVERY, "-stepper_tol", tol)
    rows.append((tol, float(len(r.balance["time_s"])), difference(r, fine)))
print("\nlargest difference of settlement and pressures from 800 equal steps")
table(("tolerance", "steps", "difference"), rows)
found = [r[-1] for r in rows]
check_true("the difference falls with the tolerance", np.all(np.diff(found) < 0))
judge(ROW, "tolerance 1e-1: difference of settlement and pressures from 800 equal steps", found[0], 3e-3)
judge(ROW, "tolerance 1e-4: difference of settlement and pressures from 800 equal steps", found[-1], 1e-3)

# cells
rows = []
for h in (4.0, 2.0, 1.0):
    grid = ("-grid_cells", f"1,{round(100 / h) + 1}", "-grid_upper", f"1 m,{100 + h:g} m")
    rows.append((h, *errors(Run.of_case("century", "-quiet", *grid))))
print()
table(("cell (m)", "settlement", "pressure"), rows)
print("orders of the pressure in h", *(f"{o:.2f}" for o in order([r[0] for r in rows], [r[2] for r in rows])))
check("error of the pressure, 1 m over 4 m", rows[-1][2] / rows[0][2], 0.3)

# cut in two by a restart, it goes on to the same end
out = scratch() / "cut"
check_true("first half stops", launch(binary(), CASES / "century", "-quiet", "-stepper_max_steps", steps // 2, out=out).returncode == 0)
cut = Run.of_case("century", "-quiet", "-restart", out / "checkpoint.h5", out=out)
check("restarted in the middle: settlement at the end, relative",
      abs(cut.probe("top")["u_y_m"][-1] / run.probe("top")["u_y_m"][-1] - 1), 1e-12)  # fmt: skip
check("restarted in the middle: steps", abs(len(cut.balance["time_s"]) - steps), 0)
finish()
