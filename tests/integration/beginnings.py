#!/usr/bin/python3
"""Warnings of a start that does not stay as it is: they come where they should, with numbers, and in no shipped case but one that lets its body settle first, and slopes whose gas is given as trapped.

Unstressed bodies, pore pressures far from hydrostatic (341), gas that rises (315), capillary pressures that jump (342), gas below its residual share, hydrate outside its
stability zone, gas inside it.  -case_check says them as a run does, and writes nothing."""
import re
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "verification"))
from common import CASES, binary, check, check_true, finish, launch, pascals, program_of, scratch  # noqa: E402

import clathra  # noqa: E402  python/, which common puts on the path
import tutorial  # noqa: E402

COLUMN = HERE.parent / "verification" / "cases" / "geostatic.yaml"  # in balance, two layers, 20 m
COLUMN_OF_GAS = HERE.parent / "verification" / "cases" / "rest_hydrostatic.yaml"  # water and next to no gas, 1 m
CLIFF = HERE.parent / "verification" / "cases" / "slope.yaml"  # hybrid
BLOCK = HERE.parent / "verification" / "cases" / "reacting_column.yaml"  # hydrate, S_h 0.4
CLAYS = HERE.parent / "verification" / "cases" / "no_gas_clay.yaml"  # a drained sand of hydrate between two
WORDS = {"stress": "unstressed body", "pressure": "far from hydrostatic", "rises": "gas starts out of balance with gravity", "hydrate": "starts outside its stability zone", "gas": "free gas starts where hydrate is stable",
         "capillary": "touch and start with p_g - p_w", "closed": "nothing flows through them", "free": "nothing bears the pore pressure", "rate": "have been measured", "trapped": "gas starts below its residual share"}


def warned(done, case):
    check_true(f"{case}: begins", done.returncode == 0, done.stdout[-300:] if done.returncode else "")
    return [line for line in done.stdout.splitlines() if "warning" in line or line.startswith("  What to try")]


def said(case, *options, ranks=1):
    return warned(launch(program_of(case), case, "-case_check", *options, ranks=ranks), case)


def same(what, case, *options, least=1):
    """-case_check warns as a run does, and leaves nothing behind."""
    out = scratch() / "out"
    check, run = (warned(launch(binary(), case, *o, *options, out=out), case) for o in (["-case_check"], ["-quiet", "-stepper_max_steps", 0]))
    check_true(f"{what}: -case_check warns as the run does", check == run and len(run) >= least, (check, run))
    launch(binary(), case, "-case_check", *options, out=out.parent / "none")
    check_true("... and writes nothing", not (out.parent / "none").exists())


def comes(what, expected, lines):
    found = [k for k, words in WORDS.items() if any(words in line for line in lines)]
    check_true(f"{what}: {', '.join(expected) or 'nothing'} is warned of", found == expected, found)
    return "\n".join(lines)


def numbers(text, words):
    """The numbers that follow the words, pressures in Pa."""
    found = re.findall(r"([-+]?\d+\.?\d*(?:e[-+]?\d+)?)(?: ([kM]Pa)\b)?", text[text.index(words) + len(words):])
    return [pascals(f"{x} {unit or 'Pa'}") for x, unit in found]


def check_rate():
    """A constant of Kim and Bishnoi without its activation energy, and an energy in the wrong unit.  The scene melts from the start, and is warned of for that, too."""
    rate = lambda K0, dE: said(BLOCK, "-mat_core_kinetics_K0", f"{K0:g} mol/(m^2 Pa s)", "-mat_core_kinetics_dE", f"{dE:g} J/mol")
    plain = comes("K0 with its dE", ["hydrate"], rate(3.6e4, 81e3))
    text = comes("K0 without dE", ["hydrate", "rate"], rate(3.6e4, 0))
    check_true("... with keys, numbers and what goes together", all(w in text for w in ("mat_core_kinetics_K0 = 36000 mol/(m^2 Pa s)", "mat_core_kinetics_dE = 0 J/mol", "K_d = 3.6e+04", "at once", "78 to 81 kJ/mol")), text)
    check_true("... and where they are given", text.count("command line: warning: mat_core_kinetics_K0") == 1, text)
    comes("dE of J for kJ", ["hydrate", "rate"], rate(3.6e4, 78))
    check_true("dE ten times too large", "never reacts" in comes("dE ten times too large", ["hydrate", "rate"], rate(3.6e4, 810e3)) and "K_d" not in plain)
    comes("K0 as K_d, without dE", ["hydrate"], rate(2.5e-10, 0))
    path, text = scratch() / "swift.yaml", re.sub(r"dE: \d+", "dE: 78", BLOCK.read_text())
    path.write_text(text)
    line = next(i for i, words in enumerate(text.splitlines(), 1) if "dE: 78 " in words)
    text = comes("K0 of a file", ["hydrate", "rate"], said(path))
    check_true("... with its file and line", f"{path}:{line}: warning: mat_core_kinetics_K0" in text, text)


STARTS = {"slope_warming": ["stress", "rises"]}  # its first twenty years are for that: no reaction, an elastic skeleton
STARTS |= {f"slope_{k}": ["trapped"] for k in ("a", "b", "c", "3d")}  # S_g/(1 - S_h) is 0.2, S_gr 0.3
check_rate()
for path in sorted(CASES.glob("*/case.yaml")):
    comes(f"cases/{path.parent.name}", STARTS.get(path.parent.name, []), said(path.parent))

# ---------------------------------------------------------------- a roller that closes a well
well = scratch() / "well.yaml"
well.write_text(tutorial.case_text())
comes("the tutorial's well", [], said(well))
text = comes("... without `holds: skeleton` on its casing", ["closed"], said(well, "-bc_casing_holds", "all"))
check_true("... which two and where is said, and what mends it", "boundary casing holds" in text and "at x = 0.1 m" in text and "boundary well" in text and "bc_casing_holds: skeleton" in text, text)
comes("a roller on the other side", [], said(well, "-bc_far_holds", "all"))
comes("a roller on another line", [], said(well, "-bc_well_side", "top", "-bc_well_from", "1 m", "-bc_casing_holds", "all"))
done = launch(binary(), well, "-quiet", "-bc_casing_holds", "all", "-time_end", "1 d", "-output_every", "1 d", out=(closed := scratch() / "closed"))
moved = clathra.Run(closed).meter("well")
check("... and it is true: nothing comes out", max(abs(moved["water_kg"][-1]), abs(moved["gas_kg"][-1])), 1e-3)

# ---------------------------------------------------------------- a side that nothing bears
text = comes("... without its burden", ["free"], said(well, "-boundaries", "base,casing,far,well"))
E, nu = (clathra.Run(closed).case[f"mat_clay_elasticity_{k}"] for k in ("E0", "nu"))
check("... the strain by which it would swell, %", abs(numbers(text, "swells by some")[0] / (100 * 11e6 / (E * (1 - nu) / ((1 + nu) * (1 - 2 * nu)))) - 1), 0.05)
check_true("... which side, what pressure, and what keeps it", "of 11 MPa at the body's top" in text and "normal: 11 MPa" in text and text.count("nothing bears") == 1, text)
check_true("... each of three that are free", "\n".join(said(well, "-boundaries", "casing,well")).count("nothing bears") == 3)
text = comes("... with its burden, but nothing at its far side", ["free"], said(well, "-boundaries", "base,casing,well,burden"))
check_true("... which it does not bear", "at the body's right" in text and text.count("nothing bears") == 1, text)
comes("... with an ambient pressure", [], said(well, "-boundaries", "base,casing,far,well", "-ambient_pressure", "11 MPa"))
comes("... ten thousand times stiffer", [], said(well, "-boundaries", "base,casing,far,well", "-mat_clay_elasticity_E0", "500 GPa"))

# ---------------------------------------------------------------- pressure
UNIFORM = [o for r in ("deep", "shallow") for o in (f"-region_{r}_hydrostatic", "no", f"-region_{r}_pressure", "0.3 MPa")]
comes("a column in balance", [], said(COLUMN))
text = comes("a uniform pressure", ["pressure"], said(COLUMN, *UNIFORM))
weight = 1000 * 9.81 * 20
apart, region = re.search(r"has (\S+ [kM]?Pa) more beyond water at rest than region (\w+)", text).groups()
check("... by the weight between the highest and the lowest particle", abs(pascals(apart) / (1000 * 9.81 * 19) - 1), 0.01)
check_true("... highest in the upper layer, lowest in the lower", "region shallow at" in text and region == "deep")
check("... the water's weight", abs(numbers(text, "the water weighs")[0] / weight - 1), 0.01)
check_true("... the same on 2 ranks", text in "\n".join(said(COLUMN, *UNIFORM, ranks=2)))
text = comes("layers of two levels", ["pressure"], said(COLUMN, "-region_deep_datum", "45 m"))
check("... which differ by 5 m of water", abs(pascals(re.search(r"has (\S+ [kM]?Pa)", text).group(1)) / 49050 - 1), 0.02)
comes("layers half a metre apart", [], said(COLUMN, "-region_deep_datum", "40.5 m"))
comes("a uniform pressure in gravity that grows", [], said(COLUMN, *UNIFORM, "-gravity_ramp", "1 s", "-region_deep_stress_geostatic", "no", "-region_shallow_stress_geostatic", "no"))
comes("water that expands, in a steep geotherm", [], said(COLUMN, "-mat_clay_water_bulk_modulus", "1 GPa", "-mat_sand_water_expansion", "1e-3 1/K", "-mat_clay_water_expansion", "1e-3 1/K"))

# ---------------------------------------------------------------- gas under gravity (315)
def gas(share, *options, **kwargs):
    return said(COLUMN_OF_GAS, "-region_column_Sg", f"{share}", "-region_column_Sw", f"{1 - share}", "-mat_sand_gas_viscosity", "1e-5 Pa s", "-mat_sand_relperm_Sgr", "0.05", "-mat_sand_retention_Sgr",
                "0.05", "-region_column_pressure", "0.1 MPa", "-mat_sand_gas_molar_mass", "1.6 kg/mol", "-mat_sand_hydrate_molar_mass", "1.708 kg/mol", "-region_column_stress_geostatic", "0.5", *options, **kwargs)


WIDE = ("-grid_cells", "3,10")
text = comes("gas that can move, with the gradient of water", ["rises"], gas(0.3, *WIDE))
apart, speed = re.search(r"has (\S+ [kM]?Pa) more .* some ([\d.e+-]+) m a day", text).groups()
buoyancy = (1000 - 0.1e6 / (8.314 / 1.6 * 283.15)) * 9.81  # a heavy gas
check("... by the weight of the water less that of the gas", abs(pascals(apart) / (buoyancy * 0.9) - 1), 0.02)
check("... as fast as its mobility says", abs(float(speed) / (1e-13 * (0.25 / 0.85) ** 2 / (1e-5 * 0.4 * 0.3) * buoyancy * 86400) - 1), 0.05)
check_true("... the same on 2 ranks", text in "\n".join(gas(0.3, *WIDE, ranks=2)))
comes("... but slowly in so short a run", [], gas(0.1))
comes("... and in a longer one", ["rises"], gas(0.1, "-time_end", "1 h"))
comes("gas that cannot move", [], gas(0.05, "-time_end", "10 d"))
comes("... nor in a longer run", [], gas(0.05, "-time_end", "100000 d"))
level = {"pressure": "13 MPa", "hydrostatic": "yes", "datum": "9 m", "geothermal": "60 K/km", "stress_geostatic": "0.5"}
sealed = [o for r in ("lower", "layer", "upper") for name, value in level.items() for o in (f"-region_{r}_{name}", value)]
comes("hydrate without gas under clay, each with the p_g of hydrate", [], said(CLAYS, *sealed, "-gravity", "0 m/s^2,-9.81 m/s^2", "-region_layer_Sg", "0", "-region_layer_Sw", "0.5", "-mat_clay_retention_p_trap", "50 kPa", "-mat_clay_retention_Sgr", "0.03"))
comes("gas that can, and no gravity to speak of", [], gas(0.3, "-gravity", "0 m/s^2,-1e-3 m/s^2"))

# ---------------------------------------------------------------- -case_check and the run
same("gas that rises", COLUMN_OF_GAS, "-region_column_Sg", "0.3", "-region_column_Sw", "0.7", "-region_column_stress_geostatic", "0.5", "-mat_sand_gas_viscosity", "1e-5 Pa s", "-mat_sand_relperm_Sgr", "0")
same("no stress and a uniform pressure", COLUMN, *UNIFORM, "-region_deep_stress_geostatic", "no", least=2)
comes("a cliff by hybrid, whose surface cuts cells", [], said(CLIFF))

# ---------------------------------------------------------------- stress
text = comes("no stress", ["stress"], said(COLUMN, "-region_deep_stress_geostatic", "no"))
weight, metres = re.search(r"weight, (\S+ [kM]?Pa) from top to foot, and will move, by some ([\d.e+-]+) m", text).groups()
buoyant = 0.6 * (2650 - 1000) * 9.81 * 8
check("... its weight under water", abs(pascals(weight) / buoyant - 1), 0.01)
check("... how far it would sink", abs(float(metres) / (buoyant * 8 / 2 / (50e6 * 0.7 / (1.3 * 0.4))) - 1), 0.01)

# ---------------------------------------------------------------- hydrate
both = lambda **k: [o for r in ("left", "right") for name, value in k.items() for o in (f"-region_{r}_{name}", value)]
comes("hydrate that is stable", [], said(BLOCK, *both(pressure="3.8 MPa")))
text = comes("hydrate below its pressure", ["hydrate"], said(BLOCK))
share, _, _, T, needs, has, up_to = numbers(text, "stability zone,")[:7]
p_e = lambda T: 1.15 * np.exp(49.3185 - 9459 / (T + 273.15))
check("... needs the pressure of equilibrium", abs(needs / p_e(2.3) - 1), 1e-3)
check("... has its mean pore pressure", abs(has / 2.84e6 - 1), 1e-3)
check("... and would be stable up to", abs(p_e(up_to) / has - 1), 1e-3)
check_true("... all of it", share == 100 and T == 2.3)
comes("hydrate that does not react", [], said(BLOCK, "-mat_core_kinetics_K0", "0 mol/(m^2 Pa s)"))

# ---------------------------------------------------------------- gas
text = comes("gas far above the pressure of equilibrium", ["gas"], said(BLOCK, *both(pressure="5 MPa")))
T, needs, has, up_to = numbers(text[text.index(") m: at") :], "at")[:4]
check("... hydrate forms above", abs(needs / p_e(T) - 1), 1e-3)
check("... there are", abs(has / 5e6 - 1), 1e-3)
check("... up to", abs(p_e(up_to) / has - 1), 1e-3)
check_true("... the same on 2 ranks", text in "\n".join(said(BLOCK, *both(pressure="5 MPa"), ranks=2)))
comes("gas that would warm the sediment by 0.4 K", [], said(BLOCK, *both(pressure=f"{p_e(2.7):.0f} Pa")))
comes("... and by 0.6 K", ["gas"], said(BLOCK, *both(pressure=f"{p_e(2.9):.0f} Pa")))
comes("gas that does not react", [], said(BLOCK, *both(pressure="5 MPa"), "-mat_core_kinetics_K0", "0 mol/(m^2 Pa s)"))

# ---------------------------------------------------------------- capillary pressure: (223) inverted, m = 0.5
STILL = [*both(pressure="3.8 MPa", Sh="0"), "-mat_core_kinetics_K0", "0 mol/(m^2 Pa s)"]
shares = lambda left, right: [o for r, g in (("left", left), ("right", right)) for o in (f"-region_{r}_Sg", f"{g}", f"-region_{r}_Sw", f"{1 - g}")]
pc = lambda share: 10 * np.sqrt((1 - (share - 0.01) / 0.89) ** -2 - 1)  # kPa, p0 10 kPa, Swr 0.1, Sgr 0.01
comes("one gas share", [], said(BLOCK, *STILL, *shares(0.2, 0.2)))
text = comes("gas below its residual share", ["trapped"], said(BLOCK, *STILL, *shares(0.03, 0.03), *both(Sh="0.2"), *both(Sw="0.77"), "-mat_core_retention_Sgr", "0.05"))
check_true("... with keys and values, once for each region", all(text.count(f"region_{r}_Sg = 0.03 and region_{r}_Sh = 0.2 are Sg/(1 - Sh) = 0.0375 of the open pores, mat_core_retention_Sgr is 0.05") == 1 for r in ("left", "right")), text)
check("... p_g below p_w, that of trapped gas (223)", abs(numbers(text, "with p_g")[0] / (10e3 * np.log(0.05 / 0.0375)) - 1), 0.05)
check_true("... the same on 2 ranks", text in "\n".join(said(BLOCK, *STILL, *shares(0.03, 0.03), *both(Sh="0.2"), *both(Sw="0.77"), "-mat_core_retention_Sgr", "0.05", ranks=2)))
comes("gas of its residual share", [], said(BLOCK, *STILL, *shares(0.05, 0.05), "-mat_core_retention_Sgr", "0.05"))
comes("two whose p_g - p_w are less than 10 kPa apart", [], said(BLOCK, *STILL, *shares(0.2, 0.45)))
text = comes("two that are further apart", ["capillary"], said(BLOCK, *STILL, *shares(0.2, 0.6)))
low, high = map(float, re.search(r"p_g - p_w of ([\d.]+) kPa and ([\d.]+) kPa", text).groups())
check("... p_g - p_w of the one, that of (223) but for its smooth corner", abs(low / pc(0.2) - 1), 0.02)
check("... of the other", abs(high / pc(0.6) - 1), 0.02)
check_true("... the same on 2 ranks", text in "\n".join(said(BLOCK, *STILL, *shares(0.2, 0.6), ranks=2)))
comes("two that do not touch", [], said(BLOCK, *STILL, *shares(0.2, 0.6), "-region_right_lower", "0.6 m, 0 m"))
text = comes("one without gas", ["capillary"], said(BLOCK, *STILL, *shares(0, 0.2)))
check_true("... which is said", "(no gas) and" in text, text)
check_true("... and what is in balance", "in this order: Sg: 0 in both or neither" in text, text)
finer = scratch() / "finer.yaml"  # the right half of three times the p_0, with hydrate; no reaction
finer.write_text(BLOCK.read_text().replace("materials: [core]", "materials: [core, fine]").replace("regions: [left", "mat_fine: {like: core, retention: {p0: 30 kPa, m: 0.5, Swr: 0.1, Sgr: 0.01}, kinetics: {active: no}}\nregions: [left")
                 .replace("Sh: 0, Sw: 0.6666667, Sg: 0.3333333", "Sh: 0.3, Sw: 0.5, Sg: 0.2").replace("0.04 m], particles_per_cell: [2, 1], material: core, pressure: 2.84 MPa,\n    temperature: 2.3 degC, Sh: 0.3", "0.04 m], particles_per_cell: [2, 1], material: fine, pressure: 2.84 MPa,\n    temperature: 2.3 degC, Sh: 0.3"))
CALM = ("-mat_core_kinetics_active", "no", "-mat_fine_kinetics_active", "no")
text = comes("a finer half with as much gas", ["capillary"], said(finer, *CALM))
low, high = map(float, re.search(r"p_g - p_w of ([\d.]+) kPa and ([\d.]+) kPa", text).groups())
share, where = re.search(r"in this order: Sg: ([\d.]+) in (\w+),", text).groups()
check_true("... what the finer one holds in balance is said (346)", where == "right", where)
held = lambda pc: 1 - 0.1 - 0.89 * (1 + (pc / 30) ** 2) ** -0.5  # (223) of the finer half, m = 0.5
check("... the gas share of (223) there, but for its smooth corner", abs(float(share) / (0.7 * held(low)) - 1), 0.02)
comes("... and with that gas", [], said(finer, *CALM, "-region_right_Sg", share, "-region_right_Sw", f"{0.7 - float(share):.9g}"))
done = launch(binary(), finer, "-quiet", "-stepper_max_steps", 0, *CALM, "-region_right_Sg", share, "-region_right_Sw", f"{0.7 - float(share):.9g}", out=scratch() / "balanced")
run = clathra.Run(scratch() if done.returncode else Path(done.args[-1]))
p = run.particles(run.times[0])
pc = (p["p_g"] - p["p_w"]).ravel()
check("... p_g - p_w is one all over, of the jump before", np.ptp(pc) / (1e3 * (high - low)), 1e-3)
finish()
