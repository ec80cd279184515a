#!/usr/bin/python3
"""Figures 13 to 18, B.32, B.33, C.36 and C.37 of the paper from runs of cases/biaxial: plot_biaxial.py OUT NAME=FOLDER...

NAME is A, B, C (the paper's cases), hybrid (A by hybrid), psi (psi = phi) or a name of scripts/biaxial.py; FOLDER that of a
finished run.  Writes OUT/biaxial_*.png, as many as these runs allow, and prints the table of the runs.
"""
import sys
from pathlib import Path

import numpy as np
from matplotlib.collections import PolyCollection

from biaxial_data import angles, at_strain, peak, reduce_run
from clathra.plotting import COLOURS, STYLES, plt, save, set_style

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
