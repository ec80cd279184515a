#!/usr/bin/python3
"""Makes docs/options.md, and docs/laws.md but for its pictures: options_doc.py CLATHRA [--check]

The keys of a case come from `CLATHRA -case_keys`; the options of the program itself are kept by hand below, and
tests/docs.py holds them against what src/ reads.  --check writes nothing and fails when the page is out of date.
"""
import difflib
import re
import sys
from pathlib import Path

from clathra.program import call

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "options.md"

PROGRAM = [  # option, value, default, meaning
    ("-case_check", "", "", "read and check the case and its start: refusals, forecast and warnings of a run; write nothing"),
    ("-case_keys", "", "", "print every key of a case file and stop; needs no case"),
    ("-case_curves", "", "", "print what the laws of the case's materials give, curve by curve, and stop: what docs/laws.md is drawn from"),
    ("-restart_as_initial", "FILE", "", "begin with the particles of a checkpoint, in another folder, at t = 0: conditions, gravity, times, integrator and the "
     "laws that tie nothing of the state may differ; grid, fields, regions and what a material ties its masses and history to may not"),
    ("-restart", "FILE", "", "go on from a checkpoint of the same case (grid, regions, materials, boundary conditions, "
     "meters, stages); times, integrator, outputs and solver may differ; in the folder of the run that wrote it, or in a "
     "new one"),
    ("-quiet", "", "", "no line per step; refused steps and the summary are still printed"),
    ("-progress", "s", "1", "of the clock on the wall between lines of progress, at least; 0 = a line for every step"),
    ("-time_limit", "s", "none", "of the clock on the wall (a number, or with a unit), after which the run must have ended: it does so before two more steps as "
     "long as its longest would pass them, with a checkpoint and exit code 4"),
    ("-checkpoint_wall", "s", "300", "of the clock on the wall between checkpoints, beside those of `checkpoint_every`; 0 = none"),
    ("-overwrite", "", "", "write into an output folder that holds the results of another case"),
    ("-stepper_max_steps", "N", "no limit", "stop after N more steps, with a checkpoint and exit code 0"),
    ("-newton_tol_residual", "x", "1e-9", "Newton stops when every scaled row of the residual is below this, rows of "
     "mass and energy 20 times lower"),
    ("-newton_tol_update", "x", "1e-6", "... and every scaled update too, in units of 1 MPa and 1 K"),
    ("-newton_keep_jacobian", "x", "0.01", "an iteration that takes the largest scaled row to less than x of what it was leaves its Jacobian "
     "to the next; 0: a new one in every iteration"),
    ("-newton_preconditioner", "auto, whole, reduced", "auto", "reduced: of what is left without the fluid velocities (docs/equations.md, section 9), LU, or multigrid "
     "where the cells across times the unknowns a node that are left exceed 250 (180 in space); where it breaks down LU of the whole for that stage; "
     "whole: of the whole matrix, LU unless -pc_type says otherwise; auto: reduced, unless -pc_type, -ksp_type or -model_pmat_type is given"),
    ("-newton_drop", "x", "1e-6", "entries of a row of the reduced matrix that are below x of its largest are left out; 0: only zeros are"),
    ("-newton_operator", "auto, assembled, particles", "auto", "the exact Jacobian that GMRES multiplies with: assembled, with its wide part particle by "
     "particle (27); particles: all of it from the tangents that each particle keeps (docs/equations.md, section 9), half the memory; auto: particles with "
     "the reduced preconditioner, assembled with one of the whole"),
    ("-reduced_pc_type", "PETSc's", "by size", "solver of the reduced matrix: lu, all of it factorised; fieldsplit, its two groups of unknowns in "
     "turn by multigrid"),
    ("-reduced_pc_fieldsplit_type", "PETSc's", "multiplicative", "how the groups follow each other: flow (p_w, p_g, T), then motion (v_s); where it is given, "
     "what motion does to the flow is stored, too"),
    ("-newton_refactor", "N", "by its cost", "the preconditioner is made once a step, and anew after a linear solve of more "
     "than N iterations, or where N is not given when solves have lost as many iterations as a new one costs; a stage that "
     "fails is tried again with a new one at every Newton iteration"),
    ("-model_pmat_type", "aij, baij", "aij with UMFPACK, else baij", "storage (aij: on one rank) of the matrix that the preconditioner "
     "sees; UMFPACK needs aij, ILU by blocks of nine needs baij; goes with the solver of the same preset"),
]  # fmt: skip

PETSC = [  # the ones worth knowing, with this program's defaults
    ("-snes_max_it", "30", "Newton iterations of a stage before the step is cut; from half of them on only while each halves the residual; then, where the skeleton yields, once more with updates shortened until it falls"),
    ("-ksp_type", "fgmres", "Krylov method on the exact Jacobian"),
    ("-ksp_pc_side", "right", "so that it stops on the residual of the rows themselves"),
    ("-ksp_rtol", "1e-6", "its relative tolerance"),
    ("-ksp_atol", "0.02 newton_tol_residual", "its absolute tolerance, on scaled rows"),
    ("-ksp_max_it", "60", "iterations before the linear solve has failed"),
    ("-ksp_gmres_restart", "60", "vectors kept by GMRES"),
    ("-ksp_rtol", "1e-4", "... with the reduced preconditioner"),
    ("-ksp_max_it", "200", "... with the reduced preconditioner"),
    ("-pc_type", "lu", "preconditioner of the whole: lu, ilu, asm, bjacobi ..."),
    ("-reduced_fieldsplit_flow_pc_type", "gamg", "of p_w, p_g, T: aggregation, smoothed by ILU (-reduced_fieldsplit_flow_mg_levels_...)"),
    ("-reduced_fieldsplit_motion_pc_type", "hypre", "of v_s: BoomerAMG with one sweep of SOR down (forward) and up (backward), strong threshold 0.5 (0.7 in space); gamg without hypre"),
    ("-exchange_ksp_max_it", "2000", "conjugate gradients of (354) in a step before it evens no pressures out within cells, which the summary counts"),
    ("-pc_factor_mat_solver_type", "umfpack up to 2500 unknowns on one rank, else mumps", "who factorises the whole (-reduced_pc_factor_mat_solver_type: the reduced matrix); a PETSc without them has the next of docs/building.md"),
    ("-options_file", "", "reads options from a file, for example a preset of options/"),
    ("-snes_monitor, -ksp_converged_reason", "", "watch Newton's method and the linear solver"),
    ("-options_left", "", "at the end, lists options that nobody read: finds misspelt ones"),
    ("-log_view", "", "where the time went; this program's own events are ClBeginStep, ClResidual, ClJacobian, "
     "ClWidePart, ClReducedMatrix, ClReducedApply, ClProduct"),
]  # fmt: skip

HEAD = """\
# Options

Made by `scripts/options_doc.py`; do not edit by hand.

An option is given on the command line (`-name value`), in a file named by `-options_file`, or in the case file, where
it is a key. The command line and options files win over the case; among themselves the later one wins, so name the file
first.

## Options of the program

| option | value | default | meaning |
|---|---|---|---|
{program}

## Options of PETSc that are worth knowing

Every `-snes_`, `-ksp_` and `-pc_` option of PETSc works. The program's own defaults are:

| option | default here | meaning |
|---|---|---|
{petsc}

A misspelt key of the case, and an option that begins as this program's own do (`-stepper_`, `-newton_`, `-model_`, `-output_`,
`-checkpoint_`, `-case_`), is an error before anything is run. One of PETSc's cannot be told from those that nobody asked for yet:
the run ends with the warning that it was not used.

## Keys of a case

Quantities carry units on the command line too, quoted for the shell: `-time_end "500 s"`. These may be bare there, and
are then in seconds: {plain}, and the same of a stage.

{keys}"""


def case_keys(binary):
    """What the program says about the keys of a case, as Markdown."""
    return call("-case_keys", program=binary)


def plain_keys():
    """Keys whose number may do without a unit on the command line, from the key table's source."""
    text = (ROOT / "src" / "case" / "keys_case.c").read_text()
    rows = re.split(r"\n    (?=[A-Z]+\()", text)
    return list(dict.fromkeys(re.search(r'"(\w+)"', row).group(1) for row in rows if re.search(r"\.plain\s*=\s*true", row)))


def row(*cells):
    return "| " + " | ".join(cells) + " |"


def spare(line):
    """<name> outside backticks would be taken for HTML."""
    parts = line.split("`")
    return "`".join(re.sub(r"<([^>|]*)>", r"\\<\1\\>", part) if k % 2 == 0 else part for k, part in enumerate(parts))


def page(binary):
    program = [row(f"`{o}`", v, d, m) for o, v, d, m in PROGRAM]
    petsc = [row(", ".join(f"`{name}`" for name in o.split(", ")), d, m) for o, d, m in PETSC]
    plain = ", ".join(f"`-{name}`" for name in plain_keys())
    keys = "\n".join(spare(line) for line in case_keys(binary).splitlines())
    return HEAD.format(program="\n".join(program), petsc="\n".join(petsc), plain=plain, keys=keys) + "\n"


def main(arguments):
    check = "--check" in arguments
    arguments = [a for a in arguments if a != "--check"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    new = page(arguments[0])
    if not check:
        import laws_doc  # whose page lists keys, too

        PAGE.write_text(new)
        laws_doc.PAGE.write_text(laws_doc.page(arguments[0]))
        return 0
    old = PAGE.read_text() if PAGE.is_file() else ""
    difference = list(difflib.unified_diff(old.splitlines(), new.splitlines(), str(PAGE), "as it should be", lineterm=""))
    print("\n".join(difference) if difference else f"{PAGE} is up to date")
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
