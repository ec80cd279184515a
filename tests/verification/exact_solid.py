#!/usr/bin/env python3
"""Exact solutions of solids: thick cylinder, column under gravity, elastic waves, wave in a saturated column.

Conventions: SI units, stress tension-positive, loads, pressures of a boundary and pore pressure compression-positive,
displacements positive along the axis.  x, r, z and t may be scalars or arrays; they are broadcast against each other.
M = E (1-nu)/((1+nu)(1-2nu)) is the constrained modulus (exact.constrained_modulus).

Run as a program it checks every solution against its equation or an independent numerical solution.
"""
import math
import sys
from dataclasses import dataclass
from typing import Callable

import numpy as np

from exact import column_displacement, column_volume_ratio, constrained_modulus
from exact_heat import difference, hankel_terms


# ---------------------------------------------------------------------------------------- thick cylinder
def thick_cylinder(r, a, b, p_in, p_out, E, nu):
    """u_r (m), sigma_rr, sigma_tt, sigma_zz (Pa) of a cylinder a <= r <= b in plane strain, small strain, under the
    pressures p_in at a and p_out at b (Pa).  Lame (1852); Timoshenko and Goodier (1951), art. 26.  a = 0: solid cylinder."""
    r = np.asarray(r, float)
    mean = (p_in * a**2 - p_out * b**2) / (b**2 - a**2)
    part = (p_in - p_out) * a**2 * b**2 / (b**2 - a**2)
    with np.errstate(divide="ignore", invalid="ignore"):
        inner = np.where(part == 0, 0.0, part / r**2)
    u = (1 + nu) / E * r * ((1 - 2 * nu) * mean + inner)
    return u, mean - inner, mean + inner, np.full(r.shape, 2 * nu * mean)


# ---------------------------------------------------------------------------------------- column under gravity
def gravity_column(Y, H, rho0, g, M):
    """u (m, positive upwards), J (-), sigma (Pa) of a column fixed at its base, at rest under gravity, any strain.

    sigma = M ln J is the Cauchy stress, in uniaxial strain also the nominal one, so sigma_Y = rho0 g exactly.
    Y (m) height in the undeformed column, H its length, rho0 (kg/m^3) density per undeformed volume, g (m/s^2, downwards).
    """
    J = column_volume_ratio(Y, H, rho0, g, M)
    return column_displacement(Y, H, rho0, g, M), J, M * np.log(J)


# ---------------------------------------------------------------------------------------- waves in a dry column
def _triangle(x, L):
    """T(x) of slope +-1 and period 4 L with T(x) = x on [-L, L]."""
    y = np.mod(np.asarray(x, float) + L, 4 * L)
    return np.where(y <= 2 * L, y - L, 3 * L - y)


def _triangle_slope(x, L):
    return np.where(np.mod(np.asarray(x, float) + L, 4 * L) < 2 * L, 1.0, -1.0)


def wave_load(x, t, L, M, rho, q):
    """u (m), v (m/s), sigma (Pa) of an elastic column, fixed at x = 0, under the load q put on x = L at t = 0 and held.

    Small strain, rho u_tt = M u_xx, c = sqrt(M/rho).  D'Alembert: u = -(q/M) [x - (T(x - ct) + T(x + ct))/2] with the
    triangle wave T, whose Fourier series is the sum of the modes; e.g. Graff (1975), 2.
    """
    x, ct = np.asarray(x, float), math.sqrt(M / rho) * np.maximum(np.asarray(t, float), 0)
    left, right = _triangle_slope(x - ct, L), _triangle_slope(x + ct, L)
    u = -q / M * (x - 0.5 * (_triangle(x - ct, L) + _triangle(x + ct, L)))
    return u, 0.5 * q / math.sqrt(M * rho) * (right - left), -q * (1 - 0.5 * (left + right))


def wave_mode(x, t, L, M, rho, v0):
    """u, v, sigma of the same column without load that starts with the velocity v0 sin(pi x/2L): its first mode."""
    k = 0.5 * math.pi / L
    w = k * math.sqrt(M / rho)
    x, t = np.asarray(x, float), np.asarray(t, float)
    shape, slope = np.sin(k * x), k * np.cos(k * x)
    return v0 / w * shape * np.sin(w * t), v0 * shape * np.cos(w * t), M * v0 / w * slope * np.sin(w * t)


# ---------------------------------------------------------------------------------------- saturated half space
def bessel_ie(n, x):
    """exp(-x) I_n(x), n = 0 or 1, x >= 0, to 1e-14: trapezoid rule up to 50, asymptotic series above (DLMF 10.40.1)."""
    x = np.asarray(x, float)
    small, big = np.minimum(x, 50.0), np.maximum(x, 50.0)
    angles = 2 * math.pi * np.arange(96) / 96
    near = sum(math.cos(n * y) * np.exp(small * (math.cos(y) - 1)) for y in angles) / 96
    far = sum((-1) ** k * a / big**k for k, a in enumerate(hankel_terms(n)))
    return np.where(x <= 50, near, far / np.sqrt(2 * math.pi * big))


@dataclass(frozen=True)
class SaturatedColumn:
    """Wave in a saturated half space z >= 0 with incompressible grains and water, small strain, uniaxial, without gravity.

    Its free-draining surface z = 0 carries the load q(t) (Pa, q = 0 for t < 0; smooth for t > 0, and on the scale `scale`
    (s) if it oscillates).  z is the depth, u and v of the skeleton are positive downwards.  With n_s v_s + n_f v_w = 0,
    a = [n_s rho_s + (n_s/n_f)^2 n_f rho_w]/M and b = mu/(k M):

        u_zz = a u_tt + b u_t,   u = 1/(M sqrt(a)) int_{z sqrt(a)}^t q(t-s) exp(-b s/2a) I0(b/2a sqrt(s^2 - a z^2)) ds.

    A column of length H is the same until the wave comes back, t < 2 H sqrt(a) - z sqrt(a).
    De Boer, Ehlers and Liu (1993).  step_load() and sine_load(), cosine_load() make q.
    """

    M: float  # Pa
    n_f: float  # porosity
    rho_s: float  # kg/m^3, of the grains
    rho_w: float
    mobility: float  # k/mu, m^2/(Pa s)
    load: Callable  # q(t), Pa, for arrays t >= 0
    scale: float = math.inf

    @property
    def drag(self):
        """mu/k, Pa s/m^2: force on the skeleton per volume and velocity of the skeleton."""
        return 1 / self.mobility

    @property
    def inertia(self):
        """a M, kg/m^3."""
        n_s = 1 - self.n_f
        return n_s * self.rho_s + n_s**2 / self.n_f * self.rho_w

    @property
    def a(self):
        return self.inertia / self.M

    @property
    def b(self):
        return self.drag / self.M

    def _nodes(self, start, end):
        """Gauss points and weights on [start, end]: panels that double from both ends, none longer than `scale`."""
        points, weights = np.polynomial.legendre.leggauss(16)
        span = end - start
        least = min(0.25, 0.1 * self.a / (self.b * span))  # the kernels vary in a/b
        graded = np.append(0.0, np.geomspace(least, 0.5, 1 + math.ceil(math.log2(0.5 / least))))
        even = np.linspace(0, 1, 1 + max(1, math.ceil(span / self.scale)))
        edges = start + span * np.unique(np.concatenate((graded, 1 - graded, even)))
        middle, half = 0.5 * (edges[1:] + edges[:-1]), 0.5 * np.diff(edges)
        return (middle[:, None] + half[:, None] * points).ravel(), (half[:, None] * weights).ravel()

    def _kernel(self, n, z, s):
        """exp(-b s/2a) I0(y) for n = 0, exp(-b s/2a) I1(y)/y for n = 1, with y = b/2a sqrt(s^2 - a z^2)."""
        rate, arrival = self.b / (2 * self.a), math.sqrt(self.a) * z
        root = np.sqrt(np.maximum((s - arrival) * (s + arrival), 0))
        y = np.maximum(rate * root, 1e-3 * n)  # I1(y)/y is 1/2 there to 1e-7
        return bessel_ie(n, y) / (y if n else 1.0) * np.exp(y - rate * root - rate * arrival**2 / (s + root))

    def _displacement(self, z, t):
        arrival = math.sqrt(self.a) * z
        if t <= arrival:
            return 0.0
        s, w = self._nodes(arrival, t)
        return float(np.sum(w * self.load(t - s) * self._kernel(0, z, s))) / (self.M * math.sqrt(self.a))

    def _stress(self, z, t):
        arrival, rate = math.sqrt(self.a) * z, self.b / (2 * self.a)
        if t < arrival or t <= 0:
            return 0.0
        front = math.exp(-rate * arrival) * float(self.load(np.array(t - arrival)))
        if t == arrival or z == 0:
            return -front
        s, w = self._nodes(arrival, t)
        return -front - arrival * rate**2 * float(np.sum(w * self.load(t - s) * self._kernel(1, z, s)))

    def _pressure(self, z, t):
        if t <= 0 or z == 0:
            return 0.0
        part, rate = (1 - self.n_f) / self.n_f * self.rho_w / self.inertia, self.drag / self.inertia
        arrival = min(math.sqrt(self.a) * z, t)
        total = 0.0
        for start, end in ((0.0, arrival), (arrival, t)):  # q + sigma' jumps when the wave arrives
            if end > start:
                s, w = self._nodes(start, end)
                total += float(np.sum(w * (self.load(s) + self.stress(z, s)) * np.exp(-rate * (t - s))))
        return part * (float(self.load(np.array(t))) + self._stress(z, t)) + (1 - part) * rate * total

    def displacement(self, z, t):
        """u (m) of the skeleton, positive downwards."""
        return np.vectorize(self._displacement, otypes=[float])(z, t)

    def stress(self, z, t):
        """Effective stress, Pa: -q(t) at the surface.  Its convolution has the kernel exp(-b s/2a) I1(y)/y."""
        return np.vectorize(self._stress, otypes=[float])(z, t)

    def pressure(self, z, t):
        """Pore pressure, Pa: the part of q + sigma' that is not spent on the skeleton's inertia.

        Laplace: p = (m s + mu/k)/(a M s + mu/k) (q + sigma'), m = n_s/n_f rho_w.
        """
        return np.vectorize(self._pressure, otypes=[float])(z, t)


def step_load(q):
    """q from t = 0 on."""
    return lambda t: np.where(np.asarray(t) >= 0, q, 0.0)


def sine_load(q, omega):
    """q sin(omega t)."""
    return lambda t: np.where(np.asarray(t) >= 0, q * np.sin(omega * np.asarray(t)), 0.0)


def cosine_load(q, omega):
    """q (1 - cos(omega t)), the load of de Boer, Ehlers and Liu's example."""
    return lambda t: np.where(np.asarray(t) >= 0, q * (1 - np.cos(omega * np.asarray(t))), 0.0)


# ---------------------------------------------------------------------------------------- self-check
def _check_cylinder(check):
    a, b, E, nu = 0.3, 0.8, 2e8, 0.3
    p_in, p_out = 2e6, 5e5
    M, lam = constrained_modulus(E, nu), E * nu / ((1 + nu) * (1 - 2 * nu))
    at = lambda r: thick_cylinder(r, a, b, p_in, p_out, E, nu)
    r = np.linspace(0.35, 0.75, 9)
    u, rr, tt, zz = at(r)
    strain = difference(lambda s: at(s)[0], r, 1e-3)
    check("thick cylinder: sigma_rr(a), sigma_rr(b)", max(abs(at(a)[1] / -p_in - 1), abs(at(b)[1] / -p_out - 1)), 1e-14)
    law = M * strain + lam * u / r - rr, lam * strain + M * u / r - tt, lam * (strain + u / r) - zz
    check("thick cylinder: stresses from u", np.max(np.abs(law)) / p_in, 1e-8)
    balance = difference(lambda s: at(s)[1], r, 1e-3) + (rr - tt) / r
    check("thick cylinder: equilibrium", np.max(np.abs(balance)) * a / p_in, 1e-8)
    solid = thick_cylinder(np.array([0.0, 0.5]), 0.0, b, 0.0, p_out, E, nu)
    check("solid cylinder: uniform stress", np.max(np.abs(np.array(solid[1:3]) / -p_out - 1)), 1e-14)
    check("tube of 1 mm in 1 m: p r/thickness", abs(thick_cylinder(1.0, 1.0, 1.001, 1e5, 0, E, nu)[2] / 1e8 - 1), 1e-3)


def _check_column(check):
    H, rho0, g, M = 10.0, 2000.0, 9.81, 5e5
    at = lambda Y: gravity_column(Y, H, rho0, g, M)
    Y = np.linspace(1, 9, 9)
    check("gravity column: J of the base", at(0.0)[1], (0.5, 0.9))
    check("gravity column: sigma_Y = rho0 g", np.max(np.abs(difference(lambda s: at(s)[2], Y, 0.01) / (rho0 * g) - 1)), 1e-9)
    check("gravity column: J = 1 + u_Y", np.max(np.abs(1 + difference(lambda s: at(s)[0], Y, 0.01) - at(Y)[1])), 1e-9)
    check("gravity column: fixed base, free top", max(abs(at(0.0)[0]), abs(at(H)[2]) / M), 1e-14)
    chain = H / 20000  # links that each carry what is above their middle
    J = np.exp(-rho0 * g * chain * (np.arange(20000) + 0.5) / M)
    check("gravity column: settlement of 20000 links", abs(np.sum(J - 1) * chain / at(H)[0] - 1), 1e-8)


def leapfrog(L, M, rho, q, v0, cells, steps):
    """u at the nodes after `steps` of dx/c, where central differences are exact; fixed at 0, loaded by q at L."""
    dx = L / cells
    dt = dx * math.sqrt(rho / M)
    x = np.linspace(0, L, cells + 1)

    def step(u, before, load):
        # a node and its ghost beyond the end: (u_ghost - u_inner)/(2 dx) = -load/M
        outer = np.append(u[1:], u[-2] - 2 * dx * load / M)
        new = outer + np.append(0.0, u[:-1]) - before
        new[0] = 0.0
        return new

    u, before = np.zeros(cells + 1), -dt * v0 * np.sin(0.5 * math.pi * x / L)
    before *= math.sin(0.5 * math.pi / cells) / (0.5 * math.pi / cells)  # the mode's exact u(-dt)
    before[-1] -= q * dx / M  # so that the end moves by half of the first kick, -q dx/M
    for _ in range(steps):
        u, before = step(u, before, q), u
    return x, u, steps * dt


def _check_waves(check):
    L, M, rho, q, v0 = 2.0, 1e7, 1800.0, 1e4, 0.1
    c = math.sqrt(M / rho)
    x = np.linspace(0, L, 41)
    k = math.pi * (np.arange(20000) + 0.5) / L
    for ct in (0.3 * L, 1.7 * L, 3.1 * L, 9.45 * L):
        u = wave_load(x, ct / c, L, M, rho, q)[0]
        modes = (-1.0) ** np.arange(20000) / k**2 * np.sin(k * x[:, None]) * np.cos(k * ct)
        series = -q / M * (x - 2 / L * np.sum(modes, axis=1))
        check(f"step load: u at ct = {ct / L:g} L off the sum of modes", np.max(np.abs(u - series)) / (2 * q * L / M), 1e-5)
    inside, t = np.array([0.31, 1.04, 1.9]), 0.9 * L / c
    both = {"step load": lambda s, r: wave_load(s, r, L, M, rho, q), "mode": lambda s, r: wave_mode(s, r, L, M, rho, v0)}
    for name, f in both.items():
        u, v, sigma = f(inside, t)
        rate, strain = difference(lambda r: f(inside, r)[0], t, 1e-4 * t), difference(lambda s: f(s, t)[0], inside, 1e-4)
        check(f"{name}: v = u_t", np.max(np.abs(rate - v)) / np.max(np.abs(v)), 1e-8)
        check(f"{name}: sigma = M u_x", np.max(np.abs(M * strain - sigma)) / np.max(np.abs(sigma)), 1e-8)
    x, u, t = leapfrog(L, M, rho, q, 0.0, 100, 337)
    off = np.max(np.abs(u - wave_load(x, t, L, M, rho, q)[0])) / (2 * q * L / M)
    check("step load: u off central differences (exact at dt = dx/c)", off, 1e-12)
    x, u, t = leapfrog(L, M, rho, 0.0, v0, 100, 337)
    off = np.max(np.abs(u - wave_mode(x, t, L, M, rho, v0)[0])) / (v0 * L / c)
    check("mode: u off central differences", off, 1e-12)
    check("mode: u_tt = c^2 u_xx",
          abs(difference(lambda r: wave_mode(0.7, r, L, M, rho, v0)[0], t, 1e-3 * L / c, 2)
              / (c**2 * difference(lambda s: wave_mode(s, t, L, M, rho, v0)[0], 0.7, 1e-3 * L, 2)) - 1), 1e-6)  # fmt: skip
    u, v, _ = wave_mode(np.linspace(0, L, 2001), 0.013, L, M, rho, v0)
    energy = np.trapz(rho * v**2 + M * np.gradient(u, L / 2000, edge_order=2) ** 2, dx=L / 2000) / (rho * v0**2 * L / 2)
    check("mode: energy kept", abs(energy - 1), 1e-5)


def talbot(F, t, terms=40):
    """Inverse Laplace transform of F at t by the fixed Talbot contour.  Abate and Valko (2004)."""
    r = 2 * terms / (5 * t)
    y = math.pi * np.arange(1, terms) / terms
    s = r * y * (1 / np.tan(y) + 1j)
    slope = 1 + 1j * (y + (y / np.tan(y) - 1) / np.tan(y))
    return r / terms * (0.5 * math.exp(r * t) * F(r + 0j).real + np.sum((np.exp(t * s) * F(s) * slope).real))


def _check_saturated(check):
    x = np.array([0.0, 0.3, 2.0, 9.0, 30.0])
    known = [np.i0(x) * np.exp(-x), difference(np.i0, x, 1e-3) * np.exp(-x)]
    check("I0, I1 off numpy's", max(np.max(np.abs(bessel_ie(n, x) - known[n])) for n in (0, 1)), 1e-9)
    jump = max(abs(bessel_ie(n, 50.0) - bessel_ie(n, 50.0 + 1e-12)) for n in (0, 1))
    check("I0, I1: jump where the method changes", jump, 1e-14)
    lame, shear, q, omega = 8.375e6, 5.583e6, 3e3, 75.0  # the example of de Boer, Ehlers and Liu (1993)
    base = dict(M=lame + 2 * shear, n_f=0.33, rho_s=2000.0, rho_w=1000.0, mobility=1e-2 / 1e4)
    pole = {"step": lambda s: q / s, "sine": lambda s: q * omega / (s**2 + omega**2),
            "1 - cosine": lambda s: q / s - q * s / (s**2 + omega**2)}  # fmt: skip
    loads = {"step": step_load(q), "sine": sine_load(q, omega), "1 - cosine": cosine_load(q, omega)}
    for name, load in loads.items():
        m = SaturatedColumn(**base, load=load, scale=1 / omega)
        kappa = lambda s: np.sqrt(m.a * s**2 + m.b * s)
        u = lambda s, z: pole[name](s) / (m.M * kappa(s)) * np.exp(-kappa(s) * z)
        stress = lambda s, z: -pole[name](s) * np.exp(-kappa(s) * z)
        extra = 0.67 / 0.33 * 1000.0  # from the momentum of water, integrated over depth
        p = lambda s, z: (extra * s**2 + m.drag * s) * pole[name](s) / (m.M * kappa(s) ** 2) * (1 - np.exp(-kappa(s) * z))
        points = [(z, t) for z in (0.0, 0.5, 2.0) for t in (0.06, 0.15)]
        for what, got, F in (("u", m.displacement, u), ("sigma'", m.stress, stress), ("p", m.pressure, p)):
            pairs = np.array([(float(got(z, t)), talbot(lambda s, z=z: F(s, z), t)) for z, t in points])
            off = np.max(np.abs(pairs[:, 0] - pairs[:, 1])) / np.max(np.abs(pairs))
            check(f"{name}: {what} off the inverted Laplace transform", off, 1e-7)
        worst = 0.0
        for z, t in ((0.3, 0.1), (1.5, 0.2)):
            h, d = 0.01, 4e-4
            speed = difference(lambda r: m.displacement(z, r), t, d)
            acceleration = difference(lambda r: m.displacement(z, r), t, d, 2)
            terms = difference(lambda y: m.displacement(y, t), z, h, 2), -m.a * acceleration, -m.b * speed
            worst = max(worst, abs(sum(terms)) / max(map(abs, terms)))
            slope = difference(lambda y: m.displacement(y, t), z, h)
            check(f"{name}: sigma' = M u_z at z = {z} m", abs(m.M * slope - m.stress(z, t)) / q, 1e-6)
            push, water = extra * acceleration + m.drag * speed, difference(lambda y: m.pressure(y, t), z, h)
            check(f"{name}: momentum of water at z = {z} m", abs(water / push - 1), 1e-5)
            force = difference(lambda y: m.stress(y, t) - m.pressure(y, t), z, h)
            mass = (1 - m.n_f) * (m.rho_s - m.rho_w)  # n_f v_w = -n_s v_s
            check(f"{name}: momentum of all at z = {z} m", abs(force - mass * acceleration) / abs(water), 1e-5)
        check(f"{name}: residual of the equation", worst, 1e-5)
        check(f"{name}: nothing before the wave", abs(float(m.displacement(5.0, 0.99 * 5 * math.sqrt(m.a)))), 0.0)
        w = SaturatedColumn(**{**base, "mobility": 1e3}, load=load, scale=1 / omega)
        speed = 1 / math.sqrt(w.a)  # without drag: u(z, t) = speed/M times the integral of q until t - z/speed
        s = np.linspace(0, 0.1 - 0.5 / speed, 20001)
        want = speed / w.M * np.trapz(load(s), s)
        check(f"{name}: no drag: d'Alembert's wave", abs(float(w.displacement(0.5, 0.1)) / want - 1), 1e-6)
    m = SaturatedColumn(**{**base, "mobility": 1e-11}, load=step_load(q))
    c = m.M * m.mobility
    want = 2 * q / m.M * math.sqrt(c * 100 / math.pi)
    check("step, much drag: u = Terzaghi's 2 q/M sqrt(c t/pi)", abs(float(m.displacement(0, 100.0)) / want - 1), 1e-4)
    want = q * math.erf(0.01 / (2 * math.sqrt(c * 0.5)))
    check("step, much drag: p = q erf(z/2 sqrt(c t))", abs(float(m.pressure(0.01, 0.5)) / want - 1), 1e-3)


def self_check():
    from common import check, finish

    for part in (_check_cylinder, _check_column, _check_waves, _check_saturated):
        part(check)
    finish()


if __name__ == "__main__":
    sys.exit(self_check())
