#!/usr/bin/env python3
"""What the program says to a newcomer: -help and --help begin with the ten options that matter and name the paper; --version; times in words; heat in the
balance; every array of fields.h5 has one unit; a copied clone builds.
"""
import re
import shutil
import subprocess
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, ROOT, binary, check, check_true, finish, launch, run, scratch  # noqa: E402

TITLE = "A fully coupled THMC-MPM framework for modeling phase transition and large deformation in methane hydrate-bearing sediment"


def check_help():
    texts = [subprocess.run([binary(), word], capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout for word in ("-help", "--help")]
    check_true("-help and --help say the same", texts[0] == texts[1] and len(texts[0]) > 1000, texts[1][:200])
    head, rest = texts[0].split("Ten options that matter:\n", 1)
    ten = re.findall(r"^  -(\w+)", rest.split("\n\n", 1)[0], re.M)
    check_true("... begin with the ten options that matter", len(ten) == 10 and head.count("\n") <= 5 and "clathra strength CASE" in head and {"case_check", "output_dir", "restart", "stepper_tol"} <= set(ten), ten)
    known = (ROOT / "docs" / "options.md").read_text()
    check_true("... which there are", all(f"`{name}`" in known or f"`-{name}`" in known for name in ten), ten)
    for what, text in (("-help", texts[0]), ("README", (ROOT / "README.md").read_text())):
        check_true(f"{what} cites the paper with its title", TITLE in " ".join(text.split()))
    for of, options in (("sdirk2", ()), ("hybrid", ("-stepper_type", "hybrid"))):
        done = subprocess.run([binary(), CASES / "bp2", "--help", "-output_dir", scratch() / "none", *options], capture_output=True, text=True, stdin=subprocess.DEVNULL, timeout=60)
        check_true(f"CASE --help, {of}, checks the case and ends, with the options of its solver and nothing written",
                   done.returncode == 0 and done.stdout.startswith(head) and "the case is valid" in done.stdout and ("-ksp_rtol" in done.stdout) == (of == "sdirk2") and not (scratch() / "none").exists(), done.stdout[-300:] + done.stderr[-300:])  # fmt: skip
    for word in ("-help", "--help"):
        piped = subprocess.run(["bash", "-c", f'"$0" {word} | head -1', binary()], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        check_true(f"{word} into a pager that ends early is no crash", piped.stdout == texts[0].splitlines(True)[0] and piped.stderr == "", piped.stderr[:200])
    script = subprocess.run([ROOT / "run", "--help"], capture_output=True, text=True, stdin=subprocess.DEVNULL).stdout
    check_true("./run --help has ten that matter", "the ten that matter" in script and all(f"-{name}" in script for name in ten), script[:200])


def check_version():
    own = re.search(r"^project\(clathra VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text(), re.M)[1]
    for program in (Path(binary()), Path(binary()).with_name("clathra3d")):
        done = subprocess.run([program, "--version"], capture_output=True, text=True, stdin=subprocess.DEVNULL)
        check_true(f"{program.name} --version says its version and PETSc's", done.returncode == 0 and re.fullmatch(rf"clathra {re.escape(own)}, PETSc \d+\.\d+\.\d+\n", done.stdout), done.stdout + done.stderr)


def check_times():
    YEARS = ("-stepper_adapt", "no", "-output_probe_every", "0 s", "-progress", "0")
    for end, unit, one in (("2 a", "years", "1 year"), ("2 d", "days", "1 day"), ("2 h", "h", "1 h")):
        said = run(binary(), CASES / "heat_slab", *YEARS, "-time_end", end, "-output_times", f"1 {end[2]},{end}", "-stepper_dt", f"0.5 {end[2]}").output
        now = re.findall(r"t = ([\d.]+ \w+) \(", said)
        check_true(f"a run of {end} says {one}, and half a {one[2:]}", now == [f"0.5 {unit}", one, f"1.5 {unit}", f"2 {unit}"], now)
        check_true("... and never 1 with a plural", not re.search(r"(?<![\d.])1 (years|days)\b", said))


def check_results():
    done = run(binary(), CASES / "bp2", "-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,60 s")
    text = (done.out / "summary.txt").read_text()
    heat = re.search(r"heat (\S+) of what warms the body by 1 K$", text, re.M)
    check_true("the balance of heat says what it is a share of", heat and done.balance["heat_error"][-1] != 0, text)
    check("... as balance.csv has it", abs(float(heat[1]) / done.balance["heat_error"][-1] - 1), 0.01)
    with h5py.File(done.out / "fields.h5", "r") as file:
        units = {f"{kind}/{name}": data.attrs.get("unit", b"").decode() for kind in ("particles", "grid") for name, data in file[kind][max(file[kind])].items()}
    check_true("every array of fields.h5 has one unit", all(u and "," not in u for u in units.values()), {k: u for k, u in units.items() if not u or "," in u})
    rates = {k.split("/")[1]: u for k, u in units.items() if k.split("/")[1].startswith("rate")}
    check_true("... rates those of what changes", rates == {"rate_p_w": "Pa/s", "rate_p_g": "Pa/s", "rate_T": "K/s", "rate_S_h": "1/s"}, rates)


def check_clone():
    """A clone that was built, then copied: setup.sh configures it anew and asks for nothing."""
    first, second = (scratch() / name for name in ("first", "second"))
    (first / "scripts").mkdir(parents=True)
    shutil.copy(ROOT / "scripts" / "setup.sh", first / "scripts")
    (first / "CMakeLists.txt").write_text("cmake_minimum_required(VERSION 3.13)\nproject(toy NONE)\nadd_custom_target(made ALL COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_BINARY_DIR}/made.txt)\n")

    def build(folder):
        done = subprocess.run(["bash", "-c", "source scripts/setup.sh; setup_build build all"], cwd=folder, capture_output=True, text=True, stdin=subprocess.DEVNULL)
        return done.returncode, done.stdout + done.stderr

    check_true("a clone builds without a word", build(first) == (0, "") and (first / "build" / "made.txt").is_file())
    shutil.copytree(first, second)
    (second / "build" / "made.txt").unlink()
    code, said = build(second)
    check_true("its copy builds too, configured anew", code == 0 and "configuring it anew" in said and (second / "build" / "made.txt").is_file(), said)
    check_true("... and asks for nothing to be deleted", not re.search(r"delete|remove", said), said)
    check_true("... the second time without a word", build(second) == (0, ""))


check_help()
check_version()
check_times()
check_results()
check_clone()
finish()
