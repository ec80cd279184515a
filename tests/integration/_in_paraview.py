"""Inside pvpython, for in_paraview.py: _in_paraview.py FOLDER OUT [PICTURE]

Writes into OUT/READER.KIND.npz what each of ParaView's readers of XDMF makes of particles.xdmf and grid.xdmf at the last time; with PICTURE
lets scripts/paraview_run.py draw the run, and writes OUT/camera.npz.
"""
import sys
from pathlib import Path

import numpy as np
from paraview import simple
from paraview.vtk.util.numpy_support import vtk_to_numpy

READERS = {"XDMFReader": "FileNames", "Xdmf3ReaderS": "FileName", "Xdmf3ReaderT": "FileName"}


def dump(reader, folder, kind, out):
    source = getattr(simple, reader)(**{READERS[reader]: [str(folder / f"{kind}.xdmf")]})
    times = list(source.TimestepValues)
    source.UpdatePipeline(times[-1])
    data, found = source.GetClientSideObject().GetOutputDataObject(0), {}  # what servermanager.Fetch copies of uneven grids is not theirs
    held = data.GetPointData()
    for k in range(held.GetNumberOfArrays()):
        found[f"array:{held.GetArrayName(k)}"] = vtk_to_numpy(held.GetArray(k))
    names = list(source.GetPropertyValue("GridStatus")) if "GridStatus" in source.ListProperties() else []
    points = np.array([data.GetPoint(k) for k in range(data.GetNumberOfPoints())])
    np.savez(out / f"{reader}.{kind}.npz", times=times, blocks=names, kind=data.GetClassName(), points=points, **found)


def picture(folder, path, out):
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
    import paraview_run

    paraview_run.main([str(folder), str(path)])
    view = simple.GetActiveView()
    names = [name for name, _ in simple.GetSources()]
    array = simple.GetDisplayProperties(simple.FindSource("body"), view).ColorArrayName[1]
    np.savez(out / "camera.npz", focus=list(view.CameraFocalPoint), scale=view.CameraParallelScale, sources=names, array=array)


folder, out = map(Path, sys.argv[1:3])
for one in READERS:
    for what in ("particles", "grid"):
        dump(one, folder, what, out)
if len(sys.argv) > 3:
    picture(folder, Path(sys.argv[3]), out)
