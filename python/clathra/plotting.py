"""What pictures share: style, colours, saving; what they show stands in shown.py.  Needs matplotlib."""
import re
import textwrap
from pathlib import Path

import numpy as np

from .shown import MM, MPA, corners, tex  # noqa: F401  MM: scripts take it from here
from .tables import missing

try:
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.collections import PolyCollection
    from matplotlib.ticker import Formatter
except ImportError as error:
    raise missing(error, "drawing pictures") from None

# Okabe and Ito's colours, told apart by colour-blind readers too; line styles differ as well.
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000"]
STYLES = ["-", "--", "-.", ":"]
PA = MPA


def colours(count):
    """As many that can be told apart: of more things than COLOURS a row through the rainbow."""
    return COLOURS[:count] if count <= len(COLOURS) else [plt.get_cmap("turbo")(k / (count - 1)) for k in range(count)]


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


class Plain(Formatter):
    """Values at ticks with as many digits as their distance has, and no factor beside the axis, which labels would meet."""

    def __call__(self, value, pos=None):
        return self.format_ticks([value])[0]

    def format_ticks(self, values):
        values = np.asarray(values, dtype=float)
        most, step = np.abs(values).max(initial=0.0), np.diff(np.sort(values)).min(initial=np.inf)
        step = step if 0 < step < np.inf else most or 1.0
        kind = "f" if not most or 1e-3 <= most < 1e5 else "e"
        digits = next((n for n in range(15) if all(abs(float(f"{v:.{n}{kind}}") - v) < 0.05 * step for v in values)), 15)
        texts = [f"{v:.{digits}{kind}}" if abs(v) > 1e-9 * step else "0" for v in values]
        return [re.sub(r"e([+-])0*", lambda e: f"e{e[1].strip('+')}", t).replace("-", "\N{MINUS SIGN}") for t in texts]


def wrapped(label, inches):
    """A label on lines of that length, in letters of the size that labels have; its unit stays with the word before."""
    word, bracket, unit = label.replace("$", "").rpartition(" (")
    text = word + bracket.replace(" ", "\N{NO-BREAK SPACE}") + unit
    return tex(textwrap.fill(text, max(10, int(inches / 0.085)), break_long_words=False, break_on_hyphens=False))


def boxes(axes, particles, values, low=None, high=None, first=None):
    """Particles as what they fill, deformed since `first` (the same particles at the start), coloured by values (n,) from low to
    high; returns the collection."""
    found = PolyCollection(corners(particles, first or particles), array=values, cmap="viridis", lw=0.6, edgecolor="face")  # wide enough to leave no seams
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
