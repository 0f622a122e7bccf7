"""The page with the engine in a headless Chromium: it takes the steps of the native program, measures what that measures, and its sliders do what they say.

usage: drum_in_browser.py DRUMLIN PAGE SCENES

PAGE: the folder page that apps/browser builds; SCENES: apps/browser. Python's package is the one beside the program.
"""

import json
import pathlib
import sys

import browser
from command import given, read_json, require

# Both compute the same sums in the same order; sine and cosine are those of two C libraries. Rounding of a place is 1e-14 d, and 200 steps of
# falling grains enlarge it by less than 1e4.
ROUNDING = 1e-10
STEPS = 200


def asked(page, name, value=None):
    return page.value(f"ask({json.dumps(name)}, {json.dumps(value)})")


def places(page):
    return page.value("ask('places').then(({x, z}) => [Array.from(x), Array.from(z)])")


def farthest(page, simulation):
    return max(abs(a - b) for ours, theirs in zip(places(page), (simulation.x, simulation.z), strict=True) for a, b in zip(ours, theirs, strict=True))


def started(page, kind, discs):
    """Without a step, as the page starts it; returns its overrides."""
    asked(page, "play", False)
    overrides = page.value(f"KINDS.{kind}.overrides({{discs: {discs}, fill: 0.5}})")
    page.value(f"ask('start', {{text: SCENES.{kind}, overrides: {json.dumps(overrides)}}}).then(() => 0)")
    return overrides


def takes_the_same_steps(page, package, scenes, kind):
    simulation = package.Simulation(str(scenes / f"{kind}.toml"), started(page, kind, 1000))
    asked(page, "step", STEPS)
    simulation.run(steps=STEPS)
    apart = farthest(page, simulation)
    print(f"{kind}: {apart:.2g} d apart after {STEPS} steps")
    require(len(simulation.x) == 1000 and apart < ROUNDING, f"{kind}: places differ by {apart} d after {STEPS} steps")
    asked(page, "set_friction", [0.2, 0.9])
    simulation.set_friction(0.2, 0.9)
    if kind == "drum":
        asked(page, "turn", ["drum", 25])
        simulation.set_wall("drum", spin=25 * 3.141592653589793 / 30 * simulation.scales["time_s"])
    asked(page, "step", 50)
    simulation.run(steps=50)
    apart = farthest(page, simulation)
    print(f"{kind}: {apart:.2g} d apart after 50 more, with another friction")
    require(apart < 10 * ROUNDING, f"{kind}: places differ by {apart} d after a change")


def measures_the_same(page, drumlin, scenes, folder):
    """The snapshots of a run at the same steps, by the command."""
    overrides = started(page, "drum", 250)
    asked(page, "step", 400)
    run = folder / "run"
    changes = [*overrides, "stages.0.duration_s=0.4", "stages.0.snapshots=20"]
    drumlin("run", scenes / "drum.toml", "-o", run, *(word for change in changes for word in ("--set", change)))
    drumlin("measure", run, "--parts", "none", "--no-figures")
    measured, live = read_json(run / "measured" / "measured.json"), asked(page, "measured")
    require(live["snapshots"] == 20, f"{live['snapshots']} snapshots")
    for name in ("theta_deg", "theta_com_deg", "surface_speed"):
        for part in ("value", "ci99"):
            theirs = measured[name][part]
            require(abs(live[name][part] - theirs) <= 1e-6 * abs(theirs), f"{name}: {part} {live[name][part]}, {theirs} of drumlin measure")


def moves_a_slider(page, name, value):
    page.value(f"(() => {{ const s = document.getElementById('{name}'); s.value = {value}; s.dispatchEvent(new Event('input'));"
               " s.dispatchEvent(new Event('change')); })()")


def lives(page):
    page.value("Object.assign($('discs'), {value: 500}) && choose('drum')")
    page.wait_for("shown.picture && shown.picture.steps > 400 && shown.measured && shown.measured.snapshots >= 20")
    require(page.value("shown.picture.grains.length") == 5 * 500, "not 500 discs")
    require(0 < page.value("parseFloat($('value-theta_deg').textContent)") < 60, "no slope of the surface is shown")
    require(page.value("shown.measured.v_x.length") > 5, "no profile")
    radius = page.value("shown.picture.radius")
    moves_a_slider(page, "fill", 25)
    page.wait_for(f"shown.picture && shown.picture.radius > 1.3 * {radius}")
    moves_a_slider(page, "speed", 30)
    page.wait_for("(async () => { const a = shown.picture; await new Promise(r => setTimeout(r, 300)); const b = shown.picture;"
                  " return b.seconds > a.seconds && Math.abs((b.angle - a.angle) / (b.seconds - a.seconds) - Math.PI) < 1e-6; })()")
    page.click(*page.middle_of("#play"))
    page.wait_for("!shown.playing && ask('picture').then(a => ask('picture').then(b => a.steps === b.steps))")
    page.click(*page.middle_of("#play"))
    page.click(*page.middle_of("#shear"))
    page.wait_for("shown.kind === 'shear' && shown.picture && shown.picture.cell && shown.picture.steps > 200")
    page.wait_for("parseFloat($('value-bulk_mu').textContent) > 0")
    refused = page.value("ask('set_friction', [-1, 0]).then(() => 'accepted', error => error.message)")
    require("grain_grain" in refused, f"a friction of -1: {refused}")


def main():
    with given() as (drumlin, folder_of_page, scenes, folder), browser.Browser(browser.executable()) as page:
        sys.path.insert(0, str(pathlib.Path(drumlin.executable).parent / "python"))
        import drumlin as package

        page.open((folder_of_page / "index.html").as_uri())
        page.wait_for("typeof begun === 'object' && begun.then(() => true)")
        for kind in ("drum", "shear"):
            takes_the_same_steps(page, package, scenes, kind)
        measures_the_same(page, drumlin, scenes, folder)
        lives(page)
        require(not page.faults(), f"{page.faults()}")
        foreign = [url for url in page.requests() if not url.startswith(("file:", "blob:", "data:"))]
        require(not foreign, f"asks for {foreign}")


if __name__ == "__main__":
    main()
