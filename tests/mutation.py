#!/usr/bin/python3
"""Do the tests see wrong physics?  Plants one fault after the other in a copy of the tree, builds it, runs the quick tests
until one fails: mutation.py [--record FILE] [--page FILE] [--only NAME ...] [--fresh] [--work FOLDER] [--sound] [--texts]

Each fault is a line of the physics that says something else, with its derivative where
it has one, so that a Newton method or a tangent test need not notice: what must notice is a test of the physics.  A
fault that no test sees makes the exit code 1.  --record keeps what was found, a line each, and goes on from there; --page
makes docs/studies/mutation.md of it.  Some seconds each on a quiet core.
"""
import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests" / "verification"))
from common import environment  # noqa: E402
import dated  # noqa: E402, of scripts/, which common puts on the path

RECORD = dated.STUDIES / "mutation.jsonl"

# The quick tests, in the order in which they are asked: seconds in all.
UNIT = ("laws_values", "laws", "laws_batch", "point", "faces", "skeleton", "bonds", "model", "slivers", "pressure_modes", "thin_gas", "one_physics", "explicit", "axisymmetry", "plasticity", "plastic_scene", "transfer",
        "fieldsets", "turning", "upwind")  # fmt: skip
FIRST = {"laws": "laws_values", "grid": "upwind", "clathra": "laws_values", "point": "point", "boundary": "faces", "model": "model", "explicit": "one_physics"}  # the folder's own
RUNS = ("closed_cell", "layers", "undrained", "thermal", "phases", "boundaries", "geostatic", "terzaghi", "surfaces", "sea", "plates", "sudden_gravity",
        "strip_load", "orientation", "ladder_heat_advection", "ladder_gravity_column", "ladder_mcwhorter_sunada", "wells", "energy", "rest", "total", "century_tolerance", "thin_cells", "heat_source", "sealed_layers", "bp2_reference")  # fmt: skip
SPACE = ("total",)  # of these with scenes in space

# (name, file, [(what stands there, what is planted), ...])
LAWS, POINT, MODEL, BOUNDARY, EXPLICIT, HEADER = "src/laws/", "src/point/", "src/model/", "src/boundary/", "src/explicit/", "include/clathra/"
FAULTS = [
    ("half of what hybrid's particles store by themselves (413)", EXPLICIT + "stored.c", [("a[j] = e->t[T_CONSISTENT][p]", "a[j] = 0.5 * e->t[T_CONSISTENT][p]")]),
    ("water expands the wrong way", LAWS + "eos.c", [("law->K - law->beta * (T - law->T_ref)", "law->K + law->beta * (T - law->T_ref)"), ("-law->rho0 * de * law->beta", "law->rho0 * de * law->beta")]),
    ("ideal gas: kelvin less 0.15", LAWS + "eos.c", [("const double TK = T[q] + LAW_ZERO_CELSIUS;\n\n    rho_p[q] = law->M", "const double TK = T[q] + 273.0;\n\n    rho_p[q] = law->M")]),
    ("hydrate stiffens 2 % less", LAWS + "elasticity.c", [("law->ah * law->Eh", "0.98 * law->ah * law->Eh")]),
    ("k_r of gas leaves out the water's residual", LAWS + "relperm.c", [("Corey(sg, law->Sgr, 1.0 - law->Swr - law->Sgr", "Corey(sg, law->Sgr, 1.0 - law->Sgr")]),
    ("hydrate clogs with mh + 0.1", LAWS + "permeability.c", [("LawToePower(1.0 - Sh, law->mh", "LawToePower(1.0 - Sh, law->mh + 0.1")]),
    ("formation on (1 - S_h)^2", LAWS + "kinetics.c", [("open = law->A_geo * v * v, sg", "open = law->A_geo * v, sg"), ("-3.0 * open", "-2.0 * open")]),
    ("hydrate grows on gas alone (418)", HEADER + "point_reaction.h", [("if (!(mat->gas.trace > 0.0))\n    return (Wetted)", "if (!(mat->gas.trace > 1e9))\n    return (Wetted)")]),
    ("latent heat takes degC for kelvin", LAWS + "thermal.c", [("(at + LAW_ZERO_CELSIUS)", "at")]),
    ("hydrate conducts like water", LAWS + "thermal.c", [("Sh * X[1] +", "Sh * X[2] +"), ("(X[1] - fluid)", "(X[2] - fluid)")]),
    ("Masuda's equilibrium 2 % low", LAWS + "equilibrium.c", [("return 1.15 * e", "return 1.127 * e"), ("1.15 * de", "1.127 * de")]),
    ("mean pressure p_w + s_w p_c", HEADER + "point_state.h", [("pw + sg * (pg - pw), pg - pw, 1.0 - sg, sg}", "pw + (1.0 - sg) * (pg - pw), pw - pg, sg, 1.0 - sg}")]),
    ("hydrate stores no heat", HEADER + "point_heat.h", [(" + m_h * mat->c_h", " + 0.0 * m_h * mat->c_h")]),
    ("hydrate does not hinder flow", POINT + "state.h", [("s->phi.v, s->Sh.v, &dphi, &dSh);\n  const Jet    ka = JetChain2(k, dphi, s->phi, dSh, s->Sh)", "s->phi.v, 0.0, &dphi, &dSh);\n  const Jet    ka = JetChain2(k, dphi, s->phi, 0.0, s->Sh)")]),
    ("hydrate's expansivity left out", HEADER + "point_heat.h", [("+ ice * mat->hydrate.beta) * per", ") * per"), ("(mat->hydrate.beta - v) * per", "-v * per")]),
    ("half of the thermal strain again", POINT + "forces.h", [("JetScale(1.0 / 3.0, JetMul(s->beta", "JetScale(0.5, JetMul(s->beta")]),
    ("1 % more gas from hydrate", HEADER + "laws.h", [("return law->M_g / law->M_h;", "return 1.01 * law->M_g / law->M_h;")]),
    ("gas carries heat like water", HEADER + "point_heat.h", [("phase == PHASE_W ? mat->c_w : mat->c_g", "phase == PHASE_W ? mat->c_w : mat->c_w")]),
    ("no flux interpolation (20)", POINT + "fluxes.h", [("= JetMul(rho, tau);", "= JetScale(0.0, JetMul(rho, tau));")]),
    ("conduction without 1/J", POINT + "tangent.h", [("g->K[i][j] = c / k->J;", "g->K[i][j] = c;"), ("(dc - g->K[i][j] * k->dJ[q]) / k->J", "dc")]),
    ("no pore pressure around the axis", POINT + "forces.h", [("hoop = st->s[ZZ] - p;", "hoop = st->s[ZZ];"), ("AddJet(o->D[OUT_HOOP], -h->V * k->cof_hoop, &s->p, k);", ""), ("o->D[OUT_HOOP][IN_U + d] += h->V", "o->D[OUT_HOOP][IN_U + d] += 0.0")]),
    ("the sea's weight twice", POINT + "forces.h", [("o->out[OUT_A + i] = s->V.v * a.g[i]", "o->out[OUT_A + i] = 2.0 * s->V.v * a.g[i]"), ("AddJet(o->D[OUT_A + i], a.g[i], &s->V, k)", "AddJet(o->D[OUT_A + i], 2.0 * a.g[i], &s->V, k)")]),
    ("small strain, J - 1 for ln J", POINT + "kinematics_plane.c", [("lnJ = 0.5 * log(J2)", "lnJ = 0.5 * (J2 - 1.0)"), ("dlnJ = 0.5 * dJ2 / J2", "dlnJ = 0.5 * dJ2")]),
    ("cpgimp domains shear", HEADER + "point_strain.h", [("c * xx + s * yx", "xx + 0.0 * yx")]),
    ("heat at open boundaries 1 % more", BOUNDARY + "terms.c", [("  o->heat_in += flux * x->area;\n  o->out[F_T] -= flux * x->area;", "  flux *= 1.01;\n  alpha *= 1.01;\n  o->heat_in += flux * x->area;\n  o->out[F_T] -= flux * x->area;")]),
    ("convection sees the particle, not the face", BOUNDARY + "terms.c", [("  Draw(x, k, x->c->bc[k].alpha, o);", "  const double alpha = x->c->bc[k].alpha;\n\n  LetIn(x, alpha * (x->v->value[k] - x->in[IN_T]), alpha, o);\n  for (int j = 0; j < 2; j++)\n    o->D[F_T][IN_GT + j] -= alpha * x->area * x->f->r[j];")]),
    ("outflow 1 % too dense", BOUNDARY + "terms.c", [("rho    = FluidDensity(x->mat, phase, leaves ? part * FacePressure(f, sets, in) : p, in[IN_T], &dp, &dT);", "rho    = 1.01 * FluidDensity(x->mat, phase, leaves ? part * FacePressure(f, sets, in) : p, in[IN_T], &dp, &dT);"), ("inside = leaves ? part * dp : 0.0, beyond = leaves ? 0.0 : dp;", "inside = leaves ? 1.01 * part * dp : 0.0, beyond = leaves ? 0.0 : 1.01 * dp;"), ("D[IN_T] += dt * dT * Ja;", "D[IN_T] += 1.01 * dt * dT * Ja;")]),
    ("inflow brings heat above its own temperature", BOUNDARY + "terms.c", [("x->v->value[k] - x->T : 0.0", "x->v->value[k] : 0.0"), ("D[F_T][IN_T] += c_f * rate;", "D[F_T][IN_T] += 0.0 * rate;"), ("D[F_T][IN_GT + j] += c_f * rate * f->r[j];", "D[F_T][IN_GT + j] += 0.0 * rate * f->r[j];")]),
    ("natural outflow with the water's share", BOUNDARY + "terms.c", [("o->p[PHASE_W]   = mean - sg * pc;", "o->p[PHASE_W]   = mean - (1.0 - sg) * pc;"), ("-sg - ds * pc;", "-(1.0 - sg) + ds * pc;")]),
    ("shear traction turned", BOUNDARY + "terms.c", [("perp[2] = {s, -s}", "perp[2] = {-s, s}")]),
    ("tangents of faces do not turn", BOUNDARY + "faces.c", [("f->n[i] = sign * A * cof[i][axis]", "f->n[i] = sign * A * (i == axis ? cof[i][axis] : 0.0)")]),
    ("staircases count their steps", BOUNDARY + "faces.c", [("f->s[i] = A * VectorDot(cof[i], f->n0)", "f->s[i] = f->n[i]")]),
    ("friction of a plate the wrong way", BOUNDARY + "plates.c", [("o->out[F_VS + t] -= shear", "o->out[F_VS + t] += shear")]),
    ("inertia of the fluids left out of the mixture", MODEL + "residual.c", [("fI[i] += take[TAKE_M + k] * acc[i]", "fI[i] += (k > 0 ? 0.0 : 1.0) * take[TAKE_M + k] * acc[i]")]),
    ("initial pressure at a face without its water", MODEL + "evaluate.c", [("weight += rho *", "weight += 0.0 * rho *")]),
    ("pressure projection without inertia (275)", MODEL + "stabilise.c", [("return 1.0 / (1.0 + PetscSqr(c->t_inertia / m->stage.dt))", "return c->t_inertia >= 0.0 && m->stage.dt > 0.0 ? 1.0 : 0.0")]),
    ("the tangent has 1 % less of every fourth term", MODEL + "rows.c", [("sum[c][l] += s->factor[q][k + c]", "sum[c][l] += (q % 4 == 3 ? 0.99 : 1.0) * s->factor[q][k + c]")]),
    ("the estimate (26) takes the nodes' mean of the velocity", MODEL + "commit.c", [("const bool own = m->c->fields.solid && !m->c->fields.inertia;", "const bool own = false;")]),
    ("every cell is taken for a full one (88)", "src/basis/cells.c", [("return sum * per_V;", "return (skip < CL_DIM ? 2.0 : 1.0) / CL_CORNERS + 0.0 * sum * per_V;")]),
    ("hybrid gives the cells the stress of the plane alone (88)", EXPLICIT + "deposit.c", [("more = v->across[q],", "more = 0.0 * v->across[q],")]),
    ("the tangent does not know the cell's mean strain (88)", MODEL + "rows.c", [("in[VectorAt(IN_GRADU, d, d)][vs + i] += dt * b->B[i]", "in[VectorAt(IN_GRADU, d, d)][vs + i] += 0.0 * dt * b->B[i]"), ("in[IN_HOOP][vs + i] += dt * b->B[i]", "in[IN_HOOP][vs + i] += 0.0 * dt * b->B[i]")]),
    ("gradients of the initial configuration are taken for those of t_n (445)", MODEL + "reach.h", [("G[i] = VectorDot(A[i], r->G[a]);", "G[i] = r->G[a][i] + 0.0 * A[i][0];")]),
    ("the hoop's too", MODEL + "reach.h", [("r->H[a] *= hoop;", "r->H[a] *= 1.0 + 0.0 * hoop;")]),
    ("ways to the nodes are those of the start (445)", HEADER + "particles.h", [("    v[i] = at[i];\n}\n\n/* What drives", "    v[i] += 0.0 * at[i];\n}\n\n/* What drives")]),
    ("a corner beside nodes that alternate carries heat as if it were alone (440)", "src/grid/alternation.c", [("fmin(own, fmax(", "0.0 * fmin(own, fmax(")]),
    ("the twist of T in long cells counts two thirds (444)", "include/clathra/point_heat.h", [("0.0) / 6.0;", "0.0) / 9.0;")]),
    ("the reaction is held where the pressure drives it (382)", "include/clathra/point_reaction.h", [("fmax(T2 - 2.0 * with_p * with_p, 0.0)", "fmax(T2 - 0.0 * with_p * with_p, 0.0)")]),
    ("... and where all of a cell is far from equilibrium", "include/clathra/point_reaction.h", [("across + beyond * beyond +", "across + 0.0 * beyond * beyond +")]),
    ("the chord of the equilibrium does not fade away from it (424)", "include/clathra/point_reaction.h", [("chord * spread / (spread + off * off)", "chord * (spread + 0.0 * off) / spread")]),
    ("hybrid holds no reaction (381)", EXPLICIT + "rates.c", [("  if (!SceneReactsWithHeat(e->m->c) || e->o.paper)\n    return;\n  LatentHeat", "  if (e->m->c || e->o.paper)\n    return;\n  LatentHeat")]),
    ("a heat source forgets its particle's volume at the start (443)", BOUNDARY + "faces.c", [("  return ParticleInitialVolume(c, x0, l);", "  return 0.0 * ParticleInitialVolume(c, x0, l) + P->f[P_V][p];")]),
    ("ghost penalty ten times", MODEL + "stabilise.c", [("= m->c->stabilisation.ghost_penalty * ratio", "= 10.0 * m->c->stabilisation.ghost_penalty * ratio")]),
    ("slivers are tied until they hold half of what is beside them (351)", MODEL + "stabilise.c", [("fmax(1.0 - 4.0 * least / most, 0.0) * least", "fmax(1.0 - 2.0 * least / most, 0.0) * least")]),
    ("the tie (351) is that of whole pressures, not of what they change by", MODEL + "stabilise.c", [("pull -= g->store[k - F_PW] * Jump(m, g, m->stage.x_star, k);", "pull -= 0.0 * g->store[k - F_PW] * Jump(m, g, m->stage.x_star, k);")]),
    ("a row of particles is tied by what both nodes share (417)", MODEL + "pressure_modes.c", [("A * B / (A + B) : 0.0", "both : 0.0")]),
    ("a thin gas takes its share, its water all (416)", MODEL + "evaluate.c", [("    in[IN_P + f] -= withheld;", "    in[IN_P + f] -= f == PHASE_G ? withheld : 0.0;"), ("less * (o->D[k][IN_P + PHASE_W] + o->D[k][IN_P + PHASE_G])", "less * o->D[k][IN_P + PHASE_G]")]),
    ("hybrid's particle of a layer takes the flow of its nodes (350)", EXPLICIT + "rates.c", [("J[d] = conduct * v[at + B_J + d];", "J[d] = v[at + B_J + d];")]),
    ("inertia of hybrid's fluids in layers without its weight (310)", EXPLICIT + "velocities.c", [("PetscSqr(b->flow) * f[FL_Inertia(s)]", "b->flow * f[FL_MI]")]),
    ("a node's flow is shared as if there were no hydrate (350)", MODEL + "step.c", [("ParticleMaterial(m, p), m->P.f[P_SH][p])", "ParticleMaterial(m, p), 0.0)")]),
    ("... by hybrid", EXPLICIT + "deposit.c", [("mat, w->Sh[q])", "mat, 0.0)")]),
    ("nodes see the mean velocity of their particles (451)", MODEL + "step.c", [("fs->solid ? Carried(", "!fs->solid ? Carried(")]),
    ("... in hybrid", EXPLICIT + "deposit.c", [("      if (s.solid)\n        Carried(r, lane, m, y, g, w, v);\n      for (int q = 0; !s.solid &&", "      for (int q = 0;")]),
    ("... the gradient of the velocity does not turn", "src/particles/keep.c", [("for (int k = 0; k < 3 + CL_DIM; k++) {", "for (int k = 0; k < 3; k++) {")]),
    ("nearly empty nodes follow one neighbour alone (454)", EXPLICIT + "nodes.c", [("n->stretch[d] = (here - x) / (x - there);", "n->stretch[d] = 0.0 * (here - there);")]),
    ("... and forget that their mass moves", EXPLICIT + "nodes.c", [("own[at + d] - Mass(e, own) * (a_root + more)", "own[at + d] + Mass(e, own) * (e->m->bc.gravity[d] + 0.0 * a_root)")]),
    ("... and take their momentum from nobody", EXPLICIT + "nodes.c", [("gives * (r * excess - Mass(e, own) * more)", "gives * r * excess")]),
    ("unseen motion is taken everywhere (453)", "src/transfer/unseen.c", [("return unseen > 0.0 ? 1.0 / (1.0 + pow(HALF * fmax(variance, 0.0) / unseen, STEEP)) : 0.0;", "return unseen > 0.0 && variance > -1.0 ? 1.0 - 0.0 * HALF : 0.0;")]),
    ("fluids keep what the skeleton loses (452)", "src/transfer/unseen.c", [("d < CL_DIM && (phase == 0 || fs->phase[phase - 1])", "d < CL_DIM && phase == 0")]),
    ("a trial state in tension opens ground that is compressed (427)", "src/skeleton/tears.c", [("c.most = c.K * c.open;", "c.most = c.K * c.open + fmax(c.trial, 0.0);")]),
]  # fmt: skip


def copy(folder):
    """A copy of the files under version control, built once."""
    files = subprocess.run(["git", "-C", str(ROOT), "ls-files", "-z"], capture_output=True, check=True).stdout.split(b"\0")
    for name in filter(None, map(bytes.decode, files)):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        if (ROOT / name).is_file() or (ROOT / name).is_symlink():
            shutil.copy(ROOT / name, folder / name, follow_symlinks=False)


def build(folder, targets):
    """What the compiler says against them; "" if nothing."""
    done = subprocess.run(["ninja", "-C", str(folder / "build"), *targets], capture_output=True, text=True)
    return "" if done.returncode == 0 else done.stdout[-1500:]


def configure(folder):
    script = f"cd {folder} && source scripts/setup.sh && set +e && setup_build build clathra"
    subprocess.run(["bash", "-c", script], check=True, stdout=subprocess.DEVNULL)


def tests(folder, path):
    """(name, what it needs, command) of the quick tests, those of the fault's folder first."""
    own = FIRST[Path(path).parts[1]]
    for name in sorted(UNIT, key=lambda u: u != own):
        yield f"unit/test_{name}", [f"tests/test_{name}"], ["mpiexec", "-n", "1", str(folder / "build" / "tests" / f"test_{name}")]
    for name in RUNS:
        yield f"verification/{name}", ["clathra", "clathra3d"] if name in SPACE else ["clathra"], [sys.executable, str(folder / "tests" / "verification" / f"{name}.py"), str(folder / "build" / "clathra")]


def said(text):
    """The line of a failing test that names what failed."""
    found = re.search(r"^FAIL (.*?)(?:   |$)", text, re.M) or re.search(r"\[  FAILED  \] (\w+)", text)
    return found[1].strip() if found else "ends with an error"


def found_by(folder, path):
    """(test, what it says) of the first quick test that fails; None: they all pass."""
    for name, targets, command in tests(folder, path):
        against = build(folder, targets)
        if against:
            return "the compiler", against.splitlines()[-1]
        try:
            done = subprocess.run(command, env=environment(), stdin=subprocess.DEVNULL, capture_output=True, text=True,
                                  errors="replace", timeout=600)  # fmt: skip
        except subprocess.TimeoutExpired:
            return name, "not done in ten minutes"
        if done.returncode:
            return name, said(done.stdout + done.stderr)
    return None


def plant(folder, fault):
    """The row of a fault: (name, file, test that found it, what it says)."""
    name, path, edits = fault
    file = folder / path
    good = text = file.read_text()
    for old, new in edits:
        if text.count(old) != 1:
            raise SystemExit(f"{name}: {path} holds {text.count(old)} times\n{old}\nmend this script")
        text = text.replace(old, new)
    file.write_text(text)
    try:
        return (name, path, *(found_by(folder, path) or ("", "")))
    finally:
        file.write_text(good)


def stale():
    """Faults whose text does not stand once in the sources, a line each."""
    texts = {path: (ROOT / path).read_text() for _, path, _ in FAULTS}
    return [f"{name}: {path} holds {texts[path].count(old)} times: {old}" for name, path, edits in FAULTS for old, _ in edits if texts[path].count(old) != 1]


def page(found):
    rows = [(name, path, *found[name]) for name, path, _ in FAULTS if name in found]
    seen, left = sum(bool(r[2]) for r in rows), [name for name, *_ in FAULTS if name not in found]
    lines = [*dated.head("Planted faults", "tests/mutation.py", RECORD, since="Every row names the commit at which its fault was planted."),
             "Written with `--record docs/studies/mutation.jsonl --page docs/studies/mutation.md`. Each fault is planted alone in a copy of the tree, with its derivative where it has "
             "one, so that what finds it is a test of the physics, not Newton's method. The quick tests (unit tests on one rank, then verification that takes seconds) run until one fails.", "",
             f"{seen} of {len(rows)} faults were found." + (f" Written down, but not planted yet: {', '.join(left)}." if left else ""), "",
             "| planted | in | found first by | what it says | commit |", "|---|---|---|---|---|"]  # fmt: skip
    lines += [f"| {name} | {path} | {test or '**none**'} | {what} | {commit} |" for name, path, test, what, commit in rows]
    return "\n".join(lines) + "\n"


def read(record):
    """{fault: (test, what it says, commit)}, the last of each."""
    lines = Path(record).read_text().splitlines() if record and Path(record).is_file() else []
    return {e["fault"]: (e["test"], e["says"], e["commit"]) for e in map(json.loads, lines)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--page", help="file for the result, as a page")
    parser.add_argument("--only", nargs="*", help="faults whose names hold one of these words")
    parser.add_argument("--work", help="folder for the copy, kept; default: a new one, removed")
    parser.add_argument("--record", help="file of what was found, gone on with")
    parser.add_argument("--fresh", action="store_true", help="ask for all faults again")
    parser.add_argument("--sound", action="store_true", help="first run the quick tests without a fault")
    parser.add_argument("--texts", action="store_true", help="only look whether each fault can be planted")
    args = parser.parse_args()
    if args.texts:
        print("\n".join(stale()) or f"{len(FAULTS)} faults can be planted")
        return 1 if stale() else 0
    folder = Path(args.work or tempfile.mkdtemp(prefix="clathra-mutation-")).resolve()
    found = {} if args.fresh else read(args.record)
    faults = [f for f in FAULTS if f[0] not in found and (not args.only or any(w in f[0] for w in args.only))]
    commit = subprocess.run(["git", "-C", str(ROOT), "rev-parse", "--short", "HEAD"], capture_output=True, text=True).stdout.strip()
    try:
        if faults:
            copy(folder)
            configure(folder)
        sound = found_by(folder, MODEL) if args.sound else None
        if sound:
            raise SystemExit(f"without a fault {sound[0]} fails: {sound[1]}")
        for fault in faults:
            name, path, test, says = plant(folder, fault)
            found[name] = (test, says, commit)
            print(f"{name}: {test or 'NOT FOUND'}: {says}", flush=True)
            if args.record:
                with open(args.record, "a") as file:
                    file.write(json.dumps({"commit": commit, "fault": name, "file": path, "test": test, "says": says}) + "\n")
                dated.measured(args.record)
    finally:
        if not args.work:
            shutil.rmtree(folder, ignore_errors=True)
    if args.page:
        Path(args.page).write_text(page(found))
    missed = [name for name, (test, _, _) in found.items() if not test]
    print(f"{len(found) - len(missed)} of {len(found)} found" + (f"; not: {', '.join(missed)}" if missed else ""))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
