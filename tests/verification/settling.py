#!/usr/bin/env python3
"""Exchange within cells: its rate, and sand drained under clay that settles into its cells.

Exchange within cells (353), (354): rows of particles at two pressures by turns even out at the rate of the flow between them; sand that is drained under clay,
whose border settles into the cells, has no pressure below that of its drain, with the axes swapped and under a higher pressure, on two ranks and cut in two by a restart."""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "integration"))
from _files import different  # noqa: E402
from common import Run, check_true, finish, judge, largest_difference, scratch, table  # noqa: E402

CASE = Path(__file__).parent / "cases" / "settling.yaml"
ROW = "settling"

# ---------------------------------------------------------------- the rate, exactly: nodes see of such rows what is at the ends alone
# but for the lowest they are alike; it lets more through, as (353) is for layers that differ
PHI, K, MU, BULK, L, END = 0.4, 1e-18, 1e-3, 1e9, 0.125, 3600.0
PLACES = [(k, 0.25 * k, 0.25 * (k + 1), 10 + 0.05 * (-1) ** k) for k in range(40)]
ROWS = f"""title: rows of particles at two pressures
inertia: no
grid: {{lower: [0 m, 0 m], upper: [0.5 m, 10 m], cells: [1, 20]}}
materials: [clay, loose]
mat: {{clay: {{porosity: {PHI}, solid: {{density: 2650 kg/m^3}}, water: {{bulk_modulus: {BULK} Pa, viscosity: {MU} Pa s}}, permeability: {{k0: {K} m^2}}, elasticity: {{E0: 1 GPa, nu: 0.25}}}}, loose: {{like: clay, permeability: {{k0: {2 * K} m^2}}}}}}
regions: [{', '.join(f'r{k}' for k, *_ in PLACES)}]
region:
{chr(10).join(f'  r{k}: {{lower: [0 m, {low} m], upper: [0.5 m, {high} m], material: {"clay" if k else "loose"}, pressure: {p} MPa, temperature: 10 degC}}' for k, low, high, p in PLACES)}
boundaries: [left, right, bottom, top]
bc: {{left: {{type: roller, axis: x, position: 0 m}}, right: {{type: roller, axis: x, position: 0.5 m}}, bottom: {{type: roller, axis: y, position: 0 m}}, top: {{type: roller, axis: y, position: 10 m}}}}
time: {{end: {END} s}}
stepper: {{type: euler, adapt: no, dt: 10 min}}
output: {{times: [{END} s]}}
"""
rows_case = scratch() / "rows.yaml"
rows_case.write_text(ROWS)
rows = []
for name, storage, options in (("rigid skeleton", PHI / BULK, ("-fields", "water")), ("M = 1.2 GPa", PHI / BULK + 1 / 1.2e9, ("-fields", "hm", "-stepper_type", "sdirk2"))):
    run = Run.of_case(rows_case, "-quiet", *options)
    (_, start), (_, end) = run.snapshots()[0], run.snapshots()[-1]
    rate = K / MU / storage * 2 * 0.5 / L**2
    inner = np.abs(start["position"][:, 1] - 5) < 0.5
    left = np.mean(np.abs(end["p_w"][inner] - 1e7)) / 5e4
    rows.append((name, left, np.exp(-rate * END)))
    judge(ROW, f"rows at two pressures, {name}: what is left of the difference", abs(left / np.exp(-rate * END) - 1), 1e-5)
    judge(ROW, f"rows at two pressures, {name}: water balance", abs(run.balance["water_error"][-1]), 1e-14)
table(("rows after 1 h", "found", "exact"), rows)
never = Run.of_case(rows_case, "-quiet", "-fields", "water", "-exchange_ksp_max_it", "1", "-stepper_max_steps", "4")
again = Run.of_case(rows_case, "-quiet", "-fields", "water", "-exchange_ksp_max_it", "1", "-restart", never.out / "checkpoint.h5")
for what, done, count in (("four steps", never, 4), ("six with a restart", again, 6)):
    said = f"  {count} steps evened no pressures out within cells"
    check_true(f"(354) is not found in {what}: the end and the summary say so", said in done.output and said in (done.out / "summary.txt").read_text(), done.output[-500:])
check_true("... and the rows stay apart", np.ptp(again.snapshots()[-1][1]["p_w"]) > 0.99e5, np.ptp(again.snapshots()[-1][1]["p_w"]))
check_true("where it is found nothing is said of it", "evened" not in run.output)
GAS = ("-mat_clay_retention_p0", "100 kPa", "-mat_clay_retention_m", "0.45", "-mat_clay_retention_Swr", "0.2", "-mat_clay_retention_Sgr", "0.01", "-mat_clay_relperm_nw", "4", "-mat_clay_relperm_ng", "2")
run = Run.of_case(rows_case, "-quiet", "-fields", "water,gas", *GAS, *(w for k, *_ in PLACES for w in (f"-region_r{k}_Sw", "0.9", f"-region_r{k}_Sg", "0.1")))
(_, start), (_, end) = run.snapshots()[0], run.snapshots()[-1]
apart = lambda s, of: np.ptp(np.asarray(of(s))[np.abs(start["position"][:, 1] - 5) < 0.5])
mean = lambda s: s["p_w"] + s["S_g"] * (s["p_g"] - s["p_w"])
check_true("rows of water and gas: the mean of the pressures evens out", apart(end, mean) < 0.9 * apart(start, mean), f"{apart(start, mean):.6g} Pa, then {apart(end, mean):.6g} Pa")
judge(ROW, "rows of water and gas: change of capillary pressure over the difference", np.max(np.abs(end["p_g"] - end["p_w"] - start["p_g"] + start["p_w"])[np.abs(start["position"][:, 1] - 5) < 0.5]) / 1e5, 1e-6)
judge(ROW, "rows of water and gas: methane balance", abs(run.balance["methane_error"][-1]), 1e-14)

# ---------------------------------------------------------------- a border that settles into the cells
SWAPPED = [
    "-grid_lower", "0 m,0 m", "-grid_upper", "6 m,1 m", "-grid_cells", "12,2", "-region_lower_upper", "3 m,1 m", "-region_upper_lower", "3 m,0 m", "-region_upper_upper", "5.8 m,1 m",
    "-bc_base_axis", "x", "-bc_near_axis", "y", "-bc_far_axis", "y", "-bc_burden_side", "right", "-bc_well_side", "bottom"]  # fmt: skip
HIGHER = ["-region_lower_pressure", "18 MPa", "-region_upper_pressure", "18 MPa", "-bc_burden_normal", "18 MPa", "-bc_well_pressure_ramp", "18 MPa,11 MPa,0 d,1 d"]
BORDER = lambda y: ["-region_lower_upper", f"1 m,{y} m", "-region_upper_lower", f"0 m,{y} m", "-bc_well_to", f"{y} m"]
settled = lambda *options, **more: Run.of_case(CASE, "-quiet", *options, **more)
lowest = lambda run, day: np.min(run.snapshot(day * 86400)["p_w"]) / 1e6
steps = lambda run: float(len(run.balance["time_s"]))
runs = {y: settled(*BORDER(y)) for y in (3, 3.2)}
table(("border at", "lowest p_w at 3 d (MPa)", "at 30 d", "steps"), [(f"{y} m", lowest(r, 3), lowest(r, 30), steps(r)) for y, r in runs.items()])
for y, most in ((3, 82), (3.2, 75)):
    judge(ROW, f"border at {y} m: p_w below that of the drain at 3 days", 4 - lowest(runs[y], 3), 0.15, unit="MPa")
    judge(ROW, f"border at {y} m: p_w below that of the drain at 30 days", 4 - lowest(runs[y], 30), 0.05, unit="MPa")
    judge(ROW, f"border at {y} m: steps", steps(runs[y]), most)
    judge(ROW, f"border at {y} m: water balance", abs(runs[y].balance["water_error"][-1]), 1e-13)
plain = runs[3]
last = lambda run: run.snapshots()[-1][1]
# without inertia velocities of particles are means of their nodes' (355)
(_, nodes), (_, bodies) = plain.snapshots("grid")[-1], plain.snapshots()[-1]
at = [int(v) for v in np.floor(bodies["position"][:, 1] / 0.5)], bodies["position"][:, 1] / 0.5 % 1
column = np.mean(nodes["v_s"].reshape(13, 3, 2)[..., 1], axis=1)
between = column[at[0]] * (1 - at[1]) + column[np.array(at[0]) + 1] * at[1]
judge(ROW, "quasi-static: velocities of particles against those of their nodes", largest_difference(bodies["v_s"][:, 1], between), 0.3)
judge(ROW, "axes swapped: p_w", largest_difference(np.sort(last(settled(*SWAPPED))["p_w"], axis=0), np.sort(last(plain)["p_w"], axis=0), 7e6), 1e-9)
judge(ROW, "7 MPa more everywhere: p_w", largest_difference(last(settled(*HIGHER))["p_w"] - 7e6, last(plain)["p_w"], 7e6), 1e-2)
judge(ROW, "2 ranks against 1: p_w", largest_difference(last(settled(ranks=2))["p_w"], last(plain)["p_w"], 7e6), 1e-9)
# where nothing settles what has been evened out stays so, or each step would undo the last
judge(ROW, "a thin layer 1e8 times as permeable: steps", steps(Run.of_case(CASE.with_name("thin_layer.yaml"), "-quiet")), 73)
out = scratch() / "out"
Run.of_case(CASE, "-quiet", "-stepper_max_steps", "40", out=out, exit_code=(0, 3, 4))
Run.of_case(CASE, "-quiet", "-restart", out / "checkpoint.h5", out=out)
names = different(plain.out, out)
check_true("cut in two by a restart: the same bit for bit", not names, ", ".join(names[:5]))
finish()
