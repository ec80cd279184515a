#!/usr/bin/python3
"""Factor of safety by strength reduction.  Usage: strength_reduction.py CASE [options] [-- OPTIONS OF CLATHRA]

  --low F, --high F   bracket to begin with (1, 2); it is widened where both ends fare alike
  --tol D             bracket to end with (0.05)
  --growth G          share of its size by which a displacement may still grow (0.05)
  --stage NAME        reduce from the begin of this stage on, not from the start
  --out DIR           keep the runs there, one folder each (else a temporary folder)
  --program FILE      clathra (build/clathra)

Runs the case with `strength_factor` F (docs/equations.md (87)) and bisects.  The criterion: a body stands at F if the run
reaches its end and its largest displacement grows by less than the share G over the last fifth of it (of its last stage);
it fails if the displacement goes on growing, or if the run cannot go on (exit code 3).  So let the case load the body well
before its end and then wait: with inertia (hybrid, or an implicit integrator), a wait of some ten travels of a wave
through the body.  Prints every run, the bracket and the factor of safety, its middle.  With a dilation of 0 deg the answer
depends on the grid; the program says so, and a second grid is not optional.  Exit code 0, 2 for a bad case or options.
"""
import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from clathra import read_snapshots

ROOT = Path(__file__).resolve().parent.parent
MOST = 6  # widenings of the bracket
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}


def stop(text):
    print(text, file=sys.stderr)
    sys.exit(2)


def arguments():
    p = argparse.ArgumentParser(description="Factor of safety by strength reduction.")
    p.add_argument("case")
    for name, value in (("low", 1.0), ("high", 2.0), ("tol", 0.05), ("growth", 0.05)):
        p.add_argument(f"--{name}", type=float, default=value)
    p.add_argument("--stage")
    p.add_argument("--out")
    p.add_argument("--program", default=str(ROOT / "build" / "clathra"))
    own, theirs = (sys.argv[1:], []) if "--" not in sys.argv else (sys.argv[1 : sys.argv.index("--")], sys.argv[sys.argv.index("--") + 1 :])
    a = p.parse_args(own)
    if not (0 < a.low < a.high and a.tol > 0 and a.growth > 0):
        stop("needs 0 < low < high, tol > 0, growth > 0")
    return a, theirs


class Reduction:
    def __init__(self, a, options):
        self.a, self.options = a, options
        self.key = f"-stage_{a.stage}_strength_factor" if a.stage else "-strength_factor"
        self.folder = Path(a.out or tempfile.mkdtemp(prefix="strength-"))
        self.warned = False
        begin, end = self.last_stage()
        self.times = (begin + 0.8 * (end - begin), end)

    def launch(self, name, *more):
        out = self.folder / name
        done = subprocess.run([self.a.program, self.a.case, "-quiet", *self.options, *more, "-output_dir", str(out)], env={**os.environ, **ENVIRONMENT},
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
        if done.returncode not in (0, 3):
            stop(done.stdout)
        for line in done.stdout.splitlines():
            if "depends on the grid" in line and not self.warned:
                print(line)
                self.warned = True
        return done.returncode, out

    def last_stage(self):
        """Begin and end (s) of the last stage, or of the run, from the resolved case of a first step."""
        lines = (self.launch("first", "-stepper_max_steps", "1")[1] / "case.yaml").read_text().splitlines()
        ends = [float(line.split()[1]) for line in lines if line.startswith("    end:")]
        if ends:
            return ([0.0] + ends)[-2:]
        return 0.0, next(float(line.split()[1]) for line in lines if line.startswith("time_end:"))

    def stands(self, factor):
        times = ", ".join(f"{t:.17g} s" for t in self.times)
        code, out = self.launch(f"{factor:.6g}", self.key, f"{factor:.17g}", "-output_times", times)
        u = {t: np.hypot(*v["displacement"].T).max() for t, v in read_snapshots(out)}
        at = [next((u[t] for t in u if abs(t - wanted) <= 1e-9 * self.times[1]), None) for wanted in self.times]
        if code == 3 or None in at:
            print(f"strength factor {factor:<8.6g} fails: the run could not go on; largest displacement {max(u.values()):.4g} m", flush=True)
            return False
        growth = at[1] / at[0] - 1 if at[0] > 0 else 0.0
        good = growth < self.a.growth
        print(f"strength factor {factor:<8.6g} {'stands' if good else 'fails '}: largest displacement {at[1]:.4g} m, {100 * growth:+.2g} % in the last fifth", flush=True)
        return good


def bracket(r, low, high):
    """Ends that stand and fail."""
    for _ in range(MOST):
        if r.stands(low):
            break
        low, high = low * low / high, low
    else:
        stop("fails at every factor tried: the body does not bear its loads, or does not come to rest before the end of the run")
    for _ in range(MOST):
        if not r.stands(high):
            return low, high
        low, high = high, high * high / low
    stop("stands at every factor tried")


def main():
    a, options = arguments()
    r = Reduction(a, options)
    low, high = bracket(r, a.low, a.high)
    while high - low > a.tol * (1 + 1e-9):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if r.stands(middle) else (low, middle)
    print(f"factor of safety {0.5 * (low + high):.4g}: stands at {low:.6g}, fails at {high:.6g}")


if __name__ == "__main__":
    main()
