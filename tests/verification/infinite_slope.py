#!/usr/bin/env python3
"""Failure of an infinite slope whose base loses its hydrate, against limit equilibrium.

Failure of an infinite slope whose base loses its hydrate (cases/infinite_slope.yaml), by hybrid and by sdirk2 on three meshes.

Limit equilibrium of the plane in the middle of the weak layer, z below the ground (Davis 1968: strength of ground without dilation on
the plane it slides on), with the pore pressure p and the cohesion c(S_h) (61) of the layer at that time, and Newmark's (1965) block:

    tau = rho g z sin(beta),   F = [c cos(phi) + (p_sea + rho g z cos(beta) - p) sin(phi)]/tau,   dv/dt = g sin(beta) (1 - F) once F < 1

v the mean velocity of what lies above the plane.  p, c and the weight are those of the whole length, so that the ends, which add
nothing to the sum of forces, make no difference.  The layer is one cell thick on every mesh: in a layer of several cells pressures alternate
between the particles of a cell, and the mean of a row is not what its weakest particles bear.
What a wrong friction or pore pressure would do to these numbers is checked as well.
"""
from pathlib import Path

import numpy as np

from common import Run, check_true, finish, judge, scratch, table

CASE = Path(__file__).parent / "cases" / "infinite_slope.yaml"
G, BETA, PHI, SEA, TOP, LENGTH = 9.81, np.radians(10), np.radians(25), 3.75e6, 8.0, 20.0
COHESION, ETA, SH_MAX = 6e3, 60.0, 0.25
ALONG = G * np.sin(BETA)
CHANGED = 4 / 3  # m: cells of the run that changes its integrator
EARLY = 0.1  # of g sin(beta): acceleration at which the slope has failed
IMPLICIT = ("-stepper_type", "sdirk2", "-stepper_adapt", "no", "-stepper_dt", "0.1 s", "-stabilisation_ghost_penalty", "1e-3")
MASSES = ("mass_solid", "mass_hydrate", "mass_water", "mass_gas")


def run(h, *options, **keywords):
    """Snapshots [(t, fields)] on cells of h (m)."""
    return Run.of_case(CASE, "-quiet", "-grid_cells", f"{round((LENGTH + 8) / h)},{round(12 / h)}", "-region_slab_lower", f"0 m, {h:.12g} m",
                       "-region_weak_upper", f"{LENGTH} m, {h:.12g} m", *options, **keywords).snapshots()  # fmt: skip


def motion(snapshots, h, share=1.0):
    """(t (s), F, v (m/s)) of snapshots on cells of h; with a share of the excess pore pressure."""
    y = snapshots[0][1]["position"][:, 1]
    row, above, rows = y < h, y > h / 2, []
    for t, now in snapshots:
        m = sum(now[k] for k in MASSES).ravel()[above]
        c = np.mean(COHESION * np.exp(ETA * (now["S_h"][row] - SH_MAX)))
        bears = m.sum() * G / LENGTH * np.cos(BETA) - share * np.mean(now["p"][row] - SEA)
        rows.append((t, (c * np.cos(PHI) + bears * np.sin(PHI)) / (m.sum() * ALONG / LENGTH), m @ now["v_s"][above, 0] / m.sum()))
    return np.array(rows).T


def onset(t, F, v):
    """(time at which F = 1, F when the slope has failed, speed at the end, that of Newmark's block)."""
    late = t > 2  # at rest under gravity
    rate, between = np.gradient(v, t)[late] / ALONG, (t[late], F[late])
    at = np.argmax(rate > EARLY)
    fails = np.interp(EARLY, rate[at - 1 : at + 1], between[1][at - 1 : at + 1])
    one = np.interp(-1.0, -between[1], between[0])
    middle = one + (np.arange(200) + 0.5) / 200 * (t[-1] - one)
    return one, fails, v[-1], ALONG * np.mean(1 - np.interp(middle, t, F)) * (t[-1] - one)


def errors(found):
    """(F when failed less that of limit equilibrium, error of the speed at the end)."""
    return found[1] - (1 - EARLY), found[2] / found[3] - 1 if found[3] else np.inf


def changed():
    """sdirk2 until the slab is about to fail, then hybrid: F and speed, two and four ranks, and restarts right before and after the change."""
    stages = ("-stages", "quiet,slide", "-stage_quiet_end", "4 s", "-stage_slide_end", "5 s", *(f"-stage_quiet_{o[1:]}" if "stepper" in o else o for o in IMPLICIT))
    kept = scratch() / "whole"
    whole = run(CHANGED, *stages, out=kept)
    b = Run(kept, 0, "").balance
    change = int(b["step"][b["time_s"] <= 4][-1])
    last = whole[-1][1]
    found = errors(onset(*motion(whole, CHANGED)))
    judge("slopes", "infinite slope, sdirk2 and then hybrid: F when it fails against limit equilibrium", abs(found[0]), 0.035)
    for ranks in (2, 4):
        many = run(CHANGED, *stages, ranks=ranks)[-1][1]
        judge("slopes", f"... {ranks} ranks against 1, of the largest value", max(np.max(np.abs(v - many[k])) / (np.max(np.abs(v)) or 1.0) for k, v in last.items() if k != "yield"), 1e-6)
    for what, cut in (("before", change - 1), ("at", change), ("after", int(b["step"][b["time_s"] > 4][0]))):
        out = scratch() / what
        run(CHANGED, *stages, "-stepper_max_steps", cut, out=out)
        again = run(CHANGED, *stages, "-restart", out / "checkpoint.h5", out=out)[-1][1]
        check_true(f"... a restart {what} the change, bit for bit", all(np.array_equal(v, again[k], equal_nan=True) for k, v in last.items()))


if __name__ == "__main__":
    rows, found, coarse = [], {}, run(2.0)
    for name, options in (("hybrid", ()), ("sdirk2", IMPLICIT)):
        for h in (2.0, 1.0, 2 / 3) if name == "hybrid" else (2.0, 4 / 3, 1.0):
            at = onset(*motion(coarse if (name, h) == ("hybrid", 2.0) else run(h, *options), h))
            rows.append([name, f"{h:.2f}", *at, errors(at)[0], 100 * errors(at)[1]])
            found.setdefault(name, []).append(np.abs(errors(at)))
    table(["integrator", "h (m)", "F = 1 at (s)", f"F at {EARLY} g sin(beta)", "speed at 5 s (m/s)", "Newmark", "error of F", "of the speed (%)"], rows)
    for name, all_meshes in found.items():
        judge("slopes", f"infinite slope, hydrate lost at its base, {name}, three meshes: F when it fails against limit equilibrium", max(f for f, _ in all_meshes), 0.04)
        judge("slopes", "... on the finest", all_meshes[-1][0], 0.01)
        judge("slopes", "... speed 0.8 s later against Newmark's block", max(v for _, v in all_meshes), 0.05, 0.01, "%")
    changed()
    weaker = errors(onset(*motion(run(2.0, "-mat_weak_plasticity_friction_peak", "15 deg"), 2.0)))
    less = errors(onset(*motion(coarse, 2.0, 0.9)))
    table(["planted", "error of F", "of the speed"], [["friction of 15 deg", *weaker], ["a tenth less excess pressure", *less]])
    for what, (off, speed) in (("a friction of 15 deg in the run", weaker), ("nine tenths of its excess pressure in F", less)):
        judge("slopes", f"infinite slope, planted: {what}: F when it fails is off by", off, (0.1, 1))
        judge("slopes", "... and the speed by", abs(speed), (0.15, 10), 0.01, "%")
    finish()
