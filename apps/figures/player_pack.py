"""Packs snapshots for the player: positions, spins, speeds and forces as small whole numbers, each told by what the frame before lets expect.

player.html holds, beside its program, a JSON text `<script type="application/json" id="content">` (drumlin-player-1) and a zlib stream in base64,
`<script type="application/octet-stream" id="data">`: the planes in sequence. apps/pages/player_data.js and tests/chain/player_file.py read them. Units
are those of snapshots.

content:
  title, reduced, status, revision, scales   of the run
  number, time_s         of each frame; count: grains in any frame, each identity once
  quantum, origin        a coordinate is origin + quantum times a whole number
  turns, turn_bits       of each frame, cosine and sine, times 2^turn_bits, of the drum's turn since the frame before; flows: see positions
  speed                  low, step, changes: a speed is low exp(step level); level 0: low and below; spin: quantum, changes
  mean_force, force_steps  a force is sign(level) mean_force (level / force_steps)^2; angles: directions are whole numbers of 2 pi/angles
  pairs, wall_contacts   of each frame, new contacts between grains and all of them; contacts with walls
  overlaps               of each frame, the deep ones: depth in d, and the two grains by their places among all; -1: the container
  planes                 name and bytes of each; fields, field, view, period, material: colours, the first of them, the part of the plane shown,
                         a periodic domain, material of each grain

planes, frame after frame. A small number n is folded, 2n for n >= 0 and -2n - 1 below; a folded number below 255 is one byte, others are a byte 255 and
four bytes, lowest first, in the plane NAME+. Wide numbers have four bytes: the lowest of all numbers, then the next ones. Bits: the lowest first.
  radius                 float32; id: wide, identity minus the one before; there, where grains come or go: bits, each frame from a byte of its own
  x, z                   small, positions less the expected ones; speed, spin: small, levels; if `changes`, minus those of the frame before
  pair_kept              bits, whether each contact of the frame before lasts; pair_a, pair_b: of each new contact, ascending: small, its first grain
                         minus that of the contact before; wide, its second; pair_force: small, of each contact, its level minus that before
  wall_grain, wall_force, wall_angle   small, its grain minus the one before; small, its level; a byte, direction from the centre to the wall
  walls                  JSON, `states` and, per frame, which are present: container, segment, disc, cell

Positions: with c and s of `turns`, R(x, z) = (floor((c x + s z + h) / 2^turn_bits), floor((c z - s x + h) / 2^turn_bits)), h = 2^(turn_bits - 1). A
grain at p in the frame before, after a step e, is expected at R(p) + R(e) if a part of e exceeds `flows`, else at R(p); its step is then its position
minus R(p). For a new grain p, e and the step after are 0."""

import json
import math
import zlib

import numpy as np

import grain_colours

QUANTUM = 0.01  # d, of places; finer where grains are much smaller than the mean
SMALLEST = 0.04  # radii of the smallest grain, at most, that a place is rounded to
SPEED_STEP = 0.05  # of the logarithm of the speed
SPEED_RANGE = 1e-4  # of nearly the fastest: what is slower counts as that
SPIN_STEPS = 64  # up to nearly the fastest spin
FORCE_STEPS = 16  # of the root of a force, up to that of the mean force
TURN = 24  # bits behind the point of the sine and cosine that a drum turns by between two frames
FLOWS = 0.3  # d per frame: what moves that far against the drum is expected to go on
MOST = 2**26  # whole numbers stay below it: products with cosines are exact in a double
ANGLES = 256  # directions of contacts with walls


def small(values):
    """(one byte for each number, four more for those that it does not hold): sign in the lowest bit, 255 for what is large."""
    values = np.asarray(values, dtype=np.int64)
    folded = np.where(values >= 0, 2 * values, -2 * values - 1)
    large = folded >= 255
    return np.where(large, 255, folded).astype("u1").tobytes(), folded[large].astype("<u4").tobytes()


def wide(values):
    """Four bytes for each number from 0 on: all lowest ones first."""
    return np.asarray(values).astype("<u4").view("u1").reshape(-1, 4).T.tobytes()


class Planes:
    """Numbers of one kind from all frames stand together: they compress better, and a reader takes one stream for each kind."""

    def __init__(self):
        self.parts = {}

    def add(self, name, content):
        self.parts.setdefault(name, []).append(content)

    def add_small(self, name, values):
        bytes_, large = small(values)
        self.add(name, bytes_)
        self.add(name + "+", large)

    def whole(self):
        """([name, bytes] of each plane, the zlib stream of all of them)"""
        joined = {name: b"".join(parts) for name, parts in self.parts.items()}
        return [[name, len(content)] for name, content in joined.items()], zlib.compress(b"".join(joined.values()), 9)


def whole_numbers(values, quantum, what):
    found = np.rint(np.asarray(values, dtype=float) / quantum)
    if not np.all(np.abs(found) < MOST):
        raise SystemExit(f"the player: {what} is no number, or larger than {MOST * quantum:g}")
    return found.astype(np.int64)


def turned(x, z, turn):
    """Whole numbers turned by a cosine and a sine that are whole numbers of 2^-24: the same in every reader."""
    c, s = turn
    half = 1 << (TURN - 1)
    return (c * x + s * z + half) >> TURN, (c * z - s * x + half) >> TURN


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

    def all_there(self):
        return all(len(places) == len(self.ids) for places in self.places)


def add_places(planes, frames, grounds, origin, quantum):
    """Residuals against the places before, turned with the drum where that serves better. Returns the turn of each frame."""
    count = len(grounds.ids)
    x, z, e_x, e_z = (np.zeros(count, dtype=np.int64) for _ in range(4))
    turns, angle = [], frames[0].wall_angle
    for grains, places in zip(frames, grounds.places):
        now_x = whole_numbers(grains.x - origin[0], quantum, "the place of a grain")
        now_z = whole_numbers(grains.z - origin[1], quantum, "the place of a grain")
        tried = [(1 << TURN, 0)]
        if grains.container_radius > 0 and grains.wall_angle != angle:
            by = grains.wall_angle - angle
            tried.append((round(math.cos(by) * (1 << TURN)), round(math.sin(by) * (1 << TURN))))
        angle, best = grains.wall_angle, None
        for turn in tried:
            to_x, to_z = turned(x[places], z[places], turn)
            goes = np.maximum(np.abs(e_x[places]), np.abs(e_z[places])) > FLOWS / quantum
            on_x, on_z = turned(np.where(goes, e_x[places], 0), np.where(goes, e_z[places], 0), turn)
            rest = now_x - to_x - on_x, now_z - to_z - on_z
            size = np.abs(rest[0]).sum() + np.abs(rest[1]).sum()
            if best is None or size < best[0]:
                best = size, turn, rest, (now_x - to_x, now_z - to_z)
        _, turn, rest, moved = best
        turns.append(turn)
        planes.add_small("x", rest[0])
        planes.add_small("z", rest[1])
        new = np.ones(count, dtype=bool)
        new[places] = False
        x[places], z[places] = now_x, now_z
        # One that was not there a frame ago has come from nowhere: nothing is expected to go on.
        e_x[places], e_z[places] = np.where(grains.fresh, 0, moved[0]), np.where(grains.fresh, 0, moved[1])
        for kept in (x, z, e_x, e_z):
            kept[new] = 0
    return turns


def mark_fresh(frames, grounds):
    """Which grains of each frame were not in the one before."""
    before = np.zeros(len(grounds.ids), dtype=bool)
    for grains, places in zip(frames, grounds.places):
        grains.fresh = ~before[places]
        before[:] = False
        before[places] = True


def add_levels(planes, name, levels, grounds):
    """Whole numbers of each grain, against those of the frame before or as they are, whichever is shorter."""
    before, changes = np.zeros(len(grounds.ids), dtype=np.int64), []
    for now, places in zip(levels, grounds.places):
        changes.append(now - before[places])
        before[:] = 0
        before[places] = now
    shorter = min((levels, changes), key=lambda kind: sum(len(zlib.compress(part, 1)) for part in small(np.concatenate(kind))))
    planes.add_small(name, np.concatenate(shorter))
    return shorter is changes


def add_pairs(planes, frames, grounds, mean):
    """Contacts between grains: which of the frame before go on, which are new, and the change of their forces."""
    count, before, levels_before = np.int64(len(grounds.ids)), np.zeros(0, dtype=np.int64), np.zeros(0, dtype=np.int64)
    kept_bits, partners, pairs = [], [], []
    for grains, places in zip(frames, grounds.places):
        between = grains.contacts["j"] >= 0
        i, j = places[grains.contacts["i"][between]], places[grains.contacts["j"][between]]
        # Two that touch across both seams of a narrow period are one line here: their forces are added.
        keys, inverse = np.unique(np.minimum(i, j) * count + np.maximum(i, j), return_inverse=True)
        levels = force_levels(np.bincount(inverse, grains.force[between], len(keys)), mean)
        stays = np.isin(before, keys, assume_unique=True)
        new = keys[~np.isin(keys, before, assume_unique=True)]
        expected = np.zeros(len(keys), dtype=np.int64)
        expected[np.searchsorted(keys, before[stays])] = levels_before[stays]
        kept_bits.append(stays)
        pairs.append([len(new), len(keys)])
        planes.add_small("pair_a", np.diff(new // count, prepend=0))
        partners.append(new % count)
        planes.add_small("pair_force", levels - expected)
        before, levels_before = keys, levels
    planes.add("pair_b", wide(np.concatenate(partners)))
    planes.add("pair_kept", np.packbits(np.concatenate(kept_bits), bitorder="little").tobytes())
    return pairs


def force_levels(force, mean):
    return (np.sign(force) * np.rint(FORCE_STEPS * np.sqrt(np.abs(force) / mean))).astype(np.int64)


def add_wall_contacts(planes, frames, grounds, mean):
    """Contacts with walls: grain, direction from its centre to the wall, force."""
    counts = []
    for grains, places in zip(frames, grounds.places):
        with_wall = grains.contacts["j"] < 0
        i = places[grains.contacts["i"][with_wall]]
        order = np.argsort(i, kind="stable")
        angle = np.arctan2(-grains.contacts["normal_z"][with_wall], -grains.contacts["normal_x"][with_wall])
        planes.add_small("wall_grain", np.diff(i[order], prepend=0))
        planes.add("wall_angle", (np.rint(angle[order] * ANGLES / (2 * np.pi)).astype(np.int64) % ANGLES).astype("u1").tobytes())
        planes.add_small("wall_force", force_levels(grains.force[with_wall], mean)[order])
        counts.append(len(i))
    return counts


def rounded(value):
    """Numbers of a wall to 1e-4 d: what stands still is the same in all frames."""
    if isinstance(value, dict):
        return {key: rounded(part) for key, part in value.items()}
    if isinstance(value, list):
        return [rounded(part) for part in value]
    return round(value, 4) if isinstance(value, float) else value


def add_walls(planes, frames):
    """Every state of a wall once, and for each frame which of them stand; cells of periodic domains among them."""
    known, lists = {}, []
    for grains in frames:
        walls = [rounded(wall) for wall in grains.frame["walls"]]
        if grains.cell is not None:
            (left, bottom), (right, top) = grains.cell
            walls.append(rounded({"shape": "cell", "x": [float(left), float(right)], "z": [float(bottom), float(top)],
                                  "offset": float(grains.offset)}))
        lists.append([known.setdefault(json.dumps(wall, sort_keys=True), len(known)) for wall in walls])
    text = json.dumps({"states": [json.loads(state) for state in known], "frames": lists}, separators=(",", ":"))
    planes.add("walls", text.encode("utf-8"))


def packed(frames, has_spin):
    """(what a reader has to know of the planes, the zlib stream)"""
    grounds, planes = Grounds(frames), Planes()
    mark_fresh(frames, grounds)
    quantum = min(QUANTUM, SMALLEST * float(grounds.radius.min(initial=QUANTUM / SMALLEST)))
    origin = [float(v) for v in frames[0].center] if frames[0].container_radius > 0 else [0.0, 0.0]
    forces = np.concatenate([np.abs(grains.force) for grains in frames])
    mean = float(forces.mean()) if len(forces) and forces.mean() > 0 else 1.0
    speeds = np.concatenate([grains.speed for grains in frames])
    fast = max(float(np.quantile(speeds, 0.998)) if len(speeds) else 1.0, grain_colours.STILL)
    head = {"quantum": quantum, "origin": origin, "count": len(grounds.ids), "mean_force": mean, "force_steps": FORCE_STEPS,
            "turn_bits": TURN, "flows": FLOWS / quantum, "angles": ANGLES, "speed": {"low": SPEED_RANGE * fast, "step": SPEED_STEP}}
    planes.add("radius", grounds.radius.astype("<f4").tobytes())
    planes.add("id", wide(np.diff(grounds.ids, prepend=0)))
    if not grounds.all_there():
        there = np.zeros((len(frames), len(grounds.ids)), dtype=bool)
        for k, places in enumerate(grounds.places):
            there[k, places] = True
        planes.add("there", np.packbits(there, axis=1, bitorder="little").tobytes())
    head["turns"] = add_places(planes, frames, grounds, origin, quantum)
    levels = [np.rint(np.log(np.maximum(grains.speed / head["speed"]["low"], 1)) / SPEED_STEP).astype(np.int64) for grains in frames]
    head["speed"]["changes"] = add_levels(planes, "speed", levels, grounds)
    if has_spin:
        most = max(float(np.quantile(np.abs(np.concatenate([grains.spin for grains in frames])), 0.99)), grain_colours.STILL)
        head["spin"] = {"quantum": most / SPIN_STEPS}
        levels = [whole_numbers(grains.spin, most / SPIN_STEPS, "the spin of a grain") for grains in frames]
        head["spin"]["changes"] = add_levels(planes, "spin", levels, grounds)
    head["pairs"] = add_pairs(planes, frames, grounds, mean)
    head["wall_contacts"] = add_wall_contacts(planes, frames, grounds, mean)
    add_walls(planes, frames)
    head["planes"], stream = planes.whole()
    return head, stream, grounds
