"""Units in which times and pressures read well."""

YEAR = 365.25 * 86400.0  # s, as the program counts
TIMES = (("s", 1.0), ("min", 60.0), ("h", 3600.0), ("days", 86400.0), ("years", YEAR))

SECONDS = {name: size for n, size in (("us", 1e-6), ("ms", 1e-3), *TIMES) for name in {n, n.removesuffix("s") if n in ("days", "years") else n}}
PASCALS = {"Pa": 1.0, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9}


def read(words, sizes):
    """A number with one of the units in `sizes`, in the unit whose size is 1."""
    number, unit = words.split()
    return float(number) * sizes[unit]


def seconds(words):
    """A time as the program says it ("3.4 h", "1 day"), s."""
    return read(words, SECONDS)


def pascals(words):
    """A pressure as the program says it ("3.96 MPa"), Pa."""
    return read(words, PASCALS)


def time_unit(end):
    """(name, seconds) of the unit in which times up to `end` (s) read well."""
    return next((u for u in reversed(TIMES) if end >= 5 * u[1] and (u[0] != "min" or end >= 7200)), TIMES[0])


def duration(seconds):
    """One time with its unit: "30 s", "1 day", "2.5 years"."""
    name, size = next((u for u in reversed(TIMES) if abs(seconds) >= u[1] * (1 - 1e-9)), TIMES[0])
    return said(seconds / size, name)


def said(value, name):
    value = f"{value:.4g}"
    return f"{value} {name[:-1] if value == '1' and name in ('days', 'years') else name}"


def durations(times):
    """Times (s) with one unit, that of an axis up to the last of them."""
    name, size = time_unit(times[-1]) if len(times) else TIMES[0]
    return [said(t / size, name) for t in times]
