#!/usr/bin/env python3
"""Section 4.3: conditions on faces and meters against closed forms, on a rigid strip of ten cells.

Inflow into a closed box and into a soft one; steady flow through a column; heat brought by an inflow; cooling of a thin plate; heat flux
into an insulated body; a ramp of a region's temperature; p_w and p_g held apart; natural outflow against an outlet that
keeps its capillary pressure; meters against the ledger (BP2, with refused steps)."""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, largest_difference, table

ROW = "4.3"
CASE = Path(__file__).parent / "cases" / "boundaries.yaml"
PHI, K, MU_W, MU_G, BULK, RHO = 0.3, 1e-12, 1e-3, 7e-6, 2.2e9, 1000.0  # of the case
P0, T0, LENGTH, HEIGHT = 5e6, 10.0, 1.0, 0.1
PROBES = {"left": 0.05, "middle": 0.5, "right": 0.95}
ROCK_C, ROCK_KAPPA = 0.7 * 2650.0 * 800.0, 0.7 * 3.0  # without water: J/(m^3 K), W/(m K)
ROUND_OFF = 1e-12


def options(group, lists, instances):
    """Options that list and define boundaries or meters: {name: {key: value}}."""
    found = [f"-{lists}", ",".join(instances)]
    for name, keys in instances.items():
        for key, value in keys.items():
            found += [f"-{group}_{name}_{key}", str(value)]
    return found


def strip(boundaries, *more, meters=(), **keywords):
    counted = options("meter", "meters", {side: {"side": side} for side in meters}) if meters else []
    return Run.of_case(CASE, "-quiet", *options("bc", "boundaries", boundaries), *counted, *more, **keywords)


def at_end(run, quantity):
    return np.array([run.probe(name)[quantity][-1] for name in PROBES])


def ranks_agree(what, quantity, make):
    """Runs on one rank and on two; the histories are the same to round-off."""
    one, two = make(1), make(2)
    a, b = (np.array([run.probe(name)[quantity] for name in PROBES]) for run in (one, two))
    check(f"{what}: 1 and 2 ranks", largest_difference(b, a), 1e-8)
    return one


# ------------------------------------------------------------------------------------------ fluids
def closed_box():
    """phi V d rho/dt = rho q A with rho = rho_0 exp((p - p_ref)/K): p rises by K q A t/(phi V), whatever its size."""
    q, t = 1e-6, 100.0
    inlet = {"inlet": {"type": "inflow", "side": "left", "water": f"{q} m/s"}}
    run = ranks_agree("inflow into a closed box", "p_Pa",
                      lambda ranks: strip(inlet, "-mat_sand_permeability_k0", "1e-8 m^2", meters=["left"], ranks=ranks))  # fmt: skip
    rise = BULK * q * t / (PHI * LENGTH)
    mass = PHI * LENGTH * HEIGHT * RHO * np.expm1(q * t / (PHI * LENGTH))
    judge(ROW, "inflow into a closed rigid box: rise of pressure, relative", largest_difference(at_end(run, "p_Pa") - P0, [rise] * 3), 1e-4)
    judge(ROW, "inflow into a closed rigid box: mass let in, relative", abs(-run.csv("meters.csv")["left.water_kg"][-1] / mass - 1), 1e-5)
    ring = strip({"inlet": {**inlet["inlet"], "side": "right"}}, "-geometry", "axisymmetric", "-mat_sand_permeability_k0", "1e-8 m^2")
    judge(ROW, "inflow into a closed cylinder (twice the surface to volume): rise of pressure, relative",
          largest_difference(at_end(ring, "p_Pa") - P0, [2 * rise] * 3), 1e-4)  # fmt: skip
    judge(ROW, "inflow into a closed rigid box: water balance", np.max(np.abs(run.balance["water_error"])), ROUND_OFF)


def soft_box():
    """Under a constant load the skeleton gives way: q t = (phi/K + 1/M) L dp, and the surface moves by L dp/M."""
    q, t, M = 1e-6, 100.0, 1e8 * 0.7 / (1.3 * 0.4)
    conditions = {"base": {"type": "roller", "axis": "x", "position": "0 m"}, "low": {"type": "roller", "axis": "y", "position": "0 m"},
                  "high": {"type": "roller", "axis": "y", "position": "0.1 m"}, "load": {"type": "traction", "side": "right", "normal": f"{P0} Pa"},
                  "inlet": {"type": "inflow", "side": "right", "water": f"{q} m/s"}}  # fmt: skip
    run = strip(conditions, "-mat_sand_elasticity_E0", "1e8 Pa", "-mat_sand_permeability_k0", "1e-8 m^2", "-grid_upper", "1.1 m,0.1 m",
                "-grid_cells", "11,1", meters=["right"])  # fmt: skip
    rise = q * t / LENGTH / (PHI / BULK + 1 / M)
    judge(ROW, "inflow into a soft body under a load: rise of pressure, relative", largest_difference(at_end(run, "p_Pa") - P0, [rise] * 3), 2e-3)
    judge(ROW, "inflow into a soft body: displacement at 0.95 m, relative", abs(at_end(run, "u_x_m")[2] / (0.95 * rise / M) - 1), 2e-3)
    judge(ROW, "inflow into a soft body: water balance", np.max(np.abs(run.balance["water_error"])), ROUND_OFF)


def column():
    """In at the left, out through a pressure at the right: p = p_out + q mu/k (L - x); then the same, pumped out."""
    x = np.array(list(PROBES.values()))
    for what, q, at in (("inflow", 1e-5, "left"), ("pumping", -1e-5, "right")):
        outlet = "right" if at == "left" else "left"
        conditions = {"flux": {"type": "inflow", "side": at, "water": f"{q} m/s"},
                      "drain": {"type": "pressure", "side": outlet, "p_w": f"{P0} Pa"}}  # fmt: skip
        make = lambda ranks: strip(conditions, "-time_end", "1000 s", "-stepper_dt", "100 s", meters=["left", "right"], ranks=ranks)
        run = ranks_agree(what, "p_Pa", make) if q > 0 else make(1)
        profile = q * MU_W / K * np.abs(x - (LENGTH if outlet == "right" else 0.0))
        judge(ROW, f"steady {what}: Darcy's linear pressure, relative", largest_difference(at_end(run, "p_Pa") - P0, profile), 1e-4)
        m = run.csv("meters.csv")
        judge(ROW, f"steady {what}: what enters leaves, relative",
              abs((m["left.water_kg_s"][-1] + m["right.water_kg_s"][-1]) / m["left.water_kg_s"][-1]), 1e-6)  # fmt: skip
        check(f"steady {what}: rate rho q A", abs(abs(m["left.water_kg_s"][-1]) / (RHO * abs(q) * HEIGHT) - 1), 1e-4)


def porous_plates():
    """Both ends held by porous plates: Darcy's pressure, and a skeleton that it pushes, M u'' = p'."""
    drop, E, nu = 1e5, 1e8, 0.3
    M = E * (1 - nu) / ((1 + nu) * (1 - 2 * nu))
    planes = {n: {"type": "roller", "axis": a, "position": f"{x} m"} for n, a, x in (("bottom", "y", 0.0), ("top", "y", HEIGHT))}
    for n, x in (("a", 0.0), ("b", LENGTH)):
        planes[n] = {"type": "roller", "axis": "x", "position": f"{x} m", "holds": "skeleton"}
    sides = {"in": {"type": "pressure", "side": "left", "pressure": f"{P0 + drop} Pa"},
             "out": {"type": "pressure", "side": "right", "pressure": f"{P0} Pa"}}  # fmt: skip
    run = strip({**planes, **sides}, "-fields", "solid,water", "-mat_sand_elasticity_E0", "100 MPa", "-mat_sand_permeability_k0", "1e-12 m^2",
                "-time_end", "1e5 s", "-stepper_dt", "1e4 s", "-grid_cells", "40,1", meters=["left", "right"])  # fmt: skip
    x = np.array(list(PROBES.values()))
    judge(ROW, "porous plates: Darcy's linear pressure, of the drop", largest_difference(at_end(run, "p_Pa") - P0, drop * (1 - x / LENGTH), drop), 1e-3)
    u = drop * x * (LENGTH - x) / (2 * M * LENGTH)
    judge(ROW, "porous plates: displacement of the skeleton, relative", largest_difference(at_end(run, "u_x_m"), u), 5e-3)
    m = run.csv("meters.csv")
    check("porous plates: what enters leaves", abs(m["left.water_kg_s"][-1] / m["right.water_kg_s"][-1] + 1), 1e-6)


GAS = ("-region_strip_Sw", "0.8", "-region_strip_Sg", "0.2", "-fields", "water,gas")


def apart():
    """p_w and p_g held apart on both sides: the body takes s_g(p_g - p_w), here Brooks and Corey's."""
    side = {"type": "pressure", "p_w": "5 MPa", "p_g": "5.04 MPa"}
    run = strip({"a": {**side, "side": "left"}, "b": {**side, "side": "right"}}, *GAS, "-mat_sand_retention_law", "brooks_corey",
                "-mat_sand_retention_lambda", "2", "-time_end", "1e6 s", "-stepper_adapt", "yes")  # fmt: skip
    share = 0.05 + 0.85 * (1 - 2.0**-2)
    judge(ROW, "p_w and p_g held: gas share s_g(p_g - p_w), relative", largest_difference(at_end(run, "S_g"), [share] * 3), 1e-6)


def one_phase():
    """Open for water alone: gas stays, and takes up the volume that water leaves as an ideal gas."""
    run = strip({"drain": {"type": "pressure", "side": "right", "pressure": "4.5 MPa", "phases": "water"}}, *GAS, "-time_end", "1e4 s",
                "-stepper_adapt", "yes", meters=["right"])  # fmt: skip
    m, b = run.csv("meters.csv"), run.balance
    check_true("open for water alone: no gas leaves", np.all(m["right.gas_kg"] == 0))
    check("open for water alone: water leaves (kg)", m["right.water_kg"][-1], (0.1, 3.0))
    judge(ROW, "pressure open for water alone: free gas that is lost, relative", abs(m["free_gas_kg"][-1] / m["free_gas_kg"][0] - 1), ROUND_OFF)
    check("open for water alone: methane balance", np.max(np.abs(b["methane_error"])), ROUND_OFF)


def natural_outflow():
    """Water and gas let in as 30 % of gas would flow: the column goes to 30 % everywhere if it may leave as it is; an
    outlet that holds its initial 20 % keeps that."""
    sg = 0.3
    mobility = [((1 - sg - 0.1) / 0.85) ** 2 / MU_W, ((sg - 0.05) / 0.85) ** 2 / MU_G]
    q_w = 1e-6
    conditions = {"inlet": {"type": "inflow", "side": "left", "water": f"{q_w} m/s", "gas": f"{q_w * mobility[1] / mobility[0]:.15g} m/s"}}
    rows, found = [], {}
    for kind in ("free", "held"):
        conditions["outlet"] = {"type": "pressure", "side": "right", "pressure": f"{P0} Pa", "saturation": kind}
        make = lambda ranks: strip(conditions, *GAS, "-time_end", "1e7 s", "-stepper_adapt", "yes", "-stepper_dt", "10 s", "-stepper_tol", "1e-2",
                                   meters=["left", "right"], ranks=ranks)  # fmt: skip
        run = found[kind] = make(1)
        rows.append((kind, *at_end(run, "S_g"), *(at_end(run, "p_Pa") - P0)))
        m = run.csv("meters.csv")
        through = 1 + abs(m["left.gas_kg"][-1]) / m["free_gas_kg"][0]  # some 3000 times the gas that was there passes
        check(f"outlet {kind}: methane balance, of the gas that passes", np.max(np.abs(run.balance["methane_error"])) / through, 1e-14)
    table(("outlet", *(f"S_g {n}" for n in PROBES), *(f"p - p0 {n} (Pa)" for n in PROBES)), rows)
    free, held = (at_end(found[k], "S_g") for k in ("free", "held"))
    judge(ROW, "free saturation at the outlet: S_g is that of the inflow, relative", largest_difference(free, [sg] * 3), 1e-3)
    judge(ROW, "free saturation: Darcy's pressure at the left, relative",
          abs((at_end(found["free"], "p_Pa")[0] - P0) / (0.95 * q_w / K / mobility[0]) - 1), 2e-3)  # fmt: skip
    check("held saturation: S_g at the outlet stays near 0.2", held[2], (0.195, 0.25))
    m = found["free"].csv("meters.csv")
    for fluid in ("water", "gas"):
        check(f"free saturation: {fluid} that enters leaves", abs(m[f"right.{fluid}_kg_s"][-1] / m[f"left.{fluid}_kg_s"][-1] + 1), 1e-3)


# ------------------------------------------------------------------------------------------ heat
def warm_inflow():
    """Steady advection and conduction: T = T_in + (T_1 - T_in) exp(-Pe (1 - x/L)), Pe = rho c q L/kappa."""
    kappa = 0.7 * 3.0 + 0.3 * 0.5
    q = 2.0 * kappa / (RHO * 4200.0 * LENGTH)
    conditions = {"inlet": {"type": "inflow", "side": "left", "water": f"{q:.15g} m/s", "temperature": "30 degC"},
                  "drain": {"type": "pressure", "side": "right", "pressure": f"{P0} Pa"},
                  "cold": {"type": "temperature", "axis": "x", "position": "1 m", "temperature": f"{T0} degC"}}  # fmt: skip
    run = strip(conditions, "-time_end", "1e8 s", "-stepper_dt", "5e6 s", "-grid_cells", "20,1")
    want = 30.0 + (T0 - 30.0) * np.exp(-2.0 * (1.0 - np.array(list(PROBES.values()))))
    judge(ROW, "warm inflow: advected and conducted, of 20 K", largest_difference(at_end(run, "T_degC"), want, 20.0), 5e-3)
    b = run.balance
    judge(ROW, "warm inflow: heat balance, of the heat stored",
          np.max(np.abs(b["heat_J"] - b["heat_in_J"] - b["heat_source_J"])) / np.max(np.abs(b["heat_J"])), 1e-6)  # fmt: skip


def thin_plate():
    """Bi = 0.0024: T = T_a + (T_0 - T_a) exp(-2 alpha t/(C H))."""
    alpha, t = 0.1, 1e6
    both = {side: {"type": "convection", "side": side, "alpha": f"{alpha} W/(m^2 K)", "ambient": "2 degC"} for side in ("top", "bottom")}
    make = lambda ranks: strip(both, "-fields", "heat", "-time_end", f"{t} s", "-stepper_dt", "5e4 s", meters=["top", "bottom"], ranks=ranks)
    run = ranks_agree("convection", "T_degC", make)
    want = 2.0 + (T0 - 2.0) * np.exp(-2.0 * alpha * t / (ROCK_C * HEIGHT))
    judge(ROW, "convection cools a thin plate (Bi = 0.0024), of 8 K", largest_difference(at_end(run, "T_degC"), [want] * 3, 8.0), 1e-3)
    m = run.csv("meters.csv")
    judge(ROW, "convection: meters against the heat stored, relative",
          abs((m["top.heat_J"][-1] + m["bottom.heat_J"][-1]) / -run.balance["heat_J"][-1] - 1), 1e-9)  # fmt: skip


def insulated():
    """Heat flux into an insulated body: q t A in all, and in the end q L/kappa [(1 - x/L)^2/2 - 1/6] above the mean."""
    q, t = 100.0, 4e6
    run = strip({"heater": {"type": "heat_flux", "side": "left", "flux": f"{q} W/m^2"}}, "-fields", "heat", "-time_end", f"{t} s",
                "-stepper_dt", "1e5 s", "-output_quantities", "T,x", meters=["left", "right"])  # fmt: skip
    x = np.array(list(PROBES.values()))
    want = T0 + q * t / (ROCK_C * LENGTH) + q * LENGTH / ROCK_KAPPA * (0.5 * (1 - x / LENGTH) ** 2 - 1 / 6)
    judge(ROW, "heat flux into an insulated body: temperatures, relative", largest_difference(at_end(run, "T_degC"), want), 1e-3)
    judge(ROW, "heat flux into an insulated body: energy q t A, relative", abs(run.balance["heat_J"][-1] / (q * t * HEIGHT) - 1), 1e-9)
    judge(ROW, "heat flux: the meter, relative", abs(run.csv("meters.csv")["left.heat_J"][-1] / -(q * t * HEIGHT) - 1), ROUND_OFF)
    check_true("output_quantities: T and x alone", list(run.probes)[1:4] == ["left.T_degC", "left.x_m", "left.y_m"])


def region():
    """The whole strip follows a ramp; the heat it takes is C V dT."""
    run = strip({"heater": {"type": "region_temperature", "region": "strip", "temperature_ramp": f"{T0} degC,40 degC,20 s,80 s"}},
                "-fields", "heat")  # fmt: skip
    judge(ROW, "region_temperature: follows its ramp, K", largest_difference(run.at("middle", "T_degC", [20.0, 50.0, 80.0]), [10.0, 25.0, 40.0], 1.0), 1e-6)
    judge(ROW, "region_temperature: heat of the held nodes, relative",
          abs(run.balance["heat_in_J"][-1] / (ROCK_C * LENGTH * HEIGHT * 30.0) - 1), 1e-9)  # fmt: skip


# ------------------------------------------------------------------------------------------ meters
def ledger():
    """The meters of a whole surface add up to the ledger, at every step, refused ones or not."""
    whole = {"left": {"side": "left"}, "bottom": {"side": "bottom"}, "top": {"side": "top"},
             "low": {"side": "right", "to": "0.01 m"}, "high": {"side": "right", "from": "0.01 m"}}  # fmt: skip
    sides = options("meter", "meters", whole)
    for ranks in (1, 2):
        run = Run.of_case("bp2", "-quiet", "-grid_cells", "26,1", "-time_end", "200 s", "-output_times", "0 s", "-output_probe_every", "0 s",
                          "-stepper_dt_max", "20 s", "-stepper_tol", "1e-4", "-stepper_dt", "20 s", *sides, ranks=ranks)  # fmt: skip
        m, b = run.csv("meters.csv"), run.balance
        refused = int(run.output.split(" refused")[0].split()[-1]) if " refused" in run.output else 0
        for fluid, column in (("water", "water_out_kg"), ("gas", "methane_out_kg")):
            total = sum(m[f"{name}.{fluid}_kg"] for name in whole)
            judge(ROW, f"meters of the whole surface against the ledger, {ranks} rank(s): {fluid}, relative",
                  largest_difference(total[1:], b[column]), 1e-14)  # fmt: skip
        check("meters: standard volume", largest_difference(m["low.gas_std_m3"] * 0.6789, m["low.gas_kg"]), 1e-11)
        free = m["free_gas_kg"][1:] + b["hydrate_kg"] * 0.016 / 0.124
        check("meters: free gas is methane less what hydrate holds", largest_difference(free, b["methane_kg"]), 1e-14)
        check_true(f"meters: steps were refused, {ranks} rank(s)", refused > 0, refused)


for part in (closed_box, soft_box, column, porous_plates, apart, one_phase, natural_outflow, warm_inflow, thin_plate, insulated, region, ledger):
    print(f"\n{part.__doc__}")
    part()
finish()
