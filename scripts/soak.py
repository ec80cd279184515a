#!/usr/bin/python3
"""Random scenes and mutated cases, by the thousand: soak.py [--scenes N] [--cases N] [--seed S] [--limit SECONDS] ...

Scenes are admissible ones drawn at random: fields, properties, saturations, loads, integrators, bases, geometry, gravity,
regions, ranks.  Each is run for a few steps under a time limit and falls into one class:

  finished   refused (exit code 2, a sentence)   given up (3, a reason)
  hang   crash   NaN   balance (above 1e-10)   silent (an end without a sentence)
  ranks (1 against 2 differ)   pair (implicit against hybrid differ, where both can)

Mutated cases are the cases of the tree changed by grammar: values, units, keys, lines, brackets; they are read and
checked, and some of those that are valid run.  Whatever is not finished, refused or given up leaves a folder with the
case, the command and what was said (--keep).  The same seed makes the same scenes and cases.
"""
import argparse
import collections
import concurrent.futures
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parent))
from clathra import read_csv, read_snapshots  # noqa: E402

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_btl_vader_single_copy_mechanism": "none",
               "OMPI_MCA_mpi_yield_when_idle": "1"}  # fmt: skip
GOOD = ("finished", "refused", "given up")
BALANCE = 1e-10
RANKS = 1e-6  # of the largest change
PAIR = 0.5  # of the largest change: another order in time, the same physics


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
    pair = integrator == "hybrid" and r.random() < 0.3
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
    if gas and r.random() < 0.1 and integrator in ("sdirk2", "euler"):
        lines.append("pressures: one")
    middle = [0.5 * (a + b) for a, b in zip(*box)]
    lines += ["probes: [middle, top]", f"probe: {{middle: {{at: [{middle[0]!r} m, {middle[1]!r} m]}}, top: {{at: [{middle[0]!r} m, {box[1][1]!r} m]}}}}"]
    return "\n".join(lines) + "\n", {"integrator": integrator, "ranks": r.choices([1, 2], [85, 15])[0],
                                     "both": r.random() < 0.1, "pair": pair and basis != "linear"}  # fmt: skip


# ---------------------------------------------------------------------------------------- running and judging
class Soak:
    def __init__(self, args):
        self.program, self.limit, self.keep, self.steps = str(args.program), args.limit, Path(args.keep), args.steps

    def run(self, case, out, *options, ranks=1):
        command = [self.program, str(case), "-quiet", "-stepper_max_steps", str(self.steps), *options, "-output_dir", str(out)]
        if ranks > 1:
            command = ["mpiexec", "-n", str(ranks), *command]
        job = subprocess.Popen(command, env={**os.environ, **ENVIRONMENT}, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                               stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True)  # fmt: skip
        try:
            text = job.communicate(timeout=self.limit * ranks)[0]
        except subprocess.TimeoutExpired:
            os.killpg(job.pid, 9)  # its own group
            return None, job.communicate()[0]
        return job.returncode, text

    def judge(self, code, text, out):
        """Class and note of one run."""
        if code is None:
            return "hang", text[-200:]
        if code not in (0, 2, 3) or "PETSC ERROR" in text or "Sanitizer" in text or "HDF5-DIAG" in text:
            return "crash", f"exit code {code}: {text[-200:]}"
        if code == 2:
            said = [s for s in text.splitlines() if ": " in s]
            return ("refused", re.sub(r"\S*case\.yaml:\d*:? ?", "", said[0])) if said else ("silent", text[-200:])
        bad = numbers(out)
        if bad:
            return "NaN", bad
        found = re.search(r"balance errors: water (\S+), methane (\S+) of", text)
        if found and max(abs(float(v)) for v in found.groups()) > BALANCE:
            return "balance", found[0]
        if code == 0:
            return "finished", ""
        reason = [s for s in text.splitlines() if s.startswith(("Given up", "t = ")) and ("Given up" in s or "no smaller" in s)]
        return ("given up", reason[-1]) if reason else ("silent", text[-200:])

    def scene(self, seed):
        text, facts = scene(seed)
        folder = Path(tempfile.mkdtemp(prefix="soak-"))
        case, out = folder / "case.yaml", folder / "out"
        case.write_text(text)
        kind, note = self.judge(*self.run(case, out, ranks=facts["ranks"]), out)
        if kind == "finished" and facts["both"]:
            kind, note = self.compare(case, folder, "ranks", RANKS, ("-stepper_adapt", "no"), (("1", 1, ()), ("2", 2, ())))
        elif kind == "finished" and facts["pair"]:
            kind, note = self.compare(case, folder, "pair", PAIR, ("-stepper_max_steps", "100000"),
                                      (("hybrid", 1, ()), ("sdirk2", 1, ("-stepper_type", "sdirk2", "-stepper_tol", "1e-4"))))  # fmt: skip
        self.end(folder, kind, f"scene {seed} ({facts['integrator']}, {facts['ranks']} ranks)", note)
        return kind, facts["integrator"], note, seed

    def compare(self, case, folder, kind, bar, options, two):
        """Runs a scene twice, with fixed steps where that is asked for, and compares the last rows of its probes."""
        if "-stepper_adapt" in options:
            end = float(re.search(r"end: (\S+) s", case.read_text())[1])
            hybrid = re.search(r"type: (hybrid|explicit|auto)", case.read_text())
            options = ("-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9") + (() if hybrid else (*options, "-stepper_dt", f"{end / 100:.6g} s"))
        rows = []
        for name, ranks, more in two:
            code, text = self.run(case, folder / name, *options, *more, ranks=ranks)
            if code != 0:
                if code is None or code not in (0, 2, 3):
                    return self.judge(code, text, folder / name)
                return "finished", ""  # one of them gives up: said, and counted elsewhere
            rows.append(read_csv(folder / name / "probes.csv"))
        worst, where = 0.0, ""
        for column in rows[0]:
            if kind == "pair" and column.startswith("top."):
                continue  # at the edge the two differ by what a cell does not resolve
            a, b = rows[0][column], rows[1][column]
            if column == "time_s" and not math.isclose(a[-1], b[-1], rel_tol=1e-6):
                return "finished", ""  # stopped at -stepper_max_steps at different times
            floor = {"Pa": 1e-4 * max(1e5, abs(a[0])), "C": 1e-2, "m": 1e-4}.get(column.rsplit("_", 1)[-1][-2:].strip("g"), 1e-3)
            change = max(np.ptp(a), np.ptp(b), floor)
            if abs(a[-1] - b[-1]) / change > worst:
                worst, where = abs(a[-1] - b[-1]) / change, column
        return (kind, f"{where}: {worst:.2g} of its largest change") if worst > bar else ("finished", "")

    def end(self, folder, kind, what, note):
        if kind not in GOOD or os.environ.get("SOAK_KEEP") == kind:
            (folder / "what.txt").write_text(f"{kind}: {what}\n{self.program} case.yaml -stepper_max_steps {self.steps}\n{note}\n")
            self.keep.mkdir(parents=True, exist_ok=True)
            shutil.move(str(folder), str(self.keep / f"{kind}-{folder.name}"))
        else:
            shutil.rmtree(folder, ignore_errors=True)


def numbers(out):
    """Where a file of the run holds something that is not finite; "" if nowhere."""
    for name in ("probes.csv", "balance.csv"):
        if not (out / name).is_file():
            return f"{name} is missing"
        for column, values in read_csv(out / name).items():
            if not np.all(np.isfinite(values)):
                return f"{name}: {column}"
    for t, variables in read_snapshots(out):
        for name, values in variables.items():
            if np.ndim(values) and not np.all(np.isfinite(values)):
                return f"fields.h5: {name} at {t:g} s"
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


def read_batch(reader, folder, seeds, texts, limit):
    """[(seed, code, what was said)]; a process that dies or hangs loses only the case it was at."""
    results, at = [], 0
    for seed, text in zip(seeds, texts):
        (folder / f"{seed}.yaml").write_text(text, encoding="utf-8", errors="replace")
    while at < len(seeds):
        paths = "".join(f"{folder / f'{s}.yaml'}\n" for s in seeds[at:])
        job = subprocess.Popen([str(reader)], env={**os.environ, **ENVIRONMENT}, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True, errors="replace")  # fmt: skip
        try:
            said, code = job.communicate(paths, timeout=limit * 10)[1], job.returncode
        except subprocess.TimeoutExpired:
            job.kill()
            said, code = job.communicate()[1], None
        *done, rest = re.split(r"\x01(\d)\n", said)
        for text, mark in zip(done[::2], done[1::2]):
            results.append((seeds[at], int(mark), text))
            at += 1
        if at < len(seeds):
            results.append((seeds[at], code, rest))
            at += 1
    return results


def soak_cases(soak, args):
    listing = subprocess.run([soak.program, "-case_keys"], capture_output=True, text=True, env={**os.environ, **ENVIRONMENT}).stdout
    keys = re.findall(r"^\| `([^`]+)`", listing, re.M)
    bases = [p.read_text() for p in sorted([*ROOT.glob("cases/*/case.yaml"), *ROOT.glob("tests/*/cases/*.yaml")])]
    count, runnable = collections.Counter(), []
    size = 250

    def batch(first):
        seeds = list(range(first, min(first + size, args.seed + args.cases)))
        folder = Path(tempfile.mkdtemp(prefix="soak-cases-"))
        texts = [mutated(s, keys, bases) for s in seeds]
        found = read_batch(args.reader, folder, seeds, texts, soak.limit)
        shutil.rmtree(folder)
        return [(s, c, said, t) for (s, c, said), t in zip(found, texts)]

    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for found in pool.map(batch, range(args.seed, args.seed + args.cases, size)):
            for seed, code, said, text in found:
                kind = {0: "valid", 2: "refused", None: "hang"}.get(code, "crash")
                if kind == "refused" and not re.search(r"\.yaml(:\d+)?: .", said) or "runtime error" in said:
                    kind = "silent"
                count[kind] += 1
                if kind == "valid" and random.Random(f"run {seed}").random() < args.run_valid:
                    runnable.append((seed, text))
                elif kind not in ("valid", "refused"):
                    keep(soak, kind, text, f"case {seed}: {code}", said)
        for kind in pool.map(lambda item: run_mutated(soak, *item), runnable):
            count[f"run: {kind}"] += 1
    return count


def keep(soak, kind, text, what, note):
    folder = Path(tempfile.mkdtemp(prefix="soak-"))
    (folder / "case.yaml").write_text(text, encoding="utf-8", errors="replace")
    soak.end(folder, kind, what, note)


def run_mutated(soak, seed, text):
    folder = Path(tempfile.mkdtemp(prefix="soak-"))
    (folder / "case.yaml").write_text(text, encoding="utf-8", errors="replace")
    code, said = soak.run(folder / "case.yaml", folder / "out", "-stepper_max_steps", "3")
    kind, note = soak.judge(code, said, folder / "out")
    soak.end(folder, kind, f"mutated case {seed}, run", note)
    return kind


# ---------------------------------------------------------------------------------------- the whole
def soak_scenes(soak, args):
    count, by, reasons = collections.Counter(), collections.Counter(), collections.Counter()
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for kind, integrator, note, seed in pool.map(soak.scene, range(args.seed, args.seed + args.scenes)):
            count[kind] += 1
            by[integrator, kind] += 1
            if kind != "finished":
                reasons[f"{kind}: {re.sub(r'[-+]?[0-9.]+(e[-+]?[0-9]+)?', '#', note)[:110]}"] += 1
            if args.verbose and kind != "finished":
                print(f"scene {seed} ({integrator}): {kind}: {note}", flush=True)
    return count, by, reasons


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program", nargs="?", default=ROOT / "build" / "clathra")
    parser.add_argument("--reader", help="read_many beside the tests", default=None)
    parser.add_argument("--scenes", type=int, default=100)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit", type=float, default=60.0, help="seconds a run may take")
    parser.add_argument("--steps", type=int, default=40, help="steps (bursts of hybrid) of a scene at most")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--run-valid", type=float, default=0.01, help="share of the valid mutated cases that is run")
    parser.add_argument("--keep", default="results/soak", help="folder for what goes wrong")
    parser.add_argument("--verbose", action="store_true")
    args = parser.parse_args()
    args.program = Path(args.program).resolve()
    args.reader = Path(args.reader or args.program.parent / "tests" / "read_many").resolve()
    soak = Soak(args)
    wrong = 0
    if args.scenes:
        count, by, reasons = soak_scenes(soak, args)
        print(f"{args.scenes} scenes from {args.seed}: " + ", ".join(f"{n} {k}" for k, n in count.most_common()))
        for name in sorted({i for i, _ in by}):
            print(f"  {name}: " + ", ".join(f"{n} {k}" for (i, k), n in sorted(by.items()) if i == name))
        for reason, n in reasons.most_common(15):
            print(f"  {n:5d} {reason}")
        wrong += sum(n for k, n in count.items() if k not in GOOD)
    if args.cases:
        count = soak_cases(soak, args)
        print(f"{args.cases} mutated cases from {args.seed}: " + ", ".join(f"{n} {k}" for k, n in count.most_common()))
        wrong += sum(n for k, n in count.items() if k.removeprefix("run: ") not in (*GOOD, "valid"))
    if wrong:
        print(f"{wrong} went wrong; see {args.keep}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
