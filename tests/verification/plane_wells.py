#!/usr/bin/env python3
"""A well in the plane against Thiem and Theis, anywhere in its cell.

A well in the plane (366)-(370): its steady flow in a square whose sides hold their pressure, against Thiem's with the exact
radius of such a square, at any place of its cell and in cells of 2 to 100 of its radii; beds; a rate against Theis; water and
gas; a body that falls through the grid, or is squeezed, also with basis: total; both kinds of integrator, two ranks, restart, balances."""
from pathlib import Path

import numpy as np
from scipy.special import exp1

from common import Run, finish, judge, largest_difference, scratch, table

CASE = Path(__file__).parent / "cases" / "plane_well.yaml"
A, K_MU, DROP, RHO = 20.0, 1e-9, 6e6, 1000.0  # of the case: side, m; k/mu, m^2/(Pa s); Pa; kg/m^3
PLACE = (10.25, 10.4)
SQUEEZED = ["-mat_sand_water_bulk_modulus", "2.2 GPa"]
D = K_MU * 2.2e9 / 0.3  # m^2/s, with it


def reach(x, y, a, b):
    """Radius R at which a source at (x, y) in a rectangle a x b with p = 0 around has p = 0: Green's function by images."""

    def image(dx, sum_y):
        c = np.cosh(np.pi * dx / b)
        return 0.5 * np.log((c - np.cos(np.pi * sum_y / b)) / (c - (1.0 if sum_y else np.nan)))

    total = np.log(2 * b / np.pi * np.sin(np.pi * y / b))
    for n in range(-6, 7):
        total += image(2 * n * a, 2 * y) if n else 0.0
        total -= image(2 * x - 2 * n * a, 2 * y)
    return np.exp(total)


def thiem(place, radius, ratio=1.0, skin=0.0, height=A):
    """Flow of mass per thickness, beds level; height of the block without beds."""
    s = ratio**0.25
    R, inner = reach(place[0] * s, place[1] / s, A * s, height / s), 0.5 * radius * (s + 1 / s)
    return RHO * 2 * np.pi * np.sqrt(ratio) * K_MU * DROP / (np.log(R / inner) + skin)


def well(place=PLACE, radius=0.1, *more, case=CASE, **keywords):
    how = ["-bc_well_radius", f"{radius} m"] if radius else []
    return Run.of_case(case, "-quiet", "-bc_well_at", f"{place[0]} m,{place[1]} m", *how, *more, **keywords)


def flow(run, what="water_kg_s"):
    return run.csv("meters.csv")[f"well.{what}"][-1]


def closed(run, fluids):
    """The largest error of the balances."""
    balance = run.csv("balance.csv")
    return max(abs(balance[f"{name}_error"]).max() for name in fluids)


# any place of a cell, radii of a half to a hundredth of it
rows = []
for ppc, places, radii in ((2, ((10.0, 10.0), (10.5, 10.5), (10.13, 10.4)), (0.5, 0.1, 0.01)), (3, ((10.25, 10.0), (4.3, 7.8)), (0.5, 0.05))):
    for place in places:
        for radius in radii:
            run = well(place, radius, "-region_block_particles_per_cell", f"{ppc},{ppc}")
            rows.append((f"{ppc} x {ppc}", f"{place[0]:g}, {place[1]:g}", 1.0 / radius, flow(run) / thiem(place, radius)))
table(("particles a cell", "place", "h / r_w", "rate / Thiem"), rows)
judge("plane_wells", "rate off Thiem's, any place of a cell, h of 2 to 100 r_w", max(abs(r[3] - 1) for r in rows), 2e-3)
steady = well()
turned = well(PLACE[::-1])
judge("plane_wells", "axes swapped: rate", abs(flow(turned) / flow(steady) - 1), 1e-10)
stiff = ["-mat_sand_water_bulk_modulus", "2.2e18 Pa"]
low, high = (well(PLACE, 0.1, *stiff, "-region_block_pressure", f"{p + 6} MPa", "-bc_well_bottom_pressure", f"{p} MPa") for p in (4, 104))
judge("plane_wells", "100 MPa added everywhere: rate", abs(flow(high) / flow(low) - 1), 1e-9)
judge("plane_wells", "skin of 3: rate off Thiem's", abs(flow(well(PLACE, 0.1, "-bc_well_skin", "3")) / thiem(PLACE, 0.1, skin=3.0) - 1), 2e-3)
beds = []
for radius in (0.5, 0.01):
    level = well(PLACE, radius, "-mat_sand_permeability_ratio", "0.1")
    upright = well(PLACE[::-1], radius, "-mat_sand_permeability_ratio", "0.1", "-mat_sand_permeability_dip", "90 deg")
    beds.append((flow(level) / thiem(PLACE, radius, 0.1), flow(upright) / flow(level)))
judge("plane_wells", "beds of 0.1: rate off Thiem's", max(abs(b[0] - 1) for b in beds), 5e-3)
judge("plane_wells", "beds of 0.1, level and upright: rate", max(abs(b[1] - 1) for b in beds), 1e-9)

# in time: a rate, a pressure; hybrid, two ranks
IMPLICIT, HYBRID = ("-stepper_type", "sdirk2", "-stepper_dt", "0.05 s"), ("-stepper_type", "hybrid", "-inertia", "yes", "-stepper_adapt", "yes", "-stepper_dt", "0.5 s")
given = scratch() / "rate.yaml"
given.write_text(CASE.read_text().replace("radius: 0.1 m, bottom_pressure: 4 MPa", "water_flow: -5 kg/s"))
CELLS = ("-grid_cells", "40,40", "-time_end", "2 s", "-stepper_dt", "0.1 s", "-probes", "near,far", "-probe_near_at", "13.25 m,10.4 m", "-probe_far_at", "14.25 m,13.4 m")
for name, how in (("sdirk2", IMPLICIT), ("hybrid", HYBRID)):
    run = well(PLACE, None, *SQUEEZED, *how, *CELLS, case=given)
    theis = [5.0 / RHO / (4 * np.pi * K_MU) * exp1(r * r / (4 * D * 2.0)) for r in (3.0, 5.0)]
    off = [abs((1e7 - run.probe(p)["p_Pa"][-1]) / exact - 1) for p, exact in zip(("near", "far"), theis)]
    judge("plane_wells", f"{name}: drawdown of a rate off Theis's at 3 and 5 m", max(off), 2e-2)
    judge("plane_wells", f"{name}: rate that is given", abs(flow(run) / 5.0 - 1), 1e-12)
last = {}
for name, how in (("sdirk2", IMPLICIT), ("hybrid", HYBRID), ("two ranks", IMPLICIT)):
    last[name] = well(PLACE, 0.1, *SQUEEZED, *how, "-time_end", "4 s", ranks=2 if name == "two ranks" else 1)
water = {name: flow(run, "water_kg") for name, run in last.items()}
judge("plane_wells", "hybrid: water in 4 s off sdirk2's", abs(water["hybrid"] / water["sdirk2"] - 1), 5e-3)
judge("plane_wells", "1 and 2 ranks: water in 4 s", abs(water["two ranks"] / water["sdirk2"] - 1), 1e-11)
judge("plane_wells", "balance of water", max(closed(run, ["water"]) for run in last.values()), 1e-12)

# water and gas, with heat; methane that water takes along
BOTH = [*SQUEEZED, "-fields", "water,gas,heat", "-region_block_Sw", "0.6", "-region_block_Sg", "0.4", "-time_end", "40 s"]
ADAPTS, SOLUBLE = ("-stepper_type", "sdirk2", "-stepper_adapt", "yes", "-stepper_dt", "0.1 s"), ("-mat_sand_gas_solubility", "1.9e-5 mol/(m^3 Pa)")
both = {}
for name, how in (("sdirk2", ADAPTS), ("hybrid", HYBRID), ("sdirk2, dissolved methane", (*ADAPTS, *SOLUBLE))):
    both[name] = well(PLACE, 0.1, *BOTH, *how)
    judge("plane_wells", f"{name}: balances of water and methane", closed(both[name], ["water", "methane"]), 1e-11)
for fluid in ("water_kg", "gas_kg"):
    judge("plane_wells", f"hybrid: {fluid.split('_')[0]} in 40 s off sdirk2's", abs(flow(both["hybrid"], fluid) / flow(both["sdirk2"], fluid) - 1), 2e-2)

# a body that falls 1.25 cells while water flows to its well, and one that rests; then the same cut in half
FALLS = [*SQUEEZED, "-fields", "solid,water", "-mat_sand_elasticity_E0", "1e10 Pa", "-inertia", "yes", "-gravity", "4e-3 m/s^2,0 m/s^2", "-grid_lower", "-2 m,-2 m",
         "-grid_upper", "24 m,22 m", "-grid_cells", "26,24", *IMPLICIT, "-stepper_dt", "1 s", "-time_end", "25 s"]  # fmt: skip
falls = well(PLACE, 0.1, *FALLS)
for basis, how, bar in (("cpgimp", "", 1e-2), ("total", ", basis: total", 1e-5)):
    moves = falls if basis == "cpgimp" else well(PLACE, 0.1, *FALLS, "-basis", basis)
    rests = well(PLACE, 0.1, *FALLS, "-basis", basis, "-gravity", "0 m/s^2,0 m/s^2")
    rate = [run.csv("meters.csv")["well.water_kg_s"] for run in (moves, rests)]
    judge("plane_wells", f"body that falls 1.25 cells{how}: rate off that of one at rest", largest_difference(rate[0][1:], rate[1][1:]) / rate[1][-1], bar)

# sand squeezed by 7 %: the well where it is then, in a lower block, at the same drop of 10 kPa
rows = []
for basis, ranks in (("cpgimp", 1), ("total", 1), ("total", 2)):
    run = Run.of_case(CASE.with_name("squeezed_well.yaml"), "-quiet", "-basis", basis, ranks=ranks)
    v = run.snapshots()[-1][1]
    highest = v["initial_position"][:, 1] > A - 0.5
    squeezed = v["position"][highest, 1].mean() / v["initial_position"][highest, 1].mean()
    rows.append((basis, ranks, squeezed, flow(run) / (thiem((10.25, 10.4 * squeezed), 0.1, height=A * squeezed) * 1e4 / DROP)))
table(("basis", "ranks", "height / first height", "rate / Thiem"), rows)
judge("plane_wells", "sand squeezed by 7 %: rate off Thiem's", abs(rows[0][3] - 1), 3e-2)
judge("plane_wells", "sand squeezed by 7 %, basis: total: rate off Thiem's", abs(rows[1][3] - 1), 1e-2)
judge("plane_wells", "sand squeezed by 7 %, basis: total: 1 and 2 ranks", abs(rows[2][3] / rows[1][3] - 1), 1e-10)
half = scratch()
well(PLACE, 0.1, *FALLS, "-time_end", "12 s", out=half)
again = well(PLACE, 0.1, *FALLS, "-restart", half / "checkpoint.h5", out=half)
judge("plane_wells", "restart: rows of the meter that are not those of the straight run", int((again.csv("meters.csv")["well.water_kg"] != falls.csv("meters.csv")["well.water_kg"]).sum()), 0)
finish()
