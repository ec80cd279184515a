#!/usr/bin/python3
"""clathra sweep and clathra compare: every combination once, resumed where it was ended, in one table; differences as they are."""
import csv
import shutil
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, check, check_true, command, finish, scratch  # noqa: E402

import clathra  # noqa: E402
from clathra import compare  # noqa: E402
from clathra.sweep import finished, named  # noqa: E402

FIXED = ("-stepper_adapt", "no", "-stepper_dt", "100 s", "-time_end", "600 s", "-output_times", "600 s", "-output_probe_every", "100 s")
KEYS = ("mat_clay_permeability_k0=1e-15 m^2,1e-14 m^2", "grid_cells=8,1|16,1")


def call(*words):
    done = command(*words)
    return done.returncode, done.stdout + done.stderr


def check_sweep(out):
    code, said = call("sweep", "terzaghi", *KEYS, "--out", out, "--", *FIXED, "-stepper_max_steps", "2")
    check_true("a sweep that is ended after two steps", code == 0 and not any(finished(f) for f in out.iterdir() if f.is_dir()), said[-200:])
    code, said = call("sweep", "terzaghi", *KEYS, "--out", out, "--", *FIXED)
    with open(out / "sweep.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    check_true("one row a combination", code == 0 and [(r["mat_clay_permeability_k0"], r["grid_cells"]) for r in rows] == [
        (k, g) for k in ("1e-15 m^2", "1e-14 m^2") for g in ("8,1", "16,1")], said[-300:])  # fmt: skip
    folders = sorted(f for f in out.iterdir() if f.is_dir())
    check_true("all went on from their checkpoints to their end", len(folders) == 4 and all(
        clathra.Run(f).finished and "-restart" in clathra.Run(f).log and len(clathra.Run(f).balance["step"]) == 6 for f in folders))  # fmt: skip
    last = [clathra.Run(out / named({k: r[k] for k in ("mat_clay_permeability_k0", "grid_cells")})).probes["base.p_Pa"][-1]
            for r in rows]  # fmt: skip
    check("the table's values are the runs' last ones", np.max(np.abs(np.array([float(r["base.p_Pa"]) for r in rows]) - last)), 0.0)
    check_true("which differ between the rows", len(set(last)) == 4 and (out / "sweep.png").is_file())
    before = [(f / "balance.csv").stat().st_mtime_ns for f in folders]
    code, said = call("sweep", "terzaghi", *KEYS, "--out", out, "--", *FIXED)
    check_true("what has finished is not run again", said.count("finished before") == 4 and before == [(f / "balance.csv").stat().st_mtime_ns for f in folders])
    check_changed(out / "changed")
    code, said = call("sweep", "terzaghi", "mat_clay_porosity=0.4,1.4", "--out", out / "bad", "--", *FIXED)
    check_true("a wrong value costs its own run only", code == 2 and "exit code 0" in said and "mat_clay_porosity = '1.4'" in said, said[-300:])
    return folders


def check_changed(out):
    """What has finished, or begun, under another case or other options is run anew, whatever has changed."""
    out.mkdir()
    case, name = out / "case.yaml", "mat_clay_permeability_k0=1e-15 m^2"
    text = (ROOT / "cases" / "terzaghi" / "case.yaml").read_text()
    again = lambda *options: call("sweep", case, name, "--out", out, "--", *FIXED, *options)
    last = lambda: float(clathra.Run(out / named(dict([name.split("=")]))).probes["base.p_Pa"][-1])
    case.write_text(text)
    code, said = again()
    first = last()
    for what, edit, options, other in (("a property", ("porosity: 0.4", "porosity: 0.3"), (), True), ("numerics alone", ("type: sdirk2", "type: euler"), (), True), ("an option of the solver", ("", ""), ("-newton_tol_residual", "1e-10"), False)):
        changed = text.replace(*edit, 1)
        check_true(f"{what}: there is something to change", changed != text or options, edit)
        case.write_text(changed)
        code, said = again(*options)
        check_true(f"{what} has changed: anew", code == 0 and said.count("have changed: anew") == 1 and (last() != first) == other, f"{said[-200:]} {first} {last()}")
    code, said = again(*options)
    check_true("... and not again", code == 0 and said.count("finished before") == 1, said[-200:])
    case.write_text(text.replace("porosity: 0.4", "porosity: 0.2"))
    again("-stepper_max_steps", "2")
    case.write_text(text)
    code, said = again()
    check_true("nor is what another state of the case has begun gone on with", code == 0 and "have changed: anew" in said and last() == first, said[-200:])


def check_floor(folder, noisy):
    """Round-off in a component that is zero is no difference; a thousandth of the field is."""
    shutil.copytree(folder, noisy)
    rows = list(csv.reader((noisy / "probes.csv").open()))
    syy, sxy = (max(abs(float(r[k])) for r in rows[1:]) for k in (rows[0].index(f"base.{c}_Pa") for c in ("syy", "sxy")))
    for share, wanted in ((1e-10, []), (1e-3, ["base.sxy_Pa"])):
        k, table = rows[0].index("base.sxy_Pa"), [list(r) for r in rows]
        for r in table[1:]:
            r[k] = repr(float(r[k]) + share * syy)
        with open(noisy / "probes.csv", "w", newline="") as stream:
            csv.writer(stream).writerows(table)
        found = [name for name, *_ in compare.largest(clathra.Run(folder), clathra.Run(noisy))]
        check_true(f"a shear stress off by {share:g} of the largest stress, itself at most {sxy:.1e} Pa", found == wanted, found)


def compared(folder, other):
    """What clathra compare says of the differences of two runs, and of damage."""
    damaged = []
    return compare.differences([clathra.Run(f, damaged.append) for f in (folder, other)], ["a", "b"], damaged)[1:], damaged


def edited(path, edit):
    """Rewrites the cells of a table: edit(rows)."""
    rows = list(csv.reader(path.open()))
    edit(rows)
    with open(path, "w", newline="") as stream:
        csv.writer(stream, lineterminator="\n").writerows(rows)


def other_value(path):
    with h5py.File(path, "r+") as file:
        file["particles/displacement"][0, 0] += 1e-3


def flipped(path):
    """One bit of the displacements."""
    with h5py.File(path, "r") as file:
        at = file["particles/displacement"].id.get_chunk_info(0).byte_offset
    data = bytearray(path.read_bytes())
    data[at + 10] ^= 1
    path.write_bytes(data)


def check_same(folder, out):
    """Nothing that differs, is missing or is damaged passes for the same; what is the same does."""
    last = sorted((folder / "fields").iterdir())[-1].name
    nan = lambda rows: rows[3].__setitem__(1, "nan")
    for what, file, damage, words in (
        ("nothing", "probes.csv", lambda p: None, ["b: the same, as far as it goes (but for round-off)"]),
        ("a NaN", "probes.csv", lambda p: edited(p, nan), ["base.p_Pa", "in one alone", "200"]),
        ("the header alone", "probes.csv", lambda p: edited(p, lambda rows: rows.__delitem__(slice(1, None))), ["base.p_Pa", "in one alone"]),
        ("half of the rows", "probes.csv", lambda p: edited(p, lambda rows: rows.__delitem__(slice(3, None))), ["base.p_Pa", "in one alone"]),
        ("a column less", "probes.csv", lambda p: edited(p, lambda rows: [r.pop() for r in rows]), ["in one alone"]),
        ("two columns of one name", "probes.csv", lambda p: edited(p, lambda rows: rows[0].__setitem__(2, rows[0][1])), ["has two columns base.p_Pa"]),
        ("a word for a number", "probes.csv", lambda p: edited(p, lambda rows: rows[2].__setitem__(2, "x")), ["line 3: no row of"]),
        ("no byte", "probes.csv", lambda p: p.write_bytes(b""), ["is empty"]),
        ("another value in a snapshot", f"fields/{last}", other_value, ["particles.displacement", "0.001", "600"]),
        ("a bit of a snapshot", f"fields/{last}", flipped, [f"fields/{last} is missing or damaged"]),
        ("half of a snapshot", f"fields/{last}", lambda p: p.write_bytes(p.read_bytes()[:9000]), [f"fields/{last} is missing or damaged", "at t = 600 s there is a snapshot"]),
        ("no snapshot", f"fields/{last}", Path.unlink, [f"fields/{last} is missing or damaged", "at t = 600 s there is a snapshot"]),
        ("no list of snapshots", "fields.h5", lambda p: p.write_bytes(b"no list"), ["fields.h5 is missing or damaged", "at t = 600 s there is a snapshot"]),
    ):  # fmt: skip
        other = out / what.replace(" ", "_")
        shutil.copytree(folder, other)
        damage(other / file)
        lines, damaged = compared(folder, other)
        said = "\n".join([*lines, *damaged])
        check_true(f"clathra compare, {what} in {file}", all(w in said for w in words) and ("b: the same" in said) == (what == "nothing"), said[-200:])
    check_true("the same NaN in both is the same", "b: the same" in "".join(compared(out / "a_NaN", out / "a_NaN")[0]))
    code, said = call("compare", folder, out / "no_byte", "--out", out)
    check_true("what is damaged is an error", code == 2 and "clathra compare: " in said and "probes.csv is empty" in said and "Traceback" not in said, said[-200:])


def check_compare(folders, out):
    code, said = call("compare", folders[0], folders[2], "--out", out)
    check_true("clathra compare", code == 0 and (out / "compare.png").is_file(), said[-300:])
    lines = [line.split() for line in said.splitlines()]
    a, b = (clathra.Run(f).probes["base.p_Pa"] for f in (folders[0], folders[2]))
    row = next(w for w in lines if w and w[0] == "base.p_Pa")
    check("the largest difference of a column", abs(float(row[1]) - np.max(np.abs(a - b))) / np.max(np.abs(a - b)), 1e-3)
    at = int(np.argmax(np.abs(a - b)))
    check("and its time, s", abs(float(row[3]) - clathra.Run(folders[0]).probes["time_s"][at]), 0.0)
    key = [w for w in lines if w and w[0].startswith(("mat_", "grid_", "bc_")) and "=" not in w[0]]
    check_true("the one key in which they differ", [w[0] for w in key] == ["mat_clay_permeability_k0"], key)
    check_true("a run against itself", not compare.largest(clathra.Run(folders[0]), clathra.Run(folders[0])))
    code, said = call("compare", folders[0], folders[2])
    check_true("by itself it draws among the first run's figures", code == 0 and (folders[0] / "figures" / "compare.png").is_file() and not Path("compare.png").exists())
    check_floor(folders[0], out / "noise")
    check_same(folders[0], out / "damaged")
    code, said = call("compare", folders[0], out / "nothing")
    check_true("what is no run is named", code == 2 and "nothing holds no run" in said, said[-200:])


def main():
    out = scratch()
    check_compare(check_sweep(out / "sweep"), out)
    finish()


main()
