#!/usr/bin/python3
"""How a run is held on to: -time_limit, -checkpoint_wall, -progress, -overwrite, and what to try when it gives up.

The scene is BP2 on 13 cells.
"""
import math
import os
import re
import resource
import shlex
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import hashes  # noqa: E402
from common import CASES, binary, check, check_true, command, environment, finish, launch, mpiexec, run, scratch  # noqa: E402

BP2 = (CASES / "bp2", "-grid_cells", "13,1", "-output_times", "0 s", "-stepper_adapt", "no", "-stepper_dt", "0.05 s")
HYBRID = ("-stepper_type", "hybrid", "-time_end", "1e-6 s", "-output_times", "0 s")


def check_share():
    """A line of progress counts the share of the run, behind a restart, too."""
    out = scratch() / "share"
    run(binary(), *BP2, "-quiet", "-time_end", "1 s", "-stepper_max_steps", "10", out=out)
    said = run(binary(), *BP2, "-progress", "0", "-time_end", "1 s", "-restart", out / "checkpoint.h5", out=out).output
    shares = re.findall(r"^step +(\d+): t = .*? \(([\d.]+) %\)", said, re.M)
    check_true("a restart in the middle goes on with 55 % of the run", shares and shares[0] == ("11", "55.0") and shares[-1] == ("20", "100.0"), shares[:2])


def limited(gigabytes, case, *options, ranks=1, at=None):
    """(exit code, what was said, largest resident size of a rank in bytes) of a run that may have so much memory a process; at: so much more than it
    has when this file of its folder is there."""
    out = scratch() / "out"
    command = [*(mpiexec(ranks) if ranks > 1 else ()), str(binary()), str(case), *options, "-output_dir", str(out)]
    limit = lambda pid, has=0: resource.prlimit(pid, resource.RLIMIT_AS, (int(gigabytes * 1e9) + has,) * 2)
    job = subprocess.Popen(command, preexec_fn=None if at else lambda: limit(0), env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    while at and not (out / at).exists() and job.poll() is None:
        time.sleep(0.01)
    if at:
        limit(job.pid, int(Path(f"/proc/{job.pid}/statm").read_text().split()[0]) * resource.getpagesize())
    said = job.stdout.read()
    _, status, usage = os.wait4(job.pid, 0)
    job.returncode = os.waitstatus_to_exitcode(status)
    return job.returncode, said, 1024 * usage.ru_maxrss


def check_memory():
    """More than the machine has is refused before anything is built; what is found out on the way is a sentence, too."""
    for ranks in (1, 2):
        code, said, _ = limited(12, BP2[0], "-grid_cells", "10000,6000", "-case_check", ranks=ranks)
        check_true(f"240 million particles in 12 GB, {ranks} rank(s): refused", code == 2 and re.search(r"grid_cells = 10000, 6000: 2\.31e\+08 particles and their nodes need about \S+ GB of memory, and there are \S+ GB: ", said)
                   and "PETSC ERROR" not in said, said[-300:])  # fmt: skip
    code, said, _ = limited(3, BP2[0], "-grid_cells", "1000,50", "-newton_preconditioner", "whole", "-quiet")
    check_true("factors in 3 GB that need more: refused", code == 2 and re.search(r"the factors of LU need about \S+ GB of memory, and there are 2\.57 GB", said) and "PETSC ERROR" not in said, said[-300:])
    large = (BP2[0], "-grid_cells", "200,100", "-quiet", "-stepper_max_steps", "1", "-output_times", "0 s")
    for more, options in ((0.005, ()), (0.1, ()), (0.001, HYBRID), (0.06, HYBRID)):  # a snapshot in memory, the solver, a snapshot, the loops
        code, said, _ = limited(more, *large, *options, at="run.id")
        check_true(f"an allocation that fails, with {1e3 * more:.0f} MB more: a sentence, exit code 3", code == 3 and said.count("clathra: out of memory") == 1 and "HDF5" not in said and "PETSC ERROR" not in said, said[-300:])
    groups = re.findall(r"^\d+:(|memory):/(.*)$", Path("/proc/self/cgroup").read_text(), re.M)  # of either version
    files = [f"{of or '.'}/{group}/memory.{'limit_in_bytes' if of else 'max'}" for of, name in groups for group in (name, *map(str, Path(name).parents))]
    for file in files:  # of the process's own group, and of those above it
        apart = ("unshare", "--mount", "sh", "-ec", 'mount -t tmpfs tmpfs /sys/fs/cgroup; cd /sys/fs/cgroup; mkdir -p "$(dirname "$0")"; echo 300000000 >"$0"; exec "$@"', file)
        if subprocess.run([*apart, "true"], capture_output=True).returncode == 0:  # as root
            done = subprocess.run([*apart, *map(str, (binary(), BP2[0], "-grid_cells", "200,100", "-case_check"))], env=environment(), capture_output=True, text=True)
            check_true(f"... and what is above the limit of a container, {file}", done.returncode == 2 and "and there are 0.3 GB" in done.stderr, done.stderr[-300:])
    code, said, _ = limited(4, *BP2, "-quiet", "-stepper_max_steps", "1")
    check_true("what fits is run, without a word about memory", code == 0 and "memory" not in said, said[-300:])


def check_forecast():
    """What is said of memory is what a run then takes, within a factor of 1.5."""
    for gigabytes, case, ranks, *options in (
        (1.0, "bp2", 1, "-grid_cells", "100,40"),
        (1.0, "masuda", 1, "-grid_cells", "40,240"),
        (1.0, "sea_floor", 1, "-grid_cells", "150,168"),
        (0.7, "footing", 1, "-grid_cells", "128,132"),
        (1.0, "bp2", 1, "-grid_cells", "200,100", *HYBRID),
        (1.0, "collapse_3d", 1, "-grid_cells", "72,72,30", *HYBRID),
        (0.8, "footing_3d", 1),
        (0.7, "footing_3d", 2),
    ):
        code, said, took = limited(gigabytes, CASES / case, "-stepper_max_steps", "1", *options, ranks=ranks)
        about = re.search(r"memory: about (\S+) GB", said)
        check_true(f"{case} {' '.join(options)}, {ranks} rank(s): memory is said", code == 0 and about, said[-300:])
        if about:
            check("... and is that forecast, share", float(about[1]) * 1e9 / (ranks * took), (1 / 1.5, 1.5))


def check_refused():
    """Words that would be ignored, a restart from nowhere, a folder with a case of the user's own: nothing is run or written."""
    done = scratch() / "done"
    run(binary(), *BP2, "-quiet", "-stepper_max_steps", "1", out=done)
    before = hashes(done)
    for option in ("-restart", "-restart_as_initial"):
        for value in (("",), ()):
            said = launch(binary(), *BP2, "-quiet", "-output_dir", done, option, *value)
            check_true(f"{option} {value or 'without a value'} is refused", said.returncode == 2 and f"{option} needs the path of a checkpoint" in said.stdout and hashes(done) == before, said.stdout[-300:])
    odd = scratch()
    (odd / "words.opts").write_text("rubbish line\n")
    os.mkfifo(odd / "pipe")
    for ranks in (1, 2):
        for value, words in ((odd / "nowhere", f"Unable to open options file {odd}/nowhere"), (odd, f"options file {odd} is a directory"), (odd / "words.opts", "words.opts line 1: rubbish"), ("", "Unable to open options file"), (None, "Missing filename for -options_file")):
            said = launch(binary(), *BP2, "-case_check", "-options_file", *(() if value is None else (value,)), ranks=ranks, timeout=60)
            check_true(f"-options_file {value}, {ranks} rank(s): a sentence", said.returncode == 2 and "clathra: " in said.stdout and words in said.stdout and "PETSC ERROR" not in said.stdout, said.stdout[-300:])
        for option in ("-restart", "-restart_as_initial"):
            said = launch(binary(), *BP2, "-case_check", option, odd / "pipe", ranks=ranks, timeout=60)
            check_true(f"{option} of a pipe, {ranks} rank(s), is refused", said.returncode == 2 and "it is not a file" in said.stdout, said.stdout[-300:])
    said = subprocess.run(["bash", "-c", 'cd "$1" && rmdir "$1" && shift && exec "$@"', "-", scratch(), Path(binary()).resolve(), *map(str, BP2), "-time_end", "1 s"], env=environment(), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=60)
    check_true("a working folder that is gone: a sentence", said.returncode == 2 and "the folder in which it was started cannot be found" in said.stderr and "PETSC ERROR" not in said.stderr, said.stderr[-300:])
    said = launch(binary(), BP2[0], "grid_cells", "13,1", out=scratch() / "none")
    check_true("a word that is no option is refused", said.returncode == 2 and "'grid_cells' is neither an option nor the value of one" in said.stdout, said.stdout[-300:])
    said = launch(binary(), *BP2, "-case_check", "yes", "50,1", out=scratch() / "none")
    check_true("... and a second value", said.returncode == 2 and "'50,1' is neither" in said.stdout, said.stdout[-300:])
    own = scratch() / "own"
    own.mkdir()
    (own / "case.yaml").write_text((CASES / "bp2" / "case.yaml").read_text())
    before = hashes(own)
    for how in ((), ("-overwrite",), ("-restart", done / "checkpoint.h5")):
        said = launch(binary(), own, *BP2[1:], "-quiet", *how, out=own)
        check_true(f"the case's own folder as -output_dir is refused {how[:1]}", said.returncode == 2 and "is a case of your own" in said.stdout and hashes(own) == before, said.stdout[-300:])
    again = launch(binary(), done / "case.yaml", "-quiet", "-stepper_max_steps", "1", "-restart", done / "checkpoint.h5", out=done)
    check_true("... a case that a run has written goes on in its folder", again.returncode == 0, again.stdout[-300:])


def check_limit():
    """A run that is ended by the clock goes on to what the straight run gives, bit for bit."""
    out, straight = scratch() / "out", scratch() / "straight"
    begun = time.monotonic()
    done = launch(binary(), *BP2, "-time_end", "2000 s", "-quiet", "-time_limit", "2", out=out)
    check("a run of 40 000 steps with -time_limit 2 s takes, on a busy machine too", time.monotonic() - begun, 60.0)
    check_true("... exit code 4, and how to go on", done.returncode == 4 and "before -time_limit 2" in done.stdout and f"-restart {out}" in done.stdout, done.stdout[-200:])
    said = re.search(r"go on with (-restart .*)$", done.stdout, re.M)
    words = shlex.split(said[1]) if said else []
    check_true("... with the keys of its command line", all(w in words for w in (*BP2[1:], "2000 s")), words)
    again = subprocess.run([binary(), str(BP2[0]), *words, "-stepper_max_steps", "1"], capture_output=True, text=True, timeout=600)
    check_true("... and so it goes on", again.returncode == 0, again.stdout[-300:] + again.stderr[-300:])
    summary = re.search(r"(\d+) steps, .* s for the (\d+) steps since the restart$", again.stdout, re.M)
    check_true("... with the time of its own steps alone", summary and int(summary[1]) > int(summary[2]) == 1, again.stdout[-400:])
    t = float((out / "balance.csv").read_text().splitlines()[-1].split(",")[1])
    end = f"{round((t + 1) / 0.05) * 0.05:g} s"
    run(binary(), *BP2, "-quiet", "-time_end", end, "-restart", out / "checkpoint.h5", out=out)
    run(binary(), *BP2, "-quiet", "-time_end", end, out=straight)
    same = [f for f in ("probes.csv", "balance.csv") if (out / f).read_bytes() == (straight / f).read_bytes()]
    check_true("... with a restart it is the straight run, bit for bit", len(same) == 2, f"{same} from {t} s")
    refused = {"-time_limit": ("0", "20x", "5 m"), "-checkpoint_wall": ("-1", "often"), "-progress": ("-1",), "-stepper_max_steps": ("2.5", "1 s"),
               "-newton_refactor": ("-1",), "-newton_tol_residual": ("1",), "-newton_tol_update": ("tight",), "-newton_keep_jacobian": ("-0.1",), "-newton_drop": ("1", "-1e-6"),
               "-newton_preconditioner": ("lu",), "-newton_operator": ("matrix",), "-quiet": ("maybe",), "-case_keys": ("maybe",), "-case_check": ("maybe",), "-case_curves": ("2",), "-overwrite": ("maybe",)}  # fmt: skip
    for option, value in ((o, v) for o, values in refused.items() for v in values):
        done = launch(binary(), *BP2, option, value, out=scratch() / "none")
        check_true(f"{option} {value} is refused", done.returncode == 2 and f"command line: {option} = '{value}" in done.stdout and "PETSC ERROR" not in done.stdout)
    done = launch(binary(), *BP2, "-case_keys", "no", "-case_check")
    check_true("-case_keys no prints none", done.returncode == 0 and "the case is valid" in done.stdout and "| `" not in done.stdout, done.stdout[-200:])
    done = launch(binary(), *BP2, "-time_end", "2000 s", "-quiet", "-time_limit", "0.03 min", out=scratch() / "minutes")
    check_true("-time_limit 0.03 min", done.returncode == 4 and "before -time_limit 1.8 s" in done.stdout, done.stdout[-200:])


TIDE = """\
title: Tide over a column of 30 m
fields: [solid, water]
inertia: no
grid: {lower: [0 m, 0 m], upper: [0.5 m, 31 m], cells: [1, 62]}
ambient: {pressure: {sine: [10 MPa, 15 kPa, 12.42 h, 0 h]}}
materials: [silt]
mat_silt:
  porosity: 0.5
  solid: {density: 2650 kg/m^3}
  permeability: {k0: 1e-15 m^2, hydrate_law: none}
  elasticity: {E0: 2 GPa, nu: 0.3}
regions: [column]
region_column: {lower: [0 m, 0 m], upper: [0.5 m, 30 m], material: silt, pressure: 10 MPa}
boundaries: [base, left, right, floor]
bc_base: {type: roller, axis: y, position: 0 m}
bc_left: {type: roller, axis: x, position: 0 m}
bc_right: {type: roller, axis: x, position: 0.5 m}
bc_floor: {type: pressure, side: top, pressure: ambient}
time: {end: 124.2 h}
output: {every: 12.42 h}
"""


def check_tide():
    """Steps of a run of ten tides, by tolerance, within a factor of two of those forecast."""
    case = scratch() / "tide.yaml"
    case.write_text(TIDE)
    for tol in ("1e-3", "1e-2"):
        out = scratch() / f"tide{tol}"
        said = run(binary(), case, "-stepper_tol", tol, out=out).output
        forecast = float(re.search(r"implicit about ([\d.e+-]+) steps", said)[1])
        came = int(re.search(r"(\d+) steps, \d+ refused", said)[1])
        check(f"ten tides, tolerance {tol}: {came} steps came over those forecast, as a power of two", abs(math.log2(came / forecast)), 1.0)


def check_slivers():
    """A fixed step that was cut and grows back ends on its events: what rounding left of them was once a step of 3e-11 s that nothing could solve."""
    out = scratch() / "out"
    case = Path(__file__).resolve().parent / "cases" / "falling.yaml"
    done = launch(binary(), case, "-quiet", "-mat_soft_elasticity_E0", "5 MPa", "-time_end", "0.74 s", "-output_times", "0 s", "-output_probe_every", "0.02 s", "-stepper_dt", "0.01 s", out=out)
    rows = [line.split(",") for line in (out / "balance.csv").read_text().splitlines()]
    dt = [float(row[rows[0].index("dt_s")]) for row in rows[1:]]
    check_true("fixed steps, cut and grown back: no slivers", done.returncode == 0 and "refused" in done.stdout and min(dt) > 1e-4, f"exit code {done.returncode}, {len(dt)} steps, least {min(dt):g} s")


def check_checkpoints():
    for seconds, wanted in (("0.01", True), ("0", False), ("300", False)):
        out = scratch() / "out"
        run(binary(), *BP2, "-quiet", "-time_end", "2 s", "-checkpoint_wall", seconds, out=out)
        check_true(f"-checkpoint_wall {seconds}: checkpoints on the way: {wanted}", (out / "checkpoint.h5.old").exists() == wanted)


def check_progress():
    few, all_ = (run(binary(), *BP2, "-time_end", "2 s", "-progress", s, out=scratch() / "out").output for s in ("1", "0"))
    lines = lambda text: [line for line in text.splitlines() if line.startswith("step")]
    check_true("-progress 0: a line a step", len(lines(all_)) == 40)
    check("lines in a run of about a second, at most one a second", len(lines(few)), (2, 20))
    check_true("the last step is told", "step   40:" in lines(few)[-1] and "(100.0 %)" in lines(few)[-1], lines(few)[-1])
    slow = run(binary(), CASES / "century", "-progress", "0", "-stepper_max_steps", "2", out=scratch() / "out").output
    check_true("times far below the unit of the run in their own", "t = 3 h (" in lines(slow)[-1], lines(slow)[-1])
    wide = run(binary(), CASES / "century", "-progress", "0", "-stepper_max_steps", "1", "-stepper_adapt", "no", "-stepper_dt", "3 a", out=scratch() / "out").output
    check_true("times in the unit of the run", " years (" in lines(wide)[-1], lines(wide)[-1])


def check_folder():
    out, other = scratch() / "out", scratch() / "other.yaml"
    run(binary(), *BP2, "-quiet", "-time_end", "0.1 s", out=out)
    before = {f.name: f.read_bytes() for f in out.iterdir() if f.is_file()}
    text = (CASES / "bp2" / "case.yaml").read_text()
    other.write_text(text.replace("title: BP2", "title: another one, BP2"))
    done = launch(binary(), other, *BP2[1:], "-quiet", "-time_end", "0.1 s", out=out)
    after = {f.name: f.read_bytes() for f in out.iterdir() if f.is_file()}
    check_true("another case's folder is refused, and nothing changed", done.returncode == 2 and "bp2/case.yaml" in done.stdout
               and "-overwrite" in done.stdout and before == after, done.stdout[-300:])  # fmt: skip
    check_true("-overwrite takes it", launch(binary(), other, *BP2[1:], "-quiet", "-time_end", "0.1 s", "-overwrite", out=out).returncode == 0
               and "another one" in (out / "case.yaml").read_text())  # fmt: skip
    check_true("the same case with other values does not need it", launch(binary(), other, *BP2[1:], "-quiet", "-time_end", "0.2 s", out=out).returncode == 0)
    (out / "meters.csv").write_text("stale\n")
    (out / "report.html").write_text("stale\n")
    launch(binary(), other, *BP2[1:], "-quiet", "-time_end", "0.2 s", "-stepper_max_steps", "1", out=out)
    check_true("stale files do not stand beside new ones", not (out / "meters.csv").exists() and not (out / "report.html").exists())
    moved = scratch() / "moved.yaml"
    moved.write_text(other.read_text())
    check_true("nor does a case that was copied", launch(binary(), moved, *BP2[1:], "-quiet", "-time_end", "0.2 s", out=out).returncode == 0)
    third = scratch() / "third.yaml"
    third.write_text(moved.read_text().replace("porosity: 0.3", "porosity: 0.31").replace("\nregions:", "\n# another\nregions:"))
    done = launch(binary(), third, *BP2[1:], "-quiet", "-time_end", "0.2 s", out=out)
    check_true("another case of the same title is refused while the first one is there", done.returncode == 2 and "holds the results of another case" in done.stdout, done.stdout[-300:])
    moved.unlink()
    check_true("... and one that has moved, and changed, is not", launch(binary(), third, *BP2[1:], "-quiet", "-time_end", "0.2 s", out=out).returncode == 0)


def check_advice():
    done = launch(binary(), *BP2[:5], "-time_end", "60 s", "-stepper_dt_min", "1e-3 s", "-bc_load_normal", "1e5 MPa", out=scratch() / "out")
    said = done.stdout.splitlines()
    at = next((k for k, line in enumerate(said) if line.startswith("Given up")), -2)
    check_true("what to try stands under why it was given up", done.returncode == 3 and "What to try, in this order" in said[at + 1]
               and "docs/giving_up.md" in said[at + 1], said[at : at + 2])  # fmt: skip
    check_true("... hybrid among it, which knows the scene", "stepper_type hybrid" in said[at + 1], said[at + 1])
    done = launch(binary(), *BP2[:5], "-time_end", "60 s", "-stepper_dt_min", "1e-3 s", "-bc_load_normal", "1e5 MPa", "-inertia", "no", out=scratch() / "out")
    text = done.stdout[done.stdout.index("Given up") :]
    check_true("... and not where it does not", "hybrid does not know inertia: no" in done.stdout and "What to try" in text and "stepper_type hybrid" not in text, text)
    jump = ("-regions", "column,wet", "-region_column_lower", "0.5 m, 0 m", "-region_wet_lower", "0 m, 0 m", "-region_wet_upper", "0.5 m, 0.02 m", "-region_wet_material", "sediment", "-region_wet_pressure", "3.25 MPa",
            "-region_wet_temperature", "4 degC", "-region_wet_Sh", 0, "-region_wet_Sw", 1, "-region_wet_Sg", 0)  # fmt: skip
    said = launch(binary(), *BP2[:5], "-time_end", "60 s", "-stepper_dt_min", "1e-3 s", "-bc_load_normal", "1e5 MPa", *jump, out=scratch() / "out").stdout.splitlines()
    check_true("a jump of p_c at the start is named where the run gives up", any(line.startswith("A likely cause: regions column and wet touch") for line in said), said[-8:])
    layers = ("-materials", "sediment,clay", "-mat_clay_like", "sediment", "-mat_clay_permeability_k0", "1e-18 m^2", "-region_wet_material", "clay", "-region_wet_Sw", 0.6, "-region_wet_Sg", 0.4)
    load = ("-time_end", "60 s", "-stepper_dt_min", "1e-3 s", "-bc_load_normal", "1e5 MPa")
    tried = ["in this order: stabilisation_donor" in launch(binary(), *BP2[:5], *load, *jump, *more, out=scratch() / "out").stdout for more in (layers, (*layers, "-stabilisation_donor", "yes"))]
    check_true("gas of where it comes from (332) is tried first in layers, unless it is on, and not in one material", tried == [True, False] and "stabilisation_donor" not in text, tried)


def snapshots(out):
    import clathra  # noqa: PLC0415, from python, which common puts on the path

    return clathra.Run(out)


def check_end():
    """A run that is ended on its way shows its last state; going on from it leaves what the straight run has."""
    whole, out = scratch() / "whole", scratch() / "out"
    every = (*BP2, "-quiet", "-time_end", "1 s", "-output_every", "0.5 s")
    run(binary(), *every, out=whole)
    for ranks in (1, 2):
        done = launch(binary(), *every, "-stepper_max_steps", "13", out=out, ranks=ranks)
        last = snapshots(out)
        at = last.balance["time_s"][-1]
        check_true(f"ended after 13 steps, {ranks} rank(s): the last snapshot is of then", done.returncode == 0 and abs(last.times[-1] - at) < 1e-9 and len(last.times) == 3, f"{last.times}, {at} s")
    launch(binary(), *every, "-stepper_max_steps", "13", out=out)
    run(binary(), *every, "-restart", out / "checkpoint.h5", out=out)
    names = [sorted(f.name for f in (o / "fields").iterdir()) for o in (out, whole)]
    check_true("... gone on with, the straight run's snapshots and no others", names[0] == names[1] and list(snapshots(out).times) == list(snapshots(whole).times), names)
    done = launch(binary(), *BP2, "-quiet", "-time_end", "2000 s", "-time_limit", "1.5", "-overwrite", out=out)
    check_true("so does -time_limit", done.returncode == 4 and abs(snapshots(out).times[-1] - snapshots(out).balance["time_s"][-1]) < 1e-9)
    done = launch(binary(), *BP2[:5], "-quiet", "-time_end", "60 s", "-stepper_dt_min", "1e-3 s", "-bc_load_normal", "{table: [0 s, 3.25 MPa, 1 s, 3.25 MPa, 1.01 s, 1e5 MPa]}", "-overwrite", out=out)
    check_true("... and what is given up", done.returncode == 3 and 0 < snapshots(out).times[-1] == snapshots(out).balance["time_s"][-1], done.stdout[-300:])


def check_last_lines():
    """What a run accepted above its tolerance stands in its last lines, in the log and so in the report."""
    loose = (CASES / "bp2", "-grid_cells", "13,1", "-output_times", "0 s", "-quiet", "-time_end", "5 s", "-stepper_dt", "1 s")
    for tol, least, told in (("1e-7", "1 s", True), ("1e-2", "1e-6 s", False)):
        out = scratch() / "out"
        last = launch(binary(), *loose, "-stepper_tol", tol, "-stepper_dt_min", least, out=out).stdout.splitlines()[-1]
        check_true(f"steps accepted far above the tolerance are told last: {told}", ("warning: 5 of 5 steps were accepted above the tolerance" in last) == told and ("steps were accepted above" in (out / "log.txt").read_text()) == told, last)
        text = (out / "summary.txt").read_text()
        check_true("... and the extremes of p and T in the summary", "  p of particles from " in text and "  T of particles from " in text, text)


CLOSED = """title: water that is heated in a closed box
inertia: no
fields: [water, heat]
grid: {lower: [0 m, 0 m], upper: [0.4 m, 0.1 m], cells: [4, 1]}
materials: [sand]
mat_sand: {porosity: 0.4, solid: {density: 2650 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}, permeability: {k0: 1e-12 m^2}, water: {expansion: 3e-4 1/K}}
regions: [box]
region_box: {lower: [0 m, 0 m], upper: [0.4 m, 0.1 m], material: sand, pressure: 5 MPa, temperature: 10 degC}
boundaries: [warm]
bc_warm: {type: face_temperature, side: left, temperature: {ramp: [10 degC, 30 degC, 0 h, 1 h]}}
time: {end: 12 h}
output: {every: 12 h}
"""


def check_pressures():
    """A pressure beyond all that started and acted is noted, above as below, and stands in the report; one that a condition makes is not."""
    case, out = scratch() / "closed.yaml", scratch() / "out"
    case.write_text(CLOSED)
    note = re.compile(r"note: the pressure of a particle was ([\d.]+) MPa, near .*?: ([\d.]+) MPa (above|below) that of the start and of all conditions and loads \(([\d.]+) MPa\)")
    done = launch(binary(), case, "-quiet", out=out)
    found = note.findall(done.stdout)
    check_true("heated in a closed box: the pressure above all is noted", len(found) == 1 and found[0][2:] == ("above", "5") and float(found[0][0]) > 5.5, done.stdout[-600:])
    check("... by how much", abs(float(found[0][0]) - 5 - float(found[0][1])), 0.01)
    check_true("... in the summary's lowest and highest, too", f"to {float(found[0][0]):.5g}"[:7] in (out / "summary.txt").read_text(), found)
    page = command("report", out)
    check_true("... and among the report's warnings", "note: the pressure of a particle" in (out / "report.html").read_text().split('"warnings": [')[1][:3000], page.stderr)
    cooled = launch(binary(), case, "-quiet", "-bc_warm_temperature", "{ramp: [10 degC, 5 degC, 0 h, 1 h]}", out=scratch() / "cooled")
    check_true("cooled: the pressure below all", [f[2:] for f in note.findall(cooled.stdout)] == [("below", "5")], cooled.stdout[-600:])
    check_true("... none of them a tension", "a tension" not in done.stdout + cooled.stdout)
    torn = launch(binary(), case, "-quiet", "-region_box_pressure", "1 MPa", "-bc_warm_temperature", "{ramp: [10 degC, 2 degC, 0 h, 1 h]}", out=scratch() / "torn")
    tension = re.search(r"warning: the pressure of a particle was -([\d.]+) MPa, a tension", torn.stdout)
    check_true("cooled from a low pressure: the tension of its water is warned of", tension and float(tension.group(1)) > 0.2, torn.stdout[-900:])
    drained = launch(binary(), case, "-quiet", "-boundaries", "warm,open", "-bc_open_type", "pressure", "-bc_open_side", "right", "-bc_open_pressure", "5 MPa", out=scratch() / "drained")
    check_true("with a way out: nothing", drained.returncode == 0 and not note.findall(drained.stdout), drained.stdout[-600:])
    pressed = launch(binary(), case, "-quiet", "-boundaries", "warm,open", "-bc_open_type", "pressure", "-bc_open_side", "right", "-bc_open_pressure", "{ramp: [5 MPa, 20 MPa, 0 h, 1 h]}", out=scratch() / "pressed")
    check_true("pressed by a condition: nothing", pressed.returncode == 0 and not note.findall(pressed.stdout), pressed.stdout[-600:])


COLUMN = """title: a column under a sea that rises
inertia: no
fields: [solid, water]
grid: {lower: [0 m, 0 m], upper: [1 m, 25 m], cells: [1, 25]}
ambient: {pressure: {ramp: [8 MPa, 9 MPa, 0 d, 4 d]}}
materials: [silt]
mat_silt: {porosity: 0.45, solid: {density: 2700 kg/m^3}, permeability: {k0: 1e-15 m^2, hydrate_law: none}, elasticity: {E0: 1.5 GPa, nu: 0.3}}
regions: [bed]
region_bed: {lower: [0 m, 0 m], upper: [1 m, 24 m], material: silt, pressure: 8 MPa, temperature: 6 degC}
boundaries: [base, left, right, floor]
bc_base: {type: roller, axis: y, position: 0 m}
bc_left: {type: roller, axis: x, position: 0 m}
bc_right: {type: roller, axis: x, position: 1 m}
bc_floor: {type: pressure, side: top, pressure: ambient}
time: {end: 4 d}
"""


def check_retries():
    """Right behind the start the error falls with dt, not with its cube: two attempts show it, (422), and the next meets the tolerance without much to spare."""
    case, out = scratch() / "rises.yaml", scratch() / "out"
    case.write_text(COLUMN)
    done = launch(binary(), case, "-progress", "0", "-stepper_tol", "1e-4", "-stepper_dt", "4 h", "-stepper_max_steps", "1", out=out)
    step = re.search(r"error ([\d.e+-]+) of tolerance.*after (\d+) refused", done.stdout)
    check_true("a first step of 4 h where 40 s would do: refused", step is not None, done.stdout[-400:])
    check("... so often, five times with the order of the estimate", int(step[2]), (1, 3))
    check("... and then its error, of the tolerance", float(step[1]), (0.4, 1.0))


def check_notes():
    """Outputs that are asked for beyond the end are told, those at it are not; a temperature that is no field is no ice."""
    case = scratch() / "rises.yaml"
    case.write_text(COLUMN)
    said = lambda *options: launch(binary(), case, "-case_check", *options, out=scratch() / "out").stdout
    check_true("output_every beyond the end is noted", "note: output_every (10 days) is longer than the run (4 days)" in said("-output_every", "10 d"))
    check_true("... of probes, too", "note: output_probe_every (5 days) is longer" in said("-output_probe_every", "5 d"))
    check_true("... and one that ends with it is not", "is longer than" not in said("-output_every", "4 d", "-output_probe_every", "4 d"))
    stages = said("-stages", "a,b", "-stage_a_end", "1 d", "-stage_b_end", "4 d", "-stage_a_output_every", "2 d", "-output_every", "2 d", "-stage_b_output_every", "5 d")
    check_true("... by stage", "note: b: output_every (5 days) is longer than the stage (3 days)" in stages and stages.count("is longer than") == 1, stages)
    done = launch(binary(), case, "-region_bed_temperature", "-3 degC", "-stepper_max_steps", "2", "-quiet", out=scratch() / "out")
    check_true("a scene without heat has no ice", "melting point" not in done.stdout and "2 steps" in done.stdout, done.stdout[-300:])


def check_words():
    """A function of time in one word, and a probe that the case does not have."""
    read = lambda *options: (run(binary(), *BP2, "-quiet", "-time_end", "0.1 s", *options, out=scratch() / "out").out / "case.yaml").read_text()
    both = [read("-bc_load_normal" + end, text) for end, text in (("", "{ramp: [3.25 MPa, 10 MPa, 0 s, 500 s]}"), ("_ramp", "3.25 MPa, 10 MPa, 0 s, 500 s"))]
    lines = [next(line for line in text.splitlines() if "normal:" in line) for text in both]
    check_true("-bc_load_normal '{ramp: [...]}'", lines[0] == lines[1] and "10000000 Pa" in lines[0], lines[0])
    for wrong in ("{slope: [1 MPa, 2 MPa, 0 s, 1 s]}", "{ramp [1 MPa]}", "{", "{ramp: [1 MPa]}"):
        done = launch(binary(), *BP2, "-bc_load_normal", wrong, out=scratch() / "out")
        check_true(f"{wrong} is refused", done.returncode == 2 and "bc_load_normal" in done.stdout, done.stdout[-200:])
    text = read("-probes", "p06, surface, mine", "-probe_mine_at", "0.3 m, 0.01 m")
    check_true("a probe from the command line", "probes: [p06, surface, mine]" in text and "at: [0.3 m, 0.01 m]" in text)


def main():
    check_words()
    check_share()
    check_tide()
    check_refused()
    check_memory()
    check_forecast()
    check_limit()
    check_slivers()
    check_retries()
    check_notes()
    check_checkpoints()
    check_progress()
    check_folder()
    check_advice()
    check_end()
    check_last_lines()
    check_pressures()
    finish()


main()
