#!/usr/bin/python3
"""Figures 6 and 7 of the paper from a run of cases/masuda, with the reference's curves: plot_masuda.py RUN_DIR OUT

Writes OUT/masuda_contours.png (gas pressure, temperature, hydrate and gas saturation in the core, mirrored at its axis, at
five times) and OUT/masuda_curves.png (surface temperatures, far-end pressure, gas), and prints the largest differences
from cases/masuda/reference/masuda.csv.
"""
import sys
from pathlib import Path

import numpy as np

from masuda_run import BARS, JUDGED, REFERENCE, curves, differences
from clathra.plotting import COLOURS, PA, plt, save, set_style, steady_limits
from clathra import read_csv, read_snapshots

TIMES = ((600, "10 min"), (3600, "1 h"), (7200, "2 h"), (10800, "3 h"), (14400, "4 h"))
FIELDS = (  # variable, factor, label, colours
    ("p_g", PA, "$p_g$ (MPa)", "viridis"), ("T", 1, "T (°C)", "inferno"), ("S_h", 1, "$S_h$ (–)", "cividis"),
    ("S_g", 1, "$S_g$ (–)", "YlGnBu"),
)  # fmt: skip
PANELS = (  # title, axis label, ((column, name), ...)
    ("(a) T1, 75 mm from the outlet", "surface temperature (°C)", (("T75_C", ""),)),
    ("(b) T3, 225 mm from the outlet", "surface temperature (°C)", (("T225_C", ""),)),
    ("(c) closed end, P0", "gas pressure (MPa)", (("pg_far_MPa", ""),)),
    ("(d) gas at 101.4 kPa and 15.56 °C", "gas (1000 cm³)", (("gas_tot_cm3", "produced + in pores"), ("gas_out_cm3", "produced"))),
)
WORDS = {"itself": (100, "%"), "K": (1, "K"), "absolute": (1, "")}


def lattice(particles, name):
    """Edges along the axis and the radius (mm), and the values on them: (radii, along)."""
    x = particles["position"]
    r, y = (np.unique(np.round(x[:, k], 9)) for k in (0, 1))
    values = np.full((len(r), len(y)), np.nan)
    values[np.searchsorted(r, x[:, 0] - 1e-8), np.searchsorted(y, x[:, 1] - 1e-8)] = particles[name][:, 0]
    edges = lambda c: 1e3 * np.arange(len(c) + 1) * (c[1] - c[0])
    return edges(y), edges(r), values


def plot_contours(snapshots, out):
    found = [(label, s) for wanted, label in TIMES for t, s in snapshots if abs(t - wanted) < 1e-6 * wanted]
    if not found:
        print("  no snapshots at the times of Figure 6")
        return
    figure, grid = plt.subplots(len(found), len(FIELDS), figsize=(14, 0.78 * len(found) + 1.3), sharex=True, sharey=True,
                                squeeze=False)  # fmt: skip
    for column, (name, factor, label, colours) in zip(grid.T, FIELDS):
        low, high = (factor * f([s[name] for _, s in found]) for f in (np.min, np.max))
        for axes, (time, particles) in zip(column, found):
            along, radius, values = lattice(particles, name)
            both = np.vstack([values[::-1], values]) * factor  # the core is mirrored at its axis
            axes.grid(False)
            shown = axes.pcolormesh(along, np.r_[-radius[:0:-1], radius], both, cmap=colours, vmin=low, vmax=high,
                                    rasterized=True)  # fmt: skip
            axes.set_aspect("equal")
        figure.colorbar(shown, ax=list(column), location="bottom", label=label, aspect=28, pad=0.02)
    for axes, (time, _) in zip(grid[:, 0], found):
        axes.set_ylabel(f"{time}\nr (mm)")
        axes.set_yticks((-25, 0, 25))
    for axes, (_, _, label, _), letter in zip(grid[0], FIELDS, "abcd"):
        axes.set_title(f"({letter}) {label.split(' ')[0]}")
    for axes in grid[-1]:
        axes.set_xlabel("distance from the outlet (mm)")
    figure.suptitle("Masuda's core: outlet on the left, bath around it (Figure 6)", x=0.01, ha="left")
    save(figure, out, "masuda_contours")


def difference_in_words(run, reference, column):
    """Largest difference from the reference at the judged times that the run has reached."""
    times = JUDGED[JUDGED <= run["t_min"][-1] * (1 + 1e-9)]
    try:
        error = differences(run, reference, column, times)
    except ValueError:
        return None
    factor, unit = WORDS[BARS[column][1]]
    return f"{factor * np.max(np.abs(error)):.2g} {unit}".strip() if len(times) else None


def plot_curves(run, reference, out):
    figure, grid = plt.subplots(2, 2, figsize=(11, 7.6))
    for axes, (title, label, columns) in zip(grid.flat, PANELS):
        differ = []
        for (column, name), colour in zip(columns, COLOURS):
            factor = 1e-3 if column.endswith("cm3") else 1
            axes.plot(reference["t_min"] / 60, factor * reference[column], "o", ms=4.5, mfc="none", mew=0.9, markevery=2,
                      color="0.25", label="reference (finite volumes)" if column == columns[0][0] else None)  # fmt: skip
            axes.plot(run["t_min"] / 60, factor * run[column], color=colour, lw=2, label=name or "Clathra")
            steady_limits(axes, run[column] * factor, least=0.01)
            words = difference_in_words(run, reference, column)
            if words:
                differ.append(words)
                print(f"  {column:12s}: largest difference from the reference to 4 h {words}")
        axes.set(xlabel="time (h)", ylabel=label, xlim=(0, run["t_min"][-1] / 60))
        axes.set_title(title + (f"; largest difference {' and '.join(differ)}" if differ else ""), fontsize=9.5)
        axes.legend(loc="best")
    for axes in grid[0]:
        axes.axhline(2, color="0.6", lw=0.8, ls=":")
    figure.suptitle("Masuda's core: histories and the reference's curves (Figure 7); differences to 4 h", x=0.01, ha="left")
    save(figure, out, "masuda_curves")


def main(arguments):
    if len(arguments) != 2:
        sys.exit(__doc__)
    set_style()
    folder, out = map(Path, arguments)
    plot_contours(read_snapshots(folder), out)
    plot_curves(curves(folder), read_csv(REFERENCE), out)


if __name__ == "__main__":
    main(sys.argv[1:])
