"""clathra COMMAND ...: what the program leaves to Python.

  strength CASE                          factor of safety by strength reduction
  sweep CASE KEY=A,B,C ...               a case for several values of its keys
  calibrate CASE KEY=LOW,HIGH[,log] ... FILE.csv   values of keys with which a case meets what was measured
  compare RUN RUN ...                    in what runs differ
  plot RUN ...                           pictures of runs
  report RUN ...                         a page for each run

clathra COMMAND --help says more.
"""
import importlib
import os
import signal
import sys
from pathlib import Path

DEBIANS = "/usr/bin/python3"  # has numpy where another python3 may not
COMMANDS = ("strength", "sweep", "calibrate", "compare", "plot", "report")


def imported(name):
    """A module of the package, or, where this python3 lacks what it needs, the same in Debian's."""
    try:
        return importlib.import_module(f"clathra.{name}")
    except ImportError as error:
        if os.path.realpath(sys.executable) != os.path.realpath(DEBIANS) and os.access(DEBIANS, os.X_OK):
            os.execv(DEBIANS, [DEBIANS, str(Path(__file__).resolve()), *sys.argv[1:]])
        sys.exit(said(name, error))


def said(command, error):
    print(f"clathra {command}: {error}", file=sys.stderr)
    return 2


def ended(*_):
    raise KeyboardInterrupt


def main(words):
    if not words or words[0] not in COMMANDS:
        print(__doc__, file=sys.stdout if words and words[0] in ("-h", "--help") else sys.stderr)
        return 0 if words and words[0] in ("-h", "--help") else 2
    command, *words = words
    signal.signal(signal.SIGTERM, ended)
    module, clathra = imported(command), importlib.import_module("clathra")
    try:
        return module.main(words)
    except clathra.Failed as error:
        said(command, error)
        return error.code if error.code in (2, 3, 4) else 2 if error.code is None else 1
    except (clathra.NoRun, clathra.Damaged, ImportError) as error:
        return said(command, error)
    except KeyboardInterrupt:
        print(f"clathra {command}: ended by a signal", file=sys.stderr)
        return 4
    except OSError as error:
        said(command, f"{error.filename}: {error.strerror}" if error.filename else error.strerror)
        return 3


if __name__ == "__main__":
    if not __package__:  # the program starts it as a file: imports are from the folder of the package, not from within it
        sys.path[0] = str(Path(__file__).resolve().parents[1])
    sys.exit(main(sys.argv[1:]))
