#!/usr/bin/env python3
"""cases/biaxial on a coarse grid to 1 % of strain: sdirk2 and hybrid agree.

cases/biaxial on a coarse grid to 1 % of axial strain, by sdirk2 and by hybrid: undrained compression of a softening sample under a
rough plate.  The stress under the plate and the changes of volume and pressure agree; the sample yields, so that it bears less than
elastic.  Without kinetics sdirk2 goes on through the bands to 9 %, where a dilating particle leaves slivers at nodes.
"""
import re

import numpy as np

from common import Run, check, finish, judge, table

COARSE = ("-quiet", "-grid_cells", "8,21", "-time_end", "0.45 s", "-output_every", "0.45 s", "-output_probe_every", "0.01 s")
ELASTIC = 600e6 / (1 - 0.33**2)  # plane strain, and then the stiffness of what is in the pores is left out


def end(kind):
    run = Run.of_case("biaxial", *COARSE, "-stepper_type", kind)
    m, v = run.csv("meters.csv"), [s for _, s in run.snapshots()]
    strain = -m["top.position_m"] / 4
    return m["time_s"], strain, m["top.stress_Pa"], v[-1]["volume"].sum() / v[0]["volume"].sum() - 1, v[-1]["p"].min()


time, strain, implicit, volume, least = end("sdirk2")
_, _, hybrid, volume_h, least_h = end("hybrid")
at = strain > 0.002  # while the plate starts, the sample rings
table(["axial strain", "sdirk2 (MPa)", "hybrid (MPa)"], [[strain[k], implicit[k] / 1e6, hybrid[k] / 1e6] for k in range(5, len(time), 5)])
table(["", "change of volume", "least p (MPa)"], [["sdirk2", volume, least / 1e6], ["hybrid", volume_h, least_h / 1e6]])
check("axial strain at the end", strain[-1], (0.0099, 0.0101))
judge("strength", "biaxial compression to 1 %: stress under the plate, hybrid against sdirk2", np.max(np.abs(hybrid[at] / implicit[at] - 1)), 0.03)
judge("strength", "biaxial compression to 1 %: change of volume, hybrid against sdirk2 (share of the axial strain)", abs(volume_h - volume) / strain[-1], 0.02)
check("least pore pressure, hybrid over sdirk2", least_h / least, (0.97, 1.03))
check("stress at 1 % over the elastic one", implicit[-1] / (ELASTIC * strain[-1]), (0.4, 0.9))

bands = Run.of_case("biaxial", "-quiet", "-grid_cells", "8,21", "-time_end", "3.7 s", "-mat_sand_kinetics_active", "no")
check("refused steps of sdirk2 to 9 % without kinetics", int(re.search(r"(\d+) refused", (bands.out / "summary.txt").read_text()).group(1)), (0, 8))
finish()
