"""Walls and openings of a flow scene, where limits of a pair ask for them."""

import dataclasses

import numpy as np
import scipy.interpolate

from ..study.runs import read_toml


@dataclasses.dataclass
class Walls:
    """Straight ones by name, each a list of (from, to); d."""

    walls: dict = dataclasses.field(default_factory=dict)
    openings: dict = dataclasses.field(default_factory=dict)

    @classmethod
    def of_scene(cls, path, length_m):
        scene, found = read_toml(path, "drumlin-flow-scene-1"), cls()
        for into, key in ((found.walls, "walls"), (found.openings, "openings")):
            for part in scene.get(key, []):
                if "from_mm" in part:
                    into.setdefault(part["name"], []).append(np.array([part["from_mm"], part["to_mm"]]) / (1e3 * length_m))
        return found

    def slot(self):
        """((x0, x1), z) of the first opening; None without one."""
        for ends, *_ in self.openings.values():
            return np.sort(ends[:, 0]), ends[:, 1].mean()
        return None

    def inside(self, name, distance, there):
        """Lines at a distance from the walls of a name, on the side where more material is: [(points, normal)]. there(points): where material is."""
        found = []
        for begin, end in self.walls.get(name, []):
            along = (end - begin) / np.linalg.norm(end - begin)
            normal = np.array([-along[1], along[0]])
            points = begin + np.outer(np.arange(0, np.linalg.norm(end - begin), 1.0), along)
            found.append(max(((points + sign * distance * normal, normal) for sign in (1, -1)), key=lambda line: there(line[0]).sum()))
        return found


def at(frames, values, points):
    """A field between its nodes; NaN beside one without material."""
    return scipy.interpolate.RegularGridInterpolator((frames.z, frames.x), values, bounds_error=False)(points[:, ::-1])


def normal_stress(frames, stress, lines):
    """On all points of lines of Walls.inside(); sigma_xz is minus the entry of the pressure tensor."""
    return np.concatenate([n_x**2 * at(frames, stress["sigma_xx"], points) + n_z**2 * at(frames, stress["sigma_zz"], points)
                           - 2 * n_x * n_z * at(frames, stress["sigma_xz"], points) for points, (n_x, n_z) in lines])
