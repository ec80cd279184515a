#!/usr/bin/python3
"""Figures of any run: plot.py OUT_DIR [OUT_DIR ...] writes OUT_DIR/figures/*.png.

probes.png     histories at the probes
balance.png    errors of the water, methane and energy balance, length of the steps
profiles.png   a strip one cell wide: profiles along it at up to six snapshots
particles.png  any other body: particles coloured by p, T, S_h and S_w at up to four snapshots
"""
import sys
from pathlib import Path

import numpy as np

from plotting import COLOURS, MM, PA, QUANTITIES, STYLES, boxes, derived, is_column, plt, save, set_style, stage_axis, steady_limits
from clathra import probe_names, read_csv, read_snapshots, time_unit

# Panels of probes.png: label, [(column, factor, name in the legend)], least width of the y axis.  A scene without a field
# has no columns for it, and no panel or curve.
PANELS = [
    ("pore pressure (MPa)", [("p_Pa", PA, ""), ("p_w_Pa", PA, "water"), ("p_g_Pa", PA, "gas")], 0.01),
    (QUANTITIES["T"], [("T_degC", 1, "")], 0.1),
    (QUANTITIES["S_h"], [("S_h", 1, "")], 0.01),
    ("saturation (–)", [("S_w", 1, "water"), ("S_g", 1, "gas")], 0.01),
    ("displacement (mm)", [("u_x_m", MM, "x"), ("u_y_m", MM, "y")], 0.01),
    ("effective stress (MPa, tension +)", [("sxx_Pa", PA, "xx"), ("syy_Pa", PA, "yy"), ("sxy_Pa", PA, "xy")], 0.01),
]

SHORT = {"p": "p (MPa)", "T": "T (°C)", "S_h": "$S_h$ (–)", "S_w": "$S_w$ (–)",
         "u_x": "$u_x$ (mm)", "u_y": "$u_y$ (mm)"}  # beside colour bars  # fmt: skip


def spread(count, most):
    """Indices of at most `most` of `count` things, first and last among them."""
    return sorted(set(np.linspace(0, count - 1, min(count, most)).round().astype(int)))


def history_panel(axes, probes, stages, names, label, columns, least):
    shown, (unit, seconds) = [], time_unit(probes["time_s"][-1])
    x = stages[0](probes["time_s"]) if stages else probes["time_s"] / seconds
    for colour, name in zip(COLOURS * len(names), names):
        for style, (column, factor, _) in zip(STYLES, columns):
            values = probes[f"{name}.{column}"] * factor
            axes.plot(x, values, style, color=colour)
            shown.append(values)
    steady_limits(axes, *shown, least=least)
    axes.set(xlabel=f"time ({unit})", ylabel=label)
    if stages:
        lengths = np.diff([0.0, *stages[1]])
        axes.set(xticks=np.arange(len(lengths)) + 0.5, xticklabels=["{:.4g} {}".format(n / u[1], u[0]) for n in lengths for u in [time_unit(5 * n)]],
                 xlabel="time in each stage, of this length", xlim=(0, len(lengths)))  # fmt: skip
        axes.grid(False, axis="x")
        for k in range(1, len(lengths)):
            axes.axvline(k, color="0.6", lw=0.8)
    if len(columns) > 1:
        handles = [plt.Line2D([], [], color="0.3", ls=s, label=c[2] or "mean") for s, c in zip(STYLES, columns)]
        axes.legend(handles=handles, loc="best")


def plot_probes(out):
    probes = read_csv(out / "probes.csv")
    names = probe_names(probes)
    stages = stage_axis(read_csv(out / "balance.csv")) if (out / "balance.csv").is_file() else None
    if not names or not len(probes["time_s"]):
        return
    written = lambda columns: [c for c in columns if f"{names[0]}.{c[0]}" in probes]
    panels = [(label, written(columns), least) for label, columns, least in PANELS if written(columns)]
    if not any(probes.get(f"{n}.S_h", np.zeros(1)).any() for n in names):
        panels = [p for p in panels if p[1][0][0] != "S_h"]
    constant = lambda c: all(np.ptp(probes[f"{n}.{c}"]) == 0 for n in names)
    panels = [p for p in panels if p[1][0][0] != "S_w" or not all(constant(c[0]) for c in p[1])]
    wide = min(len(panels), 3 if len(panels) > 4 else 2)
    figure, grid = plt.subplots(-(-len(panels) // wide), wide, figsize=(4.33 * wide, 3.5 * -(-len(panels) // wide)),
                                squeeze=False)  # fmt: skip
    for axes in grid.flat[len(panels) :]:
        axes.remove()
    for axes, panel in zip(grid.flat, panels):
        history_panel(axes, probes, stages, names, *panel)
    handles = [plt.Line2D([], [], color=c, lw=2.5, label=f"probe {n}") for c, n in zip(COLOURS * len(names), names)]
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(0.01, 0.0), ncol=2 * wide)
    figure.suptitle(f"{out.name}: histories at the probes", x=0.01, ha="left")
    save(figure, out / "figures", "probes")


def plot_balance(out):
    if not (out / "balance.csv").is_file():
        return
    balance = read_csv(out / "balance.csv")
    if not len(balance["time_s"]):
        return
    unit, seconds = time_unit(balance["time_s"][-1])
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 3.8))
    for (name, label), style in zip((("water", "water"), ("methane", "methane"), ("heat", "energy")), STYLES):
        error = np.abs(balance[f"{name}_error"])
        if not error.any():
            continue  # not in the scene
        left.semilogy(balance["time_s"] / seconds, np.maximum(error, 1e-18), style, label=label)
    left.set(xlabel=f"time ({unit})", ylabel="balance error / initial store (–)", title="conservation")
    if left.lines:
        left.legend()
    right.step(balance["time_s"] / seconds, balance["dt_s"], where="pre", color=COLOURS[0])
    right.set(xlabel=f"time ({unit})", ylabel="step (s)", yscale="log", title=f"{len(balance['time_s'])} steps, "
              f"{int(balance['newton'].sum())} Newton iterations")  # fmt: skip
    save(figure, out / "figures", "balance")


def present(snapshots, names):
    """Those of the quantities that the scene has; hydrate and saturations only where they are not the same everywhere."""
    held = [derived(particles) for _, particles in snapshots]
    varies = lambda name: np.ptp(np.concatenate([h[name] for h in held])) > 0
    return [n for n in names if n in held[0] and (n not in ("S_h", "S_w") or varies(n))]


def plot_profiles(out, snapshots, axis):
    """Profiles along the strip against the current position, one colour a snapshot."""
    chosen = [snapshots[k] for k in spread(len(snapshots), 6)]
    names = ["p", "T", "S_h", "S_w", "u_x" if axis == 0 else "u_y"]
    names = present(chosen, names)
    figure, grid = plt.subplots(1, len(names), figsize=(3.4 * len(names) + 1, 3.8), squeeze=False)
    grid = grid[0]
    colours = plt.cm.viridis(np.linspace(0, 0.88, len(chosen)))
    unit, seconds = time_unit(chosen[-1][0])
    for axes, name in zip(grid, names):
        shown = []
        for (time, particles), colour in zip(chosen, colours):
            order = np.argsort(particles["position"][:, axis], kind="stable")
            values = derived(particles)[name][order]
            axes.plot(particles["position"][order, axis], values, ".-", ms=2.5, lw=1.1, color=colour, label=f"{time / seconds:.4g} {unit}")
            shown.append(values)
        steady_limits(axes, *shown, least=0.01)
        axes.set(xlabel=f"{'xy'[axis]} (m)", ylabel=QUANTITIES[name])
    grid[-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5), title="time")
    figure.suptitle(f"{out.name}: profiles of the particles", x=0.01, ha="left")
    save(figure, out / "figures", "profiles")


def plot_scatter(out, snapshots):
    """One row a quantity, one column a snapshot, one colour scale a row."""
    chosen = [snapshots[k] for k in spread(len(snapshots), 4)]
    unit, seconds = time_unit(chosen[-1][0])
    names = present(chosen, ["p", "T", "S_h", "S_w", "u_x", "u_y"])[:4]
    extent = np.ptp(chosen[0][1]["position"], axis=0)
    width = np.clip(4.5 * extent[0] / extent[1], 1.0, 3.4)
    height = np.clip(width * extent[1] / extent[0], 0.8, 3.2) + 0.35
    figure, grid = plt.subplots(len(names), len(chosen), figsize=(width * len(chosen) + 1.5, height * len(names) + 0.5),
                                squeeze=False, sharex=True, sharey=True)  # fmt: skip
    for row, name in zip(grid, names):
        values = [derived(particles)[name] for _, particles in chosen]
        low, high = min(map(np.min, values)), max(map(np.max, values))
        if high - low < 1e-9:
            low, high = low - 1e-3, high + 1e-3
        for axes, (time, particles), v in zip(row, chosen, values):
            dots = boxes(axes, particles, v, low, high)
            axes.set_aspect("equal")
            axes.set_title(f"{time / seconds:.4g} {unit}" if name == names[0] else "")
        row[0].set_ylabel("y (m)")
        figure.colorbar(dots, ax=list(row), label=SHORT[name], pad=0.01, aspect=15)
    for axes in grid[-1]:
        axes.set_xlabel("x (m)")
        if height * extent[0] < 0.6 * extent[1]:  # narrow
            axes.tick_params(axis="x", labelrotation=90)
    figure.suptitle(f"{out.name}: particles", x=0.01, ha="left")
    save(figure, out / "figures", "particles")


def plot_run(out):
    plot_probes(out)
    plot_balance(out)
    snapshots = read_snapshots(out)
    if snapshots:
        axis = is_column(snapshots[0][1]["position"])
        if axis is None:
            plot_scatter(out, snapshots)
        else:
            plot_profiles(out, snapshots, axis)


def main(folders):
    if not folders:
        sys.exit(__doc__)
    set_style()
    for folder in map(Path, folders):
        if not (folder / "probes.csv").is_file():
            sys.exit(f"plot.py: {folder} holds no run (no probes.csv)")
        plot_run(folder)


if __name__ == "__main__":
    main(sys.argv[1:])
