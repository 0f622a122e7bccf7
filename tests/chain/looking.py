"""What `drumlin plot` and `drumlin export` leave of small runs of every kind: figures that are not blank, files that ParaView's rules hold for.

usage: looking.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import json
import pathlib
import sys
import tempfile

import matplotlib.image

from command import Drumlin, read_json, require

GRAINS = """
[grains]
density_kg_m3 = 2700
[grains.generated]
count = {count}
diameter_min_mm = 3
diameter_max_mm = 4
region = {{ shape = "rectangle", min_mm = [2, 3], max_mm = [28, 40] }}
"""

# A disc that falls: no friction, no spin, one wall.
ONE_DISC = 'format = "drumlin-scene-1"\ntitle = "One disc"\n' + GRAINS.format(count=1) + """
[[walls]]
name = "floor"
shape = "segment"
from_mm = [-1000, 0]
to_mm = [1000, 0]
[effects.gravity]
[[stages]]
name = "fall"
duration_s = 0.1
time_step_s = 1e-3
snapshots = 2
"""

# Contacts across the seam, glued discs that move, forces that pull.
PERIODIC = 'format = "drumlin-scene-1"\ntitle = "Shaken floor"\nreduced = true\n' + GRAINS.format(count=50) + """
[periodic_x]
x_min_mm = 0
x_max_mm = 30
[[walls]]
name = "floor"
shape = "segment"
from_mm = [0, 0]
to_mm = [30, 0]
rough = { diameter_mm = 3, spacing_mm = 4 }
[effects.gravity]
[effects.friction]
grain_grain = 0.4
grain_wall = 0.4
[effects.cohesion]
grain_grain = 2
grain_wall = 2
[effects.spin]
[[stages]]
name = "shaken"
duration_s = 0.2
time_step_s = 1e-3
snapshots = 5
motions = [{ wall = "floor", kind = "oscillation", amplitude_mm = [0, 2], frequency_hz = 5 }]
"""

# Nothing to look at but the log.
NO_SNAPSHOTS = ONE_DISC.replace("snapshots = 2", "snapshots = 0")


def made_run(drumlin, folder, name, text):
    scene = folder / f"{name}.toml"
    scene.write_text(text, encoding="utf-8")
    drumlin("run", scene, "-o", folder / name)
    return folder / name


def require_figure(file):
    """More than one colour beside white on at least a hundredth of the picture."""
    pixels = matplotlib.image.imread(file)[:, :, :3]
    marked = pixels.min(axis=2) < 0.95
    require(min(pixels.shape[:2]) > 150, f"{file}: too small, {pixels.shape}")
    require(marked.mean() > 0.005, f"{file}: all but blank")
    require(len({tuple(colour) for colour in (pixels[marked][::7] * 8).astype(int)}) > 3, f"{file}: of one colour")


def require_plots(folder, expected):
    drawn = read_json(folder / "plots.json")
    require(sorted(drawn["figures"]) == sorted(expected), f"{folder}: {drawn['figures']} instead of {expected}")
    require(sorted(path.name for path in folder.iterdir()) == sorted([*expected, "plots.json"]),
            f"{folder}: other files than it names")
    for name in expected:
        if name.endswith(".png"):
            require_figure(folder / name)
    return drawn


def frames_of_gif(file):
    data = file.read_bytes()
    require(data[:6] == b"GIF89a" and data[-1:] == b"\x3b", f"{file}: no whole GIF")
    return data.count(b"\x21\xf9\x04")  # one graphic control extension per frame


def plots(drumlin, one_disc, periodic, none, folder):
    drumlin("plot", periodic, "--animation", "--snapshot", "3")
    drawn = require_plots(periodic / "plots",
                          ["speed.png", "spin.png", "forces.png", "log.png", "time.png", "animation.gif"])
    require(drawn["reduced"] is True and drawn["snapshot"] == 3, f"{drawn}: not what was asked for")
    frames = frames_of_gif(periodic / "plots" / "animation.gif")
    require(frames == 5, f"{frames} frames of 5 snapshots")
    text, _ = drumlin("plot", periodic, "--resume")
    require("done already" in text, f"drawn again: {text}")

    # A run without spin has no picture of it; one that goes on is drawn as far as it went, its last line cut.
    report = json.loads((one_disc / "run.json").read_text(encoding="utf-8"))
    (one_disc / "run.json").write_text(json.dumps(report | {"status": "running"}), encoding="utf-8")
    log = one_disc / "log.csv"
    log.write_bytes(log.read_bytes()[:-7])
    text, _ = drumlin("plot", one_disc, "-o", folder / "elsewhere")
    require("unfinished" in text, f"nothing said of an unfinished run: {text}")
    require_plots(folder / "elsewhere", ["speed.png", "forces.png", "log.png", "time.png"])

    drumlin("plot", none)
    require_plots(none / "plots", ["log.png", "time.png"])


def refusals(drumlin, one_disc, none, folder):
    (folder / "no-run").mkdir()
    damaged = folder / "damaged"
    damaged.mkdir()
    for name in ("run.json", "scene.toml", "log.csv"):
        (damaged / name).write_bytes((one_disc / name).read_bytes())
    (damaged / "snapshots").mkdir()
    (damaged / "snapshots" / "000001.h5").write_bytes((one_disc / "snapshots" / "000001.h5").read_bytes()[:-9])
    for words in (["plot", folder / "no-run"], ["plot", folder / "missing"], ["plot", one_disc / "run.json"],
                  ["plot", one_disc, "--snapshot", "3"], ["plot", one_disc, "--snapshot", "first"],
                  ["plot", none, "--snapshot", "1"], ["plot", none, "--animation"], ["plot", damaged],
                  ["plot", one_disc, "-o", one_disc], ["plot", one_disc, "-o", one_disc, "--overwrite"]):
        _, said = drumlin(*words, code=2)
        require(said.strip(), f"{words} was refused without a word")
    require(not (one_disc / "plots").exists() and not (damaged / "plots").exists(), "a refusal left an output")


def main():
    drumlin = Drumlin(sys.argv[1])
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        one_disc, periodic, none = (made_run(drumlin, folder, *run) for run in
                                    (("one", ONE_DISC), ("periodic", PERIODIC), ("none", NO_SNAPSHOTS)))
        refusals(drumlin, one_disc, none, folder)
        plots(drumlin, one_disc, periodic, none, folder)
    print("figures drawn, not blank; what cannot be drawn refused")


if __name__ == "__main__":
    main()
