"""The free surface of continuum drums, flat and moved, beside the particles': height over x along the middle of the surface.

usage: surface_figures.py OUT.png FLOWRUN [FLOWRUN ...] [--particles RUN [RUN ...]]

FLOWRUNs are flows with effects.moving_surface; RUNs (one per FLOWRUN, in their order) are particle runs with measured/maps.h5.
"""

import argparse
import json
import pathlib

import h5py
import matplotlib.pyplot as plt
import numpy as np
import style


def particle_surface(run, level=0.4):
    """Highest place in each column where the volume fraction falls through `level`: the line that gives the slope."""
    with h5py.File(pathlib.Path(run) / "measured" / "maps.h5") as maps:
        x, z, nu = maps["x"][:], maps["z"][:], np.nan_to_num(maps["fields/nu"][:])
    up = np.argsort(z)
    z, nu = z[up], nu[up]
    height = np.full(len(x), np.nan)
    for column in range(len(x)):
        inside = np.nonzero(nu[:, column] > level)[0]
        if len(inside) == 0 or inside[-1] + 1 == len(z):
            continue
        i = inside[-1]
        height[column] = z[i] + (nu[i, column] - level) / (nu[i, column] - nu[i + 1, column]) * (z[i + 1] - z[i])
    return x, height


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("flows", nargs="+", type=pathlib.Path)
    parser.add_argument("--particles", nargs="*", default=[])
    arguments = parser.parse_args()
    style.use_style()
    figure, axes = plt.subplots(len(arguments.flows), 1, figsize=(9, 3.4 * len(arguments.flows)), squeeze=False, sharex=True)
    reduced = False
    for i, folder in enumerate(arguments.flows):
        flow = json.loads((folder / "flow.json").read_text())
        reduced |= flow["reduced"]
        place, surface = axes[i, 0], flow["surface"]
        if i < len(arguments.particles):
            x, z = particle_surface(arguments.particles[i])
            middle = np.abs(x) < 5
            place.plot(x, z - np.nanmean(z[middle]), color=style.PARTICLES, label=r"particles, $\nu = 0.4$")
        z = np.array(surface["z"]) - surface["z_middle"]
        last = surface["steps"][-1]
        place.plot(surface["x"], z, color=style.CONTINUUM,
                   label=f"continuum, {last['pressed_rms']:.2f} $d$ left (rms)")
        place.axhline(0, color="grey", linewidth=0.8, linestyle=":")
        settings = flow["settings"]
        rpm = settings["rotation"] / settings["scales"]["time_s"] * 30 / np.pi
        place.set_title(f"drum at {rpm:g} rpm: slope of the continuum's middle {flow['theta_deg']:.2f} deg")
        place.set_ylabel(r"height above the middle  [$d$]")
        place.legend(loc="best")
    axes[-1, 0].set_xlabel(r"$x$  [$d$], downslope")
    style.save(figure, arguments.out, reduced)


if __name__ == "__main__":
    main()
