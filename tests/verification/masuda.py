#!/usr/bin/python3
"""Masuda's core against the reference curves at every 15 min to 4 h.

Section 4.4: Masuda's core against the reference curves at every 15 min to 4 h, what is left at 6 h, all of the methane.

core    cases/masuda with 30 x 4 cells (axis x radius): the radius is resolved, the capillary pressure is that of the paper
lumped  the reference's own model: a core a tenth as thick whose bath gives a tenth of the heat, so that the same heat comes
        to a volume and the radius has no say, and hardly a capillary pressure
"""
import numpy as np

from common import CASES, Run, finish, judge, read_csv, record, table
from reference import BARS, JUDGED, at_times, curves, differences, dissociated, gas_at_start, reference_at

RUNS = {
    "core": ["-grid_cells", "4,30"],
    "lumped": ["-grid_cells", "2,60", "-grid_upper", "2.54 mm, 300 mm", "-region_core_upper", "2.54 mm, 300 mm",
               "-bc_bath_alpha", "2.5 W/(m^2 K)", "-mat_berea_retention_p0", "10 Pa",
               *(w for k, y in enumerate((75, 150, 225)) for w in (f"-probe_T{k + 1}_at", f"2.54 mm, {y} mm"))],
}  # fmt: skip
SHOWN = {"itself": (0.01, "%"), "K": (1, "K"), "absolute": (1, "")}
END = 360.0  # min


def against_reference(name, run):
    reference, rows = read_csv(CASES / "masuda" / "reference" / "masuda.csv"), []
    for column, (what, how, bar) in BARS.items():
        error = differences(run, reference, column)
        k = int(np.argmax(np.abs(error)))
        scale, unit = SHOWN[how]
        judge("4.4", f"{name}: {what}", np.abs(error[k]), bar, scale, unit)
        rows.append([name, column, error[k], JUDGED[k], at_times(run, column, JUDGED[k])[0],
                     reference_at(reference, column, JUDGED[k : k + 1])[0]])  # fmt: skip
    return rows


def at_the_end(name, run):
    judge("4.4", f"{name}: pressure at 6 h less that of the outlet, relative to it",
          abs(at_times(run, "p_far_MPa", END)[0] / 2.84 - 1), 1e-4)  # fmt: skip
    for column in ("T75_C", "T150_C", "T225_C"):
        judge("4.4", f"{name}: T at {column[1:-2]} mm at 6 h less that of the bath", abs(at_times(run, column, END)[0] - 2.0), 0.05,
              1, "K")  # fmt: skip
    judge("4.4", f"{name}: S_h/S_h0 at 6 h", at_times(run, "Sh_frac", END)[0], 1e-9)
    ledgers = [np.max(np.abs(run[f"{fluid}_error"])) for fluid in ("water", "methane")]
    judge("4.4", f"{name}: water and methane balance, largest error of any step", max(ledgers), 1e-10)


def all_methane(name, run, done):
    """Free in the pores and in the hydrate at the start = produced and in the pores at the end."""
    pores, hydrate = gas_at_start()
    total = at_times(run, "total_cm3", END)[0]
    own = sum(gas_at_start(p_g=run["pg_start_Pa"]))
    print(f"{name}: methane {total:.6f} cm3 at 6 h; closed form {pores:.6f} + {hydrate:.6f} = {pores + hydrate:.6f} cm3; with the "
          f"run's first p_g, {run['pg_start_Pa']:.3f} Pa, {own:.6f} cm3")  # fmt: skip
    judge("4.4", f"{name}: all methane against the closed form with the run's first p_g, relative", abs(total / own - 1), 1e-6)
    if name == "lumped":  # p_g starts at 3.75 MPa
        judge("4.4", f"{name}: all methane against {pores + hydrate:.1f} cm3, the closed form with 3.75 MPa, relative",
              abs(total / (pores + hydrate) - 1), 1e-6)  # fmt: skip
    else:
        meters = done.csv("meters.csv")
        both = 1e6 * (meters["outlet.gas_std_m3"][-1] + meters["free_gas_std_m3"][-1])
        judge("4.4", f"{name}: gas produced and free at 6 h of meters.csv against the ledger, relative",
              abs(both / at_times(run, "gas_tot_cm3", END)[0] - 1), 1e-9)  # fmt: skip
        record("4.4", f"{name}: the same with 3.75 MPa, the mean pore pressure (p_g starts higher)", "-",
               abs(total / (pores + hydrate) - 1), True)  # fmt: skip


lines = []
for name, options in RUNS.items():
    done = Run.of_case("masuda", "-quiet", *options)
    run = curves(done.out)
    lines += against_reference(name, run)
    at_the_end(name, run)
    all_methane(name, run, done)
    print(f"{name}: 1 % of the hydrate is left at {dissociated(run, 0.01):.1f} min")
    print("\n".join(done.output.splitlines()[-5:-1]), flush=True)
table(["run", "quantity", "largest difference", "at (min)", "Clathra", "reference"], lines)
finish()
