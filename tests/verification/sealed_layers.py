#!/usr/bin/env python3
"""A stiff layer in a sealed body keeps its own pressure, against Skempton's share.

What a layer of a sealed body keeps of its own pressure: a stiff layer in soft ground, loaded without drainage, against Skempton's share of the load in each; cells of a layer's width, a half and a quarter.

In the continuum no water moves and p = load K/(K + M) with K = K_w/phi in each layer.  Nodes share p, so a layer as wide as a cell cannot have all of it.  Hybrid's storage is lumped and then corrected (413);
implicit steps have consistent storage with (23): each by a solution of its own.  Then a slope that is heated at its base, with gas, hydrate and heat: the balances close and methane stays where it was; two ranks.
"""
import numpy as np

from common import Run, finish, judge, largest_difference, scratch, table

ROW = "sealed layers"
PHI, BULK, LOAD, E_SOFT, E_STIFF, NU = 0.4, 2.2e9, 1e6, 0.25e9, 25e9, 0.25
CORRECTS = 1.5  # of (413), where there is room
LOW, HIGH, LENGTH, WIDTH = 4.5, 5.0, 10.0, 0.5  # m: the layer, the column; its width, a cell wide
CASE = f"""title: a stiff layer in soft ground, sealed
fields: hm
grid: {{lower: [0 m, 0 m], upper: [{LENGTH} m, WIDTH m], cells: [20, 1]}}
materials: [soft, stiff]
mat:
  soft: {{porosity: {PHI}, solid: {{density: 2650 kg/m^3}}, water: {{bulk_modulus: {BULK} Pa}}, permeability: {{k0: 1e-24 m^2}}, elasticity: {{E0: {E_SOFT} Pa, nu: {NU}}}}}
  stiff: {{porosity: {PHI}, solid: {{density: 2650 kg/m^3}}, water: {{bulk_modulus: {BULK} Pa}}, permeability: {{k0: 1e-24 m^2}}, elasticity: {{E0: {E_STIFF} Pa, nu: {NU}}}}}
regions: [near, layer, far]
region:
  near: {{lower: [0 m, 0 m], upper: [{LOW} m, WIDTH m], material: soft, pressure: 1 MPa, temperature: 10 degC}}
  layer: {{lower: [{LOW} m, 0 m], upper: [{HIGH} m, WIDTH m], material: stiff, pressure: 1 MPa, temperature: 10 degC}}
  far: {{lower: [{HIGH} m, 0 m], upper: [{LENGTH} m, WIDTH m], material: soft, pressure: 1 MPa, temperature: 10 degC}}
boundaries: [base, lower, upper, load]
bc:
  base: {{type: roller, axis: x, position: 0 m}}
  lower: {{type: roller, axis: y, position: 0 m}}
  upper: {{type: roller, axis: y, position: WIDTH m}}
  load: {{type: traction, side: right, normal: {{table: [PUSH]}}}}
time: {{end: 0.24 s}}
stepper: {{type: hybrid, damping: 0.2}}
output: {{times: [0.24 s]}}
"""
# without kinks, which would send waves through the column
PUSH = ", ".join(f"{0.2 * x:.4g} s, {1 + 0.5 * (1 - np.cos(np.pi * x)):.6g} MPa" for x in np.linspace(0, 1, 21))
M = lambda E: E * (1 - NU) / ((1 + NU) * (1 - 2 * NU))
K = BULK / PHI
soft, stiff = (LOAD * K / (K + M(E)) for E in (E_SOFT, E_STIFF))


def column(name, cells, *options):
    """What the layer's p lacks of its exact difference from the ground's, in parts of that."""
    case = scratch() / "layers.yaml"
    case.write_text(CASE.replace("WIDTH", str(WIDTH / cells)).replace("PUSH", PUSH))
    run = Run.of_case(case, "-quiet", "-grid_cells", f"{20 * cells},1", *options)
    (_, start), (_, end) = run.snapshots()[0], run.snapshots()[-1]
    layer = (start["position"][:, 0] > LOW) & (start["position"][:, 0] < HIGH)
    p = np.mean(end["p_w"][layer]) - 1e6
    far = np.abs(start["position"][:, 0] - 8) < 1
    judge(ROW, f"{name}, {cells} cells in the layer: p far from it, relative", abs(np.mean(end["p_w"][far] - 1e6) / soft - 1), 2e-3)
    judge(ROW, f"{name}, {cells} cells in the layer: water balance", abs(run.balance["water_error"][-1]), 1e-12)
    return (p - stiff) / (soft - stiff)


def matrices(cells, corrects=0.0, projects=False):
    """What the layer's p lacks where the column's nodes are solved at once, two particles a cell: with consistent storage, with lumped storage
    and so much of (413), with (23)."""
    h, n = WIDTH / cells, 20 * cells
    x, V = h * (np.arange(2 * n) / 2 + 0.25), h / 2
    E = np.where((x > LOW) & (x < HIGH), E_STIFF, E_SOFT)
    S, G = np.zeros((2 * n, n + 1)), np.zeros((2 * n, n + 1))
    for p in range(2 * n):
        S[p, p // 2 : p // 2 + 2] = 1 - x[p] / h % 1, x[p] / h % 1
        G[p, p // 2 : p // 2 + 2] = -1 / h, 1 / h
    storage = V / K * S.T @ S
    if corrects:
        lumped = np.diag(storage.sum(axis=0))
        gives = np.linalg.inv(lumped)
        storage = np.linalg.inv(gives + corrects * gives @ (lumped - storage) @ gives)
    for c in range(n if projects else 0):
        D = S[2 * c : 2 * c + 2] - np.mean(S[2 * c : 2 * c + 2], axis=0)
        storage += V * D.T @ D * (1 + NU) / E[2 * c]
    A = np.block([[V * G.T @ (M(E)[:, None] * G), -V * G.T @ S], [V * S.T @ G, storage]])
    load = np.where(np.arange(2 * n + 2) == n, -LOAD, 0.0)
    p = S @ np.linalg.solve(A[1:, 1:], load[1:])[n:]  # the first node is held
    return (np.mean(p[(x > LOW) & (x < HIGH)]) - stiff) / (soft - stiff)


IMPLICIT = ("-stepper_type", "sdirk2", "-stepper_dt", "0.004s", "-stepper_adapt", "no")
lost = {name: [column(name, n, *options) for n in (1, 2, 4)] for name, options in {"hybrid": (), "sdirk2": IMPLICIT}.items()}
lost |= {"consistent storage": [matrices(n) for n in (1, 2, 4)]}
table(("difference of the layer that is lost", "1 cell in the layer", "2", "4"), list((k, *v) for k, v in lost.items()))
for k, cells in enumerate((1, 2, 4)):
    judge(ROW, f"{cells} cells in the layer, hybrid: what is lost, against storage with (413)", abs(lost["hybrid"][k] - matrices(cells, CORRECTS)), 2e-3)
    judge(ROW, f"{cells} cells in the layer, sdirk2: what is lost, against consistent storage with (23)", abs(lost["sdirk2"][k] - matrices(cells, projects=True)), 1e-2)
    judge(ROW, f"{cells} cells in the layer, hybrid: lost beyond what consistent storage loses", lost["hybrid"][k] - lost["consistent storage"][k], 0.07)

# ---------------------------------------------------------------- gas, hydrate and heat: a slope that is heated at its base
SHARE = 0.016 / 0.124  # of methane in hydrate


def slope(loaded=10.0, end=11.5, ranks=1):
    """(run, methane that is in other particles than at the start of the heating over what came of hydrate)"""
    run = Run.of_case("slope_a", "-quiet", "-grid_cells", "30,6", "-gravity_ramp", f"{loaded} s", "-stage_load_end", f"{loaded} s", "-stage_slide_end", f"{end} s", "-output_every", "0.5s", ranks=ranks)
    how = f", loaded in {loaded:g} s" if loaded < 10 else ""
    loaded, end = run.snapshot(loaded), run.snapshots()[-1][1]
    methane, hydrate = ({at: s["mass_gas"][:, 0] * gas + s["mass_hydrate"][:, 0] * SHARE for at, s in (("loaded", loaded), ("end", end))} for gas in (1, 0))
    for what in ("water", "methane", "heat"):
        judge(ROW, f"heated slope{how}, {ranks} ranks: {what} balance", np.max(np.abs(run.balance[f"{what}_error"])), 1e-11)
    return run, np.abs(methane["end"] - methane["loaded"]).sum() / 2 / np.maximum(0, hydrate["loaded"] - hydrate["end"]).sum()


judge(ROW, "heated slope: methane in other particles over what hydrate has given", slope()[1], 0.12)  # 0.24 with lumped storage
(one, _), (two, _) = (slope(loaded=2.0, end=3.0, ranks=n) for n in (1, 2))
judge(ROW, "heated slope: 2 ranks against 1, largest difference of any field", max(largest_difference(two.snapshots()[-1][1][k], one.snapshots()[-1][1][k]) for k in ("p_w", "p_g", "T", "S_h", "position", "stress")), 1e-8)
finish()
