#!/usr/bin/python3
"""report.html: what it holds against the files of the run, and what a reader sees of it in a browser.

Without a browser (chromium-headless-shell) the second half is skipped, and says so.
"""
import base64
import html
import json
import os
import re
import shutil
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "verification"))
import _browser  # noqa: E402
from common import CASES, binary, check, check_true, command, finish, launch, run, scratch  # noqa: E402

import clathra  # noqa: E402
from clathra import plot, shown  # noqa: E402
from clathra import report as page  # noqa: E402  the test has its name

DATA = re.compile(r'(?<=<script type="application/json" id="data">)(.*?)(?=</script>)', re.S)
BLOCK = ("-grid_cells", "8,5", "-output_times", "0 s,2 s,4 s,6 s,8 s,10 s", "-meters", "top", "-meter_top_side", "top")
COLUMN = ("-grid_cells", "13,1", "-time_end", "60 s", "-output_times", "0 s,30 s,60 s")
VIRIDIS = np.array([[68, 1, 84], [71, 44, 122], [59, 81, 139], [44, 113, 142], [33, 144, 141], [39, 173, 129], [92, 200, 99], [170, 220, 50], [253, 231, 37]])


def report(out):
    done = command("report", out)
    check_true(f"clathra report {out.name} ends well", done.returncode == 0, done.stderr[-300:])
    text = (out / "report.html").read_text()
    return text, json.loads(DATA.search(text)[1])


def unpack(text, kind, *shape):
    return np.frombuffer(base64.b64decode(text), kind).reshape(shape)


def check_film(film, out):
    """Every frame's places, outlines and values are those of the snapshots, rounded."""
    done, first = clathra.Run(out), clathra.Run(out).particles(0)
    n, frames = film["n"], len(film["times"])
    place = np.array(film["low"]) + unpack(film["place"], "<u2", frames, n, 2) / 65535 * film["span"]
    edges = unpack(film["edges"], "i1", frames, n, 2, 2) / 127 * film["longest"]
    worst = {"place": 0.0, "outline": 0.0}
    values = {f["key"]: f["low"] + unpack(f["data"], "u1", frames, n) / 254 * (f["high"] - f["low"]) for f in film["fields"]}
    for k, t in enumerate(done.times):
        p = shown.drawn(done, t)
        F, l = p["deformation_gradient"].reshape(-1, 2, 2), first["half_length"]
        outline = p["position"] + F[:, :, 0] * l[:, :1] + F[:, :, 1] * l[:, 1:]
        worst["place"] = max(worst["place"], np.max(np.abs(place[k] - p["position"]) / film["span"]))
        worst["outline"] = max(worst["outline"], np.max(np.abs(place[k] + edges[k].sum(1) - outline)) / film["longest"])
        for q in shown.QUANTITIES:
            if q.key in values:
                field = next(f for f in film["fields"] if f["key"] == q.key)
                worst[q.key] = max(worst.get(q.key, 0), np.max(np.abs(values[q.key][k] - q.of(p))) / (field["high"] - field["low"]))
    check("places of the film, of the body", worst.pop("place"), 1e-5)
    check("corners of the particles, of the longest half edge", worst.pop("outline"), 0.03)
    check(f"{len(worst)} quantities at {frames} times, of their range", max(worst.values()), 0.51 / 254)
    check_true("stress, strain, porosity, pressure, displacement and flow are there", {"s_xx", "q", "eps_v", "porosity", "p", "u_x"} <= set(worst)
               and [a["name"] for a in film["arrows"]] == ["water"], ", ".join(worst))  # fmt: skip


def check_charts(data, out):
    done = clathra.Run(out)
    by_label = {c["y"]: c for part in data["charts"].values() for c in part}
    curve = by_label["displacement (mm)"]["series"][0]
    check("a probe's curve", np.max(np.abs(np.array(curve["y"]) - 1e3 * done.probes["corner.u_x_m"])), 1e-3)
    curve = by_label["water out (kg)"]["series"][0]
    check("a meter's curve", np.max(np.abs(np.array(curve["y"])[1:] / done.meters["top.water_kg"][1:] - 1)), 1e-4)
    check_true("steps and balance", len(by_label["length of a step (s)"]["series"][0]["x"]) == len(done.balance["step"])
               and "mechanical energy (J)" in by_label)  # fmt: skip


def check_words(data, text, out):
    check_true("one file: nothing is loaded from elsewhere", not re.search(r"(src|href)=\"(?!#)|url\(|@import|fetch\(", text.split('<script type="application/json"')[0] + text.split("</script>", 1)[1]))
    check_true("the command to repeat it", data["command"].endswith(f"-output_dir {out}") and "-grid_cells 8,5" in data["command"], data["command"])
    check_true("forecast against fact", "hybrid does not know" in data["forecast"][0] and "10 steps" in data["fact"], data["fact"])
    lines = {c["name"]: c["lines"] for c in data["scene"]["conditions"]}
    check_true("conditions on the scene", lines["base"] == [[0.0, 0, 2.0, 0]] and len(lines["top"]) == 8 and lines["top"][0] == [0.5, 1, 0.625, 1]
               and len(lines["left"]) == 8, lines["top"][:1])  # fmt: skip


def check_damaged(out):
    """Whatever a run that was killed or a disk leaves: what there is is shown, what there is not is said, and nothing ends in a trace."""
    broken = scratch() / "broken"
    header = lambda p: p.write_bytes(p.read_bytes().split(b"\n")[0] + b"\n")
    half = lambda p: p.write_bytes(p.read_bytes()[: p.stat().st_size // 2])
    empty, cells = lambda p: p.write_bytes(b""), lambda p: p.write_bytes(p.read_bytes().replace(b"e+00,", b"e+x,"))
    none = lambda p: p.write_bytes(b"\n".join(line if k == 0 else line.split(b",")[0] + b",nan" * line.count(b",") for k, line in enumerate(p.read_bytes().split(b"\n"))))
    for name, hurt, words in (
        ("balance.csv", header, ""), ("balance.csv", empty, "balance.csv is empty"), ("balance.csv", none, "a row whose time is no number"), ("balance.csv", half, ""),
        ("probes.csv", header, ""), ("probes.csv", none, ""), ("probes.csv", cells, "probes.csv, line 2: no row of"), ("meters.csv", header, ""), ("meters.csv", empty, "meters.csv is empty"),
        ("fields/000003.h5", half, "fields/000003.h5 is missing or damaged"), ("fields/000000.h5", Path.unlink, "fields/000000.h5 is missing or damaged"), ("fields.h5", half, "fields.h5 is missing or damaged"),
        ("case.yaml", empty, "case.yaml has no grid_lower"), ("case.yaml", half, ""), ("log.txt", empty, ""), ("summary.txt", half, ""),
    ):  # fmt: skip
        shutil.rmtree(broken, ignore_errors=True)
        shutil.copytree(out, broken)
        hurt(broken / name)
        damaged, before = [], plot.save
        try:
            plot.save = lambda figure, *_: plot.plt.close(figure)
            text = page.page(clathra.Run(broken, damaged.append), damaged)
            pictures = plot.draw(clathra.Run(broken, damaged.append), damaged)
            said = "; ".join(dict.fromkeys(damaged))
        except Exception as error:  # whatever it is, it is no sentence
            text, said, pictures = "", f"a trace: {type(error).__name__}: {error}", []
        plot.save = before
        check_true(f"{name}, damaged: a page and pictures of the rest{', and a sentence' if words else ''}", "</html>" in text and len(pictures) >= 2
                   and (words in said if words else not said) and html.escape(words) in text, f"{said[:200]} {pictures}")  # fmt: skip
    done = command("report", broken)
    check_true("a folder whose last line is cut is no error", done.returncode == 0, done.stderr[-300:])
    empty(broken / "meters.csv")
    for name in ("report", "plot"):
        done = command(name, broken)
        check_true(f"clathra {name} says what is damaged, and ends with exit code 2", done.returncode == 2 and f"{broken}/meters.csv is empty" in done.stderr and "Traceback" not in done.stderr, done.stderr[-300:])


def check_titles(out):
    """Whatever a title says, the page is the same."""
    named, plain = scratch() / "named", page.page(clathra.Run(out), [])
    shutil.copytree(out, named)
    lines = (named / "case.yaml").read_text().splitlines(keepends=True)
    at = next(k for k, line in enumerate(lines) if line.startswith("title:"))
    for title in ("{{data}}", "{{title}}", "<!--<script>", "</script><b>", "a & b \\1 \\g<0>", "\u2028 é"):
        (named / "case.yaml").write_text("".join([*lines[:at], f"title: '{title}'\n", *lines[at + 1 :]]), encoding="utf-8")
        text = page.page(clathra.Run(named), [])
        data = DATA.search(text)[1]
        check_true(f"title {title!r}", json.loads(data)["title"] == title and "<" not in data and f"<title>{html.escape(title)}</title>" in text
                   and DATA.sub("", text).split("\n")[6:] == DATA.sub("", plain).split("\n")[6:], f"{json.loads(data)['title']} {text[200:400]}")  # fmt: skip


def colour(share):
    at = np.clip(share, 0, 1) * (len(VIRIDIS) - 1)
    k = np.minimum(at.astype(int), len(VIRIDIS) - 2)
    return VIRIDIS[k] + (at - k)[:, None] * (VIRIDIS[k + 1] - VIRIDIS[k])


PIXELS = """(() => { const c = document.getElementById("film"), g = c.getContext("2d"), r = window.devicePixelRatio || 1, out = [];
  for (let p = 0; p < film.n; p++) out.push([...g.getImageData(view.stage.X(frames.x(view.frame, p)) * r, view.stage.Y(frames.y(view.frame, p)) * r, 1, 1).data].slice(0, 3));
  return out; })()"""


def check_picture(page, done, key, time):
    """The colour in the middle of each particle is that of its value."""
    q = next(q for q in shown.QUANTITIES if q.key == key)
    every = [q.of(shown.drawn(done, t)) for t in done.times]
    low, high = min(map(np.min, every)), max(map(np.max, every))
    wanted, seen = colour((q.of(shown.drawn(done, time)) - low) / (high - low)), np.array(page.ask(PIXELS))
    check(f"{key} at {time:g} s: colours in the middle of the particles, levels of 255", np.max(np.abs(wanted - seen)), 8)


def look(out, browser):
    done, page = clathra.Run(out), _browser.Page(browser, f"file://{out}/report.html")
    keys = page.ask("film.fields.map(f => f.key)")
    choose = lambda key: page.ask(f"(e => {{ e.value = {keys.index(key)}; e.dispatchEvent(new Event('change')); }})(document.getElementById('quantity'))")
    check_true("title and verdict", page.ask("document.title") == done.title and "finished" in page.ask("document.getElementById('sub').textContent"))
    said = page.ask("texts([10, 10.0013, 10.0026, 10.0039, 10.0052])")
    check_true("numbers beside a colour bar are told apart", [float(t) for t in said] == [10, 10.0013, 10.0026, 10.0039, 10.0052], said)
    check_true("... with no more digits than that takes", page.ask("texts([0, 0.1, 0.2, 0.1 + 0.2])") == ["0", "0.1", "0.2", "0.3"])
    check_true("it opens at the last time", "t = 10 s (6 of 6)" in page.ask("document.getElementById('time').textContent"))
    choose("u_x")
    check_picture(page, done, "u_x", 10.0)
    page.ask("document.getElementById('slider').focus()")
    page.key("ArrowLeft")
    page.key("ArrowLeft")
    check_true("two keys on the slider go back two frames", "t = 6 s (4 of 6)" in page.ask("document.getElementById('time').textContent"),
               page.ask("document.getElementById('time').textContent"))  # fmt: skip
    check_picture(page, done, "u_x", 6.0)
    choose("s_xy")
    check_picture(page, done, "s_xy", 6.0)
    page.ask("window.was = document.getElementById('film').getContext('2d').getImageData(0, 0, 1000, 500).data; 0")
    page.ask("document.getElementById('arrows').click()")
    check("flow: pixels of arrows", page.ask("document.getElementById('film').getContext('2d').getImageData(0, 0, 1000, 500).data"
          ".filter((v, i) => v !== was[i]).length"), (1000, np.inf))  # fmt: skip
    check_true("as many curves as the data hold", page.ask("document.querySelectorAll('path.curve').length") == page.ask(
        "Object.values(data.charts).flat().map(c => c.series.length).reduce((a, b) => a + b)"))  # fmt: skip
    check_true("every curve has a path", page.ask("[...document.querySelectorAll('path.curve')].every(p => p.getAttribute('d').length > 3)"))
    check_true("a row for every condition", page.ask("document.querySelectorAll('#conditions tr').length") == len(done.names("boundaries")))
    check_true("nothing hangs over the page's right edge", page.ask("document.documentElement.scrollWidth <= window.innerWidth"))
    check_true("no error, and no request but the file", not page.errors and page.requests == [f"file://{out}/report.html"], (page.errors + page.requests)[:3])
    if os.environ.get("CLATHRA_KEEP"):
        page.picture(out / "report.png")
    page.close()


def look_at_column(out, browser):
    """A strip is a profile; a run that gave up says so."""
    page = _browser.Page(browser, f"file://{out}/report.html")
    check_true("a strip: no error", not page.errors, page.errors[:2])
    check_true("it says that it did not come to its end, and why", "did not come" in page.ask("document.getElementById('sub').textContent")
               and "Given up" in page.ask("document.getElementById('warnings').textContent"))  # fmt: skip
    check_true("profiles instead of a map", page.ask("film.strip") == 0 and page.ask("document.getElementById('film').height") > 100)
    page.close()


def check_findings():
    """A finding comes once, whatever the number of ranks: in the terminal, in the summary, and on the page, above the rest of the summary."""
    words = "warning: 5 of 5 steps were accepted above the tolerance"
    for ranks in (1, 2):
        out = scratch() / "loose"
        done = launch(binary(), CASES / "bp2", "-grid_cells", "13,1", "-output_times", "0 s", "-quiet", "-time_end", "5 s", "-stepper_dt", "1 s", "-stepper_dt_min", "1 s", "-stepper_tol", "1e-7", out=out, ranks=ranks)
        _, data = report(out)
        said = [done.stdout.count(words), (out / "summary.txt").read_text().count(words), "\n".join(data["warnings"]).count(words)]
        check_true(f"a finding comes once, {ranks} rank(s)", said == [1, 1, 1] and words not in data["summary"] and "results in" in data["summary"], f"{said} {data['summary'][-300:]}")
    check_true("... from Python, too, in the same words", sum(words in f for f in clathra.Run(out).findings) == 1 and data["warnings"] == clathra.Run(out).findings, data["warnings"])


def main():
    block, column = scratch() / "block", scratch() / "column"
    run(binary(), CASES / "shear_box", *BLOCK, out=block)
    launch(binary(), CASES / "bp2", *COLUMN, "-stepper_dt_min", "1e-3 s", "-bc_load_normal_table", "0 s,3.25 MPa,30 s,3.3 MPa,31 s,1e5 MPa", out=column)
    text, data = report(block)
    check_film(data["film"], block)
    check_charts(data, block)
    check_words(data, text, block)
    check_damaged(block)
    check_titles(block)
    _, failed = report(column)
    check_true("a run that gave up is told", not failed["finished"] and any("Given up" in w for w in failed["warnings"]), failed["warnings"][-1:])
    check_findings()
    check("size of the page, MB", len(text) / 1e6, 1.0)
    browser = _browser.find()
    if browser:
        look(block, browser)
        look_at_column(column, browser)
    else:
        print(f"SKIP no browser: none of {', '.join(_browser.BROWSERS)} is installed; what a reader sees was not looked at")
    finish()


main()
