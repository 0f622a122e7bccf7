"""Figures on axes of one's own, in the colours and words of the commands' figures."""

import importlib
import pathlib
import sys

import numpy as np

_FIGURES = pathlib.Path(__file__).parent / "figures"


def figure_module(name):
    """A script of the commands' figures as a module: figure_module("style").use_style()."""
    sys.path.insert(0, str(_FIGURES))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.remove(str(_FIGURES))


def grains(axes, snapshot, values=None, **keywords):
    """Draws discs at x, z with their radius: a snapshot that was read, or a simulation at hand. values: a colour for each; returns the collection."""
    import matplotlib.collections  # half a second, for those who draw alone

    x, z, radius = (np.asarray(getattr(snapshot, name)) for name in ("x", "z", "radius"))
    discs = matplotlib.collections.EllipseCollection(2 * radius, 2 * radius, np.zeros_like(radius), units="xy", offsets=np.column_stack([x, z]),
                                                     transOffset=axes.transData, **({"edgecolor": "0.3", "linewidth": 0.3} | keywords))
    if values is not None:
        discs.set_array(np.array(values, float))
    axes.add_collection(discs)
    axes.set(xlim=((x - radius).min(), (x + radius).max()), ylim=((z - radius).min(), (z + radius).max()), aspect="equal", xlabel="x [d]", ylabel="z [d]")
    return discs


def profile(axes, table, name, color=None, label=None):
    """Draws a column of a profile over z with its 99 % interval as a band, where it has one."""
    style = figure_module("style")
    half_width = table.get(name + "_ci99")
    style.band(axes, table["z"], table[name], half_width, color or style.PARTICLES, label)
    axes.set(xlabel=style.LABELS["z"], ylabel=style.LABELS.get(name, name))
