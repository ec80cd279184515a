"""One page on a run that opens anywhere, offline: clathra report FOLDER [FOLDER ...] writes FOLDER/report.html

It holds what the run said, its steps, histories, meters, balances, the scene with its mesh and conditions, and the body at the
output times as a film.  Numbers of the film are rounded to 1/254 of their range; BYTES bounds what they may take.
"""
import base64
import html
import json
import re
import sys
from pathlib import Path

import numpy as np

from . import shown
from .run import FINDING, Run
from .tables import Damaged, probe_names
from .units import duration, durations, time_unit

TEMPLATE = Path(__file__).with_name("report.html")
BYTES = 3_000_000  # of the film, before base64
FRAMES = 60  # at most
POINTS = 500  # of a curve, at most
ARROWS = 250
LEAST = 16  # frames, before particles are left out
FLUIDS = {"v_w": "water", "v_g": "gas"}
EMPTY = 255  # a value that is not a number


def packed(array, kind):
    return base64.b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode()


def number(x):
    if isinstance(x, str):
        raise Damaged(f"the case has '{x}' where a number should stand")
    return None if not np.isfinite(x) else float(f"{x:.5g}")


# ---------------------------------------------------------------- curves
def thinned(x, y):
    """Lists of at most POINTS points, the lowest and highest of each part among them."""
    keep = np.arange(len(x))
    if len(x) > POINTS:
        parts = np.array_split(keep, POINTS // 2)
        filled = np.nan_to_num(y)
        keep = np.unique([0, len(x) - 1] + [f(filled[k]) + k[0] for k in parts for f in (np.argmin, np.argmax)])
    return [float(f"{v:.7g}") for v in x[keep]], [number(v) for v in y[keep]]


def time_axis(run):
    """What every chart over time shares: the map of times, label, and the ends of stages with their lengths."""
    stages = shown.stage_axis(run.balance)
    if stages:
        lengths = np.diff([0.0, *stages[1]])
        return stages[0], {"label": "time in each stage, of this length", "stages": [duration(n) for n in lengths]}
    unit, seconds = time_unit(max((t["time_s"][-1] for t in (run.balance, run.probes) if len(t.get("time_s", ()))), default=1.0))
    return (lambda t: t / seconds), {"label": f"time ({unit})"}


def chart(axis, label, series, title="", **more):
    """series: [(name, t (s), values)]; nothing where all are empty."""
    to_axis, x = axis
    lines = [dict(zip(("x", "y"), thinned(to_axis(t), np.asarray(v))), name=name) for name, t, v in series if len(t)]
    return [{"title": title, "y": label, "xlabel": x["label"], "stages": x.get("stages"), "series": lines, **more}] if lines else []


def probe_charts(run, axis):
    names, charts = run.probe_names, []
    for label, unit, columns, least in shown.histories(run.probes, names):
        series = [(f"{n} {c[2]}".strip(), run.probes["time_s"], shown.curve(run.probes, n, c[0]) * c[1]) for n in names for c in columns]
        charts += chart(axis, f"{label} ({unit})", series, least=least, group=len(columns))
    return charts


def meter_charts(run, axis):
    if not len(run.meters.get("time_s", ())):
        return []
    panels = shown.production(run.meters, probe_names(run.meters))
    return [c for label, curves in panels for c in chart(axis, label, [(n, run.meters["time_s"], v) for n, v in curves])]


def step_charts(run, axis):
    b = run.balance
    steps = chart(axis, "length of a step (s)", [("step", b["time_s"], b["dt_s"])], log=True)
    return steps + (chart(axis, "Newton iterations of a step", [("Newton", b["time_s"], b["newton"])]) if b["newton"].any() else [])


ENERGIES = {"kinetic_energy_J": "kinetic", "elastic_energy_J": "elastic", "plastic_work_J": "plastic work", "gravity_work_J": "gravity's work",
            "load_work_J": "loads' work", "plate_work_J": "plates' work", "pressure_work_J": "pressures' work", "drag_work_J": "drag",
            "damping_work_J": "damping", "energy_remainder_J": "remainder"}  # fmt: skip

HEATS = {"heat_in_J": "given by conditions", "enthalpy_out_J": "out with the fluids", "enthalpy_error_J": "missing"}


def balance_charts(run, axis):
    b, charts = run.balance, []
    errors = [(name, b["time_s"], np.maximum(np.abs(b[f"{column}_error"]), 1e-18)) for column, name in
              (("water", "water"), ("methane", "methane"), ("heat", "energy (of 1 K)")) if b[f"{column}_error"].any()]  # fmt: skip
    charts += chart(axis, "what is missing, of the initial store (–)", errors, log=True)
    if "enthalpy_J" in b and len(b["time_s"]):
        heat = {"stored": b["enthalpy_J"] - b["enthalpy_J"][0]} | {name: b[c] for c, name in HEATS.items()}
        charts += chart(axis, "enthalpy (J)", [(name, b["time_s"], v) for name, v in heat.items() if np.abs(v).max() > 0])
    largest = max((np.abs(b[c]).max() for c in ENERGIES if c in b and len(b[c])), default=0.0)
    energies = [(name, b["time_s"], b[c]) for c, name in ENERGIES.items() if c in b and len(b[c]) and np.abs(b[c]).max() > 1e-3 * largest]
    charts += chart(axis, "mechanical energy (J)", energies)
    if len(b["time_s"]) and b["hydrate_kg"].any():
        charts += chart(axis, "hydrate (kg)", [("hydrate", b["time_s"], b["hydrate_kg"])])
    return charts


# ---------------------------------------------------------------- the scene and the film
def conditions(run, first):
    """[{name, type, says, lines: [[x0, y0, x1, y1], ...]}] of each boundary, on the body as it was seeded."""
    texts, found = run.texts, []
    x, l = first["position"], first["half_length"]
    for name in run.names("boundaries"):
        prefix = f"bc_{name}_"
        said = {k[len(prefix) :]: v for k, v in texts.items() if k.startswith(prefix)}
        keys = {k[len(prefix) :]: v for k, v in run.case.items() if k.startswith(prefix)}
        says = ", ".join(f"{k}: {v}" for k, v in said.items() if k != "type" and v not in DULL)
        found.append({"name": name, "type": said["type"], "says": says, "lines": places(run, keys, x, l)})
    return found


DULL = ("all", "start", "end", "run", "none", "no", "both")  # values that say nothing about a boundary


def places(run, keys, x, l):
    low, high = ([run.case[f"grid_{end}"][a] for a in shown.axes(run)] for end in ("lower", "upper"))
    if "axis" in keys and keys["axis"] not in shown.names(run):
        return []
    if "axis" in keys:
        k = shown.names(run).index(keys["axis"])
        ends = [low[1 - k], high[1 - k]]
        return [[keys["position"], ends[0], keys["position"], ends[1]] if k == 0 else [ends[0], keys["position"], ends[1], keys["position"]]]
    if keys["type"] in IN_REGION:
        return edges(run, keys["region"])
    if isinstance(keys.get("along"), list):
        return [[*a, *b] for a, b in zip(keys["along"], keys["along"][1:])]
    sides = {side: (k, out) for k, name in enumerate(shown.names(run)) for side, out in zip(SIDES[name], (-1, 1))}
    return outermost(keys, *sides[keys["side"]], x, l) if keys.get("side") in sides else []


SIDES = {"x": ("left", "right"), "y": ("bottom", "top"), "z": ("back", "front")}


IN_REGION = ("region_temperature", "heat_source")


def edges(run, region):
    """Of the box about a region, or of nothing where the condition acts on all of them."""
    if f"region_{region}_lower" not in run.case:
        return []
    a, b, c, d = (run.case[f"region_{region}_{end}"][k] for k in shown.axes(run)[:2] for end in ("lower", "upper"))
    return [[a, c, b, c], [b, c, b, d], [b, d, a, d], [a, d, a, c]]


def outermost(keys, k, out, x, l):
    """Faces of the outermost particles on the side out (-1, 1) along axis k, from `from` to `to`."""
    along = x[:, 1 - k]
    rows = np.floor(along / (2 * l[:, 1 - k].min())).astype(int)
    start, end = (keys.get(w) if isinstance(keys.get(w), float) else s * np.inf for w, s in (("from", -1), ("to", 1)))
    found = []
    for row in np.unique(rows):
        held = np.flatnonzero(rows == row)
        p = held[np.argmax(out * x[held, k])]
        if not start <= along[p] <= end:
            continue
        face, a, b = x[p, k] + out * l[p, k], along[p] - l[p, 1 - k], along[p] + l[p, 1 - k]
        found.append([face, a, face, b] if k == 0 else [a, face, b, face])
    return [[number(v) for v in line] for line in found]


def scene(run, first, last):
    corner = np.concatenate([shown.corners(p, first).reshape(-1, 2) for p in (first, last)])
    box, axes = [run.case["grid_lower"], run.case["grid_upper"]], shown.axes(run)[:2]
    return {"grid": [[number(v) for v in run.lines[a]] for a in axes], "box": [[number(b[a]) for a in axes] for b in box], "up": shown.names(run)[1],
            "body": [[number(v) for v in corner.min(0)], [number(v) for v in corner.max(0)]],
            "regions": run.names("regions"), "region": packed(first["region"], "u1"), "conditions": conditions(run, first),
            "probes": [{"name": n, "at": [number(run.case[f"probe_{n}_at"][a]) for a in axes]} for n in run.names("probes")
                       if isinstance(run.case.get(f"probe_{n}_at", [None])[0], float)]}  # fmt: skip


def film_scene(run, pictures):
    """The scene beside the film."""
    first = shown.plane(run, run.times[0])
    return {**scene(run, first, shown.plane(run, None)), "region": packed(first["region"][:: pictures["stride"]], "u1")}


def chosen(run, n, each):
    """Indices of the snapshots to show, and every how many-th particle, within BYTES."""
    stride = 1
    while n // stride * each * min(LEAST, len(run.times)) > BYTES:
        stride += 1
    return shown.spread(len(run.times), min(FRAMES, max(2, BYTES // (n // stride * each)))), stride


def film(run):
    """The body at the output times; None without snapshots."""
    if not len(run.times):
        return None
    first = shown.plane(run, run.times[0])
    wanted = shown.shown([shown.drawn(run, t) for t in run.times[shown.spread(len(run.times), 8)]], shown.names(run))
    frames, stride = chosen(run, len(first["id"]), 8 + len(wanted))
    ids = slice(None, None, stride)
    edges, place, values, flows = [], [], [], []
    at = with_arrows(first["position"][ids])
    for k in frames:
        p = shown.drawn(run, run.times[k])
        edges.append(shown.half_edges(p, first)[ids].reshape(-1, 4))
        place.append(p["position"][ids])
        values.append([q.of(p)[ids] for q in wanted])
        flows.append([(p[v] - p.get("v_s", 0.0))[ids][at] for v in FLUIDS if v in p])
    edges, place = np.array(edges), np.array(place)
    low, longest = place.min((0, 1)), np.abs(edges).max()
    span = np.where(place.max((0, 1)) > low, place.max((0, 1)) - low, 1.0)
    return {"times": durations(run.times[frames]), "n": place.shape[1], "stride": stride, "all": len(run.times),
            "strip": shown.strip_axis(first["position"]), "low": low.tolist(), "span": span.tolist(), "longest": float(longest),
            "place": packed(np.round((place - low) / span * 65535), "<u2"), "edges": packed(np.round(edges / longest * 127), "i1"),
            "fields": [field(q, np.array([v[k] for v in values])) for k, q in enumerate(wanted)], "arrow_at": packed(at, "<u4"), "arrow_way": number(min(map(shown.least_way, place[:, at]))),
            "arrows": [{"name": name, "v": packed([f[k] for f in flows], "<f4")}
                       for k, name in enumerate(n for v, n in FLUIDS.items() if v in first)]}  # fmt: skip


def field(q, values):
    """A quantity at all frames: levels 0 to 254 from low to high, EMPTY where there is no number."""
    finite = values[np.isfinite(values)]
    low, high = (finite.min(), finite.max()) if finite.size else (0.0, 0.0)
    levels = np.round((np.nan_to_num(values) - low) / (high - low or 1.0) * 254)
    return {"key": q.key, "label": q.label, "unit": q.unit, "low": float(low), "high": float(high),
            "data": packed(np.where(np.isfinite(values), np.clip(levels, 0, 254), EMPTY), "u1")}  # fmt: skip


def with_arrows(place):
    """Indices of particles that lie evenly, no more than about ARROWS."""
    extent = np.ptp(place, axis=0)
    return shown.apart(place, max(np.sqrt(extent.prod() / ARROWS), extent.max() / ARROWS))


# ---------------------------------------------------------------- words
def facts(run):
    """Lines of the log by what they are, and forecast against fact."""
    lines = run.log.splitlines()
    took = re.search(r"integrator (.*)", run.summary)
    refused = {}
    for line in lines:
        why = re.search(r"refused \(([^:)]*): (.*?) near", line)
        if why:
            refused[why[2]] = refused.get(why[2], 0) + 1
    ruled = {}
    for line in lines:
        word = re.search(r", ([\w -]+) rules", line) or re.search(r"of tolerance \(([^)]*)\)", line)
        if word:
            ruled[word[1]] = ruled.get(word[1], 0) + 1
    commands = [line[2:] for line in lines if line.startswith("$ ")]
    return {
        "warnings": run.findings,
        "forecast": [line.strip().replace("forecast: ", "") for line in lines if "forecast: " in line],
        "fact": took[1] if took else "the run has not ended",
        "refused": sorted(refused.items(), key=lambda r: -r[1]), "ruled": sorted(ruled.items(), key=lambda r: -r[1]),
        "command": commands[-1] if commands else "", "begun": lines[0][2:] if lines and lines[0].startswith("# ") else "",
    }  # fmt: skip


def page(run, damaged):
    """The page of a run, HTML; what a damaged file would have shown is left out, with a sentence in `damaged`."""
    axis, either = time_axis(run), lambda else_, part, *arguments: shown.unless_damaged(damaged, else_, part, *arguments)
    charts = {name: either([], part, run, axis) for name, part in (("production", meter_charts), ("probes", probe_charts), ("steps", step_charts), ("balance", balance_charts))}
    pictures = either(None, film, run)
    drawn = either(None, film_scene, run, pictures) if pictures else None
    data = {"title": run.title + (shown.where(run) if pictures else ""), "folder": str(run.folder.resolve()), "finished": run.finished, "summary": FINDING.sub("", run.summary).rstrip(), **facts(run),
            "film": pictures if drawn else None, "scene": drawn, "case": (run.folder / "case.yaml").read_text(encoding="utf-8", errors="replace"), "log": run.log[-200_000:], "charts": charts}  # fmt: skip
    data["warnings"] = [*dict.fromkeys(damaged), *data["warnings"]]
    said = {"title": html.escape(run.title), "data": json.dumps(data, allow_nan=False, ensure_ascii=False).replace("<", "\\u003c")}  # no tag within a script
    return re.sub(r"{{(title|data)}}", lambda place: said[place[1]], TEMPLATE.read_text(encoding="utf-8"))


def main(folders):
    if not folders or folders[0].startswith("-"):
        print(__doc__, file=sys.stdout if folders else sys.stderr)
        return 0 if folders else 2
    ends_well = True
    for folder in folders:
        damaged = []
        text = page(Run(folder, damaged.append), damaged)
        out = Path(folder) / "report.html"
        out.write_text(text, encoding="utf-8")
        print(f"  {out} ({len(text.encode()) / 1e6:.2g} MB)")
        for sentence in dict.fromkeys(damaged):
            print(f"clathra report: {sentence}; what needs it is not shown", file=sys.stderr)
        ends_well = ends_well and not damaged
    return 0 if ends_well else 2
