"""The scenes on which integrators of both kinds are held against each other: integrators.py and tests/studies/tradeoff.py."""
import re
import resource
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from common import CASES, Run, binary, environment
from exact import constrained_modulus
from exact_dynamic import DynamicColumn

FOLDER = Path(__file__).parent / "cases"
EXPLICIT = ("explicit", "hybrid")  # stepper types whose step is bounded by stability
SDIRK2, EULER = "sdirk2", "euler"
DAMPED = ("-stepper_damping", 0.1)  # without it the hybrid's waves grow into hydrate in BP2 case 2


def integrators():
    """Stepper types of the program under test, implicit ones first."""
    keys = subprocess.run([binary(), "-case_keys"], env=environment(), capture_output=True, text=True, check=True).stdout
    names = re.search(r"^\| `stepper_type` \| ([\w, ]+) \|", keys, re.M)[1].split(", ")
    return sorted((n for n in names if n not in ("auto", "hybrid_paper")), key=lambda n: (n in EXPLICIT, n))


def explicit_ones():
    return [n for n in integrators() if n in EXPLICIT]


# ---------------------------------------------------------------------------------------------------------- running
class Timed(Run):
    """A Run that knows its processor time: `cpu` (s), of the whole process."""

    cpu = 0.0


def timed(case, *options, exit_code=0):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = Timed.of_case(case, "-quiet", *options, exit_code=exit_code)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    found = Timed(done.out, done.code, done.output)
    found.cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return found


def fixed(kind, dt):
    return "-stepper_type", kind, "-stepper_adapt", "no", "-stepper_dt", f"{dt!r} s"


def adaptive(kind, tol=1e-3):
    """An implicit integrator with a tolerance, or an explicit one with the step of its stability estimate."""
    return ("-stepper_type", kind, "-stepper_adapt", "yes", *(() if kind in EXPLICIT else ("-stepper_tol", tol)))


def steps_of(run):
    """Time steps taken, from summary.txt; explicit ones within their bursts too."""
    return int(re.search(r"(\d+) steps", (run.out / "summary.txt").read_text())[1])


# ----------------------------------------------------------------------------------------------------------- scenes
@dataclass(frozen=True)
class Scene:
    """What is run, and the curves that are compared: {name: (probe, column)}."""

    name: str
    case: object
    watched: dict
    options: tuple = ()
    end: float = 1.0
    every: float = 0.1  # s between rows that are compared
    cells: tuple = (26, 1)

    def run(self, *options, cells=None, exit_code=0):
        n = cells or self.cells
        return timed(self.case, "-grid_cells", f"{n[0]},{n[1]}", "-time_end", f"{self.end!r} s", "-output_times", "0 s",
                     "-output_probe_every", f"{self.every!r} s", *self.options, *options, exit_code=exit_code)  # fmt: skip

    def times(self):
        return self.every * np.arange(1, round(self.end / self.every) + 1)

    def curves(self, run):
        """{name: values at times()}."""
        return {name: run.at(probe, column, self.times()) for name, (probe, column) in self.watched.items()}


def apart(curves, reference):
    """{name: largest difference over the range of the reference}."""
    span = lambda v: max(np.max(v), v[0]) - min(np.min(v), v[0]) or 1.0
    return {k: float(np.max(np.abs(curves[k] - reference[k])) / span(reference[k])) for k in reference}


def worst(curves, reference):
    return max(apart(curves, reference).values())


@dataclass(frozen=True)
class Saturated(Scene):
    """A saturated column whose load grows along (1 - cos)/2 over `rise`: no kink that would hide the order of a step."""

    Kw: float = 22e6
    k: float = 1e-9
    rise: float = 0.1
    load: float = 3e3
    case: object = FOLDER / "saturated_column.yaml"
    watched: dict = field(default_factory=lambda: {"u(H)": ("end", "u_x_m"), "u(H/2)": ("middle", "u_x_m"), "p(H/2)": ("middle", "p_Pa")})

    KNOTS = 21

    def table(self):
        t = np.linspace(0, self.rise, self.KNOTS)
        return t, 0.5 * self.load * (1 - np.cos(np.pi * t / self.rise))

    def run(self, *options, cells=None, exit_code=0):
        rows = ",".join(f"{t!r} s,{1e6 + q!r} Pa" for t, q in zip(*self.table()))
        return super().run("-mat_sand_water_bulk_modulus", f"{self.Kw!r} Pa" if np.isfinite(self.Kw) else "incompressible",
                           "-mat_sand_permeability_k0", f"{self.k!r} m^2", "-bc_load_normal_table", rows,
                           "-stepper_dt", f"{self.end / 1000!r} s", *options, cells=cells, exit_code=exit_code)  # fmt: skip

    def exact(self):
        """The curves of the exact solution."""
        m = DynamicColumn(H=10.0, M=constrained_modulus(14.516e6, 0.3), n_f=0.33, rho_s=2000.0, rho_w=1000.0,
                          Kw=min(self.Kw, 1e14), mobility=self.k / 1e-3, q=self.load, table=self.table())  # fmt: skip
        at = {"u(H)": (10.0, "u", 0.0), "u(H/2)": (5.0, "u", 0.0), "p(H/2)": (5.0, "p", 1e6)}
        return {name: m.solution(x, self.times())[q] + zero for name, (x, q, zero) in at.items()}


def wave(Kw=22e6, **changes):
    return Saturated("wave in a saturated column", **{"end": 0.2, "every": 0.01, "Kw": Kw, **changes})


def consolidation(**changes):
    given = dict(end=4.0, every=0.1, rise=1.0)
    return Saturated("fast consolidation", **{**given, **changes})


BLOCK = Scene("dissociating block", FOLDER / "block.yaml", end=1.0, every=0.05, cells=(11, 10), watched={
    "p": ("near", "p_Pa"), "T": ("near", "T_degC"), "S_h": ("near", "S_h"), "p, far": ("far", "p_Pa"), "u": ("near", "u_x_m")})  # fmt: skip
REACTING = Scene("closed reacting column", FOLDER / "reacting_column.yaml", end=1.0, every=0.05, watched={
    "p": ("hydrate", "p_Pa"), "T": ("hydrate", "T_degC"), "S_h": ("hydrate", "S_h"), "p, far": ("free", "p_Pa"), "u": ("free", "u_x_m")})  # fmt: skip


def bp2(case, factor=1, **changes):
    """BP2, case 1 or 2, with permeability, reaction, conductivities and load `factor` times faster: the same in 1/factor of the time."""
    head, watched = "-mat_sediment_", {"p(0.6 m)": ("p06", "p_Pa"), "u(H)": ("surface", "u_x_m")}
    options = [f"{head}kinetics_active", "yes" if case == 2 else "no",
               f"{head}permeability_k0", f"{1.53e-15 * factor!r} m^2", f"{head}kinetics_K0", f"{2.5e-10 * factor!r} mol/(m^2 Pa s)",
               "-bc_load_normal_table", f"0 s,3.25 MPa,{1e3 / factor!r} s,13.25 MPa,{2e3 / factor!r} s,3.25 MPa",
               "-stepper_dt", f"{1 / factor!r} s", "-stepper_dt_max", f"{50 / factor!r} s"]  # fmt: skip
    for what, value in (("solid", 3.0), ("hydrate", 0.5), ("water", 0.5), ("gas", 0.044)):
        options += [f"{head}{what}_conductivity", f"{value * factor!r} W/(m K)"]
    if case == 2:
        watched.update({"S_h(0.6 m)": ("p06", "S_h"), "T(0.6 m)": ("p06", "T_degC")})
    given = dict(case=CASES / "bp2", watched=watched, options=tuple(options), end=2e3 / factor, every=20 / factor)
    return Scene(f"BP2 case {case}" + (f", {factor} times faster" if factor != 1 else ""), **{**given, **changes})
