#!/usr/bin/python3
"""Figures 9-11 of the paper, with this program's curves beside the reference: plot_bp2.py CASE1_DIR CASE2_DIR OUT

Case 1 is BP2 with hydrate kinetics off, case 2 with kinetics on.  Writes OUT/fig09_case1.png, OUT/fig10_case2.png and
OUT/fig11_profiles.png, and prints the largest differences from cases/bp2/reference/bp2_case{1,2}.csv and, of the front of
hydrate at 1000 s, from bp2_case2_front.csv.
"""
import sys
from pathlib import Path

import numpy as np

import clathra
from clathra import probe_names, read_csv
from clathra.plotting import COLOURS, MM, PA, plt, save, set_style, steady_limits
from clathra.shown import QUANTITIES

REFERENCE = Path(__file__).resolve().parents[1] / "cases" / "bp2" / "reference"
INNER, LOADED = 0.6, 1.0  # m from the fixed end

# key: (column of the reference, probe at, column of the probe, factor, label, kind of the difference)
CURVES = {
    "p": ("p_MPa", INNER, "p_Pa", PA, "pore pressure p at x = 0.6 m (MPa)", "relative"),
    "S_h": ("Sh", INNER, "S_h", 1, "hydrate saturation $S_h$ at x = 0.6 m (–)", "of peak"),
    "T": ("T_C", INNER, "T_degC", 1, "temperature T at x = 0.6 m (°C)", "K"),
    "u": ("u_mm", LOADED, "u_x_m", MM, "displacement of the loaded end (mm)", "of peak"),
}


def curve(probes, place, column, factor):
    """Time and values of the probe that starts nearest to `place`."""
    names = probe_names(probes)
    nearest = min(names, key=lambda n: abs(probes[f"{n}.x_m"][0] - place))
    return probes["time_s"], probes[f"{nearest}.{column}"] * factor


def largest_difference(time, values, reference, column, kind):
    """Largest difference at the reference's times the run has reached, in words."""
    known = reference["t_s"] <= time[-1] * (1 + 1e-9)
    want = reference[column][known]
    error = np.abs(np.interp(reference["t_s"][known], time, values) - want)
    if kind == "relative":
        return f"{100 * np.max(error / np.abs(want)):.2f} %"
    if kind == "K":
        return f"{np.max(error):.3f} K"
    peak = np.max(np.abs(want))
    return f"{100 * np.max(error) / peak:.2f} % of the peak" if peak > 0 else f"{np.max(error):.2g}"


def draw(axes, key, probes, reference, case):
    column, place, probe_column, factor, label, kind = CURVES[key]
    time, values = curve(probes, place, probe_column, factor)
    shown = [values]
    if reference is not None:
        shown.append(reference[column])
        axes.plot(reference["t_s"], reference[column], "o", ms=4.5, mfc="none", mew=0.9, markevery=2, color="0.25",
                  label="reference (finite volumes)")  # fmt: skip
        difference = largest_difference(time, values, reference, column, kind)
        axes.set_title(f"largest difference {difference}", fontsize=9.5, color="0.3")
        print(f"  case {case}, {key:3s}: largest difference from the reference {difference}")
    axes.plot(time, values, color=COLOURS[0], lw=2, label="Clathra")
    steady_limits(axes, *shown, least=0.01)
    axes.set(xlabel="time (s)", ylabel=label, xlim=(0, max(time[-1], 1e-9)))


def read_reference(case):
    path = REFERENCE / f"bp2_case{case}.csv"
    if path.is_file():
        return read_csv(path)
    print(f"  no reference curve {path}")
    return None


def plot_histories(folder, case, keys, size, name, title, out):
    probes, reference = read_csv(folder / "probes.csv"), read_reference(case)
    rows = len(keys) // 2
    figure, grid = plt.subplots(rows, 2, figsize=size, squeeze=False)
    for axes, key, letter in zip(grid.flat, keys, "abcd"):
        draw(axes, key, probes, reference, case)
        axes.text(-0.12, 1.02, f"({letter})", transform=axes.transAxes, fontweight="bold")
    grid[0][0].legend(loc="best")
    figure.suptitle(title, x=0.01, ha="left")
    save(figure, out, name)


def draw_front(axes, particles, values):
    """The front of hydrate at 1000 s (reference in initial coordinates) where the particles have moved to."""
    front, x0, x = read_csv(REFERENCE / "bp2_case2_front.csv"), particles["initial_position"][:, 0], particles["position"][:, 0]
    order = np.argsort(x0, kind="stable")
    places = np.interp(front["x0_m"], x0[order], x[order])
    axes.plot(places, front["Sh"], "o", ms=4.5, mfc="none", mew=0.9, color="0.25", label="reference (finite volumes), 1000 s")
    axes.legend(loc="lower left", fontsize=8)
    error = np.max(np.abs(np.interp(front["x0_m"], x0[order], values[order]) - front["Sh"])) / np.max(values)
    print(f"  case 2, S_h at the front at 1000 s: largest difference from the reference {100 * error:.1f} % of the peak")


def plot_profiles(folder, out, times=(500.0, 1000.0)):
    run = clathra.Run(folder)
    found = [(t, run.particles(t)) for t in times if np.any(np.isclose(run.times, t))]
    if not found:
        print(f"  no particle snapshots at {times} s in {folder}")
        return
    wanted = {q.key: q for q in QUANTITIES}
    quantities = [wanted[key] for key in ("p", "T", "S_h", "u_x")]
    figure, grid = plt.subplots(1, 4, figsize=(14, 3.8))
    for axes, quantity, letter in zip(grid, quantities, "abcd"):
        shown = []
        for (time, particles), colour, style in zip(found, COLOURS, ("-", "--")):
            x = particles["position"][:, 0]
            order = np.argsort(x, kind="stable")
            shown.append(quantity.of(particles)[order])
            axes.plot(x[order], shown[-1], style, color=colour, label=f"{time:g} s")
            if quantity.key == "S_h" and time == 1000.0:
                draw_front(axes, particles, quantity.of(particles))
        steady_limits(axes, *shown, least=0.01)
        axes.set(xlabel="x (m)", ylabel=quantity.axis, xlim=(0, 1))
        axes.set_title(f"({letter})", fontweight="bold")
    grid[0].legend(loc="best")
    figure.suptitle("BP2 case 2 (hydrate kinetics on): profiles (Figure 11)", x=0.01, ha="left")
    save(figure, out, "fig11_profiles")


def main(arguments):
    if len(arguments) != 3:
        sys.exit(__doc__)
    set_style()
    case1, case2, out = map(Path, arguments)
    plot_histories(case1, 1, ("p", "u"), (11, 4.2), "fig09_case1", "BP2 case 1 (hydrate kinetics off), Figure 9", out)
    plot_histories(case2, 2, ("p", "u", "S_h", "T"), (11, 8), "fig10_case2", "BP2 case 2 (hydrate kinetics on), Figure 10",
                   out)  # fmt: skip
    plot_profiles(case2, out)


if __name__ == "__main__":
    main(sys.argv[1:])
