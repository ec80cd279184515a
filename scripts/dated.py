"""The head of a page of docs/studies: its script, its data with their dates and commits, and what of the program has changed since.

docs/studies/made.csv has a line for every file of measurements: its name, the day it was last measured, the commit of the program that was
measured.  What measures calls measured(), what writes a page takes head() into it.
"""
import csv
import subprocess
from datetime import date
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
STUDIES = ROOT / "docs" / "studies"
MADE = STUDIES / "made.csv"


def read():
    """{name of a file: (date, commit)}"""
    with open(MADE, newline="") as file:
        return {r["file"]: (r["date"], r["commit"]) for r in csv.DictReader(file)}


def measured(*files):
    """Notes today and the present commit for those of these files that stand in docs/studies."""
    commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short=8", "HEAD"], capture_output=True, text=True).stdout.strip()
    names = [Path(f).name for f in files if Path(f).resolve().parent == STUDIES]
    made = read() | {name: (date.today().isoformat(), commit or "unknown") for name in names}
    with open(MADE, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(("file", "date", "commit"))
        out.writerows((name, *when) for name, when in sorted(made.items()))


def data(*files):
    """The line of the head that names data.  A page is its own data where its runs are not kept."""
    made, names = read(), [Path(f).name for f in files]
    each = [f"{'this page' if name.endswith('.md') else f'[{name}]({name})'} (last measured {made[name][0]}, commit {made[name][1]})" for name in names]
    return f"- Data: {', '.join(each)}."


def head(title, script, *files, since="Numbers are of that commit."):
    """Title and head of a page, as lines."""
    return [f"# {title}", "", f"- Script: [{script}](../../{script}). It writes this page.", data(*files), f"- Since then: {since}", ""]
