#!/usr/bin/python3
"""Random scenes and mutated cases, by the thousand: soak.py [--scenes N] [--cases N] [--seed S] [--record FILE] ...

Scenes are admissible ones drawn at random: fields, properties, saturations, loads, integrators, bases, geometry, gravity,
regions, ranks.  Each is run for a few steps under a time limit and falls into one class:

  finished   refused (exit code 2, a sentence)   given up (3, a reason)   slow (still stepping after the limit)
  hang   crash   NaN   balance (above 1e-10)   silent (an end without a sentence)
  ranks (1 against 2 differ)   pair (implicit against hybrid differ, where both can)
  company (went wrong after other scenes in the same process, but not alone)

They run one after another in a few processes (tests/soak/many.c), for a start costs more than a scene; what goes wrong
is run once more by the program itself, alone.  Mutated cases are the cases of the tree changed by grammar: values,
units, keys, lines, brackets; they are read and checked, and some of those that are valid run.  Whatever is not
finished, refused or given up leaves a folder with the case, the command and what was said (--keep).  The same seed
makes the same scenes and cases.  --record adds the counts to a file, from where --table makes one table of all of
them: runs of any length add up.
"""
import argparse
import collections
import concurrent.futures
import json
import math
import os
import random
import re
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
import dated  # noqa: E402
from clathra import read_csv, read_snapshots  # noqa: E402
from clathra.program import call, environment  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
GOOD = ("finished", "refused", "given up", "slow")
BALANCE = 1e-10
RANKS = 1e-6  # of the largest change
PAIR = 0.5  # of the mean change: another order in time, the same physics
KINDS = {"pressure, stress": ("p_w", "p_g", "stress"), "temperature": ("T",), "saturation": ("S_h", "S_w"), "displacement": ("displacement",)}
FLOOR = {"pressure, stress": 1e4, "temperature": 0.1, "saturation": 1e-3, "displacement": 1e-4}  # Pa, K, 1, 1 (what 1e4 Pa strain sand by): smaller changes are as good as none


# ---------------------------------------------------------------------------------------- random scenes
def log_uniform(r, low, high):
    return 10 ** r.uniform(math.log10(low), math.log10(high))


def material(r, fluid, gas, heat, hydrate):
    text = f"porosity: {r.uniform(0.05, 0.6):.3g}, "
    thermal = f", heat_capacity: {r.uniform(500, 1500):.4g} J/(kg K), conductivity: {r.uniform(0.3, 5):.3g} W/(m K)" if heat or hydrate else ""
    text += f"solid: {{density: {r.uniform(2000, 3000):.4g} kg/m^3{thermal}}}"
    text += f", elasticity: {{E0: {log_uniform(r, 1e6, 1e10):.3g} Pa, Eh: {log_uniform(r, 1e6, 1e9):.3g} Pa, nu: {r.uniform(0, 0.45):.3g}}}"
    text += f", permeability: {{k0: {log_uniform(r, 1e-20, 1e-10):.3g} m^2, mh: {r.uniform(1, 8):.3g}}}"
    if fluid:
        if r.random() < 0.2:
            text += f", water: {{bulk_modulus: {log_uniform(r, 1e8, 1e11):.3g} Pa}}"
    swr, sgr = r.uniform(0, 0.3), r.uniform(0, 0.2)
    if gas or hydrate:
        text += f", retention: {{p0: {log_uniform(r, 1e3, 1e6):.3g} Pa, m: {r.uniform(0.2, 0.8):.3g}, Swr: {swr:.3g}, Sgr: {sgr:.3g}}}"
        text += f", relperm: {{nw: {r.uniform(1, 6):.3g}, ng: {r.uniform(1, 4):.3g}}}"
    active = hydrate and r.random() < 0.7
    if active:
        text += f", kinetics: {{active: yes, K0: {log_uniform(r, 1e-13, 1e-9):.3g} mol/(m^2 Pa s), A_geo: {log_uniform(r, 1e3, 1e6):.3g} 1/m}}"
    elif gas or hydrate:
        text += ", kinetics: {active: no}"
    return "{" + text + "}", swr, sgr


def saturations(r, gas, hydrate, swr, sgr):
    if not (gas or hydrate):
        return ""
    Sh = r.choice([r.uniform(0.001, 0.7), r.uniform(0.05, 0.5)]) if hydrate else 0.0
    top = 1 - swr
    share = min(max(r.choice([log_uniform(r, 1e-4, 0.5), r.uniform(sgr, top)]), sgr + 1e-3), top - 0.02)
    Sg = share * (1 - Sh)
    return f", Sh: {Sh!r}, Sg: {Sg!r}, Sw: {1 - Sh - Sg!r}"


def state(r, fluid, gas, heat, hydrate, swr, sgr, p, T):
    text = ""
    if fluid:
        text += f", pressure: {p:.6g} Pa"
    if heat or gas or hydrate:
        text += f", temperature: {T:.4g} degC"
    return text + saturations(r, gas, hydrate, swr, sgr)


def boundaries(r, box, fluid, gas, heat, p, T, t_end, smooth):
    """{name: text} of rollers all around but the top, a load there, and what may cross it; smooth: nothing jumps."""
    (x0, y0), (x1, y1) = box
    held = ", holds: skeleton" if r.random() < 0.1 else ""
    bc = {"base": f"{{type: {r.choice(['roller', 'roller', 'fixed'])}, axis: y, position: {y0!r} m{held}}}",
          "left": f"{{type: roller, axis: x, position: {x0!r} m}}"}  # fmt: skip
    if r.random() < 0.8:
        bc["right"] = f"{{type: roller, axis: x, position: {x1!r} m}}"
    p0 = p if fluid else 0.0
    load = p0 + r.choice([0, 1, -0.5]) * log_uniform(r, 1e3, 1e6)
    ramp = (0.7 if smooth else r.choice([0.0, 0.1, 0.5])) * t_end
    value = f"{load:.8g} Pa" if not ramp else f"{{ramp: [{p0:.8g} Pa, {load:.8g} Pa, 0 s, {ramp:.6g} s]}}"
    bc["load"] = f"{{type: traction, side: top, normal: {value}}}"
    if "right" not in bc:
        bc["cell"] = f"{{type: traction, side: right, normal: {p0:.8g} Pa}}"
    if fluid and r.random() < 0.7:
        free = ", saturation: free" if gas else ""
        bc["drain"] = "{type: pressure, side: top, initial: yes}" if smooth else r.choice([
            "{type: pressure, side: top, initial: yes}",
            f"{{type: pressure, side: top{free}, pressure: {{ramp: [{p:.8g} Pa, {p * r.uniform(0.3, 1.2):.8g} Pa, 0 s, {0.3 * t_end:.6g} s]}}}}",
            f"{{type: pressure, side: top, pressure: {p * r.uniform(0.8, 1.1):.8g} Pa}}",
            f"{{type: inflow, side: top, water: {r.uniform(-1, 1) * log_uniform(r, 1e-9, 1e-6):.4g} m/s}}"])  # fmt: skip
    if heat and not smooth and r.random() < 0.6:
        bc["warm"] = r.choice([f"{{type: face_temperature, side: top, temperature: {T + r.uniform(-5, 20):.4g} degC}}",
                               f"{{type: heat_flux, side: top, flux: {r.uniform(-100, 500):.4g} W/m^2}}",
                               f"{{type: convection, side: top, alpha: {log_uniform(r, 1, 1e3):.3g} W/(m^2 K), ambient: {T + r.uniform(-5, 20):.4g} degC}}"])  # fmt: skip
    return bc


def travels(r, text, slow, h, size):
    """Time (s) in which the slowest wave crosses the body some times, so that a load that grows slowly leaves a state
    that any integrator must reach; at most a few thousand steps of the fastest."""
    c = min(math.sqrt(float(E) / 2500) for E in re.findall(r"E0: (\S+) Pa", text)) if slow else 1000.0
    return min(r.uniform(5, 15) * size / c, h)


def scene(seed):
    """(text of the case, facts) of the scene with this number."""
    r = random.Random(f"scene {seed}")
    fluid, hydrate = r.random() < 0.9, False
    gas = fluid and r.random() < 0.5
    hydrate = gas and r.random() < 0.6
    heat = hydrate or r.random() < 0.4
    axisymmetric = r.random() < 0.15
    integrator = r.choices(["sdirk2", "euler", "hybrid", "explicit", "auto"], [40, 20, 25, 5, 10])[0]
    if axisymmetric and integrator in ("hybrid", "explicit"):
        integrator = "sdirk2"
    pair = integrator == "hybrid" and r.random() < 0.1
    h = log_uniform(r, 0.01, 2)
    cells = r.randint(2, 8), r.randint(2, 8)
    x0, y0 = (0.0, 0.0) if r.random() < 0.7 else (round(r.uniform(0, 3), 2), round(r.uniform(-5, 5), 2))
    room = r.randint(0, 2)  # rows of empty cells above the body
    box = (x0, y0), (x0 + cells[0] * h, y0 + cells[1] * h)
    grid = box[1][0] + (h if r.random() < 0.5 else 0), box[1][1] + (room + 1) * h
    nx, ny = round((grid[0] - x0) / h), round((grid[1] - y0) / h)
    p, T = log_uniform(r, 2e5, 2e7), r.uniform(1, 18)
    t_end = log_uniform(r, 1e-4, 1e-2) * h if integrator in ("hybrid", "explicit") else log_uniform(r, 1e-1, 1e6)
    layers = 1 if r.random() < 0.7 or cells[1] < 2 else 2
    cut = r.randint(1, cells[1] - 1) if layers == 2 else cells[1]
    lines = [f"title: scene {seed}", f"grid: {{lower: [{x0!r} m, {y0!r} m], upper: [{grid[0]!r} m, {grid[1]!r} m], cells: [{nx}, {ny}]}}",
             f"materials: [{', '.join(f'm{k}' for k in range(layers))}]", "mat:"]  # fmt: skip
    residual = []
    for k in range(layers):
        text, swr, sgr = material(r, fluid, gas, heat, hydrate)
        residual.append((swr, sgr))
        lines.append(f"  m{k}: {text}")
    if pair:
        t_end = travels(r, "".join(lines), gas or not fluid, h, max(cells) * h)
    gravity = fluid and r.random() < 0.3
    water = ", hydrostatic: yes, datum: %r m" % box[1][1] if gravity and fluid else ""
    lines += [f"regions: [{', '.join(f'r{k}' for k in range(layers))}]", "region:"]
    for k in range(layers):
        low, high = (y0, y0 + cut * h) if k == 0 else (y0 + cut * h, box[1][1])
        ppc = r.choice(["2, 2", "2, 2", "3, 3", "2, 1"])
        lines.append(f"  r{k}: {{lower: [{x0!r} m, {low!r} m], upper: [{box[1][0]!r} m, {high!r} m], material: m{k}, particles_per_cell: [{ppc}]"
                     + state(r, fluid, gas, heat, hydrate, *residual[k], p, T) + water + "}")  # fmt: skip
    bc = boundaries(r, box, fluid, gas, heat, p, T, t_end, pair)
    lines += [f"boundaries: [{', '.join(bc)}]", "bc:"] + [f"  {name}: {text}" for name, text in bc.items()]
    basis = r.choices(["cpgimp", "ugimp", "linear"], [70, 20, 10])[0]
    lines += [f"time: {{end: {t_end:.6g} s}}", f"stepper: {{type: {integrator}}}", f"output: {{times: [0 s, {t_end:.6g} s]}}",
              f"basis: {basis}"]  # fmt: skip
    if not fluid:
        lines.append(f"fields: [{'solid, heat' if heat else 'solid'}]")
    if axisymmetric:
        lines.append("geometry: axisymmetric")
    if gravity:
        lines.append("gravity: [0 m/s^2, -9.81 m/s^2]")
    if r.random() < 0.1 and integrator in ("sdirk2", "euler"):
        lines.append("inertia: no")
    middle = [0.5 * (a + b) for a, b in zip(*box)]
    lines += ["probes: [middle, top]", f"probe: {{middle: {{at: [{middle[0]!r} m, {middle[1]!r} m]}}, top: {{at: [{middle[0]!r} m, {box[1][1]!r} m]}}}}"]
    return "\n".join(lines) + "\n", {"integrator": integrator, "ranks": r.choices([1, 2], [92, 8])[0],
                                     "both": r.random() < 0.06, "pair": pair and basis != "linear"}  # fmt: skip


# ---------------------------------------------------------------------------------------- running and judging
class Server:
    """tests/soak/many.c on some ranks: cases one after another in one process, as long as it lives."""

    def __init__(self, program, ranks):
        command = [str(program)] if ranks == 1 else ["mpiexec", "-n", str(ranks), str(program)]
        self.sessions = tempfile.TemporaryDirectory()
        self.job = subprocess.Popen(command, env=environment(self.sessions.name), stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, start_new_session=True)  # fmt: skip
        self.left = 100  # a new process now and then: what one leaks is not the other's

    def run(self, words, limit):
        """(exit code, what was said); None: not done within the limit (s)."""
        said, until = b"", time.monotonic() + limit
        self.left -= 1
        try:
            self.job.stdin.write(" ".join(map(str, words)).encode() + b"\n")
            self.job.stdin.flush()
        except BrokenPipeError:
            pass  # read what it said, below
        while not (mark := re.search(rb"\x01(\d+)\n", said)):
            left = until - time.monotonic()
            ready = left > 0 and select.select([self.job.stdout], [], [], left)[0]
            more = os.read(self.job.stdout.fileno(), 65536) if ready else b""
            said += more
            if not more:
                self.left = 0
                return (self.job.wait() if ready else None), said.decode(errors="replace")
        if mark[1] == b"1":
            self.left = 0  # what an error of PETSc left behind is no place to go on from
        return int(mark[1]), said[: mark.start()].decode(errors="replace")

    def end(self):
        self.job.stdin.close()
        try:
            self.job.wait(0 if self.left == 0 else 30)
        except subprocess.TimeoutExpired:
            self.job.terminate()  # mpiexec takes its ranks along
            try:
                self.job.wait(10)
            except subprocess.TimeoutExpired:
                os.killpg(self.job.pid, signal.SIGKILL)
                self.job.wait()


class Soak:
    def __init__(self, args):
        self.program, self.many, self.limit, self.keep, self.steps = str(args.program), args.many, args.limit, Path(args.keep), args.steps
        self.mine, self.servers = threading.local(), []

    def close(self):
        for server in self.servers:
            if server.job.poll() is None:
                server.end()

    def words(self, case, out, options):
        return [str(case), "-quiet", "-stepper_max_steps", str(self.steps), *options, "-output_dir", str(out)]

    def serve(self, words, ranks=1):
        """(exit code, what was said) of a run in this thread's process for so many ranks."""
        mine = self.mine.__dict__.setdefault("servers", {})
        if ranks in mine and mine[ranks].left <= 0:
            mine.pop(ranks).end()
        if ranks not in mine:
            mine[ranks] = Server(self.many, ranks)
            self.servers.append(mine[ranks])
        return mine[ranks].run(words, self.limit * ranks)

    def run(self, case, out, *options, ranks=1):
        return self.serve(self.words(case, out, options), ranks)

    def alone(self, case, out, *options, ranks=1):
        """A run by the program itself, in a process of its own."""
        command = [self.program, *self.words(case, out, options)]
        if ranks > 1:
            command = ["mpiexec", "-n", str(ranks), *command]
        with tempfile.TemporaryDirectory() as sessions:
            job = subprocess.Popen(command, env=environment(sessions), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                                   stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True)  # fmt: skip
            return self.waited(job, ranks)

    def waited(self, job, ranks):
        """(exit code, what was said) of a run; None: it hangs."""
        try:
            text = job.communicate(timeout=2 * self.limit * ranks)[0]
        except subprocess.TimeoutExpired:
            job.send_signal(signal.SIGUSR1)  # asks for the end after the step: what still steps does not hang
            try:
                text = job.communicate(timeout=self.limit)[0]
            except subprocess.TimeoutExpired:
                job.terminate()
                time.sleep(1)
                os.killpg(job.pid, signal.SIGKILL)  # its own group
                return None, job.communicate()[0]
        return job.returncode, text

    def judged(self, case, out, *options, ranks=1):
        """Class and note of a run; what went wrong is run once more, alone."""
        kind, note = self.judge(*self.run(case, out, *options, ranks=ranks), out)
        if kind in GOOD:
            return kind, note
        out, begin = out.with_name(f"{out.name}-alone"), time.monotonic()
        again, said = self.judge(*self.alone(case, out, *options, ranks=ranks), out)
        if again not in GOOD or (kind == "hang" and time.monotonic() - begin > 0.5 * self.limit * ranks):
            return again, said  # a machine that is busy makes any run slow
        return "company", f"{kind} after other cases in one process, {again} alone: {note}"

    def judge(self, code, text, out):
        """Class and note of one run."""
        if code is None:
            return "hang", text[-600:]
        if code == 4:
            return "slow", ""
        if code not in (0, 2, 3) or "PETSC ERROR" in text or "Sanitizer" in text or "HDF5-DIAG" in text:
            return "crash", f"exit code {code}: {text[-600:]}"
        if code == 2:
            said = [s for s in text.splitlines() if ": " in s and ": note: " not in s]
            return ("refused", re.sub(r"\S*case\.yaml:\d*:? ?", "", said[0])) if said else ("silent", text[-600:])
        bad = numbers(out)
        if bad:
            return "NaN", bad
        found = re.search(r"balance errors: water (\S+), methane (\S+) of", text)
        if found and max(abs(float(v)) for v in found.groups()) > BALANCE:
            return "balance", found[0]
        if code == 0:
            return "finished", ""
        reason = [s for s in text.splitlines() if s.startswith(("Given up", "t = ")) and ("Given up" in s or "no smaller" in s)]
        return ("given up", reason[-1]) if reason else ("silent", text[-600:])

    def scene(self, seed):
        text, facts = scene(seed)
        folder = Path(tempfile.mkdtemp(prefix="soak-", dir=MEMORY))
        case = folder / "case.yaml"
        case.write_text(text)
        found = self.compare_ranks(case, folder) if facts["both"] else None
        kind, note = found or self.judged(case, folder / "out", ranks=facts["ranks"])
        if kind == "finished" and facts["pair"]:
            kind, note = self.compare_pair(case, folder) or (kind, note)
        self.end(folder, kind, f"scene {seed} ({facts['integrator']}, {facts['ranks']} ranks)", note)
        return kind, facts["integrator"], note, seed

    def compare_ranks(self, case, folder):
        """1 rank against 2 where both take the same steps, implicit runs fixed ones, lest round-off choose others; None: one of them gives up."""
        text = case.read_text()
        end = float(re.search(r"end: (\S+) s", text)[1])
        fixed = () if re.search(r"type: (hybrid|explicit|auto)", text) else ("-stepper_adapt", "no", "-stepper_dt", f"{end / 100:.6g} s")
        options = ("-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9", *fixed)
        return self.compare(case, folder, "ranks", RANKS, (("1", 1, options), ("2", 2, options)))

    def compare_pair(self, case, folder):
        """hybrid against sdirk2, where they are apart once more with ten times its accuracy: waves go on ringing, and their phase drifts; None: one of them
        gives up."""  # fmt: skip
        found = None
        for tol, steps in (("1e-3", "400"), ("1e-4", "2000")):
            implicit = ("-stepper_max_steps", steps, "-stepper_type", "sdirk2", "-stepper_tol", tol)
            found = self.compare(case, folder, "pair", PAIR, ((f"hybrid-{tol}", 1, ("-stepper_max_steps", "100000")), (f"sdirk2-{tol}", 1, implicit)))
            if not found or found[0] != "pair":
                break
        return found

    def compare(self, case, folder, kind, bar, two):
        """Class and note of two runs of a scene that ought to end the same, from all particles at their end."""
        ends = []
        for name, ranks, options in two:
            found, note = self.judged(case, folder / name, *options, ranks=ranks)
            if found != "finished":
                return None if found in GOOD else (found, note)
            ends.append((*changes(folder / name), read_csv(folder / name / "balance.csv")["time_s"]))
        (t, a, steps), (t_b, b, steps_b) = ends
        if not math.isclose(t, t_b, rel_tol=1e-6):
            return "finished", ""  # stopped at -stepper_max_steps at different times
        if kind == "ranks" and not (len(steps) == len(steps_b) and np.allclose(steps, steps_b, rtol=1e-9)):
            return "finished", ""  # auto chose otherwise, or a step was refused on one of them alone
        size = np.max if kind == "ranks" else lambda v: math.sqrt(np.mean(v**2))
        worst, where = max((size(abs(a[k] - b[k])) / max(size(abs(a[k])), size(abs(b[k])), FLOOR[k]), k) for k in a)
        note = f"{where}: {worst:.2g} of {'its largest change' if kind == 'ranks' else 'the mean change'}"
        return (kind, note) if worst > bar else ("finished", note)

    def end(self, folder, kind, what, note):
        if kind not in GOOD or os.environ.get("SOAK_KEEP") == kind:
            (folder / "what.txt").write_text(f"{kind}: {what}\n{self.program} case.yaml -stepper_max_steps {self.steps}\n{note}\n")
            self.keep.mkdir(parents=True, exist_ok=True)
            shutil.move(str(folder), str(self.keep / f"{kind}-{folder.name}"))
        else:
            shutil.rmtree(folder, ignore_errors=True)


def last_state(out):
    """{group/name: array} of the checkpoint, which holds all that a run goes on from; particles in order of their id."""
    with h5py.File(out / "checkpoint.h5", "r") as file:
        found = {f"{g}/{k}": file[g][k][()] for g in ("state", "particles") for k in file[g]}
    order = np.argsort(found["particles/id"], kind="stable")
    return {k: v[order] if k.startswith("particles/") else v for k, v in found.items()}


def changes(out):
    """(time (s), {kind: (values,) array}): what the run changed, over all particles; strains for displacements."""
    end, start = last_state(out), read_snapshots(out)[0][1]
    size = np.ptp(end["particles/initial_position"], axis=0).max()
    found = {}
    for kind, names in KINDS.items():
        parts = [(end[f"particles/{n}"].reshape(len(start["id"]), -1) - start[n]).ravel() for n in names if n in start]
        if parts:
            found[kind] = np.concatenate(parts) / (size if kind == "displacement" else 1.0)
    return float(end["state/t"][0]), found


def numbers(out):
    """Where a file of the run holds something that is not finite; "" if nowhere."""
    for name in ("probes.csv", "balance.csv"):
        if not (out / name).is_file():
            return f"{name} is missing"
        for column, values in read_csv(out / name).items():
            if not np.all(np.isfinite(values)):
                return f"{name}: {column}"
    for t, variables in (*read_snapshots(out), ("the end", last_state(out))):
        for name, values in variables.items():
            if name == "yield_distance":  # NaN where nothing can yield
                values = values[~np.isnan(values)]
            if np.ndim(values) and not np.all(np.isfinite(values)):
                return f"{name} at {t} s"
    return ""


# ---------------------------------------------------------------------------------------- mutated cases
NASTY = ["", "''", "~", "null", "[]", "{}", "[[]]", "[a, b]", "{a: b}", "{table: []}", "{table: [0 s, 1 Pa, 0 s, 2 Pa]}",
         "{ramp: [1 Pa, 2 Pa, 1 s, 0 s]}", "1e308", "-1e308", "1e999", "nan", "inf", "0x10", "-0", "1e-320", "yes", "no", "all",
         "1 Pa", "1 m", "0 m", "1 degC", "-300 degC", "1 1/", "1 m^^2", "1 m^99999999999", "(((", "1 kg/(m", "µ", "日本", "'\"'",
         "\"\\x00\"", "\"\\n\"", "&a b", "*a", "!!int 3", "|", ">", "%d%s%n", "-", "--", ":", "#", "x" * 300, "9" * 400,
         "[" * 20, "{" * 20, "1, 2, 3", "2147483648", "-1", "0", "0.5", "1.0000001", "100000"]  # fmt: skip
UNITS = ["Pa", "kPa", "MPa", "m", "mm", "s", "h", "d", "K", "degC", "m^2", "1/m", "kg/m^3", "J/(kg K)", "W/(m K)", "%", "mol", "m/s^2", ""]
VALUE = re.compile(r"(?<=: )[^,{}\[\]\n#]+|(?<=[\[,] )[^,{}\[\]\n#]+|(?<=\[)[^,{}\[\]\n#]+")
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e-?\d+)?")
WORD = re.compile(r"[A-Za-z_]{3,}")


def replace(r, text, pattern, new):
    """One match of the pattern, replaced."""
    found = list(pattern.finditer(text))
    if not found:
        return text
    m = r.choice(found)
    return text[: m.start()] + new(m[0]) + text[m.end() :]


def letter(r, word):
    k = r.randrange(len(word))
    return r.choice([word[:k] + word[k + 1 :], word[:k] + r.choice("abcxyz_-0") + word[k:], word[:k] + word[k:][::-1], word.upper()])


def mutate(r, text, keys, bases):
    lines = text.splitlines()
    k = r.randrange(len(lines))
    what = r.randrange(14)
    if what == 0:
        return replace(r, text, VALUE, lambda _: r.choice(NASTY))
    if what == 1:
        return replace(r, text, NUMBER, lambda n: r.choice([f"{float(n) * 10 ** r.uniform(-12, 12):.6g}", f"-{n}", "0", r.choice(NASTY)]))
    if what == 2:
        return replace(r, text, re.compile(r"(?<=\d )[A-Za-z1][^,\]}\n]*"), lambda _: r.choice(UNITS))
    if what == 3:
        return replace(r, text, WORD, lambda w: letter(r, w))
    if what == 4:
        del lines[k]
    elif what == 5:
        lines.insert(r.randrange(len(lines)), lines[k])
    elif what == 6:
        lines[k] = r.choice(["  ", " ", "\t", ""]) + lines[k].lstrip(r.choice([" ", ""]))
    elif what == 7:
        lines.insert(k, f"{r.choice(keys).replace('<name>', r.choice(['sand', 'a', 'column', 'x']))}: {r.choice(NASTY)}")
    elif what == 8:
        other = r.choice(bases).splitlines()
        lines[k : k + r.randrange(3)] = r.sample(other, min(3, len(other)))
    elif what == 9:
        return replace(r, text, re.compile(r"[\[\]{}:,]"), lambda _: r.choice("[]{}:,"))
    elif what == 10:
        a = r.randrange(len(text))
        return text[:a] + text[a + r.randrange(1, 40) :]
    elif what == 11:
        a = r.randrange(len(text))
        return text[:a] + r.choice(["\r", "\x0b", "\x7f", "\ufeff", "🙂", "\t", "'", '"', "\\"]) + text[a:]
    elif what == 12:
        return replace(r, text, WORD, lambda _: r.choice(WORD.findall(r.choice(bases))))
    else:
        lines.append(r.choice(["a: " + "[" * 600 + "]" * 600, "x: " + "y" * 20000, "\n".join(f"k{i}: {i}" for i in range(600)),
                               "probes: [" + ", ".join(f"p{i}" for i in range(300)) + "]"]))  # fmt: skip
    return "\n".join(lines) + "\n"


def mutated(seed, keys, bases):
    r = random.Random(f"case {seed}")
    text = r.choice(bases)
    for _ in range(r.choice([1, 1, 1, 2, 3, 6])):
        text = mutate(r, text, keys, bases) or "a: b\n"
    return text


def check_mutated(soak, seed, text, share):
    """[class] of a mutated case that is read and checked, and of its run if it is valid and drawn."""
    folder = Path(tempfile.mkdtemp(prefix="soak-", dir=MEMORY))
    case = folder / "case.yaml"
    case.write_text(text, encoding="utf-8", errors="replace")
    code, said = soak.serve([case, "-case_check"])
    kind = {0: "valid", 2: "refused", None: "hang"}.get(code, "crash")
    if kind == "refused" and not re.search(r"\.yaml(:\d+)?: .", said) or "runtime error" in said:
        kind = "silent"
    found, note = [kind], f"exit code {code}: {said}"
    if kind == "valid" and random.Random(f"run {seed}").random() < share:
        kind, note = soak.judged(case, folder / "out", "-stepper_max_steps", "3")
        found.append(f"run: {kind}")
    soak.end(folder, "finished" if kind == "valid" else kind, f"mutated case {seed}", note)
    return found


def soak_cases(soak, args):
    listing = call("-case_keys", program=str(soak.program))
    keys = re.findall(r"^\| `([^`]+)`", listing, re.M)
    bases = [p.read_text() for p in sorted([*ROOT.glob("cases/*/case.yaml"), *ROOT.glob("tests/*/cases/*.yaml")])]
    count = collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for kinds in pool.map(lambda s: check_mutated(soak, s, mutated(s, keys, bases), args.run_valid), range(args.seed, args.seed + args.cases)):
            count.update(kinds)
    return count


# ---------------------------------------------------------------------------------------- the whole
def soak_scenes(soak, args):
    """{integrator: {class: number}}, {reason: number}"""
    by, reasons = collections.defaultdict(collections.Counter), collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for kind, integrator, note, seed in pool.map(soak.scene, range(args.seed, args.seed + args.scenes)):
            by[integrator][kind] += 1
            if kind != "finished":
                reasons[f"{kind}: {re.sub(r'[-+]?[0-9.]+(e[-+]?[0-9]+)?', '#', note)[:110]}"] += 1
            if args.verbose and kind != "finished":
                print(f"scene {seed} ({integrator}): {kind}: {note}", flush=True)
    return by, reasons


def words(count):
    return ", ".join(f"{n} {k}" for k, n in count.most_common())


def wrong(count):
    return sum(n for k, n in count.items() if k.removeprefix("run: ") not in (*GOOD, "valid"))


def commit():
    done = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"], capture_output=True, text=True)
    return done.stdout.strip() if done.returncode == 0 else "unknown"


def read_record(path):
    return [json.loads(line) for line in Path(path).read_text().splitlines()] if Path(path).is_file() else []


def next_seed(record, kind):
    return max((e["seed"] + e[kind] for e in record if kind in e), default=1)


COLUMNS = {"finished": "finished", "refused": "refused", "given up": "given up with a reason", "slow": "still stepping after the time limit", "hang": "hang", "crash": "crash", "NaN": "NaN",
           "balance": "balance above 1e-10", "silent": "end without a sentence", "company": "only after others in one process",
           "ranks": "1 rank against 2", "pair": "implicit against hybrid"}  # fmt: skip


def table(record):
    """What the record holds, all slices together, as a page's tables."""
    by, cases, n, m = collections.defaultdict(collections.Counter), collections.Counter(), 0, 0
    for e in record:
        for name, count in e.get("by", {}).items():
            by[name].update(count)
        cases.update(e.get("count", {}))
        n, m = n + e.get("scenes", 0), m + e.get("cases", 0)
    whole = sum(by.values(), collections.Counter())
    lines = [f"| {n} scenes | {' | '.join(COLUMNS.values())} |", "|---" * (len(COLUMNS) + 1) + "|"]
    for name, count in (*sorted(by.items()), ("all", whole)):
        lines.append(f"| {name} | {' | '.join(str(count[k]) for k in COLUMNS)} |")
    kinds = sorted(cases, key=lambda k: (k.startswith("run: "), -cases[k]))
    made = collections.defaultdict(collections.Counter)
    for e in record:
        made[e["commit"]].update({k: e[k] for k in ("scenes", "cases") if k in e})
    by_commit = "; ".join(f"{c}: " + ", ".join(f"{k} {what}" for what, k in count.items()) for c, count in made.items())
    return "\n".join([*lines, "", f"{m} mutated cases: " + ", ".join(f"{cases[k]} {k}" for k in kinds) + ".", "", f"By commit: {by_commit}."])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", default=ROOT / "build" / "clathra")
    parser.add_argument("--many", help="soak_many, beside the tests", default=None)
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=None, help="default: 1, or where the record ends")
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a run may take")
    parser.add_argument("--steps", type=int, default=40, help="steps (bursts of hybrid) of a scene at most")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--run-valid", type=float, default=0.01, help="share of the valid mutated cases that is run")
    parser.add_argument("--keep", default="results/soak", help="folder for what goes wrong")
    parser.add_argument("--record", help="file to which the counts of this slice are added, a line each")
    parser.add_argument("--table", action="store_true", help="print what the record holds, and do nothing else")
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    record = read_record(args.record) if args.record else []
    if args.table:
        print(table(record))
        return 0
    args.program = Path(args.program).resolve()
    args.many = Path(args.many or args.program.parent / "tests" / "soak_many").resolve()
    seed, soak, bad = args.seed, Soak(args), 0

    def note(**entry):
        if args.record:
            with open(args.record, "a") as file:
                file.write(json.dumps({"commit": commit(), "seed": args.seed, **entry}) + "\n")
            dated.measured(args.record)

    if args.scenes:
        args.seed = next_seed(record, "scenes") if seed is None else seed
        by, reasons = soak_scenes(soak, args)
        count = sum(by.values(), collections.Counter())
        note(scenes=args.scenes, steps=args.steps, by=by, reasons=reasons)
        print(f"{args.scenes} scenes from {args.seed}: {words(count)}")
        for name in sorted(by):
            print(f"  {name}: {words(by[name])}")
        for reason, n in reasons.most_common(15):
            print(f"  {n:5d} {reason}")
        bad += wrong(count)
    if args.cases:
        args.seed = next_seed(record, "cases") if seed is None else seed
        count = soak_cases(soak, args)
        note(cases=args.cases, count=count)
        print(f"{args.cases} mutated cases from {args.seed}: {words(count)}")
        bad += wrong(count)
    soak.close()
    if bad:
        print(f"{bad} went wrong; see {args.keep}")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
