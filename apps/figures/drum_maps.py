"""maps.h5 of either side and grains of a snapshot, both in the flow frame: x downslope, z along the outward normal."""

import math

import h5py
import numpy as np

import result_files


def read_maps(path, with_intervals=False):
    """(header, grids): each field as a masked array over (z, x), with the nodes x and z, and on request ci99/NAME, beside them."""
    header, x, z, fields, half_widths = result_files.read_maps(path)
    grids = {name: np.ma.masked_invalid(values) for name, values in fields.items()}
    if with_intervals:
        grids |= {"ci99/" + name: np.ma.masked_invalid(values) for name, values in half_widths.items()}
    return header, grids | {"x": x, "z": z}


def read_grains(path, theta_deg, axis_depth):
    """Centres (z from the mean surface), radii and speeds in the frame of the drum, of one snapshot.

    theta_deg: slope of the surface; axis_depth: height of the drum's axis above it, d.
    """
    with h5py.File(path) as snapshot:
        grains = {name: snapshot["grains/" + name][:] for name in ("x", "z", "v_x", "v_z", "radius")}
        spin = result_files.number_of(snapshot["wall/spin"])
        x, z = grains["x"] - result_files.number_of(snapshot["container/x"]), grains["z"] - result_files.number_of(snapshot["container/z"])
    speed = np.hypot(grains["v_x"] - spin * z, grains["v_z"] + spin * x)
    if spin < 0:  # an anticlockwise drum is looked at in a mirror
        x = -x
    theta = math.radians(theta_deg)
    return {"x": x * math.cos(theta) - z * math.sin(theta),
            "z": x * math.sin(theta) + z * math.cos(theta) + axis_depth,
            "radius": grains["radius"], "speed": speed}
