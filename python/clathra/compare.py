"""Runs beside each other: clathra compare RUN RUN ... [-o FOLDER]

Prints what the runs took and where they ended, the keys of the case in which they differ, and the largest difference of every
probe's and meter's column and of every variable of the snapshots from the first run's, at its times; writes FOLDER/compare.png (default: among the first run's figures)
with the histories of all runs.  Differences below 1e-9 of the largest value of a field, any component at any probe, are round-off.
"""
import argparse
import re
import sys
from pathlib import Path

import numpy as np

from . import shown
from .plotting import COLOURS, STYLES, plt, save, set_style, steady_limits
from .run import Run
from .tables import Damaged, probe_names
from .units import time_unit

ERRORS = re.compile(r"water (\S+), methane (\S+) of the initial mass, heat (\S+)")
SHOWN = 40  # differing keys
ROUND_OFF = 1e-12  # of what is drawn, in its unit
SAME = 1e-9  # of a field's largest value: equal
COMPONENT = re.compile(r"(xx|yy|zz|xy|xz|yz|x|y|z)(?=_|$)")
IDLE = ("title", "output_dir")  # keys that change no result


def table(rows):
    """Lines of columns; all but the first column to the right."""
    widths = [max(len(r[k]) for r in rows) for k in range(len(rows[0]))]
    return [("  ".join([r[0].ljust(widths[0]), *(c.rjust(w) for c, w in zip(r[1:], widths[1:]))])).rstrip() for r in rows]


def labels(runs):
    """What tells the runs apart: their folders without what all share."""
    parts = [run.folder.resolve().parts for run in runs]
    while len(parts) > 1 and len({p[0] for p in parts}) == 1 and min(map(len, parts)) > 1:
        parts = [p[1:] for p in parts]
    return ["/".join(p) for p in parts] if len(parts) > 1 else [runs[0].folder.resolve().name]


def work(runs, names):
    """What each run took, and its balance errors."""
    rows = [["run", "ended at (s)", "integrator", "steps", "refused", "Newton", "seconds", "water", "methane", "heat"]]
    for run, name in zip(runs, names):
        took, missing = run.work, ERRORS.search(run.summary)
        ended = run.balance.get("time_s", ())
        t = f"{ended[-1]:.6g}" if len(ended) else "0"
        rows.append([name, t if run.finished else f"{t}, not its end", *(took.values() if took else ["–"] * 5), *(missing.groups() if missing else ["–"] * 3)])
    return table(rows)


def differing(runs, names):
    """Keys of the case whose values differ."""
    texts = [run.texts for run in runs]
    keys = [k for k in dict.fromkeys(k for t in texts for k in t) if k not in IDLE and len({t.get(k) for t in texts}) > 1]
    if not keys:
        return ["the cases are the same"]
    lines = table([["key", *names], *([k, *(t.get(k, "–") for t in texts)] for k in keys[:SHOWN])])
    return lines + ([f"... and {len(keys) - SHOWN} more keys"] if len(keys) > SHOWN else [])


def scales(columns):
    """{column: largest value of its field, all components at all probes or meters}."""
    field, most = {c: COMPONENT.sub("*", c.rsplit(".", 1)[-1], count=1) for c in columns}, {}
    for c, (_, v) in columns.items():
        most[field[c]] = max(most.get(field[c], 0.0), np.abs(v[np.isfinite(v)]).max(initial=0.0))
    return {c: most[field[c]] for c in columns}


def at(t, times, values):
    """Values at the times t, linear between those that there are; where there is a row at t, that of the row, a number or not."""
    row = np.searchsorted(times, t, side="right") - 1
    return np.where(times[row] == t, values[row], np.interp(t, times, values))


def apart(x, y):
    """|x - y|; 0 where both are the same, numbers or not, and infinite where one of them alone is a number."""
    with np.errstate(invalid="ignore"):
        d = np.abs(y - x)
    same = (x == y) | (np.isnan(x) & np.isnan(y))
    return np.where(same, 0.0, np.where(np.isnan(d), np.inf, d))


def common_end(first, other):
    """The time (s) up to which both ran."""
    return min((r.balance["time_s"][-1] for r in (first, other) if len(r.balance.get("time_s", ()))), default=0.0)


def cut_off(t, s, end):
    """Do the times t go on to the end, while the rows s end more than one of their steps earlier?"""
    t = t[t <= end * (1 + SAME)]
    return len(t) > 0 and t[-1] - s[-1] > np.diff(s).max(initial=0.0) * (1 + SAME)


def largest(first, other):
    """[(column, largest difference, of the first's range, time)] over the time that both have; infinite where one of them alone holds a
    number, or a column."""
    a, b, found = first.columns, other.columns, []
    size, end = scales(a), common_end(first, other)
    for name in dict.fromkeys((*a, *b)):
        if name not in a or name not in b:
            found.append((name, np.inf, np.nan, np.nan))
            continue
        (t, x), (s, y) = a[name], b[name]
        held = (t >= s[0]) & (t <= s[-1]) if len(s) else np.zeros(len(t), bool)
        if not held.any() or cut_off(t, s, end) or cut_off(s, t, end):
            found += [(name, np.inf, np.nan, min(times[-1] if len(times) else 0.0 for times in (t, s)))] if len(t) or len(s) else []
            continue
        d = apart(x[held], at(t[held], s, y))
        k, extent = int(np.argmax(d)), np.ptp(np.nan_to_num(x[held]))
        if d[k] > SAME * size[name]:
            found.append((name, d[k], d[k] / extent if extent > 0 else np.nan, t[held][k]))
    return found


def common_times(first, other):
    """(times (s) of the snapshots that both have, [sentences on those that one has alone, while both ran])."""
    end = common_end(first, other)
    near = lambda t, times: np.any(np.abs(times - t) <= SAME * max(abs(t), end))
    alone = [(t, a, b) for a, b in ((first, other), (other, first)) for t in a.times if not near(t, b.times) and t <= end * (1 + SAME)]
    return [t for t in first.times if near(t, other.times)], [f"at t = {t:.6g} s there is a snapshot in {a.folder} and none in {b.folder}" for t, a, b in alone]


def largest_of_snapshots(first, other, damaged):
    """As `largest`, of the particles' variables at the times of common_times; what cannot be read is added to `damaged`."""
    found = {}
    for t in common_times(first, other)[0]:
        try:
            a, b = first.particles(t), other.particles(t)
        except Damaged as error:
            damaged.append(str(error))
            continue
        for name in dict.fromkeys((*a, *b)):
            label, x, y = f"particles.{name}", a.get(name), b.get(name)
            d = apart(x, y).max(initial=0.0) if np.shape(x) == np.shape(y) else np.inf
            numbers = x[np.isfinite(x)] if np.isfinite(d) else np.zeros(1)
            if d > SAME * np.abs(numbers).max(initial=0.0) and d > found.get(label, (label, 0.0))[1]:
                extent = np.ptp(numbers)
                found[label] = (label, d, d / extent if extent > 0 else np.nan, t)
    return list(found.values())


def differences(runs, names, damaged):
    lines = []
    for run, name in zip(runs[1:], names[1:]):
        alone, found = common_times(runs[0], run)[1], largest(runs[0], run) + largest_of_snapshots(runs[0], run, damaged)
        rows = [[f"{name} against {names[0]}", "largest difference", "of the range", "at (s)"]]
        rows += [[c, f"{d:.4g}" if np.isfinite(d) else "in one alone", f"{share:.2%}" if np.isfinite(share) else "–", f"{t:.6g}" if np.isfinite(t) else "–"] for c, d, share, t in found]
        if not set(run.columns) & set(runs[0].columns):
            alone.append(f"{name}: no column in common with {names[0]}")
        lines += ["", *(table(rows) if found else []), *alone]
        if not found and not alone:
            lines.append(f"{name}: no difference in what can be read" if damaged else f"{name}: the same, as far as it goes (but for round-off)")
    return lines


def panels(runs):
    """[(label, [(name of a curve, column, factor)])] of the first run's probes and meters that any run has changing."""
    first, found = runs[0], []
    for label, unit, columns, _ in shown.histories(first.probes, first.probe_names):
        found += [(shown.tex(f"{label} {c[2]} ({unit})".replace("  ", " ")), [(n, f"{n}.{c[0]}", c[1]) for n in first.probe_names]) for c in columns]
    meters = probe_names(first.meters)
    for column in dict.fromkeys(c.rsplit(".", 1)[1] for c in first.meters if "." in c):
        found.append((column, [(n, f"{n}.{column}", 1.0) for n in meters if f"{n}.{column}" in first.meters]))
    changes = lambda run, column, factor: column in run and len(run[column][1]) and np.ptp(np.nan_to_num(run[column][1])) * factor > ROUND_OFF
    held = [r.columns for r in runs]
    return [p for p in found if any(changes(h, c, factor) for h in held for _, c, factor in p[1])]


def draw(runs, names, folder, picture="compare"):
    """One panel a quantity; a colour a run, a dash a probe."""
    drawn = panels(runs)
    if not drawn:
        return False
    set_style()
    wide = min(3, len(drawn))
    figure, grid = plt.subplots(-(-len(drawn) // wide), wide, figsize=(4.6 * wide, 3.2 * -(-len(drawn) // wide)), squeeze=False)
    unit, seconds = time_unit(max(t[-1] for r in runs for t, _ in r.columns.values() if len(t)))
    for axes in grid.flat[len(drawn) :]:
        axes.remove()
    for axes, (label, curves) in zip(grid.flat, drawn):
        values = []
        for run, colour in zip(runs, COLOURS * len(runs)):
            held = run.columns
            for (_, column, factor), dash in zip(curves, STYLES * len(curves)):
                if column in held:
                    values.append(held[column][1] * factor)
                    axes.plot(held[column][0] / seconds, values[-1], dash, color=colour)
        steady_limits(axes, *values)
        axes.set(xlabel=f"time ({unit})", ylabel=label)
        if len(curves) > 1:
            axes.legend(handles=[plt.Line2D([], [], color="0.3", ls=d, label=c[0]) for c, d in zip(curves, STYLES * len(curves))],
                        loc="center left", bbox_to_anchor=(1.0, 0.5))  # fmt: skip
    figure.legend(handles=[plt.Line2D([], [], color=c, lw=2.5, label=n) for n, c in zip(names, COLOURS * len(names))], loc="upper left",
                  bbox_to_anchor=(1.0, 0.95), title="run")  # fmt: skip
    figure.suptitle(runs[0].title, x=0.01, ha="left")
    save(figure, folder, picture)
    return True


def main(words):
    parser = argparse.ArgumentParser("clathra compare", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="RUN")
    parser.add_argument("-o", "--out", type=Path, metavar="FOLDER", help="of compare.png")
    options = parser.parse_args(words)
    damaged = []
    runs = [Run(folder, damaged.append) for folder in options.runs]
    names = labels(runs)
    print("\n".join([*work(runs, names), "", *differing(runs, names), *differences(runs, names, damaged)]))
    draw(runs, names, options.out or runs[0].folder / "figures")
    for sentence in dict.fromkeys(damaged):
        print(f"clathra compare: {sentence}", file=sys.stderr)
    return 2 if damaged else 0
