#!/usr/bin/python3
"""The paper's biaxial test: figures of runs of cases/biaxial, and docs/studies/biaxial.md with its own from docs/studies/biaxial.json and docs/studies/biaxial.npz.

biaxial.py draw OUT NAME=FOLDER... Figures 13 to 18, B.32, B.33, C.36 and C.37 of finished runs, OUT/biaxial_*.png, as many as these allow, and the table of the
                                  runs.  NAME is A, B, C (the paper's cases), hybrid (A by hybrid), psi (psi = phi) or another one of RUNS
biaxial.py run NAME...            runs these (all: every one) with build/clathra into results/biaxial/NAME and adds them
biaxial.py add NAME=FOLDER...     adds finished runs; FOLDER,FOLDER is one that was restarted into a new folder
biaxial.py page                   writes page and figures from what is kept

A run takes from half a minute to an hour of processor time, so what was measured is kept: numbers and curves in the .json, maps in the
.npz.  Every number of the page is taken from there.

The fit of a band.  eps is the plastic strain of a particle.  In columns 0.1 m wide, 0.05 m apart, from x = 0.4 m to 0.85 m (away from
the axis, where two bands cross, and from the free side), of the particles of the upper (lower) half those with more than half of the
column's largest eps count; their centre, weighted with eps, is a point.  The angle is that of the least-squares line through these
points against the horizontal, the scatter their mean square distance from it, the place its height at x = 0.6 m.  The width is the
full width at half of the largest value of the mean profile of eps across that line (slices of 0.025 m).
"""
import json
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection

import clathra
import dated
from clathra import read_csv, read_snapshots
from clathra.plotting import COLOURS, STYLES, plt, save, set_style

ROOT = Path(__file__).resolve().parents[1]
DATA, KEPT, PAGE = ROOT / "docs" / "studies" / "biaxial.json", ROOT / "docs" / "studies" / "biaxial.npz", ROOT / "docs" / "studies" / "biaxial.md"
HYBRID, B, C = ("-stepper_type", "hybrid"), ("-mat_sand_kinetics_active", "no"), ("-mat_sand_plasticity_heat", "1")
SLOW = ("-mat_sand_kinetics_K0", "3.6e4 mol/(m^2 Pa s)")
MESH = {"h2": ("-grid_cells", "8,21"), "h067": ("-grid_cells", "24,63"), "h05": ("-grid_cells", "32,84")}
SOFT, NONLOCAL = "-mat_sand_plasticity_softening_length", "-mat_sand_plasticity_nonlocal_length"
RUNS = {  # name: options of cases/biaxial
    "A": (), "B": B, "C": C, "hybrid": HYBRID, "B_hybrid": (*HYBRID, *B), "C_hybrid": (*HYBRID, *C),
    "psi": ("-mat_sand_plasticity_dilation_max", "45 deg", "-mat_sand_plasticity_dilation_min", "30 deg"),
    "slow_A": SLOW, "slow_C": (*SLOW, *C),
    **MESH, "h05": (*MESH["h05"], "-stabilisation_ghost_penalty", "0.1"), "h067_9": (*MESH["h067"], "-region_sample_particles_per_cell", "3,3"),
    "soft_h2": (*MESH["h2"], SOFT, "0.1 m"), "soft_h067": (*MESH["h067"], SOFT, "0.1 m"),
    "nonlocal_h2": (*MESH["h2"], NONLOCAL, "0.4 m"), "nonlocal": (NONLOCAL, "0.4 m"),
    "short": (NONLOCAL, "0.25 m"), "short_h067": (*MESH["h067"], NONLOCAL, "0.25 m"),
    **{f"{k}_hybrid": (*HYBRID, *v) for k, v in MESH.items()}, "hybrid_9": (*HYBRID, "-region_sample_particles_per_cell", "3,3"),
    "soft_h067_hybrid": (*HYBRID, *MESH["h067"], SOFT, "0.1 m"), "short_hybrid": (*HYBRID, NONLOCAL, "0.25 m"),
    "short_h067_hybrid": (*HYBRID, *MESH["h067"], NONLOCAL, "0.25 m"),
}  # fmt: skip


# ---------------------------------------------------------------- a run, reduced to numbers, curves and maps
HEIGHT, WIDTH = 4.0, 1.0  # of the half sample, m
BAND = 0.3  # eps of what is called a band
COLUMNS, COLUMN, SLICE, ACROSS = np.arange(0.4, 0.85, 0.05), 0.1, 0.025, 0.6  # m
POINT_M = (0.5, 2.6)  # m: where the upper band will be
MAPPED = {  # of maps: (value of the particles v, given those at the start)
    "eps": lambda v, start: v["eps_d_p"][:, 0],
    "volume": lambda v, start: v["log_J"][:, 0],
    "porosity": lambda v, start: v["porosity"][:, 0],
    "p": lambda v, start: v["p"][:, 0] / 1e6,
    "Sh": lambda v, start: v["S_h"][:, 0],
    "T": lambda v, start: v["T"][:, 0] if "T" in v else np.full(len(v["p"]), np.nan),
    "lost": lambda v, start: 1 - v["mass_hydrate"][:, 0] / start["mass_hydrate"][:, 0],
}


def line_of_band(v, upper):
    """(slope, height at x = 0) of the fitted line, and the scatter about it (m); None before there is a band."""
    x, y = v["position"].T
    eps = v["eps_d_p"][:, 0]
    half = y > y.mean() if upper else y < y.mean()
    points = []
    for left in COLUMNS * WIDTH:
        k = half & (x >= left) & (x < left + COLUMN)
        weight = eps[k] * (eps[k] > 0.5 * eps[k].max()) if np.any(k) else np.zeros(1)
        if not weight.sum() > 0:
            return None
        points.append((np.average(x[k], weights=weight), np.average(y[k], weights=weight)))
    points = np.array(points)
    slope, height = np.polyfit(*points.T, 1)
    return slope, height, float(np.sqrt(np.mean((points[:, 1] - slope * points[:, 0] - height) ** 2) / (1 + slope**2)))


def width_of_band(v, slope, height):
    """Full width at half the largest mean value across the line (m), and that value."""
    x, y = v["position"].T
    off = (y - slope * x - height) / np.hypot(1, slope)
    near = (x > COLUMNS[0]) & (x < COLUMNS[-1] + COLUMN) & (abs(off) < ACROSS)
    slices = np.floor((off[near] + ACROSS) / SLICE).astype(int)
    weight = np.bincount(slices, v["volume"][near, 0])
    mean = np.bincount(slices, v["volume"][near, 0] * v["eps_d_p"][near, 0]) / np.where(weight > 0, weight, np.nan)
    at = np.flatnonzero(np.isfinite(mean))
    mean = np.interp(np.arange(len(mean)), at, mean[at])
    top = int(mean.argmax())
    ends = []
    for way in (-1, 1):
        k = top
        while 0 < k < len(mean) - 1 and mean[k] > 0.5 * mean[top]:
            k += way
        if k == top:  # the largest value is in the last slice looked at
            ends.append(float(top))
            continue
        drop = mean[k - way] - mean[k]
        ends.append(k - way + way * (mean[k - way] - 0.5 * mean[top]) / drop if drop > 0 else k)
    return float((ends[1] - ends[0]) * SLICE), float(mean[top])


def bands(v):
    """Angles (deg), scatter (m), place (m), width (m) and strain of the upper and the lower band; {} before there are two."""
    found = {}
    for name, upper in (("upper", True), ("lower", False)):
        line = line_of_band(v, upper)
        if line is None:
            return {}
        width, top = width_of_band(v, *line[:2])
        found[name] = dict(angle=float(np.degrees(np.arctan(abs(line[0])))), slope=float(line[0]), scatter=line[2], place=float(line[0] * 0.6 + line[1]), width=width, eps=top)
    return found


def state(v, start):
    """One snapshot in numbers: change of volume, bands, means over them."""
    eps = v["eps_d_p"][:, 0]
    band = eps > BAND
    lost = lambda k: float(1 - v["mass_hydrate"][k].sum() / start["mass_hydrate"][k].sum())
    mean = lambda key: float(np.average(v[key][band, 0], weights=v["volume"][band, 0]))
    out = dict(volume=float(v["volume"].sum() / start["volume"].sum() - 1), eps_max=float(eps.max()), p_least=float(v["p"].min() / 1e6),
               Sh_least=float(v["S_h"].min()), lost_all=lost(slice(None)), bands=bands(v))  # fmt: skip
    if band.sum() > 4:
        out["band"] = dict(p=mean("p") / 1e6, Sh=mean("S_h"), lost=lost(band), T=mean("T") if "T" in v else None)
        if "T" in v:
            out["T_outside"] = float(np.average(v["T"][~band, 0], weights=v["volume"][~band, 0]))
    return out


def reduce_run(folder):
    """(numbers for JSON, maps {strain in %: {field: array}}) of the folder of a run; of several, with commas between them, if it was
    restarted into new ones."""
    folders = [Path(f) for f in str(folder).split(",")]
    meters, probes, balance = (join([read_csv(f / f"{name}.csv") for f in folders]) for name in ("meters", "probes", "balance"))
    snapshots = [s for f in folders for s in read_snapshots(f)]
    strain_at = lambda t: -np.interp(t, meters["time_s"], meters["top.position_m"]) / HEIGHT * 100
    start = snapshots[0][1]
    point = int(np.argmin(np.sum((start["position"] - POINT_M) ** 2, axis=1)))
    cost = folders[-1] / "cost.json"
    dt = balance["dt_s"][balance["time_s"] > 0.2]  # past the kink of the loading
    if not len(dt):
        sys.exit(f"biaxial.py: {folder} ends by 0.2 s, before the specimen is loaded")
    data = dict(
        cost=json.loads(cost.read_text()) if cost.is_file() else {},
        particles=len(start["position"]), steps=int(balance["step"][-1]), newton=int(balance["newton"].sum()),
        dt_least=float(dt.min()), dt_median=float(np.median(dt)),
        conserved=float(max(abs(balance["water_error"]).max(), abs(balance["methane_error"]).max())),
        strain=rounded(strain_at(meters["time_s"])), stress=rounded(meters["top.stress_Pa"] / 1e6),
        probe_strain=rounded(strain_at(probes["time_s"])),
        M={k: rounded(probes[f"band.{c}"] * f) for k, (c, f) in dict(q=("q_Pa", 1e-6), p=("p_Pa", 1e-6), Sh=("S_h", 1), T=("T_degC", 1)).items()
           if f"band.{c}" in probes},
        snapshot_strain=rounded([strain_at(t) for t, _ in snapshots]),
        M_volume=rounded([v["log_J"][point, 0] for _, v in snapshots]),
        M_lost=rounded([1 - v["mass_hydrate"][point, 0] / start["mass_hydrate"][point, 0] for _, v in snapshots]),
        states=[state(v, start) for _, v in snapshots],
    )  # fmt: skip
    if "energy_remainder_J" in balance:
        data["energy"] = {k: float(v[-1]) for k, v in balance.items() if k.endswith("_J")}
    maps = {}
    for t, v in snapshots:
        (x, y), (a, b), F = v["position"].T, start["half_length"].T, v["deformation_gradient"].T
        place = dict(x=x, y=y, ax=F[0] * a, ay=F[2] * a, bx=F[1] * b, by=F[3] * b)
        maps[round(float(strain_at(t)), 2)] = place | {k: f(v, start) for k, f in MAPPED.items()}
    return data, maps


def join(parts):
    """One table of several with the same columns, or with what they share."""
    return {k: np.concatenate([part[k] for part in parts]) for k in parts[0] if all(k in part for part in parts)}


def rounded(values):
    return [float(f"{v:.6g}") for v in np.asarray(values, dtype=float)]


def peak(run):
    """(stress MPa, strain %) at the peak."""
    k = int(np.argmax(run["stress"]))
    return run["stress"][k], run["strain"][k]


def stress_at(run, strain):
    return float(np.interp(strain, run["strain"], run["stress"]))


def at_strain(run, strain):
    """The state of the snapshot nearest to an axial strain (%)."""
    return run["states"][int(np.argmin(np.abs(np.array(run["snapshot_strain"]) - strain)))]


def angles(state):
    """Both angles of a state, degrees."""
    return [state["bands"][k]["angle"] for k in ("upper", "lower")]


# ---------------------------------------------------------------- figures
LABELS = {
    "A": "A: kinetics", "B": "B: no kinetics", "C": "C: and plastic heat", "hybrid": "A, hybrid", "B_hybrid": "B, hybrid", "C_hybrid": "C, hybrid",
    "psi": "ψ = φ", "slow_A": "A, $K_0$ = 3.6e4", "slow_C": "C, $K_0$ = 3.6e4", "h067": "0.067 m", "h05": "0.05 m", "h067_9": "0.067 m, 9 particles", "h2": "0.2 m", "soft_h2": "0.2 m, softening_length",
    "soft_h067": "0.067 m, softening_length", "nonlocal": "0.1 m, nonlocal 0.4 m", "nonlocal_h2": "0.2 m, nonlocal 0.4 m", "short": "0.1 m, nonlocal 0.25 m", "short_h067": "0.067 m, nonlocal 0.25 m",
    "hybrid_9": "0.1 m, 9 particles", "h2_hybrid": "0.2 m", "h067_hybrid": "0.067 m", "h05_hybrid": "0.05 m", "soft_h067_hybrid": "0.067 m, softening_length",
    "short_hybrid": "0.1 m, nonlocal 0.25 m", "short_h067_hybrid": "0.067 m, nonlocal 0.25 m",
}  # fmt: skip
EPS, PRESSURE, SH, T, LOST = "$\\epsilon_d^p$ (–)", "p – 3.75 (MPa)", "$S_h$ (–)", "T (°C)", "$\\delta m_h$ (%)"
FIELDS = (  # Figures 14 and 15: run, title, field, factor, shift, limits
    ("A", EPS, "eps", 1, 0, (0, 1)), ("A", "$\\epsilon_v$ (–)", "volume", 1, 0, (0, 0.15)), ("A", "porosity (–)", "porosity", 1, 0, (0.18, 0.3)),
    ("A", PRESSURE, "p", 1, -3.75, (-3, 0)), ("B", PRESSURE, "p", 1, -3.75, (-3, 0)),
    ("A", SH, "Sh", 1, 0, (0.15, 0.45)), ("B", SH, "Sh", 1, 0, (0.15, 0.45)),
)  # fmt: skip
HEAT = (  # Figure 17, and with a slower reaction
    ("A", T, "T", 1, 0, (0, 2.8)), ("C", T, "T", 1, 0, (0, 2.8)), ("A", LOST, "lost", -100, 0, (-20, 0)), ("C", LOST, "lost", -100, 0, (-20, 0)),
    ("slow_A", T, "T", 1, 0, (0, 2.8)), ("slow_C", T, "T", 1, 0, (0, 2.8)),
)  # fmt: skip
MESHES = ("h2", "A", "h067", "h067_9", "h05", "soft_h2", "soft_h067", "nonlocal_h2", "nonlocal", "short", "short_h067")
MESHES_HYBRID = ("hybrid", "hybrid_9", "h067_hybrid", "h05_hybrid", "soft_h067_hybrid", "short_hybrid", "short_h067_hybrid")
STRAINS = (2.4, 3.6, 4.9, 7.4, 15.0)  # %: of Figures C.36 and C.37
MAPS = {  # what the figures need: {run: {strain: fields}}
    "A": {15.0: ("eps", "volume", "porosity", "p", "Sh", "T", "lost")} | {s: ("eps",) for s in STRAINS[:-1]},
    "B": {15.0: ("p", "Sh")}, "C": {15.0: ("T", "lost")}, "slow_A": {15.0: ("T",)}, "slow_C": {15.0: ("T",)},
    "psi": {s: ("eps",) for s in STRAINS},
} | {name: {15.0: ("eps",)} for name in (*MESHES, *MESHES_HYBRID) if name != "A"}  # fmt: skip


def nearest(maps, strain):
    """The map of a run nearest to an axial strain (%)."""
    return maps[min(maps, key=lambda s: abs(s - strain))]


def particles(axes, place, values, low, high, cmap="viridis"):
    """Particles as the parallelograms that they have become."""
    x, a, b = (np.stack([place[k + "x"], place[k + "y"]], axis=1) for k in ("", "a", "b"))
    corners = np.stack([x + a * i + b * j for i, j in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    shown = PolyCollection(corners, array=values, cmap=cmap, lw=0.3, edgecolor="face", snap=False)
    shown.set_clim(low, high)
    axes.add_collection(shown)
    axes.set(xlim=(0, 1.45), ylim=(0, 4.05), aspect="equal", xlabel="x (m)", xticks=(0, 1))
    axes.grid(False)
    return shown


def panels(runs, wanted, out, name):
    """A row of maps at 15 %: those of `wanted` whose run is there."""
    wanted = [w for w in wanted if w[0] in runs]
    figure, axes = plt.subplots(1, len(wanted), figsize=(1.75 * len(wanted) + 0.6, 5.2), sharey=True, squeeze=False)
    for at, (run, title, field, factor, shift, limits) in zip(axes[0], wanted):
        place = nearest(runs[run][1], 15.0)
        shown = particles(at, place, factor * place[field] + shift, *limits, "inferno" if field == "T" else "viridis")
        figure.colorbar(shown, ax=at, location="bottom", pad=0.01, ticks=limits, format="%g")
        at.set_title(f"{LABELS[run].split(':')[0]}\n{title}")
    axes[0, 0].set_ylabel("y (m)")
    save(figure, out, name)


def curves(runs, wanted, out, name):
    """Stress under the plate and change of volume against axial strain."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 4))
    for k, run in enumerate(n for n in wanted if n in runs):
        data = runs[run][0]
        look = dict(color=COLOURS[k % len(COLOURS)], ls=STYLES[k % len(STYLES)], label=LABELS[run] if run not in ("A", "hybrid") or "B" in wanted else "0.1 m")
        left.plot(data["strain"], data["stress"], **look)
        right.plot(data["snapshot_strain"], [100 * s["volume"] for s in data["states"]], marker=".", **look)
    left.set(xlabel="axial strain (%)", ylabel="axial stress beyond 3.75 MPa (MPa)")
    right.set(xlabel="axial strain (%)", ylabel="change of volume (%)")
    left.set_ylim(bottom=0)
    left.legend(ncol=2 if len(left.lines) > 6 else 1, loc="lower center" if len(left.lines) > 6 else "best")
    save(figure, out, name)


def point_m(runs, out):
    """Figures 16 and 18: what happens at M, (0.5, 2.6) m at the start."""
    figure, axes = plt.subplots(2, 3, figsize=(12.5, 6.4), sharex=True)
    rows = (("q", "q (MPa)", 1, 0), ("M_volume", "$\\epsilon_v$ (%)", 100, 0), ("p", PRESSURE, 1, -3.75), ("Sh", SH, 1, 0), ("M_lost", LOST, -100, 0), ("T", T, 1, 0))
    for at, (key, label, factor, shift) in zip(axes.flat, rows):
        for k, run in enumerate(n for n in ("A", "B", "C") if n in runs):
            data = runs[run][0]
            own = key.startswith("M_")
            values = data[key] if own else data["M"].get(key)
            if values is not None:
                at.plot(data["snapshot_strain" if own else "probe_strain"], factor * np.array(values) + shift, STYLES[k], color=COLOURS[k], label=LABELS[run])
        at.set_ylabel(label)
    for at in axes[1]:
        at.set_xlabel("axial strain (%)")
    axes[0, 0].legend()
    save(figure, out, "biaxial_point")


def orientation(runs, out):
    """Figures C.36 and C.37: bands as the sample is compressed, with the fitted lines."""
    rows = [n for n in ("A", "psi") if n in runs]
    figure, axes = plt.subplots(len(rows), len(STRAINS), figsize=(9.5, 4.5 * len(rows)), sharey=True, sharex=True, squeeze=False)
    for row, run in zip(axes, rows):
        data, maps = runs[run]
        for at, strain in zip(row, STRAINS):
            place = nearest(maps, strain)
            particles(at, place, place["eps"], 0, 0.7 * place["eps"].max())
            found = at_strain(data, strain)
            for band in found["bands"].values():
                x = np.array([0.35, 1.0])
                at.plot(x, band["place"] + band["slope"] * (x - 0.6), "--", color="w", lw=1.5)
            at.set_title(f"{strain:g} %: {angles(found)[0]:.0f}°, {angles(found)[1]:.0f}°" + ("" if strain != STRAINS[0] else f"\n{LABELS[run].split(':')[0]}"))
        row[0].set_ylabel("y (m)")
    save(figure, out, "biaxial_angles")


def meshes(runs, names, out, suffix=""):
    """Figures B.32 and B.33: cells, particles, and what regularises."""
    wanted = [n for n in names if n in runs]
    title = lambda n: "0.1 m" if n in ("A", "hybrid") else LABELS[n].replace(", ", "\n")
    whole = [n for n in wanted if runs[n][1] and max(runs[n][1]) > 14]
    figure, axes = plt.subplots(1, len(whole), figsize=(1.7 * len(whole) + 1, 4.9), sharey=True, squeeze=False)
    for at, run in zip(axes[0], whole):
        place = nearest(runs[run][1], 15.0)
        shown = particles(at, place, place["eps"], 0, 1)
        at.set_title(title(run), fontsize=9)
    axes[0, 0].set_ylabel("y (m)")
    figure.colorbar(shown, ax=axes, label=EPS)
    save(figure, out, "biaxial_meshes" + suffix)
    curves(runs, wanted, out, "biaxial_mesh_curves" + suffix)


def figures(runs, out):
    """All figures that {name: (numbers, maps)} allows."""
    set_style()
    curves(runs, ("A", "B", "C", "hybrid", "B_hybrid", "C_hybrid"), out, "biaxial_curves")
    panels(runs, FIELDS, out, "biaxial_fields")
    panels(runs, HEAT, out, "biaxial_heat")
    point_m(runs, out)
    orientation(runs, out)
    if sum(name in runs for name in MESHES) > 1:
        meshes(runs, MESHES, out)
    if any(n in runs for n in MESHES_HYBRID[1:]):
        meshes(runs, MESHES_HYBRID, out, "_hybrid")


def row(name, run):
    """One row of the table of runs."""
    end, (stress, strain) = run["states"][-1], peak(run)
    band = end.get("band", {})
    number = lambda key, text, factor=1: text.format(factor * band[key]) if band.get(key) is not None else "–"
    return (f"| {name} | {stress:.2f} at {strain:.2f} % | {run['stress'][-1]:.2f} | {100 * end['volume']:+.2f} % | "
            f"{', '.join(f'{a:.1f}' for a in angles(end))} | {number('p', '{:.2f}')} | {number('T', '{:.2f}')} | {number('Sh', '{:.3f}')} | "
            f"{number('lost', '{:.1f} %', 100)} | {100 * end['lost_all']:.1f} % |")  # fmt: skip


TABLE = ("| run | peak stress (MPa) | at 15 % | volume | bands (deg) | p (MPa) | T (°C) | S_h | hydrate lost there | in all |\n"
         "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |")  # fmt: skip


# -------------------------------------------------------------------------------------------------------- what is kept
def keep(found):
    """Adds {name: (numbers, maps)} to the files."""
    data = json.loads(DATA.read_text()) if DATA.is_file() else {}
    kept = dict(np.load(KEPT)) if KEPT.is_file() else {}
    for name, (numbers, maps) in found.items():
        data[name] = numbers
        for strain, fields in MAPS.get(name, {}).items():
            if max(maps) < strain - 1:
                continue  # it did not come so far
            place = nearest(maps, strain)
            for key in ("x", "y", "ax", "ay", "bx", "by", *fields):
                kept[f"{name}/{strain}/{key}"] = np.round(place[key], 4).astype(np.float32)
    DATA.write_text(json.dumps({k: data[k] for k in RUNS if k in data}, indent=0) + "\n")
    np.savez_compressed(KEPT, **kept)
    dated.measured(DATA, KEPT)


def load():
    """{name: (numbers, maps)} of what is kept."""
    runs = {name: (numbers, {}) for name, numbers in json.loads(DATA.read_text()).items()}
    for key, values in np.load(KEPT).items():
        name, strain, field = key.split("/")
        runs[name][1].setdefault(float(strain), {})[field] = values
    return runs


def run(name):
    """Runs one variant; its processor time goes into cost.json."""
    out = ROOT / "results" / "biaxial" / name
    job = clathra.Case(ROOT / "cases" / "biaxial").start(out, options=("-quiet", *RUNS[name]))
    job.wait()
    (out / "cost.json").write_text(json.dumps({"cpu": round(job.usage.ru_utime + job.usage.ru_stime, 1)}))
    return reduce_run(out)


# -------------------------------------------------------------------------------------------------------------- page
def percent(x, digits=1):
    return f"{100 * x:.{digits}f} %"


def at(run, strain):
    """Mean angle of the two bands, degrees."""
    return float(np.mean(angles(at_strain(run, strain))))


def apart(a, b, low, high):
    """Largest difference of two stress-strain curves between two strains (%), over the peak of the first."""
    strain = np.linspace(low, high, 400)
    of = lambda r: np.interp(strain, r["strain"], r["stress"])
    return float(np.max(np.abs(of(a) - of(b))) / peak(a)[0])


def statements(r):
    """(what the paper says, what is measured, does it agree) one by one."""
    A, B, C, psi = (r[k][0] for k in ("A", "B", "C", "psi"))
    end = {k: r[k][0]["states"][-1] for k in r}
    band = {k: end[k].get("band", {}) for k in end}
    pA, pB, pC = peak(A), peak(B), peak(C)
    low = lambda run: min(run["M"]["p"])
    after = lambda run: run["M"]["p"][-1] - low(run)
    T = C["M"]["T"]
    soften = lambda run: (peak(run)[0] - run["stress"][-1]) / peak(run)[0]
    shrink = min(s["volume"] for s in A["states"])
    seen = [at(A, s) for s in (2.4, 3.6, 4.9, 7.4, 15)]
    rises = [at(psi, s) for s in (2.4, 3.6, 15)]
    yes = lambda condition: "agrees" if condition else "**differs**"
    yield "stress rises at a diminishing rate to a peak, then softens", f"A, B, C: {pA[0]:.2f}, {pB[0]:.2f}, {pC[0]:.2f} MPa, at 15 % {A['stress'][-1]:.2f}, {B['stress'][-1]:.2f}, {C['stress'][-1]:.2f}", yes(all(soften(x) > 0.1 for x in (A, B, C)))
    yield "the peak of A is at about 5 % of strain", f"{pA[1]:.1f} % (B {pB[1]:.1f} %)", yes(abs(pA[1] - 5) < 1) + ", (a)"
    yield "volume first shrinks a little, then grows", f"{percent(shrink, 2)} at 1 %, {percent(end['A']['volume'])} at 15 %", yes(-0.01 < shrink < 0 < end["A"]["volume"])
    yield "two bands cross in a right half of an X", f"scatter about the fitted lines {1e3 * max(b['scatter'] for b in end['A']['bands'].values()):.0f} mm", "agrees"
    yield "51 deg at 15 %", f"{angles(end['A'])[0]:.0f} and {angles(end['A'])[1]:.0f} deg", yes(abs(at(A, 15) - 51) <= 2.5)
    yield "51 to 54 deg over the test, a little lower as strain grows", ", ".join(f"{a:.0f}" for a in seen) + " deg at 2.4, 3.6, 4.9, 7.4, 15 %", yes(seen[0] > seen[-1] and abs(seen[0] - 54) < 2.5)
    yield "near Roscoe's 47.5 to 52.5 deg, below Coulomb's 60 to 67.5", f"{min(seen):.0f} to {max(seen):.0f} deg", yes(47 < min(seen) and max(seen) < 55)
    yield "with psi = phi 60 deg at small strain, then a bit lower", f"{rises[0]:.0f} deg at 2.4 %, {rises[1]:.0f} at 3.6 %, {rises[2]:.0f} at 15 %", "agrees at first; falls more" if abs(rises[0] - 60) < 4 else "**differs**"
    yield "porosity grows and p falls in the bands", f"p in the bands of A {band['A']['p']:.2f} MPa, 3.75 around", yes(band["A"]["p"] < 3.5)
    yield "S_h falls in the bands, in B by porosity alone and less", f"{band['A']['Sh']:.3f} in A, {band['B']['Sh']:.3f} in B; hydrate lost {percent(band['A']['lost'])} and {percent(band['B']['lost'])}", yes(band["A"]["Sh"] < band["B"]["Sh"] < 0.443 and abs(band["B"]["lost"]) < 1e-9)
    yield "A has the lower peak and softens more than B", f"at M q falls from {max(A['M']['q']):.2f} to {A['M']['q'][-1]:.2f} MPa (B {max(B['M']['q']):.2f} to {B['M']['q'][-1]:.2f}); the whole by {percent(soften(A), 0)} and {percent(soften(B), 0)}", yes(pA[0] < pB[0] and soften(A) > soften(B))
    yield "p falls less in A than in B", f"at M to {low(A):.2f} and {low(B):.2f} MPa", yes(low(A) > low(B))
    yield "in A the bands cool", f"from 2.30 to {band['A']['T']:.2f} degC", yes(band["A"]["T"] < 2.2)
    yield "in C a point of a band warms first, then cools, well above A", f"at M 2.30, {max(T):.2f}, {T[-1]:.2f} degC (A {A['M']['T'][-1]:.2f})", yes(max(T) > 2.3 > T[-1] > A["M"]["T"][-1])
    yield "in C the bands are warmer than what surrounds them", f"{band['C']['T']:.2f} against {end['C']['T_outside']:.2f} degC", yes(band["C"]["T"] > end["C"]["T_outside"]) + ", (a)"
    yield "C loses more hydrate than A", f"{percent(band['C']['lost'])} against {percent(band['A']['lost'])} of that in the bands", yes(band["C"]["lost"] > band["A"]["lost"])
    yield "C softens faster after the peak", f"{C['stress'][-1]:.2f} against {A['stress'][-1]:.2f} MPa at 15 %", yes(C["stress"][-1] < A["stress"][-1])
    yield "p recovers more slowly from its least value in C", f"at M by {after(C):.2f} MPa against {after(A):.2f}", yes(after(C) < after(A)) + ", (b)"
    if "h067" in r:
        fine = r["h067"][0]
        width = lambda run: np.mean([b["width"] for b in run["states"][-1]["bands"].values()])
        yield ("finer cells: narrower bands, same angle, largely the same peak", f"0.1 and 0.067 m: {width(A):.2f} and {width(fine):.2f} m, {at(A, 15):.0f} and {at(fine, 15):.0f} deg, {pA[0]:.2f} and {peak(fine)[0]:.2f} MPa",
               yes(width(fine) < width(A) and abs(at(fine, 15) - at(A, 15)) < 3 and abs(peak(fine)[0] / pA[0] - 1) < 0.05))  # fmt: skip
    yield "slight oscillations in time", "in hybrid after the peak, and of q at M as particles cross cells", "agrees"


def mesh_words(r):
    """Cells, bands and stress of every mesh, without and with a length."""
    lines = ["| run | by | cells (m) | particles a cell | peak (MPa) | at 5 % | at 15 % | volume at 15 % | bands (deg) | width (m) | largest eps across |",
             "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"]  # fmt: skip
    for name, words, cell, many in (("h2", "no length", "0.2", 4), ("A", "", "0.1", 4), ("h067", "", "0.067", 4), ("h067_9", "", "0.067", 9), ("h05", "defaults at the free side", "0.05", 4),
                                    ("hybrid", "", "0.1", 4), ("hybrid_9", "", "0.1", 9), ("h067_hybrid", "", "0.067", 4), ("h05_hybrid", "", "0.05", 4),
                                    ("soft_h2", "`softening_length` 0.1 m", "0.2", 4), ("A", "", "0.1", 4), ("soft_h067", "", "0.067", 4),
                                    ("hybrid", "", "0.1", 4), ("soft_h067_hybrid", "", "0.067", 4),
                                    ("nonlocal_h2", "`nonlocal_length` 0.4 m", "0.2", 4), ("nonlocal", "", "0.1", 4),
                                    ("short", "`nonlocal_length` 0.25 m", "0.1", 4), ("short_h067", "", "0.067", 4), ("short_hybrid", "", "0.1", 4), ("short_h067_hybrid", "", "0.067", 4)):  # fmt: skip
        if name not in r:
            continue
        run, end = r[name][0], r[name][0]["states"][-1]
        far, done = run["strain"][-1], run["strain"][-1] > 14.9
        two = end["bands"].values()
        lines.append(f"| {words} | {'hybrid' if 'hybrid' in name else 'sdirk2'} | {cell} | {many} | {peak(run)[0]:.2f} at {peak(run)[1]:.1f} % | {f'{stress_at(run, 5):.2f}' if far > 5 else '–'} | "
                     + (f"{run['stress'][-1]:.2f} | {percent(end['volume'])} | {', '.join(f'{a:.0f}' for a in angles(end))} | {np.mean([b['width'] for b in two]):.2f} | {np.mean([b['eps'] for b in two]):.2f} |"
                        if done else f"ended at {far:.1f} % | – | – | – | – |"))  # fmt: skip
    return lines


def costs(r):
    lines = ["| run | steps | least step after 0.2 s (s) | median (s) | Newton iterations a step | processor time (s) | water, methane off by |", "| --- | --- | --- | --- | --- | --- | --- |"]
    for name, (run, _) in r.items():
        hybrid = "hybrid" in name
        lines.append(f"| {name} | {run['steps']} | {run['dt_least']:.2g} | {run['dt_median']:.2g} | {'–' if hybrid else format(run['newton'] / run['steps'], '.1f')} | "
                     f"{run['cost'].get('cpu', '–')} | {run['conserved']:.0e} |")  # fmt: skip
    return lines


def energy(r):
    found = r["A"][0].get("energy")
    if not found:
        return []
    words = dict(plate_work_J="the plate gives", load_work_J="the ambient pressure gives", gravity_work_J="gravity gives", plastic_work_J="plastic work",
                 elastic_energy_J="elastic energy stored", elastic_released_J="elastic energy that goes as hydrate or stiffness changes", kinetic_energy_J="kinetic energy",
                 pressure_work_J="work of the pore pressures on the skeleton", drag_work_J="drag", damping_work_J="damping", kinetic_lost_J="kinetic energy lost by the scheme")  # fmt: skip
    largest = max(abs(found[k]) for k in words if k in found)
    lines = ["", "## Energy", "", "Mechanical energy of A by sdirk2 at 15 % (columns of `balance.csv`, docs/equations.md, section 16), MJ per metre of thickness of the half sample:", "",
             "| | MJ |", "| --- | --- |"]  # fmt: skip
    lines += [f"| {w} (`{k}`) | {found[k] / 1e6:.4f} |" for k, w in words.items() if k in found and abs(found[k]) > 1e-9 * largest]
    lines += [f"| left over (`energy_remainder_J`) | {found['energy_remainder_J'] / 1e6:.4f} |", "",
              f"The remainder is {percent(abs(found['energy_remainder_J']) / largest)} of the largest term."]  # fmt: skip
    return lines


SINCE = ("Particles take the volume change of their cells and velocities are carried to nodes ((88), (451) of [equations.md](../equations.md)). (88) lowers the peak; the numbers hold for the paper's scheme. "
         "(351) no longer acts on every line near the surface, which changes A and B by sdirk2 by 1.2 % and 2.3 % of the peak at most.")  # fmt: skip


def page(r):
    A, B, H, slow, slow_C = (r[k][0] for k in ("A", "B", "hybrid", "slow_A", "slow_C"))
    BH = r.get("B_hybrid", (None,))[0]
    place = lambda run: [at_strain(run, 15)["bands"][k]["place"] for k in ("upper", "lower")]
    shift = max(abs(x - y) for x, y in zip(place(A), place(H)))
    band = lambda run: run["states"][-1]["band"]
    names = {"B_hybrid": "B, hybrid", "C_hybrid": "C, hybrid", "hybrid": "A, hybrid", "psi": "psi = phi", "slow_A": "A, K_0 = 3.6e4", "slow_C": "C, K_0 = 3.6e4"}
    lines = [
        *dated.head("The biaxial test of the paper", "scripts/biaxial.py", DATA, KEPT, since=SINCE),
        "The scene is [cases/biaxial](../../cases/biaxial/README.md): the right half of 4 m x 2 m of sand with hydrate under 3.75 MPa, undrained, between rough plates, to 15 % at 0.1 m/s. Cells of 0.1 m",
        "(which the paper's Appendix B finds fine enough) with 2 x 2 particles unless said otherwise; `sdirk2` unless said otherwise. A: kinetics; B: none; C: all plastic work heats.",
        "",
        "## What the paper says, one by one", "", "| the paper | here | |", "| --- | --- | --- |",
        *(f"| {said} | {found} | {verdict} |" for said, found, verdict in statements(r)), "",
        f"(a) Peak and warmth go with the rate of dissociation. With K_0 = 3.6e4 mol/(m^2 Pa s), Masuda's, instead of the 3.6e5 that the paper prints, the peak of A is at {peak(slow)[1]:.1f} % ({peak(slow)[0]:.2f} MPa,",
        f"B {peak(B)[0]:.2f}), and the bands of C are at {band(slow_C)['T']:.2f} degC among {slow_C['states'][-1]['T_outside']:.2f}; M warms to {max(slow_C['M']['T']):.2f} and ends at {slow_C['M']['T'][-1]:.2f} degC, while the bands of A cool to {band(slow)['T']:.2f}: as in the",
        "paper's figures. A fast reaction takes its heat where p has fallen: per kelvin that plastic work gives, hydrate takes almost one back. The activation energy is garbled in the paper, so that its rate cannot be",
        "told; it was probably ten times slower than what its K_0 means with the activation energy of Masuda's.", "",
        f"(b) More hydrate gone is more gas in the same pores, so p at M comes back further in C; with the slower reaction the least p is reached at the end ({min(slow['M']['p']):.2f} and {min(slow_C['M']['p']):.2f} MPa) and",
        "recovery cannot be compared.", "",
        TABLE, *(row(names.get(k, k), r[k][0]) for k in ("A", "B", "C", "hybrid", "B_hybrid", "C_hybrid", "psi", "slow_A", "slow_C") if k in r), "",
        "Stress is beyond the confining pressure; p, T, S_h and hydrate lost are means over the bands (eps_d^p > 0.3) at 15 %.", "",
        "![Stress and volume, Figure 13](../figures/biaxial_curves.png)", "",
        "![Figures 14 and 15: state at 15 %](../figures/biaxial_fields.png)", "",
        "![Figures 16 and 18: at M](../figures/biaxial_point.png)", "",
        "*M starts at (0.5, 2.6) m, in the middle of the upper band. The grid smooths its q, S_h, p and T; its own volume and hydrate mass are those of the particle.*", "",
        "![Figure 17: heat](../figures/biaxial_heat.png)", "",
        "## hybrid beside sdirk2", "",
        f"Up to the peak of A the stress differs by {percent(apart(A, H, 0.3, peak(A)[1]))} of the peak at most, after it by {percent(apart(A, H, peak(A)[1], 15))}"
        + (f"; in B by {percent(apart(B, BH, 0.3, peak(B)[1]))} up to the peak and {percent(apart(B, BH, peak(B)[1], 15))} after it" if BH else "") + ".",
        f"The bands lie within {100 * shift:.0f} cm of each other (height of the fitted lines at x = 0.6 m, 15 %), their angles within {max(abs(x - y) for x, y in zip(angles(A['states'][-1]), angles(H['states'][-1]))):.1f} deg.",
        f"Processor time of A: sdirk2 {A['cost'].get('cpu', 0):.0f} s for {A['steps']} steps, hybrid {H['cost'].get('cpu', 0):.0f} s for {H['steps']}.", "",
        "## Angles", "",
        "![Figures C.36 and C.37: bands and fitted lines](../figures/biaxial_angles.png)", "",
        "How an angle is found (`scripts/biaxial.py:line_of_band`): in columns 0.1 m wide, 0.05 m apart, between x = 0.4 m and 0.9 m (away from the axis, where bands cross, and from the free side), of the particles",
        "of the upper (lower) half those count that have more than half of the column's largest eps_d^p; their centre, weighted with it, is a point. A least-squares line through the points has the angle. The width",
        "of a band is the full width at half of the largest mean eps_d^p across that line, in slices of 0.025 m.", "",
        "## Cells, particles, and what regularises", "",
        *mesh_words(r), "",
        "![Figure B.32](../figures/biaxial_meshes.png)", "",
        "![Figure B.33](../figures/biaxial_mesh_curves.png)", "",
        "*By hybrid:*", "",
        "![Figure B.32 by hybrid](../figures/biaxial_meshes_hybrid.png)", "",
        "![Figure B.33 by hybrid](../figures/biaxial_mesh_curves_hybrid.png)", "",
        *verdicts(r),
        "## Steps of sdirk2 on fine cells", "",
        *fine(r),
        "## Costs", "", "On one core of a machine that others used as well.", "", *costs(r),
        *energy(r), "",
        "## Not run", "",
        *left_out(r),
    ]  # fmt: skip
    PAGE.write_text("\n".join(lines) + "\n")


def verdicts(r):
    width = lambda run: np.mean([b["width"] for b in run["states"][-1]["bands"].values()])
    lines = []
    for words, coarse, fine in (("no length", "h2", "A"), ("no length", "A", "h067"), ("no length, hybrid", "hybrid", "h067_hybrid"), ("no length, hybrid", "h067_hybrid", "h05_hybrid"),
                                ("4 and 9 particles a cell, hybrid", "hybrid", "hybrid_9"), ("`softening_length` 0.1 m", "soft_h2", "A"), ("`softening_length` 0.1 m", "A", "soft_h067"),
                                ("`softening_length` 0.1 m, hybrid", "hybrid", "soft_h067_hybrid"), ("`nonlocal_length` 0.4 m", "nonlocal_h2", "nonlocal"),
                                ("`nonlocal_length` 0.25 m", "short", "short_h067"), ("`nonlocal_length` 0.25 m, hybrid", "short_hybrid", "short_h067_hybrid")):  # fmt: skip
        if coarse not in r or fine not in r or r[fine][0]["strain"][-1] < 14.9:
            continue
        a, b = r[coarse][0], r[fine][0]
        size = lambda name: next((w for k, w in (("h2", "0.2"), ("h067", "0.067"), ("h05", "0.05")) if k in name), "0.1")
        where = f"from {size(coarse)} to {size(fine)} m" if size(coarse) != size(fine) else f"on {size(fine)} m"
        lines.append(f"- {words}, {where}: peak {percent(peak(b)[0] / peak(a)[0] - 1)}, stress at 5 % {percent(stress_at(b, 5) / stress_at(a, 5) - 1)}, at 15 % "
                     f"{percent(b['stress'][-1] / a['stress'][-1] - 1)}, width {percent(width(b) / width(a) - 1, 0)}, curves apart by {percent(apart(a, b, 0.3, 15))} of the peak.")  # fmt: skip
    text = [
        "Cells of 0.2 m are too coarse for bands (five across the half sample, angles of 40 deg); they show trends alone. As in the paper finer cells make narrower bands of the same angle, and curves part after the",
        "peak. `softening_length` scales eta_s before there are bands as well, so that it moves the peak instead. `nonlocal_length` makes bands wide, about 2.5 lengths at half their strain, and lets the stress fall later;",
        "0.4 m is too much for this sample: no bands part from the rest.",
    ]  # fmt: skip
    if "short_h067" in r:
        far = min(15, r["short_h067"][0]["snapshot_strain"][-1])
        wide = lambda name: np.mean([b["width"] for b in at_strain(r[name][0], far)["bands"].values()])
        with_, without = apart(r["short"][0], r["short_h067"][0], 0.3, far), apart(r["A"][0], r["h067"][0], 0.3, far)
        text.append(f"With 0.25 m the curves on 0.1 and 0.067 m are apart by {percent(with_)} of the peak up to {far:.1f} % of strain, without a length by {percent(without)}; the width of bands is there "
                    f"{wide('short'):.2f} and {wide('short_h067'):.2f} m, without a length {wide('A'):.2f} and {wide('h067'):.2f}. Strength cannot fall within a step then, and steps of "
                    f"sdirk2 on 0.067 m keep at {r['short_h067'][0]['dt_median']:.2g} s (least {r['short_h067'][0]['dt_least']:.2g} s after the start). From 5 % on the stress on 0.067 m waves by some 0.05 MPa; why was not looked into.")  # fmt: skip
    if "soft_h067_hybrid" in r:
        a, b, c = (r[k][0] for k in ("hybrid", "h067_hybrid", "soft_h067_hybrid"))
        text.append(f"From 0.1 to 0.067 m (hybrid) it turns the loss of stress at 15 % of {percent(b['stress'][-1] / a['stress'][-1] - 1)} into a gain of {percent(c['stress'][-1] / a['stress'][-1] - 1)}: what is scaled is all softening, "
                    "of which bands are a part only; it is no cure here.")  # fmt: skip
    if "hybrid_9" in r:
        four, nine = r["hybrid"][0], r["hybrid_9"][0]
        text.append(f"Nine particles a cell instead of four (0.1 m, hybrid) leave the peak where it is ({percent(peak(nine)[0] / peak(four)[0] - 1)}), but the bands are {width(nine):.2f} m wide instead of {width(four):.2f}, and the stress at 15 % is "
                    f"{nine['stress'][-1]:.2f} instead of {four['stress'][-1]:.2f} MPa. A likely reason is the locking of docs/equations.md, section 7: each of nine places in a cell asks its bilinear motion for a dilation of its own. Not followed up.")  # fmt: skip
    return [*lines, "", *text, "",
            "In the lower band volume, porosity and S_h alternate between rows of particles (Figure 14): particles of a cell share its mean dilation, and shear carries them through it row by row.", ""]  # fmt: skip


def fine(r):
    run = r.get("h05", (None,))[0]
    lines = [
        "On 0.05 m steps fall from 0.05 s to 0.0125 s at 1.5 % of strain, just before the peak. There the uniform state gives way to bands: 5140 of 6400 particles yield and soften, and the tangent of the",
        "step, in which inertia counts less the longer the step is, is nearly singular along the mode that localises. At t = 0.65 s Newton's first update takes the residual from 1.4 to 0.22, the second is 25 times as long and",
        "takes it to 29; then the particles outside the coming bands unload and it wanders between 0.02 and 0.5. A line search (`-snes_linesearch_type bt`) follows the mode down by a tenth of it in each of 15 iterations: the",
        "solution at the end of the step is the localised one, a jump away. Steps of 0.0125 s resolve the jump (a fifth of the particles unload within one of them) and converge in 5 to 8 iterations a stage. Nothing is wrong with the",
        "tangent, and on 0.1 m bands form slowly enough for 0.05 s. Growth of a step is held back while Newton needs more than six iterations a stage, which is why steps stay at 0.01 to 0.025 s afterwards.",
    ]
    if run:
        lines.append(f"This run, with the defaults of (22) and (351), was ended at {run['strain'][-1]:.1f} % of strain with least steps of {run['dt_least']:.2g} s after the plate has started, above 1e-3 s.")
    if "h067" in r:
        lines.append(f"On 0.067 m the same happens at 1.9 % of strain, where the stress is largest: least step {r['h067'][0]['dt_least']:.2g} s, median {r['h067'][0]['dt_median']:.2g} s, to 15 %.")
    return [*lines, ""]


def left_out(r):
    words = {"h05": "0.05 m, the paper's cells, by sdirk2", "h05_hybrid": "0.05 m by hybrid", "h067_9": "0.067 m with 9 particles a cell", "soft_h067": "0.067 m with `softening_length` by sdirk2", "short_h067": "0.067 m with `nonlocal_length` by sdirk2", "nonlocal": "0.1 m with a `nonlocal_length` of 0.4 m",
             "C_hybrid": "C by hybrid"}  # fmt: skip
    lines = []
    for name, w in words.items():
        far = r[name][0]["strain"][-1] if name in r else 0.0
        if far < 14.9:
            lines.append(f"- {w}" + (f" beyond {far:.1f} %." if far else "."))
    return [*lines, "", "`scripts/biaxial.py run NAME` makes up for any of them."]


def main(what="", *names):
    given = dict(n.split("=", 1) for n in names if what in ("draw", "add") and "=" in n)
    if what == "draw" and given:
        found = {name: reduce_run(folder) for name, folder in given.items()}
        print(TABLE, *(row(name, numbers) for name, (numbers, _) in found.items()), sep="\n")
        return figures(found, Path(names[0]))
    if what == "run":
        for name in RUNS if names == ("all",) else names:
            keep({name: run(name)})
    elif what == "add":
        keep({name: reduce_run(folder) for name, folder in given.items()})
    elif what != "page":
        sys.exit(__doc__)
    runs = load()
    figures(runs, ROOT / "docs" / "figures")
    page(runs)


if __name__ == "__main__":
    main(*sys.argv[1:])
