"""The grains of one frame as a snapshot holds them."""

import math

import numpy as np

from ..errors import InputError
from .frame import SAME, SI, Scales, SphereScales
from .text import shown

ONE_PLACE = 1e-9  # d


class Bodies:
    """Who the rows of a frame are: `grains`, rows in the order of their ids; `walls`, rows of atoms of walls; `id` of each row."""

    def __init__(self, frame, wall_types):
        count = len(frame.lines)
        id_ = frame.columns["id"].values if "id" in frame.columns else np.arange(count, dtype=float)
        frame.require((id_ == np.floor(id_)) & (id_ >= 0) & (id_ < 1e15), "id", lambda row: f"{shown(id_[row])} is no id", "a whole number >= 0")
        self.id = id_.astype(np.int64)
        wall = np.isin(frame.values("type", SI), wall_types) if wall_types else np.zeros(count, bool)
        self.walls, self.grains = np.flatnonzero(wall), np.flatnonzero(~wall)
        self.grains = self.grains[np.argsort(self.id[self.grains], kind="stable")]
        self.ids = self.id[self.grains]
        frame.require(np.diff(self.ids, prepend=-1) > 0, frame.word("id"), lambda g: f"{self.ids[g]} appears twice in one snapshot", rows=self.grains)
        if not len(self.grains):
            frame.refuse("", "there are no grains", row=0)


def scales_for(description, frame, bodies):
    """Units from the description; the mean diameter from the first snapshot unless it is given."""
    grains, gravity = description["grains"], description["gravity"]["acceleration_m_s2"]
    diameter_m = grains.get("mean_diameter_m")
    if diameter_m is None:
        radius = frame.values("radius", SI)
        if not frame.columns["radius"].in_si:
            raise InputError(f"grains.mean_diameter_m: is needed, for the radii of {frame.file} have no unit")
        diameter_m = float(np.cumsum(2 * radius[bodies.grains] / len(bodies.grains))[-1])
        if not diameter_m > 0:
            frame.refuse("radius", "the mean radius is not above 0", row=0)
    kind = SphereScales if description.get("dimensions", 2) == 3 else Scales
    return kind(diameter_m, math.sqrt(diameter_m / (gravity or 9.81)), grains["density_kg_m3"])


def still_parts(description, scales):
    """What of a snapshot does not come from the files."""
    direction, drum = description["gravity"]["direction_deg"] * math.pi / 180, description.get("drum")
    pull = 1.0 if description["gravity"]["acceleration_m_s2"] > 0 else 0.0
    s = {"gravity_x": pull * math.cos(direction), "gravity_z": pull * math.sin(direction), "period_x": 0.0}
    if "y" in scales.axes:
        return s | {"format": "drumlin-spheres-1"} | {"period_" + axis: description["periodic_" + axis]["length_m"] / scales.length_m if "periodic_" + axis in description else 0.0
                    for axis in "xyz"} | {"tilt_xy": 0.0, "tilt_xz": 0.0, "tilt_yz": 0.0}
    s |= {"time_step": description.get("time_step_s", scales.time_s) / scales.time_s,
          "container/x": 0.0, "container/z": 0.0, "container/radius": 0.0, "wall/spin": 0.0, "velocity_window": 0.0}
    if drum:
        s |= {"container/x": drum["center_m"][0] / scales.length_m, "container/z": drum["center_m"][1] / scales.length_m,
              "container/radius": drum["radius_m"] / scales.length_m, "wall/spin": drum["speed_rpm"] * 2 * math.pi / 60 * scales.time_s}
    if "periodic_x" in description:
        s["period_x"] = description["periodic_x"]["length_m"] / scales.length_m
    return s


def _add_cell(s, frame, scales):
    """The periods of a frame that has a box: of spheres they are those of the box, of discs those of the description, which must fit."""
    if not frame.cell:
        return
    edges = frame.cell.edges / scales.length_m
    if "y" in scales.axes:
        for k, axis in enumerate("xyz"):
            s["period_" + axis] = float(edges[k, k]) if frame.cell.periodic[k] else 0.0
        s |= {"tilt_xy": float(edges[0, 1]), "tilt_xz": float(edges[0, 2]), "tilt_yz": float(edges[1, 2])}
        return
    period_m = s["period_x"] * scales.length_m
    own_m = frame.period_m
    if period_m > 0 and own_m is not None and not abs(own_m / period_m - 1) <= SAME:
        frame.refuse("BOX BOUNDS", f"are periodic over {own_m:g} m along x", f"{period_m:g} m, periodic_x.length_m of the description")


def nearest_image(s, axes, apart):
    """A vector (axis, row) between two places, from the nearest image of the one to the other."""
    for k in range(len(axes) - 1, -1, -1):
        period = s["period_" + axes[k]] if "period_" + axes[k] in s else 0.0
        if not period > 0:
            continue
        times = np.round(apart[k] / period)
        apart[k] -= period * times
        for lower in range(k):
            apart[lower] -= s.get(f"tilt_{axes[lower]}{axes[k]}", 0.0) * times
    return apart


def add_grains(s, frame, bodies, scales):
    """Places, radii and spins. Refused: grains that are not in the drum, of discs not in a plane, without a size, or two in one place."""
    _add_cell(s, frame, scales)
    rows = bodies.grains
    for name in (*scales.axes, "radius"):
        s["grains/" + name] = frame.values(name, scales)[rows]
    if "y" in scales.axes:
        for name in ("omega_x", "omega_y", "omega_z"):
            if name in frame.columns:
                s["grains/" + name] = frame.values(name, scales)[rows]
    for name, sign in (("spin_anticlockwise", -1), ("spin_clockwise", 1)):
        if name in frame.columns:
            s["grains/spin"] = sign * frame.values(name, scales)[rows]
    radius = s["grains/radius"]
    frame.require(radius > 0, frame.word("radius"), "is not above 0", "> 0", rows)
    places = np.array([s["grains/" + axis] for axis in scales.axes])
    words = ", ".join(frame.word(axis) for axis in scales.axes)
    if s.get("container/radius", 0.0) > 0:
        frame.require(np.hypot(places[0] - s["container/x"], places[1] - s["container/z"]) <= s["container/radius"], words,
                      "the grain lies outside of the drum", "centre, radius and units that fit the drum", rows)
    if "third" in frame.columns:
        third = frame.values("third", scales)[rows]
        frame.require(np.abs(third - third[0]) <= radius[0], "", "the grains lie in space, not in a plane",
                      "one layer of grains, or dimensions = 3", rows)
    _check_apart(frame, bodies, places, words)


def _check_apart(frame, bodies, places, words):
    """Two grains in one place are one that is written twice, or a column that is not what it says."""
    left, group = np.arange(places.shape[1]), np.zeros(places.shape[1], int)
    for along in places:
        order = np.lexsort((along[left], group))
        left, group = left[order], group[order]
        ends = (np.diff(group, prepend=-1) != 0) | (np.diff(along[left], prepend=-np.inf) > ONE_PLACE)
        group = np.cumsum(ends)
        shared = np.bincount(group)[group] > 1
        left, group = left[shared], group[shared]
    if len(left):
        a, b = sorted(left[:2])
        frame.refuse(words, f"grains {bodies.ids[a]} and {bodies.ids[b]} are in one place", "a place for each grain", bodies.grains[b])


def add_velocities(s, frame, bodies, scales):
    """Velocities that the frame gives."""
    for name in ("v_" + axis for axis in scales.axes):
        if name not in frame.columns:
            frame.refuse(frame.word(name), "no such column", 'one, or grains.velocities = "displacements" in the description')
        s["grains/" + name] = frame.values(name, scales)[bodies.grains]


def add_displacements(s, before, axes):
    """Velocities over the time since the snapshot before, of the same grains."""
    window = s["time"] - before["time"]
    moved = nearest_image(s, axes, np.array([s["grains/" + axis] - before["grains/" + axis] for axis in axes]))
    for k, axis in enumerate(axes):
        s["grains/v_" + axis] = moved[k] / window
        if axes == "xz":
            s["grains/displacement_" + axis] = moved[k]
    s["velocity_window"] = window
