#!/usr/bin/python3
"""The page of the slopes: slopes.py run PROGRAM FOLDER [NAME...], slopes.py add NAME FOLDER [UNTIL], slopes.py page

`run` makes the runs of the page that are named (all of them: some hours of a core) in FOLDER/NAME and adds each; `add` measures a run (scripts/slide.py; as if it had ended at UNTIL s) and keeps what
the page needs as docs/studies/slopes.json[NAME]; `page` writes docs/studies/slopes.md from that file alone.  NAME is one of ROWS.
"""
import json
import re
import shlex
import sys
from pathlib import Path

import numpy as np

import clathra
import dated
import slide
from clathra.units import YEAR

ROOT = Path(__file__).resolve().parents[1]
KEPT, PAGE = ROOT / "docs" / "studies" / "slopes.json", ROOT / "docs" / "studies" / "slopes.md"
POINTS = {"A": (165, 1), "B": (113, 53)}  # m, probes of cases/slope_a
SERIES = {"T": "T", "eps_d_p": "eps_d_p", "log_J": "log_J", "p": "p", "S_h": "S_h", "m_h": "mass_hydrate"}

PRINTED = "-mat_sand_kinetics_K0 '3.6e4 mol/(m^2 Pa s)'"
COLD = "-mat_sand_plasticity_heat 0"
LENGTH = "-mat_sand_plasticity_softening_length 4m"
NONLOCAL = "-mat_sand_plasticity_nonlocal_length 8m"
SHORT = "-stage_slide_end 40s"
LONG = "-stage_slide_end 250s"
CELLS_2, CELLS_3, CELLS_8 = "-grid_cells 300,60", "-grid_cells 200,40", "-grid_cells 75,15"
LONG_8 = "-grid_cells 450,20"
# On cells of 2 m the nodes of a second row at the temperature that is halfway up a heated cell of 4 m.
LAYER = ("-regions slope,heated,above -region_above_lower 150m,2m -region_above_upper 300m,2.5m -region_above_material none -boundaries base,back,heat,warm"
         " -bc_warm_type region_temperature -bc_warm_region above -bc_warm_temperature 6.15degC -stage_load_boundaries_off heat,warm")  # fmt: skip
IMPLICIT_STEPS = "-stepper_type sdirk2 -stepper_tol 1e-2"
PASSES = "-stepper_storage_passes 12"
PENALTY = "-stabilisation_ghost_penalty 1e-2"
NINE = "-region_slope_particles_per_cell 3,3"
CELLS_16 = "-grid_cells 225,10"
STEP_OF_HYBRID = 1.4e-3  # s of a core that a step of hybrid takes in cases/slope_warming, mean of 1.3e5
LOOKS = (30, 50, 100, 150)  # years of warming at which hydrate is looked at
# a line of summary.txt: stage, integrator, begin (s), steps, refused, processor time (s)
PHASE = r"^  stage (\w+): (\w+) from ([\d.e+]+) s .*?, (\d+) steps, (\d+) refused, .*?Newton iterations, ([\d.]+) s,"
WEAK = "-stage_warm_materials slope,weak"
# name: (case, what the row is called, options).  The order is that of the page.
ROWS = {
    "A": ("a", "θ = 0.5", ""),
    "A_250": ("a", "the same to 250 s", LONG),
    "A_theta_0": ("a", "θ = 0", COLD),
    "A_printed": ("a", "K_0 = 3.6e4, as printed", f"{PRINTED} {LONG}"),
    "A_half": ("a", "half the step (cfl 0.4)", f"-stepper_cfl 0.4 {SHORT}"),
    "A_ranks": ("a", "2 ranks", SHORT),
    "A_ppc9": ("a", "3 x 3 particles", f"{NINE} {SHORT}"),
    "A_ppc9_nl": ("a", "3 x 3 particles, nonlocal_length 8 m", f"{NINE} {NONLOCAL} {SHORT}"),
    "A_3m": ("a", "cells of 3 m", f"{CELLS_3} {SHORT}"),
    "A_2m": ("a", "cells of 2 m", f"{CELLS_2} {SHORT}"),
    "A_8m": ("a", "cells of 8 m", f"{CELLS_8} {SHORT}"),
    "A_3m_length": ("a", "cells of 3 m, softening_length 4 m", f"{CELLS_3} {LENGTH} {SHORT}"),
    "A_length": ("a", "cells of 2 m, softening_length 4 m", f"{CELLS_2} {LENGTH} {SHORT}"),
    "A_nl4": ("a", "nonlocal_length 8 m", f"{NONLOCAL} {SHORT}"),
    "A_nl3": ("a", "cells of 3 m, nonlocal_length 8 m", f"{CELLS_3} {NONLOCAL} {SHORT}"),
    "A_nl2": ("a", "cells of 2 m, nonlocal_length 8 m", f"{CELLS_2} {NONLOCAL} {SHORT}"),
    "A_2m_layer": ("a", "cells of 2 m, heated layer of 4 m", f"{CELLS_2} {LAYER} {SHORT}"),
    "A_2m_layer_length": ("a", "the same, softening_length 4 m", f"{CELLS_2} {LAYER} {LENGTH} {SHORT}"),
    "A_2m_layer_nl": ("a", "the same, nonlocal_length 8 m", f"{CELLS_2} {LAYER} {NONLOCAL} {SHORT}"),
    "A8_sdirk2": ("a", "cells of 8 m, sdirk2", f"{CELLS_8} {IMPLICIT_STEPS} {SHORT}"),
    "A8_sdirk2_half": ("a", "cells of 8 m, sdirk2, steps of 0.05 s", f"{CELLS_8} {IMPLICIT_STEPS} {SHORT} -stepper_dt_max 0.05s"),
    "A8_sdirk2_penalty": ("a", "cells of 8 m, sdirk2, ghost_penalty 1e-2", f"{CELLS_8} {IMPLICIT_STEPS} {SHORT} {PENALTY}"),
    "A_sdirk2": ("a", "sdirk2", f"{IMPLICIT_STEPS} {SHORT}"),
    "A8_passes": ("a", "cells of 8 m, storage_passes 12", f"{CELLS_8} {PASSES} {SHORT}"),
    "A_passes": ("a", "storage_passes 12", f"{PASSES} {SHORT}"),
    "A_particles": ("a", "the paper's bare form", f"-stepper_type hybrid_paper {SHORT}"),
    "B": ("b", "θ = 0.5", ""),
    "B_theta_0": ("b", "θ = 0", COLD),
    "B8": ("b", "cells of 8 m, θ = 0.5", LONG_8),
    "B8_250": ("b", "cells of 8 m, θ = 0.5, to 250 s", f"{LONG_8} {LONG}"),
    "B8_theta_0": ("b", "cells of 8 m, θ = 0", f"{LONG_8} {COLD}"),
    "B8_printed": ("b", "cells of 8 m, K_0 = 3.6e4, as printed", f"{LONG_8} {PRINTED}"),
    "B16": ("b", "cells of 16 m, θ = 0.5", CELLS_16),
    "B16_passes": ("b", "cells of 16 m, storage_passes 12", f"{CELLS_16} {PASSES}"),
    "B16_sdirk2": ("b", "cells of 16 m, sdirk2", f"{CELLS_16} {IMPLICIT_STEPS}"),
    "C": ("c", "θ = 0.5", ""),
    "C_250": ("c", "the same to 250 s", LONG),
    "C_theta_0": ("c", "θ = 0", COLD),
    "C8": ("c", "cells of 8 m, θ = 0.5", LONG_8),
    "C8_250": ("c", "cells of 8 m, θ = 0.5, to 250 s", f"{LONG_8} {LONG}"),
    "C8_theta_0": ("c", "cells of 8 m, θ = 0", f"{LONG_8} {COLD}"),
    "C16": ("c", "cells of 16 m, θ = 0.5", CELLS_16),
    "C16_passes": ("c", "cells of 16 m, storage_passes 12", f"{CELLS_16} {PASSES}"),
    "C16_sdirk2": ("c", "cells of 16 m, sdirk2", f"{CELLS_16} {IMPLICIT_STEPS}"),
    "C16_sdirk2_penalty": ("c", "cells of 16 m, sdirk2, ghost_penalty 1e-2", f"{CELLS_16} {IMPLICIT_STEPS} {PENALTY}"),
    "W": ("warming", "1e-16 m² (the case)", ""),
    "W_falls": ("warming", "the same, and the sea falls by 20 m", "-ambient_level '{ramp: [461.5 m, 441.5 m, 20 a, 120 a]}'"),
    "W_k15": ("warming", "1e-15 m²", "-mat_sand_permeability_k0 1e-15m^2"),
    "W_k14": ("warming", "1e-14 m²", "-mat_sand_permeability_k0 1e-14m^2"),
    "W_15": ("warming", "15°", f"{WEAK} -mat_weak_plasticity_friction_peak 15deg"),
    "W_12": ("warming", "12° (the case)", WEAK),
}


def run(program, folder, *names):
    """Makes and adds the runs that are named; one that stops is added as far as it came."""
    for name in names or ROWS:
        case, _, options = ROWS[name]
        out = Path(folder) / name
        job = clathra.Case(ROOT / "cases" / f"slope_{case}", program).start(out, 2 if name == "A_ranks" else 1, (*shlex.split(options), "-overwrite"))
        if job.end() not in (0, 3, 4):
            sys.exit(f"{name}: {job.sentence()}")
        add(name, out, processor_s=job.usage.ru_utime)


def add(name, folder, until=None, processor_s=None):
    slid = slide.Run(folder, across=3 if NINE in ROWS[name][2] else 2, until=until and float(until))
    m, bands = slide.measure(slid), slide.bands(slid)
    if until is None:
        slide.write(slid, m, bands)
    m["bands"] = bands
    m["took"], m["processor_s"] = f"{int(slid.balance['step'][-1])} steps" if until else took_of(folder), processor_s
    m |= {"warming": warming(slid, folder)} if ROWS[name][0] == "warming" else curves(slid, name)
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    kept[name] = m
    KEPT.write_text(json.dumps(kept, separators=(",", ":"), sort_keys=True).replace('},"', '},\n"') + "\n")
    dated.measured(KEPT)


def curves(slid, name):
    """What the page needs of a slide of seconds: its balance of energy, series of every second, and of the row A histories at points."""
    t = slid.balance["time_s"]
    every = np.unique(np.searchsorted(t, np.arange(0, t[-1], 1.0)))
    found = {"balance": closing(slid.balance),
             "series": {"t": short(t[every]), "E_k": short(slid.balance["kinetic_energy_J"][every]), "hydrate_kg": short(slid.balance["hydrate_kg"][every], 9), "shown": short(slid.time),
                        "failed": short([100 * p["volume"][slid.failed(p), 0].sum() / p["volume"].sum() for _, p in slid.snapshots])}}  # fmt: skip
    if name == "A":
        index = {point: int(np.argmin(np.hypot(*(slid.start - place).T))) for point, place in POINTS.items()}
        found |= {"snapshots": short(slid.time), "points": {point: {k: short(slid.rows(v)[:, i], 6) for k, v in SERIES.items()} for point, i in index.items()}}
    return found


def short(values, digits=5):
    return [float(f"{v:.{digits}g}") for v in values]


def took_of(folder):
    """Steps and seconds of the summary's line `integrator by stage, N steps, N refused, N Newton iterations, X s`."""
    found = re.search(r"(\d+) steps, (\d+) refused, \d+ Newton iterations, ([\d.]+) s", (Path(folder) / "summary.txt").read_text())
    return f"{found[1]} steps, {found[2]} refused" if found else ""


def closing(balance):
    """Largest errors of the conserved quantities, and the balance of energy at the end (J)."""
    errors = {k: float(abs(v).max()) for k, v in balance.items() if k.endswith("_error")}
    return errors | {k: float(balance[k][-1]) for k, _ in ENERGY}


ENERGY = (("gravity_work_J", "gravity"), ("load_work_J", "sea's pressure"), ("pressure_work_J", "pore fluids"), ("kinetic_energy_J", "kinetic"), ("elastic_energy_J", "elastic"),
          ("elastic_released_J", "released with hydrate"), ("plastic_work_J", "plastic"), ("drag_work_J", "drag"), ("damping_work_J", "ghost penalty"), ("kinetic_lost_J", "lost between particles and nodes"), ("energy_remainder_J", "left over"))  # fmt: skip


# ---------------------------------------------------------------- page
def energy(kept):
    """Balance of energy of every run that kept it, at its end, MJ per metre."""
    rows = [("run", *(word for _, word in ENERGY), "left over, of gravity's work")]
    for name, (case, label, _) in ROWS.items():
        if name in kept and "energy_remainder_J" in kept[name].get("balance", ()):
            m = kept[name]
            b = {"damping_work_J": 0.0} | m["balance"]
            rows.append((f"{case.upper()}: {label}, {m['end_s']:.0f} s", *(f"{b[k] / 1e6:.4g}" for k, _ in ENERGY), f"{100 * abs(b['energy_remainder_J'] / b['gravity_work_J']):.2g} %"))
    return ["## Balance of energy", "", "MJ per metre: works of the first three, and where they went. All close to less than 1 % of the work of gravity, B and C by `hybrid` on cells of 16 m to 1.4 %.", "",
            *table(rows)]  # fmt: skip


def tall(m):
    """Bands through at least 0.6 of the height of the slope (100 m)."""
    return [b for b in m["bands"] if b["y_high_m"] - b["y_low_m"] >= 60]


def band_words(m):
    """Times and angles of the tall bands, and how many others there are."""
    words = "; ".join(f"{b['time_s']:.0f} s {b['angle_deg']:.0f}°" for b in tall(m)) or "none"
    others = len(m["bands"]) - len(tall(m))
    return words + (f"; {others} shorter" if others else "")


def seconds(s):
    return "–" if s is None else f"{s:.1f}"


def row(label, m):
    return (label, seconds(m["onset_s"]), f"{m['peak_kinetic_energy_J']:.3g} at {m['peak_kinetic_energy_s']:.1f} s",
            ", ".join(f"{t:.0f}" for t in m["peaks_of_kinetic_energy_s"]), f"{m['failed_volume_m2']:.0f} ({100 * m['failed_share']:.0f} %)",
            f"{m['mean_displacement_m']:.1f}", f"{m['runout_m']:.1f}", f"{m['retrogression_m']:.0f}", f"{m['peak_mean_velocity_m_s']:.2f}",
            f"{100 * m['hydrate_lost_share']:.2f}", f"{m['gas_released_kg']:.0f}", band_words(m), f"{m['end_s']:.0f}", m["took"])  # fmt: skip


HEAD = ("run", "onset (s)", "largest E_k (J/m)", "its peaks (s)", "failed (m³/m)", "moved (m)", "runout (m)", "retrogression (m)", "speed (m/s)",
        "hydrate lost (%)", "gas (kg/m)", "bands through 60 % of the height: time, angle", "to t (s)", "took")  # fmt: skip


def runs_of(kept, case):
    return table([HEAD] + [row(label, kept[n]) for n, (of, label, _) in ROWS.items() if of == case and n in kept])


def at(m, point, key, time):
    return float(np.interp(time, m["snapshots"], m["points"][point][key]))


def scenario_a(kept):
    m = kept["A"]
    e, t = np.array(m["series"]["E_k"]), np.array(m["series"]["t"])
    calm = t[(t > m["peak_kinetic_energy_s"]) & (e < 0.01 * e.max())]
    eps_a = np.array(m["points"]["A"]["eps_d_p"])
    rate = np.diff(eps_a) / np.diff(m["snapshots"])
    fastest = m["snapshots"][int(rate.argmax())]
    p0 = m["points"]["A"]["p"][0]
    T_B = np.array(m["points"]["B"]["T"])
    k = int(np.argmax(T_B[np.array(m["snapshots"]) >= 10])) + int(np.argmax(np.array(m["snapshots"]) >= 10))
    yield ("E_k rises sharply at about 13 s", f"at {m['rise_of_kinetic_energy_s']:.1f} s, as heating starts at 10 s", "agrees but for the delay")
    yield ("significant peak at about 25 s", f"{m['peak_kinetic_energy_J']:.2g} J/m at {m['peak_kinetic_energy_s']:.1f} s; a smaller one at 11 s, as pressure rises in the base", "agrees")
    yield ("by 32 s nearly zero", f"below 1 % of the peak from {calm[0]:.0f} s on" if len(calm) else "not by the end", "agrees" if len(calm) and abs(calm[0] - 32) < 3 else "**differs**")
    later = [x for x in m["peaks_of_kinetic_energy_s"] if x > 34]
    yield ("rises again: peaks at 38, 50, 100 s", "peaks at " + ", ".join(f"{x:.0f} s" for x in later) if later else
           f"none: E_k stays below {100 * e[t > 36].max() / e.max():.2g} % of the peak", "agrees" if later else "**differs**, see below")  # fmt: skip
    yield ("a V-shaped band from the base to the ground by 25 s, three parts", near(m, 21.5, 1.0) + ", from (152, 10) m up", "agrees")
    yield ("by 200 s largely ceased", f"since {calm[0]:.0f} s" if len(calm) else "no", "earlier here")
    yield ("point A: 6 °C at once", f"{at(m, 'A', 'T', 11):.1f} °C at 11 s, 1 m above the base", "agrees: the mean of its cell is 6.1 °C")
    yield ("A: hydrate goes fast, p rises sharply", f"S_h {at(m, 'A', 'S_h', 10):.2f} to {at(m, 'A', 'S_h', 20):.2f} by 20 s; p by {(at(m, 'A', 'p', 12) - p0) / 1e6:.1f} MPa in 2 s", "agrees")
    yield ("A: shear strain takes off at 20 s", f"rises from 10 s on, fastest at {fastest:.0f} s", "agrees")
    yield ("A: volumetric strain rises", f"ln J {at(m, 'A', 'log_J', 30):+.2f} at 30 s", "agrees")
    yield ("in the band: dilation, less pore pressure, less hydrate", f"B at 60 s: ln J {at(m, 'B', 'log_J', 60):+.3f}, p {(at(m, 'B', 'p', 60) - p0) / 1e6:+.2f} MPa, S_h {at(m, 'B', 'S_h', 60):.2f}", "agrees")
    yield ("B warms a little before it cools", f"{T_B[k]:.2f} °C at {m['snapshots'][k]:.0f} s, from {at(m, 'B', 'T', 10):.2f}, then {T_B[-1]:.2f} °C", "agrees" if T_B[k] > at(m, "B", "T", 10) + 0.005 else "**differs**")


def section_a(kept):
    lines = ["## Scenario A", "", *runs_of(kept, "a"), ""]
    if "A" in kept:
        lines += table([("the paper says", "here", "")] + list(scenario_a(kept))) + ["", *NOTES_A]
    return lines


def lost(m, time):
    """Hydrate lost until a time, per cent."""
    h = m["series"]["hydrate_kg"]
    return 100 * (1 - np.interp(time, m["series"]["t"], h) / h[0])


def near(m, time, within=5.0):
    """Bands of about a time, in words."""
    found = [b for b in m["bands"] if abs(b["time_s"] - time) <= within]
    return "; ".join(f"{b['time_s']:.0f} s, x = {b['x_low_m']:.0f} to {b['x_high_m']:.0f} m, {b['angle_deg']:.0f}°" for b in found) or "none"


def scenario_b(kept):
    m, cold = kept["B"], kept["B_theta_0"]
    rest = f"; at rest from {kept['B8_250']['at_rest_s']:.0f} s on (8 m)" if kept.get("B8_250", {}).get("at_rest_s") else ""
    s = m["base_sheared_at_its_upper_end_s"]
    yield ("strain along the base reaches the upper end of the heated part by 15 s", "at " + seconds(s) + " s", "agrees" if s and s < 20 else "**differs**")
    yield ("crossing V bands in the middle and lower part by 18 s", f"{near(m, 16.8, 0.6)}; none farther down", "**differs**: at the upper end of the heated base only")
    yield ("a graben at the upper end of the heated base by 45 s, what is below it slides as one block", f"{len(m['bands'])} bands in it by {max(b['time_s'] for b in m['bands']):.0f} s, x = "
           f"{min(b['x_high_m'] for b in m['bands']):.0f} to {max(b['x_high_m'] for b in m['bands']):.0f} m at the ground", "agrees, but comes first, from 16 s on")  # fmt: skip
    yield ("largest E_k, then 45 s, 72 s and later peaks", f"{m['peak_kinetic_energy_J']:.2g} J/m at {m['peak_kinetic_energy_s']:.0f} s{rest}", "**differs**: one peak")
    said, still = at_rest(kept, ("8 m", "B8", "B8_250"))
    yield ("by 250 s ceased, or still going on at a slower pace", said, "agrees: ceased" if still else "goes on")
    yield ("hydrate goes fast from 13 to 35 s", f"{lost(m, 13):.1f} % lost by 13 s, {lost(m, 35):.1f} % by 35 s, {lost(m, 99):.1f} % at the end", "**in part**: as fast until 50 s")
    yield ("... faster with θ = 0.5 than with 0, and the gap widens later", f"{lost(m, 35) - lost(m, 13):.2f} against {lost(cold, 35) - lost(cold, 13):.2f} % from 13 to 35 s; {lost(m, 99):.1f} against {lost(cold, 99):.1f} % at the end", "agrees")
    yield ("with θ = 0 a shorter way", f"front {cold['runout_m']:.0f} against {m['runout_m']:.0f} m, what failed {cold['mean_displacement_m']:.0f} against {m['mean_displacement_m']:.0f} m", "agrees")
    yield ("... and a graben less developed", f"{len(cold['bands'])} against {len(m['bands'])} bands, out to x = {max(b['x_high_m'] for b in cold['bands']):.0f} against {max(b['x_high_m'] for b in m['bands']):.0f} m", "agrees: its outer half does not form")


def at_rest(kept, *names):
    """What happens between the ends of two runs of one slide, in words, and whether it has come to rest: (100 s, 250 s) of each mesh."""
    said, still = [], True
    for mesh, short_run, long_run in names:
        if long_run in kept and kept[long_run]["end_s"] > 249:
            a, b = kept[short_run], kept[long_run]
            late = sum(band["time_s"] > a["end_s"] for band in b["bands"])
            rest = f"at rest from {b['at_rest_s']:.0f} s on" if b.get("at_rest_s") else "not at rest"
            said.append(f"{mesh}: {rest}; what failed moves by {b['mean_displacement_m'] - a['mean_displacement_m']:.1f} m from {a['end_s']:.0f} to {b['end_s']:.0f} s, with {b['mean_velocity_at_end_m_s']:.1g} m/s at the end; "
                        f"front {a['runout_m']:.0f} to {b['runout_m']:.0f} m, {late} bands after {a['end_s']:.0f} s")  # fmt: skip
            still &= b["mean_velocity_at_end_m_s"] < 0.01 * b["peak_mean_velocity_m_s"]
    return "; ".join(said) or "not run", bool(said) and still


def scenario_c(kept):
    m = kept["C"]
    tops = [b["angle_deg"] for b in tall(m)]
    yield ("first band near the front at 17 s", near(m, 19, 1), "agrees but for 2 s; here a V")
    yield ("second and third V at 30 s, at the top and in the middle, two grabens", near(m, 27, 1), "at the top at 27 s; none in the middle")
    yield ("sub-bands in the grabens at 41 s", near(m, 41, 4), "agrees")
    yield ("fourth and fifth at 56 to 60 s", near(m, 54, 6), "at 50 and 57 to 59 s; they follow each other from the head of the slide down")
    yield ("last one at 77 s", near(m, 85, 5), "at 89 s")
    yield ("angles of 47 to 51°", f"bands through 60 % of the height: {min(tops):.0f} to {max(tops):.0f}°, mean {np.mean(tops):.0f}°", "four of seven of 49 to 53°, the last three 56 to 59°")
    short = [b for b in m["bands"] if 55 < b["y_high_m"] - b["y_low_m"] < 60 and b["time_s"] > 77]
    yield ("seven bands", f"{len(tall(m))} through 60 % of the height, {len(m['bands'])} in all" + "".join(f"; one of {b['y_high_m'] - b['y_low_m']:.0f} m at {b['time_s']:.0f} s, {b['angle_deg']:.0f}°" for b in short), "agrees")
    yield ("runout 600 m", f"{m['runout_m']:.0f} m at {m['end_s']:.0f} s", "**farther**")
    yield ("one very high peak of E_k, higher than in B", f"{m['peak_kinetic_energy_J']:.2g} J/m at {m['peak_kinetic_energy_s']:.0f} s" + f"; B {kept['B']['peak_kinetic_energy_J']:.2g}", "one peak, but **lower** than in B")
    yield ("R_k peaks as bands form", "peaks of R_k at " + ", ".join(f"{t:.0f}" for t in m["peaks_of_R_k_s"]) + " s", "some; many more than bands")
    both = lambda form: "; ".join(f"{mesh}: {form(kept[warm])} against {form(kept[cold])}" for mesh, warm, cold in (("4 m", "C", "C_theta_0"), ("8 m", "C8", "C8_theta_0")))
    yield ("with θ = 0.5 larger E_k, that falls more slowly", both(lambda m: f"{m['peak_kinetic_energy_J']:.3g}") + " J/m; " + both(lambda m: f"{100 * np.interp(80, m['series']['t'], m['series']['E_k']) / m['peak_kinetic_energy_J']:.0f}") + " % of it at 80 s", C_SAYS[0])
    yield ("... and farther", both(lambda m: f"{m['mean_displacement_m']:.0f}") + " m moved in the mean; " + both(lambda m: f"{m['runout_m']:.0f}") + " m runout", C_SAYS[1])
    yield ("... seven bands against six", both(lambda m: f"{len(tall(m))}") + " tall bands; " + both(lambda m: f"{len(m['bands'])}") + " in all", C_SAYS[2])
    yield ("... and more hydrate lost", both(lambda m: f"{100 * m['hydrate_lost_share']:.1f}") + " %", C_SAYS[3])
    said, still = at_rest(kept, ("8 m", "C8", "C8_250"), ("4 m", "C", "C_250"))
    yield ("by 250 s largely come to a halt", said, "agrees" if still else "**differs**")


C_SAYS = ("agrees", "agrees", "agrees; on 4 m all of them are as many", "agrees")


IMPLICIT = (  # what they are called, when they are looked at (s), runs and their integrator with its ghost penalty
    ("A, cells of 8 m", (11, 12, 14, 16, 20, 25, 30, 40), {"A_8m": "`hybrid`", "A8_passes": "12 passes", "A8_sdirk2": "`sdirk2`", "A8_sdirk2_penalty": "ghost_penalty 1e-2"}),
    ("A, cells of 4 m", (11, 12, 14, 16, 18, 20, 22, 25, 27, 30, 40), {"A": "`hybrid`", "A_passes": "12 passes", "A_particles": "by particles", "A_sdirk2": "`sdirk2`"}),
    ("B, cells of 16 m", (12, 15, 20, 30, 40, 50, 60, 80, 100), {"B16": "`hybrid`", "B16_passes": "12 passes", "B16_sdirk2": "`sdirk2`"}),
    ("C, cells of 16 m", (12, 15, 20, 30, 40, 50, 60, 80, 100), {"C16": "`hybrid`", "C16_passes": "12 passes", "C16_sdirk2": "`sdirk2`", "C16_sdirk2_penalty": "ghost_penalty 1e-2"}),
)


def looked_at(m, t):
    """E_k (J/m), failed share and hydrate lost (%) at a time, in words; nothing after the run's end."""
    if t > m["end_s"] + 0.5:
        return ("–",) * 3
    e, failed = (np.interp(t, m["series"][at], m["series"][key]) for at, key in (("t", "E_k"), ("shown", "failed")))
    return f"{e:.3g}", f"{failed:.1f}", f"{lost(m, t):.2f}"


def implicit(kept):
    """sdirk2 against hybrid on the same mesh."""
    lines, shown = ["", "## By implicit steps", ""], [(label, looks, {n: k for n, k in runs.items() if n in kept}) for label, looks, runs in IMPLICIT]
    shown = [entry for entry in shown if len(entry[2]) > 1]
    for label, looks, runs in shown:
        head = [f"{what}, {kind}" if not k else kind for what in ("E_k (J/m)", "failed (%)", "hydrate lost (%)") for k, kind in enumerate(runs.values())]
        rows = [(f"{label}: t (s)", *head)]
        for t in looks:
            rows.append((f"{t:g}", *(v for values in zip(*(looked_at(kept[n], t) for n in runs)) for v in values)))
        lines += [*table(rows), ""]
    rows = [("", "onset (s)", "moved (m)", "runout (m)", "bands", "ghost penalty took, of gravity's work", "took")]
    for label, _, runs in shown:
        for m, kind in ((kept[n], kind) for n, kind in runs.items()):
            rows.append((f"{label}, {kind}", seconds(m["onset_s"]), f"{m['mean_displacement_m']:.1f}", f"{m['runout_m']:.1f}", len(m["bands"]),
                         f"{100 * m['balance'].get('damping_work_J', 0) / m['balance']['gravity_work_J']:.1f} %", m["took"]))  # fmt: skip
    return lines + [*table(rows), ""] + NOTES_IMPLICIT


def section(kept, title, statements, notes):
    return ["", f"## Scenario {title}", "", *runs_of(kept, title.lower()), "", *table([("the paper says", "here", "")] + list(statements(kept))), "", *notes]


def warming(run, folder):
    """What the page needs of a run of cases/slope_warming besides the measures of its slides.  run: slide.Run of the folder."""
    b, warm = run.balance, run.balance["time_s"] > run.loaded * (1 + 1e-9)
    implicit = b["newton"] > 0
    summary, log = ((Path(folder) / name).read_text() for name in ("summary.txt", "log.txt"))
    phases = [p for p in re.findall(PHASE, summary, re.M) if float(p[2]) < b["time_s"][-1]]  # begun within what is looked at
    count = lambda k, stages, kinds: sum(int(p[k]) for p in phases if p[0] in stages and p[1] in kinds)
    forecast = re.findall(r"stage warm: forecast: hybrid (\S+) steps, ([^;]+);", log)
    return {
        "steps": count(3, ("settle", "warm"), ("euler", "sdirk2")), "refused": count(4, ("settle", "warm"), ("euler", "sdirk2")),
        "warm_steps": count(3, ("warm",), ("sdirk2",)), "warm_refused": count(4, ("warm",), ("sdirk2",)), "settle_steps": count(3, ("settle",), ("euler",)),
        "hybrid_steps": count(3, ("warm",), ("hybrid",)),
        "median_step_days": float(np.median(b["dt_s"][warm & implicit]) / 86400),
        "hydrate_left": [float(np.interp(run.loaded + y * YEAR, b["time_s"], b["hydrate_kg"]) / b["hydrate_kg"][0]) for y in LOOKS],
        "processor_s": round(sum(float(p[5]) for p in phases)),
        "least_p_c_Pa": float((run.end["p_g"] - run.end["p_w"]).min()),
        "largest_plastic_strain": float(run.end["eps_d_p"].max()),
        "implicit_kinetic_energy_J": float(b["kinetic_energy_J"][warm & implicit].max()),
        "errors": {k: float(abs(b[f"{k}_error"]).max()) for k in ("water", "methane", "heat")},
        "loaded_s": run.loaded,
        "hybrid_alone": list(forecast[0]),
    }  # fmt: skip


def percent(shares):
    return ", ".join(f"{100 * s:.0f}" for s in shares) + " %"


def table(rows):
    return ["| " + " | ".join(map(str, rows[0])) + " |", "|" + "---|" * len(rows[0])] + ["| " + " | ".join(map(str, r)) + " |" for r in rows[1:]]


def ground(kept, names):
    """Rows of runs that hold: what is left of the hydrate, steps, and how far they move."""
    rows = [("k_0", "hydrate left after 30, 50, 100, 150 years", "implicit steps of the warming (refused), median", "failed (m³/m)", "largest movement", "least p_g - p_w at the end")]
    for m, w, label in ((kept[n], kept[n]["warming"], ROWS[n][1]) for n in names if n in kept):
        rows.append((label, percent(w["hydrate_left"]), f"{w['warm_steps']} ({w['warm_refused']}), {w['median_step_days']:.0f} days", f"{m['failed_volume_m2']:.0f}",
                     f"{m['largest_displacement_m']:.2f} m", f"{w['least_p_c_Pa'] / 1e6:.2f} MPa"))  # fmt: skip
    return table(rows)


def slides(kept, names):
    """Rows of weak ground: every phase that hybrid carried."""
    rows = [("friction at peak", "years of warming: how long, E_k and speed at most, way of the face", "implicit steps (refused)", "of `hybrid`", "E_k that implicit steps see", "failed (m³/m)", "hydrate left", "water, methane, heat closed to")]
    for m, w, label in ((kept[n], kept[n]["warming"], ROWS[n][1]) for n in names if n in kept):
        said = "<br>".join(f"{(s['from_s'] - w['loaded_s']) / YEAR:.1f}: {float(format(s['lasts_s'], '.2g')):g} s, {s['kinetic_energy_J'] / 1e6:.2g} MJ/m, {s['velocity_m_s']:.2g} m/s, {s['probes_m']['face']:.1f} m" for s in m["slides"])
        rows.append((label, said or "holds", f"{w['steps']} ({w['refused']})", w["hybrid_steps"], f"{w['implicit_kinetic_energy_J']:.2g} J/m", f"{m['failed_volume_m2']:.0f}", f"{100 * w['hydrate_left'][-1]:.0f} %",
                     ", ".join(f"{w['errors'][k]:.0e}" for k in ("water", "methane", "heat"))))  # fmt: skip
    return table(rows)


def section_warming(kept):
    """The section of the page on cases/slope_warming: a sea that warms over decades, and slides of seconds in it."""
    forecast = kept["W"]["warming"]["hybrid_alone"]
    return [*BEFORE_WARMING, *ground(kept, ("W", "W_falls", "W_k15", "W_k14")), *GROUND_WARMING.format(steps=forecast[0], alone=float(forecast[0]) * STEP_OF_HYBRID / YEAR, per=1e3 * STEP_OF_HYBRID).split("\n"), *slides(kept, ("W_15", "W_12")), *AFTER_WARMING]


NOTES_IMPLICIT = """- *All three go through* (`-stepper_type sdirk2 -stepper_tol 1e-2`), in steps of 0.1 s, those of the probes, B in steps of 0.05 s while it tears, with 4 to 7 Newton iterations, B and C with blocks that tear loose and slide for hundreds of metres.
- *B* on 16 m comes to rest from 77 s on (`hybrid` 70, with 12 passes 72), on a grid 240 m longer, for its front passes the 2000 m of the case: 927 m runout and 710 m moved where `hybrid` has 855 and 682, with 12 passes 853 and 672. The largest E_k is 40.3 GJ/m at 39 s (44.3 and 42.7 at 39 and 40 s); from 30 to 50 s it is within 6 % of 12 passes,
  at 15 s 24 % and at 60 s 47 % more, the hydrate lost at most 7 % less, and 0.11 % of gravity's work is left over (1.4 %).
- *The ghost penalty holds them back.* (22) resists each step's motion where the surface cuts cells, also that of two pieces beside a tear. With 1e-3, which these cases have, it takes 3 and 4 % of gravity's work in B and C. `hybrid` has no (22). The default, 0.1, is for bodies that stay whole ([a blow between two bars](../../tests/verification/meeting.py): it takes 90 % of the energy, 1e-3 takes 3 %).
- *C*: the largest E_k is 8.4 GJ/m at 58.5 s, 435 m moved, runout 748 m, 12.9 % of the hydrate lost; `hybrid` with 12 passes 8.2 at 59.5 s, 420 m, 727 m, 13.1 %, as it is 10.4 at 55.3 s, 462 m, 833 m, 14.9 %.
- *A: lumped storage in `hybrid`*, (37): the heated row is at the apex of the yield surface from 11 s on (no shear stress is left by 14 s), the block floats on it, and what holds it are suction and tension where it tears from the slope above: E_k is a hundredth of gravity's work, a small difference of large works, and what pressure is lost to the cells beside counts.
  What a particle's fluids take up is spread over three cells, so a sealed row of one cell loses pressure to its neighbours and its bands lose suction: methane in other particles than at 10 s is 27 % of what the heated row has freed by 14 s (8 m; nothing may move at 1e-14 m² in 4 s).
  With `storage_passes`, (413), `hybrid` has the storage of implicit steps; then E_k on 4 m is 10.1, 8.1, 6.4 MJ/m at 25 s with 1, 3, 12 passes, and the way above the heated row 8.0, 7.1, 6.5 m: the same slide, 3 s later, with its peak of 12.1 MJ/m at 24.9 s with lumped storage and 9.7 at 28.2 s with 12 passes.
  In the paper's bare form no fluid leaves its particle: 5.5 MJ/m at 30.8 s, 10.6 m. The body is sealed for these seconds, so this is the physics, with pressures that ring; lumped storage is the farthest from it. 25 s of the paper are met by lumped storage with ten times the printed rate, and none of them is converged in the mesh.
- *On 4 m* `sdirk2` is between the two: its largest E_k is 10.7 MJ/m at 27.6 s, it moves 12.9 m, and two bands go through 60 % of the height at 23 s (51°) and 24 s (61°), in 427 steps.
- *On 8 m* `sdirk2` moves 5.0 m, `hybrid` with 12 passes 5.2, as it is 5.5; the hydrate lost is within 2 % of 12 passes, E_k 28 % more at 14 s, 2 % less at 20 s. What is left between them has no name yet.""".split("\n")
NOTES_B = """- To 100 s without a step refused: gas that expands in what tears loses shares of its pressure, not pascals ((151) of [equations.md](../equations.md)). With increments of p_g
  shared among particles a single one reached zero pressure at 27 s and the run gave up.
- *The step* falls from 6.2 to 2 ms as particles in the tears become thin; bounds by waves in thin domains set it 99.4 % of the time. With (374), by which domains act with at least a twentieth of a cell, 4 m take 48,289 steps to 100 s (70,241 to 49 s before).
- *What is left of E_k* after the slide, 1 to 3 % of its peak, is in particles of what tore that swing against each other: a motion that the grid does not see (FLIP). At 100 s on 8 m it is 1.4e9 J/m, of which the nodes
  have 2e4: single particles at up to 39 m/s where nodes move by 4 cm/s. It moves nothing, as in A.
- On cells of 8 m the heated layer is twice as thick as the paper's: 6.7 instead of 5.0 % of the hydrate goes, and the front comes 837 instead of 699 m far; E_k is 13 % lower, and the graben reaches to x = 327 m instead of 277.
- *Bands in the middle* do not come at this rate of the reaction: the block comes off its base within 3 s, everywhere at once (the base is sheared up to 150 m at 14 s), slides as one and is never held back. With K_0 as printed (8 m) the base gives way from the toe
  up over 25 s, what is above it stretches and tears in two at x = 560 to 660 m (bands at 51 to 78 s), E_k is 1.5e10 J/m at 55 s and the front comes 524 m far. So which of the paper's events come, and when, is a matter of that rate, which it does not give without doubt.
- *Ice.* In the tears gas expands, and dissociation cools up to 1,000 particles (4 %) below the melting point, by up to 11 K; ice is not modelled, in the paper neither. The summary says so.

![plastic strain](../figures/case_slope_b.png)

![strain and displacement with and without heat](../figures/slope_b_fields.png)

![energy](../figures/slope_b_energy.png)

![bands](../figures/slope_b_bands.png)

*Pictures of B and C are of cells of 8 m.*""".split("\n")
NOTES_C = """- The statements without a mesh are of the paper's cells of 4 m. On 8 m the heated layer is twice as thick (9.8 instead of 6.9 % of the hydrate lost), bands come within 2 s of the same times at the same places until 30 s, and E_k, way, runout and failed volume differ by 1 to 6 %.
- θ = 0.5 on 4 m took 111,318 steps before (374) instead of 56,451, with E_k of 9.23 instead of 9.40 GJ/m, 472 instead of 487 m moved, a front at 711 instead of 727 m and the same bands within 1 s, the last of them, at 89 s, as the seventh tall one (both as of then); on 8 m (374) took 21,738 steps instead of 26,564, E_k is 0.3 % lower, the way 0.6 % and the runout 1.7 % longer. At 100 s what failed still moves by 1.3 m/s on 4 m and 0.7 m/s on 8 m, which ends within 2 s there.
- The block in the middle stays whole, for 100 s; the paper's breaks into horsts and grabens everywhere.

![plastic strain](../figures/case_slope_c.png)

![temperature, pressure, hydrate and displacement with and without heat](../figures/slope_c_fields.png)

![energy](../figures/slope_c_energy.png)

![bands](../figures/slope_c_bands.png)""".split("\n")
TRUST = """
## Failure against limit equilibrium

A slab of 8 m on a dip of 10°, the layer under it warmed until its hydrate gives gas ([tests/verification/infinite_slope.py](../../tests/verification/infinite_slope.py)). F is the factor of safety of limit equilibrium with the run's own pore pressure and cohesion;
below F = 1 the slab should accelerate by g sin β (1 - F) (Newmark's block). So F = 0.9 is due where it accelerates by a tenth of g sin β; the speed is that at 5 s, 0.8 s after F = 1.

| | cells of 2 m | 4/3 m | 1 m |
|---|---|---|---|
| `hybrid`: F then, error of the speed | 0.923, -3.3 % | 0.912, 0.4 % | 0.899, 1.4 % |
| `sdirk2`, steps of 0.1 s | 0.927, -2.2 % | 0.914, 0.2 % | 0.902, 1.0 % |
| a friction of 15° in the run instead of 25° | 1.28, 52 % | | |

The weak layer is one cell thick on every mesh. In a layer of several cells pressures alternate between the particles of a cell where it is undrained and flows, and the F of a row's mean is up to 0.15 too high:
its weakest particles yield and the others never bear what they could.

## Under water

The water around a body is its pressure (42), and `ambient: {drag: ...}` the drag of its faces (152): no added mass, no friction along a face, no water that flows. With pressure alone a column of ground without friction collapses under water
as it does in air with its buoyant weight, to 0.2 % (`hybrid`) and 0.3 % (`sdirk2`) of the way at E = 5 MPa and a tenth of that at 50 MPa: what is left is the elastic compression by the water. (With its whole weight it is off by 350 %.)
With friction the two differ unless pore water bears the sea's pressure inside ([tests/verification/submerged_column.py](../../tests/verification/submerged_column.py)).
""".split("\n")
BEFORE_WARMING = """
## A sea that warms

[slope_warming](../../cases/slope_warming/README.md): the body of A, the sea warmer by 3 K in 100 years. From hydrate, gas and water at equilibrium everywhere `auto` goes through 170 years in implicit steps of months and, with the paper's strength, the slope holds.

![hydrate under a warming sea](../figures/case_slope_warming.png)

Cells of 8 m; k_0 by `-mat_sand_permeability_k0`, the sea's level as the case's README says. All is nearly elastic. *Cells*: on 16 m 86, 62, 38, 25 % of the hydrate are left after 30, 50, 100, 150 years, on 4 m 78, 70 % after 30 and 50 (62 % after 70, on 8 m 58). On 16 m the front of melting hydrate lies within the
first cell for decades, whose pressure is then half a megapascal above the sea's (a column: 0.54 MPa, on 4 m 0.05), and the ground gives by up to 3.8 m; on 8 m it does not. Beside the sloping floor S_h of neighbouring particles differs by up to 0.2 (8 m), by up to 0.5 on 16 m:
""".split("\n")
GROUND_WARMING = """
`hybrid` alone would take {steps} steps for the same years, {alone:.2g} years of a core at the {per:.2g} ms that a step takes here ([tradeoff](tradeoff.md#a-run-that-changes-its-integrator)).

With 1e-15 m² and more gas rises out of the foot, hydrate that forms there takes the rest, until p_g = p_e, (371) of [equations.md](../equations.md), and the next row with it; the density of gas there is that of a tenth of p_w, (323).

**Ground that fails** (cohesion 300 to 10, residual 5 kPa, friction to 10°, the dip of the slope, no dilation, η_s = 20: `-stage_warm_materials slope,weak`). `auto` sees that equilibrium is lost, (356) of [equations.md](../equations.md), goes over
to `hybrid` at the state before the slide, and after it particles lose what `hybrid` left against their nodes (452), so that implicit steps grow again. Every phase that `hybrid` carried; speed is that of the failed mass with all of E_k:
"""
AFTER_WARMING = """
With 12° the face creeps by 0.9 m in 125 years, then loses its equilibrium and slides by 7 m in 24 s; behind it the slump creeps on, by 7 m in the first year and 1.6 m in the last, in implicit steps that grow from 22 s to 70 days and are ruled by Newton's method (75 % of them; 33 iterations a step, where
open tears have no bulk stiffness). With 15° it holds.

*Ground that has no rest.* Up to the state before (427) friction fell to 4° here, less than the slope dips: on this base what is thicker than 5 m slides until it is thinner, over kilometres. The face went by 40 m in 25 s after 110 years (40 MJ/m; the time known to 0.3 years), and slides of a few metres came back up the slope every half to
two years. Newton's method goes round in two states there, which (426) ended. At 133 years, after 22 minutes, neither integrator got on: 696 of 1406 particles were up to 98 m long and 0.4 m thick in cells of 8 m, where each acts as a piece of a cell. Of what lies in a cell together one particle is then torn while another is pressed, by -21 to 0.9 MPa of
mean stress, and the water they share goes to -16 MPa; p_g falls below zero with it. The body has then swelled by 2 % of its volume: it is the shape of its particles that ends it. So
a slide may be carried to rest and on from there where there is a rest; ground that flows for hundreds of metres needs particles that part as they stretch, which are not there.

*Slides that were the grid's doing.* Up to the state before (425) this page had cells of 16 m and a sea in eight pieces of constant temperature: T of particles beside the floor was off by 0.5 K before any hydrate melted, S_h of neighbours by 0.8, the ground crept by 80 m in 130 years, and
grounds of 16, 15 and 14° slid two to six times, after 97 to 150 years, at times that changed with every state of the program. On 16 m with the sea as it is now 15° still slides, and does not come to its end.

Two things made this possible. *Who carries the slide*: before, three implicit steps in a row had to be dearer than `hybrid`, and those of seconds had most of the motion, with a sixth of its energy. *The sea gives no gas* (358): torn ground under the sea, pulled apart faster than water comes in, had taken
gas through its open faces, ten times what it held, swelled until it was lighter than water and rose out of the grid.
With dilation (2° to 0°) the slide of 12.5 m cells took weeks instead of seconds, since suction holds it; `hybrid` from there agreed: 0.3 m in the first seconds, then next to nothing in a minute.

*Sediment without gas* was another matter as long as the water's pressure drove the reaction there and water held a trace of methane alone. A column of six cells is enough to see it: 2 x 2 particles a cell,
100 m of sediment with S_h = 0.4 and no gas (k_0 = 1e-15 m², p_0 = 10 kPa, S_gr = 0.3), the sea's pressure and a temperature that rises by 0.03 K a year on its top. It ends, but refuses 31 of 201 steps, in bursts: whenever
hydrate in one more row of particles begins to go, steps fall from years to hours or minutes. Neither a surface across cells nor small shares of a cell are needed for it:

- Hydrate that becomes water alone takes less room, so as long as a pore has no gas phase, dissociation lowers p_w and drives itself on: 580 Pa per kg in a particle of 100 m³, which for a reaction as fast as this one is 1700 times what it takes to stop
  it. The tangent of a pore without gas therefore has the wrong sign, and Newton's first update lets hydrate form (p_g to -1e10 Pa). The solution lies beyond the kink of (101), where 0.05 kg of hydrate give the gas that holds the pressure.
- From guesses with gas (5 % of the pores) Newton's method does go to that solution, but by one p_trap of p_c an iteration, since s_g is exponential in p_c < 0; and guesses by nodes change the particles of the cell that hold gas already.
- While hydrate could form, it takes what methane water holds: p_g falls to 1.1 MPa below p_w, and next to a particle with gas nodes stand at p_c = +0.3 and -0.9 MPa. Drive by p_g where there is no gas, the methane's own pressure, takes this
  away, and with the trace alone refuses steps from the start; with what water really holds, (352) and (371) of [equations.md](../equations.md), it is how the program now goes past the first gas ([test](../../tests/verification/first_gas.py)).
- The matrix (101) of neighbouring nodes alternates p_g from node to node; lumped, it no longer does, but refused steps are as many.
""".split("\n")
NOT_RUN = """
## What was not run

B and C on 4 m beyond 100 s (on cells of 8 m they have come to rest by 65 and 102 s and stay so to 250 s); B and C by sdirk2 on cells finer than 16 m. On cells of 8 m two and four ranks agree with one to 3e-12 into the slide, and a restart there is bit for bit: [tests/integration/slope.py](../../tests/integration/slope.py).
""".split("\n")
NOTES_A = """- *Later peaks.* The paper's further peaks of E_k, without new bands, are put down to creep as hydrate goes on dissociating. Here the hydrate of the heated row of cells is
  gone by then (point A: all of it by 100 s), the block rests on the stump of the base left of 150 m, and 2 % of all hydrate is lost for good. With K_0 = 3.6e4, the rate as printed, the
  slide comes in many small rushes from 76 s to 138 s instead (largest E_k 0.29 MJ/m at 118 s, 10.8 m moved).
- *The rate of the reaction* decides the time scale. The paper's times (rise, peak at 25 s, rest at 32 s) come out with K_0 = 3.6e5, ten times the printed rate; dE is not legible in it.
- *Point B* has no deviatoric stress from 22 s on: the left band is pulled open and its skeleton is at the apex of the yield surface, while suction (-0.75 MPa) holds it together.
- *To 250 s* nothing comes after the peak at 25 s. Two ranks: E_k to 1e-11 of one at 25 s, what failed 12.7 m both.
- *Meshes.* Onset (11.1 s), failed volume (52 to 53 %) and the V of bands (48 to 51°, 61 to 64°; none on 8 m) stay; how far and how fast it slides does not: E_k of 9.8, 12.1, 20.8, 27.2 MJ/m, 5.5, 12.7, 15.3, 17.8 m on 8, 4, 3, 2 m.
  Softening goes into bands as thin as cells allow, and they weaken the sooner the thinner they are. Regularised it is the other way round: `softening_length: 4 m` 12.1, 4.7, 2.9 MJ/m and 12.7, 7.7, 2.0 m on 4, 3, 2 m, `nonlocal_length: 8 m`
  5.1, 3.9, 2.4 MJ/m and 4.9, 3.2, 1.8 m: what is heated is one cell thick (1.5, 1.0, 0.5 % of the hydrate lost), and strength averaged over more than that hardly falls. With the nodes of two rows of 2 m held at the temperatures that a cell of
  4 m has in between, more heat comes in than on 4 m (2.7 % lost) and 82 MJ/m, 34 m come of it; 14.3 MJ/m, 6.0 m with the softening length, 123 MJ/m, 49 m nonlocally. 3 x 3 particles on 4 m: 6.7 MJ/m, 8.8 m, and 5.7 MJ/m, 3.5 m with `nonlocal_length: 8 m`
  (5.1 and 4.9 with 2 x 2; `softening_length: 4 m` changes nothing on cells of 4 m).
  So **the heat let in rules how far it slides**, and a layer heated at nodes has no limit of fine meshes: the paper's own numbers are those of its mesh.
- *What is left of E_k* at the end, 0.03 MJ/m, is in two particles at the toe that swing against each other: a motion that the grid does not see (FLIP). On 8 m it is 42 of the 43 kJ/m after 40 s; the nodes move with 0.9.
  It moves no particle, for places and strains follow the nodes, and stresses with them; only E_k after a slide is not to be read as motion. With (452), which these rows do not have, particles lose it.

![energy](../figures/slope_a_energy.png)

![points](../figures/slope_a_points.png)

![bands](../figures/slope_a_bands.png)""".split("\n")
SINCE = ("Particles take the volume change of their cells, tears close and velocities are carried to nodes ((88), (427), (451) of [equations.md](../equations.md)). "
         "The first picture of B and those of C have that already. What it changes is said below.")  # fmt: skip
INTRO = """Section 5.2 of the paper, by [slope_a](../../cases/slope_a/README.md){others}, with `hybrid`. `scripts/slopes.py page` makes this page of
`docs/studies/slopes.json`, into which `scripts/slopes.py run` (or `add`, of a run that is there) puts what [scripts/slide.py](../../scripts/slide.py) measures of a run; the options of every row stand in that script. A run without a word on cells has those
of the paper, 4 m with 2 x 2 particles.

The first picture of B and those of C are on cells of 8 m, by the program of 2026-11-30 (commit 1d15f6bb); all else was made before particles took the volume change of their cells, tears closed and velocities were carried to nodes ((88), (427), (451) of [equations.md](../equations.md)): as in the paper's scheme, bilinear motion holds in part what has failed, and ground that is pushed together again is pressed by what it opened. With (88) scenario A begins at the same 11.1 s, but by 25 s what failed has moved 25.1 m in
place of 8.2 m, with 164 in place of 12 MJ/m (cells of 8 m: 24.9 in place of 4.7 m, 127 in place of 10 MJ/m). Rows by `sdirk2` have the ties (351) and (417), which `hybrid` has not; rows of A, B and C were made without (424). Against still earlier states, without methane that goes with all of the water's flux (352)
and hydrate that grows in water (418), E_k, way, runout and hydrate lost are within 0.2 %, but for two rows that are as sensitive as that to anything: A on 2 m with a heated layer of 4 m (34.5 instead of 34.1 m moved) and C on 4 m
(runout 733 instead of 727 m; a seventh band is 60 % of the height long now, with θ = 0 still six).

## What is measured

- *Failed*: what has moved farther than 1 % of the height (1 m) since the loading ended. *Onset*: when 1 % of the body has. *Moved*: mean over what failed.
- *Runout*: how far the front is ahead of the toe at the start, along the base. *Retrogression*: from the crest back to the farthest failed particle of the ground.
- *Speed*: the largest mean velocity of what has failed in the end. *Peaks* of E_k: maxima from which it falls by 2 % of the largest on either side, in means over 2 s.
- *At rest*: from when the mean speed between snapshots of what failed in the end, from places, stays below a hundredth of its largest: velocities of particles hold what no node sees besides.
- *P_k*: the power of the forces on what moves (`kinetic_power_W` of `balance.csv`), in means over 2 s; *R_k*: its slope by linear least squares over 2 s.
- *Bands*: straight strips one cell wide, at every angle in steps of 2 degrees and every half cell, in the configuration at the start and above the heated base. A piece of a strip, one cell long,
  counts where its mean ε_d^p exceeds 0.15 and twice that of the strips two and a half cells to either side; a strip needs a row of such pieces 60 % of the slope's height long (40 % in the
  state at the end), with gaps of two at most. They are looked for every 2 s; the strip with the largest sum of strain is a band, its particles and those within two and a half cells
  are taken out, and so on. A band's time is the median of the times at which its particles pass 0.15; its angle is that of the main axis of their places at that time, weighted with strain, against the base.
- *Gas released*: what the hydrate lost gave, per metre of thickness; all of it stays in the closed body.

The same measures stand at the end of `summary.txt` after `./run slope_a` (`slope_b`, `slope_c`, `slope_warming`), with the probes by name and the list of bands, and above the picture of the energy.
"""


def page():
    kept = json.loads(KEPT.read_text())
    others = "".join(f", [{c}](../../cases/{c}/README.md)" for c in ("slope_b", "slope_c") if (ROOT / "cases" / c).is_dir())
    lines = [*dated.head("Submarine slopes", "scripts/slopes.py", KEPT, since=SINCE), INTRO.format(others=others), *section_a(kept), *section(kept, "B", scenario_b, NOTES_B), *section(kept, "C", scenario_c, NOTES_C), *implicit(kept), "", *energy(kept), *TRUST, *section_warming(kept), *NOT_RUN]
    PAGE.write_text("\n".join(lines).rstrip() + "\n")
    print(PAGE)


if __name__ == "__main__":
    {"run": run, "add": add, "page": page}[sys.argv[1]](*sys.argv[2:])
