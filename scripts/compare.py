#!/usr/bin/python3
"""Runs beside each other: compare.py RUN RUN ... [-o FOLDER]

Prints what the runs took and where they ended, the keys of the case in which they differ, and the largest difference of every
probe's and meter's column from the first run's, at its times; writes FOLDER/compare.png (default: among the first run's figures)
with the histories of all runs.  Differences below 1e-9 of the largest value of a field, any component at any probe, are round-off.
"""
import argparse
import re
from pathlib import Path

import numpy as np

import clathra
from clathra import shown
from plotting import COLOURS, STYLES, plt, save, set_style, steady_limits

WORK = re.compile(r"integrator (\S+(?: stage)?), (\d+) steps, (\d+) refused, (\d+) Newton iterations, ([\d.]+) s")
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
        took, missing = WORK.search(run.summary), ERRORS.search(run.summary)
        t = f"{run.balance['time_s'][-1]:.6g}" if len(run.balance["time_s"]) else "0"
        rows.append([name, t if run.finished else f"{t}, not its end", *(took.groups() if took else ["–"] * 5), *(missing.groups() if missing else ["–"] * 3)])
    return table(rows)


def differing(runs, names):
    """Keys of the case whose values differ."""
    texts = [clathra.read_case(run.folder / "case.yaml", texts=True) for run in runs]
    keys = [k for k in dict.fromkeys(k for t in texts for k in t) if k not in IDLE and len({t.get(k) for t in texts}) > 1]
    if not keys:
        return ["the cases are the same"]
    lines = table([["key", *names], *([k, *(t.get(k, "–") for t in texts)] for k in keys[:SHOWN])])
    return lines + ([f"... and {len(keys) - SHOWN} more keys"] if len(keys) > SHOWN else [])


def columns_of(run):
    """{column: (times, values)} of probes and meters."""
    return {k: (t["time_s"], v) for t in (run.probes, run.meters) for k, v in t.items() if k != "time_s"}


def scales(columns):
    """{column: largest value of its field, all components at all probes or meters}."""
    field, most = {c: COMPONENT.sub("*", c.rsplit(".", 1)[-1], count=1) for c in columns}, {}
    for c, (_, v) in columns.items():
        most[field[c]] = max(most.get(field[c], 0.0), np.abs(v[np.isfinite(v)]).max(initial=0.0))
    return {c: most[field[c]] for c in columns}


def largest(first, other):
    """[(column, largest difference, of the first's range, time)] over the time that both have."""
    a, b, found = columns_of(first), columns_of(other), []
    size = scales(a)
    for name in a:
        if name not in b:
            continue
        (t, x), (s, y) = a[name], b[name]
        held = (t >= s[0]) & (t <= s[-1]) & np.isfinite(x)
        if not held.any():
            continue
        d = np.abs(np.interp(t[held], s, y) - x[held])
        k, extent = int(np.nanargmax(d)), np.ptp(x[held])
        if d[k] > SAME * size[name]:
            found.append((name, d[k], d[k] / extent if extent > 0 else np.nan, t[held][k]))
    return found


def differences(runs, names):
    lines = []
    for run, name in zip(runs[1:], names[1:]):
        found = largest(runs[0], run)
        rows = [[f"{name} against {names[0]}", "largest difference", "of the range", "at (s)"]]
        rows += [[c, f"{d:.4g}", f"{share:.2%}" if np.isfinite(share) else "–", f"{t:.6g}"] for c, d, share, t in found]
        lines += ["", *(table(rows) if found else [f"{name}: the same, as far as it goes (but for round-off)" if set(columns_of(run)) & set(columns_of(runs[0])) else f"{name}: no column in common with {names[0]}"])]
    return lines


def panels(runs):
    """[(label, [(name of a curve, column, factor)])] of the first run's probes and meters that any run has changing."""
    first, found = runs[0], []
    for label, unit, columns, _ in shown.histories(first.probes, first.probe_names):
        found += [(shown.tex(f"{label} {c[2]} ({unit})".replace("  ", " ")), [(n, f"{n}.{c[0]}", c[1]) for n in first.probe_names]) for c in columns]
    meters = clathra.probe_names(first.meters)
    for column in dict.fromkeys(c.rsplit(".", 1)[1] for c in first.meters if "." in c):
        found.append((column, [(n, f"{n}.{column}", 1.0) for n in meters if f"{n}.{column}" in first.meters]))
    changes = lambda run, column, factor: column in run and np.ptp(np.nan_to_num(run[column][1])) * factor > ROUND_OFF
    held = [columns_of(r) for r in runs]
    return [p for p in found if any(changes(h, c, factor) for h in held for _, c, factor in p[1])]


def draw(runs, names, folder, picture="compare"):
    """One panel a quantity; a colour a run, a dash a probe."""
    drawn = panels(runs)
    if not drawn:
        return False
    set_style()
    wide = min(3, len(drawn))
    figure, grid = plt.subplots(-(-len(drawn) // wide), wide, figsize=(4.6 * wide, 3.2 * -(-len(drawn) // wide)), squeeze=False)
    unit, seconds = clathra.time_unit(max(t[-1] for r in runs for t, _ in columns_of(r).values() if len(t)))
    for axes in grid.flat[len(drawn) :]:
        axes.remove()
    for axes, (label, curves) in zip(grid.flat, drawn):
        values = []
        for run, colour in zip(runs, COLOURS * len(runs)):
            held = columns_of(run)
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


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", metavar="RUN")
    parser.add_argument("-o", "--out", type=Path, metavar="FOLDER", help="of compare.png")
    options = parser.parse_args()
    try:
        runs = [clathra.Run(folder) for folder in options.runs]
    except clathra.NoRun as error:
        parser.exit(2, f"compare.py: {error}\n")
    names = labels(runs)
    print("\n".join([*work(runs, names), "", *differing(runs, names), *differences(runs, names)]))
    draw(runs, names, options.out or runs[0].folder / "figures")


if __name__ == "__main__":
    main()
