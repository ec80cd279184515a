#!/usr/bin/env python3
"""Hydrate in water without gas: a well or a heater makes the first of it.

What one writes first: hydrate in water, no gas anywhere, and a well or a heater that makes the first of it ((101)-(104), (352), (371)).

The tutorial's well in three layers with `Sg: 0` in all of them, on softer ground, 30 days; the same with a heater of 60 degC beside a well that keeps its pressure, 10 days.
Either ends in few steps: with a diffusion (200) of its own for each fluid the heater takes 151, and the well 113 with the k_r of t_n in the drag (197) of its wall.
Neither got past its first gas where only a trace of methane is in the water (102) and the water's pressure drives the reaction.
"""
import re
import sys

import numpy as np

from common import ROOT, Run, check_true, finish, judge, scratch, table

sys.path.insert(0, str(ROOT / "scripts"))
from tutorial import case_text, heated, without_gas  # noqa: E402

CASES = ROOT / "tests" / "verification" / "cases"
DAY = 86400.0
HEATER = ("-bc_well_pressure", "11 MPa", "-time_end", "10 d", "-output_every", "2 d")


def soft(text):
    """The tutorial's case on ground half as stiff, which settles twice as far off the grid's lines, just within the stability of hydrate, and begun with the default step."""
    for was, now in (("E0: 100 MPa, nu", "E0: 50 MPa, nu"), ("E0: 200 MPa, Eh", "E0: 100 MPa, Eh"), ("14.43 degC", "14.4 degC"), (", dt: 1 min}", "}")):
        if was not in text:
            raise ValueError(f"the tutorial's case has no {was}")
        text = text.replace(was, now)
    return text


def scenes():
    """The two cases: tutorial's layers without gas, and a heater in them."""
    well = soft(without_gas(case_text()))
    out = scratch()
    for name, text in (("well", well), ("heater", soft(heated(without_gas(case_text()))))):
        (out / f"{name}.yaml").write_text(text)
    return out / "well.yaml", out / "heater.yaml"


def sound(name, run, steps, pressure, temperature):
    """Ends, in a number of steps, within the bounds of its conditions, with masses closed."""
    states = [v for _, v in run.snapshots()]
    for v in states:
        v["p"] = (v["S_w"] * v["p_w"] + v["S_g"] * v["p_g"]) / (1 - v["S_h"])
    least, most = (lambda q: min(v[q].min() for v in states)), (lambda q: max(v[q].max() for v in states))
    taken, refused = map(int, re.search(r"(\d+) steps, (\d+) refused", run.output).groups())
    table(("", "steps", "refused", "p (MPa)", "", "T (degC)", "", "S_g"), [(name, taken, refused, least("p") / 1e6, most("p") / 1e6, least("T"), most("T"), most("S_g"))])
    judge("gas", f"first gas, {name}: steps", float(taken), float(steps))
    judge("gas", f"first gas, {name}: steps refused", float(refused), 30.0)
    sand = min(v["p"][(v["initial_position"][:, 1] > 3) & (v["initial_position"][:, 1] < 7)].min() for v in states)
    nodes = min(np.nanmin(v["p_w"]) for _, v in run.snapshots("grid")[1:])
    judge("gas", f"first gas, {name}: lowest pore pressure of the sand, MPa", sand / 1e6, (pressure - 0.1, 12))
    # A row of clay whose border has left the grid's lines, between its neighbours in a cell, and its nodes, docs/limits.md.
    judge("gas", f"first gas, {name}: lowest p_w of a node, MPa", nodes / 1e6, (pressure - 0.5, 12))
    judge("gas", f"first gas, {name}: lowest pore pressure of a particle, MPa", least("p") / 1e6, (pressure - 1.0, 12))
    judge("gas", f"first gas, {name}: warmest, degC", most("T"), temperature + 0.1)
    judge("gas", f"first gas, {name}: largest S_g", most("S_g"), (0.02, 0.8))
    for what in ("water", "methane"):
        judge("gas", f"first gas, {name}: {what}, largest error of any step", np.max(np.abs(run.balance[f"{what}_error"])), 1e-12)


def starts(well):
    """Clay of another p_0 without hydrate: its water starts in equilibrium with the hydrate of the sand (103), and a fast reaction finds nothing to do."""
    cold = [o for r in ("lower", "layer", "upper") for o in (f"-region_{r}_temperature", "12 degC")]
    (_, first), (_, last) = Run.of_case(well, *cold, "-mat_clay_retention_p0", "1 MPa", "-mat_sand_kinetics_K0", "3.6e4 mol/(m^2 Pa s)", "-mat_sand_kinetics_dE", "81 kJ/mol", "-boundaries", "base,casing,far,burden",
                                        "-time_end", "1 h", "-output_times", "0 h, 1 h").snapshots()  # fmt: skip
    judge("gas", "first gas, clay beside hydrate: p_g of the start, largest over smallest, less one", np.max(first["p_g"]) / np.min(first["p_g"]) - 1, 1e-12)
    judge("gas", "first gas, clay beside hydrate: largest change of S_h in an hour", np.max(np.abs(last["S_h"] - first["S_h"])), 1e-7)


def fast(scene, coldest, most, *options):
    """Coarse cells, p_0 of 15 kPa and a reaction that holds T at equilibrium, with gas of donors, (332).
    Steps were cut to seconds where Newton's method had to take the update of methane (104) or nothing, and where rows of gas were held to less than their round-off."""
    run = Run.of_case(CASES / "fast_well.yaml", *options)
    taken, refused = map(int, re.search(r"(\d+) steps, (\d+) refused", run.output).groups())
    judge("gas", f"first gas, {scene}: steps", float(taken), 75.0)
    judge("gas", f"first gas, {scene}: steps refused", float(refused), 6.0)
    v = run.snapshots()[-1][1]
    sand = (v["initial_position"][:, 1] > 4) & (v["initial_position"][:, 1] < 8)
    p = (v["S_w"] * v["p_w"] + v["S_g"] * v["p_g"]) / (1 - v["S_h"])
    judge("gas", f"first gas, {scene}: lowest pore pressure of the sand, MPa", p[sand].min() / 1e6, (4.8, 13))  # the well's: 5
    judge("gas", f"first gas, {scene}: coldest, degC", v["T"].min(), (coldest, 13))  # of hydrate at 5 MPa: 6.8
    judge("gas", f"first gas, {scene}: largest S_h, which started at 0.6", v["S_h"].max(), most)
    for what in ("water", "methane"):
        judge("gas", f"first gas, {scene}: {what}, largest error of any step", np.max(np.abs(run.balance[f"{what}_error"])), 1e-12)


def in_row(width, most, *options):
    """A row of that well, of cells of `width` m at the well and `most` m far from it, after 9 days."""
    return Run.of_case(CASES / "fast_row.yaml", "-grid_spacing_x", f"{width} m,{most} m,growth 1.2", *options)


def released(run):
    """Methane that its hydrate has given, kg."""
    return sum(c[-1] - c[0] for k, c in run.csv("meters.csv").items() if k in ("well.gas_kg", "free_gas_kg", "dissolved_gas_kg"))


def falls(run):
    """By how much S_h falls outwards in it from one particle to the next, more than 1 m from its axis, where it rises with the temperature."""
    v = run.snapshots()[-1][1]
    place = v["initial_position"]
    lower = np.flatnonzero(place[:, 1] < 0.5)
    out = lower[np.argsort(place[lower, 0])]
    return np.max(-np.diff(v["S_h"][out, 0])[place[out[1:], 0] > 1])


def row():
    """Hydrate melts because pressure falls, at equilibrium: (381) holds nothing there.  Between nodes at equilibrium particles are at equilibrium, too, (424)."""
    coarse, fine = in_row(0.4, 4), in_row(0.1, 0.25)
    share = lambda run: released(run) / released(fine)
    judge("gas", "first gas, a fast reaction in a row: methane of cells of 0.4 to 4 m, against 0.1 to 0.25 m", abs(share(coarse) - 1), 0.04, 0.01, "%")
    judge("gas", "first gas, a fast reaction in a row: ... with donors", abs(share(in_row(0.4, 4, "-stabilisation_donor", "yes")) - 1), 0.04, 0.01, "%")
    judge("gas", "first gas, a fast reaction in a row: S_h falls outwards by", max(falls(coarse), 0.0), 0.005)


def main():
    well, heater = scenes()
    starts(well)
    # What rises forms anew below the upper clay: 0.616 in cells half as wide.
    fast("a fast reaction in coarse cells", 6.6, 0.64, "-time_end", "4 d", "-output_every", "1 d")
    row()
    one = Run.of_case(well)
    sound("well", one, 110, 6.0, 14.4)
    sound("heater", Run.of_case(heater, *HEATER), 140, 11.0, 60.0)
    short = ("-time_end", "0.2 d", "-output_times", "0.2 d", "-stepper_adapt", "no", "-stepper_dt", "8 min")  # the same steps
    a, b = (Run.of_case(well, *short, ranks=n).csv("meters.csv") for n in (1, 2))
    key = "well.gas_kg"
    judge("gas", "first gas, well: gas of five hours, two ranks against one, relative", abs(b[key][-1] / a[key][-1] - 1), 1e-6)
    gas, water = (one.csv("meters.csv")[k][-1] for k in ("well.gas_kg", "well.water_kg"))
    finer = Run.of_case(well, "-stepper_tol", "3e-3", "-time_end", "6 d")
    coarse = one.csv("meters.csv")
    at = np.argmin(np.abs(coarse["time_s"] - 6 * DAY))
    judge("gas", "first gas, well: gas after 6 days, against a third of the tolerance", abs(coarse["well.gas_kg"][at] / finer.csv("meters.csv")["well.gas_kg"][-1] - 1), 0.05, 0.01, "%")
    print(f"30 days: {gas / 1e3:.3g} t of gas, {water / 1e3:.4g} t of water")


if __name__ == "__main__":
    main()
    finish()
