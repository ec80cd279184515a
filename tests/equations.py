#!/usr/bin/env python3
"""Numbers of docs/equations.md and docs/laws.md against the code: equations.py

- every equation of equations.md, and every one that laws.md adds, has one number, and is cited in a comment of src or include
- every number cited there, and every one that the text of equations.md refers to, is an equation of one of both pages
- numbers of the paper's equations carry a P, everywhere
"""
import re
import sys
from collections import Counter, defaultdict
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE, LAWS = ROOT / "docs" / "equations.md", ROOT / "docs" / "laws.md"
CODE = sorted([*(ROOT / "src").rglob("*.[ch]"), *(ROOT / "include").rglob("*.h")])
NUMBER = re.compile(r"(?<![\w)])\((\d{1,3})[a-z]?\)")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.S)
OF_THE_PAPER = re.compile(r"[Pp]aper(?:'s)?,? (?:its )?\((?:[A-C]\.)?\d+[a-z]?\)")


def equations(text):
    """Numbers at the end of indented lines."""
    return re.findall(r"^ {4}.*\((\d+)\) *$", text, re.M)


def citations():
    places = defaultdict(list)
    for path in CODE:
        text = path.read_text()
        for comment in COMMENT.finditer(text):
            for number in NUMBER.findall(comment.group()):
                places[number].append(f"{path.relative_to(ROOT)}:{text.count(chr(10), 0, comment.start()) + 1}")
    return places


def faults():
    page, cited = PAGE.read_text(), citations()
    defined = Counter(equations(page))
    defined.update(set(equations(LAWS.read_text())) - set(defined))
    yield from (f"({n}) is given to {k} equations" for n, k in defined.items() if k > 1)
    yield from (f"({n}) is cited nowhere in src and include" for n in defined if n not in cited)
    yield from (f"{places[0]} cites ({n}), which is no equation of either page" for n, places in cited.items() if n not in defined)
    prose = "\n".join(line for line in page.splitlines() if not line.startswith("    "))
    yield from (f"{PAGE.name} refers to ({n}), which is no equation" for n in sorted(set(NUMBER.findall(prose))) if n not in defined)
    for path in [*CODE, *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "tests").rglob("*.py"))]:
        if path != Path(__file__).resolve():
            yield from (f"{path.relative_to(ROOT)}: '{m}' wants a P" for m in OF_THE_PAPER.findall(path.read_text()))


if __name__ == "__main__":
    found = list(faults())
    print("\n".join(found) or f"{len({n for page in (PAGE, LAWS) for n in equations(page.read_text())})} equations, each with a number that the code cites")
    sys.exit(bool(found))
