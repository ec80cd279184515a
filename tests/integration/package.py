#!/usr/bin/python3
"""The Python package clathra against the files themselves: BP2 for a minute on 1 and 2 ranks, and what is no run."""
import re
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import Run as Tested  # noqa: E402
from common import ROOT, check, check_true, finish, scratch  # noqa: E402

import clathra  # noqa: E402  python/, which common puts on the path

TIMES = (0.0, 30.0, 60.0)
OPTIONS = ("-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s", "-output_probe_every", "10 s", "-meters", "end",
           "-meter_end_side", "right")  # fmt: skip


def refuses(name, call, *words):
    try:
        call()
    except (KeyError, clathra.NoRun) as error:
        check_true(name, all(w in str(error) for w in words), error)
    else:
        check_true(name, False, "nothing was refused")


def units(folder):
    """{array: unit} of a run's first snapshot."""
    with h5py.File(folder / "fields" / "000000.h5") as file:
        return {name: np.asarray(data.attrs["unit"]).astype(str).item() for name, data in file["particles"].items()}


def check_units(run):
    """The page's table of arrays and units against the files' own: of the plane, and what a scene of space has besides."""
    rows = re.findall(r"^\| (\S+) \| (`.*) \|$", (ROOT / "docs" / "running.md").read_text().split("## In Python")[1].split("\n## ")[0], re.M)
    page = {name: unit for unit, names in rows for name in re.findall(r"`(\w+)`", names)}
    space = Tested.of_case(ROOT / "tests" / "verification" / "cases" / "heater_corners_3d.yaml", "-quiet", "-time_end", "1 s", "-output_times", "0 s,1 s")
    own = units(run.folder) | units(space.out)
    check_true("arrays and units of docs/running.md are those of the files", page == own, sorted(page.items() ^ own.items()))


def check_snapshots(run):
    check("snapshots at their times", np.max(np.abs(run.times - TIMES)), 0.0)
    for k, time in enumerate(TIMES):
        with h5py.File(run.folder / "fields" / f"{k:06d}.h5") as file:
            raw = {name: data[()] for name, data in file["particles"].items()}
        found = run.particles(time)
        order = np.argsort(raw["id"])
        check_true(f"{time:g} s: all variables, by id, as in the file", set(found) == set(raw) and all(
            np.array_equal(found[v], raw[v][order]) for v in raw), f"{len(raw)} variables")  # fmt: skip
    check_true("without a time the last ones", np.array_equal(run.particles()["S_h"], run.particles(60)["S_h"]))
    check_true("scalars are (n,), vectors (n, 2)", found["S_h"].shape == (50,) and found["displacement"].shape == (50, 2))
    refuses("a time without a snapshot", lambda: run.particles(31), "31 s", "30 s")
    with h5py.File(run.folder / "fields" / "000002.h5") as file:
        raw = {name: data[()] for name, data in file["grid"].items()}
    grid = run.grid()
    check_true("the grid's fields", all(np.array_equal(grid[v], raw[v], equal_nan=True) for v in raw) and raw["p_w"].shape == (2, 14))
    check_true("and their coordinates", np.allclose(grid["x"], np.arange(14) * 1.04 / 13) and len(grid["y"]) == 2)


def check_tables(run, tested):
    rows = (run.folder / "probes.csv").read_text().splitlines()
    column = rows[0].split(",").index("surface.T_degC")
    check_true("a probe's column", np.array_equal(run.probe("surface")["T_degC"], [float(r.split(",")[column]) for r in rows[1:]]))
    check_true("a meter's columns", np.array_equal(run.meter("end")["water_kg"], run.meters["end.water_kg"]) and len(run.meters["time_s"]) == 7)
    check_true("the ledger", len(run.balance["step"]) == int(run.balance["step"][-1]) and run.balance["time_s"][-1] == 60)
    refuses("no such probe", lambda: run.probe("midle"), "midle", "p06, surface")
    check_true("it is finished, and says so", run.finished and run.summary in tested.output)


def check_case(run):
    case = run.case
    check_true("numbers in SI units", case["time_end"] == 60 and case["region_column_pressure"] == 3.25e6 and case["output_times"] == list(TIMES))
    check_true("words, lists, quoted texts", case["mat_sediment_kinetics_active"] == "yes" and case["grid_cells"] == [13, 1]
               and run.names("probes") == ["p06", "surface"] and run.title.startswith("BP2"), run.title)  # fmt: skip
    check_true("a function of time", case["bc_load_normal"]["table"][1] == 3.25e6, case["bc_load_normal"])
    text = scratch() / "case.yaml"
    text.write_text("title: 'it''s 1: 2'\nregion:\n  a:\n    polygon: [[0 m, 1 m], [2 m, 3 m]]\n    circle: [none, none, none]\n  b:\n    Sh: 0\n")
    check_true("quotes, points, siblings", clathra.read_case(text) == {
        "title": "it's 1: 2", "region_a_polygon": [[0, 1], [2, 3]], "region_a_circle": ["none"] * 3, "region_b_Sh": 0})  # fmt: skip


def main():
    one, two = (Tested.of_case("bp2", *OPTIONS, ranks=ranks) for ranks in (1, 2))
    run = clathra.Run(one.out)
    check_units(run)
    check_snapshots(run)
    check_tables(run, one)
    check_case(run)
    other = clathra.Run(str(two.out)).particles(60)
    check("the same particles from 2 ranks: largest difference in p, Pa", np.max(np.abs(other["p"] - run.particles(60)["p"])), 1e-2)
    refuses("a key that the case does not have", lambda: run.case["mat_nothing"], f"{run.folder}/case.yaml has no mat_nothing")
    (run.folder / "probes.csv").write_text("time_s,p.p_Pa\n0,1\n1\n")
    refuses("a damaged table", lambda: clathra.Run(one.out).probes, "probes.csv, line 3: no row of 2 numbers")
    refuses("a folder without a run", lambda: clathra.Run(scratch()), "holds no run")
    finish()


main()
