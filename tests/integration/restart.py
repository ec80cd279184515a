#!/usr/bin/python3
"""A run cut in two by a restart equals the straight run bit for bit.

A run cut in two by a restart equals the straight run bit for bit (row 15), on 1 and on 2 ranks; on another number of
ranks it continues to rtol 1e-9.

On 2 ranks the linear solver is that of options/krylov.opts.  MUMPS, the default there, adds contributions in the order
in which messages arrive: the same run twice differs in the last digits, most of all on a busy machine, restart or not.

Damaged and foreign checkpoints are refused and nothing is written.

The scene is BP2 case 2 on 26 cells with a load that turns at 150 s (a kink), up to 300 s, with adaptive steps.  It is
cut where -stepper_max_steps ends it: at any step, on none of the times that the run must hit, and also at the kink.
-time_end could cut it as well, but only at a time that is an event of the straight run, since the run steps onto its
end; the defaults of stepper_dt, stepper_dt_min and stepper_dt_max follow time_end too.
"""
import shutil
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import different, hashes  # noqa: E402
from common import CASES, ROOT, Run, binary, check_true, finish, judge, launch, record, scratch, table  # noqa: E402

OPTIONS = ("-quiet", "-grid_cells", "26,1", "-time_end", "300 s", "-stepper_dt_max", "15 s",
           "-bc_load_normal_table", "0 s,3.25 MPa,150 s,7.25 MPa,300 s,3.25 MPa",
           "-output_times", "0 s,100 s,200 s,300 s", "-checkpoint_every", "120 s",
           "-meters", "outlet,base", "-meter_outlet_side", "right", "-meter_base_side", "left")  # fmt: skip
REPRODUCIBLE = {1: (), 2: ("-options_file", str(ROOT / "options" / "krylov.opts"))}
lines = []


def bp2(*options, **keywords):
    return Run.of_case("bp2", *OPTIONS, *options, **keywords)


def same_bits(*options, ranks=1, **keywords):
    return bp2(*REPRODUCIBLE[ranks], *options, ranks=ranks, **keywords)


def state(path, name):
    with h5py.File(path, "r") as file:
        return file["state"][name][()].ravel()[0]


def cut_in_two(straight, ranks, steps):
    """Stops after `steps` steps, goes on in the same folder, compares all that is left."""
    out = scratch() / "out"
    same_bits("-stepper_max_steps", steps, ranks=ranks, out=out)
    t = state(out / "checkpoint.h5", "t")
    same_bits("-restart", out / "checkpoint.h5", ranks=ranks, out=out)
    names = different(straight.out, out)
    what = f"cut after step {steps} (t = {t:.4g} s), {ranks} rank{'s' * (ranks > 1)}: the same bit for bit"
    check_true(what, not names, ", ".join(names[:5]))
    record(15, what, "0 bits differ", f"{len(names)} datasets differ" if names else "0 bits differ", not names)
    lines.append([ranks, steps, t, len(names)])


def kink_step(run):
    return int(run.balance["step"][np.argmin(np.abs(run.balance["time_s"] - 150))])


straight = {ranks: same_bits(ranks=ranks) for ranks in (1, 2)}
for ranks, run in straight.items():
    meters, out = run.csv("meters.csv"), run.balance["water_out_kg"][-1]
    check_true(f"the meters count what leaves, {ranks} rank(s)",
               abs(meters["outlet.water_kg"][-1] - out) < 1e-14 * abs(out) and np.all(meters["base.water_kg"] == 0))  # fmt: skip
for ranks, run in straight.items():
    last = int(run.balance["step"][-1])
    for steps in (3, kink_step(run), last - 4) if ranks == 1 else (last // 3,):
        cut_in_two(run, ranks, steps)
table(["ranks", "cut after step", "at (s)", "datasets that differ"], lines)

# -time_end at an event of the straight run cuts it as well; the first run's own files are continued.
out = scratch() / "out"
bp2("-time_end", "100 s", "-output_times", "0 s,100 s", out=out)
bp2("-restart", out / "checkpoint.h5", out=out)
names = different(straight[1].out, out)
check_true("cut by -time_end 100 s: the same bit for bit", not names, ", ".join(names[:5]))

# Into another folder: only what came after.
early = scratch() / "early"
bp2("-stepper_max_steps", "5", out=early)
checkpoint = early / "checkpoint.h5"
rest = bp2("-restart", checkpoint)
tail = (straight[1].out / "probes.csv").read_text().splitlines()[-len(rest.time):]
check_true("into another folder: the rows after the cut, the same bit for bit",
           0 < len(rest.time) < len(straight[1].time)
           and (rest.out / "probes.csv").read_text().splitlines()[1:] == tail)  # fmt: skip

# On another number of ranks, to round-off; equal steps are asked for, since the controller may amplify it.
fixed = ("-stepper_adapt", "no", "-stepper_dt", "10 s", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9")
for ranks in (1, 2):
    first = bp2(*fixed, "-stepper_max_steps", "8", ranks=ranks).out / "checkpoint.h5"
    one, other = (bp2(*fixed, "-restart", first, ranks=n) for n in (ranks, 3 - ranks))
    worst = 0.0
    for column in ("p06.p_Pa", "p06.T_degC", "p06.S_h", "surface.u_x_m", "p06.sxx_Pa"):
        a, b = one.probes[column], other.probes[column]
        worst = max(worst, np.max(np.abs(a - b)) / np.max(np.abs(a)))
    judge(15, f"written on {ranks}, continued on {3 - ranks} rank{'s' * (ranks == 1)}: histories", worst, 1e-9)

# Two checkpoints are kept, of different times.
for ranks, run in straight.items():
    times = [state(run.out / f"checkpoint.h5{s}", "t") for s in (".old", "")]
    check_true(f"two checkpoints are kept, {ranks} rank(s)", times == [240.0, 300.0], times)


def refused(name, path, reason, *options):
    """exit code 2, the reason in the message, an existing folder untouched and a new one not made."""
    here, new = scratch() / "here", scratch() / "new"
    shutil.copytree(early, here)
    before = hashes(here)
    for folder in (here, new):
        done = launch(binary(), CASES / "bp2", *OPTIONS, *options, "-restart", path, out=folder)
        said = [s for s in done.stdout.splitlines() if str(path) in s]
        check_true(f"refused: {name}", done.returncode == 2 and any(reason in s for s in said),
                   f"exit code {done.returncode}: {said[0].split(': ', 1)[-1] if said else done.stdout[-200:]}")  # fmt: skip
    check_true(f"refused: {name}: nothing written", hashes(here) == before and not new.exists())


bad, data = scratch(), checkpoint.read_bytes()
flipped = bytearray(data)
flipped[len(data) // 2] ^= 1
for name, content, reason in (
    ("cut off", data[: len(data) // 2], "bytes instead of"),
    ("one bit flipped", bytes(flipped), "checksum"),
    ("empty", b"", "not a checkpoint"),
    ("a text file", b"time_s,p\n" * 100, "not a checkpoint"),
    ("another HDF5 file", (straight[1].out / "fields.h5").read_bytes(), "not a checkpoint"),
):
    path = bad / f"{name.replace(' ', '_')}.h5"
    path.write_bytes(content)
    refused(name, path, reason)
refused("a missing file", bad / "nowhere.h5", "No such file")
refused("of another grid", checkpoint, "another case: grid_cells is [26, 1] in it but [52, 1] here (keys of the command line", "-grid_cells", "52,1")
refused("of another meter", checkpoint, "another case: meter_outlet_side is right in it but left here", "-meter_outlet_side", "left")
refused("of another material", checkpoint, "another case: mat_sediment_elasticity_E0 is 90000000 Pa in it but 91000000 Pa here", "-mat_sediment_elasticity_E0", "91 MPa")
done = launch(binary(), CASES / "bp2", "-restart", checkpoint, out=scratch() / "none")
words = ("grid_cells is [26, 1] in it but ", "bc_load_normal is {table: [0 s, 3250000 Pa, 150 s", "]} in it but {table: [0 s, 3250000 Pa, 1000 s", "number of meters is 2 in it but 0 here", "; and ", " more (keys of the command line")
check_true("without the keys of the command line: those that differ are named, four of them", done.returncode == 2 and all(w in done.stdout for w in words), done.stdout[-800:])
finish()
