#!/usr/bin/env python3
"""Exact and semi-analytical solutions of flow: displacement, imbibition, pressure diffusion, a consolidating cylinder.

Conventions: SI units, pore pressure and loads compression-positive, displacements positive outwards.  S is the share of
water s_w = S_w/(1 - S_h) of the fluid volume, phi the porosity open to fluids, phi (1 - S_h).  x, r and t may be scalars or
arrays; they are broadcast against each other.

Run as a program it checks every solution against its equation or an independent numerical solution.
"""
import math
import sys
from dataclasses import dataclass

import numpy as np

from exact import Retention, bisect, constrained_modulus
from exact_heat import J0, J1, bessel_roots, difference, half_space, half_space_flux, residual

TERMS = 400  # of every series


# ---------------------------------------------------------------------------------------- constitutive laws
@dataclass(frozen=True)
class Corey:
    """k_rw = ((S - Swr)/(1 - Swr - Sgr))^nw, k_rg = ((1 - S - Sgr)/(1 - Swr - Sgr))^ng, both within [0, 1]."""

    Swr: float = 0.0
    Sgr: float = 0.0
    nw: float = 2.0
    ng: float = 2.0

    def mobile(self, S):
        return np.clip((np.asarray(S, float) - self.Swr) / (1 - self.Swr - self.Sgr), 0, 1)

    def krw(self, S):
        return self.mobile(S) ** self.nw

    def krg(self, S):
        return (1 - self.mobile(S)) ** self.ng

    def slopes(self, S):
        """dk_rw/dS, dk_rg/dS between the residual saturations."""
        e, width = self.mobile(S), 1 - self.Swr - self.Sgr
        return self.nw * e ** (self.nw - 1) / width, -self.ng * (1 - e) ** (self.ng - 1) / width


def van_genuchten_slope(p0, m, Swr=0.0, Sgr=0.0):
    """dp_c/dS (Pa) of p_c = p0 (Se^(-1/m) - 1)^(1-m), Se = (S - Swr)/(1 - Swr - Sgr), as a function of S."""

    def slope(S):
        e, width = (np.asarray(S, float) - Swr) / (1 - Swr - Sgr), 1 - Swr - Sgr
        return -p0 * (1 - m) / m * (e ** (-1 / m) - 1) ** (-m) * e ** (-1 / m - 1) / width

    return slope


def brooks_corey_slope(pd, lam, Swr=0.0, Sgr=0.0):
    """dp_c/dS (Pa) of p_c = pd Se^(-1/lam), as a function of S."""

    def slope(S):
        e, width = (np.asarray(S, float) - Swr) / (1 - Swr - Sgr), 1 - Swr - Sgr
        return -pd / lam * e ** (-1 / lam - 1) / width

    return slope


def retention_slope(law):
    """dp_c/dS (Pa) of the program's smooth retention, an exact.Retention, as a function of S."""

    def slope(S):
        share = 1 - np.asarray(S, float)
        low, high = np.full(share.shape, -1e3 * law.p0), np.full(share.shape, 1e6 * law.p0)
        for _ in range(200):
            middle = 0.5 * (low + high)
            wetter = law.gas_share(middle) > share
            low, high = np.where(wetter, low, middle), np.where(wetter, middle, high)
        pc, step = 0.5 * (low + high), 1e-4 * law.p0
        return -1 / difference(law.gas_share, pc, step)

    return slope


# ---------------------------------------------------------------------------------------- Buckley and Leverett
@dataclass(frozen=True)
class BuckleyLeverett:
    """1-D displacement without capillary pressure and gravity, incompressible: phi S_t + q f(S)_x = 0, x >= 0.

    The inlet holds S_inlet, the medium has S_initial; either may be the larger.  f is the fractional flow of water.
    Buckley and Leverett (1942), front by the tangent of Welge (1952).
    """

    relperm: Corey
    mu_w: float  # Pa s
    mu_g: float
    phi: float
    q: float  # total flux, m/s
    S_inlet: float
    S_initial: float

    def f(self, S):
        """Fractional flow of water, -."""
        w, g = self.relperm.krw(S) / self.mu_w, self.relperm.krg(S) / self.mu_g
        return w / (w + g)

    def f_slope(self, S):
        w, g = self.relperm.krw(S) / self.mu_w, self.relperm.krg(S) / self.mu_g
        dw, dg = self.relperm.slopes(S)
        return (dw / self.mu_w * g - w * dg / self.mu_g) / (w + g) ** 2

    @property
    def S_front(self):
        """S just behind the front: the steepest chord of f from S_initial."""
        S0, f0 = self.S_initial, self.f(self.S_initial)
        S = S0 + (self.S_inlet - S0) * np.linspace(0, 1, 4001)[1:]
        k = int(np.argmax((self.f(S) - f0) / (S - S0)))
        if k == len(S) - 1:
            return self.S_inlet  # nothing but a front
        if k == 0:
            return self.S_initial  # no front
        return bisect(lambda s: self.f_slope(s) - (self.f(s) - f0) / (s - S0), S[k - 1], S[k + 1])

    @property
    def front_speed(self):
        """m/s."""
        S, S0 = self.S_front, self.S_initial
        slope = self.f_slope(S) if S == S0 else (self.f(S) - self.f(S0)) / (S - S0)
        return self.q / self.phi * float(slope)

    def front(self, t):
        """Position of the front, m."""
        return self.front_speed * np.asarray(t, float)

    def position(self, S, t):
        """x (m) of the saturations S between S_front and S_inlet."""
        return self.q / self.phi * self.f_slope(S) * np.asarray(t, float)

    def saturation(self, x, t):
        """S(x, t)."""
        x, t = np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float))
        speed = x / np.maximum(t, 1e-300) * self.phi / self.q  # = f'(S) behind the front
        low, high = np.full(x.shape, self.S_inlet), np.full(x.shape, self.S_front)  # f' grows from low to high
        for _ in range(60):
            middle = 0.5 * (low + high)
            slow = self.f_slope(middle) < speed
            low, high = np.where(slow, middle, low), np.where(slow, high, middle)
        return np.where((x < self.front_speed * t) & (t > 0), 0.5 * (low + high), self.S_initial)


# ---------------------------------------------------------------------------------------- McWhorter and Sunada
class McWhorterSunada:
    """Imbibition into a half space x >= 0 under capillary pressure, incompressible, no gravity: S depends on x/sqrt(t).

    The inlet holds S_inlet, the medium S_initial; water enters at q_w(0, t) = A t^(-1/2), and the total flux is
    R q_w(0, t): R = 0 counter-current (as much gas leaves as water enters), R > 0 with gas also pushed ahead;
    R f(S_inlet) < 1.
    With g = q_w/q_w(0) and D = -k f (k_rg/mu_g) dp_c/dS the equation is

        g'' = -phi D/(2 A^2 (g - R f)),   x = 2 A/phi g' sqrt(t),
        g(S_inlet) = 1,  g'(S_inlet) = 0,  g(S_initial) = R f(S_initial).

    McWhorter and Sunada (1990), whose fixed-point iteration this is, damped; midpoint rule on cells that are fine at
    both ends, where D or its slope may be singular.

    phi (-), k (m^2), mu_w, mu_g (Pa s), krw(S), krg(S), dpc_dS(S) (Pa) functions of arrays.
    Attributes: A (m/s^(1/2)); S, g and xi = x/sqrt(t) at the middles of the cells, S rising.
    """

    def __init__(self, phi, k, mu_w, mu_g, krw, krg, dpc_dS, S_inlet, S_initial, R=0.0, cells=4000, tol=1e-13):
        if not S_inlet > S_initial:
            raise ValueError("imbibition needs S_inlet > S_initial")
        self.phi, self.S_inlet, self.S_initial, self.R = phi, S_inlet, S_initial, R

        def flow(S):
            return (krw(S) / mu_w) / (krw(S) / mu_w + krg(S) / mu_g)

        self.f, self.D = flow, lambda S: -k * flow(S) * krg(S) / mu_g * dpc_dS(S)
        y = np.linspace(0, 1, cells + 1)
        y = y**3 * (10 - 15 * y + 6 * y**2)
        edges = S_initial + (S_inlet - S_initial) * y
        S, dS = 0.5 * (edges[1:] + edges[:-1]), np.diff(edges)
        f, D, f0 = flow(S), self.D(S), float(flow(np.array(S_initial)))
        if R * float(flow(np.array(S_inlet))) >= 1:
            raise ValueError("R f(S_inlet) must be below 1")

        def above(values):
            """Integral from the middle of each cell to S_inlet."""
            return np.cumsum((values * dS)[::-1])[::-1] - 0.5 * values * dS

        share = (S - S_initial) / (S_inlet - S_initial)
        g = R * f + (1 - R * f) * share  # any start above R f
        for _ in range(10000):
            K = D / (g - R * f)
            A2 = phi / (2 * (1 - R * f0)) * np.sum((S - S_initial) * K * dS)
            new = 1 - phi / (2 * A2) * (above(S * K) - S * above(K))
            new = np.maximum(new, R * f + 1e-3 * (g - R * f))
            change, g = np.max(np.abs(new - g)), 0.5 * (g + new)
            if change < tol:
                break
        else:
            raise ArithmeticError(f"no convergence, last change {change:g}")
        self.A, self.S, self.g = math.sqrt(A2), S, g
        self.xi = above(D / (g - R * f)) / self.A

    def position(self, S, t):
        """x (m) where the saturation is S."""
        xi = np.interp(S, np.append(self.S, self.S_inlet), np.append(self.xi, 0.0))
        return xi * np.sqrt(np.asarray(t, float))

    def saturation(self, x, t):
        """S(x, t); S_initial beyond the front and at t <= 0."""
        x, t = np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float))
        xi = x / np.sqrt(np.maximum(t, 1e-300))
        nodes, values = np.append(0.0, self.xi[::-1]), np.append(self.S_inlet, self.S[::-1])
        return np.interp(xi, nodes, values, right=self.S_initial)

    def inlet_flux(self, t):
        """q_w(0, t), m/s."""
        return self.A / np.sqrt(np.asarray(t, float))

    def imbibed(self, t):
        """Water that has entered, m^3/m^2: 2 A sqrt(t)."""
        return 2 * self.A * np.sqrt(np.asarray(t, float))


# ---------------------------------------------------------------------------------------- one fluid
def diffusivity(k, mu, storage):
    """c (m^2/s) of c p_xx = p_t: k (m^2), mu (Pa s), storage (1/Pa; rigid: phi/Kw, column: phi/Kw + 1/M)."""
    return k / (mu * storage)


def half_space_pressure(x, t, c, p0, p1):
    """Half space x >= 0, initially at p0, surface kept at p1 (Pa)."""
    return half_space(x, t, c, p0, p1)


def half_space_injection(x, t, c, mobility, p0, q):
    """The same with the Darcy flux q (m/s, positive inwards) through the surface; mobility k/mu (m^2/(Pa s))."""
    return half_space_flux(x, t, c, mobility, p0, q)


def column_pressure(x, t, L, c, p0, p_left, p_right):
    """0 <= x <= L, initially at p0, ends kept at p_left and p_right (Pa).  Carslaw and Jaeger (1959), ch. 3."""
    x, t = np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float))
    n = math.pi * np.arange(1, TERMS + 1)
    sign = np.where(np.arange(1, TERMS + 1) % 2, -1.0, 1.0)
    weight = 2 / n * ((p0 - p_left) - (p0 - p_right) * sign)
    decay = np.exp(-(n**2) * c * np.maximum(t[..., None], 0) / L**2)
    p = p_left + (p_right - p_left) * x / L + np.sum(weight * np.sin(n * x[..., None] / L) * decay, axis=-1)
    return np.where(t > 0, p, p0)


# ---------------------------------------------------------------------------------------- poroelastic cylinder
@dataclass(frozen=True)
class PoroCylinder:
    """Solid poroelastic cylinder in plane strain (u_z = 0), drained at r = R, under the lateral pressure P from t = 0.

    Biot coefficient `biot`, storage at constant strain S (1/Pa; phi/Kw for incompressible grains, 0 for an
    incompressible fluid too).  The pore pressure on the axis first rises (Mandel-Cryer).  In the Laplace domain

        C = -P M/s / (a - b I1(z)/(z I0(z))),  p = -B C (1 - I0(z r/R)/I0(z)),  z = R sqrt(s/c),
        M e = biot p + C,  e = div u,  B = biot/(biot^2 + M S),  a = lambda + G + G biot B,  b = 2 G biot B,

    whose poles are the roots of a beta J0(beta) = b J1(beta), z = i beta.  Derived from Biot (1941) as Mandel's problem
    is by Detournay and Cheng (1993), and checked against finite elements below.
    """

    R: float  # m
    P: float  # Pa, compression-positive
    E: float  # Pa, drained
    nu: float
    storage: float  # 1/Pa
    mobility: float  # k/mu, m^2/(Pa s)
    biot: float = 1.0
    terms: int = TERMS

    @property
    def G(self):
        return self.E / (2 * (1 + self.nu))

    @property
    def M(self):
        """lambda + 2 G, Pa."""
        return constrained_modulus(self.E, self.nu)

    @property
    def B(self):
        return self.biot / (self.biot**2 + self.M * self.storage)

    @property
    def skempton(self):
        """Undrained dp/d(mean total stress), -."""
        bulk = self.E / (3 * (1 - 2 * self.nu))
        return self.biot / (self.biot**2 + bulk * self.storage)

    @property
    def c(self):
        """Consolidation coefficient, m^2/s."""
        return self.mobility * self.M * self.B / self.biot

    @property
    def _ab(self):
        return self.M - self.G + self.G * self.biot * self.B, 2 * self.G * self.biot * self.B

    def roots(self):
        """(terms,) beta_n."""
        a, b = self._ab
        return bessel_roots(lambda z: b * J1(z) - a * z * J0(z), self.terms)

    def _series(self, weight, r, t):
        """Sum of weight(beta, r/R) exp(-beta^2 c t/R^2)/(a beta J1 + b J0 - 2 a J0)."""
        z, (a, b) = self.roots(), self._ab
        r, t = (v[..., None] for v in np.broadcast_arrays(np.asarray(r, float), np.asarray(t, float)))
        decay = np.exp(-(z**2) * self.c * np.maximum(t, 0) / self.R**2)
        return np.sum(weight(z, r / self.R) * decay / (a * z * J1(z) + (b - 2 * a) * J0(z)), axis=-1)

    def initial_pressure(self):
        """Pore pressure (Pa) just after loading, uniform."""
        return self.P * self.B * self.M / self._ab[0]

    def pressure(self, r, t):
        """Excess pore pressure, Pa."""
        s = self._series(lambda z, x: J0(z * x) - J0(z), r, t)
        start = self.initial_pressure() * (np.asarray(r) < self.R)
        return np.where(np.asarray(t) > 0, 2 * self.P * self.M * self.B * s, start)

    def displacement(self, r, t):
        """Radial displacement (m), negative = inwards; undrained at t = 0."""
        r = np.asarray(r, float)
        drained = -self.P * r / (2 * (self.M - self.G))
        ab = self.biot * self.B
        s = self._series(lambda z, x: 2 * ab * J1(z * x) / z + (1 - ab) * J0(z) * x, r, t)
        undrained = -self.P * r * (1 - ab) / (2 * self._ab[0])
        return np.where(np.asarray(t) > 0, drained + self.P * self.R * s, undrained)


# ---------------------------------------------------------------------------------------- self-check
def upwind(b, length, cells, t_end):
    """S at the middles of the cells by the explicit upwind method (f' >= 0)."""
    dx, S = length / cells, np.full(cells, b.S_initial)
    top = np.max(b.f_slope(np.linspace(min(b.S_inlet, b.S_initial), max(b.S_inlet, b.S_initial), 2001)))
    steps = math.ceil(t_end * b.q / b.phi * top / (0.95 * dx))
    for _ in range(steps):
        S = S - t_end / steps * b.q / (b.phi * dx) * np.diff(b.f(np.concatenate(([b.S_inlet], S))))
    return S


def shoot(m, steps=4000):
    """A of a McWhorterSunada by shooting: Runge-Kutta for g from S_inlet down, bisection on A."""
    low, width = m.S_initial, m.S_inlet - m.S_initial
    y = np.linspace(0, 1, 2 * steps + 1)
    S, jac = low + width * y**2 * (3 - 2 * y), width * 6 * y * (1 - y)  # dS/dy
    f = m.f(S)
    D = np.zeros_like(S)
    D[1:-1] = m.D(S[1:-1])
    D = D * jac  # so that D dS/dy -> 0 at both ends

    def end(A):
        """g - R f reaches zero at this y, or minus its value at y = 0."""
        g, w, h = 1.0, 0.0, -1.0 / steps  # w = dg/dS
        factor = m.phi / (2 * A**2)

        def rate(k, g, w):
            return w * jac[k], -factor * D[k] / max(g - m.R * f[k], 1e-12)

        for n in range(2 * steps, 1, -2):
            g1, w1 = rate(n, g, w)
            g2, w2 = rate(n - 1, g + 0.5 * h * g1, w + 0.5 * h * w1)
            g3, w3 = rate(n - 1, g + 0.5 * h * g2, w + 0.5 * h * w2)
            g4, w4 = rate(n - 2, g + h * g3, w + h * w3)
            g, w = g + h / 6 * (g1 + 2 * g2 + 2 * g3 + g4), w + h / 6 * (w1 + 2 * w2 + 2 * w3 + w4)
            if g <= m.R * f[n - 2]:
                return y[n - 2]
        return -(g - m.R * f[0])

    return bisect(end, 0.5 * m.A, 2 * m.A, 24)


def imbibe(m, length, cells, t_end):
    """(S at the middles of the cells, water entered) by implicit finite volumes, R = 0, Newton's method, growing steps.

    Written for the Kirchhoff potential, the integral of D, which is smooth where D is not.
    """
    dx = length / cells
    table = np.linspace(m.S_initial, m.S_inlet, 20001)
    mid = 0.5 * (table[1:] + table[:-1])
    potential = np.concatenate(([0.0], np.cumsum(m.D(mid) * np.diff(table))))
    top, S, entered = potential[-1], np.full(cells, m.S_initial), 0.0
    slope = np.diff(potential) / np.diff(table)
    times = t_end * np.linspace(0, 1, 401) ** 2
    for dt in np.diff(times):
        old = S
        S = np.maximum(S, m.S_initial + 1e-12)
        for _ in range(60):
            k = np.clip(np.searchsorted(table, S) - 1, 0, len(slope) - 1)
            P, D = potential[k] + slope[k] * (S - table[k]), slope[k]
            q = np.concatenate(([2 * (top - P[0])], P[:-1] - P[1:], [0.0])) / dx
            residual_ = m.phi * dx * (S - old) + dt * np.diff(q)
            main = m.phi * dx + dt / dx * D * np.where(np.arange(cells) == 0, 3.0, 2.0)
            main[-1] -= dt / dx * D[-1]
            step = solve_tridiagonal(-dt / dx * D[:-1], main, -dt / dx * D[1:], -residual_)
            S = np.clip(S + step, m.S_initial, m.S_inlet)
            if np.max(np.abs(step)) < 1e-11:
                break
        entered += dt * q[0]
    return S, entered


def solve_tridiagonal(lower, main, upper, b):
    """Thomas' algorithm."""
    main, b = list(main), list(b)
    for i in range(1, len(b)):
        w = lower[i - 1] / main[i - 1]
        main[i] -= w * upper[i - 1]
        b[i] -= w * b[i - 1]
    b[-1] /= main[-1]
    for i in range(len(b) - 2, -1, -1):
        b[i] = (b[i] - upper[i] * b[i + 1]) / main[i]
    return np.array(b)


def cylinder_elements(m, cells, times):
    """p at the middles of the cells (len(times), cells), u at the edges, by linear elements for u, finite volumes for p.

    Exact in time: with u eliminated the pressures obey H p_t = -K p, both symmetric.  Stresses in their primitive form.
    """
    edge = np.linspace(0, m.R, cells + 1)
    r, dr, lam = 0.5 * (edge[1:] + edge[:-1]), m.R / cells, m.M - 2 * m.G
    volume = r * dr
    err, ett = np.zeros((cells, cells + 1)), np.zeros((cells, cells + 1))
    i = np.arange(cells)
    err[i, i], err[i, i + 1] = -1 / dr, 1 / dr
    ett[i, i], ett[i, i + 1] = 0.5 / r, 0.5 / r
    w = volume[:, None]
    stiff = err.T @ (w * (m.M * err + lam * ett)) + ett.T @ (w * (lam * err + m.M * ett))
    couple = m.biot * ((err + ett) * w).T
    load = np.zeros(cells + 1)
    load[-1] = -m.P * m.R
    stiff, couple, load = stiff[1:, 1:], couple[1:], load[1:]  # u = 0 on the axis
    inverse_Q, inverse_f = np.linalg.solve(stiff, couple), np.linalg.solve(stiff, load)
    H = couple.T @ inverse_Q + m.storage * np.diag(volume)
    start = np.linalg.solve(H, -couple.T @ inverse_f)
    link = m.mobility * edge[1:-1] / dr
    K = np.diag(np.concatenate((link, [m.mobility * m.R / (0.5 * dr)])) + np.concatenate(([0], link)))
    K -= np.diag(link, 1) + np.diag(link, -1)
    root = np.linalg.cholesky(H)
    half = np.linalg.solve(root, K)
    values, modes = np.linalg.eigh(np.linalg.solve(root, half.T))
    y = modes.T @ (root.T @ start)
    p = np.array([np.linalg.solve(root.T, modes @ (np.exp(-values * t) * y)) for t in times])
    u = inverse_f + p @ inverse_Q.T
    return r, p, edge[1:], u


def _check_buckley(check):
    b = BuckleyLeverett(Corey(), 1e-3, 1e-3, 0.3, 1e-6, 1.0, 0.0)
    check("quadratic laws, equal viscosities: S_front off 1/sqrt(2)", abs(b.S_front - math.sqrt(0.5)), 1e-12)
    cases = {
        "water drives gas": BuckleyLeverett(Corey(0.2, 0.05, 4, 2), 1e-3, 2e-5, 0.3, 1e-6, 0.95, 0.3),
        "inlet below its end point": BuckleyLeverett(Corey(0.1, 0.1, 2, 3), 1e-3, 5e-4, 0.3, 1e-6, 0.8, 0.15),
        "gas drives water": BuckleyLeverett(Corey(0.2, 0.0, 3, 2), 1e-3, 1e-4, 0.3, 1e-6, 0.3, 1.0),
    }
    for name, b in cases.items():
        t, S = 0.5 / b.front_speed, b.S_front
        check(f"{name}: slope of Welge's tangent - f'", abs(b.f_slope(S) * b.q / b.phi / b.front_speed - 1), 1e-9)
        S = np.linspace(b.S_front, b.S_inlet, 2001)
        stored = b.phi * (np.trapz(b.position(S, t), S) + b.front(t) * (b.S_front - b.S_initial))  # of (S - S_initial) dx
        entered = b.q * t * (b.f(b.S_inlet) - b.f(b.S_initial))
        check(f"{name}: stored water = water in - out", abs(stored / entered - 1), 1e-6)
        check(f"{name}: S(x(S)) - S", np.max(np.abs(b.saturation(b.position(S[1:-1], t), t) - S[1:-1])), 1e-7)
        off = []
        for cells in (250, 1000):
            x = (np.arange(cells) + 0.5) / cells
            off.append(np.mean(np.abs(upwind(b, 1.0, cells, t) - b.saturation(x, t))))
        check(f"{name}: mean distance from 1000 upwind cells", off[1], 4e-3)
        check(f"{name}: the same, 250 over 1000 cells", off[0] / off[1], (2.2, 5.0))


def _check_imbibition(check):
    corey, mu_w, mu_g, phi, k = Corey(0.1, 0.05, 3, 2), 1e-3, 4e-4, 0.3, 1e-13
    law = Retention(5e3, 0.45, 0.1, 0.05)
    cases = {
        "van Genuchten": (van_genuchten_slope(5e3, 0.45, 0.1, 0.05), 0.9, 0.0),
        "Brooks-Corey": (brooks_corey_slope(5e3, 2.0, 0.1, 0.05), 0.9, 0.0),
        "Brooks-Corey, R = 0.6": (brooks_corey_slope(5e3, 2.0, 0.1, 0.05), 0.9, 0.6),
        "the program's retention": (retention_slope(law), 0.94, 0.0),
    }
    for name, (slope, S_inlet, R) in cases.items():
        make = lambda n: McWhorterSunada(phi, k, mu_w, mu_g, corey.krw, corey.krg, slope, S_inlet, 0.2, R, n)
        m, coarse = make(4000), make(2000)
        check(f"{name}: A, change from 2000 to 4000 cells", abs(coarse.A / m.A - 1), 1e-6)
        check(f"{name}: A off shooting", abs(shoot(m) / m.A - 1), 3e-5)
        S = np.concatenate(([m.S_initial], m.S, [m.S_inlet]))
        xi = np.concatenate(([m.xi[0]], m.xi, [0.0]))
        stored = phi * (-np.trapz(S - m.S_initial, xi))
        f0 = float(m.f(np.array(m.S_initial)))
        check(f"{name}: stored = imbibed", abs(stored / (m.imbibed(1.0) * (1 - R * f0)) - 1), 1e-5)
        # flux at mid-profile: q_w = R q0 f - D S_x
        n = len(m.S) // 2
        S_x = (m.S[n + 1] - m.S[n - 1]) / (m.xi[n + 1] - m.xi[n - 1])
        q = R * m.A * m.f(m.S[n]) - m.D(m.S[n]) * S_x
        check(f"{name}: g A = R A f - D S_x half way", abs(q / (m.g[n] * m.A) - 1), 1e-5)
        if R == 0:
            t, length = 1e5, 1.3 * m.xi[0] * math.sqrt(1e5)
            S, entered = imbibe(m, length, 200, t)
            x = (np.arange(200) + 0.5) / 200 * length
            check(f"{name}: mean distance from 200 finite volumes", np.mean(np.abs(S - m.saturation(x, t))), 5e-4)
            check(f"{name}: imbibed water off them", abs(entered / m.imbibed(t) - 1), 3e-3)
    S = np.array([0.3, 0.6, 0.9])
    slope = [difference(lambda s: law.invert(1 - s), s, 1e-4) for s in S]
    check("retention_slope = slope of the inverse", np.max(np.abs(slope / retention_slope(law)(S) - 1)), 1e-6)


def _check_diffusion(check):
    c, L = 1e-4, 1.0
    p = lambda x, t: column_pressure(x, t, L, c, 3.0, 1.0, 2.0)
    check("column: residual of the equation", max(residual(p, x, t, c) for x in (0.2, 0.7) for t in (300, 3000)), 1e-6)
    check("column: ends, initial value, steady state",
          max(abs(p(0.0, 500) - 1), abs(p(L, 500) - 2), abs(p(0.4, 0) - 3), abs(p(0.4, 1e6) - 1.4)), 1e-12)  # fmt: skip
    x = np.linspace(0, 0.2, 9)
    off = np.max(np.abs(p(x, 50.0) - half_space_pressure(x, 50.0, c, 3.0, 1.0)))
    check("column = half space at first", off, 1e-10)
    flow = lambda s: half_space_injection(s, 500.0, c, 1e-12, 1e5, 1e-7)
    check("injection: Darcy flux at the surface", abs(-1e-12 * difference(flow, 0.0, 1e-3) / 1e-7 - 1), 1e-8)


def _check_cylinder(check):
    bodies = {
        "incompressible": PoroCylinder(0.5, 1e5, 9e7, 0.2, 0.0, 1e-12),
        "compressible water": PoroCylinder(0.5, 1e5, 9e8, 0.3, 0.3 / 2.2e9, 1e-12),
        "compressible grains too": PoroCylinder(0.5, 1e5, 5e9, 0.1, 2e-10, 1e-12, 0.7),
    }
    for name, m in bodies.items():
        unit, lam = m.R**2 / m.c, m.M - 2 * m.G
        z, (a, b) = m.roots(), m._ab
        check(f"{name}: residual of the roots", np.max(np.abs(a * J0(z) - b * J1(z) / z)) / a, 1e-13)
        nu_u = (3 * m.nu + m.biot * m.skempton * (1 - 2 * m.nu)) / (3 - m.biot * m.skempton * (1 - 2 * m.nu))
        p0 = m.P * m.skempton * 2 * (1 + nu_u) / 3
        check(f"{name}: p(0+) = 2/3 B_Skempton (1 + nu_u) P", abs(m.initial_pressure() / p0 - 1), 1e-12)
        early = m.pressure(0.4 * m.R, 1e-4 * unit)
        check(f"{name}: p at 1e-4 R^2/c, above its start by", early / p0 - 1, (0, 0.02))
        u0 = -m.P * m.R * (1 - 2 * nu_u) / (2 * m.G)
        check(f"{name}: u(R, 0+) = -P R (1 - 2 nu_u)/2G", abs(m.displacement(m.R, 0) - u0) / (m.P * m.R / m.G), 1e-12)
        check(f"{name}: axis rises above its start by", m.pressure(0, 0.05 * unit) / p0 - 1, (1e-3, 0.5))
        # equations at a point: mass balance, equilibrium; total radial stress at the surface
        t, x, h = 0.07 * unit, 0.6 * m.R, 1e-3 * m.R
        div = lambda r, s: difference(lambda y: y * m.displacement(y, s), r, h) / r
        rate = difference(lambda s: m.biot * div(x, s) + m.storage * m.pressure(x, s), t, 1e-2 * t)
        flow = difference(lambda r: r * difference(lambda y: m.pressure(y, t), r, h), x, h) / x * m.mobility
        check(f"{name}: storage rate = inflow", abs(rate / flow - 1), 1e-5)
        force = m.M * difference(lambda r: div(r, t), x, h) / (m.biot * difference(lambda r: m.pressure(r, t), x, h))
        check(f"{name}: equilibrium", abs(force - 1), 1e-5)
        u = lambda r: m.displacement(r, t)
        stress = m.M * difference(u, m.R, h) + lam * u(m.R) / m.R - m.biot * m.pressure(m.R, t)
        check(f"{name}: sigma_rr(R) = -P", abs(stress / -m.P - 1), 1e-5)
        times, off = np.array([0.01, 0.05, 0.2, 0.6]) * unit, []
        for cells in (100, 200):
            r, p, edge, ue = cylinder_elements(m, cells, times)
            dp = np.max(np.abs(m.pressure(r, times[:, None]) - p)) / p0
            du = np.max(np.abs(m.displacement(edge, times[:, None]) - ue)) / abs(m.displacement(m.R, 1e9 * unit))
            off.append((dp, du))
        check(f"{name}: p off 200 elements", off[1][0], 1e-3)
        check(f"{name}: u off 200 elements", off[1][1], 1e-3)
        check(f"{name}: both fall with h, 100 over 200, p", off[0][0] / off[1][0], (3.0, 5.0))


def self_check():
    from common import check, finish

    for part in (_check_buckley, _check_imbibition, _check_diffusion, _check_cylinder):
        part(check)
    finish()


if __name__ == "__main__":
    sys.exit(self_check())
