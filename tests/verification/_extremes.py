"""Runs at the extremes and what became of them: what the test stability.py and tests/studies/stability.py share."""
import re
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from common import binary, launch, scratch
from clathra import read_csv, read_snapshots

SCENE = Path(__file__).parent / "cases" / "stability.yaml"
LENGTH, CELL, MAT, AT = 0.2, 0.02, "-mat_sand_", "-region_column_"
P, T, K, E, EH, PHI, KW, SH, SG, K0 = 7e6, 10.0, 1e-14, 1e8, 5e8, 0.4, 2.2e9, 0.2, 0.2, 2.5e-10  # of the scene as it stands


def scene(k=K, rate=1.0, Sg=SG, Sh=SH, phi=PHI, E0=E, Kw=KW, T0=T, p=P, load=1.0):
    """Options of SCENE with other properties.  Load and drawdown (0.5 MPa and 1 MPa) are smaller for soft sediment and at low
    pressure, so that what is left is a state that exists; `load` multiplies both."""
    part = load * min(1.0, E0 / E, p / P)
    return [f"{MAT}permeability_k0", f"{k} m^2", f"{MAT}kinetics_K0", f"{K0 * rate} mol/(m^2 Pa s)",
            f"{MAT}elasticity_E0", f"{E0} Pa", f"{MAT}elasticity_Eh", f"{EH * E0 / E} Pa", f"{MAT}porosity", phi,
            f"{MAT}water_bulk_modulus", f"{Kw} Pa" if np.isfinite(Kw) else "incompressible", f"{MAT}water_ref_pressure", f"{p} Pa",
            f"{AT}pressure", f"{p} Pa", f"{AT}temperature", f"{T0} degC",
            f"{AT}Sh", Sh, f"{AT}Sg", Sg, f"{AT}Sw", repr(1.0 - Sh - Sg),
            "-bc_load_normal", f"{p + 0.5e6 * part} Pa", "-bc_outlet_pressure", f"{p - 1e6 * part} Pa"]  # fmt: skip


@dataclass
class Outcome:
    """What became of a run: finished, refused (nothing was run), stopped (with a reason), or a fault: crashed, hung, silent."""

    kind: str
    said: str  # the last reason, in words
    folder: Path
    seconds: float
    nan: list = field(default_factory=list)  # places of numbers that are not finite
    steps: int = 0
    cut: int = 0
    balance: float = np.nan  # largest error of water and methane, of the initial mass
    growth: float = np.nan  # largest kinetic energy of the second half of the run over that of the first
    kinetic: float = np.nan  # largest kinetic energy, J

    @property
    def fault(self):
        return self.kind in ("crashed", "hung", "silent") or bool(self.nan)


def not_finite(folder):
    """Files and columns of a run that hold NaN or infinity; nodal fields may be NaN where there is no sediment."""
    found = []
    for path in sorted(folder.glob("*.csv")):
        found += [f"{path.name} {c}" for c, v in read_csv(path).items() if not np.all(np.isfinite(v))]
    for t, v in read_snapshots(folder):
        found += [f"particles {c} at {t:g} s" for c, a in v.items() if np.issubdtype(a.dtype, np.floating) and not np.all(np.isfinite(a))]
    for t, v in read_snapshots(folder, "grid"):
        holes = {c: np.any(~np.isfinite(a), axis=1) for c, a in v.items() if np.issubdtype(a.dtype, np.floating)}
        nowhere = np.logical_and.reduce(list(holes.values())) if holes else False
        found += [f"grid {c} at {t:g} s" for c, h in holes.items() if np.any(h & ~nowhere)]
    return found


def late_growth(b):
    """Largest kinetic energy after the middle of the run over the largest before."""
    t, e = b["time_s"], b["kinetic_energy_J"]
    late = t > 0.5 * t[-1]
    if len(t) < 4 or np.all(late) or not np.any(late) or np.max(e[~late]) <= 0.0:
        return np.nan
    return np.max(e[late]) / np.max(e[~late])


def reason(code, text):
    """(kind, reason) from exit code and output."""
    given_up = re.findall(r"^(?:Given up at.*|.*stopped.*: .*)$", text, re.M)
    if code == 0:
        return "finished", ""
    if code == 2:
        lines = [s.strip() for s in text.splitlines() if re.search(r"clathra: |yaml:\d*:?|command line:", s) and ": note: " not in s]
        return ("refused", lines[0]) if lines else ("silent", "exit code 2 without a word")
    if code == 3:
        return ("stopped", given_up[-1].strip()) if given_up else ("silent", "exit code 3 without a reason")
    return "crashed", f"exit code {code}: " + " ".join(text.split()[-12:])


def attempt(options, case=SCENE, limit=60.0, program=None, out=None):
    """Runs a case within `limit` seconds of the wall and judges how it ended."""
    out = scratch() / "out" if out is None else Path(out)
    start = time.monotonic()
    try:
        done = launch(program or binary(), case, "-quiet", *options, out=out, timeout=limit)
        kind, said = reason(done.returncode, done.stdout)
    except subprocess.TimeoutExpired:
        kind, said = "hung", f"not done after {limit:g} s"
    result = Outcome(kind, said, out, time.monotonic() - start)
    if kind in ("refused", "silent", "crashed", "hung") or not (out / "balance.csv").is_file():
        return result
    b = read_csv(out / "balance.csv")
    result.nan = not_finite(out)
    if len(b["time_s"]):
        result.steps = int(b["step"][-1])
        errors = [np.max(np.abs(b[c])) for c in ("water_error", "methane_error")]
        result.balance, result.kinetic, result.growth = max(errors), np.max(b["kinetic_energy_J"]), late_growth(b)
    refused = re.search(r"(\d+) refused", (out / "summary.txt").read_text() if (out / "summary.txt").is_file() else "")
    result.cut = int(refused.group(1)) if refused else 0
    return result


FLOORS = {"p": 1e3, "T": 0.01, "S_h": 1e-3, "displacement": 1e-8}  # smaller changes are no scale of an error


def cells(v, name):
    """Means of a variable over the particles that shared a cell of SCENE at the start: what the nodes can see."""
    start = v["position"][:, 0] - (v["displacement"][:, 0] if "displacement" in v else 0.0)
    index = np.floor(start / CELL + 1e-9).astype(int)
    return np.array([np.mean(v[name][index == i], axis=0) for i in np.unique(index)])


def difference(folder, reference, load=0.0, fields=tuple(FLOORS)):
    """{field: largest difference of cell means between the last snapshots of two runs, over the largest change in the
    reference; a pressure also over `load` (Pa), if that is larger}."""
    ends = read_snapshots(reference)
    first, last, mine = ends[0][1], ends[-1][1], read_snapshots(folder)[-1][1]
    found = {}
    for name in fields:
        if name in last and name in mine:
            a, b, c = (cells(v, name) for v in (first, last, mine))
            scale = max(np.max(np.abs(b - a)), FLOORS[name], load if name == "p" else 0.0)
            found[name] = float(np.max(np.abs(c - b)) / scale)
    return found


def stable_step(options, integrator, case=SCENE):
    """(step (s), what rules it) as hybrid or explicit print them; (nan, reason) where they refuse the scene."""
    done = launch(binary(), case, "-quiet", *options, "-stepper_type", integrator, "-stepper_adapt", "yes", "-stepper_max_steps", 1,
                  out=scratch() / "out", timeout=60)  # fmt: skip
    found = re.search(r"stable step (\S+) s:.*?; ([^;]*) rules", done.stdout)
    return (float(found.group(1)), found.group(2)) if found and done.returncode == 0 else (np.nan, reason(done.returncode, done.stdout)[1])
