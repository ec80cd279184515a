#!/usr/bin/python3
"""Slopes after Figures 20 to 31 of the paper: plot_slope.py NAME WITH WITHOUT OUT

NAME is slope_a, slope_b or slope_c; WITH and WITHOUT (or -) are runs of it with and without heat from plastic work.  Measures both (scripts/slide.py) and writes
case_NAME.png, NAME_fields.png (slope_b, slope_c), NAME_points.png, NAME_energy.png, NAME_bands.png and the film NAME.mp4 (NAME.gif where there is no ffmpeg) into OUT.
"""
import shutil
import sys
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.collections import PolyCollection

import slide
from clathra.plotting import COLOURS, PA, STYLES, plt, save, set_style

TIMES = {"slope_a": (25, 100, 200), "slope_b": (15, 18, 30, 42, 72, 250), "slope_c": (17, 30, 41, 56, 77, 100, 250)}  # s, of the paper's maps
MAPS = (  # title, value of a particle, limits
    ("temperature T (°C)", lambda run, p: p["T"][:, 0], (-2, 8)),
    ("hydrate saturation $S_h$ (–)", lambda run, p: p["S_h"][:, 0], (0, 0.45)),
    ("deviatoric plastic strain $\\epsilon_d^p$ (–)", lambda run, p: p["eps_d_p"][:, 0], (0, 1)),
    ("volumetric strain ln J (–)", lambda run, p: p["log_J"][:, 0], (-0.15, 0.15)),
    ("excess pore pressure (MPa)", lambda run, p: (p["p"] - run.snapshots[0][1]["p"])[:, 0] * PA, (-3, 3)),
    ("displacement since the loading (m)", lambda run, p: run.moved(p), (0, None)),
)
STRAIN = MAPS[2]
FIELDS = {  # s, and maps of both runs: Figures 25 and 31
    "slope_b": (250, (STRAIN, ("displacement along the base $u_x$ (m)", lambda run, p: since(run, p)[:, 0], (0, None)), ("displacement normal to it $u_y$ (m)", lambda run, p: since(run, p)[:, 1], (-80, 0)))),
    "slope_c": (100, (MAPS[0], MAPS[4], ("hydrate left (–)", lambda run, p: (p["mass_hydrate"] / run.snapshots[0][1]["mass_hydrate"])[:, 0], (0, 1)),
                      ("displacement normal to the base $u_y$ (m)", lambda run, p: since(run, p)[:, 1], (-80, 0)))),
}  # fmt: skip
CURVES = (  # label, value of every particle at every snapshot
    ("temperature T (°C)", lambda run: run.rows("T")),
    ("deviatoric plastic strain $\\epsilon_d^p$ (–)", lambda run: run.rows("eps_d_p")),
    ("volumetric strain ln J (–)", lambda run: run.rows("log_J")),
    ("deviatoric stress q (MPa)", lambda run: deviator(run) * PA),
    ("excess pore pressure (MPa)", lambda run: (run.rows("p") - run.rows("p")[0]) * PA),
    ("hydrate saturation $S_h$ (–)", lambda run: run.rows("S_h")),
    ("hydrate lost (%)", lambda run: 100 * (1 - run.rows("mass_hydrate") / run.rows("mass_hydrate")[0])),
)
FRAMES = 10  # a second of the film


def since(run, particles):
    """Displacement (m) of every particle since the loading."""
    return particles["position"] - run.rest


def deviator(run):
    """sqrt(3 J2) (Pa) of every particle at every snapshot."""
    s = np.array([p["stress"][:, :4] for _, p in run.snapshots])
    d = s[..., :3] - s[..., :3].mean(axis=-1, keepdims=True)
    return np.sqrt(1.5 * (d**2).sum(axis=-1) + 3 * s[..., 3] ** 2)


def corners(run, particles):
    """The boxes that the particles were seeded in, where they are and as they are deformed; undeformed where stretched more than thrice."""
    F = particles["deformation_gradient"].reshape(-1, 2, 2)
    F = np.where(np.linalg.norm(F, axis=(1, 2), ord=2)[:, None, None] > 3, np.eye(2), F)
    arms = 0.52 * run.spacing * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    return particles["position"][:, None] + np.einsum("pij,cj->pci", F, arms)


def body(axes, run, particles, values, limits):
    """Draws the particles; returns what a colour bar needs."""
    shown = PolyCollection(corners(run, particles), array=values, cmap="viridis", lw=0, antialiaseds=False)
    shown.set_clim(*limits)
    axes.add_collection(shown)
    reach = (run.end["position"] + run.end["half_length"]).max(axis=0)
    axes.set(xlim=(0, max(reach[0], run.toe) + 5), ylim=(0, max(reach[1], run.height) + 2), aspect="equal")
    axes.grid(False)
    return shown


def maps(name, run, out):
    times = [t for t in TIMES[name] if t <= run.time[-1] + 0.5] or [run.time[-1]]
    shown = MAPS if name == "slope_a" else MAPS[2:3]
    rows = [(m, t) for m in shown for t in times]
    columns = len(times) if name == "slope_a" else 1
    count = len(rows) // columns
    length = run.end["position"][:, 0].max()
    high = count * (1.9 if name == "slope_a" else 13 * run.height / length + 0.6)
    figure, axes = plt.subplots(count, columns, figsize=(13, high), squeeze=False, sharex=True, sharey=True)
    for ax, ((title, value, limits), t) in zip(axes.flat, rows):
        now = run.at(t)
        bar = body(ax, run, now, value(run, now), limits)
        ax.set_title(f"{title}, t = {t:g} s", fontsize=9)
        figure.colorbar(bar, ax=ax, fraction=0.02, pad=0.01)
    save(figure, out, f"case_{name}")


def fields(name, runs, out):
    """Maps of both runs below each other, on one scale each."""
    time, shown = FIELDS[name]
    length = max(run.end["position"][:, 0].max() for run in runs.values())
    height = next(iter(runs.values())).height
    figure, axes = plt.subplots(len(shown) * len(runs), 1, figsize=(13, len(shown) * len(runs) * (13 * height / length + 0.6)), squeeze=False, sharex=True, sharey=True)
    rows = [(*m, *r) for m in shown for r in runs.items()]
    for ax, (title, value, (low, high), label, run) in zip(axes.flat, rows):
        now = run.at(time)
        top = high if high is not None else max(float(value(r, r.at(time)).max()) for r in runs.values())
        bar = body(ax, run, now, value(run, now), (low, top))
        ax.set(xlim=(0, length + 5), title=f"{label}: {title}, t = {run.time[np.argmin(abs(run.time - time))]:.0f} s")
        ax.title.set_fontsize(9)
        figure.colorbar(bar, ax=ax, fraction=0.02, pad=0.01)
    save(figure, out, f"{name}_fields")


def points(name, run, out):
    """Histories of the particles nearest to the probes."""
    figure, axes = plt.subplots(2, 4, figsize=(13, 5.6))
    places = {k: (p["x_m"], p["y_m"]) for k, p in slide.probed(run).items()}
    index = {k: int(np.argmin(np.hypot(*(run.start - place).T))) for k, place in places.items()}
    for ax, (label, values) in zip(axes.flat, CURVES):
        found = values(run)
        for (k, i), colour, style in zip(index.items(), COLOURS, STYLES):
            ax.plot(run.time, found[:, i], style, color=colour, label=f"{k} ({places[k][0]:.0f}, {places[k][1]:.0f}) m")
        ax.set(xlabel="t (s)", title=label)
    axes.flat[0].legend()
    axes.flat[-1].axis("off")
    save(figure, out, f"{name}_points")


def energy(name, runs, measures, out):
    figure, axes = plt.subplots(2, 2, figsize=(13, 7), sharex=True)
    lines = []
    end = min(max(2.5 * m["peak_kinetic_energy_s"], 50) for m in measures)
    for (label, run), m, colour, style in zip(runs.items(), measures, COLOURS, STYLES):
        t, e, P, R = slide.kinetic(run.balance)
        for ax, y in zip(axes.flat, (e, P, R, 100 * (1 - run.balance["hydrate_kg"] / run.balance["hydrate_kg"][0]))):
            ax.plot(t, y, style, color=colour, label=label, lw=1.2)
        lines.append(f"{label}: onset {m['onset_s'] or float('nan'):.1f} s, failed {m['failed_volume_m2']:.0f} m³/m, runout {m['runout_m']:.1f} m, "
                     f"retrogression {m['retrogression_m']:.0f} m, up to {m['peak_mean_velocity_m_s']:.2f} m/s, {m['peak_kinetic_energy_J']:.3g} J/m at {m['peak_kinetic_energy_s']:.0f} s, "
                     f"hydrate lost {100 * m['hydrate_lost_share']:.2f} %, gas {m['gas_released_kg']:.0f} kg/m")  # fmt: skip
    for ax, title in zip(axes.flat, ("$E_k$ (J/m)", "$P_k = dE_k/dt$ (W/m)", "$R_k = d^2E_k/dt^2$ (W/(s m))", "hydrate lost (%)")):
        ax.set(xlabel="t (s)", title=title)
    axes[1, 1].legend()
    figure.suptitle("\n".join(lines), fontsize=9)
    axes[0, 0].set_xlim(0, min(end, max(run.time[-1] for run in runs.values())))
    save(figure, out, f"{name}_energy")


def picture_bands(name, runs, found, out):
    """Plastic strain at the end, in the initial configuration, with the bands that were found and the probes by name."""
    first = next(iter(runs.values()))
    length, height = first.toe, first.height
    figure, axes = plt.subplots(len(runs), 1, figsize=(13, len(runs) * (12 * height / length + 0.7)), squeeze=False)
    for ax, (label, run), bands in zip(axes.flat, runs.items(), found):
        shown = PolyCollection(run.start[:, None] + 0.52 * run.spacing * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]),
                               array=run.end["eps_d_p"][:, 0], cmap="Greys", lw=0, antialiaseds=False)  # fmt: skip
        shown.set_clim(0, 1)
        ax.add_collection(shown)
        for k, b in enumerate(bands):
            colour = COLOURS[k % 6]
            ax.plot((b["x_low_m"], b["x_high_m"]), (b["y_low_m"], b["y_high_m"]), color=colour, lw=1.5)
            if b["y_high_m"] - b["y_low_m"] < 0.6 * height:
                continue
            ax.annotate(f"{b['time_s']:.0f} s, {b['angle_deg']:.0f}°", (b["x_high_m"], b["y_high_m"]), (0, 4), textcoords="offset points", color=colour, fontsize=8, ha="center", va="bottom")
        for k, p in slide.probed(run).items():
            ax.plot(p["x_m"], p["y_m"], "o", ms=4, mfc="white", mec="black", mew=0.8, zorder=5)
            ax.annotate(k, (p["x_m"], p["y_m"]), (4, 4), textcoords="offset points", fontsize=8, bbox={"fc": "white", "ec": "none", "pad": 0.5})
        ax.set(xlim=(0, length), ylim=(0, 1.15 * height), aspect="equal", title=f"{label}: $\\epsilon_d^p$ at {run.time[-1]:.0f} s where particles were at the start, bands found")
        ax.grid(False)
        figure.colorbar(shown, ax=ax, fraction=0.02, pad=0.01)
    save(figure, out, f"{name}_bands")


def film(name, run, out):
    """One frame for each snapshot: plastic strain, and the kinetic energy so far."""
    length, height = run.end["position"][:, 0].max(), run.height
    figure, (above, below) = plt.subplots(2, 1, figsize=(9, 9 * height / length + 3), height_ratios=(9 * height / length + 0.6, 1.8), dpi=80)
    top = float(np.clip(np.quantile(run.end["eps_d_p"], 0.97), 0.2, 1.5))
    shown = body(above, run, run.at(0), run.at(0)["eps_d_p"][:, 0], (0, top))
    figure.colorbar(shown, ax=above, fraction=0.02, pad=0.01, label="$\\epsilon_d^p$")
    t, e = run.balance["time_s"], run.balance["kinetic_energy_J"]
    below.plot(t, e, lw=1)
    below.set(xlabel="t (s)", ylabel="$E_k$ (J/m)", xlim=(0, run.time[-1]))
    (mark,) = below.plot([], [], "o", color=COLOURS[1])

    def draw(k):
        time, particles = run.snapshots[k]
        shown.set_verts(corners(run, particles))
        shown.set_array(particles["eps_d_p"][:, 0])
        above.set_title(f"t = {time:.0f} s")
        mark.set_data([time], [np.interp(time, t, e)])
        return shown, mark

    # every second until the slide is over, then the end
    last = int(np.searchsorted(run.time, (t[e > 0.01 * e.max()].max() if e.max() > 0 else 0) + 10))
    frames = [k for k in range(0, min(last, len(run.time) - 1), max(1, last // 120))] + [len(run.time) - 1] * 5
    kind, writer = ("mp4", FFMpegWriter(fps=FRAMES)) if shutil.which("ffmpeg") else ("gif", PillowWriter(fps=FRAMES))
    path = Path(out) / f"{name}.{kind}"
    FuncAnimation(figure, draw, frames).save(path, writer=writer)
    plt.close(figure)
    print(f"  {path}")


def main(name, heated, unheated, out):
    set_style()
    runs = {"θ = 0.5": slide.Run(heated)} | ({"θ = 0": slide.Run(unheated)} if unheated != "-" else {})
    measures, found = [], []
    for label, run in runs.items():
        measures.append(slide.measure(run))
        found.append(slide.bands(run))
        slide.write(run, measures[-1], found[-1])
        print(f"{label}: " + "\n".join(slide.words(measures[-1], found[-1])))
    first = runs["θ = 0.5"]
    maps(name, first, out)
    if name in FIELDS:
        fields(name, runs, out)
    points(name, first, out)
    energy(name, runs, measures, out)
    picture_bands(name, runs, found, out)
    film(name, first, out)


if __name__ == "__main__":
    main(*sys.argv[1:])
