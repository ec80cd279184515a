#!/usr/bin/python3
"""What bounds an implicit step, as the summary says it: of runs whose steps are bounded by one thing, and shares that make up the whole.

The scene is BP2 on 13 cells.
"""
import csv
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, binary, check, check_true, finish, run, scratch, seconds  # noqa: E402

BP2 = (CASES / "bp2", "-grid_cells", "13,1", "-output_times", "0 s", "-output_probe_every", "0 s", "-quiet")
LINE = re.compile(r"^  (stable step|steps of) (\S+ \S+) to (\S+ \S+) \((.*)\)$", re.M)


def bounds(name, *options, ranks=1):
    """Shares in %, by what bounded the steps; the ends of their range, s; and dt of all of them, s."""
    out = scratch() / name
    done = run(binary(), *BP2, *options, out=out, ranks=ranks)
    found = LINE.search((out / "summary.txt").read_text())
    if not found:
        check_true(f"{name}: the summary says what bounded the steps", False, done.stdout[-800:])
        sys.exit(finish())
    span = [seconds(w) for w in found.group(2, 3)]
    rows = list(csv.DictReader(l for l in (out / "balance.csv").read_text().splitlines() if not l.startswith("#")))
    shares = {w: float(v) for w, v in re.findall(r"([^,(][^,(]*?) ([\d.e+-]+) %", found[4])}
    return {w.strip(): v for w, v in shares.items()}, span, [float(r["dt_s"]) for r in rows if float(r["dt_s"]) > 0], found[1]


def judge(name, shares, span, dt):
    check_true(f"{name}: steps of", shares and sum(shares.values()) > 0, shares)
    check(f"{name}: shares, %", sum(shares.values()), (99.4, 100.6))  # three digits each
    check(f"{name}: shortest step, over the ledger's", span[0] / min(dt), (0.994, 1.006))
    check(f"{name}: longest", span[1] / max(dt), (0.994, 1.006))


def main():
    rest = ("-time_end", "400 s")
    # the scene, the word, and the least share of its steps, %
    for name, options, word, least in (
        ("error", (*rest, "-stepper_tol", "1e-4"), "error of", 60),
        ("output", (*rest, "-output_every", "2 s"), "times to be hit", 80),
        ("longest", (*rest, "-stepper_dt_max", "3 s"), "stepper_dt_max", 60),
        ("shortest", ("-time_end", "20 s", "-stepper_tol", "1e-9", "-stepper_dt_min", "1 s", "-stepper_dt", "1 s"), "stepper_dt_min", 60),
        ("growth", ("-time_end", "5 s", "-stepper_tol", "0.1", "-stepper_dt", "1e-6 s"), "growth from step to step", 50),
        # three iterations are too few for some steps; half of Newton's update takes a dozen a stage
        ("refused", ("-time_end", "100 s", "-stepper_tol", "0.1", "-snes_max_it", "3"), "refused steps", 50),
        ("newton", ("-time_end", "0.1 s", "-stepper_tol", "0.1", "-stepper_dt", "1e-3 s", "-snes_linesearch_type", "basic", "-snes_linesearch_damping", "0.5"), "Newton's method", 90),
        ("fixed", ("-time_end", "40 s", "-stepper_adapt", "no", "-stepper_dt", "2 s"), "stepper_dt", 90),
    ):
        shares, span, dt, _ = bounds(name, *options)
        judge(name, shares, span, dt)
        check(f"{name}: share of {word}, %", sum(v for w, v in shares.items() if w == word or word == "error of" and w.startswith(word)), (least, 100))
    one, two = (bounds(f"ranks{n}", *rest, ranks=n) for n in (1, 2))
    check_true("two ranks say the same", one[0] == two[0] and one[1] == two[1], f"{one[:2]} {two[:2]}")
    check("growth: the first steps", one[0].get("growth from step to step", 0.0) + one[0].get("begin or kink", 0.0), (1, 60))
    shares, _, _, kind = bounds("hybrid", "-time_end", "0.05 s", "-stepper_type", "hybrid")
    check_true("hybrid says its limit in the same place", kind == "stable step" and abs(sum(shares.values()) - 100) < 0.6, f"{kind}, {shares}")
    finish()


main()
