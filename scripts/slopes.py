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

PRINTED = "-mat_sand_kinetics_K0 '3.6e4 mol/(m^2 Pa s)'"
COLD = "-mat_sand_plasticity_heat 0"
PAPER = "-stepper_type hybrid_paper"
IMPLICIT_STEPS = "-stepper_type sdirk2 -stepper_tol 1e-2"
SHORT = "-stage_slide_end 40s"
CELLS_2, CELLS_8, LONG_8, CELLS_16 = "-grid_cells 300,60", "-grid_cells 75,15", "-grid_cells 450,20", "-grid_cells 225,10"
STEP_OF_HYBRID = 1.4e-3  # s of a core that a step of hybrid takes in cases/slope_warming, mean of 1.3e5
LOOKS = (30, 50, 100, 150)  # years of warming at which hydrate is looked at
# a line of summary.txt: stage, integrator, begin (s), steps, refused, processor time (s)
PHASE = r"^  stage (\w+): (\w+) from ([\d.e+]+) s .*?, (\d+) steps, (\d+) refused, .*?Newton iterations, ([\d.]+) s,"
WEAK = "-stage_warm_materials slope,weak"
# name: (case, what the row is called, options).  The order is that of the page.
ROWS = {
    "A": ("a", "cells of 4 m (the case)", ""),
    "A_8m": ("a", "cells of 8 m", CELLS_8),
    "A_2m": ("a", "cells of 2 m", f"{CELLS_2} -stage_slide_end 25s"),
    "A_theta_0": ("a", "4 m, θ = 0", COLD),
    "A_printed": ("a", "4 m, K_0 = 3.6e4, as printed", PRINTED),
    "A8_sdirk2": ("a", "8 m, sdirk2", f"{CELLS_8} {IMPLICIT_STEPS} {SHORT}"),
    "A_paper": ("a", "4 m, the paper's scheme", f"{PAPER} {SHORT}"),
    "B8": ("b", "cells of 8 m", LONG_8),
    "B16": ("b", "cells of 16 m", CELLS_16),
    "B8_theta_0": ("b", "8 m, θ = 0", f"{LONG_8} {COLD}"),
    "B8_paper": ("b", "8 m, the paper's scheme", f"{LONG_8} {PAPER}"),
    "C8": ("c", "cells of 8 m", LONG_8),
    "C16": ("c", "cells of 16 m", CELLS_16),
    "C8_theta_0": ("c", "8 m, θ = 0", f"{LONG_8} {COLD}"),
    "C8_paper": ("c", "8 m, the paper's scheme", f"{LONG_8} {PAPER}"),
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
        job = clathra.Case(ROOT / "cases" / f"slope_{case}", program).start(out, 1, (*shlex.split(options), "-overwrite"))
        if job.end() not in (0, 3, 4):
            sys.exit(f"{name}: {job.sentence()}")
        add(name, out, processor_s=job.usage.ru_utime)


def add(name, folder, until=None, processor_s=None):
    slid = slide.Run(folder, until=until and float(until))
    m, bands = slide.measure(slid), slide.bands(slid)
    if until is None:
        slide.write(slid, m, bands)
    m["bands"] = bands
    m["took"], m["processor_s"] = f"{int(slid.balance['step'][-1])} steps" if until else took_of(folder), processor_s
    m |= {"warming": warming(slid, folder)} if ROWS[name][0] == "warming" else curves(slid)
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    kept[name] = m
    KEPT.write_text(json.dumps(kept, separators=(",", ":"), sort_keys=True).replace('},"', '},\n"') + "\n")
    dated.measured(KEPT)


def curves(slid):
    """What the page needs of a slide of seconds: its balance of energy and series of every second."""
    t = slid.balance["time_s"]
    every = np.unique(np.searchsorted(t, np.arange(0, t[-1], 1.0)))
    return {"balance": closing(slid.balance),
             "series": {"t": short(t[every]), "E_k": short(slid.balance["kinetic_energy_J"][every]), "hydrate_kg": short(slid.balance["hydrate_kg"][every], 9), "shown": short(slid.time),
                        "moved": short([np.average(slid.moved(p)[slid.failed(p)], weights=p["volume"][slid.failed(p), 0]) if slid.failed(p).any() else 0.0 for _, p in slid.snapshots]),
                        "failed": short([100 * p["volume"][slid.failed(p), 0].sum() / p["volume"].sum() for _, p in slid.snapshots])}}  # fmt: skip


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
    return ["## Balance of energy", "", "MJ per metre: works of the first three, and where they went.", "",
            *table(rows)]  # fmt: skip


def tall(m):
    """Bands through at least 0.6 of the height of the slope (100 m)."""
    return [b for b in m["bands"] if b["y_high_m"] - b["y_low_m"] >= 60]


def band_words(bands):
    """Times, angles and places at the ground of bands."""
    return "; ".join(f"{b['time_s']:.0f} s {b['angle_deg']:.0f}° at {b['x_high_m']:.0f} m" for b in bands) or "none"


def seconds(s):
    return "–" if s is None else f"{s:.1f} s"


HEAD = ("run", "onset", "largest E_k, MJ/m", "failed, m³/m", "moved by 25 s, m", "... in the end, m", "runout, m", "retrogression, m", "hydrate lost, %", "bands through 60 % of the height", "at rest from", "to t, s", "took")


def row(label, m):
    by_25 = float(np.interp(25.0, m["series"]["shown"], m["series"]["moved"]))
    return (label, seconds(m["onset_s"]), f"{m['peak_kinetic_energy_J'] / 1e6:.3g} at {m['peak_kinetic_energy_s']:.1f} s", f"{m['failed_volume_m2']:.0f} ({100 * m['failed_share']:.0f} %)", f"{by_25:.1f}",
            f"{m['mean_displacement_m']:.1f}", f"{m['runout_m']:.1f}", f"{m['retrogression_m']:.0f}", f"{100 * m['hydrate_lost_share']:.2f}", len(tall(m)), seconds(m.get("at_rest_s")), f"{m['end_s']:.0f}", m["took"])  # fmt: skip


def lost(m, time):
    """Hydrate lost until a time, per cent."""
    h = m["series"]["hydrate_kg"]
    return 100 * (1 - np.interp(time, m["series"]["t"], h) / h[0])


def calm(m):
    """When E_k has fallen below a hundredth of its largest."""
    e, t = np.array(m["series"]["E_k"]), np.array(m["series"]["t"])
    after = t[(t > m["peak_kinetic_energy_s"]) & (e < 0.01 * e.max())]
    return f"from {after[0]:.0f} s on" if len(after) else f"not by {m['end_s']:.0f} s"


def peaks(m):
    return ", ".join(f"{t:.0f}" for t in m["peaks_of_kinetic_energy_s"]) + " s"


def until(m, time):
    return band_words([b for b in m["bands"] if b["time_s"] <= time])


def base(m):
    return f"its base is sheared up to the upper end at {seconds(m['base_sheared_at_its_upper_end_s'])}"


# What the paper says, and what a run says of it.
SAID = {
    "A": (("E_k rises sharply at about 13 s", lambda m: f"at {m['rise_of_kinetic_energy_s']:.1f} s"),
          ("a peak at about 25 s, later ones at 38, 50, 100 s", peaks),
          ("nearly no E_k by 32 s", calm),
          ("a V of bands from the base to the ground by 25 s", lambda m: until(m, 26)),
          ("largely ceased by 200 s", lambda m: f"at rest from {seconds(m['at_rest_s'])} on" if m.get("at_rest_s") else f"not by {m['end_s']:.0f} s")),
    "B": (("strain along the base reaches the upper end of the heated part by 15 s", base),
          ("V bands in the middle and lower part by 18 s", lambda m: until(m, 18)),
          ("a graben at the upper end of the heated base by 45 s", lambda m: until(m, 45)),
          ("largest E_k, then peaks at 45 and 72 s", peaks),
          ("hydrate goes fast from 13 to 35 s", lambda m: f"{lost(m, 13):.1f} % lost by 13 s, {lost(m, 35):.1f} % by 35 s, {lost(m, 99):.1f} % by 99 s")),
    "C": (("bands at 17, 30, 41, 56 to 60 and 77 s", lambda m: band_words(tall(m))),
          ("seven bands of 47 to 51°", lambda m: f"{len(tall(m))} through 60 % of the height, {len(m['bands'])} in all"),
          ("runout 600 m", lambda m: f"{m['runout_m']:.0f} m by {m['end_s']:.0f} s"),
          ("one very high peak of E_k, higher than in B", lambda m: f"{m['peak_kinetic_energy_J'] / 1e9:.2g} GJ/m; peaks at {peaks(m)}"),
          ("largely come to a halt by 250 s", lambda m: f"at rest from {seconds(m['at_rest_s'])} on" if m.get("at_rest_s") else f"not by {m['end_s']:.0f} s")),
}  # fmt: skip
BESIDE = {"A": ("A", "A_paper", "A_theta_0"), "B": ("B8", "B8_paper", "B8_theta_0"), "C": ("C8", "C8_paper", "C8_theta_0")}


def section(kept, title, notes):
    """Every run of a scenario, and what the paper says beside the case, the paper's scheme and the case without heat of plastic flow."""
    names = [n for n in BESIDE[title] if n in kept]
    said = [("the paper says", *("the case" if k == 0 else ROWS[n][1] for k, n in enumerate(names)))] + [(says, *(of(kept[n]) for n in names)) for says, of in SAID[title]]
    rows = [HEAD] + [row(label, kept[n]) for n, (of, label, _) in ROWS.items() if of == title.lower() and n in kept]
    return ["", f"## Scenario {title}", "", *table(rows), "", *table(said), "", *notes]


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


NOTES_A = """The paper's scheme gives up at 49.7 s: domains of torn particles become so thin that its step falls below 1e-8 s.

![energy](../figures/slope_a_energy.png)

![points](../figures/slope_a_points.png)

![bands](../figures/slope_a_bands.png)""".split("\n")
NOTES_B = """![strain and displacement with and without heat](../figures/slope_b_fields.png)

![energy](../figures/slope_b_energy.png)

![bands](../figures/slope_b_bands.png)""".split("\n")
NOTES_C = """![temperature, pressure, hydrate and displacement with and without heat](../figures/slope_c_fields.png)

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

Cells of 8 m; k_0 by `-mat_sand_permeability_k0`, the sea's level as the case's README says. All is nearly elastic. *Cells*: on 16 m 84, 75, 58, 44 % of the hydrate are left after 30, 50, 100, 150 years:
""".split("\n")
GROUND_WARMING = """
`hybrid` alone would take {steps} steps for the same years, {alone:.2g} years of a core at the {per:.2g} ms that a step takes here ([tradeoff](tradeoff.md#a-run-that-changes-its-integrator)).

With 1e-15 m² and more gas rises out of the foot, hydrate that forms there takes the rest, until p_g = p_e, (371) of [equations.md](../equations.md), and the next row with it; the density of gas there is that of a tenth of p_w, (323).

**Ground that fails** (cohesion 300 to 10, residual 5 kPa, friction to 10°, the dip of the slope, no dilation, η_s = 20: `-stage_warm_materials slope,weak`). `auto` sees that equilibrium is lost, (356) of [equations.md](../equations.md), goes over
to `hybrid` at the state before the slide, and after it particles lose what `hybrid` left against their nodes (452), so that implicit steps grow again. Every phase that `hybrid` carried; speed is that of the failed mass with all of E_k:
"""
AFTER_WARMING = """
With 12° the ground loses its equilibrium after 80 years of warming, with 15° after 105, and slides until it rests, half a minute later. Implicit steps behind a slide are short, since each takes 27 Newton iterations: with 12° they stay at three minutes, and the run gives up there; with 15° they had come to 12 minutes after 40 hours, where the run was ended.
""".split("\n")
SINCE = "B without heat from plastic work, and the energy of B in its picture, are from before hybrid stored pressure by particles ((413) of [equations.md](../equations.md))."
INTRO = """Section 5.2 of the paper, by [slope_a](../../cases/slope_a/README.md), [slope_b](../../cases/slope_b/README.md), [slope_c](../../cases/slope_c/README.md) and [slope_warming](../../cases/slope_warming/README.md). `scripts/slopes.py run` makes the runs,
[scripts/slide.py](../../scripts/slide.py) measures them, `scripts/slopes.py page` writes this page. By `hybrid` where nothing else is said.

How far these slopes slide hangs on two things: on the row of cells that the heated base warms, which is as thick as a cell, and on whether cells lock. Particles that share the volume change of their cells (88) do not lock. The paper's scheme (`hybrid_paper`) has bilinear cells without (88), which hold a part of what has failed.
So by 25 s slope A has moved 29.5, 30.5 and 31.2 m on cells of 8, 4 and 2 m, 30.7 m by `sdirk2` on 8 m, and 5.0 m by the paper's scheme. Its kinetic energy has the paper's peak at 25 s. It then rises once more, as the block leaves the scarp and slides out on the heated base, and is over at 60 s; the paper has it nearly over by 32 s.
With the paper's scheme the runout of C, 747 m, is nearest to the paper's 600 m.

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
    lines = [*dated.head("Submarine slopes", "scripts/slopes.py", KEPT, since=SINCE), INTRO, *section(kept, "A", NOTES_A), *section(kept, "B", NOTES_B), *section(kept, "C", NOTES_C), "", *energy(kept), *TRUST, *section_warming(kept)]
    PAGE.write_text("\n".join(lines).rstrip() + "\n")
    print(PAGE)


if __name__ == "__main__":
    {"run": run, "add": add, "page": page}[sys.argv[1]](*sys.argv[2:])
