#!/usr/bin/python3
"""What CMake makes of its options, and of a machine without HDF5's .pc files: the commands it would compile with, and one file of
each part compiled by them."""
import json
import os
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, check_true, finish, scratch  # noqa: E402

FILE = "src/io/h5util.c"  # speaks to PETSc, MPI and HDF5


def without_hdf5():
    """A folder of links to all .pc files that pkg-config sees, but for HDF5's."""
    links = scratch()
    standard = subprocess.run(["pkg-config", "--variable", "pc_path", "pkg-config"], capture_output=True, text=True, check=True).stdout
    for folder in [*os.environ.get("PKG_CONFIG_PATH", "").split(":"), *standard.strip().split(":")]:
        for pc in Path(folder).glob("*.pc") if folder else ():
            if "hdf5" not in pc.name and not (links / pc.name).exists():
                (links / pc.name).symlink_to(pc)
    return {"PKG_CONFIG_PATH": "", "PKG_CONFIG_LIBDIR": str(links)}


def configured(*options, **environment):
    """(exit code, what CMake said, command that compiles FILE, its folder)"""
    build = scratch()
    done = subprocess.run(["cmake", "-S", ROOT, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DCLATHRA_TESTS=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON",
                           *options], capture_output=True, text=True, env={**os.environ, **environment})  # fmt: skip
    commands = json.loads((build / "compile_commands.json").read_text()) if done.returncode == 0 else []
    command = next((c["command"] for c in commands if c["file"].endswith(FILE)), "")
    return done.returncode, done.stdout + done.stderr, command, build


code, said, plain, _ = configured()
check_true("as it comes: for this machine, and warnings are none but warnings", code == 0 and "-march=native" in plain and "-Werror" not in plain, code and said)
code, said, strict, _ = configured("-DCLATHRA_WERROR=ON", "-DCLATHRA_NATIVE=OFF")
check_true("CLATHRA_WERROR, CLATHRA_NATIVE: the other way", code == 0 and "-march" not in strict and "-Werror" in strict, code and said)
code, said, found, build = configured(**without_hdf5())
check_true("without a .pc file HDF5 is found by its compiler", code == 0 and "Found HDF5" in said, code and said)
done = subprocess.run(found, shell=True, cwd=build, capture_output=True, text=True)
check_true("... and compiled with", found != "" and done.returncode == 0, done.stderr[-200:])
serial = scratch()
(serial / "hdf5.h").write_text("#include_next <hdf5.h>\n#undef H5_HAVE_PARALLEL\n")
done = subprocess.run(found.replace(" -I", f" -I{serial} -I", 1), shell=True, cwd=build, capture_output=True, text=True)
check_true("an HDF5 without MPI is refused in a sentence", done.returncode != 0 and "needs an HDF5 that was built with MPI" in done.stderr, done.stderr[:200])
finish()
