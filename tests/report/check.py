"""report.html in a browser: check.py CHROMIUM SPINNEB CONFIGS [PICTURES]. Draws, moves, plays, is steered by keys alone and read aloud."""

import csv
import json
import os
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from browser import Browser  # noqa: E402

CHROMIUM, SPINNEB, CONFIGS = sys.argv[1:4]
PICTURES = sys.argv[4] if len(sys.argv) > 4 else None
HOSTILE = '</script><script>window.hurt = 1</script><img src=x onerror="window.hurt = 2"> & \u2028 \u2029 \' " `${1}` {{data}} <!--'


def page(folder, name, config, *sets):
    """Runs a config; the page of its result."""
    out = os.path.join(folder, name)
    command = [SPINNEB, "run", config, "--out", out, "--quiet", "--set", 'output={"formats":["html","spins_csv"],"plots":[]}']
    done = subprocess.run(command + [word for change in sets for word in ("--set", change)], capture_output=True, text=True)
    assert done.returncode in (0, 3), done.stderr
    return os.path.join(out, "report.html")


def landscape(folder, name):
    """The page of a shipped landscape."""
    out = os.path.join(folder, f"{name}_landscape")
    command = [SPINNEB, "landscape", os.path.join(CONFIGS, "landscapes", f"{name}.json"), "--out", out, "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return os.path.join(out, "report.html")


def keep(name):
    return os.path.join(PICTURES, f"{name}.png") if PICTURES else None


def quiet(browser):
    found = browser.complaints()
    assert not found, found


def where(browser):
    """Places of the marker and of the slider, and what is said."""
    return browser.run("[Number(document.querySelector('#marker').getAttribute('cx')), Number(document.querySelector('#slider').value), document.querySelector('#where').textContent]")


def draws(browser, pages):
    """Every page, in light and dark, on a desk and on a phone: no complaint, no request, something to see, nothing too wide."""
    for name, file in pages.items():
        lightness = {}
        windows = [("light", 1280, 900, False), ("dark", 400, 860, True), ("dark", 1280, 900, False), ("light", 320, 700, True)]
        for theme, width, height, phone in windows if name == "wall_nucleation" else windows[:2]:
            browser.open(file, width, height, phone=phone, prefers_color_scheme=theme)
            quiet(browser)
            title = f"{name}_{theme}_{width}"
            assert browser.picture("#frame").colours() > 100, f"{title}: the spins are not drawn"
            lightness[theme, width] = browser.picture(keep=keep(title)).mean()
            wide = browser.run("document.documentElement.scrollWidth - document.documentElement.clientWidth")
            assert wide <= 0, f"{title}: {wide} pixels too wide"
            assert browser.run("document.querySelector('#chart svg').childElementCount") > 20, title
        assert lightness["light", 1280] > 180 and lightness["dark", 400] < 80, lightness


def slides(browser, file):
    """Slider, marker, spins and words go together; a press on the profile moves them too."""
    browser.open(file)
    left, top, width, height = browser.box("#chart")
    browser.run("document.querySelector('#slider').focus()")
    browser.press("Home")
    browser.settle()
    start, first = where(browser), browser.picture("#frame")
    assert start[1] == 0 and "initial state" in start[2], start
    browser.press("End")
    browser.settle()
    end, last = where(browser), browser.picture("#frame")
    assert end[1] == 2000 and "final state" in end[2] and end[0] > start[0] + 0.7 * width, end
    assert first.differs(last) > 0.03, "the spins do not follow the slider"
    for _ in range(20):
        browser.press("ArrowLeft")
    assert where(browser)[1] == 1800, where(browser)
    browser.mouse((left + start[0] + 0.25 * (end[0] - start[0]), top + 60))
    browser.settle()
    pressed = where(browser)
    assert abs(pressed[1] - 500) <= 5 and abs(pressed[0] - (start[0] + 0.25 * (end[0] - start[0]))) < 2, pressed
    assert browser.picture("#frame").differs(first) > 0.01
    assert pressed[2] in browser.run("document.querySelector('#live').textContent"), "the press is not said aloud"
    browser.mouse((left + start[0] + 5, top + 60), (left + 200, top + 60), (left + end[0] + 90, top + 60))
    assert where(browser)[1] == 2000
    quiet(browser)


def numbers(browser, file):
    """The spins in the page are those of the files."""
    browser.open(file)
    browser.run("document.querySelector('#spins-table').open = true; document.querySelector('#slider').focus()")
    browser.press("Home")
    for _ in range(7):
        browser.press("PageUp")
    browser.settle(0.6)
    cells = browser.run("[...document.querySelectorAll('#spins-table tbody tr')].map(row => [...row.cells].slice(0, 4).map(cell => Number(cell.textContent.replace('−', '-'))))")
    with open(os.path.join(os.path.dirname(file), "spins.csv"), newline="") as text:
        rows = list(csv.DictReader(line for line in text if not line.startswith("#")))
    wanted = [[float(row[key]) for key in ("site", "m_x", "m_y", "m_z")] for row in rows if row["image"] == "7"]
    assert len(cells) == len(wanted) > 0
    worst = max(abs(a - b) for found, true in zip(cells, wanted) for a, b in zip(found, true))
    assert worst < 1e-3, f"a component is off by {worst}"


def steers(browser, file):
    """Keys, buttons, mouse and wheel turn and zoom the picture; 0 brings it back."""
    browser.open(file)
    browser.run("document.querySelector('#view').focus()")
    home = browser.picture("#frame")
    for keys in [["ArrowLeft"] * 5, ["ArrowUp"] * 4, ["+"] * 3]:
        for key in keys:
            browser.press(key)
        browser.settle()
        assert browser.picture("#frame").differs(home) > 0.01, keys
        browser.press("0")
        browser.settle(0.7)
    home = browser.picture("#frame")
    left, top, width, height = browser.box("#view")
    middle = (left + width / 2, top + height / 2)
    browser.mouse(middle, (middle[0] + 60, middle[1]), (middle[0] + 160, middle[1] + 40))
    browser.settle()
    assert browser.picture("#frame").differs(home) > 0.01, "a drag does not turn"
    browser.press("0")
    browser.settle(0.7)
    browser.mouse(middle, wheel=-400)
    browser.settle()
    assert browser.picture("#frame").differs(home) > 0.01, "the wheel does not zoom"
    for view in ["side", "top", "end"]:
        browser.run(f"document.querySelector('[data-view={view}]').click()")
        browser.settle(0.7)
        shown = browser.picture("#frame", keep=keep(f"view_{view}"))
        assert shown.colours() > 100 and shown.differs(home) > 0.01, view
    for colours in ["z", "x", "hsl"]:
        browser.run(f"(c => {{ c.value = '{colours}'; c.dispatchEvent(new Event('change')); }})(document.querySelector('#colours'))")
        browser.settle()
        after = browser.picture("#frame")
        assert after.differs(shown) > 0.001, colours
        shown = after
    quiet(browser)


def plays(browser, file):
    """Play goes on, pause stays; where motion is not wanted it goes from image to image."""
    browser.open(file, prefers_reduced_motion="no-preference")
    assert where(browser) == where(browser), "it moves without being asked"
    browser.run("document.querySelector('#slider').focus()")
    browser.press("Home")
    browser.run("document.querySelector('#play').focus()")
    browser.press(" ")
    browser.settle(1)
    one = where(browser)[1]
    browser.settle(0.5)
    two = where(browser)[1]
    assert 0 < one < two, (one, two)
    assert browser.run("document.querySelector('#play').getAttribute('aria-label')") == "Pause"
    browser.press(" ")
    browser.settle(0.2)
    rest = where(browser)
    browser.settle(0.5)
    assert where(browser) == rest and rest[2] in browser.run("document.querySelector('#live').textContent")
    browser.open(file, prefers_reduced_motion="reduce")
    browser.run("document.querySelector('#slider').focus()")
    browser.press("Home")
    browser.run("(s => { s.value = '4'; })(document.querySelector('#speed'))")
    browser.run("document.querySelector('#play').click()")
    steps = set()
    for _ in range(25):
        browser.settle(0.02)
        steps.add(where(browser)[2])
    assert len(steps) > 2 and not any("." in step.split("image ")[-1].split(" of")[0] for step in steps if "image" in step), steps
    quiet(browser)


def shows_lattices(browser, film, crystal, large):
    """A film with its spins at their places, seen from above as its map; a crystal layer by layer; of many sites discs, close up arrows."""
    choose = "((id, value) => {{ const c = document.querySelector(id); c.value = value; c.dispatchEvent(new Event('change')); }})('{0}', '{1}')"
    for file in (film, crystal, large):
        browser.open(file)
        quiet(browser)
        assert browser.run("document.querySelector('#layout').parentElement.hidden && !document.querySelector('#marks-choice').hidden")
        assert browser.run("document.querySelector('#chart svg image')") is None, "the map is that of a chain"
        assert "Charge" in browser.run("document.querySelector('#chart svg').textContent")
        assert "cells" in browser.run("document.querySelector('#subject').textContent")
    browser.open(film)
    shown = {}
    for marks in ["arrows", "discs"]:
        browser.run(choose.format("#marks", marks))
        browser.run("document.querySelector('[data-view=top]').click()")
        browser.settle(0.7)
        shown[marks] = browser.picture("#frame", keep=keep(f"film_{marks}"))
        assert shown[marks].colours() > 100, marks
    assert shown["arrows"].differs(shown["discs"]) > 0.02
    browser.open(crystal)
    whole = browser.picture("#frame")
    layers = browser.run("[...document.querySelector('#layer').options].map(o => o.value)")
    assert len(layers) == 5, layers
    browser.run(choose.format("#layer", layers[2]))
    browser.settle()
    assert browser.picture("#frame", keep=keep("crystal_layer")).differs(whole) > 0.02
    browser.open(large)
    far = browser.picture("#frame", keep=keep("large_far"))
    browser.run("document.querySelector('#spins-table').open = true")
    browser.settle(0.6)
    assert browser.run("document.querySelectorAll('#spins-table tbody tr').length") == 2000
    for _ in range(12):
        browser.run("document.querySelector('#zoom-in').click()")
    browser.settle()
    assert browser.picture("#frame", keep=keep("large_near")).differs(far) > 0.05
    quiet(browser)


def shows_landscapes(browser, chain, film):
    """A network whose discs and lines show their spins when they are clicked or chosen by keys; nothing too wide on a phone."""
    for name, file in {"landscape_chain": chain, "landscape_film": film}.items():
        for theme, width, height, phone in [("light", 1280, 900, False), ("dark", 400, 860, True)]:
            browser.open(file, width, height, phone=phone, prefers_color_scheme=theme)
            quiet(browser)
            assert browser.picture("#frame").colours() > 100, f"{name}: the spins are not drawn"
            assert browser.picture(keep=keep(f"{name}_{theme}_{width}"))
            wide = browser.run("document.documentElement.scrollWidth - document.documentElement.clientWidth")
            assert wide <= 0, f"{name}: {wide} pixels too wide"
        browser.open(file)
        first = browser.picture("#frame")
        assert browser.run("document.querySelector('#where').textContent").startswith("Minimum 0"), name
        discs, arcs = browser.run("[document.querySelectorAll('#network circle').length, document.querySelectorAll('#network .arc').length]")
        counted = [int(n) for n in browser.run("[...document.querySelectorAll('#answer .big')].slice(0, 2).map(e => e.textContent)")]
        assert discs == counted[0] and 0 < arcs <= counted[1], (name, discs, arcs, counted)
        left, top, width, height = browser.box("#network g:last-of-type circle")
        browser.mouse((left + width / 2, top + height / 2), (left + width / 2, top + height / 2))
        browser.settle()
        told = browser.run("document.querySelector('#where').textContent")
        assert told.startswith("Minimum 0"), told
        browser.run("document.querySelector('#beside button').click()")
        browser.settle()
        told = browser.run("document.querySelector('#where').textContent")
        assert told.startswith("Saddle") and "above minimum" in told, told
        assert browser.picture("#frame", keep=keep(f"{name}_saddle")).differs(first) > 0.001, name
        assert browser.run("document.querySelectorAll('#network .chosen').length") == 1
        browser.run("document.querySelector('#network g:has(.arc)').focus()")
        browser.press("Enter")
        browser.settle()
        assert browser.run("document.querySelector('#network .chosen') === document.activeElement"), name
        browser.run("document.querySelector('#spins-table').open = true")
        browser.settle()
        assert browser.run("document.querySelectorAll('#spins-table tbody tr').length") > 10, name
        quiet(browser)


def is_for_all(browser, file):
    """Every control has a name and can be reached by the Tab key, and what has the focus shows it."""
    browser.open(file)
    browser.run("document.querySelector('.more').open = true")
    browser.call("Accessibility.enable")
    controls = {"button", "slider", "checkbox", "combobox", "application", "image", "region", "DisclosureTriangle"}
    nodes = [node for node in browser.call("Accessibility.getFullAXTree")["nodes"] if not node["ignored"]]
    found = [node for node in nodes if node["role"]["value"] in controls]
    nameless = [node["role"]["value"] for node in found if not node.get("name", {}).get("value")]
    assert len(found) > 25 and not nameless, nameless
    selector = "a[href], button, input, select, summary, [tabindex='0']"
    wanted = browser.run(f"[...document.querySelectorAll(\"{selector}\")].filter(e => e.checkVisibility() && !e.disabled).length")
    browser.run("document.activeElement.blur(); scrollTo(0, 0)")
    reached = set()
    for _ in range(wanted + 5):
        browser.press("Tab")
        reached.add(browser.run("[...document.querySelectorAll('*')].indexOf(document.activeElement)"))
        shown = browser.run("(e => e === document.body || e.id === 'view' || getComputedStyle(e).outlineStyle !== 'none')(document.activeElement)")
        assert shown, "the focus is not seen"
    body = browser.run("[...document.querySelectorAll('*')].indexOf(document.body)")
    assert len(reached - {body}) == wanted, (len(reached - {body}), wanted)
    assert browser.run("document.querySelectorAll('table caption').length") >= 3


def is_unhurt(browser, file):
    """Words of the config are words, whatever they look like."""
    browser.open(file)
    quiet(browser)
    assert browser.run("window.hurt") is None and browser.run("document.images.length") == 0
    assert browser.run("document.scripts.length") == 2
    for selector, text in [("#subject", HOSTILE), ("dl", HOSTILE), ("pre", json.dumps(HOSTILE, ensure_ascii=False))]:
        assert text in browser.run(f"document.querySelector('{selector}').textContent"), selector


def themes(browser, file):
    browser.open(file, prefers_color_scheme="light")
    light = browser.picture("#frame").mean()
    browser.run("(s => { s.value = 'dark'; s.dispatchEvent(new Event('change')); })(document.querySelector('#theme'))")
    browser.settle()
    assert browser.picture("#frame").mean() < light - 80 and browser.picture().mean() < 80


def main():
    with tempfile.TemporaryDirectory() as folder:
        config = lambda name: os.path.join(CONFIGS, f"{name}.json")  # noqa: E731
        hostile = os.path.join(folder, "hostile.json")
        with open(config("wall_nucleation")) as text:
            changed = json.load(text)
        toy = os.path.join(CONFIGS, changed["material"])
        with open(toy) as text:
            changed["material"] = {**json.load(text), "name": HOSTILE, "source": HOSTILE}
        with open(hostile, "w") as text:
            json.dump({**changed, "comment": [HOSTILE]}, text)
        long = os.path.join(folder, "long.json")
        with open(long, "w") as text:
            soft = [{"exchange": {"J": ["10 meV"]}}, {"anisotropy": {"K": "0.0002 meV", "axis": [0, 0, 1]}}]
            path = {"images": 15, "guess": {"sweep": {"from": "left"}}}
            unproven = {"refine": False, "certify": False}
            material = {"name": "soft", "moment": "2 mu_B", "energy": soft}
            json.dump({**changed, "material": material, "lattice": {"chain": {"sites": 3000}}, "path": path, "saddle": unproven}, text)
        pages = {name: page(folder, name, config(name)) for name in ["wall_nucleation", "antiferromagnet", "ring_nucleus", "permalloy_wire"]}
        pages["long"] = page(folder, "long", long)
        pages["short"] = page(folder, "short", config("wall_nucleation"), "lattice.chain.sites=2")
        pages["nowhere"] = page(folder, "nowhere", config("wall_nucleation"), "final.uniform.direction=[0.1,0,1]")
        # of lattices the pictures are looked at, not the answers
        def lattice(name, lattice, left="left", **more):
            path = {"images": 7, "guess": {"sweep": {"from": left}}}
            once = {"neb": {"max_evaluations": 1}, "saddle": {"refine": False, "certify": False}, "relax_ends": False}
            file = os.path.join(folder, f"{name}.json")
            with open(file, "w") as text:
                json.dump({**changed, "lattice": lattice, "path": path, **once, **more}, text)
            return page(folder, name, file)
        vacant = {"disc": {"center": [4, 4], "radius": 1}}
        pages["film"] = lattice("film", {"triangular": {"cells": [18, 16], "spacing": "0.3 nm", "vacant": vacant}})
        pages["crystal"] = lattice("crystal", {"cubic": {"cells": [7, 6, 4]}})
        pages["large_film"] = lattice("large_film", {"square": {"cells": [320, 20]}})
        first = pages["wall_nucleation"]
        landscapes = [landscape(folder, name) for name in ("pinned_walls", "island")]
        with Browser(CHROMIUM) as browser:
            checks = [(draws, pages), (slides, first), (numbers, first), (steers, first), (plays, first), (is_for_all, first),
                      (is_unhurt, page(folder, "hostile", hostile)), (themes, first), (shows_lattices, [pages[n] for n in ("film", "crystal", "large_film")]),
                      (shows_landscapes, landscapes),
                      (slides, pages["film"]), (steers, pages["crystal"])]
            for check, what in checks:
                check(browser, *what) if isinstance(what, list) else check(browser, what)
                print(f"report: {check.__name__}: as it should be", flush=True)
        with Browser(CHROMIUM, "--disable-3d-apis") as browser:
            draws(browser, {"flat": first, "flat_film": pages["film"]})
            slides(browser, first)
            steers(browser, first)
        print("report: the same without WebGL")


main()
