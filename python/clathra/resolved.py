"""The case of a run as the program wrote it: case.yaml of the results, one key a line, every default, SI units."""
import re

from .tables import Entries, text_of

ENTRY = re.compile(r"^( *)([\w-]+):(?: (.*))?$")


def read_case(path, texts=False):
    """{key as on the command line: value}: mat_sand_porosity: 0.4; numbers without their (SI) units, words, lists of these; with `texts`
    what the file says, with units."""
    found, parents = Entries(path), []
    for line in text_of(path).split("\n"):
        entry = ENTRY.match(line)
        if not entry:
            continue
        depth = len(entry[1]) // 2
        parents[depth:] = [entry[2]]
        if entry[3] is not None:
            found["_".join(parents)] = entry[3] if texts else _value(entry[3])
    return found


def _value(text):
    if text.startswith("{"):
        form, _, values = text[1:-1].partition(":")
        return {form: _value(values.strip())}
    if text.startswith("["):
        return [_value(item) for item in _items(text[1:-1])]
    if text.startswith("'"):
        return text[1:-1].replace("''", "'")
    try:
        return float(text.split(" ")[0])
    except ValueError:
        return text


def _items(text):
    """Parts between the commas that stand in no bracket."""
    parts, depth = [""], 0
    for letter in text:
        depth += (letter == "[") - (letter == "]")
        if letter == "," and depth == 0:
            parts.append("")
        else:
            parts[-1] += letter
    return [part.strip() for part in parts if part.strip()]
