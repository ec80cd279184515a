"""What the plot scripts share: style, colours, saving; what is plotted stands in clathra/shown.py."""
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection

from clathra.shown import MM, MPA, corners

# Okabe and Ito's colours, told apart by colour-blind readers too; line styles differ as well.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
STYLES = ["-", "--", "-.", ":"]
PA = MPA


def set_style():
    plt.rcParams.update({
        "figure.dpi": 110, "savefig.dpi": 160, "savefig.bbox": "tight", "figure.constrained_layout.use": True,
        "font.size": 10, "axes.titlesize": 10.5, "axes.titlelocation": "left", "axes.grid": True, "grid.alpha": 0.3,
        "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.6, "legend.frameon": False,
        "legend.fontsize": 9, "axes.prop_cycle": plt.cycler(color=COLOURS), "axes.formatter.useoffset": False,
        "axes.formatter.limits": (-3, 4),
    })  # fmt: skip


def steady_limits(axes, *values, least=1e-9):
    """Keeps a nearly constant curve from being blown up: y range at least `least` wide."""
    values = np.concatenate([np.ravel(v) for v in values])
    values = values[np.isfinite(values)]
    if values.size and np.ptp(values) < least:
        axes.set_ylim(values.mean() - least, values.mean() + least)


def boxes(axes, particles, values, low=None, high=None, first=None):
    """Particles as what they fill, deformed since `first` (the same particles at the start), coloured by values (n,) from low to
    high; returns the collection."""
    found = PolyCollection(corners(particles, first or particles), array=values, cmap="viridis", lw=0.15, edgecolor="face")
    found.set_clim(low, high)
    axes.add_collection(found)
    axes.autoscale_view()
    axes.grid(False)
    return found


def save(figure, folder, name):
    """Writes folder/name.png and says so."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"{name}.png")
    plt.close(figure)
    print(f"  {folder / name}.png")
