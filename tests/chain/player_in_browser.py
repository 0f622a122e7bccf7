"""The player in a headless Chromium: it unpacks what its file holds, and clicks, keys, mouse and fingers do what they say.

usage: player_in_browser.py DRUMLIN FOLDER_OF_THIS_TEST

Ends with 77, which CTest calls skipped, where no Chromium is installed (apt-get install chromium).
"""

import sys

import browser
from command import given, require
from looking import made_run
from player import EVIL, TRAFFIC
from player_file import Player

SKIPPED = 77
PIXELS = """(() => { const d = ctx.getImageData(0, 0, canvas.width, canvas.height).data; let sum = 0;
  for (let k = 0; k < d.length; k++) sum = (sum * 31 + d[k]) % 1000000007; return sum; })()"""
FRAME = "new Promise(r => requestAnimationFrame(() => requestAnimationFrame(() => r(0))))"


def pixels(page):
    """A sum of what the canvas shows, after it was drawn."""
    page.value(FRAME)
    return page.value(PIXELS)


def comes_true(page, expression, otherwise):
    """Input takes its way through the browser: what it does is waited for."""
    try:
        page.wait_for(expression)
    except TimeoutError:
        sys.exit(otherwise)


def opened(page, file):
    page.open(file.as_uri())
    page.wait_for("document.getElementById('message') !== null && document.getElementById('message').hidden")
    require(not page.faults(), f"{page.faults()}")


def on_screen(page, grain):
    """Where a grain of the shown frame is, in pixels of the page."""
    return page.value(f"(() => {{ const f = run.frames[shown.frame], b = canvas.getBoundingClientRect(); return"
                      f" [b.x + camera.toX(run.x(f, {grain})) / pixel, b.y + camera.toY(run.z(f, {grain})) / pixel]; }})()")


def unpacks(page, player):
    for k, frame in enumerate(player.frames):
        ids = page.value(f"Array.from(run.id).filter((_, g) => run.frames[{k}].there[g])")
        require(sorted(frame["grains"]) == ids, f"frame {k}: other grains in the browser")
        for name, expression in (("x", "run.x(f, g)"), ("z", "run.z(f, g)"), ("speed", "run.values('speed', k)[g]")):
            shown = page.value(f"(() => {{ const k = {k}, f = run.frames[k]; return Array.from(run.id, (_, g) => g).filter(g => f.there[g]).map(g => {expression}); }})()")
            # The exponential function of two programs differs in the last place; places are exact.
            most = max(abs(a - frame["grains"][i][name]) for a, i in zip(shown, ids))
            require(most <= (1e-12 if name == "speed" else 0), f"frame {k}: {name} differs by {most}")
        pairs = page.value(f"Array.from(run.frames[{k}].a, (a, n) => [run.id[a], run.id[run.frames[{k}].b[n]], run.force(run.frames[{k}].level[n])])")
        require({(a, b) for a, b, _ in pairs} == set(frame["pairs"]), f"frame {k}: other contacts in the browser")
        require(all(abs(force - frame["pairs"][a, b]) < 1e-9 for a, b, force in pairs), f"frame {k}: other forces in the browser")


def plays(page, count):
    first = pixels(page)
    page.click(*page.middle_of("#forward"))
    comes_true(page, "shown.frame === 1 && $('clock').textContent.includes('frame 2 of')", "a click does not change the frame")
    second = pixels(page)
    require(first != second, "another frame, the same pixels")
    page.click(*page.middle_of("#back"))
    comes_true(page, "shown.frame === 0", "no step back")
    require(pixels(page) == first, "one back is not the frame before")
    page.key("ArrowRight")
    comes_true(page, "shown.frame === 1", "the key does nothing")
    require(pixels(page) == second, "the key is not the button")
    page.key("End")
    comes_true(page, f"shown.frame === {count - 1}", "End is not the last frame")
    left, top, width, height = page.value("(() => { const b = $('scrub').getBoundingClientRect(); return [b.x, b.y, b.width, b.height]; })()")
    page.click(left + 0.5 * width, top + 0.5 * height)
    comes_true(page, f"0 < shown.frame && shown.frame < {count - 1}", "the slider does not move the frame")
    page.key("Home")
    comes_true(page, "shown.frame === 0", "Home is not the first frame")
    page.click(*page.middle_of("#play"))
    page.wait_for("shown.frame >= 2")
    page.key(" ", "Space", " ")
    comes_true(page, "!shown.playing", "the space bar does not pause")
    page.key("Home")
    comes_true(page, "shown.frame === 0", "Home is not the first frame")


def shows(page):
    seen = {pixels(page)}
    for name in page.value("run.content.fields.map(f => f.name)")[1:]:
        page.key("c")
        comes_true(page, f"shown.field.name === '{name}'", f"not {name}")
        seen.add(pixels(page))
        require(page.value("document.getElementById('legend').textContent.length") > 3, f"no legend for {name}")
    require(len(seen) == page.value("run.content.fields.length"), "two fields of the same colours")
    page.key("c")
    comes_true(page, "shown.field === run.content.fields[0]", "after the last field comes no first")
    plain = pixels(page)
    page.click(*page.middle_of("#chains"))
    comes_true(page, "shown.chains && $('chains').getAttribute('aria-pressed') === 'true'", "no force chains")
    require(pixels(page) != plain, "force chains without a line")
    page.key("f")
    comes_true(page, "!shown.chains", "force chains stay")
    require(pixels(page) == plain, "force chains stay")


def follows(page):
    grain = page.value("run.frames[0].there.findIndex(t => t)")
    page.click(*on_screen(page, grain))
    comes_true(page, f"shown.grain === {grain} && !$('grain').hidden", "a click on a grain does not follow it")
    comes_true(page, f"$('grain').textContent.includes('Grain ' + run.id[{grain}])", "its number is not shown")
    page.key("k")
    comes_true(page, "shown.middle", "it is not kept in the middle")
    page.value(FRAME)
    require(page.value(f"Math.hypot(camera.toX(run.x(run.frames[shown.frame], {grain})) - camera.width / 2, "
                       f"camera.toY(run.z(run.frames[shown.frame], {grain})) - camera.height / 2)") < 1, "it is not in the middle")
    before = page.value("camera.scale")
    x, y = page.middle_of("#picture")
    page.call("Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=-200)
    page.wait_for(f"camera.scale > {before}")
    page.key("Escape")
    comes_true(page, "$('grain').hidden && shown.grain === null", "it is not let go")


def fits_a_phone(page):
    require(page.value("document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight"),
            "wider or higher than the screen")
    for name in ("play", "back", "forward", "scrub", "field", "chains", "pace", "fit", "open-help"):
        right, bottom, height = page.value(f"(() => {{ const b = $('{name}').getBoundingClientRect(); return [b.right, b.bottom, b.height]; }})()")
        require(right <= 390 and bottom <= 844 and height >= 28, f"{name}: off the screen, or too small for a finger")
    page.tap(*page.middle_of("#forward"))
    page.wait_for("shown.frame === 1")
    grain = page.value("run.frames[1].there.findIndex(t => t)")
    page.tap(*on_screen(page, grain))
    page.wait_for(f"shown.grain === {grain}")
    x, y = page.middle_of("#picture")
    before = page.value("camera.scale")
    for kind, apart in (("touchStart", 40), ("touchMove", 60), ("touchMove", 90), ("touchMove", 120)):
        page.call("Input.dispatchTouchEvent", type=kind, touchPoints=[{"x": x - apart, "y": y - 60, "id": 1}, {"x": x + apart, "y": y - 60, "id": 2}])
    page.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])
    page.wait_for(f"camera.scale > 1.5 * {before}")
    require(page.value("shown.grain") == grain, "two fingers let the grain go")


def main():
    program = browser.executable()
    if program is None:
        print("skipped: no Chromium is installed")
        sys.exit(SKIPPED)
    with given() as (drumlin, _, folder):
        # Grains that lie, come and go, spin and rub.
        scene = TRAFFIC.replace("Grains that come and go", EVIL).replace("[effects.gravity]", "[effects.gravity]\n[effects.spin]\n[effects.friction]\n"
                                                                        "grain_grain = 0.4\ngrain_wall = 0.4")
        run = made_run(drumlin, folder, "run", scene.replace("[[outlets]]", '[[walls]]\nname = "sill"\nshape = "segment"\nfrom_mm = [0, 0]\nto_mm = [20, 0]\n[[outlets]]'))
        drumlin("plot", run, "--player")
        file = run / "plots" / "player.html"
        player = Player(file)
        with browser.Browser(program) as page:
            opened(page, file)
            require(page.value("document.title") == EVIL and page.value("document.querySelector('h1').textContent") == EVIL, "the title became a part of the page")
            unpacks(page, player)
            plays(page, len(player.frames))
            shows(page)
            follows(page)
            require(not page.faults() and set(page.requests()) == {file.as_uri()}, f"{page.faults()} {page.requests()}")
        with browser.Browser(program, 390, 844, 3, touch=True) as page:
            opened(page, file)
            fits_a_phone(page)
            require(not page.faults(), f"{page.faults()}")
    print("the player plays, on a desktop and on a phone")


if __name__ == "__main__":
    main()
