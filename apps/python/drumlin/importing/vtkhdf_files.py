"""VTKHDF files: PolyData or UnstructuredGrid, one instant or a series (its Steps)."""

import h5py
import numpy as np

from ..errors import InputError
from .frame import BinaryFile, TextFrames, binary_frame
from .text import CutOff, refusal
from .units import units_of
from .vtk_names import contact_columns, grain_columns

BROKEN = (OSError, KeyError, ValueError, IndexError, TypeError)
VTK_LINE = 3


def text_of(value):
    return value.decode() if isinstance(value, bytes) else str(value)


class Series:
    """The instants of an open file: slices of its arrays (VTKHDF of VTK's documentation, version 2)."""

    def __init__(self, root):
        self.root, self.kind, self.steps = root, text_of(root.attrs["Type"]), root.get("Steps")
        self.times = np.array(self.steps["Values"], float) if self.steps else None

    def __len__(self):
        return 1 if self.steps is None else len(self.times)

    def _parts(self, step):
        """Of the arrays that have an entry per part."""
        if self.steps is None:
            return slice(None)
        first = int(self.steps["PartOffsets"][step]) if "PartOffsets" in self.steps else step
        count = int(self.steps["NumberOfParts"][step]) if "NumberOfParts" in self.steps else 1
        return slice(first, first + count)

    def _offset(self, name, step, column=None):
        if self.steps is None or name not in self.steps:
            return 0
        value = self.steps[name][step]
        return int(value if column is None else np.ravel(value)[column])

    def points(self, step):
        count, first = int(np.sum(self.root["NumberOfPoints"][self._parts(step)])), self._offset("PointOffsets", step)
        return whole(self.root["Points"], first, count)

    def arrays(self, of, step, first, count):
        """Of PointData or CellData; `first`: of files without offsets of their own."""
        found = {}
        for name, data in self.root.get(of, {}).items():
            offsets = self.steps[of + "Offsets"] if self.steps and of + "Offsets" in self.steps else {}
            found[name] = whole(data, int(offsets[name][step]) if name in offsets else first, count)
        return found

    def point_arrays(self, step, count):
        return self.arrays("PointData", step, self._offset("PointOffsets", step), count)

    def lines(self, step):
        """(points of each line of two (rows, 2), arrays of the lines by their names)"""
        if self.kind == "PolyData":
            group, column = self.root["Lines"], 1
            before = sum(int(np.sum(self.root[kind]["NumberOfCells"][self._parts(step)])) for kind in ("Vertices",))
        else:
            group, column, before = self.root, 0, 0
        parts = self._parts(step)
        count, ids = int(np.sum(group["NumberOfCells"][parts])), int(np.sum(group["NumberOfConnectivityIds"][parts]))
        connectivity = whole(group["Connectivity"], self._offset("ConnectivityIdOffsets", step, column), ids)
        first = self._offset("CellOffsets", step, column)
        cells = self.root["CellData"] if "CellData" in self.root else {}
        if ids != 2 * count:
            raise ValueError("lines of other than two points")
        arrays = {}
        for name, data in cells.items():
            start = int(self.steps["CellDataOffsets"][name][step]) if self.steps and name in self.steps.get("CellDataOffsets", {}) else first
            arrays[name] = whole(data, start + before, count)
        return np.asarray(connectivity).reshape(-1, 2), arrays


def whole(data, first, count):
    """Rows of a dataset, all of which must be there."""
    if first + count > len(data):
        raise ValueError(f"{data.name} holds {len(data)} of {first + count} rows")
    return data[first:first + count]


class VtkhdfFrames(TextFrames):
    opened = BinaryFile

    def __init__(self, files, source):
        super().__init__(files)
        self.source, self.units = source, units_of(source)

    def frames_of(self, text):
        try:
            file = h5py.File(text.path, "r")
        except OSError as error:
            raise refusal(text.path, 0, "", f"is cut off or damaged: {error}", "a whole file of HDF5", CutOff) from error
        with file:
            if "VTKHDF" not in file or text_of(file["VTKHDF"].attrs.get("Type", b"")) not in ("PolyData", "UnstructuredGrid"):
                raise refusal(text.path, 0, "VTKHDF", "is no group of the type PolyData or UnstructuredGrid", "VTKHDF")
            series = Series(file["VTKHDF"])
            for number in range(len(series)):
                text.number = self.first_line = f"frame {number}"
                try:
                    count, columns = self.columns_of(text, series, number)
                except InputError:
                    raise
                except BROKEN as error:
                    raise refusal(text.path, text.number, "", f"cannot be read: {error}", "whole arrays", CutOff) from error
                frame = binary_frame(text.path, number, count, columns)
                frame.time = self._time_of(text, series, number)
                yield frame

    def _time_of(self, text, series, number):
        if series.times is not None:
            return float(series.times[number]) * self.units.time_unit_s
        if "interval_s" not in self.source:
            raise refusal(text.path, text.number, "", "has no time", "Steps in the file or files.interval_s in the description")
        return self.count * self.source["interval_s"]


class Grains(VtkhdfFrames):
    def columns_of(self, text, series, number):
        points = series.points(number)
        return grain_columns(points, series.point_arrays(number, len(points)), self.units, self.unused)


class Contacts(VtkhdfFrames):
    """Lines of a PolyData, with ids of the grains as their points or in arrays."""

    def columns_of(self, text, series, number):
        def refuse(key, what, allowed):
            raise refusal(text.path, text.number, key, what, allowed)

        if series.kind == "PolyData" and "Lines" not in series.root:
            refuse("contacts", "there are no lines", "a PolyData with Lines")
        ends, arrays = series.lines(number)
        return contact_columns(ends, arrays, self.source, self.units, refuse)
