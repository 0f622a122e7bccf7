"""Loads on the walls as means over time: impulses of single instants scatter by half the weight and more while grains fall."""

import pathlib

import numpy as np

from ..figures import result_files

WINDOW = 0.2  # sqrt(H0/g), about each time


def mean_loads(frames, folders, height):
    """The loads of frames from walls.csv of its runs (`folders`, in their order), each the mean over what lies within WINDOW about its time; NaN where that
    reaches before the origin. height: H0. None where a run has no walls.csv (output.walls_every_s of its scene)."""
    files = [pathlib.Path(folder) / "walls.csv" for folder in folders]
    if not files or not all(file.is_file() for file in files):
        return None
    length, time, density = (frames.scales[name] for name in ("length_m", "time_s", "density_kg_m3"))
    unit, half = density * length**3 / time**2, WINDOW / 2 * np.sqrt(height)
    found = {name: np.full(load.shape, np.nan) for name, load in frames.loads.items()}
    for run, file in enumerate(files):
        columns = result_files.read_table(file)[2]
        ends = (columns["time_s"] - float(frames.header["time_origin_s"])) / time
        middles = ends - columns["interval_s"] / time / 2
        force = np.array([columns["force_x_n_m"], columns["force_z_n_m"]]).T / unit
        for name, load in found.items():
            for t in np.flatnonzero(frames.times >= half):
                near = (columns["wall"] == name) & (np.abs(middles - frames.times[t]) <= half)
                load[run, t] = force[near].mean(axis=0) if near.any() else np.nan
    return found
