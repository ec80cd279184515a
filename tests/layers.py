#!/usr/bin/env python3
"""The one-way rule: a file includes only headers of layers above its own, and within a folder no two files call each
other, directly or in a circle; and no file outside of src/model names what Model keeps to itself.
Usage: layers.py [root of the tree].

It also judges a table of made-up files, some with planted violations, and fails if it misses one.
"""
import re
import sys
from pathlib import Path

# From the top down.  Each row: layer, headers of include/clathra/ (without .h) that belong to it, folders of src/.
LAYERS = [
    ("dimension", ["dimension"], []),
    ("base", ["base", "words", "finding"], ["base"]),
    ("tensor", ["inline", "tensor", "eigen", "jet", "fields"], ["tensor", "fields"]),
    ("laws", ["laws"], ["laws"]),
    ("material", ["material"], ["material"]),
    ("skeleton", ["skeleton"], ["skeleton"]),
    # Plain data that many layers read: scene.h is what the physics sees of a case (regions, boundary conditions), with
    # schedule.h, the function of time it holds.  How to run it, case.h, is seen by the integrators and what is below
    # them; the reader of case files, src/case, stays at the bottom.
    ("schedule", ["schedule", "ambient"], ["schedule"]),
    ("grid lines", ["lines"], ["lines"]),
    ("scene", ["scene", "conditions"], []),
    ("shape", ["geometry", "shape"], ["shape"]),
    ("point", ["point", "kinematics"], ["point"]),
    ("grid", ["grid"], ["grid"]),
    ("basis", ["basis"], ["basis"]),
    ("particles", ["particles"], ["particles"]),
    ("boundary", ["boundary"], ["boundary"]),
    ("transfer", ["transfer"], ["transfer"]),
    ("model", ["model", "solver_words"], ["model"]),
    ("explicit", ["explicit"], ["explicit"]),
    ("settings", ["case"], []),
    ("stepper", ["stepper"], ["stepper"]),
    ("io", ["io"], ["io"]),
    ("case", [], ["case"]),
    ("findings", ["findings"], ["findings"]),
    ("run", ["run"], ["run"]),
    ("main", [], ["."]),
]
# The physics sees no solver, grid or message passing: laws include nothing of PETSc, point names none of its objects.
NO_PETSC = {"tensor", "laws", "skeleton"}
NO_SOLVER = {"tensor", "laws", "material", "skeleton", "point"}

RANK_OF_HEADER = {h: i for i, (_, headers, _) in enumerate(LAYERS) for h in headers}
RANK_OF_FOLDER = {f: i for i, (_, _, folders) in enumerate(LAYERS) for f in folders}
INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)
SOLVER = re.compile(r"\b(Vec|Mat|DM|KSP|SNES|MPI_\w+)\b")
COMMENT = re.compile(r'/\*.*?\*/|//[^\n]*|("(?:\\.|[^"\\\n])*")', re.S)


def name_of(rank):
    return LAYERS[rank][0]


def rank_of(path):
    """Rank of a file by its path from the root; None when the table does not know it.  boundary_face.h is boundary's."""
    parts = Path(path).parts
    if parts[0] == "include":
        stem = Path(path).stem
        return RANK_OF_HEADER.get(stem, RANK_OF_HEADER.get(stem.split("_")[0]))
    return RANK_OF_FOLDER.get(parts[1] if len(parts) > 2 else ".")


def violations_of(path, text):
    """Sentences on what a file includes or names against the rule."""
    rank = rank_of(path)
    if rank is None:
        return [f"{path}: no layer of the table holds this file"]
    code = COMMENT.sub(lambda m: m.group(1) or " ", text)
    found = []
    for kind, target in INCLUDE.findall(code):
        if target.startswith("clathra/"):
            other = rank_of("include/" + target)
            if other is None:
                found.append(f"{path}: includes {target}, which no layer of the table holds")
            elif other > rank:
                found.append(f"{path}: layer {name_of(rank)} includes {target} of {name_of(other)}, a layer below it")
            elif other == RANK_OF_HEADER["base"] and name_of(rank) in NO_PETSC:
                found.append(f"{path}: layer {name_of(rank)} includes {target}, which brings in PETSc")
        elif kind == '"' and ("/" in target or target.startswith(".")):
            found.append(f"{path}: includes {target}, a private header of another folder")
        elif re.match(r"(petsc|mpi|hdf5|H5)", target) and name_of(rank) in NO_PETSC:
            found.append(f"{path}: layer {name_of(rank)} includes {target}")
    if name_of(rank) in NO_SOLVER:
        found += [f"{path}: layer {name_of(rank)} names {w}" for w in sorted(set(SOLVER.findall(INCLUDE.sub("", code))))]
    return found


STRINGS = re.compile(r'/\*.*?\*/|//[^\n]*|"(?:\\.|[^"\\\n])*"', re.S)
DEFINITION = re.compile(r"^(?!static\b|typedef\b|extern\b|#)[A-Za-z_][\w \*]*?\b(\w+)\([^;{]*\)\n\{", re.M)


def circle_of(files):
    """One circle of files that call each other, as sentences; files: name -> text."""
    code = {name: STRINGS.sub(" ", text) for name, text in files.items()}
    home = {m.group(1): name for name, text in code.items() for m in DEFINITION.finditer(text)}
    calls = {name: {home[w]: w for w in sorted(set(re.findall(r"\b\w+\b", text))) if home.get(w, name) != name} for name, text in code.items()}
    done = set()

    def visit(name, way):
        if name in way:
            ring = way[way.index(name) :] + [name]
            return [f"{a} calls {calls[a][b]} of {b}" for a, b in zip(ring, ring[1:])]
        if name in done:
            return None
        found = next(filter(None, (visit(other, way + [name]) for other in sorted(calls[name]))), None)
        done.add(name)
        return found

    return next(filter(None, (visit(name, []) for name in sorted(code))), [])


def circles(root):
    found = []
    for folder in sorted(p for p in (root / "src").iterdir() if p.is_dir()):
        ring = circle_of({p.name: p.read_text() for p in folder.glob("*.c")})
        if ring:
            found.append(f"src/{folder.name}: files in a circle: " + ", ".join(ring))
    return found


MODEL = re.compile(r"typedef struct \{(?:(?!typedef struct).)*\} Model;", re.S)
PRIVATE_FROM = "seen by src/model alone"


def private_members(header):
    """Names of the members of Model that stand behind the mark."""
    body = MODEL.search(header).group(0).split(PRIVATE_FROM, 1)[1].split("*/", 1)[1].rsplit("}", 1)[0]
    parts = re.split(r"[;,]", re.sub(r"\[.*?\]", "", COMMENT.sub(" ", body)))
    return {re.findall(r"\w+", part)[-1] for part in parts if part.strip()}


def peeks_of(path, text, private):
    """Sentences on private members of Model that a file below src/model names; src/case has none, its m are materials."""
    if not path.startswith("src/") or rank_of(path) <= RANK_OF_FOLDER["model"] or rank_of(path) == RANK_OF_FOLDER["case"]:
        return []
    named = set(re.findall(r"\b(?:m|model)(?:->|\.)(\w+)", COMMENT.sub(" ", text)))
    return [f"{path}: {name} of Model is src/model's own" for name in sorted(private & named)]


CHECK = re.compile(r"^[A-Za-z][\w \*]*?\b(\w*(?:Check|Valid|Good|Filled|Fits)\w*)\(([^;{)]*)\)\n\{\n(.*?)^\}", re.M | re.S)
FILLED = re.compile(r"(?<!const )\b(?:Case|Scene|Bc|Region|Material|Probe|Meter|CaseStage) \*|^ *(?!r->)\w+->.*[^=!<>]=[^=]|\b\w+->\S*(?:\+\+|--);", re.M)


def fillers_of(path, text):
    """Sentences on checks of src/case that could fill a field of the case, or do: what follows from keys is found before (derive.c)."""
    if not path.startswith("src/case/"):
        return []
    return [f"{path}: {name} is a check and fills the case, or could" for name, *parts in CHECK.findall(COMMENT.sub(lambda m: m.group(1) or " ", text)) if any(map(FILLED.search, parts))]


PLANTED = {  # path: text, whether it is wrong
    ("include/clathra/point.h", '#include "clathra/grid.h"\n'): True,
    ("include/clathra/laws.h", '#include "clathra/base.h"\n'): True,
    ("include/clathra/laws.h", "#include <petscvec.h>\n"): True,
    ("src/laws/relperm.c", '  #  include "clathra/material.h"\n'): True,
    ("src/point/point.c", '#include "clathra/point.h"\nstatic Vec x;\n'): True,
    ("src/grid/grid.c", '#include "clathra/particles.h"\n'): True,
    ("src/grid/grid.c", '#include "../point/state.h"\n'): True,
    ("src/model/residual.c", '#include "clathra/stepper.h"\n'): True,
    ("src/model/residual.c", '#include "clathra/unheard.h"\n'): True,
    ("src/unheard/a.c", ""): True,
    ("src/point/point.c", '#include "clathra/point.h"\n#include "state.h"\n/* Vec */ // MPI_Comm\n'): False,
    ("src/case/read.c", '#include "clathra/case.h"\n#include "clathra/io.h"\n'): False,
    ("include/clathra/particles.h", '#include "clathra/scene.h"\n'): False,
    ("src/explicit/update.c", '#include "clathra/case.h"\n'): True,
    ("src/grid/grid.c", '/*\n#include "clathra/model.h"\n*/\n#include "clathra/grid.h"\n'): False,
    ("src/main.c", '#include "clathra/stepper.h"\n#include "clathra/case.h"\n'): False,
}


def self_test():
    wrong = [path for (path, text), bad in PLANTED.items() if bool(violations_of(path, text)) != bad]
    rings = {"a.c": "void A(void)\n{\n  C();\n}\n", "b.c": "int B(int x)\n{\n  A(); /* C */\n}\n", "c.c": "void C(void)\n{\n  D();\n}\n"}
    if circle_of(rings) or len(circle_of({**rings, "d.c": "void D(void)\n{\n  B(1);\n}\n"})) != 4:
        wrong.append("files in a circle")
    header = "typedef struct {\n  Grid grid; /* coef */\n  /* seen by src/model alone */\n  double *coef, *x; /* [n] */\n  double (*plate)[4];\n} Model;\n"
    private = private_members(header)
    peeks = {("src/io/a.c", "e->m->coef[0] = s->model.x;"): 2, ("src/io/a.c", "m->grid; a->x; /* m->x */"): 0, ("src/model/a.c", "m->x"): 0}
    if private != {"coef", "x", "plate"} or any(len(peeks_of(path, text, private)) != n for (path, text), n in peeks.items()):
        wrong.append("private members of Model")
    head = "void CheckWell(Reader *r, const Case *c, const Bc *b)\n{\n"
    checks = {head.replace("const Bc", "Bc") + "}": 1, head + "  c->scene.bc[0].at = 1;\n}": 1, head + "  Bc *o = c->scene.bc;\n}": 1, head + "  if (c->x >= 1 && b->y == 2)\n    r->bad[0] = !b->z;\n}": 0}
    if any(len(fillers_of("src/case/a.c", text)) != n for text, n in checks.items()):
        wrong.append("checks that fill")
    for path in wrong:
        print(f"self-test: a planted case was judged wrongly: {path}")
    return len(wrong)


def main():
    root = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1])
    files = sorted(p for folder in ("src", "include") for p in (root / folder).rglob("*.[ch]"))
    found = [v for p in files for v in violations_of(p.relative_to(root).as_posix(), p.read_text())]
    found += circles(root)
    private = private_members((root / "include/clathra/model.h").read_text())
    found += [v for p in files for v in peeks_of(p.relative_to(root).as_posix(), p.read_text(), private)]
    found += [v for p in files for v in fillers_of(p.relative_to(root).as_posix(), p.read_text())]
    print("\n".join(found + [f"{len(files)} files, {len(found)} violations, {len(PLANTED)} planted cases tried"]))
    return 1 if self_test() or found or not files else 0


if __name__ == "__main__":
    sys.exit(main())
