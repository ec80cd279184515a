#!/usr/bin/env python3
"""Grids whose cells differ: patch tests, rest, fall, consolidation, a well and a footing.

A grid whose cells differ: what must be exact on any lines is, and what gains by fine cells does.

A uniform stress and a linear temperature, fine at either end of either axis; bodies at rest; a fall through cells of changing width; consolidation with the
cells at the drain; Thiem's well of 0.1 m in a reservoir of 100 m; a footing on ground of 40 m.
"""
from pathlib import Path

import numpy as np

import exact
from common import Run, finish, judge, table

CASES = Path(__file__).parent / "cases"
QUIET = ("-quiet",)
# Of rows of cells between lines at 0, 8, 10, 11, 20 and 24 m; and of a shaft whose cells change width by half.
LAYERS = "0 m,3 m,8 m,1 m,10 m,0.4 m,12 m,0.4 m,20 m,2 m,24 m,3 m"
SHAFT = "0 m,0.1 m,1.5 m,0.06 m,2.5 m,0.06 m,4 m,0.1 m"
TIGHT = ("-newton_tol_residual", 1e-12, "-newton_tol_update", 1e-10, "-snes_max_it", 30)
FINE = {"low": "0 m,0.03 m,1 m,0.3 m", "high": "0 m,0.3 m,1 m,0.03 m", "middle": "0 m,0.3 m,0.45 m,0.03 m,0.5 m,0.03 m,1 m,0.4 m"}


def axes(x, y):
    return ("-grid_cells", "auto,auto", "-grid_spacing_x_table", x, "-grid_spacing_y_table", y)


# ---------------------------------------------------------------- patch tests
def patch(basis, x, y):
    """(stress, displacement, temperature) off the uniform and linear ones, over the largest."""
    grid = axes(FINE[x], FINE[y])
    last = Run.of_case(CASES / "graded_patch.yaml", *QUIET, *grid, "-basis", basis, *TIGHT, timeout=60).snapshots()[-1][1]
    u, X = last["displacement"], np.c_[last["position"] - last["displacement"], np.ones(len(last["position"]))]
    stress = np.max(np.abs(last["stress"][:, [0, 1, 3]] - [-1e3, -2e3, 0.0])) / 2e3
    linear, heat = np.max(np.abs(X @ np.linalg.lstsq(X, u, rcond=None)[0] - u)) / np.max(np.abs(u)), 0.0
    for k, sides in enumerate((("left", "right"), ("bottom", "top"))):
        held = [o for n, side, T in zip(("cold", "hot"), sides, (10, 30))
                for o in (f"-bc_{n}_type", "face_temperature", f"-bc_{n}_side", side, f"-bc_{n}_temperature", f"{T} degC")]  # fmt: skip
        run = Run.of_case(CASES / "graded_patch.yaml", *QUIET, *grid, "-basis", basis, "-fields", "heat", "-boundaries", "cold,hot", *held,
                          "-time_end", "1e12 s", "-stepper_dt", "5e11 s", "-output_times", "1e12 s", timeout=60)  # fmt: skip
        p = run.snapshots()[-1][1]
        heat = max(heat, np.max(np.abs(p["T"].ravel() - 10.0 - 20.0 * p["position"][:, k])) / 20.0)
    return stress, linear, heat


rows = [(basis, f"x {x}, y {y}", *patch(basis, x, y)) for basis in ("cpgimp", "ugimp") for x, y in (("low", "high"), ("high", "middle"), ("middle", "low"))]
table(("basis", "fine at", "stress off", "displacement not linear", "temperature off"), rows)
judge("graded", "patch test, fine at either end of either axis: uniform stress, linear displacement", max(max(r[2:4]) for r in rows if r[0] == "cpgimp"), 1e-9)
judge("graded", "... with domains that keep their length (strain 2e-6)", max(max(r[2:4]) for r in rows if r[0] == "ugimp"), 2e-6)
judge("graded", "... linear temperature", max(r[4] for r in rows), 1e-9)

last = Run.of_case(CASES / "graded_patch.yaml", *QUIET, *axes(FINE["low"], FINE["middle"]), "-basis", "linear", *TIGHT, "-boundaries", "base,wall", "-ambient_pressure", "2 kPa").snapshots()[-1][1]
judge("graded", "... linear functions under an ambient pressure (a traction acts at their particles): uniform stress", np.max(np.abs(last["stress"][:, [0, 1, 3]] - [-2e3, -2e3, 0.0])) / 2e3, 1e-9)

# ---------------------------------------------------------------- at rest, and in free fall
rows = []
for name, options, scale in (("rest_hydrostatic", ("-grid_cells", "1,auto", "-grid_spacing_y", "0.03 m,0.3 m,growth 1.4", *TIGHT), 1e-9),
                             ("rest_layers", ("-grid_cells", "1,auto", "-grid_spacing_y", "0.03 m,0.3 m,growth 1.4", *TIGHT), 1e-9),
                             ("geostatic", ("-grid_cells", "2,auto", "-grid_spacing_y_table", LAYERS), 1e-9)):  # fmt: skip
    last = Run.of_case(CASES / f"{name}.yaml", *QUIET, *options, timeout=100).snapshots()[-1][1]
    rows.append((name, *(np.max(np.abs(last[v])) / scale for v in ("v_s", "v_w"))))
table(("at rest", "v_s (nm/s)", "v_w (nm/s)"), rows)
judge("graded", "hydrostatic and geostatic columns, two layers: largest velocity, over 1 nm/s", max(max(r[1:]) for r in rows), 1e-6)
held = [o for n, side, T in (("cold", "top", 10), ("hot", "bottom", 30))
        for o in (f"-bc_{n}_type", "face_temperature", f"-bc_{n}_side", side, f"-bc_{n}_temperature", f"{T} degC")]  # fmt: skip
warm = Run.of_case(CASES / "graded_patch.yaml", *QUIET, *axes(FINE["middle"], FINE["middle"]), "-fields", "heat", "-boundaries", "cold,hot", *held, "-inertia", "yes", "-gravity", "0 m/s^2,-9.81 m/s^2",
                   "-region_square_geothermal", "20 K/m", "-region_square_geothermal_datum", "1 m", "-stepper_type", "hybrid", "-stepper_adapt", "yes", "-stepper_dt", "10 s", "-time_end", "1e5 s",
                   "-output_times", "1e5 s", "-stepper_max_steps", "20000", timeout=60)  # fmt: skip
p = warm.snapshots()[-1][1]
judge("graded", "hybrid: a linear temperature stays, after a day", np.max(np.abs(p["T"].ravel() - 30.0 + 20.0 * p["position"][:, 1])) / 20.0, 1e-10)
fall = {g: Run.of_case(CASES / "falling.yaml", *QUIET, "-time_end", "0.6 s", "-output_times", "0.6 s", "-stepper_dt", "4 ms", "-region_block_particles_per_cell", "3,3", *o, timeout=200)
        for g, o in (("equal", ()), ("graded", ("-grid_cells", "6,auto", "-grid_spacing_y_table", SHAFT)))}  # fmt: skip
last = {g: r.snapshots()[-1][1] for g, r in fall.items()}
warm = Run.of_case(CASES / "falling.yaml", *QUIET, "-fields", "solid,heat", "-boundaries", "", "-probes", "", "-grid_cells", "6,auto", "-grid_spacing_y_table", SHAFT,
                   "-region_block_particles_per_cell", "3,3", "-region_block_geothermal", "50 K/m", "-region_block_geothermal_datum", "3.9 m", "-region_block_temperature", "10 degC",
                   "-mat_sand_solid_heat_capacity", "800 J/(kg K)", "-mat_sand_solid_conductivity", "1e-9 W/(m K)", "-mat_sand_gas_conductivity", "1e-9 W/(m K)", "-stepper_type", "hybrid", "-stepper_adapt", "yes",
                   "-stepper_dt", "1e-5 s", "-time_end", "0.4 s", "-output_times", "0.4 s", timeout=100)  # fmt: skip
gradient = np.max(np.abs(warm.snapshots()[-1][1]["grad_T"] - [0.0, -50.0])) / 50.0
judge("graded", "hybrid: the gradient of a linear temperature in a falling block", gradient, 1e-10)
speed = -9.81 * 0.6
rows = [(g, np.max(np.abs(p["v_s"][:, 1] / speed - 1)), np.max(np.abs(p["stress"])) / 1e7, np.ptp(p["displacement"][:, 1])) for g, p in last.items()]
table(("a block falls through cells that are", "speed off g t", "stress over E0", "spread of its fall (m)"), rows)
judge("graded", "a block that falls 1.8 m through cells of changing width: speed off g t", rows[1][1], 1e-9)
judge("graded", "... stress over its modulus", rows[1][2], 1e-9)

# ---------------------------------------------------------------- consolidation: a loaded column, soon after, cells at the drain
P0, q, M = 3.25e6, 1e3, exact.constrained_modulus(9e7, 0.2)
B, c = exact.mixture_coefficients(M, 1.53e-12, 0.15, 2.2e9, 0.6, 0.4, P0)
times, rows = (20.0, 100.0, 500.0), []
for grid, options in (("equal", ("-grid_cells", "12,1")), ("fine at the drain", ("-grid_cells", "12,1", "-grid_spacing_x_table", "0 m,0.23 m,1 m,0.02 m"))):
    run = Run.of_case(CASES / "terzaghi.yaml", *QUIET, *options, "-bc_load_normal_table", f"0 s,{P0 + q} Pa,2000 s,{P0 + q} Pa", "-time_end", "500 s",
                      "-stepper_dt", "2 s", "-output_times", "20 s,100 s,500 s", timeout=100)  # fmt: skip
    off = []
    for t in times:
        p = run.snapshot(t)
        x = p["position"][:, 0] - p["displacement"][:, 0]
        off.append(np.sqrt(np.sum(p["volume"].ravel() * (p["p"].ravel() - P0 - exact.terzaghi_constant(q, B, c, 1.0, 1.0 - x, t)) ** 2) / np.sum(p["volume"])) / (B * q))
    u = run.at("surface", "u_x_m", times)
    rows.append((grid, *off, np.max(np.abs(u / exact.terzaghi_constant_settlement(q, M, B, c, 1.0, np.array(times)) - 1))))
table(("12 cells", *(f"p off at {t:g} s" for t in times), "settlement off"), rows)
judge("graded", "Terzaghi at 20 s, 12 cells fine at the drain, over as many equal ones", rows[1][1] / rows[0][1], 0.5)
judge("graded", "... settlement up to 500 s", rows[1][4] / rows[0][4], 0.5)

# ---------------------------------------------------------------- a well of 0.1 m in a reservoir of 100 m
r_w, R, k, mu, K = 0.1, 100.0, 1e-12, 1e-3, 2.2e9
rows = []
for what, size in (("fine at the well", "0.1 m,8 m,growth 1.25"), ("finer", "0.05 m,2 m,growth 1.15"), ("equal cells of the same number", "3.44482759 m")):
    run = Run.of_case(CASES / "graded_well.yaml", *QUIET, "-grid_spacing_x", size, timeout=100)
    meters = run.csv("meters.csv")
    thiem = 2 * np.pi * k / mu * 6e6 / np.log(R / r_w) * 1000.0 * np.exp(2e6 / K)
    p = [run.probe(n)["p_Pa"][-1] - (4e6 + 6e6 * np.log(r / r_w) / np.log(R / r_w)) for n, r in (("near", 0.15), ("middle", 1.0), ("far", 20.0))]
    rows.append((what, float(run.output.split(" x 1 cells")[0].split()[-1]), meters["well.water_kg_s"][-1] / thiem, *np.abs(p) / 6e6))
table(("cells", "number", "rate / Thiem", "p at 0.15 m", "at 1 m", "at 20 m, of the drop"), rows)
judge("graded", "Thiem, r_w = 0.1 m, to 100 m: rate off", max(abs(r[2] - 1) for r in rows[:2]), 1e-3)
judge("graded", "... pressure off from 1 m on, of the drop", max(max(r[4:]) for r in rows[:2]), 1e-2)
rows = []
for lower in (0.06, 0.03):
    run = Run.of_case(CASES / "graded_well.yaml", *QUIET, "-grid_lower", f"{lower} m,0 m", timeout=100)
    rows.append((lower, run.csv("meters.csv")["well.water_kg_s"][-1] / thiem))
table(("grid from (m)", "rate / Thiem"), rows)
judge("graded", "... whose wall of 0.1 m lies within a cell: rate off", max(abs(r[1] - 1) for r in rows), 1e-2)

# ---------------------------------------------------------------- a footing of 1 m on ground of 40 m, in as many cells as equal ones to 8 m
E, NU = 20e6, 0.3
HALF_SPACE = ("-grid_cells", "auto,auto", "-grid_upper", "40 m,40.05 m", "-region_ground_upper", "40 m,40 m", "-bc_side_position", "40 m", "-probes", "", "-stepper_dt", "1 s",
              "-grid_spacing_x", "{table: [0 m,0.2 m,0.8 m,0.05 m,1 m,0.05 m,1.2 m,0.05 m,40 m,4 m]}", "-grid_spacing_y_table", "0 m,4 m,38.8 m,0.1 m,39.8 m,0.05 m,40 m,0.05 m,40.05 m,0.05 m")  # fmt: skip
rows = []
for rough in ("no", "yes"):
    m = Run.of_case("footing", *QUIET, *HALF_SPACE, "-bc_footing_rough", rough, timeout=100).csv("meters.csv")
    rows.append((rough, -m["footing.force_N"][-1] / m["footing.position_m"][-1] / (2 * E / (1 - NU**2))))
table(("rough", "stiffness / half space"), rows)
judge("graded", "a smooth footing over cells of 0.05 to 4 m: stiffness, over a half space's", abs(rows[0][1] - 1), 0.05)
judge("graded", "... a rough one over it, against Spence", abs(rows[1][1] / rows[0][1] / ((1 - NU) * np.log(3 - 4 * NU) / (1 - 2 * NU)) - 1), 5e-3)
finish()
