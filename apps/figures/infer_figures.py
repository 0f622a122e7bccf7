"""Figures of an answer: corner.png, samples of all pairs of unknowns over their ranges, data.png, what was measured beside what is
expected, and law.png, the law of such grains, where the library has it.

usage: infer_figures.py FOLDER
"""

import json
import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

import result_files
import style

BINS = 30
SHOWN = 3000  # samples in a panel


def label(name):
    return style.plain(name.removeprefix("effects.").replace("_", " ").replace(".", " "), 14)


def title_of(name, one):
    """A sentence over the panel of an unknown."""
    width = one["width_over_prior"]
    text = f"{one['median']:.3g} ({one['low']:.3g} to {one['high']:.3g})" if width <= 0.8 else "not determined"
    return f"{label(name)}\n{text}\n{max(width, 0.01):.0%} of the prior's width"


def draw_corner(content, columns):
    unknowns, count = content["unknowns"], len(content["unknowns"])
    figure, grid = plt.subplots(count, count, figsize=(style.WIDEST, (style.WIDEST / count + 0.2) * count), squeeze=False)
    for i, (row, one) in enumerate(unknowns.items()):
        for j, (column, other) in enumerate(unknowns.items()):
            axes = grid[i][j]
            if j > i:
                axes.set_visible(False)
                continue
            axes.set_xlim(other["range"])
            if i == j:
                draw_one(axes, row, one, columns[row])
            else:
                draw_two(axes, columns[column], columns[row], content["correlations"][i][j])
                axes.set_ylim(one["range"])
            axes.set(xlabel=label(column) if i == count - 1 else "", ylabel=label(row) if j == 0 and i else "")
            axes.tick_params(labelbottom=i == count - 1, labelleft=j == 0 and i > 0)
    return figure


def draw_one(axes, name, one, values):
    axes.hist(values, BINS, one["range"], density=True, color=style.PARTICLES, alpha=0.6)
    for end in ("low", "high"):
        axes.axvline(one[end], color=style.CONTINUUM, linewidth=1.2)
    axes.set_yticks([])
    axes.set_title(title_of(name, one), fontsize="medium", loc="right" if axes.get_subplotspec().is_last_col() else "center")


def draw_two(axes, x, y, correlation):
    step = max(1, len(x) // SHOWN)
    axes.plot(x[::step], y[::step], ".", color=style.PARTICLES, markersize=1.5, alpha=0.3, rasterized=True)
    axes.text(0.04, 0.94, rf"$r$ = {correlation:.2f}", transform=axes.transAxes, va="top",
              bbox={"facecolor": "white", "alpha": 0.8, "edgecolor": "none", "pad": 1.5})


def draw_data(content):
    """Each number less what is expected, over the deviation that is expected."""
    rows = content["data"]
    figure, (axes,) = style.panels(1, height=1.6 + 0.6 * len(rows))
    place = np.arange(len(rows))[::-1]
    axes.axvspan(-2, 2, color="0.9", zorder=0)
    axes.axvline(0, color="0.5", linewidth=1)
    axes.plot([row["off"] for row in rows], place, "o", color=style.CONTINUUM, markersize=6)
    axes.set_yticks(place, [style.plain(f"{row['scene']}, {row['name']}: {row['value']:.4g}, expected {row['expected']:.4g}", 28) for row in rows])
    far = max(3.5, 1.1 * max(abs(row["off"]) for row in rows))
    fit = content["misfit"]
    axes.set(xlim=(-far, far), ylim=(-0.7, len(rows) - 0.3), xlabel="(measured - expected) / expected deviation",
             title="misfit" if fit["is_misfit"] else "")
    axes.grid(axis="y", visible=False)
    return figure


def draw_law(law):
    figure, (axes,) = style.panels(1, height=4)
    axes.fill_between(law["I"], law["low"], law["high"], color=style.PARTICLES, alpha=0.3, linewidth=0, label="90 %")
    axes.plot(law["I"], law["mu"], color=style.PARTICLES)
    axes.set(xscale="log", xlabel="I", ylabel=style.axis_label("mu"))
    axes.legend()
    return figure


def main(folder):
    folder = pathlib.Path(folder)
    style.use_style()
    content = json.loads((folder / "infer.json").read_text(encoding="utf-8"))
    _, _, columns = result_files.read_table(folder / "samples.csv", "drumlin-samples-1")
    style.save(draw_corner(content, columns), folder / "corner.png", content["reduced"])
    style.save(draw_data(content), folder / "data.png", content["reduced"])
    if content["law"] is not None:
        style.save(draw_law(content["law"]), folder / "law.png", content["reduced"])


if __name__ == "__main__":
    main(*sys.argv[1:])
