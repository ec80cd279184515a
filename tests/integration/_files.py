"""Comparing what runs leave in their folders."""
import hashlib

import h5py
import numpy as np

TABLES = ("probes.csv", "meters.csv", "balance.csv")


def contents(path):
    """{name: bytes} of everything in an HDF5 file, attributes too."""
    found = {}

    def visit(name, item):
        for key, value in item.attrs.items():
            found[f"{name}@{key}"] = np.asarray(value).tobytes()
        if isinstance(item, h5py.Dataset):
            found[name] = str((item.dtype, item.shape)).encode() + np.asarray(item[()]).tobytes()

    with h5py.File(path, "r") as file:
        file.visititems(visit)
        for kind in file if path.name == "fields.h5" else ():  # links into other files, which visititems passes by
            for key in file[kind]:
                visit(f"{kind}/{key}", file[kind][key])
                for name in file[kind][key] if isinstance(file[kind][key], h5py.Group) else ():
                    visit(f"{kind}/{key}/{name}", file[kind][key][name])
    return found


def different(a, b, tables=TABLES):
    """Names of the files, or parts of them, that differ between two folders."""
    names = [f for f in tables if (a / f).is_file() and (a / f).read_bytes() != (b / f).read_bytes()]
    for f in ("fields.h5", "checkpoint.h5"):
        x, y = contents(a / f), contents(b / f)
        names += [f"{f}:{k}" for k in sorted(x.keys() | y.keys()) if x.get(k) != y.get(k)]
    return names


def hashes(folder, but=""):
    """{path: digest} of all files but that of this name."""
    return {str(p): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(folder.rglob("*")) if p.is_file() and p.name != but}
