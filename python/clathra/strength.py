"""Factor of safety of a case by strength reduction.

Runs the case with strength divided by a factor (`strength_factor`, docs/laws.md (87)) and bisects to the largest one it bears.

Whether the body stands is read from what keeps moving in the last fifth of the run, or of its last stage.  Energies are taken as shares of
what the body has taken up: elastic and kinetic energy, and the plastic work since the stage began.
  It fails if it flows: plastic work of the last tenth is more than 1/100.
  It fails if it creeps: plastic work of the last fifth is more than 1/1000, and each quarter of it has at least an eighth of that.
  It fails if it moves off: in the last tenth gravity, loads and plates give more than they ever had, by 1/100, and its kinetic energy is
  more than half of that.
  It fails if the run cannot go on (exit code 3).
  Otherwise it stands.  It vibrates if kinetic energy of the last tenth is more than 1/10000 and what moves most goes to and fro; it comes to
  rest if it does not, or if plastic work of the last fifth is more than 1/1000; else it is at rest.
A body that slumps and then stands, stands: each line has its largest displacement, too.

So let the case load the body well before its end, and then wait for ten travels of a wave through it or more.  A little `stepper_damping` lets
it come to rest sooner.  Where the dilation is 0 deg and friction is not, the factor depends on the grid: compare two grids.

Exit code 0, 2 for a bad case or options, 3 if a file could not be written, 4 if it was ended by a signal.
"""
import argparse
import math
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

from .case import find_case
from .program import Job, find_program
from .run import Run
from .tables import missing

try:
    import h5py  # noqa: F401  of which snapshots are read
except ImportError as error:
    raise missing(error, "clathra strength") from None

LEAST, MOST = 0.01, 100.0  # factors that are tried
ROWS = 200  # of the balance
SNAPSHOTS = 8  # of the last fifth
FLOWS, CREEPS, STEADY, LEAVES, KINETIC, VIBRATES = 1e-2, 1e-3, 0.125, 1e-2, 0.5, 1e-4  # shares that the docstring names


def stop(text, code=2):
    print(text.rstrip() if text.startswith("clathra") else f"clathra strength: {text.rstrip()}", file=sys.stderr)
    sys.exit(code)


def positive(text):
    value = float(text)
    if not (0 < value < math.inf):
        raise argparse.ArgumentTypeError(f"'{text}' is no number above 0")
    return value


def arguments(words):
    p = argparse.ArgumentParser(prog="clathra strength", usage="%(prog)s CASE [options] [-- OPTIONS OF CLATHRA]", description=__doc__,
                                formatter_class=argparse.RawDescriptionHelpFormatter)  # fmt: skip
    p.add_argument("case", metavar="CASE", help="folder with a case.yaml, such a file, or the name of a shipped case")
    p.add_argument("--low", type=positive, default=1.0, metavar="F", help="lower end of the bracket to begin with (1); it is widened where the body fails there")
    p.add_argument("--high", type=positive, default=2.0, metavar="F", help="upper end (2); widened where the body stands")
    p.add_argument("--tol", type=positive, default=0.05, metavar="D", help="width of the bracket to end with (0.05)")
    p.add_argument("--stage", metavar="NAME", help="reduce from the begin of this stage on, not from the start")
    p.add_argument("--ranks", type=int, default=1, metavar="N", help="run on N MPI ranks (1)")
    p.add_argument("--out", metavar="DIR", help="keep the runs in this new folder, one folder each")
    at = words.index("--") if "--" in words else len(words)
    a = p.parse_args(words[:at])
    if not a.low < a.high:
        p.error(f"--low {a.low:g} must be below --high {a.high:g}")
    if not LEAST <= a.low or not a.high <= MOST:
        p.error(f"--low {a.low:g} and --high {a.high:g} must be in [{LEAST:g}, {MOST:g}]")
    if a.tol < 1e-4:
        p.error(f"--tol {a.tol:g} is below 0.0001")
    if a.ranks < 1:
        p.error(f"--ranks {a.ranks} is below 1")
    if a.out and Path(a.out).exists() and not (Path(a.out).is_dir() and not any(Path(a.out).iterdir())):
        p.error(f"--out {a.out} is there already and is not an empty folder")
    if any(int(os.environ.get(name, 1)) > 1 for name in ("OMPI_COMM_WORLD_SIZE", "PMI_SIZE")):
        p.error("begin it without mpiexec; --ranks N runs the case on N ranks")
    return a, words[at + 1 :]


# ---------------------------------------------------------------- what a run says of the body
class Energies:
    """Energies (J) of a run at times of its last stage; what it says of them are shares of what the body has taken up by the end."""

    def __init__(self, balance, begin, end):
        self.part = (balance["time_s"] - begin) / (end - begin)  # of the stage
        self.kinetic = balance["kinetic_energy_J"]
        self.plastic = balance["plastic_work_J"] + balance["removed_plastic_J"]
        self.given = balance["gravity_work_J"] + balance["load_work_J"] + balance["plate_work_J"]
        self.taken = balance["elastic_energy_J"][-1] + self.kinetic[-1] + self.plastic[-1] - np.interp(0.0, self.part, self.plastic)
        self.taken = max(self.taken, np.finfo(float).tiny)

    def most(self, column, first, last):
        """Its largest value in these parts of the stage."""
        return column[(self.part > first - 1e-9) & (self.part < last + 1e-9)].max() / self.taken

    def flow(self, *parts):
        """Plastic work between parts of the stage."""
        return np.diff(np.interp(parts, self.part, self.plastic)) / self.taken


def swing(displacements):
    """Half of the widest way (m) between snapshots of the particle that has the widest, and whether it goes to and fro: its mean place of
    the first and of the last half of them is less than half of that way apart."""
    ids = [ids for ids, _ in displacements]
    there = np.intersect1d(ids[0], ids[-1])
    u = np.array([u[np.isin(these, there)] for these, u in displacements])
    ways = np.max([np.linalg.norm(a - b, axis=-1) for k, a in enumerate(u) for b in u[:k]], axis=0)
    far, half = ways.argmax(), len(u) // 2
    return 0.5 * ways[far], np.linalg.norm(u[:half, far].mean(axis=0) - u[-half:, far].mean(axis=0)) < 0.5 * ways[far]


def judge(energies, displacements):
    """Whether the body stands, and why."""
    before, last = energies.flow(0.8, 0.9, 1.0)
    quarters = energies.flow(0.8, 0.85, 0.9, 0.95, 1.0)
    work = energies.most(energies.given, 0.9, 1.0) - energies.most(energies.given, 0.0, 0.9)
    moving = energies.most(energies.kinetic, 0.9, 1.0)
    if last > FLOWS:
        return False, f"it flows: plastic work is {100 * last:.2g} % of its energy in the last tenth, {100 * before:.2g} % in the one before"
    if quarters.sum() > CREEPS and quarters.min() > STEADY * quarters.sum():
        return False, f"it creeps: plastic work is {100 * quarters.sum():.2g} % of its energy in the last fifth, and goes on"
    if work > LEAVES and moving > KINETIC * work:
        return False, f"it moves off: its loads give {100 * work:.2g} % of its energy in the last tenth, more than ever, and {100 * moving:.2g} % is kinetic"
    by, returns = swing(displacements)
    if moving > VIBRATES and returns:
        yields = f"plastic work is {100 * quarters.sum():.2g} % of its energy in the last fifth" if quarters.sum() > CREEPS else "and does not flow"
        return True, f"it vibrates, by {by:.3g} m to either side, {yields}"
    if moving > VIBRATES or quarters.sum() > CREEPS:
        return True, f"it comes to rest: plastic work is {100 * last:.2g} % of its energy in the last tenth, {100 * before:.2g} % in the one before"
    return True, "it is at rest"


# ---------------------------------------------------------------- runs
class Reduction:
    def __init__(self, program, a, options, folder):
        self.program, self.a, self.options, self.folder = program, a, options, folder
        self.key = f"-stage_{a.stage}_strength_factor" if a.stage else "-strength_factor"
        self.warned = False
        first = self.first()
        stages = first.get("stages", [])
        self.begin, self.end = ([0.0] + [first[f"stage_{name}_end"] for name in stages])[-2:] if stages else (0.0, first["time_end"])
        # Without a matrix a row of the balance is up to 256 steps, more than a period; implicit steps would be cut to end at these times.
        implicit = {"euler", "sdirk2", "auto"} & {first["stepper_type"], *(first.get(f"stage_{name}_stepper_type") for name in stages)}
        self.rows = () if implicit else ("-output_probe_every", f"{(self.end - self.begin) / ROWS:.17g} s")
        # Not evenly, so that no vibration is met at the same place each time.
        self.times = [self.end - 0.2 * (self.end - self.begin) * (k / SNAPSHOTS) ** 1.5 for k in range(SNAPSHOTS, -1, -1)]

    def launch(self, name, *more):
        out = self.folder / name
        job = Job([self.program, self.a.case, "-quiet", *self.options, *more, "-output_dir", out], out, self.a.ranks)
        code = job.end()
        if code not in (0, 3):
            stop(job.said or f"exit code {code} of {self.program}", code if code in (2, 4) else 1)
        given_up = re.search(r"^Given up at [^:]*: (.*)$", job.said, re.M)
        if code == 3 and not given_up:  # it could not write, say
            stop(job.said, 3)
        self.reason = given_up and given_up[1]
        for line in job.said.splitlines():
            if "depends on the grid" in line and not self.warned:
                print(line)
                self.warned = True
        return code, out

    def first(self):
        """The resolved case of a first step."""
        if self.a.stage:  # else an option of a stage that is not there
            names = Run(self.launch("stages", "-stepper_max_steps", "1")[1]).case.get("stages", [])
            if self.a.stage not in names:
                stop(f"--stage {self.a.stage}: {self.a.case} has {'the stages ' + ', '.join(names) if names else 'no stages'}")
        return Run(self.launch("first", "-stepper_max_steps", "1", self.key, f"{self.a.high:.17g}")[1]).case

    def stands(self, factor):
        code, out = self.launch(f"{factor:.6g}", self.key, f"{factor:.17g}", *self.rows, "-output_times", ", ".join(f"{t:.17g} s" for t in self.times))
        run = Run(out)
        if code == 3:
            good, why = False, f"the run could not go on: {self.reason}"
        else:
            u = [(v["id"], v["displacement"]) for v in (run.particles(t) for t in run.times[run.times > self.times[0] * (1 - 1e-9)])]
            good, why = judge(Energies(run.balance, self.begin, self.end), u)
        far = np.linalg.norm(run.particles()["displacement"], axis=1).max()
        print(f"strength factor {factor:<8.6g} {'stands' if good else 'fails '}: {why}; largest displacement {far:.4g} m", flush=True)
        if not self.a.out:
            shutil.rmtree(out)
        return good


def bracket(r, low, high):
    """Ends that stand and fail.  Where both ends fare alike the next bracket begins where this one ends and is wider."""
    ratio = high / low
    if r.stands(low):
        while r.stands(high):
            if high == MOST:
                stop(f"stands at every factor up to {MOST:g}: what loads it does not test its strength")
            ratio = max(ratio, min(ratio**2, 2.0))
            low, high = high, min(MOST, high * ratio)
        return low, high
    while True:
        if low == LEAST:
            stop(f"fails at every factor down to {LEAST:g}: it does not bear its loads, or has not come to rest by the end of the run")
        ratio = max(ratio, min(ratio**2, 2.0))
        low, high = max(LEAST, low / ratio), low
        if r.stands(low):
            return low, high


def reduce(program, a, options, folder):
    r = Reduction(program, a, options, folder)
    low, high = bracket(r, a.low, a.high)
    while high - low > a.tol * (1 + 1e-9):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if r.stands(middle) else (low, middle)
    print(f"factor of safety {0.5 * (low + high):.4g}: stands at {low:.6g}, fails at {high:.6g}")


def main(words):
    a, options = arguments(words)
    a.case = find_case(a.case)
    if a.out:
        Path(a.out).mkdir(parents=True, exist_ok=True)
        reduce(find_program(), a, options, Path(a.out))
    else:
        with tempfile.TemporaryDirectory(prefix="strength-") as name:
            reduce(find_program(), a, options, Path(name))
    return 0
