#!/usr/bin/env python3
"""Heat sources: a wall that is heated all over, and what parts of bodies are given.

Heat sources (443): a wall heated all over between two cold sides has the parabola of its steady state, with the square of h; what a part of a closed
body is given, in the plane, about an axis and in space, is q V t to round-off and found again in its particles; it stays with the particles of a body that
is sheared and turned, in implicit steps and hybrid, on two ranks; a part without a particle is refused."""
import re
from pathlib import Path

import numpy as np

from _shear_block import CASE as SHEARED, saturated
from common import Run, binary, check_true, finish, judge, launch, order, scratch, table

CASE = Path(__file__).parent / "cases" / "heat_source.yaml"
ROW = "4.3"
K, Q = 0.8 * 2.5 + 0.2 * 0.044, 100.0  # W/(m K), of grains and of the gas in dry pores; W/m^3

# between two cold sides: T - T_0 = q x (L - x)/(2 k)
rows, cells = [], (5, 10, 20)
for n in cells:
    _, v = Run.of_case(CASE, "-quiet", "-grid_cells", f"{n},{n // 2}").snapshots()[-1]
    x = v["position"][:, 0]
    rows.append((n, np.max(np.abs(v["T"][:, 0] - 10 - Q * x * (1 - x) / (2 * K))) / (Q / (8 * K))))
table(("cells", "error of T, of its rise"), rows)
judge(ROW, "wall between cold sides, 20 cells: T, of its rise", rows[-1][1], 0.005)
judge(ROW, "... its order in h", order([1 / n for n in cells], [e for _, e in rows])[-1], (1.9, 2.1))

# closed: of what the rod is given nothing is lost
CLOSED = ("-boundaries", "warm", "-time_end", "4 h", "-output_times", "4 h")
RAMP = ("-bc_warm_power", "{ramp: [0 W/m^3, 500 W/m^3, 0 h, 2 h]}")
ACROSS = ("-region_rod_upper", "0.57 m,0.33 m")  # edges that cut particles: those whose middle is inside
PLANE, RING = 0.4 * 0.2, np.pi * (0.6**2 - 0.2**2) * 0.2
for name, joules, options in (("plane", PLANE * 3 * 3600, RAMP), ("hybrid", PLANE * 4 * 3600, ("-bc_warm_power", "500 W/m^3", "-stepper_type", "hybrid")),
                              ("about an axis", RING * 3 * 3600, (*RAMP, "-geometry", "axisymmetric")), ("edges across particles", 0.35 * 0.25 * 3 * 3600, (*RAMP, *ACROSS))):  # fmt: skip
    for ranks in (1, 2):
        run = Run.of_case(CASE, "-quiet", *CLOSED, *options, ranks=ranks)
        _, v = run.snapshots()[-1]
        found = 800 * float((v["mass_solid"] * (v["T"] - 10)).sum())
        judge(ROW, f"closed wall, {name}, ranks: {ranks}: heat that came in over q V t", abs(run.balance["heat_in_J"][-1] / (500 * joules) - 1), 1e-12)
        judge(ROW, f"closed wall, {name}, ranks: {ranks}: found in the particles", abs(found / (500 * joules) - 1), 1e-9)

# in space: the same rod, 0.2 m long in a wall of 0.3 m
space = scratch() / "source_3d.yaml"
space.write_text(re.sub(r"\[(\S+ m), (\S+ m)\]", lambda m: f"[{m[1]}, {m[2]}, {'0 m' if m[1] == '0 m' else '0.1 m' if m[1] == '0.2 m' else '0.3 m'}]", CASE.read_text()).replace("[10, 5]", "[10, 5, 3]"))
run = Run.of_case(space, "-quiet", *CLOSED, *RAMP)
judge(ROW, "closed wall, in space: heat that came in over q V t", abs(run.balance["heat_in_J"][-1] / (500 * PLANE * 0.2 * 3 * 3600) - 1), 1e-12)

for what, options, words in (("a rod without a particle's middle", ("-region_rod_lower", "0.51 m,0.31 m", "-region_rod_upper", "0.52 m,0.32 m"), "bc_warm_region: rod has no particle to heat"),
                             ("no power", ("-bc_warm_power", ""), "bc_warm_power")):  # fmt: skip
    said = launch(binary(), CASE, *CLOSED, *options, out=scratch() / "bad")
    check_true(f"{what} is refused", said.returncode == 2 and words in said.stdout, said.stdout[-300:])

# a body that is sheared and turned keeps what heats it: the particles of its upper half
HEATED = ("-fields", "solid,water,heat", "-inertia", "yes", "-mat_soft_solid_heat_capacity", "800 J/(kg K)", "-mat_soft_solid_conductivity", "0 W/(m K)", "-mat_soft_water_conductivity", "0 W/(m K)",
          "-mat_soft_water_heat_capacity", "4200 J/(kg K)", "-mat_soft_permeability_k0", "1e-14 m^2", "-regions", "block,upper", "-region_upper_material", "none",
          "-region_upper_lower", "0.5 m,0.5 m", "-region_upper_upper", "1.5 m,1 m", "-bc_heat_type", "heat_source", "-bc_heat_region", "upper", "-bc_heat_power", "10 MW/m^3",
          "-bc_shear_shear_ramp", "0 Pa,-0.1 MPa,0 s,0.02 s", "-time_end", "0.05 s", "-output_times", "0.05 s", "-output_probe_every", "0.05 s")  # fmt: skip
OTHERS = {"sdirk2": ("-stepper_dt", "1e-3 s"), "hybrid": ("-stepper_dt", "4e-5 s")}
turned, rises = [], {}
for kind, dt in OTHERS.items():
    for ranks in (1, 2):
        run = Run.of_case(SHEARED, "-quiet", *saturated(0.1), *HEATED, "-boundaries", "base,shear,left,right,top,heat", "-stepper_type", kind, *dt, ranks=ranks)
        (_, first), (_, v) = run.snapshots()[0], run.snapshots()[-1]
        upper = first["position"][:, 1] > 0.5
        rises[kind, ranks] = v["T"][:, 0] - first["T"][:, 0]
        u = v["position"] - first["position"]
        turned.append((kind, ranks, np.abs(u).max(), rises[kind, ranks][upper].mean(), rises[kind, ranks][~upper].mean(), run.balance["heat_in_J"][-1]))
        judge(ROW, f"sheared block, {kind}, ranks: {ranks}: heat that came in over q V t", abs(run.balance["heat_in_J"][-1] / (1e7 * 0.5 * 0.05) - 1), 1e-12)
for kind in OTHERS:
    judge(ROW, f"sheared block, {kind}: T on two ranks, apart from one", np.max(np.abs(rises[kind, 2] - rises[kind, 1])), 1e-9, unit="K")
judge(ROW, "sheared block: hybrid against sdirk2, rise of T of the upper half", abs(turned[2][3] / turned[0][3] - 1), 0.01)
table(("sheared block", "ranks", "moved (m)", "upper half (K)", "lower half (K)", "in (J)"), turned)
finish()
