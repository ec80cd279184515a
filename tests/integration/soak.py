#!/usr/bin/python3
"""A short soak: random scenes end well or with a reason, mutated cases are refused or read; scripts/soak.py makes more."""
import subprocess
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import ROOT, binary, check, check_true, finish, launch, scratch  # noqa: E402
from clathra import read_csv  # noqa: E402

done = subprocess.run([sys.executable, str(ROOT / "scripts" / "soak.py"), binary(), "--scenes", "100", "--cases", "2000", "--jobs", "1",
                       "--keep", str(scratch() / "wrong")], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)  # fmt: skip
print(done.stdout)
check_true("no crash, hang, NaN, silent end or lost balance", done.returncode == 0)

# What the soak found: a soft body whose pore pressure tractions hold is torn apart as its faces move; ambient keeps it at rest.
SOFT = Path(__file__).resolve().parent / "cases" / "soft_deep.yaml"
ADVICE = "14.3 times its stiffness, against tractions"
held, free = (scratch() / name for name in ("held", "free"))
torn = launch(binary(), SOFT, "-quiet", "-bc_sea_normal", "17.03 MPa", out=free)
check_true("held by tractions alone but for 7 kPa: warned, and given up with the cause", torn.returncode == 3
           and f"warning: the pores of region body bear 17 MPa, {ADVICE}" in torn.stdout and "A likely cause: the pores" in torn.stdout, torn.stdout[-300:])  # fmt: skip
done = launch(binary(), SOFT, "-quiet", "-ambient_pressure", "17.037 MPa", "-bc_sea_normal", "-1 Pa", out=held)
check_true("held by ambient: no warning, finished", done.returncode == 0 and "warning" not in done.stdout, done.stdout[-300:])
if done.returncode == 0:
    check("... and heaves by p L/M of the pascal that is missing (m)", abs(read_csv(held / "probes.csv")["top.u_y_m"][-1]), 1e-8)
finish()
