"""Figure of `drumlin cost --effects`: what each effect of a scene takes and changes, relative to the scene as it is.

usage: effect_price_figures.py COST_JSON PICTURE
"""

import math
import sys

import matplotlib.pyplot as plt

import script
import style

LONGEST, LONGER = 50, 100  # per cent; the latter where a change exceeds the former: nothing is less than 100 % less

PANELS = [
    ("cpu_seconds", "processor time"),
    ("bytes", "memory"),
    ("unknowns", "unknowns"),
    ("kinetic_energy_J_kg", "kinetic energy"),
]


def label(row):
    """The effect with a sign; what goes with it, or its strength, stands in cost.json."""
    if row["change"] == "none":
        return "the same again"
    return ("- " if row["change"] == "removed" else "+ ") + row["effect"].replace("_", " ")


def draw_panel(axes, key, title, base, rows):
    """Changes in per cent; bars that would dwarf the others are cut and end in a point, their numbers stand beside them."""
    changes = [100 * (row[key] / base[key] - 1) if base[key] else math.nan for row in rows]
    colors = [style.PAPER if row["change"] == "none"
              else style.CONTINUUM if row["change"] == "removed" else style.PARTICLES for row in rows]
    longest = LONGER if any(abs(change) > LONGEST for change in changes) else LONGEST
    cut = [max(-longest, min(longest, change)) for change in changes]
    axes.barh(range(len(rows)), cut, color=colors)
    for place, (change, length) in enumerate(zip(changes, cut)):
        if math.isnan(change):
            continue
        side = 1 if length >= 0 else -1
        beyond = abs(change) > longest * (1 + 1e-9)
        if beyond:
            axes.plot([length + 0.04 * side * longest], [place], marker=">" if side > 0 else "<", color=colors[place], markersize=8, clip_on=False)
        axes.annotate(f"{change:+.3g}" if abs(change) < 1000 else f"{change:+.0e}", (length, place),
                      xytext=((12 if beyond else 4) * side, 0), textcoords="offset points", va="center",
                      ha="left" if side > 0 else "right", fontsize=9)
    axes.axvline(0, color="0.3", linewidth=1)
    axes.set_xlim(-1.7 * longest, 1.7 * longest)
    axes.set_xticks([-longest, 0, longest])
    axes.set_xlabel("change [%]")
    axes.set_title(title)
    axes.grid(axis="y", visible=False)


def main():
    report = script.content_of(sys.argv[1])
    priced = [row for row in report["variants"] if "cpu_seconds" in row]
    base, rows = priced[0], priced[1:][::-1]
    style.use_style()
    figure, all_axes = plt.subplots(1, len(PANELS), sharey=True, figsize=(12, 2.2 + 0.36 * len(rows)))
    for axes, (key, title) in zip(all_axes, PANELS):
        draw_panel(axes, key, title, base, rows)
    all_axes[0].set_yticks(range(len(rows)), [label(row) for row in rows])
    figure.suptitle(style.title_of(f"{style.plain(report['title'])}, first {report['simulated_seconds']:g} s\n"
                                   "without (-) and with (+) an effect, against the scene as it is",
                                   report["reduced"]), fontsize=13)
    style.save(figure, sys.argv[2], report["reduced"])


if __name__ == "__main__":
    main()
