#!/usr/bin/env python3
"""Sediment without gas: gas appears, vanishes and is let in, against exact equilibrium.

Sediment without gas (equations (101)-(109), (352)): gas appears as hydrate dissociates and is gone when hydrate has formed of it,
against the exact equilibrium of a closed cell, implicit and hybrid, on two ranks and across a restart; gas that is let into
sediment full of water, against finite volumes.
"""
import math
from pathlib import Path

import numpy as np

import exact
from common import Run, check, finish, judge, scratch, table

CASES = Path(__file__).parent / "cases"
CELL = CASES / "no_gas_cell.yaml"
LAW = exact.Retention(p0=1e4, m=0.5, Swr=0.1, Sgr=0.0)
TRACE = 1e-7 * 0.016 / (8.314 * 283.15)  # kg/(m^3 Pa) (102)
HENRY = 1.9e-5  # mol/(m^3 Pa), methane at 10 degC
PHI, KW, P_REF = 0.3, 2.2e9, 2.84e6
WATER = ("-bc_sea_type", "pressure", "-bc_sea_side", "right", "-bc_sea_pressure", "8 MPa", "-bc_sea_phases", "water")
FORMS = ("-without_gas", "yes", "-boundaries", "sea", *WATER, "-region_cell_pressure", "8 MPa", "-region_cell_Sh", 0.1, "-region_cell_Sw", 0.85,
         "-region_cell_Sg", 0.05)  # fmt: skip


def water(p):
    return 1000.0 * math.exp((p - P_REF) / KW)


def equilibrium(p0, T0, Sh, solubility=TRACE):
    """p_w, p_g, T, S_h, S_g of the closed adiabatic cell without gas, when p = p_e(T)."""
    cell = exact.masuda_cell(p=p0, T=T0, phi=PHI, Sh=Sh, Sw=1 - Sh, Sg=0.0)
    pg0 = p0 - 20 * LAW.p0  # where a run starts without gas (103)
    mh0, mw0 = PHI * Sh * 900.0, PHI * (1 - Sh) * water(p0)
    mg0 = PHI * (1 - Sh) * solubility * pg0
    heat = exact.replace(cell, rho_w=water(p0), heat=(800.0 + mg0 * 2100.0 / ((1 - PHI) * 2600.0), *cell.heat[1:]))  # with the methane in the water

    def state(formed):
        T, mh = heat.temperature(formed), mh0 + formed
        mw, mg = mw0 - formed * 6 * 0.018 / 0.124, mg0 - formed * 0.016 / 0.124
        pores = PHI - mh / 900.0

        def gas_share(pw):
            return 1 - mw / (pores * water(pw))

        def lacks(pw):
            s = gas_share(pw)
            pc = exact.bisect(lambda x: LAW.gas_share(x) - s, -3e6, 3e6, 70)
            pg = pw + pc
            return pores * (s * 0.016 * pg / (8.314 * (T + exact.ZERO_C)) + (1 - s) * solubility * pg) - mg

        tight = P_REF + KW * math.log(mw / (pores * 1000.0))  # no room for gas
        pw = exact.bisect(lacks, tight + 1e-6 * KW, tight + 0.5 * KW, 60)
        s = gas_share(pw)
        pc = exact.bisect(lambda x: LAW.gas_share(x) - s, -3e6, 3e6)
        return {"p_w": pw, "p_g": pw + pc, "p": pw + s * pc, "T": T, "S_h": mh / 900 / PHI, "S_g": (1 - mh / 900 / PHI) * s}

    last, first = (-3e-3, -1e-6) if solubility == TRACE else (-3e-2, -4e-3)  # first: enough for some gas
    formed = exact.bisect(lambda m: state(m)["p"] - cell.equilibrium_pressure(state(m)["T"]), last * mh0, first * mh0, 50)
    return state(formed)


def balances(name, run):
    worst = max(np.max(np.abs(run.balance[f"{w}_error"])) for w in ("water", "methane"))
    judge("gas", f"{name}: water and methane, largest error of any step", worst, 1e-13)


def appears(more=(), solubility=TRACE, dissolves=""):
    want, end = equilibrium(2e6, 2.3, 0.5, solubility), ("10 s", "2 s") if solubility == TRACE else ("20 s", "20 s")
    step = 0.25 if solubility == TRACE else 0.05  # s: (235) depends on the way that T takes, of first order
    for name, options in (("sdirk2", ()), (f"euler, steps of {step} s", ("-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", step, "-time_end", end[0])),
                          ("hybrid", ("-stepper_type", "hybrid", "-stepper_adapt", "yes", "-time_end", end[1], "-output_probe_every", "1 s"))):  # fmt: skip
        run = Run.of_case(CELL, *options, *more)
        columns = {"p": "p_Pa", "p_g": "p_g_Pa", "T": "T_degC", "S_h": "S_h", "S_g": "S_g"}
        got = {k: run.probe("middle")[c][-1] for k, c in columns.items()}
        name += dissolves
        print(f"\nno gas at first, {name}: {len(run.balance['time_s'])} steps")
        table(("quantity", "computed", "exact", "relative error"), [(k, f"{got[k]:.8g}", f"{want[k]:.8g}", got[k] / want[k] - 1) for k in got])  # fmt: skip
        for k in got:
            judge("gas", f"gas appears, {name}: {k} at equilibrium, relative error", abs(got[k] / want[k] - 1), 2e-5 if k == "S_g" else 1e-6)
        balances(f"gas appears, {name}", run)
        check("steps refused or over tolerance", run.output.count("refused ("), 2 if name.startswith("sdirk2") else 0)


def melts():
    """Hydrate beneath water at 8 MPa that holds less methane than the equilibrium at 7.5 MPa melts into it, without gas, until p_g = p_e (371)."""
    case = ("-without_gas", "yes", "-boundaries", "sea", *WATER, "-region_cell_pressure", "8 MPa", "-region_cell_temperature", "8.13 degC",
            "-mat_core_gas_solubility", f"{HENRY} mol/(m^3 Pa)", "-mat_core_retention_p_trap", "50 kPa", "-time_end", "20 s", "-output_times", "0 s,20 s")  # fmt: skip
    law, kept = exact.masuda_cell(p=8e6, T=8.13, phi=PHI, Sh=0.5, Sw=0.5, Sg=0.0), {}
    for name, options in (("sdirk2", ()), ("hybrid", ("-stepper_type", "hybrid"))):
        run = Run.of_case(CELL, *case, *options)
        (_, first), (_, last) = run.snapshots()
        pe = np.array([law.equilibrium_pressure(T) for T in last["T"][:, 0]])
        gave = (first["mass_hydrate"].sum() - last["mass_hydrate"].sum()) * 0.016 / 0.124 - run.balance["methane_out_kg"][-1]
        before, after = (PHI * 0.01 * 0.016 * HENRY * np.mean((1 - v["S_h"]) * v["p_g"]) for v in (first, last))
        judge("gas", f"hydrate melts into water, {name}: p_g over p_e(T), less one", np.max(np.abs(last["p_g"][:, 0] / pe - 1)), 1e-5)
        judge("gas", f"hydrate melts into water, {name}: methane it gave, and what came in with water, over what water took, less one", abs(gave / (after - before) - 1), 1e-5)
        judge("gas", f"hydrate melts into water, {name}: largest S_g", np.max(last["S_g"]), 1e-6)
        balances(f"hydrate melts into water, {name}", run)
        kept[name] = last["p_g"].mean()
    judge("gas", "hydrate melts into water: p_g, hybrid against sdirk2", abs(kept["hybrid"] / kept["sdirk2"] - 1), 1e-5)


def grows():
    """Water in equilibrium with hydrate is cooled by 1 K at once and kept there: what it then holds too much of grows on the hydrate, without gas (418).
    Its course against the ordinary differential equation of the cell's p_g."""
    T0, T, rate, times = 7.0, 6.0, 360.0, (30, 100, 300)  # degC; mol/(m^2 Pa s): a hundredth; s
    case = ("-grid_cells", "6, 6", "-without_gas", "yes", "-region_cell_pressure", "8 MPa", "-region_cell_temperature", f"{T0} degC", "-mat_core_gas_solubility", f"{HENRY} mol/(m^3 Pa)", "-mat_core_retention_p_trap", "50 kPa",
            "-mat_core_kinetics_K0", f"{rate} mol/(m^2 Pa s)", "-boundaries", "cold", "-bc_cold_type", "region_temperature", "-bc_cold_region", "cell", "-bc_cold_temperature", f"{{ramp: [{T0} degC, {T} degC, 0 s, 0.1 s]}}",
            "-time_end", f"{times[-1]} s", "-output_times", ",".join(f"{t} s" for t in (0, *times)))  # fmt: skip
    law = exact.masuda_cell(p=8e6, T=T, phi=PHI, Sh=0.5, Sw=0.5, Sg=0.0)
    pe, Kd, held = law.equilibrium_pressure(T), rate * math.exp(-78151 / (8.314 * (T + exact.ZERO_C))), 0.016 * HENRY

    def course(m0, pg0, ends, n=20000):  # of a m^3: kg of hydrate by the mid-point rule; methane is that of the start
        pg_of = lambda m: ((PHI - m0 / 900) * held * pg0 - (m - m0) * 0.016 / 0.124) / ((PHI - m / 900) * held)  # noqa: E731

        def slope(m):
            over, whole = pg_of(m) - pe, (1 - m / 900 / PHI) ** -3
            return 0.124 * Kd * 7.5e5 * m / 900 / whole * (over + (whole - 1) * -math.expm1(-over / 100) * 100)

        m, dt, found = m0, ends[-1] / n, []
        for i in range(1, n + 1):
            m += dt * slope(m + 0.5 * dt * slope(m))
            if any(abs(i * dt - t) < 0.5 * dt for t in ends):
                found.append(pg_of(m))
        return np.array(found)

    for name, options in (("sdirk2", ()), ("sdirk2, 2 ranks", ()), ("hybrid", ("-stepper_type", "hybrid", "-stepper_adapt", "yes", "-grid_cells", "2, 2"))):
        run = Run.of_case(CELL, *case, *options, ranks=2 if "ranks" in name else 1)
        states = [v for _, v in run.snapshots()]
        got = np.array([v["p_g"].mean() for v in states])
        want = course(PHI * 0.5 * 900.0, got[0], times)
        table(("s", "p_g (MPa)", "exact", "of p_e (MPa)"), [(t, f"{a / 1e6:.5f}", f"{b / 1e6:.5f}", f"{pe / 1e6:.5f}") for t, a, b in zip(times, got[1:], want)])
        judge("gas", f"hydrate grows from water, {name}: p_g, largest error over what it falls by", np.max(np.abs(got[1:] - want)) / (got[0] - pe), 0.004)
        judge("gas", f"hydrate grows from water, {name}: largest S_g", max(np.max(v["S_g"]) for v in states), 1e-6)
        balances(f"hydrate grows from water, {name}", run)


def rests():
    """Hydrate beneath water at 8 MPa that holds what hydrate is in equilibrium with, 5.9 MPa at 6 degC (103): nothing happens."""
    case = ("-without_gas", "yes", "-region_cell_pressure", "8 MPa", "-region_cell_temperature", "6 degC", "-mat_core_gas_solubility", "auto", "-time_end", "20 s", "-output_times", "0 s,20 s")
    for name, options in (("sdirk2", ()), ("hybrid", ("-stepper_type", "hybrid"))):
        (_, first), (_, last) = Run.of_case(CELL, *case, *options).snapshots()
        pe = exact.masuda_cell(p=8e6, T=6.0, phi=PHI, Sh=0.5, Sw=0.5, Sg=0.0).equilibrium_pressure(6.0)
        check(f"hydrate in water at rest, {name}: p_g of the start over p_e, less one", np.max(np.abs(first["p_g"] / pe - 1)), 1e-12)
        judge("gas", f"hydrate in water at rest, {name}: largest change of S_h", np.max(np.abs(last["S_h"] - first["S_h"])), 1e-12)


def carried():
    """Methane over water in what leaves a column whose water holds H p_g (352)."""
    case, held = CASES / "no_gas_flow.yaml", 0.016 * HENRY * 8e6 / 1000.0
    rows, ends = [], []
    for name, ranks, options in (("sdirk2", 1, ()), ("sdirk2, 2 ranks", 2, ()), ("hybrid", 1, ("-stepper_type", "hybrid"))):
        run = Run.of_case(case, "-time_end", "2 s", "-output_probe_every", "0.5 s", *options, ranks=ranks)
        ends.append([run.csv("meters.csv")[f"out.{q}_kg"][-1] for q in ("gas", "water")])
        rows.append((name, ends[-1][0] / ends[-1][1], ends[-1][0] / ends[-1][1] / held - 1))
        balances(f"methane carried by water, {name}", run)
    print("\nmethane over water that leaves")
    table(("", "kg/kg", "off what the water held"), rows)
    judge("gas", "methane carried by water, sdirk2: off what the water held, relative", abs(rows[0][2]), 1e-4)
    judge("gas", "methane carried by water, two ranks against one, relative", abs(ends[1][0] / ends[0][0] - 1), 1e-9)
    judge("gas", "methane carried by water, hybrid against sdirk2, relative", abs(ends[2][0] / ends[0][0] - 1), 5e-4)


def drained():
    """Water drained from sand and clay through a corner takes all of its methane along: p_g, uniform at first, stays so (352), also of what (22) and (23) move.

    Where their permeabilities differ (353) evens out p_g with p_w, so for this both have the same, and clay a thousand times as viscous a water.
    """
    alike = ("-mat_clay_permeability_k0", "1e-13 m^2", "-mat_clay_water_viscosity", "1 Pa s")
    blow = ("-inertia", "yes", "-time_end", "0.2 s", "-output_every", "0.2 s", "-bc_well_pressure", "7.8 MPa")
    border = ("-region_sand_upper", "4.1 m, 1.7 m", "-region_clay_lower", "0.1 m, 1.7 m")
    shears = ("-grid_lower", "-1.9 m, -1 m", "-grid_upper", "6.1 m, 5 m", "-grid_cells", "16, 12", "-boundaries", "base,well", "-bc_base_type", "fixed", "-ambient_pressure", "8 MPa",
              "-gravity", "9 m/s^2, 0 m/s^2", "-mat_sand_elasticity_E0", "0.3 MPa", "-mat_clay_elasticity_E0", "0.3 MPa")  # fmt: skip
    hybrid = ("-stepper_type", "hybrid", "-mat_sand_water_bulk_modulus", "1e11 Pa", *blow)
    rows = []
    for name, bar, options in (("sdirk2", 1e-7, alike), ("euler", 1e-7, ("-stepper_type", "euler", *alike)), ("about an axis", 1e-7, ("-geometry", "axisymmetric", *alike)),
                               ("a border across cells", 1e-7, (*border, *alike)), ("sdirk2 with inertia", 1e-7, (*blow, *alike)),
                               ("hybrid", 1e-5, hybrid), ("hybrid, sheared by 0.2 off the grid's lines", 1e-5, (*hybrid, *shears)),
                               ("permeabilities that differ", 0.01, ()), ("... a border across cells", 0.01, border)):  # fmt: skip
        (_, first), *_, (_, last) = Run.of_case(CASES / "no_gas_drained.yaml", *options).snapshots()
        off = np.max(np.abs(last["p_g"] / np.mean(first["p_g"]) - 1))
        rows.append((name, (np.max(last["p_w"]) - np.min(last["p_w"])) / 1e6, off))
        judge("gas", f"water with methane drained from sand and clay, {name}: p_g off the first, relative", off, bar)
    print("\nwater drained from sand and clay: p_w differs, p_g must not")
    table(("", "p_w differs by (MPa)", "p_g, relative"), rows)


def dissolves():
    """Much gas over water that holds methane: how volumes go with pressures is lopsided then, and hybrid's stable step (38) must know it."""
    case, more = CASES / "sea_gas.yaml", ("-mat_mud_gas_solubility", f"{HENRY} mol/(m^3 Pa)", "-region_body_Sw", 0.6, "-region_body_Sg", 0.4, "-ambient_pressure_ramp", "1 MPa,0.7 MPa,0 s,0.5 s")  # fmt: skip
    one, other = (Run.of_case(case, "-stepper_type", kind, *more) for kind in ("sdirk2", "hybrid"))
    left = [r.balance["methane_kg"][-1] / r.balance["methane_kg"][0] for r in (one, other)]
    judge("gas", "gas over water that holds methane, hybrid against sdirk2: methane left, relative", abs(left[1] / left[0] - 1), 0.01)
    balances("gas over water that holds methane, hybrid", other)


def disappears():
    gas = PHI * 0.05 * 0.016 * (8e6 + LAW.invert(0.05 / 0.9) * (1 - 0.05 / 0.9)) / (8.314 * 275.45)  # kg/m^3
    made = 0.01 * gas * 0.124 / 0.016  # kg in the cell
    run = Run.of_case(CELL, *FORMS)
    judge("gas", "gas is gone, sdirk2: hydrate made against what all gas makes, relative error", abs((run.balance["hydrate_kg"][-1] - 0.27) / made - 1), 1e-5)
    judge("gas", "gas is gone, sdirk2: S_g", run.probe("middle")["S_g"][-1], (0.0, 1e-9))
    balances("gas is gone, sdirk2", run)
    check("steps refused", run.output.count("refused ("), 2)
    short = ("-time_end", "60 s", "-output_probe_every", "10 s")
    one, other = (Run.of_case(CELL, *FORMS, *short, *o).probe("middle") for o in ((), ("-stepper_type", "hybrid", "-stepper_adapt", "yes")))
    table(("time (s)", "S_g sdirk2", "hybrid"), zip(range(0, 70, 10), one["S_g"], other["S_g"]))
    judge("gas", "gas goes, hybrid against sdirk2: S_g, of the first", np.max(np.abs(one["S_g"] - other["S_g"])) / 0.05, 5e-3)


def runs_short():
    """Gas that hydrate takes from S_gr = 2 % down: nothing forms below p_g = p_e(T) (371), and (223) says what gas that leaves."""
    p0, Sgr, law = 5e5, 0.02, exact.masuda_cell(p=8e6, T=2.3, phi=PHI, Sh=0.1, Sw=0.85, Sg=0.05)  # p_0: a tail of S_g down to p_e
    scarce = (*FORMS, "-mat_core_retention_Sgr", Sgr, "-mat_core_retention_p0", f"{p0} Pa")
    run = Run.of_case(CELL, *scarce, "-time_end", "400 s", "-output_probe_every", "20 s", "-stepper_dt_max", "20 s")
    end = {k: run.probe("middle")[c][-1] for k, c in (("p_w", "p_w_Pa"), ("p_g", "p_g_Pa"), ("T", "T_degC"), ("S_w", "S_w"), ("S_g", "S_g"))}
    left = exact.Retention(p0=p0, m=0.5, Swr=0.1, Sgr=Sgr).gas_share(end["p_g"] - end["p_w"])
    judge("gas", "gas runs short, sdirk2: p_g over p_e(T) at the end, less one", abs(end["p_g"] / law.equilibrium_pressure(end["T"]) - 1), 2e-4)
    judge("gas", "gas runs short, sdirk2: what is left of it, relative error", abs(end["S_g"] / (end["S_g"] + end["S_w"]) / left - 1), 1e-3)
    check("... of the gas there was", end["S_g"] / 0.05, (1e-5, 0.1))
    check("... steps refused", run.output.count("refused ("), 2)
    balances("gas runs short, sdirk2", run)
    short = ("-time_end", "60 s", "-output_probe_every", "10 s")
    one, other = (Run.of_case(CELL, *scarce, *short, *o).probe("middle") for o in ((), ("-stepper_type", "hybrid", "-stepper_adapt", "yes")))
    table(("time (s)", "S_g sdirk2", "hybrid", "p_g", "hybrid"), zip(range(0, 70, 10), one["S_g"], other["S_g"], one["p_g_Pa"], other["p_g_Pa"]))
    judge("gas", "gas runs short, hybrid against sdirk2: S_g, of the first", np.max(np.abs(one["S_g"] - other["S_g"])) / 0.05, 5e-3)
    judge("gas", "gas runs short, hybrid against sdirk2: p_g, relative", np.max(np.abs(one["p_g_Pa"] / other["p_g_Pa"] - 1)), 1e-2)


def column():
    case = CASES / "no_gas_column.yaml"
    keys = [f"{p}.{q}" for p in ("hydrate", "free") for q in ("p_Pa", "T_degC", "S_h", "S_g")]
    straight, two, hybrid = (Run.of_case(case, *o, ranks=n) for n, o in ((1, ()), (2, ()), (1, ("-stepper_type", "hybrid", "-stepper_adapt", "yes"))))
    differ = lambda a, b, keys: max(np.max(np.abs(a.probes[k] - b.probes[k])) / max(np.max(np.abs(a.probes[k])), 1e-3) for k in keys)
    gas = [r.snapshots()[-1][1]["mass_gas"].sum() for r in (straight, hybrid)]
    print()
    judge("gas", "column: two ranks against one, largest relative difference", differ(straight, two, keys), 1e-9)
    judge("gas", "column: hybrid against sdirk2, largest relative difference of p, T, S_h", differ(straight, hybrid, [k for k in keys if not k.endswith("S_g")]), 2e-3)
    judge("gas", "column: hybrid against sdirk2, gas, relative difference", abs(gas[1] / gas[0] - 1), 1e-3)
    for name, run in (("sdirk2", straight), ("hybrid", hybrid)):
        balances(f"column, {name}", run)
        judge("gas", f"column, {name}: gas in the half without hydrate", np.max(run.probe("free")["S_g"]), 1e-6)
    edge = ("-grid_upper", "0.175 m, 0.1 m", "-grid_cells", "7,2", "-time_end", "10 s", "-output_probe_every", "1 s")  # the second rank has the last nodes alone
    one, two = (Run.of_case(CELL, *edge, ranks=n).probe("middle")["p_Pa"] for n in (1, 2))
    judge("gas", "a rank with nodes but no particles (other steps): p against one rank, relative", np.max(np.abs(two / one - 1)), 1e-6)
    out = scratch() / "half"
    Run.of_case(case, "-time_end", "20 ms", out=out)
    Run.of_case(case, "-restart", out / "checkpoint.h5", out=out)
    again = Run(out)
    check("column: restart while gas appears, bit for bit", max(np.max(np.abs(straight.probes[k][-5:] - again.probes[k][-5:])) for k in keys), 0.0)


K, Q, MU = 1e-12, 2e-6, (1e-3, 7e-6)  # m^2, m/s, Pa s of no_gas_inflow.yaml


def displaced(cells, end):
    """Places (m) and S_g when gas drives water out of 1 m of sand, both incompressible: explicit finite volumes."""
    h, pc = 1 / cells, np.linspace(-2e4, 1e4, 20001)
    share = np.array(LAW.gas_share(pc)) - LAW.gas_share(-2e5)
    mobile = lambda s: (np.clip(1 - s / 0.9, 0, 1) ** 4 / MU[0], np.clip(s / 0.9, 0, 1) ** 2 / MU[1])
    w, g = mobile(share)
    spread, speed = np.nanmax(K * w * g / (w + g) * np.gradient(pc, share)), Q * np.nanmax(np.gradient(g / (w + g), share))
    steps = 1 + int(end / min(0.4 * h * h * PHI / spread, 0.4 * h * PHI / speed))
    s = np.zeros(cells)
    for _ in range(steps):
        w, g = (0.5 * (m[1:] + m[:-1]) for m in mobile(s))
        u = g / (w + g) * (Q - K * w * np.diff(np.interp(s, share, pc)) / h)
        s -= end / steps / PHI / h * np.diff(np.concatenate(([Q], u, [u[-1]])))
    return (np.arange(cells) + 0.5) * h, s


def inflow():
    case, end = CASES / "no_gas_inflow.yaml", 3600.0
    x, want = displaced(100, end)
    rows = []
    for cells in (20, 40):
        run = Run.of_case(case, "-grid_cells", f"{cells},1")
        v = run.snapshot(end)
        exact_S = np.interp(v["position"][:, 0], x, want)
        rows.append((float(cells), np.mean(np.abs(v["S_g"][:, 0] - exact_S)) / np.mean(exact_S), v["S_g"].min(), len(run.balance["time_s"])))
        lost = np.max(np.abs(run.balance["methane_error"])) * run.balance["methane_kg"][0] / run.balance["methane_kg"][-1]
        judge("gas", f"inflow, {cells} cells: methane, largest error of any step over what is there at the end", lost, 1e-13)
    print("\ngas into sediment full of water, 1 h")
    table(("cells", "mean error of S_g, of its mean", "smallest S_g", "steps"), rows)
    judge("gas", "gas into water, 40 cells: mean error of S_g, of its mean", rows[1][1], 0.02, 0.01, "%")
    judge("gas", "gas into water: error on 40 cells over that on 20", rows[1][1] / rows[0][1], 0.7)
    judge("gas", "gas into water: smallest S_g", min(r[2] for r in rows), (0.0, 1e-6))


def seal():
    """A well between clays whose gas is trapped, with gas from where it comes (332): p_c stays near zero in the clays (4 MPa below it without)."""
    case, donor = CASES / "no_gas_seal.yaml", ("-stabilisation_donor", "yes")
    v = Run.of_case(case, *donor).snapshot(1.4 * 86400)
    short = ("-time_end", "1 h", "-output_every", "1 h")
    one, two = (np.sort(Run.of_case(case, *donor, *short, ranks=n).snapshot(3600.0)["p_g"][:, 0]) for n in (1, 2))
    clay = (v["position"][:, 1] < 2.9) | (v["position"][:, 1] > 7.1)
    pc, pw = (v["p_g"] - v["p_w"])[clay, 0], v["p_w"][clay, 0]
    print(f"\nwell between clays with trapped gas, 1.4 days: p_c {pc.min() / 1e3:.0f} to {pc.max() / 1e3:.0f} kPa in the clays, p_w {pw.min() / 1e6:.2f} to {pw.max() / 1e6:.2f} MPa")
    judge("gas", "well between clays with trapped gas: largest |p_c| in the clays", np.max(np.abs(pc)), 2e5, 1e3, "kPa")
    check("... two ranks, p_g, largest difference (Pa)", np.max(np.abs(one - two)), 1.0)


def clay():
    """Drained sand between clays without gas: gas that sand has does not carry off, over its share of a node in the clay (359), what the clay's water holds."""
    case, early, end = CASES / "no_gas_clay.yaml", 0.3 * 86400, 30 * 86400
    run = Run.of_case(case)
    short = ("-time_end", "0.3 d", "-output_times", "0.3 d")
    one, two = (np.sort(Run.of_case(case, *short, ranks=n).snapshot(early)["p_g"][:, 0]) for n in (1, 2))
    first, rows = run.snapshots()[0][1], {}
    for t in (early, end):
        v, y = run.snapshot(t), first["position"][:, 1]
        inside = (y < 3) | (y > 10)  # a cell and more from the sand
        settled = np.max(np.abs(v["displacement"][:, 1]))
        kept = (v["mass_gas"][inside] / v["mass_water"][inside] / (first["mass_gas"][inside] / first["mass_water"][inside]))[:, 0]
        rows[t] = (t / 86400, settled, kept.min(), kept.max(), (v["p_g"] - v["p_w"])[inside, 0].min() / 1e3)
    print("\ndrained sand between clays without gas")
    table(("days", "settlement (m)", "methane of the clay's water, least", "most", "p_c, least (kPa)"), list(rows.values()))
    judge("gas", "drained sand between clays without gas: methane in the clay's water a cell away after 7 hours, least, over that at the start", rows[early][2], (0.97, 1.03))
    judge("gas", "... steps of 30 days", float(len(run.balance["time_s"])), 200.0)
    check("... p_c there, least (kPa)", rows[early][4], (-100.0, 100.0))
    check("... methane", np.max(np.abs(run.balance["methane_error"])), 1e-12)
    check("... two ranks, p_g, largest difference (Pa)", np.max(np.abs(one - two)), 1.0)


def metered():
    """meters.csv tells methane in water from free gas: a heater melts hydrate in sand that starts without gas."""
    run = Run.of_case(CASES / "heater.yaml", "-quiet", "-region_layer_Sw", 0.6, "-region_layer_Sg", 0, "-meters", "left", "-meter_left_side", "left",
                      "-time_end", "12 h", "-output_every", "12 h", "-mat_sand_gas_eos", "ideal")  # fmt: skip
    m = run.csv("meters.csv")
    for row, (t, v) in zip((0, -1), run.snapshots()):
        pores = v["porosity"] * v["volume"]
        dissolved, free = np.sum(pores * v["S_w"] * HENRY * 0.016 * v["p_g"]), np.sum(pores * v["S_g"] * v["p_g"] * 0.016 / (8.314 * (v["T"] + 273.15)))
        judge("gas", f"meters at {t / 3600:g} h: dissolved methane against Henry's law, relative", abs(m["dissolved_gas_kg"][row] / dissolved - 1), 1e-6)
        judge("gas", f"... free gas, {free / dissolved:.2g} of that, against the ideal gas law, of both", abs(m["free_gas_kg"][row] - free) / (free + dissolved), 1e-3)
        judge("gas", "... both against the masses of the particles, relative", abs((m["free_gas_kg"][row] + m["dissolved_gas_kg"][row]) / np.sum(v["mass_gas"]) - 1), 1e-12)
    judge("gas", "... standard volumes, relative", np.max(np.abs(m["dissolved_gas_std_m3"] * 0.6789 / m["dissolved_gas_kg"] - 1)), 1e-11)


if __name__ == "__main__":
    clay()
    inflow()
    seal()
    appears()
    appears(("-mat_core_gas_solubility", f"{HENRY} mol/(m^3 Pa)"), 0.016 * HENRY, ", methane dissolves")
    melts()
    grows()
    rests()
    carried()
    drained()
    dissolves()
    disappears()
    runs_short()
    column()
    metered()
    finish()
