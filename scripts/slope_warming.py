"""What the page of the slopes (scripts/slopes.py) says of runs of cases/slope_warming: a sea that warms over decades, and slides of seconds in it."""
import re
from pathlib import Path

import numpy as np

from clathra.units import YEAR

STEP_OF_HYBRID = 1.4e-3  # s of a core that a step of hybrid takes in cases/slope_warming, mean of 1.3e5
LOOKS = (30, 50, 100, 150)  # years of warming at which hydrate is looked at
# a line of summary.txt: stage, integrator, begin (s), steps, refused, processor time (s)
PHASE = r"^  stage (\w+): (\w+) from ([\d.e+]+) s .*?, (\d+) steps, (\d+) refused, .*?Newton iterations, ([\d.]+) s,"
WEAK = "-stage_warm_materials slope,weak"
ROWS = {  # name: (case, what the row is called, options)
    "W": ("warming", "1e-16 m² (the case)", ""),
    "W_falls": ("warming", "the same, and the sea falls by 20 m", "-ambient_level '{ramp: [461.5 m, 441.5 m, 20 a, 120 a]}'"),
    "W_k15": ("warming", "1e-15 m²", "-mat_sand_permeability_k0 1e-15m^2"),
    "W_k14": ("warming", "1e-14 m²", "-mat_sand_permeability_k0 1e-14m^2"),
    "W_15": ("warming", "15°", f"{WEAK} -mat_weak_plasticity_friction_peak 15deg"),
    "W_12": ("warming", "12° (the case)", WEAK),
}


def measure(run, folder):
    """What the page needs besides the measures of the slide.  run: slide.Run of the folder."""
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


def section(kept):
    """The section of the page."""
    forecast = kept["W"]["warming"]["hybrid_alone"]
    return [*BEFORE, *ground(kept, ("W", "W_falls", "W_k15", "W_k14")), *GROUND.format(steps=forecast[0], alone=float(forecast[0]) * STEP_OF_HYBRID / YEAR, per=1e3 * STEP_OF_HYBRID).split("\n"), *slides(kept, ("W_15", "W_12")), *AFTER]


BEFORE = """
## A sea that warms

[slope_warming](../cases/slope_warming/README.md): the body of A, the sea warmer by 3 K in 100 years. From hydrate, gas and water at equilibrium everywhere `auto` goes through 170 years in implicit steps of months and, with the paper's strength, the slope holds.

![hydrate under a warming sea](figures/case_slope_warming.png)

Cells of 8 m; k_0 by `-mat_sand_permeability_k0`, the sea's level as the case's README says. All is nearly elastic. *Cells*: on 16 m 86, 62, 38, 25 % of the hydrate are left after 30, 50, 100, 150 years, on 4 m 78, 70 % after 30 and 50 (62 % after 70, on 8 m 58). On 16 m the front of melting hydrate lies within the
first cell for decades, whose pressure is then half a megapascal above the sea's (a column: 0.54 MPa, on 4 m 0.05), and the ground gives by up to 3.8 m; on 8 m it does not. Beside the sloping floor S_h of neighbouring particles differs by up to 0.2 (8 m), by up to 0.5 on 16 m:
""".split("\n")
GROUND = """
`hybrid` alone would take {steps} steps for the same years, {alone:.2g} years of a core at the {per:.2g} ms that a step takes here ([tradeoff](tradeoff.md#a-run-that-changes-its-integrator)).

With 1e-15 m² and more gas rises out of the foot, hydrate that forms there takes the rest, until p_g = p_e, (371) of [equations.md](equations.md), and the next row with it; the density of gas there is that of a tenth of p_w, (323).

**Ground that fails** (cohesion 300 to 10, residual 5 kPa, friction to 10°, the dip of the slope, no dilation, η_s = 20: `-stage_warm_materials slope,weak`). `auto` sees that equilibrium is lost, (356) of [equations.md](equations.md), goes over
to `hybrid` at the state before the slide, and after it particles lose what `hybrid` left against their nodes (452), so that implicit steps grow again. Every phase that `hybrid` carried; speed is that of the failed mass with all of E_k:
"""
AFTER = """
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
  away, and with the trace alone refuses steps from the start; with what water really holds, (352) and (371) of [equations.md](equations.md), it is how the program now goes past the first gas ([test](../tests/verification/first_gas.py)).
- The matrix (101) of neighbouring nodes alternates p_g from node to node; lumped, it no longer does, but refused steps are as many.
""".split("\n")
