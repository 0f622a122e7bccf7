"""Files of VTK, XML (.vtp, .vtu, .pvd) and legacy (.vtk), read by the package vtk (Debian: python3-vtk9), which only they need."""

import pathlib
import re
import xml.etree.ElementTree

import numpy as np

from ..errors import InputError
from .frame import BinaryFile, TextFrames, binary_frame
from .text import CutOff, refusal
from .units import units_of
from .vtk_names import contact_columns, grain_columns


def _vtk():
    try:
        import vtk
        from vtk.util.numpy_support import vtk_to_numpy
    except ImportError as error:
        raise InputError("files of VTK: to read them the package vtk is needed (Debian: python3-vtk9)") from error
    return vtk, vtk_to_numpy


def dataset_of(path):
    """A vtkPointSet; refused where its reader reports an error."""
    vtk, _ = _vtk()
    with open(path, "rb") as stream:
        legacy = stream.read(5) == b"# vtk"
    reader = vtk.vtkGenericDataObjectReader() if legacy else vtk.vtkXMLGenericDataObjectReader()
    if legacy:
        for kind in ("Scalars", "Vectors", "Fields"):
            getattr(reader, f"ReadAll{kind}On")()
    errors = []
    for source in filter(None, (reader, None if legacy else getattr(reader, "GetReader", lambda: None)())):
        source.AddObserver("ErrorEvent", lambda *_: errors.append("the reader of VTK reports an error"))
    window = vtk.vtkOutputWindow.GetInstance()
    window.AddObserver("ErrorEvent", lambda *_: errors.append("the reader of VTK reports an error"))
    display, silent = window.GetDisplayMode(), window.NEVER if hasattr(window, "NEVER") else 0
    window.SetDisplayMode(silent)
    reader.SetFileName(str(path))
    reader.Update()
    window.SetDisplayMode(display)
    window.RemoveAllObservers()
    found = reader.GetOutput()
    if errors or found is None or not hasattr(found, "GetPoints"):
        raise refusal(path, 0, "", errors[0] if errors else "holds no points", "a whole file with points", CutOff if errors else InputError)
    return found


def arrays_of(attributes):
    _, vtk_to_numpy = _vtk()
    return {attributes.GetArrayName(k): vtk_to_numpy(attributes.GetArray(k)) for k in range(attributes.GetNumberOfArrays()) if attributes.GetArray(k)}


def points_of(found):
    _, vtk_to_numpy = _vtk()
    return vtk_to_numpy(found.GetPoints().GetData()) if found.GetPoints() else np.zeros((0, 3))


def lines_of(found):
    """Points of each line of two (rows, 2)."""
    vtk, _ = _vtk()
    pairs, ids = [], vtk.vtkIdList()
    for k in range(found.GetNumberOfCells()):
        if found.GetCellType(k) in (vtk.VTK_LINE, vtk.VTK_POLY_LINE):
            found.GetCellPoints(k, ids)
            pairs.append((ids.GetId(0), ids.GetId(1)))
    return np.array(pairs, int).reshape(-1, 2)


def _collection(path):
    """[(time, file)] of a .pvd."""
    try:
        root = xml.etree.ElementTree.parse(path).getroot()
        found = [(float(entry.get("timestep")), pathlib.Path(path).parent / entry.get("file")) for entry in root.iter("DataSet")]
    except (xml.etree.ElementTree.ParseError, TypeError, ValueError) as error:
        raise refusal(path, 0, "", f"is no whole collection: {error}", "DataSet elements with timestep and file") from error
    return sorted(found, key=lambda entry: entry[0])


class VtkFrames(TextFrames):
    """A frame per file. Its time is that of the .pvd or TimeValue, else the last number in the name of the file times step_s, else the files are interval_s
    apart."""

    opened = BinaryFile

    def __init__(self, files, source):
        super().__init__(files)
        self.source, self.units = source, units_of(source)

    def frames_of(self, text):
        with open(text.path, "rb") as stream:
            collection = b'type="Collection"' in stream.read(1024)
        for time, path in _collection(text.path) if collection else [(None, text.path)]:
            found = dataset_of(path)
            frame = binary_frame(str(path), self.count, *self.columns_of(str(path), found))
            frame.time = self._time_of(found, path) if time is None else time * self.units.time_unit_s
            yield frame

    def _time_of(self, found, path):
        stored = arrays_of(found.GetFieldData())
        for name in ("TimeValue", "TIME"):
            if name in stored:
                return float(np.ravel(stored[name])[0]) * self.units.time_unit_s
        numbers = re.findall(r"\d+", pathlib.Path(path).stem)
        if "step_s" in self.source and numbers:
            return int(numbers[-1]) * self.source["step_s"]
        if "interval_s" in self.source:
            return self.count * self.source["interval_s"]
        raise refusal(path, 0, "", "has no time", "TimeValue in the file, a .pvd, or files.step_s or files.interval_s in the description")


class Grains(VtkFrames):
    def columns_of(self, path, found):
        return grain_columns(points_of(found), arrays_of(found.GetPointData()), self.units, self.unused)


class Contacts(VtkFrames):
    """Lines between two points whose places are the ids of the grains, as Yade's VTKRecorder writes them, or with arrays of ids."""

    def columns_of(self, path, found):
        def refuse(key, what, allowed):
            raise refusal(path, 0, key, what, allowed)

        return contact_columns(lines_of(found), arrays_of(found.GetCellData()), self.source, self.units, refuse)
