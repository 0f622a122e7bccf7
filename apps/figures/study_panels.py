"""Panels that several figures of a study share: over depth, over the inertial number, over the flow rate."""

import math

import numpy as np

import style
from study_runs import color_of, label_of, marker_of


def depth_panel(axes, run, label, lowest=None):
    """Axes over depth with the marks of the paper: dash-dotted at the surface, dotted at the interface."""
    style.depth_axes(axes, run.scalar("H"), label, "-.")
    axes.set_xlim(lowest if lowest is not None else min(run.z) - 1, 4)


def lowest_shown(runs, standard):
    """Where an axis over depth begins: where the paper's does, or a d below the deepest layer of a bed that does not reach it."""
    return max(standard, min((run.z.min() for run in runs if run.z.size), default=standard) - 1)


def draw(axes, run, name, color=style.PARTICLES, label=None, rows=slice(None), marker="o"):
    """A column over depth with its band; of all layers unless `rows` names some."""
    half = run.half_width(name)
    style.band(axes, run.z[rows], run.columns[name][rows], None if half is None else half[rows], color, label, marker)


def draw_logarithmic(axes, run, name, size=3):
    """Positive values only; a band that reaches zero ends at the foot of the axis."""
    style.band(axes, run.z, run.columns[name], run.half_width(name), style.PARTICLES, foot=1e-2, markersize=size, linewidth=1)
    axes.set_yscale("log")


def limits_of(run, name, rows, with_bands=False):
    """Limits of an axis that hold a column at these rows; with the widest tenth of its bands left outside."""
    values, half = run.columns[name][rows], run.half_width(name)
    known = values[np.isfinite(values)]
    if not known.size:
        return -1, 1
    low, high = known.min(), known.max()
    ends = np.sort([values - half[rows], values + half[rows]], axis=None) if with_bands and half is not None else known[:0]
    ends = ends[np.isfinite(ends)]
    if ends.size:
        low, high = min(low, ends[ends.size // 20]), max(high, ends[-1 - ends.size // 20])
    room = 0.08 * (high - low or 1)
    return low - room, high + room


def over_inertia(axes, run, values, halves, color, label=None, size=4):
    """Values over I at the layers where the shear rate's sign is known."""
    rows = run.inside()
    x, y = run.columns["I"][rows], values[rows]
    axes.plot(x, y, marker_of(run.rpm), color=color, markersize=size, label=label, linestyle="none",
              markerfacecolor=color, markeredgewidth=0.6)
    if halves is not None:
        order = np.argsort(x, kind="stable")
        low, high = (y - halves[rows])[order], (y + halves[rows])[order]
        axes.fill_between(x[order], low, high, color=color, alpha=0.1, linewidth=0)
    axes.set_xscale("log")
    axes.set_xlabel(style.axis_label("I"))


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


def speed_marks(axes, study):
    """The marks of the speeds for a legend, without drawing anything."""
    return [axes.plot([], [], marker_of(run.rpm), color=color_of(study, run.rpm), linestyle="none", label=label_of(run))[0] for run in study.first_runs()]


def speed_legend(axes, study, **options):
    """Of the marks of the speeds, and of what was drawn with a label."""
    speed_marks(axes, study)
    axes.legend(**options)
