#!/usr/bin/python3
"""What a run leaves and says: fields.h5 and its XDMF, probes.csv, balance.csv, the resolved case, messages, exit codes.

The scene is the first minute of BP2 case 2 on 13 cells.
"""
import os
import re
import sys
import xml.etree.ElementTree as xml
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, Run, binary, check, check_true, finish, launch, run, scratch  # noqa: E402

BOUNDARIES = Path(__file__).resolve().parents[1] / "verification" / "cases" / "boundaries.yaml"
OPTIONS = ("-progress", "0", "-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s", "-output_probe_every", "10 s")
QUANTITIES = ["p_Pa", "p_w_Pa", "p_g_Pa", "T_degC", "S_h", "S_w", "S_g", "u_x_m", "u_y_m", "sxx_Pa", "syy_Pa", "szz_Pa",
              "sxy_Pa", "x_m", "y_m"]  # fmt: skip
TIMES = [0.0, 30.0, 60.0]
BP2 = CASES / "bp2"
good = Run.of_case("bp2", *OPTIONS)


def says(name, done, code, *words):
    """The program ended with this exit code and said all these words."""
    missing = [w for w in words if w not in done.stdout]
    note = f"exit code {done.returncode}" + (f", it did not say {missing}: ...{done.stdout[-300:]}" if missing else "")
    check_true(name, done.returncode == code and not missing, note)


# ------------------------------------------------------------------------------------------ fields.h5, particles.xdmf, grid.xdmf
def check_fields():
    with h5py.File(good.out / "fields.h5", "r") as file:
        for kind, rows in (("particles", 50), ("grid", None)):
            groups = [file[kind][k] for k in sorted(file[kind])]
            times = [float(g.attrs["time"].ravel()[0]) for g in groups]
            check_true(f"fields.h5: one file a snapshot of /{kind}",
                       sorted(p.name for p in (good.out / "fields").iterdir()) == [f"{k:06d}.h5" for k in range(3)])  # fmt: skip
            check_true(f"fields.h5: times of /{kind}", np.allclose(times, TIMES[-len(times):]) and len(times) >= 2, times)
            values = [g[k] for g in groups for k in g]
            check_true(f"fields.h5: every dataset of /{kind} has a unit", all("unit" in v.attrs for v in values))
            if rows:
                check_true("fields.h5: 50 particles, all values finite",
                           all(len(v) == rows and np.all(np.isfinite(v[()])) for v in values))  # fmt: skip
                check_true("fields.h5: sorted by id", all(np.array_equal(g["id"][()], range(rows)) for g in groups))
            else:
                check_true("fields.h5: nodal fields on 2 x 14 nodes", all(v.shape[:2] == (2, 14) for v in values))


def check_xdmf(kind, times):
    """One time series a file, as every reader of ParaView takes it: in_paraview.py asks them themselves."""
    root, items, bad = xml.parse(good.out / f"{kind}.xdmf").getroot(), 0, []
    for item in root.iter("DataItem"):
        if item.get("Format") != "HDF":
            continue
        name, _, path = item.text.strip().partition(":")
        shape = tuple(int(n) for n in item.get("Dimensions").split())
        items += 1
        with h5py.File(good.out / name, "r") as file:
            if path not in file or np.prod(file[path].shape) != np.prod(shape):
                bad.append(item.text)
            elif file[path].dtype.itemsize != int(item.get("Precision")):
                bad.append(item.text)
    series = root.find("Domain").findall("Grid")
    names = [{a.get("Name") for a in grid.findall("Attribute")} for grid in series[0].findall("Grid")]
    with h5py.File(good.out / "fields.h5", "r") as file:
        held = [set(file[kind][k]) for k in sorted(file[kind])]
    check_true(f"{kind}.xdmf: well-formed XDMF", root.tag == "Xdmf" and items > 0, f"{items} datasets")
    check_true(f"{kind}.xdmf: refers to what is in the snapshots, of its size and precision", not bad, ", ".join(bad[:3]))
    check_true(f"{kind}.xdmf: one series, of its name and times", [s.get("Name") for s in series] == [kind]
               and [float(t.get("Value")) for t in series[0].iter("Time")] == times)  # fmt: skip
    check_true(f"{kind}.xdmf: every array by its name", len(names) == len(times) and all(
        n == h - {"position", "vertex"} for n, h in zip(names, held)), sorted(names[0] ^ held[0]))  # fmt: skip


# ------------------------------------------------------------------------------------------ text files
def bad_ends(text):
    """Numbers with a point and nothing behind it, before a unit."""
    return re.findall(r"\d+\. (?:s|m|Pa|MPa|degC|K|kg)\b", text)


def check_tables():
    columns = ["time_s"] + [f"{probe}.{q}" for probe in ("p06", "surface") for q in QUANTITIES]
    check_true("probes.csv: columns", list(good.probes) == columns)
    check_true("probes.csv: a row every 10 s", np.allclose(good.time, np.arange(0, 61, 10), rtol=0, atol=1e-9))
    check_true("probes.csv: all finite", all(np.all(np.isfinite(v)) for v in good.probes.values()))
    p, share = good.probe("p06"), None
    share = p["S_w"] / (p["S_w"] + p["S_g"])
    check_true("probes.csv: S_w + S_g + S_h = 1", np.allclose(p["S_w"] + p["S_g"] + p["S_h"], 1, atol=1e-9))
    check_true("probes.csv: p is the mean of p_w and p_g", np.allclose(p["p_Pa"], share * p["p_w_Pa"] +
               (1 - share) * p["p_g_Pa"], rtol=1e-5))  # fmt: skip
    check_true("probes.csv: a probe follows the body", np.allclose(p["x_m"], 0.6 + p["u_x_m"], atol=1e-9))
    b = good.balance
    check_true("balance.csv: a row a step, dt adds up", np.array_equal(b["step"], range(1, len(b["step"]) + 1))
               and np.allclose(np.cumsum(b["dt_s"]), b["time_s"]) and abs(b["time_s"][-1] - 60) < 1e-9)  # fmt: skip
    check_true("summary.txt: the end of what was printed", (good.out / "summary.txt").read_text() in good.output)
    log = (good.out / "log.txt").read_text().splitlines()
    check_true("log.txt: the command, then all that was said", log[0].startswith("# ") and "bp2 -progress 0 -grid_cells 13,1 -time_end '60 s'" in log[1]
               and sorted(log[2:]) == sorted(good.output.splitlines()), log[1])  # fmt: skip
    check_true("numbers end with a digit, and a time has the unit it is read in", not bad_ends(good.output) and "to t = 60 s" in good.output, bad_ends(good.output))
    long = run(binary(), CASES / "bp2", "-time_end", "60 days", "-output_times", "0 s", "-stepper_max_steps", "1")
    check_true("... days are days", "to t = 60 days" in long.output and not bad_ends(long.output), long.output[:300])
    steps = [s for s in good.output.splitlines() if s.startswith("step")]
    check_true("a line a step with percentage and time left", len(steps) == len(b["step"]) and "(100.0 %)" in steps[-1]
               and steps[-1].endswith(" 0 s left"), steps[-1])  # fmt: skip
    known = [(float(re.search(r"\(([\d.]+) %\)", s)[1]), s.endswith(" left")) for s in steps[3:]]  # three steps say nothing
    check_true("time left is named from 5 % on, not before", all(is_known == (share >= 5) for share, is_known in known if abs(share - 5) > 0.1) and steps[0].endswith("time left not known yet"), known)


def check_resolved():
    again = run(binary(), good.out / "case.yaml")
    same = [f for f in ("probes.csv", "balance.csv") if (again.out / f).read_bytes() == (good.out / f).read_bytes()]
    check_true("the resolved case runs to the same probes and ledgers, bit for bit", len(same) == 2, same)
    a, b = good.snapshots(), again.snapshots()
    check_true("... and to the same particles", len(a) == len(b) == 3 and all(
        t == u and set(x) == set(y) and all(x[k].tobytes() == y[k].tobytes() for k in x)
        for (t, x), (u, y) in zip(a, b)))  # fmt: skip
    rest = lambda r: [s for s in (r.out / "case.yaml").read_text().splitlines() if not s.startswith(("#", "output_dir"))]
    check_true("... and resolves to itself", rest(good) == rest(again))


# ------------------------------------------------------------------------------------------ runs that end badly
def check_failure():
    out = scratch() / "out"
    absurd = ("-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s", "-stepper_dt_min", "1e-3 s",
              "-bc_load_normal_table", "0 s,3.25 MPa,20 s,3.45 MPa,21 s,1e5 MPa")  # fmt: skip
    done = launch(binary(), BP2, *absurd, out=out)
    says("a load of 100 GPa: exit code 3, what failed and where, where the state is", done, 3, "Given up at t = ",
         "near (", " m", "last good state", str(out / "checkpoint.h5"), "stopped at t")  # fmt: skip
    given_up = next((s for s in done.stdout.splitlines() if s.startswith("Given up")), "")
    fields = ("momentum", "mass", "energy", "pressure", "volume", "porosity", "temperature", "strain", "cell", "grid")
    check_true("... which field", any(f in given_up for f in fields), given_up)
    check_true("... the files are there", all((out / f).is_file() for f in ("probes.csv", "fields.h5", "summary.txt")))
    with h5py.File(out / "checkpoint.h5", "r") as file:
        t, step = (file["state"][k][()].ravel()[0] for k in ("t", "step"))
    check_true("... the state is from the kink or later", 20 <= t < 21, f"t = {t:.6g} s after {step} steps")
    again = launch(binary(), BP2, *absurd, "-restart", out / "checkpoint.h5", out=out)
    says("... and restarts, to the same end", again, 3, "Given up at t = ")
    rows = Run(out).balance["step"]
    check_true("... with the ledger of all its steps", np.array_equal(rows, range(1, len(rows) + 1)) and len(rows) >= step)
    go_on = launch(binary(), BP2, *absurd, "-time_end", f"{t + 1e-6} s", "-output_times", "0 s", "-restart",
                   out / "checkpoint.h5", "-stepper_dt_min", "1e-9 s", out=out)  # fmt: skip
    says("... and runs with a smaller step", go_on, 0, "finished")


def check_left():
    """What Newton's method left in the balances (277): little with its own tolerances, much with loose ones; the ledger, which gives it back (28), sees neither."""
    for name, options, least, most in (("default", (), 0.0, 2e-6), ("loose", ("-newton_tol_residual", "1e-4", "-newton_tol_update", "1e-1"), 1e-3, 1.0)):
        run = Run.of_case("bp2", "-quiet", "-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,60 s", *options)
        left = re.search(r"left in the balances by Newton's method: water (\S+), gas (\S+) of what moved", run.output)
        check_true(f"{name} tolerances: what is left is told", left is not None, run.output[-300:])
        worst = max(map(float, left.groups()))
        check(f"{name} tolerances: largest share that is left", worst, (least, most))
        check(f"{name} tolerances: the ledger, all the same", np.max(np.abs([run.balance[f"{w}_error"] for w in ("water", "methane")])), 1e-13)


def check_loose():
    """What is accepted above the tolerance is counted."""
    loose = Run.of_case("bp2", *OPTIONS, "-stepper_tol", "1e-7", "-stepper_dt", "5 s", "-stepper_dt_min", "5 s", "-stepper_dt_max", "5 s")
    summary, steps = (loose.out / "summary.txt").read_text(), len(loose.balance["step"])
    check_true("steps above the tolerance are counted in summary.txt", f"{steps} steps were accepted above the tolerance" in
               summary and " 0 refused" in summary, summary)  # fmt: skip
    check_true("... and beside the steps and refusals", f"; {steps} steps above the tolerance" in summary, summary)
    check_true("... and progress names the field that rules", "of tolerance (" in loose.output)
    place = r"\(([\w ]+) near \(([-\d.e+]+), ([-\d.e+]+)\) m\)"
    told = re.search(r"largest error of a step at any particle: (\S+) of the tolerance, of (\S+) near \((\S+), (\S+)\) m at t = ", summary)
    steps_told = [(float(e), float(x)) for e, _, x, _ in re.findall(r"at worst (\S+) " + place, loose.output)]
    check_true("the worst particle is named, in the summary and in each line of progress", told is not None and len(steps_told) > 3, summary)
    check_true("... within the body, and no line of progress has more", 0 <= float(told[3]) <= 1 and 0 <= float(told[4]) <= 0.1
               and max(steps_told)[0] <= float(told[1]) * 1.06 and all(0 <= x <= 1 for _, x in steps_told), f"{told[0]}, {max(steps_told)}")  # fmt: skip
    check_true("... a run within it says nothing", "accepted above" not in (good.out / "summary.txt").read_text())


def check_probe_range():
    """A probe at a surface beside a jump of hydrate: its saturations are from 0 to 1, and add up to 1."""
    split, z = "0.95 m", "0.05 m"
    strip = Run.of_case(BOUNDARIES, "-quiet", "-fields", "water", "-time_end", "1 s", "-stepper_dt", "1 s", "-regions", "strip,bare", "-region_strip_Sh", "0.4",
                        "-region_strip_upper", f"{split},0.1 m", "-region_bare_lower", f"{split},0 m", "-region_bare_upper", "1 m,0.1 m",
                        "-region_bare_material", "sand", "-region_bare_pressure", "5 MPa", "-region_bare_temperature", "10 degC",
                        "-probe_left_at", f"0.9 m,{z}", "-probe_middle_at", f"0.94 m,{z}", "-probe_right_at", f"1 m,{z}")  # fmt: skip
    at = [strip.probe(name) for name in ("left", "middle", "right")]
    Sh = [p["S_h"][-1] for p in at]
    check_true("a probe at a surface has no negative hydrate", 0.4 >= Sh[0] >= Sh[1] >= Sh[2] and abs(Sh[2]) < 1e-12, str(Sh))
    check_true("... and its saturations add up to 1", all(abs(p["S_h"][-1] + p["S_w"][-1] - 1.0) < 1e-12 for p in at))


def check_forecast():
    for name, tol in (("mcwhorter_sunada", 1e-3), ("mcwhorter_sunada", 1e-4), ("terzaghi", 1e-3), ("century", 1e-2)):
        done = Run.of_case(name, "-stepper_tol", tol)
        says, took = float(re.search(r"implicit about ([\d.e+]+) steps", done.output)[1]), len(done.balance["step"])
        check_true(f"{name}, tol {tol}: the forecast's steps (317) within a factor of two of those it takes", 0.5 < says / took < 2, f"{says:g} and {took}")


def check_refusals():
    out = scratch() / "out"
    says("-case_check: valid", launch(binary(), BP2, "-case_check", out=out), 0, "the case is valid")
    says("an unknown option", launch(binary(), BP2, "-grid_cell", "3,1", out=out), 2, "-grid_cell", "grid_cells")
    says("-case_check of a wrong case", launch(binary(), BP2, "-case_check", "-mat_sediment_porosity", "1.5", out=out), 2,
         "mat_sediment_porosity", "1.5")  # fmt: skip
    says("a snapshot after the end", launch(binary(), BP2, "-time_end", "60 s", out=out), 2, "output_times", "time_end")
    says("more ranks than the grid has room for", launch(binary(), BP2, "-grid_cells", "3,1", ranks=4, out=out), 2,
         "grid_cells = 3, 1", "use fewer ranks")  # fmt: skip
    says("no such case", launch(binary(), "/nowhere/case.yaml", out=out), 2, "/nowhere/case.yaml")
    says("no case", launch(binary(), "-quiet"), 2, "name a case")
    says("a misspelt option of PETSc's: the run ends with a warning that nobody read it", launch(binary(), BP2, *OPTIONS, "-stepper_max_steps", "1",
         "-ksp_typ", "gmres", out=scratch() / "spelt"), 0, "warning: option -ksp_typ was not used")  # fmt: skip
    check_true("none of them wrote anything", not out.exists())
    blocked = scratch() / "file"
    blocked.write_text("in the way")
    for name, folder in (("is a file", blocked), ("lies below a file", blocked / "out")):
        says(f"an output folder that {name}", launch(binary(), BP2, *OPTIONS, out=folder), 2, str(folder))
    closed = Path("/proc") if os.geteuid() == 0 else scratch()  # root may write everywhere but there
    if os.geteuid() != 0:
        closed.chmod(0o555)
    says("an output folder without permission", launch(binary(), BP2, *OPTIONS, out=closed), 2, str(closed))
    check_true("... without a PETSc trace", "PETSC ERROR" not in launch(binary(), BP2, *OPTIONS, out=closed).stdout)


check_fields()
check_xdmf("particles", TIMES)
check_xdmf("grid", TIMES[1:])
check_tables()
check_resolved()
check_failure()
check_left()
check_loose()
check_probe_range()
check_forecast()
check_refusals()
finish()
