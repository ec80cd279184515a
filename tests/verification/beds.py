#!/usr/bin/env python3
"""Flow through dipping beds, ten times as permeable along them as across, against the exact one.

Flow through beds that dip (306)-(309), ten times as permeable along them as across: the linear pressure of a lighter fluid around a block of rigid
sand makes a flow that is even, with the tensor of its beds, exactly; layers with level beds lie on each other; a wet block falls without slip; a block
that is sheared at once is the same in hybrid and in implicit steps, on two ranks, and cut in two by a restart."""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "integration"))
from _files import different  # noqa: E402
from common import Run, check_true, finish, judge, largest_difference, scratch, table  # noqa: E402

CASES = Path(__file__).parent / "cases"
BEDS, LAYERS, FALLING, SHEARED = (CASES / f"{name}.yaml" for name in ("beds", "layers", "falling", "shear_block"))
ROW = "beds"
K, RATIO, MU, RHO = 5e-13, 0.1, 1e-3, 1000.0


def exact(dip, g):
    """Water through the right side (3 m) and the bottom (6 m), outwards, kg/(s m)."""
    n = np.array([-np.sin(np.radians(dip)), np.cos(np.radians(dip))])
    J = K / MU * (np.eye(2) - (1 - RATIO) * np.outer(n, n)) @ [0, -g] * (RHO - 600)
    return RHO * np.array([3 * J[0], -6 * J[1]])


def found(case, *options, **keywords):
    m = Run.of_case(case, "-quiet", *options, **keywords).csv("meters.csv")
    return np.array([m[k][-1] for k in m if k.endswith("water_kg_s")])


SLOWLY = ("-stepper_type", "hybrid", "-inertia", "yes", "-stepper_adapt", "yes", "-stepper_dt", "0.1 s", "-mat_beds_water_bulk_modulus", "1e8 Pa", "-gravity", "0 m/s^2,-0.1 m/s^2",
          "-region_block_pressure", "101325 Pa", "-ambient_pressure", "101235 Pa", "-time_end", "3000 s", "-output_times", "3000 s")  # fmt: skip
EXACTLY = ("-newton_tol_update", "1e-8")
SHIFTED = ("-grid_lower", "-0.13 m,-0.17 m", "-grid_upper", "6.37 m,3.33 m", "-grid_cells", "13,7")
rows = []
for name, g, bar, dips, options in (("euler", 10, 1e-9, (0, 30, -60, 90), EXACTLY), ("euler, block across the lines of the grid", 10, 1e-9, (30,), (*SHIFTED, *EXACTLY)),
                                    ("sdirk2 with inertia", 10, 1e-6, (-60,), ("-stepper_type", "sdirk2", "-inertia", "yes")), ("hybrid", 0.1, 1e-5, (0, 30, -60), SLOWLY)):  # fmt: skip
    for dip in dips:
        flow, should = found(BEDS, "-mat_beds_permeability_dip", f"{dip} deg", *options), exact(dip, g)
        rows.append((f"{name}, {dip} deg", *flow, *should))
        judge(ROW, f"{name}, beds dip by {dip} deg: flow", largest_difference(flow, should), bar)
table(("kg/(s m)", "right", "bottom", "exact", "exact"), rows)

UP = ("-bc_in_side", "bottom", "-bc_out_side", "top", "-meter_in_side", "bottom", "-meter_out_side", "top")
LEVEL = ("-mat_sand_permeability_ratio", "0.1", "-mat_clay_permeability_ratio", "0.5")
SAND, CLAY = 5e-13, 1e-17
for name, options, should in (("along", (), 1e6 / 6 * (SAND + 2 * CLAY)), ("across", UP, 6e6 / (1 / (0.1 * SAND) + 2 / (0.5 * CLAY)))):
    flow = abs(found(LAYERS, *LEVEL, *options)[1])
    judge(ROW, f"{name} layers of other beds: flow", abs(flow / (RHO / MU * should) - 1), 1e-8)

# where beds of one layer dip otherwise than those of the next water at rest stays so
ALIKE = ("-mat_clay_permeability_k0", f"{SAND} m^2", "-mat_sand_permeability_ratio", "0.1", "-mat_clay_permeability_ratio", "0.1", "-mat_sand_permeability_dip", "40 deg")
STILL = ("-gravity", "1 m/s^2,-10 m/s^2", "-ambient_pressure", "10 MPa", "-ambient_level", "3 m", "-ambient_density", "1000 kg/m^3", "-bc_in_pressure", "ambient", "-bc_out_pressure", "ambient")
judge(ROW, "water at rest in layers whose beds dip otherwise: flow over k rho g/mu", np.max(np.abs(found(LAYERS, *ALIKE, *STILL))) / (3 * RHO * SAND / MU * 1e4), 1e-8)

DIPS = ("-mat_sand_permeability_ratio", "0.05", "-mat_sand_permeability_dip", "30 deg", "-mat_sand_permeability_k0", "1e-10 m^2")
for kind, adapt in (("sdirk2", "no"), ("hybrid", "yes")):
    _, end = Run.of_case(FALLING, "-quiet", *DIPS, "-newton_tol_update", "1e-8", "-stepper_type", kind, "-stepper_adapt", adapt).snapshots()[-1]
    judge(ROW, f"a block of beds falls at 7.8 m/s, {kind}: slip of its water", np.max(np.abs(end["v_w"] - end["v_s"])), 1e-11, unit="m/s")

# inertia and drag of the water are alike in this block: the skeleton's acceleration counts along both axes
SIDES = [w for side in ("left", "right", "top") for w in (f"-bc_p{side}_type", "pressure", f"-bc_p{side}_side", side, f"-bc_p{side}_pressure", "0.1 MPa")]
SIDES += [w for side in ("left", "right") for w in (f"-bc_t{side}_type", "traction", f"-bc_t{side}_side", side, f"-bc_t{side}_normal", "0.1 MPa")]
WET = ("-fields", "solid,water", "-inertia", "yes", "-region_block_pressure", "0.1 MPa", "-mat_soft_permeability_k0", "1e-8 m^2", "-mat_soft_water_bulk_modulus", "100 MPa",
       "-bc_shear_shear_ramp", "0 Pa,-0.02 MPa,0 s,0.01 s", "-bc_shear_normal", "0.1 MPa", "-boundaries", "base,shear,pleft,pright,ptop,tleft,tright", *SIDES,
       "-time_end", "0.02 s", "-output_times", "0.02 s", "-output_probe_every", "0.02 s", "-stepper_adapt", "no")  # fmt: skip
TILTED = ("-mat_soft_permeability_ratio", "0.1", "-mat_soft_permeability_dip", "30 deg")
KIND = {"sdirk2": ("-stepper_type", "sdirk2", "-stepper_dt", "2e-4 s"), "hybrid": ("-stepper_type", "hybrid", "-stepper_dt", "2e-5 s")}
shear = lambda kind, *options, **keywords: Run.of_case(SHEARED, "-quiet", *WET, *KIND[kind], *options, **keywords)
corner = lambda run: np.array([run.probe("corner")[k][-1] for k in ("u_x_m", "u_y_m")])
runs = {(kind, beds): shear(kind, *(TILTED if beds else ())) for kind in KIND for beds in (False, True)}
table(("sheared block", "u_x (m)", "u_y (m)", "remainder/work"),
      [(f"{kind}{', beds' * beds}", *corner(run), run.balance["energy_remainder_J"][-1] / run.balance["load_work_J"][-1]) for (kind, beds), run in runs.items()])  # fmt: skip
judge(ROW, "sheared block of beds: hybrid against sdirk2", largest_difference(corner(runs["hybrid", True]), corner(runs["sdirk2", True])), 0.006, 0.01, "%")
judge(ROW, "sheared block: beds move it otherwise", largest_difference(corner(runs["sdirk2", True]), corner(runs["sdirk2", False])), (0.03, 0.2), 0.01, "%")
for kind in KIND:
    b = runs[kind, True].balance
    judge(ROW, f"sheared block of beds, {kind}: remainder of energy over work", abs(b["energy_remainder_J"][-1]) / b["load_work_J"][-1], 0.01, 0.01, "%")
    judge(ROW, f"sheared block of beds, {kind}: 2 ranks against 1", largest_difference(corner(shear(kind, *TILTED, ranks=2)), corner(runs[kind, True])), 1e-6)
    out = scratch() / "out"
    shear(kind, *TILTED, "-stepper_max_steps", "512" if kind == "hybrid" else "31", out=out)  # whole bursts of hybrid
    shear(kind, *TILTED, "-restart", out / "checkpoint.h5", out=out)
    names = [n for n in different(runs[kind, True].out, out) if kind == "sdirk2" or n != "checkpoint.h5:state/dt"]  # hybrid divides what is left anew
    check_true(f"sheared block of beds, {kind}: cut in two by a restart, the same bit for bit", not names, ", ".join(names[:5]))
finish()
