"""What callers hand over, as the compiled part takes it."""

import os

import numpy as np

from .errors import InputError, IoError


def file_name(path):
    """The bytes of a path, whatever its encoding."""
    name = os.fsencode(path)
    if b"\0" in name:
        raise InputError(f"{path!r}: is no name of a file: it holds a NUL character")
    return name


def require_file(path):
    """Of anything else reading may never end."""
    if not path.is_file():
        raise IoError(f"{path}: is {'no file but a folder, a device, a FIFO or a socket' if path.exists() else 'missing'}")


def real(name, values):
    """An array of floating-point numbers; numpy would drop what is imaginary."""
    values = np.asarray(values)
    if np.iscomplexobj(values):
        raise InputError(f"{name}: holds complex numbers (allowed: real ones)")
    return values.astype(float)
