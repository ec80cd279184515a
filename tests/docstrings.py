#!/usr/bin/env python3
"""Every function of include/ has a docstring: a comment right above it, or behind it on its line.  Where it takes or gives
doubles, the docstring, a comment among its arguments or a line `Units: ...` in the comment that the header begins with says
in which units.

Usage: docstrings.py [root of the tree].  It also judges made-up headers, some with functions that have none.
"""
import re
import sys
from pathlib import Path

COMMENT = re.compile(r"/\*.*?\*/", re.S)
# A declaration or inline definition at the left edge: type, name, arguments, then ; or {
FUNCTION = re.compile(r"^(?!typedef\b|return\b|else\b|#)(?:[A-Za-z_]\w*[ \t*]+)+?\**(\w+)\(([^;{}]*)\)[ \t]*(?:\n?\{|;|__attribute__)", re.M)


UNIT = re.compile(r"(?<![\w.])(?:m|m\^?[23]|s|kg|Pa|K|degC|J|W|N|B|rad|degrees|1/[KsmNW]|1/Pa|per [sKm]|dimensionless|SI units?|any unit|unit of \w+|m/s|cells)(?![\w\[])")


def says_unit(text, m, comments):
    """Does the declaration m of a header name the units of its doubles?"""
    if not re.search(r"\bdouble\b", COMMENT.sub(" ", text[m.start() : m.end()])):
        return True
    top = COMMENT.match(text.lstrip())
    return bool(UNIT.search(comments) or (top and "Units:" in top.group()))


def functions(text):
    """[(name, line, has a docstring, which says units)] of a header."""
    blank = COMMENT.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)  # code alone, places kept
    ends = {m.end(): m for m in COMMENT.finditer(text)}
    found = []
    for m in FUNCTION.finditer(blank):
        start = text.rfind("\n", 0, m.start()) + 1
        before = max((e for e in ends if e <= start and not text[e:start].strip() and text[e:start].count("\n") == 1), default=None)
        behind = text[m.end() : text.find("\n", m.end())]
        own = before is not None and not blank[blank.rfind("\n", 0, ends[before].start()) + 1 : ends[before].start()].strip()
        inside = " ".join(COMMENT.findall(text[m.start() : m.end()] + behind))
        units = says_unit(text, m, (ends[before].group() if own else "") + inside)
        found.append((m.group(1), text.count("\n", 0, m.start()) + 1, own or "/*" in behind, units))
    return found


PLANTED = {
    "int F(int x);\n": False,
    "/* What it is. */\nint F(int x);\n": True,
    "/* What it is. */\n\nint F(int x);\n": False,
    "int F(int x); /* what it is */\n": True,
    "int G(int x); /* what that is */\nint F(int x);\n": False,
    "/* What it is,\n   at length. */\nstatic inline double *F(int x,\n                        int y)\n{\n  return 0;\n}\n": True,
    "static inline double *F(int x)\n{\n  return 0; /* none */\n}\n": False,
    "#define N 1 /* a number */\nint F(int x);\n": False,
}
PLANTED_UNITS = {
    "/* What it is. */\ndouble F(int x);\n": False,
    "/* What it is, Pa. */\ndouble F(int x);\n": True,
    "/* What it is at x (m). */\nint F(double x);\n": True,
    "/* What it is. */\nint F(double x /* degC */);\n": True,
    "/* What it is. */\nint F(const double x[]);\n": False,
    "/* What it is. */\nint F(int x);\n": True,
    "/* top: all.  Units: Pa. */\n\n/* What it is. */\ndouble F(int x);\n": True,
}


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1])
    missing, count = [], 0
    for path in sorted((root / "include").rglob("*.h")):
        for name, line, documented, units in functions(path.read_text()):
            count += 1
            if not documented:
                missing.append(f"{path.relative_to(root)}:{line}: {name} has no docstring")
            elif not units:
                missing.append(f"{path.relative_to(root)}:{line}: the docstring of {name} says no unit of its doubles")
    wrong = [f"self-test: judged wrongly: {text!r}" for text, good in PLANTED.items() if functions(text)[-1][2] != good]
    wrong += [f"self-test: judged wrongly: {text!r}" for text, good in PLANTED_UNITS.items() if functions(text)[-1][3] != good]
    print("\n".join(missing + wrong + [f"{count} functions, {len(missing)} without a docstring or units"]))
    return 1 if missing or wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main())
