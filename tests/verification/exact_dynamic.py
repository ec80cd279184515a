#!/usr/bin/env python3
"""Exact dynamics of a saturated column of finite length with compressible water, by inversion of its Laplace transform.

Conventions as in exact_solid.py.  Run as a program it checks the solution against others.
"""
import math
import sys
from dataclasses import dataclass
from typing import Optional

import numpy as np

from exact import slope_changes, constrained_modulus, mixture_coefficients, terzaghi_constant, terzaghi_constant_settlement
from exact_solid import SaturatedColumn, step_load


def invert(F, t, terms=20000):
    """Inverse Laplace transforms at the times t > 0 (n,) of F(s) (m, k) for s (k,): (m, n).

    Fourier series on a line right of all poles (Dubner and Abate 1968, Durbin 1974), with Lanczos's factors against the
    cut tail; for transforms that fall at least as 1/s^2.
    """
    t = np.asarray(t, float)
    T = 1.25 * np.max(t)
    shift = 9.0 / T  # the next period weighs exp(-18)
    k = np.arange(terms)
    values = F(shift + 1j * math.pi * k / T) * np.sinc(k / terms)
    values[:, 0] *= 0.5
    angle = np.exp(1j * math.pi / T * np.outer(k, t))
    return np.exp(shift * t) / T * np.real(values @ angle)


@dataclass(frozen=True)
class DynamicColumn:
    """A saturated column 0 <= x <= H, fixed and closed at x = 0, drained at x = H under the total stress q(t) there.

    Small strain, incompressible grains, water of bulk modulus Kw; both phases have their own acceleration (Biot 1956 without
    added mass).  With u, w of skeleton and water and e = (n_f w_x + n_s u_x) Kw/n_f = -p, per volume of each phase:

        n_s rho_s u_tt = M u_xx + n_s e_x - n_f^2/mobility (u - w)_t,     rho_w w_tt = e_x + n_f/mobility (u - w)_t.

    Each transform is a sum of two waves sinh(l x) along the eigenvectors of that system.  q grows from 0 to `q` over `rise`
    (s), 0 for at once; or it is piecewise linear, `table` = (times, loads), 0 at the first and constant after the last.
    """

    H: float
    M: float
    n_f: float
    rho_s: float
    rho_w: float
    Kw: float
    mobility: float
    q: float
    rise: float = 0.0
    table: Optional[tuple] = None

    def _load(self, s):
        if self.table is not None:
            return sum(change * np.exp(-s * start) for start, change in slope_changes(*self.table)) / s**2
        return self.q / s if self.rise == 0 else self.q * (1 - np.exp(-s * self.rise)) / (s**2 * self.rise)

    def _waves(self, s):
        """l (k, 2), eigenvectors (k, 2, 2) of (u, w) and their amplitudes c (k, 2)."""
        n_f, n_s, stiff = self.n_f, 1 - self.n_f, self.Kw / self.n_f
        A = np.array([[self.M + n_s**2 * stiff, n_s * self.Kw], [n_s * self.Kw, n_f * self.Kw]])
        drag = n_f**2 / self.mobility
        B = np.empty((len(s), 2, 2), complex)
        B[:, 0, 0] = s**2 * n_s * self.rho_s + s * drag
        B[:, 1, 1] = s**2 * n_f * self.rho_w + s * drag
        B[:, 0, 1] = B[:, 1, 0] = -s * drag
        squares, vectors = np.linalg.eig(np.linalg.solve(A[None], B))
        l = np.sqrt(squares)
        l = np.where(l.real < 0, -l, l)
        slope = np.stack([-self._load(s) / self.M, n_s / n_f * self._load(s) / self.M], axis=1)  # p = 0 there
        return l, vectors, np.linalg.solve(vectors, slope[..., None])[..., 0] / l

    def transforms(self, s, x):
        """Transforms of u(x), sigma'(x), p(x), (3, k)."""
        l, V, c = self._waves(s)
        n_f, n_s = self.n_f, 1 - self.n_f
        ratio = lambda sign: (np.exp(l * (x - self.H)) + sign * np.exp(-l * (x + self.H))) / (1 + np.exp(-2 * l * self.H))
        u = np.einsum("kij,kj->ki", V, c * ratio(-1))
        slope = np.einsum("kij,kj->ki", V, c * l * ratio(1))
        return np.stack([u[:, 0], self.M * slope[:, 0], -self.Kw / n_f * (n_f * slope[:, 1] + n_s * slope[:, 0])])

    def solution(self, x, t):
        """{u (m), stress (effective, Pa), p (excess, Pa)} at one x and the times t (n,); zero at t = 0."""
        t = np.asarray(t, float)
        found = np.zeros((3, len(t)))
        found[:, t > 0] = invert(lambda s: self.transforms(s, x), t[t > 0])
        return dict(zip(("u", "stress", "p"), found))


# ---------------------------------------------------------------------------------------- self-check
SAND = dict(M=constrained_modulus(14.516e6, 0.3), n_f=0.33, rho_s=2000.0, rho_w=1000.0, mobility=1e-6, q=3e3)


def finite_volumes(m, cells, dt, end):
    """u(H) and p(0) at `end` by central differences in space and the trapezoidal rule in time, for the check."""
    h, n_s, n_f = m.H / cells, 1 - m.n_f, m.n_f
    weight = np.ones(cells)
    weight[-1] = 0.5  # of the nodes 1 ... cells; node 0 is held
    mass = np.concatenate((n_s * m.rho_s * weight, n_f * m.rho_w * weight)) * h
    D = (np.eye(cells) - np.eye(cells, k=-1)) / h  # strain of cell i between nodes i and i+1
    Z, drag = np.zeros((cells, cells)), np.diag(n_f**2 / m.mobility * weight * h)
    C = m.Kw / n_f
    stiffness = h * np.block([[(m.M + n_s**2 * C) * D.T @ D, n_s * n_f * C * D.T @ D], [n_s * n_f * C * D.T @ D, n_f**2 * C * D.T @ D]])
    friction = np.block([[drag, -drag], [-drag, drag]])
    force = np.zeros(2 * cells)
    force[cells - 1] = -1.0  # p = 0: the skeleton carries the load
    left = np.linalg.inv(np.diag(mass) + 0.5 * dt * friction + 0.25 * dt**2 * stiffness)
    y, v, load = np.zeros(2 * cells), np.zeros(2 * cells), lambda t: m.q * min(t / m.rise, 1.0)
    for k in range(round(end / dt)):
        push = 0.5 * (load(k * dt) + load((k + 1) * dt)) * force
        new = left @ (mass * v - 0.5 * dt * friction @ v - dt * stiffness @ (y + 0.25 * dt * v) + dt * push)
        y, v = y + 0.5 * dt * (v + new), new
    strain = [D[0] @ y[:cells], D[0] @ y[cells:]]
    return y[cells - 1], -C * (n_f * strain[1] + n_s * strain[0])


def self_check():
    from common import check, finish

    t = np.array([0.02, 0.06, 0.1])
    slow = SaturatedColumn(**{k: SAND[k] for k in SAND if k != "q"}, load=lambda s: step_load(3e3 / 0.05)(s) * np.minimum(s, 0.05),
                           scale=0.01)  # fmt: skip
    stiff = DynamicColumn(H=10.0, Kw=1e14, rise=0.05, **SAND)
    for z, what in ((0.0, "u"), (2.0, "p"), (2.0, "stress")):
        want = {"u": lambda z, t: -slow.displacement(z, t), "p": slow.pressure, "stress": slow.stress}[what](z, t)
        off = np.max(np.abs(stiff.solution(10.0 - z, t)[what] - want)) / np.max(np.abs(want))
        check(f"incompressible water: {what} at depth {z:g} m off de Boer, Ehlers and Liu's", off, 1e-4)
    tight = {**SAND, "mobility": 1e-11}
    clay = DynamicColumn(H=1.0, Kw=2.2e9, **tight)
    B, c = mixture_coefficients(clay.M, clay.mobility, clay.n_f, clay.Kw)
    t = np.array([500.0, 2000.0, 5000.0])
    off = clay.solution(1.0, t)["u"] / terzaghi_constant_settlement(clay.q, clay.M, B, c, 1.0, t) - 1
    check("slow: settlement off Terzaghi's", np.max(np.abs(off)), 1e-4)
    off = clay.solution(0.4, t)["p"] - terzaghi_constant(clay.q, B, c, 1.0, 0.6, t)
    check("slow: p off Terzaghi's, over q", np.max(np.abs(off)) / clay.q, 1e-4)
    sand = DynamicColumn(H=10.0, Kw=2.2e9, rise=0.05, **SAND)
    u, p = finite_volumes(sand, 200, 2e-5, 0.06)
    check("Kw = 2.2 GPa: u(H) off central differences", abs(sand.solution(10.0, [0.06])["u"][0] / u - 1), 2e-3)
    check("Kw = 2.2 GPa: p(0) off central differences, over q", abs(sand.solution(0.0, [0.06])["p"][0] - p) / sand.q, 2e-3)
    ramp = DynamicColumn(H=10.0, Kw=2.2e9, table=([0.0, 0.05], [0.0, sand.q]), **SAND).solution(5.0, [0.1])["p"]
    check("a ramp as a table: p", abs(ramp[0] / sand.solution(5.0, [0.1])["p"][0] - 1), 1e-10)
    more = invert(lambda s: sand.transforms(s, 5.0), np.array([0.05, 0.2]), 80000)
    off = np.abs(np.stack(list(sand.solution(5.0, [0.05, 0.2]).values())) - more) / np.max(np.abs(more), axis=1)[:, None]
    check("Kw = 2.2 GPa: off four times as many terms", np.max(off), 1e-5)
    finish()


if __name__ == "__main__":
    sys.exit(self_check())
