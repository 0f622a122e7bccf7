"""Figures of `drumlin cost --effects`: what each effect takes and changes, and how it meets the limits of a comparison.

usage: price_figures.py JSON FOLDER
JSON is COST/cost.json, or a record of drumlin-effect-errors-1 (data/cost/effects-flow-6rpm.json). FOLDER takes prices.png and, of a flow that was compared
with particles, effects.png.
"""

import math
import pathlib
import sys

from matplotlib.colors import TwoSlopeNorm

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
                      ha="left" if side > 0 else "right")
    axes.axvline(0, color="0.3", linewidth=1)
    axes.set_xlim(-1.7 * longest, 1.7 * longest)
    axes.set_xticks([-longest, 0, longest])
    axes.set_xlabel("change [%]")
    axes.set_title(title)
    axes.grid(axis="y", visible=False)


def of_particles(report):
    """Changes relative to the scene as it is, with and without each effect."""
    priced = [row for row in report["variants"] if "cpu_seconds" in row]
    base, rows = priced[0], priced[1:][::-1]
    figure, places = style.panels(len(PANELS), 2, 1.2 + 0.4 * len(rows), sharey=True)
    for axes, (key, title) in zip(places, PANELS):
        draw_panel(axes, key, title, base, rows)
    places[0].set_yticks(range(len(rows)), [label(row) for row in rows])
    figure.suptitle(style.title_of(f"{style.plain(report['title'])}, first {report['simulated_seconds']:g} s\n"
                                   "without (-) and with (+) an effect, against the scene as it is",
                                   report["reduced"]))
    return figure


NAMES = {"theta_deg": r"$\theta$", "H": "$H$", "Q": "$Q$", "lambda": r"$\lambda$", "shear_rate": r"$\dot\gamma$", "I_th": r"$I_{th}$"}


def of_flow(report):
    """What each effect of a flow takes, and what it changes in the scalars and the profile."""
    rows = [row for row in report["effects"] if "scalars" in row][::-1]
    base = next(row for row in rows if row["effect"] == "none")
    scalars = [name for name in base["scalars"] if name in NAMES and base["scalars"][name] and name != "Q"]
    panels = ["cpu_seconds"] + scalars + ["v_x"]
    figure, places = style.panels(len(panels), 2, 1.2 + 0.36 * len(rows), sharey=True)
    for axes, panel in zip(places, panels):
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
                axes.annotate(" other layers", (0, place), va="center", color="grey")
                continue
            text = f" {value:.3g} " if panel in ("cpu_seconds", "v_x") else f" {value:+.2g} "
            axes.annotate(text, (value, place), va="center", ha="left" if value >= 0 else "right")
        axes.margins(x=0.45)
        axes.axvline(0, color="0.3", linewidth=1)
        axes.set_title(title)
        axes.set_xlabel(unit)
        axes.grid(axis="y", visible=False)
    places[0].set_yticks(range(len(rows)), [row["effect"].replace("_", " ") for row in rows])
    figure.suptitle(style.title_of(f"{style.plain(report['title'])}: each effect alone", report["reduced"]))
    return figure


def name_of(target):
    return target["quantity"].replace("_deg", "").replace("log10_shear_rate", "log rate").replace("axis_angle", "axes") + (f"\n{target['zone']}" if "zone" in target else "")


def rows_of(report):
    """The variants that were found: name, targets, processor seconds."""
    if report["format"] == "drumlin-effect-errors-1":
        return [{"name": " + ".join(row["effects"]).replace("_", " ") or "none", "targets": row["targets"], "cpu_seconds": row["cpu_seconds"]}
                for row in report["variants"] if row["exit"] == 0]
    return [{"name": row["effect"].replace("_", " ").replace("+", " + "), "targets": row["against"]["targets"], "cpu_seconds": row["cpu_seconds"]}
            for row in report["effects"] if "against" in row]


def errors(report):
    """Effects of the continuum one at a time: every error over its limit, coloured, and the seconds."""
    rows = rows_of(report)
    known = [i for i, target in enumerate(rows[0]["targets"]) if target["quantity"] != "Q" and all(row["targets"][i]["value"] is not None for row in rows)]
    ratios = [[row["targets"][i]["value"] / row["targets"][i]["limit"] for i in known] for row in rows]
    figure, (axes, bars) = style.panels(2, 2, 2.2 + 0.42 * len(rows), width_ratios=[5, 1], sharey=True)
    axes.imshow([[min(ratio, 2) for ratio in line] for line in ratios], cmap="RdYlGn_r", norm=TwoSlopeNorm(1, 0, 2), aspect="auto", alpha=0.75)
    for y, line in enumerate(ratios):
        for x, ratio in enumerate(line):
            axes.text(x, y, f"{ratio:.1f}", ha="center", va="center", weight="bold" if ratio > 1 else "normal")
    axes.set_xticks(range(len(known)), [name_of(rows[0]["targets"][i]).replace("\n", ", ") for i in known], rotation=60, ha="right", rotation_mode="anchor")
    axes.set_yticks(range(len(rows)), [row["name"] for row in rows])
    axes.grid(False)
    axes.set_title("error / limit; bold: missed")
    seconds = [row["cpu_seconds"] for row in rows]
    bars.barh(range(len(rows)), seconds, color=style.CONTINUUM, height=0.6)
    for y, value in enumerate(seconds):
        bars.text(value, y, f" {value:.0f}", va="center")
    bars.set_xlim(0, 1.2 * max(seconds))
    bars.set_title("seconds")
    return figure


FIGURES = {"drumlin-effect-prices-1": of_particles, "drumlin-flow-effect-prices-1": of_flow, "drumlin-effect-errors-1": errors}


def draw_all(report, folder):
    style.use_style()
    drawings = {"prices": FIGURES[report["format"]]}
    if any("against" in row for row in report.get("effects", [])):
        drawings["effects"] = errors
    for name, draw in drawings.items():
        style.save(draw(report), folder / f"{name}.png", report.get("reduced", False))


if __name__ == "__main__":
    draw_all(script.content_of(sys.argv[1]), pathlib.Path(sys.argv[2]))
