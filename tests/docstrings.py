#!/usr/bin/env python3
"""Every function of include/ has a docstring: a comment right above it, or behind it on its line.

Usage: docstrings.py [root of the tree].  It also judges made-up headers, some with functions that have none.
"""
import re
import sys
from pathlib import Path

COMMENT = re.compile(r"/\*.*?\*/", re.S)
# A declaration or inline definition at the left edge: type, name, arguments, then ; or {
FUNCTION = re.compile(r"^(?!typedef\b|return\b|else\b|#)(?:[A-Za-z_]\w*[ \t*]+)+?\**(\w+)\(([^;{}]*)\)[ \t]*(?:\n?\{|;|__attribute__)", re.M)


def functions(text):
    """[(name, line, has a docstring)] of a header."""
    blank = COMMENT.sub(lambda m: re.sub(r"[^\n]", " ", m.group()), text)  # code alone, places kept
    ends = {m.end(): m for m in COMMENT.finditer(text)}
    found = []
    for m in FUNCTION.finditer(blank):
        start = text.rfind("\n", 0, m.start()) + 1
        before = max((e for e in ends if e <= start and not text[e:start].strip() and text[e:start].count("\n") == 1), default=None)
        behind = text[m.end() : text.find("\n", m.end())]
        own = before is not None and not blank[blank.rfind("\n", 0, ends[before].start()) + 1 : ends[before].start()].strip()
        found.append((m.group(1), text.count("\n", 0, m.start()) + 1, own or "/*" in behind))
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


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1])
    missing, count = [], 0
    for path in sorted((root / "include").rglob("*.h")):
        for name, line, documented in functions(path.read_text()):
            count += 1
            if not documented:
                missing.append(f"{path.relative_to(root)}:{line}: {name} has no docstring")
    wrong = [f"self-test: judged wrongly: {text!r}" for text, good in PLANTED.items() if functions(text)[-1][2] != good]
    print("\n".join(missing + wrong + [f"{count} functions, {len(missing)} without a docstring"]))
    return 1 if missing or wrong or not count else 0


if __name__ == "__main__":
    sys.exit(main())
