"""maps.png of `drumlin measure`: fields over the whole drum, or over what else holds the grains, from maps.h5."""

import math

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import ListedColormap, LogNorm, Normalize

import result_files
import script
import style

UNKNOWN = "0.85"  # where an interval is wider than what is shown
WIDEST_ANGLE = 15  # deg, half width of the interval from which on an angle is not shown
SHOWN = ("nu", "v_x", "v_z", "v_y", "coordination", "I", "p", "mu", "k", "axis_angle_deg", "residual_x", "residual_z")
MOST_COLUMNS = 640  # more than a panel has pixels
WIDEST_I = 1.0  # half width of the interval of I, as a share of I, from which on it is not shown


class Maps:
    """Fields of one maps.h5; masked where there is no packing."""

    def __init__(self, path):
        self.header, self.x, self.z, self.fields, self.ci99 = result_files.read_maps(path, SHOWN, MOST_COLUMNS)
        with np.errstate(invalid="ignore"):
            self.empty = ~(self.fields["nu"] > style.LEAST_SHOWN_NU)

    def number(self, key):
        return float(self.header[key])

    def masked(self, values):
        return np.ma.masked_where(self.empty | ~np.isfinite(values), values)

    def field(self, name):
        return self.masked(self.fields[name])

    def half_width(self, name):
        return self.ci99.get(name, np.zeros_like(self.fields[name]))


def draw_drum(axes, maps):
    radius, axis = maps.number("drum_radius"), maps.number("axis_depth")
    if radius > 0:
        turn = np.linspace(0, 2 * math.pi, 400)
        axes.plot(radius * np.cos(turn), axis + radius * np.sin(turn), color="black", linewidth=1)
        axes.set_xlim(-1.02 * radius, 1.02 * radius)
        # The empty upper half would halve the scale; its beginning shows the wall and the way of gravity.
        axes.set_ylim(axis - 1.02 * radius, axis + 0.3 * radius)
    axes.set_aspect("equal")


def draw_gravity(axes, maps):
    slope = math.radians(maps.number("theta_deg"))
    radius, axis = maps.number("drum_radius"), maps.number("axis_depth")
    if not radius > 0:
        return
    start = (0.62 * radius, axis + 0.24 * radius)
    tip = (start[0] + 0.2 * radius * math.sin(slope), start[1] - 0.2 * radius * math.cos(slope))
    axes.annotate("", xytext=start, xy=tip, arrowprops={"arrowstyle": "->", "linewidth": 1.2})
    axes.text(start[0] + 0.1 * radius, start[1] - 0.12 * radius, "$g$")


def panel(axes, maps, values, title, norm, colors="viridis", unknown=None):
    axes.grid(False)
    if unknown is not None:
        axes.pcolormesh(maps.x, maps.z, maps.masked(np.where(unknown, 1.0, np.nan)), cmap=ListedColormap([UNKNOWN]),
                        shading="nearest", rasterized=True)
        values = np.ma.masked_where(unknown, values)
    drawn = axes.pcolormesh(maps.x, maps.z, values, cmap=colors, norm=norm, shading="nearest", rasterized=True)
    draw_drum(axes, maps)
    axes.set_title(title)
    axes.figure.colorbar(drawn, ax=axes, extend="both", shrink=0.75, pad=0.02)


def symmetric(half, middle=0.0):
    return Normalize(middle - half, middle + half)


def log_range(values, decades):
    """From the highest value down over some decades."""
    positive = values.compressed()
    positive = positive[positive > 0]
    top = np.percentile(positive, 99.5) if positive.size else 1.0
    return LogNorm(top / 10 ** decades, top)


def draw_fields(axes, maps):
    speed = maps.masked(np.hypot(maps.fields["v_x"], maps.fields["v_z"]))
    panel(axes[0], maps, speed, r"speed and streamlines  [$\sqrt{gd}$]", log_range(speed, 3))
    draw_streamlines(axes[0], maps)
    draw_gravity(axes[0], maps)
    dense, contacts = ((0.45, 0.65), (1, 6)) if "v_y" in maps.fields else ((0.7, 0.86), (1.5, 4))  # of spheres, of discs
    panel(axes[1], maps, maps.field("nu"), style.axis_label("nu"), Normalize(*dense))
    panel(axes[2], maps, maps.field("coordination"), style.axis_label("coordination"), Normalize(*contacts))

    with np.errstate(invalid="ignore"):
        unsure = maps.half_width("I") > WIDEST_I * maps.fields["I"]
    panel(axes[3], maps, maps.field("I"), r"$I = 2|D|/\sqrt{p}$  (grey: noise)", LogNorm(1e-5, 0.2), unknown=unsure)
    panel(axes[4], maps, maps.field("p"), style.axis_label("p"), Normalize(0, np.nanpercentile(maps.fields["p"], 99)))
    panel(axes[5], maps, maps.field("mu"), r"$\mu = |\tau|/p$", Normalize(0.05, 0.45))

    panel(axes[6], maps, maps.field("k"), style.axis_label("k"), symmetric(0.5, 1), "RdBu_r")
    with np.errstate(invalid="ignore"):
        unsure = maps.half_width("axis_angle_deg") > WIDEST_ANGLE
    panel(axes[7], maps, maps.field("axis_angle_deg"), f"stress from strain axis  [deg]\n(grey: $\\pm${WIDEST_ANGLE} or worse)", symmetric(30), "RdBu_r",
          unknown=unsure)
    missing = 100 * np.hypot(maps.fields["residual_x"], maps.fields["residual_z"])
    panel(axes[8], maps, maps.masked(missing), r"momentum missing  [% of $\nu g$]", LogNorm(0.1, 30), "magma_r")


def draw_streamlines(axes, maps):
    v_x, v_z = maps.field("v_x").filled(np.nan), maps.field("v_z").filled(np.nan)
    if not np.any(np.isfinite(v_x)):
        return
    # As the laboratory sees them: closed through the packing that the drum carries up.
    rotation, axis = maps.number("rotation"), maps.number("axis_depth")
    if rotation and math.isfinite(axis):
        x, z = np.meshgrid(maps.x, maps.z)
        v_x, v_z = v_x + rotation * (z - axis), v_z - rotation * x
    axes.streamplot(maps.x, maps.z, v_x, v_z, color="white", linewidth=0.6, arrowsize=0.7, density=0.9)


def main():
    folder, content = script.measured_folder()
    maps = Maps(folder / "maps.h5")
    style.use_style()
    if not maps.number("drum_radius") > 0:  # panels may be narrower than their titles
        plt.rcParams["savefig.bbox"] = "tight"
    wide, high = (2.04, 1.32) if maps.number("drum_radius") > 0 else (np.ptp(maps.x), np.ptp(maps.z))
    columns = 1 if wide > 3 * high else 2
    figure, axes = style.maps(9, columns, wide, high, sharex=True, sharey=True)
    draw_fields(axes, maps)
    sloping = maps.number("drum_radius") > 0 or abs(maps.number("theta_deg")) > 0
    for one in axes[9 - columns:9]:
        one.tick_params(labelbottom=True)
        one.set_xlabel(r"$x$  [$d$]" + (", downslope" if sloping else ""))
    for one in axes[0:9:columns]:
        one.set_ylabel(style.axis_label("z"))
    style.save(figure, folder / "maps.png", content["reduced"])


if __name__ == "__main__":
    main()
