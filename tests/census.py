#!/usr/bin/env python3
"""Counts what of the tree should become fewer, keys, lines, words and the like, and fails where a count exceeds its ceiling.

Usage: census.py [root of the tree].  A change that makes a count smaller lowers its ceiling; one that needs more says why where it raises it.
It also counts made-up sources.
"""
import re
import sys
from pathlib import Path

COMMENT = re.compile(r"/\*.*?\*/", re.S)
REFERENCE = re.compile(r"/\*\s*(?:\(\d+\)[,;.]?\s*)+\*/")
# A function at the left edge, declared or defined: its arguments end before ; or {
FUNCTION = re.compile(r"^(?!typedef\b|return\b|else\b|#)(?:[A-Za-z_]\w*[ \t*]+)+?\**(\w+)\(([^;{}]*)\)[ \t]*(?:\n?\{|;)", re.M)
WARNING = re.compile(r'"[^"\n]*: (?:warning|note): ')
NUMERICS = re.compile(r"(?:stabilisation_|stepper_|mean_|basis$|pressures$|tears$)")
MANY = 8  # parameters


def arguments(text):
    """Number of arguments of a list of declarations, commas within parentheses and brackets left out."""
    while re.search(r"\([^()]*\)|\[[^\[\]]*\]", text):
        text = re.sub(r"\([^()]*\)|\[[^\[\]]*\]", "", text)
    return 0 if text.strip() in ("", "void") else text.count(",") + 1


def wide(text):
    """Names of functions of a C source with MANY parameters or more, but PETSc's error handler, whose list PETSc prescribes."""
    return {m.group(1) for m in FUNCTION.finditer(COMMENT.sub(" ", text)) if arguments(m.group(2)) >= MANY and "PetscErrorType" not in m.group(2)}


def counts(root):
    """{what: (count, goal)}"""
    read = lambda *patterns: {p: p.read_text(errors="replace") for pattern in patterns for p in sorted(root.glob(pattern))}
    code, pages = read("src/**/*.[ch]", "include/**/*.h"), read("docs/*.md", "README.md")
    keys = re.findall(r"^\| `([a-z]\w*(?:<[a-z]+>\w*)*)` \|", pages[root / "docs" / "options.md"], re.M)
    return {
        "keys of a case": (len(keys), 200),
        "... that choose numerics": (sum(bool(NUMERICS.match(k)) for k in keys), 12),
        "lines of C in src and include": (sum(t.count("\n") for t in code.values()), 35000),
        f"functions with {MANY} parameters or more": (len(set().union(*map(wide, code.values()))), 0),
        "comments that are a number alone": (sum(len(REFERENCE.findall(t)) for t in code.values()), 0),
        "files that print warnings": (sum(bool(WARNING.search(COMMENT.sub(" ", t))) for t in code.values()), 1),
        "words of docs and README": (sum(len(t.split()) for t in pages.values()), 41000),
        "words of the equations": (len(pages[root / "docs" / "equations.md"].split()), 8000),
        "files in scripts": (len(list((root / "scripts").glob("*.py"))), 12),
    }


CEILINGS = {
    "keys of a case": 239,
    "... that choose numerics": 16,
    "lines of C in src and include": 44821,  # 8 more: consistent storage of hybrid, in lanes
    f"functions with {MANY} parameters or more": 12,
    "comments that are a number alone": 0,
    "files that print warnings": 1,
    "words of docs and README": 38002,
    "words of the equations": 9798,
    "files in scripts": 13,
}

PLANTED = {
    "int F(int a, int b, int c, int d, int e, int f, int g, int h);\n": {"F"},
    "static void G(int a, /* b, c, d, e, f, g, h, i */ int j)\n{\n}\n": set(),
    "static void H(int a, int b, int c, int d, int e, int f, int g,\n              double h[3][4])\n{\n}\n": {"H"},
    "void K(int a, int (*of)(int, int, int), int c, int d, int e, int f);\n": set(),
    "void L(void);\n": set(),
}


def main(root):
    faults = [f"made-up source {text!r}: {wide(text)}" for text, want in PLANTED.items() if wide(text) != want]
    found = counts(root)
    print(f"{'':44}{'now':>9}{'ceiling':>9}{'goal':>9}")
    for what, (n, goal) in found.items():
        print(f"{what:44}{n:9}{CEILINGS[what]:9}{goal:9}")
        if n > CEILINGS[what]:
            faults.append(f"{what}: {n}, more than the ceiling of {CEILINGS[what]} in tests/census.py")
    for fault in faults:
        print(fault)
    return bool(faults)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1])))
