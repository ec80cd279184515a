"""The files of a run's folder: CSV tables and snapshots."""
import csv
import io
import sys
from pathlib import Path


def missing(error, what):
    """The ImportError that says in a sentence which python3 lacks which module, and what needs it."""
    module = error.name.split(".")[0]
    return ImportError(f"{sys.executable} has no module {module}, which {what} needs (Debian: python3-{module})", name=module)


try:
    import numpy as np
except ImportError as error:
    raise missing(error, "clathra") from None


class Damaged(KeyError):
    """A file of a run does not hold what it should."""

    def __str__(self):
        return self.args[0]


class Entries(dict):
    """What a file holds, by name; what it lacks is said with the file."""

    def __init__(self, path, found=()):
        super().__init__(found)
        self.path = path

    def __missing__(self, name):
        raise Damaged(f"{self.path} has no {name}")


def text_of(path):
    """Text of a file, whatever its bytes."""
    return Path(path).read_text(encoding="utf-8", errors="replace")


def read_csv(path):
    """Columns of a CSV file with one header line: {name: (rows,) array}.  A row without its end, which is being written or was cut off,
    is left out; what is no such table is Damaged."""
    text = text_of(path)
    rows = list(csv.reader(io.StringIO(text[: text.rfind("\n") + 1])))
    if not rows:
        raise Damaged(f"{path} is empty")
    names = [name.strip() for name in rows[0]]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise Damaged(f"{path} has two columns {twice[0]}")
    values = np.empty((len(rows) - 1, len(names)))
    for k, row in enumerate(rows[1:]):
        try:
            values[k] = np.array([float(value) for value in row]).reshape(len(names))
        except ValueError:
            raise Damaged(f"{path}, line {k + 2}: no row of {len(names)} numbers") from None
    if "time_s" in names and not np.isfinite(values[:, names.index("time_s")]).all():
        raise Damaged(f"{path} has a row whose time is no number")
    return Entries(path, zip(names, values.T))


def last_row(path):
    """{column: value} of the last whole row of such a file, {} if it has none; of a long one no more is read than that."""
    with open(path, "rb") as file:
        names = file.readline().decode(errors="replace").strip().split(",")
        begin = file.tell()
        file.seek(max(begin, file.seek(0, 2) - 4000 - 40 * len(names)))
        rows = file.read().decode(errors="replace").rpartition("\n")[0].splitlines()
    try:
        return dict(zip(names, map(float, rows[-1].split(",")))) if rows else {}
    except ValueError:
        raise Damaged(f"{path}: its last row is no row of numbers") from None


def probe_names(probes):
    """Names of the probes in the columns of probes.csv, in their order."""
    return list(dict.fromkeys(c.rsplit(".", 1)[0] for c in probes if "." in c))


def _read(path, read, file=None):
    """What `read` makes of an HDF5 file; Damaged if it cannot, or what it links to as `file`."""
    try:
        import h5py
    except ImportError as error:
        raise missing(error, "reading snapshots") from None
    try:
        with h5py.File(path, "r") as h5:
            return read(h5)
    except (OSError, KeyError, RuntimeError, ValueError) as error:
        raise Damaged(f"{file or path} is missing or damaged: {str(error).strip(chr(39) + chr(34))}") from None


def _file(folder, key):
    """The file of a snapshot, to which fields.h5 links."""
    return Path(folder) / "fields" / f"{key}.h5"


def snapshot_times(folder, kind="particles", tell=None):
    """{name of the group in fields.h5: time (s)} in order of time; {} if there are none.  What cannot be read is Damaged; with `tell` it is
    told of that and left out."""
    path, found = Path(folder) / "fields.h5", {}
    if not path.is_file():
        return found
    time = lambda key: _read(path, lambda h5: float(np.ravel(h5[kind][key].attrs["time"])[0]), _file(folder, key))
    for key in _read(path, lambda h5: sorted(h5.get(kind, {}))):
        try:
            found[key] = time(key)
        except Damaged as error:
            if tell is None:
                raise
            tell(str(error))
    return found


def read_lines(folder):
    """Places of the lines of the background grid, m: (x (columns,), y (rows,)), in space also z (layers,)."""
    return _read(Path(folder) / "fields.h5", lambda h5: tuple(h5["lines"][d][()] for d in "xyz" if d in h5["lines"]))


def read_snapshot(folder, key, kind="particles"):
    """{variable: array} of one snapshot: of particles (n, components), sorted by their id, where the file holds one, so that
    runs on different ranks can be compared; of the grid (rows, columns[, 2])."""
    file, read = _file(folder, key), lambda h5: {name: data[()] for name, data in h5[kind][key].items()}
    return Entries(file, _tidy(_read(Path(folder) / "fields.h5", read, file)))


def read_snapshots(folder, kind="particles"):
    """[(time (s), {variable: (n, components) array})] of fields.h5 in order of time; kind particles or grid; [] if none."""
    return [(time, read_snapshot(folder, key, kind)) for key, time in snapshot_times(folder, kind).items()]


def _tidy(variables):
    order = np.argsort(np.ravel(variables["id"]), kind="stable") if "id" in variables else slice(None)
    return {k: np.asarray(v).reshape(len(v), -1)[order] if np.ndim(v) else v for k, v in variables.items()}
