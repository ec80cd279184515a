#!/usr/bin/env python3
"""docs/extending.md, followed: its blocks applied to a copy of the tree, built, and what they add put to work.

Usage: extending.py CLATHRA   (the program as it is, to compare with)
"""
import json
import re
import shlex
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, binary, check, check_true, finish, launch, run, scratch  # noqa: E402

PAGE = ROOT / "docs" / "extending.md"
LINKED = r"\]\(\.\./(tests/integration/cases/\w+\.c)\), which goes to `([\w/]+)`"  # whole files of an example
SCENE = """
title: a plate that radiates
fields: [heat]
grid: {lower: [0 m, 0 m], upper: [0.1 m, 0.01 m], cells: [10, 1]}
materials: [metal]
mat: {metal: {porosity: 0.01, solid: {density: 7800 kg/m^3, heat_capacity: 500 J/(kg K), conductivity: 5000 W/(m K)}}}
regions: [plate]
region: {plate: {lower: [0 m, 0 m], upper: [0.1 m, 0.01 m], material: metal, temperature: 500 degC}}
boundaries: [sky]
bc: {sky: {type: radiation, side: right, emissivity: 0.8, ambient: -273 degC}}
time: {end: 20000 s}
stepper: {tol: 1e-5}
probes: [middle]
probe: {middle: {at: [0.05 m, 0.005 m]}}
"""

CLAY = """
title: clay compressed from all sides, about an axis
fields: [solid]
geometry: axisymmetric
inertia: no
grid: {lower: [0 m, 0 m], upper: [3 m, 1.5 m], cells: [6, 3]}
materials: [clay]
mat:
  clay:
    porosity: 0.5
    solid: {density: 2700 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}
    permeability: {k0: 1e-12 m^2, hydrate_law: none}
    elasticity: {E0: 20 MPa, nu: 0.3}
    plasticity: {law: cam_clay, M: 1.2, lambda: 0.05, preconsolidation: 150 kPa}
regions: [body]
region: {body: {lower: [0 m, 0 m], upper: [1 m, 1 m], material: clay, particles_per_cell: [2, 2], stress: [-100 kPa, -100 kPa, -100 kPa, 0 Pa, 0 Pa, 0 Pa]}}
boundaries: [base, side, top]
bc:
  base: {type: roller, axis: y, position: 0 m}
  side: {type: traction, side: right, normal: {ramp: [100 kPa, 300 kPa, 0 s, 1 s]}}
  top: {type: traction, side: top, normal: {ramp: [100 kPa, 300 kPa, 0 s, 1 s]}}
time: {end: 1 s}
stepper: {type: euler, adapt: no, dt: 0.1 s}
output: {probe_every: 0 s, times: [1 s]}
probes: [m]
probe: {m: {at: [0.5 m, 0.5 m]}}
"""


GAS = """
title: gas in a closed cell, warmed
fields: [water, gas, heat]
grid: {lower: [0 m, 0 m], upper: [0.04 m, 0.04 m], cells: [4, 4]}
materials: [sand]
mat:
  sand:
    porosity: 0.3
    solid: {density: 2600 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}
    water: {bulk_modulus: incompressible}
    gas: {eos: virial}
    retention: {p0: 1 kPa, m: 0.5, Swr: 0.1, Sgr: 0.05}
    relperm: {nw: 2, ng: 2}
    permeability: {k0: 1e-16 m^2, hydrate_law: none}
regions: [cell]
region: {cell: {lower: [0 m, 0 m], upper: [0.04 m, 0.04 m], material: sand, pressure: 3 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4}}
boundaries: [bath]
bc: {bath: {type: region_temperature, region: cell, temperature: {ramp: [4 degC, 24 degC, 0 s, 1 s]}}}
time: {end: 1 s}
stepper: {adapt: no, dt: 0.01 s}
probes: [m]
probe: {m: {at: [0.02 m, 0.02 m]}}
output: {times: [0 s, 1 s]}
"""


def blocks():
    """[(file, [(old lines, new lines)])] of the page's diff blocks."""
    found = []
    for text in re.findall(r"^```diff\n(.*?)^```", PAGE.read_text(), re.M | re.S):
        head, *hunks = re.split(r"^@@\n", text, flags=re.M)
        pairs = []
        for hunk in hunks:
            lines = [line[:1] + line[1:] if line else " " for line in hunk.splitlines()]
            pairs.append(([l[1:] for l in lines if l[0] in " -"], [l[1:] for l in lines if l[0] in " +"], lines))
        found.append((head.split()[1], pairs))
    return found


def same(line, pattern):
    """A line of the page may be the beginning of the line in the tree, and spaces do not count."""
    squeeze = lambda s: re.sub(r"\s+", "", s).rstrip("\\")
    return squeeze(line).startswith(squeeze(pattern)) if pattern.strip() else not line.strip()


def find(lines, old, where):
    at = [k for k in range(len(lines) - len(old) + 1) if all(same(lines[k + j], old[j]) for j in range(len(old)))]
    if len(at) != 1:
        sys.exit(f"{where}: {len(at)} places look like\n" + "\n".join(old))
    return at[0]


def apply(tree):
    """Puts every block in its place; the lines of a hunk that only show where stay as they are in the tree."""
    count = 0
    for file, folder in re.findall(LINKED, PAGE.read_text()):
        shutil.copy(ROOT / file, tree / folder)
    for name, pairs in blocks():
        path = tree / name
        lines = path.read_text().splitlines() if path.exists() else []
        for old, new, hunk in pairs:
            at = find(lines, old, name) if old else len(lines)
            result, k = [], at
            for line in hunk:
                if line[0] == "+":
                    macro = "\\" if result and result[-1].endswith("\\") or lines[at : at + 1] and lines[at].endswith("\\") else ""
                    result.append(line[1:] + (" " + macro if macro else ""))
                    continue
                if line[0] == " ":
                    result.append(lines[k])
                k += 1
            lines[at : at + len(old)] = result
            count += 1
        path.write_text("\n".join(lines) + "\n")
    return count


def build(tree):
    """The program of a tree; headers of PETSc read once and no symbols for a debugger take two thirds of the time."""
    folder, once = tree / "build", tree / "once.cmake"
    once.write_text("cmake_language(DEFER CALL target_precompile_headers clathra_core PRIVATE <petscsnes.h> <petscdmda.h> <petscsf.h>)\n")
    for command in (["cmake", "-S", tree, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_C_FLAGS_DEBUG=-O0", "-DCLATHRA_TESTS=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
                     f"-DCMAKE_PROJECT_INCLUDE={once}"],
                    ["cmake", "--build", folder, "--target", "clathra"]):  # fmt: skip
        done = subprocess.run(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            sys.exit("\n".join(done.stdout.splitlines()[-30:]))
    return folder / "clathra"


def in_space(tree):
    """What the compiler says of the files that the page changes, as those of the program of three axes."""
    units = [u for u in json.loads((tree / "build" / "compile_commands.json").read_text()) if "-DCL_DIM=3" in u["command"]]
    changed = {str(tree / name) for name, _ in blocks() if name.endswith(".c")} | {str(tree / folder / Path(file).name) for file, folder in re.findall(LINKED, PAGE.read_text())}
    said = [subprocess.run(shlex.split(u["command"].split(" -o ")[0]) + ["-o", "/dev/null", "-c", u["file"]], cwd=u["directory"], capture_output=True, text=True).stderr
            for u in units if u["file"] in changed]  # fmt: skip
    return len(said), "".join(said)


def costs():
    """{example: (files, lines)} as the page's table says, and as its blocks are."""
    page = PAGE.read_text()
    said = {row[0]: (int(row[1]), int(row[2])) for row in re.findall(r"^\| (an? [^|]*?) \| (\d+)[^|]* \| (\d+)[^|]* \|$", page, re.M)}
    counted = []
    for section in re.split(r"^## ", page, flags=re.M)[1:]:
        found = re.findall(r"^```diff\n(.*?)^```", section, re.M | re.S)
        linked = [(ROOT / file).read_text() for file, _ in re.findall(LINKED, section)]
        counted.append((len({b.split()[1] for b in found}) + len(linked),
                        sum(len(re.findall(r"^\+[ \t]*\S", b, re.M)) for b in found) + sum(len(re.findall(r"^[ \t]*\S", b, re.M)) for b in linked)))  # fmt: skip
    return said, [c for c in counted if c[0]]


tree = scratch() / "clathra"
tree.mkdir()
for folder in ("src", "include"):
    shutil.copytree(ROOT / folder, tree / folder)
shutil.copy(ROOT / "CMakeLists.txt", tree)
check_true("every block finds its place", apply(tree) > 15)
said, counted = costs()
check_true("the table of costs is what the blocks are", list(said.values()) == counted, f"{said} {counted}")
for name, row, more in ( # a variable of more components than any other
    ("include/clathra/particles.h", '"hydrate saturation")', ' X(P_WIDE, HAS_ALL, "wide", 9, "-", "")'),
    ("src/particles/initial.c", "Set(P, p, P_SW, r->Sw);", " for (int k = 0; k < 9; k++) Set(P, p, P_WIDE + k, (k + 1) * x[0]);")):  # fmt: skip
    text = (tree / name).read_text()
    (tree / name).write_text(text.replace(row, row + more, 1))
extended = build(tree)
compiled, complaints = in_space(tree)
check_true("the files of the program of three axes compile without a warning", compiled > 10 and not complaints, f"{compiled}\n{complaints[:2000]}")

BP2 = [ROOT / "cases" / "bp2", "-mat_sediment_kinetics_active", "no", "-time_end", "100 s", "-output_times", "100 s", "-stepper_adapt", "no"]

# a law: k falls faster than with Kozeny and Carman's (phi^1.5 at first order), so less water leaves
plain = run(binary(), *BP2, "-stepper_type", "euler", "-stepper_dt", "5 s")
cubic = run(extended, *BP2, "-stepper_type", "euler", "-stepper_dt", "5 s", "-mat_sediment_permeability_porosity_law", "cubic")
ratio = cubic.balance["water_out_kg"][-1] / plain.balance["water_out_kg"][-1]
check("law: water that left, cubic over Kozeny-Carman", ratio, (0.9, 1.1))
check_true("law: it makes a difference", abs(ratio - 1) > 1e-6, f"{ratio - 1:.2e}")

# ... and in hybrid's loops over arrays: from phi = 1.5 phi_0 on it is the constant 1.5^3 k_0, as long as porosity hardly changes
SHORT = (*BP2[:3], "-time_end", "0.02 s", "-output_times", "0.02 s", "-stepper_type", "hybrid")
cubic_hybrid = run(extended, *SHORT, "-mat_sediment_permeability_porosity_law", "cubic", "-mat_sediment_permeability_phi0", "0.1")
constant = run(extended, *SHORT, "-mat_sediment_permeability_porosity_law", "none", "-mat_sediment_permeability_k0", f"{1.5**3 * 1.53e-15} m^2")
ratio = cubic_hybrid.balance["water_out_kg"][-1] / constant.balance["water_out_kg"][-1]
check("law, hybrid: water that left, cubic from 1.5 phi_0 on over a constant 1.5^3 k_0", ratio, (0.9999, 1.0001))

# an equation of state: in a closed cell of incompressible water the density of the gas stays
case = tree / "gas.yaml"
case.write_text(GAS)
for kind, dt, bar in (("sdirk2", "0.01 s", 1e-9), ("hybrid", "0.001 s", 1e-5)):
    gas = run(extended, case, "-stepper_type", kind, "-stepper_dt", dt)
    first, last = gas.snapshot(0.0), gas.snapshot(1.0)
    rho = (first["mass_gas"] / first["volume"]).mean() / (0.3 * 0.4)
    p = [rho * 8.314 * (T + 273.15) / (0.016 + rho * 5e-5) for T in (4.0, 24.0)]
    check(f"equation of state, {kind}: gas of the initial state", abs(first["p_g"].mean() / p[0] - 1), 1e-9)
    check(f"equation of state, {kind}: rise of p_g when warmed, relative", np.max(np.abs((last["p_g"] - first["p_g"]) / (p[1] - p[0]) - 1)), bar)

# a history variable: while the load only grows the highest pressure is the pressure; once it is gone both kinds of integrator remember
last = cubic.snapshot(100.0)
check("variable: p_peak against p_w, relative", np.max(np.abs(last["p_peak"] / last["p_w"] - 1)), 1e-12)
GONE = ("-bc_load_normal_table", "0 s, 3.25 MPa, 0.01 s, 5 MPa, 0.02 s, 3.25 MPa, 1 s, 3.25 MPa", "-time_end", "0.05 s", "-output_times", "0.05 s")
peak = {}
for kind, options in (("sdirk2", ("-stepper_dt", "2.5e-3 s")), ("hybrid", ("-stepper_adapt", "yes"))):
    last = run(extended, *BP2, *GONE, "-stepper_type", kind, *options).snapshot(0.05)
    peak[kind] = last["p_peak"]
    check_true(f"variable: {kind} remembers what is gone", np.max(peak[kind]) > 1.2 * np.max(last["p_w"]) and np.all(peak[kind] >= last["p_w"]),
               f"{np.max(peak[kind]):.4g} against {np.max(last['p_w']):.4g} Pa")  # fmt: skip
check("variable: the same in hybrid as in sdirk2, relative", np.max(np.abs(peak["hybrid"] / peak["sdirk2"] - 1)), 0.05)

# nine components through store, migration, snapshot and checkpoint; PETSc looks for writes beyond the ends of arrays
WIDE = (*BP2, "-stepper_type", "euler", "-stepper_dt", "10 s", "-malloc_debug")
wide = run(extended, *WIDE).snapshot(100.0)
check_true("variable of nine components: its values", wide["wide"].shape[1] == 9 and np.all(wide["wide"] == wide["initial_position"][:, :1] * np.arange(1, 10)))
half = run(extended, *WIDE, "-stepper_max_steps", "4")
again = run(extended, *WIDE, "-restart", half.out / "checkpoint.h5", out=half.out).snapshot(100.0)
apart = run(extended, *WIDE, ranks=2).snapshot(100.0)
check_true("variable of nine components: restart and two ranks", np.array_equal(wide["wide"], again["wide"]) and np.array_equal(wide["wide"], apart["wide"]))

# a boundary condition: a thin black body cools as dT/dt = -eps sigma T^4/(rho c L), which has a closed form
case = tree / "plate.yaml"
case.write_text(SCENE)
rate = 0.8 * 5.670374e-8 / (0.99 * 7800 * 500 * 0.1)
for kind, options in (("sdirk2", ()), ("hybrid", ("-stepper_type", "hybrid", "-grid_cells", "5,1", "-time_end", "1000 s"))):
    plate = run(extended, case, *options)
    t, T = plate.time, plate.probe("middle")["T_degC"] + 273.15
    exact = (773.15**-3 + 3 * rate * t) ** (-1 / 3)
    check(f"condition: T of a plate that radiates into space, {kind} (K)", np.max(np.abs(T - exact)), 0.5)
    if kind == "sdirk2":  # an integrator: order by self-convergence, control of its error, and under auto
        fixed = ("-stepper_adapt", "no", "-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9")
        for name, bar in (("sdirk2", (1.8, 2.3)), ("sdirk3", (2.7, 3.3))):
            ends = [run(extended, case, *fixed, "-stepper_type", name, "-stepper_dt", f"{dt} s").probe("middle")["T_degC"][-1] for dt in (1000, 500, 250)]
            check(f"integrator: order in time of {name}", np.log2(abs(np.diff(ends)[0] / np.diff(ends)[1])), bar)
        third = run(extended, case, "-stepper_type", "auto")
        T3 = third.probe("middle")["T_degC"] + 273.15
        check("integrator: T of the plate, steps by its error (K)", np.max(np.abs(T3 - (773.15**-3 + 3 * rate * third.time) ** (-1 / 3))), 0.5)
        check_true("integrator: auto takes it in turn with hybrid", "integrator chosen: sdirk3" in third.output and "  sdirk3 from" in third.output)
        two, three = [run(extended, *BP2, "-stepper_type", name, "-stepper_dt", "10 s") for name in ("sdirk2", "sdirk3")]
        ends = [r.snapshot(100.0) for r in (two, three)]
        check("integrator: p and u of BP2 against sdirk2, relative", max(np.max(np.abs(ends[1][q] - ends[0][q])) / np.max(np.abs(ends[0][q])) for q in ("p", "displacement")), 1e-3)
    # a finding: said once where it is found, and kept for the summary
    told = T.min() < 773.15 - 100
    said = [text.count("clathra: note: particles cooled by") for text in (plate.output, (plate.out / "summary.txt").read_text(), (plate.out / "log.txt").read_text())]
    check_true(f"finding: cooled by more than 100 K, {kind}: {told}", said == [told] * 3 and told == (kind == "sdirk2"), said)
half = launch(extended, case, "-stepper_max_steps", "5", out=tree / "half")
other = launch(extended, case, "-bc_sky_emissivity", "0.7", "-restart", tree / "half" / "checkpoint.h5", out=tree / "half")
check_true("condition: a restart with another value of its key is refused", other.returncode == 2 and "another case" in other.stdout, other.stdout[-300:])

# a law of the skeleton, with no hand on store, files or probes
K, LAMBDA, SLOPE = 20e6 / 1.2, 0.05, 1.2
case = tree / "clay.yaml"
case.write_text(CLAY)
clay = run(extended, case)
last, probe = clay.snapshot(1.0), clay.probe("m")
check("clay: all-round compression, volume in log strain", np.max(np.abs(last["log_J"] / -(200e3 / K + LAMBDA * np.log(2.0)) - 1)), 1e-6)
check("clay: p_c is the pressure", np.max(np.abs(last["p_c"] / 300e3 - 1)), 1e-6)
check("clay: p_c of a probe before it yields is the start's", abs(probe["p_c_Pa"][1] / 150e3 - 1), 1e-12)
check_true("clay: p_c in XDMF and checkpoint", "p_c" in (clay.out / "particles.xdmf").read_text() and b"p_c" in (clay.out / "checkpoint.h5").read_bytes())
only = run(extended, case, "-output_quantities", "p_c")
check_true("clay: p_c as a quantity of probes", (only.out / "probes.csv").read_text().startswith("time_s,m.p_c_Pa\n"))
check_true("clay: no p_c where no clay is", "p_c" not in two.snapshots()[-1][1])
half = run(extended, case, "-stepper_max_steps", "6")
again = run(extended, case, "-restart", half.out / "checkpoint.h5", out=half.out)
check_true("clay: a restart bit for bit", all(np.array_equal(v, again.snapshot(1.0)[k], equal_nan=True) for k, v in last.items()))
apart = run(extended, case, ranks=2).snapshot(1.0)
check("clay: 2 ranks against 1, p_c", np.max(np.abs(apart["p_c"] / last["p_c"] - 1)), 1e-9)
bad = launch(extended, case, "-mat_clay_plasticity_lambda", "0", out=tree / "local")
check_true("clay: a bad parameter is refused with its range", bad.returncode == 2 and "mat_clay_plasticity_lambda" in bad.stdout and "(0,10]" in bad.stdout)

# undrained: e = -dp/K, so p_c and q are functions of p, whatever the shape of the test
WET = CLAY.replace("[solid]", "[solid, water]").replace("150 kPa", "200 kPa").replace("-100 kPa", "-200 kPa").replace("material: clay, part", "material: clay, pressure: 1 MPa, part")
WET = WET[: WET.index("  side:")] + """  side: {type: traction, side: right, normal: 1.2 MPa}
  top: {type: plate, side: top, velocity: {ramp: [0 m/s, -0.1 m/s, 0 s, 0.1 s]}}
""" + WET[WET.index("time:") :]
PLANE = WET.replace("axisymmetric", "plane").replace("boundaries: [", "boundaries: [left, ").replace("bc:\n", "bc:\n  left: {type: roller, axis: x, position: 0 m}\n")
for name, text, bar, options in (
    ("sdirk2, about the axis", WET, 1e-3, ("-stepper_type", "sdirk2", "-stepper_dt", "0.01 s", "-mat_clay_water_bulk_modulus", "incompressible")),
    ("hybrid, in the plane", PLANE, 0.02, ("-inertia", "yes", "-stepper_type", "hybrid", "-stepper_adapt", "yes", "-stepper_damping", "0.2")),
):
    case.write_text(text)
    probe = run(extended, case, *options).probe("m")
    p, q = probe["p_eff_Pa"], probe["q_Pa"]
    pc = 200e3 * np.exp(-(p - 200e3) / (K * LAMBDA))
    check(f"clay, undrained, {name}: p_c", np.max(np.abs(probe["p_c_Pa"] / pc - 1)), bar)
    check(f"clay, undrained, {name}: stress path", np.max(np.abs(q - SLOPE * np.sqrt(np.maximum(p * (pc - p), 0.0)))) / 130e3, bar)
    check(f"clay, undrained, {name}: q/p at the end over M", q[-1] / p[-1] / SLOPE, (1 - bar, 1 + bar))
finish()
