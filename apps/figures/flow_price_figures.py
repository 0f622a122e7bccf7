"""Figure of `drumlin cost --effects` of a flow: what each effect takes, and what it changes in the scalars and the profile.

usage: flow_price_figures.py COST_JSON PICTURE
"""

import math
import sys

import matplotlib.pyplot as plt

import script
import style

NAMES = {"theta_deg": r"$\theta$", "H": "$H$", "Q": "$Q$", "lambda": r"$\lambda$", "shear_rate": r"$\dot\gamma$", "I_th": r"$I_{th}$"}


def draw(report, path):
    rows = [row for row in report["effects"] if "scalars" in row][::-1]
    base = next(row for row in rows if row["effect"] == "none")
    scalars = [name for name in base["scalars"] if name in NAMES and base["scalars"][name] and name != "Q"]
    panels = ["cpu_seconds"] + scalars + ["v_x"]
    figure, all_axes = plt.subplots(1, len(panels), sharey=True, figsize=(2.1 * len(panels) + 2, 1.8 + 0.42 * len(rows)))
    for axes, panel in zip(all_axes, panels):
        if panel == "cpu_seconds":
            values, title, unit = [row["cpu_seconds"] for row in rows], "processor time", "s"
        elif panel == "v_x":
            values, title, unit = [math.nan if row["v_x_change"] is None else 100 * row["v_x_change"] for row in rows], r"$v_x(z)$, rms", "change [%]"
        else:
            values = [100 * row["change"].get(panel, math.nan) / base["scalars"][panel] for row in rows]
            title, unit = NAMES[panel], "change [%]"
        colors = [style.PAPER if row["effect"].startswith("none") else style.CONTINUUM for row in rows]
        axes.barh(range(len(rows)), [0 if math.isnan(value) else value for value in values], color=colors)
        for place, value in enumerate(values):
            if math.isnan(value):
                axes.annotate(" other layers", (0, place), va="center", fontsize=10, color="grey")
                continue
            text = f" {value:.3g} " if panel in ("cpu_seconds", "v_x") else f" {value:+.2g} "
            axes.annotate(text, (value, place), va="center", ha="left" if value >= 0 else "right", fontsize=10)
        axes.margins(x=0.45)
        axes.axvline(0, color="0.3", linewidth=1)
        axes.set_title(title)
        axes.set_xlabel(unit)
        axes.grid(axis="y", visible=False)
    all_axes[0].set_yticks(range(len(rows)), [row["effect"].replace("_", " ") for row in rows])
    figure.suptitle(style.title_of(f"{style.plain(report['title'])}: each effect alone", report["reduced"]), fontsize=13)
    style.save(figure, path, report["reduced"])


def main():
    report = script.content_of(sys.argv[1])
    style.use_style()
    draw(report, sys.argv[2])


if __name__ == "__main__":
    main()
