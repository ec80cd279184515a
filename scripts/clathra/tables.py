"""The files of a run's folder: CSV tables and snapshots."""
import csv
from pathlib import Path

import numpy as np


def read_csv(path):
    """Columns of a CSV file with one header line: {name: (rows,) array}."""
    with open(path, newline="") as stream:
        rows = list(csv.reader(stream))
    values = np.array(rows[1:], dtype=float).reshape(-1, len(rows[0]))
    return {name.strip(): values[:, k] for k, name in enumerate(rows[0])}


def probe_names(probes):
    """Names of the probes in the columns of probes.csv, in their order."""
    return list(dict.fromkeys(c.rsplit(".", 1)[0] for c in probes if "." in c))


def snapshot_times(folder, kind="particles"):
    """{name of the group in fields.h5: time (s)} in order of time; {} if there are none."""
    path = Path(folder) / "fields.h5"
    if not path.is_file():
        return {}
    import h5py

    with h5py.File(path, "r") as h5:
        return {key: float(np.ravel(h5[kind][key].attrs["time"])[0]) for key in sorted(h5.get(kind, {}))}


def read_lines(folder):
    """Places of the lines of the background grid, m: (x (columns,), y (rows,)), in space also z (layers,)."""
    import h5py

    with h5py.File(Path(folder) / "fields.h5", "r") as h5:
        return tuple(h5["lines"][d][()] for d in "xyz" if d in h5["lines"])


def read_snapshot(folder, key, kind="particles"):
    """{variable: array} of one snapshot: of particles (n, components), sorted by their id, where the file holds one, so that
    runs on different ranks can be compared; of the grid (rows, columns[, 2])."""
    import h5py

    with h5py.File(Path(folder) / "fields.h5", "r") as h5:
        return _tidy({name: data[()] for name, data in h5[kind][key].items()})


def read_snapshots(folder, kind="particles"):
    """[(time (s), {variable: (n, components) array})] of fields.h5 in order of time; kind particles or grid; [] if none."""
    return [(time, read_snapshot(folder, key, kind)) for key, time in snapshot_times(folder, kind).items()]


def _tidy(variables):
    order = np.argsort(np.ravel(variables["id"]), kind="stable") if "id" in variables else slice(None)
    return {k: np.asarray(v).reshape(len(v), -1)[order] if np.ndim(v) else v for k, v in variables.items()}
