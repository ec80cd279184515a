#!/usr/bin/env python3
"""cases/elastic_wave: a dry column pushed at its end, against d'Alembert's solution.

First mode about the static state: what a time step keeps of it is |R(i omega dt)| of the integrator's R(z), so that both
integrators are held against their own damping.  Energy about the static state: exactly constant; what is lost is what
the integrator takes from the modes that it cannot follow.
"""
import numpy as np

from _ladder import CASES, ElasticWave as W
from common import Run, check, finish, judge, table

GAMMA = 1 - 0.5**0.5
GROWTH = {"euler": lambda z: 1 / (1 - z), "sdirk2": lambda z: (1 + (1 - 2 * GAMMA) * z) / (1 - GAMMA * z) ** 2}
PERIODS = 2


def last(*options):
    end = f"{PERIODS * W.period:.12g} s"
    return Run.of_case(CASES / "elastic_wave", "-time_end", end, "-output_times", end, *options).snapshots()[-1][1]


left, rows = {}, []
for stepper, growth in GROWTH.items():
    for n in (100, 200):
        v = last("-stepper_type", stepper, "-stepper_dt", f"{W.period / n:.12g}")
        kept, energy = W.first_mode(v) / W.first_mode_start, W.energy(v)
        want = (growth(2j * np.pi / n) ** (n * PERIODS)).real
        left[stepper, n] = kept, energy
        rows.append((stepper, float(n), kept, want, energy))
        if n == 200:
            judge("4.5", f"Elastic wave, {stepper}, {n} steps a period: first mode off the integrator's damping",
                  abs(kept - want), 1e-4)  # fmt: skip
table(("", "steps a period", "first mode kept", "by R(z)", "energy kept"), rows)
judge("4.5", "Elastic wave, sdirk2, 200 steps a period: energy lost in 2 periods", 1 - left["sdirk2", 200][1], 0.05, 0.01, "%")
check("euler loses more", left["euler", 200][1], left["sdirk2", 100][1])

run = Run.of_case(CASES / "elastic_wave", "-stepper_dt", f"{W.period / 400:.12g}")
u = W.solution(10.0, run.time)[0]
judge("4.5", "Elastic wave, sdirk2, 400 steps a period: end of the column, of its largest displacement",
      np.max(np.abs(run.probe("end")["u_x_m"] - u)) / np.max(np.abs(u)), 0.04, 0.01, "%")  # fmt: skip
v = run.snapshots()[-1][1]
kinetic = 0.5 * np.sum(v["mass_solid"][:, 0] * np.sum(v["v_s"] ** 2, axis=1))
check("kinetic energy in balance.csv, relative to that of the snapshot", abs(run.balance["kinetic_energy_J"][-1] / kinetic - 1), 1e-12)
finish()
