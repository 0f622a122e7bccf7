"""The contacts of one frame as a snapshot holds them."""

import numpy as np

from .grains import nearest_image
from .text import shown

NORMAL_TOLERANCE = 1e-3  # of the length of a unit normal in a table of few digits
PLACE_TOLERANCE = 0.02  # of a radius, of an image beside its grain
NEIGHBOURS = 8  # of a contact, among which its grain is


def _ids(frame, name, scales):
    value = frame.values(name, scales)
    frame.require((value == np.floor(value)) & (np.abs(value) <= 1e15), name, lambda row: f"{shown(value[row])} is no whole number", "the id of a grain")
    return value.astype(np.int64)


def _places(sorted_ids, wanted):
    """(place of each among the ids, whether it is there)"""
    place = np.minimum(np.searchsorted(sorted_ids, wanted), len(sorted_ids) - 1)
    return place, (sorted_ids[place] == wanted if len(sorted_ids) else np.zeros(len(wanted), bool))


def _force_of(frame, scales):
    """(force on i as rows of components or, of discs, of the normal and the tangent; whether by components)"""
    components = ["f_" + axis for axis in scales.axes]
    by_components = "y" in scales.axes or "f_x" in frame.columns or "f_n" not in frame.columns
    return np.array([frame.values(name, scales) for name in (components if by_components else ("f_n", "f_t"))]), by_components


def _bodies_behind(s, frame, grains_frame, bodies, scales, first, second):
    """Images across a period, whose ids are beyond those of all grains, by the ids of their grains: (first, second, whether a row tells a new contact). The
    image lies along the normal, as far as the radii and the overlap say. Told from both sides are those of two grains that move, each beside the image of
    the other."""
    if "overlap" not in frame.columns:  # of another program than MercuryDPM
        return first, second, np.ones(len(first), bool)
    last = bodies.id.max()
    told = first <= last
    rows = np.flatnonzero(told & (second > last))
    if told.all() and not len(rows):
        return first, second, told
    from scipy.spatial import cKDTree

    by_id = np.argsort(bodies.id)
    center = np.array([grains_frame.values(axis, scales) for axis in scales.axes])[:, by_id]
    radius = grains_frame.values("radius", scales)[by_id]
    i, overlap = np.searchsorted(bodies.id[by_id], first[rows]), frame.values("overlap", scales)[rows]
    normal = np.array([frame.values("normal_" + axis, scales)[rows] for axis in scales.axes])
    period = np.array([[s.get("period_" + axis, 0.0)] for axis in scales.axes])

    def in_box(places):
        inside = np.mod(places, period, where=period > 0, out=places.copy())
        return np.where((period > 0) & (inside >= period), 0.0, inside).T

    tree = cKDTree(in_box(center), boxsize=period[:, 0])
    near = np.array(tree.query(in_box(center[:, i] - normal * radius[i]), k=range(1, min(NEIGHBOURS, len(radius)) + 1))[1]).reshape(len(rows), -1)
    image = (center[:, i] - normal * (radius[i] - overlap))[:, :, None] - normal[:, :, None] * radius[near]
    off = np.sqrt((nearest_image(s, scales.axes, image - center[:, near]) ** 2).sum(axis=0))
    best, row = off.argmin(axis=1), np.arange(len(rows))
    frame.require(off[row, best] <= PLACE_TOLERANCE * radius[i], "j", lambda c: f"there is no grain {second[rows[c]]}, nor does a grain lie where its image would",
                  "periodic_x and periodic_y of the description as in the other program", rows)
    j = near[row, best]
    second = second.copy()
    second[rows] = bodies.id[by_id[j]]
    pair, reverse = i * len(radius) + j, j * len(radius) + i
    told[rows[(i > j) & np.isin(pair, reverse)]] = False
    return first, second, told


def _ends(s, frame, grains_frame, bodies, scales, force):
    """(rows that carry a force between a grain and something, its grain i and other body j by their ids, sign of the force, whether j is a wall, whether
    that is an atom). A contact that is told from the side of the wall is turned."""
    first, second, told = _bodies_behind(s, frame, grains_frame, bodies, scales, _ids(frame, "i", scales), _ids(frame, "j", scales))
    wall_ids = bodies.id[bodies.walls]

    def is_wall(ids):
        return (ids < 0) | np.isin(ids, wall_ids)

    from_wall = is_wall(first)
    first, second = np.where(from_wall, second, first), np.where(from_wall, first, second)
    rows = np.flatnonzero(told & ~is_wall(first) & (force != 0).any(axis=0))  # not those of a wall on a wall
    first, second, sign = first[rows], second[rows], np.where(from_wall[rows], -1.0, 1.0)
    frame.require(first != second, "i, j", lambda c: f"grain {first[c]} touches itself", rows=rows)
    return rows, first, second, sign, is_wall(second), is_wall(second) & (second >= 0)


def _normals_along_centres(s, frame, grains_frame, bodies, scales, i, j, second, kinds, rows):
    """Not of length 1."""
    at_wall, of_atom = kinds
    center = np.array([s["grains/" + axis] for axis in scales.axes])
    other = center[:, np.where(at_wall, 0, j)]
    if of_atom.any():
        sorted_walls = bodies.walls[np.argsort(bodies.id[bodies.walls])]
        place, _ = _places(bodies.id[sorted_walls], second[of_atom])
        other[:, of_atom] = [grains_frame.values(name, scales)[sorted_walls[place]] for name in scales.axes]
    normal = nearest_image(s, scales.axes, center[:, i] - other)
    bare = at_wall & ~of_atom
    if s.get("container/radius", 0.0) > 0:
        normal[:, bare] = np.array([[s["container/x"]], [s["container/z"]]]) - center[:, i[bare]]
    else:
        frame.require(~bare, "normal_x", "the normal of a contact with a wall is not given", "columns normal_x, normal_z, or a drum in the description", rows)
    return normal


def add_contacts(s, frame, grains_frame, bodies, scales):
    """The contacts that carry a force, to a snapshot whose grains are there. A negative j is a wall. The force is f_n, f_t or f_x, f_y, f_z, on i; the
    normal that of the frame, else along the centres, at the drum towards its axis."""
    force, by_components = _force_of(frame, scales)
    rows, first, second, sign, at_wall, of_atom = _ends(s, frame, grains_frame, bodies, scales, force)
    force = force[:, rows]
    (i, known), (j, j_known) = _places(bodies.ids, first), _places(bodies.ids, second)
    frame.require(known, "i, j", lambda c: f"there is no grain {first[c]}", rows=rows)
    frame.require(j_known | at_wall, "i, j", lambda c: f"there is no grain {second[c]}", rows=rows)
    names = ["normal_" + axis for axis in scales.axes]
    given = bool(set(names) & frame.columns.keys())
    if given:
        normal = np.array([frame.values(name, scales) for name in names])[:, rows]
        length = np.sqrt((normal * normal).sum(axis=0))
        frame.require(np.abs(length - 1) <= NORMAL_TOLERANCE, "normal_x", lambda c: f"the normal has the length {shown(length[c])}", "1", rows)
    else:
        normal = _normals_along_centres(s, frame, grains_frame, bodies, scales, i, j, second, (at_wall, of_atom), rows)
        length = np.sqrt((normal * normal).sum(axis=0))
    frame.require(length > 0, "", "both bodies are at one place", rows=rows)
    normal = normal / length * (sign if given else 1)
    if by_components:
        force = sign * force
    if np.sum(np.sum(force * normal, axis=0) if by_components else force[0]) < 0:
        frame.refuse("contacts", "the contacts of this snapshot pull, in sum", "forces on the first grain of a contact, normals towards it")
    s |= {"contacts/i": i.astype("i4"), "contacts/j": np.where(at_wall, np.where(of_atom, -1, second), j).astype("i4")}
    s |= {name: along.astype("f4") for name, along in zip(("contacts/" + name for name in names), normal)}
    if "y" in scales.axes:
        s |= {"contacts/force_" + axis: along for axis, along in zip(scales.axes, force)}
        return
    n_x, n_z = normal
    f_n, f_t = (force[0] * n_x + force[1] * n_z, force[0] * n_z - force[1] * n_x) if by_components else force
    s |= {"contacts/impulse_n": f_n * s["time_step"], "contacts/impulse_t": f_t * s["time_step"]}
