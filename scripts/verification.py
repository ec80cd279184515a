#!/usr/bin/python3
"""Runs the verification tests and writes what they measured: docs/studies/verification.md, every number, and docs/verification.md, a row a test;
and tests/README.md, which test guards what.

verification.py [CLATHRA] [--jobs N] [--only NAME ...] [--no-figures]

CLATHRA     the program, default build/clathra
--jobs N    tests at a time, default 2
--only      run only these tests (stems of files in tests/), and take the others' numbers from results/verification, or from the page as it is;
            without a name none is run, and both pages are written anew
--no-figures  leave docs/figures as it is

What a test shows is the first sentence of its docstring.  Each test notes its numbers with common.record() in results/verification/<test>.json.  Figures 6, 7 and 9 to 11 of the paper, with
the reference's curves, are drawn by reference.py into docs/figures.  Ends with 1 if a test failed.
"""
import argparse
import ast
import json
import math
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import clathra
import dated
import reference

ROOT = Path(__file__).resolve().parents[1]
RESULTS = ROOT / "results" / "verification"
GUARDS = ROOT / "tests" / "README.md"
PAGE, ALL, FIGURES = ROOT / "docs" / "verification.md", dated.STUDIES / "verification.md", ROOT / "docs" / "figures"
sys.path.insert(0, str(ROOT / "tests" / "verification"))

ROWS = {  # of the table: what is shown
    1: "BP2, cases 1 and 2, against the reference curves at every 20 s: 50 cells, 4 particles a cell, default options",
    2: "The same with 100 cells and a tight tolerance: half of each bar",
    3: "Order in time on smooth BP2 loading, by self-convergence",
    4: "Terzaghi's consolidation, linear limit: water, and gas-water mixture; triangular and constant load",
    5: "Exact large-strain consolidation (Xie and Leo 2004)",
    6: "Undrained closed forms, with and without kinetics; load and full unload",
    7: "Water and methane balance, at every step",
    8: "Rest: two layers of different saturation under one pressure; hydrostatic column",
    9: "Jacobian against differences at random states, each boundary type",
    10: "The same column along x and along y; mirrored; shifted by a fraction of a cell",
    11: "Mandel's problem in the plane",
    12: "Strip load on saturated clay, k = 1e-16 m^2: no checkerboard",
    13: "Closed adiabatic cell; dissociation at constant p and T; S_h from 0.5 to 0",
    14: "Rigid rotation of a stressed body; Jaumann simple shear",
    15: "A run cut in two by a restart equals the straight run",
    16: "Bad cases, truncated and random files are refused with a reason",
    17: "Big steps: BP2 case 2 at fixed dt = 50 s and 100 s",
}
SECTION = {  # beside that table
    "4.1": "Field sets: a superfluous field changes nothing (rtol 1e-8), and what leaving it out saves",
    "4.2": "Geometry about an axis: exact solutions, balances, rest, ranks, and the plane far from the axis",
    "4.3": "Boundary conditions and meters",
    "4.4": "Masuda's core, cases/masuda, against the reference curves at every 15 min to 4 h",
    "4.5": "The ladder of cases, against exact solutions (docs/cases.md)",
    "surfaces": "Surfaces that shear and turn: an all-round pressure changes nothing",
    "plates": "Rigid plates that move with the body: confined compression, forces, rough and loose plates, a footing",
    "geostatic": "Initial states in balance with gravity: nothing moves when the run starts (docs/equations.md, section 13)",
    "scenes": "cases/shear_box and cases/sea_floor on coarse grids: motion under any pressure; a falling sea against consolidation in one dimension",
    "narrow": "Capillary pressure that grows with hydrate (docs/laws.md, (320))",
    "gas": "Sediment without gas: gas that appears, vanishes, is let in (docs/equations.md, section 19); gas that is stretched (section 12)",
    "fluids": "Fluids: real methane, equilibrium in salt water, viscosities, ice, heat of reaction, thermal strain and pressurisation, heat of compression",
    "layers": "Layers of sand and clay: flow along and across them, a well in one",
    "sealed layers": "A layer of a sealed body keeps its own pressure as far as its cells let it: storage of hybrid and of implicit steps, with Skempton's share of the load; a heated slope",
    "settling": "Exchange within cells: its rate; sand that is drained under clay, whose border settles into the cells",
    "fronts": "Sharp fronts: heat behind an inlet, saturations beside a pressure, hydrate ahead of a heater",
    "wells": "Wells about an axis against Thiem, in cells up to twenty times their radius",
    "plane_wells": "A well in the plane against Thiem and Theis, anywhere in its cell",
    "graded": "Cells that differ: patch tests, rest, free fall, Terzaghi with fine cells at the drain, a well of 0.1 m in 100 m",
    "space": "Space (clathra3d): scenes of the plane drawn out along any axis by all integrators, a cube at rest under the sea, a square footing, restart",
    "energy": "Mechanical energy: what is left of its balance",
    "integrators": "Integrators of both kinds on one scene: a wave and consolidation (exact), a reacting column, BP2 1000 times faster",
    "century": "Long runs: cases/century, 500 years of consolidation at large strain, and cases/century_hydrate, the same with hydrate",
    "strength": "Mohr-Coulomb: softening along a plastic path, orders of the integrators, Salencon's hole",
    "slopes": "Slopes: failure against limit equilibrium, blocks that meet, a column under water, a change of integrator (docs/studies/slopes.md)",
    "corners": "Heaters: temperatures at their corners, and beside hydrate (docs/equations.md, (395), (446))",
    "beds": "Beds that dip: flow through layered sediment against the exact one (docs/equations.md, (306)-(309))",
    "stability": "Stability at the extremes: a representative part of docs/studies/stability.md",
    "8.": "1, 2 and 4 ranks agree (rtol 1e-9)",
}
NOT_A_TEST = {"common", "exact"}
INTEGRATION = ("ranks", "restart", "slope", "warming")  # of tests/integration: those that record lines of the table


def tests():
    found = [p for p in sorted((ROOT / "tests" / "verification").glob("*.py")) if p.stem not in NOT_A_TEST]
    found = [p for p in found if not p.stem.startswith("_")]
    return found + [p for n in INTEGRATION if (p := ROOT / "tests" / "integration" / f"{n}.py").is_file()]


def run_test(path, program):
    """(verdict, last line, seconds, everything it printed)."""
    (RESULTS / f"{path.stem}.json").unlink(missing_ok=True)
    start = time.monotonic()
    done = subprocess.run([sys.executable, str(path), str(program)], env={**os.environ, "CLATHRA_RESULTS": str(RESULTS)},
                          stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                          text=True, errors="replace")  # fmt: skip
    (RESULTS / f"{path.stem}.txt").write_text(done.stdout)
    counts = re.findall(r"^\d+ passed, \d+ failed$", done.stdout, re.M)
    said = counts[-1] if counts else f"ended with exit code {done.returncode}"
    print(f"{'ok  ' if done.returncode == 0 else 'FAIL'} {path.stem:24s} {said}, {time.monotonic() - start:.0f} s", flush=True)
    return done.returncode == 0


def figures(program):
    """Both cases of BP2 and Masuda's core as they stand, then the figures."""
    bp2, masuda = (clathra.Case(ROOT / "cases" / name, program) for name in ("bp2", "masuda"))
    for name, case in (("bp2_case2", bp2), ("bp2_case1", bp2.with_(mat_sediment_kinetics_active=False)), ("masuda", masuda)):
        case.run(RESULTS / name, options=("-quiet",))
    reference.bp2(RESULTS / "bp2_case1", RESULTS / "bp2_case2", FIGURES)
    reference.masuda(RESULTS / "masuda", FIGURES)
    subprocess.run([sys.executable, str(ROOT / "tests" / "verification" / "strip_load.py"), str(program),
                    str(FIGURES / "strip_load.png")], check=True, stdout=subprocess.DEVNULL)  # fmt: skip


def script(test):
    return next((p for folder in ("verification", "integration") if (p := ROOT / "tests" / folder / f"{test}.py").is_file()), None)


def link(test, page):
    path = script(test)
    return f"[{path.name}]({os.path.relpath(path, page.parent)})" if path else test


def escape(text):
    return str(text).replace("|", "\\|")


def rows_of(records, row):
    mine = [r for r in records if str(r["row"]) == str(row)]
    lines = ["| what | bar | measured | test |", "|---|---|---|---|"]
    for r in mine:
        mark = "" if r["ok"] else " **missed**"
        lines.append(f"| {escape(r['what'])} | {escape(r['bar'])} | {escape(r['measured'])}{mark} | {link(r['test'], ALL)} |")
    return lines if mine else []


def records_of(text):
    """{test: its records} of a page: what rows_of() and every_number() made of them."""
    found, row, rows = {}, None, {f"{f'{k}. ' if isinstance(k, int) else ''}{title}": k for k, title in {**ROWS, **SECTION}.items()}
    for line in text.splitlines():
        if line.startswith("## "):
            row = rows.get(line[3:])
        elif row is not None and line.count(" | ") >= 3 and (cells := re.fullmatch(r"\| (.*) \| (.*) \| (.*) \| \[(\w+)\.py\].* \|", line)):
            what, bar, measured, test = (c.replace("\\|", "|") for c in cells.groups())
            record = {"row": row, "what": what, "bar": bar, "measured": measured.removesuffix(" **missed**"), "ok": not measured.endswith(" **missed**"), "test": test}
            found.setdefault(test, []).append(record)
    return found


ELSEWHERE = {
    9: "Shown by [tests/unit/test_point.c](../tests/unit/test_point.c) (a particle's tangent) and "
       "[tests/unit/test_model.c](../tests/unit/test_model.c) (the exact Jacobian, every entry); they print the largest differences.",
    14: "Shown by [tests/unit/test_point.c](../tests/unit/test_point.c), which prints the table of errors and orders.",
    16: "Shown by [tests/bad/run.py](../tests/bad/run.py), which also runs under the address sanitizer.",
}  # fmt: skip


def counted(records):
    missed = sum(not r["ok"] for r in records)
    return f"{len(records)} numbers, {missed} outside their bars. A bar is a limit of the test: `./check` fails outside it."


def every_number(records):
    """The page of all numbers, by what they show."""
    rows = {str(k) for k in {**ROWS, **SECTION}}
    if homeless := sorted({f"{r['row']} of {r['test']}" for r in records if str(r["row"]) not in rows}):
        sys.exit(f"no section of the page for: {', '.join(homeless)}")
    text = [*dated.head("Every number of the verification", "scripts/verification.py", ALL, since="Tests are run again as they change, so that each number is of the last run of its test."),
            counted(records), "[A row a test](../verification.md) is a shorter page.", ""]  # fmt: skip
    for row, title in {**ROWS, **SECTION}.items():
        number = f"{row}. " if isinstance(row, int) else ""
        text += [f"## {number}{title}", "", *(rows_of(records, row) or [ELSEWHERE.get(row, "No numbers yet.").replace("](../", "](../../")]), ""]
    return "\n".join(text).rstrip() + "\n"


def shows(test):
    """What a test of docs/verification.md shows."""
    return first_sentence(script(test))


def first_sentence(path):
    """The first sentence of a test's docstring, or of the comment it begins with, without numbers of rows and sections and what stands in brackets."""
    source = path.read_text()
    text = ast.get_docstring(ast.parse(source)) if path.suffix == ".py" else re.search(r"/\*(.*?)\*/", source, re.S)[1]
    text = " ".join(text.split("\n\n")[0].split())
    text = re.sub(r"^(Row \d+|Section [\d.]+): ", "", text)
    while (bare := re.sub(r" ?\([^()]*\)", "", text)) != text:
        text = bare
    text = re.split(r"\.(?= [A-Z`]|$)", text)[0]
    return text if "/" in text.split()[0] else text[0].upper() + text[1:]


def share(record):
    """How far a number has gone on its way to its bar, 1 at the bar; of two bars, from the middle between them.  None without such a bar.
    The middle is the geometric one where the bars are a hundredfold apart, and 0 where the lower one is 0."""
    number = lambda text: float(text.split()[0])
    if record["bar"][0] != "<" and " to " not in record["bar"]:
        return None
    low, high = map(number, record["bar"].replace("< ", "0 to ").split(" to "))
    value = number(record["measured"])
    if low == 0:
        return value and (value / high if high else math.inf)
    if high >= 100 * low > 0 and value > 0:
        low, high, value = map(math.log, (low, high, value))
    return abs(value - (low + high) / 2) / ((high - low) / 2)


def row_of(test, records):
    shares = [s for s in map(share, records) if s is not None]
    worst = (f"{max(shares):.3g}" if shares else "-") + ("" if all(r["ok"] for r in records) else " **missed**")
    return f"| {link(test, PAGE)} | {escape(shows(test))} | {sum(r['bar'] != '-' for r in records)} | {worst} |"


def overview(records):
    """The page with a row a test, in the order of what they show."""
    order, found = [str(k) for k in {**ROWS, **SECTION}], {}
    for r in sorted(records, key=lambda r: order.index(str(r["row"]))):
        found.setdefault(r["test"], []).append(r)
    text = ["# Verification", "",
            "Written by `scripts/verification.py`, which runs the tests named here; change them, not this page.", "",
            counted(records), "[All of them](studies/verification.md) stand on a page of their own, by what they show.", "",
            "*Judged*: how many numbers the test holds against a bar.",
            "*Worst*: the largest of them as a share of its bar; 1 is at the bar.",
            "Between two bars it is the distance from their middle as a share of half of what lies between them (of logarithms where the bars are a hundredfold apart).",
            "Exact solutions are in `tests/verification/exact*.py`, reference curves in `cases/bp2/reference` and `cases/masuda/reference`.", "",
            *(f"- {ROWS[row]}: {words[0].lower()}{words[1:]}" for row, words in ELSEWHERE.items()), "",
            "| test | what it shows | judged | worst |", "|---|---|---|---|",
            *(row_of(test, mine) for test, mine in found.items()), ""]  # fmt: skip
    names = {"fig09_case1": "BP2 case 1 (kinetics off): Figure 9 of the paper",
             "fig10_case2": "BP2 case 2 (kinetics on): Figure 10",
             "fig11_profiles": "BP2 case 2, profiles at 500 s and 1000 s: Figure 11",
             "masuda_contours": "Masuda's core, 60 x 10 cells: Figure 6",
             "masuda_curves": "Masuda's core: Figure 7",
             "strip_load": "Strip load after one step of 1 s: excess pressure over the load, with and without stabilisation"}  # fmt: skip
    text += ["## Figures", ""]
    for name, title in names.items():
        if (FIGURES / f"{name}.png").is_file():
            text += [f"![{title}](figures/{name}.png)", "", f"{title}.", ""]
    return "\n".join(text).rstrip() + "\n"


def guards():
    """The page of tests/: each test, its ring, and what it guards."""
    build = (GUARDS.parent / "CMakeLists.txt").read_text()
    full = set(re.search(r"^list\(APPEND full\s([^)]*)\)", build, re.M)[1].split())
    text = ["# Tests", "", "Written by `scripts/verification.py` from the first sentence of each test; change that.", "",
            "`./check` runs the tests without *full*; `./check --full` runs all of them, unit tests on two ranks and under sanitizers, too.", "",
            "| test | ring | what it guards |", "|---|---|---|"]  # fmt: skip
    for folder, pattern in (("unit", "test_*.c"), ("space", "test_*.c"), ("integration", "[a-z]*.py"), ("verification", "[a-z]*.py"), ("bad", "run.py")):
        for path in sorted((GUARDS.parent / folder).glob(pattern)):
            if path.stem not in NOT_A_TEST:
                ring = "full" if f"{folder}.{path.stem}" in full else ""
                text.append(f"| [{folder}/{path.name}]({folder}/{path.name}) | {ring} | {escape(first_sentence(path))} |")
    return "\n".join(text) + "\n"


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("\n\n", 1)[1])
    parser.add_argument("program", nargs="?", default=str(ROOT / "build" / "clathra"))
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--no-figures", action="store_true")
    given = parser.parse_args()
    RESULTS.mkdir(parents=True, exist_ok=True)
    program = Path(given.program).resolve()
    wanted = [t for t in tests() if given.only is None or t.stem in given.only]
    with ThreadPoolExecutor(given.jobs) as pool:
        passed = list(pool.map(lambda t: run_test(t, program), wanted))
    if not given.no_figures:
        figures(program)
    known = {t.stem for t in tests()}
    fresh = {p.stem: json.loads(p.read_text()) for p in RESULTS.glob("*.json") if p.stem in known}
    kept = {t: r for t, r in records_of(ALL.read_text()).items() if given.only is not None and t in known and t not in given.only}
    found = kept | fresh
    records = [r for t in sorted(found) for r in found[t]]
    if wanted:
        dated.measured(ALL)
    ALL.write_text(every_number(records))
    PAGE.write_text(overview(records))
    GUARDS.write_text(guards())
    print(f"{PAGE}, {ALL}: {len(records)} numbers from {len(found)} tests")
    return 0 if all(passed) else 1


if __name__ == "__main__":
    sys.exit(main())
