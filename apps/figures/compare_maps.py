"""Maps of `drumlin compare`: both sides on one colour scale, their difference, and the difference over the interval."""

import math

import matplotlib.colors
import numpy as np

import quantity_table
import style
from drum_maps import read_grains, read_maps

# Name of the sheet: field, label, logarithmic.
SHEETS = {
    "maps_speed": ("speed", r"speed in the frame of the drum  [$\sqrt{gd}$]", True),
    "maps_shear_rate": ("strain_rate", r"shear rate $2\sqrt{D:D/2}$  [$\sqrt{g/d}$]", True),
    "maps_pressure": ("p", style.axis_label("p"), False),
    "maps_sigma_xz": ("sigma_xz", style.axis_label("sigma_xz"), False),
    "maps_mu": ("mu", r"$\mu = \tau/p$", False),
    "maps_axis_angle": ("axis_angle_deg", style.axis_label("axis_angle_deg"), False),
}
DRUM = 2.04, 1.32  # width and height of what is shown of a drum, in its radius
WORST_INTERVALS = 3  # intervals at which the colour of the last panel ends


def outline(axes, radius, axis_depth):
    """The drum, its axis `axis_depth` above the free surface."""
    angle = np.linspace(0, 2 * math.pi, 400)
    axes.plot(radius * np.sin(angle), axis_depth - radius * np.cos(angle), color="black", linewidth=1)
    axes.set_aspect("equal")
    axes.set_xlim(-1.02 * radius, 1.02 * radius)
    axes.set_ylim(axis_depth - 1.02 * radius, 0.3 * radius)
    axes.grid(False)
    axes.set_xlabel(r"$x$  [$d$], downslope")
    axes.set_ylabel(style.axis_label("z"))


def drums(comparison, snapshot, maps):
    """Grains of one instant beside the other side's mean flow: speed in the frame of the drum, on one colour scale."""
    header = comparison["particles"]["profiles"]
    reduced = comparison["reduced"]
    axis_depth, radius = float(header["axis_depth"]), float(header["drum_radius"])
    grains = read_grains(snapshot, float(header["theta_deg"]), axis_depth)
    maps_header, grids = read_maps(maps)
    lift = comparison["registration"]["offset"]  # to the first side's z
    speed = np.ma.hypot(grids["v_x"], grids["v_z"])
    top = max(float(speed.max()), float(np.quantile(grains["speed"], 0.999)))
    norm = matplotlib.colors.LogNorm(1e-3 * top, top)
    figure, (left, right) = style.maps(2, 1, *DRUM)
    style.discs(left, grains["x"], grains["z"], grains["radius"], np.maximum(grains["speed"], 1e-3 * top), cmap="viridis", norm=norm)
    outline(left, radius, axis_depth)
    left.set_title(style.title_of("particles, one instant", reduced))
    image = right.pcolormesh(grids["x"], grids["z"] + lift, np.ma.maximum(speed, 1e-3 * top), norm=norm, cmap="viridis",
                             shading="nearest", rasterized=True)
    outline(right, float(maps_header["drum_radius"]), float(maps_header["axis_depth"]) + lift)
    right.set_title(style.title_of(f"{comparison['continuum']['kind']}, mean flow", reduced))
    figure.colorbar(image, ax=[left, right], shrink=0.9, extend="min",
                    label=r"speed in the frame of the drum  [$\sqrt{gd}$]")
    return figure


def with_speed(grids):
    """Speed of both sides and the particles' half width of it, beside what the file holds."""
    for side in ("particles", "continuum"):
        grids["speed_" + side] = np.ma.hypot(grids["v_x_" + side], grids["v_z_" + side])
        widths = [grids.get(f"ci99/{name}_{side}") for name in ("v_x", "v_z")]
        if all(width is not None for width in widths):
            speed = np.ma.masked_less_equal(grids["speed_" + side], 0)
            grids["ci99/speed_" + side] = np.ma.hypot(widths[0] * grids["v_x_" + side], widths[1] * grids["v_z_" + side]) / speed
    return grids


def scale(first, second, inside, logarithmic):
    """One scale for both, from the places that are compared."""
    values = np.concatenate([side[inside].compressed() for side in (first, second)])
    if logarithmic:
        values = values[values > 0]
    if values.size == 0:
        return None
    low, high = np.quantile(values, (0.005, 0.995))
    if logarithmic:
        low = max(low, 1e-5 * high)
        return matplotlib.colors.LogNorm(low, max(high, 1.01 * low))
    return matplotlib.colors.Normalize(low, high if high > low else low + 1)


def symmetric(values, inside, largest=None):
    """Zero in the middle, as far as 99 % of the compared places reach."""
    known = np.abs(values[inside].compressed())
    end = largest or (float(np.quantile(known, 0.99)) if known.size else 1) or 1
    return matplotlib.colors.Normalize(-end, end)


def difference_of(field, first, second, logarithmic):
    if logarithmic:
        return np.ma.log10(np.ma.masked_less_equal(second, 0)) - np.ma.log10(np.ma.masked_less_equal(first, 0))
    difference = second - first
    # Axes half a turn apart are one axis.
    return difference - 180 * np.round(difference / 180) if quantity_table.field(field).compared == "half turns" else difference


def sheet(grids, header, field, label, logarithmic, names, reduced):
    """Four panels: one side, the other, their difference, the same over the first one's 99 % half width."""
    first, second = grids[field + "_particles"], grids[field + "_continuum"]
    inside = np.asarray(grids["zone"].filled(0)) > 0
    if field in ("strain_rate", "axis_angle_deg"):
        inside &= np.asarray(grids["noise"].filled(1)) == 0
    norm = scale(first, second, inside, logarithmic)
    if norm is None:
        return None
    difference = np.ma.masked_where(~inside, difference_of(field, first, second, logarithmic))
    half_width = grids.get(f"ci99/{field}_particles")
    palette = "viridis"
    if quantity_table.field(field).compared == "half turns":  # of both signs, and noise where no axis is known
        first, second = (np.ma.masked_where(~inside, side) for side in (first, second))
        norm, palette = symmetric(np.ma.concatenate([first, second]), np.concatenate([inside, inside])), "RdBu_r"
    panels = [(first, norm, palette, names[0]), (second, norm, palette, names[1]),
              (difference, symmetric(difference, inside), "RdBu_r", "second - first" + ("  [decades]" if logarithmic else ""))]
    if half_width is not None:
        over = np.ma.masked_where(~inside, difference_of(field, first, second, False) / np.ma.masked_less_equal(half_width, 0))
        panels.append((over, symmetric(over, inside, WORST_INTERVALS), "RdBu_r", "the same in half widths"))
    figure, places = style.maps(len(panels), 2, *DRUM)
    for axes, (values, colours, cmap, title) in zip(places, panels):
        if logarithmic and colours is norm:
            values = np.ma.maximum(values, norm.vmin)
        image = axes.pcolormesh(grids["x"], grids["z"], values, norm=colours, cmap=cmap, shading="nearest", rasterized=True)
        axes.contour(grids["x"], grids["z"], grids["zone"].filled(0), levels=[0.5, 1.5], colors="black", linewidths=0.6)
        outline(axes, float(header["drum_radius"]), float(header["axis_depth"]))
        axes.set_title(title)
        figure.colorbar(image, ax=axes, shrink=0.85, extend="both")
    figure.suptitle(style.title_of(label, reduced))
    return figure


def overlaid(path):
    """(header, grids) of overlay_maps.h5, with intervals and speeds."""
    header, grids = read_maps(path, with_intervals=True)
    return header, with_speed(grids)


def sheet_of(name, maps, names, reduced):
    """The figure of one entry of SHEETS; None where the maps do not have its field."""
    header, grids = maps
    field, label, logarithmic = SHEETS[name]
    return sheet(grids, header, field, label, logarithmic, names, reduced) if field + "_particles" in grids else None
