#!/usr/bin/env python3
"""No checkerboard in the pressure under a strip load on clay.

Row 12: no checkerboard in the pressure under a strip load on clay, with k = 1e-16 m^2 (undrained) and 1e-10 m^2,
and a checkerboard that is there goes.

The high-pass part of the particles' pressure is its deviation from the field smoothed with the weights (1 2 1)/4 along both
axes, over particles one cell apart: a checkerboard of nodal pressures stays in, a harmonic field (the undrained p) falls
out.  What remains with stabilisation sits at the drained surface and the strip's edge; the second measure leaves out the
uppermost four cells.

At 1e-16 m^2 the pressure projection (23) holds it, at 1e-10 m^2 the drag. What the flux interpolation (20) is for are
pressures that alternate from node to node: the nodal flux of such a one is zero.
"""
import sys
from pathlib import Path

import numpy as np

from common import Run, finish, judge, scratch, table

CASE = Path(__file__).parent / "cases" / "strip_load.yaml"
P0, Q, N, H = 1e6, 1e4, 20, 0.05  # Pa, Pa, cells, m


def lattice(run):
    """(rows, columns) excess pressure of the particles by their place at the start, Pa."""
    v = run.snapshot(1.0)
    start = v["position"] - v["displacement"]
    index = np.floor(start / (H / 2)).astype(int)
    p = np.full((2 * N - 1, 2 * N), np.nan)
    p[index[:, 1], index[:, 0]] = v["p"][:, 0] - P0
    return p


def high_pass(p):
    """Deviation of the inner particles from the field smoothed over neighbours one cell (two particles) away, Pa."""
    smooth = (p[:-4] + 2 * p[2:-2] + p[4:]) / 4
    return p[2:-2, 2:-2] - (smooth[:, :-4] + 2 * smooth[:, 2:-2] + smooth[:, 4:]) / 4


STRIPES = """title: stripes of pressure
grid: {lower: [0 m, 0 m], upper: [1 m, 0.1 m], cells: [10, 1]}
fields: [water]
materials: [rock]
mat: {rock: {porosity: 0.4, solid: {density: 2600 kg/m^3}, elasticity: {E0: rigid}, permeability: {k0: 1e-12 m^2, porosity_law: none, hydrate_law: none}}}
regions: [%s]
region:
%s
boundaries: []
time: {end: 10 ms}
stepper: {type: sdirk2, adapt: no, dt: 0.2 ms}
output: {times: [0 s, 10 ms]}
probes: []
"""


def stripes():
    """What is left after six times h^2 over the diffusivity of stripes of +-10 kPa, a cell wide about each node of closed rock, far from the ends."""
    edges = [0.0, *(0.05 + 0.1 * k for k in range(10)), 1.0]
    boxes = [f"  s{k}: {{lower: [{a!r} m, 0 m], upper: [{b!r} m, 0.1 m], particles_per_cell: [2, 2], material: rock, pressure: {1e6 + (-1) ** k * 1e4!r} Pa, temperature: 4 degC}}"
             for k, (a, b) in enumerate(zip(edges, edges[1:]))]  # fmt: skip
    case = scratch() / "stripes.yaml"
    case.write_text(STRIPES % (", ".join(f"s{k}" for k in range(len(boxes))), "\n".join(boxes)))
    rows = []
    for scheme, own in (("sdirk2", ()), ("hybrid", ("-stepper_type", "hybrid", "-stepper_adapt", "yes"))):
        snapshots = Run.of_case(case, "-quiet", *own).snapshots()
        first, last = (np.ptp(v["p_w"][abs(v["position"][:, 0] - 0.5) < 0.2]) for _, v in (snapshots[0], snapshots[-1]))
        rows.append((scheme, last / first))
        judge(12, f"stripes of pressure, {scheme}: left after 10 ms", last / first, 2e-3)
    table(("integrator", "left of the stripes"), rows)


def picture(fields, path):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, len(fields), figsize=(4.2 * len(fields), 3.8), squeeze=False)
    for ax, (title, p) in zip(axes[0], fields.items()):
        shown = ax.imshow(p / Q, origin="lower", extent=(0, 1, 0, 1), cmap="viridis")
        ax.set(title=title, xlabel="x (m)", ylabel="y (m)")
        figure.colorbar(shown, ax=ax, label="excess p / q", shrink=0.8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main():
    rows, fields = [], {}
    rms = lambda a: np.sqrt(np.mean(a**2)) / Q
    for k in ("1e-16", "1e-10"):
        p = lattice(Run.of_case(CASE, "-mat_clay_permeability_k0", f"{k} m^2"))
        fields[f"k = {k} m$^2$"] = p
        rows.append((k, rms(high_pass(p)), rms(high_pass(p)[:-6]), np.min(p) / Q, np.max(p) / Q))
        judge(12, f"strip load, k = {k} m2: high-pass rms of p over q", rms(high_pass(p)), 5e-3)
    table(("k (m2)", "rms high-pass p/q", "below 4 cells", "smallest p/q", "largest p/q"), rows)
    stripes()
    if len(sys.argv) > 2:  # a file name for the picture
        picture(fields, sys.argv[2])
    finish()


if __name__ == "__main__":
    main()
