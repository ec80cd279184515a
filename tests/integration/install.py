#!/usr/bin/python3
"""What `cmake --install` and `pip install ./python` make of a build: a prefix that works from another folder, in a clean environment and
where it is moved to, and needs nothing of the source tree; what a python3 without numpy or h5py says.
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, binary, check_true, finish, scratch  # noqa: E402

PYTHON = "/usr/bin/python3"
BUILD = Path(binary()).resolve().parent
PACKAGE = "lib/python3/dist-packages"
READS = "import clathra; run = clathra.Run('out'); print(clathra.__file__, run.finished, len(run.times), run.particles()['p_w'].max())"
AWAY = scratch()  # the working folder of every command


def call(*words, **environment):
    """A command from another folder, with nothing in its environment but the path and what is given."""
    return subprocess.run(list(map(str, words)), cwd=AWAY, env={"PATH": "/usr/bin:/bin", "HOME": str(AWAY), "PYTHONDONTWRITEBYTECODE": "1", **environment},
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=120)  # fmt: skip


def shipped():
    """Cases and presets of the tree: those that git knows, or all where there is no git."""
    tracked = call("git", "-C", ROOT, "-c", "safe.directory=*", "ls-files", "cases", "options")
    return tracked.stdout.split() if tracked.returncode == 0 else [p.relative_to(ROOT).as_posix() for kind in ("cases", "options") for p in (ROOT / kind).rglob("*") if p.is_file()]


def strangers():
    """A user's case, preset and results in the tree are not installed."""
    tree, prefix = scratch() / "tree", scratch()
    tree.mkdir()
    for name in ("src", "include", "python", "docs", "LICENSE", "CMakeLists.txt"):
        (tree / name).symlink_to(ROOT / name)
    for name in ("cases", "options"):
        shutil.copytree(ROOT / name, tree / name)
    for name in ("cases/mine/case.yaml", "cases/bp2/out/case.yaml", "cases/bp2/probes.csv", "cases/bp2/reference/mine.csv", "options/mine.opts"):
        (tree / name).parent.mkdir(exist_ok=True)
        (tree / name).write_text("mine\n")
    done = call("cmake", "-S", tree, "-B", tree / "build", "-DCLATHRA_TESTS=OFF")
    check_true("a tree with a user's files is configured", done.returncode == 0, done.stdout[-300:])
    call("cmake", "--install", tree / "build", "--component", "data", "--prefix", prefix)
    names = {p.relative_to(prefix / "share/clathra").as_posix() for p in prefix.rglob("*") if p.is_file()}
    check_true("... and what is shipped is installed alone", names == set(shipped()), sorted(names ^ set(shipped())))


def installed(prefix):
    done = call("cmake", "--install", BUILD, "--prefix", prefix)
    check_true("cmake --install installs", done.returncode == 0, done.stdout[-300:])
    names = {p.relative_to(prefix).as_posix() for p in prefix.rglob("*") if p.is_file()}
    wanted = {"bin/clathra", "bin/clathra3d", "share/man/man1/clathra.1", "share/doc/clathra/LICENSE"}
    wanted |= {f"{PACKAGE}/{p.relative_to(ROOT / 'python').as_posix()}" for p in (ROOT / "python" / "clathra").glob("*.*")}
    wanted |= {f"share/clathra/{name}" for name in shipped()}
    check_true("... programs, presets, cases, man page, licence and the Python package", wanted <= names, sorted(wanted - names))
    check_true("... and no file besides", names <= wanted, sorted(names - wanted))
    texts = [n for n in names if not n.startswith("bin/") and str(ROOT).encode() in (prefix / n).read_bytes()]
    check_true("... no file of which names the source tree", not texts, texts)


def source_free(program):
    """Of the source tree it names files in PETSc's traces, which a run does not read, and nothing else."""
    found = re.findall(re.escape(str(ROOT).encode()) + rb"[^\0]*", program.read_bytes())
    needed = [path.decode() for path in found if not re.search(rb"/(src|include|tests)/[\w/]+\.[ch]$", path)]
    check_true(f"{program.name} needs nothing of the source tree", not needed, needed[:3])


def works(prefix, where):
    """Runs a case, reads it, and finds the driver of strength."""
    shutil.rmtree(AWAY / "out", ignore_errors=True)
    done = call(prefix / "bin/clathra", prefix / "share/clathra/cases/terzaghi", "-time_end", "100 s", "-output_times", "0 s,100 s", "-output_dir", "out",
                "-options_file", prefix / "share/clathra/options/fast.opts")  # fmt: skip
    check_true(f"{where}: it runs a case with a preset", done.returncode == 0 and ": finished at t = " in done.stdout, done.stdout[-300:])
    read = call(PYTHON, "-c", READS, PYTHONPATH=str(prefix / PACKAGE))
    check_true("... which the Python package reads", read.returncode == 0 and read.stdout.startswith(f"{prefix}/{PACKAGE}") and " True 2 " in read.stdout, read.stdout[-300:])
    done = call(prefix / "bin/clathra", "strength", "--help")
    check_true("... clathra strength --help explains", done.returncode == 0 and "--low F" in done.stdout, done.stdout[-300:])
    done = call(prefix / "bin/clathra", prefix / "share/clathra/cases/collapse_3d", "-case_check")
    check_true("... and hands a case of three axes over", done.returncode == 0 and "the case is valid" in done.stdout, done.stdout[-300:])


def manual(prefix):
    page = (prefix / "share/man/man1/clathra.1").read_text().replace("\\-", "-")
    named = {f"-{name}" for name in re.findall(r"(?<![\w-])-([a-z]\w+)", page)}
    known = (ROOT / "docs" / "options.md").read_text() + "`-help`" + "`-options_file`"
    check_true("the man page names options that there are", len(named) > 8 and all(f"`{name}`" in known or f"`{name[1:]}`" in known for name in named), sorted(named))
    codes = re.findall(r"^\.TP\n\.B (\d)$", page, re.M)
    said = re.search(r"Exit codes: (.*?)\n\n", call(prefix / "bin/clathra", "-help").stdout, re.S)[1]
    check_true("... and the exit codes of -help", codes == re.findall(r"\b(\d) [a-z]", said), f"{codes} {said}")
    example = re.search(r"^\.EX\nclathra (.*)$", page, re.M)[1].replace("/usr/local", shlex.quote(str(prefix))).replace(r"\(dq", '"')
    done = call(prefix / "bin/clathra", *shlex.split(example), "-case_check")
    check_true("... and an example that is valid", done.returncode == 0, done.stdout[-300:])


def lacking(package):
    """A python3 without numpy, and one that has numpy alone."""
    bare = scratch()
    done = call(PYTHON, "-S", "-c", "import clathra", PYTHONPATH=str(package))
    said = "has no module {0}, which {1} needs (Debian: python3-{0})"
    check_true("without numpy the package says so in a sentence", done.returncode == 1 and said.format("numpy", "clathra") in done.stdout.splitlines()[-1], done.stdout[-300:])
    for part in Path(np.__file__).parents[1].glob("numpy*"):
        (bare / part.name).symlink_to(part)
    done = call(PYTHON, "-S", "-c", READS, PYTHONPATH=os.pathsep.join(map(str, (package, bare))))
    check_true("... without h5py as well, where a snapshot is read", done.returncode == 1 and said.format("h5py", "reading snapshots") in done.stdout.splitlines()[-1], done.stdout[-300:])


def pip_installs():
    """pip install without a network, from a copy: it builds in the folder that it is given."""
    source, target = scratch() / "python", scratch()
    shutil.copytree(ROOT / "python", source, ignore=shutil.ignore_patterns("build", "*.egg-info", "__pycache__"))
    done = call(PYTHON, "-m", "pip", "install", "-q", "--no-build-isolation", "--no-index", "--no-deps", "--target", target, source)
    check_true("pip install ./python installs the package", done.returncode == 0 and all((target / "clathra" / name).is_file() for name in ("run.py", "report.html")), done.stdout[-300:])
    read = call(PYTHON, "-c", READS, PYTHONPATH=str(target))
    check_true("... which reads the run", read.returncode == 0 and read.stdout.startswith(str(target)) and " True 2 " in read.stdout, read.stdout[-300:])


first, second = scratch() / "a prefix", scratch() / "moved" / "there"
strangers()
installed(first)
for name in ("clathra", "clathra3d"):
    source_free(first / "bin" / name)
works(first, "as installed")
manual(first)
lacking(first / PACKAGE)
pip_installs()
shutil.move(first, second)
works(second, "moved elsewhere")
finish()
