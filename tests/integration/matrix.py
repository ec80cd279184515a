#!/usr/bin/python3
"""scripts/matrix.sh without a chroot: its words, its refusals, and what a failure or a signal leaves.  The workflow and the Containerfile
name what exists."""
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, check_true, finish, scratch  # noqa: E402

TREE = scratch()  # whose results it may write
(TREE / "scripts").mkdir()
for script in ("matrix.sh", "setup.sh"):
    shutil.copy(ROOT / "scripts" / script, TREE / "scripts")
SCRIPT = TREE / "scripts" / "matrix.sh"


def environment(**programs):
    """One in which these programs are shell scripts of so many words."""
    folder, temporary = scratch(), scratch()
    for name, text in programs.items():
        path = folder / name.replace("_", "-")
        path.write_text(f"#!/bin/sh\n{text}\n")
        path.chmod(0o755)
    return {**os.environ, "PATH": f"{folder}:/usr/bin:/bin", "TMPDIR": str(temporary)}


def says(name, code, sentence, *words, env=None):
    done = subprocess.run([SCRIPT, *words], capture_output=True, text=True, env=env, stdin=subprocess.DEVNULL)
    said = done.stdout + done.stderr
    check_true(name, done.returncode == code and sentence in said, f"{done.returncode}: {said.strip()[-300:]}")
    return done


def command_lines():
    for path in Path("/proc").glob("[0-9]*/cmdline"):
        try:
            yield path.read_text(errors="replace")
        except OSError:  # it has ended
            pass


usage = says("--help says what there is", 0, "SYSTEM", "--help").stdout
says("a word that is none of its own", 2, "'14' is neither a system", "14")
says("--mirror without one", 2, "--mirror needs a URL", "13", "--mirror")
says("JOBS that is no number", 2, "not a number of jobs", env={**os.environ, "JOBS": "many"})
says("no root", 1, "needs root", "13", env=environment(id="echo 1000"))
if not any(Path(folder, "debootstrap").exists() for folder in ("/usr/bin", "/bin")):
    says("no debootstrap", 1, "needs debootstrap", "13", env=environment(id="echo 0"))
says("no mirror", 1, "names no mirror", "13", env=environment(id="echo 0", debootstrap="exit 1", apt_get="exit 0"))

if subprocess.run(["unshare", "--mount", "--pid", "--fork", "true"], capture_output=True).returncode == 0 and os.geteuid() == 0:
    asked = scratch() / "asked"
    env = environment(debootstrap=f'echo "$@" >{asked}; exit 1')
    says("no chroot: a row says so", 1, "| Debian testing | no chroot", "testing", "gcc", "--mirror", "http://mirror.example", env=env)
    check_true("... the mirror was asked for that system", "testing" in asked.read_text() and "http://mirror.example" in asked.read_text(), asked.read_text())
    check_true("... nothing is left", not os.listdir(env["TMPDIR"]), os.listdir(env["TMPDIR"]))

    folders = " ".join(f'"$3/{f}"' for f in ("proc", "sys", "dev/pts", "dev/shm", "etc/apt/apt.conf.d", "etc/dpkg/dpkg.cfg.d"))
    head, row = "| system | PETSc | compiler | built | warnings | installed | passed / failed |", "| Debian 12 | 3.18.1 | gcc 12.2.0 | yes | 0 | %s |"
    for name, code, said, counted in (("all passed", 0, row % "yes | 44 / 0", 1), ("one failed", 1, row % "yes | 43 / 1: docs ", 1), ("nothing ran", 1, row % "yes | 0 / 0", 1),
                                      ("what is installed does not run", 1, row % "no | 44 / 0", 1),
                                      ("no row", 1, "| 12, gcc | not built: ", 0)):  # fmt: skip
        env = environment(debootstrap=f"mkdir -p {folders}", chroot=f"echo '{head}'; " + (f"echo '{said}'" if counted else "exit 1"))
        done = says(f"{name}: a row says so", code, said, "12", "gcc", "--mirror", "http://mirror.example", env=env)
        check_true("... in a table of its own", done.stdout.count("\n") == 3 and done.stdout.startswith(head), done.stdout)

    begun, seconds = scratch() / "begun", f"1234.{os.getpid()}"
    env = environment(debootstrap=f'mkdir "$3"; mount -t tmpfs tmpfs "$3"; echo >"$3/file"; echo >{begun}; exec sleep {seconds}')
    process = subprocess.Popen([SCRIPT, "12", "--mirror", "http://mirror.example"], env=env, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    end = time.monotonic() + 60
    while not begun.exists() and time.monotonic() < end:
        time.sleep(0.05)
    process.send_signal(signal.SIGTERM)
    check_true("a signal ends it", process.wait(60) == 143 and begun.exists(), process.returncode)
    check_true("... its folder is gone", not os.listdir(env["TMPDIR"]), os.listdir(env["TMPDIR"]))
    check_true("... its mounts are gone", env["TMPDIR"] not in Path("/proc/mounts").read_text())
    check_true("... and what it started", not any(seconds in words for words in command_lines()))

workflow, image = ((ROOT / path).read_text() for path in (".github/workflows/ci.yml", "Containerfile"))
for name, text in (("workflow", workflow), ("Containerfile", image)):
    commands = "\n".join(line for line in text.splitlines() if not line.startswith("#"))
    scripts = set(re.findall(r"(?:\./|\bscripts/)[\w.]+", commands))
    check_true(f"{name}: its first line says whether it was run", text.startswith("# Not run by its authors"))
    check_true(f"{name}: the scripts that it calls are there", scripts and all(os.access(ROOT / s, os.X_OK) for s in scripts), scripts)
    check_true(f"{name}: no list of packages of its own", not set(re.findall(r"install (?:-\S+ )*(.*)", commands)) - {"debootstrap"})
functions = re.findall(r"^(\w+)\(\)", (ROOT / "scripts" / "setup.sh").read_text(), re.M)
called = re.findall(r"\bsetup_\w+", image.replace("setup.sh", ""))
check_true("Containerfile: the functions that it calls are those of scripts/setup.sh", called and set(called) <= set(functions), called)
words = [w for line in re.findall(r"(?:system|compiler): \[(.*)\]", workflow) for w in re.findall(r"\w+", line)]
check_true("workflow: its systems and compilers are those of scripts/matrix.sh", words and all(re.search(rf"\b{w}\b", usage) for w in words), words)
finish()
