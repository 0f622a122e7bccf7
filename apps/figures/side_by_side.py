"""What moves at the top of the page of `drumlin compare`: grains beside the mean flow of the other side, and in both the same tracers.

usage: side_by_side.py COMPARISON_JSON MAPS FOLDER SNAPSHOT...

Writes FOLDER/motion.json, which the page takes in. The tracers are grains of three upright stripes in the first snapshot; on the other side
points start from their places and go with the mean flow.
"""

import base64
import json
import math
import pathlib
import sys

import h5py
import numpy as np

import grain_colours
import player_pack
import script
import whole_file
from drum_maps import read_maps
from result_files import number_of

STRIPES = (-0.5, 0.0, 0.5)  # of the radius of the drum: where upright stripes of grains are marked
STRIPE_WIDTH = 3.0  # d
COLOURS = 64
STEPS = 10  # of a tracer between two frames
FILLED = 3  # nodes that the velocity is continued by beyond the border of the map
NONE = 255  # no flow there


class Frame:
    """A snapshot as player_pack wants it, without contacts. An anticlockwise drum is looked at in a mirror."""

    def __init__(self, file):
        with h5py.File(file) as snapshot:
            x, self.z, v_x, v_z, self.radius = (snapshot["grains/" + name][:] for name in ("x", "z", "v_x", "v_z", "radius"))
            spin, angle = number_of(snapshot["wall/spin"]), number_of(snapshot["wall/angle"])
            middle = number_of(snapshot["container/x"]), number_of(snapshot["container/z"])
            self.container_radius = number_of(snapshot["container/radius"])
            self.time, self.time_s = number_of(snapshot["time"]), number_of(snapshot["time"]) * number_of(snapshot["scales/time_s"])
            self.scales = {name: number_of(snapshot["scales/" + name]) for name in ("length_m", "time_s", "density_kg_m3")}
        sign = -1.0 if spin < 0 else 1.0
        self.x, self.z = sign * (x - middle[0]), self.z - middle[1]
        self.spin, self.wall_angle, self.center = abs(spin), sign * angle, (0.0, 0.0)
        self.speed = np.hypot(sign * v_x - self.spin * self.z, v_z + self.spin * self.x)
        self.id = grain_colours.id_of(file, len(x))
        self.with_nothing_else()
        self.frame = {"walls": [{"shape": "container", "x": 0.0, "z": 0.0, "radius": self.container_radius,
                                 "angle": float(self.wall_angle)}]}

    def with_nothing_else(self):
        none = np.zeros(0, dtype=np.int64)
        self.contacts, self.force, self.cell = {"i": none, "j": none, "normal_x": none, "normal_z": none}, np.zeros(0), None


class Tracers(Frame):
    """Points on the other side, at the time of a frame."""

    def __init__(self, of, places):
        self.__dict__.update(of.__dict__)
        self.x, self.z = places.T
        self.radius, self.speed, self.id = np.full(len(places), 0.5), np.zeros(len(places)), np.arange(len(places))
        self.with_nothing_else()


class MeanFlow:
    """Velocity of a map in the laboratory, about the axis of the drum."""

    def __init__(self, maps, spin):
        header, grids = read_maps(maps)
        self.theta, self.axis_depth, self.spin = math.radians(float(header["theta_deg"])), float(header["axis_depth"]), spin
        self.x, self.z = grids["x"], grids["z"]
        self.speed = np.ma.hypot(grids["v_x"], grids["v_z"])
        self.there = ~np.ma.getmaskarray(self.speed)
        self.velocity = [continued(np.ma.filled(grids[name], np.nan)) for name in ("v_x", "v_z")]

    def to_flow(self, places):
        """From the laboratory, about the axis, to x downslope and z from the surface."""
        c, s = math.cos(self.theta), math.sin(self.theta)
        return np.column_stack([places[:, 0] * c - places[:, 1] * s, places[:, 0] * s + places[:, 1] * c + self.axis_depth])

    def to_laboratory(self, places):
        c, s, z = math.cos(self.theta), math.sin(self.theta), places[:, 1] - self.axis_depth
        return np.column_stack([places[:, 0] * c + z * s, -places[:, 0] * s + z * c])

    def node(self, places):
        """Column and row of the lower left node, and how far a place lies beyond it."""
        at = np.column_stack([(places[:, 0] - self.x[0]) / (self.x[1] - self.x[0]), (places[:, 1] - self.z[0]) / (self.z[1] - self.z[0])])
        low = np.clip(np.floor(at).astype(int), 0, [len(self.x) - 2, len(self.z) - 2])
        return low, np.clip(at - low, 0, 1)

    def holds(self, places):
        low, part = self.node(places)
        near = low + (part > 0.5)
        return self.there[near[:, 1], near[:, 0]]

    def at(self, places):
        low, part = self.node(places)
        (i, j), (u, w) = low.T, part.T
        moving = np.column_stack([(v[j, i] * (1 - u) + v[j, i + 1] * u) * (1 - w) + (v[j + 1, i] * (1 - u) + v[j + 1, i + 1] * u) * w
                                  for v in self.velocity])
        # The map is told in the frame of the drum, which turns clockwise.
        return moving + self.spin * np.column_stack([places[:, 1] - self.axis_depth, -places[:, 0]])

    def carried(self, places, time, radius):
        """Runge and Kutta's fourth order, in steps of a fraction of a frame; nothing comes nearer to the wall than a grain."""
        h = time / STEPS
        for _ in range(STEPS):
            k1 = self.at(places)
            k2 = self.at(places + h / 2 * k1)
            k3 = self.at(places + h / 2 * k2)
            places = places + h / 6 * (k1 + 2 * k2 + 2 * k3 + self.at(places + h * k3))
            axis = np.array([0, self.axis_depth])
            out = np.hypot(*(places - axis).T)[:, None]
            places = axis + (places - axis) * np.minimum(1, (radius - 0.5) / np.maximum(out, 0.5))
        return places


def continued(values):
    """Some nodes further than the map reaches with the mean of the neighbours; beyond, at rest against the drum."""
    for _ in range(FILLED):
        padded = np.pad(values, 1, constant_values=np.nan)
        beside = np.stack([padded[1 + j:padded.shape[0] - 1 + j, 1 + i:padded.shape[1] - 1 + i] for i in (-1, 0, 1) for j in (-1, 0, 1)])
        known = np.isfinite(beside)
        mean = np.where(known, beside, 0).sum(axis=0) / np.maximum(known.sum(axis=0), 1)
        values = np.where(np.isfinite(values) | ~known.any(axis=0), values, mean)
    return np.nan_to_num(values)


def described(frames, field):
    """One side as the player reads it."""
    head, stream, _ = player_pack.packed(frames, False)
    return head | {"number": list(range(len(frames))), "time_s": [frame.time_s for frame in frames], "period": None,
                   "overlaps": [[]] * len(frames), "scales": frames[0].scales, "fields": [field], "data": base64.b64encode(stream).decode("ascii")}


def motion(files, maps, comparison):
    frames = [Frame(file) for file in files]
    frames = [frame for frame in frames if frame.spin > 0]
    if len(frames) < 2 or any(not np.array_equal(frame.id, frames[0].id) for frame in frames):
        return None  # no drum that turns, or grains that come and go
    flow = MeanFlow(maps, frames[0].spin)
    radius = frames[0].container_radius
    first = frames[0]
    marked = np.flatnonzero(np.any([np.abs(first.x - at * radius) < STRIPE_WIDTH / 2 for at in STRIPES], axis=0))
    places = flow.to_flow(np.column_stack([first.x, first.z])[marked])
    places = places[flow.holds(places)]
    tracers = [Tracers(first, flow.to_laboratory(places))]
    for before, now in zip(frames, frames[1:]):
        places = flow.carried(places, now.time - before.time, radius)
        tracers.append(Tracers(now, flow.to_laboratory(places)))
    top = max(float(flow.speed.max()), float(np.quantile(np.concatenate([frame.speed for frame in frames]), 0.998)))
    field = colours(1e-3 * top, top)
    level = np.floor(np.log(np.ma.filled(flow.speed, top) / field["low"]) / math.log(1e3) * COLOURS)
    level = np.where(flow.there, np.clip(level, 0, COLOURS - 1), NONE).astype("u1")
    return {"format": "drumlin-motion-1", "reduced": comparison["reduced"], "radius": radius, "marked": marked.tolist(),
            "sides": [comparison["particles"]["kind"], comparison["continuum"]["kind"]],
            "particles": described(frames, field), "tracers": described(tracers, field),
            "flow": {"theta": flow.theta, "axis_depth": flow.axis_depth, "x": [float(flow.x[0]), float(flow.x[-1]), len(flow.x)],
                     "z": [float(flow.z[0]), float(flow.z[-1]), len(flow.z)], "levels": base64.b64encode(level.tobytes()).decode("ascii")}}


def colours(low, high):
    import matplotlib.cm
    import matplotlib.colors
    table = [matplotlib.colors.to_hex(matplotlib.cm.get_cmap("viridis")(k / (COLOURS - 1))) for k in range(COLOURS)]
    return {"name": "speed", "low": low, "high": high, "scale": "log", "colours": table}


def main():
    comparison, maps, folder, *snapshots = sys.argv[1:]
    found = motion(snapshots, maps, script.content_of(comparison))
    if found is not None:
        whole_file.write_text(pathlib.Path(folder) / "motion.json", json.dumps(found))


if __name__ == "__main__":
    main()
