#!/usr/bin/env python3
"""Probes that are means: over a region by current volume, against the particles of the snapshot; over a surface by current
area, against a pressure known everywhere; the same on 1, 2 and 4 ranks, by both kinds of integrator.  What fields and probes
compute from stress, strain and strength is computed here again.
"""
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "verification"))
from common import Run, check, check_true, finish  # noqa: E402

FOOTING, SEA = HERE / "cases" / "footing.yaml", HERE.parent / "verification" / "cases" / "sea_body.yaml"
MEANS = ("-probes", "p,body,spot,here,strip", "-regions", "block,disc", "-region_disc_material", "none", "-region_disc_circle", "0.5 m,0.8 m,0.246 m",
         "-probe_body_over", "block", "-probe_spot_over", "disc", "-probe_here_over", "disc", "-probe_here_fixed", "yes",
         "-probe_strip_side", "top", "-probe_strip_from", "0 m", "-probe_strip_to", "0.5 m")  # fmt: skip


def derived(kind, v):
    xx, yy, zz, xy = v["stress"][:, :4].T
    mean, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    top, low = np.maximum(mean + radius, zz), np.minimum(mean - radius, zz)
    q = np.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy**2)
    left = np.exp(-5 * v["eps_d_p"].ravel())
    c, phi = 20e3 + 40e3 * left, np.radians(20 + 5 * left)
    distance = c - ((top - low) / 2 + (top + low) / 2 * np.sin(phi)) / np.cos(phi)
    F = v["deformation_gradient"].reshape(-1, 2, 2)
    w, R = np.linalg.eigh(F @ F.transpose(0, 2, 1))
    e = np.zeros((len(F), 3, 3))
    e[:, :2, :2] = np.einsum("nij,nj,nkj->nik", R, 0.5 * np.log(w), R)
    dev = e - np.trace(e, axis1=1, axis2=2)[:, None, None] / 3 * np.eye(3)
    for name, value in (("q", q), ("p_eff", -(xx + yy + zz) / 3), ("yield_distance", distance), ("eps_d", np.sqrt(2 / 3 * np.sum(dev**2, axis=(1, 2))))):
        check(f"{kind}: {name} of all particles", np.max(np.abs(v[name].ravel() - value)) / np.max(np.abs(value)), 1e-9)
    flag = v["yield"].ravel() > 0
    check(f"{kind}: distance to yield of those that yield, Pa", np.max(np.abs(v["yield_distance"].ravel()[flag])), 1e-4)
    check(f"{kind}: ... and of the others", -np.min(v["yield_distance"].ravel()[~flag]), 1e-4)


def regions():
    for kind, options in (("sdirk2", ("-newton_tol_residual", "1e-11", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-10")),
                          ("hybrid", ("-stepper_type", "hybrid", "-stepper_adapt", "yes"))):  # fmt: skip
        go = lambda ranks: Run.of_case(FOOTING, "-quiet", *options, *MEANS, ranks=ranks)
        run = go(1)
        v = run.snapshots()[-1][1]
        x0 = v["position"] - v["displacement"]
        inside = lambda x: np.hypot(x[:, 0] - 0.5, x[:, 1] - 0.8) < 0.246
        derived(kind, v)
        check(f"{kind}: share of the volume that yields", abs(run.probe("body")["yields"][-1] - np.average(v["yield"].ravel() > 0, weights=v["volume"].ravel())), 1e-12)
        for name, which in (("body", np.full(len(x0), True)), ("spot", inside(x0)), ("here", inside(v["position"]))):
            w = v["volume"].ravel()[which] / v["volume"].ravel()[which].sum()
            for column, value in (("T_degC", v["T"].ravel()), ("syy_Pa", v["stress"][:, 1]), ("u_y_m", v["displacement"][:, 1]), ("eps_d_p", v["eps_d_p"].ravel()),
                                  ("eps_v", v["log_J"].ravel()), ("eps_d", v["eps_d"].ravel()), ("yield_distance_Pa", v["yield_distance"].ravel()), ("q_Pa", v["q"].ravel())):
                mean = np.sum(w * value[which])
                check(f"{kind}: {column} over {name}, {which.sum()} particles", abs(run.probe(name)[column][-1] / mean - 1), 1e-10)
        check_true(f"{kind}: what was and what is in the disc differ", abs(run.probe("spot")["y_m"][-1] - run.probe("here")["y_m"][-1]) > 1e-4)
        top = (x0[:, 1] > 0.8751) & (x0[:, 0] < 0.5)  # one row of particles
        spans = v["deformation_gradient"][top][:, [0, 2]]
        area = np.hypot(spans[:, 0], spans[:, 1])
        area, u = area[x0[top][:, 1] > 0.93], v["displacement"][top][:, 1][x0[top][:, 1] > 0.93]
        check(f"{kind}: settlement of the strip", abs(run.probe("strip")["u_y_m"][-1] / (np.sum(area * u) / area.sum()) - 1), 1e-9)
        for ranks in (2, 4):
            other = go(ranks)
            worst = max(np.max(np.abs(a - other.probes[k])) / (np.max(np.abs(a)) or 1.0) for k, a in run.probes.items())
            check(f"{kind}: {ranks} ranks against 1", worst, 1e-7)


def surfaces():
    """Water at rest: p = 10 kPa/m (50 m - y) on every face; the slope runs from (6, 0) to (4, 4)."""
    p = lambda y: 1e4 * (50 - y)
    run = Run.of_case(SEA, "-quiet", "-time_end", "10 s", "-output_times", "10 s", "-region_body_polygon", "[[0 m,0 m],[6 m,0 m],[4 m,4 m],[0 m,4 m]]",
                      "-boundaries", "base,left", "-bc_base_type", "fixed", "-bc_base_axis", "y", "-bc_base_position", "0 m",
                      "-bc_left_type", "roller", "-bc_left_axis", "x", "-bc_left_position", "0 m",
                      "-probes", "left,high,slope", "-probe_left_side", "left", "-probe_high_side", "left", "-probe_high_from", "2 m",
                      "-probe_slope_along", "[[6 m,0 m],[4 m,4 m]]")  # fmt: skip
    for name, y in (("left", 2.0), ("high", 3.0)):
        check(f"water at rest: pressure over {name}", abs(run.probe(name)["p_Pa"][-1] - p(y)), 50)
        check(f"water at rest: place of {name}", np.hypot(run.probe(name)["x_m"][-1], run.probe(name)["y_m"][-1] - y), 5e-3)
    slope = run.probe("slope")
    check("water at rest: place of the slope, of cells", np.hypot(slope["x_m"][-1] - 5, slope["y_m"][-1] - 2) / 0.5, 0.3)
    check("water at rest: pressure there", abs(slope["p_Pa"][-1] - p(slope["y_m"][-1])), 50)


regions()
surfaces()
finish()
