"""Figure of docs/cost.md from data/cost/engine.json: what a sweep costs, how soon a solve is done, how that grows with the drum.

usage: engine_cost.py ENGINE.json FIGURE.png
"""

import json
import sys

import matplotlib.pyplot as plt
import matplotlib.ticker

import style


def bars(axes, values, unit, marks, title):
    """values: {solver: number}; marks: {what: number}, drawn as lines across."""
    names = list(values)[::-1]
    colours = [style.CONTINUUM if name == "accelerated" else style.PARTICLES for name in names]
    axes.barh(names, [values[name] for name in names], color=colours, height=0.65)
    for k, name in enumerate(names):
        axes.annotate(f"{values[name]:.3g}", (values[name], k), xytext=(4, 0), textcoords="offset points", va="center",
                      fontsize=11)
    for (what, value), line in zip(marks.items(), ("--", ":")):
        axes.axvline(value, color=style.PAPER, linewidth=1, linestyle=line, label=what)
    axes.set_xlim(0, 1.15 * max([*values.values(), *marks.values()]))
    axes.grid(axis="y", visible=False)
    axes.set_xlabel(unit)
    axes.set_title(title)
    axes.legend(loc="lower right")


def over_size(axes, sizes):
    discs = [size["discs"] for size in sizes]
    axes.plot(discs, [size["ns_per_disc_and_sweep"] for size in sizes], marker="o", label="accelerated, a sweep")
    axes.plot(discs, [size["detection_ns_per_disc_and_step"] / 10 for size in sizes], marker="s",
              label="detection, a tenth of a step's")
    axes.set_xscale("log")
    axes.set_ylim(0, None)
    axes.xaxis.set_major_locator(matplotlib.ticker.FixedLocator(discs))
    axes.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axes.xaxis.set_major_formatter(matplotlib.ticker.StrMethodFormatter("{x:,.0f}"))
    axes.set_xlabel("discs")
    axes.set_ylabel("ns per disc")
    axes.set_title("growth with the drum, one thread")
    axes.set_ylim(0, 1.35 * axes.get_ylim()[1])  # room for the legend
    axes.legend(loc="upper left")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    with open(sys.argv[1], encoding="utf-8") as stream:
        cost = json.load(stream)
    style.use_style()
    plt.rcParams["savefig.dpi"] = 130
    figure, (left, middle, right) = plt.subplots(1, 3, figsize=(16, 4.6))
    bars(left, cost["ns_per_contact_and_sweep"], "ns per contact and sweep", {"required: 6": 6, "aim: 3": 3},
         "cost of a sweep, one thread")
    solvers = cost["to_residual"]["solvers"]
    bars(middle, {name: entry["speed_against_nlgs_scalar"] for name, entry in solvers.items()},
         "times as fast as nlgs-scalar", {"required: 4": 4, "aim: 10": 10},
         f"warm solve to residual {cost['to_residual']['residual']:g}")
    over_size(right, cost["sizes"])
    style.save(figure, sys.argv[2], cost["reduced"])


if __name__ == "__main__":
    main()
