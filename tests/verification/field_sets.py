#!/usr/bin/env python3
"""A scene gives the same with and without a field that is superfluous in it.

Section 4.1, and what leaving it out saves.

A field is superfluous where it is identically constant: the temperature of a body that is everywhere as warm, without
reaction; the skeleton of a body that cannot move.  Fixed steps and tight tolerances leave only round-off.
"""
import re
import subprocess
import sys
from pathlib import Path

import numpy as np

from common import CASES, Run, binary, check, environment, finish, judge, record, scratch, table

SCENE = Path(__file__).parent / "cases" / "field_sets.yaml"
WORDS = {"t": ("heat",), "h": ("water",), "m": ("solid",), "c": ("gas",)}
TIGHT = ("-quiet", "-newton_tol_residual", 1e-11, "-newton_tol_update", 1e-9, "-ksp_rtol", 1e-10, "-stepper_adapt", "no")  # fmt: skip
GEOMETRY = {"plane": (), "about an axis": ("-geometry", "axisymmetric")}
BAR = 1e-8


def select(case, *keep):
    """Path of a copy of a case without the lines marked "only x" for any x not in `keep`."""
    lines = []
    for line in Path(case).read_text().splitlines():
        tag = re.search(r"# only (\w+)$", line)
        if tag is None or tag[1] in keep:
            lines.append(line)
    path = scratch() / "case.yaml"
    path.write_text("\n".join(lines) + "\n")
    return path


def scene(fields, *keep):
    """Path of the scene's case for a set's name, with the lines of `keep`."""
    words = {w for letter in fields for w in WORDS[letter]}
    return select(SCENE, *keep, *words, *(() if "solid" in words else ("rigid",)))


def difference(a, b, leave_out=()):
    """Largest difference of the particles' common variables over the size of their kind, with its name; and how many."""
    worst, names = (0.0, "-"), 0
    (_, x), (_, y) = a.snapshots()[-1], b.snapshots()[-1]
    for name in sorted(set(x) & set(y)):
        size = np.max(np.abs(x[name])) or 1.0
        if name in ("rate_p_w", "rate_p_g", "rate_T", "rate_S_h") or name.startswith(tuple(leave_out)):  # of p_w, p_g, T and S_h: those that both have, over what a step makes of the variable
            continue
        if name.startswith("grad_"):
            size = np.max(np.abs(x[name.removeprefix("grad_")])) / (2 * np.max(x["half_length"]))
        if name.startswith("mixed_"):
            size = np.max(np.abs(x[name.removeprefix("mixed_")])) / (2 * np.max(x["half_length"])) ** 2
        if name in ("v_s", "v_w", "v_g"):
            size = max(np.max(np.abs(s[v])) for _, s in a.snapshots() for v in ("v_s", "v_w", "v_g") if v in s) or 1.0  # over the run: what drains comes to rest
        worst, names = max(worst, (float(np.max(np.abs(x[name] - y[name])) / size), name)), names + 1
    return *worst, names


def pairs():
    """(large set, small set, what makes them equal, lines kept, options of both, options of the large one)."""
    reacting = ("-mat_sand_kinetics_active", "yes")
    stiff = ("-mat_sand_elasticity_E0", "1e15 Pa", "-mat_sand_elasticity_Eh", "0 Pa")  # (23) falls with G
    small = ("-bc_load_normal_ramp", "0 Pa, 100 kPa, 0 s, 50 s", "-bc_side_normal", "10 kPa")  # nothing else carries a dry body
    for geometry, inertia in (("plane", ""), ("about an axis", ", quasi-static")):
        turn, still, where = GEOMETRY[geometry], ("-inertia", "no") if inertia else (), f"{geometry}{inertia}"
        yield "thmc", "hmc", f"uniform T, {where}", ("drained",), (*turn, *still), ()
        yield "thm", "hm", f"uniform T, {where}", ("drained",), (*turn, *still), ()
        yield "tm", "m", f"uniform T, {where}", (), (*turn, *still, *small), ()
        yield "thc", "hc", f"uniform T, {where}", ("drained",), (*turn, *still), ()
        yield "th", "h", f"uniform T, {where}", ("drained",), (*turn, *still), ()
        yield "thmc", "thc", f"held, reacting, {where}", ("held", "warmed"), (*turn, *still, *reacting), stiff


def equality():
    rows, worst = [], {}
    for large, small, what, keep, options, extra in pairs():
        a = Run.of_case(scene(large, *keep), "-fields", large, *TIGHT, *options, *extra)
        b = Run.of_case(scene(small, *keep), "-fields", small, *TIGHT, *options)
        value, where, names = difference(a, b)
        check(f"{large} against {small}, {what}: {names} variables", value, BAR)
        rows.append((large, small, what, value, where))
        key = large, small, what.split(",")[0]
        worst[key] = max(worst.get(key, 0.0), value)
    table(("with", "without", "scene", "difference", "largest in"), rows)
    for (large, small, what), value in worst.items():
        judge("4.1", f"{large} against {small} ({what}), plane and about an axis: largest difference of any variable", value, BAR)


def rigid_limit():
    """A stiffer and stiffer skeleton, drained and reacting, against none: the difference of the state falls as 1/E0.

    Of the state, not of its gradients and of the fluids' velocities, which are a hundred times as sensitive here: near its
    threshold of mobility, that of gas follows the capillary pressure.
    """
    rows, moduli = [], (1e11, 1e12)
    for geometry, turn in GEOMETRY.items():
        options = (*turn, "-quiet", "-stepper_adapt", "no", "-inertia", "no", "-mat_sand_kinetics_active", "yes")
        none = Run.of_case(scene("thc", "drained", "warmed"), "-fields", "thc", *options)
        off = []
        for E0 in moduli:
            stiff = Run.of_case(scene("thmc", "drained", "warmed"), "-fields", "thmc", *options, "-mat_sand_elasticity_Eh", "0 Pa",
                                "-mat_sand_elasticity_E0", f"{E0!r} Pa")  # fmt: skip
            value, where, _ = difference(none, stiff, ("v_", "grad_"))
            off.append(value)
            rows.append((geometry, E0, value, where))
        judge("4.1", f"thmc against thc, drained and reacting, {geometry}: E0 = 1e12 Pa", off[1], 1e-4)
        judge("4.1", f"the same, {geometry}: over the difference for E0 = 1e11 Pa", off[1] / off[0], (0.09, 0.11))
    table(("geometry", "E0 (Pa)", "difference", "largest in"), rows)


def bp2():
    options = (*TIGHT, "-stepper_dt", "20 s", "-time_end", "600 s", "-output_times", "500 s", "-mat_sediment_kinetics_active", "no")
    a, b = (Run.of_case("bp2", "-fields", f, *options) for f in ("thmc", "hmc"))
    auto = Run.of_case("bp2", "-fields", "auto", *options)
    value, where, names = difference(a, b)
    judge("4.1", f"BP2 case 1, thmc against hmc: {names} variables, histories at 500 s ({where})", value, BAR)
    columns = [c for c in b.probes if c in a.probes and not c.endswith(("_y_m", "sxy_Pa"))]  # those are round-off
    value = max(np.max(np.abs(a.probes[c] - b.probes[c])) / (np.max(np.abs(a.probes[c])) or 1) for c in columns)
    judge("4.1", f"BP2 case 1, thmc against hmc: {len(columns)} columns of probes.csv at every step", value, BAR)
    judge("4.1", "BP2 case 1: auto finds hmc, largest difference", difference(auto, b)[0], 0.0)


MEASURE = """
import resource, subprocess, sys
subprocess.run(sys.argv[1:], stdout=subprocess.DEVNULL, check=True)
r = resource.getrusage(resource.RUSAGE_CHILDREN)
print(r.ru_utime, r.ru_maxrss)
"""


def bp2_case1(fields, cells, steps, *options):
    """(what it printed, processor seconds, peak memory in MB) of so many steps of BP2 case 1."""
    out = scratch() / "out"
    command = [binary(), CASES / "bp2", "-fields", fields, "-mat_sediment_kinetics_active", "no", "-grid_cells", cells,
               "-stepper_adapt", "no", "-stepper_dt", "10 s", "-stepper_max_steps", steps, "-output_dir", out, *options]  # fmt: skip
    command = [str(c) for c in command]
    if "-reduced_ksp_view" in options:
        return subprocess.run(command, env=environment(), capture_output=True, text=True, check=True).stdout, 0.0, 0.0
    done = subprocess.run([sys.executable, "-c", MEASURE, *command], env=environment(), capture_output=True, text=True, check=True)
    seconds, memory = map(float, done.stdout.split())
    return "", seconds, memory / 1024


def cost():
    """Unknowns, matrix, time and memory of BP2 case 1 with the full and the smallest set."""
    found = {}
    for fields in ("thmc", "hmc"):
        view = bp2_case1(fields, "52,1", 1, "-reduced_ksp_view")[0]
        n = int(re.search(r"(\d+) unknowns a node", view)[1])
        matrix = re.search(r"rows=(\d+), cols=\d+(?:, bs=\d+)?\s+total: nonzeros=(\d+)", view)
        few, many = (min(bp2_case1(fields, "52,1", n, "-quiet")[1] for _ in range(2)) for n in (5, 45))
        seconds = (many - few) / 40
        empty, full = (bp2_case1(fields, cells, 1, "-quiet")[2] for cells in ("13,1", "208,10"))
        found[fields] = (n, int(matrix[1]), int(matrix[2]), 1e3 * seconds, full - empty)
    names = ("unknowns per node", "rows of the matrix that is factorised", "its entries", "time per step (ms)", "memory above the program's own (MB)")
    table(("BP2 case 1", "thmc", "hmc", "ratio"), [(w, a, b, b / a) for w, a, b in zip(names, *found.values())])
    for what, a, b in list(zip(names, *found.values()))[:3]:
        record("4.1", f"BP2 case 1, {what}: hmc over thmc", "-", f"{b} / {a} = {b / a:.2f}", True)
    time, memory = (b / a for a, b in list(zip(*found.values()))[3:])
    record("4.1", "BP2 case 1, 52 x 1 cells, processor time per step: hmc over thmc", "-", time, True)
    judge("4.1", "BP2 case 1, 208 x 10 cells, memory above the program's own: hmc over thmc", memory, 0.95)


def derived():
    """A reaction keeps heat in the set in whatever form it is switched on; a bare option is a yes."""
    for given, unknowns in ((["yes"], 9), (["on"], 9), ([], 9), (["no"], 8)):
        run = Run.of_case("bp2", "-quiet", "-stepper_max_steps", "1", "-mat_sediment_kinetics_active", *given)
        check(f"unknowns of BP2, kinetics_active {' '.join(given) or 'without a word'}", int(re.search(r"(\d+) unknowns a node", run.output)[1]),
              (unknowns, unknowns))  # fmt: skip


if __name__ == "__main__":
    bp2()
    derived()
    equality()
    rigid_limit()
    cost()
    finish()
