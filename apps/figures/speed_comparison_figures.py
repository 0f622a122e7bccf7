"""Figures of `drumlin compare --study`: paper, particles and continuum over the speed of rotation; errors over their limits.

usage: speed_comparison_figures.py FOLDER   (holds study.json and takes the figures)
"""

import functools
import math
import pathlib
import sys

import quantity_table
import script
import style
from style import half_width_of, value_of

plt = style.plt


class Study:
    def __init__(self, path):
        content = script.content_of(path)
        self.speeds, self.laws, self.reduced = content["speeds"], content["laws"], content["reduced"]

    def points(self, name, side, over):
        """Per speed (x, y, half width of y, role); x is the speed or a quantity, that of the paper for the paper's points."""
        for speed in self.speeds:
            entry = speed["scalars"][name][side]
            x = speed["rotation_rpm"] if over == "rotation_rpm" else value_of(speed["scalars"][over][side])
            if math.isfinite(x) and math.isfinite(value_of(entry)):
                yield x, value_of(entry), half_width_of(entry), speed["role"]

    def coefficients(self, law, side):
        return {key: value_of(value) for key, value in self.laws.get(law, {}).get(side, {}).items()}


def draw_sides(axes, study, name, over):
    paper = list(study.points(name, "paper", over))
    if paper:
        axes.errorbar([p[0] for p in paper], [p[1] for p in paper], yerr=[0 if math.isnan(p[2]) else p[2] for p in paper], fmt="x",
                      color=style.PAPER, markersize=7, label="paper", elinewidth=1)
    ours = list(study.points(name, "particles", over))
    if ours:
        axes.errorbar([p[0] for p in ours], [p[1] for p in ours], yerr=[0 if math.isnan(p[2]) else p[2] for p in ours], fmt="o",
                      color=style.PARTICLES, markersize=6, capsize=3, elinewidth=1.2, label="particles, 99 %")
    flows = sorted(study.points(name, "continuum", over))
    axes.plot([p[0] for p in flows], [p[1] for p in flows], "-", color=style.CONTINUUM, linewidth=1, alpha=0.6)
    for x, y, half, _ in flows:
        if math.isfinite(half):  # what the calibration of the law leaves open
            axes.errorbar(x, y, yerr=half, fmt="none", ecolor=style.CONTINUUM, elinewidth=1, capsize=3, alpha=0.7)
    for role, face, label in (("calibrated", style.CONTINUUM, "continuum, calibrated here"), (None, "white", "continuum, predicted")):
        chosen = [p for p in flows if (p[3] == "calibrated") == (role is not None)]
        if chosen:
            axes.plot([p[0] for p in chosen], [p[1] for p in chosen], "s", color=style.CONTINUUM, markersize=8, markerfacecolor=face,
                      markeredgewidth=1.6, label=label)
    axes.set_ylabel(quantity_table.SCALARS[name].axis_label().replace("  [", "\n["))
    axes.set_xlabel("speed of rotation  [rpm]" if over == "rotation_rpm" else quantity_table.SCALARS["Q"].axis_label())
    highest = [p[1] + (0 if math.isnan(p[2]) else p[2]) for p in ours] + [p[1] for p in flows + paper]
    if name != "theta_deg" and highest:
        axes.set_ylim(0, 1.15 * max(highest))
    axes.set_xlim(left=0)


def draw_depth_laws(axes, study):
    """H = c sqrt(Q) of each side."""
    end = axes.get_xlim()[1]
    Q = [end * i / 60 for i in range(61)]
    for side, color, line in (("paper", style.PAPER, ":"), ("particles", style.PARTICLES, "--"), ("continuum", style.CONTINUUM, "--")):
        c = study.coefficients("flowing_layer_depth", side).get("c", math.nan)
        if math.isfinite(c):
            axes.plot(Q, [c * math.sqrt(q) for q in Q], line, color=color, linewidth=1, zorder=0, label=rf"{side}: ${c:.2f}\sqrt{{Q}}$")
    handles = [line for line in axes.get_lines() if "sqrt" in str(line.get_label())]
    axes.legend(handles=handles, loc="lower right")


def draw_slope_laws(axes, study):
    """tan(theta) = c0 + c1 Q of each side, at the Q that goes with a speed in proportion."""
    pairs = [(speed["rotation_rpm"], value_of(speed["scalars"]["Q"]["continuum"])) for speed in study.speeds]
    pairs = [(rpm, Q) for rpm, Q in pairs if math.isfinite(Q)]
    if not pairs:
        return
    per_rpm = sum(Q for _, Q in pairs) / sum(rpm for rpm, _ in pairs)
    end = axes.get_xlim()[1]
    for side, color, line in (("paper", style.PAPER, ":"), ("particles", style.PARTICLES, "--"), ("continuum", style.CONTINUUM, "--")):
        law = study.coefficients("effective_friction", side)
        if all(math.isfinite(law.get(key, math.nan)) for key in ("c0", "c1")):
            rpm = [0, end]
            axes.plot(rpm, [math.degrees(math.atan(law["c0"] + law["c1"] * per_rpm * r)) for r in rpm], line, color=color, linewidth=1, zorder=0)


def speeds(study):
    figure, axes = style.panels(3, height=3.6)
    draw_sides(axes[0], study, "theta_deg", "rotation_rpm")
    draw_slope_laws(axes[0], study)
    draw_sides(axes[1], study, "H", "Q")
    draw_depth_laws(axes[1], study)
    draw_sides(axes[2], study, "lambda", "Q")
    axes[0].legend()
    return figure


def rates(study):
    figure, axes = style.panels(2, height=3.8)
    draw_sides(axes[0], study, "shear_rate", "Q")
    draw_sides(axes[1], study, "I_th", "Q")
    axes[0].legend()
    return figure


def name_of(target):
    return target["quantity"] + (f", {target['zone']}" if "zone" in target else "")


MET, NEAR, MISSED = "#1a7f4b", "#e08a00", "#B00000"


def judge_of(target):
    """What a target is judged by: its limit, or the noise floor of the particles where that is larger."""
    return target["noise_floor"] if target["judged_by"] == "noise floor" else target["limit"]


def errors(study):
    """One row per target, one mark per speed, over what judges it; a bar where that is not the limit stands at the limit."""
    compared = [speed for speed in study.speeds if any(target["value"] is not None for target in speed["targets"])]
    names = [name_of(target) for target in compared[0]["targets"] if target["value"] is not None] if compared else []
    figure, (axes,) = style.panels(1, height=3.6 + 0.42 * len(names))
    largest = 1
    marks = "osD^vP*X<>"
    for i, speed in enumerate(compared):
        shift = 0.5 * (i / max(1, len(compared) - 1) - 0.5)
        calibrated = speed["role"] == "calibrated"
        for target in speed["targets"]:
            if target["value"] is None or name_of(target) not in names:
                continue
            y, share = names.index(name_of(target)) + shift, target["value"] / judge_of(target)
            near = target["outcome"] == "met" and target["value"] > target["limit"]
            color = MISSED if target["outcome"] == "missed" else NEAR if near else MET
            axes.plot(max(share, 0.02), y, marks[i % len(marks)], color=color, markerfacecolor=color if calibrated else "white", markeredgewidth=1.6, markersize=7)
            if judge_of(target) != target["limit"]:
                axes.plot([target["limit"] / judge_of(target)] * 2, [y - 0.12, y + 0.12], color="0.4", linewidth=2)
            largest = max(largest, share)
        axes.plot([], [], marks[i % len(marks)], color="0.2", markerfacecolor="0.2" if calibrated else "white", linestyle="none",
                  label=f"{speed['rotation_rpm']:.3g} rpm" + (", calibrated" if calibrated else ""))
    for color, label in ((MET, "within its limit"), (NEAR, "beyond it, within the noise"), (MISSED, "missed")):
        axes.plot([], [], "s", color=color, linestyle="none", label=label)
    axes.plot([], [], "|", color="0.4", markersize=10, markeredgewidth=2, linestyle="none", label="the limit, where the\nnoise floor judges")
    axes.axvspan(1, 100, color=MISSED, alpha=0.06, linewidth=0)
    axes.axvline(1, color=MISSED, linewidth=1)
    axes.set_xscale("log")
    axes.set_xlim(0.015, max(5, 1.5 * largest))
    axes.set_yticks(range(len(names)), names)
    axes.invert_yaxis()
    axes.set_xlabel("error / what judges it: limit, or larger noise floor")
    axes.set_title("met left of the line, missed right")
    axes.legend(loc="upper center", bbox_to_anchor=(0.3, -0.12), ncols=2)
    return figure


def main():
    folder = pathlib.Path(sys.argv[1])
    style.use_style()
    study = Study(folder / "study.json")
    script.save_each({draw.__name__: functools.partial(draw, study) for draw in (speeds, rates, errors)}, folder, study.reduced)


if __name__ == "__main__":
    main()
