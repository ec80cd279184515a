#!/usr/bin/python3
"""Figures 13 to 18, B.32, B.33, C.36 and C.37 of the paper from runs of cases/biaxial: plot_biaxial.py OUT NAME=FOLDER...

NAME is A, B, C (the paper's cases), hybrid (A by hybrid), psi (psi = phi) or a name of scripts/biaxial.py; FOLDER that of a
finished run.  Writes OUT/biaxial_*.png, as many as these runs allow, and prints the table of the runs.

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

from clathra import read_csv, read_snapshots
from clathra.plotting import COLOURS, STYLES, plt, save, set_style

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


def main(out, *given):
    runs = {name: reduce_run(folder) for name, folder in (g.split("=", 1) for g in given)}
    print(TABLE)
    for name, (data, _) in runs.items():
        print(row(name, data))
    figures(runs, Path(out))


if __name__ == "__main__":
    main(*sys.argv[1:])
