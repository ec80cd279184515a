#!/usr/bin/env python3
"""Benchmark: where the time of an implicit step goes.  Usage: bench.py CLATHRA [OUT.md]

BP2 case 2 (kinetics on) as a strip of 50, 200 and 800 cells, and as a plane block of 100 x 100 cells, on one core.
Times are PETSc's own logging; the same run yields all numbers of a row.
"""
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bench_explicit
import bench_ranks

ROOT = Path(__file__).resolve().parent.parent
CASE = ROOT / "cases" / "bp2" / "case.yaml"

BLOCK = ["-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "10 s"]
# name, cells along x, cells across, body height (m), steps (None: the whole run), options
SCENES = [
    ("strip, 50 cells", 52, 1, 0.02, None, []),
    ("strip, 200 cells", 208, 1, 0.005, 40, []),
    ("strip, 800 cells", 832, 1, 0.00125, 10, []),
    ("block, 100 x 100 cells", 104, 100, 1.0, 1, BLOCK),
    ("dry block (m), 100 x 100 cells", 104, 100, 1.0, 10, BLOCK),
    ("the same six-field block, options/krylov.opts", 104, 100, 1.0, 1, [*BLOCK, "-options_file", str(ROOT / "options" / "krylov.opts")]),
]


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
            raise SystemExit(f"bench: {source} no longer holds '{old}'")
        text = text.replace(old, new)
    path = Path(folder) / "case.yaml"
    path.write_text(text)
    return path


def case_file(folder, nx, ny, height, name):
    """BP2 with other cells and another height of the body; or the dry block."""
    if name.startswith("dry"):
        path = Path(folder) / "case.yaml"
        path.write_text(DRY)
        return path
    return edited(CASE, folder, ("upper: [1.04 m, 0.02 m]", f"upper: [1.04 m, {height} m]"), ("cells: [52, 1]", f"cells: [{nx}, {ny}]"),
                  ("upper: [1 m, 0.02 m]", f"upper: [1 m, {height} m]"), ("position: 0.02 m", f"position: {height} m"),
                  ("0.01 m]}", f"{height / 2} m]}}"))  # fmt: skip


def log_events(text):
    """{event: (count, seconds)} of -log_view."""
    found = {}
    for m in re.finditer(r"^(\w+)\s+(\d+)\s+[\d.]+\s+([\d.e+-]+)\s", text, re.M):
        found.setdefault(m.group(1), (int(m.group(2)), float(m.group(3))))
    return found


def run(binary, scene):
    name, nx, ny, height, steps, options = scene
    with tempfile.TemporaryDirectory() as folder:
        command = [binary, str(case_file(folder, nx, ny, height, name)), "-output_dir", folder + "/out", "-quiet", "-log_view", *options]
        if steps:
            command += ["-stepper_max_steps", str(steps)]
        start = time.perf_counter()
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
    if status:
        raise SystemExit(f"bench: {name} failed\n{text[-2000:]}")
    m = re.search(r"(\d+) steps, (\d+) refused, (\d+) Newton iterations, ([\d.]+) s", text)
    dry = name.startswith("dry")
    return {"name": name, "particles": round(nx / 1.04) * 2 * ny * (1 if dry else 2),
            "unknowns": (nx - round(nx * 0.04 / 1.04) + 1) * (ny + 1) * (2 if dry else 9),
            "steps": int(m.group(1)), "newton": int(m.group(3)), "seconds": float(m.group(4)), "wall": wall,
            "rss": usage.ru_maxrss * 1024.0, "log": log_events(text)}


def row(r, base):
    log, n = r["log"], r["particles"]

    def each(event, unit):
        count, seconds = log.get(event, (0, 0.0))
        return seconds / count / unit if count else float("nan")

    jacobians, both = log["ClJacobian"]  # the second with what the preconditioner's set-up takes
    jacobian = (both - log.get("ClReducedMatrix", (0, 0.0))[1]) / jacobians / (1e-9 * n)
    krylov, solves = log["KSPGMRESOrthog"][0], log["SNESLineSearch"][0]  # one a Krylov iteration, one an update of Newton's method
    return [r["name"], n, r["unknowns"], r["steps"], f"{r['newton'] / r['steps']:.1f}", f"{solves / r['steps']:.1f}", f"{krylov / solves:.1f}",
            f"{each('ClResidual', 1e-9 * n):.0f}", f"{jacobian:.0f}", f"{each('ClReducedMatrix', 1e-3):.2f}" if "ClReducedMatrix" in log else f"{each('MatLUFactorNum', 1e-3):.2f}",
            f"{log['KSPSolve'][1] / max(krylov, 1) * 1e3:.3f}", f"{r['seconds'] / r['steps']:.3f}", f"{r['seconds']:.2f}",
            f"{(r['rss'] - base) / n / 1e3:.1f}", f"{(r['rss'] - base) / r['unknowns'] / 1e3:.1f}"]


def baseline(binary):
    """Memory of the program before it has a scene, bytes."""
    process = subprocess.Popen([binary, "-case_keys"], stdout=subprocess.DEVNULL)
    _, _, usage = os.wait4(process.pid, 0)
    return usage.ru_maxrss * 1024.0


def markdown(head, rows):
    return "\n".join(["| " + " | ".join(head) + " |", "|" + "---|" * len(head)] + ["| " + " | ".join(str(v) for v in r) + " |" for r in rows])


def explicit_section(binary):
    head, rows, copy, waits = bench_explicit.table(binary)
    return f"""
## Hybrid

Square blocks with 2 x 2 particles a cell, uGIMP, one core. Time in the steps alone (between two bursts of 256 the stable step is estimated and the particles are sorted: 2 % more with six fields, 10 % dry).
The last column compares the arrays that a step must read and write, each once a pass, with a stream copy in the same run ({copy / 1e9:.0f} GB/s).

{markdown(head, rows)}

*What rules it*: instructions. {bench_explicit.SIZES[0][0] ** 2 * 4} particles stay in caches; with {bench_explicit.SIZES[-1][0] ** 2 * 4} memory takes {100 * min(waits):.0f} to {100 * max(waits):.0f} % of the time, and the rest is what
the processor has to do: 1366 instructions a particle and step of a dry body, 2577 with water, 4179 with six fields, 3 to 4 a cycle (counted with valgrind's callgrind in a build for AVX2, 256 particles, 256
steps more or less; the same build timed at 4096 particles, 3.25 GHz). So the stream copy is far from being the limit: at three times the traffic it would have to do a third of these instructions.

For scale: the fastest mature GIMP code reaches 1.5 million dry (uGIMP), a widely used C++ code 0.55 million dry, its two-phase descendant 0.40 million (linear basis, explicit) and 0.12 million
(semi-implicit), the fastest explicit code found 4.1 million dry with linear functions; the least memory among them is 1.9 kB a particle.
"""


HEAD = ["scene", "particles", "unknowns", "steps", "Jacobians a step", "Newton updates a step", "Krylov an update", "residual, ns/particle", "Jacobian, ns/particle",
        "preconditioner, ms", "Krylov iteration, ms", "s a step", "s in all", "kB/particle", "kB/unknown"]


def main():
    binary, base = sys.argv[1], baseline(sys.argv[1])
    rows = []
    for scene in SCENES:
        rows.append(row(run(binary, scene), base))
        print(dict(zip(HEAD, rows[-1])), flush=True)
    direct, dry, krylov = (float(r[HEAD.index("s a step")]) for r in rows[-3:])
    text = f"""# Benchmark

Made by `cmake --build build --target bench` on one core; compare ratios, not seconds, between machines.
BP2 case 2; the strip of 50 cells runs all 2000 s, the others a few steps. Solvers against size and properties: [scale.md](scale.md).

{markdown(HEAD, rows)}

A mature C++ code takes 0.20 s for an implicit mechanics-only step of 10,000 nodes and 20,000 particles (linear elastic, conjugate gradients,
3.5 Newton iterations); the dry block above is of that size and takes {dry:.2f} s. A six-field step has 9 unknowns a node instead of 2; scaled with
(9/2)^2 the 0.20 s become 4.05 s. A step of the block above, with 10,000 nodes and 40,000 particles, takes {direct:.1f} s with multigrid, the default at that size, and {krylov:.1f} s\nwith options/krylov.opts: {direct / 4.05:.1f} and {krylov / 4.05:.1f} times that.
"""
    text += explicit_section(binary) + bench_ranks.sections(binary)
    if len(sys.argv) > 2:
        Path(sys.argv[2]).write_text(text)
    print(text)


if __name__ == "__main__":
    main()
