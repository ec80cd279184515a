#!/usr/bin/env pvpython
"""What ParaView itself reads of a run: pvpython tests/studies/paraview_readers.py [CLATHRA [PICTURE.png]]

By hand, for python3-paraview brings 139 packages (xvfb-run -a pvpython ... where there is no screen, for the picture):
every reader of XDMF must give the particles and the grid under names of their own, at their times, with every array as
clathra.Run reads it, and scripts/paraview_run.py must show them.  In every check tests/integration/output.py holds the same
files to the form that passes here.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from paraview import simple
from paraview import servermanager as server
from paraview.vtk.util.numpy_support import vtk_to_numpy

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "scripts"))
import clathra  # noqa: E402

READERS = {"XDMFReader": "FileNames", "Xdmf3ReaderS": "FileName", "Xdmf3ReaderT": "FileName"}
SCENES = (("shear_box", "-grid_cells", "16,10"), ("bp2", "-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s"))


def check(reader, run, kind, faults):
    """The last time of one file by one reader: numbers of points, places, arrays."""
    source = getattr(simple, reader)(**{READERS[reader]: [str(run.folder / f"{kind}.xdmf")]})
    times = list(source.TimestepValues)
    wanted = run.particles() if kind == "particles" else run.grid()
    if times != (run.times.tolist() if kind == "particles" else run.times[1:].tolist()):
        faults.append(f"{reader}: {kind} has times {times}")
    source.UpdatePipeline(times[-1])
    data = server.Fetch(source)
    arrays = {data.GetPointData().GetArrayName(k): vtk_to_numpy(data.GetPointData().GetArray(k)) for k in range(data.GetPointData().GetNumberOfArrays())}
    names = set(wanted) - {"position", "vertex", "x", "y"}
    if set(arrays) != names:
        faults.append(f"{reader}: {kind} has arrays {sorted(set(arrays) ^ names)} too many or too few")
    for name in names & set(arrays):
        a, b = arrays[name].ravel(), np.asarray(wanted[name]).ravel()
        if a.size != b.size or not np.array_equal(a, b.astype(a.dtype), equal_nan=a.dtype.kind == "f"):
            faults.append(f"{reader}: {kind}: {name} is not what the file holds")
    points = np.array([data.GetPoint(k) for k in range(data.GetNumberOfPoints())])
    x, y = wanted.get("x"), wanted.get("y")
    places = wanted["position"] if kind == "particles" else np.stack(np.meshgrid(x, y), -1).reshape(-1, 2)
    if points.shape[0] != len(places) or not np.allclose(points[:, :2], places, atol=1e-12) or np.any(points[:, 2]):
        faults.append(f"{reader}: {kind}: points are in other places")
    return len(arrays), len(points)


def main(program=str(ROOT / "build" / "clathra"), picture=None):
    faults = []
    for name, *options in SCENES:
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([program, ROOT / "cases" / name, *options, "-quiet", "-output_dir", folder], check=True, stdout=subprocess.DEVNULL)
            run = clathra.Run(folder)
            for kind in ("particles", "grid"):
                for reader in READERS:
                    print(f"{name:10s} {kind:10s} {reader:14s} %d arrays of %d points" % check(reader, run, kind, faults), flush=True)
            if picture:
                subprocess.run(["pvpython", ROOT / "scripts" / "paraview_run.py", folder, picture], check=True)
                picture = None
    print("\n".join(faults) or "no faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
