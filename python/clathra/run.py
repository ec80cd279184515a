"""A run by its folder."""
import re
import warnings
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .resolved import read_case
from .tables import Damaged, Entries, last_row, probe_names, read_csv, read_lines, read_snapshot, snapshot_times, text_of


WORK = re.compile(r"integrator (\S+(?: stage)?), (\d+) steps, (\d+) refused, (\d+) Newton iterations, ([\d.]+) s")
FINDING = re.compile(r"^(?:.*: (?:note|warning): |Given up at |A likely cause: ).*(?:\n  What to try, in this order: .*)?", re.M)  # src/base/finding.c


class NoRun(Exception):
    """The folder holds no run."""


class Progress(NamedTuple):
    """How far a run is."""

    step: int
    time: float  # s
    end: float  # of the case, s; NaN before it is read
    share: float  # of the time to the end


class Run:
    """What a run left in `folder`; files are read when first asked for.

    times    (snapshots,) s, of particles()
    case     {key: value} as it ran, in SI units; texts: as its file says it, with units
    probes, balance, meters  {column: (rows,) array} of the CSV files; {} if the run wrote none
    summary, log             what the program said at its end, and in all ("" while it runs)

    A damaged table raises Damaged, a damaged snapshot is warned of and left out of `times`.  With tell=F, F(sentence) is called for either,
    and the table has no columns.
    """

    def __init__(self, folder, tell=None):
        self.folder, self._tell = Path(folder), tell
        if not (self.folder / "case.yaml").is_file() or not (self.folder / "balance.csv").is_file():
            raise NoRun(f"{folder} holds no run (no case.yaml and balance.csv)")

    def __repr__(self):
        return f"clathra.Run({str(self.folder)!r})"

    def _table(self, name):
        path = self.folder / name
        try:
            return read_csv(path) if path.is_file() else Entries(path)
        except Damaged as error:
            if self._tell is None:
                raise
            self._tell(str(error))
            return Entries(path)

    def _text(self, name):
        path = self.folder / name
        return text_of(path) if path.is_file() else ""

    case = cached_property(lambda self: read_case(self.folder / "case.yaml"))
    texts = cached_property(lambda self: read_case(self.folder / "case.yaml", texts=True))
    probes = cached_property(lambda self: self._table("probes.csv"))
    balance = cached_property(lambda self: self._table("balance.csv"))
    meters = cached_property(lambda self: self._table("meters.csv"))
    summary = cached_property(lambda self: self._text("summary.txt"))
    log = cached_property(lambda self: self._text("log.txt"))

    @property
    def findings(self):
        """What the program warned of, noted and advised, each once: [sentence, with what to try behind it]."""
        return [*dict.fromkeys(FINDING.findall(self.log))]

    @property
    def title(self):
        return self.case.get("title") or self.folder.name

    @property
    def finished(self):
        """Did it come to its end?"""
        return ": finished at t = " in self.summary

    @property
    def progress(self):
        """How far it is, or came: Progress(step, time, end, share)."""
        row = last_row(self.folder / "balance.csv")
        ends = [self.case.get(f"stage_{name}_end") for name in self.names("stages")] or [self.case.get("time_end")]
        step, time, end = int(row.get("step", 0)), row.get("time_s", 0.0), float(ends[-1] or "nan")
        return Progress(step, time, end, time / end)

    @property
    def axisymmetric(self):
        return self.case.get("geometry") == "axisymmetric"

    def names(self, group):
        """Names that the case lists: regions, materials, boundaries, probes, meters, stages."""
        return self.case.get(group, [])

    @property
    def probe_names(self):
        return probe_names(self.probes)

    @property
    def columns(self):
        """{column: (times (s), values)} of probes and meters, each (rows,)."""
        return {k: (t["time_s"], v) for t in (self.probes, self.meters) for k, v in t.items() if k != "time_s"}

    @property
    def work(self):
        """What it took, in the words of its summary: {integrator, steps, refused, newton, seconds}; {} before its end."""
        said = WORK.search(self.summary)
        return dict(zip(("integrator", "steps", "refused", "newton", "seconds"), said.groups())) if said else {}

    def probe(self, name):
        """{quantity: (rows,) array} of one probe: p_Pa, T_degC, S_h, u_x_m, ..., and time_s."""
        return self._columns(self.probes, name, "probe", self.probe_names)

    def meter(self, name):
        """{quantity: (rows,) array} of one meter or plate: water_kg_s, gas_std_m3, position_m, ..., and time_s."""
        return self._columns(self.meters, name, "meter or plate", probe_names(self.meters))

    @staticmethod
    def _columns(table, name, what, names):
        found = {c[len(name) + 1 :]: v for c, v in table.items() if c.startswith(f"{name}.")}
        if not found:
            raise KeyError(f"no {what} {name}; there are: {', '.join(names) or 'none'}")
        return {"time_s": table["time_s"], **found}

    @cached_property
    def _keys(self):
        return {kind: self._listed(kind) for kind in ("particles", "grid")}

    def _listed(self, kind):
        try:
            return snapshot_times(self.folder, kind, self._tell or warnings.warn)
        except Damaged as error:
            (self._tell or warnings.warn)(str(error))
            return {}

    @property
    def times(self):
        return np.array(list(self._keys["particles"].values()))

    def _snapshot(self, kind, time):
        keys, times = list(self._keys[kind]), np.array(list(self._keys[kind].values()))
        if not len(keys):
            raise KeyError(f"{self.folder} holds no snapshots of the {kind}")
        k = len(keys) - 1 if time is None else int(np.argmin(abs(times - time)))
        if time is not None and abs(times[k] - time) > 1e-6 * max(abs(time), times[-1] - times[0]):
            raise KeyError(f"no snapshot at {time:g} s; nearest is {times[k]:.17g} s (all: Run.times)")
        return read_snapshot(self.folder, keys[k], kind)

    def particles(self, time=None):
        """{variable: (n,) array, of vectors and tensors (n, components)} at a time of `times` (s); None: the last."""
        found = self._snapshot("particles", time)
        found.update((k, v[:, 0]) for k, v in found.items() if v.ndim == 2 and v.shape[1] == 1)
        return found

    def grid(self, time=None):
        """{field: (rows, columns) array, of velocities (rows, columns, 2)} of the nodes, NaN where there is no sediment, with their
        coordinates x (columns,) and y (rows,), m: what the step that ended at this time started from.  In space z comes first:
        (layers, rows, columns)."""
        lines = self.lines
        fields = {k: v.reshape(*(len(x) for x in lines[::-1]), -1) for k, v in self._snapshot("grid", time).items()}
        return {**dict(zip("xyz", lines)), **{k: v[..., 0] if v.shape[-1] == 1 else v for k, v in fields.items()}}

    @property
    def lines(self):
        """Lines of the background grid: (x (m), y (m)), in space also z (m)."""
        return read_lines(self.folder)

    @property
    def in_space(self):
        """Has it three axes?"""
        return len(self.case["grid_lower"]) == 3
