"""What speaks for a continuum flow: where its equations are well-posed, how Newton's method went, what settings move."""

import math

import matplotlib.colors
import matplotlib.pyplot as plt
import matplotlib.ticker
import numpy as np
import result_files
import style

# Names of the scalars in the figure of the sensitivities.
SCALARS = {"theta_deg": r"$\theta$", "Q": "$Q$", "H": "$H$", "lambda": r"$\lambda$", "shear_rate": r"$\dot\gamma$",
           "I_th": r"$I_{th}$", "I": "$I$", "mu_wall": r"$\mu_{wall}$", "torque": "torque", "surface_speed": "surface speed",
           "mean_speed": "mean speed"}


def well_posedness(flow, header, grids, draw_map):
    """Margin of the symbol of the linearised equations: negative where waves grow the faster the shorter they are."""
    margin = grids["well_posedness_margin"]
    share = 100 * flow["ill_posed_share"]
    said = f"ill-posed in {share:.2g} % of the area" if share > 0 else "well-posed everywhere"
    label = "margin of the symbol"
    # Blue on the safe side; linear within a hundredth, for the flow itself keeps little of the margin.
    top = max(0.1, float(abs(margin).max()))
    norm = matplotlib.colors.SymLogNorm(0.01, vmin=-top, vmax=top)
    if "drum_radius" in header or "outer_radius" in header:
        figure, (axes,) = style.maps(1, 1, np.ptp(grids["x"]), np.ptp(grids["z"]))
        draw_map(axes, grids, margin, f"{label}, red: ill-posed;\n{said}", norm, "RdBu", header, flow.get("surface"))
        if (margin < 0).any():
            axes.contour(grids["x"], grids["z"], margin.filled(top), levels=[0], colors="black", linewidths=0.8)
    else:  # a strip is the same all along
        figure, (axes,) = style.panels(1, height=4.6)
        axes.plot(margin[:, margin.shape[1] // 2], grids["z"], color=style.CONTINUUM)
        axes.axvline(0, color="grey", linewidth=0.8, linestyle=":")
        axes.set_xlabel(f"{label}, negative: ill-posed")
        axes.set_ylabel(style.axis_label("z"))
        axes.set_title(style.title_of(said, flow["reduced"]))
    return figure


def runs_of(rows):
    """Stretches of one mesh, phase and eps without a new start, as lists of indices."""
    stretches = []
    for i, row in enumerate(rows):
        key = (row["mesh"], row["phase"], row["shear_rate"])
        if not stretches or stretches[-1][0] != key or row["iteration"] == 1:
            stretches.append((key, []))
        stretches[-1][1].append(i)
    return stretches


def draw_residuals(axes, rows, along, colors):
    """Residuals over the iterations or over time; each stretch a line of its own, named by its phase once."""
    named = set()
    for (_, phase, _), places in runs_of(rows):
        axes.semilogy([along[i] for i in places], [rows[i]["residual"] for i in places], marker="o",
                      color=colors[phase], label=None if phase in named else phase)
        named.add(phase)
    for before, after in zip(range(len(rows) - 1), range(1, len(rows))):
        if rows[before]["mesh"] != rows[after]["mesh"]:
            axes.axvline(0.5 * (along[before] + along[after]), color="grey", linewidth=0.8, linestyle=":")
            axes.annotate(f" mesh {rows[after]['mesh']:g}", (0.5 * (along[before] + along[after]), 1),
                          xycoords=("data", "axes fraction"), va="top", color="grey")


def draw_convergence(axes, rows, tolerance, over_time=False):
    """How Newton's method went, from the rows of iterations.csv: residuals over the iterations, or over the seconds; a colour for each phase."""
    phases = list(dict.fromkeys(row["phase"] for row in rows))
    colors = dict(zip(phases, (style.COLORS + [style.PAPER]) * 3))
    draw_residuals(axes, rows, [row["seconds"] for row in rows] if over_time else list(range(1, len(rows) + 1)), colors)
    axes.axhline(tolerance, color="grey", linewidth=0.8, linestyle="--")
    axes.set_xlabel("seconds since the start" if over_time else "iteration")
    if not over_time:
        axes.xaxis.set_major_locator(matplotlib.ticker.MaxNLocator(integer=True))


def newton(folder, flow):
    rows = result_files.read_rows(folder / "iterations.csv")
    if not rows:
        return None
    figure, axes = style.panels(3, height=3.6)
    for place, over_time in zip(axes, (False, True)):
        draw_convergence(place, rows, flow["settings"]["tolerance"], over_time)
        place.set_ylabel("residual / norm of the loads")
    axes[0].legend(loc="lower left", title="phase, each eps a line")
    work = flow["phases"]
    axes[2].barh(list(work), [part["seconds"] for part in work.values()], color=style.CONTINUUM)
    for row, part in enumerate(work.values()):
        axes[2].annotate(f" {part['seconds']:.2g} s, {part['times']} times", (part["seconds"], row), va="center")
    axes[2].margins(x=0.55)
    axes[2].invert_yaxis()
    axes[2].grid(axis="y", visible=False)
    axes[2].set_xlabel("seconds of work")
    ranks = f", {flow['ranks']} ranks" if flow["ranks"] > 1 else ""
    figure.suptitle(style.title_of(f"{flow['iterations']} iterations to {flow['unknowns']} unknowns in {flow['seconds']:.3g} s{ranks}",
                                   flow["reduced"]))
    return figure


def changes_of(flow, setting):
    """Changes by one setting in per cent of the scalars' values; NaN where there is nothing to compare."""
    result = {}
    for name in flow["meshes"][-1]:
        value, change = flow.get(name), setting["changes"].get(name)
        if name not in SCALARS:
            continue
        result[name] = 100 * change / abs(value) if value and change is not None else math.nan
    if setting["profile"] is not None:
        result["profile"] = 100 * setting["profile"]
    return result


def sensitivity(flow):
    """Bars on a logarithmic scale: what matters next to nothing and what matters most differ by decades."""
    settings = [setting for setting in flow["sensitivity"] or [] if setting["found"]]
    if not settings:
        return None
    names = [name for name in flow["meshes"][-1] if name in SCALARS] + ["profile"]
    figure, (axes,) = style.panels(1, height=1.4 + 0.62 * len(names))
    height = 0.8 / len(settings)
    known = []
    for s, (setting, color) in enumerate(zip(settings, style.COLORS)):
        changes = changes_of(flow, setting)
        for row, name in enumerate(names):
            change = changes.get(name, math.nan)
            place = row + (s - 0.5 * (len(settings) - 1)) * height
            if not math.isfinite(change) or change == 0:
                continue
            known.append(abs(change))
            axes.barh(place, abs(change), height=height, color=color, left=0)
            axes.annotate(f" {change:+.2g}" if name != "profile" else f" {change:.2g}", (abs(change), place), va="center")
        axes.barh(0, 0, color=color, label=setting["setting"])
    if not known:
        plt.close(figure)
        return None
    axes.set_xscale("log")
    axes.set_xlim(max(1e-5, 0.3 * min(known)), 8 * max(known))
    axes.set_yticks(range(len(names)), [SCALARS.get(name, r"$v_x(z)$, rms") for name in names])
    axes.invert_yaxis()
    axes.grid(axis="y", visible=False)
    axes.set_xlabel("change [%] (no bar: less)")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14 * 6 / len(names)), ncols=3)
    axes.set_title(style.title_of("What settings move in the results", flow["reduced"]))
    return figure
