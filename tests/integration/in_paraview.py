#!/usr/bin/python3
"""Results in ParaView itself, written by one and by two ranks: every reader of XDMF gives the particles and the grid under names of their own,
at their times, with every array as the files hold it; scripts/paraview_run.py draws every particle in the colour of its value.

Without ParaView (python3-paraview; xvfb where there is no screen) nothing is looked at, and the test says so.
"""
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, check, check_true, finish, program_of, run, scratch  # noqa: E402

import clathra  # noqa: E402
from clathra.plotting import plt  # noqa: E402

INSIDE = Path(__file__).with_name("_in_paraview.py")
READERS = ("XDMFReader", "Xdmf3ReaderS", "Xdmf3ReaderT")  # the last two are the new one, for files in space and in time
BLOCK = ("shear_box", "-grid_cells", "16,5")
GRADED = ("shear_box", "-grid_cells", "16,auto", "-grid_spacing_y", "{table: [0 m, 0.1 m, 1.25 m, 0.3 m]}")
SPACE = ("footing_3d", "-time_end", "0.5 d", "-output_times", "0 d,0.25 d,0.5 d", "-grid_spacing_x_table", "0 m,2 m,10 m,2 m", "-grid_spacing_y_table", "0 m,2 m,7 m,1 m,8.5 m,0.75 m",
         "-grid_spacing_z_table", "0 m,2 m,10 m,2 m")  # fmt: skip
COLUMN = ("bp2", "-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s")


def paraview(folder, out, *picture):
    """pvpython on a run; a picture wants a screen, which must outlive the first window on it."""
    screen = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24 -noreset"] if picture and not os.environ.get("DISPLAY") else []
    return subprocess.run([*screen, "pvpython", INSIDE, folder, out, *picture], capture_output=True, text=True, stdin=subprocess.DEVNULL)


def check_reader(name, reader, kind, read, done):
    wanted = done.particles() if kind == "particles" else done.grid()
    times = done.times if kind == "particles" else done.times[1:]
    arrays = {k[6:]: v for k, v in read.items() if k.startswith("array:")}
    names = set(wanted) - {"position", "vertex", "x", "y", "z"}
    what = f"{name}, {reader}, {kind}"
    check_true(f"{what}: its times", read["times"].tolist() == times.tolist(), read["times"].tolist())
    if reader == "XDMFReader":  # the others name none
        first = len(done.times) - len(times)
        check_true(f"{what}: named blocks", read["blocks"].tolist() == [f"{kind}_{k:06d}" for k in range(first, len(done.times))], read["blocks"].tolist()[:2])
    check_true(f"{what}: {len(names)} named arrays", set(arrays) == names, sorted(set(arrays) ^ names))
    bad = [a for a in names & set(arrays) if not same(arrays[a], wanted[a])]
    check_true(f"{what}: values as the file holds them", not bad, bad)
    lines = [wanted[d] for d in "zyx" if d in wanted]  # x runs fastest
    places = wanted["position"] if kind == "particles" else np.stack(np.meshgrid(*lines, indexing="ij")[::-1], -1).reshape(-1, len(lines))
    axes = places.shape[1]
    there = read["points"].shape == (len(places), 3) and np.allclose(read["points"][:, :axes], places, rtol=0, atol=1e-12) and not read["points"][:, axes:].any()
    check_true(f"{what}: {len(places)} points in their places", there and str(read["kind"]) != "vtkMultiBlockDataSet", str(read["kind"]))


def same(a, b):
    a, b = a.ravel(), np.asarray(b).ravel()
    return a.size == b.size and np.array_equal(a, b.astype(a.dtype), equal_nan=a.dtype.kind == "f")


def check_picture(name, path, camera, done):
    """The colour in the middle of every particle is that of its value, on a white ground."""
    image = (plt.imread(path)[:, :, :3] * 255).astype(int)
    high, wide = image.shape[:2]
    particles = done.particles()
    check_true(f"{name}: it shows what differs from place to place", str(camera["array"]) == "displacement_vector", str(camera["array"]))
    values = np.hypot(*particles["displacement"].T)
    metre = 0.5 * high / float(camera["scale"])
    at = np.rint(np.c_[0.5 * high - metre * (particles["position"][:, 1] - camera["focus"][1]), 0.5 * wide + metre * (particles["position"][:, 0] - camera["focus"][0])]).astype(int)
    wanted = 255 * plt.get_cmap("viridis")((values - values.min()) / np.ptp(values))[:, :3]
    # Between the lines of the grid, which are drawn over the particles.
    off = np.abs(np.array([[image[y + j, x + i] for i in (-2, 2) for j in (-2, 2)] for y, x in at]) - wanted[:, None]).max(axis=2).min(axis=1)
    check(f"{name}: colours of the particles, levels of 255", off.max(), 3)
    white, coloured = (image.min(axis=2) > 250).mean(), (np.ptp(image, axis=2) > 40).mean()
    body = np.ptp(particles["position"], axis=0).prod() * metre**2 / (high * wide)
    check(f"{name}: coloured share of the picture over the body's", coloured / body, (0.85, 1.5))
    check(f"{name}: white share of the picture", white, (0.2, 1 - body))
    check_true(f"{name}: title, time, particles and grid are in the pipeline", {"title", "time", "particles", "grid"} <= set(camera["sources"].tolist()), camera["sources"].tolist())


def main():
    if not shutil.which("pvpython") or not (os.environ.get("DISPLAY") or shutil.which("xvfb-run")):
        print("SKIP no ParaView: python3-paraview, and xvfb where there is no screen, are not installed; what it reads was not looked at")
        finish()
        return
    for name, (case, *options), ranks in (("block of graded cells", GRADED, 1), ("block on 2 ranks", BLOCK, 2), ("column on 2 ranks", COLUMN, 2), ("ground in space on 2 ranks", SPACE, 2)):
        out, found = scratch() / "out", scratch() / "found"
        run(program_of(case), CASES / case, "-quiet", *options, out=out, ranks=ranks)
        found.mkdir(exist_ok=True)
        drawn = name == "block on 2 ranks"
        said = paraview(out, found, *([found / "picture.png"] if drawn else []))
        check_true(f"{name}: pvpython ends well", said.returncode == 0, (said.stdout + said.stderr)[-600:])
        done = clathra.Run(out)
        for reader in READERS:
            for kind in ("particles", "grid"):
                with np.load(found / f"{reader}.{kind}.npz") as read:
                    check_reader(name, reader, kind, read, done)
        if drawn:
            with np.load(found / "camera.npz") as camera:
                check_picture(name, found / "picture.png", camera, done)
    finish()


main()
