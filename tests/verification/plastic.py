#!/usr/bin/env python3
"""Mohr-Coulomb with softening in a whole scene, against the rate equations; orders of the integrators.

Mohr-Coulomb with softening in a whole scene: uniaxial strain from a state on the yield surface, against the rate
equations integrated here without any return ((PA.7), derivatives by differences), for every integrator; and the
order of euler and sdirk2 on it.
"""
from pathlib import Path

import numpy as np

from common import Run, check, finish, judge, order, table

CASE = Path(__file__).parent / "cases" / "oedometer.yaml"
E, NU, SH, C_0 = 200e6, 0.2, 0.4, 300e3


def strength(eps):
    left = np.exp(-10 * eps)
    return 100e3 + (300e3 - 100e3) * left, np.radians(12 + (18 - 12) * left), np.radians(8 * left)


def yields(y, eps):
    c, phi, _ = strength(eps)
    return ((y[0] - y[2]) + (y[0] + y[2]) * np.sin(phi)) / (2 * np.cos(phi)) - c


def potential(y, eps):
    """(49), (50b)"""
    _, phi, psi = strength(eps)
    sm = y.mean()
    q = np.sqrt(1.5 * np.sum((y - sm) ** 2))
    t, e = 1.5 * (y[0] - sm) / q, (3 - np.sin(phi)) / (3 + np.sin(phi))
    a, b = 1 - e * e, 2 * e - 1
    r = (4 * a * t * t + b * b) / (2 * a * t + b * np.sqrt(4 * a * t * t + 5 * e * e - 4 * e)) * (3 - np.sin(phi)) / (6 * np.cos(phi))
    return np.sqrt((0.1 * C_0 * np.tan(psi)) ** 2 + (r * q) ** 2) + sm * np.tan(psi)


def slope(f, y, eps, d=10.0):
    return np.array([(f(y + d * i, eps) - f(y - d * i, eps)) / (2 * d) for i in np.eye(3)])


def hooke(e):
    return E / (1 + NU) * e + E * NU / ((1 + NU) * (1 - 2 * NU)) * e.sum()


def reference(axial, steps):
    """(axial stress, lateral stresses, plastic strain) at an axial strain; second order in the steps (mid-point)."""
    y, eps, de = np.array([-1147666.618198045, -1.5e6, -3e6]), 0.0, np.array([0.0, 0.0, axial / steps])

    def rate(y, eps):
        F, P = slope(yields, y, eps), slope(potential, y, eps)
        n = np.sqrt(2 / 3 * np.sum((P - P.mean()) ** 2))
        F_eps = (yields(y, eps + 1e-7) - yields(y, eps - 1e-7)) / 2e-7
        L = F @ hooke(de) / (F @ hooke(P) - F_eps * n)
        return hooke(de) - L * hooke(P), L * n

    for _ in range(steps):
        dy, deps = rate(y, eps)
        dy, deps = rate(y + 0.5 * dy, eps + 0.5 * deps)
        y, eps = y + dy, eps + deps
    return y[2], y[0], y[1], eps


def state(run):
    p = run.probe("p")
    return np.array([p["syy_Pa"][-1], p["sxx_Pa"][-1], p["szz_Pa"][-1], p["eps_d_p"][-1]])


def strain(run):
    """Axial strain of the particles: nothing strains sideways."""
    return run.snapshots()[-1][1]["log_J"].mean()


rows = []
FIXED = ("-stepper_adapt", "no", "-newton_tol_residual", "1e-12", "-newton_tol_update", "1e-10", "-output_times", "1 s")
RUNS = {
    "euler": (("-stepper_type", "euler", "-stepper_dt", "0.002 s", *FIXED), 1e-4),
    "sdirk2": (("-stepper_type", "sdirk2", "-stepper_dt", "0.05 s", *FIXED), 2e-5),
    "hybrid": (("-inertia", "yes", "-stepper_type", "hybrid", "-stepper_damping", "0.2", "-output_times", "1 s"), 1e-4),
}
for name, (options, bar) in RUNS.items():
    run = Run.of_case(CASE, "-quiet", *options)
    want, got = np.array(reference(strain(run), 400)), state(run)
    error = np.abs(got / want - 1)
    rows.append([name, *got, error[:3].max(), error[3]])
    judge("strength", f"oedometer with softening, {name}: stress and plastic strain at the same strain", error.max(), bar)
table(["integrator", "syy", "sxx", "szz", "eps_d_p", "error of stress", "of plastic strain"], rows)

def settlement(kind, n):
    return Run.of_case(CASE, "-quiet", *FIXED, "-stepper_type", kind, "-stepper_dt", f"{1 / n:.17g} s").probe("p")["u_y_m"][-1]


best, steps, lines = settlement("sdirk2", 512), np.array([8, 16, 32]), []
for kind, low, high in (("euler", 0.9, 1.1), ("sdirk2", 1.85, 2.15)):
    error = np.array([abs(settlement(kind, n) - best) for n in steps])
    found = order(1.0 / steps, error)
    lines += [[kind, int(n), e] for n, e in zip(steps, error)]
    for value in found:
        check(f"order of {kind} on a plastic path", value, (low, high))
    judge("strength", f"order of {kind} on a plastic path", found[-1], (low, high))
table(["integrator", "steps", "error of the settlement (m)"], lines)
finish()
