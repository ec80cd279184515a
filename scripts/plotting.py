"""What the plot scripts share: style, names and units of the plotted quantities."""
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

# Okabe and Ito's colours, told apart by colour-blind readers too; line styles differ as well.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
STYLES = ["-", "--", "-.", ":"]
PA, MM = 1e-6, 1e3  # to MPa, to mm


def set_style():
    plt.rcParams.update({
        "figure.dpi": 110, "savefig.dpi": 160, "savefig.bbox": "tight", "figure.constrained_layout.use": True,
        "font.size": 10, "axes.titlesize": 10.5, "axes.titlelocation": "left", "axes.grid": True, "grid.alpha": 0.3,
        "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.6, "legend.frameon": False,
        "legend.fontsize": 9, "axes.prop_cycle": plt.cycler(color=COLOURS), "axes.formatter.useoffset": False,
        "axes.formatter.limits": (-3, 4),
    })  # fmt: skip


def derived(particles):
    """Plotted quantities of one snapshot, in the units of QUANTITIES, that its scene has: {name: (n,) array}."""
    found = {"p": ("p", 0, PA), "T": ("T", 0, 1), "S_h": ("S_h", 0, 1), "S_w": ("S_w", 0, 1),
             "u_x": ("displacement", 0, MM), "u_y": ("displacement", 1, MM)}  # fmt: skip
    return {name: particles[v][:, k] * factor for name, (v, k, factor) in found.items() if v in particles}


QUANTITIES = {  # name: label
    "p": "pore pressure p (MPa)",
    "T": "temperature T (°C)",
    "S_h": "hydrate saturation $S_h$ (–)",
    "S_w": "water saturation $S_w$ (–)",
    "u_x": "displacement $u_x$ (mm)",
    "u_y": "displacement $u_y$ (mm)",
}


def is_column(position):
    """Axis (0 or 1) along which the body is a strip, at least eight times as long as wide and with no more than four rows of
    particles across; None if it is not one."""
    extent = np.ptp(position, axis=0)
    axis = int(np.argmax(extent))
    rows = np.unique(np.round(position[:, 1 - axis] / extent[axis], 6))
    return axis if extent[1 - axis] < extent[axis] / 8 and len(rows) <= 4 else None


def steady_limits(axes, *values, least=1e-9):
    """Keeps a nearly constant curve from being blown up: y range at least `least` wide."""
    values = np.concatenate([np.ravel(v) for v in values])
    values = values[np.isfinite(values)]
    if values.size and np.ptp(values) < least:
        axes.set_ylim(values.mean() - least, values.mean() + least)


def boxes(axes, particles, values, low=None, high=None):
    """Particles as the boxes that they fill, where they are, coloured by values (n,) from low to high; returns the collection."""
    x, l = particles["position"], particles["half_length"]
    corners = np.stack([x + l * s for s in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    found = PolyCollection(corners, array=values, cmap="viridis", lw=0.15, edgecolor="face")
    found.set_clim(low, high)
    axes.add_collection(found)
    axes.autoscale_view()
    axes.grid(False)
    return found


def stage_axis(balance):
    """(map of times (s) to an axis on which each stage is one wide, ends of the stages (s)); None without stages."""
    stage = balance.get("stage", np.zeros(len(balance["time_s"])))
    ends = [balance["time_s"][stage == k][-1] for k in np.unique(stage)]
    if len(ends) < 2 or np.any(np.diff(ends) <= 0):
        return None
    return (lambda t: np.interp(t, [0.0, *ends], range(len(ends) + 1))), ends


def save(figure, folder, name):
    """Writes folder/name.png and says so."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"{name}.png")
    plt.close(figure)
    print(f"  {folder / name}.png")
