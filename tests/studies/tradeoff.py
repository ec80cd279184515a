#!/usr/bin/python3
"""Study of what accuracy costs: writes docs/studies/tradeoff.md, its figures and docs/studies/tradeoff.json.

tradeoff.py [CLATHRA] [--only PART ...] [--page]

CLATHRA  the program, default build/clathra
--only   measure these parts again (wave, consolidation, bp2, block, permeability, terms, basis, choice, change), take the others from docs/studies/tradeoff.json
--page   write the page and the figures from docs/studies/tradeoff.json

Every number of the page is of one of its runs.  It is a study, no test: it takes about ten minutes of processor time.  Processor time is
user and system time of the process less that of starting it.
"""
import argparse
import json
import math
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "verification"), str(ROOT / "scripts")]
import _auto as slow_fast  # noqa: E402
import _integrators as scenes  # noqa: E402
import dated  # noqa: E402
import exact  # noqa: E402
from _integrators import EULER, EXPLICIT, SDIRK2, adaptive, apart, fixed, integrators, steps_of, timed  # noqa: E402
from common import CASES, changes, read_csv, seconds  # noqa: E402
from field_sets import select  # noqa: E402

PAGE, DATA, FIGURES = ROOT / "docs" / "studies" / "tradeoff.md", ROOT / "docs" / "studies" / "tradeoff.json", ROOT / "docs" / "figures"
SHORT = 1.0  # s: runs shorter than this are timed twice
LEAST = 0.01  # s: what the time of starting the program varies by
IMPLICIT = (EULER, SDIRK2)
GIVEN_UP = (0, 2, 3)  # exit codes that are results too


# ---------------------------------------------------------------------------------------------------------- measuring
class Clock:
    """Processor time of a run less that of starting the program."""

    start = None

    @classmethod
    def startup(cls):
        if cls.start is None:
            cls.start = min(timed(CASES / "heat_slab", "-case_keys").cpu for _ in range(5))
        return cls.start

    @classmethod
    def of(cls, scene, *options, **given):
        """(run, seconds): the shorter of two if it is short."""
        run = scene.run(*options, exit_code=GIVEN_UP, **given)
        cpu = run.cpu
        if run.code == 0 and cpu < SHORT:
            cpu = min(cpu, scene.run(*options, **given).cpu)
        return run, max(cpu - cls.startup(), LEAST)


def why(run):
    """The line that says why a run was refused or given up."""
    said = [line for line in run.output.splitlines() if re.search(r"Given up|clathra:|^/.*: |no stable", line)]
    return re.sub(r"^\S*/\S*: ", "", said[-1]).strip() if said else ""


def point(scene, kind, setting, options, reference, **given):
    """One run as a record: its work and its error, or why there is none."""
    run, cpu = Clock.of(scene, *options, **given)
    cells = given.get("cells", scene.cells)
    found = {"scene": scene.name, "kind": kind, "setting": setting, "cells": list(cells), "cpu": cpu, "code": run.code}
    if run.code == 0:
        each = apart(scene.curves(run), reference)
        found.update(steps=steps_of(run), each=each, error=max(each.values()))
    else:
        found.update(why=why(run), reached=reached(run))
    print("  ", {k: v for k, v in found.items() if k not in ("scene", "each")}, flush=True)
    return found


def reached(run):
    said = re.search(r"stopped at t = (\S+ \w+)", run.output)
    return seconds(said[1]) if said else 0.0


def work_precision(scene, reference, cells, steps, tols=(), kinds=None):
    """Every integrator: fixed steps, tolerances, or shares of the stable step, on each grid; `reference` of cells or of none."""
    known, found = (lambda n: reference(n)) if callable(reference) else (lambda n: reference), []
    for kind in kinds or integrators():
        for n in cells:
            if kind in EXPLICIT:
                choices = [("stable step x 0.5", adaptive(kind)), ("stable step x 0.9", (*adaptive(kind), "-stepper_cfl", 0.9))]
            else:
                choices = [(f"dt = {dt:g} s", fixed(kind, dt)) for dt in steps] + [(f"tol {tol:g}", adaptive(kind, tol)) for tol in tols]
            found += [point(scene, kind, name, options, known(n), cells=n) for name, options in choices]
    return found


# -------------------------------------------------------------------------------------------------------------- parts
WAVES = {  # name: column; the third load rises in the time in which the fast wave runs to and fro twice
    "gassy water (22 MPa)": scenes.wave(22e6),
    "water (2.2 GPa)": scenes.wave(2.2e9),
    "water (2.2 GPa), sudden load": scenes.wave(2.2e9, rise=0.02, end=0.05, every=0.0025),
}


def wave():
    found = []
    for name, scene in WAVES.items():
        grids = [(13 * 2**k, 1) for k in range(4)]
        steps = scene.every / np.array([1, 2, 5, 10] if "sudden" in name else [2, 5, 10, 20])
        found += [{**p, "name": name} for p in work_precision(scene, scene.exact(), grids, steps)]
    return found


def consolidation():
    scene = scenes.consolidation()
    return work_precision(scene, scene.exact(), [(13 * 2**k, 1) for k in range(3)], scene.every / np.array([1, 2, 5]), (1e-2, 1e-3, 1e-4))


def bp2_reference(case, scene):
    columns = {"p(0.6 m)": ("p_MPa", 1e6), "u(H)": ("u_mm", 1e-3), "S_h(0.6 m)": ("Sh", 1.0), "T(0.6 m)": ("T_C", 1.0)}
    table = read_csv(CASES / "bp2" / "reference" / f"bp2_case{case}.csv")
    share = scene.times() / scene.end * 2000.0
    return {k: np.interp(share, table["t_s"], table[columns[k][0]] * columns[k][1]) for k in scene.watched}


def bp2_error(curves, reference):
    """Largest difference: of p over its own value, of u and S_h over their peaks, of T over its change."""
    size = {k: np.abs(v) if k.startswith("p") else np.ptp(v) if k.startswith("T") else np.max(np.abs(v)) for k, v in reference.items()}
    return {k: float(np.max(np.abs(curves[k] - v) / size[k])) for k, v in reference.items()}


def bp2():
    """Implicit: the case as it is.  Explicit: in 2 s instead of 2000 s to its end, and a part of the case as it is."""
    found, grids = [], [(13, 1), (26, 1), (52, 1)]
    for case in (1, 2):
        scene = scenes.bp2(case, every=100.0)
        reference = bp2_reference(case, scene)
        for kind in IMPLICIT:
            for n in grids:
                for tol in (1e-1, 1e-2, 1e-3):
                    run, cpu = Clock.of(scene, *adaptive(kind, tol), "-stepper_dt", "20 s", "-stepper_dt_max", "200 s", cells=n)
                    found.append(bp2_record(case, kind, f"tol {tol:g}", n, run, cpu, scene, reference))
        for kind in [k for k in integrators() if k in EXPLICIT]:
            for n in grids:
                found.append(bp2_explicit(case, kind, n, "damping 0.1", scenes.DAMPED))
        found.append(bp2_explicit(case, "hybrid", grids[0], "no damping", ()))
    return found


def bp2_record(case, kind, setting, cells, run, cpu, scene, reference):
    found = {"case": case, "kind": kind, "setting": setting, "cells": list(cells), "cpu": cpu, "code": run.code}
    if run.code == 0:
        each = bp2_error(scene.curves(run), reference)
        found.update(steps=steps_of(run), each=each, error=max(each.values()))
    else:
        found.update(why=why(run), reached=reached(run))
    print("  ", {k: v for k, v in found.items() if k != "each"}, flush=True)
    return found


def bp2_explicit(case, kind, cells, setting, extra, bursts=40):
    """The faster case to its end (its error), and `bursts` of the case as it is (time a step and step, extrapolated to 2000 s)."""
    fast, slow = scenes.bp2(case, 1000, every=0.1), scenes.bp2(case, every=100.0)
    part, cpu = Clock.of(slow, *adaptive(kind), *extra, "-stepper_max_steps", 256 * bursts, cells=cells)
    steps, t = steps_of(part), seconds(re.search(r"(?:finished|stopped) at t = (\S+ \w+)", part.output)[1])
    whole = cpu * slow.end / t
    budget = () if kind == "hybrid" else ("-stepper_max_steps", 100)  # a step of a microsecond: no end in sight
    run, fast_cpu = Clock.of(fast, *adaptive(kind), *extra, *budget, cells=cells)
    if "finished" not in run.output:
        run.code = run.code or -1
    found = bp2_record(case, kind, f"{setting}, extrapolated", cells, run, whole, fast, bp2_reference(case, fast))
    return {**found, "steps": round(steps * slow.end / t), "measured_steps": steps, "measured_time": t, "measured_cpu": cpu,
            "fast_cpu": fast_cpu}  # fmt: skip


def block():
    """Error of each integrator against itself resolved finely in time, so that only the step counts: each on its own h."""
    scene = scenes.BLOCK
    fine = {True: scene.curves(scene.run(*adaptive("hybrid"), "-stepper_cfl", 0.1)) if "hybrid" in integrators() else None,
            False: scene.curves(scene.run(*adaptive(SDIRK2, 1e-5)))}  # fmt: skip
    found = []
    for kind in integrators():
        if kind != "explicit":  # its drag limits the step to a microsecond
            found += work_precision(scene, fine[kind in EXPLICIT], [scene.cells], (0.05, 0.02, 0.01, 0.005), (1e-1, 1e-2, 1e-3, 1e-4), [kind])
    if fine[True]:
        found.append({"scene": scene.name, "kind": "hybrid against sdirk2", "each": apart(fine[True], fine[False])})
    return found


def settlement(scene, k, Kw):
    """Exact settlement at scene.times(): dynamic while inertia may count, else Terzaghi's."""
    if k >= 1e-10:
        return scene.exact()["u(H)"]
    M = exact.constrained_modulus(14.516e6, 0.3)
    B, c = exact.mixture_coefficients(M, k / 1e-3, 0.33, Kw)
    return exact.terzaghi_ramps_settlement(*scene.table(), M, B, c, 10.0, scene.times())


def sweep_scene(Kw, k):
    """The column to a time factor of 1/2, loaded over a quarter of that."""
    c = exact.mixture_coefficients(exact.constrained_modulus(14.516e6, 0.3), k / 1e-3, 0.33, Kw)[1]
    end = 0.5 * 100 / c
    return scenes.consolidation(Kw=Kw, k=k, end=end, every=end / 10, rise=end / 4)


def permeability(bar=0.01):
    """Time to reach 3/4 of consolidation with the settlement within 1 % of its end all the way."""
    found = []
    for Kw in (22e6, 2.2e9):
        for power in range(7, 19):
            k = 10.0**-power
            scene = sweep_scene(Kw, k)
            want = {"u(H)": settlement(scene, k, Kw)}
            for kind in integrators():
                found.append(cheapest(scene, kind, want, bar) | {"k": k, "Kw": Kw, "end": scene.end})
                print("  ", found[-1], flush=True)
    return found


def cheapest(scene, kind, want, bar, bursts=60):
    """The longest step of a row of settings that keeps the bar; explicit ones whose end is far are extrapolated."""
    if kind in EXPLICIT:
        run, cpu = Clock.of(scene, *adaptive(kind), "-stepper_max_steps", 256 * bursts)
        said = re.search(r"(finished|stopped) at t = (\S+ \w+)", run.output)
        if run.code or not said:
            return {"kind": kind, "code": run.code, "why": why(run)}
        steps, off = steps_of(run), None
        t = scene.end if said[1] == "finished" else seconds(said[2])
        if t < scene.end and cpu * scene.end / t < 15.0:
            run, cpu = Clock.of(scene, *adaptive(kind))
            steps, t = steps_of(run), scene.end
        if t == scene.end:
            off = settled(scene, run, want)
        return {"kind": kind, "code": 0, "cpu": cpu * scene.end / t, "steps": round(steps * scene.end / t), "off": off, "extrapolated": off is None}
    for n in (1, 2, 5, 10, 20, 40):
        run, cpu = Clock.of(scene, *fixed(kind, scene.every / n))
        off = settled(scene, run, want) if run.code == 0 else math.inf
        if off <= bar:
            break
    return {"kind": kind, "code": run.code, "cpu": cpu, "steps": steps_of(run), "off": off, "extrapolated": False}


def settled(scene, run, want):
    return float(np.max(np.abs(scene.curves(run)["u(H)"] - want["u(H)"])) / np.max(np.abs(want["u(H)"])))


HEAD = "-mat_sand_"
TERMS = (  # what is left out, options; on the dissociating block
    ("nothing", ()),
    ("inertia (`inertia: no`)", ("-inertia", "no")),
    ("solid (`fields: thc`)", ("-fields", "thc", "-inertia", "no", f"{HEAD}elasticity_E0", "rigid", "-boundaries", "base,left,top,well,above")),
    ("reaction (`kinetics_active: no`)", (f"{HEAD}kinetics_active", "no")),
    ("reaction and heat (`fields: hmc`)", (f"{HEAD}kinetics_active", "no", "-fields", "hmc")),
    ("gas (`fields: thm`)", ("-fields", "thm", f"{HEAD}kinetics_active", "no", "-region_block_Sw", 0.7, "-region_block_Sg", 0)),
    ("hydrate's share of stiffness (`Eh: 0`)", (f"{HEAD}elasticity_Eh", "0 Pa")),
    ("permeability's change (`hydrate_law`, `porosity_law: none`)", (
        f"{HEAD}permeability_hydrate_law", "none", f"{HEAD}permeability_porosity_law", "none", f"{HEAD}permeability_k0", "3.43e-12 m^2")),
    ("conduction of heat", tuple(w for p in ("solid", "hydrate", "water", "gas") for w in (f"{HEAD}{p}_conductivity", "0 W/(m K)"))),
    ("capillary pressure (`p0: 10 Pa`)", (f"{HEAD}retention_p0", "10 Pa")),
    ("ghost penalty", ("-stabilisation_ghost_penalty", 0)),
)  # fmt: skip


def terms():
    scene, found, base = scenes.BLOCK, [], {}
    for kind in (SDIRK2, "hybrid") if "hybrid" in integrators() else (SDIRK2,):
        for name, options in TERMS:
            if kind == "hybrid" and ("-inertia" in options or name == "ghost penalty"):
                continue  # it lives by inertia, and has none of it
            here = replace(scene, case=select(scene.case)) if "thc" in options else scene  # without the load
            run, cpu = Clock.of(here, *adaptive(kind), *options)
            record = {"kind": kind, "left out": name, "cpu": cpu, "code": run.code, "why": why(run) if run.code else ""}
            if run.code == 0:
                have = {k: (p, c) for k, (p, c) in scene.watched.items() if f"{p}.{c}" in run.probes}
                curves = {k: run.at(p, c, scene.times()) for k, (p, c) in have.items()}
                base.setdefault(kind, curves)
                record.update(steps=steps_of(run), change=apart(curves, {k: base[kind][k] for k in curves}))
            found.append(record)
            print("  ", record, flush=True)
    return found


def ringing(run, load):
    """Root mean square of what a particle's pressure differs from the mean of its neighbours along the column, over the load."""
    particles = run.snapshots()[-1][1]
    x, y = particles["position"].T
    row = np.flatnonzero(np.abs(y - np.min(y)) < 1e-9)
    p = particles["p_w"][row[np.argsort(x[row])], 0]
    return float(np.sqrt(np.mean((p[1:-1] - 0.5 * (p[2:] + p[:-2])) ** 2)) / load)


def basis():
    """Consolidation under a load that squeezes the column by 5 %, so that particles cross cells."""
    scene = scenes.consolidation(load=1e6, cells=(26, 1))
    found = []
    for kind in (SDIRK2, *[k for k in integrators() if k == "hybrid"]):
        step = adaptive(kind) if kind in EXPLICIT else fixed(kind, scene.every / 10)
        fine = scene.curves(scene.run(*step, cells=(104, 1)))
        for name in ("linear", "ugimp", "cpgimp"):
            for n in (2, 3, 4):
                options = (*step, "-basis", name, "-region_column_particles_per_cell", f"{n},{n}", "-output_times", f"{scene.end!r} s")
                run, cpu = Clock.of(scene, *options)
                record = {"kind": kind, "basis": name, "particles": n * n, "cpu": cpu, "code": run.code, "why": why(run) if run.code else ""}
                if run.code == 0:
                    record.update(error=max(apart(scene.curves(run), fine).values()), noise=ringing(run, scene.load), steps=steps_of(run))
                found.append(record)
                print("  ", record, flush=True)
    return found


def choice():
    """What `auto` forecasts and takes, from one step of each scene."""
    rows = [("wave", {"name": name}, scene) for name, scene in WAVES.items()] + [("consolidation", {}, scenes.consolidation())]
    rows += [("bp2", {"case": case}, scenes.bp2(case, every=100.0)) for case in (1, 2)] + [("block", {}, scenes.BLOCK)]
    rows += [("permeability", {"Kw": Kw, "k": 10.0**-power}, sweep_scene(Kw, 10.0**-power)) for Kw in (22e6, 2.2e9) for power in range(7, 19)]
    found = []
    for part, which, scene in rows:
        run = scene.run(*adaptive("auto"), "-stepper_max_steps", 1, exit_code=GIVEN_UP)
        said = re.search(r"forecast: (.*)\n\s*integrator chosen: (\w+)", run.output)
        forecast, chosen = said.groups() if said else ("", why(run))
        found.append({"part": part, "which": which, "scene": scene.name, "forecast": forecast, "chosen": chosen})
        print("  ", found[-1], flush=True)
    return found


def change():
    """A run that `auto` carries from slow to fast and back, against either kind alone; `hybrid` extrapolated where it would take minutes."""
    found, whole = [], None
    for slow in (1, 10, 100):
        t = slow_fast.times(slow)
        exactly = {name: slow_fast.exact(x, q, t, slow) + zero for name, (_, _, x, q, zero) in slow_fast.WATCHED.items()}
        for kind in ("auto", "hybrid", SDIRK2):
            record = {"slow": slow, "kind": kind}
            if kind == "hybrid" and slow > 10:
                record.update(cpu=whole["cpu"] * slow / whole["slow"], steps=round(whole["steps"] * slow / whole["slow"]), extrapolated=True)
            else:
                run, cpu = Clock.of(SlowFast, kind, slow)
                off = [np.max(np.abs(run.at(*slow_fast.WATCHED[name][:2], t) - exactly[name])) / np.ptp(slow_fast.EXACT[name]) for name in exactly]
                record.update(cpu=cpu, steps=steps_of(run), error=max(off), changes=len(changes(run)))
                whole = record if kind == "hybrid" else whole
            found.append(record)
            print("  ", record, flush=True)
    return found


class SlowFast:
    """The scene of verification/auto.py for Clock."""

    @staticmethod
    def run(kind, slow, exit_code=0):
        return timed(slow_fast.CASE, "-stepper_type", kind, *slow_fast.options(26, 1e-3, slow), exit_code=exit_code)


PARTS = {f.__name__: f for f in (wave, consolidation, bp2, block, permeability, terms, basis, choice, change)}


def measure(names):
    data = json.loads(DATA.read_text()) if DATA.is_file() else {}
    for name in names:
        print(name, flush=True)
        data[name] = PARTS[name]()
        data["startup"] = Clock.startup()
        DATA.write_text(json.dumps(data, indent=0, default=float) + "\n")
        dated.measured(DATA)
    return data


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n", 1)[1])
    parser.add_argument("program", nargs="?", default=str(ROOT / "build" / "clathra"))
    parser.add_argument("--only", nargs="*", choices=PARTS)
    parser.add_argument("--page", action="store_true")
    given = parser.parse_args()
    sys.argv[1:] = [str(Path(given.program).resolve())]  # where common.binary() looks
    data = measure([] if given.page else given.only or PARTS)
    from _tradeoff_page import write

    write(data, PAGE, FIGURES)


if __name__ == "__main__":
    main()
