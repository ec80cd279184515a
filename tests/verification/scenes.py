#!/usr/bin/env python3
"""The scenes cases/shear_box and cases/sea_floor on coarse grids, to their end.

shear_box: the motion under 10 MPa is that under 0.1 MPa.  sea_floor: a column in the middle against consolidation in one
dimension; a dipping contact of sand and clay of very different permeability stays at rest.
"""
import numpy as np

import _sea_floor as floor
from common import Run, check, finish, judge

TIGHT = ("-quiet", "-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10")


def shear_box():
    def corner(*options):
        u = Run.of_case("shear_box", *TIGHT, "-grid_cells", "16,10", *options).probe("corner")
        return np.column_stack((u["u_x_m"], u["u_y_m"]))

    deep = corner()
    shallow = corner("-ambient_pressure", "0.1 MPa", "-region_block_pressure", "0.1 MPa", "-mat_soft_water_ref_pressure", "0.1 MPa")
    judge("scenes", "shear_box: motion under 10 MPa against that under 0.1 MPa", np.abs(deep - shallow).max() / np.abs(deep).max(), 1e-6)
    check("shear_box: u_x of the corner (m)", deep[-1, 0], (0.06, 0.07))


def contact():
    """Growing pressures at the contact: water at 1e-5 m/s after a day, if the projection in (20) does not weigh with k_0."""
    run = Run.of_case("sea_floor", "-quiet", "-grid_cells", "20,28", "-stage_settle_stepper_type", "sdirk2", "-stage_settle_stepper_dt", "5000 s",
                      "-stepper_max_steps", "20", "-output_times", "100000 s")  # fmt: skip
    judge("scenes", "sea_floor: flow of water at rest (m/s)", np.abs(run.snapshot(1e5)["v_w"]).max(), 1e-7)


def sea_floor():
    """Excess pressure and rise of a column in the middle, at the end of the fall, five and fifty years later."""
    seen = Run.of_case("sea_floor", "-quiet", "-grid_cells", "10,56").snapshots()
    start = next(v for t, v in seen if t == floor.SETTLED)
    for t, v in seen[-3:]:
        t -= floor.SETTLED
        depth, (e,), (rise,) = floor.column(t)
        x = start["initial_position"]
        middle = np.abs(x[:, 0] - 100) < 10.1  # two columns of particles
        below = 50 - floor.DIP * x[middle, 0] - x[middle, 1]
        excess = (v["p"] - start["p"])[middle, 0] + floor.FALL
        error = np.abs(excess - np.interp(below, depth, e)).mean() / floor.undrained("clay")
        judge("scenes", f"sea_floor: excess pressure of a column {t / floor.YEAR:.3g} years after the fall began, mean error over the undrained", error, 0.08)
        check("... rise of the floor over the exact", v["displacement"][middle, 1][np.argmin(below)] / rise, (0.84, 1.02))


shear_box()
contact()
sea_floor()
finish()
