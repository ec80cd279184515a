"""Runs of Clathra: what they leave as numpy arrays, and cases that Python builds, checks, runs, sweeps and calibrates.

    import clathra
    run = clathra.Run("results/well")
    run.times                              # of the snapshots, s
    run.particles(3600)["S_h"]             # (n,) at 1 h; vectors are (n, components); without a time the last ones
    run.probe("middle")["p_Pa"]            # (rows,) at run.probes["time_s"]
    run.meters["well.gas_std_m3"], run.balance["water_error"]
    run.case["mat_sand_porosity"]          # as it ran: numbers in SI units, words, lists

    case = clathra.Case("terzaghi").with_(mat_clay_permeability_k0="1e-14 m^2", time={"end": "1 h"})
    case.check()                           # raises clathra.Refused with the program's words
    run = case.run("results/softer", ranks=2)
    with case.start("results/again") as job:
        for now in job:                    # every second
            print(f"{now.share:.0%}")
    clathra.sweep(case, {"grid_cells": ["20,1", "40,1"]}, "results/grids")
    clathra.calibrate(case, {"mat_clay_permeability_k0": (1e-17, 1e-13, "log")}, "measured.csv", "results/fit").values

Quantities and units are those of the files (docs/running.md, What a run writes).  Needs numpy; snapshots need h5py, calibrate scipy.
"""
from .tables import Damaged, probe_names, read_csv, read_snapshots  # isort: skip  first: says where numpy is missing
from .calibrate import calibrate
from .case import Case, find_case
from .program import Ended, Failed, GaveUp, Job, Refused, find_program
from .resolved import read_case
from .run import NoRun, Progress, Run
from .sweep import sweep
from .units import time_unit

__all__ = ["Case", "Damaged", "Ended", "Failed", "GaveUp", "Job", "NoRun", "Progress", "Refused", "Run", "calibrate", "find_case", "find_program", "probe_names",
           "read_case", "read_csv", "read_snapshots", "sweep", "time_unit"]  # fmt: skip
