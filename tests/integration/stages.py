#!/usr/bin/python3
"""Stages: what one hands to the next, what each may change, restarts at and around a change.

Two scenes.  cases/stages.yaml: an elastic column settles within a century (quasi-static, implicit), then a blow sends waves
down it within a tenth of a second (hybrid).  cases/block.yaml, a reacting block of two materials that is squeezed, in three
stages sdirk2 -> hybrid -> sdirk2, the last without reaction.
"""
import re
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import _files  # noqa: E402
from _files import TABLES  # noqa: E402
from common import Run, binary, check, check_true, finish, launch, scratch  # noqa: E402

CASES = Path(__file__).resolve().parent / "cases"
COLUMN, BLOCK = CASES / "stages.yaml", CASES / "block.yaml"
CENTURY, H, RHO_G, E0, NU = 3155760000.0, 4.0, 1500 * 9.81, 200e6, 0.2
MODULUS = E0 * (1 - NU) / ((1 + NU) * (1 - 2 * NU))


def column(*options, **keywords):
    return Run.of_case(COLUMN, "-quiet", *options, **keywords)


def different(a, b, tables=TABLES):
    return _files.different(a.out, b.out, tables)


# ------------------------------------------------------------------------------------------- gravity, then the event
run = column()
t, u, y = run.time, run.probe("top")["u_y_m"], run.probe("top")["y_m"]
settled = int(np.argmin(np.abs(t - CENTURY)))
static = RHO_G * H**2 / (2 * MODULUS)
check("settles by rho g H^2/(2 M)", abs(u[settled] / -static - 1), 1e-3)
check_true("a step ends on the end of the stage", t[settled] == CENTURY, t[settled] - CENTURY)
check_true("rows every 5 ms after a century", np.allclose(t[settled + 1 :] - CENTURY, 0.005 * np.arange(1, 21), atol=1e-6) and len(t) == settled + 21, len(t))
check_true("the displacement counts from the blow, the position goes on",
           np.allclose(y[settled + 1 :] - y[settled], u[settled + 1 :], atol=1e-12) and abs(u[settled]) > 1e-4)  # fmt: skip
alone = column("-stage_settle_end", "1 s", "-stage_strike_end", "1.1 s", "-gravity", "0 m/s^2,0 m/s^2")
moves = alone.probe("top")["u_y_m"][-20:]
check("the blow moves it as if there were no weight", np.max(np.abs(u[settled + 1 :] - moves)) / np.max(np.abs(moves)), 2e-3)
damped = column("-stage_settle_end", "1 s", "-stage_strike_end", "1.1 s", "-stage_settle_inertia", "yes", "-stage_settle_stepper_type", "hybrid",
                "-stage_settle_stepper_damping", "0.3", "-stage_settle_output_probe_every", "1 s").probe("top")["u_y_m"]  # fmt: skip
check("damped, hybrid settles to the same", abs(damped[1] / -static - 1), 1e-3)
check("... and undamped it swings as before", np.max(np.abs(damped[-20:] - moves)) / np.max(np.abs(moves)), 1e-2)
quiet = column("-stage_strike_boundaries_off", "blow").probe("top")["u_y_m"]
check("without the blow it stays where it settled", np.max(np.abs(quiet[settled + 1 :])) / static, 1e-3)
stage = run.balance["stage"]
check_true("balance.csv says the stage", set(stage) == {1, 2} and np.all(np.diff(stage) >= 0))
said = (run.out / "summary.txt").read_text()
check_true("a line for each stage in summary.txt", all(re.search(rf"stage {n}: {k} .* \d+ steps, \d+ refused", said) for n, k in (("settle", "sdirk2"), ("strike", "hybrid"))))
loud = Run.of_case(COLUMN, "-progress", "0")
check_true("the progress says the stage", "stage settle: step    1:" in loud.output and re.search(r"stage strike: step +\d+: t = 100 years \+ 0\.(1|0999999\d*|1000000\d*) s ", loud.output))
check_true("a forecast for each stage before the first step", loud.output.index("stage strike: forecast") < loud.output.index("step    1:"))

# ---------------------------------------------------------------------------- conditions and materials that change
SLOW = ("-stage_strike_inertia", "no", "-stage_strike_stepper_type", "sdirk2", "-stage_strike_end", "3155760010 s",
        "-stage_strike_output_probe_every", "10 s", "-bc_blow_normal_ramp", "0 Pa,20 kPa,0 s,1 s", "-stage_strike_reset_displacement", "yes")  # fmt: skip
lateral = ("-mat_soil_solid_density", "250 kg/m^3", "-mat_soft_solid_density", "250 kg/m^3", "-probes", "top,middle,side", "-probe_side_at", "0.2 m,2 m")
kept = column(*SLOW, *lateral)
freed = column(*SLOW, *lateral, "-stage_strike_boundaries_off", "right")
never = column(*SLOW, *lateral, "-stage_settle_boundaries_off", "right,blow", "-stage_strike_boundaries_off", "right", "-stage_strike_reset_displacement", "no")
check_true("a wall that stays holds", np.max(np.abs(kept.probe("side")["u_x_m"])) < 1e-12)
check("a wall taken away lets go of its stress", abs(freed.probe("side")["u_x_m"][-1] / never.probe("side")["u_x_m"][-1] - 1), 0.01)
check_true("it was there before", np.max(np.abs(freed.probe("side")["u_x_m"][freed.time <= CENTURY])) < 1e-12)
held = column("-stage_strike_inertia", "no", "-stage_strike_stepper_type", "sdirk2").probe("top")["u_y_m"][settled + 1 : settled + 21]
static_blow = -20e3 * H / MODULUS * np.minimum(0.005 * np.arange(1, 21) / 0.02, 1)
check("without inertia it follows the blow at once, from the begin of the stage on", np.max(np.abs(held / static_blow - 1)), 1e-3)
let_go, fallen = (column("-stage_strike_" + o, v) for o, v in (("boundaries", "none"), ("boundaries_off", "base,left,right,wall,blow")))
check_true("no boundaries at all, said in two ways: it falls", not different(let_go, fallen) and let_go.probe("top")["u_y_m"][-1] < -0.02)
rest = column("-region_column_stress_geostatic", f"{NU / (1 - NU)}", "-bc_blow_normal_ramp", "20 kPa,21 kPa,0 s,1 s")
check("a geostatic start is in balance with what acts in the first stage", np.max(np.abs(rest.probe("top")["u_y_m"][rest.time <= CENTURY])) / static, 1e-6)
soft, firm = (column(*SLOW, *o).probe("top") for o in (("-stage_strike_materials", "column,soft"), ()))
check("half the stiffness from the second stage on: twice the motion", abs(soft["u_y_m"][-1] / firm["u_y_m"][-1] - 2), 1e-3)
still = column(*SLOW, "-stage_strike_materials", "column,soft", "-stage_strike_boundaries_off", "blow").probe("top")
check("a change of material alone moves nothing, its stress stays", np.max(np.abs(still["u_y_m"][-1])) / static, 1e-6)
more = column(*SLOW, "-stage_strike_boundaries_off", "blow", "-stage_strike_gravity", "0 m/s^2,-19.62 m/s^2", "-stage_strike_gravity_ramp", "5 s",
              "-stage_strike_output_probe_every", "2.5 s").probe("top")["u_y_m"]  # fmt: skip
check("gravity goes from that of the stage before ...", abs(more[-4] / -static - 0.5), 2e-3)
check("... to twice that: it sinks as much again", abs(more[-1] / -static - 1), 2e-3)
chosen = Run.of_case(COLUMN, "-stage_strike_stepper_type", "auto")
names = [n for n in different(run, chosen) if not re.search("state/(kind|votes|patience|since|spent)$", n)]
check_true("a stage may choose its integrator", re.search(r"strike: forecast: .*\n  integrator chosen: hybrid, for now", chosen.output) and not names, ", ".join(names))

# --------------------------------------------------- stages that name nothing are no stages: all is handed on, bit for bit
for kind, end, step in (("sdirk2", 60, 10), ("hybrid", 0.03, 4e-5)):
    options = ("-quiet", "-stepper_type", kind, "-time_end", f"{end} s", "-output_times", "0 s", "-output_probe_every", f"{end / 3} s")
    fixed = ("-stepper_adapt", "no", "-stepper_dt", f"{step} s")
    stages = [x for k in range(3) for x in (f"-stage_s{k}_end", f"{(k + 1) * end / 3!r} s")]
    for what, n, more in (("one stage", 1, ()), ("three stages", 3, fixed)):
        none = Run.of_case(BLOCK, *options, *more)
        some = Run.of_case(BLOCK, *options, *more, "-stages", ",".join(f"s{k}" for k in range(3 - n, 3)), *stages[-2 * n :])
        names = [c for c in none.probes if c != "time_s" and not np.array_equal(none.probes[c], some.probes[c])]
        names += [c for c in none.balance if c != "time_s" and not np.array_equal(none.balance[c], some.balance[c])]
        anew = "state/(stage|fresh|err_old|hold|t|next_snapshot|acts)$|fields" if n > 1 else "^$"
        names += [c for c in different(none, some, ()) if not re.search(anew, c) and c != "checkpoint.h5:case"]  # that says which stages
        check_true(f"{kind}: {what} naming nothing: the case without", not names, ", ".join(names[:5]))

# ----------------------------------------------------------------------------------------- sdirk2 -> hybrid -> sdirk2
TIGHT = ("-newton_tol_residual", "1e-10", "-newton_tol_update", "1e-9", "-ksp_rtol", "1e-9")
THREE = ("-quiet", "-mat_soft_permeability_k0", "1e-10 m^2", "-mat_firm_permeability_k0", "1e-10 m^2",
         "-mat_soft_kinetics_K0", "2.5e-8 mol/(m^2 Pa s)", "-mat_firm_kinetics_K0", "2.5e-8 mol/(m^2 Pa s)",
         "-bc_load_normal_ramp", "3.4 MPa,4.6 MPa,0 s,0.06 s", "-time_end", "0.09 s", "-output_times", "0 s,0.03 s,0.06 s,0.09 s",
         "-output_probe_every", "0.01 s", "-stepper_adapt", "no", "-stepper_dt", "2 ms", "-checkpoint_every", "0.01 s",
         "-meters", "part", "-meter_part_side", "top", "-meter_part_from", "0 m", "-meter_part_to", "0.322 m",
         "-stages", "press,wave,rest", "-stage_press_end", "0.03 s", "-stage_wave_end", "0.06 s", "-stage_rest_end", "0.09 s",
         "-stage_wave_stepper_type", "hybrid", "-stage_wave_stepper_dt", "40 us", "-stage_rest_kinetics_active", "no",
         "-stage_rest_materials", "left,firm", *TIGHT)  # fmt: skip
RESET = ("-stage_rest_reset_displacement", "yes")
KRYLOV = ("-options_file", str(CASES.parents[2] / "options" / "krylov.opts"))


def block(*options, **keywords):
    return Run.of_case(BLOCK, *THREE, *options, **keywords)


run = block(*RESET)
ledger, meter = run.balance, run.csv("meters.csv")
check("water and methane through both changes", max(np.max(np.abs(ledger[f"{w}_error"])) for w in ("water", "methane")), 1e-12)
check("heat through both changes (K)", np.max(np.abs(ledger["heat_error"])), 1e-3)
hydrate = {k: ledger["hydrate_kg"][ledger["stage"] == k] for k in (1, 2, 3)}
check_true("hydrate forms in two stages and rests in the third", hydrate[1][-1] > 1e-6 and hydrate[2][-1] > 1.2 * hydrate[1][-1]
           and np.ptp(hydrate[3]) <= 1e-15 * hydrate[3][0], [h[-1] for h in hydrate.values()])  # fmt: skip
check_true("each stage has its own step", all(np.allclose(ledger["dt_s"][ledger["stage"] == k], dt) for k, dt in ((1, 2e-3), (2, 4e-5), (3, 2e-3))))
gone = np.diff(meter["part.water_kg"])[3:6] / 0.01
check("a meter's rate in the hybrid stage is the mean since the row before", np.max(np.abs(meter["part.water_kg_s"][4:7] / gone - 1)), 1e-9)
u = run.probe("top")["u_y_m"]
check_true("the block is squeezed before its displacement is reset", u[6] < -0.02 and abs(u[7]) < 0.5 * abs(u[6]), str(u[[6, 7]]))

plain = block()
counts = [c for c in run.probes if not re.search(r"\.u_[xy]_m$", c)]
check_true("resetting displacements changes nothing else: probes", all(np.array_equal(run.probes[c], plain.probes[c]) for c in counts))
check_true("... nor what a meter on a part of a side counts", all(np.array_equal(meter[c], plain.csv("meters.csv")[c]) for c in meter) and meter["part.water_kg"][-1] > 1)
names = {n.split("/")[-1] for n in different(run, plain, ()) if n.startswith("checkpoint") and n != "checkpoint.h5:case"}  # whose stages differ
check_true("... nor any other variable of a particle", names <= {"displacement", "log_J", "scale_u", "err_old"}, names)  # errors are relative to scale_u
(_, last), (_, first) = run.snapshots()[-1], run.snapshots()[0]
check_true("where particles were seeded stays known", np.array_equal(last["initial_position"], first["position"]))

again = Run.of_case(run.out / "case.yaml", "-quiet", *TIGHT)
names = different(run, again)
check_true("the resolved case runs to the same", not names, ", ".join(names[:5]))

other = block(*RESET, ranks=2)
worst = max(np.max(np.abs(run.probes[c] - other.probes[c])) / (np.max(np.abs(run.probes[c])) or 1.0) for c in run.probes if not c.endswith("u_x_m"))
check("2 ranks against 1", worst, 1e-8)

# ------------------------------------------------------------------------------------------------------------ restarts
# Rows of the balance until a cut: a row is a step of the implicit stages, up to 256 of hybrid.
CUTS = {"within the first stage": 7, "at the first change": 15, "within the second": 16, "at the second change": 18, "within the third": 22}
for ranks in (1, 2):
    extra = (*RESET, *(KRYLOV if ranks == 2 else ()))
    straight = block(*extra, ranks=ranks) if ranks == 2 else run
    for what, rows in CUTS.items() if ranks == 1 else [("at the second change", 18)]:
        out = scratch() / "out"
        block(*extra, "-stepper_max_steps", straight.steps(rows - 1), ranks=ranks, out=out)
        rest = block(*extra, "-restart", out / "checkpoint.h5", ranks=ranks, out=out)
        with h5py.File(out / "checkpoint.h5.old", "r") as file:
            t = file["state/t"][()].ravel()[0]
        names = different(straight, rest)
        check_true(f"cut {what}, {ranks} rank(s): the same bit for bit", not names, ", ".join(names[:5]))

out = scratch() / "new"
saved = run.out / "checkpoint.h5"
for what, options in (("another end of a stage", ("-stage_wave_end", "0.05 s")), ("another reset", ("-stage_press_reset_displacement", "yes")),
                      ("other conditions", ("-stage_wave_boundaries_off", "drain")), ("a stage more", ("-stages", "press,wave,rest,late", "-stage_late_end", "0.1 s", "-time_end", "0.1 s"))):  # fmt: skip
    said = launch(binary(), BLOCK, *THREE, *RESET, *options, "-restart", saved, out=out)
    check_true(f"a checkpoint of {what} is refused", said.returncode == 2 and "another case" in said.stdout and not out.exists(), said.stdout[-200:])

# ------------------------------------------------------------------------------------- refused before anything is done
said = launch(binary(), BLOCK, *THREE, "-stage_wave_stepper_dt", "10 ms", out=out)
check_true("a fixed step above the stable one in a later stage is refused at once",
           said.returncode == 2 and "stage wave: stepper_dt" in said.stdout and not out.exists(), said.stdout[-300:])  # fmt: skip
finish()
