#!/usr/bin/python3
"""A case for several values of its keys: sweep.py CASE KEY=A,B,C [KEY=... ...] [--out FOLDER] [--jobs N] [-- OPTIONS]

Runs every combination side by side, each on one core, in FOLDER/KEY=A,... (default results/sweep_CASE); values are separated by
commas, or by | where a value holds commas itself: grid_cells=10,1|20,1.  What has finished is not run again, and a sweep that was
ended goes on where it was, with the last checkpoints; but where the case or its options have changed since, a run begins anew.  Writes FOLDER/sweep.csv, one row a run: the values, how it ended, its
work, the last value of every probe and meter; and FOLDER/sweep.png, all histories.  OPTIONS go to every run.
"""
import argparse
import csv
import itertools
import os
import re
import shlex
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import clathra
import compare

ROOT = Path(__file__).resolve().parents[1]
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
               "PRTE_MCA_hwloc_default_binding_policy": "none"}  # fmt: skip
ENDS = ("-output_dir", "-restart", "-stepper_max_steps", "-time_limit", "-checkpoint_wall", "-progress")  # with a value each
SAFE = re.compile(r"[^\w.,=+-]+")


def combinations(keys):
    """[{key: value}] of every combination of KEY=A,B,C."""
    lists = []
    for text in keys:
        key, _, values = text.partition("=")
        if not values:
            sys.exit(f"sweep.py: {text} is no KEY=A,B,C")
        split = "|" if "|" in values else ","
        lists.append([(key.lstrip("-"), v.strip()) for v in values.split(split) if v.strip()])
    return [dict(c) for c in itertools.product(*lists)]


def find_case(name):
    """A case's folder or file, as ./run finds it."""
    for path in (Path(name), ROOT / "cases" / name):
        if path.is_file() or (path / "case.yaml").is_file():
            return path.resolve()
    sys.exit(f"sweep.py: no case '{name}'")


def finished(folder):
    try:
        return clathra.Run(folder).finished
    except clathra.NoRun:
        return False


def call(command):
    """Runs it with a folder of its own for MPI's session: of two runs that share one, the first to end may remove what the other has just made."""
    with tempfile.TemporaryDirectory(prefix="clathra-mpi-") as session:
        environment = {**os.environ, **ENVIRONMENT, "OMPI_MCA_orte_tmpdir_base": session}
        return subprocess.run(list(map(str, command)), env=environment, stdin=subprocess.DEVNULL, capture_output=True, text=True)


def scene(folder):
    """Every key of the case as it ran in a folder, with its value."""
    found = dict(clathra.read_case(folder / "case.yaml", texts=True))
    found.pop("output_dir", None)
    return found


def worded(words):
    """The options of a command but those that decide where it writes and when it ends."""
    return [w for k, w in enumerate(words) if w not in ENDS and (k == 0 or words[k - 1] not in ENDS)]


def changed(command, folder):
    """Is what the folder holds of another state of the case, or of other options?  What the case is now, the program says: by a run of no steps."""
    said = [line[2:] for line in clathra.Run(folder).log.splitlines() if line.startswith("$ ")]
    if not said or worded(shlex.split(said[-1])[2:]) != worded(list(map(str, command[2:]))):
        return True
    with tempfile.TemporaryDirectory() as now:
        done = call([*command, "-output_dir", Path(now) / "now", "-stepper_max_steps", "0"])
        return done.returncode == 0 and scene(Path(now) / "now") != scene(folder)


def launch(program, case, values, folder, options):
    """Runs one combination, unless it has finished; its exit code."""
    command = [program, case, "-quiet", "-output_dir", folder, *options, *(w for k, v in values.items() for w in (f"-{k}", v))]
    begun = (folder / "balance.csv").is_file() and (folder / "case.yaml").is_file()
    if begun and changed(command, folder):
        print(f"  {folder.name}: the case or its options have changed: anew", flush=True)
    elif finished(folder):
        print(f"  {folder.name}: finished before", flush=True)
        return 0
    elif (folder / "checkpoint.h5").is_file():
        command += ["-restart", folder / "checkpoint.h5"]
    done = call(command)
    said = done.stderr.strip().splitlines() or done.stdout.strip().splitlines()
    print(f"  {folder.name}: exit code {done.returncode}" + (f": {said[0]}" if done.returncode and said else ""), flush=True)
    return done.returncode


def rows(runs):
    """Header and one row a run."""
    keys, found = list(runs[0][0]), []
    for values, folder, code in runs:
        row = {**values, "exit_code": code}
        try:
            run = clathra.Run(folder)
        except clathra.NoRun:
            found.append(row)
            continue
        took = compare.WORK.search(run.summary)
        if took:
            row.update(zip(("integrator", "steps", "refused", "newton", "seconds"), took.groups()))
        row["time_s"] = run.balance["time_s"][-1] if len(run.balance["time_s"]) else 0.0
        row.update({name: v[-1] for name, (_, v) in compare.columns_of(run).items() if len(v)})
        found.append(row)
    columns = list(dict.fromkeys([*keys, *(k for row in found for k in row)]))
    return columns, found


def main():
    split = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    own, rest = sys.argv[1:split], sys.argv[split + 1 :]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    parser.add_argument("keys", nargs="+", metavar="KEY=A,B,C")
    parser.add_argument("--out", type=Path)
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)), help="runs at a time; default: the cores there are")
    parser.add_argument("--program", default=ROOT / "build" / "clathra")
    options = parser.parse_args(own)
    case, wanted = find_case(options.case), combinations(options.keys)
    name = case.parent.name if case.name == "case.yaml" else case.stem
    out = options.out or ROOT / "results" / f"sweep_{name}"
    folders = [out / SAFE.sub("_", ",".join(f"{k}={v}" for k, v in c.items())) for c in wanted]
    if len(set(folders)) < len(folders):
        parser.exit(2, "sweep.py: two combinations have the same name\n")
    out.mkdir(parents=True, exist_ok=True)
    print(f"{len(wanted)} runs of {case}, {options.jobs} at a time, into {out}", flush=True)
    with ThreadPoolExecutor(options.jobs) as pool:
        codes = list(pool.map(lambda c, f: launch(options.program, case, c, f, rest), wanted, folders))
    columns, found = rows(list(zip(wanted, folders, codes)))
    with open(out / "sweep.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, columns)
        writer.writeheader()
        writer.writerows(found)
    short = [c for c in columns if c in wanted[0] or c in ("exit_code", "steps", "seconds", "time_s")]
    print("\n".join(compare.table([short, *([str(row.get(c, "")) for c in short] for row in found)])))
    held = [(clathra.Run(f), ", ".join(c.values())) for c, f in zip(wanted, folders) if (f / "balance.csv").is_file()]
    if held:
        compare.draw([r for r, _ in held], [n for _, n in held], out, "sweep")
    sys.exit(max(codes))


if __name__ == "__main__":
    main()
