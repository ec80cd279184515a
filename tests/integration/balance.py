#!/usr/bin/python3
"""Ranks share the particles evenly wherever the body goes: borders between them move (docs/architecture.md, 'In parallel').

A body in the shape of an L falls through an empty grid. On 2 and 4 ranks: at most 1.1 times the mean of particles on a
rank at the end, the same answer as on one, and a restart from the middle bit for bit, though its borders are not those
that the particles there would ask for.
"""
import shutil
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import different  # noqa: E402
from common import Run, check, check_true, finish, judge, scratch, table  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "falling.yaml"
ROW = "8."
# MUMPS adds up its messages as they arrive, so its answer is not the same bit for bit; multigrid's is.
KINDS = {"sdirk2": ("-reduced_pc_type", "fieldsplit", "-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9"),
         "hybrid": ("-stepper_type", "hybrid", "-stepper_adapt", "yes")}  # fmt: skip
CUT = {"sdirk2": 40, "hybrid": 5}  # rows of the balance


def shares(run):
    """(most particles of a rank over the mean, borders between them) at the end."""
    with h5py.File(run.out / "checkpoint.h5") as file:
        count = np.bincount(file["particles/rank"][()], minlength=file.attrs["ranks"])
        return np.max(count) / np.mean(count), list(file["borders"][()])


def ends(run):
    """(time, positions) of the last good state."""
    with h5py.File(run.out / "checkpoint.h5") as file:
        return file["state/t"][0], file["particles/position"][()]


lines = []
for kind, options in KINDS.items():
    fall = lambda *more, **how: Run.of_case(CASE, "-quiet", *options, *more, **how)
    runs = {n: fall(ranks=n) for n in (1, 2, 4)}
    last = {n: run.snapshots()[-1][1] for n, run in runs.items()}
    check_true(f"{kind}: it falls", abs(np.mean(last[1]["displacement"][:, 1]) + 0.5 * 10 * 0.44**2) < 0.05, f"{np.mean(last[1]['displacement'][:, 1]):.4f} m")
    for n in (2, 4):
        most, borders = shares(runs[n])
        first = fall("-stepper_max_steps", "1", ranks=n)
        begun, before = shares(first)
        for name in ("position", "stress", "v_s"):
            check(f"{kind}, {n} ranks: {name}", np.max(np.abs(last[n][name] - last[1][name])) / np.max(np.abs(last[1][name])), 1e-9)
        judge(ROW, f"{kind}, {n} ranks: particles of the fullest over the mean, after the first step", begun, 1.1)
        judge(ROW, f"{kind}, {n} ranks: particles of the fullest over the mean, at the end", most, 1.1)
        check_true(f"{kind}, {n} ranks: borders have moved", borders != before, f"{before} and {borders}")
        lines.append([kind, n, begun, most, str(before), str(borders)])
        if (kind, n) == ("sdirk2", 2):
            continue  # implicit steps are cut on 4 ranks
        again = scratch() / f"{kind}{n}"
        fall("-stepper_max_steps", runs[n].steps(CUT[kind] - 1), ranks=n, out=again)
        cut = shutil.copytree(again, scratch() / "out")
        fall("-restart", again / "checkpoint.h5", ranks=n, out=again)
        names = different(runs[n].out, again)
        check_true(f"{kind}, {n} ranks: cut in two by a restart, the same bit for bit", not names, ", ".join(names[:5]))
    on = fall("-restart", cut / "checkpoint.h5", ranks=2, out=cut).snapshots()[-1][1]
    check(f"{kind}: begun on 4, ended on 2 ranks: position", np.max(np.abs(on["position"] - last[1]["position"])) / 4.2, 1e-9)

# What a burst that was refused leaves behind: the particles from before it belong to whom the borders say by now.
soft = [Run.of_case(CASE, "-quiet", *KINDS["hybrid"], "-mat_soft_elasticity_E0", "0.1 MPa", "-time_end", "1 s", ranks=n, exit_code=3) for n in (1, 2, 4)]
for run in soft[1:]:
    (t, a), (t_b, b) = ends(soft[0]), ends(run)
    check("bursts refused at the floor: time of the last good state", abs(t / t_b - 1), 1e-12)
    check("bursts refused at the floor: position", np.max(np.abs(a - b)) / 4.2, 1e-9)
table(["integrator", "ranks", "fullest over mean", "at the end", "borders after a step", "at the end"], lines)
finish()
