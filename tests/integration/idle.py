#!/usr/bin/python3
"""Keys that do nothing in a scene are said to be idle, with the reason; keys that it does not need are not asked for.

A table of both; none of the shipped cases has an idle key, nor has any case as it ran (the resolved case)."""
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, ROOT, binary, check_true, finish, launch, program_of, scratch  # noqa: E402

FOLDER = scratch()


def idle(case, *options):
    """{key: reason} of those that the program says do nothing; ends the test if the case is refused."""
    done = launch(program_of(case), case, "-case_check", *options)
    if done.returncode:
        print(done.stdout)
        sys.exit(f"{case}: refused")
    note = next((line for line in done.stdout.splitlines() if ": note: " in line), "")
    return dict(re.findall(r"(-?\w+) \(((?:no|it acts) [^()]*)\)", note))


def says(what, expected, case, *options):
    found = idle(case, *options)
    missing = {k: v for k, v in expected.items() if v not in found.get(k, "")}
    check_true(what, not missing and found.keys() == expected.keys(), found)


# ---------------------------------------------------------------- a law's, of another law
M = "mat_sediment_"
PLASTIC = ("-mat_sediment_plasticity_law", "mohr_coulomb", "-mat_sediment_plasticity_cohesion_max", "1 MPa", "-mat_sediment_plasticity_friction_peak", "30 deg")
for expected, options in (
    ({}, ()),
    ({"-" + M + "retention_lambda": "brooks_corey"}, ("retention_lambda", "2")),
    ({M + "retention_m": "van_genuchten"}, ("retention_law", "brooks_corey", "retention_lambda", "2")),
    ({"-" + M + "retention_p_trap": "van_genuchten"}, ("retention_law", "van_genuchten_clamped", "retention_p_trap", "1 kPa")),
    ({M + "gas_viscosity": "viscosity_law is constant"}, ("gas_viscosity_law", "lee")),
    ({M + "water_viscosity": "viscosity_law is constant"}, ("water_viscosity_law", "kestin")),
    ({"-" + M + "gas_critical_pressure": "peng_robinson"}, ("gas_critical_pressure", "4 MPa")),
    ({}, ("gas_critical_pressure", "4 MPa", "gas_critical_temperature", "200 K", "gas_eos", "peng_robinson")),
    ({M + "permeability_mh": "power", "-" + M + "permeability_phi0": "porosity_law is not none"},
     ("permeability_hydrate_law", "none", "permeability_porosity_law", "none", "permeability_phi0", "0.2")),
    ({"-" + M + "permeability_kh": "masuda_ramp"}, ("permeability_kh", "0.2")),
    ({f"{M}kinetics_A{k}": "sloan" for k in (1, 2, 3)}, ("kinetics_equilibrium", "kamath")),
    ({"-" + M + "latent_heat_T_ref": "kirchhoff"}, ("latent_heat_T_ref", "4 degC")),
    ({"-" + M + "plasticity_cohesion_max": "mohr_coulomb"}, ("plasticity_cohesion_max", "1 MPa")),
    ({"-" + M + "plasticity_eccentricity": "menetrey_willam"}, (*(o.replace("-" + M, "") for o in PLASTIC), "plasticity_flow", "mohr_coulomb", "plasticity_eccentricity", "0.2")),
):  # fmt: skip
    pairs = [o if k % 2 else "-" + M + o for k, o in enumerate(options)]
    says("bp2 with " + (" ".join(options) or "nothing else"), expected, CASES / "bp2", *pairs)
says("a datum without water at rest", {"-region_column_datum": "hydrostatic", "-region_column_geothermal_datum": "geothermal"},
     CASES / "bp2", "-region_column_datum", "1 m", "-region_column_geothermal_datum", "1 m")  # fmt: skip
reaction = [f"{M}kinetics_{k}" for k in ("K0", "dE", "A_geo", "A1", "A2", "A3")] + [M + "latent_heat_C0", M + "latent_heat_C1"]
hydrate = [f"{M}hydrate_{k}" for k in ("density", "heat_capacity", "conductivity", "expansion", "molar_mass", "number")]
found = idle(CASES / "bp2", "-fields", "thmc", "-mat_sediment_kinetics_active", "no")
check_true("kinetics and hydrate where none is and none forms", len(found) == 12 and set(found) < {*reaction, *hydrate, M + "permeability_mh"}, found)
found = idle(CASES / "bp2", "-fields", "thmc", "-mat_sediment_kinetics_active", "no", "-region_column_Sh", "0.1", "-region_column_Sw", "0.5")
check_true("kinetics alone where hydrate does not react", set(found) == set(reaction), found)

says("free saturation at a face of a scene without gas", {"-bc_drain_saturation": "no gas"}, CASES / "terzaghi", "-bc_drain_saturation", "free")

# ---------------------------------------------------------------- fields: the fewest keys that a scene needs, and one more
SCENE = """grid: {{lower: [0 m, 0 m], upper: [1 m, 1 m], cells: [4, 4]}}
time: {{end: 1 s}}
fields: {fields}
materials: [a]
mat: {{a: {{porosity: 0.3, solid: {{density: 2600 kg/m^3{solid}}}{material}}}}}
regions: [b]
region: {{b: {{lower: [0 m, 0 m], upper: [1 m, 0.5 m], material: a{region}}}}}
"""
HEAT, SKELETON, WATER = ", heat_capacity: 800 J/(kg K), conductivity: 2 W/(m K)", ", elasticity: {E0: 1 GPa, nu: 0.3}", ", permeability: {k0: 1e-12 m^2}"
GAS = ", retention: {p0: 1 kPa, m: 0.5, Swr: 0, Sgr: 0}, relperm: {nw: 2, ng: 2}"
MORE = {"heat": "mat_a_water_heat_capacity", "gas": "mat_a_gas_viscosity", "water": "mat_a_water_bulk_modulus", "solid": "mat_a_elasticity_nu", "hydrate": "mat_a_hydrate_density"}
VALUE = {"heat": "4000 J/(kg K)", "gas": "1e-5 Pa s", "water": "2 GPa", "solid": "0.2", "hydrate": "900 kg/m^3"}
for fields, has in (("m", ["solid"]), ("hm", ["solid", "water"]), ("thm", ["solid", "water", "heat"]), ("t", ["heat"]), ("th", ["water", "heat"]),
                    ("hmc", ["solid", "water", "gas"]), ("thmc", ["solid", "water", "gas", "heat"])):  # fmt: skip
    path = FOLDER / f"{fields}.yaml"
    material = (SKELETON if "solid" in has else "") + (WATER if "water" in has else "") + (GAS if "gas" in has else "")
    region = (", pressure: 1 MPa" if "water" in has else "") + (", temperature: 4 degC" if "heat" in has or "gas" in has else "") + (", Sw: 0.5, Sg: 0.5" if "gas" in has else "")
    path.write_text(SCENE.format(fields=fields, solid=HEAT if "heat" in has else "", material=material, region=region))
    says(f"{fields}: the keys of its fields are enough, and all act", {}, path)
    more = [k for k in MORE if k not in has and not (k == "heat" and "water" not in has)]
    options = [o for k in more for o in ("-" + MORE[k], VALUE[k])]
    says(f"{fields}: idle are those of {', '.join(more)}", {"-" + MORE[k]: f"no {k}" for k in more}, path, *options)

out = launch(binary(), FOLDER / "hmc.yaml", "-quiet", "-stepper_max_steps", 0, out=FOLDER / "hmc").stdout
reacts = launch(binary(), CASES / "bp2", "-fields", "hmc", "-stepper_max_steps", 0, out=FOLDER / "bp2").stdout
check_true("a scene without hydrate is no hmc", "fields: solid, water, gas;" in out and "fields: solid, water, gas (hmc);" in reacts, out.splitlines()[:3])

# ---------------------------------------------------------------- keys of another integrator
EXPLICIT = [w for k, v in (("cfl", 0.5), ("force_dt", "yes"), ("damping", 0.1), ("mass_scaling", 2)) for w in (f"-stepper_{k}", v)]
IMPLICIT = ["-stepper_tol", "1e-2", "-stepper_dt_min", "1 ns", "-stepper_error_exponent", 4, "-stabilisation_ghost_penalty", 0.01, "-newton_refactor", 3, "-newton_operator", "assembled"]
MEAN = ["-mean_strain", 0.5]
for stepper, others in (("sdirk2", EXPLICIT), ("euler", EXPLICIT), ("hybrid", IMPLICIT), ("hybrid_paper", [*IMPLICIT, *MEAN]), ("auto", [])):
    every = {w: "sdirk2, euler, auto" if w in IMPLICIT else "hybrid, explicit" for w in others[::2]}
    given = others or [*EXPLICIT, *IMPLICIT, *MEAN]
    says(f"terzaghi by {stepper} with keys of {'others' if others else 'both'}", every, CASES / "terzaghi", "-stepper_type", stepper, "-inertia", "yes", *map(str, given))
says("terzaghi by auto without inertia, where hybrid takes no step", {w: "auto; hybrid does not know inertia: no" for w in EXPLICIT[::2]},
     CASES / "terzaghi", "-stepper_type", "auto", "-inertia", "no", *map(str, [*EXPLICIT, *IMPLICIT, *MEAN]))  # fmt: skip
STAGED = ("-stages", "one,two", "-time_end", "2 s", "-output_times", "2 s", "-output_probe_every", "1 s", "-stage_one_end", "1 s", "-stage_two_end", "2 s", "-stage_two_stepper_type", "hybrid", "-stage_two_stepper_dt_max", "1 s", "-inertia", "yes")
says("a key that one of two stages knows", {}, CASES / "terzaghi", *STAGED, "-stepper_damping", "0.1")
says("... given to the other one", {"-stage_one_stepper_damping": "hybrid"}, CASES / "terzaghi", *STAGED, "-stage_one_stepper_damping", "0.1")
done = launch(binary(), CASES / "terzaghi", "-quiet", "-stepper_max_steps", 0, "-stepper_damping", "0.1", out=FOLDER / "other")
check_true("a run by sdirk2 says that damping is not its own", "-stepper_damping (it acts with hybrid" in done.stdout, done.stdout[-300:])
says("... and the case as it ran has none", {}, FOLDER / "other" / "case.yaml")

# ---------------------------------------------------------------- lists of names on the command line
says("a probe of the command line beside those of the file", {}, CASES / "terzaghi", "-probes", "base,end,more", "-probe_more_at", "0.5 m,0.01 m")
says("... in their place: the file's are left out", {}, CASES / "terzaghi", "-probes", "more", "-probe_more_at", "0.5 m,0.01 m")
says("a list in brackets, as in a file", {}, CASES / "terzaghi", "-output_times", "[1 h, 2 h]")
says("a function of time on the command line", {}, CASES / "terzaghi", "-bc_drain_initial", "no", "-bc_drain_pressure", "{ramp: [1 kPa, 2 kPa, 0 s, 10 days]}")
wrong = launch(binary(), CASES / "terzaghi", "-case_check", "-probe_more_at", "0.5 m,0.01 m")
check_true("one that is in no list is refused", wrong.returncode == 2 and "'more' is not listed in probes" in wrong.stdout, wrong.stdout[-200:])

# ---------------------------------------------------------------- shipped cases, and as they run
for path in sorted(CASES.glob("*/case.yaml")):  # slides by hybrid carry what they need by sdirk2
    slide = re.match("slope_(a|b|c|3d)$", path.parent.name)
    says(f"cases/{path.parent.name}", {"stabilisation_ghost_penalty": "sdirk2"} if slide else {}, path.parent)
done = launch(binary(), FOLDER / "hm.yaml", "-quiet", "-stepper_max_steps", 0, "-mat_a_gas_viscosity", "1e-5 Pa s", "-mat_a_permeability_mh", 3, out=FOLDER / "out")
check_true("a run says it too", "mat_a_gas_viscosity (no gas)" in done.stdout, done.stdout[-300:])
log = (FOLDER / "out" / "log.txt").read_text()
check_true("... and so does its log.txt", "mat_a_gas_viscosity (no gas)" in log, log[:300])
says("... and the case as it ran has none", {}, FOLDER / "out" / "case.yaml")
done = launch(binary(), FOLDER / "hm.yaml", "-quiet", "-restart", FOLDER / "out" / "checkpoint.h5", "-stepper_max_steps", 1, out=FOLDER / "out")
check_true("a restart does not mind an idle key that is gone", done.returncode == 0, done.stdout[-300:])
finish()
