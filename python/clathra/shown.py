"""What pictures of a run show, whatever draws them: quantities of particles and histories, their labels and units."""
import functools
import re
from typing import Callable, NamedTuple

import numpy as np

from .tables import Damaged

MPA, MM = 1e-6, 1e3  # from Pa, from m


class Quantity(NamedTuple):
    """One number a particle: `of(particles)` is (n,), in `unit`; particles as Run.particles gives them."""

    key: str
    label: str
    unit: str
    needs: str  # variable of the snapshot
    of: Callable

    @property
    def axis(self):
        """Words beside an axis of a plot."""
        return f"{tex(self.label)} ({self.unit})"


def tex(label):
    """Subscripts as matplotlib sets them: u_x to $u_x$."""
    return re.sub(r"\b(\w)_(\w)\b", r"$\1_\2$", label)


def _part(name, component, factor=1.0):
    return lambda p: p[name][:, component] * factor


def _scalar(name, factor=1.0):
    return lambda p: p[name] * factor


def _speed(name):
    return lambda p: np.hypot(*p[name].T)


def _mises(p):
    s = p["stress"][:, :3] - p["stress"][:, :3].mean(axis=1, keepdims=True)
    return MPA * np.sqrt(1.5 * (s**2).sum(axis=1) + 3.0 * (p["stress"][:, 3:] ** 2).sum(axis=1))


def _relative(fluid):
    """Speed of a fluid against the skeleton."""
    return lambda p: np.hypot(*(p[fluid] - p.get("v_s", 0.0)).T)


QUANTITIES = [
    Quantity("p", "pore pressure p", "MPa", "p", _scalar("p", MPA)),
    Quantity("T", "temperature T", "°C", "T", _scalar("T")),
    Quantity("S_h", "hydrate saturation S_h", "–", "S_h", _scalar("S_h")),
    Quantity("S_w", "water saturation S_w", "–", "S_w", _scalar("S_w")),
    Quantity("S_g", "gas saturation S_g", "–", "S_g", _scalar("S_g")),
    Quantity("porosity", "porosity", "–", "porosity", _scalar("porosity")),
    Quantity("u_x", "displacement u_x", "mm", "displacement", _part("displacement", 0, MM)),
    Quantity("u_y", "displacement u_y", "mm", "displacement", _part("displacement", 1, MM)),
    Quantity("s_xx", "effective stress xx (tension +), nodal means", "MPa", "stress", _part("stress", 0, MPA)),
    Quantity("s_yy", "effective stress yy (tension +), nodal means", "MPa", "stress", _part("stress", 1, MPA)),
    Quantity("s_xy", "effective stress xy, nodal means", "MPa", "stress", _part("stress", 3, MPA)),
    Quantity("q", "deviatoric stress q of nodal means", "MPa", "stress", _mises),
    Quantity("eps_v", "volumetric strain ln J", "–", "log_J", _scalar("log_J")),
    Quantity("eps_d_p", "plastic strain", "–", "eps_d_p", _scalar("eps_d_p")),
    Quantity("p_w", "water pressure p_w", "MPa", "p_w", _scalar("p_w", MPA)),
    Quantity("p_g", "gas pressure p_g", "MPa", "p_g", _scalar("p_g", MPA)),
    Quantity("v_w", "speed of the water in the pores", "m/s", "v_w", _relative("v_w")),
    Quantity("v_g", "speed of the gas in the pores", "m/s", "v_g", _relative("v_g")),
    Quantity("v_s", "speed of the skeleton", "m/s", "v_s", _speed("v_s")),
]

# Histories at probes: label, unit, [(column, factor, name in the legend)], least width of the axis.
HISTORIES = [
    ("pore pressure", "MPa", [("p_Pa", MPA, "mean"), ("p_w_Pa", MPA, "water"), ("p_g_Pa", MPA, "gas")], 0.01),
    ("change of pore pressure", "kPa", [("p_rise_Pa", 1e-3, "")], 0.01),
    ("temperature T", "°C", [("T_degC", 1, "")], 0.1),
    ("hydrate saturation S_h", "–", [("S_h", 1, "")], 0.01),
    ("saturation", "–", [("S_w", 1, "water"), ("S_g", 1, "gas")], 0.01),
    ("displacement", "mm", [("u_x_m", MM, "x"), ("u_y_m", MM, "y"), ("u_z_m", MM, "z")], 0.01),
    ("effective stress, tension +", "MPa", [("sxx_Pa", MPA, "xx"), ("syy_Pa", MPA, "yy"), ("sxy_Pa", MPA, "xy")], 0.01),
]


def nodal_means(lines, particles, values):
    """(n, components) `values` of particles as the nodes of the grid see them, by volume and for each region by itself, linear between
    the nodes.  lines: places (m) of the grid's lines along each axis."""
    weights, nodes, stride = [1.0], [0], 1
    for line, x in zip(lines, particles["position"].T):
        cell = np.clip(np.searchsorted(line, x, side="right") - 1, 0, len(line) - 2)
        share = np.clip((x - line[cell]) / (line[cell + 1] - line[cell]), 0.0, 1.0)
        weights = [w * s for w in weights for s in (1.0 - share, share)]
        nodes = [n + (cell + k) * stride for n in nodes for k in (0, 1)]
        stride *= len(line)
    found = np.empty_like(values, dtype=float)
    for region in np.unique(particles["region"]):
        at = particles["region"] == region
        mass, total = np.zeros(stride), np.zeros((stride, values.shape[1]))
        for w, n in zip(weights, nodes):
            np.add.at(mass, n[at], (w * particles["volume"])[at])
            np.add.at(total, n[at], ((w * particles["volume"])[:, None] * values)[at])
        mean = total / np.maximum(mass, 1e-300)[:, None]
        found[at] = sum(w[at, None] * mean[n[at]] for w, n in zip(weights, nodes))
    return found


def axes(run):
    """The axes of a picture, to the right and up, then in space the one that it cuts across: x and y, but x and z where weight goes along z."""
    weight = np.abs(run.case["gravity"]) if run.in_space else [0.0]
    return ((0, 2, 1) if np.argmax(weight) == 2 else (0, 1, 2)) if run.in_space else (0, 1)


def names(run):
    """Their names, "xy" or "xz"."""
    return "".join("xyz"[a] for a in axes(run)[:2])


@functools.lru_cache(maxsize=4)
def cut(run):
    """(place along the axis that it cuts across (m), mask of the particles that it goes through at the start) of the plane in which a run in
    space is shown: that of its first probe, else the middle of the body; None in the plane."""
    if not run.in_space:
        return None
    first, across = run.particles(run.times[0]), axes(run)[2]
    z, l = first["position"][:, across], first["half_length"][:, across]
    at = next((p[across] for n in run.names("probes") if isinstance((p := run.case.get(f"probe_{n}_at", [None]))[0], float)), None)
    at = 0.5 * ((z - l).min() + (z + l).max()) if at is None else float(np.clip(at, (z - l).min(), (z + l).max()))
    inside = at + 1e-6 * l.min() * (1 if at < (z + l).max() - 1e-9 * l.min() else -1)  # on a border between particles: those behind it
    return at, np.abs(z - inside) < l


def plane(run, time):
    """Particles at a time as pictures show them: those of the plane, in space those of cut() with what lies in that plane of vectors and
    of the deformation gradient; stresses keep their six components, in the order of these axes."""
    return _in_plane(run, run.particles(time))


def _in_plane(run, particles):
    if cut(run) is None:
        return particles
    held, found, (a, b, c) = cut(run)[1], {}, axes(run)
    voigt = np.array([[0, 3, 5], [3, 1, 4], [5, 4, 2]])
    for name, v in particles.items():
        v = v[held]
        if name == "deformation_gradient":
            v = v[:, [3 * i + j for i in (a, b) for j in (a, b)]]
        elif v.ndim == 2 and v.shape[1] == 6:
            v = v[:, [voigt[pair] for pair in ((a, a), (b, b), (c, c), (a, b), (b, c), (a, c))]]
        elif v.ndim == 2 and v.shape[1] == 3:
            v = v[:, [a, b]]
        found[name] = v
    return found


def drawn(run, time):
    """The same with the nodal means of stresses.  Particles of a cell share its strain; where hydrate gives them unlike stiffness their own
    stresses alternate, while the forces on the nodes, which are in balance, do not."""
    particles = run.particles(time)
    if "stress" in particles:
        particles["stress"] = nodal_means(run.lines, particles, particles["stress"])
    return _in_plane(run, particles)


def where(run):
    """Words that say which plane is shown, for a title; none in the plane."""
    return "" if cut(run) is None else f", cut at {'xyz'[axes(run)[2]]} = {cut(run)[0]:.4g} m"


def _on(q, names):
    """The quantity with its label on these axes."""
    return q._replace(label=re.sub(r"\b[xy]{2}\b|(?<=_)[xy]\b", lambda m: "".join(names["xy".index(k)] for k in m[0]), q.label))


def shown(snapshots, names="xy"):
    """The quantities that the scene has and that are not the same everywhere and always, in order; names: of the axes."""
    found, first = [], snapshots[0]
    for q in QUANTITIES:
        if q.needs not in first or (q.key == "p_w" and "p_g" not in first):
            continue
        values = np.concatenate([q.of(p) for p in snapshots])
        values = values[np.isfinite(values)]
        if values.size and np.ptp(values) > 1e-9 * np.abs(values).max():
            found.append(_on(q, names))
    return found


NO_GAS = 1e-6  # of the pores: without more p_g says nothing
SMALL = 0.02  # of the pressure: changes below are drawn by themselves, too


def has(probes, name, column):
    return f"{name}.{'p_Pa' if column == 'p_rise_Pa' else column}" in probes


def curve(probes, name, column):
    """Values of a probe: of a column of probes.csv, of p_g only where there is gas, or p_rise_Pa, how far p is from its first value."""
    if column == "p_rise_Pa":
        p = probes[f"{name}.p_Pa"]
        return p - p[0]
    values = probes[f"{name}.{column}"]
    gas = probes.get(f"{name}.S_g") if column == "p_g_Pa" else None
    return values if gas is None else np.where(gas > NO_GAS, values, np.nan)


def _small(probes, names):
    """Does pore pressure change, but by little of itself?"""
    most = lambda column: max(np.nan_to_num(np.abs(curve(probes, n, column))).max() for n in names)
    return 0 < most("p_rise_Pa") < SMALL * most("p_Pa")


def histories(probes, names):
    """The panels of HISTORIES that the probes `names` have (curve), without saturations that never change, hydrate that is not there, and
    changes of pressure that the pressures themselves show."""
    found = []
    for label, unit, columns, least in HISTORIES if len(probes.get("time_s", ())) else ():
        held = [c for c in columns if names and has(probes, names[0], c[0])]
        if held and held[0][0] == "p_rise_Pa" and not _small(probes, names):
            continue
        curves = [curve(probes, n, c[0]) for n in names for c in held]
        idle = {"S_h": lambda v: not np.nan_to_num(v).any(), "S_w": lambda v: not np.ptp(np.nan_to_num(v))}.get(held[0][0] if held else "")
        if held and not (idle and all(map(idle, curves))):
            found.append((label, unit, held, least))
    return found


# What meters and plates count: label of a column.
METERS = {"gas_std_m3": "gas out (standard m³)", "gas_kg_s": "gas out, rate (kg/s)", "water_kg": "water out (kg)", "water_kg_s": "water out, rate (kg/s)",
          "heat_J": "heat out (J)", "heat_W": "heat out, rate (W)", "position_m": "plate, position (m)", "force_N": "plate, force (N)",
          "stress_Pa": "plate, mean stress (Pa)", "shear_N": "plate, shear force (N)"}  # fmt: skip

LEAST_FLOW = 1e-3  # of the largest: less water than this has no ratio


def gas_to_water(meters, name):
    """Standard m3 of gas per m3 of water (of 1000 kg) that a meter counts, as both flow out; NaN elsewhere, None if it counts but one."""
    columns = [meters.get(f"{name}.{c}") for c in ("gas_kg_s", "water_kg_s", "gas_std_m3", "gas_kg")]
    if any(c is None or not c.any() for c in columns):
        return None
    gas, water, standard, kg = columns
    outwards = (gas >= 0) & (water > LEAST_FLOW * np.max(np.abs(water)))
    most = np.argmax(np.abs(kg))
    return np.where(outwards, gas * standard[most] / kg[most] / np.where(outwards, water / 1000, 1.0), np.nan)


def production(meters, names):
    """[(label, [(meter, values)])] of what the meters `names` count that is not zero always, of the ratio of gas to water, and of the methane in
    the body's pores, free and dissolved."""
    found = []
    for column, label in METERS.items():
        curves = [(n, meters[f"{n}.{column}"]) for n in names if f"{n}.{column}" in meters]
        found += [(label, curves)] if any(v.any() for _, v in curves) else []
    ratios = [(n, v) for n in names if (v := gas_to_water(meters, n)) is not None and np.isfinite(v).sum() > 1]
    found += [("gas to water (std m³/m³)", ratios)] if ratios else []
    pores = [(name, meters[f"{name}_gas_std_m3"]) for name in ("free", "dissolved") if np.ptp(meters.get(f"{name}_gas_std_m3", np.zeros(1))) > 0]
    return [*found, ("methane in the body's pores (standard m³)", pores)] if pores else found


def half_edges(particles, first):
    """(n, 2, 2) half edges (m) of the particles' domains, one a row: those of the start (`first`, of the same particles) carried by the
    deformation gradient, so that they are the true outline.  What is stretched beyond three times is drawn as a box of its volume."""
    l = particles["half_length"]
    box = np.stack([np.stack([l[:, 0], 0 * l[:, 0]], -1), np.stack([0 * l[:, 1], l[:, 1]], -1)], 1)
    if "deformation_gradient" not in particles or len(first["half_length"]) != len(l):
        return box
    F, F0 = (p["deformation_gradient"].reshape(-1, 2, 2) for p in (particles, first))
    l0 = first["half_length"] / np.linalg.norm(F0, axis=1)
    edges = np.swapaxes(F * l0[:, None, :], 1, 2)
    square = np.sqrt(np.abs(np.linalg.det(F)))[:, None, None] * np.stack([np.diag(x) for x in l0])
    long = np.linalg.norm(F, axis=1).max(axis=1) > 3.0
    return np.where(long[:, None, None], square, edges)


def corners(particles, first):
    """(n, 4, 2) corners (m) of the particles' domains in the plane, in order around each."""
    a, b = np.swapaxes(half_edges(particles, first), 0, 1)
    return np.stack([particles["position"] + s * a + t * b for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)


def apart(position, gap):
    """Indices of particles any two of which differ by `gap` (m) or more along an axis, in their order, as many as that leaves room for:
    every how many-th row and column of a lattice."""
    left, taken = np.arange(len(position)), []
    while len(left):
        taken.append(left[0])
        left = left[1:][np.abs(position[left[1:]] - position[left[0]]).max(1) >= gap]
    return np.array(taken, int)


def least_way(position):
    """The least distance (m) between two of a few places."""
    ways = np.hypot(*(position[:, None] - position[None]).T)
    np.fill_diagonal(ways, np.inf)
    return ways.min()


def strip_axis(position):
    """Axis (0 or 1) along which the body is a strip, at least eight times as long as wide and with no more than four rows of
    particles across; None if it is not one."""
    extent = np.ptp(position, axis=0)
    axis = int(np.argmax(extent))
    rows = np.unique(np.round(position[:, 1 - axis] / extent[axis], 6))
    return axis if extent[1 - axis] < extent[axis] / 8 and len(rows) <= 4 else None


def unless_damaged(damaged, else_, part, *arguments):
    """What a part of a picture or page returns; else_, and a sentence more in `damaged`, where a file that it needs is damaged."""
    try:
        return part(*arguments)
    except Damaged as error:
        damaged.append(str(error))
        return else_


def stage_axis(balance):
    """(map of times (s) to an axis on which each stage is one wide, ends of the stages (s)); None without stages."""
    if not len(balance.get("time_s", ())):
        return None
    stage = balance.get("stage", np.zeros(len(balance["time_s"])))
    ends = [balance["time_s"][stage == k][-1] for k in np.unique(stage)]
    if len(ends) < 2 or np.any(np.diff(ends) <= 0):
        return None
    return (lambda t: np.interp(t, [0.0, *ends], range(len(ends) + 1))), ends


def spread(count, most):
    """Indices of at most `most` of `count` things, first and last among them."""
    return sorted(set(np.linspace(0, count - 1, min(count, most)).round().astype(int).tolist()))


def period(case):
    """The longest period (s) of the sines that act in a case (Run.case), below a third of it; None without."""
    found = [wave for key, value in case.items() if isinstance(value, dict) for wave in value.get("sine", [])[2::3]]
    return max((p for p in found if p < case.get("time_end", np.inf) / 3), default=None)


def spread_phases(times, most, period):
    """Like spread, but of the times (s) about each evenly spaced one that is taken whose phase in the period (s) is farthest from
    those taken before: evenly spaced times may all be of one phase.  Also the largest distance of phases among them, 0 to 0.5."""
    even, phase = spread(len(times), most), np.asarray(times, float) / period % 1.0
    apart = lambda a, b: np.abs((a - b + 0.5) % 1.0 - 0.5)
    taken = [even[0], even[-1]] if len(even) > 1 else list(even)
    for k in range(1, len(even) - 1):
        from_, to = (even[k - 1] + even[k]) // 2 + 1, (even[k] + even[k + 1]) // 2
        among = [j for j in range(from_, max(to, from_) + 1) if j not in taken] or [even[k]]
        least = [min(apart(phase[j], phase[i]) for i in taken) for j in among]
        taken.append(among[int(np.argmax(np.round(least, 9)))])
    taken = sorted(set(taken))
    return taken, max(float(apart(phase[a], phase[b])) for a in taken for b in taken)
