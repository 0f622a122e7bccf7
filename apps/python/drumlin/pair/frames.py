"""Averages in time of either side: frames.h5 (docs/formats/frames.md)."""

import dataclasses
import pathlib

import h5py
import numpy as np

from ..errors import InputError
from ..figures.result_files import number_of, text_of


@dataclasses.dataclass
class Frames:
    """Units d, sqrt(d/g), rho0 g d. R runs (a continuum: one), T times, C columns x, W rows z; NaN where there is no material."""

    path: pathlib.Path
    header: dict
    scales: dict  # length_m, time_s, density_kg_m3
    runs: list
    times: np.ndarray
    x: np.ndarray
    z: np.ndarray
    height: np.ndarray  # (R, T, C)
    mass_height: np.ndarray  # (R, T, C)
    fields: dict  # (R, T, W, C)
    scalars: dict  # (R, T)
    loads: dict  # (R, T, 2)


def read_frames(path):
    """A file of frames; InputError where it is none."""
    try:
        with h5py.File(path) as file:
            if text_of(file["format"]) != "drumlin-frames-1":
                raise InputError(f"{path}: format: is not known here (allowed: drumlin-frames-1)")
            header = dict(line.split(" = ", 1) for line in text_of(file["header"]).splitlines())
            groups = ({name: data[:] for name, data in file[group].items()} for group in ("fields", "scalars", "loads") if group in file)
            return Frames(pathlib.Path(path), header, {name: number_of(data) for name, data in file["scales"].items()},
                          text_of(file["runs"]).splitlines(), *(file[name][:] for name in ("times", "x", "z", "height", "mass_height")), *groups)
    except (KeyError, OSError) as error:
        raise InputError(f"{path}: is no file of frames: {error}") from error
