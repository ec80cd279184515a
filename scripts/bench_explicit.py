"""Benchmark of hybrid: particle-steps a second on one core, where the time goes, and memory traffic against a stream copy.

Used by bench.py.  Blocks of square cells with 2 x 2 particles, uGIMP; all numbers of a row come from one run.
"""
import re
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
PARTS = {"ClExDeposit": "particles to nodes", "ClExVelocities": "velocities", "ClExRates": "rates", "ClExScalars": "p and T", "ClExUpdate": "update",
         "ClExOrder": "order"}
COMMON = """
grid: {{lower: [0 m, 0 m], upper: [{top} m, 1 m], cells: [{nx}, {n}]}}
basis: ugimp
materials: [soil]
mat:
  soil:
    porosity: 0.15
    solid: {{density: 2600 kg/m^3, heat_capacity: 800 J/(kg K), conductivity: 3 W/(m K)}}
    permeability: {{k0: 1e-12 m^2, mh: 3}}
    elasticity: {{E0: 90 MPa, Eh: 2 GPa, ah: 1, bh: 1, nu: 0.3, stiffness_change: both}}
{laws}
regions: {regions}
boundaries: [base, low, high, load{drains}]
bc:
  base: {{type: fixed, axis: x, position: 0 m}}
  low: {{type: roller, axis: y, position: 0 m}}
  high: {{type: roller, axis: y, position: 1 m}}
  load: {{type: traction, side: right, normal: {{ramp: [{p} MPa, {q} MPa, 0 s, {rise} s]}}}}
{drain}
time: {{end: 10 s}}
stepper: {{type: hybrid}}
output: {{probe_every: 10 s}}
"""
GAS = """
    gas: {eos: ideal}
    retention: {law: van_genuchten, p0: 50 kPa, m: 0.3, Swr: 0.2, Sgr: 0.4}
    relperm: {nw: 4, ng: 2}
    kinetics: {active: yes, K0: 2.5e-7 mol/(m^2 Pa s), dE: 0 J/mol, A_geo: 1e6 1/m, equilibrium: sloan, A1: 1 kPa, A2: 38.98, A3: 8533.8 K}
    latent_heat: {C0: 473632 J/kg, C1: 140.117 J/(kg K)}
"""
# The tenth beside the load starts on the yield surface, and the load, which rises, keeps it there.
PLASTIC = GAS + """
    plasticity: {law: mohr_coulomb, flow: menetrey_willam, cohesion_max: 10 kPa, cohesion_residual: 5 kPa, friction_peak: 15 deg, dilation_max: 5 deg, eta_s: 5}
"""
DRAIN = "  drain: {type: pressure, side: right, initial: yes}"
WET = ", pressure: 3.25 MPa, temperature: 4 degC, Sw: 0.6, Sg: 0.4, Sh: 0"
# name, fields, laws, state, drained, numbers a step must at least read and write per particle
SETS = [
    ("dry (m)", "[solid]", "", "", False),
    ("saturated (hm)", "[solid, water]", "", ", pressure: 3.25 MPa", True),
    ("six fields (thmc)", "thmc", GAS, WET, True),
    ("six fields, plastic", "thmc", PLASTIC, WET, True),
]


# cells across, bursts: in the cache of a core, in that of the processor, in memory
SIZES = ((32, 20), (71, 4), (224, 1))


def stream_copy():
    """Bytes a second, read and written, of a copy far larger than the caches: the best of five."""
    a = np.ones(25_000_000)
    b = np.empty_like(a)
    best = np.inf
    for _ in range(5):
        start = time.perf_counter()
        np.copyto(b, a)
        best = min(best, time.perf_counter() - start)
    return 2 * a.nbytes / best


def traffic(fields):
    """Bytes per particle and step if each pass read and wrote every array it uses just once (src/explicit)."""
    fluids = {"[solid]": 0, "[solid, water]": 1}.get(fields, 2)
    heat = fields == "thmc"
    deposit = 2 + 2 + 3 + 6 + fluids * (1 + 1 + 2 + 2 + 2) + 3 * heat + (2 if fluids == 2 else 0)
    rates = (2 + 2 + 3 + 1 + 4 + fluids * (1 + 2 + 4 + 2 + 4) + heat + (2 + 3 if fluids == 2 else 0)) if fluids or heat else 0
    update = 4 + 4 + 4 + 2 + 16 + 3 + fluids * (2 + 2 + 2 + 4) + 4 * heat + (5 if fluids == 2 else 0) + (0 if fluids else 4)
    return 8.0 * (deposit + rates + update)


def case_text(kind, n):
    name, fields, laws, state, drained = kind
    plastic = laws is PLASTIC
    p = (3.25 if drained else 0.0) + (1 if plastic else 0)
    box = lambda left, right, stress: f"{{lower: [{left} m, 0 m], upper: [{right} m, 1 m], material: soil, particles_per_cell: [2, 2]{state}{stress}}}"
    stress = lambda across: f", stress: [-1 MPa, {across} MPa, {across} MPa, 0 Pa, 0 Pa, 0 Pa]"
    part = round(0.9 * n) / n
    body = COMMON.format(top=1 + 4 / n, nx=n + 4, n=n, laws=laws, drains=", drain" if drained else "", drain=DRAIN if drained else "", p=p, q=p + 1, rise=0.01 if plastic else 1,
                         regions=f"[far, near]\nregion: {{far: {box(0, part, stress(-1))}, near: {box(part, 1, stress(-0.5735))}}}" if plastic else f"[block]\nregion: {{block: {box(0, 1, '')}}}")  # fmt: skip
    return f"title: {name}\nfields: {fields}\n{body}"


def run(binary, kind, n, bursts):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "case.yaml"
        path.write_text(case_text(kind, n))
        text = subprocess.run([binary, str(path), "-output_dir", folder + "/out", "-quiet", "-log_view", "-stepper_max_steps", str(bursts)],
                              stdout=subprocess.PIPE, text=True, check=True).stdout  # fmt: skip
    events = {m.group(1): float(m.group(2)) for m in re.finditer(r"^(ClEx\w+)\s+\d+\s+[\d.]+\s+([\d.e+-]+)\s", text, re.M)}
    steps = int(re.search(r"integrator hybrid, (\d+) steps", text).group(1))
    memory = float(re.search(r"([\d.]+) B a particle", text).group(1))
    yields = re.search(r"(\d+) of (\d+) particles yield", text)
    return steps, events, memory, int(yields.group(1)) / int(yields.group(2)) if yields else 0.0


def table(binary):
    """Rows of the table, with a stream copy of the same run; and of each scene the share of the time in memory that goes when it fits the cache."""
    copy = stream_copy()
    rows, waits = [], []
    for kind in SETS:
        rates = []
        for n, bursts in SIZES:
            steps, events, memory, yields = run(binary, kind, n, bursts)
            particles, seconds = 4 * n * n, sum(events.values())
            rate = particles * steps / seconds
            rates.append(rate)
            shares = [f"{100 * events.get(e, 0.0) / seconds:.0f} %" for e in PARTS]
            rows.append([kind[0] + (f", {100 * yields:.0f} % yield" if yields else ""), particles, f"{rate / 1e6:.2f}", *shares, f"{memory:.0f}", f"{100 * rate * traffic(kind[1]) / copy:.0f} %"])
            print(rows[-1], flush=True)
        waits.append(1 - rates[-1] / max(rates))
    head = ["scene", "particles", "million particle-steps a second", *PARTS.values(), "B a particle", "traffic of a stream copy"]
    return head, rows, copy, waits
