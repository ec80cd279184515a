#!/usr/bin/python3
"""Study of stability at the extremes: writes docs/studies/stability.md and its figures.

stability.py [CLATHRA] [--fresh] [--only PART ...]

CLATHRA  the program, default build/clathra
--fresh  run again what results/stability_study holds already
--only   parts to run: properties, steps, events, consolidation, waves, limits; the page needs all

Every number of the page is of one of its runs.  It is a study, no test: it takes about ten minutes.  Each run may take
LIMIT seconds of the wall; a longer one counts as a fault, as do a crash, an end without a reason and a NaN in a file.
"""
import argparse
import math
import pickle
import re
import sys
from collections import Counter
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "verification"), str(ROOT / "scripts")]
import dated  # noqa: E402
import exact  # noqa: E402
from _extremes import CELL, P, SCENE, attempt, cells, difference, scene, stable_step  # noqa: E402
from _ladder import ElasticWave, Terzaghi  # noqa: E402
from common import CASES  # noqa: E402
from clathra import read_csv, read_snapshots  # noqa: E402
from soak import read_record, table as soak_table  # noqa: E402

FOLDER, PAGE, FIGURES = ROOT / "results" / "stability_study", ROOT / "docs" / "studies" / "stability.md", ROOT / "docs" / "figures"
SOAKED = dated.STUDIES / "soak.jsonl"
DIFFUSION = ROOT / "tests" / "verification" / "cases" / "diffusion.yaml"
FALLING = ROOT / "tests" / "verification" / "cases" / "falling.yaml"
LIMIT = 40.0  # s of the wall
IMPLICIT, BY_STEPS = ("sdirk2", "euler"), ("hybrid", "explicit")
INTEGRATORS = IMPLICIT + BY_STEPS
ADAPTIVE, WINDOW = 100.0, 200  # s; steps at the stable limit that hybrid and explicit get

AXES = {
    "permeability (m²)": [(f"{k:g}", {"k": k}) for k in (1e-9, 1e-11, 1e-13, 1e-15, 1e-17, 1e-19, 1e-22)],
    "reaction constant x": [(f"{r:g}", {"rate": r}) for r in (1e-4, 1e-2, 1, 1e2, 1e4, 1e6, 1e8)],
    "S_g (S_h = 0.1)": [(f"{s:g}", {"Sg": s, "Sh": 0.1}) for s in (1e-6, 1e-4, 1e-2, 0.1, 0.4, 0.8)],
    "S_h": [(f"{s:g}", {"Sh": s, "Sg": min(0.2, (1 - s) / 2)}) for s in (0, 1e-4, 0.1, 0.4, 0.7, 0.9)],
    "porosity": [(f"{s:g}", {"phi": s}) for s in (0.05, 0.1, 0.2, 0.7, 0.9)],
    "stiffness (Pa)": [(f"{e:g}", {"E0": e}) for e in (1e5, 1e6, 1e7, 1e9, 1e11)],
    "K_w (Pa), S_g = 0.001": [(f"{k:g}", {"Kw": k, "Sg": 1e-3, "Sh": 0.1}) for k in (1e8, 1e10, 1e12, math.inf)],
    "T (°C)": [(f"{t:g}", {"T0": t}) for t in (-5, 0, 4, 20, 40, 60)],
    "p (MPa)": [(f"{p:g}", {"p": p * 1e6}) for p in (0.1, 1, 20, 60)],
}


def seconds(t):
    return f"{t:.12g} s"


def until(t, probe=20):
    """Options of a run to time t (s) with `probe` rows."""
    return ["-time_end", seconds(t), "-output_times", seconds(t), "-output_probe_every", seconds(t / probe), "-stepper_dt_min",
            seconds(1e-9 * t), "-stepper_dt_max", seconds(t)]  # fmt: skip


def fixed(dt, integrator):
    return ["-stepper_type", integrator, "-stepper_adapt", "no", "-stepper_dt", f"{dt:.12g}", "-stepper_dt_min", f"{1e-7 * dt:.12g}"]


def own(limit, integrator):
    """hybrid or explicit by their own step."""
    return ["-stepper_type", integrator, "-stepper_adapt", "yes", "-stepper_dt", seconds(1e-3 * limit)]


class Study:
    """Runs by name, kept in FOLDER."""

    def __init__(self, program, fresh):
        self.program, self.fresh, self.all = program, fresh, {}

    def run(self, name, options, case=SCENE, limit=LIMIT):
        out = FOLDER / "".join(c if c.isalnum() or c in "-+." else "_" for c in name)
        kept, key = out / "outcome.pickle", (str(case), list(map(str, options)), limit)
        if not self.fresh and kept.is_file():
            with open(kept, "rb") as stream:
                old, done = pickle.load(stream)
            if old == key:
                self.all[name] = done
                return done
        done = attempt(options, case, limit, self.program, out)
        out.mkdir(parents=True, exist_ok=True)
        with open(kept, "wb") as stream:
            pickle.dump((key, done), stream)
        self.all[name] = done
        print(f"{name:60s} {done.kind:9s} {done.steps:7d} steps {done.seconds:6.1f} s  {done.said[:100]}", flush=True)
        return done

    def against(self, name, options, reference, load=0.0, **more):
        """Outcome with its largest error against a reference run."""
        done = self.run(name, options, **more)
        ok = done.kind == reference.kind == "finished"
        return done, max(difference(done.folder, reference.folder, load).values()) if ok else math.nan


# ---------------------------------------------------------------------------------------- the parts
def by_steps(study, name, options, load, case=SCENE, window=WINDOW, like=None):
    """hybrid and explicit over a window of steps at their stable limit, against sdirk2: {integrator: (outcome, error)}."""
    found = {}
    for integrator in BY_STEPS:
        limit, rules = stable_step(options, integrator, case)
        if not limit > 0:
            found[integrator] = study.run(f"{name}, {integrator}", [*options, *own(1.0, integrator)], case), math.nan
            continue
        end = window * limit
        reference = study.run(f"{name}, {integrator}, reference", [*options, *until(end), *fixed(end / window, "sdirk2")], case)
        found[integrator] = study.against(f"{name}, {integrator}", [*options, *until(end), *own(limit, integrator)], reference, load, case=case)
    return found


def properties(study):
    """{axis: [(label, {run: (outcome, error)})]}."""
    found = {}
    for axis, values in AXES.items():
        found[axis] = []
        for label, change in values:
            options, name = scene(**change), f"{axis} {label}"
            load = 1.0e6 * min(1.0, change.get("E0", 1e8) / 1e8, change.get("p", P) / P)
            base = study.run(f"{name}, reference", [*options, "-inertia", "no", "-stepper_tol", "1e-4", *until(ADAPTIVE, 1)])
            row = {}
            for integrator in IMPLICIT:
                row[f"{integrator}"] = study.against(f"{name}, {integrator}", [*options, "-stepper_type", integrator], base, load)
                row[f"{integrator}, 1 s"] = study.against(f"{name}, {integrator}, 1 s", [*options, *fixed(1.0, integrator)], base, load)
            row.update(by_steps(study, name, options, load))
            found[axis].append((label, row))
    return found


def fast(study):
    """The fastest reactions without inertia: {label: {integrator: outcome}}."""
    return {label: {n: study.run(f"reaction constant x {label}, {n} without inertia", [*scene(rate=float(label)), "-stepper_type", n, "-inertia", "no"])
                    for n in IMPLICIT} for label in ("1e+06", "1e+08")}  # fmt: skip


FACTORS = (0.1, 1.0, 10.0, 1e2, 1e3, 1e4, 1e5, 1e6)
REGIMES = {"as it stands": {}, "k = 1e-18 m²": {"k": 1e-18}, "k = 1e-11 m²": {"k": 1e-11}, "reaction x 1e4": {"rate": 1e4},
           "S_g = 1e-6": {"Sg": 1e-6, "Sh": 0.1}}  # fmt: skip
STEPS = 40


def steps(study):
    """{regime: (limit, [(factor, {integrator: (outcome, error)})])}: 40 fixed steps of a multiple of the hybrid's limit."""
    found = {}
    for regime, change in REGIMES.items():
        options = scene(**change)
        limit, _ = stable_step(options, "hybrid")
        rows = []
        for factor in FACTORS:
            dt = factor * limit
            end = STEPS * dt
            base = study.run(f"steps, {regime}, x {factor:g}, reference", [*options, *until(end), *fixed(dt / 8, "sdirk2")])
            row = {i: study.against(f"steps, {regime}, x {factor:g}, {i}", [*options, *until(end), *fixed(dt, i)], base, 1e6) for i in INTEGRATORS}
            if factor > 1.0 and factor <= 100.0:
                row["hybrid, forced"] = study.against(f"steps, {regime}, x {factor:g}, forced",
                                                      [*options, *until(end), *fixed(dt, "hybrid"), "-stepper_force_dt", "yes"], base, 1e6)  # fmt: skip
            rows.append((factor, row))
        found[regime] = limit, rows
    return found


HOT = ["-boundaries", "base,bottom,top,load,outlet,hot", "-bc_hot_type", "temperature", "-bc_hot_axis", "x", "-bc_hot_position", "0 m",
       "-bc_hot_temperature", "60 degC"]  # fmt: skip


def sliver(depth):
    return ["-region_column_upper", f"{0.2 + depth * CELL!r} m, 0.02 m"]


def at_outlet():
    """The scene without its own pressure at the outlet."""
    options = scene()
    k = options.index("-bc_outlet_pressure")
    return options[:k] + options[k + 2 :]


EVENTS = {
    **{f"the end {d:g} cells beyond a grid line": [*scene(), *sliver(d)] for d in (0.1, 1e-3, 1e-5, 1e-6, 1e-7, 1e-9)},
    **{f"sudden load of 10 MPa, k = {k:g} m²": [*scene(k=k), "-bc_load_normal", "17 MPa", "-bc_outlet_pressure", "7 MPa"] for k in (1e-11, 1e-14, 1e-18)},
    **{f"outlet to 0.5 MPa at once, k = {k:g} m²": [*scene(k=k), "-bc_load_normal", "7 MPa", "-bc_outlet_pressure", "0.5 MPa"] for k in (1e-11, 1e-14, 1e-18)},
    "outlet to 0.5 MPa within 1 s, k = 1e-14 m²": [*at_outlet(), "-bc_load_normal", "7 MPa", "-bc_outlet_pressure_ramp", "7 MPa,0.5 MPa,0 s,1 s"],
    **{f"base to 60 °C at once, S_h = {s:g}": [*scene(Sh=s, Sg=0.1, load=1e-6), *HOT] for s in (0.2, 0.6)},
    "all three at once": [*scene(), *HOT, "-bc_load_normal", "17 MPa", "-bc_outlet_pressure", "0.5 MPa"],
}  # fmt: skip


def events(study):
    found = []
    for name, options in EVENTS.items():
        base = study.run(f"{name}, reference", [*options, "-inertia", "no", "-stepper_tol", "1e-4", *until(ADAPTIVE, 1)])
        row = {}
        for integrator in IMPLICIT:
            row[f"{integrator}"] = study.against(f"{name}, {integrator}", [*options, "-stepper_type", integrator], base, 1e6)
            row[f"{integrator}, 1 s"] = study.against(f"{name}, {integrator}, 1 s", [*options, *fixed(1.0, integrator)], base, 1e6)
        row.update(by_steps(study, name, options, 1e6))
        found.append((name, row))
    return found


def falling(study):
    """[(integrator, outcome, error of the fall, largest spurious stress over rho g H)]."""
    rows, g, t, weight = [], 9.81, 0.8, (0.6 * 2650 + 400) * 9.81 * 0.4
    for integrator in INTEGRATORS:
        limit, _ = stable_step([], "explicit", FALLING) if integrator == "explicit" else (1.0, "")
        options = ["-stepper_type", integrator]
        if integrator in BY_STEPS:
            options += ["-stepper_adapt", "yes"]
        done = study.run(f"falling block, {integrator}", options, FALLING)
        if done.kind == "finished":
            v = read_snapshots(done.folder)[-1][1]
            error = np.max(np.abs(v["displacement"] - [0.0, -0.5 * g * t**2])) / (0.5 * g * t**2)
            stress = max(np.max(np.abs(v["stress"])), np.max(np.abs(v["p"] - 0.1e6))) / weight
        rows.append((integrator, done, *((error, stress) if done.kind == "finished" else (math.nan, math.nan))))
    return rows


def consolidation(study):
    """[(k, {integrator: (outcome, error)})]: Terzaghi's column to 0.1 H^2/c against the closed form."""
    rows = []
    for k in (1e-9, 1e-11, 1e-13, 1e-15, 1e-17, 1e-19, 1e-22):
        B, c = exact.mixture_coefficients(Terzaghi.M, k / 1e-3, 0.4, 2.2e9)
        end, row = 0.1 / c, {}
        options = ["-grid_cells", "25,1", "-mat_clay_permeability_k0", f"{k} m^2", *until(end)]
        for name, more in {"sdirk2": [], "euler": [], "sdirk2, 20 steps": fixed(end / 20, "sdirk2"), "euler, 20 steps": fixed(end / 20, "euler")}.items():
            first = ["-stepper_dt", seconds(1e-4 * end), "-stepper_type", name] if not more else more
            done, error = study.run(f"consolidation, k = {k:g}, {name}", [*options, *first], CASES / "terzaghi"), math.nan
            if done.kind == "finished":
                v = read_snapshots(done.folder)[-1][1]
                x = v["position"][:, 0] - v["displacement"][:, 0]
                want = exact.terzaghi_constant(Terzaghi.q, B, c, Terzaghi.H, Terzaghi.H - x, end)
                error = float(np.sqrt(np.mean((v["p"][:, 0] - Terzaghi.p0 - want) ** 2)) / np.max(want))
            row[name] = done, error
        rows.append((k, row))
    return rows


def wave_scenes():
    """{name: (case, options, largest kinetic energy there can be (J), time a wave takes to cross the column (s))}."""
    W = ElasticWave
    found = {"dry": (CASES / "elastic_wave", [], W.q**2 * 10.0 * 0.2 / (2 * W.M), 10.0 / W.c)}
    for Kw in (1e8, 2.2e9, 1e12):
        M = Terzaghi.M + Kw / 0.4
        found[f"undrained, K_w = {Kw:g} Pa"] = (
            CASES / "terzaghi", ["-grid_cells", "25,1", "-mat_clay_permeability_k0", "1e-22 m^2", "-mat_clay_water_bulk_modulus", f"{Kw} Pa"],
            Terzaghi.q**2 * 0.02 / (2 * M), math.sqrt((0.6 * 2600 + 400) / M))  # fmt: skip
    return found


def waves(study):
    """[(scene, factor, {integrator: (outcome, largest kinetic energy over the exact largest)})]: 400 steps."""
    rows = []
    for name, (case, options, energy, _) in wave_scenes().items():
        limit, _ = stable_step(options, "hybrid", case)
        for factor in (0.1, 0.5, 1.0, 10.0, 1e3, 1e6):
            row, dt = {}, factor * limit
            for integrator in INTEGRATORS:
                done = study.run(f"wave, {name}, x {factor:g}, {integrator}", [*options, *until(400 * dt), *fixed(dt, integrator)], case)
                row[integrator] = done, done.kinetic / energy
            rows.append((name, factor, row))
    return rows


TERZAGHI = ["-grid_cells", "25,1", "-mat_clay_permeability_k0"]
BOUNDS = {  # regime: case, options
    "dry wave": (CASES / "elastic_wave", []),
    "undrained wave, k = 1e-15 m²": (CASES / "terzaghi", [*TERZAGHI, "1e-15 m^2"]),
    "wave with drainage, k = 1e-9 m²": (CASES / "terzaghi", [*TERZAGHI, "1e-9 m^2"]),
    "diffusion of pressure, k = 1e-11 m², rigid": (DIFFUSION, ["-mat_rock_permeability_k0", "1e-11 m^2"]),
    "diffusion of pressure, k = 1e-13 m², rigid": (DIFFUSION, []),
    "conduction of heat": (CASES / "heat_slab", []),
    "two fluids, hydrate, k = 1e-14 m²": (SCENE, scene()),
    "two fluids, hydrate, k = 1e-11 m²": (SCENE, scene(k=1e-11)),
}


def amplitude(done):
    """Largest change of any pressure, temperature or displacement at the probes; infinite when the run did not end well or
    had to take steps back."""
    if done.kind != "finished" or done.nan or done.cut:
        return math.inf
    found = {}
    for name, v in read_csv(done.folder / "probes.csv").items():
        if name.endswith((".p_Pa", ".T_degC", ".u_x_m")):
            kind = name.rsplit(".", 1)[1]
            found[kind] = max(found.get(kind, 0.0), float(np.max(np.abs(v - v[0]))))
    return found


def bounded(now, calm):
    """Not more than three times what the run at half the predicted limit shows."""
    return now is not math.inf and all(now[k] <= 3.0 * calm[k] + 1e-12 for k in calm)


def measured(study, regime, case, options, integrator, limit, n=4000):
    """Largest factor of the predicted limit with which a run to n times that limit stays bounded: bisection between 0.5 and 32."""
    def go(factor):
        forced = ["-stepper_force_dt", "yes", "-stepper_max_failures", 1]
        return amplitude(study.run(f"limit, {regime}, {integrator}, x {factor:.4g}",
                                   [*options, *until(n * limit, 40), *fixed(factor * limit, integrator), *forced], case))  # fmt: skip
    calm = go(0.5)
    if calm is math.inf:
        return math.nan
    lo, hi = 0.5, 32.0
    if bounded(go(hi), calm):
        return math.inf
    while hi > 1.03 * lo:
        mid = math.sqrt(lo * hi)
        lo, hi = (mid, hi) if bounded(go(mid), calm) else (lo, mid)
    return lo


def limits(study):
    """[(regime, integrator, predicted (s), what rules, measured over predicted)]."""
    rows = []
    for regime, (case, options) in BOUNDS.items():
        for integrator in BY_STEPS:
            limit, rules = stable_step(options, integrator, case)
            factor = measured(study, regime, case, options, integrator, limit) if limit > 0 else math.nan
            rows.append((regime, integrator, limit, rules, factor))
            print(f"{regime}, {integrator}: {limit:.4g} s ({rules}), measured x {factor:.3g}", flush=True)
    return rows


# ---------------------------------------------------------------------------------------- the page
class Notes:
    """Reasons of runs that did not finish, numbered as they come, the first of each kind."""

    def __init__(self):
        self.text, self.kinds = [], []

    def __call__(self, said):
        said = said.replace(str(ROOT) + "/", "").replace("|", "\\|")
        kind = re.sub(r"[-+]?\d[\d.]*(e[-+]?\d+)?", "#", said)  # one note for all that differ in their numbers only
        if kind not in self.kinds:
            self.kinds.append(kind)
            self.text.append(said)
        return f"[{self.kinds.index(kind) + 1}]"


def cell(pair, note, show=lambda e: f"{100 * e:.2g} %"):
    if pair is None:
        return ""
    done, value = pair
    if done.kind == "finished":
        return (show(value) if math.isfinite(value) else "finished") + (" **NaN**" if done.nan else "")
    return f"{done.kind if not done.fault else '**' + done.kind + '**'} {note(done.said)}"


def table(head, rows):
    return ["| " + " | ".join(head) + " |", "|" + "---|" * len(head), *("| " + " | ".join(map(str, r)) + " |" for r in rows), ""]


def columns():
    return [*(f"{i}{s}" for i in IMPLICIT for s in ("", ", 1 s")), *BY_STEPS]


def rows_of(found, note, show=None):
    names = columns()
    more = {} if show is None else {"show": show}
    return [[label, *(cell(row.get(n), note, **more) for n in names)] for label, row in found]


def largest(rows, what):
    """Largest of what(outcome) over {run: (outcome, error)} rows."""
    values = [what(d) for _, row in rows for d, _ in row.values() if d.kind == "finished" and math.isfinite(what(d))]
    return max(values, default=math.nan)


def summary(study):
    count = Counter(d.kind for d in study.all.values())
    faults = [f"{n}: {d.kind} {d.said} {'; '.join(d.nan[:3])}" for n, d in study.all.items() if d.fault]
    worst = max((d.balance for d in study.all.values() if d.kind == "finished" and math.isfinite(d.balance)), default=math.nan)
    text = [f"{len(study.all)} runs: " + ", ".join(f"{v} {k}" for k, v in sorted(count.items())) + f". NaN in the files of "
            f"{sum(bool(d.nan) for d in study.all.values())}; no end without a reason: {count['silent'] == 0 and count['crashed'] == 0}; "
            f"not done within {LIMIT:g} s of the wall: {count['hung']}. Largest error of water and methane in any finished run: {worst:.1e} of the "
            "initial mass."]  # fmt: skip
    return [*text, "", *(f"- {f}" for f in faults), *([""] if faults else [])]


def page(study, found):
    note, text = Notes(), []
    text += [*dated.head("Stability at the extremes", "tests/studies/stability.py", PAGE, SOAKED),
             "A representative part is a test: [stability.py](../../tests/verification/stability.py).", "",
             "A run *finishes*, is *refused* at the start (exit code 2), or *stops* (exit code 3, the last good state saved); numbers in brackets "
             "lead to what it said. Every file of every run is searched for NaN.", "", *summary(study)]  # fmt: skip
    text += ["![Largest error of every run](../figures/stability_map.png)", "",
             "*Largest error of every finished run of the map; crosses did not finish.*", ""]  # fmt: skip
    text += ["## Properties", "",
             "The scene is [stability.yaml](../../tests/verification/cases/stability.yaml): a column of 10 cells with hydrate, gas and water, suddenly loaded "
             "by 0.5 MPa at its end, where the pressure falls by 1 MPa at once (less on soft sediment and at low pressure). One property at a time is driven "
             f"to its extreme. `sdirk2` and `euler` run {ADAPTIVE:g} s, with adaptive steps and with fixed steps of 1 s, against a quasi-static run with a tenth of the "
             f"tolerance; `hybrid` and `explicit` run {WINDOW} times their stable step, at half of it, against `sdirk2`. The error is the largest "
             "of pressure, temperature, hydrate saturation and displacement over all cells (means of their four particles), each over its largest change.", ""]  # fmt: skip
    for axis, rows in found["properties"].items():
        text += table([axis, *columns()], rows_of(rows, note))
    every = [r for rows in found["properties"].values() for r in rows]
    grown = [(f"{a} {label}, {n}", d.growth) for a, rows in found["properties"].items() for label, row in rows for n, (d, _) in row.items()
             if n != "explicit" and d.kind == "finished" and d.growth > 1.0]  # fmt: skip
    text += [f"*Energy.* All that drives these scenes acts at t = 0, so the kinetic energy of the second half of a run must not exceed that of the first. It does in "
             f"{len(grown)} of {sum(len(r) - 1 for _, r in every)} runs (`explicit` left out: its steps are so short that the first wave is still being fed)" + (": " + "; ".join(f"{n} ({g:.2g})" for n, g in grown) if grown else "") + ".", ""]
    text += ["## Step", "",
             f"{STEPS} fixed steps of a multiple of the hybrid's stable step, against `sdirk2` with an eighth of the step; errors as above.", "",
             "![Error against step](../figures/stability_steps.png)", ""]  # fmt: skip
    for regime, (limit, rows) in found["steps"].items():
        names = [*INTEGRATORS, "hybrid, forced"]
        text += [f"{regime}: stable step of the hybrid {limit:.3g} s.", "",
                 *table(["step / stable step", *names], [[f"{f:g}", *(cell(row.get(n), note) for n in names)] for f, row in rows])]  # fmt: skip
    text += ["## Predicted and measured stability limits", "",
             "The step that `hybrid` and `explicit` print at their start, and the largest multiple of it with which a run to 4000 times the predicted step stays bounded (no pressure, temperature or "
             "displacement changes more than three times as much as at half the limit), by bisection to 3 % between 0.5 and 32.", "",
             *table(["regime", "integrator", "predicted (s)", "ruled by", "measured / predicted"],
                    [[r, i, f"{limit:.3g}" if limit > 0 else "none", rules.replace(str(ROOT) + "/", ""), "> 32" if f == math.inf else "-" if math.isnan(f) else f"{f:.2f}"]
                     for r, i, limit, rules, f in found["limits"]])]  # fmt: skip
    text += ["## Events", "", "As for the properties; a sliver is what the last particle covers of the next cell.", "",
             *table(["event", *columns()], rows_of(found["events"], note))]  # fmt: skip
    text += ["A saturated block falls freely over 3.1 m, 31 cells, and crosses 0.4 of a cell a step at the end (`hybrid` and `explicit`: their own steps); nothing may strain "
             "it.", "",
             *table(["integrator", "fall off", "largest spurious stress or pressure / ρ g H"],
                    [[i, cell((d, e), note, lambda e: f"{100 * e:.2g} %"), f"{s:.2g}"] for i, d, e, s in found["falling"]])]  # fmt: skip
    text += ["## Consolidation from 1e-9 to 1e-22 m²", "",
             "[cases/terzaghi](../../cases/terzaghi/README.md) on 25 cells to 0.1 H²/c, rms error of the pressure against the closed form over the largest exact value. The "
             "closed form is quasi-static; at 1e-9 m² the run lasts some periods of the column's own waves.", ""]  # fmt: skip
    names = list(found["consolidation"][0][1])
    text += table(["permeability (m²)", *names], [[f"{k:g}", *(cell(row[n], note) for n in names)] for k, row in found["consolidation"]])
    text += ["## Energy of waves", "",
             "A column is pushed at t = 0 and rings, dry and undrained (k = 1e-22 m²), over 400 steps of a multiple of the hybrid's stable step. Largest kinetic energy over "
             "the largest that the exact solution has, q²V/2M: above one by more than the grid's overshoot, energy grows.", "",
             *table(["scene", "step / stable step", *INTEGRATORS],
                    [[n, f"{f:g}", *(cell(row[i], note, lambda e: f"{e:.3g}") for i in INTEGRATORS)] for n, f, row in found["waves"]])]  # fmt: skip
    text += ["## What breaks", "", *breaks(study, found), ""]
    text += [SOAK, "", soak_text()]
    text += ["## What runs said", "", *(f"{k + 1}. {s}" for k, s in enumerate(note.text)), ""]
    return "\n".join(text)


def ripple(folder, field="p"):
    """Largest deviation of a particle's value from the mean of its cell's at the end."""
    v = read_snapshots(folder)[-1][1]
    start = v["position"][:, 0] - v["displacement"][:, 0]
    index = np.floor(start / CELL + 1e-9).astype(int)
    means = cells(v, field)[:, 0]
    return float(np.max(np.abs(v[field][:, 0] - means[np.searchsorted(np.unique(index), index)])))


def off(study, name, field):
    """Largest difference of one field from the reference run of the same scene."""
    reference = study.all[", ".join(name.split(", ")[:-1]) + ", reference"]
    return difference(study.all[name].folder, reference.folder, 1e6, (field,))[field]


def progress(folder):
    """Last whole row of balance.csv of a run that was ended: t and step (s)."""
    row = (folder / "balance.csv").read_text().splitlines()[-2].split(",")
    return float(row[1]), float(row[2])


def breaks(study, found):
    """What was found to break, why, and what became of it."""
    fast = dict(found["properties"]["reaction constant x"])["1e+08"]
    hot = study.all["T (°C) 40, reference"]
    low = dict(found["properties"]["p (MPa)"])["0.1"]
    crawl = {n: f"not done after {LIMIT:g} s of the wall, at t = {progress(d.folder)[0]:.3g} s with steps of {progress(d.folder)[1]:.1g} s" if d.kind == "hung"
             else f"{d.kind} with {d.steps} steps and {d.cut} refused" for n, (d, _) in low.items() if n not in BY_STEPS}  # fmt: skip
    return [
        "Mended; each of these ended runs or cut their steps without end, always because Newton's method was asked for less than round-off:", "",
        "- *Permeability of 1e-19 m² and less with short steps.* The drag is a small difference of two large terms, those of the fluid's and the skeleton's own "
        "velocities. The row of (16) is measured by their round-off where that is larger than 1 MPa over a cell.",
        "- *Reaction constants from 1e6 times on.* The last bit of a pressure makes hydrate and heat beyond the tolerance of (17) and (21). Their rows are measured by the "
        "reaction too.",
        "- *Slivers.* On a node that sees a depth d of the next cell, forces shrink with d and its volume with d². An edge within 1e-6 of a cell moves onto the grid line "
        "(1e-9 before), and rows of (16) are measured by the forces that the pressure has there.",
        "- *Outlets at a tenth of the pressure, hydrate far from equilibrium at 0.1 MPa and less.* What left a coarse cell of gas did so with the density outside, so that the cell could "
        "not drain and p overshot; it has the body's (365). Then the node behind the surface, where p_g goes on with its fall below zero, held Newton's method up, which took half of that node's "
        "own p_g at a time; it takes half of what particles have (349). At 0.1 MPa: "
        + "; ".join(f"`{n}` {said}" for n, said in crawl.items()) + ".", "",
        "Limits that stand:", "",
        "- *Reaction 1e8 times as fast.* The same round-off reaches the mixture's momentum through the stiffness of the hydrate, and steps are cut: "
        + ", ".join(f"`{n}` took {d.steps} steps with {d.cut} refused" for n, (d, _) in fast.items() if n in ("euler, 1 s", "sdirk2, 1 s")) + " for 100 s.",
        "- *Steps that shrink* until the rest would take more than 1e7 of them end a run after 100 of those, and it says so.",
        "- *What nodes cannot see.* A pressure that alternates from particle to particle or from cell to cell has no part in the nodal fields, so neither flow nor Newton's method "
        "removes it. Waves and violent dissociation that are followed with short steps leave it behind, strong damping (`euler`, long steps) does not: after a sudden load of 10 MPa, k = 1e-14 m², "
        f"adaptive `sdirk2` is off by {100 * off(study, 'sudden load of 10 MPa, k = 1e-14 m², sdirk2', 'p'):.2g} % of the scale in p at 100 s, `euler` by "
        f"{100 * off(study, 'sudden load of 10 MPa, k = 1e-14 m², euler', 'p'):.2g} %; at T = 40 °C particles of one cell differ from their mean by up to {ripple(hot.folder) / 1e3:.2g} kPa. For "
        "sudden loads whose waves are of no interest take `inertia: no`.",
        "- *Hydrate of a very fast reaction.* The reaction integrates such small differences into hydrate that stays: at 1e8 times the rate "
        + ", ".join(f"`{n}` is off by {100 * off(study, f'reaction constant x 1e+08, {n}', 'S_h'):.2g} % in S_h and {100 * off(study, f'reaction constant x 1e+08, {n}', 'p'):.1g} % in p"
                    for n in ("sdirk2", "euler")) + ". Waves make hydrate and melt it, and what they leave is not what quasi-static steps leave: without inertia "
        + ", ".join(f"`{n}` is off by {100 * off(study, f'reaction constant x {label}, {n} without inertia', 'S_h'):.2g} % at {label} times the rate"
                    for label in found["fast"] for n in found["fast"][label])
        + f". Where every cell is at equilibrium, how hydrate is shared out is nearly undetermined: interpolated p and T meet p_e(T) only in the mean, so that of two particles of a cell one "
        f"forms what the other melts until it has none: at 1e8 times the rate they differ from their cell's mean by up to {ripple(study.all['reaction constant x 1e+08, reference'].folder, 'S_h'):.2g}, "
        f"at 1e4 times by {ripple(study.all['reaction constant x 10000, reference'].folder, 'S_h'):.2g}.",
        "- *A sliver just above 1e-6 of a cell under a sudden fall of the outlet* takes about twice the outflow in the first step: the face feeds one node more. What "
        "is left at the end is in the table of events.",
        "- *A fixed step at the stable limit itself* ends when the limit falls a little during the run, with the message that says so; `-stepper_adapt yes` follows it."]  # fmt: skip


def draw_map(found, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    names = columns()
    rows = [(f"{axis} {label}", row) for axis, values in found["properties"].items() for label, row in values] + list(found["events"])
    errors = np.array([[row[n][1] if n in row and row[n][0].kind == "finished" else np.nan for n in names] for _, row in rows])
    figure, ax = plt.subplots(figsize=(7.5, 0.17 * len(rows) + 1.6))
    shown = ax.imshow(np.log10(np.maximum(errors, 1e-6)), aspect="auto", cmap="viridis_r", vmin=-5, vmax=0)
    for i, j in zip(*np.nonzero(~np.isfinite(errors))):
        ax.text(j, i, "×", color="crimson", ha="center", va="center", fontsize=8)
    ax.set_xticks(range(len(names)), names, rotation=30, ha="left", fontsize=8)
    ax.xaxis.tick_top()
    ax.set_yticks(range(len(rows)), [n for n, _ in rows], fontsize=6)
    bar = figure.colorbar(shown, ax=ax, label="largest error", shrink=0.5)
    bar.set_ticks(range(-5, 1), labels=[f"$10^{{{k}}}$" for k in range(-5, 1)])
    figure.tight_layout()
    figure.savefig(path, dpi=130)
    plt.close(figure)


def draw_steps(found, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    regimes = found["steps"]
    figure, axes = plt.subplots(1, len(regimes), figsize=(2.7 * len(regimes), 3.0), sharey=True)
    colour = dict(zip([*INTEGRATORS, "hybrid, forced"], ("C0", "C1", "C2", "C3", "C4")))
    for ax, (regime, (_, rows)) in zip(axes, regimes.items()):
        for name, c in colour.items():
            points = [(f, row[name][1]) for f, row in rows if name in row and math.isfinite(row[name][1])]
            gone = [f for f, row in rows if name in row and row[name][0].kind != "finished"]
            if points:
                ax.loglog(*zip(*points), "o-", color=c, ms=3, lw=1, label=name)
            ax.loglog(gone, [3.0 * 1.8 ** (-list(colour).index(name))] * len(gone), "x", color=c, ms=5)
        ax.axvline(1.0, color="0.6", lw=0.8)
        ax.set(title=regime, xlabel="step / stable step")
        ax.title.set_fontsize(9)
    axes[0].set(ylabel="largest error", ylim=(1e-6, 6))
    axes[0].legend(fontsize=6, loc="lower right")
    figure.tight_layout()
    figure.savefig(path, dpi=130)
    plt.close(figure)


SOAK = "## Random scenes and mutated cases"
PARTS = {"properties": properties, "fast": fast, "steps": steps, "events": events, "falling": falling, "consolidation": consolidation, "waves": waves,
         "limits": limits}  # fmt: skip


def soak_text():
    """soak.md with the table of all recorded runs of scripts/soak.py."""
    here = Path(__file__)
    return here.with_name("soak.md").read_text().replace("@table@", soak_table(read_record(SOAKED)))


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n", 1)[1])
    parser.add_argument("program", nargs="?", default=str(ROOT / "build" / "clathra"))
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--only", nargs="*", choices=PARTS)
    parser.add_argument("--soak", action="store_true", help="only the page's section on random scenes, from the record")
    given = parser.parse_args()
    program = Path(given.program).resolve()
    sys.argv[1:] = [str(program)]
    if given.soak:
        before, rest = PAGE.read_text().split(SOAK + "\n", 1)
        before = re.sub(r"^- Data: .*", dated.data(PAGE, SOAKED), before, count=1, flags=re.M)
        PAGE.write_text(f"{before}{SOAK}\n\n{soak_text()}\n{rest[rest.index('## '):]}")
        return
    FOLDER.mkdir(parents=True, exist_ok=True)
    study = Study(program, given.fresh)
    found = {name: part(study) for name, part in PARTS.items() if given.only is None or name in given.only}
    if given.only is not None:
        return
    draw_map(found, FIGURES / "stability_map.png")
    draw_steps(found, FIGURES / "stability_steps.png")
    dated.measured(PAGE)
    PAGE.write_text(page(study, found))
    print(PAGE)


if __name__ == "__main__":
    main()
