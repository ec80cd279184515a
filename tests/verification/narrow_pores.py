#!/usr/bin/env python3
"""Capillary pressure that grows with hydrate, against the law and against exact equilibrium.

Capillary pressure that grows with hydrate (320)-(322): sand with and without hydrate at rest at one p_c, drained to another, against the
law, implicit and hybrid, on two ranks and across a restart; hydrate that dissociates in a closed cell and forms in one, against the exact
equilibrium; without hydrate nothing changes.
"""
from pathlib import Path

import numpy as np

import exact
from common import Run, check, finish, judge, scratch, table

CASES = Path(__file__).parent / "cases"
SAND, CELL = CASES / "narrow_pores.yaml", CASES / "no_gas_cell.yaml"
LAW, N, SH, P0 = exact.Retention(p0=2e4, m=0.5, Swr=0.1, Sgr=0.02), 1.5, 0.4, 5e6
DRAINED, PC = 5.05e6, 6e4  # p_g at the end, p_c, Pa
DRAIN = ("-boundaries", "end", "-bc_end_type", "pressure", "-bc_end_side", "right", "-bc_end_p_w", f"{DRAINED - PC} Pa", "-bc_end_p_g", f"{DRAINED} Pa")
HYBRID = ("-stepper_type", "hybrid", "-stepper_adapt", "yes")
ROW = "narrow"


def share(pc, Sh):
    return LAW.gas_share(pc * (1 - Sh) ** N)


def balances(name, run):
    judge(ROW, f"{name}: water and methane, largest error of any step", max(np.max(np.abs(run.balance[f"{w}_error"])) for w in ("water", "methane")), 1e-12)


# both halves at p_c = 30 kPa, and the same mean pressure of gas: p_w, p_g are the same in both
S = {name: share(3e4, Sh) for name, Sh in (("free", 0.0), ("narrow", SH))}
START = [word for name, Sh in (("free", 0.0), ("narrow", SH))
         for word in (f"-region_{name}_Sg", repr((1 - Sh) * S[name]), f"-region_{name}_Sw", repr((1 - Sh) * (1 - S[name])), f"-region_{name}_pressure", f"{P0 + S[name] * 3e4!r} Pa")]  # fmt: skip


def rest():
    rows = []
    for name, options in (("sdirk2", ()), ("hybrid", (*HYBRID, "-time_end", "1 s", "-output_probe_every", "0.1 s"))):
        run = Run.of_case(SAND, *START, *options)
        rows.append((name, max(np.ptp(run.probe(p)["S_g"]) for p in S), max(np.ptp(run.probe(p)["p_g_Pa"]) for p in S)))
    print("\nat rest at p_c of 30 kPa")
    table(("", "largest change of S_g", "of p_g (Pa)"), rows)
    for name, change, _ in rows:
        judge(ROW, f"at rest, {name}: largest change of S_g", change, 1e-10)
    flows = Run.of_case(SAND, *START, "-mat_sand_retention_hydrate_exponent", "0")
    judge(ROW, "the same pressures without (320): change of S_g", max(np.ptp(flows.probe(p)["S_g"]) for p in S), (0.02, 1.0))


def drained():
    rows, last = [], {}
    for name, ranks, options in (("sdirk2", 1, ()), ("sdirk2, 2 ranks", 2, ()), ("euler", 1, ("-stepper_type", "euler"))):
        run = Run.of_case(SAND, *START, *DRAIN, *options, ranks=ranks)
        for probe, Sh in (("free", 0.0), ("narrow", SH)):
            got, want = run.probe(probe)["S_g"][-1], (1 - Sh) * share(PC, Sh)
            rows.append((name, probe, got, want, got / want - 1))
            judge(ROW, f"drained, {name}: S_g of the {probe} half, relative", abs(got / want - 1), 1e-6)
        last[name] = np.array([run.probe(p)["S_g"] for p in S])
        balances(f"drained, {name}", run)
    print("\ndrained to p_c of 60 kPa")
    table(("", "half", "S_g", "exact", "relative error"), rows)
    judge(ROW, "drained, two ranks against one: largest difference of S_g", np.max(np.abs(last["sdirk2"] - last["sdirk2, 2 ranks"])), 1e-9)
    short = (*HYBRID, "-stepper_cfl", "0.3", "-mat_sand_permeability_k0", "1e-9 m^2", "-grid_cells", "4,1", "-time_end", "8 s", "-output_probe_every", "8 s")
    run = Run.of_case(SAND, *START, *DRAIN, *short)
    for probe, Sh in (("free", 0.0), ("narrow", SH)):
        judge(ROW, f"drained for 8 s, hybrid: S_g of the {probe} half, relative", abs(run.probe(probe)["S_g"][-1] / (1 - Sh) / share(PC, Sh) - 1), 5e-4)
    balances("drained, hybrid", run)
    out = scratch() / "half"
    Run.of_case(SAND, *START, *DRAIN, "-time_end", "3000 s", out=out)
    Run.of_case(SAND, *START, *DRAIN, "-restart", out / "checkpoint.h5", out=out)
    whole = Run.of_case(SAND, *START, *DRAIN, "-output_times", "3000 s")
    again = Run(out)
    check("drained: restart, bit for bit", max(np.max(np.abs(whole.probe(p)["S_g"][-5:] - again.probe(p)["S_g"][-5:])) for p in S), 0.0)


def equilibrium(T, Sh, Sg, p0):
    """S_h, S_g, p of the closed isothermal cell at p = p_e(T); per m^3 of pores."""
    cell = exact.masuda_cell()
    water = lambda p: 1000.0 * np.exp((p - 2.84e6) / 2.2e9)
    law = exact.Retention(p0=1e6, m=0.5, Swr=0.1, Sgr=0.02)
    pc_of = lambda s, h: law.invert(s) * (1 - h) ** -N
    s0 = Sg / (1 - Sh)
    pc0 = pc_of(s0, Sh)
    pw0 = p0 - s0 * pc0
    per_g = 0.016 / (exact.R_GAS * (T + exact.ZERO_C))
    mh0, mw0, mg0 = Sh * 900, (1 - Sh - Sg) * water(pw0), Sg * per_g * (pw0 + pc0)

    def state(formed):
        h = (mh0 + formed) / 900
        mw, mg = mw0 - formed * 6 * 0.018 / 0.124, mg0 - formed * 0.016 / 0.124

        def lacks(s):
            pc = pc_of(s, h)
            return (1 - h) * (1 - s) * water(mg / ((1 - h) * s * per_g) - pc) - mw

        s = exact.bisect(lacks, 0.03, 0.85)
        pg = mg / ((1 - h) * s * per_g)
        return {"S_h": h, "S_g": (1 - h) * s, "p": pg - (1 - s) * pc_of(s, h), "p_g": pg}

    formed = exact.bisect(lambda f: state(f)["p"] - cell.equilibrium_pressure(T), -0.5 * mh0, 0.5 * mh0, 60)
    return state(formed)


def reacts():
    """p0 of 1 MPa: without (320) S_g would be off by what the table shows."""
    fixed = ("-fields", "water,gas", "-mat_core_kinetics_K0", "3.6e5 mol/(m^2 Pa s)", "-mat_core_retention_p0", "1 MPa", "-mat_core_retention_Sgr", "0.02", "-region_cell_Sh", "0.5", "-region_cell_Sw", "0.3", "-region_cell_Sg", "0.2")
    narrow = ("-mat_core_retention_hydrate_exponent", N)
    for what, p0 in (("dissociates", 2e6), ("forms", 5e6)):
        want, rows = equilibrium(2.3, 0.5, 0.2, p0), []
        for name, options in (("sdirk2", narrow), ("hybrid", (*narrow, *HYBRID, "-time_end", "30 s", "-output_probe_every", "30 s")), ("without (320)", ())):
            run = Run.of_case(CELL, *fixed, "-region_cell_pressure", f"{p0} Pa", *options)
            v = run.probe("middle")
            got = {"S_h": v["S_h"][-1], "S_g": v["S_g"][-1], "p": v["p_Pa"][-1], "p_g": v["p_g_Pa"][-1]}
            rows.append((name, *(got[k] / want[k] - 1 for k in want), len(run.balance["time_s"])))
            if options:
                judge(ROW, f"hydrate {what}, {name}: equilibrium, largest relative error", max(map(abs, rows[-1][1:5])), 1e-5)
                balances(f"hydrate {what}, {name}", run)
        print(f"\nhydrate {what}: relative errors at equilibrium; exact", ", ".join(f"{k} {v:.6g}" for k, v in want.items()))
        table(("", *want, "steps"), rows)


def unchanged():
    none = ("-region_narrow_Sh", "0", "-region_narrow_Sw", "0.6", "-region_narrow_Sg", "0.4", *DRAIN, "-time_end", "2000 s")
    one, other = (Run.of_case(SAND, *none, "-mat_sand_retention_hydrate_exponent", n) for n in (N, 0))
    check("without hydrate: S_g with (320) and without, bit for bit", max(np.max(np.abs(one.probe(p)["S_g"] - other.probe(p)["S_g"])) for p in S), 0.0)


if __name__ == "__main__":
    rest()
    drained()
    reacts()
    unchanged()
    finish()
