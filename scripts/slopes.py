#!/usr/bin/python3
"""The page of the slopes: slopes.py add NAME FOLDER [ACROSS [WHAT IT TOOK]], slopes.py page

`add` measures a run (scripts/slide.py) with ACROSS particles along a cell (2) and keeps what the page needs as docs/slopes.json[NAME]; `page` writes docs/slopes.md
from that file alone.
"""
import json
import re
import sys
from pathlib import Path

import numpy as np

import slide

DOCS = Path(__file__).resolve().parents[1] / "docs"
KEPT = DOCS / "slopes.json"
POINTS = {"A": (165, 1), "B": (113, 53)}  # m, of scripts/plot_slope.py
SERIES = {"T": "T", "eps_d_p": "eps_d_p", "log_J": "log_J", "p": "p", "S_h": "S_h", "m_h": "mass_hydrate"}


def add(name, folder, across="2", took=""):
    run = slide.Run(folder, across=int(across))
    m, found = slide.measure(run), slide.bands(run)
    slide.write(run, m, found)
    m["bands"] = found
    m["took"] = took or took_of(folder)
    m["balance"] = closing(run.balance)
    t = run.balance["time_s"]
    every = np.unique(np.searchsorted(t, np.arange(0, t[-1], 1.0)))
    m["series"] = {"t": short(t[every]), "E_k": short(run.balance["kinetic_energy_J"][every]), "hydrate_kg": short(run.balance["hydrate_kg"][every], 9)}
    m["series"] |= {"shown": short(run.time), "failed": short([100 * p["volume"][run.failed(p), 0].sum() / p["volume"].sum() for _, p in run.snapshots])}
    for point, place in POINTS.items() if name == "A" else ():
        m["snapshots"], m.setdefault("points", {})[point] = short(run.time), {}
        i = int(np.argmin(np.hypot(*(run.start - place).T)))
        m["points"][point] = {k: short(run.rows(v)[:, i], 6) for k, v in SERIES.items()}
    kept = json.loads(KEPT.read_text()) if KEPT.is_file() else {}
    kept[name] = m
    KEPT.write_text(json.dumps(kept, separators=(",", ":"), sort_keys=True).replace('},"', '},\n"') + "\n")


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
          ("elastic_released_J", "released with hydrate"), ("plastic_work_J", "plastic"), ("drag_work_J", "drag"), ("kinetic_lost_J", "lost between particles and nodes"), ("energy_remainder_J", "left over"))  # fmt: skip


LABELS = {"A": "A, θ = 0.5", "A_theta_0": "A, θ = 0", "A_half": "A, half the step", "A_3m": "A, cells of 3 m", "A_2m": "A, cells of 2 m", "A_ppc9": "A, 3 x 3 particles", "A_ranks": "A, 2 ranks",
          "A_3m_length": "A, cells of 3 m, softening_length 4 m", "A_length": "A, cells of 2 m, softening_length 4 m", "B": "B, cells of 4 m, θ = 0.5", "C": "C, cells of 4 m, θ = 0.5", "A_8m": "A, cells of 8 m", "A_printed": "A, K_0 = 3.6e4",
          "A_250": "A to 250 s", "A_nl4": "A, nonlocal_length 8 m", "A_nl3": "A, cells of 3 m, nonlocal_length 8 m", "A_nl2": "A, cells of 2 m, nonlocal_length 8 m",
          "A_2m_layer": "A, cells of 2 m, heated layer of 4 m", "A_2m_layer_length": "A, the same, softening_length 4 m", "A_2m_layer_nl": "A, the same, nonlocal_length 8 m",
          "B8": "B, cells of 8 m, θ = 0.5", "B8_theta_0": "B, cells of 8 m, θ = 0", "C8": "C, cells of 8 m, θ = 0.5", "C8_theta_0": "C, cells of 8 m, θ = 0", "A8_sdirk2": "A, cells of 8 m, sdirk2", "A_sdirk2": "A, sdirk2", "C8_sdirk2": "C, cells of 8 m, sdirk2"}  # fmt: skip


# ---------------------------------------------------------------- page
def energy(kept):
    """Balance of energy of every run that kept it, at its end, MJ per metre."""
    rows = [("run", *(word for _, word in ENERGY), "left over, of gravity's work")]
    for name, m in kept.items():
        if "energy_remainder_J" in m["balance"]:
            b = m["balance"]
            rows.append((f"{LABELS.get(name, name)}, {m['end_s']:.0f} s", *(f"{b[k] / 1e6:.4g}" for k, _ in ENERGY), f"{100 * abs(b['energy_remainder_J'] / b['gravity_work_J']):.2g} %"))
    return ["## Balance of energy", "", "MJ per metre: works of the first three, and where they went. All close to less than 1 % of the work of gravity. With velocities of nearly empty nodes tied to their",
            "neighbours, a tie that gives power where a surface tears, and works of held nodes that missed half the slip over the base, a fifth was left over in B and C ((41), (92), (150) of [equations.md](equations.md)).", "",
            *table(rows)]  # fmt: skip


def table(rows):
    width = len(rows[0])
    return ["| " + " | ".join(map(str, rows[0])) + " |", "|" + "---|" * width] + ["| " + " | ".join(map(str, r)) + " |" for r in rows[1:]]


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


def runs_of(kept, names):
    return table([HEAD] + [row(label, kept[n]) for n, label in names if n in kept])


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
    lines = ["## Scenario A", "", *runs_of(kept, RUNS_A), ""]
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
    m = kept["B8"]
    s = m["base_sheared_at_its_upper_end_s"]
    yield ("strain along the base reaches the upper end of the heated part by 15 s", "at " + seconds(s) + " s", "agrees" if s and s < 20 else "**differs**")
    yield ("crossing V bands in the middle and lower part by 18 s", near(m, 18, 2), "**differs**: at the upper end of the heated base only")
    yield ("a graben at the upper end of the heated base by 45 s, what is below it slides as one block", near(m, 17, 1), "agrees, but comes first, at 17 s")
    yield ("largest E_k, then 45 s, 72 s and later peaks", f"{m['peak_kinetic_energy_J']:.2g} J/m at {m['peak_kinetic_energy_s']:.0f} s", "one peak, earlier")
    yield ("hydrate goes fast from 13 to 35 s", f"{lost(m, 13):.1f} % lost by 13 s, {lost(m, 35):.1f} % by 35 s" if m["end_s"] >= 35 else "the run ended before", "agrees")


def scenario_c(kept):
    m, warm, cold = kept["C"], kept["C8"], kept["C8_theta_0"]
    tops = [b["angle_deg"] for b in tall(m)]
    yield ("first band near the front at 17 s", near(m, 19, 1), "agrees but for 2 s; here a V")
    yield ("second and third V at 30 s, at the top and in the middle, two grabens", near(m, 27, 1), "at the top at 27 s; none in the middle")
    yield ("sub-bands in the grabens at 41 s", near(m, 41, 4), "agrees")
    yield ("fourth and fifth at 56 to 60 s", near(m, 54, 6), "at 50 and 59 s; they follow each other from the head of the slide down")
    yield ("last one at 77 s", near(m, 86, 4), "at 82 and 89 s")
    yield ("angles of 47 to 51°", f"bands through 60 % of the height: {min(tops):.0f} to {max(tops):.0f}°, mean {np.mean(tops):.0f}°", "four of seven of 49 to 53°, the last three 56 to 58°")
    yield ("seven bands", f"{len(tall(m))} through 60 % of the height, {len(m['bands'])} in all", "agrees")
    yield ("runout 600 m", f"{m['runout_m']:.0f} m at {m['end_s']:.0f} s", "**farther**")
    yield ("one very high peak of E_k, higher than in B", f"{m['peak_kinetic_energy_J']:.2g} J/m at {m['peak_kinetic_energy_s']:.0f} s" + (f"; B {kept['B8']['peak_kinetic_energy_J']:.2g}" if "B8" in kept else ""), "one peak, but **lower** than in B")
    yield ("R_k peaks as bands form", "peaks of R_k at " + ", ".join(f"{t:.0f}" for t in m["peaks_of_R_k_s"]) + " s", "some; many more than bands")
    yield ("with θ = 0.5 larger E_k, that falls more slowly", f"8 m: {warm['peak_kinetic_energy_J']:.3g} against {cold['peak_kinetic_energy_J']:.3g} J/m", "agrees")
    yield ("... and farther", f"8 m: what failed moved {warm['mean_displacement_m']:.0f} against {cold['mean_displacement_m']:.0f} m; front {warm['runout_m']:.0f} against {cold['runout_m']:.0f} m", "agrees in the mean")
    yield ("... seven bands against six", f"8 m: {len(tall(warm))} against {len(tall(cold))} tall bands, {len(warm['bands'])} against {len(cold['bands'])} in all", "more of them reach 60 %, their number hardly changes")
    yield ("... and more hydrate lost", f"8 m: {100 * warm['hydrate_lost_share']:.1f} against {100 * cold['hydrate_lost_share']:.1f} %", "agrees")


IMPLICIT = (("A8_sdirk2", "A_8m", "A, cells of 8 m"), ("A_sdirk2", "A", "A, cells of 4 m"), ("C8_sdirk2", "C8", "C, cells of 8 m"))
LOOKS = (11, 12, 14, 16, 18, 20, 22, 25, 30, 40)  # s


def implicit(kept):
    """sdirk2 against hybrid on the same mesh as far as it went."""
    pairs = [(kept[a], kept[b], label) for a, b, label in IMPLICIT if a in kept and "failed" in kept[b]["series"]]
    if not pairs:
        return []
    lines = ["", "## By implicit steps", ""]
    for own, other, label in pairs:
        end = own["end_s"]
        rows = [(f"{label}: t (s)", "E_k, `sdirk2`", "`hybrid` (J/m)", "failed, `sdirk2`", "`hybrid` (%)", "hydrate lost, `sdirk2`", "`hybrid` (%)")]
        for t in [*(t for t in LOOKS if t < end - 0.5), end]:
            values = [(np.interp(t, m["series"]["t"], m["series"]["E_k"]), np.interp(t, m["series"]["shown"], m["series"]["failed"]), lost(m, t)) for m in (own, other)]
            rows.append((f"{t:g}", *(words for k, form in enumerate(("{:.3g}", "{:.1f}", "{:.2f}")) for words in (form.format(v[k]) for v in values))))
        lines += [*table(rows), "", f"Onset at {seconds(own['onset_s'])} s by `sdirk2`, {seconds(other['onset_s'])} s by `hybrid`; {own['took']} against {other['took']} (to {other['end_s']:.0f} s).", ""]
    return lines + NOTES_IMPLICIT


def section(kept, title, runs, statements, key, notes):
    if key not in kept:
        return []
    return ["", f"## Scenario {title}", "", *runs_of(kept, runs), "", *table([("the paper says", "here", "")] + list(statements(kept))), "", *notes]


RUNS_A = (
    ("A", "A: θ = 0.5"), ("A_250", "the same to 250 s"), ("A_theta_0", "θ = 0"), ("A_printed", "K_0 = 3.6e4, as printed; surface tied"), ("A_half", "half the step (cfl 0.4)"),
    ("A_ranks", "2 ranks"), ("A_ppc9", "3 x 3 particles"), ("A_3m", "cells of 3 m"), ("A_2m", "cells of 2 m"), ("A_8m", "cells of 8 m"),
    ("A_3m_length", "cells of 3 m, softening_length 4 m"), ("A_length", "cells of 2 m, softening_length 4 m"),
    ("A_nl4", "nonlocal_length 8 m"), ("A_nl3", "cells of 3 m, nonlocal_length 8 m"), ("A_nl2", "cells of 2 m, nonlocal_length 8 m"),
    ("A_2m_layer", "cells of 2 m, heated layer of 4 m"), ("A_2m_layer_length", "the same, softening_length 4 m"), ("A_2m_layer_nl", "the same, nonlocal_length 8 m"),
    ("A8_sdirk2", "cells of 8 m, sdirk2"), ("A_sdirk2", "sdirk2"),
)  # fmt: skip
RUNS_B = (("B8", "B: cells of 8 m, θ = 0.5"), ("B8_theta_0", "θ = 0"), ("B", "cells of 4 m, θ = 0.5"))
RUNS_C = (("C8", "C: cells of 8 m, θ = 0.5"), ("C8_theta_0", "θ = 0"), ("C", "cells of 4 m, θ = 0.5"), ("C8_sdirk2", "cells of 8 m, θ = 0.5, sdirk2"))
NOTES_IMPLICIT = """- *It goes through to rest* (`-stepper_type sdirk2 -stepper_tol 1e-2`), in steps of 0.1 s, those of the probes, with 4 to 7 Newton iterations. The same part of the body fails, E_k is lower, by 14 % at its peak
  and by a quarter until 16 s, and comes to rest sooner: what failed moves 4.1 m instead of 5.5. The ghost penalty holds the torn surface (1e-2; with the default 0.1 E_k is 2.7 MJ/m at 12 s and 3.7 m come of it), and steps of 0.1 s damp waves; halved steps were not run.
- *What stopped it before* (the prototype at 13.5 s; this program, with the cases as they were, at steps of 5 ms from 10.4 s on) is the undrained body's surface, not plasticity. In a node of which the surface leaves a sliver, changes of pressure are what that share of a
  particle makes up, and temperature is carried there by the heated row's gradient: 0.66 MPa beside 4.5, -6 °C beside 2 at (296, 16) m. Newton's first six updates were cut in every stage, 8 to 10 iterations each, and with
  more than six steps do not grow. `stabilisation: {ghost_storage: 0.1}`, (351), which these cases now have, ties the changes to those of the nodes beside: from the same state 5 ms became 0.1 s within 17 steps. `hybrid` has its own tie (41) and knows neither.
- *C* on cells of 8 m likewise went on in steps of 0.1 s with 5 to 7 iterations; it was ended at 11.6 s for want of time, and 4 m was not tried.""".split("\n")
NOTES_B = """- To 100 s without a step refused: gas that expands in what tears loses shares of its pressure, not pascals ((151) of [equations.md](equations.md), `stepper_pressures: relative`). With increments of p_g
  shared among particles a single one reached zero pressure at 27 s and the run gave up; with `stepper_relaxation` of 1 s at 42.7 s.
- The step falls to 2 ms as particles in the tears become thin (150): 43,000 steps (on cells of 16 m 12,700, tied 7,300).
- The rows are of a program without (374). With it (and domains that might reach over the edge of the grid) the run on 8 m takes 30,173 steps instead of 43,892 and none is refused; E_k 5.2e10 J/m at 39 s, 702 m moved, runout 837 m, 6.7 % of the hydrate:
  the thinnest domain, h/200, would have a step of 1.3 ms and has 4.2.
- *What is left of E_k* from 66 s on, 2 % of its peak, is in particles of what tore that swing against each other (100 of 6,406 hold half of it): a motion that the grid does not see (FLIP). At 100 s, with (374), it is 1.4e9 J/m, of which the nodes
  have 2e4: single particles at up to 39 m/s where nodes move by 4 cm/s. It moves nothing, as in A.
- On cells of 8 m the heated layer is twice as thick as the paper's. On 4 m the run was ended at 49.7 s (68,000 steps, 37 minutes; with steps of 0.34 to 0.42 ms the rest would have taken an hour): E_k has its peak of 5.0e10 J/m
  at 34 s, not at 39, the base is sheared at its upper end at 14.0 s (14.1), and the graben there comes at 16 to 17 s with more bands inside (ten by 23 s instead of six); 4.2 % of the hydrate is lost.

![plastic strain](figures/case_slope_b.png)

![energy](figures/slope_b_energy.png)""".split("\n")
NOTES_C = """- The statements without a mesh are of the paper's cells of 4 m. On 8 m the heated layer is twice as thick (9.8 instead of 6.9 % of the hydrate lost), bands come within 2 s of the same times at the same places until 30 s, and E_k, runout and failed volume differ by 2 to 6 %.
- The block in the middle stays whole, for 100 s; the paper's breaks into horsts and grabens everywhere.

![plastic strain](figures/case_slope_c.png)

![energy](figures/slope_c_energy.png)

![bands](figures/slope_c_bands.png)""".split("\n")
TRUST = """
## Failure against limit equilibrium

A slab of 8 m on a dip of 10°, the layer under it warmed until its hydrate gives gas ([tests/verification/infinite_slope.py](../tests/verification/infinite_slope.py)). F is the factor of safety of limit equilibrium with the run's own pore pressure and cohesion;
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
With friction the two differ unless pore water bears the sea's pressure inside ([tests/verification/submerged_column.py](../tests/verification/submerged_column.py)).
""".split("\n")
WARMING = """
## A sea that warms

[slope_warming](../cases/slope_warming/README.md): the body of A, the sea warmer by 3 K in 100 years. From hydrate, gas and water at equilibrium everywhere `auto` goes through 170 years in 393 implicit steps (17 refused), loses
77 % of the hydrate, and the slope holds, with the paper's strength.

![hydrate under a warming sea](figures/case_slope_warming.png)

**Ground that fails** (cells of 16 m; cohesion 300 to 10, residual 5 kPa, friction to 4°, no dilation, η_s = 20: `-stage_warm_materials slope,weak`). `auto` sees that equilibrium is lost, (356) of [equations.md](equations.md), goes over
to `hybrid` at the state before the slide, and after it particles lose what `hybrid` left against their nodes (357), so that implicit steps grow again.

| friction at peak | what comes of it in 150 years |
|---|---|
| 16° | holds: implicit steps alone (775, 33 refused), plastic strain of 1.1 at most |
| 15° (the case) | slides after 109.3 and 134.6 years: 3.6 and 5.2 m at the face within half a minute each, 1.07 and 3.53 MJ/m, all by `hybrid` (implicit steps never see more than 12 J/m); between them creep in steps of up to months. 561 implicit steps (16 refused), 4608 of `hybrid`, masses closed to 4e-15, heat to 1e-12 |
| 14° | 103.5 and 131.6 years (0.61, 1.95 MJ/m); 564 implicit steps (25 refused), 6400 of `hybrid` |
| 14°, 3 x 3 particles | 108.9, 115.4, 121.2, 130.8, 140.9 and 146.7 years (up to 2.5 MJ/m); 995 implicit steps (67 refused), 17152 of `hybrid`; water and methane closed to 8e-15, heat to 5e-12. The front ends at 494 m: a grid of 480 m ended this run after 145.8 years, where no particle flew, but the front had arrived whole (twelve particles in its last 30 m) |
| 12° | 92.5, 100.0, 147.7 and 149.7 years (0.25, 0.04, 1.77, 0.09 MJ/m); 693 implicit steps (43 refused), 8448 of `hybrid` |

Two things made this possible. *Who carries the slide*: before, three implicit steps in a row had to be dearer than `hybrid`, and those of seconds had most of the motion, with a sixth of its energy (0.079 instead of 0.46 MJ/m in the
first slide of the 14° ground as it was then). *The sea gives no gas* (358): torn ground under the sea, pulled apart faster than water comes in, had taken gas through its open faces, ten times what it held, swelled until it was lighter than water
and rose out of the grid; with it the 14° ground went to and fro at 126 years and the 12° one stopped at 110.

The onset moves with what the state before holds, and with it what comes later: 15° failed after 116.5 years, and twice more, 14° after 107.4 and without an end, when what left through the floor had the density of the sea's pressure
instead of the body's (365) and Newton's updates were bound by nodes instead of particles (349). Steps there are of half a year.
With dilation (2° to 0°) the slide of 12.5 m cells takes weeks instead of seconds, since suction holds it; `hybrid` from there agrees: 0.3 m in the first seconds, then next to nothing in a minute.

**More permeable ground** (`-mat_sand_permeability_k0`, all else as it stands; elastic all the way, as gas and pressure leave):

| k_0 | hydrate left after 30, 50, 100, 150 years | implicit steps of the warming (refused), median | largest movement | least p_g - p_w at the end |
|---|---|---|---|---|
| 1e-16 m² (the case) | 80, 64, 35, 23 % | 287 (12), 160 days | 1.4 m | 0.04 MPa |
| 1e-15 m² | 59, 53, 39, 29 % | 461 (5), 86 days | 0.08 m | -0.55 MPa |
| 1e-14 m² | 62, 56, 43, 33 % | 345 (18), 117 days | 0.02 m | -0.86 MPa |

Before, 1e-15 m² stood still in its 85th year (steps of seconds, and `hybrid` in vain): gas rises out of the foot, hydrate that forms there takes the rest, and as the drive of the reaction was the water's pressure then, p_g fell below that of equilibrium without end,
to 0.3 MPa at particles 24 m below 4.3 MPa, in a gas that can no longer move. Now hydrate takes gas until p_g = p_e, (371) of [equations.md](equations.md), and the next row with it; 1e-16 m² never gets there. With 1e-14 m² so much gas is
used up that steps of a year overshoot p_g below zero, where methane flowed from the lower to the higher p_g until 1.2 GPa stood against it and the run gave up in its 125th year; since the density of gas there is that of a tenth of p_w, (323), it goes through.
The twenty years of settling take 564 steps of `euler` at 1e-14 m² (106 at 1e-16).

*Sediment without gas* is another matter. A column of six cells is enough to see it: 2 x 2 particles a cell,
100 m of sediment with S_h = 0.4 and no gas (k_0 = 1e-15 m², p_0 = 10 kPa, S_gr = 0.3), the sea's pressure and a temperature that rises by 0.03 K a year on its top. It ends, but refuses 31 of 201 steps, in bursts: whenever
hydrate in one more row of particles begins to go, steps fall from years to hours or minutes. Neither a surface across cells nor small shares of a cell are needed for it:

- Hydrate that becomes water alone takes less room, so as long as a pore has no gas phase, dissociation lowers p_w and drives itself on: 580 Pa per kg in a particle of 100 m³, which for a reaction as fast as this one is 1700 times what it takes to stop
  it. The tangent of a pore without gas therefore has the wrong sign, and Newton's first update lets hydrate form (p_g to -1e10 Pa). The solution lies beyond the kink of (101), where 0.05 kg of hydrate give the gas that holds the pressure.
- From guesses with gas (5 % of the pores) Newton's method does go to that solution, but by one p_trap of p_c an iteration, since s_g is exponential in p_c < 0; and guesses by nodes change the particles of the cell that hold gas already.
- While hydrate could form, it takes what methane water holds: p_g falls to 1.1 MPa below p_w, and next to a particle with gas nodes stand at p_c = +0.3 and -0.9 MPa. Drive by p_g where there is no gas, the methane's own pressure, takes this
  away and was worse: the dissociation of traces refuses steps from the start.
- The matrix (101) of neighbouring nodes alternates p_g from node to node; lumped, it no longer does, but refused steps are as many.
""".split("\n")
NOT_RUN = """
## What was not run

B on 4 m after 49.7 s, B and C on 4 m without heat from plastic work, `K_0` as printed with free velocities (that row of A is of an earlier program), sdirk2 on 4 m
(on cells of 8 m two ranks agree with one to 1e-12 into the slide: [tests/integration/slope.py](../tests/integration/slope.py)).
""".split("\n")
NOTES_A = """- *Later peaks.* The paper's further peaks of E_k, without new bands, are put down to creep as hydrate goes on dissociating. Here the hydrate of the heated row of cells is
  gone by then (point A: all of it by 100 s), the block rests on the stump of the base left of 150 m, and 2 % of all hydrate is lost for good. With K_0 = 3.6e4, the rate as printed, the
  slide comes in many small rushes from 76 s to 184 s instead.
- *The rate of the reaction* decides the time scale. The paper's times (rise, peak at 25 s, rest at 32 s) come out with K_0 = 3.6e5, ten times the printed rate; dE is not legible in it.
- *Point B* has no deviatoric stress from 22 s on: the left band is pulled open and its skeleton is at the apex of the yield surface, while suction (-0.75 MPa) holds it together.
- *To 250 s* nothing comes after the peak at 25 s. Two ranks: E_k to 1e-11 of one at 25 s, what failed 12.7 m both.
- *Meshes.* Onset (11.1 s), failed volume (52 to 53 %) and the V of bands (48 to 51°, 61 to 64°; none on 8 m) stay; how far and how fast it slides does not: E_k of 9.8, 12.1, 20.8, 27.2 MJ/m, 5.5, 12.7, 15.3, 17.8 m on 8, 4, 3, 2 m.
  Softening goes into bands as thin as cells allow, and they weaken the sooner the thinner they are. Regularised it is the other way round: `softening_length: 4 m` 12.1, 4.7, 2.9 MJ/m and 12.7, 7.7, 2.0 m on 4, 3, 2 m, `nonlocal_length: 8 m`
  5.1, 3.9, 2.4 MJ/m and 4.9, 3.2, 1.8 m: what is heated is one cell thick (1.5, 1.0, 0.5 % of the hydrate lost), and strength averaged over more than that hardly falls. With the nodes of two rows of 2 m held at the temperatures that a cell of
  4 m has in between, more heat comes in than on 4 m (2.7 % lost) and 82 MJ/m, 34 m come of it; 14.3 MJ/m, 6.0 m with the softening length, 123 MJ/m, 49 m nonlocally. 3 x 3 particles on 4 m: 6.7 MJ/m, 8.8 m.
  So **the heat let in rules how far it slides**, and a layer heated at nodes has no limit of fine meshes: the paper's own numbers are those of its mesh.
- *What is left of E_k* at the end, 0.03 MJ/m, is in two particles at the toe that swing against each other: a motion that the grid does not see (FLIP). On 8 m it is 42 of the 43 kJ/m after 40 s; the nodes move with 0.9.
  It moves no particle, for places and strains follow the nodes, and stresses with them; only E_k after a slide is not to be read as motion. `auto` takes it out over the implicit steps behind a slide, (357); `hybrid` alone keeps it.

![energy](figures/slope_a_energy.png)

![points](figures/slope_a_points.png)

![bands](figures/slope_a_bands.png)""".split("\n")
INTRO = """# Submarine slopes

Section 5.2 of the paper, by [slope_a](../cases/slope_a/README.md){others}, with `hybrid`. Made by `scripts/slopes.py page` from
`docs/slopes.json`, into which `scripts/slopes.py add` puts what [scripts/slide.py](../scripts/slide.py) measures of a run.

## What is measured

- *Failed*: what has moved farther than 1 % of the height (1 m) since the loading ended. *Onset*: when 1 % of the body has. *Moved*: mean over what failed.
- *Runout*: how far the front is ahead of the toe at the start, along the base. *Retrogression*: from the crest back to the farthest failed particle of the ground.
- *Speed*: the largest mean velocity of what has failed in the end. *Peaks* of E_k: maxima from which it falls by 2 % of the largest on either side, in means over 2 s.
- *P_k*: the power of the forces on what moves (`kinetic_power_W` of `balance.csv`), in means over 2 s; *R_k*: its slope by linear least squares over 2 s.
- *Bands*: straight strips one cell wide, at every angle in steps of 2 degrees and every half cell, in the configuration at the start and above the heated base. A piece of a strip, one cell long,
  counts where its mean ε_d^p exceeds 0.15 and twice that of the strips two and a half cells to either side; a strip needs a row of such pieces 60 % of the slope's height long (40 % in the
  state at the end), with gaps of two at most. They are looked for every 2 s; the strip with the largest sum of strain is a band, its particles and those within two and a half cells
  are taken out, and so on. A band's time is the median of the times at which its particles pass 0.15; its angle is that of the main axis of their places at that time, weighted with strain, against the base.
- *Gas released*: what the hydrate lost gave, per metre of thickness; all of it stays in the closed body.
"""


def page():
    kept = json.loads(KEPT.read_text())
    others = "".join(f", [{c}](../cases/{c}/README.md)" for c in ("slope_b", "slope_c") if (DOCS.parent / "cases" / c).is_dir())
    lines = [INTRO.format(others=others), *section_a(kept), *section(kept, "B", RUNS_B, scenario_b, "B8", NOTES_B), *section(kept, "C", RUNS_C, scenario_c, "C8", NOTES_C), *implicit(kept), "", *energy(kept), *TRUST, *WARMING, *NOT_RUN]
    (DOCS / "slopes.md").write_text("\n".join(lines).rstrip() + "\n")
    print(DOCS / "slopes.md")


if __name__ == "__main__":
    {"add": add, "page": page}[sys.argv[1]](*sys.argv[2:])
