"""The player of `drumlin plot --player` holds what the snapshots hold, within the quanta that it states, and asks for nothing else.

usage: player.py DRUMLIN FOLDER_OF_THIS_TEST
"""

import math
import re

import h5py
import numpy

from command import SHORT_RUN, given, read_json, require
from looking import NO_SNAPSHOTS, PERIODIC, made_run
from player_file import Player

# Names that would end a script or a title, were they not escaped.
EVIL = "</script><script>alert('x')</script> </title> & <b>"

GRAINS = """
[grains]
density_kg_m3 = 2700
[grains.generated]
count = 40
diameter_min_mm = 3
diameter_max_mm = 4
region = {{ shape = "rectangle", min_mm = {low}, max_mm = {high} }}
"""

# Grains that come and go, of two materials; a container that does not turn.
TRAFFIC = 'format = "drumlin-scene-1"\ntitle = "Grains that come and go"\n' + GRAINS.format(low=[2, 20], high=[28, 50]) + """
[[walls]]
name = "left"
shape = "segment"
from_mm = [0, -20]
to_mm = [0, 80]
[[walls]]
name = "right"
shape = "segment"
from_mm = [30, -20]
to_mm = [30, 80]
[[outlets]]
name = "below"
region = { shape = "rectangle", min_mm = [-5, -40], max_mm = [35, -5] }
returns_to = { shape = "rectangle", min_mm = [3, 60], max_mm = [27, 75] }
[effects.gravity]
[[stages]]
name = "fall"
duration_s = 0.3
time_step_s = 1e-3
snapshots = 12
"""

# A cell that is sheared: images above are displaced.
CELL = 'format = "drumlin-scene-1"\ntitle = "Sheared cell"\n' + GRAINS.format(low=[0, 0], high=[30, 30]) + """
[periodic_x]
x_min_mm = 0
x_max_mm = 30
[periodic_z]
z_min_mm = 0
z_max_mm = 30
[effects.friction]
grain_grain = 0.4
grain_wall = 0.4
[[stages]]
name = "shear"
duration_s = 0.2
time_step_s = 5e-4
snapshots = 6
cell = { zz = { pressure_n_m2 = 270 }, shear_rate_per_s = 17.84 }
"""


def require_same(player, k, file):
    """Frame k is the snapshot of the file: places (but for whole periods), spins, speeds, forces of the same contacts."""
    content, frame = player.content, player.frames[k]
    grains, quantum = frame["grains"], content["quantum"]
    with h5py.File(file) as snapshot:
        found = {name: values[:] for name, values in snapshot["grains"].items()}
        contacts = {name: values[:] for name, values in snapshot["contacts"].items()}
        force = contacts["impulse_n"] / snapshot["time_step"][()]
        spin, center = snapshot["wall/spin"][()], (snapshot["container/x"][()], snapshot["container/z"][()])
        spin = spin if snapshot["container/radius"][()] > 0 else 0
        cell = {name: values[()] for name, values in snapshot["cell"].items()} if "cell" in snapshot else None
        length = snapshot["period_x"][()]
    ids = [int(i) for i in found.get("id", numpy.arange(len(found["x"])))]
    require(sorted(grains) == ids, f"{file}: other grains")
    for n, i in enumerate(ids):
        grain = grains[i]
        off = [grain["x"] - found["x"][n], grain["z"] - found["z"][n]]
        if cell is not None:
            rows = round(off[1] / cell["height"])
            off = [off[0] - rows * cell["offset"], off[1] - rows * cell["height"]]
        if length > 0:
            off[0] -= length * round(off[0] / length)
        require(max(map(abs, off)) <= 0.5 * quantum * (1 + 1e-9) + 1e-9, f"{file}: grain {i} is {off} d off, quantum {quantum}")
        require(abs(grain["radius"] - found["radius"][n]) < 1e-6, f"{file}: radius of {i}")
        if "spin" in found:
            require(abs(grain["spin"] - found["spin"][n]) <= 0.5001 * content["spin"]["quantum"], f"{file}: spin of {i}")
        speed = math.hypot(found["v_x"][n] - spin * (found["z"][n] - center[1]), found["v_z"][n] + spin * (found["x"][n] - center[0]))
        if grain["slow"]:
            require(speed < content["speed"]["low"] * math.exp(0.51 * content["speed"]["step"]), f"{file}: {i} is not slow")
        else:
            require(abs(math.log(speed / grain["speed"])) <= 0.5001 * content["speed"]["step"], f"{file}: speed of {i}: {speed}, {grain['speed']}")

    if cell is None:
        x, z, radius = (found[name].astype(float) for name in ("x", "z", "radius"))
        apart = x[:, None] - x
        apart -= length * numpy.round(apart / length) if length > 0 else 0
        deep = numpy.triu(radius[:, None] + radius - numpy.hypot(apart, z[:, None] - z), 1)
        told = {tuple(sorted((player.id[a], player.id[b]))): depth for depth, a, b in content["overlaps"][k] if b >= 0}
        expected = {tuple(sorted((ids[i], ids[j]))): deep[i, j] for i, j in zip(*numpy.nonzero(deep > 1e-3))}
        require(told.keys() == expected.keys() and all(abs(told[pair] - expected[pair]) < 1e-5 for pair in told), f"{file}: {told}, not {expected}")

    def level(value):
        return math.sqrt(abs(value) / content["mean_force"]) * content["force_steps"]

    pairs, walls = {}, []
    for n, (i, j) in enumerate(zip(contacts["i"], contacts["j"])):
        if j >= 0:
            pair = min(ids[i], ids[j]), max(ids[i], ids[j])
            pairs[pair] = pairs.get(pair, 0) + force[n]
        else:
            walls.append((ids[i], force[n], math.atan2(-contacts["normal_z"][n], -contacts["normal_x"][n])))
    require(set(pairs) == set(frame["pairs"]), f"{file}: other contacts")
    for pair, value in pairs.items():
        kept = frame["pairs"][pair]
        require(abs(level(value) - level(kept)) < 0.5001 and (kept == 0 or kept * value > 0), f"{file}: force of {pair}: {value}, {kept}")
    walls.sort(key=lambda contact: contact[0])
    require([w[0] for w in walls] == [w[0] for w in frame["wall_contacts"]], f"{file}: other contacts with walls")
    for (_, value, angle), (_, kept, direction) in zip(walls, frame["wall_contacts"]):
        off = (angle - direction + math.pi) % (2 * math.pi) - math.pi
        require(abs(level(value) - level(kept)) < 0.5001 and abs(off) <= 1.001 * math.pi / content["angles"], f"{file}: contacts with walls")


def require_player(run, folder, count):
    player = Player(folder / "player.html")
    numbers = player.content["number"]
    require(len(numbers) == count == len(player.frames), f"{folder}: {numbers}")
    for k, number in enumerate(numbers):
        file = run / "snapshots" / f"{number:06}.h5"
        with h5py.File(file) as snapshot:
            time = snapshot["time"][()] * snapshot["scales/time_s"][()]
        require(math.isclose(player.content["time_s"][k], time, rel_tol=1e-9), f"{folder}: time of frame {k}")
        require_same(player, k, file)
    return player


def require_alone(folder):
    """No address of anything elsewhere: the only ones that a page may name are those of its own parts."""
    text = (folder / "player.html").read_text(encoding="utf-8")
    player = Player(folder / "player.html")
    require("default-src 'none'" in text, "no policy that forbids loading")
    require(not {"src", "href", "action", "data", "srcset", "background"} & {name for name, _ in player.parts.attributes}, "attributes that load")
    require(not {"link", "img", "iframe", "object", "embed", "base", "form"} & set(player.parts.tags), f"{player.parts.tags}")
    own = text.replace(player.parts.scripts["data"], "").replace(player.parts.scripts["content"], "")
    for word in ("http:", "https:", "url(", "@import", "fetch(", "XMLHttpRequest", "WebSocket", "import("):
        require(word not in own, f"the page says {word}")
    require(len(own) < 60000 and not re.search(r"[^\n]{2000}", own), f"{len(own)} bytes of program, or lines that nobody reads")


def main():
    with given() as (drumlin, here, folder):
        periodic = made_run(drumlin, folder, "periodic", PERIODIC.replace("Shaken floor", EVIL))
        said, _ = drumlin("plot", periodic, "--player")
        drawn = read_json(periodic / "plots" / "plots.json")
        require("player.html" in drawn["figures"] and "MB" in drawn["figures"]["player.html"], f"{drawn['figures']}")
        require(said.startswith("player.html: 5 of 5 snapshots, about 0.1 MB\n"), f"its size was not said before: {said}")
        require("player.html" in (periodic / "plots" / "manifest.txt").read_text(), "not in the manifest")
        require(not (periodic / "plots" / "stills").exists(), "stills that nobody asked for")
        player = require_player(periodic, periodic / "plots", 5)
        require(player.parts.title == EVIL and player.content["title"] == EVIL, f"the title: {player.parts.title}")
        require([s for s in player.parts.scripts if s != "program"] == ["content", "data"], f"{list(player.parts.scripts)}")
        require([f["name"] for f in player.content["fields"]] == ["speed", "spin", "size", "pressure", "coordination", "id"], "other fields")
        # Two calls leave the same bytes.
        first = (periodic / "plots" / "player.html").read_bytes()
        drumlin("plot", periodic, "--player", "--overwrite")
        require(first == (periodic / "plots" / "player.html").read_bytes(), "not the same bytes twice")
        drumlin("plot", periodic, "--player", "--every", "2", "--color", "pressure", "-o", folder / "every")
        require(require_player(periodic, folder / "every", 3).content["field"] == "pressure", "another field first")
        require_alone(folder / "every")

        # Materials, with a name that would end the script it stands in.
        evil = "a</script>b"
        mixed = made_run(drumlin, folder, "mixed", PERIODIC.replace("[grains.generated]", f'materials = [{{ name = "{evil}", share = 3 }}, {{ name = "steel" }}]\n[grains.generated]')
                         .replace("grain_grain = 0.4", f'grain_grain = 0.4\npairs = [{{ between = ["{evil}", "steel"], value = 0.2 }}]'))
        drumlin("plot", mixed, "--player", "--color", "material")
        player = require_player(mixed, mixed / "plots", 5)
        field = next(f for f in player.content["fields"] if f["name"] == "material")
        require(field["names"] == [evil, "steel", "none"] and {0, 1} == set(player.content["material"]) and len(field["colours"]) == 3, f"{field}")
        require([s for s in player.parts.scripts if s != "program"] == ["content", "data"], f"{list(player.parts.scripts)}")

        drumlin("run", here / "tiny-drum.toml", "-o", folder / "drum", *SHORT_RUN)
        drumlin("plot", folder / "drum", "--player")
        drum = require_player(folder / "drum", folder / "drum" / "plots", 4)
        walls = [frame["walls"][0] for frame in drum.frames]
        require(walls[0]["shape"] == "container" and walls[0] != walls[-1], f"no drum that turns: {walls}")

        traffic = made_run(drumlin, folder, "traffic", TRAFFIC)
        drumlin("plot", traffic, "--player")
        came = require_player(traffic, traffic / "plots", 12)
        require(came.content["count"] > 40 and "there" in came.arrays and "spin" not in came.content, "no grain came")
        _, said = drumlin("plot", traffic, "--color", "material", "-o", folder / "traffic-plots", code=2)
        require("have no materials" in said and "come and go" not in said, said)
        two = made_run(drumlin, folder, "two", TRAFFIC.replace("[grains.generated]", 'materials = [{ name = "glass" }, { name = "steel" }]\n[grains.generated]')
                       .replace("[effects.gravity]", '[effects.gravity]\n[effects.friction]\ngrain_grain = 0.4\ngrain_wall = 0.4\npairs = [{ between = ["glass", "steel"], value = 0.2 }]'))
        _, said = drumlin("plot", two, "--color", "material", "-o", folder / "two-plots", code=2)
        require("come and go" in said and not (folder / "two-plots").exists(), said)
        cell = made_run(drumlin, folder, "cell", CELL)
        drumlin("plot", cell, "--player")
        require(require_player(cell, cell / "plots", 6).frames[-1]["walls"][-1]["shape"] == "cell", "no cell")

        none = made_run(drumlin, folder, "none", NO_SNAPSHOTS)
        _, said = drumlin("plot", none, "--player", code=2)
        require("snapshot" in said, said)
    print("players hold the snapshots within their quanta and ask for nothing else")


if __name__ == "__main__":
    main()
