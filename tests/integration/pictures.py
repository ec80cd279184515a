#!/usr/bin/python3
"""Pictures of scripts/plot.py: a sheared body is drawn whole, in cells that are no squares; which pictures there are of what run."""
import subprocess
import sys
from pathlib import Path

import numpy as np
from matplotlib.path import Path as Outline

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, ROOT, binary, check, check_true, finish, launch, run, scratch  # noqa: E402

import clathra  # noqa: E402
from clathra import shown  # noqa: E402
from plotting import boxes, plt  # noqa: E402


def draw(out):
    """Names of the pictures that plot.py makes, and what it says."""
    done = subprocess.run([sys.executable, ROOT / "scripts" / "plot.py", out], capture_output=True, text=True)
    check_true(f"plot.py {out.name} ends well", done.returncode == 0, done.stderr[-300:])
    return sorted(p.stem for p in (out / "figures").glob("*.png")), done.stdout


def holes(particles, first):
    """Share of white pixels inside the outline of the body, a pixel away from its edge."""
    figure = plt.figure(figsize=(5, 5), dpi=100)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.axis("off")
    boxes(axes, particles, np.zeros(len(particles["id"])), -1, 1, first)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].astype(int)
    corner, x = shown.corners(particles, first), first["position"]
    left, right = (np.isclose(x[:, 0], f(x[:, 0])) for f in (np.min, np.max))
    up = np.argsort(x[left, 1])
    outline = np.concatenate([corner[left][up][:, [0, 3]].reshape(-1, 2), corner[right][up][::-1][:, [2, 1]].reshape(-1, 2)])
    shape = Outline(axes.transData.transform(outline))
    rows, columns = np.mgrid[0:500, 0:500]
    inside = shape.contains_points(np.c_[columns.ravel() + 0.5, 499.5 - rows.ravel()]).reshape(500, 500)
    for k in (0, 1):
        for step in (-1, 1):
            inside &= np.roll(inside, step, k)
    plt.close(figure)
    return (pixels[inside].min(axis=1) > 200).mean(), inside.mean()


def main():
    block, failed, upright = scratch() / "block", scratch() / "failed", scratch() / "upright"
    run(binary(), CASES / "shear_box", "-grid_cells", "32,5", out=block)
    body = clathra.Run(block)
    white, share = holes(body.particles(), body.particles(0))
    check_true("the sheared block fills a part of the picture", 0.5 < share < 0.95, f"{share:.2f}")
    check("white pixels in it", white, 0.0)
    names, _ = draw(block)
    check_true("pictures of a body", names == ["balance", "maps", "particles", "probes"], names)
    launch(binary(), CASES / "bp2", "-grid_cells", "13,1", "-output_times", "0 s", "-stepper_dt", "10 s", "-stepper_dt_min", "9 s", "-bc_load_normal", "1e5 MPa", out=failed)
    names, said = draw(failed)
    check_true("a run without a step has no empty axes", names == [] and "nothing to draw yet" in said, names)
    run(binary(), CASES / "gravity_column", out=upright)
    names, _ = draw(upright)
    check_true("pictures of a strip", "profiles" in names and "particles" not in names, names)
    finish()


main()
