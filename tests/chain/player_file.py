"""Reads a player.html as apps/figures/player_pack.py describes it, with nothing of the program that wrote it."""

import base64
import html.parser
import itertools
import json
import math
import pathlib
import zlib

from command import require


class Parts(html.parser.HTMLParser):
    """Texts of the scripts by their ids, the title, and every attribute with its value."""

    def __init__(self, text):
        super().__init__()
        self.scripts, self.title, self.attributes, self.tags, self.inside = {}, "", [], [], None
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes += attrs
        if tag in ("script", "title"):
            self.inside = tag, dict(attrs).get("id", "program")

    def handle_endtag(self, tag):
        self.inside = None

    def handle_data(self, data):
        if self.inside and self.inside[0] == "title":
            self.title += data
        elif self.inside:
            self.scripts[self.inside[1]] = self.scripts.get(self.inside[1], "") + data


class Player:
    """Frames of a player: dictionaries with grains by their identities."""

    def __init__(self, file):
        self.parts = Parts(pathlib.Path(file).read_text(encoding="utf-8"))
        self.content = json.loads(self.parts.scripts["content"])
        require(self.content["format"] == "drumlin-player-2", f"{file}: {self.content['format']}")
        stream, at, self.arrays = zlib.decompress(base64.b64decode(self.parts.scripts["data"], validate=True)), 0, {}
        for name, kind, length in self.content["arrays"]:
            letter, size = {"Int8": ("b", 1), "Int16": ("h", 2), "Int32": ("i", 4), "Float32": ("f", 4)}[kind]
            whole = bytes(itertools.chain.from_iterable(zip(*(stream[at + k * length:at + (k + 1) * length] for k in range(size)))))
            self.arrays[name] = memoryview(whole).cast(letter)
            at += size * length
        require(at == len(stream), f"{file}: {len(stream)} bytes of {at}")
        self.id = list(self.arrays["id"])
        self.frames = list(self.unpacked())

    def unpacked(self):
        content, count, arrays = self.content, self.content["count"], self.arrays
        pairs, levels = [{} for _ in content["number"]], iter(arrays["pair_force"])
        for a, b, first, frames in zip(*(arrays["pair_" + name] for name in ("a", "b", "from", "frames"))):
            for f in range(first, first + frames):
                pairs[f][self.id[a], self.id[b]] = self.force(next(levels))
        places, touches = [[0, 0] for _ in range(count)], zip(*(arrays["wall_" + name] for name in ("grain", "force", "angle")))
        for f, walls in enumerate(content["walls"]["frames"]):
            grains = {}
            for g in range(count):
                k, place = f * count + g, places[g]
                place[0] += arrays["x"][k]
                place[1] += arrays["z"][k]
                if "there" in arrays and not arrays["there"][k]:
                    continue
                level = arrays["speed"][k]
                grains[self.id[g]] = {"x": content["origin"][0] + content["quantum"] * place[0], "z": content["origin"][1] + content["quantum"] * place[1],
                                      "radius": arrays["radius"][g], "speed": content["speed"]["low"] * math.exp(content["speed"]["step"] * level), "slow": level == 0}
                if "spin" in arrays:
                    grains[self.id[g]]["spin"] = content["spin"]["quantum"] * arrays["spin"][k]
            touched = [(self.id[g], self.force(level), 2 * math.pi * angle / content["angles"]) for g, level, angle in itertools.islice(touches, content["wall_contacts"][f])]
            yield {"grains": grains, "pairs": pairs[f], "wall_contacts": touched, "walls": [content["walls"]["states"][k] for k in walls]}

    def force(self, level):
        return math.copysign(self.content["mean_force"] * (level / self.content["force_steps"]) ** 2, level)
