#!/usr/bin/env python3
"""README and docs against the program: docs.py CLATHRA

- docs/options.md and docs/laws.md are what their scripts make of this program
- the options read in src/ and the options of that page are the same
- files and functions that README and docs name exist
- commands in README and docs, and presets, use options that exist; presets hold no physics and nothing unread
- links to headings find them
- the cases in README and docs/cases_reference.md are valid
- CHANGELOG.md, CITATION.cff, CMakeLists.txt and python/pyproject.toml say the same version
- every verification test that measures stands in docs/studies/verification.md, whose lines are as many as it says; docs/verification.md is what
  scripts/verification.py makes of it, in at most 4000 words, and says in at most 16 words what a test shows
- every page of docs/studies has a head with script, data, date and commit, and a line in docs/studies/README.md; every file of docs/studies/made.csv is there
"""
import re
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGES = [*(ROOT / page for page in ("README.md", "CHANGELOG.md", "CONTRIBUTING.md")), *sorted((ROOT / "docs").rglob("*.md")), *sorted((ROOT / "cases").glob("*/README.md"))]
EXAMPLES = (ROOT / "README.md", ROOT / "docs" / "cases_reference.md")  # whose YAML blocks are whole cases
PRESETS = sorted((ROOT / "options").glob("*.opts"))
FOLDERS = ("cases", "docs", "include", "options", "python", "scripts", "src", "tests")

# PETSc's, without an object of ours in front.
PETSC = re.compile(r"-(snes|ksp|pc|sub_pc|sub_ksp|sub|mat_mumps|mat_umfpack|log|vec|reduced_pc_factor)_\w+|"
                   r"-(help|options_file|options_left|info)")
# Presets may choose solver and integrator.
NO_PHYSICS = re.compile(r"-(stepper|newton|model_pmat|reduced)_\w+")

sys.dont_write_bytecode = True
sys.path.insert(0, str(ROOT / "scripts"))
import dated  # noqa: E402
import options_doc  # noqa: E402
import verification  # noqa: E402


def fences(page):
    """(language, text) of the fenced blocks."""
    return re.findall(r"^```(\w*)\n(.*?)^```", page.read_text(), re.M | re.S)


def options_in_source():
    call = re.compile(r'PetscOptions(?:Get\w+|HasName)\s*\([^;"]*"(-\w+)"')
    return {o for p in (ROOT / "src").rglob("*.c") for o in call.findall(p.read_text()) if not PETSC.fullmatch(o)}


def check_table():
    documented, read = {o for o, *_ in options_doc.PROGRAM}, options_in_source()
    yield from (f"src reads {o}, which scripts/options_doc.py does not describe" for o in sorted(read - documented))
    yield from (f"scripts/options_doc.py describes {o}, which src does not read" for o in sorted(documented - read))
    if not read:
        yield "no option was found in src: the search is broken"


def check_page(binary):
    old = options_doc.PAGE.read_text() if options_doc.PAGE.is_file() else ""
    if old != options_doc.page(binary):
        yield "docs/options.md is out of date: run scripts/options_doc.py CLATHRA"


def check_laws(binary):
    """docs/laws.md is what scripts/options_doc.py makes of this program, the code cites its equations, and the curves are whole."""
    text = options_doc.LAWS_PAGE.read_text()
    if text != options_doc.laws_page(binary):
        yield "docs/laws.md is out of date: run scripts/options_doc.py CLATHRA"
    yield from (f"docs/laws.md: no code cites ({n})" for law in options_doc.LAWS for n in law[3] if not options_doc.files(n))
    for law in options_doc.LAWS:
        columns, rows = options_doc.curves(binary, law[1], law[2][-1][1])
        if len(rows) < 100 or any(len(r) != len(columns) or any(v != v for v in r) for r in rows):
            yield f"-case_curves: the rows of {law[1]} are not whole"


def check_version():
    says = {"CMakeLists.txt": r"^project\(clathra VERSION (\S+)", "CHANGELOG.md": r"^## (\S+)", "CITATION.cff": r"^version: (\S+)", "python/pyproject.toml": r'^version = "(\S+)"'}
    versions = {page: found[1] if (found := re.search(pattern, (ROOT / page).read_text(), re.M)) else None for page, pattern in says.items()}
    if len(set(versions.values())) > 1:
        yield f"the versions differ: {versions}"


def named_files(page):
    """(what the page says, path, function or None)."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
    for target in re.findall(r"\]\(([^)#\s]+)\)", text):
        if "://" not in target:
            yield target, page.parent / target, None
    for word in re.findall(r"`([^`\n]+)`", text):
        path, _, function = word.partition(":")
        if path.split("/")[0] in FOLDERS and "/" in path and re.fullmatch(r"[\w./*-]+", path):
            yield word, ROOT / path, function or None


def exists(path):
    return any(path.parent.glob(path.name)) if "*" in path.name else path.exists()


def anchors(page):
    """What links into a page may end with: its headings in small letters, words joined by hyphens."""
    text = re.sub(r"^```.*?^```", "", page.read_text(), flags=re.M | re.S)
    return {re.sub(r"[^\w\- ]", "", h.strip().lower()).replace(" ", "-") for h in re.findall(r"^#+ (.*)$", text, re.M)}


def check_anchors(page):
    for target, heading in re.findall(r"\]\(([^)#\s]*)#([^)\s]+)\)", page.read_text()):
        there = page.parent / target if target else page
        if "://" not in target and there.suffix == ".md" and there.is_file() and heading not in anchors(there):
            yield f"{page.relative_to(ROOT)}: {target or 'the page'} has no heading #{heading}"


def check_files(page):
    for word, path, function in named_files(page):
        if not exists(path):
            yield f"{page.relative_to(ROOT)}: there is no {word}"
        elif function and not re.search(rf"\b{function}\(", path.read_text()):
            yield f"{page.relative_to(ROOT)}: {path.relative_to(ROOT)} has no function {function}"


def case_patterns(binary):
    keys = re.findall(r"^\| `(\w*(?:<name>)?\w*)` \|", options_doc.case_keys(binary), re.M)
    lists = re.findall(r"^`(\w+)`: the list", options_doc.case_keys(binary), re.M)
    form = r"(_table|_ramp|_rate|_piecewise|_sine|_csv)?"
    return re.compile("-(" + "|".join(k.replace("<name>", r"[\w-]+?") + form for k in keys + lists) + ")")


def commands(page):
    """Commands of this program in the fenced blocks and in inline code, as words."""
    text = page.read_text()
    lines = [line for _, block in fences(page) for line in block.splitlines()] + re.findall(r"`([^`\n]+)`", text)
    for line in lines:
        if re.match(r"(RANKS=\d+ |mpiexec -n \d+ )?(build/clathra|\./run)\b", line):
            words = shlex.split(line, comments=True)
            at = next(k for k, w in enumerate(words) if w in ("build/clathra", "./run"))
            yield line, words[at + 1 :]


def is_option(word):
    return re.match(r"-[A-Za-z]", word)


def check_commands(page, known):
    for line, words in commands(page):
        for k, word in enumerate(words):
            if is_option(word) and not known(word):
                yield f"{page.relative_to(ROOT)}: unknown option {word} in: {line}"
            if k and words[k - 1] == "-options_file" and not (ROOT / word).is_file():
                yield f"{page.relative_to(ROOT)}: no file {word} in: {line}"


def check_preset(binary, preset, known):
    name = preset.relative_to(ROOT)
    words = [w for line in preset.read_text().splitlines() for w in shlex.split(line, comments=True)]
    for word in filter(is_option, words):
        if not known(word):
            yield f"{name}: unknown option {word}"
        elif not (PETSC.fullmatch(word) or NO_PHYSICS.fullmatch(word)):
            yield f"{name}: {word} is no business of a preset"
    with tempfile.TemporaryDirectory() as folder:
        run = subprocess.run(
            [binary, ROOT / "cases" / "bp2", "-options_file", preset, "-stepper_max_steps", "1", "-output_dir", folder,
             "-quiet", "-options_left"], capture_output=True, text=True, timeout=120)  # fmt: skip
    if run.returncode != 0:
        yield f"{name}: one step of cases/bp2 ends with code {run.returncode}: {run.stdout[-300:]}{run.stderr[-300:]}"
    left = re.findall(r"^Option left: name:(-\w+)", run.stdout, re.M)
    yield from (f"{name}: nobody reads {o}" for o in left)


def check_example(binary, page):
    blocks = [text for language, text in fences(page) if language == "yaml"]
    if not blocks:
        yield f"{page.name} has no case"
    for text in blocks:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "case.yaml"
            path.write_text(text)
            run = subprocess.run([binary, path, "-case_check"], capture_output=True, text=True, timeout=60)
            if run.returncode != 0:
                yield f"{page.name}: the case is not valid: {run.stderr}"


def check_verification():
    """Tests whose numbers are not on the page of all numbers, numbers that it counts but does not show, and a page of tests that is another one."""
    text = verification.ALL.read_text()
    rows = len(re.findall(r"^\| (?!what \|).*\.py\)[^|]* \|$", text, re.M))
    said = re.search(r"^(\d+) numbers, ", text, re.M)
    if not said or int(said[1]) != rows:
        yield f"docs/studies/verification.md says {said and said[1]} numbers and shows {rows}"
    for test in sorted((ROOT / "tests" / "verification").glob("[!_]*.py")):
        if test.stem not in ("common", "exact") and re.search(r"^[^#\n]*\b(judge|record)\(", test.read_text(), re.M) and f"verification/{test.name})" not in text:
            yield f"docs/studies/verification.md has no number of {test.name}: run scripts/verification.py --only {test.stem}"
    found = verification.records_of(text)
    if verification.PAGE.read_text() != (short := verification.overview([r for t in sorted(found) for r in found[t]])):
        yield "docs/verification.md is out of date: run scripts/verification.py --only --no-figures"
    if len(short.split()) > 4000:
        yield f"docs/verification.md has {len(short.split())} words"
    yield from (f"the first sentence of {t}.py has more than 16 words: {verification.shows(t)}" for t in found if len(verification.shows(t).split()) > 16)


def check_studies():
    contents = (dated.STUDIES / "README.md").read_text()
    for page in sorted(dated.STUDIES.glob("[!R]*.md")):
        head = re.match(r"# .*\n\n- Script: \[(\S+)\]\(\.\./\.\./\1\)\. It writes this page\.\n(- Data: .*)\n- Since then: \S.*\n\n", page.read_text())
        files = re.findall(r"\[([\w.]+)\]\(|this page", head[2]) if head else []
        if not head or head[2] != dated.data(*(f or page.name for f in files)):
            yield f"{page.relative_to(ROOT)} does not begin with its script, its data, their dates and commits as in made.csv, and what has changed since"
        if f"]({page.name})" not in contents:
            yield f"docs/studies/README.md does not name {page.name}"
    if verification.GUARDS.read_text() != verification.guards():
        yield "tests/README.md is not what the tests say of themselves: scripts/verification.py --only --no-figures"
    yield from (f"docs/studies/made.csv names {f}, which is not there" for f in dated.read() if not (dated.STUDIES / f).is_file())


def main(binary):
    binary = str(Path(binary).resolve())
    case, program = case_patterns(binary), {o for o, *_ in options_doc.PROGRAM}
    known = lambda word: word in program or PETSC.fullmatch(word) or case.fullmatch(word)
    planted = ["-stepper_typ", "-mat_sand_porosty", "-newton_tol", "-grid", "-ksptype"]
    found = [f"self-test: {word} was taken for an option" for word in planted if known(word)]
    found += [*check_table(), *check_page(binary), *check_laws(binary), *check_version(), *check_verification(), *check_studies(), *(f for page in EXAMPLES for f in check_example(binary, page))]
    for page in PAGES:
        found += [*check_files(page), *check_anchors(page), *check_commands(page, known)]
    for preset in PRESETS:
        found += check_preset(binary, preset, known)
    count = sum(1 for page in PAGES for _ in named_files(page)), sum(1 for page in PAGES for _ in commands(page))
    print("\n".join(found + [f"{len(PAGES)} pages, {count[0]} files and {count[1]} commands named, {len(PRESETS)} presets, "
                             f"{len(found)} faults"]))  # fmt: skip
    return 1 if found or not min(count) or not PRESETS else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
