"""Figures of `drumlin compare`: both profiles over depth, each at its own layers, the particles' 99 % interval as a band."""

import argparse
import math

import matplotlib.collections
import matplotlib.colors
import matplotlib.pyplot as plt
import numpy as np

import style
from drum_maps import read_grains, read_maps


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--particles", required=True, help="profiles.csv of the particles")
    parser.add_argument("--continuum", required=True, help="profiles.csv of the continuum")
    parser.add_argument("--output", required=True, help="folder for the figures")
    parser.add_argument("--snapshot", required=True, help="snapshot of the particle run to draw")
    parser.add_argument("--maps", required=True, help="maps.h5 of the continuum")
    parser.add_argument("--depth", type=float, default=math.nan, help="H of the particles, d")
    return parser.parse_args()


def mark_depths(axes, depth):
    """Dotted line at the interface, dashed line at the free surface, as in the paper's figures."""
    axes.axvline(0, color="0.4", linestyle="--", linewidth=1)
    if not math.isnan(depth):
        axes.axvline(-depth, color="0.4", linestyle=":", linewidth=1)
    axes.set_xlabel(style.LABELS["z"])


def positive(values):
    """What a logarithmic axis can show."""
    return [value if value > 0 else math.nan for value in values]


def draw(axes, name, particles, continuum, logarithmic=False):
    """One quantity over depth, both sides."""
    keep = positive if logarithmic else list
    if name in particles:
        ours, half_width = keep(particles[name]), particles.get(name + "_ci99")
        if half_width is not None and logarithmic:
            # A band that reaches zero ends at the foot of the axis instead of taking the axis with it.
            low = [max(value - width, 1e-2 * value) for value, width in zip(ours, half_width)]
            high = [value + width for value, width in zip(ours, half_width)]
            axes.fill_between(particles["z"], low, high, color=style.PARTICLES, alpha=0.25, linewidth=0)
            half_width = None
        style.band(axes, particles["z"], ours, half_width, style.PARTICLES, "particles, 99 %")
    if name in continuum:
        axes.plot(continuum["z"], keep(continuum[name]), color=style.CONTINUUM, label="continuum")
    axes.set_ylabel(style.LABELS[name])
    if logarithmic:
        axes.set_yscale("log")


def limit_to_the_packing(axes, name, sides):
    """The few grains above the surface, and their wide bands, would set the scale: it is taken from z < 0 instead."""
    values = [value for side in sides if name in side for z, value in zip(side["z"], side[name])
              if z < 0 and math.isfinite(value)]
    if values:
        margin = 0.1 * (max(values) - min(values))
        axes.set_ylim(min(values) - margin, max(values) + margin)


def over_depth(names, particles, continuum, depth, size):
    """Panels side by side; `names` as (column, logarithmic)."""
    figure, panels = plt.subplots(1, len(names), figsize=size, squeeze=False)
    for axes, (name, logarithmic) in zip(panels[0], names):
        draw(axes, name, particles, continuum, logarithmic)
        if not logarithmic:
            limit_to_the_packing(axes, name, (particles, continuum))
        mark_depths(axes, depth)
    panels[0][0].legend()
    return figure


def friction(particles, continuum):
    """mu over I, the layers of both sides; the flow pays for every percent of it."""
    figure, axes = plt.subplots()
    for columns, color, marker, label in ((particles, style.PARTICLES, "o", "particles"),
                                          (continuum, style.CONTINUUM, "x", "continuum")):
        if "I" in columns and "mu" in columns:
            axes.plot(positive(columns["I"]), columns["mu"], marker, color=color, label=label)
    axes.set_xscale("log")
    axes.set_xlabel(style.LABELS["I"])
    axes.set_ylabel(style.LABELS["mu"])
    axes.legend()
    return figure


def outline(axes, radius, axis_depth):
    """The drum, its axis `axis_depth` above the free surface."""
    angle = np.linspace(0, 2 * math.pi, 400)
    axes.plot(radius * np.sin(angle), axis_depth - radius * np.cos(angle), color="black", linewidth=1)
    axes.set_aspect("equal")
    axes.set_xlim(-1.02 * radius, 1.02 * radius)
    axes.set_ylim(axis_depth - 1.02 * radius, 0.3 * radius)
    axes.grid(False)
    axes.set_xlabel(r"$x$  [$d$], downslope")
    axes.set_ylabel(style.LABELS["z"])


def drums(particles_header, options):
    """Grains of one instant beside the continuum's steady flow: speed in the frame of the drum, on one colour scale."""
    axis_depth, radius = float(particles_header["axis_depth"]), float(particles_header["drum_radius"])
    grains = read_grains(options.snapshot, float(particles_header["theta_deg"]), axis_depth)
    maps_header, grids = read_maps(options.maps)
    speed = np.ma.hypot(grids["v_x"], grids["v_z"])
    top = max(float(speed.max()), float(np.quantile(grains["speed"], 0.999)))
    norm = matplotlib.colors.LogNorm(1e-3 * top, top)
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 4.9))
    discs = matplotlib.collections.EllipseCollection(
        2 * grains["radius"], 2 * grains["radius"], np.zeros_like(grains["radius"]), units="x",
        offsets=np.column_stack((grains["x"], grains["z"])), transOffset=left.transData, cmap="viridis", norm=norm)
    discs.set_array(np.maximum(grains["speed"], 1e-3 * top))
    left.add_collection(discs)
    outline(left, radius, axis_depth)
    left.set_title(style.title_of("particles, one instant", particles_header.get("reduced") == "true"))
    image = right.pcolormesh(grids["x"], grids["z"], speed, norm=norm, cmap="viridis", shading="nearest", rasterized=True)
    outline(right, float(maps_header["drum_radius"]), float(maps_header["axis_depth"]))
    right.set_title(style.title_of("continuum, steady flow", particles_header.get("reduced") == "true"))
    figure.colorbar(image, ax=[left, right], shrink=0.9, extend="min",
                    label=r"speed in the frame of the drum  [$\sqrt{gd}$]")
    return figure


def main():
    options = arguments()
    style.use_style()
    header, particles = style.read_profiles(options.particles)
    _, continuum = style.read_profiles(options.continuum)
    reduced = header.get("reduced") == "true"
    sheets = {
        "velocity": ([("v_x", False), ("v_x", True)], (11, 4.4)),
        "shear_rate": ([("shear_rate", False), ("shear_rate", True)], (11, 4.4)),
        "stresses": ([("sigma_zz", False), ("sigma_xz", False), ("sigma_xx", False)], (13, 4.2)),
        "ratios": ([("I", True), ("mu", False), ("k", False)], (13, 4.2)),
    }
    figures = {name: over_depth(names, particles, continuum, options.depth, size)
               for name, (names, size) in sheets.items()}
    figures["drums"] = drums(header, options)
    figures["friction"] = friction(particles, continuum)
    for name, figure in figures.items():
        style.save(figure, f"{options.output}/{name}.png", reduced)


if __name__ == "__main__":
    main()
