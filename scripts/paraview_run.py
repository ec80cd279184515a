"""Shows a run in ParaView: its particles as large as they are, coloured by a quantity, over the wire frame of the grid.

  paraview --script=scripts/paraview_run.py            asks for nothing: the run is $CLATHRA_RUN, or the folder ParaView was started in
  pvpython scripts/paraview_run.py FOLDER [PICTURE.png [ARRAY]]   writes a picture of the last time (xvfb-run -a where there is no screen)
  in ParaView: Macros, Import new macro ..., then the button; it takes the same folder

Vectors of the plane have two components; Calculators make the displacement and the velocity of the water vectors of space, for Glyph
and Warp By Vector.
"""
import os
import sys

from paraview.simple import (Calculator, ColorBy, GetActiveViewOrCreate, GetAnimationScene, GetColorTransferFunction, GetScalarBar, Hide, Render,
                             ResetCamera, SaveScreenshot, Show, XDMFReader)  # fmt: skip

FIRST = ("p", "T", "S_h")  # what is shown unless an array is named: the first of these that there is
VECTORS = ("displacement", "v_w")


def vector(source, name):
    """The array `name` of two components as `name_vector` of three."""
    found = Calculator(registrationName=f"{name}_vector", Input=source)
    found.ResultArrayName = f"{name}_vector"
    found.Function = f'"{name}_X"*iHat+"{name}_Y"*jHat'
    return found


def spacing(particles):
    """Distance between neighbours, m: from the volume of a particle of one metre of thickness, or of the bounds."""
    x0, x1, y0, y1 = particles.GetDataInformation().GetBounds()[:4]
    return (max(x1 - x0, 1e-9) * max(y1 - y0, 1e-9) / max(particles.GetDataInformation().GetNumberOfPoints(), 1)) ** 0.5


def show(folder, array=None):
    """Fills the active view; returns (view, particles, grid or None)."""
    view = GetActiveViewOrCreate("RenderView")
    particles = XDMFReader(registrationName="particles", FileNames=[os.path.join(folder, "particles.xdmf")])
    times = list(particles.TimestepValues)
    particles.UpdatePipeline(times[-1])
    there = particles.PointData.keys()
    shown = particles
    for name in VECTORS:
        if name in there:
            shown = vector(shown, name)
    display = Show(shown, view)
    display.SetRepresentationType("Point Gaussian")
    display.GaussianRadius = 0.5 * spacing(particles)
    display.ShaderPreset = "Plain circle"
    grid = XDMFReader(registrationName="grid", FileNames=[os.path.join(folder, "grid.xdmf")])
    if len(times) > 1:
        lines = Show(grid, view)
        lines.SetRepresentationType("Wireframe")
        ColorBy(lines, None)
        lines.Opacity = 0.3
        lines.AmbientColor = lines.DiffuseColor = [0.3, 0.3, 0.3]
    else:
        Hide(grid, view)
    view.Background = [1, 1, 1]
    view.UseColorPaletteForBackground = 0
    view.OrientationAxesVisibility = 0
    view.InteractionMode = "2D"
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = view.ViewTime = times[-1]
    array = array or next(name for name in (*FIRST, *there) if name in there)
    ColorBy(display, ("POINTS", array))
    display.RescaleTransferFunctionToDataRange(False, True)
    GetColorTransferFunction(array).ApplyPreset("Viridis (matplotlib)", True)
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(GetColorTransferFunction(array), view)
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.TitleFontSize, bar.LabelFontSize = 16, 14
    bar.WindowLocation, bar.ScalarBarLength = "Upper Right Corner", 0.4
    ResetCamera(view)
    Render(view)
    return view, shown, grid


def main(arguments):
    folder = arguments[0] if arguments else os.environ.get("CLATHRA_RUN", ".")
    if not os.path.isfile(os.path.join(folder, "particles.xdmf")):
        raise SystemExit(f"paraview_run.py: {folder} holds no run (no particles.xdmf)")
    if len(arguments) > 1:
        GetActiveViewOrCreate("RenderView").ViewSize = [600, 400]
    view, _, _ = show(folder, arguments[2] if len(arguments) > 2 else None)
    if len(arguments) > 1:
        SaveScreenshot(arguments[1], view, ImageResolution=[1200, 800])


if __name__ in ("__main__", "__vtkconsole__"):
    main([a for a in sys.argv[1:] if not a.startswith("-")])
