"""Figure of `drumlin calibrate`: the points of all runs over I, the law with its 99 % band, the residual, and the axes; below them the memory of
the axes and the threshold of fluidity, where they were fitted.

usage: calibrate_figures.py RECORD_JSON PICTURE

The law is drawn and subtracted as the record holds it: the command evaluates it, with the function that the flow uses."""

import functools
import itertools
import math
import sys

import numpy as np

import script
import style


def colors_of(record):
    """One colour per speed."""
    speeds = sorted({round(run["rotation_rpm"], 2) for run in record["points"]})
    return dict(zip(speeds, itertools.cycle(style.COLORS)))


def draw_points(axes, record, quantity, colors, less_law=False):
    labelled = set()
    for run in record["points"]:
        values = np.array([np.nan if v is None else v for v in run[quantity]])
        inertial = np.array(run["I"])
        if less_law:
            values = values - np.array(run["law"])
        speed = round(run["rotation_rpm"], 2)
        label = None if (speed, run["held_out"]) in labelled else (f"{speed:g} rpm" if speed else "without rotation") + (", held out" if run["held_out"] else "")
        labelled.add((speed, run["held_out"]))
        axes.plot(inertial, values, "o" if not run["held_out"] else "x", color=colors[speed], alpha=0.35,
                  markersize=3, linestyle="none", label=label)


def draw_amount(axes, memory):
    """|s|/p over I, with the table that the law holds."""
    for points, color in zip(memory["amount"]["points"], [style.PARTICLES, *style.OTHERS] * 10):
        axes.plot(points["I"], points["amount"], "o", color=color, alpha=0.35, markersize=3, linestyle="none", label=style.plain(points["run"]))
    curve, line = memory["amount"]["curve"], memory["amount"]["bed_line"]
    axes.fill_between(curve["I"], curve["low"], curve["high"], color="0.3", alpha=0.35, linewidth=0)
    axes.plot(curve["I"], curve["value"], color=style.PAPER, label=f"table: rms {memory['amount']['rms_misfit']:.4f}")
    if line is not None:
        inertial = np.geomspace(curve["I"][0], 1e-3, 20)
        axes.plot(inertial, line["a"] + line["b"] * np.log(inertial), "--", color=style.CONTINUUM,
                  label=f"{line['a']:.3f} + {line['b']:.4f} ln I in the bed")
    axes.set_xscale("log")
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"$I = 2|D|/\sqrt{p}$")
    axes.set_ylabel(r"$|s|/p$")
    axes.set_title("Stress ratio")
    axes.legend(loc="lower right")


def draw_arc(axes, arc, with_legend):
    """Axes of stress and strain rate along an arc about the drum's axis."""
    axes.plot(arc["angle_deg"], arc["stress_deg"], "o-", color=style.PARTICLES, label="stress")
    axes.plot(arc["angle_deg"], arc["law_deg"], color=style.CONTINUUM, label="law with memory")
    axes.plot(arc["angle_deg"], arc["strain_rate_deg"], "--", color="0.45", label="strain rate")
    axes.axhline(0, color="0.5", linewidth=1)
    axes.set_title(f"r = {arc['radius'][0]:.0f} to {arc['radius'][1]:.0f} d")
    axes.set_xlabel("angle, downslope +  [°]")
    axes.set_ylabel("axis less that of\nsimple shear  [°]")
    if with_legend:
        style.room_above(axes, 0.6)
        axes.legend(loc="upper left")


LEAST_POINTS = 4  # of a panel: fewer show no course


def memory_panels(memory):
    arcs = [arc for arc in memory["arcs"] if len(arc["angle_deg"]) >= LEAST_POINTS]
    return [lambda axes: draw_amount(axes, memory), *(lambda axes, arc=arc: draw_arc(axes, arc, arc is arcs[0]) for arc in arcs)]


def draw_curvature(axes, nonlocal_record):
    """What curves upwards over the stress ratio, beside what a threshold would require."""
    lengths = nonlocal_record["lengths"]
    middle = [sum(length["mu"]) / 2 for length in lengths]
    axes.plot(middle, [length["curvature"] for length in lengths], "o-", color=style.PARTICLES, label="measured")
    laws = [("fit", nonlocal_record["amplitude"], nonlocal_record["mu_s"])]
    laws += [(rf"$\mu_s$ = {law['mu_s']:.2f}", law["amplitude"], law["mu_s"]) for law in nonlocal_record["given_mu_s"] if law["mu_s"] in (0.22, 0.26)]
    for (name, amplitude, threshold), line in zip(laws, ("-", "--", ":")):
        if amplitude > 0:
            below = [mu for mu in middle if mu < threshold] + [threshold]
            axes.plot(below, [(threshold - mu) / amplitude**2 for mu in below], line, color=style.CONTINUUM, label=f"{name}: A = {amplitude:.2f}")
    axes.axhline(0, color="0.6", linewidth=0.8)
    axes.set_ylim(top=4 * max(length["curvature"] for length in lengths))
    axes.set_xlabel(r"$|s|/p$")
    axes.set_ylabel(r"$\nabla^2g/g$  [$1/d^2$]")
    axes.set_title("Curvature of the fluidity")
    axes.legend(loc="upper right", frameon=True)


def draw_misfits(axes, nonlocal_record):
    given = nonlocal_record["given_mu_s"]
    axes.plot([law["mu_s"] for law in given], [law["rms_bed"] for law in given], "s-", color=style.CONTINUUM, label=r"threshold $\mu_s$")
    axes.axhline(nonlocal_record["rms_local_bed"], color=style.PARTICLES, label="no threshold")
    axes.set_ylim(bottom=0)
    axes.set_xlabel(r"$\mu_s$")
    axes.set_ylabel("residual of $|s|/p$\nin the bed, rms")
    axes.set_title("Threshold of the fluidity")
    style.room_above(axes, 0.3)
    axes.legend(loc="upper left")


def nonlocal_panels(nonlocal_record):
    drawn = [draw_curvature, draw_misfits] if len(nonlocal_record["lengths"]) >= LEAST_POINTS else [draw_misfits]
    return [functools.partial(draw, nonlocal_record=nonlocal_record) for draw in drawn]


def curve_of(record):
    return next(form for form in record["forms"] if form["chosen"])["curve"]


def draw_law(axes, record):
    """The points of all runs over I, the law that was chosen with its 99 % band, and the other forms."""
    draw_points(axes, record, "mu", colors_of(record))
    for form in record["forms"]:
        if not form["chosen"]:
            axes.plot(form["curve"]["I"], form["curve"]["value"], "--", color="0.45", linewidth=1.2,
                      label=f"{form['form']}: rms {form['rms_misfit']:.4f}")
    chosen = next(form for form in record["forms"] if form["chosen"])
    curve = chosen["curve"]
    axes.fill_between(curve["I"], curve["low"], curve["high"], color="0.3", alpha=0.35, linewidth=0)
    axes.plot(curve["I"], curve["value"], color=style.PAPER,
              label=f"{chosen['form']}: rms {chosen['rms_misfit']:.4f}, 99 % band")
    axes.set_ylim(bottom=0)
    axes.set_ylabel(r"$\mu$ along the strain rate" if record["source"] == "maps" else style.axis_label("mu"))
    over_inertial_number(axes, record)


def draw_rest(axes, record):
    """Residual of the points, beside the law's 99 % band."""
    draw_points(axes, record, "mu", colors_of(record), less_law=True)
    curve = curve_of(record)
    value = np.array(curve["value"])
    axes.fill_between(curve["I"], np.array(curve["low"]) - value, np.array(curve["high"]) - value, color="0.3",
                      alpha=0.35, linewidth=0, label="99 % band of the law")
    axes.axhline(0, color=style.PAPER, linewidth=1)
    axes.set_ylim(-0.1, 0.1)
    axes.set_ylabel(r"$\mu$ less the law")
    over_inertial_number(axes, record)


def draw_misalignment(axes, record):
    draw_points(axes, record, "axis_angle_deg", colors_of(record))
    axes.plot(record["turn"]["axis_angle"]["I"], record["turn"]["axis_angle"]["degrees"], color=style.PAPER, label="fit")
    axes.axhline(0, color="0.5", linewidth=1)
    axes.set_ylim(-50, 30)
    axes.set_ylabel("axis of stress less\nthat of strain rate  [°]")
    over_inertial_number(axes, record)


def over_inertial_number(axes, record):
    """The horizontal axis, and where the law is ill-posed."""
    axes.set_xscale("log")
    axes.set_xlabel(r"$I = 2|D|/\sqrt{p}$" if record["source"] == "maps" else style.axis_label("I"))
    for low, high in record["ill_posed_I"]:
        axes.axvspan(low, high, color="#D55E00", alpha=0.08, linewidth=0)
    inertial = curve_of(record)["I"]
    axes.set_xlim(0.5 * inertial[0], 2 * inertial[-1])


def main():
    record = script.content_of(sys.argv[1])
    style.use_style()
    parts = [(draw_law, "Friction law"), (draw_rest, "Residual")]
    if record["turn"] is not None and "axis_angle_deg" in record["points"][0]:
        parts.append((draw_misalignment, "Non-coaxiality angle"))
    further = [panel for panels_of, key in ((memory_panels, "memory"), (nonlocal_panels, "nonlocal")) if key in record for panel in panels_of(record[key])]
    alone = 2 + ("memory" in record)
    figure, places = style.places([1] * alone + [2] * math.ceil((len(parts) + len(further) - alone) / 2), 3.4)
    panels = [figure.add_subplot(place) for place in places[:len(parts) + len(further)]]
    for axes, (draw, title) in zip(panels, parts):
        draw(axes, record)
        axes.set_title(title)
    panels[0].legend(loc="lower right")
    for axes, draw in zip(panels[len(parts):], further):
        draw(axes)
    style.save(figure, sys.argv[2], record["reduced"])


if __name__ == "__main__":
    main()
