"""Effects of the continuum one at a time: every error over its limit, coloured, and the seconds.

usage: flow_effect_figures.py JSON PICTURE
JSON is COST/cost.json of `drumlin cost --effects --against`, or a record of drumlin-effect-errors-1 (data/cost/effects-flow-6rpm.json).
"""

import sys

import script
import style
from matplotlib.colors import TwoSlopeNorm

plt = style.plt


def name_of(target):
    return target["quantity"].replace("_deg", "").replace("log10_shear_rate", "log rate").replace("axis_angle", "axes") + (f"\n{target['zone']}" if "zone" in target else "")


def rows_of(report):
    """The variants that were found: name, targets, processor seconds."""
    if report["format"] == "drumlin-effect-errors-1":
        return [{"name": " + ".join(row["effects"]).replace("_", " ") or "none", "targets": row["targets"], "cpu_seconds": row["cpu_seconds"]}
                for row in report["variants"] if row["exit"] == 0]
    return [{"name": row["effect"].replace("_", " ").replace("+", " + "), "targets": row["against"]["targets"], "cpu_seconds": row["cpu_seconds"]}
            for row in report["effects"] if "against" in row]


def main():
    report = script.content_of(sys.argv[1])
    style.use_style()
    rows = rows_of(report)
    known = [i for i, target in enumerate(rows[0]["targets"]) if target["quantity"] != "Q" and all(row["targets"][i]["value"] is not None for row in rows)]
    ratios = [[row["targets"][i]["value"] / row["targets"][i]["limit"] for i in known] for row in rows]
    figure, (axes, bars) = plt.subplots(1, 2, figsize=(13.5, 1.6 + 0.45 * len(rows)), width_ratios=[4, 1], sharey=True)
    axes.imshow([[min(ratio, 2) for ratio in line] for line in ratios], cmap="RdYlGn_r", norm=TwoSlopeNorm(1, 0, 2), aspect="auto", alpha=0.75)
    for y, line in enumerate(ratios):
        for x, ratio in enumerate(line):
            axes.text(x, y, f"{ratio:.2f}", ha="center", va="center", fontsize=10.5, weight="bold" if ratio > 1 else "normal")
    axes.set_xticks(range(len(known)), [name_of(rows[0]["targets"][i]) for i in known], fontsize=10)
    axes.set_yticks(range(len(rows)), [row["name"] for row in rows])
    axes.grid(False)
    axes.set_title("error / limit against the particles; bold: missed", fontsize=12)
    seconds = [row["cpu_seconds"] for row in rows]
    bars.barh(range(len(rows)), seconds, color=style.CONTINUUM, height=0.6)
    for y, value in enumerate(seconds):
        bars.text(value, y, f" {value:.0f}", va="center", fontsize=10.5)
    bars.set_xlim(0, 1.2 * max(seconds))
    bars.set_title("processor seconds", fontsize=12)
    style.save(figure, sys.argv[2], report.get("reduced", False))


if __name__ == "__main__":
    main()
