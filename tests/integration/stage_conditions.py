#!/usr/bin/python3
"""Every kind of condition, meter, probe and region state in a case with stages (cases/conditions.yaml, in the plane, about an axis, in
space; sdirk2 and hybrid): stages that name nothing are the case without, to the last digit; with each condition off in the middle
stage the end is that of three runs, each the start of the next; what gave nothing in a whole stage is said; restarts inside and at a
change of stage."""
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import TABLES, different  # noqa: E402
from common import Run, check, check_true, finish, scratch  # noqa: E402

CASE = Path(__file__).resolve().parent / "cases" / "conditions.yaml"
ALL = re.search(r"boundaries: \[(.*)\]", CASE.read_text())[1].split(", ")
HELD = ("base", "wall")  # without them the body would fall
WELLS = ("well", "pump")
METERS = {"right": {"drain", "air"}, "top": {"warmer"}, "west": {"held", "feed"}, "well": {"well"}, "pump": {"pump"}}  # what each counts
NEWTON = ("-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9")
INTEGRATORS = {"sdirk2": ("-stepper_type", "sdirk2", *NEWTON), "hybrid": ("-stepper_type", "hybrid", "-stepper_dt", "0.25 ms")}
ENDS = ("3 ms", "6 ms", "9 ms")
STAGES = ("-stages", "first,middle,last", *(word for name, end in zip(("first", "middle", "last"), ENDS) for word in (f"-stage_{name}_end", end)))


def in_space():
    """The case, 0.4 m thick: places have a third coordinate; a part of a side is told by the region whose side it is."""
    text = CASE.read_text().replace("cells: [5, 5]", "cells: [5, 5, 2]").replace("-9.81 m/s^2]", "-9.81 m/s^2, 0 m/s^2]")
    text = re.sub(r"(lower|at): \[(\S+ m), (\S+ m)\]", r"\1: [\2, \3, 0 m]", text)
    text = re.sub(r"upper: \[(\S+ m), (\S+ m)\]", r"upper: [\1, \2, 0.4 m]", text)
    text = re.sub(r"(type: well, at: \[(\S+ m, \S+ m), 0 m\])", r"\1, end: [\2, 0.4 m]", text)
    text = re.sub(r"side: (\w+)((?:, (?:from|to): \S+ m)+)", r"side: \1", text)
    path = scratch() / "conditions_3d.yaml"
    path.write_text(text)
    return path


SPACE = in_space()
GEOMETRIES = {
    "plane": (CASE, (), ALL),
    "axis": (CASE, ("-geometry", "axisymmetric"), [b for b in ALL if b not in ("wall", "held", "feed", "well", "pump")]),
    "space": (SPACE, (), ALL),
}


def go(geometry, integrator, *options, acting=None, **keywords):
    case, more, known = GEOMETRIES[geometry]
    acting = [b for b in known if acting is None or b in acting]
    meters = [m for m in METERS if m not in WELLS or m in acting]
    return Run.of_case(case, "-quiet", *more, *INTEGRATORS[integrator], "-boundaries", ",".join(acting), "-meters", ",".join(meters), *options, **keywords)


def apart(a, b):
    """The largest difference of the particles at the end, of what differs between particles and from the start."""
    (_, x), (_, y), (_, first) = a.snapshots()[-1], b.snapshots()[-1], a.snapshots()[0]
    worst = 0.0
    for name in ("p_w", "p_g", "T", "S_w", "position", "stress"):
        scale = max(np.ptp(x[name]), np.max(np.abs(x[name] - first[name])), 1e-300)
        worst = max(worst, np.max(np.abs(x[name] - y[name])) / scale)
    return worst


def chain(geometry, integrator, off, known):
    """Three runs without stages, each from the particles of the one before; the middle one without `off`."""
    start, run = (), None
    for k in range(3):
        acting = [b for b in known if b != "plate" and (k != 1 or b not in off)]  # a plate counts from the run's start
        run = go(geometry, integrator, "-time_end", "3 ms", "-output_times", "3 ms", *start, acting=acting)
        start = ("-restart_as_initial", run.out / "checkpoint.h5")
    return run


def tables_apart(a, b):
    """Columns of the tables that differ; times are sums of steps, counted from another begin."""
    return [f"{t}:{c}" for t in TABLES for c in a.csv(t)
            if c != "stage" and not (np.allclose if c in ("time_s", "dt_s") else np.array_equal)(a.csv(t)[c], b.csv(t)[c])]  # fmt: skip


def still(run):
    """{stage: what the run says that nothing came of}"""
    return {stage: words.split(", ") for stage, words in re.findall(r"note: stage (\w+): from .* nothing at all came of: (.*)", run.output)}


def uncounted(known, off=()):
    """The same, of meters: those that nothing feeds which acts."""
    acting = {"first": set(known), "middle": set(known) - set(off), "last": set(known)}
    found = {stage: [f"meter {m}" for m, fed in METERS.items() if (m not in WELLS or m in known) and not fed & on] for stage, on in acting.items()}
    return {stage: names for stage, names in found.items() if names}


# ----------------------------------------------------- stages that name nothing; conditions that pause in the middle one
for geometry, (_, _, known) in GEOMETRIES.items():
    wells = [b for b in known if b in WELLS]
    for integrator in ("sdirk2",) if geometry == "axis" else INTEGRATORS:
        where = f"{geometry}, {integrator}"
        plain, staged = go(geometry, integrator), go(geometry, integrator, *STAGES)
        without = go(geometry, integrator, acting=[b for b in known if b != "plate"])
        names = tables_apart(plain, staged)
        check_true(f"{where}: stages that name nothing, the tables", not names, ", ".join(names[:5]))
        check(f"{where}: ... the particles", apart(plain, staged), 0.0)
        rates = [staged.csv("meters.csv")[f"{name}.gas_kg_s"][1:] for name in wells]
        check_true(f"{where}: both wells give all the time, and nothing is still", all(np.all(r > 0) for r in rates) and still(staged) == uncounted(known), str(still(staged)))
        paused = [b for b in known if b not in HELD and b != "plate"]
        for off in [[b] for b in paused] if (geometry, integrator) == ("plane", "sdirk2") else [paused]:
            run = go(geometry, integrator, *STAGES, "-stage_middle_boundaries_off", ",".join(off), acting=[b for b in known if b != "plate"])
            what = f"{where}: without {off[0] if len(off) == 1 else 'all but plate and supports'} in the middle stage"
            check(f"{what}, three runs in a row", apart(run, chain(geometry, integrator, off, known)), 1e-8)
            check_true(f"{what}: it makes a difference", apart(run, without) > 1e-9)
            meters = run.csv("meters.csv")
            middle = (meters["time_s"] > 0.0031) & (meters["time_s"] < 0.0061)
            ok = all(np.all((meters[f"{name}.gas_kg_s"][1:] == 0) == middle[1:]) for name in off if name in WELLS)
            check_true(f"{what}: a well that is off gives nothing", ok)
            check_true(f"{what}: meters that count nothing are said", still(run) == uncounted([b for b in known if b != "plate"], off), str(still(run)))
    run = go(geometry, "sdirk2", *STAGES, "-stage_middle_boundaries_off", "plate")
    force, time = run.csv("meters.csv")["plate.force_N"][1:], run.csv("meters.csv")["time_s"][1:]
    check_true(f"{geometry}: a plate bears something in the first and the last stage alone", np.all((force != 0) == ((time < 0.0031) | (time > 0.0061))), str(force))

# ------------------------------------------------------------------------------------------- what gives nothing is said
run = go("plane", "sdirk2", *STAGES, "-stage_last_boundaries_off", "pump", "-bc_air_alpha", "0 W/(m^2 K)", "-bc_source_power", "0 W/m^3")
check_true("convection without exchange is said in every stage, a source of no power in none, the meter of a well that is off in its stage",
           still(run) == {"first": ["convection air"], "middle": ["convection air"], "last": ["convection air", "meter pump"]}, str(still(run)))  # fmt: skip
once = go("plane", "sdirk2", "-bc_air_alpha", "0 W/(m^2 K)")
check_true("... and at the end of a run without stages", re.search(r"note: from 0 s to 0\.009 s nothing at all came of: convection air\n", once.output), once.output[-600:])

# ------------------------------------------------------------------------------- restarts inside and at a change of stage
OFF = ("-stage_middle_boundaries_off", "well,drain,source,heater", "-checkpoint_every", "0.5 ms", "-bc_air_alpha", "0 W/(m^2 K)")
for integrator, rows in {"sdirk2": (4, 6, 9, 12, 15), "hybrid": (4, 6, 9)}.items():  # of the balance
    straight = go("plane", integrator, *STAGES, *OFF)
    for steps in (straight.steps(k - 1) for k in rows):
        out = scratch() / "out"
        go("plane", integrator, *STAGES, *OFF, "-stepper_max_steps", steps, out=out)
        rest = go("plane", integrator, *STAGES, *OFF, "-restart", out / "checkpoint.h5", out=out)
        names = different(straight.out, rest.out)
        check_true(f"{integrator}: cut after {steps} steps: the same bit for bit", not names, ", ".join(names[:5]))
finish()
