#!/usr/bin/python3
"""The tutorial's case and pictures: tutorial.py CLATHRA [FOLDER]

Puts the YAML blocks of docs/tutorial.md together, runs them into FOLDER (goes on there from a checkpoint; default: results/tutorial)
and takes the pictures of docs/figures/tutorial_*.png from its report, with a headless browser.
"""
import base64
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "tutorial.md"
FIGURES = {"scene": "s-scene", "film": "s-film", "production": "s-production"}  # picture: section of the report


def case_text():
    """The case of the page: its YAML blocks, one after the other."""
    return "\n".join(re.findall(r"^```yaml\n(.*?)^```", PAGE.read_text(), re.M | re.S))


def quoted(key):
    """A line of the page's last section, by its key."""
    return next(w for w in PAGE.read_text().split("`") if w.startswith(key + ":"))


def heated(text):
    """The case with the page's heater."""
    return text.replace("boundaries: [", "boundaries: [heater, ") + f"\n{quoted('bc_heater')}\n"


def tidal(text):
    """The case with the page's tide in place of the burden."""
    return text.replace("burden, well]", "floor, well]").replace("bc_burden", "#") + f"\n{quoted('ambient')}\n{quoted('bc_floor')}\n"


def without_gas(text):
    """The layers full of water, or of hydrate and water."""
    changed = text.replace("Sh: 0, Sw: 0.9, Sg: 0.1", "Sh: 0, Sw: 1, Sg: 0").replace("Sh: 0.4, Sw: 0.5, Sg: 0.1", "Sh: 0.4, Sw: 0.6, Sg: 0")
    if changed.count("Sg: 0}") != 3:
        raise ValueError("the page's regions are not those that this changes")
    return changed


def photograph(report):
    """A picture of each section, as a reader sees it; the film at the last time, hydrate chosen."""
    sys.path.insert(0, str(ROOT / "tests" / "integration"))
    import _browser

    page = _browser.Page(_browser.find(), f"file://{report}", 1240, 1000)
    page.ask("(e => { e.value = film.fields.findIndex(f => f.key === 'S_h'); e.dispatchEvent(new Event('change')); })(document.getElementById('quantity'))")
    page.ask("(e => { if (e.checked) e.click(); })(document.getElementById('arrows')); document.querySelector('nav').remove()")
    for name, section in FIGURES.items():
        box = page.ask(f"(r => [r.x + scrollX, r.y + scrollY, r.width, r.height])(document.getElementById('{section}').getBoundingClientRect())")
        clip = dict(zip(("x", "y", "width", "height"), box), scale=0.8)
        picture = page.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)["data"]
        (ROOT / "docs" / "figures" / f"tutorial_{name}.png").write_bytes(base64.b64decode(picture))
        print(f"  docs/figures/tutorial_{name}.png")
    page.close()


def main(program, folder=ROOT / "results" / "tutorial"):
    folder = Path(folder).resolve()
    case = folder / "tutorial.yaml"
    folder.mkdir(parents=True, exist_ok=True)
    case.write_text(case_text())
    go_on = ["-restart", folder / "checkpoint.h5"] if (folder / "checkpoint.h5").is_file() else []
    subprocess.run([program, case, "-output_dir", folder, *go_on], check=True)
    subprocess.run([sys.executable, ROOT / "scripts" / "report.py", folder], check=True)
    photograph(folder / "report.html")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
