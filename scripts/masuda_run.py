"""What a run of cases/masuda says in the units of its reference curves; used by the plots, the test and the study."""
import math
from pathlib import Path

import numpy as np

from clathra import read_csv

REFERENCE = Path(__file__).resolve().parents[1] / "cases" / "masuda" / "reference" / "masuda.csv"
RADIUS, LENGTH = 25.4e-3, 0.3  # m, of the core
POROSITY, SH, SG = 0.182, 0.501, 0.148
RHO_H, M_H, M_G = 900.0, 0.124, 0.016  # kg/m^3, kg/mol
STANDARD = 0.6789  # kg/m^3, methane at 101.4 kPa and 15.56 degC
CM3 = 1e6 / STANDARD  # kg of methane to cm^3 at standard conditions
JUDGED = np.arange(15.0, 241.0, 15.0)  # min

# column of the reference: (what it is, how a difference is judged, bar)
BARS = {
    "pg_far_MPa": ("gas pressure at the far end", "itself", 0.02),
    "T75_C": ("surface temperature at T1, 75 mm", "K", 0.1),
    "T150_C": ("surface temperature at T2, 150 mm", "K", 0.1),
    "T225_C": ("surface temperature at T3, 225 mm", "K", 0.1),
    "gas_out_cm3": ("gas produced at the outlet", "itself", 0.03),
    "gas_tot_cm3": ("gas produced and free in the pores", "itself", 0.03),
    "Sh_frac": ("hydrate left, S_h/S_h0", "absolute", 0.03),
}


def gas_at_start(p_g=3.75e6, T=2.3, radius=RADIUS):
    """Methane in the pores and in the hydrate, cm^3 at standard conditions, of the constants of the paper."""
    pores = math.pi * radius**2 * LENGTH * POROSITY
    return pores * SG * p_g * M_G / (8.314 * (T + 273.15)) * CM3, pores * SH * RHO_H * M_G / M_H * CM3


def curves(folder):
    """{column of the reference: (rows,) array} of a run with the probes of the case, of a core of any radius: amounts are
    scaled to RADIUS.  Rows are the steps (t_min).  Besides: total_cm3 (methane wherever it is), p_far_MPa (mean pore
    pressure), the ledgers' errors, and the number pg_start_Pa.
    """
    probes, balance = read_csv(Path(folder) / "probes.csv"), read_csv(Path(folder) / "balance.csv")
    radius, time = probes["T1.x_m"][0], balance["time_s"]
    scale = (RADIUS / radius) ** 2
    at = lambda column: np.interp(time, probes["time_s"], probes[column])
    hydrate, out = scale * balance["hydrate_kg"], scale * balance["methane_out_kg"]
    total = scale * balance["methane_kg"] + out
    hydrate0 = math.pi * RADIUS**2 * LENGTH * POROSITY * RHO_H * probes["T1.S_h"][0]
    return {
        "t_min": time / 60, "pg_far_MPa": at("P0.p_g_Pa") * 1e-6, "T75_C": at("T1.T_degC"), "T150_C": at("T2.T_degC"),
        "T225_C": at("T3.T_degC"), "gas_out_cm3": out * CM3, "gas_tot_cm3": (total - hydrate * M_G / M_H) * CM3,
        "Sh_frac": hydrate / hydrate0, "water_out_cm3": scale * balance["water_out_kg"] * 1e3, "total_cm3": total * CM3,
        "p_far_MPa": at("P0.p_Pa") * 1e-6, "pg_start_Pa": probes["T1.p_g_Pa"][0], "water_error": balance["water_error"],
        "methane_error": balance["methane_error"],
    }  # fmt: skip


def at_times(run, column, minutes):
    """Values of curves() at times that the run has hit."""
    rows = [int(np.argmin(np.abs(run["t_min"] - t))) for t in np.atleast_1d(minutes)]
    if not np.allclose(run["t_min"][rows], minutes, rtol=1e-9, atol=1e-6):
        raise ValueError("the run has no step that ends at a wanted time")
    return run[column][rows]


def reference_at(reference, column, minutes):
    return np.array([reference[column][np.flatnonzero(np.isclose(reference["t_min"], t))[0]] for t in minutes])


def differences(run, reference, column, minutes=JUDGED):
    """Run minus reference at these times, judged as BARS says."""
    want = reference_at(reference, column, minutes)
    error = at_times(run, column, minutes) - want
    return error / np.abs(want) if BARS[column][1] == "itself" else error


def dissociated(run, left):
    """Time (min) at which this part of the hydrate is left; NaN if the run does not reach it."""
    below = np.flatnonzero(run["Sh_frac"] <= left)
    if not len(below) or below[0] == 0:
        return math.nan
    k = below[0]
    log = np.log(np.maximum(run["Sh_frac"][k - 1 : k + 1], 1e-300))
    part = (log[0] - math.log(left)) / (log[0] - log[1])
    return float(run["t_min"][k - 1] + part * (run["t_min"][k] - run["t_min"][k - 1]))
