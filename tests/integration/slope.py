#!/usr/bin/env python3
"""Slope A as it begins to slide: ranks agree, a restart is exact, bands are found.

Slope A on cells of 8 m as it begins to slide, by hybrid, and on 20 m by sdirk2: the same on 1, 2 and 4 ranks, a restart in the slide bit for bit, nothing lost, which limit set the
step; pressures that tend to the nodes' lose what no node sees and no mass; and what scripts/slide.py finds: onset, failed part, the bands of strains and the slides of a balance that are
known; rows of docs/studies/slopes.md are runs of today's cases.
"""
import json
import re
import shlex
import sys
from collections import Counter
from pathlib import Path
from types import SimpleNamespace
from unittest import mock

import numpy as np
from PIL import Image, ImageSequence

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, Run, binary, check, check_true, finish, judge, launch, scratch  # noqa: E402
from clathra import read_snapshots  # noqa: E402

import slide  # noqa: E402  scripts/, which common puts on the path
import slopes  # noqa: E402

COARSE = ("-quiet", "-grid_cells", "75,15", "-gravity_ramp", "3 s", "-stage_load_end", "3 s", "-stage_slide_end", "7 s", "-output_every", "0.5 s")


def slope(*options, **keywords):
    return Run.of_case("slope_a", *COARSE, *options, **keywords)


def implicit():
    """Slope A on cells of 20 m by implicit steps alone, from its loading until it has slid by metres: ranks, and a restart in the slide."""
    coarse = (*COARSE, "-grid_cells", "30,6", "-stage_slide_end", "6 s", "-stepper_type", "sdirk2", "-stepper_tol", "1e-2")
    whole = Run.of_case("slope_a", *coarse)
    last = whole.snapshots()[-1][1]
    check("slope A by sdirk2: the farthest particle has slid, m", np.hypot(*last["displacement"].T).max(), (3, 10))
    for ranks in (2, 4):
        many = Run.of_case("slope_a", *coarse, ranks=ranks).snapshots()[-1][1]
        judge("slopes", f"slope A on 20 m into its slide, sdirk2, {ranks} ranks against 1: any field, of its largest value", apart(last, many), 1e-9)
    out, taken = scratch() / "implicit", int(whole.balance["step"][-1])
    Run.of_case("slope_a", *coarse, "-stepper_max_steps", taken - 20, out=out)
    on = Run.of_case("slope_a", *coarse, "-restart", out / "checkpoint.h5", out=out)
    check_true("a restart of implicit steps in the slide, bit for bit", int(on.balance["step"][-1]) == taken and all(np.array_equal(v, on.snapshots()[-1][1][k]) for k, v in last.items()))


def apart(one, other):
    """Largest difference of any field, of its largest value; where a particle yields is a matter of round-off."""
    return max(np.max(np.abs(v - other[k])) / (np.max(np.abs(v)) or 1.0) for k, v in one.items() if k != "yield")


def cells(particles, h):
    """{cell: number of particles in it} on cells of h (m)."""
    return Counter(map(tuple, np.floor(particles["position"] / h).astype(int)))


def torn():
    """Slope C on cells of 20 m, as far as its blocks have torn loose: velocities that are free at the surface leave the balance of energy closed; the tie (41) leaves 6 %.  It has single
    particles in cells, cells that emptied and points at the apex by then, and no step is refused."""
    slide = lambda *more: Run.of_case("slope_c", "-quiet", "-grid_cells", "180,8", "-gravity_ramp", "5 s", "-stage_load_end", "5 s", "-stage_slide_end", "40 s", "-output_every", "0 s", *more)
    leaves = lambda run: abs(run.balance["energy_remainder_J"][-1] / run.balance["gravity_work_J"][-1])
    run, half = slide(), slide("-stepper_cfl", "0.4")  # 0.2 leaves 0.9 %
    check("slope C: work of gravity, J", run.balance["gravity_work_J"][-1], (1e10, 3.5e10))
    judge("slopes", "slope C on 20 m until its blocks have torn loose, in half the step: what the balance of energy leaves of the work of gravity", leaves(half), 0.015)
    check("... of what it leaves in the whole step", leaves(half) / leaves(run), 0.85)
    (_, first), *_, (_, last) = run.snapshots()
    before, after = cells(first, 20), cells(last, 20)
    check("slope C: cells with a single particle in them", sum(n == 1 for n in after.values()), (5, 100))
    check("slope C: cells that emptied", len(set(before) - set(after)), (10, 100))
    check("slope C: particles at the apex", int(re.search(r"(\d+) at the apex", run.output)[1]), (10, 500))
    check_true("slope C: no step refused, nobody left", ", 0 refused" in run.output and len(first["id"]) == len(last["id"]))


def known_bands():
    """Three bands in a slope of 300 m x 100 m: angle, rises, time, and a strip beside them that is too short; strain of 0.03 everywhere."""
    wanted = ((50, "downslope", 20.0, 60), (65, "upslope", 31.0, 230), (50, "downslope", 44.0, 140))
    x = np.stack(np.meshgrid(np.arange(1, 300, 2.0), np.arange(1, 100, 2.0)), axis=-1).reshape(-1, 2)
    strain = np.full(len(x), 0.03)
    time = np.full(len(x), np.inf)
    for angle, rises, when, foot in wanted:
        slope = np.tan(np.radians(angle)) * (1 if rises == "downslope" else -1)
        inside = abs((x[:, 1] - slope * (x[:, 0] - foot)) * np.cos(np.arctan(slope))) < 4
        strain[inside], time[inside] = 0.6, when
    short = (abs(x[:, 0] - 270) < 4) & (abs(x[:, 1] - 60) < 12)
    strain[short], time[short] = 0.6, 10.0
    times = np.arange(0, 60.5, 1.0)
    snapshots = [(t, {"eps_d_p": np.where(t >= time, strain, 0.0)[:, None], "position": x}) for t in times]
    run = SimpleNamespace(start=x, end=snapshots[-1][1], snapshots=snapshots, time=times, cell=4.0, height=100.0)
    run.at = lambda time: slide.Run.at(run, time)
    run.rows = lambda *a: slide.Run.rows(run, *a)
    found = slide.bands(run)
    check("bands found of three that are known", len(found), (3, 3))
    for (angle, rises, when, foot), b in zip(wanted, found):
        check(f"band of {angle} deg: angle found", b["angle_deg"], (angle - 1, angle + 1))
        check_true(f"band of {angle} deg: rises {rises}", b["rises"] == rises)
        check(f"band of {angle} deg: time", b["time_s"], (when - 1, when))
        check(f"band of {angle} deg: distance of its low end from the line, m", abs(b["y_low_m"] - abs(np.tan(np.radians(angle)) * (b["x_low_m"] - foot))), 4.0)


def known_slides():
    """Two phases of hybrid between implicit steps, in a balance and with a probe that are known."""
    newton, t = np.array([3, 2, 4, 0, 0, 5, 3, 0, 2.0]), np.array([1.0, 10, 100, 101, 103, 200, 300, 307, 400])
    energy = np.array([0, 0, 1.0, 50, 8, 0, 0, 2, 0])
    balance = {"newton": newton, "time_s": t, "kinetic_energy_J": energy, "step": np.array([1.0, 2, 3, 259, 515, 516, 517, 773, 774])}
    probes = {"time_s": t, "face.u_x_m": np.interp(t, (100, 103, 300, 307), (0.0, 3, 3, 4)), "face.u_y_m": np.interp(t, (100, 103), (0.0, -4))}
    run = SimpleNamespace(balance=balance, probes=probes, loaded=5.0)
    found = slide.slides(run, 100.0)
    check_true("two phases of hybrid: from, how long, steps, energy", [(s["from_s"], s["lasts_s"], s["steps"], s["kinetic_energy_J"]) for s in found] == [(100.0, 3.0, 512, 50.0), (300.0, 7.0, 256, 2.0)], found)
    check("... speed of a mass of 100 kg", abs(found[0]["velocity_m_s"] - 1.0), 1e-12)
    check("... way of the probe", abs(found[0]["probes_m"]["face"] - 5.0) + abs(found[1]["probes_m"]["face"] - 1.0), 1e-12)
    balance["newton"] = np.zeros(9)
    check_true("... none in a run that is hybrid's all the way", slide.slides(run, 100.0) == [])


def film(run):
    """The film of a run: a frame for each snapshot since the loading and the last one five times, each at its time."""
    out = scratch()
    with mock.patch.object(slide.shutil, "which", return_value=None):  # without ffmpeg a gif, which Pillow reads
        slide.film("slide", run, out)
    with Image.open(out / "slide.gif") as gif:
        frames, lasts = [], 0
        for frame in ImageSequence.Iterator(gif):
            frames.append(np.asarray(frame.convert("L"), dtype=int))
            lasts += frame.info["duration"]
    n = len(run.snapshots)
    check("film: frames that differ, of its snapshots", sum(np.any(a != b) for a, b in zip(frames, frames[1:])) + 1, (n, n))
    check("... lasts, ms, the end five times", lasts, (0.9 * 1000 * (n + 4) / slide.FRAMES, 1.1 * 1000 * (n + 4) / slide.FRAMES))
    check("... first and last frame: pixels that differ, %", 100 * np.mean(abs(frames[0] - frames[-1]) > 40), (0.2, 60))


def rows_of_the_page():
    """Every row that docs/studies/slopes.json keeps is one that scripts/slopes.py can run, and its options are such that the program takes them."""
    kept = json.loads(slopes.KEPT.read_text())
    check_true("rows of the page are rows of the script", set(kept) <= set(slopes.ROWS), set(kept) - set(slopes.ROWS))
    for name, (case, _, options) in slopes.ROWS.items():
        done = launch(binary(), CASES / f"slope_{case}", *shlex.split(options), "-case_check")
        check_true(f"options of {name}", done.returncode == 0, "" if done.returncode == 0 else done.stdout[-300:])


one = slope()
last = one.snapshots()[-1][1]
for ranks in (2, 4):
    many = slope(ranks=ranks).snapshots()[-1][1]
    judge("slopes", f"slope A on 8 m as it begins to slide, hybrid, {ranks} ranks against 1: any field, of its largest value", apart(last, many), 1e-6)
check_true("no particle is lost", np.array_equal(last["id"], one.snapshots()[0][1]["id"]) and all(np.isfinite(v).all() for v in last.values()))
judge("slopes", "... what the balance of energy leaves, of the work of gravity", abs(one.balance["energy_remainder_J"][-1] / one.balance["gravity_work_J"][-1]), 0.02)
for what in ("water", "methane"):
    check(f"{what} kept, of the mass at the start", np.max(np.abs(one.balance[f"{what}_error"])), 1e-12)

cut = scratch() / "cut"
slope("-stepper_max_steps", one.steps(7), "-checkpoint_every", "0.5 s", out=cut)  # the slide begins at 3 s
begun = slope("-restart", cut / "checkpoint.h5", "-stepper_max_steps", one.steps(47) - one.steps(7), out=cut).balance["time_s"][-1]
check("time of the restart, in the slide (s)", begun, (4.0, 6.5))
again = slope("-restart", cut / "checkpoint.h5", out=cut).snapshots()[-1][1]
check_true("a restart in the slide, bit for bit", all(np.array_equal(v, again[k]) for k, v in last.items()) and (one.out / "probes.csv").read_bytes() == (cut / "probes.csv").read_bytes())

summary = (one.out / "summary.txt").read_text()
check_true("the summary says which limits set the step of each stage", len(re.findall(r"hybrid .*stable step \S+ s to \S+ s \((waves in the mixture|waves in thin domains) [\d.]+ %", summary)) == 2, summary[-900:])
run = slide.Run(one.out)
film(run)
m = slide.measure(run)
slide.write(run, m, slide.bands(run))
slide.write(run, m, slide.bands(run))
check_true("the slide stands once at the end of the summary", (one.out / "summary.txt").read_text().startswith(summary) and (one.out / "summary.txt").read_text().count("slide, to t =") == 1)
said = {k: tuple(map(float, v)) for k, *v in re.findall(r"^    (\w+) +\((\d+), (\d+)\) m  ([\d.]+) m  (-?[\d.]+); (-?[\d.]+) MPa  (-?[\d.]+) degC  ([\d.]+)  ([\d.]+)$", (one.out / "summary.txt").read_text(), re.M)}
check_true("the probes by name, where the case has them", {k: v[:2] for k, v in said.items()} == {"A": (165, 1), "B": (113, 53)}, said)
for name, (*_, way, most, pressure, T, Sh, strain) in said.items():
    of, start = one.probe(name), np.searchsorted(one.probes["time_s"], 3.0)  # the loading ends
    check(f"... {name}: way since the loading, m", abs(way - np.hypot(of["u_x_m"][-1] - of["u_x_m"][start], of["u_y_m"][-1] - of["u_y_m"][start])), 0.006)
    over = (of["p_Pa"] - of["p_Pa"][0]) / 1e6
    check(f"... {name}: pore pressure, T, S_h, strain", max(abs(most - over.max()), abs(pressure - over[-1]), abs(T - of["T_degC"][-1]), abs(Sh - of["S_h"][-1]), abs(strain - of["eps_d_p"][-1])), 0.006)
(before, then), (now, late) = one.snapshots()[-2:]
fell = np.hypot(*(late["position"] - then["position"]).T) / (now - before)
check("mean speed at the end between that of the slowest and the fastest particle, m/s", m["mean_velocity_at_end_m_s"], (0.01, fell.max()))
times, places = np.arange(0, 11.0), np.array([0, 0, 0, 8, 18, 24, 25, 25.05, 25.06, 25.06, 25.06])
slid = SimpleNamespace(time=times, end={"mass_solid": np.ones((2, 1))}, snapshots=[(t, {"position": np.array([[x, 0.0], [0.0, x]])}) for t, x in zip(times, places)], failed=lambda p: np.array([True, True]))
speed = slide.speeds(slid)
check_true("a slide that is known: its speeds, at rest from 6 s on", np.allclose(speed, np.diff(places)) and slide.rests(slid, speed) == 6.0, (speed, slide.rests(slid, speed)))
check_true("... one that goes on is not at rest", slide.rests(slid, speed[:6]) is None and slide.rests(slid, np.zeros(10)) is None)
half = slide.Run(one.out, until=5.0)
check_true("a run looked at as far as 5 s", half.time[-1] == 5.0 and max(half.balance["time_s"][-1], half.probes["time_s"][-1]) <= 5.0 + 1e-6 and half.balance["time_s"][-1] > 4.9)
check("... its onset is the whole run's", abs(slide.measure(half)["onset_s"] - m["onset_s"]), 1e-12)
check_true("... and it has not come as far", slide.measure(half)["runout_m"] < m["runout_m"])
check("onset (s)", m["onset_s"], (3.0, 5.0))
check("share of the body that failed", m["failed_share"], (0.3, 0.7))
check("runout (m)", m["runout_m"], (0.2, 20.0))
check("gas released over hydrate lost", m["gas_released_kg"] / m["hydrate_lost_kg"], (0.016 / 0.124 - 1e-12, 0.016 / 0.124 + 1e-12))


torn()
implicit()
known_bands()
known_slides()
rows_of_the_page()
finish()
