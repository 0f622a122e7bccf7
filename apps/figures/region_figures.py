"""Figures of a flow of a region: how fast the material is, frame by frame, and what the steps of its series say.

usage: region_figures.py FLOWRUN
"""

import pathlib
import sys

import numpy as np

import script
import style
from drumlin.pair.frames import read_frames

SERIES = (("fastest", r"largest speed  [$\sqrt{gd}$]"), ("kinetic_energy", r"kinetic energy  [$\rho_0gd^3$]"),
          ("discharge_rate", r"discharge  [$d^2/\sqrt{d/g}$]"), ("energy_error", r"error of the energy  [$\rho_0gd^3$]"))


def speeds(frames):
    """Speed at six times at most, on one scale."""
    speed = np.hypot(frames.fields["v_x"][0], frames.fields["v_z"][0])
    there = np.isfinite(speed).any(axis=0)
    columns, rows = np.flatnonzero(there.any(axis=0)), np.flatnonzero(there.any(axis=1))
    x0, x1, z0, z1 = frames.x[columns[0]], frames.x[columns[-1]], frames.z[rows[0]], frames.z[rows[-1]]
    chosen = np.unique(np.linspace(0, len(frames.times) - 1, min(6, len(frames.times))).round().astype(int))
    across = 1 if x1 - x0 > 3 * (z1 - z0) else min(3, len(chosen))
    figure, axes = style.maps(len(chosen), across, x1 - x0, z1 - z0, sharex=True, sharey=True)
    top = max(np.nanmax(speed), 1e-9)
    for axis, t in zip(axes, chosen):
        shown = axis.pcolormesh(frames.x, frames.z, speed[t], vmin=0, vmax=top, shading="nearest")
        axis.plot(frames.x, frames.height[0, t], color="black", lw=0.8)
        axis.set(xlim=(x0 - 1, x1 + 1), ylim=(z0 - 1, z1 + 1), aspect="equal")
        axis.set_title(rf"$t$ = {frames.times[t]:.3g} $\sqrt{{d/g}}$")
        axis.grid(False)
    figure.colorbar(shown, ax=axes, label=r"speed  [$\sqrt{gd}$]", shrink=0.7)
    return figure


def series(folder):
    steps = np.genfromtxt(folder / "series.csv", delimiter=",", names=True, comments="#", skip_header=1)
    shown = [(name, label) for name, label in SERIES if np.any(steps[name])]
    figure, axes = style.panels(len(shown), height=2.4, sharex=True)
    for axis, (name, label) in zip(axes, shown):
        axis.plot(steps["time"], steps[name], color=style.CONTINUUM)
        axis.set_ylabel(label)
    axes[-1].set_xlabel(r"$t$  [$\sqrt{d/g}$]")
    return figure


def main():
    folder = pathlib.Path(sys.argv[1])
    frames = read_frames(folder / "frames.h5")
    style.use_style()
    script.save_each({"frames": lambda: speeds(frames), "series": lambda: series(folder)}, folder, frames.header.get("reduced") == "true")


if __name__ == "__main__":
    sys.exit(main())
