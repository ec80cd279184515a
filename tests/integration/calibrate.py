#!/usr/bin/python3
"""clathra calibrate and clathra.calibrate: Terzaghi's column gives back the permeability, and permeability and stiffness, with which it was made; runs
that fail, and targets that tell nothing, are said."""
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import binary, check, check_true, command, finish, scratch  # noqa: E402

import clathra  # noqa: E402

K0, E0 = "mat_clay_permeability_k0", "mat_clay_elasticity_E0"
OUT = scratch()
CASE = clathra.Case("terzaghi", binary()).with_(grid_cells=[8, 1], time_end="4 h", output_times="4 h", output_probe_every="10 min", stepper_adapt=False, stepper_dt="10 min")


def measured(**keys):
    """What a run with these keys gives of pressure and settlement."""
    run = CASE.with_(**keys).run(OUT / "made", options=("-overwrite",))
    return {name: run.columns[name] for name in ("base.p_Pa", "end.u_x_m")}


def permeability():
    """By the command, from a file with gaps, and from a start that is 10 times off."""
    target = measured(mat_clay_permeability_k0=1e-14)
    t, p = target["base.p_Pa"]
    rows = [f"{a!r},{b!r}" if k % 3 else f"{a!r},nan" for k, (a, b) in enumerate(zip(t.tolist(), p.tolist()))]
    (OUT / "measured.csv").write_text("\n".join(["time_s,base.p_Pa", *rows]) + "\n")
    CASE.write(OUT / "column.yaml")
    words = (OUT / "column.yaml", f"{K0}=1e-17 m^2,1e-13 m^2,log", OUT / "measured.csv", "--out", OUT / "one")
    done = command("calibrate", *words)
    said = [line.split() for line in done.stdout.splitlines() if line.startswith(f"{K0} = ")]
    check_true("clathra calibrate says the value, its unit and its error", done.returncode == 0 and len(said) == 1 and "m^2, standard error" in " ".join(said[0]), done.stdout[-400:] + done.stderr)
    check("permeability, relative", abs(float(said[0][2]) / 1e-14 - 1), 1e-2)
    again = command("calibrate", *words)
    first, *others = (line for line in again.stdout.splitlines() if line.startswith("  "))
    check_true("a second time nothing is run", again.returncode == 0 and first.count("finished before") == 1 and all("finished before" in line for line in others), again.stdout[-300:])


def two():
    """Noise of 0.2 % of each column's range leaves standard errors of a tenth of a percent (the same as ten times the noise makes ten times as large)."""
    target, random = measured(mat_clay_permeability_k0=3e-15, mat_clay_elasticity_E0=2e7), np.random.default_rng(1)
    noise = {name: 0.002 * np.ptp(v) for name, (_, v) in target.items()}
    noisy = {name: (t, v + random.normal(0, noise[name], len(v)), noise[name]) for name, (t, v) in target.items()}
    fit = clathra.calibrate(CASE, {K0: (1e-17, 1e-13, "log"), E0: ("1 MPa", "100 MPa", "log")}, noisy, OUT / "two")
    check("both: permeability, relative", abs(fit.values[K0] / 3e-15 - 1), 1e-2)
    check("... stiffness, relative", abs(fit.values[E0] / 20 - 1), 1e-2)
    check("... standard error of the permeability, m^2", fit.errors[K0], (1.5e-18, 3.5e-18))
    check("... of the stiffness, MPa", fit.errors[E0], (0.007, 0.017))
    check("... by which they are off", max(abs(fit.values[K0] - 3e-15) / fit.errors[K0], abs(fit.values[E0] - 20) / fit.errors[E0]), 3)
    check("... and by the noise the run", np.std(fit.residuals["end.u_x_m"]) / noise["end.u_x_m"], (0.6, 1.4))
    check_true("... which is the case with these values", fit.converged and not fit.failed and fit.run.case[K0] == fit.values[K0] and abs(fit.run.case[E0] / fit.values[E0] / 1e6 - 1) < 1e-9, len(fit.parts))


def fails():
    """Where runs fail the search turns back; where the first does, or the target is none, an exception says so."""
    load = "bc_load_normal"
    case = CASE.with_({load: 1.5e6}, stepper_max_failures=1)
    target = {"end.u_x_m": case.with_({load: 5e6}).run(OUT / "pressed").columns["end.u_x_m"]}
    fit = clathra.calibrate(case, {load: (1e5, 1e8, "log")}, target, OUT / "turns")
    check("a search that steps to a load that closes the pores turns back: load, relative", abs(fit.values[load] / 5e6 - 1), 1e-2)
    check_true("... and says which values failed, and how", fit.failed and all(part.values[load] > 5e6 and "Given up" in part.said for part in fit.failed), fit.failed)
    for name, words, call in (
        ("the first run fails: its values", ("mat_clay_porosity=0.4", "Given up"), lambda: clathra.calibrate(case.with_({load: 1e9}), {"mat_clay_porosity": (0.3, 0.5)}, target, OUT / "a")),
        ("a key that there is not", ("mat_clay_porosty", "did you mean"), lambda: clathra.calibrate(CASE, {"mat_clay_porosty": (0.3, 0.5)}, target, OUT / "b")),
        ("bounds the wrong way round", ("mat_clay_porosity", "low below high"), lambda: clathra.calibrate(CASE, {"mat_clay_porosity": (0.5, 0.3)}, target, OUT / "c")),
        ("two units", (E0, "one unit"), lambda: clathra.calibrate(CASE, {E0: ("1 MPa", "1 GPa")}, target, OUT / "c")),
        ("a column that there is not", ("no column top.p_Pa", "base.p_Pa"), lambda: clathra.calibrate(CASE, {E0: (1e6, 1e8)}, {"top.p_Pa": ([0], [1])}, OUT / "d")),
        ("a time after the end", ("base.p_Pa", "outside of the rows"), lambda: clathra.calibrate(CASE, {E0: (1e6, 1e8)}, {"base.p_Pa": ([1e9], [1])}, OUT / "d")),
    ):
        try:
            call()
            check_true(name, False, "nothing was refused")
        except clathra.Failed as error:
            check_true(name, all(w in str(error) for w in words), error)
    (OUT / "twice.csv").write_text("time_s,base.p_Pa,base.p_Pa\n60,1e5,1e5\n")
    for name, keys, said in (("no file", (f"{K0}=1e-15,1e-14", OUT / "none.csv"), "none.csv"), ("two columns of one name", (f"{K0}=1e-15,1e-14", OUT / "twice.csv"), "twice.csv has two columns base.p_Pa"), ("no range", (K0, OUT / "measured.csv"), "is no range")):
        done = command("calibrate", OUT / "column.yaml", *keys, "--out", OUT / "e")
        check_true(f"clathra calibrate, {name}: a sentence", done.returncode in (2, 3) and said in done.stderr and "Traceback" not in done.stderr and done.stderr.count("\n") == 1, done.stderr)


for part in (permeability, two, fails):
    part()
finish()
