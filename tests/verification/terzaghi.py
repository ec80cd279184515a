#!/usr/bin/env python3
"""Row 4: linear consolidation (Terzaghi) of a column filled with water, and with water and immobile gas.

The closed form knows one pressure.  The case realises it with a tiny capillary pressure (p0 = 300 Pa), so that gas and water are
squeezed together and the pore fluid stores S = phi (Sw/Kw + Sg/p) per Pa; with k_rw = 1 and k_rg = 0 at any saturation,
so that only water flows; and with a load of 1e3 Pa.  Water alone is a gas share of 1e-6, whose storage is counted too.
"""
from pathlib import Path

import numpy as np

import exact
from common import Run, check, finish, judge, order, table

CASE = Path(__file__).parent / "cases" / "terzaghi.yaml"
P0, PEAK, H, X = 3.25e6, 1e3, 1.0, 0.6  # Pa, Pa, m, m
M = exact.constrained_modulus(9e7, 0.2)
TIMES = np.array([500.0, 1000.0, 1500.0, 2000.0])

FLUIDS = {  # saturations, options
    "gas and water": (0.6, 0.4, []),
    "water": (1 - 1e-6, 1e-6, ["-mat_sediment_retention_Swr", 0, "-mat_sediment_retention_Sgr", 0]),
}
LOADS = {
    "triangular": [],
    "constant": ["-bc_load_normal_table", f"0 s, {P0 + PEAK} Pa, 2000 s, {P0 + PEAK} Pa"],
}


class Solution:
    """The closed form for one fluid and load."""

    def __init__(self, fluid, load):
        Sw, Sg, _ = FLUIDS[fluid]
        self.B, self.c = exact.mixture_coefficients(M, 1.53e-12, 0.15, 2.2e9, Sw, Sg, P0)
        self.load = load

    def pressure(self, a, t):
        if self.load == "constant":
            return exact.terzaghi_constant(PEAK, self.B, self.c, H, a, t)
        return exact.terzaghi_triangle(PEAK, 1000.0, self.B, self.c, H, a, t)

    def settlement(self, t):
        if self.load == "constant":
            return exact.terzaghi_constant_settlement(PEAK, M, self.B, self.c, H, t)
        return exact.terzaghi_triangle_settlement(PEAK, 1000.0, M, self.B, self.c, H, t)


def solve(fluid, load, cells, dt, stepper="sdirk2"):
    """{quantity: values at TIMES}: p (Pa, at x = 0.6 m), u (m, loaded end), profile [(x (m), p (Pa))]."""
    Sw, Sg, options = FLUIDS[fluid]
    run = Run.of_case(CASE, "-grid_cells", f"{cells},1", "-stepper_dt", dt, "-stepper_type", stepper,
                      "-region_column_Sw", repr(Sw), "-region_column_Sg", repr(Sg), *options, *LOADS[load])  # fmt: skip
    profile = []
    for t in TIMES:
        v = run.snapshot(t)
        profile.append((v["position"][:, 0] - v["displacement"][:, 0], v["p"][:, 0] - P0))
    return {"p": run.at("p06", "p_Pa", TIMES) - P0, "u": run.at("surface", "u_x_m", TIMES), "profile": profile}


def errors(got, fluid, load):
    """Largest error at TIMES of p(0.6 m), of the settlement and of the profile (rms over the column), each relative to
    the largest exact value at TIMES."""
    s = Solution(fluid, load)
    p, u = s.pressure(H - X, TIMES), s.settlement(TIMES)
    rms, top = 0.0, 0.0
    for t, (x, profile) in zip(TIMES, got["profile"]):
        want = s.pressure(H - x, t)
        rms, top = max(rms, np.sqrt(np.mean((profile - want) ** 2))), max(top, np.max(np.abs(want)))
    return (np.max(np.abs(got["p"] - p)) / np.max(np.abs(p)), np.max(np.abs(got["u"] - u)) / np.max(np.abs(u)), rms / top)


def orders(steps, values):
    return ["", *order(steps, values)]


def space():
    """Error against h, with steps so short that the time error does not show."""
    cells = (12, 25, 50)
    for fluid in FLUIDS:
        for load in LOADS:
            found = np.array([errors(solve(fluid, load, n, 10.0), fluid, load) for n in cells])
            print(f"\n{fluid}, {load} load, sdirk2, dt = 10 s: largest errors over the largest value, in %")
            columns = [[f"{1 / n:.4f}" for n in cells]]
            for k in range(3):
                columns += [list(100 * found[:, k]), orders([1 / n for n in cells], found[:, k])]
            table(("h (m)", "p(0.6 m)", "order", "settlement", "order", "profile (rms)", "order"), list(zip(*columns)))
            for k, what in enumerate(("p(0.6 m)", "settlement", "profile of p, rms")):
                judge(4, f"Terzaghi, {fluid}, {load} load, 50 cells: {what}", found[-1, k], 2e-3, 0.01, "%")
                check(f"{what}: error falls with h (50 over 12 cells)", found[-1, k] / found[0, k], 0.5)


def time():
    """Error against dt on 12 cells: difference from a run with much shorter steps, so that h does not show.

    sdirk2's order is printed and not judged: a load that starts at t = 0 with a slope or a jump is not smooth (stage order
    1 for the stiff modes), and what is left is a hundredth of euler's error.  bp2_order.py judges it on a smooth load.
    """
    steps = (100.0, 50.0, 25.0)
    for fluid, load in (("gas and water", "triangular"), ("water", "constant")):
        fine, off = solve(fluid, load, 12, 2.5), {}
        for stepper in ("euler", "sdirk2"):
            runs = [solve(fluid, load, 12, dt, stepper) for dt in steps]
            p, u = ([np.max(np.abs(r[k] - fine[k])) / np.max(np.abs(fine[k])) for r in runs] for k in "pu")
            off[stepper] = p, u
            print(f"\n{fluid}, {load} load, {stepper}, 12 cells: largest difference from sdirk2, dt = 2.5 s, in %")
            columns = [steps, 100 * np.array(p), orders(steps, p), 100 * np.array(u), orders(steps, u)]
            table(("dt (s)", "p(0.6 m)", "order", "settlement", "order"), list(zip(*columns)))
        for q, what in enumerate(("p(0.6 m)", "settlement")):
            name = f"Terzaghi, {fluid}, {load} load: {what}"
            judge(4, f"{name}, order of euler", order(steps, off["euler"][q])[-1], (0.9, 1.2))
            judge(4, f"{name}, error of sdirk2 at 100 s over euler's at 25 s", off["sdirk2"][q][0] / off["euler"][q][-1], 1.0)


if __name__ == "__main__":
    space()
    time()
    finish()
