"""Panels that several figures of a study share: over depth, over the inertial number, over the flow rate."""

import math

import style
from study_runs import color_of, label_of, marker_of

MARK = {"color": "0.4", "linewidth": 1}


def depth_panel(axes, run, label, lowest=None):
    """Axes over depth with the marks of the paper: dash-dotted at the surface, dotted at the interface."""
    axes.axvline(0, linestyle="-.", **MARK)
    H = run.scalar("H")
    if math.isfinite(H):
        axes.axvline(-H, linestyle=":", **MARK)
    axes.set_xlabel(style.LABELS["z"])
    axes.set_ylabel(label)
    axes.set_xlim(lowest if lowest is not None else min(run.z) - 1, 4)


def lowest_shown(runs, standard):
    """Where an axis over depth begins: where the paper's does, or a d below the deepest layer of a bed that does not reach it."""
    return max(standard, min((min(run.z) for run in runs if run.z), default=standard) - 1)


def draw(axes, run, name, color=style.PARTICLES, label=None, rows=None, marker="o"):
    """A column over depth with its band; of all layers unless `rows` names some."""
    rows = range(len(run.z)) if rows is None else rows
    half = run.half_width(name)
    style.band(axes, [run.z[i] for i in rows], [run.columns[name][i] for i in rows],
               [half[i] for i in rows] if half else None, color, label, marker)


def draw_logarithmic(axes, run, name, size=3):
    """Positive values only; a band that reaches zero ends at the foot of the axis."""
    style.band(axes, run.z, run.columns[name], run.half_width(name), style.PARTICLES, foot=1e-2, markersize=size, linewidth=1)
    axes.set_yscale("log")


def limits_of(run, names, rows, margin=0.08, with_bands=False):
    """Limits of an axis that hold these columns at these rows; with the widest tenth of the bands left outside."""
    values, ends = [], []
    for name in names:
        half = run.half_width(name)
        for i in rows:
            value = run.columns[name][i]
            if math.isfinite(value):
                values.append(value)
                if half and math.isfinite(half[i]):
                    ends += [value - half[i], value + half[i]]
    if not values:
        return -1, 1
    low, high = min(values), max(values)
    if with_bands and ends:
        ends.sort()
        low, high = min(low, ends[len(ends) // 20]), max(high, ends[-1 - len(ends) // 20])
    room = margin * (high - low or 1)
    return low - room, high + room


def over_inertia(axes, run, values, halves, color, label=None, size=4):
    """values(i) over I at the layers where the shear rate's sign is known."""
    rows = run.inside()
    x = [run.columns["I"][i] for i in rows]
    y = [values[i] for i in rows]
    axes.plot(x, y, marker_of(run.rpm), color=color, markersize=size, label=label, linestyle="none",
              markerfacecolor=color, markeredgewidth=0.6)
    if halves is not None:
        order = sorted(range(len(x)), key=lambda i: x[i])
        axes.fill_between([x[i] for i in order], [y[i] - halves[rows[i]] for i in order],
                          [y[i] + halves[rows[i]] for i in order], color=color, alpha=0.1, linewidth=0)
    axes.set_xscale("log")
    axes.set_xlabel(style.LABELS["I"])


def over_flow_rate(axes, study, name, label, scale=None):
    """One scalar over Q: each run faint, the pooled speeds with their bars, marks as in the paper."""
    Q, Q_half = study.speed_values("Q")
    values, half = study.speed_values(name)
    for run in study.runs:
        axes.plot(run.scalar("Q"), run.scalar(name), "o", markersize=3, color="0.6", zorder=1)
    for speed, x, dx, y, dy in zip(study.speeds, Q, Q_half, values, half):
        rpm = speed["rotation_rpm"]
        bars = {"xerr": none_if_nan(dx), "yerr": none_if_nan(dy)}
        axes.errorbar(x, y, fmt=marker_of(rpm), color=color_of(study, rpm), markersize=7, elinewidth=1.2, zorder=3, **bars)
    axes.set_xlabel(r"$Q$  [$d\sqrt{gd}$]")
    axes.set_ylabel(label)
    if scale:
        axes.set_xlim(0, 1.08 * max([q for q in Q if q > 0] + study.paper_column("Q"), default=1))


def none_if_nan(value):
    return value if math.isfinite(value) else None


def speed_legend(axes, study, **options):
    """The marks of the speeds, without drawing anything."""
    for run in study.first_runs():
        axes.plot([], [], marker_of(run.rpm), color=color_of(study, run.rpm), linestyle="none", label=label_of(run))
    axes.legend(**options)
