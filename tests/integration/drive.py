#!/usr/bin/python3
"""The Python package drives the program: cases of dicts and with changes, checks, runs and their progress, stops and restarts; what is wrong is an
exception with the program's words; nothing is left running; what a python3 without a module says."""
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, binary, check, check_true, environment, finish, scratch  # noqa: E402

import clathra  # noqa: E402

COLUMN = {
    "title": "A column: 'clay' # 1", "fields": ["solid", "water"], "grid": {"lower": [0, 0], "upper": ["1 m", 0.02], "cells": (20, 1)},
    "materials": ["clay"], "mat": {"clay": {
        "porosity": np.float64(0.4), "solid_density": 2600, "water": {"bulk_modulus": "2.2 GPa", "viscosity": 1e-3, "ref_pressure": 1e5},
        "permeability": {"k0": 1e-15, "porosity_law": "none", "hydrate_law": "none"}, "elasticity": {"E0": 1e7, "nu": 0.2}}},
    "regions": ["column"], "region_column": {"lower": [0, 0], "upper": np.array([1.0, 0.02]), "material": "clay", "pressure": 1e5, "temperature": 20},
    "boundaries": ["base", "bottom", "top", "load", "drain"],
    "bc": {"base": {"type": "roller", "axis": "x", "position": 0}, "bottom": {"type": "roller", "axis": "y", "position": 0},
           "top": {"type": "roller", "axis": "y", "position": 0.02}, "load": {"type": "traction", "side": "right", "normal": {"ramp": [1e5, 1.01e5, 0, 60]}},
           "drain": {"type": "pressure", "side": "right", "initial": True}},
    "stepper": {"adapt": False, "dt": 2}, "time": {"end": "10 min"}, "output": {"probe_every": 60}, "probes": ["base"], "probe_base_at": [0, 0.01],
}  # fmt: skip
OUT = scratch()
CASE = clathra.Case(COLUMN, binary())


def refuses(name, kind, call, *words, code=None):
    try:
        call()
    except kind as error:
        said = str(error)
        check_true(name, all(w in said for w in words) and "Traceback" not in said and ": note: " not in said and getattr(error, "code", code) == code, said)
    else:
        check_true(name, False, "nothing was refused")


def running(folder):
    """Processes that have the folder in their command."""
    found = []
    for process in Path("/proc").glob("[0-9]*"):
        try:
            found += [process.name] if str(folder).encode() in (process / "cmdline").read_bytes() else []
        except OSError:
            pass
    return found


def cases():
    """Of a dict, a name, a file; flat and nested changes; units of bare numbers."""
    said = CASE.check()
    check_true("a dict is a case, whose check says what a run says first", "forecast" in said and "the case is valid" in said and "given.yaml" not in said, said)
    run = CASE.run(OUT / "dict")
    check_true("... and runs", run.finished and run.title == COLUMN["title"] and run.progress == clathra.Progress(300, 600.0, 600.0, 1.0), run.progress)
    check_true("bare numbers have the units of their key", run.case["region_column_temperature"] == 20 and run.case["bc_load_normal"] == {"table": [0, 1e5, 60, 1.01e5]}
               and run.case["stepper_adapt"] == "no" and run.case["mat_clay_elasticity_E0"] == 1e7, run.case["bc_load_normal"])  # fmt: skip
    CASE.write(OUT / "written.yaml")
    check_true("what it writes is the same case", clathra.Case(OUT / "written.yaml", binary()).resolved(texts=True) == CASE.resolved(texts=True))
    shipped = clathra.Case("terzaghi", binary())
    changed = shipped.with_({"mat": {"clay": {"porosity": 0.3}}}, grid_cells=[8, 1], time_end=3600, output_times=[60, "1 h"], bc_load_normal={"table": [[0, 1e5], [60, "0.2 MPa"]]})
    found, was = changed.resolved(), shipped.resolved()
    check_true("a shipped case with changes, nested and flat", (found["mat_clay_porosity"], found["grid_cells"], found["time_end"], found["output_times"]) == (0.3, [8, 1], 3600, [60, 3600])
               and found["bc_load_normal"] == {"table": [0, 1e5, 60, 2e5]} and was["mat_clay_porosity"] == 0.4, found["bc_load_normal"])  # fmt: skip
    check_true("... one of which is taken back", changed.with_(mat_clay_porosity=None).resolved()["mat_clay_porosity"] == 0.4)
    forms = [c.with_(bc_load_normal_table=[[0, 1e5], [60, 2e5]]).resolved()["bc_load_normal"] for c in (changed, CASE)]
    check_true("... of which another form takes the place", forms == [{"table": [0, 1e5, 60, 2e5]}] * 2, forms)
    changed.write(OUT / "changed.yaml")
    kept = clathra.Case(OUT / "changed.yaml", binary()).resolved()
    check_true("... is written with all its keys", kept == found)


def wrong():
    case = clathra.Case("terzaghi", binary())
    refuses("a value out of range", clathra.Refused, case.with_(mat_clay_porosity=1.4).check, "mat_clay_porosity = '1.4'", "(0,1)", "exit code 2", code=2)
    refuses("... of a dict, without a file that nobody has seen", clathra.Refused, CASE.with_(mat_clay_porosity=1.4, nonsense=1).check, "mat_clay_porosity = '1.4': is out",
            "nonsense", code=2)  # fmt: skip
    refuses("an unknown key", clathra.Refused, case.with_(mat_clay_porostiy=0.4).check, "did you mean mat_clay_porosity", code=2)
    refuses("... of no group", clathra.Refused, case.with_(nonsense=1).check, "nonsense = 1", "unknown key")
    refuses("a step above the stable one, with a key that hybrid does not know", clathra.Refused, CASE.with_(stepper_type="hybrid", inertia=True, stepper_tol=0.01).check, "stable step", code=2)
    refuses("a key twice", clathra.Refused, lambda: clathra.Case({"time_end": 1, "time": {"end": 2}}), "time_end", "twice")
    refuses("no such case", clathra.Refused, lambda: clathra.Case("nowhere", binary()), "nowhere")
    refuses("no such program", clathra.Refused, lambda: clathra.Case(COLUMN, "/no/clathra").check(), "/no/clathra")
    refuses("no rank", clathra.Refused, lambda: CASE.run(OUT / "rank", ranks=0), "ranks = 0")
    refuses("a folder of another case", clathra.Refused, lambda: case.run(OUT / "dict"), "holds the results of another case", code=2)
    folder = OUT / "mine"
    folder.mkdir()
    (folder / "case.yaml").write_text("mine")
    refuses("a folder with a case of one's own", clathra.Refused, lambda: CASE.run(folder), "a case of your own", code=2)
    check_true("... which stays as it was", [p.name for p in folder.iterdir()] == ["case.yaml"], list(folder.iterdir()))
    refuses("no checkpoint", clathra.Refused, lambda: CASE.run(OUT / "new", restart=True), "checkpoint.h5", code=2)
    refuses("a run that cannot go on", clathra.GaveUp, lambda: CASE.with_(bc_load_normal={"ramp": [1e5, 1e9, 0, 1]}, stepper_max_failures=1).run(OUT / "up"), "Given up at", "exit code 3", code=3)
    refuses("a limit", clathra.Ended, lambda: CASE.with_(stepper_dt=1e-3).run(OUT / "limit", options=("-time_limit", "0.5 s")), "-time_limit", code=4)


def under_way():
    """A run that is stopped and goes on ends as one that was not; a killed one says so."""
    case, whole = CASE.with_(stepper_dt=0.5), CASE.with_(stepper_dt=0.5).run(OUT / "whole")
    with case.start(OUT / "parts") as job:
        seen = [now for now in iter_until(job, lambda now: now.step > 0)]
    check_true("progress of a run under way", seen[-1].step > 0 and 0 < seen[-1].share < 1 and seen[-1].end == 600, seen[-1])
    check_true("the end of the block stops it, with a checkpoint", job.code == 4 and "Ended by signal" in job.sentence() and not clathra.Run(OUT / "parts").finished, job.code)
    run = case.run(OUT / "parts", restart=True)
    check_true("... from which it goes on, as if it had not been stopped", run.finished and np.array_equal(run.probes["base.p_Pa"], whole.probes["base.p_Pa"]))
    job = case.start(OUT / "parts")
    check_true("what another run left is no progress", job.progress().step == 0)
    while not job.progress().step:
        time.sleep(0.02)
    os.kill(int(running(OUT / "parts")[0]), signal.SIGKILL)
    refuses("a killed run", clathra.Failed, job.wait, "signal 9", code=-signal.SIGKILL)
    job = case.start(OUT / "early", ranks=2)
    check_true("on two ranks, stopped as it starts: with a checkpoint", job.stop() == 4 and (OUT / "early" / "checkpoint.h5").is_file(), job.code)
    run = CASE.with_(time_end=10).run(OUT / "ranks", ranks=2)
    check_true("on two ranks", run.finished and "2 ranks:" in run.summary, run.summary[-200:])


def apart():
    """Runs side by side share no folder of MPI's session, on one rank and on two, and leave none."""
    of = lambda job: dict(word.split("=", 1) for word in Path(f"/proc/{job._process.pid}/environ").read_text().split("\0") if "=" in word).get("OMPI_MCA_orte_tmpdir_base", "")
    with CASE.with_(stepper_dt=1e-3).start(OUT / "one") as one, CASE.with_(stepper_dt=1e-3).start(OUT / "two", ranks=2) as two:
        folders = [Path(of(job)) for job in (one, two)]
        check_true("runs side by side have a session of MPI each", len(set(folders)) == 2 and all(f.is_dir() and f.name.startswith("clathra-mpi-") for f in folders), folders)
    check_true("... and leave none", not any(f.exists() for f in folders), folders)


def deaf():
    """A program that does not end is killed; so is what it started."""
    script = OUT / "deaf"
    script.write_text("#!/bin/sh\ntrap '' USR1\nsleep 60\n")
    script.chmod(0o755)
    job = clathra.Job([script])
    check_true("a program that does not stop is killed", job.stop(0.1) == -signal.SIGTERM and "killed by signal 15" in job.sentence() and not running(script), job.sentence())


def iter_until(job, there):
    for now in job.follow(0.05):
        yield now
        if there(now):
            return


def left_alone():
    """Ctrl-C and the end of Python end what they started, those of a sweep, too."""
    again = "signal.signal(signal.SIGINT, signal.default_int_handler)"  # where a shell has let it be ignored
    script = f"import clathra, signal; {again}; clathra.Case({str(OUT / 'written.yaml')!r}, {binary()!r}).with_(stepper_dt=1e-3).%s"
    for what, call, number in (("Ctrl-C", "run('{}')", signal.SIGINT), ("... in a sweep", "sweep('{}')", signal.SIGINT), ("the end of Python", "start('{}'); import time; time.sleep(1.5)", None)):
        folder, call = scratch(), call if "sweep" not in call else "name; clathra.sweep(clathra.Case(%r, %r).with_(stepper_dt=1e-3), {'grid_cells': ['20,1', '40,1', '60,1']}, '{}', jobs=2)" % (
            str(OUT / "written.yaml"), binary())  # fmt: skip
        python = subprocess.Popen([sys.executable, "-c", script % call.replace("'{}'", repr(str(folder)))], env=environment(PYTHONPATH=str(ROOT / "python")), stderr=subprocess.PIPE, text=True)
        wanted = 2 if "sweep" in call else 1
        while len(list(folder.rglob("balance.csv"))) < wanted:
            time.sleep(0.02)
        if number:
            python.send_signal(number)
        said = python.communicate(timeout=60)[1]
        logs = [log.read_text() for log in folder.rglob("log.txt")]
        check_true(f"{what}: nothing is left running", not running(folder), running(folder))
        check_true("... all ended with a checkpoint, and no more was begun", len(logs) == wanted and all("Ended by signal" in log for log in logs) and ("KeyboardInterrupt" in said) == bool(number), said[-300:])


def lacking():
    """Without h5py all but snapshots, without scipy all but calibrate, without numpy nothing: in one sentence."""
    (OUT / "lacking.py").write_text(f"""import sys
sys.modules[sys.argv[1]] = None
import clathra
case = clathra.Case({str(OUT / 'written.yaml')!r}, {binary()!r}).with_(time_end=2)
parts = clathra.sweep(case, {{"mat_clay_porosity": [0.3, 0.4]}}, sys.argv[2])
print([part.code for part in parts], len(parts[0].run.probes), len(parts[0].run.times) if sys.argv[1] != "h5py" else "")
clathra.calibrate(case, {{"mat_clay_porosity": (0.2, 0.5)}}, {{"base.p_Pa": (1, 1e5)}}, sys.argv[2]) if sys.argv[1] == "scipy" else parts[0].run.particles()
""")
    for module, words, works in (("h5py", "h5py, which reading snapshots needs", True), ("scipy", "scipy, which clathra calibrate needs", True), ("numpy", "numpy, which clathra needs", False)):
        done = subprocess.run([sys.executable, OUT / "lacking.py", module, OUT / f"without_{module}"], env=environment(PYTHONPATH=str(ROOT / "python")), capture_output=True, text=True)
        last = done.stderr.strip().splitlines()[-1]
        check_true(f"without {module}: one sentence", last == f"ImportError: {sys.executable} has no module {words} (Debian: python3-{module})", last)
        check_true(f"... and {'the rest works' if works else 'nothing else'}", done.stdout.startswith("[0, 0] ") == works, done.stdout)


for part in (cases, wrong, under_way, apart, deaf, left_alone, lacking):
    begun = time.monotonic()
    part()
    print(f"{part.__name__}: {time.monotonic() - begun:.1f} s")
check("processes left", len(running(OUT)), 0)
finish()
