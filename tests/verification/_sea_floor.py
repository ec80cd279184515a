"""Pore pressure in a column of cases/sea_floor far from its ends: consolidation in one dimension, layer by layer.

For e = p - p_a, what the pore pressure exceeds that of the sea at its present level by beyond the weight of still water,
    (1/M + phi/K_w) de/dt = d/dn (k/mu de/dn) - phi/K_w dp_a/dt,
n normal to the layers, e = 0 at the sea floor, closed below; M the constrained modulus, grains that do not compress.
The floor stands int e/M dn above where it settles in the end.
"""
import numpy as np

LAYERS = {  # from the sea floor down: vertical thickness (m) at x = 100 m, porosity, E (Pa), k (m^2)
    "sand": (10.0, 0.4, 100e6, 1e-11),
    "clay": (15.0, 0.5, 200e6, 1e-18),
    "mudstone": (15.0, 0.2, 500e6, 1e-20),
}
NU, K_WATER, MU, DIP = 0.3, 2.2e9, 1e-3, 0.1
DAY, YEAR = 86400.0, 365 * 86400.0
SETTLED, FALL = 3650000 * DAY, 1025 * 9.81 * 100.0  # begin of the fall (s); what p_a loses within a day (Pa)


def modulus(E):
    return E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))


def undrained(layer):
    """e once the sea has fallen, if nothing flows (Pa)."""
    _, phi, E, _ = LAYERS[layer]
    return FALL * phi / K_WATER / (1 / modulus(E) + phi / K_WATER)


def column(t, clay=LAYERS["clay"][3], dz=0.05):
    """depth (n,) of the centres of slices, e (len(t), n) in Pa and rise of the floor (len(t),) in m at times t (s) after the fall began."""
    n = [round(layer[0] / dz) for layer in LAYERS.values()]
    phi, E, k = (np.repeat([layer[q] for layer in LAYERS.values()], n) for q in (1, 2, 3))
    k = np.where(np.repeat(list(LAYERS), n) == "clay", clay, k)
    M, size = modulus(E), dz / np.hypot(1.0, DIP)
    S, source = size * (1 / M + phi / K_WATER), size * phi / K_WATER * FALL / DAY
    T = np.r_[k[0] / MU / (size / 2), 1 / (size / 2 * MU * (1 / k[1:] + 1 / k[:-1]))]  # towards the slice above
    A = np.diag(T + np.r_[T[1:], 0.0]) - np.diag(T[1:], 1) - np.diag(T[1:], -1)
    rate, Q = np.linalg.eigh(A / np.sqrt(np.outer(S, S)))
    drive = Q.T @ (source / np.sqrt(S))
    t = np.atleast_1d(np.asarray(t, float))[:, None]
    begun, ended = np.clip(t, 0, None), np.clip(t - DAY, 0, None)
    mode = drive / rate * (np.exp(-rate * ended) - np.exp(-rate * begun))
    e = (mode @ Q.T) / np.sqrt(S)
    return (np.arange(len(S)) + 0.5) * dz, e, (e / M).sum(axis=1) * size
