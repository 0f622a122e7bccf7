"""The pace of the drum and of the shear cell in a headless Chromium, by number of discs.

usage: python3 tests/benchmarks/drum_in_browser.py DRUMLIN PAGE RECORD.json [DISCS ...]

PAGE: the folder page that apps/browser builds, at the revision of DRUMLIN. The engine works in one thread, drawing in another; Chromium draws
without a graphics card here. Seconds of a processor are those of all processes of the browser: frames per such second are what one core gives.
Grains first fall, turn and are measured for a while; what is shown then is counted.
"""

import os
import pathlib
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "chain"))

import browser  # noqa: E402  (it lies there)
from player import processor_seconds  # noqa: E402
from records import machine, write  # noqa: E402

BEFORE = {"drum": 1000, "shear": 1600}  # steps before
STEPS_A_FRAME, FRAMES = 10, 100
STEPPED = """(async () => {{ const from = performance.now(); for (let k = 0; k < {0}; k++) {{ await ask("step", {1}); show(await ask("picture"));
  await new Promise(requestAnimationFrame); if (k % 12 === 0) {{ shown.measured = await ask("measured"); tell(); }} }} return performance.now() - from; }})()"""


def pace(page, kind, discs):
    page.value(f"ask('play', false).then(() => ask('start', {{text: SCENES.{kind}, overrides: KINDS.{kind}.overrides({{discs: {discs}, fill: 0.5}})}}))"
               f".then(() => {{ shown.kind = '{kind}'; shown.picture = null; }})")
    page.value(f"ask('step', {BEFORE[kind]})")
    before = processor_seconds(page.process.pid)
    wall = page.value(STEPPED.format(FRAMES, STEPS_A_FRAME)) / 1000
    busy = processor_seconds(page.process.pid) - before
    before = processor_seconds(page.process.pid)
    page.value(f"ask('step', {FRAMES * STEPS_A_FRAME})")
    stepping = processor_seconds(page.process.pid) - before
    return {"scene": kind, "discs": discs, "time_step_s": page.value("ask('step_time')"), "frames_per_processor_second": round(FRAMES / busy, 1), "frames_per_second": round(FRAMES / wall, 1),
            "steps_per_processor_second": round(FRAMES * STEPS_A_FRAME / stepping)}


def main():
    drumlin, folder, record, *numbers = sys.argv[1:]
    program = browser.executable()
    if program is None:
        sys.exit("no Chromium is installed")
    load = os.getloadavg()[0]
    with browser.Browser(program, 1280, 800) as page:
        page.open((pathlib.Path(folder).resolve() / "index.html").as_uri())
        page.wait_for("typeof begun === 'object' && begun.then(() => true)")
        paces = [pace(page, kind, discs) for kind in ("drum", "shear") for discs in map(int, numbers or ["1000", "3000"])]
        version = page.call("Browser.getVersion")["product"]
    revision = subprocess.run([drumlin, "--version"], capture_output=True, text=True, check=True).stdout.split()[3].rstrip(",")
    write(pathlib.Path(record), {"format": "drumlin-browser-cost-1", "command": "tests/benchmarks/drum_in_browser.py DRUMLIN PAGE RECORD.json",
                   "steps_a_frame": STEPS_A_FRAME, "pace": paces,
                   "bytes": (pathlib.Path(folder) / "engine.js").stat().st_size, "window": "1280 x 800", "browser": version, "load_before": load,
                   "provenance": {"revision": revision} | machine()})


if __name__ == "__main__":
    main()
