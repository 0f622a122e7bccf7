"""Files of VTK, XML (.vtp, .vtu, .pvd) and legacy (.vtk), read by the package vtk (Debian: python3-vtk9), which only they need."""

import pathlib
import re
import xml.etree.ElementTree

import numpy as np

from ..errors import InputError
from .array_names import contact_columns, grain_columns
from .frame import BinaryFile, FramesInUnits, binary_frame
from .text import CutOff, refusal


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


class VtkFrames(FramesInUnits):
    """A frame per file. Its time is that of the .pvd or TimeValue, else the last number in the name of the file times step_s, else the files are interval_s
    apart."""

    opened = BinaryFile

    def frames_of(self, text):
        with open(text.path, "rb") as stream:
            collection = b'type="Collection"' in stream.read(1024)
        for time, path in _collection(text.path) if collection else [(None, text.path)]:
            found, file = dataset_of(path), BinaryFile(path)
            frame = binary_frame(str(path), self.count, *self.columns_of(file, found))
            stored, numbers = arrays_of(found.GetFieldData()), re.findall(r"\d+", pathlib.Path(path).stem) if "step_s" in self.source else []
            if time is None:
                time = next((np.ravel(stored[name])[0] for name in ("TimeValue", "TIME") if name in stored), None)
            frame.time = self.time_of(file.refuse, "TimeValue in the file, a .pvd, files.step_s", time, numbers[-1] if numbers else None)
            yield frame


class Grains(VtkFrames):
    def columns_of(self, file, found):
        return grain_columns(points_of(found), arrays_of(found.GetPointData()), self, file.refuse)


class Contacts(VtkFrames):
    """Lines between two points whose places are the ids of the grains, as Yade's VTKRecorder writes them, or with arrays of ids."""

    def columns_of(self, file, found):
        return contact_columns(lines_of(found), arrays_of(found.GetCellData()), self.source, self.units, file.refuse)
