#!/usr/bin/python3
"""Benchmarks: bench.py CLATHRA [OUT.md], or bench.py CLATHRA scale [--only REGEX] [--cells N,N,...] [--again] [--page]

The first says where the time of a step goes, implicit and hybrid, on one core and on several (docs/studies/benchmark.md); all numbers of a row come from one run.

`scale` runs solvers of implicit steps against size and against properties.  Every run is kept in docs/studies/scale.json as soon as it is there and not run
again (--again: the chosen ones are); docs/studies/scale.md is written anew from all of them (--page: only that).  --only chooses runs by name ("size",
"size block 50:", "extremes", "operator", "across", "long"), --cells those of the sizes (25 and 50 unless said; 100, 200 and 350 want minutes and up to
20 GB).  Time is user time of the process less that of one without a step, so a busy machine hardly matters; memory is the resident set likewise.
"""
import argparse
import json
import re
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

import clathra
import dated

ROOT = Path(__file__).resolve().parents[1]
CASES = ROOT / "tests" / "verification" / "cases"
BENCHMARK = dated.STUDIES / "benchmark.md"
BP2 = ROOT / "cases" / "bp2" / "case.yaml"


# ---------------------------------------------------------------- runs, and what -log_view says of them
def measured(binary, case, options=(), ranks=1, limit=None):
    """One run: (Job, what it said and its log, s of the wall); killed after `limit` s."""
    with tempfile.TemporaryDirectory() as folder:
        log, start = Path(folder) / "log", time.perf_counter()
        job = clathra.Case(case, binary).start(Path(folder) / "out", ranks, ("-quiet", "-log_view", f":{log}", *options))
        if job.end(limit) is None:
            job.stop(0)
        if job.code in (1, 2):
            job.fail()
        return job, job.said + (log.read_text() if log.is_file() else ""), time.perf_counter() - start


def events(text):
    """{event: (count, seconds, messages, bytes, reductions)} of -log_view, of all ranks together."""
    row = re.compile(r"^(\w+)\s+(\d+)\s+\S+\s+(\S+)\s+\S+\s+\S+\s+\S+\s+(\S+)\s+(\S+)\s+(\S+)\s", re.M)
    found = {}
    for name, count, seconds, messages, length, reductions in row.findall(text):
        try:
            found.setdefault(name, (int(count), float(seconds), float(messages), float(messages) * float(length), float(reductions)))
        except ValueError:
            continue
    return found


def counts(text):
    """Steps, refused ones and Newton iterations of a summary; zeros where there is none."""
    found = re.search(r"(\d+) steps, (\d+) refused, (\d+) Newton iterations", text)
    return tuple(map(int, found.groups())) if found else (0, 0, 0)


def markdown(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(str(v) for v in r) + " |" for r in rows])


# ---------------------------------------------------------------- scenes
EULER = ("-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "10 s")

DRY = """
title: dry block
fields: [solid]
grid: {lower: [0 m, 0 m], upper: [1.04 m, 1 m], cells: [104, 100]}
materials: [soil]
mat: {soil: {porosity: 0.3, solid: {density: 2600 kg/m^3}, elasticity: {E0: 90 MPa, nu: 0.3}}}
regions: [block]
region: {block: {lower: [0 m, 0 m], upper: [1 m, 1 m], material: soil, particles_per_cell: [2, 1]}}
boundaries: [base, low, high, load]
bc:
  base: {type: fixed, axis: x, position: 0 m}
  low: {type: roller, axis: y, position: 0 m}
  high: {type: roller, axis: y, position: 1 m}
  load: {type: traction, side: right, normal: {ramp: [0 Pa, 1 MPa, 0 s, 100 s]}}
time: {end: 100 s}
"""


def edited(source, folder, *pairs):
    """Path of a copy of a case in `folder`, each (old, new) replaced."""
    text = Path(source).read_text()
    for old, new in pairs:
        if old not in text:
            raise SystemExit(f"bench.py: {source} no longer holds '{old}'")
        text = text.replace(old, new)
    path = Path(folder) / "case.yaml"
    path.write_text(text)
    return path

def bp2(folder, nx, ny, height, length=1.0, end=1.04):
    """BP2 with other cells, a body of another size (m) and another end of the grid (m)."""
    return edited(BP2, folder, ("upper: [1.04 m, 0.02 m]", f"upper: [{end} m, {height} m]"), ("cells: [52, 1]", f"cells: [{nx}, {ny}]"),
                  ("upper: [1 m, 0.02 m]", f"upper: [{length} m, {height} m]"), ("position: 0.02 m", f"position: {height} m"), ("0.01 m]}", f"{height / 2} m]}}"))  # fmt: skip


def broad(folder, n):
    """BP2 as a block of n x n cells (and spare ones along x)."""
    return bp2(folder, n + max(1, n // 25), n, 1.0)


def dry(folder, n):
    path = Path(folder) / "case.yaml"
    path.write_text(DRY.replace("cells: [104, 100]", f"cells: [{n + max(1, n // 25)}, {n}]"))
    return path


# ---------------------------------------------------------------- implicit steps
# name, cells along x, cells across, body height (m), steps (None: the whole run), options
IMPLICIT = [
    ("strip, 50 cells", 52, 1, 0.02, None, ()),
    ("strip, 200 cells", 208, 1, 0.005, 40, ()),
    ("strip, 800 cells", 832, 1, 0.00125, 10, ()),
    ("block, 100 x 100 cells", 104, 100, 1.0, 1, EULER),
    ("dry block (m), 100 x 100 cells", 104, 100, 1.0, 10, EULER),
    ("the same six-field block, options/krylov.opts", 104, 100, 1.0, 1, (*EULER, "-options_file", ROOT / "options" / "krylov.opts")),
]
HEAD = ["scene", "particles", "unknowns", "steps", "Jacobians a step", "Newton updates a step", "Krylov an update", "residual, ns/particle", "Jacobian, ns/particle",
        "preconditioner, ms", "Krylov iteration, ms", "s a step", "s in all", "kB/particle", "kB/unknown"]


def implicit(binary, scene):
    name, nx, ny, height, steps, options = scene
    dry_ = name.startswith("dry")
    with tempfile.TemporaryDirectory() as folder:
        case = dry(folder, ny) if dry_ else bp2(folder, nx, ny, height)
        job, text, wall = measured(binary, case, (*options, *(("-stepper_max_steps", steps) if steps else ())))
    if job.code:
        job.fail()
    made, _, newton = counts(text)
    return {"name": name, "particles": round(nx / 1.04) * 2 * ny * (1 if dry_ else 2),
            "unknowns": (nx - round(nx * 0.04 / 1.04) + 1) * (ny + 1) * (2 if dry_ else 9),
            "steps": made, "newton": newton, "seconds": float(re.search(r"Newton iterations, ([\d.]+) s", text)[1]), "wall": wall,
            "rss": job.usage.ru_maxrss * 1024.0, "log": events(text)}  # fmt: skip


def row(r, base):
    log, n = r["log"], r["particles"]

    def each(event, unit):
        count, seconds = log.get(event, (0, 0.0))[:2]
        return seconds / count / unit if count else float("nan")

    jacobians, both = log["ClJacobian"][:2]  # the second with what the preconditioner's set-up takes
    jacobian = (both - log.get("ClReducedMatrix", (0, 0.0))[1]) / jacobians / (1e-9 * n)
    krylov, solves = log["KSPGMRESOrthog"][0], log["SNESLineSearch"][0]  # one a Krylov iteration, one an update of Newton's method
    return [r["name"], n, r["unknowns"], r["steps"], f"{r['newton'] / r['steps']:.1f}", f"{solves / r['steps']:.1f}", f"{krylov / solves:.1f}",
            f"{each('ClResidual', 1e-9 * n):.0f}", f"{jacobian:.0f}", f"{each('ClReducedMatrix', 1e-3):.2f}" if "ClReducedMatrix" in log else f"{each('MatLUFactorNum', 1e-3):.2f}",
            f"{log['KSPSolve'][1] / max(krylov, 1) * 1e3:.3f}", f"{r['seconds'] / r['steps']:.3f}", f"{r['seconds']:.2f}",
            f"{(r['rss'] - base) / n / 1e3:.1f}", f"{(r['rss'] - base) / r['unknowns'] / 1e3:.1f}"]


def implicit_section(binary):
    job = clathra.Job([binary, "-case_keys"])  # memory of the program before it has a scene
    job.end()
    rows = []
    for scene in IMPLICIT:
        rows.append(row(implicit(binary, scene), job.usage.ru_maxrss * 1024.0))
        print(dict(zip(HEAD, rows[-1])), flush=True)
    direct, dry_, krylov = (float(r[HEAD.index("s a step")]) for r in rows[-3:])
    return f"""Made by `cmake --build build --target bench` on one core; compare ratios, not seconds, between machines.
BP2 case 2; the strip of 50 cells runs all 2000 s, the others a few steps. Solvers against size and properties: [scale.md](scale.md).

{markdown(HEAD, rows)}

A mature C++ code takes 0.20 s for an implicit mechanics-only step of 10,000 nodes and 20,000 particles (linear elastic, conjugate gradients,
3.5 Newton iterations); the dry block above is of that size and takes {dry_:.2f} s. A six-field step has 9 unknowns a node instead of 2; scaled with
(9/2)^2 the 0.20 s become 4.05 s. A step of the block above, with 10,000 nodes and 40,000 particles, takes {direct:.1f} s with multigrid, the default at that size, and {krylov:.1f} s\nwith options/krylov.opts: {direct / 4.05:.1f} and {krylov / 4.05:.1f} times that.
"""


# ---------------------------------------------------------------- hybrid
HYBRID_PARTS = {"ClExDeposit": "particles to nodes", "ClExVelocities": "velocities", "ClExRates": "rates", "ClExScalars": "p and T", "ClExUpdate": "update",
         "ClExOrder": "order"}
COMMON = """
grid: {{lower: [0 m, 0 m], upper: [{top} m, 1 m], cells: [{nx}, {n}]}}
basis: ugimp
materials: [soil]
mat:
  soil:
    porosity: 0.15
    solid: {{density: 2600 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}}
    permeability: {{k0: 1e-12 m^2, mh: 3}}
    elasticity: {{E0: 90 MPa, Eh: 2 GPa, ah: 1, bh: 1, nu: 0.3, stiffness_change: both}}
{laws}
regions: {regions}
boundaries: [base, low, high, load{drains}]
bc:
  base: {{type: fixed, axis: x, position: 0 m}}
  low: {{type: roller, axis: y, position: 0 m}}
  high: {{type: roller, axis: y, position: 1 m}}
  load: {{type: traction, side: right, normal: {{ramp: [{p} MPa, {q} MPa, 0 s, {rise} s]}}}}
{drain}
time: {{end: 10 s}}
stepper: {{type: hybrid}}
output: {{probe_every: 10 s}}
"""
GAS = """
    gas: {eos: ideal}
    retention: {law: van_genuchten, p0: 50 kPa, m: 0.3, Swr: 0.2, Sgr: 0.4}
    relperm: {nw: 4, ng: 2}
    kinetics: {active: yes, K0: 2.5e-7 mol/(m^2 Pa s), dE: 0 J/mol, A_geo: 1e6 1/m, equilibrium: sloan, A1: 1 kPa, A2: 38.98, A3: 8533.8 K}
    latent_heat: {C0: 473632 J/kg, C1: 140.117 J/(kg K)}
"""
# The tenth beside the load starts on the yield surface, and the load, which rises, keeps it there.
PLASTIC = GAS + """
    plasticity: {law: mohr_coulomb, flow: menetrey_willam, cohesion_max: 10 kPa, cohesion_residual: 5 kPa, friction_peak: 15 deg, dilation_max: 5 deg, eta_s: 5}
"""
DRAIN = "  drain: {type: pressure, side: right, initial: yes}"
WET = ", pressure: 3.25 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4, Sh: 0"
# name, fields, laws, state, drained, numbers a step must at least read and write per particle
SETS = [
    ("dry (m)", "[solid]", "", "", False),
    ("saturated (hm)", "[solid, water]", "", ", pressure: 3.25 MPa", True),
    ("six fields (thmc)", "thmc", GAS, WET, True),
    ("six fields, plastic", "thmc", PLASTIC, WET, True),
]


# cells across, bursts: in the cache of a core, in that of the processor, in memory
SIZES = ((32, 20), (71, 4), (224, 1))


def stream_copy():
    """Bytes a second, read and written, of a copy far larger than the caches: the best of five."""
    a = np.ones(25_000_000)
    b = np.empty_like(a)
    best = np.inf
    for _ in range(5):
        start = time.perf_counter()
        np.copyto(b, a)
        best = min(best, time.perf_counter() - start)
    return 2 * a.nbytes / best


def traffic(fields):
    """Bytes per particle and step if each pass read and wrote every array it uses just once (src/explicit)."""
    fluids = {"[solid]": 0, "[solid, water]": 1}.get(fields, 2)
    heat = fields == "thmc"
    deposit = 2 + 2 + 3 + 6 + fluids * (1 + 1 + 2 + 2 + 2) + 3 * heat + (2 if fluids == 2 else 0)
    rates = (2 + 2 + 3 + 1 + 4 + fluids * (1 + 2 + 4 + 2 + 4) + heat + (2 + 3 if fluids == 2 else 0)) if fluids or heat else 0
    update = 4 + 4 + 4 + 2 + 16 + 3 + fluids * (2 + 2 + 2 + 4) + 4 * heat + (5 if fluids == 2 else 0) + (0 if fluids else 4)
    return 8.0 * (deposit + rates + update)


def case_text(kind, n):
    name, fields, laws, state, drained = kind
    plastic = laws is PLASTIC
    p = (3.25 if drained else 0.0) + (1 if plastic else 0)
    box = lambda left, right, stress: f"{{lower: [{left} m, 0 m], upper: [{right} m, 1 m], material: soil, particles_per_cell: [2, 2]{state}{stress}}}"
    stress = lambda across: f", stress: [-1 MPa, {across} MPa, {across} MPa, 0 Pa, 0 Pa, 0 Pa]"
    part = round(0.9 * n) / n
    body = COMMON.format(top=1 + 4 / n, nx=n + 4, n=n, laws=laws, drains=", drain" if drained else "", drain=DRAIN if drained else "", p=p, q=p + 1, rise=0.01 if plastic else 1,
                         regions=f"[far, near]\nregion: {{far: {box(0, part, stress(-1))}, near: {box(part, 1, stress(-0.5735))}}}" if plastic else f"[block]\nregion: {{block: {box(0, 1, '')}}}")  # fmt: skip
    return f"title: {name}\nfields: {fields}\n{body}"


def hybrid(binary, kind, n, bursts, ranks=1):
    """What it said of one run, its events, and million particle-steps a second."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.yaml"
        path.write_text(case_text(kind, n))
        text = measured(binary, path, ("-stepper_max_steps", 256 * bursts), ranks)[1]
    found = {name: log[1] for name, log in events(text).items() if name.startswith("ClEx")}
    return text, found, 4e-6 * n * n * counts(text)[0] / sum(found.values())


def hybrid_rows(binary):
    """Rows of the table, with a stream copy of the same run; and of each scene the share of the time in memory that goes when it fits the cache."""
    copy = stream_copy()
    rows, waits = [], []
    for kind in SETS:
        rates = []
        for n, bursts in SIZES:
            text, spent, rate = hybrid(binary, kind, n, bursts)
            rates.append(rate)
            memory, yields = float(re.search(r"([\d.]+) B a particle", text)[1]), re.search(r"(\d+) of (\d+) particles yield", text)
            shares = [f"{100 * spent.get(e, 0.0) / sum(spent.values()):.0f} %" for e in HYBRID_PARTS]
            rows.append([kind[0] + (f", {100 * int(yields[1]) / int(yields[2]):.0f} % yield" if yields else ""), 4 * n * n, f"{rate:.2f}", *shares, f"{memory:.0f}", f"{1e8 * rate * traffic(kind[1]) / copy:.0f} %"])
            print(rows[-1], flush=True)
        waits.append(1 - rates[-1] / max(rates))
    head = ["scene", "particles", "million particle-steps a second", *HYBRID_PARTS.values(), "B a particle", "traffic of a stream copy"]
    return head, rows, copy, waits


def hybrid_section(binary):
    head, rows, copy, waits = hybrid_rows(binary)
    return f"""
## Hybrid

Square blocks with 2 x 2 particles a cell, uGIMP, one core. Time in the steps alone (between two bursts of 256 the stable step is estimated and the particles are sorted: 2 % more with six fields, 10 % dry).
The last column compares the arrays that a step must read and write, each once a pass, with a stream copy in the same run ({copy / 1e9:.0f} GB/s).

{markdown(head, rows)}

*What rules it*: instructions. {SIZES[0][0] ** 2 * 4} particles stay in caches; with {SIZES[-1][0] ** 2 * 4} memory takes {100 * min(waits):.0f} to {100 * max(waits):.0f} % of the time, and the rest is what
the processor has to do: 1366 instructions a particle and step of a dry body, 2577 with water, 4179 with six fields, 3 to 4 a cycle (counted with valgrind's callgrind in a build for AVX2, 256 particles, 256
steps more or less; the same build timed at 4096 particles, 3.25 GHz). So the stream copy is far from being the limit: at three times the traffic it would have to do a third of these instructions.

For scale: the fastest mature GIMP code reaches 1.5 million dry (uGIMP), a widely used C++ code 0.55 million dry, its two-phase descendant 0.40 million (linear basis, explicit) and 0.12 million
(semi-implicit), the fastest explicit code found 4.1 million dry with linear functions; the least memory among them is 1.9 kB a particle.
"""


# ---------------------------------------------------------------- ranks
PARTS = {"ClBeginStep": "start of the step", "ClResidual": "residual", "ClJacobian": "Jacobian", "Krylov": "Krylov iteration"}
STEP = (*EULER, "-stepper_max_steps", 1, "-reduced_pc_type", "fieldsplit")


def each(log, part):
    """(seconds, messages, bytes, reductions) of one of its kind; a Krylov iteration without what sets up the preconditioner."""
    if part != "Krylov":
        count, *sums = log[part]
        return [v / count for v in sums]
    count, setup = log["KSPGMRESOrthog"][0], log["PCSetUp"]
    return [(a - b) / count for a, b in zip(log["KSPSolve"][1:], setup[1:], strict=True)]


def over_ranks(binary, nx, ny, ranks):
    """Events of one Euler step of BP2 as a block of nx x ny cells of one size, and of each of PARTS."""
    with tempfile.TemporaryDirectory() as folder:
        log = events(measured(binary, bp2(folder, nx + 4, ny, ny / 100, nx / 100, (nx + 4) / 100), STEP, ranks)[1])
    return log, {part: each(log, part) for part in PARTS}


def ranks_section(binary):
    one, one_each = over_ranks(binary, 100, 100, 1)
    two, two_each = over_ranks(binary, 100, 100, 2)
    wide, wide_each = over_ranks(binary, 200, 100, 2)
    four, four_each = over_ranks(binary, 100, 100, 4)
    rows = [[what, *(f"{1e3 * log[part][0]:.1f}" for log in (one_each, two_each, wide_each)), f"{one_each[part][0] / two_each[part][0]:.2f}", f"{one_each[part][0] / wide_each[part][0]:.2f}"]
            for part, what in PARTS.items()]  # fmt: skip
    rows.append(["all of the step", *(f"{1e3 * log['SNESSolve'][1]:.0f}" for log in (one, two, wide)), f"{one['SNESSolve'][1] / two['SNESSolve'][1]:.2f}",
                 f"{one['SNESSolve'][1] / wide['SNESSolve'][1]:.2f}"])  # fmt: skip
    messages = [[what, *(f"{log[part][1] / n:.0f}" if k == 0 else f"{log[part][2] / n / 1e3:.0f}" if k == 1 else f"{log[part][3]:.0f}"
                         for n, log in ((2, two_each), (4, four_each)) for k in range(3))] for part, what in PARTS.items()]  # fmt: skip
    speeds = []
    for kind in (SETS[0], SETS[2]):
        for n, bursts in ((71, 4), (224, 1)):
            alone, both = (hybrid(binary, kind, n, bursts, ranks)[2] for ranks in (1, 2))
            speeds.append([kind[0], 4 * n * n, f"{alone:.2f}", f"{both:.2f}", f"{both / alone:.2f}"])
            print(speeds[-1], flush=True)
    return f"""
## Ranks

The six-field block of 100 x 100 cells with multigrid, one Euler step, on one and two cores; and twice as long (200 x 100 cells) on two. Milliseconds; a Krylov iteration is one of GMRES without what sets up the
preconditioner. The counts of iterations differ a little with the ranks, so the last row compares steps, not work.

{markdown(["", "1 rank", "2 ranks", "2 ranks, 200 x 100 cells", "one over two", "one over two of twice the size"], rows)}

`hybrid`, million particle-steps a second:

{markdown(["scene", "particles", "1 rank", "2 ranks", "ratio"], speeds)}

Messages that a rank sends, kB that it sends, and sums over all ranks, each time (those of hypre within a Krylov iteration are not counted by PETSc):

{markdown(["", "2 ranks: messages", "kB", "sums", "4 ranks: messages", "kB", "sums"], messages)}
"""


# ---------------------------------------------------------------- scale: solvers against size and properties
STORE, PAGE = dated.STUDIES / "scale.json", dated.STUDIES / "scale.md"
STABILITY, FOOTING, FIELD_SETS = (CASES / f"{name}.yaml" for name in ("stability", "strip", "field_sets"))
WHOLE, LU, MULTIGRID = ("-newton_preconditioner", "whole"), ("-reduced_pc_type", "lu"), ("-reduced_pc_type", "fieldsplit")
KINDS = (("whole", WHOLE), ("LU", LU), ("multigrid", MULTIGRID))
FRESH = ("-newton_refactor", 0)


def solved(binary, case, options, ranks=1, limit=1800):
    """What one run says: iterations of each linear solve, steps, Newton iterations, user seconds, memory."""
    job, text, _ = measured(binary, case, ("-ksp_converged_reason", *options), ranks, limit)
    its = [int(n) for n in re.findall(r"Linear solve \w+ due to \w+ iterations (\d+)", text)]
    (steps, refused, _), log = counts(text), events(text)
    why = re.findall(r"(?:Given up|clathra:).*", text)
    return {"status": job.code, "steps": steps, "refused": refused, "solves": len(its),
            "mean": sum(its) / max(len(its), 1), "most": max(its, default=0), "failed": len(re.findall("Linear solve did not", text)),
            "lu": len(re.findall("reduced preconditioner broke down", text)), "user": job.usage.ru_utime, "memory": job.usage.ru_maxrss * 1024,
            "made": log.get("ClReducedMatrix", log.get("MatLUFactorNum", (0, 0.0)))[0], "why": why[0] if why else "",
            "finished": " finished at " in text or " stopped at " in text}  # fmt: skip


def some_fields(folder, names, n):
    """The scene of field_sets.py with these of its fields, n cells of its body across."""
    words = {"t": "heat", "h": "water", "m": "solid", "c": "gas"}
    keep = {words[k] for k in names} | ({"drained"} if "h" in names else set()) | ({"warmed"} if "t" in names else set()) | (set() if "m" in names else {"rigid"})
    lines = [line for line in FIELD_SETS.read_text().splitlines() for tag in [re.search(r"# only (\w+)$", line)] if tag is None or tag[1] in keep]
    m = round(n * 0.4 / 0.26)
    path = Path(folder) / "case.yaml"
    path.write_text("\n".join(lines).replace("cells: [5, 4]", f"cells: [{m}, {m}]") + "\n")
    return path


def extreme(folder, fields="thmc", body="0.2 m", width="0.2 m", cells="[22, 20]"):
    """The column of stability.yaml as a block of 20 x 20 cells; without gas for `hm`."""
    gas = [("Sh: 0.2, Sw: 0.6, Sg: 0.2", ""), ("pressure: 7 MPa, temperature: 10 degC,\n    ", "pressure: 7 MPa, temperature: 10 degC"),
           (", saturation: free", ""), ("kinetics: {active: yes", "kinetics: {active: no"), ("grid:", "fields: hm\ngrid:")] if fields == "hm" else []  # fmt: skip
    return edited(STABILITY, folder, ("upper: [0.22 m, 0.02 m] ", f"upper: [0.22 m, {body}] "), ("cells: [11, 1]", f"cells: {cells}"),
                  ("upper: [0.2 m, 0.02 m]", f"upper: [{width}, {body}]"), ("position: 0.02 m", f"position: {body}"),
                  ("{at: [0.2 m, 0.01 m]}", "{at: [0.18 m, 0.01 m]}"), *gas)  # fmt: skip


BLOCK = (*EULER, "-stepper_max_steps", 1)


def fixed(dt):
    return ["-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", f"{dt} s", "-time_end", f"{10 * dt} s", "-output_times", f"{10 * dt} s", "-stepper_max_steps", 3]


def sizes(cells):
    """(name, maker of the case, options, ranks): the block and the dry block, multigrid kept as (176) says and made at every iteration, and LU."""
    for n in cells:
        for name, make, steps, most in (("block", broad, BLOCK, 100), ("dry", dry, (*EULER, "-stepper_max_steps", 3), 200)):
            yield f"size {name} {n}: kept", lambda f, n=n, make=make: make(f, n), (*steps, *MULTIGRID), 1
            yield f"size {name} {n}: fresh", lambda f, n=n, make=make: make(f, n), (*steps, *MULTIGRID, *FRESH), 1
            if n <= most:
                yield f"size {name} {n}: LU", lambda f, n=n, make=make: make(f, n), (*steps, *LU), 1


def extremes():
    """Properties to their ends, each by LU of the whole and by LU and multigrid of the reduced matrix."""
    rows = [(f"k_0 = {k:g} m2, {s}", s, {}, ["-mat_sand_permeability_k0", f"{k} m^2", *fixed(1)]) for s in ("thmc", "hm")
            for k in (1e-9, 1e-10, 1e-12, 1e-14, 1e-16, 1e-18, 1e-20, 1e-22)]
    rows += [(f"K_w = {K:g} Pa, k_0 = {k:g} m2, hm", "hm", {}, ["-mat_sand_water_bulk_modulus", f"{K} Pa", "-mat_sand_permeability_k0", f"{k} m^2", *fixed(1)])
             for K in (2.2e7, 1e12) for k in (1e-12, 1e-16, 1e-20)]
    rows += [(f"dt = {dt:g} s, {s}", s, {}, fixed(dt)) for s in ("thmc", "hm") for dt in (1e-3, 1e-2, 1e-1, 10, 100, 1000)]
    rows += [(f"cells 0.01 x {0.2 * a / 20:g} m, {s}", s, {"body": f"{0.2 * a:g} m"}, fixed(1)) for s in ("thmc", "hm") for a in (10, 0.1)]
    rows += [(f"loaded side at {c:g} of a cell, {s}", s, {"width": f"{0.19 + 0.01 * c:g} m"}, fixed(1)) for s in ("thmc", "hm") for c in (0.5, 0.1, 0.01)]
    for name, fields, shape, options in rows:
        for kind, solver in KINDS:
            yield f"extremes {name}: {kind}", lambda f, fields=fields, shape=shape: extreme(f, fields, **shape), (*options, *solver), 1
    for kind, solver in KINDS:
        yield f"extremes hydrate front (BP2, 25 x 25 cells, 20 steps): {kind}", lambda f: broad(f, 25), ("-stepper_max_steps", 20, *solver), 1
        yield f"extremes plastic zone under a strip footing: {kind}", lambda f: FOOTING, ("-stepper_type", "sdirk2", "-stepper_max_steps", 20, *solver), 1


def operator(cells):
    """J x of GMRES: assembled with its wide part, particle by particle, or by differences of the residual."""
    for n in cells:
        for name, make in (("block", broad), ("dry", dry)):
            for kind, options in (("assembled", ("-newton_operator", "assembled")), ("particles", ("-newton_operator", "particles")), ("differences", ("-snes_mf_operator",))):
                yield f"operator {name} {n}: {kind}", lambda f, n=n, make=make: make(f, n), (*BLOCK, *MULTIGRID, *options), 1


def across():
    """Where multigrid begins to pay: scenes by the unknowns of the reduced matrix across the body, LU of the whole as far as that is quick."""
    strip = lambda f, n, b: bp2(f, n + max(1, n // 25), b, 0.02 * b)  # noqa: E731
    scenes = [(f"thmc, {n} x {b}", lambda f, n=n, b=b: strip(f, n, b), 5, b, ("-stepper_max_steps", 3)) for n, b in ((200, 1), (200, 4), (200, 8), (200, 16))]
    scenes += [(f"thmc, {b} x {b}", lambda f, b=b: broad(f, b), 5, b, ("-stepper_max_steps", 3)) for b in (15, 25, 35, 50, 75)]
    scenes += [(f"{s}, {round(b * 1.65)} x {b}", lambda f, s=s, b=b: some_fields(f, s, b), n, b, ("-stepper_max_steps", 3)) for s, n, bs in (("hm", 3, (20, 40, 80)), ("th", 2, (30, 60, 120))) for b in bs]
    scenes += [(f"m, {b} x {b}", lambda f, b=b: dry(f, b), 2, b, (*EULER, "-stepper_max_steps", 3)) for b in (50, 100, 200)]
    for name, make, n, b, options in scenes:
        for kind, solver in KINDS if n * b < 200 else KINDS[1:]:
            yield f"across n_r b = {n * b}: {name}, 1 rank: {kind}", make, (*options, *solver), 1
    for b in (25, 35, 50):
        for kind, solver in KINDS[1:]:
            yield f"across n_r b = {5 * b}: thmc, {b} x {b}, 2 ranks: {kind}", lambda f, b=b: broad(f, b), ("-stepper_max_steps", 3, *solver), 2


# name, case, options, particles, unknowns, steps by LU of the whole
LONG = (("century, 200 cells across", "century", ("-grid_upper", "200 m,101 m", "-grid_cells", "200,101", "-region_layer_upper", "200 m,100 m", "-bc_right_position", "200 m"), 80000, 101505, 4),
        ("masuda, 80 x 480 cells", "masuda", ("-grid_cells", "80,480"), 153600, 272727, 2))  # fmt: skip


def longs():
    """Whole runs on fine grids by the default, and their first steps by LU of the whole."""
    for name, case, options, _, _, few in LONG:
        yield f"long {name}: default", lambda f, case=case: ROOT / "cases" / case, options, 1
        yield f"long {name}: whole", lambda f, case=case: ROOT / "cases" / case, (*options, "-stepper_max_steps", few, *WHOLE), 1
        yield f"long {name}: begin", lambda f, case=case: ROOT / "cases" / case, (*options, "-stepper_max_steps", few), 1


def empty(binary, store, again):
    """Time and memory of a run that takes no step."""
    if again or "nothing" not in store:
        store["nothing"] = solved(binary, STABILITY, ("-stepper_max_steps", 0))
    return store["nothing"]


def number(v):
    return f"{v:.3g}" if v < 1000 else f"{v:.0f}"


def outcome(r):
    """What became of a run where it did not simply go through."""
    said = [f"{r['refused']} refused"] * (r["refused"] > 0) + [f"LU {r['lu']} times"] * (r["lu"] > 0) + ["ended: " + (r["why"] or "no answer")] * (r["status"] != 0)
    return ", ".join(said)


def pairs(store, study, kinds):
    """{scene: its runs of these kinds} of a study, where all are there."""
    scenes = dict.fromkeys(name.rsplit(": ", 1)[0] for name in store if name.startswith(study + " "))
    return {s.removeprefix(study + " "): [store[f"{s}: {k}"] for k in kinds] for s in scenes if all(f"{s}: {k}" in store for k in kinds)}


def size_rows(store):
    base, rows = store["nothing"], []
    for name, r in sorted(((n, r) for n, r in store.items() if n.startswith("size ")), key=lambda v: (v[0].split()[1], int(v[0].split()[2][:-1]), v[0].split()[3])):
        _, scene, n, kind = name.split()
        n, dry_ = int(n[:-1]), scene == "dry"
        nx = n + max(1, n // 25)
        filled = round(nx / 1.04)
        unknowns, particles = (filled + 1) * (n + 1) * (2 if dry_ else 9), filled * n * (2 if dry_ else 4)
        rows.append([scene, n, unknowns, kind, r["solves"], f"{r['mean']:.1f}", r["most"], r["made"], f"{(r['user'] - base['user']) / r['steps']:.3g}" if r["steps"] else "-",
                     number((r["user"] - base["user"]) / max(r["solves"], 1) / unknowns * 1e6), f"{(r['memory'] - base['memory']) / particles / 1e3:.1f}", outcome(r)])  # fmt: skip
    return rows


def page(store):
    base = store["nothing"]
    head = ["scene", "cells across", "unknowns", "preconditioner", "linear solves", "iterations, mean", "most", "times made", "s a step", "us a solve and unknown", "kB a particle", ""]
    kinds = [kind for kind, _ in KINDS]
    extreme = pairs(store, "extremes", kinds)
    extreme_rows = [[name, *(v for r in runs for v in (r["solves"], f"{r['mean']:.1f}", r["most"], outcome(r)))] for name, runs in extreme.items()]
    worse = [sum(runs[k]["status"] != 0 and runs[0]["status"] == 0 for runs in extreme.values()) for k in (1, 2)]
    back = [sum(runs[k]["lu"] for runs in extreme.values()) for k in (1, 2)]
    across_rows = []
    for name, (lu, grid) in sorted(pairs(store, "across", kinds[1:]).items(), key=lambda v: float(re.search(r"= (\d+)", v[0])[1])):
        whole = store.get(f"across {name}: whole")
        took = [(r["user"] - base["user"]) if r else None for r in (whole, lu, grid)]
        across_rows.append([name, *("-" if t is None else f"{t:.2f}" for t in took), f"{took[1] / took[2]:.2f}", *("-" if r is None else f"{r['memory'] / 1e6:.0f}" for r in (whole, lu, grid)),
                            "; ".join(f"{k}: {outcome(r)}" for k, r in zip(kinds, (whole, lu, grid)) if r and outcome(r))])  # fmt: skip
    operator_rows = [[name, *(v for r in runs for v in (r["solves"], f"{r['mean']:.1f}", f"{r['user'] - base['user']:.2f}", f"{(r['memory'] - base['memory']) / 1e6:.0f}")), outcome(runs[-1])]
                     for name, runs in pairs(store, "operator", ("assembled", "particles", "differences")).items()]  # fmt: skip
    ran = pairs(store, "long", ("default", "whole", "begin"))
    each = lambda run: (run["user"] - base["user"]) / run["solves"]  # s a linear solve
    long_rows = [[name, particles, unknowns, full["steps"], full["refused"], full["solves"], f"{full['mean']:.1f}", f"{full['user'] - base['user']:.0f}", f"{each(begin):.2f}", f"{each(whole):.2f}", f"{each(whole) / each(begin):.1f}", outcome(full)]
                 for name, _, _, particles, unknowns, _ in LONG if name in ran for full, whole, begin in [ran[name]]]  # fmt: skip
    return "\n".join(dated.head("Solvers of implicit steps", "scripts/bench.py", STORE)) + f"""
The data hold every run. User seconds of one process, less those of a run without a step, on machines that were not
always quiet: differences below a fifth mean nothing. Equation numbers are those of [equations.md](../equations.md).

## Size

One Euler step of 10 s of BP2 as a block with six fields and 4 particles a cell, and three of the dry block, from a cold start. Multigrid made once a step and where (176) says (*kept*), or at every
Newton iteration (*fresh*); LU of the same matrix for comparison. A solve is one Newton iteration.

{markdown(head, size_rows(store))}

## Where it begins to pay

User time of the first steps (adaptive `sdirk2` of BP2 as strips and blocks; fixed steps of the scene of field_sets.py; Euler steps of the dry block), by n_r b of (330): LU of the whole (as far as it was tried), LU and multigrid of what is left
without the fluid velocities. On two ranks the sum over both with their waiting, memory of one.

{markdown(["scene", "whole, s", "LU, s", "multigrid, s", "LU over multigrid", "whole, MB", "LU, MB", "multigrid, MB", ""], across_rows)}

## Properties to their ends

tests/verification/cases/stability.yaml as a block of 20 x 20 cells, loaded and drained at its right, three fixed Euler steps (1 s unless said); BP2 with its hydrate front; a strip footing at its collapse
load. Iterations a linear solve. Runs that LU of the whole finishes and LU or multigrid of the reduced matrix do not: {worse[0]} and {worse[1]}. Times that LU of the whole took over: {back[0]} and {back[1]}.

{markdown(["scene", "whole: solves", "mean", "most", "", "LU: solves", "mean", "most", "", "multigrid: solves", "mean", "most", ""], extreme_rows)}

## Long runs

Shipped cases on fine grids, to their end, by the default; and their first steps by it and by LU of the whole. User seconds.

{markdown(["case", "particles", "unknowns", "steps", "refused", "solves", "iterations a solve", "s in all", "s a solve, first steps", "... LU of the whole", "ratio", ""], long_rows)}

## The exact operator

J x of GMRES with multigrid, one Euler step: assembled, J2 with its wide part (27); particle by particle from tangents that are kept (401), the default; differences of the residual (`-snes_mf_operator`).
User seconds of the step and MB.

{markdown(["scene", "assembled: solves", "mean", "s", "MB", "particles: solves", "mean", "s", "MB", "differences: solves", "mean", "s", "MB", ""], operator_rows)}

With six fields differences cost more than either product and lose solves. A particle of six fields keeps 0.8 kB: slopes as floats, but those of storage and of det F as doubles; J2 has 25 blocks of 81 a node, 4.1 kB a particle
with 4 a cell, and its assembly is most of a Jacobian. With all of them doubles the same iterations took 0.7 kB a particle more and up to a tenth more time. Tangents evaluated anew in every product would take no memory,
but a tangent costs two residuals, a product of kept ones half of one, and an iteration of GMRES needs two products.
"""


def scale(binary, words):
    parser = argparse.ArgumentParser("bench.py CLATHRA scale")
    parser.add_argument("--only", default="")
    parser.add_argument("--cells", default="25,50")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args(words)
    store = json.loads(STORE.read_text()) if STORE.exists() else {}
    cells = [int(n) for n in a.cells.split(",")]
    empty(binary, store, a.again and not a.only)
    for name, make, options, ranks in (*across(), *extremes(), *operator(cells), *sizes(cells), *longs()):
        if a.page or not re.search(a.only, name) or (name in store and not a.again):
            continue
        with tempfile.TemporaryDirectory() as folder:
            store[name] = solved(binary, make(folder), options, ranks, 7200)
        print(name, store[name], flush=True)
        STORE.write_text(json.dumps(store, indent=0) + "\n")
        dated.measured(STORE)
    PAGE.write_text(page(store))


def main(words):
    if not words or words[0].startswith("-"):
        sys.exit(__doc__)
    binary, *more = words
    if more[:1] == ["scale"]:
        return scale(binary, more[1:])
    text = implicit_section(binary) + hybrid_section(binary) + ranks_section(binary)
    if more:
        dated.measured(more[0])
        top = dated.head("Benchmark", "scripts/bench.py", BENCHMARK) if Path(more[0]).resolve() == BENCHMARK else ["# Benchmark", ""]
        Path(more[0]).write_text("\n".join([*top, text]))
    print(text)


if __name__ == "__main__":
    main(sys.argv[1:])
