"""Work against precision of `drumlin cost SCENE`: errors over processor seconds, the front and the scene's own settings marked.

usage: work_precision.py COST_JSON FOLDER
FOLDER takes work_precision.png and, of particles with long runs, statistics.png.
"""

import math
import pathlib
import sys

from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter

import script
import style

NAMES = {"field": "velocity field", "displacement": "velocity of each grain,\nmean over the stretch", "velocity": "velocity of each grain\nat the end",
         "energy": "kinetic energy", "solver": "velocity field,\ncontact solve alone", "theta_deg": r"$\theta$", "H": "$H$", "Q": "$Q$",
         "lambda": r"$\lambda$", "shear_rate": r"$\dot\gamma$", "I_th": r"$I_{th}$", "v_x": r"$v_x(z)$, rms", "v_x_mesh": r"$v_x(z)$, mesh and solver alone",
         "theta_com_deg": r"$\theta$ (centre of mass)  [deg]", "overlap_mean": "mean overlap  [d]"}
STATISTICS = ["theta_com_deg", "H", "shear_rate", "lambda", "I_th", "overlap_mean"]
NARROW = 3  # greatest over smallest time, up to which numbers of powers of ten would stand over one another, or be none
ROUNDING = 1e-9  # what is exact up to it is no panel


def name_of(quantity):
    return NAMES.get(quantity, quantity.replace("_", " "))


def curves_of(cost):
    """[(label, points)]: particles by solver and step, the tolerance along a curve; a flow by what is varied."""
    groups = {}
    for point in cost["points"]:
        if "failure" in point:
            continue
        if cost["kind"] == "particles":
            groups.setdefault(("tolerance", f"{point['solver']}, step {point['step_s']:g} s"), []).append(point)
        else:
            for axis in point["axes"]:
                groups.setdefault((axis, {"mesh": "number of meshes"}.get(axis, axis)), []).append(point)
    # From the coarsest to the finest.
    return [(label, sorted(points, key=lambda point: point["levels"] if axis == "mesh" else -point[axis])) for (axis, label), points in groups.items()]


def error_of(point, quantity):
    error = point["errors"].get(quantity)
    return error if error else math.nan


def mark_seconds(axes, seconds):
    """Numbers at a logarithmic axis of processor seconds, three where the times hardly differ."""
    axes.set_xscale("log")
    axes.xaxis.set_major_locator(MaxNLocator(2) if max(seconds, default=1) < NARROW * min(seconds, default=1) else LogLocator(subs=(1, 2, 5)))
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_major_formatter("{x:g}")


def limit_errors(axes, errors):
    """About errors of nearly one size with room and with numbers at 1, 2 and 5: by itself such an axis may lose its limits."""
    errors = [error for error in errors if error > 0]
    if errors and max(errors) < 10 * min(errors):
        axes.set_ylim(min(errors) / 1.6, 1.6 * max(errors))
        axes.yaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axes.yaxis.set_minor_formatter(NullFormatter())
        axes.yaxis.set_major_formatter("{x:.2g}")


def draw_panel(axes, cost, quantity):
    for (label, points), color in zip(curves_of(cost), style.COLORS * 3):
        axes.plot([point["cpu_seconds"] for point in points], [error_of(point, quantity) for point in points], marker="o", linewidth=1, alpha=0.85,
                  color=color, label=label)
    front = sorted((point for point in cost["points"] if quantity in point["pareto"]), key=lambda point: point["cpu_seconds"])
    front = [point for point in front if error_of(point, quantity) > 0]
    if front:
        axes.step([point["cpu_seconds"] for point in front], [error_of(point, quantity) for point in front], where="post", color="black", linewidth=1.2,
                  linestyle="--", label="front")
    for point in cost["points"]:
        if point["default"] and error_of(point, quantity) > 0:
            axes.plot([point["cpu_seconds"]], [error_of(point, quantity)], marker="*", markersize=15, color="black", zorder=5, linestyle="none",
                      label="the scene as it is")
    floor = (cost.get("floor") or {}).get(quantity)
    if floor and quantity != "solver":
        axes.axhline(floor, color="grey", linewidth=1, linestyle=":", label="the finest point")
    axes.set_yscale("log")
    shown = [point for point in cost["points"] if "failure" not in point]
    limit_errors(axes, [error_of(point, quantity) for point in shown])
    mark_seconds(axes, [point["cpu_seconds"] for point in shown])
    axes.set_title(name_of(quantity))
    axes.set_xlabel("processor seconds per second" if cost["kind"] == "particles" else "processor time  [s]")


def draw(cost):
    """The work-precision diagram of one cost.json, a panel for each quantity."""
    quantities = [quantity for quantity in cost["quantities"] if any(error_of(point, quantity) > ROUNDING for point in cost["points"])]
    figure, panels = style.panels(len(quantities) + 1, 2)  # the last place is the legend's
    for axes, quantity in zip(panels, quantities):
        draw_panel(axes, cost, quantity)
    for axes in panels[:len(quantities):2]:
        axes.set_ylabel("relative error")
    panels[len(quantities)].axis("off")
    panels[len(quantities)].legend(*panels[0].get_legend_handles_labels(), loc="center left")
    figure.suptitle(style.plain(style.title_of(f"{cost['title']}: {subtitle(cost)}", cost["reduced"])))
    return figure


def subtitle(cost):
    if cost["kind"] == "particles":
        reference = cost["reference"]
        return f"{cost['horizon_s']:g} s from one state, against tolerance {reference['tolerance']:.2g} and step {reference['step_s']:.2g} s"
    if cost["reference"] == "closed form":
        return "errors against the closed form"
    return f"errors against {cost['reference']['unknowns']:,} unknowns, eps {cost['reference']['eps']:g}"


def draw_statistics(cost):
    """Measured numbers of long runs with their 99 % intervals, over what the runs took."""
    points = [point for point in cost["points"] if "statistics" in point]
    known = [name for name in STATISTICS if any(name in point["statistics"]["scalars"] for point in points)]
    if not points or not known:
        return None
    figure, panels = style.panels(len(known) + 1, 2)  # the last place is the legend's
    steps = sorted({point["step_s"] for point in points})
    for axes, name in zip(panels, known):
        for step, color in zip(steps, style.COLORS):
            here = sorted((point for point in points if point["step_s"] == step), key=lambda point: point["tolerance"])
            found = [(point["statistics"]["cpu_seconds"], point["statistics"]["scalars"].get(name, {})) for point in here]
            found = [(seconds, entry["value"], entry["ci99"] or 0) for seconds, entry in found if entry.get("value") is not None]
            axes.errorbar([x for x, _, _ in found], [y for _, y, _ in found], [e for _, _, e in found], fmt="o-", linewidth=1, capsize=3, color=color,
                          label=f"step {step:g} s,\ntolerance along the curve")
        for point in points:
            entry = point["statistics"]["scalars"].get(name, {})
            if point["default"] and entry.get("value") is not None:
                axes.plot([point["statistics"]["cpu_seconds"]], [entry["value"]], marker="*", markersize=15, color="black", zorder=5, linestyle="none",
                          label="the scene as it is")
        mark_seconds(axes, [point["statistics"]["cpu_seconds"] for point in points])
        axes.set_title(name_of(name))
        axes.set_xlabel("processor time  [s]")
    panels[len(known)].axis("off")
    panels[len(known)].legend(*panels[0].get_legend_handles_labels(), loc="center left")
    seconds = points[0]["statistics"]["simulated_seconds"]
    figure.suptitle(style.plain(style.title_of(f"{cost['title']}: measured over {seconds:g} s, bars 99 %", cost["reduced"])))
    return figure


def draw_all(cost, folder):
    style.use_style()
    script.save_each({"work_precision": lambda: draw(cost), "statistics": lambda: draw_statistics(cost)}, folder, cost["reduced"])


if __name__ == "__main__":
    draw_all(script.content_of(sys.argv[1]), pathlib.Path(sys.argv[2]))
