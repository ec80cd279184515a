#!/usr/bin/python3
"""scripts/site.sh makes a site of every page, with search, whose links hold and which asks no other host for anything; a broken link fails."""
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, check_true, finish, scratch  # noqa: E402


def make(tree, folder):
    done = subprocess.run([tree / "scripts" / "site.sh", folder], stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


site = scratch() / "site"
code, said = make(ROOT, site)
check_true("the site is made, and its links to files hold", code == 0 and str(site / "index.html") in said, said[-500:])
pages = {p.relative_to(ROOT).with_suffix(".html").as_posix() for pattern in ("docs/**/*.md", "cases/*/README.md") for p in ROOT.glob(pattern)}
pages = {"index.html"} | {p.replace("README", "index") for p in pages}
found = {entry["location"].split("#")[0] for entry in json.loads((site / "search" / "search_index.json").read_text())["docs"]}
check_true("... its search knows every page", pages <= found, sorted(pages - found))
listed = set(re.findall(r'href="\.\./\.\./(docs/[\w/]+\.html)"', (site / "cases" / "heat_slab" / "index.html").read_text()))
check_true("... and the contents beside any page list every page of docs", not (docs := {p for p in pages if p.startswith("docs/")} - listed), sorted(docs))
foreign = [(p.name, a) for p in site.rglob("*.html") for a in re.findall(r'<(?:script|link|img)[^>]* (?:src|href)="((?:https?:)?//[^"]*)', p.read_text())]
check_true("... which ask no other host for anything", not foreign, foreign[:3])

tree = scratch() / "tree"
for name in ("docs", "cases", "scripts", "python", "tests/studies"):
    shutil.copytree(ROOT / name, tree / name, symlinks=True)
(tree / "README.md").write_text("# Clathra\n\n[no such page](docs/no_such_page.md)\n")
code, said = make(tree, scratch() / "site")
check_true("a broken link is said, and no site is promised", code != 0 and "no_such_page.md" in said and "a page is wrong" in said, said[-300:])
finish()
