"""Benchmark over ranks: the same scenes on one and two, and the messages of an implicit step on four.  Used by bench.py.

Times of four ranks would say nothing on two cores; their messages do.
"""
import os
import re
import subprocess
import tempfile
from pathlib import Path

import bench
import bench_explicit

ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe",
               "OMPI_MCA_mpi_yield_when_idle": "1", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}  # fmt: skip
PARTS = {"ClBeginStep": "start of the step", "ClResidual": "residual", "ClJacobian": "Jacobian", "Krylov": "Krylov iteration"}
STEP = ["-stepper_type", "euler", "-stepper_adapt", "no", "-stepper_dt", "10 s", "-stepper_max_steps", "1", "-reduced_pc_type", "fieldsplit"]


def launch(binary, case, ranks, options):
    with tempfile.TemporaryDirectory() as folder:
        command = [*(["mpiexec", "-n", str(ranks)] if ranks > 1 else []), binary, str(case), "-output_dir", folder + "/out", "-quiet", "-log_view", *options]
        return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, env=ENVIRONMENT).stdout


def events(text):
    """{event: (count, seconds, messages, bytes, reductions)} of -log_view, of all ranks together."""
    row = re.compile(r"^(\w+)\s+(\d+)\s+\S+\s+(\S+)\s+\S+\s+\S+\s+\S+\s+(\S+)\s+(\S+)\s+(\S+)\s", re.M)
    found = {}
    for name, count, seconds, messages, length, reductions in row.findall(text):
        try:
            found.setdefault(name, (int(count), float(seconds), float(messages), float(messages) * float(length), float(reductions)))
        except ValueError:
            continue
    return found


def each(log, part):
    """(seconds, messages, bytes, reductions) of one of its kind; a Krylov iteration without what sets up the preconditioner."""
    if part != "Krylov":
        count, *sums = log[part]
        return [v / count for v in sums]
    count, setup = log["KSPGMRESOrthog"][0], log["PCSetUp"]
    return [(a - b) / count for a, b in zip(log["KSPSolve"][1:], setup[1:], strict=True)]


def block(folder, nx, ny):
    """BP2 as a block of nx x ny cells of one size, 2 x 2 particles each."""
    return bench.edited(bench.CASE, folder, ("upper: [1.04 m, 0.02 m]", f"upper: [{(nx + 4) / 100} m, {ny / 100} m]"), ("cells: [52, 1]", f"cells: [{nx + 4}, {ny}]"),
                        ("upper: [1 m, 0.02 m]", f"upper: [{nx / 100} m, {ny / 100} m]"), ("position: 0.02 m", f"position: {ny / 100} m"),
                        ("0.01 m]}", f"{ny / 200} m]}}"))  # fmt: skip


def implicit(binary, nx, ny, ranks):
    with tempfile.TemporaryDirectory() as folder:
        text = launch(binary, block(folder, nx, ny), ranks, STEP)
    log = events(text)
    return log, {part: each(log, part) for part in PARTS}


def hybrid(binary, kind, n, bursts, ranks):
    """Million particle-steps a second."""
    with tempfile.TemporaryDirectory() as folder:
        case = Path(folder) / "case.yaml"
        case.write_text(bench_explicit.case_text(kind, n))
        text = launch(binary, case, ranks, ["-stepper_max_steps", str(bursts)])
    steps = int(re.search(r"integrator hybrid, (\d+) steps", text).group(1))
    return 4e-6 * n * n * steps / sum(log[1] for name, log in events(text).items() if name.startswith("ClEx"))


def sections(binary):
    one, one_each = implicit(binary, 100, 100, 1)
    two, two_each = implicit(binary, 100, 100, 2)
    wide, wide_each = implicit(binary, 200, 100, 2)
    four, four_each = implicit(binary, 100, 100, 4)
    rows = [[what, *(f"{1e3 * log[part][0]:.1f}" for log in (one_each, two_each, wide_each)), f"{one_each[part][0] / two_each[part][0]:.2f}", f"{one_each[part][0] / wide_each[part][0]:.2f}"]
            for part, what in PARTS.items()]  # fmt: skip
    rows.append(["all of the step", *(f"{1e3 * log['SNESSolve'][1]:.0f}" for log in (one, two, wide)), f"{one['SNESSolve'][1] / two['SNESSolve'][1]:.2f}",
                 f"{one['SNESSolve'][1] / wide['SNESSolve'][1]:.2f}"])  # fmt: skip
    messages = [[what, *(f"{log[part][1] / n:.0f}" if k == 0 else f"{log[part][2] / n / 1e3:.0f}" if k == 1 else f"{log[part][3]:.0f}"
                         for n, log in ((2, two_each), (4, four_each)) for k in range(3))] for part, what in PARTS.items()]  # fmt: skip
    speeds = []
    for kind in (bench_explicit.SETS[0], bench_explicit.SETS[2]):
        for n, bursts in ((71, 4), (224, 1)):
            alone, both = (hybrid(binary, kind, n, bursts, ranks) for ranks in (1, 2))
            speeds.append([kind[0], 4 * n * n, f"{alone:.2f}", f"{both:.2f}", f"{both / alone:.2f}"])
            print(speeds[-1], flush=True)
    return f"""
## Ranks

The six-field block of 100 x 100 cells with multigrid, one Euler step, on one and two cores; and twice as long (200 x 100 cells) on two. Milliseconds; a Krylov iteration is one of GMRES without what sets up the
preconditioner. The counts of iterations differ a little with the ranks, so the last row compares steps, not work.

{bench.markdown(["", "1 rank", "2 ranks", "2 ranks, 200 x 100 cells", "one over two", "one over two of twice the size"], rows)}

`hybrid`, million particle-steps a second:

{bench.markdown(["scene", "particles", "1 rank", "2 ranks", "ratio"], speeds)}

Messages that a rank sends, kB that it sends, and sums over all ranks, each time (those of hypre within a Krylov iteration are not counted by PETSc):

{bench.markdown(["", "2 ranks: messages", "kB", "sums", "4 ranks: messages", "kB", "sums"], messages)}
"""
