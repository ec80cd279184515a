"""A case that is to run: from a dict or from one that is there, with changes."""
import copy
import functools
import re
import tempfile
from pathlib import Path

from .program import Job, Refused, call, find_program
from .resolved import read_case
from .tables import text_of

FORMS = ("table", "ramp", "rate", "piecewise", "sine", "csv")  # of a function of time
SOLVER = ("newton", "snes", "ksp", "pc", "reduced")  # first words of options that are no keys of a case, but may change with them
PLAIN = re.compile(r"[\w.+-][\w .+/^*()°²³-]*")  # a text that YAML reads as it is
GIVEN = "given.yaml"  # in the results of a case that is no file


def flat(nested, parents=()):
    """{key as on the command line: value} of nested ones; {form: values} is a value."""
    found = {}
    for name, value in nested.items():
        key = "_".join((*parents, str(name)))
        group = isinstance(value, dict) and not (len(value) == 1 and next(iter(value)) in FORMS)
        for k, v in (flat(value, (*parents, str(name))) if group else {key: value}).items():
            if k in found:
                raise Refused(f"{k} is given twice")
            found[k] = v
    return found


@functools.lru_cache(maxsize=8)
def _units(program):
    """[(pattern of a key, unit)] of the program's keys, the most exact first."""
    rows = re.findall(r"^\| `(\S+)` \| [^|]* \| ([^|]*) \|", call("-case_keys", program=program), re.M)
    rows += [(name, "") for name in re.findall(r"^`(\w+)`: the list", call("-case_keys", program=program), re.M)]
    rows.sort(key=lambda row: -len(row[0].replace("<name>", "")))
    return [(re.compile(key.replace("<name>", r"[\w-]+?")), unit.strip()) for key, unit in rows]


def _bare(value):
    """Is there a number without a unit in it?"""
    return any(map(_bare, value)) if isinstance(value, list) else isinstance(value, (int, float)) and not isinstance(value, bool)


def _in_units(value, units):
    """Its bare numbers with these units, in turn."""
    if isinstance(value, list):
        return [_in_units(v, units if isinstance(v, list) else (units[k % len(units)],)) for k, v in enumerate(value)]
    return f"{value!r} {units[0]}" if _bare(value) else value


def words_of(value, quote=False):
    """A value as YAML, or with the quotes left out as an option, says it."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{k}: {words_of(v, quote)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(words_of(v, quote) for v in value) + "]"
    if isinstance(value, bool):
        return "yes" if value else "no"
    text = value if isinstance(value, str) else repr(value)
    return "'" + text.replace("'", "''") + "'" if quote and not PLAIN.fullmatch(text) else text


def _plain(value):
    """numpy's arrays and numbers as Python's."""
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    value = value.tolist() if hasattr(value, "tolist") else str(value) if isinstance(value, Path) else value
    return [_plain(v) for v in value] if isinstance(value, (list, tuple)) else value


def _form(key):
    """(key, form) of a function of time whose form stands in its key: bc_load_normal_ramp; (key, None) of another."""
    base, _, form = key.rpartition("_")
    return (base, form) if form in FORMS and base else (key, None)


def find_case(name, program=None):
    """A case's folder or file, or a shipped one by its name."""
    is_case = lambda path: path.is_file() or (path / "case.yaml").is_file()
    if is_case(Path(name)):
        return Path(name).resolve()
    top = Path(find_program(program)).resolve().parents[1]
    for path in (top / "cases" / name, top / "share" / "clathra" / "cases" / name):
        if is_case(path):
            return path
    raise Refused(f"there is no case {name}: no folder with a case.yaml, no such file, and none that is shipped")


class Case:
    """What is to run: a dict of keys, nested or flat, or a case that is there (a folder with a case.yaml, a file, the name of a shipped one).

        case = clathra.Case("terzaghi").with_(mat_clay_permeability_k0="1e-14 m^2", grid_cells=[20, 1])
        case.check()
        run = case.run("results/terzaghi")

    Values are texts with units ("2 MPa"), bare numbers (in the unit of the program's key table: SI, degC, deg), bools, lists, functions of time
    ({"ramp": [0, 1e5, 0, 10]}).  Files that a dict names count from the working folder.  `program`: where it is (find_program).
    """

    def __init__(self, source, program=None):
        self.program, self.changes = program, {}
        self.path = None if isinstance(source, dict) else find_case(source, program)
        if self.path is None:
            self.changes = flat(_plain(source))

    def __repr__(self):
        return f"clathra.Case({str(self.path) if self.path else self.changes!r})" + (f".with_({self.changes!r})" if self.path and self.changes else "")

    @property
    def name(self):
        """Of its folder or file, or its title."""
        if self.path is None:
            return str(self.changes.get("title", "case"))
        return self.path.parent.name if self.path.name == "case.yaml" else self.path.stem

    def with_(self, changes=None, **keys):
        """The case with other keys (a dict, nested or flat, or names); None takes a change back, or the key of a dict away."""
        found, new = copy.copy(self), flat(_plain({**(changes or {}), **keys}))
        replaced = {_form(key)[0] for key in new}  # in whatever form of a function of time
        found.changes = {k: v for k, v in {**{k: v for k, v in self.changes.items() if _form(k)[0] not in replaced}, **new}.items() if v is not None}
        return found

    def _value(self, key, value):
        """With the units that bare numbers lack, and files of a dict by their whole path."""
        base, form = _form(key)
        values = value
        if isinstance(value, dict):
            form, values = next(iter(value.items()))
        if form == "csv" and self.path is None:
            file, *column = values if isinstance(values, list) else values.split(",")
            values = [str(Path(file).resolve()), *column]
        unit = next((unit for pattern, unit in _units(self.program) if pattern.fullmatch(base)), "") if _bare(values) else ""
        if unit:
            change = "K" if unit == "degC" else unit
            units = {"ramp": (unit, unit, "s", "s"), "rate": (unit, f"{change}/s", "s", "s"), "table": ("s", unit), "piecewise": ("s", unit),
                     "sine": (unit, *(change, "s", "s") * 99)}  # fmt: skip
            values = _in_units(values, units.get(form, (unit,)))
        return {form: values} if isinstance(value, dict) else values

    def _options(self):
        """Changes of a file, as options."""
        words, heads = [], {pattern.pattern.split("_")[0] for pattern, _ in _units(self.program)}
        for key, value in self.changes.items():
            if key.split("_")[0] not in (*heads, *SOLVER):
                raise Refused(f"{key} = {words_of(value)}: unknown key (clathra -case_keys lists all)")
            value = self._value(key, value)
            if _form(key)[1] and isinstance(value, list) and all(isinstance(pair, list) for pair in value):
                value = sum(value, [])  # an option takes the numbers of pairs one after the other
            words += [f"-{key}", words_of(value)]
        return words

    def text(self):
        """The keys of a dict as a case file."""
        return "".join(f"{key}: {words_of(self._value(key, value), quote=True)}\n" for key, value in self.changes.items())

    def command(self, folder, options=()):
        """The command that runs it into a folder, with further options; the case of a dict is to be written to `folder`/given.yaml."""
        words = [find_program(self.program), self.path or Path(folder).resolve() / GIVEN, "-output_dir", folder, *options]
        return list(map(str, words + (self._options() if self.path else [])))

    def start(self, folder, ranks=1, options=(), restart=None):
        """Begins a run into a folder and returns at once: the Job, whose progress() says how far it is, wait() gives the Run, stop() ends it.

        options   words of further options of the program (docs/options.md): ("-stepper_max_steps", 10)
        restart   True: goes on from the folder's checkpoint; or the path of one
        """
        if isinstance(options, str):
            raise Refused(f"options = {options!r} is no list of words")
        folder = Path(folder)
        if restart:
            options = (*options, "-restart", folder / "checkpoint.h5" if restart is True else restart)
        command, given, new = self.command(folder, options), folder / GIVEN, None
        if self.path is None:
            folder.mkdir(parents=True, exist_ok=True)
            new, text = None if given.is_file() else given, self.text()
            if new or text_of(given) != text:
                given.write_text(text, encoding="utf-8")
        return Job(command, folder, ranks, bool(restart), new)

    def run(self, folder, ranks=1, options=(), restart=None):
        """As start, until its end: the Run.  Raises Refused, GaveUp, Ended or Failed with what the program said; Ctrl-C stops it."""
        return self.start(folder, ranks, options, restart).wait()

    def check(self, options=()):
        """Lets the program read and check it without a run: what it says, forecast and warnings.  Raises Refused with its errors."""
        with tempfile.TemporaryDirectory() as folder:
            return self._told(self.start(folder, options=(*options, "-case_check")), folder)

    def resolved(self, texts=False, options=()):
        """Every key with its value, as Run.case: {key: value in SI units}; with `texts` what the program writes, units too."""
        with tempfile.TemporaryDirectory() as folder:
            self._told(self.start(folder, options=(*options, "-quiet", "-stepper_max_steps", "0")), folder)
            return {k: v for k, v in read_case(Path(folder) / "case.yaml", texts).items() if k != "output_dir"}

    @staticmethod
    def _told(job, folder):
        """What it said at its end, without the folder that nobody has seen."""
        given = re.escape(str(Path(folder).resolve() / GIVEN))
        if job.end():
            job.errors = re.sub(rf"(?m)^{given}(:\d+)?: ", "", job.errors)
            job.fail()
        return re.sub(rf"(?m)^{given}: ", "", job.said)

    def write(self, path):
        """Writes it as a case file: the keys of a dict, or of a file with changes every key as the program resolves it."""
        text = self.text() if self.path is None else "".join(f"{k}: {v}\n" for k, v in self.resolved(texts=True).items())
        Path(path).write_text(text, encoding="utf-8")
