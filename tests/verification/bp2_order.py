#!/usr/bin/python3
"""Order in time by self-convergence on smooth BP2 loading (row 3), kinetics off and on.

All runs of a study start from one checkpoint (60 s into a steadily growing load), take equal steps and end at the same
time; differences of neighbours give the order.  Changes against BP2, all to let the error in time stand out:
- the permeability is a hundred times larger: with BP2's own the pressure is so nearly linear in time that SDIRK2 at
  dt = 200 s is within 1e-5 of the change, which leaves nothing to measure;
- the load grows by 0.5 MPa in 1000 s instead of 10 MPa: the basis is frozen over a step, at the places where the
  particles are at its start, and that leaves an error of first order in dt, quadratic in the displacement, and against
  that of second order: with 2, 1 and 0.5 MPa SDIRK2 shows 3.0, 2.21 and 2.07 in u between the same steps;
- with kinetics on, the pore pressure starts at 3.62 MPa, just above equilibrium, for the start of formation is a kink.
Steps: a longer fixed step than wanted is cut by the probe's rows, so that all runs can share the checkpoint.
"""
import numpy as np

from common import Run, finish, judge, order, table

START, END, STEPS = 60, 100, (10, 5, 2.5, 1.25)
COMMON = ("-quiet", "-grid_cells", "26,1", "-output_times", "0 s", "-stepper_adapt", "no", "-stepper_dt", "20 s",
          "-mat_sediment_permeability_k0", "1.53e-13 m^2",
          "-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9")  # fmt: skip
BARS = {"euler": (0.9, 1.2), "sdirk2": (1.8, 2.2)}
QUANTITIES = {"p": ("p06", "p_Pa"), "u": ("surface", "u_x_m")}


def scene(kinetics):
    p0 = 3.62 if kinetics else 3.25
    return (*COMMON, "-mat_sediment_kinetics_active", "yes" if kinetics else "no",
            "-region_column_pressure", f"{p0} MPa",
            "-bc_load_normal_table", f"0 s,{p0} MPa,1000 s,{p0 + 0.5} MPa")  # fmt: skip


def steps_of(dt, end):
    return ("-output_probe_every", f"{dt} s", "-time_end", f"{end} s")


def study(kinetics):
    name = "kinetics on" if kinetics else "kinetics off"
    start = Run.of_case("bp2", *scene(kinetics), *steps_of(2, START)).out / "checkpoint.h5"
    for scheme, bar in BARS.items():
        runs = [Run.of_case("bp2", *scene(kinetics), *steps_of(dt, END), "-stepper_type", scheme, "-restart", start)
                for dt in STEPS]  # fmt: skip
        taken = [np.ptp(run.balance["dt_s"]) < 1e-9 * dt and abs(run.balance["dt_s"][0] - dt) < 1e-9 * dt
                 for run, dt in zip(runs, STEPS)]  # fmt: skip
        if not all(taken):
            raise SystemExit("a run did not take the steps asked for")
        for quantity, (probe, column) in QUANTITIES.items():
            values = [run.probe(probe)[column][-1] for run in runs]
            differences = np.abs(np.diff(values))
            orders = order(STEPS[:-1], differences)
            print(f"\n{scheme}, {name}: {quantity} ({probe}, {column}) at {END} s")
            table(["dt (s)", "value", "difference to dt/2", "order"],
                  [[dt, f"{v:.12g}", d, o] for dt, v, d, o in
                   zip(STEPS, values, [*differences, "-"], [*(f"{o:.3f}" for o in orders), "-", "-"])])  # fmt: skip
            for k, o in enumerate(orders):
                judge(3, f"{scheme}, {name}: order in {quantity}, dt {STEPS[k]:g} to {STEPS[k + 2]:g} s", o, bar)


study(False)
study(True)
finish()
