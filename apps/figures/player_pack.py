"""Packs snapshots for the player: arrays of small whole numbers.

player.html holds, beside its program, a JSON text `<script type="application/json" id="content">` (drumlin-player-2) and a zlib stream in base64,
`<script type="application/octet-stream" id="data">`: the arrays in sequence. apps/pages/player_data.js and tests/chain/player_file.py read them. Units
are those of snapshots.

content:
  title, reduced, status, revision, scales   of the run
  number, time_s         of each frame; count: grains in any frame, each identity once
  arrays                 [name, type, length] of each: Int8, Int16, Int32 or Float32 of JavaScript; the lowest bytes of all its numbers, then the next ones
  quantum, origin        a coordinate is origin + quantum times a whole number
  speed                  low, step: a speed is low exp(step level); level 0: low and below; spin: quantum
  mean_force, force_steps  a force is sign(level) mean_force (level / force_steps)^2; angles: directions are whole numbers of 2 pi/angles
  wall_contacts          of each frame, contacts with walls
  walls                  `states` and, per frame, which are present: container, segment, disc, cell
  overlaps               of each frame, the deep ones: depth in d, and the two grains by their places among all; -1: the container
  fields, field, view, period, material      colours, the first of them, the part of the plane shown, a periodic domain, material of each grain

arrays:
  radius, id             of each grain
  x, z                   of each frame all grains: positions minus those of the frame before, first minus 0
  there                  of each frame all grains: 1, or 0 where it is not there; only if grains come and go
  speed, spin            of each frame all grains: levels
  pair_a, pair_b, pair_from, pair_frames     of each contact between grains, ascending by grains and time: the two, its first frame, how many it lasts
  pair_force             its levels in these frames
  wall_grain, wall_force, wall_angle         of each frame, contacts with walls: grain, level, direction from the centre to the wall"""

import json
import zlib

import numpy as np

import grain_colours

QUANTUM = 0.01  # d, of places; finer where grains are much smaller than the mean
SMALLEST = 0.04  # radii of the smallest grain, at most, that a place is rounded to
SPEED_STEP = 0.05  # of the logarithm of the speed
SPEED_RANGE = 1e-4  # of nearly the fastest: what is slower counts as that
SPIN_STEPS = 64  # up to nearly the fastest spin
FORCE_STEPS = 16  # of the root of a force, up to that of the mean force
MOST = 2**30  # whole numbers and their differences stay below 2^31
ANGLES = 256  # directions of contacts with walls
TYPES = {"Int8": "<i1", "Int16": "<i2", "Int32": "<i4", "Float32": "<f4"}


class Arrays:
    """Arrays of whole numbers, each of the smallest type that holds it."""

    def __init__(self):
        self.listed, self.content = [], []

    def add(self, name, values, kind=None):
        values = np.ravel(values)
        if kind is None:
            low, high = (int(values.min()), int(values.max())) if len(values) else (0, 0)
            kind = next(kind for kind, limit in (("Int8", 2**7), ("Int16", 2**15), ("Int32", 2**31)) if -limit <= low and high < limit)
        self.listed.append([name, kind, len(values)])
        self.content.append(values.astype(TYPES[kind]).view("u1").reshape(len(values), -1 if len(values) else 1).T.tobytes())

    def stream(self):
        return zlib.compress(b"".join(self.content), 9)


def whole_numbers(values, quantum, what):
    found = np.rint(np.asarray(values, dtype=float) / quantum)
    if not np.all(np.abs(found) < MOST):
        raise SystemExit(f"the player: {what} is no number, or larger than {MOST * quantum:g}")
    return found.astype(np.int64)


class Grounds:
    """The grains of all frames: each identity once, in ascending order."""

    def __init__(self, frames):
        self.ids = np.unique(np.concatenate([grains.id for grains in frames]))
        self.places = [np.searchsorted(self.ids, grains.id) for grains in frames]
        self.radius = np.zeros(len(self.ids))
        for grains, places in zip(frames, self.places):
            self.radius[places] = grains.radius
        for grains, places in zip(frames, self.places):
            if not np.array_equal(self.radius[places], grains.radius):
                raise SystemExit("the player: a grain changes its size, which it cannot show")

    def of_all(self, levels, stay=False):
        """Of each frame all grains: 0 for those that are not there, or, where they `stay`, what they had last."""
        whole = np.zeros((len(self.places), len(self.ids)), dtype=np.int64)
        for frame, (values, places) in enumerate(zip(levels, self.places)):
            if stay and frame:
                whole[frame] = whole[frame - 1]
            whole[frame, places] = values
        return whole


def force_levels(force, mean):
    return (np.sign(force) * np.rint(FORCE_STEPS * np.sqrt(np.abs(force) / mean))).astype(np.int64)


def add_pairs(arrays, frames, grounds, mean):
    """Contacts between grains: each with all its frames."""
    count, keys, levels = np.int64(len(grounds.ids)), [], []
    for grains, places in zip(frames, grounds.places):
        between = grains.contacts["j"] >= 0
        i, j = places[grains.contacts["i"][between]], places[grains.contacts["j"][between]]
        # Two that touch across both seams of a narrow period are one line here: their forces are added.
        found, inverse = np.unique(np.minimum(i, j) * count + np.maximum(i, j), return_inverse=True)
        keys.append(found)
        levels.append(force_levels(np.bincount(inverse, grains.force[between], len(found)), mean))
    frame = np.repeat(np.arange(len(frames)), [len(found) for found in keys])
    key, level = np.concatenate(keys), np.concatenate(levels)
    order = np.lexsort((frame, key))
    key, frame, level = key[order], frame[order], level[order]
    first = np.flatnonzero((np.diff(key, prepend=-1) != 0) | (np.diff(frame, prepend=-1) != 1))
    arrays.add("pair_a", key[first] // count if count else key)
    arrays.add("pair_b", key[first] % count if count else key)
    arrays.add("pair_from", frame[first])
    arrays.add("pair_frames", np.diff(first, append=len(key)))
    arrays.add("pair_force", level)


def add_wall_contacts(arrays, frames, grounds, mean):
    """Contacts with walls: grain, direction from its centre to the wall, force. Returns how many each frame has."""
    grain, force, angle, counts = [], [], [], []
    for grains, places in zip(frames, grounds.places):
        with_wall = grains.contacts["j"] < 0
        i = places[grains.contacts["i"][with_wall]]
        order = np.argsort(i, kind="stable")
        direction = np.arctan2(-grains.contacts["normal_z"][with_wall], -grains.contacts["normal_x"][with_wall])
        grain.append(i[order])
        angle.append(np.rint(direction[order] * ANGLES / (2 * np.pi)))
        force.append(force_levels(grains.force[with_wall], mean)[order])
        counts.append(len(i))
    for name, values in (("grain", grain), ("force", force), ("angle", angle)):
        arrays.add("wall_" + name, np.concatenate(values))
    return counts


def rounded(value):
    """Numbers of a wall to 1e-4 d: what stands still is the same in all frames."""
    if isinstance(value, dict):
        return {key: rounded(part) for key, part in value.items()}
    if isinstance(value, list):
        return [rounded(part) for part in value]
    return round(value, 4) if isinstance(value, float) else value


def walls_of(frames):
    """Every state of a wall once, and for each frame which of them stand; cells of periodic domains among them."""
    known, lists = {}, []
    for grains in frames:
        walls = [rounded(wall) for wall in grains.frame["walls"]]
        if grains.cell is not None:
            (left, bottom), (right, top) = grains.cell
            walls.append(rounded({"shape": "cell", "x": [float(left), float(right)], "z": [float(bottom), float(top)],
                                  "offset": float(grains.offset)}))
        lists.append([known.setdefault(json.dumps(wall, sort_keys=True), len(known)) for wall in walls])
    return {"states": [json.loads(state) for state in known], "frames": lists}


def packed(frames, has_spin):
    """(what a reader has to know of the arrays, the zlib stream, the grains)"""
    grounds, arrays = Grounds(frames), Arrays()
    quantum = min(QUANTUM, SMALLEST * float(grounds.radius.min(initial=QUANTUM / SMALLEST)))
    origin = [float(v) for v in frames[0].center] if frames[0].container_radius > 0 else [0.0, 0.0]
    forces = np.concatenate([np.abs(grains.force) for grains in frames])
    mean = float(forces.mean()) if len(forces) and forces.mean() > 0 else 1.0
    speeds = np.concatenate([grains.speed for grains in frames])
    fast = max(float(np.quantile(speeds, 0.998)) if len(speeds) else 1.0, grain_colours.STILL)
    low = SPEED_RANGE * fast
    head = {"quantum": quantum, "origin": origin, "count": len(grounds.ids), "mean_force": mean, "force_steps": FORCE_STEPS,
            "angles": ANGLES, "speed": {"low": low, "step": SPEED_STEP}, "walls": walls_of(frames)}
    arrays.add("radius", grounds.radius, "Float32")
    arrays.add("id", grounds.ids)
    for name, from_ in (("x", origin[0]), ("z", origin[1])):
        at = [whole_numbers(getattr(grains, name) - from_, quantum, "the place of a grain") for grains in frames]
        arrays.add(name, np.diff(grounds.of_all(at, stay=True), axis=0, prepend=0))
    there = grounds.of_all([1] * len(frames))
    if not there.all():
        arrays.add("there", there)
    arrays.add("speed", grounds.of_all([np.rint(np.log(np.maximum(grains.speed / low, 1)) / SPEED_STEP) for grains in frames]))
    if has_spin:
        most = max(float(np.quantile(np.abs(np.concatenate([grains.spin for grains in frames])), 0.99)), grain_colours.STILL)
        head["spin"] = {"quantum": most / SPIN_STEPS}
        arrays.add("spin", grounds.of_all([whole_numbers(grains.spin, most / SPIN_STEPS, "the spin of a grain") for grains in frames]))
    add_pairs(arrays, frames, grounds, mean)
    head["wall_contacts"] = add_wall_contacts(arrays, frames, grounds, mean)
    return head | {"arrays": arrays.listed}, arrays.stream(), grounds
