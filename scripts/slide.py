#!/usr/bin/python3
"""What a slide did, and its pictures: slide.py FOLDER, or slide.py NAME WITH WITHOUT OUT

FOLDER is a run of cases/slope_a, slope_b, slope_c or slope_warming: what moves is counted from the end of its first stage.  Measures the slide and its shear bands
from snapshots and balance.csv, writes FOLDER/slide.json and puts the measures at the end of FOLDER/summary.txt.  docs/studies/slopes.md says how each of them is defined.

NAME is slope_a, slope_b or slope_c; WITH and WITHOUT (or -) are runs of it with and without heat from plastic work.  Measures both and draws Figures 20 to 31 of the paper:
case_NAME.png, NAME_fields.png (slope_b, slope_c), NAME_points.png, NAME_energy.png, NAME_bands.png and the film NAME.mp4 (NAME.gif where there is no ffmpeg) into OUT.
"""
import json
import shutil
import sys
from pathlib import Path

import numpy as np
from matplotlib.animation import FFMpegWriter, FuncAnimation, PillowWriter
from matplotlib.collections import PolyCollection

from clathra import probe_names, read_case, read_csv, read_snapshots, time_unit
from clathra.plotting import COLOURS, PA, STYLES, plt, save, set_style

MOVED = 0.01  # of the height: what has moved farther has failed
STARTED = 0.01  # failed share of the body at the onset
RISEN = 3.0  # kinetic energy at the rise, of the largest during the loading
PROMINENT = 0.02  # of the largest kinetic energy: how far it falls between two peaks
REST = 0.01  # of the largest mean speed: what is slower is over
SMOOTH = 1.0  # s: half the window of means and slopes in time
HEATED = 150.0  # m: where the heated base begins
SHEARED = 0.15  # eps_d_p of a sheared particle
CONTRAST = 2.0  # of a band's strain to that beside it
LONG, SHORT = 0.6, 0.4  # of the height: the shortest band as it forms, and at the end
SEARCH = 2.0  # s between two searches
GAS = 0.016 / 0.124  # kg of methane per kg of hydrate
MASSES = ("mass_solid", "mass_hydrate", "mass_water", "mass_gas")
STANDARD = 0.6789  # kg/m3, methane at 101.4 kPa and 15.56 degC


def of_all(snapshots):
    """The snapshots without the particles that had left the grid by the last of them."""
    stay = snapshots[-1][1]["id"]
    return [(t, p if len(p["id"]) == len(stay) else {k: v[np.isin(p["id"], stay)] for k, v in p.items()}) for t, p in snapshots]


def rows_until(columns, end):
    """The rows of a CSV until a time."""
    keep = columns["time_s"] <= end
    return {k: v[keep] for k, v in columns.items()}


class Run:
    """Snapshots, balance and probes of a run, as far as `until` (s) if that is given.  loaded: when its first stage ended, s; cell: size (m) of a cell along y, from
    2 x 2 particles, or `across` of them; gone: particles that left the grid."""

    def __init__(self, folder, across=2, until=None):
        self.folder = Path(folder)
        case = read_case(self.folder / "case.yaml")
        self.loaded = case[f"stage_{case['stages'][0]}_end"]
        end = (np.inf if until is None else until) * (1 + 1e-9)
        self.snapshots = of_all(whole := [(t, p) for t, p in read_snapshots(folder) if t <= end])
        self.gone = len(whole[0][1]["id"]) - len(self.snapshots[0][1]["id"])
        self.balance, self.probes = (rows_until(read_csv(self.folder / name), end) for name in ("balance.csv", "probes.csv"))
        self.time = np.array([t for t, _ in self.snapshots])
        first = self.snapshots[0][1]
        self.start, self.end = first["initial_position"], self.snapshots[-1][1]
        self.spacing = 2 * first["half_length"][0]
        self.cell = across * self.spacing[1]
        self.height = self.start[:, 1].max() + self.spacing[1] / 2
        top = self.start[:, 1] > self.height - self.spacing[1]
        self.crest = self.start[top, 0].max() + self.spacing[0] / 2
        self.toe = self.start[:, 0].max() + self.spacing[0] / 2
        self.top = top
        self.rest = self.at(self.loaded)["position"]

    def at(self, time):
        """The snapshot nearest to a time."""
        return self.snapshots[int(np.argmin(abs(self.time - time)))][1]

    def moved(self, particles):
        """Distance (m) of each particle from where the loading left it."""
        return np.hypot(*(particles["position"] - self.rest).T)

    def failed(self, particles):
        return self.moved(particles) > MOVED * self.height

    def rows(self, variable, component=0):
        """(snapshots, particles) values of a variable."""
        return np.array([p[variable][:, component] for _, p in self.snapshots])


def crossing(times, values, level):
    """First time at which values, one for each time, pass a level; None if they do not."""
    above = np.flatnonzero(values > level)
    if not len(above):
        return None
    k = above[0]
    if k == 0:
        return float(times[0])
    return float(times[k - 1] + (level - values[k - 1]) / (values[k] - values[k - 1]) * (times[k] - times[k - 1]))


def kinetic(balance):
    """(t, E_k (J), P_k (W), R_k (W/s)): kinetic energy, its power from the forces (mean over 2 SMOOTH), and the slope of that by linear least squares over as long."""
    t, e, power = (balance[k] for k in ("time_s", "kinetic_energy_J", "kinetic_power_W"))
    R = np.zeros(len(t))
    for k in range(len(t)):
        near = slice(*np.searchsorted(t, (t[k] - SMOOTH, t[k] + SMOOTH)))
        if near.stop - near.start > 3:
            R[k] = np.polyfit(t[near] - t[k], power[near], 1)[0]
    return t, e, smooth(t, power), R


def smooth(t, values):
    """Means over 2 SMOOTH."""
    total = np.concatenate([[0.0], np.cumsum(values)])
    first, last = np.searchsorted(t, t - SMOOTH), np.searchsorted(t, t + SMOOTH)
    return (total[last] - total[first]) / (last - first)


def peaks(t, values, least):
    """Times of the local maxima from which values fall by at least `least` on both sides."""
    found, low, top = [], values[0], None
    for time, v in zip(t, values):
        if top is None:
            low = min(low, v)
            if v > low + least:
                top = (v, time)
        else:
            top = max(top, (v, time))
            if v < top[0] - least:
                found.append(top)
                low, top = v, None
    return found


# ---------------------------------------------------------------- bands
def passed(run, level):
    """Time at which each particle's eps_d_p passes a level; infinite where it never does."""
    eps = run.rows("eps_d_p")
    k = np.argmax(eps > level, axis=0)
    below, above = np.take_along_axis(eps, np.maximum(k - 1, 0)[None], 0)[0], np.take_along_axis(eps, k[None], 0)[0]
    with np.errstate(divide="ignore", invalid="ignore"):
        time = run.time[np.maximum(k - 1, 0)] + (level - below) / (above - below) * (run.time[k] - run.time[np.maximum(k - 1, 0)])
    return np.where((eps > level).any(axis=0), np.where(k == 0, run.time[0], time), np.inf)


def longest(good):
    """(first, last) of the longest run of True, over gaps of up to two."""
    best, first, last = (0, -1), None, None
    for j in np.flatnonzero(good):
        if first is None or j - last > 3:
            first = j
        last = j
        if last - first > best[1] - best[0]:
            best = (first, last)
    return best


def strips(x, eps, angle, cell, least):
    """Best straight strip at one angle: (score, offset, from, to along it), from the mean strain of strips one cell wide, each compared with those two
    cells to either side.  x (n, 2), eps (n,); NaN where a particle already belongs to a band."""
    along = np.array([np.cos(angle), np.sin(angle)])
    s, n = x @ along, x @ np.array([-along[1], along[0]])
    i, j = np.floor((n - n.min()) / (cell / 2)).astype(int), np.floor((s - s.min()) / cell).astype(int)
    total, count, used = (np.zeros((i.max() + 14, j.max() + 1)) for _ in range(3))
    free = ~np.isnan(eps)
    np.add.at(total, (i[free] + 6, j[free]), eps[free])
    np.add.at(count, (i[free] + 6, j[free]), 1)
    with np.errstate(invalid="ignore"):
        two = lambda a: a[:-1] + a[1:]
        mean = two(total) / two(count)
    beside = np.fmax(np.roll(mean, 5, axis=0), np.roll(mean, -5, axis=0))
    good = (mean > SHEARED) & (mean > CONTRAST * np.where(np.isnan(beside), 0, beside))
    best = (0.0,)
    for k in np.flatnonzero(good.sum(axis=1) * cell >= 0.5 * least):
        a, b = longest(good[k])
        score = np.minimum(np.where(good[k], mean[k], 0)[a : b + 1], 1).sum()
        if (b - a + 1) * cell >= least and good[k, a : b + 1].mean() > 0.5 and score > best[0]:
            best = (score, n.min() + (k - 6 + 1) * cell / 2, s.min() + a * cell, s.min() + (b + 1) * cell)
    return best


def strip(run, eps, least):
    """The best straight strip of at least a length: (angle, offset, from, to along it); None if there is none."""
    best = max(((*strips(run.start, eps, a, run.cell, least), a) for a in np.radians(np.arange(20, 161, 2))), key=lambda b: b[0])
    return (best[4], *best[1:4]) if best[0] > 0 else None


def describe(run, eps, when, where):
    """A band from its strip: its members are the sheared particles of the strip, one and a half cells to either side."""
    angle, offset, first, last = where
    along = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-along[1], along[0]])
    s, n = run.start @ along, run.start @ across
    with np.errstate(invalid="ignore"):
        members = np.flatnonzero((s >= first) & (s <= last) & (abs(n - offset) < 1.5 * run.cell) & (eps > SHEARED))
    weight, time = eps[members], float(np.median(when[members]))
    now = run.at(time)["position"][members]
    axis = np.linalg.svd((now - np.average(now, axis=0, weights=weight)) * np.sqrt(weight)[:, None], full_matrices=False)[2][0]
    middle = np.average(n[members], weights=weight) * across
    low, high = sorted((middle + first * along, middle + last * along), key=lambda end: end[1])
    return {"time_s": time, "angle_deg": float(np.degrees(np.arctan(abs(axis[1] / axis[0])))), "rises": "upslope" if axis[0] * axis[1] < 0 else "downslope",
            "x_low_m": float(low[0]), "y_low_m": float(low[1]), "x_high_m": float(high[0]), "y_high_m": float(high[1]),
            "eps_d_p": float(np.median(run.end["eps_d_p"][members, 0]))}  # fmt: skip


def searches(time):
    """Times of snapshots at least SEARCH apart, and the last."""
    kept = [time[0]]
    for t in time[1:]:
        if t >= kept[-1] + SEARCH * (1 - 1e-9):
            kept.append(t)
    return kept if kept[-1] == time[-1] else [*kept, time[-1]]


def bands(run):
    """Shear bands in order of time: straight strips of sheared particles in the initial configuration.  Long ones as they form, looked for every SEARCH seconds, then
    what is left at the end; the strongest first, and each particle in one band, with those two and a half cells from it and two cells beyond its ends."""
    x, when, taken, found = run.start, passed(run, SHEARED), run.start[:, 1] < 2.5 * run.cell, []
    times = searches(run.time)
    for k, time in enumerate(times):
        if k < len(times) - 1 and not ((when <= time) & (when > times[max(k - 2, 0)]) & ~taken).any():
            continue
        eps = run.at(time)["eps_d_p"][:, 0]
        least = (LONG if k < len(times) - 1 else SHORT) * run.height
        while (where := strip(run, np.where(taken, np.nan, eps), least)) is not None:
            found.append(describe(run, np.where(taken, np.nan, eps), when, where))
            angle, offset, first, last = where
            s, n = x @ np.array([np.cos(angle), np.sin(angle)]), x @ np.array([-np.sin(angle), np.cos(angle)])
            taken |= (abs(n - offset) < 2.5 * run.cell) & (s > first - 2 * run.cell) & (s < last + 2 * run.cell)
    return sorted(found, key=lambda b: b["time_s"])


# ---------------------------------------------------------------- measures
def slides(run, mass):
    """What `hybrid` carried in a run that `auto` made: when, how long (s), steps, largest E_k (J) and the speed that is of the failed mass (kg), way of each probe (m)."""
    b, found = run.balance, []
    carried = (b["newton"] == 0) & (b["time_s"] > run.loaded)
    if not carried.any() or (b["newton"] > 0).sum() < 2:
        return found
    ends = np.flatnonzero(np.diff(np.concatenate([[0], carried, [0]])))
    for first, last in zip(ends[::2], ends[1::2] - 1):
        t = b["time_s"][[first - 1, last]]
        e = b["kinetic_energy_J"][first : last + 1].max()
        ways = {}
        for column in (c for c in run.probes if c.endswith(".u_x_m")):
            x, y = (np.interp(t, run.probes["time_s"], run.probes[column[:-5] + k]) for k in ("u_x_m", "u_y_m"))
            ways[column[:-6]] = float(np.hypot(x[1] - x[0], y[1] - y[0]))
        found.append({"from_s": float(t[0]), "lasts_s": float(t[1] - t[0]), "steps": int(b["step"][last] - b["step"][first - 1]), "kinetic_energy_J": float(e),
                      "velocity_m_s": float(np.sqrt(2 * e / mass)) if mass > 0 else 0.0, "probes_m": ways})  # fmt: skip
    return found


def speeds(run):
    """Mean speed (m/s) between snapshots of what failed in the end, from places: those follow the nodes, velocities hold what no node sees besides."""
    failed = run.failed(run.end)
    if not failed.any():
        return np.zeros(len(run.time) - 1)
    weight = run.end["mass_solid"][failed, 0]
    ways = [np.hypot(*(b["position"] - a["position"])[failed].T) for (_, a), (_, b) in zip(run.snapshots, run.snapshots[1:])]
    return np.array([np.average(way, weights=weight) for way in ways]) / np.diff(run.time)


def rests(run, speed):
    """Time (s) from which the mean speed between snapshots stays below REST of its largest; None if it does not, or never moves."""
    moves = np.flatnonzero(speed > REST * speed.max(initial=0.0))
    return float(run.time[moves[-1] + 1]) if len(moves) and moves[-1] + 1 < len(speed) else None


def probed(run):
    """{name of each probe at a point: place at the start, way since the loading, pore pressure over that of the start (largest, last), T, S_h and strain}, m, Pa, degC."""
    t, found = run.probes["time_s"], {}
    for name in probe_names(run.probes):
        of = lambda key: run.probes.get(f"{name}.{key}")
        if of("x_m") is None or of("u_x_m") is None:
            continue
        way = [of(f"u_{axis}_m")[-1] - np.interp(run.loaded, t, of(f"u_{axis}_m")) for axis in "xy"]
        found[name] = {"x_m": float(of("x_m")[0]), "y_m": float(of("y_m")[0]), "moved_m": float(np.hypot(*way))}
        if of("p_Pa") is not None:
            found[name] |= {"excess_pressure_most_Pa": float((of("p_Pa") - of("p_Pa")[0]).max()), "excess_pressure_Pa": float(of("p_Pa")[-1] - of("p_Pa")[0])}
        found[name] |= {key: float(of(key)[-1]) for key in ("T_degC", "S_h", "eps_d_p") if of(key) is not None}
    return found


def measure(run):
    """The measures of the slide, with units in their names."""
    total = run.snapshots[0][1]["volume"].sum()
    share = np.array([p["volume"][run.failed(p), 0].sum() for _, p in run.snapshots]) / total
    failed = run.failed(run.end)
    b, (t, e, _, R) = run.balance, kinetic(run.balance)
    quiet = t <= run.loaded
    after = t > run.loaded
    tops = peaks(t[after], smooth(t, e)[after], PROMINENT * e.max())
    late = t > run.loaded + 3 * SMOOTH  # the jump of the temperature is past
    bursts = peaks(t[late], R[late], 0.1 * R[late].max()) if late.any() else []
    x, y = run.start.T
    base = passed(run, SHEARED)[(y < run.spacing[1]) & (x > HEATED) & (x < HEATED + 5 * run.cell)]
    mean = [np.average(np.hypot(*p["v_s"][failed].T), weights=p["mass_solid"][failed, 0]) if failed.any() else 0.0 for _, p in run.snapshots]
    fastest = [np.quantile(np.hypot(*p["v_s"].T), 0.999) for _, p in run.snapshots]
    slab = run.end["volume"][failed, 0]
    lost = b["hydrate_kg"][0] - b["hydrate_kg"][-1] - b["removed_hydrate_kg"][-1]
    scarp = run.start[run.top & failed, 0]
    speed = speeds(run)
    heavy = sum(run.end[k][failed, 0].sum() for k in MASSES)
    return {
        "end_s": float(run.time[-1]),
        "particles_gone": run.gone,
        "onset_s": crossing(run.time, share, STARTED),
        "rise_of_kinetic_energy_s": crossing(t[after], e[after], RISEN * e[quiet].max()) if quiet.any() else None,
        "failed_volume_m2": float(slab.sum()),
        "failed_share": float(share[-1]),
        "mean_displacement_m": float(np.average(run.moved(run.end)[failed], weights=slab)) if failed.any() else 0.0,
        "largest_displacement_m": float(run.moved(run.end).max()),
        "runout_m": float((run.end["position"] + run.end["half_length"])[:, 0].max() - run.toe),
        "retrogression_m": float(run.crest - scarp.min() + run.spacing[0] / 2) if len(scarp) else 0.0,
        "peak_mean_velocity_m_s": float(max(mean)),
        "peak_velocity_m_s": float(max(fastest)),
        "peak_kinetic_energy_J": float(e.max()),
        "peak_kinetic_energy_s": float(t[e.argmax()]),
        "peaks_of_kinetic_energy_s": [float(time) for _, time in tops],
        "peaks_of_R_k_s": [float(time) for _, time in bursts],
        "base_sheared_at_its_upper_end_s": float(np.median(base)) if len(base) and np.isfinite(np.median(base)) else None,
        "kinetic_energy_at_end_J": float(e[-1]),
        "mean_velocity_at_end_m_s": float(speed[-1]) if len(speed) else 0.0,
        "at_rest_s": rests(run, speed),
        "hydrate_lost_kg": float(lost),
        "hydrate_lost_share": float(lost / b["hydrate_kg"][0]),
        "gas_released_kg": float(GAS * lost),
        "gas_released_std_m3": float(GAS * lost / STANDARD),
        "slides": slides(run, heavy),
        "probes": probed(run),
    }  # fmt: skip


def words(m, found):
    """The measures as lines of summary.txt, times in the unit that suits the run's end."""
    unit, size = time_unit(m["end_s"])
    number = lambda s: f"{s / size:.{0 if size == 1 else 1}f}"
    time = lambda s: "(never)" if s is None else f"{s / size:.1f} {unit}"
    yield f"slide, to t = {m['end_s'] / size:.0f} {unit} (scripts/slide.py):"
    yield f"  onset {time(m['onset_s'])}, kinetic energy rises at {time(m['rise_of_kinetic_energy_s'])}, at rest from {time(m['at_rest_s']).replace('(never)', '(not by the end)')} on"
    yield (f"  failed {m['failed_volume_m2']:.0f} m3 per metre ({100 * m['failed_share']:.0f} % of the body), moved by {m['mean_displacement_m']:.1f} m in the mean and "
           f"up to {m['largest_displacement_m']:.1f} m; runout {m['runout_m']:.1f} m, retrogression {m['retrogression_m']:.0f} m behind the crest")  # fmt: skip
    tops = ", ".join(number(t) for t in m["peaks_of_kinetic_energy_s"])
    yield (f"  largest mean velocity of what failed {m['peak_mean_velocity_m_s']:.3g} m/s, of all but one particle in a thousand {m['peak_velocity_m_s']:.2g} m/s{' (at the snapshots)' if m['slides'] else ''}, at the end {m['mean_velocity_at_end_m_s']:.2g} m/s; "
           f"kinetic energy up to {m['peak_kinetic_energy_J']:.3g} J per metre at {time(m['peak_kinetic_energy_s'])}, {f'peaks at {tops} {unit}' if tops else 'no peak'}")  # fmt: skip
    yield (f"  hydrate lost {m['hydrate_lost_kg']:.0f} kg ({100 * m['hydrate_lost_share']:.2f} %), gas released {m['gas_released_kg']:.0f} kg = "
           f"{m['gas_released_std_m3']:.0f} m3 at 101.4 kPa and 15.56 degC, per metre")  # fmt: skip
    if m["particles_gone"]:
        yield f"  {m['particles_gone']} particles left the grid and count in nothing of this but energy and hydrate"
    if m["slides"]:
        yield f"  hybrid carried {len(m['slides'])}: from, for how long, kinetic energy and speed of what failed at most, way of the probes"
    for s in m["slides"]:
        ways = ", ".join(f"{k} {v:.2f} m" for k, v in s["probes_m"].items())
        yield f"    {time(s['from_s'])}  {s['lasts_s']:.3g} s, {s['steps']} steps  {s['kinetic_energy_J']:.3g} J, {s['velocity_m_s']:.2g} m/s  {ways}"
    if m["probes"]:
        yield "  probes: where at the start, moved since the loading, pore pressure over that at the start (at most; at the end), T, S_h and eps_d_p at the end"
    for name, p in m["probes"].items():
        pressure = f"  {p['excess_pressure_most_Pa'] / 1e6:.2f}; {p['excess_pressure_Pa'] / 1e6:.2f} MPa" if "excess_pressure_Pa" in p else ""
        last = "".join(f"  {form.format(p[key])}" for key, form in (("T_degC", "{:.2f} degC"), ("S_h", "{:.3f}"), ("eps_d_p", "{:.2f}")) if key in p)
        yield f"    {name:6s}  ({p['x_m']:.0f}, {p['y_m']:.0f}) m  {p['moved_m']:.2f} m{pressure}{last}"
    yield f"  {len(found)} shear bands" + (": time, angle to the base, from and to (where it was at the start), eps_d_p" if found else "")
    for b in found:
        yield (f"    {b['time_s'] / size:6.1f} {unit}  {b['angle_deg']:3.0f} deg, rises {b['rises']:9s}  ({b['x_low_m']:.0f}, {b['y_low_m']:.0f}) to ({b['x_high_m']:.0f}, {b['y_high_m']:.0f}) m  "
               f"{b['eps_d_p']:.2f}")  # fmt: skip


def write(run, m, found):
    """slide.json, and the end of summary.txt, in place of what stood there of an earlier call."""
    (run.folder / "slide.json").write_text(json.dumps(m | {"bands": found}, indent=1) + "\n")
    summary = run.folder / "summary.txt"
    before = summary.read_text().split("slide, to t = ")[0] if summary.is_file() else ""
    summary.write_text(before + "\n".join(words(m, found)) + "\n")


# ---------------------------------------------------------------- pictures
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
    places = {k: (p["x_m"], p["y_m"]) for k, p in probed(run).items()}
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
        t, e, P, R = kinetic(run.balance)
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
        for k, p in probed(run).items():
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


def draw(name, heated, unheated, out):
    set_style()
    runs = {"θ = 0.5": Run(heated)} | ({"θ = 0": Run(unheated)} if unheated != "-" else {})
    measures, found = [], []
    for label, run in runs.items():
        measures.append(measure(run))
        found.append(bands(run))
        write(run, measures[-1], found[-1])
        print(f"{label}: " + "\n".join(words(measures[-1], found[-1])))
    first = runs["θ = 0.5"]
    maps(name, first, out)
    if name in FIELDS:
        fields(name, runs, out)
    points(name, first, out)
    energy(name, runs, measures, out)
    picture_bands(name, runs, found, out)
    film(name, first, out)


def main(folder):
    run = Run(folder)
    m, found = measure(run), bands(run)
    write(run, m, found)
    print("\n".join(words(m, found)))


if __name__ == "__main__":
    (main if len(sys.argv) == 2 else draw)(*sys.argv[1:])
