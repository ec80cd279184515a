#!/usr/bin/python3
"""Particles that leave the grid and are taken out (373): when, how many and with what momentum against free fall; masses, enthalpy and energy close with them; all
integrators; 1, 2 and 4 ranks; a restart after some have left, bit for bit; a burst that is rolled back takes back what left in it; the last one ends the run."""
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run, binary, check, check_true, finish, launch, scratch  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "thrown.yaml"
G, EDGE, END = 9.81, 2.0, 0.5
STEPS = {"sdirk2": ("-stepper_adapt", "no", "-stepper_dt", "0.01 s"), "euler": ("-stepper_adapt", "no", "-stepper_dt", "0.01 s"), "hybrid": (), "explicit": ("-mat_rock_permeability_k0", "1e-8 m^2")}  # where drag is weak


def thrown(kind, *options, **keywords):
    return Run.of_case(CASE, "-quiet", "-stepper_type", kind, *STEPS[kind], *options, **keywords)


def said(run):
    """(number, time, x, kg) of each particle that the run says has left."""
    return np.array([list(map(float, m)) for m in re.findall(r"t = (?=\S+ s: particle (\d+) of block left the grid at \((\S+), \S+\) m and is taken out, (\S+) kg)(\S+) s", run.output)])


def fall(kind, dt):
    """What leaves a free fall with steps dt until END: (times of crossing, of each particle; momentum of one kg that leaves then)."""
    t = np.arange(1, round(END / dt) + 1) * dt
    way = G * (t * (t + dt) if kind == "euler" else t * t) / 2  # backward Euler is first order
    x = 0.45 + 0.1 * np.arange(10)
    k = np.array([np.argmax(way > EDGE - s) if way[-1] > EDGE - s else -1 for s in x])
    return [(t[i], G * t[i]) for i in k if i >= 0]


for kind in STEPS:
    run = thrown(kind)
    b, first, last = run.balance, run.snapshots()[0][1], run.snapshots()[-1][1]
    mass = sum(first[f"mass_{p}"][0, 0] for p in ("solid", "hydrate", "water", "gas"))
    dt = 0.01 if kind in ("sdirk2", "euler") else b["dt_s"][-1]
    due = fall(kind, dt)
    gone = said(run)
    check(f"{kind}: particles that left", b["removed_particles"][-1], (6 * len(due), 6 * len(due)))
    check(f"{kind}: particles that are left and that left", len(last["id"]) + b["removed_particles"][-1], (len(first["id"]), len(first["id"])))
    check_true(f"{kind}: each is printed once", len(gone) == 6 * len(due) and len(set(gone[:, 0])) == len(gone) and not set(gone[:, 0]) & set(last["id"].ravel()))
    check(f"{kind}: time of leaving against free fall, s", np.max(abs(np.sort(gone[:, 3]) - np.sort(np.repeat([t for t, _ in due], 6)))), 1e-9 if dt == 0.01 else 2 * dt)
    check(f"{kind}: place of leaving, over the edge by (m)", gone[:, 1].max() - EDGE, (0.0, G * END * dt))
    check(f"{kind}: momentum that left against free fall", abs(b["removed_momentum_x_Ns"][-1] / (6 * mass * sum(v for _, v in due)) - 1), 1e-6 if dt == 0.01 else 2 * dt / 0.35)  # hydrate that forms moves things a little
    kept = sum(np.sum(last[f"mass_{m}"] * last[v][:, :1]) for m, v in (("solid", "v_s"), ("hydrate", "v_s"), ("water", "v_w"), ("gas", "v_g")))
    impulse = mass * (len(last["id"]) * G * END + 6 * sum(v for _, v in due))
    check(f"{kind}: momentum that left and is left, of the impulse of gravity", abs((b["removed_momentum_x_Ns"][-1] + kept) / impulse - 1), 1e-9 if dt == 0.01 else 2 * dt / 0.35)
    for what in ("water", "methane"):
        check(f"{kind}: {what} that left and is left", np.max(abs(b[f"{what}_error"])), 2e-14)
        check_true(f"{kind}: {what} left", b[f"removed_{what}_kg"][-1] > 0)
    for what, name in (("solid", "mass_solid"), ("hydrate", "mass_hydrate")):
        share = b[f"removed_{what}_kg"][-1] / (b["removed_particles"][-1] * first[name][0, 0])
        check(f"{kind}: {what} that left, over what those particles had at the start", abs(share - 1), 1e-12 if what == "solid" else 1e-3)
    check(f"{kind}: enthalpy that left and is left, of all", np.max(abs(b["enthalpy_error_J"])) / abs(b["enthalpy_J"][0]), 1e-6)
    check(f"{kind}: what the balance of energy leaves of gravity's work", abs(b["energy_remainder_J"][-1] / b["gravity_work_J"][-1]), 1e-3)
    given = b["gravity_work_J"][-1] - b["kinetic_lost_J"][-1]
    check(f"{kind}: kinetic energy that left and is left, of gravity's work", abs((b["kinetic_energy_J"][-1] + b["removed_kinetic_J"][-1]) / given - 1), 1e-3)
    check_true(f"{kind}: the summary counts them", f"{b['removed_particles'][-1]:.0f} particles left the grid and were taken out" in (run.out / "summary.txt").read_text())

for kind, many_ranks in (("sdirk2", (2,)), ("hybrid", (2, 4))):
    one = thrown(kind)
    for ranks in many_ranks:
        many = thrown(kind, ranks=ranks)
        a, b = one.snapshots()[-1][1], many.snapshots()[-1][1]
        check_true(f"{kind}, {ranks} ranks: the same particles are left", np.array_equal(a["id"], b["id"]) and np.array_equal(said(one)[:, :1], said(many)[:, :1]))
        check(f"{kind}, {ranks} ranks against 1: position (m)", np.max(abs(a["position"] - b["position"])), 1e-9)
        for what in ("solid_kg", "momentum_x_Ns", "enthalpy_J", "kinetic_J"):
            check(f"{kind}, {ranks} ranks against 1: removed {what}", abs(many.balance[f"removed_{what}"][-1] / one.balance[f"removed_{what}"][-1] - 1), 1e-9)
    for ranks in (1, many_ranks[-1])[: 1 + (kind == "hybrid")]:
        straight, cut = thrown(kind, "-checkpoint_every", "0.4 s", ranks=ranks), scratch() / "cut"
        half = thrown(kind, "-checkpoint_every", "0.4 s", "-stepper_max_steps", straight.steps(44 if kind == "sdirk2" else 3), ranks=ranks, out=cut)
        then, left = half.balance["time_s"][-1], half.balance["removed_particles"][-1]
        again = thrown(kind, "-checkpoint_every", "0.4 s", "-restart", cut / "checkpoint.h5", ranks=ranks, out=cut)
        check(f"{kind}, {ranks} rank(s): time of the restart (s), after {left:.0f} have left", then if left else 0.0, (0.4, 0.49))
        check_true(f"{kind}, {ranks} rank(s): a restart after some have left, bit for bit", (straight.out / "balance.csv").read_bytes() == (cut / "balance.csv").read_bytes()
                   and all(np.array_equal(v, again.snapshots()[-1][1][k]) for k, v in straight.snapshots()[-1][1].items()), f"from {then} s")  # fmt: skip

# a sea that crushes the block: a burst fails after some have left in it (the first column at 0.364 s), and is taken back
crushed = thrown("hybrid", "-ambient_pressure", "{ramp: [5 MPa, 0.6 GPa, 0.362 s, 0.562 s]}")
gone = said(crushed)
check_true("crushed: bursts are refused", "refused (" in crushed.output, crushed.output[-600:])
check("rolled back: particles that are counted, over those that left", crushed.balance["removed_particles"][-1] / len(set(gone[:, 0])), (1, 1))
check_true("rolled back: each is printed once", len(gone) == len(set(gone[:, 0])))
check("rolled back: water that left and is left", np.max(abs(crushed.balance["water_error"])), 1e-13)

for kind, ranks in (("sdirk2", 1), ("hybrid", 2)):
    empty = launch(binary(), CASE, "-quiet", "-stepper_type", kind, *STEPS[kind], "-time_end", "0.8 s", "-output_times", "0.8 s", ranks=ranks, out=scratch() / "empty")
    check_true(f"{kind}, {ranks} rank(s): the last one ends the run", empty.returncode == 3 and "the last particle has left the grid" in empty.stdout and "no particle is left in the grid.  The last checkpoint" in empty.stdout, empty.stdout[-400:])
    check_true(f"{kind}, {ranks} rank(s): ... with what to try", "What to try, in this order: a larger grid" in empty.stdout[empty.stdout.index("the last particle has left") :], empty.stdout[-400:])
stop = launch(binary(), CASE, "-quiet", "-particles_leaving", "stop", out=scratch() / "stop")
check_true("by default what leaves ends the run, and the advice names the key", stop.returncode == 3 and "left the grid" in stop.stdout and "particles: {leaving: remove}" in stop.stdout, stop.stdout[-400:])
finish()
