"""GSD files of HOOMD-blue, read by the package gsd (Debian: python3-gsd), which only they need."""

import numpy as np

from ..errors import InputError
from .array_names import grain_columns
from .frame import BinaryFile, Cell, Column, FramesInUnits, binary_frame
from .text import CutOff, refusal
from .units import force_unit

FORCE = "bonds/force_N"  # of the log: on the first grain of each bond; what drumlin export writes


def opened(path):
    try:
        import gsd.hoomd
    except ImportError as error:
        raise InputError(f"{path}: to read it the package gsd is needed (Debian: python3-gsd)") from error
    try:
        return gsd.hoomd.open(name=str(path), mode="rb")
    except (OSError, RuntimeError, ValueError) as error:
        raise refusal(path, 0, "", f"is no whole file of the schema hoomd: {error}", "GSD 1 or 2", CutOff) from error


def frame_at(path, trajectory, number):
    try:
        return trajectory[number]
    except (OSError, RuntimeError, ValueError, KeyError, IndexError) as error:
        raise refusal(path, f"frame {number}", "", f"cannot be read: {error}", "a whole frame", CutOff) from error


class GsdFrames(FramesInUnits):
    """The times are log/time (s) or the steps times step_s; bonds are contacts where the log holds their forces."""

    opened = BinaryFile

    def frames_of(self, text):
        with opened(text.path) as trajectory:
            for number in range(len(trajectory)):
                text.number = f"frame {number}"
                self.first_line = text.number
                stored = frame_at(text.path, trajectory, number)
                frame = binary_frame(text.path, number, *self.columns_of(text, stored), cell=self._cell_of(stored))
                time = np.ravel(stored.log["time"])[0] if "time" in stored.log else None
                frame.time = self.time_of(text.refuse, "configuration/step", time, stored.configuration.step or 0)
                yield frame

    def _cell_of(self, stored):
        """HOOMD's box is periodic along all of its edges; a plane one has no third."""
        if stored.configuration.box is None:
            return None
        l_x, l_y, l_z, xy, xz, yz = (float(value) for value in stored.configuration.box)
        edges = self.units.length_unit_m * np.array([[l_x, xy * l_y, xz * l_z], [0, l_y, yz * l_z], [0, 0, l_z]])
        periodic = tuple(bool(value) for value in stored.log["periodic"]) if "periodic" in stored.log else (True, True, stored.configuration.dimensions != 2)
        return Cell(edges, periodic)


class Grains(GsdFrames):
    def columns_of(self, text, stored):
        particles = stored.particles
        position = np.array(particles.position if particles.position is not None else np.zeros((0, 3)), float)
        if particles.image is not None and stored.configuration.box is not None:  # of the box that each has left
            position += np.array(particles.image, float) @ (self._cell_of(stored).edges.T / self.units.length_unit_m)
        arrays = {"id": np.arange(particles.N), "velocity": particles.velocity if particles.velocity is not None else np.zeros_like(position),
                  "diameter": particles.diameter if particles.diameter is not None else np.ones(particles.N)}
        if self.source["wall_types"]:
            arrays["type"] = particles.typeid
        if "particles/omega" in stored.log:
            arrays["omega"] = stored.log["particles/omega"]
        return grain_columns(position, arrays, self, text.refuse)


class Contacts(GsdFrames):
    def columns_of(self, text, stored):
        if FORCE not in stored.log:
            text.refuse("contacts", f"there is no log/{FORCE}: HOOMD stores no contacts", "files of drumlin export")
        pairs = np.array(stored.bonds.group if stored.bonds.N else np.zeros((0, 2)), float)
        force = np.array(stored.log[FORCE], float).reshape(-1, 3) * force_unit(self.source, self.units)
        columns = {"i": Column(pairs[:, 0], "number"), "j": Column(pairs[:, 1], "number")}
        return len(pairs), columns | {"f_" + axis: Column(force[:, k], "force") for k, axis in enumerate("xyz")}
