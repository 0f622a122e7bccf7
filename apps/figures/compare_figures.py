"""Figures of `drumlin compare`, from the overlays that it wrote: both sides at the same places, with their 99 % bands.

usage: compare_figures.py COMPARISON_JSON FOLDER [SNAPSHOT MAPS]
FOLDER holds the overlays and takes the figures; SNAPSHOT of the first side and maps.h5 of the second are drawn beside one another.
"""

import functools
import math
import pathlib
import sys

import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

import compare_maps
import script
import style

DEEPEST = -60  # d, of the slices
MOST_SLICES = 5  # beside one another


def names_of(comparison):
    """What the two sides are called in legends."""
    first, second = comparison["particles"], comparison["continuum"]
    if first["kind"] != second["kind"]:
        return first["kind"], second["kind"]
    return tuple(f"{side['kind']}: {style.plain(side['name'], 40)}" for side in (first, second))


def mark_depths(axes, depth, zones=None):
    """Dotted line at the interface, dashed line at the free surface, as in the paper's figures; grey: in no zone."""
    axes.axvline(0, color="0.4", linestyle="--", linewidth=1)
    if depth is not None:
        axes.axvline(-depth, color="0.4", linestyle=":", linewidth=1)
    if zones and zones["all"]["from"] is not None:
        left, right = axes.get_xlim()
        axes.axvspan(left, zones["all"]["from"], color="0.93", zorder=0)
        axes.axvspan(zones["all"]["to"], right, color="0.93", zorder=0)
        axes.set_xlim(left, right)
    axes.set_xlabel(style.axis_label("z"))


def curve(axes, columns, name, side, color, label, logarithmic):
    """One side's quantity over depth with its band."""
    key = f"{name}_{side}"
    if key not in columns:
        return
    style.band(axes, columns["z"], columns[key], columns.get(key + "_ci99"), color, label, "o" if side == "particles" else None, 1e-2 if logarithmic else None)


def limit_to_the_packing(axes, name, columns):
    """The few grains above the surface, and their wide bands, would set the scale: it is taken from z < 0 instead."""
    sides = [columns[f"{name}_{side}"] for side in ("particles", "continuum") if f"{name}_{side}" in columns]
    values = np.concatenate([values[(columns["z"] < 0) & np.isfinite(values)] for values in sides])
    if values.size:
        margin = 0.1 * np.ptp(values) or 1
        axes.set_ylim(values.min() - margin, values.max() + margin)


def draw(axes, columns, name, names, logarithmic=False):
    for side, color, label in zip(("particles", "continuum"), (style.PARTICLES, style.CONTINUUM), names):
        curve(axes, columns, name, side, color, label, logarithmic)
    axes.set_ylabel(style.axis_label(name))
    if logarithmic:
        axes.set_yscale("log")
    else:
        limit_to_the_packing(axes, name, columns)


def over_depth(panels, columns, comparison):
    """Panels, in two columns where they are four; `panels` as (column, logarithmic). None where no side has any of them."""
    panels = [(name, log) for name, log in panels if name + "_particles" in columns]
    if not panels:
        return None
    figure, places = style.panels(len(panels), 2 if len(panels) > 3 else 1)
    for axes, (name, logarithmic) in zip(places, panels):
        draw(axes, columns, name, names_of(comparison), logarithmic)
        mark_depths(axes, comparison["scalars"]["H"]["particles"]["value"], comparison["zones"])
    places[0].legend()
    return figure


def friction(columns, names):
    """mu over I, the layers of both sides; the flow pays for every percent of it."""
    if "mu_particles" not in columns or "I_particles" not in columns:
        return None
    figure, axes = plt.subplots()
    for side, color, marker, label in zip(("particles", "continuum"), (style.PARTICLES, style.CONTINUUM), "ox", names):
        axes.plot(style.positive(columns["I_" + side]), columns["mu_" + side], marker, color=color, label=label)
    axes.set_xscale("log")
    axes.set_xlabel(style.axis_label("I"))
    axes.set_ylabel(style.axis_label("mu"))
    axes.legend()
    return figure


def lowest_shown(overlays, names):
    """Where the axis over depth begins, in tens of d: below all that is known, at the depth of the paper's drum at most."""
    depths = [z for columns in overlays for name in names for z, value in zip(columns["z"], columns.get(name, [])) if math.isfinite(value)]
    return max(DEEPEST, 10 * math.floor((min(depths, default=DEEPEST) - 0.5) / 10))


def slices(comparison, folder):
    """A column of panels per slice, upstream to downstream."""
    if not comparison["slices"]:
        return None
    rows = [("v_x", False), ("log10_shear_rate", False), ("sigma_zz", False), ("sigma_xz", False), ("mu", False)]
    entries = [comparison["slices"][k] for k in np.unique(np.linspace(0, len(comparison["slices"]) - 1, MOST_SLICES).round().astype(int))]
    figure, grid = style.panels(len(rows) * len(entries), len(entries), 2.2, sharey="row", sharex=True)
    grid = np.array(grid).reshape(len(rows), len(entries))
    overlays = [style.read_profiles(folder / "overlay_slices" / f"x{entry['position']:+.1f}.csv")[1] for entry in entries]
    lowest = lowest_shown(overlays, [f"{name}_{side}" for name, _ in rows for side in ("particles", "continuum")])
    for column, (entry, columns) in enumerate(zip(entries, overlays)):
        for row, (name, logarithmic) in enumerate(rows):
            axes = grid[row][column]
            draw(axes, columns, name, names_of(comparison), logarithmic)
            mark_depths(axes, entry["H"])
            axes.set_xlim(lowest, 2)
            if column > 0:
                axes.set_ylabel("")
            if row + 1 < len(rows):
                axes.set_xlabel("")
        grid[0][column].set_title(f"{entry['position']:+.3g} d")
        grid[0][column].xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(2))
    for row, (name, _) in enumerate(rows):
        # Between wall and surface alone: what touches either is in no zone and would set the scale.
        curves = [(np.asarray(line.get_xdata()), np.asarray(line.get_ydata())) for axes in grid[row] for line in axes.get_lines()
                  if len(line.get_ydata()) > 2]
        values = np.concatenate([y[np.isfinite(y) & (x < 0) & (x > np.min(x, where=np.isfinite(y), initial=0) + 3)] for x, y in curves])
        if values.size:
            grid[row][0].set_ylim(*(np.quantile(values, (0, 1)) + 0.05 * np.ptp(values) * np.array([-1, 1])))
    first, second = names_of(comparison)
    figure.suptitle(style.title_of(style.plain(f"slices at x; dots: {first}, line: {second}"), comparison["reduced"]))
    return figure


def main():
    comparison, folder, drums = script.content_of(sys.argv[1]), pathlib.Path(sys.argv[2]), sys.argv[3:]
    style.use_style()
    reduced, names = comparison["reduced"], names_of(comparison)
    _, columns = style.read_profiles(folder / "overlay.csv")
    sheets = {
        "velocity": [("v_x", False), ("v_x", True), ("v_z", False)],
        "shear_rate": [("shear_rate", False), ("shear_rate", True)],
        "stresses": [("sigma_zz", False), ("sigma_xz", False), ("sigma_xx", False), ("p", False)],
        "ratios": [("I", True), ("mu", False), ("k", False), ("axis_angle_deg", False)],
    }
    drawings = {name: functools.partial(over_depth, panels, columns, comparison) for name, panels in sheets.items()}
    drawings["friction"] = lambda: friction(columns, names)
    drawings["slices"] = lambda: slices(comparison, folder)
    if comparison["maps"]:
        maps = compare_maps.overlaid(folder / "overlay_maps.h5")
        drawings |= {name: functools.partial(compare_maps.sheet_of, name, maps, names, reduced) for name in compare_maps.SHEETS}
    if drums:
        drawings["drums"] = lambda: compare_maps.drums(comparison, *drums)
    script.save_each(drawings, folder, reduced)


if __name__ == "__main__":
    main()
