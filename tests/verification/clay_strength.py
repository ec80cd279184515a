#!/usr/bin/env python3
"""A free strip of clay whose strength grows with depth: its factor of safety.

Undrained strength that grows with depth (455): a free strip of clay on a smooth base, of height H and half-width b.

    F = 2 (c_0/(gamma H) + k/gamma)              stresses that its slices bear by themselves
    F = 2 (c_0/(gamma (H - b/2)) + k/gamma)      a plane at 45 deg through its foot slides

bound the factor of safety within 1 %: 2.25 and 2.267 (on cells of b/8 it is found in (2.25, 2.28), on those of b/4, here, in (2.28, 2.31)).  At F = 3 the strip slumps, and what yields has the strength of the depth at which it
was at the start: half the difference of its principal stresses is c_u(z_0)/F, to round-off, in each integrator, along either axis, in space, on
two ranks and after a restart.
"""
import re
import subprocess
from pathlib import Path

import numpy as np

from common import binary, check, check_true, environment, finish, judge, launch, run, scratch, table

CASE = Path(__file__).parent / "cases" / "clay_column.yaml"
H, B, C0, K, GAMMA, F = 4.0, 0.5, 10e3, 20e3, 20e3, 3.0
LOWER, UPPER = 2 * (C0 / (GAMMA * H) + K / GAMMA), 2 * (C0 / (GAMMA * (H - B / 2)) + K / GAMMA)
SLUMP = ("-quiet", "-strength_factor", F, "-time_end", "0.5 s", "-output_times", "0.25 s, 0.5 s")
SWAPS = (  # gravity along +x, so that the level is where x is least
    ("upper: [1.5 m, 4.5 m], cells: [12, 36]", "upper: [4.5 m, 1.5 m], cells: [36, 12]"), ("[0 m/s^2, -10 m/s^2]", "[10 m/s^2, 0 m/s^2]"), ("level: 4 m", "level: 0.5 m"),
    ("column: {lower: [0 m, 0 m], upper: [0.5 m, 4 m]", "column: {lower: [0.5 m, 0 m], upper: [4.5 m, 0.5 m]"), ("base: {type: roller, axis: y, position: 0 m}", "base: {type: roller, axis: x, position: 4.5 m}"),
    ("left: {type: roller, axis: x", "left: {type: roller, axis: y"))  # fmt: skip
DRAWN = (  # out along z
    ("upper: [1.5 m, 4.5 m], cells: [12, 36]", "upper: [1.5 m, 4.5 m, 0.125 m], cells: [12, 36, 1]"), ("grid: {lower: [0 m, 0 m]", "grid: {lower: [0 m, 0 m, 0 m]"), ("-10 m/s^2]", "-10 m/s^2, 0 m/s^2]"),
    ("lower: [0 m, 0 m], upper: [0.5 m, 4 m]", "lower: [0 m, 0 m, 0 m], upper: [0.5 m, 4 m, 0.125 m]"), ("[2, 2]", "[2, 2, 2]"), ("[base, left]", "[base, left, back, front]"),
    ("bc:\n", "bc:\n  back: {type: roller, axis: z, position: 0 m}\n  front: {type: roller, axis: z, position: 0.125 m}\n"))  # fmt: skip


def varied(swaps):
    text = CASE.read_text()
    for old, new in swaps:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = scratch() / "case.yaml"
    path.write_text(text)
    return path


def limit():
    words = ["strength", CASE, "--low", 2.2, "--high", 2.4, "--tol", 0.03]
    said = subprocess.run([binary(), *map(str, words)], env=environment(TMPDIR=str(scratch())), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, text=True).stdout
    print(said, end="")
    ends = re.search(r"stands at (\S+), fails at (\S+)", said)
    found = 0.5 * (float(ends[1]) + float(ends[2])) if ends else np.nan
    judge("strength", "strip of clay, c_u with depth, b/4, hybrid: factor of safety over the mean of its bounds", found / (0.5 * (LOWER + UPPER)) - 1, (-0.01, 0.03), 0.01, "%")


def of_depth(last, axis=1, level=4.0, up=1):
    """(share of the particles that yields, how far half the difference of principal stresses is from c_u/F at the initial and at the present depth)."""
    s, at = last["stress"], last["yield"].ravel() > 0
    xx, yy, zz, xy = s[at, :4].T
    middle, radius = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
    half = (np.maximum(middle + radius, zz) - np.minimum(middle - radius, zz)) / 2
    off = [np.max(np.abs(half / ((C0 + K * np.maximum(up * (level - last[place][at, axis]), 0)) / F) - 1)) for place in ("initial_position", "position")]
    return np.mean(at), *off


def slump():
    rows, ends = [], {}
    cases = {"hybrid": (CASE, ()), "sdirk2": (CASE, ("-stepper_type", "sdirk2", "-stepper_adapt", "no", "-stepper_dt", "0.01 s")),
             "gravity along +x": (varied(SWAPS), ()), "in space": (varied(DRAWN), ())}  # fmt: skip
    for what, (case, options) in cases.items():
        done = run(binary(), case, *SLUMP, *options)
        ends[what] = done.snapshots()[-1][1]
        share, then, now = of_depth(ends[what], *((0, 0.5, -1) if "+x" in what else ()))
        rows.append([what, np.linalg.norm(ends[what]["displacement"], axis=1).max(), 100 * share, then, now])
        check(f"{what}: strength of what yields against that of its initial depth", then, 1e-9)
        check_true("... which is not that of its present depth, and much of it yields", now > 0.02 and share > 0.2, (now, share))
    table(["", "largest displacement (m)", "yields (%)", "off c_u(z_0)", "off c_u(z)"], rows)
    one = ends["hybrid"]
    turned = np.abs(ends["gravity along +x"]["displacement"][:, ::-1] * (1, -1))
    check("gravity along +x: displacements, sorted, against those along -y (m)", np.max(np.abs(np.sort(turned, axis=0) - np.sort(np.abs(one["displacement"]), axis=0))), 1e-9)
    check("in space: largest displacement against the plane's", np.abs(np.linalg.norm(ends["in space"]["displacement"], axis=1).max() / rows[0][1] - 1), 1e-3)  # steps differ
    two = run(binary(), CASE, *SLUMP, ranks=2).snapshots()[-1][1]
    half = run(binary(), CASE, *SLUMP[:3], "-time_end", "0.25 s", "-output_times", "0.25 s")
    again = run(binary(), CASE, *SLUMP, "-restart", half.out / "checkpoint.h5", ranks=2).snapshots()[-1][1]
    for what, other in (("two ranks", two), ("begun again on two ranks", again)):
        check(f"{what}: stresses against one rank's, of the largest", np.max(np.abs(other["stress"] - one["stress"])) / np.max(np.abs(one["stress"])), 1e-9)


def axisymmetric():
    """About an axis, implicit."""
    last = run(binary(), CASE, *SLUMP, "-geometry", "axisymmetric", "-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "0.01 s").snapshots()[-1][1]
    check("about an axis: strength of what yields against that of its initial depth", of_depth(last)[1], 1e-9)


def refused():
    for what, options, said in (
        ("a gradient without gravity", ("-gravity", "0 m/s^2, 0 m/s^2"), ("plasticity_cohesion_gradient", "needs gravity")),
        ("a strength that falls with depth", ("-mat_clay_plasticity_cohesion_gradient", "-1 kPa/m"), ("plasticity_cohesion_gradient", "[0,1e9]")),
        ("a gradient in another unit", ("-mat_clay_plasticity_cohesion_gradient", "1 kPa"), ("plasticity_cohesion_gradient", "Pa/m")),
    ):
        done = launch(binary(), CASE, "-case_check", *options)
        check_true(f"refused: {what}", done.returncode == 2 and all(w in done.stdout for w in said), done.stdout)
    bare = varied(((", cohesion_level: 4 m", ""),))
    done = launch(binary(), bare, "-case_check")
    check_true("refused: a gradient without its level", done.returncode == 2 and "plasticity_cohesion_level" in done.stdout, done.stdout)
    deep = launch(binary(), CASE, "-case_check", "-mat_clay_plasticity_cohesion_residual", "5 kPa", "-mat_clay_plasticity_eta_s", "2000", "-mat_clay_elasticity_E0", "20 MPa")
    check_true("refused: softening that snaps back where the clay is strongest", deep.returncode == 2 and "snaps back" in deep.stdout, deep.stdout)


for part in (limit, slump, axisymmetric, refused):
    part()
finish()
