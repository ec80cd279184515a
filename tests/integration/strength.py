#!/usr/bin/env python3
"""clathra strength: what it takes for standing and for failing, on made-up energies; a block that vibrates, in the plane and in space, with
brackets that begin too high and too low; bad input.
"""
import contextlib
import io
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, binary, check, check_true, environment, finish, scratch  # noqa: E402

from clathra import strength  # noqa: E402  python/, which common puts on the path

BLOCK = ROOT / "tests" / "verification" / "cases" / "vibrating_block.yaml"
SWAPS = (  # the block drawn out along z
    ("upper: [2 m, 1.25 m], cells: [16, 10]", "upper: [2 m, 1.25 m, 0.125 m], cells: [16, 10, 1]"), ("lower: [0 m, 0 m]", "lower: [0 m, 0 m, 0 m]"),
    ("upper: [1 m, 1 m]", "upper: [1 m, 1 m, 0.125 m]"), ("-10 m/s^2]", "-10 m/s^2, 0 m/s^2]"), ("[2, 2]", "[2, 2, 2]"), ("[base, left]", "[base, left, back, front]"),
    ("bc:\n", "bc:\n  back: {type: roller, axis: z, position: 0 m}\n  front: {type: roller, axis: z, position: 0.125 m}\n"))  # fmt: skip


# ---------------------------------------------------------------- what keeps moving
def judged(sway=(-1.0, 0.7, -0.8, 1.0), **columns):
    """The verdict on made-up energies at 1000 times of a stage from 1 s to 3 s; elastic energy 1 J unless given."""
    t = np.linspace(1.0, 3.0, 1001)
    table = {f"{name}_J": np.zeros_like(t) for name in ("kinetic_energy", "plastic_work", "removed_plastic", "gravity_work", "load_work", "plate_work")}
    table |= {"time_s": t, "elastic_energy_J": np.ones_like(t)} | {f"{name}_J": of((t - 1.0) / 2.0) for name, of in columns.items()}
    ids = np.arange(3)
    u = [(ids, np.array([[0.0, 0.0], [0.1, 0.0], [0.5 + 0.03 * s, 0.04 * s]])) for s in sway]
    return strength.judge(strength.Energies(table, 1.0, 3.0), u)


def verdicts():
    swings = lambda s: 0.1 * np.sin(40 * np.pi * s) ** 2
    for what, stands, word, columns in (
        ("nothing moves", True, "at rest", {}),
        ("it swings", True, "vibrates, by 0.05 m", {"kinetic_energy": swings, "gravity_work": lambda s: 1.0 + np.sin(40 * np.pi * s)}),
        ("it swings and yields once more", True, "vibrates, by 0.05 m to either side, plastic work is 0.4 %", {"kinetic_energy": swings, "plastic_work": lambda s: 1.0 + 4e-3 * (s > 0.93)}),
        ("it moves on, with little energy", True, "comes to rest", {"kinetic_energy": lambda s: 0 * s + 1e-3, "sway": (-1.0, -0.4, 0.3, 1.0)}),
        ("it flows on", False, "flows", {"plastic_work": lambda s: s}),
        ("it begins to flow at the end", False, "flows", {"plastic_work": lambda s: np.maximum(s - 0.95, 0.0)}),
        ("it flows less and less, but still does", False, "flows", {"plastic_work": lambda s: 1.0 - np.exp(-10.0 * np.maximum(s - 0.7, 0.0))}),
        ("it comes to rest", True, "comes to rest", {"plastic_work": lambda s: 2.0 + 0.1 * (1.0 - np.exp(-40.0 * np.maximum(s - 0.8, 0.0)))}),
        ("it creeps at a constant speed", False, "creeps", {"plastic_work": lambda s: 9.0 + 0.1 * s}),
        ("it falls", False, "moves off", {"kinetic_energy": lambda s: s**2, "gravity_work": lambda s: s**2}),
        ("it consolidates", True, "at rest", {"load_work": lambda s: s}),
    ):  # fmt: skip
        good, why = judged(**columns)
        check_true(f"{what}: {'stands' if stands else 'fails'}, {word}", good == stands and word in why, why)


# ---------------------------------------------------------------- runs
def launch(*words, program=None, path=None, cwd=None):
    more = {"TMPDIR": str(scratch())} | ({} if path is None else {"PATH": str(path)})
    return subprocess.run([program or binary(), "strength", *map(str, words)], env=environment(**more), cwd=cwd, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, timeout=300)  # fmt: skip


def reduced(case, *words, **how):
    """{factor: (stands, why)} in the order of the runs, and the bracket."""
    done = launch(case, *words, **how)
    print(done.stdout, end="")
    rows = re.findall(r"^strength factor (\S+) +(stands|fails ): (.*)", done.stdout, re.M)
    last = re.search(r"^factor of safety \S+: stands at (\S+), fails at (\S+)$", done.stdout, re.M)
    return {float(f): (word == "stands", why) for f, word, why in rows}, tuple(map(float, last.groups())) if last else None


def block():
    """Elastic it would swing about rho g H^2 (1 - nu^2)/(2 E) = 0.91 mm; at F = 1.28 it yields little, at 2.56 in its first swings and then no more."""
    flat, ends = reduced(BLOCK, "--low", 1.28, "--high", 2.56, "--tol", 3)
    by = float(re.search(r"vibrates, by (\S+) m", flat[1.28][1])[1]) if "vibrates" in flat[1.28][1] else 0.0
    check("a block that vibrates is said to, by what it settles at rest", by / 0.91e-3, (0.8, 1.2))
    check_true("... and after it has yielded; the bracket goes up to what fails", "vibrates" in flat[2.56][1] and flat[2.56][0] and ends == (2.56, 5.12) and not flat[5.12][0], ends)
    text = BLOCK.read_text()
    for old, new in SWAPS:
        assert old in text, old
        text = text.replace(old, new)
    folder = scratch()
    (folder / "block.yaml").write_text(text)
    drawn, ends = reduced("block.yaml", "--low", 8, "--high", 10, "--tol", 3, "--out", "runs", program=Path(binary()).resolve(), cwd=folder)
    check_true("in space, from a bracket that is too high down to what stands", ends == (2.56, 5.12) and list(drawn) == [8.0, 5.12, 2.56] and "vibrates" in drawn[2.56][1], ends)
    check_true("... with the runs kept", sorted(f.name for f in (folder / "runs").iterdir()) == ["2.56", "5.12", "8", "first"], folder)
    same = lambda runs, f: (runs[f][0], runs[f][1][:8], runs[f][1].split()[-2][:4])
    check_true("... as in the plane", all(same(flat, f) == same(drawn, f) for f in (2.56, 5.12)), (flat, drawn))


def refused():
    full, bare = scratch(), scratch()
    (full / "mine").write_text("mine")
    (bare / "python3").write_text(f'#!/bin/sh\nexec {os.path.realpath("/usr/bin/python3")} -S -E "$@"\n')
    (bare / "python3").chmod(0o755)
    elastic = scratch() / "elastic.yaml"
    elastic.write_text(re.sub(r" +plasticity:.*\n", "", BLOCK.read_text()))
    for what, words, said in (
        ("a bracket the wrong way round", ("case", "--low", 3, "--high", 2), ("--low 3", "--high 2")),
        ("no number", ("case", "--low", "many"), ("--low", "many")),
        ("a tolerance of zero", ("case", "--tol", 0), ("--tol", "'0'")),
        ("a factor beyond all sense", ("case", "--high", 1e4), ("--high", "10000")),
        ("an unknown option", ("case", "--growth", 0.1), ("--growth",)),
        ("no rank", ("case", "--ranks", 0), ("--ranks 0",)),
        ("no case", ("--low", 1), ("CASE",)),
    ):
        text, code = io.StringIO(), 0
        try:
            with contextlib.redirect_stderr(text):
                strength.arguments(list(map(str, words)))
        except SystemExit as stopped:
            code = stopped.code
        check_true(f"refused: {what}: exit code 2, and said", code == 2 and all(w in text.getvalue() for w in said), text.getvalue())
    for what, words, said, how in (
        ("a case that is not there", ("nowhere",), ("nowhere",), {}),
        ("a stage that is not there", (BLOCK, "--stage", "dig"), ("--stage dig", "no stages"), {}),
        ("a case without a strength", (elastic,), ("strength_factor", "plasticity_law"), {}),
        ("a folder that holds something", (BLOCK, "--out", full), ("--out", str(full)), {}),
        ("an unknown option of clathra", (BLOCK, "--", "-grid_cels", "8,5"), ("grid_cels",), {}),
        ("no python3", (BLOCK,), ("python3", "numpy"), {"path": scratch()}),
        ("a python3 without numpy", (BLOCK,), ("numpy", "python3-numpy"), {"path": bare}),
    ):
        done = launch(*words, **how)
        check_true(f"refused: {what}: exit code 2, and said", done.returncode == 2 and all(w in done.stdout for w in said) and "Traceback" not in done.stdout, done.stdout)
    check_true("... and nothing there is touched", [f.name for f in full.iterdir()] == ["mine"])
    done = launch("--help")
    check_true("--help explains", done.returncode == 0 and all(w in done.stdout for w in ("--low F", "--stage NAME", "plastic work", "vibrates")), done.stdout)
    copy = scratch() / "clathra"
    shutil.copy(binary(), copy)
    done = launch("--help", program=copy)
    check_true("a copy of the program without its Python package says what it needs", done.returncode == 2 and "clathra/__main__.py" in done.stdout, done.stdout)


for part in (verdicts, block, refused):
    part()
finish()
