"""Rigid footings on Mohr-Coulomb ground at their collapse load: cases, exact loads and how to run them."""
from pathlib import Path

import numpy as np

from common import Run, scratch

STRIP = Path(__file__).parent / "cases" / "strip.yaml"
CIRCLE = STRIP.with_name("circle.yaml")
COX = 141 * 1.6e3  # Pa
END = 0.0632  # s
# name: friction (deg), cohesion, surcharge (MPa), exact mean pressure (MPa), width and depth of the ground (half-widths), settlement
STRIPS = {
    "Prandtl": (0, 1, 0, 5.14159, 3.5, 1.5, 3.6e-4),
    "Nc, 20 deg": (20, 1, 0, 14.8347, 4.25, 1.5, 6e-4),
    "Nq, 20 deg": (20, 0, 1, 6.3994, 4.25, 1.5, 3.8e-4),
    "Nc, 30 deg": (30, 1, 0, 30.1396, 6, 2, 1.6e-3),
    "Nq, 30 deg": (30, 0, 1, 18.4011, 6, 2, 7e-4),
}
IMPLICIT = ("-inertia", "no", "-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", f"{END / 30} s", "-stabilisation_ghost_penalty", "1e-3",
            "-bc_plate_velocity")  # fmt: skip


def saturated():
    """The strip on saturated ground that nothing leaves: without friction it carries the same."""
    text = STRIP.read_text()
    for old, new in (
        ("fields: m\n", "fields: hm\nambient: {pressure: 1 MPa}\n"),
        ("{density: 2600 kg/m^3}\n", "{density: 2600 kg/m^3}\n    water: {density: 1000 kg/m^3, bulk_modulus: 20 GPa, viscosity: 1e-3 Pa s, ref_pressure: 1 MPa}\n"
         "    permeability: {k0: 1e-14 m^2, porosity_law: none, hydrate_law: none}\n"),
        ("[2, 2], stress", "[2, 2], pressure: 1 MPa, temperature: 20 degC, stress"),
    ):  # fmt: skip
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    path = scratch() / "case.yaml"
    path.write_text(text)
    return path


def strip_run(name, cells, rough, *more, implicit=False, case=STRIP):
    """A strip with `cells` cells a half-width."""
    phi, c, q, _, width, depth, settles = STRIPS[name]
    if implicit:
        motion = (*IMPLICIT, f"{-settles / END:.17g} m/s")
    else:
        fast = settles / (0.505 * END)
        motion = ("-bc_plate_velocity_table", f"0 s, {-fast} m/s, {0.4 * END} s, {-fast} m/s, {0.5 * END} s, {-0.1 * fast} m/s, {END} s, {-0.1 * fast} m/s")
    top = depth + max(0.25, 1 / cells)
    return Run.of_case(case, "-quiet", "-grid_upper", f"{width} m, {top} m", "-grid_cells", f"{round(width * cells)},{round(top * cells)}",
                       "-region_ground_upper", f"{width} m, {depth} m", "-bc_right_position", f"{width} m", "-bc_plate_rough", "yes" if rough else "no",
                       "-mat_soil_plasticity_friction_peak", f"{phi} deg", "-mat_soil_plasticity_dilation_max", f"{phi} deg",
                       "-mat_soil_plasticity_cohesion_max", f"{c} MPa", *(("-ambient_pressure", f"{q} MPa") if q else ()),
                       "-region_ground_stress", ",".join(3 * [f"{-q} MPa"] + 3 * ["0 Pa"]), *motion, *more, exit_code=(0, 3))  # fmt: skip


def strip(*arguments, **more):
    """Settlement (half-widths) and mean pressure under the plate (MPa) of a strip_run: (n,), (n,)."""
    m = strip_run(*arguments, **more).csv("meters.csv")
    return -m["plate.position_m"], m["plate.force_N"] / 1e6 + STRIPS[arguments[0]][2]  # the surcharge is ambient, the plate bears what is beyond it


def collapse(u, load):
    """Collapse load: the mean over the last fifth of the settlement, or of what was reached of it; and how much it still grows there."""
    late = u >= 0.8 * u[-1]
    return load[late].mean(), load[-1] / load[late][0] - 1


def circle(cells, strain, softer=1, end=1.0, timeout=800, kind="euler"):
    """Load over Cox's, and its growth over the last fifth of the settlement; cells over the radius, E and the penalty as in the file or softer, to
    the share `end` of the settlement; the ground as deep as in the file or to the next line of the grid."""
    deep = f"4 m, {np.ceil(1.75 * cells) / cells:.15g} m"
    soft = ("-mat_soil_elasticity_E0", f"{16 / softer} GPa", "-bc_plate_velocity", f"{-6e-5 * softer} m/s", "-stabilisation_ghost_penalty", 1e-6 * softer)
    run = Run.of_case(CIRCLE, "-quiet", "-grid_cells", f"{4 * cells},{2 * cells}", "-region_ground_upper", deep, "-mean_strain", strain, "-time_end", f"{end} s",
                      "-output_times", f"{end} s", "-stepper_type", kind, *(soft if softer != 1 else ()), exit_code=(0, 3), timeout=timeout)  # fmt: skip
    m = run.csv("meters.csv")
    u, load = -m["plate.position_m"], m["plate.force_N"] / np.pi / COX
    return load[-1], load[-1] / np.interp(0.8 * u[-1], u, load) - 1


def exact(name):
    return STRIPS[name][3]


def order(h, load, want):
    error = np.abs(np.asarray(load) / want - 1)
    return np.log(error[:-1] / error[1:]) / np.log(np.asarray(h)[:-1] / np.asarray(h)[1:])
