#!/usr/bin/python3
"""docs/readme_figures.ipynb: every cell runs, on runs that are there and on none; its curves are those of the runs."""
import contextlib
import io
import json
import os
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, ROOT, binary, check, check_true, finish, launch, scratch  # noqa: E402

import clathra  # noqa: E402
from clathra.plotting import plt  # noqa: E402

RUNS = {  # folder of the results: case, options that make it short
    "bp2/case2": ("bp2", "-time_end", "30 s", "-output_times", "0 s,30 s"),
    "masuda": ("masuda", "-time_end", "5 min", "-output_times", "0 s,5 min"),
    "slope_c/theta_0.5": ("slope_c", "-grid_cells", "90,4", "-gravity_ramp", "0.2 s", "-stage_load_end", "0.2 s", "-stage_slide_end", "0.4 s", "-output_every", "0.2 s"),
}  # fmt: skip


def execute(results):
    """(figures, what the cells print) of the notebook on a folder of results; an error of a cell is the test's."""
    cells = json.loads((ROOT / "docs" / "readme_figures.ipynb").read_text())["cells"]
    said, space, before = io.StringIO(), {}, Path.cwd()
    os.environ["CLATHRA_RESULTS"] = str(results)
    os.chdir(ROOT / "docs")
    try:
        with contextlib.redirect_stdout(said):
            for k, cell in enumerate(c for c in cells if c["cell_type"] == "code"):
                exec(compile("".join(cell["source"]), f"code cell {k + 1}", "exec"), space)
    finally:
        os.chdir(before)
        del os.environ["CLATHRA_RESULTS"]
    figures = [plt.figure(n) for n in plt.get_fignums()]
    return figures, said.getvalue()


plt.show = lambda: None
results = scratch()
figures, said = execute(results / "none")
check_true("without runs: no figure, and three lines that say so", not figures and said.count("holds no run") == 3, said)
for folder, (case, *options) in RUNS.items():
    done = launch(binary(), CASES / case, "-quiet", *options, out=results / folder, timeout=100)
    check_true(f"{case}: short run", done.returncode == 0, done.stdout[-300:])
figures, said = execute(results)
check_true("with runs: three figures, and no run is missed", len(figures) == 3 and "no run" not in said, said)
bp2, masuda, slope = figures
probe = clathra.Run(results / "bp2" / "case2").probe("surface")
drawn = bp2.axes[3].lines[1]
check("BP2: the curve of the loaded end is the probe's (mm)", np.max(np.abs(drawn.get_ydata() - 1e3 * probe["u_x_m"])), 1e-12)
check("BP2: ... and near the reference after half a minute (of what it has moved)",
      abs(drawn.get_ydata()[-1] / np.interp(30, *bp2.axes[3].lines[0].get_data()) - 1), 0.005)  # fmt: skip
check_true("Masuda: curves and reference in each panel", all(len(a.lines) in (2, 4) and len(a.lines[1].get_xdata()) > 5 for a in masuda.axes), "")
particles = clathra.Run(results / "slope_c" / "theta_0.5").particles()
check_true("slope C: every particle is drawn", len(slope.axes[0].collections[0].get_offsets()) == len(particles["id"]), "")
finish()
