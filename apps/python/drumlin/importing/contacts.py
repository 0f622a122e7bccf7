"""The contacts of one frame as a snapshot holds them."""

import numpy as np

from .text import shown

NORMAL_TOLERANCE = 1e-3  # of the length of a unit normal in a table of few digits


def _ids(frame, name, scales):
    value = frame.values(name, scales)
    frame.require((value == np.floor(value)) & (np.abs(value) <= 1e15), name, lambda row: f"{shown(value[row])} is no whole number", "the id of a grain")
    return value.astype(np.int64)


def _places(sorted_ids, wanted):
    """(place of each among the ids, whether it is there)"""
    place = np.minimum(np.searchsorted(sorted_ids, wanted), len(sorted_ids) - 1)
    return place, (sorted_ids[place] == wanted if len(sorted_ids) else np.zeros(len(wanted), bool))


def add_contacts(s, frame, grains_frame, bodies, scales):
    """The contacts that carry a force, to a snapshot whose grains are there. A negative j is a wall. The force is f_n, f_t or f_x, f_z, on i; the normal
    that of the frame, else along the centres, at the drum towards its axis."""
    first, second = _ids(frame, "i", scales), _ids(frame, "j", scales)
    by_components = "f_x" in frame.columns or "f_n" not in frame.columns
    force = np.array([frame.values(name, scales) for name in (("f_x", "f_z") if by_components else ("f_n", "f_t"))])
    given = [frame.values(name, scales) for name in ("normal_x", "normal_z")] if {"normal_x", "normal_z"} & frame.columns.keys() else None
    wall_ids = bodies.id[bodies.walls]

    def is_wall(ids):
        return (ids < 0) | np.isin(ids, wall_ids)

    from_wall = is_wall(first)  # told from the wall's side
    first, second = np.where(from_wall, second, first), np.where(from_wall, first, second)
    rows = np.flatnonzero(~is_wall(first) & (force != 0).any(axis=0))  # not those of a wall on a wall
    first, second, force, sign = first[rows], second[rows], force[:, rows], np.where(from_wall[rows], -1.0, 1.0)
    at_wall, of_atom = is_wall(second), is_wall(second) & (second >= 0)
    (i, known), (j, j_known) = _places(bodies.ids, first), _places(bodies.ids, second)
    frame.require(known, "i, j", lambda c: f"there is no grain {first[c]}", rows=rows)
    frame.require(j_known | at_wall, "i, j", lambda c: f"there is no grain {second[c]}", rows=rows)
    frame.require(first != second, "i, j", lambda c: f"grain {first[c]} touches itself", rows=rows)
    center = np.array([s["grains/x"], s["grains/z"]])
    if given:
        normal = np.array(given)[:, rows]
        length = np.hypot(*normal)
        frame.require(np.abs(length - 1) <= NORMAL_TOLERANCE, "normal_x", lambda c: f"the normal has the length {shown(length[c])}", "1", rows)
    else:
        other = center[:, np.where(at_wall, 0, j)]
        if of_atom.any():
            sorted_walls = bodies.walls[np.argsort(wall_ids)]
            place, _ = _places(bodies.id[sorted_walls], second[of_atom])
            other[:, of_atom] = [grains_frame.values(name, scales)[sorted_walls[place]] for name in ("x", "z")]
        normal = center[:, i] - other
        if s["period_x"] > 0:
            normal[0] -= s["period_x"] * np.round(normal[0] / s["period_x"])
        bare = at_wall & ~of_atom
        if s["container/radius"] > 0:
            normal[:, bare] = np.array([[s["container/x"]], [s["container/z"]]]) - center[:, i[bare]]
        else:
            frame.require(~bare, "normal_x", "the normal of a contact with a wall is not given",
                          "columns normal_x, normal_z, or a drum in the description", rows)
    length = np.hypot(*normal)
    frame.require(length > 0, "", "both bodies are at one place", rows=rows)
    n_x, n_z = normal / length * (sign if given else 1)
    f_n, f_t = force  # the same seen from either side
    if by_components:
        f_x, f_z = sign * force
        f_n, f_t = f_x * n_x + f_z * n_z, f_x * n_z - f_z * n_x
    if np.sum(f_n) < 0:
        frame.refuse("contacts", "the contacts of this snapshot pull, in sum", "forces on the first grain of a contact, normals towards it")
    s |= {"contacts/i": i.astype("i4"), "contacts/j": np.where(at_wall, np.where(of_atom, -1, second), j).astype("i4"),
          "contacts/normal_x": n_x.astype("f4"), "contacts/normal_z": n_z.astype("f4"),
          "contacts/impulse_n": f_n * s["time_step"], "contacts/impulse_t": f_t * s["time_step"]}
