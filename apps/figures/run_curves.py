"""Curves over the time of a run: accuracy and state from log.csv, the energy ledger, and where the time went."""

import math

import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np

import result_files
import style


def mark_stages(axes, stages, end):
    """A line where a stage ends; its name above."""
    begin = 0
    for stage in stages:
        if begin < end:
            if begin > 0:
                axes.axvline(begin, color="0.5", linewidth=0.8, linestyle=":")
            axes.annotate(style.plain(stage["name"], 30, 1), ((begin + min(stage["end_s"], end)) / 2, 1.0), ha="center", va="bottom",
                          xycoords=("data", "axes fraction"), color="0.35")
        begin = stage["end_s"]


def log_panel(axes, time, curves, label):
    """curves: (name, values, colour). Values that are 0, or no numbers, have no place on the axis."""
    shown = False
    for name, values, colour in curves:
        positive = np.where(np.asarray(values) > 0, values, math.nan)
        if np.isfinite(positive).any():
            axes.plot(time, positive, label=name, color=colour, linewidth=0.9)
            shown = True
    if shown:
        axes.set_yscale("log")
        # The first steps of free fall, exact to rounding, would flatten all that follows.
        usual = [np.nanquantile(np.where(np.asarray(values) > 0, values, math.nan), 0.01) for _, values, _ in curves
                 if np.any(np.asarray(values) > 0)]
        low, high = axes.get_ylim()
        low = max(low, min(usual) / 5)
        axes.set_ylim(low, high)
        if high / low < 10:  # else no power of ten is on the axis, and nothing can be read off
            axes.set_ylim(10 ** math.floor(math.log10(low)), 10 ** math.ceil(math.log10(high)))
    else:
        axes.text(0.5, 0.5, "0 throughout", transform=axes.transAxes, ha="center", va="center", color="0.4")
    axes.set_ylabel(label)
    if len(curves) > 1 or curves[0][0]:
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def threshold(axes, value, name):
    axes.axhline(value, color=style.PAPER, linewidth=1, linestyle="--", label=name)
    axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def title(drawing, what):
    state = "" if drawing["status"] == "finished" else f" (run {style.plain(drawing['status'])})"
    return style.title_of(f"{style.plain(drawing['title'])}\n{what}{state}", drawing["reduced"])


def draw_log(drawing, path):
    log = result_files.read_table(drawing["log"])[2]
    if not log or not len(log["time_s"]):
        return False
    time, blue, orange = log["time_s"], style.PARTICLES, style.CONTINUUM
    figure, panels = style.panels(6, height=2.1, sharex=True)
    log_panel(panels[0], time, [("largest", log["residual_max"], orange), ("rms", log["residual"], blue)], "residual")
    threshold(panels[0], drawing["tolerance"], "tolerance of rms")
    log_panel(panels[1], time, [("largest", log["penetration"], blue)], "penetration\nper step  [$d$]")
    threshold(panels[1], drawing["penetration_tolerance"], "tolerance")
    log_panel(panels[2], time, [("largest", log["overlap_max"], orange), ("mean", log["overlap_mean"], blue)],
              "overlap before\nprojection  [$d$]")
    log_panel(panels[3], time, [("", log["kinetic_energy"], blue)], "kinetic energy\n" + r"[$\rho_0 g d^3$]")
    for axes, name, label in [(panels[4], "sweeps", "sweeps\nper step"), (panels[5], "contacts", "contacts\nsolved")]:
        axes.plot(time, log[name], color=blue, linewidth=0.9)
        axes.set_ylim(0, None)
        axes.set_ylabel(label)
        axes.yaxis.set_major_locator(matplotlib.ticker.MaxNLocator(4, integer=True))
    panels[5].set_xlabel("time  [s]")
    missed = 1 - np.mean(log["converged"])
    mark_stages(panels[0], drawing["stages"], time[-1])
    for axes in panels[1:]:
        mark_stages(axes, [dict(stage, name="") for stage in drawing["stages"]], time[-1])
    figure.align_ylabels(panels)
    figure.suptitle(title(drawing, f"accuracy and state; {100 * missed:.0f} % of the steps missed a tolerance"))
    style.save(figure, path, drawing["reduced"])
    return True


def draw_energy(drawing, path):
    """Every column of the ledger but those that say when; what the books do not explain is a number in the title."""
    table = result_files.read_table(drawing["energy"])[2]
    time, error = table.pop("time_s", None), table.pop("closing_error", None)
    curves = {name: values for name, values in table.items()
              if name not in ("step", "stage") and isinstance(values, np.ndarray)}
    if time is None or not len(time) or not curves:
        return False
    figure, (axes,) = style.panels(1, height=5)
    colours = style.COLORS + ["0.4", style.PAPER]
    for k, (name, values) in enumerate(curves.items()):
        axes.plot(time, values, label=name.replace("_", " "), color=colours[k % len(colours)], linewidth=1.3,
                  linestyle=["-", "--", ":"][k // len(colours) % 3])
    axes.set_xlabel("time  [s]")
    axes.set_ylabel(r"energy, work  [$\rho_0 g d^3$]")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.15), ncols=2)
    mark_stages(axes, drawing["stages"], time[-1])
    closes = "" if error is None else f"; it closes to {np.nanmax(np.abs(error)):.1g}"
    figure.suptitle(title(drawing, "energy ledger: changes since the start" + closes))
    style.save(figure, path, drawing["reduced"])
    return True


def draw_time(drawing, path):
    run = drawing["run"]
    parts = {name[:-len("_seconds")].replace("_", " "): value for name, value in run.get("cost", {}).items()
             if name.endswith("_seconds") and value is not None}
    if not parts or not run.get("wall_seconds") or not run.get("steps"):
        return False
    # What is written beside the computation counts in its own thread, so that the sum may exceed the wall time.
    rest = run["wall_seconds"] - sum(parts.values())
    if rest > 0.001 * run["wall_seconds"]:
        parts["everything else"] = rest
    parts = dict(sorted(parts.items(), key=lambda part: part[1]))
    figure, (axes,) = style.panels(1, height=1.6 + 0.55 * len(parts))
    bars = axes.barh(list(parts), list(parts.values()), color=style.PARTICLES, height=0.65)
    for bar, value in zip(bars, parts.values()):
        share, step = 100 * value / run["wall_seconds"], 1e3 * value / run["steps"]
        axes.annotate(f"{value:.3g} s, {share:.1f} %, {step:.2g} ms per step",
                      (bar.get_width(), bar.get_y() + bar.get_height() / 2), xytext=(6, 0), va="center",
                      textcoords="offset points")
    axes.set_xlim(0, 2.3 * max(parts.values()) or 1)
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("wall time  [s]")
    figure.suptitle(title(drawing, f"where the time went: {run['wall_seconds']:.3g} s, {run['steps']} steps,\n"
                                   f"{run['grains']} grains, threads: {run['threads']}"))
    style.save(figure, path, drawing["reduced"])
    return True


def draw(drawing, folder):
    """Returns {file: what it shows}; what there is no data for is not drawn."""
    plt.rcParams.update({"savefig.dpi": 130, "savefig.bbox": None})
    figures = {}
    if draw_log(drawing, folder / "log.png"):
        figures["log.png"] = "residual, penetration, overlap, kinetic energy, sweeps and contacts over time"
    if drawing["energy"] and draw_energy(drawing, folder / "energy.png"):
        figures["energy.png"] = "energy ledger over time"
    if draw_time(drawing, folder / "time.png"):
        figures["time.png"] = "where the time went"
    return figures
