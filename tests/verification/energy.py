#!/usr/bin/env python3
"""The balance of mechanical energy: each term where it is known, and what is left.

It is (90), the columns of balance.csv, by implicit and explicit integrators."""
from pathlib import Path

import numpy as np

from _integrators import adaptive, consolidation, fixed
from _shear_block import roof, saturated
from common import Run, check_true, finish, judge, order, scratch, table

CASES = Path(__file__).parent / "cases"
FOOTING = Path(__file__).resolve().parents[1] / "integration" / "cases" / "footing.yaml"
COLUMNS = ("elastic_energy_J", "plastic_work_J", "plastic_heat_J", "gravity_work_J", "load_work_J", "plate_work_J", "pressure_work_J", "drag_work_J",
           "damping_work_J", "elastic_released_J", "kinetic_lost_J", "energy_remainder_J")  # fmt: skip
HYBRID = ("-stepper_type", "hybrid", "-stepper_adapt", "yes", "-inertia", "yes")
TIGHT = ("-newton_tol_residual", 1e-10, "-newton_tol_update", 1e-8, "-ksp_rtol", 1e-8)
rows = []


def go(name, kind, case, *options, **keywords):
    """The run, and its last row in short."""
    run = Run.of_case(case, "-quiet", *(HYBRID if kind == "hybrid" else ("-stepper_type", kind)), *options, **keywords)
    b = {k.rsplit("_", 1)[0]: v[-1] for k, v in run.balance.items() if k.endswith("_J")}
    rows.append([name, kind, *(b[k.rsplit("_", 1)[0]] for k in ("kinetic_energy_J", *COLUMNS))])
    return run, b


def falls():
    """Gravity is all: to round-off, but for what backward Euler takes, m g^2 dt T/2."""
    for kind in ("sdirk2", "euler", "hybrid"):
        run, b = go("free fall", kind, CASES / "falling.yaml")
        expected = b["gravity_work"] * (run.balance["dt_s"][-1] / (0.8 + run.balance["dt_s"][-1]) if kind == "euler" else 0.0)
        judge("energy", f"free fall, {kind}: gravity, kinetic", abs(b["gravity_work"] - b["kinetic_energy"] - expected) / b["kinetic_energy"], 1e-11)
        judge("energy", f"free fall, {kind}: kinetic energy lost", abs(b["kinetic_lost"] - expected) / b["kinetic_energy"], 1e-11)
        judge("energy", f"free fall, {kind}: remainder", abs(b["energy_remainder"]) / b["kinetic_energy"], 1e-10)
        P = run.balance["kinetic_power_W"][-1] / (b["kinetic_energy"] * 2 / 0.8)
        judge("energy", f"free fall, {kind}: power", abs(P - 1), 0.03)  # hybrid: the mean over a burst


def flies():
    """A block that the sea presses all of a sudden, flying through cells: where it started in a cell does not show, and its velocity is gravity's (454)."""
    places = []
    for name, shift in (("0.15 of a cell", 0.03), ("0.5", 0.1)):
        run, b = go(f"flying block, {name}", "hybrid", CASES / "flying.yaml", "-region_block_lower", f"{0.4 + shift:g} m, {0.4 + shift:g} m",
                    "-region_block_upper", f"{1.4 + shift:g} m, {1.1 + shift:g} m")  # fmt: skip
        check_true(f"flying block, {name}: no step refused", ", 0 refused" in run.output, run.output[-800:])
        last = run.snapshots()[-1][1]
        places.append((last["volume"].sum(), last["v_s"][:, 0].mean()))
        judge("energy", f"flying block, {name}: kinetic energy over gravity's work", abs(b["kinetic_energy"] / b["gravity_work"] - 1), 3e-5)  # it rings
    for k, (what, bar) in enumerate((("volume", 2e-5), ("velocity", 1e-6))):
        judge("energy", f"flying block: {what}, 0.15 against 0.5 of a cell", abs(places[1][k] / places[0][k] - 1), bar)


def rings():
    """A block whose surface crosses a line of the grid in every period, some 200 of them (454): it swings on, with a quarter of the step alike, and nothing is made of energy."""
    swings = []
    for cfl in ("0.8", "0.2"):
        run, b = go(f"ringing block, stepper_cfl {cfl}", "hybrid", CASES / "ringing.yaml", "-stepper_cfl", cfl)
        u = run.probe("top")["u_y_m"]
        swings.append(np.ptp(u[-len(u) // 10:]) / np.ptp(u[: len(u) // 10]))
        most = (run.balance["elastic_energy_J"] + run.balance["kinetic_energy_J"]).max()
        judge("energy", f"ringing block, stepper_cfl {cfl}: remainder, of the most that it holds", abs(b["energy_remainder"]) / most, 0.05)
        judge("energy", f"ringing block, stepper_cfl {cfl}: its last swings over its first", swings[-1], (0.5, 1.02))
    judge("energy", "ringing block: ... with a quarter of the step over with the whole", swings[1] / swings[0], (0.9, 1.1))


WELL = """title: a well in sand that settles
fields: FIELDS
geometry: axisymmetric
inertia: no
grid: {lower: [0.1 m, 0 m], upper: [8.1 m, 1 m], cells: [16, 2]}
materials: [sand]
mat_sand: {porosity: 0.4, solid: {density: 2650 kg/m^3}, permeability: {k0: 1e-12 m^2}, elasticity: {E0: 100 MPa, nu: 0.3}FLUIDS}
regions: [sand]
region_sand: {lower: [0.1 m, 0 m], upper: [8.1 m, 1 m], material: sand, pressure: 5 MPa, temperature: 10 degC, STATE}
boundaries: [casing, rim, base, roof, well, far]
bc_casing: {type: roller, axis: x, position: 0.1 m, holds: skeleton}
bc_rim: {type: roller, axis: x, position: 8.1 m, holds: skeleton}
bc_base: {type: roller, axis: y, position: 0 m}
bc_roof: {type: roller, axis: y, position: 1 m}
bc_well: {type: pressure, side: left, pressure: {ramp: [5 MPa, 4 MPa, 0 s, 100 s]}}
bc_far: {type: pressure, side: right, initial: yes}
time: {end: 300 s}
stepper: {tol: 1e-3}
"""


def wells():
    """A well about an axis takes what pressure gives as drag, that of its wall (197) included: of one fluid and of two."""
    case = scratch() / "well.yaml"
    two = ", retention: {p0: 20 kPa, m: 0.5, Swr: 0.2, Sgr: 0.02}, relperm: {nw: 4, ng: 2}"
    for fields, state, fluids in (("[solid, water]", "Sh: 0, Sw: 1, Sg: 0", ""), ("[solid, water, gas]", "Sh: 0, Sw: 0.6, Sg: 0.4", two)):
        case.write_text(WELL.replace("FIELDS", fields).replace("STATE", state).replace("FLUIDS", fluids))
        _, b = go(f"well, {fields}", "sdirk2", case)
        judge("energy", f"well, {fields}: remainder over the work of drag", abs(b["energy_remainder"]) / b["drag_work"], 1e-3)


def waves():
    """A pulse in a dry bar: nothing is dissipated, and what is left falls with the step."""
    found = []
    for kind, low in (("sdirk2", 1.6), ("euler", 0.8), ("hybrid", 0.8)):
        left, sizes = [], (26, 52, 104)
        for n in sizes:
            run, b = go(f"bar wave, {n} cells", kind, CASES / "bar.yaml", "-grid_cells", f"{n},1", "-stepper_dt", f"{26e-3 / n} s",
                        *(TIGHT if kind != "hybrid" else ()))  # fmt: skip
            held = b["kinetic_energy"] + b["elastic_energy"]
            left.append(np.max(np.abs(run.balance["energy_remainder_J"] + run.balance["kinetic_lost_J"])) / held)
        orders = order(1 / np.array(sizes), left)
        found += [[kind, n, e] for n, e in zip(sizes, left)]
        judge("energy", f"bar wave, {kind}: order of what is left", orders[-1], (low, 4))
        judge("energy", f"bar wave, {kind}: what is left, share of the energy", left[-1], 0.2 if kind == "euler" else 0.02)
    table(["integrator", "cells", "lost and left, share"], found)


def consolidates():
    """Load work beyond the pressure of the pores is half stored and half dissipated; all of it is found again."""
    elastic = 3e3**2 * 10.0 * 0.2 / (2 * 14.516e6 * 0.7 / (1.3 * 0.4))
    for kind, bar in (("sdirk2", 1e-4), ("hybrid", 3e-4)):  # hybrid: what (41) moves of the flow
        run = consolidation(Kw=2.2e9, end=40.0, every=40.0, cells=(13, 1)).run(*(adaptive(kind) if kind == "hybrid" else fixed(kind, 0.1)), cells=(13, 1))
        b = {k: v[-1] for k, v in run.balance.items()}
        rows.append(["consolidation", kind, *(b[k] for k in ("kinetic_energy_J", *COLUMNS))])
        size = b["drag_work_J"] + b["elastic_energy_J"]
        judge("energy", f"consolidation, {kind}: elastic energy against q^2 V/2M", abs(b["elastic_energy_J"] / elastic - 1), 0.01)
        judge("energy", f"consolidation, {kind}: given less kept and dissipated", abs((b["load_work_J"] + b["pressure_work_J"]) / size - 1), bar)
        judge("energy", f"consolidation, {kind}: remainder", abs(b["energy_remainder_J"]) / size, bar)


def drains():
    """On the way, with 1 MPa on either side of the load: works of what balances must be those of one motion."""
    run = consolidation(cells=(13, 1)).run(*adaptive("hybrid"), cells=(13, 1))
    b = {k: v[-1] for k, v in run.balance.items()}
    judge("energy", "draining, hybrid: remainder", abs(b["energy_remainder_J"]) / (b["drag_work_J"] + b["elastic_energy_J"]), 1e-3)


PRESSED = ("-inertia", "no", "-stepper_dt", "2 ms", "-time_end", "0.12 s", "-output_times", "0.12 s", "-output_probe_every", "10 ms", "-bc_plate_rough", "no", "-bc_plate_velocity", "-0.1 m/s",
           "-mat_ground_plasticity_law", "mohr_coulomb", "-mat_ground_plasticity_cohesion_max", "20 kPa", "-mat_ground_plasticity_flow", "mohr_coulomb",
           "-boundaries", "base,plate,left", "-bc_left_type", "roller", "-bc_left_axis", "x", "-bc_left_position", "0 m", "-mat_ground_plasticity_friction_peak", "0 deg", "-mat_ground_plasticity_dilation_max", "0 deg", "-bc_base_type", "roller",
           "-stabilisation_ghost_penalty", "0")  # fmt: skip


def yields():
    """At a steady yield all that the plate gives is dissipated."""
    for kind in ("sdirk2", "euler", "hybrid"):
        options = () if kind != "hybrid" else ("-stepper_damping", "0.1")
        run, b = go("squeezed block", kind, CASES / "plate_block.yaml", *PRESSED, *(HYBRID if kind == "hybrid" else ()), *options)
        half = len(run.balance["time_s"]) // 2
        given, gone = (run.balance[k][-1] - run.balance[k][half] for k in ("plate_work_J", "plastic_work_J"))
        gone += run.balance["damping_work_J"][-1] - run.balance["damping_work_J"][half]
        stored = run.balance["elastic_energy_J"][-1] - run.balance["elastic_energy_J"][half]
        judge("energy", f"steady yield, {kind}: dissipated over the plate's work", gone / given, (0.97, 1.03))
        judge("energy", f"steady yield, {kind}: stored", abs(stored) / given, 0.02)
        judge("energy", f"steady yield, {kind}: remainder", abs(b["energy_remainder"]) / b["plate_work"], 0.02)


def plates():
    """A block under a rough plate, and a footing that softens: small strain, small remainder."""
    short = ("-time_end", "0.1 s", "-output_times", "0.1 s", "-stepper_dt", "1 ms")
    for kind in ("sdirk2", "euler", "hybrid"):
        run, b = go("plate", kind, CASES / "plate_block.yaml", *short)
        judge("energy", f"plate, {kind}: remainder", abs(b["energy_remainder"]) / b["plate_work"], {"sdirk2": 0.008, "euler": 0.02, "hybrid": 0.002}[kind])
    for kind in ("sdirk2", "hybrid"):
        run, b = go("footing", kind, FOOTING)
        judge("energy", f"footing, {kind}: remainder", abs(b["energy_remainder"]) / b["load_work"], 0.01)
        judge("energy", f"footing, {kind}: heat, share of the plastic work", abs(b["plastic_heat"] / b["plastic_work"] - 0.7), 1e-12)
        two, b2 = go("footing, 2 ranks", kind, FOOTING, *(TIGHT if kind == "sdirk2" else ()), ranks=2)
        one, b1 = (run, b) if kind == "hybrid" else go("footing, tight", kind, FOOTING, *TIGHT)
        off = max(abs(b2[k] - b1[k]) for k in b1 if "heat" not in k) / b1["load_work"]
        judge("energy", f"footing, {kind}: 2 ranks against 1", off, 1e-7)
    run, b = go("footing, damped", "hybrid", FOOTING, "-stepper_damping", "0.3")
    judge("energy", "footing, damped hybrid: remainder", abs(b["energy_remainder"]) / b["load_work"], 0.01)
    judge("energy", "footing, damped hybrid: what damping takes", b["damping_work"] / b["load_work"], (1e-3, 0.2))


def around():
    """A constant pressure outside and in the pores does work, but leaves as little."""
    for kind in ("sdirk2", "hybrid"):
        left = []
        for p in (0.1e6, 10e6):
            run, b = go(f"sheared in {p / 1e6:g} MPa", kind, CASES / "shear_block.yaml", "-fields", "hm", "-region_block_pressure", f"{p} Pa",
                        "-mat_soft_water_ref_pressure", f"{p} Pa", "-mat_soft_water_bulk_modulus", "100 MPa", "-ambient_pressure", f"{p} Pa",
                        "-stepper_dt", "0.05 s", "-time_end", "0.5 s", "-output_probe_every", "0.5 s", "-bc_shear_shear_ramp", "0 Pa,-0.1 MPa,0 s,0.4 s",
                        *(TIGHT if kind != "hybrid" else ()))  # fmt: skip
            left.append(b)
        judge("energy", f"sheared in 10 and 0.1 MPa, {kind}: remainders apart", abs(left[1]["energy_remainder"] - left[0]["energy_remainder"]) / left[0]["elastic_energy"], 1e-8)
        judge("energy", f"sheared in 10 MPa, {kind}: remainder", abs(left[1]["energy_remainder"]) / left[1]["elastic_energy"], 0.03)


def hydrate():
    """Hydrate goes, and the stiffness with it, or with the stress it bore: what it takes is counted."""
    for kind in ("sdirk2", "hybrid"):
        for change, bar in (("both", 0.1), ("bonds", 0.1)):
            run, b = go(f"dissociating, {change}", kind, CASES / "block.yaml", "-mat_sand_elasticity_stiffness_change", change)
            judge("energy", f"dissociating block, {change}, {kind}: remainder over the released", abs(b["energy_remainder"]) / b["elastic_released"], bar)
            judge("energy", f"dissociating block, {change}, {kind}: released over the elastic energy", b["elastic_released"] / b["elastic_energy"], (0.005, 0.1))


def rigid():
    """Without mechanics no such columns."""
    run = Run.of_case(CASES / "diffusion.yaml", "-quiet", "-stepper_max_steps", "1")
    check_true("a rigid body has no mechanical balance", not set(COLUMNS) & set(run.balance))


def layers():
    """A sheared block, open all around, of which the upper part is a ten-thousandth as permeable: no drag but that of what each layer's water does (313)."""
    _, b = go("layers", "hybrid", CASES / "shear_block.yaml", "-bc_shear_shear_ramp", "0 Pa,-0.1 MPa,0 s,0.1 s", "-time_end", "0.12 s", "-stepper_dt", "2e-5 s",
              *saturated(0.1), *roof("1e-14 m^2", 0.53))  # fmt: skip
    judge("energy", "sheared layers, hybrid: remainder", abs(b["energy_remainder"]) / b["load_work"], 0.015)


if __name__ == "__main__":
    falls()
    flies()
    rings()
    waves()
    consolidates()
    drains()
    yields()
    plates()
    around()
    hydrate()
    wells()
    rigid()
    layers()
    table(["scene", "integrator", *(k.replace("_energy_J", "").replace("_J", "") for k in ("kinetic_energy_J", *COLUMNS))], rows)
    finish()
