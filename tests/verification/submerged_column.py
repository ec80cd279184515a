#!/usr/bin/env python3
"""Collapse of a column under water against the same in air with its buoyant weight.

Collapse of a column of ground without friction (cases/sand_column.yaml with cohesion alone) under water that is its pressure only,
(42), against the same column in air with the buoyant weight, g (1 - rho_a/rho): both have the same forces and the same inertia, since the
water has neither drag nor added mass, so they move alike but for the elastic compression by the water's pressure (less where the ground
is stiffer).  With friction they would differ: this ground has no pore water, so its grains bear the sea's pressure.
"""
from pathlib import Path

import numpy as np

from common import Run, finish, judge, table

CASE = Path(__file__).parent / "cases" / "sand_column.yaml"
RHO, WATER, G = 0.6 * 2650, 1000.0, 9.81  # kg/m^3, kg/m^3, m/s^2
SEA = ("-ambient_pressure", "0 Pa", "-ambient_density", f"{WATER} kg/m^3", "-ambient_level", "2 m")
KINDS = {"hybrid": ("1 s",), "sdirk2": ("0.5 s", "-stepper_type", "sdirk2", "-stepper_dt", "0.01 s", "-stepper_tol", "1e-2", "-stabilisation_ghost_penalty", "1e-3")}


def collapse(kind, E, g, *more):
    """Displacements (n, 2) at the end."""
    end, *options = KINDS[kind]
    return Run.of_case(CASE, "-quiet", "-grid_cells", "30,12", "-gravity", f"0 m/s^2,{-g} m/s^2", "-region_block_stress_geostatic", "1", "-mat_sand_elasticity_E0", f"{E} MPa",
                       "-mat_sand_plasticity_friction_peak", "0 deg", "-mat_sand_plasticity_dilation_max", "0 deg", "-mat_sand_plasticity_cohesion_max", "1.5 kPa",
                       "-time_end", end, "-output_every", "0 s", *options, *more).snapshots()[-1][1]["displacement"]  # fmt: skip


def apart(a, b):
    return np.max(np.hypot(*(a - b).T)) / np.max(np.hypot(*b.T))


if __name__ == "__main__":
    rows, off, air = [], {}, {}
    for kind, E in (("hybrid", 5), ("hybrid", 50), ("sdirk2", 5), ("sdirk2", 50)):
        air[kind, E] = collapse(kind, E, G * (1 - WATER / RHO))
        off[kind, E] = apart(collapse(kind, E, G, *SEA), air[kind, E])
        rows.append([kind, E, np.max(np.hypot(*air[kind, E].T)), off[kind, E]])
    table(["integrator", "E (MPa)", "largest displacement (m)", "under water off by, of it"], rows)
    for kind in KINDS:
        judge("slopes", f"column under water against its buoyant weight in air, {kind}: displacement, E = 5 MPa", off[kind, 5], 0.005)
        judge("slopes", f"... {kind}: what is left, of what is left in ground of a tenth of the stiffness", off[kind, 50] / off[kind, 5], 0.2)
    heavy = apart(collapse("hybrid", 5, G), air["hybrid", 5])
    judge("slopes", "column under water, planted: its whole weight: displacement off by", heavy, (1, 100), 0.01, "%")
    finish()
