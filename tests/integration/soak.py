#!/usr/bin/python3
"""A short soak: random scenes end well or with a reason, mutated cases are refused or read; scripts/soak.py makes more."""
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, binary, check_true, finish, scratch  # noqa: E402

done = subprocess.run([sys.executable, str(ROOT / "scripts" / "soak.py"), binary(), "--scenes", "100", "--cases", "2000", "--jobs", "2",
                       "--keep", str(scratch() / "wrong")], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
print(done.stdout)
check_true("no crash, hang, NaN, silent end or lost balance", done.returncode == 0)
finish()
