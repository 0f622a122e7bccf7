"""Frames of files of HDF5, read one by one."""

import h5py

from ..errors import InputError
from .frame import BinaryFile, FramesInUnits, binary_frame
from .text import CutOff

# What h5py and numpy raise on a file that is not as it should be.
BROKEN = (OSError, LookupError, ValueError, TypeError, AttributeError, ArithmeticError, RuntimeError)


def text_of(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def whole(data, first, count):
    """Rows of a dataset, all of which must be there."""
    if first + count > len(data):
        raise ValueError(f"{data.name} holds {len(data)} of {first + count} rows")
    return data[first:first + count]


class Hdf5Frames(FramesInUnits):
    """A class of a format gives series_of(text, file), whose `numbers` are those of its frames, and frame_of(text, series, number): their rows, columns, time
    and cell."""

    opened = BinaryFile

    def frames_of(self, text):
        try:
            file = h5py.File(text.path, "r")
        except OSError as error:
            text.refuse("", f"is cut off or damaged: {error}", "a whole file of HDF5", CutOff)
        with file:
            try:
                series = self.series_of(text, file)
                for number in series.numbers:
                    text.number = self.first_line = f"frame {number}"
                    count, columns, time, cell = self.frame_of(text, series, number)
                    yield binary_frame(text.path, number, count, columns, time=time, cell=cell)
            except InputError:
                raise
            except BROKEN as error:
                text.refuse("", f"cannot be read: {error}", "whole arrays", CutOff)
