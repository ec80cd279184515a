#!/usr/bin/python3
"""Study of cases/masuda: writes docs/studies/masuda.md and the table of sensitivity in cases/masuda/README.md.

masuda.py [CLATHRA] [--fresh] [--jobs N]

CLATHRA  the program, default build/clathra
--fresh  run again what results/masuda_study holds already
--jobs   runs at a time, default 2

Every number of the page is of one of its runs.  It is a study, no test: it takes about ten minutes.
"""
import argparse
import math
import os
import re
import shlex
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests" / "verification"), str(ROOT / "scripts")]
import dated  # noqa: E402
from common import environment  # noqa: E402
from reference import BARS, REFERENCE, at_times, curves, differences, dissociated, gas_at_start  # noqa: E402
from clathra import read_csv, read_snapshots  # noqa: E402

FOLDER, PAGE, README = ROOT / "results" / "masuda_study", ROOT / "docs" / "studies" / "masuda.md", ROOT / "cases" / "masuda" / "README.md"
MAT = "-mat_berea_"


def mesh(axial, radial):
    return ["-grid_cells", f"{radial},{axial}"]


def radius(mm, alpha):
    probes = [w for k, y in enumerate((75, 150, 225)) for w in (f"-probe_T{k + 1}_at", f"{mm} mm, {y} mm")]
    return ["-grid_upper", f"{mm} mm, 300 mm", "-region_core_upper", f"{mm} mm, 300 mm", "-bc_bath_alpha", f"{alpha} W/(m^2 K)",
            *probes]  # fmt: skip


LUMPED = radius(2.54, 2.5)  # the same heat to a volume, a hundredth of the radial resistance
NO_PC = [f"{MAT}retention_p0", "10 Pa"]
TO_4H = ["-time_end", "4 h", "-output_times", "2 h"]
FIXED = lambda dt: ["-stepper_adapt", "no", "-stepper_dt", f"{dt} s", *TO_4H]
# every v_s is held by a stiffness: a strain of 1e-6
STIFF = ["-fields", "thmc", f"{MAT}elasticity_E0", "1e12 Pa", "-boundaries", "outlet,bath,shell,far,mouth",
         "-bc_shell_type", "roller", "-bc_shell_axis", "x", "-bc_shell_position", "25.4 mm",
         "-bc_far_type", "roller", "-bc_far_axis", "y", "-bc_far_position", "300 mm",
         "-bc_mouth_type", "traction", "-bc_mouth_side", "bottom", "-bc_mouth_normal", "2.84 MPa"]  # fmt: skip
ADAPTIVE = {"60x10": mesh(60, 10), "30x4": mesh(30, 4), "30x5": mesh(30, 5), "120x20": mesh(120, 20),
            "lumped": mesh(60, 2) + LUMPED, "lumped, no p_c": mesh(60, 2) + LUMPED + NO_PC,
            "60x10, no p_c": mesh(60, 10) + NO_PC, "60x10, thmc": mesh(60, 10) + STIFF}  # fmt: skip
MESHES = {f"{a}x{r}": mesh(a, r) + FIXED(150) for a, r in ((30, 5), (60, 10), (120, 20))}
ALONG = {f"{a}x2": mesh(a, 2) + FIXED(150) for a in (15, 30, 60, 120, 240)}
ACROSS = {f"15x{r}": mesh(15, r) + FIXED(150) for r in (2, 4, 8, 16, 32)}
STEPS = {(kind, dt): mesh(30, 4) + FIXED(dt) + ["-stepper_type", kind]
         for kind in ("sdirk2", "euler") for dt in (300, 150, 75, 37.5, 18.75)}  # fmt: skip
RAMP = ["-bc_outlet_pressure_ramp", "3.75 MPa, 2.84 MPa, 0 s, 30 min"]
STEPS.update({("sdirk2, ramp", dt): STEPS["sdirk2", dt] + RAMP for dt in (300, 150, 75, 37.5, 18.75)})
C1_IN_C = 446120 - 132.638 * 273.15
SENSITIVITY = (  # what, options
    ("**the case**", []),
    ("alpha = 20 W/(m² K)", ["-bc_bath_alpha", "20 W/(m^2 K)"]),
    ("alpha = 30 W/(m² K)", ["-bc_bath_alpha", "30 W/(m^2 K)"]),
    ("A1 = 1.0 Pa", [f"{MAT}kinetics_A1", "1 Pa"]),
    ("K_0 = 1.8e4", [f"{MAT}kinetics_K0", "1.8e4 mol/(m^2 Pa s)"]),
    ("K_0 = 7.2e4", [f"{MAT}kinetics_K0", "7.2e4 mol/(m^2 Pa s)"]),
    ("K_0 = 3.6e6 (near equilibrium)", [f"{MAT}kinetics_K0", "3.6e6 mol/(m^2 Pa s)"]),
    ("heat C0 + C1 T, T in kelvin", [f"{MAT}latent_heat_C1", "-132.638 J/(kg K)"]),
    ("heat C0 + C1 T, T in °C", [f"{MAT}latent_heat_C0", f"{C1_IN_C:.6f} J/kg", f"{MAT}latent_heat_C1", "-132.638 J/(kg K)"]),
    ("k_r of all pores, S_wr 0.2, S_gr 0", [f"{MAT}relperm_Swr", "0.2"]),
    ("k_r of all pores, S_wr 0.1, S_gr 0.05", [f"{MAT}relperm_Sgr", "0.05"]),
    ("k_r of the fluids (42), S_wr 0.1, S_gr 0", [f"{MAT}relperm_share_of", "fluids"]),
    ("k_r of the fluids (42), S_wr 0.2, S_gr 0.3", [f"{MAT}relperm_share_of", "fluids", f"{MAT}relperm_Swr", "0.2",
                                                    f"{MAT}relperm_Sgr", "0.3"]),
    ("p_0 = 10 Pa: no capillary pressure", NO_PC),
    ("p_0 = 100 kPa", [f"{MAT}retention_p0", "100 kPa"]),
    ("retention S_wr 0.1, S_gr 0", [f"{MAT}retention_Swr", "0.1", f"{MAT}retention_Sgr", "0"]),
    ("outlet holds the first p_c", ["-bc_outlet_saturation", "held"]),
    ("k = 0.01 k_0 also without hydrate", [f"{MAT}permeability_hydrate_law", "none", f"{MAT}permeability_k0", "9.67e-16 m^2"]),
    ("radius 30.2 mm", radius(30.2, 25)),
    ("lumped radius", LUMPED),
)  # fmt: skip


# ---------------------------------------------------------------------------------------------------------- running
class Done:
    """A finished run: folder, CPU time (s), peak memory (MB), and its curves when first asked for."""

    def __init__(self, name, folder, cpu, memory, said):
        self.name, self.folder, self.cpu, self.memory, self.said = name, folder, cpu, memory, said
        found = re.search(r"(\d+) steps, (\d+) refused, (\d+) Newton", (folder / "summary.txt").read_text())
        self.steps, self.refused, self.newton = map(int, found.groups())
        self._curves = None

    @property
    def curves(self):
        self._curves = self._curves or curves(self.folder)
        return self._curves


def execute(command, log):
    """Runs it; returns CPU seconds and peak memory in MB."""
    with open(log, "w") as stream:
        process = subprocess.Popen(command, env=environment(), stdin=subprocess.DEVNULL, stdout=stream,
                                   stderr=subprocess.STDOUT)  # fmt: skip
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"{shlex.join(command)}\nended with {process.returncode}:\n{Path(log).read_text()[-2000:]}")
    return used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def run(program, name, options, fresh):
    folder = FOLDER / re.sub(r"[^\w.]+", "_", name)
    words, note = shlex.join(options), folder / "study.txt"
    log = folder.with_suffix(".log")
    if fresh or not note.is_file() or note.read_text().splitlines()[0] != words:
        start = time.monotonic()
        command = [str(program), str(ROOT / "cases" / "masuda"), "-quiet", "-output_dir", str(folder), *options]
        cpu, memory = execute(command, log)
        note.write_text(f"{words}\n{cpu}\n{memory}\n")
        print(f"{name}: {time.monotonic() - start:.0f} s", flush=True)
    cpu, memory = map(float, note.read_text().splitlines()[1:3])
    return Done(name, folder, cpu, memory, log.read_text())


def sizes(program, options):
    """Unknowns a node, rows and non-zeros of the assembled matrix, from one step."""
    command = [str(program), str(ROOT / "cases" / "masuda"), *options, "-quiet", "-ksp_view", "-stepper_max_steps", "1", "-output_dir",
               str(FOLDER / "sizes")]  # fmt: skip
    execute(command, FOLDER / "sizes.log")
    text = (FOLDER / "sizes.log").read_text()
    view = text[text.index("PC Object") :]
    matrix = view[view.index("matrix followed by preconditioner matrix") :]
    entry = re.search(r"type: \w*aij.*?rows=(\d+).*?total: nonzeros=(\d+)", matrix, re.S)
    return int(re.search(r"(\d+) unknowns a node", text)[1]), int(entry[1]), int(entry[2])


# ----------------------------------------------------------------------------------------------------------- writing
def table(head, rows):
    text = [[c if isinstance(c, str) else f"{c:.4g}" for c in row] for row in rows]
    return ["| " + " | ".join(r) + " |" for r in [list(head), ["---"] * len(head), *text]] + [""]


def against_reference(done):
    reference, rows = read_csv(REFERENCE), []
    for name in ("60x10", "30x4", "120x20", "60x10, no p_c", "lumped", "lumped, no p_c",
                 "k_r of the fluids (42), S_wr 0.1, S_gr 0", "k_r of the fluids (42), S_wr 0.2, S_gr 0.3"):
        worst = []
        for column, (_, how, bar) in BARS.items():
            error = np.max(np.abs(differences(done[name].curves, reference, column)))
            worst.append((f"{100 * error:.2f} %" if how == "itself" else f"{error:.3f}{' K' if how == 'K' else ''}")
                         + ("" if error <= bar else " **missed**"))  # fmt: skip
        rows.append([name, *worst])
    bars = [f"{100 * b:g} %" if how == "itself" else f"{b:g}{' K' if how == 'K' else ''}" for _, how, b in BARS.values()]
    return table(["run (axis x radius)", "far-end p_g", "T1", "T2", "T3", "gas out", "gas out + free", "S_h/S_h0"],
                 [["bar", *bars], *rows])  # fmt: skip


WATCHED = (("gas produced (cm³)", "gas_out_cm3"), ("S_h/S_h0", "Sh_frac"), ("far-end p_g (MPa)", "pg_far_MPa"), ("T1 (°C)", "T75_C"),
           ("T3 (°C)", "T225_C"))  # fmt: skip


def self_convergence(done, names, shown, minutes=120.0, ratio=2.0):
    """Values of each run, then differences between neighbours and the orders that follow."""
    values = {c: [at_times(done[n].curves, c, minutes)[0] for n in names] for _, c in WATCHED}
    step = {c: np.abs(np.diff(v)) for c, v in values.items()}
    rows = [[s, *(f"{values[c][k]:.7g}" for _, c in WATCHED)] for k, s in enumerate(shown)]
    rows += [[f"{shown[k]} to {shown[k + 1]}", *(f"{step[c][k]:.2e}" for _, c in WATCHED)] for k in range(len(names) - 1)]
    for k in range(len(names) - 2):
        order = [math.log(step[c][k] / step[c][k + 1], ratio) if min(step[c][k : k + 2]) > 0 else math.nan for _, c in WATCHED]
        rows.append([f"order from {shown[k]}, {shown[k + 1]}, {shown[k + 2]}", *(f"{o:.2f}" for o in order)])
    return table(["", *(w for w, _ in WATCHED)], rows)


def clock(minutes):
    return "not by 6 h" if math.isnan(minutes) else f"{minutes:.0f} min"


def sensitivity(done):
    reference, rows, base = read_csv(REFERENCE), [], done[SENSITIVITY[0][0]].curves
    first = at_times(base, "gas_tot_cm3", 120)[0]
    for name, _ in SENSITIVITY:
        c = done[name].curves
        if name == "radius 30.2 mm":  # amounts of this core, not scaled to the other
            c = {**c, **{k: c[k] * (30.2 / 25.4) ** 2 for k in ("gas_tot_cm3", "gas_out_cm3", "total_cm3")}}
        gas = at_times(c, "gas_tot_cm3", 120)[0]
        p = at_times(c, "pg_far_MPa", 30)[0]
        rows.append([name, f"{at_times(c, 'gas_out_cm3', 120)[0]:.0f}", f"{gas:.0f}", f"{100 * (gas / first - 1):+.1f} %", f"{p:.4f}",
                     f"{np.min(c['T75_C']):.3f}", clock(dissociated(c, 0.01)), clock(dissociated(c, 0.001))])  # fmt: skip
    at = lambda column, t: reference[column][np.flatnonzero(reference["t_min"] == t)[0]]
    left = {"t_min": reference["t_min"], "Sh_frac": reference["Sh_frac"]}
    rows.append(["reference curves", f"{at('gas_out_cm3', 120):.0f}", f"{at('gas_tot_cm3', 120):.0f}",
                 f"{100 * (at('gas_tot_cm3', 120) / first - 1):+.1f} %", f"{at('pg_far_MPa', 30):.4f}",
                 f"{np.min(reference['T75_C']):.3f}", clock(dissociated(left, 0.01)), clock(dissociated(left, 0.001))])  # fmt: skip
    return table(["changed", "gas out at 2 h (cm³)", "gas out + free at 2 h (cm³)", "change", "far-end p_g at 30 min (MPa)",
                  "least T1 (°C)", "1 % of hydrate left at", "0.1 % left at"], rows)  # fmt: skip


def cost(done, program):
    rows = []
    for label, name in (("water, gas, heat (`fields: auto`)", "60x10"), ("thmc, skeleton held by E = 1e12 Pa", "60x10, thmc")):
        d, options = done[name], ADAPTIVE[name]
        a_node, size, entries = sizes(program, options)
        rows.append([label, f"{a_node}", f"{size}", f"{entries}", f"{d.steps} / {d.refused}", f"{d.newton}", f"{d.cpu:.1f}",
                     f"{1e3 * d.cpu / d.steps:.0f}", f"{d.memory:.0f}"])  # fmt: skip
    both = [done[n].curves for n in ("60x10", "60x10, thmc")]
    differ = [np.max(np.abs(at_times(both[0], c, np.arange(15, 241, 15.0)) - at_times(both[1], c, np.arange(15, 241, 15.0))))
              for c in ("pg_far_MPa", "T75_C", "gas_out_cm3", "Sh_frac")]  # fmt: skip
    said = (f"Largest difference between the two to 4 h: {1e6 * differ[0]:.0f} Pa, {differ[1]:.1e} K, {differ[2]:.1f} cm³ of gas, "
            f"{differ[3]:.1e} of S_h/S_h0; their steps are chosen by the error estimate and differ too.")
    head = ["fields", "unknowns a node", "rows", "non-zeros", "steps / refused", "Newton iterations", "CPU time (s)",
            "a step (ms)", "memory (MB)"]  # fmt: skip
    return [*table(head, rows), said, ""]


def field(snapshots, minutes):
    return next(s for t, s in snapshots if abs(t - 60 * minutes) < 1e-6 * (t + 1))


def near(s, name, r=None, y=None):
    """Mean of the particles nearest to radius r and place y (m); all along an axis left out."""
    x, keep = s["position"], np.ones(len(s["position"]), bool)
    for value, k in ((r, 0), (y, 1)):
        if value is not None:
            away = np.abs(x[:, k] - value)
            keep &= away < away.min() + 1e-9
    return np.average(s[name][keep, 0], weights=s["volume"][keep, 0])


def words(done):
    """What section 4.1 of the paper says beside what the run says: rows."""
    run, snaps = done["60x10"].curves, read_snapshots(done["60x10"].folder)
    R, L = 0.0254, 0.3
    at10, at60, at240, at360 = (field(snaps, m) for m in (10, 60, 240, 360))
    contrast = lambda s, y: near(s, "T", R, y) - near(s, "T", 0, y)
    least = {c: (np.min(run[c]), run["t_min"][np.argmin(run[c])]) for c in ("T75_C", "T150_C", "T225_C")}
    warm = {c: run["t_min"][np.flatnonzero((run[c] > 1.9) & (run["t_min"] > 60))[0]] for c in ("T75_C", "T225_C")}
    value = lambda c, m: at_times(run, c, m)[0]
    Sg = {m: near(field(snaps, m), "S_g") for m in (180, 240, 360)}
    reference = read_csv(REFERENCE)
    no_pc = done["60x10, no p_c"].curves
    pc = max(np.abs(differences(run, reference, "pg_far_MPa"))), max(np.abs(differences(no_pc, reference, "pg_far_MPa")))
    jump = [(m, value("pg_far_MPa", m)) for m in (60, 180, 210, 225)]
    flat = done["k = 0.01 k_0 also without hydrate"].curves
    pores, hydrate = gas_at_start()
    return (
        ("At 10 min the fall of gas pressure spreads from the outlet, hydrate dissociates there and cools it",
         f"p_g {near(at10, 'p_g', y=0) / 1e6:.2f} MPa at the outlet, {near(at10, 'p_g', y=L / 2) / 1e6:.2f} in the middle, "
         f"{near(at10, 'p_g', y=L) / 1e6:.2f} at the closed end; T {near(at10, 'T', y=0):.2f}, {near(at10, 'T', y=L / 2):.2f}, "
         f"{near(at10, 'T', y=L):.2f} °C; S_h {near(at10, 'S_h', y=0):.3f}, {near(at10, 'S_h', y=L / 2):.3f}, "
         f"{near(at10, 'S_h', y=L):.3f}. Agrees"),
        ("At 1 h the temperature gradient between outlet (\"maintained by the warm air bath\") and inner core is more pronounced",
         f"Radially it is small: surface less axis {contrast(at10, L / 2):.3f} K at 10 min, {contrast(at60, L / 2):.3f} K at 1 h in the "
         f"middle (alpha R/kappa is about 0.1). Along the core T falls towards the outlet, where p is least: "
         f"{near(at60, 'T', y=0):.2f} °C there, {near(at60, 'T', y=L):.2f} at the closed end, against "
         f"{near(at10, 'T', y=0):.2f} and {near(at10, 'T', y=L):.2f} at 10 min. The bath acts on the cylinder; hydrate goes there "
         f"first: S_h at 1 h {near(at60, 'S_h', R, L / 2):.3f} at the surface, {near(at60, 'S_h', 0, L / 2):.3f} on the axis"),
        ("By 4 h all hydrate has dissociated, p_g and T are steady",
         f"S_h/S_h0 = {value('Sh_frac', 240):.1e} at 4 h (1 % at {dissociated(run, 0.01):.0f} min, 0.1 % at {dissociated(run, 0.001):.0f} "
         f"min), p_g {value('pg_far_MPa', 240):.3f} MPa at the closed end; T is still rising: T1 {value('T75_C', 240):.2f}, T3 "
         f"{value('T225_C', 240):.2f} °C, within 0.05 K of the bath at 5 h (T3 {value('T225_C', 300):.3f}); the reference has "
         f"{reference['T225_C'][np.flatnonzero(reference['t_min'] == 240)[0]]:.2f} °C at T3"),
        ("After it S_g goes on falling slowly while gas drains",
         f"Mean S_g {Sg[180]:.4f} at 3 h, {Sg[240]:.4f} at 4 h, {Sg[360]:.4f} at 6 h; at the closed end {near(at240, 'S_g', y=L):.4f} at 4 h "
         f"and {near(at360, 'S_g', y=L):.4f} at 6 h. After 4 h {value('gas_out_cm3', 360) - value('gas_out_cm3', 240):.1f} cm³ of gas and "
         f"{value('water_out_cm3', 360) - value('water_out_cm3', 240):.3f} cm³ of water leave"),
        ("Both probes cool fast, then warm slowly to 2.0 °C; T3 lags behind T1",
         f"T1 is least at {least['T75_C'][1]:.0f} min with {least['T75_C'][0]:.3f} °C, T2 at {least['T150_C'][1]:.0f} min with "
         f"{least['T150_C'][0]:.3f}, T3 at {least['T225_C'][1]:.0f} min with {least['T225_C'][0]:.3f}; 1.9 °C is passed at "
         f"{warm['T75_C']:.0f} (T1) and {warm['T225_C']:.0f} min (T3). Agrees"),
        ("Gas, produced and in the pores, at 101.4 kPa and 15.56 °C with 0.6789 kg/m³",
         f"{value('gas_tot_cm3', 360):.1f} cm³ at 6 h; closed form {pores:.1f} + {hydrate:.1f} = {pores + hydrate:.1f}"),
        ("The nonlinear decline of pressure reflects the permeability's change with dissociation",
         "Partly: k is 0.01 k_0 until S_h < 1e-4, so the decline to 3 h is that of the rate and of k_rg; far-end p_g "
         + ", ".join(f"{p:.3f} at {m} min" for m, p in jump) + " MPa. Without the rise of k at S_h = 0 it is "
         + ", ".join(f"{at_times(flat, 'pg_far_MPa', m)[0]:.3f} at {m} min" for m, _ in jump) + " MPa"),
        ("Small differences from the finite-volume code come from its neglect of p_g - p_w",
         f"The paper's p_c changes little here: far-end p_g is within {100 * pc[0]:.2f} % of the reference with it and {100 * pc[1]:.2f} % "
         "without. Resolving the radius changes gas and temperature more (the first table)"),
    )  # fmt: skip


def page(done, program):
    base = done["60x10"]
    refused = [d for n, d in done.items() if d.refused]
    failed = [(n, d.said.count("refused (")) for n, d in done.items() if "refused (" in d.said]
    return "\n".join([
        *dated.head("Masuda's core", "tests/studies/masuda.py", PAGE),
        "Every number is of a run of [cases/masuda](../../cases/masuda/README.md).",
        "The bars are held by [masuda.py](../../tests/verification/masuda.py) and listed in [verification.md](verification.md).", "",
        "## Against the reference curves", "",
        "Largest differences at every 15 min to 4 h. *Lumped* is the reference's own model of the radius: a core a tenth as thick and a "
        "bath that gives a tenth of the heat, so that a volume gets the same heat and the radius has no say. *No p_c* has p_0 = 10 Pa.", "",
        *against_reference(done),
        "The last two, on 30 x 5 cells, take k_r as (42) is printed; the reference takes the saturations of all pores, and so does the "
        "case.", "",
        "The 1 % of gas and the 0.07 K are thus the radius: the surface is warmer than the mean, the bath gives less heat, and hydrate near "
        "the axis goes last. With the radius lumped the two codes agree to 0.2 % and 0.01 K.", "",
        "## What the paper says in words, and this program", "",
        *table(["section 4.1 of the paper", "60 x 10 cells"], words(done)),
        "## Cells", "",
        "Values at 2 h, differences between neighbours, observed orders; all with fixed steps of 150 s, so that only cells differ.", "",
        "Both ways (axis x radius):", "", *self_convergence(done, [f"fixed {n}" for n in MESHES], list(MESHES)),
        "Along the axis:", "", *self_convergence(done, ALONG, list(ALONG)),
        "Across the radius:", "", *self_convergence(done, ACROSS, list(ACROSS)),
        "## Steps", "",
        "The same with fixed steps on 30 x 4 cells. The jump of the outlet's pressure at t = 0 falls into the first step: "
        "`sdirk2` shows no order once the differences are down to some 1e-6 of the values, and the far-end pressure and T3 then do not "
        "fall at every halving. With the pressure lowered over 30 min gas and hydrate do, at an order between one and two; temperatures, "
        "which differ by microkelvins, show none there either. `euler` is of first order throughout.", "",
        *(line for kind in ("sdirk2", "sdirk2, ramp", "euler")
          for line in (f"`{kind}`:" if "," not in kind else "`sdirk2`, outlet lowered over 30 min:", "", *self_convergence(done, [k for k in STEPS if k[0] == kind],
                                                           [f"{k[1]:g} s" for k in STEPS if k[0] == kind]))),
        "## What a field costs", "",
        "60 x 10 cells to 6 h, default options, one rank; CPU time, as the machine was shared. There is no condition that holds v_s and lets the fluids go, so "
        "the full set holds the skeleton by its stiffness (strain 1e-6).", "",
        *cost(done, program),
        "## Refused steps", "",
        f"The case as it stands: {base.steps} steps, {base.refused} refused, {base.newton} Newton iterations. Of the {len(done)} runs of this "
        f"page {len(refused)} had refused steps, {sum(d.refused for d in refused)} in all, out of {sum(d.steps for d in done.values())} steps. "
        f"Newton's method failed in {sum(k for _, k in failed)} of them"
        + (" (" + "; ".join(f"{n if isinstance(n, str) else ' '.join(map(str, n))}: {k}" for n, k in failed) + ")" if failed else "")
        + "; the others were refused by the error estimate, in the first steps, where the outlet's pressure jumps. "
        "Newton's hard spot is the end of dissociation: k rises a hundredfold while S_h falls from 1e-4 to 0.", "",
        "The table of sensitivity is in [cases/masuda](../../cases/masuda/README.md).", "",
    ])  # fmt: skip


def put_table(lines):
    text = README.read_text()
    begin, end = "<!-- table written by tests/studies/masuda.py -->\n", "<!-- end of the table -->"
    i, j = text.index(begin) + len(begin), text.index(end)
    README.write_text(text[:i] + "\n" + "\n".join(lines).strip() + "\n\n" + text[j:])


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n", 1)[1])
    parser.add_argument("program", nargs="?", default=str(ROOT / "build" / "clathra"))
    parser.add_argument("--fresh", action="store_true")
    parser.add_argument("--jobs", type=int, default=2)
    given = parser.parse_args()
    program = Path(given.program).resolve()
    FOLDER.mkdir(parents=True, exist_ok=True)
    sensitive = {n: mesh(30, 5) + o for n, o in SENSITIVITY}
    groups = (("", ADAPTIVE), ("fixed ", MESHES), ("", ALONG), ("", ACROSS), ("", STEPS), ("", sensitive))
    todo = {(head + n if isinstance(n, str) else n): o for head, group in groups for n, o in group.items()}
    timed = [n for n in todo if n in ("60x10", "60x10, thmc")]
    name = lambda n: n if isinstance(n, str) else " ".join(map(str, n))
    done = {n: run(program, name(n), todo[n], given.fresh) for n in timed}  # one at a time
    with ThreadPoolExecutor(given.jobs) as pool:
        rest = [n for n in sorted(todo, key=lambda n: "120x20" not in name(n)) if n not in done]
        done.update(zip(rest, pool.map(lambda n: run(program, name(n), todo[n], given.fresh), rest)))
    dated.measured(PAGE)
    PAGE.write_text(page(done, program))
    put_table(sensitivity(done))
    print(f"{PAGE}, {README}")


if __name__ == "__main__":
    main()
