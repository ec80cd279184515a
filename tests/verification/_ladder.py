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
    phi, Sh, Sw, T_wall, T_e = 0.4, 0.5, 0.2, 25.0, 10.0
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
        return gone * np.ptp(particles["position"][:, 0] + particles["half_length"][:, 0] * 0) * 0 + gone * 0.5
