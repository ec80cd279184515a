"""What a run of cases/biaxial says: reduced to numbers, curves and maps, from its folder or from docs/biaxial.json and .npz.

The fit of a band.  eps is the plastic strain of a particle.  In columns 0.1 m wide, 0.05 m apart, from x = 0.4 m to 0.85 m (away from
the axis, where two bands cross, and from the free side), of the particles of the upper (lower) half those with more than half of the
column's largest eps count; their centre, weighted with eps, is a point.  The angle is that of the least-squares line through these
points against the horizontal, the scatter their mean square distance from it, the place its height at x = 0.6 m.  The width is the
full width at half of the largest value of the mean profile of eps across that line (slices of 0.025 m).
"""
import json
from pathlib import Path

import numpy as np

from clathra import read_csv, read_snapshots

HEIGHT, WIDTH = 4.0, 1.0  # of the half sample, m
BAND = 0.3  # eps of what is called a band
COLUMNS, COLUMN, SLICE, ACROSS = np.arange(0.4, 0.85, 0.05), 0.1, 0.025, 0.6  # m
POINT_M = (0.5, 2.6)  # m: where the upper band will be
FIELDS = {  # of maps: (value of the particles v, given those at the start)
    "eps": lambda v, start: v["eps_d_p"][:, 0],
    "volume": lambda v, start: v["log_J"][:, 0],
    "porosity": lambda v, start: v["porosity"][:, 0],
    "p": lambda v, start: v["p"][:, 0] / 1e6,
    "Sh": lambda v, start: v["S_h"][:, 0],
    "T": lambda v, start: v["T"][:, 0] if "T" in v else np.full(len(v["p"]), np.nan),
    "lost": lambda v, start: 1 - v["mass_hydrate"][:, 0] / start["mass_hydrate"][:, 0],
}


def line_of_band(v, upper):
    """(slope, height at x = 0) of the fitted line, and the scatter about it (m); None before there is a band."""
    x, y = v["position"].T
    eps = v["eps_d_p"][:, 0]
    half = y > y.mean() if upper else y < y.mean()
    points = []
    for left in COLUMNS * WIDTH:
        k = half & (x >= left) & (x < left + COLUMN)
        weight = eps[k] * (eps[k] > 0.5 * eps[k].max()) if np.any(k) else np.zeros(1)
        if not weight.sum() > 0:
            return None
        points.append((np.average(x[k], weights=weight), np.average(y[k], weights=weight)))
    points = np.array(points)
    slope, height = np.polyfit(*points.T, 1)
    return slope, height, float(np.sqrt(np.mean((points[:, 1] - slope * points[:, 0] - height) ** 2) / (1 + slope**2)))


def width_of_band(v, slope, height):
    """Full width at half the largest mean value across the line (m), and that value."""
    x, y = v["position"].T
    off = (y - slope * x - height) / np.hypot(1, slope)
    near = (x > COLUMNS[0]) & (x < COLUMNS[-1] + COLUMN) & (abs(off) < ACROSS)
    slices = np.floor((off[near] + ACROSS) / SLICE).astype(int)
    weight = np.bincount(slices, v["volume"][near, 0])
    mean = np.bincount(slices, v["volume"][near, 0] * v["eps_d_p"][near, 0]) / np.where(weight > 0, weight, np.nan)
    at = np.flatnonzero(np.isfinite(mean))
    mean = np.interp(np.arange(len(mean)), at, mean[at])
    top = int(mean.argmax())
    ends = []
    for way in (-1, 1):
        k = top
        while 0 < k < len(mean) - 1 and mean[k] > 0.5 * mean[top]:
            k += way
        if k == top:  # the largest value is in the last slice looked at
            ends.append(float(top))
            continue
        drop = mean[k - way] - mean[k]
        ends.append(k - way + way * (mean[k - way] - 0.5 * mean[top]) / drop if drop > 0 else k)
    return float((ends[1] - ends[0]) * SLICE), float(mean[top])


def bands(v):
    """Angles (deg), scatter (m), place (m), width (m) and strain of the upper and the lower band; {} before there are two."""
    found = {}
    for name, upper in (("upper", True), ("lower", False)):
        line = line_of_band(v, upper)
        if line is None:
            return {}
        width, top = width_of_band(v, *line[:2])
        found[name] = dict(angle=float(np.degrees(np.arctan(abs(line[0])))), slope=float(line[0]), scatter=line[2], place=float(line[0] * 0.6 + line[1]), width=width, eps=top)
    return found


def state(v, start):
    """One snapshot in numbers: change of volume, bands, means over them."""
    eps = v["eps_d_p"][:, 0]
    band = eps > BAND
    lost = lambda k: float(1 - v["mass_hydrate"][k].sum() / start["mass_hydrate"][k].sum())
    mean = lambda key: float(np.average(v[key][band, 0], weights=v["volume"][band, 0]))
    out = dict(volume=float(v["volume"].sum() / start["volume"].sum() - 1), eps_max=float(eps.max()), p_least=float(v["p"].min() / 1e6),
               Sh_least=float(v["S_h"].min()), lost_all=lost(slice(None)), bands=bands(v))  # fmt: skip
    if band.sum() > 4:
        out["band"] = dict(p=mean("p") / 1e6, Sh=mean("S_h"), lost=lost(band), T=mean("T") if "T" in v else None)
        if "T" in v:
            out["T_outside"] = float(np.average(v["T"][~band, 0], weights=v["volume"][~band, 0]))
    return out


def reduce_run(folder):
    """(numbers for JSON, maps {strain in %: {field: array}}) of the folder of a run; of several, with commas between them, if it was
    restarted into new ones."""
    folders = [Path(f) for f in str(folder).split(",")]
    meters, probes, balance = (join([read_csv(f / f"{name}.csv") for f in folders]) for name in ("meters", "probes", "balance"))
    snapshots = [s for f in folders for s in read_snapshots(f)]
    strain_at = lambda t: -np.interp(t, meters["time_s"], meters["top.position_m"]) / HEIGHT * 100
    start = snapshots[0][1]
    point = int(np.argmin(np.sum((start["position"] - POINT_M) ** 2, axis=1)))
    cost = folders[-1] / "cost.json"
    dt = balance["dt_s"][balance["time_s"] > 0.2]  # past the kink of the loading
    data = dict(
        cost=json.loads(cost.read_text()) if cost.is_file() else {},
        particles=len(start["position"]), steps=int(balance["step"][-1]), newton=int(balance["newton"].sum()),
        dt_least=float(dt.min()), dt_median=float(np.median(dt)),
        conserved=float(max(abs(balance["water_error"]).max(), abs(balance["methane_error"]).max())),
        strain=rounded(strain_at(meters["time_s"])), stress=rounded(meters["top.stress_Pa"] / 1e6),
        probe_strain=rounded(strain_at(probes["time_s"])),
        M={k: rounded(probes[f"band.{c}"] * f) for k, (c, f) in dict(q=("q_Pa", 1e-6), p=("p_Pa", 1e-6), Sh=("S_h", 1), T=("T_degC", 1)).items()
           if f"band.{c}" in probes},
        snapshot_strain=rounded([strain_at(t) for t, _ in snapshots]),
        M_volume=rounded([v["log_J"][point, 0] for _, v in snapshots]),
        M_lost=rounded([1 - v["mass_hydrate"][point, 0] / start["mass_hydrate"][point, 0] for _, v in snapshots]),
        states=[state(v, start) for _, v in snapshots],
    )  # fmt: skip
    if "energy_remainder_J" in balance:
        data["energy"] = {k: float(v[-1]) for k, v in balance.items() if k.endswith("_J")}
    maps = {}
    for t, v in snapshots:
        (x, y), (a, b), F = v["position"].T, start["half_length"].T, v["deformation_gradient"].T
        place = dict(x=x, y=y, ax=F[0] * a, ay=F[2] * a, bx=F[1] * b, by=F[3] * b)
        maps[round(float(strain_at(t)), 2)] = place | {k: f(v, start) for k, f in FIELDS.items()}
    return data, maps


def join(parts):
    """One table of several with the same columns, or with what they share."""
    return {k: np.concatenate([part[k] for part in parts]) for k in parts[0] if all(k in part for part in parts)}


def rounded(values):
    return [float(f"{v:.6g}") for v in np.asarray(values, dtype=float)]


def peak(run):
    """(stress MPa, strain %) at the peak."""
    k = int(np.argmax(run["stress"]))
    return run["stress"][k], run["strain"][k]


def stress_at(run, strain):
    return float(np.interp(strain, run["strain"], run["stress"]))


def at_strain(run, strain):
    """The state of the snapshot nearest to an axial strain (%)."""
    return run["states"][int(np.argmin(np.abs(np.array(run["snapshot_strain"]) - strain)))]


def angles(state):
    """Both angles of a state, degrees."""
    return [state["bands"][k]["angle"] for k in ("upper", "lower")]
