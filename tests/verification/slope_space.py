#!/usr/bin/env python3
"""cases/slope_3d one cell thick and heated everywhere is cases/slope_a.

cases/slope_3d one cell thick and heated everywhere is cases/slope_a: gravity grows, hydrate goes and the front begins to slide, by hybrid
with the same steps.  In the middle of a slope that is heated there alone it is held by what is beside it."""
import numpy as np

from common import ROOT, binary, check, finish, judge, program_of, run, table

PLANE, SPACE = ROOT / "cases" / "slope_a", ROOT / "cases" / "slope_3d"
STEPS = ("-stepper_adapt", "no", "-stepper_dt", "0.005 s", "-stage_slide_end", "12 s")
COARSE = ("-grid_upper", "480 m,120 m", "-grid_cells", "60,15")
BARS = {"displacement": 1e-10, "eps_d_p": 1e-10, "S_h": 1e-10, "T": 1e-10, "p_w": 1e-10, "p_g": 1e-10, "v_s": 1e-9}


def thick(deep, cells, heated):
    """Options for so much along z, m."""
    return ("-grid_upper", f"480 m,120 m,{deep} m", "-grid_cells", f"60,15,{cells}", "-region_slope_upper", f"300 m,100 m,{deep} m",
            "-region_heated_upper", f"300 m,1 m,{heated} m", "-bc_side_position", f"{deep} m")  # fmt: skip


def in_order(place, at):
    """Particles `at`, by where in the plane they were at the start."""
    return at[np.lexsort(np.round(place[at, :2], 6).T)]


def layers(place):
    """Those of each layer along z."""
    z = np.round(place[:, 2], 6)
    return [in_order(place, np.flatnonzero(z == at)) for at in np.unique(z)]


def main():
    plane = run(binary(), PLANE, *COARSE, *STEPS).snapshots()[-1][1]
    flat = in_order(plane["initial_position"], np.arange(len(plane["T"])))
    for ranks in (1, 2):
        space = run(program_of(SPACE), SPACE, *thick(8, 1, 8), *STEPS, ranks=ranks).snapshots()[-1][1]
        off = {k: max(np.max(np.abs(space[k][at][:, : plane[k].shape[1]] - plane[k][flat])) for at in layers(space["initial_position"])) / np.max(np.abs(plane[k])) for k in BARS}
        table(["of the largest"], [(f"{k} {v:.1e}",) for k, v in off.items()])
        worst = max(off, key=lambda k: off[k] / BARS[k])
        judge("slopes", f"slope in space, a cell thick, {ranks} rank{'s' * (ranks > 1)}, against the plane, of the bar of each field ({worst})", off[worst] / BARS[worst], 1.0)
    slid = lambda v: np.linalg.norm(v["displacement"], axis=1)
    part = run(program_of(SPACE), SPACE, *thick(24, 3, 8), *STEPS).snapshots()[-1][1]
    middle, beside = (slid(part)[np.abs(part["initial_position"][:, 2] - z) < 4] for z in (4, 20))
    front = lambda far: np.quantile(far, 0.95)
    check("heated in a third: way of the front there, over that of the plane", front(middle) / front(slid(plane)), (0.05, 0.95))
    check("... beside it, over that where it is heated", front(beside) / front(middle), 0.99)
    finish()


if __name__ == "__main__":
    main()
