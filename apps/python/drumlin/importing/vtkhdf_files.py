"""VTKHDF files: PolyData or UnstructuredGrid, one instant or a series (its Steps)."""

import numpy as np

from .array_names import contact_columns, grain_columns
from .hdf5_files import Hdf5Frames, text_of, whole


class Series:
    """The instants of an open file: slices of its arrays (VTKHDF of VTK's documentation, version 2)."""

    def __init__(self, root):
        self.root, self.kind, self.steps = root, text_of(root.attrs["Type"]), root.get("Steps")
        self.times = np.array(self.steps["Values"], float) if self.steps else [None]
        self.numbers = range(len(self.times))

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


class VtkhdfFrames(Hdf5Frames):
    def series_of(self, text, file):
        if text_of(file["VTKHDF"].attrs.get("Type", b"")) not in ("PolyData", "UnstructuredGrid"):
            text.refuse("VTKHDF", "is no group of the type PolyData or UnstructuredGrid", "VTKHDF")
        return Series(file["VTKHDF"])

    def frame_of(self, text, series, number):
        return *self.columns_of(text, series, number), self.time_of(text.refuse, "Steps in the file", series.times[number]), None


class Grains(VtkhdfFrames):
    def columns_of(self, text, series, number):
        points = series.points(number)
        return grain_columns(points, series.point_arrays(number, len(points)), self, text.refuse)


class Contacts(VtkhdfFrames):
    """Lines of a PolyData, with ids of the grains as their points or in arrays."""

    def columns_of(self, text, series, number):
        if series.kind == "PolyData" and "Lines" not in series.root:
            text.refuse("contacts", "there are no lines", "a PolyData with Lines")
        ends, arrays = series.lines(number)
        return contact_columns(ends, arrays, self.source, self.units, text.refuse)
