"""What a player costs: its size, and the processor time of opening it and of drawing a frame in a headless Chromium.

usage: python3 tests/benchmarks/player.py DRUMLIN player.html RECORD.json

Chromium draws without a graphics card here, which is the slowest that a reader will have. Processor time is that of all processes of the browser.
"""

import glob
import os
import pathlib
import subprocess
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "chain"))

import browser  # noqa: E402  (it lies there)
from records import machine, write  # noqa: E402

FRAMES = 100
PLAYED = ("(async () => {{ const from = performance.now(); for (let k = 0; k < {0}; k++) {{ goTo(k % run.frames.length); await new Promise(requestAnimationFrame); }}"
          " return (performance.now() - from) / {0}; }})()").format(FRAMES)


def processor_seconds(session):
    """Of all processes of the session that the browser leads."""
    ticks = 0
    for file in glob.glob("/proc/[0-9]*/stat"):
        try:
            fields = pathlib.Path(file).read_text(encoding="utf-8").rsplit(")", 1)[1].split()
        except OSError:  # it has ended since
            continue
        if int(fields[3]) == session:
            ticks += int(fields[11]) + int(fields[12])
    return ticks / os.sysconf("SC_CLK_TCK")


def drawn(page):
    pause = "new Promise(r => setTimeout(r, 500))"
    page.value(pause)
    before = processor_seconds(page.process.pid)
    wall = page.value(PLAYED)
    page.value(pause)
    return {"processor_ms": round(1e3 * (processor_seconds(page.process.pid) - before) / FRAMES, 1), "wall_ms": round(wall, 1)}


def main():
    drumlin, file, record = sys.argv[1], pathlib.Path(sys.argv[2]).resolve(), pathlib.Path(sys.argv[3])
    program = browser.executable()
    if program is None:
        sys.exit("no Chromium is installed")
    load = os.getloadavg()[0]
    with browser.Browser(program, 1280, 800) as page:
        page.open(file.as_uri())
        page.wait_for("document.getElementById('message') !== null && document.getElementById('message').hidden")
        opened = processor_seconds(page.process.pid)
        content = page.value("({ title: run.content.title, reduced: run.content.reduced, frames: run.frames.length, grains: run.content.count,"
                             " contacts_mean: run.frames.reduce((sum, f) => sum + f.a.length + f.wallGrain.length, 0) / run.frames.length })")
        plain = drawn(page)
        page.value("toggleChains()")
        chains = drawn(page)
        version = page.call("Browser.getVersion")["product"]
    revision = subprocess.run([drumlin, "--version"], capture_output=True, text=True, check=True).stdout.split()[3].rstrip(",")
    write(record, {"format": "drumlin-player-cost-1", "command": "tests/benchmarks/player.py DRUMLIN player.html RECORD.json"} | content | {
        "bytes": file.stat().st_size, "opening_processor_seconds": round(opened, 2), "frame": plain, "frame_with_force_chains": chains,
        "window": "1280 x 800", "browser": version, "load_before": load, "provenance": {"revision": revision} | machine()})


if __name__ == "__main__":
    main()
