#!/usr/bin/python3
"""Pictures of the ladder of cases, numeric against exact: plot_cases.py [CLATHRA [NAME ...]] writes docs/figures/case_<name>.png.

It runs the cases with the program (default build/clathra) in a temporary folder.  Lines are exact, dots are particles.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

import slide
from clathra.plotting import COLOURS, MM, PA, boxes, plt, save, set_style
from clathra import read_csv, read_snapshots
from clathra.units import YEAR

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "verification"))
import _ladder as ladder  # noqa: E402

DOTS = {"ls": "", "marker": ".", "ms": 4}
EXACT = {"color": "k", "lw": 1.0, "zorder": 0}


class Case:
    """A run of cases/<name> with options: out is its folder."""

    def __init__(self, program, folder, name, *options):
        self.out = Path(folder) / "-".join([name, *(o.strip("-") for o in options)]).replace(" ", "_")
        subprocess.run([program, ROOT / "cases" / name, "-quiet", "-output_dir", self.out, *options],
                       check=True, stdout=subprocess.DEVNULL)  # fmt: skip
        self.snapshots = read_snapshots(self.out)[1:]

    def csv(self, name):
        return read_csv(self.out / f"{name}.csv")


def profiles(axes, case, axis, value, exact, unit="s", scale=1.0, reference=False):
    """One colour a snapshot: value(particles) as dots, exact(x, t) as a line."""
    for colour, (t, v) in zip(COLOURS, case.snapshots):
        x = v["position"][:, axis] - (v["displacement"][:, axis] if reference else 0)
        axes.plot(x, value(v), color=colour, label=f"{t / scale:.4g} {unit}", **DOTS)
        line = np.linspace(x.min(), x.max(), 800)
        axes.plot(line, exact(line, t), **EXACT)
    axes.legend(title="dots: Clathra; lines: exact", title_fontsize=8)


def heat(run, left, right, scene, probes):
    """Profiles and histories of temperature; probes: {name: x (m)}."""
    case = run()
    profiles(left, case, 0, lambda v: v["T"][:, 0], scene.temperature, "h", 3600)
    left.set(xlabel="x (m)", ylabel="temperature (°C)")
    p = case.csv("probes")
    for colour, (name, x) in zip(COLOURS, probes.items()):
        right.plot(p["time_s"] / 3600, p[f"{name}.T_degC"], color=colour, label=f"x = {x} m", **DOTS)
        right.plot(p["time_s"] / 3600, scene.temperature(x, p["time_s"]), **EXACT)
    right.legend()
    right.set(xlabel="time (h)", ylabel="temperature (°C)")


def heat_slab(run, left, right):
    heat(run, left, right, ladder.HeatSlab, {"wall": 0.0, "middle": 0.5})


def heat_advection(run, left, right):
    heat(run, left, right, ladder.HeatAdvection, {"half": 0.5, "one": 1.0})


def elastic_wave(run, left, right):
    case, W = run(), ladder.ElasticWave
    case.snapshots = case.snapshots[:3]
    profiles(left, case, 0, lambda v: v["stress"][:, 0] / 1e3, lambda x, t: W.solution(x, t)[2] / 1e3, "ms", 1e-3, True)
    left.set(xlabel="x (m)", ylabel="stress (kPa)")
    for stepper, colour in (("sdirk2", COLOURS[0]), ("euler", COLOURS[1])):
        p = run("-stepper_type", stepper).csv("probes")
        right.plot(p["time_s"] * 1e3, p["end.u_x_m"] * MM, color=colour, label=stepper)
    t = np.linspace(0, p["time_s"][-1], 2000)
    right.plot(t * 1e3, W.solution(W.L, t)[0] * MM, "k:", label="exact")
    right.legend(ncol=3, loc="upper right")
    right.set(xlabel="time (ms)", ylabel="displacement of the end (mm)", ylim=(None, 0.3))


def gravity_column(run, left, right):
    v, G = run().snapshots[-1][1], ladder.GravityColumn
    Y = v["position"][:, 1] - v["displacement"][:, 1]
    line = np.linspace(0, G.H, 200)
    u, J, _ = G.solution(line)
    left.plot(v["displacement"][:, 1], Y, color=COLOURS[0], label="Clathra", **DOTS)
    left.plot(u, line, **EXACT, label="exact")
    left.plot(G.rho0 * G.g / G.M * (line**2 / 2 - G.H * line), line, "--", color="0.6", label="small strain")
    left.set(xlabel="displacement (m)", ylabel="height before (m)")
    right.plot(0.5 / (1 - v["porosity"][:, 0]), Y, color=COLOURS[0], **DOTS)
    right.plot(J, line, **EXACT)
    right.plot(1 - G.rho0 * G.g * (G.H - line) / G.M, line, "--", color="0.6")
    right.set(xlabel="volume ratio J (–)", ylabel="height before (m)")
    left.legend()


def terzaghi(run, left, right):
    case, Z = run(), ladder.Terzaghi
    profiles(left, case, 0, lambda v: (v["p"][:, 0] - Z.p0) / 1e3, lambda x, t: Z.pressure(x, t) / 1e3, "h", 3600)
    left.set(xlabel="x (m)", ylabel="excess pore pressure (kPa)")
    p = case.csv("probes")
    right.plot(p["time_s"] / 3600, p["end.u_x_m"] * MM, color=COLOURS[0], **DOTS)
    right.plot(p["time_s"] / 3600, Z.settlement(p["time_s"]) * MM, **EXACT)
    right.set(xlabel="time (h)", ylabel="displacement of the end (mm)")


def buckley_leverett(run, left, right):
    B = ladder.BuckleyLeverett
    for axes, cells in ((left, 50), (right, 100)):
        profiles(axes, run("-grid_cells", f"{cells},1", "-stepper_dt", f"{1500 // cells} s"), 0, lambda v: v["S_w"][:, 0], B.exact.saturation)
        axes.set(xlabel="x (m)", ylabel="water saturation (–)", title=f"{cells} cells")


def mcwhorter_sunada(run, left, right):
    case, M = run(), ladder.McWhorterSunada.solution()
    profiles(left, case, 0, lambda v: v["S_w"][:, 0], M.saturation, "h", 3600)
    left.set(xlabel="x (m)", ylabel="water saturation (–)")
    b = case.csv("balance")
    root = np.sqrt(b["time_s"] / 3600)
    right.plot(root, -b["water_out_kg"] / 1000 / 0.02 * MM, color=COLOURS[0], **DOTS)
    right.plot(root, M.imbibed(b["time_s"]) * MM, **EXACT)
    right.set(xlabel="square root of time (√h)", ylabel="water taken up (mm)")


def stefan_front(run, left, right):
    case, F = run("-output_every", "2 h", "-output_times", "0 s"), ladder.StefanFront
    exact, every = F.solution(), case.snapshots
    case.snapshots = [s for s in every if round(s[0] / 3600) in (2, 12, 24, 48)]
    profiles(left, case, 0, lambda v: v["T"][:, 0], exact.temperature, "h", 3600)
    left.set(xlabel="x (m)", ylabel="temperature (°C)")
    t = np.array([0.0] + [t for t, _ in every])
    right.plot(np.sqrt(t[1:] / 3600), [F.front(v) for _, v in every], color=COLOURS[0], **DOTS)
    right.plot(np.sqrt(t / 3600), exact.front(t), **EXACT)
    right.set(xlabel="square root of time (√h)", ylabel="front (m)")


def century(run, left, right):
    case, C = run(), ladder.Century
    a = np.linspace(0, 40, 400)
    for colour, (t, v) in zip(COLOURS, [s for s in case.snapshots if s[0] > 0]):
        depth = C.H - (v["position"][:, 1] - v["displacement"][:, 1])
        left.plot((v["p"][:, 0] - C.p0) / 1e6, depth, color=colour, label=f"{t / YEAR:.0f} years", **DOTS)
        left.plot(C.pressure(a, t)[0] / 1e6, a, **EXACT)
    left.set(xlabel="excess pore pressure (MPa)", ylabel="depth at the start (m)", ylim=(40, 0))
    left.legend(loc="lower left")
    p = case.csv("probes")
    t = p["time_s"][1:]
    right.plot(t / YEAR, -p["top.u_y_m"][1:], color=COLOURS[0], **DOTS)
    right.plot(t / YEAR, C.settlement(t), **EXACT)
    right.set(xlabel="time (years)", ylabel="settlement (m)")


def century_hydrate(run, left, middle, right):
    case = run()
    for colour, (t, v) in zip(COLOURS, [s for s in case.snapshots if s[0] > 0]):
        height, there = v["position"][:, 1] - v["displacement"][:, 1], v["S_h"][:, 0] > 0.05
        p_e = 1e3 * np.exp(38.98 - 8533.8 / (v["T"][:, 0] + 273.15))
        left.plot((v["p"][:, 0] - 5e6) / 1e6, 100 - height, color=colour, label=f"{t / YEAR:.0f} years", **DOTS)
        left.plot(np.where(there, (p_e - 5e6) / 1e6, np.nan), 100 - height, **EXACT)
        middle.plot(v["S_h"][:, 0], 100 - height, color=colour, **DOTS)
    left.plot([], [], **EXACT, label="$p_e(T)$ at hydrate")
    left.set(xlabel="excess pore pressure (MPa)", ylabel="depth at the start (m)", ylim=(100, 0))
    middle.legend(*left.get_legend_handles_labels(), loc="upper center")
    middle.set(xlabel="hydrate saturation (–)", ylim=(100, 0))
    p, b = case.csv("probes"), case.csv("balance")
    right.plot(p["time_s"] / YEAR, p["top.u_y_m"], color=COLOURS[0], marker=".", ms=4)
    right.set(xlabel="time (years)", ylabel="sea floor (m)")
    other = right.twinx()
    other.plot(b["time_s"] / YEAR, b["hydrate_kg"] / b["hydrate_kg"][0], color=COLOURS[1])
    other.set_ylabel("hydrate, of the start", color=COLOURS[1])


def footing(run, left, right):
    """Settlement of the ground's surface and contact stress; lines: a smooth disc on a half space."""
    case, radius = run(), 1.0
    m = case.csv("meters")
    w, force = -m["footing.position_m"][-1], m["footing.force_N"][-1]
    v = case.snapshots[-1][1]
    x, u = v["position"] - v["displacement"], v["displacement"]
    top = x[:, 1] > x[:, 1].max() - 1e-6
    left.plot(x[top, 0], -u[top, 1] * MM, color=COLOURS[0], **DOTS)
    r = np.linspace(0.0, x[:, 0].max(), 800)
    left.plot(r, 2 / np.pi * w * np.arcsin(np.minimum(radius / np.maximum(r, radius), 1.0)) * MM, **EXACT)
    left.set(xlabel="radius (m)", ylabel="settlement of the surface (mm)")
    left.invert_yaxis()
    under = top & (x[:, 0] < 1.5 * radius)
    right.plot(x[under, 0], -v["stress"][under, 1] / 1e3, color=COLOURS[0], **DOTS)
    r = np.linspace(0.0, 0.995 * radius, 400)
    right.plot(r, force / (2 * np.pi * radius * np.sqrt(radius**2 - r**2)) / 1e3, **EXACT)
    right.set(xlabel="radius (m)", ylabel="vertical stress under the surface (kPa)", ylim=(-20, 500))


def body(axes, values, particles, label, aspect=1):
    axes.figure.colorbar(boxes(axes, particles, values), ax=axes, label=label, shrink=0.9)
    axes.set_aspect(aspect)
    axes.set(xlabel="x (m)", ylabel="y (m)")


def shear_box(run, left, right):
    case = run()
    end = case.snapshots[-1][1]
    body(left, end["displacement"][:, 0] * MM, end, "displacement $u_x$ (mm)")
    left.plot([0.5, 1.5, 1.5, 0.5, 0.5], [0, 0, 1, 1, 0], "k--", lw=0.8)
    left.set(xlim=(0.4, 1.75), title="after 10 s; dashed: before")
    for p, mark, colour in (("10 MPa", "-", COLOURS[0]), ("0.1 MPa", ":", COLOURS[1])):
        q = run("-ambient_pressure", p, "-region_block_pressure", p, "-mat_soft_water_ref_pressure", p).csv("probes")
        for what in "xy":
            right.plot(q["time_s"], q[f"corner.u_{what}_m"] * MM, mark, color=colour, lw=1.6 if p == "10 MPa" else 3, label=f"under {p}" if what == "x" else None)
    right.set(xlabel="time (s)", ylabel="displacement of the corner (mm)", title="upper curve $u_x$, lower $u_y$")
    right.legend()


def sea_floor(run, *axes):
    import _sea_floor as floor

    case = run()
    (t0, start), *later = case.snapshots
    for row, (t, v) in zip((axes[:2], axes[2:4]), later):
        when = "at the end of the fall" if t - t0 <= floor.DAY else f"{(t - t0) / floor.YEAR:.0f} years after"
        body(row[0], ((v["p"] - start["p"])[:, 0] + floor.FALL) / 1e3, v, "excess pressure (kPa)", 1.6)
        body(row[1], v["displacement"][:, 1] * MM, v, "displacement $u_y$ (mm)", 1.6)
        row[0].set_title(when)
    left, right = axes[4:]
    x = start["initial_position"]
    middle = np.abs(x[:, 0] - 100) < 2.1
    depth = 50 - floor.DIP * x[middle, 0] - x[middle, 1]
    for colour, (t, v) in zip(COLOURS, later):
        left.plot(((v["p"] - start["p"])[middle, 0] + floor.FALL) / 1e3, depth, color=colour, label=f"{(t - t0) / floor.YEAR:.3g} years", **DOTS)
        down, e, _ = floor.column(t - t0)
        left.plot(e[0] / 1e3, down, **EXACT)
    left.set(xlabel="excess pressure (kPa)", ylabel="depth (m)", ylim=(40, 0), title="a column in the middle; lines: exact")
    left.legend()
    for name, k, other, colour in (("clay of 1e-18 m$^2$", 1e-18, case, COLOURS[0]),
                                   ("of 1e-12 m$^2$", 1e-12, run("-mat_clay_permeability_k0", "1e-12 m^2"), COLOURS[1])):  # fmt: skip
        q = other.csv("probes")
        at = q["time_s"] > t0 + 3600
        years = (q["time_s"][at] - t0) / floor.YEAR
        excess = q["clay.p_Pa"][at] - np.interp(t0, q["time_s"], q["clay.p_Pa"]) + floor.FALL * np.minimum(years * 365, 1)
        right.semilogx(years, excess / 1e3, ".", color=colour, label=name)
        down, e, _ = floor.column(years * floor.YEAR, k)
        right.semilogx(years, [np.interp(17.5, down, line) / 1e3 for line in e], **EXACT)
    right.set(xlabel="years since the fall began", ylabel="excess pressure (kPa)", title="probe clay, 17.5 m deep; lines: exact")
    right.legend(loc="center")


def in_space(panel):
    """Axes of three dimensions in its place."""
    figure, place = panel.figure, panel.get_subplotspec()
    panel.remove()
    return figure.add_subplot(place, projection="3d", proj_type="ortho")


MAGNIFIED = 20  # displacements of footing_3d


def outside(v, axis, end):
    """(n, 4, 3) corners, deformed, of the faces of the particles that were the outermost along `axis` at the start (end: 0 lower, 1 upper)."""
    x, l = v["initial_position"], v["half_length"]
    at = np.isclose(x[:, axis], x[:, axis].max() if end else x[:, axis].min())
    a, b = (k for k in range(3) if k != axis)
    corners = np.repeat((x + MAGNIFIED * v["displacement"])[at][:, None], 4, axis=1)
    corners[:, :, axis] += (1 if end else -1) * l[at, axis][:, None]
    for k, sign in ((a, (-1, 1, 1, -1)), (b, (-1, -1, 1, 1))):
        corners[:, :, k] += np.array(sign) * l[at, k][:, None]
    return corners, at


def footing_3d(run, left, right):
    """Settlement over time, and the quarter of the ground from its planes of symmetry."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    case = run()
    q = case.csv("probes")
    for colour, (name, label) in zip(COLOURS, (("middle", "middle of the footing"), ("corner", "its corner"), ("clay", "clay, 4 m below"))):
        left.plot(q["time_s"] / 86400, -q[f"{name}.u_y_m"] * MM, color=colour, marker=".", ms=3, label=label)
    left.set(xlabel="time (days)", ylabel="settlement (mm)", xscale="log", xlim=(0.3, None))
    left.invert_yaxis()
    left.legend()
    axes = in_space(right)
    v = case.snapshots[-1][1]
    s = v["stress"]
    mises = PA * np.sqrt(0.5 * ((s[:, :3] - s[:, [1, 2, 0]]) ** 2).sum(1) + 3 * (s[:, 3:] ** 2).sum(1))
    colours = plt.cm.ScalarMappable(plt.Normalize(0, mises.max()), "viridis")
    for axis, end in ((1, 1), (0, 0), (2, 0)):
        corners, at = outside(v, axis, end)
        axes.add_collection3d(Poly3DCollection(corners[:, :, [0, 2, 1]], color=colours.to_rgba(mises[at]), lw=0.8))
    high = v["initial_position"].max(0)
    axes.set(xlim=(0, high[0]), ylim=(0, high[2]), zlim=(0, high[1]), xlabel="x (m)", ylabel="z (m)", zlabel="y (m)",
             title=f"deviatoric stress q (MPa); displacements x {MAGNIFIED}")  # fmt: skip
    axes.set_box_aspect(high[[0, 2, 1]])
    axes.view_init(elev=28, azim=-132)
    axes.figure.colorbar(colours, ax=axes, shrink=0.7, pad=0.1)


def collapse_3d(run, left, right):
    """Profiles over the radius, and the heap, its quarter mirrored."""
    case = run()
    bins = np.arange(0, 2.6, 1 / 16)
    for colour, (t, v) in zip(COLOURS, (case.snapshots[k] for k in (0, 1, 3, 7))):
        x = v["position"]
        cell = np.digitize(np.hypot(x[:, 0], x[:, 1]), bins)
        there = np.unique(cell)
        left.plot(bins[there - 1] + 1 / 32, [x[cell == k, 2].max() for k in there], color=colour, label=f"{t:.1f} s", marker=".", ms=3, lw=0.8)
    left.axvline(1 + 1.24, color="k", ls=":", lw=1)
    left.text(2.22, 0.6, "experiments stop here", rotation=90, ha="right", va="center", fontsize=8)
    left.set(xlabel="distance from the axis (m)", ylabel="height of the highest particles (m)", ylim=(0, 1.1), xlim=(0, 2.6))
    left.legend()
    axes = in_space(right)
    v = case.snapshots[-1][1]
    x = np.concatenate([v["position"] * (a, b, 1) for a in (-1, 1) for b in (-1, 1)])
    far = np.tile(np.linalg.norm(v["displacement"], axis=1), 4)
    shown = axes.scatter(*x.T, c=far, s=4, cmap="viridis", lw=0, depthshade=False)
    axes.set(xlim=(-2.3, 2.3), ylim=(-2.3, 2.3), zlim=(0, 1.0), xlabel="x (m)", ylabel="y (m)", zticks=(), title="all of it after 1.6 s: way of the particles (m)")
    axes.set_box_aspect((4.6, 4.6, 1.0), zoom=1.1)
    axes.view_init(elev=25, azim=-60)
    axes.figure.colorbar(shown, ax=axes, shrink=0.7, pad=0.15)


def slope_3d(run, left, right):
    """How far the front goes along the slope, heated in its middle and everywhere, and the body heated in its middle."""
    middle, everywhere = run(), run("-region_heated_upper", "300 m,1 m,96 m")
    for case, label, colour in ((everywhere, "heated everywhere", COLOURS[1]), (middle, "heated to z = 48 m", COLOURS[0])):
        for (t, v), style in zip((case.snapshots[k] for k in (19, 39)), ("--", "-")):
            z, far = v["initial_position"][:, 2], np.linalg.norm(v["displacement"], axis=1)
            rows = np.unique(np.round(z, 6))
            left.plot(rows, [np.quantile(far[np.isclose(z, row)], 0.95) for row in rows], style, color=colour, label=f"{label}, {t:.0f} s")
    left.set(xlabel="z (m)", ylabel="way that 95 % stay below (m)", ylim=(0, None))
    left.legend()
    axes = in_space(right)
    v = middle.snapshots[-1][1]
    x, far = v["position"], np.linalg.norm(v["displacement"], axis=1)
    x, far = np.concatenate([x * (1, 1, side) for side in (-1, 1)]), np.tile(far, 2)
    shown = axes.scatter(x[:, 0], x[:, 2], x[:, 1], c=far, s=3, cmap="viridis", lw=0, depthshade=False, vmax=4)
    axes.set(xlim=(0, 320), ylim=(-96, 96), zlim=(0, 100), zticks=(0, 100), xlabel="x (m)", ylabel="z (m)", title="heated to z = 48 m, 40 s: way of the particles (m)")
    axes.set_box_aspect((320, 192, 100))
    axes.view_init(elev=28, azim=-48)
    axes.figure.colorbar(shown, ax=axes, shrink=0.7, pad=0.15, extend="max")


def slope_warming(run, *axes):
    settled = 20
    case, falling = run(), run("-ambient_level", "{ramp: [461.5 m, 441.5 m, 20 a, 120 a]}")
    at = {round(t / YEAR) - settled: v for t, v in case.snapshots}
    for panel, years in zip(axes, (30, 60, 150)):
        body(panel, at[years]["S_h"][:, 0], at[years], "$S_h$")
        panel.set_title(f"after {years} years")
    for what, shown, colour in (("a sea that warms", case, COLOURS[0]), ("... and falls by 20 m", falling, COLOURS[1])):
        b = shown.csv("balance")
        axes[3].plot(b["time_s"] / YEAR - settled, 100 * b["hydrate_kg"] / b["hydrate_kg"][0], color=colour, label=what)
    axes[3].set(xlabel="years", ylabel="hydrate left (%)", ylim=(0, 105))
    axes[3].legend()
    weak = run("-stage_warm_materials", "slope,weak")
    end = weak.snapshots[-1][1]
    body(axes[4], end["eps_d_p"][:, 0], end, "$\\epsilon_d^p$")
    m = slide.measure(slide.Run(weak.out))
    axes[4].set_title(f"weak ground after {weak.snapshots[-1][0] / YEAR - settled:.0f} years: failed {m['failed_volume_m2']:.0f} m³/m,\nrunout {m['runout_m']:.0f} m, retrogression {m['retrogression_m']:.0f} m", fontsize=8)
    b, p = weak.csv("balance"), weak.csv("probes")
    late = b["time_s"] > (m["slides"][0]["from_s"] if m["slides"] else 120 * YEAR) - YEAR
    row, moved = np.arange(late.sum()), np.interp(b["time_s"][late], p["time_s"], p["face.u_x_m"])
    axes[5].semilogy(row, b["dt_s"][late], color=COLOURS[0])
    axes[5].set(xlabel="rows of balance.csv from a year before the slide on", ylabel="step (s)", ylim=(1e-3, None))
    slid = [f"{(s['from_s'] - 20 * YEAR) / YEAR:.1f} a: {s['lasts_s']:.0f} s, {s['kinetic_energy_J'] / 1e6:.1f} MJ/m" for s in m["slides"] if s["kinetic_energy_J"] > 0.1 * m["peak_kinetic_energy_J"]]
    axes[5].set_title("weak ground: steps, way of the face; slides after\n" + ",\n".join(", ".join(slid[k : k + 2]) for k in range(0, len(slid), 2)), fontsize=8)
    beside = axes[5].twinx()
    beside.plot(row, moved, color=COLOURS[1])
    beside.set_ylabel("m", color=COLOURS[1])


SPACE = {"footing_3d", "collapse_3d", "slope_3d"}  # run by clathra3d
PANELS = {"century_hydrate": (1, 3), "sea_floor": (3, 2), "slope_warming": (3, 2)}  # rows and columns; one row of two without a word
FIGURES = [heat_slab, heat_advection, elastic_wave, gravity_column, terzaghi, buckley_leverett, mcwhorter_sunada, stefan_front, century,
           century_hydrate, footing, footing_3d, collapse_3d, shear_box, sea_floor, slope_warming, slope_3d]  # fmt: skip


def main(program=str(ROOT / "build" / "clathra"), *names):
    set_style()
    for draw in FIGURES:
        name = draw.__name__
        if names and name not in names:
            continue
        with tempfile.TemporaryDirectory() as folder:
            rows, columns = PANELS.get(name, (1, 2))
            figure, axes = plt.subplots(rows, columns, figsize=(9.2, 3.4 if rows == 1 else 2.6 * rows))
            runs = Path(program).with_name("clathra3d") if name in SPACE else program
            draw(lambda *options: Case(runs, folder, name, *options), *axes.flat)
            save(figure, ROOT / "docs" / "figures", f"case_{name}")


if __name__ == "__main__":
    main(*sys.argv[1:])
