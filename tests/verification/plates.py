#!/usr/bin/env python3
"""Rigid plates that move with the body: confined compression against its closed form, forces, lift-off.

Rigid plates that move with the body's side: confined compression to half the height against its closed form, a prescribed
force, rough plates, lift-off, the fluid around the body, ranks, restarts, and how a plate ends.

Stress follows the logarithmic strain, so in confined compression the stress is -M ln(1 - x) exactly, with the pressure of the
enclosed water p = p_0 - K ln((J - 1 + phi)/phi) when nothing can leave.
"""
import re
from pathlib import Path

import numpy as np

from common import Run, binary, check, check_true, finish, judge, launch, scratch

ROW = "plates"
CASES = Path(__file__).parent / "cases"
COLUMN, BLOCK = CASES / "plates.yaml", CASES / "plate_block.yaml"
M, PHI, K_W, P0, WIDTH = 12e6, 0.6, 100e6, 1e6, 0.2
STIFF = ("-bc_plate_stiffness", "1e4")
HYBRID = ("-inertia", "yes", "-stepper_type", "hybrid", "-stepper_adapt", "yes", "-stepper_damping", "0.05")


def edited(case, *edits):
    """A copy of a case with (old, new) replaced."""
    text = case.read_text()
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new)
    path = scratch() / "case.yaml"
    path.write_text(text)
    return path


def prescribed(case, words, *more):
    """The case with another motion of its plate."""
    return edited(case, (re.search(r"velocity: \S+ m/s", case.read_text()).group(), words), *more)


def meters(run):
    m = run.csv("meters.csv")
    return m["time_s"], m["plate.position_m"], m["plate.force_N"], m["plate.stress_Pa"]


def drained(x):
    return -M * np.log(1 + x)


def undrained(x):
    return drained(x) + P0 - K_W * np.log((x + PHI) / PHI)


def off(run, exact, area=WIDTH, start=0.0, bar=1e-12):
    """Largest error of the plate's stress after `start` (m), relative; the force is stress x area to round-off."""
    t, x, force, stress = meters(run)
    late = x < -start
    check("force less stress x area, relative", np.max(np.abs(force[late] / (stress[late] * area) - 1)), bar)
    return np.max(np.abs(stress[late] / exact(x[late]) - 1))


def confined():
    ring = np.pi * WIDTH**2
    for what, options, area in (("sdirk2", (), WIDTH), ("euler", ("-stepper_type", "euler"), WIDTH),
                                ("about an axis", ("-geometry", "axisymmetric"), ring)):  # fmt: skip
        run = Run.of_case(COLUMN, *STIFF, *options)
        judge(ROW, f"confined compression to 50 %, dry, {what}: stress under the plate", off(run, drained, area), 1e-4)
    wet = edited(COLUMN, ("fields: [solid]", "fields: [solid, water]"), ("2.2 GPa", "100 MPa"))
    for what, options, area in (("plane", (), WIDTH), ("about an axis", ("-geometry", "axisymmetric"), ring)):
        run = Run.of_case(wet, *STIFF, "-bc_plate_velocity", "-0.3 m/s", *options)
        judge(ROW, f"closed plate on a saturated column, to 30 %, {what}: total stress", off(run, undrained, area, bar=1e-6), 1e-4)
        check("closed plate: water that left, kg", np.max(np.abs(run.balance["water_out_kg"])), 0.0)
    porous = edited(wet, ("velocity: -0.5 m/s", "velocity: -5e-7 m/s, holds: skeleton"), ("right, plate]", "right, plate, drain]"),
                    ("\ntime:", "  drain: {type: pressure, side: top, initial: yes}\n\ntime:"), ("{end: 1 s}", "{end: 1e6 s}"),
                    ("20 ms", "2e4 s"))  # fmt: skip
    run = Run.of_case(porous, *STIFF)
    judge(ROW, "porous plate, slow, to 50 %: total stress", off(run, lambda x: drained(x) + P0), 5e-4)
    run = Run.of_case(COLUMN, *HYBRID, *STIFF, "-bc_plate_velocity", "-0.05 m/s", "-time_end", "10 s", "-output_probe_every", "0.5 s")
    judge(ROW, "confined compression to 50 %, dry, hybrid, from 15 % on: stress under the plate", off(run, drained, start=0.149), 1e-3)
    run = Run.of_case(COLUMN)
    judge(ROW, "the same at the default stiffness, 10 cells", off(run, drained), 2.5e-3)


def prescribed_force():
    """The force that a motion needed, prescribed, gives the motion back."""
    for what, case, bar in (("column", COLUMN, 1e-9), ("rough plate on a block", BLOCK, 1e-5)):
        given = Run.of_case(case)
        t, x, force, _ = meters(given)
        words = ", ".join(f"{a!r} s, {float(b)!r} N" for a, b in zip(t, force))
        _, y, got, _ = meters(Run.of_case(prescribed(case, f"force: {{table: [{words}]}}")))
        # first stages lie between the points of the table, which the ghost penalty of the block sees
        judge(ROW, f"prescribed force gives the motion back, {what}", np.max(np.abs(y - x)) / np.max(np.abs(x)), bar)
        check(f"force as prescribed, {what}", np.max(np.abs(got[1:] / force[1:] - 1)), 1e-9)
    ramp = "force: {ramp: [0 N, 5e5 N, 0 s, 4 s]}"
    run = Run.of_case(prescribed(COLUMN, ramp), *HYBRID, *STIFF, "-time_end", "4 s", "-output_probe_every", "0.5 s")
    t, x, force, stress = meters(run)
    check("hybrid: force as prescribed", np.max(np.abs(force[1:] / (5e5 * t[1:] / 4) - 1)), 1e-9)
    judge(ROW, "prescribed force, hybrid: position at 2.5 MPa", abs(x[-1] / np.expm1(-2.5e6 / M) - 1), 5e-3)


def rough():
    """A block between rough plates: against a fine grid, smooth over grid lines, whatever surrounds it."""
    t, x, fine, _ = meters(Run.of_case(BLOCK, "-grid_cells", "24,20"))
    run = Run.of_case(BLOCK)
    force = meters(run)[2]
    judge(ROW, "rough plate, 25 %: force at 8 cells against 16", np.max(np.abs(force[1:] / fine[1:] - 1)), 2e-3)
    corner = run.probe("corner")["u_x_m"]
    check("rough plate: its corner stays, m", np.max(np.abs(corner)), 0.002)
    smooth = Run.of_case(BLOCK, "-bc_plate_rough", "no").probe("corner")["u_x_m"]
    check("... under a smooth one it moves, m", smooth[-1], (0.045, 0.065))
    t, x, y, _ = meters(Run.of_case(BLOCK, "-stepper_dt", "10 ms", "-bc_plate_velocity", "-0.5 m/s"))
    s = y[4:] / x[4:]
    judge(ROW, "ripple of the force over four grid lines", np.max(np.abs(s / np.polyval(np.polyfit(x[4:], s, 6), x[4:]) - 1)), 3e-3)
    within = ("-ambient_pressure", "10 MPa", "-region_block_stress", "-10 MPa,-10 MPa,-10 MPa,0 Pa,0 Pa,0 Pa")
    sea = meters(Run.of_case(BLOCK, *within))[2]
    judge(ROW, "rough plate: force with 10 MPa all around", np.max(np.abs(sea[1:] / force[1:] - 1)), 1e-6)
    slow = ("-bc_plate_velocity", "-0.0625 m/s", "-time_end", "4 s", "-output_times", "4 s", "-output_probe_every", "0.4 s")
    hybrid = Run.of_case(BLOCK, *HYBRID, *slow)
    judge(ROW, "rough plate, 25 %: hybrid against sdirk2", abs(meters(hybrid)[2][-1] / force[-1] - 1), 2e-2)
    sea = meters(Run.of_case(BLOCK, *HYBRID, *slow, *within))[2]
    judge(ROW, "hybrid: force with 10 MPa all around", abs(sea[-1] / meters(hybrid)[2][-1] - 1), 1e-6)


def lift_off():
    """Down, up beyond the body, down again; then by force."""
    motion = "displacement: {table: [0 s, 0 m, 0.2 s, -0.05 m, 0.6 s, 0.15 m, 1 s, -0.05 m]}, separates: yes"
    run = Run.of_case(prescribed(COLUMN, motion), *STIFF)
    t, x, force, _ = meters(run)
    touch = x < -1e-6
    check("lift-off: stress while it touches", np.max(np.abs(force[touch] / WIDTH / drained(x[touch]) - 1)), 2e-4)
    check("lift-off: force while it does not, N", np.max(np.abs(force[x > 1e-6])), 0.0)
    check_true("... and both occur", touch.sum() > 15 and (x > 1e-6).sum() > 15)
    times = meters(Run.of_case(prescribed(COLUMN, motion), "-stepper_dt", "70 ms"))[0]
    check("kinks of a displacement end steps, s off", max(np.min(np.abs(times - kink)) for kink in (0.2, 0.6)), 1e-12)
    run = Run.of_case(prescribed(COLUMN, motion.replace(", separates: yes", ", separates: no")), *STIFF)
    check("a plate that does not separate pulls, N", meters(run)[2].min(), (-1e9, -1e4))
    load = "force: {table: [0 s, 0 N, 0.2 s, 1e5 N, 0.4 s, 0 N, 0.6 s, 0 N, 1 s, 1e5 N]}, separates: yes"
    t, x, force, _ = meters(Run.of_case(prescribed(COLUMN, load), *STIFF))
    check("by force: position", np.max(np.abs(x - np.expm1(-force / WIDTH / M))), 1e-6)
    run = Run.of_case(prescribed(COLUMN, motion), *HYBRID, *STIFF, "-stepper_damping", "0.3", "-output_probe_every", "20 ms")
    t, x, force, _ = meters(run)
    check("lift-off, hybrid: force while the plate is away, N", np.max(np.abs(force[x > 0.04])), 0.0)
    check("lift-off, hybrid: force at -0.05 m, second touch over first", force[-1] / np.interp(0.2, t, force), (0.9, 1.1))


def ranks_and_restart():
    """The same on 1, 2 and 4 ranks; cut in half, bit for bit."""
    ramp = "force: {ramp: [0 N, 3e6 N, 0 s, 1 s]}"
    hybrid = (*HYBRID, "-time_end", "0.2 s", "-output_times", "0.2 s", "-output_probe_every", "50 ms")
    for what, case, options in (("force, sdirk2", prescribed(BLOCK, ramp), ("-time_end", "0.4 s", "-output_times", "0.4 s")),
                                ("velocity, hybrid", BLOCK, hybrid), ("force, hybrid", prescribed(BLOCK, ramp), hybrid)):  # fmt: skip
        whole = Run.of_case(case, *options)
        one = meters(whole)
        for n in (2, 4):
            many = meters(Run.of_case(case, *options, ranks=n))
            worst = max(np.max(np.abs(a[1:] / b[1:] - 1)) for a, b in zip(many[1:], one[1:]))
            check(f"{what}: {n} ranks against one", worst, 1e-9)
        out = scratch() / "out"
        Run.of_case(case, *options, "-stepper_max_steps", whole.steps(7 if "sdirk2" in what else 1), out=out)
        cut = meters(Run(out))[0][-1]
        again = meters(Run.of_case(case, *options, "-restart", out / "checkpoint.h5", out=out))
        same = all(np.array_equal(a[a_t > cut], b[b_t > cut]) for a, b in zip(again, one) for a_t, b_t in [(again[0], one[0])])
        check_true(f"{what}: restart in the middle of the motion, bit for bit", same and 0 < cut < one[0][-1], f"cut at {cut:g} s")


def ends():
    """What a plate cannot do ends the run with a sentence, exit code 3 and the last good state."""
    hollow = ("-mat_ground_porosity", "0.99", "-bc_plate_velocity")
    for what, words, options in (
        ("leaves the grid", "plate plate leaves the background grid", ("-bc_plate_velocity", "0.5 m/s")),
        ("meets the base", "plate plate comes within half a cell of base", (*hollow, "-1.2 m/s")),
        ("jumps", "plate plate moves more than half a cell in one step", ("-stepper_dt_min", "0.1 s", "-stepper_dt", "0.1 s", *hollow, "-0.6 m/s")),
    ):  # fmt: skip
        out = scratch() / "out"
        done = launch(binary(), COLUMN, *options, "-stepper_max_failures", "5", out=out)
        check_true(f"plate {what}: exit code 3", done.returncode == 3, done.returncode)
        last = [line for line in done.stdout.splitlines() if line.startswith("Given up")]
        check_true(f"plate {what}: said so", last and words in last[0], last)
        check_true(f"plate {what}: last good state", (out / "checkpoint.h5").exists())

    block = "  block: {lower: [0 m, 0 m], upper: [0.2 m, 1 m], material: ground, pressure: 1 MPa}"
    two = edited(COLUMN, ("regions: [block]", "regions: [block, above]"), (block, block.replace("1 m]", "0.5 m]") + "\n" +
                 block.replace("block", "above").replace("[0 m, 0 m]", "[0 m, 0.5 m]")), ("side: top", "side: top, region: block"))
    out = scratch() / "out"
    done = launch(binary(), two, out=out)
    check_true("plate on a closed-in side: exit code 2, said so, nothing written", done.returncode == 2 and not out.exists() and
               "bc_plate_side" in done.stdout and "no free surface" in done.stdout, done.stdout.splitlines()[0])


for part in (confined, prescribed_force, rough, lift_off, ranks_and_restart, ends):
    print(f"--- {part.__name__}")
    part()
finish()
