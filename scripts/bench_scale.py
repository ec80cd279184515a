#!/usr/bin/env python3
"""Solvers of implicit steps against size and against properties.  Usage: bench_scale.py CLATHRA [--only REGEX] [--cells N,N,...] [--again] [--page]

Every run is kept in docs/scale.json as soon as it is there and not run again (--again: the chosen ones are); docs/scale.md is written anew
from all of them (--page: only that).  --only chooses runs by name ("size", "size block 50:", "extremes", "operator", "across", "long"), --cells those of
the sizes (25 and 50 unless said; 100, 200 and 350 want minutes and up to 20 GB).

Time is user time of the process less that of one without a step, so a busy machine hardly matters; memory is the resident set likewise.
"""
import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

import bench

ROOT = Path(__file__).resolve().parent.parent
STORE, PAGE = ROOT / "docs" / "scale.json", ROOT / "docs" / "scale.md"
STABILITY = ROOT / "tests" / "verification" / "cases" / "stability.yaml"
FOOTING = ROOT / "tests" / "verification" / "cases" / "strip.yaml"
FIELD_SETS = ROOT / "tests" / "verification" / "cases" / "field_sets.yaml"
ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}  # fmt: skip
WHOLE, LU, MULTIGRID = ("-newton_preconditioner", "whole"), ("-reduced_pc_type", "lu"), ("-reduced_pc_type", "fieldsplit")
KINDS = (("whole", WHOLE), ("LU", LU), ("multigrid", MULTIGRID))
KEPT, FRESH = (), ("-newton_refactor", "0")


def run(binary, case, options, ranks=1, limit=1800):
    """What one run says: iterations of each linear solve, steps, Newton iterations, user seconds, memory."""
    with tempfile.TemporaryDirectory() as folder:
        command = [*(("mpiexec", "-n", str(ranks)) if ranks > 1 else ()), binary, str(case), "-output_dir", folder + "/out", "-quiet",
                   "-ksp_converged_reason", "-log_view", f":{folder}/log", *map(str, options)]  # fmt: skip
        process = subprocess.Popen(["timeout", str(limit), *command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=ENVIRONMENT)
        text = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        log = Path(folder, "log")
        events = bench.log_events(log.read_text()) if log.exists() else {}
    its = [int(n) for n in re.findall(r"Linear solve \w+ due to \w+ iterations (\d+)", text)]
    m = re.search(r"(\d+) steps, (\d+) refused, (\d+) Newton iterations", text)
    if os.waitstatus_to_exitcode(status) in (1, 2):
        raise SystemExit(f"bench_scale: {' '.join(command)}\n{text[-2000:]}")
    why = re.findall(r"(?:Given up|clathra:).*", text)
    return {"status": os.waitstatus_to_exitcode(status), "steps": int(m[1]) if m else 0, "refused": int(m[2]) if m else 0, "solves": len(its),
            "mean": sum(its) / max(len(its), 1), "most": max(its, default=0), "failed": len(re.findall("Linear solve did not", text)),
            "lu": len(re.findall("reduced preconditioner broke down", text)), "user": usage.ru_utime, "memory": usage.ru_maxrss * 1024,
            "made": events.get("ClReducedMatrix", events.get("MatLUFactorNum", (0, 0.0)))[0], "why": why[0] if why else "",
            "finished": " finished at " in text or " stopped at " in text}  # fmt: skip


def broad(folder, n):
    """BP2 as a block of n x n cells (and spare ones along x)."""
    return bench.case_file(folder, n + max(1, n // 25), n, 1.0, "block")


def dry(folder, n):
    return bench.edited(bench.case_file(folder, 0, 0, 1.0, "dry"), folder, ("cells: [104, 100]", f"cells: [{n + max(1, n // 25)}, {n}]"))


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
    return bench.edited(STABILITY, folder, ("upper: [0.22 m, 0.02 m] ", f"upper: [0.22 m, {body}] "), ("cells: [11, 1]", f"cells: {cells}"),
                  ("upper: [0.2 m, 0.02 m]", f"upper: [{width}, {body}]"), ("position: 0.02 m", f"position: {body}"),
                  ("{at: [0.2 m, 0.01 m]}", "{at: [0.18 m, 0.01 m]}"), *gas)  # fmt: skip


BLOCK = (*bench.BLOCK, "-stepper_max_steps", 1)


def fixed(dt):
    return ["-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", f"{dt} s", "-time_end", f"{10 * dt} s", "-output_times", f"{10 * dt} s", "-stepper_max_steps", 3]


def sizes(cells):
    """(name, maker of the case, options, ranks): the block and the dry block, multigrid kept as (176) says and made at every iteration, and LU."""
    for n in cells:
        for name, make, steps, most in (("block", broad, BLOCK, 100), ("dry", dry, (*bench.BLOCK, "-stepper_max_steps", 3), 200)):
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
    strip = lambda f, n, b: bench.case_file(f, n + max(1, n // 25), b, 0.02 * b, "strip")  # noqa: E731
    scenes = [(f"thmc, {n} x {b}", lambda f, n=n, b=b: strip(f, n, b), 5, b, ("-stepper_max_steps", 3)) for n, b in ((200, 1), (200, 4), (200, 8), (200, 16))]
    scenes += [(f"thmc, {b} x {b}", lambda f, b=b: broad(f, b), 5, b, ("-stepper_max_steps", 3)) for b in (15, 25, 35, 50, 75)]
    scenes += [(f"{s}, {round(b * 1.65)} x {b}", lambda f, s=s, b=b: some_fields(f, s, b), n, b, ("-stepper_max_steps", 3)) for s, n, bs in (("hm", 3, (20, 40, 80)), ("th", 2, (30, 60, 120))) for b in bs]
    scenes += [(f"m, {b} x {b}", lambda f, b=b: dry(f, b), 2, b, (*bench.BLOCK, "-stepper_max_steps", 3)) for b in (50, 100, 200)]
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
        store["nothing"] = run(binary, STABILITY, ("-stepper_max_steps", 0))
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
    return f"""# Solvers of implicit steps

Written by `scripts/bench_scale.py` from docs/scale.json, which holds every run; change it, not this page. User seconds of one process, less those of a run without a step, on machines that were not
always quiet: differences below a fifth mean nothing. Equation numbers are those of [equations.md](equations.md).

## Size

One Euler step of 10 s of BP2 as a block with six fields and 4 particles a cell, and three of the dry block, from a cold start. Multigrid made once a step and where (176) says (*kept*), or at every
Newton iteration (*fresh*); LU of the same matrix for comparison. A solve is one Newton iteration.

{bench.markdown(head, size_rows(store))}

## Where it begins to pay

User time of the first steps (adaptive `sdirk2` of BP2 as strips and blocks; fixed steps of the scene of field_sets.py; Euler steps of the dry block), by n_r b of (330): LU of the whole (as far as it was tried), LU and multigrid of what is left
without the fluid velocities. On two ranks the sum over both with their waiting, memory of one.

{bench.markdown(["scene", "whole, s", "LU, s", "multigrid, s", "LU over multigrid", "whole, MB", "LU, MB", "multigrid, MB", ""], across_rows)}

## Properties to their ends

tests/verification/cases/stability.yaml as a block of 20 x 20 cells, loaded and drained at its right, three fixed Euler steps (1 s unless said); BP2 with its hydrate front; a strip footing at its collapse
load. Iterations a linear solve. Runs that LU of the whole finishes and LU or multigrid of the reduced matrix do not: {worse[0]} and {worse[1]}. Times that LU of the whole took over: {back[0]} and {back[1]}.

{bench.markdown(["scene", "whole: solves", "mean", "most", "", "LU: solves", "mean", "most", "", "multigrid: solves", "mean", "most", ""], extreme_rows)}

## Long runs

Shipped cases on fine grids, to their end, by the default; and their first steps by it and by LU of the whole. User seconds.

{bench.markdown(["case", "particles", "unknowns", "steps", "refused", "solves", "iterations a solve", "s in all", "s a solve, first steps", "... LU of the whole", "ratio", ""], long_rows)}

## The exact operator

J x of GMRES with multigrid, one Euler step: assembled, J2 with its wide part (27); particle by particle from tangents that are kept (401), the default; differences of the residual (`-snes_mf_operator`).
User seconds of the step and MB.

{bench.markdown(["scene", "assembled: solves", "mean", "s", "MB", "particles: solves", "mean", "s", "MB", "differences: solves", "mean", "s", "MB", ""], operator_rows)}

With six fields differences cost more than either product and lose solves. A particle of six fields keeps 0.8 kB: slopes as floats, but those of storage and of det F as doubles; J2 has 25 blocks of 81 a node, 4.1 kB a particle
with 4 a cell, and its assembly is most of a Jacobian. With all of them doubles the same iterations took 0.7 kB a particle more and up to a tenth more time. Tangents evaluated anew in every product would take no memory,
but a tangent costs two residuals, a product of kept ones half of one, and an iteration of GMRES needs two products.
"""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("binary")
    parser.add_argument("--only", default="")
    parser.add_argument("--cells", default="25,50")
    parser.add_argument("--again", action="store_true")
    parser.add_argument("--page", action="store_true")
    a = parser.parse_args()
    store = json.loads(STORE.read_text()) if STORE.exists() else {}
    cells = [int(n) for n in a.cells.split(",")]
    empty(a.binary, store, a.again and not a.only)
    for name, make, options, ranks in (*across(), *extremes(), *operator(cells), *sizes(cells), *longs()):
        if a.page or not re.search(a.only, name) or (name in store and not a.again):
            continue
        with tempfile.TemporaryDirectory() as folder:
            store[name] = run(a.binary, make(folder), options, ranks, 7200)
        print(name, store[name], flush=True)
        STORE.write_text(json.dumps(store, indent=0) + "\n")
    PAGE.write_text(page(store))


if __name__ == "__main__":
    main()
