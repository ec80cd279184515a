#!/usr/bin/env python3
"""Exact solutions of heat conduction, with advection and with a moving front.

Conventions: SI units; temperatures in degC or K, as long as they agree; k conductivity (W/(m K)), kappa = k/C diffusivity
(m^2/s) with C the heat capacity per volume (J/(m^3 K)).  x, r and t may be scalars or arrays; they are broadcast
against each other.  At t <= 0 the initial temperature is returned.  Series have 400 terms: enough for kappa t/L^2 > 3e-5.

Run as a program it checks every solution against its equation or an independent numerical solution.
"""
import math
import sys
from dataclasses import dataclass

import numpy as np

from exact import ZERO_C, bisect

TERMS = 400  # of every series


# ---------------------------------------------------------------------------------------- special functions
erf = np.vectorize(math.erf, otypes=[float])
erfc = np.vectorize(math.erfc, otypes=[float])


def erfcx(z):
    """exp(z^2) erfc(z) for z >= -20, without overflow: by definition below 10, by its asymptotic series above."""
    z = np.asarray(z, float)
    small, big = np.minimum(z, 10.0), np.maximum(z, 10.0)
    term, series = np.ones_like(big), np.ones_like(big)
    for k in range(1, 16):
        term = -term * (2 * k - 1) / (2 * big**2)
        series = series + term
    return np.where(z < 10, np.exp(small**2) * erfc(small), series / (math.sqrt(math.pi) * big))


def hankel_terms(n, count=24):
    """a_k(n) of the asymptotic series of the Bessel functions of order n (DLMF 10.17.1)."""
    a = [1.0]
    for k in range(1, count):
        a.append(a[-1] * (4 * n**2 - (2 * k - 1) ** 2) / (8 * k))
    return np.array(a)


def bessel_j(n, x):
    """J_n(x), n = 0 or 1, x >= 0, to 1e-15 absolute.

    x <= 25: Bessel's integral by the trapezoid rule, which converges exponentially; above: Hankel's series.
    """
    x = np.asarray(x, float)
    small, big = np.minimum(x, 25.0), np.maximum(x, 25.0)
    near = sum(np.cos(n * angle - small * math.sin(angle)) for angle in 2 * math.pi * np.arange(64) / 64) / 64
    a, phase = hankel_terms(n), big - (0.5 * n + 0.25) * math.pi
    P = sum((-1) ** (k // 2) * a[k] / big**k for k in range(0, len(a), 2))
    Q = sum((-1) ** (k // 2) * a[k] / big**k for k in range(1, len(a), 2))
    return np.where(x <= 25, near, np.sqrt(2 / (math.pi * big)) * (np.cos(phase) * P - np.sin(phase) * Q))


def J0(x):
    return bessel_j(0, x)


def J1(x):
    return bessel_j(1, x)


def bessel_zeros(n, count):
    """The first zeros of J_n, n = 0 or 1, (count,): Newton's method from McMahon's series."""
    beta = (np.arange(1, count + 1) + 0.5 * n - 0.25) * math.pi
    z = beta - (4 * n**2 - 1) / (8 * beta)
    for _ in range(5):
        z = z + J0(z) / J1(z) if n == 0 else z - J1(z) / (J0(z) - J1(z) / z)
    return z


def bessel_roots(f, count):
    """The one root of f in each interval (j_1,k-1, j_0,k), k = 1, ..., count, with j_1,0 = 0; (count,)."""
    low, high = np.concatenate(([1e-12], bessel_zeros(1, count - 1))), bessel_zeros(0, count)
    sign = f(high) > 0
    for _ in range(100):
        middle = 0.5 * (low + high)
        upper = (f(middle) > 0) == sign
        low, high = np.where(upper, low, middle), np.where(upper, middle, high)
    return 0.5 * (low + high)


# ---------------------------------------------------------------------------------------- plane walls
def slab(x, t, L, kappa, T0, T1):
    """Slab 0 <= x <= L, insulated at x = 0, initially at T0, surface x = L kept at T1; also -L <= x <= L with both
    surfaces at T1.  Carslaw and Jaeger (1959), ch. 3."""
    Mn = math.pi * (np.arange(TERMS) + 0.5)
    x, t = (a[..., None] for a in np.broadcast_arrays(np.asarray(x, float), np.asarray(t, float)))
    sign = np.where(np.arange(TERMS) % 2, -1.0, 1.0)
    s = np.sum(2 * sign / Mn * np.cos(Mn * x / L) * np.exp(-(Mn**2) * kappa * np.maximum(t, 0) / L**2), axis=-1)
    return np.where(t[..., 0] > 0, T1 + (T0 - T1) * s, T0)


def _root_time(kappa, t):
    """2 sqrt(kappa t), with a tiny number for t <= 0."""
    return 2 * np.sqrt(kappa * np.maximum(np.asarray(t, float), 1e-300))


def half_space(x, t, kappa, T0, T1):
    """Half space x >= 0, initially at T0, surface kept at T1.  Carslaw and Jaeger (1959), ch. 2."""
    return T0 + (T1 - T0) * erfc(np.asarray(x, float) / _root_time(kappa, t))


def half_space_flux(x, t, kappa, k, T0, q):
    """The same with the heat flux q (W/m^2, positive into the solid) through the surface.  Carslaw and Jaeger (1959)."""
    x, w = np.asarray(x, float), _root_time(kappa, t)
    return T0 + q / k * (w / math.sqrt(math.pi) * np.exp(-((x / w) ** 2)) - x * erfc(x / w))


def half_space_convective(x, t, kappa, k, h, T0, Ta):
    """The same with the flux h (Ta - T) through the surface, h in W/(m^2 K).  Carslaw and Jaeger (1959), ch. 2."""
    x, w = np.asarray(x, float), _root_time(kappa, t)
    z = x / w
    return T0 + (Ta - T0) * (erfc(z) - np.exp(-(z**2)) * erfcx(z + 0.5 * h * w / k))


def thermal_velocity(q_w, C_w, C_m):
    """Velocity of a temperature front (m/s): Darcy flux q_w (m/s) times C_w/C_m, capacities per volume of water, mixture."""
    return q_w * C_w / C_m


def ogata_banks(x, t, v, kappa, T0, T1):
    """Half space x >= 0, initially at T0, inlet x = 0 kept at T1, water flowing in: T_t + v T_x = kappa T_xx.

    v thermal velocity (m/s, >= 0; thermal_velocity()), kappa = k_m/C_m (m^2/s).  Ogata and Banks (1961).
    """
    x, t = np.asarray(x, float), np.maximum(np.asarray(t, float), 1e-300)
    w = _root_time(kappa, t)
    z = (x - v * t) / w
    return T0 + 0.5 * (T1 - T0) * (erfc(z) + np.exp(-(z**2)) * erfcx((x + v * t) / w))


# ---------------------------------------------------------------------------------------- cylinders
def _cylinder_series(roots, weights, r, t, R, kappa):
    r, t = (a[..., None] for a in np.broadcast_arrays(np.asarray(r, float), np.asarray(t, float)))
    decay = np.exp(-(roots**2) * kappa * np.maximum(t, 0) / R**2)
    return np.where(t[..., 0] > 0, np.sum(weights * J0(roots * r / R) * decay, axis=-1), 1.0)


def cylinder(r, t, R, kappa, T0, T1):
    """Solid cylinder r <= R, initially at T0, surface kept at T1.  Carslaw and Jaeger (1959), ch. 7."""
    z = bessel_zeros(0, TERMS)
    return T1 + (T0 - T1) * _cylinder_series(z, 2 / (z * J1(z)), r, t, R, kappa)


def biot_roots(Bi, count=TERMS):
    """Positive roots of z J1(z) = Bi J0(z), (count,)."""
    return bessel_roots(lambda z: z * J1(z) - Bi * J0(z), count)


def cylinder_convective(r, t, R, kappa, k, h, T0, Ta):
    """The same with the flux h (Ta - T) through the surface, h in W/(m^2 K), Biot number h R/k.  Carslaw and Jaeger."""
    Bi = h * R / k
    z = biot_roots(Bi)
    return Ta + (T0 - Ta) * _cylinder_series(z, 2 * Bi / ((z**2 + Bi**2) * J0(z)), r, t, R, kappa)


# ---------------------------------------------------------------------------------------- fronts
@dataclass(frozen=True)
class StefanFront:
    """Half space x >= 0 at T_initial, where a front at T_front starts from the surface, kept at T_wall; two-phase Stefan
    problem without motion, Neumann's solution (Carslaw and Jaeger 1959, ch. 11).

    x < s(t) = 2 lambda sqrt(kappa1 t) has changed and has k1, C1; beyond are k2, C2.  The front takes up `latent`
    (J per m^3) when the wall is warmer than the front and gives it off when it is colder.  T_initial = T_front is the
    one-phase problem.
    """

    T_wall: float
    T_front: float
    T_initial: float
    k1: float  # W/(m K)
    C1: float  # J/(m^3 K)
    k2: float
    C2: float
    latent: float  # J/m^3

    def __post_init__(self):
        if (self.T_wall - self.T_front) * (self.T_front - self.T_initial) < 0 or self.T_wall == self.T_front:
            raise ValueError("T_front must lie between T_wall and T_initial and differ from T_wall")

    @property
    def kappa1(self):
        return self.k1 / self.C1

    @property
    def kappa2(self):
        return self.k2 / self.C2

    @property
    def lam(self):
        """lambda (-) from the heat balance of the front, -k1 T1_x + k2 T2_x = latent ds/dt, here over (T_wall - T_front)."""
        drive = self.T_wall - self.T_front
        ratio, cold = math.sqrt(self.kappa1 / self.kappa2), (self.T_front - self.T_initial) / drive
        e1, e2 = math.sqrt(self.k1 * self.C1 / math.pi), math.sqrt(self.k2 * self.C2 / math.pi)
        latent = self.latent * math.sqrt(self.kappa1) / abs(drive)

        def excess(lam):
            return (
                e1 * math.exp(-(lam**2)) / math.erf(lam)
                - e2 * cold / float(erfcx(lam * ratio))
                - latent * lam
            )  # fmt: skip

        return bisect(excess, 1e-12, 20.0)

    def front(self, t):
        """s(t), m."""
        return 2 * self.lam * np.sqrt(self.kappa1 * np.maximum(np.asarray(t, float), 0))

    def temperature(self, x, t):
        lam, x = self.lam, np.asarray(x, float)
        w1, w2 = _root_time(self.kappa1, t), _root_time(self.kappa2, t)
        near = self.T_wall + (self.T_front - self.T_wall) * erf(x / w1) / math.erf(lam)
        z, z0 = x / w2, lam * math.sqrt(self.kappa1 / self.kappa2)
        z = np.maximum(z, z0)  # beyond the front only
        far = self.T_initial + (self.T_front - self.T_initial) * np.exp(z0**2 - z**2) * erfcx(z) / erfcx(z0)
        return np.where(x / w1 < lam, near, far)

    def wall_heat(self, t):
        """Heat that has entered through the surface, J/m^2."""
        flux = self.k1 * (self.T_wall - self.T_front) / (math.sqrt(math.pi * self.kappa1) * math.erf(self.lam))
        return 2 * flux * np.sqrt(np.asarray(t, float))


def hydrate_latent(T_e, phi, S_h, rho_h, C0=473632.0, C1=140.117):
    """Heat of dissociation per m^3 of sediment, J/m^3: phi S_h rho_h (C0 - C1 T_K) at the front's temperature T_e (degC)."""
    return phi * S_h * rho_h * (C0 - C1 * (T_e + ZERO_C))


def hydrate_front(T_wall, T_e, T_initial, free, hydrate, latent):
    """Dissociation of hydrate in a rigid half space by a warm wall, controlled by conduction: a StefanFront at x = s(t).

    Between wall and front all hydrate is gone, beyond it none is; the front is at the equilibrium temperature T_e of the
    constant pressure; fluids do not carry heat.  free, hydrate: (conductivity, capacity per volume) on either side;
    latent from hydrate_latent().  T_initial <= T_e < T_wall.  Selim and Sloan (1985, 1989) without convection.
    """
    if not T_initial <= T_e < T_wall:
        raise ValueError("hydrate_front needs T_initial <= T_e < T_wall")
    return StefanFront(T_wall, T_e, T_initial, *free, *hydrate, latent)


# ---------------------------------------------------------------------------------------- self-check
def difference(f, x, h, n=1):
    """First or second derivative of f at x by central differences of fourth order."""
    if n == 1:
        return (8 * (f(x + h) - f(x - h)) - (f(x + 2 * h) - f(x - 2 * h))) / (12 * h)
    return (16 * (f(x + h) + f(x - h)) - f(x + 2 * h) - f(x - 2 * h) - 30 * f(x)) / (12 * h**2)


def residual(T, x, t, kappa, v=0.0, radial=False, h=0.01):
    """|T_t + v T_x - kappa (T_xx + T_x/x)| over the size of its terms, by differences of relative step h."""
    rate, slope = difference(lambda s: T(x, s), t, h * t), difference(lambda s: T(s, t), x, h * x)
    bend = difference(lambda s: T(s, t), x, h * x, 2)
    terms = rate, v * slope, -kappa * bend, -kappa * slope / x if radial else 0.0
    return abs(sum(terms)) / max(map(abs, terms))


def radial_cells(R, kappa, times, h_over_k=math.inf, cells=400):
    """(len(times), cells) of theta(r, t), initially 1, falling to 0, by finite volumes exact in time; and the radii."""
    edge = np.linspace(0, R, cells + 1)
    r, volume, dr = 0.5 * (edge[1:] + edge[:-1]), 0.5 * np.diff(edge**2), R / cells
    link = edge[1:-1] / dr
    K = np.diag(np.concatenate((link, [0])) + np.concatenate(([0], link))) - np.diag(link, 1) - np.diag(link, -1)
    K[-1, -1] += R / (0.5 * dr + 1 / h_over_k)
    root = np.sqrt(volume)
    values, modes = np.linalg.eigh(kappa * K / np.outer(root, root))
    return np.array([modes @ (np.exp(-values * t) * (modes.T @ root)) / root for t in times]), r


def enthalpy_front(f, length, cells, t_end):
    """s(t_end) of a StefanFront by the explicit enthalpy method: no front is tracked.  Wall warmer than the front."""
    dx = length / cells
    dt = 0.4 * dx**2 / max(f.kappa1, f.kappa2)
    steps = math.ceil(t_end / dt)
    dt, H = t_end / steps, np.full(cells, f.C2 * (f.T_initial - f.T_front))  # 0 ... latent: changing
    for _ in range(steps):
        T = np.where(H < 0, H / f.C2, np.where(H > f.latent, (H - f.latent) / f.C1, 0.0))
        share = np.clip(H / f.latent, 0, 1)
        resistance = dx * (share / f.k1 + (1 - share) / f.k2)  # of a cell
        q = np.empty(cells + 1)
        q[0] = (f.T_wall - f.T_front - T[0]) / (0.5 * resistance[0])
        q[1:-1] = (T[:-1] - T[1:]) / (0.5 * (resistance[:-1] + resistance[1:]))
        q[-1] = 0.0
        H += dt / dx * (q[:-1] - q[1:])
    return dx * np.sum(np.clip(H / f.latent, 0, 1))


def _check_functions(check):
    known = {0: (2.404825557695773, 5.520078110286311, 8.653727912911012), 1: (3.831705970207512, 7.015586669815619)}
    for n, zeros in known.items():
        check(f"zeros of J{n}: off the tables", np.max(np.abs(bessel_zeros(n, len(zeros)) - zeros)), 1e-14)
    check("J0(1), J1(1), J0(50), J1(50): off the tables",
          np.max(np.abs(np.array([J0(1.0), J1(1.0), J0(50.0), J1(50.0)])
                        - [0.7651976865579666, 0.4400505857449335, 0.05581232766925181, -0.09751182812517514])),
          1e-15)  # fmt: skip
    x = np.linspace(0.1, 60, 600)
    series = [sum((-1) ** k * (y / 2) ** (2 * k + n) / (math.factorial(k) * math.factorial(k + n)) for k in range(60))
              for n in (0, 1) for y in x[x < 8]]  # fmt: skip
    check("J0, J1 below 8: off the power series",
          np.max(np.abs(np.concatenate((J0(x[x < 8]), J1(x[x < 8]))) - series)), 1e-13)  # fmt: skip
    check("J0' + J1 by differences, 0.1 to 60", np.max(np.abs(difference(J0, x, 0.01) + J1(x))), 1e-8)
    at = np.nextafter(25.0, 26.0)
    check("J0, J1: jump where the method changes", max(abs(f(25.0) - f(at)) for f in (J0, J1)), 3e-15)
    check("J0 at its zero number 400, J1 likewise",
          max(abs(J0(bessel_zeros(0, 400)[-1])), abs(J1(bessel_zeros(1, 400)[-1]))), 1e-14)  # fmt: skip
    jump = float(erfcx(10.0) / erfcx(10 - 1e-12)) - 1
    check("erfcx: jump where the method changes", abs(jump), 1e-12)


def _check_plane(check):
    L, kappa, k = 0.7, 1.3e-6, 2.9
    h = 37.0
    solutions = {
        "slab": (lambda x, t: slab(x, t, L, kappa, 10.0, 3.0), 0.0),
        "half space": (lambda x, t: half_space(x, t, kappa, 10.0, 3.0), 0.0),
        "half space, flux": (lambda x, t: half_space_flux(x, t, kappa, k, 10.0, 50.0), 0.0),
        "half space, convection": (lambda x, t: half_space_convective(x, t, kappa, k, h, 10.0, 3.0), 0.0),
        "Ogata-Banks": (lambda x, t: ogata_banks(x, t, 4e-6, kappa, 10.0, 3.0), 4e-6),
    }
    for name, (T, v) in solutions.items():
        worst = max(residual(T, x, t, kappa, v) for x in (0.2, 0.5) for t in (3e4, 1e5))
        check(f"{name}: residual of the equation", worst, 1e-6)
        check(f"{name}: initial value", abs(float(T(0.3, 0.0)) - 10), 1e-12)
    x = np.linspace(0.3, 0.7, 9)
    t = 0.005 * L**2 / kappa
    off = np.max(np.abs(slab(x, t, L, kappa, 1, 0) - half_space(L - x, t, kappa, 1, 0)))
    check("slab = half space at kappa t = 0.005 L^2", off, 1e-12)
    T = solutions["half space, flux"][0]
    check("flux: -k T_x at the surface", abs(-k * difference(lambda s: T(s, 1e4), 0.0, 1e-3) / 50 - 1), 1e-8)
    T = solutions["half space, convection"][0]
    check("convection: -k T_x = h (T_a - T) at the surface",
          abs(-k * difference(lambda s: T(s, 1e4), 0.0, 1e-3) / (h * (3.0 - T(0.0, 1e4))) - 1), 1e-8)  # fmt: skip
    check("Ogata-Banks: inlet", abs(float(ogata_banks(0.0, 1e5, 4e-6, kappa, 10, 3)) - 3), 1e-12)
    check("Ogata-Banks, v = 0: half space",
          np.max(np.abs(ogata_banks(x, 1e5, 0, kappa, 10, 3) - half_space(x, 1e5, kappa, 10, 3))), 1e-12)  # fmt: skip
    far = float(ogata_banks(100.0, 1e5, 1e-3, 1e-5, 0, 1))
    check("Ogata-Banks, Peclet 1e4: half way at x = v t", abs(far - 0.5), 0.01)
    root = np.linspace(0, math.sqrt(1e5), 201)[1:]  # of t; stored = advected + conducted in
    flux = 4e-6 - kappa * difference(lambda s: ogata_banks(s, root**2, 4e-6, kappa, 0, 1), 0.0, 1e-4)
    into = np.trapz(2 * root * flux, root) + 2 * root[0] ** 2 * flux[0]
    x = np.linspace(0, 6, 60001)
    stored = np.trapz(ogata_banks(x, 1e5, 4e-6, kappa, 0, 1), x)
    check("Ogata-Banks: stored heat = heat in", abs(stored / into - 1), 1e-4)


def _check_cylinder(check):
    R, kappa, k, h = 0.4, 1.1e-6, 2.0, 25.0
    check("first roots of z J1 = Bi J0, Bi = 1 and 10: off the tables",
          max(abs(biot_roots(1.0, 2)[0] - 1.2558), abs(biot_roots(10.0, 2)[0] - 2.1795)), 5e-5)  # fmt: skip
    z = biot_roots(5.0)
    check("roots for Bi = 5: residual", np.max(np.abs(J1(z) - 5 * J0(z) / z)), 1e-13)
    fixed = lambda r, t: cylinder(r, t, R, kappa, 10.0, 3.0)
    air = lambda r, t: cylinder_convective(r, t, R, kappa, k, h, 10.0, 3.0)
    times = np.array([0.003, 0.02, 0.1, 0.5]) * R**2 / kappa
    for name, T, ratio in (("fixed surface", fixed, math.inf), ("convective", air, h / k)):
        worst = max(residual(T, r, t, kappa, radial=True) for r in (0.15, 0.3) for t in times[1:])
        check(f"cylinder, {name}: residual of the equation", worst, 1e-6)
        off = []
        for cells in (200, 400):
            theta, r = radial_cells(R, kappa, times, ratio, cells)
            off.append(np.max(np.abs((T(r, times[:, None]) - 3) / 7 - theta)))
        check(f"cylinder, {name}: off 400 finite volumes", off[1], 1e-4)
        check(f"cylinder, {name}: the same falls with h^2, 200 over 400", off[0] / off[1], (3.8, 4.2))
    t = 1e4
    check("cylinder: -k T_r = h (T - T_a) at the surface",
          abs(-k * difference(lambda s: air(s, t), R, 1e-3) / (h * (air(R, t) - 3.0)) - 1), 1e-6)  # fmt: skip
    r = np.array([0, 0.2, 0.35])
    off = np.max(np.abs(cylinder_convective(r, 2e4, R, kappa, 1, 1e8, 10, 3) - fixed(r, 2e4)))
    check("cylinder, Bi -> inf: fixed surface", off, 1e-5)


def _check_fronts(check):
    ice = StefanFront(1.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0, 1.0)
    check("Stefan number 1, one phase: lambda off 0.620063", abs(ice.lam - 0.620063), 1e-6)
    latent = hydrate_latent(10.0, 0.4, 0.5, 900.0)
    f = hydrate_front(40.0, 10.0, 6.0, (2.0, 2.4e6), (2.6, 2.9e6), latent)
    t, s = 2e6, float(f.front(2e6))
    T = f.temperature
    check("hydrate front: residual of the equation, both sides",
          max(residual(T, 0.5 * s, t, f.kappa1), residual(T, 1.7 * s, t, f.kappa2)), 1e-6)  # fmt: skip
    check("hydrate front: T at the front, both sides",
          max(abs(T(s * (1 - 1e-9), t) - 10), abs(T(s * (1 + 1e-9), t) - 10)), 1e-6)  # fmt: skip
    check("hydrate front: T at the wall and far away", max(abs(T(0.0, t) - 40), abs(T(50.0, t) - 6)), 1e-9)
    h = 1e-6  # one-sided: the front divides them
    slope1, slope2 = (T(s, t) - T(s - h, t)) / h, (T(s + h, t) - T(s, t)) / h
    taken = -f.k1 * slope1 + f.k2 * slope2
    check("hydrate front: heat balance at the front", abs(taken / (latent * s / (2 * t)) - 1), 1e-5)
    x1, x2 = np.linspace(0, s, 20001), np.linspace(s, s + 40, 200001)
    # C2 up to T_front, the latent heat there, C1 above it
    stored = latent * s + f.C1 * np.trapz(T(x1, t) - 10, x1)
    stored += f.C2 * ((10 - 6) * s + np.trapz(T(x2 + 1e-12, t) - 6, x2))
    check("hydrate front: stored heat = heat through the wall", abs(stored / f.wall_heat(t) - 1), 1e-6)
    check("hydrate front: s off the enthalpy method, 200 cells", abs(enthalpy_front(f, 6 * s, 200, t) / s - 1), 0.01)
    freeze = StefanFront(-10.0, 0.0, 5.0, 2.2, 1.9e6, 0.6, 4.2e6, 3.3e8)
    mirror = StefanFront(10.0, 0.0, -5.0, 2.2, 1.9e6, 0.6, 4.2e6, 3.3e8)
    check("freezing = thawing mirrored", abs(freeze.lam / mirror.lam - 1), 1e-14)
    alike = StefanFront(3.0, 1.0, 0.0, 2.0, 2e6, 2.0, 2e6, 0.0)
    x = np.linspace(0, 3, 31)
    off = np.max(np.abs(alike.temperature(x, 1e6) - half_space(x, 1e6, 1e-6, 0, 3)))
    check("no latent heat, equal phases: half space", off, 1e-12)


def self_check():
    from common import check, finish

    for part in (_check_functions, _check_plane, _check_cylinder, _check_fronts):
        part(check)
    finish()


if __name__ == "__main__":
    sys.exit(self_check())
