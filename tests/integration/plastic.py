#!/usr/bin/env python3
"""A footing on a softening Mohr-Coulomb block, with sdirk2 and hybrid: the same on 1, 2 and 4 ranks, a restart in the
middle of the plastic flow bit for bit, the heat of plastic work in the balance of heat, and both integrators against
each other; and all that where the plastic strain of neighbours softens (nonlocal_length).
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run, check, check_true, finish, scratch, table  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "footing.yaml"
KINDS = {
    "sdirk2": ("-newton_tol_residual", "1e-11", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10"),
    "hybrid": ("-stepper_type", "hybrid", "-stepper_adapt", "yes"),
}
CUT = {"sdirk2": 11, "hybrid": 256}  # steps
NONLOCAL = ("-mat_soil_plasticity_nonlocal_length", "0.6 m", "-mat_soil_plasticity_eta_s", "50")


def footing(kind, *options, **keywords):
    return Run.of_case(CASE, "-quiet", *KINDS[kind], *options, **keywords)


def difference(a, b):
    """Largest difference of the last snapshots over the size of each variable, and which."""
    x, y = a.snapshots()[-1][1], b.snapshots()[-1][1]
    worst = {name: np.max(np.abs(x[name] - y[name])) / (np.max(np.abs(x[name])) or 1.0) for name in x if name != "yield"}
    name = max(worst, key=worst.get)
    return worst[name], name


def reproduced(kind, *options):
    """One run and its last snapshot; on more ranks, and cut in two, it is the same."""
    words = f"{kind}{', nonlocal' if options else ''}"
    one = footing(kind, *options)
    last = one.snapshots()[-1][1]
    for n in (2, 4):
        value, where = difference(one, footing(kind, *options, ranks=n))
        check(f"{words}: {n} ranks against 1, {where}", value, 1e-7)
    out = scratch() / "out"
    footing(kind, *options, "-stepper_max_steps", CUT[kind], out=out)
    two = footing(kind, *options, "-restart", out / "checkpoint.h5", out=out)
    same = all(np.array_equal(v, two.snapshots()[-1][1][name]) for name, v in last.items())
    check_true(f"{words}: a restart in plastic flow, bit for bit", same and all((one.out / f).read_bytes() == (out / f).read_bytes() for f in ("probes.csv", "balance.csv")))
    return one, last


rows, runs = [], {}
said = footing("sdirk2", "-mat_soil_plasticity_dilation_max", "60 deg", "-stepper_max_steps", "1").output
check_true("dilation above friction: a warning with both", "material soil dilates more than it rubs (dilation_max 60 deg > friction_peak" in said)
check_true("... and the strength at the start is printed", "starts with cohesion" in said and "dilation 60 deg" in said)
for kind in KINDS:
    one, last = reproduced(kind)
    runs[kind] = one
    work, pending = last["plastic_work"].sum(), last["plastic_heat"].sum()
    gain = one.balance["heat_J"][-1]
    check(f"{kind}: heat gained against the share of the plastic work", abs(gain + pending - 0.7 * work) / work, 1e-10)
    check(f"{kind}: share of particles that yield at the end", np.mean(last["yield"] > 0), (0.1, 1.0))
    check(f"{kind}: plastic work is never negative", -last["plastic_work"].min(), 0.0)
    rows.append([kind, last["eps_d_p"].max(), work, gain, one.probe("p")["u_y_m"][-1]])
out = scratch() / "out"  # heat that hybrid's last step leaves for the next one, which is implicit
left = footing("hybrid", "-time_end", "0.36 s", "-output_times", "0 s,0.36 s", out=out).snapshots()[-1][1]["plastic_heat"].sum()
both = footing("sdirk2", "-restart", out / "checkpoint.h5", out=out)
work, pending, gain = (*(both.snapshots()[-1][1][name].sum() for name in ("plastic_work", "plastic_heat")), both.balance["heat_J"][-1])
check("hybrid, then sdirk2: heat gained against the share of the plastic work", abs(gain + pending - 0.7 * work) / work, 1e-10)
check("hybrid, then sdirk2: share of the work whose heat was left between them", left / work, (1e-6, 1.0))
table(["integrator", "largest eps_d_p", "plastic work (J)", "heat (J)", "settlement (m)"], rows)
a, b = (runs[k].probe("p")["u_y_m"][-1] for k in KINDS)
check("hybrid against sdirk2: settlement", abs(b / a - 1), 0.05)
check("hybrid against sdirk2: plastic work", abs(rows[1][2] / rows[0][2] - 1), 0.1)
strains = {}
for kind in KINDS:
    one, last = reproduced(kind, *NONLOCAL)
    own, around, V = (last[name][:, 0] for name in ("eps_d_p", "eps_d_p_nonlocal", "volume"))
    strains[kind] = own, around
    check(f"{kind}, nonlocal: averages keep the sum of the plastic strain", abs(np.sum(V * around) / np.sum(V * own) - 1), 0.15)
    check(f"{kind}, nonlocal: largest average over largest plastic strain", around.max() / own.max(), (0.2, 0.95))
check("hybrid against sdirk2, nonlocal: plastic strain", np.max(np.abs(strains["hybrid"][1] - strains["sdirk2"][1])) / strains["sdirk2"][1].max(), 0.1)
finish()
