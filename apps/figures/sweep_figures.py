"""The figure of a sweep: each quantity over each key that was varied, with 99 % intervals, runs that differ in their seed alone as one point.

usage: sweep_figures.py SWEEP.json FOLDER
FOLDER takes quantities.png; nothing where no run has a number yet.
"""

import math
import pathlib
import sys

import quantity_table
import script
import style


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


def label_of(quantity):
    known = quantity_table.SCALARS.get(quantity)
    return known.axis_label().replace("  [", "\n[") if known else style.plain(quantity, 24)


def draw_line(axes, points, label, color, joined):
    """Points (x, value, half width); one whose interval is not known is hollow."""
    x, values, halves = zip(*points)
    axes.errorbar(x, values, [half if math.isfinite(half) else 0 for half in halves], fmt="-" if joined else "none", color=color, capsize=2)
    for hollow in (False, True):
        shown = [point[:2] for point in points if math.isfinite(point[2]) != hollow]
        if shown:
            axes.plot(*zip(*shown), "o", color=color, markerfacecolor="white" if hollow else color)
    axes.plot([], [], "o-", color=color, label=style.plain(label, 40) or None)


def draw_panel(axes, key, quantity, groups):
    x, names = places(key, groups)
    place = {id(group): at for group, at in zip(groups, x)}
    lines = lines_over(key, groups)
    few = len(lines) <= len(style.COLORS)
    for k, (label, of) in enumerate(lines.items()):
        entries = [(place[id(group)], group["numbers"].get(quantity)) for group in of]
        points = sorted((at, style.value_of(entry), style.half_width_of(entry)) for at, entry in entries if math.isfinite(style.value_of(entry)))
        if points:
            draw_line(axes, points, label, style.COLORS[k] if few else style.PARTICLES, few)
    if names is not None:
        axes.set_xticks(range(len(names)), [style.plain(name, 14) for name in names])
    elif min(x) > 0 and max(x) > 20 * min(x):
        axes.set_xscale("log")
    axes.set(xlabel=style.plain(key, 40), ylabel=label_of(quantity))
    return few and len(lines) > 1


def draw(content):
    groups = content["groups"]
    panels = [(quantity, key) for quantity in content["quantities"] for key in varied_keys(groups)]
    if not panels:
        return None
    figure, places = style.panels(len(panels), min(2, len(panels)))
    for axes, (quantity, key) in zip(places, panels):
        if draw_panel(axes, key, quantity, groups):
            axes.legend()
    return figure


if __name__ == "__main__":
    style.use_style()
    given = script.content_of(sys.argv[1])
    script.save_each({"quantities": lambda: draw(given)}, pathlib.Path(sys.argv[2]), given["reduced"])
