#!/usr/bin/env python3
"""The enthalpy of a closed column is conserved while hydrate dissociates and fluids flow.

Enthalpy of a closed, insulated column, added up from masses and temperatures of its particles, while hydrate dissociates in one half and water
and gas flow from it to the other: with Kirchhoff's law (130) H = sum m c (T - T_ref) - m_h L(T_ref) is a function of the state and stays.  The rows of
heat in balance.csv, which sum what each step gave, are not asked.

Of the same column, open at its cold end and heated at its warm one, balance.csv has (363) and (364).
"""
from pathlib import Path

import numpy as np

from common import Run, finish, judge, table

CASE = Path(__file__).parent / "cases" / "enthalpy.yaml"
CAPACITY = {"mass_solid": 800.0, "mass_hydrate": 2010.0, "mass_water": 4200.0, "mass_gas": 2100.0}  # J/(kg K)
LATENT = 446120 - 132.638 * 273.15  # J/kg, at T_ref = 0 degC
SHORT = ("-time_end", "1 s", "-output_times", "0 s,1 s")


def enthalpy(v):
    return sum(c * float((v[m] * v["T"]).sum()) for m, c in CAPACITY.items()) - LATENT * float(v["mass_hydrate"].sum())


def lost(*options, ranks=1):
    """What the column's enthalpy has changed by, and what flowed with the fluids, over the heat of reaction."""
    (_, first), (_, last) = Run.of_case(CASE, "-quiet", *options, ranks=ranks).snapshots()
    heat = LATENT * float((first["mass_hydrate"] - last["mass_hydrate"]).sum())
    cold = first["position"][:, 0] > 0.5
    carried = sum(CAPACITY[m] * float((last[m] - first[m])[cold].sum()) for m in ("mass_water", "mass_gas")) * 4.0  # K between the halves
    return (enthalpy(last) - enthalpy(first)) / heat, carried / heat


rows = [(name, *lost(*options, ranks=ranks)) for name, ranks, options in (
    ("10 cells", 1, ()), ("20 cells", 1, ("-grid_cells", "20,1")), ("40 cells", 1, ("-grid_cells", "40,1")), ("10 cells, 2 ranks", 2, ()),
    ("10 cells, 1 s", 1, SHORT), ("10 cells, 1 s, hybrid", 1, (*SHORT, "-stepper_type", "hybrid", "-stepper_adapt", "yes")),
    ("10 cells, law linear", 1, ("-mat_core_latent_heat_law", "linear")))]  # fmt: skip
table(("", "enthalpy lost", "carried by the fluids"), rows)
error = [abs(row[1]) for row in rows]
for k, bar in enumerate((1e-4, 1e-4, 1e-4, 1e-4, 5e-5, 3e-5)):
    judge("fluids", f"closed column, {rows[k][0]}: enthalpy of the state lost, of the heat of reaction", error[k], bar)
judge("fluids", "closed column: enthalpy lost on two ranks, apart from one", abs(rows[3][1] - rows[0][1]), 1e-9)
judge("fluids", "closed column with (235), whose heat depends on the way: lost, of the heat of reaction", error[6], (0.02, 0.1))

# (442): what (235) gives beyond what the state stores is known, and not missing
HYBRID = ("-stepper_type", "hybrid", "-stepper_adapt", "yes")
LINEAR = ("-mat_core_latent_heat_law", "linear", *SHORT)
beyond = []
for name, ranks, options in (("implicit", 1, ()), ("implicit, 2 ranks", 2, ()), ("hybrid", 1, HYBRID)):
    b = Run.of_case(CASE, "-quiet", *LINEAR, *options, ranks=ranks).balance
    heat = abs(b["heat_source_J"][-1])
    beyond.append((name, b["latent_beyond_J"][-1] / heat, b["enthalpy_error_J"][-1] / heat))
    judge("fluids", f"closed column with (235), {name}: missing of the enthalpy, of the heat of reaction", abs(beyond[-1][2]), 5e-5)
    judge("fluids", f"closed column with (235), {name}: beyond what the state stores, of the heat of reaction", abs(beyond[-1][1]), (0.02, 0.1))
table(("(235)", "beyond the state", "missing"), beyond)
judge("fluids", "closed column with (235): beyond the state on two ranks, apart from one", abs(beyond[1][1] / beyond[0][1] - 1), 1e-9)


OPEN = ("-boundaries", "out,warm", "-bc_out_type", "pressure", "-bc_out_side", "right", "-bc_out_pressure", "2.9 MPa", "-bc_out_saturation", "free",
        "-bc_warm_type", "heat_flux", "-bc_warm_side", "left", "-bc_warm_flux", "2 kW/m^2", *SHORT)  # fmt: skip


def opened(name, *options, ranks=1):
    """What is missing in the open column, over what left with the fluids; the column of enthalpy against the particles."""
    run = Run.of_case(CASE, "-quiet", *OPEN, *options, ranks=ranks)
    b, last = run.balance, enthalpy(run.snapshots()[-1][1])
    judge("fluids", f"open column, {name}: enthalpy_J against the particles", abs(b["enthalpy_J"][-1] / last - 1), 1e-9)
    kept = b["enthalpy_J"] + b["enthalpy_out_J"] - b["heat_in_J"] - b["enthalpy_error_J"]
    judge("fluids", f"open column, {name}: enthalpy_error_J is what is missing", np.ptp(kept) / abs(last), 1e-12)
    return b["enthalpy_error_J"][-1] / b["enthalpy_out_J"][-1], b["enthalpy_out_J"][-1] / abs(last)


found = [(name, *opened(name, *options, ranks=ranks)) for name, ranks, options in (
    ("10 cells", 1, ()), ("20 cells", 1, ("-grid_cells", "20,1")), ("2 ranks", 2, ()), ("hybrid", 1, HYBRID))]  # fmt: skip
table(("open", "missing, of what left", "what left, of the enthalpy"), found)
for name, missing, _ in found:
    judge("fluids", f"open column, {name}: enthalpy of the state missing, of what left with the fluids", abs(missing), {"20 cells": 0.005}.get(name, 0.015))
judge("fluids", "open column: enthalpy missing on two ranks, apart from one", abs(found[2][1] - found[0][1]), 1e-6)
finish()
