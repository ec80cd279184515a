#!/usr/bin/env python3
"""cases/century_hydrate: hydrate in clay under a warming sea floor.  Balances, convergence, an independent solution of the sealed clay."""
import numpy as np

from _sealed_hydrate import BARE, BEARING, RISE, YEAR, Sealed
from common import CASES, Run, binary, check, check_true, finish, judge, launch, order, scratch, table

ROW = "century"
EVERY = ("-quiet", "-output_probe_every", "25 a")


def differences(run, fine):
    """Largest differences over the whole time: sea floor (m), pressure (MPa), temperature (K), S_h."""
    return tuple(max(np.max(np.abs(run.probe(n)[q] - fine.probe(n)[q])) / scale for n in fine.probe_names)
                 for q, scale in (("u_y_m", 1), ("p_Pa", 1e6), ("T_degC", 1), ("S_h", 1)))  # fmt: skip


def hydrate_left(run):
    return run.balance["hydrate_kg"][-1]


run = Run.of_case("century_hydrate", "-quiet")
b, top, middle = run.balance, run.probe("top")["u_y_m"], run.probe("middle")
steps = len(b["time_s"])
print(f"{steps} steps from {b['dt_s'].min():.3g} s to {b['dt_s'].max() / YEAR:.3g} years; sea floor down to {top.min():.3f} m, {top[-1]:.3f} m at the"
      f" end; hydrate {b['hydrate_kg'][0]:.0f} kg, at most {b['hydrate_kg'].max():.0f} kg, {hydrate_left(run):.0f} kg at the end")  # fmt: skip
judge(ROW, "century_hydrate: steps", steps, 300)
judge(ROW, "century_hydrate: longest over shortest step", b["dt_s"].max() / b["dt_s"].min(), (1e4, 1e9))
judge(ROW, "century_hydrate: water balance", np.max(np.abs(b["water_error"])), 1e-12)
judge(ROW, "century_hydrate: methane balance", np.max(np.abs(b["methane_error"])), 1e-12)
A1, A2, A3 = BARE.equilibrium
off = middle["p_Pa"] / (A1 * np.exp(A2 - A3 / (middle["T_degC"] + 273.15))) - 1
judge(ROW, "century_hydrate: pressure amid the hydrate off p_e(T), all times", np.max(np.abs(off)), 5e-3, 0.01, "%")

# the clay sealed: an independent solution of the conduction of heat with closed cells of hydrate, water and gas
sealed, exact = Run.of_case("century_hydrate", "-quiet", "-mat_clay_permeability_k0", "1e-23 m^2"), Sealed(cells=200, steps=250)
rows = []
for t, v in [s for s in sealed.snapshots() if s[0] > 0]:
    there = next(f for s, f in exact.found.items() if abs(s - t) < YEAR)
    a = (v["position"] - v["displacement"])[:, 1]
    inside, layer = (a > 22) & (a < 48), (a > 20) & (a < 50)
    T = np.max(np.abs(v["T"][:, 0] - np.interp(a, exact.a, there["T"]))) / RISE
    S = np.max(np.abs(v["S_h"][:, 0] - np.interp(a, exact.a, there["S_h"]))[inside])
    m = np.sum(v["mass_hydrate"][layer]), np.sum(there["m_h"][exact.bearing]) * exact.h
    rows.append((t / YEAR, T, S, *m, (m[0] - m[1]) / (30 * BEARING.masses()[1])))
print()
table(("years", "T, of 2 K", "S_h", "hydrate (kg)", "independent (kg)", "difference, of all"), rows)
judge(ROW, "century_hydrate, sealed: temperature against an independent solution, of 2 K", max(r[1] for r in rows), 1e-2, 0.01, "%")
judge(ROW, "century_hydrate, sealed: S_h, 22 to 48 m", max(r[2] for r in rows), 5e-3)
judge(ROW, "century_hydrate, sealed: hydrate of the layer, of all", max(abs(r[-1]) for r in rows), 2e-3, 0.01, "%")

# tolerance
fine = Run.of_case("century_hydrate", *EVERY, "-stepper_tol", 1e-4)
rows = []
for tol in (1e-1, 1e-2, 1e-3):
    r = Run.of_case("century_hydrate", *EVERY, "-stepper_tol", tol)
    rows.append((tol, float(len(r.balance["time_s"])), *differences(r, fine)))
print("\nlargest differences from tolerance 1e-4")
table(("tolerance", "steps", "sea floor (m)", "p (MPa)", "T (K)", "S_h"), rows)
check_true("they fall with the tolerance", np.all(np.diff([r[2:] for r in rows], axis=0) < 0))
judge(ROW, "century_hydrate: sea floor, tolerance 1e-3 against 1e-4, of its fall", rows[-1][2] / -top.min(), 2e-3, 0.01, "%")

# cells
hs, found = (2.5, 1.25, 0.625), []
for h in hs:
    grid = ("-grid_upper", "1 m,102.5 m", "-grid_cells", f"1,{round(102.5 / h)}")
    found.append(Run.of_case("century_hydrate", *EVERY, *grid))
left = np.array([hydrate_left(r) for r in found])
rows = [(h, r.probe("top")["u_y_m"].min(), r.probe("top")["u_y_m"][-1], m) for h, r, m in zip(hs, found, left)]
print()
table(("cell (m)", "lowest sea floor (m)", "sea floor at the end (m)", "hydrate left (kg)"), rows)
sea = [np.max(np.abs(a.probe("top")["u_y_m"] - b.probe("top")["u_y_m"])) for a, b in zip(found, found[1:])]
print(f"sea floor: largest difference {sea[0]:.3g} m, then {sea[1]:.3g} m: order {order((2, 1), sea)[0]:.2f};"
      f" hydrate left: {abs(left[0] - left[1]):.3g} kg, then {abs(left[1] - left[2]):.3g} kg")  # fmt: skip
judge(ROW, "century_hydrate: sea floor, cells of 1.25 m against 0.625 m, of its fall", sea[1] / -top.min(), 2e-2, 0.01, "%")
check("half the cell, smaller difference: sea floor", sea[1] / sea[0], 0.7)

# cut in two by a restart; on two ranks
out = scratch() / "cut"
cut = launch(binary(), CASES / "century_hydrate", "-quiet", "-stepper_max_steps", steps // 2, out=out)
check_true("first half stops", cut.returncode == 0)
cut = Run.of_case("century_hydrate", "-quiet", "-restart", out / "checkpoint.h5", out=out)
two = Run.of_case("century_hydrate", "-quiet", ranks=2)
for name, other, bar in (("restarted in the middle", cut, 1e-12), ("on 2 ranks", two, 1e-6)):
    check(f"{name}: sea floor at the end, of its fall", abs(other.probe("top")["u_y_m"][-1] - top[-1]) / -top.min(), bar)
    check(f"{name}: hydrate at the end, relative", abs(hydrate_left(other) / hydrate_left(run) - 1), bar)
    check(f"{name}: steps", abs(len(other.balance["time_s"]) - steps), 0)
finish()
