#!/usr/bin/env python3
"""Total Lagrangian basis: uniform compression to round-off, a soft column, layers that settle.

Total Lagrangian (445), `basis: total`: a block squeezed by 30 % stays uniform to round-off, in the plane, in a ring and in space; a soft column converges to its exact
settlement with second order; layers that settle off the grid's lines drain as those that do not; balance of water, two and four ranks, restart; what it does not
know it refuses.  (Turns under pressure, a linear T under shear, tangents: tests/unit/test_turning.c, test_model.c.)"""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, largest_difference, order, table

CASES = Path(__file__).parent / "cases"
BLOCK, LAYERS = CASES / "squeezed_block.yaml", CASES / "settling_layers.yaml"
ROW = "4.1"
TOTAL = ("-basis", "total")


def last(case, *options, **keywords):
    run = Run.of_case(case, "-quiet", *options, **keywords)
    return run, run.snapshots()[-1][1]


# ---------------------------------------------------------------- homogeneous motion across many cells
rows = []
for name, block, options in (("plane", BLOCK, ()), ("ring", BLOCK, ("-geometry", "axisymmetric")), ("space", CASES / "squeezed_block_3d.yaml", ())):
    spread = {}
    for basis in ("total", "cpgimp", "ugimp"):
        _, v = last(block, *options, "-basis", basis)
        J = np.exp(v["log_J"][:, 0])
        spread[basis] = J.max() - J.min()
        if basis == "total":
            judge(ROW, f"total, block squeezed by 30 %, {name}: volume against exact", np.max(np.abs(J / 0.7 - 1)), 1e-7)
            off = v["displacement"][:, 1] + 0.3 * v["initial_position"][:, 1]
            judge(ROW, f"total, block squeezed by 30 %, {name}: displacement against exact", np.max(np.abs(off)), 1e-7, unit="m")
    rows.append((name, *spread.values()))
    check_true(f"... those of ugimp differ by {spread['ugimp']:.1e}, more than 1e-2", spread["ugimp"] > 1e-2)
table(("squeezed block: largest less smallest J", "total", "cpgimp", "ugimp"), rows)

# ---------------------------------------------------------------- a column under its own weight: u = int (exp(-rho g (H - Y)/M) - 1) dY
DEPTH, M, WEIGHT = 10.0, 3e5, 1300 * 9.81
exact = lambda Y: M / WEIGHT * np.exp(-WEIGHT * DEPTH / M) * (np.exp(WEIGHT * Y / M) - 1) - Y
cells, off = (10, 20, 40), {"total": [], "cpgimp": []}
for basis, error in off.items():
    for n in cells:
        _, v = last("gravity_column", "-basis", basis, "-grid_cells", f"1,{n}", "-grid_upper", f"{10 / n} m,10 m", "-region_column_upper", f"{10 / n} m,10 m", "-bc_right_position", f"{10 / n} m")
        error.append(np.max(np.abs(v["displacement"][:, 1] - exact(v["initial_position"][:, 1]))) / abs(exact(DEPTH)))
table(("soft column, cells", *(f"error, {b}" for b in off), "order, total"), [(n, *(e[k] for e in off.values()), "-" if k == 0 else f"{-order(cells, off['total'])[k - 1]:.2f}") for k, n in enumerate(cells)])
judge(ROW, "total, soft column: error on 40 cells", off["total"][-1], 1e-3)
check_true("... of second order", max(order(cells, off["total"])) < -1.8)

# ---------------------------------------------------------------- borders of layers
def clays(*options):
    run, v = last(LAYERS, *options)
    X, u, region = v["initial_position"], v["displacement"][:, 1], v["region"].ravel()
    near = X[:, 0] < 0.4
    end = lambda r, pick: u[near & (region == r)][pick(X[near & (region == r), 1])]
    return -end(0, np.argmax), end(2, np.argmin) - end(2, np.argmax), run.csv("meters.csv")["well.water_kg"][-1], run


rows, found = [], {}
for basis in ("total", "cpgimp"):
    lower, upper, water, run = found[basis] = clays("-basis", basis)
    rows.append((basis, 1e3 * lower, 1e3 * upper, water / 1e3, len(run.balance["step"])))
table(("sand between clays: mm of", "lower clay", "upper clay", "water, t", "steps"), rows)
judge(ROW, "total, sand between clays: the clays' compression apart", abs(found["total"][0] / found["total"][1] - 1), 0.01, 0.01, "%")
for k, what in enumerate(("lower clay", "upper clay", "water")):
    judge(ROW, f"sand between clays, borders that cut cells of a fixed grid (447): {what}, off total", abs(found["cpgimp"][k] / found["total"][k] - 1), 0.06, 0.01, "%")
SHORT = ("-basis", "cpgimp", "-time_end", "0.5 d", "-output_times", "0.5 d", "-newton_tol_update", "1e-8", "-newton_tol_residual", "1e-10")
one, two = (last(LAYERS, *SHORT, ranks=n)[1] for n in (1, 2))
judge(ROW, "... on 2 ranks, displacement apart", largest_difference(two["displacement"], one["displacement"]), 1e-8, unit="m")
GAS = [w for n in ("sand", "clay") for k, v in (("retention_p0", "20 kPa"), ("retention_m", "0.5"), ("retention_Swr", "0.2"), ("retention_Sgr", "0.05"), ("relperm_nw", "3"), ("relperm_ng", "2")) for w in (f"-mat_{n}_{k}", v)]
GAS += [w for n in ("lower", "layer", "upper") for k, v in (("temperature", "10 degC"), ("Sw", "0.9"), ("Sg", "0.1")) for w in (f"-region_{n}_{k}", v)]
EARLY = ("-fields", "solid,water,gas", "-basis", "cpgimp", "-time_end", "0.5 d", "-output_times", "0.5 d", *GAS)
NOTE = "the border between clay and sand lay on a line of the grid and is"
said = [[line for line in last(LAYERS, *EARLY, *more, ranks=n)[0].output.splitlines() if NOTE in line] for n, *more in ((1,), (2,), (1, "-basis", "total"), (1, "-mat_clay_permeability_k0", "5e-15 m^2"))]
check_true("with gas the run says that a border has left its line, on 2 ranks the same, not with total, and not where they differ by 100", len(said[0]) == 1 and said[0] == said[1] and not said[2] and not said[3], str(said))
check_true("... with water alone it does not", not any(NOTE in found[k][3].output for k in found))
run = found["total"][3]
judge(ROW, "total, sand between clays: balance of water", np.max(np.abs(run.balance["water_error"])), 1e-13)

# ---------------------------------------------------------------- ranks and restart
SHORT = (*TOTAL, "-time_end", "0.5 d", "-output_times", "0.5 d", "-newton_tol_update", "1e-8", "-newton_tol_residual", "1e-10")
_, one = last(LAYERS, *SHORT)
for ranks in (2, 4):
    _, v = last(LAYERS, *SHORT, ranks=ranks)
    judge(ROW, f"total, sand between clays: {ranks} ranks, displacement apart", largest_difference(v["displacement"], one["displacement"]), 1e-9, unit="m")
half, _ = last(LAYERS, *TOTAL, "-time_end", "3 d", "-output_times", "1 d,3 d", "-stepper_max_steps", "8")
_, v = last(LAYERS, *TOTAL, "-time_end", "3 d", "-output_times", "1 d,3 d", "-restart", str(half.out / "checkpoint.h5"))
_, whole = last(LAYERS, *TOTAL, "-time_end", "3 d", "-output_times", "1 d,3 d")
judge(ROW, "total, sand between clays: restarted, displacement apart", largest_difference(v["displacement"], whole["displacement"]), 1e-13, unit="m")

half, _ = last(BLOCK, "-stepper_max_steps", "10")
_, v = last(BLOCK, *TOTAL, "-restart_as_initial", str(half.out / "checkpoint.h5"), "-bc_load_normal", f"{0.5 * 480139.34761} Pa")
judge(ROW, "total, block that cpgimp squeezed half of the way: displacement under the same load", np.max(np.abs(v["displacement"])), 1e-7, unit="m")

# ---------------------------------------------------------------- what it does not know
for options, words in ((("-inertia", "yes", "-stepper_type", "hybrid"), "hybrid does not know basis: total"),
                       (("-mean_strain", "0.5"), "total is not known with a mean_strain")):  # fmt: skip
    run = Run.of_case(BLOCK, "-quiet", *TOTAL, *options, exit_code=2)
    check_true(f"refused: {words}", words in run.output, run.output[:300])
run = Run.of_case("biaxial", "-quiet", *TOTAL, "-mat_sand_plasticity_nonlocal_length", "0.05 m", exit_code=2)
check_true("refused: nonlocal_length", "nonlocal_length: is not known with basis: total" in run.output, run.output[:300])
run = Run.of_case("footing", "-quiet", *TOTAL, exit_code=2)
check_true("refused: a plate", "_type: plate is not known with basis: total" in run.output, run.output[:300])
finish()
