"""cases/century_hydrate with clay that lets nothing through: conduction of heat with latent heat, an independent solution.

Nothing flows, so each piece of clay is a closed cell under the load: wherever it holds hydrate and gas, p = p_e(T), and the closed cell says
how much hydrate that takes.  What is left is one equation for T in material coordinates a (from the base),

    C T_t = L f_t + (kappa/J T_a)_a,      f(T, q) hydrate formed per initial volume, J(T, q) volume ratio,

solved with finite volumes and backward Euler.  f and J come from a table of closed cells (exact.Cell).
"""
import numpy as np

from exact import R_GAS, ZERO_C, Cell, Retention

YEAR = 3.15576e7
H, Q, LOADED, WARMED, END = 100.0, 0.5e6, 300 * YEAR, 150 * YEAR, 500 * YEAR
T0, RISE, LAYER = 6.988336, 2.0, (20.0, 50.0)  # degC, K, heights (m)
CLAY = dict(phi=0.5, p=5e6, T=T0, E0=10e6, Eh=100e6, nu=0.0, rho_s=2650.0, retention=Retention(500e3, 0.45, 0.2, 0.01))
BARE, BEARING = Cell(Sw=0.95, Sg=0.05, **CLAY), Cell(Sh=0.2, Sw=0.76, Sg=0.04, **CLAY)
KAPPA = (2.0, 0.5, 0.57, 0.035)  # solid, hydrate, water, gas


def load(t):
    return Q * min(t / LOADED, 1.0)


def at_equilibrium(cell, T, q):
    """{f, J, C, kappa, p} of a closed cell with p = p_e(T) under the load q; where its hydrate does not last, f < -m_h and
    the other values are those of the start without hydrate (0.5 % off)."""
    p = cell.equilibrium[0] * np.exp(cell.equilibrium[1] - cell.equilibrium[2] / (T + ZERO_C))
    ms, mh, mw, mg = cell.masses()
    nu_g, nu_w, pw0 = cell.M_g / cell.M_h, cell.N_h * cell.M_w / cell.M_h, cell.initial_pressures()[0]

    def state(pc):
        s = cell.retention.gas_share(pc)
        pw = p - s * pc
        rho_w, rho_g = cell.rho_w * np.exp((pw - pw0) / cell.Kw), cell.M_g * (pw + pc) / (R_GAS * (T + ZERO_C))
        ratio = s * rho_g / ((1 - s) * rho_w)  # of gas to water, kg/kg
        f = (mg - ratio * mw) / (nu_g - ratio * nu_w)
        V_f, V_h = (mg - nu_g * f) / (s * rho_g), (mh + f) / cell.rho_h
        Sh, J = V_h / (V_f + V_h), 1 - cell.phi + V_f + V_h
        return f, J, Sh, s, q + cell.p - p + (cell.E0 + cell.Eh * np.maximum(Sh, 0.0)) * np.log(J)

    low, high = np.full_like(T, -1e6), np.full_like(T, 1e6)  # more capillary pressure is more gas, less hydrate, more volume
    for _ in range(60):
        pc = 0.5 * (low + high)
        stiff = state(pc)[-1] > 0
        low, high = np.where(stiff, low, pc), np.where(stiff, pc, high)
    f, J, Sh, s, _ = state(pc)
    left = f > -mh - 1e-12
    J, Sh, s = (np.where(left, v, start) for v, start in ((J, 1.0), (Sh, 0.0), (s, cell.Sg / (cell.Sw + cell.Sg))))
    phi, c = 1 - (1 - cell.phi) / J, cell.heat
    fluid = (1 - s) * KAPPA[2] + s * KAPPA[3]
    kappa = (1 - phi) * KAPPA[0] + phi * (Sh * KAPPA[1] + (1 - Sh) * fluid)
    C = ms * c[0] + (mh + f) * c[1] + (mw - nu_w * f) * c[2] + (mg - nu_g * f) * c[3]
    C = np.where(left, C, ms * c[0] + (mw + nu_w * mh) * c[2] + (mg + nu_g * mh) * c[3])
    return {"f": f, "J": J, "C": C, "kappa": kappa, "S_h": Sh, "p": p}


class Table:
    """at_equilibrium() of one cell, bilinear in T and q."""

    def __init__(self, cell):
        self.T, self.q = np.linspace(T0 - 0.1, T0 + RISE + 0.1, 221), np.linspace(0, Q, 26)
        grid = np.meshgrid(self.T, self.q, indexing="ij")
        self.values = at_equilibrium(cell, *grid)

    def __call__(self, name, T, q):
        x, y = (T - self.T[0]) / (self.T[1] - self.T[0]), q / self.q[1]
        i, j = np.clip(x.astype(int), 0, len(self.T) - 2), min(int(y), len(self.q) - 2)
        v, x, y = self.values[name], x - i, y - j
        return (1 - x) * ((1 - y) * v[i, j] + y * v[i, j + 1]) + x * ((1 - y) * v[i + 1, j] + y * v[i + 1, j + 1])


class Sealed:
    """The column: middle heights a (m, material), and T, S_h, hydrate (kg/m^3 initial) at the times asked for."""

    def __init__(self, cells=200, steps=500, times=(100 * YEAR, 300 * YEAR, END)):
        self.h, self.dt = H / cells, END / steps
        self.a = (np.arange(cells) + 0.5) * self.h
        self.bearing = (self.a > LAYER[0]) & (self.a < LAYER[1])
        self.tables = Table(BARE), Table(BEARING)
        self.m0 = np.where(self.bearing, BEARING.masses()[1], 0.0)
        self.found, T = {}, np.full(cells, T0)
        f = np.zeros(cells)
        for k in range(1, steps + 1):
            T, f = self.step(T, f, k * self.dt)
            for t in times:
                if abs(k * self.dt - t) < 0.5 * self.dt:
                    self.found[t] = {"T": T, "m_h": self.m0 + f, "S_h": np.where(f > -self.m0, self.value("S_h", T, load(t)), 0.0)}

    def value(self, name, T, q):
        bare, bearing = (table(name, T, q) for table in self.tables)
        return np.where(self.bearing, bearing, bare)

    def formed(self, T, q):
        return np.maximum(self.value("f", T, q), -self.m0)

    def step(self, T_n, f_n, t):
        q, T = load(t), T_n.copy()
        C, g = self.value("C", T_n, q), self.value("kappa", T_n, q) / self.value("J", T_n, q) / self.h
        between = 2 / (1 / g[1:] + 1 / g[:-1])
        K = np.diag(np.append(between, 2 * g[-1]) + np.insert(between, 0, 0.0)) - np.diag(between, 1) - np.diag(between, -1)
        source = np.zeros_like(T)
        source[-1] = 2 * g[-1] * (T0 + RISE * min(t / WARMED, 1.0))
        latent = BARE.latent[0] - BARE.latent[1] * (T_n + ZERO_C)
        for _ in range(30):
            f, slope = self.formed(T, q), (self.formed(T + 1e-6, q) - self.formed(T - 1e-6, q)) / 2e-6
            residual = self.h / self.dt * (C * (T - T_n) - latent * (f - f_n)) + K @ T - source
            change = np.linalg.solve(K + np.diag(self.h / self.dt * (C - latent * slope)), -residual)
            T = T + change
            if np.max(np.abs(change)) < 1e-9:
                break
        return T, self.formed(T, q)
