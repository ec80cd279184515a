"""Pictures of any run: clathra plot FOLDER [FOLDER ...] writes FOLDER/figures/*.png

probes.png     histories at the probes
meters.png     what meters and plates count, methane that is not in hydrate
balance.png    errors of the water, methane and energy balance, length of the steps
profiles.png   a strip one cell wide: profiles along it at up to six snapshots; upright if the strip is
particles.png  any other body, deformed: p, T, S_h, S_w (or what else changes) at up to four snapshots
maps.png       the same body at the last snapshot: everything that changes, those and stress, strain, porosity, flow

clathra report makes one page of it all.
"""
import sys

import numpy as np
from matplotlib.ticker import MaxNLocator

from . import shown
from .plotting import COLOURS, STYLES, Plain, boxes, colours, plt, save, set_style, steady_limits, wrapped
from .run import Run
from .tables import probe_names
from .units import duration, durations, time_unit

FIRST = ("p", "T", "S_h", "S_w", "u_x", "u_y")  # of particles.png, the first four of them that change
ONE_PHASE = 0.1  # of a period: times whose phases are no farther apart show one phase of a periodic load
PICTURES = ("probes", "meters", "balance", "profiles", "particles", "maps")
ARROWS = 18  # along the longer side, at most


def head(run, what):
    return f"{run.title}: {what}"


def stage_ticks(axes, ends):
    lengths = np.diff([0.0, *ends])
    axes.set(xticks=np.arange(len(lengths)) + 0.5, xticklabels=[duration(n) for n in lengths], xlabel="time in each stage, of this length",
             xlim=(0, len(lengths)))  # fmt: skip
    axes.grid(False, axis="x")
    for k in range(1, len(lengths)):
        axes.axvline(k, color="0.6", lw=0.8)


def history_panel(axes, run, stages, label, unit, columns, least):
    probes, values = run.probes, []
    name, seconds = time_unit(probes["time_s"][-1])
    x = stages[0](probes["time_s"]) if stages else probes["time_s"] / seconds
    for colour, probe in zip(colours(len(run.probe_names)), run.probe_names):
        for style, (column, factor, _) in zip(STYLES, columns):
            values.append(shown.curve(probes, probe, column) * factor)
            axes.plot(x, values[-1], style, color=colour)
    steady_limits(axes, *values, least=least)
    axes.set(xlabel=f"time ({name})", ylabel=shown.tex(f"{label} ({unit})"))
    if stages:
        stage_ticks(axes, stages[1])
    if len(columns) > 1:
        handles = [plt.Line2D([], [], color="0.3", ls=s, label=c[2]) for s, c in zip(STYLES, columns)]
        axes.legend(handles=handles, loc="center left", bbox_to_anchor=(1.0, 0.5))


def plot_probes(run):
    if len(run.probes.get("time_s", ())) < 2:
        return False  # no step was made
    panels = shown.histories(run.probes, run.probe_names)
    if not panels:
        return False
    stages = shown.stage_axis(run.balance)
    wide = min(len(panels), 3 if len(panels) > 4 else 2)
    figure, grid = plt.subplots(-(-len(panels) // wide), wide, figsize=(4.9 * wide, 3.5 * -(-len(panels) // wide)), squeeze=False)
    for axes in grid.flat[len(panels) :]:
        axes.remove()
    for axes, panel in zip(grid.flat, panels):
        history_panel(axes, run, stages, *panel)
    handles = [plt.Line2D([], [], color=c, lw=2.5, label=n) for c, n in zip(colours(len(run.probe_names)), run.probe_names)]
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.0, 0.95), title="probe")
    figure.suptitle(head(run, "histories at the probes"), x=0.01, ha="left")
    save(figure, run.folder / "figures", "probes")
    return True


def plot_meters(run):
    if len(run.meters.get("time_s", ())) < 2:
        return False
    names = probe_names(run.meters)
    panels = shown.production(run.meters, names)
    if not panels:
        return False
    stages, time, wide = shown.stage_axis(run.balance), run.meters["time_s"], min(len(panels), 3 if len(panels) > 4 else 2)
    unit, seconds = time_unit(time[-1])
    rows = -(-len(panels) // wide)
    figure, grid = plt.subplots(rows, wide, figsize=(4.9 * wide, 3.5 * rows), squeeze=False)
    for axes in grid.flat[len(panels) :]:
        axes.remove()
    colour = {**dict(zip(names, colours(len(names)))), "free": "0.3", "dissolved": "0.65"}  # the last two: of the body
    for axes, (label, curves) in zip(grid.flat, panels):
        for name, values in curves:
            axes.plot(stages[0](time) if stages else time / seconds, values, color=colour[name])
        axes.set(xlabel=f"time ({unit})", ylabel=wrapped(label, 3.0))
        axes.yaxis.set_major_formatter(Plain())
        if stages:
            stage_ticks(axes, stages[1])
    handles = [plt.Line2D([], [], color=colour[n], lw=2.5, label=n) for n in dict.fromkeys(n for _, curves in panels for n, _ in curves)]
    figure.legend(handles=handles, loc="upper left", bbox_to_anchor=(1.0, 0.95), title="meter")
    figure.suptitle(head(run, "what the meters count"), x=0.01, ha="left")
    save(figure, run.folder / "figures", "meters")
    return True


def plot_balance(run):
    balance = run.balance
    if not len(balance.get("time_s", ())):
        return False
    unit, seconds = time_unit(balance["time_s"][-1])
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.5, 3.8))
    for (name, label), style in zip((("water", "water"), ("methane", "methane"), ("heat", "energy (of 1 K)")), STYLES):
        error = np.abs(balance[f"{name}_error"])
        if error.any():  # it is in the scene
            left.semilogy(balance["time_s"] / seconds, np.maximum(error, 1e-18), style, label=label)
    left.set(xlabel=f"time ({unit})", ylabel="balance error / initial store (–)", title="conservation")
    if left.lines:
        left.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    else:
        left.remove()
    right.step(balance["time_s"] / seconds, balance["dt_s"], where="pre", color=COLOURS[0], marker="." if len(balance["dt_s"]) < 3 else "")
    right.set(xlabel=f"time ({unit})", ylabel="step (s)", yscale="log", title=f"{balance['step'][-1]:.0f} steps, "
              f"{balance['newton'].sum():.0f} Newton iterations")  # fmt: skip
    figure.suptitle(head(run, "balances and steps"), x=0.01, ha="left")
    save(figure, run.folder / "figures", "balance")
    return True


def plot_profiles(run, times, snapshots, axis, beats=""):
    """Profiles along the strip against the current position, one colour a snapshot; along the second axis with that upright."""
    keys = ("p", "T", "S_h", "S_w", "u_x" if axis == 0 else "u_y", "s_xx" if axis == 0 else "s_yy")
    quantities = [q for q in shown.shown(snapshots, shown.names(run)) if q.key in keys]
    if not quantities:
        return False
    size = (3.4 * len(quantities) + 1, 3.8) if axis == 0 else (2.6 * len(quantities) + 1, 5.6)
    figure, grid = plt.subplots(1, len(quantities), figsize=size, squeeze=False, sharey=axis == 1)
    colours = plt.cm.viridis(np.linspace(0, 0.88, len(snapshots)))
    for axes, q in zip(grid[0], quantities):
        for time, particles, colour in zip(durations(times), snapshots, colours):
            order = np.argsort(particles["position"][:, axis], kind="stable")
            along, values = particles["position"][order, axis], q.of(particles)[order]
            axes.plot(*((along, values) if axis == 0 else (values, along)), ".-", ms=2.5, lw=1.1, color=colour, label=time)
        label, shows = wrapped(q.axis, 3.0 if axis == 0 else 2.2), axes.yaxis if axis == 0 else axes.xaxis
        axes.set(**{"xlabel": "x (m)", "ylabel": label} if axis == 0 else {"xlabel": label})
        shows.set_major_formatter(Plain())
        shows.set_major_locator(MaxNLocator(6 if axis == 0 else 3))
    if axis == 1:
        grid[0][0].set_ylabel(f"{shown.names(run)[1]} (m)")
    grid[0][-1].legend(loc="center left", bbox_to_anchor=(1.02, 0.5), title="time")
    figure.suptitle(head(run, "profiles of the particles" + beats + shown.where(run)), x=0.01, ha="left")
    save(figure, run.folder / "figures", "profiles")
    return True


def frame_size(snapshots, most=(3.4, 3.2)):
    """Width and height (inches) of one map with equal scales."""
    extent = np.max([np.ptp(p["position"], axis=0) for p in snapshots], axis=0)
    width = np.clip(4.5 * extent[0] / extent[1], 1.0, most[0])
    return width, np.clip(width * extent[1] / extent[0], 0.8, most[1])


def tidy_axes(axes, narrow, up):
    axes.set_aspect("equal")
    axes.set(xlabel="x (m)", ylabel=f"{up} (m)")
    axes.label_outer()
    if narrow:
        axes.tick_params(axis="x", labelrotation=90)


def plot_film(run, times, snapshots, quantities):
    """One row a quantity, one column a snapshot, one colour scale a row."""
    width, height = frame_size(snapshots)
    figure, grid = plt.subplots(len(quantities), len(snapshots), figsize=(width * len(snapshots) + 1.8, (height + 0.35) * len(quantities) + 0.5),
                                squeeze=False, sharex=True, sharey=True)  # fmt: skip
    said = durations(times)
    for row, q in zip(grid, quantities):
        values = [q.of(p) for p in snapshots]
        low, high = np.nanmin(values), np.nanmax(values)
        for axes, time, p, v in zip(row, said, snapshots, values):
            drawn = boxes(axes, p, v, low, high, snapshots[0])
            axes.set_title(f"t = {time}" if q is quantities[0] else "")
            tidy_axes(axes, width < 1.5, shown.names(run)[1])
        figure.colorbar(drawn, ax=list(row), label=wrapped(q.axis, height), format=Plain(), ticks=MaxNLocator(4 if height < 1.5 else 6), pad=0.01, aspect=15)
    figure.suptitle(head(run, "the body at output times" + shown.where(run)), x=0.01, ha="left")
    save(figure, run.folder / "figures", "particles")


def arrows(axes, p, fluid):
    """Velocity of a fluid in the pores against the skeleton, at particles that lie evenly, as long as the root of its speed; drawn about its
    particle and shorter than the way to the next one, none reaches another."""
    x, v = p["position"], p[fluid] - p.get("v_s", 0.0)
    gap = np.ptp(x, axis=0).max() / ARROWS
    at = shown.apart(x, gap)
    speed = np.hypot(*v[at].T)
    longest = np.nanmax(speed)
    if longest > 0 and len(at) > 1:
        along = v[at] / np.sqrt(np.maximum(speed, 1e-4 * longest) * longest)[:, None]  # the root of the speed: slow flow is seen, too
        axes.quiver(*x[at].T, *along.T, angles="xy", scale_units="xy", scale=1 / min(1.6 * gap, 0.9 * shown.least_way(x[at])),
                    width=0.006, pivot="mid", color="w", ec="0.1", lw=0.4)  # fmt: skip


def plot_maps(run, time, particles, first, quantities):
    """Every quantity at one time, each with a scale of its own; arrows of flow over the speeds of the fluids."""
    width, height = frame_size([particles], (4.2, 3.6))
    wide = min(len(quantities), max(1, round(13 / (width + 1.3))))
    rows = -(-len(quantities) // wide)
    figure, grid = plt.subplots(rows, wide, figsize=((width + 1.3) * wide, (height + 0.6) * rows + 0.4), squeeze=False)
    for axes in grid.flat[len(quantities) :]:
        axes.remove()
    for axes, q in zip(grid.flat, quantities):
        figure.colorbar(boxes(axes, particles, q.of(particles), first=first), ax=axes, format=Plain(), ticks=MaxNLocator(4 if height < 1.5 else 6), pad=0.01, aspect=15)
        axes.set_title(q.axis)
        if q.key in ("v_w", "v_g"):
            arrows(axes, particles, q.key)
        tidy_axes(axes, width < 1.5, shown.names(run)[1])
    figure.suptitle(head(run, f"t = {duration(time)}" + shown.where(run)), x=0.01, ha="left")
    save(figure, run.folder / "figures", "maps")


def plot_body(run):
    times = run.times
    if not len(times):
        return False
    first = shown.drawn(run, times[0])
    axis = shown.strip_axis(first["position"])
    period, taken, beats = shown.period(run.case), shown.spread(len(times), 4 if axis is None else 6), ""
    if period:
        taken, wide = shown.spread_phases(times, 4 if axis is None else 6, period)
        beats = f"; at {'one phase' if wide < ONE_PHASE else 'unlike phases'} of the load, whose period is {duration(period)}"
    times = times[taken]
    snapshots = [first, *(shown.drawn(run, t) for t in times[1:])]
    if axis is not None:
        return plot_profiles(run, times, snapshots, axis, beats)
    changing = shown.shown(snapshots, shown.names(run))
    rows = [q for q in changing if q.key in FIRST][:4]
    if rows:
        plot_film(run, times, snapshots, rows)
    uneven = [q for q in changing if np.nanmax(q.of(snapshots[-1])) > np.nanmin(q.of(snapshots[-1]))]
    if uneven and len(times) > 1:
        plot_maps(run, times[-1], snapshots[-1], first, uneven)
    return bool(rows)


def draw(run, damaged):
    """All pictures of a run; the functions that drew one.  What is damaged is not drawn, with a sentence in `damaged`."""
    return [plot.__name__ for plot in (plot_probes, plot_meters, plot_balance, plot_body) if shown.unless_damaged(damaged, False, plot, run)]


def main(folders):
    if not folders or folders[0].startswith("-"):
        print(__doc__, file=sys.stdout if folders else sys.stderr)
        return 0 if folders else 2
    set_style()
    ends_well = True
    for folder in folders:
        damaged = []
        run = Run(folder, damaged.append)
        for name in PICTURES:
            (run.folder / "figures" / f"{name}.png").unlink(missing_ok=True)
        if not draw(run, damaged):
            print(f"  {folder}: nothing to draw yet")
        for sentence in dict.fromkeys(damaged):
            print(f"clathra plot: {sentence}; what needs it is not drawn", file=sys.stderr)
        ends_well = ends_well and not damaged
    return 0 if ends_well else 2
