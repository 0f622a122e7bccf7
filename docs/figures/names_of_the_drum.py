"""What theta, H, lambda, x and z are, drawn into the measured speed of a rotating drum.

usage: names_of_the_drum.py PICTURE RUN   (RUN: a measured run with maps, such as data/bed/6rpm-5turns-seed2)
"""

import math
import pathlib
import sys

import numpy as np

import drum_maps
import script
import style

plt = style.plt

INK = "#202020"


def turned(x, z, theta):
    """From the axes of the flow (x downslope) to those of the laboratory, where the surface falls to the right."""
    return x * math.cos(theta) + z * math.sin(theta), -x * math.sin(theta) + z * math.cos(theta)


def arrow(axes, start, end, theta, head="->"):
    axes.annotate("", turned(*end, theta), turned(*start, theta), arrowprops={"arrowstyle": head, "color": INK, "linewidth": 1.6, "shrinkA": 0, "shrinkB": 0})


def word(axes, x, z, theta, text, **more):
    axes.text(*turned(x, z, theta), text, color=INK, fontsize=14, bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.5}, **more)


def draw(axes, header, grids, scalars):
    theta, H, length = (scalars[name]["value"] for name in ("theta_deg", "H", "lambda"))
    theta = math.radians(theta)
    x, z = np.meshgrid(grids["x"], grids["z"])
    speed = np.ma.hypot(grids["v_x"], grids["v_z"])
    seen = np.ma.masked_where(np.ma.getmaskarray(speed) | (grids["nu"].filled(0) < 0.4), speed)
    colours = axes.pcolormesh(*turned(x, z, theta), np.ma.log10(seen), cmap="viridis", vmin=-2.5, vmax=0.6, rasterized=True)
    axis_depth, radius = float(header["axis_depth"]), float(header["drum_radius"])
    axes.add_patch(plt.Circle(turned(0, axis_depth, theta), radius, fill=False, color=INK, linewidth=2))
    half = math.sqrt(radius**2 - axis_depth**2)
    axes.plot(*zip(turned(-half, 0, theta), turned(half, 0, theta)), color=INK, linewidth=1)
    level, corner = turned(half, 0, theta), turned(-half * 0.1, 0, theta)
    axes.plot([corner[0], level[0]], [corner[1], corner[1]], color=INK, linewidth=1, linestyle="--")
    axes.annotate(r"$\theta$", (corner[0] + 40, corner[1] - 6.5), color=INK, fontsize=16, ha="center", va="center",
                  bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.5})
    arrow(axes, (0, 24), (26, 24), theta)
    word(axes, 30, 24, theta, "$x$", va="center", ha="center")
    arrow(axes, (0, 24), (0, 48), theta)
    word(axes, 0, 52, theta, "$z$", va="center", ha="center")
    arrow(axes, (-20, 0), (-20, -H), theta, "<->")
    word(axes, -23, -H / 2, theta, "$H$", va="center", ha="right")
    axes.plot(*zip(turned(-38, -H, theta), turned(30, -H, theta)), color=INK, linewidth=1, linestyle=":")
    arrow(axes, (8, -H), (8, -H - length), theta, "|-|")
    word(axes, 12, -H - length - 3, theta, r"$\lambda$: here the shear rate falls to 1/e", va="top", ha="center")
    axes.set_aspect("equal")
    axes.set_axis_off()
    return colours


def main():
    if len(sys.argv) != 3:
        raise SystemExit(__doc__)
    picture, run = map(pathlib.Path, sys.argv[1:])
    style.use_style()
    header, grids = drum_maps.read_maps(run / "measured/maps.h5")
    scalars = script.content_of(run / "measured/measured.json")
    figure, (axes,) = style.panels(1, height=6)
    axes.grid(False)
    colours = draw(axes, header, grids, scalars)
    bar = figure.colorbar(colours, ax=axes, shrink=0.6)
    bar.set_label(r"$\log_{10}$ of the speed in the frame of the drum  [$\sqrt{gd}$]")
    style.save(figure, picture, header.get("reduced") == "true")


if __name__ == "__main__":
    main()
