"""A case for several values of its keys: clathra sweep CASE KEY=A,B,C [KEY=... ...] [--out FOLDER] [--jobs N] [-- OPTIONS]

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
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from .case import Case, words_of
from .program import Failed, Refused
from .run import NoRun, Run

ENDS = ("-output_dir", "-restart", "-stepper_max_steps", "-time_limit", "-checkpoint_wall", "-progress")  # with a value each
SAFE = re.compile(r"[^\w.,=+-]+")


class Part(NamedTuple):
    """One run of a sweep."""

    values: dict  # of its keys
    folder: Path
    code: int  # exit code of the program; 0: it has finished
    said: str  # how it ended, in a sentence

    @property
    def run(self):
        """What it left; raises NoRun where it left nothing."""
        return Run(self.folder)


def finished(folder):
    """Does the folder hold a run that came to its end?"""
    try:
        return Run(folder).finished
    except NoRun:
        return False


def worded(words):
    """The options of a command but those that decide where it writes and when it ends."""
    return [w for k, w in enumerate(words) if w not in ENDS and (k == 0 or words[k - 1] not in ENDS)]


def changed(case, folder, options):
    """Is what the folder holds of another state of the case, or of other options?  What the case is now, the program says: by a run of no steps."""
    said = [line[2:] for line in Run(folder).log.splitlines() if line.startswith("$ ")]
    if not said or worded(shlex.split(said[-1])[2:]) != worded(case.command(folder, ("-quiet", *options))[2:]):
        return True
    try:
        return {**case.resolved(texts=True, options=options), "output_dir": ""} != {**Run(folder).texts, "output_dir": ""}
    except Failed:
        return False  # it says so itself


def complete(case, folder, options=(), living=None):
    """Runs a case into a folder, or goes on there, unless it has finished: (exit code, sentence).  `living`: jobs that are under way."""
    begun, said, restart = (folder / "balance.csv").is_file() and (folder / "case.yaml").is_file(), "", False
    if begun and changed(case, folder, options):
        said = "the case or its options have changed: anew, "
    elif finished(folder):
        return 0, "finished before"
    else:
        restart = (folder / "checkpoint.h5").is_file()
    try:
        job = case.start(folder, options=("-quiet", *options), restart=restart)
    except Refused as error:
        return 2, str(error)
    if living is not None:
        living.append(job)
    code = job.end()
    return code, f"{said}exit code {code}" + (f": {job.sentence().splitlines()[0]}" if code else "")


def at_a_time(jobs):
    """How many runs; None: as many as there are cores."""
    if jobs is not None and jobs < 1:
        raise Refused(f"jobs = {jobs} is below 1")
    return jobs or len(os.sched_getaffinity(0))


def side_by_side(function, items, jobs=None):
    """[function(*item, living)] of many items, `jobs` at a time; `living` takes the Jobs that it starts, which Ctrl-C stops."""
    living = []
    with ThreadPoolExecutor(at_a_time(jobs)) as pool:
        futures = [pool.submit(function, *item, living) for item in items]
        try:
            return [future.result() for future in futures]
        except BaseException:
            for future in futures:
                future.cancel()
            while not all(future.done() for future in futures):  # one that was about to start a run may have done so since
                for job in list(living):
                    job.signal()
                time.sleep(0.05)
            raise


def named(values):
    """Name of the folder of these values."""
    return SAFE.sub("_", ",".join(f"{key}={words_of(value)}" for key, value in values.items()))


def sweep(case, keys, folder, jobs=None, options=(), tell=None):
    """Runs every combination of keys' values, {key: [values]}, side by side: [Part(values, folder, code, said)], in their order.

    Each runs in folder/KEY=VALUE,..., on one core, `jobs` at a time (default: the cores there are).  What has finished is not run again, and what
    was begun goes on, unless the case or its options have changed.  A run that fails is a Part with its exit code and what was said.
    `options`: words for every run.  `tell(sentence)` is called as each ends.  Writes folder/sweep.csv, a row a run.
    """
    at_a_time(jobs)
    wanted = [dict(zip(keys, values)) for values in itertools.product(*keys.values())]
    folders = [Path(folder) / named(values) for values in wanted]
    if len(set(folders)) < len(folders):
        raise Refused("two combinations have the same name")
    if not wanted:
        raise Refused("there is nothing to run: a key has no values")
    Path(folder).mkdir(parents=True, exist_ok=True)

    def part(values, place, living):
        code, said = complete(case.with_(values), place, options, living)
        if tell is not None:
            tell(f"{place.name}: {said}")
        return Part(values, place, code, said)

    parts = side_by_side(part, zip(wanted, folders), jobs)
    columns, found = rows(parts)
    with open(Path(folder) / "sweep.csv", "w", newline="") as stream:
        writer = csv.DictWriter(stream, columns)
        writer.writeheader()
        writer.writerows(found)
    return parts


def rows(parts):
    """Header and one row a run."""
    found = []
    for part in parts:
        row = {**{key: words_of(value) for key, value in part.values.items()}, "exit_code": part.code}
        found.append(row)
        try:
            run = part.run
        except NoRun:
            continue
        row.update(run.work, time_s=run.progress.time)
        row.update({name: v[-1] for name, (_, v) in run.columns.items() if len(v)})
    return list(dict.fromkeys(key for row in found for key in row)), found


def values_of(text):
    """(key, [values]) of KEY=A,B,C."""
    key, _, values = text.partition("=")
    found = [v.strip() for v in values.split("|" if "|" in values else ",") if v.strip()]
    if not found:
        raise Refused(f"{text} is no KEY=A,B,C")
    return key.lstrip("-"), found


def arguments(words, doc, prog, **more):
    """Parsed words of a command that runs a case many times, and what follows --; `more`: its own positional arguments."""
    split = words.index("--") if "--" in words else len(words)
    parser = argparse.ArgumentParser(prog, description=doc, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case")
    for name, how in more.items():
        parser.add_argument(name, **how)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--jobs", type=int, help="runs at a time; default: the cores there are")
    parser.add_argument("--program")
    return parser.parse_args(words[:split]), words[split + 1 :]


def main(words):
    from . import compare

    found, options = arguments(words, __doc__, "clathra sweep", keys={"nargs": "+", "metavar": "KEY=A,B,C"})
    case, keys = Case(found.case, found.program), dict(map(values_of, found.keys))
    out = found.out or Path("results") / f"sweep_{case.name}"
    at_a_time(found.jobs)
    print(f"runs of {case.path} into {out}", flush=True)
    parts = sweep(case, keys, out, found.jobs, options, lambda sentence: print(f"  {sentence}", flush=True))
    columns, table = rows(parts)
    short = [c for c in columns if c in keys or c in ("exit_code", "steps", "seconds", "time_s")]
    print("\n".join(compare.table([short, *([str(row.get(c, "")) for c in short] for row in table)])))
    held = [(part.run, ", ".join(part.values.values())) for part in parts if (part.folder / "balance.csv").is_file()]
    if held:
        compare.draw([run for run, _ in held], [name for _, name in held], out, "sweep")
    return max((part.code if part.code >= 0 else 1) for part in parts)
