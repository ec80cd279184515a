"""Running the program and judging its results, for the Python tests.

A test is a program: its first argument is the path of clathra.

    from common import Run, check, finish, table
    run = Run.of_case("bp2", "-grid_cells", "50,1")
    check("p at 1000 s", abs(run.probe("inner")["p_Pa"][-1] / 3.25e6 - 1), 0.01)
    finish()

Tests outside this folder first put it on their path:
    sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
"""
import atexit
import json
import math
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "python"), str(ROOT / "scripts")]
from clathra import probe_names, program, read_csv, read_snapshots  # noqa: E402
from clathra.units import pascals, seconds  # noqa: E402

CASES = ROOT / "cases"
np.set_printoptions(legacy="1.21")  # repr of a number is the number alone, which cases can read; NumPy 2 writes its type, too
# pml: starting takes 0.11 s instead of 0.41 s, for no networks are looked for (a library of one times a clock).
ENVIRONMENT = {**program.ENVIRONMENT, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_MCA_pml": "ob1"}


def binary():
    """Path of the program: the test's first argument, else the release build."""
    return sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "build" / "clathra")


def program_of(case):
    """The program that runs a case of cases/: that of space where the name ends in _3d."""
    return Path(binary()).with_name("clathra3d") if Path(case).stem.endswith("_3d") else binary()


MEMORY = Path("/dev/shm")


def room():
    """Where there is memory for it, files of tests stay there: a run syncs some forty of them, for which a busy disk takes 0.2 s."""
    return MEMORY if MEMORY.is_dir() and os.access(MEMORY, os.W_OK) and shutil.disk_usage(MEMORY).free > 4e9 else None


def scratch():
    """A new empty folder, removed when the test ends; kept in $CLATHRA_KEEP if that is set."""
    keep = os.environ.get("CLATHRA_KEEP")
    if keep:
        Path(keep).mkdir(parents=True, exist_ok=True)
    folder = Path(tempfile.mkdtemp(prefix="clathra-", dir=keep or room()))
    if not keep:
        atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


_sessions = tempfile.TemporaryDirectory(prefix="clathra-mpi-")


def environment(**more):
    """{name: value} for one run, with a folder of its own for MPI's session: of two runs that share one, the first to end may remove
    what the other has just made."""
    return {**os.environ, **ENVIRONMENT, "OMPI_MCA_orte_tmpdir_base": tempfile.mkdtemp(dir=_sessions.name), **more}


# Before a run of one rank: ranks that wait for each other on a core take up to ten times as long beside it, and it goes to the other core.
GIVES_WAY = ["nice", "-n", "10"]


def mpiexec(ranks):
    """The beginning of a command on several ranks, which share one core."""
    return [sys.executable, "-S", str(ROOT / "tests" / "one_core.py"), "mpiexec", "-n", str(ranks)]


def launch(program, case, *options, ranks=1, out=None, timeout=800):
    """Runs the program without judging it; returns subprocess.CompletedProcess (stdout holds both streams)."""
    command = [str(program), str(case), *map(str, options)]
    if out is not None:
        command += ["-output_dir", str(out)]
    command = [*(mpiexec(ranks) if ranks > 1 else GIVES_WAY), *command]
    return subprocess.run(
        command, env=environment(), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT, timeout=timeout, text=True, errors="replace",
    )  # fmt: skip


def command(*words, **more):
    """clathra COMMAND ..., which is Python's: subprocess.CompletedProcess; `more`: of its environment."""
    return subprocess.run([binary(), *map(str, words)], env=environment(**more), stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=300)


class Run:
    """What a finished run left behind.  Files are read when first asked for.

    out      Path of the output folder
    code     exit code
    output   what the program printed
    probes   {column of probes.csv: (rows,) array}
    balance  {column of balance.csv: (steps,) array}
    """

    def __init__(self, out, code=0, output=""):
        self.out, self.code, self.output = Path(out), code, output
        self._csv = {}

    @staticmethod
    def of_case(case, *options, ranks=1, out=None, exit_code=0, timeout=800):
        """Runs cases/<case> (or a path) with the program under test."""
        folder = CASES / str(case)
        return run(program_of(case), folder if folder.is_dir() else case, *options, ranks=ranks, out=out, exit_code=exit_code, timeout=timeout)

    def csv(self, name):
        if name not in self._csv:
            self._csv[name] = read_csv(self.out / name)
        return self._csv[name]

    @property
    def probes(self):
        return self.csv("probes.csv")

    @property
    def balance(self):
        return self.csv("balance.csv")

    def steps(self, row):
        """Steps until a row of the balance, of which hybrid has one for up to 256 steps."""
        return int(self.balance["step"][row])

    @property
    def time(self):
        """(rows,) times of the probe rows, s."""
        return self.probes["time_s"]

    @property
    def probe_names(self):
        return probe_names(self.probes)

    def probe(self, name):
        """{quantity: (rows,) array} of one probe: p_Pa, T_degC, S_h, u_x_m, ..."""
        head = name + "."
        columns = {c[len(head) :]: v for c, v in self.probes.items() if c.startswith(head)}
        if not columns:
            raise KeyError(f"no probe {name}; there are {', '.join(self.probe_names)}")
        return columns

    def at(self, name, quantity, times):
        """Values of a probe's quantity at times (s), linear between rows."""
        return np.interp(times, self.time, self.probe(name)[quantity])

    def snapshots(self, kind="particles"):
        """[(time (s), {variable: (n, components) array})] in order of time; kind particles (sorted by id) or grid."""
        return read_snapshots(self.out, kind)

    def snapshot(self, time, kind="particles"):
        """Variables of the snapshot at `time` (s), which must exist."""
        for t, variables in self.snapshots(kind):
            if math.isclose(t, time, rel_tol=1e-9, abs_tol=1e-9):
                return variables
        raise KeyError(f"no {kind} snapshot at {time} s in {self.out}")


CHANGE = re.compile(r"^t = (\S+ \w+): (\w+) -> (\w+):", re.M)  # of the integrator, as a run says it


def changes(run):
    """[(time in s, from, to)] of the changes of the integrator that a run said."""
    return [(seconds(t), a, b) for t, a, b in CHANGE.findall(run.output)]


def last_places(run):
    """(n, axes) places (m) of a Run's particles at its last snapshot, in the order of their numbers, which ranks do not change."""
    last = run.snapshots()[-1][1]
    return last["position"][last["id"].ravel().argsort()]


def run(program, case, *options, ranks=1, out=None, exit_code=0, timeout=800):
    """Runs a case to its end and returns its Run; another exit code (or none of several) ends the test with what the program said."""
    out = scratch() / "out" if out is None else out
    done = launch(program, case, *options, ranks=ranks, out=out, timeout=timeout)
    if done.returncode not in np.atleast_1d(exit_code):
        print(" ".join(map(str, done.args)))
        print("\n".join(done.stdout.splitlines()[-40:]))
        sys.exit(f"exit code {done.returncode} instead of {exit_code}")
    return Run(out, done.returncode, done.stdout)


# ---------------------------------------------------------------------------------------- judging and reporting
_results = []


def check(name, value, bar):
    """Records whether value <= bar, or lower <= value <= upper when bar is a pair; NaN fails.  Returns the verdict."""
    low, high = bar if isinstance(bar, (tuple, list)) else (-math.inf, bar)
    value = float(value)
    ok = low <= value <= high
    limit = f"in [{low:g}, {high:g}]" if math.isfinite(low) else f"<= {high:g}"
    print(f"{'ok  ' if ok else 'FAIL'} {name:60s} {value:12.5g}  {limit}", flush=True)
    _results.append(ok)
    return ok


def check_true(name, condition, note=""):
    """Records a yes or no."""
    print(f"{'ok  ' if condition else 'FAIL'} {name}{'  ' + str(note) if note else ''}", flush=True)
    _results.append(bool(condition))
    return bool(condition)


def table(headers, rows):
    """Prints rows of text and numbers (six digits) under headers, columns aligned."""
    text = [[c if isinstance(c, str) else f"{c:.6g}" for c in row] for row in rows]
    widths = [max(len(r[k]) for r in [list(headers), *text]) for k in range(len(headers))]
    for row in [list(headers), ["-" * w for w in widths], *text]:
        print("  ".join(c.rjust(w) for c, w in zip(row, widths)), flush=True)


def order(steps, errors):
    """Observed orders of convergence between neighbours: log(e1/e2)/log(h1/h2), (n-1,) array."""
    steps, errors = np.asarray(steps, float), np.asarray(errors, float)
    return np.log(errors[:-1] / errors[1:]) / np.log(steps[:-1] / steps[1:])


def largest_difference(values, reference, scale=None):
    """Largest |values - reference|, over `scale` (default: the largest |reference|)."""
    values, reference = np.asarray(values, float), np.asarray(reference, float)
    return np.max(np.abs(values - reference)) / (np.max(np.abs(reference)) if scale is None else scale)


_records = []


def record(row, what, bar, measured, ok):
    """Notes one line of docs/studies/verification.md: row of the table, what is measured, its bar, the value (text or numbers).

    Kept in $CLATHRA_RESULTS/<test>.json if that is set, and read by scripts/verification.py.  It prints nothing and is
    no check of its own, but a test that records a failure does not end well.
    """
    text = [v if isinstance(v, str) else f"{v:.3g}" for v in (bar, measured)]
    test = Path(sys.argv[0]).stem
    _records.append({"row": row, "what": what, "bar": text[0], "measured": text[1], "ok": bool(ok), "test": test})
    folder = os.environ.get("CLATHRA_RESULTS")
    if folder:
        Path(folder).mkdir(parents=True, exist_ok=True)
        (Path(folder) / f"{test}.json").write_text(json.dumps(_records, indent=1) + "\n")


def judge(row, what, value, bar, scale=1.0, unit=""):
    """check() and record() in one: shown and recorded in units of `scale`, e.g. 0.01 and "%"."""
    ok = check(what, value, bar)
    pair = bar if isinstance(bar, (tuple, list)) else (bar,)
    show = lambda v: f"{v / scale:.3g}" + (f" {unit}" if unit else "")
    record(row, what, " to ".join(map(show, pair)) if len(pair) > 1 else f"< {show(bar)}", show(value), ok)
    return ok


def finish():
    """Prints the count and ends the test; nothing checked is a failure."""
    failed = _results.count(False)
    print(f"{_results.count(True)} passed, {failed} failed")
    sys.exit(1 if failed or not _results or not all(r["ok"] for r in _records) else 0)
