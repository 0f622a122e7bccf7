"""The paper's Figs. 10, 11, 13, 14: inertial number, the two stress ratios, fluctuations."""

import math

import numpy as np

import style
from study_panels import depth_panel, draw_logarithmic, over_flow_rate, over_inertia, speed_legend
from style import FIT
from study_runs import color_of, label_of, shown


def inertial_number(study):
    run = study.main_run()
    figure, (left, right) = style.panels(2, height=3.8)
    depth_panel(left, run, style.axis_label("I"))
    draw_logarithmic(left, run, "I", size=4)
    over_flow_rate(right, study, "I_th", r"$I_{\mathrm{th}}$", scale=True)
    mean = study.mean("I_th")
    if math.isfinite(mean["value"]):
        right.axhline(mean["value"], color=FIT, label=f"mean: {shown(mean)}")
    paper = study.paper_value("I_th")
    if math.isfinite(paper):
        left.axhline(paper, color=style.PAPER, linestyle="--", linewidth=1)
        right.axhline(paper, color=style.PAPER, linestyle="--", linewidth=1.2, label=f"paper: {paper:g}")
    right.set_ylim(0, None)
    right.legend(loc="lower right")
    return (figure, f"Fig. 10: inertial number, {label_of(run)}, and its value at the interface over Q",
            "I_th = 1.8e-2, independent of Q.",
            f"I_th = {shown(mean)} in the mean of all speeds; over Q it changes by {shown(study.trend('I_th'), 2)} of itself.")


def ratio_panels(study, panels, run, name):
    """The main speed on a linear axis of I; below it what the paper shows in an inset: all speeds, logarithmic."""
    linear, logarithmic = panels
    over_inertia(linear, run, run.columns[name], run.half_width(name), style.PARTICLES, label_of(run))
    linear.set_xscale("linear")
    linear.set_xlim(0, 0.12)
    for one in study.first_runs():
        over_inertia(logarithmic, one, one.columns[name], one.half_width(name), color_of(study, one.rpm), size=4)
    logarithmic.set_xlim(1e-5, 0.3)
    for axes in (linear, logarithmic):
        axes.set_ylabel(style.axis_label(name))
    return linear, logarithmic


def collapse_in_words(one):
    if one["ratio"] is None:
        return "not measured"
    return (f"the speeds spread {one['ratio']:.2f} times as far as their intervals explain (one curve up to "
            f"{one['limit']:.2f}), {one['spread']:.3g} on a range of {one['range']:.3g}")


def rheology(study):
    run = study.main_run()
    figure, panels = style.panels(4, height=3.4)
    linear, logarithmic = ratio_panels(study, panels[:2], run, "mu")
    friction = study.content["friction"]
    found = "no law was fitted"
    if friction:
        a, b = friction["a"]["value"], friction["b"]["value"]
        logarithmic.plot(friction["curve"]["I"], friction["curve"]["mu"], color=FIT, linewidth=2, zorder=5,
                         label=f"{a:.3f} + {b:.4f} ln $I$")
        found = (f"all speeds together: {shown(friction['a'])} + ({shown(friction['b'])}) ln I; rms of the layers about it "
                 f"{friction['rms']:.3g}, about the laws of their own speeds {friction['rms_own']:.3g}")
    paper = study.content["paper_friction"]
    if paper:
        logarithmic.plot(paper["curve"]["I"], paper["curve"]["mu"], color=style.PAPER, linestyle="-.", linewidth=1.4, zorder=5,
                         label=f"paper: {paper['a']:g} + {paper['b']:g} ln $I$")
    speed_legend(logarithmic, study, loc="upper left", ncols=2, handletextpad=0.3, labelspacing=0.3)
    linear.legend(loc="lower right")
    for axes in (linear, logarithmic):
        axes.set_ylim(0.1, 0.6)
    for axes in ratio_panels(study, panels[2:], run, "k"):
        axes.axhline(1, color="k", linestyle="-.", linewidth=1)
        axes.set_ylim(0.7, 1.4)
    collapse = study.content["collapse"]
    return (figure, f"Fig. 11: stress ratios over the inertial number, {label_of(run)}, and of all speeds",
            "mu = 0.35 + 0.013 log I from 1e-4 to 1e-1 for all Q, decreasing faster below; k = 0.8 at I -> 0, a maximum of 1.2 at "
            "I = 1e-3, 1 in the flowing layer, no collapse.",
            f"{found}. mu(I): {collapse_in_words(collapse['mu'])}. k(I): {collapse_in_words(collapse['k'])}; its maximum is "
            f"{shown(study.mean('k_maximum'))}, at the drum it is {shown(study.mean('k_boundary'))}, in the flowing layer "
            f"{shown(study.mean('k_flowing'))}.")


def fluctuation_names(run):
    return [(name, plateau, label) for name, plateau, label in
            (("dv", "dv_over_shear", r"$\delta v / \dot\gamma$  [$d$]"),
             ("domega", "domega_over_shear", r"$\delta\omega / \dot\gamma$")) if run.has(name)]


def ratio_to_shear(run, name):
    """Ratio and its half width, the errors of both taken for independent."""
    rates, values = (style.positive(run.columns[key]) for key in ("shear_rate", name))
    ratios = values / rates
    return ratios, ratios * np.hypot(run.half_width(name) / values, run.half_width("shear_rate") / rates)


def fluctuations(study):
    run = study.main_run()
    names = fluctuation_names(run)
    figure, panels = style.panels(len(names), height=3.8)
    found = []
    for axes, (name, plateau, label) in zip(panels, names):
        depth_panel(axes, run, label)
        ratios, errors = ratio_to_shear(run, name)
        rows = run.inside()
        style.band(axes, run.z[rows], ratios[rows], np.minimum(errors, 0.99 * ratios)[rows], style.PARTICLES)
        axes.set_yscale("log")
        axes.set_ylim(1, 200)
        mean = study.at_main_speed(plateau)
        if math.isfinite(mean["value"]):
            axes.plot([-run.scalar("H"), 0], [mean["value"]] * 2, color=FIT, linewidth=2.5, zorder=5,
                      label=f"flowing layer: {shown(mean)}")
        paper = study.paper_value(plateau)
        if math.isfinite(paper):
            axes.plot([-run.scalar("H"), 0], [paper] * 2, color=style.PAPER, linestyle="--", linewidth=1.5, zorder=6,
                      label=f"paper: {paper:g}")
        axes.legend(loc="upper right")
        found.append(f"{plateau} = {shown(mean)} here, {shown(study.mean(plateau))} over all speeds")
    return (figure, f"Fig. 13: fluctuations of velocity and spin over the shear rate, {label_of(run)}",
            "constant in the flowing layer, 2.65 and 3.35; growing with depth below it.", "; ".join(found) + ".")


def fluctuations_over_inertia(study):
    names = fluctuation_names(study.main_run())
    figure, panels = style.panels(len(names), height=4.4)
    found = []
    laws = {"dv": ("static_velocity_fluctuation", "dv_exponent"), "domega": ("static_spin_fluctuation", "domega_exponent")}
    for axes, (name, plateau, label) in zip(panels, names):
        for run in study.first_runs():
            if run.has(name):
                ratios, errors = ratio_to_shear(run, name)
                over_inertia(axes, run, ratios, np.minimum(errors, 0.9 * ratios), color_of(study, run.rpm), label_of(run))
        axes.set_yscale("log")
        axes.set_ylabel(label)
        interface = study.mean("I_th")["value"]
        law, exponent = laws[name]
        measured, level = study.mean(exponent), study.mean(plateau)["value"]
        if math.isfinite(interface):
            axes.axvline(interface, color="0.4", linestyle="-.", linewidth=1)
        if math.isfinite(interface) and math.isfinite(level):
            inertial = [3e-5, interface]
            for power, color, line, words in ((measured["value"], FIT, "-", f"here: {shown(measured, 2)}"),
                                              (study.paper_law(law, "p"), style.PAPER, "--", "paper: ")):
                if math.isfinite(power):
                    text = words if color == FIT else f"paper: {power:.2f}"
                    axes.plot(inertial, [level * (x / interface) ** power for x in inertial], color=color,
                              linestyle=line, zorder=5, label=f"slope {text}")
        axes.set_xlim(1e-5, 0.3)
        axes.set_ylim(1, 200)
        axes.legend(loc="upper right", ncols=2)
        found.append(f"{name}: exponent {shown(measured, 2)} over all speeds")
    return (figure, "Fig. 14: fluctuations over the shear rate against I, all speeds",
            "below I_th dv/shear rate ~ I^(-1/2), domega/shear rate ~ I^(-1/3).", "; ".join(found) + ".")


def volume_fraction_over_inertia(study):
    figure, (axes,) = style.panels(1, height=4.6)
    for run in study.first_runs():
        over_inertia(axes, run, run.columns["nu"], run.half_width("nu"), color_of(study, run.rpm), label_of(run))
    axes.set_xlim(1e-5, 0.3)
    axes.set_ylim(0.77, 0.845)
    axes.set_ylabel(style.axis_label("nu"))
    axes.legend(loc="lower left")
    one = study.content["collapse"]["nu"]
    return (figure, "Volume fraction over the inertial number, all speeds", "not shown.", collapse_in_words(one) + ".")
