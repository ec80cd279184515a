#!/usr/bin/env python3
"""One element of a softening skeleton, drained and undrained, against the rate equations.

Drained and undrained compression of one element of a softening skeleton, in plane strain and, implicit alone, triaxial about an
axis, with both flows: against an integrator of the rate equations written here without any return (strength, flow and pore
water from the equations, derivatives by differences), at the strain that the element has; and the ratio of the principal stresses
against that of the current strength at every moment.
"""
from pathlib import Path

import numpy as np

from common import Run, check, check_true, finish, judge, table

CASE = Path(__file__).parent / "cases" / "element.yaml"
E, NU, C, C_RES, PHI, PHI_RES, PSI, ETA = 200e6, 0.25, 300e3, 100e3, 30.0, 22.0, 10.0, 20.0
SIDE, P0, POROSITY, K_W = 500e3, 1e6, 0.4, 300e6
STEPS = 2500
PROBE, CELL = 0.9, 4 / 3  # m, as in the case


def strength(eps):
    left = np.exp(-ETA * eps)
    return C_RES + (C - C_RES) * left, np.radians(PHI_RES + (PHI - PHI_RES) * left), np.radians(PSI * left)


def yields(s, eps):
    c, phi, _ = strength(eps)
    return (s.max() - s.min() + (s.max() + s.min()) * np.sin(phi)) / (2 * np.cos(phi)) - c


def smooth(s, eps):
    """(64)"""
    _, phi, psi = strength(eps)
    sm = s.mean()
    q = np.sqrt(1.5 * np.sum((s - sm) ** 2))
    t, e = 1.5 * (s.max() - sm) / q, (3 - np.sin(phi)) / (3 + np.sin(phi))
    a, b = 1 - e * e, 2 * e - 1
    r = (4 * a * t * t + b * b) / (2 * a * t + b * np.sqrt(4 * a * t * t + 5 * e * e - 4 * e)) * (3 - np.sin(phi)) / (6 * np.cos(phi))
    return np.sqrt((0.1 * C * np.tan(psi)) ** 2 + (r * q) ** 2) + sm * np.tan(psi)


def slope(f, s, eps, d=20.0):
    return np.array([(f(s + d * i, eps) - f(s - d * i, eps)) / (2 * d) for i in np.eye(3)])


def normals(s, eps, flow, axis):
    """Slope of the yield function and direction of flow; about an axis the two lateral stresses stay equal, so both share."""
    if flow == "menetrey_willam":
        P = slope(smooth, s, eps)
    else:
        psi = strength(eps)[2]
        order = np.argsort(s)
        P = np.zeros(3)
        P[order[2]], P[order[0]] = 1 + np.sin(psi), np.sin(psi) - 1
    phi = strength(eps)[1]
    F, order = np.zeros(3), np.argsort(s)
    F[order[2]], F[order[0]] = (1 + np.sin(phi)) / (2 * np.cos(phi)), -(1 - np.sin(phi)) / (2 * np.cos(phi))
    if axis:
        share = lambda v: np.array([0.5 * (v[0] + v[2]), v[1], 0.5 * (v[0] + v[2])])
        F, P = share(F), share(P)
    return F, P


D = E / (1 + NU) * np.eye(3) + E * NU / ((1 + NU) * (1 - 2 * NU))


class Point:
    """x, y (axial), z; plastic: the slope of stress and plastic strain in strain."""

    def __init__(self, flow, axis, water):
        self.flow, self.axis, self.water = flow, axis, water
        self.s, self.eps, self.ln = np.full(3, -SIDE), 0.0, np.zeros(3)

    def modulus(self, s, eps, plastic):
        if not plastic:
            return D, np.zeros(3)
        F, P = normals(s, eps, self.flow, self.axis)
        n = np.sqrt(2 / 3 * np.sum((P - P.mean()) ** 2))
        hard = (yields(s, eps + 1e-7) - yields(s, eps - 1e-7)) / 2e-7
        by = F @ D / (F @ D @ P - hard * n)
        return D - np.outer(D @ P, by), by * n

    def rate(self, s, eps, ln, de, plastic):
        """Increments of stress, plastic strain and logarithmic strain for an axial de; the lateral total stress stays."""
        M, by = self.modulus(s, eps, plastic)
        lateral = np.array([1.0, 0.0, 1.0 if self.axis else 0.0])
        J = np.exp(ln.sum())
        k = K_W * J / (J - 1 + POROSITY) if self.water else 0.0  # -dp/d(volumetric strain)
        a = M[0] + k  # of d(total lateral stress) in strains
        d = np.array([0.0, de, 0.0])
        d = d - lateral * (a @ d) / (a @ lateral)
        return M @ d, by @ d, d

    def step(self, de):
        ds, _, d = self.rate(self.s, self.eps, self.ln, de, False)
        if yields(self.s + ds, self.eps) <= 0:
            self.s, self.ln = self.s + ds, self.ln + d
            return
        if yields(self.s, self.eps) < -1.0:  # to the yield surface first
            lo, hi = 0.0, 1.0
            for _ in range(60):
                at = 0.5 * (lo + hi)
                lo, hi = (at, hi) if yields(self.s + at * ds, self.eps) < 0 else (lo, at)
            self.s, self.ln, de = self.s + lo * ds, self.ln + lo * d, de * (1 - lo)
        ds, deps, d = self.rate(self.s, self.eps, self.ln, de, True)
        ds, deps, d = self.rate(self.s + 0.5 * ds, self.eps + 0.5 * deps, self.ln + 0.5 * d, de, True)
        self.s, self.eps, self.ln = self.s + ds, self.eps + deps, self.ln + d


def reference(flow, axis, water, axial):
    """sxx syy szz, p, eps at the axial strains (falling)."""
    q, out, at = Point(flow, axis, water), [], 0.0
    for target in axial:
        n = max(1, int(np.ceil((at - target) / 0.06 * STEPS)))
        for _ in range(n):
            q.step((target - at) / n)
        at = target
        out.append([*q.s, q.s[0] + SIDE + P0 if water else 0.0, q.eps])
    return np.array(out)


def run_of(flow, axis, water, *options):
    more = ["-fields", "hm", "-bc_side_normal", f"{SIDE + P0} Pa"] if water else []
    return Run.of_case(CASE, "-quiet", "-mat_soil_plasticity_flow", flow, *(["-geometry", "axisymmetric"] if axis else []), *more, *options)


def states(run, water):
    p = run.probe("p")
    columns = [p["sxx_Pa"], p["syy_Pa"], p["szz_Pa"], p["p_Pa"] if water else 0 * p["sxx_Pa"], p["eps_d_p"]]
    return np.log1p(p["u_y_m"] / PROBE), np.array(columns).T


FIXED = ("-stepper_adapt", "no", "-newton_tol_residual", "1e-11", "-newton_tol_update", "1e-9")
RUNS = {
    "sdirk2": (("-stepper_type", "sdirk2", "-stepper_dt", "0.005 s", *FIXED), 3e-5),
    "euler": (("-stepper_type", "euler", "-stepper_dt", "0.001 s", *FIXED), 2e-3),
    "hybrid": (("-inertia", "yes", "-stepper_type", "hybrid", "-stepper_damping", "0.3", "-time_end", "30.75 s", "-bc_top_velocity_ramp", "0 m/s,-0.002 m/s,0 s,1.5 s",
                "-output_probe_every", "5 ms"), 2e-4),
}  # fmt: skip
RINGING = 50  # rows of the probe: 0.25 s, in which a block with inertia rings fifteen times


def settled(values):
    """Means over RINGING rows, about which the block rings."""
    weight = np.hanning(RINGING + 2)[1:-1]
    return np.array([np.convolve(column, weight / weight.sum(), "valid") for column in values.T]).T


def moments(values):
    """Forty of them, evenly along the path."""
    return values[np.linspace(0, len(values) - 1, 41).astype(int)[1:]]


rows = []


def compare(what, flow, axis, water, name, *more):
    """Judges one run against the rate equations."""
    options, bar = RUNS[name]
    axial, got = states(run_of(flow, axis, water, *options, *more), water)
    if name == "hybrid":
        want, mean = (moments(settled(v)) for v in (reference(flow, axis, water, axial), got))
    else:
        axial, got = moments(axial), moments(got)
        want, mean = reference(flow, axis, water, axial), got
    error = np.abs(mean - want).max(axis=0) / np.array([*[np.abs(want[:, :3]).max()] * 3, P0, want[-1, 4]])
    plastic = got[:, 4] > 0
    c, phi, _ = strength(got[:, 4])
    s3, s1 = got[:, :3].max(axis=1), got[:, :3].min(axis=1)
    peak = (s3 * (1 + np.sin(phi)) - 2 * c * np.cos(phi)) / (1 - np.sin(phi))
    ratio = np.abs(s1 / peak - 1)[plastic].max()
    rows.append([what, *(got[-1] * [1e-6, 1e-6, 1e-6, 1e-6, 1]), error[:3].max(), error[3], error[4], ratio])
    judge("strength", f"one element: {what}: stress, pressure and plastic strain on the whole path", error.max(), bar)
    check("... stress ratio at the current strength", ratio, 1e-9)
    check_true("... the path is plastic, and softens", got[-1, 4] > 0.02 and (water or np.abs(got[:, 1]).max() > 1.02 * np.abs(got[-1, 1])))


for axis in (False, True):
    for water in (False, True):
        for flow in ("menetrey_willam", "mohr_coulomb"):
            for name in RUNS:
                if not axis or name == "sdirk2":
                    compare(f"{'triaxial' if axis else 'plane strain'}, {'undrained' if water else 'drained'}, {flow}, {name}", flow, axis, water, name)
plain, ETA = ETA, ETA * CELL / 2.0
for name in RUNS:
    compare(f"softening_length of 1.5 cells, {name}", "menetrey_willam", False, False, name, "-mat_soil_plasticity_softening_length", "2 m")
ETA = plain
table(["path", "sxx", "syy", "szz (MPa)", "p (MPa)", "eps_d_p", "error of stress", "of p", "of eps_d_p", "off the yield surface"], rows)
finish()
