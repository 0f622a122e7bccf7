"""Figures of `drumlin compare` on flows in layers, from the overlay that it wrote: both sides over height, with their 99 % bands.

usage: layer_comparison_figures.py COMPARISON_JSON FOLDER [SNAPSHOT]
FOLDER holds the overlay and takes the figures; a snapshot of the first side is drawn.
"""

import pathlib
import sys

import h5py
import matplotlib.pyplot as plt
import numpy as np

import script
import style
from compare_figures import names_of
from result_files import number_of

COLOURS = {"particles": style.PARTICLES, "continuum": style.CONTINUUM}
WIDE = 1.2  # of a picture, over the height of its layer


def between(comparison, z):
    """Which layers lie between base and top, and which of them in the bulk."""
    zones = comparison["zones"]
    return tuple((z >= zones[name]["from"]) & (z <= zones[name]["to"]) for name in ("all", "bulk"))


def over_height(columns, comparison, fields):
    """A panel per field, z upwards. None where no side has any of them."""
    fields = [field for field in fields if field + "_particles" in columns]
    if not fields:
        return None
    z = np.asarray(columns["z"])
    whole, bulk = between(comparison, z)
    figure, places = style.panels(len(fields), 2, 3.4, sharey=True)
    for axes, field in zip(places, fields):
        for side, name in zip(COLOURS, names_of(comparison)):
            values = np.asarray(columns[f"{field}_{side}"])
            half_width = np.asarray(columns.get(f"{field}_{side}_ci99", np.full(len(z), np.nan)))
            axes.plot(values[whole], z[whole], "o-" if comparison[side]["kind"] == "particles" else "-", color=COLOURS[side], label=name)
            axes.fill_betweenx(z[whole], (values - half_width)[whole], (values + half_width)[whole], color=COLOURS[side], alpha=0.25, linewidth=0)
        if bulk.any():
            axes.axhspan(z[whole][0] - 0.5, z[bulk][0] - 0.5, color="0.93", zorder=0)
            axes.axhspan(z[bulk][-1] + 0.5, z[whole][-1] + 0.5, color="0.93", zorder=0)
        axes.set_xlabel(style.axis_label(field))
    for axes in places[::2]:
        axes.set_ylabel(style.axis_label("z"))
    places[0].legend()
    return figure


def law(columns, comparison):
    """mu over I of the layers: full symbols in the bulk."""
    _, bulk = between(comparison, np.asarray(columns["z"]))
    figure, axes = plt.subplots()
    for side, name, marker in zip(COLOURS, names_of(comparison), "os"):
        inertial, mu = (np.asarray(columns[f"{field}_{side}"]) for field in ("I", "mu"))
        shears = inertial > 0
        axes.plot(inertial[shears & bulk], mu[shears & bulk], marker, color=COLOURS[side], label=name)
        axes.plot(inertial[shears & ~bulk], mu[shears & ~bulk], marker, color=COLOURS[side], fillstyle="none")
    style.log_scale(axes, "x")
    axes.set_ylim(0, 1.2 * np.nanmax([columns[f"mu_{side}"] for side in COLOURS]))
    axes.set_xlabel(style.axis_label("I"))
    axes.set_ylabel(style.axis_label("mu"))
    axes.legend()
    return figure


def read_grains(path, base):
    """Centres over the period and above the lowest layer, radii and speeds of a snapshot of a periodic domain."""
    with h5py.File(path) as snapshot:
        grains = {name: snapshot["grains/" + name][:] for name in ("x", "z", "v_x", "v_z", "radius")}
        period = number_of(snapshot["period_x"])
    return {"x": np.mod(grains["x"], period), "z": grains["z"] - (grains["z"] - grains["radius"]).min() + base, "radius": grains["radius"],
            "speed": np.hypot(grains["v_x"], grains["v_z"]), "period": period}


def picture(columns, comparison, snapshot):
    """Grains on the left, the mean speed of the second side on the right, one colour scale."""
    z, speed = np.asarray(columns["z"]), np.asarray(columns["v_x_continuum"])
    known = np.isfinite(speed)
    zones = comparison["zones"]
    grains = read_grains(snapshot, zones["all"]["from"])
    width = min(grains["period"], WIDE * comparison["registration"]["particles"]["height"])
    shown = grains["x"] < width
    scale = plt.Normalize(0, np.nanmax([np.quantile(grains["speed"], 0.99), speed[known].max()]))
    figure, row = style.panels(2, 2, 4, sharey=True)
    image = style.discs(row[0], *(grains[name][shown] for name in ("x", "z", "radius", "speed")), cmap="viridis", norm=scale, linewidths=0)
    row[1].pcolormesh([0, width], np.append(z[known] - 0.5, z[known][-1] + 0.5), speed[known][:, None], cmap="viridis", norm=scale)
    for axes, name in zip(row, names_of(comparison)):
        for end in ("from", "to"):
            axes.axhline(zones["bulk"][end], color="0.3", linestyle="--", linewidth=1)
        axes.set(xlim=(0, width), ylim=(zones["all"]["from"] - 1, zones["all"]["to"] + 2), aspect="equal", title=name, xlabel=r"$x$  [$d$]")
        axes.grid(False)
    row[0].set_ylabel(style.axis_label("z"))
    figure.colorbar(image, ax=row, label=r"speed  [$\sqrt{gd}$]", shrink=0.85)
    return figure


def main():
    comparison, folder, snapshot = script.content_of(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
    style.use_style()
    _, columns = style.read_profiles(folder / "overlay.csv")
    drawings = {"profiles": lambda: over_height(columns, comparison, ["v_x", "shear_rate", "sigma_zz", "sigma_xz", "sigma_xx"]),
                "ratios": lambda: over_height(columns, comparison, ["mu", "I", "k", "nu"]),
                "law": lambda: law(columns, comparison)}
    if snapshot:
        drawings["picture"] = lambda: picture(columns, comparison, *snapshot)
    script.save_each(drawings, folder, comparison["reduced"])


if __name__ == "__main__":
    main()
