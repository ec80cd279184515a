"""The scenes of the ladder: what each test and scripts/plot_cases.py share, mostly exact solutions as functions of x and t."""
import sys
from pathlib import Path

import numpy as np

import exact
import exact_flow
import exact_heat
import exact_solid

CASES = Path(__file__).resolve().parents[2] / "cases"


# ---------------------------------------------------------------------------------------- heat_slab
class HeatSlab:
    k = 0.8 * 2.5 + 0.2 * 0.044  # W/(m K); the pores count with the conductivity of gas
    C = 0.8 * 2500 * 800  # J/(m^3 K)

    @classmethod
    def temperature(cls, x, t):
        return exact_heat.slab(x, t, 1.0, cls.k / cls.C, 20.0, 10.0)


# ---------------------------------------------------------------------------------------- heat_advection
class HeatAdvection:
    q = 1e-12 / 1e-3 * 0.02e6 / 4  # m/s
    k = 0.7 * 2.5 + 0.3 * 0.6
    C = 0.7 * 2600 * 800 + 0.3 * 1000 * 4200

    @classmethod
    def temperature(cls, x, t):
        v = exact_heat.thermal_velocity(cls.q, 1000 * 4200, cls.C)
        return exact_heat.ogata_banks(x, t, v, cls.k / cls.C, 20.0, 10.0)


# ---------------------------------------------------------------------------------------- elastic_wave
class ElasticWave:
    L, M, rho, q = 10.0, 2e8, 2000.0, 1e4
    c = (M / rho) ** 0.5
    period = 4 * L / c

    @classmethod
    def solution(cls, x, t):
        """u, v, sigma."""
        return exact_solid.wave_load(x, t, cls.L, cls.M, cls.rho, cls.q)

    @classmethod
    def first_mode(cls, particles):
        """Amplitude (m) of sin(pi x/2L) in the displacement about the static state -q x/M."""
        u, V = particles["displacement"][:, 0], particles["volume"][:, 0]
        X = particles["position"][:, 0] - u
        return 2 * np.sum(V * (u + cls.q * X / cls.M) * np.sin(np.pi * X / (2 * cls.L))) / np.sum(V)

    first_mode_start = 8 * q * L / (np.pi**2 * M)

    @classmethod
    def energy(cls, particles):
        """Kinetic energy and strain energy about the static state, over that at t = 0; exactly 1."""
        strain = (particles["stress"][:, 0] + cls.q) / cls.M
        V = particles["volume"][:, 0]
        kinetic = particles["mass_solid"][:, 0] * particles["v_s"][:, 0] ** 2
        return np.sum(kinetic + V * cls.M * strain**2) * cls.M / (cls.q**2 * np.sum(V))


# ---------------------------------------------------------------------------------------- gravity_column
class GravityColumn:
    H, rho0, g, M = 10.0, 1300.0, 9.81, 3e5

    @classmethod
    def solution(cls, Y):
        """u, J, sigma."""
        return exact_solid.gravity_column(Y, cls.H, cls.rho0, cls.g, cls.M)


# ---------------------------------------------------------------------------------------- terzaghi
class Terzaghi:
    H, q, p0 = 1.0, 1e3, 0.1e6
    M = exact.constrained_modulus(1e7, 0.2)
    B, c = exact.mixture_coefficients(M, 1e-15 / 1e-3, 0.4, 2.2e9)

    @classmethod
    def pressure(cls, x, t):
        """Excess pore pressure, Pa."""
        return exact.terzaghi_constant(cls.q, cls.B, cls.c, cls.H, cls.H - np.asarray(x, float), t)

    @classmethod
    def settlement(cls, t):
        return exact.terzaghi_constant_settlement(cls.q, cls.M, cls.B, cls.c, cls.H, t)


# ---------------------------------------------------------------------------------------- stefan_front
class StefanFront:
    phi, Sh, Sw, T_wall, T_e, length = 0.4, 0.5, 0.2, 25.0, 10.0, 0.5
    share = 6 * 0.018 / 0.124  # water per hydrate, kg/kg

    @classmethod
    def side(cls, Sh, Sw):
        """Conductivity and heat capacity per volume."""
        Sg = 1 - Sh - Sw
        k = (1 - cls.phi) * 3 + cls.phi * (Sh * 0.5 + Sw * 0.5 + Sg * 0.05)
        return k, (1 - cls.phi) * 2600 * 800 + cls.phi * (Sh * 900 * 2010 + Sw * 1000 * 4200)

    @classmethod
    def solution(cls):
        """exact_heat.StefanFront; the water of the hydrate stays where it was."""
        latent = exact_heat.hydrate_latent(cls.T_e, cls.phi, cls.Sh, 900.0)
        free = cls.side(0.0, cls.Sw + cls.Sh * 900 / 1000 * cls.share)
        return exact_heat.hydrate_front(cls.T_wall, cls.T_e, cls.T_e, free, cls.side(cls.Sh, cls.Sw), latent)

    @classmethod
    def front(cls, particles):
        """Position (m) of the front that has taken as much hydrate as is gone."""
        gone = 1 - np.sum(particles["mass_hydrate"]) / (cls.phi * cls.Sh * 900 * np.sum(particles["volume"]))
        return gone * cls.length


# ---------------------------------------------------------------------------------------- buckley_leverett
class BuckleyLeverett:
    q, phi = 1e-5, 0.3
    exact = exact_flow.BuckleyLeverett(exact_flow.Corey(0.1, 0.1, 2, 2), 1e-3, 1e-3, phi, q, 0.9, 0.1)

    @staticmethod
    def profile(particles):
        """x (m) and S of the lower row of particles, x rising."""
        x, y = particles["position"].T
        row = np.flatnonzero(y < np.mean(y))
        row = row[np.argsort(x[row])]
        return x[row], particles["S_w"][row, 0]

    @classmethod
    def front(cls, x, S):
        """Last place (m) where S passes half of the front's jump."""
        half = 0.5 * (cls.exact.S_initial + cls.exact.S_front)
        i = np.flatnonzero(S > half)[-1]
        return x[i] + (S[i] - half) / (S[i] - S[i + 1]) * (x[i + 1] - x[i])


# ---------------------------------------------------------------------------------------- mcwhorter_sunada
class McWhorterSunada:
    retention = exact.Retention(10e3, 0.65, 0.0, 0.0)

    @classmethod
    def solution(cls):
        laws = exact_flow.Corey(0.1, 0.0, 2, 2)
        slope = exact_flow.retention_slope(cls.retention)
        return exact_flow.McWhorterSunada(0.3, 1e-13, 1e-3, 1e-3, laws.krw, laws.krg, slope, 0.9, 0.3)


# ---------------------------------------------------------------------------------------- century
class Century:
    """With k = k0 J^2 and sigma' = -M ln J the volume ratio J obeys linear diffusion in material coordinates (Xie and Leo 2004), whatever
    the load: J_t = c J_aa, c = k0 M/mu, J = exp(-q(t)/M) at the drain (depth a = 0), J_a = 0 at the base; q grows to Q until T1."""

    H, M, c, p0 = 100.0, 10e6, 1e-18 * 10e6 / 1e-3, 1e6
    Q, T1, end = 3e6, 9.467e9, 1.5778e10
    depths = {"below_2m": 2.0, "below_5m": 5.0, "below_10m": 10.0, "below_20m": 20.0}  # of the probes, m

    @classmethod
    def of(cls, k):
        """The same with permeability k (m^2), and probes as deep as the pressure's layer wants."""
        scale = k / 1e-18
        return type(cls.__name__, (cls,), {"c": cls.c * scale, "depths": {n: a * scale**0.5 for n, a in cls.depths.items()}})

    @classmethod
    def load(cls, t):
        return cls.Q * np.minimum(t, cls.T1) / cls.T1

    @classmethod
    def _modes(cls, t, terms=4000):
        Mn = (np.arange(terms) + 0.5) * np.pi
        rate, beta = Mn**2 * cls.c / cls.H**2, cls.Q / cls.T1 / cls.M
        s = np.minimum(t, cls.T1)[:, None]
        grown = beta * (np.exp(-beta * s) - np.exp(-rate * s)) / (rate - beta)
        return Mn, grown * np.exp(-rate * np.maximum(t - cls.T1, 0.0)[:, None]), np.exp(-cls.load(t) / cls.M)

    @classmethod
    def pressure(cls, a, t):
        """Excess pore pressure (Pa) at depths a (m) and times t (s): (times, depths)."""
        t = np.atleast_1d(np.asarray(t, float))
        Mn, T, top = cls._modes(t)
        J = top[:, None] + (T * 2 / Mn) @ np.sin(np.outer(Mn, np.atleast_1d(a) / cls.H))
        return cls.load(t)[:, None] + cls.M * np.log(J)

    @classmethod
    def settlement(cls, t):
        """m, at times t (s)."""
        t = np.atleast_1d(np.asarray(t, float))
        Mn, T, top = cls._modes(t)
        return cls.H * (1 - top - T @ (2 / Mn**2))
