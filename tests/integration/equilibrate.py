#!/usr/bin/python3
"""-restart_as_initial: a column settles under its weight, and another scene begins with what it has become.

Two layers under the sea settle from no stress (quasi-static).  From their state: the same scene stays at rest; a drain
opened at the foot gives what a second stage of one run gives, on 1 and 2 ranks, in implicit steps and in hybrid, which
come together as the grid is refined; balances are those of the new run.  What the state is tied to must agree and is named when it does not.  Hydrate that bears a
stress of its own keeps it (340)."""
import shutil
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import different, hashes  # noqa: E402
from common import Run, binary, check, check_true, finish, launch, scratch, table  # noqa: E402

FOLDER = scratch()
SETTLE, END = 200.0, 1.0  # s
BODY = """
grid: {lower: [0 m, 0 m], upper: [1 m, 6 m], cells: [2, 12]}
fields: hm
gravity: [0 m/s^2, -9.81 m/s^2]
materials: [clay, sand]
mat:
  clay: {porosity: 0.5, solid: {density: 2700 kg/m^3}, permeability: {k0: 2e-11 m^2, hydrate_law: none}, elasticity: {E0: 20 MPa, nu: 0.3}}
  sand: {like: clay, porosity: 0.4, permeability: {k0: 1e-11 m^2}, elasticity: {E0: 50 MPa}}
regions: [deep, shallow]
region:
  deep: {lower: [0 m, 0 m], upper: [1 m, 2 m], material: sand, pressure: 0.2 MPa, hydrostatic: yes, datum: 5 m}
  shallow: {like: deep, lower: [0 m, 2 m], upper: [1 m, 5 m], material: clay}
bc:
  closed: {type: roller, axis: y, position: 0 m}
  plate: {type: roller, axis: y, position: 0 m, holds: skeleton}
  left: {type: roller, axis: x, position: 0 m}
  right: {type: roller, axis: x, position: 1 m}
  sea: {type: traction, side: top, normal: 0.2 MPa}
  open: {type: pressure, side: top, pressure: 0.2 MPa}
  drain: {type: pressure, side: bottom, pressure: {ramp: [0.249 MPa, 0.2 MPa, 0 s, 0.1 s]}, clock: stage}
probes: [middle]
probe: {middle: {at: [0.5 m, 2.5 m]}}
"""
UNUSED = {"settle": ("plate", "drain"), "drain": ("closed",)}  # a boundary must be listed to be described


def scene(name, unused, rest):
    body = "\n".join(line for line in BODY.splitlines() if line.split(":")[0].strip() not in unused)
    listed = [b for b in ("closed", "plate", "left", "right", "sea", "open", "drain") if b not in unused]
    path = FOLDER / f"{name}.yaml"
    path.write_text(f"title: {name}\n{body}\nboundaries: [{', '.join(listed)}]\n{rest}")
    return path


FIXED = "inertia: no\nstepper: {adapt: no, dt: 0.05 s}\n"
settle = scene("settle", UNUSED["settle"], f"time: {{end: {SETTLE} s}}\ninertia: no\nstepper: {{adapt: no, dt: 20 s}}\n")
rest = scene("rest", UNUSED["settle"], f"time: {{end: {END} s}}\noutput: {{times: [0 s, {END} s]}}\n{FIXED}")
drain = scene("drain", UNUSED["drain"], f"time: {{end: {END} s}}\noutput: {{times: [0 s, {END} s]}}\n{FIXED}")
both = scene("both", (), f"""stages: [settle, drain]
stage:
  settle: {{end: {SETTLE} s, boundaries_off: [plate, drain], stepper: {{dt: 20 s}}}}
  drain: {{end: {SETTLE + END} s, boundaries_off: [closed], reset_displacement: yes}}
output: {{times: [{SETTLE} s, {SETTLE + END} s]}}\n{FIXED}""")  # fmt: skip
TIGHT = ("-newton_tol_residual", 1e-11, "-newton_tol_update", 1e-10)

settled = Run.of_case(settle, *TIGHT)
STATE = settled.out / "checkpoint.h5"
check_true("a body without stress is warned of", "unstressed body" in settled.output)


def begun(case, *options, **keywords):
    return Run.of_case(case, "-restart_as_initial", STATE, *TIGHT, *options, **keywords)


def ends(run):
    return run.snapshots()[0][1], run.snapshots()[-1][1]


# ---------------------------------------------------------------- what it begins with
run = begun(rest)
first, last = ends(run)
with h5py.File(STATE) as file:
    state = {name: item[()] for name, item in file["particles"].items()}
for name in ("position", "stress", "p_w", "volume", "mass_water", "deformation_gradient", "initial_position"):
    check_true(f"begins with the {name} of the state", np.array_equal(first[name].squeeze(), state[name].squeeze()))
check_true("initial stress and pressure are those of the state",
           np.array_equal(first["stress_initial"], state["stress"]) and np.array_equal(first["p_w_initial"].squeeze(), state["p_w"]))  # fmt: skip
sunk = np.abs(state["displacement"]).max()
check("it had sunk (m)", sunk, (2e-3, 1e-2))
check("displacements begin at 0", np.abs(first["displacement"]).max(), 0)
check("at rest: further displacement over that", np.abs(last["displacement"]).max() / sunk, 1e-7)
check("at rest: pressure over the weight", np.abs(last["p_w"] - first["p_w"]).max() / 5e4, 1e-7)
check_true("no warning of an unstressed body; the state is named", "unstressed" not in run.output and f"starts from the state of {STATE}" in run.output)

# ---------------------------------------------------------------- a drain is opened
staged = ends(Run.of_case(both, *TIGHT))
drained = begun(drain)
rows = []


def compare(what, run, bar, reference=staged):
    begin, end = ends(run)
    u, p = (end[k] for k in ("displacement", "p_w"))
    scale = np.abs(reference[1]["displacement"]).max(), np.abs(reference[1]["p_w"] - reference[0]["p_w"]).max()
    worst = [np.abs(u - reference[1]["displacement"]).max() / scale[0], np.abs(p - reference[1]["p_w"]).max() / scale[1]]
    rows.append((what, *worst))
    check(f"{what}: displacement and pressure", max(worst), bar)


compare("against a second stage of one run", drained, 1e-8)
compare("begun on 2 ranks", begun(drain, ranks=2), 1e-8)
short = ("-stepper_type", "hybrid", "-stepper_adapt", "yes", "-inertia", "yes")
hybrid = begun(drain, *short)
in_stage = [o if k % 2 else o.replace("-", "-stage_drain_", 1) for k, o in enumerate(short)]
compare("hybrid against a second stage in hybrid", hybrid, 1e-8, ends(Run.of_case(both, *TIGHT, *in_stage)))
apart = []
for cells in ("2,12", "2,24"):
    finer = ("-grid_cells", cells, *TIGHT)
    begin = ("-restart_as_initial", Run.of_case(settle, *finer).out / "checkpoint.h5", *finer)
    implicit, local = (ends(Run.of_case(drain, *begin, *o))[1] for o in (("-stepper_dt", "5e-3"), short))
    apart.append([np.abs(local[k] - implicit[k]).max() / np.abs(implicit[k] - implicit[f"{k}_initial"] if k == "p_w" else implicit[k]).max()
                  for k in ("displacement", "p_w")])  # fmt: skip
    rows.append((f"hybrid against implicit steps, {cells} cells", *apart[-1]))
for k, name in enumerate(("displacement", "pressure")):
    check(f"hybrid and implicit steps come together: {name}, half the cells", apart[0][k] / apart[1][k], (3, 6))
    check(f"hybrid against implicit steps: {name}, fine", apart[1][k], 0.02)
still = ends(begun(rest, *short, "-time_end", "0.1 s", "-output_times", "0 s,0.1 s"))
check("hybrid at rest: displacement over what had sunk", np.abs(still[1]["displacement"]).max() / sunk, 1e-6)
for name, r in (("implicit", drained), ("hybrid", hybrid)):
    b = r.balance
    lost = state["mass_water"].sum() - ends(r)[1]["mass_water"].sum()
    check(f"{name}: water that left, from this run's begin on", abs(b["water_out_kg"][-1] / lost - 1), 1e-6)
    check(f"{name}: balance of water over what the body holds", np.abs(b["water_error"]).max(), 1e-9)
    check(f"{name}: balance of mechanical work over that of gravity", abs(b["energy_remainder_J"][-1] / b["gravity_work_J"][-1]), 0.02)
    check_true(f"{name}: its clock starts at 0", b["time_s"][0] < END / 2 and abs(b["time_s"][-1] - END) < 1e-9)
table(["begun with the state", "displacement", "pressure"], rows)

# ---------------------------------------------------------------- and restarted
out = scratch() / "cut"
begun(drain, "-stepper_max_steps", 7, out=out)
Run.of_case(drain, *TIGHT, "-restart", out / "checkpoint.h5", out=out)
check_true("cut in two and restarted: the same bit for bit", not different(drained.out, out), different(drained.out, out)[:5])

# ---------------------------------------------------------------- hydrate's own stress
cycles = Path(__file__).parent / "cases" / "bonds.yaml"
loaded = Run.of_case(cycles, "-time_end", "0.3 s", "-output_times", "0.3 s", "-stepper_dt", "0.05 s", "-stepper_adapt", "no")
after = Run.of_case(cycles, "-restart_as_initial", loaded.out / "checkpoint.h5", "-time_end", "0.01 s", "-stepper_dt", "0.01 s",
                    "-output_times", "0 s", "-bc_load_normal_ramp", "5.5 MPa,6 MPa,0 s,1 s")  # fmt: skip
first = after.snapshots()[0][1]
own = first["stress_hydrate"]
check("hydrate bears a stress (Pa)", np.abs(own).max(), (1e4, 1e7))
check("initial stress is what the rest bears", np.abs(first["stress"][:, :4] - own - first["stress_initial"][:, :4]).max(), 0)


# ---------------------------------------------------------------- refused by name
def refused(what, words, *options, case=rest, out=None):
    out = scratch() / "new" if out is None else out
    before = hashes(out)
    done = launch(binary(), case, *options, out=out)
    check_true(f"refused: {what}", done.returncode == 2 and all(w in done.stdout for w in words) and hashes(out) == before, done.stdout.strip()[-300:])


AS = ("-restart_as_initial", STATE)
refused("another grid", ["grid_cells is [2, 12] in it but [4, 12] here"], *AS, "-grid_cells", "4,12")
refused("another region", ["region_shallow_upper is [1 m, 5 m]", "[1 m, 4 m]"], *AS, "-region_shallow_upper", "1 m,4 m")
refused("other particles", ["region_deep_particles_per_cell is [2, 2]"], *AS, "-region_deep_particles_per_cell", "3,3")
refused("another porosity", ["material of region shallow: porosity is 0.5 in it but 0.45 here"], *AS, "-mat_clay_porosity", "0.45")
refused("a region of another material", ["material of region deep: porosity is 0.4"], *AS, "-region_deep_material", "clay")
refused("other fields", ["fields is 'solid,water' in it but 'solid,water,heat' here"], *AS, "-fields", "thm", "-region_deep_temperature", "4 degC",
        "-region_shallow_temperature", "4 degC", "-mat_clay_solid_heat_capacity", "800 J/(kg K)", "-mat_clay_solid_conductivity", "2 W/(m K)")  # fmt: skip
refused("another history", ["plasticity_law is none in it but mohr_coulomb here"], *AS, "-mat_clay_plasticity_law", "mohr_coulomb",
        "-mat_clay_plasticity_cohesion_max", "1 MPa", "-mat_clay_plasticity_friction_peak", "30 deg")  # fmt: skip
refused("two beginnings", ["-restart_as_initial begins another one"], *AS, "-restart", STATE)
copy = scratch() / "copy"
shutil.copytree(settled.out, copy)
refused("its own folder", ["write over it"], "-restart_as_initial", copy / "checkpoint.h5", out=copy, case=settle)
broken = FOLDER / "broken.h5"
broken.write_bytes(STATE.read_bytes()[:-100])
refused("a damaged file", ["bytes instead of"], "-restart_as_initial", broken)
finish()
