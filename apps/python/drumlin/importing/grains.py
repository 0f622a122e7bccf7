"""The grains of one frame as a snapshot holds them."""

import math

import numpy as np

from ..errors import InputError
from .frame import SI, Scales
from .text import shown

SAME = 1e-6  # relative: of the digits that a user writes
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
    return Scales(diameter_m, math.sqrt(diameter_m / (gravity or 9.81)), grains["density_kg_m3"])


def still_parts(description, scales):
    """What of a snapshot does not come from the files."""
    direction, drum = description["gravity"]["direction_deg"] * math.pi / 180, description.get("drum")
    s = {"time_step": description.get("time_step_s", scales.time_s) / scales.time_s, "gravity_x": math.cos(direction), "gravity_z": math.sin(direction),
         "container/x": 0.0, "container/z": 0.0, "container/radius": 0.0, "wall/spin": 0.0, "velocity_window": 0.0, "period_x": 0.0}
    if drum:
        s |= {"container/x": drum["center_m"][0] / scales.length_m, "container/z": drum["center_m"][1] / scales.length_m,
              "container/radius": drum["radius_m"] / scales.length_m, "wall/spin": drum["speed_rpm"] * 2 * math.pi / 60 * scales.time_s}
    if "periodic_x" in description:
        s["period_x"] = description["periodic_x"]["length_m"] / scales.length_m
    return s


def add_grains(s, frame, bodies, scales):
    """Places, radii and spins. Refused: grains that are not in the drum, not in a plane, without a size, or two in one place."""
    period_m = s["period_x"] * scales.length_m
    if period_m > 0 and frame.period_m is not None and not abs(frame.period_m / period_m - 1) <= SAME:
        frame.refuse("BOX BOUNDS", f"are periodic over {frame.period_m:g} m along x", f"{period_m:g} m, periodic_x.length_m of the description")
    rows = bodies.grains
    for name in ("x", "z", "radius"):
        s["grains/" + name] = frame.values(name, scales)[rows]
    for name, sign in (("spin_anticlockwise", -1), ("spin_clockwise", 1)):
        if name in frame.columns:
            s["grains/spin"] = sign * frame.values(name, scales)[rows]
    x, z, radius = s["grains/x"], s["grains/z"], s["grains/radius"]
    frame.require(radius > 0, frame.word("radius"), "is not above 0", "> 0", rows)
    place = f"{frame.word('x')}, {frame.word('z')}"
    if s["container/radius"] > 0:
        frame.require(np.hypot(x - s["container/x"], z - s["container/z"]) <= s["container/radius"], place, "the grain lies outside of the drum",
                      "centre, radius and units that fit the drum", rows)
    if "third" in frame.columns:
        third = frame.values("third", scales)[rows]
        frame.require(np.abs(third - third[0]) <= radius[0], "", "the grains lie in space, not in a plane", "one layer of grains", rows)
    _check_apart(frame, bodies, x, z, place)


def _check_apart(frame, bodies, x, z, place):
    """Two grains in one place are one that is written twice, or a column that is not what it says."""
    order = np.argsort(x, kind="stable")
    column = np.cumsum(np.diff(x[order], prepend=x[order[0]]) > ONE_PLACE)  # of grains above each other
    shared = np.bincount(column)[column] > 1
    order, column = order[shared], column[shared]
    upwards = np.lexsort((z[order], column))
    order, column = order[upwards], column[upwards]
    together = np.flatnonzero((np.diff(column) == 0) & (np.diff(z[order]) <= ONE_PLACE))
    if len(together):
        a, b = sorted(order[together[0]:together[0] + 2])
        frame.refuse(place, f"grains {bodies.ids[a]} and {bodies.ids[b]} are in one place", "a place for each grain", bodies.grains[b])


def add_velocities(s, frame, bodies, scales):
    """Velocities that the frame gives."""
    for name in ("v_x", "v_z"):
        if name not in frame.columns:
            frame.refuse(frame.word(name), "no such column", 'one, or grains.velocities = "displacements" in the description')
        s["grains/" + name] = frame.values(name, scales)[bodies.grains]


def add_displacements(s, before):
    """Velocities over the time since the snapshot before, of the same grains."""
    s["velocity_window"] = s["time"] - before["time"]
    for axis, period in (("x", s["period_x"]), ("z", 0.0)):
        moved = s["grains/" + axis] - before["grains/" + axis]
        if period > 0:
            moved -= period * np.round(moved / period)
        s["grains/displacement_" + axis], s["grains/v_" + axis] = moved, moved / s["velocity_window"]
