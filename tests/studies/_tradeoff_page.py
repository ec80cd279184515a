"""docs/studies/tradeoff.md and its figures from what tradeoff.py measured; every number is taken from the data."""
import json
from pathlib import Path

import dated
import numpy as np
from clathra.units import YEAR
from clathra.plotting import COLOURS, plt, save, set_style
from slopes import STEP_OF_HYBRID

KINDS = ("euler", "sdirk2", "explicit", "hybrid")
COLOUR = dict(zip(KINDS, COLOURS))
MARK = dict(zip(KINDS, "osv^"))
EXPLICIT = ("explicit", "hybrid")


# ----------------------------------------------------------------------------------------------------------- helpers
def seconds(s):
    """A time of four digits at most, in the unit that suits it."""
    for name, size in (("years", YEAR), ("days", 86400.0), ("h", 3600.0), ("min", 60.0)):
        if s >= 2 * size:
            return f"{s / size:.3g} {name}"
    return f"{s:.2g} s" if s >= 0.1 else f"{1e3 * s:.2g} ms" if s > 1e-4 else f"{s:.1e} s"


def percent(x):
    return f"{100 * x:.2g} %" if x < 0.995 else f"{100 * x:.0f} %"


def times(x):
    return f"{x:.0f}" if x >= 10 else f"{x:.2g}"


def table(header, rows):
    text = [[c if isinstance(c, str) else f"{c:.4g}" for c in row] for row in rows]
    return ["| " + " | ".join(r) + " |" for r in [list(header), ["---"] * len(header), *text]] + [""]


def good(points):
    return [p for p in points if "error" in p]


def best(points, kind, bar):
    """The cheapest run of a kind with no more error than the bar, or None."""
    fit = [p for p in good(points) if p["kind"] == kind and p["error"] <= bar]
    return min(fit, key=lambda p: p["cpu"]) if fit else None


def kinds_of(points):
    return [k for k in KINDS if any(p["kind"] == k for p in points)]


def cheapest_table(points, bars):
    """For each integrator: processor time of its cheapest run within each bar, with grid and step."""
    rows = []
    for kind in kinds_of(points):
        cells = []
        for bar in bars:
            p = best(points, kind, bar)
            cells.append(f"{seconds(p['cpu'])} ({p['cells'][0]} cells, {p['setting']})" if p else "not reached")
        least = min((p["error"] for p in good(points) if p["kind"] == kind), default=None)
        rows.append([f"`{kind}`", *cells, "-" if least is None else percent(least)])
    return table(["integrator", *(f"within {percent(b)}" for b in bars), "least error of all runs"], rows)


def ratio(points, bar, over=("euler", "sdirk2"), under="hybrid"):
    """Time of the best implicit over that of the hybrid, both within the bar, with their runs; None if one is missing."""
    a = [p for k in over if (p := best(points, k, bar))]
    b = best(points, under, bar)
    a = min(a, key=lambda p: p["cpu"]) if a else None
    return (a["cpu"] / b["cpu"], a, b) if a and b else None


def compare(points, bar, what):
    """A sentence: which kind is cheaper for the bar, and by how much."""
    r = ratio(points, bar)
    if r is None:
        sides = [k for k in KINDS if best(points, k, bar)]
        return f"{what}: {percent(bar)} is reached by {', '.join(f'`{k}`' for k in sides) or 'none'} only."
    factor, a, b = r
    if 0.8 < factor < 1.25:
        return f"{what}: the same ({seconds(b['cpu'])} by `hybrid`, {seconds(a['cpu'])} by `{a['kind']}`, within {percent(bar)})."
    less, more = (b, a) if factor >= 1 else (a, b)
    return (f"{what}: `{less['kind']}` is the cheaper one, {times(more['cpu'] / less['cpu'])} times ({seconds(less['cpu'])} against "
            f"{seconds(more['cpu'])} of `{more['kind']}`, within {percent(bar)}).")  # fmt: skip


# ----------------------------------------------------------------------------------------------------------- figures
def draw_work(axes, points, title):
    for kind in kinds_of(points):
        mine = [p for p in good(points) if p["kind"] == kind]
        if not mine:
            continue
        sizes = sorted({p["cells"][0] for p in mine})
        for n in sizes:
            at = sorted((p["cpu"], p["error"]) for p in mine if p["cells"][0] == n)
            far = any(p.get("setting", "").endswith("extrapolated") for p in mine)
            axes.plot(*zip(*at), MARK[kind], ls=":" if len(at) > 1 else "", color=COLOUR[kind], ms=3 + 2.2 * sizes.index(n), lw=0.8,
                      mfc="none" if far else COLOUR[kind], label=kind if n == sizes[-1] else None)  # fmt: skip
    axes.set(xscale="log", yscale="log", title=title, xlabel="processor time (s)", ylabel="largest error (–)")
    axes.legend()


def waves(data):
    return list(dict.fromkeys(p["name"] for p in data["wave"]))


def work_figure(data, folder):
    figure, axes = plt.subplots(2, 4, figsize=(15.5, 7.2))
    panels = [([p for p in data["wave"] if p["name"] == name], f"wave, {name}") for name in waves(data)]
    panels += [(data["consolidation"], "fast consolidation")]
    panels += [([p for p in data["bp2"] if p["case"] == c], f"BP2 case {c}") for c in (1, 2)]
    panels += [([p for p in data["block"] if "setting" in p], "dissociating block, error of the step")]
    for a, letter, (points, title) in zip(axes.flat, "abcdefgh", panels):
        draw_work(a, points, f"{letter}) {title}")
    for a in axes.flat[len(panels) :]:
        a.set_axis_off()
    save(figure, folder, "tradeoff_work")


def permeability_figure(points, folder):
    figure, axes = plt.subplots(1, 2, figsize=(11, 4.4), sharey=True)
    for a, Kw, title in zip(axes, (22e6, 2.2e9), ("a) water of 22 MPa", "b) water of 2.2 GPa")):
        for kind in kinds_of(points):
            mine = sorted((p["k"], p["cpu"], p["extrapolated"]) for p in points if p["Kw"] == Kw and p["kind"] == kind and kept(p))
            if not mine:
                continue
            k, cpu, far = map(np.array, zip(*mine))
            a.plot(k, cpu, "-", color=COLOUR[kind], lw=1)
            a.plot(k[~far], cpu[~far], MARK[kind], color=COLOUR[kind], label=kind)
            a.plot(k[far], cpu[far], MARK[kind], color=COLOUR[kind], mfc="white", label=None if (~far).any() else f"{kind} (extrapolated)")
        a.set(xscale="log", yscale="log", title=title, xlabel="permeability (m²)", ylabel="processor time (s)")
        a.invert_xaxis()
        a.legend()
    save(figure, folder, "tradeoff_permeability")


def basis_figure(points, folder):
    kinds = kinds_of(points)
    figure, axes = plt.subplots(1, 3, figsize=(12.5, 3.9))
    for kind in kinds:
        for j, name in enumerate(("linear", "ugimp", "cpgimp")):
            mine = sorted((p["particles"], p["error"], p["noise"], p["cpu"]) for p in good(points) if p["kind"] == kind and p["basis"] == name)
            for a, k in zip(axes, (1, 2, 3)):
                if mine:
                    a.plot([m[0] for m in mine], [m[k] for m in mine], MARK[kind], ls=("-", "--", ":")[j], color=COLOURS[j],
                           mfc="none" if kind == "hybrid" else COLOURS[j], label=f"{name}, {kind}")  # fmt: skip
    for a, what in zip(axes, ("a) error (–)", "b) ringing of pressure over the load (–)", "c) processor time (s)")):
        a.set(yscale="log", title=what, xlabel="particles per cell", xticks=(4, 9, 16))
    axes[2].legend(fontsize=7)
    save(figure, folder, "tradeoff_basis")


# ---------------------------------------------------------------------------------------------------------- sections
def about_waves(data):
    text = []
    for name in waves(data):
        points = [p for p in data["wave"] if p["name"] == name]
        text += [f"{name[0].upper()}{name[1:]}:", "", *cheapest_table(points, (0.05, 0.02, 0.01, 0.005))]
    return text


def about_bp2(data):
    text = []
    for case in (1, 2):
        points = [p for p in data["bp2"] if p["case"] == case]
        text += [f"Case {case}:", "", *cheapest_table(points, (0.05, 0.02, 0.01))]
        rows = [[f"`{p['kind']}`, {p['setting'].split(',')[0]}", str(p["cells"][0]), seconds(p["measured_time"]),
                 f"{p['measured_steps']}", seconds(p["measured_cpu"]), f"{p['steps']:.2g}",
                 seconds(p["cpu"]), percent(p["error"]) if "error" in p else f"none: stopped at {p['reached']:.3g} of 2 s"]
                for p in points if p["kind"] in EXPLICIT]  # fmt: skip
        text += table(["integrator", "cells", "measured part of 2000 s", "its steps", "its processor time", "steps in all", "extrapolated time",
                       "error, of the run in 2 s"], rows)  # fmt: skip
    return text


def bp2_bar(data):
    """The bar of case 2: the best implicit run within 1 % against the hybrid."""
    points = [p for p in data["bp2"] if p["case"] == 2]
    a = min((p for k in ("euler", "sdirk2") if (p := best(points, k, 0.01))), key=lambda p: p["cpu"], default=None)
    mine = [p for p in points if p["kind"] == "hybrid" and p["setting"].startswith("damping")]
    if a is None or not mine:
        return "BP2 case 2 within 1 %: no implicit run or no hybrid."
    b = best(points, "hybrid", 0.01)
    same = next(p for p in mine if p["cells"] == a["cells"])
    said = f"BP2 case 2 within 1 %: `{a['kind']}` ({a['cells'][0]} cells, {a['setting']}) takes {seconds(a['cpu'])}"
    if b:
        more = times(b["cpu"] / a["cpu"])
        return f"{said}, `hybrid` ({b['cells'][0]} cells) {seconds(b['cpu'])}, extrapolated: {more} times as much. The bar is 1000."
    end = "does not come to the end of the case" if "error" not in same else f"is {percent(same['error'])} off there"
    verdict = "more" if same["cpu"] / a["cpu"] >= 1000 else "less"
    return (f"{said}. `hybrid` on the same grid takes {seconds(same['cpu'])}, extrapolated, {times(same['cpu'] / a['cpu'])} times as much "
            f"and {verdict} than the bar of 1000, and {end}; within 1 % it comes on none of these grids.")  # fmt: skip


def about_block(data):
    points = [p for p in data["block"] if "setting" in p]
    rows = [[f"`{p['kind']}`", p["setting"], p["steps"], seconds(p["cpu"]), percent(p["error"])] for p in good(points)]
    other = [p for p in data["block"] if "setting" not in p]
    each = [", ".join(f"{k} {percent(v)}" for k, v in o["each"].items()) for o in other]
    said = [f"Resolved in time, `hybrid` and `sdirk2` differ on this grid by {e}: that is space." for e in each]
    return [*table(["integrator", "step", "steps", "processor time", "error of the step"], rows), *said, ""]


def kept(p):
    """A point of the sweep that counts: within the bar, or extrapolated."""
    return "cpu" in p and (p["extrapolated"] or p["off"] <= 0.01)


def slope(points, Kw, kind, least=0.0, most=1.0):
    mine = [(np.log10(p["k"]), np.log10(p["cpu"])) for p in points if p["Kw"] == Kw and p["kind"] == kind and kept(p) and least <= p["k"] <= most]
    return float(np.polyfit(*zip(*mine), 1)[0]) if len(mine) > 2 else float("nan")


def crossing(points, Kw):
    """Permeability where hybrid and the best implicit cost the same, on straight lines in logarithms; None if there is none."""
    at = lambda kinds: {p["k"]: min(q["cpu"] for q in points if q["k"] == p["k"] and q["Kw"] == Kw and q["kind"] in kinds and kept(q))
                        for p in points if p["Kw"] == Kw and p["kind"] in kinds and kept(p)}  # fmt: skip
    a, b = at(("hybrid",)), at(("euler", "sdirk2"))
    k = sorted(set(a) & set(b))
    gap = [np.log(a[x] / b[x]) for x in k]
    for i in range(len(k) - 1):
        if gap[i] > 0 >= gap[i + 1]:
            part = gap[i] / (gap[i] - gap[i + 1])
            return float(np.exp(np.log(k[i]) + part * (np.log(k[i + 1]) - np.log(k[i]))))
    return None


def about_permeability(points):
    text, rows = [], []
    for Kw, name in ((22e6, "22 MPa"), (2.2e9, "2.2 GPa")):
        k = crossing(points, Kw)
        low = f"{slope(points, Kw, 'hybrid', 0, 1e-9):+.2f}"
        flat = f"{slope(points, Kw, 'sdirk2', 0, 1e-9):+.2f}"
        steep = f"{slope(points, Kw, 'explicit', 0, 1e-9):+.2f}"
        meet = f"hybrid and implicit cost the same at k = {k:.1e} m²; below it the implicit ones win. " if k else "the curves do not cross in this range. "
        text.append(f"Water of {name}: {meet}"
                    f"Below 1e-9 m² the time goes as k to the power {low} (`hybrid`), {steep} (`explicit`) and {flat} (`sdirk2`).")
        for p in points:
            if p["Kw"] == Kw and "cpu" in p and round(np.log10(p["k"])) in (-7, -8, -9, -12, -15, -18):
                rows.append([name, f"{p['k']:.0e}", f"`{p['kind']}`", seconds(p["end"]), f"{p['steps']:.3g}", seconds(p["cpu"]),
                             "extrapolated" if p["extrapolated"] else percent(p["off"]) + ("" if kept(p) else ", bar missed")])  # fmt: skip
    header = ["water", "k (m²)", "integrator", "simulated", "steps", "processor time", "error"]
    return [*(line for t in text for line in (t, "")), *table(header, rows)]


def about_terms(points):
    text = []
    for kind in kinds_of(points):
        mine = [p for p in points if p["kind"] == kind]
        base, rows = mine[0], []
        for p in mine:
            if p is not base and not any(p.get("change", {"": 1}).values()):
                continue  # this kind has no such term
            if "change" in p:
                change = [percent(p["change"][k]) if k in p["change"] else "-" for k in base["change"]]
                rows.append([p["left out"], p["steps"], seconds(p["cpu"]), f"{p['cpu'] / base['cpu']:.2f}", *change])
            else:
                rows.append([p["left out"], "-", "-", "-", f"refused: {p['why'][:90]}", *["-"] * (len(base["change"]) - 1)])
        header = ["left out", "steps", "processor time", "of that with all", *(f"change of {k}" for k in base["change"])]
        text += [f"`{kind}`:", "", *table(header, rows)]
    return text


def about_basis(points):
    rows = [[f"`{p['kind']}`", p["basis"], p["particles"], *((percent(p["error"]), f"{p['noise']:.1e}", seconds(p["cpu"])) if "error" in p
             else (f"gave up: {p['why'][:70]}", "-", "-"))] for p in points]  # fmt: skip
    return table(["integrator", "basis", "particles per cell", "error", "ringing over the load", "processor time"], rows)


def measured(data, part, which):
    """{hybrid, implicit: seconds within 1 %} of a scene; what is missing did not reach it."""
    points = [p for p in data[part] if all(p.get(k) == v for k, v in which.items())]
    found = {}
    for name, kinds in (("hybrid", ("hybrid",)), ("implicit", ("euler", "sdirk2"))):
        if part == "permeability":
            times_ = [p["cpu"] for p in points if p["kind"] in kinds and kept(p)]
        else:
            times_ = [q["cpu"] for kind in kinds if (q := best(points, kind, 0.01))]
        if times_:
            found[name] = min(times_)
    return found


def about_choice(data):
    rows, right = [], []
    for c in data["choice"]:
        found, took = measured(data, c["part"], c["which"]), "hybrid" if c["chosen"] == "hybrid" else "implicit"
        scene = ", ".join([c["scene"], *(f"{k} = {v:.1e}" for k, v in c["which"].items() if k in ("Kw", "k")), *([c["which"]["name"]] if "name" in c["which"] else [])])
        if len(found) == 2:
            right.append(found[took] <= 1.25 * min(found.values()))
        shown = [seconds(found[k]) if k in found else "not reached" for k in ("hybrid", "implicit")]
        rows.append([scene, f"`{c['chosen']}`", c["forecast"].rsplit(";", 1)[0], *shown,
                     ("yes" if right[-1] else "**no**") if len(found) == 2 else "-"])  # fmt: skip
    said = f"`auto` takes the cheaper kind (or one within a quarter of it) in {sum(right)} of {len(right)} scenes that both kinds bring within 1 %."
    return said, table(["scene", "`auto` takes", "its forecast", "measured, `hybrid`", "measured, best implicit", "right"], rows)


def about_change(points):
    """Each stretch of the slow phases: time of `auto` and of either kind alone."""
    rows = []
    for slow in sorted({p["slow"] for p in points}):
        auto, hybrid, implicit = ({p["kind"]: p for p in points if p["slow"] == slow}[kind] for kind in ("auto", "hybrid", "sdirk2"))
        rows.append([times(slow), *(f"{seconds(p['cpu'])}, {p['steps']} steps{' (extrapolated)' if p.get('extrapolated') else ''}" for p in (auto, hybrid, implicit)),
                     times(hybrid["cpu"] / auto["cpu"]), *(percent(p["error"]) if "error" in p else "-" for p in (auto, hybrid, implicit)), auto["changes"]])  # fmt: skip
    return table(["slow phases x", "`auto`", "`hybrid` alone", "`sdirk2` alone", "`hybrid` over `auto`", "error of `auto`", "of `hybrid`", "of `sdirk2`", "changes"], rows)


def about_crossing(points):
    said = []
    for Kw, name in ((22e6, "gassy water"), (2.2e9, "water of 2.2 GPa")):
        k, top = crossing(points, Kw), max(p["k"] for p in points if p["Kw"] == Kw and kept(p))
        said.append(f"above k = {k:.0e} m² with {name}" if k else f"nowhere up to {top:.0e} m² with {name}")
    steep, flat = (10 ** -slope(points, 2.2e9, kind, 0, 1e-9) for kind in ("hybrid", "sdirk2"))
    return (f"Consolidation over its own time, a column of 10 m on 25 cells: `hybrid` pays {', '.join(said)}; below, each decade of permeability "
            f"costs it {times(steep)} times more, and `sdirk2` {flat:.2f} times.")  # fmt: skip


def about_damping(points):
    bare = next((p for p in points if p["case"] == 2 and p["setting"].startswith("no damping")), None)
    if bare is None:
        return "BP2 case 2 was not run without damping."
    what = f"is {100 * bare['error']:.0f} % off at the end" if "error" in bare else f"stops at {bare['reached']:.3g} of 2 s"
    return (f"`hybrid` wants `-stepper_damping` (0.1 here) on fast BP2 case 2: without it it {what} ({bare['cells'][0]} cells), for stiffness that follows hydrate feeds waves "
            "(docs/equations.md, section 12).")  # fmt: skip


def advice(data):
    lines = [compare([p for p in data["wave"] if p["name"] == name], 0.02 if "sudden" in name else 0.01, f"A wave, {name}") for name in waves(data)]
    lines += [compare(data["consolidation"], 0.01, "Fast consolidation"), bp2_bar(data)]
    case1 = compare([p for p in data["bp2"] if p["case"] == 1], 0.02, "BP2 case 1")
    lines.append(case1)
    lines += [about_crossing(data["permeability"]), about_damping(data["bp2"])]
    implicit = [p for p in data["terms"] if p["kind"] == "sdirk2" and "change" in p]
    cheaper = sorted((p["cpu"] / implicit[0]["cpu"], max(p["change"].values()), p["left out"]) for p in implicit[1:])
    free = [c for c in cheaper if c[1] < 0.01]
    saves = [c for c in free if c[0] < 0.8]
    lines.append("What can go on the dissociating block for less than 1 % of any curve: "
                 + "; ".join(f"{n} ({percent(c)})" for t, c, n in free) + ". It saves: "
                 + ("; ".join(f"{n}, time x {t:.2f}" for t, c, n in saves) or "nothing worth it") + ".")  # fmt: skip
    dear = [c for c in cheaper if c[1] > 0.05]
    lines.append("What must stay (more than 5 % of a curve): " + "; ".join(f"{n} ({percent(c)})" for t, c, n in dear) + ".")
    four = {p["basis"]: p for p in good(data["basis"]) if p["kind"] == "sdirk2" and p["particles"] == 4}
    lines.append("Basis with `sdirk2`, 4 particles a cell: "
                 + "; ".join(f"{n} {percent(p['error'])} off, ringing {p['noise']:.0e} of the load" for n, p in four.items()) + ".")  # fmt: skip
    more = {p["particles"]: p for p in good(data["basis"]) if p["kind"] == "sdirk2" and p["basis"] == "cpgimp"}
    if {4, 16} <= set(more):
        a, b = more[4], more[16]
        lines.append(f"Sixteen particles a cell instead of four, cpgimp: error {percent(a['error'])} to {percent(b['error'])}, "
                     f"time x {times(b['cpu'] / a['cpu'])}.")  # fmt: skip
    lines.append(about_choice(data)[0])
    return [f"- {line}" for line in lines] + [""]


def about_years():
    """Years and seconds in one run: a slide under a warming sea (docs/studies/slopes.json), against hybrid alone."""
    kept = json.loads((Path(__file__).resolve().parents[2] / "docs" / "studies" / "slopes.json").read_text())["W_12"]
    w = kept["warming"]
    steps, alone = float(w["hybrid_alone"][0]), float(w["hybrid_alone"][0]) * STEP_OF_HYBRID
    return [f"Years and seconds in one run, `cases/slope_warming` with the weak ground ({kept['end_s'] / YEAR - 20:.0f} years of warming, a slide of seconds and creep behind it; 1406 particles): {w['processor_s']:.0f} s of processor time by "
            f"`auto` ({w['steps']} implicit steps, {w['hybrid_steps']} of `hybrid`) against {alone / YEAR:.2g} years of `hybrid` alone ({steps:.2g} steps at {1e3 * STEP_OF_HYBRID:.2g} ms, measured over 1.3e5 of them and "
            f"extrapolated; {alone / w['processor_s']:.1g} times as long)."]  # fmt: skip


def page(data):
    return [
        *dated.head("What accuracy costs", "tests/studies/tradeoff.py", dated.STUDIES / "tradeoff.json"),
        "The data hold every run.", "",
        "Error: the largest difference of any watched curve from the exact or reference one, over the range of that curve. Time: user and system "
        f"time of one process on one core, less {seconds(data['startup'])} of starting it, at least 10 ms. The machine was shared: differences below a fifth mean "
        "nothing. Cells are those of the grid, spare ones included (one in 26). Columns have 2 particles a cell along their axis (BP2 and the block 2 x 2).", "",
        "## Advice", "", *advice(data),
        "Rules that follow: take an explicit kind where the time of interest is a few passages of a wave; an implicit one for everything "
        "that flows, warms or reacts over longer than that. `sdirk2` for all but crude answers; where inertia hardly matters, `inertia: no` gives it its "
        "second order back (`tests/verification/integrators.py`).", "",
        "## Work and precision", "", "![work and precision](../figures/tradeoff_work.png)", "",
        "Larger marks are finer grids; open marks are extrapolated in time.", "",
        "### A wave in a saturated column", "", "Against the exact wave (`tests/verification/exact_dynamic.py`).", "", *about_waves(data),
        "### Fast consolidation", "", "Against the same exact solution, four seconds of consolidation, 10 m, k = 1e-9 m².", "",
        *cheapest_table(data["consolidation"], (0.02, 0.01, 0.005, 0.002)),
        "### BP2", "",
        "Against the curves of the independent finite-volume code: p over its own value, u and S_h over their peaks, T over its change. "
        "The implicit integrators run the case as it is. The step of the explicit ones is bound by waves, so their whole run is extrapolated from a measured "
        "part of it; their error is that of the run that is 1000 times faster (permeability, reaction, conductivities and load), taken to its end.", "", *about_bp2(data), bp2_bar(data), "",
        "### A dissociating block", "",
        "10 x 10 cells, all fields. Error of the step: against the same kind with a tolerance of 1e-5, or a tenth of the stable step.", "",
        *about_block(data),
        "## Permeability", "", "![permeability](../figures/tradeoff_permeability.png)", "",
        "Time to a time factor of 1/2 of the same column, settlement within 1 % of its end all the way: the longest fixed step that keeps it. Open marks "
        "are extrapolated.", "",
        *about_permeability(data["permeability"]),
        "## What `auto` chooses", "", "Measured times are of the cheapest run within 1 %.", "", *about_choice(data)[1],
        "## A run that changes its integrator", "",
        "The column of `tests/verification/auto.py` (10 m, 26 cells, k = 1e-8 m², gassy water): loaded over 10 s, suddenly at 20 s, unloaded over 10 s at 60 s, to 80 s; then with all but "
        "the sudden load stretched. `auto` takes hybrid for the wave alone. Errors at 160 times of the run, over the range of the first row's curves; with slow phases a hundred "
        "times as long none of these times sees the wave.", "", *about_change(data["change"]),
        *about_years(), "",
        "## What each field and term costs and buys", "", "The dissociating block without one of them. Change: of the curve over its range.", "",
        *about_terms(data["terms"]),
        "## Basis and particles per cell", "", "![basis](../figures/tradeoff_basis.png)", "",
        "Consolidation under 1 MPa, 5 % of strain, so that particles cross cells. Error: against four times as many cells with cpgimp. Ringing: "
        "root mean square of the difference between a particle's pressure and the mean of its neighbours, at the end. With `linear` a closed face under "
        "pressure is not in balance (1 MPa here), as [limits](../limits.md) says.", "", *about_basis(data["basis"]),
    ]  # fmt: skip


def clamp(data, least=0.01):
    """Times below what starting the program varies by are that."""
    for points in data.values():
        for p in points if isinstance(points, list) else []:
            if "cpu" in p:
                p["cpu"] = max(p["cpu"], least)


def write(data, path, figures):
    set_style()
    clamp(data)
    work_figure(data, figures)
    permeability_figure(data["permeability"], figures)
    basis_figure(data["basis"], figures)
    path.write_text("\n".join(page(data)).rstrip() + "\n")
    print(path)
