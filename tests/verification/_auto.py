"""A saturated column that is loaded slowly, then suddenly, then unloaded slowly, and its exact solution: the scene of
verification/auto.py and of what `auto` saves in docs/studies/tradeoff.md.  `slow` stretches all but the sudden load."""
from pathlib import Path

import numpy as np

from common import Run
from exact import constrained_modulus
from exact_dynamic import DynamicColumn

CASE = Path(__file__).parent / "cases" / "saturated_column.yaml"
K, K_W, Q, END = 1e-8, 22e6, 3e3, 80.0
PHASES = ((0, 20), (20, 25), (25, 60), (60, 80))
WATCHED = {"u(H)": ("end", "u_x_m", 10.0, "u", 0.0), "p(H/2)": ("middle", "p_Pa", 5.0, "p", 1e6)}


def loads(slow):
    """(from, to (s), change (Pa))."""
    return (0.0, 10.0 * slow, Q), (20.0 * slow, 20.0 * slow + 0.1, Q), (60.0 * slow, 70.0 * slow, -Q)


def options(cells, tol, slow=1.0):
    rows, q = ["0 s,1 MPa"], 0.0
    for begin, end, change in loads(slow):
        rows += [f"{begin} s,{1e6 + q} Pa"] * (begin > 0) + [f"{end} s,{1e6 + q + change} Pa"]
        q += change
    return ("-grid_cells", f"{cells},1", "-time_end", f"{END * slow} s", "-output_times", "0 s", "-output_probe_every", f"{0.5 * slow} s",
            "-stepper_adapt", "yes", "-stepper_dt", "0.1 s", "-stepper_tol", tol, "-mat_sand_water_bulk_modulus", f"{K_W} Pa",
            "-mat_sand_permeability_k0", f"{K} m^2", "-bc_load_normal_table", ",".join(rows))  # fmt: skip


def column(kind, *more, cells=26, tol=1e-3, **keywords):
    return Run.of_case(CASE, "-stepper_type", kind, *options(cells, tol), *more, **keywords)


def times(slow=1.0):
    return 0.5 * slow * np.arange(1, round(END / 0.5) + 1)


def exact(x, quantity, t, slow=1.0):
    found = np.zeros_like(t)
    for begin, end, change in loads(slow):
        m = DynamicColumn(H=10.0, M=constrained_modulus(14.516e6, 0.3), n_f=0.33, rho_s=2000.0, rho_w=1000.0, Kw=K_W, mobility=K / 1e-3, q=change, rise=end - begin)
        late = t > begin
        found[late] += m.solution(x, t[late] - begin)[quantity]
    return found


TIMES = times()
EXACT = {name: exact(x, q, TIMES) + zero for name, (_, _, x, q, zero) in WATCHED.items()}
