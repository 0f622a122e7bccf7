"""maps.h5 of either side and grains of a snapshot, both in the flow frame: x downslope, z along the outward normal."""

import math

import h5py
import numpy as np


def text_of(data):
    return bytes(data[:]).decode()


def read_maps(path, with_intervals=False):
    """(header, grids): each field as a masked array over (z, x), with the nodes x and z, and on request ci99/NAME, beside them."""
    with h5py.File(path) as file:
        if text_of(file["format"]) != "drumlin-maps-1":
            raise SystemExit(f"{path}: is not a file of maps of this version")
        header = dict(line.split(" = ", 1) for line in text_of(file["header"]).splitlines())
        grids = {name: np.ma.masked_invalid(data[:]) for name, data in file["fields"].items()}
        if with_intervals and "ci99" in file:
            grids |= {"ci99/" + name: np.ma.masked_invalid(data[:]) for name, data in file["ci99"].items()}
        grids["x"], grids["z"] = file["x"][:], file["z"][:]
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
