#!/usr/bin/python3
"""The tutorial's cases and pictures: tutorial.py CLATHRA [FOLDER]

Puts the YAML blocks of docs/tutorial.md together, those of the ten steps and those of its heater by power, runs them into FOLDER (goes on there from
a checkpoint; default: results/tutorial) and takes the pictures of docs/figures/tutorial_*.png from the reports, with a headless browser.
"""
import base64
import re
import sys
from pathlib import Path

import clathra
from clathra import report

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "tutorial.md"
FINE = ("-basis", "total", "-grid_cells", "10,44")  # those of the answer
POWER = "A heater by power"


def blocks(heading):
    """The YAML blocks of a part of the page, one after the other; its ten steps stand before the first heading."""
    parts = dict(part.split("\n", 1) for part in PAGE.read_text().split("\n## "))
    return "\n".join(re.findall(r"^```yaml\n(.*?)^```", parts[heading], re.M | re.S))


def case_text():
    """The case that the ten steps build."""
    return blocks(PAGE.read_text().split("\n", 1)[0])


def quoted(key):
    """A line of the page's last section, by its key."""
    return next(w for w in PAGE.read_text().split("`") if w.startswith(key + ":"))


def heated(text):
    """The case with the page's heater."""
    return text.replace("boundaries: [", "boundaries: [heater, ") + f"\n{quoted('bc_heater')}\n"


def powered(text):
    """The case with the page's heater by power: lines in place of those of their names, or new ones."""
    for line in blocks(POWER).splitlines():
        name = re.escape(line.split(":")[0])
        text, found = re.subn(rf"^{name}:.*$", line, text, flags=re.M)
        text += "" if found else f"\n{line}\n"
    return text


def tidal(text):
    """The case with the page's tide in place of the burden."""
    return text.replace("burden, well]", "floor, well]").replace("bc_burden", "#") + f"\n{quoted('ambient')}\n{quoted('bc_floor')}\n"


def without_gas(text):
    """The layers full of water, or of hydrate and water."""
    changed = text.replace("Sh: 0, Sw: 0.9, Sg: 0.1", "Sh: 0, Sw: 1, Sg: 0").replace("Sh: 0.4, Sw: 0.5, Sg: 0.1", "Sh: 0.4, Sw: 0.6, Sg: 0")
    if changed.count("Sg: 0}") != 3:
        raise ValueError("the page's regions are not those that this changes")
    return changed


def photograph(report, figures, quantity):
    """A picture of each section, as a reader sees it; the film at the last time, of that quantity."""
    sys.path.insert(0, str(ROOT / "tests" / "integration"))
    import _browser

    page = _browser.Page(_browser.find(), f"file://{report}", 1240, 1000)
    page.ask(f"(e => {{ e.value = film.fields.findIndex(f => f.key === '{quantity}'); e.dispatchEvent(new Event('change')); }})(document.getElementById('quantity'))")
    page.ask("(e => { if (e.checked) e.click(); })(document.getElementById('arrows')); document.querySelector('nav').remove()")
    for name, section in figures.items():
        box = page.ask(f"(r => [r.x + scrollX, r.y + scrollY, r.width, r.height])(document.getElementById('{section}').getBoundingClientRect())")
        clip = dict(zip(("x", "y", "width", "height"), box), scale=0.8)
        picture = page.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
        (ROOT / "docs" / "figures" / f"tutorial_{name}.png").write_bytes(base64.b64decode(picture))
        print(f"  docs/figures/tutorial_{name}.png")
    page.close()


def pictured(program, folder, text, figures, quantity, options=()):
    """Runs a case in a folder of its own and takes its pictures, {name: section of the report}."""
    case = folder / "tutorial.yaml"
    folder.mkdir(parents=True, exist_ok=True)
    case.write_text(text)
    clathra.Case(case, program).run(folder, options=options, restart=(folder / "checkpoint.h5").is_file())
    report.main([str(folder)])
    photograph(folder / "report.html", figures, quantity)


def main(program, folder=ROOT / "results" / "tutorial"):
    folder = Path(folder).resolve()
    pictured(program, folder, case_text(), {"scene": "s-scene"}, "S_h")
    pictured(program, folder / "fine", case_text(), {"film": "s-film", "production": "s-production"}, "S_h", FINE)
    pictured(program, folder / "heater", powered(case_text()), {"heater": "s-film"}, "T")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
