#!/usr/bin/env python3
"""cases/century: large-strain consolidation under a growing load, against its exact solution over 500 years."""
import numpy as np

from _ladder import CASES, Century as C
from common import Run, binary, check, check_true, finish, judge, launch, order, scratch, table

from clathra.units import YEAR  # python/, which common puts on the path

ROW = "century"


def errors(run, C=C):
    """Largest errors over the whole time: of the settlement, relative to its last value; of the pressures, relative to the load Q."""
    t = run.time[1:]
    settlement, p = C.settlement(t), C.pressure(list(C.depths.values()), t)
    off = [np.max(np.abs(run.probe(n)["p_Pa"][1:] - C.p0 - p[:, k])) / C.Q for k, n in enumerate(C.depths)]
    return np.max(np.abs(-run.probe("top")["u_y_m"][1:] - settlement)) / settlement[-1], max(off)


def thin(k, h, H):
    """Options for the permeability k, square cells of h and the uppermost H of the layer."""
    depths = {"top": 0.0, **C.of(k).depths}
    probes = [o for n, a in depths.items() for o in (f"-probe_{n}_at", f"{h / 2:.17g} m,{100 - a:.17g} m")]
    return ("-mat_clay_permeability_k0", f"{k:g} m^2", "-grid_cells", f"1,{round(H / h) + 1}", *probes,
            "-grid_lower", f"0 m,{100 - H} m", "-grid_upper", f"{h:.17g} m,{100 + h:.17g} m", "-bc_base_position", f"{100 - H} m",
            "-region_layer_lower", f"0 m,{100 - H} m", "-region_layer_upper", f"{h:.17g} m,100 m", "-bc_right_position", f"{h:.17g} m")  # fmt: skip


run = Run.of_case("century", "-quiet")
u, p = errors(run)
b = run.balance
steps = len(b["time_s"])
print(f"{steps} steps from {b['dt_s'].min():.3g} s to {b['dt_s'].max() / YEAR:.3g} years, {int(b['newton'].sum())} Newton iterations;"
      f" settlement {-run.probe('top')['u_y_m'][-1]:.3f} m")  # fmt: skip
judge(ROW, "settlement over 500 years, of the last", u, 1e-2, 0.01, "%")
judge(ROW, "pore pressure at 2, 5, 10 and 20 m over 500 years, of the load", p, 1e-2, 0.01, "%")
judge(ROW, "steps", steps, 200)
judge(ROW, "water balance", np.max(np.abs(b["water_error"])), 1e-12)

# cells
rows = []
for h in (4.0, 2.0, 1.0):
    grid = ("-grid_cells", f"1,{round(100 / h) + 1}", "-grid_upper", f"1 m,{100 + h:g} m")
    rows.append((h, *errors(Run.of_case("century", "-quiet", *grid))))
print()
table(("cell (m)", "settlement", "pressure"), rows)
print("orders of the pressure in h", *(f"{o:.2f}" for o in order([r[0] for r in rows], [r[2] for r in rows])))
check("error of the pressure, 1 m over 4 m", rows[-1][2] / rows[0][2], 0.3)

# lower permeabilities: pressure changes within a layer that thins with sqrt(k); cells and probes follow it.  For the lowest only the
# uppermost 10 m are there: at 10 m the exact solution is the load to all digits
rows = []
for k, h, H in ((1e-19, 100 / 316, 100), (1e-20, 0.1, 100), (1e-22, 0.01, 10), (1e-22, 1, 100)):
    rows.append((f"{k:g}", float(H), h, *errors(Run.of_case("century", "-quiet", *thin(k, h, H)), C.of(k))))
print()
table(("k (m2)", "thickness (m)", "cell (m)", "settlement", "pressure"), rows)
judge(ROW, "k = 1e-19, 1e-20 and 1e-22 m^2, cells of a tenth of sqrt(c T): settlement, of the last", max(r[3] for r in rows[:3]), 1e-2, 0.01, "%")
judge(ROW, "k = 1e-19, 1e-20 and 1e-22 m^2, the same: pore pressure, of the load", max(r[4] for r in rows[:3]), 1e-2, 0.01, "%")

# cut in two by a restart, it goes on to the same end
out = scratch() / "cut"
check_true("first half stops", launch(binary(), CASES / "century", "-quiet", "-stepper_max_steps", steps // 2, out=out).returncode == 0)
cut = Run.of_case("century", "-quiet", "-restart", out / "checkpoint.h5", out=out)
check("restarted in the middle: settlement at the end, relative",
      abs(cut.probe("top")["u_y_m"][-1] / run.probe("top")["u_y_m"][-1] - 1), 1e-12)  # fmt: skip
check("restarted in the middle: steps", abs(len(cut.balance["time_s"]) - steps), 0)
finish()
