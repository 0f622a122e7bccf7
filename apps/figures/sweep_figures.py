"""The figure of a sweep: each quantity over each key that was varied, with 99 % intervals, runs that differ in their seed alone as one point.

usage: sweep_figures.py SWEEP.json FOLDER
FOLDER takes quantities.png; nothing where no run has a number yet.
"""

import math
import pathlib
import sys

import matplotlib.pyplot as plt

import script
import style

MOST_LINES = len(style.COLORS)


def is_number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def varied_keys(groups):
    keys = list(dict.fromkeys(key for group in groups for key in group["changes"]))
    return [key for key in keys if len({str(group["changes"].get(key)) for group in groups}) > 1]


def lines_over(key, groups):
    """{label of all other settings: groups}"""
    lines = {}
    for group in groups:
        others = ", ".join(f"{name.split('.')[-1]} {value}" for name, value in group["changes"].items() if name != key)
        lines.setdefault(others, []).append(group)
    return lines


def places(key, groups):
    """(x of each group, labels of the places, None where they are numbers)."""
    values = [group["changes"].get(key) for group in groups]
    if all(map(is_number, values)):
        return values, None
    names = list(dict.fromkeys(map(str, values)))
    return [names.index(str(value)) for value in values], names


def draw_panel(axes, key, quantity, groups):
    x, names = places(key, groups)
    place = {id(group): at for group, at in zip(groups, x)}
    lines = lines_over(key, groups)
    few = len(lines) <= MOST_LINES
    for k, (label, of) in enumerate(lines.items()):
        points = sorted((place[id(group)], style.value_of(group["numbers"].get(quantity)), style.half_width_of(group["numbers"].get(quantity))) for group in of)
        points = [point for point in points if math.isfinite(point[1])]
        if points:
            along, values, halves = zip(*points)
            halves = [half if math.isfinite(half) else 0 for half in halves]
            axes.errorbar(along, values, halves, fmt="o-" if few else "o", color=style.COLORS[k] if few else style.PARTICLES, capsize=2, label=style.plain(label, 40) or None)
    if names is not None:
        axes.set_xticks(range(len(names)), [style.plain(name, 14) for name in names])
    elif min(x) > 0 and max(x) > 20 * min(x):
        axes.set_xscale("log")
    axes.set(xlabel=style.plain(key, 40), ylabel=style.plain(quantity, 40))
    return few and len(lines) > 1


def draw(content):
    groups, quantities = content["groups"], content["quantities"]
    keys = varied_keys(groups)
    if not quantities or not keys:
        return None
    figure, panels = plt.subplots(len(quantities), len(keys), squeeze=False, figsize=(5.6 * len(keys), 3.2 * len(quantities)))
    for row, quantity in zip(panels, quantities):
        for axes, key in zip(row, keys):
            if draw_panel(axes, key, quantity, groups) and row is panels[0]:
                axes.legend(fontsize=9)
    return figure


if __name__ == "__main__":
    style.use_style()
    given = script.content_of(sys.argv[1])
    script.save_each({"quantities": lambda: draw(given)}, pathlib.Path(sys.argv[2]), given["reduced"])
