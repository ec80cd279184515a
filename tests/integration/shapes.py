#!/usr/bin/python3
"""Bodies that are not boxes: the same on 1, 2 and 4 ranks, from the resolved case, from the command line, across a
restart; a checkpoint of another shape is refused.

The scene, cases/hill.yaml, has every shape and every way to name faces.
"""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run, binary, check, check_true, finish, launch, scratch, table  # noqa: E402

HILL = Path(__file__).resolve().parent / "cases" / "hill.yaml"
TIGHT = ("-quiet", "-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10")
HYBRID = ("-quiet", "-inertia", "yes", "-stepper_type", "hybrid", "-time_end", "0.02 s", "-output_times", "0 s,0.02 s",
          "-stepper_dt", "1e-4 s", "-bc_load_normal_ramp", "0 Pa,100 kPa,0 s,0.02 s", "-checkpoint_every", "0 s")  # fmt: skip
FILES = ("probes.csv", "meters.csv")


def hill(*options, **keywords):
    return Run.of_case(HILL, *options, **keywords)


def same_files(a, b):
    return all((a.out / f).read_bytes() == (b.out / f).read_bytes() for f in FILES)


def worst(a, b):
    """Largest difference over the size of its variable, in particles (sorted by number) and meters."""
    found = 0.0
    for (_, x), (_, y) in zip(a.snapshots(), b.snapshots(), strict=True):
        for name in ("position", "half_length", "volume", "mass_solid", "T", "stress", "displacement", "region"):
            found = max(found, np.max(np.abs(x[name] - y[name])) / (np.max(np.abs(x[name])) or 1.0))
    for name, x in a.csv("meters.csv").items():
        found = max(found, np.max(np.abs(x - b.csv("meters.csv")[name])) / (np.max(np.abs(x)) or 1.0))
    return found


# --- ranks
runs = {n: hill(*TIGHT, ranks=n) for n in (1, 2, 4)}
one = runs[1]
for n in (2, 4):
    check(f"{n} ranks against 1", worst(one, runs[n]), 1e-9)
fast = {n: hill(*HYBRID, ranks=n) for n in (1, 2)}
check("hybrid: 2 ranks against 1", worst(fast[1], fast[2]), 1e-9)

# --- what the scene shows: it was loaded and heated where the case says
end = one.snapshot(3600.0)
check_true("the crest comes down", one.probe("tip")["u_y_m"][-1] < -0.01, f"{one.probe('tip')['u_y_m'][-1]:.3g} m")
heat = {m: -one.csv("meters.csv")[f"{m}.heat_J"][-1] for m in ("slope", "crest", "crown")}
check_true("heat comes through slope and crown alone", heat["slope"] > 0 and heat["crown"] < 0 and heat["crest"] == 0, heat)
boulder = end["T"][end["region"] == 2]
check_true("the boulder stays warm", len(boulder) > 50 and boulder.mean() > 37, f"{boulder.mean():.3g} degC")
check_true("no particle in the tunnel", np.hypot(*(end["position"] - end["displacement"] - [12, 4]).T).min() > 1)

# --- the resolved case, the command line
again = Run.of_case(one.out / "case.yaml", *TIGHT)
check_true("the resolved case runs to the same", same_files(one, again) and worst(one, again) == 0.0)
resolved = [[line for line in (r.out / "case.yaml").read_text().splitlines() if not line.startswith(("#", "output_dir"))] for r in (one, again)]
check_true("... and resolves to itself", resolved[0] == resolved[1] and any("minus: [rock, boulder, lining]" in line for line in resolved[0]))
text = HILL.read_text()
folder = scratch()
plain = folder / "case.yaml"
plain.write_text(text.replace("{polygon: [[3 m, 3.2 m], [6 m, 3 m], [6.5 m, 5 m], [4 m, 5.1 m]],", "{polygon: [[0 m, 0 m], [1 m, 0 m], [1 m, 1 m]],")
                 .replace("minus: [rock, boulder, lining]", "minus: [rock]"))  # fmt: skip
given = Run.of_case(plain, *TIGHT, "-region_boulder_polygon", "[[3 m, 3.2 m], [600 cm,3 m],[6.5 m,5 m] , [4 m, 5.1 m]]",
                    "-region_soil_minus", "rock,boulder,lining")  # fmt: skip
check_true("shapes from the command line", same_files(one, given) and worst(one, given) == 0.0)

# --- restart
out = scratch() / "cut"
half = launch(binary(), HILL, *TIGHT, "-stepper_max_steps", "3", out=out)
rest = launch(binary(), HILL, *TIGHT, "-restart", out / "checkpoint.h5", out=out)
check_true("a restart goes on bit for bit", rest.returncode == 0 and same_files(one, Run(out)), f"codes {half.returncode}, {rest.returncode}")
for key, value in (("-region_lining_circle", "12 m,4 m,1.61 m"), ("-region_soil_below", "[[0 m, 4 m], [8 m, 8 m], [20 m, 8.2 m]]"),
                   ("-region_soil_minus", "rock,boulder,lining,tunnel"), ("-meter_slope_along", "[[0 m, 4 m], [8 m, 7.9 m]]"),
                   ("-bc_sun_along", "[[1 m, 4.5 m], [8 m, 8 m]]")):  # fmt: skip
    refused = launch(binary(), HILL, *TIGHT, "-restart", out / "checkpoint.h5", key, value, out=scratch() / "other")
    check_true(f"another {key[1:]} is refused", refused.returncode == 2 and "another case" in refused.stdout, refused.stdout.splitlines()[-1:])

# --- what a surface lets in is what the true one would: flux and inflow times its size, however the staircase runs
SCENE = """
grid: {{lower: [{left} m, -1.2 m], upper: [1.4 m, 1.4 m], cells: [{n}, {n}]}}
{more}
materials: [sand]
mat: {{sand: {{porosity: 0.3, solid: {{density: 2650 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}},
  permeability: {{k0: 1e-11 m^2, mh: 0}}, elasticity: {{E0: rigid}}}}}}
fields: [water, heat]
inertia: no
regions: [body]
region: {{body: {{material: sand, {shape}, temperature: 10 degC, pressure: 1 MPa}}}}
boundaries: [{names}, {names}_in]
bc:
{conditions}
time: {{end: 1 s}}
stepper: {{adapt: no, dt: 1 s}}
output: {{dir: out}}
meters: [{names}]
meter:
{meters}
"""
SIDES = ("left", "right", "bottom", "top")
WEDGE = [(-0.8, -0.7), (0.9, -0.4), (1.1, 0.5), (0.2, 0.1), (-0.3, 1.2)]
EDGES = list(zip(WEDGE, WEDGE[1:] + WEDGE[:1]))
points = lambda p: "[" + ", ".join(f"[{x} m, {y} m]" for x, y in p) + "]"
BODIES = {  # shape, more, names of the faces, true size of the surface
    "circle": ("circle: [0.06 m, 0.13 m, 0.9 m]", "", {s: f"side: {s}" for s in SIDES}, 2 * np.pi * 0.9),
    "polygon": (f"polygon: {points(WEDGE)}", "", {f"edge{k}": f"along: {points(e)}" for k, e in enumerate(EDGES)},
                sum(np.hypot(b[0] - a[0], b[1] - a[1]) for a, b in EDGES)),
    "ball": ("circle: [0 m, 0.1 m, 1 m], lower: [0 m, none]", "geometry: axisymmetric", {s: f"side: {s}" for s in SIDES[1:]}, 4 * np.pi),
}  # fmt: skip


def let_in(body, cells):
    """(heat, water) that came in over what the true surface would let in for 100 W/m^2 and 1e-6 m/s."""
    shape, more, faces, size = BODIES[body]
    lines = [f"  {name}: {{type: heat_flux, {where}, flux: 100 W/m^2}}\n  {name}_in: {{type: inflow, {where}, water: 1e-6 m/s}}" for name, where in faces.items()]
    case = scratch() / "case.yaml"
    case.write_text(SCENE.format(n=cells, left=0 if more else -1.2, more=more, shape=shape, names=", ".join(faces), conditions="\n".join(lines),
                                 meters="\n".join(f"  {name}: {{{where}}}" for name, where in faces.items()))
                    .replace(f"{', '.join(faces)}_in]", f"{'_in, '.join(faces)}_in]"))  # fmt: skip
    meters = Run.of_case(case, "-quiet").csv("meters.csv")
    heat, water = (-sum(meters[f"{m}.{what}"][-1] for m in faces) for what in ("heat_J", "water_kg"))
    return heat / (100 * size), water / (1e-6 * 1000 * size)


lines = []
for body in BODIES:
    for cells in (13, 26, 52):
        heat, water = let_in(body, cells)
        lines.append([body, cells, heat - 1, water - 1])
        check(f"{body}, {cells} cells: heat let in", abs(heat - 1), 0.45 / cells)
        check(f"{body}, {cells} cells: water let in", abs(water - heat), 1e-3)
table(["body", "cells", "heat: error", "water: error"], lines)

# --- regions that lie over each other: the later one wins
OVER = """title: two regions
grid: {{lower: [0 m, 0 m], upper: [2 m, 1 m], cells: [8, 4]}}
fields: heat
materials: [rock, soil]
mat:
  rock: {{porosity: 0.1, solid: {{density: 2650 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}}, elasticity: {{E0: rigid}}}}
  soil: {{like: rock, porosity: 0.4}}
regions: [{order}]
region:
  box: {{lower: [0 m, 0 m], upper: [2 m, 1 m], material: rock, temperature: 10 degC{minus}}}
  ball: {{circle: [1 m, 0.5 m, 0.4 m], material: soil, temperature: 20 degC}}
stages: [one, two]
stage: {{one: {{end: 1 h}}, two: {{end: 2 h, materials: [ball, soil]}}}}
output: {{times: [0 s, 2 h]}}
"""


def the_same(a, b):
    return all(np.array_equal(x[n], y[n]) for (_, x), (_, y) in zip(a.snapshots(), b.snapshots(), strict=True) for n in x)


runs = {}
for name, order, minus in (("later", "box, ball", ""), ("cut", "box, ball", ", minus: [ball]"), ("first", "ball, box", "")):
    case = scratch() / "case.yaml"
    case.write_text(OVER.format(order=order, minus=minus))
    done = launch(binary(), case, "-quiet", out=case.parent / "out")
    runs[name] = done, Run(case.parent / "out") if done.returncode == 0 else None
later, cut = runs["later"][1], runs["cut"][1]
check_true("a region over an earlier one is as if cut out of it", the_same(later, cut))
check_true("... which is said", "note: region ball lies over region box" in runs["later"][0].stdout and "note: region" not in runs["cut"][0].stdout, runs["later"][0].stdout[-300:])
start = later.snapshot(0.0)
check("... they fill the box", abs(np.sum(start["volume"]) / 2.0 - 1), 1e-12)
check_true("... the ball is the later one's", 0 < np.count_nonzero(start["region"] == 1) < len(start["region"]) / 2)
check_true("an earlier one that is all covered is refused", runs["first"][0].returncode == 2 and "region_ball_minus" in runs["first"][0].stdout, runs["first"][0].stdout[-300:])
again = Run.of_case(later.out / "case.yaml", "-quiet")
check_true("the resolved case runs to the same", the_same(later, again))
# A region without particles is a hole where minus names it, and nowhere else.
ROD = HILL.parents[2] / "verification" / "cases" / "heater_rod.yaml"


def inside_rod(*options):
    run = Run.of_case(ROD, "-quiet", "-stepper_max_steps", 0, *options)
    x = run.snapshots()[0][1]["position"]
    return int(np.sum(np.all((x > (3.1, 4)) & (x < (4.1, 6)), axis=1)))


there = inside_rod()
check_true("a rod of no material, listed last: its particles stay", there > 0, there)
check_true("... and are cut out where minus names it", inside_rod("-region_layer_minus", "rod") == 0)
finish()
