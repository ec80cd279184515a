#!/usr/bin/env python3
"""Runs a command on one core, which no other such command has: one_core.py COMMAND...

Ranks that wait for each other give their core away and get it back late.  Beside another test on two cores two of them take up to ten times
as long, four up to forty; all on one core they take the sum of their work, and leave the other core to what runs there.
"""
import fcntl
import os
import sys
from pathlib import Path


def take():
    """(core, its lock): a core of this process that nobody holds, as long as the lock is open; one of all where all are held."""
    cores = sorted(os.sched_getaffinity(0))
    for core in cores:
        lock = open(Path("/tmp") / f"clathra-core-{os.getuid()}-{core}", "w")
        try:
            fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
            return core, lock
        except OSError:
            lock.close()
    return cores[os.getpid() % len(cores)], open(os.devnull)


if __name__ == "__main__":
    core, lock = take()
    os.set_inheritable(lock.fileno(), True)  # held until the command ends
    os.sched_setaffinity(0, {core})
    os.execvp(sys.argv[1], sys.argv[1:])
