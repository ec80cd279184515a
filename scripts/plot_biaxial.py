#!/usr/bin/python3
"""Biaxial compression, after Figures 13 to 17 of the paper: plot_biaxial.py A B C OUT [HYBRID]

A, B, C (and A by hybrid) are folders of finished runs of cases/biaxial.  Writes OUT/case_biaxial.png and prints the table of its page.
"""
import sys
from pathlib import Path

import numpy as np

from plotting import COLOURS, PA, STYLES, boxes, plt, save, set_style
from results import read_csv, read_snapshots

HEIGHT, WIDTH = 4.0, 1.0  # of the half sample, m
BAND = 0.3  # plastic strain eps_d_p of what is called a band
MAPS = (  # run, title, value of a particle, limits
    ("A", "A: $\\epsilon_d^p$ (–)", lambda v, start: v["eps_d_p"][:, 0], (0, 1)),
    ("A", "A: p (MPa)", lambda v, start: v["p"][:, 0] * PA, (2, 4)),
    ("A", "A: $S_h$ (–)", lambda v, start: v["S_h"][:, 0], (0.15, 0.5)),
    ("B", "B: $S_h$ (–)", lambda v, start: v["S_h"][:, 0], (0.15, 0.5)),
    ("A", "A: T (°C)", lambda v, start: v["T"][:, 0], (0, 2.5)),
    ("C", "C: T (°C)", lambda v, start: v["T"][:, 0], (0, 2.5)),
    ("C", "C: hydrate lost (–)", lambda v, start: 1 - v["mass_hydrate"][:, 0] / start["mass_hydrate"][:, 0], None),
)


def curves(folder):
    """Axial strain, stress under the plate beyond the confining pressure (Pa)."""
    m = read_csv(Path(folder) / "meters.csv")
    return -m["top.position_m"] / HEIGHT, m["top.stress_Pa"]


def volumetric(folder, snapshots):
    """(axial strain, change of volume) at the snapshots."""
    m = read_csv(Path(folder) / "meters.csv")
    total = np.array([v["volume"].sum() for _, v in snapshots])
    return -np.interp([t for t, _ in snapshots], m["time_s"], m["top.position_m"]) / HEIGHT, total / total[0] - 1


def band_angle(particles, upper):
    """Slope (degrees) of the upper or lower band: a line through the centres of its plastic strain in columns of 0.1 m, weighted with the
    strain beyond half the column's largest; away from the axis, where the bands cross, and from the free side."""
    x, y = particles["position"].T
    e = particles["eps_d_p"][:, 0]
    half = y > y.mean() if upper else y < y.mean()
    centres = []
    for left in np.arange(0.4, 0.85, 0.05) * WIDTH:
        k = half & (x >= left) & (x < left + 0.1)
        w = e[k] * (e[k] > 0.5 * e[k].max())
        centres.append((np.average(x[k], weights=w), np.average(y[k], weights=w)))
    return np.degrees(np.arctan(abs(np.polyfit(*np.transpose(centres), 1)[0])))


def describe(name, folder, snapshots):
    """One row of the table: peak, end, volume, bands."""
    strain, stress = curves(folder)
    (_, start), (_, end) = snapshots[0], snapshots[-1]
    peak = stress.argmax()
    band = end["eps_d_p"][:, 0] > BAND
    mean = lambda key: np.average(end[key][band, 0], weights=end["volume"][band, 0])
    warmth = f"{mean('T'):.2f}" if "T" in end else "–"  # without kinetics nothing changes T, and it is no field
    lost = lambda k: 1 - end["mass_hydrate"][k].sum() / start["mass_hydrate"][k].sum()
    return (f"| {name} | {stress[peak] * PA:.2f} at {100 * strain[peak]:.2f} % | {stress[-1] * PA:.2f} at {100 * strain[-1]:.1f} % | "
            f"{100 * volumetric(folder, snapshots)[1][-1]:+.2f} % | {band_angle(end, True):.1f}, {band_angle(end, False):.1f} | "
            f"{mean('p') * PA:.2f} | {warmth} | {mean('S_h'):.3f} | {100 * lost(band):.1f} % | {100 * lost(slice(None)):.1f} % |")  # fmt: skip


def main(a, b, c, out, hybrid=None):
    set_style()
    folders = {"A": a, "B": b, "C": c} | ({"A, hybrid": hybrid} if hybrid else {})
    runs = {name: read_snapshots(folder) for name, folder in folders.items()}
    print("| case | peak stress (MPa) | at the end | volume | bands (deg) | p (MPa) | T (°C) | S_h | hydrate lost there | in all |")
    for name, folder in folders.items():
        print(describe(name, folder, runs[name]))

    figure = plt.figure(figsize=(13, 8.4))
    above, below = figure.subfigures(2, 1, height_ratios=(1, 1.25))
    left, right = above.subplots(1, 2)
    for (name, folder), colour, style in zip(folders.items(), COLOURS, (*STYLES[:3], "-")):
        strain, stress = curves(folder)
        label = {"A": "A: kinetics", "B": "B: no kinetics", "C": "C: and plastic heat"}.get(name, name)
        left.plot(100 * strain, stress * PA, style, color=colour, label=label)
        strain, volume = volumetric(folder, runs[name])
        right.plot(100 * strain, 100 * volume, style, color=colour, marker=".", label=label)
    left.set(xlabel="axial strain (%)", ylabel="axial stress beyond 3.75 MPa (MPa)")
    right.set(xlabel="axial strain (%)", ylabel="change of volume (%)")
    left.legend()
    for axes, (name, title, value, limits) in zip(below.subplots(1, len(MAPS), sharey=True), MAPS):
        start, end = runs[name][0][1], runs[name][-1][1]
        shown = boxes(axes, end, value(end, start), *(limits or (None, None)))
        below.colorbar(shown, ax=axes, location="bottom", pad=0.02)
        axes.set_aspect("equal")
        axes.set(title=title, xlabel="x (m)")
    save(figure, out, "case_biaxial")


if __name__ == "__main__":
    main(*sys.argv[1:])
