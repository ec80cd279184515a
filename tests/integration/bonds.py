#!/usr/bin/env python3
"""Hydrate with a stress of its own (stiffness_change: bonds) in a whole scene: cycles of hydrate at constant load against
the other forms, hybrid against sdirk2, steps of sdirk2 while hydrate goes, ranks, restart; elastic and with Mohr-Coulomb.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run, check, check_true, finish, scratch, table  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "bonds.yaml"
MAT = "-mat_sand_"
FORM = f"{MAT}elasticity_stiffness_change"
TIGHT = ("-newton_tol_residual", "1e-11", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10")
HYBRID = ("-inertia", "yes", "-stepper_type", "hybrid", "-stepper_adapt", "yes")
PLASTIC = tuple(f"{MAT}plasticity_{k}" if n % 2 == 0 else k for n, k in enumerate(
    ("law", "mohr_coulomb", "cohesion_max", "200 kPa", "cohesion_residual", "150 kPa", "friction_peak", "12 deg", "dilation_max", "4 deg",
     "eta_s", "5")))  # fmt: skip


def block(*options, **keywords):
    return Run.of_case(CASE, "-quiet", *options, **keywords)


def lost(run, q=2e6, E_0=200e6, E_h=2e9, nu=0.25):
    """How a block under q (Pa) comes down while the hydrate of a cycle goes, off what Hooke's law makes of it, and what it moves while hydrate comes; of that."""
    t, e, S = run.time, np.log1p(run.probe("end")["u_x_m"]), run.probe("end")["S_h"]
    M = (1 - nu) / ((1 + nu) * (1 - 2 * nu)) * (E_0 + E_h * S)
    off, back = 0.0, 0.0
    for start, end in zip([0.4, *gone], gone):
        cycle = np.flatnonzero((t >= start) & (t <= end))
        most = cycle[np.argmax(S[cycle])]
        want = q * (1 / M[most] - 1 / M[cycle[-1]])
        off = max(off, abs((e[cycle[-1]] - e[most]) / want - 1))
        if start > 0.4:
            back = max(back, abs((e[most] - e[cycle[0]]) / want))
    return off, back


# complete cycles: where the block is whenever its hydrate is gone, mm
gone, rows, place = 1.39 + 2 * np.arange(5), [], {}
for form in ("both", "loss_only", "bonds"):
    run = block(FORM, form, f"{MAT}kinetics_K0", "2e-7 mol/(m^2 Pa s)")
    place[form] = 1e3 * run.at("end", "u_x_m", gone)
    check(f"{form}: hydrate is gone in every cycle", np.max(run.at("end", "S_h", gone)), 1e-6)
    if form == "loss_only":
        off, back = lost(run)
        check("loss_only: strain of each loss off q (1/M - 1/M_0), of it", off, 0.01)
        check("loss_only: strain while hydrate comes, of that", back, 0.03)
    rows.append([form, *place[form]])
table(["form", *(f"{t:g} s (mm)" for t in gone)], rows)
check("bonds: drift over five cycles at constant load (mm)", np.ptp(place["bonds"]), 0.02)
check("loss_only: least drift of a cycle (mm)", np.max(np.diff(place["loss_only"])), -3.0)
check_true("only bonds hold a stress of the hydrate", "stress_hydrate" in run.snapshots()[-1][1]
           and "stress_hydrate" not in block(FORM, "both", "-time_end", "0.1 s", "-output_times", "0.1 s").snapshots()[-1][1])  # fmt: skip


def difference(a, b):
    """Largest difference of the last snapshots over the size of each variable (of the stress for the distance to yield, which is round-off in flow), and which."""
    x, y = a.snapshots()[-1][1], b.snapshots()[-1][1]
    size = {n: np.max(np.abs(x["stress" if n == "yield_distance" else n])) or 1.0 for n in x}
    worst = {n: np.max(np.abs(x[n] - y[n])) / size[n] for n in x if n != "yield" and not n.startswith(("v_", "grad", "mixed", "rate"))}
    name = max(worst, key=worst.get)
    return worst[name], name


# hydrate goes from the start, under a load that grows
SHORT = ("-bc_warm_temperature", "7 degC", "-region_cell_temperature", "7 degC", "-time_end", "0.4 s", "-output_times", "0.4 s")
COARSE = ("-grid_cells", "6,2")
FIXED = (*TIGHT, "-stepper_adapt", "no", "-stepper_dt")
for name, law in (("elastic", ()), ("Mohr-Coulomb", PLASTIC)):
    runs = {"sdirk2": block(*law, *TIGHT, *COARSE), "hybrid": block(*law, *HYBRID, *COARSE)}
    a, b = (r.probe("end")["u_x_m"][-1] for r in runs.values())
    check(f"{name}: hybrid against sdirk2, settlement after five cycles", abs(b / a - 1), 1e-3)
    if law:
        last = runs["hybrid"].snapshots()[-1][1]
        check("Mohr-Coulomb: plastic strain", last["eps_d_p"].max(), (1e-4, 0.1))
    for kind, options, row, n in (("sdirk2", (*FIXED, "0.02 s"), 11, 2 if law else 4), ("hybrid", HYBRID, 3, 4 if law else 2)):
        one = block(*law, *options, *SHORT)
        value, where = difference(one, block(*law, *options, *SHORT, ranks=n))
        check(f"{name}, {kind}: {n} ranks against 1, {where}", value, 1e-6)
        out = scratch() / "out"
        block(*law, *options, *SHORT, "-stepper_max_steps", one.steps(row - 1), out=out)
        two = block(*law, *options, *SHORT, "-restart", out / "checkpoint.h5", out=out)
        same = all(np.array_equal(v, two.snapshots()[-1][1][k]) for k, v in one.snapshots()[-1][1].items())
        check_true(f"{name}, {kind}: a restart while hydrate goes, bit for bit", same)

    def settlement(n):
        return block(*law, *FIXED, f"{0.4 / n:.17g} s", *SHORT).probe("end")["u_x_m"][-1]

    change = abs(settlement(32) / settlement(16) - 1)  # without starred states: 1e-2; its order: tests/unit/test_bonds.c
    check(f"{name}: sdirk2 while hydrate goes, 16 against 32 steps", change, 1e-4)
finish()
