#!/usr/bin/python3
"""Solvers of the linear systems: every preset takes the squeezed block of hydrate-forming sediment through its first steps
and all agree within the solver's tolerance, on 1 and on 2 ranks, with LU of the whole as well, and multigrid on beds that dip, too; with LU and with multigrid a run cut by a restart is
the straight one bit for bit; where the reduced matrix breaks down LU of the whole takes over, says so, and the answer is the same.
"""
import re
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from _files import different  # noqa: E402
from common import ROOT, Run, check, check_true, finish, scratch, table  # noqa: E402

CASE = Path(__file__).parent / "cases" / "block.yaml"
FIXED = ("-quiet", "-stepper_adapt", "no", "-stepper_dt", "10 s", "-time_end", "40 s", "-output_times", "0 s,40 s", "-output_probe_every", "10 s",
         "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9")  # fmt: skip
COLUMNS = ("middle.p_Pa", "middle.T_degC", "top.u_y_m", "middle.syy_Pa")
PRESETS = ("umfpack", "mumps", "krylov", "scale")


def preset(name):
    return "-options_file", str(ROOT / "options" / f"{name}.opts")


def run(*options, ranks=1, out=None):
    return Run.of_case(CASE, *options, ranks=ranks, out=out)


def apart(a, b):
    return max(np.max(np.abs(a.probes[c] - b.probes[c])) / np.max(np.abs(b.probes[c])) for c in COLUMNS)


# Presets and ranks.
reference, rows = run(*FIXED, "-newton_preconditioner", "whole"), []
for name in (None, *PRESETS):
    for ranks in (1,) if name == "umfpack" else (1, 2):
        error = apart(run(*FIXED, *(preset(name) if name else ()), ranks=ranks), reference)
        rows.append([name or "default", ranks, f"{error:.1e}"])
        check(f"{f'options/{name}.opts' if name else 'the default'} on {ranks} rank(s) against LU of the whole: histories", error, 1e-8)
table(["preset", "ranks", "apart"], rows)
check_true("with all packages none is said to be missing", "this PETSc has no" not in reference.output)

# Beds that dip, a thousandth as permeable across: flow couples the directions, and the reduced preconditioner knows it.
def krylov(r):
    return int(re.search(r"KSPGMRESOrthog +(\d+)", r.output).group(1)) / newton(r)


def newton(r):
    return int(re.search(r"(\d+) Newton iterations", r.output).group(1))


BEDS = [w for m in ("soft", "firm") for w in (f"-mat_{m}_permeability_ratio", "1e-3", f"-mat_{m}_permeability_dip", "30 deg")]
plain, bedded = (run(*FIXED, *preset("scale"), "-log_view", *beds) for beds in ((), BEDS))
check("beds with multigrid against LU: histories", apart(bedded, run(*FIXED, *BEDS)), 1e-8)
check("... iterations of a solve over those without beds", krylov(bedded) / krylov(plain), 1.4)
check_true("... and LU takes over nowhere", "broke down" not in bedded.output, f"{krylov(plain):.1f} without beds, {krylov(bedded):.1f} with")

# An iteration that does well leaves its Jacobian to the next (343).
always = run(*FIXED, "-newton_keep_jacobian", 0)
check("a new Jacobian in every iteration against the default: histories", apart(always, reference), 1e-8)
check_true("... and the default needs at most three quarters as many", 0 < newton(reference) <= 0.75 * newton(always), f"{newton(reference)} {newton(always)}")
hopeless = run(*FIXED, "-newton_keep_jacobian", 1e9, "-snes_max_it", 5)
check("one Jacobian a stage, which five iterations do not solve: a second attempt does; histories", apart(hopeless, reference), 1e-8)
check_true("... and no step is refused", ", 0 refused" in hopeless.output, f"{newton(hopeless)} Jacobians, {newton(always)} of Newton's method")

# Restart.
for kind, ranks in (("lu", 1), ("fieldsplit", 1), ("fieldsplit", 2)):  # on ranks MUMPS adds in the order in which messages arrive
    adaptive = ("-quiet", "-reduced_pc_type", kind)
    straight, out = run(*adaptive, "-stepper_max_steps", 8, ranks=ranks), scratch() / "out"
    run(*adaptive, "-stepper_max_steps", 3, ranks=ranks, out=out)
    run(*adaptive, "-stepper_max_steps", 5, "-restart", out / "checkpoint.h5", ranks=ranks, out=out)
    names = different(straight.out, out)
    check_true(f"{kind}, cut after step 3, {ranks} rank(s): the same bit for bit", not names, ", ".join(names[:5]))

# By size: a block of 52 cells across has multigrid, a smaller one LU, unless the user chooses.
BROAD = (*FIXED, "-time_end", "10 s", "-output_times", "0 s,10 s", "-grid_cells", "52,80", "-region_left_particles_per_cell", "2,1",
         "-region_right_particles_per_cell", "2,1")  # fmt: skip


def chosen(r):
    return re.search(r"preconditioner: (\w+) of the (\w+) matrix: (.*)", r.output).groups()


for ranks in (1, 2):
    r = run(*BROAD, "-stepper_max_steps", 0, ranks=ranks)
    check_true(f"many cells across, {ranks} rank(s): multigrid", chosen(r)[:2] == ("multigrid", "reduced") and "5 of 9 unknowns" in chosen(r)[2], chosen(r))
for given, said in (("-newton_preconditioner whole", ("lu", "whole", "as -newton_preconditioner asks")), ("-pc_type asm", ("asm", "whole", "as -pc_type asks")), ("-ksp_type gmres", ("lu", "whole")),
                    ("-newton_preconditioner reduced -ksp_type gmres", ("multigrid", "reduced")), ("-grid_cells 52,4", ("lu", "reduced")), ("-grid_cells 48,80", ("lu", "reduced")),
                    ("-reduced_pc_type lu", ("lu", "reduced", "as -reduced_pc_type asks")), ("-reduced_fieldsplit_flow_pc_type gamg -grid_cells 52,4", ("multigrid", "reduced"))):  # fmt: skip
    r = run(*BROAD, "-stepper_max_steps", 0, *given.split())
    check_true(f"{given}: {said[0]} of the {said[1]}", chosen(r)[: len(said)] == said, chosen(r))

# The forecast knows what each costs.
def forecast(*options):
    seconds, unit = re.search(r"implicit about [\d.e+]+ steps, ([\d.]+) (s|min)", run(*BROAD, "-stepper_max_steps", 0, *options).output).groups()
    return float(seconds) * (60 if unit == "min" else 1)


cost = [forecast(), forecast("-reduced_pc_type", "lu"), forecast("-newton_preconditioner", "whole")]
check_true("forecast: LU of the whole costs more than LU of the reduced matrix; multigrid here no more than that", cost[0] <= cost[1] < cost[2], str(cost))

# A reduced preconditioner that is none: LU takes over.
weak = [w for g in ("flow", "motion") for w in (f"-reduced_fieldsplit_{g}_pc_type", "none")]
broken = run(*FIXED, *preset("scale"), *weak, "-ksp_max_it", 40)
said = re.findall(r"t = [\d.e+-]+ s: the reduced preconditioner broke down \(too many iterations\); LU of the whole solves this stage", broken.output)
refused = int(re.search(r"(\d+) refused", broken.output).group(1))
check_true("a preconditioner that breaks down: LU says so in every stage and no step is refused", len(said) == 8 and refused == 0, f"{len(said)} lines, {refused} refused")
check("... histories", apart(broken, reference), 1e-8)
finish()
