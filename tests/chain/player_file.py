"""Reads a player.html as apps/figures/player_pack.py describes it, with nothing of the program that wrote it."""

import base64
import html.parser
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
        require(self.content["format"] == "drumlin-player-1", f"{file}: {self.content['format']}")
        stream, at, self.planes = zlib.decompress(base64.b64decode(self.parts.scripts["data"], validate=True)), 0, {}
        for name, length in self.content["planes"]:
            self.planes[name] = stream[at:at + length]
            at += length
        require(at == len(stream), f"{file}: {len(stream)} bytes of {at}")
        self.radius = [float(r) for r in memoryview(self.planes["radius"]).cast("f")]
        differences, self.id = self.wide("id"), []
        for _ in range(self.content["count"]):
            self.id.append(next(differences) + (self.id[-1] if self.id else 0))
        self.frames = list(self.unpacked())

    def small(self, name):
        large = iter(memoryview(self.planes[name + "+"]).cast("I"))
        for folded in self.planes[name]:
            folded = next(large) if folded == 255 else folded
            yield -(folded + 1) // 2 if folded % 2 else folded // 2

    def wide(self, name):
        plane = self.planes[name]
        n = len(plane) // 4
        return (sum(plane[part * n + k] << 8 * part for part in range(4)) for k in range(n))

    def bits(self, name):
        return (byte >> k & 1 for byte in self.planes[name] for k in range(8))

    def turned(self, x, z, turn):
        (c, s), bits = turn, self.content["turn_bits"]
        half = 1 << (bits - 1)
        return (c * x + s * z + half) >> bits, (c * z - s * x + half) >> bits

    def unpacked(self):
        content, count = self.content, self.content["count"]
        streams = {name: self.small(name) for name in ("x", "z", "pair_a", "pair_force", "wall_grain", "wall_force") if name in self.planes}
        partners, stays, walls = self.wide("pair_b"), self.bits("pair_kept"), json.loads(self.planes["walls"])
        levels = {name: (self.small(name), content[name]["changes"]) for name in ("speed", "spin") if name in self.planes}
        angles, row = iter(self.planes["wall_angle"]), (count + 7) // 8
        before, steps, lasting = {}, {}, {}
        for f, turn in enumerate(content["turns"]):
            shown = range(count)
            if "there" in self.planes:
                shown = [g for g in shown if self.planes["there"][f * row + g // 8] >> g % 8 & 1]
            now, went, grains = {}, {}, {}
            for g in shown:
                # x and z stand in planes of their own: the streams go on side by side.
                to = self.turned(*before.get(g, ((0, 0), {}))[0], turn)
                step = steps.get(g, (0, 0))
                on = self.turned(*step, turn) if max(map(abs, step)) > content["flows"] else (0, 0)
                at = to[0] + on[0] + next(streams["x"]), to[1] + on[1] + next(streams["z"])
                now[g], went[g] = (at, {}), (at[0] - to[0], at[1] - to[1]) if g in before else (0, 0)
            for name, (values, changes) in levels.items():
                for g in shown:
                    now[g][1][name] = next(values) + (before[g][1][name] if changes and g in before else 0)
            for g in shown:
                (x, z), found = now[g]
                grains[self.id[g]] = {"x": content["origin"][0] + content["quantum"] * x, "z": content["origin"][1] + content["quantum"] * z,
                                      "radius": self.radius[g], "speed": content["speed"]["low"] * math.exp(content["speed"]["step"] * found["speed"]),
                                      "slow": found["speed"] == 0}
                if "spin" in found:
                    grains[self.id[g]]["spin"] = content["spin"]["quantum"] * found["spin"]
            before, steps = now, went
            kept = {pair: level for pair, level in lasting.items() if next(stays)}
            fresh, whole = content["pairs"][f]
            first = 0
            for _ in range(fresh):
                first += next(streams["pair_a"])
                kept[first, next(partners)] = 0
            require(len(kept) == whole, f"frame {f}: {len(kept)} pairs, not {whole}")
            lasting = {pair: kept[pair] + next(streams["pair_force"]) for pair in sorted(kept)}
            touched, grain = [], 0
            for _ in range(content["wall_contacts"][f]):
                grain += next(streams["wall_grain"])
                touched.append((self.id[grain], self.force(next(streams["wall_force"])), 2 * math.pi * next(angles) / content["angles"]))
            yield {"grains": grains, "pairs": {(self.id[a], self.id[b]): self.force(level) for (a, b), level in lasting.items()},
                   "wall_contacts": touched, "walls": [walls["states"][k] for k in walls["frames"][f]]}

    def force(self, level):
        return math.copysign(self.content["mean_force"] * (level / self.content["force_steps"]) ** 2, level)
