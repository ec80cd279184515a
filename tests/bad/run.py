#!/usr/bin/env python3
"""Bad cases: each kind of error must end with exit code 2, a message that names the key, and no output.

usage: run.py CLATHRA   (the program; needs no arguments of its own)

Each row edits the good case cases/bp2/case.yaml: (what, [(old, new), ...], words the message must hold, options)."""
import os
import random
import subprocess
import sys
import tempfile

HERE = os.path.dirname(os.path.abspath(__file__))
BASE = open(os.path.join(HERE, "..", "..", "cases", "bp2", "case.yaml")).read()
M = "mat_sediment_"
METER = lambda keys: ("basis: cpgimp", f"basis: cpgimp\nmeters: [outlet]\nmeter: {{outlet: {{{keys}}}}}")
WELL = lambda keys: [("cells: [52, 1]", "cells: [52, 2]"), ("load, drain]\nbc:\n", "load, drain, well]\nbc:\n  well: {type: well, " + keys + "}\n")]
PLATE = lambda keys: ("base: {type: fixed, axis: x, position: 0 m", "base: {type: plate, " + keys)
STAGES = lambda a, b: ("time: {end: 2000 s}", f"stages: [a, b]\nstage:\n  a: {{{a}}}\n  b: {{{b}}}")
SEDIMENT = {"porosity": "0.15", "solid_density": "2600 kg/m^3", "solid_heat_capacity": "800 J/(kg K)", "solid_conductivity": "3 W/(m K)",
            "water_ref_pressure": "3.25 MPa", "water_ref_temperature": "4 degC", "gas_eos": "ideal", "retention_p0": "50 kPa", "retention_m": "0.3", "retention_Swr": "0.2",
            "retention_Sgr": "0.4", "relperm_nw": "4", "relperm_ng": "2", "permeability_k0": "1e-14 m^2", "permeability_mh": "3", "kinetics_active": "yes",
            "kinetics_K0": "1e-10 mol/(m^2 Pa s)", "kinetics_A_geo": "1e6 1/m", "elasticity_E0": "9 MPa", "elasticity_nu": "0.3"}
SHAPE = lambda keys: ("    lower: [0 m, 0 m]\n    upper: [1 m, 0.02 m]\n", f"    {keys}\n")
POLYGON = lambda *points: SHAPE(f"polygon: [{', '.join(f'[{x} m, {y} m]' for x, y in points)}]")
CORNERS = [(0, 0), (1, 0), (1, 0.02), (0, 0.02)]
BESIDE = lambda keys: ("regions: [column]\nregion:\n", "regions: [column, plug]\nregion:\n  plug: {" + keys
  + ", material: sediment, pressure: 3 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4}\n")
NO_GAS = [("basis: cpgimp", "basis: cpgimp\nfields: thm"), ("active: yes", "active: no"), ("    Sw: 0.6\n    Sg: 0.4\n", "")]
GRAVITY = ("title: BP2", "gravity: [0 m/s^2, -9.81 m/s^2]\ntitle: BP2")
STRESS = lambda value: ("    Sh: 0\n", f"    Sh: 0\n    stress: {value}\n")

SEA = lambda keys: ("load, drain]\nbc:\n", "load, drain, sea]\nbc:\n  sea: {side: right, " + keys + "}\n")

STRENGTH = lambda keys: [("    elasticity:", "    plasticity: {law: mohr_coulomb, " + keys + "}\n    elasticity:")]

SPACING = lambda value, cells="auto, 1": [("cells: [52, 1]", f"cells: [{cells}]\n  spacing: {{{value}}}")]

CASES = [
    # --- spacing of the grid
    ("growth below 1", SPACING("x: [0.01 m, 0.05 m, growth 0.9]"), ["grid_spacing_x", "'0.9'", "[1,2]"], []),
    ("growth above 2", SPACING("x: [0.01 m, 0.05 m, growth 2.5]"), ["grid_spacing_x", "'2.5'", "[1,2]"], []),
    ("first size above the largest", SPACING("x: [0.05 m, 0.01 m, growth 1.1]"), ["grid_spacing_x", "first size is above the largest", "0.05 m > 0.01 m"], []),
    ("size without unit", SPACING("x: [0.01, 0.05 m, growth 1.1]"), ["grid_spacing_x", "'0.01'", "0.01 m"], []),
    ("size of nothing", SPACING("x: [0 m, 0.05 m, growth 1.1]"), ["grid_spacing_x", "'0 m'", "(0,1e6]"], []),
    ("two sizes alone", SPACING("x: [0.01 m, 0.05 m]"), ["grid_spacing_x", "has 2 values", "the growth"], []),
    ("cells that do not fill the axis", SPACING("x: 0.3 m"), ["grid_spacing_x", "0.3 m do not fill 1.04 m", "nearest: 0.346666667 m, 0.26 m"], []),
    ("first size that does not fit", SPACING("x: [0.7 m, 0.9 m, growth 1.1]"), ["grid_spacing_x", "2 cells of at least 0.7 m are longer than the grid, 1.04 m"], []),
    ("too many cells", SPACING("x: [1e-6 m, 1e-6 m, growth 1.1]"), ["grid_spacing_x", "more than 100000 cells"], []),
    ("table that ends early", SPACING("x: {table: [0 m, 0.01 m, 1 m, 0.05 m]}"), ["grid_spacing_x_table", "0..1.04 m", "has 1 m there"], []),
    ("table that turns back", SPACING("x: {table: [0 m, 0.01 m, 0.7 m, 0.02 m, 0.5 m, 0.02 m, 1.04 m, 0.05 m]}"), ["grid_spacing_x_table", "must ascend", "0.5 m after 0.7 m"], []),
    ("table of one place", SPACING("x: {table: [0 m, 0.01 m]}"), ["grid_spacing_x_table", "needs pairs"], []),
    ("table that jumps", SPACING("x: {table: [0 m, 0.01 m, 0.5 m, 0.01 m, 0.51 m, 0.1 m, 1.04 m, 0.1 m]}"), ["grid_spacing_x_table", "more than 2 times as wide"], []),
    ("a spacing that is a ramp", SPACING("x: 0.02 m"), ["grid_spacing_x", "has 4 values", "the growth"], ["-grid_spacing_x", "{ramp: [0 m, 0.01 m, 1 m, 0.05 m]}"]),
    ("a table in one word that jumps", SPACING("x: 0.02 m"), ["grid_spacing_x", "more than 2 times as wide"], ["-grid_spacing_x", "{table: [0 m, 0.01 m, 0.5 m, 0.01 m, 0.51 m, 0.1 m, 1.04 m, 0.1 m]}"]),
    ("two spacings", SPACING("x: {table: [0 m, 0.01 m, 1.04 m, 0.02 m]}"), ["grid_spacing_x_table", "two ways to say the same"], ["-grid_spacing_x", "0.02 m"]),
    ("spacing against the cells", SPACING("x: 0.02 m", "50, 1"), ["grid_cells", "names 50 cells along x, but the spacing makes 52"], []),
    ("auto without a spacing", [("cells: [52, 1]", "cells: [auto, 1]")], ["grid_cells", "auto along x", "grid_spacing_x"], []),
    ("no cells and one spacing", [("  cells: [52, 1]\n", "  spacing: {x: 0.02 m}\n")], ["grid_cells"], []),
    ("softening of one size of cells", SPACING("x: [0.01 m, 0.05 m, growth 1.1]")
     + STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0.9 MPa, friction_peak: 30 deg, eta_s: 0.1, softening_length: 0.02 m"), [M + "plasticity_softening_length", "needs equal cells"], []),
    ("methane that dissolves and is all taken for gas", [("gas: {", "gas: {solubility: 1.9e-5 mol/(m^3 Pa), "), ("title: BP2", "compression_heat: yes\ntitle: BP2")],
     [M + "gas_solubility", "1.9e-05 mol/(m^3 Pa)", "compression_heat"], []),
    # --- beds
    ("more across the beds than along them", [("permeability: {", "permeability: {ratio: 2, ")], [M + "permeability_ratio", "'2'", "(0,1]"], []),
    ("dip without a unit", [("permeability: {", "permeability: {ratio: 0.5, dip: 30, ")], [M + "permeability_dip", "'30'", "30 deg"], []),
    ("beds that dip about an axis", [("permeability: {", "permeability: {ratio: 0.5, dip: 30 deg, "), ("title: BP2", "geometry: axisymmetric\ntitle: BP2")],
     [M + "permeability_dip", "must be 0 deg", "axisymmetric"], []),
    ("beds in the bare form", [("permeability: {", "permeability: {ratio: 0.5, ")], ["command line: -stepper_type", "hybrid_paper does not know permeability_ratio below 1"],
     ["-stepper_type", "hybrid_paper"]),
    ("beds in the bare form of a later stage", [("permeability: {", "permeability: {ratio: 0.5, "), STAGES("end: 10 s", "end: 2000 s, stepper: {type: hybrid_paper}")],
     ["stage_b_stepper_type", "hybrid_paper does not know permeability_ratio below 1"], []),
    # --- functions of time
    ("wave without a period", [("time: {end", "ambient: {pressure: {sine: [1 MPa, 0.1 MPa]}}\ntime: {end")], ["ambient_pressure_sine", "has 2 values", "amplitude, period and begin"], []),
    ("wave of no length", [("time: {end", "ambient: {pressure: {sine: [1 MPa, 0.1 MPa, 0 h]}}\ntime: {end")], ["ambient_pressure_sine", "'0 h'", "(0,inf) s"], []),
    ("wave out of range", [("time: {end", "ambient: {pressure: {sine: [1 MPa, 2 MPa, 12 h]}}\ntime: {end")], ["ambient_pressure_sine", "may reach -1e+06 Pa", "[0,1e10]"], []),
    ("wave in the wrong unit", [("time: {end", "ambient: {pressure: {sine: [1 MPa, 2 m, 12 h]}}\ntime: {end")], ["ambient_pressure_sine", "'2 m'", "a pressure"], []),
    ("file that is not there", [("time: {end", "ambient: {pressure: {csv: tide.csv}}\ntime: {end")], ["ambient_pressure_csv", "tide.csv", "there is no such file"], []),
    ("file that is no table", [("time: {end", f"ambient: {{pressure: {{csv: [{os.path.abspath(__file__)}, sea]}}}}\ntime: {{end")], ["ambient_pressure_csv", "no column sea"], []),
    # --- strength
    ("no such law of strength", [("    elasticity:", "    plasticity: {law: cam_clay}\n    elasticity:")], [M + "plasticity_law", "mohr_coulomb"], []),
    ("strength without cohesion", STRENGTH("friction_peak: 30 deg"), [M + "plasticity_cohesion_max", "required when law is mohr_coulomb"], []),
    ("no strength at all", STRENGTH("cohesion_max: 0 Pa, friction_peak: 0 deg"), [M + "plasticity_cohesion_max", "no strength"], []),
    ("friction of 90 deg", STRENGTH("cohesion_max: 1 MPa, friction_peak: 90 deg"), [M + "plasticity_friction_peak", "[0,90)"], []),
    ("angle without unit", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30"), [M + "plasticity_friction_peak", "30 deg"], []),
    ("angle in the wrong unit", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 %"), [M + "plasticity_friction_peak", "an angle"], []),
    ("angle for a plain number", [("porosity: 0.15", "porosity: 0.15 deg")], [M + "porosity", "takes no unit"], []),
    ("residual cohesion above the peak", STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 2 MPa, friction_peak: 30 deg"),
     [M + "plasticity_cohesion_residual", "2e+06 Pa > 1e+06 Pa"], []),
    ("residual friction above the peak", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg, friction_residual: 40 deg"),
     [M + "plasticity_friction_residual", "40 deg > 30 deg"], []),
    ("cohesion that falls with hydrate", STRENGTH("cohesion_max: 1 MPa, cohesion_min: 2 MPa, friction_peak: 30 deg"), [M + "plasticity_cohesion_min"], []),
    ("dilation that falls with hydrate", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg, dilation_min: 5 deg"), [M + "plasticity_dilation_min"], []),
    ("softening that snaps back", STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0 Pa, friction_peak: 30 deg, eta_s: 1000, Sh_max: 0.5"),
     [M + "plasticity_eta_s", "snaps back", "E = 9e+07 Pa", "c_max - c_res = 1e+06 Pa"], []),
    ("neighbours closer than two cells", STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0 Pa, friction_peak: 30 deg, eta_s: 5, nonlocal_length: 1 mm"),
     [M + "plasticity_nonlocal_length", "= 0.001 m is less than two cells", "allowed ["], []),
    ("neighbours of what does not soften", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg, eta_s: 5, nonlocal_length: 3 m"),
     [M + "plasticity_nonlocal_length", "needs strength that falls", "by 0 Pa, 0 deg, 0 deg"], []),
    ("neighbours without a rate of softening", STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0 Pa, friction_peak: 30 deg, nonlocal_length: 3 m"),
     [M + "plasticity_nonlocal_length", "eta_s is 0"], []),
    ("two cures of the mesh", STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0 Pa, friction_peak: 30 deg, eta_s: 5, nonlocal_length: 3 m, softening_length: 3 m"),
     [M + "plasticity_nonlocal_length", "softening_length", "one of them"], []),
    ("tension cut-off of the smooth flow", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg, tension_cutoff: 1 kPa"),
     [M + "plasticity_tension_cutoff", "flow: mohr_coulomb"], []),
    ("plastic heat without heat", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg, heat: 0.5") + [("basis: cpgimp", "basis: cpgimp\nfields: hmc")],
     [M + "plasticity_heat", "heat is not among"], []),
    ("shear out of the plane of a plastic material", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg") +
     [("    pressure: 3.25 MPa\n", "    pressure: 3.25 MPa\n    stress: [0 Pa, 0 Pa, 0 Pa, 0 Pa, 1 kPa, 0 Pa]\n")],
     ["region_column_stress", "out of the plane"], []),
    ("strength factor of 0", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg"), ["strength_factor", "(0,1e3]"], ["-strength_factor", "0"]),
    ("negative strength factor", STRENGTH("cohesion_max: 1 MPa, friction_peak: 30 deg"), ["strength_factor", "-1.4", "(0,1e3]"], ["-strength_factor", "-1.4"]),
    ("strength factor of what has no strength", [], ["strength_factor", "plasticity_law"], ["-strength_factor", "1.2"]),
    ("strength factor that makes a point snap back", STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0 Pa, friction_peak: 30 deg, eta_s: 20, Sh_max: 0.5"),
     [M + "plasticity_eta_s", "snaps back"], ["-strength_factor", "0.01"]),
    ("strength factor of a stage that makes a point snap back", [*STRENGTH("cohesion_max: 1 MPa, cohesion_residual: 0 Pa, friction_peak: 30 deg, eta_s: 20, Sh_max: 0.5"),
     STAGES("end: 10 s", "end: 2000 s, strength_factor: 0.01")], [M + "plasticity_eta_s", "snaps back"], []),
    ("plastic strain of an elastic scene", [], ["output_quantities", "plasticity_law"], ["-output_quantities", "eps_d_p"]),
    # --- keys
    ("typo in a top key", [("basis: cpgimp", "bassis: cpgimp")], ["bassis", "did you mean basis"], []),
    ("typo in a nested key", [("porosity: 0.15", "porosty: 0.15")], [M + "porosty", "did you mean " + M + "porosity"], []),
    ("typo in an inner map", [("retention: {", "retenton: {")], [M + "retenton_p0", M + "retention_p0"], []),
    ("typo in a schedule form", [("normal: {table:", "normal: {tabel:")], ["bc_load_normal_tabel", "bc_load_normal_table"], []),
    ("typo in a list of names", [("\nregions:", "\nregoins:")], ["regoins", "regions", "is missing"], []),
    ("unknown key, nothing near", [("basis: cpgimp", "wavelength: 3")], ["wavelength", "unknown key"], []),
    ("missing key", [("    porosity: 0.15\n", "")], [M + "porosity", "is missing"], []),
    ("missing grid", [("  cells: [52, 1]\n", "")], ["grid_cells", "is missing"], []),
    ("missing end time", [("time: {end: 2000 s}", "")], ["time_end", "is missing"], []),
    ("missing when active", [("K0: 2.5e-10 mol/(m^2 Pa s), ", "")], [M + "kinetics_K0", "required when active"], []),
    ("exponent of (320) below 0", [("law: van_genuchten, ", "law: van_genuchten, hydrate_exponent: -1, ")], [M + "retention_hydrate_exponent", "-1", "allowed: [0,20]"], []),
    ("missing van Genuchten m", [(" m: 0.3,", "")], [M + "retention_m", "is missing"], []),
    ("missing boundary value", [("    normal: {table: [0 s, 3.25 MPa, 1000 s, 13.25 MPa, 2000 s, 3.25 MPa]}\n", "")],
     ["bc_load_normal", "is missing"], []),
    ("pressure neither given nor initial", [(", initial: yes", "")], ["bc_drain_pressure", "is missing"], []),
    ("initial as a pressure", [(", initial: yes", ", pressure: initial")], ["bc_drain_pressure", "1 Pa", "the word ambient", "initial: yes in place of pressure"], []),
    ("ambient on a face without a fluid around", [(", initial: yes", ", pressure: ambient")], ["bc_drain_pressure", "neither ambient_pressure"], []),
    ("ambient in a misspelt word", [(", initial: yes", ", pressure: ambiant"), ("basis: cpgimp", "ambient: {pressure: 1 MPa}")],
     ["bc_drain_pressure", "ambiant"], []),
    ("heat of compression without heat", [("basis: cpgimp", "compression_heat: yes\nfields: [solid, water]")], ["compression_heat", "heat and a fluid"], []),
    ("heat of compression in the bare form", [("basis: cpgimp", "compression_heat: yes"), ("type: sdirk2", "type: hybrid_paper")], ["stepper_type", "hybrid_paper does not know compression_heat: yes"], []),
    ("heat of compression in the bare form of a later stage", [("basis: cpgimp", "compression_heat: yes"), STAGES("end: 10 s", "end: 2000 s, stepper: {type: hybrid_paper}")],
     ["stage_b_stepper_type", "hybrid_paper does not know compression_heat: yes"], []),
    ("drag of a fluid without density", [("basis: cpgimp", "ambient: {pressure: 1 MPa, drag: 1.2}")], ["ambient_drag", "ambient_density"], []),
    ("ambient density without gravity", [("basis: cpgimp", "ambient: {density: 1025 kg/m^3}")], ["ambient_density", "without gravity"], []),
    ("negative ambient pressure", [("basis: cpgimp", "ambient: {pressure: -1 MPa}")], ["ambient_pressure", "[0,1e10]"], []),
    ("doubled key", [("basis: cpgimp", "basis: cpgimp\nbasis: linear")], ["basis", "given twice"], []),
    ("doubled map", [("time: {end: 2000 s}", "time: {end: 2000 s}\ntime: {end: 1 s}")], ["time", "given twice"], []),
    ("no value", [("porosity: 0.15", "porosity:")], [M + "porosity", "no value"], []),
    ("a list of maps", [("probes: [p06, surface]", "probes:\n  - {name: p06}\n  - {name: surface}")], ["probes"], []),
    # --- like another
    ("like a material that is not there", [("porosity: 0.15", "porosity: 0.15\n    like: sand")], [M + "like = 'sand'", "must be one of sediment"], []),
    ("like itself", [("porosity: 0.15", "porosity: 0.15\n    like: sediment")], [M + "like", "circle: sediment like sediment"], []),
    ("likes in a circle", [("porosity: 0.15", "like: b\n    porosity: 0.15")], ["mat_a_like", "circle: a like sediment like b like a"],
     ["-materials", "a,sediment,b", "-mat_a_like", "sediment", "-mat_b_like", "a"]),
    ("like nothing", [("porosity: 0.15", "porosity: 0.15\n    like:")], [M + "like", "no value"], []),
    ("a value of another out of range, said once", [("porosity: 0.15", "porosity: 1.5")], [M + "porosity", "The case has 1 error"],
     ["-materials", "sediment,b", "-mat_b_like", "sediment"]),
    ("a shape is not another's", [], ["region_b_lower", "is missing"], ["-regions", "column,b", "-region_b_like", "column"]),
    ("a probe is like nothing", [], ["-probe_p06_like", "unknown key"], ["-probe_p06_like", "surface"]),
    # --- units
    ("no unit", [("pressure: 3.25 MPa\n", "pressure: 3.25e6\n")], ["region_column_pressure", "unit of a pressure", "3.25e6 Pa"], []),
    ("wrong unit", [("temperature: 4 degC\n", "temperature: 4 Pa\n")], ["region_column_temperature", "a temperature", "degC"], []),
    ("unknown unit", [("E0: 90 MPa", "E0: 90 MPsi")], [M + "elasticity_E0", "MPsi"], []),
    ("unit of the wrong power", [("k0: 1.53e-15 m^2", "k0: 1.53e-15 m")], [M + "permeability_k0", "m^2"], []),
    ("ambiguous division", [("conductivity: 3 W/(m K)", "conductivity: 3 W/m K")], [M + "solid_conductivity", "W/(m K)"], []),
    ("unit of a plain number", [("porosity: 0.15", "porosity: 0.15 m")], [M + "porosity", "takes no unit"], []),
    ("Celsius where kelvin is meant", [("A3: 8533.8 K", "A3: 8533.8 degC")], [M + "kinetics_A3", "in K"], []),
    ("unbalanced unit", [("800 J/(kg K)", "800 J/(kg K")], [M + "solid_heat_capacity", "')' is missing"], []),
    ("not a number", [("porosity: 0.15", "porosity: high")], [M + "porosity", "finite number"], []),
    ("nan", [("porosity: 0.15", "porosity: nan")], [M + "porosity", "finite number"], []),
    ("infinite", [("E0: 90 MPa", "E0: inf Pa")], [M + "elasticity_E0", "finite number"], []),
    ("overflow", [("E0: 90 MPa", "E0: 1e999 Pa")], [M + "elasticity_E0", "finite number"], []),
    ("hexadecimal", [("porosity: 0.15", "porosity: 0x1p-2")], [M + "porosity", "finite number"], []),
    # --- ranges and lists
    ("out of range", [("porosity: 0.15", "porosity: 1.5")], [M + "porosity", "out of range", "(0,1)"], []),
    ("negative permeability", [("k0: 1.53e-15 m^2", "k0: -1.53e-15 m^2")], [M + "permeability_k0", "out of range"], []),
    ("Poisson's ratio", [("nu: 0.3", "nu: 0.5")], [M + "elasticity_nu", "[0,0.5)"], []),
    ("colder than zero kelvin", [("temperature: 4 degC\n", "temperature: -1 K\n")], ["region_column_temperature", "out of range"], []),
    ("cells not whole", [("cells: [52, 1]", "cells: [52.5, 1]")], ["grid_cells", "whole number"], []),
    ("cells zero", [("cells: [52, 1]", "cells: [0, 1]")], ["grid_cells", "out of range"], []),
    ("particles per cell", [("particles_per_cell: [2, 2]", "particles_per_cell: [2, 11]")], ["region_column_particles_per_cell", "[1,10]"], []),
    ("list too short", [("cells: [52, 1]", "cells: [52]")], ["grid_cells", "needs 2"], []),
    ("list too long", [("at: [0.6 m, 0.01 m]", "at: [0.6 m, 0.01 m, 0 m]")], ["probe_p06_at", "needs 2"], []),
    ("bad word", [("active: yes", "active: perhaps")], [M + "kinetics_active", "yes | no"], []),
    ("bad law", [("law: van_genuchten", "law: van_genuchen")], [M + "retention_law", "did you mean van_genuchten"], []),
    ("salinity of more than brine", [("water: {density", "water: {salinity: 0.3, density")], [M + "water_salinity", "[0,0.16]"], []),
    ("bad curve of equilibrium", [("equilibrium: sloan", "equilibrium: kamat")], [M + "kinetics_equilibrium", "did you mean kamath"], []),
    ("bad viscosity of water", [("water: {density", "water: {viscosity_law: vogel, density")], [M + "water_viscosity_law", "kestin"], []),
    ("bad viscosity of gas", [("eos: ideal", "eos: ideal, viscosity_law: sutherland")], [M + "gas_viscosity_law", "lee"], []),
    ("bad heat of reaction", [("latent_heat: {", "latent_heat: {law: hess, ")], [M + "latent_heat_law", "kirchhoff"], []),
    ("bad word for ice", [("basis: cpgimp", "basis: cpgimp\nice: melt")], ["ice", "warn"], []),
    ("bad equation of state", [("eos: ideal", "eos: van_der_waals")], [M + "gas_eos", "peng_robinson | ideal"], []),
    ("gas that may condense", [("eos: ideal", "eos: peng_robinson, critical_temperature: 304.1 K")], ["region_column_temperature", "gas_critical_temperature", "304.1"], []),
    ("critical pressure without unit", [("eos: ideal", "eos: ideal, critical_pressure: 4.6")], [M + "gas_critical_pressure", "unit"], []),
    ("bad basis", [("basis: cpgimp", "basis: cubic")], ["basis", "ugimp"], []),
    ("bad stepper", [("type: sdirk2", "type: sdirk3")], ["stepper_type", "euler"], []),
    # --- names
    ("name listed twice", [("probes: [p06, surface]", "probes: [p06, p06]")], ["probes", "listed twice"], []),
    ("name with a blank", [("regions: [column]", "regions: [my column]")], ["regions", "not a name"], []),
    ("listed, not defined", [("probes: [p06, surface]", "probes: [p06, surface, deep]")], ["probe_deep_at", "is missing"], []),
    ("defined, not listed", [("probes: [p06, surface]", "probes: [p06]")], ["surface", "not listed in probes"], []),
    ("unknown material", [("material: sediment", "material: sedment")], ["region_column_material", "did you mean sediment"], []),
    ("unknown region of a boundary", [("drain: {type: pressure,", "drain: {type: pressure, region: core,")], ["bc_drain_region", "column"], []),
    ("no materials", [("materials: [sediment]\n", "")], ["materials", "is missing"], []),
    # --- agreement
    ("saturations", [("Sg: 0.4\n", "Sg: 0.3\n")], ["region_column_Sw", "must be 1"], []),
    ("residual saturations", [("Swr: 0.2, Sgr: 0.4", "Swr: 0.6, Sgr: 0.4")], [M + "retention_Swr", "below 1"], []),
    ("no gas in a law that leaves some", [("Sw: 0.6\n    Sg: 0.4\n", "Sw: 1\n    Sg: 0\n"), ("law: van_genuchten,", "law: van_genuchten_clamped,")],
     ["region_column_Sg", "retention law"], []),
    ("gas let into sediment without any, by hybrid", [("Sw: 0.6\n    Sg: 0.4\n", "Sw: 1\n    Sg: 0\n"), ("type: sdirk2", "type: hybrid"),
      ("type: pressure, side: right, initial: yes}", "type: inflow, side: right, gas: 1e-6 m/s}")],
     ["stepper_type", "hybrid does not know an inflow of gas where a region has Sg: 0"], []),
    ("retention out of reach", [("Sw: 0.6\n    Sg: 0.4\n", "Sw: 0.1\n    Sg: 0.9\n")], ["region_column_Sg", "retention law"], []),
    ("grid upside down", [("upper: [1.04 m, 0.02 m]", "upper: [1.04 m, -0.02 m]")], ["grid_upper", "above"], []),
    ("region upside down", [("upper: [1 m, 0.02 m]", "upper: [-1 m, 0.02 m]")], ["region_column_upper", "above"], []),
    ("region leaves the grid", [("upper: [1 m, 0.02 m]", "upper: [1.1 m, 0.02 m]")], ["region_column_upper", "leaves the grid"], []),
    ("molar masses", [("molar_mass: 0.124 kg/mol", "molar_mass: 0.120 kg/mol")], [M + "hydrate_molar_mass", "0.124"], []),
    ("hydrostatic without gravity", [("    Sh: 0\n", "    Sh: 0\n    hydrostatic: yes\n")], ["region_column_hydrostatic", "gravity"], []),
    ("negative hydrostatic pressure", [("    Sh: 0\n", "    Sh: 0\n    hydrostatic: yes\n    datum: -1 km\n"),
      ("basis: cpgimp", "gravity: [0 m/s^2, -9.81 m/s^2]")], ["region_column_datum", "positive"], []),
    ("K0 negative", [GRAVITY, STRESS("{geostatic: -0.5}")], ["region_column_stress_geostatic", "out of range", "(0,10]"], []),
    ("geostatic and a list", [GRAVITY, STRESS("[-1 kPa, 0 Pa, 0 Pa, 0 Pa, 0 Pa, 0 Pa]\n    stress_geostatic: 0.5")],
     ["region_column_stress_geostatic", "choose one"], []),
    ("geostatic and normally consolidated", [GRAVITY, STRESS("{geostatic: 0.5, normally_consolidated: yes}")],
     ["region_column_stress_normally_consolidated", "choose one"], []),
    ("geostatic without gravity", [STRESS("{geostatic: 0.5}")], ["region_column_stress_geostatic", "gravity is zero"], []),
    ("geostatic with a ramp of gravity", [("basis: cpgimp", "gravity: [0 m/s^2, -9.81 m/s^2]\ngravity_ramp: 1 s"), STRESS("{geostatic: 0.5}")],
     ["region_column_stress_geostatic", "gravity_ramp"], []),
    ("geostatic stress of a rigid body", [GRAVITY, ("E0: 90 MPa", "E0: rigid"), STRESS("{geostatic: 0.5}")],
     ["region_column_stress_geostatic", "needs solid"], []),
    ("normally consolidated without a friction angle", [GRAVITY, STRESS("{normally_consolidated: yes}")],
     ["region_column_stress_normally_consolidated", "friction angle", "sediment"], []),
    ("geothermal without gravity", [("    Sh: 0\n", "    Sh: 0\n    geothermal: 30 K/km\n")], ["region_column_geothermal", "gravity"], []),
    ("geothermal below absolute zero", [("basis: cpgimp", "gravity: [9.81 m/s^2, 0 m/s^2]"), ("    Sh: 0\n", "    Sh: 0\n    geothermal: -1e3 K/m\n")],
     ["region_column_geothermal", "degC at its top or foot"], []),
    ("geothermal without heat", [GRAVITY, ("    Sh: 0\n", "    Sh: 0\n    geothermal: 30 K/km\n"), *NO_GAS, ("fields: thm", "fields: hm")],
     ["region_column_geothermal", "needs heat"], []),
    ("geothermal without unit", [GRAVITY, ("    Sh: 0\n", "    Sh: 0\n    geothermal: 30\n")], ["region_column_geothermal", "K/m"], []),
    ("a temperature with depth, without gravity", [SEA("type: face_temperature, temperature: 4 degC, with_depth: 20 K/km")], ["bc_sea_with_depth", "gravity"], []),
    ("... below absolute zero", [("title: BP2", "gravity: [9.81 m/s^2, 0 m/s^2]\ntitle: BP2"), SEA("type: face_temperature, temperature: 4 degC, with_depth: -1e3 K/m")],
     ["bc_sea_with_depth", "degC at the top or foot"], []),
    ("... in a stage without gravity", [GRAVITY, SEA("type: face_temperature, temperature: 4 degC, with_depth: 20 K/km"), STAGES("end: 1000 s", "end: 2000 s, gravity: [0 m/s^2, 0 m/s^2]")],
     ["bc_sea_with_depth", "is zero"], []),
    ("... without unit", [GRAVITY, SEA("type: convection, alpha: 1 W/(m^2 K), ambient: 4 degC, with_depth: 20")], ["bc_sea_with_depth", "K/m"], []),
    ("... of what flows in", [GRAVITY, SEA("type: inflow, temperature: 4 degC, water: 1e-9 m/s, with_depth: 20 K/km")], ["bc_sea_with_depth", "inflow"], []),
    ("a point and a mean in one", [("at: [0.6 m, 0.01 m]", "at: [0.6 m, 0.01 m], over: column")], ["probe_p06_at", "one of three"], []),
    ("a region and a surface in one", [("at: [0.6 m, 0.01 m]", "over: column, side: right")], ["probe_p06_over", "one of three"], []),
    ("a mean over nothing that is known", [("at: [0.6 m, 0.01 m]", "over: colum")], ["probe_p06_over", "column"], []),
    ("a mean over a shape outside", [("at: [0.6 m, 0.01 m]", "over: spot"), ("regions: [column]\nregion:\n",
      "regions: [column, spot]\nregion:\n  spot: {circle: [0.6 m, 0.01 m, 1 mm], material: none}\n")], ["probe_p06_over", "holds no particle"], []),
    ("from without a side", [("at: [0.6 m, 0.01 m]", "over: column, from: 1 m")], ["probe_p06_from", "goes with side"], []),
    ("part of a point", [("at: [0.6 m, 0.01 m]", "at: [0.6 m, 0.01 m], region: column")], ["probe_p06_region", "goes with side"], []),
    ("a surface that stays", [("at: [0.6 m, 0.01 m]", "side: right, fixed: yes")], ["probe_p06_fixed", "moves with the body"], []),
    ("a mean over no face", [("at: [0.6 m, 0.01 m]", "side: right, from: 1 m")], ["probe_p06_from", "no part of the body"], []),
    ("probe outside", [("at: [0.6 m, 0.01 m]", "at: [1.02 m, 0.01 m]")], ["probe_p06_at", "no region"], []),
    ("cfl above 1", [("type: sdirk2", "type: hybrid, cfl: 1.5")], ["stepper_cfl", "(0,1]"], []),
    ("damping of 1", [("type: sdirk2", "type: hybrid, damping: 1")], ["stepper_damping", "[0,1)"], []),
    ("mass scaling below 1", [("type: sdirk2", "type: explicit, mass_scaling: 0.5")], ["stepper_mass_scaling", "[1,1e12]"], []),
    *(("gas carried from upstream by " + by, [("basis: cpgimp", "basis: cpgimp\nstabilisation: {donor: yes}")], ["stepper_type", by + " does not know stabilisation_donor"], ["-stepper_type", by])
      for by in ("hybrid", "explicit", "hybrid_paper")),
    ("cells that deform with the body by explicit", [("basis: cpgimp", "basis: total")], ["command line: -stepper_type", "explicit does not know basis: total"], ["-stepper_type", "explicit"]),
    ("hybrid about an axis", [("basis: cpgimp", "basis: cpgimp\ngeometry: axisymmetric"), ("type: sdirk2", "type: hybrid")], ["hybrid does not know geometry: axisymmetric"], []),
    ("steps out of order", [("dt: 1 s,", "dt: 100 s,")], ["stepper_dt", "stepper_dt_max"], []),
    ("output after the end", [("1500 s, 2000 s]", "1500 s, 2001 s]")], ["output_times", "time_end"], []),
    ("output times not ascending", [("1500 s, 2000 s]", "2000 s, 1500 s]")], ["output_times", "ascend"], []),
    # --- boundaries and schedules
    ("unknown boundary type", [("type: traction", "type: tracton")], ["bc_load_type", "did you mean traction"], []),
    ("unknown side", [("type: pressure, side: right", "type: pressure, side: east")], ["bc_drain_side", "left | right"], []),
    ("key of another type", [("base: {type: fixed, axis: x,", "base: {type: fixed, axis: x, normal: 1 MPa,")],
     ["bc_base_normal", "type fixed"], []),
    ("plate: velocity and displacement", [PLATE("side: left, velocity: 1 um/s, displacement: 1 mm")], ["bc_base_displacement", "velocity", "one of"], []),
    ("plate: displacement and force", [PLATE("side: left, force: 1 N, displacement: 1 mm")], ["bc_base_force", "displacement", "one of"], []),
    ("plate: nothing prescribed", [PLATE("side: left")], ["bc_base_velocity", "is missing", "neither displacement nor force"], []),
    ("plate: rough and separates", [PLATE("side: left, velocity: 1 um/s, rough: yes, separates: yes")], ["bc_base_separates", "rough"], []),
    ("plate: pulls what separates", [PLATE("side: left, force: {table: [0 s, 1 N, 1 s, -1 N]}, separates: yes")], ["bc_base_force", "-1 N", "pull"], []),
    ("plate: side and axis", [PLATE("side: left, axis: x, velocity: 1 um/s")], ["bc_base_axis", "type plate"], []),
    ("plate: soft", [PLATE("side: left, stiffness: 0.1, velocity: 1 um/s")], ["bc_base_stiffness", "[1,1e6]"], []),
    ("plate: force in another unit", [PLATE("side: left, force: 1 kPa")], ["bc_base_force", "N"], []),
    ("plate: closed, on a drained side", [PLATE("side: right, velocity: 1 um/s")], ["bc_base_holds", "drain", "holds: skeleton"], []),
    ("plate: closed, drained along a line on its side", [PLATE("side: right, velocity: 1 um/s"), ("side: right, initial: yes", "along: [[1 m, 0 m], [1 m, 0.02 m]], initial: yes")],
     ["bc_base_holds", "drain", "holds: skeleton"], []),
    ("plate: on a grid line, far", [PLATE("axis: x, position: 0 m, velocity: {table: [0 s, 1 um/s, 1000 s, -1 um/s]}")],
     ["bc_base_velocity", "0.001 m", "side: left"], []),
    ("plate: in a scene without solid", [PLATE("side: left, velocity: 1 um/s"), ("basis: cpgimp", "fields: thc")], ["bc_base_type", "needs solid"], []),
    ("plate: on a side closed in by another region", [PLATE("side: right, region: column, velocity: 1 um/s, holds: skeleton"),
      ("upper: [1 m, 0.02 m]", "upper: [0.5 m, 0.02 m]"), BESIDE("lower: [0.5 m, 0 m], upper: [1 m, 0.02 m]")], ["bc_base_side", "no free surface"], []),
    ("plate: from a line", [PLATE("along: [[0 m, 0 m], [0 m, 0.02 m]], velocity: 1 um/s")], ["bc_base_along", "type plate"], []),
    ("plate: moves from the second stage on", [PLATE("side: left, velocity: 1 um/s"), STAGES("end: 1 s, boundaries_off: [base]", "end: 2 s")],
     ["bc_base_velocity", "first stage"], []),
    ("plate: moves by the clock of a stage", [PLATE("side: left, displacement: 1 um, clock: stage"), STAGES("end: 1 s", "end: 2 s")], ["bc_base_clock", "start of the run"], []),
    ("plane off the grid lines", [("base: {type: fixed, axis: x, position: 0 m}", "base: {type: fixed, axis: x, position: 0.01 m}")],
     ["bc_base_position", "grid line"], []),
    ("plane outside", [("upper_wall: {type: roller, axis: y, position: 0.02 m}", "upper_wall: {type: roller, axis: y, position: 0.04 m}")],
     ["bc_upper_wall_position", "outside"], []),
    ("part of a side upside down", [("initial: yes}", "initial: yes, from: 0.02 m, to: 0 m}")], ["bc_drain_to", "above from"], []),
    ("part of a side off the body", [("initial: yes}", "initial: yes, from: 1 m}")], ["bc_drain_from", "no part"], []),
    ("schedule times", [("1000 s, 13.25 MPa, 2000 s, 3.25 MPa", "2000 s, 13.25 MPa, 1000 s, 3.25 MPa")], ["bc_load_normal_table", "ascend"], []),
    ("schedule without pairs", [("2000 s, 3.25 MPa]}", "2000 s]}")], ["bc_load_normal_table", "pairs"], []),
    ("schedule with units swapped", [("[0 s, 3.25 MPa, 1000 s", "[3.25 MPa, 0 s, 1000 s")], ["bc_load_normal_table", "a time"], []),
    ("two forms", [("normal: {table:", "normal: {ramp: [0 Pa, 1 Pa, 0 s, 1 s], table:")], ["bc_load_normal", "two forms"], []),
    ("more behind a form", [], ["bc_load_normal", "no function of time"], ["-bc_load_normal", "{ramp: [0 Pa, 1 MPa, 0 s, 1 s]} x"]),
    ("a form without its end", [], ["bc_load_normal", "no function of time"], ["-bc_load_normal", "{ramp: [0 Pa, 1 MPa, 0 s, 1 s]"]),
    ("pairs that lack a value", [], ["bc_load_normal", "needs pairs"], ["-bc_load_normal", "{table: [[0 s, 1 MPa], [1 s]]}"]),
    ("ramp backwards", [("{table: [0 s, 3.25 MPa, 1000 s, 13.25 MPa, 2000 s, 3.25 MPa]}", "{ramp: [0 Pa, 1 MPa, 10 s, 0 s]}")],
     ["bc_load_normal_ramp", "end after"], []),
    ("rate unit", [("{table: [0 s, 3.25 MPa, 1000 s, 13.25 MPa, 2000 s, 3.25 MPa]}", "{rate: [0 Pa, 1 MPa, 0 s, 10 s]}")],
     ["bc_load_normal_rate", "Pa/s"], []),
    # --- shapes
    ("no shape", [SHAPE("")], ["region_column_lower", "is missing", "polygon, below and circle are not given"], []),
    ("two shapes", [SHAPE("polygon: [[0 m, 0 m], [1 m, 0 m], [1 m, 0.02 m]]\n    circle: [0.5 m, 0.01 m, 0.01 m]")],
     ["region_column_circle", "one shape too many"], []),
    ("polygon of two points", [POLYGON((0, 0), (1, 0.02))], ["case.yaml:32: region_column_polygon", "at least 3"], []),
    ("polygon that crosses itself", [POLYGON((0, 0), (1, 0), (0, 0.02), (1, 0.02))], ["region_column_polygon", "crosses itself",
     "(1 m, 0 m) and (1 m, 0.02 m)"], []),
    ("polygon that repeats its first point", [POLYGON(*CORNERS, (0, 0))], ["region_column_polygon", "crosses itself"], []),
    ("polygon outside the grid", [POLYGON((0, 0), (1, 0), (1, 0.03))], ["region_column_polygon", "leaves the grid along y"], []),
    ("polygon outside its bounds", [POLYGON(*CORNERS), ("    particles_per_cell", "    lower: [1 m, none]\n    particles_per_cell")],
     ["region_column_polygon", "nothing of it lies between lower and upper along x"], []),
    ("polygon as a flat list", [SHAPE("polygon: [0 m, 0 m, 1 m, 0 m, 1 m, 0.02 m]")], ["region_column_polygon", "'0 m'", "not a point"], []),
    ("point of three numbers", [SHAPE("polygon: [[0 m, 0 m], [1 m, 0 m, 0 m], [1 m, 0.02 m]]")], ["region_column_polygon", "not a point"], []),
    ("point of one number", [SHAPE("polygon: [[0 m, 0 m], [1 m], [1 m, 0.02 m]]")], ["region_column_polygon", "not a point"], []),
    ("point without unit", [SHAPE("polygon: [[0 m, 0 m], [1 m, 0], [1 m, 0.02 m]]")], ["region_column_polygon", "unit of a length"], []),
    ("comma in a value of a list", [SHAPE("polygon: [['0 m, 1 m', 0 m], [1 m, 0 m], [1 m, 0.02 m]]")], ["case.yaml:32", "comma"], []),
    ("list of points one deeper", [SHAPE("polygon: [[[0 m, 0 m], [1 m, 0 m], [1 m, 0.02 m]]]")], ["region_column_polygon", "nested too deeply"], []),
    ("list of points, brackets", [], ["-region_column_polygon", "brackets"], ["-region_column_polygon", "[[0 m, 0 m], [1 m, 0 m]"]),
    ("box as a list of lists", [SHAPE("lower: [[0 m, 0 m]]\n    upper: [1 m, 0.02 m]")], ["region_column_lower", "needs 2"], []),
    ("circle on the command line", [], ["region_column_circle", "positive radius"], ["-region_column_circle", "0.5 m,0.01 m,0 m"]),
    ("line of one point", [SHAPE("below: [[0 m, 0.01 m]]")], ["region_column_below", "at least 2"], []),
    ("line that does not ascend", [SHAPE("below: [[0 m, 0.01 m], [0.5 m, 0.01 m], [0.5 m, 0.02 m]]")], ["region_column_below",
     "ascend in x (0.5 m after 0.5 m)"], []),
    ("line above the grid", [SHAPE("below: [[0 m, 0.01 m], [0.5 m, 0.03 m]]")], ["region_column_below", "leaves the grid along y"], []),
    ("line below the grid", [SHAPE("below: [[0 m, -0.01 m], [0.5 m, -0.02 m]]")], ["region_column_below", "nothing of it"], []),
    ("circle of radius zero", [SHAPE("circle: [0.5 m, 0.01 m, 0 m]")], ["region_column_circle", "positive radius"], []),
    ("circle without centre", [SHAPE("circle: [none, none, 0.01 m]")], ["region_column_circle", "needs a centre"], []),
    ("circle outside the grid", [SHAPE("circle: [0.5 m, 0.01 m, 0.02 m]")], ["region_column_circle", "leaves the grid along y"], []),
    ("no particle", [SHAPE("circle: [0.5 m, 0.01 m, 1 mm]")], ["region_column_circle", "keeps no particle"], []),
    ("nothing left", [BESIDE("lower: [0 m, 0 m], upper: [0.5 m, 0.01 m], minus: [column]")], ["region_plug_minus", "keeps no particle"], []),
    ("a region under a later one", [BESIDE("lower: [0 m, 0 m], upper: [1.04 m, 0.02 m]")], ["region_column_minus", "keeps no particle"], []),
    ("minus itself", [SHAPE("lower: [0 m, 0 m]\n    upper: [1 m, 0.02 m]\n    minus: [column]")], ["region_column_minus", "out of itself"], []),
    ("minus an unknown region", [SHAPE("lower: [0 m, 0 m]\n    upper: [1 m, 0.02 m]\n    minus: [hole]")], ["region_column_minus", "hole", "column"], []),
    ("a hole in nothing", [("regions: [column]\nregion:\n", "regions: [column, hole]\nregion:\n  hole: {circle: [0.5 m, 0.01 m, 0.01 m], material: none}\n")],
     ["region_hole_material", "no region has hole in its minus"], []),
    ("a hole with a state", [("material: sediment", "material: none")], ["region_column_pressure", "without particles"], []),
    ("a material called none", [("materials: [sediment]", "materials: [none]")], ["materials", "not a name"], []),
    ("probe in a hole", [("regions: [column]\nregion:\n", "regions: [column, hole]\nregion:\n  hole: {circle: [0.6 m, 0.01 m, 0.01 m], material: none}\n"),
      ("    particles_per_cell", "    minus: [hole]\n    particles_per_cell")], ["probe_p06_at", "no region"], []),
    ("a line and a side", [("side: right, initial: yes}", "side: right, along: [[1 m, 0 m], [1 m, 0.02 m]], initial: yes}")],
     ["bc_drain_side", "give one"], []),
    ("neither line nor side", [("side: right, initial: yes}", "initial: yes}")], ["bc_drain_side", "required when along is not given"], []),
    ("side none", [("side: right, initial: yes}", "side: none, initial: yes}")], ["bc_drain_side", "along is not given"], []),
    ("a line and from", [("side: right, initial: yes}", "along: [[1 m, 0 m], [1 m, 0.02 m]], from: 0 m, initial: yes}")],
     ["bc_drain_from", "goes with side"], []),
    ("line beside the body", [("side: right, initial: yes}", "along: [[1.02 m, 0 m], [1.02 m, 0.02 m]], initial: yes}")],
     ["bc_drain_along", "no face"], []),
    ("line across the surface", [("side: right, initial: yes}", "along: [[0.3 m, 0 m], [0.7 m, 0 m]], region: plug, initial: yes}"),
      BESIDE("lower: [1 m, 0 m], upper: [1.02 m, 0.02 m]")], ["bc_drain_along", "no face"], []),
    ("line of one point for faces", [("side: right, initial: yes}", "along: [[1 m, 0 m]], initial: yes}")], ["bc_drain_along", "at least 2"], []),
    ("meter on a line beside the body", [METER("along: [[0.3 m, 0.01 m], [0.4 m, 0.01 m]]")], ["meter_outlet_along", "no face"], []),
    ("side of a polygon that is covered", [POLYGON((0, 0), (0.5, 0), (0.5, 0.02), (0, 0.02)), BESIDE("lower: [0.5 m, 0 m], upper: [1 m, 0.02 m]"),
      ("side: right, initial: yes}", "side: right, region: column, initial: yes}")], ["bc_drain_from", "no part"], []),
    ("line on a grid plane's condition", [("base: {type: fixed,", "base: {type: fixed, along: [[0 m, 0 m], [0 m, 0.02 m]],")],
     ["bc_base_along", "type fixed"], []),
    # --- fields and geometry
    ("unknown set of fields", [("basis: cpgimp", "fields: thx")], ["fields", "thx", "must be auto"], []),
    ("unknown field", [("basis: cpgimp", "fields: [solid, watr]")], ["fields", "watr", "must be auto"], []),
    ("gas without water", [("basis: cpgimp", "fields: [solid, gas]")], ["fields", "gas without water"], []),
    ("heat flux without heat", [("basis: cpgimp", "fields: [solid, water]"), ("Sg: 0.4\n", "Sg: 0\n"), ("Sw: 0.6\n", "Sw: 1\n"),
     ("active: yes", "active: no"), ("drain: {type: pressure, side: right, initial: yes}", "drain: {type: heat_flux, side: right, flux: 1 W/m^2}")],
     ["bc_drain_type", "needs heat", "(solid,water)"], []),
    ("pressure without water", [("basis: cpgimp", "fields: [solid, heat]"), ("active: yes", "active: no")], ["bc_drain_type", "needs water"], []),
    ("traction on a rigid body", [("E0: 90 MPa", "E0: rigid")], ["bc_load_type", "needs solid", "(water,gas,heat)"], []),
    ("rigid material of a moving body", [("E0: 90 MPa", "E0: rigid"), ("basis: cpgimp", "fields: thmc")],
     [M + "elasticity_E0", "solid is among the fields"], []),
    ("kinetics without gas", [("basis: cpgimp", "fields: thm"), ("Sg: 0.4\n", "Sg: 0\n"), ("Sw: 0.6\n", "Sw: 1\n")],
     [M + "kinetics_active", "needs water and gas"], []),
    ("gas in a scene without it", [("basis: cpgimp", "fields: hm"), ("active: yes", "active: no")], ["region_column_Sg", "is 0.4 but gas is not"], []),
    ("roller in a scene of heat", [("basis: cpgimp", "fields: t")], ["bc_lower_wall_type", "needs solid or water"], []),
    ("grid left of the axis", [("basis: cpgimp", "geometry: axisymmetric"), ("lower: [0 m, 0 m]\n  upper: [1.04 m, 0.02 m]", "lower: [-0.02 m, 0 m]\n  upper: [1.02 m, 0.02 m]")],
     ["grid_lower", "left of the axis"], []),
    ("gravity across the axis", [("basis: cpgimp", "geometry: axisymmetric\ngravity: [1 m/s^2, 0 m/s^2]")], ["gravity", "along the axis"], []),
    ("bad geometry", [("basis: cpgimp", "geometry: spherical")], ["geometry", "plane | axisymmetric"], []),
    ("p_w without p_g", [("initial: yes}", "p_w: 3 MPa}")], ["bc_drain_p_g", "p_w is given"], []),
    ("p_w beside the mean", [("initial: yes}", "p_w: 3 MPa, p_g: 3 MPa, pressure: 3 MPa}")], ["bc_drain_p_w", "pressure"], []),
    ("p_w beside initial", [("initial: yes}", "p_w: 3 MPa, p_g: 3 MPa, initial: yes}")], ["bc_drain_p_w", "initial"], []),
    ("free saturation with p_w and p_g", [("initial: yes}", "p_w: 3 MPa, p_g: 3 MPa, saturation: free}")],
     ["bc_drain_saturation", "p_w and p_g"], []),
    ("bad saturation", [("initial: yes}", "pressure: 3 MPa, saturation: fixed}")], ["bc_drain_saturation", "held | free"], []),
    ("bad phases", [("initial: yes}", "pressure: 3 MPa, phases: oil}")], ["bc_drain_phases", "both | water | gas"], []),
    ("p_g without a gas field", [("initial: yes}", "p_w: 3 MPa, p_g: 3 MPa}"), *NO_GAS], ["bc_drain_p_g", "needs gas"], []),
    ("open for a gas that is not there", [("initial: yes}", "pressure: 3 MPa, phases: gas}"), *NO_GAS], ["bc_drain_phases", "needs gas"], []),
    ("inflow of gas without a gas field", [("type: pressure, side: right, initial: yes}", "type: inflow, side: right, gas: 1e-6 m/s}"), *NO_GAS],
     ["bc_drain_gas", "needs gas"], []),
    ("inflow with a temperature, without heat", [("type: pressure, side: right, initial: yes}", "type: inflow, side: right, temperature: 3 degC}"),
      ("basis: cpgimp", "basis: cpgimp\nfields: hm"), *NO_GAS[1:]], ["bc_drain_temperature", "needs heat"], []),
    ("inflow without unit", [("type: pressure, side: right, initial: yes}", "type: inflow, side: right, water: 1e-6}")],
     ["bc_drain_water", "m/s"], []),
    ("inflow with a pressure", [("type: pressure, side: right, initial: yes}", "type: inflow, side: right, pressure: 3 MPa}")],
     ["bc_drain_pressure", "type inflow"], []),
    # --- meters
    # --- a well in the plane; the column is two cells high, so one on the middle line has a cell of body around it
    ("well outside the body", WELL("at: [1.02 m, 0.01 m], radius: 1 mm, bottom_pressure: 2 MPa"), ["bc_well_at", "outside the body", "(1.02, 0.01) m"], []),
    ("well beside the surface", WELL("at: [0.5 m, 0.015 m], radius: 1 mm, bottom_pressure: 2 MPa"), ["bc_well_at", "within a cell", "ends nearer"], []),
    ("well that nothing drives", WELL("at: [0.5 m, 0.01 m]"), ["bc_well_bottom_pressure", "is missing", "water_flow"], []),
    ("well that two things drive", WELL("at: [0.5 m, 0.01 m], radius: 1 mm, bottom_pressure: 2 MPa, water_flow: 1 kg/s"), ["bc_well_water_flow", "two ways to drive a well"], []),
    ("well without a radius", WELL("at: [0.5 m, 0.01 m], bottom_pressure: 2 MPa"), ["bc_well_radius", "is missing", "bottom_pressure is given"], []),
    ("well without a place", WELL("radius: 1 mm, bottom_pressure: 2 MPa"), ["bc_well_at", "is missing"], []),
    ("well wider than its cells", WELL("at: [0.5 m, 0.01 m], radius: 6 mm, bottom_pressure: 2 MPa"), ["bc_well_radius", "0.006 m", "half a cell (0.01 m)"], []),
    ("well that draws too well", WELL("at: [0.5 m, 0.01 m], radius: 5 mm, skin: -5, bottom_pressure: 2 MPa"), ["bc_well_skin", "-5", "yield"], []),
    ("well of gas where there is none", NO_GAS + WELL("at: [0.5 m, 0.01 m], gas_flow: -1 kg/s"), ["bc_well_gas_flow", "needs gas", "solid,water,heat"], []),
    ("well on a side", WELL("at: [0.5 m, 0.01 m], radius: 1 mm, bottom_pressure: 2 MPa, side: left"), ["bc_well_side", "is not a key of a boundary of type well"], []),
    ("well about an axis", WELL("at: [0.5 m, 0.01 m], radius: 1 mm, bottom_pressure: 2 MPa"), ["bc_well_type", "about an axis", "side: left"], ["-geometry", "axisymmetric"]),
    ("well in the paper's bare form", WELL("at: [0.5 m, 0.01 m], radius: 1 mm, bottom_pressure: 2 MPa"), ["bc_well_type", "hybrid_paper does not know the condition well"],
     ["-stepper_type", "hybrid_paper", "-inertia", "yes"]),
    ("meter of a well that is a plane", [METER("well: base")], ["meter_outlet_well", "base", "is not a well but a fixed"], []),
    ("meter of a well and a side", WELL("at: [0.5 m, 0.01 m], radius: 1 mm, bottom_pressure: 2 MPa") + [METER("well: well, side: left")], ["meter_outlet_well", "side", "give one"], []),
    ("meter without a side", [METER("from: 0 m")], ["meter_outlet_side", "is missing"], []),
    ("meter on no side", [METER("side: east")], ["meter_outlet_side", "left | right"], []),
    ("meter of an unknown region", [METER("side: right, region: core")], ["meter_outlet_region", "column"], []),
    ("meter off the body", [METER("side: right, from: 1 m")], ["meter_outlet_from", "no part"], []),
    ("meter upside down", [METER("side: right, from: 0.02 m, to: 0 m")], ["meter_outlet_to", "above from"], []),
    ("meter not listed", [("basis: cpgimp", "basis: cpgimp\nmeter: {outlet: {side: right}}")], ["outlet", "not listed in meters"], []),
    ("too many meters", [("basis: cpgimp", "basis: cpgimp\nmeters: [" + ", ".join(f"m{k}" for k in range(17)) + "]\nmeter: {"
      + ", ".join(f"m{k}: {{side: right}}" for k in range(17)) + "}")], ["meters", "at most 16"], []),
    ("standard density", [("basis: cpgimp", "basis: cpgimp\nstandard: {gas_density: 0 kg/m^3}")], ["standard_gas_density", "out of range"], []),
    ("unknown quantity", [("  probe_every:", "  quantities: [p, viscosity]\n  probe_every:")], ["output_quantities", "viscosity", "S_h"], []),
    ("quantity of a field that is not there", [("  probe_every:", "  quantities: [p, T]\n  probe_every:"), ("basis: cpgimp", "basis: cpgimp\nfields: hm"),
      *NO_GAS[1:]], ["output_quantities", "'T'", "needs heat, which is not among the fields of the scene"], []),
    ("gas saturation without gas", [("  probe_every:", "  quantities: [S_g]\n  probe_every:"), *NO_GAS], ["output_quantities", "needs gas"], []),
    ("region held between the nodes", [("type: pressure, side: right, initial: yes}", "type: region_temperature, region: plug, temperature: 3 degC}"),
      ("regions: [column]\nregion:\n", "regions: [column, plug]\nregion:\n  plug: {lower: [1.022 m, 0 m], upper: [1.038 m, 0.02 m],"
       " material: sediment, pressure: 3 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4}\n")], ["bc_drain_region", "no node"], []),
    ("region temperature without heat", [("type: pressure, side: right, initial: yes}", "type: region_temperature, temperature: 3 degC}"),
      ("basis: cpgimp", "basis: cpgimp\nfields: hm"), *NO_GAS[1:]], ["bc_drain_type", "needs heat"], []),
    ("region temperature on a side", [("type: pressure, side: right, initial: yes}", "type: region_temperature, side: right, temperature: 3 degC}")],
     ["bc_drain_side", "type region_temperature"], []),
    # --- stages
    ("stage without an end", [STAGES("end: 10 s", "inertia: no")], ["stage_b_end", "is missing"], []),
    ("stage that ends before time begins", [STAGES("end: 0 s", "end: 2000 s")], ["stage_a_end", "out of range"], []),
    ("empty stage", [STAGES("end: 2000 s", "end: 2000 s")], ["case.yaml:", "stage_b_end", "the stage is empty"], []),
    ("stages out of order", [STAGES("end: 2000 s", "end: 10 s")], ["stage_b_end", "order of their ends"], []),
    ("time_end beside stages", [STAGES("end: 10 s", "end: 2000 s"), ("basis: cpgimp", "basis: cpgimp\ntime: {end: 1 h}")],
     ["time_end", "the last stage, b, ends at 2000 s"], []),
    ("output after the last stage", [STAGES("end: 10 s", "end: 1900 s")], ["output_times", "2000 s after time_end, 1900 s"], []),
    ("stage of an unknown boundary", [STAGES("end: 10 s, boundaries: [bas, load]", "end: 2000 s")],
     ["stage_a_boundaries", "'bas': must be one of base | "], []),
    ("stage without an unknown boundary", [STAGES("end: 10 s, boundaries_off: [wind]", "end: 2000 s")], ["stage_a_boundaries_off", "'wind': must be one of base | "], []),
    ("stage with boundaries on and off", [STAGES("end: 10 s, boundaries: [base], boundaries_off: [load]", "end: 2000 s")],
     ["stage_a_boundaries_off", "choose one"], []),
    ("boundary listed twice in a stage", [STAGES("end: 10 s, boundaries_off: [load, load]", "end: 2000 s")], ["stage_a_boundaries_off", "listed twice"], []),
    ("stage of an unknown material", [STAGES("end: 10 s", "end: 2000 s, materials: [column, sedment]")],
     ["stage_b_materials", "'sedment': must be one of sediment; did you mean sediment?"], []),
    ("stage of an unknown region", [STAGES("end: 10 s", "end: 2000 s, materials: [colum, sediment]")], ["stage_b_materials", "'colum': must be one of column"], []),
    ("material of a stage for a hole", [STAGES("end: 10 s", "end: 2000 s, materials: [hole, sediment]"),
     ("regions: [column]\nregion:\n", "regions: [column, hole]\nregion:\n  hole: {circle: [0.5 m, 0.01 m, 0.01 m], material: none}\n")],
     ["stage_b_materials", "region hole has no particles"], []),
    ("materials of a stage without pairs", [STAGES("end: 10 s", "end: 2000 s, materials: [column]")], ["stage_b_materials", "pairs"], []),
    *((f"stage that would change {what}", [STAGES("end: 10 s", "end: 2000 s, materials: [column, other]"), ("materials: [sediment]", "materials: [sediment, other]")],
       ["stage_b_materials", "region column cannot change from sediment to other", word],
       [x for key, value in {**SEDIMENT, **changed}.items() for x in (f"-mat_other_{key}", value)])
      for what, word, changed in (("porosity", "porosity", {"porosity": "0.2"}), ("the grains", "solid_density", {"solid_density": "2500 kg/m^3"}),
                                  ("retention", "retention", {"retention_p0": "60 kPa"}), ("what reacts", "kinetics_active", {"kinetics_active": "no"}))),
    ("condition that hybrid does not know", [PLATE("axis: x, position: 0 m, velocity: 0 m/s"), ("type: sdirk2", "type: hybrid")],
     ["bc_base_type", "hybrid does not know the condition plate without a side; use sdirk2 or euler"], []),
    ("the same in a later stage", [PLATE("axis: x, position: 0 m, velocity: 0 m/s"), STAGES("end: 10 s", "end: 2000 s, stepper: {type: hybrid}")],
     ["bc_base_type", "in stage b: hybrid does not know the condition plate without a side"], []),
    ("hybrid stage without inertia", [STAGES("end: 10 s", "end: 2000 s, inertia: no, stepper: {type: hybrid}")],
     ["stage_b_stepper_type", "hybrid does not know inertia: no"], []),
    ("stage without inertia under the case's hybrid", [STAGES("end: 10 s", "end: 2000 s, inertia: no"), ("type: sdirk2", "type: hybrid")],
     ["stepper_type", "in stage b: hybrid does not know inertia: no"], []),
    ("steps of a stage out of order", [STAGES("end: 10 s", "end: 2000 s, stepper: {dt: 60 s}")], ["stage_b_stepper_dt", "stepper_dt_max"], []),
    ("gravity ramp longer than its stage", [STAGES("end: 10 s, gravity: [0 m/s^2, -1 m/s^2], gravity_ramp: 11 s", "end: 2000 s")],
     ["stage_a_gravity_ramp", "longer than the stage"], []),
    ("typo in a stage", [STAGES("end: 10 s", "end: 2000 s, inrtia: no")], ["stage_b_inrtia", "did you mean stage_b_inertia"], []),
    ("stage not listed", [STAGES("end: 10 s", "end: 2000 s}\n  d: {end: 3000 s")], ["stage 'd' is not listed in stages"], []),
    ("stage's tolerance out of range", [STAGES("end: 10 s", "end: 2000 s")], ["-stage_b_stepper_tol", "out of range"], ["-stage_b_stepper_tol", "2"]),
    ("bad clock", [("initial: yes}", "initial: yes, clock: wall}")], ["bc_drain_clock", "run | stage"], []),
    # --- command line
    ("a bracket that stays open on the command line", [], ["command line: -grid_cells = '[10'", "whole number"], ["-grid_cells", "[10,1"]),
    ("a list of the command line that disagrees with the rest", [], ["command line: -output_times: has 3000 s after time_end"], ["-output_times", "[1 s, 3000 s]", "-time_end", "2000 s"]),
    ("option without unit", [], ["-region_column_pressure", "needs the unit"], ["-region_column_pressure", "3e6"]),
    ("option out of range", [], ["-" + M + "porosity", "out of range"], ["-" + M + "porosity", "2"]),
    ("option misspelt", [], ["-" + M + "porosty", "did you mean " + M + "porosity"], ["-" + M + "porosty", "0.2"]),
    ("option of an unlisted region", [], ["-region_core_Sh", "not listed"], ["-region_core_Sh", "0.2"]),
    ("grid option misspelt", [], ["-grid_cell", "did you mean grid_cells"], ["-grid_cell", "52,1"]),
    # --- files
    ("unclosed bracket", [("cells: [52, 1]", "cells: [52, 1")], ["case.yaml:", "bracket"], []),
    ("unclosed quote", [("title: BP2", "title: 'BP2")], ["case.yaml:3", "quote"], []),
    ("tab", [("  cells:", "\tcells:")], ["case.yaml:", "tab"], []),
    ("wrong indentation", [("  cells: [52, 1]", "   cells: [52, 1]")], ["case.yaml"], []),
    ("alias without an anchor", [("basis: cpgimp", "basis: *a")], ["case.yaml:", "alias"], []),
    ("endless recursion", [("basis: cpgimp", "basis: &a {<<: *a}")], ["deeply"], []),
    ("endless map", [("basis: cpgimp", "basis: &a {b: *a}")], ["deeply"], []),
    ("merged value", [("basis: cpgimp", "basis: {<<: cpgimp}")], ["case.yaml:", "<<", "must be a map"], []),
    ("merged key out of range", [("porosity: 0.15", "porosity: 0.15\n    <<: {compaction: 3}")], ["case.yaml:", "compaction"], []),
    ("tag", [("basis: cpgimp", "basis: !include case.yaml")], ["case.yaml:", "tags", "not allowed"], []),
    ("key of signs", [("basis: cpgimp", "$$x: case.yaml")], ["case.yaml:", "begin with a letter"], []),
    ("key that is a list", [("basis: cpgimp", "? [a, b]\n: c")], ["case.yaml:", "a key is a word"], []),
    ("list of maps", [("cells: [52, 1]", "cells: [{a: 52}, 1]")], ["case.yaml:", "not maps"], []),
    ("text of lines", [("title: BP2", "title: |\n  BP2\n  again")], ["case.yaml:3", "line break"], []),
    ("two documents", [("basis: cpgimp", "---\nbasis: cpgimp")], ["case.yaml:", "second document"], []),
    ("a key like a number", [("basis: cpgimp", "nan_key: 3")], ["nan_key", "unknown key"], []),
    ("not a map", None, ["case.yaml"], [], b"hello\n"),
    ("empty", None, ["empty"], [], b" \n"),
    ("zero bytes", None, ["zero byte"], [], b"title: a\0b\n"),
    ("deep nesting", None, ["deeply"], [], b"a: " + b"[" * 500000),
    ("aliases of aliases", None, ["too many keys"], [],
     b"a0: &a0 {x: 1, y: 2}\n" + b"".join(b"a%d: &a%d {" % (i, i) + b", ".join(b"k%d: *a%d" % (j, i - 1) for j in range(9)) + b"}\n" for i in range(1, 9))),
    ("not UTF-8", None, ["case.yaml"], [], b"title: \xff\xfe\xfd\n"),
    ("huge", None, ["at most"], [], b"# x\n" * 300000),
]


def run(program, folder, options):
    with tempfile.TemporaryDirectory() as sessions:  # of MPI: of two runs that share one, the first to end may remove what the other has just made
        env = dict(os.environ, OMP_NUM_THREADS="1", OPENBLAS_NUM_THREADS="1", ASAN_OPTIONS="detect_leaks=0", PETSC_OPTIONS="", OMPI_MCA_orte_tmpdir_base=sessions)
        done = subprocess.run([program, folder, "-case_check"] + options, cwd=folder, env=env, capture_output=True, timeout=120)
    return done.returncode, (done.stdout + done.stderr).decode("utf-8", "replace")


def attempt(program, data, options):
    """Runs the case text; returns exit code, message and what was written."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "case.yaml"), "wb") as f:
            f.write(data)
        code, text = run(program, folder, options)
        return code, text, sorted(set(os.listdir(folder)) - {"case.yaml"})


def bad_case(program, row):
    what, edits, words, options = row[:4]
    if edits is None:
        data = row[4]
    else:
        text = BASE
        for old, new in edits:
            if text.count(old) != 1:
                return f"{what}: the base case holds '{old}' {text.count(old)} times; mend this test"
            text = text.replace(old, new)
        data = text.encode()
    code, message, written = attempt(program, data, options)
    if code != 2:
        return f"{what}: exit code {code}, not 2\n{message}"
    missing = [w for w in words if w not in message]
    if missing:
        return f"{what}: the message does not hold {missing}:\n{message}"
    if written:
        return f"{what}: wrote {written}"
    if os.environ.get("BAD_VERBOSE"):
        print(f"--- {what}\n{message}", end="")
    return None


def fuzzed(n, seed=1):
    """Truncations, flipped bytes and shuffled pieces of the good case."""
    rng = random.Random(seed)
    base = BASE.encode()
    for i in range(n):
        data = bytearray(base)
        if i % 3 == 0:
            del data[rng.randrange(len(data)):]
        elif i % 3 == 1:
            for _ in range(rng.randrange(1, 30)):
                data[rng.randrange(len(data))] = rng.randrange(256)
        else:
            for _ in range(rng.randrange(1, 6)):
                a, b, n_ = rng.randrange(len(data)), rng.randrange(len(data)), rng.randrange(1, 40)
                data[a:a + n_] = data[b:b + n_]
        yield i, bytes(data)


def fuzz_case(program, item):
    i, data = item
    code, message, written = attempt(program, data, [])
    if code not in (0, 2) or written or "Sanitizer" in message or "runtime error" in message:
        return f"fuzz {i}: exit code {code}, wrote {written}\n{message}"
    return None


def main():
    program = os.path.abspath(sys.argv[1])
    n_fuzz = int(os.environ.get("BAD_FUZZ", "30"))
    code, message, _ = attempt(program, BASE.encode(), [])
    failures = [] if code == 0 else [f"the good case: exit code {code}\n{message}"]
    results = [bad_case(program, row) for row in CASES] + [fuzz_case(program, item) for item in fuzzed(n_fuzz)]
    failures += [r for r in results if r]
    for f in failures:
        print("FAILED", f)
    print(f"{1 + len(results) - len(failures)} passed, {len(failures)} failed")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
