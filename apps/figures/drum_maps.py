"""maps.csv of a continuum flow and grains of a snapshot, both in the flow frame: x downslope, z along the outward normal."""

import csv
import math

import h5py
import numpy as np


def read_maps(path):
    """(header, grids): each column of maps.csv as a masked array over (z, x), with x and z beside them."""
    header = {}
    with open(path, newline="", encoding="utf-8") as stream:
        for line in stream:
            if not line.startswith("#"):
                break
            key, _, value = line[1:].partition("=")
            header[key.strip()] = value.strip()
        names = line.strip().split(",")
        rows = np.array([[float(entry) for entry in row] for row in csv.reader(stream)])
    spacing = float(header["spacing"])
    column = np.rint(rows[:, 0] / spacing).astype(int)
    row = np.rint(rows[:, 1] / spacing).astype(int)
    column_0, row_0 = column.min(), row.min()
    shape = (row.max() - row_0 + 1, column.max() - column_0 + 1)
    grids = {}
    for i, name in enumerate(names):
        grid = np.full(shape, np.nan)
        grid[row - row_0, column - column_0] = rows[:, i]
        grids[name] = np.ma.masked_invalid(grid)
    grids["x"] = spacing * (column_0 + np.arange(shape[1]))
    grids["z"] = spacing * (row_0 + np.arange(shape[0]))
    return header, grids


def read_grains(path, theta_deg, axis_depth):
    """Centres (z from the mean surface), radii and speeds in the frame of the drum, of one snapshot.

    theta_deg: slope of the surface; axis_depth: height of the drum's axis above it, d.
    """
    with h5py.File(path) as snapshot:
        grains = {name: snapshot["grains/" + name][:] for name in ("x", "z", "v_x", "v_z", "radius")}
        spin = snapshot["wall/spin"][0]
        x, z = grains["x"] - snapshot["container/x"][0], grains["z"] - snapshot["container/z"][0]
    speed = np.hypot(grains["v_x"] - spin * z, grains["v_z"] + spin * x)
    if spin < 0:  # an anticlockwise drum is looked at in a mirror
        x = -x
    theta = math.radians(theta_deg)
    return {"x": x * math.cos(theta) - z * math.sin(theta),
            "z": x * math.sin(theta) + z * math.cos(theta) + axis_depth,
            "radius": grains["radius"], "speed": speed}
