"""What a run leaves in its folder, as numpy arrays.

    import clathra
    run = clathra.Run("results/well")
    run.times                              # of the snapshots, s
    run.particles(3600)["S_h"]             # (n,) at 1 h; vectors are (n, components); without a time the last ones
    run.probe("middle")["p_Pa"]            # (rows,) at run.probes["time_s"]
    run.meters["well.gas_std_m3"], run.balance["water_error"]
    run.case["mat_sand_porosity"]          # as it ran: numbers in SI units, words, lists

Quantities and units are those of the files (docs/running.md, What a run writes).  Needs numpy, and h5py for snapshots.
"""
from .case import read_case
from .run import NoRun, Run
from .tables import Damaged, probe_names, read_csv, read_snapshots
from .units import time_unit

__all__ = ["Damaged", "NoRun", "Run", "probe_names", "read_case", "read_csv", "read_snapshots", "time_unit"]
