#!/usr/bin/python3
"""Pictures of clathra plot: a sheared body is drawn whole, in cells that are no squares; which pictures there are of what run; no words
over others; numbers at ticks."""
import sys
from pathlib import Path

import numpy as np
from matplotlib.path import Path as Outline

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
from common import CASES, ROOT, binary, check, check_true, command, finish, launch, run, scratch  # noqa: E402

import clathra  # noqa: E402
from clathra import plot, shown  # noqa: E402
from clathra.units import durations  # noqa: E402
from clathra.plotting import Plain, boxes, colours, plt, set_style, wrapped  # noqa: E402


def draw(out):
    """Names of the pictures that clathra plot makes, and what it says."""
    done = command("plot", out)
    check_true(f"clathra plot {out.name} ends well", done.returncode == 0, done.stderr[-300:])
    return sorted(p.stem for p in (out / "figures").glob("*.png")), done.stdout


def holes(particles, first):
    """Share of white pixels inside the outline of the body, a pixel away from its edge."""
    figure = plt.figure(figsize=(5, 5), dpi=100)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.axis("off")
    boxes(axes, particles, np.zeros(len(particles["id"])), -1, 1, first)
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, :3].astype(int)
    corner, x = shown.corners(particles, first), first["position"]
    left, right = (np.isclose(x[:, 0], f(x[:, 0])) for f in (np.min, np.max))
    up = np.argsort(x[left, 1])
    outline = np.concatenate([corner[left][up][:, [0, 3]].reshape(-1, 2), corner[right][up][::-1][:, [2, 1]].reshape(-1, 2)])
    shape = Outline(axes.transData.transform(outline))
    rows, columns = np.mgrid[0:500, 0:500]
    inside = shape.contains_points(np.c_[columns.ravel() + 0.5, 499.5 - rows.ravel()]).reshape(500, 500)
    for k in (0, 1):
        for step in (-1, 1):
            inside &= np.roll(inside, step, k)
    plt.close(figure)
    return (pixels[inside].min(axis=1) > 200).mean(), inside.mean()


def drawn(axis):
    """Labels of the ticks that lie on the axis."""
    low, high = sorted(axis.get_view_interval())
    return [t.label1 for t in axis.get_major_ticks() if t.label1.get_visible() and low - 1e-9 * (high - low) <= t.get_loc() <= high + 1e-9 * (high - low)]


def picture(draw, *arguments):
    """A picture of clathra plot and what measures its words."""
    kept = []
    plot.save = lambda figure, folder, name: kept.append(figure)
    draw(*arguments)
    kept[0].canvas.draw()
    return kept[0], kept[0].canvas.get_renderer()


def overlaps(draw, *arguments):
    """Pairs of words in a picture one of which is drawn over the other."""
    figure, renderer = picture(draw, *arguments)
    words = [t for a in figure.axes for axis in (a.xaxis, a.yaxis) for t in (axis.label, axis.get_offset_text(), *drawn(axis))]
    words += [t for a in figure.axes for t in (a.title, a._left_title)]
    held = [(t.get_text(), t.get_window_extent(renderer)) for t in words if t.get_visible() and t.get_text().strip()]
    plt.close(figure)
    return [(a, b) for k, (a, x) in enumerate(held) for b, y in held[:k] if min(x.x1, y.x1) - max(x.x0, y.x0) > 1 and min(x.y1, y.y1) - max(x.y0, y.y0) > 1]


def body(columns, rows, size, height):
    """Two snapshots of a body of squares (m), with values that are awkward to write."""
    x, y = (a.ravel() for a in np.meshgrid((np.arange(columns) + 0.5) * size, height * (np.arange(rows) + 0.5) / rows))
    share = (x + y) / (x + y).max()
    p = {"position": np.c_[x, y], "half_length": np.full((len(x), 2), 0.5 * size), "id": np.arange(len(x)), "p": 1e7 + 40 * share, "T": 13.5 + 40 * share,
         "S_h": 0.4 * share, "S_w": 0.9702 + 0.01 * share, "displacement": np.c_[2e-8 * share, -3e-7 * share], "stress": 120.0 * np.outer(share, np.ones(6))}  # fmt: skip
    return [{**p, "p": 1e7 + 0 * share}, p]


class Body:
    """What pictures ask of a run beside its particles."""

    title, folder, in_space = "a body", scratch(), False


def check_words():
    set_style()
    run = Body()
    flat, upright = body(40, 10, 0.1, 1.0), body(1, 40, 0.25, 10.0)
    rows = [q for q in shown.shown(flat) if q.key in plot.FIRST][:4]
    over = overlaps(plot.plot_film, run, (0.0, 3e5), flat, rows)
    check_true("a flat body: no words over others", len(rows) == 4 and not over, over[:3])
    over = overlaps(plot.plot_profiles, run, (0.0, 3e5), upright, 1)
    check_true("profiles: no words over others", not over, over[:3])
    check_true("one unit for all times of a picture", durations([0.0, 78120.0, 111600.0]) == ["0 h", "21.7 h", "31 h"], durations([0.0, 78120.0, 111600.0]))
    texts = lambda *v: [t.replace("\N{MINUS SIGN}", "-") for t in Plain().format_ticks(v)]
    check_true("ticks that lie close", texts(10.0, 10.0025, 10.005) == ["10.0000", "10.0025", "10.0050"], texts(10.0, 10.0025, 10.005))
    check_true("small ones carry their own power of ten", texts(0, 5e-8, 1e-7) == ["0", "5e-8", "1e-7"] and texts(-2e6, 0) == ["-2e6", "0"], texts(0, 5e-8, 1e-7))
    check_true("a unit stays with the word before it", wrapped("water saturation S_w (-)", 1.9) == "water saturation\n$S_w$\N{NO-BREAK SPACE}(-)", wrapped("water saturation S_w (-)", 1.9))


def check_arrows():
    """None reaches another, however strong the flow and however the particles lie; about a dozen and a half along the longer side, or every particle."""
    chance = np.random.default_rng(1)
    for what, columns, rows, tilt, noise in (("a lattice", 20, 22, 0.0, 0.0), ("a sheared one", 80, 40, 0.4, 0.0), ("places at random", 60, 60, 0.0, 1.0), ("few", 3, 2, 0.0, 0.0)):
        p = body(columns, rows, 0.4, 0.48 * rows)[1]
        x = p["position"]
        x += np.c_[tilt * x[:, 1], 0 * x[:, 1]] + noise * chance.uniform(-0.3, 0.3, x.shape)
        axes = plt.figure().add_axes([0, 0, 1, 1])
        plot.arrows(axes, {**p, "v_w": np.ones(x.shape) / (0.1 + x[:, :1])}, "v_w")
        flow = axes.collections[0]
        place = np.c_[flow.X, flow.Y]
        way = min(np.hypot(*(place - q).T)[np.arange(len(place)) != k].min() for k, q in enumerate(place))
        check(f"{what}: the longest arrow, of the least way between two", np.hypot(flow.U, flow.V).max() / flow.scale / way, (0.1, 0.91))
        check(f"{what}: arrows", len(place), (min(len(x), 80), 19**2))
        plt.close(axes.figure)
    check_true("a body of one particle", list(shown.apart(np.zeros((1, 2)), 0.0)) == [0])


def check_meters(run):
    figure, renderer = picture(plot.plot_meters, run)
    beyond = [a.get_ylabel() for a in figure.axes if a.yaxis.label.get_window_extent(renderer).height > a.get_window_extent(renderer).height]
    check_true("words beside the curves of meters are no longer than their axes", figure.axes and not beyond, beyond)
    plt.close(figure)
    meters = {"well.gas_kg_s": np.array([0.0, 0.02, 0.02, 0.01]), "well.water_kg_s": np.array([0.0, 0.1, -0.1, 5e-5]), "well.gas_kg": np.array([0, 1.0, 3.0, 4.0]),
              "well.gas_std_m3": np.array([0, 1.5, 4.5, 6.0])}  # fmt: skip
    ratio = shown.gas_to_water(meters, "well")
    check_true("gas to water: 300 m3/m3 where both flow out, nowhere else", list(np.isnan(ratio)) == [True, False, True, True] and abs(ratio[1] - 300) < 1e-9, list(ratio))
    check_true("... and none where a meter counts no water", shown.gas_to_water({**meters, "well.water_kg_s": np.zeros(4)}, "well") is None)


def check_histories():
    """Changes of pressure that its axis hides have a panel of their own; p_g is drawn where there is gas; no two probes of a dozen have one colour."""
    tide = {"time_s": np.arange(4.0), "sea.p_Pa": 8e6 + 15e3 * np.array([0.0, 1, 0, -1]), "sea.p_w_Pa": np.full(4, 8e6), "sea.p_g_Pa": np.full(4, 3.6e6), "sea.S_g": np.array([0.0, 0, 0.1, 0.1])}
    labels = lambda probes: [label for label, *_ in shown.histories(probes, ["sea"])]
    check_true("a tide: its rise and fall by themselves", "change of pore pressure" in labels(tide) and list(shown.curve(tide, "sea", "p_rise_Pa")) == [0, 15e3, 0, -15e3], labels(tide))
    check_true("... not those of a well, which the pressure shows", "change of pore pressure" not in labels({**tide, "sea.p_Pa": np.array([8e6, 7e6, 6e6, 5e6])}))
    check_true("... nor where nothing changes", "change of pore pressure" not in labels({**tide, "sea.p_Pa": np.full(4, 8e6)}))
    check_true("p_g where there is gas", list(np.isnan(shown.curve(tide, "sea", "p_g_Pa"))) == [True, True, False, False])
    check_true("colours of two and of twelve probes", len(set(map(tuple, colours(12)))) == 12 and colours(2) == plot.COLOURS[:2])


def check_phases():
    """Profiles under a periodic load: times of several phases; where all snapshots are of one phase, words that say so."""
    period = 12.42 * 3600
    case = {"bc_floor_pressure": {"sine": [1.1e7, 2e4, period, 0.0]}, "time_end": 10 * period}
    check_true("the period of a load; none without a sine, nor of one that hardly acts", shown.period(case) == period and shown.period({"time_end": 1e6, "x": {"ramp": [0.0, 1.0]}}) is None
               and shown.period({**case, "time_end": 2 * period}) is None)  # fmt: skip
    sixth = np.arange(61) * period / 6
    even = (sixth[shown.spread(61, 6)] / period + 1e-9) % 1.0
    taken, wide = shown.spread_phases(sixth, 6, period)
    phases = np.round(sixth[taken] / period % 1.0, 6) % 1.0
    check_true("evenly spaced times are all of one phase", np.ptp(even) < 1e-6, list(even))
    check_true("those of profiles are not, first and last among them", len(set(phases)) >= 5 and wide > 0.4 and taken[0] == 0 and taken[-1] == 60 and len(taken) == 6, list(phases))
    check_true("where there is one phase only, that is seen", shown.spread_phases(np.arange(11) * period, 6, period)[1] < plot.ONE_PHASE)
    check_true("few snapshots", shown.spread_phases([0.0], 6, period)[0] == [0] and shown.spread_phases([0.0, period], 6, period)[0] == [0, 1] and shown.spread_phases(sixth[:4], 6, period)[0] == [0, 1, 2, 3])


def main():
    check_phases()
    block, failed, upright = scratch() / "block", scratch() / "failed", scratch() / "upright"
    run(binary(), CASES / "shear_box", "-grid_cells", "32,5", "-meters", "top", "-meter_top_side", "top", out=block)
    body = clathra.Run(block)
    white, share = holes(body.particles(), body.particles(0))
    check_true("the sheared block fills a part of the picture", 0.5 < share < 0.95, f"{share:.2f}")
    check("white pixels in it", white, 0.0)
    names, _ = draw(block)
    check_true("pictures of a body and of its meters", names == ["balance", "maps", "meters", "particles", "probes"], names)
    launch(binary(), CASES / "bp2", "-grid_cells", "13,1", "-output_times", "0 s", "-stepper_dt", "10 s", "-stepper_dt_min", "9 s", "-bc_load_normal", "1e5 MPa", out=failed)
    names, said = draw(failed)
    check_true("a run without a step has no empty axes", names == [] and "nothing to draw yet" in said, names)
    run(binary(), CASES / "gravity_column", out=upright)
    names, _ = draw(upright)
    check_true("pictures of a strip", "profiles" in names and "particles" not in names and "meters" not in names, names)
    gas = scratch() / "gas"
    run(binary(), ROOT / "tests" / "verification" / "cases" / "no_gas_cell.yaml", "-time_end", "2 s", "-meters", "side", "-meter_side_side", "right", out=gas)
    check_true("... of gas that comes: what pores hold of it beside what a meter counts", "meters" in draw(gas)[0])
    check_meters(clathra.Run(gas))
    check_histories()
    check_words()
    check_arrows()
    finish()


main()
