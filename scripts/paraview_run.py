"""Shows a run in ParaView: its particles as wide and high as they are, coloured by a quantity, over the wire frame of the grid, with title and time.

  paraview --script=scripts/paraview_run.py            asks for nothing: the run is $CLATHRA_RUN, or the folder ParaView was started in
  pvpython scripts/paraview_run.py FOLDER [PICTURE.png [ARRAY]]   writes a picture of the last time (where there is no screen: SCREEN below)
  in ParaView: Macros, Import new macro ..., then the button; it takes the same folder

Vectors of the plane have two components; Calculators make the displacement and the velocity of the water vectors of space, for Glyph
and Warp By Vector.
"""
import os
import re
import sys

from paraview.simple import (AnnotateTimeFilter, Calculator, ColorBy, GetActiveViewOrCreate, GetAnimationScene, GetColorTransferFunction, GetScalarBar, Glyph,
                             Render, ResetCamera, SaveScreenshot, Show, Text, XDMFReader)  # fmt: skip

FIRST = ("S_h", "p", "T")  # what is shown unless an array is named: the first of these that there is and that differs by a thousandth,
VECTORS = ("displacement", "v_w")  # ... or the length of the first of these
UNITS = {"porosity": "–", "T": "°C", "displacement": "m", "stress": "Pa", "volume": "m³", "p": "Pa", "S_": "–", "v_": "m/s", "mass_": "kg"}  # by first letters
SCREEN = 'xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" pvpython ...'
TIMES = ((3.15576e7, "a"), (86400.0, "d"), (3600.0, "h"), (60.0, "min"), (1.0, "s"))


def calculated(source, name, function):
    """The array `name` of three components."""
    found = Calculator(registrationName=name, Input=source)
    found.ResultArrayName, found.Function = name, function
    return found


def axes(particles):
    """How many the run has."""
    return particles.PointData["half_length"].GetNumberOfComponents()


def boxes(particles):
    """Every particle as the rectangle, in space the box, of its half lengths, in the middle of which it lies."""
    space = axes(particles) == 3
    size = calculated(particles, "size", '2*"half_length_X"*iHat+2*"half_length_Y"*jHat+' + ('2*"half_length_Z"*kHat' if space else "kHat"))
    found = Glyph(registrationName="body", Input=size, GlyphType="Box" if space else "2D Glyph")
    if not space:
        found.GlyphType.GlyphType, found.GlyphType.Filled = "Square", 1
    found.OrientationArray, found.ScaleArray, found.VectorScaleMode = ["POINTS", "No orientation array"], ["POINTS", "size"], "Scale by Components"
    found.ScaleFactor, found.GlyphMode = 1.0, "All Points"
    return found


def unit(array):
    return next((u for start, u in UNITS.items() if array.startswith(start)), "")


def first(particles):
    """The array to begin with."""
    there = particles.PointData.keys()
    ranges = {name: particles.PointData[name].GetRange() for name in FIRST if name in there}
    differs = [name for name, (low, high) in ranges.items() if high - low > 1e-3 * max(abs(low), abs(high))]
    return next(name for name in (*differs, *(f"{v}_vector" for v in VECTORS if v in there), *ranges, *there))


def title(folder):
    """What the case calls itself."""
    try:
        with open(os.path.join(folder, "case.yaml"), encoding="utf-8") as text:
            found = re.search(r"^title: *(.*)$", text.read(), re.M)
    except OSError:
        found = None
    return found[1].strip("'\"").replace("''", "'") if found else os.path.basename(os.path.abspath(folder))


def words(view, folder, particles, end):
    """The case's name and the time, in the upper left corner."""
    scale, name = next((s, n) for s, n in TIMES if end >= 2 * s or s == 1.0)
    line = Show(Text(registrationName="title", Text=title(folder)), view)
    clock = Show(AnnotateTimeFilter(registrationName="time", Input=particles, Format="t = {time:g} " + name, Scale=1.0 / scale), view)
    for place, shown, size in ((0.94, line, 20), (0.89, clock, 18)):
        shown.WindowLocation, shown.Position, shown.FontSize, shown.Color = "Any Location", [0.02, place], size, [0, 0, 0]


def wires(grid, view):
    lines = Show(grid, view)
    lines.SetRepresentationType("Wireframe")
    ColorBy(lines, None)
    lines.Opacity, lines.AmbientColor = 0.3, [0.3, 0.3, 0.3]
    lines.DiffuseColor = lines.AmbientColor


def coloured(display, array, view):
    ColorBy(display, ("POINTS", array))
    display.RescaleTransferFunctionToDataRange(False, True)
    GetColorTransferFunction(array).ApplyPreset("Viridis (matplotlib)", True)
    display.SetScalarBarVisibility(view, True)
    bar, name = GetScalarBar(GetColorTransferFunction(array), view), array.replace("_vector", "")
    bar.Title, bar.ComponentTitle, bar.HorizontalTitle = f"{name} ({unit(name)})" if unit(name) else name, "", 1
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.TitleFontSize, bar.LabelFontSize, bar.RangeLabelFormat = 18, 16, "%.3g"
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.87, 0.25], 0.5


def show(folder, array=None):
    """Fills the active view; returns (view, particles, grid)."""
    view = GetActiveViewOrCreate("RenderView")
    particles, grid = (XDMFReader(registrationName=kind, FileNames=[os.path.join(folder, f"{kind}.xdmf")]) for kind in ("particles", "grid"))
    times = list(particles.TimestepValues)
    particles.UpdatePipeline(times[-1])
    shown = particles
    for name in VECTORS:
        if name in particles.PointData.keys():
            shown = calculated(shown, f"{name}_vector", "+".join(f'"{name}_{a}"*{e}' for a, e in zip("XYZ"[: axes(particles)], ("iHat", "jHat", "kHat"))))
    display = Show(boxes(shown), view)
    display.SetRepresentationType("Surface")
    display.Ambient, display.Diffuse = 1.0, 0.0  # colours as the bar has them
    if len(times) > 1:  # the first snapshot has no grid
        wires(grid, view)
    view.Background, view.UseColorPaletteForBackground = [1, 1, 1], 0
    view.OrientationAxesVisibility, view.InteractionMode = int(axes(particles) == 3), f"{axes(particles)}D"
    scene = GetAnimationScene()
    scene.UpdateAnimationUsingDataTimeSteps()
    scene.AnimationTime = view.ViewTime = times[-1]
    coloured(display, array or first(particles), view)
    words(view, folder, particles, times[-1])
    if axes(particles) == 3:
        view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [-1.2, 0.8, -1.3], [0, 0, 0], [0, 1, 0]
    ResetCamera(view)
    Render(view)
    return view, shown, grid


def main(arguments):
    folder = arguments[0] if arguments else os.environ.get("CLATHRA_RUN", ".")
    if not os.path.isfile(os.path.join(folder, "particles.xdmf")):
        raise SystemExit(f"paraview_run.py: {folder} holds no run (no particles.xdmf)")
    if len(arguments) > 1:
        if sys.platform == "linux" and not os.environ.get("DISPLAY"):
            print("paraview_run.py: no screen; a ParaView that needs one ends here: " + SCREEN + " gives it one", file=sys.stderr, flush=True)
        GetActiveViewOrCreate("RenderView").ViewSize = [1200, 800]
    view, _, _ = show(folder, arguments[2] if len(arguments) > 2 else None)
    if len(arguments) > 1:
        SaveScreenshot(arguments[1], view, ImageResolution=[1200, 800])


if __name__ in ("__main__", "__vtkconsole__"):
    main([a for a in sys.argv[1:] if not a.startswith("-")])
