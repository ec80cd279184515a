#!/usr/bin/python3
"""Makes docs/options.md and docs/laws.md of this program: options_doc.py CLATHRA [--check | --pictures]

The keys of a case come from `CLATHRA -case_keys`; the options of the program itself are kept by hand below, and tests/docs.py holds them against what src/ reads.
Formulas of the laws stand in FORMULAS below or, where the balances use them, in docs/equations.md; files come from the comments that cite their numbers, and the curves from
`CLATHRA CASE -case_curves`: nothing is computed here but K_d of published pairs.  --check writes nothing and fails when a page is out of date; --pictures draws the laws, too.
"""
import difflib
import functools
import math
import re
import sys
from pathlib import Path

from clathra.program import call

ROOT = Path(__file__).resolve().parents[1]
PAGE, LAWS_PAGE = ROOT / "docs" / "options.md", ROOT / "docs" / "laws.md"
EQUATIONS, FIGURES = ROOT / "docs" / "equations.md", ROOT / "docs" / "figures"
CASE, MATERIAL = ROOT / "docs" / "laws.yaml", "sand"  # whose parameters the pictures have, but for what they vary

# ---------------------------------------------------------------- options and keys
PROGRAM = [  # option, value, default, meaning
    ("-case_check", "", "", "check the case and its start: refusals, forecast and warnings; write nothing"),
    ("-case_keys", "", "", "print every key of a case file and stop; needs no case"),
    ("-case_curves", "", "", "print the curves of the materials' laws, as in docs/laws.md, and stop"),
    ("-restart_as_initial", "FILE", "", "start at t = 0 from the particles of a checkpoint (docs/running.md says what may differ)"),
    ("-restart", "FILE", "", "go on from a checkpoint of the same case; times, integrator, outputs and solver may differ"),
    ("-quiet", "", "", "no line per step; refused steps and the summary are still printed"),
    ("-progress", "s", "1", "least wall time between lines of progress; 0 = a line for every step"),
    ("-time_limit", "s", "none", "wall time before which the run ends, with a checkpoint and exit code 4"),
    ("-checkpoint_wall", "s", "300", "wall time between checkpoints, beside those of `checkpoint_every`; 0 = none"),
    ("-overwrite", "", "", "write into an output folder that holds the results of another case"),
    ("-stepper_max_steps", "N", "no limit", "stop after N more steps (those without a matrix at the end of up to 256), with a checkpoint and exit code 0"),
    ("-newton_tol_residual", "x", "1e-9", "bound of every scaled row of the residual; rows of mass and energy 20 times lower"),
    ("-newton_tol_update", "x", "1e-6", "bound of every scaled update, in units of 1 MPa and 1 K"),
    ("-newton_keep_jacobian", "x", "0.01", "the Jacobian is kept where an iteration reduces the residual to less than x of it (343); 0: always a new one"),
    ("-newton_preconditioner", "auto, whole, reduced", "auto", "reduced: without the fluid velocities, LU or multigrid by size (330), LU of the whole for a stage where it breaks down; whole: -pc_type of the whole matrix; auto: reduced, unless -pc_type, -ksp_type or -model_pmat_type is given"),
    ("-newton_drop", "x", "1e-6", "entries below x of the largest of their row in the reduced matrix are left out (433)"),
    ("-newton_operator", "auto, assembled, particles", "auto", "exact Jacobian of GMRES, assembled or applied particle by particle (27), with half the memory; auto: particles with the reduced preconditioner"),
    ("-reduced_pc_type", "PETSc's", "by size", "solver of the reduced matrix: lu, or fieldsplit, multigrid of its two groups"),
    ("-reduced_pc_fieldsplit_type", "PETSc's", "multiplicative", "how flow (p_w, p_g, T) and motion (v_s) follow each other; where it is given, the coupling of flow to motion is stored"),
    ("-newton_refactor", "N", "by its cost", "a new preconditioner after a linear solve of more than N iterations, by default where it pays (176)"),
    ("-model_pmat_type", "aij, baij", "aij with UMFPACK, else baij", "storage of the preconditioner's matrix (aij: on one rank); UMFPACK needs aij, ILU by blocks baij"),
]  # fmt: skip

PETSC = [  # the ones worth knowing, with this program's defaults
    ("-snes_max_it", "30", "Newton iterations of a stage before the step is cut; from half of them on each must halve the residual"),
    ("-ksp_type", "fgmres", "Krylov method on the exact Jacobian"),
    ("-ksp_pc_side", "right", "so that it stops on the residual of the rows themselves"),
    ("-ksp_rtol", "1e-6", "its relative tolerance"),
    ("-ksp_atol", "0.02 newton_tol_residual", "its absolute tolerance, on scaled rows"),
    ("-ksp_max_it", "60", "iterations before the linear solve has failed"),
    ("-ksp_gmres_restart", "60", "vectors kept by GMRES"),
    ("-ksp_rtol", "1e-4", "... with the reduced preconditioner"),
    ("-ksp_max_it", "200", "... with the reduced preconditioner"),
    ("-pc_type", "lu", "preconditioner of the whole: lu, ilu, asm, bjacobi ..."),
    ("-reduced_fieldsplit_flow_pc_type", "gamg", "of p_w, p_g, T: aggregation, smoothed by ILU (-reduced_fieldsplit_flow_mg_levels_...)"),
    ("-reduced_fieldsplit_motion_pc_type", "hypre", "of v_s: BoomerAMG, strong threshold 0.5 (0.7 in space); gamg without hypre"),
    ("-exchange_ksp_max_it", "2000", "conjugate gradients of (354) in a step; where they do not suffice it does without, and the summary counts it"),
    ("-pc_factor_mat_solver_type", "umfpack up to 2500 unknowns on one rank, else mumps", "direct solver of the whole (-reduced_pc_factor_mat_solver_type: of the reduced matrix), or the next of docs/building.md"),
    ("-options_file", "", "reads options from a file, for example a preset of options/"),
    ("-snes_monitor, -ksp_converged_reason", "", "watch Newton's method and the linear solver"),
    ("-options_left", "", "at the end, lists options that nobody read: finds misspelt ones"),
    ("-log_view", "", "where the time went; this program's own events are ClBeginStep, ClResidual, ClJacobian, "
     "ClWidePart, ClReducedMatrix, ClReducedApply, ClProduct"),
]  # fmt: skip

HEAD = """\
# Options

Made by `scripts/options_doc.py`; do not edit by hand.

An option is given on the command line (`-name value`), in a file named by `-options_file`, or, where it is a key, in the case file. Command line and
options files win over the case, the later one over the earlier.

## Options of the program

| option | value | default | meaning |
|---|---|---|---|
{program}

## Options of PETSc that are worth knowing

Every `-snes_`, `-ksp_` and `-pc_` option of PETSc works. The program's own defaults are:

| option | default here | meaning |
|---|---|---|
{petsc}

A misspelt key of the case, and an unknown option that begins as this program's own do (`-stepper_`, `-newton_`, `-model_`, `-output_`, `-checkpoint_`,
`-case_`), is an error. Of PETSc's the run ends with the warning that it was not used.

## Keys of a case

Quantities carry units on the command line too: `-time_end "500 s"`. Bare numbers are seconds in {plain}, and the same of a stage.

{keys}"""


def case_keys(binary):
    """What the program says about the keys of a case, as Markdown."""
    return call("-case_keys", program=binary)


def plain_keys():
    """Keys whose number may do without a unit on the command line, from the key table's source."""
    text = (ROOT / "src" / "case" / "keys_case.c").read_text()
    rows = re.split(r"\n    (?=[A-Z]+\()", text)
    return list(dict.fromkeys(re.search(r'"(\w+)"', row).group(1) for row in rows if re.search(r"\.plain\s*=\s*true", row)))


def row(*cells):
    return "| " + " | ".join(cells) + " |"


def spare(line):
    """<name> outside backticks would be taken for HTML."""
    parts = line.split("`")
    return "`".join(re.sub(r"<([^>|]*)>", r"\\<\1\\>", part) if k % 2 == 0 else part for k, part in enumerate(parts))


def page(binary):
    program = [row(f"`{o}`", v, d, m) for o, v, d, m in PROGRAM]
    petsc = [row(", ".join(f"`{name}`" for name in o.split(", ")), d, m) for o, d, m in PETSC]
    plain = ", ".join(f"`-{name}`" for name in plain_keys())
    keys = "\n".join(spare(line) for line in case_keys(binary).splitlines())
    return HEAD.format(program="\n".join(program), petsc="\n".join(petsc), plain=plain, keys=keys) + "\n"


# ---------------------------------------------------------------- laws
# title; its curve; what the picture varies (label, keys of the material); equations; keys (without mat_<name>_); source
LAWS = [
    ("Retention", "retention", [("van_genuchten", "retention_law van_genuchten"), ("van_genuchten, twice p0", "retention_p0 40000"), ("brooks_corey", "retention_law brooks_corey retention_lambda 1")],
     (223, 224, 320, 321, 322), r"retention_\w+", "van Genuchten (1980), Brooks and Corey (1964); with hydrate Leverett (1941), and a power law as in S. Gupta's models"),
    ("Relative permeability", "relative_permeability", [("n = 4, 2", "relperm_nw 4 relperm_ng 2"), ("n = 2, 2", "relperm_nw 2 relperm_ng 2")],
     (225,), r"relperm_\w+", "Corey (1954)"),
    ("Permeability and hydrate", "permeability_hydrate", [("power, mh = 3", "permeability_mh 3"), ("power, mh = 8", "permeability_mh 8"), ("masuda_ramp", "permeability_hydrate_law masuda_ramp permeability_kh 0.1 permeability_Shc 0.5")],
     (226, 229, 230), r"permeability_(k0|hydrate_law|mh|kh|Shc)", "Masuda et al. (1999)"),
    ("Permeability and porosity", "permeability_porosity", [("kozeny_carman", "permeability_porosity_law kozeny_carman"), ("square_jacobian", "permeability_porosity_law square_jacobian")],
     (226, 227, 228), r"permeability_(k0|phi0|porosity_law)", "Kozeny (1927), Carman (1937); Xie and Leo (2004)"),
    ("Equilibrium of hydrate", "equilibrium", [("sloan", "kinetics_equilibrium sloan"), ("moridis", "kinetics_equilibrium moridis"), ("kamath", "kinetics_equilibrium kamath"), ("masuda", "kinetics_equilibrium masuda"),
      ("sloan, salinity 0.1", "kinetics_equilibrium sloan water_salinity 0.1")],
     (231, 232, 122, 123, 125), r"kinetics_(equilibrium|A\d)|water_salinity", "Sloan; Moridis (2003); Kamath (1984); Masuda (1999); Dickens and Quinby-Hunt (1994)"),
    ("Rate of the reaction", "rate_constant", [("dE = 0", "kinetics_K0 1e-11 kinetics_dE 0"), ("dE = 81 kJ/mol", "kinetics_K0 8.06e3 kinetics_dE 81084.2")],
     (11, 12, 13, 371, 233), r"kinetics_(active|K0|dE)|hydrate_(number|molar_mass)|water_molar_mass", "Kim, Bishnoi, Heidemann and Rizvi (1987)"),
    ("Surface on which hydrate forms", "formation_surface", [("", "")], (234, 418), r"porosity|kinetics_A_geo", "the paper; (418) ours, where water holds methane"),
    ("Heat of dissociation", "latent_heat", [("linear", "latent_heat_law linear"), ("kirchhoff", "latent_heat_law kirchhoff")], (235, 130), r"latent_heat_\w+", "the paper; Kirchhoff (1858)"),
    ("Density of gas", "gas_density", [("peng_robinson", "gas_eos peng_robinson"), ("ideal", "gas_eos ideal")], (222, 120, 121), r"gas_(molar_mass|eos|critical_\w+|acentric_factor)", "Peng and Robinson (1976)"),
    ("Density of water, grains and hydrate", "water_density", [("expansion 0", "water_expansion 0"), ("expansion 2e-4 1/K", "water_expansion 2e-4"), ("salinity 0.035", "water_expansion 0 water_salinity 0.035")],
     (221, 126), r"(solid|hydrate|water)_(density|expansion|bulk_modulus|ref_\w+|salinity)", "the paper; Sharqawy, Lienhard and Zubair (2010)"),
    ("Viscosities", "viscosity", [("constant", "water_viscosity_law constant gas_viscosity_law constant"), ("kestin, lee", "water_viscosity_law kestin gas_viscosity_law lee")],
     (128, 129), r"(water|gas)_viscosity(_law)?", "Kestin, Sokolov and Wakeham (1978); Lee, Gonzalez and Eakin (1966)"),
    ("Melting of ice", "melting", [("fresh", "water_salinity 0"), ("salinity 0.035", "water_salinity 0.035")], (127,), r"water_salinity", "Fofonoff and Millard (1983)"),
    ("Conductivity and heat capacity", "conductivity", [("", "")], (236,), r"\w+_(heat_capacity|conductivity)", "the paper"),
    ("Stiffness", "stiffness", [("bh = 1", "elasticity_bh 1"), ("bh = 2", "elasticity_bh 2")], (14, 93, 237), r"elasticity_\w+", "the paper"),
    ("Strength and hydrate", "strength", [("eta_h = 5", "plasticity_eta_h 5"), ("eta_h = 1", "plasticity_eta_h 1")], (61, 63, 455), r"plasticity_(law|cohesion_(m\w+|gradient|level)|dilation_\w+|eta_h|Sh_max|tension_cutoff|flow|eccentricity)", "the paper"),
    ("Softening", "softening", [("eta_s = 5", "plasticity_eta_s 5"), ("eta_s = 20", "plasticity_eta_s 20")], (62, 85, 87), r"plasticity_(cohesion_residual|friction_\w+|eta_s|softening_length|nonlocal_length|heat)|strength_factor", "the paper; Galavi and Schweiger (2010)"),
]  # fmt: skip

# Formulas that only docs/laws.md has; the number stands behind the first line
FORMULAS = {
    221: "rho = rho_0 exp[(p - p_ref)/K - beta (T - T_ref)]   liquid, solid, hydrate (P10)",
    222: "rho = M p/(R T_K)   `ideal` gas (P11)",
    223: "s_g = S_gr exp(p_-/p_trap) + (1 - S_wr - S_gr)(1 - [1 + (p_+/p_0)^(1/(1-m))]^-m),   p_+- = +-p_s ln(1 + exp(+-p_c/p_s))   van Genuchten, smooth (P4), (P6)",
    224: "s_g = S_gr + (1 - S_wr - S_gr)(1 - (p_c/p_0)^-lambda) above p_c = p_0   Brooks and Corey",
    320: "s_g = law[(1 - S_h)^n p_c],   that is p_c = p_c,law(s_g)/(1 - S_h)^n;   ds_g/dS_h = - n p_c/(1 - S_h) ds_g/dp_c,   n = `hydrate_exponent`",
    321: "S_h rho_h V_p = m_h(s_g(p_c, S_h), q),   dS_h = [d(m_h/(rho_h V_p))/dq at fixed S_h] dq/(1 - d(m_h/(rho_h V_p))/dS_h),   q = (J, p_w, p_g, T)",
    322: "-dm/dV_h = c - (1 - S_h) dc/ds_g ds_g/dS_h = c + n p_c ds_g/dp_c dc/ds_g",
    225: "k_r = b^n,   b = (s - s_r)/(1 - S_wr - S_gr) in [0, 1]   Corey (P42)",
    226: "k_a = k_0 f_phi(phi) f_Sh(S_h)   (P38)",
    227: "f_phi = (phi/phi_0)^1.5 [(1 - phi_0)/(1 - phi)]^3   `kozeny_carman` (P39)",
    228: "f_phi = [(1 - phi_0)/(1 - phi)]^2   `square_jacobian`",
    229: "f_Sh = (1 - S_h)^mh   `power` (P41)",
    230: "f_Sh = k_h + (1 - k_h)(S_hc - S_h)/S_hc below S_hc, k_h above   `masuda_ramp` (P40)",
    231: "p_e = A_1 exp(A_2 - A_3/T_K)   `sloan` (P37)",
    232: "ln p_e = sum_i a_i T^i   `moridis`: over water, over ice, joined where they cross",
    122: "p_e = exp(14.717 - 1886.79/T_K), exp(38.980 - 8533.80/T_K) kPa   `kamath`: over ice, over water, joined so",
    123: "p_e = 1.15 exp(49.3185 - 9459/T_K) Pa   `masuda`",
    233: "K_d = K_0 exp(-dE/(R T_K))   (P35)",
    234: "A_s = A_geo s_w s_g (1 - S_h)^3   of formation (P36)",
    235: "L = C_0 - C_1 T_K, J per kg of hydrate   (P30)",
    130: "L = L(T_ref) + [(N_h M_w c_w + M_g c_g)/M_h - c_h] (T - T_ref),   L(T_ref) by (235)   `kirchhoff`",
    236: "X = (1 - phi) X_s + phi [S_h X_h + (1 - S_h)(s_w X_w + s_g X_g)]   of a mixture (P29)",
    237: "E = E_0 + a_h E_h S_h^b_h   (P46)",
    61: "c_p = c_min + (c_max - c_min) exp[eta_h (S_h - S_h,max)],   likewise psi_p;   phi_p constant",
    62: "c = c_res + (c_p - c_res) exp(-eta_s eps),   phi = phi_res + (phi_p - phi_res) exp(-eta_s eps),   psi = psi_p exp(-eta_s eps)",
    455: "c(z) = c + (c/c_max) k max(0, z_0 - z),   c = c_max, c_min, c_res,   k = `cohesion_gradient`",
    87: "c/F,   tan(phi)/F,   tan(psi)/F,   T/F,   F = `strength_factor`,   T = `tension_cutoff`",
    120: """Z^3 - (1 - B) Z^2 + (A - 3 B^2 - 2 B) Z - (A B - B^2 - B^3) = F(Z) = 0,   rho_g = M p_g/(Z R T_K)   `peng_robinson`
A = a p/(R T_K)^2,   a = 0.45723553 (R T_c)^2/p_c [1 + k (1 - sqrt(T_K/T_c))]^2,   k = 0.37464 + 1.54226 w - 0.26992 w^2,   w the acentric factor
B = b p/(R T_K),   b = 0.07779607 R T_c/p_c""",
    121: "dZ = - (F_A dA + F_B dB)/F_Z,   F_A = Z - B,   F_B = Z^2 - (6 B + 2) Z - A + 2 B + 3 B^2",
    125: """p_e = p_e,fresh(T + dT_s),   dT_s = 1.1 K ln(1 - x)/ln(1 - x(0.0335)),   x = (S/M_s)/(S/M_s + (1 - S)/M_w),   M_s = 0.05844 kg/mol
S = `salinity`, kg of salt per kg of pore water""",
    126: "rho_0 = fresh density + S [802.0 - 2.001 T + 1.677e-2 T^2 - 3.06e-5 T^3 - 1.613e-5 S T^2],   T = T_ref in degC,   S = `salinity`",
    127: "T_m = -0.0575 s + 1.710523e-3 s^1.5 - 2.154996e-4 s^2 - 7.53e-4 (p_w - 101325 Pa)/(10^4 Pa),   s = 1000 `salinity`",
    128: """log10(mu_w/1.002e-3) = (20 - T)/(T + 96) [1.2364 - 1.37e-3 (20 - T) + 5.7e-6 (20 - T)^2],   mu_w *= 1 + S (A + B S)   `kestin`
A = 1.541 + 1.998e-2 T - 9.52e-5 T^2,   B = 7.974 - 7.561e-2 T + 4.724e-4 T^2,   S = `salinity`""",
    129: """mu_g = 1e-7 K exp[X (rho_g/1000)^Y],   K = (9.379 + 0.01607 M) t^1.5/(209.2 + 19.26 M + t),   t = 1.8 T_K,   M in g/mol   `lee`
X = 3.448 + 986.4/t + 0.01009 M,   Y = 2.447 - 0.2224 X""",
}  # fmt: skip

NOTES = {  # what belongs to the formulas of a law, by its curve
    "retention": "Below p_c = 0, where the printed law ends, (223) compresses trapped gas, so that p_c and s_g follow from each other. Hydrate that narrows the pores raises p_c: Leverett's p_c ~ sqrt(phi/k) with (229) is "
    "n = (m_h - 1)/2. In implicit steps s_g and S_h are solved together in the particle (321); `hybrid` has the hydrate of t_n. A unit volume of hydrate displaces (322) of a fluid with content c.",
    "equilibrium": "(125) is the form of an ideal solution through the 1.1 K measured in sea water.",
    "latent_heat": "With (130) the heat that hydrate stores does not depend on the path; with (235) a closed cell loses or gains the difference of the slopes.",
    "gas_density": "The largest root Z is the gas. A region must start above T_c. Methane is within 3 % of Setzmann and Wagner (1991) from 3 to 15 MPa, 2 to 27 degC.",
    "viscosity": "mu_w does not depend on pressure; its salt is that of Sharqawy, Lienhard and Zubair (2010).",
}  # fmt: skip

SYMBOLS = [  # as formulas write it; what it is; SI unit
    ("p_w, p_g, p", "pressure of water, of gas, their mean s_w p_w + s_g p_g", "Pa"), ("p_c", "capillary pressure p_g - p_w; in (120) the critical one", "Pa"),
    ("T, T_K", "temperature in degC, in kelvin", "degC, K"), ("phi", "porosity; in strength the friction angle", "-, deg"), ("S_h, S_w, S_g", "share of the pores that hydrate, water, gas fill", "-"),
    ("s_w, s_g", "share of the open pores, S_w/(1 - S_h), S_g/(1 - S_h)", "-"), ("rho", "density", "kg/m^3"), ("k_r", "relative permeability", "-"), ("k_a, k_0", "intrinsic permeability, that without hydrate at phi_0", "m^2"),
    ("f_phi, f_Sh", "its factors of porosity and hydrate", "-"), ("p_e", "equilibrium pressure of hydrate", "Pa"), ("K_d", "rate constant", "mol/(m^2 Pa s)"), ("A_s", "surface per volume", "1/m"), ("L", "heat of dissociation", "J/kg"),
    ("X", "conductivity, or density times specific heat", "W/(m K), J/(m^3 K)"), ("E", "Young's modulus", "Pa"), ("c, psi", "cohesion, dilation angle", "Pa, deg"), ("eps", "deviatoric plastic strain", "-"), ("sigma'", "effective stress, tension-positive", "Pa"),
    ("m_h", "mass of hydrate", "kg"), ("R", "rate of the reaction; gas constant where beside T_K", "mol/(m^3 s), J/(mol K)"), ("mu", "viscosity", "Pa s"), ("M", "molar mass", "kg/mol"), ("*", "starred: what the stage starts from", ""),
]  # fmt: skip


@functools.cache
def keys(binary):
    """[(key without mat_<name>_, kind, unit, range, default, meaning)] of materials, and strength_factor."""
    rows = [[w.strip() for w in line.strip("|\n").split(" | ")] for line in call("-case_keys", program=binary).splitlines() if line.startswith("| `")]
    return [(re.sub(r"`(mat_<name>_)?", "", r[0].strip("| ")), *r[1:6]) for r in rows if "mat_<name>" in r[0] or r[0].strip("| ") == "`strength_factor`"]


def formulas():
    """{number: lines with the number behind the first}, of docs/equations.md and FORMULAS"""
    theirs = {int(n): f"    {line.strip()} ({n})" for line, n in re.findall(r"^ {4}(.*)\((\d+)\) *$", EQUATIONS.read_text(), re.M)}
    own = {n: "\n".join(f"    {line} ({n})" if k == 0 else f"    {line}" for k, line in enumerate(text.splitlines())) for n, text in FORMULAS.items()}
    return theirs | own


@functools.cache
def citations():
    """{path: numbers that its comments cite}"""
    comments = lambda path: "\n".join(re.findall(r"/\*.*?\*/", path.read_text(), re.S))
    return {str(p.relative_to(ROOT)): {int(n) for n in re.findall(r"(?<![\w)])\((\d{1,3})\)", comments(p))} for p in sorted([*(ROOT / "src").rglob("*.[ch]"), *(ROOT / "include").rglob("point_*.h")])}


def files(number):
    """Where a comment of the code cites it."""
    return [path for path, numbers in citations().items() if number in numbers]


def curves(binary, name, variation):
    """Columns' names, and the rows of a curve with other keys."""
    words = variation.split()
    units = {k[0]: k[2] for k in keys(binary)}
    options = []
    for key, value in zip(words[::2], words[1::2]):
        unit = units.get(key, "")
        options += [f"-mat_{MATERIAL}_{key}", f"{value} {unit}" if re.fullmatch(r"[-+.\de]+", value) and unit else value]
    text = call(CASE, "-case_curves", *options, program=binary)
    block = re.search(rf"^# {name} of {MATERIAL}: (.*)\n((?:[^#].*\n)+)", text, re.M)
    return block[1].split(", "), [[float(v) for v in line.split(",")] for line in block[2].splitlines()]


# Published pairs of K_0 (mol/(m^2 Pa s)) and dE (J/mol).
PAIRS = (("Kim, Bishnoi, Heidemann and Rizvi (1987)", 1.24e5, 78151.0), ("Clarke and Bishnoi (2001)", 3.6e4, 81e3))


def published_pairs():
    """The table of PAIRS, with K_d at two temperatures (degC)."""
    at = lambda K0, dE, T: f"{K0 * math.exp(-dE / (8.314 * (T + 273.15))):.2g}"
    return ["Published pairs of methane, with what they make of K_d, mol/(m^2 Pa s):", "", "| source | `K0`, mol/(m^2 Pa s) | `dE`, J/mol | K_d at 2 degC | K_d at 10 degC |", "|---|---|---|---|---|",
            *(f"| {name} | {K0:.3g} | {dE:.5g} | {at(K0, dE, 2)} | {at(K0, dE, 10)} |" for name, K0, dE in PAIRS), "",
            "78151 J/mol is 9400 K times R. The rate of a volume is K_0 `A_geo`. K_0 was measured on crystals in a stirred cell; the surface of hydrate in pores (1e5 to 1e6 1/m in the cases here, 1 to 10 1/m "
            "in lumps and veins) is the less certain number of the two.", ""]  # fmt: skip


def laws_page(binary):
    table, text = keys(binary), formulas()
    out = ["# Laws", "", "<!-- made by scripts/options_doc.py -->", "",
           "Every constitutive relation: its formula, numbered with those of [equations.md](equations.md), the curve as the program evaluates it (`clathra CASE -case_curves` prints them for any case), "
           "its keys below `mat_<name>_` (meaning, range and default: [options.md](options.md#keys-of-a-case)), source and code. The pictures have the parameters of [laws.yaml](laws.yaml) but for what they vary.", "",
           "## Symbols", "", "| symbol | what it is | SI unit |", "|---|---|---|"]  # fmt: skip
    out += [f"| {s} | {what} | {unit} |" for s, what, unit in SYMBOLS]
    for title, curve, _, numbers, pattern, source in LAWS:
        own = ", ".join(f"`{k[0]}`" + (f" ({', '.join(words)})" if (words := key_note(k)) else "") for k in table if re.fullmatch(pattern, k[0]))
        where = sorted({f for n in numbers for f in files(n)})
        out += ["", f"## {title}", "", *(text[n] for n in numbers), "", *([NOTES[curve], ""] if curve in NOTES else []), f"![{title}](figures/law_{curve}.png)", "", f"Keys: {own}.", "",
                *(published_pairs() if curve == "rate_constant" else []), f"Source: {source}. Code: {', '.join(f'`{f}`' for f in where)}."]  # fmt: skip
    return "\n".join([*out, ""])


def key_note(key):
    """The words of a choice, or the unit of a number."""
    return [word for word in (key[2],) if word] if key[1] in ("number", "integer", "name") else [key[1]] if key[1] != "yes, no" else []


def draw(binary):
    from clathra.plotting import plt, set_style

    set_style()
    for title, curve, variations, *_ in LAWS:
        columns, _ = curves(binary, curve, variations[0][1])
        fig, axes = plt.subplots(1, len(columns) - 1, figsize=(3.6 * max(len(columns) - 1, 1.4), 2.9), squeeze=False)
        for label, variation in variations:
            columns, rows = curves(binary, curve, variation)
            for k, ax in enumerate(axes[0]):
                ax.plot([r[0] for r in rows], [r[k + 1] for r in rows], label=label)
        for k, ax in enumerate(axes[0]):
            ax.set(xlabel=columns[0].removesuffix(" -"), title=columns[k + 1].removesuffix(" -"))
            if curve == "equilibrium" or curve == "permeability_hydrate":
                ax.set_yscale("log")
        if variations[0][0]:
            axes[0][0].legend()
        fig.savefig(FIGURES / f"law_{curve}.png", dpi=80)
        plt.close(fig)


def main(binary, *options):
    pages = {PAGE: page(binary), LAWS_PAGE: laws_page(binary)}
    if "--check" not in options:
        for path, text in pages.items():
            path.write_text(text)
        return draw(binary) if "--pictures" in options else 0
    stale = 0
    for path, text in pages.items():
        old = path.read_text() if path.is_file() else ""
        difference = list(difflib.unified_diff(old.splitlines(), text.splitlines(), str(path), "as it should be", lineterm=""))
        print("\n".join(difference) if difference else f"{path} is up to date")
        stale |= bool(difference)
    return stale


if __name__ == "__main__":
    if len(sys.argv) < 2 or not set(sys.argv[2:]) <= {"--check", "--pictures"}:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
