"""Reading what a run leaves in its folder; used by the plots and by the tests.  Needs numpy, and h5py for snapshots."""
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


def read_snapshots(folder, kind="particles"):
    """[(time (s), {variable: (n, components) array})] of fields.h5 in order of time; kind particles or grid; [] if none.

    Particles are sorted by their id, where the file holds one, so that runs on different ranks can be compared.
    """
    path = Path(folder) / "fields.h5"
    if not path.is_file():
        return []
    import h5py

    with h5py.File(path, "r") as h5:
        groups = [h5[kind][key] for key in sorted(h5.get(kind, {}))]
        return [(float(np.ravel(g.attrs["time"])[0]), _tidy({k: g[k][()] for k in g})) for g in groups]


def _tidy(variables):
    order = np.argsort(np.ravel(variables["id"]), kind="stable") if "id" in variables else slice(None)
    return {k: np.asarray(v).reshape(len(v), -1)[order] if np.ndim(v) else v for k, v in variables.items()}
