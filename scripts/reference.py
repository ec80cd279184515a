#!/usr/bin/python3
"""Figures of the paper whose curves stand beside a reference's, and the largest differences from it in words:

reference.py bp2 CASE1_DIR CASE2_DIR OUT   Figures 9 to 11: OUT/fig09_case1.png, fig10_case2.png, fig11_profiles.png.  Case 1 is BP2 with hydrate kinetics off, case 2
                                           with kinetics on; the reference is cases/bp2/reference
reference.py masuda RUN_DIR OUT            Figures 6 and 7: OUT/masuda_contours.png (gas pressure, temperature, hydrate and gas saturation in the core, mirrored at its axis,
                                           at five times) and masuda_curves.png (surface temperatures, far-end pressure, gas); the reference is cases/masuda/reference

curves() and differences() of Masuda's core are also the test's, the study's and the notebook's.
"""
import math
import sys
from pathlib import Path

import numpy as np

import clathra
from clathra import probe_names, read_csv, read_snapshots
from clathra.plotting import COLOURS, MM, PA, plt, save, set_style, steady_limits
from clathra.shown import QUANTITIES

CASES = Path(__file__).resolve().parents[1] / "cases"

# ---------------------------------------------------------------- BP2
INNER, LOADED = 0.6, 1.0  # m from the fixed end

# key: (column of the reference, probe at, column of the probe, factor, label, kind of the difference)
CURVES = {
    "p": ("p_MPa", INNER, "p_Pa", PA, "pore pressure p at x = 0.6 m (MPa)", "relative"),
    "S_h": ("Sh", INNER, "S_h", 1, "hydrate saturation $S_h$ at x = 0.6 m (–)", "of peak"),
    "T": ("T_C", INNER, "T_degC", 1, "temperature T at x = 0.6 m (°C)", "K"),
    "u": ("u_mm", LOADED, "u_x_m", MM, "displacement of the loaded end (mm)", "of peak"),
}


def curve(probes, place, column, factor):
    """Time and values of the probe that starts nearest to `place`."""
    names = probe_names(probes)
    nearest = min(names, key=lambda n: abs(probes[f"{n}.x_m"][0] - place))
    return probes["time_s"], probes[f"{nearest}.{column}"] * factor


def largest_difference(time, values, reference, column, kind):
    """Largest difference at the reference's times the run has reached, in words."""
    known = reference["t_s"] <= time[-1] * (1 + 1e-9)
    want = reference[column][known]
    error = np.abs(np.interp(reference["t_s"][known], time, values) - want)
    if kind == "relative":
        return f"{100 * np.max(error / np.abs(want)):.2f} %"
    if kind == "K":
        return f"{np.max(error):.3f} K"
    peak = np.max(np.abs(want))
    return f"{100 * np.max(error) / peak:.2f} % of the peak" if peak > 0 else f"{np.max(error):.2g}"


def draw(axes, key, probes, reference, case):
    column, place, probe_column, factor, label, kind = CURVES[key]
    time, values = curve(probes, place, probe_column, factor)
    shown = [values]
    if reference is not None:
        shown.append(reference[column])
        axes.plot(reference["t_s"], reference[column], "o", ms=4.5, mfc="none", mew=0.9, markevery=2, color="0.25",
                  label="reference (finite volumes)")  # fmt: skip
        difference = largest_difference(time, values, reference, column, kind)
        axes.set_title(f"largest difference {difference}", fontsize=9.5, color="0.3")
        print(f"  case {case}, {key:3s}: largest difference from the reference {difference}")
    axes.plot(time, values, color=COLOURS[0], lw=2, label="Clathra")
    steady_limits(axes, *shown, least=0.01)
    axes.set(xlabel="time (s)", ylabel=label, xlim=(0, max(time[-1], 1e-9)))


def read_reference(case):
    path = CASES / "bp2" / "reference" / f"bp2_case{case}.csv"
    if path.is_file():
        return read_csv(path)
    print(f"  no reference curve {path}")
    return None


def plot_histories(folder, case, keys, size, name, title, out):
    probes, reference = read_csv(folder / "probes.csv"), read_reference(case)
    rows = len(keys) // 2
    figure, grid = plt.subplots(rows, 2, figsize=size, squeeze=False)
    for axes, key, letter in zip(grid.flat, keys, "abcd"):
        draw(axes, key, probes, reference, case)
        axes.text(-0.12, 1.02, f"({letter})", transform=axes.transAxes, fontweight="bold")
    grid[0][0].legend(loc="best")
    figure.suptitle(title, x=0.01, ha="left")
    save(figure, out, name)


def draw_front(axes, particles, values):
    """The front of hydrate at 1000 s (reference in initial coordinates) where the particles have moved to."""
    front, x0, x = read_csv(CASES / "bp2" / "reference" / "bp2_case2_front.csv"), particles["initial_position"][:, 0], particles["position"][:, 0]
    order = np.argsort(x0, kind="stable")
    places = np.interp(front["x0_m"], x0[order], x[order])
    axes.plot(places, front["Sh"], "o", ms=4.5, mfc="none", mew=0.9, color="0.25", label="reference (finite volumes), 1000 s")
    axes.legend(loc="lower left", fontsize=8)
    error = np.max(np.abs(np.interp(front["x0_m"], x0[order], values[order]) - front["Sh"])) / np.max(values)
    print(f"  case 2, S_h at the front at 1000 s: largest difference from the reference {100 * error:.1f} % of the peak")


def plot_profiles(folder, out, times=(500.0, 1000.0)):
    run = clathra.Run(folder)
    found = [(t, run.particles(t)) for t in times if np.any(np.isclose(run.times, t))]
    if not found:
        print(f"  no particle snapshots at {times} s in {folder}")
        return
    wanted = {q.key: q for q in QUANTITIES}
    quantities = [wanted[key] for key in ("p", "T", "S_h", "u_x")]
    figure, grid = plt.subplots(1, 4, figsize=(14, 3.8))
    for axes, quantity, letter in zip(grid, quantities, "abcd"):
        shown = []
        for (time, particles), colour, style in zip(found, COLOURS, ("-", "--")):
            x = particles["position"][:, 0]
            order = np.argsort(x, kind="stable")
            shown.append(quantity.of(particles)[order])
            axes.plot(x[order], shown[-1], style, color=colour, label=f"{time:g} s")
            if quantity.key == "S_h" and time == 1000.0:
                draw_front(axes, particles, quantity.of(particles))
        steady_limits(axes, *shown, least=0.01)
        axes.set(xlabel="x (m)", ylabel=quantity.axis, xlim=(0, 1))
        axes.set_title(f"({letter})", fontweight="bold")
    grid[0].legend(loc="best")
    figure.suptitle("BP2 case 2 (hydrate kinetics on): profiles (Figure 11)", x=0.01, ha="left")
    save(figure, out, "fig11_profiles")


def bp2(case1, case2, out):
    """Figures 9 to 11 of runs of cases/bp2 without and with kinetics."""
    set_style()
    plot_histories(case1, 1, ("p", "u"), (11, 4.2), "fig09_case1", "BP2 case 1 (hydrate kinetics off), Figure 9", out)
    plot_histories(case2, 2, ("p", "u", "S_h", "T"), (11, 8), "fig10_case2", "BP2 case 2 (hydrate kinetics on), Figure 10", out)
    plot_profiles(case2, out)


# ---------------------------------------------------------------- Masuda's core
REFERENCE = CASES / "masuda" / "reference" / "masuda.csv"
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


TIMES = ((600, "10 min"), (3600, "1 h"), (7200, "2 h"), (10800, "3 h"), (14400, "4 h"))
FIELDS = (  # variable, factor, label, colours
    ("p_g", PA, "$p_g$ (MPa)", "viridis"), ("T", 1, "T (°C)", "inferno"), ("S_h", 1, "$S_h$ (–)", "cividis"),
    ("S_g", 1, "$S_g$ (–)", "YlGnBu"),
)  # fmt: skip
PANELS = (  # title, axis label, ((column, name), ...)
    ("(a) T1, 75 mm from the outlet", "surface temperature (°C)", (("T75_C", ""),)),
    ("(b) T3, 225 mm from the outlet", "surface temperature (°C)", (("T225_C", ""),)),
    ("(c) closed end, P0", "gas pressure (MPa)", (("pg_far_MPa", ""),)),
    ("(d) gas at 101.4 kPa and 15.56 °C", "gas (1000 cm³)", (("gas_tot_cm3", "produced + in pores"), ("gas_out_cm3", "produced"))),
)
WORDS = {"itself": (100, "%"), "K": (1, "K"), "absolute": (1, "")}


def lattice(particles, name):
    """Edges along the axis and the radius (mm), and the values on them: (radii, along)."""
    x = particles["position"]
    r, y = (np.unique(np.round(x[:, k], 9)) for k in (0, 1))
    values = np.full((len(r), len(y)), np.nan)
    values[np.searchsorted(r, x[:, 0] - 1e-8), np.searchsorted(y, x[:, 1] - 1e-8)] = particles[name][:, 0]
    edges = lambda c: 1e3 * np.arange(len(c) + 1) * (c[1] - c[0])
    return edges(y), edges(r), values


def plot_contours(snapshots, out):
    found = [(label, s) for wanted, label in TIMES for t, s in snapshots if abs(t - wanted) < 1e-6 * wanted]
    if not found:
        print("  no snapshots at the times of Figure 6")
        return
    figure, grid = plt.subplots(len(found), len(FIELDS), figsize=(14, 0.78 * len(found) + 1.3), sharex=True, sharey=True,
                                squeeze=False)  # fmt: skip
    for column, (name, factor, label, colours) in zip(grid.T, FIELDS):
        low, high = (factor * f([s[name] for _, s in found]) for f in (np.min, np.max))
        for axes, (time, particles) in zip(column, found):
            along, radius, values = lattice(particles, name)
            both = np.vstack([values[::-1], values]) * factor  # the core is mirrored at its axis
            axes.grid(False)
            shown = axes.pcolormesh(along, np.r_[-radius[:0:-1], radius], both, cmap=colours, vmin=low, vmax=high,
                                    rasterized=True)  # fmt: skip
            axes.set_aspect("equal")
        figure.colorbar(shown, ax=list(column), location="bottom", label=label, aspect=28, pad=0.02)
    for axes, (time, _) in zip(grid[:, 0], found):
        axes.set_ylabel(f"{time}\nr (mm)")
        axes.set_yticks((-25, 0, 25))
    for axes, (_, _, label, _), letter in zip(grid[0], FIELDS, "abcd"):
        axes.set_title(f"({letter}) {label.split(' ')[0]}")
    for axes in grid[-1]:
        axes.set_xlabel("distance from the outlet (mm)")
    figure.suptitle("Masuda's core: outlet on the left, bath around it (Figure 6)", x=0.01, ha="left")
    save(figure, out, "masuda_contours")


def difference_in_words(run, reference, column):
    """Largest difference from the reference at the judged times that the run has reached."""
    times = JUDGED[JUDGED <= run["t_min"][-1] * (1 + 1e-9)]
    try:
        error = differences(run, reference, column, times)
    except ValueError:
        return None
    factor, unit = WORDS[BARS[column][1]]
    return f"{factor * np.max(np.abs(error)):.2g} {unit}".strip() if len(times) else None


def plot_curves(run, reference, out):
    figure, grid = plt.subplots(2, 2, figsize=(11, 7.6))
    for axes, (title, label, columns) in zip(grid.flat, PANELS):
        differ = []
        for (column, name), colour in zip(columns, COLOURS):
            factor = 1e-3 if column.endswith("cm3") else 1
            axes.plot(reference["t_min"] / 60, factor * reference[column], "o", ms=4.5, mfc="none", mew=0.9, markevery=2,
                      color="0.25", label="reference (finite volumes)" if column == columns[0][0] else None)  # fmt: skip
            axes.plot(run["t_min"] / 60, factor * run[column], color=colour, lw=2, label=name or "Clathra")
            steady_limits(axes, run[column] * factor, least=0.01)
            words = difference_in_words(run, reference, column)
            if words:
                differ.append(words)
                print(f"  {column:12s}: largest difference from the reference to 4 h {words}")
        axes.set(xlabel="time (h)", ylabel=label, xlim=(0, run["t_min"][-1] / 60))
        axes.set_title(title + (f"; largest difference {' and '.join(differ)}" if differ else ""), fontsize=9.5)
        axes.legend(loc="best")
    for axes in grid[0]:
        axes.axhline(2, color="0.6", lw=0.8, ls=":")
    figure.suptitle("Masuda's core: histories and the reference's curves (Figure 7); differences to 4 h", x=0.01, ha="left")
    save(figure, out, "masuda_curves")


def masuda(folder, out):
    """Figures 6 and 7 of a run of cases/masuda."""
    set_style()
    plot_contours(read_snapshots(folder), out)
    plot_curves(curves(folder), read_csv(REFERENCE), out)


if __name__ == "__main__":
    wanted = {("bp2", 3): bp2, ("masuda", 2): masuda}.get((sys.argv[1] if sys.argv[1:] else "", len(sys.argv) - 2))
    if wanted is None:
        sys.exit(__doc__)
    wanted(*map(Path, sys.argv[2:]))
