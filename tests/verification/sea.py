#!/usr/bin/env python3
"""Bodies of any shape under the sea, against closed forms of rest and load.

Bodies of any shape under the sea: at rest where they weigh nothing, indifferent to the depth of the sea and to an all-round pressure,
loaded by a falling sea level and by the slope of the sea floor as closed forms say."""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, table

CASES = Path(__file__).parent / "cases"
ROW = "surfaces"
SHAPES = {"triangle": ("-region_body_polygon", "[[2.1 m, 1.1 m], [7.7 m, 1.3 m], [4.2 m, 4.4 m]]"),
          "circle": ("-region_body_circle", "5.1 m,2.4 m,1.7 m")}  # fmt: skip
# on the base: held there, it may lean
MOUNDS = {"triangle": ("-region_body_polygon", "[[2 m, 0 m], [8 m, 0 m], [4.2 m, 4 m]]"),
          "half circle": ("-region_body_circle", "5 m,0 m,2.6 m", "-region_body_lower", "none,0 m"),
          "hill": ("-region_body_below", "[[1.5 m, 0 m], [3 m, 2.5 m], [5.5 m, 1.5 m], [7 m, 3 m], [8.5 m, 0 m]]",
                   "-region_body_lower", "1.5 m,0 m", "-region_body_upper", "8.5 m,none"),
          "box with a hole": ("-regions", "body,hole", "-region_body_lower", "3 m,0 m", "-region_body_upper", "7 m,4 m", "-region_body_minus", "hole",
                              "-region_hole_circle", "5 m,2 m,0.8 m", "-region_hole_material", "none")}  # fmt: skip
BASE = ("-bc_base_type", "fixed", "-bc_base_axis", "y", "-bc_base_position", "0 m")
SIDES = ("left", "right", "top", "bottom")
OPEN = tuple(o for s in SIDES for o in (f"-bc_{s}_type", "pressure", f"-bc_{s}_side", s, f"-bc_{s}_pressure", "ambient"))


def walls(length):
    """Rollers at both ends, along x, and an open sea floor."""
    ends = (o for n, x in (("a", 0.0), ("b", length)) for o in (f"-bc_{n}_type", "roller", f"-bc_{n}_axis", "x", f"-bc_{n}_position", f"{x} m"))
    return ("-boundaries", "base,a,b,top", *ends, "-bc_top_type", "pressure", "-bc_top_side", "top", "-bc_top_pressure", "ambient")


TIGHT = ("-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10")


def body(*options, ranks=1):
    return Run.of_case(CASES / "sea_body.yaml", "-quiet", *options, ranks=ranks)


def last(run):
    return run.snapshots()[-1][1]


def rest():
    """As heavy as the water, with its pressure inside: nothing moves, wherever the body lies against the grid."""
    hybrid = ("-stepper_type", "hybrid", "-inertia", "yes", "-mat_mud_water_bulk_modulus", "1e13 Pa", "-stepper_dt", "1e-7 s", "-time_end", "1e-4 s",
              "-output_times", "0 s,1e-4 s")  # fmt: skip
    for shape, where in SHAPES.items():
        for name, options in (("quasi-static", TIGHT), ("sdirk2", (*TIGHT, "-inertia", "yes")), ("hybrid", hybrid)):
            v = last(body(*where, "-boundaries", ",".join(SIDES), *OPEN, *options))
            fastest = max(np.max(np.abs(v[k])) for k in ("v_s", "v_w"))
            # masses keep 1e-16, which stiff water (K = 1e13 Pa, for its density must not change with depth) turns into 1e-3 Pa; falling freely: 1e-3 m/s
            judge(ROW, f"{shape} in the sea, {name}: fastest velocity after the run (m/s)", fastest, 2e-9 if name == "hybrid" else 1e-11)


def deeper():
    """A heavier body settles on its base by as much under 50 m of water as under 150 m; pressure and total stress grow, nothing else."""
    for shape, where in MOUNDS.items():
        run = lambda level, ranks=1: last(body(*where, "-boundaries", ",".join(("base", *SIDES)), *BASE, *OPEN, *TIGHT, "-ambient_level", f"{level} m", "-region_body_pressure", f"{level / 100} MPa",
                                      "-mat_mud_solid_density", "2600 kg/m^3", ranks=ranks))  # fmt: skip
        shallow, deep = run(50), run(150)
        if shape == "hill":
            for ranks in (2, 4):
                got = run(50, ranks=ranks)
                worst = max(np.max(np.abs(got[k] - shallow[k])) / np.max(np.abs(shallow[k])) for k in ("position", "displacement", "stress", "p"))
                judge(ROW, f"{shape} in the sea: {ranks} ranks against 1", worst, 1e-9)
        size = lambda k: np.max(np.abs(shallow[k]))
        off = max(np.max(np.abs(deep[k] - shallow[k])) / size(k) for k in ("displacement", "stress"))
        judge(ROW, f"{shape} under 100 m more of sea: displacement and effective stress", off, 1e-6)
        judge(ROW, f"{shape} under 100 m more of sea: pressure less 1 MPa, over 1 MPa", np.max(np.abs(deep["p"] - shallow["p"] - 1e6)) / 1e6, 1e-6)


def leaning():
    """Dry bodies that lean by a third and more under a sideways weight: as without pressure under 10 MPa."""
    for shape, where in MOUNDS.items():
        run = lambda p, *more: last(Run.of_case(
            CASES / "sea_body.yaml", "-quiet", *where, "-boundaries", "base", *BASE, *TIGHT, "-fields", "solid", "-region_body_hydrostatic", "no",
            "-ambient_density", "0 kg/m^3", "-ambient_pressure", f"{p} MPa", "-region_body_stress", ",".join([f"{-p} MPa"] * 3 + ["0 Pa"] * 3),
            "-gravity", "600 m/s^2,0 m/s^2", "-gravity_ramp", "100 s", "-mat_mud_elasticity_E0", "5 MPa", *more))  # fmt: skip
        for name, options in (("sdirk2", ()), ("hybrid", ("-inertia", "yes", "-stepper_type", "hybrid", "-grid_upper", "12 m,5 m", "-grid_cells", "24,10", "-stepper_dt", "1e-3 s", "-gravity_ramp", "0.6 s",
                                                          "-time_end", "0.6 s", "-output_times", "0 s,0.6 s"))):  # fmt: skip
            free, pressed = run(0.0, *options), run(10.0, *options)
            u = free["displacement"]
            lean = np.max(np.abs(free["deformation_gradient"][:, 1]))
            check_true(f"{shape}, {name}: it leans", lean > 0.3, f"largest shear {lean:.2f}")
            judge(ROW, f"{shape} that leans, {name}: displacement under 10 MPa against none", np.max(np.abs(pressed["displacement"] - u)) / np.max(np.abs(u)), 1e-6)


def layers(depth, value, h):
    """Means over cells of h: strain is that of a cell, pressure the particle's, so stresses go up and down inside one."""
    cell = np.floor(depth / h + 1e-3).astype(int)
    mean = lambda a: np.array([np.mean(a[cell == k]) for k in np.unique(cell)])
    return mean(depth), mean(value)


def falling():
    """A column under a sea that falls by 100 m within a day: Terzaghi with a load that is taken off and a drain that follows it.

    With gamma = 1/M/(1/M + phi/K_w) the pore pressure follows a load undrained by gamma; what is left, (1 - gamma) dP, diffuses in from the
    drain with c = (k/mu)/(1/M + phi/K_w).
    """
    H, day, P, E, nu, K, phi, k = 10.0, 86400.0, -1e6, 1e9, 0.3, 2e9, 0.5, 2e-16
    M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    gamma, c = (1 / M) / (1 / M + phi / K), k / 1e-3 / (1 / M + phi / K)
    n = np.arange(400)[:, None]
    m = (n + 0.5) * np.pi

    def diffused(z, t):  # of a boundary value that grows by 1 a day and stays there after a day
        w = lambda s: s - H**2 / c * np.sum(2 / m**3 * np.sin(m * z / H) * (1 - np.exp(-(m**2) * c * s / H**2)), 0) if s > 0 else 0 * z
        return (w(t) - w(t - day)) / day

    rows, errors, cells = [], [], (10, 20)
    for count in cells:
        run = Run.of_case(CASES / "sea_body.yaml", "-quiet", "-region_body_lower", "0 m,0 m", "-region_body_upper", "0.5 m,10 m", "-grid_upper", "0.5 m,10.5 m",
                          "-grid_cells", f"1,{count * 21 // 20}", "-gravity", "0 m/s^2,-10 m/s^2", "-ambient_level_ramp", f"200 m,100 m,0 s,{day} s",
                          "-region_body_pressure", "2 MPa", *walls(0.5), "-bc_base_type", "roller", *BASE[2:],
                          "-mat_mud_elasticity_E0", f"{E} Pa", "-mat_mud_water_bulk_modulus", f"{K} Pa", "-mat_mud_permeability_k0", f"{k} m^2",
                          "-mat_mud_water_ref_pressure", "2 MPa", "-mat_mud_water_ref_temperature", "10 degC",
                          "-time_end", f"{2 * day} s", "-stepper_adapt", "yes", "-stepper_dt", "600 s", "-stepper_tol", "1e-4", "-output_times", f"0 s,{day} s,{2 * day} s",
                          "-probes", "top", "-probe_top_at", "0.25 m,10 m")  # fmt: skip
        worst = [0.0, 0.0, 0.0]
        start = run.snapshots()[0][1]
        for t in (day, 2 * day):
            v = run.snapshot(t)
            z = H - start["position"][:, 1]
            dp = P * (gamma * min(t, day) / day + (1 - gamma) * diffused(z, t))
            grid = (np.arange(2000) + 0.5) * H / 2000
            u = np.mean(P * (gamma * min(t, day) / day + (1 - gamma) * diffused(grid, t)) - P * min(t, day) / day) * H / M
            total = lambda s: layers(z, s["stress"][:, 1] - s["p"][:, 0], H / count)[1]
            worst[0] = max(worst[0], np.max(np.abs(v["p"][:, 0] - start["p"][:, 0] - dp)) / abs(P))
            worst[1] = max(worst[1], np.max(np.abs(total(v) - total(start) + P * min(t, day) / day)) / abs(P))
            worst[2] = max(worst[2], abs(run.at("top", "u_y_m", t) / u - 1))
        errors.append(worst)
        rows.append((float(count), *worst))
    table(("cells", "pore pressure", "total stress", "settlement"), rows)
    for q, (what, bar) in enumerate((("pore pressure, of 1 MPa", 5e-3), ("total stress, of 1 MPa", 2e-3), ("heave of the sea floor, relative", 5e-3))):
        judge(ROW, f"sea level falls by 100 m in a day: {what}", errors[-1][q], bar)


def slope():
    """A layer of 5 m on a base that dips by 10 degrees, far from its ends: tau = gamma' z sin b cos b, whether drained or not."""
    b, H, L = np.radians(10.0), 5.0, 100.0
    g = (10 * np.sin(b), -10 * np.cos(b))
    unit = (1 - 0.5) * (2600 - 1000) * 10
    for name, k in (("drained", "1e-9 m^2"), ("undrained", "1e-18 m^2")):
        errors = []
        for h in (1.0, 0.5):  # what is left is the ends' doing, 50 m away
            run = Run.of_case(CASES / "sea_body.yaml", "-quiet", "-region_body_lower", "0 m,0 m", "-region_body_upper", f"{L} m,{H} m", "-grid_upper", f"{L} m,{H + 1} m",
                              "-grid_cells", f"{int(L / h)},{int((H + 1) / h)}", "-gravity", f"{g[0]!r} m/s^2,{g[1]!r} m/s^2", "-region_body_datum", "50 m",
                              "-region_body_pressure", "1 Pa", "-mat_mud_solid_density", "2600 kg/m^3", "-mat_mud_permeability_k0", k,
                              *walls(L), *BASE,
                              "-mat_mud_elasticity_E0", "200 MPa", "-time_end", "1000 s", "-stepper_dt", "500 s", "-output_times", "0 s,1000 s")  # fmt: skip
            v = last(run)
            x, y = v["position"].T
            middle = np.abs(x - L / 2) < 3
            depth, tau = layers(H - y[middle], v["stress"][middle, 3], h)
            errors.append(np.max(np.abs(np.abs(tau) - unit * np.sin(b) * depth)) / (unit * np.sin(b) * H))
        judge(ROW, f"sea floor that dips by 10 degrees, {name}: shear stress, cells of 0.5 m", errors[-1], 0.01)


def sinks():
    """With the drag (152) a block tends to its terminal velocity; where it stood in the cells, ranks and restarts do not matter."""
    rho, g, C, H = 2650 * 0.6, 9.81, 1.2, 0.4
    limit, pull = np.sqrt(2 * (rho - 1000) * g * H / (1000 * C)), (1 - 1000 / rho) * g
    ends = []
    for kind, options in (("sdirk2", ("-stepper_type", "sdirk2")), ("hybrid", ("-stepper_type", "hybrid", "-stepper_adapt", "yes"))):
        run = Run.of_case(CASES / "sinking.yaml", "-quiet", *options)
        t, moved = run.time, run.probe("middle")["u_y_m"]
        exact = limit**2 / pull * np.log(np.cosh(pull * t / limit))
        judge(ROW, f"sinking block, {kind}: way, off the closed form, of the whole", np.max(np.abs(moved + exact)) / exact[-1], 5e-3)
        v = last(run)["v_s"][:, 1].mean()
        judge(ROW, f"sinking block, {kind}: velocity over the terminal one", v / (-limit * np.tanh(pull * t[-1] / limit)), (0.99, 1.01))
        b = {k: w[-1] for k, w in run.balance.items()}
        given = b["gravity_work_J"] + b["load_work_J"]  # load: buoyancy and drag
        check(f"sinking block, {kind}: what the works of weight, buoyancy and drag leave, of the first", abs(b["energy_remainder_J"]) / b["gravity_work_J"], 2e-3)
        check(f"sinking block, {kind}: kinetic energy over those works", b["kinetic_energy_J"] / given, (0.98, 1.0))
        two = last(Run.of_case(CASES / "sinking.yaml", "-quiet", *options, ranks=2))
        check(f"sinking block, {kind}: 2 ranks against 1", np.max(np.abs(two["v_s"] - last(run)["v_s"])) / limit, 1e-7)
        ends.append(v)
    check("sinking block: hybrid against sdirk2", abs(ends[1] / ends[0] - 1), 5e-3)


SWAPPED = ("-grid_upper", "1.2 m,0.1 m", "-grid_cells", "12,1", "-region_body_upper", "1 m,0.1 m", "-bc_base_axis", "x", "-bc_left_axis", "y", "-bc_right_axis", "y",
           "-bc_top_side", "right")  # fmt: skip


def gas():
    """The sea lets gas out and none in (358): a column whose gas a rising sea compresses takes in water alone, until p_g V is again what it was; a falling
    one draws off as much as a given pressure does."""
    run = lambda kind, *options, ranks=1: Run.of_case(CASES / "sea_gas.yaml", "-quiet", "-stepper_type", kind, *options, ranks=ranks)
    rises, falls = ("-ambient_pressure_ramp", "1 MPa,1.5 MPa,0 s,0.5 s"), ("-ambient_pressure_ramp", "1 MPa,0.7 MPa,0 s,0.5 s")
    given = ("-bc_top_pressure_ramp", "1 MPa,0.7 MPa,0 s,0.5 s")
    for kind in ("sdirk2", "hybrid"):
        up, down, outlet = run(kind, *rises), run(kind, *falls), run(kind, *given, *falls)
        methane, water = up.balance["methane_kg"], up.balance["water_kg"]
        judge(ROW, f"gas under a sea that rises by half, {kind}: methane that comes in, of what is there", np.max(np.abs(methane / methane[0] - 1)), 1e-4)
        before, after = up.snapshots()[0][1], up.snapshots()[-1][1]
        pV = lambda v: np.sum(v["p_g"][:, 0] * (v["S_g"] * v["porosity"] * v["volume"])[:, 0])
        judge(ROW, f"... {kind}: p_g times the room that gas has, over that before", pV(after) / pV(before), (0.999, 1.001))
        check_true(f"... {kind}: water comes in", water[-1] > 1.1 * water[0], f"{water[-1] / water[0] - 1:.3f} of what was there")
        left = [1 - r.balance["methane_kg"][-1] / r.balance["methane_kg"][0] for r in (down, outlet)]
        judge(ROW, f"gas under a sea that falls, {kind}: what leaves, over what a given pressure draws", left[0] / left[1], (0.98, 1.02))
        check_true(f"... {kind}: gas leaves", left[0] > 0.2, f"{left[0]:.3f}")
    p = last(run("sdirk2", *rises))["p_g"]
    check("gas under a rising sea: axes swapped", np.max(np.abs(np.sort(last(run("sdirk2", *rises, *SWAPPED))["p_g"], 0) / np.sort(p, 0) - 1)), 1e-9)
    check("gas under a rising sea: 2 ranks", np.max(np.abs(last(run("sdirk2", *rises, ranks=2))["p_g"] / p - 1)), 1e-9)


rest()
deeper()
leaning()
falling()
slope()
sinks()
gas()
finish()
