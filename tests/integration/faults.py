#!/usr/bin/python3
"""Nothing is lost when a run is killed, the disk is full or goes away, a write fails, or a folder is shared.

A run of the first minute of BP2 case 2 on 13 cells is disturbed at one of the system calls that change its folder (see
fault.c) and then gone on with, from its last checkpoint or anew: what is left must be that of the undisturbed run, bit
for bit, and the disturbed run must have said in one sentence what could not be written (exit code 3).  A few calls of
each kind are taken; CLATHRA_FAULTS=all takes all.
"""
import os
import resource
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import different, hashes  # noqa: E402
from common import CASES, GIVES_WAY, ROOT, Run, binary, check_true, environment, finish, launch, mpiexec, scratch  # noqa: E402

OPTIONS = ("-quiet", "-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s", "-checkpoint_every",
           "20 s", "-stepper_dt_max", "5 s", "-meters", "outlet", "-meter_outlet_side", "right")  # fmt: skip
TWO = ("-options_file", ROOT / "options" / "krylov.opts")  # bit for bit on two ranks: MUMPS adds in the order in which messages arrive
FINE = ("-stepper_dt", "0.1 s", "-stepper_dt_max", "0.2 s")
BP2 = CASES / "bp2"
ALL = os.environ.get("CLATHRA_FAULTS") == "all"


def command(out, *options):
    return [str(binary()), str(BP2), *OPTIONS, *options, "-output_dir", str(out)]


def start(out, *options, extra=None, **keywords):
    return subprocess.Popen([*GIVES_WAY, *command(out, *options)], env=environment(**(extra or {})), text=True,
                            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **keywords)  # fmt: skip


def shim():
    library = scratch() / "fault.so"
    source = Path(__file__).with_name("fault.c")
    subprocess.run(["cc", "-shared", "-fPIC", "-O1", "-o", library, source, "-ldl"], check=True)
    return library


LIBRARY = shim()
straight = Run(scratch() / "out")


def disturbed(how, at, out, *options):
    count = out.parent / f"{out.name}.count"
    job = start(out, *options, extra={"LD_PRELOAD": str(LIBRARY), "FAULT_DIR": str(out), "FAULT_HOW": how,
                                      "FAULT_AT": str(at), "FAULT_COUNT": str(count)})  # fmt: skip
    text = job.communicate(timeout=300)[0]
    return job.returncode, text, int(count.read_text()) if count.is_file() else 0


def sentence_missing(how, code, text, out):
    """What is wrong with the end of a disturbed run; "" if nothing."""
    if "PETSC ERROR" in text or "HDF5-DIAG" in text:
        return "a trace"
    if how == "kill":
        return "" if code == -signal.SIGKILL else f"exit code {code}"
    if code == 0:  # a call whose failure changes nothing
        return ", ".join(different(straight.out, out)[:3])
    if code != 3 and not (code == 2 and how == "gone" and not (out / "case.yaml").exists()):
        return f"exit code {code}"
    return "" if f"cannot write {out}" in text else f"says: {text[-200:]}"


def survive(job):
    """Disturbs a run, goes on with it, and compares; the complaint, or ""."""
    how, at = job
    out = scratch() / "out"
    try:
        code, text, _ = disturbed(how, at, out)
        wrong = sentence_missing(how, code, text, out)
        if wrong:
            return f"{how} at call {at}: {wrong}"
        if code == 0:
            return ""
        checkpoint = out / "checkpoint.h5"
        done = launch(binary(), BP2, *OPTIONS, *(("-restart", checkpoint) if checkpoint.exists() else ()), out=out)
        if done.returncode:
            return f"{how} at call {at}: gone on with exit code {done.returncode}: {done.stdout[-300:]}"
        names = different(straight.out, out)
        return f"{how} at call {at}: others {names[:3]}" if names else ""
    finally:
        if not os.environ.get("CLATHRA_KEEP"):
            shutil.rmtree(out.parent, ignore_errors=True)


def check_calls():
    code, text, calls = disturbed("none", 0, straight.out)
    check_true("the undisturbed run", code == 0 and calls > 60, f"{calls} calls: {text[-200:] if code else ''}")
    every = 1 if ALL else max(1, calls // 6)
    for k, how in enumerate(("kill", "full", "once", "gone")):
        places = range(1 + (0 if ALL else k), calls + 1, every)
        wrong = [w for w in (survive((how, at)) for at in places) if w]
        check_true(f"{how}: said, and gone on with to the same bits, at {len(places)} of {calls} calls", not wrong,
                   "; ".join(wrong[:5]))  # fmt: skip


def wait_for(path, job):
    for _ in range(3000):
        if path.exists() or job.poll() is not None:
            return
        time.sleep(0.01)


def check_limit():
    """A real limit of the system instead of the preloaded one: no file above 24 kB, set once MPI has made its own."""
    out = scratch() / "out"
    job = start(out, *FINE, "-checkpoint_every", "1 s")
    wait_for(out / "run.id", job)
    resource.prlimit(job.pid, resource.RLIMIT_FSIZE, (24000, 24000))
    text = job.communicate(timeout=300)[0]
    check_true("files limited to 24 kB: exit code 3 and a sentence", job.returncode == 3 and "PETSC ERROR" not in text
               and f"cannot write {out}" in text and "File too large" in text, text[-200:])  # fmt: skip


def two_ranks(how="", at=0):
    """The same run on two ranks, disturbed on both; its folder."""
    out = scratch() / "out"
    job = subprocess.run([*mpiexec(2), *command(out, *map(str, TWO))], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                         stderr=subprocess.STDOUT, text=True, timeout=300, env=environment(FAULT_DIR=str(out), FAULT_HOW=how,
                         FAULT_AT=str(at), **({"LD_PRELOAD": str(LIBRARY)} if how else {})))  # fmt: skip
    return out, job


def check_two_ranks():
    """Files that two ranks write together: without room for one, and killed in the middle."""
    whole, job = two_ranks()
    check_true("two ranks", job.returncode == 0, job.stdout[-300:])
    asked = {1: "fields/000000.h5", 2: "checkpoint.h5", 3: "fields/000001.h5"}
    for how, at in [("room", k) for k in asked] + [("kill", k) for k in (85, 120, 200)] + [("once", 85)]:
        out, job = two_ranks(how, at)
        said = job.returncode == 3 and f"cannot write {out / asked.get(at, '')}: No space left" in job.stdout and "HDF5" not in job.stdout
        check_true(f"two ranks, {how} {at}: {'said' if how == 'room' else 'ended'}",
                   said and not list(out.rglob("*.tmp*")) if how == "room" else job.returncode not in (0, 2, 3), job.stdout[-400:])  # fmt: skip
        checkpoint = out / "checkpoint.h5"
        done = launch(binary(), BP2, *OPTIONS, *TWO, *(("-restart", checkpoint) if checkpoint.exists() else ()), out=out, ranks=2)
        names = different(whole, out) if done.returncode == 0 else ["all"]
        check_true(f"... gone on with {'from its checkpoint' if checkpoint.exists() else 'anew'} to the same bits",
                   not names, f"{names[:5]} {done.stdout[-300:]}")  # fmt: skip


def rows(out):
    return len((out / "balance.csv").read_text().splitlines())


def check_identity():
    """A checkpoint of another run in the same folder is no place to go on from, nor is one that the files have left behind."""
    out, other = scratch() / "out", scratch() / "other"
    old = out / "checkpoint.h5"
    first = launch(binary(), BP2, *OPTIONS, out=out)
    was = (out / "run.id").read_text()
    job = start(out, *FINE, "-checkpoint_every", "0 s")  # the same case anew, killed before its first
    while job.poll() is None and ((out / "run.id").read_text() == was or rows(out) not in range(2, 20)):
        time.sleep(0.01)
    job.kill()
    job.communicate()
    before = hashes(out, but="run.lock")
    done = launch(binary(), BP2, *OPTIONS, "-restart", old, out=out)
    check_true("a checkpoint of the run before: refused, nothing changed", first.returncode == 0 and done.returncode == 2
               and "was not written by the run whose files are in" in done.stdout and hashes(out, but="run.lock") == before, done.stdout[-200:])  # fmt: skip
    done = launch(binary(), BP2, *OPTIONS, "-time_end", "80 s", "-restart", old, out=other)
    check_true("... taken in another folder", done.returncode == 0 and "finished at t = 80" in done.stdout,
               done.stdout[-200:])  # fmt: skip
    older = launch(binary(), BP2, *OPTIONS, "-time_end", "50 s", "-output_times", "0 s,30 s", "-checkpoint_every", "0 s",
                   "-restart", f"{straight.out / 'checkpoint.h5'}.old", out=straight.out)  # fmt: skip
    lost = launch(binary(), BP2, *OPTIONS, "-restart", f"{straight.out / 'checkpoint.h5'}.old", out=straight.out)
    check_true("back to an older checkpoint, and on; the later one of the first run is refused", older.returncode == 0 and
               lost.returncode == 2 and "does not belong to the files" in lost.stdout, lost.stdout[-200:])  # fmt: skip


def check_lost():
    """What is gone of the files of a run that is gone on with, or damaged, is said; elsewhere there is nothing to miss."""
    options, begun = (*OPTIONS, "-output_probe_every", "10 s"), scratch() / "out"
    launch(binary(), BP2, *options, "-stepper_max_steps", "12", out=begun)
    lines = lambda p, n: p.write_text("".join(p.read_text().splitlines(keepends=True)[:n]))
    for what, name, hurt, said in (
        ("nothing", "probes.csv", lambda p: None, ""),
        ("gone", "probes.csv", Path.unlink, "is missing; it begins anew at t = "),
        ("empty", "meters.csv", lambda p: p.write_text(""), "has not the columns of this run; it is kept as"),
        ("half", "balance.csv", lambda p: lines(p, 6), "lacks the rows from t = "),
        ("half", "probes.csv", lambda p: lines(p, 2), "lacks the rows from t = 0 s to t = "),
        ("the header alone", "meters.csv", lambda p: lines(p, 1), "lacks the rows from t = 0 s to t = "),
        ("a row without its end", "probes.csv", lambda p: p.write_text(p.read_text() + "1.0,2"), ""),
        ("a row of words", "probes.csv", lambda p: p.write_text(p.read_text().replace("e+", "x", 1)), "is damaged; 1 of its rows are left out"),
        ("gone", "fields/000000.h5", Path.unlink, "is missing; it is left out of fields.h5"),
        ("cut off", "fields/000000.h5", lambda p: p.write_bytes(p.read_bytes()[:9000]), "is damaged; it is set aside as"),
    ):
        out = scratch() / "out"
        shutil.copytree(begun, out)
        hurt(out / name)
        done = launch(binary(), BP2, *options, "-restart", out / "checkpoint.h5", out=out, ranks=1 + (what == "half"))
        check_true(f"{name}, {what}, at a restart: {'said' if said else 'nothing is'}", done.returncode == 0 and (
            f"warning: {out / name} {said}" in done.stdout if said else str(out / name) not in done.stdout), f"exit code {done.returncode}: {done.stdout[-200:]}")  # fmt: skip
    done = launch(binary(), BP2, *options, "-restart", begun / "checkpoint.h5", out=scratch() / "elsewhere")
    check_true("a restart into another folder misses nothing", done.returncode == 0 and "is missing" not in done.stdout and "lacks" not in done.stdout, done.stdout[-300:])


def check_lock():
    out = scratch() / "out"
    first = start(out, *FINE)
    wait_for(out / "run.id", first)
    second = launch(binary(), BP2, *OPTIONS, out=out)
    check_true("a second run in the folder of a living one: refused", second.returncode == 2 and
               f"process {first.pid}" in second.stdout and "another run" in second.stdout, second.stdout[-200:])  # fmt: skip
    first.kill()
    first.communicate()
    third = launch(binary(), BP2, *OPTIONS, out=out)
    check_true("... a dead one leaves no lock", third.returncode == 0, third.stdout[-200:])


def check_links():
    """Nothing outside of the folder is written over through a link in it."""
    for link, words in (("run.lock", "run.lock is a symbolic link"), ("case.yaml.tmp", "cannot write"), ("fields.h5.tmp", "cannot write")):
        out, outside = scratch() / "out", scratch() / "precious"
        outside.write_text("precious\n")
        out.mkdir()
        (out / link).symlink_to(outside)
        done = launch(binary(), BP2, *OPTIONS, "-stepper_max_steps", "1", out=out, ranks=1 + (link == "run.lock"))
        check_true(f"{link} is a symbolic link: refused, what it points to is as it was", done.returncode in (2, 3) and words in done.stdout and outside.read_text() == "precious\n",
                   f"exit code {done.returncode}: {done.stdout[-200:]}")  # fmt: skip


def check_signals():
    fine = (*FINE, "-checkpoint_every", "0 s")
    whole = launch(binary(), BP2, *OPTIONS, *fine, out=scratch() / "out")
    for name, number in (("SIGTERM", signal.SIGTERM), ("SIGINT", signal.SIGINT), ("SIGQUIT", signal.SIGQUIT)):
        out = scratch() / "out"
        job = start(out, *fine)
        while job.poll() is None and not ((out / "balance.csv").exists() and (out / "balance.csv").stat().st_size > 2000):
            time.sleep(0.01)
        job.send_signal(number)
        text = job.communicate(timeout=60)[0]
        rest = launch(binary(), BP2, *OPTIONS, *fine, "-restart", out / "checkpoint.h5", out=out)
        reference = Path(whole.args[-1])
        same = rest.returncode == 0 and not different(reference, out)
        check_true(f"{name}: exit code 4, a checkpoint, gone on with to the same bits", job.returncode == 4 and same and
                   "go on with -restart" in text and "PETSC ERROR" not in text, f"exit code {job.returncode}: {text[-200:]}")  # fmt: skip
    for name, number in (("SIGTERM", signal.SIGTERM), ("ctrl-C", signal.SIGINT)):
        out = scratch() / "out"
        job = start(out, *fine, extra={"LD_PRELOAD": str(LIBRARY), "FAULT_DIR": str(out), "FAULT_HOW": "wait", "FAULT_AT": "60"})
        wait_for(out / "balance.csv", job)
        time.sleep(0.5)  # it sleeps in a write now
        job.send_signal(number)
        time.sleep(0.2)
        job.send_signal(number)
        job.communicate(timeout=60)
        check_true(f"a second {name} ends it at once", job.returncode == -number, f"exit code {job.returncode}")


def check_streams():
    verbose = [c for c in command("") if c != "-quiet"]
    for name, redirection in (("closed", ">&-"), ("a pipe whose reader is gone", "| true"), ("full", "> /dev/full")):
        out = scratch() / "out"
        verbose[-1] = str(out)
        done = subprocess.run(["bash", "-c", f'"$@" {redirection}; exit ${{PIPESTATUS[0]}}', "-", *verbose], text=True,
                              capture_output=True, env=environment(), stdin=subprocess.DEVNULL)  # fmt: skip
        names = different(straight.out, out) if done.returncode == 0 else ["all"]
        check_true(f"standard output {name}: the run goes on", not names, f"exit code {done.returncode}: {names[:3]}")


def check_threads():
    """BLAS takes one thread unless the environment says otherwise."""
    words = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")
    plain = {k: v for k, v in environment().items() if k not in words}
    for given, threads in (({}, "1"), ({"OMP_NUM_THREADS": "2"}, "2"), ({"OPENBLAS_NUM_THREADS": "2"}, None)):
        out = scratch() / "out"
        job = subprocess.Popen(command(out, *FINE), env={**plain, **given}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE)
        wait_for(out / "balance.csv", job)
        seen = dict(s.split("=", 1) for s in Path(f"/proc/{job.pid}/environ").read_text().split("\0") if "=" in s)
        job.terminate()
        job.communicate(timeout=60)
        check_true(f"threads of BLAS with {given or 'nothing said'}: {threads or 'as given'}", seen.get(words[0]) == threads and job.returncode == 4,
                   f"{[seen.get(w) for w in words]}, exit code {job.returncode}")  # fmt: skip


check_calls()
check_limit()
check_two_ranks()
check_threads()
check_lock()
check_links()
check_signals()
check_streams()
check_identity()
check_lost()
finish()
