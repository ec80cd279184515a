"""Values of keys with which a case meets what was measured: clathra calibrate CASE KEY=LOW,HIGH[,log] ... FILE.csv [--out FOLDER] [--jobs N] [-- OPTIONS]

FILE.csv has the times in a column time_s, and columns named as those of probes.csv and meters.csv; a place without a number was not measured.
Least squares, each column in shares of its range; the runs for the slopes go side by side, each on one core, in FOLDER/KEY=VALUE,...
(default results/calibrate_CASE).  It begins with the values of the case, and ends when a step changes no value by more than --tol of its range.
Prints the values with their standard errors.  LOW and HIGH may carry a unit; log searches in the logarithm.  OPTIONS go to every run.
"""
from pathlib import Path
from typing import NamedTuple

import numpy as np

from .case import Case
from .program import GaveUp, Refused
from .run import Run
from .sweep import Part, arguments, at_a_time, complete, named, side_by_side
from .tables import Damaged, missing, read_csv

STEP = 2e-3  # of a key's range, for slopes
NEAREST = 0.01  # of a key's range, to its ends, to begin with


class Range(NamedTuple):
    """Where a key's value is looked for; places in it run from 0 to 1."""

    key: str
    low: float
    high: float
    log: bool
    unit: str  # "" where bounds are bare numbers

    @classmethod
    def of(cls, key, bounds):
        """Of (low, high) or (low, high, "log"), numbers or texts with one unit."""
        try:
            low, high, *kind = bounds
            (low, unit), (high, other) = ((*str(b).split(None, 1), "")[:2] for b in (low, high))
            found = cls(key, float(low), float(high), bool(kind), unit)
        except (TypeError, ValueError):
            raise Refused(f"{key} = {bounds!r} is no range: (low, high) or (low, high, 'log'), numbers or texts with a unit") from None
        if kind not in ([], ["log"]) or unit != other or not found.low < found.high or (found.log and found.low <= 0) or not np.isfinite([found.low, found.high]).all():
            raise Refused(f"{key}: {', '.join(map(str, bounds))} is no range: low below high, in one unit, above 0 for log")
        return found

    def value(self, place):
        """The value (in the unit of the bounds) at a place."""
        found = self.low * (self.high / self.low) ** place if self.log else self.low + place * (self.high - self.low)
        return float(f"{found:.12g}")

    def place(self, value):
        """The place of a value, within the range."""
        at = np.log(value / self.low) / np.log(self.high / self.low) if self.log else (value - self.low) / (self.high - self.low)
        return float(np.clip(at, NEAREST, 1 - NEAREST))

    def width(self, place):
        """Change of the value by one of the place."""
        return self.value(place) * np.log(self.high / self.low) if self.log else self.high - self.low

    def given(self, place):
        """The value as a case takes it."""
        return f"{self.value(place)!r} {self.unit}" if self.unit else self.value(place)

    def start(self, resolved):
        """The place of the case's own value, where that has the bounds' unit; else the middle."""
        number, _, unit = str(resolved.get(self.key, "")).partition(" ")
        try:
            return self.place(float(number)) if self.unit in ("", unit) and (float(number) > 0 or not self.log) else 0.5
        except ValueError:
            return 0.5


class Fit(NamedTuple):
    """What calibrate found."""

    values: dict  # {key: value}, in the unit of its bounds
    errors: dict  # {key: standard error}, in the same; infinite where the target does not tell
    residuals: dict  # {column: (rows,) array}: of the run less measured, in the column's unit
    case: Case  # with these values
    run: Run
    parts: list  # every run: Part(values, folder, code, said)
    converged: bool

    @property
    def failed(self):
        """The runs that did not come to their end, or gave no number."""
        return [part for part in self.parts if part.code]


class Target:
    """Measured rows: {column: (times (s), values, error)}."""

    def __init__(self, source):
        if not isinstance(source, dict):
            table = read_csv(source)
            source = {c: (table["time_s"], v) for c, v in table.items() if c != "time_s"}
        self.columns = {}
        for name, (times, values, *error) in source.items():
            times, values = np.atleast_1d(np.asarray(times, float)), np.atleast_1d(np.asarray(values, float))
            if times.shape != values.shape or times.ndim != 1:
                raise Refused(f"the target has {times.size} times and {values.size} values of {name}")
            there = np.isfinite(values) & np.isfinite(times)
            scale = error[0] if error else np.ptp(values[there]) or abs(values[there]).max() or 1.0 if there.any() else 1.0
            if not np.all(np.asarray(scale, float) > 0):
                raise Refused(f"the target's error of {name} must be above 0")
            self.columns[name] = (times[there], values[there], np.broadcast_to(scale, values.shape)[there])
        if not any(len(values) for _, values, _ in self.columns.values()):
            raise Refused("the target holds no number")

    def residuals(self, run):
        """{column: of the run less measured}; between rows of the run straight lines."""
        found, there = {}, run.columns
        for name, (times, values, _) in self.columns.items():
            if name not in there:
                raise Refused(f"the run has no column {name}; there are: {', '.join(there) or 'none'}", folder=run.folder)
            t, v = there[name]
            if len(times) and (not len(t) or times.min() < t[0] or times.max() > t[-1] * (1 + 1e-9)):
                raise Refused(f"{name} was measured from {times.min():g} s to {times.max():g} s, outside of the rows of {run.folder}", folder=run.folder)
            found[name] = np.interp(times, t, v) - values
        return found

    def scaled(self, residuals):
        """(rows,) of all columns, in shares of their errors."""
        return np.concatenate([residuals[name] / error for name, (_, _, error) in self.columns.items()])

    @property
    def rows(self):
        return sum(len(values) for _, values, _ in self.columns.values())


class Search:
    """The runs of a calibration, each made once."""

    def __init__(self, case, ranges, target, folder, jobs, options, tell):
        self.case, self.ranges, self.target, self.folder, self.jobs, self.options, self.tell = case, ranges, target, Path(folder), jobs, options, tell
        self.made = {}  # {values: (Part, scaled residuals, NaN of a run that failed)}

    def values(self, places):
        return {r.key: r.given(z) for r, z in zip(self.ranges, places)}

    def _make(self, values, living):
        """Runs the case with these values."""
        folder = self.folder / named(values)
        folder.mkdir(parents=True, exist_ok=True)
        code, said = complete(self.case.with_(values), folder, self.options, living)
        found = np.full(self.target.rows, np.nan)
        if code == 0:
            found = self.target.scaled(self.target.residuals(Run(folder)))
            if not np.isfinite(found).all():
                code, said = 3, "the run's columns hold what is no number"
        if self.tell is not None:
            self.tell(f"{folder.name}: {said}" + (f", misfit {np.sqrt(np.mean(found**2)):.3g}" if code == 0 else ""))
        return Part(values, folder, code, said), found

    def at(self, *places):
        """[(Part, scaled residuals)] at several places, side by side."""
        wanted = [self.values(p) for p in places]
        new = list({tuple(v.items()): v for v in wanted if tuple(v.items()) not in self.made}.items())
        self.made.update(zip((name for name, _ in new), side_by_side(self._make, [(v,) for _, v in new], self.jobs)))
        return [self.made[tuple(v.items())] for v in wanted]

    def misfit(self, places):
        """(rows,) scaled residuals; NaN where the run fails, from where the search turns back."""
        return self.at(places)[0][1]

    def slopes(self, places):
        """(rows, keys) of the scaled residuals by places: to the side on which there is room, to the other where that run fails."""
        steps = [STEP if z + STEP <= 1 else -STEP for z in places]
        moved = lambda k, step: places + step * (np.arange(len(places)) == k)
        base, *beside = self.at(places, *(moved(k, step) for k, step in enumerate(steps)))
        found = np.empty((self.target.rows, len(places)))
        for k, (part, residuals) in enumerate(beside):
            if part.code and 0 <= places[k] - steps[k] <= 1:
                steps[k] = -steps[k]
                part, residuals = self.at(moved(k, steps[k]))[0]
            if part.code:
                raise GaveUp(f"runs with {self.ranges[k].key} beside {base[0].values[self.ranges[k].key]} fail: {part.said}", part.code, part.said, part.folder)
            found[:, k] = (residuals - base[1]) / steps[k]
        return found


def calibrate(case, keys, target, folder, jobs=None, options=(), tol=1e-3, most=50, tell=None):
    """Values of keys with which a case meets what was measured, by least squares within bounds: a Fit.  Needs scipy.

    keys     {key: (low, high)} or {key: (low, high, "log")}, where it is searched in the logarithm; numbers in the unit of the key table (SI, degC,
             deg), or texts with a unit ("1 MPa", "1 GPa").  It begins with the case's own value, or in the middle where that has another unit
    target   {column: (times (s), values)}, named and measured as in probes.csv and meters.csv, or a CSV file of such columns and time_s.  Each column
             counts in shares of its range, or of a third entry: its error, one or one a row, in its unit
    folder   of the runs, folder/KEY=VALUE,...; those that have finished there are not run again
    jobs     runs at a time; default: the cores there are
    options  words for every run
    tol      change of a value, as a share of its range, below which the search ends
    most     steps of the search, beside which the runs for the slopes go: one a key
    tell     tell(sentence) is called after each run

    A run that fails is a Part of `failed` with its values, and the search turns back from it; where the first one fails, or all beside one, it raises
    GaveUp, or Refused, with these values and what the program said.
    """
    try:
        from scipy.optimize import least_squares
    except ImportError as error:
        raise missing(error, "clathra calibrate") from None
    ranges, target = [Range.of(key, bounds) for key, bounds in keys.items()], Target(target)
    if not ranges:
        raise Refused("no key was named to calibrate")
    at_a_time(jobs)
    search = Search(case, ranges, target, folder, jobs, options, tell)
    own = case.resolved(texts=True, options=options)
    start = np.array([r.start(own) for r in ranges])
    first = search.at(start)[0][0]
    if first.code:
        kind = Refused if first.code == 2 else GaveUp
        raise kind(f"the first run, with {named(first.values)}, did not come to its end: {first.said}", first.code, first.said, first.folder)
    found = least_squares(search.misfit, start, jac=search.slopes, bounds=(0, 1), xtol=tol, ftol=1e-8, gtol=1e-12, max_nfev=most)
    part, _ = search.at(found.x)[0]
    errors = np.full(len(ranges), np.inf)
    if target.rows > len(ranges) == np.linalg.matrix_rank(found.jac, tol=1e-9):
        errors = np.sqrt(np.diag(np.linalg.inv(found.jac.T @ found.jac)) * 2 * found.cost / (target.rows - len(ranges)))
    return Fit({r.key: r.value(z) for r, z in zip(ranges, found.x)}, {r.key: float(e * r.width(z)) for r, z, e in zip(ranges, found.x, errors)},
               target.residuals(part.run), case.with_(part.values), part.run, [made for made, _ in search.made.values()], found.status > 0)  # fmt: skip


def main(words):
    found, options = arguments(words, __doc__, "clathra calibrate", keys={"nargs": "+", "metavar": "KEY=LOW,HIGH[,log]"}, target={"metavar": "FILE.csv"}, **{"--tol": {"type": float, "default": 1e-3}})
    case = Case(found.case, found.program)
    keys = {key.lstrip("-"): tuple(w.strip() for w in bounds.split(",")) for key, _, bounds in (text.partition("=") for text in found.keys)}
    out = found.out or Path("results") / f"calibrate_{case.name}"
    try:
        fit = calibrate(case, keys, found.target, out, found.jobs, options, found.tol, tell=lambda sentence: print(f"  {sentence}", flush=True))
    except Damaged as error:
        raise Refused(str(error)) from None
    units = {key: Range.of(key, bounds).unit for key, bounds in keys.items()}
    for key, value in fit.values.items():
        print(f"{key} = {value:.6g} {units[key]}".rstrip() + f", standard error {fit.errors[key]:.2g}")
    for name, rest in fit.residuals.items():
        print(f"{name}: {len(rest)} rows, root mean square of the residuals {np.sqrt(np.mean(rest**2)):.3g}, largest {abs(rest).max():.3g}")
    for part in fit.failed:
        print(f"failed: {named(part.values)}: {part.said}")
    print(f"{len(fit.parts)} runs; the last one in {fit.run.folder}" + ("" if fit.converged else "; it has not converged"))
    return 0 if fit.converged else 3
